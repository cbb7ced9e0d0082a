//! Frequency responses (receptance, mobility, accelerance) and their peaks.
//!
//! `X(ω) = (K(ω) − ω²M)⁻¹ F`, convention e^{+iωt}. Frequencies are computed side by side in vector registers (the
//! kernel). The plain version, [`receptance`], is the oracle of the kernel and replaces it where the kernel is not
//! accurate. [`adaptive`] chooses frequencies such that no peak is missed; [`missed_peaks`] counts those that other
//! frequencies miss.

pub mod adaptive;
mod frame_motion;
mod kernel;
mod maxima;
pub mod missed_peaks;
mod peaks;
mod signals;

pub use frame_motion::{FrameInput, FrameMotion};
pub use peaks::{Peak, peaks};
pub use signals::{Port, Signal, about, along};

use crate::cable::catenary_dynamic::DriveSignal;
use crate::cable_motion::CableStations;
use crate::dynamics::Dynamics;
use crate::math::{CDMat, CMat6, CVec6, Complex, Vec3, Vec6, inverse6};
use std::f64::consts::TAU;
use std::slice;
use std::sync::Arc;
use thiserror::Error;

/// Quantity of a motion in a response.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// Displacement [m] or rotation [rad].
    Displacement,
    /// Velocity [m/s] or angular velocity [rad/s].
    Velocity,
    /// Acceleration [m/s²] or angular acceleration [rad/s²].
    Acceleration,
}

impl Quantity {
    /// Number of differentiations by time that lead from the displacement to the quantity.
    pub(crate) fn derivatives(self) -> u32 {
        match self {
            Self::Displacement => 0,
            Self::Velocity => 1,
            Self::Acceleration => 2,
        }
    }

    /// Factor 1, iω or −ω² from a harmonic displacement to the quantity at ω [rad/s].
    pub fn factor(self, omega: f64) -> Complex {
        match self {
            Self::Displacement => Complex::new(1.0, 0.0),
            Self::Velocity => Complex::new(0.0, omega),
            Self::Acceleration => Complex::new(-(omega * omega), 0.0),
        }
    }

    /// Response of the quantity at ω [rad/s], from that of the displacement.
    fn of_displacement(self, displacement: Complex, omega: f64) -> Complex {
        let factor = self.factor(omega);
        // A real factor keeps the sign of a part that is zero, and with it the phase of an undamped response.
        if self == Self::Velocity { displacement * factor } else { displacement * factor.re }
    }
}

/// Value of one response at one frequency.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measured {
    /// Response.
    pub value: Complex,
    /// Magnitude below which rounding hides the response. It is not resolved there.
    pub floor: f64,
}

/// Reason why there is no response.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum ResponseError {
    /// The robot is undamped and the frequency is a natural one.
    #[error(
        "the response at {frequency_hz} Hz is not finite: an undamped natural frequency lies there; give the ropes \
         damping or choose other frequencies"
    )]
    Resonance {
        /// Frequency [Hz].
        frequency_hz: f64,
    },
    /// Input and output are on the same cable, whose response to a force on itself is not known.
    #[error(
        "the response of a cable to a force on itself needs the model `catenary-dynamic`, a cable with mass, and both \
         points among the same loaded stations"
    )]
    SameCable,
}

/// Response of one output to one input at each frequency [Hz]: displacement per force [m/N], rotation per moment
/// [rad/(N·m)], and so on, by the kinds of input and output.
///
/// `input` and `output` come from [`along`] or [`about`].
///
/// # Errors
/// [`ResponseError::Resonance`] where an undamped robot has no finite response.
///
/// # References
/// The paper's equation (15); docs/theory.md, equation (31).
pub fn frf(
    dynamics: &Dynamics,
    frequencies_hz: &[f64],
    input: &Vec6,
    output: &Vec6,
    quantity: Quantity,
) -> Result<Vec<Complex>, ResponseError> {
    finished(kernel::one_entry(dynamics, frequencies_hz, input, output), frequencies_hz, quantity)
}

/// Response between any two ports at each frequency [Hz]: `v_outᵀ X v_in`, with vectors that depend on frequency if a
/// port is on a cable.
///
/// # Errors
/// [`ResponseError`]; a force and a motion on the same cable must be stations of one
/// [`CableStations`], made for forces (`loaded`).
///
/// # References
/// docs/theory.md, section 11.
pub fn between(
    dynamics: &Dynamics,
    frequencies_hz: &[f64],
    input: &Port,
    output: &Port,
    quantity: Quantity,
) -> Result<Vec<Complex>, ResponseError> {
    let rows = matrix(dynamics, frequencies_hz, slice::from_ref(input), &[(output.clone(), quantity)])?;
    Ok(rows.into_iter().next().unwrap_or_default())
}

/// Responses between all pairs of ports at each frequency [Hz], one row per pair: the pairs of the first output with
/// all inputs, then those of the next output. Each row is that of [`between`] for its pair, to the last digit.
///
/// # Errors
/// The errors of [`between`].
pub fn matrix(
    dynamics: &Dynamics,
    frequencies_hz: &[f64],
    inputs: &[Port],
    outputs: &[(Port, Quantity)],
) -> Result<Vec<Vec<Complex>>, ResponseError> {
    let on_platform = |port: &Port| if let Port::Platform(vector) = port { Some(*vector) } else { None };
    let pairs =
        || outputs.iter().flat_map(|(output, quantity)| inputs.iter().map(move |input| (input, output, *quantity)));

    // Pairs of ports on the platform need no complete receptance.
    let from: Vec<Vec6> = inputs.iter().filter_map(on_platform).collect();
    let to: Vec<Vec6> = outputs.iter().filter_map(|(port, _)| on_platform(port)).collect();
    let of_platform = match (&from[..], &to[..]) {
        ([], _) | (_, []) => Vec::new(),
        ([input], [output]) => vec![kernel::one_entry(dynamics, frequencies_hz, input, output)],
        _ => kernel::entries(dynamics, frequencies_hz, &from, &to),
    };
    if of_platform.len() == inputs.len() * outputs.len() {
        let finished = |(row, (_, _, quantity))| finished(row, frequencies_hz, quantity);
        return of_platform.into_iter().zip(pairs()).map(finished).collect();
    }

    let own =
        pairs().map(|(input, output, _)| OwnResponse::of(dynamics, input, output)).collect::<Result<Vec<_>, _>>()?;
    let all = kernel::all_entries(dynamics, frequencies_hz);
    let mut rows = vec![Vec::with_capacity(frequencies_hz.len()); inputs.len() * outputs.len()];
    for (receptance, frequency_hz) in all.iter().zip(frequencies_hz) {
        let omega = frequency_hz * TAU;
        let supports = dynamics.support_response(omega);
        let by_platform = supports.as_ref().map(|(by_platform, _)| by_platform);
        let from: Vec<(CVec6, Vec<Complex>)> =
            inputs.iter().map(|input| input.free_vector(dynamics, by_platform, omega)).collect();
        let mut row = 0;
        for (output, _) in outputs {
            let (to, to_supports) = output.free_vector(dynamics, by_platform, omega);
            for (input, from_supports) in &from {
                let mut through = (to.transpose() * receptance * input)[0];
                if let Some((_, free)) = &supports {
                    through += between_supports(free, &to_supports, from_supports);
                }
                let added = own[row].as_ref().map(|own| own.at(dynamics, omega));
                rows[row].push(added.map_or(through, |added| through + added));
                row += 1;
            }
        }
    }

    let mut of_platform = of_platform.into_iter();
    let finished = |(row, (input, output, quantity)): (Vec<Complex>, (&Port, &Port, Quantity))| {
        let both = on_platform(input).is_some() && on_platform(output).is_some();
        finished(if both { of_platform.next().unwrap_or(row) } else { row }, frequencies_hz, quantity)
    };
    rows.into_iter().zip(pairs()).map(finished).collect()
}

/// Output through the supports alone: `w_outᵀ Y⁻¹ w_in`.
fn between_supports(free: &CDMat, to: &[Complex], from: &[Complex]) -> Complex {
    let row = |i: usize| -> Complex { from.iter().enumerate().map(|(j, from)| free[(i, j)] * from).sum() };
    to.iter().enumerate().map(|(i, to)| to * row(i)).sum()
}

/// Motion of a cable under a force on itself, or a motion of its anchor, which adds to the motion through the platform.
enum OwnResponse<'a> {
    /// Between points of the cable.
    Points { stations: &'a CableStations, to: (usize, &'a Vec3), from: (usize, &'a Vec3) },
    /// Between signals of its drive; the cable's index among those whose stiffness depends on frequency.
    Drive { term: usize, to: DriveSignal, from: DriveSignal },
    /// From a signal of its drive to a point of the cable, or by reciprocity from a force there to that signal.
    DriveAndPoint { stations: &'a CableStations, point: (usize, &'a Vec3), signal: DriveSignal },
    /// From a motion of the frame to a signal of a drive; the cable's index among those whose stiffness depends on
    /// frequency.
    DriveByFrame { term: usize, to: DriveSignal, from: &'a FrameMotion },
    /// From a motion of the frame to a point of a cable.
    PointByFrame { stations: &'a CableStations, to: (usize, &'a Vec3), from: &'a FrameMotion },
}

impl<'a> OwnResponse<'a> {
    /// Own response of a pair of ports; `None` if they are not on the same cable.
    fn of(dynamics: &Dynamics, input: &'a Port, output: &'a Port) -> Result<Option<Self>, ResponseError> {
        match (input, output) {
            (Port::Drive { term, signal: from, .. }, Port::Drive { term: of_output, signal: to, .. })
                if term == of_output =>
            {
                Ok(Some(Self::Drive { term: *term, to: *to, from: *from }))
            }

            // A drive and a point of its cable, in either direction.
            (Port::Drive { term, signal, .. }, Port::Cable { stations, station, direction_w })
            | (Port::Cable { stations, station, direction_w }, Port::Drive { term, signal, .. })
                if dynamics.terms()[*term].cable() == stations.cable =>
            {
                Ok(Some(Self::DriveAndPoint { stations, point: (*station, direction_w), signal: *signal }))
            }

            // Two points of a cable.
            (
                Port::Cable { stations, station: loaded, direction_w: force_w },
                Port::Cable { stations: of_output, station, direction_w },
            ) if stations.cable == of_output.cable => {
                if !(Arc::ptr_eq(stations, of_output) && stations.has_own_receptance()) {
                    return Err(ResponseError::SameCable);
                }
                Ok(Some(Self::Points { stations, to: (*station, direction_w), from: (*loaded, force_w) }))
            }

            // A motion of the frame.
            (Port::Frame(from), Port::Drive { term, signal, .. }) => {
                Ok(Some(Self::DriveByFrame { term: *term, to: *signal, from }))
            }
            (Port::Frame(from), Port::Cable { stations, station, direction_w }) => {
                Ok(Some(Self::PointByFrame { stations, to: (*station, direction_w), from }))
            }
            _ => Ok(None),
        }
    }

    fn at(&self, dynamics: &Dynamics, omega: f64) -> Complex {
        match self {
            Self::Points { stations, to, from } => stations.own_receptance(dynamics, *to, *from, omega),
            Self::DriveAndPoint { stations, point, signal } => stations.by_signal(dynamics, *point, *signal, omega),
            Self::DriveByFrame { term, to, from } => from.of_drive(dynamics, *term, *to, omega),
            Self::PointByFrame { stations, to, from } => from.of_station(dynamics, stations, *to, omega),
            Self::Drive { term, to, from } => {
                let Some(form) = dynamics.terms()[*term].form().by_poles() else {
                    unreachable!("ports of drives are on catenary-dynamic cables")
                };
                form.signal_response(*from, *to, omega.into()).unwrap_or_default()
            }
        }
    }
}

/// Maximum response that is lost in rounding, as a fraction of the sum of its terms: elimination keeps at least ten
/// digits of the largest term.
const LOST: f64 = 1e-9;

/// Responses between all pairs of ports, in the order of [`matrix`], with the magnitude below which rounding hides
/// each: one row per frequency [Hz].
///
/// # Errors
/// The errors of [`between`].
pub fn measured(
    dynamics: &Dynamics,
    frequencies_hz: &[f64],
    inputs: &[Port],
    outputs: &[(Port, Quantity)],
) -> Result<Vec<Vec<Measured>>, ResponseError> {
    let values = matrix(dynamics, frequencies_hz, inputs, outputs)?;
    let sizes = kernel::all_entries(dynamics, frequencies_hz);

    let row = |(k, (receptance, frequency_hz)): (usize, (&CMat6, &f64))| {
        let omega = frequency_hz * TAU;
        let magnitudes = |port: &Port| port.vector(dynamics, omega).map(Complex::norm);
        let size = receptance.map(Complex::norm);
        let from: Vec<Vec6> = inputs.iter().map(|input| size * magnitudes(input)).collect();
        let sums = outputs.iter().flat_map(|(output, quantity)| {
            let to = magnitudes(output);
            let by_time = quantity.factor(omega).norm();
            from.iter().map(move |from| LOST * by_time * to.dot(from)).collect::<Vec<f64>>()
        });
        sums.enumerate().map(|(i, floor)| Measured { value: values[i][k], floor }).collect()
    };
    Ok(sizes.iter().zip(frequencies_hz).enumerate().map(row).collect())
}

/// Converts receptances to the requested quantity.
fn finished(
    mut values: Vec<Complex>,
    frequencies_hz: &[f64],
    quantity: Quantity,
) -> Result<Vec<Complex>, ResponseError> {
    for (value, &frequency_hz) in values.iter_mut().zip(frequencies_hz) {
        let omega = frequency_hz * TAU;
        *value = quantity.of_displacement(*value, omega);
        if !(value.re.is_finite() && value.im.is_finite()) {
            return Err(ResponseError::Resonance { frequency_hz });
        }
    }
    Ok(values)
}

/// Receptance of all six motions to all six wrench components at each frequency [Hz], about the platform origin, world
/// axes [m/N, rad/N, m/(N·m), rad/(N·m)]; symmetric.
///
/// # Errors
/// [`ResponseError::Resonance`] where an undamped robot has no finite response.
pub fn receptances(dynamics: &Dynamics, frequencies_hz: &[f64]) -> Result<Vec<CMat6>, ResponseError> {
    let all = kernel::all_entries(dynamics, frequencies_hz);
    match all.iter().position(|x| !x.iter().all(|v| v.re.is_finite() && v.im.is_finite())) {
        Some(i) => Err(ResponseError::Resonance { frequency_hz: frequencies_hz[i] }),
        None => Ok(all),
    }
}

/// Receptance at one angular frequency ω [rad/s], by elimination with pivots; not finite at an undamped resonance.
///
/// Rows and columns are zero for motions along axes that the platform does not have.
pub fn receptance(dynamics: &Dynamics, omega: f64) -> CMat6 {
    let mut d = dynamics.damped_dynamic_stiffness(omega);
    for i in dynamics.dof()..6 {
        d[(i, i)] = Complex::new(1.0, 0.0);
    }
    let mut inverse = inverse6(&d).unwrap_or_else(|| CMat6::repeat(Complex::new(f64::INFINITY, 0.0)));
    for i in dynamics.dof()..6 {
        inverse[(i, i)] = Complex::new(0.0, 0.0);
    }
    let inverse = dynamics.expanded(&inverse);
    let scale = dynamics.scale();
    CMat6::from_fn(|i, j| inverse[(i, j)] / (scale[i] * scale[j]))
}

//! Frequency responses (receptance, mobility, accelerance) and their peaks.
//!
//! `X(ω) = (K(ω) − ω²M)⁻¹ F`, convention e^{+iωt}. Frequencies are computed side by side in vector registers (the
//! kernel). The plain version, [`receptance`], is the oracle of the kernel and replaces it where the kernel is not
//! accurate.

mod kernel;
mod peaks;
mod signals;

pub use peaks::{Peak, peaks};
pub use signals::{Port, Signal, about, along};

use crate::cable_motion::CableStations;
use crate::dynamics::Dynamics;
use crate::math::{CMat6, Complex, Vec3, Vec6};
use std::f64::consts::TAU;
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

/// Reason for which there is no response.
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
/// [`CableStations`](crate::cable_motion::CableStations), made for forces (`loaded`).
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
    if let (Port::Platform(input), Port::Platform(output)) = (input, output) {
        return frf(dynamics, frequencies_hz, input, output, quantity);
    }

    let own = own_receptance(input, output)?;
    let all = kernel::all_entries(dynamics, frequencies_hz);
    let entry = |(receptance, frequency_hz): (&CMat6, &f64)| {
        let omega = frequency_hz * TAU;
        let through = (output.vector(dynamics, omega).transpose() * receptance * input.vector(dynamics, omega))[0];
        own.as_ref().map_or(through, |own| through + own.at(dynamics, omega))
    };
    finished(all.iter().zip(frequencies_hz).map(entry).collect(), frequencies_hz, quantity)
}

/// Displacements of all outputs per force at all inputs at each frequency [Hz]: outputs×inputs entries by columns, one
/// frequency after the other.
///
/// # Errors
/// The errors of [`between`].
pub(crate) fn between_all(
    dynamics: &Dynamics,
    frequencies_hz: &[f64],
    inputs: &[Port],
    outputs: &[Port],
) -> Result<Vec<Complex>, ResponseError> {
    let own = inputs
        .iter()
        .flat_map(|input| outputs.iter().map(move |output| own_receptance(input, output)))
        .collect::<Result<Vec<_>, _>>()?;
    let all = kernel::all_entries(dynamics, frequencies_hz);

    let mut entries = Vec::with_capacity(frequencies_hz.len() * own.len());
    for (receptance, &frequency_hz) in all.iter().zip(frequencies_hz) {
        let omega = frequency_hz * TAU;
        let rows: Vec<_> = outputs.iter().map(|output| output.vector(dynamics, omega).transpose()).collect();
        let mut own = own.iter();
        for input in inputs {
            let column = receptance * input.vector(dynamics, omega);
            for row in &rows {
                let through = (row * column)[0];
                let entry = match own.next() {
                    Some(Some(own)) => through + own.at(dynamics, omega),
                    _ => through,
                };
                if !(entry.re.is_finite() && entry.im.is_finite()) {
                    return Err(ResponseError::Resonance { frequency_hz });
                }
                entries.push(entry);
            }
        }
    }
    Ok(entries)
}

/// Motion of a cable itself by a force on it, beside its motion with the platform.
struct OwnReceptance<'a> {
    stations: &'a CableStations,
    to: (usize, &'a Vec3),
    from: (usize, &'a Vec3),
}

impl OwnReceptance<'_> {
    fn at(&self, dynamics: &Dynamics, omega: f64) -> Complex {
        self.stations.own_receptance(dynamics, self.to, self.from, omega)
    }
}

/// Own motion of the cable if both ports are on the same one.
fn own_receptance<'a>(input: &'a Port, output: &'a Port) -> Result<Option<OwnReceptance<'a>>, ResponseError> {
    match (input, output) {
        (
            Port::Cable { stations, station: loaded, direction_w: force_w },
            Port::Cable { stations: of_output, station, direction_w },
        ) if stations.cable == of_output.cable => {
            if !(Arc::ptr_eq(stations, of_output) && stations.has_own_receptance()) {
                return Err(ResponseError::SameCable);
            }
            Ok(Some(OwnReceptance { stations, to: (*station, direction_w), from: (*loaded, force_w) }))
        }
        _ => Ok(None),
    }
}

/// Converts receptances to the requested quantity.
fn finished(
    mut values: Vec<Complex>,
    frequencies_hz: &[f64],
    quantity: Quantity,
) -> Result<Vec<Complex>, ResponseError> {
    for (value, &frequency_hz) in values.iter_mut().zip(frequencies_hz) {
        let omega = frequency_hz * TAU;
        *value = match quantity {
            Quantity::Displacement => *value,
            Quantity::Velocity => *value * Complex::new(0.0, omega),
            Quantity::Acceleration => *value * -(omega * omega),
        };
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
    let mut inverse = d.try_inverse().unwrap_or_else(|| CMat6::repeat(Complex::new(f64::INFINITY, 0.0)));
    for i in dynamics.dof()..6 {
        inverse[(i, i)] = Complex::new(0.0, 0.0);
    }
    let inverse = dynamics.expanded(&inverse);
    let scale = dynamics.scale();
    CMat6::from_fn(|i, j| inverse[(i, j)] / (scale[i] * scale[j]))
}

//! Response to gusts: spectra, r.m.s. values and expected peaks of motions and tensions in turbulent wind.
//!
//! The drag of cables and platform is linear about the mean wind. Its derivative by the velocity of the air loads the
//! robot, and by the velocity of cables and platform it damps it: [`Gusts`] has this aerodynamic damping beside all
//! damping of the robot. The gusts on the cells of all cables and on the platform agree by the coherence of the
//! turbulence. Derivation: docs/theory.md, section 15.

mod cable;
mod extremes;
mod field;
mod integration;
mod modes;
mod solved;

pub use extremes::{MIN_CROSSINGS, PeakFactor, slack_probability};
pub use integration::{Moments, Spectra};
pub use modes::{GustResonance, aerodynamic_damping_ratio};

use crate::cable::catenary_dynamic::{CatenaryDynamicEnd, DriveSignal};
use crate::cable_motion::{CableMotionError, CableStations};
use crate::dynamics::Dynamics;
use crate::math::{CDMat, CDVec, Complex, DMat, DVec, Vec3};
use crate::reduced_model::{CoordinateLayout, Matrices};
use crate::response::{Quantity, Signal, along};
use crate::robot::Robot;
use crate::statics::Equilibrium;
use cable::{GustyCable, motion_w};
use field::Distances;
pub(crate) use field::{GustPlace, TurbulentField};
use solved::{OutputRow, Solved, products};
use std::f64::consts::TAU;
use thiserror::Error;

/// Frequencies, over the highest one, up to which clamped modes are kept as they are; a few modes replace those above.
/// With 4, amplitudes of cables between their ends are right to 1e-3 at the highest frequency.
const KEPT: f64 = 4.0;

/// Reason why there is no response to gusts.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum GustError {
    /// The robot has no turbulence.
    #[error("the wind has no turbulence")]
    NoTurbulence,
    /// The mean wind is zero.
    #[error("there is no mean wind: gusts have no direction and no length in time")]
    NoWind,
    /// The mean wind is vertical.
    #[error("the mean wind is vertical: the gusts have no lateral direction; give a wind that is nearly level")]
    NotLevel,
    /// Nothing has drag.
    #[error(
        "the wind acts neither on a cable nor on the platform: give a `drag_coefficient` of the ropes or a \
         `drag_area_m2` of the platform in the robot file"
    )]
    NoDrag,
    /// The control of a motor has a delay, which has no second-order form.
    #[error(
        "the control of cable \"{cable}\" has a delay of {delay_s} s, which gusts do not have yet: set it to 0 to see \
         the response without it"
    )]
    Delay {
        /// Name of the cable.
        cable: String,
        /// Delay [s].
        delay_s: f64,
    },
    /// The output is none of those that gusts have.
    #[error("the response to gusts has motions of the platform and of points on cables, and tensions at the platform")]
    Output,
    /// The tension has no row in the coordinates of the platform.
    #[error(
        "cable \"{cable}\" is slack or pulls out of the plane of the platform: its tension in gusts is not \
         known; choose outputs without it"
    )]
    Tension {
        /// Name of the cable.
        cable: String,
    },
    /// The motion along a cable is not known.
    #[error(transparent)]
    CableMotion(#[from] CableMotionError),
    /// The response is not finite.
    #[error(
        "the response at {frequency_hz} Hz is not finite: an undamped natural frequency lies there; give the ropes \
         damping"
    )]
    Resonance {
        /// Frequency [Hz].
        frequency_hz: f64,
    },
    /// The integration over frequency does not end.
    #[error(
        "the spectra need more than {limit} frequencies: the robot has hardly any damping; give the ropes damping or \
         lower the frequency limit"
    )]
    TooManyFrequencies {
        /// Maximum number of frequencies.
        limit: usize,
    },
}

/// Robot at rest in its mean wind, linearised.
#[derive(Clone, Copy)]
pub(crate) struct Setting<'a> {
    pub(crate) robot: &'a Robot,
    pub(crate) equilibrium: &'a Equilibrium,
    pub(crate) dynamics: &'a Dynamics,
}

/// Output of the response.
enum GustOutput {
    /// Motion of the platform or of a point on a cable.
    Motion(OutputRow),
    /// Tension of a cable at the platform.
    Tension(usize),
}

/// Robot in gusts, with its outputs.
///
/// # Example
/// ```
/// use funicular::dynamics::{Dynamics, Linearisation};
/// use funicular::gust::{self, GustResonance, Gusts};
/// use funicular::math::Vec3;
/// use funicular::response::{Quantity, Signal};
/// use funicular::robot::Robot;
/// use funicular::{modes, statics, statics::StaticModel};
///
/// let wind = "[wind]\nvelocity_m_s = [12.0, 0.0, 0.0]\nturbulence = \"kaimal\"\nintensity = [0.15, 0.12, 0.075]\n\
///             length_scale_m = [85.05, 28.35, 6.93]";
/// let rope = "drag_coefficient = 1.2\ndrag_diameter_m = 0.005\nmaximum_tension_n";
/// let file = funicular_robots::STADIUM_CAMERA.replace("maximum_tension_n", rope);
/// let robot = Robot::from_toml(&format!("{file}\n{wind}"))?;
/// let rest = statics::solve(&robot, StaticModel::Catenary, None)?.equilibrium;
/// let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), 2.0)?;
///
/// let up = Signal::Along { direction_w: Vec3::z(), point_p: Vec3::zeros() };
/// let gusts = Gusts::new(&robot, &rest, &dynamics, &[(up, Quantity::Displacement)], 2.0)?;
/// let found = modes::below(&dynamics, 2.0).modes;
/// let in_air = gust::aerodynamic_damping_ratio(&robot, &rest, &dynamics, &found)?;
/// let spectra = gusts.spectra(2.0, &GustResonance::of_modes(&found, &in_air))?;
/// assert!((spectra.moments[0].rms() - 0.0676).abs() < 2e-4); // m
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Gusts {
    field: TurbulentField,
    places: Vec<GustPlace>,
    distances: Distances,
    /// Platform and supports, without the cables whose matrices stand below.
    ends: Matrices,
    /// Generalised forces on the platform per velocity of the air along, lateral and up [N s/m].
    platform_loads: DMat,
    cables: Vec<GustyCable>,
    outputs: Vec<(GustOutput, Quantity)>,
    /// Outputs per velocity of the air at every place, at rest; empty if the robot has no stiffness.
    at_rest: Vec<Vec<Complex>>,
}

/// Spectral densities of all outputs at one frequency.
#[derive(Debug, Clone, PartialEq)]
pub struct Densities {
    /// Density of each output, its unit squared per Hz.
    pub total: Vec<f64>,
    /// Density without the dynamics of the robot: of the response as slow gusts would have it. Not finite for a robot
    /// without stiffness.
    pub quasi_static: Vec<f64>,
}

impl Gusts {
    /// Robot linearised about an equilibrium in its mean wind, with outputs, for frequencies up to `up_to_hz`, for
    /// which the dynamics are made.
    ///
    /// # Errors
    /// [`GustError`].
    ///
    /// # References
    /// docs/theory.md, equations (49i) and (49j).
    pub fn new(
        robot: &Robot,
        equilibrium: &Equilibrium,
        dynamics: &Dynamics,
        outputs: &[(Signal, Quantity)],
        up_to_hz: f64,
    ) -> Result<Self, GustError> {
        let field = TurbulentField::of(robot)?;
        check(robot, dynamics)?;
        let dynamics = &dynamics.with_poles_below(KEPT * highest(dynamics, up_to_hz), &[]);
        let setting = Setting { robot, equilibrium, dynamics };

        // Cables, and the ends without those that are matrices of their own.
        let blocks: Vec<_> = dynamics.cable_blocks().collect();
        let cables = (0..robot.cables.len())
            .map(|i| GustyCable::new(&setting, &field, i, blocks.iter().find(|of| of.cable == i)))
            .collect::<Result<Vec<_>, _>>()?;
        let mut ends = ends_of(dynamics);
        for cable in cables.iter().filter(|cable| cable.is_constant) {
            ends.stiffness -= &cable.matrices.stiffness;
        }

        let platform_loads = platform_loads(&setting, &field, &mut ends);
        let pose = &equilibrium.pose;
        let center_w = pose.position_w + pose.rot_wp * robot.platform.center_of_mass_p;
        let mut places = vec![GustPlace { center_w, extent_w: Vec3::zeros() }];
        places.extend(cables.iter().flat_map(|cable| cable.cells.iter().cloned()));
        let distances = field.distances(&places);

        let outputs = outputs
            .iter()
            .map(|(signal, quantity)| Ok((output(&setting, &cables, ends.mass.nrows(), signal)?, *quantity)))
            .collect::<Result<Vec<_>, GustError>>()?;
        let mut gusts = Self { field, places, distances, ends, platform_loads, cables, outputs, at_rest: Vec::new() };
        gusts.at_rest = gusts.transfers(0.0).unwrap_or_default();
        Ok(gusts)
    }

    /// Spectral densities of all outputs at a frequency [Hz].
    ///
    /// # Errors
    /// [`GustError::Resonance`].
    ///
    /// # References
    /// docs/theory.md, equation (49k).
    pub fn densities(&self, frequency_hz: f64) -> Result<Densities, GustError> {
        let omega = TAU * frequency_hz;
        let transfers = self.transfers(omega).ok_or(GustError::Resonance { frequency_hz })?;
        let both: Vec<&Vec<Complex>> = transfers.iter().chain(&self.at_rest).collect();
        let powers = self.powers(&both, frequency_hz);
        let of_gusts = self.field.densities(frequency_hz);
        let density = |(k, (_, quantity)): (usize, &(GustOutput, Quantity))| {
            let by_time = quantity.factor(omega).norm_sqr();
            move |powers: &[[f64; 3]]| -> f64 {
                let sum: f64 = powers.get(k).map_or(f64::NAN, |of| of.iter().zip(of_gusts).map(|(p, s)| p * s).sum());
                by_time * sum
            }
        };
        let (dynamic, still) = powers.split_at(transfers.len());
        let of_all = |powers: &[[f64; 3]]| self.outputs.iter().enumerate().map(|of| density(of)(powers)).collect();
        Ok(Densities { total: of_all(dynamic), quasi_static: of_all(still) })
    }

    /// Outputs per velocity of the air at ω [rad/s]: a row per output, with three components per place. `None` if they
    /// are not finite.
    fn transfers(&self, omega: f64) -> Option<Vec<Vec<Complex>>> {
        let stiffness: Vec<CDMat> = self.cables.iter().map(|cable| cable.matrices.dynamic_stiffness(omega)).collect();
        let solved = Solved::new(self.ends.dynamic_stiffness(omega), &self.cables, &stiffness)?;
        self.outputs.iter().map(|(output, _)| self.transfer(output, &stiffness, &solved)).collect()
    }

    /// One output per velocity of the air.
    fn transfer(&self, output: &GustOutput, stiffness: &[CDMat], solved: &Solved) -> Option<Vec<Complex>> {
        let row = match output {
            GustOutput::Motion(row) => row.clone(),
            GustOutput::Tension(i) => {
                let row = self.cables[*i].tension_row(&stiffness[*i])?;
                OutputRow::of_cable(*i, &self.cables[*i], &row, self.ends.mass.nrows())
            }
        };
        let (ends, modes) = solved.response(&row)?;

        let mut transfer = products(&self.platform_loads, |i| ends[i]);
        for (i, (cable, modes)) in self.cables.iter().zip(&modes).enumerate() {
            let at = |coordinate: usize| of_coordinate(cable, &ends, modes, coordinate);
            let mut of_cable = products(&cable.loads, at);
            // The gusts on the end of the cable do not come through it.
            if let (GustOutput::Tension(of), Some(pull)) = (output, &cable.pull)
                && *of == i
            {
                let direct = products(&cable.loads, |coordinate| pull[coordinate].into());
                of_cable.iter_mut().zip(direct).for_each(|(sum, direct)| *sum += direct);
            }
            transfer.extend(of_cable);
        }
        Some(transfer)
    }

    /// Power of each transfer for gusts of unit density with their coherence, per component. It is never negative:
    /// the coherence between places is positive definite.
    fn powers(&self, transfers: &[&Vec<Complex>], frequency_hz: f64) -> Vec<[f64; 3]> {
        // Real and imaginary parts of all transfers and components, place by place.
        let width = 6 * transfers.len();
        let rows: Vec<Vec<f64>> = (self.places.iter().enumerate())
            .map(|(p, place)| {
                let factor = self.field.factor(place, frequency_hz);
                let components = transfers.iter().flat_map(|of| &of[3 * p..3 * p + 3]);
                components.flat_map(|of| [(of * factor).re, (of * factor).im]).collect()
            })
            .collect();

        let mut sums = vec![0.0; width];
        self.field.for_coherences(&self.distances, frequency_hz, |p, q, coherence| {
            let twice = if p == q { coherence } else { 2.0 * coherence };
            for ((sum, a), b) in sums.iter_mut().zip(&rows[p]).zip(&rows[q]) {
                *sum += twice * a * b;
            }
        });
        sums.chunks_exact(6).map(|of| std::array::from_fn(|c| (of[2 * c] + of[2 * c + 1]).max(0.0))).collect()
    }
}

/// Response of a coordinate of a cable.
fn of_coordinate(cable: &GustyCable, ends: &CDVec, modes: &CDVec, coordinate: usize) -> Complex {
    let first = cable.mode(0);
    if coordinate < first {
        ends[coordinate]
    } else if coordinate < first + modes.len() {
        modes[coordinate - first]
    } else {
        ends[coordinate - modes.len()]
    }
}

/// Refuses robots without drag and drives without a second-order form.
fn check(robot: &Robot, dynamics: &Dynamics) -> Result<(), GustError> {
    if robot.platform.drag_area == 0.0 && !robot.wind_turns_with_cables() {
        return Err(GustError::NoDrag);
    }
    for term in dynamics.terms() {
        let delay_s = term.form().by_poles().map_or(0.0, CatenaryDynamicEnd::delay);
        if delay_s > 0.0 {
            return Err(GustError::Delay { cable: robot.cables[term.cable()].name.clone(), delay_s });
        }
    }
    Ok(())
}

/// Angular frequency that the kept clamped modes have to reach [rad/s]: the highest frequency [Hz], and the first
/// clamped mode of every cable, so that each one bows under its gusts.
fn highest(dynamics: &Dynamics, up_to_hz: f64) -> f64 {
    let first = |end: &CatenaryDynamicEnd| end.poles_below(f64::INFINITY).fold(f64::INFINITY, f64::min).sqrt();
    let firsts = dynamics.terms().iter().filter_map(|term| term.form().by_poles()).map(first);
    firsts.filter(|omega| omega.is_finite()).fold(TAU * up_to_hz, f64::max)
}

/// Matrices of platform and supports.
fn ends_of(dynamics: &Dynamics) -> Matrices {
    let supports = dynamics.support_blocks();
    let count = supports.as_ref().map_or(0, |of| of.mass.nrows());
    let mut ends = Matrices::of_platform(&dynamics.platform_blocks(), dynamics.dof() + count);
    if let Some(supports) = &supports {
        let layout = CoordinateLayout::new(dynamics.dof(), &[], count);
        ends.add_supports(supports, &layout);
    }
    ends
}

/// Generalised forces on the platform per velocity of the air; adds its aerodynamic damping.
fn platform_loads(setting: &Setting, field: &TurbulentField, ends: &mut Matrices) -> DMat {
    let Setting { robot, equilibrium, dynamics } = *setting;
    let by_velocity = robot.wind.pressure_by_velocity_w() * robot.platform.drag_area;
    let motion = dynamics.coordinates().motion();
    let rows = [Vec3::x(), Vec3::y(), Vec3::z()]
        .map(|axis_w| motion.reduced(&along(&axis_w, &robot.platform.center_of_mass_p, &equilibrium.pose)));
    let count = ends.mass.nrows();
    let of_center = DMat::from_fn(3, count, |k, j| if j < dynamics.dof() { rows[k][j] } else { 0.0 });
    let force = of_center.transpose() * DMat::from_fn(3, 3, |k, l| by_velocity[(k, l)]);
    ends.damping += &force * &of_center;
    force * DMat::from_fn(3, 3, |k, l| field.axes[(k, l)])
}

/// Output of a signal.
fn output(setting: &Setting, cables: &[GustyCable], ends: usize, signal: &Signal) -> Result<GustOutput, GustError> {
    let Setting { robot, equilibrium, dynamics } = *setting;
    if let Some(vector) = signal.platform_vector(&equilibrium.pose) {
        let reduced = dynamics.coordinates().motion().reduced(&vector);
        let row: Vec<f64> = (0..ends).map(|j| if j < dynamics.dof() { reduced[j] } else { 0.0 }).collect();
        return Ok(GustOutput::Motion(OutputRow::of_ends(&row)));
    }
    match signal {
        Signal::OnCable { cable, fraction, direction_w } => {
            let stations = CableStations::new(robot, equilibrium, dynamics, *cable, &[*fraction], false)?;
            let towards = direction_w.normalize();
            let row = motion_w(dynamics, &stations, 0).tr_mul(&DVec::from_column_slice(towards.as_slice()));
            let row: Vec<Complex> = row.iter().map(|entry| Complex::from(*entry)).collect();
            Ok(GustOutput::Motion(OutputRow::of_cable(*cable, &cables[*cable], &row, ends)))
        }
        Signal::Drive { cable, signal: DriveSignal::Tension } => {
            if cables[*cable].pull.is_none() {
                return Err(GustError::Tension { cable: robot.cables[*cable].name.clone() });
            }
            Ok(GustOutput::Tension(*cable))
        }
        _ => Err(GustError::Output),
    }
}

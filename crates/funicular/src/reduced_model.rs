//! Small second-order model of the robot, `M ẍ + C ẋ + K x = B f`, `y = L x`, for control design.
//!
//! The coordinates are the platform's motion and the amplitudes of the cables' clamped modes. They represent
//! catenary-dynamic cables without approximation: K is block diagonal, M couples the platform to each amplitude. The
//! model has two approximations. Three modes of each cable replace all modes above the limit, and a constant damping
//! ratio is replaced by viscous damping. Both errors are measured against the full model. Derivation: docs/theory.md,
//! section 13.

mod candidates;
mod control_model;
mod reference;
mod selection;
mod steps;
mod terms;

pub use steps::STEPS;

pub use control_model::{
    ControlModel, ModalStates, PointwiseError, RequestedStateSpace, ResponseOfPair, control_model,
};
pub use selection::Size;

use crate::cable::DynamicCable;
use crate::cable_motion::CableMotionError;
use crate::dynamics::{CableBlocks, Dynamics, PlatformBlocks};
use crate::math::{CDMat, Complex, DMat, Vec6, symmetric_part};
use crate::modes;
use crate::response::{self, Port, Quantity, ResponseError, Signal};
use crate::robot::{Damping, Robot};
use crate::statics::Equilibrium;
use std::f64::consts::TAU;
use std::ops::Range;
use steps::Steps;
use thiserror::Error;

/// Viscous replacement of constant damping ratios, which no matrix C can represent at every frequency.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum DampingAt {
    /// Equation (46) of docs/theory.md: correct at every natural frequency of the model.
    NaturalFrequencies,
    /// `C = 2ξω M_c`: correct at this one frequency [Hz].
    Hz(f64),
}

/// Requirements for a reduced model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RequestedModel {
    /// Highest frequency [Hz].
    pub below_hz: f64,
    /// Maximum relative error of the responses by modes left out.
    pub tolerance: f64,
    /// Treatment of constant damping ratios.
    pub damping_at: DampingAt,
}

/// Meaning of a coordinate of the model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Coordinate {
    /// Coordinate of the platform's motion about its origin ([m] or [rad]), in the order of
    /// [`coordinate_names`](crate::robot::PlatformMotion::coordinate_names); for a rigid body δp and δθ in world axes.
    Platform(usize),
    /// Amplitude of a clamped mode of a cable, of unit modal mass [m √kg].
    Clamped {
        /// Index of the cable, in the order of the file.
        cable: usize,
        /// True for a mode out of the cable's plane.
        out_of_plane: bool,
        /// Clamped frequency [Hz]; the last modes of a cable replace all the others.
        frequency_hz: f64,
    },
}

/// Reduced model in second-order form.
#[derive(Debug, Clone, PartialEq)]
pub struct SecondOrder {
    /// Mass matrix M, symmetric positive definite, n×n.
    pub mass: DMat,
    /// Damping matrix C, symmetric positive semidefinite, n×n.
    pub damping: DMat,
    /// Stiffness matrix K, symmetric, n×n.
    pub stiffness: DMat,
    /// Input matrix B, n×inputs.
    pub input: DMat,
    /// Output matrix L, outputs×n: displacements and rotations.
    pub output: DMat,
    /// Quantity of each output: displacement, velocity or acceleration.
    pub quantities: Vec<Quantity>,
    /// Meaning of the n coordinates.
    pub coordinates: Vec<Coordinate>,
    /// Highest frequency for which the model is made [Hz].
    pub below_hz: f64,
    /// Maximum relative error of the natural frequencies below the limit.
    pub frequency_error: f64,
    /// Maximum error of the responses up to the limit by modes left out, at each frequency relative to the largest
    /// entry there. `None` if an undamped robot has no finite response.
    pub truncation_error: Option<f64>,
    /// Maximum error of the responses by the viscous replacement of constant damping ratios, at natural frequencies,
    /// each relative to the largest entry there; zero for viscous damping.
    pub damping_error: Option<f64>,
}

/// State space `ẋ = A x + B f`, `y = C x + D f`, whose state is motion and velocity.
#[derive(Debug, Clone, PartialEq)]
pub struct StateSpace {
    /// Matrix A, 2n×2n.
    pub a: DMat,
    /// Matrix B, 2n×inputs.
    pub b: DMat,
    /// Matrix C, outputs×2n.
    pub c: DMat,
    /// Matrix D, outputs×inputs.
    pub d: DMat,
}

/// Reason for which there is no reduced model.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ReductionError {
    /// A cable is in the shallow-dynamic model.
    #[error(
        "the reduced model consists of the modes of catenary-dynamic cables: choose the cable model \
         `catenary-dynamic`, or a model without vibration"
    )]
    Model,
    /// A drive has inertia, or its motor a control.
    #[error(
        "cable \"{cable}\" runs to a drive with inertia or control: the reduced model exists for drives that are \
         springs; use `frf` and `modes`, or hold the motors (winches clamped) and leave inertias out"
    )]
    Drive {
        /// Name of the cable.
        cable: String,
    },
    /// A signal belongs to a drive.
    #[error("the reduced model has no signals of drives: use `frf` for them")]
    DriveSignal,
    /// A signal is a motion of the frame.
    #[error("the reduced model has no motions of the base or of anchors: use `frf` for them")]
    FrameSignal,
    /// The motion of a point on a cable is not known.
    #[error(transparent)]
    CableMotion(#[from] CableMotionError),
    /// The full model has no response to compare with.
    #[error(transparent)]
    Response(#[from] ResponseError),
    /// The mass matrix is not positive definite.
    #[error(
        "the mass matrix of the reduced model is not positive definite: check masses and inertia of the robot file"
    )]
    Mass,
    /// A mode has no damping, so that its peak is not finite.
    #[error(
        "the natural frequency {frequency_hz} Hz has no damping: a response has no peak to which an error could be \
         related; give the ropes or the platform damping, or take the second-order form"
    )]
    Undamped {
        /// Frequency [Hz].
        frequency_hz: f64,
    },
    /// The equilibrium is unstable.
    #[error(
        "the equilibrium is unstable, so that it has no stable state space; choose another state, or take the \
         second-order form"
    )]
    Unstable,
    /// No input moves any output.
    #[error("no input moves any output below the limit: choose other inputs or outputs")]
    NoResponse,
    /// The eigenvalues of the damped modes are not found.
    #[error("the eigenvalues of the damped modes cannot be computed: choose a lower frequency limit")]
    Eigenvalues,
    /// Too few states for any mode.
    #[error("{0} states hold no mode: a mode needs two")]
    Order(usize),
    /// The observer has stopped the work.
    #[error("stopped before the end")]
    Stopped,
    /// No choice of modes keeps the tolerance.
    #[error(
        "no state space has an error of at most {requested:e} of the peaks: {order} states reach {reached:.2e}, because a \
         constant damping ratio has no exact state space or because of modes that are left out; choose a larger tolerance"
    )]
    Tolerance {
        /// Requested error.
        requested: f64,
        /// Smallest error.
        reached: f64,
        /// Number of states with this error.
        order: usize,
    },
}

/// Checks that no signal is one of a drive or a motion of the frame.
fn check_signals<'a>(signals: impl Iterator<Item = &'a Signal>) -> Result<(), ReductionError> {
    for signal in signals {
        match signal {
            Signal::Drive { .. } => return Err(ReductionError::DriveSignal),
            Signal::Frame(_) => return Err(ReductionError::FrameSignal),
            Signal::Along { .. } | Signal::About { .. } | Signal::OnCable { .. } => {}
        }
    }
    Ok(())
}

/// Checks that all cables are catenary-dynamic and end at fixed points or at springs.
fn check_cables(robot: &Robot, dynamics: &Dynamics) -> Result<(), ReductionError> {
    for term in dynamics.terms() {
        let DynamicCable::CatenaryDynamic(form) = term.form() else { return Err(ReductionError::Model) };
        if form.has_drive_mass() || form.has_drive_losses() {
            return Err(ReductionError::Drive { cable: robot.cables[term.cable()].name.clone() });
        }
    }
    Ok(())
}

impl ReductionError {
    /// True if the request is valid, but the robot has no such model.
    pub fn is_no_solution(&self) -> bool {
        matches!(
            self,
            Self::Undamped { .. } | Self::Unstable | Self::NoResponse | Self::Eigenvalues | Self::Tolerance { .. }
        )
    }
}

/// Ratios to the limit up to which clamped modes are kept unchanged, tried in turn until the error is small enough.
const KEPT: [f64; 7] = [1.1, 1.5, 2.0, 3.0, 5.0, 8.0, f64::INFINITY];

/// Number of frequencies at which the error of modes left out is measured, in addition to the natural frequencies.
const GRID: usize = 1000;

/// Steps for the responses of the full model, and for the tried numbers of clamped modes; the rest are for the error of
/// damping.
const FULL: Range<usize> = 0..10;
const TRIED: Range<usize> = 10..60;

/// Reduced model of a robot linearised about an equilibrium.
///
/// `report` gets the number of finished steps of [`STEPS`] during the work, and stops it by returning `false`.
///
/// # Errors
/// [`ReductionError`].
///
/// # References
/// R. R. Craig, M. C. C. Bampton, AIAA Journal 6(7), 1968; docs/theory.md, section 13.
pub fn reduce(
    robot: &Robot,
    equilibrium: &Equilibrium,
    dynamics: &Dynamics,
    inputs: &[Signal],
    outputs: &[(Signal, Quantity)],
    requested: RequestedModel,
    report: &mut dyn FnMut(usize) -> bool,
) -> Result<SecondOrder, ReductionError> {
    let mut steps = Steps::new(report);
    check_cables(robot, dynamics)?;
    check_signals(inputs.iter().chain(outputs.iter().map(|(signal, _)| signal)))?;

    // The response of a cable to a force on itself has a kink, which the kept modes cannot represent.
    let loaded = inputs.iter().any(|signal| matches!(signal, Signal::OnCable { .. }));
    let full = Channels::new(robot, equilibrium, dynamics, inputs, outputs, loaded)?;

    // Natural frequencies and responses of the full model, for comparison.
    let listed = modes::below(dynamics, requested.below_hz);
    steps.reached(&FULL, 1, 2)?;
    let natural: Vec<f64> = listed.modes.iter().map(|mode| mode.frequency_hz).collect();
    let mut frequencies: Vec<f64> =
        (1..=GRID).map(|i| requested.below_hz * i as f64 / GRID as f64).chain(natural.iter().copied()).collect();
    frequencies.sort_by(f64::total_cmp);
    let reference = full.responses(dynamics, &frequencies).ok();

    // As few clamped modes as the tolerance allows.
    for (tried, ratio) in KEPT.into_iter().enumerate() {
        steps.reached(&TRIED, tried, KEPT.len())?;
        let cut = dynamics.with_poles_below(ratio * requested.below_hz * TAU);
        let truncation_error = reference.as_ref().and_then(|reference| {
            let of_cut = Channels::new(robot, equilibrium, &cut, inputs, outputs, false).ok()?;
            Some(largest_difference(reference, &of_cut.responses(&cut, &frequencies).ok()?))
        });

        let reduced = modes::below(&cut, requested.below_hz * (1.0 + 1e-9));
        let frequency_error = relative_error(&natural, &reduced.modes);

        if truncation_error.unwrap_or(frequency_error) <= requested.tolerance || ratio.is_infinite() {
            let channels = Channels::new(robot, equilibrium, &cut, inputs, outputs, false)?;
            let mut model = assembled(&cut, &channels, outputs, requested)?;
            steps.reached(&TRIED, KEPT.len(), KEPT.len())?;
            (model.frequency_error, model.truncation_error) = (frequency_error, truncation_error);
            model.damping_error = match requested.damping_at {
                _ if !cut.has_damping_ratios() => Some(0.0),
                _ => damping_error(&model, &cut, &channels, &natural, &mut steps)?,
            };
            return Ok(model);
        }
    }
    unreachable!("the last ratio keeps all modes")
}

/// Maximum relative difference of frequencies; infinite if their numbers differ by more than one.
fn relative_error(natural: &[f64], others: &[modes::Mode]) -> f64 {
    // A frequency at the limit may lie on different sides of it.
    if others.len().abs_diff(natural.len()) > 1 {
        return f64::INFINITY;
    }
    natural.iter().zip(others).map(|(a, b)| (b.frequency_hz / a - 1.0).abs()).fold(0.0, f64::max)
}

/// Maximum difference of the responses over all frequencies, at each frequency relative to the largest entry there.
fn largest_difference(reference: &[Vec<Complex>], others: &[Vec<Complex>]) -> f64 {
    let count = reference.first().map_or(0, Vec::len);
    (0..count)
        .map(|k| {
            let size = reference.iter().map(|entry| entry[k].norm()).fold(0.0, f64::max);
            let gap = reference.iter().zip(others).map(|(a, b)| (a[k] - b[k]).norm()).fold(0.0, f64::max);
            if size > 0.0 { gap / size } else { 0.0 }
        })
        .fold(0.0, f64::max)
}

/// Ports of the inputs and outputs on the linearised robot.
struct Channels {
    inputs: Vec<Port>,
    outputs: Vec<Port>,
}

impl Channels {
    fn new(
        robot: &Robot,
        equilibrium: &Equilibrium,
        dynamics: &Dynamics,
        inputs: &[Signal],
        outputs: &[(Signal, Quantity)],
        loaded: bool,
    ) -> Result<Self, ReductionError> {
        let signals: Vec<Signal> = inputs.iter().copied().chain(outputs.iter().map(|(signal, _)| *signal)).collect();
        let mut inputs_first = Port::all(robot, equilibrium, dynamics, &signals, loaded)?;
        let outputs = inputs_first.split_off(inputs.len());
        Ok(Self { inputs: inputs_first, outputs })
    }

    /// Displacement of every output per force at every input, at all frequencies.
    fn responses(&self, dynamics: &Dynamics, frequencies_hz: &[f64]) -> Result<Vec<Vec<Complex>>, ResponseError> {
        let pairs = self.outputs.iter().flat_map(|output| self.inputs.iter().map(move |input| (input, output)));
        pairs
            .map(|(input, output)| response::between(dynamics, frequencies_hz, input, output, Quantity::Displacement))
            .collect()
    }

    /// Row of a port over the coordinates.
    fn row(port: &Port, dynamics: &Dynamics, layout: &Layout) -> Vec<f64> {
        let mut row = vec![0.0; layout.coordinates.len()];
        let coordinates = |vector: &Vec6| dynamics.coordinates().motion().reduced(vector);
        match port {
            Port::Platform(vector) => {
                row[..layout.dof].copy_from_slice(&coordinates(vector).as_slice()[..layout.dof]);
            }
            Port::Drive { .. } | Port::Frame(_) => unreachable!("signals of drives and of the frame are refused"),
            Port::Cable { stations, station, direction_w } => {
                let (platform, term, amplitudes) = stations.row(dynamics, *station, direction_w);
                row[..layout.dof].copy_from_slice(&coordinates(&platform).as_slice()[..layout.dof]);
                if let Some(term) = term {
                    let from = layout.first_of_term[term];
                    row[from..from + amplitudes.len()].copy_from_slice(&amplitudes);
                }
            }
        }
        row
    }
}

/// Order of the coordinates: the platform's, then per cable its clamped modes in plane and out of plane.
struct Layout {
    dof: usize,
    first_of_term: Vec<usize>,
    coordinates: Vec<Coordinate>,
}

impl Layout {
    fn new(dof: usize, cables: &[CableBlocks]) -> Self {
        let mut coordinates: Vec<Coordinate> = (0..dof).map(Coordinate::Platform).collect();
        let mut first_of_term = Vec::with_capacity(cables.len());
        for blocks in cables {
            first_of_term.push(coordinates.len());
            coordinates.extend(blocks.modes.iter().map(|mode| Coordinate::Clamped {
                cable: blocks.cable,
                out_of_plane: mode.out_of_plane,
                frequency_hz: mode.pole.sqrt() / TAU,
            }));
        }
        Self { dof, first_of_term, coordinates }
    }
}

/// Matrices over all coordinates.
struct Matrices {
    mass: DMat,
    /// Viscous damping.
    damping: DMat,
    /// Damping of cables with a constant damping ratio: the coefficient R of the damping `2ωR`.
    ratio: DMat,
    stiffness: DMat,
}

impl Matrices {
    /// Matrices of the platform alone, with n coordinates in total.
    fn of_platform(platform: &PlatformBlocks, n: usize) -> Self {
        let f = platform.mass.nrows();
        let at_corner = |block: &DMat| {
            let mut matrix = DMat::zeros(n, n);
            matrix.view_mut((0, 0), (f, f)).copy_from(block);
            matrix
        };
        Self {
            mass: at_corner(&platform.mass),
            damping: at_corner(&platform.damping),
            ratio: DMat::zeros(n, n),
            stiffness: at_corner(&platform.stiffness),
        }
    }

    /// Adds a cable; the coordinates of its clamped modes start at index `from`.
    fn add_cable(&mut self, cable: &CableBlocks, from: usize) {
        let f = cable.end_mass.nrows();
        let n = self.mass.nrows();

        // Stiffness of the end, and ω_k² of each clamped mode.
        let mut at_end = self.stiffness.view_mut((0, 0), (f, f));
        at_end += &cable.end_stiffness;
        for (k, mode) in cable.modes.iter().enumerate() {
            self.stiffness[(from + k, from + k)] = mode.pole;
        }

        // Mass of the end, 1 for each clamped mode, and the participation of the mode between both.
        let mut mass = DMat::zeros(n, n);
        mass.view_mut((0, 0), (f, f)).copy_from(&cable.end_mass);
        for (k, mode) in cable.modes.iter().enumerate() {
            let at = from + k;
            mass[(at, at)] = 1.0;
            for (i, g) in mode.participation.iter().enumerate() {
                mass[(i, at)] = *g;
                mass[(at, i)] = *g;
            }
        }

        // Damping acts where the mass is.
        match cable.damping {
            Damping::Viscous(c) => self.damping += &mass * (c / cable.mass_per_length),
            Damping::Ratio(xi) => self.ratio += &mass * xi,
        }
        self.mass += mass;
    }

    /// Viscous damping, including the replacement of constant ratios.
    fn all_damping(&self, at: DampingAt) -> Result<DMat, ReductionError> {
        let by_ratio = match at {
            DampingAt::Hz(hz) => &self.ratio * (2.0 * TAU * hz),
            DampingAt::NaturalFrequencies => at_natural_frequencies(&self.mass, &self.stiffness, &self.ratio)?,
        };
        Ok(&self.damping + by_ratio)
    }
}

/// Matrices of a linearised robot whose cables have only the poles to be kept, and their coordinates.
fn matrices(dynamics: &Dynamics) -> (Layout, Matrices) {
    let cables: Vec<CableBlocks> = dynamics.cable_blocks().collect();
    let layout = Layout::new(dynamics.dof(), &cables);

    let mut matrices = Matrices::of_platform(&dynamics.platform_blocks(), layout.coordinates.len());
    for (cable, from) in cables.iter().zip(&layout.first_of_term) {
        matrices.add_cable(cable, *from);
    }
    (layout, matrices)
}

/// Damping matrix without that of constant ratios, and the coefficient R of the damping `2ωR` by these.
fn viscous_damping_and_ratios(dynamics: &Dynamics) -> (DMat, DMat) {
    let (_, Matrices { damping, ratio, .. }) = matrices(dynamics);
    (damping, ratio)
}

/// Reduced model from a linearised robot whose cables have only the poles to be kept.
fn assembled(
    dynamics: &Dynamics,
    channels: &Channels,
    outputs: &[(Signal, Quantity)],
    requested: RequestedModel,
) -> Result<SecondOrder, ReductionError> {
    let (layout, mut matrices) = matrices(dynamics);
    let n = layout.coordinates.len();
    if dynamics.has_damping_ratios() {
        matrices.damping = matrices.all_damping(requested.damping_at)?;
    }

    let rows = |ports: &[Port]| {
        let all: Vec<f64> = ports.iter().flat_map(|port| Channels::row(port, dynamics, &layout)).collect();
        DMat::from_row_slice(ports.len(), n, &all)
    };
    let (input, output) = (rows(&channels.inputs).transpose(), rows(&channels.outputs));

    let Matrices { mass, damping, stiffness, .. } = matrices;
    if mass.clone().cholesky().is_none() {
        return Err(ReductionError::Mass);
    }
    Ok(SecondOrder {
        mass,
        damping,
        stiffness,
        input,
        output,
        quantities: outputs.iter().map(|(_, quantity)| *quantity).collect(),
        coordinates: layout.coordinates,
        below_hz: requested.below_hz,
        frequency_error: 0.0,
        truncation_error: None,
        damping_error: None,
    })
}

/// Viscous damping matrix that replaces `2ω R`: with the natural modes Φ, `ΦᵀMΦ = 1`, it is `2 MΦ W ΦᵀM` with
/// `W_jk = √ω_j (ΦᵀRΦ)_jk √ω_k`. It is correct at ω = ω_j = ω_k, also for the coupling of close modes.
fn at_natural_frequencies(mass: &DMat, stiffness: &DMat, ratio: &DMat) -> Result<DMat, ReductionError> {
    let factor = mass.clone().cholesky().ok_or(ReductionError::Mass)?.l();
    let half = factor.solve_lower_triangular(stiffness).ok_or(ReductionError::Mass)?;
    let standard = factor.solve_lower_triangular(&half.transpose()).ok_or(ReductionError::Mass)?;
    let eigen = standard.symmetric_eigen();

    // MΦ = L U; Φᵀ R Φ = Uᵀ L⁻¹ R L⁻ᵀ U.
    let half = factor.solve_lower_triangular(ratio).ok_or(ReductionError::Mass)?;
    let inner = factor.solve_lower_triangular(&half.transpose()).ok_or(ReductionError::Mass)?;
    let mut in_modes = eigen.eigenvectors.transpose() * inner * &eigen.eigenvectors;
    let roots: Vec<f64> = eigen.eigenvalues.iter().map(|square| square.max(0.0).sqrt().sqrt()).collect();
    for j in 0..roots.len() {
        for k in 0..roots.len() {
            in_modes[(j, k)] *= 2.0 * roots[j] * roots[k];
        }
    }
    let back = factor * eigen.eigenvectors;
    let damping = &back * in_modes * back.transpose();
    Ok(symmetric_part(&damping))
}

/// Maximum relative error of the responses by the viscous replacement of constant ratios, at natural frequencies.
fn damping_error(
    model: &SecondOrder,
    dynamics: &Dynamics,
    channels: &Channels,
    natural: &[f64],
    steps: &mut Steps<'_>,
) -> Result<Option<f64>, ReductionError> {
    // Maximum number of frequencies, spread over all natural frequencies, where the effect of damping is largest. Each
    // needs a full elimination.
    const MAX_FREQUENCIES: f64 = 48.0;
    // Maximum number of operations of all eliminations.
    const MAX_OPERATIONS: f64 = 2e9;
    let max = (MAX_OPERATIONS / (model.mass.nrows() as f64).powi(3)).clamp(4.0, MAX_FREQUENCIES) as usize;
    let every = natural.len().div_ceil(max).max(1);
    let frequencies: Vec<f64> = natural.iter().copied().step_by(every).collect();
    let Ok(reference) = channels.responses(dynamics, &frequencies) else { return Ok(None) };

    // Responses of the reduced model at these frequencies.
    let mut of_model = vec![Vec::new(); reference.len()];
    for (done, frequency_hz) in frequencies.iter().enumerate() {
        steps.reached(&(TRIED.end..STEPS), done, frequencies.len())?;
        let Some(receptance) = model.receptance(frequency_hz * TAU) else { return Ok(None) };
        let entries = (0..receptance.nrows()).flat_map(|i| (0..receptance.ncols()).map(move |j| (i, j)));
        for (list, at) in of_model.iter_mut().zip(entries) {
            list.push(receptance[at]);
        }
    }
    Ok(Some(largest_difference(&reference, &of_model)))
}

impl SecondOrder {
    /// Receptance `L (K + iωC − ω²M)⁻¹ B` of displacements at ω [rad/s]; `None` at an undamped resonance.
    pub fn receptance(&self, omega: f64) -> Option<CDMat> {
        let d = self
            .stiffness
            .zip_zip_map(&self.damping, &self.mass, |k, c, m| Complex::new(k - omega * omega * m, omega * c));
        let complex = |matrix: &DMat| matrix.map(Complex::from);
        Some(complex(&self.output) * d.lu().solve(&complex(&self.input))?)
    }

    /// State space of the model, with outputs of displacement, velocity or acceleration as in
    /// [`quantities`](Self::quantities).
    pub fn state_space(&self) -> StateSpace {
        let (n, inputs, outputs) = (self.mass.nrows(), self.input.ncols(), self.output.nrows());

        let factor = self.mass.clone().cholesky().expect("checked when it was made");
        let (by_motion, by_velocity) = (-factor.solve(&self.stiffness), -factor.solve(&self.damping));
        let by_force = factor.solve(&self.input);

        // State.
        let mut a = DMat::zeros(2 * n, 2 * n);
        a.view_mut((0, n), (n, n)).fill_with_identity();
        a.view_mut((n, 0), (n, n)).copy_from(&by_motion);
        a.view_mut((n, n), (n, n)).copy_from(&by_velocity);

        // Input.
        let mut b = DMat::zeros(2 * n, inputs);
        b.view_mut((n, 0), (n, inputs)).copy_from(&by_force);

        // Outputs.
        let (mut c, mut d) = (DMat::zeros(outputs, 2 * n), DMat::zeros(outputs, inputs));
        for (i, quantity) in self.quantities.iter().enumerate() {
            let row = self.output.rows(i, 1);
            match quantity {
                Quantity::Displacement => c.view_mut((i, 0), (1, n)).copy_from(&row),
                Quantity::Velocity => c.view_mut((i, n), (1, n)).copy_from(&row),
                Quantity::Acceleration => {
                    c.view_mut((i, 0), (1, n)).copy_from(&(row * &by_motion));
                    c.view_mut((i, n), (1, n)).copy_from(&(row * &by_velocity));
                    d.view_mut((i, 0), (1, inputs)).copy_from(&(row * &by_force));
                }
            }
        }
        StateSpace { a, b, c, d }
    }
}

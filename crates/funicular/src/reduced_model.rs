//! Small second-order model of the robot, `M ẍ + C ẋ + K x = B f`, `y = L x`, for control design.
//!
//! The coordinates are the platform's motion, the amplitudes of the cables' clamped modes and the displacements of flexible
//! supports. They represent
//! catenary-dynamic cables without approximation: K is block diagonal, M couples the platform to each amplitude. The
//! model has two approximations. Three modes of each cable replace all modes above the limit, and a constant damping
//! ratio is replaced by viscous damping. Both errors are measured against the full model. Derivation: docs/theory.md,
//! section 13.

mod candidates;
mod control_model;
mod error;
mod expansion;
mod massless;
mod reference;
mod selection;
mod steps;
mod terms;

pub use steps::STEPS;

pub use control_model::{
    ControlModel, ModalStates, PointwiseError, RequestedStateSpace, ResponseOfPair, control_model,
};
pub use error::ReductionError;
pub use selection::Size;

use crate::cable::catenary_dynamic::{DriveSignal, EndSignal, InPowersOfS};
use crate::cable::{CableModel, DynamicCable};
use crate::dynamics::{CableBlocks, CableRow, Dynamics, PlatformBlocks, SupportBlocks};
use crate::math::{CDMat, Complex, DMat, DVec, Vec3, Vec6, symmetric_part};
use crate::modes;
use crate::response::{self, FrameInput, Port, Quantity, ResponseError, Signal};
use crate::robot::{Damping, Robot};
use crate::statics::Equilibrium;
use expansion::Expansion;
use massless::Massless;
use std::array::from_fn;
use std::f64::consts::TAU;
use std::ops::Range;
use steps::Steps;

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
    /// Amplitude of a clamped mode of a cable with its drive, of unit modal mass [m √kg].
    Clamped {
        /// Index of the cable, in the order of the file.
        cable: usize,
        /// True for a mode out of the cable's plane.
        out_of_plane: bool,
        /// Clamped frequency [Hz]; the last modes of a cable replace all the others.
        frequency_hz: f64,
    },
    /// Displacement of a flexible support along an axis of the world [m], relative to its foot.
    Support {
        /// Index of the support, in the order of [`Robot::supports`].
        support: usize,
        /// Axis: 0, 1 or 2.
        axis: usize,
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
    /// Input matrix B, n×inputs: generalised force per unit of each input.
    pub input: DMat,
    /// Matrices B₁ and B₂, n×inputs: generalised force per rate and per acceleration of each input. They are zero except
    /// for a commanded length and a motion of the frame.
    pub input_rates: [DMat; 2],
    /// Output matrix L, outputs×n: displacements, rotations and tensions.
    pub output: DMat,
    /// Matrices L₁ and L₂, outputs×n: outputs per velocity and per acceleration of the coordinates. They are zero except
    /// for the tension of a cable.
    pub output_rates: [DMat; 2],
    /// Matrices D₀, D₁ and D₂, outputs×inputs: outputs per input, its rate and its acceleration with all coordinates at
    /// rest. They are zero except for signals of the drive of one cable, and for outputs on cables by a motion of the frame.
    pub feedthrough: [DMat; 3],
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

/// Fraction of its static response above which a part of a drive has no mass; rounding leaves 1e-9.
const MASSLESS: f64 = 1e-6;

/// Checks that all cables are catenary-dynamic and that the losses of their drives have a second-order form.
fn check_cables(robot: &Robot, dynamics: &Dynamics) -> Result<(), ReductionError> {
    let name = |cable: usize| robot.cables[cable].name.clone();
    for term in dynamics.terms() {
        let DynamicCable::CatenaryDynamic(form) = term.form() else { return Err(ReductionError::Model) };
        if dynamics.linearisation.cable_model == CableModel::ShallowDynamic {
            return Err(ReductionError::Model);
        }
        let delay_s = form.delay();
        if delay_s > 0.0 {
            return Err(ReductionError::Delay { cable: name(term.cable()), delay_s });
        }
    }
    for blocks in dynamics.cable_blocks() {
        if blocks.drive.iter().any(|part| part.damping > 0.0 && part.massless > MASSLESS) {
            return Err(ReductionError::Massless { cable: name(blocks.cable) });
        }
    }
    Ok(())
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
    let ends = full.at_far_ends(dynamics);
    let kinds = pair_kinds(inputs, outputs);
    for (tried, ratio) in KEPT.into_iter().enumerate() {
        steps.reached(&TRIED, tried, KEPT.len())?;
        let cut = dynamics.with_poles_below(ratio * requested.below_hz * TAU, &ends);
        let truncation_error = reference.as_ref().and_then(|reference| {
            let of_cut = Channels::new(robot, equilibrium, &cut, inputs, outputs, false).ok()?;
            Some(largest_difference(reference, &of_cut.responses(&cut, &frequencies).ok()?, &kinds))
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
                _ => damping_error(&model, &cut, &channels, &kinds, &natural, &mut steps)?,
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

/// Kind of each response, the pairs of the first output with all inputs first. Responses of one kind have comparable
/// sizes: motion or tension, per force, per commanded length or displacement of the frame, or per rotation of the base.
fn pair_kinds(inputs: &[Signal], outputs: &[(Signal, Quantity)]) -> Vec<usize> {
    let of_input = |signal: &Signal| match signal {
        Signal::Drive { signal: DriveSignal::Length, .. }
        | Signal::Frame(FrameInput::BaseAlong(_) | FrameInput::Anchor { .. }) => 1,
        Signal::Frame(FrameInput::BaseAbout(_)) => 2,
        Signal::Drive { .. } | Signal::Along { .. } | Signal::About { .. } | Signal::OnCable { .. } => 0,
    };
    let is_tension = |signal: &Signal| matches!(signal, Signal::Drive { signal, .. } if signal.is_tension());
    let kind = |input: &Signal, output: &Signal| 3 * usize::from(is_tension(output)) + of_input(input);
    outputs.iter().flat_map(|(output, _)| inputs.iter().map(move |input| kind(input, output))).collect()
}

/// Maximum difference of the responses over all frequencies, at each frequency relative to the largest entry of its kind
/// there.
fn largest_difference(reference: &[Vec<Complex>], others: &[Vec<Complex>], kinds: &[usize]) -> f64 {
    let count = reference.first().map_or(0, Vec::len);
    let of_kind = |kind: usize, k: usize| {
        let pairs = || reference.iter().zip(others).zip(kinds).filter(|(_, of)| **of == kind).map(|(pair, _)| pair);
        let size = pairs().map(|(entry, _)| entry[k].norm()).fold(0.0, f64::max);
        let gap = pairs().map(|(a, b)| (a[k] - b[k]).norm()).fold(0.0, f64::max);
        if size > 0.0 { gap / size } else { 0.0 }
    };
    let last = kinds.iter().copied().max().unwrap_or(0);
    (0..count).flat_map(|k| (0..=last).map(move |kind| (kind, k))).map(|(kind, k)| of_kind(kind, k)).fold(0.0, f64::max)
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
        let outputs: Vec<_> = self.outputs.iter().map(|port| (port.clone(), Quantity::Displacement)).collect();
        response::matrix(dynamics, frequencies_hz, &self.inputs, &outputs)
    }

    /// Row of a port over the coordinates, in powers of s.
    fn row(port: &Port, dynamics: &Dynamics, layout: &Layout) -> InPowersOfS<Vec<f64>> {
        let zeros = || vec![0.0; layout.coordinates.len()];
        let mut row = [zeros(), zeros(), zeros()];
        let coordinates = |vector: &Vec6| dynamics.coordinates().motion().reduced(vector);
        match port {
            Port::Platform(vector) => {
                row[0][..layout.dof].copy_from_slice(&coordinates(vector).as_slice()[..layout.dof]);
            }
            Port::Drive { term, signal, .. } => {
                let Some(powers) = dynamics.drive_signal_row(*term, *signal) else {
                    unreachable!("a port has a signal of its drive")
                };
                for (row, of_cable) in row.iter_mut().zip(&powers) {
                    layout.add_row(of_cable, *term, 1.0, row);
                }
            }
            Port::Frame(frame) => {
                row[0][..layout.dof].copy_from_slice(&coordinates(frame.constant()).as_slice()[..layout.dof]);
                if let Some(supports) = dynamics.supports() {
                    let (constant, feet) = frame.on_feet();
                    row[0][layout.first_support..].copy_from_slice(constant);
                    row[2][layout.first_support..].copy_from_slice(&supports.inertia_of_feet(feet));
                }
                for (term, motion) in frame.carriers() {
                    let Some(powers) = dynamics.carrier_row(term, motion) else {
                        unreachable!("other models were refused")
                    };
                    for (row, of_cable) in row.iter_mut().zip(&powers) {
                        layout.add_row(of_cable, term, 1.0, row);
                    }
                }
            }
            Port::Cable { stations, station, direction_w } => {
                let (platform, term, amplitudes) = stations.row(dynamics, *station, direction_w);
                row[0][..layout.dof].copy_from_slice(&coordinates(&platform).as_slice()[..layout.dof]);
                if let Some(term) = term {
                    let from = layout.first_of_term[term];
                    row[0][from..from + amplitudes.len()].copy_from_slice(&amplitudes);
                }
                let axes = [Vec3::x(), Vec3::y(), Vec3::z()];
                let by_far_end = axes.map(|axis| stations.still_by_far_end(*station, direction_w, &axis));
                let on_supports = dynamics.station_row_on_supports(stations.cable, by_far_end, &amplitudes);
                row[0][layout.first_support..].copy_from_slice(&on_supports);
            }
        }
        row
    }

    /// Matrices of ports by powers of s, one row per port.
    fn rows(ports: &[Port], dynamics: &Dynamics, layout: &Layout) -> InPowersOfS<DMat> {
        let rows: Vec<_> = ports.iter().map(|port| Self::row(port, dynamics, layout)).collect();
        from_fn(|power| DMat::from_fn(ports.len(), layout.coordinates.len(), |i, j| rows[i][power][j]))
    }

    /// Signals at the far ends of cables: index of the cable, and signal.
    fn at_far_ends(&self, dynamics: &Dynamics) -> Vec<(usize, EndSignal)> {
        let of_port = |port: &Port| match port {
            Port::Drive { term, signal, .. } => vec![(*term, EndSignal::Drive(*signal))],
            Port::Frame(frame) => frame.carriers().map(|(term, motion)| (term, EndSignal::Carrier(*motion))).collect(),
            Port::Platform(_) | Port::Cable { .. } => Vec::new(),
        };
        let all = self.inputs.iter().chain(&self.outputs).flat_map(of_port);
        all.map(|(term, signal)| (dynamics.terms()[term].cable(), signal)).collect()
    }

    /// Outputs per inputs with all coordinates at rest, in powers of s, outputs×inputs. Input and output of the drive of
    /// one cable have such a part, and so has an output on a cable whose far end the input moves.
    fn direct(&self, dynamics: &Dynamics) -> InPowersOfS<DMat> {
        let entry = |output: &Port, input: &Port| match (input, output) {
            (Port::Drive { term, signal: input, .. }, Port::Drive { term: of_output, signal: output, .. })
                if term == of_output =>
            {
                dynamics.direct_drive_signal(*term, *input, *output).unwrap_or_default()
            }
            (Port::Frame(frame), Port::Drive { term, signal, .. }) => {
                let moved = frame.carriers().find(|(of, _)| of == term);
                moved.and_then(|(_, motion)| dynamics.direct_by_carrier(*term, motion, *signal)).unwrap_or_default()
            }
            (Port::Drive { term, signal, .. }, Port::Cable { stations, station, direction_w })
            | (Port::Cable { stations, station, direction_w }, Port::Drive { term, signal, .. })
                if dynamics.terms()[*term].cable() == stations.cable =>
            {
                [stations.still_by_ends(*station, direction_w, dynamics.ends_of_signal(*term, *signal)), 0.0, 0.0]
            }
            (Port::Frame(frame), Port::Cable { stations, station, direction_w }) => {
                [frame.still_of_station(stations, *station, direction_w), 0.0, 0.0]
            }
            _ => [0.0; 3],
        };
        let size = (self.outputs.len(), self.inputs.len());
        from_fn(|power| DMat::from_fn(size.0, size.1, |o, i| entry(&self.outputs[o], &self.inputs[i])[power]))
    }
}

/// Order of the coordinates: the platform's, then per cable its clamped modes in plane and out of plane, then the supports.
struct Layout {
    dof: usize,
    first_of_term: Vec<usize>,
    /// First coordinate of the supports.
    first_support: usize,
    coordinates: Vec<Coordinate>,
}

impl Layout {
    /// Order for a robot with this number of support coordinates.
    fn new(dof: usize, cables: &[CableBlocks], supports: usize) -> Self {
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
        let first_support = coordinates.len();
        coordinates.extend((0..supports).map(|i| Coordinate::Support { support: i / 3, axis: i % 3 }));
        Self { dof, first_of_term, first_support, coordinates }
    }

    /// Index of a coordinate of the ends: the platform's, then those of the supports.
    fn end(&self, i: usize) -> usize {
        if i < self.dof { i } else { self.first_support + i - self.dof }
    }

    /// Adds `factor` times a row of a cable, given by its index among the terms, to a row over all coordinates.
    fn add_row(&self, of_cable: &CableRow, term: usize, factor: f64, row: &mut [f64]) {
        let at_modes = &mut row[self.first_of_term[term]..][..of_cable.modes.len()];
        at_modes.iter_mut().zip(&of_cable.modes).for_each(|(sum, entry)| *sum += factor * entry);
        of_cable.ends.iter().enumerate().for_each(|(i, entry)| row[self.end(i)] += factor * entry);
    }
}

/// Matrices over all coordinates.
struct Matrices {
    mass: DMat,
    /// Viscous damping.
    damping: DMat,
    /// Damping of cables with a constant damping ratio: the coefficient R of the damping `2ωR`.
    ratio: DMat,
    /// Imaginary part of the stiffness of supports with a constant damping ratio.
    loss: DMat,
    stiffness: DMat,
    /// Mass of the drives; part of `mass`.
    drives: DMat,
    /// Motions of drives on which losses act.
    lossy: Vec<Vec<f64>>,
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
            loss: DMat::zeros(n, n),
            stiffness: at_corner(&platform.stiffness),
            drives: DMat::zeros(n, n),
            lossy: Vec::new(),
        }
    }

    /// Adds the flexible supports.
    fn add_supports(&mut self, supports: &SupportBlocks, layout: &Layout) {
        let (at, count) = (layout.first_support, supports.mass.nrows());
        let parts = [
            (&mut self.stiffness, &supports.stiffness),
            (&mut self.mass, &supports.mass),
            (&mut self.loss, &supports.loss),
        ];
        for (matrix, block) in parts {
            let mut view = matrix.view_mut((at, at), (count, count));
            view += block;
        }
        let mut view = self.stiffness.view_mut((0, at), (layout.dof, count));
        view += &supports.coupling;
        let mut view = self.stiffness.view_mut((at, 0), (count, layout.dof));
        view += &supports.coupling.transpose();
    }

    /// Adds a cable, given by its index among the terms.
    fn add_cable(&mut self, cable: &CableBlocks, term: usize, layout: &Layout) {
        let f = cable.end_mass.nrows();
        let n = self.mass.nrows();
        let from = layout.first_of_term[term];

        // Stiffness of the ends, and ω_k² of each clamped mode.
        for (i, j) in (0..f).flat_map(|i| (0..f).map(move |j| (i, j))) {
            self.stiffness[(layout.end(i), layout.end(j))] += cable.end_stiffness[(i, j)];
        }
        for (k, mode) in cable.modes.iter().enumerate() {
            self.stiffness[(from + k, from + k)] = mode.pole;
        }

        // Mass of the ends, 1 for each clamped mode, and the participation of the mode between both.
        let mut mass = DMat::zeros(n, n);
        for (i, j) in (0..f).flat_map(|i| (0..f).map(move |j| (i, j))) {
            mass[(layout.end(i), layout.end(j))] = cable.end_mass[(i, j)];
        }
        for (k, mode) in cable.modes.iter().enumerate() {
            let at = from + k;
            mass[(at, at)] = 1.0;
            for (i, g) in mode.participation.iter().enumerate() {
                mass[(layout.end(i), at)] = *g;
                mass[(at, layout.end(i))] = *g;
            }
        }

        // The drive: its mass, which is part of that of the modes, and its losses.
        let mut rope = mass.clone();
        for part in &cable.drive {
            let mut row = vec![0.0; n];
            layout.add_row(&part.row, term, 1.0, &mut row);
            let row = DVec::from_vec(row);
            let product = &row * row.transpose();
            rope -= &product * part.mass;
            self.drives += &product * part.mass;
            if part.damping > 0.0 {
                self.damping += product * part.damping;
                self.lossy.push(row.as_slice().to_vec());
            }
        }

        // Damping of the rope acts where its mass is.
        match cable.damping {
            Damping::Viscous(c) => self.damping += &rope * (c / cable.mass_per_length),
            Damping::Ratio(xi) => self.ratio += &rope * xi,
        }
        self.mass += mass;
    }

    /// Viscous damping, including the replacement of constant ratios.
    fn all_damping(&self, at: DampingAt) -> Result<DMat, ReductionError> {
        let by_ratio = match at {
            DampingAt::Hz(hz) => &self.ratio * (2.0 * TAU * hz) + &self.loss / (TAU * hz),
            DampingAt::NaturalFrequencies => {
                at_natural_frequencies(&self.mass, &self.stiffness, &self.ratio, &self.loss)?
            }
        };
        Ok(&self.damping + by_ratio)
    }
}

/// Matrices of a linearised robot whose cables have only the poles to be kept, the order of all coordinates, and the supports
/// without mass, which the matrices do not contain.
fn matrices(dynamics: &Dynamics) -> (Layout, Matrices, Option<Massless>) {
    let cables: Vec<CableBlocks> = dynamics.cable_blocks().collect();
    let supports = dynamics.support_blocks();
    let layout = Layout::new(dynamics.dof(), &cables, supports.as_ref().map_or(0, |blocks| blocks.mass.nrows()));

    let mut matrices = Matrices::of_platform(&dynamics.platform_blocks(), layout.coordinates.len());
    if let Some(supports) = &supports {
        matrices.add_supports(supports, &layout);
    }
    for (term, cable) in cables.iter().enumerate() {
        matrices.add_cable(cable, term, &layout);
    }
    let massless = Massless::of(&matrices, &layout);
    let matrices = match &massless {
        Some(massless) => massless.reduced(matrices),
        None => matrices,
    };
    (layout, matrices, massless)
}

/// Reduced model from a linearised robot whose cables have only the poles to be kept.
fn assembled(
    dynamics: &Dynamics,
    channels: &Channels,
    measured: &[(Signal, Quantity)],
    requested: RequestedModel,
) -> Result<SecondOrder, ReductionError> {
    let (mut layout, mut matrices, massless) = matrices(dynamics);
    if dynamics.has_damping_ratios() {
        matrices.damping = matrices.all_damping(requested.damping_at)?;
    }

    let mut inputs = Channels::rows(&channels.inputs, dynamics, &layout);
    let mut outputs = Channels::rows(&channels.outputs, dynamics, &layout);
    let mut feedthrough = channels.direct(dynamics);
    if let Some(massless) = &massless {
        let added = massless.direct(&outputs, &inputs);
        feedthrough.iter_mut().zip(added).for_each(|(sum, added)| *sum += added);
        (inputs, outputs) = (massless.rows(inputs), massless.rows(outputs));
        layout.coordinates = massless.kept(&layout.coordinates);
    }
    let [input, input_rate, input_acceleration] = inputs.map(|rows| rows.transpose());
    let [output, output_rate, output_acceleration] = outputs;

    let Matrices { mass, damping, stiffness, .. } = matrices;
    if mass.clone().cholesky().is_none() {
        return Err(ReductionError::Mass);
    }
    Ok(SecondOrder {
        mass,
        damping,
        stiffness,
        input,
        input_rates: [input_rate, input_acceleration],
        output,
        output_rates: [output_rate, output_acceleration],
        feedthrough,
        quantities: measured.iter().map(|(_, quantity)| *quantity).collect(),
        coordinates: layout.coordinates,
        below_hz: requested.below_hz,
        frequency_error: 0.0,
        truncation_error: None,
        damping_error: None,
    })
}

/// Viscous damping matrix that replaces `2ω R + S/ω`: with the natural modes Φ, `ΦᵀMΦ = 1`, it is `MΦ W ΦᵀM` with
/// `W_jk = 2 √ω_j (ΦᵀRΦ)_jk √ω_k + (ΦᵀSΦ)_jk/√(ω_jω_k)`. It is correct at ω = ω_j = ω_k, also for the coupling of close modes.
/// R belongs to cables with a constant damping ratio, S to supports.
fn at_natural_frequencies(mass: &DMat, stiffness: &DMat, ratio: &DMat, loss: &DMat) -> Result<DMat, ReductionError> {
    let factor = mass.clone().cholesky().ok_or(ReductionError::Mass)?.l();
    let half = factor.solve_lower_triangular(stiffness).ok_or(ReductionError::Mass)?;
    let standard = factor.solve_lower_triangular(&half.transpose()).ok_or(ReductionError::Mass)?;
    let eigen = standard.symmetric_eigen();

    // MΦ = L U; Φᵀ R Φ = Uᵀ L⁻¹ R L⁻ᵀ U.
    let of_modes = |matrix: &DMat| {
        let half = factor.solve_lower_triangular(matrix).ok_or(ReductionError::Mass)?;
        let inner = factor.solve_lower_triangular(&half.transpose()).ok_or(ReductionError::Mass)?;
        Ok::<_, ReductionError>(eigen.eigenvectors.transpose() * inner * &eigen.eigenvectors)
    };
    let mut in_modes = of_modes(ratio)?;
    let roots: Vec<f64> = eigen.eigenvalues.iter().map(|square| square.max(0.0).sqrt().sqrt()).collect();
    for j in 0..roots.len() {
        for k in 0..roots.len() {
            in_modes[(j, k)] *= 2.0 * roots[j] * roots[k];
        }
    }
    if loss.amax() > 0.0 {
        // An unstable direction has no frequency at which the damping could be correct.
        let inverse = |root: f64| if root > 0.0 { root.recip() } else { 0.0 };
        in_modes += of_modes(loss)?.map_with_location(|j, k, entry| entry * inverse(roots[j]) * inverse(roots[k]));
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
    kinds: &[usize],
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
    Ok(Some(largest_difference(&reference, &of_model, kinds)))
}

impl SecondOrder {
    /// Inputs in powers of s: B, B₁ and B₂.
    pub(crate) fn inputs(&self) -> InPowersOfS<&DMat> {
        [&self.input, &self.input_rates[0], &self.input_rates[1]]
    }

    /// Outputs in powers of s: L, L₁ and L₂.
    pub(crate) fn outputs(&self) -> InPowersOfS<&DMat> {
        [&self.output, &self.output_rates[0], &self.output_rates[1]]
    }

    /// Response `L (K + iωC − ω²M)⁻¹ B` of displacements at ω [rad/s], with B, L and the feedthrough as polynomials of
    /// iω; `None` at an undamped resonance.
    pub fn receptance(&self, omega: f64) -> Option<CDMat> {
        let d = self
            .stiffness
            .zip_zip_map(&self.damping, &self.mass, |k, c, m| Complex::new(k - omega * omega * m, omega * c));
        let s = Complex::new(0.0, omega);
        let [direct, by_rate, by_acceleration] = &self.feedthrough;
        let solved = d.lu().solve(&polynomial(&self.inputs(), s))?;
        Some(polynomial(&self.outputs(), s) * solved + polynomial(&[direct, by_rate, by_acceleration], s))
    }

    /// State space of the model, with outputs of displacement, velocity or acceleration as in
    /// [`quantities`](Self::quantities). With inputs that act by their rates the first states are the coordinates
    /// without the part that follows the input at once.
    ///
    /// # Errors
    /// [`ReductionError::Improper`] if an output contains the rate of an input, such as the acceleration of the platform
    /// by the commanded length of a motor with a speed gain.
    pub fn state_space(&self) -> Result<StateSpace, ReductionError> {
        let expansion = Expansion::of(self);
        if let Some((output, input)) = expansion.improper() {
            return Err(ReductionError::Improper { output: output + 1, input: input + 1 });
        }
        let Expansion { a, b, c, direct, .. } = expansion;
        let d = direct.into_iter().next().unwrap_or_else(|| DMat::zeros(c.nrows(), b.ncols()));
        Ok(StateSpace { a, b, c, d })
    }
}

/// Value of a polynomial with matrix coefficients at s.
fn polynomial(coefficients: &InPowersOfS<&DMat>, s: Complex) -> CDMat {
    let [constant, by_rate, by_acceleration] = coefficients;
    constant.zip_zip_map(by_rate, by_acceleration, |c, r, a| c + s * r + s * s * a)
}

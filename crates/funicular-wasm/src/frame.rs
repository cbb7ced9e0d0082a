//! Results for one frame of an animation, as numbers in memory instead of JSON.
//!
//! A [`Session`] keeps a robot. [`Session::frame`] solves its statics and vibration at a state and writes pose,
//! tensions, curves of the cables and lowest natural frequencies into one list of numbers. The analyses and their
//! defaults are those of the commands `statics` and `modes`; only the list of modes ends where enough are found.
//! [`Session::platform`] continues the list up to the first mode of the platform. After a refused state there is no
//! frame, so that no mode or response of another state is taken for one of it.
//!
//! The list begins with [`HEADER`] numbers. Then come, without gaps, [`CABLE`] numbers per cable, three coordinates per
//! point of the cables, and [`MODE`] numbers per mode, followed by the energy fractions of the cables. [`layout`]
//! has the meaning of each number.

use crate::layout;
use anyhow::{Result, anyhow, bail};
use funicular::cable_motion::CableStations;
use funicular::clearance::Surroundings;
use funicular::dynamics::{Dynamics, Linearisation};
use funicular::math::Vec3;
use funicular::modes::{self, LowestError, Mode, Modes, PlatformModeError};
use funicular::response;
use funicular::robot::{self, Body, PlatformMotion, Robot, State};
use funicular::statics;
use funicular_study::analyses::workspace::WorkspaceReach;
use funicular_study::analyses::{calibrate, check, frf};
use funicular_study::at_rest::{self, AtRest};
use funicular_study::request::{self, FrfRequest, MAX_HZ, Pose, StiffnessRequest, WorkspaceRequest};
use funicular_study::sweep::no_platform_mode;
use funicular_study::wording::Words;
use funicular_study::{NoSolution, Request, Silent};
use serde_json::{Value, json};

pub use crate::layout::{CABLE, HEADER, MODE};

/// Maximum number of modes per frame: with more, a frame takes too long for an animation.
pub const MAX_MODES: usize = 500;

/// Maximum number of points per cable.
pub const MAX_POINTS: usize = 1000;

/// Factor on the highest frequency of the last frame, which gives the limit of the next list of modes. From frame to
/// frame frequencies change by some per cent: at 1.0 every second list has too few modes and is computed twice, and at
/// 1.5 it has half as many modes too many.
const LIMIT_FACTOR: f64 = 1.08;

/// Message for what needs a frame.
const NO_FRAME: &str = "there is no frame, or the last one was refused: compute one first";

/// State at which a frame is computed.
#[derive(Debug, Clone, PartialEq)]
pub enum FrameState {
    /// State of the request, or else of the robot file.
    OfRequest,
    /// Pose of the platform.
    Pose(Pose),
    /// Unstrained lengths [m], one per cable. With a pose the search begins there, and of several equilibria it finds
    /// the one to which the platform moves from it.
    Lengths(Vec<f64>, Option<Pose>),
}

impl FrameState {
    /// State from its kind and its numbers: 0, the state of the request, without numbers; 1, a pose, as position [m],
    /// position and roll, pitch, yaw [degrees], or position and quaternion w, x, y, z; 2, unstrained lengths [m]; 3,
    /// the seven numbers of a pose from which the search starts, then unstrained lengths.
    ///
    /// # Errors
    /// Another kind or count, or a number that is not finite.
    pub fn of_numbers(kind: u32, numbers: &[f64]) -> Result<Self> {
        if let Some(number) = numbers.iter().find(|number| !number.is_finite()) {
            bail!("the state contains {number}: give finite numbers");
        }
        Ok(match (kind, numbers) {
            (0, []) => Self::OfRequest,
            (1, [x, y, z]) => Self::Pose(Pose::Angles([*x, *y, *z, 0.0, 0.0, 0.0])),
            (1, [x, y, z, roll, pitch, yaw]) => Self::Pose(Pose::Angles([*x, *y, *z, *roll, *pitch, *yaw])),
            (1, [_, _, _, _, _, _, _]) => Self::Pose(pose_of(numbers)),
            (2, lengths) => Self::Lengths(lengths.to_vec(), None),
            (3, [_, _, _, _, _, _, _, lengths @ ..]) => Self::Lengths(lengths.to_vec(), Some(pose_of(numbers))),
            _ => bail!(
                "kind {kind} of a state does not go with {} numbers: give 0 and none, 1 and 3, 6 or 7 numbers of a \
                 pose, 2 and one length per cable, or 3, 7 numbers of a pose and one length per cable",
                numbers.len()
            ),
        })
    }
}

/// Pose of the first seven numbers: position [m] and quaternion w, x, y, z.
fn pose_of(numbers: &[f64]) -> Pose {
    Pose::Quaternion(std::array::from_fn(|k| numbers[k]), std::array::from_fn(|k| numbers[3 + k]))
}

/// Size of a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FrameSize {
    /// Number of lowest natural frequencies; zero for statics alone.
    pub modes: usize,
    /// Number of points per cable, ends included; zero for none.
    pub points: usize,
}

impl FrameSize {
    fn check(self) -> Result<()> {
        let Self { modes, points } = self;
        if modes > MAX_MODES || points > MAX_POINTS || points == 1 {
            bail!(
                "{modes} modes and {points} points: give at most {MAX_MODES} modes, and 0 or 2 to {MAX_POINTS} points"
            );
        }
        Ok(())
    }
}

/// Robot with the options of its analyses, and its last frame.
pub struct Session {
    request: StiffnessRequest,
    robot: Robot,
    /// None before the first frame and after a refused one.
    last: Option<Frame>,
    /// Rays to the border of the workspace, from the first call on.
    reach: Option<WorkspaceReach>,
    /// Natural frequencies of the last list [Hz], also after a refused frame: they say where the next list may end.
    known_hz: Vec<f64>,
}

/// Last frame, for the shapes of its modes and for responses.
struct Frame {
    at_rest: AtRest,
    vibration: Option<(Dynamics, Modes)>,
}

/// Numbers and text of an answer.
#[derive(Debug, Default)]
pub struct Answer {
    /// Numbers.
    pub numbers: Vec<f64>,
    /// JSON with the words that belong to the numbers.
    pub text: String,
}

impl Session {
    /// Reads the robot of a request with the keys of `stiffness`. The text of the answer describes the robot.
    ///
    /// # Errors
    /// A request or robot file that has to change.
    pub fn new(request: Request) -> Result<(Self, Answer)> {
        let Request::Stiffness(request) = request else {
            bail!("`{}` is not a request for frames: give the keys of `stiffness`", request.command())
        };
        let file = request.robot.read()?;
        let robot = at_rest::with_limits(&at_rest::with_state(file.robot.clone(), &request.state)?, &request.tensions)?;
        let answer = Answer { numbers: Vec::new(), text: description(&robot, &file.text).to_string() };
        Ok((Self { request, robot: file.robot, last: None, reach: None, known_hz: Vec::new() }, answer))
    }

    /// Solves the robot at a state, whose error is passed on.
    ///
    /// # Errors
    /// A state that the robot cannot have, or a robot without such an equilibrium. There is no frame then.
    pub fn frame(&mut self, state: Result<FrameState>, size: FrameSize) -> Result<Answer> {
        self.last = None;
        let state = state?;
        size.check()?;
        let at_rest = self.at_rest(state)?;

        // Without modes the equilibrium is still a frame; the text says why they are missing.
        let linearisation = at_rest::linearisation(&self.request.model, at_rest.equilibrium.model);
        let found = match size.modes {
            0 => Ok(None),
            count => self.modes(&at_rest, linearisation, count).map(Some),
        };
        let reason = found.as_ref().err().map(|error| funicular_study::wording::message(error, Words::Json));
        let vibration = found.ok().flatten();

        let numbers = numbers(&at_rest, vibration.as_ref().map(|(_, modes)| modes), size);
        let text = json!({
            "no_modes": reason,
            "clearance": nearest(&at_rest),
            "platform_frequency_hz": vibration.as_ref().and_then(|(dynamics, _)| dynamics.platform_frequency()),
            "tension_rule": at_rest.rule.as_ref().map(statics::TensionRule::name),
            "static_model": at_rest.equilibrium.model.name(),
            "cable_model": linearisation.cable_model.name(),
        });
        if let Some((_, modes)) = &vibration {
            self.known_hz = modes.modes.iter().map(|mode| mode.frequency_hz).collect();
        }
        self.last = Some(Frame { at_rest, vibration });
        Ok(Answer { numbers, text: text.to_string() })
    }

    /// Continues the list of modes of the last frame up to the first mode of the platform, however many modes of the
    /// cables lie below it: the numbers of all these modes, as in a frame. They are the list of the frame then.
    ///
    /// # Errors
    /// No frame, or no such mode within the limits of the search.
    pub fn platform(&mut self) -> Result<Answer> {
        let Some(Frame { at_rest, vibration }) = &mut self.last else { bail!(NO_FRAME) };
        let share = modes::PLATFORM_SHARE;
        let first = |found: &Option<(Dynamics, Modes)>| found.as_ref().and_then(|(_, list)| list.first_platform(share));
        if first(vibration).is_none() {
            let AtRest { robot, equilibrium, .. } = &*at_rest.vibrating();
            let linearisation = at_rest::linearisation(&self.request.model, equilibrium.model);
            let found = modes::lowest_with_platform(robot, equilibrium, linearisation, share, MAX_HZ);
            *vibration = Some(found.map_err(|error| NoSolution(without_platform(&error, share)))?);
        }

        let (Some(index), Some((_, list))) = (first(vibration), &*vibration) else { bail!("the search has no mode") };
        let numbers = list.modes[..=index].iter().flat_map(mode_numbers).collect();
        let text = json!({ "index": index, "below_hz": list.below_hz, "certified": list.certified });
        Ok(Answer { numbers, text: text.to_string() })
    }

    /// Ends of the rays of a level that no lower level has, from a pose to the border of the workspace: x, y, z [m],
    /// distance
    /// [m], and 1 at the border or 0 where the box of the search ends. The text has the conditions in words, whether
    /// they are kept at the pose and the pose is in the box, otherwise there are no rays, and the triangles between all
    /// rays so far.
    ///
    /// # Errors
    /// A state that is no pose, or a robot whose workspace cannot be searched.
    pub fn reach(&mut self, state: &FrameState, level: usize) -> Result<Answer> {
        let FrameState::Pose(pose) = state else { bail!("rays go out from a pose: give 7 numbers") };
        let pose = pose.to_robot()?;
        if self.reach.is_none() {
            self.reach = Some(WorkspaceReach::new(self.robot.clone(), &self.workspace_request())?);
        }
        let Some(reach) = &self.reach else { bail!("there are no rays") };
        let ends = reach.from(&pose, level);
        let numbers = ends.iter().flatten().flat_map(|end| {
            let [x, y, z]: [f64; 3] = end.position_w.into();
            [x, y, z, end.distance, if end.is_border { 1.0 } else { 0.0 }]
        });
        let text = json!({
            "conditions": reach.conditions().iter().map(ToString::to_string).collect::<Vec<_>>(),
            "is_inside": ends.as_ref().is_some_and(|ends| !ends.is_empty()),
            "is_in_box": ends.is_some(),
            "triangles": reach.triangles(level).as_flattened(),
        });
        Ok(Answer { numbers: numbers.collect(), text: text.to_string() })
    }

    /// Request of the workspace whose loads, limits and models are those of the frames.
    fn workspace_request(&self) -> WorkspaceRequest {
        let StiffnessRequest { robot, state, tensions, model, .. } = &self.request;
        let state = request::State { pose: None, lengths_m: None, hold_lengths_of_pose: false, ..state.clone() };
        let (tensions, model) = (tensions.clone(), *model);
        let point = request::PointOptions { state, tensions, model, ..Default::default() };
        WorkspaceRequest { robot: robot.clone(), point, ..Default::default() }
    }

    /// Equilibrium at a state.
    fn at_rest(&self, state: FrameState) -> Result<AtRest> {
        let StiffnessRequest { robot: source, state: of_request, tensions, .. } = &self.request;
        let mut requested = of_request.clone();
        match state {
            FrameState::OfRequest => {}
            FrameState::Pose(pose) => (requested.pose, requested.lengths_m) = (Some(pose), None),
            FrameState::Lengths(lengths, start) => {
                requested =
                    request::State { pose: None, lengths_m: Some(lengths), hold_lengths_of_pose: false, ..requested };
                if let Some(start) = start {
                    return self.near(&start.to_robot()?, &requested);
                }
            }
        }
        at_rest::equilibrium(self.robot.clone(), source, &requested, tensions)
    }

    /// Equilibrium of held lengths near a pose.
    fn near(&self, start: &robot::Pose, requested: &request::State) -> Result<AtRest> {
        let robot = at_rest::with_state(self.robot.clone(), requested)?;
        let robot = at_rest::with_limits(&robot, &self.request.tensions)?;
        let State::Lengths(lengths) = &robot.state else { bail!("the state has no lengths") };
        let equilibrium = statics::forward(&robot, lengths, requested.static_model, Some(start))?;
        Ok(AtRest { robot, equilibrium, requested_pose: None, rule: None, held_pose: None })
    }

    /// At least `count` lowest modes, or all if there are fewer. The first limit is the highest frequency of the last
    /// frame, because a robot that moves a little has nearly the same frequencies.
    fn modes(&self, at_rest: &AtRest, linearisation: Linearisation, count: usize) -> Result<(Dynamics, Modes)> {
        let AtRest { robot, equilibrium, .. } = &*at_rest.vibrating();

        if let Some(limit) = self.known_hz.get(count - 1).map(|hz| (LIMIT_FACTOR * hz).min(MAX_HZ)) {
            let dynamics = Dynamics::about(robot, equilibrium, linearisation, limit)?;
            let counted = dynamics.modes_below(limit * std::f64::consts::TAU);
            if (count..=2 * count).contains(&counted) {
                let found = modes::below(&dynamics, limit);
                if found.modes.len() >= count {
                    return Ok((dynamics, found));
                }
            }
        }
        match modes::lowest(robot, equilibrium, linearisation, count, MAX_HZ) {
            // Cables without mass leave the robot few modes: the frame has all of them.
            Err(LowestError::TooFew { found: 1.., .. }) => {
                let dynamics = Dynamics::about(robot, equilibrium, linearisation, MAX_HZ)?;
                let found = modes::below(&dynamics, MAX_HZ);
                Ok((dynamics, found))
            }
            found => Ok(found?),
        }
    }

    /// Displacements (x, y, z) of points on all cables in mode `index` of the last frame, in the scale of its shape.
    ///
    /// # Errors
    /// No such mode, or a cable model without motion along the cables.
    pub fn mode(&self, index: usize, points: usize) -> Result<Answer> {
        FrameSize { modes: 0, points }.check()?;
        let Some(Frame { at_rest, vibration }) = &self.last else { bail!(NO_FRAME) };
        let Some((dynamics, found)) = vibration else {
            bail!("the last frame has no modes: compute a frame with modes first")
        };
        let Some(mode) = found.modes.get(index) else {
            bail!("there is no mode {index}: the last frame has {}", found.modes.len())
        };
        let at_rest = &*at_rest.vibrating();
        let fractions = fractions(points);
        let mut numbers = Vec::with_capacity(3 * points * at_rest.robot.cables.len());
        for i in 0..at_rest.robot.cables.len() {
            let along = CableStations::new(&at_rest.robot, &at_rest.equilibrium, dynamics, i, &fractions, false)?;
            let axes = along.axes;
            for [e, n, b] in along.in_mode(dynamics, mode) {
                numbers.extend((axes.e * e + axes.n * n + axes.b * b).iter());
            }
        }
        Ok(Answer { numbers, text: String::new() })
    }

    /// Response at the equilibrium of the last frame: three numbers per frequency [Hz], real and imaginary part, then
    /// three per peak: frequency [Hz], prominence [dB] and magnitude. The text has their counts. Whether peaks are
    /// missed between the frequencies is not checked, because this takes longer than the response; `frf` does it.
    ///
    /// # Errors
    /// A request that contradicts itself or the robot, or an undamped resonance at one of the frequencies.
    pub fn response(&self, request: &FrfRequest) -> Result<Answer> {
        let Some(Frame { at_rest, .. }) = &self.last else { bail!(NO_FRAME) };
        let adaptive = request.is_adaptive();
        let linearisation = at_rest::linearisation(&self.request.model, at_rest.equilibrium.model);
        let range = at_rest.response_range(&request.range, linearisation)?;
        let frequencies = if adaptive { range.starts()? } else { range.frequencies()? };
        let (inputs, outputs) = (request.input.names(), request.output.names());
        if inputs.len() != 1 || outputs.len() != 1 {
            bail!("give one ⟪input⟫ and one ⟪output⟫: a frame has one response");
        }
        let pairs = frf::Pairs { inputs, outputs, points: request.signal_points, model: self.request.model };
        let found = if adaptive {
            frf::response(at_rest, &pairs, frequencies, adaptive, &mut Silent)?
        } else {
            frf::values_alone(at_rest, &pairs, frequencies)?
        };

        let [values] = &found.values[..] else { bail!("there is no response") };
        let frequencies = &found.frequencies_hz;
        let mut numbers: Vec<f64> =
            frequencies.iter().zip(values).flat_map(|(hz, value)| [*hz, value.re, value.im]).collect();
        let peaks = response::peaks(frequencies, values, request.prominence_db);
        numbers.extend(peaks.iter().flat_map(|peak| [peak.frequency_hz, peak.prominence_db, peak.magnitude]));
        let text = json!({
            "frequencies": frequencies.len(),
            "peaks": peaks.len(),
            "unit": found.unit(0),
            "caveat": found.caveat,
        });
        Ok(Answer { numbers, text: text.to_string() })
    }
}

/// Reason for which no mode of the platform was found.
fn without_platform(error: &PlatformModeError, share: f64) -> String {
    match error {
        // The search has gone as far as the cables can be resolved.
        PlatformModeError::Dynamics(limit) => {
            format!("no mode of the platform was found. The search ends here: {limit}")
        }
        _ => no_platform_mode(error, share),
    }
}

/// Equal steps from 0 to 1.
fn fractions(points: usize) -> Vec<f64> {
    (0..points).map(|i| i as f64 / (points - 1) as f64).collect()
}

/// Robot as a page shows it.
fn description(robot: &Robot, text: &str) -> Value {
    let motion = match robot.platform.motion {
        PlatformMotion::Rigid => json!({ "name": "rigid" }),
        PlatformMotion::PointMass => json!({ "name": "point-mass" }),
        PlatformMotion::Planar(plane) => {
            json!({ "name": "planar", "normal": plane.normal_w().as_slice(), "offset_m": plane.offset() })
        }
    };
    json!({
        "name": robot.name,
        "text": text,
        "motion": motion,
        "degrees_of_freedom": robot.platform.motion.count(),
        "platform_share": modes::PLATFORM_SHARE,
        "considerable_share": modes::CONSIDERABLE_SHARE,
        "calibration_unknowns": calibrate::UNKNOWNS,
        "obstacles": bodies(&robot.obstacles),
        "platform_bodies": bodies(&robot.platform.bodies),
        "check": check::run(robot.clone()),
    })
}

/// Bodies with the corners of the triangles of their surfaces, in the frame in which they stand [m]; without half
/// spaces.
fn bodies(of: &[Body]) -> Vec<Value> {
    let with_surface = of.iter().map(|body| (body, body.triangles())).filter(|(_, triangles)| !triangles.is_empty());
    let corners = |triangles: Vec<[Vec3; 3]>| -> Vec<f64> {
        triangles.iter().flatten().flat_map(|corner| corner.iter().copied()).collect()
    };
    with_surface.map(|(body, triangles)| json!({ "name": body.name, "corners": corners(triangles) })).collect()
}

/// Pair of cables, platform and obstacles with the least margin, for a robot that is judged by distances.
fn nearest(AtRest { robot, equilibrium, .. }: &AtRest) -> Option<Value> {
    if !robot.judges_clearance() {
        return None;
    }
    let around = Surroundings::of(robot);
    let least = around.least(equilibrium, None)?;
    Some(json!({
        "pair": around.pair_text(least.pair),
        "distance_m": least.distance,
        "required_m": least.required,
        "margin_m": least.margin(),
        "points_m": least.points_w.map(|point| [point.x, point.y, point.z]),
    }))
}

/// Numbers of a frame in the order that the documentation of this file gives.
fn numbers(at_rest: &AtRest, modes: Option<&Modes>, size: FrameSize) -> Vec<f64> {
    let AtRest { robot, equilibrium, .. } = at_rest;
    let cables = robot.cables.len();
    let shown = modes.map_or(0, |modes| modes.modes.len().min(size.modes));
    let mut numbers = Vec::with_capacity(HEADER + cables * (CABLE + 3 * size.points) + shown * (MODE + cables));

    let header = layout::Header { at_rest, modes, points: size.points, shown };
    layout::write(&layout::header(), &header, &mut numbers);
    for (i, cable) in equilibrium.cables.iter().enumerate() {
        layout::write(&layout::cable(), &layout::Cable::new(robot, i, cable), &mut numbers);
    }

    // Points along the cables, from the platform.
    let fractions = fractions(size.points);
    for cable in &equilibrium.cables {
        for fraction in &fractions {
            let point: Vec3 = match &cable.hanging {
                Some(hanging) => hanging.point_w(fraction * cable.free_length()),
                None => cable.attachment_w + cable.chord_w() * *fraction,
            };
            numbers.extend(point.iter());
        }
    }

    // Modes.
    numbers.extend(modes.iter().flat_map(|modes| &modes.modes).take(shown).flat_map(mode_numbers));
    numbers
}

/// Numbers of one mode.
fn mode_numbers(mode: &Mode) -> Vec<f64> {
    let mut numbers = Vec::with_capacity(MODE + mode.cable_energy_fractions.len());
    layout::write(&layout::mode(), mode, &mut numbers);
    numbers.extend(&mode.cable_energy_fractions);
    numbers
}

/// Request of frames in JSON.
///
/// # Errors
/// Text that is not such a request.
pub fn request_of(text: &str) -> Result<Request> {
    Request::from_json(text).map_err(|error| anyhow!("{error}"))
}

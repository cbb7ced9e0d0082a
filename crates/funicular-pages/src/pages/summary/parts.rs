//! Parts of a summary: each takes the results of the analysis that has them, or says why it has none.

use crate::figures::{self, Figure};
use anyhow::Result;
use funicular::math::rotation;
use funicular::modes;
use funicular::robot::{RequiredLoads, Robot};
use funicular_study::Watch;
use funicular_study::analyses::winches::Winches;
use funicular_study::analyses::{clearance, gust, loads, payload, settle, winches, workspace};
use funicular_study::at_rest::{self, AtRest};
use funicular_study::request::{
    Axis, ClearanceRequest, GustRequest, LoadsRequest, PointOptions, Pose, ReportRequest, SettleRequest, State,
    WinchesRequest, WorkspaceRequest,
};
use funicular_study::text::significant;

/// Time for the section of the workspace: it is computed on one thread, and the reader waits for the pages.
const MAX_SECONDS: f64 = 40.0;

/// Coordinate of the height among those of a platform.
const Z: usize = 2;

/// Half the thickness of the slab of the workspace [m], and its layers: the fewest that a workspace takes.
const HALF_SLAB: f64 = 0.1;
const LAYERS: usize = 5;

/// Number of warnings on the pages.
const MAX_WARNINGS: usize = 3;

/// Parts of two pages.
pub(super) struct Parts {
    pub(super) robot: String,
    /// Source and state in one line.
    pub(super) about: String,
    pub(super) picture: Figure,
    pub(super) section: Result<Figure, String>,
    pub(super) section_about: String,
    /// Loads that it carries, with true if it is enough.
    pub(super) verdict: (bool, Vec<String>),
    pub(super) winches: Result<Winches, String>,
    /// Titles and sentences.
    pub(super) answers: Vec<(&'static str, String)>,
    pub(super) dangers: Vec<String>,
    pub(super) assumed: Vec<String>,
    pub(super) warnings: Vec<String>,
}

/// Clock of the caller: seconds since any moment.
pub type Clock<'a> = &'a dyn Fn() -> f64;

/// Observer that stops the work at a time, and shows nothing.
struct UntilTime<'a> {
    inner: &'a dyn Watch,
    clock: Clock<'a>,
    /// Reading of the clock at the end [s].
    end: f64,
}

impl Watch for UntilTime<'_> {
    fn is_cancelled(&self) -> bool {
        (self.clock)() > self.end || self.inner.is_cancelled()
    }
}

impl Parts {
    /// Computes all parts.
    ///
    /// # Errors
    /// A robot without this equilibrium.
    pub(super) fn of(request: &ReportRequest, robot: &Robot, watch: &mut dyn Watch, clock: Clock<'_>) -> Result<Self> {
        let rest = at_rest::equilibrium(robot.clone(), &request.robot, &request.state, &request.tensions)?;
        let mut warnings = rest.warnings(None);
        let asks = &rest.robot.required;
        let (section, section_about) = section(request, robot, &rest, (watch, clock));
        let winches = winches(request, &rest, &mut warnings, watch);
        let answers = vec![
            ("Clearance", clearance(request, robot, watch)),
            ("Stop", stop(request, &rest, &mut warnings)),
            ("Gusts", gusts(request, &rest, &mut warnings)),
            ("First resonance", resonance(&rest)),
        ];
        let mut seen: Vec<String> = Vec::new();
        for warning in warnings {
            if !seen.contains(&warning) {
                seen.push(warning);
            }
        }
        let dangers = match seen.len() {
            0 => vec!["no warning".to_owned()],
            count if count > MAX_WARNINGS => {
                let more = format!("and {} more: `report` without a summary lists all", count - MAX_WARNINGS);
                seen[..MAX_WARNINGS].iter().cloned().chain([more]).collect()
            }
            _ => seen.clone(),
        };
        Ok(Self {
            robot: rest.robot.name.clone(),
            about: about(&rest),
            picture: figures::of_rest(&rest),
            section,
            section_about,
            verdict: verdict(request, robot, &rest),
            winches,
            answers,
            dangers,
            assumed: assumed(&rest, asks),
            warnings: seen,
        })
    }
}

fn about(rest: &AtRest) -> String {
    let [x, y, z] = [0, 1, 2].map(|k| significant(rest.equilibrium.pose.position_w[k], 4));
    let tensions = || rest.equilibrium.cables.iter().map(|cable| cable.tension_platform);
    format!(
        "{} cables, {} kg, at ({x}, {y}, {z}) m; tensions at rest {} to {} N",
        rest.robot.cables.len(),
        significant(rest.robot.platform.mass, 4),
        significant(tensions().fold(f64::INFINITY, f64::min), 4),
        significant(tensions().fold(0.0, f64::max), 4)
    )
}

/// Loads that the robot carries at its pose.
fn verdict(request: &ReportRequest, robot: &Robot, rest: &AtRest) -> (bool, Vec<String>) {
    let of = LoadsRequest {
        robot: request.robot.clone(),
        state: request.state.clone(),
        tensions: request.tensions.clone(),
        ..LoadsRequest::default()
    };
    let mut lines = Vec::new();
    let mut good = true;
    match loads::run(robot.clone(), &of) {
        Err(error) => lines.push(format!("Required loads: not computed, {error}")),
        Ok(found) => match (&found.required, &found.dead_load_reason) {
            (_, Some(reason)) => {
                good = false;
                lines.push(format!("The platform alone is NOT held within the limits: {reason}"));
            }
            (Some(required), None) => {
                good = required.held;
                let factor = required.load_factor.map_or_else(|| "any".to_owned(), |of| significant(of, 3));
                let word = if required.held { "are held" } else { "are NOT held" };
                lines.push(format!("All required loads {word} here: {factor} times what is required is the limit."));
            }
            (None, None) => {
                let margin = found.capacity_margin_n.map(|margin| significant(margin, 3));
                let margin = margin.map_or_else(String::new, |margin| {
                    format!(" A further force of {margin} N in any direction is held.")
                });
                lines.push(format!("No loads are required in the file beyond the platform's own weight.{margin}"));
            }
        },
    }
    match payload::about(rest, None) {
        Ok(found) => lines.push(match &found.maximum {
            Some(most) => format!("Largest payload here: {} kg.", significant(most.payload_kg, 4)),
            None => "No maximum tension is given, so that nothing limits the payload.".to_owned(),
        }),
        Err(error) => lines.push(format!("Payload: not computed, {error}")),
    }
    (good, lines)
}

/// Section of the workspace at the height of the pose, and what it shows.
fn section(
    request: &ReportRequest,
    robot: &Robot,
    rest: &AtRest,
    (watch, clock): (&mut dyn Watch, Clock<'_>),
) -> (Result<Figure, String>, String) {
    let height = rest.equilibrium.pose.position_w.z;
    let about = format!("Positions at z = {} m", significant(height, 4));
    // A thin slab about the height of the pose is enough for a section; a guide that holds z has its own plane.
    let rises = robot.platform.motion.components().contains(&Z);
    let slab = Axis::Range { axis: "z".to_owned(), from: height - HALF_SLAB, to: height + HALF_SLAB, count: LAYERS };
    let of = WorkspaceRequest {
        robot: request.robot.clone(),
        grid: if rises { vec![slab] } else { Vec::new() },
        section: vec![Axis::List { axis: "z".to_owned(), values: vec![height] }],
        point: PointOptions {
            state: request.state.clone(),
            tensions: request.tensions.clone(),
            ..PointOptions::default()
        },
        ..WorkspaceRequest::default()
    };
    let mut until = UntilTime { inner: &*watch, clock, end: clock() + MAX_SECONDS };
    let found = workspace::run(robot.clone(), &of, &mut until);
    let late = until.is_cancelled();
    let reason = |error: anyhow::Error| {
        if late { format!("not within {MAX_SECONDS} s: `workspace` finds it") } else { error.to_string() }
    };
    match found {
        Ok(found) => {
            let conditions = found.conditions.iter().map(|of| in_words(&of.to_string())).collect::<Vec<_>>().join(", ");
            let figure = figures::of_sections(&found).map_err(|error| error.to_string());
            (figure, format!("{about} that keep: {conditions}."))
        }
        Err(error) => (Err(reason(error)), format!("{about}.")),
    }
}

/// Condition of the workspace for a reader who knows no names of quantities.
fn in_words(condition: &str) -> String {
    match condition {
        "load_factor at least 1" => "all required loads are held".to_owned(),
        "clearance_margin_m at least 0" => "every pair keeps its required distance".to_owned(),
        other => other.to_owned(),
    }
}

fn winches(
    request: &ReportRequest,
    rest: &AtRest,
    warnings: &mut Vec<String>,
    watch: &mut dyn Watch,
) -> Result<Winches, String> {
    // Lengths that the file gives hold this pose; the winches give it again.
    let pose = &rest.equilibrium.pose;
    let [roll, pitch, yaw] = rotation::to_roll_pitch_yaw_deg(&pose.rot_wp);
    let [x, y, z] = pose.position_w.into();
    let pose = Some(Pose::Angles([x, y, z, roll, pitch, yaw]));
    let of = WinchesRequest {
        robot: request.robot.clone(),
        state: State { pose, lengths_m: None, hold_lengths_of_pose: false, ..request.state.clone() },
        tensions: request.tensions.clone(),
        ..WinchesRequest::default()
    };
    let found = winches::run(rest.robot.clone(), &of, watch).map_err(|error| error.to_string())?;
    warnings.extend(found.warnings.iter().cloned());
    Ok(found)
}

fn clearance(request: &ReportRequest, robot: &Robot, watch: &mut dyn Watch) -> String {
    let of = ClearanceRequest {
        robot: request.robot.clone(),
        state: request.state.clone(),
        tensions: request.tensions.clone(),
        ..ClearanceRequest::default()
    };
    match clearance::run(robot.clone(), &of, watch) {
        Err(error) => format!("not computed: {error}"),
        Ok(found) => match found.pairs.first() {
            None => "there is no pair of things that could touch".to_owned(),
            Some(pair) => format!(
                "{}; nearest are {} and {} with {} m, {} m are required",
                if found.free {
                    "every pair keeps its distance here"
                } else {
                    "NOT every pair keeps its distance here"
                },
                pair.first,
                pair.second,
                significant(pair.distance_m, 3),
                significant(pair.required_m, 3)
            ),
        },
    }
}

/// Motion after a sudden stop from the required velocity along the axis where it is largest.
fn stop(request: &ReportRequest, rest: &AtRest, warnings: &mut Vec<String>) -> String {
    let velocity = rest.robot.required.velocity_w;
    let axis = velocity.imax();
    if velocity[axis] == 0.0 {
        return "not computed: the file requires no velocity (`velocity_m_s` in [required])".to_owned();
    }
    let mut stop = [0.0; 3];
    stop[axis] = velocity[axis];
    let of = SettleRequest {
        robot: request.robot.clone(),
        stop_m_s: Some(stop),
        below_hz: Some(request.below_hz),
        ..SettleRequest::default()
    };
    match settle::about(rest, &of) {
        Err(error) => format!("a stop from {} m/s: {error}", significant(velocity[axis], 3)),
        Ok(found) => {
            warnings.extend(found.warnings.iter().cloned());
            format!(
                "a sudden stop from {} m/s along {} swings by up to {} mm. {}",
                significant(velocity[axis], 3),
                ["x", "y", "z"][axis],
                significant(1e3 * found.peak_m, 3),
                found.when_settled()
            )
        }
    }
}

fn gusts(request: &ReportRequest, rest: &AtRest, warnings: &mut Vec<String>) -> String {
    if rest.robot.turbulence.is_none() {
        return "not computed: the file has no turbulence in [wind]".to_owned();
    }
    let of = GustRequest { robot: request.robot.clone(), ..GustRequest::default() };
    match gust::about(rest, &of) {
        Err(error) => format!("not computed: {error}"),
        Ok(found) => {
            warnings.extend(found.warnings.iter().cloned());
            let moved = found.outputs.iter().filter(|row| row.unit == "m").filter_map(|row| row.peak);
            let lowest = found.outputs.iter().filter(|row| row.is_tension()).filter_map(gust::GustRow::smallest);
            let mut said = vec![format!("in {} s", significant(found.duration_s, 4))];
            said.extend(moved.reduce(f64::max).map(|of| format!("up to {} mm", significant(1e3 * of, 3))));
            said.extend(lowest.reduce(f64::min).map(|of| format!("lowest tension {} N", significant(of, 3))));
            said.join(", ")
        }
    }
}

fn resonance(rest: &AtRest) -> String {
    match modes::first(&rest.robot, &rest.equilibrium) {
        Ok(first) => format!(
            "{} Hz: keep machines and the control of the position well below or above it",
            significant(first.frequency_hz, 4)
        ),
        Err(error) => format!("not computed: {error}"),
    }
}

/// Assumptions behind all numbers.
fn assumed(rest: &AtRest, asks: &RequiredLoads) -> Vec<String> {
    let rule = rest
        .rule
        .as_ref()
        .map_or_else(|| "as the lengths give them".to_owned(), |rule| format!("by the rule `{}`", rule.name()));
    let list = |of: funicular::math::Vec3| [of.x, of.y, of.z].map(|value| significant(value, 3)).join(", ");
    let mut lines = vec![
        format!(
            "Cables: {} model at rest; tensions {rule}; one pose, unless a part says otherwise.",
            rest.equilibrium.model.name()
        ),
        "Winches: at this pose alone; `winches` with a grid of poses gives those of the whole room.".to_owned(),
    ];
    if rest.robot.required.twists_w().is_empty() {
        let text = "No velocity is required in the file: winches then need neither speed nor power.";
        lines.push(text.to_owned());
    }
    let mut required = Vec::new();
    let zero = funicular::math::Vec3::zeros();
    for (name, of, unit) in [
        ("force", asks.force_w, "N"),
        ("moment", asks.moment_w, "N m"),
        ("acceleration", asks.acceleration_w, "m/s²"),
        ("velocity", asks.velocity_w, "m/s"),
    ] {
        if of != zero {
            required.push(format!("{name} ({}) {unit}", list(of)));
        }
    }
    if asks.payload.max_mass > 0.0 {
        required.push(format!("payload up to {} kg", significant(asks.payload.max_mass, 4)));
    }
    if asks.wind_speed > 0.0 {
        required.push(format!("wind of {} m/s", significant(asks.wind_speed, 3)));
    }
    let nothing = || "nothing beyond the weight of the platform".to_owned();
    lines.push(format!("Required: {}.", if required.is_empty() { nothing() } else { required.join(", ") }));
    lines
}

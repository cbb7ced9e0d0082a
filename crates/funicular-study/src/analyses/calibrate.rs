//! `calibrate`: anchors, attachments, offsets and scale from readings of lengths at poses that nobody knows.
//!
//! docs/theory.md, section 18d, has the equations. `identify` takes measured results of states that are known; here
//! every row brings its own unknown pose.

mod accuracy;
mod caveats;
mod choice;
mod covariance;
mod drawn;
mod profiles;
mod reachable;
mod report;
mod rows;
mod table;
mod words;
mod wrong;

pub use accuracy::{HalvingRow, ToolAccuracy, ToolRow};
pub use covariance::CovarianceRow;
pub use drawn::{AnchorRow, LinearRows, NetRows};
pub use rows::LeftOut;
pub use rows::{CableResidual, CalibratedValue, DistanceRow, MinimumRow, ProposalRow, ReadingRow, Walk, WeakRow};
pub use table::check as check_readings;

use super::candidate_poses::{self, Candidates};
use super::found;
use crate::Watch;
use crate::columns::{ResultTable, Tabled};
use crate::error::{Cancelled, NoSolution};
use crate::names::suggestion;
use crate::request::{self, CalibrateRequest, PriorValue};
use crate::rows::rows;
use crate::table::Column;
use crate::text::significant;
use anyhow::{Result, anyhow, bail};
use funicular::calibration::{
    Calibration, CalibrationError, CalibrationUnknown, FrameChoice, ReadingDeviations, moving_axes, search,
};
use funicular::robot::Robot;
use funicular::robot::parameters::Parameters;
use funicular::statics::StaticModel;
use report::CalibrationReport;

/// Key of the table.
const KEY: &str = "readings";

/// Standard deviation of readings in a search if none is given [m]. The residuals then give it.
const ASSUMED_DEVIATION: f64 = 1e-3;

/// Names of the unknowns.
pub const UNKNOWNS: [&str; 8] =
    ["anchors", "attachments", "offsets", "scale", "pulley-radii", "axial-stiffness", "mass", "support-stiffness"];

/// Name of the platform's position in ⟪propose_for⟫.
const TOOL: &str = "tool";

/// Name of the inner frame.
const INNER: &str = "inner";

rows! {
    /// Results of `calibrate`.
    pub struct Calibrated {
        pub robot: String = hidden;
        /// Sentence on the fit of the readings.
        pub fit: String;
        /// Sentence on what the readings determine.
        pub determined: String;
        /// True if χ² is a parabola along the weakest combination and no combination is lost.
        pub is_determined: bool;
        /// Frame in words.
        pub frame: String;
        pub values: Vec<CalibratedValue>;
        /// Anchors with their covariance.
        pub anchors: Vec<AnchorRow>;
        pub distances: Vec<DistanceRow>;
        pub rows: Vec<ReadingRow>;
        pub weak_combinations: Vec<WeakRow>;
        pub walk: Option<Walk>;
        /// Further minima that fit.
        pub minima: Vec<MinimumRow> = sparse;
        pub proposals: Vec<ProposalRow> = sparse;
        /// Number of candidates that were left out: no tensions within the limits, too near to a body, or out of reach.
        pub left_out: Option<LeftOut>;
        /// Least number of proposed poses that reaches the wanted deviation; absent if none was wanted or no number
        /// does.
        pub poses_needed: Option<usize>;
        /// Accuracy of the tool; absent if none was asked for, or if the readings do not tell it.
        pub accuracy: Option<ToolAccuracy>;
        /// Sum of the squares of the residuals, divided by the deviations of the data.
        pub chi2: f64;
        /// Number of readings and measured coordinates.
        pub data: usize;
        pub degrees_of_freedom: usize;
        /// Root mean square of the residuals of the readings.
        pub residual_rms_m: f64;
        /// Standard deviation of a reading, given or from the residuals.
        pub length_std_m: Option<f64>;
        /// Root of the sum of the variances of the values, in the frame and with inner conditions.
        pub total_m: Option<f64>;
        pub inner_total_m: Option<f64>;
        /// Largest deviation of a combination of values in the frame.
        pub weakest_m: Option<f64>;
        /// True if the platform turns.
        pub turns: bool = hidden;
        pub starts: usize;
        /// Number of starts that arrived at the best minimum.
        pub arrivals: usize;
        pub iterations: usize;
        /// Robot file with the calibrated anchors and attachments.
        pub robot_file: String;
        /// Covariance of the numbers of the robot file, for `uncertainty`; none if the readings do not tell it.
        pub covariance: Vec<CovarianceRow> = sparse;
        /// World axes along which the platform moves.
        pub axes: Vec<usize> = hidden;
        /// Rows as linear equations, for pages.
        pub linear: Option<LinearRows> = hidden;
        pub warnings: Vec<String> = hidden;
    }
}

impl Calibrated {
    /// Table of the covariance.
    pub fn covariance_table(&self) -> ResultTable<'_> {
        ResultTable::new(CovarianceRow::columns(), &self.covariance)
    }
}

impl Tabled for Calibrated {
    fn tables() -> Vec<(&'static str, Vec<Column>)> {
        vec![("", CalibratedValue::columns().described())]
    }

    fn table(&self) -> ResultTable<'_> {
        ResultTable::new(CalibratedValue::columns(), &self.values)
    }
}

found!(Calibrated, "calibrate");

/// Calibrates a robot.
///
/// # Errors
/// A request that contradicts itself or the robot; a table with a fault; fewer readings than unknowns; readings that
/// fit at no start; work that was stopped.
pub fn run(request: &CalibrateRequest, watch: &mut dyn Watch) -> Result<Calibrated> {
    check_numbers(request)?;
    let file = request.robot.read()?;
    let parameters = Parameters::from_toml(&file.text)?;
    let robot = parameters.robot().clone();
    let rows = table::rows(
        &request.readings,
        &robot,
        [request.position_std_m, request.rotation_std_deg].map(|of| of.is_some()),
    )?;
    let (numbers, rows) = table::kept(rows, &request.leave_out)?;
    let is_proposed = request.propose > 0 || request.wanted_std_m.is_some();
    let needs = (is_proposed, "⟪propose⟫ or ⟪wanted_std_m⟫");
    let candidates = candidate_poses::wanted(needs, &request.grid, request.poses.as_ref(), &robot)?;
    let keys = ["accuracy_grid", "accuracy_poses"];
    let tool = candidate_poses::given(keys, &request.accuracy_grid, request.accuracy_poses.as_ref(), &robot)?;
    if is_for_tool(request) && matches!(tool, Candidates::None) {
        bail!("⟪propose_for⟫ {TOOL} needs the poses where the tool is used: give ⟪accuracy_grid⟫ or ⟪accuracy_poses⟫");
    }

    // Unknowns and frame.
    let unknowns = unknowns(request, &robot)?;
    choice::all_chosen("profile", &request.profile, &unknowns, &robot)?;
    let proposed_for = choice::proposed_for(request, &unknowns, &robot)?;
    let is_chosen = |k: usize| proposed_for[k];
    if !is_for_tool(request)
        && request.wanted_std_m.is_some()
        && !(0..unknowns.len()).any(|k| is_chosen(k) && unknowns[k].is_length())
    {
        bail!("⟪wanted_std_m⟫ is a length, and none of the chosen values is one: leave it out, or name lengths");
    }
    let deviations = ReadingDeviations {
        reading: request.length_std_m.unwrap_or(ASSUMED_DEVIATION),
        position: request.position_std_m.unwrap_or(1.0),
        angle: request.rotation_std_deg.unwrap_or(1.0).to_radians(),
        tension: request.tension_std_n,
        tension_prior: request.tension_range_n.map(prior_of_range),
    };
    let named = |error: CalibrationError| in_words(&robot, &numbers, error);
    let of = Calibration::new(robot.clone(), unknowns, rows, deviations, request.static_model).map_err(named)?;
    let of = with_priors(request, of)?;
    check_signs(request, &of, &numbers)?;
    let frame = of.frame(&frame_choice(request, &robot)?).map_err(named)?;
    of.check_count(&frame).map_err(named)?;

    // The search.
    let mut progress = |done: usize, total: usize| {
        watch.progress(done, total, "starts");
        !watch.is_cancelled()
    };
    let found = search(&of, &frame, request.starts, &mut progress);
    if watch.is_cancelled() {
        return Err(Cancelled.into());
    }
    let found = found.ok_or_else(|| NoSolution(CalibrationError::NoMinimum { starts: request.starts }.to_string()))?;

    let report = CalibrationReport::new(request, &of, &numbers, &frame, &found, [&candidates, &tool])?;
    let mut results = report.results(watch)?;
    results.warnings = caveats::warnings(&report, &results);
    Ok(results)
}

/// True if a proposal reduces the deviation of the platform.
fn is_for_tool(request: &CalibrateRequest) -> bool {
    request.propose_for.iter().any(|name| name == TOOL)
}

/// Refuses numbers of a request that are out of their ranges.
fn check_numbers(request: &CalibrateRequest) -> Result<()> {
    request::check("length_std_m", request.length_std_m, crate::values::positive)?;
    request::check("position_std_m", request.position_std_m, crate::values::positive)?;
    request::check("rotation_std_deg", request.rotation_std_deg, crate::values::positive)?;
    request::check_positive("tension_std_n", request.tension_std_n)?;
    request::check("wanted_std_m", request.wanted_std_m, crate::values::positive)?;
    check_tension_range(request)?;
    request.tensions.check()
}

/// Refuses a reading that is no length, unless an unknown offset makes it one.
fn check_signs(request: &CalibrateRequest, of: &Calibration, numbers: &[usize]) -> Result<()> {
    if request.unknowns.iter().any(|unknown| unknown == "offsets") {
        return Ok(());
    }
    for (number, row) in numbers.iter().zip(&of.rows) {
        let wrong = row.readings.iter().zip(&of.robot.cables).find(|(reading, _)| reading.is_some_and(|of| of <= 0.0));
        if let Some((reading, cable)) = wrong {
            bail!(
                "⟪readings⟫, row {number}: the reading {} m of cable {} is no length, which is positive; readings from \
                 an encoder's zero need unknown offsets, ⟪unknowns⟫ anchors,offsets",
                significant(reading.unwrap_or_default(), 4),
                cable.name
            );
        }
    }
    Ok(())
}

/// Error of the core with the names of the robot and the numbers of the rows in their table.
fn in_words(robot: &Robot, numbers: &[usize], error: CalibrationError) -> anyhow::Error {
    match error {
        CalibrationError::UnreadCable { cable } => anyhow!(
            "no row has a reading of cable {}: add its column, or hold its anchor with ⟪hold_anchors⟫",
            robot.cables[cable].name
        ),
        CalibrationError::OpenPose { row, data, coordinates } => {
            anyhow!(CalibrationError::OpenPose { row: numbers[row - 1], data, coordinates })
        }
        other => anyhow!("{other}"),
    }
}

/// Unknowns of a request, without what the platform does not have.
fn unknowns(request: &CalibrateRequest, robot: &Robot) -> Result<Vec<CalibrationUnknown>> {
    check_names("unknowns", &request.unknowns)?;
    if request.unknowns.is_empty() {
        bail!("⟪unknowns⟫ is empty: name at least one of {}", UNKNOWNS.join(", "));
    }
    let held = cables_of("hold_anchors", &request.hold_anchors, robot)?;
    let axes = moving_axes(robot);
    let wants = |name: &str| request.unknowns.iter().any(|unknown| unknown == name);
    let count = robot.cables.len();
    let (axes, held) = (&axes, &held);
    let points = |is_anchor: bool| {
        (0..count).flat_map(move |cable| {
            axes.iter().map(move |&axis| {
                if is_anchor {
                    CalibrationUnknown::Anchor { cable, axis }
                } else {
                    CalibrationUnknown::Attachment { cable, axis }
                }
            })
        })
    };

    let mut unknowns = Vec::new();
    if wants("anchors") {
        unknowns.extend(points(true).filter(|of| !of.cable().is_some_and(|cable| held.contains(&cable))));
    }
    if wants("attachments") {
        unknowns.extend(points(false));
    }
    if wants("offsets") {
        unknowns.extend((0..count).map(|cable| CalibrationUnknown::Offset { cable }));
    }
    if wants("pulley-radii") {
        let names: Vec<Option<&str>> =
            robot.cables.iter().map(|cable| cable.anchor.pulley.as_ref().map(|pulley| pulley.name.as_str())).collect();
        let is_first = |cable: &usize| names[*cable].is_some() && !names[..*cable].contains(&names[*cable]);
        let first: Vec<usize> = (0..count).filter(is_first).collect();
        if first.is_empty() {
            bail!("⟪unknowns⟫: no cable of the robot file runs over a pulley: leave out pulley-radii");
        }
        unknowns.extend(first.into_iter().map(|cable| CalibrationUnknown::PulleyRadius { cable }));
    }
    let common = [
        ("scale", CalibrationUnknown::Scale),
        ("axial-stiffness", CalibrationUnknown::AxialStiffness),
        ("mass", CalibrationUnknown::Mass),
        ("support-stiffness", CalibrationUnknown::SupportStiffness),
    ];
    unknowns.extend(common.into_iter().filter(|(name, _)| wants(name)).map(|(_, unknown)| unknown));
    if unknowns.is_empty() {
        bail!("⟪hold_anchors⟫ holds every unknown: leave a cable out of it, or name further ⟪unknowns⟫");
    }
    Ok(unknowns)
}

fn check_tension_range(request: &CalibrateRequest) -> Result<()> {
    let Some([low, high]) = request.tension_range_n else { return Ok(()) };
    if !(low.is_finite() && high.is_finite() && 0.0 <= low && low < high) {
        bail!("⟪tension_range_n⟫ {low}:{high} is no range: give the smallest and the largest tension, as in 20:120");
    }
    if request.static_model == StaticModel::Ideal {
        bail!("⟪tension_range_n⟫ is of elastic cables: choose a ⟪static_model⟫, or leave it out");
    }
    Ok(())
}

/// Mean and standard deviation of equal chances in a range.
fn prior_of_range([low, high]: [f64; 2]) -> (f64, f64) {
    (0.5 * (low + high), (high - low) / 12.0_f64.sqrt())
}

/// The calibration with the priors of a request.
fn with_priors(request: &CalibrateRequest, of: Calibration) -> Result<Calibration> {
    let start = of.start();
    let mut priors: Vec<Option<(f64, f64)>> = vec![None; start.len()];
    for prior in &request.prior {
        let PriorValue { path, prior: value, prior_std } = prior;
        let wrong = |reason: String| anyhow!("⟪prior⟫ {path}: {reason}");
        crate::values::positive(*prior_std).map_err(wrong)?;
        for k in choice::chosen("prior", path, &of.unknowns, &of.robot)? {
            let [in_file, _] = of.meaning(k, start[k]);
            let value = crate::values::finite(value.unwrap_or(in_file)).map_err(wrong)?;
            let is_positive = !matches!(
                of.unknowns[k],
                CalibrationUnknown::Anchor { .. }
                    | CalibrationUnknown::Attachment { .. }
                    | CalibrationUnknown::Offset { .. }
            );
            if is_positive && value <= 0.0 {
                bail!("⟪prior⟫ {path}: {value} is not positive");
            }
            if priors[k].replace((value, *prior_std)).is_some() {
                bail!("⟪prior⟫ {path}: {} has a prior already", words::path(&of.robot, &of.unknowns[k]).0);
            }
        }
    }
    let priors: Vec<(usize, f64, f64)> =
        priors.iter().enumerate().filter_map(|(k, prior)| prior.map(|(value, std)| (k, value, std))).collect();
    Ok(of.with_priors(&priors))
}

/// Refuses a name that no unknown has.
fn check_names(key: &str, names: &[String]) -> Result<()> {
    let known = UNKNOWNS.map(str::to_owned);
    match names.iter().find(|name| !known.contains(name)) {
        Some(unknown) => bail!("⟪{key}⟫: there is no `{unknown}`{}", suggestion(unknown, &known)),
        None => Ok(()),
    }
}

/// Indices of cables by their names.
fn cables_of(key: &str, names: &[String], robot: &Robot) -> Result<Vec<usize>> {
    let known: Vec<String> = robot.cables.iter().map(|cable| cable.name.clone()).collect();
    let index = |name: &String| {
        known
            .iter()
            .position(|cable| cable == name)
            .ok_or_else(|| anyhow!("⟪{key}⟫: there is no cable `{name}`{}", suggestion(name, &known)))
    };
    names.iter().map(index).collect()
}

/// Frame of a request.
fn frame_choice(request: &CalibrateRequest, robot: &Robot) -> Result<FrameChoice> {
    if request.frame.iter().any(|name| name == INNER) && !robot.cables.iter().any(|cable| cable.name == INNER) {
        if request.frame.len() > 1 {
            bail!("⟪frame⟫: {INNER} stands alone, without names of cables");
        }
        return Ok(FrameChoice::Inner);
    }
    Ok(FrameChoice::Anchors(cables_of("frame", &request.frame, robot)?))
}

/// Deviation in millimetres for sentences.
fn in_mm(value: f64) -> String {
    format!("{} mm", significant(1e3 * value, 3))
}

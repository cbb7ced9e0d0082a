//! Figures of requests: what each command draws.

use super::axis::ChartAxis;
use super::chart::{Chart, Entry, Layer, Panel, Sample};
use super::drawing::{BLACK, Stroke};
use super::space::{RobotShape, Space};
use super::style::{self, GREY, ModelStyle, Symbol};
use super::{
    Figure, FigureContent, bars, calibration, estimated, gusts, motions, pairs, proved, sections, settling, simulated,
    winches,
};
use crate::figure_style::{MODE_TICKS, ModeTick, rgb};
use anyhow::{Result, bail};
use funicular::cable::CableModel;
use funicular::cable_motion::CableStations;
use funicular::dynamics::{Dynamics, Linearisation};
use funicular::math::Vec3;
use funicular::modes::{self, Mode};
use funicular::robot::Robot;
use funicular_study::Watch;
use funicular_study::analyses::calibrate::Calibrated;
use funicular_study::analyses::clearance::Clearances;
use funicular_study::analyses::compare::Compared;
use funicular_study::analyses::estimate::Estimated;
use funicular_study::analyses::frf;
use funicular_study::analyses::gust::Gusty;
use funicular_study::analyses::loads::Loads;
use funicular_study::analyses::modes::with_rigid_cables;
use funicular_study::analyses::payload::Payload;
use funicular_study::analyses::prove::Proved;
use funicular_study::analyses::settle::Settled;
use funicular_study::analyses::simulate::Simulated;
use funicular_study::analyses::speeds::Speeds;
use funicular_study::analyses::trajectory::TrajectoryResult;
use funicular_study::analyses::winches::Winches;
use funicular_study::analyses::workspace::Workspace;
use funicular_study::at_rest::{self, AtRest, ModesBelow};
use funicular_study::names::Named;
use funicular_study::request;
use funicular_study::text::{counted, decimals, significant};

/// Figure with its warnings.
pub struct RequestFigure {
    /// The figure.
    pub figure: Figure,
    /// Sentences that the user should know before trusting the figure.
    pub warnings: Vec<String>,
}

/// Makes the figure of a decay that has been computed before.
pub fn of_decay(found: &Settled) -> Figure {
    Figure(FigureContent::Chart(settling::chart(found)))
}

/// Makes the figure of the sections of a workspace.
///
/// # Errors
/// No section, or sections along several axes.
pub fn of_sections(found: &Workspace) -> Result<Figure> {
    Ok(Figure(FigureContent::Chart(sections::chart(found)?)))
}

/// Makes the figure of a proof: a section with the three sets.
///
/// # Errors
/// A box without an area.
pub fn of_proof(found: &Proved) -> Result<Figure> {
    Ok(Figure(FigureContent::Chart(proved::chart(found)?)))
}

/// Makes the figure of a calibration that has been computed before.
pub fn of_calibration(found: &Calibrated) -> Figure {
    Figure(FigureContent::Chart(calibration::chart(found)))
}

/// Makes the figure of an estimate that has been computed before.
pub fn of_estimate(found: &Estimated) -> Figure {
    Figure(FigureContent::Chart(estimated::chart(found)))
}

/// Makes the figure of a simulation that has been computed before.
pub fn of_simulation(found: &Simulated) -> Figure {
    Figure(FigureContent::Chart(simulated::chart(found)))
}

/// Makes the figure of a trajectory that has been computed before. The robot has the limits.
pub fn of_trajectory(robot: &Robot, found: &TrajectoryResult) -> Figure {
    Figure(FigureContent::Chart(motions::chart(robot, found)))
}

/// Makes the figure of the distances at rest or on a move.
///
/// # Errors
/// A robot without a pair.
pub fn of_clearance(found: &Clearances) -> Result<Figure> {
    Ok(Figure(FigureContent::Chart(pairs::chart(found)?)))
}

/// Makes the figure of the winches that are needed, with those on offer.
pub fn of_winches(found: &Winches, offers: &[request::OfferedWinch]) -> Figure {
    Figure(FigureContent::Chart(winches::needed(found, offers)))
}

/// Makes the figure of the speeds of the winches.
pub fn of_speeds(found: &Speeds) -> Figure {
    Figure(FigureContent::Chart(winches::speeds(found)))
}

/// Makes the figure of the tensions with the minimum and the maximum payload.
///
/// # Errors
/// Payloads without limits.
pub fn of_payload(found: &Payload) -> Result<Figure> {
    Ok(Figure(FigureContent::Chart(bars::of_payload(found)?)))
}

/// Makes the figure of the tensions with the largest multiple of the required loads.
///
/// # Errors
/// A robot without a largest multiple.
pub fn of_loads(found: &Loads) -> Result<Figure> {
    Ok(Figure(FigureContent::Chart(bars::of_loads(found)?)))
}

fn chart(chart: Chart, warnings: Vec<String>) -> RequestFigure {
    RequestFigure { figure: Figure(FigureContent::Chart(chart)), warnings }
}

fn entry(text: impl Into<String>, sample: Sample) -> Entry {
    Entry { text: text.into(), sample }
}

/// Makes the figure of the robot at its equilibrium.
///
/// # Errors
/// The errors of `statics`.
pub fn of_statics(of: &request::StaticsRequest) -> Result<Figure> {
    Ok(of_rest(&at_rest::equilibrium(of.robot.read()?.robot, &of.robot, &of.state, &of.tensions)?))
}

/// Makes the figure of a robot at a known equilibrium.
pub fn of_rest(at_rest: &AtRest) -> Figure {
    let space = Space::new(&at_rest.robot, &at_rest.equilibrium, None, Vec::new());
    Figure(FigureContent::Space(Box::new(space)))
}

/// Makes the figure of the spectra of a response to gusts.
pub fn of_gust(found: &Gusty) -> Figure {
    Figure(FigureContent::Chart(gusts::chart(found)))
}

/// Makes the spectrum of the natural frequencies, or the shape of one mode, whose number counts from 1.
///
/// # Errors
/// The errors of `modes`, and a number that the list does not have.
pub fn of_modes(of: &request::ModesRequest, mode: Option<usize>) -> Result<RequestFigure> {
    let at_rest =
        at_rest::equilibrium(of.robot.read()?.robot, &of.robot, &of.state, &of.tensions)?.vibrating().into_owned();
    let (dynamics, found, warnings) = if of.rigid_cables {
        let (found, warnings) = with_rigid_cables(&at_rest, of)?;
        (None, found, warnings)
    } else {
        let linearisation = at_rest::linearisation(&of.model, at_rest.equilibrium.model);
        let limit = at_rest.modes_limit(of.below_hz, linearisation)?;
        let ModesBelow { dynamics, modes, warnings } = at_rest.modes_below(linearisation, limit, modes::MAX_MODES)?;
        (Some(dynamics), modes, warnings)
    };
    let Some(number) = mode else {
        return Ok(chart(spectrum(&at_rest.robot.name, &found), warnings));
    };

    let Some(mode) = number.checked_sub(1).and_then(|k| found.modes.get(k)) else {
        bail!(
            "⟪figure_mode⟫ is {number}, but there {} below {} Hz: give 1 to {}, or raise ⟪below_hz⟫",
            if found.modes.len() == 1 {
                "is 1 mode".to_owned()
            } else {
                format!("are {}", counted(found.modes.len(), "mode"))
            },
            found.below_hz,
            found.modes.len()
        );
    };
    let moved = mode_shape(&at_rest, dynamics.as_ref(), mode)?;
    let head = vec![format!(
        "Mode {number}: {} Hz, {}; dashed: at equilibrium",
        decimals(mode.frequency_hz, 3),
        mode.kind.name()
    )];
    let space = Space::new(&at_rest.robot, &at_rest.equilibrium, Some(moved), head);
    Ok(RequestFigure { figure: Figure(FigureContent::Space(Box::new(space))), warnings })
}

/// Symbol of a kind of mode in a spectrum.
fn kind_symbol(tick: &ModeTick) -> Symbol {
    let shape = match tick.kind {
        modes::Kind::Cable => style::SymbolShape::Circle,
        modes::Kind::Drive => style::SymbolShape::Triangle,
        modes::Kind::Mixed => style::SymbolShape::Diamond,
        modes::Kind::Platform => style::SymbolShape::Square,
    };
    Symbol { shape, colour: rgb(tick.colour) }
}

/// Stroke of the stems and ticks of a kind of mode.
fn kind_stroke(tick: &ModeTick) -> Stroke {
    Stroke::solid(rgb(tick.colour), tick.width_pt)
}

/// Platform's share of the kinetic energy of every mode, over frequency.
fn spectrum(name: &str, found: &modes::Modes) -> Chart {
    let (mut layers, mut legend) = (Vec::new(), Vec::new());
    for tick in &MODE_TICKS {
        let of_kind: Vec<&Mode> = found.modes.iter().filter(|mode| mode.kind == tick.kind).collect();
        if of_kind.is_empty() {
            continue;
        }

        let symbol = kind_symbol(tick);
        let points: Vec<(f64, f64)> =
            of_kind.iter().map(|mode| (mode.frequency_hz, 100.0 * mode.platform_energy_fraction)).collect();
        let stems = points.iter().flat_map(|(x, y)| [(*x, 0.0), (*x, *y), (f64::NAN, 0.0)]).collect();
        layers.push(Layer::Line { points: stems, stroke: kind_stroke(tick) });
        layers.push(Layer::Symbols { points, symbol });
        legend.push(entry(format!("{} ({})", tick.kind.name(), of_kind.len()), Sample::Symbol(symbol)));
    }

    let y = ChartAxis::linear("platform's share of energy [%]", -5.0, 105.0)
        .with_labels([0, 25, 50, 75, 100].map(|share| (f64::from(share), share.to_string())).to_vec());
    Chart {
        title: format!("{name}: natural frequencies"),
        x: ChartAxis::linear("natural frequency [Hz]", 0.0, found.below_hz),
        panels: vec![Panel::new(y, 0.42, layers)],
        legend,
        colour_bar: None,
    }
}

/// Largest displacement of a drawn mode, relative to the diagonal of the robot.
const REACH: f64 = 0.06;
/// Maximum slope of a drawn wave along a cable, and maximum rotation of the platform [rad]: with more, linear rotation
/// visibly distorts the platform.
const MAX_SLOPE: f64 = 0.9;
const MAX_TURN: f64 = 0.3;
/// Number of drawn points per half wave of the cable with most waves, and minimum number along a cable.
const PER_HALF_WAVE: f64 = 12.0;
const MIN_STATIONS: usize = 65;
const MAX_STATIONS: usize = 2001;

/// Shape of the robot in a mode, enlarged so that the motion is visible. Without `dynamics` the cables stay straight.
fn mode_shape(at_rest: &AtRest, dynamics: Option<&Dynamics>, mode: &Mode) -> Result<RobotShape> {
    let AtRest { robot, equilibrium, .. } = at_rest;
    let half_waves = equilibrium
        .cables
        .iter()
        .enumerate()
        .map(|(i, state)| {
            let string_hz = funicular::cable::Sag::of(robot, i, state).string_frequency_hz();
            if string_hz > 0.0 { mode.frequency_hz / string_hz } else { 0.0 }
        })
        .fold(0.0, f64::max);
    let count = ((PER_HALF_WAVE * half_waves).min(1e6) as usize).clamp(MIN_STATIONS, MAX_STATIONS);
    let fractions: Vec<f64> = (0..count).map(|k| k as f64 / (count - 1) as f64).collect();

    let s = mode.shape;
    let (shift, turn) = (Vec3::new(s[0], s[1], s[2]), Vec3::new(s[3], s[4], s[5]));
    let rigid = |p: Vec3| shift + turn.cross(&(p - equilibrium.pose.position_w));

    let (mut points, mut motions) = (Vec::new(), Vec::new());
    for (i, state) in equilibrium.cables.iter().enumerate() {
        let Some(dynamics) = dynamics else {
            points.push(vec![state.attachment_w, state.anchor_w]);
            motions.push(vec![rigid(state.attachment_w), Vec3::zeros()]);
            continue;
        };
        let stations = CableStations::new(robot, equilibrium, dynamics, i, &fractions, false)?;
        let axes = [stations.axes.e, stations.axes.n, stations.axes.b];
        let world = |u: [f64; 3]| axes[0] * u[0] + axes[1] * u[1] + axes[2] * u[2];
        motions.push(stations.in_mode(dynamics, mode).into_iter().map(world).collect::<Vec<Vec3>>());
        points.push(stations.points_w);
    }
    let corners: Vec<Vec3> = equilibrium.cables.iter().map(|state| state.attachment_w).collect();
    let centre = equilibrium.pose.point_w(&robot.platform.center_of_mass_p);

    // The amplitude at which the first of the three limits is reached.
    let largest = motions.iter().flatten().copied().chain(corners.iter().map(|p| rigid(*p)));
    let largest = largest.fold(0.0_f64, |most, u| most.max(u.norm()));
    let mut steepest: f64 = 0.0;
    for (line, u) in points.iter().zip(&motions) {
        for k in 1..line.len() {
            steepest = steepest.max((u[k] - u[k - 1]).norm() / (line[k] - line[k - 1]).norm());
        }
    }
    let everything: Vec<Vec3> = points.iter().flatten().copied().collect();
    let diagonal = super::view::extent(&everything);
    let limit = |most: f64, of: f64| if of > 0.0 { most / of } else { f64::INFINITY };
    let amplitude = limit(REACH * diagonal, largest).min(limit(MAX_SLOPE, steepest)).min(limit(MAX_TURN, turn.norm()));
    let amplitude = if amplitude.is_finite() { amplitude } else { 0.0 };

    let cables = points.into_iter().zip(motions);
    Ok(RobotShape {
        cables: cables.map(|(line, u)| line.into_iter().zip(u).map(|(p, u)| p + u * amplitude).collect()).collect(),
        corners: corners.into_iter().map(|p| p + rigid(p) * amplitude).collect(),
        mass_centre: centre + rigid(centre) * amplitude,
    })
}

/// Maximum number of natural frequencies marked in a response; more would be a grey band.
const MAX_MARKS: usize = 400;
/// Maximum range of a magnitude; a lower value leaves the figure at the bottom.
const MAX_DECADES: f64 = 8.0;
/// Minimum distance between the numbers at two peaks, as a fraction of the axis.
const LABEL_DISTANCE: f64 = 0.05;

/// Makes the figure of magnitude and phase of a frequency response, with its natural frequencies.
///
/// # Errors
/// The errors of `frf`, and responses with several units.
pub fn of_frf(of: &request::FrfRequest, watch: &mut dyn Watch) -> Result<RequestFigure> {
    let robot = of.robot.read()?.robot;
    // A curve has every peak at its height, whatever the requested frequencies.
    let at_rest = at_rest::equilibrium(robot.clone(), &of.robot, &of.state, &of.tensions)?;
    let linearisation = at_rest::linearisation(&of.model, at_rest.equilibrium.model);
    let range = at_rest.response_range(&of.range, linearisation)?;
    let of = &request::FrfRequest { adaptive: true, range: range.into(), ..of.clone() };
    let found = frf::run(robot, of, watch)?;
    let mut warnings = found.warnings.clone();
    refuse_several_units(&found)?;
    let first_pair = &found.responses[0];
    let (marks, caveat) = marks(&at_rest, linearisation, range.to_hz)?;
    warnings.extend(caveat);
    let hz = &found.frequency_hz;
    let (first, last) = (range.from_hz, range.to_hz);
    let x_axis = || {
        if of.range.log {
            ChartAxis::logarithmic("frequency [Hz]", first, last)
        } else {
            ChartAxis::linear("frequency [Hz]", first, last)
        }
    };

    // Magnitude. Its range leaves out the first twentieth of an even axis, where an accelerance falls to zero.
    let (mut magnitudes, mut phases, mut legend) = (Vec::new(), Vec::new(), Vec::new());
    let (mut low, mut high) = (f64::INFINITY, 0.0_f64);
    let counts = |f: f64| of.range.log || f > first + 0.05 * (last - first);
    for (i, pair) in found.responses.iter().enumerate() {
        let values = || hz.iter().zip(pair.real.iter().zip(&pair.imag));
        let magnitude: Vec<(f64, f64)> = values().map(|(f, (re, im))| (*f, re.hypot(*im))).collect();
        for (_, m) in magnitude.iter().filter(|(f, m)| counts(*f) && *m > 0.0) {
            (low, high) = (low.min(*m), high.max(*m));
        }
        let stroke = style::curve(i);
        legend.push(entry(format!("{} / {}", pair.output, pair.input), Sample::Line(stroke.clone())));
        magnitudes.push(Layer::Line { points: magnitude, stroke: stroke.clone() });
        phases.push(Layer::Line { points: phase(values()), stroke });
    }
    // Numbers stand above the peaks; over several curves they would not show to which one they belong.
    let peaks = if found.responses.len() == 1 { labelled_peaks(&first_pair.peaks, &x_axis()) } else { Vec::new() };
    let y = magnitude_axis(&first_pair.unit, low, high, !peaks.is_empty());
    magnitudes.push(Layer::Upright { texts: peaks, colour: BLACK });

    let phase_axis = ChartAxis::linear("phase [°]", -190.0, 190.0).with_labels(
        [-180, -90, 0, 90, 180].map(|angle: i32| (f64::from(angle), angle.to_string().replace('-', "−"))).to_vec(),
    );
    let mut panels = vec![Panel::new(y, 0.5, magnitudes), Panel::new(phase_axis, 0.24, phases)];

    // Natural frequencies below, by kind.
    let (stems, entries) = stems(&marks, first, last);
    legend.extend(entries);
    if !stems.is_empty() {
        panels.push(Panel { bare: true, ..Panel::new(ChartAxis::linear("", 0.0, 1.0), 0.05, stems) });
    }
    Ok(chart(
        Chart { title: format!("{}: frequency response", found.robot), x: x_axis(), panels, legend, colour_bar: None },
        warnings,
    ))
}

fn refuse_several_units(found: &frf::Frf) -> Result<()> {
    let unit = &found.responses[0].unit;
    if let Some(other) = found.responses.iter().find(|pair| pair.unit != *unit) {
        bail!(
            "a figure shows responses with one unit, and these have {unit} and {}: choose ⟪input⟫ and ⟪output⟫ with \
             one unit, or write .csv or .json",
            other.unit
        );
    }
    Ok(())
}

/// Axis of a magnitude between two values, with room above the curves, and more if there are `numbers` above the peaks.
fn magnitude_axis(unit: &str, low: f64, high: f64, numbers: bool) -> ChartAxis {
    let low = low.max(high / 10_f64.powf(MAX_DECADES));
    let (low, high) = if high > 0.0 { (low, high) } else { (0.1, 1.0) };
    let above = if numbers { 0.3 } else { 0.06 };
    let room = (high / low).log10().max(0.5);
    ChartAxis::logarithmic(
        format!("magnitude [{unit}]"),
        low * 10_f64.powf(-0.05 * room),
        high * 10_f64.powf(above * room),
    )
}

/// Stems of the natural frequencies, by kind, and the legend's entries. A kind without any in the range is left out.
fn stems(marks: &[Mode], first: f64, last: f64) -> (Vec<Layer>, Vec<Entry>) {
    let (mut stems, mut legend) = (Vec::new(), Vec::new());
    for tick in &MODE_TICKS {
        let x: Vec<f64> = marks.iter().filter(|mode| mode.kind == tick.kind).map(|mode| mode.frequency_hz).collect();
        if !x.iter().any(|x| (first..=last).contains(x)) {
            continue;
        }
        let stroke = kind_stroke(tick);
        legend.push(entry(format!("{} mode", tick.kind.name()), Sample::Stem(stroke.clone())));
        stems.push(Layer::Stems { x, from: 0.0, to: tick.height, stroke });
    }
    (stems, legend)
}

/// Phase [°] of a response in (−180°, 180°], with gaps where it wraps, so that no line crosses the figure.
fn phase<'a>(values: impl Iterator<Item = (&'a f64, (&'a f64, &'a f64))>) -> Vec<(f64, f64)> {
    let mut phase: Vec<(f64, f64)> = Vec::new();
    for (f, (re, im)) in values {
        let degrees = im.atan2(*re).to_degrees();
        // An undamped response is real; the sign of its zero imaginary part has no meaning.
        let degrees = if degrees <= -179.99 { 180.0 } else { degrees };
        if phase.last().is_some_and(|(_, before)| (degrees - before).abs() > 270.0) {
            phase.push((f64::NAN, f64::NAN));
        }
        phase.push((*f, degrees));
    }
    phase
}

/// Natural frequencies up to the end of a response, and the reason if they are not marked.
fn marks(at_rest: &AtRest, linearisation: Linearisation, to_hz: f64) -> Result<(Vec<Mode>, Option<String>)> {
    let (dynamics, _) = at_rest.dynamics(linearisation, to_hz)?;
    if let Err(too_many) = modes::check_count(&dynamics, to_hz, MAX_MARKS) {
        return Ok((Vec::new(), Some(format!("natural frequencies are not marked: {too_many}"))));
    }
    let found = modes::below(&dynamics, to_hz);
    let caveat = found.caveat();
    Ok((found.modes, caveat))
}

/// Most prominent peaks at a minimum distance from each other, with their frequencies.
fn labelled_peaks(peaks: &[frf::PeakRow], x: &ChartAxis) -> Vec<(f64, f64, String)> {
    let mut order: Vec<&frf::PeakRow> = peaks.iter().collect();
    order.sort_by(|a, b| b.prominence_db.total_cmp(&a.prominence_db));
    let mut kept: Vec<&frf::PeakRow> = Vec::new();
    for peak in order {
        let apart = |other: &&frf::PeakRow| {
            (x.fraction(peak.frequency_hz) - x.fraction(other.frequency_hz)).abs() > LABEL_DISTANCE
        };
        if kept.iter().all(apart) {
            kept.push(peak);
        }
    }
    kept.iter().map(|peak| (peak.frequency_hz, peak.magnitude, significant(peak.frequency_hz, 3))).collect()
}

/// Smallest difference that is drawn [%]; smaller ones are drawn at this value.
const MIN_DIFFERENCE: f64 = 1e-4;
/// Position of modes that a model lacks [%], and the ratio between the lines of two models.
const LACKING: f64 = 60.0;
const LINE: f64 = 1.8;

/// Makes the figure of the differences between the natural frequencies of each cable model and those of the reference.
pub fn of_compare(found: &Compared) -> Figure {
    let reference = found.models.iter().find(|model| model.cable_model == found.reference);
    let all: Vec<f64> = reference.map_or_else(Vec::new, |model| model.modes.iter().map(|m| m.frequency_hz).collect());
    let (mut layers, mut legend) = (Vec::new(), Vec::new());
    let tolerance = 100.0 * found.tolerance;
    let limit = Stroke { colour: GREY, width: 0.7, dashes: vec![1.0, 1.5] };
    layers.push(Layer::Line { points: vec![(0.0, tolerance), (found.below_hz, tolerance)], stroke: limit.clone() });

    let mut highest = LACKING;
    let mut lacking_any = false;
    let others = found.models.iter().filter(|model| model.cable_model != found.reference && model.error.is_none());
    for model in others {
        let symbol = of_model(model.cable_model);
        let points = model
            .matches
            .iter()
            .map(|of| (of.reference_hz, (100.0 * of.relative_difference.abs()).max(MIN_DIFFERENCE)));
        layers.push(Layer::Symbols { points: points.collect(), symbol });
        legend.push(entry(model.cable_model, Sample::Symbol(symbol)));
        highest *= LINE;
        let has = |index: usize| model.matches.iter().any(|of| of.reference_index == index);
        let lacking: Vec<(f64, f64)> =
            all.iter().enumerate().filter(|(i, _)| !has(*i)).map(|(_, hz)| (*hz, highest)).collect();
        lacking_any |= !lacking.is_empty();
        layers.push(Layer::Symbols { points: lacking, symbol: Symbol { shape: style::SymbolShape::Cross, ..symbol } });
    }
    legend.push(entry(format!("{} %", significant(tolerance, 2)), Sample::Line(limit)));
    if lacking_any {
        let cross = Symbol { shape: style::SymbolShape::Cross, colour: BLACK };
        legend.push(entry("mode that the model of this colour lacks", Sample::Symbol(cross)));
    }
    let y = ChartAxis::logarithmic("difference [%]", 0.7 * MIN_DIFFERENCE, highest * LINE).with_labels(
        [(1e-4, "≤ 10^{−4}"), (1e-3, "10^{−3}"), (1e-2, "0.01"), (0.1, "0.1"), (1.0, "1"), (10.0, "10")]
            .map(|(at, text)| (at, text.to_owned()))
            .to_vec(),
    );
    Figure(FigureContent::Chart(Chart {
        title: format!("{}: cable models", found.robot),
        x: ChartAxis::linear("natural frequency [Hz]", 0.0, found.below_hz),
        panels: vec![Panel::new(y, 0.55, layers)],
        legend,
        colour_bar: None,
    }))
}

/// Symbol of a cable model, in its colour of all figures.
fn of_model(name: &str) -> Symbol {
    let style = ModelStyle::of(CableModel::from_name(name).unwrap_or_default());
    Symbol { shape: style.shape, colour: rgb(style.colour) }
}

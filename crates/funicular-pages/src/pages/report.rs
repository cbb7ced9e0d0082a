//! Report of one robot at one state: statics, stiffness, modes, response and comparison of cable models on one page.

mod gradients;
mod of_request;
mod parts;

pub use of_request::{about, of_request};

use super::Shell;
use super::figure::response::{Marks, ResponseCurve};
use super::figure::shapes::{self, Shapes};
use super::figure::{PageFigure, response, robot as drawing};
use super::table::{PageTable, fixed, significant};
use crate::figures::style::ModelStyle;
use anyhow::Context as _;
use askama::Template;
use funicular::cable::CableModel;
use funicular::cable_motion::CableMotionError;
use funicular::dynamics::{Assembly, Dynamics, Linearisation};
use funicular::math::{Vec6, rotation};
use funicular::modes::{self, Kind, Modes};
use funicular::pose_error::PoseDifference;
use funicular::response::{Peak, Quantity};
use funicular::robot::Robot;
use funicular::statics::{Equilibrium, Stability, StaticModel};
use funicular_study::analyses::modes::FirstPlatformMode;
use funicular_study::analyses::shared::{LoadRow, WindRow};
use funicular_study::at_rest::{AtRest, ModesBelow};
use funicular_study::text::{counted, short};

/// Minimum prominence of a listed peak [dB].
const PEAK_PROMINENCE_DB: f64 = 3.0;

/// Maximum number of modes on a page; a browser still scrolls their table smoothly.
const MAX_MODES: usize = 2000;

/// Input of a report.
pub(crate) struct ReportInput<'a> {
    /// Robot and its state.
    pub(crate) at_rest: &'a AtRest,
    /// Path of the robot file, or a description if there is no file.
    pub(crate) file_label: &'a str,
    /// Text of the robot file.
    pub(crate) robot_text: &'a str,
    /// Linearisation about the equilibrium: cable model and assembly.
    pub(crate) linearisation: Linearisation,
    /// Upper limit of the frequencies [Hz].
    pub(crate) below_hz: f64,
    /// Minimum fraction of the kinetic energy in the platform for the first mode of the platform.
    pub(crate) platform_share: f64,
    /// Name and 6-vector of the exciting force or moment.
    pub(crate) frf_input: (String, Vec6),
    /// Name, 6-vector and quantity of the measured motion.
    pub(crate) frf_output: (String, Vec6, Quantity),
    /// Unit of motion per excitation.
    pub(crate) frf_unit: &'a str,
    /// Command that writes this page again.
    pub(crate) command_line: String,
}

#[derive(Template)]
#[template(path = "report.html")]
struct ReportPage<'a> {
    shell: Shell,
    source: &'a str,
    key: Vec<(&'static str, String)>,
    state: String,
    robot_figure: PageFigure,
    platform_figure: PageFigure,
    tension_table: PageTable,
    drive_table: Option<PageTable>,
    support_table: Option<PageTable>,
    friction_table: Option<PageTable>,
    tension_figure: PageFigure,
    sag_figure: PageFigure,
    stiffness_table: Option<PageTable>,
    modes_text: String,
    modes_figure: PageFigure,
    shapes: Result<Shapes, String>,
    modes_table: PageTable,
    held_table: Option<PageTable>,
    gradients: Result<PageFigure, String>,
    response_figure: PageFigure,
    peaks_table: PageTable,
    response_notes: Vec<String>,
    comparison: Result<parts::ComparisonPart, String>,
    warnings: Vec<String>,
    command_line: &'a str,
    file_label: &'a str,
    robot_text: &'a str,
}

/// Sections: id and name.
pub(crate) const CONTENTS: &[(&str, &str)] = &[
    ("robot", "Robot"),
    ("tensions", "Tensions and sag"),
    ("stiffness", "Static stiffness"),
    ("modes", "Natural frequencies"),
    ("response", "Frequency response"),
    ("comparison", "Cable models"),
    ("warnings", "Warnings"),
    ("repeat", "How to repeat"),
];

/// Page of a report, with its warnings.
pub struct Report {
    /// HTML text.
    pub html: String,
    /// Warnings, one sentence each; they are also on the page.
    pub warnings: Vec<String>,
}

/// Writes the page.
///
/// # Errors
/// A robot that cannot be linearised at this state with the requested model, or that has no finite response there.
pub(crate) fn report(input: &ReportInput<'_>) -> anyhow::Result<Report> {
    let ReportInput { at_rest, linearisation, below_hz, .. } = *input;
    let AtRest { robot, equilibrium, .. } = at_rest;
    let ModesBelow { dynamics, modes: found, mut warnings } =
        at_rest.modes_with_strains(linearisation, below_hz, MAX_MODES)?;
    let (response_figure, peaks_table, response_notes) = response_part(input, &dynamics, &found)?;
    warnings.extend(at_rest.without_damping());
    let ratios: Vec<f64> = found.modes.iter().map(|mode| mode.damping_ratio).collect();
    warnings.extend(modes::caveat_of_stretch(robot, &found.modes, &ratios, input.platform_share));

    let page = ReportPage {
        shell: Shell::new(robot.name.clone(), CONTENTS),
        source: robot.source.trim_end_matches('.'),
        key: key_numbers(at_rest, &found, input.platform_share),
        state: state_text(equilibrium),
        robot_figure: drawing::complete(robot, equilibrium),
        platform_figure: drawing::close_up(robot, equilibrium),
        tension_table: parts::tension_table(at_rest),
        drive_table: parts::drive_table(robot, equilibrium),
        support_table: parts::support_table(robot, equilibrium),
        friction_table: parts::friction_table(at_rest),
        tension_figure: parts::tension_figure(robot, equilibrium),
        sag_figure: parts::sag_figure(robot, equilibrium),
        stiffness_table: parts::stiffness_table(robot, equilibrium),
        modes_text: modes_text(linearisation, &found),
        modes_figure: response::strip(&found),
        shapes: shapes_of(&at_rest.vibrating(), &dynamics, &found),
        modes_table: parts::modes_table(robot, &found),
        held_table: parts::held_table(robot, equilibrium, linearisation, &found),
        gradients: gradients::first_frequencies(at_rest, input.robot_text, &dynamics, &found)
            .map_err(|reason| prose(&format!("Derivatives of the first frequencies are not shown: {reason}."))),
        response_figure,
        peaks_table,
        response_notes,
        comparison: parts::comparison(robot, equilibrium, below_hz, linearisation),
        warnings: warnings.iter().map(|warning| prose(&sentence(warning))).collect(),
        command_line: &input.command_line,
        file_label: input.file_label,
        robot_text: input.robot_text,
    };

    let html = page.render().context("the report could not be written as HTML")?;
    Ok(Report { html, warnings })
}

/// Template that turns text in backticks into code. Messages of the core put code in backticks.
#[derive(Template)]
#[template(
    source = "{% for (code, text) in parts %}{% if *code %}<code>{{ text }}</code>{% else %}{{ text }}{% endif %}{% endfor %}",
    ext = "html"
)]
struct Prose<'a> {
    parts: Vec<(bool, &'a str)>,
}

/// HTML of a message.
fn prose(text: &str) -> String {
    Prose { parts: text.split('`').enumerate().map(|(i, text)| (i % 2 == 1, text)).collect() }.to_string()
}

/// Sentence of a message: with a capital first letter and a full stop. Messages of the core begin in lower case.
fn sentence(text: &str) -> String {
    let mut letters = text.chars();
    let first: String = letters.next().into_iter().flat_map(char::to_uppercase).collect();
    format!("{first}{}.", letters.as_str())
}

fn key_numbers(at_rest: &AtRest, found: &Modes, platform_share: f64) -> Vec<(&'static str, String)> {
    let AtRest { robot, equilibrium, .. } = at_rest;
    let p = equilibrium.pose.position_w;
    let tensions = || equilibrium.cables.iter().map(|c| c.tension_platform);
    let (minimum, maximum) = (tensions().fold(f64::INFINITY, f64::min), tensions().fold(f64::NEG_INFINITY, f64::max));

    let mut key = vec![
        ("platform mass", format!("{} kg", significant(robot.platform.mass, 4))),
        ("position x, y, z", format!("{}, {}, {} m", fixed(p.x, 4), fixed(p.y, 4), fixed(p.z, 4))),
    ];
    if robot.platform.motion.can_turn() {
        let [roll, pitch, yaw] = rotation::to_roll_pitch_yaw_deg(&equilibrium.pose.rot_wp);
        key.push(("roll, pitch, yaw", format!("{}, {}, {} °", fixed(roll, 2), fixed(pitch, 2), fixed(yaw, 2))));
    }

    if let Some(load) = LoadRow::of(&robot.load) {
        key.push(("load", load.text()));
    }
    if let Some(wind) = WindRow::of(&robot.wind) {
        key.push(("wind", wind.text()));
    }

    if let Some(held) = &at_rest.held_pose {
        let [x, y, z] = PoseDifference::between(held, &equilibrium.pose).translation.map(|part| fixed(1e3 * part, 2));
        key.push(("displacement at held lengths", format!("{x}, {y}, {z} mm")));
    }
    if let Some(rule) = &at_rest.rule {
        key.push(("tension rule", rule.name().to_owned()));
    }

    key.push(("tensions at the platform", format!("{} to {} N", significant(minimum, 4), significant(maximum, 4))));
    if let Some(first) = found.modes.first() {
        key.push(("first natural frequency", format!("{} Hz", significant(first.frequency_hz, 4))));
    }

    let of_platform = match FirstPlatformMode::of(found, platform_share) {
        Some(first) => format!(
            "{} Hz (no. {}, {} % of its energy in the platform)",
            significant(first.frequency_hz, 4),
            first.index + 1,
            fixed(100.0 * first.platform_energy_fraction, 0)
        ),
        None => format!(
            "none below {} Hz with {} % of its energy in the platform",
            found.below_hz,
            short(100.0 * platform_share, 4)
        ),
    };
    key.push(("first platform mode", of_platform));

    let count = found.modes.len();
    let certified = if found.certified { "certified complete" } else { "not certified" };
    key.push(("natural frequencies", format!("{count} below {} Hz, {certified}", found.below_hz)));
    key
}

fn state_text(equilibrium: &Equilibrium) -> String {
    let model = match equilibrium.model {
        StaticModel::Ideal => "ideal cables (straight, massless, inextensible)",
        StaticModel::Spring => "straight elastic cables without weight",
        StaticModel::Catenary => "elastic catenaries",
    };
    let stability = match equilibrium.stability {
        Stability::Stable { min_stiffness } => {
            format!("stable (minimum eigenvalue of the scaled stiffness: {} N/m)", significant(min_stiffness, 3))
        }
        Stability::Unstable { directions, min_stiffness: 0.0 } => {
            format!("indifferent in {directions} of its directions")
        }
        Stability::Unstable { directions, .. } => format!("unstable in {directions} of its directions"),
        Stability::Rigid => "rigid".to_owned(),
    };
    format!(
        "Static equilibrium with {model}, found to a scaled residual of {}; it is {stability}.",
        significant(equilibrium.residual, 1)
    )
}

fn modes_text(linearisation: Linearisation, found: &Modes) -> String {
    let of = |kind: Kind| found.modes.iter().filter(|m| m.kind == kind).count();
    let assembly = match linearisation.assembly {
        Assembly::Consistent => "consistent assembly",
        Assembly::WithoutGeometricStiffness => "assembly without geometric stiffness, as in Yuan et al. 2014",
    };
    let plane = if linearisation.in_plane_only { ", cables with in-plane stiffness only" } else { "" };

    let certified = if found.certified {
        format!(
            "The Wittrick–Williams count gives {} below {} Hz, {}",
            counted(found.count_below, "natural frequency"),
            found.below_hz,
            if found.count_below == 1 { "and it is listed" } else { "and all of them are listed" }
        )
    } else {
        format!(
            "The Wittrick–Williams count gives {} below {} Hz, but the list has {}: it is not certified",
            counted(found.count_below, "natural frequency"),
            found.below_hz,
            found.modes.len()
        )
    };

    let mut kinds = vec![
        counted(of(Kind::Platform), "platform mode"),
        counted(of(Kind::Cable), "cable mode"),
        counted(of(Kind::Mixed), "mixed mode"),
    ];
    // Drives without inertia have no modes of their own.
    kinds.extend((of(Kind::Drive) > 0).then(|| counted(of(Kind::Drive), "drive mode")));

    let model = linearisation.cable_model.name();
    format!("Cable model: {model}; {assembly}{plane}. {certified}. Kinds: {}.", kinds.join(", "))
}

/// View of the mode shapes, or the reason why there is none and how to get it.
fn shapes_of(at_rest: &AtRest, dynamics: &Dynamics, found: &Modes) -> Result<Shapes, String> {
    let reason = match Shapes::new(&at_rest.robot, &at_rest.equilibrium, dynamics, found) {
        Ok(Some(shapes)) => return Ok(shapes),
        Ok(None) if found.modes.is_empty() => "there is no mode below the limit. Raise `--below-hz`".to_owned(),
        Ok(None) => "the first mode needs more data than a page may hold".to_owned(),
        Err(error @ CableMotionError::Model(_)) => {
            format!("{error}. Write this page with `--cable-model catenary-dynamic`")
        }
        Err(error) => error.to_string(),
    };
    Err(prose(&format!("Mode shapes are not shown: {reason}.")))
}

/// Responses with the requested model and with all other models that work at this state.
fn response_part(
    input: &ReportInput<'_>,
    dynamics: &Dynamics,
    found: &Modes,
) -> anyhow::Result<(PageFigure, PageTable, Vec<String>)> {
    let ReportInput { at_rest, linearisation, below_hz, frf_unit: unit, .. } = *input;
    let AtRest { robot, equilibrium, .. } = &*at_rest.vibrating();
    let (force, u) = &input.frf_input;
    let (motion, v, quantity) = &input.frf_output;

    let draw = |dynamics: &Dynamics, found: &Modes| {
        let model = dynamics.linearisation.cable_model;
        let at = (dynamics, below_hz, &found.modes[..]);
        ResponseCurve::of(model.name(), ModelStyle::of(model), at, u, &[*v], *quantity)
    };

    let mut curves = vec![draw(dynamics, found)?];
    let mut notes = Vec::new();
    for cable_model in
        [CableModel::CatenaryDynamic, CableModel::ShallowDynamic, CableModel::ShallowStatic, CableModel::Spring]
    {
        if cable_model == linearisation.cable_model {
            continue;
        }
        let other = Dynamics::about(robot, equilibrium, Linearisation { cable_model, ..linearisation }, below_hz);
        match other.map_err(|e| e.to_string()).and_then(|other| {
            let found = modes::below(&other, below_hz);
            draw(&other, &found).map_err(|e| e.to_string())
        }) {
            Ok(curve) => curves.push(curve),
            Err(reason) => {
                notes.push(prose(&format!(
                    "The response with the model {} is not drawn: {reason}.",
                    cable_model.name()
                )));
            }
        }
    }

    let tops = curves[0].peaks(PEAK_PROMINENCE_DB);
    notes.extend(without_peaks(&curves[0], &tops, robot));
    let caption = format!(
        "Response of {motion} to {force}: magnitude and phase. Ticks: natural frequencies with the model {}; numbers: \
         frequencies [Hz] of its most prominent peaks. Models with constant cable stiffness (spring, shallow-static, \
         catenary-static) have no damping; their resonances exceed the figure.",
        linearisation.cable_model.name()
    );

    let marks = Marks { modes: &found.modes, peaks: &tops, published: None, phase: true };
    let figure = response::figure("figure-response", caption, unit, below_hz, &curves, &marks);
    Ok((figure, peaks_table(&tops, found, unit), notes))
}

/// Sentence in place of peaks: resonances without damping have no height.
fn without_peaks(curve: &ResponseCurve, tops: &[Peak], robot: &Robot) -> Option<String> {
    let cause = if robot.is_damped() {
        format!("the cable model {} has no damping", curve.name)
    } else {
        "nothing in the robot file damps vibration".to_owned()
    };
    let undamped = curve.undamped();
    (undamped > 0).then(|| {
        format!(
            "{} without height: {cause}, so the response has no bound there{}.",
            counted(undamped, "resonance"),
            if tops.is_empty() { ", and the table of peaks is empty" } else { "" }
        )
    })
}

fn peaks_table(tops: &[Peak], found: &Modes, unit: &str) -> PageTable {
    let mut table = PageTable::new(
        "table-peaks",
        format!(
            "Peaks of the response with a prominence of at least {PEAK_PROMINENCE_DB} dB. There are fewer peaks than \
             natural frequencies: a mode gives a peak only if force and sensor act on it and damping does not merge it \
             with its neighbours.",
        ),
        &[
            "frequency|Hz",
            "prominence|dB",
            &format!("magnitude|{unit}"),
            "nearest natural frequency|Hz",
            "<kind of that mode",
        ],
    );

    for peak in tops {
        let distance = |f: f64| (f - peak.frequency_hz).abs();
        let nearest = found.modes.iter().min_by(|a, b| distance(a.frequency_hz).total_cmp(&distance(b.frequency_hz)));

        table.row(vec![
            fixed(peak.frequency_hz, 3),
            fixed(peak.prominence_db, 1),
            significant(peak.magnitude, 3),
            nearest.map_or_else(|| "–".to_owned(), |m| fixed(m.frequency_hz, 3)),
            nearest.map_or("–", |m| m.kind.name()).to_owned(),
        ]);
    }

    table
}

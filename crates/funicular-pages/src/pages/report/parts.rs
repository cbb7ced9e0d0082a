//! Tables and bar charts of a report.

use super::prose;
use crate::pages::figure::{self, PageFigure, axis, colour, plain, rounded};
use crate::pages::table::{PageTable, fixed, listed};
use funicular::cable::{SHALLOW_SAG_LIMIT, Sag};
use funicular::compare::{self, Comparison, Criterion};
use funicular::dynamics::{Dynamics, Linearisation};
use funicular::math::Vec3;
use funicular::modes::{Kind, Mode, Modes};
use funicular::robot::{Anchor, Robot};
use funicular::statics::{Equilibrium, StaticModel, drag_stiffness, tangent_with_drag};
use funicular_study::analyses::{modes, statics};
use funicular_study::at_rest::AtRest;
use funicular_study::text::NONE;
use serde_json::{Value, json};

/// Maximum number of frequencies listed in a row of the table of models.
const MAX_LISTED: usize = 16;

fn sags(robot: &Robot, equilibrium: &Equilibrium) -> Vec<Sag> {
    equilibrium.cables.iter().enumerate().map(|(i, state)| Sag::of(robot, i, state)).collect()
}

/// Table of lengths, tensions and sag of every cable.
pub(crate) fn tension_table(at_rest: &AtRest) -> PageTable {
    let rows = statics::cable_rows(at_rest);
    let columns = statics::CableRow::columns(&rows);
    let caption = format!(
        "Cables at equilibrium. Sag/chord: the shallow models hold up to 0.05, tinted rows are beyond. λ²: Irvine's \
         parameter, which compares the stiffness of the sag with that of the rope. String: √(τ/m)/(2l), the first \
         natural frequency of the taut cable alone.{}",
        if rows.iter().any(|row| row.limits.is_some()) {
            " Margin: distance of the tension from its nearest limit; negative beyond it."
        } else {
            ""
        }
    );
    let straight = at_rest.equilibrium.model != StaticModel::Catenary;
    PageTable::marked("table-tensions", caption, &columns, &rows, |row| {
        if row.sag.sag_ratio.is_some_and(|ratio| ratio > SHALLOW_SAG_LIMIT) && !straight { "flag" } else { "" }
    })
}

/// Table of the interval in which friction of pulleys leaves pose and tensions; `None` without friction, and if
/// friction may move the platform without limit.
pub(crate) fn friction_table(at_rest: &AtRest) -> Option<PageTable> {
    let found = statics::FrictionRow::of(at_rest).ok()?;
    let range = |[min, max]: [f64; 2], digits: usize| format!("{} to {}", fixed(min, digits), fixed(max, digits));

    let motion = match &found.motion {
        Some(motion) => {
            let mm = motion.translation_m.map(|pair| range(pair.map(|metres| 1e3 * metres), 3)).join(", ");
            let degrees = motion.rotation_deg.map(|pair| range(pair, 4)).join(", ");
            format!(
                "With the lengths held, the pose is this far from the equilibrium: translation along x, y, z {mm} mm, \
                 rotation about x, y, z {degrees}°."
            )
        }
        None => "The pose and the tensions at the platform are held.".to_owned(),
    };

    let caption = format!(
        "Friction of pulleys: minimum to maximum if every cable may have run last towards the platform or towards its \
         drum. {motion} All other results leave friction out."
    );

    let columns = statics::FrictionCableRow::columns(found.motion.is_some());
    Some(PageTable::of("table-friction", caption, &columns, &found.cables))
}

/// Table of pulleys and winches at equilibrium; `None` if all cables end at fixed points.
pub(crate) fn drive_table(robot: &Robot, equilibrium: &Equilibrium) -> Option<PageTable> {
    if robot.cables.iter().all(|cable| cable.anchor.is_fixed()) {
        return None;
    }

    let mut table = PageTable::new(
        "table-drives",
        "Pulleys and winches. Wrap: angle over which the cable touches its wheel. The unstrained length of a cable is \
         the sum of its free span, the arc on the wheel and the drum side."
            .to_owned(),
        &[
            "<cable",
            "<pulley",
            "<winch",
            "wrap|°",
            "tension, exit|N",
            "tension, drum|N",
            "free span|m",
            "arc|m",
            "drum side|m",
            "<exit point|m",
        ],
    );

    for (cable, row) in robot.cables.iter().zip(&equilibrium.cables) {
        let name = |name: Option<&String>| name.map_or_else(|| NONE.to_owned(), Clone::clone);
        let contact = row.drive.as_ref().and_then(|drive| drive.contact);
        let wrap = contact.or_else(|| cable.anchor.contact(&row.attachment_w)).map(|contact| contact.wrap.to_degrees());

        let [arc, drum_side] = match &row.drive {
            Some(drive) => [drive.arc_length, drive.drum_side_length],
            // Ideal cables.
            None => {
                [row.unstrained_length - row.chord() - cable.anchor.drum_side_length(), cable.anchor.drum_side_length()]
            }
        };

        let free = row.unstrained_length - arc - drum_side;
        let exit = row.anchor_w;
        table.row(vec![
            cable.name.clone(),
            name(cable.anchor.pulley.as_ref().map(|pulley| &pulley.name)),
            name(cable.anchor.winch.as_ref().map(|winch| &winch.name)),
            wrap.map_or_else(|| NONE.to_owned(), |wrap| fixed(wrap, 2)),
            fixed(row.tension_anchor, 3),
            fixed(row.tension_drum(), 3),
            fixed(free, 4),
            fixed(arc, 4),
            fixed(drum_side, 4),
            format!("{}, {}, {}", fixed(exit.x, 4), fixed(exit.y, 4), fixed(exit.z, 4)),
        ]);
    }

    Some(table)
}

/// Table of flexible supports at equilibrium; `None` on a rigid frame.
pub(crate) fn support_table(robot: &Robot, equilibrium: &Equilibrium) -> Option<PageTable> {
    if !robot.has_supports() {
        return None;
    }

    let mut table = PageTable::new(
        "table-supports",
        "Flexible supports. Displacement: of the anchors from their places without forces, world axes. Force: of all \
         cables on the support, world axes."
            .to_owned(),
        &["<support", "<cables", "<displacement|mm", "<force|N"],
    );

    let moved = equilibrium.support_displacements(robot);

    for (i, (support, displacement_w)) in robot.supports.iter().zip(moved).enumerate() {
        let carried = robot.cables.iter().filter(|cable| cable.anchor.support == Some(i));
        let vector = |v: Vec3, digits: usize| [v.x, v.y, v.z].map(|entry| fixed(entry, digits)).join(", ");
        table.row(vec![
            support.name.clone(),
            carried.map(|cable| cable.name.as_str()).collect::<Vec<_>>().join(", "),
            vector(displacement_w * 1e3, 3),
            vector(support.stiffness_w * displacement_w, 1),
        ]);
    }

    Some(table)
}

/// Maximum number of modes in the table with held exit points.
const MAX_HELD: usize = 10;

/// Table of the first natural frequencies beside those with held exit points; `None` if all cables end at fixed points
/// of a rigid frame, or if there are none with held exit points.
///
/// A cable that cannot slip at its exit point is a robot with more constraints, so that no frequency is lower.
pub(crate) fn held_table(
    robot: &Robot,
    equilibrium: &Equilibrium,
    linearisation: Linearisation,
    found: &Modes,
) -> Option<PageTable> {
    let held = modes_with_held_exits(robot, equilibrium, linearisation, found.below_hz)?;

    let mut table = PageTable::new(
        "table-held",
        "First natural frequencies with pulleys, winches and flexible supports, and at the same equilibrium with the \
         exit points held, so that the cables neither slip there nor move sideways. Both lists are ascending; the n-th \
         frequency with held exit points is never lower."
            .to_owned(),
        &["no.", "as given|Hz", "exit points held|Hz", "difference|%"],
    );

    for (i, mode) in found.modes.iter().take(MAX_HELD).enumerate() {
        let other = held.get(i);
        table.row(vec![
            (i + 1).to_string(),
            fixed(mode.frequency_hz, 4),
            other.map_or_else(|| format!("above {}", found.below_hz), |hz| fixed(*hz, 4)),
            other.map_or_else(|| NONE.to_owned(), |hz| fixed(100.0 * (hz / mode.frequency_hz - 1.0), 2)),
        ]);
    }

    Some(table)
}

/// Natural frequencies below a limit [Hz] with every cable held at its exit point; `None` if all cables end at fixed
/// points, or if the robot cannot be linearised.
fn modes_with_held_exits(
    robot: &Robot,
    equilibrium: &Equilibrium,
    linearisation: Linearisation,
    below_hz: f64,
) -> Option<Vec<f64>> {
    if !robot.has_supports() && equilibrium.cables.iter().all(|state| state.drive.is_none()) {
        return None;
    }
    let (robot, equilibrium) = equilibrium.with_dynamic_stiffness(robot);
    let (mut robot, mut equilibrium) = (robot.into_owned(), equilibrium.into_owned());
    for (cable, state) in robot.cables.iter_mut().zip(&mut equilibrium.cables) {
        cable.anchor = Anchor::from(state.anchor_w);
        state.unstrained_length = state.free_length();
        state.drive = None;
    }
    let dynamics = Dynamics::about(&robot, &equilibrium, linearisation, below_hz).ok()?;
    Some(funicular::modes::below(&dynamics, below_hz).modes.iter().map(|mode| mode.frequency_hz).collect())
}

/// Names of the cables, escaped for plotly.
fn names(robot: &Robot) -> Vec<String> {
    robot.cables.iter().map(|c| plain(&c.name)).collect()
}

fn bars(name: &str, names: &[String], values: &[f64], colour: &str, unit: &str) -> Value {
    json!({
        "type": "bar", "name": name, "x": names, "y": rounded(values), "marker": {"color": colour},
        "hovertemplate": format!("cable %{{x}}<br>%{{y:.4g}} {unit}"),
    })
}

/// Bar chart of the tensions.
pub(crate) fn tension_figure(robot: &Robot, equilibrium: &Equilibrium) -> PageFigure {
    let of = |end: fn(&funicular::statics::CableState) -> f64| equilibrium.cables.iter().map(end).collect::<Vec<_>>();
    let data = [
        bars("at the platform", &names(robot), &of(|c| c.tension_platform), colour::BLUE, "N"),
        bars("at the anchor", &names(robot), &of(|c| c.tension_anchor), colour::SKY, "N"),
    ];
    let layout = json!({
        "barmode": "group", "bargap": 0.3, "xaxis": axis("cable", json!({"type": "category", "ticks": ""})),
        "yaxis": axis("tension [N]", json!({"rangemode": "tozero"})),
    });
    PageFigure::new("figure-tensions", 300, "Tension at both ends of the cables.", &data, layout)
}

/// Minimum of the axis of sag over chord: that of cables without mass has another number than zero at its end.
const MIN_SHOWN_SAG: f64 = 1e-9;

/// Bar chart of the sag, with the limit of the shallow models.
pub(crate) fn sag_figure(robot: &Robot, equilibrium: &Equilibrium) -> PageFigure {
    let ratios: Vec<f64> = sags(robot, equilibrium).iter().map(Sag::ratio).collect();
    let maximum = ratios.iter().copied().filter(|r| r.is_finite()).fold(0.0, f64::max);

    // The limit is drawn only if the bars stay visible beside it.
    let near = maximum > 0.2 * SHALLOW_SAG_LIMIT;
    let shapes = if near {
        json!([{
            "type": "line", "xref": "paper", "x0": 0, "x1": 1, "y0": SHALLOW_SAG_LIMIT, "y1": SHALLOW_SAG_LIMIT,
            "line": {"color": colour::VERMILION, "width": 1.4, "dash": "dash"},
        }])
    } else {
        json!([])
    };

    let top = 1.12 * if near { maximum.max(SHALLOW_SAG_LIMIT) } else { maximum.max(MIN_SHOWN_SAG) };
    let layout = json!({
        "bargap": 0.45, "showlegend": false, "shapes": shapes,
        "xaxis": axis("cable", json!({"type": "category", "ticks": ""})),
        "yaxis": axis("sag ratio d/l", json!({"range": [0, top], "exponentformat": "power"})),
    });

    let caption = if near {
        "Sag divided by chord; dashed: 1/20, the limit of the models shallow-static and shallow-dynamic."
    } else {
        "Sag divided by chord, far below 1/20, the limit of the models shallow-static and shallow-dynamic."
    };

    PageFigure::new("figure-sag", 300, caption, &[bars("d/l", &names(robot), &ratios, colour::BLUE, "")], layout)
}

/// Table of the static stiffness with catenaries, consistently assembled.
pub(crate) fn stiffness_table(robot: &Robot, equilibrium: &Equilibrium) -> Option<PageTable> {
    let stiffness = tangent_with_drag(robot, equilibrium)?;
    let possible = robot.platform.motion.components();
    let motions = ["δx|m", "δy|m", "δz|m", "δθx|rad", "δθy|rad", "δθz|rad"];
    let wrenches = ["fx [N]", "fy [N]", "fz [N]", "mx [N·m]", "my [N·m]", "mz [N·m]"];
    let columns: Vec<&str> = std::iter::once("<").chain(possible.iter().map(|&i| motions[i])).collect();

    let units = if robot.platform.motion.can_turn() {
        " Forces per translation in N/m, forces per rotation and moments per translation in N, moments per rotation \
         in N·m."
    } else {
        ""
    };

    let drag = if drag_stiffness(robot, equilibrium).is_some() {
        " The drag of the wind rotates with the cables, so the matrix is not symmetric."
    } else {
        ""
    };

    let mut table = PageTable::new(
        "table-stiffness",
        format!(
            "Static stiffness: wrench needed to hold a small motion, about the platform origin, world axes.{units} \
             Tangent stiffness of the elastic catenaries, with geometric stiffness.{drag}"
        ),
        &columns,
    );

    for &i in &possible {
        let numbers = possible.iter().map(|&j| fixed(stiffness[(i, j)], 2));
        table.row(std::iter::once(wrenches[i].to_owned()).chain(numbers).collect());
    }

    Some(table)
}

/// Table of all modes.
pub(crate) fn modes_table(robot: &Robot, found: &Modes) -> PageTable {
    let (turns, possible) = (robot.platform.motion.can_turn(), robot.platform.motion.components());
    let mut columns =
        vec!["no.", "frequency|Hz", "damping|%", "<kind", "platform energy|%", "<strongest cables|share of the energy"];
    columns.extend(possible.iter().map(|&i| ["δx|m", "δy|m", "δz|m", "θx|rad", "θy|rad", "θz|rad"][i]));

    let mut table = PageTable::new(
        "table-modes",
        format!(
            "All natural frequencies below {} Hz (undamped, multiple ones repeated), damping ratios to first order, \
             and motion of the platform origin in world axes{}. A dash means that the platform does not move.",
            found.below_hz,
            if turns {
                ", scaled so that the largest component of translation and ℓ · rotation is 1"
            } else {
                ", scaled so that the largest component is 1"
            }
        ),
        &columns,
    );

    for (i, mode) in found.modes.iter().enumerate() {
        let rests = mode.shape.iter().all(|s| s.abs() <= 0.0);
        let shape = possible.iter().map(|&i| mode.shape[i]);

        let mut cells = vec![
            (i + 1).to_string(),
            fixed(mode.frequency_hz, 4),
            fixed(100.0 * mode.damping_ratio, 3),
            mode.kind.name().to_owned(),
            fixed(100.0 * mode.platform_energy_fraction, 1),
            strongest(robot, mode),
        ];
        cells.extend(shape.map(|s| if rests { "–".to_owned() } else { fixed(s, 3) }));

        table.marked_row(class_of(mode.kind), cells);
    }
    table
}

fn class_of(kind: Kind) -> &'static str {
    match kind {
        Kind::Platform => "platform",
        Kind::Mixed | Kind::Drive => "mixed",
        Kind::Cable => "",
    }
}

/// Names of the cables with the largest shares of a mode's energy.
fn strongest(robot: &Robot, mode: &Mode) -> String {
    let names: Vec<String> = robot.cables.iter().map(|cable| cable.name.clone()).collect();
    let supports: Vec<String> = robot.supports.iter().map(|support| support.name.clone()).collect();
    let of_supports = (&supports[..], &mode.support_energy_fractions[..]);
    let of_cables = (&mode.cable_energy_fractions, &mode.drive_energy_fractions);
    let named: Vec<String> = modes::strongest(&names, of_cables.0, of_cables.1, of_supports)
        .iter()
        .map(|(name, share)| format!("{name} ({} %)", fixed(100.0 * share, 0)))
        .collect();
    if named.is_empty() { NONE.to_owned() } else { named.join(", ") }
}

/// Comparison of the cable models in a report.
pub(crate) struct ComparisonPart {
    /// Advice on the choice of a model, from the core.
    pub(crate) advice: String,
    /// Figure of the differences from the reference model; `None` if the reference has no modes.
    pub(crate) figure: Option<PageFigure>,
    /// Table with one row per model.
    pub(crate) models: PageTable,
    /// Table with one row per mode.
    pub(crate) modes: PageTable,
}

/// Compares all cable models, or gives the reason why they cannot be compared.
pub(crate) fn comparison(
    robot: &Robot,
    equilibrium: &Equilibrium,
    below_hz: f64,
    linearisation: Linearisation,
) -> Result<ComparisonPart, String> {
    let comparison = compare::compare(robot, equilibrium, below_hz, linearisation, Criterion::default())
        .map_err(|error| prose(&format!("The models cannot be compared at this state: {error}.")))?;
    let (models, modes) = (models_table(&comparison), side_by_side(&comparison));
    let figure = figure::models::figure(&comparison);
    let frozen = comparison.frozen_sag.as_ref().map_or_else(String::new, |frozen| format!(" {}", frozen.text()));
    Ok(ComparisonPart { advice: prose(&format!("{}{frozen}", comparison.advice.text)), figure, models, modes })
}

fn models_table(comparison: &Comparison) -> PageTable {
    let mut table = PageTable::new(
        "table-models",
        format!(
            "Natural frequencies of each cable model below {} Hz. Missed: modes of the model {} without a counterpart. \
             First wrong: the lowest natural frequency that is missing or wrong by more than {} %.",
            comparison.below_hz,
            comparison.reference.name(),
            100.0 * compare::TOLERANCE
        ),
        &["<model", "modes", "missed", "first wrong|Hz", "<<natural frequencies|Hz"],
    );

    for result in &comparison.models {
        let is_reference = result.model == comparison.reference;
        let modes = result.modes.as_ref().ok();

        let list = match &result.modes {
            Ok(found) if found.modes.len() > MAX_LISTED => format!(
                "{} from {} to {}",
                found.modes.len(),
                fixed(found.modes[0].frequency_hz, 3),
                fixed(found.modes[found.modes.len() - 1].frequency_hz, 3)
            ),
            Ok(found) => {
                let all: Vec<f64> = found.modes.iter().map(|m| m.frequency_hz).collect();
                let free = match found.unstable_directions {
                    0 => "",
                    1 => "; no stiffness in 1 direction",
                    _ => "; no stiffness in several directions",
                };
                format!("{}{free}", listed(&all, 3))
            }
            // A cell is plain text, so the backticks around code in messages are removed.
            Err(reason) => reason.to_string().replace('`', ""),
        };

        let count = modes.map_or_else(|| "–".to_owned(), |m| m.modes.len().to_string());
        let (missed, first) = if is_reference || modes.is_none() {
            ("–".to_owned(), "–".to_owned())
        } else {
            (result.missed.to_string(), result.first_wrong_hz.map_or_else(|| "none".to_owned(), |f| fixed(f, 3)))
        };

        table.row(vec![result.model.name().to_owned(), count, missed, first, list]);
    }

    table
}

/// Minimum share of the platform in the energy of a mode that is listed as moving the platform: the smallest one that
/// the table, with one decimal of a per cent, does not show as zero. Modes of cables alone have 1e-29 by rounding.
const MIN_SHARE: f64 = 1e-3;

/// Table of the reference's modes that move the platform, with each model's counterpart.
fn side_by_side(comparison: &Comparison) -> PageTable {
    let others: Vec<_> =
        comparison.models.iter().filter(|m| m.model != comparison.reference && m.modes.is_ok()).collect();

    let mut columns =
        vec![format!("{}|Hz", comparison.reference.name()), "<kind".to_owned(), "platform energy|%".to_owned()];
    for other in &others {
        columns.push(format!("{}|Hz", other.model.name()));
        columns.push("difference|%".to_owned());
    }

    let mut table = PageTable::new(
        "table-side-by-side",
        format!(
            "Modes that move the platform, with at least {} % of their energy in it, compared between the models. In a \
             model of constant stiffness (spring, shallow-static, catenary-static) the counterpart is the mode whose \
             platform motion correlates with at least 0.5, in the other models the nearest in frequency. Vibrations of \
             cables alone, which models of constant stiffness do not have, are left out.",
            100.0 * MIN_SHARE
        ),
        &columns.iter().map(String::as_str).collect::<Vec<_>>(),
    );

    let reference = comparison.models.iter().find(|m| m.model == comparison.reference);
    let modes = reference.and_then(|m| m.modes.as_ref().ok()).map_or(&[][..], |m| &m.modes);

    for (index, mode) in modes.iter().enumerate() {
        let pairs: Vec<_> = others.iter().map(|m| m.matches.iter().find(|m| m.reference_index == index)).collect();
        let of_cables = mode.kind == Kind::Cable && pairs.iter().all(Option::is_none);
        if of_cables || mode.platform_energy_fraction < MIN_SHARE {
            continue;
        }

        let mut cells = vec![
            fixed(mode.frequency_hz, 4),
            mode.kind.name().to_owned(),
            fixed(100.0 * mode.platform_energy_fraction, 1),
        ];
        for pair in pairs {
            match pair {
                Some(m) => cells.extend([fixed(m.frequency_hz, 4), signed(100.0 * m.relative_difference)]),
                None => cells.extend(["–".to_owned(), "–".to_owned()]),
            }
        }

        table.row(cells);
    }
    table
}

/// Number with two decimals and its sign, also for positive numbers.
fn signed(value: f64) -> String {
    let text = fixed(value, 2);
    if value > 0.0 && text != "0.00" { format!("+{text}") } else { text }
}

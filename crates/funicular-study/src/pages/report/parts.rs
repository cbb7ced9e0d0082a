//! The report's tables and bars.

use super::prose;
use crate::analyses::modes;
use crate::pages::figure::{self, Figure, axis, colour, model_name, plain, rounded};
use crate::pages::table::{Table, fixed, listed, significant};
use crate::text::NONE;
use funicular::cable::{SHALLOW_SAG_LIMIT, Sag};
use funicular::compare::{self, Comparison};
use funicular::dynamics::Linearisation;
use funicular::modes::{Kind, Mode, Modes};
use funicular::robot::Robot;
use funicular::statics::{Equilibrium, StaticModel, drag_stiffness, tangent_with_drag};
use serde_json::{Value, json};

/// Frequencies that a row of the table of models lists at most.
const LISTED: usize = 16;

fn sags(robot: &Robot, equilibrium: &Equilibrium) -> Vec<Sag> {
    equilibrium.cables.iter().enumerate().map(|(i, state)| Sag::of(robot, i, state)).collect()
}

/// Lengths, tensions and sag of every cable.
pub(crate) fn tension_table(robot: &Robot, equilibrium: &Equilibrium) -> Table {
    let mut table = Table::new(
        "table-tensions",
        "Cables at equilibrium. d/l: sag over chord, shallow up to 0.05 (tinted rows are beyond); λ²: Irvine's parameter, \
         which compares the stiffness of the sag with that of the rope; string frequency: √(τ/m)/(2l), the first of the \
         taut cable by itself.",
        &[
            "<cable",
            "<rope",
            "unstrained length|m",
            "chord|m",
            "tension, platform|N",
            "tension, anchor|N",
            "sag d/l|–",
            "λ²|–",
            "string frequency|Hz",
        ],
    );
    let straight = equilibrium.model != StaticModel::Catenary;
    for ((cable, state), sag) in robot.cables.iter().zip(&equilibrium.cables).zip(sags(robot, equilibrium)) {
        let class = if sag.ratio() > SHALLOW_SAG_LIMIT && !straight { "flag" } else { "" };
        table.marked_row(
            class,
            vec![
                cable.name.clone(),
                cable.material.name.clone(),
                fixed(state.unstrained_length, 4),
                fixed(state.chord(), 4),
                fixed(state.tension_platform, 3),
                fixed(state.tension_anchor, 3),
                fixed(sag.ratio(), 5),
                significant(sag.lambda2, 4),
                significant(sag.string_frequency_hz(), 4),
            ],
        );
    }
    table
}

/// Names of the cables as categories: without this plotly takes "1" for a number.
fn names(robot: &Robot) -> Vec<String> {
    robot.cables.iter().map(|c| plain(&c.name)).collect()
}

fn bars(name: &str, names: &[String], values: &[f64], colour: &str, unit: &str) -> Value {
    json!({
        "type": "bar", "name": name, "x": names, "y": rounded(values), "marker": {"color": colour},
        "hovertemplate": format!("cable %{{x}}<br>%{{y:.4g}} {unit}"),
    })
}

/// Tensions as bars.
pub(crate) fn tension_figure(robot: &Robot, equilibrium: &Equilibrium) -> Figure {
    let of = |end: fn(&funicular::statics::CableState) -> f64| equilibrium.cables.iter().map(end).collect::<Vec<_>>();
    let data = [
        bars("at the platform", &names(robot), &of(|c| c.tension_platform), colour::BLUE, "N"),
        bars("at the anchor", &names(robot), &of(|c| c.tension_anchor), colour::SKY, "N"),
    ];
    let layout = json!({
        "barmode": "group", "bargap": 0.3, "xaxis": axis("cable", json!({"type": "category", "ticks": ""})), "yaxis": axis("tension [N]", json!({"rangemode": "tozero"})),
    });
    Figure::new("figure-tensions", 300, "Tension at both ends of the cables.", &data, layout)
}

/// Sag as bars, against the limit of the shallow models.
pub(crate) fn sag_figure(robot: &Robot, equilibrium: &Equilibrium) -> Figure {
    let ratios: Vec<f64> = sags(robot, equilibrium).iter().map(Sag::ratio).collect();
    let most = ratios.iter().copied().filter(|r| r.is_finite()).fold(0.0, f64::max);
    // The limit is drawn where it does not press the bars to the floor.
    let near = most > 0.2 * SHALLOW_SAG_LIMIT;
    let shapes = if near {
        json!([{
            "type": "line", "xref": "paper", "x0": 0, "x1": 1, "y0": SHALLOW_SAG_LIMIT, "y1": SHALLOW_SAG_LIMIT,
            "line": {"color": colour::VERMILION, "width": 1.4, "dash": "dash"},
        }])
    } else {
        json!([])
    };
    let top = 1.12 * if near { most.max(SHALLOW_SAG_LIMIT) } else { most.max(f64::MIN_POSITIVE) };
    let layout = json!({
        "bargap": 0.45, "showlegend": false, "shapes": shapes, "xaxis": axis("cable", json!({"type": "category", "ticks": ""})),
        "yaxis": axis("sag over chord d/l", json!({"range": [0, top], "exponentformat": "power"})),
    });
    let caption = if near {
        "Sag over chord; dashed: 1/20, up to which the shallow-sag models hold."
    } else {
        "Sag over chord, all far below the 1/20 up to which the shallow-sag models hold."
    };
    Figure::new("figure-sag", 300, caption, &[bars("d/l", &names(robot), &ratios, colour::BLUE, "")], layout)
}

/// The static stiffness of catenaries, consistently assembled.
pub(crate) fn stiffness_table(robot: &Robot, equilibrium: &Equilibrium) -> Option<Table> {
    let stiffness = tangent_with_drag(robot, equilibrium)?;
    let possible = robot.platform.motion.components();
    let motions = ["δx|m", "δy|m", "δz|m", "δθx|rad", "δθy|rad", "δθz|rad"];
    let wrenches = ["fx [N]", "fy [N]", "fz [N]", "mx [N·m]", "my [N·m]", "mz [N·m]"];
    let columns: Vec<&str> = std::iter::once("<").chain(possible.iter().map(|&i| motions[i])).collect();
    let units = if robot.platform.motion.can_turn() {
        " Forces per translation in N/m, forces per rotation and moments per translation in N, moments per rotation in N·m."
    } else {
        ""
    };
    let drag = if drag_stiffness(robot, equilibrium).is_some() {
        " The drag of the wind turns with the cables, so that it is not symmetric."
    } else {
        ""
    };
    let mut table = Table::new(
        "table-stiffness",
        format!(
            "Static stiffness: the wrench that holds a small motion, about the platform origin, world axes.{units} Exact \
             tangent of the cables, with the turning of static forces on their lever arms.{drag}"
        ),
        &columns,
    );
    for &i in &possible {
        let numbers = possible.iter().map(|&j| fixed(stiffness[(i, j)], 2));
        table.row(std::iter::once(wrenches[i].to_owned()).chain(numbers).collect());
    }
    Some(table)
}

/// Every mode.
pub(crate) fn modes_table(robot: &Robot, found: &Modes) -> Table {
    let (turns, possible) = (robot.platform.motion.can_turn(), robot.platform.motion.components());
    let mut columns =
        vec!["no.", "frequency|Hz", "damping|%", "<kind", "platform energy|%", "<strongest cables|share of the energy"];
    columns.extend(possible.iter().map(|&i| ["δx|m", "δy|m", "δz|m", "θx|rad", "θy|rad", "θz|rad"][i]));
    let mut table = Table::new(
        "table-modes",
        format!(
            "All natural frequencies below {} Hz, undamped, with multiplicity; damping ratio to first order; motion of the \
             platform origin, world axes{}. A dash: the platform rests.",
            found.below_hz,
            if turns {
                ", scaled so that the largest of translation and ℓ · rotation is 1"
            } else {
                ", largest part 1"
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
        Kind::Mixed => "mixed",
        Kind::Cable => "",
    }
}

/// Names of the cables with most of a mode's energy.
fn strongest(robot: &Robot, mode: &Mode) -> String {
    let names = robot.cables.iter().map(|cable| cable.name.as_str());
    let named: Vec<String> = modes::strongest(names, &mode.cable_energy_fractions)
        .iter()
        .map(|(name, share)| format!("{name} ({} %)", fixed(100.0 * share, 0)))
        .collect();
    if named.is_empty() { NONE.to_owned() } else { named.join(", ") }
}

/// The comparison of the cable models.
pub(crate) struct ComparisonPart {
    /// Advice of the core.
    pub(crate) advice: String,
    /// How far the models are from the reference, where that has modes.
    pub(crate) figure: Option<Figure>,
    /// One row a model.
    pub(crate) models: Table,
    /// One row a mode.
    pub(crate) modes: Table,
}

/// All cable models side by side, or why they cannot be.
pub(crate) fn comparison(
    robot: &Robot,
    equilibrium: &Equilibrium,
    below_hz: f64,
    linearisation: Linearisation,
) -> Result<ComparisonPart, String> {
    let comparison = compare::compare(robot, equilibrium, below_hz, linearisation)
        .map_err(|error| prose(&format!("The models cannot be compared at this state: {error}.")))?;
    let (models, modes) = (models_table(&comparison), side_by_side(&comparison));
    let figure = figure::models::figure(&comparison);
    Ok(ComparisonPart { advice: prose(&comparison.advice.text), figure, models, modes })
}

fn models_table(comparison: &Comparison) -> Table {
    let mut table = Table::new(
        "table-models",
        format!(
            "What each model finds below {} Hz. Missed: modes of the {} model that it has no counterpart of. First wrong: the \
             lowest natural frequency that it lacks or has wrong by more than {} %.",
            comparison.below_hz,
            model_name(comparison.reference),
            100.0 * compare::TOLERANCE
        ),
        &["<model", "modes", "missed", "first wrong|Hz", "<<natural frequencies|Hz"],
    );
    for result in &comparison.models {
        let is_reference = result.model == comparison.reference;
        let modes = result.modes.as_ref().ok();
        let list = match &result.modes {
            Ok(found) if found.modes.len() > LISTED => format!(
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
            // A cell is plain text; the core quotes what one types in backticks.
            Err(reason) => reason.to_string().replace('`', ""),
        };
        let count = modes.map_or_else(|| "–".to_owned(), |m| m.modes.len().to_string());
        let (missed, first) = if is_reference || modes.is_none() {
            ("–".to_owned(), "–".to_owned())
        } else {
            (result.missed.to_string(), result.first_wrong_hz.map_or_else(|| "none".to_owned(), |f| fixed(f, 3)))
        };
        table.row(vec![model_name(result.model).to_owned(), count, missed, first, list]);
    }
    table
}

/// The reference's modes that move the platform, with each model's counterpart.
fn side_by_side(comparison: &Comparison) -> Table {
    let others: Vec<_> =
        comparison.models.iter().filter(|m| m.model != comparison.reference && m.modes.is_ok()).collect();
    let mut columns =
        vec![format!("{}|Hz", model_name(comparison.reference)), "<kind".to_owned(), "platform energy|%".to_owned()];
    for other in &others {
        columns.push(format!("{}|Hz", model_name(other.model)));
        columns.push("difference|%".to_owned());
    }
    let mut table = Table::new(
        "table-side-by-side",
        "Modes that move the platform, the models side by side; the counterpart in a model of \
         constant stiffness is the mode whose platform motion correlates with at least 0.5, in one of vibrating cables \
         the nearest in frequency. Vibrations of cables alone, which constant stiffnesses do not have, are left out.",
        &columns.iter().map(String::as_str).collect::<Vec<_>>(),
    );
    let reference = comparison.models.iter().find(|m| m.model == comparison.reference);
    let modes = reference.and_then(|m| m.modes.as_ref().ok()).map_or(&[][..], |m| &m.modes);
    for (index, mode) in modes.iter().enumerate() {
        let pairs: Vec<_> = others.iter().map(|m| m.matches.iter().find(|m| m.reference_index == index)).collect();
        if mode.kind == Kind::Cable && pairs.iter().all(Option::is_none) {
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

/// With two decimals and its sign, plus included.
fn signed(value: f64) -> String {
    let text = fixed(value, 2);
    if value > 0.0 && text != "0.00" { format!("+{text}") } else { text }
}

//! Derivatives of equilibria and natural frequencies, compared with a complex step through a separate program.

use super::reference::{GradientReference, GradientRobot, GradientRow, robot};
use super::section::{WRONG, with_scaled};
use super::{
    Bound, Case, ComparedQuantity, Comparison, Declared, DifferenceKind, Level, NegativeControl, largest,
    largest_difference, over, reference, slug, worst,
};
use anyhow::{Context, Result, ensure};
use funicular::dynamics::{Dynamics, Linearisation};
use funicular::gradient::{Gradients, Hold};
use funicular::modes;
use funicular::robot::parameters::Parameters;
use funicular::robot::{Robot, RobotChange};
use funicular::statics::{self, Equilibrium, StaticModel};

/// Largest relative difference of the statics, and of the frequencies.
const STATICS: f64 = 1e-9;
const FREQUENCIES: f64 = 1e-8;

/// Largest relative difference of tensions with the pose held. There the axial stiffness hardly changes them: its
/// derivatives, 1e-9 N/N, are differences of terms a million times as large, whose rounding they have.
const TENSIONS_AT_POSE: f64 = 6e-9;

pub(super) const SECTION: Declared = Declared {
    id: "gradients",
    title: "Gradients",
    note: "Derivatives by numbers of the robot, all from one reverse pass per result, against a complex step of \
           1e-30 through a separate program in 80-bit arithmetic. Each difference is relative to the largest \
           derivative of the same kind by the same number; the table shows the derivatives by the mass of the \
           platform that are largest in the reference, and the largest difference over all numbers.",
    rows: || rows(&reference::gradients()?),
    controls: &[
        NegativeControl {
            id: "ea",
            wrong: "axial stiffness EA of the ropes 1 % too large",
            proves: "the derivatives by the numbers of the ropes",
            rows: || of_changed("axial_stiffness_n"),
        },
        NegativeControl {
            id: "mass",
            wrong: "mass of the platform 1 % too large",
            proves: "the derivatives by the numbers of the platform",
            rows: || of_changed("mass_kg"),
        },
    ],
};

fn rows(reference: &GradientReference) -> Result<Vec<Comparison>> {
    let mut rows = Vec::new();
    for given in &reference.robots {
        let (robot, lengths) = robot(&given.toml)?;
        let rest = statics::forward(&robot, &lengths, StaticModel::Catenary, None)?;
        let case = Case::new(Level::Program, &reference.source, &slug(&given.id), &given.id);
        let position: [f64; 3] = rest.pose.position_w.into();
        rows.push(case.of("position", "position [m]").absolute(&given.position_m, &position, 1e-10, Bound::Rounding));
        for (hold, theirs) in [(Hold::Lengths, &given.lengths_held), (Hold::Pose, &given.pose_held)] {
            compare(given, &case, &robot, &rest, (hold, theirs), &mut rows)?;
        }
    }
    Ok(rows)
}

/// Comparisons of the first robot with a number of its file 1 % too large.
fn of_changed(key: &str) -> Result<Vec<Comparison>> {
    let mut reference = reference::gradients()?;
    reference.robots.truncate(1);
    reference.robots.iter_mut().for_each(|of| of.toml = with_scaled(&of.toml, key, WRONG, usize::MAX));
    rows(&reference)
}

/// Compares all derivatives with lengths or with the pose held.
fn compare(
    given: &GradientRobot,
    case: &Case,
    robot: &Robot,
    rest: &Equilibrium,
    (hold, theirs): (Hold, &[GradientRow]),
    rows: &mut Vec<Comparison>,
) -> Result<()> {
    let parameters = Parameters::from_toml(&given.toml)?;
    let below_hz = 1.1 * given.frequency_hz.iter().fold(0.0_f64, |largest, f| largest.max(*f));
    let dynamics = Dynamics::about(robot, rest, Linearisation::default(), below_hz)?;
    let found = modes::below(&dynamics, below_hz).modes;
    ensure!(found.len() >= given.frequency_hz.len(), "{}: too few modes", given.id);

    let gradients = Gradients::new(robot, rest, hold)?;
    let vibration = gradients.vibration(&dynamics)?;
    let frequencies = (found.iter().take(given.frequency_hz.len()))
        .map(|mode| Ok(vibration.frequency(mode)?))
        .collect::<Result<Vec<_>>>()?;

    let mut push = |(id, what): (&str, &str),
                    gradients: &[RobotChange],
                    row: &dyn Fn(&GradientRow) -> Option<&[f64]>,
                    tolerance| {
        let (id, what) = (format!("{}-held-{id}", hold.name()), format!("{what}, {} held", hold.name()));
        let found = comparison(case.of(&id, &what), (&parameters, gradients), theirs, row, tolerance)?;
        rows.push(found);
        anyhow::Ok(())
    };
    match hold {
        Hold::Lengths => push(("pose", "pose [m, rad]"), &gradients.pose(), &|row| row.pose.as_deref(), STATICS)?,
        Hold::Pose | Hold::Rule => {
            push(("lengths", "unstrained lengths [m]"), &gradients.lengths(), &|row| row.lengths.as_deref(), STATICS)?;
        }
    }
    let of_tensions = if hold == Hold::Pose { TENSIONS_AT_POSE } else { STATICS };
    push(
        ("tensions-platform", "tensions at the platform [N]"),
        &gradients.tensions_platform(),
        &|row| Some(&row.tension_platform),
        of_tensions,
    )?;
    push(
        ("tensions-anchor", "tensions at the anchors [N]"),
        &gradients.tensions_anchor(),
        &|row| Some(&row.tension_anchor),
        of_tensions,
    )?;
    push(("frequencies", "natural frequencies [Hz]"), &frequencies, &|row| Some(&row.frequency_hz), FREQUENCIES)
}

/// Comparison of the derivatives of one kind of results by all numbers.
fn comparison(
    quantity: ComparedQuantity,
    (parameters, gradients): (&Parameters, &[RobotChange]),
    theirs: &[GradientRow],
    of_row: &dyn Fn(&GradientRow) -> Option<&[f64]>,
    tolerance: f64,
) -> Result<Comparison> {
    let (mut shown, mut differences, mut numbers) = (None, Vec::new(), 0);
    for row in theirs {
        let reference = of_row(row).with_context(|| format!("{} lacks a result", row.path))?;
        let change = change(parameters, &row.path)?;
        let ours: Vec<f64> = gradients.iter().map(|gradient| gradient.dot(&change)).collect();
        ensure!(ours.len() == reference.len(), "{}: {} values", row.path, reference.len());
        numbers += reference.len();
        differences.push(over(largest_difference(reference, &ours), largest(reference)));
        let at = (0..reference.len()).max_by(|a, b| reference[*a].abs().total_cmp(&reference[*b].abs())).unwrap_or(0);
        shown.get_or_insert((reference[at], ours[at]));
    }
    let (theirs, ours) = shown.context("no derivatives")?;
    let difference = (worst(differences.into_iter()), DifferenceKind::Relative);
    Ok(quantity.numbers(numbers).row((&[theirs], &[ours]), difference, tolerance, Bound::Elements))
}

/// Change of the robot by a number of its file, or by a value of the rope in one cable only.
fn change(parameters: &Parameters, path: &str) -> Result<RobotChange> {
    let keys: Vec<&str> = path.split('.').collect();
    if let Some(change) = parameters.find(&keys).and_then(|index| parameters.change(index)) {
        return Ok(change);
    }
    let mut change = RobotChange::none(parameters.robot().cables.len());
    let cable = keys.get(1).and_then(|name| parameters.robot().cables.iter().position(|cable| cable.name == *name));
    let cable = &mut change.cables[cable.with_context(|| format!("no number {path}"))?];
    match keys.last() {
        Some(&"axial_stiffness_n") => cable.axial_stiffness = 1.0,
        Some(&"mass_kg_per_m") => cable.mass_per_length = 1.0,
        _ => anyhow::bail!("no number {path}"),
    }
    Ok(change)
}

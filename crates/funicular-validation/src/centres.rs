//! Centre of the tensions: tensions, limits, lengths and their derivatives.

use super::reference::{CentreRow, LengthsAtCentre, ReferenceTable, library_text};
use super::section::WRONG;
use super::{
    Bound, Case, ComparedQuantity, Comparison, Declared, DifferenceKind, Level, NegativeControl, largest,
    largest_difference, over, reference,
};
use anyhow::{Context, Result};
use funicular::gradient::Gradients;
use funicular::math::Vec3;
use funicular::robot::{Pose, Robot, RobotChange, TensionLimits};
use funicular::statics::{StaticModel, TensionCentre, TensionRule, tension_centre};

/// Maximum relative difference: both programs end a search below 1e-12, and the limits are searched to 1e-11.
const SAME: f64 = 1e-9;

/// Maximum difference of derivatives, relative to the largest one of a number: limits and balance are differentiated
/// in closed form.
const DERIVATIVE: f64 = 1e-8;

/// Maximum relative difference of lengths: the reference has them to 1e-12 m.
const SAME_LENGTHS: f64 = 1e-10;

/// Cause that bounds all differences.
const ACCURACY: &str = "accuracy of both searches";

/// Reference and result of one pose.
struct Found<'a> {
    row: &'a CentreRow,
    robot: Robot,
    centre: TensionCentre,
}

pub(super) const SECTION: Declared = Declared {
    id: "centres",
    title: "Centre of the tensions, computed independently",
    note: "The tension rule `centre`: minimum of the logarithms of the distances from the limits, with sagging \
           cables, over fixed anchors and over pulleys; random poses, some near the border, some with a load.",
    rows: || Ok([rows(&reference::centres()?)?, lengths(&reference::centre_lengths()?, 1.0)?].concat()),
    controls: &[
        NegativeControl {
            id: "minimum",
            wrong: "minimum tension 1 % too large",
            proves: "the limits of the tensions",
            rows: || {
                let mut reference = reference::centres()?;
                reference.rows.retain(|row| row.minimum_tension_n.is_some());
                reference
                    .rows
                    .iter_mut()
                    .for_each(|row| row.minimum_tension_n = row.minimum_tension_n.map(|t| t * WRONG));
                rows(&reference)
            },
        },
        NegativeControl {
            id: "maximum",
            wrong: "maximum tension 1 % too large",
            proves: "the limits of the tensions",
            rows: || {
                let mut reference = reference::centres()?;
                reference.rows.retain(|row| row.maximum_tension_n.is_some());
                reference
                    .rows
                    .iter_mut()
                    .for_each(|row| row.maximum_tension_n = row.maximum_tension_n.map(|t| t * WRONG));
                rows(&reference)
            },
        },
        NegativeControl {
            id: "mass",
            wrong: "mass of the platform 1 % too large",
            proves: "the weight of the platform in the lengths of the centre",
            rows: || {
                let mut reference = reference::centre_lengths()?;
                reference.rows.truncate(3);
                lengths(&reference, WRONG)
            },
        },
    ],
};

fn rows(reference: &ReferenceTable<CentreRow>) -> Result<Vec<Comparison>> {
    let mut rows = Vec::new();
    let mut names: Vec<&str> = reference.rows.iter().map(|row| row.robot.as_str()).collect();
    names.dedup();
    for name in names {
        let of_robot = reference.rows.iter().filter(|row| row.robot == name).map(found);
        let all = of_robot.collect::<Result<Vec<_>>>()?;
        let case = Case::new(Level::Program, &reference.source, name, &format!("{name}, {} poses", all.len()));
        rows.extend(at_poses(&case, &all));
        rows.extend(derivatives(&case, &all)?);
    }
    Ok(rows)
}

/// Unstrained lengths of CoGiRo at random positions, with its mass multiplied by a factor.
fn lengths(reference: &ReferenceTable<LengthsAtCentre>, mass_factor: f64) -> Result<Vec<Comparison>> {
    let robot = Robot::from_toml(library_text("cogiro")?)?;
    let mass = mass_factor * robot.platform.mass;
    let robot = robot.with_mass(mass);
    let mut pairs: Vec<Pair> = Vec::new();
    for row in &reference.rows {
        let pose = Pose::new(row.position_m, [0.0; 3]);
        let centre = tension_centre(&robot, &pose, StaticModel::Catenary, None)?;
        let ours = centre.equilibrium.cables.iter().map(|cable| cable.unstrained_length).collect();
        pairs.push((row.unstrained_length_m.clone(), ours));
    }
    let name = format!("cogiro, {} positions", pairs.len());
    let case = Case::new(Level::Program, &reference.source, "cogiro-box", &name);
    let quantity = case.of("lengths", "unstrained lengths [m], worst position");
    Ok(compared(quantity, &pairs, SAME_LENGTHS).into_iter().collect())
}

fn found(row: &CentreRow) -> Result<Found<'_>> {
    let limits = TensionLimits { minimum: row.minimum_tension_n, maximum: row.maximum_tension_n };
    let mut robot = Robot::from_toml(library_text(&row.robot)?)?.with_tension_limits(limits);
    if let Some(mass) = row.mass_kg {
        robot = robot.with_mass(mass);
    }
    if let Some([x, y, z, roll, pitch, yaw]) = row.load_n_nm {
        robot.load.force_w = Vec3::new(x, y, z);
        robot.load.moment_w = Vec3::new(roll, pitch, yaw);
        robot.load.point_p = Vec3::zeros();
    }
    let [x, y, z, roll, pitch, yaw] = row.pose;
    let pose = Pose::new([x, y, z], [roll, pitch, yaw]);
    let centre = tension_centre(&robot, &pose, StaticModel::Catenary, None)?;
    Ok(Found { row, robot, centre })
}

/// Numbers of the reference and of the program at one pose.
type Pair = (Vec<f64>, Vec<f64>);

/// Quantity with its numbers at a pose.
type Quantity<'a> = (&'static str, &'static str, Box<dyn Fn(&Found) -> Pair + 'a>);

/// Comparison of the pair with the largest difference, relative to its largest number.
fn compared(quantity: ComparedQuantity, pairs: &[Pair], tolerance: f64) -> Option<Comparison> {
    let difference = |(theirs, ours): &Pair| over(largest_difference(theirs, ours), largest(theirs));
    let numbers = pairs.iter().map(|(theirs, _)| theirs.len()).sum();
    let worst = pairs.iter().max_by(|a, b| difference(a).total_cmp(&difference(b)))?;
    let kind = (difference(worst), DifferenceKind::Relative);
    Some(quantity.numbers(numbers).row((&worst.0, &worst.1), kind, tolerance, Bound::Digits(ACCURACY)))
}

fn at_poses(case: &Case, all: &[Found]) -> Vec<Comparison> {
    let states = |found: &Found, of: fn(&funicular::statics::CableState) -> f64| -> Vec<f64> {
        found.centre.equilibrium.cables.iter().map(of).collect()
    };
    let limit = |found: &Found, side: usize| -> Vec<f64> { found.centre.limits.iter().map(|of| of[side]).collect() };
    let quantities: [Quantity; 5] = [
        (
            "tensions",
            "tensions along the chords [N], worst pose",
            Box::new(|of| (of.row.tau_n.clone(), of.centre.tensions.clone())),
        ),
        ("lower-limits", "their lower limits [N], worst pose", Box::new(|of| (of.row.lower_n.clone(), limit(of, 0)))),
        ("upper-limits", "their upper limits [N], worst pose", Box::new(|of| (of.row.upper_n.clone(), limit(of, 1)))),
        (
            "tensions-platform",
            "tensions at the platform [N], worst pose",
            Box::new(|of| (of.row.tension_platform_n.clone(), states(of, |cable| cable.tension_platform))),
        ),
        (
            "lengths",
            "unstrained lengths [m], worst pose",
            Box::new(|of| (of.row.unstrained_length_m.clone(), states(of, |cable| cable.unstrained_length))),
        ),
    ];
    let of_quantity = |(id, name, pair): &Quantity| {
        let pairs: Vec<Pair> = all.iter().map(pair).collect();
        compared(case.of(id, name), &pairs, SAME)
    };
    let mut rows: Vec<Comparison> = quantities.iter().filter_map(of_quantity).collect();
    let proved = all.iter().filter(|found| found.centre.certificate.is_unique()).count();
    rows.push(case.of("unique", "poses at which the centre is proved to be the only one").count(all.len(), proved));
    rows
}

/// Derivatives of the lengths, at the poses at which the reference has them.
fn derivatives(case: &Case, all: &[Found]) -> Result<Option<Comparison>> {
    let mut pairs: Vec<Pair> = Vec::new();
    for found in all.iter().filter(|found| !found.row.length_by.is_empty()) {
        let gradients = Gradients::by_rule(&found.robot, &found.centre.equilibrium, &TensionRule::Centre)?;
        let lengths = gradients.lengths();
        for (name, theirs) in &found.row.length_by {
            let change = change_of(&found.robot, name)?;
            pairs.push((theirs.clone(), lengths.iter().map(|length| length.dot(&change)).collect()));
        }
    }
    let quantity = format!("derivatives of the lengths by {} numbers, worst one", pairs.len());
    Ok(compared(case.of("derivatives", &quantity), &pairs, DERIVATIVE))
}

/// Change of the robot or of its pose by one unit of a number.
fn change_of(robot: &Robot, name: &str) -> Result<RobotChange> {
    let mut change = RobotChange::none(robot.cables.len());
    match name {
        "x_m" => change.position_w = Vec3::x(),
        "y_m" => change.position_w = Vec3::y(),
        "z_m" => change.position_w = Vec3::z(),
        "mass_kg" => return Ok(RobotChange::of_mass(robot)),
        "axial_stiffness_n" => change.cables.iter_mut().for_each(|cable| cable.axial_stiffness = 1.0),
        "mass_kg_per_m" => change.cables.iter_mut().for_each(|cable| cable.mass_per_length = 1.0),
        "anchor_x_m" => change.cables.first_mut().context("a cable")?.anchor_w = Vec3::x(),
        "force_x_n" => change.force_w = Vec3::x(),
        other => anyhow::bail!("{other} is no number of centres.json"),
    }
    Ok(change)
}

//! Natural frequencies that were measured on a robot with fewer cables than degrees of freedom.

use super::reference::{MeasuredPose, ReferenceTable};
use super::section::{WRONG, with_scaled};
use super::{Bound, Case, Comparison, Declared, Level, NegativeControl, reference, worst};
use anyhow::{Result, anyhow};
use funicular::math::{Rotation, Vec3};
use funicular::modes;
use funicular::robot::{Pose, Robot, State};
use funicular::statics::{self, StaticModel};

/// Frequency limit of the lists of modes [Hz]: far above all frequencies of the robot's free motions.
const BELOW_HZ: f64 = 100.0;

/// Difference that the search for the nearest pose leaves: it ends at 1e-11 of the robot's size, which is 3 m.
const POSE: f64 = 1e-9;

/// Difference of a mean in per cent that the search leaves.
const PERCENT: f64 = 1e-7;

/// Difference of the change by fixed points [%] between the measured pose, where their forces balance only in least
/// squares, and the nearest pose that they hold: a tenth of the change.
const BALANCED: f64 = 0.2;

/// Relative width of the window around the source's model in which the source looked for a measured peak.
const WINDOW: f64 = 0.07;

pub(super) const SECTION: Declared = Declared {
    id: "few-cables",
    title: "Measured natural frequencies of a robot with few cables",
    note: "The prototype of the University of Bologna, a platform on four, three or two cables over swivelling \
           pulleys, at 69 poses. Lengths and model frequencies are the source's own model: cables without mass and \
           rigid in length. The measured frequencies are not independent of that model. The source looked for each \
           peak within 7 % of its model's frequency, so that none can differ by more, and a wrong model would \
           still agree to 7 %. Mean and root mean square say more: the measured frequencies are higher by 1.3 %. \
           The oscillations were large, up to several centimetres and degrees, and the program's modes are linear.",
    rows: || rows(&reference::measured()?.grab, &|cables| Ok(Robot::from_toml(text(cables)?)?)),
    controls: &[
        NegativeControl {
            id: "radius",
            wrong: "radius of every pulley 1 % too large",
            proves: "the arc on the pulley, in lengths and frequencies",
            rows: || {
                rows(&some_poses()?, &|cables| {
                    Ok(Robot::from_toml(&with_scaled(text(cables)?, "radius_m", WRONG, usize::MAX))?)
                })
            },
        },
        NegativeControl {
            id: "inertia",
            wrong: "moments of inertia of the platform 1 % too large",
            proves: "the rotation of the platform in its modes",
            rows: || {
                rows(&some_poses()?, &|cables| {
                    Ok(Robot::from_toml(&with_scaled(text(cables)?, "inertia_kg_m2", WRONG, usize::MAX))?)
                })
            },
        },
    ],
};

fn rows(table: &ReferenceTable<MeasuredPose>, robot: &dyn Fn(usize) -> Result<Robot>) -> Result<Vec<Comparison>> {
    let mut rows = Vec::new();
    let (mut measured, mut refitted, mut by_pulleys) = (Vec::new(), Vec::new(), Vec::new());
    for row in &table.rows {
        let found = at_pose(row, robot(row.cables)?, &table.source)?;
        measured.extend(found.measured);
        refitted.extend(found.refitted);
        by_pulleys.extend(found.by_pulleys);
        rows.extend(found.rows);
    }

    let theirs: Vec<f64> = table.rows.iter().flat_map(|row| differences(&row.measured_hz, &row.model_hz)).collect();
    let case = Case::new(Level::Measured, &table.source, "all", &format!("all {} measured frequencies", theirs.len()));
    rows.push(
        case.of("mean-rms", "mean and root mean square of the difference from the model [%]")
            .numbers(theirs.len())
            .absolute(&mean_and_rms(&theirs), &mean_and_rms(&measured), PERCENT, Bound::Rounding),
    );

    // The same records, fitted over time instead of read from spectra.
    let theirs: Vec<f64> = table.rows.iter().flat_map(|row| differences(&row.refitted_hz, &row.model_hz)).collect();
    let case =
        Case::new(Level::Measured, &table.source, "refitted", &format!("all {} refitted frequencies", theirs.len()));
    rows.push(
        case.of("mean-rms", "mean and root mean square of the difference from the model [%]")
            .numbers(theirs.len())
            .absolute(&mean_and_rms(&theirs), &mean_and_rms(&refitted), PERCENT, Bound::Rounding),
    );

    let pairs = table.rows.iter().flat_map(|row| row.fixed_points_hz.iter().zip(&row.model_hz));
    let theirs: Vec<f64> = pairs.map(|(fixed, model)| fixed / model - 1.0).collect();
    rows.push(
        case.of("fixed-points", "mean and root mean square of the change by fixed points instead of pulleys [%]")
            .absolute(
                &mean_and_rms(&theirs),
                &mean_and_rms(&by_pulleys),
                BALANCED,
                Bound::Model("balance at the pose"),
            ),
    );

    Ok(rows)
}

/// Comparisons of a pose, the relative differences of its measured frequencies from the model's, and the relative
/// changes of the model's frequencies by fixed points instead of pulleys.
struct AtPose {
    rows: Vec<Comparison>,
    measured: Vec<f64>,
    refitted: Vec<f64>,
    by_pulleys: Vec<f64>,
}

fn at_pose(row: &MeasuredPose, mut robot: Robot, source: &str) -> Result<AtPose> {
    let [a, b, c] = row.angles_xyz_rad;
    let turned = |axis: Vec3, angle: f64| Rotation::from_scaled_axis(axis * angle);
    let rot_wp = turned(Vec3::x(), a) * turned(Vec3::y(), b) * turned(Vec3::z(), c);
    robot.state = State::Pose(Pose { position_w: Vec3::from(row.position_m), rot_wp });

    // The pose is an equilibrium, so that the nearest pose is the requested one.
    let solution = statics::solve(&robot, StaticModel::Ideal, None)?;
    let distance = solution.requested_pose.map_or(f64::NAN, |(_, distance)| distance);
    let rest = solution.equilibrium;
    let lengths: Vec<f64> = rest.cables.iter().map(|cable| cable.unstrained_length).collect();
    let found = modes::with_rigid_cables(&robot, &rest, BELOW_HZ)?;
    let frequencies: Vec<f64> = found.modes.iter().map(|mode| mode.frequency_hz).collect();

    let case = Case::new(
        Level::Program,
        source,
        &format!("{}-cables/{}", row.cables, row.experiment),
        &format!("{} cables, experiment {}", row.cables, row.experiment),
    );
    let mut rows = vec![
        case.of("nearest-pose", "distance to the nearest pose [m]").absolute(
            &[0.0],
            &[distance],
            POSE,
            Bound::Rounding,
        ),
        case.of("lengths", "lengths [m]").absolute(&row.lengths_m, &lengths, POSE, Bound::Rounding),
        case.of("model", "model frequencies [Hz]").relative(&row.model_hz, &frequencies, POSE, Bound::Rounding),
    ];

    // Measured frequencies beside those of the model; some were not found.
    let pairs = row.measured_hz.iter().zip(&frequencies).filter_map(|(theirs, ours)| Some(((*theirs)?, *ours)));
    let (theirs, ours): (Vec<f64>, Vec<f64>) = pairs.unzip();
    let measured = differences(&row.measured_hz, &frequencies);
    let refitted = differences(&row.refitted_hz, &frequencies);
    rows.push(case.of("measured", "measured frequencies [Hz], relative to the model").level(Level::Measured).row(
        (&theirs, &ours),
        (worst(measured.iter().map(|d| d.abs())), super::DifferenceKind::Relative),
        WINDOW,
        Bound::Model("window of the peaks"),
    ));

    // Fixed points instead of the pulleys hold another pose nearby.
    for cable in &mut robot.cables {
        cable.anchor.pulley = None;
    }
    let nearby = statics::solve(&robot, StaticModel::Ideal, None)?.equilibrium;
    let without = modes::with_rigid_cables(&robot, &nearby, BELOW_HZ)?.modes;
    let by_pulleys = without.iter().zip(&frequencies).map(|(fixed, model)| fixed.frequency_hz / model - 1.0).collect();
    Ok(AtPose { rows, measured, refitted, by_pulleys })
}

/// Mean and root mean square of the relative differences of all measured frequencies from those of a model [%].
fn mean_and_rms(differences: &[f64]) -> [f64; 2] {
    let mean = |values: &mut dyn Iterator<Item = f64>| values.sum::<f64>() / differences.len() as f64;
    [mean(&mut differences.iter().copied()), mean(&mut differences.iter().map(|d| d * d)).sqrt()].map(|x| 100.0 * x)
}

/// Relative differences of the measured frequencies from those of a model; some frequencies were not measured.
fn differences(measured_hz: &[Option<f64>], model_hz: &[f64]) -> Vec<f64> {
    measured_hz.iter().zip(model_hz).filter_map(|(measured, model)| Some((*measured)? / model - 1.0)).collect()
}

/// Three poses, one for each number of cables.
fn some_poses() -> Result<ReferenceTable<MeasuredPose>> {
    let mut table = reference::measured()?.grab;
    table.rows.dedup_by_key(|row| row.cables);
    Ok(table)
}

/// File of the robot by its number of cables.
fn text(cables: usize) -> Result<&'static str> {
    Ok(match cables {
        4 => funicular_robots::GRAB_4_CABLES,
        3 => funicular_robots::GRAB_3_CABLES,
        2 => funicular_robots::GRAB_2_CABLES,
        other => return Err(anyhow!("no robot of the table has {other} cables")),
    })
}

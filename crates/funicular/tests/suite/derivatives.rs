//! Derivatives of equilibria and natural frequencies, against central differences with Richardson's extrapolation.

use crate::library::library;
use funicular::cable::CableModel;
use funicular::dynamics::{Dynamics, Linearisation};
use funicular::math::{Mat3, Vec3};
use funicular::modes::{self, Mode, derivatives as frequencies};
use funicular::robot::parameters::Parameters;
use funicular::robot::{Robot, RobotChange, Wind};
use funicular::statics::derivatives::{StaticDerivativeError, at_held_lengths, at_held_pose};
use funicular::statics::{self, Equilibrium, StaticModel};

/// Changes of every kind, with a name and a step: a thousandth of the value, or a tenth of a millimetre.
fn changes(robot: &Robot) -> Vec<(&'static str, RobotChange, f64)> {
    let none = || RobotChange::none(robot.cables.len());
    let (platform, cable) = (&robot.platform, &robot.cables[0]);
    let weight = platform.mass * 9.81;
    let mut all = vec![
        ("mass", RobotChange::of_mass(robot), 1e-3 * platform.mass),
        ("gravity", RobotChange { gravity_w: Vec3::new(0.3, 0.0, 1.0), ..none() }, 1e-3),
        ("force", RobotChange { force_w: Vec3::new(1.0, 0.2, 0.5), ..none() }, 1e-3 * weight),
    ];
    if platform.inertia_p != Mat3::zeros() {
        let tensor = Mat3::new(1.0, 0.2, 0.0, 0.2, 1.0, 0.1, 0.0, 0.1, 1.0);
        all.push(("centre", RobotChange { center_of_mass_p: Vec3::new(1.0, 0.3, -0.5), ..none() }, 1e-4));
        all.push(("inertia", RobotChange { inertia_p: tensor, ..none() }, 1e-3 * platform.inertia_p.amax()));
        all.push(("moment", RobotChange { moment_w: Vec3::new(0.5, 1.0, 0.2), ..none() }, 1e-4 * weight));
        all.push(("point", RobotChange { point_p: Vec3::new(0.1, 0.4, 1.0), ..none() }, 1e-4));
    }
    let mut of_cable = |name, set: &dyn Fn(&mut funicular::robot::CableChange), step| {
        let mut change = none();
        set(&mut change.cables[0]);
        all.push((name, change, step));
    };
    of_cable("anchor", &|c| c.anchor_w = Vec3::new(0.3, -0.5, 1.0), 1e-4);
    if platform.inertia_p != Mat3::zeros() {
        of_cable("attachment", &|c| c.attachment_p = Vec3::new(1.0, 0.5, 0.2), 1e-4);
    }
    of_cable("length", &|c| c.unstrained_length = 1.0, 1e-4);
    of_cable("stiffness", &|c| c.axial_stiffness = 1.0, 1e-3 * cable.material.axial_stiffness);
    of_cable("load", &|c| c.load_per_length_w = Vec3::new(1.0, 0.5, -1.0), 1e-3);
    if cable.material.mass_per_length > 0.0 {
        of_cable("rope", &|c| c.mass_per_length = 1.0, 1e-3 * cable.material.mass_per_length);
    }
    all
}

fn lengths_of(rest: &Equilibrium) -> Vec<f64> {
    rest.cables.iter().map(|cable| cable.unstrained_length).collect()
}

/// The robot with a load that has all its parts, and in wind.
fn loaded() -> Robot {
    let text = funicular_robots::YUAN2014_4MM
        .replace("damping_ratio = 0.003", "damping_ratio = 0.003\ndrag_coefficient = 1.2");
    let mut robot = Robot::from_toml(&text).unwrap();
    robot.load.force_w = Vec3::new(5.0, -3.0, -8.0);
    robot.load.moment_w = Vec3::new(0.3, 0.2, -0.1);
    robot.load.point_p = Vec3::new(0.05, -0.1, 0.08);
    robot.with_wind(Wind { velocity_w: Vec3::new(12.0, 5.0, 1.0), ..Wind::default() })
}

/// The library's robots whose cables end at fixed points and one in wind and under a load, each at rest.
fn robots() -> Vec<(String, Robot, Equilibrium)> {
    let mut all = library();
    all.retain(|(_, robot, _)| robot.cables.iter().all(|cable| cable.anchor.is_fixed()));
    let robot = loaded();
    let lengths = [6.863, 6.565, 6.756, 6.663, 6.801, 6.604];
    let rest = statics::forward(&robot, &lengths, StaticModel::Catenary, None).unwrap();
    all.push(("in wind".to_owned(), robot, rest));
    all
}

/// Central difference at a step and at half of it, extrapolated, and how much the extrapolation adds.
fn extrapolated(step: f64, mut at: impl FnMut(f64) -> Option<Vec<f64>>) -> Option<(Vec<f64>, f64)> {
    let mut central = |h: f64| -> Option<Vec<f64>> {
        let (low, high) = (at(-h)?, at(h)?);
        Some(low.iter().zip(&high).map(|(low, high)| (high - low) / (2.0 * h)).collect())
    };
    let (coarse, fine) = (central(step)?, central(0.5 * step)?);
    let best: Vec<f64> = coarse.iter().zip(&fine).map(|(coarse, fine)| (4.0 * fine - coarse) / 3.0).collect();
    let added = best.iter().zip(&fine).map(|(best, fine)| (best - fine).powi(2)).sum::<f64>().sqrt();
    Some((best, added))
}

fn distance(a: &[f64], b: &[f64]) -> (f64, f64) {
    let norm = |v: &mut dyn Iterator<Item = f64>| v.map(|x| x * x).sum::<f64>().sqrt();
    (norm(&mut a.iter().zip(b).map(|(a, b)| a - b)), norm(&mut b.iter().copied()))
}

/// Pose and forces with lengths held. The equilibrium is found to 1e-10 of the forces at least, over steps that change
/// them by 1e-4 to 1e-2: differences have five digits or more, of which half the extrapolation's own part is spared.
#[test]
fn pose_and_forces_follow_every_number_of_the_robot_at_held_lengths() {
    let mut compared = 0;
    for (name, robot, rest) in robots() {
        let lengths = lengths_of(&rest);
        for (what, change, step) in changes(&robot) {
            let Ok(found) = at_held_lengths(&robot, &rest, &change) else { continue };
            let differences = extrapolated(step, |h| {
                let changed = robot.changed(&change, h);
                let lengths: Vec<f64> =
                    lengths.iter().zip(&change.cables).map(|(l, c)| l + h * c.unstrained_length).collect();
                let at = statics::forward(&changed, &lengths, StaticModel::Catenary, Some(&rest.pose)).ok()?;
                let turn = (at.pose.rot_wp * rest.pose.rot_wp.inverse()).scaled_axis();
                let moved = at.pose.position_w - rest.pose.position_w;
                let mut values: Vec<f64> = moved.iter().chain(turn.iter()).copied().collect();
                let scale = 1.0 / robot.cables[0].material.axial_stiffness.max(1.0);
                for cable in &at.cables {
                    values.extend([cable.tension_platform * scale, cable.tension_anchor * scale]);
                    values.extend(cable.force_on_platform_w.iter().map(|force| force * scale));
                }
                Some(values)
            });
            let Some((differences, added)) = differences else { continue };
            let mut values: Vec<f64> = found.translation_w.iter().chain(found.rotation_w.iter()).copied().collect();
            let scale = 1.0 / robot.cables[0].material.axial_stiffness.max(1.0);
            for cable in &found.cables {
                values.extend([cable.tension_platform * scale, cable.tension_anchor * scale]);
                values.extend(cable.force_on_platform_w.iter().map(|force| force * scale));
            }
            let (error, size) = distance(&values, &differences);
            assert!(error <= 1e-5 * size + added, "{name}, {what}: {error:e} of {size:e}, extrapolation {added:e}");
            compared += 1;
        }
    }
    assert!(compared > 60, "{compared}");
}

/// Lengths with the pose held, where they are as many as the degrees of freedom: inverse statics changes them so.
#[test]
fn lengths_follow_every_number_of_the_robot_at_a_held_pose() {
    let mut compared = 0;
    for (name, robot, rest) in robots() {
        let square = robot.cables.len() == robot.platform.motion.count();
        for (what, change, step) in changes(&robot) {
            let found = at_held_pose(&robot, &rest, &change);
            if !square {
                assert!(matches!(found, Err(StaticDerivativeError::CableCount { .. })), "{name}");
                continue;
            }
            // With the pose held, the change of a length is taken back.
            let Ok(found) = found else { continue };
            let differences = extrapolated(step, |h| {
                let at = statics::inverse(&robot.changed(&change, h), &rest.pose, StaticModel::Catenary).ok()?;
                Some(lengths_of(&at))
            });
            let Some((differences, added)) = differences else { continue };
            let values: Vec<f64> = found.cables.iter().map(|cable| cable.unstrained_length).collect();
            let (error, size) = distance(&values, &differences);
            // Lengths are found to 1e-12 m or so, over changes of 1e-6 m and more.
            assert!(error <= 1e-5 * size + added + 1e-12 / step, "{name}, {what}: {error:e} of {size:e}");
            compared += 1;
        }
    }
    assert!(compared > 10, "{compared}");
}

fn list(robot: &Robot, rest: &Equilibrium, cable_model: CableModel, below_hz: f64) -> Option<(Dynamics, Vec<Mode>)> {
    let dynamics =
        Dynamics::about(robot, rest, Linearisation { cable_model, ..Linearisation::default() }, below_hz).ok()?;
    let found = modes::below(&dynamics, below_hz);
    found.certified.then_some((dynamics, found.modes))
}

/// Frequencies, of both models that have derivatives, with lengths held. Frequencies have twelve digits and steps change
/// them by 1e-6 to 1e-3, so that differences have six digits of the larger changes; a change that is small beside the
/// frequency times the relative step loses the rest, hence the second term.
#[test]
fn natural_frequencies_follow_every_number_of_the_robot() {
    let mut compared = [0; 2];
    for (r, (name, robot, rest)) in robots().into_iter().enumerate() {
        for (m, cable_model) in [CableModel::CatenaryDynamic, CableModel::CatenaryStatic].into_iter().enumerate() {
            let below_hz = if m == 0 { 6.0 } else { 12.0 };
            let Some((dynamics, modes)) = list(&robot, &rest, cable_model, below_hz) else { continue };
            // Alone, so that the order of the list is that of the modes while the robot changes.
            let alone = |k: usize| {
                let gap = |other: Option<&Mode>| {
                    other.is_none_or(|other| (other.frequency_hz / modes[k].frequency_hz - 1.0).abs() > 0.02)
                };
                gap(modes.get(k + 1)) && gap(k.checked_sub(1).and_then(|k| modes.get(k)))
            };
            let chosen: Vec<usize> = (0..modes.len().saturating_sub(1)).filter(|k| alone(*k)).take(3).collect();
            // Every other change of every other robot: all kinds occur in both, in half the time.
            for (what, change, step) in changes(&robot).into_iter().skip(r % 2).step_by(2) {
                let Ok(by) = at_held_lengths(&robot, &rest, &change) else { continue };
                let differences = extrapolated(step, |h| {
                    let changed = robot.changed(&change, h);
                    let lengths: Vec<f64> = (lengths_of(&rest).iter().zip(&change.cables))
                        .map(|(length, of_cable)| length + h * of_cable.unstrained_length)
                        .collect();
                    let at = statics::forward(&changed, &lengths, StaticModel::Catenary, Some(&rest.pose)).ok()?;
                    let (_, found) = list(&changed, &at, cable_model, below_hz)?;
                    (found.len() > *chosen.last()?).then(|| chosen.iter().map(|k| found[*k].frequency_hz).collect())
                });
                let Some((differences, added)) = differences else { continue };
                for (k, difference) in chosen.iter().zip(&differences) {
                    let mode = &modes[*k];
                    let found = frequencies::frequency(&robot, &rest, &dynamics, mode, &change, &by).unwrap();
                    let error = (found - difference).abs();
                    let allowed = 1e-5 * difference.abs() + added + 2e-11 * mode.frequency_hz / step;
                    assert!(
                        error <= allowed,
                        "{name}, {cable_model}, mode {k} at {} Hz, {what}: {found} and {difference}, extrapolation {added:e}",
                        mode.frequency_hz
                    );
                    compared[m] += 1;
                }
            }
        }
    }
    assert!(compared.iter().all(|count| *count > 100), "{compared:?}");
}

/// The parameters of a file change the robot as the file's numbers do.
#[test]
fn a_parameter_changes_the_robot_as_its_number_in_the_file_does() {
    let mut compared = 0;
    for (_, text) in funicular_robots::ALL {
        let parameters = Parameters::from_toml(text).unwrap();
        for (i, parameter) in parameters.list().iter().enumerate().filter(|(_, parameter)| parameter.given) {
            let Some(change) = parameters.change(i) else { continue };
            let step = if parameter.value == 0.0 { 1e-6 } else { 1e-6 * parameter.value.abs() };
            let Ok(changed) = parameters.robot_with(&[(i, parameter.value + step)]) else { continue };
            let moved = parameters.robot().changed(&change, step);
            for (by_file, by_change) in numbers_of(&changed).iter().zip(numbers_of(&moved)) {
                // The square of the relative step, which the area of a rope has, and rounding of sums.
                let allowed = 2e-12 * (by_file.abs() + step);
                assert!((by_file - by_change).abs() <= allowed, "{}: {by_file} {by_change}", parameter.path());
            }
            assert!(numbers_of(&changed) != numbers_of(parameters.robot()), "{}", parameter.path());
            compared += 1;
        }
    }
    assert!(compared > 300, "{compared}");
}

/// The numbers of a robot that a change can reach.
fn numbers_of(robot: &Robot) -> Vec<f64> {
    let mut numbers = vec![robot.platform.mass, robot.platform.drag_area];
    let mut three = |v: &Vec3| numbers.extend(v.iter());
    [
        &robot.gravity_w,
        &robot.platform.center_of_mass_p,
        &robot.load.force_w,
        &robot.load.moment_w,
        &robot.load.point_p,
    ]
    .into_iter()
    .for_each(&mut three);
    for cable in &robot.cables {
        [&cable.anchor.reference_w(), &cable.attachment_p, &cable.load_per_length_w].into_iter().for_each(&mut three);
    }
    numbers.extend(robot.platform.inertia_p.iter());
    numbers.extend(robot.cables.iter().flat_map(|c| [c.material.axial_stiffness, c.material.mass_per_length]));
    if let funicular::robot::State::Lengths(lengths) = &robot.state {
        numbers.extend(lengths);
    }
    numbers
}

#[test]
fn what_has_no_derivative_is_refused() {
    let (robot, rest) = {
        let robot = loaded();
        let rest =
            statics::forward(&robot, &[6.863, 6.565, 6.756, 6.663, 6.801, 6.604], StaticModel::Catenary, None).unwrap();
        (robot, rest)
    };
    let change = RobotChange::of_mass(&robot);
    let by = at_held_lengths(&robot, &rest, &change).unwrap();
    let (dynamics, modes) = list(&robot, &rest, CableModel::ShallowDynamic, 5.0).unwrap();
    let error = frequencies::frequency(&robot, &rest, &dynamics, &modes[0], &change, &by).unwrap_err().to_string();
    assert!(error.contains("need the cable model"), "{error}");

    let (dynamics, mut modes) = list(&robot, &rest, CableModel::CatenaryDynamic, 5.0).unwrap();
    modes[0].multiplicity = 2;
    let error = frequencies::frequency(&robot, &rest, &dynamics, &modes[0], &change, &by).unwrap_err().to_string();
    assert!(error.contains("2 modes share the frequency"), "{error}");

    let ideal = statics::inverse(&robot, &rest.pose, StaticModel::Ideal).unwrap();
    assert_eq!(at_held_lengths(&robot, &ideal, &change), Err(StaticDerivativeError::Ideal));
    assert_eq!(at_held_pose(&robot, &ideal, &change), Err(StaticDerivativeError::Ideal));
}

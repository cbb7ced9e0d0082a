//! Derivatives of equilibria and natural frequencies, against central differences with Richardson's extrapolation.

mod drives;
mod equal_drives;
mod kept_shapes;
mod load_factor;
mod rule_with_drives;
mod supports;
mod tension_rule;

use crate::library::library;
use funicular::cable::CableModel;
use funicular::dynamics::{Dynamics, Linearisation};
use funicular::gradient::{GradientError, Gradients, Hold};
use funicular::math::{DMat, Mat3, Vec3};
use funicular::modes::{self, Mode};
use funicular::response::{self, Quantity, Signal};
use funicular::robot::parameters::Parameters;
use funicular::robot::{Cable, Control, Damping, Robot, RobotChange, State, StretchLoss, Wind};
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
    if let Some(pulley) = &cable.anchor.pulley {
        let turned = pulley.entry_direction_w.cross(&Vec3::new(0.6, 0.5, -0.3));
        of_cable("radius", &|c| c.pulley.radius = 1.0, 1e-2 * pulley.radius);
        of_cable("direction", &|c| c.pulley.entry_direction_w = turned, 1e-2);
    }
    if let Some(winch) = &cable.anchor.winch {
        of_cable("drum side", &|c| c.winch.drum_side_length = 1.0, 1e-3);
        if winch.stiffness.is_finite() {
            of_cable("winch", &|c| c.winch.stiffness = 1.0, 1e-3 * winch.stiffness);
        }
        if let Control::Position(servo) = winch.control {
            of_cable("gain", &|c| c.winch.position_gain = 1.0, 1e-3 * servo.position_gain);
        }
    }
    if robot.wind.velocity_w != Vec3::zeros() {
        all.push(("wind", RobotChange { wind_velocity_w: Vec3::new(1.0, -0.3, 0.5), ..none() }, 1e-3));
        all.push(("density", RobotChange { air_density: 1.0, ..none() }, 1e-3));
        let mut change = none();
        change.cables[1].drag_width = 1.0;
        all.push(("drag", change, 1e-5));
        all.push(("area", RobotChange { drag_area: 1.0, ..none() }, 1e-4));
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
    robot.platform.drag_area = 0.02;
    robot.with_wind(Wind { velocity_w: Vec3::new(12.0, 5.0, 1.0), ..Wind::default() })
}

/// The library's robots and one in wind and under a load, each at rest.
fn robots() -> Vec<(String, Robot, Equilibrium)> {
    let mut all = library();
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

/// Frequencies, of all models that have derivatives, with lengths held. Frequencies have twelve digits and steps change
/// them by 1e-6 to 1e-3, so that differences have six digits of the larger changes; a change that is small beside the
/// frequency times the relative step loses the rest, hence the second term.
#[test]
fn natural_frequencies_follow_every_number_of_the_robot() {
    let mut compared = [0; 3];
    for (r, (name, robot, rest)) in robots().into_iter().enumerate() {
        let models = [CableModel::CatenaryDynamic, CableModel::CatenaryStatic, CableModel::Spring];
        for (m, cable_model) in models.into_iter().enumerate() {
            let below_hz = if m == 0 { 6.0 } else { 12.0 };
            let Some((dynamics, modes)) = list(&robot, &rest, cable_model, below_hz) else { continue };
            let Ok(gradients) = Gradients::new(&robot, &rest, Hold::Lengths) else { continue };
            let vibration = gradients.vibration(&dynamics).unwrap();
            // Alone, so that the order of the list is that of the modes while the robot changes.
            let alone = |k: usize| {
                let gap = |other: Option<&Mode>| {
                    other.is_none_or(|other| (other.frequency_hz / modes[k].frequency_hz - 1.0).abs() > 0.02)
                };
                gap(modes.get(k + 1)) && gap(k.checked_sub(1).and_then(|k| modes.get(k)))
            };
            let chosen: Vec<usize> = (0..modes.len().saturating_sub(1)).filter(|k| alone(*k)).take(3).collect();
            let found: Vec<RobotChange> = chosen.iter().map(|k| vibration.frequency(&modes[*k]).unwrap()).collect();
            // Every other change of every other robot: all kinds occur in both, in half the time.
            for (what, change, step) in changes(&robot).into_iter().skip(r % 2).step_by(2) {
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
                for ((k, difference), gradient) in chosen.iter().zip(&differences).zip(&found) {
                    let mode = &modes[*k];
                    let found = gradient.dot(&change);
                    let error = (found - difference).abs();
                    let allowed = 1e-5 * difference.abs() + added + 2e-11 * mode.frequency_hz / step;
                    assert!(
                        error <= allowed,
                        "{name}, {cable_model}, mode {k} at {} Hz, {what}: {found} and {difference}, extrapolation \
                         {added:e}",
                        mode.frequency_hz
                    );
                    compared[m] += 1;
                }
            }
        }
    }
    assert!(compared.iter().all(|count| *count > 100), "{compared:?}");
}

/// The reverse pass has the derivatives of the forward one, by every number, whichever is held. Both take the same
/// partial derivatives and cancel the same stiff terms: 1e-9 of the largest derivative of the kind is rounding of
/// those.
#[test]
fn gradients_are_the_transposes_of_derivatives_along_directions() {
    let mut compared = 0;
    for (name, robot, rest) in robots() {
        for hold in Hold::ALL {
            let Ok(gradients) = Gradients::new(&robot, &rest, hold) else { continue };
            let kinds = [
                gradients.pose().to_vec(),
                gradients.tensions_platform(),
                gradients.tensions_anchor(),
                gradients.lengths(),
            ];
            let mut all = changes(&robot);
            if hold == Hold::Pose {
                all.push((
                    "position",
                    RobotChange { position_w: Vec3::new(0.2, 1.0, -0.4), ..RobotChange::none(robot.cables.len()) },
                    0.0,
                ));
                if robot.platform.motion.count() == 6 {
                    let turned =
                        RobotChange { rotation_w: Vec3::new(0.2, 1.0, -0.4), ..RobotChange::none(robot.cables.len()) };
                    all.push(("turn", turned, 0.0));
                }
            }
            for (what, change, _) in all {
                let along = match hold {
                    Hold::Lengths => at_held_lengths(&robot, &rest, &change),
                    Hold::Pose | Hold::Rule => at_held_pose(&robot, &rest, &change),
                };
                // Forward, more cables than degrees of freedom have no rule.
                let Ok(along) = along else { continue };
                let tensions =
                    |of: fn(&statics::derivatives::CableDerivative) -> f64| along.cables.iter().map(of).collect();
                let forward: [Vec<f64>; 4] = [
                    along.translation_w.iter().chain(along.rotation_w.iter()).copied().collect(),
                    tensions(|cable| cable.tension_platform),
                    tensions(|cable| cable.tension_anchor),
                    tensions(|cable| cable.unstrained_length),
                ];
                for (forward, reverse) in forward.iter().zip(&kinds) {
                    let reverse: Vec<f64> = reverse.iter().map(|gradient| gradient.dot(&change)).collect();
                    let (error, size) = distance(&reverse, forward);
                    assert!(error <= 1e-9 * size, "{name}, {hold:?} held, {what}: {reverse:?} {forward:?}");
                    compared += 1;
                }
            }
        }
    }
    assert!(compared > 400, "{compared}");
}

/// Point mass on four equal cables, whose modes share frequencies: horizontal motions, and vibrations of the cables
/// with the platform at rest.
fn symmetric_robot() -> Robot {
    let cables: Vec<String> = [("1", "2.0, 0.0"), ("2", "-2.0, 0.0"), ("3", "0.0, 2.0"), ("4", "0.0, -2.0")]
        .iter()
        .map(|(name, point)| {
            format!(
                "[[cables]]\nname = \"{name}\"\nmaterial = \"rope\"\nanchor_m = [{point}, \
                3.0]\nunstrained_length_m = 2.8\n"
            )
        })
        .collect();
    let cables = cables.concat();
    let text = format!(
        "name = \"square\"\n[platform]\nmotion = \"point-mass\"\nmass_kg = 10.0\n[materials.rope]\naxial_stiffness_n = \
         1e5\n\
         mass_kg_per_m = 0.3\n{cables}"
    );
    Robot::from_toml(&text).unwrap()
}

/// Along a change, the eigenvalues of the block of modes that share a frequency are their one-sided derivatives: also
/// where the platform is at rest and only cables vibrate, at their poles.
#[test]
fn modes_that_share_a_frequency_part_along_a_change_by_the_eigenvalues_of_their_block() {
    let robot = symmetric_robot();
    let State::Lengths(lengths) = robot.state.clone() else { panic!("its file gives lengths") };
    let rest = statics::forward(&robot, &lengths, StaticModel::Catenary, None).unwrap();
    let below_hz = 25.0;
    let (dynamics, modes) = list(&robot, &rest, CableModel::CatenaryDynamic, below_hz).unwrap();
    let gradients = Gradients::new(&robot, &rest, Hold::Lengths).unwrap();
    let vibration = gradients.vibration(&dynamics).unwrap();

    let mut change = RobotChange::none(4);
    change.cables[0].anchor_w = Vec3::new(0.2, 1.0, 0.3);
    change.cables[2].mass_per_length = 0.05;
    change.mass = 0.5;
    let step = 1e-6;
    let parted = |step: f64| {
        let changed = robot.changed(&change, step);
        let at = statics::forward(&changed, &lengths, StaticModel::Catenary, Some(&rest.pose)).unwrap();
        list(&changed, &at, CableModel::CatenaryDynamic, below_hz).unwrap().1
    };
    let (whole, half) = (parted(step), parted(0.5 * step));

    let (mut next, mut blocks, mut at_rest) = (0, 0, 0);
    while next < modes.len() {
        let count = modes[next].multiplicity;
        let shared: Vec<&Mode> = modes[next..next + count].iter().collect();
        // Frequencies that only lie near would mix with these.
        let gap = |k: Option<usize>| {
            k.and_then(|k| modes.get(k))
                .is_none_or(|other| (other.frequency_hz / shared[0].frequency_hz - 1.0).abs() > 1e-3)
        };
        if count > 1 && gap(next.checked_sub(1)) && gap(Some(next + count)) && next + count < whole.len() {
            let block = vibration.block(&shared);
            let matrix = DMat::from_fn(count, count, |i, j| block[i][j].dot(&change));
            assert!((&matrix - matrix.transpose()).amax() < 1e-9 * matrix.amax());
            let mut ours: Vec<f64> = matrix.clone().symmetric_eigen().eigenvalues.iter().copied().collect();
            ours.sort_by(f64::total_cmp);
            for (ours, (whole, half)) in ours.iter().zip(whole[next..].iter().zip(&half[next..])) {
                // One-sided, with the curvature extrapolated, which neighbours make large.
                let slope = |mode: &Mode, step: f64| (mode.frequency_hz - shared[0].frequency_hz) / step;
                let difference = 2.0 * slope(half, 0.5 * step) - slope(whole, step);
                // Frequencies have 1e-12, at a pole its width, over the step; the third order is below.
                let allowed = 1e-4 * matrix.amax();
                assert!(
                    (ours - difference).abs() < allowed,
                    "mode {next} at {} Hz: {ours} {difference}",
                    whole.frequency_hz
                );
            }
            blocks += 1;
            at_rest += usize::from(shared[0].shape.iter().all(|entry| entry.abs() <= 0.0));
        }
        next += count;
    }
    assert!(blocks > 3 && at_rest > 0, "{blocks} {at_rest}");
}

/// Least stiffness, and entries of the tangent, which a load and all changes of the geometry bend.
#[test]
fn stiffness_follows_every_number_of_the_robot() {
    let mut robot = loaded().with_wind(Wind::default());
    robot.platform.drag_area = 0.0;
    let rest = statics::forward(&robot, &LENGTHS, StaticModel::Catenary, None).unwrap();
    let gradients = Gradients::new(&robot, &rest, Hold::Lengths).unwrap();
    let values = |robot: &Robot, rest: &Equilibrium| {
        let tangent = statics::tangent_stiffness(robot, rest).unwrap();
        let least = rest.stability.min_stiffness().unwrap();
        vec![least, tangent[(0, 0)], tangent[(1, 4)] + tangent[(4, 1)], tangent[(5, 5)]]
    };
    let entry = |i, j| gradients.tangent_entry(i, j).unwrap();
    let found = [gradients.min_stiffness().unwrap(), entry(0, 0), entry(1, 4), entry(5, 5)];
    let factors = [1.0, 1.0, 2.0, 1.0];
    for (what, change, step) in changes(&robot) {
        let Some((differences, _)) = extrapolated(step, |h| {
            let (changed, at) = changed_rest(&robot, &rest, &change, h)?;
            Some(values(&changed, &at))
        }) else {
            continue;
        };
        for (k, ((gradient, factor), difference)) in found.iter().zip(factors).zip(&differences).enumerate() {
            let ours = factor * gradient.dot(&change);
            // Rounding of entries of 1e5 N/m over the step, and the third order.
            let allowed = 1e-5 * difference.abs() + 1e-8 * values(&robot, &rest)[k].abs() / step;
            assert!((ours - difference).abs() <= allowed, "{what}, {k}: {ours} {difference}, {allowed:e}");
        }
    }
}

/// Changes of the damping, and some of the other kinds.
fn changes_with_damping(robot: &Robot) -> Vec<(&'static str, RobotChange, f64)> {
    let none = || RobotChange::none(robot.cables.len());
    let mut all = changes(robot);
    let mut of_rope = none();
    of_rope.cables.iter_mut().for_each(|cable| cable.damping = 1.0);
    all.push(("damping of the ropes", of_rope, 1e-4));
    for (name, [factor, time], step) in [("loss factor", [1.0, 0.0], 1e-3), ("damping time", [0.0, 1.0], 1e-4)] {
        let mut of_stretch = none();
        of_stretch.cables.iter_mut().for_each(|cable| (cable.loss_factor, cable.damping_time) = (factor, time));
        all.push((name, of_stretch, step));
    }
    let of_platform = RobotChange {
        translational_damping_p: Vec3::new(1.0, 0.5, 0.2),
        rotational_damping_p: Vec3::new(0.01, 0.02, 0.03),
        ..none()
    };
    all.push(("damping of the platform", of_platform, 1e-2));
    all
}

/// A robot in wind and under a load whose platform is damped and whose ropes have a damping ratio, one with viscous
/// ropes, and one whose ropes have a loss of their stretch, too.
fn damped_robots() -> [(&'static str, Robot, f64); 3] {
    let mut with_ratio = loaded();
    with_ratio.platform.translational_damping_p = Vec3::new(3.0, 1.0, 2.0);
    with_ratio.platform.rotational_damping_p = Vec3::new(0.02, 0.05, 0.01);
    with_ratio.cables.iter_mut().for_each(|cable| cable.material.damping = Damping::Ratio(0.01));
    let mut viscous = with_ratio.clone();
    viscous.cables.iter_mut().for_each(|cable| cable.material.damping = Damping::Viscous(0.02));
    let mut lossy = with_ratio.clone();
    lossy.cables.iter_mut().for_each(|cable| cable.material.stretch_loss = StretchLoss { factor: 0.05, time: 2e-3 });
    [("damping ratio", with_ratio, 3.0), ("viscous", viscous, 3.0), ("loss of stretch", lossy, 3.0)]
}

const LENGTHS: [f64; 6] = [6.863, 6.565, 6.756, 6.663, 6.801, 6.604];

/// Equilibrium of a robot changed by a step along a direction, lengths held.
fn changed_rest(robot: &Robot, rest: &Equilibrium, change: &RobotChange, h: f64) -> Option<(Robot, Equilibrium)> {
    let changed = robot.changed(change, h);
    let lengths: Vec<f64> = LENGTHS.iter().zip(&change.cables).map(|(l, c)| l + h * c.unstrained_length).collect();
    let at = statics::forward(&changed, &lengths, StaticModel::Catenary, Some(&rest.pose)).ok()?;
    Some((changed, at))
}

/// Damped frequencies and damping ratios. Their zeros have eleven digits, over steps that change them by 1e-6 to 1e-3.
#[test]
fn damped_frequencies_and_damping_ratios_follow_every_number_of_the_robot() {
    let mut compared = 0;
    for (name, robot, below_hz) in damped_robots() {
        let rest = statics::forward(&robot, &LENGTHS, StaticModel::Catenary, None).unwrap();
        let damped = |robot: &Robot, rest: &Equilibrium| -> Option<(Dynamics, Vec<modes::damped::DampedMode>)> {
            let dynamics = Dynamics::about(robot, rest, Linearisation::default(), below_hz).ok()?;
            let undamped = modes::below(&dynamics, below_hz);
            let found = modes::damped::damped_modes(&dynamics, &undamped);
            found.certified.then_some((dynamics, found.modes))
        };
        let (dynamics, found) = damped(&robot, &rest).unwrap();
        let gradients = Gradients::new(&robot, &rest, Hold::Lengths).unwrap();
        let vibration = gradients.vibration(&dynamics).unwrap();
        let values = |mode: &modes::damped::DampedMode| [mode.frequency_hz(), mode.ringing_hz(), mode.damping_ratio()];
        for (what, change, step) in changes_with_damping(&robot).into_iter().skip(name.len() % 2).step_by(3) {
            let differences = extrapolated(step, |h| {
                let (changed, at) = changed_rest(&robot, &rest, &change, h)?;
                let (_, list) = damped(&changed, &at)?;
                (list.len() == found.len()).then(|| list.iter().flat_map(values).collect())
            });
            let Some((differences, added)) = differences else { continue };
            for (k, mode) in found.iter().enumerate().take(8) {
                let of_mode = vibration.damped(mode).unwrap();
                let ours = [&of_mode.frequency_hz, &of_mode.ringing_hz, &of_mode.damping_ratio];
                for (i, gradient) in ours.iter().enumerate() {
                    let (ours, difference) = (gradient.dot(&change), differences[3 * k + i]);
                    let allowed = 1e-5 * difference.abs() + added + 1e-10 * values(mode)[i] / step;
                    let error = (ours - difference).abs();
                    assert!(error <= allowed, "{name}, mode {k}, value {i}, {what}: {ours} {difference}, {added:e}");
                    compared += 1;
                }
            }
        }
    }
    assert!(compared > 100, "{compared}");
}

/// Responses between points of the platform, all kinds of signals and quantities, beside and at the peaks.
#[test]
fn responses_follow_every_number_of_the_robot() {
    let mut compared = 0;
    let inputs = [
        Signal::Along { direction_w: Vec3::new(0.2, 0.1, 1.0), point_p: Vec3::new(0.1, 0.05, 0.02) },
        Signal::About { axis_w: Vec3::new(0.0, 1.0, 0.2) },
    ];
    let outputs = [
        (
            Signal::Along { direction_w: Vec3::new(1.0, -0.2, 0.3), point_p: Vec3::new(-0.1, 0.0, 0.1) },
            Quantity::Acceleration,
        ),
        (Signal::About { axis_w: Vec3::new(1.0, 0.0, 0.3) }, Quantity::Velocity),
        (inputs[0], Quantity::Displacement),
    ];
    for (name, robot, _) in damped_robots() {
        let rest = statics::forward(&robot, &LENGTHS, StaticModel::Catenary, None).unwrap();
        let frequencies_hz = [0.6, 1.3, 2.71];
        let responses = |robot: &Robot, rest: &Equilibrium| -> Option<Vec<f64>> {
            let dynamics = Dynamics::about(robot, rest, Linearisation::default(), 3.0).ok()?;
            let port = |signal: &Signal| response::Port::Platform(signal.platform_vector(&rest.pose).unwrap());
            let inputs: Vec<_> = inputs.iter().map(port).collect();
            let outputs: Vec<_> = outputs.iter().map(|(signal, quantity)| (port(signal), *quantity)).collect();
            let rows = response::matrix(&dynamics, &frequencies_hz, &inputs, &outputs).ok()?;
            Some(rows.iter().flatten().flat_map(|z| [z.re, z.im]).collect())
        };
        let all = changes_with_damping(&robot);
        let directions: Vec<RobotChange> = all.iter().map(|(_, change, _)| change.clone()).collect();
        let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), 3.0).unwrap();
        let gradients = Gradients::new(&robot, &rest, Hold::Lengths).unwrap();
        let vibration = gradients.vibration(&dynamics).unwrap();
        let found = vibration.responses(&inputs, &outputs, &frequencies_hz, &directions).unwrap();
        let ours: Vec<f64> = found.iter().flatten().flat_map(|at| [at.value.re, at.value.im]).collect();
        let values = responses(&robot, &rest).unwrap();
        let (error, size) = distance(&ours, &values);
        assert!(error <= 1e-10 * size, "{name}: {error:e} of {size:e}");

        for (d, (what, change, step)) in all.iter().enumerate() {
            let differences = extrapolated(*step, |h| {
                let (changed, at) = changed_rest(&robot, &rest, change, h)?;
                responses(&changed, &at)
            });
            let Some((differences, _)) = differences else { continue };
            let pairs = found.iter().flatten().zip(differences.chunks(2)).zip(values.chunks(2));
            for (k, ((at, difference), value)) in pairs.enumerate() {
                let ours = [at.along[d].re, at.along[d].im];
                let size = value[0].hypot(value[1]);
                let (error, largest) = distance(&ours, difference);
                // Third order of the step, which near a peak is the step over its width, and rounding of the values.
                let allowed = 2e-4 * largest + 1e-11 * size / step;
                assert!(error <= allowed, "{name}, {k}, {what}: {ours:?} {difference:?}");
                compared += 1;
            }
        }
    }
    assert!(compared > 400, "{compared}");
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
                // The square of the relative step, which the area of a rope has, three times that for one over the
                // square of a drum's radius, and rounding of sums.
                let allowed = 4e-12 * (by_file.abs() + step);
                assert!((by_file - by_change).abs() <= allowed, "{}: {by_file} {by_change}", parameter.path());
            }
            // A direction does not depend on the length of the vector that gives it.
            let is_change = change != RobotChange::none(parameters.robot().cables.len());
            let is_changed = numbers_of(&changed) != numbers_of(parameters.robot());
            assert!(is_changed || !is_change && parameter.key == "entry_direction", "{}", parameter.path());
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
    for cable in &robot.cables {
        if let Some(pulley) = &cable.anchor.pulley {
            numbers.extend([pulley.radius, pulley.inertia, pulley.swivel_inertia]);
            numbers.extend(pulley.entry_direction_w.iter());
        }
        if let Some(winch) = &cable.anchor.winch {
            numbers.extend([winch.drum_side_length, winch.drum_mass, winch.motor_mass, winch.damping]);
            numbers.extend(Some(winch.stiffness).filter(|stiffness| stiffness.is_finite()));
            if let Control::Position(servo) = winch.control {
                numbers.extend([servo.position_gain, servo.speed_gain, servo.delay]);
            }
        }
    }
    numbers.extend(robot.platform.inertia_p.iter());
    numbers.extend(robot.cables.iter().flat_map(|c| [c.material.axial_stiffness, c.material.mass_per_length]));
    numbers.extend([robot.wind.air_density]);
    numbers.extend(robot.wind.velocity_w.iter());
    numbers.extend(robot.platform.translational_damping_p.iter().chain(robot.platform.rotational_damping_p.iter()));
    for Cable { material, .. } in &robot.cables {
        let (Damping::Ratio(damping) | Damping::Viscous(damping)) = material.damping;
        numbers.extend([damping, material.drag_width.unwrap_or(0.0)]);
    }
    match &robot.state {
        State::Lengths(lengths) => numbers.extend(lengths),
        State::Pose(pose) => {
            numbers.extend(pose.position_w.iter());
            numbers.extend(pose.rot_wp.to_rotation_matrix().matrix().iter());
        }
        State::Unknown => {}
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
    let gradients = Gradients::new(&robot, &rest, Hold::Lengths).unwrap();
    let (dynamics, _) = list(&robot, &rest, CableModel::ShallowDynamic, 5.0).unwrap();
    let error = gradients.vibration(&dynamics).err().unwrap().to_string();
    assert!(error.contains("need the cable model"), "{error}");
    assert_eq!(gradients.min_stiffness(), Err(GradientError::DragTurns));

    let (dynamics, mut modes) = list(&robot, &rest, CableModel::CatenaryDynamic, 5.0).unwrap();
    modes[0].multiplicity = 2;
    let error = gradients.vibration(&dynamics).unwrap().frequency(&modes[0]).unwrap_err().to_string();
    assert!(error.contains("2 modes share the frequency"), "{error}");

    let hung = Robot::from_toml(funicular_robots::GRAB_3_CABLES).unwrap();
    let rest_of_hung = statics::solve(&hung, StaticModel::Catenary, None).unwrap().equilibrium;
    let error = Gradients::new(&hung, &rest_of_hung, Hold::Pose).err().unwrap().to_string();
    assert!(error.contains("3 cables cannot hold the pose of a platform with 6 degrees of freedom"), "{error}");

    let ideal = statics::inverse(&robot, &rest.pose, StaticModel::Ideal).unwrap();
    assert_eq!(at_held_lengths(&robot, &ideal, &change), Err(StaticDerivativeError::Ideal));
    assert_eq!(at_held_pose(&robot, &ideal, &change), Err(StaticDerivativeError::Ideal));
}

//! Gradients of robots on flexible supports, against differences of the program itself: random robots, with and without
//! drives, two cables on a support, drums on the ground.

use funicular::gradient::{Gradients, Hold};
use funicular::robot::parameters::{Parameters, RobotPart};
use funicular::robot::{Robot, RobotChange};
use funicular::statics::{self, Equilibrium, StaticModel};
use std::fmt::Write;

/// Numbers that look random, from a seed: a linear congruential generator.
struct Random(u64);

impl Random {
    /// Number within 1 of the centre, times a width.
    fn about(&mut self, center: f64, width: f64) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        center + width * ((self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0)
    }
}

/// What lies behind the cables of a robot.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Behind {
    Nothing,
    /// Winches without pulleys.
    Winches,
    OnSupports,
    OnGround,
}

/// Suspended robot with a random geometry: cables in pairs on three supports, or on four of which one is rigid. `count` cables, six
/// or eight.
fn random_robot(seed: u64, behind: Behind, count: usize) -> Parameters {
    let mut random = Random(seed);
    let mut r = |center: f64, width: f64| random.about(center, width);
    let mut text = format!(
        "name = \"random\"\n[platform]\nmass_kg = {}\ncenter_of_mass_m = [{}, {}, {}]\ninertia_kg_m2 = [[0.9, 0.1, 0.05], \
         [0.1, 1.1, -0.08], [0.05, -0.08, 1.4]]\ntranslational_damping_n_s_m = [2, 3, 4]\nrotational_damping_n_m_s = \
         [0.5, 0.4, 0.3]\n[materials.rope]\naxial_stiffness_n = {}\nmass_kg_per_m = {}\ndamping_ratio = 0.01\n[loads]\n\
         force_n = [12, -8, -15]\npoint_m = [0.1, 0.05, -0.1]\nmoment_n_m = [1.0, -2.0, 0.5]\n",
        r(40.0, 8.0),
        r(0.0, 0.05),
        r(0.0, 0.05),
        r(-0.1, 0.05),
        r(2.5e5, 1e5),
        r(0.12, 0.05)
    );
    let angles: Vec<f64> = (0..count / 2).map(|k| k as f64 * std::f64::consts::TAU / (count / 2) as f64).collect();
    for k in 0..count / 2 {
        let (a, b, c) = (r(8e4, 3e4), r(1e5, 4e4), r(1.5e5, 5e4));
        let drums = if behind == Behind::OnGround { "drums = \"on-ground\"\n" } else { "" };
        let _ = write!(
            text,
            "[supports.post{k}]\nstiffness_n_per_m = [[{a}, {}, {}], [{0}, {b}, {}], [{1}, {2}, {c}]]\nmass_kg = {}\n\
             damping_ratio = {}\n{drums}",
            r(0.0, 1e4),
            r(0.0, 1e4),
            r(0.0, 1e4),
            r(12.0, 6.0),
            r(0.03, 0.01)
        );
    }
    if behind != Behind::Nothing {
        let _ = write!(
            text,
            "[winches.drum]\ndrum_side_length_m = {}\nstiffness_n_per_m = {}\ndrum_radius_m = 0.1\ndrum_inertia_kg_m2 = 0.02\n",
            r(3.0, 0.5),
            r(3e5, 1e5)
        );
    }
    if !matches!(behind, Behind::Nothing | Behind::Winches) {
        let _ = write!(
            text,
            "[pulleys.wheel]\nradius_m = {}\nentry_direction = [{}, {}, 1]\ninertia_kg_m2 = 0.002\nswivel_inertia_kg_m2 = \
             0.003\n",
            r(0.08, 0.02),
            r(0.0, 0.1),
            r(0.0, 0.1)
        );
    }
    for i in 0..count {
        let (k, side) = (i / 2, if i % 2 == 0 { 1.0 } else { -1.0 });
        let (angle, height) = (angles[k], if i % 2 == 0 { 5.0 } else { 4.6 });
        let at = angle + side * 0.02;
        let inner = angle + side * if count == 6 { 1.0 } else { 0.6 };
        let mut drive = String::new();
        if behind != Behind::Nothing && i != 3 {
            drive += "winch = \"drum\"\n";
            if behind != Behind::Winches {
                drive += "pulley = \"wheel\"\n";
            }
        }
        // One cable of the last pair has a rigid anchor.
        if i + 1 != count {
            let _ = writeln!(drive, "support = \"post{k}\"");
        }
        let _ = write!(
            text,
            "[[cables]]\nname = \"{i}\"\nmaterial = \"rope\"\nanchor_m = [{}, {}, {}]\nattachment_m = [{}, {}, {}]\n{drive}",
            r(6.0 * at.cos(), 0.3),
            r(5.0 * at.sin(), 0.3),
            r(height, 0.2),
            r(0.5 * inner.cos(), 0.05),
            r(0.5 * inner.sin(), 0.05),
            r(0.2 * side, 0.05)
        );
    }
    let _ = write!(text, "[state]\nposition_m = [0.3, -0.2, 1.5]\nroll_pitch_yaw_deg = [1, -2, 3]\n");
    Parameters::from_toml(&text).unwrap_or_else(|issue| panic!("{issue}\n{text}"))
}

/// At rest from lengths that hold a pose near that of the file.
fn at_rest(robot: &Robot) -> Option<Equilibrium> {
    let held = statics::solve(robot, StaticModel::Catenary, None).ok()?.equilibrium;
    let lengths = lengths_of(&held);
    statics::forward(robot, &lengths, StaticModel::Catenary, Some(&held.pose)).ok()
}

fn lengths_of(rest: &Equilibrium) -> Vec<f64> {
    rest.cables.iter().map(|cable| cable.unstrained_length).collect()
}

/// Directions of all numbers of a file, and of the unstrained lengths, with a name and a step.
fn directions(parameters: &Parameters) -> Vec<(String, RobotChange, f64)> {
    let mut all = Vec::new();
    for (index, parameter) in parameters.list().iter().enumerate() {
        let Some(change) = parameters.change(index) else { continue };
        if parameter.part == RobotPart::State {
            continue;
        }
        let step = match parameter.unit {
            "m" => 1e-3,
            "1" => 1e-3,
            _ => 4e-3 * parameter.value.abs().max(1e-2),
        };
        all.push((parameter.path(), change, step));
    }
    for i in 0..parameters.robot().cables.len() {
        let mut change = RobotChange::none(parameters.robot().cables.len());
        change.cables[i].unstrained_length = 1.0;
        all.push((format!("length {i}"), change, 5e-4));
    }
    all
}

/// Central differences at four steps, extrapolated to the eighth order.
pub(super) fn romberg(step: f64, mut at: impl FnMut(f64) -> Option<Vec<f64>>) -> Option<Vec<f64>> {
    let mut rows: Vec<Vec<f64>> = Vec::new();
    for k in 0..4 {
        let h = step / f64::from(1 << k);
        let (low, high) = (at(-h)?, at(h)?);
        rows.push(low.iter().zip(&high).map(|(low, high)| (high - low) / (2.0 * h)).collect());
    }
    for order in 1..4 {
        let factor = f64::from(1 << (2 * order));
        rows = rows
            .windows(2)
            .map(|pair| {
                pair[0].iter().zip(&pair[1]).map(|(coarse, fine)| (factor * fine - coarse) / (factor - 1.0)).collect()
            })
            .collect();
    }
    rows.pop()
}

/// Largest difference of the gradients of results from differences, over the largest entry of each row, entries being those
/// of the steps.
fn worst(
    gradients: &[RobotChange],
    directions: &[(String, RobotChange, f64)],
    mut at: impl FnMut(&RobotChange, f64) -> Option<Vec<f64>>,
) -> (f64, String) {
    let mut largest = vec![0.0_f64; gradients.len()];
    let mut gaps: Vec<(f64, String)> = vec![(0.0, String::new()); gradients.len()];
    for (name, change, step) in directions {
        let Some(differences) = romberg(*step, |h| at(change, h)) else { panic!("no result beside {name}") };
        assert_eq!(differences.len(), gradients.len());
        for (k, (gradient, difference)) in gradients.iter().zip(&differences).enumerate() {
            let found = gradient.dot(change);
            largest[k] = largest[k].max(difference.abs() * step);
            let gap = (found - difference).abs() * step;
            if gap > gaps[k].0 {
                gaps[k] = (gap, format!("result {k} by {name}: {found} and {difference}"));
            }
        }
    }
    let over = gaps.into_iter().zip(largest).map(|((gap, what), largest)| (gap / largest.max(f64::MIN_POSITIVE), what));
    over.fold((0.0, String::new()), |worst, here| if here.0 > worst.0 { here } else { worst })
}

/// Pose, tensions and minimum stiffness of an equilibrium.
fn results(rest: &Equilibrium, from: &Equilibrium, robot: &Robot) -> Option<Vec<f64>> {
    let turn = (rest.pose.rot_wp * from.pose.rot_wp.inverse()).scaled_axis();
    let moved = rest.pose.position_w - from.pose.position_w;
    let mut values: Vec<f64> = moved.iter().chain(turn.iter()).copied().collect();
    values.extend(rest.cables.iter().map(|cable| cable.tension_platform));
    values.extend(rest.cables.iter().map(|cable| cable.tension_anchor));
    values.extend(rest.cables.iter().map(statics::CableState::tension_drum));
    values.extend(lengths_of(rest));
    let _ = robot;
    Some(values)
}

fn gradients_of(gradients: &Gradients<'_>) -> Vec<RobotChange> {
    let mut all = gradients.pose().to_vec();
    all.extend(gradients.tensions_platform());
    all.extend(gradients.tensions_anchor());
    all.extend(gradients.tensions_drum());
    all.extend(gradients.lengths());
    all
}

/// Robots of these tests.
fn robots() -> Vec<(String, Parameters)> {
    let mut all = Vec::new();
    for (seed, behind) in [Behind::Nothing, Behind::Winches, Behind::OnSupports, Behind::OnGround].into_iter().enumerate() {
        for count in [6, 8] {
            all.push((format!("{behind:?}, {count} cables"), random_robot(seed as u64 * 10 + count as u64, behind, count)));
        }
    }
    all
}

#[test]
fn statics_on_supports_follow_every_number_at_held_lengths() {
    for (name, parameters) in robots() {
        let robot = parameters.robot();
        let rest = at_rest(robot).unwrap_or_else(|| panic!("{name} has no equilibrium"));
        let gradients = Gradients::new(robot, &rest, Hold::Lengths).unwrap();
        let lengths = lengths_of(&rest);
        let (gap, what) = worst(&gradients_of(&gradients), &directions(&parameters), |change, h| {
            let changed = robot.changed(change, h);
            let lengths: Vec<f64> =
                lengths.iter().zip(&change.cables).map(|(length, cable)| length + h * cable.unstrained_length).collect();
            let at = statics::forward(&changed, &lengths, StaticModel::Catenary, Some(&rest.pose)).ok()?;
            results(&at, &rest, &changed)
        });
        eprintln!("{name}: {gap:e} {what}");
        assert!(gap < 1e-3, "{name}: {gap:e}, {what}");
    }
}

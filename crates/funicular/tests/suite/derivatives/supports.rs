//! Gradients of robots on flexible supports, against differences of the program itself: random robots, with and without
//! drives, two cables on a support, drums on the ground.

use funicular::cable::CableModel;
use funicular::cable::catenary_dynamic::DriveSignal;
use funicular::dynamics::{Dynamics, Linearisation};
use funicular::gradient::{Gradients, Hold};
use funicular::math::Vec3;
use funicular::modes;
use funicular::modes::damped::DampedMode;
use funicular::response::{self, Port, Quantity, Signal};
use funicular::robot::parameters::{Parameters, RobotPart};
use funicular::robot::{GuideWheelChange, Robot, RobotChange, SupportChange};
use funicular::statics::derivatives::{StaticDerivativeError, at_held_lengths};
use funicular::statics::{self, CableState, Equilibrium, StaticModel, TensionRule};
use std::f64::consts::TAU;
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

/// Supports and drives behind the cables of a robot.
#[derive(Debug, Clone, Copy, PartialEq)]
enum DriveVariant {
    Nothing,
    /// Winches without pulleys.
    Winches,
    OnSupports,
    OnGround,
    /// Drum sides with mass and motors under position control.
    RodsOnSupports,
    RodsOnGround,
}

impl DriveVariant {
    const ALL: [Self; 6] =
        [Self::Nothing, Self::Winches, Self::OnSupports, Self::OnGround, Self::RodsOnSupports, Self::RodsOnGround];

    fn is_on_ground(self) -> bool {
        matches!(self, Self::OnGround | Self::RodsOnGround)
    }

    fn has_rods(self) -> bool {
        matches!(self, Self::RodsOnSupports | Self::RodsOnGround)
    }
}

/// Tables of supports, and of the drives of their cables.
fn tables(r: &mut impl FnMut(f64, f64) -> f64, behind: DriveVariant, supports: usize) -> String {
    let mut text = String::new();
    for k in 0..supports {
        let (a, b, c) = (r(8e4, 3e4), r(1e5, 4e4), r(1.5e5, 5e4));
        let drums = if behind.is_on_ground() { "drums = \"on-ground\"\n" } else { "" };
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
    if behind != DriveVariant::Nothing {
        let _ = write!(
            text,
            "[winches.drum]\ndrum_side_length_m = {}\nstiffness_n_per_m = {}\ndrum_radius_m = 0.1\ndrum_inertia_kg_m2 \
             = 0.02\n",
            r(3.0, 0.5),
            r(3e5, 1e5)
        );
    }
    if behind.has_rods() {
        text += "drum_side = \"rod\"\nmotor_inertia_kg_m2 = 0.15\ncontrol = \"position\"\nbandwidth_hz = 6\n\
                 control_damping_ratio = 0.7\nintegral_action = \"no\"\ndelay_s = 0.002\n[guide_wheels.foot]\nwinch = \
                 \"drum\"\n\
                 distance_m = 1.5\nradius_m = 0.05\ninertia_kg_m2 = 0.0005\n";
    }
    if !matches!(behind, DriveVariant::Nothing | DriveVariant::Winches) {
        let _ = write!(
            text,
            "[pulleys.wheel]\nradius_m = {}\nentry_direction = [{}, {}, 1]\ninertia_kg_m2 = \
             0.002\nswivel_inertia_kg_m2 = 0.003\n",
            r(0.08, 0.02),
            r(0.0, 0.1),
            r(0.0, 0.1)
        );
    }
    text
}

/// Keys of the drive of a cable; the last one of four has none.
fn drive(behind: DriveVariant, i: usize) -> &'static str {
    match behind {
        _ if i == 3 => "",
        DriveVariant::Nothing => "",
        DriveVariant::Winches => "winch = \"drum\"\n",
        _ => "winch = \"drum\"\npulley = \"wheel\"\n",
    }
}

/// Suspended robot with a random geometry: cables in pairs on three supports, or on four of which one is rigid. `count`
/// cables, six or eight.
fn random_robot(seed: u64, behind: DriveVariant, count: usize) -> Parameters {
    let mut random = Random(seed);
    let mut r = |center: f64, width: f64| random.about(center, width);
    let mut text = format!(
        "name = \"random\"\n[platform]\nmass_kg = {}\ncenter_of_mass_m = [{}, {}, {}]\ninertia_kg_m2 = [[0.9, 0.1, \
         0.05], [0.1, 1.1, -0.08], [0.05, -0.08, 1.4]]\ntranslational_damping_n_s_m = [2, 3, \
         4]\nrotational_damping_n_m_s = [0.5, 0.4, 0.3]\n[materials.rope]\naxial_stiffness_n = {}\nmass_kg_per_m = \
         {}\ndamping_ratio = 0.01\n[loads]\n\
         force_n = [12, -8, -15]\npoint_m = [0.1, 0.05, -0.1]\nmoment_n_m = [1.0, -2.0, 0.5]\n",
        r(40.0, 8.0),
        r(0.0, 0.05),
        r(0.0, 0.05),
        r(-0.1, 0.05),
        r(2.5e5, 1e5),
        r(0.12, 0.05)
    );
    let angles: Vec<f64> = (0..count / 2).map(|k| k as f64 * std::f64::consts::TAU / (count / 2) as f64).collect();
    text += &tables(&mut r, behind, count / 2);
    for i in 0..count {
        let (k, side) = (i / 2, if i % 2 == 0 { 1.0 } else { -1.0 });
        let (angle, height) = (angles[k], if i % 2 == 0 { 5.0 } else { 4.6 });
        let at = angle + side * 0.02;
        let inner = angle + side * if count == 6 { 1.0 } else { 0.6 };
        let mut drive = drive(behind, i).to_owned();
        // One cable of the last pair has a rigid anchor.
        if i + 1 != count {
            let _ = writeln!(drive, "support = \"post{k}\"");
        }
        let _ = write!(
            text,
            "[[cables]]\nname = \"{i}\"\nmaterial = \"rope\"\nanchor_m = [{}, {}, {}]\nattachment_m = [{}, {}, \
             {}]\n{drive}",
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

/// Directions in which numbers of one kind change together by random shares, by their kind: one for each key of the
/// file, over all its tables and components, and one for the unstrained lengths. A unit changes values by the share
/// `size`, or by as many metres.
fn directions(parameters: &Parameters, seed: u64, size: f64) -> Vec<(String, RobotChange)> {
    let mut random = Random(seed);
    let mut all: Vec<(String, RobotChange)> = Vec::new();
    let cables = parameters.robot().cables.len();
    let mut add = |kind: String, change: &RobotChange, size: f64| {
        let found = all.iter().position(|(known, _)| *known == kind);
        let index = found.unwrap_or_else(|| {
            all.push((kind, RobotChange::none(cables)));
            all.len() - 1
        });
        all[index].1 = sum(&all[index].1, change, size);
    };
    // The loss of the stretch comes last, which changes no other direction.
    let list = parameters.list();
    let is_loss = |index: &usize| ["axial_loss_factor", "axial_damping_time_s"].contains(&list[*index].key);
    let (loss, others): (Vec<usize>, Vec<usize>) = (0..list.len()).partition(is_loss);
    let add_all = |indices: Vec<usize>, random: &mut Random, add: &mut dyn FnMut(String, &RobotChange, f64)| {
        for index in indices {
            let parameter = &list[index];
            let Some(change) = parameters.change(index) else { continue };
            if parameter.part == RobotPart::State {
                continue;
            }
            let share = match parameter.unit {
                "m" | "1" => 1.0,
                _ => parameter.value.abs().max(1e-2),
            };
            let kind = format!("{} {}", parameter.keys[0], parameter.key);
            add(kind, &change, size * share * random.about(0.0, 1.0));
        }
    };
    add_all(others, &mut random, &mut add);
    let lengths: Vec<f64> = (0..cables).map(|_| 0.3 * size * random.about(0.0, 1.0)).collect();
    let mut by_length = RobotChange::none(cables);
    by_length.cables.iter_mut().zip(lengths).for_each(|(cable, length)| cable.unstrained_length = length);
    add("lengths".to_owned(), &by_length, 1.0);
    add_all(loss, &mut random, &mut add);
    all
}

/// Sum of a change and a multiple of another one.
fn sum(one: &RobotChange, other: &RobotChange, factor: f64) -> RobotChange {
    let mut all = one.clone();
    all.gravity_w += other.gravity_w * factor;
    all.mass += other.mass * factor;
    all.inertia_p += other.inertia_p * factor;
    all.center_of_mass_p += other.center_of_mass_p * factor;
    all.drag_area += other.drag_area * factor;
    all.force_w += other.force_w * factor;
    all.moment_w += other.moment_w * factor;
    all.point_p += other.point_p * factor;
    all.wind_velocity_w += other.wind_velocity_w * factor;
    all.air_density += other.air_density * factor;
    all.translational_damping_p += other.translational_damping_p * factor;
    all.rotational_damping_p += other.rotational_damping_p * factor;
    for (cable, other) in all.cables.iter_mut().zip(&other.cables) {
        cable.anchor_w += other.anchor_w * factor;
        cable.attachment_p += other.attachment_p * factor;
        cable.unstrained_length += other.unstrained_length * factor;
        cable.axial_stiffness += other.axial_stiffness * factor;
        cable.mass_per_length += other.mass_per_length * factor;
        cable.load_per_length_w += other.load_per_length_w * factor;
        cable.drag_width += other.drag_width * factor;
        cable.damping += other.damping * factor;
        cable.loss_factor += other.loss_factor * factor;
        cable.damping_time += other.damping_time * factor;
        cable.pulley.radius += other.pulley.radius * factor;
        cable.pulley.entry_direction_w += other.pulley.entry_direction_w * factor;
        cable.pulley.inertia += other.pulley.inertia * factor;
        cable.pulley.swivel_inertia += other.pulley.swivel_inertia * factor;
        cable.winch.drum_side_length += other.winch.drum_side_length * factor;
        cable.winch.stiffness += other.winch.stiffness * factor;
        cable.winch.drum_mass += other.winch.drum_mass * factor;
        cable.winch.motor_mass += other.winch.motor_mass * factor;
        cable.winch.damping += other.winch.damping * factor;
        cable.winch.position_gain += other.winch.position_gain * factor;
        cable.winch.speed_gain += other.winch.speed_gain * factor;
        cable.winch.delay += other.winch.delay * factor;
        cable.guide_wheels.resize(other.guide_wheels.len().max(cable.guide_wheels.len()), GuideWheelChange::default());
        for (wheel, other) in cable.guide_wheels.iter_mut().zip(&other.guide_wheels) {
            wheel.distance += other.distance * factor;
            wheel.mass += other.mass * factor;
        }
    }
    all.supports.resize(other.supports.len().max(all.supports.len()), SupportChange::default());
    for (support, other) in all.supports.iter_mut().zip(&other.supports) {
        support.stiffness_w += other.stiffness_w * factor;
        support.mass += other.mass * factor;
        support.damping_ratio += other.damping_ratio * factor;
    }
    all
}

/// Smallest of the steps of [`romberg`].
const SMALLEST_STEP: f64 = 0.25;

/// Relative scatter of responses that forward statics leaves. Differences scatter by this over their step.
const NOISE_OF_RESPONSES: f64 = 1e-11;

/// Central differences at three steps, extrapolated to the sixth order.
fn romberg(mut at: impl FnMut(f64) -> Option<Vec<f64>>) -> Option<Vec<f64>> {
    let mut rows: Vec<Vec<f64>> = Vec::new();
    for k in 0..3 {
        let h = 1.0 / f64::from(1 << k);
        let (low, high) = (at(-h)?, at(h)?);
        rows.push(low.iter().zip(&high).map(|(low, high)| (high - low) / (2.0 * h)).collect());
    }
    for order in 1..3 {
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

/// Largest difference of the gradients of results from differences, over the largest entry of each row.
fn worst(
    gradients: &[RobotChange],
    directions: &[(String, RobotChange)],
    mut at: impl FnMut(&RobotChange, f64) -> Option<Vec<f64>>,
) -> (f64, String) {
    let mut largest = vec![0.0_f64; gradients.len()];
    let mut gaps: Vec<(f64, String)> = vec![(0.0, String::new()); gradients.len()];
    for (name, change) in directions {
        let Some(differences) = romberg(|h| at(change, h)) else { panic!("no result beside {name}") };
        assert_eq!(differences.len(), gradients.len());
        for (k, (gradient, difference)) in gradients.iter().zip(&differences).enumerate() {
            let found = gradient.dot(change);
            largest[k] = largest[k].max(difference.abs());
            let gap = (found - difference).abs();
            if gap > gaps[k].0 {
                gaps[k] = (gap, format!("result {k} by {name}: {found} and {difference}"));
            }
        }
    }
    let over = gaps.into_iter().zip(largest).map(|((gap, what), largest)| (gap / largest.max(f64::MIN_POSITIVE), what));
    over.fold((0.0, String::new()), |worst, here| if here.0 > worst.0 { here } else { worst })
}

/// Pose, tensions and lengths.
fn results(rest: &Equilibrium, from: &Equilibrium) -> Vec<f64> {
    let turn = (rest.pose.rot_wp * from.pose.rot_wp.inverse()).scaled_axis();
    let moved = rest.pose.position_w - from.pose.position_w;
    let mut values: Vec<f64> = moved.iter().chain(turn.iter()).copied().collect();
    values.extend(rest.cables.iter().map(|cable| cable.tension_platform));
    values.extend(rest.cables.iter().map(|cable| cable.tension_anchor));
    values.extend(rest.cables.iter().map(CableState::tension_drum));
    values.extend(lengths_of(rest));
    values
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
    for (seed, behind) in (0..).zip(DriveVariant::ALL) {
        for count in [6, 8] {
            all.push((format!("{behind:?}, {count} cables"), random_robot(seed * 10 + count as u64, behind, count)));
        }
    }
    all
}

/// Equilibrium of the changed robot with lengths held, apart from their own change.
fn changed(robot: &Robot, rest: &Equilibrium, change: &RobotChange, h: f64) -> Option<(Robot, Equilibrium)> {
    let changed = robot.changed(change, h);
    let lengths: Vec<f64> = lengths_of(rest)
        .iter()
        .zip(&change.cables)
        .map(|(length, cable)| length + h * cable.unstrained_length)
        .collect();
    let at = statics::forward(&changed, &lengths, StaticModel::Catenary, Some(&rest.pose)).ok()?;
    Some((changed, at))
}

/// Pose, tensions, lengths and stiffness with lengths held. The forward solver finds forces to 1e-12; over steps that
/// change them by a thousandth, differences of the smallest of three steps have 1e-8 of the largest entry.
#[test]
fn statics_on_supports_follow_every_number_at_held_lengths() {
    for (name, parameters) in robots() {
        let robot = parameters.robot();
        let rest = at_rest(robot).unwrap_or_else(|| panic!("{name} has no equilibrium"));
        let gradients = Gradients::new(robot, &rest, Hold::Lengths).unwrap();
        let (mut all, mut stiffness) = (gradients_of(&gradients), gradients.min_stiffness().unwrap());
        std::mem::swap(&mut stiffness, &mut all[0]);
        all.push(stiffness);
        all.push(gradients.tangent_entry(1, 3).unwrap());
        // Cables that are redundant change their tensions much over short ways.
        let size = if robot.cables.len() > 6 { 1e-4 } else { 1e-3 };
        let (gap, what) = worst(&all, &directions(&parameters, 7, size), |change, h| {
            let (robot, at) = changed(robot, &rest, change, h)?;
            let mut values = results(&at, &rest);
            let first = std::mem::replace(&mut values[0], at.stability.min_stiffness()?);
            let tangent = statics::tangent_stiffness(&robot, &at)?;
            values.extend([first, 0.5 * (tangent[(1, 3)] + tangent[(3, 1)])]);
            Some(values)
        });
        assert!(gap < 2e-8, "{name}: {gap:e}, {what}");
    }
}

/// Tensions and lengths of as many cables as degrees of freedom, whose pose is held. Inverse statics has the forces to
/// rounding.
#[test]
fn statics_on_supports_follow_every_number_at_a_held_pose() {
    for (name, parameters) in robots() {
        let robot = parameters.robot();
        if robot.cables.len() > 6 {
            continue;
        }
        let rest = at_rest(robot).unwrap_or_else(|| panic!("{name} has no equilibrium"));
        let gradients = Gradients::new(robot, &rest, Hold::Pose).unwrap();
        let directions = directions(&parameters, 8, 1e-3);
        let (gap, what) = worst(&gradients_of(&gradients)[6..], &directions[..directions.len() - 1], |change, h| {
            let at = statics::inverse(&robot.changed(change, h), &rest.pose, StaticModel::Catenary).ok()?;
            Some(results(&at, &rest)[6..].to_vec())
        });
        assert!(gap < 1e-9, "{name}: {gap:e}, {what}");
    }
}

/// Point mass on four cables with sag, two of them on one post, one on a mast and one with a rigid anchor.
fn small_robot(seed: u64, behind: DriveVariant) -> Parameters {
    let mut random = Random(seed);
    let mut r = |center: f64, width: f64| random.about(center, width);
    let mut text = format!(
        "name = \"small\"\n[platform]\nmass_kg = {}\nmotion = \"point-mass\"\ntranslational_damping_n_s_m = [2, 3, 4]\n\
         [materials.rope]\naxial_stiffness_n = {}\nmass_kg_per_m = {}\ndamping_ratio = 0.01\naxial_loss_factor = 0.03\n\
         axial_damping_time_s = 4e-4\n[loads]\nforce_n = [12, -8, -15]\n",
        r(20.0, 4.0),
        r(1.0e5, 3e4),
        r(0.15, 0.05)
    );
    text += &tables(&mut r, behind, 2);
    let anchors = [[3.0, 0.5, 4.0], [3.0, -0.5, 3.8], [-3.0, 1.0, 4.2], [-2.0, -2.0, 3.6]];
    for (i, (anchor, support)) in anchors.iter().zip([Some(0), Some(0), Some(1), None]).enumerate() {
        let support = support.map_or_else(String::new, |k| format!("support = \"post{k}\"\n"));
        let _ = write!(
            text,
            "[[cables]]\nname = \"{i}\"\nmaterial = \"rope\"\nanchor_m = [{}, {}, {}]\n{support}{}",
            r(anchor[0], 0.2),
            r(anchor[1], 0.2),
            r(anchor[2], 0.2),
            drive(behind, i)
        );
    }
    let _ = write!(text, "[state]\nposition_m = [0.3, -0.2, 1.5]\n");
    Parameters::from_toml(&text).unwrap_or_else(|issue| panic!("{issue}\n{text}"))
}

/// Robot that vibrates about an equilibrium.
fn dynamics_of(robot: &Robot, rest: &Equilibrium, cable_model: CableModel) -> Dynamics {
    let linearisation = Linearisation { cable_model, ..Linearisation::default() };
    Dynamics::about(robot, rest, linearisation, BELOW_HZ).unwrap()
}

/// Frequency up to which modes are listed [Hz].
const BELOW_HZ: f64 = 5.0;

/// Frequencies at which responses are compared [Hz].
const RESPONSES_HZ: [f64; 2] = [1.3, 4.6];

/// Responses between platform and drives, real and imaginary part, at frequencies beside and between resonances.
/// Forward statics leaves 1e-8 as in the statics.
fn compare_responses(behind: DriveVariant) {
    let parameters = small_robot(11, behind);
    let robot = parameters.robot();
    let rest = at_rest(robot).unwrap();
    for cable_model in [CableModel::Spring, CableModel::CatenaryStatic, CableModel::CatenaryDynamic] {
        let dynamics = dynamics_of(robot, &rest, cable_model);
        let gradients = Gradients::new(robot, &rest, Hold::Lengths).unwrap();
        let vibration = gradients.vibration(&dynamics).unwrap();

        let along = |x, y, z| Signal::Along { direction_w: Vec3::new(x, y, z), point_p: Vec3::zeros() };
        let mut inputs = vec![along(1.0, 0.3, 0.2)];
        let mut outputs = vec![(along(0.2, -0.5, 1.0), Quantity::Acceleration)];
        let has_drive = !matches!(behind, DriveVariant::Nothing) && cable_model == CableModel::CatenaryDynamic;
        if has_drive {
            inputs.push(Signal::Drive { cable: 0, signal: DriveSignal::Length });
            outputs.push((Signal::Drive { cable: 1, signal: DriveSignal::Drum }, Quantity::Displacement));
            if behind.has_rods() {
                inputs.push(Signal::Drive { cable: 2, signal: DriveSignal::Motor });
            }
        }

        // Every third direction of the model that costs most.
        let mut directions = directions(&parameters, 10, 1e-4);
        if cable_model == CableModel::CatenaryDynamic {
            directions = directions.into_iter().step_by(3).collect();
        }
        let changes: Vec<RobotChange> = directions.iter().map(|(_, change)| change.clone()).collect();
        let rows = vibration.responses(&inputs, &outputs, &RESPONSES_HZ, &changes).unwrap();
        let (mut largest, mut gaps) = (Vec::new(), Vec::new());
        for (d, (name, change)) in directions.iter().enumerate() {
            let differences = romberg(|h| {
                let (robot, at) = changed(robot, &rest, change, h)?;
                let dynamics = dynamics_of(&robot, &at, cable_model);
                let measured: Vec<Signal> = outputs.iter().map(|(signal, _)| *signal).collect();
                let from = Port::all(&robot, &at, &dynamics, &inputs, false).ok()?;
                let to = Port::all(&robot, &at, &dynamics, &measured, false).ok()?;
                let to: Vec<_> = to.into_iter().zip(outputs.iter().map(|(_, quantity)| *quantity)).collect();
                let rows = response::matrix(&dynamics, &RESPONSES_HZ, &from, &to).unwrap();
                Some(rows.iter().flatten().flat_map(|value| [value.re, value.im]).collect())
            });
            let found: Vec<f64> =
                rows.iter().flatten().map(|at| at.along[d]).flat_map(|value| [value.re, value.im]).collect();
            for (k, (found, difference)) in found.chunks(2).zip(differences.unwrap().chunks(2)).enumerate() {
                let size = |of: &[f64]| of[0].hypot(of[1]);
                let gap = size(&[found[0] - difference[0], found[1] - difference[1]]);
                if d == 0 {
                    largest.push(0.0_f64);
                    gaps.push((0.0_f64, String::new()));
                }
                largest[k] = largest[k].max(size(difference));
                if gap > gaps[k].0 {
                    gaps[k] = (gap, format!("{k} by {name}: {found:?} and {difference:?}"));
                }
            }
        }
        for (((gap, what), largest), at) in gaps.iter().zip(&largest).zip(rows.iter().flatten()) {
            let noise = NOISE_OF_RESPONSES * at.value.norm() / SMALLEST_STEP;
            assert!(
                *gap < 1e-8 * largest + noise,
                "{behind:?}, {cable_model}: {:e}, {what}, value {:e}",
                gap / largest,
                at.value.norm()
            );
        }
    }
}

/// Natural frequencies alone in their list, some of them at clamped poles. They are found to 1e-12, over steps that
/// change them by 1e-4 and less: differences have seven digits.
fn compare_frequencies(behind: DriveVariant) {
    let parameters = small_robot(12, behind);
    let robot = parameters.robot();
    let rest = at_rest(robot).unwrap();
    for cable_model in [CableModel::Spring, CableModel::CatenaryStatic, CableModel::CatenaryDynamic] {
        let dynamics = dynamics_of(robot, &rest, cable_model);
        let here = modes::below(&dynamics, BELOW_HZ);
        let far = |a: usize, b: usize| (here.modes[a].frequency_hz / here.modes[b].frequency_hz - 1.0).abs() > 0.01;
        let last = here.modes.len() - 1;
        let alone = |k: &usize| (*k == 0 || far(*k, k - 1)) && (*k == last || far(*k, k + 1));
        let mut chosen: Vec<usize> = (0..here.modes.len()).filter(alone).collect();
        chosen.truncate(4);
        assert!(!chosen.is_empty(), "{behind:?}, {cable_model}");

        let gradients = Gradients::new(robot, &rest, Hold::Lengths).unwrap();
        let vibration = gradients.vibration(&dynamics).unwrap();
        let all: Vec<RobotChange> = chosen.iter().map(|k| vibration.frequency(&here.modes[*k]).unwrap()).collect();
        let mut directions = directions(&parameters, 9, 1e-4);
        if cable_model == CableModel::CatenaryDynamic {
            directions = directions.into_iter().skip(1).step_by(3).collect();
        }
        let (gap, what) = worst(&all, &directions, |change, h| {
            let (robot, at) = changed(robot, &rest, change, h)?;
            let there = modes::below(&dynamics_of(&robot, &at, cable_model), BELOW_HZ);
            Some(chosen.iter().map(|k| there.modes[*k].frequency_hz).collect())
        });
        assert!(gap < 1e-7, "{behind:?}, {cable_model}: {gap:e}, {what}");
    }
}

#[test]
fn responses_on_supports_without_drives_follow_every_number() {
    compare_responses(DriveVariant::Nothing);
}

#[test]
fn responses_on_supports_with_winches_follow_every_number() {
    compare_responses(DriveVariant::Winches);
}

#[test]
fn responses_on_supports_with_drums_follow_every_number() {
    compare_responses(DriveVariant::OnSupports);
    compare_responses(DriveVariant::RodsOnSupports);
}

#[test]
fn responses_on_supports_before_drums_on_the_ground_follow_every_number() {
    compare_responses(DriveVariant::RodsOnGround);
    compare_responses(DriveVariant::OnGround);
}

#[test]
fn frequencies_on_supports_without_drives_follow_every_number() {
    compare_frequencies(DriveVariant::Nothing);
    compare_frequencies(DriveVariant::Winches);
}

#[test]
fn frequencies_on_supports_with_drums_follow_every_number() {
    compare_frequencies(DriveVariant::OnSupports);
    compare_frequencies(DriveVariant::RodsOnSupports);
}

#[test]
fn frequencies_on_supports_before_drums_on_the_ground_follow_every_number() {
    compare_frequencies(DriveVariant::RodsOnGround);
    compare_frequencies(DriveVariant::OnGround);
}

/// Damping ratios of damped modes: supports with damping, with and without motors under control. Zeros of the
/// determinant are found to 1e-12 or so; modes veer, so that the steps are short.
fn compare_damping(behind: DriveVariant) {
    let parameters = small_robot(13, behind);
    let robot = parameters.robot();
    let rest = at_rest(robot).unwrap();
    let damped = |robot: &Robot, rest: &Equilibrium| {
        let dynamics = dynamics_of(robot, rest, CableModel::CatenaryDynamic);
        let undamped = modes::below(&dynamics, 4.5);
        (modes::damped::damped_modes(&dynamics, &undamped).modes, dynamics)
    };
    let (here, dynamics) = damped(robot, &rest);
    let gradients = Gradients::new(robot, &rest, Hold::Lengths).unwrap();
    let vibration = gradients.vibration(&dynamics).unwrap();
    let found: Vec<_> = here.iter().map(|mode| vibration.damped(mode).unwrap()).collect();
    let all: Vec<RobotChange> = found.iter().flat_map(|of| [of.damping_ratio.clone(), of.ringing_hz.clone()]).collect();
    assert!(!all.is_empty(), "{behind:?}");

    let chosen: Vec<(String, RobotChange)> = directions(&parameters, 14, 3e-5)
        .into_iter()
        .filter(|(name, _)| ["supports", "damping_ratio", "anchor", "drum_side"].iter().any(|part| name.contains(part)))
        .collect();
    let (gap, what) = worst(&all, &chosen, |change, h| {
        let (robot, at) = changed(robot, &rest, change, h)?;
        let (there, _) = damped(&robot, &at);
        let nearest = |mode: &DampedMode| {
            let gap = |other: &&DampedMode| (other.omega - mode.omega).norm();
            there.iter().min_by(|a, b| gap(a).total_cmp(&gap(b))).map(|found| found.omega)
        };
        let omegas: Option<Vec<_>> = here.iter().map(nearest).collect();
        Some(omegas?.iter().flat_map(|omega| [omega.im / omega.norm(), omega.re / TAU]).collect())
    });
    assert!(gap < 1e-7, "{behind:?}: {gap:e}, {what}");
}

#[test]
fn damping_ratios_on_supports_without_drives_follow_every_number() {
    compare_damping(DriveVariant::Nothing);
}

#[test]
fn damping_ratios_on_supports_before_drums_on_the_ground_follow_every_number() {
    compare_damping(DriveVariant::OnGround);
}

#[test]
fn damping_ratios_on_supports_with_drums_follow_every_number() {
    compare_damping(DriveVariant::RodsOnSupports);
}

/// With tensions by a rule supports are refused, derivatives along one direction too.
#[test]
fn what_has_no_derivatives_on_supports_is_refused() {
    let parameters = random_robot(3, DriveVariant::Nothing, 8);
    let robot = parameters.robot();
    let pose = statics::solve(robot, StaticModel::Catenary, None).unwrap().equilibrium.pose;
    let rule = TensionRule::Closest(vec![200.0]);
    let rest = statics::distribute_tensions(robot, &pose, StaticModel::Catenary, &rule).unwrap();
    let refused = Gradients::by_rule(robot, &rest, &rule).err().unwrap();
    assert!(refused.to_string().contains("is on a flexible support: tensions that follow their rule"), "{refused}");
    let along = at_held_lengths(robot, &rest, &RobotChange::of_mass(robot));
    assert!(matches!(along, Err(StaticDerivativeError::Support { .. })));
}

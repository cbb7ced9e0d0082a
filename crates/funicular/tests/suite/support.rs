//! Robots whose anchors are on flexible supports: the robots of the tests, and the subjects in the files of the folder.
//!
//! - `statics`: balance of the supports, energy, stiffness against differences, all static problems
//! - `vibration`: modes, damped modes and counts, against the closed form of straight cables
//! - `responses`: signals of cables and drives, motions of the frame, against closed forms and moved robots
//! - `reduced`: second-order models and state spaces against these responses
//! - `limits`: stiff supports, masts in closed form, and what is refused

mod limits;
mod reduced;
mod responses;
mod statics;
mod vibration;

use funicular::dynamics::Dynamics;
use funicular::math::{CDMat, CMat3, Complex};
use funicular::response::{self, Port, Quantity, Signal};
use funicular::robot::{Control, DrumPlace, DrumSide, Pose, Robot, Servo};
use funicular::statics::{Equilibrium, StaticModel};
use std::fmt::Write;

/// Drive behind the cables of a robot of these tests.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Behind {
    /// Fixed ends.
    Nothing,
    /// Pulleys and drums on the supports.
    DrumsOnSupports,
    /// Pulleys on the supports, drums on the ground.
    DrumsOnGround,
}

impl Behind {
    const ALL: [Self; 3] = [Self::Nothing, Self::DrumsOnSupports, Self::DrumsOnGround];
}

/// CoGiRo on four posts with two cables each.
pub(super) fn cogiro(behind: Behind) -> Robot {
    let mut text = funicular_robots::COGIRO.to_owned();
    for (name, post) in ["1", "2", "3", "4", "5", "6", "7", "8"].into_iter().zip("aabbccdd".chars()) {
        let drive = if behind == Behind::Nothing { "" } else { "pulley = \"wheel\"\nwinch = \"drum\"\n" };
        text =
            text.replace(&format!("name = \"{name}\""), &format!("name = \"{name}\"\nsupport = \"{post}\"\n{drive}"));
    }
    let mut tables = String::new();
    if behind != Behind::Nothing {
        tables += "[pulleys.wheel]\nradius_m = 0.06\nentry_direction = [0.1, 0.0, 2.0]\n[winches.drum]\n\
                   drum_side_length_m = 5.0\nstiffness_n_per_m = 2e6\n";
    }
    let drums = if behind == Behind::DrumsOnGround { "drums = \"on-ground\"\n" } else { "" };
    for (post, size) in [("a", 1.0), ("b", 0.7), ("c", 1.3), ("d", 0.5)] {
        let _ = write!(
            tables,
            "[supports.{post}]\nmass_kg = {}\nstiffness_n_per_m = [[{}, 2e4, 0], [2e4, 3e5, -1e4], [0, -1e4, \
             4e6]]\n{drums}",
            20.0 * size,
            2e5 * size
        );
    }
    Robot::from_toml(&text.replacen("[[cables]]", &format!("{tables}[[cables]]"), 1)).unwrap()
}

/// A robot with wheels that have inertia, drum sides with mass, and motors under position control.
fn with_servos(mut robot: Robot) -> Robot {
    for cable in &mut robot.cables {
        let (anchor, mass) = (&mut cable.anchor, 20.0);
        if let (Some(pulley), Some(winch)) = (&mut anchor.pulley, &mut anchor.winch) {
            pulley.inertia = 2e-3;
            pulley.swivel_inertia = 4e-3;
            winch.drum_side = DrumSide::Rod;
            winch.motor_mass = mass;
            winch.control = Control::Position(Servo::of_bandwidth(mass, 6.0, 0.7, true, 0.0));
        }
    }
    robot
}

fn lengths(rest: &Equilibrium) -> Vec<f64> {
    rest.cables.iter().map(|cable| cable.unstrained_length).collect()
}

/// The robot at rest at a pose, from the lengths that hold it there.
fn at_rest(robot: &Robot) -> Equilibrium {
    let pose = Pose::new([1.0, 2.0, 1.5], [2.0, 1.0, 5.0]);
    let held = funicular::statics::inverse(robot, &pose, StaticModel::Catenary).unwrap();
    funicular::statics::forward(robot, &lengths(&held), StaticModel::Catenary, Some(&held.pose)).unwrap()
}

/// Robot with rigid anchors at the places of an equilibrium.
fn rigid(robot: &Robot, rest: &Equilibrium) -> Robot {
    let moved = rest.support_displacements(robot);
    let mut rigid = robot.clone();
    for cable in &mut rigid.cables {
        let Some(support) = cable.anchor.support.take() else { continue };
        let (displacement_w, on_ground) = (moved[support], robot.supports[support].drum == DrumPlace::OnGround);
        cable.anchor.point_w += displacement_w;
        if let (true, Some(pulley), Some(winch)) = (on_ground, &cable.anchor.pulley, &mut cable.anchor.winch) {
            winch.drum_side_length = (pulley.entry_direction_w * winch.drum_side_length + displacement_w).norm();
        }
    }
    rigid.supports.clear();
    rigid
}

/// Point mass without gravity on four cables, two of them on one post; straight cables have a closed form.
fn taut(post: &str) -> Robot {
    let cables: Vec<String> = [
        ("1", "[3.0, 0.5, 2.0]", "support = \"post\"\n", 3.55),
        ("2", "[3.0, -0.5, 1.8]", "support = \"post\"\n", 3.45),
        ("3", "[-3.0, 1.0, 1.0]", "support = \"mast\"\n", 3.25),
        ("4", "[-2.0, -1.0, -3.0]", "", 3.7),
    ]
    .iter()
    .map(|(name, anchor, support, length)| {
        format!(
            "[[cables]]\nname = \"{name}\"\nmaterial = \"rope\"\nanchor_m = {anchor}\n{support}unstrained_length_m = \
             {length}\n"
        )
    })
    .collect();
    let cables = cables.concat();
    Robot::from_toml(&format!(
        "name = \"taut\"\ngravity_m_s2 = [0, 0, 0]\n[platform]\nmass_kg = 2.0\nmotion = \"point-mass\"\n\
         [materials.rope]\naxial_stiffness_n = 4e4\nmass_kg_per_m = 0.05\ndamping_ratio = 0.01\n[supports.post]\n\
         mass_kg = 3.0\n{post}stiffness_n_per_m = [[3e4, 2e3, 0], [2e3, 5e4, -4e3], [0, -4e3, 9e4]]\n[supports.mast]\n\
         mass_kg = 0.5\nstiffness_n_per_m = 2e4\n{cables}"
    ))
    .unwrap()
}

/// Dynamic stiffness of platform and both supports of [`taut`] at the squares ω² and ω_c²: exact for straight cables.
fn closed_form(robot: &Robot, rest: &Equilibrium, own: Complex, square: Complex, losses: f64) -> CDMat {
    let mut all = CDMat::from_element(9, 9, Complex::new(0.0, 0.0));
    let mut add = |row: usize, column: usize, matrix: &CMat3| {
        let mut view = all.view_mut((row, column), (3, 3));
        view += matrix;
    };
    add(0, 0, &(CMat3::identity() * (-own * robot.platform.mass)));
    for (k, support) in robot.supports.iter().enumerate() {
        let stiffness =
            support.stiffness_w.map(Complex::from) * Complex::new(1.0, 2.0 * losses * support.damping_ratio);
        add(3 + 3 * k, 3 + 3 * k, &(stiffness - CMat3::identity() * (own * support.mass)));
    }
    for (cable, state) in robot.cables.iter().zip(&rest.cables) {
        let (ea, m, length) = (cable.material.axial_stiffness, cable.material.mass_per_length, state.unstrained_length);
        let across = ea * state.tension_platform / (ea + state.tension_platform);
        let t = state.chord_w().normalize();
        let along = (t * t.transpose()).map(Complex::from);
        let wave = |c: Complex| {
            let kappa = (square * m / c).sqrt();
            let phase = kappa * length;
            (c * kappa * phase.cos() / phase.sin(), -c * kappa / phase.sin())
        };
        let loss = cable.material.stretch_loss;
        let h = Complex::from(1.0) + Complex::i() * losses * (loss.factor + own.sqrt() * loss.time);
        let ((k, far), (k_across, far_across)) = (wave(ea * h), wave(across.into()));
        let block = |along_t: Complex, across_t: Complex| along * along_t + (CMat3::identity() - along) * across_t;
        add(0, 0, &block(k, k_across));
        if let Some(support) = cable.anchor.support {
            let at = 3 + 3 * support;
            add(at, at, &block(k, k_across));
            add(0, at, &block(far, far_across));
            add(at, 0, &block(far, far_across));
        }
    }
    all
}

/// Responses of motions of the platform at one frequency [Hz], by rows of outputs.
fn platform_responses(
    robot: &Robot,
    rest: &Equilibrium,
    dynamics: &Dynamics,
    hz: f64,
    inputs: &[Signal],
    outputs: &[Signal],
) -> Vec<Complex> {
    let inputs = Port::all(robot, rest, dynamics, inputs, false).unwrap();
    let outputs = Port::all(robot, rest, dynamics, outputs, false).unwrap();
    let outputs: Vec<(Port, Quantity)> = outputs.into_iter().map(|port| (port, Quantity::Displacement)).collect();
    response::matrix(dynamics, &[hz], &inputs, &outputs).unwrap().iter().map(|row| row[0]).collect()
}

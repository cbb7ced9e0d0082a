//! Robots whose anchors are on flexible supports: equilibria against robots with rigid, displaced anchors, and stiffness
//! against differences.

use funicular::cable::catenary_dynamic::DriveSignal;
use funicular::cable::{CableModel, LocalAxes};
use funicular::cable_motion::CableStations;
use funicular::dynamics::{Dynamics, Linearisation};
use funicular::math::{Complex, Mat3, Vec3};
use funicular::modes::{self, Kind};
use funicular::response::{self, FrameInput, Port, Quantity, Signal};
use funicular::robot::{Control, DrumPlace, DrumSide, Pose, Robot, Servo};
use funicular::statics::{self, CableState, Equilibrium, StaticModel, TensionRule};
use nalgebra::{DMatrix, Matrix3};
use std::f64::consts::TAU;
use std::fmt::Write;

/// Drive behind the cables of a robot of these tests.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Behind {
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
fn cogiro(behind: Behind) -> Robot {
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
            "[supports.{post}]\nmass_kg = {}\nstiffness_n_per_m = [[{}, 2e4, 0], [2e4, 3e5, -1e4], [0, -1e4, 4e6]]\n{drums}",
            20.0 * size,
            2e5 * size
        );
    }
    Robot::from_toml(&text.replacen("[[cables]]", &format!("{tables}[[cables]]"), 1)).unwrap()
}

fn lengths(rest: &Equilibrium) -> Vec<f64> {
    rest.cables.iter().map(|cable| cable.unstrained_length).collect()
}

/// The robot at rest at a pose, from the lengths that hold it there.
fn at_rest(robot: &Robot) -> Equilibrium {
    let pose = Pose::new([1.0, 2.0, 1.5], [2.0, 1.0, 5.0]);
    let held = statics::inverse(robot, &pose, StaticModel::Catenary).unwrap();
    statics::forward(robot, &lengths(&held), StaticModel::Catenary, Some(&held.pose)).unwrap()
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

/// Force of all cables on a support from the balance of each cable: its weight, less the forces at platform and drum.
fn force_on(robot: &Robot, rest: &Equilibrium, support: usize) -> Vec3 {
    let of_cable = |(cable, state): (&funicular::robot::Cable, &CableState)| {
        let moved = state.displacement_w;
        let mut length = state.unstrained_length;
        let mut force_w = -state.force_on_platform_w;
        if let (DrumPlace::OnGround, Some(pulley), Some(winch)) =
            (robot.supports[support].drum, &cable.anchor.pulley, &cable.anchor.winch)
        {
            let side_w = pulley.entry_direction_w * winch.drum_side_length;
            force_w -= (side_w + moved).normalize() * state.tension_drum();
            length -= winch.drum_side_length;
        }
        force_w + robot.gravity_w * (cable.material.mass_per_length * length)
    };
    let cables = robot.cables.iter().zip(&rest.cables);
    cables.filter(|(cable, _)| cable.anchor.support == Some(support)).map(of_cable).sum()
}

#[test]
fn supports_balance_their_cables_and_the_rest_is_a_rigid_robot() {
    for behind in Behind::ALL {
        let robot = cogiro(behind);
        let rest = at_rest(&robot);
        assert_eq!(robot.supports.len(), 4);

        // Balance of every support: rounding of forces of some hundred newtons.
        for (i, (support, moved)) in robot.supports.iter().zip(rest.support_displacements(&robot)).enumerate() {
            let gap = support.stiffness_w * moved - force_on(&robot, &rest, i);
            assert!(gap.norm() < 1e-9 && moved.norm() > 1e-4, "{behind:?}, {}: {gap:?}, {moved:?}", support.name);
        }

        // A robot with rigid anchors there rests in the same way.
        let stiff = rigid(&robot, &rest);
        let same = statics::forward(&stiff, &lengths(&rest), StaticModel::Catenary, Some(&rest.pose)).unwrap();
        assert!(statics::pose_distance(&robot, &same.pose, &rest.pose) < 1e-10);
        for (one, other) in same.cables.iter().zip(&rest.cables) {
            assert!((one.tension_platform - other.tension_platform).abs() < 1e-7 * one.tension_platform);
        }
    }
}

#[test]
fn the_lengths_of_a_pose_lead_back_to_it() {
    let pose = Pose::new([-3.0, 1.0, 2.5], [4.0, -3.0, 0.0]);
    for behind in Behind::ALL {
        let robot = cogiro(behind);
        for model in [StaticModel::Spring, StaticModel::Catenary] {
            let held = statics::distribute_tensions(&robot, &pose, model, &TensionRule::Lowest).unwrap();
            let back = statics::forward(&robot, &lengths(&held), model, None).unwrap();
            let gap = statics::pose_distance(&robot, &back.pose, &pose);
            assert!(gap < 1e-9, "{behind:?}, {model:?}: {gap:e}");
            let moved = held.support_displacements(&robot);
            for (one, other) in moved.iter().zip(back.support_displacements(&robot)) {
                assert!((one - other).norm() < 1e-9, "{behind:?}, {model:?}: {one:?}, {other:?}");
            }
        }
    }
}

#[test]
fn the_stiffness_is_that_of_differences_and_the_force_that_of_the_energy() {
    for behind in Behind::ALL {
        let robot = cogiro(behind);
        let rest = at_rest(&robot);
        let stiffness = statics::tangent_stiffness(&robot, &rest).unwrap();
        assert!((stiffness - stiffness.transpose()).norm() < 1e-9 * stiffness.norm());

        let held = statics::tangent_stiffness(&rigid(&robot, &rest), &rest).unwrap();
        assert!((held - stiffness).norm() > 0.05 * held.norm(), "{behind:?}: supports matter");

        let wrench = |pose: &Pose| statics::wrench(&robot, pose, &lengths(&rest), StaticModel::Catenary).unwrap();
        for k in 0..6 {
            let unit = |at: usize| if k == at { 1e-6 } else { 0.0 };
            let (move_w, turn_w) = (Vec3::new(unit(0), unit(1), unit(2)), Vec3::new(unit(3), unit(4), unit(5)));
            let [ahead, behind_w] =
                [1.0, -1.0].map(|sign| wrench(&rest.pose.moved(&(move_w * sign), &(turn_w * sign))));
            // The step's square and the rounding of forces of some hundred newtons over the step.
            let gap = ((behind_w - ahead) / 2e-6 - stiffness.column(k)).norm();
            assert!(gap < 1e-6 * stiffness.norm(), "{behind:?}, column {k}: {gap:e} of {:e}", stiffness.norm());
        }
    }
}

/// Energy at equilibria under different forces at the platform: the force that carries the platform from one to the other
/// does the work of the difference.
#[test]
fn the_energy_is_the_work_of_a_force() {
    for behind in Behind::ALL {
        let robot = cogiro(behind);
        let rest = at_rest(&robot);
        let with_force = |force_w: Vec3| {
            let mut load = robot.load;
            load.force_w = force_w;
            let loaded = robot.with_load(load);
            let found = statics::forward(&loaded, &lengths(&rest), StaticModel::Catenary, Some(&rest.pose)).unwrap();
            // The energy without the work of that force.
            (statics::energy(&robot, &found), found.pose.position_w)
        };
        let force_w = Vec3::new(40.0, -30.0, 25.0);
        // Simpson's rule over the force, in eight pieces: the platform moves by millimetres.
        let along: Vec<(f64, Vec3)> = (0..=8).map(|k| with_force(force_w * (f64::from(k) / 8.0))).collect();
        let weights = [1.0, 4.0, 2.0, 4.0, 2.0, 4.0, 2.0, 4.0, 1.0];
        let mean_w: Vec3 = along.iter().zip(weights).map(|((_, at_w), weight)| at_w * (weight / 24.0)).sum();
        let ((energy, _), (ahead, there_w)) = (along[0], along[8]);
        let work = force_w.dot(&(there_w - mean_w));
        assert!((ahead - energy - work).abs() < 1e-6 * work.abs(), "{behind:?}: {} and {work}", ahead - energy);
    }
}

#[test]
fn stiff_supports_are_rigid_ones() {
    for behind in Behind::ALL {
        let mut robot = cogiro(behind);
        let gap = |robot: &mut Robot, stiffness: f64| {
            robot.supports.iter_mut().for_each(|support| support.stiffness_w = Mat3::identity() * stiffness);
            let pose = Pose::new([1.0, 2.0, 1.5], [2.0, 1.0, 5.0]);
            let mut stiff = robot.clone();
            stiff.supports.clear();
            stiff.cables.iter_mut().for_each(|cable| cable.anchor.support = None);
            let held = statics::inverse(&stiff, &pose, StaticModel::Catenary).unwrap();
            let rest = statics::forward(robot, &lengths(&held), StaticModel::Catenary, Some(&pose)).unwrap();
            statics::pose_distance(robot, &rest.pose, &pose)
        };
        let [soft, stiff] = [1e7, 1e9].map(|stiffness| gap(&mut robot, stiffness));
        assert!(stiff < 1e-5 && (soft / stiff - 100.0).abs() < 5.0, "{behind:?}: {soft:e}, {stiff:e}");
    }
}

#[test]
fn every_static_problem_has_supports() {
    let robot = cogiro(Behind::Nothing);
    let rest = at_rest(&robot);
    let all = statics::all_equilibria(&robot, &lengths(&rest), StaticModel::Catenary, Some(&rest.pose)).unwrap();
    assert!(all.found.iter().any(|found| found.distance < 1e-8 && found.is_stable()), "{:?}", all.found.len());
    assert_eq!(Some(all.index_sum), all.expected_index_sum);

    // Ideal cables: the supports yield to their tensions.
    let pose = rest.pose;
    let ideal = statics::distribute_tensions(&robot, &pose, StaticModel::Ideal, &TensionRule::Lowest).unwrap();
    for (i, (support, moved)) in robot.supports.iter().zip(ideal.support_displacements(&robot)).enumerate() {
        let mut weightless = robot.clone();
        weightless.gravity_w = Vec3::zeros();
        let gap = support.stiffness_w * moved - force_on(&weightless, &ideal, i);
        assert!(gap.norm() < 1e-8, "{}: {gap:?}", support.name);
    }

    // Fewer cables than degrees of freedom: a point mass between two masts.
    let few = Robot::from_toml(
        "name = \"two\"\n[platform]\nmass_kg = 20.0\nmotion = \"point-mass\"\n[materials.rope]\naxial_stiffness_n = 1e5\n\
         mass_kg_per_m = 0.1\n[supports.left]\nstiffness_n_per_m = 2e4\n[supports.right]\nstiffness_n_per_m = 4e4\n\
         [[cables]]\nname = \"1\"\nmaterial = \"rope\"\nsupport = \"left\"\nanchor_m = [-2, 0, 3]\n[[cables]]\nname = \"2\"\n\
         material = \"rope\"\nsupport = \"right\"\nanchor_m = [2, 0, 3]\n",
    )
    .unwrap();
    let found =
        statics::nearest_equilibrium(&few, &Pose::new([0.3, 0.4, 1.5], [0.0; 3]), StaticModel::Catenary).unwrap();
    assert!((found.distance - 0.4).abs() < 1e-6, "{}", found.distance);
    let back =
        statics::forward(&few, &lengths(&found.equilibrium), StaticModel::Catenary, Some(&found.equilibrium.pose));
    let back = back.unwrap();
    assert!(statics::pose_distance(&few, &back.pose, &found.equilibrium.pose) < 1e-7);
    assert!(found.equilibrium.cables.iter().any(|cable| cable.displacement_w.norm() > 1e-5));
}

/// A mast with one massless cable: everything in closed form.
#[test]
fn a_mast_bends_to_a_hanging_weight() {
    let robot = Robot::from_toml(
        "name = \"mast\"\n[platform]\nmass_kg = 10.0\nmotion = \"point-mass\"\n[materials.rope]\n\
         axial_stiffness_n = 1e5\nmass_kg_per_m = 0.0\n[supports.mast]\nstiffness_n_per_m = 2e4\n[[cables]]\nname = \"1\"\n\
         material = \"rope\"\nsupport = \"mast\"\nanchor_m = [0, 0, 3]\nunstrained_length_m = 2.0\n",
    )
    .unwrap();
    let rest = statics::solve(&robot, StaticModel::Catenary, None).unwrap().equilibrium;
    let (weight, ea, k) = (98.1, 1e5, 2e4);
    assert!((rest.support_displacements(&robot)[0].z + weight / k).abs() < 1e-12);
    assert!((rest.pose.position_w.z - (3.0 - weight / k - 2.0 * (1.0 + weight / ea))).abs() < 1e-12);

    // Vertical stiffness of cable and mast in series; sideways the pendulum and the mast.
    let stiffness = statics::tangent_stiffness(&robot, &rest).unwrap();
    let chord = 2.0 * (1.0 + weight / ea);
    let series = |a: f64, b: f64| a * b / (a + b);
    assert!((stiffness[(2, 2)] / series(ea / 2.0, k) - 1.0).abs() < 1e-9);
    assert!((stiffness[(0, 0)] / series(weight / chord, k) - 1.0).abs() < 1e-9);
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
fn closed_form(robot: &Robot, rest: &Equilibrium, own: Complex, square: Complex, losses: f64) -> DMatrix<Complex> {
    let mut all = DMatrix::from_element(9, 9, Complex::new(0.0, 0.0));
    let mut add = |row: usize, column: usize, matrix: &Matrix3<Complex>| {
        let mut view = all.view_mut((row, column), (3, 3));
        view += matrix;
    };
    add(0, 0, &(Matrix3::identity() * (-own * robot.platform.mass)));
    for (k, support) in robot.supports.iter().enumerate() {
        let stiffness =
            support.stiffness_w.map(Complex::from) * Complex::new(1.0, 2.0 * losses * support.damping_ratio);
        add(3 + 3 * k, 3 + 3 * k, &(stiffness - Matrix3::identity() * (own * support.mass)));
    }
    for (cable, state) in robot.cables.iter().zip(&rest.cables) {
        let (ea, m, length) = (cable.material.axial_stiffness, cable.material.mass_per_length, state.unstrained_length);
        let across = ea * state.tension_platform / (ea + state.tension_platform);
        let t = state.chord_w().normalize();
        let along = (t * t.transpose()).map(Complex::from);
        let wave = |c: f64| {
            let kappa = (square * (m / c)).sqrt();
            let phase = kappa * length;
            (c * kappa * phase.cos() / phase.sin(), -c * kappa / phase.sin())
        };
        let ((k, far), (k_across, far_across)) = (wave(ea), wave(across));
        let block = |along_t: Complex, across_t: Complex| along * along_t + (Matrix3::identity() - along) * across_t;
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

#[test]
fn straight_cables_on_supports_have_their_closed_form() {
    let robot = taut("damping_ratio = 0.02\n");
    let rest = statics::solve(&robot, StaticModel::Catenary, None).unwrap().equilibrium;
    assert_eq!(robot.supports[1].name, "post");
    let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), 60.0).unwrap();

    // Damped stiffness of the platform.
    for hz in [0.3, 4.1, 11.3, 23.7, 55.0] {
        let omega = hz * TAU;
        let own = Complex::from(omega * omega);
        let all = closed_form(&robot, &rest, own, own * Complex::new(1.0, -0.02), 1.0);
        let far = all.view((3, 3), (6, 6)).into_owned().lu().solve(&all.view((3, 0), (6, 3)).into_owned()).unwrap();
        let exact = all.view((0, 0), (3, 3)) - all.view((0, 3), (3, 6)) * far;
        let found = dynamics.stiffness(omega) - dynamics.mass().map(|mass| own * mass);
        let gap = (found.fixed_view::<3, 3>(0, 0) - &exact).norm();
        // The error of the cables' discretisation.
        assert!(gap < 1e-8 * exact.norm(), "{hz} Hz: {gap:e} of {:e}", exact.norm());
    }

    // Undamped frequencies are the zeros of the determinant, none missed: a scan of its sign, without double zeros.
    let found = modes::below(&dynamics, 60.0);
    assert!(found.certified && found.modes.len() > 20, "{}", found.modes.len());
    for mode in &found.modes {
        let at = |factor: f64| {
            let own = Complex::from((mode.frequency_hz * TAU * factor).powi(2));
            closed_form(&robot, &rest, own, own, 0.0).map(|entry| entry.re).determinant()
        };
        assert!(at(1.0 - 1e-8) * at(1.0 + 1e-8) < 0.0, "{} Hz", mode.frequency_hz);
        let total: f64 = mode.platform_energy_fraction
            + mode.cable_energy_fractions.iter().sum::<f64>()
            + mode.support_energy_fractions.iter().sum::<f64>();
        assert!((total - 1.0).abs() < 1e-9, "{total}");
    }
    assert!(found.modes.iter().any(|mode| mode.support_energy_fractions[0] > 0.75 && mode.kind == Kind::Drive));

    // Damped frequencies are zeros of the complex determinant.
    let damped = modes::damped::damped_modes(&dynamics, &found);
    assert!(damped.certified);
    for (mode, undamped) in damped.modes.iter().zip(&found.modes) {
        let at = |omega: Complex| {
            let own = omega * omega;
            closed_form(&robot, &rest, own, own * Complex::new(1.0, -0.02), 1.0).determinant()
        };
        // Newton's step by a difference.
        let step = mode.omega * 1e-6;
        let newton = at(mode.omega) / ((at(mode.omega + step) - at(mode.omega - step)) / (step * 2.0));
        assert!(newton.norm() < 1e-8 * mode.omega.norm(), "{:?}: {newton}", mode.omega);
        assert!((mode.damping_ratio() - undamped.damping_ratio).abs() < 2e-3, "{undamped:?}");
    }
}

/// At rest the vibration has the stiffness of statics, with every model and with drums on supports and on the ground.
#[test]
fn slow_vibration_is_the_static_stiffness() {
    for behind in Behind::ALL {
        let robot = cogiro(behind);
        let rest = at_rest(&robot);
        let still = statics::tangent_stiffness(&robot, &rest).unwrap();
        for cable_model in [CableModel::CatenaryStatic, CableModel::CatenaryDynamic] {
            let linearisation = Linearisation { cable_model, ..Linearisation::default() };
            let dynamics = Dynamics::about(&robot, &rest, linearisation, 12.0).unwrap();
            let slow = dynamics.stiffness(1e-6).map(|entry| entry.re);
            let gap = (slow - still).norm() / still.norm();
            assert!(gap < 1e-9, "{behind:?}, {cable_model}: {gap:e}");
        }
        let slow = |cable_model: CableModel| {
            let linearisation = Linearisation { cable_model, ..Linearisation::default() };
            let dynamics = Dynamics::about(&robot, &rest, linearisation, 12.0).unwrap();
            let certified = modes::below(&dynamics, 6.0).certified;
            (dynamics.stiffness(1e-6).map(|entry| entry.re), certified)
        };
        let ((shallow, certified), (still, _)) = (slow(CableModel::ShallowDynamic), slow(CableModel::ShallowStatic));
        assert!(certified && (shallow - still).norm() < 1e-9 * still.norm(), "{behind:?}");

        let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), 12.0).unwrap();
        let found = modes::below(&dynamics, 12.0);
        assert!(found.certified && found.unstable_directions == 0);

        // Supports yield: no frequency is above that of the rigid frame there, and the platform's are lower.
        let stiff = Dynamics::about(&rigid(&robot, &rest), &rest, Linearisation::default(), 12.0).unwrap();
        let held = modes::below(&stiff, 12.0);
        for (free, held) in found.modes.iter().zip(&held.modes) {
            assert!(free.frequency_hz <= held.frequency_hz * (1.0 + 1e-12));
        }
        let platform = |found: &modes::Modes| found.modes[found.first_platform(0.5).unwrap()].frequency_hz;
        assert!(platform(&found) < 0.97 * platform(&held), "{} {}", platform(&found), platform(&held));
        let first = modes::first(&robot, &rest).unwrap().frequency_hz;
        assert!((first / found.modes[0].frequency_hz - 1.0).abs() < 1e-11);
    }
}

/// Servos, drum sides with mass and wheels with inertia on supports: every list is certified, and stiff supports without
/// mass are a rigid frame.
#[test]
fn drives_on_supports_are_part_of_the_count() {
    for behind in [Behind::DrumsOnSupports, Behind::DrumsOnGround] {
        let mut robot = cogiro(behind);
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
        let rest = at_rest(&robot);
        let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), 4.0).unwrap();
        let still = statics::tangent_stiffness(&robot, &rest).unwrap();
        let slow = dynamics.stiffness(1e-6).map(|entry| entry.re);
        // The position gain of the servo yields in vibration, but not at rest.
        let yields = (slow - still).norm() / still.norm();
        assert!(yields > 1e-3, "{yields}");

        let found = modes::below(&dynamics, 4.0);
        assert!(found.certified, "{behind:?}: {:?}", found.caveat());
        for mode in &found.modes {
            let all = [&mode.cable_energy_fractions, &mode.drive_energy_fractions, &mode.support_energy_fractions];
            let total = mode.platform_energy_fraction + all.into_iter().flatten().sum::<f64>();
            assert!((total - 1.0).abs() < 1e-9, "{behind:?}, {} Hz: {total}", mode.frequency_hz);
        }
        // Limit of stiff supports.
        let hz = |robot: &Robot| {
            let dynamics = Dynamics::about(robot, &rest, Linearisation::default(), 4.0).unwrap();
            modes::below(&dynamics, 4.0).modes.iter().map(|mode| mode.frequency_hz).collect::<Vec<_>>()
        };
        let frame = hz(&rigid(&robot, &rest));
        for support in &mut robot.supports {
            (support.stiffness_w, support.mass) = (Mat3::identity() * 1e11, 0.0);
        }
        let stiff = hz(&robot);
        assert_eq!(stiff.len(), frame.len());
        for (stiff, frame) in stiff.iter().zip(&frame) {
            assert!((stiff / frame - 1.0).abs() < 1e-5, "{behind:?}: {stiff} and {frame}");
        }
    }
}

/// Signals of drives and points of cables: at rest the derivatives of forward statics, and reciprocal at any frequency.
#[test]
fn responses_include_the_supports() {
    for behind in Behind::ALL {
        let robot = cogiro(behind);
        let rest = at_rest(&robot);
        let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), 6.0).unwrap();
        let along = |direction_w: Vec3| Signal::Along { direction_w, point_p: Vec3::zeros() };
        let drive = |cable: usize, signal: DriveSignal| Signal::Drive { cable, signal };
        let responses = |hz: f64, inputs: &[Signal], outputs: &[Signal], loaded: bool| {
            let inputs = Port::all(&robot, &rest, &dynamics, inputs, loaded).unwrap();
            let outputs = Port::all(&robot, &rest, &dynamics, outputs, loaded).unwrap();
            let outputs: Vec<(Port, Quantity)> = outputs.into_iter().map(|p| (p, Quantity::Displacement)).collect();
            response::matrix(&dynamics, &[hz], &inputs, &outputs).unwrap().iter().map(|row| row[0]).collect::<Vec<_>>()
        };

        // A length that is paid out: motion of the platform, and tensions of cables on this support and others.
        let outputs = [
            along(Vec3::x()),
            along(Vec3::z()),
            drive(1, DriveSignal::Tension),
            drive(0, DriveSignal::DrumTension),
            drive(1, DriveSignal::DrumTension),
            drive(6, DriveSignal::Tension),
        ];
        let found = responses(1e-4, &[drive(0, DriveSignal::Length)], &outputs, false);
        let step = 1e-6;
        let [ahead, back] = [step, -step].map(|amount| {
            let mut lengths = lengths(&rest);
            lengths[0] += amount;
            statics::forward(&robot, &lengths, StaticModel::Catenary, Some(&rest.pose)).unwrap()
        });
        let measured = |at: &Equilibrium| {
            let (p, cables) = (at.pose.position_w, &at.cables);
            let tensions = [cables[1].tension_platform, cables[0].tension_drum(), cables[1].tension_drum()];
            [p.x, p.z, tensions[0], tensions[1], tensions[2], cables[6].tension_platform]
        };
        for (k, (found, (ahead, back))) in found.iter().zip(measured(&ahead).iter().zip(measured(&back))).enumerate() {
            let difference = (ahead - back) / (2.0 * step);
            // Rounding of the equilibria over the step; a bent cable adds its linearised turn to the tension.
            assert!(
                (found.re - difference).abs() < 2e-5 * difference.abs().max(1.0),
                "{behind:?}, {k}: {found} {difference}"
            );
        }

        // Reciprocity between the platform, points of cables on one support and on two, and lengths.
        let point = |cable: usize| Signal::OnCable { cable, fraction: 0.4, direction_w: Vec3::new(0.3, 0.2, 1.0) };
        let ports = [along(Vec3::y()), point(0), point(1), point(5)];
        let both = Port::all(&robot, &rest, &dynamics, &ports, true).unwrap();
        let outputs: Vec<(Port, Quantity)> = both.iter().map(|p| (p.clone(), Quantity::Displacement)).collect();
        let all = response::matrix(&dynamics, &[3.7], &both, &outputs).unwrap();
        for i in 0..4 {
            for j in 0..4 {
                let (one, other) = (all[4 * i + j][0], all[4 * j + i][0]);
                assert!((one - other).norm() < 1e-9 * one.norm(), "{behind:?}, {i} {j}: {one} {other}");
            }
        }
    }
}

/// The base moves with the feet of all supports: against the closed form of straight cables, and rigidly at rest.
#[test]
fn supports_stand_on_the_base() {
    let robot = taut("damping_ratio = 0.02\n");
    let rest = statics::solve(&robot, StaticModel::Catenary, None).unwrap().equilibrium;
    let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), 60.0).unwrap();
    let axes = [Vec3::x(), Vec3::y(), Vec3::z()];
    let inputs = axes.map(|axis| Signal::Frame(FrameInput::BaseAlong(axis)));
    let outputs = axes.map(|direction_w| Signal::Along { direction_w, point_p: Vec3::zeros() });
    for hz in [0.7, 4.1, 11.3, 23.7, 55.0] {
        let found = platform_responses(&robot, &rest, &dynamics, hz, &inputs, &outputs);
        let own = Complex::from((hz * TAU).powi(2));
        let square = own * Complex::new(1.0, -0.02);
        let all = closed_form(&robot, &rest, own, square, 1.0);

        // Forces by the feet: as if every anchor moved, less the forces of the supports' own stiffness.
        let mut forces = DMatrix::from_element(9, 3, Complex::new(0.0, 0.0));
        let anchored = closed_form_of_anchors(&robot, &rest, square);
        for i in 0..3 {
            for j in 0..3 {
                forces[(i, j)] = -anchored[(i, j)];
                for (k, support) in robot.supports.iter().enumerate() {
                    let at = 3 + 3 * k;
                    let spring = support.stiffness_w[(i, j)] * Complex::new(1.0, 2.0 * support.damping_ratio);
                    forces[(at + i, j)] = spring - all[(at + i, at + j)];
                }
            }
        }
        let moved = all.lu().solve(&forces).unwrap();
        let size = moved.view((0, 0), (3, 3)).norm();
        for (i, j) in (0..3).flat_map(|i| (0..3).map(move |j| (i, j))) {
            // The error of the cables' discretisation, near resonances.
            let gap = (found[3 * i + j] - moved[(i, j)]).norm();
            assert!(gap < 1e-7 * size, "{hz} Hz, {i} {j}: {} {}", found[3 * i + j], moved[(i, j)]);
        }
    }

    for behind in Behind::ALL {
        let robot = cogiro(behind);
        let rest = at_rest(&robot);
        for cable_model in [CableModel::CatenaryStatic, CableModel::CatenaryDynamic] {
            let linearisation = Linearisation { cable_model, ..Linearisation::default() };
            let dynamics = Dynamics::about(&robot, &rest, linearisation, 6.0).unwrap();
            let found = platform_responses(&robot, &rest, &dynamics, 1e-4, &inputs, &outputs);
            for (i, j) in (0..3).flat_map(|i| (0..3).map(move |j| (i, j))) {
                let rigid = if i == j { 1.0 } else { 0.0 };
                let gap = (found[3 * i + j] - rigid).norm();
                assert!(gap < 1e-7, "{behind:?}, {cable_model}, {i} {j}: {}", found[3 * i + j]);
            }
        }
    }
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

/// Force on the platform of [`taut`] by a motion of all anchors at the square ω_c², less its sign.
fn closed_form_of_anchors(robot: &Robot, rest: &Equilibrium, square: Complex) -> Matrix3<Complex> {
    let of_cable = |(cable, state): (&funicular::robot::Cable, &CableState)| {
        let (ea, m, length) = (cable.material.axial_stiffness, cable.material.mass_per_length, state.unstrained_length);
        let across = ea * state.tension_platform / (ea + state.tension_platform);
        let t = state.chord_w().normalize();
        let along = (t * t.transpose()).map(Complex::from);
        let far = |c: f64| {
            let kappa = (square * (m / c)).sqrt();
            -c * kappa / (kappa * length).sin()
        };
        along * far(ea) + (Matrix3::identity() - along) * far(across)
    };
    robot.cables.iter().zip(&rest.cables).map(of_cable).sum()
}

/// In a mode, the far end of a cable moves as its support does, and the points between follow without a jump.
#[test]
fn cables_follow_their_supports_in_modes() {
    for behind in Behind::ALL {
        let robot = cogiro(behind);
        let rest = at_rest(&robot);
        let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), 9.0).unwrap();
        let found = modes::below(&dynamics, 9.0);
        let mode = &found.modes[found.first_platform(0.5).unwrap()];
        let fractions: Vec<f64> = (0..=200).map(|k| f64::from(k) / 200.0).collect();
        let [first, second] = [0, 1].map(|cable| {
            let stations = CableStations::new(&robot, &rest, &dynamics, cable, &fractions, false).unwrap();
            let moved = stations.in_mode(&dynamics, mode);
            let LocalAxes { e, n, b } = stations.axes;
            let points_w: Vec<Vec3> = moved.iter().map(|[x, y, z]| e * *x + n * *y + b * *z).collect();
            for pair in points_w.windows(2) {
                assert!((pair[0] - pair[1]).norm() < 0.3);
            }
            points_w[200]
        });
        // Without drives, both cables of a post end at one displacement.
        let size = first.norm();
        assert!(size > 1e-4, "{behind:?}: {size}");
        if behind == Behind::Nothing {
            assert!((first - second).norm() < 1e-9 * size, "{first:?} {second:?}");
        }
    }
}

#[test]
fn the_paper_has_no_supports() {
    let robot = cogiro(Behind::Nothing);
    let rest = at_rest(&robot);
    let in_plane = Linearisation { in_plane_only: true, ..Linearisation::default() };
    assert_eq!(
        Dynamics::about(&robot, &rest, in_plane, 5.0).unwrap_err().to_string(),
        "the anchor of cable \"1\" is on a flexible support, which moves in all directions: leave `in-plane-only` out"
    );
}

#[test]
fn the_reader_says_what_is_wrong_with_a_support() {
    let file = |support: &str, reference: &str| {
        format!(
            "name = \"mast\"\n[platform]\nmass_kg = 10.0\nmotion = \"point-mass\"\n[materials.rope]\naxial_stiffness_n = \
             1e5\nmass_kg_per_m = 0.0\n[supports.mast]\n{support}\n[[cables]]\nname = \"1\"\nmaterial = \"rope\"\nsupport = \
             \"{reference}\"\nanchor_m = [0, 0, 3]\nunstrained_length_m = 2.0\n"
        )
    };
    let message = |support: &str, reference: &str| {
        let error = Robot::from_toml(&file(support, reference)).unwrap_err();
        let help = error.issues()[0].help.clone().unwrap_or_default();
        format!("{}; {help}", error.issues()[0].message)
    };
    let good = "stiffness_n_per_m = [1e5, 2e5, 3e5]";
    assert!(message("mass_kg = 2", "mast").contains("has no `stiffness_n_per_m`"));
    assert!(message("stiffness_n_per_m = -1e5", "mast").contains("must be positive"));
    assert_eq!(
        message("stiffness_n_per_m = [[1e5, 2e5, 0], [2e5, 1e5, 0], [0, 0, 1e5]]", "mast"),
        "`stiffness_n_per_m` is not positive definite: its principal values are -100000, 100000 and 300000 N/m; a support \
         has to resist displacements in all directions; a rigid direction has a large number"
    );
    assert!(message("stiffness_n_per_m = [[1e5, 1, 0], [0, 1e5, 0], [0, 0, 1e5]]", "mast").contains("not symmetric"));
    assert!(message(&format!("{good}\nmass_kg = -1"), "mast").contains("must not be negative"));
    assert_eq!(
        message(&format!("{good}\ndamping_ratio = 2"), "mast"),
        "`damping_ratio` is 2, it must be below 1; it is a fraction of the critical damping, not per cent: structures have \
         0.005 to 0.05"
    );
    assert!(message(&format!("{good}\ndrums = \"on-grund\""), "mast").contains("did you mean \"on-ground\"?"));
    assert_eq!(message(good, "mats"), "there is no support \"mats\"; did you mean \"mast\"? the file has \"mast\"");
    assert!(Robot::from_toml(&file(good, "mast")).unwrap().has_supports());
}

/// Supports and cables without mass are springs: the mast of a massless rope swings with the platform alone.
#[test]
fn a_mast_without_mass_is_a_spring() {
    let robot = Robot::from_toml(
        "name = \"mast\"\n[platform]\nmass_kg = 10.0\nmotion = \"point-mass\"\n[materials.rope]\naxial_stiffness_n = 1e5\n\
         mass_kg_per_m = 0.0\n[supports.mast]\nstiffness_n_per_m = 2e4\n[[cables]]\nname = \"1\"\nmaterial = \"rope\"\n\
         support = \"mast\"\nanchor_m = [0, 0, 3]\nunstrained_length_m = 2.0\n",
    )
    .unwrap();
    let rest = statics::solve(&robot, StaticModel::Catenary, None).unwrap().equilibrium;
    let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), 20.0).unwrap();
    let found = modes::below(&dynamics, 20.0);
    assert!(found.certified && found.modes.len() == 3);
    let (weight, ea, k) = (98.1_f64, 1e5, 2e4);
    let chord = 2.0 * (1.0 + weight / ea);
    let series = |a: f64, b: f64| a * b / (a + b);
    let hz = |stiffness: f64| (stiffness / 10.0).sqrt() / TAU;
    for (mode, exact) in
        found.modes.iter().zip([series(weight / chord, k), series(weight / chord, k), series(ea / 2.0, k)])
    {
        assert!((mode.frequency_hz / hz(exact) - 1.0).abs() < 1e-9, "{} {}", mode.frequency_hz, hz(exact));
        assert_eq!(mode.support_energy_fractions, [0.0]);
    }
}

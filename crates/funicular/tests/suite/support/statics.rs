//! Supports at rest: against robots with rigid, displaced anchors, against differences and against the work of forces.

use super::{Behind, at_rest, cogiro, lengths, rigid};
use funicular::math::Vec3;
use funicular::robot::{DrumPlace, Pose, PulleyFriction, Robot};
use funicular::statics::{self, CableState, Equilibrium, Held, Interval, StaticModel, TensionRule};

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

/// Energy at equilibria under different forces at the platform: the force that carries the platform from one to the
/// other does the work of the difference.
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
        "name = \"two\"\n[platform]\nmass_kg = 20.0\nmotion = \"point-mass\"\n[materials.rope]\naxial_stiffness_n = \
         1e5\n\
         mass_kg_per_m = 0.1\n[supports.left]\nstiffness_n_per_m = 2e4\n[supports.right]\nstiffness_n_per_m = 4e4\n\
         [[cables]]\nname = \"1\"\nmaterial = \"rope\"\nsupport = \"left\"\nanchor_m = [-2, 0, 3]\n[[cables]]\nname = \
         \"2\"\n\
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

/// Friction of one pulley on a support that carries its drum: the intervals are those of equilibria for the changed
/// length.
#[test]
fn friction_moves_supports_and_platform() {
    let mut robot = cogiro(Behind::DrumsOnSupports);
    let friction = Some(PulleyFriction::Sliding { coefficient: 0.02 });
    robot.cables[2].anchor.pulley.as_mut().unwrap().friction = friction;
    let rest = at_rest(&robot);
    let found = statics::friction_interval(&robot, &rest, Held::Lengths).unwrap();
    let excess = found.cables[2].excess_length;
    assert!(excess.max > 1e-6 && found.cables[0].excess_length.max == 0.0);

    let [one, other] = [excess.min, excess.max].map(|excess| {
        let mut lengths = lengths(&rest);
        lengths[2] -= excess;
        statics::forward(&robot, &lengths, StaticModel::Catenary, Some(&rest.pose)).unwrap()
    });
    let check = |interval: Interval, value: &dyn Fn(&Equilibrium) -> f64, what: &str| {
        let (one, other) = (value(&one), value(&other));
        let (min, max) = (one.min(other), one.max(other));
        // Second order in the friction, and the weight of the changed length on the support.
        let tolerance = 5e-3 * (max - min);
        let gap = (interval.min - min).abs().max((interval.max - max).abs());
        assert!(gap < tolerance, "{what}: {interval:?}, {min} {max}");
    };
    let at = rest.pose.position_w;
    for axis in 0..3 {
        let interval = found.motion.unwrap().translation_w[axis];
        check(interval, &|at_one| at_one.pose.position_w[axis] - at[axis], "position");
    }
    for (i, cable) in found.cables.iter().enumerate() {
        check(cable.tension_platform, &|at_one| at_one.cables[i].tension_platform, "tension");
        if i != 2 {
            check(cable.tension_drum, &|at_one| at_one.cables[i].tension_drum(), "tension at the drum");
        }
    }

    // Supports make the robot softer: the platform moves further than on a rigid frame.
    let stiff = rigid(&robot, &rest);
    let held = statics::friction_interval(&stiff, &rest, Held::Lengths).unwrap();
    let [width, held] = [found, held].map(|found| found.motion.unwrap().translation_w[2].half_width());
    assert!((width / held - 1.0).abs() > 0.01, "{width:e} {held:e}");
}

/// A mast with a pulley and a drum below it: friction changes the pull of the drum side at the mast. Everything in
/// closed form.
#[test]
fn friction_relieves_a_mast_of_the_pull_of_its_drum() {
    let (mu, radius, below, spring, ea, k, total) = (1e-4_f64, 0.2, 4.0, 1e5, 2e5, 3e4, 7.0);
    let robot = Robot::from_toml(&format!(
        "name = \"mast\"\n[platform]\nmass_kg = 50.0\nmotion = \"planar\"\nplane_normal = [0, 1, 0]\ninertia_kg_m2 = \
         1.0\n\
         [materials.rope]\naxial_stiffness_n = {ea}\n\
         mass_kg_per_m = 0.0\n[pulleys.wheel]\nradius_m = {radius}\nentry_direction = [0, 0, 1]\nfriction_coefficient \
         = {mu}\n\
         [winches.drum]\ndrum_side_length_m = {below}\nstiffness_n_per_m = \
         {spring}\n[supports.mast]\nstiffness_n_per_m = {k}\n\
         drums = \"on-ground\"\n[[cables]]\nname = \"1\"\nmaterial = \"rope\"\nsupport = \"mast\"\npulley = \
         \"wheel\"\nwinch = \
         \"drum\"\nanchor_m = [0, 0, 5]\nattachment_m = [0, 0, 0.1]\nunstrained_length_m = {total}\n"
    ))
    .unwrap();
    let start = Pose::new([0.4, 0.0, 2.0], [0.0; 3]);
    let rest = statics::forward(&robot, &[total], StaticModel::Catenary, Some(&start)).unwrap();
    let found = statics::friction_interval(&robot, &rest, Held::Lengths).unwrap();

    // Height of the body, and the tension at the drum; `used` is the fraction of the friction.
    let weight = 50.0 * 9.81;
    let height = |used: f64| {
        let wrap = std::f64::consts::PI;
        let tension = weight * (-used * mu * wrap).exp();
        let moved = -(weight + tension) / k;
        let drum_side = (below + moved - tension / spring) / (1.0 + tension / ea);
        let low = weight.min(tension) / ea;
        let on_wheel = if used == 0.0 {
            radius * wrap / (1.0 + weight / ea)
        } else {
            radius * wrap - radius / mu * ((1.0 + low * (mu * wrap).exp()) / (1.0 + low)).ln()
        };
        let free = total - on_wheel - drum_side;
        5.0 + moved - free * (1.0 + weight / ea)
    };
    let vertical = found.motion.unwrap().translation_w[2];
    let (up, down) = (height(1.0) - height(0.0), height(-1.0) - height(0.0));
    for (interval, exact) in [(vertical.max, up.max(down)), (vertical.min, up.min(down))] {
        // Second order in the friction.
        assert!((interval / exact - 1.0).abs() < 1e-3, "{interval:e} {exact:e}");
    }
    assert!((found.cables[0].tension_platform.half_width()) < 1e-6);
    let relief = rest.cables[0].tension_drum() * mu * std::f64::consts::PI;
    assert!((found.cables[0].tension_drum.half_width() / relief - 1.0).abs() < 1e-6);

    // With the pose held, the support would move.
    let message = statics::friction_interval(&robot, &rest, Held::Pose).unwrap_err().to_string();
    assert!(message.contains("cable \"1\"") && message.contains("drums = \"on-support\""), "{message}");
}

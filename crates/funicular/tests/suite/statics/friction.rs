//! Friction of pulleys: strain behind the exit points against closed forms, and intervals against equilibria that are
//! solved with friction. The comparison with another program is in the validation.

use funicular::drive::CableAtRest;
use funicular::math::Vec3;
use funicular::robot::{Load, Pose, PulleyFriction, Robot, TensionLimits};
use funicular::statics::{self, CableFriction, Equilibrium, FrictionError, Held, Interval, StaticModel, TensionRule};

const SLIDING: &str = "friction_coefficient = 0.03";

/// 4 mm robot over pulleys to winches, with keys of its pulleys.
fn robot(friction: &str) -> Robot {
    let tables = format!(
        "[pulleys.wheel]\nradius_m = 0.05\nentry_direction = [0, 0, 1]\n{friction}\n[winches.drum]\n\
         drum_side_length_m = 3.0\nstiffness_n_per_m = 5e4\n[[cables]]\n"
    );
    let text = funicular_robots::YUAN2014_4MM.replacen("[[cables]]\n", &tables, 1);
    let text = text.replace("[[cables]]\n", "[[cables]]\npulley = \"wheel\"\nwinch = \"drum\"\n");
    Robot::from_toml(&text).unwrap()
}

const LENGTHS: [f64; 6] = [9.929, 9.628, 9.823, 9.725, 9.867, 9.667];

fn at_lengths(robot: &Robot, lengths: &[f64]) -> Equilibrium {
    statics::forward(robot, lengths, StaticModel::Catenary, None).unwrap()
}

/// Platform in a vertical plane on one cable without mass that runs up a post and over half of a wheel.
fn hanging(friction: &str) -> Robot {
    let text = format!(
        "name = \"one\"\n[platform]\nmass_kg = 50.0\nmotion = \"planar\"\nplane_normal = [0, 1, 0]\ninertia_kg_m2 = \
         1.0\n[materials.rope]\n\
         axial_stiffness_n = 2e5\nmass_kg_per_m = 0.0\n[pulleys.wheel]\nradius_m = 0.2\nentry_direction = [0, 0, 1]\n\
         {friction}\n[winches.drum]\ndrum_side_length_m = 4.0\nstiffness_n_per_m = 1e5\n[[cables]]\nname = \"1\"\n\
         material = \"rope\"\npulley = \"wheel\"\nwinch = \"drum\"\nanchor_m = [0, 0, 5]\nattachment_m = [0, 0, 0.1]\n"
    );
    Robot::from_toml(&text).unwrap()
}

/// Unstrained length behind the exit point without friction and with it, both by closed forms for a tension T at the
/// exit and the wrap β: with T constant along the drum side, and `T_low e^(μθ)` on the wheel.
fn excess_by_closed_form(tension: f64, wrap: f64, coefficient: f64, sign: f64) -> f64 {
    let (radius, drum_side, stiffness, ea) = (0.2, 4.0, 1e5, 2e5);
    let tension_drum = tension * (-sign * coefficient * wrap).exp();
    let low = tension.min(tension_drum) / ea;
    let grown = (1.0 + low * (coefficient * wrap).exp()) / (1.0 + low);
    let arc = radius * wrap - radius / coefficient * grown.ln();
    let beyond = |tension: f64| (drum_side - tension / stiffness) / (1.0 + tension / ea);
    let without = radius * wrap / (1.0 + tension / ea) + beyond(tension);
    arc + beyond(tension_drum) - without
}

#[test]
fn the_strain_of_a_sliding_cable_is_that_of_the_closed_form() {
    for coefficient in [0.01, 0.15, 0.8] {
        let robot = hanging(&format!("friction_coefficient = {coefficient}"));
        for attachment_w in [Vec3::new(0.4, 0.0, 0.0), Vec3::new(2.0, 1.0, 4.0)] {
            let anchor = &robot.cables[0].anchor;
            let free = (anchor.exit_w(&attachment_w) - attachment_w).norm();
            let straight = free + anchor.length_beyond(&attachment_w);
            let cable = CableAtRest::of(&robot, 0, attachment_w, straight - 0.02);
            let drive = cable.drive.as_ref().unwrap();
            let wrap = drive.contact.unwrap().wrap;
            for sign in [1.0, -1.0] {
                let found = drive.with_friction(&cable.span, &robot.cables[0].anchor, sign);
                let tension = cable.span.catenary.tension_at_end();
                let exact = excess_by_closed_form(tension, wrap, coefficient, sign);
                // Rounding of lengths of some metres, and the rule of six points on a factor of up to e^2.5.
                let tolerance = 1e-14 + 1e-11 * exact.abs();
                assert!((found.excess_length - exact).abs() < tolerance, "{} {exact}", found.excess_length);
                let factor = (-sign * coefficient * wrap).exp();
                assert!((found.tension_drum / tension / factor - 1.0).abs() < 1e-12);
            }
            // Half of the friction takes the square root of the factor.
            let half = drive.with_friction(&cable.span, &robot.cables[0].anchor, 0.5).tension_drum;
            let whole = drive.with_friction(&cable.span, &robot.cables[0].anchor, 1.0).tension_drum;
            assert!((half * half / (whole * drive.tension_drum) - 1.0).abs() < 1e-12);
        }
    }
}

#[test]
fn the_exponents_of_the_three_kinds_are_those_of_mechanics() {
    let contact_of = |robot: &Robot| robot.cables[0].anchor.contact(&Vec3::new(0.4, 0.0, -20.0)).unwrap();
    let exponent = |friction: &str| {
        let robot = hanging(friction);
        let contact = contact_of(&robot);
        let friction = robot.cables[0].anchor.pulley.as_ref().unwrap().friction.unwrap();
        friction.exponent(contact.radius, contact.wrap)
    };
    // Half a turn.
    let half_turn = contact_of(&hanging("")).wrap;
    assert!((half_turn - std::f64::consts::PI).abs() < 1e-12);
    assert!((exponent("friction_coefficient = 0.2") - 0.2 * half_turn).abs() < 1e-15);
    assert!((exponent("efficiency = 0.96") + 0.96_f64.ln()).abs() < 1e-15);
    assert!(exponent("efficiency = 1.0").abs() < f64::MIN_POSITIVE);

    // Moments about the axle: (T₂ − T₁) r = μ_b r_b (T₁ + T₂), the cable running in and out in parallel.
    let ratio = exponent("bearing_friction_coefficient = 0.1\nbearing_radius_m = 0.01").exp();
    let moments = (ratio - 1.0) * 0.2 - 0.1 * 0.01 * (1.0 + ratio);
    // The exponent is of first order in the moment of the bearing.
    assert!(moments.abs() < 0.2 * (2.0 * 0.1 * 0.01 / 0.2_f64).powi(3), "{moments:e}");
}

/// The platform's motion and the tensions of a mass on one vertical cable by hand.
#[test]
fn a_platform_on_one_cable_moves_by_the_strain_of_its_drum_side() {
    for friction in ["friction_coefficient = 0.1", "efficiency = 0.93"] {
        let robot = hanging(friction);
        // Near the equilibrium: the search would begin on the swivel axis.
        let start = Pose::new([0.4, 0.0, 0.02], [0.0; 3]);
        let rest = statics::forward(&robot, &[9.5], StaticModel::Catenary, Some(&start)).unwrap();
        let found = statics::friction_interval(&robot, &rest, Held::Lengths).unwrap();
        let (cable, drive) = (found.cables[0], rest.cables[0].drive.as_ref().unwrap());
        let weight = 50.0 * 9.81;
        assert!((drive.contact.unwrap().wrap - std::f64::consts::PI).abs() < 1e-9);

        // The tension at the platform is the weight; the free span's strain is, too.
        let height = found.motion.unwrap().translation_w[2];
        let stretch = 1.0 + weight / 2e5;
        assert!((height.min - cable.excess_length.min * stretch).abs() < 1e-12, "{height:?}");
        assert!((height.max - cable.excess_length.max * stretch).abs() < 1e-12, "{height:?}");
        for tension in [cable.tension_platform, cable.tension_anchor] {
            assert!((tension.min - weight).abs() < 1e-6 && (tension.max - weight).abs() < 1e-6, "{tension:?}");
        }
        let factor = cable.exponent.exp();
        let drum = cable.tension_drum;
        assert!((drum.min * factor / weight - 1.0).abs() < 1e-8 && (drum.max / factor / weight - 1.0).abs() < 1e-8);

        // Drum side and winch, and the wheel with the tension of the drum if it turns.
        let (behind, winch) = (4.0 / 2e5, 1.0 / 1e5);
        let lost = weight * (1.0 - 1.0 / factor);
        let least = lost * (behind + winch) / (stretch * (stretch - lost / 2e5));
        let whole = least + lost * 0.2 * std::f64::consts::PI / 2e5 / (stretch * (stretch - lost / 2e5));
        if friction.starts_with("efficiency") {
            assert!((cable.excess_length.max / whole - 1.0).abs() < 1e-9);
        } else {
            let share = (cable.excess_length.max - least) / (whole - least);
            // Mean of 1 − e^(−μφ) over the arc, by its end value; the stretch changes it by the strain.
            let exponent = cable.exponent;
            let mean = (exponent - 1.0 + (-exponent).exp()) / (exponent * (1.0 - (-exponent).exp()));
            assert!((share - mean).abs() < 0.01 * mean, "{share} {mean}");
        }
    }
}

/// Equilibrium with friction: cables without friction that are shorter by the excess length of their own tension.
fn with_friction(robot: &Robot, lengths: &[f64], used: &[f64]) -> (Equilibrium, Vec<f64>) {
    let mut rest = at_lengths(robot, lengths);
    let mut drum = Vec::new();
    for _ in 0..30 {
        let friction = |((cable, state), used): ((&funicular::robot::Cable, &statics::CableState), &f64)| {
            let (span, drive) = (state.hanging.as_ref().unwrap(), state.drive.as_ref().unwrap());
            drive.with_friction(span, &cable.anchor, *used)
        };
        let found: Vec<_> = robot.cables.iter().zip(&rest.cables).zip(used).map(friction).collect();
        let shorter: Vec<f64> = lengths.iter().zip(&found).map(|(length, own)| length - own.excess_length).collect();
        rest = statics::forward(robot, &shorter, StaticModel::Catenary, Some(&rest.pose)).unwrap();
        drum = found.iter().map(|own| own.tension_drum).collect();
    }
    (rest, drum)
}

/// All 64 combinations of last motions, solved without linearisation, fill the interval.
#[test]
fn equilibria_with_friction_fill_the_interval() {
    for friction in [SLIDING, "efficiency = 0.97", "bearing_friction_coefficient = 0.2\nbearing_radius_m = 0.01"] {
        let robot = robot(friction);
        let rest = at_lengths(&robot, &LENGTHS);
        let found = statics::friction_interval(&robot, &rest, Held::Lengths).unwrap();
        let motion = found.motion.unwrap();
        let intervals = |own: &CableFriction| [own.tension_platform, own.tension_anchor, own.tension_drum];

        let mut moved = [Interval { min: 0.0, max: 0.0 }; 6];
        let mut tensions = vec![[Interval { min: f64::INFINITY, max: 0.0 }; 3]; 6];
        let widen = |interval: &mut Interval, value: f64| {
            *interval = Interval { min: interval.min.min(value), max: interval.max.max(value) };
        };
        for corner in 0..64_u32 {
            let used: Vec<f64> = (0..6).map(|i| if corner >> i & 1 == 1 { 1.0 } else { -1.0 }).collect();
            let (solved, drum) = with_friction(&robot, &LENGTHS, &used);
            let translation = solved.pose.position_w - rest.pose.position_w;
            let rotation = (solved.pose.rot_wp * rest.pose.rot_wp.inverse()).scaled_axis();
            for (interval, value) in moved.iter_mut().zip(translation.iter().chain(rotation.iter())) {
                widen(interval, *value);
            }
            for (i, state) in solved.cables.iter().enumerate() {
                let [platform, anchor, at_drum] = &mut tensions[i];
                widen(platform, state.tension_platform);
                widen(anchor, state.tension_anchor);
                widen(at_drum, drum[i]);
            }
        }

        // Second-order terms: the motion of a few tenths of a millimetre over the way to a singular pose.
        let linear = motion.translation_w.iter().chain(&motion.rotation_w);
        for (ours, solved) in linear.zip(&moved) {
            let gap = (ours.min - solved.min).abs().max((ours.max - solved.max).abs());
            assert!(gap < 0.01 * ours.half_width(), "{friction}: {ours:?} {solved:?}");
        }
        for (own, solved) in found.cables.iter().zip(&tensions) {
            for (ours, solved) in intervals(own).iter().zip(solved) {
                let gap = (ours.min - solved.min).abs().max((ours.max - solved.max).abs());
                assert!(gap < 0.01 * ours.half_width(), "{friction}: {ours:?} {solved:?}");
            }
        }
    }
}

#[test]
fn a_held_pose_leaves_the_tension_at_the_drum_and_the_length_open() {
    let robot = robot(SLIDING);
    let rest = at_lengths(&robot, &LENGTHS);
    let found = statics::friction_interval(&robot, &rest, Held::Pose).unwrap();
    assert_eq!(found.motion, None);
    let exponents = statics::friction_exponents(&robot, &rest);
    for ((own, state), exponent) in found.cables.iter().zip(&rest.cables).zip(exponents) {
        let wrap = state.drive.as_ref().unwrap().contact.unwrap().wrap;
        assert!((own.exponent - 0.03 * wrap).abs() < 1e-15 && own.exponent.to_bits() == exponent.to_bits());
        for (interval, tension) in
            [(own.tension_platform, state.tension_platform), (own.tension_anchor, state.tension_anchor)]
        {
            assert_eq!((interval.min, interval.max), (tension, tension));
        }
        let tension = state.tension_drum();
        assert!((own.tension_drum.min / tension - (-exponent).exp()).abs() < 1e-14);
        assert!((own.tension_drum.max / tension - exponent.exp()).abs() < 1e-14);
        assert!(own.excess_length.min < 0.0 && own.excess_length.max > 0.0);
    }
}

/// Without strain the pose does not depend on friction: ideal cables, and the limit of stiff ones.
#[test]
fn friction_does_not_move_a_robot_of_rigid_cables() {
    let robot = robot(SLIDING);
    let straight = statics::forward(&robot, &LENGTHS, StaticModel::Spring, None).unwrap();
    let spring = statics::friction_interval(&robot, &straight, Held::Lengths).unwrap();
    assert!(spring.motion.unwrap().translation_w[2].half_width() > 1e-5);

    let pose = straight.pose;
    let ideal = statics::inverse(&robot, &pose, StaticModel::Ideal).unwrap();
    for held in [Held::Lengths, Held::Pose] {
        let found = statics::friction_interval(&robot, &ideal, held).unwrap();
        let still = found.motion.is_none_or(|motion| motion.translation_w.iter().all(|x| x.half_width() == 0.0));
        assert!(still);
        for (own, state) in found.cables.iter().zip(&ideal.cables) {
            assert!((own.tension_drum.max / state.tension_drum() - own.exponent.exp()).abs() < 1e-14);
            assert!(own.tension_platform.half_width().abs() < f64::MIN_POSITIVE);
        }
    }
}

#[test]
fn friction_of_zero_has_no_width_and_no_friction_is_refused() {
    for friction in ["friction_coefficient = 0.0", "efficiency = 1"] {
        let robot = robot(friction);
        let rest = at_lengths(&robot, &LENGTHS);
        let found = statics::friction_interval(&robot, &rest, Held::Lengths).unwrap();
        assert!(found.motion.unwrap().translation_w.iter().all(|x| x.half_width() == 0.0));
        assert!(found.cables.iter().all(|own| own.tension_drum.half_width() < 1e-14 * own.tension_drum.max));
    }
    let plain = robot("");
    let rest = at_lengths(&plain, &LENGTHS);
    assert_eq!(statics::friction_exponents(&plain, &rest), [0.0; 6]);
    assert_eq!(statics::friction_interval(&plain, &rest, Held::Pose), Err(FrictionError::NoFriction));
}

/// Friction takes no part in the equilibrium itself.
#[test]
fn the_equilibrium_does_not_depend_on_friction() {
    let (plain, rough) = (robot(""), robot("friction_coefficient = 0.5"));
    assert_eq!(at_lengths(&plain, &LENGTHS), at_lengths(&rough, &LENGTHS));
}

/// More cables than degrees of freedom, a load, and cables of which only one has friction.
#[test]
fn one_cable_with_friction_moves_the_platform_of_a_redundant_robot() {
    let text = funicular_robots::COGIRO
        .replace("[[cables]]\n", "[[cables]]\npulley = \"wheel\"\nwinch = \"drum\"\n")
        .replacen(
            "[[cables]]",
            "[pulleys.wheel]\nradius_m = 0.06\nentry_direction = [0, 0, 1]\n[winches.drum]\ndrum_side_length_m = 5.0\n\
             stiffness_n_per_m = 2e6\n[[cables]]",
            1,
        );
    let mut robot = Robot::from_toml(&text).unwrap();
    robot.load = Load { force_w: Vec3::new(30.0, -20.0, 0.0), moment_w: Vec3::new(5.0, 0.0, 8.0), ..robot.load };
    robot = robot.with_tension_limits(TensionLimits { minimum: Some(100.0), maximum: None });
    let friction = PulleyFriction::Bearing { coefficient: 0.3, radius: 0.02 };
    robot.cables[2].anchor.pulley.as_mut().unwrap().friction = Some(friction);

    let pose = Pose::new([1.0, 2.0, 1.5], [0.0, 0.0, 5.0]);
    let rest = statics::distribute_tensions(&robot, &pose, StaticModel::Catenary, &TensionRule::Lowest).unwrap();
    let found = statics::friction_interval(&robot, &rest, Held::Lengths).unwrap();
    let motion = found.motion.unwrap();

    // Motion between the two ends of the only friction.
    let lengths: Vec<f64> = rest.cables.iter().map(|cable| cable.unstrained_length).collect();
    let ends = [1.0, -1.0].map(|used| with_friction(&robot, &lengths, &[0.0, 0.0, used, 0.0, 0.0, 0.0, 0.0, 0.0]).0);
    let solved = ends[0].pose.position_w - ends[1].pose.position_w;
    for (ours, solved) in motion.translation_w.iter().zip(solved.iter()) {
        // Second-order terms, as above.
        assert!((2.0 * ours.half_width() - solved.abs()).abs() < 0.01 * solved.abs(), "{ours:?} {solved}");
    }
    for (i, own) in found.cables.iter().enumerate() {
        let change = (ends[0].cables[i].tension_platform - ends[1].cables[i].tension_platform).abs();
        assert!((2.0 * own.tension_platform.half_width() - change).abs() < 0.01 * change, "cable {i}");
        assert!(i == 2 || own.exponent == 0.0 && own.excess_length.half_width() == 0.0);
    }
}

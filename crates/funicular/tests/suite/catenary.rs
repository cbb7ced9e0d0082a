//! Catenary compared with its own limits, its energy and differences.

use funicular::catenary::space::HangingCable;
use funicular::catenary::{Catenary, CatenaryError, Rope};
use proptest::prelude::*;

fn solve(span: f64, rise: f64, unstrained_length: f64, axial_stiffness: f64, weight_per_length: f64) -> Catenary {
    Catenary::between(span, rise, Rope { unstrained_length, weight_per_length, axial_stiffness }).unwrap()
}

fn assert_close(ours: f64, theirs: f64, relative: f64, what: &str) {
    assert!((ours - theirs).abs() <= relative * theirs.abs(), "{what}: {ours:e} for {theirs:e}");
}

#[test]
fn a_vertical_taut_cable_carries_its_weight() {
    // T_B − T_A = wL, and the stretch is that of the mean tension: no approximation.
    let (length, ea, w) = (10.0, 1e5, 3.0);
    let rise = 10.05;
    let cable = solve(0.0, rise, length, ea, w);
    let mean = ea * (rise / length - 1.0);
    assert_close(cable.tension_at_start(), mean - 15.0, 1e-12, "lower");
    assert_close(cable.tension_at_end(), mean + 15.0, 1e-12, "upper");
    assert_close(cable.tangent()[1][1], ea / length, 1e-12, "axial");
    // Horizontal: 1/∫ds(1/EA + 1/T) = w/(w L/EA + ln(T_B/T_A)).
    let exact = w / (w * length / ea + (cable.tension_at_end() / cable.tension_at_start()).ln());
    assert_close(cable.out_of_plane_stiffness(), exact, 1e-12, "across");
    assert_close(cable.tangent()[0][0], exact, 1e-12, "across in plane");
    for s in [0.0, 3.0, 10.0] {
        let z = s + s * (cable.tension_at_start() + 0.5 * w * s) / ea;
        assert_close(cable.point_at(s)[1], z, 1e-13, "shape");
    }
    // The limit is smooth.
    let beside = solve(1e-9, rise, length, ea, w);
    assert_close(beside.horizontal_force() / 1e-9, exact, 1e-9, "nearly vertical");
}

#[test]
fn a_vertical_loop_hangs_by_both_ends() {
    let cable = solve(0.0, 2.0, 10.0, 1e6, 5.0);
    assert_eq!(cable.horizontal_force().to_bits(), 0.0_f64.to_bits());
    // Inextensible: the lower end carries 4 m, the upper end 6 m; elastic to 1e-4.
    assert_close(-cable.vertical_force_at_start(), 20.0, 1e-4, "lower end");
    assert_close(cable.vertical_force_at_end(), 30.0, 1e-4, "upper end");
    let beside = solve(1e-7, 2.0, 10.0, 1e6, 5.0);
    assert_close(beside.vertical_force_at_end(), cable.vertical_force_at_end(), 1e-6, "nearly a loop");
    assert_close(beside.tangent()[1][1], cable.tangent()[1][1], 1e-5, "stiffness of nearly a loop");
}

#[test]
fn strained_by_a_hundredth_and_almost_weightless_it_is_a_spring() {
    for (span, rise) in [(10.0, 0.0), (6.0, 8.0), (0.01, 10.0), (6.0, -8.0)] {
        let chord = f64::hypot(span, rise);
        let (length, ea) = (chord / 1.01, 1e5);
        let tension = 1e3;
        // Weight over tension 1e-8, and zero.
        for w in [1e-8 * tension / length, 0.0] {
            let cable = solve(span, rise, length, ea, w);
            assert_close(cable.horizontal_force(), tension * span / chord, 3e-13, "H");
            assert_close(cable.tension_at_end(), tension, 1e-8, "T");
            let [[xx, xz], [_, zz]] = cable.tangent();
            let (c, s) = (span / chord, rise / chord);
            let (along, across) = (ea / length, tension / chord);
            assert_close(xx, along * c * c + across * s * s, 1e-9, "xx");
            assert_close(zz, along * s * s + across * c * c, 1e-9, "zz");
            assert!((xz - (along - across) * c * s).abs() < 1e-9 * along, "xz");
        }
    }
}

#[test]
fn slack_at_three_times_the_chord_and_the_far_end_below() {
    for (span, rise) in [(10.0, 0.0), (8.0, 6.0), (8.0, -6.0), (1.0, -9.9)] {
        let cable = solve(span, rise, 30.0, 1e7, 2.0);
        // Inextensible to 3e-6: √(L² − z²)/x = sinh(a)/a with a = wx/2H.
        let a = 2.0 * span / (2.0 * cable.horizontal_force());
        assert_close(a.sinh() / a, (900.0 - rise * rise).sqrt() / span, 1e-4, "slack");
        let [x, z] = cable.point_at(30.0);
        assert!((x - span).abs() < 1e-12 && (z - rise).abs() < 1e-12, "the curve ends at its end: {x} {z}");
    }
}

#[test]
fn input_that_is_no_cable_is_refused_with_its_value() {
    let rope = Rope { unstrained_length: 1.0, weight_per_length: 1.0, axial_stiffness: 1.0 };
    let texts = [
        Catenary::between(-1.0, 0.0, rope),
        Catenary::between(f64::NAN, 0.0, rope),
        Catenary::between(1.0, f64::INFINITY, rope),
        Catenary::between(1.0, 0.0, Rope { unstrained_length: 0.0, ..rope }),
        Catenary::between(1.0, 0.0, Rope { weight_per_length: -0.1, ..rope }),
        Catenary::between(1.0, 0.0, Rope { axial_stiffness: f64::NAN, ..rope }),
    ]
    .map(|r| r.unwrap_err().to_string());
    assert_eq!(texts[0], "span [m] is -1: it must be finite and not negative");
    assert_eq!(texts[3], "unstrained length [m] is 0: it must be finite and positive");
    let refused: Result<Catenary, CatenaryError> = Catenary::between(1.0, 0.0, Rope { axial_stiffness: 0.0, ..rope });
    assert!(refused.is_err());
}

/// Cables over many decades: chord of 1 to 1000 m at any slope, unstrained length from taut to three times the chord.
fn any_cable() -> impl Strategy<Value = [f64; 5]> {
    (0.0f64..3.0, -89.99f64..89.99, -3.0f64..0.48, 3.0f64..9.0, -3.0f64..3.0).prop_map(|(size, slope, slack, ea, w)| {
        let (chord, slope) = (10f64.powf(size), slope.to_radians());
        // The range −3..−0 gives strains of 1e-3..; above, lengths up to 3 times the chord.
        let length =
            if slack < -1.0 { chord / (1.0 + 10f64.powf(slack * 1.5)) } else { chord * 10f64.powf(slack.max(1e-9)) };
        [chord * slope.cos(), chord * slope.sin(), length, 10f64.powf(ea), 10f64.powf(w)]
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 3000, max_global_rejects: 100_000, failure_persistence: None,
        ..Default::default() })]

    #[test]
    fn the_curve_closes_and_energy_gives_the_forces([dx, dz, length, ea, w] in any_cable()) {
        let cable = solve(dx, dz, length, ea, w);
        let [x, z] = cable.point_at(length);
        let chord = f64::hypot(dx, dz);
        // Stretched lengths far beyond the chord (weak, heavy cables) have their own rounding.
        let stretched = length * (1.0 + cable.tension_at_end().max(cable.tension_at_start()) / ea);
        prop_assert!((x - dx).abs() < 1e-11 * (chord + stretched), "x {x} {dx}");
        prop_assert!((z - dz).abs() < 1e-11 * (chord + stretched), "z {z} {dz}");
        // Richardson-extrapolated energy difference along z and x.
        let step = 1e-5 * dx.min(chord);
        let by = |ax: f64, az: f64| {
            let at = |k: f64| solve(dx + k * ax, dz + k * az, length, ea, w).energy();
            (8.0 * (at(step) - at(-step)) - (at(2.0 * step) - at(-2.0 * step))) / (12.0 * step)
        };
        // If a taut cable goes slack within the step, the difference quotient has no meaning.
        prop_assume!((chord / length - 1.0).abs() > 2e-4);
        let force = cable.tension_at_end().max(cable.tension_at_start());
        // Energy is a difference of terms of size force × length, known to rounding.
        let rounding = 1e-14 * force * stretched / step;
        prop_assert!((by(0.0, 1.0) - cable.vertical_force_at_end()).abs() < 1e-6 * force + rounding);
        prop_assert!((by(1.0, 0.0) - cable.horizontal_force()).abs() < 1e-6 * force + rounding);
    }

    #[test]
    fn stiffness_is_symmetric_positive_and_the_derivative_of_the_forces([dx, dz, length, ea, w] in any_cable()) {
        let cable = solve(dx, dz, length, ea, w);
        let [[xx, xz], [zx, zz]] = cable.tangent();
        prop_assert!((xz - zx).abs() <= 1e-12 * (xx + zz));
        prop_assert!(xx > 0.0 && zz > 0.0 && xx * zz - xz * xz > -1e-12 * xx * zz);
        prop_assume!((f64::hypot(dx, dz) / length - 1.0).abs() > 2e-3);
        let step = 1e-5 * dx.min(f64::hypot(dx, dz));
        let at = |x: f64, z: f64| {
            let c = solve(dx + x * step, dz + z * step, length, ea, w);
            [c.horizontal_force(), c.vertical_force_at_end()]
        };
        let (right, left) = (at(1.0, 0.0), at(-1.0, 0.0));
        let (up, down) = (at(0.0, 1.0), at(0.0, -1.0));
        let rounding = 1e-11 * cable.tension_at_end().max(w * length) / step;
        for (exact, a, b) in [(xx, right[0], left[0]), (xz, up[0], down[0]), (zx, right[1], left[1]),
            (zz, up[1], down[1])] {
            let differenced = (a - b) / (2.0 * step);
            prop_assert!((exact - differenced).abs() < 1e-4 * (xx + zz) + rounding, "{exact} {differenced}");
        }
        // Extrapolated (Richardson): if the tension of a steep cable nearly vanishes at its lower end, the forces are
        // curved over a strain of 1e-4.
        let change = 1e-6 * length;
        let with = |k: f64| solve(dx, dz, length + k * change, ea, w);
        let by_length = |f: &dyn Fn(&Catenary) -> f64| {
            (8.0 * (f(&with(1.0)) - f(&with(-1.0))) - (f(&with(2.0)) - f(&with(-2.0)))) / (12.0 * change)
        };
        let [h, v] = cable.start_force_by_length();
        let size = h.hypot(v);
        let force = cable.tension_at_end().max(cable.tension_at_start());
        let bound = 1e-4 * size + 1e-11 * force / change;
        prop_assert!((h - by_length(&Catenary::horizontal_force)).abs() < bound);
        prop_assert!((v - by_length(&Catenary::vertical_force_at_start)).abs() < bound);
        prop_assert!((cable.parallel_tension_by_length() - by_length(&Catenary::parallel_tension)).abs() < bound);
    }
}

#[test]
fn in_space_it_is_the_same_cable_however_gravity_points() {
    use funicular::math::{Rotation, Vec3};
    let rope = Rope { unstrained_length: 7.2, weight_per_length: 2.0, axial_stiffness: 1e5 };
    let turn = Rotation::from_scaled_axis(Vec3::new(0.4, -1.1, 0.7));
    let (a, b) = (Vec3::new(0.3, -0.2, 1.0), Vec3::new(4.0, 3.0, 5.0));
    let upright = HangingCable::new(a, b, Vec3::z(), rope).unwrap();
    let turned = HangingCable::new(turn * a, turn * b, turn * Vec3::z(), rope).unwrap();
    assert!((turn * upright.force_on_start_w() - turned.force_on_start_w()).norm() < 1e-12);
    let rotated = turn.to_rotation_matrix() * upright.tangent_w() * turn.to_rotation_matrix().transpose();
    assert!((rotated - turned.tangent_w()).amax() < 1e-9 * rotated.amax());
    assert!((turn * upright.point_w(3.0) - turned.point_w(3.0)).norm() < 1e-12);
}

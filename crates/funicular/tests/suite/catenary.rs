//! The catenary against published cases, high-precision values and its own limits.

use funicular::catenary::space::HangingCable;
use funicular::catenary::{Catenary, CatenaryError, Rope};
use proptest::prelude::*;

fn solve(span: f64, rise: f64, unstrained_length: f64, axial_stiffness: f64, weight_per_length: f64) -> Catenary {
    Catenary::between(span, rise, Rope { unstrained_length, weight_per_length, axial_stiffness }).unwrap()
}

fn assert_close(ours: f64, theirs: f64, relative: f64, what: &str) {
    assert!((ours - theirs).abs() <= relative * theirs.abs(), "{what}: {ours:e} for {theirs:e}");
}

/// Nine cables computed with mpmath, 40 digits: (dx, dz, L0, EA, w), H, V at the end, K = [xx, xz, zz] of the end.
#[rustfmt::skip]
const GRID: [([f64; 5], f64, f64, [f64; 3]); 9] = [
    ([100.0, 0.0, 105.0, 1e7, 10.0], 918.634_473_646_241_4, 525.0, [103.949_767_446_749_71, 0.0, 10.075_800_823_491_979]),
    ([100.0, 0.0, 100.0, 1e7, 10.0], 7_463.990_429_563_481, 500.0, [33_378.119_186_577_87, 0.0, 74.751_268_256_080_88]),
    ([100.0, 0.0, 99.9, 1e7, 10.0], 12_619.388_595_989_494, 499.5, [70_829.243_321_758_75, 0.0, 126.259_665_566_132_21]),
    ([100.0, 50.0, 120.0, 5e6, 20.0], 1_368.650_085_844_660_5, 2_001.854_851_450_725_8, [93.141_539_923_641_49, 33.353_383_596_312_41, 30.038_074_316_433_247]),
    ([5.54, 4.025, 6.9, 251_327.412_287_183_46, 0.657_27], 6.889_647_568_860_437, 7.389_111_813_247_903, [54.801_295_675_270_435, 38.018_247_435_906_026, 28.259_917_392_548_393]),
    ([10.0, -8.0, 15.0, 2e5, 3.0], 12.254_619_883_417_32, 8.229_879_788_737_504, [3.914_038_949_530_472, -1.335_439_407_097_129, 2.447_089_318_690_452]),
    ([1.0, 30.0, 33.0, 1e6, 50.0], 5.091_541_761_391_54, 1_574.463_277_939_209_4, [6.393_512_310_869_302, 0.204_714_724_953_319_6, 25.014_297_487_814_43]),
    ([0.001, 10.0, 12.0, 1e6, 5.0], 0.000_208_750_833_144_050_99, 54.999_250_024_479_705, [0.227_769_677_085_133_33, 4.321_615_911_119_703e-6, 2.499_925_003_429_963]),
    ([1000.0, 300.0, 1050.0, 1e8, 700.0], 1_044_436.191_372_133_8, 692_091.287_865_038_5, [22_460.576_563_214_81, 6_189.732_692_785_734, 2_870.939_006_216_141]),
];

#[test]
fn end_forces_and_stiffness_agree_with_forty_digit_values() {
    for ([dx, dz, length, ea, w], h, v, [xx, xz, zz]) in GRID {
        let cable = solve(dx, dz, length, ea, w);
        let what = format!("dx {dx}, dz {dz}, L0 {length}");
        assert_close(cable.horizontal_force(), h, 1e-12, &what);
        assert_close(cable.vertical_force_at_end(), v, 1e-12, &what);
        let [[k_xx, k_xz], [k_zx, k_zz]] = cable.tangent();
        assert_close(k_xx, xx, 1e-11, &what);
        assert_close(k_zz, zz, 1e-11, &what);
        assert!((k_xz - xz).abs() <= 1e-11 * xx.max(zz) && (k_zx - k_xz).abs() <= 1e-15 * xx, "{what}");
    }
}

/// MoorPy's own test rows, recomputed with mpmath (its row 8 is wrong by 3.6 % and not used): (dx, dz, L0, EA, w), H,
/// V at start, V at end.
#[rustfmt::skip]
const MOORPY: [([f64; 5], f64, f64, f64); 5] = [
    ([400.0, 200.0, 500.0, 7.51e12, 200.0], 43_694.604_622_068_7, -22_365.589_454_192, 77_634.410_545_808),
    ([89.9, 59.2, 130.0, 7.51e8, 881.05], 31_373.234_876_305_675, -26_650.338_700_035_084, 87_886.161_299_964_92),
    ([246.224_209_400_329_47, 263.557_663_308_431_64, 360.625_662_623_969_27, 7e8, 3.087_35], 71_116.817_198_612_98, 75_567.265_824_623_5, 76_680.643_464_125_61),
    ([246.224_209_400_329_47, 263.557_663_308_431_64, 360.645_662_623_969_27, 7e8, 3.087_35], 46_077.271_172_417_89, 48_765.373_042_054_225, 49_878.812_428_556_34),
    ([119.323_738_300_205_8, 52.496_688_491_781_13, 130.361_403_551_773_18, 7e8, 34.910_604_699_912_27], 72_694.649_894_215_43, 29_715.389_528_137_67, 34_266.384_955_659_36),
];

#[test]
fn the_rows_of_moorpys_tests_agree() {
    for ([dx, dz, length, ea, w], h, start, end) in MOORPY {
        let cable = solve(dx, dz, length, ea, w);
        // The taut rows have strains of 1e-4: the twelfth digit of the force is the sixteenth of the length.
        assert_close(cable.horizontal_force(), h, 2e-11, "H");
        assert_close(cable.vertical_force_at_start(), start, 2e-11, "V start");
        assert_close(cable.vertical_force_at_end(), end, 2e-11, "V end");
    }
}

#[test]
fn sags_of_code_aster_and_the_hanging_line_of_frydom_agree() {
    // SSNL114 (V6.02.114): 325 m, own weight; sag 6.352 m stated to 1e-3, 6.35216146971447 m with mpmath.
    let ea = 57e9 * 2.2783e-4;
    let w = 2844.23 * 2.2783e-4 * 9.81;
    let cable = solve(325.0, 0.0, 325.0, ea, w);
    assert_close(cable.horizontal_force(), 13_206.239_149_360_694, 1e-11, "SSNL114 H");
    assert_close(-cable.point_at(162.5)[1], 6.352_161_469_714_472, 1e-11, "SSNL114 sag");
    // SSNL100: 13.93 m published; 13.9391933516305289 m with mpmath.
    let cable = solve(100.0, 0.0, 105.0, 5e7, 30.0);
    assert_close(-cable.point_at(52.5)[1], 13.939_193_351_630_53, 1e-12, "SSNL100 sag");
    // FRyDoM's bench_hanging_cable, in water: H 11.47, tensions 47.14 and 26.63 kN as OrcaFlex's catenary prints.
    let cable = solve(100.0, 50.0, 170.0, 5e8, 410.280_831_825_621_94);
    assert_close(cable.horizontal_force() / 1e3, 11.471_869_498_836_605, 1e-12, "H");
    assert_close(cable.tension_at_end() / 1e3, 47.137_846_595_090_5, 1e-12, "top");
    assert_close(cable.tension_at_start() / 1e3, 26.625_318_072_828_543, 1e-12, "bottom");
    // FRyDoM's bench_cables, strained by 18 %.
    let cable = solve(20.0, 20.0, 24.041_630_560_342_616, 636_620_000.0 * 0.007_854, 616.538 * 9.81);
    assert_close(cable.horizontal_force(), 625_312.577_046_026_5, 1e-12, "strained");
}

/// Michalos and Birnstiel's isolated cable: a load at a node between two cables; (A, E, w, span, lengths, load, g).
#[test]
fn the_isolated_cable_of_michalos_and_birnstiel_moves_as_published() {
    const FOOT: f64 = 0.3048;
    let (ea, w) = (0.85 * 19_000.0, 0.003_16);
    let (left, right) = (412.883_7, 613.042_2);
    // kip and feet throughout: the node at (x, z) is in balance with a load p downward.
    let balance = |x: f64, z: f64, p: f64| {
        let a = solve(x, -z.abs(), left, ea, w);
        let b = solve(1000.0 - x, z.abs(), right, ea, w);
        let down = a.vertical_force_at_end() - b.vertical_force_at_start() + p;
        (b.horizontal_force() - a.horizontal_force(), -down)
    };
    let rest = |p: f64, mut x: f64, mut z: f64| {
        for _ in 0..60 {
            let (fx, fz) = balance(x, z, p);
            let h = 1e-6;
            let (gx, gz) = balance(x + h, z, p);
            let (kx, kz) = balance(x, z + h, p);
            let (a, b, c, d) = ((gx - fx) / h, (kx - fx) / h, (gz - fz) / h, (kz - fz) / h);
            let det = a * d - b * c;
            x -= ((d * fx - b * fz) / det).clamp(-20.0, 20.0);
            z -= ((a * fz - c * fx) / det).clamp(-20.0, 20.0);
        }
        (x, z)
    };
    let (x0, z0) = rest(0.0, 400.0, -96.0);
    assert_close(-z0, 96.049_477_954_474_44, 1e-9, "sag");
    assert_close(x0, 399.999_900_794_963_63, 1e-9, "node");
    let (x1, z1) = rest(8.0, 398.0, -114.0);
    assert_close((z1 - z0) * FOOT, -5.625_616_451_571_743, 1e-7, "vertical, published -5.626");
    assert_close((x1 - x0) * FOOT, -0.859_365_123_311_387_8, 1e-6, "horizontal, published -0.859");
}

#[test]
fn a_vertical_taut_cable_carries_its_weight() {
    // T_B − T_A = wL, and the stretch is the mean tension's: no approximation.
    let (length, ea, w) = (10.0, 1e5, 3.0);
    let rise = 10.05;
    let cable = solve(0.0, rise, length, ea, w);
    let mean = ea * (rise / length - 1.0);
    assert_close(cable.tension_at_start(), mean - 15.0, 1e-12, "lower");
    assert_close(cable.tension_at_end(), mean + 15.0, 1e-12, "upper");
    assert_close(cable.tangent()[1][1], ea / length, 1e-12, "axial");
    // Across: 1/∫ds(1/EA + 1/T) = w/(w L/EA + ln(T_B/T_A)).
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
    // Inextensible: the lower end carries 4 m, the upper 6 m; elastic to 1e-4.
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
        // Weight over tension 1e-8, and none at all.
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
        // −3..−0 gives strains of 1e-3..; above, lengths up to 3 times the chord.
        let length =
            if slack < -1.0 { chord / (1.0 + 10f64.powf(slack * 1.5)) } else { chord * 10f64.powf(slack.max(1e-9)) };
        [chord * slope.cos(), chord * slope.sin(), length, 10f64.powf(ea), 10f64.powf(w)]
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 3000, max_global_rejects: 100_000, failure_persistence: None, ..Default::default() })]

    #[test]
    fn the_curve_closes_and_energy_gives_the_forces([dx, dz, length, ea, w] in any_cable()) {
        let cable = solve(dx, dz, length, ea, w);
        let [x, z] = cable.point_at(length);
        let chord = f64::hypot(dx, dz);
        // Stretched lengths far beyond the chord (weak, heavy cables) carry their own rounding.
        let stretched = length * (1.0 + cable.tension_at_end().max(cable.tension_at_start()) / ea);
        prop_assert!((x - dx).abs() < 1e-11 * (chord + stretched), "x {x} {dx}");
        prop_assert!((z - dz).abs() < 1e-11 * (chord + stretched), "z {z} {dz}");
        // Richardson-extrapolated energy difference along z and x.
        let step = 1e-5 * dx.min(chord);
        let by = |ax: f64, az: f64| {
            let at = |k: f64| solve(dx + k * ax, dz + k * az, length, ea, w).energy();
            (8.0 * (at(step) - at(-step)) - (at(2.0 * step) - at(-2.0 * step))) / (12.0 * step)
        };
        // Where a taut cable goes slack within the step the difference quotient says nothing.
        prop_assume!((chord / length - 1.0).abs() > 2e-4);
        let force = cable.tension_at_end().max(cable.tension_at_start());
        // Energy is the difference of terms of size force × length, known to rounding.
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
            let c = solve(x, z, length, ea, w);
            [c.horizontal_force(), c.vertical_force_at_end()]
        };
        let (right, left) = (at(dx + step, dz), at(dx - step, dz));
        let (up, down) = (at(dx, dz + step), at(dx, dz - step));
        let rounding = 1e-11 * cable.tension_at_end().max(w * length) / step;
        for (exact, a, b) in [(xx, right[0], left[0]), (xz, up[0], down[0]), (zx, right[1], left[1]), (zz, up[1], down[1])] {
            let differenced = (a - b) / (2.0 * step);
            prop_assert!((exact - differenced).abs() < 1e-4 * (xx + zz) + rounding, "{exact} {differenced}");
        }
        let change = 1e-6 * length;
        let longer = solve(dx, dz, length + change, ea, w);
        let shorter = solve(dx, dz, length - change, ea, w);
        let [h, v] = cable.start_force_by_length();
        let differenced = [
            (longer.horizontal_force() - shorter.horizontal_force()) / (2.0 * change),
            (longer.vertical_force_at_start() - shorter.vertical_force_at_start()) / (2.0 * change),
        ];
        let size = h.hypot(v);
        prop_assert!((h - differenced[0]).abs() < 1e-4 * size && (v - differenced[1]).abs() < 1e-4 * size);
        let tension = (longer.parallel_tension() - shorter.parallel_tension()) / (2.0 * change);
        prop_assert!((cable.parallel_tension_by_length() - tension).abs() < 1e-4 * size);
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

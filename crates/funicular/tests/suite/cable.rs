//! Cable models against published and independently computed stiffness and frequencies.

use funicular::cable::closed_form::ClosedForm;
use funicular::cable::{LocalAxes, Sag};
use funicular::math::{Complex, Vec3};
use funicular::robot::Damping;
use std::f64::consts::{PI, TAU};

/// In-plane symmetric roots Ω of tan(Ω/2) = Ω/2 − (4/λ²)(Ω/2)³ (Irvine and Caughey 1974), computed with mpmath to 40
/// digits: (λ², first four roots).
#[rustfmt::skip]
const IRVINE_CAUGHEY: [(f64, [f64; 4]); 23] = [
    (0.01, [3.142882432937363, 9.424825745473143, 15.70797358883793, 21.991152336316283]),
    (0.1, [3.154465166857235, 9.42525622691198, 15.708066512667022, 21.991186193833098]),
    (0.5, [3.2054043124827283, 9.427178643975342, 15.708480289172623, 21.991336820514768]),
    (1.0, [3.267886207620111, 9.429602888986565, 15.708999311145325, 21.991525446236338]),
    (2.0, [3.389149487602121, 9.4345232845882, 15.710043402075843, 21.991903843213002]),
    (5.0, [3.7274959069082283, 9.449882471864088, 15.713224870514042, 21.993048280701416]),
    (7.1293967, [3.948428331448642, 9.461358272280588, 15.715528892405304, 21.993869120830677]),
    (7.57, [3.9924363037077586, 9.463795191242065, 15.716010478707021, 21.9940398577556]),
    (10.0, [4.225833283147767, 9.477636678493196, 15.718696958294755, 21.994987057255173]),
    (20.0, [5.0565078174761355, 9.54261589280694, 15.730322741924054, 21.99898663978031]),
    (30.0, [5.737915699866339, 9.623295680644604, 15.74295070946497, 22.00315744891843]),
    (39.47841760435743, [6.283185307179586, 9.718272546111002, 15.755960858324457, 22.00727872050917]),
    (50.0, [6.793919661528915, 9.850045750779808, 15.771745584474148, 22.012057566795455]),
    (64.0, [7.337759850841772, 10.07716238383193, 15.795283261265189, 22.01877445976094]),
    (100.0, [8.159295885441594, 10.931721654181933, 15.873408309379286, 22.038200139442086]),
    (157.91367041742973, [8.6000652381808, 12.566370614359172, 16.091716763622014, 22.077917893855634]),
    (200.0, [8.716003678780412, 13.562954616859928, 16.39094148043202, 22.116098237880326]),
    (355.3057584392169, [8.860744631268444, 15.00954850703494, 18.84955592153876, 22.415537083362615]),
    (500.0, [8.90301792010551, 15.227564742828049, 20.768243459401386, 23.427494059535817]),
    (1000.0, [8.948084122029504, 15.370464294246725, 21.646867600009497, 27.67542797475574]),
    (10000.0, [8.983197867548709, 15.444177663465018, 21.79909255737648, 28.120179401122748]),
    (1000000.0, [8.986782965926674, 15.450441857598724, 21.808156045075737, 28.132275207884188]),
    (f64::INFINITY, [8.986818915818128, 15.450503673875414, 21.808243318857798, 28.132387825662946]),
];

/// Real and imaginary part.
type Pair = (f64, f64);

/// The paper's Fig. 2 cable with 0.067 kg/m, closed form, mpmath: (frequency [Hz], ξ, k_a, coupling, k_c, k_o [N/m]) in
/// axes whose chord runs from the fixed to the moving end, so that the coupling has the opposite sign of ours.
#[rustfmt::skip]
const FIG2_CLOSED_FORM: [(f64, f64, [Pair; 4]); 24] = [
    (0.5, 0.0, [(22663.910702215, 0.0), (-18.445369190057, 0.0), (9.7955364669935, 0.0), (9.7805244221162, 0.0)]),
    (1.5, 0.0, [(19008.880981916, 0.0), (-209.26911431155, 0.0), (-4.9528576373572, 0.0), (-7.2567050993096, 0.0)]),
    (2.9, 0.0, [(-60419.879933241, 0.0), (-4296.1452717473, 0.0), (-233.72614153056, 0.0), (71.750536283932, 0.0)]),
    (4.0, 0.0, [(56998.486762065, 0.0), (1709.3290867299, 0.0), (30.67874106956, 0.0), (-20.582372912952, 0.0)]),
    (6.0, 0.0, [(40720.808203724, 0.0), (763.39877832094, 0.0), (37.933605054728, 0.0), (23.622059669226, 0.0)]),
    (8.0, 0.0, [(41134.627985846, 0.0), (1496.4729946023, 0.0), (193.41795551164, 0.0), (138.97644155545, 0.0)]),
    (12.0, 0.0, [(37290.611238725, 0.0), (455.21561046606, 0.0), (-283.63127926196, 0.0), (-289.1882075377, 0.0)]),
    (18.0, 0.0, [(37315.359326326, 0.0), (1066.4152314206, 0.0), (298.42683464773, 0.0), (267.95033740002, 0.0)]),
    (0.5, 0.003, [(22663.911042949, 2.165931246607), (-18.44535165137, 0.11352064347091), (9.7955374789237, 0.0093820982151766), (9.7805260492269, 0.0095683136522943)]),
    (1.5, 0.003, [(19008.937040074, 31.229000421166), (-209.26623305784, 1.6252359562257), (-4.9526985081989, 0.11840654820834), (-7.2562717766003, 0.15797489975596)]),
    (2.9, 0.003, [(-60283.610951399, 3627.8073454357), (-4289.153736081, 186.23560257145), (-233.36706043654, 9.745352172348), (71.719035005554, 1.6039572668269)]),
    (4.0, 0.003, [(56993.579807539, 320.5147075838), (1709.0779441389, 16.72321309597), (30.673931497346, 1.7579930249062), (-20.575645241861, 1.0432404799684)]),
    (6.0, 0.003, [(40720.572630784, 50.023212406765), (763.41100559553, 4.8930401793053), (37.923872344234, 2.1985483035258), (23.612169880032, 2.0326644841507)]),
    (8.0, 0.003, [(41129.605617288, 119.36134889599), (1495.0232374878, 31.216376694345), (192.99965450121, 10.271701955912), (138.67450252544, 8.1599848029248)]),
    (12.0, 0.003, [(37294.137070483, 51.838911259059), (458.12204180459, 36.520736801915), (-281.27355573249, 31.527489335512), (-286.86661047111, 30.638020540649)]),
    (18.0, 0.003, [(37314.267637854, 15.278299331802), (1064.7108211108, 19.652677070139), (295.80062033691, 36.6801699498), (265.43047182263, 35.571081274588)]),
    (0.5, 0.05, [(22664.005349915, 36.098606154332), (-18.440497365796, 1.8919979960531), (9.7958175569686, 0.15636762365283), (9.7809763898201, 0.15947009881054)]),
    (1.5, 0.05, [(19024.438757741, 520.01863398641), (-208.46948101259, 27.063417916782), (-4.9086920334257, 1.9721918338723), (-7.1367205504256, 2.6262142667763)]),
    (2.9, 0.05, [(-33188.748505848, 43499.280211544), (-2898.9930612482, 2233.5600866541), (-161.94045210674, 117.76252706158), (64.093722613134, 23.820253760482)]),
    (4.0, 0.05, [(55719.098287065, 5015.2737282914), (1643.8589770428, 261.95503307022), (29.491846236761, 28.051497125506), (-18.77495669102, 16.939274283604)]),
    (6.0, 0.05, [(40656.220899328, 816.43583246258), (766.62881771883, 79.496097991073), (35.620263736833, 34.738241351752), (21.265450646298, 32.028490838302)]),
    (8.0, 0.05, [(40269.8101246, 1323.381155214), (1249.8709770323, 325.00752596058), (123.14446544912, 113.26094997651), (86.351484080577, 94.295282954986)]),
    (12.0, 0.05, [(37623.073765962, 389.58863995289), (736.56788840672, 224.40834805455), (-55.86413582659, 211.43101669525), (-69.03539416251, 202.78067101808)]),
    (18.0, 0.05, [(37218.422365479, 117.74587925467), (921.26631590367, 110.56374627089), (87.484846587705, 254.6222387858), (64.992130878198, 249.2198366142)]),
];

/// The same cable by finite elements of the exact catenary (MoorPy 1.3.0 line matrices condensed at the ends, lumped
/// mass, 200 and 400 segments, Richardson extrapolated), undamped: (frequency [Hz], moving end is the upper one,
/// [k_xx, k_xz, k_zz, k_yy] [N/m]); x horizontal from the lower to the upper end, z up.
#[rustfmt::skip]
const FIG2_FINITE_ELEMENTS: [(f64, bool, [f64; 4]); 36] = [
    (0.0, true, [15055.211, 10929.88, 7948.002, 11.513]),
    (0.0, false, [15054.889, 10929.926, 7947.794, 11.1268]),
    (0.5, true, [14840.666, 10756.761, 7807.187, 9.9481]),
    (0.5, false, [14805.227, 10768.221, 7842.132, 9.5884]),
    (1.0, true, [14124.033, 10178.463, 7337.026, 4.6543]),
    (1.0, false, [13971.475, 10227.988, 7489.207, 4.3841]),
    (1.5, true, [12613.37, 8959.26, 6346.727, -7.2495]),
    (1.5, false, [12214.662, 9088.776, 6745.285, -7.3184]),
    (2.0, true, [9401.417, 6366.538, 4243.494, -41.1246]),
    (2.0, false, [8481.508, 6665.398, 5163.677, -40.6206]),
    (2.4, true, [3341.353, 1473.823, 279.544, -328.4741]),
    (2.4, false, [1442.066, 2090.832, 2179.795, -323.1108]),
    (2.8, true, [-18177.227, -15903.134, -13783.344, 95.4839]),
    (2.8, false, [-23542.314, -14160.499, -8415.209, 93.6778]),
    (3.0, true, [-81884.929, -67354.864, -55401.342, 56.62]),
    (3.0, false, [-97495.395, -62285.097, -39782.196, 55.4711]),
    (3.3, true, [92317.473, 73343.071, 58380.817, 28.4886]),
    (3.3, false, [104705.064, 69321.14, 45987.196, 27.8155]),
    (3.6, true, [47612.477, 37242.604, 29171.326, 8.3667]),
    (3.6, false, [52805.896, 35557.188, 23976.119, 8.0338]),
    (4.0, true, [35617.883, 27568.982, 21323.579, -20.8805]),
    (4.0, false, [38871.867, 26514.123, 18069.698, -20.7187]),
    (4.5, true, [30425.671, 23432.944, 17914.064, -96.9957]),
    (4.5, false, [32834.164, 22655.458, 15509.025, -95.5465]),
    (4.9, true, [27875.441, 22119.974, 16294.119, -842.7549]),
    (4.9, false, [30020.164, 21461.441, 14185.25, -828.6923]),
    (5.5, true, [26807.827, 20251.667, 15443.575, 99.262]),
    (5.5, false, [28487.874, 19700.499, 13758.086, 97.3918]),
    (6.0, true, [25827.417, 19480.085, 14723.208, 23.4157]),
    (6.0, false, [27266.404, 19009.513, 13281.61, 22.8284]),
    (7.0, true, [24116.502, 17826.535, 12923.845, -158.146]),
    (7.0, false, [24493.313, 17702.357, 12549.342, -155.6624]),
    (8.0, true, [25301.805, 19711.487, 15587.264, 138.1851]),
    (8.0, false, [28111.299, 18796.918, 12772.142, 135.6565]),
    (9.5, true, [23979.267, 18520.002, 13953.314, -225.1246]),
    (9.5, false, [25787.972, 17931.781, 12147.86, -221.5081]),
];

fn fig2(upper_end_moves: bool, damping: Damping) -> ClosedForm {
    let (sin, cos) = 36f64.to_radians().sin_cos();
    let sag = Sag::new(6.848, cos, 77.6, 20e9 * 1.2566e-5, 0.067, 9.81);
    let (lower, upper) = (Vec3::zeros(), Vec3::new(cos, 0.0, sin) * 6.848);
    let axes = if upper_end_moves {
        LocalAxes::of_chord(&upper, &lower, &Vec3::z())
    } else {
        LocalAxes::of_chord(&lower, &upper, &Vec3::z())
    };
    ClosedForm::new(sag, axes, damping, false)
}

#[test]
fn lambda_squared_of_fig_2_follows_from_table_ii_not_from_the_printed_value() {
    let sag = fig2(true, Damping::Ratio(0.0)).sag;
    assert!((sag.lambda2 - 7.129_396_682_090_6).abs() < 1e-12 && (sag.epsilon - 0.046_924_913_969_923).abs() < 1e-15);
    let heavier = Sag::new(6.848, 36f64.to_radians().cos(), 77.6, 20e9 * 1.2566e-5, 0.069_039_882_946_126_53, 9.81);
    assert!((heavier.lambda2 - 7.57).abs() < 1e-12);
}

#[test]
fn the_closed_form_agrees_with_high_precision_values_damped_and_undamped() {
    for (frequency, xi, expected) in FIG2_CLOSED_FORM {
        let k = fig2(true, Damping::Ratio(xi)).damped(frequency * TAU);
        for (ours, (re, im)) in [k.axial, -k.coupling, k.normal, k.out_of_plane].into_iter().zip(expected) {
            // The table prints fourteen digits, of the larger of both parts.
            let gap = (ours - Complex::new(re, im)).norm();
            assert!(gap < 2e-11 * re.hypot(im), "{frequency} Hz, ξ {xi}: {ours} for {re} + {im}i");
        }
    }
}

#[test]
fn both_ends_have_the_sign_that_finite_elements_show() {
    for (frequency, upper, [xx, xz, zz, yy]) in FIG2_FINITE_ELEMENTS {
        let cable = fig2(upper, Damping::Ratio(0.0));
        let k = cable.undamped(frequency * TAU).in_world(&cable.axes);
        // What the small-sag theory leaves out at d/l = 0.006: axial inertia, growing with ω² to 1.5 % at 10 Hz, the
        // static coupling of an inclined cable, and the shift of the symmetric pole at 3.12 Hz. A wrong sign of the
        // coupling is off by 29 % at 2.8 Hz.
        let near_pole = 0.012 / (frequency / 3.123 - 1.0).abs();
        let bound = 0.015 + near_pole.min(0.1);
        let size = xx.abs().max(zz.abs());
        for (ours, theirs) in [(k[(0, 0)], xx), (k[(0, 2)], xz), (k[(2, 2)], zz)] {
            assert!((ours - theirs).abs() < bound * size, "{frequency} Hz, upper {upper}: {ours} for {theirs}");
        }
        // Out of plane the tension varies along the cable by 17 % of its mean, the string has the mean: poles at
        // multiples of 2.485 Hz are off by 0.1 %.
        let distance = (frequency / 2.485 / (frequency / 2.485).round().max(1.0) - 1.0).abs();
        let bound = (0.03 + 0.001 / distance) * yy.abs() + 0.7;
        assert!((k[(1, 1)] - yy).abs() < bound, "{frequency} Hz: {} for {yy}", k[(1, 1)]);
    }
}

#[test]
fn clamped_frequencies_are_the_roots_of_irvine_and_caughey_beside_those_of_the_string() {
    for (lambda2, roots) in IRVINE_CAUGHEY.into_iter().filter(|(l, _)| l.is_finite()) {
        let mut cable = fig2(true, Damping::Ratio(0.0));
        cable.sag.lambda2 = lambda2;
        cable.in_plane_only = true;
        // Ω = 1 at this ω.
        let unit = 0.5 / cable.gamma_by_square.sqrt();
        let mut expected: Vec<f64> = roots.into_iter().chain((1..=4).map(|k| f64::from(2 * k) * PI)).collect();
        expected.sort_by(f64::total_cmp);
        let last = roots[3].min(8.0 * PI);
        expected.retain(|root| *root <= last);
        let found = cable.clamped_frequencies_below(unit * last * (1.0 + 1e-9));
        assert_eq!(found.len(), expected.len(), "λ² {lambda2}");
        for (ours, root) in found.iter().zip(expected) {
            assert!((ours / unit / root - 1.0).abs() < 1e-13, "λ² {lambda2}: {} for {root}", ours / unit);
        }
    }
}

/// Vertical cable, upper end fixed, tension T0 at the lower end, 10 m, 0.25 kg/m, transverse, exact (Bessel functions,
/// mpmath): (T0 [N], first clamped ω [rad/s], static stiffness m g/ln(1 + m g L/T0) [N/m], stiffness at 1 rad/s).
const BESSEL: [(f64, [f64; 3], f64, f64); 3] = [
    (
        5.0,
        [2.386_591_301_685_105, 4.806_656_760_419_61, 7.220_159_114_017_31],
        1.381_068_115_819_219,
        0.808_796_452_789_297_4,
    ),
    (
        50.0,
        [4.931_029_185_827_509, 9.865_776_137_343_04, 14.799_702_220_925_198],
        6.144_897_292_481_234,
        5.372_223_393_380_8,
    ),
    (
        500.0,
        [14.219_747_456_968_139, 28.439_649_763_806_173, 42.659_517_662_754_11],
        51.216_463_878_595_067,
        50.390_398_443_631_07,
    ),
];

#[test]
fn a_vertical_cable_is_exact_at_rest_and_near_its_bessel_frequencies_where_it_is_light() {
    for (lower_tension, frequencies, still, at_one) in BESSEL {
        let weight = 0.25 * 9.81 * 10.0;
        // Inextensible: τ from the catenary's limit, l·(H/x) = w l/ln(T_B/T_A).
        let tension = weight / f64::ln(1.0 + weight / lower_tension);
        let sag = Sag::new(10.0, 0.0, tension, 1e9, 0.25, 9.81);
        let axes = LocalAxes::of_chord(&Vec3::zeros(), &(Vec3::z() * 10.0), &Vec3::z());
        let cable = ClosedForm::new(sag, axes, Damping::Ratio(0.0), false);
        assert!((cable.undamped(0.0).out_of_plane / still - 1.0).abs() < 1e-12, "at rest it is exact");
        // The string has one tension; the error is of second order in the variation of tension along the cable.
        let variation = (weight / tension).powi(2);
        let found = cable.clamped_frequencies_below(frequencies[2] * 1.2);
        for (k, exact) in frequencies.iter().enumerate() {
            let ours = found[2 * k];
            assert!((ours / exact - 1.0).abs() < 0.012 * variation, "T0 {lower_tension}: {ours} for {exact}");
        }
        let moving = cable.undamped(1.0).out_of_plane;
        assert!((moving - at_one).abs() < 0.1 * variation * still, "T0 {lower_tension}: {moving} for {at_one}");
    }
}

#[test]
fn damping_makes_every_cable_passive() {
    for damping in [Damping::Ratio(0.003), Damping::Ratio(0.2), Damping::Viscous(0.05)] {
        for i in 1..500 {
            let k = fig2(true, damping).damped(0.3 * f64::from(i));
            let determinant = k.axial.im * k.normal.im - k.coupling.im * k.coupling.im;
            assert!(k.axial.im > 0.0 && k.normal.im > 0.0 && k.out_of_plane.im > 0.0, "{damping:?} {i}");
            assert!(determinant > -1e-12 * k.axial.im * k.normal.im, "{damping:?} {i}");
        }
    }
}

//! The C functions as a C program calls them: results of the core, every wrong use with its status, nothing reserved in
//! the loop, the same digits in every thread, and a long run of random poses.
#![allow(missing_docs)]
#![allow(clippy::undocumented_unsafe_blocks, reason = "every call here is one that a C program could make")]

mod counting;

use counting::reserved;
use funicular::control_loop::LoopModel;
use funicular::robot::{Pose, Robot};
use funicular::statics::{StaticModel, tension_centre};
use funicular_c::est_layout::{EstFault, EstReadings, EstResult, EstSettings};
use funicular_c::layout::{ForwardResult, InverseResult, PoseInput, WrenchResult};
use funicular_c::status::{self, *};
use funicular_c::{
    Loop, Model, fn_forward, fn_forward_cold, fn_inverse, fn_loop_bytes, fn_loop_end, fn_loop_init, fn_model_cables,
    fn_model_free, fn_model_from_toml, fn_reset, fn_status_text, fn_warm_up, fn_wrench,
};
use std::ffi::c_void;
use std::mem::{offset_of, size_of};
use std::ptr::{null, null_mut};
use std::time::Instant;

/// Size of a struct as its member has it.
fn size<T>() -> u32 {
    u32::try_from(size_of::<T>()).unwrap()
}

/// Model of a robot file, and a loop in memory of this test.
struct TestSession {
    model: *mut Model,
    handle: *mut Loop,
    cables: usize,
    memory: Vec<u64>,
}

// Both handles may go to other threads; one at a time uses the loop.
unsafe impl Send for TestSession {}

fn model_of(toml: &str) -> (i32, *mut Model, String) {
    let (mut model, mut message) = (null_mut(), [0_u8; 4000]);
    let text = message.as_mut_ptr().cast();
    let status = unsafe { fn_model_from_toml(toml.as_ptr().cast(), toml.len(), &raw mut model, text, 4000) };
    let end = message.iter().position(|byte| *byte == 0).unwrap();
    (status, model, String::from_utf8(message[..end].to_vec()).unwrap())
}

fn loop_of(model: *mut Model) -> (Vec<u64>, *mut Loop) {
    let (mut bytes, mut alignment, mut handle) = (0, 0, null_mut());
    unsafe {
        assert_eq!(fn_loop_bytes(model, &raw mut bytes, &raw mut alignment), CERTIFIED);
        assert!(alignment <= 8 && bytes < 32_768, "{bytes} {alignment}");
        let mut memory = vec![0_u64; bytes.div_ceil(8)];
        let place = memory.as_mut_ptr().cast::<c_void>();
        assert_eq!(fn_loop_init(model, place, bytes, &raw mut handle), CERTIFIED);
        (memory, handle)
    }
}

impl TestSession {
    fn new(toml: &str) -> Self {
        let (status, model, message) = model_of(toml);
        assert_eq!(status, CERTIFIED, "{message}");
        let mut cables = 0;
        assert_eq!(unsafe { fn_model_cables(model, &raw mut cables) }, CERTIFIED);
        let (memory, handle) = loop_of(model);
        Self { model, handle, cables: cables as usize, memory }
    }

    fn inverse(&self, input: &PoseInput, rows: &mut Rows) -> i32 {
        let mut result = rows.result(self.cables);
        let status = unsafe { fn_inverse(self.handle, input, &raw mut result) };
        rows.summary = result;
        status
    }
}

impl Drop for TestSession {
    fn drop(&mut self) {
        assert!(!self.memory.is_empty());
        unsafe {
            assert_eq!(fn_loop_end(self.handle), CERTIFIED);
            assert_eq!(fn_model_free(self.model), CERTIFIED);
        }
    }
}

/// Arrays of results.
#[derive(Clone, PartialEq, Debug)]
struct Numbers {
    length: [f64; 16],
    rate: [f64; 16],
    acceleration: [f64; 16],
    platform: [f64; 16],
    drum: [f64; 16],
}

struct Rows {
    numbers: Numbers,
    summary: InverseResult,
}

const UNTOUCHED: f64 = -77.25;

impl Rows {
    fn new() -> Self {
        let row = [UNTOUCHED; 16];
        let numbers = Numbers { length: row, rate: row, acceleration: row, platform: row, drum: row };
        Self { numbers, summary: InverseResult::default() }
    }

    fn result(&mut self, cables: usize) -> InverseResult {
        InverseResult {
            struct_size: size::<InverseResult>(),
            cables: u32::try_from(cables).unwrap(),
            length_m: self.numbers.length.as_mut_ptr(),
            length_rate_m_s: self.numbers.rate.as_mut_ptr(),
            length_acceleration_m_s2: self.numbers.acceleration.as_mut_ptr(),
            tension_platform_n: self.numbers.platform.as_mut_ptr(),
            tension_drum_n: self.numbers.drum.as_mut_ptr(),
            ..InverseResult::default()
        }
    }
}

fn at(position_m: [f64; 3]) -> PoseInput {
    PoseInput {
        struct_size: size::<PoseInput>(),
        position_m,
        quaternion_wxyz: [1.0, 0.0, 0.0, 0.0],
        ..PoseInput::default()
    }
}

/// Numbers from zero to one that repeat with their seed.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }

    /// Pose in the room of CoGiRo, now and then far outside.
    fn pose(&mut self) -> PoseInput {
        let far = if self.next() < 0.1 { 3.0 } else { 1.0 };
        let mut input =
            at([far * self.between(-5.0, 5.0), far * self.between(-3.0, 3.0), 1.0 + far * self.between(-0.5, 2.0)]);
        let half: [f64; 3] = std::array::from_fn(|_| self.between(-0.04, 0.04));
        let square: f64 = half.iter().map(|part| part * part).sum();
        input.quaternion_wxyz = [(1.0 - square).sqrt(), half[0], half[1], half[2]];
        for number in input.velocity_m_s.iter_mut().chain(&mut input.angular_velocity_rad_s) {
            *number = self.between(-0.3, 0.3);
        }
        for number in input.acceleration_m_s2.iter_mut().chain(&mut input.force_n) {
            *number = self.between(-0.5, 0.5);
        }
        input
    }

    /// Input with one number that no controller should send.
    fn hostile(&mut self) -> PoseInput {
        let mut input = self.pose();
        let bad = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e300, -2e9][(5.0 * self.next()) as usize];
        match (6.0 * self.next()) as usize {
            0 => input.position_m[1] = bad,
            1 => input.quaternion_wxyz[2] = bad,
            2 => input.velocity_m_s[0] = bad,
            3 => input.angular_acceleration_rad_s2[2] = bad,
            4 => input.moment_n_m[1] = bad,
            _ => input.quaternion_wxyz = [0.0; 4],
        }
        input
    }
}

/// Results are those of the program, with and without pulleys; nothing is reserved; 1 % hostile input changes nothing.
/// `FUNICULAR_POSES` gives another number of poses.
#[test]
fn a_long_run_of_random_poses_reserves_nothing_and_equals_the_program() {
    let poses: usize = std::env::var("FUNICULAR_POSES").map_or(50_000, |count| count.parse().unwrap());
    for toml in [funicular_robots::COGIRO, funicular_robots::COGIRO_WINCHES] {
        let session = TestSession::new(toml);
        let robot = Robot::from_toml(toml).unwrap();
        let mut random = Random(7);
        let (mut rows, mut counts, mut most) = (Rows::new(), [0_usize; 6], 0);
        let (mut worst, mut times) = (0.0_f64, Vec::with_capacity(poses));
        for k in 0..poses {
            let is_hostile = random.next() < 0.01;
            let input = if is_hostile { random.hostile() } else { random.pose() };
            let before = rows.numbers.clone();
            let begin = Instant::now();
            let (status, reserved) = reserved(|| session.inverse(&input, &mut rows));
            times.push(begin.elapsed().as_secs_f64() * 1e6);
            assert_eq!(reserved, 0, "pose {k}");
            if is_hostile {
                assert_eq!(status, BAD_INPUT, "pose {k}: {input:?}");
            }
            if status < CERTIFIED {
                assert_eq!(rows.numbers, before, "pose {k}");
                counts[5] += 1;
                continue;
            }
            counts[status as usize] += 1;
            most = most.max(rows.summary.iterations);
            let numbers = &rows.numbers;
            let all = [&numbers.length, &numbers.rate, &numbers.acceleration, &numbers.platform, &numbers.drum];
            assert!(all.iter().all(|row| row[..8].iter().all(|number| number.is_finite())), "pose {k}");

            if k % 50 == 0 && status <= ACCEPTED {
                worst = worst.max(difference_to_program(&robot, &input, &rows.numbers));
            }
        }
        println!("certified, accepted, beyond, held, -, negative: {counts:?}; most steps {most}; difference {worst:e}");
        times.sort_by(f64::total_cmp);
        let part = |part: f64| times[((poses - 1) as f64 * part) as usize];
        println!("µs, with rates: median {:.1}, 99.9 % {:.1}, worst {:.1}", part(0.5), part(0.999), part(1.0));
        assert!(worst < 1e-10, "{worst:e}");
        assert!(counts[0] > poses / 2 && counts[2] > 0, "{counts:?}");
    }
}

/// Largest relative difference of lengths and tensions to those of the program at the same pose and load.
fn difference_to_program(robot: &Robot, input: &PoseInput, numbers: &Numbers) -> f64 {
    use funicular::math::{Quaternion, Rotation, Vec3, Vec6};
    use funicular::path::PathPoint;
    let [w, x, y, z] = input.quaternion_wxyz;
    let rot_wp = Rotation::from_quaternion(Quaternion::new(w, x, y, z));
    let pose = Pose { position_w: Vec3::from(input.position_m), rot_wp };
    let six = |a: [f64; 3], b: [f64; 3]| Vec6::new(a[0], a[1], a[2], b[0], b[1], b[2]);
    let point = PathPoint {
        velocity_w: six(input.velocity_m_s, input.angular_velocity_rad_s),
        acceleration_w: six(input.acceleration_m_s2, input.angular_acceleration_rad_s2),
        ..PathPoint::at_rest(&pose)
    };
    let [force_w, moment_w] = point.inertia(robot);
    let mut loaded = robot.clone();
    loaded.load.force_w += force_w + Vec3::from(input.force_n);
    loaded.load.moment_w += moment_w;
    let rest = tension_centre(&loaded, &pose, StaticModel::Catenary, None).unwrap().equilibrium;
    let pairs = rest.cables.iter().enumerate().flat_map(|(i, cable)| {
        [
            (numbers.length[i], cable.unstrained_length),
            (numbers.platform[i], cable.tension_platform),
            (numbers.drum[i], cable.tension_drum()),
        ]
    });
    pairs.map(|(a, b)| (a - b).abs() / b.abs()).fold(0.0, f64::max)
}

/// Poses beyond the limits have a proof, which random tensions within the limits confirm: the load that they hold lacks
/// what the proof says, by `fn_wrench`, over pulleys and without.
#[test]
fn poses_beyond_the_limits_have_a_proof_that_random_tensions_confirm() {
    for toml in [funicular_robots::COGIRO, funicular_robots::COGIRO_WINCHES] {
        let session = TestSession::new(toml);
        let robot = Robot::from_toml(toml).unwrap();
        let (mut random, mut rows) = (Random(11), Rows::new());
        let (mut beyond, mut proved, mut least) = (0, 0, f64::INFINITY);
        while beyond < 400 {
            let mut input = random.pose();
            input.position_m.iter_mut().take(2).for_each(|place| *place *= 1.6);
            if session.inverse(&input, &mut rows) != BEYOND_LIMITS {
                assert!(rows.summary.missing_n.to_bits() == 0, "{}", rows.summary.missing_n);
                continue;
            }
            beyond += 1;
            let InverseResult { missing_n, missing_force, missing_moment, missing_at_maximum, .. } = rows.summary;
            if missing_n == 0.0 {
                continue;
            }
            proved += 1;
            assert!(missing_at_maximum < 1 << 8, "{missing_at_maximum:b}");
            for k in 0..20 {
                let tensions: [f64; 8] = std::array::from_fn(|i| {
                    let limits = robot.cables[i].limits();
                    let (low, high) = (1.05 * limits.minimum.unwrap(), 0.98 * limits.maximum.unwrap());
                    match k {
                        0 if missing_at_maximum >> i & 1 == 1 => high,
                        0 => low,
                        _ => random.between(low, high),
                    }
                });
                let mut load = WrenchResult { struct_size: size::<WrenchResult>(), ..WrenchResult::default() };
                let status =
                    unsafe { fn_wrench(session.handle, &raw const input, tensions.as_ptr(), 8, &raw mut load) };
                assert_eq!(status, CERTIFIED);
                let along = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
                let external = along(missing_force, input.force_n);
                let found = along(missing_force, load.force_n)
                    + along(missing_moment, load.moment_n_m) / robot.platform_length();
                least = least.min(found - external - missing_n);
                assert!(found - external >= missing_n, "{k}: {found} {external} {missing_n}");
            }
        }
        println!("{proved} of {beyond} proved, {least} N beyond the bound");
        assert!(proved * 10 >= beyond * 9, "{proved} of {beyond}");
    }
}

/// Times of the calls 1 mm on per call, which docs/speed.md has, and the counts that bound them.
#[test]
fn calls_along_a_line_take_few_steps() {
    for (name, toml) in [("cogiro", funicular_robots::COGIRO), ("winches", funicular_robots::COGIRO_WINCHES)] {
        let session = TestSession::new(toml);
        let mut rows = Rows::new();
        let calls = 4000_u32;
        let along = |k: u32| {
            let part = 1e-3 * (f64::from(k) - 2000.0);
            PoseInput { velocity_m_s: [1.0, 0.5, 0.2], ..at([part, 0.5 * part, 1.6 + 0.2 * part]) }
        };
        let mut timed = |what: &str, most: i32, is_cold: bool, with_rates: bool| {
            let mut times = Vec::with_capacity(calls as usize);
            for k in 0..calls {
                if is_cold {
                    assert_eq!(unsafe { fn_reset(session.handle) }, CERTIFIED);
                }
                let input = along(k);
                let mut result = rows.result(8);
                if !with_rates {
                    (result.length_rate_m_s, result.length_acceleration_m_s2) = (null_mut(), null_mut());
                }
                let begin = Instant::now();
                let status = unsafe { fn_inverse(session.handle, &raw const input, &raw mut result) };
                times.push(begin.elapsed().as_secs_f64() * 1e6);
                assert!(
                    status == CERTIFIED && (k == 0 || result.iterations <= most),
                    "{what} {k}: {status} {}",
                    result.iterations
                );
            }
            times.sort_by(f64::total_cmp);
            println!("{name}, {what}: fastest {:.1} µs, median {:.1} µs", times[0], times[times.len() / 2]);
        };
        timed("cold", 12, true, false);
        timed("warm", 4, false, false);
        timed("warm with rates", 4, false, true);
    }
}

#[test]
fn no_function_of_the_loop_reserves_memory() {
    let session = TestSession::new(funicular_robots::COGIRO_WINCHES);
    let mut rows = Rows::new();
    let input = at([0.5, 0.2, 1.2]);
    let (all, reserved) = reserved(|| unsafe {
        let warm = fn_warm_up(session.handle);
        let inverse = session.inverse(&input, &mut rows);
        let mut pose = ForwardResult { struct_size: size::<ForwardResult>(), ..ForwardResult::default() };
        let lengths = rows.numbers.length.as_ptr();
        let forward = fn_forward(session.handle, lengths, 8, null(), &raw mut pose);
        let mut load = WrenchResult { struct_size: size::<WrenchResult>(), ..WrenchResult::default() };
        let wrench = fn_wrench(session.handle, &raw const input, rows.numbers.drum.as_ptr(), 8, &raw mut load);
        [warm, inverse, forward, wrench, fn_reset(session.handle)]
    });
    assert_eq!((all, reserved), ([CERTIFIED; 5], 0));
    // The counter counts.
    assert!(counting::reserved(|| vec![1_u8; 100]).1 > 0);
}

#[test]
fn eight_threads_with_one_model_give_the_digits_of_one() {
    let (status, model, _) = model_of(funicular_robots::COGIRO_WINCHES);
    assert_eq!(status, CERTIFIED);
    let address = model as usize;
    let run = move || -> Vec<u64> {
        let (_memory, handle) = loop_of(address as *mut Model);
        let mut random = Random(3);
        let mut all = Vec::new();
        for _ in 0..200 {
            let (input, mut rows) = (random.pose(), Rows::new());
            let mut result = rows.result(8);
            let status = unsafe { fn_inverse(handle, &raw const input, &raw mut result) };
            all.push(status as u64);
            all.extend(rows.numbers.length.iter().chain(&rows.numbers.acceleration).map(|number| number.to_bits()));
        }
        assert_eq!(unsafe { fn_loop_end(handle) }, CERTIFIED);
        all
    };
    let one = run();
    std::thread::scope(|scope| {
        let threads: Vec<_> = (0..8).map(|_| scope.spawn(run)).collect();
        assert!(threads.into_iter().all(|thread| thread.join().unwrap() == one));
    });
    assert_eq!(unsafe { fn_model_free(model) }, CERTIFIED);
}

/// Two threads on one loop: one of them is refused now and then, no result is wrong.
#[test]
fn a_second_thread_is_refused() {
    let session = TestSession::new(funicular_robots::COGIRO);
    let handle = session.handle as usize;
    let wanted = {
        let mut rows = Rows::new();
        assert_eq!(session.inverse(&at([0.0, 0.0, 1.5]), &mut rows), CERTIFIED);
        rows.numbers.length
    };
    let run = move || {
        let mut busy = 0;
        for _ in 0..3000 {
            let (input, mut rows) = (at([0.0, 0.0, 1.5]), Rows::new());
            let mut result = rows.result(8);
            match unsafe { fn_inverse(handle as *mut Loop, &raw const input, &raw mut result) } {
                BUSY => {
                    busy += 1;
                    assert!(rows.numbers.length[0].to_bits() == UNTOUCHED.to_bits());
                }
                status => {
                    assert_eq!(status, CERTIFIED);
                    let pairs = rows.numbers.length.iter().zip(&wanted).take(8);
                    assert!(pairs.into_iter().all(|(a, b)| (a - b).abs() < 1e-10));
                }
            }
        }
        busy
    };
    let busy: usize = std::thread::scope(|scope| {
        let threads: Vec<_> = (0..4).map(|_| scope.spawn(run)).collect();
        threads.into_iter().map(|thread| thread.join().unwrap()).sum()
    });
    println!("{busy} of 12000 refused");
}

#[test]
fn addresses_sizes_and_handles_that_are_wrong_have_a_status() {
    let session = TestSession::new(funicular_robots::COGIRO);
    let (handle, model) = (session.handle, session.model);
    let (input, mut rows) = (at([0.0, 0.0, 1.5]), Rows::new());
    let aside = |address: usize| address + 4;
    unsafe {
        // Missing and misaligned.
        let mut result = rows.result(8);
        assert_eq!(fn_inverse(null_mut(), &raw const input, &raw mut result), BAD_POINTER);
        assert_eq!(fn_inverse(handle, null(), &raw mut result), BAD_POINTER);
        assert_eq!(fn_inverse(handle, &raw const input, null_mut()), BAD_POINTER);
        let beside = aside(&raw const input as usize) as *const PoseInput;
        assert_eq!(fn_inverse(handle, beside, &raw mut result), BAD_POINTER);
        result.tension_drum_n = aside(rows.numbers.drum.as_ptr() as usize) as *mut f64;
        assert_eq!(fn_inverse(handle, &raw const input, &raw mut result), BAD_POINTER);
        result.tension_drum_n = null_mut();

        // Too small.
        let short = PoseInput { struct_size: 40, ..input };
        assert_eq!(fn_inverse(handle, &raw const short, &raw mut result), BAD_STRUCT);
        result.cables = 7;
        assert_eq!(fn_inverse(handle, &raw const input, &raw mut result), BAD_STRUCT);
        result.cables = 8;
        result.struct_size = 4;
        assert_eq!(fn_inverse(handle, &raw const input, &raw mut result), BAD_STRUCT);
        result.struct_size = size::<InverseResult>();
        assert!(rows.numbers.length[0].to_bits() == UNTOUCHED.to_bits() && result.status == 0);

        // Without the members that may be missing, the platform is at rest and no array is wanted.
        let rest = u32::try_from(offset_of!(PoseInput, velocity_m_s)).unwrap();
        let first = PoseInput { struct_size: rest, velocity_m_s: [f64::NAN; 3], ..input };
        assert_eq!(fn_inverse(handle, &raw const first, &raw mut result), CERTIFIED);
        assert!(rows.numbers.length[0] > 1.0);
        let later = PoseInput { struct_size: size::<PoseInput>() + 200, ..input };
        assert_eq!(fn_inverse(handle, &raw const later, &raw mut result), CERTIFIED);

        // Handles.
        let mut nothing = vec![0_u64; 4096];
        let no_loop = nothing.as_mut_ptr().cast::<Loop>();
        assert_eq!(fn_inverse(no_loop, &raw const input, &raw mut result), BAD_HANDLE);
        assert_eq!(fn_model_free(no_loop.cast()), BAD_HANDLE);
        assert_eq!(fn_model_free(model), IN_USE);
        let mut other = null_mut();
        assert_eq!(fn_loop_init(model, null_mut(), 100_000, &raw mut other), BAD_POINTER);
        let place = nothing.as_mut_ptr().cast::<c_void>();
        assert_eq!(fn_loop_init(model, place.byte_add(4), 30_000, &raw mut other), BAD_MEMORY);
        assert_eq!(fn_loop_init(model, place, 64, &raw mut other), BAD_MEMORY);
        assert!(other.is_null());

        // Lengths and tensions.
        let mut pose = ForwardResult { struct_size: size::<ForwardResult>(), ..ForwardResult::default() };
        let lengths = rows.numbers.length;
        assert_eq!(fn_forward(handle, null(), 8, null(), &raw mut pose), BAD_POINTER);
        assert_eq!(fn_forward(handle, lengths.as_ptr(), 7, null(), &raw mut pose), BAD_STRUCT);
        assert_eq!(fn_forward(handle, [0.0; 8].as_ptr(), 8, null(), &raw mut pose), BAD_INPUT);
        let mut load = WrenchResult { struct_size: size::<WrenchResult>(), ..WrenchResult::default() };
        let none = [0.0; 8];
        assert_eq!(fn_wrench(handle, &raw const input, none.as_ptr(), 8, &raw mut load), TOO_SLACK);
        assert_eq!(fn_wrench(handle, &raw const input, [f64::NAN; 8].as_ptr(), 8, &raw mut load), BAD_INPUT);
        assert_eq!(load.payload_kg.to_bits(), 0);

        // Lengths from nothing, and without a start.
        assert_eq!(fn_reset(handle), CERTIFIED);
        assert_eq!(fn_forward(handle, lengths.as_ptr(), 8, null(), &raw mut pose), NO_START);
        assert!(fn_forward_cold(handle, lengths.as_ptr(), 8, &raw mut pose) >= CERTIFIED);
        assert!((pose.position_m[2] - 1.5).abs() < 1e-8, "{:?}", pose.position_m);
    }
}

#[test]
fn robots_that_cannot_be_computed_have_a_message() {
    let cogiro = funicular_robots::COGIRO;
    let robot = Robot::from_toml(cogiro).unwrap();
    assert!(LoopModel::new(robot).is_ok());
    let cables = cogiro.find("[[cables]]").unwrap();
    let one = &cogiro[cables..cables + cogiro[cables + 1..].find("[[cables]]").unwrap()];
    let many = (0..9).fold(cogiro.to_owned(), |toml, k| {
        let name = one.lines().find(|line| line.starts_with("name")).unwrap();
        format!("{toml}\n{}\n", one.replace(name, &format!("name = \"more {k}\"")))
    });
    for (toml, wanted, word) in
        [(many.as_str(), NOT_FOR_LOOP, "17 cables"), ("name = ", BAD_MODEL, "robot file"), ("", BAD_MODEL, "platform")]
    {
        let (status, model, message) = model_of(toml);
        assert!(status == wanted && model.is_null() && message.contains(word), "{status}: {message}");
    }
    let (mut model, mut text) = (null_mut(), [1_u8; 8]);
    let to = text.as_mut_ptr().cast();
    let not_utf8 = [0xff_u8, 0xfe];
    unsafe {
        assert_eq!(fn_model_from_toml(not_utf8.as_ptr().cast(), 2, &raw mut model, to, 8), BAD_MODEL);
        assert_eq!(text[7], 0);
        assert_eq!(fn_model_from_toml(null(), 2, &raw mut model, null_mut(), 0), BAD_POINTER);
        assert_eq!(fn_model_from_toml(not_utf8.as_ptr().cast(), 2, null_mut(), null_mut(), 0), BAD_POINTER);
    }
}

/// The headers have the statuses, structs and functions of the library, and nothing else.
#[test]
fn the_headers_say_what_the_library_has() {
    let (header, flat) = (include_str!("../include/funicular.h"), include_str!("../include/funicular_flat.h"));
    for (name, number, _) in status::ALL {
        let line = header.lines().find(|line| line.starts_with(&format!("#define {name} "))).unwrap_or_else(|| {
            panic!("{name} is not in the header");
        });
        let given = line.split_whitespace().nth(2).unwrap().trim_matches(['(', ')']);
        assert_eq!(given, number.to_string(), "{line}");
    }

    let sources = [
        include_str!("../src/model_calls.rs"),
        include_str!("../src/loop_calls.rs"),
        include_str!("../src/sim_calls.rs"),
        include_str!("../src/est_calls.rs"),
        include_str!("../src/flat.rs"),
    ];
    let mut exported: Vec<&str> = sources
        .iter()
        .flat_map(|source| source.split("extern \"C\" fn ").skip(1))
        .map(|rest| &rest[..rest.find('(').unwrap()])
        .collect();
    let mut declared: Vec<&str> = header
        .lines()
        .chain(flat.lines())
        .filter_map(|line| line.strip_prefix("int32_t "))
        .map(|rest| &rest[..rest.find('(').unwrap()])
        .collect();
    exported.sort_unstable();
    declared.sort_unstable();
    assert_eq!(exported, declared);
    assert!(exported.iter().all(|name| name.starts_with("fn_")));

    let mut words = [0_u8; 300];
    for (.., number, text) in status::ALL {
        assert_eq!(unsafe { fn_status_text(*number, words.as_mut_ptr().cast(), 300) }, CERTIFIED);
        assert!(words.starts_with(text.as_bytes()) && words[text.len()] == 0);
    }
}

/// Members of the structs at the places that a C compiler gives them: scripts/test-c compares the same file.
#[test]
fn structs_have_the_places_of_the_header() {
    macro_rules! places {
        ($($c:literal $rust:ident: $($member:ident)*;)*) => {{
            let mut lines = String::new();
            $(
                lines += &format!("{} size {}\n", $c, size_of::<$rust>());
                $(lines += &format!("{} {} {}\n", $c, stringify!($member), offset_of!($rust, $member));)*
            )*
            lines
        }};
    }
    let found = places! {
        "fn_pose_input" PoseInput: struct_size reserved position_m quaternion_wxyz velocity_m_s angular_velocity_rad_s
            acceleration_m_s2 angular_acceleration_rad_s2 force_n moment_n_m;
        "fn_inverse_result" InverseResult: struct_size cables status iterations age_calls least_margin_cable
            least_margin_n error_n error_m length_m length_rate_m_s length_acceleration_m_s2 free_length_m
            tension_platform_n tension_drum_n margin_n missing_n missing_force missing_moment missing_at_maximum
            reserved;
        "fn_forward_result" ForwardResult: struct_size cables status iterations age_calls least_margin_cable
            least_margin_n error_n error_m position_m quaternion_wxyz free_length_m tension_platform_n tension_drum_n
            margin_n;
        "fn_wrench_result" WrenchResult: struct_size status force_n moment_n_m payload_kg;
        "fn_est_settings" EstSettings: struct_size reserved length_std_m tension_std_n cable_angle_std_rad
            gyroscope_std_rad_s accelerometer_std_m_s2 tracker_std_m payload_kg payload_std_kg first_moment_std_kg_m
            force_std_n moment_std_n_m force_time_s offset_std_m tension_bias_std_n friction false_alarms_per_hour
            inertial_unit_m tracked_point_m;
        "fn_est_readings" EstReadings: struct_size cables length_m tension_n azimuth_rad elevation_rad
            gyroscope_rad_s accelerometer_m_s2 tracker_m length_missing tension_missing azimuth_missing
            elevation_missing gyroscope_missing accelerometer_missing tracker_missing reserved;
        "fn_est_result" EstResult: struct_size cables is_trusted rings alarm alarm_cable time_s position_m
            quaternion_wxyz position_std_m rotation_std_rad velocity_m_s velocity_std_m_s angular_velocity_rad_s
            angular_velocity_std_rad_s force_n force_std_n moment_n_m moment_std_n_m payload_kg payload_std_kg
            first_moment_kg_m first_moment_std_kg_m tension_n tension_std_n offset_m offset_std_m tension_bias_n
            tension_bias_std_n slack;
        "fn_est_fault" EstFault: kind cable size std worse_by;
    };
    assert_eq!(found, include_str!("layout.txt"));
}

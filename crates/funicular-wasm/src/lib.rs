//! Front end for WebAssembly: a request in JSON gives results in JSON, or one message.
//!
//! The exported functions are C functions on the memory of the instance, so they need no code generator on either side.
//! A caller gets memory from [`funicular_input`], writes the request there as UTF-8, calls [`funicular_answer`], and
//! reads the text at [`funicular_output`]. `web/funicular.js` does this for JavaScript.
//!
//! The commands that write files on a disk return their content here: `import` and `new` a robot file, `schema` the
//! schema, `map` its rows. [`frame`] has results for animations, as numbers.
//!
//! The module has no imports: no disk, no clock, no random numbers, no threads.
//!
//! A panic is a mistake in this library. It ends the call with a trap. Afterwards the text says what happened and how
//! to report it. The instance must not be used again: the caller makes a new one.

mod border;
pub mod frame;
pub mod layout;
mod page_answers;

use anyhow::Result;
use frame::{Answer, FrameSize, FrameState, Session};
use funicular_study::request::Request;
use funicular_study::robot_file::Refused;
use funicular_study::wording::Words;
use funicular_study::{Error, ErrorKind, Silent, run};
use serde_json::{Value, json};
use std::cell::RefCell;
use std::panic::{self, Location, PanicHookInfo};
use std::sync::Once;

/// Status of an answer whose text is the results in JSON.
pub const RESULTS: u32 = 0;

/// Status of a valid request for a robot that has no such solution. The text says what was reached.
pub const NO_SOLUTION: u32 = 1;

/// Status of a request that has to change. The text says where and how.
pub const BAD_INPUT: u32 = 2;

/// Status of work that was stopped, equal to the program's exit code. This front end does not stop work today.
pub const INTERRUPTED: u32 = 130;

thread_local! {
    /// Text of the request before a call of [`funicular_answer`], and of the answer after it.
    static TEXT: RefCell<Vec<u8>> = const { RefCell::new(Vec::new()) };

    /// Numbers of a state before a call of [`funicular_frame`], and of an answer after it.
    static NUMBERS: RefCell<Vec<f64>> = const { RefCell::new(Vec::new()) };

    /// Robot of the frames; none after a refused one.
    static SESSION: RefCell<Option<Session>> = const { RefCell::new(None) };
}

/// Allocates memory for a request of `length` bytes and returns its address. The caller writes all of these bytes.
///
/// The text of the previous answer is discarded.
#[expect(unsafe_code, reason = "a name for other languages")]
#[unsafe(no_mangle)]
pub extern "C" fn funicular_input(length: usize) -> *mut u8 {
    static HOOK: Once = Once::new();
    HOOK.call_once(|| panic::set_hook(Box::new(leave_message)));

    // The old text is released first, so that memory never holds both texts. The new one is allocated before it is
    // stored, so that a panic during the allocation finds the store free.
    TEXT.set(Vec::new());
    let room = vec![0; length];
    TEXT.with_borrow_mut(|text| {
        *text = room;
        text.as_mut_ptr()
    })
}

/// Answers the request that was written and returns the status: 0, 1 or 2, equal to the program's exit codes.
#[expect(unsafe_code, reason = "a name for other languages")]
#[unsafe(no_mangle)]
pub extern "C" fn funicular_answer() -> u32 {
    let (status, text) = answer(TEXT.take());
    TEXT.set(text);
    NUMBERS.set(Vec::new());
    status
}

/// Address of the answer's text, or after a trap of the message about the trap. Valid until the next request.
#[expect(unsafe_code, reason = "a name for other languages")]
#[unsafe(no_mangle)]
pub extern "C" fn funicular_output() -> *const u8 {
    TEXT.with_borrow(Vec::as_ptr)
}

/// Length in bytes of the text of the answer, which is UTF-8.
#[expect(unsafe_code, reason = "a name for other languages")]
#[unsafe(no_mangle)]
pub extern "C" fn funicular_output_length() -> usize {
    TEXT.with_borrow(Vec::len)
}

/// Allocates memory for `length` numbers and returns its address. The caller writes all of them.
///
/// The numbers of the previous answer are discarded.
#[expect(unsafe_code, reason = "a name for other languages")]
#[unsafe(no_mangle)]
pub extern "C" fn funicular_numbers(length: usize) -> *mut f64 {
    NUMBERS.set(vec![0.0; length]);
    NUMBERS.with_borrow_mut(Vec::as_mut_ptr)
}

/// Address of the numbers of the last answer. Valid until the next call.
#[expect(unsafe_code, reason = "a name for other languages")]
#[unsafe(no_mangle)]
pub extern "C" fn funicular_numbers_output() -> *const f64 {
    NUMBERS.with_borrow(Vec::as_ptr)
}

/// Count of the numbers of the last answer.
#[expect(unsafe_code, reason = "a name for other languages")]
#[unsafe(no_mangle)]
pub extern "C" fn funicular_numbers_length() -> usize {
    NUMBERS.with_borrow(Vec::len)
}

/// Reads the robot of the frames from the written text: a request with the keys of `stiffness`. The answer's text
/// describes the robot. If it is refused, there is no robot until the next one is read, and the text is JSON with the
/// `message` and the places of the `issues`.
#[expect(unsafe_code, reason = "a name for other languages")]
#[unsafe(no_mangle)]
pub extern "C" fn funicular_robot() -> u32 {
    let request = TEXT.take();
    SESSION.set(None);
    keep(text_of(request).and_then(|text| Session::new(frame::request_of(&text)?)).map(|(session, answer)| {
        SESSION.set(Some(session));
        answer
    }))
}

/// Computes a frame at a state, whose numbers were written: `kind` 0 is the state of the robot, 1 a pose, 2 unstrained
/// lengths, 3 a pose at which the search begins, then unstrained lengths. The frame has `modes` natural frequencies and
/// `points` points per cable. If it is refused, there is no frame until the next one is computed.
#[expect(unsafe_code, reason = "a name for other languages")]
#[unsafe(no_mangle)]
pub extern "C" fn funicular_frame(kind: u32, modes: usize, points: usize) -> u32 {
    let numbers = NUMBERS.take();
    with_session(|session| session.frame(FrameState::of_numbers(kind, &numbers), FrameSize { modes, points }))
}

/// Continues the list of modes of the last frame up to the first mode of the platform. The numbers are those of all
/// these modes, as at the end of a frame; the text has the `index` of the last one.
#[expect(unsafe_code, reason = "a name for other languages")]
#[unsafe(no_mangle)]
pub extern "C" fn funicular_platform() -> u32 {
    with_session(Session::platform)
}

/// Computes the displacements of `points` points per cable in mode `index` of the last frame.
#[expect(unsafe_code, reason = "a name for other languages")]
#[unsafe(no_mangle)]
pub extern "C" fn funicular_mode(index: usize, points: usize) -> u32 {
    with_session(|session| session.mode(index, points))
}

/// Follows the rays of a level from the pose whose seven numbers were written, position [m] and quaternion w, x, y, z,
/// to where the conditions of `workspace` end. The text has the conditions.
#[expect(unsafe_code, reason = "a name for other languages")]
#[unsafe(no_mangle)]
pub extern "C" fn funicular_reach(level: usize) -> u32 {
    let numbers = NUMBERS.take();
    with_session(|session| session.reach(&FrameState::of_numbers(1, &numbers)?, level))
}

/// Reads the table in CSV that was written, its name in messages in the first line and the table from the second line
/// on. The text is JSON, as a request of `calibrate` has it in `readings`.
#[expect(unsafe_code, reason = "a name for other languages")]
#[unsafe(no_mangle)]
pub extern "C" fn funicular_table() -> u32 {
    let written = TEXT.take();
    keep(text_of(written).and_then(|text| {
        let (name, table) = text.split_once('\n').unwrap_or((&text, ""));
        Ok(Answer { numbers: Vec::new(), text: page_answers::table(name, table)?.to_string() })
    }))
}

/// Computes the frequency response that was written, a request of `frf` whose robot and state are not used, at the
/// equilibrium of the last frame.
#[expect(unsafe_code, reason = "a name for other languages")]
#[unsafe(no_mangle)]
pub extern "C" fn funicular_response() -> u32 {
    let request = TEXT.take();
    with_session(|session| match frame::request_of(&text_of(request)?)? {
        Request::Frf(request) => session.response(&request),
        other => anyhow::bail!("`{}` is not a response: give a request of `frf`", other.command()),
    })
}

/// Runs a function on the robot of the frames and keeps its answer. A panic inside leaves no robot, but the instance is
/// broken anyway.
fn with_session(work: impl FnOnce(&mut Session) -> Result<Answer>) -> u32 {
    let mut session = SESSION.take();
    let answer = match &mut session {
        Some(session) => work(session),
        None => Err(anyhow::anyhow!("there is no robot, or the last one was refused: give one with `robot` first")),
    };
    SESSION.set(session);
    keep(answer)
}

/// Stores an answer for the caller and returns its status.
fn keep(answer: Result<Answer>) -> u32 {
    let (status, Answer { numbers, text }) = match answer {
        Ok(answer) => (RESULTS, answer),
        Err(error) => refusal(error),
    };
    NUMBERS.set(numbers);
    TEXT.set(text.into_bytes());
    status
}

/// Status and text of an error: JSON with the message, the places in the robot file that it refers to, and why a pose
/// has no equilibrium.
fn refusal(error: anyhow::Error) -> (u32, Answer) {
    let issues = error.downcast_ref().map_or_else(Vec::new, issues);
    let border = border::of(&error);
    let error = Error::from(error);
    let text = json!({ "message": error.message(Words::Json), "issues": issues, "border": border }).to_string();
    (status_of(&error), Answer { numbers: Vec::new(), text })
}

/// Issues of a robot file with their places: lines and columns from 1, bytes of the text from 0.
fn issues(refused: &Refused) -> Vec<Value> {
    let of = |issue: &funicular::robot::spec::Issue| {
        json!({
            "line": issue.line,
            "column": issue.column,
            "from_byte": issue.span.start,
            "to_byte": issue.span.end,
            "message": issue.message,
            "help": issue.help,
        })
    };
    refused.error.issues().iter().map(of).collect()
}

/// Text of bytes that a caller has written.
fn text_of(bytes: Vec<u8>) -> Result<String> {
    String::from_utf8(bytes).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        anyhow::anyhow!("the request is not valid UTF-8 at byte {}; write the request as JSON in UTF-8", at + 1)
    })
}

/// Status and text for a request in JSON.
pub fn answer(request: Vec<u8>) -> (u32, Vec<u8>) {
    match results(request) {
        Ok(json) => (RESULTS, json),
        Err((status, message)) => (status, message.into_bytes()),
    }
}

fn results(request: Vec<u8>) -> Result<Vec<u8>, (u32, String)> {
    let told = |error: Error| (status_of(&error), error.message(Words::Json));
    let request = text_of(request).map_err(|error| told(error.into()))?;
    let request = Request::from_json(&request).map_err(told)?;
    if let Some(content) = page_answers::content(&request) {
        return content.map_err(|error| told(error.into()));
    }
    #[cfg(feature = "validation")]
    if let Request::Validate(of) = &request {
        let found = funicular_validation::run(of).map_err(|error| told(error.into()))?;
        return funicular_study::json::of_results(&found, Words::Json).map_err(told);
    }
    run(&request, &mut Silent).and_then(|results| results.to_json(Words::Json)).map_err(told)
}

fn status_of(error: &Error) -> u32 {
    match error.kind() {
        ErrorKind::NoSolution => NO_SOLUTION,
        ErrorKind::Input => BAD_INPUT,
        ErrorKind::Cancelled => INTERRUPTED,
    }
}

/// Stores a message about a panic in place of the answer.
fn leave_message(panic: &PanicHookInfo<'_>) {
    let payload = panic.payload();
    let reason =
        payload.downcast_ref::<&str>().copied().or_else(|| payload.downcast_ref::<String>().map(String::as_str));
    let text = message_of(reason, panic.location());
    // The panic may have occurred while the text was borrowed; then the caller sees only the trap.
    let _ = TEXT.try_with(|store| store.try_borrow_mut().map(|mut store| *store = text.into_bytes()));
}

fn message_of(panic: Option<&str>, place: Option<&Location<'_>>) -> String {
    format!(
        "mistake in funicular {}: {} ({}); please report it with the request and its robot file. This instance is \
         broken: make a new one",
        env!("CARGO_PKG_VERSION"),
        panic.unwrap_or("a panic without text"),
        place.map_or("unknown place".to_owned(), ToString::to_string),
    )
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "numbers of equal computations are equal bit for bit")]
mod tests {
    use super::*;
    use serde_json::{Value, json};

    const ROBOT: &str = funicular_robots::COGIRO;

    fn answered(request: &Value) -> (u32, String) {
        let (status, text) = answer(request.to_string().into_bytes());
        (status, String::from_utf8(text).unwrap())
    }

    #[test]
    fn an_answer_is_the_json_of_the_study() {
        let request = json!({ "command": "statics", "robot": { "text": ROBOT }, "pose": [1.0, 2.0, 1.5] });
        let (status, text) = answered(&request);
        assert_eq!(status, RESULTS);
        let results = run(&Request::from_value(request).unwrap(), &mut Silent).unwrap();
        assert_eq!(text.into_bytes(), results.to_json(Words::Json).unwrap());
    }

    #[test]
    fn an_error_is_one_message_with_the_status_of_the_program() {
        for (request, status, message) in [
            (json!({ "command": "check", "robot": { "text": "name = 1" } }), BAD_INPUT, "<request>:1:8"),
            (json!({ "command": "statics" }), BAD_INPUT, "a request of `statics` needs `robot`"),
            (json!({ "command": "statics", "poze": 1 }), BAD_INPUT, "has no key `poze`; did you mean `pose`?"),
            (json!({ "command": "paper" }), BAD_INPUT, "`paper` writes a file"),
            (json!({ "command": "map", "robot": { "text": ROBOT }, "grid": [] }), BAD_INPUT, "a map needs poses"),
            (
                json!({ "command": "statics", "robot": { "text": ROBOT }, "pose": [50.0, 0.0, 1.0] }),
                NO_SOLUTION,
                "no tensions hold this pose, whatever their limits",
            ),
        ] {
            let (found, text) = answered(&request);
            assert!(found == status && text.contains(message), "{found} {text}");
        }
        let (status, text) = answer(vec![b'{', 0xff]);
        assert_eq!((status, text.starts_with(b"the request is not valid UTF-8 at byte 2;")), (BAD_INPUT, true));
    }

    /// Status, numbers and text of a call.
    type Called = (u32, Vec<f64>, String);

    /// Calls an exported function after writing a text.
    fn called(text: &str, call: impl FnOnce() -> u32) -> Called {
        TEXT.set(text.as_bytes().to_vec());
        let status = call();
        (status, NUMBERS.take(), String::from_utf8(TEXT.take()).unwrap())
    }

    fn robot(more: &Value) -> Called {
        let mut request = json!({ "command": "stiffness", "robot": { "text": ROBOT } });
        request.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
        called(&request.to_string(), || funicular_robot())
    }

    fn at(pose: &[f64], modes: usize, points: usize) -> Called {
        NUMBERS.set(pose.to_vec());
        called("", || funicular_frame(1, modes, points))
    }

    #[test]
    fn a_frame_has_the_numbers_of_statics_and_modes() {
        let (status, _, about) = robot(&json!({ "tension_rule": "middle" }));
        assert_eq!(status, RESULTS);
        let about: Value = serde_json::from_str(&about).unwrap();
        assert_eq!(about["platform_share"], funicular::modes::PLATFORM_SHARE);
        let (status, numbers, text) = at(&[1.0, 2.0, 1.5], 20, 33);
        assert!(status == RESULTS && text.contains("\"tension_rule\":\"middle\""), "{status} {text}");
        assert_eq!(numbers.len(), frame::HEADER + 8 * (frame::CABLE + 3 * 33) + 20 * (frame::MODE + 8));
        assert_eq!(numbers[..6], [8.0, 33.0, 20.0, 1.0, 2.0, 1.5]);

        let common = json!({ "robot": { "text": ROBOT }, "pose": [1.0, 2.0, 1.5], "tension_rule": "middle" });
        let request = |more: &Value| {
            let mut request = common.clone();
            request.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
            let (status, text) = answered(&request);
            assert_eq!(status, RESULTS, "{text}");
            serde_json::from_str::<Value>(&text).unwrap()
        };
        let statics = request(&json!({ "command": "statics" }));
        for (i, cable) in statics["cables"].as_array().unwrap().iter().enumerate() {
            let at = frame::HEADER + i * frame::CABLE;
            for (k, key) in
                [(0, "unstrained_length_m"), (1, "tension_platform_n"), (2, "tension_anchor_n"), (4, "chord_m")]
            {
                assert_eq!(numbers[at + k], cable[key].as_f64().unwrap(), "{key}");
            }
        }

        // The list of the program with the limit of the frame has equal modes; only its damping is not of first order.
        let below_hz = numbers[20];
        let found = request(&json!({ "command": "modes", "below_hz": below_hz, "damped": false, "stations": 33 }));
        let modes = found["modes"].as_array().unwrap();
        let first = frame::HEADER + 8 * (frame::CABLE + 3 * 33);
        for (i, mode) in modes.iter().take(20).enumerate() {
            let own = &numbers[first + i * (frame::MODE + 8)..][..frame::MODE + 8];
            assert_eq!(own[0], mode["frequency_hz"].as_f64().unwrap());
            assert_eq!(own[2], mode["damping_ratio"].as_f64().unwrap());
            assert_eq!(own[6], mode["shape"][0].as_f64().unwrap());
            assert_eq!(own[frame::MODE], mode["cable_energy_fractions"][0].as_f64().unwrap());
        }

        // Points and displacements along the cables.
        let point = frame::HEADER + 8 * frame::CABLE + 3 * (33 * 2 + 16);
        for k in 0..3 {
            assert_eq!(numbers[point + k], found["stations"][2]["position_m"][16][k].as_f64().unwrap());
        }
        let (status, moved, _) = called("", || funicular_mode(3, 33));
        assert_eq!((status, moved.len()), (RESULTS, 8 * 33 * 3));
        let size = |three: &[f64]| three.iter().map(|x| x * x).sum::<f64>().sqrt();
        let shape: Vec<f64> = serde_json::from_value(modes[3]["cable_shapes"][2][16].clone()).unwrap();
        let ours = &moved[3 * (33 * 2 + 16)..][..3];
        assert!((size(ours) - size(&shape)).abs() <= 1e-14 * size(&shape), "{ours:?} {shape:?}");
    }

    #[test]
    fn frames_that_follow_one_another_equal_frames_alone() {
        let poses: Vec<[f64; 6]> = (0..6).map(|i| [0.3 * f64::from(i), 0.5, 1.5, 0.0, 2.0, 0.0]).collect();
        robot(&json!({}));

        for pose in &poses {
            let (_, following, _) = at(pose, 20, 9);
            SESSION.with_borrow_mut(|session| {
                let request = json!({ "command": "stiffness", "robot": { "text": ROBOT } });
                let (alone, _) = Session::new(Request::from_value(request).unwrap()).unwrap();
                let mut alone = alone;
                let kept = session.take();
                let state = FrameState::of_numbers(1, pose);
                let numbers = alone.frame(state, FrameSize { modes: 20, points: 9 }).unwrap().numbers;
                // The limit of the list differs, and with it the number of clamped modes that a cable keeps: 1e-9 is
                // the accuracy of that reduction in the list of modes.
                let first = frame::HEADER + 8 * (frame::CABLE + 27);
                let bits = |numbers: &[f64]| numbers.iter().map(|number| number.to_bits()).collect::<Vec<_>>();
                assert_eq!(bits(&numbers[..20]), bits(&following[..20]));
                assert_eq!(bits(&numbers[frame::HEADER..first]), bits(&following[frame::HEADER..first]));
                for i in 0..20 {
                    let [a, b] = [&numbers, &following].map(|of| of[first + i * (frame::MODE + 8)]);
                    assert!((a / b - 1.0).abs() < 1e-9, "{a} {b}");
                }
                *session = kept;
            });
        }
    }

    #[test]
    fn a_response_of_the_last_frame_equals_that_of_the_program() {
        robot(&json!({}));
        at(&[1.0, 2.0, 1.5], 0, 0);
        let range = json!({
            "command": "frf", "robot": { "text": ROBOT }, "from_hz": 1.0, "to_hz": 30.0, "points": 400, "input": "fz",
            "output": "az", "pose": [1.0, 2.0, 1.5],
        });
        let (status, numbers, text) = called(&range.to_string(), || funicular_response());
        assert_eq!(status, RESULTS, "{text}");
        let expected: Value = serde_json::from_str(&answered(&range).1).unwrap();
        assert!(text.contains(expected["unit"].as_str().unwrap()), "{text}");
        for (i, three) in numbers.chunks(3).take(400).enumerate() {
            for (value, key) in three.iter().zip(["frequency_hz", "real", "imag"]) {
                assert_eq!(*value, expected[key][i].as_f64().unwrap());
            }
        }
        let peaks = expected["peaks"].as_array().unwrap();
        assert_eq!(numbers.len(), 3 * (400 + peaks.len()));
        assert_eq!(numbers[1202], peaks[0]["magnitude"].as_f64().unwrap());
    }

    #[test]
    fn held_lengths_lead_back_to_the_pose_and_a_bad_state_leaves_no_frame() {
        robot(&json!({}));
        let (_, numbers, _) = at(&[1.0, 2.0, 1.5], 0, 0);
        let lengths: Vec<f64> = (0..8).map(|i| numbers[frame::HEADER + i * frame::CABLE]).collect();
        let by_lengths = |lengths: &[f64]| {
            NUMBERS.set(lengths.to_vec());
            called("", || funicular_frame(3, 0, 0))
        };
        let (status, back, text) = by_lengths(&[&numbers[3..10], &lengths[..]].concat());
        assert_eq!(status, RESULTS, "{text}");
        // The residual of an equilibrium moves the pose by less than a nanometre.
        for k in 3..6 {
            assert!((back[k] - numbers[k]).abs() < 1e-9);
        }

        let refused: [(u32, &str, &dyn Fn() -> Called); 5] = [
            (BAD_INPUT, "7 unstrained lengths", &|| by_lengths(&[&numbers[3..10], &lengths[1..]].concat())),
            (BAD_INPUT, "give finite numbers", &|| at(&[1.0, f64::NAN, 1.5], 0, 0)),
            (BAD_INPUT, "kind 1 of a state does not go with 4 numbers", &|| at(&[1.0, 0.0, 1.5, 0.0], 0, 0)),
            (BAD_INPUT, "501 modes", &|| at(&[1.0, 2.0, 1.5], 501, 0)),
            (NO_SOLUTION, "no tensions hold this pose", &|| at(&[50.0, 0.0, 1.0], 0, 0)),
        ];
        for (status, message, call) in refused {
            assert_eq!(at(&[1.0, 2.0, 1.5], 3, 0).0, RESULTS);
            let found = call();
            assert!(found.0 == status && found.2.contains(message) && found.1.is_empty(), "{} {}", found.0, found.2);
            nothing_answers("there is no frame, or the last one was refused");
        }
        assert_eq!(at(&[1.0, 2.0, 1.5], 0, 0).0, RESULTS);
        assert!(called("", || funicular_mode(0, 9)).2.contains("the last frame has no modes"));
        assert_eq!(at(&[1.0, 2.0, 1.5], 3, 0).0, RESULTS);
        assert!(called("", || funicular_mode(99, 9)).2.contains("there is no mode 99: the last frame has"));
    }

    /// Asserts that what follows from a frame is refused with a message, and leaves no numbers.
    fn nothing_answers(message: &str) {
        let range = json!({
            "command": "frf", "robot": { "text": "" }, "from_hz": 1.0, "to_hz": 30.0, "points": 4, "input": "fz",
            "output": "az",
        });
        for (status, numbers, text) in [
            called("", || funicular_mode(0, 9)),
            called("", || funicular_platform()),
            called(&range.to_string(), || funicular_response()),
        ] {
            assert!(status == BAD_INPUT && numbers.is_empty() && text.contains(message), "{status} {text}");
        }
    }

    #[test]
    fn after_a_refused_robot_nothing_answers_for_the_one_before() {
        let half = &ROBOT[..ROBOT.len() / 2];
        for bad in [json!({ "robot": { "text": half } }), json!({ "poze": 1 }), json!({ "command": "statics" })] {
            assert_eq!((robot(&json!({})).0, at(&[1.0, 2.0, 1.5], 3, 0).0), (RESULTS, RESULTS));
            assert_eq!(robot(&bad).0, BAD_INPUT);
            let (status, numbers, text) = at(&[1.0, 2.0, 1.5], 3, 0);
            assert!(status == BAD_INPUT && numbers.is_empty() && text.contains("there is no robot"), "{status} {text}");
            nothing_answers("there is no robot");
        }
        // An answer in JSON has no numbers; those of the frame before are not left.
        robot(&json!({}));
        NUMBERS.set(vec![1.0]);
        assert_eq!(called("{}", || funicular_answer()).1.len(), 0);
    }

    #[test]
    fn the_first_mode_of_the_platform_is_found_above_the_listed_ones() {
        // In a hall with long cables 26 modes of the cables come first.
        let common = json!({ "robot": { "text": include_str!("../tests/hall.toml") } });
        let about: Value = serde_json::from_str(&robot(&common).2).unwrap();
        let cables = about["check"]["cables"].as_array().unwrap().len();
        let call = || called("", || funicular_platform());
        NUMBERS.set(Vec::new());
        let (_, frame, _) = called("", || funicular_frame(0, 20, 0));
        let listed = &frame[frame::HEADER + cables * frame::CABLE..];
        let share = |numbers: &[f64], i: usize| numbers[i * (frame::MODE + cables) + 4];
        assert!((0..20).all(|i| share(listed, i) < funicular::modes::PLATFORM_SHARE));

        let (status, numbers, text) = call();
        let told: Value = serde_json::from_str(&text).unwrap();
        assert_eq!((status, &told["index"], &told["certified"]), (RESULTS, &json!(26), &json!(true)), "{text}");
        assert_eq!(numbers.len(), 27 * (frame::MODE + cables));
        // The program's `modes` says 7.0849 Hz.
        let hz = numbers[26 * (frame::MODE + cables)];
        assert!((hz - 7.0849).abs() < 5e-5 && share(&numbers, 26) >= funicular::modes::PLATFORM_SHARE, "{hz}");
        for (a, b) in numbers.chunks(frame::MODE + cables).zip(listed.chunks(frame::MODE + cables)) {
            assert!((a[0] / b[0] - 1.0).abs() < 1e-9, "{} {}", a[0], b[0]);
        }
        // It moves like the listed ones, and a second call has it at once.
        assert_eq!(called("", || funicular_mode(26, 9)).0, RESULTS);
        assert_eq!(call().1, numbers);
    }

    #[test]
    fn a_refused_robot_file_has_the_places_of_its_errors() {
        let text = ROBOT.replace("mass_kg = 91.058", "mass_kg = -91.058");
        let request = json!({ "command": "stiffness", "robot": { "name": "a.toml", "text": text } });
        let (status, _, told) = called(&request.to_string(), || funicular_robot());
        let told: Value = serde_json::from_str(&told).unwrap();
        let issue = &told["issues"][0];
        assert_eq!((status, issue["line"].as_u64()), (BAD_INPUT, Some(7)), "{told}");
        let [from, to] = ["from_byte", "to_byte"].map(|key| usize::try_from(issue[key].as_u64().unwrap()).unwrap());
        assert_eq!(&text[from..to], "-91.058");
        assert!(told["message"].as_str().unwrap().contains("a.toml:7:"), "{told}");
    }

    #[test]
    fn a_refused_pose_says_which_cables_prevent_it() {
        robot(&json!({}));
        let why = |pose: &[f64]| serde_json::from_str::<Value>(&at(pose, 0, 0).2).unwrap()["border"].clone();
        // Above all anchors nothing pulls up; far along x the minimum tensions of the cables behind are too much.
        assert_eq!(why(&[0.0, 0.0, 6.0])["one_sided"], json!(true));
        let along = why(&[6.8, 0.0, 1.5]);
        assert_eq!((&along["code"], &along["one_sided"]), (&json!("tension-limits"), &json!(false)), "{along}");
        assert_eq!((&along["minimum"], &along["maximum"]), (&json!(["2", "3", "4"]), &json!([])), "{along}");
        // Outside of the frame cables would have to push, and no limit is named.
        let outside = why(&[12.0, 0.0, 1.5]);
        assert!(!outside["push"].as_array().unwrap().is_empty() && outside["minimum"] == json!([]), "{outside}");
        assert_eq!(why(&[0.0, f64::NAN, 1.0]), Value::Null);
    }

    #[test]
    fn content_of_files_is_returned_as_json() {
        let map = json!({
            "command": "map", "robot": { "text": ROBOT }, "quantities": ["tension-max", "first-frequency"],
            "poses": [[0.0, 0.0, 1.5, 0.0, 0.0, 0.0], [50.0, 0.0, 1.5, 0.0, 0.0, 0.0]],
        });
        let (status, text) = answered(&map);
        let rows: Value = serde_json::from_str(&text).unwrap();
        assert_eq!(status, RESULTS, "{text}");
        assert_eq!(rows["columns"]["feasible"], json!([true, false]));
        assert!(rows["columns"]["first_frequency_hz"][0].as_f64().unwrap() > 1.0, "{text}");
        assert_eq!(rows["columns"]["tension_max_n"][1], Value::Null);
        assert_eq!(rows["columns"]["status"][0], json!("ok"));

        let (status, text) = answered(&json!({ "command": "new", "cables": 6 }));
        let file = serde_json::from_str::<Value>(&text).unwrap()["text"].as_str().unwrap().to_owned();
        assert_eq!((status, robot(&json!({ "robot": { "text": file } })).0), (RESULTS, RESULTS), "{text}");
        let (status, text) = answered(&json!({ "command": "schema" }));
        assert!(status == RESULTS && text.contains("youngs_modulus_pa"));
        let bad = json!({ "command": "import", "files": [{ "path": "a.txt", "text": "no" }] });
        let (status, text) = answered(&bad);
        assert!(status == BAD_INPUT && text.starts_with("a.txt: it is neither XML"), "{text}");
    }

    #[test]
    fn a_message_about_a_panic_says_what_where_and_what_to_do() {
        let text = message_of(Some("index out of bounds"), Some(Location::caller()));
        assert!(text.contains(": index out of bounds (") && text.contains("lib.rs:"), "{text}");
        assert!(text.contains("please report it with the request"), "{text}");
        assert!(text.ends_with("make a new one"), "{text}");
    }
}

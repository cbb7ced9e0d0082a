//! Front end for WebAssembly: a request in JSON gives results in JSON, or one message.
//!
//! The exported functions are C functions on the memory of the instance, so they need no code generator on either side.
//! A caller gets memory from [`funicular_input`], writes the request there as UTF-8, calls [`funicular_answer`], and
//! reads the text at [`funicular_output`]. `web/funicular.js` does this for JavaScript.
//!
//! The module has no imports: no disk, no clock, no random numbers, no threads.
//!
//! A panic is a mistake in this library. It ends the call with a trap. Afterwards the text says what happened and how
//! to report it. The instance must not be used again: the caller makes a new one.

use funicular_study::wording::Words;
use funicular_study::{Error, ErrorKind, Request, Silent, run};
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

/// Status and text for a request in JSON.
pub fn answer(request: Vec<u8>) -> (u32, Vec<u8>) {
    match results(request) {
        Ok(json) => (RESULTS, json),
        Err((status, message)) => (status, message.into_bytes()),
    }
}

fn results(request: Vec<u8>) -> Result<Vec<u8>, (u32, String)> {
    let request = String::from_utf8(request).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        (BAD_INPUT, format!("the request is not valid UTF-8 at byte {}; write the request as JSON in UTF-8", at + 1))
    })?;
    let answered = Request::from_json(&request).and_then(|request| run(&request, &mut Silent)?.to_json(Words::Json));
    answered.map_err(|error| (status_of(&error), error.message(Words::Json)))
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
            (json!({ "command": "statics", "poze": 1 }), BAD_INPUT, "missing field `robot`"),
            (json!({ "command": "map", "robot": { "text": ROBOT }, "grid": [] }), BAD_INPUT, "`map` writes a file"),
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

    #[test]
    fn a_message_about_a_panic_says_what_where_and_what_to_do() {
        let text = message_of(Some("index out of bounds"), Some(Location::caller()));
        assert!(text.contains(": index out of bounds (") && text.contains("lib.rs:"), "{text}");
        assert!(text.contains("please report it with the request"), "{text}");
        assert!(text.ends_with("make a new one"), "{text}");
    }
}

//! Statuses that the functions return: a number, and a text for people.

use funicular::control_loop::{LoopFault, LoopStatus};

/// Statuses by name, number and text. Those from zero on have a result, and a smaller one is better; with a negative
/// one nothing was written.
macro_rules! statuses {
    ($($name:ident = $number:literal, $text:literal;)*) => {
        $(
            #[doc = $text]
            pub const $name: i32 = $number;
        )*

        /// All statuses: name in the header, number, text.
        pub const ALL: &[(&str, i32, &str)] = &[$((concat!("FN_", stringify!($name)), $number, $text)),*];
    };
}

statuses! {
    CERTIFIED = 0, "certified: balance, limits and certificate hold";
    ACCEPTED = 1, "accepted: balance and limits hold, the certificate is missing";
    BEYOND_LIMITS = 2, "beyond limits: the balance holds with tensions beyond their limits";
    HELD = 3, "held: nothing was found, these are the last certified values";
    BAD_INPUT = -1, "bad input: a number is not finite, larger than 1e9, not positive where it has to be, or a \
        quaternion is off by more than 1e-3";
    BAD_POINTER = -2, "bad pointer: an address is missing or not aligned";
    BAD_STRUCT = -3, "bad struct: struct_size or cables is too small";
    BAD_MODEL = -4, "bad model: the robot file cannot be read; the message says where";
    NOT_FOR_LOOP = -5, "not for a loop: the robot cannot be computed in a control loop; the message says why";
    BAD_MEMORY = -6, "bad memory: too small or not aligned; see fn_loop_bytes";
    BAD_HANDLE = -7, "bad handle: no model or loop is at this address, or it has ended";
    IN_USE = -8, "in use: loops of this model have not ended";
    BUSY = -9, "busy: another thread is in a call with this loop";
    POISONED = -10, "poisoned: an earlier call with this loop failed inside; end the loop and make a new one";
    PANIC = -11, "panic: a mistake in this library; please report it";
    IMPOSSIBLE_POSE = -12, "impossible pose: out of the plane of the platform, or an attachment at its anchor";
    INSIDE_PULLEY = -13, "inside pulley: an attachment is inside the wheel of its pulley";
    LIMITS_CONTRADICT = -14, "limits contradict: a minimum tension is not below its maximum at this pose";
    SINGULAR = -15, "singular: the cables do not oppose every motion at this pose";
    TOO_SLACK = -16, "too slack: a cable cannot have this tension at this pose";
    NOT_FOUND = -17, "not found: no result in the largest number of steps, and none to hold";
    NO_START = -18, "no start: lengths to pose need a pose to start from";
    NO_REST = -19, "no rest: the simulation or the estimator finds no equilibrium to begin at; the message says why";
    REFUSED = -20, "refused: an input, an interval or an event cannot be; the message says why";
    FAILED = -21, "failed: no step can follow the motion; the message says when";
    BAD_STATE = -22, "bad state: these bytes are damaged, or the state of another simulation";
    LOST = -23, "lost: no length has been read for too long, or the readings lead nowhere; restart the estimator";
}

/// Number of a status of the core.
pub(crate) fn of_status(status: LoopStatus) -> i32 {
    match status {
        LoopStatus::Certified => CERTIFIED,
        LoopStatus::Accepted => ACCEPTED,
        LoopStatus::BeyondLimits => BEYOND_LIMITS,
        LoopStatus::Held => HELD,
    }
}

/// Number of a fault of the core.
pub(crate) fn of_fault(fault: LoopFault) -> i32 {
    match fault {
        LoopFault::BadInput => BAD_INPUT,
        LoopFault::ImpossiblePose => IMPOSSIBLE_POSE,
        LoopFault::InsidePulley { .. } => INSIDE_PULLEY,
        LoopFault::LimitsContradict { .. } => LIMITS_CONTRADICT,
        LoopFault::Singular => SINGULAR,
        LoopFault::TooSlack { .. } => TOO_SLACK,
        LoopFault::NotFound => NOT_FOUND,
        LoopFault::NoStart => NO_START,
    }
}

/// Text of a status.
pub(crate) fn text(status: i32) -> &'static str {
    ALL.iter().find(|(_, number, _)| *number == status).map_or("unknown status", |(.., text)| text)
}

//! Files of the commands: what each command reads and writes.
//!
//! [`inputs`] reads the values of keys from files, as the keys declare it. [`outputs`] is the table of files that a
//! command writes besides its result, and [`document`] that of commands whose result is a file itself. [`answer::run`]
//! runs a request of any command that has results. Front ends add the arguments, the text, and the words.

pub mod answer;
pub mod destination;
pub mod document;
pub mod inputs;
mod matrices;
pub mod outputs;

pub use answer::Running;
pub use destination::{Content, Destination};
pub use funicular_study::Stopped;
pub use outputs::{FigureOptions, Output, Written};

//! Requests and results of funicular as plain data.
//!
//! A [`Request`] contains everything about one analysis: the command, the text of the robot file, its changes, state,
//! loads, limits and models. [`run`] answers it with [`Results`]. Both are serde data with one vocabulary: the keys
//! have the same names as the program's options, Python's keywords and the plan inside the file of a sweep. The front
//! ends (program, Python package, browser) convert their input to a request and the results to their output. They make
//! no decisions themselves.
//!
//! This crate uses no disk and no threads, and it compiles for WebAssembly. Files of other programs are read and
//! written by the crate `funicular-formats`, pages and figures are made by `funicular-pages`.
//!
//! # Example
//! ```
//! use funicular_study::{Request, Results, Silent, run};
//!
//! let text = funicular_robots::COGIRO;
//! let request = serde_json::json!({
//!     "command": "statics",
//!     "robot": {"name": "cogiro", "text": text},
//!     "pose": [1.0, 2.0, 1.5],
//!     "max_tension_n": 1200.0,
//!     "tension_rule": "middle",
//! });
//! let request = Request::from_json(&request.to_string())?;
//! let Results::Statics(found) = run(&request, &mut Silent)? else { panic!("statics was requested") };
//! assert!(found.cables.iter().all(|cable| cable.tension_platform_n < 1200.0));
//! # Ok::<(), funicular_study::Error>(())
//! ```

#[expect(missing_docs, reason = "fields are the keys of the JSON: quantity and unit are their names")]
pub mod analyses;
pub mod at_rest;
mod chosen_numbers;
pub mod columns;
mod differenced_goals;
mod error;
pub mod frequency_range;
pub mod json;
mod measure;
pub mod measurements;
pub mod names;
mod normal;
mod parameter_pattern;
mod payload;
mod quantiles;
pub mod reading_table;
mod refused;
pub mod request;
pub mod robot_file;
pub mod rows;
mod run;
pub mod schema;
pub mod set_values;
pub mod shared_ropes;
pub mod signals;
pub mod sweep;
pub mod table;
mod table_fault;
pub mod text;
pub mod units;
pub mod values;
mod watch;
pub mod wording;
pub mod written;

pub use error::{Cancelled, Error, ErrorKind, NoSolution, Stopped};
pub use request::Request;
pub use run::{Results, run, run_at, run_on};
pub use table_fault::TableFault;
pub use watch::{Silent, Watch};

/// Example of README.md, which is tested like those of the documentation.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

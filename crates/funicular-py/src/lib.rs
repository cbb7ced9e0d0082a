//! The Python package `funicular`: the core's robots, equilibria, modes and responses as Python classes over NumPy
//! arrays.
//!
//! This crate computes nothing. A method reads its arguments, calls the core without holding Python's lock, and returns
//! arrays that own the results of the core. Tables, HTML and plots need no core and are in `python/funicular`.

#![allow(clippy::needless_pass_by_value, reason = "PyO3 hands arguments over by value")]

mod analyses;
mod answered;
mod answers;
mod arrays;
mod batch;
mod catenary;
mod dict_to_toml;
mod elements;
mod equilibrium;
mod errors;
mod estimator;
mod interrupt;
mod labels;
mod pose;
mod reading;
mod request;
mod robot;
mod robot_text;
mod simulation;
mod sweep;
mod texts;
mod threads;
mod vibration;
mod written;

use pyo3::prelude::*;

/// Compiled half of `funicular`; import `funicular` instead.
#[pymodule]
mod _funicular {
    #[pymodule_export]
    use crate::analyses::PyAnalyses;
    #[pymodule_export]
    use crate::answered::{PyAnswered, check_files, outputs_of_commands};
    #[pymodule_export]
    use crate::answers::{
        answer, complete_request, figure_sizes, imported, measurements_of_file, merge_parts, plot_page, source_file,
        text_of, try_file, write_file,
    };
    #[pymodule_export]
    use crate::arrays::{complex_numbers, real_numbers};
    #[pymodule_export]
    use crate::catenary::Catenary;
    #[pymodule_export]
    use crate::equilibrium::PyEquilibrium;
    #[pymodule_export]
    use crate::errors::shown;
    #[pymodule_export]
    use crate::estimator::PyEstimator;
    #[pymodule_export]
    use crate::pose::PyPose;
    #[pymodule_export]
    use crate::reading::{argument, declarations, interval, number, numbers, suggested, unit_of_name};
    #[pymodule_export]
    use crate::robot::{PyRobot, library, robot_of_source};
    #[pymodule_export]
    use crate::simulation::PySimulation;
    #[pymodule_export]
    use crate::sweep::{PyPlan, PyTable, PyWork};
    #[pymodule_export]
    use crate::vibration::peaks;
    #[pymodule_export]
    use crate::written::matlab_file;
    #[pymodule_export]
    use crate::written::write_unit;

    #[pymodule_export]
    #[expect(non_upper_case_globals, reason = "Python's name of a version")]
    const __version__: &str = env!("CARGO_PKG_VERSION");
}

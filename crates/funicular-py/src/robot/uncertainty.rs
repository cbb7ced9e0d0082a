//! Deviations of results from deviations of numbers of the robot file.

use super::PyRobot;
use crate::answered::PyAnswered;
use crate::arrays::{Count, Number, Numbers};
use crate::errors;
use crate::interrupt::interruptible_by_flag;
use crate::pose::PoseLike;
use crate::reading::sizes;
use crate::request::{StateKeywords, TensionKeywords, model, named, points};
use crate::sweep::{self, ProgressArgument};
use crate::texts::{Texts, not_empty};
use crate::threads::Threads;
use crate::written::UncertaintyObject;
use funicular_files::{Begin, UncertaintyOutcome, UncertaintyRun};
use funicular_study::Results;
use funicular_study::analyses::uncertainty::{SAMPLES, UncertaintyStudy};
use funicular_study::request::{self, DEFAULT_SAMPLES, Request, UncertaintyRequest};
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use std::path::PathBuf;

const SAMPLES_RULE: &str = "give a whole number from 10 to 1000000";

#[pymethods]
impl PyRobot {
    /// Computes the deviations of results from deviations or tolerances of numbers of the robot file.
    ///
    /// Results are linear in the deviations where no cable may become slack and no frequencies may cross; elsewhere
    /// robots are sampled, on all processors. docs/uncertainty.md explains the result. Theory, section "Uncertainty".
    ///
    /// Parameters
    /// ----------
    /// deviations
    ///     Standard deviations of normally distributed numbers: a mapping from paths to values in the unit of the
    ///     number, or to percentages such as "1%"; or a list of texts such as "platform.mass_kg=1%". In a path * stands
    ///     for any key. Each entry is a group with a share of its own.
    /// tolerances
    ///     Tolerances of numbers that are anywhere within ± their tolerance, in the same form.
    /// of
    ///     Results: `pose`, `lengths`, `tensions`, `stiffness-min`, `frequencies`, `damping`, `response`; the first and
    ///     the third if not given.
    /// hold
    ///     What stays while the numbers deviate: `lengths`, `pose`, or `rule` (the pose and the rule of the tensions).
    /// below_hz
    ///     Upper limit of the frequencies [Hz]; for frequencies and damping.
    /// at_hz, input, output, input_point_m, output_point_m
    ///     Frequencies [Hz], one or several, signals and points of the response. Results are its magnitudes in decibels
    ///     of its unit, and its phases in degrees.
    /// poses
    ///     Several poses, (n, 3) or (n, 6): x, y, z [m], roll, pitch, yaw [degrees].
    /// method
    ///     `automatic`, `linear` or `sampled`.
    /// samples, seed
    ///     Number of sampled robots per pose, 200 if not given, and a number that chooses another sample; 0 if not given.
    /// samples_file, resume, discard
    ///     File of the sampled robots, .parquet or .csv: FILE.partial holds them until all are there, and `resume`
    ///     continues with them.
    /// threads
    ///     Number of threads of this process; one per processor if not given.
    /// progress
    ///     Function that is called with the number of finished items and of all items.
    ///
    /// The other parameters are those of `equilibrium` and of `modes`.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     A path, a deviation or another argument is wrong; the message says which and what to give.
    /// StaticsError
    ///     The robot has no equilibrium.
    /// FileError
    ///     The file of the samples cannot be written, or belongs to other work.
    #[pyo3(signature = (
        deviations=None, tolerances=None, of=None, *, hold="lengths", below_hz=None, at_hz=None, input=None,
        output=None, input_point_m=None, output_point_m=None, poses=None, method="automatic", samples=None, seed=None,
        pose=None, lengths_m=None, static_model="catenary", cable_model=None, assembly="consistent",
        in_plane_only=false, winches="as-given", tension_rule=None, target_tension_n=None,
        min_tension_n=None, max_tension_n=None, mass_kg=None, force_n=None, moment_n_m=None, load_point_m=None,
        wind_m_s=None, cable_load_n_per_m=None, hold_lengths_of_pose=false, samples_file=None, resume=false,
        discard=false, threads=None, progress=None
    ))]
    #[expect(clippy::too_many_arguments, clippy::fn_params_excessive_bools, reason = "Python's keywords")]
    fn uncertainty(
        &self,
        py: Python<'_>,
        deviations: Option<Bound<'_, PyAny>>,
        tolerances: Option<Bound<'_, PyAny>>,
        of: Option<Texts>,
        hold: &str,
        below_hz: Option<Number>,
        at_hz: Option<Numbers>,
        input: Option<String>,
        output: Option<String>,
        input_point_m: Option<Numbers>,
        output_point_m: Option<Numbers>,
        poses: Option<Numbers>,
        method: &str,
        samples: Option<Count>,
        seed: Option<Count>,
        pose: Option<PoseLike>,
        lengths_m: Option<Numbers>,
        static_model: &str,
        cable_model: Option<&str>,
        assembly: &str,
        in_plane_only: bool,
        winches: &str,
        tension_rule: Option<&str>,
        target_tension_n: Option<Numbers>,
        min_tension_n: Option<Number>,
        max_tension_n: Option<Number>,
        mass_kg: Option<Number>,
        force_n: Option<Numbers>,
        moment_n_m: Option<Numbers>,
        load_point_m: Option<Numbers>,
        wind_m_s: Option<Numbers>,
        cable_load_n_per_m: Option<Numbers>,
        hold_lengths_of_pose: bool,
        samples_file: Option<PathBuf>,
        resume: bool,
        discard: bool,
        threads: Option<Threads>,
        progress: Option<ProgressArgument>,
    ) -> PyResult<UncertaintyObject> {
        let state = StateKeywords {
            pose,
            lengths_m,
            hold_lengths_of_pose,
            mass_kg,
            static_model,
            force_n,
            moment_n_m,
            load_point_m,
            wind_m_s,
            cable_load_n_per_m,
        };
        let cables = self.names();
        let request = UncertaintyRequest {
            robot: self.source.clone(),
            of: not_empty(of, "of")?.unwrap_or_else(request::pose_and_tensions),
            deviations: deviations.map_or_else(|| Ok(Vec::new()), |given| sizes("deviations", &given))?,
            tolerances: tolerances.map_or_else(|| Ok(Vec::new()), |given| sizes("tolerances", &given))?,
            hold: named("hold", hold)?,
            method: named("method", method)?,
            samples: samples.map_or(Ok(DEFAULT_SAMPLES), |samples| samples.within("samples", SAMPLES, SAMPLES_RULE))?,
            seed: seed.map_or(Ok(0), |seed| seed.within_u32("seed"))?,
            below_hz: below_hz.map(|hz| hz.value("below_hz")).transpose()?,
            at_hz: at_hz.map(|hz| hz.frequencies_of("at_hz")).transpose()?.map(|(hz, _)| hz),
            input,
            output,
            points: points(input_point_m, output_point_m)?,
            poses: poses.map(sweep::poses).transpose()?,
            state: state.request(&cables)?,
            tensions: TensionKeywords { tension_rule, target_tension_n, min_tension_n, max_tension_n }
                .request(&cables)?,
            model: model(cable_model, assembly, in_plane_only, winches)?,
        };
        let samples = samples_file.map(|path| (path, begin(resume, discard)));
        if samples.is_none() && (resume || discard) {
            return Err(errors::input("`resume` and `discard` need `samples_file`".to_owned()));
        }
        if resume && discard {
            return Err(errors::input("give `resume` or `discard`, not both: one keeps the robots".to_owned()));
        }
        computed(py, request, samples, threads, progress)
    }
}

/// Beginning of the work on a file of samples.
fn begin(resume: bool, discard: bool) -> Begin {
    match (resume, discard) {
        (true, _) => Begin::Resume,
        (_, true) => Begin::Discard,
        _ => Begin::Anew,
    }
}

/// Computes a request on all threads, with calls of `progress`.
fn computed(
    py: Python<'_>,
    request: UncertaintyRequest,
    samples: Option<(PathBuf, Begin)>,
    threads: Option<Threads>,
    progress: Option<ProgressArgument>,
) -> PyResult<UncertaintyObject> {
    let threads = Threads::of(threads);
    let asked = Request::Uncertainty(request.clone());
    let outcome = interruptible_by_flag(py, move |cancel| {
        let study = UncertaintyStudy::new(&request)?;
        let samples = samples.as_ref().map(|(path, begin)| (path.as_path(), *begin));
        let mut raised = None;
        let mut report = |done: usize, total: usize, _: &'static str| {
            if let (Some(ProgressArgument(function)), None) = (&progress, &raised) {
                raised = Python::attach(|py| function.call1(py, (done, total)).err());
            }
        };
        let outcome = UncertaintyRun { threads, samples, cancel }.run(&study, &mut report)?;
        Ok::<_, anyhow::Error>((outcome, raised))
    })?;

    let (outcome, raised) = outcome.map_err(|error| errors::study(&error))?;
    if let Some(raised) = raised {
        return Err(raised);
    }
    match outcome {
        UncertaintyOutcome::Complete(found) => {
            let answered = PyAnswered::new(asked, Results::Uncertainty(*found));
            let made = py.import("funicular._uncertainty")?.call_method1("uncertainty", (answered,))?;
            Ok(UncertaintyObject(made.unbind()))
        }
        // Only Ctrl-C stops the work, and its exception has been raised before.
        UncertaintyOutcome::Stopped(reason) => Err(PyKeyboardInterrupt::new_err(reason)),
    }
}

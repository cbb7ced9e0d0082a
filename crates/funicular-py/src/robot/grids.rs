//! Methods about many poses and values: `map` and `sweep`.

use super::PyRobot;
use crate::arrays::{Count, Number, Numbers};
use crate::pose::PoseLike;
use crate::request::{StateKeywords, TensionKeywords, model};
use crate::sweep::{self, Axes, ExecutorArgument, ProgressArgument, PyPlan, RunKeywords, SweepObject};
use crate::texts::Texts;
use crate::threads::Threads;
use funicular_study::request::{MapRequest, Request, SweepRequest};
use pyo3::prelude::*;
use std::path::PathBuf;

#[pymethods]
impl PyRobot {
    /// Computes quantities over poses, one row per pose.
    ///
    /// The rows are those of the program's `map`, bit for bit, with any number of threads or workers. A pose without
    /// equilibrium is a row with its reason, never an exception.
    ///
    /// Parameters
    /// ----------
    /// grid
    ///     Axes of a grid of poses: x, y, z [m], roll, pitch, yaw [degrees], as in `{"x": (-4, 4, 81), "z": [0.5, 1,
    ///     2]}`. A tuple is the first value, the last value and their number; anything else is values. x varies
    ///     fastest, then y.
    /// quantities
    ///     What is computed at every point; docs/sweeps.md has the list; `tension-min` and `tension-max` if not given.
    /// poses
    ///     Poses instead of a grid, (n, 3) or (n, 6): x, y, z [m], roll, pitch, yaw [degrees].
    /// pose, lengths_m
    ///     Values of the axes that the grid does not have: x, y, z [m], roll, pitch, yaw [degrees], or the pose of
    ///     unstrained lengths [m]; the state of the robot file if not given.
    /// up_to_hz
    ///     Limit of the search for natural frequencies [Hz]; 1000 if not given.
    /// platform_share
    ///     Minimum fraction of the kinetic energy in the platform for `first-platform-frequency`; 0.5 if not given.
    /// payload_center_m
    ///     Centre of mass of the payload for `payload-max`, platform frame [m]; that of the platform if not given.
    /// file
    ///     File of the rows: .parquet, .csv or .vti. It is written when all rows are there; until then FILE.partial
    ///     holds them, also after a crash. The rows of a Parquet file are read into memory at their first use.
    /// resume, discard
    ///     Continue with the rows of the same sweep in FILE.partial, or delete them.
    /// part
    ///     Part k of n, as in "3/8"; each part has its own Parquet `file`, and `funicular.merge` joins them.
    /// threads
    ///     Number of threads of this process; one per processor if not given.
    /// executor
    ///     Executor whose workers compute (`concurrent.futures`, Dask's `Client.get_executor()`, mpi4py's
    ///     `MPIPoolExecutor`), or a function that makes an executor and is called again when the executor breaks.
    /// chunks_per_task
    ///     Number of chunks of rows that a worker gets at once; chosen from measured times if not given.
    /// progress
    ///     Function that is called with the number of finished rows and the number of all rows.
    ///
    /// The other parameters are those of `equilibrium` and `modes`.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     An argument is wrong; the message says which and what to give.
    /// FileError
    ///     The file cannot be written, or belongs to another sweep.
    /// ExecutorError
    ///     The executor's workers died; `resume` of the exception continues.
    ///
    /// Warns
    /// -----
    /// RobotWarning
    ///     The robot has a value that no usual robot has; once per call, before the rows are computed.
    #[pyo3(signature = (
        grid=None, quantities=None, *, poses=None, pose=None, lengths_m=None, static_model="catenary",
        cable_model=None, assembly="consistent", in_plane_only=false, winches="as-given", up_to_hz=None,
        platform_share=None, payload_center_m=None, tension_rule=None, target_tension_n=None, min_tension_n=None,
        max_tension_n=None, mass_kg=None, force_n=None, moment_n_m=None, load_point_m=None, wind_m_s=None,
        cable_load_n_per_m=None, hold_lengths_of_pose=false, file=None, resume=false, discard=false, part=None,
        threads=None, executor=None, chunks_per_task=None, progress=None
    ))]
    #[expect(clippy::too_many_arguments, clippy::fn_params_excessive_bools, reason = "Python\'s keywords")]
    fn map(
        &self,
        py: Python<'_>,
        grid: Option<Axes>,
        quantities: Option<Texts>,
        poses: Option<Numbers>,
        pose: Option<PoseLike>,
        lengths_m: Option<Numbers>,
        static_model: &str,
        cable_model: Option<&str>,
        assembly: &str,
        in_plane_only: bool,
        winches: &str,
        up_to_hz: Option<Number>,
        platform_share: Option<Number>,
        payload_center_m: Option<Numbers>,
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
        file: Option<PathBuf>,
        resume: bool,
        discard: bool,
        part: Option<String>,
        threads: Option<Threads>,
        executor: Option<ExecutorArgument>,
        chunks_per_task: Option<Count>,
        progress: Option<ProgressArgument>,
    ) -> PyResult<SweepObject> {
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

        let tensions = TensionKeywords { tension_rule, target_tension_n, min_tension_n, max_tension_n };
        let cables = &self.names();
        let model = model(cable_model, assembly, in_plane_only, winches)?;
        let point = sweep::each_point(
            quantities,
            up_to_hz,
            platform_share,
            payload_center_m,
            state.request(cables)?,
            tensions.request(cables)?,
            model,
        )?;
        let grid = grid.map_or_else(Vec::new, |Axes(axes)| axes);
        let poses = poses.map(sweep::poses).transpose()?;
        let request = Request::Map(MapRequest { robot: self.source.clone(), grid, poses, point });

        let plan = PyPlan::of(py, request, part)?;
        RunKeywords { file, resume, discard, threads, executor, chunks_per_task, progress }.rows(py, plan)
    }

    /// Computes quantities over values of the robot file, one row per combination, as the program's `sweep`.
    ///
    /// Parameters
    /// ----------
    /// vary
    ///     Values of the robot file that vary, by their paths as in `with_`: `{"platform.mass_kg": (10, 90, 81)}`. A
    ///     tuple is the first value, the last value and their number; anything else is values. The first path varies
    ///     fastest. `*` for any key moves all numbers that match together: `{"cables.*.anchor_m.z": (5, 6, 3)}`.
    ///
    /// The other parameters are those of `map`.
    #[pyo3(signature = (
        vary, quantities=None, *, pose=None, lengths_m=None, static_model="catenary", cable_model=None,
        assembly="consistent", in_plane_only=false, winches="as-given", up_to_hz=None, platform_share=None,
        payload_center_m=None, tension_rule=None, target_tension_n=None, min_tension_n=None, max_tension_n=None,
        mass_kg=None, force_n=None, moment_n_m=None, load_point_m=None, wind_m_s=None, cable_load_n_per_m=None,
        hold_lengths_of_pose=false, file=None, resume=false, discard=false, part=None, threads=None, executor=None,
        chunks_per_task=None, progress=None
    ))]
    #[expect(clippy::too_many_arguments, clippy::fn_params_excessive_bools, reason = "Python\'s keywords")]
    fn sweep(
        &self,
        py: Python<'_>,
        vary: Axes,
        quantities: Option<Texts>,
        pose: Option<PoseLike>,
        lengths_m: Option<Numbers>,
        static_model: &str,
        cable_model: Option<&str>,
        assembly: &str,
        in_plane_only: bool,
        winches: &str,
        up_to_hz: Option<Number>,
        platform_share: Option<Number>,
        payload_center_m: Option<Numbers>,
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
        file: Option<PathBuf>,
        resume: bool,
        discard: bool,
        part: Option<String>,
        threads: Option<Threads>,
        executor: Option<ExecutorArgument>,
        chunks_per_task: Option<Count>,
        progress: Option<ProgressArgument>,
    ) -> PyResult<SweepObject> {
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

        let tensions = TensionKeywords { tension_rule, target_tension_n, min_tension_n, max_tension_n };
        let cables = &self.names();
        let model = model(cable_model, assembly, in_plane_only, winches)?;
        let point = sweep::each_point(
            quantities,
            up_to_hz,
            platform_share,
            payload_center_m,
            state.request(cables)?,
            tensions.request(cables)?,
            model,
        )?;
        let request = Request::Sweep(SweepRequest { robot: self.source.clone(), vary: vary.0, point });

        let plan = PyPlan::of(py, request, part)?;
        RunKeywords { file, resume, discard, threads, executor, chunks_per_task, progress }.rows(py, plan)
    }
}

"""
Compiled half of `funicular`; import `funicular` instead.
"""

from _typeshed import SupportsGetItem, SupportsLenAndGetItem
from collections.abc import Callable
from concurrent.futures import Executor
from funicular._results import Equilibria, Results
from funicular._sweeps import Sweep
from numpy import complex128, float64
from numpy.typing import ArrayLike, NDArray
from os import PathLike
from pathlib import Path
from typing import Any, Final, SupportsFloat, SupportsIndex, final
from typing_extensions import disjoint_base
from collections.abc import Mapping, Sequence
from funicular._design import Designed
from funicular._identify import Identified
from funicular._live import Live
from funicular._pages import Page
from funicular._results import Modes, ReducedModel, StateSpaceModel
from funicular._uncertainty import Uncertainty
from funicular._words import StaticModel, TensionRule, CableModel, Assembly, Winches, Hold, Per, Method, Goal, ExportFormat, Result
from funicular.results import CableResults, CalibrateResults, ClearanceResults, CompareResults, EstimateResults, GradientResults, GustResults, LoadsResults, ObservabilityResults, PayloadResults, PoseErrorResults, ProveResults, SettleResults, SimulateResults, SpeedsResults, TrajectoryResults, WinchesResults, WorkspaceResults
from typing import Literal, overload

__all__ = ["__version__", "Analyses", "Answered", "Catenary", "Equilibrium", "Estimator", "Pose", "Robot", "Simulation", "SweepPlan", "SweepTable", "SweepWork", "answer", "argument", "check_files", "complete_request", "complex_numbers", "declarations", "figure_sizes", "imported", "interval", "library", "matlab_file", "measurements_of_file", "merge_parts", "number", "numbers", "outputs_of_commands", "peaks", "plot_page", "real_numbers", "robot_of_source", "shown", "source_file", "suggested", "text_of", "try_file", "unit_of_name", "write_file", "write_unit"]

__version__: Final[str]

@disjoint_base
class Analyses:
    """
    Analyses of a robot at an equilibrium: the methods that `Equilibrium` and `Robot` share.

    Those of `Robot` analyse the equilibrium in the state of the robot file, which every call computes again.
    """
    def all_equilibria(self, /) -> Results:
        """
        Searches for all equilibria of the unstrained lengths of the equilibrium.

        Returns
        -------
        The keys of the program's JSON. `equilibria` lists the solutions, the lowest first, each with `pose`, `stable`,
        `energy_j`, `distance_m` and `tensions_platform_n`; `search` describes the search. Lists of numbers are arrays.
        """
    def friction_interval(self, /) -> Results:
        """
        Computes the interval in which friction of pulleys leaves pose and tensions.

        Every cable may have run last towards the platform or towards its drum. If the lengths are given or held, pose
        and tensions vary; if the pose is given, the tensions at the drums and the lengths vary.

        Returns
        -------
        The keys of the program's JSON. `friction_interval` has `held`, which is `lengths` or `pose`; with lengths held
        `translation_m` (3, 2) and `rotation_deg` (3, 2), the rotation vector, both in world axes; and `cables`, each
        with `friction_exponent`, `excess_length_m`, `tension_platform_n`, `tension_anchor_n` and `tension_drum_n`.
        Pairs are minimum and maximum. Theory (71) to (74).

        Raises
        ------
        InputError
            No cable runs over a pulley with friction.
        NoSolutionError
            The equilibrium is indifferent.
        """
    def cable(self, /, name: str, hz: ArrayLike, *, cable_model: CableModel | None = None, in_plane_only: bool = False, winches: Winches = "as-given") -> CableResults:
        """
        Computes the dynamic stiffness of the platform end of one cable with a fixed anchor.

        Parameters
        ----------
        name
            Name of a cable.
        hz
            Frequencies [Hz], a row of n.

        The other parameters are those of `Equilibrium.stiffness`.

        Returns
        -------
        The keys of the program's JSON. `local` has `k_a`, `k_b`, `k_c`, `k_o` (n, complex): along the chord, coupling,
        normal in plane, out of plane [N/m]. `world` is (n, 3, 3), complex, in world axes. `clamped_frequencies_hz` are
        the natural frequencies of the cable with both ends fixed.
        """
    def compare(self, /, below_hz: SupportsFloat | SupportsIndex, *, platform: bool = False, platform_share: SupportsFloat | SupportsIndex | None = None, tolerance: SupportsFloat | SupportsIndex | None = None, assembly: Assembly = "consistent", in_plane_only: bool = False, winches: Winches = "as-given", figure: str | PathLike[str] | None = None) -> CompareResults:
        """
        Compares every cable model with the catenary-dynamic model: frequencies found, missed and wrong, and the
        recommended model.

        Parameters
        ----------
        below_hz
            Upper limit of the frequencies [Hz].
        platform
            Compare the modes of the platform alone.
        platform_share
            Minimum fraction of the kinetic energy in the platform for a mode that counts as a mode of the platform; 0.5
            if not given.
        tolerance
            Maximum relative difference of frequency for a model that is good enough; 0.01 if not given.
        figure
            Draw the differences between the cable models (.svg, .pdf).

        The other parameters are those of `Equilibrium.stiffness`.

        Returns
        -------
        The keys of the program's JSON; lists of numbers are arrays.
        """
    def export(self, /, to: ExportFormat, path: str | PathLike[str], *, segments: SupportsIndex | None = None, cable_pieces: SupportsIndex | None = None, modes_below_hz: SupportsFloat | SupportsIndex | None = None, scenario: Any = None, duration_s: SupportsFloat | SupportsIndex | None = None, within: Mapping[str, ArrayLike] | None = None, tolerance_m: SupportsFloat | SupportsIndex | None = None, prefix: str | None = None) -> list[str]:
        """
        Writes the equilibrium as a file of another program; returns the caveats of the file.

        Parameters
        ----------
        to
            Program that the file is for: `opensees` (python script for OpenSeesPy); `moordyn` (input file of version
            2); `mujoco` (model in MJCF, with winches as actuators); `sdf` (world of Gazebo, whose cables Drake reads as
            springs); `urdf` (frame and platform for viewers); `vtk` (vTK XML of polylines and polygons (.vtp), for
            ParaView); `c` (table of lengths over a box of poses as a C99 file, for firmware); `json` (table of lengths
            over a box of poses in JSON, for firmware that reads its numbers); `fmu` (robot in motion as a Functional
            Mock-up Unit 2.0 for co-simulation); `fmu3` (robot in motion as a Functional Mock-up Unit 3.0 for co-
            simulation).
        path
            Path of the file, which is complete or absent.
        segments
            Elements per cable, 1 to 1000: bars in OpenSees, segments in MoorDyn, pieces of a curve in VTK; 20 if not
            given.
        cable_pieces
            Pieces of each cable in MuJoCo, 2 to 100: a chain of bars that has the mass, the sag and the vibration of
            the cable. Without it cables are straight and have no mass; if not given: straight cables without mass.
        modes_below_hz
            Upper limit of the frequencies of modes in the file [Hz]: in VTK one field per mode, in OpenSees the modes
            to compare with; if not given: no modes in VTK, the first ten in OpenSees.
        scenario
            Events for MoorDyn, as `Robot.simulate` takes them: `release` from rest, `lengths`, `stop`, `cut`. The file is
            then a Python script that runs MoorDyn.
        duration_s
            Time that MoorDyn simulates with `scenario` [s]; if not given: 10 with a scenario.
        within
            Side of the box of poses for C and JSON: x, y, z [m], roll, pitch, yaw [degrees] from A to B, or at one
            value (repeatable); an axis that is not given keeps the value of `pose` or of the pose of the robot's state.
        tolerance_m
            Largest error of a length in the box [m]; in a unit, the error of a position that one step may have; if not
            given: 1e-4, 1e-7 in a unit.
        prefix
            Beginning of all names in the C file; if not given: from the name of the robot file.

        Raises
        ------
        FileError
            The file cannot be written.
        """
    @overload
    def frf(self, /, hz: ArrayLike | None = None, input: str | Sequence[str] | None = None, output: str | Sequence[str] | None = None, *, adaptive: Literal[False] = False, input_point_m: ArrayLike | None = None, output_point_m: ArrayLike | None = None, cable_model: CableModel | None = None, assembly: Assembly = "consistent", in_plane_only: bool = False, winches: Winches = "as-given") -> NDArray[complex128]: ...
    @overload
    def frf(self, /, hz: ArrayLike | None = None, input: str | Sequence[str] | None = None, output: str | Sequence[str] | None = None, *, adaptive: Literal[True], input_point_m: ArrayLike | None = None, output_point_m: ArrayLike | None = None, cable_model: CableModel | None = None, assembly: Assembly = "consistent", in_plane_only: bool = False, winches: Winches = "as-given") -> tuple[NDArray[float64], NDArray[complex128]]: ...
    @overload
    def frf(self, /, hz: ArrayLike | None = None, input: str | Sequence[str] | None = None, output: str | Sequence[str] | None = None, *, adaptive: bool, input_point_m: ArrayLike | None = None, output_point_m: ArrayLike | None = None, cable_model: CableModel | None = None, assembly: Assembly = "consistent", in_plane_only: bool = False, winches: Winches = "as-given") -> NDArray[complex128] | tuple[NDArray[float64], NDArray[complex128]]:
        """
        Computes frequency responses: complex, for e^{+iωt}, in units of output per input.

        Parameters
        ----------
        hz
            Frequencies [Hz], a row of n. With `adaptive` it may be left out: from 0 to above the 20 lowest natural
            frequencies and the first mode of the platform.
        input
            Input signal: force `fx`, `fy`, `fz`, moment `mx`, `my`, `mz`, or `f:ux,uy,uz`, `m:ux,uy,uz` along a
            direction, in world axes; a force on a cable, as in `cable:3@0.5:fz`; the commanded length of a cable, a
            force of its motor or on its drum, as in `length:3`, `motor:3`, `drum:3`; or a motion of the base, `base-x`
            to `base-rz`, or of an anchor, as in `anchor:3:x`. A list names several; `fz` if not given.
        output
            Output signal: displacement `x`, `y`, `z`, rotation `rx`, `ry`, `rz`, with `v` (velocity) or `a`
            (acceleration) before it, or `x:ux,uy,uz`, `v:…`, `a:…` along a direction; a point of a cable, as in
            `cable:3@0.5:az`; or the motion of a drum or motor, or the tension of a cable at the platform or at its
            drum, as in `drum:3`, `motor:3`, `tension:3`, `drum-tension:3`. A list names several; `az` if not given.
        adaptive
            Add frequencies between those in `hz`, which ascend, until every peak has its height (to 0.1 %) and straight
            lines over the logarithm of the magnitude are accurate to 1 %. At undamped natural frequencies, where the
            response has no bound, there is a gap of 5e-5 of the frequency on either side.
        input_point_m, output_point_m
            Point where the forces act and point whose motion is measured, platform frame [m]; the origin if not given.

        The other parameters are those of `Equilibrium.stiffness`.

        Returns
        -------
        (n,) for one input and one output; (outputs, inputs, n) if `input` or `output` is a list. With `adaptive` a
        pair: the chosen frequencies [Hz] (n,), and the responses at them.

        Raises
        ------
        ResponseError
            One of the frequencies is an undamped natural frequency.

        Warns
        -----
        ResponseWarning
            At least ten frequencies ascend, and peaks between them are read more than 5 % too low.
        """
    def gradient(self, /, of: Result | Sequence[Result] | None = None, *, by: str | Sequence[str] | None = None, hold: Hold = "lengths", per: Per = "unit", tolerances: Any = None, below_hz: SupportsFloat | SupportsIndex | None = None, at_hz: SupportsFloat | SupportsIndex | None = None, input: str | None = None, output: str | None = None, input_point_m: ArrayLike | None = None, output_point_m: ArrayLike | None = None, cable_model: CableModel | None = None, assembly: Assembly = "consistent", in_plane_only: bool = False, winches: Winches = "as-given") -> GradientResults:
        """
        Computes derivatives of results by numbers of the robot file, without perturbing any.

        Parameters
        ----------
        of
            Results, separated by commas: pose, lengths, tensions, rope-length, rope-mass, stiffness-min, load-factor,
            frequencies, damping, response; frequencies if not given.
        by
            Paths of the numbers, as `Robot.parameters` lists them; `*` stands for any key, as in `cables.*.anchor_m`,
            and a path to a table or vector for all numbers in it. All numbers if not given.
        hold
            Held while a number changes: the unstrained `lengths`, so that the pose follows, or the `pose`, so that the
            lengths follow. Of more cables than degrees of freedom the tensions parallel to the chords then change
            least. `rule`: as `pose`, but the tensions go on to follow the rule that has chosen them (not `stiffest`).
        per
            Unit of the derivatives: per unit, percent or tolerance of each number: `unit` (unit of the number);
            `percent` (percent of its value); `tolerance` (tolerance of the number).
        tolerances
            Tolerances: a mapping from paths to values or percentages, or texts such as `platform.mass_kg=1%` or
            `cables.*.anchor_m=0.002`. If not given: 1 mm for positions and lengths, 0.1° for angles, 1 % of other values.
        below_hz
            Upper limit of the frequencies [Hz]; for frequencies and damping.
        at_hz, input, output, input_point_m, output_point_m
            Frequency [Hz], signals and points of the `response`, as in `frf`; signals on the platform.

        The other parameters are those of `Equilibrium.stiffness`.

        Returns
        -------
        The keys of the program's JSON. `parameters` lists the numbers, each with `path`, `value`, `unit` and
        `tolerance`; `results` the results, each with `name`, `unit`, `value` and the array `derivatives` (parameters,).
        `held_means` says what is held. Modes that share a frequency have a block, `block_entry`. `refused` has the
        results without a gradient and the reasons. Theory, section 17.

        Raises
        ------
        InputError
            The robot has ideal cables, or a path that no number has.
        NoSolutionError
            A cable is slack, or the equilibrium indifferent: it has no derivatives.
        """
    def gust(self, /, output: str | Sequence[str] | None = None, *, output_point_m: ArrayLike | None = None, duration_s: SupportsFloat | SupportsIndex | None = None, below_hz: SupportsFloat | SupportsIndex | None = None, spectrum: str | PathLike[str] | Mapping[str, ArrayLike] | None = None, turbulence: Literal['kaimal', 'von-karman'] | None = None, intensity: ArrayLike | None = None, length_scale_m: ArrayLike | None = None, coherence_decay: ArrayLike | None = None, cable_model: CableModel | None = None, assembly: Assembly = "consistent", in_plane_only: bool = False, winches: Winches = "as-given", figure: str | PathLike[str] | None = None) -> GustResults:
        """
        Computes the response to turbulent wind: r.m.s. values and expected peaks of motions and tensions, with their
        spectra.

        The drag is linear about the mean wind of the equilibrium, and its damping is included. Motions are about that
        equilibrium.

        Parameters
        ----------
        output
            Output, see `frf`: a motion of the platform or of a point on a cable, or the tension at the platform,
            tension:3 (repeatable); if not given: all displacements and rotations of the platform, and all tensions.
        output_point_m
            Point of the platform whose motion is measured, platform frame [m]; if not given: the origin.
        duration_s
            Time for which the mean wind lasts, and in which peaks are expected [s]; 600 if not given.
        below_hz
            Upper limit of the frequencies [Hz]; faster gusts are left out; if not given: above all modes of the
            platform.
        spectrum
            Measured spectra of the gusts in place of `turbulence`, one-sided: columns frequency_hz, and along_m2_s,
            lateral_m2_s and up_m2_s [m²/s² per Hz], straight between the rows and constant below the first. With
            `intensity` their integrals are compared with it.
        turbulence
            Spectrum of the gusts: `kaimal` (kaimal, as in IEC 61400-1); `von-karman` (von Kármán); if not given: from
            the robot file.
        intensity
            Standard deviation of the gusts along the mean wind, lateral and up, over the mean speed; if not given: from
            the robot file.
        length_scale_m
            Length scales of the gusts along, lateral and up, each in the direction of the mean wind [m]; if not given:
            from the robot file.
        coherence_decay
            Decay of the coherence with the distance along the mean wind, lateral and up; if not given: from the robot
            file, or 0,10,10.
        figure
            Draw the spectra of motions and tensions (.svg, .pdf).

        The other parameters are those of `Equilibrium.stiffness`.

        Returns
        -------
        The keys of the program's JSON; lists of numbers are arrays.

        References
        ----------
        docs/theory.md, equations (49f) to (49q).
        """
    def live(self, /, path: str | PathLike[str] | None = None, *, cable_model: CableModel | None = None, assembly: Assembly = "consistent", in_plane_only: bool = False, winches: Winches = "as-given") -> Live:
        """
        Makes a page in HTML on which the platform can be dragged, which notebooks show.

        The page contains the program itself, as WebAssembly, and needs no network. In a notebook, with the package
        `anywidget`, the pose and the values that a person changes come back: `state`, `pose`, `values` and
        `equilibrium()` of the result follow the page.

        Parameters
        ----------
        path
            File to which the page is also written.

        The other parameters are those of `Equilibrium.stiffness`.

        Raises
        ------
        InputError
            The package was built without the page.
        """
    def modes(self, /, below_hz: SupportsFloat | SupportsIndex | None = None, *, input: str | None = None, output: str | None = None, input_point_m: ArrayLike | None = None, output_point_m: ArrayLike | None = None, stations: SupportsIndex | None = None, platform_share: SupportsFloat | SupportsIndex | None = None, decay_percent: SupportsFloat | SupportsIndex | None = None, damped: bool = True, cable_model: CableModel | None = None, assembly: Assembly = "consistent", in_plane_only: bool = False, winches: Winches = "as-given", rigid_cables: bool = False) -> Modes:
        """
        Computes all natural frequencies below a limit, and checks by an independent count that none is missing.

        Parameters
        ----------
        below_hz
            Upper limit of the frequencies [Hz]; if not given: slightly above the 20 lowest; with rigid cables above
            all.
        input, output
            Signals of a response, as in `frf`: every mode then has its residue and the height of its peak.
        input_point_m
            Point where the force acts, platform frame [m]; if not given: the origin.
        output_point_m
            Point whose motion is measured, platform frame [m]; if not given: the origin.
        stations
            Number of points along every cable, ends included, whose displacements are wanted.
        platform_share
            Minimum fraction of the kinetic energy in the platform for `first_platform_index`, the first mode of the
            platform; 0.5 if not given.
        decay_percent
            Percentage of its amplitude to which a mode decays in the time that is listed; 5 if not given.
        damped
            Seek the damped partner of every mode. False is faster; damping ratios are then of first order in the
            damping, and there are no eigenvalues.
        rigid_cables
            Modes with cables that are straight, without mass and rigid in length, of the motions that they leave free.
            The equilibrium has the static model `ideal` or `spring`.

        The other parameters are those of `Equilibrium.stiffness`.
        """
    def receptance(self, /, hz: ArrayLike, *, cable_model: CableModel | None = None, assembly: Assembly = "consistent", in_plane_only: bool = False, winches: Winches = "as-given") -> NDArray[complex128]:
        """
        Computes the receptance of all six motions to all six wrench components about the platform origin: (n, 6, 6),
        world axes.

        Parameters
        ----------
        hz
            Frequencies [Hz], a row of n.

        The other parameters are those of `Equilibrium.stiffness`.
        """
    def reduce(self, /, below_hz: SupportsFloat | SupportsIndex, input: str | Sequence[str] | None = None, output: str | Sequence[str] | None = None, *, input_point_m: ArrayLike | None = None, output_point_m: ArrayLike | None = None, tolerance: SupportsFloat | SupportsIndex | None = None, damping_at_hz: SupportsFloat | SupportsIndex | None = None, cable_model: CableModel | None = None, assembly: Assembly = "consistent", in_plane_only: bool = False, winches: Winches = "as-given") -> ReducedModel:
        """
        Computes a second-order model M x'' + C x' + K x = B f, y = L x, and its state space with all clamped modes.

        `state_space` gives far fewer states.

        Parameters
        ----------
        below_hz
            Highest frequency for which the model is valid [Hz].
        input, output
            Signals, as in `frf`, one or a list; if not given, all forces and moments on the platform, and all its
            displacements and rotations.
        input_point_m
            Point where the force acts, platform frame [m]; if not given: the origin.
        output_point_m
            Point whose motion is measured, platform frame [m]; if not given: the origin.
        tolerance
            Maximum relative error of the responses by modes left out; 1e-3 if not given.
        damping_at_hz
            Frequency at which viscous damping reproduces constant damping ratios [Hz]; if not given: every natural
            frequency.

        The other parameters are those of `Equilibrium.stiffness`.
        """
    def report(self, /, path: str | PathLike[str] | None = None, *, summary: bool = False, below_hz: SupportsFloat | SupportsIndex | None = None, input: str | None = None, output: str | None = None, input_point_m: ArrayLike | None = None, output_point_m: ArrayLike | None = None, platform_share: SupportsFloat | SupportsIndex | None = None, cable_model: CableModel | None = None, assembly: Assembly = "consistent", in_plane_only: bool = False, winches: Winches = "as-given") -> Page:
        """
        Makes a page in HTML about the equilibrium and its vibration, which notebooks show.

        Parameters
        ----------
        path
            File to which the page is also written.
        summary
            Two pages A4 for the person who decides, instead of the page with all analyses; -o FILE.pdf writes them as
            PDF.
        below_hz
            Upper limit of the frequencies [Hz]; 20 if not given.
        input
            Input of the frequency response: fx … mz, or f:ux,uy,uz, m:ux,uy,uz, see `funicular frf`; if not given: fz;
            fx if the platform cannot move along z.
        output
            Output of the frequency response: x … arz, or x:ux,uy,uz, v:…, a:…, see `funicular frf`; if not given: az;
            ax if the platform cannot move along z.
        input_point_m
            Point where the force acts, platform frame [m]; if not given: the origin.
        output_point_m
            Point whose motion is measured, platform frame [m]; if not given: the origin.
        platform_share
            Minimum fraction of the kinetic energy in the platform for a mode that counts as a mode of the platform; 0.5
            if not given.

        The other parameters are those of `Equilibrium.stiffness`.
        """
    def settle(self, /, release_n: ArrayLike | None = None, *, release_n_m: ArrayLike | None = None, stop_m_s: ArrayLike | None = None, stop_rad_s: ArrayLike | None = None, move_m: ArrayLike | None = None, move_deg: ArrayLike | None = None, trajectory: str | PathLike[str] | Mapping[str, ArrayLike] | None = None, profile_s: ArrayLike | None = None, shaper: str | None = None, shape_modes_hz: ArrayLike | None = None, robust_payload_kg: ArrayLike | None = None, sample_time_s: SupportsFloat | SupportsIndex | None = None, input_point_m: ArrayLike | None = None, output_point_m: ArrayLike | None = None, tolerance_m: SupportsFloat | SupportsIndex | None = None, below_hz: SupportsFloat | SupportsIndex | None = None, cable_model: CableModel | None = None, assembly: Assembly = "consistent", in_plane_only: bool = False, winches: Winches = "as-given", page: str | PathLike[str] | None = None, figure: str | PathLike[str] | None = None, lengths: str | PathLike[str] | None = None) -> SettleResults:
        """
        Computes how a point of the platform swings after a release, a stop, a move or a trajectory, and when it has settled.

        The motion is linear about the equilibrium at the end, in closed form over the damped modes. A stop, a move and a
        trajectory are commanded by the lengths; an input shaper splits them so that their vibrations cancel.

        Parameters
        ----------
        release_n
            Force on the platform that is released, at `input_point_m`, world axes [N]; if not given: none.
        release_n_m
            Moment on the platform that is released, world axes [N m]; if not given: none.
        stop_m_s
            Velocity of the platform before it stops, world axes [m/s]; its lengths command it; if not given: none.
        stop_rad_s
            Angular velocity of the platform before it stops, world axes [rad/s]; if not given: none.
        move_m
            Displacement of the platform from rest to rest, world axes [m]; its lengths command it; if not given: none.
        move_deg
            Rotation vector of the platform from rest to rest, world axes [degrees]; if not given: none.
        trajectory
            Trajectory that the lengths command, from rest to rest: columns t_s [s], and either x_m, y_m, z_m, roll_deg,
            pitch_deg, yaw_deg or unstrained_length_NAME_m of every cable [m]; between the rows the lengths change in
            straight lines. Without a pose and lengths the state is that of the last row.
        profile_s
            Times of the command [s], each at most the one before. A move has T1 from the start of the acceleration to
            the start of the deceleration, T2 for each of the two, and T3 for each change of the acceleration; a stop
            has T1 for the deceleration, and T2 and T3 for its changes. The command takes their sum; without them a stop
            is sudden; if not given: none.
        shaper
            Input shaper of the command: zv, zvd, or ei:V, which leaves the fraction V of a vibration, as in ei:0.05; if
            not given: none.
        shape_modes_hz
            Natural frequencies of the modes whose vibration the shaper cancels [Hz]; if not given: the modes with the
            largest amplitudes, at most three, until their sum is within the tolerance.
        robust_payload_kg
            Payloads [kg] with which the vibration after the same lengths is listed as well. Their centre of mass is
            that of the `[required]` payload of the file, or that of the platform; if not given: none.
        sample_time_s
            Time between the samples of the commanded lengths, which are then listed [s]; if not given: no samples.
        input_point_m
            Point where the force acts, platform frame [m]; if not given: the origin.
        output_point_m
            Point whose motion is measured, platform frame [m]; if not given: the origin.
        tolerance_m
            Distance from its rest within which the point has settled [m]; 0.001 if not given.
        below_hz
            Upper limit of the frequencies of the modes that take part [Hz]; if not given: above all modes of the
            platform.
        page
            Write a page with the decay of the point and its modes (.html).
        figure
            Draw the decay of the point (.svg, .pdf).
        lengths
            Write the commanded lengths: t_s, and unstrained_length_NAME_m of every cable [m] (.csv).

        The other parameters are those of `Equilibrium.stiffness`.

        Returns
        -------
        The keys of the program's JSON; lists of numbers are arrays.

        References
        ----------
        docs/theory.md, equations (46f) to (46n).
        """
    def state_space(self, /, input: str | Sequence[str] | None = None, output: str | Sequence[str] | None = None, *, below_hz: SupportsFloat | SupportsIndex, input_point_m: ArrayLike | None = None, output_point_m: ArrayLike | None = None, tolerance: SupportsFloat | SupportsIndex | None = None, order: SupportsIndex | None = None, damping_at_hz: SupportsFloat | SupportsIndex | None = None, cable_model: CableModel | None = None, assembly: Assembly = "consistent", in_plane_only: bool = False, winches: Winches = "as-given") -> StateSpaceModel:
        """
        Computes a state space A, B, C, D for control design: the modes that inputs and outputs see.

        Parameters
        ----------
        input, output
            Signals, as in `frf`, one or a list; if not given, all forces and moments on the platform, and all its
            displacements and rotations.
        below_hz
            Highest frequency for which the model is valid [Hz].
        input_point_m
            Point where the force acts, platform frame [m]; if not given: the origin.
        output_point_m
            Point whose motion is measured, platform frame [m]; if not given: the origin.
        tolerance
            Maximum of |G_r − G| up to the limit relative to the peak of |G|, for each response. The model has as few
            states as it allows. 0.01 if neither is given.
        order
            Maximum number of states, instead of a tolerance.
        damping_at_hz
            Frequency at which viscous damping reproduces constant damping ratios [Hz]; if not given: every natural
            frequency.

        The other parameters are those of `Equilibrium.stiffness`.

        Raises
        ------
        funicular.NoSolutionError
            No choice of modes keeps the tolerance, a mode has no damping, or the equilibrium is unstable.
        """
    def stiffness(self, /, at_hz: ArrayLike | None = None, *, cable_model: CableModel | None = None, assembly: Assembly = "consistent", in_plane_only: bool = False, winches: Winches = "as-given") -> NDArray[Any]:
        """
        Computes the stiffness about the platform origin in world axes [N/m, N, N m].

        Parameters
        ----------
        at_hz
            Frequency [Hz], or a row of n frequencies; 0 if not given.
        cable_model
            How cables answer motion of the platform: `catenary-dynamic`, `shallow-dynamic`, `shallow-static`,
            `catenary-static`, `spring`. If not given: `catenary-dynamic` with catenary statics, else `shallow-dynamic`,
            and at 0 Hz the exact tangent of the static model. In wind this tangent is unsymmetric, because the drag
            turns with the cables (theory (49d)). A named model, or another frequency, gives the symmetric stiffness
            with constant drag.
        assembly
            Terms of the stiffness: `consistent` (all terms: end stiffness of the cables, and rotation of their forces
            on their lever arms); `without-geometric-stiffness` (end stiffness of the cables only, as in Yuan et al.
            2014).
        in_plane_only
            Leave out the out-of-plane stiffness of the cables, as in Yuan et al. 2014.
        winches
            Winches in vibration, for cables that run to a winch: `as-given` (as the robot file describes them);
            `clamped` (motors held at their angle); `torque` (motors with constant torque); `stuck` (cables that stick
            to their pulleys).

        Returns
        -------
        (6, 6), real at 0 Hz and complex at another frequency; for a row of frequencies (n, 6, 6), complex.
        """
    def write_frf(self, /, path: str | PathLike[str], hz: ArrayLike, input: str | Sequence[str] | None = None, output: str | Sequence[str] | None = None, *, adaptive: bool = False, input_point_m: ArrayLike | None = None, output_point_m: ArrayLike | None = None, cable_model: CableModel | None = None, assembly: Assembly = "consistent", in_plane_only: bool = False, winches: Winches = "as-given") -> list[str]:
        """
        Writes frequency responses as a Universal File, as the program's `frf -o FILE.uff`; returns the caveats.

        Each response is a function of dataset 58, with its points in dataset 15.

        Parameters
        ----------
        path
            Path of the file, which is complete or absent.
        hz
            Frequencies [Hz], a row of n.
        input, output
            Signals, as in `frf`: motions of the platform and forces on it, along axes.
        adaptive
            Add frequencies until every peak has its height (to 0.1 %) and straight lines over the logarithm of the
            magnitude are accurate to 1 %.
        input_point_m
            Point where the force acts, platform frame [m]; if not given: the origin.
        output_point_m
            Point whose motion is measured, platform frame [m]; if not given: the origin.

        The other parameters are those of `Equilibrium.stiffness`.

        Raises
        ------
        InputError
            A Universal File cannot hold one of the signals.
        FileError
            The file cannot be written.
        """
    def write_modes(self, /, path: str | PathLike[str], below_hz: SupportsFloat | SupportsIndex | None = None, *, cable_model: CableModel | None = None, assembly: Assembly = "consistent", in_plane_only: bool = False, winches: Winches = "as-given", rigid_cables: bool = False) -> list[str]:
        """
        Writes all mode shapes below a limit as a Universal File, as the program's `modes -o FILE.uff`; returns the
        caveats.

        Each mode is a dataset 55 over the origin of the platform and the attachments, in platform axes.

        Parameters
        ----------
        path
            Path of the file, which is complete or absent.
        below_hz
            Upper limit of the frequencies [Hz]; if not given: slightly above the 20 lowest; with rigid cables above
            all.

        The other parameters are those of `Equilibrium.stiffness`.

        Raises
        ------
        FileError
            The file cannot be written.
        """

@final
class Answered:
    """
    Results of a request, from which their page is made.

    A pickle contains the request. Its results are computed again when a page is wanted.
    """
    def __new__(cls, /, request: str) -> Answered:
        """
        Takes a request in JSON, whose results are computed when they are wanted.
        """
    def __reduce__(self, /) -> tuple[Any, tuple[str]]: ...
    def json(self, /) -> str:
        """
        Returns the keys of the program's JSON.
        """
    def page(self, /, call: str) -> str:
        """
        Makes the page in HTML; `call` is the code that makes it again.
        """
    def reading_table(self, /, latex: bool) -> str:
        """
        Returns the rounded table for LaTeX, or for Markdown.
        """
    @property
    def request(self, /) -> str:
        """
        Request, as JSON.
        """
    def table(self, /) -> list[tuple[str, str, list[Any]]]:
        """
        Returns name, unit and values of every column of the program's CSV.
        """
    def write(self, /, files: SupportsGetItem[int, tuple[str, str | PathLike[str]]], call: str) -> list[str]:
        """
        Writes files that the command writes besides its result, by their keys, and returns sentences about them; `call`
        is the code that writes them again.
        """

@final
class Catenary:
    """
    Elastic cable that hangs in its plane under its own weight; immutable.

    Parameters
    ----------
    span_m, rise_m
        Horizontal and vertical distance from the start to the end [m]; the rise may be negative.
    unstrained_length_m
        Unstrained length [m].
    weight_n_per_m
        Weight per unstrained length [N/m]; a cable without weight is straight.
    axial_stiffness_n
        Axial stiffness EA [N].
    """
    def __copy__(self, /) -> Catenary: ...
    def __deepcopy__(self, /, memo: Any) -> Catenary: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self, /) -> int: ...
    def __new__(cls, /, span_m: SupportsFloat | SupportsIndex, rise_m: SupportsFloat | SupportsIndex, *, unstrained_length_m: SupportsFloat | SupportsIndex, weight_n_per_m: SupportsFloat | SupportsIndex, axial_stiffness_n: SupportsFloat | SupportsIndex) -> Catenary: ...
    def __reduce__(self, /) -> tuple[Any, tuple[float, float, float, float, float]]: ...
    def __repr__(self, /) -> str: ...
    @property
    def horizontal_force_n(self, /) -> float:
        """
        Horizontal force at both ends [N].
        """
    def points_m(self, /, arc_length_m: ArrayLike) -> NDArray[float64]:
        """
        Returns the points at unstrained arc lengths from the start [m], one row per point: horizontal and vertical
        distance from the start.
        """
    @property
    def tangent_n_per_m(self, /) -> NDArray[float64]:
        """
        Static stiffness of the start in the plane with a fixed end, 2×2 [N/m]: horizontal, vertical.
        """
    @property
    def tension_end_n(self, /) -> float:
        """
        Tension at the end [N].
        """
    @property
    def tension_start_n(self, /) -> float:
        """
        Tension at the start [N].
        """

@final
class Equilibrium(Analyses):
    """
    Static equilibrium of a robot; immutable. Arrays with one entry per cable are in the order of the file.

    Made by `Robot.equilibrium`.
    """
    def __copy__(self, /) -> Equilibrium: ...
    def __deepcopy__(self, /, memo: Any) -> Equilibrium: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self, /) -> int: ...
    def __reduce__(self, /) -> tuple[Any, tuple[Robot, str]]: ...
    def __repr__(self, /) -> str: ...
    def _repr_html_(self, /) -> Any: ...
    def cable_points(self, /, points: SupportsIndex | None = None) -> NDArray[float64]:
        """
        Returns points along the hanging cables in world axes [m]: (cables, points, 3), from the platform to the anchor.

        The points are at equal steps of the unstrained length; 33 per cable if `points` is not given.
        """
    @property
    def cables(self, /) -> list[dict[str, Any]]:
        """
        One dictionary per cable, with the keys of the program's JSON.
        """
    @property
    def chord_m(self, /) -> NDArray[float64]:
        """
        Chord lengths from attachment to anchor [m].
        """
    @property
    def exit_m(self, /) -> NDArray[float64]:
        """
        Points at which the cables leave their pulleys in world axes [m], one row per cable; the anchors without
        pulleys.
        """
    @property
    def force_on_platform_n(self, /) -> NDArray[float64]:
        """
        Forces of the cables on the platform in world axes [N], one row per cable.
        """
    @property
    def free_motions(self, /) -> list[str]:
        """
        Motions of the platform that no cable opposes by its tension, in words; empty unless the directions of the
        cables are dependent or the equilibrium is indifferent.
        """
    @property
    def held_pose(self, /) -> Pose | None:
        """
        Pose whose unstrained lengths are held, as with `hold_lengths_of_pose=True`; else None.
        """
    @property
    def iterations(self, /) -> int:
        """
        Number of iterations of the solver.
        """
    @property
    def lambda2(self, /) -> NDArray[float64]:
        """
        Irvine's parameters λ²; NaN for a cable without tension.
        """
    @property
    def nearest_pose_distance_m(self, /) -> float | None:
        """
        Distance from the requested pose [m] with fewer cables than degrees of freedom; else None.
        """
    @property
    def pose(self, /) -> Pose:
        """
        Pose of the platform.
        """
    @property
    def residual(self, /) -> float:
        """
        Unbalanced wrench on the platform relative to the sum of all forces.
        """
    @property
    def robot(self, /) -> Robot:
        """
        Robot of the equilibrium.
        """
    @property
    def sag_ratio(self, /) -> NDArray[float64]:
        """
        Ratios of sag to chord; NaN for a cable without tension.
        """
    def simulation(self, /, *, tension_control: SupportsGetItem[int, str] | None = None, tolerance_m: SupportsFloat | SupportsIndex | None = None, elements: SupportsIndex | None = None, degree: SupportsIndex | None = None, damping_frequency_hz: SupportsFloat | SupportsIndex | None = None, stretch_damping_time_s: SupportsFloat | SupportsIndex | None = None, hold_platform: bool = False, gust_seed: SupportsIndex | None = None) -> Simulation:
        """
        Begins a simulation that advances by intervals, at this equilibrium.

        Parameters
        ----------
        tension_control
            Names of the cables whose winches may be told to hold a tension; none if not given.
        tolerance_m
            Error of a position that one step may have [m]; 1e-7 if not given.
        elements
            Number of elements of each rope; 3 if not given.
        degree
            Degree of the polynomials of each element; 8 if not given.
        damping_frequency_hz
            Frequency at which the damping ratio of the ropes and their loss factor hold [Hz]; if not given, the first
            natural frequency, for a loss factor that of the mode with most stretch.
        stretch_damping_time_s
            Damping time of the stretch of all ropes [s] in place of that of the robot file.
        hold_platform
            Hold the platform where it is, so that only the ropes move.
        gust_seed
            Number from which the gusts of the wind's turbulence are drawn; the mean wind alone if not given.
        """
    @property
    def stable(self, /) -> bool | None:
        """
        True if every small motion is opposed; None for ideal cables, which are rigid.
        """
    @property
    def static_model(self, /) -> str:
        """
        Static model of the cables: `ideal`, `spring` or `catenary`.
        """
    @property
    def stiffness_min_n_per_m(self, /) -> float | None:
        """
        Minimum eigenvalue of the scaled static stiffness, in wind of its symmetric part [N/m]; None for ideal cables.
        """
    @property
    def string_frequency_hz(self, /) -> NDArray[float64]:
        """
        First frequencies of the cables as taut strings [Hz]; NaN for a cable without tension or mass.
        """
    @property
    def support_displacement_m(self, /) -> NDArray[float64]:
        """
        Displacements of the flexible supports in world axes [m], one row per support in the order of their names; no
        rows on a rigid frame.
        """
    @property
    def tension_anchor_n(self, /) -> NDArray[float64]:
        """
        Tensions at the anchor ends [N].
        """
    @property
    def tension_drum_n(self, /) -> NDArray[float64]:
        """
        Tensions at the drums [N]; those at the anchor ends for cables without pulley and winch.
        """
    @property
    def tension_platform_n(self, /) -> NDArray[float64]:
        """
        Tensions at the platform ends [N].
        """
    @property
    def tension_rule(self, /) -> str | None:
        """
        Rule by which tensions were chosen; None if there was no choice.
        """
    def to_dict(self, /, *, another_stable_equilibrium: bool = False) -> dict[str, Any]:
        """
        Returns a dictionary with the keys of the program's JSON.

        Parameters
        ----------
        another_stable_equilibrium
            Search for another stable equilibrium of the same lengths, too, as the program does. The search takes
            about a hundred times as long as the equilibrium; the key of this name is absent if there is none.
        """
    def to_latex(self, /) -> str:
        """
        Rounded table with one row per cable for LaTeX, with the rules of booktabs and the numbers of siunitx.
        """
    def to_markdown(self, /) -> str:
        """
        Rounded table with one row per cable for Markdown.
        """
    def to_pandas(self, /) -> Any:
        """
        Makes a table of pandas with one row per cable; pandas has to be installed.
        """
    @property
    def unique_centre(self, /) -> bool | None:
        """
        True if the tensions of the rule `centre` are certified to be the only ones; None for another rule. The key
        `centre` of `to_dict` has the numbers of the proof.
        """
    @property
    def unstrained_length_m(self, /) -> NDArray[float64]:
        """
        Unstrained lengths [m].
        """
    @property
    def warnings(self, /) -> list[str]:
        """
        Caveats of the result.
        """

@final
class Estimator:
    """
    Estimator of pose, velocity, payload, tensions and errors of the sensors, inside a loop.

    The filter of `Robot.estimate`, which gets readings as they come. The platform rests at the first ones. What raises
    an exception leaves the estimator as it was.

    Parameters
    ----------
    robot
        Robot.
    lengths_m
        Unstrained lengths of all cables by their encoders [m].
    tensions_n
        Tensions at anchors or drums [N]: one per cable, or a dictionary by names.
    azimuths_rad
        Azimuths at which cables leave their anchors, about z from x [rad].
    elevations_rad
        Elevations of the cables at their anchors above the xy plane [rad].
    gyroscope_rad_s
        Angular velocity, platform axes [rad/s].
    accelerometer_m_s2
        Specific force, platform axes [m/s²]; at rest minus gravity.
    tracker_m
        Position of the tracked point in the world [m].
    options
        Noise, places of the sensors and prior knowledge as in `Robot.estimate`, `false_alarms_per_hour` and
        `near_pose`.

    Raises
    ------
    InputError
        A reading or an option is wrong, or a length is missing.
    NoSolutionError
        The lengths have no equilibrium.
    """
    def __new__(cls, /, robot: Robot, lengths_m: dict[str, Any] | ArrayLike, *, tensions_n: dict[str, Any] | ArrayLike | None = None, azimuths_rad: dict[str, Any] | ArrayLike | None = None, elevations_rad: dict[str, Any] | ArrayLike | None = None, gyroscope_rad_s: ArrayLike | None = None, accelerometer_m_s2: ArrayLike | None = None, tracker_m: ArrayLike | None = None, **options: Any) -> Estimator: ...
    def __repr__(self, /) -> str: ...
    @property
    def alarms(self, /) -> list[dict[str, Any]]:
        """
        All alarms so far, as in the results of `Robot.estimate`.
        """
    @property
    def cable_names(self, /) -> list[str]:
        """
        Names of the cables, in the order of the file.
        """
    @property
    def now(self, /) -> Results:
        """
        Present state with the keys of a row of `Robot.estimate`.
        """
    def restart(self, /, lengths_m: dict[str, Any] | ArrayLike, *, tensions_n: dict[str, Any] | ArrayLike | None = None, gyroscope_rad_s: ArrayLike | None = None, accelerometer_m_s2: ArrayLike | None = None, tracker_m: ArrayLike | None = None, near_pose: Pose | ArrayLike | None = None, forget: bool = False) -> None:
        """
        Begins anew at rest with the lengths of all cables.

        Parameters
        ----------
        lengths_m
            Unstrained lengths of all cables by their encoders [m].
        tensions_n
            Tensions at anchors or drums [N]: one per cable, or a dictionary by names.
        gyroscope_rad_s
            Angular velocity, platform axes [rad/s].
        accelerometer_m_s2
            Specific force, platform axes [m/s²]; at rest minus gravity.
        tracker_m
            Position of the tracked point in the world [m].
        near_pose
            Pose near which the platform is; the last one if not given.
        forget
            Begin with what was known before the first reading; otherwise payload and errors of the sensors stay as they
            are known.

        Raises
        ------
        InputError
            A reading is wrong or a length is missing; the estimator is as it was.
        NoSolutionError
            The lengths have no equilibrium; the estimator is as it was.
        """
    def update(self, /, dt_s: SupportsFloat | SupportsIndex, *, lengths_m: dict[str, Any] | ArrayLike | None = None, tensions_n: dict[str, Any] | ArrayLike | None = None, azimuths_rad: dict[str, Any] | ArrayLike | None = None, elevations_rad: dict[str, Any] | ArrayLike | None = None, gyroscope_rad_s: ArrayLike | None = None, accelerometer_m_s2: ArrayLike | None = None, tracker_m: ArrayLike | None = None) -> Results:
        """
        Moves the estimate by a time step and takes the readings at its end. A reading that is left out was not there.

        Parameters
        ----------
        dt_s
            Time step [s], above 0 and at most 1.
        lengths_m
            Unstrained lengths by the encoders [m]: one per cable, or a dictionary by names.
        tensions_n
            Tensions at anchors or drums [N]: one per cable, or a dictionary by names.
        azimuths_rad
            Azimuths at which cables leave their anchors, about z from x [rad].
        elevations_rad
            Elevations of the cables at their anchors above the xy plane [rad].
        gyroscope_rad_s
            Angular velocity, platform axes [rad/s].
        accelerometer_m_s2
            Specific force, platform axes [m/s²]; at rest minus gravity.
        tracker_m
            Position of the tracked point in the world [m], at this time.

        Returns
        -------
        The keys of a row of `Robot.estimate`, with the time since the start, and `alarms` since the last call.

        Raises
        ------
        InputError
            The step or a reading is wrong; the estimator is as it was.
        NoSolutionError
            No length has been read for 0.2 s, or the readings lead nowhere: call `restart`. The estimator is as it was.
        """

@final
class Pose:
    """
    Position and orientation of the platform; immutable.

    Parameters
    ----------
    position_m
        Origin of the platform frame in world axes, x, y, z [m].
    roll_pitch_yaw_deg
        Roll, pitch, yaw [degrees], R = Rz(yaw) Ry(pitch) Rx(roll); zero if not given.
    quaternion_wxyz
        Unit quaternion w, x, y, z instead of angles.
    """
    def __copy__(self, /) -> Pose: ...
    def __deepcopy__(self, /, memo: Any) -> Pose: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self, /) -> int: ...
    def __new__(cls, /, position_m: ArrayLike, roll_pitch_yaw_deg: ArrayLike | None = None, *, quaternion_wxyz: ArrayLike | None = None) -> Pose: ...
    def __reduce__(self, /) -> tuple[Any, tuple[NDArray[float64], NDArray[float64]]]: ...
    def __repr__(self, /) -> str: ...
    @property
    def matrix(self, /) -> NDArray[float64]:
        """
        Homogeneous transformation from platform to world, 4×4.
        """
    @property
    def position_m(self, /) -> NDArray[float64]:
        """
        Origin of the platform frame in world axes, x, y, z [m].
        """
    @property
    def quaternion_wxyz(self, /) -> NDArray[float64]:
        """
        Orientation as w, x, y, z with w ≥ 0.
        """
    @property
    def roll_pitch_yaw_deg(self, /) -> NDArray[float64]:
        """
        Roll, pitch, yaw [degrees], R = Rz(yaw) Ry(pitch) Rx(roll).
        """
    @property
    def rotation(self, /) -> NDArray[float64]:
        """
        Rotation matrix from platform to world axes, 3×3.
        """
    def to_array(self, /) -> NDArray[float64]:
        """
        Returns x, y, z, roll, pitch, yaw [m, degrees]: a row of `poses`.
        """

@final
class Robot(Analyses):
    """
    Cable-driven parallel robot, read from the text of a robot file (TOML); immutable.

    Made by `Robot.from_file`, `Robot.from_toml`, `Robot.from_dict` or `Robot.example`.
    """
    def __copy__(self, /) -> Robot: ...
    def __deepcopy__(self, /, memo: Any) -> Robot: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self, /) -> int: ...
    def __reduce__(self, /) -> tuple[Any, tuple[str]]: ...
    def __repr__(self, /) -> str: ...
    def _repr_html_(self, /) -> Any: ...
    @property
    def anchor_m(self, /) -> NDArray[float64]:
        """
        Anchors in world axes [m], one row per cable.
        """
    @property
    def attachment_m(self, /) -> NDArray[float64]:
        """
        Attachments in the platform frame [m], one row per cable.
        """
    @property
    def cable_names(self, /) -> list[str]:
        """
        Names of the cables, in the order of the file, which every array with one entry per cable has.
        """
    def check(self, /) -> Results:
        """
        Returns the robot as it was read, with the keys of the program's `check`; lists of numbers are arrays.
        """
    @classmethod
    def example(cls, /) -> Robot:
        """
        Makes the robot that is part of the package: six cables of 4 mm (Yuan, Courteille and Deblaise 2014).
        """
    @classmethod
    def from_dict(cls, /, robot: dict[str, Any]) -> Robot:
        """
        Reads a dictionary with the keys of a robot file, such as that of `to_dict`.

        Raises
        ------
        RobotFileError
            The dictionary is not a valid robot; the message shows it as a robot file.
        """
    @classmethod
    def from_file(cls, /, path: str | PathLike[str]) -> Robot:
        """
        Reads a robot file.

        Raises
        ------
        RobotFileError
            The file is not a valid robot file; the message shows its lines.
        OSError
            The file cannot be read.
        """
    @classmethod
    def from_toml(cls, /, text: str) -> Robot:
        """
        Reads the text of a robot file.

        Raises
        ------
        RobotFileError
            The text is not a valid robot file; the message shows its lines.
        """
    @property
    def lengths_m(self, /) -> NDArray[float64] | None:
        """
        Unstrained lengths of the robot file [m], one per cable; None if the file gives a pose or no state.
        """
    @property
    def mass_kg(self, /) -> float:
        """
        Mass of the platform [kg].
        """
    @property
    def motion(self, /) -> str:
        """
        Motion of the platform, as in the robot file: `rigid`, `point-mass`, `planar` and so on.
        """
    @property
    def name(self, /) -> str:
        """
        Name of the robot.
        """
    def parameters(self, /) -> dict[str, Any]:
        """
        Returns every number of the robot file, with the keys of the program's `parameters`: `path`, `value`, `unit`,
        `range`, `minimum`, `maximum`, `meaning`, `label` (name in words with the unit) and `given`.
        `Robot.with_` and `vary=` use the same paths.
        """
    def request(self, /, command: "str", **keywords: "object") -> dict[str, Any]:
        """
        Makes the request of a command of the program for this robot, as `funicular COMMAND --print-request` prints it.

        `funicular.run` runs the request.

        Parameters
        ----------
        command
            Name of the command, such as `statics`.
        keywords
            Options of the command by their names with _ in place of -, such as `tension_rule="middle"`.
        """
    @property
    def source(self, /) -> str:
        """
        Source of the robot's numbers.
        """
    def to_dict(self, /) -> dict[str, Any]:
        """
        Returns the robot file as a dictionary.
        """
    def to_toml(self, /) -> str:
        """
        Returns the text of the robot file with all changes.
        """
    def with_(self, /, changes: dict[str, Any] | None = None, *, mass_kg: SupportsFloat | SupportsIndex | None = None) -> Robot:
        """
        Makes a robot with other values; this robot stays as it is.

        Parameters
        ----------
        changes
            New values by their paths in the robot file, as in the program's `--set`; cables by their names:
            `{"materials.rope-4mm.diameter_m": 0.008, "cables.3.unstrained_length_m": 6.7}`.
        mass_kg
            Mass of the platform [kg]; inertia and centre of mass do not change.

        Raises
        ------
        RobotFileError
            The file has no such path, or the value is wrong there.
        """
    def calibrate(self, /, readings: str | PathLike[str] | Mapping[str, ArrayLike], unknowns: str | Sequence[str] | None = None, *, leave_out: ArrayLike | None = None, hold_anchors: str | Sequence[str] | None = None, frame: str | Sequence[str] | None = None, length_std_m: SupportsFloat | SupportsIndex | None = None, position_std_m: SupportsFloat | SupportsIndex | None = None, rotation_std_deg: SupportsFloat | SupportsIndex | None = None, tension_std_n: SupportsFloat | SupportsIndex | None = None, prior: Any = None, tension_range_n: ArrayLike | None = None, static_model: StaticModel = "ideal", starts: SupportsIndex | None = None, profile: str | Sequence[str] | None = None, propose: SupportsIndex | None = None, grid: Mapping[str, ArrayLike] | None = None, poses: ArrayLike | None = None, propose_for: str | Sequence[str] | None = None, propose_by: Literal['variances', 'determinant'] = "variances", accuracy_grid: Mapping[str, ArrayLike] | None = None, accuracy_poses: ArrayLike | None = None, wanted_std_m: SupportsFloat | SupportsIndex | None = None, tension_rule: TensionRule | None = None, target_tension_n: ArrayLike | None = None, min_tension_n: SupportsFloat | SupportsIndex | None = None, max_tension_n: SupportsFloat | SupportsIndex | None = None, figure: str | PathLike[str] | None = None, calibrated: str | PathLike[str] | None = None, calibrated_covariance: str | PathLike[str] | None = None, page: str | PathLike[str] | None = None) -> CalibrateResults:
        """
        Calibrates anchors, attachments, offsets and more from readings of lengths at poses that are not known.

        Parameters
        ----------
        readings
            One row per pose: columns `length_NAME_m` (or `_mm`, `_in`) of every cable, and optionally `x_m`, `y_m`, `z_m`,
            `roll_deg`, `pitch_deg`, `yaw_deg`, as a mapping, a data frame or a CSV file.
        unknowns
            Numbers to find, separated by commas: anchors, attachments, offsets (length of each cable at the reading
            zero), scale (metres of length per metre of all readings), pulley-radii; of elastic cables also axial-
            stiffness, mass and support-stiffness, as factors of those of the file; anchors if not given.
        leave_out
            Rows of the readings that are left out, by their numbers from 1, separated by commas.
        hold_anchors
            Cables whose anchors are known, by their names, separated by commas.
        frame
            Frame of the result: cables separated by commas, of which the first keeps its anchor, the second the
            direction from the first, and the third the plane of the three; or inner, in which all anchors together move
            least.
        length_std_m
            Standard deviation of a reading [m]; if not given: that of the residuals.
        position_std_m
            Standard deviation of the coordinates x_m, y_m, z_m [m]; with it they are measurements; if not given: they
            only start the search.
        rotation_std_deg
            Standard deviation of the angles roll_deg, pitch_deg, yaw_deg [degrees]; with it they are measurements; if
            not given: they only start the search.
        tension_std_n
            Standard deviation of the measured tensions [N]; 1 if not given.
        prior
            Values known beforehand: a mapping from kinds of unknowns or paths of values to a standard deviation, or to a value
            and its deviation.
        tension_range_n
            Range within which the tensions at the anchors lie that were not measured [N]: a prior of its middle, with
            the deviation of equal chances, for elastic cables.
        static_model
            Static model of the cables: ideal ones are straight and rigid: `ideal` (straight, massless, rigid); `spring`
            (straight, massless, elastic); `catenary` (elastic, sagging under its own weight).
        starts
            Maximum number of starts of the search; 10 if not given.
        profile
            Values with a profile, separated by commas: kinds as in `unknowns`, or paths of values. Each is held at
            steps and everything else is fitted again, until χ² has risen to the limit of 95 %.
        propose
            Number of poses to propose that reduce the deviations most, one after the other; 0 if not given.
        grid
            Axis of the candidates of a proposal: x, y, z [m], roll, pitch, yaw [degrees], with N values from A to B, or
            with listed values (repeatable); an axis that is not given stays at the middle pose of the rows.
        poses
            Candidates of a proposal (n, 3) or (n, 6): x, y, z [m], roll, pitch, yaw [degrees].
        propose_for
            Numbers whose deviations the proposal reduces: kinds as in `unknowns`, or paths of values, or tool for the
            position of the platform at the poses of `accuracy_grid`; if not given: all unknowns.
        propose_by
            Criterion of the proposal: `variances` (least sum of the variances of the chosen values); `determinant`
            (least determinant of the covariance of all values, whatever their units).
        accuracy_grid
            Axis of the poses at which the deviation of the platform is told, as in `grid` (repeatable): a controller
            commands the readings of the calibrated values there.
        accuracy_poses
            Poses at which the deviation of the platform is told, instead of a grid: position [m] and roll, pitch, yaw
            [degrees].
        wanted_std_m
            Largest deviation that is wanted [m]: the least number of proposed poses that reaches it.
        tension_rule
            Rule that chooses the tensions at a pose if there are more cables than degrees of freedom: `lowest` (minimum
            sum of squares of the tensions above their minimum); `closest` (minimum sum of squares of the differences
            from `target_tension_n`); `middle` (maximum distance from the limits, relative to the distance between
            them); `centre` (centre of the tensions within the limits, which changes smoothly: for paths and
            controllers); `stiffest` (maximum of the minimum eigenvalue of the scaled stiffness); if not given: lowest.
        target_tension_n
            Target tensions [N], one for all cables or one per cable in the order of the file; the rule is then closest.
        min_tension_n
            Minimum tension anywhere in a cable [N]; if not given: from the robot file, or 2.5 times the cable's weight.
        max_tension_n
            Maximum tension anywhere in a cable [N]; if not given: from the robot file, or none.
        figure
            Draw the anchors with their ellipses (.svg, .pdf).
        calibrated
            Write the robot file with the calibrated anchors and attachments (.toml).
        calibrated_covariance
            Write the covariance of the calibrated anchors, attachments, pulleys and offsets (as unstrained lengths),
            for `uncertainty`; a scale and factors are left out (.csv).
        page
            Write a page with the anchors and their ellipses, the residuals, rows that can be clicked away and the
            proposed poses (.html).

        Returns
        -------
        The keys of the program's JSON: `fit` and `determined` as sentences, `is_determined`, `values` with deviations and
        intervals, `anchors` with their covariance, `distances`, `rows`, `weak_combinations`, `walk`, `minima`, `proposals`, `robot_file`
        and `covariance`, which `Robot.uncertainty` takes.

        Raises
        ------
        InputError
            A column, a value or a name is wrong, or there are fewer readings than unknowns.
        StaticsError
            The readings fit at no start.

        References
        ----------
        docs/theory.md, equations (96a) to (96k).
        """
    def clearance(self, /, pose: Pose | ArrayLike | None = None, static_model: StaticModel = "catenary", *, move_to: Pose | ArrayLike | None = None, find_way: bool = False, in_gusts: bool = False, lengths_m: ArrayLike | None = None, hold_lengths_of_pose: bool = False, mass_kg: SupportsFloat | SupportsIndex | None = None, force_n: ArrayLike | None = None, moment_n_m: ArrayLike | None = None, load_point_m: ArrayLike | None = None, wind_m_s: ArrayLike | None = None, cable_load_n_per_m: ArrayLike | None = None, tension_rule: TensionRule | None = None, target_tension_n: ArrayLike | None = None, min_tension_n: SupportsFloat | SupportsIndex | None = None, max_tension_n: SupportsFloat | SupportsIndex | None = None) -> ClearanceResults:
        """
        Computes the distances between the sagging cables, the platform and obstacles: what is nearest, where, and what is
        too near.

        Parameters
        ----------
        move_to
            Pose x,y,z[,roll,pitch,yaw] [m, degrees] to which the platform moves, straight and with one turn; the
            distances are then the least on the way, and cables that cross each other are shown.
        find_way
            Search a way to the end of the move through one or two other poses if something is too near on the straight
            one.
        in_gusts
            Enlarge every required distance by the expected largest motions of both within ten minutes in the gusts of
            the robot file.

        The other parameters are those of `Robot.equilibrium`.

        Returns
        -------
        The keys of the program's JSON: `free`, and `pairs` with `kind`, `first`, `second`, `distance_m`, `required_m`,
        `margin_m` and `points_m`, the pair with the least margin first.

        Raises
        ------
        StaticsError
            The robot has no such equilibrium.
        """
    def design(self, /, change: Any, *, goal: Goal = "first-frequency", grid: Mapping[str, ArrayLike] | None = None, poses: ArrayLike | None = None, weights: ArrayLike | None = None, ropes: Any = None, reconnect: bool = False, min_frequency_hz: SupportsFloat | SupportsIndex | None = None, min_stiffness_n_per_m: SupportsFloat | SupportsIndex | None = None, avoid_hz: ArrayLike | None = None, max_iterations: SupportsIndex | None = None, pose: Pose | ArrayLike | None = None, mass_kg: SupportsFloat | SupportsIndex | None = None, static_model: StaticModel = "catenary", force_n: ArrayLike | None = None, moment_n_m: ArrayLike | None = None, load_point_m: ArrayLike | None = None, wind_m_s: ArrayLike | None = None, cable_load_n_per_m: ArrayLike | None = None, tension_rule: TensionRule | None = None, target_tension_n: ArrayLike | None = None, min_tension_n: SupportsFloat | SupportsIndex | None = None, max_tension_n: SupportsFloat | SupportsIndex | None = None, cable_model: CableModel | None = None, assembly: Assembly = "consistent", in_plane_only: bool = False, winches: Winches = "as-given", designed: str | PathLike[str] | None = None, page: str | PathLike[str] | None = None) -> Designed:
        """
        Chooses values of the robot file with which the robot is best at several poses.

        The poses are held, and the tensions of more cables than degrees of freedom follow `tension_rule`. The values
        move within their bounds until the goal improves no further.

        Parameters
        ----------
        change
            Values to choose: a mapping from paths to the largest change to both sides, or to bounds (minimum, maximum).
            A vector without a component stands for all its numbers, and * for every name, as in
            `cables.*.attachment_m`.
        goal
            Goal of the design: `first-frequency` (highest first natural frequency, cables included); `platform`
            (highest first natural frequency of the platform on the static stiffness of its cables); `stiffness-min`
            (highest minimum stiffness, as `statics` prints it); `rope-length` (least length of all ropes); `rope-mass`
            (least mass of all ropes); `load-factor` (largest multiple of the required loads that is held); `clearance`
            (largest distance, beyond the required one, of what comes nearest: cables, platform, obstacles); `winch-
            tension` (least tension at a drum under everything that is required); `winch-speed` (least speed of a cable
            at its drum for the required velocities); `winch-torque` (least torque of a motor under everything that is
            required); `winch-power` (least mechanical power of a motor that drives, under everything that is required);
            `workspace` (most of the poses at which the required loads are held).
        grid
            Axis of the grid: x, y, z [m], roll, pitch, yaw [degrees], with N values from A to B, or with listed values
            (repeatable); an axis that is not given keeps the value of the robot's state or of `pose`.
        poses
            Poses (n, 3) or (n, 6): x, y, z [m], roll, pitch, yaw [degrees]; the worst one counts. If not given: `pose`,
            or the pose of the robot file.
        weights
            Weights of the poses, for their mean instead of the worst pose.
        ropes
            Ropes to choose from for all cables: a table with the columns name, axial_stiffness_n, mass_kg_per_m and,
            where known, diameter_m, minimum_tension_n, maximum_tension_n, breaking_load_n. The values are chosen for
            each of them.
        reconnect
            Exchange the attachments of cables, two at a time, while the goal with the present values gains from it and
            no further cables cross.
        min_frequency_hz
            Demand: first natural frequency at every pose of at least HZ.
        min_stiffness_n_per_m
            Demand: minimum stiffness at every pose of at least K, as `statics` prints it [N/m].
        avoid_hz
            Band (first, last) without natural frequencies at every pose [Hz].
        max_iterations
            Maximum number of iterations; 50 if not given.
        designed
            Write the robot file with the chosen values (.toml).
        page
            Write a page with the poses before and after, the moved points and the gains of more room (.html).

        The other parameters are those of `Robot.equilibrium` and of `Equilibrium.stiffness`.

        Returns
        -------
        Result with `x`, `fun`, `success`, `message`, `nit` as those of `scipy.optimize`, with the values per pose, and
        with `robot`.

        Raises
        ------
        InputError
            A value, a path or a bound is wrong.
        StaticsError
            A pose has no equilibrium, or no values within the bounds meet all demands; the message says what was
            reached.

        References
        ----------
        docs/theory.md, equations (60r) to (60t) and (95a) to (95c).
        """
    def equilibria(self, /, poses: ArrayLike | None = None, lengths_m: ArrayLike | None = None, static_model: StaticModel = "catenary", tension_rule: TensionRule | None = None, *, hold_lengths_of_pose: bool = False, mass_kg: SupportsFloat | SupportsIndex | None = None, force_n: ArrayLike | None = None, moment_n_m: ArrayLike | None = None, load_point_m: ArrayLike | None = None, wind_m_s: ArrayLike | None = None, cable_load_n_per_m: ArrayLike | None = None, target_tension_n: ArrayLike | None = None, min_tension_n: SupportsFloat | SupportsIndex | None = None, max_tension_n: SupportsFloat | SupportsIndex | None = None, threads: SupportsIndex | None = None) -> Equilibria:
        """
        Computes the equilibria of many states in parallel, without Python's lock.

        A state without equilibrium is a row with its reason, never an exception. Each row has, bit for bit, the numbers
        of `equilibrium`.

        Parameters
        ----------
        poses
            (n, 3), (n, 6) or (n, 7): x, y, z [m], then roll, pitch, yaw [degrees] or a quaternion w, x, y, z.
        lengths_m
            (n, m): unstrained lengths [m] of m cables.
        threads
            Number of threads; one per processor if not given.

        The other parameters are those of `Robot.equilibrium`.
        """
    def equilibrium(self, /, pose: Pose | ArrayLike | None = None, lengths_m: ArrayLike | None = None, static_model: StaticModel = "catenary", tension_rule: TensionRule | None = None, *, hold_lengths_of_pose: bool = False, mass_kg: SupportsFloat | SupportsIndex | None = None, force_n: ArrayLike | None = None, moment_n_m: ArrayLike | None = None, load_point_m: ArrayLike | None = None, wind_m_s: ArrayLike | None = None, cable_load_n_per_m: ArrayLike | None = None, target_tension_n: ArrayLike | None = None, min_tension_n: SupportsFloat | SupportsIndex | None = None, max_tension_n: SupportsFloat | SupportsIndex | None = None) -> Equilibrium:
        """
        Computes the static equilibrium for a pose or for unstrained lengths.

        Without `pose` and `lengths_m` the state is that of the robot file.

        Parameters
        ----------
        pose
            A `Pose`, or x, y, z [m], or x, y, z, roll, pitch, yaw [m, degrees], or x, y, z and a quaternion w, x, y, z.
            The lengths follow. With fewer cables than degrees of freedom: the nearest pose that the cables can hold.
        lengths_m
            Unstrained lengths [m], one per cable in the order of the file; the pose follows from them.
        static_model
            Static model of the cables: `ideal` (straight, massless, rigid); `spring` (straight, massless, elastic);
            `catenary` (elastic, sagging under its own weight).
        tension_rule
            Rule that chooses the tensions at a pose if there are more cables than degrees of freedom: `lowest` (minimum
            sum of squares of the tensions above their minimum); `closest` (minimum sum of squares of the differences
            from `target_tension_n`); `middle` (maximum distance from the limits, relative to the distance between
            them); `centre` (centre of the tensions within the limits, which changes smoothly: for paths and
            controllers); `stiffest` (maximum of the minimum eigenvalue of the scaled stiffness); if not given: lowest.
        hold_lengths_of_pose
            Hold the unstrained lengths with which the robot, as it was read and before `with_`, rests at the pose. All
            changes, those of `with_` and those of this call, then act at these lengths and move the platform.
        mass_kg
            Mass of the platform [kg]; inertia and centre of mass do not change.
        force_n
            Force on the platform, world axes [N].
        moment_n_m
            Moment on the platform, world axes [N m].
        load_point_m
            Point where the force acts, platform frame [m]; if not given: from the robot file, or the origin.
        wind_m_s
            Velocity of the steady wind, world axes [m/s]; it acts on ropes with a `drag_coefficient` and platforms with
            a `drag_area_m2`.
        cable_load_n_per_m
            Load per metre of every cable besides its weight, world axes [N/m].
        target_tension_n
            Target tensions [N], one for all cables or one per cable in the order of the file; the rule is then closest.
        min_tension_n
            Minimum tension anywhere in a cable [N]; if not given: from the robot file, or 2.5 times the cable's weight.
        max_tension_n
            Maximum tension anywhere in a cable [N]; if not given: from the robot file, or none.

        Raises
        ------
        StaticsError
            There is no such equilibrium; `code` gives the reason as one word.
        InputError
            An argument is wrong; the message says which and what to give.
        """
    def estimate(self, /, log: str | PathLike[str] | Mapping[str, ArrayLike], *, near_pose: Pose | ArrayLike | None = None, every_s: SupportsFloat | SupportsIndex | None = None, false_alarms_per_hour: SupportsFloat | SupportsIndex | None = None, inertial_unit_m: ArrayLike | None = None, tracked_point_m: ArrayLike | None = None, length_std_m: SupportsFloat | SupportsIndex | None = None, tension_std_n: SupportsFloat | SupportsIndex | None = None, cable_angle_std_rad: SupportsFloat | SupportsIndex | None = None, gyroscope_std_rad_s: SupportsFloat | SupportsIndex | None = None, accelerometer_std_m_s2: SupportsFloat | SupportsIndex | None = None, tracker_std_m: SupportsFloat | SupportsIndex | None = None, payload_kg: SupportsFloat | SupportsIndex | None = None, payload_std_kg: SupportsFloat | SupportsIndex | None = None, first_moment_std_kg_m: SupportsFloat | SupportsIndex | None = None, force_std_n: SupportsFloat | SupportsIndex | None = None, moment_std_n_m: SupportsFloat | SupportsIndex | None = None, force_time_s: SupportsFloat | SupportsIndex | None = None, offset_std_m: SupportsFloat | SupportsIndex | None = None, tension_bias_std_n: SupportsFloat | SupportsIndex | None = None, friction: SupportsFloat | SupportsIndex | None = None, figure: str | PathLike[str] | None = None, page: str | PathLike[str] | None = None) -> EstimateResults:
        """
        Estimates pose, velocity, payload and tensions over time from the log of a machine, each with its deviation, and alarms.

        Parameters
        ----------
        log
            One row per time: `t_s`, `length_NAME_m` of every cable, and optionally `tension_anchor_NAME_n`, `gyroscope_x_rad_s`,
            `accelerometer_x_m_s2`, `tracker_x_m` and more, as a mapping, a data frame or a CSV file.
        near_pose
            Pose near which the platform is at the first row: x,y,z[,roll,pitch,yaw] [m, degrees]; if not given: an
            equilibrium that the program finds.
        every_s
            Least time between rows of the result [s]; with 0 every row of the log has one; 0 if not given.
        false_alarms_per_hour
            False alarms of the tests of the load cells that are accepted, per hour; 0.1 if not given.
        inertial_unit_m
            Place of the inertial unit, platform frame [m]; its axes are those of the platform; 0.0, 0.0, 0.0 if not
            given.
        tracked_point_m
            Tracked point, platform frame [m]; 0.0, 0.0, 0.0 if not given.
        length_std_m
            Standard deviation of a length between its readings [m]; 2e-05 if not given.
        tension_std_n
            Standard deviation of a tension [N]; 3 if not given.
        cable_angle_std_rad
            Standard deviation of the direction of a cable [rad]; 0.001 if not given.
        gyroscope_std_rad_s
            Standard deviation of the gyroscope [rad/s]; 0.002 if not given.
        accelerometer_std_m_s2
            Standard deviation of the accelerometer [m/s²]; 0.03 if not given.
        tracker_std_m
            Standard deviation of each coordinate of the tracked point [m]; 0.001 if not given.
        payload_kg
            Payload beyond the platform of the file that is expected at the start [kg]; 0 if not given.
        payload_std_kg
            Standard deviation of this payload [kg]; 20 if not given.
        first_moment_std_kg_m
            Standard deviation of the payload's first moment about the platform origin, each component [kg m]; 2 if not
            given.
        force_std_n
            Standard deviation of an external force besides the loads of the file, each component [N]; 3 if not given.
        moment_std_n_m
            Standard deviation of such a moment, each component [N m]; 0.5 if not given.
        force_time_s
            Time in which the external force and moment change [s]; 1 if not given.
        offset_std_m
            Standard deviation of the constant error of each length [m]; 0.001 if not given.
        tension_bias_std_n
            Standard deviation of the constant error of each tension [N]; 5 if not given.
        friction
            Coefficient of friction between rope and load cell: the error of a tension wanders by twice this part of it
            within a centimetre of travel; 0 if not given.
        figure
            Draw motion, payload, tensions and residuals over time (.svg, .pdf).
        page
            Write a page with motion, payload, tensions, residuals and alarms (.html).

        Returns
        -------
        The keys of the program's JSON: `fit` and `not_determined` as sentences, `alarms`, `sensors`, `cable_errors`, and `rows`
        over time.

        Raises
        ------
        InputError
            A column, a time or a value is wrong, or the lengths of a cable are missing.
        NoSolutionError
            The lengths have no equilibrium.

        References
        ----------
        docs/theory.md, equations (97r) to (97za).
        """
    def identify(self, /, fit: Any = None, experiments: Any = None, *, starts: SupportsIndex | None = None, profile: str | Sequence[str] | None = None, propose: SupportsIndex | None = None, grid: Mapping[str, ArrayLike] | None = None, poses: ArrayLike | None = None, propose_measuring: str | Sequence[str] | None = None, propose_modes: SupportsIndex | None = None, propose_payloads_kg: ArrayLike | None = None, propose_for: str | Sequence[str] | None = None, propose_by: Literal['variances', 'determinant'] = "variances", wanted_percent: SupportsFloat | SupportsIndex | None = None, from_hz: SupportsFloat | SupportsIndex | None = None, to_hz: SupportsFloat | SupportsIndex | None = None, response_noise: SupportsFloat | SupportsIndex | None = None, frequency_noise: SupportsFloat | SupportsIndex | None = None, damping_noise: SupportsFloat | SupportsIndex | None = None, history_kind: Literal['decay', 'ambient'] = "decay", history_from_s: SupportsFloat | SupportsIndex | None = None, history_to_s: SupportsFloat | SupportsIndex | None = None, history_poles: SupportsIndex | None = None, tension_rule: TensionRule | None = None, target_tension_n: ArrayLike | None = None, min_tension_n: SupportsFloat | SupportsIndex | None = None, max_tension_n: SupportsFloat | SupportsIndex | None = None, cable_model: CableModel | None = None, assembly: Assembly = "consistent", in_plane_only: bool = False, winches: Winches = "as-given", rigid_cables: bool = False, lengths_m: ArrayLike | None = None, pose: Pose | ArrayLike | None = None, hold_lengths_of_pose: bool = False, mass_kg: SupportsFloat | SupportsIndex | None = None, static_model: StaticModel = "catenary", force_n: ArrayLike | None = None, moment_n_m: ArrayLike | None = None, load_point_m: ArrayLike | None = None, wind_m_s: ArrayLike | None = None, cable_load_n_per_m: ArrayLike | None = None, fitted: str | PathLike[str] | None = None, page: str | PathLike[str] | None = None) -> Identified:
        """
        Finds the values of the robot file that fit measurements best, with their deviations.

        The keywords of the state belong to every experiment that does not give them itself.

        Parameters
        ----------
        fit
            Values to identify: a list of paths, or a mapping from paths to None, to bounds (minimum, maximum), or to a
            mapping with `minimum`, `maximum`, `prior` and `prior_std`. A vector without a component stands for all its
            numbers, and * for every name, as in `materials.*.mass_kg_per_m`. Without values, the natural frequencies of
            time histories are found alone: `details["histories"]`.
        experiments
            One mapping per state of the robot, or a single one: `responses`, `frequencies` and `histories` as
            `funicular.read_measurements` returns them, `measured_pose`, `measured_tensions_n`, `measured_lengths_m`
            with their deviations, `cables` with the names of those that were mounted, `payload_kg` with its
            `payload_center_m`, and the keys of the state.
        starts
            Maximum number of starts of the search. The first start has the values of the file, the others are spread by
            the priors; the search ends at the first start that fits; 10 if not given.
        profile
            Paths of fitted values whose interval of 95 % is also found by holding the value and fitting the others
            again; `details["values"]` has it under `profile`. * stands for any key.
        propose
            Number of measurements to propose that reduce the deviations most, one after the other; 0 if not given.
        grid
            Axis of the poses of a proposal: x, y, z [m], roll, pitch, yaw [degrees], with N values from A to B, or with
            listed values (repeatable); an axis that is not given stays at the pose of the first experiment.
        poses
            Poses of a proposal instead of a grid: position [m] and roll, pitch, yaw [degrees].
        propose_measuring
            Quantities that can be measured at each of these poses, separated by commas: frequencies (the lowest ones),
            tensions, lengths, pose (at the lengths of the file's robot there). Other loads are those of the first
            experiment; frequencies if not given.
        propose_modes
            Number of the lowest natural frequencies that are measured at each pose of a proposal; 6 if not given.
        propose_payloads_kg
            Payloads of a proposal [kg], which the platform carries at each of these poses, separated by commas; if not
            given: that of the first experiment.
        propose_for
            Values whose deviations the proposal reduces, by their paths, as in `profile`; if not given: all fitted
            values.
        propose_by
            Criterion of the proposal. Variances are relative to the values, or in usual errors of values that may be
            zero: `variances` (least sum of the variances of the chosen values); `determinant` (least determinant of the
            covariance of all values, whatever their units).
        wanted_percent
            Largest relative deviation of a positive value that is wanted [%]: the least number of proposed measurements
            that reaches it.
        from_hz
            First frequency of the responses that counts [Hz]; if not given: all.
        to_hz
            Last frequency of the responses that counts [Hz]; if not given: all.
        response_noise
            Standard deviation of responses without deviations, relative to their magnitude; 0.3 % of the median
            magnitude is added; 0.02 if not given.
        frequency_noise
            Relative standard deviation of natural frequencies without deviations; 0.01 if not given.
        damping_noise
            Relative standard deviation of damping ratios; 0.1 if not given.
        history_kind
            Kind of measured time histories: `decay` (free decay after a push, a release or a stop); `ambient` (record
            under wind or other broad-band excitation that is not measured).
        history_from_s
            Time at which the histories begin to count [s]: a decay begins after its push has ended; if not given: all.
        history_to_s
            Time at which they end to count [s]; if not given: all.
        history_poles
            Number of vibrations in a decay, or half the order of the system for a record in wind; if not given: as many
            as the readings show.
        fitted
            Write the robot file with the identified values (.toml).
        page
            Write a page with measured and fitted curves (.html).

        The other parameters are those of `Robot.equilibrium` and of `Equilibrium.stiffness`.

        Raises
        ------
        InputError
            A value, a path or a measurement is wrong.
        StaticsError
            The robot has no equilibrium at any start.
        """
    def loads(self, /, pose: Pose | ArrayLike | None = None, static_model: StaticModel = "catenary", *, required_force_n: ArrayLike | None = None, required_moment_n_m: ArrayLike | None = None, required_shape: Literal['box', 'ellipsoid'] | None = None, required_payload_min_kg: SupportsFloat | SupportsIndex | None = None, required_payload_max_kg: SupportsFloat | SupportsIndex | None = None, required_payload_center_m: ArrayLike | None = None, required_payload_center_reach_m: ArrayLike | None = None, required_acceleration_m_s2: ArrayLike | None = None, required_angular_acceleration_rad_s2: ArrayLike | None = None, required_wind_speed_m_s: SupportsFloat | SupportsIndex | None = None, lengths_m: ArrayLike | None = None, hold_lengths_of_pose: bool = False, mass_kg: SupportsFloat | SupportsIndex | None = None, force_n: ArrayLike | None = None, moment_n_m: ArrayLike | None = None, load_point_m: ArrayLike | None = None, wind_m_s: ArrayLike | None = None, cable_load_n_per_m: ArrayLike | None = None, tension_rule: TensionRule | None = None, target_tension_n: ArrayLike | None = None, min_tension_n: SupportsFloat | SupportsIndex | None = None, max_tension_n: SupportsFloat | SupportsIndex | None = None) -> LoadsResults:
        """
        Compares the loads that the cables hold at a pose with the required ones: verdict, load factor, what binds, margins.

        All tensions within the limits count, not only those of a tension rule.

        Parameters
        ----------
        required_force_n
            Largest required force, both ways along each world axis [N].
        required_moment_n_m
            Largest required moment about the platform origin, both ways about each world axis [N m].
        required_shape
            Shape of the set of required forces and moments: `box` (every component varies by itself); `ellipsoid`
            (ellipsoid with these half axes; a ball if they are equal); if not given: from the robot file, or box.
        required_payload_min_kg
            Minimum required payload [kg], which is always carried.
        required_payload_max_kg
            Maximum required payload [kg].
        required_payload_center_m
            Middle of the centres of mass of the required payload, platform frame [m].
        required_payload_center_reach_m
            Largest distance of the centre of mass of the payload from this middle, both ways along each axis of the
            platform [m].
        required_acceleration_m_s2
            Largest required acceleration of the platform origin from rest, both ways along each world axis [m/s²].
        required_angular_acceleration_rad_s2
            Largest required angular acceleration from rest, both ways about each world axis [rad/s²].
        required_wind_speed_m_s
            Speed of the required wind from every horizontal direction, on platform and ropes [m/s].

        The other parameters are those of `Robot.equilibrium`.

        Returns
        -------
        The keys of the program's JSON: `closure`, `tension_factor`, `dead_load_held`, `capacity_margin_n`,
        `acceleration_max_m_s2`, and `required` with `held`, `load_factor`, its bounds, the load that binds, and `cables`;
        without `required` if nothing is required or the dead load is not held.

        Raises
        ------
        StaticsError
            The robot has no such pose, or no load factor was found.
        """
    def map(self, /, grid: Mapping[str, ArrayLike] | None = None, quantities: str | Sequence[str] | None = None, *, poses: ArrayLike | None = None, up_to_hz: SupportsFloat | SupportsIndex | None = None, platform_share: SupportsFloat | SupportsIndex | None = None, payload_center_m: ArrayLike | None = None, required_force_n: ArrayLike | None = None, required_moment_n_m: ArrayLike | None = None, required_shape: Literal['box', 'ellipsoid'] | None = None, required_payload_min_kg: SupportsFloat | SupportsIndex | None = None, required_payload_max_kg: SupportsFloat | SupportsIndex | None = None, required_payload_center_m: ArrayLike | None = None, required_payload_center_reach_m: ArrayLike | None = None, required_acceleration_m_s2: ArrayLike | None = None, required_angular_acceleration_rad_s2: ArrayLike | None = None, required_wind_speed_m_s: SupportsFloat | SupportsIndex | None = None, required_velocity_m_s: ArrayLike | None = None, required_angular_velocity_rad_s: ArrayLike | None = None, required_velocity_shape: Literal['box', 'ellipsoid'] | None = None, lengths_m: ArrayLike | None = None, pose: Pose | ArrayLike | None = None, hold_lengths_of_pose: bool = False, mass_kg: SupportsFloat | SupportsIndex | None = None, static_model: StaticModel = "catenary", force_n: ArrayLike | None = None, moment_n_m: ArrayLike | None = None, load_point_m: ArrayLike | None = None, wind_m_s: ArrayLike | None = None, cable_load_n_per_m: ArrayLike | None = None, tension_rule: TensionRule | None = None, target_tension_n: ArrayLike | None = None, min_tension_n: SupportsFloat | SupportsIndex | None = None, max_tension_n: SupportsFloat | SupportsIndex | None = None, cable_model: CableModel | None = None, assembly: Assembly = "consistent", in_plane_only: bool = False, winches: Winches = "as-given", file: str | PathLike[str] | None = None, resume: bool = False, discard: bool = False, part: str | None = None, threads: SupportsIndex | None = None, executor: Executor | Callable[[], Executor] | None = None, chunks_per_task: SupportsIndex | None = None, progress: Callable[[int, int], object] | None = None) -> Sweep:
        """
        Computes quantities over poses, one row per pose.

        The rows are those of the program's `map`, bit for bit, with any number of threads or workers. A pose without
        equilibrium is a row with its reason, never an exception.

        Parameters
        ----------
        grid
            Axes of a grid of poses: x, y, z [m], roll, pitch, yaw [degrees], as in `{"x": (-4, 4, 81), "z": [0.5, 1,
            2]}`. A tuple is the first value, the last value and their number; anything else is values. x varies
            fastest, then y.
        quantities
            What is computed at every point; docs/sweeps.md has the list; `tension-min` and `tension-max` if not given.
        poses
            Poses instead of a grid, (n, 3) or (n, 6): x, y, z [m], roll, pitch, yaw [degrees].
        up_to_hz
            Upper limit of the search for natural frequencies [Hz]; 1000 if not given.
        platform_share
            Minimum fraction of the kinetic energy in the platform for a mode that counts as a mode of the platform; 0.5
            if not given.
        payload_center_m
            Centre of mass of the payload, platform frame [m]; if not given: that of the platform.
        required_force_n
            Largest required force, both ways along each world axis [N].
        required_moment_n_m
            Largest required moment about the platform origin, both ways about each world axis [N m].
        required_shape
            Shape of the set of required forces and moments: `box` (every component varies by itself); `ellipsoid`
            (ellipsoid with these half axes; a ball if they are equal); if not given: from the robot file, or box.
        required_payload_min_kg
            Minimum required payload [kg], which is always carried.
        required_payload_max_kg
            Maximum required payload [kg].
        required_payload_center_m
            Middle of the centres of mass of the required payload, platform frame [m].
        required_payload_center_reach_m
            Largest distance of the centre of mass of the payload from this middle, both ways along each axis of the
            platform [m].
        required_acceleration_m_s2
            Largest required acceleration of the platform origin from rest, both ways along each world axis [m/s²].
        required_angular_acceleration_rad_s2
            Largest required angular acceleration from rest, both ways about each world axis [rad/s²].
        required_wind_speed_m_s
            Speed of the required wind from every horizontal direction, on platform and ropes [m/s].
        required_velocity_m_s
            Largest required velocity of the platform origin, both ways along each world axis [m/s].
        required_angular_velocity_rad_s
            Largest required angular velocity, both ways about each world axis [rad/s].
        required_velocity_shape
            Shape of the set of required velocities, and of that of angular velocities: an ellipsoid with equal half
            axes is every direction up to one speed: `box` (every component varies by itself); `ellipsoid` (ellipsoid
            with these half axes; a ball if they are equal); if not given: from the robot file, or box.
        file
            File of the rows: .parquet, .csv or .vti. It is written when all rows are there; until then FILE.partial
            holds them, also after a crash. The rows of a Parquet file are read into memory at their first use.
        resume, discard
            Continue with the rows of the same sweep in FILE.partial, or delete them.
        part
            Part k of n, as in "3/8"; each part has its own Parquet `file`, and `funicular.merge` joins them.
        threads
            Number of threads of this process; one per processor if not given.
        executor
            Executor whose workers compute (`concurrent.futures`, Dask's `Client.get_executor()`, mpi4py's
            `MPIPoolExecutor`), or a function that makes an executor and is called again when the executor breaks.
        chunks_per_task
            Number of chunks of rows that a worker gets at once; chosen from measured times if not given.
        progress
            Function that is called with the number of finished rows and the number of all rows.

        The other parameters are those of `Robot.equilibrium` and of `Equilibrium.stiffness`.

        Raises
        ------
        InputError
            An argument is wrong; the message says which and what to give.
        FileError
            The file cannot be written, or belongs to another sweep.
        ExecutorError
            The executor's workers died; `resume` of the exception continues.

        Warns
        -----
        RobotWarning
            The robot has a value that no usual robot has; once per call, before the rows are computed.
        """
    def observability(self, /, sensors: str | Sequence[str] | None = None, pose: Pose | ArrayLike | None = None, *, further_pose_m: SupportsFloat | SupportsIndex | None = None, grid: Mapping[str, ArrayLike] | None = None, poses: ArrayLike | None = None, inertial_unit_m: ArrayLike | None = None, tracked_point_m: ArrayLike | None = None, length_std_m: SupportsFloat | SupportsIndex | None = None, tension_std_n: SupportsFloat | SupportsIndex | None = None, cable_angle_std_rad: SupportsFloat | SupportsIndex | None = None, gyroscope_std_rad_s: SupportsFloat | SupportsIndex | None = None, accelerometer_std_m_s2: SupportsFloat | SupportsIndex | None = None, tracker_std_m: SupportsFloat | SupportsIndex | None = None, payload_kg: SupportsFloat | SupportsIndex | None = None, payload_std_kg: SupportsFloat | SupportsIndex | None = None, first_moment_std_kg_m: SupportsFloat | SupportsIndex | None = None, force_std_n: SupportsFloat | SupportsIndex | None = None, moment_std_n_m: SupportsFloat | SupportsIndex | None = None, force_time_s: SupportsFloat | SupportsIndex | None = None, offset_std_m: SupportsFloat | SupportsIndex | None = None, tension_bias_std_n: SupportsFloat | SupportsIndex | None = None, friction: SupportsFloat | SupportsIndex | None = None, lengths_m: ArrayLike | None = None, hold_lengths_of_pose: bool = False, mass_kg: SupportsFloat | SupportsIndex | None = None, static_model: StaticModel = "catenary", force_n: ArrayLike | None = None, moment_n_m: ArrayLike | None = None, load_point_m: ArrayLike | None = None, wind_m_s: ArrayLike | None = None, cable_load_n_per_m: ArrayLike | None = None, tension_rule: TensionRule | None = None, target_tension_n: ArrayLike | None = None, min_tension_n: SupportsFloat | SupportsIndex | None = None, max_tension_n: SupportsFloat | SupportsIndex | None = None) -> ObservabilityResults:
        """
        Computes which numbers sensors determine at poses at rest, before any reading, and what would add most.

        Parameters
        ----------
        sensors
            Sensors besides the encoders of all cables: `tensions`, `cable-angles`, `gyroscope`, `accelerometer`, `tracker`;
            `none` for the encoders alone.
        further_pose_m
            Distance of the further poses that are tried, along each axis to both sides [m]; 0.3 if not given.
        grid
            Axis of the grid: x, y, z [m], roll, pitch, yaw [degrees], with N values from A to B, or with listed values
            (repeatable); an axis that is not given keeps the value of the robot's state or of `pose`.
        poses
            List of poses instead of a grid: position [m] and roll, pitch, yaw [degrees].
        inertial_unit_m
            Place of the inertial unit, platform frame [m]; its axes are those of the platform; 0.0, 0.0, 0.0 if not
            given.
        tracked_point_m
            Tracked point, platform frame [m]; 0.0, 0.0, 0.0 if not given.
        length_std_m
            Standard deviation of a length between its readings [m]; 2e-05 if not given.
        tension_std_n
            Standard deviation of a tension [N]; 3 if not given.
        cable_angle_std_rad
            Standard deviation of the direction of a cable [rad]; 0.001 if not given.
        gyroscope_std_rad_s
            Standard deviation of the gyroscope [rad/s]; 0.002 if not given.
        accelerometer_std_m_s2
            Standard deviation of the accelerometer [m/s²]; 0.03 if not given.
        tracker_std_m
            Standard deviation of each coordinate of the tracked point [m]; 0.001 if not given.
        payload_kg
            Payload beyond the platform of the file that is expected at the start [kg]; 0 if not given.
        payload_std_kg
            Standard deviation of this payload [kg]; 20 if not given.
        first_moment_std_kg_m
            Standard deviation of the payload's first moment about the platform origin, each component [kg m]; 2 if not
            given.
        force_std_n
            Standard deviation of an external force besides the loads of the file, each component [N]; 3 if not given.
        moment_std_n_m
            Standard deviation of such a moment, each component [N m]; 0.5 if not given.
        force_time_s
            Time in which the external force and moment change [s]; 1 if not given.
        offset_std_m
            Standard deviation of the constant error of each length [m]; 0.001 if not given.
        tension_bias_std_n
            Standard deviation of the constant error of each tension [N]; 5 if not given.
        friction
            Coefficient of friction between rope and load cell: the error of a tension wanders by twice this part of it
            within a centimetre of travel; 0 if not given.

        The other parameters are those of `Robot.equilibrium`.

        Returns
        -------
        The keys of the program's JSON: `numbers` with the deviation of each number with these sensors and with the encoders
        alone, `cases` with the deviations for each further sensor and pose, `best_addition`, and `not_determined` as
        sentences.

        Raises
        ------
        StaticsError
            The cables hold the platform at none of these poses.
        NoSolutionError
            The filter finds no balance at a pose.

        References
        ----------
        docs/theory.md, equation (97r).
        """
    def payload(self, /, pose: Pose | ArrayLike | None = None, lengths_m: ArrayLike | None = None, static_model: StaticModel = "catenary", tension_rule: TensionRule | None = None, *, payload_center_m: ArrayLike | None = None, hold_lengths_of_pose: bool = False, mass_kg: SupportsFloat | SupportsIndex | None = None, force_n: ArrayLike | None = None, moment_n_m: ArrayLike | None = None, load_point_m: ArrayLike | None = None, wind_m_s: ArrayLike | None = None, cable_load_n_per_m: ArrayLike | None = None, target_tension_n: ArrayLike | None = None, min_tension_n: SupportsFloat | SupportsIndex | None = None, max_tension_n: SupportsFloat | SupportsIndex | None = None) -> PayloadResults:
        """
        Computes the minimum and the maximum payload at a pose, with the cables whose tension limits bind.

        The payload is held by any tensions within the limits, not only by those of a tension rule. The pose need not be
        held without a payload.

        Parameters
        ----------
        payload_center_m
            Centre of mass of the payload, platform frame [m]; if not given: that of the platform.

        The other parameters are those of `Robot.equilibrium`.

        Returns
        -------
        The keys of the program's JSON: `minimum` and `maximum` with `payload_kg` and `cables`; without `maximum` if no
        maximum tension limits the payload.

        Raises
        ------
        StaticsError
            No payload is held at this pose.
        """
    def pose_error(self, /, mass_kg: tuple[SupportsFloat | SupportsIndex, SupportsFloat | SupportsIndex, SupportsIndex], *, lengths_m: ArrayLike | None = None, pose: Pose | ArrayLike | None = None, tension_rule: TensionRule | None = None, target_tension_n: ArrayLike | None = None, min_tension_n: SupportsFloat | SupportsIndex | None = None, max_tension_n: SupportsFloat | SupportsIndex | None = None, tolerance_mm: SupportsFloat | SupportsIndex | None = None) -> PoseErrorResults:
        """
        Computes the distance of the poses of spring and catenary cables from those of ideal cables, over the platform
        mass.

        Parameters
        ----------
        mass_kg
            First mass [kg], last mass [kg] and number of masses.
        lengths_m
            Unstrained lengths [m], one per cable in the order of the file; if not given: from the robot file.
        pose
            Pose x,y,z[,roll,pitch,yaw] [m, degrees]: hold the unstrained lengths with which the robot of the file,
            without `with_`, rests there; if not given: the [state] of the robot file.
        tolerance_mm
            Maximum distance between spring pose and catenary pose at which springs are good enough [mm]; reports the
            masses where they are.

        The other parameters are those of `Robot.equilibrium`.

        Returns
        -------
        The keys of the program's JSON: `points` with one entry for each mass.
        """
    def prove(self, /, pose: Pose | ArrayLike | None = None, within_m: ArrayLike | None = None, within_deg: ArrayLike | None = None, *, boxes: SupportsIndex | None = None, undecided: SupportsFloat | SupportsIndex | None = None, time_s: SupportsFloat | SupportsIndex | None = None, required_force_n: ArrayLike | None = None, required_moment_n_m: ArrayLike | None = None, required_shape: Literal['box', 'ellipsoid'] | None = None, required_payload_min_kg: SupportsFloat | SupportsIndex | None = None, required_payload_max_kg: SupportsFloat | SupportsIndex | None = None, required_payload_center_m: ArrayLike | None = None, required_payload_center_reach_m: ArrayLike | None = None, required_acceleration_m_s2: ArrayLike | None = None, required_angular_acceleration_rad_s2: ArrayLike | None = None, required_wind_speed_m_s: SupportsFloat | SupportsIndex | None = None, lengths_m: ArrayLike | None = None, hold_lengths_of_pose: bool = False, mass_kg: SupportsFloat | SupportsIndex | None = None, static_model: StaticModel = "catenary", force_n: ArrayLike | None = None, moment_n_m: ArrayLike | None = None, load_point_m: ArrayLike | None = None, wind_m_s: ArrayLike | None = None, cable_load_n_per_m: ArrayLike | None = None, tension_rule: TensionRule | None = None, target_tension_n: ArrayLike | None = None, min_tension_n: SupportsFloat | SupportsIndex | None = None, max_tension_n: SupportsFloat | SupportsIndex | None = None, threads: SupportsIndex | None = None, progress: Callable[[int, int], object] | None = None, figure: str | PathLike[str] | None = None, proved: str | PathLike[str] | Sequence[str | PathLike[str]] | None = None, page: str | PathLike[str] | None = None, certificate: str | PathLike[str] | None = None) -> ProveResults:
        """
        Proves that required loads are held within the tension limits at every pose of a box, not only at samples of it.

        Parameters
        ----------
        within_m
            Half widths of the box of positions about the pose, world axes [m]; if not given: 0,0,0: the pose alone.
        within_deg
            Largest turn from the orientation of the pose about each world axis [degrees]; all turns belong to the
            statement at every position; if not given: 0,0,0: no turn.
        boxes
            Maximum number of boxes into which the box is divided; if not given: 1 for `prove`, or 20000.
        undecided
            Share of the set that may be undecided: undecided volume over the volume that is not proved outside.
        time_s
            Time after which the division ends [s].
        required_force_n
            Largest required force, both ways along each world axis [N].
        required_moment_n_m
            Largest required moment about the platform origin, both ways about each world axis [N m].
        required_shape
            Shape of the set of required forces and moments: `box` (every component varies by itself); `ellipsoid`
            (ellipsoid with these half axes; a ball if they are equal); if not given: from the robot file, or box.
        required_payload_min_kg
            Minimum required payload [kg], which is always carried.
        required_payload_max_kg
            Maximum required payload [kg].
        required_payload_center_m
            Middle of the centres of mass of the required payload, platform frame [m].
        required_payload_center_reach_m
            Largest distance of the centre of mass of the payload from this middle, both ways along each axis of the
            platform [m].
        required_acceleration_m_s2
            Largest required acceleration of the platform origin from rest, both ways along each world axis [m/s²].
        required_angular_acceleration_rad_s2
            Largest required angular acceleration from rest, both ways about each world axis [rad/s²].
        required_wind_speed_m_s
            Speed of the required wind from every horizontal direction, on platform and ropes [m/s].
        threads
            Number of threads of this process; one per processor if not given.
        progress
            Function that is called with the number of boxes that are done, and of the most that are wanted.
        figure
            Draw a section with what is proved inside, outside and neither (.svg, .pdf).
        proved
            Write the surface of what is proved inside [m] to FILE.stl, FILE.ply or FILE.vtp (ParaView) (.stl, .ply,
            .vtp).
        page
            Write a page that says what is proved and what is not, with the three sets (.html).
        certificate
            Write a certificate as lines of JSON, which scripts/check_certificate.py checks with rational numbers
            (.jsonl).

        The other parameters are those of `Robot.equilibrium`.

        Returns
        -------
        The keys of the program's JSON: `verdict` with `margin_n` or `reason`, `inside`, `outside` and `undecided` in
        `volume_unit`, `undecided_share`, `tried`, `end`, `worst`, and `boxes` with their verdicts.

        Raises
        ------
        InputError
            An argument is wrong, or the robot has something for which no bound over a box is derived; the message says which.
        KeyboardInterrupt
            Ctrl-C stopped the division; its attribute `partial_results` has the `Results` of what was proved until then.

        References
        ----------
        docs/theory.md, section 10b.
        """
    def simulate(self, /, scenario: Any = None, duration_s: SupportsFloat | SupportsIndex | None = None, *, sample_time_s: SupportsFloat | SupportsIndex | None = None, point: Mapping[str, ArrayLike] | None = None, tolerance_m: SupportsFloat | SupportsIndex | None = None, elements: SupportsIndex | None = None, degree: SupportsIndex | None = None, once: bool = False, damping_frequency_hz: SupportsFloat | SupportsIndex | None = None, stretch_damping_time_s: SupportsFloat | SupportsIndex | None = None, hold_platform: bool = False, gust_seed: SupportsIndex | None = None, lengths_m: ArrayLike | None = None, pose: Pose | ArrayLike | None = None, hold_lengths_of_pose: bool = False, mass_kg: SupportsFloat | SupportsIndex | None = None, static_model: StaticModel = "catenary", force_n: ArrayLike | None = None, moment_n_m: ArrayLike | None = None, load_point_m: ArrayLike | None = None, wind_m_s: ArrayLike | None = None, cable_load_n_per_m: ArrayLike | None = None, tension_rule: TensionRule | None = None, target_tension_n: ArrayLike | None = None, min_tension_n: SupportsFloat | SupportsIndex | None = None, max_tension_n: SupportsFloat | SupportsIndex | None = None, progress: Callable[[int, int], object] | None = None, figure: str | PathLike[str] | None = None, animation: str | PathLike[str] | None = None, page: str | PathLike[str] | None = None) -> SimulateResults:
        """
        Simulates large motion in time of platform and sagging ropes.

        Parameters
        ----------
        scenario
            What happens: a mapping from `release`, `pick`, `lengths`, `tension`, `stop`, `push`, `anchor` and `cut` to lists
            of events, each a mapping with the keys of docs/simulation.md. The `table` of an event of `lengths` or `anchor` may be a function of the
            time [s] from its beginning on, which returns a mapping from the columns of such a table to numbers; the event then
            needs its `duration_s`.
        duration_s
            Simulated time [s]; 10 if not given.
        sample_time_s
            Time between the rows of the result [s]; if not given: a thousandth of the duration.
        point
            Points of the platform whose motion is a part of the result: a mapping from names to places x, y, z in the platform
            frame [m].
        tolerance_m
            Error of a position that one step may have [m]; 1e-07 if not given.
        elements
            Number of elements of each rope; 3 if not given.
        degree
            Degree of the polynomials of each element; 8 if not given.
        once
            Run once, without the finer run that shows the error.
        damping_frequency_hz
            Frequency at which the damping ratio of the ropes and their loss factor hold [Hz]; if not given: the first
            natural frequency at the start, for a loss factor that of the mode with most stretch.
        stretch_damping_time_s
            Damping time of the stretch of all ropes [s] in place of that of the robot file; if not given:
            `axial_damping_time_s` of each rope.
        hold_platform
            Hold the platform where it is, so that only the ropes move.
        gust_seed
            Draw the gusts of the wind's turbulence from this number; another number gives other gusts of the same
            strength; if not given: the mean wind alone.
        lengths_m
            Unstrained lengths [m], one per cable in the order of the file; the pose follows from them.
        pose
            Pose x,y,z[,roll,pitch,yaw] [m, degrees], R = Rz(yaw) Ry(pitch) Rx(roll); the lengths follow from it.
        hold_lengths_of_pose
            Hold the unstrained lengths with which the robot of the file rests at the pose (of the file or of `pose`);
            all changes (`with_`, `mass_kg`, loads, wind, `vary`) then act at these lengths and move the platform.
        mass_kg
            Mass of the platform [kg]; inertia and centre of mass do not change.
        static_model
            Static model of the cables: `ideal` (straight, massless, rigid); `spring` (straight, massless, elastic);
            `catenary` (elastic, sagging under its own weight).
        force_n
            Force on the platform, world axes [N].
        moment_n_m
            Moment on the platform, world axes [N m].
        load_point_m
            Point where the force acts, platform frame [m]; if not given: from the robot file, or the origin.
        wind_m_s
            Velocity of the steady wind, world axes [m/s]; it acts on ropes with a `drag_coefficient` and platforms with
            a `drag_area_m2`.
        cable_load_n_per_m
            Load per metre of every cable besides its weight, world axes [N/m].
        tension_rule
            Rule that chooses the tensions at a pose if there are more cables than degrees of freedom: `lowest` (minimum
            sum of squares of the tensions above their minimum); `closest` (minimum sum of squares of the differences
            from `target_tension_n`); `middle` (maximum distance from the limits, relative to the distance between
            them); `centre` (centre of the tensions within the limits, which changes smoothly: for paths and
            controllers); `stiffest` (maximum of the minimum eigenvalue of the scaled stiffness); if not given: lowest.
        target_tension_n
            Target tensions [N], one for all cables or one per cable in the order of the file; the rule is then closest.
        min_tension_n
            Minimum tension anywhere in a cable [N]; if not given: from the robot file, or 2.5 times the cable's weight.
        max_tension_n
            Maximum tension anywhere in a cable [N]; if not given: from the robot file, or none.
        progress
            Function that is called with the number of rows that are done, and of all rows; first for the run, then for the
            finer one that shows the error.
        figure
            Draw pose and tensions over time (.svg, .pdf).
        animation
            Write the moving robot as an animated drawing, which any browser shows in true time (.svg).
        page
            Write a page with the moving robot, pose and tensions over time, and the spectrum of the motion (.html).

        Returns
        -------
        The keys of the program's JSON: `rows` with pose, velocities, tensions, lengths and energies at every time, `errors`
        with the difference of each column from a finer run, `peaks`, `slack`, `cuts` and `steps`.

        Raises
        ------
        InputError
            An event cannot happen, or the robot has a part that is not simulated.
        NoSolutionError
            The start is not a stable equilibrium.
        KeyboardInterrupt
            Ctrl-C stopped the run; any exception that another handler of signals raises arrives as well. Its attribute
            `partial_results` has the `Results` until then.

        References
        ----------
        docs/theory.md, equations (97a) to (97k).
        """
    def speeds(self, /, pose: Pose | ArrayLike | None = None, static_model: StaticModel = "catenary", *, required_velocity_m_s: ArrayLike | None = None, required_angular_velocity_rad_s: ArrayLike | None = None, required_velocity_shape: Literal['box', 'ellipsoid'] | None = None, lengths_m: ArrayLike | None = None, hold_lengths_of_pose: bool = False, mass_kg: SupportsFloat | SupportsIndex | None = None, force_n: ArrayLike | None = None, moment_n_m: ArrayLike | None = None, load_point_m: ArrayLike | None = None, wind_m_s: ArrayLike | None = None, cable_load_n_per_m: ArrayLike | None = None, tension_rule: TensionRule | None = None, target_tension_n: ArrayLike | None = None, min_tension_n: SupportsFloat | SupportsIndex | None = None, max_tension_n: SupportsFloat | SupportsIndex | None = None) -> SpeedsResults:
        """
        Computes what the winches do while the platform moves, and how fast their limits let it be.

        Parameters
        ----------
        required_velocity_m_s
            Largest required velocity of the platform origin, both ways along each world axis [m/s].
        required_angular_velocity_rad_s
            Largest required angular velocity, both ways about each world axis [rad/s].
        required_velocity_shape
            Shape of the set of required velocities, and of that of angular velocities: an ellipsoid with equal half
            axes is every direction up to one speed: `box` (every component varies by itself); `ellipsoid` (ellipsoid
            with these half axes; a ball if they are equal); if not given: from the robot file, or box.

        The other parameters are those of `Robot.equilibrium`.

        Returns
        -------
        The keys of the program's JSON: `every_direction` and `directions` with the largest speeds and what limits them,
        `cables` with rates, torques, largest speeds and used parts of the limits, and `required` with `speed_factor` and the
        powers of all motors; without `required` if no velocity is required.

        Raises
        ------
        StaticsError
            The robot has no such equilibrium, or its lengths have no rates there.
        """
    def sweep(self, /, vary: Mapping[str, ArrayLike], quantities: str | Sequence[str] | None = None, *, up_to_hz: SupportsFloat | SupportsIndex | None = None, platform_share: SupportsFloat | SupportsIndex | None = None, payload_center_m: ArrayLike | None = None, required_force_n: ArrayLike | None = None, required_moment_n_m: ArrayLike | None = None, required_shape: Literal['box', 'ellipsoid'] | None = None, required_payload_min_kg: SupportsFloat | SupportsIndex | None = None, required_payload_max_kg: SupportsFloat | SupportsIndex | None = None, required_payload_center_m: ArrayLike | None = None, required_payload_center_reach_m: ArrayLike | None = None, required_acceleration_m_s2: ArrayLike | None = None, required_angular_acceleration_rad_s2: ArrayLike | None = None, required_wind_speed_m_s: SupportsFloat | SupportsIndex | None = None, required_velocity_m_s: ArrayLike | None = None, required_angular_velocity_rad_s: ArrayLike | None = None, required_velocity_shape: Literal['box', 'ellipsoid'] | None = None, lengths_m: ArrayLike | None = None, pose: Pose | ArrayLike | None = None, hold_lengths_of_pose: bool = False, mass_kg: SupportsFloat | SupportsIndex | None = None, static_model: StaticModel = "catenary", force_n: ArrayLike | None = None, moment_n_m: ArrayLike | None = None, load_point_m: ArrayLike | None = None, wind_m_s: ArrayLike | None = None, cable_load_n_per_m: ArrayLike | None = None, tension_rule: TensionRule | None = None, target_tension_n: ArrayLike | None = None, min_tension_n: SupportsFloat | SupportsIndex | None = None, max_tension_n: SupportsFloat | SupportsIndex | None = None, cable_model: CableModel | None = None, assembly: Assembly = "consistent", in_plane_only: bool = False, winches: Winches = "as-given", file: str | PathLike[str] | None = None, resume: bool = False, discard: bool = False, part: str | None = None, threads: SupportsIndex | None = None, executor: Executor | Callable[[], Executor] | None = None, chunks_per_task: SupportsIndex | None = None, progress: Callable[[int, int], object] | None = None) -> Sweep:
        """
        Computes quantities over values of the robot file, one row per combination, as the program's `sweep`.

        Parameters
        ----------
        vary
            Values of the robot file that vary, by their paths as in `with_`: `{"platform.mass_kg": (10, 90, 81)}`. A
            tuple is the first value, the last value and their number; anything else is values. The first path varies
            fastest. `*` for any key moves all numbers that match together: `{"cables.*.anchor_m.z": (5, 6, 3)}`.
        quantities
            Quantities to compute at every point, described in docs/sweeps.md; tension-min, tension-max if not given.
        up_to_hz
            Upper limit of the search for natural frequencies [Hz]; 1000 if not given.
        platform_share
            Minimum fraction of the kinetic energy in the platform for a mode that counts as a mode of the platform; 0.5
            if not given.
        payload_center_m
            Centre of mass of the payload, platform frame [m]; if not given: that of the platform.
        required_force_n
            Largest required force, both ways along each world axis [N].
        required_moment_n_m
            Largest required moment about the platform origin, both ways about each world axis [N m].
        required_shape
            Shape of the set of required forces and moments: `box` (every component varies by itself); `ellipsoid`
            (ellipsoid with these half axes; a ball if they are equal); if not given: from the robot file, or box.
        required_payload_min_kg
            Minimum required payload [kg], which is always carried.
        required_payload_max_kg
            Maximum required payload [kg].
        required_payload_center_m
            Middle of the centres of mass of the required payload, platform frame [m].
        required_payload_center_reach_m
            Largest distance of the centre of mass of the payload from this middle, both ways along each axis of the
            platform [m].
        required_acceleration_m_s2
            Largest required acceleration of the platform origin from rest, both ways along each world axis [m/s²].
        required_angular_acceleration_rad_s2
            Largest required angular acceleration from rest, both ways about each world axis [rad/s²].
        required_wind_speed_m_s
            Speed of the required wind from every horizontal direction, on platform and ropes [m/s].
        required_velocity_m_s
            Largest required velocity of the platform origin, both ways along each world axis [m/s].
        required_angular_velocity_rad_s
            Largest required angular velocity, both ways about each world axis [rad/s].
        required_velocity_shape
            Shape of the set of required velocities, and of that of angular velocities: an ellipsoid with equal half
            axes is every direction up to one speed: `box` (every component varies by itself); `ellipsoid` (ellipsoid
            with these half axes; a ball if they are equal); if not given: from the robot file, or box.

        The other parameters are those of `map`.
        """
    def trajectory(self, /, path: str | PathLike[str] | Mapping[str, ArrayLike] | Callable[[float], ArrayLike] | None = None, move_to: Pose | ArrayLike | None = None, pose: Pose | ArrayLike | None = None, *, path_origin_m: ArrayLike | None = None, row_tolerance_m: SupportsFloat | SupportsIndex | None = None, via: ArrayLike | None = None, lift_m: SupportsFloat | SupportsIndex | None = None, blend: SupportsFloat | SupportsIndex | None = None, circle_center_m: ArrayLike | None = None, circle_axis: ArrayLike | None = None, turns: SupportsFloat | SupportsIndex | None = None, course: Literal['continuous-jerk', 'jerk-limited', 'quintic', 'septic'] = "continuous-jerk", speed_m_s: SupportsFloat | SupportsIndex | None = None, acceleration_m_s2: SupportsFloat | SupportsIndex | None = None, jerk_m_s3: SupportsFloat | SupportsIndex | None = None, angular_speed_rad_s: SupportsFloat | SupportsIndex | None = None, angular_acceleration_rad_s2: SupportsFloat | SupportsIndex | None = None, angular_jerk_rad_s3: SupportsFloat | SupportsIndex | None = None, duration_s: SupportsFloat | SupportsIndex | None = None, fastest: bool = False, rope_inertia: bool = False, sample_time_s: SupportsFloat | SupportsIndex | None = None, station_time_s: SupportsFloat | SupportsIndex | None = None, length_tolerance_m: SupportsFloat | SupportsIndex | None = None, lengths_m: ArrayLike | None = None, hold_lengths_of_pose: bool = False, mass_kg: SupportsFloat | SupportsIndex | None = None, static_model: StaticModel = "catenary", force_n: ArrayLike | None = None, moment_n_m: ArrayLike | None = None, load_point_m: ArrayLike | None = None, wind_m_s: ArrayLike | None = None, cable_load_n_per_m: ArrayLike | None = None, tension_rule: TensionRule | None = None, target_tension_n: ArrayLike | None = None, min_tension_n: SupportsFloat | SupportsIndex | None = None, max_tension_n: SupportsFloat | SupportsIndex | None = None, lengths: str | PathLike[str] | None = None, figure: str | PathLike[str] | None = None, page: str | PathLike[str] | None = None) -> TrajectoryResults:
        """
        Computes the motion along a path: lengths with their rates, tensions with the inertia, winches, and what limits them.

        Parameters
        ----------
        path
            Path over time: columns `t_s`, `x_m`, `y_m`, `z_m` and, where the platform turns, `roll_deg`, `pitch_deg`,
            `yaw_deg`, as a mapping, a data frame or a CSV file; or a function of the time [s] that returns x, y, z [m] or
            x, y, z, roll, pitch, yaw [m, degrees]. A function needs `duration_s` and `sample_time_s`. A spline of the
            fifth degree passes the rows.
        move_to
            Pose x,y,z[,roll,pitch,yaw] [m, degrees] to which the platform moves from the pose of the state, from rest
            to rest.
        path_origin_m
            Place of the zero of a job, world axes [m]; if not given: the zero of the world.
        row_tolerance_m
            Smooth the rows of `path` by less than this distance [m]: half a unit of their last digit takes their
            rounding out. Angles change by less than what moves the attachments as far; if not given: the path passes
            its rows.
        via
            Poses on the way to `move_to`: position [m] and roll, pitch, yaw [degrees].
        lift_m
            Pick and place: lift the platform by this height [m], carry it to `move_to`, and lower it there.
        blend
            Part of the time of slowing down by which the next move begins earlier, so that the path rounds the corner:
            0 stops at every pose of the way, 1 rounds most; 0 if not given.
        circle_center_m
            Centre of a circle on which the platform moves from the pose of the state, from rest to rest [m].
        circle_axis
            Direction of the axis of the circle; positive turns go round it by the right-hand rule; 0.0, 0.0, 1.0 if not
            given.
        turns
            Number of turns on the circle; negative turns go the other way; 1 if not given.
        course
            Form of the course of every move: `continuous-jerk` (fifteen phases: the jerk rises and falls in straight
            lines, so that the rates of the lengths do not jump); `jerk-limited` (seven phases of constant jerk: the
            fastest course within the limits); `quintic` (polynomial of the fifth degree; the jerk jumps at both ends);
            `septic` (polynomial of the seventh degree, without jerk at both ends).
        speed_m_s
            Largest speed of the platform origin [m/s]; if not given: none.
        acceleration_m_s2
            Largest acceleration of the origin [m/s²]; if not given: none.
        jerk_m_s3
            Largest rate of the acceleration [m/s³]; if not given: none: the acceleration and with it the tensions jump.
        angular_speed_rad_s
            Largest angular velocity of the platform [rad/s]; if not given: none.
        angular_acceleration_rad_s2
            Largest angular acceleration [rad/s²]; if not given: none.
        angular_jerk_rad_s3
            Largest rate of the angular acceleration [rad/s³]; if not given: none.
        duration_s
            Duration of the whole path [s]: all its times are multiplied by one factor. With the course `quintic` or
            `septic` it needs no limits: moves in a row then get times by their length, 1 rad like 1 m; if not given:
            that of the limits or of the table.
        fastest
            Find the shortest duration that keeps all limits of tensions and winches, by one factor of all times.
        rope_inertia
            Add the inertia of the ropes across them, as of taut strings, to that of the platform.
        sample_time_s
            Time between the rows of the result [s]; the last step may be shorter. Largest values do not depend on it;
            if not given: the rows of the table, or a two-hundredth of the duration.
        station_time_s
            Time between the lengths that a controller gets [s]; between them it changes the lengths in straight lines;
            if not given: that between the rows.
        length_tolerance_m
            Error of a length between two of them for which their number is listed [m]; 0.0001 if not given.
        lengths
            Write the lengths for a controller: t_s, and unstrained_length_NAME_m of every cable [m], a trajectory for
            `settle` (.csv).
        figure
            Draw tensions, lengths, speeds and powers over time, with their limits (.svg, .pdf).
        page
            Write a page with the moving robot, and tensions, speeds and powers over time (.html).

        The other parameters are those of `Robot.equilibrium`.

        Returns
        -------
        The keys of the program's JSON: `within_limits`, `most_used`, `extremes`, `stations`, `limit_changes`, and `rows` with
        a number or a list with a number per cable at every time.

        Raises
        ------
        StaticsError
            The cables do not hold the platform at some time of the path.
        """
    def uncertainty(self, /, deviations: Any = None, tolerances: Any = None, of: Result | Sequence[Result] | None = None, *, covariance: Any = None, hold: Hold = "lengths", below_hz: SupportsFloat | SupportsIndex | None = None, at_hz: ArrayLike | None = None, input: str | None = None, output: str | None = None, input_point_m: ArrayLike | None = None, output_point_m: ArrayLike | None = None, grid: Mapping[str, ArrayLike] | None = None, poses: ArrayLike | None = None, method: Method = "automatic", samples: SupportsIndex | None = None, seed: SupportsIndex | None = None, lengths_m: ArrayLike | None = None, pose: Pose | ArrayLike | None = None, hold_lengths_of_pose: bool = False, mass_kg: SupportsFloat | SupportsIndex | None = None, static_model: StaticModel = "catenary", force_n: ArrayLike | None = None, moment_n_m: ArrayLike | None = None, load_point_m: ArrayLike | None = None, wind_m_s: ArrayLike | None = None, cable_load_n_per_m: ArrayLike | None = None, tension_rule: TensionRule | None = None, target_tension_n: ArrayLike | None = None, min_tension_n: SupportsFloat | SupportsIndex | None = None, max_tension_n: SupportsFloat | SupportsIndex | None = None, cable_model: CableModel | None = None, assembly: Assembly = "consistent", in_plane_only: bool = False, winches: Winches = "as-given", samples_file: str | PathLike[str] | None = None, resume: bool = False, discard: bool = False, threads: SupportsIndex | None = None, progress: Callable[[int, int], object] | None = None, page: str | PathLike[str] | None = None) -> Uncertainty:
        """
        Computes the deviations of results from deviations or tolerances of numbers of the robot file.

        Results are linear in the deviations where no cable may become slack and no frequencies may cross; elsewhere
        robots are sampled, on all processors. docs/uncertainty.md explains the result. Theory, section "Uncertainty".

        Parameters
        ----------
        deviations
            Standard deviations of normally distributed numbers: a mapping from paths to values in the unit of the
            number, or to percentages such as "1%"; or a list of texts such as "platform.mass_kg=1%". In a path * stands
            for any key. Each entry is a group with a share of its own.
        tolerances
            Tolerances of numbers that are anywhere within ± their tolerance, in the same form.
        of
            Results, separated by commas: pose, lengths, tensions, rope-length, rope-mass, stiffness-min, load-factor,
            frequencies, damping, response; pose, tensions if not given.
        covariance
            Numbers that deviate together: a list of mappings with `first`, `second` (paths) and `covariance`, as the key
            `covariance` of the results of `calibrate`.
        hold
            Quantity that is held while the numbers deviate; with the pose held, the tensions parallel to the chords of
            more cables than degrees of freedom change least, or follow their rule: `lengths` (the unstrained lengths;
            the pose follows); `pose` (the pose; the unstrained lengths follow); `rule` (the pose and the rule of
            `tension_rule`; the unstrained lengths follow).
        below_hz
            Upper limit of the frequencies [Hz]; for frequencies and damping.
        at_hz
            Frequencies of the response [Hz], one or several. Results are its magnitudes in decibels of its unit, and its
            phases in degrees.
        input
            Input of the response (see `frf`).
        output
            Output of the response (see `frf`); results are its magnitudes in decibels and its phases in degrees.
        input_point_m
            Point where the force acts, platform frame [m]; if not given: the origin.
        output_point_m
            Point whose motion is measured, platform frame [m]; if not given: the origin.
        grid
            Axis of the grid: x, y, z [m], roll, pitch, yaw [degrees], with N values from A to B, or with listed values
            (repeatable); an axis that is not given keeps the value of the robot's state or of `pose`.
        poses
            Several poses, (n, 3) or (n, 6): x, y, z [m], roll, pitch, yaw [degrees].
        method
            Method for the deviations: `automatic` (linear where tensions and frequencies allow it, otherwise sampled);
            `linear` (linear for every result); `sampled` (sampled for every result).
        samples
            Number of sampled robots per pose that needs sampling, 10 to 1000000; with several groups, each group needs
            as many again; 200 if not given.
        seed
            Seed of the sample; 0 if not given.
        samples_file, resume, discard
            File of the sampled robots, .parquet or .csv: FILE.partial holds them until all are there, and `resume`
            continues with them.
        threads
            Number of threads of this process; one per processor if not given.
        progress
            Function that is called with the number of finished items and of all items.
        page
            Write a page with the deviations and what they come from (.html).

        The other parameters are those of `Robot.equilibrium` and of `Equilibrium.stiffness`.

        Raises
        ------
        InputError
            A path, a deviation or another argument is wrong; the message says which and what to give.
        StaticsError
            The robot has no equilibrium.
        FileError
            The file of the samples cannot be written, or belongs to other work.
        """
    def winches(self, /, grid: Mapping[str, ArrayLike] | None = None, pose: Pose | ArrayLike | None = None, *, poses: ArrayLike | None = None, offers: Any = None, drum_width_m: SupportsFloat | SupportsIndex | None = None, required_force_n: ArrayLike | None = None, required_moment_n_m: ArrayLike | None = None, required_shape: Literal['box', 'ellipsoid'] | None = None, required_payload_min_kg: SupportsFloat | SupportsIndex | None = None, required_payload_max_kg: SupportsFloat | SupportsIndex | None = None, required_payload_center_m: ArrayLike | None = None, required_payload_center_reach_m: ArrayLike | None = None, required_acceleration_m_s2: ArrayLike | None = None, required_angular_acceleration_rad_s2: ArrayLike | None = None, required_wind_speed_m_s: SupportsFloat | SupportsIndex | None = None, required_velocity_m_s: ArrayLike | None = None, required_angular_velocity_rad_s: ArrayLike | None = None, required_velocity_shape: Literal['box', 'ellipsoid'] | None = None, lengths_m: ArrayLike | None = None, hold_lengths_of_pose: bool = False, mass_kg: SupportsFloat | SupportsIndex | None = None, static_model: StaticModel = "catenary", force_n: ArrayLike | None = None, moment_n_m: ArrayLike | None = None, load_point_m: ArrayLike | None = None, wind_m_s: ArrayLike | None = None, cable_load_n_per_m: ArrayLike | None = None, tension_rule: TensionRule | None = None, target_tension_n: ArrayLike | None = None, min_tension_n: SupportsFloat | SupportsIndex | None = None, max_tension_n: SupportsFloat | SupportsIndex | None = None) -> WinchesResults:
        """
        Computes the winches that a robot needs over its poses, for everything that is required there.

        Parameters
        ----------
        grid
            Axis of the grid: x, y, z [m], roll, pitch, yaw [degrees], with N values from A to B, or with listed values
            (repeatable); an axis that is not given keeps the value of the robot's state or of `pose`.
        poses
            List of poses instead of a grid: position [m] and roll, pitch, yaw [degrees].
        offers
            Winches on offer, to be compared with the needs: `name`, and what each bears or gives, `tension_n`,
            `speed_m_s`, `acceleration_m_s2`, `torque_n_m`, `power_w`, `brake_power_w`, `rope_m`; what a winch does not
            say is not compared.
        drum_width_m
            Width of the drums between their flanges [m], for the layers of rope.
        required_force_n
            Largest required force, both ways along each world axis [N].
        required_moment_n_m
            Largest required moment about the platform origin, both ways about each world axis [N m].
        required_shape
            Shape of the set of required forces and moments: `box` (every component varies by itself); `ellipsoid`
            (ellipsoid with these half axes; a ball if they are equal); if not given: from the robot file, or box.
        required_payload_min_kg
            Minimum required payload [kg], which is always carried.
        required_payload_max_kg
            Maximum required payload [kg].
        required_payload_center_m
            Middle of the centres of mass of the required payload, platform frame [m].
        required_payload_center_reach_m
            Largest distance of the centre of mass of the payload from this middle, both ways along each axis of the
            platform [m].
        required_acceleration_m_s2
            Largest required acceleration of the platform origin from rest, both ways along each world axis [m/s²].
        required_angular_acceleration_rad_s2
            Largest required angular acceleration from rest, both ways about each world axis [rad/s²].
        required_wind_speed_m_s
            Speed of the required wind from every horizontal direction, on platform and ropes [m/s].
        required_velocity_m_s
            Largest required velocity of the platform origin, both ways along each world axis [m/s].
        required_angular_velocity_rad_s
            Largest required angular velocity, both ways about each world axis [rad/s].
        required_velocity_shape
            Shape of the set of required velocities, and of that of angular velocities: an ellipsoid with equal half
            axes is every direction up to one speed: `box` (every component varies by itself); `ellipsoid` (ellipsoid
            with these half axes; a ball if they are equal); if not given: from the robot file, or box.

        The other parameters are those of `Robot.equilibrium`.

        Returns
        -------
        The keys of the program's JSON: `winches` with the numbers of one winch that serves every cable and of each cable,
        `asked` with what asks for each number of the first, `poses`, `held`, `not_held`, and `offers` with the comparison.

        Raises
        ------
        StaticsError
            No pose holds every required load.
        """
    def workspace(self, /, at_least: Mapping[str, SupportsFloat | SupportsIndex] | None = None, at_most: Mapping[str, SupportsFloat | SupportsIndex] | None = None, grid: Mapping[str, ArrayLike] | None = None, *, step_m: SupportsFloat | SupportsIndex | None = None, orientations: Literal['all', 'some'] = "all", vertex_tolerance_m: SupportsFloat | SupportsIndex | None = None, rays: SupportsIndex | None = None, center_m: ArrayLike | None = None, section: Mapping[str, ArrayLike] | None = None, prove: bool = False, boxes: SupportsIndex | None = None, undecided: SupportsFloat | SupportsIndex | None = None, time_s: SupportsFloat | SupportsIndex | None = None, up_to_hz: SupportsFloat | SupportsIndex | None = None, platform_share: SupportsFloat | SupportsIndex | None = None, payload_center_m: ArrayLike | None = None, required_force_n: ArrayLike | None = None, required_moment_n_m: ArrayLike | None = None, required_shape: Literal['box', 'ellipsoid'] | None = None, required_payload_min_kg: SupportsFloat | SupportsIndex | None = None, required_payload_max_kg: SupportsFloat | SupportsIndex | None = None, required_payload_center_m: ArrayLike | None = None, required_payload_center_reach_m: ArrayLike | None = None, required_acceleration_m_s2: ArrayLike | None = None, required_angular_acceleration_rad_s2: ArrayLike | None = None, required_wind_speed_m_s: SupportsFloat | SupportsIndex | None = None, required_velocity_m_s: ArrayLike | None = None, required_angular_velocity_rad_s: ArrayLike | None = None, required_velocity_shape: Literal['box', 'ellipsoid'] | None = None, pose: Pose | ArrayLike | None = None, mass_kg: SupportsFloat | SupportsIndex | None = None, static_model: StaticModel = "catenary", force_n: ArrayLike | None = None, moment_n_m: ArrayLike | None = None, load_point_m: ArrayLike | None = None, wind_m_s: ArrayLike | None = None, cable_load_n_per_m: ArrayLike | None = None, tension_rule: TensionRule | None = None, target_tension_n: ArrayLike | None = None, min_tension_n: SupportsFloat | SupportsIndex | None = None, max_tension_n: SupportsFloat | SupportsIndex | None = None, cable_model: CableModel | None = None, assembly: Assembly = "consistent", in_plane_only: bool = False, winches: Winches = "as-given", compare: Robot | None = None, threads: SupportsIndex | None = None, progress: Callable[[int, int], object] | None = None, figure: str | PathLike[str] | None = None, surface: str | PathLike[str] | Sequence[str | PathLike[str]] | None = None, page: str | PathLike[str] | None = None, proved: str | PathLike[str] | Sequence[str | PathLike[str]] | None = None, certificate: str | PathLike[str] | None = None) -> WorkspaceResults:
        """
        Finds all positions at which quantities keep their limits: surface, volume, parts and holes.

        Without a limit the positions are those at which tensions within their limits hold the platform, with the required
        loads if there are any.

        Parameters
        ----------
        at_least, at_most
            Least and greatest values: a mapping from quantities of `map`, or their columns, to numbers.
        grid
            Axes of the grid: a mapping from x, y, z [m] to (first, last, number of values), and from roll, pitch, yaw
            [degrees] to such ranges or to lists of angles.
        step_m
            Step of the grid along axes that `grid` does not give [m]; if not given: a fortieth of the longest side.
        orientations
            Orientations of the grid that have to be possible at a position: `all` (positions at which every orientation
            of the grid is possible (total orientation workspace)); `some` (positions at which one of them is possible
            (inclusive orientation workspace)).
        vertex_tolerance_m
            Tolerance of the vertices along the edges of the grid, and of the ends of rays [m]; if not given: a
            hundredth of the smallest step.
        rays
            Number of rays from `center_m` for a second volume: 6, 18, 66, 258, 1026 … or 12, 42, 162, 642, 2562 …;
            every interval of a ray inside the set is kept.
        center_m
            Point from which the rays go out [m]; if not given: the centroid of the set.
        section
            Sections: a mapping from x, y or z to a list of coordinates [m].
        prove
            Prove as well in which parts of the box required loads are held at every position, not only at the nodes.
        boxes
            Maximum number of boxes into which the box is divided; if not given: 1 for `prove`, or 20000.
        undecided
            Share of the set that may be undecided: undecided volume over the volume that is not proved outside.
        time_s
            Time after which the division ends [s].
        up_to_hz
            Upper limit of the search for natural frequencies [Hz]; 1000 if not given.
        platform_share
            Minimum fraction of the kinetic energy in the platform for a mode that counts as a mode of the platform; 0.5
            if not given.
        payload_center_m
            Centre of mass of the payload, platform frame [m]; if not given: that of the platform.
        required_force_n
            Largest required force, both ways along each world axis [N].
        required_moment_n_m
            Largest required moment about the platform origin, both ways about each world axis [N m].
        required_shape
            Shape of the set of required forces and moments: `box` (every component varies by itself); `ellipsoid`
            (ellipsoid with these half axes; a ball if they are equal); if not given: from the robot file, or box.
        required_payload_min_kg
            Minimum required payload [kg], which is always carried.
        required_payload_max_kg
            Maximum required payload [kg].
        required_payload_center_m
            Middle of the centres of mass of the required payload, platform frame [m].
        required_payload_center_reach_m
            Largest distance of the centre of mass of the payload from this middle, both ways along each axis of the
            platform [m].
        required_acceleration_m_s2
            Largest required acceleration of the platform origin from rest, both ways along each world axis [m/s²].
        required_angular_acceleration_rad_s2
            Largest required angular acceleration from rest, both ways about each world axis [rad/s²].
        required_wind_speed_m_s
            Speed of the required wind from every horizontal direction, on platform and ropes [m/s].
        required_velocity_m_s
            Largest required velocity of the platform origin, both ways along each world axis [m/s].
        required_angular_velocity_rad_s
            Largest required angular velocity, both ways about each world axis [rad/s].
        required_velocity_shape
            Shape of the set of required velocities, and of that of angular velocities: an ellipsoid with equal half
            axes is every direction up to one speed: `box` (every component varies by itself); `ellipsoid` (ellipsoid
            with these half axes; a ball if they are equal); if not given: from the robot file, or box.
        compare
            Robot whose set is compared with this one on the same grid.
        threads
            Number of threads of this process; one per processor if not given.
        progress
            Function that is called with the number of positions that are done, and of those known to be needed.
        figure
            Draw the sections (.svg, .pdf).
        surface
            Write the closed surface of the set [m] to FILE.stl, FILE.ply or FILE.vtp (ParaView) (.stl, .ply, .vtp).
        page
            Write a page with the surface in space, the volumes and the sections (.html).
        proved
            Write the surface of what is proved inside [m] to FILE.stl, FILE.ply or FILE.vtp (ParaView) (.stl, .ply,
            .vtp).
        certificate
            Write a certificate as lines of JSON, which scripts/check_certificate.py checks with rational numbers
            (.jsonl).

        The other parameters are those of `Robot.equilibrium` and of `Equilibrium.stiffness`.

        Returns
        -------
        The keys of the program's JSON: `volumes` with the steps or the number of rays of each, `parts`, `holes`,
        `touches`, `bounds_m`, `inner_box`, `sections`, `rays`, `compared`, `proof`; `vertices_m` (n, 3) and `triangles` (m, 3) of the closed
        surface, whose first `triangles_of_surface` lie on the set and the others on the box of the grid.

        Raises
        ------
        InputError
            A quantity, an axis or another argument is wrong; the message says which and what to give.
        NoSolutionError
            No position of the grid meets the conditions.
        KeyboardInterrupt
            Ctrl-C stopped the search; any exception that another handler of signals or `progress` raises arrives as well. Its
            attribute `partial_results` has the `Results` of the steps that were ready, if there is a surface.

        References
        ----------
        docs/theory.md, section 10b.
        """

@final
class Simulation:
    """
    Robot in motion that advances by intervals, with inputs and events that are known only when they come.

    Made by `Equilibrium.simulation`. Arrays with one entry per cable are in the order of the file. What raises an
    exception leaves the simulation as it was.
    """
    def __copy__(self, /) -> Simulation: ...
    def __deepcopy__(self, /, memo: Any) -> Simulation: ...
    def __repr__(self, /) -> str: ...
    @property
    def acceleration_m_s2(self, /) -> NDArray[float64]:
        """
        Acceleration of the platform origin, world axes [m/s²].
        """
    @property
    def anchors_m(self, /) -> list[list[float]]:
        """
        Places of the anchors, world axes [m]: a row per cable.
        """
    @property
    def angular_acceleration_rad_s2(self, /) -> NDArray[float64]:
        """
        Angular acceleration of the platform, world axes [rad/s²].
        """
    @property
    def angular_velocity_rad_s(self, /) -> NDArray[float64]:
        """
        Angular velocity of the platform, world axes [rad/s].
        """
    @property
    def cable_names(self, /) -> list[str]:
        """
        Names of the cables, in the order of the file.
        """
    def change_lengths(self, /, changes_m: dict[str, Any] | ArrayLike, duration_s: SupportsFloat | SupportsIndex) -> None:
        """
        Lets winches at rest change lengths within a time, from rest to rest.

        Parameters
        ----------
        changes_m
            Changes of the unstrained lengths [m]: one per cable, or a dictionary by names.
        duration_s
            Duration [s].
        """
    def clone(self, /) -> Simulation:
        """
        Returns a simulation of its own in the same state.
        """
    def cut(self, /, cable: str, *, at_tension_n: SupportsFloat | SupportsIndex | None = None) -> None:
        """
        Cuts a cable at the platform, now or when its tension at either end reaches a value.

        Parameters
        ----------
        cable
            Name of the cable.
        at_tension_n
            Tension at which it fails [N]; it is cut now if not given.
        """
    @property
    def cut_cables(self, /) -> list[str]:
        """
        Names of the cables that have been cut or have failed.
        """
    @property
    def energy_j(self, /) -> dict[str, Any]:
        """
        Energies at the present time and works since the start [J]: `kinetic`, `strain`, `potential`, `winches`,
        `anchors`, `loads`, `dissipated`, `payloads`, `defect`.
        """
    def hold_tensions(self, /, tensions_n: dict[str, Any] | ArrayLike, duration_s: SupportsFloat | SupportsIndex) -> None:
        """
        Lets winches hold tensions from now on in place of lengths, by their torque.

        Parameters
        ----------
        tensions_n
            Tensions at the drums [N]: one per cable, or a dictionary by names.
        duration_s
            Time within which the tension goes from the present one to the given one [s].
        """
    @property
    def length_rate_m_s(self, /) -> NDArray[float64]:
        """
        Rates of the unstrained lengths [m/s].
        """
    def pick(self, /, mass_kg: SupportsFloat | SupportsIndex, point_m: ArrayLike | None = None, *, velocity_m_s: ArrayLike | None = None) -> None:
        """
        Takes a payload up now, a point mass that sticks to the platform.

        Parameters
        ----------
        mass_kg
            Mass of the payload [kg].
        point_m
            Point of the payload in the platform frame [m]; the centre of mass if not given.
        velocity_m_s
            Velocity of the payload before, world axes [m/s]; that of the platform if not given.
        """
    @property
    def pose(self, /) -> Pose:
        """
        Pose of the platform.
        """
    def push(self, /, duration_s: SupportsFloat | SupportsIndex, *, force_n: ArrayLike | None = None, moment_n_m: ArrayLike | None = None, point_m: ArrayLike | None = None, rise_s: SupportsFloat | SupportsIndex | None = None) -> None:
        """
        Pushes the platform for a while from now on.

        Parameters
        ----------
        duration_s
            Duration [s].
        force_n
            Force, world axes [N].
        moment_n_m
            Moment, world axes [N m].
        point_m
            Point at which the force acts, platform frame [m]; the origin if not given.
        rise_s
            Time in which the push grows at its beginning and fades at its end [s]; at once if not given.
        """
    def release(self, /, mass_kg: SupportsFloat | SupportsIndex, point_m: ArrayLike | None = None) -> None:
        """
        Lets a payload go now.

        Parameters
        ----------
        mass_kg
            Mass of the payload, a part of the platform's mass [kg].
        point_m
            Point of the payload in the platform frame [m]; the centre of mass if not given.
        """
    def restore(self, /, state: bytes) -> None:
        """
        Takes over a state that `save` returned, of a simulation with the same robot, start and settings. It goes on
        with the same bits.
        """
    def save(self, /) -> bytes:
        """
        Returns the state as bytes, for `restore`.
        """
    def step(self, /, dt_s: SupportsFloat | SupportsIndex, *, lengths_m: dict[str, Any] | ArrayLike | None = None, rates_m_s: dict[str, Any] | ArrayLike | None = None, accelerations_m_s2: dict[str, Any] | ArrayLike | None = None, force_n: ArrayLike | None = None, moment_n_m: ArrayLike | None = None, force_rate_n_s: ArrayLike | None = None, moment_rate_n_m_s: ArrayLike | None = None, wind_m_s: ArrayLike | None = None, anchors_m: dict[str, Any] | None = None, anchor_velocities_m_s: dict[str, Any] | None = None, anchor_accelerations_m_s2: dict[str, Any] | None = None) -> None:
        """
        Advances by an interval. What is left out goes on as it is: lengths with their last rates, force and moment with
        their last rates, the wind.

        Parameters
        ----------
        dt_s
            Interval [s], from 1e-6 to 1.
        lengths_m
            Unstrained lengths at the end of the interval [m]: one per cable, or a dictionary by names.
        rates_m_s
            Rates of these lengths at the end [m/s]. Without them a length may change by a micrometre.
        accelerations_m_s2
            Accelerations of these lengths at the end [m/s²]; without them the course is a cubic polynomial.
        force_n
            Force on the platform at the beginning, world axes [N], besides the load of the robot.
        moment_n_m
            Moment at the beginning about the platform origin, world axes [N m].
        force_rate_n_s
            Rate of the force [N/s]; zero if a force is given without.
        moment_rate_n_m_s
            Rate of the moment [N m/s]; zero if a moment is given without.
        wind_m_s
            Mean velocity of the wind, world axes [m/s].
        anchors_m
            Places of anchors at the end of the interval, world axes [m]: a dictionary from names of cables to x, y, z.
        anchor_velocities_m_s
            Velocities of these anchors at the end [m/s]. Without them an anchor may move by a micrometre.
        anchor_accelerations_m_s2
            Accelerations of these anchors at the end [m/s²]; without them the course is a cubic polynomial.

        Raises
        ------
        InputError
            An input is wrong; the simulation is as it was.
        NoSolutionError
            The motion cannot be followed; the simulation is as it was.
        """
    @property
    def steps(self, /) -> dict[str, Any]:
        """
        Numbers of the integrator's own steps so far: `accepted`, `rejected`, `factored`, `evaluations`.
        """
    def stop(self, /, duration_s: SupportsFloat | SupportsIndex, cables: SupportsGetItem[int, str] | None = None) -> None:
        """
        Brings winches to rest, with a continuous acceleration.

        Parameters
        ----------
        duration_s
            Duration [s].
        cables
            Names of the cables; all if not given.
        """
    @property
    def tension_anchor_n(self, /) -> NDArray[float64]:
        """
        Tensions at the anchors [N].
        """
    @property
    def tension_platform_n(self, /) -> NDArray[float64]:
        """
        Tensions at the platform [N].
        """
    @property
    def time_s(self, /) -> float:
        """
        Present time [s].
        """
    @property
    def unstrained_length_m(self, /) -> NDArray[float64]:
        """
        Unstrained lengths [m].
        """
    @property
    def velocity_m_s(self, /) -> NDArray[float64]:
        """
        Velocity of the platform origin, world axes [m/s].
        """

@final
class SweepPlan:
    """
    Plan of a map or sweep; its pickle is the request as JSON.
    """
    def __new__(cls, /, request: str, part: str | None = None) -> SweepPlan:
        """
        Makes the plan of a request in JSON; `part` is one of its parts, such as "3/8".
        """
    def __reduce__(self, /) -> tuple[Any, tuple[str, str | None]]: ...
    def begin(self, /, file: str | PathLike[str] | None = None, resume: bool = False, discard: bool = False, level: SupportsIndex = 2) -> SweepWork | None:
        """
        Begins to collect rows in memory or in a file; None if the file has all rows. Warns of values of the robot that
        no usual robot has.
        `level` is the number of functions between the user and this call.
        """
    @property
    def chunk_rows(self, /) -> int:
        """
        Number of rows of every chunk but the last.
        """
    @property
    def chunks(self, /) -> int:
        """
        Index behind the last chunk.
        """
    def compute(self, /, first: SupportsIndex, end: SupportsIndex, threads: SupportsIndex = ...) -> bytes:
        """
        Computes the chunks from `first` (included) to `end` (excluded), as bytes for `SweepWork.add`.
        """
    @property
    def first_chunk(self, /) -> int:
        """
        Index of the first chunk of rows; chunks are computed independently.
        """
    @property
    def rows(self, /) -> int:
        """
        Number of rows.
        """

@final
class SweepTable:
    """
    Rows of a sweep as columns in memory.
    """
    def __arrow_c_stream__(self, /, requested_schema: Any | None = None) -> Any:
        """
        Exports the rows as a C stream of Arrow, without copies.
        """
    def column(self, /, index: SupportsIndex) -> Any:
        """
        Returns one column: numbers (NaN if missing), flags, or a list of texts (None if missing).
        """
    @property
    def complete(self, /) -> bool:
        """
        True if every row of the plan is there.
        """
    @property
    def fields(self, /) -> list[tuple[str, str, str]]:
        """
        Names, units and meanings of the columns.
        """
    @property
    def plan(self, /) -> str:
        """
        Points, quantities and options, as JSON.
        """
    @staticmethod
    def read(path: str | PathLike[str]) -> SweepTable:
        """
        Reads a Parquet file of a sweep.
        """
    @property
    def robot_file(self, /) -> str:
        """
        Text of the robot file.
        """
    @property
    def rows(self, /) -> int:
        """
        Number of rows.
        """
    def write(self, /, path: str | PathLike[str]) -> None:
        """
        Writes .parquet, .csv or .vti; the file is complete or absent.
        """

@final
class SweepWork:
    """
    Collection of the rows of a plan, in their order.
    """
    def add(self, /, chunks: bytes) -> None:
        """
        Adds the next chunks, as bytes of `SweepPlan.compute`.
        """
    @property
    def done(self, /) -> int:
        """
        Number of finished rows.
        """
    def finish(self, /) -> SweepTable | None:
        """
        Ends the collection and writes the file. Returns the table of rows, or None if it is in a Parquet file.
        """
    def interrupt(self, /) -> str | None:
        """
        Ends the collection early. Returns a sentence about the rows that are safe, or None for rows in memory.
        """
    @property
    def journal(self, /) -> Path | None:
        """
        File that contains the rows until the end; None for rows in memory.
        """
    @property
    def next_chunk(self, /) -> int:
        """
        Index of the first missing chunk.
        """
    def run(self, /, threads: SupportsIndex | None = None, progress: Any | None = None) -> None:
        """
        Computes all missing chunks in parallel; `progress` is called with the number of finished rows and of all rows.
        """

def answer(request: str) -> str:
    """
    Computes the results of a request; both are JSON. Commands that make files, pages or rows are refused.
    """

def argument(command: str, key: str, name: str, value: Any, cables: SupportsGetItem[int, str]) -> str:
    """
    Reads the value of a key of a request, as JSON; `name` stands in errors, and `cables` are the names of the cables,
    if there are any. For functions of the package that are written in Python.
    """

def check_files(command: str, given: str, files: SupportsGetItem[int, tuple[str, str | PathLike[str]]]) -> None:
    """
    Checks files that a command shall write besides its result, before the work; `given` has its keys as JSON.
    """

def complete_request(request: str) -> str:
    """
    Adds the defaults to a request; both are JSON.
    """

def complex_numbers(name: str, values: ArrayLike) -> NDArray[complex128]:
    """
    Makes an array of complex numbers of any shape; `name` stands in errors. For functions of the package that are
    written in Python.
    """

def declarations() -> str:
    """
    Returns the declarations of all keywords as JSON: by commands, each key with its name, its type in Python, its
    meaning, its default, what stands for it if it is not given, the heading under which it stands, and its names.
    """

def figure_sizes() -> tuple[list[tuple[str, float]], tuple[float, float], tuple[float, float]]:
    """
    Returns the widths of columns of journals [mm], and minimum and maximum of a figure's width [mm] and of its texts
    [pt].
    """

def imported(request: str) -> tuple[str, list[str], list[str]]:
    """
    Computes robot file, assumptions and losses of a request of `import`.
    """

def interval(name: str, value: Any) -> tuple[float, float]:
    """
    Reads minimum and maximum of an interval; `name` stands in errors. For functions of the package that are written in
    Python.
    """

def library() -> list[tuple[str, str]]:
    """
    Returns the robots of the library: names, and texts of their files.
    """

def matlab_file(matrices: SupportsGetItem[int, tuple[str, SupportsIndex, SupportsGetItem[int, SupportsFloat | SupportsIndex]]], texts: SupportsGetItem[int, tuple[str, SupportsGetItem[int, str]]]) -> bytes:
    """
    Makes the bytes of a file of MATLAB from matrices (name, number of rows, entries by columns) and columns of texts.
    """

def measurements_of_file(path: str | PathLike[str], options: str) -> str:
    """
    Reads a file of measurements as an experiment in JSON. What is left out or converted is a `MeasurementWarning`.
    """

def merge_parts(parts: SupportsGetItem[int, str | PathLike[str]], path: str | PathLike[str]) -> int:
    """
    Joins the parts of a map or sweep; returns the number of rows.
    """

def number(name: str, value: Any) -> float:
    """
    Reads one number; `name` stands in errors. For functions of the package that are written in Python.
    """

def numbers(name: str, value: Any) -> list[float]:
    """
    Reads a row of numbers; `name` stands in errors. For functions of the package that are written in Python.
    """

def outputs_of_commands() -> str:
    """
    Files that commands write besides their result, as JSON: by the name of the command, with key, meaning, and whether
    there may be several.
    """

def peaks(hz: ArrayLike, response: ArrayLike, *, prominence_db: SupportsFloat | SupportsIndex | None = None) -> tuple[NDArray[float64], NDArray[float64], NDArray[float64]]:
    """
    Finds the peaks of a response; returns their frequencies [Hz], heights above the valleys beside them [dB] and
    magnitudes.

    Parameters
    ----------
    hz
        Frequencies [Hz] in ascending order.
    response
        Response at these frequencies, as `frf` returns it.
    prominence_db
        Minimum height of a peak above the valleys beside it [dB]; 1 if not given.
    """

def plot_page(path: str | PathLike[str], label: str, call: str) -> tuple[str, list[str]]:
    """
    Makes page and notes of the Parquet file of a map or sweep; `label` names the rows, `call` is the code that makes
    the page again.
    """

def real_numbers(name: str, values: ArrayLike) -> NDArray[float64]:
    """
    Makes an array of real numbers of any shape; `name` stands in errors. For functions of the package that are written
    in Python.
    """

def robot_of_source(source: str) -> Robot:
    """
    Robot of the text and the changes that a pickle contains, as JSON.
    """

def shown(message: str) -> str:
    """
    Returns a message in which text of the user can neither act on a terminal nor fill it, as all exceptions have it.
    """

def source_file(path: str | PathLike[str]) -> str:
    """
    Reads a file of another program for a request: path, text, and the encoding if it had to be guessed, as JSON.
    """

def suggested(word: str, known: SupportsGetItem[int, str]) -> str:
    """
    End of a message about an unknown word: the nearest known one, or all. For functions of the package that are written
    in Python.
    """

def text_of(request: str, call: str) -> tuple[str, list[str]]:
    """
    Computes text and caveats of a request whose result is a file, such as `report` or `export`; `call` is the code that
    makes a page again.
    """

def try_file(path: str | PathLike[str]) -> None:
    """
    Tries whether a file can be written, before the work whose result it shall hold.
    """

def unit_of_name(name: str) -> str:
    """
    Unit that the end of a name tells, as the conventions for climate and forecast (CF) write it; empty for a name
    without one.
    """

def write_file(path: str | PathLike[str], text: str) -> None:
    """
    Writes a text to a file, which is complete or absent.
    """

def write_unit(path: str | PathLike[str], limits: tuple[SupportsFloat | SupportsIndex, SupportsFloat | SupportsIndex], signals: SupportsLenAndGetItem[SupportsGetItem[int, tuple[str, str]]], matrices: SupportsLenAndGetItem[tuple[SupportsIndex, SupportsGetItem[int, SupportsFloat | SupportsIndex]]], robot_file: str, description: str) -> list[str]:
    """
    Writes a state space of the robot of a file as a Functional Mock-up Unit, and returns the caveats. `limits` are the
    highest frequency [Hz] and the error, `signals` names and units of inputs and outputs, `matrices` A, B, C, D with
    their numbers of rows and entries by columns.
    """

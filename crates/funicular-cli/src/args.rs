//! What the user can ask for.

mod export;
mod import;
mod request;
mod sweep;
pub(crate) mod values;

use clap::{Args, Parser, Subcommand, ValueEnum};
pub(crate) use export::{ExportArgs, ExportFormat};
use funicular::cable::CableModel;
use funicular::dynamics::Assembly;
use funicular::math::Vec3;
use funicular::statics::StaticModel;
use funicular_study::request::Change;
use funicular_study::signals::{Input, Output};
pub(crate) use import::ImportArgs;
use std::path::PathBuf;
pub(crate) use sweep::{EachArgs, MapArgs, MergeArgs, PlotArgs, RunArgs, SweepArgs};
use values::{Lengths, MassRange, PoseNumbers, Tensions};

/// Statics and vibration of cable-driven parallel robots whose cables sag.
///
/// All but `import`, `merge`, `paper`, `plot` and `validate` read a robot file (TOML); a result goes to stdout, what to mind to stderr. SI units;
/// the unit of every value is in its name. Exit codes: 0 done, 1 no solution, 2 bad input.
#[derive(Debug, Parser)]
#[command(name = "funicular", version, propagate_version = true, max_term_width = 110)]
#[command(after_help = "Example:\n  funicular modes robots/yuan2014-4mm.toml --below-hz 20")]
pub(crate) struct Cli {
    /// Print the request that the command stands for as JSON, and run nothing
    #[arg(long, global = true, help_heading = "Request")]
    pub(crate) print_request: bool,
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Read a robot file, check it, and say what the robot is
    #[command(after_help = "Examples:\n  funicular check robots/yuan2014-4mm.toml\n  \
        funicular check robots/cogiro.toml --set platform.mass_kg=300 --format json")]
    Check(CheckArgs),
    /// Every number of a robot file: path, value, unit, range, meaning
    ///
    /// The paths are those of `--set` and of `sweep --vary`. A number that the file leaves out stands there with its default.
    #[command(after_help = "Examples:\n  funicular parameters robots/yuan2014-4mm.toml\n  \
        funicular parameters robots/cogiro.toml --set cables.1.anchor_m.z=5.5 --format csv")]
    Parameters(CheckArgs),
    /// Equilibrium: pose, tensions, sag
    #[command(after_help = "Examples:\n  funicular statics robots/yuan2014-4mm.toml\n  \
        funicular statics robots/yuan2014-4mm.toml --pose 0,0,0.5 --mass-kg 20\n  \
        funicular statics robots/yuan2014-4mm.toml --lengths-m 6.9,6.6,6.8,6.7,6.8,6.6\n  \
        funicular statics robots/cogiro.toml --pose 1,2,1.5 --tension-rule middle --max-tension-n 1200")]
    Statics(StaticsArgs),
    /// The 6×6 stiffness at one frequency, static at 0 Hz
    #[command(after_help = "Examples:\n  funicular stiffness robots/yuan2014-4mm.toml\n  \
        funicular stiffness robots/yuan2014-4mm.toml --at-hz 3.5 --format json")]
    Stiffness(StiffnessArgs),
    /// Every natural frequency below a limit, counted: none missed
    #[command(after_help = "Examples:\n  funicular modes robots/yuan2014-4mm.toml --below-hz 20\n  \
        funicular modes robots/yuan2014-4mm.toml --below-hz 5 --input fz --output az\n  \
        funicular modes robots/yuan2014-4mm.toml --below-hz 5 --stations 21 -o modes.json\n  \
        funicular modes robots/cogiro.toml --below-hz 10 --cable-model spring -o modes.csv")]
    Modes(ModesArgs),
    /// Frequency response of the platform or of points on cables, and its peaks
    #[command(after_help = "Examples:\n  \
        funicular frf robots/yuan2014-4mm.toml --from-hz 0.1 --to-hz 10 --points 2000 \\\n    \
        --input fz --output ay\n  \
        funicular frf robots/yuan2014-4mm.toml --from-hz 0.1 --to-hz 100 --points 5000 --log \\\n    \
        --input f:1,0,1 --output x --output-point-m 0,0,-0.2 -o frf.csv\n  \
        funicular frf robots/yuan2014-4mm.toml --from-hz 0.1 --to-hz 10 --points 2000 \\\n    \
        --input fz --output cable:3@0.5:az")]
    Frf(FrfArgs),
    /// Every cable model side by side, and the simplest that is good enough
    #[command(after_help = "Example:\n  funicular compare robots/yuan2014-4mm.toml --below-hz 5")]
    Compare(CompareArgs),
    /// Poses of spring and catenary cables against ideal ones over platform mass
    #[command(after_help = "Examples:\n  funicular pose-error robots/yuan2014-4mm.toml --mass-kg 10.55:86.35:100\n  \
        funicular pose-error robots/yuan2014-8mm.toml --mass-kg 10:90:81 --tolerance-mm 5 --format csv")]
    PoseError(PoseErrorArgs),
    /// Dynamic stiffness of one cable over frequency
    #[command(after_help = "Example:\n  \
        funicular cable robots/yuan2014-4mm.toml --name 1 --from-hz 0.1 --to-hz 20 --points 1000")]
    Cable(CableArgs),
    /// A small second-order model M, C, K for control design, and its state space
    #[command(after_help = "Examples:\n  \
        funicular reduce robots/yuan2014-4mm.toml --below-hz 5 --input fz --output z --model model.npz\n  \
        funicular reduce robots/cogiro.toml --below-hz 10 --tolerance 0.01 --model model\n\n\
        In Python: m = numpy.load('model.npz'); m['M'], m['C'], m['K'], m['ss_A'], …\n\
        In MATLAB: M = readmatrix('model/M.csv'); sys = ss(A, B, C, D) from ss_A.csv, …")]
    Reduce(ReduceArgs),
    /// Tensions, frequencies, stiffness over the workspace: one row a pose
    #[command(after_help = "Examples:\n  \
        funicular map robots/cogiro.toml --grid x=-6:6:25 --grid y=-4:4:17 --grid z=0.5:3.5:7 \\\n    \
        --quantity tension-max,stiffness-min -o cogiro.parquet\n  \
        funicular map robots/yuan2014-4mm.toml --grid x=-1:1:21 --grid y=-1:1:21 --grid z=0.5 \\\n    \
        --quantity first-frequency,model-error:spring -o first.vti\n  \
        funicular map robots/cogiro.toml --poses trajectory.csv --quantity lengths,tensions --format csv\n\n\
        Stopped, killed or out of power: the same command with --resume goes on, and ends with the same file.\n\
        As a job array: --part 3/8 -o part-3.parquet, and at the end funicular merge part-*.parquet -o all.parquet")]
    Map(MapArgs),
    /// The same over values of the robot file: one row a combination
    #[command(after_help = "Examples:\n  \
        funicular sweep robots/yuan2014-4mm.toml --vary platform.mass_kg=10.55:86.35:50 \\\n    \
        --quantity pose,first-frequency,pose-error -o mass.parquet\n  \
        funicular sweep robots/yuan2014-4mm.toml --pose 0,0,0.5 --vary materials.rope-4mm.diameter_m=0.002:0.008:25 \\\n    \
        --vary platform.mass_kg=10,20,40 --quantity tension-max,sag-max --format csv")]
    Sweep(SweepArgs),
    /// Parts of a map or sweep become one file
    #[command(after_help = "Example:\n  funicular merge part-*.parquet -o all.parquet")]
    Merge(MergeArgs),
    /// A map or sweep in pictures: one page that opens offline
    ///
    /// Grids as slices with contours, the feasible set, histograms and points in space; trajectories and sweeps of one value
    /// as curves, the natural frequencies with their modes followed through crossings and veering. docs/sweeps.md says how.
    #[command(
        after_help = "Examples:\n  funicular map robots/cogiro.toml --grid x=-6:6:25 --grid y=-4:4:17 --grid z=0.5:3.5:7 \\\n    \
        --quantity tension-max,stiffness-min -o cogiro.parquet\n  funicular plot cogiro.parquet\n  \
        funicular plot mass.parquet -o mass.html"
    )]
    Plot(PlotArgs),
    /// All of it on one page, figures included
    #[command(after_help = "Examples:\n  funicular report\n  \
        funicular report robots/cogiro.toml -o cogiro.html\n  \
        funicular report robots/yuan2014-4mm.toml --pose 0,0,0.5 --below-hz 10 --input f:1,0,1 --output x")]
    Report(ReportArgs),
    /// Every figure and table of Yuan et al. 2014, theirs beside ours, on one page
    #[command(after_help = "Example:\n  funicular paper -o paper.html")]
    Paper(PaperArgs),
    /// A robot file from files of CASPR, WireX or MoorDyn
    ///
    /// CASPR: the bodies file and the cables file, in any order. WireX: a .wcrfx file. MoorDyn: an input file of version 2
    /// with one body, or one free point, on lines. What a file lacks is asked for, nothing is made up; what a robot file
    /// cannot hold is listed, also at the head of the file. docs/import.md says how each number is read.
    #[command(
        after_help = "Examples:\n  funicular import docs/import/tripod_bodies.xml docs/import/tripod_cables.xml \\\n    \
        --mass-kg-per-m 0.05 --axial-stiffness-n 1e6 -o tripod.toml\n  \
        funicular import robot.wcrfx --pose 0,0,1 -o robot.toml\n  \
        funicular import mooring.txt -o robot.toml"
    )]
    Import(ImportArgs),
    /// The robot at its state for OpenSees, MoorDyn or ParaView
    ///
    /// opensees: a Python script for OpenSeesPy, statics and modes beside funicular's. moordyn: an input file of version 2. vtk:
    /// a .vtp file of cables and platform, with their modes on request. docs/export.md says what each holds, and by how
    /// much the programs differ.
    #[command(after_help = "Examples:\n  \
        funicular export robots/yuan2014-4mm.toml --to opensees -o yuan.py && python3 yuan.py\n  \
        funicular export robots/cogiro.toml --to moordyn --segments 20 -o cogiro.txt\n  \
        funicular export robots/cogiro.toml --to vtk --pose 1,2,1.5 --modes-below-hz 10 -o cogiro.vtp")]
    Export(ExportArgs),
    /// Compare the program with numbers that others published or computed; exit code 1 if one is not within tolerance
    #[command(after_help = "Examples:\n  funicular validate\n  funicular validate -o docs/validation.md\n  \
        funicular validate --format json")]
    Validate(ValidateArgs),
    /// Run a request written as JSON: the options of any command and the text of the robot file in one object
    ///
    /// Every command prints its request with --print-request. The keys are the names of the options, with _ for -.
    #[command(
        after_help = "Example:\n  funicular statics robots/cogiro.toml --pose 1,2,1.5 --print-request > request.json\n  \
        funicular request request.json --format json"
    )]
    Request(RequestArgs),
}

/// The robot.
#[derive(Debug, Args)]
pub(crate) struct RobotArgs {
    /// Robot file (TOML), or - for standard input
    #[arg(value_name = "ROBOT")]
    pub(crate) robot: PathBuf,
    #[command(flatten)]
    pub(crate) changes: ChangeArgs,
}

/// Changes of the robot file.
#[derive(Debug, Args)]
pub(crate) struct ChangeArgs {
    /// Change a value of the robot file, as in platform.mass_kg=20 or cables.3.unstrained_length_m=6.7 (cables by their name; repeatable)
    #[arg(long, value_name = "PATH=VALUE", value_parser = funicular_study::set_values::change)]
    pub(crate) set: Vec<Change>,
}

/// The state: as the robot file says, or as these options say.
#[derive(Debug, Args)]
#[command(next_help_heading = "State")]
pub(crate) struct StateArgs {
    /// Unstrained lengths [m], one a cable in file order; the pose follows
    #[arg(long, value_name = "L1,L2,…", value_parser = values::lengths, allow_hyphen_values = true, conflicts_with = "pose")]
    pub(crate) lengths_m: Option<Lengths>,

    /// Pose x,y,z[,roll,pitch,yaw] [m, degrees], R = Rz(yaw) Ry(pitch) Rx(roll); the lengths follow
    #[arg(long, value_name = "X,Y,Z[,ROLL,PITCH,YAW]", value_parser = values::pose, allow_hyphen_values = true)]
    pub(crate) pose: Option<PoseNumbers>,

    /// Mass of the platform [kg]; inertia and centre of mass stay
    #[arg(long, value_name = "KG", value_parser = values::positive, allow_hyphen_values = true)]
    pub(crate) mass_kg: Option<f64>,

    /// How cables carry their static load
    #[arg(long, value_name = "MODEL", value_enum, default_value_t)]
    pub(crate) static_model: StaticModelName,
    #[command(flatten)]
    pub(crate) load: LoadArgs,
}

/// What acts on platform and cables besides their weight, fixed in the world; instead of what the robot file says.
#[derive(Debug, Clone, Copy, Args)]
#[command(next_help_heading = "Load")]
pub(crate) struct LoadArgs {
    /// Force on the platform, world axes [N]
    #[arg(long, visible_alias = "force", value_name = "X,Y,Z", value_parser = values::point, allow_hyphen_values = true)]
    pub(crate) force_n: Option<Vec3>,

    /// Moment on the platform, world axes [N m]
    #[arg(long, visible_alias = "moment", value_name = "X,Y,Z", value_parser = values::point, allow_hyphen_values = true)]
    pub(crate) moment_n_m: Option<Vec3>,

    /// Point where the force acts, platform frame [m] [default: as the robot file says, or the origin]
    #[arg(long, value_name = "X,Y,Z", value_parser = values::point, allow_hyphen_values = true)]
    pub(crate) load_point_m: Option<Vec3>,

    /// Steady wind, world axes [m/s], on ropes with a `drag_coefficient` and platforms with a `drag_area_m2`
    #[arg(long, visible_alias = "wind", value_name = "X,Y,Z", value_parser = values::point, allow_hyphen_values = true)]
    pub(crate) wind_m_s: Option<Vec3>,

    /// Load per metre of every cable besides its weight, world axes [N/m]
    #[arg(long, value_name = "X,Y,Z", value_parser = values::point, allow_hyphen_values = true)]
    pub(crate) cable_load_n_per_m: Option<Vec3>,
}

/// How the robot is linearised.
#[derive(Debug, Args)]
#[command(next_help_heading = "Model")]
pub(crate) struct ModelArgs {
    /// How cables answer motion of the platform [default: catenary-dynamic; shallow-dynamic for static models other than catenary]
    #[arg(long, value_name = "MODEL", value_enum)]
    pub(crate) cable_model: Option<CableModelName>,
    #[command(flatten)]
    pub(crate) terms: TermArgs,
}

/// What of a cable's stiffness counts.
#[derive(Debug, Args)]
#[command(next_help_heading = "Model")]
pub(crate) struct TermArgs {
    /// Terms of the stiffness: all (consistent), or the cables' end stiffness only, as Yuan et al. 2014 (paper)
    #[arg(long, value_name = "TERMS", value_enum, default_value_t)]
    pub(crate) assembly: AssemblyName,

    /// Leave out the stiffness of cables out of their planes, as Yuan et al. 2014
    #[arg(long)]
    pub(crate) in_plane_only: bool,
}

/// What the result looks like and where it goes.
#[derive(Debug, Args)]
#[command(next_help_heading = "Output")]
pub(crate) struct OutputArgs {
    /// Format of the result [default: by the ending of FILE, else text]
    #[arg(long, value_name = "FORMAT", value_enum)]
    pub(crate) format: Option<Format>,

    /// Write the result to FILE, as a whole or not at all, instead of standard output (-)
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output_file: Option<PathBuf>,
}

/// A range of frequencies.
#[derive(Debug, Args)]
pub(crate) struct RangeArgs {
    /// First frequency [Hz]
    #[arg(long, value_name = "HZ", value_parser = values::not_negative, allow_hyphen_values = true)]
    pub(crate) from_hz: f64,

    /// Last frequency [Hz]
    #[arg(long, value_name = "HZ", value_parser = values::positive, allow_hyphen_values = true)]
    pub(crate) to_hz: f64,

    /// Number of frequencies, 2 to 1000000
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(2..=1_000_000), allow_hyphen_values = true)]
    pub(crate) points: u64,

    /// Equal ratios between frequencies instead of equal steps
    #[arg(long)]
    pub(crate) log: bool,
}

#[derive(Debug, Args)]
pub(crate) struct CheckArgs {
    #[command(flatten)]
    pub(crate) robot: RobotArgs,
    #[command(flatten)]
    pub(crate) output: OutputArgs,
}

#[derive(Debug, Args)]
pub(crate) struct StaticsArgs {
    #[command(flatten)]
    pub(crate) robot: RobotArgs,
    #[command(flatten)]
    pub(crate) state: StateArgs,
    #[command(flatten)]
    pub(crate) tensions: TensionArgs,

    /// Search for all equilibria of these unstrained lengths, also the unstable ones
    #[arg(long)]
    pub(crate) all: bool,
    #[command(flatten)]
    pub(crate) output: OutputArgs,
}

/// Which tensions a robot with more cables than degrees of freedom has at a pose.
#[derive(Debug, Args)]
#[command(next_help_heading = "Tensions")]
pub(crate) struct TensionArgs {
    /// Which of the tensions that hold a pose: more cables than degrees of freedom leave a choice [default: lowest]
    #[arg(long, value_name = "RULE", value_enum)]
    pub(crate) tension_rule: Option<TensionRuleName>,

    /// Tension that cables shall be near to [N], one for all or one a cable in file order; the rule is then closest
    #[arg(long, value_name = "T|T1,T2,…", value_parser = values::tensions, allow_hyphen_values = true)]
    pub(crate) target_tension_n: Option<Tensions>,

    /// Least tension anywhere in a cable [N] [default: as the robot file says, or 2.5 times the cable's weight]
    #[arg(long, value_name = "N", value_parser = values::not_negative, allow_hyphen_values = true)]
    pub(crate) min_tension_n: Option<f64>,

    /// Greatest tension anywhere in a cable [N] [default: as the robot file says, or none]
    #[arg(long, value_name = "N", value_parser = values::positive, allow_hyphen_values = true)]
    pub(crate) max_tension_n: Option<f64>,
}

#[derive(Debug, Args)]
pub(crate) struct StiffnessArgs {
    #[command(flatten)]
    pub(crate) robot: RobotArgs,

    /// Frequency [Hz]. At 0 the exact tangent of the static model, unless --cable-model says otherwise
    #[arg(long, value_name = "HZ", value_parser = values::not_negative, allow_hyphen_values = true, default_value = "0")]
    pub(crate) at_hz: f64,

    #[command(flatten)]
    pub(crate) state: StateArgs,
    #[command(flatten)]
    pub(crate) model: ModelArgs,
    #[command(flatten)]
    pub(crate) output: OutputArgs,
}

#[derive(Debug, Args)]
pub(crate) struct ModesArgs {
    #[command(flatten)]
    pub(crate) robot: RobotArgs,

    /// Limit of the frequencies [Hz]
    #[arg(long, value_name = "HZ", value_parser = values::positive, allow_hyphen_values = true)]
    pub(crate) below_hz: f64,

    /// Say how much each mode takes part in the response to this input: as of `frf`; needs --output
    #[arg(long, value_name = "INPUT", value_parser = Input::parse, requires = "output")]
    pub(crate) input: Option<Input>,

    /// The output of that response; needs --input
    #[arg(long, value_name = "OUTPUT", value_parser = Output::parse, requires = "input")]
    pub(crate) output: Option<Output>,
    #[command(flatten)]
    pub(crate) points: PointArgs,

    /// Displacements of N points along every cable in each mode, ends included; in JSON
    #[arg(long, value_name = "N", value_parser = values::stations)]
    pub(crate) stations: Option<usize>,

    #[command(flatten)]
    pub(crate) state: StateArgs,
    #[command(flatten)]
    pub(crate) model: ModelArgs,
    #[command(flatten)]
    pub(crate) sink: OutputArgs,
}

#[derive(Debug, Args)]
pub(crate) struct FrfArgs {
    #[command(flatten)]
    pub(crate) robot: RobotArgs,
    #[command(flatten)]
    pub(crate) range: RangeArgs,

    /// Force fx, fy, fz, moment mx, my, mz, or f:ux,uy,uz, m:ux,uy,uz along a direction; world axes; a force on a cable as in cable:3@0.5:fz
    #[arg(long, value_name = "INPUT", value_parser = Input::parse)]
    pub(crate) input: Input,

    /// Displacement x, y, z, rotation rx, ry, rz, velocity vx … vrz, acceleration ax … arz, or x:ux,uy,uz, v:…, a:… along a direction; world axes; a point of a cable (name, part of its length from the platform) as in cable:3@0.5:az
    #[arg(long, value_name = "OUTPUT", value_parser = Output::parse)]
    pub(crate) output: Output,
    #[command(flatten)]
    pub(crate) points: PointArgs,

    /// Least height of a peak above the valleys beside it [dB]
    #[arg(long, value_name = "DB", value_parser = values::not_negative, allow_hyphen_values = true, default_value = "1")]
    pub(crate) prominence_db: f64,

    #[command(flatten)]
    pub(crate) state: StateArgs,
    #[command(flatten)]
    pub(crate) model: ModelArgs,
    #[command(flatten)]
    pub(crate) sink: OutputArgs,
}

/// Where a response begins and ends.
#[derive(Debug, Args)]
pub(crate) struct PointArgs {
    /// Point where the force acts, platform frame [m] [default: the origin]
    #[arg(long, value_name = "X,Y,Z", value_parser = values::point, allow_hyphen_values = true)]
    pub(crate) input_point_m: Option<Vec3>,

    /// Point whose motion is measured, platform frame [m] [default: the origin]
    #[arg(long, value_name = "X,Y,Z", value_parser = values::point, allow_hyphen_values = true)]
    pub(crate) output_point_m: Option<Vec3>,
}

#[derive(Debug, Args)]
pub(crate) struct ReduceArgs {
    #[command(flatten)]
    pub(crate) robot: RobotArgs,

    /// Highest frequency that the model is for [Hz]
    #[arg(long, value_name = "HZ", value_parser = values::positive, allow_hyphen_values = true)]
    pub(crate) below_hz: f64,

    /// An input, as of `frf` (repeatable) [default: all forces and moments on the platform]
    #[arg(long, value_name = "INPUT", value_parser = Input::parse)]
    pub(crate) input: Vec<Input>,

    /// An output, as of `frf` (repeatable) [default: all displacements and rotations of the platform]
    #[arg(long, value_name = "OUTPUT", value_parser = Output::parse)]
    pub(crate) output: Vec<Output>,
    #[command(flatten)]
    pub(crate) points: PointArgs,

    /// Largest relative error of the responses by modes left out
    #[arg(long, value_name = "PART", value_parser = values::not_negative, allow_hyphen_values = true, default_value = "0.001")]
    pub(crate) tolerance: f64,

    /// Make constant damping ratios viscous so that they are right at this frequency [Hz] [default: at every natural frequency]
    #[arg(long, value_name = "HZ", value_parser = values::positive, allow_hyphen_values = true)]
    pub(crate) damping_at_hz: Option<f64>,

    /// Write the matrices to an .npz file, or as CSV files into a new folder
    #[arg(long = "model", value_name = "FILE.npz|FOLDER")]
    pub(crate) model_file: Option<PathBuf>,

    #[command(flatten)]
    pub(crate) state: StateArgs,
    #[command(flatten)]
    pub(crate) model: ModelArgs,
    #[command(flatten)]
    pub(crate) sink: OutputArgs,
}

#[derive(Debug, Args)]
pub(crate) struct CompareArgs {
    #[command(flatten)]
    pub(crate) robot: RobotArgs,

    /// Limit of the frequencies [Hz]
    #[arg(long, value_name = "HZ", value_parser = values::positive, allow_hyphen_values = true)]
    pub(crate) below_hz: f64,

    #[command(flatten)]
    pub(crate) state: StateArgs,
    #[command(flatten)]
    pub(crate) terms: TermArgs,
    #[command(flatten)]
    pub(crate) output: OutputArgs,
}

#[derive(Debug, Args)]
pub(crate) struct PoseErrorArgs {
    #[command(flatten)]
    pub(crate) robot: RobotArgs,

    /// Platform masses [kg] from A to B, N of them in equal steps, as in 10:90:81
    #[arg(long, value_name = "A:B:N", value_parser = values::mass_range, allow_hyphen_values = true)]
    pub(crate) mass_kg: MassRange,

    /// Unstrained lengths [m], one a cable in file order [default: as the robot file says]
    #[arg(long, value_name = "L1,L2,…", value_parser = values::lengths, allow_hyphen_values = true)]
    pub(crate) lengths_m: Option<Lengths>,

    /// Name the mass from which on the spring pose is this near to the catenary pose [mm]
    #[arg(long, value_name = "MM", value_parser = values::positive, allow_hyphen_values = true)]
    pub(crate) tolerance_mm: Option<f64>,

    #[command(flatten)]
    pub(crate) output: OutputArgs,
}

#[derive(Debug, Args)]
pub(crate) struct CableArgs {
    #[command(flatten)]
    pub(crate) robot: RobotArgs,

    /// Name of the cable in the robot file
    #[arg(long, value_name = "NAME", allow_hyphen_values = true)]
    pub(crate) name: String,

    #[command(flatten)]
    pub(crate) range: RangeArgs,
    #[command(flatten)]
    pub(crate) state: StateArgs,

    /// How the cable answers motion of its platform end [default: catenary-dynamic; shallow-dynamic for static models other than catenary]
    #[arg(long, value_name = "MODEL", value_enum)]
    pub(crate) cable_model: Option<CableModelName>,

    /// Leave out the stiffness out of the cable's plane, as Yuan et al. 2014
    #[arg(long)]
    pub(crate) in_plane_only: bool,

    #[command(flatten)]
    pub(crate) output: OutputArgs,
}

#[derive(Debug, Args)]
pub(crate) struct ReportArgs {
    /// Robot file (TOML), or - for standard input [default: the robot that the program carries, yuan2014-4mm.toml]
    #[arg(value_name = "ROBOT")]
    pub(crate) robot: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) changes: ChangeArgs,

    /// Limit of the frequencies [Hz]
    #[arg(long, value_name = "HZ", value_parser = values::positive, allow_hyphen_values = true, default_value = "20")]
    pub(crate) below_hz: f64,

    /// Force or moment of the frequency response: fx … mz, or f:ux,uy,uz, m:ux,uy,uz, as of `funicular frf` [default: fz; fx of a platform that cannot move along z]
    #[arg(long, value_name = "INPUT", value_parser = Input::parse)]
    pub(crate) input: Option<Input>,

    /// Motion of the frequency response: x … arz, or x:ux,uy,uz, v:…, a:…, as of `funicular frf` [default: az; ax of a platform that cannot move along z]
    #[arg(long, value_name = "OUTPUT", value_parser = Output::parse)]
    pub(crate) output: Option<Output>,
    #[command(flatten)]
    pub(crate) points: PointArgs,

    #[command(flatten)]
    pub(crate) state: StateArgs,
    #[command(flatten)]
    pub(crate) model: ModelArgs,

    /// Write the page to FILE, as a whole or not at all; - is standard output
    #[arg(short, long, value_name = "FILE", default_value = "funicular-report.html", help_heading = "Output")]
    pub(crate) output_file: PathBuf,
}

#[derive(Debug, Args)]
pub(crate) struct PaperArgs {
    /// Write the page to FILE, as a whole or not at all; - is standard output
    #[arg(short, long, value_name = "FILE", default_value = "funicular-paper.html")]
    pub(crate) output_file: PathBuf,
}

#[derive(Debug, Args)]
pub(crate) struct RequestArgs {
    /// The request (JSON), or - for standard input
    #[arg(value_name = "FILE.json")]
    pub(crate) file: PathBuf,
    #[command(flatten)]
    pub(crate) run: RunArgs,
}

#[derive(Debug, Args)]
pub(crate) struct ValidateArgs {
    #[command(flatten)]
    pub(crate) output: OutputArgs,
}

/// Format of a result.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Format {
    /// Tables to read, rounded
    Text,
    /// One object, every digit
    Json,
    /// One table with a header, every digit
    Csv,
}

/// Names of [`funicular::statics::TensionRule`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum TensionRuleName {
    /// Least sum of squares of the tensions above their minimum
    Lowest,
    /// Least sum of squares of the differences from --target-tension-n
    Closest,
    /// Farthest from the limits, relative to the distance between them
    Middle,
    /// Largest least eigenvalue of the scaled stiffness
    Stiffest,
}

/// Names of [`StaticModel`].
#[derive(Debug, Clone, Copy, Default, ValueEnum)]
pub(crate) enum StaticModelName {
    /// Straight, massless, rigid
    Ideal,
    /// Straight, massless, elastic
    Spring,
    /// Elastic, sagging under its own weight
    #[default]
    Catenary,
}

impl From<StaticModelName> for StaticModel {
    fn from(name: StaticModelName) -> Self {
        match name {
            StaticModelName::Ideal => Self::Ideal,
            StaticModelName::Spring => Self::Spring,
            StaticModelName::Catenary => Self::Catenary,
        }
    }
}

/// Names of [`CableModel`].
#[derive(Debug, Clone, Copy, ValueEnum)]
pub(crate) enum CableModelName {
    /// Vibration about the elastic catenary: any sag, axial waves included
    CatenaryDynamic,
    /// Dynamic stiffness of a shallow sagging cable (Starossek 1991)
    ShallowDynamic,
    /// Static stiffness of a shallow sagging cable (Irvine 1981)
    ShallowStatic,
    /// Exact static stiffness of the elastic catenary
    CatenaryStatic,
    /// Massless spring along the chord
    Spring,
}

impl From<CableModelName> for CableModel {
    fn from(name: CableModelName) -> Self {
        match name {
            CableModelName::CatenaryDynamic => Self::CatenaryDynamic,
            CableModelName::ShallowDynamic => Self::ShallowDynamic,
            CableModelName::ShallowStatic => Self::ShallowStatic,
            CableModelName::CatenaryStatic => Self::CatenaryStatic,
            CableModelName::Spring => Self::Spring,
        }
    }
}

/// Names of [`Assembly`].
#[derive(Debug, Clone, Copy, Default, ValueEnum)]
pub(crate) enum AssemblyName {
    /// The whole tangent: end stiffness and the turning of forces on their lever arms
    #[default]
    Consistent,
    /// End stiffness only
    WithoutGeometricStiffness,
}

impl From<AssemblyName> for Assembly {
    fn from(name: AssemblyName) -> Self {
        match name {
            AssemblyName::Consistent => Self::Consistent,
            AssemblyName::WithoutGeometricStiffness => Self::WithoutGeometricStiffness,
        }
    }
}

//! Arguments of the program.

mod design;
mod export;
mod gradient;
mod groups;
mod identify;
mod import;
mod names;
mod new_robot;
mod pages;
mod request;
mod statics;
mod sweep;
mod uncertainty;
pub(crate) mod values;
mod vibration;

use clap::{Args, Parser, Subcommand, ValueEnum};
pub(crate) use design::DesignArgs;
pub(crate) use export::{ExportArgs, ExportFormat};
pub(crate) use gradient::GradientArgs;
pub(crate) use groups::{
    ChangeArgs, FigureArgs, LinearisedArgs, LoadArgs, LoadedRobotArgs, ModelArgs, OptionalRobotArgs, OutputArgs,
    PointArgs, RangeArgs, RobotArgs, StateArgs, TensionArgs, TermArgs,
};
pub(crate) use identify::IdentifyArgs;
pub(crate) use import::ImportArgs;
pub(crate) use names::{AssemblyName, CableModelName, TensionRuleName, WinchModeName};
pub(crate) use new_robot::{LengthUnitName, MotionName, NewArgs, RopeName, SchemaArgs};
pub(crate) use pages::{LiveArgs, PaperArgs, ReportArgs};
pub(crate) use statics::{CheckArgs, PayloadArgs, PoseErrorArgs, StaticsArgs, StiffnessArgs};
use std::path::PathBuf;
pub(crate) use sweep::{EachArgs, MapArgs, MergeArgs, PlotArgs, RunArgs, SweepArgs};
pub(crate) use uncertainty::UncertaintyArgs;
pub(crate) use vibration::{CableArgs, CompareArgs, FrfArgs, ModesArgs, ReduceArgs};

/// Statics and vibration of cable-driven parallel robots whose cables sag.
///
/// All commands except `new`, `schema`, `import`, `merge`, `paper`, `plot`, `validate` and `request` read a robot file
/// (TOML). Results go to stdout, warnings and errors to stderr. Units are SI units, and the unit of every value is in
/// its name. Exit codes: 0 done, 1 no solution, 2 bad input, 130 stopped by Ctrl-C or the end of a job.
#[derive(Debug, Parser)]
#[command(name = "funicular", version, propagate_version = true, max_term_width = 110)]
#[command(after_help = "Example:\n  funicular modes robots/yuan2014-4mm.toml --below-hz 20")]
pub(crate) struct Cli {
    /// Print the request of this command as JSON instead of running it
    #[arg(long, global = true, help_heading = "Request")]
    pub(crate) print_request: bool,
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Write a robot file with starting values and comments
    ///
    /// Without options: eight wire ropes and a platform of 100 kg. The state of the file is a stable equilibrium, so
    /// that every command runs on it at once. docs/robot-file.md explains every key.
    #[command(after_help = "Examples:\n  funicular new -o robot.toml\n  \
        funicular new --cables 6 --mass-kg 20 --box-m 0.4,0.3,0.2 --diameter-m 0.003\n  \
        funicular new --motion planar-xz --name \"planar test rig\"\n  \
        funicular new --from-csv docs/robot-file.csv --csv-unit mm --mass-kg 60")]
    New(NewArgs),
    /// Write the JSON Schema of the robot file, with which editors complete and check it
    ///
    /// The first line `#:schema ./robot.schema.json` of a robot file names the schema to Even Better TOML in VS Code
    /// and to other editors with Taplo.
    #[command(after_help = "Example:\n  funicular schema -o robot.schema.json")]
    Schema(SchemaArgs),
    /// Read and check a robot file, and describe the robot
    #[command(after_help = "Examples:\n  funicular check robots/yuan2014-4mm.toml\n  \
        funicular check robots/cogiro.toml --set platform.mass_kg=300 --format json")]
    Check(CheckArgs),
    /// List every number of a robot file: path, value, unit, range, meaning
    ///
    /// The paths can be used in `--set` and in `sweep --vary`. One number of a vector is named by its axis or by its
    /// index from 0: `anchor_m.z` is `anchor_m.2`. A number that the file leaves out is listed with its default.
    #[command(after_help = "Examples:\n  funicular parameters robots/yuan2014-4mm.toml\n  \
        funicular parameters robots/cogiro.toml --set cables.1.anchor_m.z=5.5 --format csv\n  \
        funicular parameters robots/cogiro.toml --set loads.force_n.2=-50")]
    Parameters(CheckArgs),
    /// Equilibrium: pose, tensions, sag
    #[command(after_help = "Examples:\n  funicular statics robots/yuan2014-4mm.toml\n  \
        funicular statics robots/yuan2014-4mm.toml --pose 0,0,0.5 --mass-kg 20\n  \
        funicular statics robots/yuan2014-4mm.toml --lengths-m 6.9,6.6,6.8,6.7,6.8,6.6\n  \
        funicular statics robots/cogiro.toml --pose 1,2,1.5 --hold-lengths-of-pose --mass-kg 250\n  \
        funicular statics robots/cogiro.toml --pose 1,2,1.5 --tension-rule middle --max-tension-n 1200\n  \
        funicular statics docs/pulleys/winches.toml --friction-interval\n  \
        funicular statics robots/cogiro.toml -o robot.pdf")]
    Statics(StaticsArgs),
    /// 6×6 stiffness at one frequency, static at 0 Hz
    #[command(after_help = "Examples:\n  funicular stiffness robots/yuan2014-4mm.toml\n  \
        funicular stiffness robots/yuan2014-4mm.toml --at-hz 3.5 --format json")]
    Stiffness(StiffnessArgs),
    /// Every natural frequency below a limit, with a count that proves that none is missing
    #[command(after_help = "Examples:\n  funicular modes robots/yuan2014-4mm.toml --below-hz 20\n  \
        funicular modes robots/yuan2014-4mm.toml --below-hz 5 --input fz --output az\n  \
        funicular modes robots/yuan2014-4mm.toml --below-hz 5 --stations 21 -o modes.json\n  \
        funicular modes robots/yuan2014-4mm.toml --below-hz 5 -o modes.uff\n  \
        funicular modes robots/cogiro.toml --below-hz 10 --cable-model spring -o modes.csv\n  \
        funicular modes robots/cogiro.toml --pose 1,2,1.5 --tension-rule middle --below-hz 8 --platform-share 0.75\n  \
        funicular modes robots/grab-3-cables.toml --static-model ideal --rigid-cables --below-hz 10\n  \
        funicular modes robots/cogiro.toml --below-hz 5 --figure-mode 3 -o shape.pdf")]
    Modes(ModesArgs),
    /// Frequency response of the platform or of points on cables, and its peaks
    #[command(after_help = "Examples:\n  \
        funicular frf robots/yuan2014-4mm.toml --from-hz 0.1 --to-hz 10 --points 2000 \\\n    \
        --input fz --output ay\n  \
        funicular frf robots/yuan2014-4mm.toml --from-hz 0.1 --to-hz 100 --points 5000 --log \\\n    \
        --input f:1,0,1 --output x --output-point-m 0,0,-0.2 -o frf.csv\n  \
        funicular frf robots/yuan2014-4mm.toml --from-hz 0.1 --to-hz 10 --adaptive \\\n    \
        --input fz --output ay\n  \
        funicular frf robots/yuan2014-4mm.toml --from-hz 0.1 --to-hz 10 --adaptive \\\n    \
        --input fx --input fz --output x --output cable:3@0.5:az -o frf.json\n  \
        funicular frf robots/yuan2014-4mm.toml --from-hz 0.1 --to-hz 10 --points 2000 \\\n    \
        --input fz --output az --output-point-m 0.1,0.08,0.02 -o frf.uff\n  \
        funicular frf robots/yuan2014-4mm.toml --from-hz 0.1 --to-hz 10 --adaptive \\\n    \
        --input fz --output az --figure-width-mm ieee-single -o frf.pdf")]
    Frf(FrfArgs),
    /// Comparison of all cable models, and the simplest model that is good enough
    #[command(after_help = "Examples:\n  funicular compare robots/yuan2014-4mm.toml --below-hz 5\n  \
        funicular compare robots/cogiro.toml --below-hz 15 --platform --tolerance 0.05\n  \
        funicular compare robots/yuan2014-4mm.toml --below-hz 5 -o models.svg")]
    Compare(CompareArgs),
    /// Derivatives of results with respect to every number of the robot file
    ///
    /// All derivatives come from the solution itself, without perturbing a number; docs/gradients.md explains the
    /// tables. The text shows the ten largest of each result, JSON and CSV all of them.
    #[command(after_help = "Examples:\n  funicular gradient robots/yuan2014-4mm.toml --below-hz 2\n  \
        funicular gradient robots/cogiro.toml --pose 1,2,1.5 --of tensions,stiffness-min --by cables.*.anchor_m --hold pose\n  \
        funicular gradient robots/yuan2014-4mm.toml --of frequencies,damping --below-hz 1.5 --per percent -o gradients.csv\n  \
        funicular gradient robots/yuan2014-4mm.toml --of response --at-hz 1.1 --input fz --output az \\\n    \
        --by platform,materials --per tolerance --tolerances platform.mass_kg=2%")]
    Gradient(GradientArgs),
    /// Deviations of results from deviations or tolerances of numbers of the robot file
    ///
    /// Results are linear in the deviations where no cable may become slack and no frequencies may cross; elsewhere the
    /// program computes sampled robots, on all cores. Each result has its deviation, the interval that holds 95 % of
    /// all robots, and the shares of the numbers; docs/uncertainty.md explains the tables.
    #[command(
        after_help = "Examples:\n  funicular uncertainty robots/yuan2014-4mm.toml --deviations platform.mass_kg=1%,cables.*.anchor_m=0.002 \\\n    \
        --of pose,tensions,frequencies --below-hz 2\n  \
        funicular uncertainty robots/cogiro.toml --pose 1,2,1.5 --tolerances cables.*.unstrained_length_m=0.0002 -o cogiro.html\n  \
        funicular uncertainty robots/cogiro.toml --poses trajectory.csv --deviations platform.center_of_mass_m=0.005 \\\n    \
        --of stiffness-min --hold pose -o stiffness.csv\n  \
        funicular uncertainty robots/yuan2014-4mm.toml --deviations materials.*.youngs_modulus_pa=5%,platform=1% \\\n    \
        --of frequencies,damping --below-hz 3 --samples 2000 --samples-file robots.parquet"
    )]
    Uncertainty(UncertaintyArgs),
    /// Minimum and maximum payload at a pose, with the cables and ends whose tension limits bind
    ///
    /// The payload is held by any tensions within the limits, not only by those of a tension rule.
    #[command(after_help = "Examples:\n  funicular payload robots/cogiro.toml --pose 1,2,1.5\n  \
        funicular payload robots/cogiro.toml --pose 1,2,1.5 --payload-center-m 0,0,-0.5 --max-tension-n 3000\n  \
        funicular map robots/cogiro.toml --grid x=-6:6:25 --grid y=-4:4:17 --grid z=1.5 --quantity payload-max -o cogiro.parquet")]
    Payload(PayloadArgs),
    /// Distances between the poses of ideal, spring and catenary cables over platform mass
    #[command(after_help = "Examples:\n  funicular pose-error robots/yuan2014-4mm.toml --mass-kg 10.55:86.35:100\n  \
        funicular pose-error robots/yuan2014-8mm.toml --mass-kg 10:90:81 --tolerance-mm 5 --format csv\n  \
        funicular pose-error robots/cogiro.toml --pose 1,2,1.5 --mass-kg 80:400:33")]
    PoseError(PoseErrorArgs),
    /// Dynamic stiffness of one cable over frequency
    #[command(after_help = "Example:\n  \
        funicular cable robots/yuan2014-4mm.toml --name 1 --from-hz 0.1 --to-hz 20 --points 1000")]
    Cable(CableArgs),
    /// State space A, B, C, D for control design, or the second-order model M, C, K
    ///
    /// The state space has the modes that the inputs and outputs see: as few states as the tolerance allows, or the
    /// best ones for a given number of states. docs/control.md explains the error and the use in Python and MATLAB.
    #[command(after_help = "Examples:\n  \
        funicular reduce robots/yuan2014-4mm.toml --below-hz 5 --input fz --output az --matrices model.mat\n  \
        funicular reduce robots/cogiro.toml --below-hz 10 --input fz --output z --order 8 --matrices model.npz\n  \
        funicular reduce robots/cogiro-winches.toml --below-hz 5 --input length:1 --output z --output tension:1\n  \
        funicular reduce robots/cogiro-winches.toml --below-hz 5 --input base-z --output z --output az\n  \
        funicular reduce robots/yuan2014-4mm.toml --below-hz 5 --form second-order --matrices model\n\n\
        In Python: m = numpy.load('model.npz'); m['A'], m['B'], m['C'], m['D']\n\
        In MATLAB: load model.mat; sys = ss(A, B, C, D)")]
    Reduce(ReduceArgs),
    /// Values of the robot file that fit measurements best, with their deviations
    ///
    /// Measurements are frequency responses, natural frequencies with damping ratios, poses, tensions and lengths, in
    /// one or several states. The result says how sure each value is, and which combinations the measurements do not
    /// determine. docs/identification.md explains files, priors and the result.
    #[command(after_help = "Examples:\n  \
        funicular identify docs/quick-start/hall.toml --hold-lengths-of-pose \\\n    \
        --measured docs/identification/hall-modes.csv --fit platform.mass_kg --prior platform.mass_kg=60±10\n  \
        funicular identify robot.toml --measured test.uff --node 2=0.1,0.08,0.02 --node 1=0.03,-0.02,0.05 \\\n    \
        --fit platform.mass_kg --fit platform.center_of_mass_m --prior platform.center_of_mass_m=0±0.03 -o fitted.toml\n  \
        funicular identify robot.toml --experiments poses.json --rigid-cables --fit platform.center_of_mass_m \\\n    \
        --fit platform.inertia_kg_m2 -o result.json --page result.html")]
    Identify(IdentifyArgs),
    /// Values of the robot file with which the robot is stiffest, fastest or lightest at several poses
    ///
    /// The values move within their bounds until the goal at the worst pose, or its weighted mean, improves no further.
    /// The poses are held, and the tensions follow --tension-rule. docs/design.md explains goals, demands and the
    /// result.
    #[command(after_help = "Examples:\n  \
        funicular design robots/cogiro.toml --poses docs/design/cogiro-poses.csv --target-tension-n 350 \\\n    \
        --change 'cables.*.attachment_m=±0.05' -o designed.toml\n  \
        funicular design robots/cogiro.toml --pose 1,2,1.5 --change 'cables.*.anchor_m.z=5:6' --goal stiffness \\\n    \
        --page design.html\n  \
        funicular design robots/cogiro.toml --pose 0,0,1.5 --change 'cables.*.anchor_m=±0.5' --goal rope-mass \\\n    \
        --min-stiffness-n-per-m 20000")]
    Design(DesignArgs),
    /// Tensions, frequencies, stiffness over the workspace, with one row per pose
    #[command(after_help = "Examples:\n  \
        funicular map robots/cogiro.toml --grid x=-6:6:25 --grid y=-4:4:17 --grid z=0.5:3.5:7 \\\n    \
        --quantity tension-max,stiffness-min -o cogiro.parquet\n  \
        funicular map robots/yuan2014-4mm.toml --grid x=-1:1:21 --grid y=-1:1:21 --grid z=0.5 \\\n    \
        --quantity first-frequency,model-error:spring -o first.vti\n  \
        funicular map robots/cogiro.toml --poses trajectory.csv --quantity lengths,tensions --format csv\n\n\
        After an interruption or a power failure the same command with --resume continues and gives the same file.\n\
        In a job array: --part 3/8 -o part-3.parquet, and at the end funicular merge part-*.parquet -o all.parquet")]
    Map(MapArgs),
    /// Tensions, frequencies, stiffness over values of the robot file, with one row per combination
    #[command(after_help = "Examples:\n  \
        funicular sweep robots/yuan2014-4mm.toml --vary platform.mass_kg=10.55:86.35:50 \\\n    \
        --quantity pose,first-frequency,pose-error -o mass.parquet\n  \
        funicular sweep robots/yuan2014-4mm.toml --pose 0,0,0.5 --vary materials.rope-4mm.diameter_m=0.002:0.008:25 \\\n    \
        --vary platform.mass_kg=10,20,40 --quantity tension-max,sag-max --format csv")]
    Sweep(SweepArgs),
    /// Combine the parts of a map or sweep in one file
    #[command(after_help = "Example:\n  funicular merge part-*.parquet -o all.parquet")]
    Merge(MergeArgs),
    /// HTML page with figures of a map or sweep, which opens offline
    ///
    /// Grids are shown as slices with contours, the feasible set, histograms and points in space. Trajectories and
    /// sweeps of one value are shown as curves; the curves of natural frequencies follow their modes through crossings
    /// and veering. docs/sweeps.md explains the figures. With a FILE.svg or FILE.pdf the command writes one figure for
    /// a paper instead of the page.
    #[command(
        after_help = "Examples:\n  funicular map robots/cogiro.toml --grid x=-6:6:25 --grid y=-4:4:17 --grid z=0.5:3.5:7 \\\n    \
        --quantity tension-max,stiffness-min -o cogiro.parquet\n  funicular plot cogiro.parquet\n  \
        funicular plot mass.parquet -o mass.html\n  \
        funicular plot cogiro.parquet --quantity tension-max --at z=1.5 -o tension.pdf"
    )]
    Plot(PlotArgs),
    /// HTML page with all analyses of a robot and their figures
    #[command(after_help = "Examples:\n  funicular report\n  \
        funicular report robots/cogiro.toml -o cogiro.html\n  \
        funicular report robots/yuan2014-4mm.toml --pose 0,0,0.5 --below-hz 10 --input f:1,0,1 --output x")]
    Report(ReportArgs),
    /// HTML page on which the platform can be dragged, and everything is computed anew
    ///
    /// The page contains the program itself, as WebAssembly, and opens in a browser without network. docs/web.md
    /// describes it.
    #[command(after_help = "Examples:\n  funicular live robots/cogiro.toml -o cogiro.html\n  \
        funicular live robots/cogiro.toml --pose 1,2,1.5 --tension-rule middle --set platform.mass_kg=150")]
    Live(LiveArgs),
    /// HTML page with every figure and table of Yuan et al. 2014 beside the results of this program
    #[command(after_help = "Example:\n  funicular paper -o paper.html")]
    Paper(PaperArgs),
    /// Convert files of CASPR, WireX or MoorDyn to a robot file
    ///
    /// CASPR: the bodies file and the cables file, in any order. WireX: a .wcrfx file. MoorDyn: an input file of
    /// version 2 with one body, or one free point, on lines. No value is invented: if a file lacks one, a message names
    /// the option that gives it. Data that a robot file cannot hold is listed, also at the head of the file.
    /// docs/import.md explains how each number is read.
    #[command(
        after_help = "Examples:\n  funicular import docs/import/tripod_bodies.xml docs/import/tripod_cables.xml \\\n    \
        --mass-kg-per-m 0.05 --axial-stiffness-n 1e6 -o tripod.toml\n  \
        funicular import robot.wcrfx --pose 0,0,1 -o robot.toml\n  \
        funicular import mooring.txt -o robot.toml"
    )]
    Import(ImportArgs),
    /// Export the robot at its equilibrium for OpenSees, MoorDyn or ParaView
    ///
    /// opensees: a Python script for OpenSeesPy that prints its statics and modes beside those of funicular. moordyn:
    /// an input file of version 2. vtk: a .vtp file of cables and platform, with modes on request. docs/export.md
    /// describes the files and the differences between the programs.
    #[command(after_help = "Examples:\n  \
        funicular export robots/yuan2014-4mm.toml --to opensees -o yuan.py && python3 yuan.py\n  \
        funicular export robots/cogiro.toml --to moordyn --segments 20 -o cogiro.txt\n  \
        funicular export robots/cogiro.toml --to vtk --pose 1,2,1.5 --modes-below-hz 10 -o cogiro.vtp")]
    Export(ExportArgs),
    /// Compare the program with numbers that others published or computed; exit code 1 if a difference is out of
    /// tolerance
    #[command(after_help = "Examples:\n  funicular validate\n  funicular validate -o docs/validation.md\n  \
        funicular validate --format json")]
    Validate(ValidateArgs),
    /// Run a request in JSON: the options of any command and the text of the robot file in one object
    ///
    /// Every command prints its request with --print-request. The keys are the names of the options, with _ instead of
    /// -.
    #[command(
        after_help = "Example:\n  funicular statics robots/cogiro.toml --pose 1,2,1.5 --print-request > request.json\n  \
        funicular request request.json --format json"
    )]
    Request(RequestArgs),
}

#[derive(Debug, Args)]
pub(crate) struct RequestArgs {
    /// Request (JSON), or - for standard input
    #[arg(value_name = "FILE.json")]
    pub(crate) file: PathBuf,
    #[command(flatten)]
    pub(crate) run: RunArgs,
    #[command(flatten)]
    pub(crate) figure: FigureArgs,

    /// Draw the shape of mode N of `modes` in the figure [default: the spectrum]
    #[arg(long, value_name = "N", allow_hyphen_values = true, help_heading = "Figure")]
    pub(crate) figure_mode: Option<usize>,

    /// Write the matrices of `reduce` to an .npz or .mat file, or as CSV files to a new folder
    #[arg(long, value_name = "FILE|FOLDER", help_heading = "Output")]
    pub(crate) matrices: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct ValidateArgs {
    #[command(flatten)]
    pub(crate) output: OutputArgs,
}

/// Format of a result.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Format {
    /// Rounded tables for reading
    Text,
    /// One object with every digit
    Json,
    /// One table with a header and every digit
    Csv,
}

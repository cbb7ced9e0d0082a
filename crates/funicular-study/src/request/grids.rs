//! Requests over many poses or values of the robot file, and about their files.

use super::key::declared;
use super::loads::Requirements;
use super::parts::{Axis, MAX_HZ, Model, Places, RobotText, State, Tensions};
use super::speeds::RequiredVelocities;
use funicular::modes::PLATFORM_SHARE;

declared! {
    /// Quantities and options of every point of a map or sweep.
    pub struct EachPoint {
        /// Quantities to compute at every point, described in docs/sweeps.md
        quantities: Vec<String> = vec!["tension-min".to_owned(), "tension-max".to_owned()] =>
            (Commas(ProgramForm::Quantity)).form("Q,Q,…").option("quantity");
        /// Options of every point.
        #[serde(flatten)]
        options: PointOptions = PointOptions::default() => group;
    }
}

declared! {
    /// State, loads and models at every point, whichever quantities are computed there.
    pub struct PointOptions {
        /// Upper limit of the search for natural frequencies [Hz].
        up_to_hz: f64 = MAX_HZ => (Number(Positive));
        /// Minimum fraction of the kinetic energy in the platform for a mode that counts as a mode of the platform.
        platform_share: f64 = PLATFORM_SHARE => (Number(Fraction));
        /// Centre of mass of the payload, platform frame [m].
        payload_center_m: Option<[f64; 3]> = None => (Vector).otherwise("that of the platform");
        /// Required loads, for quantities that compare with them.
        #[serde(flatten)]
        required: Requirements = Requirements::default() => group;
        /// Required velocities, for quantities that compare with them.
        #[serde(flatten)]
        velocities: RequiredVelocities = RequiredVelocities::default() => group;
        /// State and loads.
        #[serde(flatten)]
        state: State = State::default() => group;
        /// Rule and limits of tensions.
        #[serde(flatten)]
        tensions: Tensions = Tensions::default() => group;
        /// Linearisation.
        #[serde(flatten)]
        model: Model = Model::default() => group;
    }
}

declared! {
    /// Tensions, frequencies, stiffness over the workspace, with one row per pose.
    pub struct MapRequest {
        /// Robot file.
        robot: RobotText = RobotText::default() => (Data(shape::robot)).required();
        /// Poses.
        #[serde(flatten)]
        places: Places = Places::default() => group;
        /// Quantities and options of every point.
        #[serde(flatten)]
        point: EachPoint = EachPoint::default() => group;
    }
    examples {
        "funicular map robots/cogiro.toml --grid x=-6:6:25 --grid y=-4:4:17 --grid z=0.5:3.5:7 \\\n    --quantity \
         tension-max,stiffness-min -o cogiro.parquet",
        "funicular map robots/yuan2014-4mm.toml --grid x=-1:1:21 --grid y=-1:1:21 --grid z=0.5 \\\n    --quantity \
         first-frequency,model-error:spring -o first.vti",
        "funicular map robots/cogiro.toml --poses trajectory.csv --quantity lengths,tensions --format csv\n\nAfter an \
         interruption or a power failure the same command with --resume continues and gives the same file.\nIn a job \
         array: --part 3/8 -o part-3.parquet, and at the end funicular merge part-*.parquet -o all.parquet",
    }
}

declared! {
    /// Tensions, frequencies, stiffness over values of the robot file, with one row per combination.
    pub struct SweepRequest {
        /// Robot file.
        robot: RobotText = RobotText::default() => (Data(shape::robot)).required();
        /// Number of the robot file that varies, with N values from A to B, or with listed values (repeatable: all
        /// combinations, the first fastest); `*` for any key moves all numbers that match together, as in
        /// cables.*.anchor_m.z.
        vary: Vec<Axis> = Vec::new() => (List(ProgramForm::Variation)).form("PATH=A:B:N|V,V,…").required();
        /// Quantities and options of every point.
        #[serde(flatten)]
        point: EachPoint = EachPoint::default() => group;
    }
    examples {
        "funicular sweep robots/yuan2014-4mm.toml --vary platform.mass_kg=10.55:86.35:50 \\\n    --quantity \
         pose,first-frequency,pose-error -o mass.parquet",
        "funicular sweep robots/yuan2014-4mm.toml --pose 0,0,0.5 --vary materials.rope-4mm.diameter_m=0.002:0.008:25 \
         \\\n    --vary platform.mass_kg=10,20,40 --quantity tension-max,sag-max --format csv",
    }
}

declared! {
    /// Combine the parts of a map or sweep in one file.
    pub struct MergeRequest {
        /// Parts, in any order.
        parts: Vec<String> = Vec::new() => (Data(shape::texts)).required().form("PART.parquet")
            .read_by(Reader::Paths, "the rows in");
    }
    examples {
        "funicular merge part-*.parquet -o all.parquet",
    }
}

declared! {
    /// HTML page with figures of a map or sweep, which opens offline.
    ///
    /// Grids are shown as slices with contours, the feasible set, histograms and points in space. Trajectories and
    /// sweeps of one value are shown as curves; the curves of natural frequencies follow their modes through crossings
    /// and veering. docs/sweeps.md explains the figures. With a FILE.svg or FILE.pdf the command writes one figure for
    /// a paper instead of the page.
    pub struct PlotRequest {
        /// File that `map` or `sweep` has written.
        file: String = String::new() => (Data(shape::text)).required().form("FILE.parquet")
            .read_by(Reader::Path, "the rows in");
    }
    examples {
        "funicular map robots/cogiro.toml --grid x=-6:6:25 --grid y=-4:4:17 --grid z=0.5:3.5:7 \\\n    --quantity \
         tension-max,stiffness-min -o cogiro.parquet",
        "funicular plot cogiro.parquet",
        "funicular plot mass.parquet -o mass.html",
        "funicular plot cogiro.parquet --quantity tension-max --at z=1.5 -o tension.pdf",
    }
}

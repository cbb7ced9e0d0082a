//! Requests that make a robot file, or write the robot for another program.

use super::key::declared;
use super::parts::{Axis, ImportPlatform, ImportRopes, Pose, RobotText, State, Tensions};
use super::simulate::Scenario;
use super::source_file::SourceFile;
use crate::names::{ExportFormat, LengthUnit, NewMotion, RopeType, SchemaSubject, optional};

/// Largest error of a length in a table of lengths if none is requested [m].
pub const TABLE_TOLERANCE_M: f64 = 1e-4;

declared! {
    /// Write a robot file with starting values and comments.
    ///
    /// Without options: eight wire ropes and a platform of 100 kg. The state of the file is a stable equilibrium, so
    /// that every command runs on it at once. docs/robot-file.md explains every key.
    pub struct NewRequest {
        /// Name of the robot.
        name: Option<String> = None => (Text).form("NAME");
        /// Number of cables, up to 64, in a symmetric layout.
        cables: Option<usize> = None => (Count(0..=u64::MAX)).otherwise("8; 4 for planar-xz and point-mass");
        /// Motion of the platform.
        #[serde(with = "crate::names")]
        motion: NewMotion = NewMotion::default() => (name::<NewMotion>()).form("MOTION");
        /// Table of the cables in place of their number: name (may be left out), anchor x, y, z in the world frame,
        /// attachment x, y, z in the platform frame; a first line may name the columns: name, anchor_x, …,
        /// attachment_z.
        from_csv: Option<SourceFile> = None => (Data(shape::file))
            .read_by(Reader::Source, "the table of points");
        /// Unit of the points in the table.
        #[serde(with = "optional")]
        csv_unit: Option<LengthUnit> = None => (name::<LengthUnit>()).form("UNIT")
            .otherwise("m, or the ending of the names of the columns, as in anchor_x_mm");
        /// Pose of the state x,y,z[,roll,pitch,yaw] [m, degrees], R = Rz(yaw) Ry(pitch) Rx(roll).
        pose: Option<Pose> = None => (Pose).otherwise("a stable pose that the program finds, above the floor of the \
            anchors");
        /// Mass of the platform [kg].
        mass_kg: Option<f64> = None => (Number(Positive)).under("Platform").otherwise("100");
        /// Sides of the homogeneous box that gives the inertia [m].
        box_m: Option<[f64; 3]> = None => (Vector).form("A,B,C").under("Platform")
            .otherwise("1,1,0.5, or the box around the attachments of the table");
        /// Type of the rope: a wire rope, or a rope of HMPE fibre.
        #[serde(with = "crate::names")]
        rope: RopeType = RopeType::default() => (name::<RopeType>()).form("ROPE").under("Ropes");
        /// Diameter of the rope [m].
        diameter_m: Option<f64> = None => (Number(Positive)).under("Ropes")
            .otherwise("by the mass of the platform, 0.006 for 100 kg on wire ropes");
        /// Axial stiffness EA of another rope [N]; needs ⟪mass_kg_per_m⟫.
        axial_stiffness_n: Option<f64> = None => (Number(Positive)).under("Ropes");
        /// Mass of this rope per unstrained length [kg/m].
        mass_kg_per_m: Option<f64> = None => (Number(NotNegative)).under("Ropes");
    }
    examples {
        "funicular new -o robot.toml",
        "funicular new --cables 6 --mass-kg 20 --box-m 0.4,0.3,0.2 --diameter-m 0.003",
        "funicular new --motion planar-xz --name \"planar test rig\"",
        "funicular new --from-csv docs/robot-file.csv --csv-unit mm --mass-kg 60",
    }
}

declared! {
    /// Write the JSON Schema of the robot file, with which editors complete and check it, that of requests or of
    /// results, or the columns of results.
    ///
    /// The first line `#:schema ./robot.schema.json` of a robot file names the schema to Even Better TOML in VS Code
    /// and to other editors with Taplo.
    pub struct SchemaRequest {
        /// Subject of the schema.
        #[serde(with = "crate::names")]
        of: SchemaSubject = SchemaSubject::default() => (name::<SchemaSubject>()).form("SUBJECT");
    }
    examples {
        "funicular schema -o robot.schema.json",
        "funicular schema --of request -o request.schema.json",
        "funicular schema --of columns",
        "funicular schema --of results -o results.schema.json",
    }
}

declared! {
    /// Convert files of other programs to a robot file: CASPR, WireX, MoorDyn, MuJoCo, SDF, URDF, cdpr, GRAB.
    ///
    /// CASPR: the bodies file and the cables file, in any order. WireX: a .wcrfx file. MoorDyn: an input file of
    /// version 2 with one body, or one free point, on lines. MuJoCo: a model with spatial tendons. SDF: a model with
    /// springs of Drake, chains of joints or named frames. URDF: links in pairs. JSON of GRAB, YAML of cdpr. No value
    /// is invented: if a file lacks one, a message names the option that gives it. Data that a robot file cannot hold
    /// is listed, also at the head of the file. docs/import.md explains how each number is read.
    pub struct ImportRequest {
        /// Files of one robot; their format is recognised from their content.
        files: Vec<SourceFile> = Vec::new() => (Data(shape::files)).required()
            .read_by(Reader::Sources, "the source file");
        /// Name of the cable set if a CASPR file has several.
        cable_set: Option<String> = None => (Text).form("NAME").otherwise("from the file");
        /// Name of a trajectory of a CASPR file; it is written instead of the robot, as a table that `trajectory` and
        /// `settle` read.
        trajectory: Option<String> = None => (Text).form("NAME");
        /// Rope values that the files do not give.
        #[serde(flatten)]
        ropes: ImportRopes = ImportRopes::default() => group;
        /// Platform values that the files do not give.
        #[serde(flatten)]
        platform: ImportPlatform = ImportPlatform::default() => group;
    }
    examples {
        "funicular import docs/import/tripod_bodies.xml docs/import/tripod_cables.xml \\\n    --mass-kg-per-m 0.05 \
         --axial-stiffness-n 1e6 -o tripod.toml",
        "funicular import docs/import/tripod_bodies.xml docs/import/tripod_trajectories.xml --trajectory lift -o \
         lift.csv",
        "funicular import robot.wcrfx --pose 0,0,1 -o robot.toml",
        "funicular import mooring.txt -o robot.toml",
        "funicular import model.xml --mass-kg-per-m 0.05 -o robot.toml",
    }
}

declared! {
    /// Export the robot at its equilibrium for OpenSees, MoorDyn, MuJoCo, Gazebo or ParaView, or its lengths for
    /// firmware.
    ///
    /// opensees: a Python script for OpenSeesPy that prints its statics and modes beside those of funicular. moordyn:
    /// an input file of version 2, with a scenario a Python script that runs it. mujoco: a model with straight cables
    /// whose lengths and tensions are commanded. sdf: a world of Gazebo. urdf: frame and platform for viewers. vtk: a
    /// .vtp file of cables and platform, with modes on request. c, json: polynomials that correct the lengths of
    /// straight cables over a box of poses, for firmware. docs/export.md describes the files and the differences
    /// between the programs.
    pub struct ExportRequest {
        /// Robot file.
        robot: RobotText = RobotText::default() => (Data(shape::robot)).required();
        /// Program that the file is for.
        #[serde(with = "crate::names")]
        to: ExportFormat = ExportFormat::Opensees => (name::<ExportFormat>()).form("PROGRAM").required();
        /// Elements per cable, 1 to 1000: bars in OpenSees, segments in MoorDyn, pieces of a curve in VTK.
        segments: usize = 20 => (Count(1..=1000));
        /// Pieces of each cable in MuJoCo, 2 to 100: a chain of bars that has the mass, the sag and the vibration of
        /// the cable. Without it cables are straight and have no mass.
        cable_pieces: Option<usize> = None => (Count(2..=100)).otherwise("straight cables without mass");
        /// Upper limit of the frequencies of modes in the file [Hz]: in VTK one field per mode, in OpenSees the modes
        /// to compare with.
        modes_below_hz: Option<f64> = None =>
            (Number(Positive)).otherwise("no modes in VTK, the first ten in OpenSees");
        /// Events that MoorDyn runs from the equilibrium on, as in `simulate`: lists `release`, `lengths`, `stop` and
        /// `cut`. The file is then a Python script with the input file in it.
        scenario: Option<Scenario> = None => (Data(shape::scenario))
            .read_by(Reader::Scenario, "the scenario");
        /// Time that MoorDyn simulates with ⟪scenario⟫ [s].
        duration_s: Option<f64> = None => (Number(Positive)).otherwise("10 with a scenario");
        /// Side of the box of poses for C and JSON: x, y, z [m], roll, pitch, yaw [degrees] from A to B, or at one
        /// value (repeatable); an axis that is not given keeps the value of ⟪pose⟫ or of the pose of the robot's state.
        within: Vec<Axis> = Vec::new() => (List(ProgramForm::Side)).form("AXIS=A:B").under("Table of lengths");
        /// Largest error of a length in the box [m]; in a unit, the error of a position that one step may have.
        tolerance_m: Option<f64> = None =>
            (Number(Positive)).under("Table of lengths").otherwise("1e-4, 1e-7 in a unit");
        /// Beginning of all names in the C file.
        prefix: Option<String> = None => (Text).form("NAME").under("Table of lengths")
            .otherwise("from the name of the robot file");
        /// State and loads.
        #[serde(flatten)]
        state: State = State::default() => group;
        /// Rule and limits of tensions.
        #[serde(flatten)]
        tensions: Tensions = Tensions::default() => group;
    }
    examples {
        "funicular export robots/yuan2014-4mm.toml --to opensees -o yuan.py && python3 yuan.py",
        "funicular export robots/cogiro.toml --to moordyn --segments 20 -o cogiro.txt",
        "funicular export robots/yuan2014-4mm.toml --to moordyn --mass-kg 12.5 \\\n    --scenario \
         docs/simulation/release.toml --for 2 -o drop.py && python3 drop.py",
        "funicular export robots/cogiro.toml --to mujoco -o cogiro.xml",
        "funicular export robots/cogiro.toml --to mujoco --cable-pieces 10 -o cogiro.xml",
        "funicular export robots/cogiro.toml --to vtk --pose 1,2,1.5 --modes-below-hz 10 -o cogiro.vtp",
        "funicular export robots/cogiro.toml --to fmu -o cogiro.fmu",
        "funicular export robots/cogiro.toml --to c --within x=-3:3 --within y=-2:2 --within z=0.5:2.5 -o cogiro.c",
    }
}

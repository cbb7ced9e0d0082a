//! Request of `calibrate`: readings of lengths at unknown poses, and the numbers that they shall give.

use super::key::declared;
use super::parts::{Axis, GappedColumns, RobotText, Tensions};
use funicular::math::chosen_rows::RowCriterion;
use funicular::statics::StaticModel;
use serde::{Deserialize, Serialize};

declared! {
    /// Anchors, attachments, offsets and scale from readings of cable lengths at poses that are not known.
    ///
    /// Every row of ⟪readings⟫ belongs to one pose, which is found with the robot's numbers. Cables are straight and
    /// rigid unless ⟪static_model⟫ says otherwise; elastic ones need measured tensions or coordinates. The result says
    /// how well the readings fit and, apart from that, what they determine. docs/calibration.md explains tables, frames
    /// and the result.
    pub struct CalibrateRequest {
        /// Robot file, whose values are the start.
        robot: RobotText = RobotText::default() => (Data(shape::robot)).required();
        /// Readings, one row per pose: columns length_NAME_m [m] (or _mm, _in) of every cable, empty where a
        /// cable was slack or not read; x_m, y_m, z_m and, where the platform turns, roll_deg, pitch_deg, yaw_deg are
        /// poses at which the search begins; tension_NAME_n are tensions at the anchors [N], which elastic cables need.
        readings: GappedColumns = GappedColumns::new() => (GappedColumns).required()
            .read_by(Reader::GappedColumns, "the readings");
        /// Rows of the readings that are left out, by their numbers from 1, separated by commas.
        leave_out: Vec<f64> = Vec::new() => (Commas(ProgramForm::Positive)).form("ROWS");
        /// Numbers to find, separated by commas: anchors, attachments, offsets (length of each cable at the reading
        /// zero), scale (metres of length per metre of all readings), pulley-radii; of elastic cables also
        /// axial-stiffness, mass and support-stiffness, as factors of those of the file.
        unknowns: Vec<String> = vec!["anchors".to_owned()] => (Texts).form("NAMES");
        /// Cables whose anchors are known, by their names, separated by commas.
        hold_anchors: Vec<String> = Vec::new() => (Texts).form("CABLES");
        /// Frame of the result: cables separated by commas, of which the first keeps its anchor, the second the
        /// direction from the first, and the third the plane of the three; or inner, in which all anchors together move
        /// least.
        frame: Vec<String> = Vec::new() => (Texts).form("CABLES|inner");
        /// Standard deviation of a reading [m].
        length_std_m: Option<f64> = None => (Number(Positive)).otherwise("that of the residuals");
        /// Standard deviation of the coordinates x_m, y_m, z_m [m]; with it they are measurements.
        position_std_m: Option<f64> = None => (Number(Positive)).otherwise("they only start the search");
        /// Standard deviation of the angles roll_deg, pitch_deg, yaw_deg [degrees]; with it they are measurements.
        rotation_std_deg: Option<f64> = None => (Number(Positive)).otherwise("they only start the search");
        /// Standard deviation of the measured tensions [N].
        tension_std_n: f64 = 1.0 => (Number(Positive));
        /// Values known beforehand with their standard deviations: kinds as in ⟪unknowns⟫, or paths of values; without
        /// a value that of the file, as in offsets=0±0.02 or cables.*.anchor_m=±0.05 (repeatable). Anchors with a prior
        /// have a place in the world, which holds the frame.
        prior: Vec<PriorValue> = Vec::new() => (List(ProgramForm::Prior)).form("NAME=[VALUE]±DEVIATION")
            .under("Prior knowledge");
        /// Range within which the tensions at the anchors lie that were not measured [N]: a prior of its middle, with
        /// the deviation of equal chances, for elastic cables.
        tension_range_n: Option<[f64; 2]> = None => (Written(ProgramForm::Band)).form("FROM:TO")
            .under("Prior knowledge");
        /// Static model of the cables: ideal ones are straight and rigid.
        #[serde(with = "crate::names")]
        static_model: StaticModel = StaticModel::Ideal => (name::<StaticModel>()).form("MODEL");
        /// Maximum number of starts of the search.
        starts: usize = 10 => (Count(1..=1000));
        /// Values with a profile, separated by commas: kinds as in ⟪unknowns⟫, or paths of values. Each is held at
        /// steps and everything else is fitted again, until χ² has risen to the limit of 95 %.
        profile: Vec<String> = Vec::new() => (Texts).form("NAMES");
        /// Number of poses to propose that reduce the deviations most, one after the other.
        propose: usize = 0 => (Count(0..=100)).under("Proposal");
        /// Axis of the candidates of a proposal: x, y, z [m], roll, pitch, yaw [degrees], with N values from A to B, or
        /// with listed values (repeatable); an axis that is not given stays at the middle pose of the rows.
        grid: Vec<Axis> = Vec::new() => (List(ProgramForm::GridAxis)).form("AXIS=A:B:N|V,V,…").under("Proposal");
        /// Candidates of a proposal instead of a grid: position [m] and roll, pitch, yaw [degrees].
        poses: Option<Vec<[f64; 6]>> = None => (Poses).under("Proposal").excludes(&["grid"])
            .read_by(Reader::Poses, "the poses");
        /// Numbers whose deviations the proposal reduces: kinds as in ⟪unknowns⟫, or paths of values, or tool for the
        /// position of the platform at the poses of ⟪accuracy_grid⟫.
        propose_for: Vec<String> = Vec::new() => (Texts).form("NAMES").under("Proposal").otherwise("all unknowns");
        /// Criterion of the proposal.
        #[serde(with = "crate::names")]
        propose_by: RowCriterion = RowCriterion::default() => (name::<RowCriterion>()).form("CRITERION")
            .under("Proposal");
        /// Axis of the poses at which the deviation of the platform is told, as in ⟪grid⟫ (repeatable): a controller
        /// commands the readings of the calibrated values there.
        accuracy_grid: Vec<Axis> = Vec::new() => (List(ProgramForm::GridAxis)).form("AXIS=A:B:N|V,V,…")
            .under("Accuracy of the tool");
        /// Poses at which the deviation of the platform is told, instead of a grid: position [m] and roll, pitch, yaw
        /// [degrees].
        accuracy_poses: Option<Vec<[f64; 6]>> = None => (Poses).under("Accuracy of the tool")
            .excludes(&["accuracy_grid"]).read_by(Reader::Poses, "the poses of the accuracy");
        /// Largest deviation that is wanted [m]: the least number of proposed poses that reaches it.
        wanted_std_m: Option<f64> = None => (Number(Positive)).under("Proposal");
        /// Tensions at the candidates of a proposal. Candidates without tensions within the limits are left out;
        /// elastic cables without a rule try the lowest and the middle tensions.
        #[serde(flatten)]
        tensions: Tensions = Tensions::default() => group;
    }
    examples {
        "funicular calibrate docs/calibration/machine.toml --readings docs/calibration/belts.csv",
        "funicular calibrate docs/calibration/machine.toml --readings docs/calibration/belts.csv --frame inner \\\n    \
         --propose 3 --grid x=0.4:4.2:9 --grid y=0.4:3.5:8",
        "funicular calibrate docs/calibration/machine.toml --readings docs/calibration/belts.csv \\\n    \
         --accuracy-grid x=0.4:4.2:9 --accuracy-grid y=0.4:3.5:8",
        "funicular calibrate robot.toml --readings lengths.csv --unknowns anchors,offsets --length-std-m 0.0005 \
         \\\n    --calibrated calibrated.toml",
        "funicular calibrate robot.toml --readings lengths.csv --static-model catenary --tension-range-n 20:120 \
         \\\n    --unknowns anchors,offsets --prior offsets=0±0.02",
    }
}

/// Value known beforehand.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PriorValue {
    /// Kind of unknowns, or path of a value.
    pub path: String,
    /// Value; default that of the robot file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub prior: Option<f64>,
    /// Standard deviation of this value.
    pub prior_std: f64,
}

//! Calibration from lengths whose poses are unknown: anchors, attachments, offsets and scale of the readings, and what
//! else lies between them, found together with the pose of every row.
//!
//! The equations (96a) to (96n) are in section 18d of docs/theory.md. Straight rigid cables: a row of readings has more
//! cables than its pose has degrees of freedom; what is left of it after its pose is eliminated, its net rows, says
//! something about the robot. Elastic cables have a true length each in every row, so that tensions or coordinates have
//! to be measured as well.

mod curvature;
mod elastic;
mod elimination;
mod exchange;
mod fit;
mod frame;
mod from_nothing;
mod mirror;
mod natural;
mod precision;
mod priors;
mod proposal;
mod row;
mod search;
mod spread;
mod tool;
mod unknowns;
mod weak;
mod wrong_rows;

pub use curvature::WeakWalk;
pub use exchange::{CableExchange, cable_exchange, encoder_of_other_sign};
pub use fit::CalibrationFit;
pub use frame::{CalibrationFrame, FrameChoice};
pub use from_nothing::anchors_from_lengths;
pub use mirror::{OtherMinimum, TellingRow};
pub use precision::{AnchorDistance, CalibrationPrecision, LeftOutRow};
pub use proposal::{CandidatePose, ProposalAim, ProposedPose, proposals};
pub use row::{MeasuredRow, ReadingDeviations};
pub use search::{CalibrationSearch, search};
pub use tool::{ToolDeviation, ToolRows};
pub use unknowns::{CalibratedRobot, CalibrationUnknown};
pub use weak::{CombinationPart, WeakCombination};
pub use wrong_rows::{WrongRow, wrong_rows};

use crate::math::{DMat, Vec3};
use crate::platform::Coordinates;
use crate::robot::{PlatformMotion, Pose, Robot};
use crate::statics::StaticModel;
use thiserror::Error;

/// Calibration: a robot with starting values, its unknowns, and the measured rows.
#[derive(Debug, Clone)]
pub struct Calibration {
    /// Robot with the starting values.
    pub robot: Robot,
    /// Unknown numbers of the robot and its readings, in the order of all results.
    pub unknowns: Vec<CalibrationUnknown>,
    /// Measured rows, one per pose.
    pub rows: Vec<MeasuredRow>,
    /// Standard deviations of the data.
    pub deviations: ReadingDeviations,
    /// Model of the cables: ideal ones are straight and rigid.
    pub model: StaticModel,
    /// Length that makes the scale of the readings a length [m].
    scale_length: f64,
    /// Unknowns that are known beforehand.
    priors: Vec<priors::Prior>,
    /// True if the readings see no rotation: all cables end in one point of the platform.
    is_point: bool,
}

/// Reason why rows of readings cannot calibrate a robot.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum CalibrationError {
    /// Fewer readings than unknowns.
    #[error(
        "{data} data cannot give {unknowns} unknowns of the robot and {poses} of the poses: measure {} with all cables",
        at_least(*needed)
    )]
    TooFewRows {
        /// Number of readings and other data.
        data: usize,
        /// Number of unknowns of the robot without those of the frame.
        unknowns: usize,
        /// Number of unknown coordinates of all poses.
        poses: usize,
        /// Least number of rows with all cables by counting; `None` if no number suffices.
        needed: Option<usize>,
    },
    /// A cable that no row reads.
    #[error("no row has a reading of cable {cable}: add one, or leave its values out of the unknowns")]
    UnreadCable {
        /// Index of the cable.
        cable: usize,
    },
    /// Elastic cables without tensions or coordinates.
    #[error(
        "cables that stretch or sag have a true length each in every row, so that lengths alone say nothing about the \
         robot: measure tensions too (one per row helps, all are best), or coordinates of the platform, or give a \
         range that the tensions keep to, or take straight rigid cables where stretch and sag are below the \
         deviation of the readings"
    )]
    ElasticLengthsAlone,
    /// Rows whose poses their readings do not fix.
    #[error(
        "the data of row {row} do not fix its pose ({data} data, {coordinates} coordinates): give readings of more \
         cables or coordinates of the platform, or leave the row out"
    )]
    OpenPose {
        /// Number of the row, from 1.
        row: usize,
        /// Number of its data.
        data: usize,
        /// Number of its coordinates.
        coordinates: usize,
    },
    /// The size of the robot is free.
    #[error(
        "readings of an unknown scale say nothing about the size of the robot: hold the scale, hold two anchors whose \
         distance is known, or measure coordinates of the platform"
    )]
    FreeSize,
    /// Unknowns that the platform does not have.
    #[error("{0}")]
    NoSuchUnknown(&'static str),
    /// The search has found no minimum.
    #[error(
        "no start of the search arrived at a minimum ({starts} starts): give anchors that are nearer, or poses of the \
         rows"
    )]
    NoMinimum {
        /// Number of starts.
        starts: usize,
    },
}

fn at_least(needed: Option<usize>) -> String {
    needed.map_or_else(
        || "coordinates of the platform too, because no number of rows suffices".to_owned(),
        |rows| format!("at least {rows} rows"),
    )
}

impl Calibration {
    /// Calibration of a robot from rows of readings, one reading or none per cable, in metres.
    ///
    /// # Errors
    /// [`CalibrationError`]: unknowns that the platform does not have, a cable without readings, or a row that does not
    /// fix its pose.
    pub fn new(
        robot: Robot,
        unknowns: Vec<CalibrationUnknown>,
        rows: Vec<MeasuredRow>,
        deviations: ReadingDeviations,
        model: StaticModel,
    ) -> Result<Self, CalibrationError> {
        let readings: Vec<f64> = rows.iter().flat_map(|row| row.readings.iter().flatten().copied()).collect();
        let mean = readings.iter().map(|reading| reading.abs()).sum::<f64>() / readings.len().max(1) as f64;
        let attachments = unknowns.iter().any(|of| matches!(of, CalibrationUnknown::Attachment { .. }));
        let first = robot.cables.first().map_or(Vec3::zeros(), |cable| cable.attachment_p);
        let coincide = robot.cables.iter().all(|cable| (cable.attachment_p - first).norm() <= SAME_POINT * mean);
        let is_point = robot.platform.motion == PlatformMotion::PointMass || (coincide && !attachments);
        let made = Self {
            robot,
            unknowns,
            rows,
            deviations,
            model,
            scale_length: if mean > 0.0 { mean } else { 1.0 },
            priors: Vec::new(),
            is_point,
        };
        made.check()?;
        Ok(made)
    }

    fn check(&self) -> Result<(), CalibrationError> {
        if self.robot.platform.motion == PlatformMotion::PointMass
            && self.unknowns.iter().any(|of| matches!(of, CalibrationUnknown::Attachment { .. }))
        {
            let text = "a point mass has no attachments: leave them out of the unknowns";
            return Err(CalibrationError::NoSuchUnknown(text));
        }
        if self.unknowns.contains(&CalibrationUnknown::SupportStiffness) && !self.robot.has_supports() {
            let text =
                "no anchor of the robot file is on a flexible support: leave their stiffness out of the unknowns";
            return Err(CalibrationError::NoSuchUnknown(text));
        }
        let of_statics = |of: &CalibrationUnknown| of.factor().is_some();
        if !self.is_elastic() && self.unknowns.iter().any(of_statics) {
            let text = "straight rigid cables have neither stiffness nor tensions: choose an elastic static model with \
                        measured tensions, or leave axial stiffness, mass and supports out of the unknowns";
            return Err(CalibrationError::NoSuchUnknown(text));
        }
        let lengths = |row: &MeasuredRow| row.readings.iter().flatten().count();
        if self.is_elastic() && self.rows.iter().all(|row| self.data_count(row) == lengths(row)) {
            return Err(CalibrationError::ElasticLengthsAlone);
        }
        for cable in 0..self.robot.cables.len() {
            let is_read = self.rows.iter().any(|row| row.readings.get(cable).copied().flatten().is_some());
            if !is_read && self.unknowns.iter().any(|of| of.cable() == Some(cable)) {
                return Err(CalibrationError::UnreadCable { cable });
            }
        }
        let coordinates = self.row_unknown_count();
        for (j, row) in self.rows.iter().enumerate() {
            let data = self.data_count(row);
            if data < coordinates {
                return Err(CalibrationError::OpenPose { row: j + 1, data, coordinates });
            }
        }
        Ok(())
    }

    /// Refuses fewer data than unknowns (96g).
    ///
    /// # Errors
    /// [`CalibrationError::TooFewRows`].
    pub fn check_count(&self, frame: &CalibrationFrame) -> Result<(), CalibrationError> {
        let data: usize = self.rows.iter().map(|row| self.data_count(row)).sum();
        let poses = self.rows.len() * self.row_unknown_count();
        let unknowns = frame.free_count().saturating_sub(self.priors.len());
        if data >= unknowns + poses {
            return Ok(());
        }
        let most = self.rows.iter().map(|row| self.data_count(row)).max().unwrap_or(0);
        let full = if self.is_elastic() { most } else { most.max(self.robot.cables.len()) };
        let net = full.saturating_sub(self.row_unknown_count());
        let needed = (net > 0).then(|| unknowns.div_ceil(net));
        Err(CalibrationError::TooFewRows { data, unknowns, poses, needed })
    }

    /// Number of data of a row: readings, coordinates, angles, tensions, measured or known beforehand.
    pub fn data_count(&self, row: &MeasuredRow) -> usize {
        let tensions = (0..self.robot.cables.len()).filter(|cable| self.tension_datum(row, *cable).is_some()).count();
        row.readings.iter().flatten().count() + self.pose_data_counts(row).iter().sum::<usize>() + tensions
    }

    /// Number of coordinates of a pose that the readings see: degrees of freedom, or only the translations if all
    /// cables end in one point.
    pub fn coordinate_count(&self) -> usize {
        match (self.robot.platform.motion, self.is_point) {
            (PlatformMotion::Planar(_), true) => 2,
            (_, true) | (PlatformMotion::Planar(_), false) => 3,
            (_, false) => 6,
        }
    }

    /// Number of unknowns of a row: coordinates of its pose, or the true lengths of elastic cables.
    pub fn row_unknown_count(&self) -> usize {
        if self.is_elastic() { self.robot.cables.len() } else { self.coordinate_count() }
    }

    /// True if all cables end in one point of the platform, so that the readings do not see it turn.
    pub fn is_point(&self) -> bool {
        self.is_point
    }

    /// Coordinates of the robot's platform.
    fn coordinates(&self) -> Coordinates {
        Coordinates::of(&self.robot)
    }

    /// World axes along which the platform moves, as by [`moving_axes`].
    pub fn axes(&self) -> Vec<usize> {
        moving_axes(&self.robot)
    }

    /// Unit vectors of the translations of the platform, two of them in a plane, world axes. Anchors that are unknown
    /// move along them only.
    pub fn translations_w(&self) -> Vec<Vec3> {
        self.robot.platform.motion.translations_w()
    }

    /// Values of the unknowns in the robot file: metres, and for a scale or a factor its value or logarithm times a
    /// length.
    pub fn start(&self) -> Vec<f64> {
        self.as_in_file().values(&self.unknowns, self.scale_length)
    }

    /// Robot and readings with values of the unknowns.
    pub fn robot_at(&self, values: &[f64]) -> CalibratedRobot {
        let mut calibrated = self.as_in_file();
        calibrated.set(&self.unknowns, values, self.scale_length);
        calibrated
    }

    /// Robot of the file, whose encoders count in metres from zero.
    fn as_in_file(&self) -> CalibratedRobot {
        let factors = [1.0; 3];
        CalibratedRobot { robot: self.robot.clone(), offsets: vec![0.0; self.robot.cables.len()], scale: 1.0, factors }
    }

    /// Number that a value of the vectors of results means, and its derivative: metres as they are; a scale, or a
    /// factor.
    pub fn meaning(&self, unknown: usize, value: f64) -> [f64; 2] {
        match self.unknowns[unknown] {
            CalibrationUnknown::Scale => [value / self.scale_length, 1.0 / self.scale_length],
            of if of.factor().is_some() => {
                let factor = (value / self.scale_length).exp();
                [factor, factor / self.scale_length]
            }
            _ => [value, 1.0],
        }
    }

    /// Value in the vectors of results of a number that [`Calibration::meaning`] returns.
    pub(super) fn value_of(&self, unknown: usize, meaning: f64) -> f64 {
        match self.unknowns[unknown] {
            CalibrationUnknown::Scale => meaning * self.scale_length,
            of if of.factor().is_some() => meaning.ln() * self.scale_length,
            _ => meaning,
        }
    }

    /// Place of an unknown.
    pub fn position_of(&self, wanted: &CalibrationUnknown) -> Option<usize> {
        self.unknowns.iter().position(|of| of == wanted)
    }

    /// Poses at which the search begins: those of the rows, else the middle of the anchors without a turn.
    pub fn start_poses(&self) -> Vec<Pose> {
        let middle = self.middle();
        self.rows.iter().map(|row| row.start.unwrap_or(middle)).collect()
    }

    /// Middle of the anchors, in the plane of a planar platform, without a turn.
    fn middle(&self) -> Pose {
        let count = self.robot.cables.len().max(1) as f64;
        let mut middle = self.robot.cables.iter().map(|cable| cable.anchor.point_w).sum::<Vec3>() / count;
        if let PlatformMotion::Planar(plane) = &self.robot.platform.motion {
            middle -= plane.normal_w() * plane.distance(&middle);
        }
        // Cables whose anchors lie in a plane with the platform would not see it leave the plane.
        if self.translations_w().len() == 3 {
            let up = self.robot.up_w();
            let drop = MIDDLE_BELOW * self.anchor_spread();
            let highest = self.robot.cables.iter().map(|cable| cable.anchor.point_w.dot(&up)).fold(f64::MIN, f64::max);
            let lowest = self.robot.cables.iter().map(|cable| cable.anchor.point_w.dot(&up)).fold(f64::MAX, f64::min);
            if highest - lowest < drop {
                middle -= up * drop;
            }
        }
        Pose { position_w: middle, ..Pose::new([0.0; 3], [0.0; 3]) }
    }

    /// Root of the mean square distance of the anchors from their mean [m].
    pub fn anchor_spread(&self) -> f64 {
        let count = self.robot.cables.len().max(1) as f64;
        let mean = self.robot.cables.iter().map(|cable| cable.anchor.point_w).sum::<Vec3>() / count;
        let squares: f64 = self.robot.cables.iter().map(|cable| (cable.anchor.point_w - mean).norm_squared()).sum();
        (squares / count).sqrt()
    }
}

/// World axes along which a platform moves that is calibrated: 0, 1, 2 without one that is the normal of its plane.
pub fn moving_axes(robot: &Robot) -> Vec<usize> {
    robot.platform.motion.components().into_iter().filter(|component| *component < 3).collect()
}

/// Iterations of one start. Sound starts arrive within about 50; the best one goes on to its end.
const ITERATIONS_OF_START: usize = 80;

/// Distance between attachments, relative to the readings, up to which they are one point.
const SAME_POINT: f64 = 1e-9;

/// Depth of the first poses below anchors that lie at one height, relative to the spread of the anchors. Half of a
/// spread is where most robots that hang under a ceiling work; in the plane of the anchors no reading sees the height.
const MIDDLE_BELOW: f64 = 0.5;

/// Orthonormal basis of the vectors that a matrix of full row rank maps to zero, as columns.
fn null_space(rows: &DMat) -> DMat {
    let (count, n) = (rows.nrows(), rows.ncols());
    if count == 0 {
        return DMat::identity(n, n);
    }
    let mut transposed = DMat::identity(n, n);
    rows.transpose().qr().q_tr_mul(&mut transposed);
    transposed.rows(count, n - count).transpose()
}

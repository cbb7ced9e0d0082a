//! Freedom of the frame: motions of the whole robot that change no datum, and the conditions that take their place.

use super::elastic::RowState;
use super::{Calibration, CalibrationError, CalibrationUnknown, null_space};
use crate::math::{DMat, DVec, Vec3};
use crate::robot::{PlatformMotion, Pose};

/// Choice of the conditions that fix the frame.
#[derive(Debug, Clone, PartialEq)]
pub enum FrameChoice {
    /// The first of these cables keeps its anchor, the second the direction from the first, the third the plane of the
    /// three; further cables follow where these do not suffice. Empty for the order of the robot file.
    Anchors(Vec<usize>),
    /// The anchors move as little as possible: the sum of their variances is least.
    Inner,
}

/// Free motions of the frame and the conditions on the unknowns that fix it.
#[derive(Debug, Clone)]
pub struct CalibrationFrame {
    /// Motions of the unknowns that change no datum, as columns.
    motions: DMat,
    /// Conditions, as rows; their product with a change of the unknowns is zero.
    conditions: DMat,
    /// Orthonormal basis of the changes that keep the conditions, as columns.
    pub(super) free: DMat,
    /// True for inner conditions.
    pub is_inner: bool,
    /// Cables whose anchors the conditions hold, in their order; empty for inner conditions.
    pub held: Vec<usize>,
    /// Number of coordinates that the conditions hold for each of these cables.
    pub held_coordinates: Vec<usize>,
}

/// Change of the data by a motion, relative to that by the unknowns one by one, up to which the motion is free.
/// Rounding is 1e-14; a coordinate measured 1e6 times worse than lengths is far above.
const FREE_MOTION: f64 = 1e-9;

/// Part of a condition that the conditions before it do not fix, below which it is left out.
const NEW_CONDITION: f64 = 1e-6;

impl Calibration {
    /// Free motions of the frame at the starting values, and their conditions.
    ///
    /// # Errors
    /// [`CalibrationError::FreeSize`].
    pub fn frame(&self, choice: &FrameChoice) -> Result<CalibrationFrame, CalibrationError> {
        let values = self.start();
        let poses = self.generic_poses();
        let mut motions = self.free_motions(&values, &poses, false);
        if self.position_of(&CalibrationUnknown::Scale).is_some()
            && self.free_motions(&values, &poses, true).ncols() > motions.ncols()
        {
            return Err(CalibrationError::FreeSize);
        }
        // A frame without motions has a matrix without columns.
        if motions.ncols() == 0 {
            motions = DMat::zeros(self.unknowns.len(), 0);
        }
        let (conditions, held, held_coordinates) = match choice {
            FrameChoice::Inner => (motions.transpose(), Vec::new(), Vec::new()),
            FrameChoice::Anchors(order) => self.conditions(&motions, order),
        };
        let conditions = stacked(&conditions, &self.plane_conditions());
        let is_inner = *choice == FrameChoice::Inner;
        Ok(CalibrationFrame { free: null_space(&conditions), motions, conditions, is_inner, held, held_coordinates })
    }

    /// Frame with the free motions of a fit, which turn about its own anchors; inner conditions are then those of the
    /// fit.
    pub fn frame_about(&self, frame: &CalibrationFrame, fit: &super::CalibrationFit) -> CalibrationFrame {
        let motions = self.free_motions(&fit.values, &fit.poses, false);
        if motions.ncols() != frame.motions.ncols() {
            return frame.clone();
        }
        let conditions = if frame.is_inner {
            stacked(&motions.transpose(), &self.plane_conditions())
        } else {
            frame.conditions.clone()
        };
        CalibrationFrame { free: null_space(&conditions), motions, conditions, ..frame.clone() }
    }

    /// Conditions, as rows, that keep unknown anchors and attachments at their distance from a plane that contains no
    /// world axis across which they could leave it; none in a coordinate plane, in which that coordinate is no unknown.
    fn plane_conditions(&self) -> DMat {
        let PlatformMotion::Planar(plane) = &self.robot.platform.motion else {
            return DMat::zeros(0, self.unknowns.len());
        };
        let normal = plane.normal_w();
        let is_anchor = |of: &CalibrationUnknown| matches!(of, CalibrationUnknown::Anchor { .. });
        let points = (0..self.robot.cables.len()).flat_map(|cable| [(cable, true), (cable, false)]);
        let row = |(point, anchors): (usize, bool)| {
            DVec::from_fn(self.unknowns.len(), |k, _| match &self.unknowns[k] {
                of if of.cable() != Some(point) || is_anchor(of) != anchors => 0.0,
                CalibrationUnknown::Anchor { axis, .. } | CalibrationUnknown::Attachment { axis, .. } => normal[*axis],
                _ => 0.0,
            })
        };
        let rows: Vec<DVec> = points.map(row).filter(|row| row.amax() > 0.0).collect();
        if rows.is_empty() { DMat::zeros(0, self.unknowns.len()) } else { DMat::from_columns(&rows).transpose() }
    }

    /// Poses in general position, at which no accident hides a motion.
    fn generic_poses(&self) -> Vec<Pose> {
        let reach = 0.2 * self.anchor_spread();
        let (count, translations) = (self.coordinate_count(), self.translations_w().len());
        let spread = |(j, pose): (usize, Pose)| {
            let step = DVec::from_fn(count, |c, _| {
                let turn = c >= translations;
                let size = if turn { 0.3 * self.coordinates().ell() } else { reach };
                size * (2.0 * super::spread::spread(j, c) - 1.0)
            });
            self.moved(&pose, &step)
        };
        self.start_poses().into_iter().enumerate().map(spread).collect()
    }

    /// Motions that change no datum, orthonormal columns; with the size of the robot among them if asked.
    fn free_motions(&self, values: &[f64], poses: &[Pose], with_size: bool) -> DMat {
        let fields = self.motion_fields(values, with_size);
        let at = self.robot_at(values);
        let straight = |pose: &Pose| at.robot.cables.iter().map(|cable| cable.straight_length(pose)).collect();
        let state = |pose: &Pose| RowState {
            pose: *pose,
            lengths: if self.is_elastic() { straight(pose) } else { Vec::new() },
        };
        let rows = self.rows.iter().zip(poses);
        let terms: Vec<_> = rows.filter_map(|(row, pose)| self.terms_of(&at, row, &state(pose))).collect();
        let identity = DMat::identity(values.len(), values.len());
        let net: Vec<DMat> =
            terms.iter().map(|row| super::elimination::EliminatedRow::of(row, &identity, None).net).collect();
        let largest = net.iter().flat_map(|net| net.column_iter().map(|column| column.norm())).fold(0.0, f64::max);
        let largest = largest.max(f64::MIN_POSITIVE);

        // Changes of the data, and numbers that are known but would have to change.
        let along = DMat::from_columns(&fields.iter().map(|of| of.unknowns.clone()).collect::<Vec<_>>());
        let known = fields.first().map_or(0, |of| of.known.len());
        // Priors hold a place in the world as data do.
        let net: Vec<DMat> = net.into_iter().chain([self.prior_rows(&identity)]).collect();
        let height: usize = net.iter().map(DMat::nrows).sum();
        let mut changes = DMat::zeros((height + known).max(fields.len()), fields.len());
        let mut first = 0;
        for net in &net {
            changes.view_mut((first, 0), (net.nrows(), fields.len())).copy_from(&((net / largest) * &along));
            first += net.nrows();
        }
        for (k, field) in fields.iter().enumerate() {
            for (i, value) in field.known.iter().enumerate() {
                changes[(height + i, k)] = *value;
            }
        }
        let svd = changes.svd(false, true);
        let Some(right) = svd.v_t else { return DMat::zeros(values.len(), 0) };
        let columns: Vec<DVec> = (0..fields.len())
            .filter(|&k| svd.singular_values[k] <= FREE_MOTION)
            .map(|k| &along * right.row(k).transpose())
            .collect();
        if columns.is_empty() {
            return DMat::zeros(values.len(), 0);
        }
        DMat::from_columns(&columns).qr().q()
    }

    /// Motions of the world, of the platform's own frame and of the size, each scaled to changes of about one metre.
    fn motion_fields(&self, values: &[f64], with_size: bool) -> Vec<MotionField> {
        let at = self.robot_at(values);
        let cables = &at.robot.cables;
        let count = cables.len() as f64;
        let middle = cables.iter().map(|cable| cable.anchor.point_w).sum::<Vec3>() / count;
        let (spread, ell) = (self.anchor_spread().max(f64::MIN_POSITIVE), self.coordinates().ell());
        let turns: Vec<Vec3> = match &self.robot.platform.motion {
            PlatformMotion::Planar(plane) => vec![plane.normal_w()],
            _ => (0..3).map(|axis| Vec3::ith(axis, 1.0)).collect(),
        };
        let shifts = self.translations_w();

        let mut fields = Vec::new();
        let still = |_: usize| Vec3::zeros();
        for shift in shifts.clone() {
            fields.push(self.field(&|_| shift, &still, 0.0));
        }
        for turn in &turns {
            fields.push(self.field(&|i| turn.cross(&(cables[i].anchor.point_w - middle)) / spread, &still, 0.0));
        }
        if !self.is_point {
            for shift in shifts {
                fields.push(self.field(&still, &|_| shift, 0.0));
            }
            for turn in &turns {
                fields.push(self.field(&still, &|i| turn.cross(&cables[i].attachment_p) / ell, 0.0));
            }
        }
        if with_size {
            let mut field = self.field(
                &|i| (cables[i].anchor.point_w - middle) / spread,
                &|i| cables[i].attachment_p / spread,
                1.0 / spread,
            );
            // Lengths of known offsets would have to grow with the robot.
            field.known.extend(at.offsets.iter().map(|offset| offset / spread));
            fields.push(field);
            let longest = fields.iter().map(|of| of.known.len()).max().unwrap_or(0);
            for field in &mut fields {
                field.known.resize(longest, 0.0);
            }
        }
        fields
    }

    /// Motion field from those of anchors and attachments; `scale` is the relative growth of the scale of readings.
    fn field(&self, anchor: &dyn Fn(usize) -> Vec3, attachment: &dyn Fn(usize) -> Vec3, scale: f64) -> MotionField {
        let unknowns = DVec::from_fn(self.unknowns.len(), |k, _| match self.unknowns[k] {
            CalibrationUnknown::Anchor { cable, axis } => anchor(cable)[axis],
            CalibrationUnknown::Attachment { cable, axis } => attachment(cable)[axis],
            CalibrationUnknown::Scale => scale * self.scale_length,
            _ => 0.0,
        });
        let is_known = |of: CalibrationUnknown| !self.unknowns.contains(&of);
        let mut known = Vec::new();
        for cable in 0..self.robot.cables.len() {
            for axis in 0..3 {
                let of_anchor = is_known(CalibrationUnknown::Anchor { cable, axis });
                let of_attachment = is_known(CalibrationUnknown::Attachment { cable, axis });
                known.push(if of_anchor { anchor(cable)[axis] } else { 0.0 });
                known.push(if of_attachment { attachment(cable)[axis] } else { 0.0 });
            }
        }
        known.push(if is_known(CalibrationUnknown::Scale) { scale * self.scale_length } else { 0.0 });
        known.extend((self.plane_conditions() * &unknowns).iter());
        MotionField { unknowns, known }
    }

    /// Conditions on anchors in an order, then on attachments, as many as there are motions; with the cables that they
    /// hold and the number of coordinates of each.
    fn conditions(&self, motions: &DMat, order: &[usize]) -> (DMat, Vec<usize>, Vec<usize>) {
        let mut order = order.to_vec();
        order.extend((0..self.robot.cables.len()).filter(|cable| !order.contains(cable)).collect::<Vec<_>>());
        let anchors: Vec<Vec3> = self.robot.cables.iter().map(|cable| cable.anchor.point_w).collect();
        let attachments: Vec<Vec3> = self.robot.cables.iter().map(|cable| cable.attachment_p).collect();
        let of_anchors = self.candidates(&order, &anchors, |cable, axis| CalibrationUnknown::Anchor { cable, axis });
        let of_attachments =
            self.candidates(&order, &attachments, |cable, axis| CalibrationUnknown::Attachment { cable, axis });

        let (mut chosen, mut basis): (Vec<DVec>, Vec<DVec>) = (Vec::new(), Vec::new());
        let (mut held, mut held_coordinates) = (Vec::new(), Vec::new());
        for (k, (cable, row)) in of_anchors.iter().chain(&of_attachments).enumerate() {
            if chosen.len() == motions.ncols() {
                break;
            }
            let mut fixes = motions.transpose() * row;
            let size = fixes.norm();
            for known in &basis {
                fixes -= known * known.dot(&fixes);
            }
            if fixes.norm() <= NEW_CONDITION * size.max(NEW_CONDITION) {
                continue;
            }
            basis.push(fixes.normalize());
            chosen.push(row.clone());
            if k < of_anchors.len() {
                if held.last() != Some(cable) {
                    held.push(*cable);
                    held_coordinates.push(0);
                }
                if let Some(count) = held_coordinates.last_mut() {
                    *count += 1;
                }
            }
        }
        if chosen.is_empty() {
            return (DMat::zeros(0, self.unknowns.len()), held, held_coordinates);
        }
        (DMat::from_columns(&chosen).transpose(), held, held_coordinates)
    }

    /// Conditions on points in an order: all coordinates of the first; of the second those across the direction from
    /// the first; of the third that across the plane of the three; then all of all.
    fn candidates(
        &self,
        order: &[usize],
        points: &[Vec3],
        unknown: impl Fn(usize, usize) -> CalibrationUnknown,
    ) -> Vec<(usize, DVec)> {
        let row = |cable: usize, direction: Vec3| {
            let mut row = DVec::zeros(self.unknowns.len());
            for axis in 0..3 {
                match self.position_of(&unknown(cable, axis)) {
                    Some(place) => row[place] = direction[axis],
                    None if direction[axis].abs() > NEW_CONDITION => return None,
                    None => {}
                }
            }
            Some((cable, row))
        };
        let axes = self.translations_w();
        let mut candidates = Vec::new();
        if let Some(&a) = order.first() {
            candidates.extend(axes.iter().filter_map(|axis| row(a, *axis)));
        }
        if let [a, b, rest @ ..] = order
            && let Some(along) = (points[*b] - points[*a]).try_normalize(f64::MIN_POSITIVE)
        {
            // Across the direction, along the axes as far as possible.
            let mut across: Vec<Vec3> = axes.iter().map(|axis| axis - along * along.dot(axis)).collect();
            across.sort_by(|x, y| y.norm().total_cmp(&x.norm()));
            let first = across.first().map(Vec3::normalize);
            candidates.extend(first.and_then(|direction| row(*b, direction)));
            if let (Some(first), true) = (first, axes.len() == 3) {
                candidates.extend(row(*b, along.cross(&first)));
            }
            if let Some(c) = rest.first()
                && let Some(normal) = along.cross(&(points[*c] - points[*a])).try_normalize(f64::MIN_POSITIVE)
            {
                candidates.extend(row(*c, normal));
            }
        }
        candidates.extend(order.iter().flat_map(|&cable| axes.iter().filter_map(move |axis| row(cable, *axis))));
        candidates
    }
}

/// Rows of two matrices, one below the other.
fn stacked(above: &DMat, below: &DMat) -> DMat {
    let mut all = DMat::zeros(above.nrows() + below.nrows(), below.ncols());
    all.rows_mut(0, above.nrows()).copy_from(above);
    all.rows_mut(above.nrows(), below.nrows()).copy_from(below);
    all
}

/// Change of the unknowns by a motion, and of the numbers that are known.
struct MotionField {
    unknowns: DVec,
    known: Vec<f64>,
}

impl CalibrationFrame {
    /// True if the conditions hold an unknown by itself.
    pub fn holds(&self, unknown: usize) -> bool {
        self.free.row(unknown).norm() <= NEW_CONDITION
    }

    /// Gives the unknowns that the conditions hold one by one their starting values, without rounding.
    pub(super) fn hold(&self, values: &mut [f64], start: &[f64]) {
        for (k, (value, start)) in values.iter_mut().zip(start).enumerate() {
            if self.holds(k) {
                *value = *start;
            }
        }
    }

    /// Number of unknowns less that of the conditions.
    pub fn free_count(&self) -> usize {
        self.free.ncols()
    }

    /// Number of free motions of the frame.
    pub fn motion_count(&self) -> usize {
        self.motions.ncols()
    }

    /// Covariance of the unknowns with inner conditions, from that in any frame (96d).
    pub fn inner(&self, covariance: &DMat) -> DMat {
        let project = self.inner_projection();
        &project * covariance * project.transpose()
    }

    /// Orthonormal basis of the changes of the unknowns that keep the conditions, as columns.
    pub fn free_directions(&self) -> &DMat {
        &self.free
    }

    /// Projection of changes of the unknowns on those with inner conditions.
    pub fn inner_projection(&self) -> DMat {
        let n = self.motions.nrows();
        DMat::identity(n, n) - &self.motions * self.motions.transpose()
    }

    /// Values that fulfil the conditions exactly, from those of a figure in any place, and the poses that move with it.
    pub(super) fn placed(&self, of: &Calibration, values: &[f64], poses: &[Pose]) -> (Vec<f64>, Vec<Pose>) {
        let target = &self.conditions * DVec::from_vec(of.start());
        let (mut values, mut poses) = (values.to_vec(), poses.to_vec());
        for _ in 0..PLACING_STEPS {
            let missing = &target - &self.conditions * DVec::from_column_slice(&values);
            if missing.amax() <= PLACED * of.anchor_spread() {
                break;
            }
            // The motions of the figure at its present place.
            let Some(motion) = of.world_motion(&values, &self.conditions, &missing) else { break };
            motion.apply(of, &mut values, &mut poses);
        }
        (values, poses)
    }
}

/// Maximum number of steps that place a figure; Newton's method needs about six from a quarter turn.
const PLACING_STEPS: usize = 50;

/// Distance from the conditions, relative to the spread of the anchors, at which a figure is in its place.
const PLACED: f64 = 1e-14;

/// Shift and turn of the whole robot about the middle of its anchors.
struct WorldMotion {
    shift: Vec3,
    turn: Vec3,
    middle: Vec3,
}

impl Calibration {
    /// Smallest motion of the world that changes the conditions by `missing`.
    fn world_motion(&self, values: &[f64], conditions: &DMat, missing: &DVec) -> Option<WorldMotion> {
        let fields = self.motion_fields(values, false);
        let at = self.robot_at(values);
        let count = at.robot.cables.len() as f64;
        let middle = at.robot.cables.iter().map(|cable| cable.anchor.point_w).sum::<Vec3>() / count;
        let shifts = self.translations_w();
        let turns = if shifts.len() == 2 { 1 } else { 3 };
        let used = shifts.len() + turns;
        let along = DMat::from_columns(&fields.iter().take(used).map(|of| of.unknowns.clone()).collect::<Vec<_>>());
        let step = (conditions * along).svd(true, true).solve(missing, NEW_CONDITION).ok()?;

        let shift = shifts.iter().zip(step.iter()).map(|(shift, size)| shift * *size).sum();
        let turn = match &self.robot.platform.motion {
            PlatformMotion::Planar(plane) => plane.normal_w() * step[shifts.len()],
            _ => Vec3::new(step[3], step[4], step[5]),
        };
        let turn = turn / self.anchor_spread();
        let limit = turn.norm().max(1.0);
        Some(WorldMotion { shift, turn: turn / limit, middle })
    }
}

impl WorldMotion {
    fn apply(&self, of: &Calibration, values: &mut [f64], poses: &mut [Pose]) {
        let rotation = crate::math::Rotation::from_scaled_axis(self.turn);
        let moved = |point: Vec3| self.middle + self.shift + rotation * (point - self.middle);
        let at = of.robot_at(values);
        for (value, unknown) in values.iter_mut().zip(&of.unknowns) {
            if let CalibrationUnknown::Anchor { cable, axis } = unknown {
                *value = moved(at.robot.cables[*cable].anchor.point_w)[*axis];
            }
        }
        for pose in poses {
            *pose = Pose { position_w: moved(pose.position_w), rot_wp: rotation * pose.rot_wp };
        }
    }
}

//! Sampled robots: which ones, their results, and tables of them.

use super::distribution::latin_hypercube;
use super::inputs::{DeviatingNumber, Distribution, Inputs};
use super::linear::LinearPose;
use super::results;
use super::statistics::total_share;
use crate::measure::Measure;
use crate::request::UncertaintyRequest;
use crate::sweep::{Chunk, Column, ColumnKind, Values};
use anyhow::{Result, bail};
use funicular::gradient::Hold;
use funicular::math::Vec3;
use funicular::robot::{Robot, State};
use funicular::statics::{self, Equilibrium};

/// Maximum number of values of all sampled robots: some 200 MB.
const MAX_VALUES: usize = 20_000_000;

/// Maximum number of rows per chunk, and minimum number of chunks of a small sample.
const MAX_ROWS: usize = 16;
const MIN_CHUNKS: usize = 64;

/// Set of sampled robots at a pose.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum SampleSet {
    /// Latin hypercube.
    Sample,
    /// Latin hypercube with the numbers of a group drawn again.
    Redrawn(usize),
    /// Two corners of the tolerances for a row of the results: those that increase and that decrease it linearly.
    Corners(usize),
}

/// Robots of one set.
struct Segment {
    pose: usize,
    set: SampleSet,
    first: usize,
    count: usize,
}

/// All robots to compute.
pub(crate) struct Sampling {
    segments: Vec<Segment>,
    /// Results, one column each.
    pub(crate) kinds: Vec<Measure>,
    rows: usize,
    /// Points in the unit cube, and the points from which groups are drawn again.
    points: Vec<Vec<f64>>,
    redrawn: Vec<Vec<f64>>,
}

impl Sampling {
    /// Chooses the robots: at each pose those that its results need. Samples may be not allowed, corners always are.
    ///
    /// # Errors
    /// More values than the memory is for.
    pub(crate) fn new(
        request: &UncertaintyRequest,
        inputs: &Inputs,
        poses: &[Option<LinearPose>],
        is_allowed: bool,
    ) -> Result<Self> {
        let groups = inputs.groups.len();
        let mut sampling =
            Self { segments: Vec::new(), kinds: Vec::new(), rows: 0, points: Vec::new(), redrawn: Vec::new() };
        for (pose, linear) in poses.iter().enumerate().filter_map(|(i, linear)| Some((i, linear.as_ref()?))) {
            if is_allowed && linear.needs_samples() {
                sampling.push(pose, SampleSet::Sample, request.samples);
                let redrawn = if groups > 1 { 0..groups } else { 0..0 };
                redrawn.for_each(|group| sampling.push(pose, SampleSet::Redrawn(group), request.samples));
            }
            if linear.distributions.iter().any(|of| of.half_width().is_some()) {
                let with_corners = linear.rows.iter().enumerate().filter(|(_, row)| row.derivatives.is_some());
                with_corners.for_each(|(row, _)| sampling.push(pose, SampleSet::Corners(row), 2));
            }
            for row in &linear.rows {
                if !sampling.kinds.contains(&row.kind) {
                    sampling.kinds.push(row.kind);
                }
            }
        }
        let values = sampling.rows.saturating_mul(sampling.kinds.len());
        if values > MAX_VALUES {
            bail!(
                "{} robots with {} results each would be sampled, {values} values, and at most {MAX_VALUES} are \
                 possible: give fewer poses, results or ⟪samples⟫, or ⟪method⟫ linear",
                sampling.rows,
                sampling.kinds.len()
            );
        }

        // One sample for all poses, so that differences between poses are not those of chance.
        if sampling.segments.iter().any(|segment| segment.set == SampleSet::Sample) {
            let axes = inputs.list.len();
            let seed = u64::from(request.seed);
            sampling.points = latin_hypercube(request.samples, axes, 2 * seed);
            sampling.redrawn = latin_hypercube(request.samples, axes, 2 * seed + 1);
        }
        Ok(sampling)
    }

    fn push(&mut self, pose: usize, set: SampleSet, count: usize) {
        self.segments.push(Segment { pose, set, first: self.rows, count });
        self.rows += count;
    }

    /// Number of robots.
    pub(crate) fn rows(&self) -> usize {
        self.rows
    }

    /// Number of robots per chunk.
    pub(crate) fn chunk_rows(&self) -> usize {
        (self.rows / MIN_CHUNKS).clamp(1, MAX_ROWS)
    }

    /// Number of chunks.
    pub(crate) fn chunks(&self) -> usize {
        self.rows.div_ceil(self.chunk_rows())
    }

    /// Columns of the rows: pose, set, number, reason of missing values, then the results.
    pub(crate) fn columns(&self, robot: &Robot) -> Vec<Column> {
        let column = |name: String, unit: &'static str, about: &str, kind| Column {
            name,
            unit: unit.into(),
            about: about.to_owned(),
            kind,
        };
        let mut columns = vec![
            column("pose".to_owned(), "1", "number of the pose, from 1", ColumnKind::Real),
            column("set".to_owned(), "", "sample, group drawn again, or corner of the tolerances", ColumnKind::Text),
            column("number".to_owned(), "1", "number of the robot in its set, from 1", ColumnKind::Real),
            column("reason".to_owned(), "", "reason why the robot has no results", ColumnKind::Text),
        ];
        let results = self.kinds.iter();
        columns
            .extend(results.map(|kind| column(kind.column(robot), kind.unit(), &kind.name(robot), ColumnKind::Real)));
        columns
    }

    /// Computes a chunk of robots; `None` if `given_up`, which is called between two robots, returned true.
    pub(crate) fn evaluate(
        &self,
        index: usize,
        hold: Hold,
        inputs: &Inputs,
        poses: &[Option<LinearPose>],
        given_up: &dyn Fn() -> bool,
    ) -> Option<Chunk> {
        let begin = index * self.chunk_rows();
        let end = (begin + self.chunk_rows()).min(self.rows);
        let (mut numbers, mut sets, mut counts, mut reasons) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        let mut columns: Vec<Vec<Option<f64>>> = vec![Vec::with_capacity(end - begin); self.kinds.len()];
        for row in begin..end {
            if given_up() {
                return None;
            }
            let segment = &self.segments[self.segments.partition_point(|segment| segment.first <= row) - 1];
            let linear = poses[segment.pose].as_ref()?;
            let deviations = self.deviations(inputs, linear, segment.set, row - segment.first);
            let (values, reason) = match disturbed(inputs, linear, hold, &deviations) {
                Ok((robot, rest)) => {
                    let pose = &linear.at_rest.equilibrium.pose;
                    let kinds: Vec<Measure> = linear.rows.iter().map(|row| row.kind).collect();
                    let responses = linear.responses.as_ref();
                    (results::values(&kinds, &robot, &rest, pose, linear.linearisation, responses), None)
                }
                Err(reason) => (Vec::new(), Some(reason)),
            };

            numbers.push(Some((segment.pose + 1) as f64));
            sets.push(Some(set_name(inputs, linear, segment.set).into()));
            counts.push(Some((row - segment.first + 1) as f64));
            reasons.push(reason.map(Into::into));
            for (kind, column) in self.kinds.iter().zip(&mut columns) {
                let place = linear.rows.iter().position(|row| row.kind == *kind);
                let value = place.and_then(|place| values.get(place)).copied();
                column.push(value.filter(|value| value.is_finite()).map(|value| value + 0.0));
            }
        }
        let head = [Values::Real(numbers), Values::Text(sets), Values::Real(counts), Values::Text(reasons)];
        Some(Chunk { index, columns: head.into_iter().chain(columns.into_iter().map(Values::Real)).collect() })
    }

    /// Deviations of the numbers of one robot.
    fn deviations(&self, inputs: &Inputs, linear: &LinearPose, set: SampleSet, number: usize) -> Vec<f64> {
        let distributions = linear.distributions.iter();
        match set {
            SampleSet::Sample => distributions.zip(&self.points[number]).map(|(of, p)| of.at(*p)).collect(),
            SampleSet::Redrawn(group) => {
                let points = self.points[number].iter().zip(&self.redrawn[number]).zip(&inputs.list);
                let point = |((one, other), input): ((&f64, &f64), &DeviatingNumber)| {
                    if input.group == group { *other } else { *one }
                };
                distributions.zip(points).map(|(of, at)| of.at(point(at))).collect()
            }
            SampleSet::Corners(row) => {
                let side = if number == 0 { 1.0 } else { -1.0 };
                let derivatives = linear.rows[row].derivatives.iter().flatten();
                let corner = |(of, j): (&Distribution, &f64)| {
                    of.half_width().map_or(0.0, |width| if *j == 0.0 { 0.0 } else { side * width.copysign(*j) })
                };
                distributions.zip(derivatives).map(corner).collect()
            }
        }
    }

    /// Rows of a set at a pose.
    fn range(&self, pose: usize, set: SampleSet) -> Option<std::ops::Range<usize>> {
        let found = self.segments.iter().find(|segment| segment.pose == pose && segment.set == set)?;
        Some(found.first..found.first + found.count)
    }
}

/// Name of a set in files.
fn set_name(inputs: &Inputs, linear: &LinearPose, set: SampleSet) -> String {
    match set {
        SampleSet::Sample => "sample".to_owned(),
        SampleSet::Redrawn(group) => format!("redrawn {}", inputs.groups[group].name),
        SampleSet::Corners(row) => format!("corners of {}", linear.rows[row].kind.name(&linear.at_rest.robot)),
    }
}

/// Disturbed robot and its equilibrium.
fn disturbed(
    inputs: &Inputs,
    linear: &LinearPose,
    hold: Hold,
    deviations: &[f64],
) -> Result<(Robot, Equilibrium), String> {
    let (robot, by_length) = inputs.robot(&linear.input_values, deviations)?;
    // The limits of the request are those of the undisturbed robot.
    let robot = robot.with_tension_limits(linear.limits);
    let rest = &linear.at_rest.equilibrium;
    let model = rest.model;

    let found = if hold == Hold::Lengths {
        let lengths: Vec<f64> =
            rest.cables.iter().zip(by_length).map(|(cable, deviation)| cable.unstrained_length + deviation).collect();
        statics::forward(&robot, &lengths, model, Some(&rest.pose))
    } else {
        let (mut translation_w, mut rotation_w) = (Vec3::zeros(), Vec3::zeros());
        for (change, deviation) in linear.pose_changes.iter().zip(deviations) {
            if let Some(change) = change {
                translation_w += change.position_w * *deviation;
                rotation_w += change.rotation_w * *deviation;
            }
        }
        let pose = rest.pose.moved(&translation_w, &rotation_w);
        statics::solve_at(&robot, &State::Pose(pose), model, &linear.rule).map(|found| found.equilibrium)
    };
    found.map(|rest| (robot, rest)).map_err(|error| error.to_string())
}

/// Values of sampled robots.
pub(crate) struct SampleTable {
    /// Values of a row, one per result; NaN where there is none.
    rows: Vec<Vec<f64>>,
    /// Reasons why robots have no results, each with its row.
    pub(crate) reasons: Vec<(usize, String)>,
}

impl SampleTable {
    /// Table without rows.
    pub(crate) fn new() -> Self {
        Self { rows: Vec::new(), reasons: Vec::new() }
    }

    /// Adds the next chunk.
    pub(crate) fn add(&mut self, chunk: &Chunk) {
        let first = self.rows.len();
        let [_, _, _, Values::Text(reasons), columns @ ..] = &chunk.columns[..] else { return };
        self.rows.extend((0..chunk.rows()).map(|_| Vec::with_capacity(columns.len())));
        for column in columns {
            if let Values::Real(values) = column {
                for (row, value) in self.rows[first..].iter_mut().zip(values) {
                    row.push(value.unwrap_or(f64::NAN));
                }
            }
        }
        let of_rows = reasons.iter().enumerate();
        self.reasons.extend(of_rows.filter_map(|(i, reason)| Some((first + i, reason.as_ref()?.to_string()))));
    }

    /// Values of a result in a set at a pose.
    pub(crate) fn values<'t>(
        &'t self,
        sampling: &Sampling,
        pose: usize,
        set: SampleSet,
        kind: Measure,
    ) -> Option<impl Iterator<Item = f64> + use<'t>> {
        let range = sampling.range(pose, set)?;
        let column = sampling.kinds.iter().position(|other| *other == kind)?;
        Some(self.rows.get(range)?.iter().map(move |row| row[column]))
    }

    /// Total shares of the groups in the variance of a result.
    pub(crate) fn shares(
        &self,
        sampling: &Sampling,
        inputs: &Inputs,
        (pose, linear): (usize, &LinearPose),
        kind: Measure,
        deviation: f64,
    ) -> Option<Vec<f64>> {
        if inputs.groups.len() == 1 {
            return Some(vec![1.0]);
        }
        let row = linear.rows.iter().find(|row| row.kind == kind)?;
        let share = |group: usize| {
            let one = self.values(sampling, pose, SampleSet::Sample, kind)?;
            let other = self.values(sampling, pose, SampleSet::Redrawn(group), kind)?;

            // The linear change of the same robots, where there are derivatives.
            let derivatives = row.derivatives.as_deref().unwrap_or_default();
            let of_group = || (0..derivatives.len()).filter(|k| inputs.list[*k].group == group);
            let at = |points: &[f64], k: usize| derivatives[k] * linear.distributions[k].at(points[k]);
            let linear_changes = sampling
                .points
                .iter()
                .zip(&sampling.redrawn)
                .map(|(one, other)| of_group().map(|k| at(one, k) - at(other, k)).sum::<f64>());
            let mean_square: f64 =
                of_group().map(|k| 2.0 * (derivatives[k] * linear.distributions[k].deviation()).powi(2)).sum();
            let changes = one.zip(other).map(|(one, other)| one - other).zip(linear_changes);
            total_share(changes, mean_square, deviation * deviation)
        };
        (0..inputs.groups.len()).map(share).collect()
    }

    /// Number of robots of the sample at a pose that have no results, with the first reason.
    pub(crate) fn failures(&self, sampling: &Sampling, pose: usize) -> Option<(usize, &str)> {
        let range = sampling.range(pose, SampleSet::Sample)?;
        let mut failed = self.reasons.iter().filter(|(row, _)| range.contains(row));
        let (_, first) = failed.next()?;
        Some((1 + failed.count(), first))
    }
}

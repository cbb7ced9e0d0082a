//! `uncertainty`: deviations of results from deviations of numbers of the robot file.
//!
//! The linear method uses the gradients of all results, and four tests decide where it is valid: whether a cable may
//! become slack, whether natural frequencies may cross, whether modes come near and mix, and whether a response is far
//! from linear. Where it is not valid, or where a result has no gradient, robots are sampled (docs/theory.md, section
//! "Uncertainty").
//!
//! The work comes in parts that do not depend on each other: poses, then chunks of sampled robots. A front end runs
//! them on its own threads and may keep the samples in a file, as those of a sweep.

mod distribution;
mod inputs;
mod joint;
mod linear;
mod mode_linearity;
mod output;
mod position;
mod response_linearity;
mod responses;
mod results;
mod row;
mod sampling;
mod statistics;

pub use output::{
    FailedSamples, InputGroup, PoseUncertainty, ResultAtPose, ShareOfInput, UncertainInput, UncertainResponse,
    UncertainResult, Uncertainties, WorstCase,
};
pub use position::PositionDeviation;
pub(crate) use statistics::Statistics;

use super::result_groups::{refuse_unused, result_groups};
use super::shared::Models;
use super::{candidate_poses, found};
use crate::at_rest::{self, AtRest};
use crate::error::{Cancelled, NoSolution};
use crate::measure::{Measure, MeasureGroup};
use crate::names::UncertaintyMethod;
use crate::request::{Pose, Request, UncertaintyRequest};
use crate::table::{Chunk, Record};
use crate::text::counted;
use crate::watch::Watch;
use anyhow::{Result, bail};
use funicular::robot::Robot;
use inputs::{DeviatingNumber, Distribution, Inputs};
use linear::LinearPose;
use responses::RequestedResponse;
use row::Row;
use sampling::{SampleSet, SampleTable, Sampling};
use serde_json::{Value, json};

/// Number of contributions that are listed per result.
const LARGEST: usize = 5;

/// Allowed sample sizes.
pub const SAMPLES: std::ops::RangeInclusive<usize> = 10..=1_000_000;

found!(Uncertainties, "uncertainty");

/// Computes the deviations of all results on the calling thread.
///
/// # Errors
/// A request that contradicts itself or the robot, a robot without equilibrium at every pose, or work that was stopped.
pub fn run(request: &UncertaintyRequest, watch: &mut dyn Watch) -> Result<Uncertainties> {
    let study = UncertaintyStudy::new(request)?;
    let mut poses = Vec::with_capacity(study.poses());
    for pose in 0..study.poses() {
        watch.progress(pose, study.poses(), "poses");
        if watch.is_cancelled() {
            return Err(Cancelled.into());
        }
        poses.push(study.linear(pose));
    }

    let plan = study.plan(poses)?;
    let mut samples = plan.table();
    for chunk in 0..plan.chunks() {
        watch.progress(chunk * plan.chunk_rows(), plan.rows(), "robots");
        let is_cancelled = || watch.is_cancelled();
        let Some(chunk) = plan.evaluate(chunk, &is_cancelled) else { return Err(Cancelled.into()) };
        samples.add(&chunk);
    }
    Ok(plan.finish(&samples))
}

/// Request that is ready to run: poses first, then samples.
pub struct UncertaintyStudy {
    request: UncertaintyRequest,
    of: Vec<&'static MeasureGroup>,
    /// Frequency response, if it is among the results.
    requested: Option<RequestedResponse>,
    robot: Robot,
    inputs: Inputs,
    poses: Vec<Option<[f64; 6]>>,
    /// Number of the first pose that has an equilibrium, and its linear deviations.
    first: (usize, LinearPose),
    /// Reasons of the poses before it.
    failed: Vec<String>,
}

/// Pose with its linear deviations, or the reason why there are none.
pub struct PoseOutcome(Result<LinearPose, String>);

impl UncertaintyStudy {
    /// Checks a request, and finds the first equilibrium.
    ///
    /// # Errors
    /// A request that contradicts itself or the robot, or a robot without equilibrium at every pose.
    pub fn new(request: &UncertaintyRequest) -> Result<Self> {
        let of = groups(request)?;
        let robot = request.robot.read()?.robot;
        let requested =
            of.contains(&&MeasureGroup::Response).then(|| RequestedResponse::new(request, &robot)).transpose()?;
        if let Some(poses) = &request.places.poses {
            crate::sweep::check_poses(poses, &robot)?;
        }
        let poses: Vec<Option<[f64; 6]>> = match candidate_poses::of_places(&request.places, &request.state, &robot)? {
            None => vec![None],
            Some(rows) => rows.into_iter().map(Some).collect(),
        };

        // Input errors are the same at every pose, and are found at the first equilibrium.
        let mut failed = Vec::new();
        let mut first = None;
        for (i, pose) in poses.iter().enumerate() {
            match rest(request, &robot, *pose) {
                Ok(at_rest) => {
                    first = Some((i, at_rest));
                    break;
                }
                Err(error) if poses.len() == 1 || !is_of_pose(&error) => return Err(error),
                Err(error) => failed.push(format!("{error:#}")),
            }
        }
        let Some((first, at_rest)) = first else {
            return Err(NoSolution(format!(
                "the robot has no equilibrium at any of {}; at the first one: {}",
                counted(poses.len(), "pose"),
                failed.first().map_or("", String::as_str)
            ))
            .into());
        };
        let inputs = Inputs::new(request, &at_rest)?;
        // The linear deviations of the first pose find the errors that all poses share.
        let linear = linear_at(request, &of, requested.as_ref(), &inputs, at_rest)?;
        Ok(Self { request: request.clone(), of, requested, robot, inputs, poses, first: (first, linear), failed })
    }

    /// Number of poses.
    pub fn poses(&self) -> usize {
        self.poses.len()
    }

    /// Linear deviations at a pose.
    pub fn linear(&self, pose: usize) -> PoseOutcome {
        if let Some(reason) = self.failed.get(pose) {
            return PoseOutcome(Err(reason.clone()));
        }
        let (first, linear) = &self.first;
        if pose == *first {
            return PoseOutcome(Ok(linear.clone()));
        }
        let at_rest = rest(&self.request, &self.robot, self.poses[pose]);
        let linear = at_rest
            .and_then(|at_rest| linear_at(&self.request, &self.of, self.requested.as_ref(), &self.inputs, at_rest));
        PoseOutcome(linear.map_err(|error| format!("{error:#}")))
    }

    /// Plan of the samples that the poses need, given in their order.
    ///
    /// # Errors
    /// More samples than the memory is for.
    pub fn plan(&self, poses: Vec<PoseOutcome>) -> Result<SamplePlan<'_>> {
        let mut reasons = Vec::with_capacity(poses.len());
        let mut found = Vec::with_capacity(poses.len());
        for PoseOutcome(outcome) in poses {
            match outcome {
                Ok(linear) => {
                    found.push(Some(linear));
                    reasons.push(None);
                }
                Err(reason) => {
                    found.push(None);
                    reasons.push(Some(reason));
                }
            }
        }
        let samples_anything = self.request.method != UncertaintyMethod::Linear;
        let sampling = Sampling::new(&self.request, &self.inputs, &found, samples_anything)?;
        Ok(SamplePlan { study: self, poses: found, reasons, sampling })
    }
}

/// Robots to compute.
pub struct SamplePlan<'a> {
    study: &'a UncertaintyStudy,
    poses: Vec<Option<LinearPose>>,
    reasons: Vec<Option<String>>,
    sampling: Sampling,
}

/// Results of sampled robots.
pub struct Samples(SampleTable);

impl Samples {
    /// Adds the next chunk.
    pub fn add(&mut self, chunk: &Chunk) {
        self.0.add(chunk);
    }
}

impl SamplePlan<'_> {
    /// Number of robots.
    pub fn rows(&self) -> usize {
        self.sampling.rows()
    }

    /// Number of robots per chunk.
    pub fn chunk_rows(&self) -> usize {
        self.sampling.chunk_rows()
    }

    /// Number of chunks.
    pub fn chunks(&self) -> usize {
        self.sampling.chunks()
    }

    /// Empty table for the results of the robots.
    pub fn table(&self) -> Samples {
        Samples(SampleTable::new())
    }

    /// Computes a chunk of robots; `None` if `given_up`, which is called between two robots, returned true. A chunk
    /// depends on the request alone.
    pub fn evaluate(&self, index: usize, given_up: &dyn Fn() -> bool) -> Option<Chunk> {
        self.sampling.evaluate(index, self.study.request.hold, &self.study.inputs, &self.poses, given_up)
    }

    /// Description of a file of the robots.
    ///
    /// # Errors
    /// A robot file that cannot be changed as requested.
    pub fn record(&self) -> Result<Record> {
        let request = &self.study.request;
        let Value::Object(mut plan) = Request::Uncertainty(request.clone()).to_value() else {
            bail!("a request is an object");
        };
        plan.remove("schema");
        plan.insert("robot".to_owned(), json!(request.robot.name));
        Ok(Record {
            robot_file: request.robot.changed_text()?,
            plan,
            columns: self.sampling.columns(&self.study.robot),
            rows: self.rows(),
            chunk_rows: self.chunk_rows(),
            part: None,
        })
    }

    /// Deviations of all results.
    pub fn finish(self, samples: &Samples) -> Uncertainties {
        let UncertaintyStudy { request, robot, inputs, first, .. } = self.study;
        let single = self.poses.len() == 1;
        let mut warnings = Vec::new();
        let mut poses = Vec::with_capacity(self.poses.len());
        for (i, (linear, reason)) in self.poses.iter().zip(&self.reasons).enumerate() {
            let Some(linear) = linear else {
                poses.push(PoseUncertainty {
                    position_m: None,
                    roll_pitch_yaw_deg: None,
                    reason: reason.clone(),
                    failed: None,
                    position: None,
                    results: Vec::new(),
                });
                continue;
            };
            for warning in &linear.warnings {
                if !warnings.contains(warning) {
                    warnings.push(warning.clone());
                }
            }
            poses.push(self.at_pose(i, linear, samples, single));
        }

        let first = &first.1.at_rest;
        let linearisation = at_rest::linearisation(&request.model, first.equilibrium.model);
        Uncertainties {
            robot: robot.name.clone(),
            models: Models::of(first, linearisation),
            held: request.hold.name(),
            held_means: super::gradient::meaning(first, request.hold),
            response: self.study.requested.as_ref().map(|requested| {
                let (input, output, unit) = requested.names();
                UncertainResponse { input: input.to_owned(), output: output.to_owned(), unit }
            }),
            inputs: self.inputs(),
            groups: (inputs.groups.iter().enumerate())
                .map(|(i, group)| InputGroup {
                    name: group.name.clone(),
                    count: inputs.list.iter().filter(|input| input.group == i).count(),
                })
                .collect(),
            samples: request.samples,
            evaluations: self.rows(),
            notes: notes(request, &poses),
            poses,
            warnings,
        }
    }

    /// Numbers that deviate, with their values at the first pose.
    fn inputs(&self) -> Vec<UncertainInput> {
        let inputs = &self.study.inputs;
        let several = self.poses.len() > 1;
        let values = inputs.values(&self.study.first.1.at_rest);
        let distributions = inputs.distributions(&values);
        let input = |((input, value), distribution): ((&DeviatingNumber, f64), Distribution)| {
            let follows = several && inputs.follows_state(input);
            UncertainInput {
                path: input.path.clone(),
                unit: input.unit,
                value: Some(value).filter(|_| !(several && input.is_of_state)),
                distribution: distribution.name(),
                deviation: Some(distribution.deviation()).filter(|_| !follows),
                tolerance: distribution.half_width().filter(|_| !follows),
                group: input.group,
            }
        };
        inputs.list.iter().zip(values).zip(distributions).map(input).collect()
    }

    fn at_pose(&self, i: usize, linear: &LinearPose, samples: &Samples, single: bool) -> PoseUncertainty {
        let pose = crate::analyses::shared::PoseRow::of(&linear.at_rest.equilibrium.pose);
        let rows = linear.rows.iter().enumerate();
        let failed = samples.0.failures(&self.sampling, i);
        PoseUncertainty {
            position_m: Some(pose.position_m),
            roll_pitch_yaw_deg: Some(pose.roll_pitch_yaw_deg),
            reason: None,
            failed: failed.map(|(count, reason)| FailedSamples { count, reason: reason.to_owned() }),
            position: self.position(i, linear, samples),
            results: rows.map(|(number, row)| self.result(i, number, row, linear, samples, single)).collect(),
        }
    }

    /// Deviation of the position, if it is among the results: by gradients, or of the sampled robots.
    fn position(&self, i: usize, linear: &LinearPose, samples: &Samples) -> Option<PositionDeviation> {
        let of_axis = |row| match row {
            row @ &Row { kind: Measure::Pose(axis @ 0..3), .. } => Some((axis, row)),
            _ => None,
        };
        let axes: Vec<(usize, &Row)> = linear.rows.iter().filter_map(of_axis).collect();
        let is_sampled = self.study.request.method != UncertaintyMethod::Linear
            && axes.iter().any(|(_, row)| row.sampling_reason.is_some());
        let changes: Vec<Vec<f64>> = if is_sampled {
            let of_axis = |(_, row): &(usize, &Row)| {
                samples.0.values(&self.sampling, i, SampleSet::Sample, row.kind).map(Iterator::collect)
            };
            axes.iter().map(of_axis).collect::<Option<_>>()?
        } else {
            let of_axis = |(_, row): &(usize, &Row)| {
                let derivatives = row.derivatives.as_ref()?.iter().zip(&linear.distributions);
                Some(derivatives.map(|(derivative, of)| derivative * of.deviation()).collect())
            };
            axes.iter().map(of_axis).collect::<Option<_>>()?
        };
        let axes: Vec<usize> = axes.iter().map(|(axis, _)| *axis).collect();
        if is_sampled {
            PositionDeviation::of_samples(&axes, &changes)
        } else {
            PositionDeviation::of_contributions(&axes, &changes)
        }
    }

    fn result(
        &self,
        pose: usize,
        number: usize,
        row: &Row,
        linear: &LinearPose,
        samples: &Samples,
        single: bool,
    ) -> UncertainResult {
        let inputs = &self.study.inputs;
        let spread = row.spread(&linear.distributions);
        let is_sampled = row.sampling_reason.is_some() && self.study.request.method != UncertaintyMethod::Linear;
        let values = |set: SampleSet| samples.0.values(&self.sampling, pose, set, row.kind);
        let sampled = if is_sampled { values(SampleSet::Sample).and_then(Statistics::of) } else { None };

        // Shares of single numbers are linear; those of the groups of a sampled result include what is not.
        let contributions = row.contributions(&linear.distributions);
        let total: f64 = contributions.iter().flatten().sum();
        let shares =
            contributions.filter(|_| total > 0.0).map(|of| of.iter().map(|part| part / total).collect::<Vec<_>>());
        let group_shares = match &sampled {
            Some(found) => samples.0.shares(&self.sampling, inputs, (pose, linear), row.kind, found.deviation),
            None => shares.as_ref().map(|shares| {
                let mut groups = vec![0.0; inputs.groups.len()];
                inputs.list.iter().zip(shares).for_each(|(input, share)| groups[input.group] += share);
                groups
            }),
        };
        let largest = shares.as_ref().map_or_else(Vec::new, |shares| largest_shares(inputs, shares));

        let worst = row.worst(&linear.distributions).filter(|worst| *worst > 0.0).map(|linear| {
            let mut corners = values(SampleSet::Corners(number)).into_iter().flatten();
            let mut change = || corners.next().filter(|value| value.is_finite()).map(|value| value - row.value);
            let up = change();
            WorstCase { linear, up, down: change() }
        });
        UncertainResult {
            name: row.kind.name(&linear.at_rest.robot),
            measure: row.kind.identity(&linear.at_rest.robot),
            unit: row.kind.unit(),
            at_hz: row.kind.at_hz(),
            value: row.value + 0.0,
            deviation: if is_sampled { sampled.as_ref().map(|of| of.deviation) } else { spread.map(|of| of.0) },
            interval_95: if is_sampled {
                sampled.as_ref().map(|of| of.interval)
            } else {
                spread.map(|(_, half)| [row.value - half, row.value + half])
            },
            method: if is_sampled { "sampled" } else { "linear" },
            sampling_reason: row.sampling_reason.clone(),
            linear_deviation: spread.map(|of| of.0),
            mean: sampled.as_ref().map(|of| of.mean),
            group_shares,
            largest,
            shares: shares.filter(|_| single),
            worst,
        }
    }
}

/// Largest shares of single numbers in a variance.
fn largest_shares(inputs: &Inputs, shares: &[f64]) -> Vec<ShareOfInput> {
    let mut order: Vec<(f64, usize)> = shares.iter().copied().zip(0..).collect();
    order.sort_by(|a, b| b.0.total_cmp(&a.0));
    order.truncate(LARGEST);
    let of = |(share, k): (f64, usize)| ShareOfInput { path: inputs.list[k].path.clone(), share };
    order.into_iter().filter(|(share, _)| *share > 0.0).map(of).collect()
}

/// Groups of results of a request, after a check of them and of the sample size.
fn groups(request: &UncertaintyRequest) -> Result<Vec<&'static MeasureGroup>> {
    let groups = result_groups(&request.of, request.below_hz)?;
    let signals = [request.input.as_deref(), request.output.as_deref()];
    refuse_unused(&groups, request.below_hz, request.at_hz.is_some(), signals, &request.points)?;
    if !SAMPLES.contains(&request.samples) {
        bail!(
            "⟪samples⟫: {} robots are not possible: give a whole number from {} to {}",
            request.samples,
            SAMPLES.start(),
            SAMPLES.end()
        );
    }
    Ok(groups)
}

/// Linear deviations of an equilibrium, by the method of a request.
fn linear_at(
    request: &UncertaintyRequest,
    of: &[&MeasureGroup],
    requested: Option<&RequestedResponse>,
    inputs: &Inputs,
    at_rest: AtRest,
) -> Result<LinearPose> {
    let mut linear = LinearPose::new(request, of, requested, inputs, at_rest)?;

    match request.method {
        UncertaintyMethod::Automatic => {}
        UncertaintyMethod::Linear => {
            if let Some(row) = linear.rows.iter().find(|row| row.derivatives.is_none()) {
                let name = row.kind.name(&linear.at_rest.robot);
                let reason = row.sampling_reason.as_deref().unwrap_or_default();
                bail!("{name} has no linear deviation: {reason}; leave out ⟪method⟫ linear, or this result");
            }
        }
        UncertaintyMethod::Sampled => {
            for row in &mut linear.rows {
                row.sampling_reason.get_or_insert_with(|| "sampled as requested".to_owned());
            }
        }
    }
    Ok(linear)
}

/// Robot of a request at rest, at a pose of its list or at its state.
fn rest(request: &UncertaintyRequest, robot: &Robot, pose: Option<[f64; 6]>) -> Result<AtRest> {
    let mut state = request.state.clone();
    if let Some(pose) = pose {
        state.pose = Some(Pose::Angles(pose));
    }
    at_rest::equilibrium(robot.clone(), &request.robot, &state, &request.tensions)
}

/// True for an error that another pose need not have.
fn is_of_pose(error: &anyhow::Error) -> bool {
    crate::ErrorKind::of(error) == crate::ErrorKind::NoSolution
}

/// Notes on the accuracy.
fn notes(request: &UncertaintyRequest, poses: &[PoseUncertainty]) -> Vec<String> {
    let results = || poses.iter().flat_map(|pose| &pose.results);
    let mut notes = Vec::new();
    let linear = results().filter(|result| result.method == "linear").count();
    let not_valid = results().filter(|result| result.method == "linear" && result.sampling_reason.is_some()).count();
    let sampled = results().count() - linear;

    if linear > not_valid {
        notes.push(format!(
            "{} linear: within the deviations no cable becomes slack, no frequencies cross, and responses are nearly \
             linear",
            counted(linear - not_valid, "result")
        ));
    }
    if not_valid > 0 {
        notes.push(format!(
            "{} linear as requested, although the deviations are too large for it; the reason stands with each result",
            counted(not_valid, "result")
        ));
    }
    if sampled > 0 {
        let n = request.samples as f64;
        notes.push(format!(
            "{} sampled with {} robots: a deviation is accurate to {} %, and an interval holds 95 ± {} % of all robots",
            counted(sampled, "result"),
            request.samples,
            crate::text::significant(100.0 / (2.0 * n).sqrt(), 2),
            crate::text::significant(100.0 * 2.0 * (0.95 * 0.05 / n).sqrt(), 2)
        ));
    }

    if results().any(|result| result.worst.is_some()) {
        notes.push(
            "Worst cases within the tolerances: the linear sum is not a bound; the computed corners are lower bounds"
                .to_owned(),
        );
    }
    notes.extend(output::position_note(poses));
    let failed: usize = poses.iter().filter_map(|pose| pose.failed.as_ref()).map(|failed| failed.count).sum();
    if failed > 0 {
        notes.push(format!("{} had no equilibrium or no valid values: not counted", counted(failed, "sampled robot")));
    }
    notes
}

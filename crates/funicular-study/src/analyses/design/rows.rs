//! Results of one pose and their derivatives by the values, as rows of a linear problem.

use super::band::{self, BandCounts};
use super::differences::{Ends, smooth_share};
use crate::analyses::gradient::{held, no_solution};
use crate::at_rest::{self, AtRest};
use crate::differenced_goals::{DifferencedGoal, GoalPart};
use crate::measure::{LOAD_FACTOR, Measure};
use crate::names::DesignGoal;
use crate::request::DesignRequest;
use anyhow::{Result, anyhow};
use funicular::cable::CableModel;
use funicular::dynamics::{Dynamics, Linearisation};
use funicular::gradient::{Gradients, Hold, VibrationGradients};
use funicular::math::max_min::{Evaluation, LinearisedFunction};
use funicular::modes::{self, Mode, Wanted};
use funicular::robot::RobotChange;
use funicular::statics::StaticModel;

/// Number of lowest modes that have rows: more than can become the lowest one within a step.
const MODES: usize = 6;

/// Limit of the search for the lowest modes [Hz].
const HIGHEST_HZ: f64 = 1e4;

/// Relative distance of frequencies below which their modes mix within a step: combinations of them have rows as well.
const NEAR: f64 = 1e-3;

/// Ratio of the highest frequency with a row to the last frequency of a band: modes farther above do not reach the band
/// in a step.
const ABOVE_BAND: f64 = 1.2;

/// Kind of a demand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum DemandKind {
    /// First natural frequency of at least a limit.
    Frequency,
    /// Minimum stiffness of at least a limit.
    Stiffness,
    /// No natural frequency within a band.
    Band,
}

/// Derivatives of a result by every value.
pub(super) type Slopes = Vec<f64>;

/// Number of worst parts of a goal of differences that have rows: more than can become the worst one within a step.
const PARTS: usize = 16;

/// Change of a robot per unit of a value.
pub(super) enum Direction {
    /// Rates of the robot's numbers, for derivatives.
    Exact(Box<RobotChange>),
    /// A limit of tensions, which has none: differences alone.
    Limit,
}

/// Results at one pose.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct PoseValues {
    /// Value of the goal.
    pub(crate) goal: f64,
    /// First natural frequency, if it is demanded [Hz].
    pub(crate) frequency_hz: Option<f64>,
    /// Minimum stiffness, if it is demanded [N/m].
    pub(crate) stiffness: Option<f64>,
    /// Natural frequency that is deepest in the band or nearest to it, if a band is to be avoided [Hz].
    pub(crate) beside_band_hz: Option<f64>,
    /// Numbers of the natural frequencies below and within the band.
    pub(crate) band_counts: Option<BandCounts>,
}

/// Functions of the values at all poses, with the results of every pose.
#[derive(Default)]
pub(crate) struct Evaluated {
    pub(crate) evaluation: Evaluation,
    pub(crate) poses: Vec<PoseValues>,
    /// Number of rows of the goal, one entry per pose.
    pub(crate) rows_per_pose: Vec<usize>,
    /// Kinds of the rows of demands, in their order.
    pub(crate) demands: Vec<DemandKind>,
}

impl Evaluated {
    /// Adds the rows of the next pose. `directions` are the changes of the robot per unit of each value, `ends` the
    /// robot at rest on both sides of values whose derivatives are differences. `below` is the number of frequencies
    /// that have to go below the band to avoid; without it each goes to its nearer side. `count` is the number of all
    /// poses.
    ///
    /// # Errors
    /// Results without derivatives, or without modes.
    pub(crate) fn add_pose(
        &mut self,
        request: &DesignRequest,
        at_rest: &AtRest,
        (directions, ends): (&[Direction], &[Option<Ends>]),
        (count, below): (usize, Option<usize>),
    ) -> Result<()> {
        let gradients = held(at_rest, Hold::Rule)?;
        let group = if request.weights.is_some() { self.poses.len() } else { 0 };
        let linearisation = at_rest::linearisation(&request.model, at_rest.equilibrium.model);
        let rows =
            PoseRows { request, at_rest, gradients: &gradients, linearisation, directions, ends, group, poses: count };

        let (goal, objectives) = rows.goal()?;
        self.rows_per_pose.push(objectives.len());
        self.add_objectives(request, objectives);

        let mut values = PoseValues { goal, ..PoseValues::default() };
        if let Some(limit) = request.min_frequency_hz {
            let lowest = rows.lowest(linearisation)?;
            values.frequency_hz = lowest.first().map(|(hz, _)| *hz);
            self.add_demands(DemandKind::Frequency, rows.at_least(limit, &lowest));
        }
        if let Some(limit) = request.min_stiffness_n_per_m {
            let stiffnesses = rows.stiffnesses()?;
            values.stiffness = stiffnesses.first().map(|(value, _)| *value);
            self.add_demands(DemandKind::Stiffness, rows.at_least(limit, &stiffnesses));
        }
        if let Some(band) = request.avoid_hz {
            self.add_demands(DemandKind::Band, rows.beside_band(band, below, &mut values)?);
        }
        self.poses.push(values);
        Ok(())
    }

    /// Adds a pose that is not held: it has no part in the share of the poses that are.
    pub(crate) fn add_lost_pose(&mut self, variables: usize) {
        self.rows_per_pose.push(0);
        self.poses.push(PoseValues::default());
        if self.evaluation.objectives.is_empty() {
            let gradient = vec![0.0; variables];
            self.evaluation.objectives.push(LinearisedFunction { value: 0.0, gradient, group: 0 });
        }
    }

    /// Adds rows of the goal; shares of poses are summed in one row.
    fn add_objectives(&mut self, request: &DesignRequest, rows: Vec<LinearisedFunction>) {
        let is_sum = request.goal == DesignGoal::Workspace;
        let (Some(sum), true) = (self.evaluation.objectives.first_mut(), is_sum) else {
            self.evaluation.objectives.extend(rows);
            return;
        };
        for row in rows {
            sum.value += row.value;
            sum.gradient.iter_mut().zip(row.gradient).for_each(|(all, of)| *all += of);
        }
    }

    fn add_demands(&mut self, kind: DemandKind, rows: Vec<LinearisedFunction>) {
        self.demands.extend(rows.iter().map(|_| kind));
        self.evaluation.demands.extend(rows);
    }
}

/// Pose whose results and derivatives become rows.
struct PoseRows<'a> {
    request: &'a DesignRequest,
    at_rest: &'a AtRest,
    gradients: &'a Gradients<'a>,
    /// Linearisation for the demands.
    linearisation: Linearisation,
    /// Changes of the robot per unit of each value.
    directions: &'a [Direction],
    /// Robot on both sides of each value whose derivatives are differences.
    ends: &'a [Option<Ends>],
    /// Group of the rows of the goal.
    group: usize,
    /// Number of all poses.
    poses: usize,
}

impl PoseRows<'_> {
    /// Derivatives of a result by every value, from its gradient; zero for a limit of tensions.
    fn along(&self, gradient: &RobotChange) -> Slopes {
        let along = |direction: &Direction| match direction {
            Direction::Exact(change) => gradient.dot(change),
            Direction::Limit => 0.0,
        };
        self.directions.iter().map(along).collect()
    }

    /// LinearisedFunction of a result, multiplied by a factor.
    fn row(&self, value: f64, slopes: &Slopes, factor: f64) -> LinearisedFunction {
        let gradient = slopes.iter().map(|slope| factor * slope).collect();
        LinearisedFunction { value: value * factor, gradient, group: self.group }
    }

    /// Value of the goal, and its rows.
    fn goal(&self) -> Result<(f64, Vec<LinearisedFunction>)> {
        let smallest_first = |list: &[(f64, Slopes)]| {
            let rows = list.iter().map(|(value, slopes)| self.row(*value, slopes, 1.0)).collect();
            (list.first().map_or(0.0, |(value, _)| *value), rows)
        };
        Ok(match self.request.goal {
            DesignGoal::First | DesignGoal::Platform => {
                let of_goal = linearisation_of_goal(self.request, self.at_rest.equilibrium.model);
                smallest_first(&self.lowest(of_goal)?)
            }
            DesignGoal::Stiffness => smallest_first(&self.stiffnesses()?),
            DesignGoal::Measure(of) => {
                let (value, slopes) = self.at_rest(of.measure())?;
                (value, vec![self.row(value, &slopes, of.sign())])
            }
            DesignGoal::Differenced(of) => {
                let mut parts = self.differenced(of)?;
                parts.sort_by(|a, b| (of.sign * a.0).total_cmp(&(of.sign * b.0)));
                let rows = parts.iter().take(PARTS).map(|(value, slopes)| self.row(*value, slopes, of.sign)).collect();
                (parts.first().map_or(0.0, |(value, _)| *value), rows)
            }
            DesignGoal::Workspace => {
                let Ok((factor, slopes)) = self.at_rest(LOAD_FACTOR) else { return Ok((0.0, Vec::new())) };
                // Every pose adds its share to the row of the first one.
                let (share, rate) = smooth_share(factor);
                let part = 1.0 / self.poses as f64;
                let gradient = slopes.iter().map(|slope| part * rate * slope).collect();
                (factor, vec![LinearisedFunction { value: part * share, gradient, group: 0 }])
            }
        })
    }

    /// Rows that are not negative if results are at least a limit, relative to it.
    fn at_least(&self, limit: f64, list: &[(f64, Slopes)]) -> Vec<LinearisedFunction> {
        list.iter().map(|(value, slopes)| over(self.row(*value, slopes, 1.0), limit, limit)).collect()
    }

    /// Rows that are not negative if natural frequencies are beside a band, relative to its ends. Writes the numbers of
    /// frequencies below and within the band, and the frequency deepest in it, into the results of the pose.
    fn beside_band(
        &self,
        band: [f64; 2],
        below: Option<usize>,
        values: &mut PoseValues,
    ) -> Result<Vec<LinearisedFunction>> {
        let [first, last] = band;
        let (dynamics, list) = self.modes_beside_band(last, below.unwrap_or(0))?;
        let count = |limit: f64| list.iter().filter(|mode| mode.frequency_hz < limit).count();
        let nearer_below = count(band::middle(band));
        values.band_counts = Some(BandCounts { below: count(first), nearer_below, not_above: count(last) });

        let vibration = self.gradients.vibration(&dynamics).map_err(no_solution)?;
        let mut rows = Vec::new();
        for FrequencySlopes { hz, slopes, modes } in frequency_slopes(&vibration, &list, &|of| self.along(of)) {
            if values.beside_band_hz.is_none_or(|other| band::depth(band, hz) > band::depth(band, other)) {
                values.beside_band_hz = Some(hz);
            }
            let goes_below = match below {
                // Modes that go to different sides have no row for their common motions.
                Some(number) if modes[0] < number && modes[1] >= number => continue,
                Some(number) => modes[0] < number,
                None => hz < band::middle(band),
            };
            rows.push(if goes_below {
                over(self.row(hz, &slopes, -1.0), -first, first)
            } else {
                over(self.row(hz, &slopes, 1.0), last, last)
            });
        }
        Ok(rows)
    }

    /// Modes somewhat beyond the last frequency of a band, and at least `wanted` of them: a frequency that has to go
    /// below the band may be far above it.
    fn modes_beside_band(&self, last_hz: f64, wanted: usize) -> Result<(Dynamics, Vec<Mode>)> {
        let (robot, rest) = (&self.at_rest.robot, &self.at_rest.equilibrium);
        // The limit rises little: every mode of the list has a row.
        let next_hz = |limit: f64| (limit <= HIGHEST_HZ).then_some(ABOVE_BAND * limit);
        let found = modes::until(Wanted::Count(wanted), ABOVE_BAND * last_hz, next_hz, |limit| -> Result<_> {
            let dynamics = Dynamics::for_gradients(robot, rest, self.linearisation, limit)?;
            modes::check_count(&dynamics, limit, modes::MAX_MODES)?;
            Ok(dynamics)
        })?;
        Ok((found.dynamics, found.modes.modes))
    }

    /// Stiffnesses [N/m] with their derivatives, ascending.
    fn stiffnesses(&self) -> Result<Vec<(f64, Slopes)>> {
        let found = self.gradients.stiffnesses().map_err(no_solution)?;
        Ok(found.iter().map(|(value, gradient)| (*value, self.along(gradient))).collect())
    }

    /// Lowest natural frequencies [Hz] with their derivatives.
    fn lowest(&self, linearisation: Linearisation) -> Result<Vec<(f64, Slopes)>> {
        let (robot, rest) = (&self.at_rest.robot, &self.at_rest.equilibrium);
        // The platform alone has no more modes than degrees of freedom.
        let is_dynamic = linearisation.cable_model.is_dynamic();
        let wanted = if is_dynamic { MODES } else { MODES.min(robot.platform.motion.count()) };
        let (dynamics, list) = modes::lowest(robot, rest, linearisation, wanted, HIGHEST_HZ)?;

        let vibration = self.gradients.vibration(&dynamics).map_err(no_solution)?;
        let lowest = &list.modes[..list.modes.len().min(wanted)];
        let rows = frequency_slopes(&vibration, lowest, &|of| self.along(of));
        Ok(rows.into_iter().map(|row| (row.hz, row.slopes)).collect())
    }

    /// Value of a measure of the equilibrium, with its derivatives.
    fn at_rest(&self, measure: Measure) -> Result<(f64, Slopes)> {
        let AtRest { robot, equilibrium, .. } = self.at_rest;
        let none = || anyhow!("the {} has no derivatives", measure.name(robot));
        // The gradient says why a value does not exist.
        let gradient = Measure::static_gradients(&[measure], self.gradients).pop().flatten().ok_or_else(none)?;
        let gradient = gradient.map_err(no_solution)?;
        let value = measure.static_value(robot, equilibrium, &equilibrium.pose).ok_or_else(none)?;
        let mut slopes = self.along(&gradient);
        for (slope, ends) in slopes.iter_mut().zip(self.ends) {
            if let Some(ends) = ends {
                let at = |of: &AtRest| measure.static_value(&of.robot, &of.equilibrium, &of.equilibrium.pose);
                *slope = ends.slope(value, at);
            }
        }
        Ok((value, slopes))
    }

    /// Values of all parts of a goal, with their derivatives as differences.
    fn differenced(&self, goal: &DifferencedGoal) -> Result<Vec<(f64, Slopes)>> {
        let parts_of = |of: &AtRest| (goal.values)(&of.robot, &of.equilibrium, &of.rule.clone().unwrap_or_default());
        let parts = parts_of(self.at_rest)?;
        let mut rows: Vec<(f64, Slopes)> = parts.iter().map(|(_, value)| (*value, Vec::new())).collect();
        for ends in self.ends.iter().flatten() {
            let [low, high] = ends.at_rest.each_ref().map(|end| end.as_ref().and_then(|end| parts_of(end).ok()));
            for ((part, value), row) in parts.iter().zip(&mut rows) {
                let at = |parts: &Option<Vec<(GoalPart, f64)>>| {
                    parts.as_ref()?.iter().find(|(other, _)| other == part).map(|(_, value)| *value)
                };
                row.1.push(ends.slope_of([at(&low), at(&high)], *value));
            }
        }
        Ok(rows)
    }
}

/// LinearisedFunction of a result less a limit, over a scale.
fn over(mut row: LinearisedFunction, limit: f64, scale: f64) -> LinearisedFunction {
    row.value = (row.value - limit) / scale;
    row.gradient.iter_mut().for_each(|slope| *slope /= scale);
    row
}

/// Linearisation for the goal of a request. With the goal `platform`, the platform alone vibrates on the static
/// stiffness of its cables.
pub(crate) fn linearisation_of_goal(request: &DesignRequest, model: StaticModel) -> Linearisation {
    let linearisation = at_rest::linearisation(&request.model, model);
    match request.goal {
        DesignGoal::Platform => Linearisation { cable_model: CableModel::static_about(model), ..linearisation },
        _ => linearisation,
    }
}

/// Natural frequency with its derivatives by every value.
struct FrequencySlopes {
    hz: f64,
    slopes: Slopes,
    /// Indices of the two modes whose motions are combined, the lower one first; twice the same for a single mode.
    modes: [usize; 2],
}

/// Natural frequencies with their derivatives. Modes that nearly share a frequency mix within a step: for each pair of
/// them, the sum and the difference of their motions have a row as well, so that the linear problem contains the
/// complete block of derivatives.
fn frequency_slopes(
    vibration: &VibrationGradients<'_>,
    modes: &[Mode],
    along: &dyn Fn(&RobotChange) -> Slopes,
) -> Vec<FrequencySlopes> {
    let mut rows = Vec::with_capacity(modes.len());
    let mut from = 0;
    while from < modes.len() {
        let mut to = from + 1;
        while to < modes.len() && modes[to].frequency_hz < (1.0 + NEAR) * modes[to - 1].frequency_hz {
            to += 1;
        }

        let cluster: Vec<&Mode> = modes[from..to].iter().collect();
        let block: Vec<Vec<Slopes>> =
            vibration.block(&cluster).iter().map(|row| row.iter().map(along).collect()).collect();
        for (i, mode) in cluster.iter().enumerate() {
            rows.push(FrequencySlopes { hz: mode.frequency_hz, slopes: block[i][i].clone(), modes: [from + i; 2] });
            for (j, other) in cluster.iter().enumerate().skip(i + 1) {
                let mean = (0.5 * (mode.frequency_hz.powi(2) + other.frequency_hz.powi(2))).sqrt();
                for sign in [1.0, -1.0] {
                    let both = (0..block[i][i].len())
                        .map(|k| 0.5 * (block[i][i][k] + block[j][j][k]) + sign * block[i][j][k])
                        .collect();
                    rows.push(FrequencySlopes { hz: mean, slopes: both, modes: [from + i, from + j] });
                }
            }
        }
        from = to;
    }
    rows
}

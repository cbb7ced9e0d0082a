//! Results of one pose and their derivatives by the values, as rows of a linear problem.

use super::band::{self, BandCounts};
use crate::analyses::gradient::{held, no_solution};
use crate::at_rest::{self, AtRest};
use crate::measure::Measure;
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
type Slopes = Vec<f64>;

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
    /// Adds the rows of the next pose. `directions` are the changes of the robot per unit of each value. `below` is the
    /// number of frequencies that have to go below the band to avoid; without it each goes to its nearer side.
    ///
    /// # Errors
    /// Results without derivatives, or without modes.
    pub(crate) fn add_pose(
        &mut self,
        request: &DesignRequest,
        at_rest: &AtRest,
        directions: &[RobotChange],
        below: Option<usize>,
    ) -> Result<()> {
        let gradients = held(at_rest, Hold::Rule)?;
        let group = if request.weights.is_some() { self.poses.len() } else { 0 };
        let linearisation = at_rest::linearisation(&request.model, at_rest.equilibrium.model);
        let rows = PoseRows { request, at_rest, gradients: &gradients, linearisation, directions, group };

        let (goal, objectives) = rows.goal()?;
        self.rows_per_pose.push(objectives.len());
        self.evaluation.objectives.extend(objectives);

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
    directions: &'a [RobotChange],
    /// Group of the rows of the goal.
    group: usize,
}

impl PoseRows<'_> {
    /// Derivatives of a result by every value, from its gradient.
    fn along(&self, gradient: &RobotChange) -> Slopes {
        self.directions.iter().map(|direction| gradient.dot(direction)).collect()
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
            goal @ DesignGoal::Measure(_) => {
                let (value, slopes) = self.at_rest(goal.measure())?;
                (value, vec![self.row(value, &slopes, goal.sign())])
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
        Ok((value, self.along(&gradient)))
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

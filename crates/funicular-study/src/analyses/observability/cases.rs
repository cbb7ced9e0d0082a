//! Deviations of the filter at rest with some sensors.

use super::ObservedCase;
use crate::names::SensorSet;
use funicular::estimation::{EstimatedState, EstimationError, EstimationSettings, Estimator, SensorReadings};
use funicular::robot::{Pose, Robot};

/// Lengths at which the platform rests, and its pose.
pub(super) struct RestingPlace {
    pub(super) lengths: Vec<f64>,
    pub(super) pose: Pose,
}

/// Sensors, with a single load cell or a further pose.
pub(super) struct Case {
    pub(super) name: String,
    pub(super) sensors: Vec<SensorSet>,
    pub(super) cell: Option<usize>,
    pub(super) further: Option<RestingPlace>,
}

impl Case {
    pub(super) fn of(name: &str, sensors: &[SensorSet]) -> Self {
        Self { name: name.to_owned(), sensors: sensors.to_vec(), cell: None, further: None }
    }

    fn has_cell(&self, i: usize) -> bool {
        self.cell == Some(i) || self.sensors.contains(&SensorSet::Tensions)
    }

    /// Readings of these sensors out of those of all.
    fn readings(&self, all: &SensorReadings) -> SensorReadings {
        let mut found = SensorReadings { lengths: all.lengths, ..SensorReadings::default() };
        for (i, tension) in found.tensions.iter_mut().enumerate() {
            if self.has_cell(i) {
                *tension = all.tensions[i];
            }
        }
        for sensor in &self.sensors {
            match sensor {
                SensorSet::None | SensorSet::Tensions => {}
                SensorSet::CableAngles => found.angles = all.angles,
                SensorSet::Gyroscope => found.gyroscope = all.gyroscope,
                SensorSet::Accelerometer => found.accelerometer = all.accelerometer,
                SensorSet::Tracker => found.tracker = all.tracker,
            }
        }
        found
    }
}

/// Readings of all sensors at one pose at rest.
struct FullReadings {
    pose: Pose,
    readings: SensorReadings,
}

/// Robot and poses of all cases.
pub(super) struct CasePlan<'a> {
    robot: &'a Robot,
    settings: EstimationSettings,
    poses: Vec<FullReadings>,
}

impl<'a> CasePlan<'a> {
    /// Plan of some poses.
    ///
    /// # Errors
    /// A robot that the filter does not follow, or lengths at which it finds no balance.
    pub(super) fn new(
        robot: &'a Robot,
        settings: EstimationSettings,
        places: Vec<RestingPlace>,
    ) -> Result<Self, EstimationError> {
        let poses = places.into_iter().map(|place| full_readings(robot, settings, &place)).collect::<Result<_, _>>()?;
        Ok(Self { robot, settings, poses })
    }

    pub(super) fn count(&self) -> usize {
        self.poses.len()
    }

    pub(super) fn last_pose(&self) -> Pose {
        self.poses[self.poses.len() - 1].pose
    }

    /// Deviations of a case: each pose is the last one once, with the readings of all others before.
    ///
    /// # Errors
    /// As for [`Self::new`].
    pub(super) fn observe(&self, case: &Case) -> Result<ObservedCase, EstimationError> {
        let further = case.further.as_ref().map(|place| full_readings(self.robot, self.settings, place)).transpose()?;
        let mut worst: Option<ObservedCase> = None;
        for k in 0..self.poses.len() {
            let others = self.poses.iter().enumerate().filter(|(j, _)| *j != k).map(|(_, at)| at);
            let order: Vec<&FullReadings> = further.iter().chain(others).chain([&self.poses[k]]).collect();
            let first = case.readings(&order[0].readings);
            let mut estimator = Estimator::new(self.robot.clone(), self.settings, &first, Some(&order[0].pose))?;
            for at in &order[1..] {
                estimator.rest_anew(&case.readings(&at.readings), Some(&at.pose))?;
            }
            let row = self.row(case, &estimator.state());
            worst = Some(match worst {
                Some(worst) => larger(worst, &row),
                None => row,
            });
        }
        Ok(worst.expect("a plan has poses"))
    }

    fn row(&self, case: &Case, state: &EstimatedState) -> ObservedCase {
        let cables = &state.cables[..self.robot.cables.len()];
        let largest = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, f64::max);
        let biases = cables.iter().enumerate().filter(|(i, _)| case.has_cell(*i)).map(|(_, of)| of.tension_bias.std);
        ObservedCase {
            with: case.name.clone(),
            position_std_m: state.position_std,
            rotation_std_deg: state.rotation_std.map(f64::to_degrees),
            payload_std_kg: state.payload.std,
            first_moment_std_kg_m: state.first_moment.map(|part| part.std),
            force_std_n: state.force.map(|part| part.std),
            moment_std_n_m: state.moment.map(|part| part.std),
            offset_std_m: largest(&mut cables.iter().map(|of| of.offset.std)),
            tension_bias_std_n: biases.reduce(f64::max),
            tension_std_n: largest(&mut cables.iter().map(|of| of.tension.std)),
        }
    }
}

/// Readings of all sensors at a place, as the filter expects them.
fn full_readings(
    robot: &Robot,
    settings: EstimationSettings,
    place: &RestingPlace,
) -> Result<FullReadings, EstimationError> {
    let mut lengths = SensorReadings::default();
    lengths.lengths.iter_mut().zip(&place.lengths).for_each(|(to, length)| *to = *length);
    let mut estimator = Estimator::new(robot.clone(), settings, &lengths, Some(&place.pose))?;
    Ok(FullReadings { pose: estimator.state().pose, readings: estimator.expected_at_rest() })
}

/// Larger of the deviations of two poses.
fn larger(a: ObservedCase, b: &ObservedCase) -> ObservedCase {
    let three = |a: [f64; 3], b: [f64; 3]| [0, 1, 2].map(|k| a[k].max(b[k]));
    ObservedCase {
        with: a.with,
        position_std_m: three(a.position_std_m, b.position_std_m),
        rotation_std_deg: three(a.rotation_std_deg, b.rotation_std_deg),
        payload_std_kg: a.payload_std_kg.max(b.payload_std_kg),
        first_moment_std_kg_m: three(a.first_moment_std_kg_m, b.first_moment_std_kg_m),
        force_std_n: three(a.force_std_n, b.force_std_n),
        moment_std_n_m: three(a.moment_std_n_m, b.moment_std_n_m),
        offset_std_m: a.offset_std_m.max(b.offset_std_m),
        tension_bias_std_n: a.tension_bias_std_n.into_iter().chain(b.tension_bias_std_n).reduce(f64::max),
        tension_std_n: a.tension_std_n.max(b.tension_std_n),
    }
}

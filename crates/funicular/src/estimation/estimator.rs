//! Estimator of a control loop or a log: filter, tests and monitors.

use super::consistency::{Consistency, chi2_quantile, normal_quantile};
use super::faults::{FaultAlarm, FaultHypothesis, FaultKind, FaultTests, FaultVerdict, explain};
use super::kalman::Kalman;
use super::model::EstimatedRobot;
use super::payload_mean::PayloadWindow;
use super::readings::{SensorGroup, SensorReadings};
use super::rows::MAX_ROWS;
use super::settings::EstimationSettings;
use super::start::{EstimationError, MAX_STEP, balanced, check, prior, rest_pose, tie_pose, wrench_prior};
use super::state::{Estimate, EstimatedCable, EstimatedState, Slackness, StateMean, StatePlaces};
use crate::control_loop::MAX_CABLES;
use crate::math::{Vec3, Vec6};
use crate::robot::{Pose, Robot};

/// Speed of a vibration above which the platform rings [m/s]: 4 % of the frequency of a mode of 5 Hz and 110 kg are a
/// force of half the deviation of the external wrench then.
const RINGING: f64 = 5e-3;

/// Times of the filter that separates vibration from motion, and of the memory of the vibration [s].
const SMOOTHING: f64 = 0.05;
const MEMORY: f64 = 0.25;

/// Deviation of tensions [N] and factor on the white force while the platform rings: with them poses and offsets of
/// simulated robots have their stated deviations.
const RINGING_TENSION: f64 = 7.4;
const RINGING_FORCE: f64 = 30.0;

/// Size of the test of the payload, 1e-6 per sample at rest, and while something rings.
const PAYLOAD_TEST: f64 = 23.9;
const PAYLOAD_TEST_RINGING: f64 = 100.0;

/// Deviations with which payload [kg] and first moment [kg m] are unknown again.
const NEW_PAYLOAD: [f64; 2] = [20.0, 2.0];

/// Deviations with which a length that slipped [m] and the error of a load cell that stepped [N] are unknown again.
const NEW_OFFSET: f64 = 5e-3;
const NEW_BIAS: f64 = 200.0;

/// Time between two values of the payload from means, and least time between alarms [s].
const PAYLOAD_PERIOD: f64 = 0.1;
const QUIET_AFTER_ALARM: f64 = 0.5;

/// Time over which the innovations decide whether deviations are told [s], and their probability.
const TRUST_TIME: f64 = 0.5;
const TRUST: f64 = 1e-6;

/// Time that the readings behind an alarm are kept [s], and their largest number.
const KEPT_TIME: f64 = 0.05;
const KEPT_ROWS: usize = 256;

/// Time after an alarm at which its explanation is best [s]: the platform has moved, and the rows before the fault are
/// still kept.
const EXPLAINED_AFTER: f64 = 0.05;

/// Rounds of Gauss and Newton's method at rest; the third changes tensions by less than a tenth of a newton.
const ROUNDS: usize = 3;

/// Time within which the test of the payload decides about an alarm that no cable alone explains [s]: it takes 40 to
/// 70 ms.
const PAYLOAD_DELAY: f64 = 0.1;

/// False alarms of all tests of the load cells per hour.
const FALSE_ALARMS: f64 = 0.1;

/// Notes about one update.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct UpdateNotes {
    /// Alarm of a test.
    pub alarm: Option<FaultAlarm>,
    /// Readings left out as outliers.
    pub gated: usize,
    /// False if the innovations of the last half second are larger than the stated deviations allow: values without
    /// deviations.
    pub is_trusted: bool,
}

/// Filter and readings from which the explanation of an alarm begins.
#[derive(Debug, Clone)]
struct KeptRows {
    older: Kalman,
    newer: Kalman,
    /// Readings since `older` and steps before them; the first `middle` lie before `newer`.
    rows: Vec<(SensorReadings, f64)>,
    middle: usize,
    /// Time since `newer` [s].
    time: f64,
}

impl KeptRows {
    /// Begins with a filter that has no readings behind it.
    fn begin(&mut self, kalman: &Kalman) {
        self.older.copy_from(kalman);
        self.newer.copy_from(kalman);
        self.rows.clear();
        (self.middle, self.time) = (0, 0.0);
    }
}

/// Sums and times that an update changes before it can fail.
#[derive(Debug, Clone, Copy)]
struct UpdateSums {
    time: f64,
    since: [f64; 2],
    recent: [f64; 2],
    consistency: [Consistency; 5],
    relative: [f64; MAX_ROWS],
}

/// Estimator of the state of a robot. It reserves memory at its start; [`Self::update`] reserves none.
#[derive(Debug, Clone)]
pub struct Estimator {
    kalman: Kalman,
    /// Filter before a change that may fail.
    spare: Box<Kalman>,
    time: f64,
    tests: FaultTests,
    consistency: [Consistency; 5],
    relative: [f64; MAX_ROWS],
    /// Smoothed velocities and rates, and the speed of the vibration [m/s].
    smooth_twist: Vec6,
    smooth_rates: [f64; MAX_CABLES],
    vibration: f64,
    window: Option<PayloadWindow>,
    since_mean: f64,
    since_alarm: f64,
    since_payload: f64,
    /// Age of an alarm that no cable alone explains, with its size; innovations of the load cells at the last alarm.
    common: Option<(f64, f64)>,
    suspects: [f64; MAX_ROWS],
    /// Cable that alone explains the last alarm of the load cells.
    alarmed: Option<usize>,
    /// Sums that forget: squared innovations and degrees of freedom, and samples.
    recent: [f64; 2],
    kept: Option<Box<KeptRows>>,
}

impl Estimator {
    /// Estimator that starts at rest from the lengths of all cables at one time; the other readings of that time are
    /// taken in, too. `near` is a pose in whose neighbourhood the platform is.
    ///
    /// # Errors
    /// A robot that it cannot follow, a length that is missing, or lengths at which the platform finds no balance.
    pub fn new(
        robot: Robot,
        settings: EstimationSettings,
        readings: &SensorReadings,
        near: Option<&Pose>,
    ) -> Result<Self, EstimationError> {
        check(&robot)?;
        let of = EstimatedRobot::new(robot);
        let lengths = all_lengths(&of, readings)?;
        let places = StatePlaces { cables: of.cables() };
        let mut mean = StateMean::new(Pose::new([0.0; 3], [0.0; 3]), settings.priors.payload[0]);
        let (pose, at) = rest_pose(&of, &lengths[..of.cables()], &mean.load, near)?;
        mean.pose = pose;
        let mut kalman = Kalman::new(of, settings, &mean, at, lengths);
        prior(&mut kalman.covariance, places, &settings.priors, settings.noise.length);
        let mut estimator = Self {
            spare: Box::new(kalman.clone()),
            kalman,
            time: 0.0,
            tests: FaultTests::new(FALSE_ALARMS),
            consistency: [Consistency::default(); 5],
            relative: [f64::NAN; MAX_ROWS],
            smooth_twist: Vec6::zeros(),
            smooth_rates: [0.0; MAX_CABLES],
            vibration: 0.0,
            window: None,
            since_mean: 0.0,
            since_alarm: f64::INFINITY,
            since_payload: f64::INFINITY,
            common: None,
            suspects: [f64::NAN; MAX_ROWS],
            alarmed: None,
            recent: [0.0; 2],
            kept: None,
        };
        estimator.take_at_rest(readings)?;
        let rows = Vec::with_capacity(KEPT_ROWS);
        let (older, newer) = (estimator.kalman.clone(), estimator.kalman.clone());
        estimator.kept = Some(Box::new(KeptRows { older, newer, rows, middle: 0, time: 0.0 }));
        Ok(estimator)
    }

    /// False alarms per hour that the tests of the load cells may give; 0.1 unless it is set.
    pub fn set_false_alarms_per_hour(&mut self, rate: f64) {
        self.tests.rate = rate;
    }

    /// Begins anew with what was known before the first reading, as [`Self::new`] does. It reserves memory; after an
    /// error the estimator is as it was.
    ///
    /// # Errors
    /// As for [`Self::new`].
    pub fn reset(&mut self, readings: &SensorReadings, near: Option<&Pose>) -> Result<(), EstimationError> {
        let rate = self.tests.rate;
        *self = Self::new(self.kalman.of.robot.clone(), self.kalman.settings, readings, near)?;
        self.tests.rate = rate;
        Ok(())
    }

    /// Begins a further pose at rest, with the payload, offsets and biases that are known: the next of many poses whose
    /// readings one fit shares. The external wrench is as unknown as at the start. It reserves memory; after an error
    /// the estimator is as it was.
    ///
    /// # Errors
    /// As for [`Self::new`].
    pub fn rest_anew(&mut self, readings: &SensorReadings, near: Option<&Pose>) -> Result<(), EstimationError> {
        self.spare.copy_from(&self.kalman);
        let sums = self.sums();
        if let Err(error) = self.rest_at(readings, near) {
            self.take_back(&sums);
            return Err(error);
        }

        // Readings before the rest explain nothing after it.
        if let Some(kept) = &mut self.kept {
            kept.begin(&self.kalman);
        }
        self.tests.reset();
        (self.window, self.common) = (None, None);
        (self.smooth_twist, self.smooth_rates, self.vibration) = (Vec6::zeros(), [0.0; MAX_CABLES], 0.0);
        self.hold_payload();
        Ok(())
    }

    fn rest_at(&mut self, readings: &SensorReadings, near: Option<&Pose>) -> Result<(), EstimationError> {
        let lengths = all_lengths(&self.kalman.of, readings)?;
        let kalman = &mut self.kalman;
        kalman.readings = lengths;
        kalman.mean.load.wrench = Vec6::zeros();
        kalman.mean.twist = Vec6::zeros();
        kalman.mean.encoder_errors = [0.0; MAX_CABLES];
        wrench_prior(&mut kalman.covariance, &kalman.settings.priors);
        for i in 0..kalman.places.cables {
            kalman.covariance.reopen(kalman.places.encoder_errors() + i, kalman.settings.noise.length.powi(2));
        }
        let all = kalman.lengths();
        let (pose, at) = rest_pose(&kalman.of, &all[..kalman.places.cables], &kalman.mean.load, near)?;
        (kalman.mean.pose, kalman.at) = (pose, at);
        self.take_at_rest(readings)
    }

    /// Ties the pose to what is known, and takes the readings of a platform at rest.
    fn take_at_rest(&mut self, readings: &SensorReadings) -> Result<(), EstimationError> {
        let kalman = &mut self.kalman;
        let priors = kalman.settings.priors;
        kalman.rates = [0.0; MAX_CABLES];
        kalman.silent = [0.0; MAX_CABLES];
        (kalman.acceleration, kalman.largest_acceleration) = (Vec6::zeros(), 0.0);
        let (known, before) = (kalman.covariance.clone(), kalman.mean);

        // Offsets of a millimetre are a quarter of the tension, so that tangents change: Gauss and Newton's method.
        for round in 1..=ROUNDS {
            let kalman = &mut self.kalman;
            kalman.covariance.copy_from(&known);
            let all = kalman.lengths();
            let load = kalman.mean.load;
            let (pose, at) = balanced(&kalman.of, &all[..kalman.places.cables], &load, kalman.mean.pose)
                .ok_or(EstimationError::NoBalance)?;
            (kalman.mean.pose, kalman.at, kalman.mean.twist) = (pose, at, Vec6::zeros());
            let motion = tie_pose(&mut kalman.covariance, kalman.places, &kalman.of, &kalman.at, &pose, &priors)
                .ok_or(EstimationError::NoBalance)?;
            kalman.begin_from(&before, &motion);
            self.take_groups(readings, round == ROUNDS)?;
        }
        Ok(())
    }

    /// Updates by all groups of one time.
    fn measure(&mut self, readings: &SensorReadings) -> Result<usize, EstimationError> {
        self.kalman.begin();
        self.relative = [f64::NAN; MAX_ROWS];
        self.take_groups(readings, true)
    }

    /// Takes the readings of all groups, and counts them if they are new. Returns the number of outliers.
    fn take_groups(&mut self, readings: &SensorReadings, are_new: bool) -> Result<usize, EstimationError> {
        let mut gated = 0;
        for group in SensorGroup::ALL {
            if let Some(result) = self.kalman.measure(group, readings).filter(|_| are_new) {
                self.consistency[group.index()].add(&result);
                gated += result.gated;
                if group == SensorGroup::Tensions {
                    self.relative = result.relative;
                }
                if group != SensorGroup::Accelerometer {
                    self.recent[0] += result.nis;
                    self.recent[1] += result.count as f64;
                }
            }
        }
        self.kalman.finish()?;
        Ok(gated)
    }

    /// Moves the estimate by a time step [s] and takes the readings at its end. Lengths are read every time; a length
    /// or another reading that is missing is NaN. It reserves no memory; after an error the estimator is as it was.
    ///
    /// # Errors
    /// A step or lengths that cannot be used, or a state that has left every number behind: the estimator has to be
    /// started anew.
    pub fn update(&mut self, readings: &SensorReadings, step: f64) -> Result<UpdateNotes, EstimationError> {
        if !(step > 0.0 && step <= MAX_STEP) {
            return Err(EstimationError::BadStep { step });
        }
        self.spare.copy_from(&self.kalman);
        let (sums, is_kept) = (self.sums(), self.keep(readings, step));
        let gated = match self.advance(readings, step) {
            Ok(gated) => gated,
            Err(error) => {
                self.take_back(&sums);
                if let Some(kept) = self.kept.as_mut().filter(|_| is_kept) {
                    kept.rows.pop();
                }
                return Err(error);
            }
        };
        self.watch_vibration(step);

        let mut notes = UpdateNotes { alarm: None, gated, is_trusted: self.is_trusted() };
        let payload = self.follow_payload(readings, step);
        let stuck = self.tests.stuck(readings, &self.kalman);
        let cable = self.test_cables(step);
        let alarm = |cable, kind, size| Some(FaultAlarm { time: self.time, cable, kind, size });
        notes.alarm = if let Some(size) = payload {
            alarm(None, Some(FaultKind::Payload), size)
        } else if let Some(i) = stuck {
            alarm(Some(i), Some(FaultKind::Stuck), 1.0)
        } else {
            cable.and_then(|(i, size)| alarm(i, None, size))
        };
        if notes.alarm.is_some() {
            self.since_alarm = 0.0;
        }
        Ok(notes)
    }

    /// Moves the filter and takes the readings. Returns the number of outliers.
    fn advance(&mut self, readings: &SensorReadings, step: f64) -> Result<usize, EstimationError> {
        self.time += step;
        self.since_alarm += step;
        self.since_payload += step;
        self.kalman.predict(&readings.lengths, step)?;
        let forget = (-step / TRUST_TIME).exp();
        self.recent = self.recent.map(|sum| sum * forget);
        self.measure(readings)
    }

    fn sums(&self) -> UpdateSums {
        UpdateSums {
            time: self.time,
            since: [self.since_alarm, self.since_payload],
            recent: self.recent,
            consistency: self.consistency,
            relative: self.relative,
        }
    }

    /// Takes back a change that failed.
    fn take_back(&mut self, sums: &UpdateSums) {
        self.kalman.copy_from(&self.spare);
        [self.since_alarm, self.since_payload] = sums.since;
        (self.time, self.recent) = (sums.time, sums.recent);
        (self.consistency, self.relative) = (sums.consistency, sums.relative);
    }

    /// True if the innovations of the last half second fit the stated deviations.
    fn is_trusted(&self) -> bool {
        let [nis, count] = self.recent;
        nis <= chi2_quantile(1.0 - TRUST, count.max(1.0))
    }

    /// Keeps readings and states of the last 50 to 100 ms. Returns true if there was room.
    fn keep(&mut self, readings: &SensorReadings, step: f64) -> bool {
        let Some(kept) = &mut self.kept else { return false };
        kept.time += step;
        // The beginning of an alarm that waits for its explanation stays.
        let waits = self.common.is_some() || self.since_alarm < EXPLAINED_AFTER;
        let is_due = !waits && kept.time >= KEPT_TIME;
        if is_due || kept.rows.len() == KEPT_ROWS {
            std::mem::swap(&mut kept.older, &mut kept.newer);
            kept.newer.copy_from(&self.kalman);
            kept.rows.drain(..kept.middle);
            kept.middle = kept.rows.len();
            kept.time = 0.0;
        }
        let has_room = kept.rows.len() < KEPT_ROWS;
        if has_room {
            kept.rows.push((*readings, step));
        }
        has_room
    }

    /// Explanations of the last alarm by the readings since 50 to 100 ms before it; best 50 ms after it, when the
    /// platform has moved. It reserves memory and takes many times as long as an update: call it on a copy, outside the
    /// control loop.
    pub fn explain(&self) -> Option<FaultVerdict> {
        let kept = self.kept.as_ref()?;
        let rows = kept.rows.iter().map(|(readings, step)| (readings, *step));
        Some(explain(&kept.older, &rows, &self.suspects, self.alarmed))
    }

    /// Separates vibration from commanded motion.
    fn watch_vibration(&mut self, step: f64) {
        let part = 1.0 - (-step / SMOOTHING).exp();
        let kalman = &mut self.kalman;
        self.smooth_twist += (kalman.mean.twist - self.smooth_twist) * part;
        let mut pull = Vec6::zeros();
        for i in 0..kalman.places.cables {
            self.smooth_rates[i] += (kalman.rates[i] - self.smooth_rates[i]) * part;
            pull += kalman.at.wrench_by_length(i) * self.smooth_rates[i];
        }
        let commanded = kalman.at.stiffness.lu().solve(&kalman.of.allowed(&pull)).unwrap_or_default();
        let rest = self.smooth_twist - commanded;
        let turn = rest.fixed_rows::<3>(3).norm() * kalman.of.coordinates.ell();
        let speed = rest.fixed_rows::<3>(0).norm().max(turn);
        self.vibration = speed.max(self.vibration * (-step / MEMORY).exp());
        self.hold_payload();
    }

    /// Lets the filter consider the payload, and trust tensions less, while the platform rings.
    fn hold_payload(&mut self) {
        let rings = self.rings();
        self.kalman.holds_payload = rings;
        self.kalman.force_factor = if rings { RINGING_FORCE } else { 1.0 };
        self.kalman.rope_tension = if rings { RINGING_TENSION } else { 0.0 };
    }

    /// True while the platform vibrates.
    pub fn rings(&self) -> bool {
        let is_new = self.window.is_some() && self.since_payload < QUIET_AFTER_ALARM;
        is_new || self.vibration > RINGING
    }

    /// Test of the payload, and its value from means while the platform rings. Returns the size of the test over its
    /// limit at an alarm.
    fn follow_payload(&mut self, readings: &SensorReadings, step: f64) -> Option<f64> {
        let rings = self.rings();
        if let Some(window) = &mut self.window {
            window.add(&self.kalman, readings, step);
            self.since_mean += step;
            if rings && self.since_mean >= PAYLOAD_PERIOD {
                self.since_mean = 0.0;
                self.spare.copy_from(&self.kalman);
                if window.apply(&mut self.kalman, self.vibration) && self.kalman.refresh().is_err() {
                    self.kalman.copy_from(&self.spare);
                }
            }
            if !rings {
                self.window = None;
            }
        }

        // The external force along gravity against its prior.
        let gravity = self.kalman.of.robot.gravity_w;
        let prior = self.kalman.settings.priors.force.powi(2);
        if gravity == Vec3::zeros() || self.since_payload < QUIET_AFTER_ALARM || prior == 0.0 {
            return None;
        }
        let along = gravity.normalize();
        let force = (0..3).map(|k| along[k] * self.kalman.mean.load.wrench[k]).sum::<f64>();
        let mut known = 0.0;
        for (a, b) in (0..9).map(|k| (k / 3, k % 3)) {
            known += along[a] * along[b] * self.kalman.covariance.at(StatePlaces::WRENCH + a, StatePlaces::WRENCH + b);
        }
        let limit = if rings { PAYLOAD_TEST_RINGING } else { PAYLOAD_TEST };
        let size = force * force / (prior - known).max(1e-3 * prior) / limit;
        if size < 1.0 {
            return None;
        }
        self.kalman.reopen_payload(NEW_PAYLOAD[0], NEW_PAYLOAD[1]);
        self.window = Some(PayloadWindow::new(&self.kalman));
        self.since_mean = 0.0;
        self.since_payload = 0.0;
        self.hold_payload();
        Some(size)
    }

    /// Tests of the load cells; they rest while the platform rings, because its vibration is no white noise. Returns
    /// the cable, or none if no cable alone has raised an alarm, and the size over the limit.
    fn test_cables(&mut self, step: f64) -> Option<(Option<usize>, f64)> {
        if self.rings() || self.since_alarm < QUIET_AFTER_ALARM {
            self.tests.reset();
            self.common = None;
            return None;
        }
        if let Some((age, size)) = &mut self.common {
            *age += step;
            if *age < PAYLOAD_DELAY {
                return None;
            }
            let size = *size;
            self.common = None;
            return Some((None, size));
        }
        let cables = self.kalman.places.cables;
        let found = self.tests.innovations(&self.relative[..cables], &self.kalman.tension_factor, step)?;
        self.suspects = self.relative;
        self.alarmed = Some(found.cable).filter(|_| found.is_own);
        if found.is_own {
            return Some((Some(found.cable), found.size));
        }
        self.common = Some((0.0, found.size));
        None
    }

    /// Takes a length that slipped: the offset of a cable is unknown again, with this deviation [m].
    pub fn reopen_offset(&mut self, cable: usize, std: f64) {
        if cable < self.kalman.places.cables {
            self.kalman.covariance.reopen(StatePlaces::OFFSETS + cable, std * std);
        }
    }

    /// Takes a step of a load cell: the constant error of its readings is unknown again, with this deviation [N].
    pub fn reopen_tension_bias(&mut self, cable: usize, std: f64) {
        if cable < self.kalman.places.cables {
            self.kalman.covariance.reopen(self.kalman.places.tension_biases() + cable, std * std);
        }
    }

    /// Takes a fault: the number that changed is unknown again, because the filter would go on with a wrong one.
    pub fn take_fault(&mut self, of: &FaultHypothesis) {
        match (of.kind, of.cable) {
            (FaultKind::Slip | FaultKind::Cut, Some(i)) => self.reopen_offset(i, NEW_OFFSET),
            (FaultKind::LoadCell, Some(i)) => self.reopen_tension_bias(i, NEW_BIAS),
            _ => {}
        }
    }

    /// Readings that all sensors would have at the present state, without noise, if the platform rests.
    pub fn expected_at_rest(&self) -> SensorReadings {
        let Kalman { of, mean, at, settings, readings, .. } = &self.kalman;
        let to_platform = mean.pose.rot_wp.inverse();
        let mut expected = SensorReadings { lengths: *readings, ..SensorReadings::default() };
        for (i, cable) in at.cables.iter().enumerate() {
            let leaving = &cable.leaving;
            expected.tensions[i] = cable.tension + mean.tension_biases[i];
            expected.angles[i] = [leaving.y.atan2(leaving.x), leaving.z.atan2(leaving.x.hypot(leaving.y))];
        }
        expected.gyroscope = mean.gyroscope_bias.into();
        expected.accelerometer = (to_platform * -of.robot.gravity_w + mean.accelerometer_bias).into();
        expected.tracker = mean.pose.point_w(&settings.tracked_point_p).into();
        expected
    }

    /// Number of cables.
    pub fn cables(&self) -> usize {
        self.kalman.places.cables
    }

    /// Time since the start [s].
    pub fn time(&self) -> f64 {
        self.time
    }

    /// Statistics of a group of sensors.
    pub fn consistency(&self, group: SensorGroup) -> &Consistency {
        &self.consistency[group.index()]
    }

    /// Innovations of the load cells at the last time over their deviations.
    pub fn relative_innovations(&self) -> &[f64] {
        &self.relative[..self.kalman.places.cables]
    }

    /// Deviation and correlation of the innovations of the load cells at quiet times; the tests for faults rest if the
    /// correlation is above 0.3.
    pub fn whiteness(&self) -> [f64; 2] {
        [self.tests.deviation(), self.tests.correlation()]
    }

    /// State at the last time. It needs memory of the filter for intermediate results, but reserves none.
    pub fn state(&mut self) -> EstimatedState {
        let rings = self.rings();
        let kalman = &mut self.kalman;
        let (mean, places) = (kalman.mean, kalman.places);
        let covariance = &kalman.covariance;
        let std = |place: usize| covariance.variance(place).sqrt();
        let three =
            |values: Vec3, first: usize| std::array::from_fn(|k| Estimate { value: values[k], std: std(first + k) });
        let upper = |of: &Vec6| Vec3::new(of[0], of[1], of[2]);
        let lower = |of: &Vec6| Vec3::new(of[3], of[4], of[5]);
        let mut state = EstimatedState {
            pose: mean.pose,
            position_std: std::array::from_fn(|k| std(StatePlaces::POSITION + k)),
            rotation_std: std::array::from_fn(|k| std(StatePlaces::TURN + k)),
            velocity: three(upper(&mean.twist), StatePlaces::VELOCITY),
            angular_velocity: three(lower(&mean.twist), StatePlaces::ANGULAR_VELOCITY),
            force: three(upper(&mean.load.wrench), StatePlaces::WRENCH),
            moment: three(lower(&mean.load.wrench), StatePlaces::WRENCH + 3),
            payload: Estimate { value: mean.load.mass, std: std(StatePlaces::PAYLOAD) },
            first_moment: three(mean.load.moment_p, StatePlaces::FIRST_MOMENT),
            accelerometer_bias: three(mean.accelerometer_bias, places.accelerometer_bias()),
            gyroscope_bias: three(mean.gyroscope_bias, places.gyroscope_bias()),
            cables: [EstimatedCable::default(); MAX_CABLES],
            rings,
        };
        for (i, cable) in state.cables.iter_mut().enumerate().take(places.cables) {
            cable.offset = Estimate { value: mean.offsets[i], std: std(StatePlaces::OFFSETS + i) };
            cable.tension_bias = Estimate { value: mean.tension_biases[i], std: std(places.tension_biases() + i) };
        }
        let slack = normal_quantile(0.95);
        for (i, cable) in state.cables.iter_mut().enumerate().take(places.cables) {
            cable.tension = kalman.tension(i);
            let minimum = kalman.of.robot.cables[i].limits().minimum.unwrap_or(0.0);
            let limit = minimum.max(kalman.at.cables[i].half_weight);
            let distance = (cable.tension.value - limit) / cable.tension.std.max(1e-9);
            cable.slackness = if distance > slack {
                Slackness::Taut
            } else if distance < -slack {
                Slackness::Slack
            } else {
                Slackness::Unknown
            };
        }
        state
    }
}

/// Lengths of all cables at one time.
fn all_lengths(of: &EstimatedRobot, readings: &SensorReadings) -> Result<[f64; MAX_CABLES], EstimationError> {
    let missing = of.robot.cables.iter().zip(&readings.lengths).find(|(_, length)| !length.is_finite());
    match missing {
        Some((cable, _)) => Err(EstimationError::NoLength { cable: cable.name.clone() }),
        None => Ok(readings.lengths),
    }
}

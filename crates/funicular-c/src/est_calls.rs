//! Exported functions of the estimator. Updates reserve no memory.

use crate::border::{Checked, check, check_wanted, read_array, read_struct, write_array, write_struct};
use crate::est_layout::{EstFault, EstReadings, EstResult, EstSettings};
use crate::owned::{MessageRoom, Owned, OwnedKind, Told, pose_at, read, robot_of_bytes, silent};
use crate::status::{BAD_INPUT, BAD_STRUCT, CERTIFIED, LOST, NO_REST, NOT_FOR_LOOP, REFUSED};
use funicular::control_loop::MAX_CABLES;
use funicular::estimation::{
    Estimate, EstimatedCable, EstimatedState, EstimationError, EstimationSettings, Estimator, FaultAlarm,
    FaultHypothesis, FaultKind, ProcessNoise, SensorNoise, SensorReadings, Slackness, StatePriors, UpdateNotes,
};
use funicular::math::{Vec3, rotation};
use std::borrow::Cow;
use std::ffi::c_char;
use std::mem;

/// Largest number of an input.
const MAX_INPUT: f64 = 1e9;

/// Alarm of the load cells that is not explained yet.
const UNEXPLAINED: i32 = 7;

/// `fn_est`: estimator of a robot.
pub type Est = Owned<EstState>;

/// Estimator with the notes of its last update.
pub struct EstState {
    estimator: Estimator,
    notes: UpdateNotes,
}

impl OwnedKind for EstState {
    const KIND: u64 = 0x666e_5f65_7374_696d;
}

/// Notes of an estimator that begins.
const BEGUN: UpdateNotes = UpdateNotes { alarm: None, gated: 0, is_trusted: true };

fn status_of(error: &EstimationError) -> i32 {
    match error {
        EstimationError::TooManyCables { .. }
        | EstimationError::Supports { .. }
        | EstimationError::RopeOverSheaves { .. } => NOT_FOR_LOOP,
        EstimationError::NoStart(_) | EstimationError::NoBalance => NO_REST,
        EstimationError::NoLength { .. } | EstimationError::BadStep { .. } => REFUSED,
        EstimationError::EncodersLost { .. } | EstimationError::Diverged => LOST,
    }
}

fn told(error: &EstimationError) -> (i32, Cow<'static, str>) {
    (status_of(error), Cow::Owned(error.to_string()))
}

fn number_of(kind: FaultKind) -> i32 {
    match kind {
        FaultKind::Slip => 1,
        FaultKind::LoadCell => 2,
        FaultKind::Payload => 3,
        FaultKind::Wrench => 4,
        FaultKind::Cut => 5,
        FaultKind::Stuck => 6,
    }
}

fn kind_of(number: i32) -> Option<FaultKind> {
    use FaultKind::{Cut, LoadCell, Payload, Slip, Stuck, Wrench};
    [Slip, LoadCell, Payload, Wrench, Cut, Stuck].into_iter().find(|kind| number_of(*kind) == number)
}

fn cable_number(cable: Option<usize>) -> i32 {
    cable.map_or(-1, |cable| cable as i32)
}

/// Number that may be an input.
fn usable(value: f64) -> bool {
    value.is_finite() && value.abs() <= MAX_INPUT
}

impl EstSettings {
    fn usual() -> Self {
        let EstimationSettings { noise, priors, process, .. } = EstimationSettings::default();
        Self {
            struct_size: mem::size_of::<Self>() as u32,
            reserved: 0,
            length_std_m: noise.length,
            tension_std_n: noise.tension,
            cable_angle_std_rad: noise.angle,
            gyroscope_std_rad_s: noise.gyroscope,
            accelerometer_std_m_s2: noise.accelerometer,
            tracker_std_m: noise.tracker,
            payload_kg: priors.payload[0],
            payload_std_kg: priors.payload[1],
            first_moment_std_kg_m: priors.first_moment,
            force_std_n: priors.force,
            moment_std_n_m: priors.moment,
            force_time_s: process.wrench_time,
            offset_std_m: priors.offset,
            tension_bias_std_n: priors.tension_bias,
            friction: process.friction,
            false_alarms_per_hour: 0.1,
            inertial_unit_m: [0.0; 3],
            tracked_point_m: [0.0; 3],
        }
    }

    /// Settings of the core, if all numbers can be used.
    fn checked(&self) -> Told<EstimationSettings> {
        let positive = [
            ("length_std_m", self.length_std_m),
            ("tension_std_n", self.tension_std_n),
            ("cable_angle_std_rad", self.cable_angle_std_rad),
            ("gyroscope_std_rad_s", self.gyroscope_std_rad_s),
            ("accelerometer_std_m_s2", self.accelerometer_std_m_s2),
            ("tracker_std_m", self.tracker_std_m),
            ("force_time_s", self.force_time_s),
            ("false_alarms_per_hour", self.false_alarms_per_hour),
        ];
        let others = [
            ("payload_kg", self.payload_kg),
            ("payload_std_kg", self.payload_std_kg),
            ("first_moment_std_kg_m", self.first_moment_std_kg_m),
            ("force_std_n", self.force_std_n),
            ("moment_std_n_m", self.moment_std_n_m),
            ("offset_std_m", self.offset_std_m),
            ("tension_bias_std_n", self.tension_bias_std_n),
            ("friction", self.friction),
        ];
        let refused = |name: &str, value: f64, rule: &str| {
            Err((REFUSED, Cow::Owned(format!("{name} is {value}: it has to be a number {rule}"))))
        };
        if let Some((name, value)) = positive.into_iter().find(|(_, value)| !(usable(*value) && *value > 0.0)) {
            return refused(name, value, "above zero");
        }
        if let Some((name, value)) = others.into_iter().find(|(_, value)| !(usable(*value) && *value >= 0.0)) {
            return refused(name, value, "not below zero");
        }
        if !self.inertial_unit_m.iter().chain(&self.tracked_point_m).all(|value| usable(*value)) {
            return Err(silent(BAD_INPUT));
        }
        Ok(EstimationSettings {
            noise: SensorNoise {
                length: self.length_std_m,
                tension: self.tension_std_n,
                angle: self.cable_angle_std_rad,
                gyroscope: self.gyroscope_std_rad_s,
                accelerometer: self.accelerometer_std_m_s2,
                tracker: self.tracker_std_m,
            },
            priors: StatePriors {
                payload: [self.payload_kg, self.payload_std_kg],
                first_moment: self.first_moment_std_kg_m,
                force: self.force_std_n,
                moment: self.moment_std_n_m,
                offset: self.offset_std_m,
                tension_bias: self.tension_bias_std_n,
                ..StatePriors::default()
            },
            process: ProcessNoise {
                wrench_time: self.force_time_s,
                friction: self.friction,
                ..ProcessNoise::default()
            },
            inertial_unit_p: Vec3::from(self.inertial_unit_m),
            tracked_point_p: Vec3::from(self.tracked_point_m),
        })
    }
}

/// Readings of the caller.
///
/// # Safety
/// If not null, the struct is there with its size, and its arrays with their numbers.
unsafe fn readings_at(from: *const EstReadings, cables: usize) -> Checked<SensorReadings> {
    // SAFETY: promised by the caller.
    let of = unsafe { read_struct(from) }?;
    if (of.cables as usize) < cables {
        return Err(BAD_STRUCT);
    }
    let row = |from: *const f64, count: usize, missing: u32, least: f64| -> Checked<[f64; MAX_CABLES]> {
        let mut found = [f64::NAN; MAX_CABLES];
        if from.is_null() {
            return Ok(found);
        }
        // SAFETY: promised by the caller.
        let values = unsafe { read_array(from, count) }?;
        for (i, (found, value)) in found.iter_mut().zip(values).enumerate().take(count) {
            if missing & (1 << i) == 0 {
                if !(usable(value) && value > least) {
                    return Err(BAD_INPUT);
                }
                *found = value;
            }
        }
        Ok(found)
    };
    let any = f64::NEG_INFINITY;
    let lengths = row(of.length_m, cables, of.length_missing, 0.0)?;
    let tensions = row(of.tension_n, cables, of.tension_missing, any)?;
    let azimuths = row(of.azimuth_rad, cables, of.azimuth_missing, any)?;
    let elevations = row(of.elevation_rad, cables, of.elevation_missing, any)?;
    let three = |from: *const f64, missing: u32| row(from, 3, missing, any).map(|found| [found[0], found[1], found[2]]);
    Ok(SensorReadings {
        lengths,
        tensions,
        angles: std::array::from_fn(|i| [azimuths[i], elevations[i]]),
        gyroscope: three(of.gyroscope_rad_s, of.gyroscope_missing)?,
        accelerometer: three(of.accelerometer_m_s2, of.accelerometer_missing)?,
        tracker: three(of.tracker_m, of.tracker_missing)?,
    })
}

impl EstResult {
    fn arrays(&self) -> [*mut f64; 7] {
        [
            self.tension_n,
            self.tension_std_n,
            self.offset_m,
            self.offset_std_m,
            self.tension_bias_n,
            self.tension_bias_std_n,
            self.slack,
        ]
    }

    /// Result of the caller, if it can be written.
    ///
    /// # Safety
    /// If not null, the struct is there with its size.
    unsafe fn wanted(to: *mut Self, cables: usize) -> Checked<Self> {
        // SAFETY: promised by the caller.
        let of = unsafe { read_struct(to.cast_const()) }?;
        if (of.cables as usize) < cables {
            return Err(BAD_STRUCT);
        }
        of.arrays().into_iter().try_for_each(check_wanted)?;
        Ok(of)
    }

    fn fill(&mut self, state: &EstimatedState, notes: &UpdateNotes, time: f64) {
        let std = |std: f64| if notes.is_trusted { std } else { f64::INFINITY };
        let values = |of: &[Estimate; 3]| of.map(|part| part.value);
        let stds = |of: &[Estimate; 3]| of.map(|part| std(part.std));
        (self.is_trusted, self.rings) = (i32::from(notes.is_trusted), i32::from(state.rings));
        (self.alarm, self.alarm_cable) = match notes.alarm {
            None => (0, -1),
            Some(FaultAlarm { kind, cable, .. }) => (kind.map_or(UNEXPLAINED, number_of), cable_number(cable)),
        };
        self.time_s = time;
        self.position_m = state.pose.position_w.into();
        self.quaternion_wxyz = rotation::quaternion_wxyz(&state.pose.rot_wp);
        self.position_std_m = state.position_std.map(std);
        self.rotation_std_rad = state.rotation_std.map(std);
        (self.velocity_m_s, self.velocity_std_m_s) = (values(&state.velocity), stds(&state.velocity));
        self.angular_velocity_rad_s = values(&state.angular_velocity);
        self.angular_velocity_std_rad_s = stds(&state.angular_velocity);
        (self.force_n, self.force_std_n) = (values(&state.force), stds(&state.force));
        (self.moment_n_m, self.moment_std_n_m) = (values(&state.moment), stds(&state.moment));
        (self.payload_kg, self.payload_std_kg) = (state.payload.value, std(state.payload.std));
        (self.first_moment_kg_m, self.first_moment_std_kg_m) = (values(&state.first_moment), stds(&state.first_moment));
    }

    /// Writes the state of an estimator.
    ///
    /// # Safety
    /// The struct was [`Self::wanted`].
    unsafe fn write(mut self, to: *mut Self, of: &mut EstState) {
        let state = of.estimator.state();
        let cables = &state.cables[..of.estimator.cables()];
        let is_trusted = of.notes.is_trusted;
        self.fill(&state, &of.notes, of.estimator.time());
        let std = |std: f64| if is_trusted { std } else { f64::INFINITY };
        let slack = |of: &EstimatedCable| match of.slackness {
            _ if !is_trusted => -1.0,
            Slackness::Slack => 1.0,
            Slackness::Taut => 0.0,
            Slackness::Unknown => -1.0,
        };
        // SAFETY: the arrays were checked, and the struct has its size.
        unsafe {
            write_array(self.tension_n, cables.iter().map(|of| of.tension.value));
            write_array(self.tension_std_n, cables.iter().map(|of| std(of.tension.std)));
            write_array(self.offset_m, cables.iter().map(|of| of.offset.value));
            write_array(self.offset_std_m, cables.iter().map(|of| std(of.offset.std)));
            write_array(self.tension_bias_n, cables.iter().map(|of| of.tension_bias.value));
            write_array(self.tension_bias_std_n, cables.iter().map(|of| std(of.tension_bias.std)));
            write_array(self.slack, cables.iter().map(slack));
            write_struct(to, &self, self.struct_size);
        }
    }
}

/// `fn_est_defaults`: usual settings.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fn_est_defaults(settings: *mut EstSettings) -> i32 {
    // SAFETY: promised by the caller.
    match unsafe { read_struct(settings.cast_const()) } {
        Ok(EstSettings { struct_size, .. }) => {
            let usual = EstSettings { struct_size, ..EstSettings::usual() };
            // SAFETY: as above.
            unsafe { write_struct(settings, &usual, struct_size) };
            CERTIFIED
        }
        Err(status) => status,
    }
}

/// `fn_est_new`: estimator of the text of a robot file, at rest.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fn_est_new(
    toml: *const c_char,
    bytes: usize,
    settings: *const EstSettings,
    readings: *const EstReadings,
    near_pose: *const f64,
    out: *mut *mut Est,
    message: *mut c_char,
    message_bytes: usize,
) -> i32 {
    // SAFETY: the caller gives `bytes`, the structs with their arrays, and seven numbers of a pose.
    let make = || unsafe {
        let robot = robot_of_bytes(read(toml.cast::<u8>(), bytes).map_err(silent)?)?;
        let given = if settings.is_null() { EstSettings::usual() } else { read_struct(settings).map_err(silent)? };
        let (settings, near) = (given.checked()?, pose_at(near_pose)?);
        let readings = readings_at(readings, robot.cables.len().min(MAX_CABLES)).map_err(silent)?;
        let mut estimator = Estimator::new(robot, settings, &readings, near.as_ref()).map_err(|error| told(&error))?;
        estimator.set_false_alarms_per_hour(given.false_alarms_per_hour);
        Ok(EstState { estimator, notes: BEGUN })
    };
    // SAFETY: promised by the caller.
    unsafe { Est::make(out, MessageRoom { to: message, bytes: message_bytes }, make) }
}

/// `fn_est_free`: ends an estimator.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fn_est_free(est: *mut Est) -> i32 {
    // SAFETY: promised by the caller.
    unsafe { Est::free(est) }
}

/// `fn_est_update`: moves the estimate by a time step and takes the readings at its end; reserves no memory.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fn_est_update(
    est: *mut Est,
    readings: *const EstReadings,
    step_s: f64,
    result: *mut EstResult,
) -> i32 {
    // SAFETY: promised by the caller for all addresses.
    unsafe {
        Est::call(est, MessageRoom::NONE, |state| {
            let cables = state.estimator.cables();
            let readings = readings_at(readings, cables).map_err(silent)?;
            let wanted = if result.is_null() { None } else { Some(EstResult::wanted(result, cables).map_err(silent)?) };
            let updated = state.estimator.update(&readings, step_s);
            state.notes = updated.map_err(|error| silent(status_of(&error)))?;
            if let Some(wanted) = wanted {
                wanted.write(result, state);
            }
            Ok(())
        })
    }
}

/// `fn_est_get`: state at the last time.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fn_est_get(est: *mut Est, result: *mut EstResult) -> i32 {
    // SAFETY: promised by the caller for all addresses.
    unsafe {
        Est::call(est, MessageRoom::NONE, |state| {
            let wanted = EstResult::wanted(result, state.estimator.cables()).map_err(silent)?;
            wanted.write(result, state);
            Ok(())
        })
    }
}

/// `fn_est_restart`: begins anew at rest, with what is known about payload and sensors or with nothing.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fn_est_restart(
    est: *mut Est,
    readings: *const EstReadings,
    near_pose: *const f64,
    forget: i32,
    message: *mut c_char,
    message_bytes: usize,
) -> i32 {
    // SAFETY: promised by the caller for all addresses.
    unsafe {
        Est::call(est, MessageRoom { to: message, bytes: message_bytes }, |state| {
            let (near, cables) = (pose_at(near_pose)?, state.estimator.cables());
            let readings = readings_at(readings, cables).map_err(silent)?;
            let estimator = &mut state.estimator;
            let begun = if forget == 0 {
                let here = near.unwrap_or_else(|| estimator.state().pose);
                estimator.rest_anew(&readings, Some(&here))
            } else {
                estimator.reset(&readings, near.as_ref())
            };
            begun.map_err(|error| told(&error))?;
            state.notes = BEGUN;
            Ok(())
        })
    }
}

/// `fn_est_explain`: explanations of the last alarm, best first.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fn_est_explain(
    est: *mut Est,
    faults: *mut EstFault,
    room: u32,
    count: *mut u32,
    is_decided: *mut i32,
) -> i32 {
    // SAFETY: promised by the caller for all addresses.
    unsafe {
        Est::call(est, MessageRoom::NONE, |state| {
            check(faults).and_then(|()| check(count)).and_then(|()| check(is_decided)).map_err(silent)?;
            let verdict = state.estimator.explain().ok_or_else(|| silent(REFUSED))?;
            let found: Vec<FaultHypothesis> = verdict.hypotheses.into_iter().flatten().collect();
            for (i, of) in found.iter().enumerate().take(room as usize) {
                let (kind, cable) = (number_of(of.kind), cable_number(of.cable));
                let (size, std, worse_by) = (of.size, of.std, of.worse_by);
                faults.add(i).write(EstFault { kind, cable, size, std, worse_by });
            }
            count.write(found.len().min(room as usize) as u32);
            is_decided.write(i32::from(verdict.is_decided));
            Ok(())
        })
    }
}

/// `fn_est_take_fault`: lets the estimator follow a fault.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fn_est_take_fault(est: *mut Est, kind: i32, cable: i32) -> i32 {
    // SAFETY: promised by the caller for the address.
    unsafe {
        Est::call(est, MessageRoom::NONE, |state| {
            let kind = kind_of(kind).ok_or_else(|| silent(REFUSED))?;
            let cable = usize::try_from(cable).ok();
            if cable.is_some_and(|cable| cable >= state.estimator.cables()) {
                return Err(silent(REFUSED));
            }
            state.estimator.take_fault(&FaultHypothesis { kind, cable, size: 0.0, std: 0.0, worse_by: 0.0 });
            Ok(())
        })
    }
}

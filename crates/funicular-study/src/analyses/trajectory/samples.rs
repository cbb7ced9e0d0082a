//! A robot at the times of a path: lengths, tensions, winches, and the used part of every limit.

use super::Planned;
use crate::error::{Cancelled, NoSolution};
use crate::text::significant;
use crate::watch::Watch;
use anyhow::{Result, anyhow};
use funicular::clearance::{Clearance, Surroundings};
use funicular::math::Vec3;
use funicular::robot::{Cable, LimitOfWinch, Load, MotorLoad, RequiredLoads, Robot, WinchLimits};
use funicular::statics::{Limit, LoadCapacity, TensionRange};
use funicular::trajectory::{AlongPath, InMotion, length_accelerations};

/// Times between two looks at whether the work shall stop.
const PER_LOOK: usize = 50;

/// Robot at the times of a path.
pub(super) struct MotionSamples {
    pub(super) times: Vec<f64>,
    pub(super) motions: Vec<InMotion>,
    /// Acceleration of every length at every time [m/s²].
    pub(super) accelerations: Vec<Vec<f64>>,
    /// Nearest pair at every time, if distances are judged.
    pub(super) nearest: Vec<Option<Clearance>>,
    /// Used part of what tensions within their limits can hold of the inertia, at every time; `None` where the tensions
    /// are no matter of choice.
    held: Vec<Option<(UsedLimit, f64)>>,
}

/// Winch of a cable at one time; without a winch in the file that of a plain drum at the anchor.
#[derive(Debug, Clone, Copy)]
pub(super) struct WinchInMotion {
    /// Speed and acceleration of the cable at the drum, positive while it pays out [m/s, m/s²].
    pub(super) speed: f64,
    pub(super) acceleration: f64,
    /// Load of the motor; `None` without a winch.
    pub(super) motor: Option<MotorLoad>,
}

/// Limit, of which a motion uses a part.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum UsedLimit {
    Tension(Limit, usize),
    Winch(LimitOfWinch, usize),
    Clearance,
}

impl UsedLimit {
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Tension(Limit::Maximum, _) => "maximum-tension",
            Self::Tension(Limit::Minimum, _) => "minimum-tension",
            Self::Winch(limit, _) => limit.name(),
            Self::Clearance => "clearance",
        }
    }

    /// Cable to which it belongs.
    pub(super) fn cable(self) -> Option<usize> {
        match self {
            Self::Tension(_, cable) | Self::Winch(_, cable) => Some(cable),
            Self::Clearance => None,
        }
    }
}

impl MotionSamples {
    /// Robot at these times of a path.
    ///
    /// # Errors
    /// A time at which the cables do not hold the platform, or [`Cancelled`].
    pub(super) fn at(planned: &Planned, times: Vec<f64>, watch: &mut dyn Watch) -> Result<Self> {
        let mut along = planned.along();
        let mut motions = Vec::with_capacity(times.len());
        for (done, time) in times.iter().enumerate() {
            if done % PER_LOOK == 0 {
                watch.progress(done, times.len(), "times");
                if watch.is_cancelled() {
                    return Err(Cancelled.into());
                }
            }
            motions.push(in_motion(&mut along, planned, *time)?);
        }

        let lengths: Vec<Vec<f64>> = motions.iter().map(lengths).collect();
        let rates: Vec<Vec<f64>> = motions.iter().map(|motion| motion.length_rates.clone()).collect();
        let jumps = planned.path.jumps_of_jerk();
        let is_smooth = |k: usize| {
            let next = jumps.partition_point(|jump| *jump <= times[k]);
            let jumps_between = jumps.get(next).is_some_and(|jump| *jump < times[k + 1]);
            motions[k].at_limit == motions[k + 1].at_limit && !jumps_between
        };
        let accelerations = length_accelerations(&times, &lengths, &rates, is_smooth);
        let around = planned.judged.clearance.then(|| Surroundings::of(planned.robot));
        let nearest = |motion: &InMotion| around.as_ref().and_then(|around| around.least(&motion.equilibrium, None));
        let nearest = motions.iter().map(nearest).collect();
        let held = if planned.judged.inertia { parts_of_inertia(planned, &motions) } else { vec![None; motions.len()] };
        Ok(Self { times, motions, accelerations, nearest, held })
    }

    /// Winch of a cable at the time with this index.
    pub(super) fn winch(&self, robot: &Robot, k: usize, i: usize) -> WinchInMotion {
        let (motion, cable) = (&self.motions[k], &robot.cables[i]);
        let tension = motion.equilibrium.cables[i].tension_drum();
        // The rope that passes the drum is longer than unstrained by its strain.
        let stretched = 1.0 + tension / cable.material.axial_stiffness;
        let (speed, acceleration) = (motion.length_rates[i] * stretched, self.accelerations[k][i] * stretched);
        let motor = cable.anchor.winch.as_ref().map(|winch| winch.motor(tension, speed, acceleration));
        WinchInMotion { speed, acceleration, motor }
    }

    /// Limit of which the largest part is used at the time with this index, with this part.
    pub(super) fn most_used(&self, planned: &Planned, k: usize) -> Option<(UsedLimit, f64)> {
        let robot = planned.robot;
        let of_cable = |i: usize| {
            let state = &self.motions[k].equilibrium.cables[i];
            let margin = TensionRange::of(robot, i, &state.chord_w()).margin(state);
            let minimum = if margin.min > 0.0 { margin.range.minimum / margin.min } else { f64::INFINITY };
            // Where tensions are a matter of choice, others may hold more.
            let of_tension = self.held[k].is_none().then_some([
                (UsedLimit::Tension(Limit::Maximum, i), margin.max / margin.range.maximum),
                (UsedLimit::Tension(Limit::Minimum, i), if planned.judged.minimum_tensions { minimum } else { 0.0 }),
            ]);
            let winch = self.winch(robot, k, i);
            let of_winch = limits_of(&robot.cables[i]).zip(winch.motor).map(|(limits, motor)| {
                limits
                    .use_of(winch.speed, winch.acceleration, &motor)
                    .map(|(limit, part)| (UsedLimit::Winch(limit, i), part))
            });
            of_tension.into_iter().flatten().chain(of_winch.into_iter().flatten())
        };
        let clearance = self.nearest[k].as_ref().map(|pair| (UsedLimit::Clearance, part_of_clearance(pair)));
        let further = clearance.into_iter().chain(self.held[k]);
        (0..robot.cables.len()).flat_map(of_cable).chain(further).max_by(|a, b| a.1.total_cmp(&b.1))
    }
}

/// Inertia over the largest multiple of it that tensions within their limits hold, with a limit that binds there, at
/// every time; `None` where the dead load alone is not held.
fn parts_of_inertia(planned: &Planned, motions: &[InMotion]) -> Vec<Option<(UsedLimit, f64)>> {
    let mut robot = Robot { required: RequiredLoads::default(), ..planned.robot.clone() };
    let part = |motion: &InMotion| {
        let [force_w, moment_w] = motion.point.inertia(planned.robot);
        if [force_w, moment_w] == [Vec3::zeros(); 2] {
            return Some((UsedLimit::Tension(Limit::Maximum, 0), 0.0));
        }
        robot.required.listed = vec![Load { force_w, moment_w, point_p: Vec3::zeros() }];
        let capacity = LoadCapacity::at(&robot, &motion.point.pose, planned.model, None).ok()?;
        let found = capacity.load_factor().ok()?;
        let binding = |limit: Limit| found.limits.iter().find(|at| at.limit == limit);
        let at = binding(Limit::Maximum).or_else(|| binding(Limit::Minimum))?;
        Some((UsedLimit::Tension(at.limit, at.cable), 1.0 / found.value))
    };
    motions.iter().map(part).collect()
}

/// Required distance over the distance of a pair; infinite where it touches.
fn part_of_clearance(pair: &Clearance) -> f64 {
    if pair.touches() { f64::INFINITY } else { pair.required / pair.distance }
}

/// Robot at a time of a path.
pub(super) fn in_motion(along: &mut AlongPath, planned: &Planned, time: f64) -> Result<InMotion> {
    along.at(&planned.path.at(time)).map_err(|error| {
        let text = format!("{} s after the start of the path: {error}", significant(time, 4));
        if error.is_no_solution() { NoSolution(text).into() } else { anyhow!(text) }
    })
}

/// Unstrained lengths [m].
pub(super) fn lengths(motion: &InMotion) -> Vec<f64> {
    motion.equilibrium.cables.iter().map(|cable| cable.unstrained_length).collect()
}

/// Limits of the winch of a cable.
fn limits_of(cable: &Cable) -> Option<&WinchLimits> {
    cable.anchor.winch.as_ref().map(|winch| &winch.limits)
}

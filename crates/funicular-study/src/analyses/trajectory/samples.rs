//! A robot at the times of a path: lengths, tensions, winches, and where lengths or their rates jump.

use super::Planned;
use super::at_time::{in_motion, lengths};
use super::instants::{Instant, instants};
use super::jumps::{self, LengthJump, MAX_CHANGES, Sample};
use super::passing::Passing;
use crate::error::Cancelled;
use crate::watch::Watch;
use anyhow::Result;
use funicular::clearance::{Clearance, Surroundings};
use funicular::path::Side;
use funicular::robot::{MotorLoad, Robot};
use funicular::trajectory::{AlongPath, InMotion, length_accelerations};

/// Times between two looks at whether the work shall stop.
const PER_LOOK: usize = 50;

/// Part of the largest rate of a cable by which a rate between two samples may be larger without a sample of its own.
const MAX_MISSED: f64 = 1e-3;

/// Peak of a rate between two samples over the difference of its mean from that of the two: 1.5 for a parabola, 6 for a
/// triangle on a third of the time.
const NARROW: f64 = 6.0;

/// Part of the duration below which two samples have none between them.
const SHORTEST: f64 = 1e-4;

/// Largest number of samples at peaks.
const MAX_PEAKS: usize = 200;

/// Robot at the times of a path, ascending. Both sides of a jump are two of them.
pub(super) struct MotionSamples {
    pub(super) times: Vec<f64>,
    pub(super) motions: Vec<InMotion>,
    /// Acceleration of every length at every time [m/s²].
    pub(super) accelerations: Vec<Vec<f64>>,
    /// Indices of the rows of the result.
    pub(super) rows: Vec<usize>,
    /// Nearest pair at every row, if distances are judged.
    pub(super) nearest: Vec<Option<Clearance>>,
    /// Pair that comes too near between the times, if distances are judged and kept at all rows.
    pub(super) passing: Option<Passing>,
    /// Jumps of lengths or of their rates.
    pub(super) jumps: Vec<LengthJump>,
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

impl MotionSamples {
    /// Robot at rows of a path and at about `count` times between them.
    ///
    /// # Errors
    /// A time at which the cables do not hold the platform, or [`Cancelled`].
    pub(super) fn at(planned: &Planned, rows: &[f64], count: usize, watch: &mut dyn Watch) -> Result<Self> {
        let mut along = planned.along();
        let asked = instants(&planned.path, rows, count);
        let mut sampled: Vec<Sample> = Vec::with_capacity(asked.len());
        let mut jumps = Vec::new();
        for (done, instant) in asked.iter().enumerate() {
            if done % PER_LOOK == 0 {
                watch.progress(done, asked.len(), "times");
                if watch.is_cancelled() {
                    return Err(Cancelled.into());
                }
            }
            let motion = in_motion(&mut along, planned, instant.time, instant.side)?;
            if let Some(last) = sampled.last().cloned() {
                let next = (*instant, motion.clone());
                for (sample, jump) in jumps::between(&mut along, planned, &sampled, &next, jumps.len())? {
                    if let Some(mut jump) = jump {
                        jump.before = sampled.len();
                        jumps.push(jump);
                    }
                    sampled.push(sample);
                }
                jumps.extend(LengthJump::at_corner(planned, &last, &next, sampled.len()));
            }
            sampled.push((*instant, motion));
        }
        add_peaks(&mut along, planned, &mut sampled, &mut jumps)?;
        let mut found = Self::of(planned, sampled, jumps);
        if planned.judged.clearance && found.nearest.iter().flatten().all(Clearance::is_kept) {
            let known: Vec<_> =
                found.times.iter().zip(&found.motions).map(|(time, motion)| (*time, &motion.equilibrium)).collect();
            found.passing = Passing::look(planned, &known, watch)?;
        }
        Ok(found)
    }

    fn of(planned: &Planned, sampled: Vec<Sample>, jumps: Vec<LengthJump>) -> Self {
        let (instants, motions): (Vec<Instant>, Vec<InMotion>) = sampled.into_iter().unzip();
        let times: Vec<f64> = instants.iter().map(|instant| instant.time).collect();
        let lengths: Vec<Vec<f64>> = motions.iter().map(lengths).collect();
        let rates: Vec<Vec<f64>> = motions.iter().map(|motion| motion.length_rates.clone()).collect();
        let is_smooth = |k: usize| {
            // Every change of what holds the tensions is a jump, up to their largest number.
            let are_known = !planned.judged.choice || jumps.len() < MAX_CHANGES;
            let held_alike = are_known || motions[k].held.are_alike(&motions[k + 1].held);
            let jumps = || jumps.iter().any(|jump| jump.before == k);
            instants[k].phase == instants[k + 1].phase && held_alike && !jumps()
        };
        let mut accelerations = length_accelerations(&times, &lengths, &rates, is_smooth);
        for (row, _) in accelerations.iter_mut().zip(&instants).filter(|(_, instant)| instant.is_rest) {
            row.fill(0.0);
        }

        let rows: Vec<usize> = (0..instants.len()).filter(|k| instants[*k].is_row).collect();
        let around = planned.judged.clearance.then(|| Surroundings::of(planned.robot));
        let nearest = |k: &usize| around.as_ref().and_then(|around| around.least(&motions[*k].equilibrium, None));
        let nearest = rows.iter().map(nearest).collect();
        Self { times, motions, accelerations, rows, nearest, passing: None, jumps }
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
}

/// Adds samples between two where the change of a length says that its rate may be larger than at all samples.
///
/// # Errors
/// A time at which the cables do not hold the platform.
fn add_peaks(
    along: &mut AlongPath,
    planned: &Planned,
    sampled: &mut Vec<Sample>,
    jumps: &mut [LengthJump],
) -> Result<()> {
    let Some((_, first)) = sampled.first() else { return Ok(()) };
    let mut largest = vec![0.0_f64; first.length_rates.len()];
    let raise = |largest: &mut [f64], motion: &InMotion| {
        for (largest, rate) in largest.iter_mut().zip(&motion.length_rates) {
            *largest = largest.max(rate.abs());
        }
    };
    for (_, motion) in sampled.iter() {
        raise(&mut largest, motion);
    }

    let duration = planned.path.duration();
    let (mut k, mut added) = (0, 0);
    while k + 1 < sampled.len() && added < MAX_PEAKS {
        let ((last, from), (next, to)) = (&sampled[k], &sampled[k + 1]);
        let time = next.time - last.time;
        let is_whole =
            last.phase == next.phase && time > SHORTEST * duration && jumps.iter().all(|jump| jump.before != k);
        let (before, after) = (lengths(from), lengths(to));
        let may_be_larger = |i: usize| {
            let ends = 0.5 * (from.length_rates[i] + to.length_rates[i]);
            let peak = ends + NARROW * ((after[i] - before[i]) / time - ends);
            peak.abs() > (1.0 + MAX_MISSED) * largest[i]
        };
        if !is_whole || !(0..largest.len()).any(may_be_larger) {
            k += 1;
            continue;
        }
        let instant = Instant { time: last.time + 0.5 * time, is_row: false, side: Side::After, ..*last };
        let motion = in_motion(along, planned, instant.time, instant.side)?;
        raise(&mut largest, &motion);
        sampled.insert(k + 1, (instant, motion));
        jumps.iter_mut().filter(|jump| jump.before > k).for_each(|jump| jump.before += 1);
        added += 1;
    }
    Ok(())
}

//! Lengths of a controller that changes them in straight lines between its stations.

use super::Planned;
use super::at_time::{in_motion, lengths};
use super::samples::MotionSamples;
use crate::rows::rows;
use anyhow::Result;
use funicular::path::Side;
use funicular::statics;

rows! {
    /// Error of lengths that change in straight lines between stations, where it is largest.
    #[derive(Debug, Clone)]
    pub struct Stations {
        /// Time between two stations.
        pub interval_s: f64;
        /// Largest error of a length; half way between two stations.
        pub error_m: f64;
        pub cable: String;
        pub t_s: f64;
        /// Distance of the platform from its path there; absent if the lengths hold it nowhere near.
        pub displacement_m: Option<f64>;
        /// Lowest tension in any cable there.
        pub lowest_tension_n: Option<f64>;
        /// Tolerance of a length, and number of stations that keeps it.
        pub tolerance_m: f64;
        pub needed: usize;
    }
}

impl Stations {
    /// Largest error between stations at equal times; `None` if no length bends.
    ///
    /// # Errors
    /// A time at which the cables do not hold the platform.
    pub(super) fn of(
        planned: &Planned,
        samples: &MotionSamples,
        interval: f64,
        tolerance: f64,
    ) -> Result<Option<Self>> {
        // A line leaves a curve by the square of the interval times an eighth of the second derivative.
        let bends = samples.accelerations.iter().enumerate();
        let largest = bends
            .flat_map(|(k, row)| row.iter().enumerate().map(move |(i, bend)| (k, i, bend.abs())))
            .max_by(|a, b| a.2.total_cmp(&b.2));
        let duration = planned.path.duration();
        let Some((k, i, _)) = largest.filter(|(_, _, bend)| *bend > 0.0) else { return Ok(None) };
        if interval > duration {
            return Ok(None);
        }

        let half = 0.5 * interval;
        let middle = samples.times[k].clamp(half, duration - half);
        let mut along = planned.along();
        let [from, to, at] =
            [middle - half, middle + half, middle].map(|time| in_motion(&mut along, planned, time, Side::After));
        let (from, to, at) = (lengths(&from?), lengths(&to?), at?);
        let on_line: Vec<f64> = from.iter().zip(&to).map(|(from, to)| 0.5 * (from + to)).collect();
        let errors = lengths(&at).into_iter().zip(&on_line).map(|(at, line)| (at - line).abs());
        let (i, error_m) = errors.enumerate().max_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((i, 0.0));

        let model = at.equilibrium.model;
        let held = statics::forward(along.loaded(), &on_line, model, Some(&at.point.pose)).ok();
        let lowest = held.as_ref().and_then(|held| {
            held.cables.iter().map(|cable| cable.tension_platform.min(cable.tension_anchor)).reduce(f64::min)
        });
        let moved = |held: &statics::Equilibrium| (held.pose.position_w - at.point.pose.position_w).norm();
        let needed = (duration / interval * (error_m / tolerance).sqrt()).ceil() as usize + 1;
        Ok(Some(Self {
            interval_s: interval,
            error_m,
            cable: planned.robot.cables[i].name.clone(),
            t_s: middle,
            displacement_m: held.as_ref().map(moved),
            lowest_tension_n: lowest,
            tolerance_m: tolerance,
            needed: needed.max(2),
        }))
    }
}

//! Remedies for a pose that is not held: single changes of limits, loads, anchors and attachments with which the
//! platform rests there.

use crate::text::significant;
use funicular::calibration::moving_axes;
use funicular::math::Vec3;
use funicular::robot::{PlatformMotion, Pose, Robot, State, TensionLimits};
use funicular::statics::{self, StaticModel, TensionRule};

/// Number of remedies that are told.
const TOLD: usize = 6;

/// Accuracy of the size of a change, relative to it; told are three digits.
const ACCURACY: f64 = 1e-3;

/// Largest factor of a maximum tension, and the reciprocal of the least one of the mass; a minimum goes down to zero.
const MAX_FACTOR: f64 = 10.0;

/// Largest move of an anchor, over the mean distance from anchors to platform.
const MAX_MOVE: f64 = 0.5;

/// Largest move of an attachment, over the length of the platform.
const MAX_SHIFT: f64 = 2.0;

/// Change that is tried: a robot for each size from 0 to 1, and the change in words.
struct Remedy<'a> {
    robot: Box<dyn Fn(f64) -> Robot + 'a>,
    words: Box<dyn Fn(f64) -> String + 'a>,
}

/// Sentences on what would let the platform rest at a pose, the smallest changes first; each is one change alone.
pub(super) fn cures(robot: &Robot, pose: &Pose, model: StaticModel, rule: &TensionRule) -> Vec<String> {
    let holds = |robot: &Robot| statics::solve_at(robot, &State::Pose(*pose), model, rule).is_ok();
    let mut found: Vec<(f64, String)> = remedies(robot, pose)
        .into_iter()
        .filter_map(|remedy| {
            let size = least_size(&|size| holds(&(remedy.robot)(size)))?;
            Some((size, (remedy.words)(size)))
        })
        .collect();
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    found.into_iter().take(TOLD).map(|(_, words)| words).collect()
}

/// Least size with which a pose is held, slightly above it; none if the largest one does not hold it.
fn least_size(holds: &dyn Fn(f64) -> bool) -> Option<f64> {
    // Small changes first: a large one can hold for another reason, or not at all.
    let sizes = (0..=6).rev().map(|k| 0.5_f64.powi(k));
    let mut low = 0.0;
    let mut high = None;
    for size in sizes {
        if holds(size) {
            high = Some(size);
            break;
        }
        low = size;
    }
    let mut high = high?;
    while high - low > ACCURACY * high {
        let middle = 0.5 * (low + high);
        if holds(middle) {
            high = middle;
        } else {
            low = middle;
        }
    }
    Some(high)
}

/// All remedies that are tried.
fn remedies<'a>(robot: &'a Robot, pose: &'a Pose) -> Vec<Remedy<'a>> {
    let mut all = vec![limits(robot, true), limits(robot, false), lighter(robot)];
    let up = -robot.gravity_w.try_normalize(f64::MIN_POSITIVE).unwrap_or_else(|| -Vec3::z());
    let anchors = robot.cables.iter().map(|cable| (pose.position_w - cable.anchor.point_w).norm());
    let reach = MAX_MOVE * anchors.sum::<f64>() / robot.cables.len().max(1) as f64;
    for (direction, words) in [(up, "higher"), (-up, "lower")] {
        all.push(moved_anchors(robot, None, direction * reach, words.to_owned()));
    }
    let shift = MAX_SHIFT * robot.platform_length();
    let is_point = robot.platform.motion == PlatformMotion::PointMass;
    for i in 0..robot.cables.len() {
        for axis in moving_axes(robot) {
            for sign in [1.0, -1.0] {
                let words = format!("along {}{}", if sign > 0.0 { "" } else { "−" }, ["x", "y", "z"][axis]);
                all.push(moved_anchors(robot, Some(i), Vec3::ith(axis, sign * reach), words.clone()));
                if !is_point {
                    all.push(moved_attachment(robot, i, Vec3::ith(axis, sign * shift), words));
                }
            }
        }
    }
    all
}

/// Other minimum or maximum tensions of all cables.
fn limits(robot: &Robot, is_maximum: bool) -> Remedy<'_> {
    let factor = move |size: f64| if is_maximum { MAX_FACTOR.powf(size) } else { 1.0 - size };
    let limit = move |robot: &Robot, size: f64| -> Vec<Option<f64>> {
        let of = robot.cables.iter().map(|cable| {
            let limits = cable.limits();
            if is_maximum { limits.maximum } else { limits.minimum }
        });
        of.map(|limit| limit.map(|limit| limit * factor(size))).collect()
    };
    Remedy {
        robot: Box::new(move |size| {
            let mut changed = robot.clone();
            for (cable, limit) in changed.cables.iter_mut().zip(limit(robot, size)) {
                let TensionLimits { minimum, maximum } = cable.limits();
                cable.tension_limits = if is_maximum {
                    TensionLimits { minimum, maximum: limit }
                } else {
                    TensionLimits { minimum: limit, maximum }
                };
            }
            changed
        }),
        words: Box::new(move |size| {
            let name = if is_maximum { "maximum" } else { "minimum" };
            let of: Vec<f64> = limit(robot, size).into_iter().flatten().collect();
            let (low, high) = of.iter().fold((f64::MAX, f64::MIN), |(low, high), x| (low.min(*x), high.max(*x)));
            let value = if high - low <= ACCURACY * high {
                format!("{} N", significant(high, 3))
            } else {
                format!("{} times as large", significant(factor(size), 3))
            };
            format!("{name} tension of all cables {value}")
        }),
    }
}

/// Less mass of the platform.
fn lighter(robot: &Robot) -> Remedy<'_> {
    let mass = move |size: f64| robot.platform.mass * (1.0 - size * (1.0 - MAX_FACTOR.recip()));
    Remedy {
        robot: Box::new(move |size| {
            let mut changed = robot.clone();
            changed.platform.mass = mass(size);
            changed
        }),
        words: Box::new(move |size| format!("mass of the platform {} kg", significant(mass(size), 3))),
    }
}

/// One anchor or all of them moved.
fn moved_anchors(robot: &Robot, cable: Option<usize>, most_w: Vec3, direction: String) -> Remedy<'_> {
    Remedy {
        robot: Box::new(move |size| {
            let mut changed = robot.clone();
            let chosen = changed.cables.iter_mut().enumerate().filter(|(i, _)| cable.is_none_or(|only| only == *i));
            chosen.for_each(|(_, cable)| cable.anchor.point_w += most_w * size);
            changed
        }),
        words: Box::new(move |size| {
            let distance = significant(size * most_w.norm(), 3);
            match cable {
                Some(i) => format!("anchor of cable {} moved by {distance} m {direction}", robot.cables[i].name),
                None => format!("all anchors {distance} m {direction}"),
            }
        }),
    }
}

/// One attachment moved on the platform.
fn moved_attachment(robot: &Robot, cable: usize, most_p: Vec3, direction: String) -> Remedy<'_> {
    Remedy {
        robot: Box::new(move |size| {
            let mut changed = robot.clone();
            changed.cables[cable].attachment_p += most_p * size;
            changed
        }),
        words: Box::new(move |size| {
            let distance = significant(size * most_p.norm(), 3);
            let name = &robot.cables[cable].name;
            format!("attachment of cable {name} moved by {distance} m {direction} of the platform")
        }),
    }
}

//! Plausibility of the geometry: sizes of anchors, attachments, poses and lengths, and signs of coordinates.

use super::{Implausible, likely, number, outside, usual};
use crate::math::{Vec3, rotation};
use crate::robot::{Cable, Robot, State};
use crate::statics::spread;
use std::f64::consts::PI;

/// Sizes of a robot [m].
#[derive(Debug, Clone, Copy)]
pub(super) struct Size {
    /// Maximum distance of an anchor from the mean of all.
    pub anchors: f64,
    /// Maximum distance of an attachment from the mean of all.
    pub attachments: f64,
    /// Mean of the attachments, platform frame.
    pub middle_p: Vec3,
}

impl Size {
    pub(super) fn of(robot: &Robot) -> Self {
        let attachments = robot.cables.iter().map(|cable| cable.attachment_p);
        let count = robot.cables.len().max(1) as f64;
        Self {
            anchors: spread(robot.cables.iter().map(|cable| cable.anchor.reference_w())),
            attachments: spread(attachments.clone()),
            middle_p: attachments.sum::<Vec3>() / count,
        }
    }
}

/// Warnings about the geometry.
pub(super) fn check(robot: &Robot) -> Vec<Implausible> {
    let size = Size::of(robot);
    // A single point far away explains the size of all.
    let of_size = one_anchor(robot, &size)
        .or_else(|| single_cable(robot))
        .or_else(|| anchors(&size))
        .or_else(|| attachments(robot, &size));
    let of_size = of_size.or_else(|| distance(robot, &size)).or_else(|| attachments_in_world(robot, &size));
    let mut found: Vec<Implausible> = of_size.into_iter().collect();
    found.extend(signs(robot, &size));
    found.extend(angles(robot));
    found
}

/// Lengths of the cables [m]: given, or between anchors and attachments at the pose, or from the middle of the anchors.
pub(super) fn lengths(robot: &Robot) -> Vec<f64> {
    let count = robot.cables.len() as f64;
    let middle: Vec3 = robot.cables.iter().map(|cable| cable.anchor.reference_w()).sum::<Vec3>() / count;
    let length = |(i, cable): (usize, &Cable)| match &robot.state {
        // Lengths of another number are refused by statics, with these warnings.
        State::Lengths(lengths) => lengths.get(i).copied().unwrap_or_default(),
        State::Pose(pose) => cable.chord_w(pose).norm(),
        State::Unknown => (cable.anchor.reference_w() - middle).norm(),
    };
    robot.cables.iter().enumerate().map(length).collect()
}

/// Point `i` against the other points: its distance from their mean, and their size [m].
fn against_others(points: &[Vec3], i: usize) -> (f64, f64) {
    let others = points.iter().enumerate().filter(|(j, _)| *j != i).map(|(_, point)| *point);
    let mean = others.clone().sum::<Vec3>() / (points.len() - 1) as f64;
    ((points[i] - mean).norm(), spread(others))
}

/// Minimum number of cables of which one with a point far from those of the others is suspicious.
const MIN_OTHERS: usize = 4;

/// Cable whose anchor or attachment is far from those of all others.
fn single_cable(robot: &Robot) -> Option<Implausible> {
    let cables = &robot.cables;
    if cables.len() < MIN_OTHERS {
        return None;
    }
    let anchors: Vec<Vec3> = cables.iter().map(|cable| cable.anchor.reference_w()).collect();
    let attachments: Vec<Vec3> = cables.iter().map(|cable| cable.attachment_p).collect();

    for (i, cable) in cables.iter().enumerate() {
        let (from_anchors, anchors_size) = against_others(&anchors, i);
        let (from_attachments, size) = against_others(&attachments, i);
        if size == 0.0 || anchors_size == 0.0 {
            continue;
        }

        // Ends swapped: each end fits the other ends of the other cables.
        let exchanged = |points: &[Vec3], own: Vec3| {
            let mut points = points.to_vec();
            points[i] = own;
            let (distance, size) = against_others(&points, i);
            distance <= 2.0 * size
        };
        if from_attachments > usual::SWAPPED_ATTACHMENT * size
            && exchanged(&attachments, anchors[i])
            && exchanged(&anchors, attachments[i])
        {
            return Some(Implausible::Odd {
                what: format!(
                    "the attachment of cable \"{}\" is among the anchors of the other cables, and its anchor among \
                     their attachments",
                    cable.name
                ),
                slip: "`anchor_m` and `attachment_m` of this cable swapped?".to_owned(),
            });
        }

        let far = |end: &str, key: &str, distance: f64, size: f64, range: [f64; 2]| {
            let what =
                format!("distance of the {end} of cable \"{}\" from those of the others, over their size,", cable.name);
            outside(what, distance / size, "", range, |_| format!("`{key}` of this cable in mm or cm given as m?"))
        };
        let attachment = far("attachment", "attachment_m", from_attachments, size, usual::ATTACHMENT_OVER_OTHERS);
        let anchor = || far("anchor", "anchor_m", from_anchors, anchors_size, usual::ANCHOR_OVER_OTHERS);
        if let Some(found) = attachment.or_else(anchor) {
            return Some(found);
        }
    }
    None
}

/// All cables at one anchor: slings from one hook, or a slip.
fn one_anchor(robot: &Robot, size: &Size) -> Option<Implausible> {
    let [first, _, ..] = &robot.cables[..] else { return None };
    let at = first.anchor.reference_w();
    (robot.rope_count() > 1 && size.anchors <= COINCIDE * at.norm()).then(|| Implausible::Odd {
        what: format!("all cables have one anchor, ({}, {}, {}) m", number(at.x), number(at.y), number(at.z)),
        slip:
            "a copied `anchor_m`? Slings from one hook have one, and the platform turns about the vertical through it \
               without resistance"
                .to_owned(),
    })
}

/// Attachments around the position of the platform in place of its origin.
fn attachments_in_world(robot: &Robot, size: &Size) -> Option<Implausible> {
    let State::Pose(pose) = &robot.state else { return None };
    let at = pose.position_w;
    let is_there = (size.middle_p - at).norm() < size.attachments;
    (is_there && size.middle_p.norm() > 2.0 * size.attachments).then(|| Implausible::Odd {
        what: format!(
            "the attachments are around ({:.3}, {:.3}, {:.3}) m, which is the position of the platform in the world",
            size.middle_p.x, size.middle_p.y, size.middle_p.z
        ),
        slip:
            "attachments given in the world frame? They belong in the platform frame, whose origin is at `position_m`"
                .to_owned(),
    })
}

fn anchors(size: &Size) -> Option<Implausible> {
    outside("distance of the farthest anchor from the middle of all", size.anchors, "m", usual::ANCHORS, |_| {
        let ratio = size.attachments / size.anchors;
        if size.attachments > 0.0 && ratio < 5.0 * usual::ATTACHMENTS_OVER_ANCHORS[0] {
            "anchors in mm or cm given as m?".to_owned()
        } else {
            "lengths of the robot in mm or cm given as m?".to_owned()
        }
    })
}

/// Attachments against anchors.
fn attachments(robot: &Robot, size: &Size) -> Option<Implausible> {
    let ratio = size.attachments / size.anchors;
    // One anchor for all cables, or attachments at one point.
    if size.anchors == 0.0 || size.attachments == 0.0 {
        return None;
    }

    if ratio > usual::SLINGS && size.attachments < reach(robot) {
        return None;
    }

    let what = "size of the attachments over that of the anchors";
    outside(what, ratio, "", usual::ATTACHMENTS_OVER_ANCHORS, |value| {
        let [low, high] = usual::ATTACHMENTS_OVER_ANCHORS;
        if value.is_too_large() {
            likely(
                value,
                [5.0 * low, 0.5 * high],
                &[
                    (1e-3, "attachments in mm given as m"),
                    (1e-2, "attachments in cm given as m"),
                    (ratio.powi(-2), "`anchor_m` and `attachment_m` swapped"),
                ],
            )
        } else {
            "anchors in mm or cm given as m?".to_owned()
        }
    })
}

/// Distance that the cables span at most: lengths, or distance of the anchors from the pose [m].
fn reach(robot: &Robot) -> f64 {
    match &robot.state {
        State::Lengths(lengths) => lengths.iter().copied().fold(0.0, f64::max),
        State::Pose(pose) => farthest(robot, &pose.position_w),
        State::Unknown => farthest(robot, &Vec3::zeros()),
    }
}

fn farthest(robot: &Robot, from: &Vec3) -> f64 {
    robot.cables.iter().map(|cable| (cable.anchor.reference_w() - from).norm()).fold(0.0, f64::max)
}

/// Pose or lengths against the anchors.
fn distance(robot: &Robot, size: &Size) -> Option<Implausible> {
    let unit = size.anchors + size.attachments;
    if unit == 0.0 {
        return None;
    }

    match &robot.state {
        State::Unknown => None,
        State::Pose(pose) => {
            let count = robot.cables.len() as f64;
            let middle: Vec3 = robot.cables.iter().map(|cable| cable.anchor.reference_w()).sum::<Vec3>() / count;
            let what = "distance of the platform from the middle of the anchors, over the size of the robot,";
            outside(what, (pose.position_w - middle).norm() / unit, "", usual::DISTANCE, |_| {
                "position in mm or cm given as m?".to_owned()
            })
        }
        State::Lengths(lengths) => {
            let longest = lengths.iter().copied().fold(0.0, f64::max);
            let what = "longest cable over the size of the robot";
            let long = outside(what, longest / unit, "", usual::DISTANCE, |_| {
                "unstrained lengths in mm or cm given as m?".to_owned()
            });
            long.or_else(|| {
                let value = (2.0 * longest + size.attachments) / size.anchors;
                let what = "length of two cables with the platform, over the size of the anchors,";
                outside(what, value, "", usual::MIN_LENGTH, |_| "unstrained lengths in km given as m?".to_owned())
            })
        }
    }
}

/// Minimum number of cables at which one that differs from all others by a sign is suspicious.
const MIN_CABLES: usize = 6;

/// Distance of points over their size below which they coincide, and difference of coordinates over their magnitude up
/// to which they are alike: a measured frame is not symmetric to more than a per cent.
const COINCIDE: f64 = 1e-9;
const ALIKE: f64 = 0.01;

/// Two cables, not more, with both ends at the same points. Pairs of parallel ropes come in greater numbers.
fn copied(robot: &Robot, size: &Size) -> Option<Implausible> {
    let cables = &robot.cables;
    if cables.len() < 3 || size.anchors == 0.0 || size.attachments == 0.0 {
        return None;
    }
    let same = |i: usize, j: usize| {
        let anchors = (cables[i].anchor.reference_w() - cables[j].anchor.reference_w()).norm();
        let attachments = (cables[i].attachment_p - cables[j].attachment_p).norm();
        anchors <= COINCIDE * size.anchors && attachments <= COINCIDE * size.attachments
    };
    let pairs: Vec<(usize, usize)> =
        (0..cables.len()).flat_map(|i| (0..i).map(move |j| (j, i))).filter(|&(j, i)| same(i, j)).collect();
    let [(j, i)] = pairs[..] else { return None };
    Some(Implausible::Odd {
        what: format!(
            "cables \"{}\" and \"{}\" have the same `anchor_m` and the same `attachment_m`",
            cables[j].name, cables[i].name
        ),
        slip: "a copied cable whose points were not changed?".to_owned(),
    })
}

/// Coordinates of one cable with another sign than those of the others.
fn signs(robot: &Robot, size: &Size) -> Vec<Implausible> {
    let cables = &robot.cables;
    if let Some(copied) = copied(robot, size) {
        return vec![copied];
    }
    if cables.len() < MIN_CABLES {
        return Vec::new();
    }
    let anchors: Vec<Vec3> = cables.iter().map(|cable| cable.anchor.reference_w()).collect();
    let attachments: Vec<Vec3> = cables.iter().map(|cable| cable.attachment_p).collect();

    // Two cables at one point, and all others at points of their own.
    let mut found = Vec::new();
    for (key, points, size) in [("anchor_m", &anchors, size.anchors), ("attachment_m", &attachments, size.attachments)]
    {
        let mut pairs = Vec::new();
        for (i, point) in points.iter().enumerate() {
            let at_it = (0..i).filter(|&j| (points[j] - point).norm() <= COINCIDE * size);
            pairs.extend(at_it.map(|j| (j, i)));
        }
        if let ([(j, i)], true) = (&pairs[..], size > 0.0) {
            found.push(Implausible::Odd {
                what: format!(
                    "cables \"{}\" and \"{}\" have the same `{key}`, and all others have points of their own",
                    cables[*j].name, cables[*i].name
                ),
                slip: format!("wrong sign of a coordinate, or a copied `{key}`?"),
            });
        }
    }

    // One anchor on the other side.
    for (k, axis) in ["x", "y", "z"].into_iter().enumerate() {
        for i in 0..cables.len() {
            let own = anchors[i][k];
            let others = || anchors.iter().enumerate().filter(|(j, _)| *j != i).map(|(_, point)| point[k]);
            let opposite = own != 0.0 && others().all(|other| other * own < 0.0);
            let alike = others().any(|other| (other + own).abs() <= ALIKE * own.abs());
            if opposite && alike {
                found.push(Implausible::Odd {
                    what: format!(
                        "the anchor of cable \"{}\" has {axis} = {own} m, and those of all other cables are on the \
                         other side of the origin, one of them equally far",
                        cables[i].name
                    ),
                    slip: "wrong sign of the coordinate?".to_owned(),
                });
            }
        }
    }
    found
}

/// Angle of the pose, as it was written, beyond a full turn. It changes neither the pose nor any size.
pub(super) fn full_turns(robot: &Robot) -> Option<Implausible> {
    let State::Pose(pose) = &robot.state else { return None };
    let written = robot.written_angles_deg;
    // Code may have set another pose since.
    if rotation::from_roll_pitch_yaw_deg(written[0], written[1], written[2]) != pose.rot_wp {
        return None;
    }

    ["roll", "pitch", "yaw"].into_iter().zip(written).find_map(|(name, degrees)| {
        outside(format!("{name} of the pose"), degrees, "degrees", usual::ANGLE, |_| {
            let left = degrees - 360.0 * (degrees / 360.0).round();
            format!(
                "an angle in degrees multiplied by 57.3 (180/π) as if it were in radians, or an angle in another unit? \
                 Without its full turns it is {} degrees",
                number(left)
            )
        })
    })
}

/// Difference of an angle from a multiple of 15° in radians up to which it counts as that: four decimals, rounded.
const ANGLE_DIGITS: f64 = 6e-5;

/// Angles of a pose that are round numbers in radians.
fn angles(robot: &Robot) -> Option<Implausible> {
    let State::Pose(pose) = &robot.state else { return None };
    let names = ["roll", "pitch", "yaw"].into_iter().zip(rotation::to_roll_pitch_yaw_deg(&pose.rot_wp));
    names.into_iter().find_map(|(name, degrees)| {
        let step = PI / 12.0;
        let multiple = (degrees / step).round();
        let is_round = (1.0..=24.0).contains(&multiple.abs()) && (degrees - multiple * step).abs() < ANGLE_DIGITS;
        is_round.then(|| Implausible::Odd {
            what: format!("{name} is {degrees:.4}°, which is {:.0}° in radians", 15.0 * multiple),
            slip: "angle in radians given in degrees?".to_owned(),
        })
    })
}

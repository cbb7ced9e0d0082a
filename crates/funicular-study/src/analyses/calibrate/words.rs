//! Weak combinations, the frame and lost directions in words.

use crate::columns::Style;
use crate::text::significant;
use funicular::calibration::{CalibrationFrame, CalibrationUnknown, CombinationPart, WeakCombination};
use funicular::math::Vec3;
use funicular::robot::Robot;

/// Names of the world axes.
const AXES: [&str; 3] = ["x", "y", "z"];

/// A world axis by its name, or a direction by its components.
fn direction(along_w: &Vec3) -> String {
    let axis = (0..3).find(|axis| *along_w == Vec3::ith(*axis, 1.0));
    let components = || along_w.map(|component| significant(component, 3)).as_slice().join(" ");
    axis.map_or_else(|| format!("[{}]", components()), |axis| AXES[axis].to_owned())
}

/// Part of a sentence about a combination whose deviation is known.
fn part(robot: &Robot, paths: &[String], (part, amount): &(CombinationPart, f64)) -> String {
    let cable = |cable: usize| robot.cables[cable].name.clone();
    let per_metre = |amount: f64| format!("{} mm/m", significant(1e3 * amount.abs(), 3));
    let millimetres = |amount: f64| format!("{} mm", significant(1e3 * amount.abs(), 3));
    let more = *amount > 0.0;
    match *part {
        CombinationPart::Stretch { along_w } => {
            let how = if more { "farther apart" } else { "closer together" };
            format!("all anchors {how} along {} by {}", direction(&along_w), per_metre(*amount))
        }
        CombinationPart::Shear { between_w: [a, b] } => {
            format!("all anchors sheared between {} and {} by {}", direction(&a), direction(&b), per_metre(*amount))
        }
        CombinationPart::CommonOffset => {
            format!("all offsets {} by {}", if more { "larger" } else { "smaller" }, millimetres(*amount))
        }
        CombinationPart::OffsetWithAnchor { cable: of } => format!(
            "anchor of cable {} {} and its offset {} by {}",
            cable(of),
            if more { "farther away" } else { "nearer" },
            if more { "larger" } else { "smaller" },
            millimetres(*amount)
        ),
        CombinationPart::ScaleOfReadings => {
            format!("the scale {} by {} of length", if more { "larger" } else { "smaller" }, millimetres(*amount))
        }
        CombinationPart::Factor { unknown } => {
            let how = if more { "larger" } else { "smaller" };
            format!("the {} {how} by {} %", paths[unknown], significant(100.0 * amount.abs(), 3))
        }
        CombinationPart::Single { unknown } => {
            format!("{} {} by {}", paths[unknown], if more { "larger" } else { "smaller" }, millimetres(*amount))
        }
    }
}

/// Weak combination in words, without its deviation.
pub(super) fn combination(robot: &Robot, paths: &[String], of: &WeakCombination) -> String {
    let sign = if of.parts.first().is_some_and(|(_, amount)| *amount < 0.0) { -1.0 } else { 1.0 };
    let parts: Vec<String> =
        of.parts.iter().map(|(kind, amount)| part(robot, paths, &(*kind, sign * amount))).collect();
    parts.join(", ")
}

/// Direction that no reading sees, in words.
pub(super) fn lost(robot: &Robot, paths: &[String], of: &WeakCombination) -> String {
    let words = combination(robot, paths, of);
    let without_amounts: Vec<&str> =
        words.split(", ").map(|part| part.rsplit_once(" by ").map_or(part, |(what, _)| what)).collect();
    without_amounts.join(", ")
}

/// Frame in words.
pub(super) fn frame(robot: &Robot, of: &CalibrationFrame) -> String {
    let name = |cable: &usize| robot.cables[*cable].name.clone();
    if of.motion_count() == 0 {
        return "the data fix the frame".to_owned();
    }
    if of.is_inner {
        return "inner: the sum of the variances of the anchors is least".to_owned();
    }
    let held: Vec<String> = of
        .held
        .iter()
        .zip(&of.held_coordinates)
        .map(|(cable, count)| match count {
            1 => format!("one coordinate of anchor {}", name(cable)),
            2 if robot_is_planar(robot) => format!("anchor {}", name(cable)),
            3 => format!("anchor {}", name(cable)),
            count => format!("{count} coordinates of anchor {}", name(cable)),
        })
        .collect();
    format!("held as in the file: {}", held.join(", "))
}

fn robot_is_planar(robot: &Robot) -> bool {
    matches!(robot.platform.motion, funicular::robot::PlatformMotion::Planar(_))
}

/// Path of an unknown and its unit.
pub(super) fn path(robot: &Robot, of: &CalibrationUnknown) -> (String, &'static str) {
    let axis = |axis: usize| AXES[axis];
    let cable = |cable: usize| funicular::robot::parameters::quoted_key(&robot.cables[cable].name);
    match *of {
        CalibrationUnknown::Anchor { cable: i, axis: k } => (format!("cables.{}.anchor_m.{}", cable(i), axis(k)), "m"),
        CalibrationUnknown::Attachment { cable: i, axis: k } => {
            (format!("cables.{}.attachment_m.{}", cable(i), axis(k)), "m")
        }
        CalibrationUnknown::Offset { cable: i } => (format!("offset of cable {}", cable(i)), "m"),
        CalibrationUnknown::Scale => ("scale".to_owned(), "1"),
        CalibrationUnknown::AxialStiffness => ("factor of the axial stiffness".to_owned(), "1"),
        CalibrationUnknown::Mass => ("factor of the mass".to_owned(), "1"),
        CalibrationUnknown::PulleyRadius { cable: i } => {
            let name = robot.cables[i].anchor.pulley.as_ref().map_or("", |pulley| pulley.name.as_str());
            (format!("pulleys.{}.radius_m", funicular::robot::parameters::quoted_key(name)), "m")
        }
        CalibrationUnknown::SupportStiffness => ("factor of the support stiffness".to_owned(), "1"),
    }
}

/// Range of numbers in words: ±17 to 34 mm.
pub(super) fn range_mm(values: &[f64]) -> String {
    let (low, high) = values.iter().fold((f64::MAX, 0.0_f64), |(low, high), value| (low.min(*value), high.max(*value)));
    let text = |value: f64| Style::Plain.significant(1e3 * value, 3);
    if values.is_empty() { "nothing".to_owned() } else { format!("±{} to ±{} mm", text(low), text(high)) }
}

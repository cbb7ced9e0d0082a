//! Warnings about a calibration: place, number, and what to do.

use super::reachable::none_left;
use super::report::{CalibrationReport, MAX_PROPOSALS};
use super::rows::{ReadingRow, Walk};
use super::wrong::misses;
use super::{Calibrated, in_mm};
use crate::text::{counted, significant};
use funicular::calibration::{OtherMinimum, WrongRow, encoder_of_other_sign};
use funicular::math::DMat;
use funicular::robot::{PlatformMotion, Robot};

/// Ratio of the deviations in the frame to those with inner conditions from which on the frame is a poor choice.
const POOR_FRAME: f64 = 3.0;

/// All warnings.
pub(super) fn warnings(of: &CalibrationReport, results: &Calibrated) -> Vec<String> {
    let mut warnings = Vec::new();
    warnings.extend(lost_rank(of));
    warnings.extend(results.walk.as_ref().filter(|_| !of.is_misfit()).and_then(curved));
    warnings.extend(exchanged_cables(of));
    warnings.extend(of.wrong.rows.iter().map(|row| outlier(of, &results.rows[row.row], Some(row))));
    // One row at a time: a wrong one makes others look wrong.
    if of.wrong.rows.is_empty() && of.wrong.columns.is_none() {
        let drop = |row: &ReadingRow| row.chi2_drop.unwrap_or_default();
        let outliers = results.rows.iter().filter(|row| row.outlier);
        let worst = outliers.max_by(|a, b| drop(a).total_cmp(&drop(b)));
        warnings.extend(worst.map(|row| outlier(of, row, None)));
    }
    warnings.extend(other_minima(of));
    warnings.extend(poor_frame(of));
    warnings.extend(stretch(of));
    warnings.extend(open_rows(of));
    warnings.extend(other_sign(of));
    warnings.extend(none_left(results));
    warnings.extend(not_reached(of, results));
    warnings
}

fn lost_rank(of: &CalibrationReport) -> Option<String> {
    let lost = of.precision.lost.len();
    (lost > 0).then(|| {
        format!(
            "{lost} of the combinations of values {} no effect on the readings at any of these poses: measure a pose \
             off the plane, line or conic of the others, turn the platform, or hold a value",
            if lost == 1 { "has" } else { "have" }
        )
    })
}

fn curved(walk: &Walk) -> Option<String> {
    if walk.is_parabola {
        return None;
    }
    let rises: Vec<String> = walk.chi2_rises.iter().map(|rise| significant(*rise, 3)).collect();
    Some(format!(
        "along the weakest combination χ² rises by {} at {} deviations instead of 1 and 4 at 1 and 2: noise may hide a \
         combination that these poses do not determine; no intervals are given; measure the proposed poses",
        rises.join(", "),
        walk.deviations.iter().map(|step| significant(*step, 1)).collect::<Vec<_>>().join(", ")
    ))
}

fn exchanged_cables(of: &CalibrationReport) -> Option<String> {
    let found = of.wrong.columns?;
    let [a, b] = found.cables.map(|cable| of.of.robot.cables[cable].name.as_str());
    Some(if of.of.is_point() {
        format!(
            "the figure of the anchors is that of the robot file with the names {a} and {b} exchanged: exchange their \
             columns, or check which motor drives which cable"
        )
    } else {
        format!(
            "with the readings of cables {a} and {b} exchanged, χ² falls from {} to {}: exchange their columns",
            significant(of.found.best.chi2, 3),
            significant(found.chi2, 3)
        )
    })
}

fn outlier(of: &CalibrationReport, row: &ReadingRow, wrong: Option<&WrongRow>) -> String {
    let remedy = wrong.and_then(|wrong| wrong.exchange).map_or_else(
        || format!("repeat the measurement, or leave the row out (⟪leave_out⟫ {})", row.row),
        |found| {
            let [a, b] = found.cables.map(|cable| of.of.robot.cables[cable].name.as_str());
            format!("with its readings of cables {a} and {b} exchanged it fits")
        },
    );
    format!(
        "row {} does not agree with the others: without it χ² falls by {}, noise gives up to {}; the values would move \
         by up to {}; {remedy}",
        row.row,
        significant(row.chi2_drop.unwrap_or_default(), 3),
        significant(row.chi2_limit, 3),
        in_mm(row.shift_m.unwrap_or_default())
    )
}

fn other_minima(of: &CalibrationReport) -> Option<String> {
    let best = &of.found.best;
    let image = of.found.others.iter().find(|other| !other.mirrored.is_empty());
    let other = image.or(of.found.others.first())?;
    let telling = of.of.telling_row(best, &other.fit).map(|row| {
        let place: Vec<String> = row.pose.position_w.iter().map(|x| significant(*x, 3)).collect();
        format!(
            "a row with the platform at {} m tells them apart: the readings of the two differ there by {} or more",
            place.join(", "),
            in_mm(row.difference)
        )
    });
    if let Some(image) = image {
        let (flat, where_rows_lie) =
            if of.of.translations_w().len() == 2 { ("line", "line on which") } else { ("plane", "plane in which") };
        let telling = telling.unwrap_or_else(|| format!("measure a row off this {flat}"));
        return Some(format!(
            "{} of values fit the readings, see `minima`: χ² {}, and {} with {} on the other side of the \
             {where_rows_lie} the rows lie; {telling}",
            counted(1 + of.found.others.len(), "set"),
            significant(best.chi2, 4),
            significant(image.fit.chi2, 4),
            anchors(of, image),
        ));
    }
    let telling = telling.unwrap_or_else(|| "measure more rows".to_owned());
    Some(format!(
        "another minimum fits as well: χ² {} beside {}, see `minima`; give poses at which the search begins; {telling}",
        significant(other.fit.chi2, 4),
        significant(best.chi2, 4)
    ))
}

fn anchors(of: &CalibrationReport, image: &OtherMinimum) -> String {
    let names: Vec<&str> = image.mirrored.iter().map(|cable| of.of.robot.cables[*cable].name.as_str()).collect();
    match names.as_slice() {
        [one] => format!("the anchor of cable {one}"),
        several => format!("the anchors of cables {}", several.join(", ")),
    }
}

fn poor_frame(of: &CalibrationReport) -> Option<String> {
    let root = |covariance: &DMat| covariance.trace().max(0.0).sqrt();
    let (here, inner) = (root(&of.precision.covariance), root(&of.frame.inner(&of.precision.covariance)));
    (here > POOR_FRAME * inner && of.precision.lost.is_empty()).then(|| {
        format!(
            "the frame makes the deviations {} times as large as those with inner conditions: its anchors are close \
             together or nearly in line; name others in ⟪frame⟫",
            significant(here / inner, 2)
        )
    })
}

/// Warning of stretch and sag that straight rigid cables do not have.
fn stretch(of: &CalibrationReport) -> Option<String> {
    if of.of.is_elastic() {
        return None;
    }
    let deviation = of.factor? * of.of.deviations.reading;
    let (stretch, tension) = elongation(&of.of.robot)?;
    (stretch > deviation).then(|| {
        format!(
            "cables are straight and rigid here. Under {} N they stretch or sag by about {}, which is more than the \
             deviation of the readings, {}: the part that all rows share goes into the found values, the rest into the \
             residuals. Correct the readings by measured tensions if you need the anchors more exactly than that",
            significant(tension, 3),
            in_mm(stretch),
            in_mm(deviation)
        )
    })
}

/// Usual change of a length by stretch and sag [m], with the tension [N]: the weight shared by the cables. `None` if
/// the cables do not carry the weight.
fn elongation(robot: &Robot) -> Option<(f64, f64)> {
    let gravity = robot.gravity_w;
    let carried = match &robot.platform.motion {
        PlatformMotion::Planar(plane) => (gravity - plane.normal_w() * gravity.dot(&plane.normal_w())).norm(),
        _ => gravity.norm(),
    };
    let tension = robot.platform.mass * carried / robot.cables.len().max(1) as f64;
    if tension <= 0.0 {
        return None;
    }
    let count = robot.cables.len() as f64;
    let mean = robot.cables.iter().map(|cable| cable.anchor.point_w).sum::<funicular::math::Vec3>() / count;
    let change = |cable: &funicular::robot::Cable| {
        let length = (cable.anchor.point_w - mean).norm();
        let weight = cable.material.mass_per_length * gravity.norm();
        tension * length / cable.material.axial_stiffness + length * (weight * length / tension).powi(2) / 24.0
    };
    Some((robot.cables.iter().map(change).fold(0.0, f64::max), tension))
}

fn open_rows(of: &CalibrationReport) -> Option<String> {
    let rows: Vec<String> = of.precision.open_rows.iter().map(|row| of.numbers[*row].to_string()).collect();
    (!rows.is_empty()).then(|| {
        format!(
            "the readings of rows {} do not fix the pose there, because cables lie in one plane or line with the \
             platform: these rows say nothing",
            rows.join(", ")
        )
    })
}

/// Warning of a wanted deviation that no number of candidates reaches.
fn not_reached(of: &CalibrationReport, results: &Calibrated) -> Option<String> {
    let wanted = of.request.wanted_std_m.filter(|_| results.poses_needed.is_none())?;
    Some(format!(
        "{MAX_PROPOSALS} of the candidates do not reach deviations of {}: offer poses that are farther apart or \
         turned, or more accurate readings",
        in_mm(wanted)
    ))
}

/// Warning of an encoder whose readings fall while its cable pays out.
fn other_sign(of: &CalibrationReport) -> Option<String> {
    if !misses(&of.judged()) || of.wrong.columns.is_some() || !of.wrong.rows.is_empty() {
        return None;
    }
    let (cable, chi2) = encoder_of_other_sign(of.of, &of.found.best, &of.frame)?;
    Some(format!(
        "with the readings of cable {} multiplied by −1, χ² falls from {} to {}: its encoder counts down while the \
         cable pays out; change the sign of its column",
        of.of.robot.cables[cable].name,
        significant(of.found.best.chi2, 3),
        significant(chi2, 3)
    ))
}

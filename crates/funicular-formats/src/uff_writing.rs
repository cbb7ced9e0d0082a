//! Writer of Universal Files: responses as datasets 58, mode shapes as datasets 55, their points as dataset 15.
//!
//! Nodes have coordinates in the platform frame. Directions of responses are world axes, as everywhere in a response;
//! mode shapes are in platform axes, as their nodes are, so that programs draw them on the points.

#[cfg(test)]
mod tests;

use crate::measurements::RESPONSE;
use anyhow::{Result, bail};
use funicular::math::Vec3;
use funicular::response::Quantity;
use funicular_study::NoSolution;
use funicular_study::analyses::frf::{Frf, PairRow};
use funicular_study::analyses::modes::Modes;
use funicular_study::signals::{Input, Output, Place};
use std::fmt::Write as _;

/// Relative error of an evenly spaced abscissa that a file may have by the six digits of its first value and step.
/// Beyond it all frequencies are written.
const MAX_STEP_ERROR: f64 = 1e-6;

/// Universal File of the responses of `frf`.
///
/// # Errors
/// A signal that is not at a point of the platform along an axis, or a value that is not finite.
pub fn frf_file(found: &Frf) -> Result<Vec<u8>> {
    if found.responses.iter().any(|pair| pair.real.iter().chain(&pair.imag).any(|value| !value.is_finite())) {
        return Err(NoSolution("a response is not finite, which a Universal File cannot hold".to_owned()).into());
    }
    // Each point is a node, in the order of first appearance; node 0 belongs to none.
    let mut points: Vec<[f64; 3]> = Vec::new();
    let mut node_of = |point_m: Option<[f64; 3]>| {
        let point = point_m.unwrap_or_default();
        let known = points.iter().position(|known| known.map(f64::to_bits) == point.map(f64::to_bits));
        1 + known.unwrap_or_else(|| {
            points.push(point);
            points.len() - 1
        })
    };

    let mut functions = String::new();
    for pair in &found.responses {
        let (input, output) = (Input::parse(&pair.input)?, Output::parse(&pair.output)?);
        let ends = [
            (node_of(pair.output_place.point_m), direction(&output.place, &output.name)?),
            (node_of(pair.input_place.point_m), direction(&input.place, &input.name)?),
        ];
        function(&mut functions, &found.robot, &found.frequency_hz, pair, output.quantity, ends);
    }
    Ok((units() + &nodes(&points) + &functions).into_bytes())
}

/// Universal File of the mode shapes of `modes`: the platform origin as node 1, the attachments behind it.
pub fn modes_file(found: &Modes) -> Vec<u8> {
    let points: Vec<[f64; 3]> = std::iter::once([0.0; 3]).chain(found.outline.attachments_m.iter().copied()).collect();
    let to_platform = found.outline.rot_wp.inverse();

    let mut out = units() + &nodes(&points);
    for (number, mode) in found.modes.iter().enumerate() {
        let [x, y, z, rx, ry, rz] = mode.shape;
        let (shift_p, turn_p) = (to_platform * Vec3::new(x, y, z), to_platform * Vec3::new(rx, ry, rz));
        out += "    -1\n    55\n";
        let _ = writeln!(out, "{}\n{}, mode {}\nNONE\nNONE\nNONE", text(&found.robot), mode.kind, number + 1);
        // Structural model; normal mode; six components; displacement; real; six values per node.
        let _ = writeln!(out, "{:10}{:10}{:10}{:10}{:10}{:10}", 1, 2, 3, 8, 2, 6);
        let _ = writeln!(out, "{:10}{:10}{:10}{:10}", 2, 4, 0, number + 1);
        let _ = writeln!(
            out,
            "{}{}{}{}",
            exponential(mode.frequency_hz, 13, 5),
            exponential(mode.modal_mass_kg, 13, 5),
            exponential(mode.damping_ratio, 13, 5),
            exponential(0.0, 13, 5)
        );
        for (node, point) in points.iter().enumerate() {
            let moved_p = shift_p + turn_p.cross(&Vec3::from(*point));
            let _ = writeln!(out, "{:10}", node + 1);
            let values = moved_p.iter().chain(turn_p.iter()).map(|value| exponential(*value, 13, 5));
            out.extend(values);
            out.push('\n');
        }
        out += "    -1\n";
    }
    out.into_bytes()
}

/// Direction 1 to 6 of a signal on the platform, with its sign.
fn direction(place: &Place, name: &str) -> Result<i64> {
    let Place::Platform { turns, direction_w } = place else {
        bail!(
            "{name} is not on the platform: a Universal File holds motions of platform points and forces on them; \
             write .csv or .json"
        );
    };
    let others_vanish = |axis: usize| (0..3).all(|k| k == axis || direction_w[k].abs() <= 0.0);
    let Some((axis, number)) = [(0, 1), (1, 2), (2, 3)].into_iter().find(|(axis, _)| others_vanish(*axis)) else {
        bail!("{name} is not along an axis, as a Universal File needs it: choose x, y or z, or write .csv or .json");
    };
    let number = number + if *turns { 3 } else { 0 };
    Ok(if direction_w[axis] < 0.0 { -number } else { number })
}

/// Dataset 164: SI units.
fn units() -> String {
    let factor = |value: f64| exponential(value, 25, 17).replace('E', "D");
    format!(
        "    -1\n   164\n{:10}{:>20}{:10}\n{one}{one}{one}\n{}\n    -1\n",
        1,
        "SI: Meter (newton)",
        2,
        factor(273.15),
        one = factor(1.0)
    )
}

/// Dataset 15: nodes from 1 on.
fn nodes(points: &[[f64; 3]]) -> String {
    let mut out = "    -1\n    15\n".to_owned();
    for (i, point) in points.iter().enumerate() {
        let _ = write!(out, "{:10}{:10}{:10}{:10}", i + 1, 0, 0, 1);
        out.extend(point.iter().map(|number| exponential(*number, 13, 5)));
        out.push('\n');
    }
    out + "    -1\n"
}

/// Appends a response as dataset 58 with complex numbers of thirteen digits.
fn function(
    out: &mut String,
    robot: &str,
    frequencies_hz: &[f64],
    pair: &PairRow,
    quantity: Quantity,
    [output, input]: [(usize, i64); 2],
) {
    let first = frequencies_hz.first().copied().unwrap_or_default();
    let count = frequencies_hz.len();
    let step = if count > 1 { (frequencies_hz[count - 1] - first) / (count - 1) as f64 } else { 0.0 };
    let rounded = |value: f64| exponential(value, 13, 5).trim().parse().unwrap_or(value);
    let (first_written, step_written): (f64, f64) = (rounded(first), rounded(step));
    let is_even = (frequencies_hz.iter().enumerate())
        .all(|(i, f)| (first_written + i as f64 * step_written - f).abs() <= MAX_STEP_ERROR * f.abs());
    let (first, step) = if is_even { (first, step) } else { (0.0, 0.0) };

    *out += "    -1\n    58\n";
    let _ =
        writeln!(out, "{}\nresponse of {} to {}\nNONE\nNONE\nNONE", text(robot), text(&pair.output), text(&pair.input));
    let _ = writeln!(
        out,
        "{RESPONSE:5}{:10}{:5}{:10} {:<10}{:10}{:4} {:<10}{:10}{:4}",
        0, 1, 0, "NONE", output.0, output.1, "NONE", input.0, input.1
    );
    let _ = writeln!(
        out,
        "{:10}{count:10}{:10}{}{}{}",
        6,
        i32::from(is_even),
        exponential(first, 13, 5),
        exponential(step, 13, 5),
        exponential(0.0, 13, 5)
    );
    let turns = [output.1.abs() > 3, input.1.abs() > 3];
    let (kind, label, unit) = match quantity {
        Quantity::Displacement => (8, "Displacement", if turns[0] { "rad" } else { "m" }),
        Quantity::Velocity => (11, "Velocity", if turns[0] { "rad/s" } else { "m/s" }),
        Quantity::Acceleration => (12, "Acceleration", if turns[0] { "rad/s^2" } else { "m/s^2" }),
    };
    let load = if turns[1] { ("Moment", "N m") } else { ("Force", "N") };
    for (kind, label, unit) in [(18, "Frequency", "Hz"), (kind, label, unit), (13, load.0, load.1), (0, "NONE", "NONE")]
    {
        let _ = writeln!(out, "{kind:10}{:5}{:5}{:5} {label:<20} {unit:<20}", 0, 0, 0);
    }

    let points = frequencies_hz.iter().zip(&pair.real).zip(&pair.imag);
    for (i, ((frequency, re), im)) in points.enumerate() {
        if !is_even {
            *out += &exponential(*frequency, 13, 5);
        }
        *out += &exponential(*re, 20, 12);
        *out += &exponential(*im, 20, 12);
        if !is_even || i % 2 == 1 || i + 1 == count {
            out.push('\n');
        }
    }
    *out += "    -1\n";
}

/// Text of a line: printable, without line ends, at most 80 characters.
fn text(text: &str) -> String {
    let line: String =
        funicular_study::text::clean(text).chars().map(|c| if c.is_ascii() { c } else { '?' }).take(80).collect();
    if line.is_empty() { "NONE".to_owned() } else { line }
}

/// Number as Fortran's format E writes it, with at least two digits in the exponent.
fn exponential(value: f64, width: usize, digits: usize) -> String {
    // `+ 0.0` makes a negative zero positive.
    let text = format!("{:.digits$e}", value + 0.0);
    let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let exponent: i32 = exponent.parse().unwrap_or_default();
    let sign = if exponent < 0 { '-' } else { '+' };
    format!("{:>width$}", format!("{mantissa}E{sign}{:02}", exponent.abs()))
}

#[cfg(test)]
mod number_tests {
    use super::*;

    #[test]
    fn numbers_have_the_width_and_the_exponent_of_fortran() {
        assert_eq!(exponential(-1.5e-3, 13, 5), " -1.50000E-03");
        assert_eq!(exponential(0.0, 13, 5), "  0.00000E+00");
        assert_eq!(exponential(-1.234_567_8e-100, 13, 5), "-1.23457E-100");
        assert_eq!(exponential(0.1, 20, 12), "  1.000000000000E-01");
    }
}

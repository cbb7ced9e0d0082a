//! Table of lengths as a C99 file that needs no library.

use super::{COORDINATES, Firmware, MAX_PREFIX, one_line};
use anyhow::Result;
use askama::Template;
use funicular::counted;
use funicular::robot::Cable;
use funicular_study::sweep::AXES;
use funicular_study::text::significant;

#[derive(Template)]
#[template(path = "lengths.c", escape = "none")]
struct CSource {
    /// Beginning of all names, and in capital letters that of macros.
    p: String,
    m: String,
    about: Vec<String>,
    cables: usize,
    axes: usize,
    terms: usize,
    degree: usize,
    /// Parameters of the functions, and their names alone.
    parameters: String,
    arguments: String,
    from: Vec<f64>,
    to: Vec<f64>,
    exponents: Vec<Vec<usize>>,
    coefficients: Vec<Vec<f64>>,
    /// Largest sum of the sizes of the coefficients of a cable [m].
    size: f64,
    /// Ends of the cables, less all that is fixed; attachments, if the platform turns.
    ends: Vec<[f64; 3]>,
    attachments: Vec<[f64; 3]>,
    turns: bool,
    /// Number of each coordinate of the pose among the variables, or its fixed value.
    position: Vec<Coordinate>,
    angles: Vec<Coordinate>,
    /// Variables of the box in the order of the axes, as numbers of axes.
    variables: Vec<usize>,
    shortest: f64,
    longest: f64,
    tests: Vec<Test>,
}

/// Coordinate of a pose.
enum Coordinate {
    Variable(usize),
    Fixed(f64),
}

struct Test {
    at: Vec<String>,
    lengths: Vec<String>,
}

/// Text of a table in C.
pub(super) fn text(of: &Firmware) -> Result<String> {
    let (table, sides) = (&of.table, of.table.pose_box.sides());
    let p = of.request.prefix.clone().unwrap_or_else(|| identifier(stem(of)));
    let names: Vec<String> = sides.iter().map(|side| COORDINATES[side.axis].to_owned()).collect();
    let (base, angles) = (table.pose_box.base(), table.pose_box.angles_deg());
    let coordinate = |axis: usize, fixed: f64| {
        let variable = sides.iter().position(|side| side.axis == axis);
        variable.map_or(Coordinate::Fixed(fixed), Coordinate::Variable)
    };

    // Fixed coordinates move the anchors.
    let turns = table.pose_box.turns();
    let end = |line: &funicular::length_table::StraightLine| {
        let mut end = line.anchor_w;
        if !turns {
            end -= base.rot_wp * line.attachment_p;
        }
        let is_fixed = |axis: usize| sides.iter().all(|side| side.axis != axis);
        std::array::from_fn(|axis| end[axis] - if is_fixed(axis) { base.position_w[axis] } else { 0.0 })
    };
    let tests = of.self_tests();
    let straight = |at: &Vec<f64>, cable: usize| table.lines[cable].length(&table.pose_box.pose(at));
    let all = || tests.iter().flat_map(|at| (0..table.lines.len()).map(move |cable| straight(at, cable)));
    let of_cable = |coefficients: &Vec<f64>| coefficients.iter().map(|c| c.abs()).sum::<f64>();
    let source = CSource {
        m: p.to_ascii_uppercase(),
        about: about(of),
        cables: table.lines.len(),
        axes: sides.len(),
        terms: table.basis.exponents().len(),
        degree: table.basis.degree(),
        parameters: names.iter().map(|name| format!("double {name}")).collect::<Vec<_>>().join(", "),
        arguments: names.join(", "),
        from: sides.iter().map(|side| side.from).collect(),
        to: sides.iter().map(|side| side.to).collect(),
        exponents: table.basis.exponents().to_vec(),
        coefficients: table.coefficients.clone(),
        size: table.coefficients.iter().map(of_cable).fold(0.0, f64::max),
        ends: table.lines.iter().map(end).collect(),
        attachments: table.lines.iter().map(|line| line.attachment_p.into()).collect(),
        turns,
        position: (0..3).map(|axis| coordinate(axis, base.position_w[axis])).collect(),
        angles: (3..6).map(|axis| coordinate(axis, angles[axis - 3])).collect(),
        variables: sides.iter().map(|side| side.axis).collect(),
        shortest: all().fold(f64::INFINITY, f64::min),
        longest: all().fold(0.0, f64::max),
        tests: tests.iter().map(|at| test(of, at)).collect(),

        p,
    };
    Ok(source.render()? + "\n")
}

fn test(of: &Firmware, at: &[f64]) -> Test {
    let lengths = (0..of.table.lines.len()).map(|cable| hexadecimal(of.table.length(cable, at)));
    Test { at: at.iter().copied().map(hexadecimal).collect(), lengths: lengths.collect() }
}

/// Lines of the comment at the head.
fn about(of: &Firmware) -> Vec<String> {
    let table = &of.table;
    let mut lines = vec![
        format!("Unstrained lengths of the cables of {}", comment(&of.robot.name)),
        format!("Robot file: {}, CRC-32 {}", comment(&of.request.robot.name), of.checksum()),
    ];
    lines.extend(of.changes().iter().map(|change| format!("Changed: {}", comment(change))));
    lines.push(format!("Written by funicular {}: `funicular export --to c`", env!("CARGO_PKG_VERSION")));
    lines.push(String::new());
    lines.push(format!(
        "Static model: {}; rule of the tensions: {}",
        of.static_model(),
        of.rule.unwrap_or("none, the tensions follow from the pose")
    ));
    lines.push(format!("Mass of the platform: {} kg", of.robot.platform.mass));
    lines.push("Cables: number, name, limits of the tension".to_owned());
    lines.extend(of.robot.cables.iter().enumerate().map(|(i, cable)| format!("  {i}: {}", in_words(cable))));
    lines.push(String::new());
    lines.push("Box of poses:".to_owned());
    for side in table.pose_box.sides() {
        let unit = if side.axis < 3 { "m" } else { "degrees" };
        lines.push(format!("  {} from {} to {} {unit}", AXES[side.axis], side.from, side.to));
    }
    lines.push(fixed(of));
    lines.push(String::new());
    lines.extend(accuracy(of));
    lines
}

/// Line about the coordinates that are fixed.
fn fixed(of: &Firmware) -> String {
    let pose_box = &of.table.pose_box;
    let (position, angles) = (pose_box.base().position_w, pose_box.angles_deg());
    let is_fixed = |axis: &usize| pose_box.sides().iter().all(|side| side.axis != *axis);
    let value = |axis: usize| if axis < 3 { position[axis] } else { angles[axis - 3] };
    let each = (0..6).filter(is_fixed).map(|axis| format!("{} = {}", COORDINATES[axis], significant(value(axis), 9)));
    let each: Vec<String> = each.collect();
    if each.is_empty() {
        "  all six coordinates have a range".to_owned()
    } else {
        format!("  fixed: {}", each.join(", "))
    }
}

/// Lines about the error and about what changes it.
fn accuracy(of: &Firmware) -> Vec<String> {
    let table = &of.table;
    let mm = |metres: f64| significant(1e3 * metres, 3);
    let places = table.pose_box.sides().iter().zip(&table.error_at.1);
    let at: Vec<String> =
        places.map(|(side, value)| format!("{} = {}", COORDINATES[side.axis], significant(*value, 4))).collect();
    let numbers = table.coefficients.len() * table.basis.exponents().len();
    let by = |change: Option<f64>| {
        change.map_or("a pose of the box is no longer held".to_owned(), |metres| format!("up to {} mm", mm(metres)))
    };
    vec![
        format!("Total degree {}: {numbers} coefficients, {} bytes as float", table.basis.degree(), 4 * numbers),
        format!("Corrections of straight lengths: {} to {} mm", mm(table.corrections[0]), mm(table.corrections[1])),
        format!("Tolerance: {} mm", mm(of.tolerance)),
        format!("Largest error seen: {} mm, cable {}, at {}", mm(table.error), table.error_at.0, at.join(", ")),
        format!(
            "  at {} to which the polynomials were not fitted; they were fitted to {}",
            counted(table.tested, "pose"),
            counted(table.fitted, "pose")
        ),
        format!("10 % more axial stiffness EA of all ropes changes lengths by: {}", by(table.by_stiffness)),
        format!("10 % more mass per length of all ropes changes lengths by: {}", by(table.by_mass)),
    ]
}

/// Name and limits of a cable.
fn in_words(cable: &Cable) -> String {
    let limits = cable.limits();
    let minimum = limits.minimum.map_or("2.5 times its weight".to_owned(), |newtons| format!("{newtons} N"));
    let maximum = limits.maximum.map_or("no maximum".to_owned(), |newtons| format!("{newtons} N"));
    format!("{}, {minimum} to {maximum}", comment(&cable.name))
}

/// Text of the user in a comment: one line of letters, digits and signs that neither end a comment nor begin one, and
/// that no preprocessor reads.
fn comment(text: &str) -> String {
    let kept = |c: char| if c.is_alphanumeric() || matches!(c, ' '..='~') { c } else { '_' };
    let text: String = one_line(text).chars().map(kept).collect();
    text.replace("*/", "* /").replace("/*", "/ *").replace("??", "? ?").replace('\\', "/")
}

/// Name of the robot file without folder and ending, or else that of the robot.
fn stem<'a>(of: &'a Firmware) -> &'a str {
    let file = of.request.robot.name.rsplit(['/', '\\']).next().unwrap_or_default();
    let stem = file.split('.').next().unwrap_or_default();
    // Standard input is no file.
    if !file.starts_with('<') && stem.contains(|c: char| c.is_ascii_alphanumeric()) { stem } else { &of.robot.name }
}

/// Beginning of names in C from the name of a robot: its letters without accents and digits in small letters, all else
/// as underscores.
fn identifier(name: &str) -> String {
    let mut out = String::new();
    for c in name.chars() {
        if c.is_ascii_alphanumeric() {
            out.push(c.to_ascii_lowercase());
        } else if !out.is_empty() && !out.ends_with('_') {
            out.push('_');
        }
        if out.len() == MAX_PREFIX {
            break;
        }
    }
    let out = out.trim_end_matches('_');
    match out.chars().next() {
        None => "robot".to_owned(),
        Some(first) if first.is_ascii_digit() => format!("robot_{out}"),
        Some(_) => out.to_owned(),
    }
}

/// Number as a hexadecimal constant of C99, with every bit.
fn hexadecimal(value: f64) -> String {
    const MANTISSA: u64 = (1 << 52) - 1;
    let bits = value.to_bits();
    let sign = if value.is_sign_negative() { "-" } else { "" };
    let (exponent, mantissa) = (bits >> 52 & 0x7ff, bits & MANTISSA);
    match exponent {
        0 if mantissa == 0 => format!("{sign}0x0p+0"),
        0 => format!("{sign}0x0.{mantissa:013x}p-1022"),
        _ => format!("{sign}0x1.{mantissa:013x}p{:+}", exponent.cast_signed() - 1023),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hexadecimal_numbers_are_those_of_printf() {
        for (value, written) in [
            (1.0, "0x1.0000000000000p+0"),
            (-0.1, "-0x1.999999999999ap-4"),
            (9.75, "0x1.3800000000000p+3"),
            (0.0, "0x0p+0"),
            (5e-324, "0x0.0000000000001p-1022"),
        ] {
            assert_eq!(hexadecimal(value), written);
        }
    }

    #[test]
    fn names_of_robots_become_identifiers_and_comments() {
        for (name, identified) in [
            ("CoGiRo, LIRMM", "cogiro_lirmm"),
            ("4 \"mm\" */ robot", "robot_4_mm_robot"),
            ("__x", "x"),
            ("Käfig", "k_fig"),
            ("索", "robot"),
            ("", "robot"),
        ] {
            assert_eq!(identifier(name), identified);
        }
        assert!(identifier(&"ab ".repeat(100)).len() <= MAX_PREFIX);
        assert_eq!(comment("a*/b/*c??/\\\n\u{202e}ü"), "a* /b/ *c? ?// _ü");
    }
}

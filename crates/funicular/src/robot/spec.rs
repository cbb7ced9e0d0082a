//! The robot file: TOML text in, a validated [`Robot`] out, or errors that point into the text.
//!
//! The file is read as a tree of values with their places ([`toml::de::DeTable`]), not through derived types. So one
//! reading reports every error at the value that caused it, and an unknown key is compared with the known ones.
//!
//! [`TABLES`] lists every key with its unit, range, default and meaning; docs/robot-file.md is made from it.
//!
//! Every number is finite and at most 1e12 in magnitude; a quantity that has to be positive is at least 1e-12. No robot
//! comes near these limits, and within them no product in the analyses overflows.

mod bodies;
mod cables;
mod drives;
mod guide_wheels;
mod issue;
pub mod key;
mod limits;
mod materials;
mod platform;
pub(super) mod range;
mod read;
mod required;
mod ropes;
mod stl;
mod supports;
mod tensor;
mod winch_limits;
mod winches;
mod wind;

use super::{Cable, Load, Platform, PlatformMotion, Pose, Robot, State, Support};
use crate::math::Vec3;
use bodies::Bodies;
use cables::CableEntry;
pub use issue::{Issue, SpecError};
use key::{Absent, Key, KeyValue, Shape, Table};
use range::Range;
use read::{DECIMAL_POINT, Reader, Section, is_zero};
pub(super) use read::{Numbers, TOP, parsed};
use toml::de::DeTable;

/// Default gravity [m/s²]: the rounded standard value, used by the publications that the results are compared with.
const DEFAULT_GRAVITY: [f64; 3] = [0.0, 0.0, -9.81];

/// Keys at the top of the file.
const ROOT: &[Key] = &[
    Key::other("name", r#"name = "my robot""#, KeyValue::Name, "name of the robot"),
    Key::other("source", r#"source = "author, year, table""#, KeyValue::Text, "source of the numbers")
        .without(Absent::Means("empty")),
    Key::numeric(
        Shape::Vector,
        "gravity_m_s2",
        "gravity_m_s2 = [0.0, 0.0, -9.81]",
        "m/s²",
        Range::Any,
        "acceleration of gravity, world axes",
    )
    .or(DEFAULT_GRAVITY),
    Key::other("platform", "[platform]", KeyValue::Table, "moving platform"),
    Key::other("materials", "[materials.rope]", KeyValue::NamedTables, "ropes, one or more, each with a name"),
    Key::other("pulleys", "[pulleys.wheel]", KeyValue::NamedTables, "pulleys that cables refer to, each with a name")
        .without(Absent::Means("no pulleys")),
    Key::other("winches", "[winches.drum]", KeyValue::NamedTables, "winches that cables refer to, each with a name")
        .without(Absent::Means("no winches: all cables end at their anchors")),
    Key::other(
        "guide_wheels",
        "[guide_wheels.post]",
        KeyValue::NamedTables,
        "guide wheels with inertia between winches and entry points, each with a name",
    )
    .without(Absent::Means("guide wheels without inertia: their effect is that of the length of the drum side")),
    Key::other(
        "supports",
        "[supports.post]",
        KeyValue::NamedTables,
        "flexible supports that the anchors of cables refer to, each with a name",
    )
    .without(Absent::Means("rigid supports: all anchors are fixed")),
    Key::other("cables", "[[cables]]", KeyValue::Tables, "cables, one or more"),
    Key::other("loads", "[loads]", KeyValue::Table, "load on the platform besides its weight, fixed in the world")
        .without(Absent::Means("no load")),
    Key::other("required", "[required]", KeyValue::Table, "loads that the robot has to bear at every pose")
        .without(Absent::Means("only the dead load is required")),
    Key::other(
        "required_loads",
        "[[required_loads]]",
        KeyValue::Tables,
        "further required loads, of which any one may act in addition to those of [required]",
    )
    .without(Absent::Means("none")),
    Key::other(
        "platform_bodies",
        "[platform_bodies.frame]",
        KeyValue::NamedTables,
        "bodies that move with the platform, each with a name: what cables and obstacles must not touch",
    )
    .without(Absent::Means("the convex hull of the attachments")),
    Key::other(
        "obstacles",
        "[obstacles.column]",
        KeyValue::NamedTables,
        "bodies that stand in the world, each with a name: what cables and platform must not touch",
    )
    .without(Absent::Means("no obstacles")),
    Key::other(
        "clearance",
        "[clearance]",
        KeyValue::Table,
        "distances that cables, platform and obstacles keep from each other",
    )
    .without(Absent::Means("none, and poses are judged by distances only if the file has obstacles or bodies")),
    Key::other(
        "wind",
        "[wind]",
        KeyValue::Table,
        "steady and uniform wind, on ropes with a `drag_coefficient` and on platforms with a `drag_area_m2`",
    )
    .without(Absent::Means("still air")),
    Key::other(
        "state",
        "[state]",
        KeyValue::Table,
        "pose of the platform, from which the unstrained lengths follow; refused if the cables have lengths",
    )
    .without(Absent::Means("the pose follows from the unstrained lengths of the cables, or is given to a command")),
];

/// Keys of `[loads]`.
const LOADS: &[Key] = &[
    Key::numeric(
        Shape::Vector,
        "force_n",
        "force_n = [0.0, 0.0, -50.0]",
        "N",
        Range::Any,
        "force on the platform, world axes",
    )
    .or([0.0; 3]),
    Key::numeric(
        Shape::Vector,
        "moment_n_m",
        "moment_n_m = [0.0, 0.0, 2.0]",
        "N m",
        Range::Any,
        "moment on the platform, world axes",
    )
    .or([0.0; 3]),
    Key::numeric(
        Shape::Vector,
        "point_m",
        "point_m = [0.0, 0.0, -0.1]",
        "m",
        Range::Any,
        "point at which the force acts, platform frame",
    )
    .or([0.0; 3]),
];

/// Keys of `[state]`.
const STATE: &[Key] = &[
    Key::numeric(
        Shape::Vector,
        "position_m",
        "position_m = [0.0, 0.0, 1.0]",
        "m",
        Range::Any,
        "origin of the platform frame in the world frame",
    ),
    Key::numeric(
        Shape::Angles,
        "roll_pitch_yaw_deg",
        "roll_pitch_yaw_deg = [0.0, 0.0, 0.0]",
        "degrees",
        Range::Any,
        "orientation of the platform, R = Rz(yaw) Ry(pitch) Rx(roll)",
    )
    .or([0.0; 3]),
];

/// Every table of the robot file, with its keys in the order of the documentation.
pub const TABLES: &[Table] = &[
    Table { header: TOP, keys: ROOT },
    Table { header: "[platform]", keys: platform::KEYS },
    Table { header: "[materials.NAME]", keys: materials::KEYS },
    Table { header: "[pulleys.NAME]", keys: drives::PULLEY },
    Table { header: "[winches.NAME]", keys: winches::WINCH },
    Table { header: "[guide_wheels.NAME]", keys: guide_wheels::GUIDE_WHEEL },
    Table { header: "[supports.NAME]", keys: supports::SUPPORT },
    Table { header: "[[cables]]", keys: cables::KEYS },
    Table { header: "[loads]", keys: LOADS },
    Table { header: "[required]", keys: required::REQUIRED },
    Table { header: "[[required_loads]]", keys: LOADS },
    Table { header: "[platform_bodies.NAME]", keys: bodies::BODY },
    Table { header: "[obstacles.NAME]", keys: bodies::BODY },
    Table { header: "[clearance]", keys: bodies::CLEARANCE },
    Table { header: "[wind]", keys: wind::KEYS },
    Table { header: "[state]", keys: STATE },
];

/// Table of the keys before the first header of the file, `platform` and the other tables among them.
pub fn top_of_file() -> &'static Table {
    &TABLES[0]
}

impl Robot {
    /// Reads a robot file (TOML; [`TABLES`] lists the keys).
    ///
    /// `text` may begin with a byte-order mark and may have either kind of line end.
    ///
    /// # Errors
    ///
    /// [`SpecError`] with every issue that one reading finds, each with its place in `text`.
    ///
    /// # Example
    ///
    /// ```
    /// use funicular::robot::{Robot, State};
    ///
    /// let text = r#"
    ///     name = "pendulum"
    ///     [platform]
    ///     mass_kg = 2.0
    ///     motion = "point-mass"
    ///     [materials.steel]
    ///     youngs_modulus_pa = 100e9
    ///     area_m2 = 1e-5
    ///     mass_kg_per_m = 0.08
    ///     [[cables]]
    ///     name = "only"
    ///     material = "steel"
    ///     anchor_m = [0.0, 0.0, 3.0]
    ///     unstrained_length_m = 2.0
    /// "#;
    /// let robot = Robot::from_toml(text)?;
    /// assert!((robot.cables[0].material.axial_stiffness - 1e6).abs() < 1e-6); // N
    /// assert_eq!(robot.state, State::Lengths(vec![2.0])); // m
    ///
    /// let error = Robot::from_toml(&text.replace("mass_kg = 2.0", "mass_kg = -2.0")).unwrap_err();
    /// assert_eq!(error.to_string(), "line 4, column 15: `mass_kg` is -2.0, it must be positive");
    /// # Ok::<(), funicular::robot::spec::SpecError>(())
    /// ```
    pub fn from_toml(text: &str) -> Result<Self, SpecError> {
        match DeTable::parse(text) {
            Ok(root) => from_tree(text, root.get_ref(), Numbers::default()),
            Err(error) => {
                let mut reader = Reader::new(text);
                // Only the first error: after a syntax error the parser guesses, and its further errors mislead.
                let message = format!("the file is not valid TOML: {}", error.message());
                let issue = reader.issue(error.span().unwrap_or(0..0), message);
                if has_decimal_comma(text, error.span()) {
                    issue.help(DECIMAL_POINT);
                } else if error.message().contains("must be quoted") {
                    // The parser gives this message for every invalid value, `10 kg` and `4 * 1e-3` among them.
                    issue.help("a value is one number without its unit, text in quotes, or an array in brackets");
                }
                Err(SpecError::new(text, reader.issues))
            }
        }
    }
}

/// True if the parser stopped at a comma between two digits, as in `60,0`.
fn has_decimal_comma(text: &str, span: Option<std::ops::Range<usize>>) -> bool {
    let Some(at) = span.map(|span| span.start) else { return false };
    let is_digit = |byte: Option<&u8>| byte.is_some_and(u8::is_ascii_digit);
    let bytes = text.as_bytes();
    // The parser points at the comma or, for some values, at the number before it.
    let first = at.saturating_sub(1).max(1);
    let line_end = text.get(at..).and_then(|rest| rest.find(['\n', '#'])).map_or(bytes.len(), |length| at + length);
    let end = line_end.min(at + 40);
    let comma = (first..end).find(|i| bytes[*i] == b',');
    comma.is_some_and(|i| is_digit(bytes.get(i - 1)) && is_digit(bytes.get(i + 1)))
}

/// Robot of a parsed text, with numbers beside its tree.
///
/// # Errors
/// [`SpecError`], as [`Robot::from_toml`]. It points into the text; its messages show the numbers that replace
/// those of the text.
pub(super) fn from_tree(text: &str, root: &DeTable, numbers: Numbers) -> Result<Robot, SpecError> {
    let mut reader = Reader::with(text, numbers);
    if root.is_empty() {
        reader
            .issue(0..0, "the file describes no robot: it has no keys")
            .help("a robot file has a `name` and the tables [platform], [materials.NAME] and [[cables]]");
    }
    let robot = if root.is_empty() { None } else { read_robot(&mut reader, root) };
    match robot {
        Some(robot) if reader.issues.is_empty() => Ok(robot),
        _ => Err(SpecError::new(text, reader.issues)),
    }
}

/// Reads the complete file. `None`, here and at every early end, means that an issue has been reported.
fn read_robot(reader: &mut Reader, table: &DeTable) -> Option<Robot> {
    let root = reader.open(TOP, 0..0, table, ROOT);

    let name = reader.required(&root, "name").and_then(|value| reader.name("name", value));
    let source = match root.get("source") {
        Some(value) => reader.prose("source", value),
        None => Some(String::new()),
    };
    let gravity = reader.vector_or_default(&root, "gravity_m_s2");

    let motion = platform::motion(reader, &root);
    let platform = platform::read(reader, &root, motion);
    let load = read_load(reader, &root, motion);
    let required = required::read(reader, &root, motion, LOADS);
    let bodies = bodies::read(reader, &root, motion);
    let (wind, turbulence) = wind::read(reader, &root);
    let materials = materials::read(reader, &root);
    let drives = drives::read(reader, &root);
    let supports = supports::read(reader, &root);
    let cables = cables::read(reader, &root, materials.as_ref(), (&drives, supports.as_ref()), motion);
    let state_and_angles = read_state(reader, &root, cables.as_deref(), motion);
    let ropes = cables.as_deref().map(|cables| ropes::of(reader, cables));

    let cables = cables?.into_iter().map(|entry| Some((entry.cable?, entry.support))).collect::<Option<Vec<_>>>()?;
    let (state, written_angles_deg) = state_and_angles?;
    let (cables, supports) = on_supports(cables, supports?);
    let size = size_of(&cables, &state);
    refuse_huge_wheels(reader, table, &cables, &state, size);
    let Bodies { obstacles, parts, clearance } = bodies?;
    let robot = Robot {
        name: name?,
        source: source?,
        gravity_w: Vec3::from(gravity?),
        platform: Platform { bodies: parts, ..platform? },
        load: load?,
        required: required?,
        wind: wind?,
        turbulence: turbulence?,
        supports,
        obstacles,
        clearance,
        cables,
        ropes: ropes?,
        state,
        written_angles_deg,
    };
    bodies::check_places(reader, &root, &robot, size);
    Some(robot)
}

/// Cables with the supports of their anchors, and the supports by name. A support without anchors is left out.
fn on_supports(cables: Vec<(Cable, Option<String>)>, named: read::Named<Support>) -> (Vec<Cable>, Vec<Support>) {
    let is_used = |name: &str| cables.iter().any(|(_, support)| support.as_deref() == Some(name));
    let supports: Vec<Support> = named.into_values().flatten().filter(|support| is_used(&support.name)).collect();
    let with_support = |(mut cable, support): (Cable, Option<String>)| {
        cable.anchor.support = support.and_then(|name| supports.iter().position(|support| support.name == name));
        cable
    };
    (cables.into_iter().map(with_support).collect(), supports)
}

/// Radius above which a wheel is refused if the platform may be far from the anchors [m]. No wheel of a rope is so
/// large.
const LARGEST_WHEEL: f64 = 100.0;

/// Size of a robot [m]: the largest distance between two anchors, from an anchor to the platform, or along a cable.
fn size_of(cables: &[Cable], state: &State) -> f64 {
    let platform_w = if let State::Pose(pose) = state { Some(pose.position_w) } else { None };
    let lengths: &[f64] = if let State::Lengths(lengths) = state { lengths } else { &[] };
    let points: Vec<Vec3> = cables.iter().map(|cable| cable.anchor.point_w).chain(platform_w).collect();
    let between = points.iter().flat_map(|one| points.iter().map(move |other| (other - one).norm()));
    between.chain(lengths.iter().copied()).fold(0.0, f64::max)
}

/// Refuses wheels of pulleys that are larger than the robot of a size [m].
fn refuse_huge_wheels(reader: &mut Reader, root: &DeTable, cables: &[Cable], state: &State, size: f64) {
    // Without a state, the anchors do not tell how long the cables are.
    let least = if matches!(state, State::Unknown) { LARGEST_WHEEL } else { 0.0 };

    let mut named: Vec<&str> = Vec::new();
    for pulley in cables.iter().filter_map(|cable| cable.anchor.pulley.as_ref()) {
        let limit = size.max(least);
        let is_huge = limit > 0.0 && pulley.radius > limit;
        if !is_huge || named.contains(&pulley.name.as_str()) {
            continue;
        }
        named.push(&pulley.name);
        let tables = root.get("pulleys").and_then(|pulleys| pulleys.get_ref().as_table());
        let own = tables.and_then(|pulleys| pulleys.get(pulley.name.as_str())?.get_ref().as_table());
        let span = own.and_then(|pulley| pulley.get("radius_m")).map_or(0..0, toml::Spanned::span);
        reader
            .issue(
                span,
                format!(
                    "`radius_m` of the wheel of [pulleys.{}] is {} m, larger than the robot: the largest distance of \
                     its anchors from each other and from its platform is {size:.4} m",
                    pulley.name, pulley.radius
                ),
            )
            .help("give the radius in metres; wheels of a few centimetres are usual");
    }
}

/// Reads `[loads]`: force, moment and point.
fn read_load(reader: &mut Reader, root: &Section, motion: Option<PlatformMotion>) -> Option<Load> {
    let Some(value) = root.get("loads") else { return Some(Load::default()) };
    let table = reader.table("loads", "[loads]", value)?;
    let section = reader.open("[loads]", value.span(), table, LOADS);

    let mut vector = |key: &str| match section.get(key) {
        Some(value) => {
            let vector = reader.vector(&section, key, value)?;
            if key != "force_n" && motion == Some(PlatformMotion::PointMass) && !is_zero(&vector) {
                reader
                    .issue(
                        value.span(),
                        format!("a point mass bears forces at its own point only, `{key}` must be absent"),
                    )
                    .help("remove the line, or set `motion = \"rigid\"` in [platform]");
                return None;
            }
            Some(Vec3::from(vector))
        }
        None => Some(Vec3::zeros()),
    };

    let (force, moment, point) = (vector("force_n"), vector("moment_n_m"), vector("point_m"));
    Some(Load { force_w: force?, moment_w: moment?, point_p: point? })
}

/// Reads `[state]` or the cables' lengths, and checks them against the geometry. Also returns the angles of `[state]`
/// as they are written [degrees].
fn read_state(
    reader: &mut Reader,
    root: &Section,
    cables: Option<&[CableEntry]>,
    motion: Option<PlatformMotion>,
) -> Option<(State, [f64; 3])> {
    let lengths = cables.map(|cables| cables::lengths(reader, cables));

    let Some(value) = root.get("state") else {
        let lengths = lengths??;
        let state = if lengths.is_empty() { State::Unknown } else { State::Lengths(lengths) };
        return Some((state, [0.0; 3]));
    };

    let table = reader.table("state", "[state]", value)?;
    let section = reader.open("[state]", value.span(), table, STATE);
    let position = reader.required(&section, "position_m").and_then(|v| reader.vector(&section, "position_m", v));
    let angles = match section.get("roll_pitch_yaw_deg") {
        Some(value) => {
            let angles = reader.vector(&section, "roll_pitch_yaw_deg", value);
            if motion == Some(PlatformMotion::PointMass) && angles.is_some_and(|angles| !is_zero(&angles)) {
                reader
                    .issue(value.span(), "a point mass has no orientation, `roll_pitch_yaw_deg` must be zero or absent")
                    .help("remove the line, or set `motion = \"rigid\"` in [platform]");
            }
            angles
        }
        None => Some([0.0; 3]),
    };

    if let Some(with_length) = cables.into_iter().flatten().find_map(|c| c.length_span.clone()) {
        reader
            .issue(value.span(), "the file gives both a pose and unstrained lengths, each fixes the other")
            .context(with_length, "a length is here")
            .help("remove [state], or remove every `unstrained_length_m`");
        return None;
    }

    let (position, angles) = (position?, angles?);
    let pose = Pose::new(position, angles);
    if let Some(Err(out)) = motion.map(|motion| motion.check(&pose)) {
        reader.issue(value.span(), format!("this pose is not in the plane: {out}"));
        return None;
    }
    cables::refuse_coincident_ends(reader, cables?, &pose);
    Some((State::Pose(pose), angles))
}

#[cfg(test)]
mod tests;

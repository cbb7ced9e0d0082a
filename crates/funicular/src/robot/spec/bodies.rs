//! `[obstacles.NAME]`, `[platform_bodies.NAME]` and `[clearance]`: what cables and platform must not touch.

use super::key::{Absent, Key, KeyValue, Shape};
use super::range::{MIN_POSITIVE, Range};
use super::read::{Named, Reader, Section, shortened};
use super::stl;
use crate::math::Vec3;
use crate::robot::{Body, Cable, ClosedMesh, PlatformMotion, Pose, RequiredClearance, Robot, Solid, State};
use base64::Engine;
use base64::prelude::BASE64_STANDARD;

/// Largest size of a mesh over the size of its robot: a hall has up to ten, and millimetres read as metres make even a
/// part of a fiftieth of the robot larger.
const LARGEST_MESH: f64 = 20.0;

/// Units of the numbers of an STL file, which does not say them.
const UNITS: &[(&str, &str)] = &[("m", "metres"), ("mm", "millimetres")];

/// Beginning of a mesh that stands in the robot file itself.
const IN_THE_FILE: &str = "data:model/stl";

/// Tables of obstacles, and of parts of the platform.
const OBSTACLES: &str = "obstacles";
const PARTS: &str = "platform_bodies";

/// Effect of an end of an axis that is left out.
const BY_TWO_POINTS: &str = "the body is placed by `position_m`; `from_m` and `to_m` stand together";

/// Keys of `[obstacles.NAME]` and `[platform_bodies.NAME]`.
pub(super) const BODY: &[Key] = &[
    Key::other("shape", r#"shape = "box""#, KeyValue::Word(Solid::WORDS), "shape of the body")
        .without(Absent::DefaultWord("box")),
    Key::numeric(
        Shape::Vector,
        "position_m",
        "position_m = [2.0, 0.0, 1.5]",
        "m",
        Range::Any,
        "origin of the body's own frame: for an obstacle in the world, for a part of the platform in its frame",
    )
    .or([0.0; 3]),
    Key::numeric(
        Shape::Angles,
        "roll_pitch_yaw_deg",
        "roll_pitch_yaw_deg = [0.0, 0.0, 30.0]",
        "degrees",
        Range::Any,
        "orientation of the body's own frame, R = Rz(yaw) Ry(pitch) Rx(roll)",
    )
    .or([0.0; 3]),
    Key::numeric(
        Shape::Vector,
        "from_m",
        "from_m = [0.0, 0.0, 8.0]",
        "m",
        Range::Any,
        "first end of the axis of a cylinder or a box, as of a guy wire or a beam, in the place of `position_m` and \
         `roll_pitch_yaw_deg`",
    )
    .without(Absent::Depends(BY_TWO_POINTS)),
    Key::numeric(
        Shape::Vector,
        "to_m",
        "to_m = [4.0, 3.0, 0.0]",
        "m",
        Range::Any,
        "second end of the axis of a cylinder or a box",
    )
    .without(Absent::Depends(BY_TWO_POINTS)),
    Key::numeric(Shape::Vector, "size_m", "size_m = [0.4, 0.4, 3.0]", "m", Range::Positive, "edges of a box")
        .without(Absent::Depends("required for a box without `from_m`, else refused")),
    Key::numeric(
        Shape::Number,
        "width_m",
        "width_m = 0.2",
        "m",
        Range::Positive,
        "width of a box with `from_m`: the level edge across its axis, along x if the box is upright",
    )
    .without(Absent::Depends("required for a box with `from_m`, else refused")),
    Key::numeric(
        Shape::Number,
        "height_m",
        "height_m = 0.3",
        "m",
        Range::Positive,
        "height of a box with `from_m`: the edge across its axis and its width",
    )
    .without(Absent::Depends("required for a box with `from_m`, else refused")),
    Key::numeric(Shape::Number, "diameter_m", "diameter_m = 0.4", "m", Range::Positive, "diameter of a cylinder")
        .without(Absent::Depends("required for a cylinder, else refused")),
    Key::numeric(Shape::Number, "length_m", "length_m = 3.0", "m", Range::Positive, "length of a cylinder")
        .without(Absent::Depends("required for a cylinder without `from_m`, else refused")),
    Key::other(
        "file",
        r#"file = "column.stl""#,
        KeyValue::Name,
        "STL file of a mesh, binary or text, relative to the folder of the robot file",
    )
    .without(Absent::Depends("required for a mesh, else refused")),
    Key::other("file_unit", r#"file_unit = "mm""#, KeyValue::Word(UNITS), "unit of the numbers of the STL file")
        .without(Absent::DefaultWord("m")),
];

/// Keys of `[clearance]`.
pub(super) const CLEARANCE: &[Key] = &[
    Key::numeric(
        Shape::Number,
        "cables_m",
        "cables_m = 0.02",
        "m",
        Range::NotNegative,
        "required distance between the surfaces of two cables",
    )
    .or([0.0; 3]),
    Key::numeric(
        Shape::Number,
        "platform_m",
        "platform_m = 0.02",
        "m",
        Range::NotNegative,
        "required distance between a cable and the platform",
    )
    .or([0.0; 3]),
    Key::numeric(
        Shape::Number,
        "obstacles_m",
        "obstacles_m = 0.05",
        "m",
        Range::NotNegative,
        "required distance of cables and platform from obstacles",
    )
    .or([0.0; 3]),
    Key::numeric(
        Shape::Number,
        "from_end_m",
        "from_end_m = 0.1",
        "m",
        Range::NotNegative,
        "length at the end of a cable that is not compared with what this end is mounted on: the platform, an obstacle \
         that is nearer than this to the anchor, or a cable whose same end is nearer than this",
    )
    .without(Absent::Means(
        "a tenth of the mean distance of the attachments from the platform origin; 0.1 m for a point mass",
    )),
];

/// Obstacles, parts of the platform, and the distances that they need.
pub(super) struct Bodies {
    pub(super) obstacles: Vec<Body>,
    pub(super) parts: Vec<Body>,
    pub(super) clearance: Option<RequiredClearance>,
}

/// Reads obstacles, parts of the platform and required distances.
pub(super) fn read(reader: &mut Reader, root: &Section, motion: Option<PlatformMotion>) -> Option<Bodies> {
    let mut named = |kind: &str, singular: &str| match root.get(kind) {
        Some(value) => reader.named_tables(kind, singular, value, BODY, read_one),
        None => Some(Named::new()),
    };
    let (obstacles, parts) = (named(OBSTACLES, "obstacle"), named(PARTS, "platform body"));
    let clearance = read_clearance(reader, root);

    let parts = parts?;
    let refused = match motion? {
        PlatformMotion::PointMass if !parts.is_empty() => {
            Some("a point mass has no extent: remove [platform_bodies], or set `motion = \"rigid\"`")
        }
        _ if parts.values().flatten().any(|body| body.solid == Solid::HalfSpace) => {
            Some("a platform cannot carry a half space: give its bodies as boxes, cylinders or meshes")
        }
        _ => None,
    };
    if let Some(message) = refused {
        reader.issue(root.get(PARTS).map_or(0..0, toml::Spanned::span), message);
        return None;
    }
    let all = |named: Named<Body>| named.into_values().collect::<Option<Vec<Body>>>();
    Some(Bodies { obstacles: all(obstacles?)?, parts: all(parts)?, clearance: clearance? })
}

/// Reads `[clearance]`. The outer `None` is a refused value; the inner one a file without the table.
#[expect(clippy::option_option, reason = "outside: refused, an issue is reported; inside: not given")]
fn read_clearance(reader: &mut Reader, root: &Section) -> Option<Option<RequiredClearance>> {
    let Some(value) = root.get("clearance") else { return Some(None) };
    let table = reader.table("clearance", "[clearance]", value)?;
    let section = reader.open("[clearance]", value.span(), table, CLEARANCE);
    let [cables, platform, obstacles] =
        ["cables_m", "platform_m", "obstacles_m"].map(|key| reader.number_or_default(&section, key));
    let from_end = match section.get("from_end_m") {
        Some(value) => Some(reader.number_of(&section, "from_end_m", value)?),
        None => None,
    };
    Some(Some(RequiredClearance { cables: cables?, platform: platform?, obstacles: obstacles?, from_end }))
}

/// Keys of a body that belong to some of the shapes only.
const OF_SHAPES: [&str; 9] =
    ["size_m", "from_m", "to_m", "width_m", "height_m", "diameter_m", "length_m", "file", "file_unit"];

/// Keys that say what the two ends of an axis say.
const OF_PLACE: [&str; 4] = ["position_m", "roll_pitch_yaw_deg", "size_m", "length_m"];

/// Reads a body.
fn read_one(reader: &mut Reader, name: &str, section: &Section) -> Option<Body> {
    let word = reader.word(section, "shape")?;
    let own: &[&str] = match word {
        "box" => &["size_m", "from_m", "to_m", "width_m", "height_m"],
        "cylinder" => &["diameter_m", "length_m", "from_m", "to_m"],
        "mesh" => &["file", "file_unit"],
        _ => &[],
    };
    let foreign = OF_SHAPES.into_iter().filter(|key| !own.contains(key));
    if let Some((key, value)) = first_of(section, foreign) {
        reader
            .issue(value.span(), format!("`{key}` does not go with `shape = \"{word}\"`"))
            .help("remove the line, or write the shape that it belongs to");
        return None;
    }
    if section.get("from_m").is_some() || section.get("to_m").is_some() {
        return between_points(reader, name, section, word);
    }
    if let Some((key, value)) = first_of(section, ["width_m", "height_m"].into_iter()) {
        reader
            .issue(value.span(), format!("`{key}` needs `from_m` and `to_m`, the ends of the axis of the box"))
            .help("give them, or the three edges as `size_m` with `position_m`");
        return None;
    }

    let position = reader.vector_or_default(section, "position_m");
    let angles = reader.vector_or_default(section, "roll_pitch_yaw_deg");
    let mut number = |key: &str| reader.required(section, key).and_then(|value| reader.number_of(section, key, value));
    let solid = match word {
        "cylinder" => {
            let (diameter, length) = (number("diameter_m"), number("length_m"));
            Solid::Cylinder { radius: 0.5 * diameter?, half_length: 0.5 * length? }
        }
        "half-space" => Solid::HalfSpace,
        "mesh" => Solid::Mesh(mesh(reader, section)?),
        _ => {
            let value = reader.required(section, "size_m")?;
            Solid::Box { half: Vec3::from(reader.vector(section, "size_m", value)?) * 0.5 }
        }
    };
    Some(Body { name: name.to_owned(), pose: Pose::new(position?, angles?), solid })
}

/// First of some keys that a table has.
fn first_of<'t>(
    section: &Section<'t>,
    mut keys: impl Iterator<Item = &'static str>,
) -> Option<(&'static str, &'t super::read::Value<'t>)> {
    keys.find_map(|key| Some((key, section.get(key)?)))
}

/// Reads a cylinder or a box whose axis has two given ends.
fn between_points(reader: &mut Reader, name: &str, section: &Section, word: &str) -> Option<Body> {
    if let Some((key, value)) = first_of(section, OF_PLACE.into_iter()) {
        reader
            .issue(value.span(), format!("`{key}` does not go with `from_m` and `to_m`, which place the body already"))
            .help("keep the two ends of the axis, or the place with its angles and lengths");
        return None;
    }
    let mut end = |key: &str| reader.required(section, key).and_then(|value| reader.vector(section, key, value));
    let (from, to) = (end("from_m"), end("to_m"));
    let mut number = |key: &str| reader.required(section, key).and_then(|value| reader.number_of(section, key, value));
    let across = if word == "cylinder" {
        number("diameter_m").map(|diameter| [diameter; 2])
    } else {
        let (width, height) = (number("width_m"), number("height_m"));
        width.and_then(|width| Some([width, height?]))
    };

    let (from, to) = (Vec3::from(from?), Vec3::from(to?));
    let length = (to - from).norm();
    if length < MIN_POSITIVE {
        let span = section.get("to_m").map_or(section.span.clone(), toml::Spanned::span);
        let message = format!("`from_m` and `to_m` of {} are the same point", section.label());
        reader.issue(span, message).help("give the two ends of the axis of the body");
        return None;
    }
    let [width, height] = across?;
    let solid = if word == "cylinder" {
        Solid::Cylinder { radius: 0.5 * width, half_length: 0.5 * length }
    } else {
        Solid::Box { half: Vec3::new(width, height, length) * 0.5 }
    };
    Some(Body { name: name.to_owned(), pose: Pose::between(&from, &to), solid })
}

/// Reads the mesh of a body.
fn mesh(reader: &mut Reader, section: &Section) -> Option<ClosedMesh> {
    let value = reader.required(section, "file")?;
    let text = reader.text("file", value)?;
    let scale = if reader.word(section, "file_unit")? == "mm" { 1e-3 } else { 1.0 };

    let Some(data) = text.strip_prefix(IN_THE_FILE) else {
        reader.issue(value.span(), format!("the mesh \"{}\" has not been read", shortened(&text))).help(
            "give the robot as a file, so that its meshes are found beside it, or write the STL file into the text as \
             \"data:model/stl;base64,…\"",
        );
        return None;
    };
    let (head, encoded) = data.split_once("base64,").unwrap_or((data, ""));
    let name = head.split(';').find_map(|part| part.strip_prefix("name=")).unwrap_or("in the file");
    // The place is that of the table: the line of the mesh is its whole content.
    let mut refuse = |message: &str, help: &str| {
        let message = format!("the mesh \"{}\" of {} {message}", shortened(name), section.label());
        reader.issue(section.span.clone(), message).help(help);
    };

    let Ok(bytes) = BASE64_STANDARD.decode(encoded) else {
        refuse("is no STL file: the text in the robot file is not base64", "write it as \"data:model/stl;base64,…\"");
        return None;
    };
    let corners = match stl::read(&bytes) {
        Ok(corners) => corners,
        Err(error) => {
            refuse(&format!("is no STL file: {error}"), "export it again as STL, binary or text");
            return None;
        }
    };
    let corner = |of: &[f32; 3]| Vec3::from(of.map(|number| f64::from(number) * scale));
    let triangles: Vec<[Vec3; 3]> = corners.iter().map(|triangle| [0, 1, 2].map(|k| corner(&triangle[k]))).collect();
    match ClosedMesh::of_triangles(&triangles) {
        Ok(mesh) => Some(mesh),
        Err(error) => {
            refuse(
                &error.to_string(),
                "repair it in the program that made it, or describe the body by boxes and cylinders",
            );
            None
        }
    }
}

/// Refuses meshes that are far larger than the robot of a size [m], and obstacles around an anchor or the platform.
pub(super) fn check_places(reader: &mut Reader, root: &Section, robot: &Robot, size: f64) {
    for (kind, bodies) in [(PARTS, &robot.platform.bodies), (OBSTACLES, &robot.obstacles)] {
        for body in bodies {
            let Solid::Mesh(mesh) = &body.solid else { continue };
            if size > 0.0 && mesh.size() > LARGEST_MESH * size {
                let message =
                    format!("the mesh of \"{}\" is {:.4} m large, and the robot {size:.4} m", body.name, mesh.size());
                let help = "if the file is in millimetres, add `file_unit = \"mm\"`";
                reader.issue(span_of(root, kind, &body.name), message).help(help);
                return;
            }
        }
    }

    for obstacle in &robot.obstacles {
        if let Some(what) = inside(obstacle, robot) {
            let message = format!("the obstacle \"{}\" is around {what}", obstacle.name);
            reader.issue(span_of(root, OBSTACLES, &obstacle.name), message).help(
                "a cable that begins inside an obstacle can never be free of it: make the obstacle smaller, or \
                 describe a room by half spaces, one for each wall",
            );
        }
    }
}

/// Part of the robot that an obstacle must not contain and does, in words.
fn inside(obstacle: &Body, robot: &Robot) -> Option<String> {
    // Anchors may lie in the surface of what carries them.
    let is_inside = |cable: &&Cable| obstacle.depth_inside(&cable.anchor.point_w) > robot.clearance_from_end();
    if let Some(cable) = robot.cables.iter().find(is_inside) {
        return Some(format!("the anchor of cable \"{}\"", cable.name));
    }
    let State::Pose(pose) = &robot.state else { return None };
    let around_platform = obstacle.depth_inside(&pose.position_w) > 0.0;
    around_platform.then(|| "the origin of the platform at the pose of [state]".to_owned())
}

/// Place of a body in the file.
fn span_of(root: &Section, kind: &str, name: &str) -> std::ops::Range<usize> {
    let table = root.get(kind).and_then(|value| value.get_ref().as_table()?.get(name));
    table.map_or(0..0, toml::Spanned::span)
}

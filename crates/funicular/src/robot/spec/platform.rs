//! `[platform]`: mass, motion, and an inertia tensor that a body can have.

use super::key::{Absent, Key, KeyValue, Shape};
use super::range::{MAX_MAGNITUDE, MIN_POSITIVE, Range};
use super::read::{Reader, Section, Value, is_zero, known, parsed, shortened};
use super::tensor::{self, rounded};
use crate::math::{Mat3, Vec3};
use crate::robot::{Plane, Platform, PlatformMotion};
use crate::suggest::nearest;
use toml::de::DeValue;

/// Largest excess of a principal moment over the sum of the others, relative to this moment. For a flat body they are
/// equal, and sources round them: 0.005208333, 0.005208333 and 0.010416667 differ by 1e-7.
const FLAT: f64 = 1e-6;

/// Keys of `[platform]`.
pub(super) const KEYS: &[Key] = &[
    Key::numeric(Shape::Number, "mass_kg", "mass_kg = 10.0", "kg", Range::Positive, "mass of the platform"),
    Key::other("motion", r#"motion = "rigid""#, KeyValue::Word(MOTIONS), "degrees of freedom of the platform")
        .without(Absent::DefaultWord("rigid")),
    Key::numeric(
        Shape::Vector,
        "plane_normal",
        "plane_normal = [0.0, 1.0, 0.0]",
        "1",
        Range::Any,
        "normal of the plane in which the platform moves, world axes, any length",
    )
    .without(Absent::Depends("required with `motion = \"planar\"`, else refused")),
    Key::numeric(
        Shape::Number,
        "plane_offset_m",
        "plane_offset_m = 0.0",
        "m",
        Range::Any,
        "distance of that plane from the world's origin along the normal, for planar platforms only",
    )
    .or([0.0; 3]),
    Key::numeric(
        Shape::Tensor,
        "inertia_kg_m2",
        "inertia_kg_m2 = [0.1, 0.1, 0.2]",
        "kg m²",
        Range::Any,
        "inertia tensor about the centre of mass, platform axes: three principal moments or three rows of three \
         numbers; for a planar platform also one number, the moment about the normal; the tensor has to be one that a \
         body can have",
    )
    .without(Absent::Depends("required, except for a point mass, for which it is refused")),
    Key::numeric(
        Shape::Vector,
        "center_of_mass_m",
        "center_of_mass_m = [0.0, 0.0, 0.0]",
        "m",
        Range::Any,
        "centre of mass, platform frame",
    )
    .or([0.0; 3]),
    Key::numeric(
        Shape::Number,
        "drag_area_m2",
        "drag_area_m2 = 0.5",
        "m²",
        Range::NotNegative,
        "drag coefficient times area of the platform; the wind acts at the centre of mass",
    )
    .or([0.0; 3]),
    Key::numeric(
        Shape::Vector,
        "translational_damping_n_s_m",
        "translational_damping_n_s_m = [10.0, 10.0, 10.0]",
        "N s/m",
        Range::NotNegative,
        "viscous damping of the platform's translation, platform axes",
    )
    .or([0.0; 3]),
    Key::numeric(
        Shape::Vector,
        "rotational_damping_n_m_s",
        "rotational_damping_n_m_s = [0.1, 0.1, 0.1]",
        "N m s",
        Range::NotNegative,
        "viscous damping of the platform's rotation, platform axes",
    )
    .or([0.0; 3]),
];

/// Values of `motion`, with their meanings.
const MOTIONS: &[(&str, &str)] = &[
    ("rigid", "three translations and three rotations"),
    ("point-mass", "three translations"),
    ("planar-xy", "translations along x and y, rotation about z"),
    ("planar-xz", "translations along x and z, rotation about y"),
    ("planar-yz", "translations along y and z, rotation about x"),
    ("planar", "two translations in the plane with the normal `plane_normal`, rotation about this normal"),
];

/// Reads the motion; `None` if the word in the file is unknown. Reports nothing if there is no `[platform]`: [`read`]
/// does.
pub(super) fn motion(reader: &mut Reader, root: &Section) -> Option<PlatformMotion> {
    let Some(DeValue::Table(table)) = root.get("platform").map(toml::Spanned::get_ref) else {
        return Some(PlatformMotion::default());
    };

    let (normal, offset) = (table.get("plane_normal"), table.get("plane_offset_m"));
    let word = match table.get("motion") {
        Some(value) => known_word(reader, value)?,
        None => "rigid",
    };

    let axis = match word {
        "planar-xy" => Some(Vec3::z()),
        "planar-xz" => Some(Vec3::y()),
        "planar-yz" => Some(Vec3::x()),
        _ => None,
    };

    if word != "planar"
        && let Some(value) = normal
    {
        let help = "set `motion = \"planar\"`, or remove the line";
        reader.issue(value.span(), format!("`plane_normal` goes with `motion = \"planar\"`, not {word}")).help(help);
        return None;
    }

    if axis.is_none() && word != "planar" {
        if let Some(value) = offset {
            reader
                .issue(value.span(), "`plane_offset_m` is for a planar platform only")
                .help("remove the line, or set `motion = \"planar-xz\"`");
            return None;
        }
        return Some(if word == "rigid" { PlatformMotion::Rigid } else { PlatformMotion::PointMass });
    }

    let normal_w = match (axis, normal) {
        (Some(axis), _) => axis,
        (None, Some(value)) => plane_normal(reader, value)?,
        (None, None) => {
            let span = table.get("motion").map_or(0..0, toml::Spanned::span);
            reader
                .issue(span, "`motion = \"planar\"` needs the normal of its plane")
                .help("add `plane_normal = [0.0, 1.0, 0.0]`, or write \"planar-xy\", \"planar-xz\" or \"planar-yz\"");
            return None;
        }
    };

    let offset = match offset {
        Some(value) => reader.number_as(known(KEYS, "plane_offset_m"), value)?,
        None => 0.0,
    };
    Plane::new(normal_w, offset).map(PlatformMotion::Planar)
}

/// Normal of the plane of a planar platform, of any length.
fn plane_normal(reader: &mut Reader, value: &Value) -> Option<Vec3> {
    let normal = Vec3::from(reader.vector_as(known(KEYS, "plane_normal"), value)?);
    if normal.norm() < MIN_POSITIVE {
        reader.issue(value.span(), "`plane_normal` has no direction").help("give the normal of the plane, any length");
        return None;
    }
    Some(normal)
}

fn known_word(reader: &mut Reader, value: &Value) -> Option<&'static str> {
    let word = reader.text("motion", value)?;
    let words = || MOTIONS.iter().map(|(word, _)| *word);
    let known = words().find(|known| *known == word);
    if known.is_none() {
        let suggestion = nearest(&word, words()).map(|near| format!("; did you mean \"{near}\"?")).unwrap_or_default();
        reader.issue(value.span(), format!("`motion` is \"{}\", which is unknown", shortened(&word))).help(format!(
            "write \"rigid\", \"point-mass\", \"planar-xy\", \"planar-xz\", \"planar-yz\", or \"planar\" with a \
             `plane_normal`{suggestion}"
        ));
    }
    known
}

/// Reads the platform.
pub(super) fn read(reader: &mut Reader, root: &Section, motion: Option<PlatformMotion>) -> Option<Platform> {
    let value = reader.required(root, "platform")?;
    let table = reader.table("platform", "[platform]", value)?;
    let section = reader.open("[platform]", value.span(), table, KEYS);

    let mass = reader.required(&section, "mass_kg").and_then(|v| reader.number_of(&section, "mass_kg", v));

    let inertia = match motion {
        Some(PlatformMotion::Rigid) => {
            required_inertia(reader, root, &section, mass).and_then(|value| inertia(reader, value))
        }
        Some(PlatformMotion::Planar(plane)) => {
            required_inertia(reader, root, &section, mass).and_then(|value| planar_inertia(reader, value, &plane))
        }
        Some(PlatformMotion::PointMass) => {
            if let Some(value) = section.get("inertia_kg_m2") {
                reader
                    .issue(value.span(), "a point mass has no inertia tensor, `inertia_kg_m2` must be absent")
                    .help("remove the line, or set `motion = \"rigid\"`");
            }
            Some(Mat3::zeros())
        }
        None => None,
    };

    let center_of_mass = center_of_mass(reader, &section, motion);
    let drag_area = reader.number_or_default(&section, "drag_area_m2");

    let translational = damping(reader, &section, "translational_damping_n_s_m");
    let rotational = damping(reader, &section, "rotational_damping_n_m_s");
    if let Some(value) = section.get("rotational_damping_n_m_s").filter(|_| motion == Some(PlatformMotion::PointMass)) {
        reader
            .issue(value.span(), "a point mass does not turn, `rotational_damping_n_m_s` must be absent")
            .help("remove the line, or set `motion = \"rigid\"`");
    }

    Some(Platform {
        translational_damping_p: translational?,
        rotational_damping_p: rotational?,
        mass: mass?,
        inertia_p: inertia?,
        drag_area: drag_area?,
        center_of_mass_p: Vec3::from(center_of_mass?),
        bodies: Vec::new(),
        motion: motion?,
    })
}

/// Centre of mass, zero if the file has none; that of a point mass has to be zero.
fn center_of_mass(reader: &mut Reader, section: &Section, motion: Option<PlatformMotion>) -> Option<[f64; 3]> {
    let Some(value) = section.get("center_of_mass_m") else { return Some([0.0; 3]) };
    let center = reader.vector(section, "center_of_mass_m", value);
    if motion == Some(PlatformMotion::PointMass) && center.is_some_and(|center| !is_zero(&center)) {
        reader
            .issue(value.span(), "a point mass is its own centre, `center_of_mass_m` must be zero or absent")
            .help("remove the line, or set `motion = \"rigid\"`");
    }
    center
}

/// Value of the inertia tensor, which a platform that turns needs. If it is missing, the issue shows an example.
fn required_inertia<'t>(
    reader: &mut Reader,
    root: &Section,
    section: &Section<'t>,
    mass: Option<f64>,
) -> Option<&'t Value<'t>> {
    let found_before = reader.issues.len();
    let value = reader.required(section, "inertia_kg_m2");
    if value.is_none()
        && let Some(issue) = reader.issues.get_mut(found_before)
        && let Some(example) = mass.and_then(|mass| box_example(root, mass))
    {
        issue.help(example);
    }
    value
}

/// Remedy for a missing tensor: the moments of a homogeneous box with the size of the attachments. `None` if the file
/// has no attachments that span at least a rectangle.
fn box_example(root: &Section, mass: f64) -> Option<String> {
    let DeValue::Array(cables) = root.get("cables")?.get_ref() else { return None };
    let attachments: Vec<[f64; 3]> = cables.iter().filter_map(|cable| attachment(cable.get_ref())).collect();
    let extent = |i: usize| {
        let along = attachments.iter().map(|attachment| attachment[i]);
        along.clone().fold(f64::NEG_INFINITY, f64::max) - along.fold(f64::INFINITY, f64::min)
    };
    let size = [extent(0), extent(1), extent(2)];

    // Second moments m a²/12 are rounded, not their sums: so the moments of a flat box stay those of a body.
    let second = size.map(|side| rounded(mass * side * side / 12.0, 4));
    let moments = [second[1] + second[2], second[0] + second[2], second[0] + second[1]];
    if !moments.iter().all(|moment| *moment > MIN_POSITIVE && *moment < MAX_MAGNITUDE) {
        return None;
    }
    let [xx, yy, zz] = moments.map(|moment| rounded(moment, 10));
    let [a, b, c] = size.map(|side| rounded(side, 4));
    Some(format!(
        "add it, for example `inertia_kg_m2 = [{xx}, {yy}, {zz}]`: moments m(b² + c²)/12, m(a² + c²)/12 and m(a² + \
         b²)/12 of a homogeneous box of {mass} kg with the size of the attachments, {a} × {b} × {c} m; replace this \
         starting value by that of the real platform"
    ))
}

/// Attachment of an entry of `[[cables]]`, if it has three numbers.
fn attachment(cable: &DeValue) -> Option<[f64; 3]> {
    let DeValue::Table(cable) = cable else { return None };
    let DeValue::Array(numbers) = cable.get("attachment_m")?.get_ref() else { return None };
    let numbers: Option<Vec<f64>> = numbers.iter().map(|number| parsed(number.get_ref())).collect();
    numbers?.try_into().ok()
}

/// Viscous damping along the platform's three axes; zero if the key is absent.
fn damping(reader: &mut Reader, section: &Section, key: &str) -> Option<Vec3> {
    let Some(value) = section.get(key) else { return Some(Vec3::zeros()) };
    let label = format!("`{key}`");
    let three = reader.three(&label, &format!("three numbers in {}", section.number(key).unit), value)?;
    reader.three_numbers(&label, section.number(key).range, three).map(Vec3::from)
}

/// Inertia of a planar platform. A single number is the moment about the normal, which is all that counts; a tensor is
/// read as for a rigid body.
fn planar_inertia(reader: &mut Reader, value: &Value, plane: &Plane) -> Option<Mat3> {
    if matches!(value.get_ref(), DeValue::Array(_)) {
        return inertia(reader, value);
    }
    let moment = reader.number("`inertia_kg_m2`", Range::Positive, value)?;
    Some(plane.normal_w() * plane.normal_w().transpose() * moment)
}

/// Reads three principal moments or a full tensor, which must be symmetric, positive definite and possible for a body.
fn inertia(reader: &mut Reader, value: &Value) -> Option<Mat3> {
    let tensor = tensor::read(reader, "inertia_kg_m2", "kg m²", value)?;
    possible(reader, &tensor, value)?;
    Some(tensor)
}

/// Checks that a body can have this tensor: principal moments positive, none larger than the sum of the others.
fn possible(reader: &mut Reader, tensor: &Mat3, value: &Value) -> Option<()> {
    let mut moments: [f64; 3] = tensor.symmetric_eigenvalues().into();
    moments.sort_by(f64::total_cmp);
    let [least, middle, largest] = moments;
    let shown = format!(
        "its principal moments are {}, {} and {} kg m²",
        tensor::short(least),
        tensor::short(middle),
        tensor::short(largest)
    );

    // Below 1e-12 of the largest moment, the sign of the smallest is rounding.
    if least < MIN_POSITIVE * largest.max(1.0) {
        reader
            .issue(value.span(), format!("`inertia_kg_m2` is not positive definite: {shown}"))
            .help("give the tensor about the centre of mass in platform axes; its off-diagonal entries are −∫xy dm");
        return None;
    }

    if largest > (least + middle) * (1.0 + FLAT) {
        reader
            .issue(
                value.span(),
                format!("`inertia_kg_m2` fits no body: {shown}, and the largest exceeds the sum of the others"),
            )
            .help("check the unit (kg m²) and the order of the numbers");
        return None;
    }
    Some(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use toml::de::DeTable;

    fn tensor_of(text: &str) -> Result<Mat3, String> {
        let file = format!("i = {text}");
        let root = DeTable::parse(&file).unwrap();
        let mut reader = Reader::new(&file);
        let tensor = inertia(&mut reader, &root.get_ref()["i"]);
        tensor.ok_or_else(|| reader.issues[0].message.clone())
    }

    #[test]
    fn a_flat_plate_and_a_cube_are_bodies_and_a_rod_without_thickness_is_not() {
        assert!(tensor_of("[1.0, 2.0, 3.0]").is_ok());
        assert!(tensor_of("[1e-6, 1e-6, 1e-6]").is_ok());
        assert!(tensor_of("[[1, 0, 0], [0, 1, 0], [0, 0, 0]]").unwrap_err().contains("not positive definite"));
        assert!(tensor_of("[1.0, 1.0, 2.1]").unwrap_err().contains("moments are 1, 1 and 2.1 kg m²"));
    }

    #[test]
    fn the_slack_is_a_billionth_of_symmetry_and_a_millionth_of_flatness() {
        assert!(tensor_of("[1.0, 1.0, 2.000001]").is_ok());
        assert!(tensor_of("[1.0, 1.0, 2.00001]").is_err());
        assert!(tensor_of("[[1, 1e-10, 0], [0, 1, 0], [0, 0, 1]]").is_ok());
        assert!(tensor_of("[[1, 1e-8, 0], [0, 1, 0], [0, 0, 1]]").unwrap_err().contains("not symmetric"));
    }

    proptest! {
        /// Points with mass are a body, so their tensor has to be accepted whatever the axes.
        #[test]
        fn the_tensor_of_any_four_masses_is_accepted(
            points in proptest::array::uniform4((proptest::array::uniform3(-1.0_f64..1.0), 0.1_f64..1.0)),
        ) {
            let total: f64 = points.iter().map(|(_, m)| m).sum();
            let center = points.iter().map(|(p, m)| Vec3::from(*p) * *m).sum::<Vec3>() / total;
            let mut tensor = Mat3::identity() * 1e-3;
            for (p, m) in points {
                let r = Vec3::from(p) - center;
                tensor += (Mat3::identity() * r.norm_squared() - r * r.transpose()) * m;
            }
            let rows: Vec<String> =
                (0..3).map(|i| format!("[{:?}, {:?}, {:?}]", tensor[(i, 0)], tensor[(i, 1)], tensor[(i, 2)])).collect();
            let read = tensor_of(&format!("[{}]", rows.join(", ")));
            prop_assert!(read.is_ok_and(|t| (t - tensor).amax() < 1e-12));
        }
    }
}

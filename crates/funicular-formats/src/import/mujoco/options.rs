//! Units of angles and default values of a model of MuJoCo.

use crate::import::frames::{attribute_array, attribute_vec};
use crate::import::text;
use crate::import::xml::{Xml, children, tag};
use anyhow::{Result, bail};
use funicular::math::{Quaternion, Rotation, Vec3};
use funicular_study::text::clean;
use roxmltree::Node;

/// Settings of `<compiler>` and `<default>`.
pub(super) struct MujocoOptions<'n> {
    /// Radians per unit of an angle.
    angle: f64,
    euler_sequence: String,
    defaults: Vec<Node<'n, 'n>>,
}

impl<'n> MujocoOptions<'n> {
    pub(super) fn read(xml: &'n Xml<'n>) -> Result<Self> {
        let root: Node<'n, 'n> = xml.root();
        let compiler = |name: &str| children(root, "compiler").filter_map(|node| node.attribute(name)).last();
        let angle = match compiler("angle") {
            None | Some("degree") => 1.0_f64.to_radians(),
            Some("radian") => 1.0,
            Some(other) => bail!(xml.error(
                root,
                format!("attribute `angle` of <compiler> is `{}`; MuJoCo knows degree and radian", clean(other))
            )),
        };
        if compiler("coordinate") == Some("global") {
            bail!(
                xml.error(root, "coordinates are global, which MuJoCo has given up; save the model with a new version")
            );
        }
        let euler_sequence = compiler("eulerseq").unwrap_or("xyz").to_owned();
        if euler_sequence.len() != 3 || !euler_sequence.bytes().all(|axis| b"xyzXYZ".contains(&axis)) {
            bail!(
                xml.error(root, format!("attribute `eulerseq` is `{}`, it must be like xyz", clean(&euler_sequence)))
            );
        }
        let defaults = root.descendants().filter(|node| node.is_element() && tag(*node) == "default").collect();
        Ok(Self { angle, euler_sequence, defaults })
    }

    /// Attribute of an element, its class or the defaults of its kind.
    pub(super) fn attribute(&self, node: Node<'n, 'n>, kind: &str, name: &str) -> Option<(Node<'n, 'n>, &'n str)> {
        if let Some(text) = node.attribute(name) {
            return Some((node, text));
        }
        let class = node.attribute("class");
        let mut group = self.defaults.iter().copied().find(|of| match class {
            Some(class) => of.attribute("class") == Some(class),
            None => of.parent_element().is_some_and(|parent| tag(parent) == "mujoco"),
        });
        while let Some(at) = group.filter(|at| tag(*at) == "default") {
            let found = children(at, kind).find_map(|of| Some((of, of.attribute(name)?)));
            if found.is_some() {
                return found;
            }
            group = at.parent_element();
        }
        None
    }

    /// Numbers of such an attribute; `None` if it is absent.
    pub(super) fn numbers(&self, xml: &Xml, node: Node<'n, 'n>, kind: &str, name: &str) -> Result<Option<Vec<f64>>> {
        let Some((place, text)) = self.attribute(node, kind, name) else { return Ok(None) };
        match text::numbers(text) {
            Ok(numbers) => Ok(Some(numbers)),
            Err(wrong) => bail!(xml.error(place, format!("attribute `{name}` of <{}> holds {wrong}", tag(place)))),
        }
    }

    /// Orientation of a body or geometry in the frame around it.
    pub(super) fn orientation(&self, xml: &Xml, node: Node) -> Result<Rotation> {
        let degenerate =
            |name: &str| xml.error(node, format!("attribute `{name}` of <{}> is no orientation", tag(node)));
        let unit = |v: Vec3, name: &str| v.try_normalize(0.0).ok_or_else(|| degenerate(name));
        if let Some([w, i, j, k]) = attribute_array(xml, node, "quat")? {
            let quaternion = Quaternion::new(w, i, j, k);
            return if quaternion.norm() > 0.0 {
                Ok(Rotation::new_normalize(quaternion))
            } else {
                Err(degenerate("quat"))
            };
        }
        if let Some([x, y, z, angle]) = attribute_array(xml, node, "axisangle")? {
            return Ok(about(&unit(Vec3::new(x, y, z), "axisangle")?, angle * self.angle));
        }
        if let Some(angles) = attribute_array::<3>(xml, node, "euler")? {
            let mut total = Rotation::identity();
            for (axis, angle) in self.euler_sequence.bytes().zip(angles) {
                let turn = about(&axis_of(axis), angle * self.angle);
                total = if axis.is_ascii_lowercase() { total * turn } else { turn * total };
            }
            return Ok(total);
        }
        if let Some([a, b, c, d, e, f]) = attribute_array(xml, node, "xyaxes")? {
            let x = unit(Vec3::new(a, b, c), "xyaxes")?;
            let y = Vec3::new(d, e, f);
            let y = unit(y - x * x.dot(&y), "xyaxes")?;
            return Ok(from_axes(&x, &y));
        }
        if let Some(axis) = attribute_vec(xml, node, "zaxis")? {
            let z = unit(axis, "zaxis")?;
            let turn = Vec3::z().cross(&z);
            let angle = turn.norm().atan2(z.z);
            return Ok(about(&turn.try_normalize(0.0).unwrap_or_else(Vec3::x), angle));
        }
        Ok(Rotation::identity())
    }
}

fn axis_of(letter: u8) -> Vec3 {
    match letter.to_ascii_lowercase() {
        b'x' => Vec3::x(),
        b'y' => Vec3::y(),
        _ => Vec3::z(),
    }
}

/// Rotation about an axis of unit length.
fn about(axis: &Vec3, angle: f64) -> Rotation {
    let (s, c) = (angle / 2.0).sin_cos();
    Rotation::new_normalize(Quaternion::new(c, axis.x * s, axis.y * s, axis.z * s))
}

/// Rotation that takes the axes x and y to two unit vectors at a right angle.
fn from_axes(x: &Vec3, y: &Vec3) -> Rotation {
    let first = Vec3::x().cross(x);
    let half_turn = about(&Vec3::y(), std::f64::consts::PI);
    let to_x = match first.try_normalize(1e-12) {
        Some(axis) => about(&axis, first.norm().atan2(x.x)),
        None if x.x > 0.0 => Rotation::identity(),
        None => half_turn,
    };
    let y_now = to_x * Vec3::y();
    let angle = y_now.cross(y).dot(x).atan2(y_now.dot(y));
    about(x, angle) * to_x
}

#[cfg(test)]
mod tests {
    use super::*;
    use funicular_study::request::SourceFile;

    #[test]
    fn every_way_to_write_an_orientation_is_the_same_quarter_turn() {
        let angles =
            ["quat=\"0.5 0.5 0.5 0.5\"", "axisangle=\"1 1 1 120\"", "xyaxes=\"0 1 0 0 0 2\"", "euler=\"90 90 0\""];
        for attribute in angles {
            let text = format!("<mujoco><worldbody><body {attribute}/></worldbody></mujoco>");
            let file = SourceFile::decode("a.xml".to_owned(), text.as_bytes()).unwrap();
            let xml = Xml::parse(&file).unwrap();
            let body = xml.root().descendants().find(|node| node.has_tag_name("body")).unwrap();
            let turn = MujocoOptions::read(&xml).unwrap().orientation(&xml, body).unwrap();
            // x goes to y, y to z.
            for (from, to) in [(Vec3::x(), Vec3::y()), (Vec3::y(), Vec3::z())] {
                assert!((turn * from - to).norm() < 1e-12, "{attribute}: {}", turn * from);
            }
        }
        let minus = from_axes(&-Vec3::x(), &Vec3::y());
        assert!((minus * Vec3::x() + Vec3::x()).norm() < 1e-15 && (minus * Vec3::y() - Vec3::y()).norm() < 1e-15);
    }
}

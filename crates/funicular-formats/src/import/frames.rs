//! Frames within frames, and bodies put together, for files of links and joints.

use super::text;
use super::xml::{Xml, tag};
use anyhow::{Result, bail};
use funicular::math::{Mat3, Rotation, Vec3};
use funicular::robot::Pose;
use roxmltree::Node;

/// Frame that coincides with the one it is given in.
pub(super) fn identity() -> Pose {
    Pose { position_w: Vec3::zeros(), rot_wp: Rotation::identity() }
}

/// Pose of a frame that is given in another frame.
pub(super) fn compose(outer: &Pose, inner: &Pose) -> Pose {
    Pose { position_w: outer.point_w(&inner.position_w), rot_wp: outer.rot_wp * inner.rot_wp }
}

/// Pose of the outer frame in the inner one.
pub(super) fn inverse(pose: &Pose) -> Pose {
    let rot_wp = pose.rot_wp.inverse();
    Pose { position_w: -(rot_wp * pose.position_w), rot_wp }
}

/// Tensor in the axes of the frame in which `rotation` is given.
pub(super) fn turned(tensor: &Mat3, rotation: &Rotation) -> Mat3 {
    let r = rotation.to_rotation_matrix();
    r.matrix() * tensor * r.matrix().transpose()
}

/// Mass, centre of mass and inertia tensor about it, in one frame.
#[derive(Debug, Clone, Copy)]
pub(super) struct MassOfBody {
    pub(super) mass: f64,
    pub(super) center: Vec3,
    /// `None` if the file has none.
    pub(super) inertia: Option<Mat3>,
}

impl MassOfBody {
    /// Mass that is given in a frame, in the frame around it.
    pub(super) fn seen_from_outside(&self, pose: &Pose) -> Self {
        Self {
            mass: self.mass,
            center: pose.point_w(&self.center),
            inertia: self.inertia.map(|inertia| turned(&inertia, &pose.rot_wp)),
        }
    }

    /// One body of two.
    pub(super) fn with(&self, other: &Self) -> Self {
        let mass = self.mass + other.mass;
        if mass <= 0.0 {
            return *self;
        }
        let center = (self.center * self.mass + other.center * other.mass) / mass;
        let about = |body: &Self| {
            let arm = body.center - center;
            body.inertia.map(|own| own + (Mat3::identity() * arm.norm_squared() - arm * arm.transpose()) * body.mass)
        };
        let inertia = about(self).zip(about(other)).map(|(a, b)| a + b);
        Self { mass, center, inertia }
    }
}

/// Numbers in an attribute; `None` if it is absent.
pub(super) fn attribute_numbers(xml: &Xml, node: Node, name: &str) -> Result<Option<Vec<f64>>> {
    let Some(text) = node.attribute(name) else { return Ok(None) };
    match text::numbers(text) {
        Ok(numbers) => Ok(Some(numbers)),
        Err(wrong) => bail!(xml.error(node, format!("attribute `{name}` of <{}> holds {wrong}", tag(node)))),
    }
}

/// Numbers in an attribute, as many as wanted; `None` if it is absent.
pub(super) fn attribute_array<const N: usize>(xml: &Xml, node: Node, name: &str) -> Result<Option<[f64; N]>> {
    let Some(numbers) = attribute_numbers(xml, node, name)? else { return Ok(None) };
    match <[f64; N]>::try_from(numbers) {
        Ok(array) => Ok(Some(array)),
        Err(numbers) => bail!(xml.error(
            node,
            format!("attribute `{name}` of <{}> holds {} numbers; it must hold {N}", tag(node), numbers.len())
        )),
    }
}

/// Vector in an attribute; `None` if it is absent.
pub(super) fn attribute_vec(xml: &Xml, node: Node, name: &str) -> Result<Option<Vec3>> {
    Ok(attribute_array::<3>(xml, node, name)?.map(Vec3::from))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_halves_of_a_rod_are_the_rod() {
        let half = |x: f64| {
            let inertia = Mat3::from_diagonal(&Vec3::new(0.0, 1.0, 1.0)) * (1.0 / 12.0);
            MassOfBody { mass: 1.0, center: Vec3::new(x, 0.0, 0.0), inertia: Some(inertia) }
        };
        let rod = half(-0.5).with(&half(0.5));
        assert!((rod.inertia.unwrap()[(1, 1)] - 2.0 * 4.0 / 12.0).abs() < 1e-15 && rod.center == Vec3::zeros());
        let quarter = Rotation::from_euler_angles(0.0, 0.0, std::f64::consts::FRAC_PI_2);
        let standing = rod.seen_from_outside(&Pose { position_w: Vec3::x(), rot_wp: quarter });
        let tensor = standing.inertia.unwrap();
        assert!(tensor[(1, 1)].abs() < 1e-15 && (tensor[(0, 0)] - 2.0 / 3.0).abs() < 1e-15, "{tensor}");
        let there = Pose { position_w: Vec3::new(1.0, 2.0, 3.0), rot_wp: quarter };
        let back = compose(&there, &inverse(&there));
        assert!(back.position_w.norm() < 1e-15 && back.rot_wp.angle() < 1e-15);
    }
}

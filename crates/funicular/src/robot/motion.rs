//! Motions that a platform can make, and the coordinates in which every analysis works.

use super::Pose;
use crate::math::{Mat6, Vec3, Vec6};
use thiserror::Error;

/// Motions that the platform can make.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum PlatformMotion {
    /// Three translations and three rotations.
    #[default]
    Rigid,
    /// Translations only: all cables end in one point that carries the mass.
    PointMass,
    /// Two translations in a plane and the rotation about its normal; a guide carries the other forces and moments.
    Planar(Plane),
}

/// The plane in which the origin of a planar platform moves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plane {
    /// Unit normal, world axes.
    normal_w: Vec3,
    /// Distance from the world's origin along the normal [m].
    offset: f64,
}

/// Reason why a planar platform cannot have a pose.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum OutOfPlane {
    /// The origin is not in the plane.
    #[error(
        "the platform's origin is {distance} m off the plane in which it moves: give a position in the plane, or the \
         plane's `plane_offset_m` in [platform]"
    )]
    Beside {
        /// Distance along the normal [m].
        distance: f64,
    },
    /// The platform is turned about another axis than the normal.
    #[error(
        "the platform is tilted out of its plane by {degrees}°: a planar platform turns about the normal of its plane \
         only (pitch in the xz plane, yaw in xy, roll in yz)"
    )]
    Tilted {
        /// Angle between the normal before and after the platform's rotation [degrees].
        degrees: f64,
    },
}

/// Largest distance from the plane, relative to the distance from the origin, and largest angle [rad] at which a pose
/// counts as in the plane: far above the rounding of angles in degrees, far below any intended deviation.
const IN_PLANE: f64 = 1e-9;

/// Component of the normal of a plane from which on the plane gives the coordinate along that axis: a millimetre in the
/// other two is then less than a metre in it.
const ACROSS: f64 = 1e-3;

impl Plane {
    /// Plane with this normal (of any length), at a distance [m] from the world's origin along it. `None` if the normal
    /// has no direction.
    pub fn new(normal_w: Vec3, offset: f64) -> Option<Self> {
        let length = normal_w.norm();
        (length > 0.0 && length.is_finite() && offset.is_finite()).then(|| Self { normal_w: normal_w / length, offset })
    }

    /// Unit normal, world axes.
    pub fn normal_w(&self) -> Vec3 {
        self.normal_w
    }

    /// Distance from the world's origin along the normal [m].
    pub fn offset(&self) -> f64 {
        self.offset
    }

    /// Signed distance of a point from the plane, positive along the normal [m].
    pub fn distance(&self, point_w: &Vec3) -> f64 {
        self.normal_w.dot(point_w) - self.offset
    }

    /// Point in the plane with these coordinates along the world axes [m], of which one may be missing where the plane
    /// is across its axis; `None` if the plane does not give what is missing.
    pub fn point_with(&self, given: [Option<f64>; 3]) -> Option<Vec3> {
        let mut point_w = Vec3::from(given.map(Option::unwrap_or_default));
        let missing = (0..3).filter(|axis| given[*axis].is_none());
        match missing.collect::<Vec<_>>()[..] {
            [] => {}
            [axis] if self.normal_w[axis].abs() > ACROSS => {
                point_w[axis] = -self.distance(&point_w) / self.normal_w[axis];
            }
            _ => return None,
        }
        Some(point_w)
    }

    /// Two orthonormal directions in the plane: coordinate axes if the plane contains them.
    fn axes(&self) -> [Vec3; 2] {
        let n = &self.normal_w;
        let least = (0..3).fold(0, |least, i| if n[i].abs() < n[least].abs() { i } else { least });
        let axis = Vec3::ith(least, 1.0);
        let first = (axis - n * n[least]).normalize();
        let second = n.cross(&first);
        [first, if second[second.iamax()] < 0.0 { -second } else { second }]
    }
}

impl PlatformMotion {
    /// Number of degrees of freedom: 6 or 3.
    pub fn count(&self) -> usize {
        match self {
            Self::Rigid => 6,
            Self::PointMass | Self::Planar(_) => 3,
        }
    }

    /// True if the platform can rotate.
    pub fn can_turn(&self) -> bool {
        *self != Self::PointMass
    }

    /// Name in the robot file; `planar` if the plane is not a coordinate plane.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Rigid => "rigid",
            Self::PointMass => "point-mass",
            Self::Planar(plane) => {
                let words = ["planar-yz", "planar-xz", "planar-xy"];
                let axis = (0..3).find(|&i| plane.normal_w == Vec3::ith(i, 1.0));
                axis.map_or("planar", |axis| words[axis])
            }
        }
    }

    /// Unit motion (δp, δθ) of every coordinate, as columns; zero beyond [`Self::count`]. The columns are orthonormal,
    /// and none mixes translation and rotation, so that the matrix also holds for scaled quantities.
    fn motions(&self) -> Mat6 {
        match self {
            Self::Rigid => Mat6::identity(),
            Self::PointMass => Mat6::from_diagonal(&Vec6::new(1.0, 1.0, 1.0, 0.0, 0.0, 0.0)),
            Self::Planar(plane) => {
                let mut motions = Mat6::zeros();
                for (k, (row, axis)) in
                    [0, 0, 3].into_iter().zip(plane.axes().into_iter().chain([plane.normal_w])).enumerate()
                {
                    motions.fixed_view_mut::<3, 1>(row, k).copy_from(&axis);
                }
                motions
            }
        }
    }

    /// Unit vectors of the translations that the platform can make, world axes, in the order of its coordinates.
    pub fn translations_w(&self) -> Vec<Vec3> {
        let motions = self.motions();
        let count = if matches!(self, Self::Planar(_)) { 2 } else { 3 };
        (0..count).map(|k| motions.fixed_view::<3, 1>(0, k).into_owned()).collect()
    }

    /// Names of the coordinates: world axes where possible; in another plane its two directions `u` and `v`, and
    /// `turn`.
    pub fn coordinate_names(&self) -> &'static [&'static str] {
        match (self, self.name()) {
            (Self::Rigid, _) => &["x", "y", "z", "rx", "ry", "rz"],
            (Self::PointMass, _) => &["x", "y", "z"],
            (_, "planar-xy") => &["x", "y", "rz"],
            (_, "planar-xz") => &["x", "z", "ry"],
            (_, "planar-yz") => &["y", "z", "rx"],
            _ => &["u", "v", "turn"],
        }
    }

    /// Components of (δp, δθ) in world axes in which the platform can move.
    pub fn components(&self) -> Vec<usize> {
        (0..6).filter(|&i| self.reduced(&Vec6::ith(i, 1.0)).norm() > IN_PLANE).collect()
    }

    /// True if coordinate `k` is a rotation.
    pub fn is_rotation(&self, k: usize) -> bool {
        match self {
            Self::Rigid | Self::PointMass => k >= 3,
            Self::Planar(_) => k == 2,
        }
    }

    /// Components of a motion or of a wrench (either with one unit throughout) in the platform's coordinates; zero
    /// beyond [`Self::count`]. Drops the components that the platform cannot follow.
    #[inline]
    pub fn reduced(&self, vector: &Vec6) -> Vec6 {
        match self {
            Self::Rigid => *vector,
            Self::PointMass => Vec6::new(vector[0], vector[1], vector[2], 0.0, 0.0, 0.0),
            Self::Planar(_) => self.motions().tr_mul(vector),
        }
    }

    /// Motion or wrench of six components that has these coordinates.
    #[inline]
    pub fn expanded(&self, coordinates: &Vec6) -> Vec6 {
        match self {
            Self::Rigid => *coordinates,
            Self::PointMass => self.reduced(coordinates),
            Self::Planar(_) => self.motions() * coordinates,
        }
    }

    /// 6×6 matrix over motions, in the platform's coordinates; zero beyond [`Self::count`].
    #[inline]
    pub fn reduced_matrix(&self, matrix: &Mat6) -> Mat6 {
        match self {
            Self::Rigid => *matrix,
            Self::PointMass | Self::Planar(_) => {
                let motions = self.motions();
                motions.transpose() * matrix * motions
            }
        }
    }

    /// Matrix over motions of six components that has this matrix in the platform's coordinates.
    pub fn expanded_matrix(&self, matrix: &Mat6) -> Mat6 {
        match self {
            Self::Rigid => *matrix,
            Self::PointMass | Self::Planar(_) => {
                let motions = self.motions();
                motions * matrix * motions.transpose()
            }
        }
    }

    /// Projection of a wrench or motion on the platform's degrees of freedom; the guide carries the remainder.
    #[inline]
    pub fn allowed(&self, vector: &Vec6) -> Vec6 {
        match self {
            Self::Rigid => *vector,
            Self::PointMass | Self::Planar(_) => self.expanded(&self.reduced(vector)),
        }
    }

    /// True if the platform can follow all of a motion.
    pub fn can_follow(&self, motion: &Vec6) -> bool {
        (self.allowed(motion) - motion).norm() <= IN_PLANE * motion.norm()
    }

    /// Checks that the platform can have a pose.
    ///
    /// # Errors
    /// [`OutOfPlane`] for a pose off the plane of a planar platform.
    pub fn check(&self, pose: &Pose) -> Result<(), OutOfPlane> {
        let Self::Planar(plane) = self else { return Ok(()) };
        let distance = plane.distance(&pose.position_w);
        if distance.abs() > IN_PLANE * (pose.position_w.norm() + plane.offset.abs()).max(1.0) {
            return Err(OutOfPlane::Beside { distance });
        }
        let normal = plane.normal_w;
        let turned = pose.rot_wp * normal;
        let angle = turned.cross(&normal).norm().atan2(turned.dot(&normal));
        if angle > IN_PLANE {
            return Err(OutOfPlane::Tilted { degrees: angle.to_degrees() });
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn planar(normal: [f64; 3]) -> PlatformMotion {
        PlatformMotion::Planar(Plane::new(Vec3::from(normal), 0.5).unwrap())
    }

    #[test]
    fn coordinate_planes_have_coordinate_axes() {
        let v = Vec6::new(1.0, 2.0, 3.0, 4.0, 5.0, 6.0);
        for (normal, name, expected) in [
            ([0.0, 0.0, 2.0], "planar-xy", [1.0, 2.0, 6.0]),
            ([0.0, 1.0, 0.0], "planar-xz", [1.0, 3.0, 5.0]),
            ([3.0, 0.0, 0.0], "planar-yz", [2.0, 3.0, 4.0]),
        ] {
            let motion = planar(normal);
            assert_eq!(motion.name(), name);
            assert_eq!(motion.reduced(&v).as_slice()[..3], expected);
        }
        assert!(Plane::new(Vec3::zeros(), 0.0).is_none());
    }

    proptest! {
        #[test]
        fn what_is_allowed_stays_and_the_coordinates_are_orthonormal(
            normal in prop::array::uniform3(-1.0_f64..1.0),
            v in prop::array::uniform6(-1.0_f64..1.0),
        ) {
            prop_assume!(Vec3::from(normal).norm() > 1e-3);
            let (motion, v) = (planar(normal), Vec6::from(v));
            let x = motion.reduced(&v);
            let allowed = motion.expanded(&x);
            prop_assert!((allowed.norm() - x.norm()).abs() < 1e-14);
            prop_assert!((motion.allowed(&allowed) - allowed).norm() < 1e-14);
            let PlatformMotion::Planar(plane) = motion else { unreachable!() };
            let across = plane.normal_w().dot(&allowed.fixed_rows::<3>(0).clone_owned());
            let turn = allowed.fixed_rows::<3>(3).cross(&plane.normal_w());
            prop_assert!(across.abs() < 1e-14 && turn.norm() < 1e-14);
        }
    }
}

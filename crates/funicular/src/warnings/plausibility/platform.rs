//! Plausibility of the platform: mass, inertia and centre of mass against the size of the attachments.

use super::geometry::Size;
use super::{Implausible, likely, outside, usual};
use crate::robot::{PlatformMotion, Robot};
use std::f64::consts::PI;

/// Warnings about the platform.
pub(super) fn check(robot: &Robot) -> Vec<Implausible> {
    let platform = &robot.platform;
    let size = Size::of(robot);
    if platform.motion == PlatformMotion::PointMass || size.attachments == 0.0 {
        return Vec::new();
    }

    // A load far from its attachments is as large as its distance.
    let offset = (platform.center_of_mass_p - size.middle_p).norm();
    let center = outside(
        "distance of the centre of mass from the attachments, over their size,",
        offset / size.attachments,
        "",
        usual::OFFSET,
        |value| {
            let slips = &[(1e-3, "`center_of_mass_m` in mm given as m"), (1e-2, "`center_of_mass_m` in cm given as m")];
            likely(value, [0.0, 2.0], slips)
        },
    );
    if center.is_some() {
        return center.into_iter().collect();
    }
    let radius = size.attachments.max(offset);

    // Mass, and inertia if the mass is plausible.
    let density = platform.mass / (4.0 / 3.0 * PI * radius.powi(3));
    let mass = outside(
        "mass of the platform over the volume of the ball around its attachments",
        density,
        "kg/m³",
        usual::PLATFORM_DENSITY,
        |value| {
            let slips = &[(1e3, "mass in t given as kg"), (1e-3, "mass in g given as kg")];
            likely(value, [3.0, 2000.0], slips)
        },
    );
    let inertia = || {
        let moment = match platform.motion {
            PlatformMotion::Planar(plane) => {
                let normal_p = plane.normal_w();
                normal_p.dot(&(platform.inertia_p * normal_p))
            }
            PlatformMotion::Rigid | PlatformMotion::PointMass => platform.inertia_p.symmetric_eigenvalues().max(),
        };
        let ratio = (moment / platform.mass).sqrt() / radius;
        let what = "radius of gyration of the platform, √(inertia/mass), over the size of its attachments";
        outside(what, ratio, "", usual::GYRATION, |value| {
            let slips = &[
                (1e-3, "inertia in kg mm² given as kg m²"),
                (1e-2, "inertia in kg cm² given as kg m²"),
                (1e-3_f64.sqrt(), "inertia a factor of 1000 too large (g m²), or mass in t given as kg"),
                (1e3_f64.sqrt(), "inertia a factor of 1000 too small (t m²), or mass in g given as kg"),
            ];
            likely(value, [0.15, 1.6], slips)
        })
    };
    mass.or_else(inertia).into_iter().collect()
}

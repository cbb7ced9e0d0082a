//! Plausibility of the platform: mass, inertia and centre of mass against the size of the attachments, and damping.

use super::geometry::Size;
use super::{Implausible, likely, outside, usual};
use crate::math::Vec3;
use crate::robot::{Platform, PlatformMotion, Robot, State};
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
    let position_w = match &robot.state {
        State::Pose(pose) => Some(pose.position_w),
        State::Lengths(_) | State::Unknown => None,
    };
    let center = outside(
        "distance of the centre of mass from the attachments, over their size,",
        offset / size.attachments,
        "",
        usual::OFFSET,
        |value| {
            if position_w.is_some_and(|at| (platform.center_of_mass_p - at).norm() < 2.0 * size.attachments) {
                return "`center_of_mass_m` given in the world frame?".to_owned();
            }
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
    let inertia = || inertia(platform, radius, position_w);
    mass.or_else(inertia).into_iter().chain(damping(robot)).collect()
}

/// Inertia, as the radius of gyration over the `radius` of the platform [m]; `position_w` recognises an inertia about
/// the origin of the world.
fn inertia(platform: &Platform, radius: f64, position_w: Option<Vec3>) -> Option<Implausible> {
    let moment = match platform.motion {
        PlatformMotion::Planar(plane) => {
            let normal_p = plane.normal_w();
            normal_p.dot(&(platform.inertia_p * normal_p))
        }
        PlatformMotion::Rigid | PlatformMotion::PointMass => platform.inertia_p.symmetric_eigenvalues().max(),
    };

    let gyration = (moment / platform.mass).sqrt();
    let ratio = gyration / radius;
    let what = "radius of gyration of the platform, √(inertia/mass), over the size of its attachments";
    outside(what, ratio, "", usual::GYRATION, |value| {
        // The distance of the world's origin is the radius of gyration about it.
        if position_w.is_some_and(|at| (0.5..1.1).contains(&(gyration / at.norm()))) {
            return "inertia about the origin of the world in place of the centre of mass?".to_owned();
        }
        let slips = &[
            (1e-3, "inertia in kg mm² given as kg m²"),
            (1e-7_f64.sqrt(), "inertia in g cm² given as kg m²"),
            (1e-2, "inertia in kg cm² given as kg m²"),
            (1e-3_f64.sqrt(), "inertia a factor of 1000 too large (g m²), or mass in t given as kg"),
            (1e3_f64.sqrt(), "inertia a factor of 1000 too small (t m²), or mass in g given as kg"),
            (platform.mass.sqrt(), "inertia divided by the mass"),
        ];
        likely(value, [0.15, 1.6], slips)
    })
}

/// Viscous damping over mass and inertia; the first value outside the usual range of each.
fn damping(robot: &Robot) -> Vec<Implausible> {
    let platform = &robot.platform;
    let rates = |damping: &Vec3, inertia: Vec3| -> Vec<f64> {
        damping.iter().zip(inertia.iter()).filter(|(c, m)| **c > 0.0 && **m > 0.0).map(|(c, m)| c / m).collect()
    };
    let translation = rates(&platform.translational_damping_p, Vec3::repeat(platform.mass));
    let rotation = rates(&platform.rotational_damping_p, platform.inertia_p.diagonal());

    let check = |key: &str, of: &str, rates: &[f64]| {
        let [low, high] = usual::PLATFORM_DAMPING;
        let rate = *rates.iter().find(|rate| !(low..=high).contains(*rate))?;
        outside(format!("`{key}` over {of} of the platform"), rate, "1/s", [low, high], |rate| {
            let slip = if rate.is_too_large() { "a stiffness, or a value in other units," } else { "a damping ratio" };
            format!("{slip} given as damping? A damping ratio ζ at f Hz is 4π ζ f")
        })
    };
    let translation = check("translational_damping_n_s_m", "the mass", &translation);
    let rotation = check("rotational_damping_n_m_s", "the inertia", &rotation);
    [translation, rotation].into_iter().flatten().collect()
}

//! Plausibility of gravity, weights, loads, wind and tension limits.

use super::geometry::{Size, lengths};
use super::{Implausible, likely, outside, usual};
use crate::math::{Vec3, Vec6};
use crate::robot::{Load, PlatformMotion, Robot, State};
use std::f64::consts::PI;

/// Warnings about the loads; those that compare them with ropes and sizes only if `sizes_fit`.
pub(super) fn check(robot: &Robot, sizes_fit: bool) -> Vec<Implausible> {
    let gravity: Vec<Implausible> =
        [magnitude_of_gravity(robot), gravity_up(robot), gravity_level(robot)].into_iter().flatten().collect();
    let compared = sizes_fit && gravity.is_empty();
    let mut found = gravity;
    if compared {
        let limits = [maxima(robot), minima(robot)];
        // Without these the weight itself is compared.
        let weight = if limits[0].is_none() { stiffness(robot) } else { None };
        found.extend([weight, cable_mass(robot)].into_iter().chain(limits).flatten());
        found.extend(load(robot));
    }
    found.extend([wind(robot), air_density(robot)].into_iter().flatten());
    if compared {
        found.extend(drag_area(robot));
    }
    found
}

fn magnitude_of_gravity(robot: &Robot) -> Option<Implausible> {
    let gravity = robot.gravity_w.norm();
    if gravity == 0.0 {
        return None;
    }
    outside("gravity", gravity, "m/s²", usual::GRAVITY, |value| {
        let slips = &[
            (9.81, "`gravity_m_s2` in units of g"),
            (0.3048, "`gravity_m_s2` in ft/s²"),
            (1e-2, "`gravity_m_s2` in cm/s²"),
            (1e-3, "`gravity_m_s2` in mm/s²"),
            (1e3, "`gravity_m_s2` in km/s²"),
        ];
        likely(value, [9.5, 10.1], slips)
    })
}

/// Gravity along +z with anchors above the platform.
fn gravity_up(robot: &Robot) -> Option<Implausible> {
    let count = robot.cables.len() as f64;
    let anchors = robot.cables.iter().map(|cable| cable.anchor.reference_w().z).sum::<f64>() / count;
    let platform = match &robot.state {
        State::Pose(pose) => pose.position_w.z,
        State::Lengths(_) | State::Unknown => 0.0,
    };
    let up = robot.gravity_w.z > 0.5 * robot.gravity_w.norm();
    (up && anchors > platform).then(|| Implausible::Odd {
        what: format!(
            "`gravity_m_s2` has z = {}, which is up, and the anchors are above the platform in z",
            robot.gravity_w.z
        ),
        slip: "wrong sign of gravity?".to_owned(),
    })
}

/// Gravity perpendicular to z, with all anchors above the platform in z.
fn gravity_level(robot: &Robot) -> Option<Implausible> {
    let State::Pose(pose) = &robot.state else { return None };
    let gravity = robot.gravity_w.norm();
    let is_level = gravity > 0.0 && robot.gravity_w.z.abs() < 0.1 * gravity;
    let is_above = robot.cables.iter().all(|cable| cable.anchor.reference_w().z > pose.position_w.z);
    (is_level && is_above).then(|| Implausible::Odd {
        what: format!(
            "`gravity_m_s2` is ({}, {}, {}), perpendicular to z, and all anchors are above the platform in z",
            robot.gravity_w.x, robot.gravity_w.y, robot.gravity_w.z
        ),
        slip: "gravity along -z meant?".to_owned(),
    })
}

/// Force on the platform that the cables have to carry [N]: without the part that a guide carries.
fn carried(robot: &Robot) -> f64 {
    let force = robot.force_at_mass_centre_w() + robot.load.force_w;
    let allowed = robot.platform.motion.allowed(&Vec6::new(force.x, force.y, force.z, 0.0, 0.0, 0.0));
    Vec3::new(allowed[0], allowed[1], allowed[2]).norm()
}

/// Weight against the stiffness of all cables.
fn stiffness(robot: &Robot) -> Option<Implausible> {
    let total: f64 = robot.cables.iter().map(|cable| cable.material.axial_stiffness).sum();
    let what = "weight and load of the platform over the sum of the axial stiffnesses";
    outside(what, carried(robot) / total, "", usual::WEIGHT_OVER_STIFFNESS, |value| {
        let slips = &[(1e-3, "mass in g given as kg, or axial stiffness in kN given as N")];
        likely(value, [0.0, 1.0], slips)
    })
}

/// Mass of all cables against that of the platform.
fn cable_mass(robot: &Robot) -> Option<Implausible> {
    let lengths = lengths(robot);
    let masses = robot.cables.iter().zip(&lengths).map(|(cable, length)| cable.material.mass_per_length * length);
    let what = "mass of all cables over that of the platform";
    outside(what, masses.sum::<f64>() / robot.platform.mass, "", usual::CABLES_OVER_PLATFORM, |_| {
        "ropes in kg per 100 m or g/m given as kg/m, or mass of the complete cable given per metre, or platform in t \
         given as kg?"
            .to_owned()
    })
}

/// Sum of the maximum tensions against the load.
fn maxima(robot: &Robot) -> Option<Implausible> {
    let total = robot.cables.iter().map(|cable| cable.limits().maximum).sum::<Option<f64>>()?;
    let load = carried(robot);
    if load == 0.0 {
        return None;
    }
    let what = "sum of all maximum tensions over the load of the platform";
    outside(what, total / load, "", usual::MAXIMA_OVER_LOAD, |_| {
        "maximum tension in kN given as N, or mass in g given as kg? No pose can be held".to_owned()
    })
}

/// Minimum tensions that a file gives against the load.
fn minima(robot: &Robot) -> Option<Implausible> {
    let load = carried(robot);
    let given = robot.cables.iter().filter_map(|cable| cable.limits().minimum).filter(|min| *min > usual::NOT_SLACK);
    let minimum = given.fold(f64::INFINITY, f64::min);
    if load == 0.0 || minimum.is_infinite() {
        return None;
    }
    outside(
        "smallest minimum tension over the load of the platform",
        minimum / load,
        "",
        usual::MINIMUM_OVER_LOAD,
        |_| "minimum tension in kN given as N?".to_owned(),
    )
}

/// Force, moment and point of the load.
fn load(robot: &Robot) -> Vec<Implausible> {
    let Load { force_w, moment_w, point_p } = robot.load;
    let weight = robot.platform.mass * robot.gravity_w.norm();
    let size = Size::of(robot);
    let mut found = Vec::new();
    let weight_w = robot.platform.mass * robot.gravity_w;
    if weight > 0.0 && (force_w - weight_w).norm() <= usual::WEIGHT_DIGITS * weight {
        found.push(Implausible::Odd {
            what: format!("`force_n` is {:.4} N, which is the weight of the platform", force_w.norm()),
            slip: "weight counted twice? `mass_kg` includes it".to_owned(),
        });
    }

    if weight > 0.0 {
        let what = "force on the platform over its weight";
        found.extend(outside(what, force_w.norm() / weight, "", usual::LOAD_OVER_WEIGHT, |_| {
            "force in mN given as N, or mass in t given as kg?".to_owned()
        }));
    }

    if size.attachments > 0.0 && weight > 0.0 {
        let what = "moment on the platform over its weight and the size of its attachments";
        let ratio = moment_w.norm() / (weight * size.attachments);
        found
            .extend(outside(what, ratio, "", usual::MOMENT_OVER_WEIGHT, |_| "moment in N mm given as N m?".to_owned()));
    }

    if size.attachments > 0.0 {
        let what = "distance of the load's point from the attachments, over their size,";
        let ratio = (point_p - size.middle_p).norm() / size.attachments;
        found.extend(outside(what, ratio, "", usual::OFFSET, |value| {
            likely(value, [0.0, 2.0], &[(1e-3, "`point_m` in mm given as m"), (1e-2, "`point_m` in cm given as m")])
        }));
    }

    found
}

fn wind(robot: &Robot) -> Option<Implausible> {
    outside("wind", robot.wind.velocity_w.norm(), "m/s", usual::WIND, |_| "km/h given as m/s?".to_owned())
}

fn air_density(robot: &Robot) -> Option<Implausible> {
    let density = robot.wind.air_density;
    if (usual::WATER_DENSITY[0]..=usual::WATER_DENSITY[1]).contains(&density) {
        return None;
    }
    outside("density of the air", density, "kg/m³", usual::AIR_DENSITY, |value| {
        likely(value, usual::AIR_DENSITY, &[(1e3, "g/cm³ given as kg/m³"), (1e-3, "g/m³ given as kg/m³")])
    })
}

/// Drag area against the size of the platform.
fn drag_area(robot: &Robot) -> Option<Implausible> {
    let size = Size::of(robot).attachments;
    if robot.platform.motion == PlatformMotion::PointMass || size == 0.0 {
        return None;
    }
    let what = "drag coefficient times area of the platform, over the disc of its attachments,";
    outside(what, robot.platform.drag_area / (PI * size * size), "", usual::DRAG_AREA, |value| {
        likely(value, [0.05, 5.0], &[(1e-4, "cm² given as m²"), (1e-6, "mm² given as m²")])
    })
}

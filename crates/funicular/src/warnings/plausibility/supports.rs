//! Plausibility of flexible supports: stiffness and mass against the platform, and displacement at an equilibrium.

use super::{Implausible, likely, outside, usual};
use crate::math::Vec3;
use crate::robot::{Robot, Support};
use crate::statics::{CableState, Equilibrium};

/// Slips of the unit of a stiffness that is too small.
const TOO_SOFT: &[(f64, &str)] =
    &[(1e-3, "stiffness in N/mm or kN/m given as N/m"), (1e-6, "stiffness in kN/mm or MN/m given as N/m")];

/// Warnings about all supports.
pub(super) fn check(robot: &Robot) -> Vec<Implausible> {
    robot.supports.iter().flat_map(|support| of_support(robot, support)).collect()
}

fn of_support(robot: &Robot, support: &Support) -> Vec<Implausible> {
    let named = |quantity: &str| format!("support \"{}\": {quantity}", support.name);
    let softest = support.stiffness_w.symmetric_eigenvalues().min();
    let (mass, gravity) = (robot.platform.mass, robot.gravity_w.norm());

    // Displacement under the platform's weight, over the size of the robot.
    let yields = (mass * gravity / softest) / size(robot);
    let soft = outside(
        named("displacement under the weight of the platform, over the distance of the anchors,"),
        yields,
        "",
        usual::SUPPORT_YIELD,
        |value| likely(value, [1e-5, 0.01], TOO_SOFT),
    );
    let stiff = outside(named("smallest principal stiffness"), softest, "N/m", usual::SUPPORT_STIFFNESS, |_| {
        "a Young's modulus or EI given as stiffness? A rigid frame needs no `support`".to_owned()
    });
    let heavy =
        outside(named("mass over that of the platform"), support.mass / mass, "", usual::SUPPORT_MASS, |value| {
            likely(value, [1e-3, 100.0], &[(1e-3, "mass in g given as kg, or the platform's in t")])
        });
    [soft, stiff, heavy].into_iter().flatten().collect()
}

/// Maximum distance of an anchor from the mean of all [m]; that of the anchors from the attachments if there is one
/// anchor.
fn size(robot: &Robot) -> f64 {
    let anchors: Vec<Vec3> = robot.cables.iter().map(|cable| cable.anchor.point_w).collect();
    let mean = anchors.iter().sum::<Vec3>() / anchors.len().max(1) as f64;
    let size = anchors.iter().map(|anchor| (anchor - mean).norm()).fold(0.0, f64::max);
    if size > 0.0 { size } else { mean.norm() }
}

/// Largest displacement of a support at an equilibrium, over the longest cable.
pub(super) fn displacement(robot: &Robot, equilibrium: &Equilibrium) -> Option<Implausible> {
    let longest = equilibrium.cables.iter().map(CableState::chord).fold(0.0, f64::max);
    let moved = equilibrium.support_displacements(robot);
    let (support, displacement_w) =
        robot.supports.iter().zip(&moved).max_by(|a, b| a.1.norm().total_cmp(&b.1.norm()))?;
    let what = format!("displacement of support \"{}\" at equilibrium over the longest cable", support.name);
    outside(what, displacement_w.norm() / longest, "", usual::SUPPORT_DISPLACEMENT, |value| {
        format!("{} Supports are linear springs, for small displacements", likely(value, [1e-5, 0.02], TOO_SOFT))
    })
}

//! Plausibility of flexible supports: stiffness, mass and damping against cables and platform, distance of their
//! anchors, and displacement at an equilibrium.

use super::geometry::lengths;
use super::{Implausible, likely, outside, usual};
use crate::math::Vec3;
use crate::robot::{Cable, Robot, Support};
use crate::statics::{CableState, Equilibrium};

/// Slips of the unit of a stiffness that is too small.
const TOO_SOFT: &[(f64, &str)] =
    &[(1e-3, "stiffness in N/mm or kN/m given as N/m"), (1e-6, "stiffness in kN/mm or MN/m given as N/m")];

/// Warnings about all supports.
pub(super) fn check(robot: &Robot) -> Vec<Implausible> {
    let of_all = robot.supports.iter().enumerate();
    of_all.flat_map(|(i, support)| of_support(robot, support).into_iter().chain(extent(robot, i))).collect()
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
    let soft = soft.or_else(|| {
        let what =
            named("smallest principal stiffness over the axial stiffness of its stiffest cable, EA over its length,");
        outside(what, softest / stiffest_cable(robot, support)?, "", usual::SUPPORT_OVER_CABLE, |_| {
            "stiffness in N/mm or kN/m given as N/m?".to_owned()
        })
    });
    let stiff = outside(named("smallest principal stiffness"), softest, "N/m", usual::SUPPORT_STIFFNESS, |_| {
        "a Young's modulus or EI given as stiffness? A rigid frame needs no `support`".to_owned()
    });
    let heavy =
        outside(named("mass over that of the platform"), support.mass / mass, "", usual::SUPPORT_MASS, |value| {
            likely(value, [1e-3, 100.0], &[(1e-3, "mass in g given as kg, or the platform's in t")])
        });
    let damped = outside(named("damping ratio"), support.damping_ratio, "", usual::SUPPORT_DAMPING, |_| {
        "per cent given as a fraction? Structures have 0.005 to 0.05".to_owned()
    });
    [soft, stiff, heavy, damped].into_iter().flatten().collect()
}

/// Largest axial stiffness of the cables on a support, EA over the length [N/m].
fn stiffest_cable(robot: &Robot, support: &Support) -> Option<f64> {
    let on_it = |cable: &Cable| cable.anchor.support.is_some_and(|i| robot.supports[i].name == support.name);
    let stiffness = |(cable, length): (&Cable, f64)| cable.material.axial_stiffness / length;
    let all = robot.cables.iter().zip(lengths(robot)).filter(|(cable, length)| on_it(cable) && *length > 0.0);
    all.map(stiffness).max_by(f64::total_cmp)
}

/// Anchors of one support that are as far apart as those of the whole robot. One displacement cannot be that of several
/// posts.
fn extent(robot: &Robot, support: usize) -> Option<Implausible> {
    let anchors = |of: Option<usize>| -> Vec<Vec3> {
        let all = robot.cables.iter().filter(|cable| of.is_none() || cable.anchor.support == of);
        all.map(|cable| cable.anchor.reference_w()).collect()
    };
    // A post carries anchors at different heights.
    let up_w = robot.gravity_w.try_normalize(0.0).unwrap_or_default();
    let largest = |points: &[Vec3]| {
        let pairs = points.iter().enumerate().flat_map(|(i, a)| points[..i].iter().map(move |b| a - b));
        pairs.map(|between| (between - up_w * up_w.dot(&between)).norm()).fold(0.0, f64::max)
    };
    // Anchors side by side at one mast are near each other against the cables.
    let longest = lengths(robot).into_iter().fold(0.0, f64::max);
    let (own, all) = (largest(&anchors(Some(support))), largest(&anchors(None)).max(longest));
    let name = &robot.supports[support].name;
    let what = format!(
        "support \"{name}\": distance of its anchors, {} m, over that of all anchors or the longest cable,",
        super::number(own)
    );
    outside(what, if all > 0.0 { own / all } else { 0.0 }, "", usual::SUPPORT_EXTENT, |_| {
        "several posts in one table? All anchors of a support move together: give each post a table of its own"
            .to_owned()
    })
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

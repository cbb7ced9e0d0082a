//! Plausibility of ropes: cross-section, modulus, mass, damping, strength and drag.

use super::geometry::lengths;
use super::{Implausible, likely, outside, usual};
use crate::math::Vec3;
use crate::robot::{Damping, Material, Robot, RopeSection};
use std::f64::consts::PI;

/// Distinct ropes of the cables, in their order.
pub(super) fn distinct(robot: &Robot) -> Vec<&Material> {
    let mut ropes: Vec<&Material> = Vec::new();
    for cable in &robot.cables {
        if !ropes.contains(&&cable.material) {
            ropes.push(&cable.material);
        }
    }
    ropes
}

/// All warnings about a rope.
pub(super) fn check(robot: &Robot, rope: &Material) -> Vec<Implausible> {
    // These quantities depend on each other: the first one that is wrong explains the others.
    let stiffness = section(robot, rope).or_else(|| modulus(rope)).or_else(|| specific_stiffness(rope));
    let stiffness = stiffness.or_else(|| full_circle(rope));
    let strength = if stiffness.is_none() { strength(rope) } else { Vec::new() };

    let stiffness_ratio = stiffness_ratio(rope);
    let loss = loss_factor(rope).or_else(|| same_decay(rope));
    let loss = [damping(rope), loss, damping_time(rope)];
    let others = [stiffness_ratio, drag_coefficient(rope), drag_diameter(rope), load(robot, rope)];
    stiffness.into_iter().chain(strength).chain(loss.into_iter().chain(others).flatten()).collect()
}

fn named(rope: &Material, quantity: &str) -> String {
    format!("rope \"{}\": {quantity}", rope.name)
}

/// Diameter and density.
fn section(robot: &Robot, rope: &Material) -> Option<Implausible> {
    let section = rope.dimensions.section?;
    let (quantity, key) = match section {
        RopeSection::Diameter(_) => ("diameter", "diameter_m"),
        RopeSection::Area(_) => ("diameter of a circle with its area", "area_m2"),
    };

    let diameter = (4.0 * section.area() / PI).sqrt();
    let by_diameter = outside(named(rope, quantity), diameter, "m", usual::DIAMETER, |value| match section {
        RopeSection::Diameter(_) => {
            likely(value, [5e-4, 0.06], &[(1e-3, "diameter in mm given as m"), (1e-2, "diameter in cm given as m")])
        }
        // An area by the diameter of its circle.
        RopeSection::Area(_) => {
            likely(value, [5e-4, 0.06], &[(1e-3, "area in mm² given as m²"), (1e-2, "area in cm² given as m²")])
        }
    });
    if by_diameter.is_some() || rope.mass_per_length == 0.0 {
        return by_diameter;
    }

    let slips: &[(f64, &str)] = &[
        (1e-3, "mass in g/m given as kg/m"),
        (1e-2, "mass in kg per 100 m given as kg/m"),
        (1.0 / mean_length(robot), "mass of the complete cable given per metre"),
        (1.0 / 9.81, "weight in N/m given as mass in kg/m"),
        (0.25, "radius given as diameter"),
        (1e3, "mass in t/m given as kg/m"),
        (1e4, "diameter in cm, or area in cm², given in m or m²"),
        (1e6, "diameter in mm, or area in mm², given in m or m²"),
    ];
    let what = named(rope, &format!("density, `mass_kg_per_m` over the area of `{key}`,"));
    let density = rope.mass_per_length / section.area();
    outside(what, density, "kg/m³", usual::DENSITY, |value| likely(value, [700.0, 1e4], slips))
}

fn modulus(rope: &Material) -> Option<Implausible> {
    let modulus = rope.axial_stiffness / rope.dimensions.section?.area();
    let slips: &[(f64, &str)] = &[
        (1e9, "GPa given as Pa"),
        (1e6, "MPa (N/mm²) given as Pa"),
        (1e3, "kPa given as Pa"),
        (1e-3, "a factor of 1000 too much"),
    ];
    outside(named(rope, "Young's modulus"), modulus, "Pa", usual::YOUNGS_MODULUS, |value| {
        format!(
            "{} Steel has 1.96e11 Pa, wire rope about 1e11 Pa, fibre rope 1e9 to 1e11 Pa",
            likely(value, [1e9, 2.2e11], slips)
        )
    })
}

fn specific_stiffness(rope: &Material) -> Option<Implausible> {
    if rope.mass_per_length == 0.0 {
        return None;
    }
    let slips: &[(f64, &str)] = &[
        (1e2, "mass in kg per 100 m given as kg/m"),
        (1e3, "axial stiffness in kN given as N, or mass in g/m given as kg/m"),
        (1e6, "axial stiffness in MN given as N"),
        (1e9, "Young's modulus in GPa given as axial stiffness in N"),
        (1e-3, "axial stiffness in mN given as N, or mass in t/m given as kg/m"),
        (1e-5, "Young's modulus given as axial stiffness, without the area"),
    ];
    let what = named(rope, "axial stiffness over mass per length");
    let value = rope.axial_stiffness / rope.mass_per_length;
    outside(what, value, "m²/s²", usual::SPECIFIC_STIFFNESS, |value| {
        format!("{} Wire rope has 1.2e7, polyamide rope 1e6, fibres up to 1.2e8", likely(value, [8e5, 1.5e8], slips))
    })
}

/// Modulus over the metal of a stranded steel rope whose modulus is given together with the full circle [Pa].
///
/// The circle is that of `diameter_m`, or an `area_m2` with the density of a rope in place of that of steel.
fn metal_modulus(rope: &Material) -> Option<f64> {
    let section = rope.dimensions.section?;
    let fill = rope.mass_per_length / section.area() / usual::STEEL_DENSITY;
    let is_stranded = (usual::STRANDED[0]..=usual::STRANDED[1]).contains(&fill);
    is_stranded.then(|| rope.axial_stiffness / section.area() / fill)
}

fn full_circle(rope: &Material) -> Option<Implausible> {
    let circle = match rope.dimensions.section? {
        RopeSection::Diameter(_) => "`diameter_m`",
        RopeSection::Area(_) => "`area_m2` (by its density)",
    };
    let what = format!("Young's modulus over its metal, which fills a part of the full circle of {circle} only,");
    outside(named(rope, &what), metal_modulus(rope)?, "Pa", usual::STRANDED_MODULUS, |_| {
        "modulus over the metal given with the diameter of the full circle? Give the area of the metal as `area_m2`: \
         mass per length over 7850 kg/m³"
            .to_owned()
    })
}

/// Remark on a rope whose values may be meant as well as a slip.
pub(super) fn note(rope: &Material) -> Option<String> {
    if rope.mass_per_length == 0.0 {
        let what = "it has no mass, so cables hang straight and have no vibrations of their own; if that is not meant, \
                    give `mass_kg_per_m`";
        return Some(named(rope, what));
    }
    let modulus = metal_modulus(rope)?;
    let of_note = modulus > usual::STRANDED_MODULUS_OF_NOTE && modulus <= usual::STRANDED_MODULUS[1];
    of_note.then(|| {
        let what = format!(
            "`diameter_m` gives the area of the full circle, of which the metal of a wire rope fills 0.4 to 0.65; with \
             this mass, `youngs_modulus_pa` stands for {modulus:.2e} Pa over the metal, where wire ropes have 0.6e11 \
             to 1.3e11 Pa; if it is the modulus over the metal, give `area_m2`"
        );
        named(rope, &what)
    })
}

/// Axial stiffness in vibration over that of the equilibrium.
fn stiffness_ratio(rope: &Material) -> Option<Implausible> {
    let slips: &[(f64, &str)] =
        &[(1e3, "axial stiffness in kN given as N"), (1e-3, "axial stiffness in mN given as N")];
    let what = named(rope, "`dynamic_axial_stiffness_n` over the axial stiffness of the equilibrium");
    let ratio = rope.dynamic_axial_stiffness? / rope.axial_stiffness;
    outside(what, ratio, "", usual::STIFFNESS_RATIO, |value| {
        format!(
            "{} A rope is stiffer in vibration than under a slow load",
            likely(value, usual::STIFFNESS_RATIO, slips)
        )
    })
}

fn damping(rope: &Material) -> Option<Implausible> {
    match rope.damping {
        Damping::Ratio(ratio) if ratio > 0.0 => {
            let slips: &[(f64, &str)] =
                &[(1e-2, "per cent given as a fraction"), (1e2, "a fraction divided by 100 once more")];
            outside(named(rope, "damping ratio"), ratio, "", usual::DAMPING_RATIO, |value| {
                format!("{} Wire rope has about 0.003", likely(value, usual::DAMPING_RATIO, slips))
            })
        }
        Damping::Viscous(coefficient) if rope.mass_per_length > 0.0 => {
            let what = named(rope, "viscous damping over mass per length");
            outside(what, coefficient / rope.mass_per_length, "1/s", usual::VISCOUS_DAMPING, |_| {
                "damping of the complete cable in N s/m given per metre, or mN s/m² given as N s/m²?".to_owned()
            })
        }
        Damping::Ratio(_) | Damping::Viscous(_) => None,
    }
}

fn loss_factor(rope: &Material) -> Option<Implausible> {
    let factor = rope.stretch_loss.factor;
    let slips: &[(f64, &str)] = &[(1e-2, "per cent given as a fraction"), (1e2, "a fraction divided by 100 once more")];
    let is_given = factor > 0.0;
    let what = named(rope, "loss factor of the stretch, `axial_loss_factor`,");
    is_given.then(|| outside(what, factor, "", usual::LOSS_FACTOR, |value| likely(value, [2e-3, 0.1], slips)))?
}

fn damping_time(rope: &Material) -> Option<Implausible> {
    let slips: &[(f64, &str)] = &[(1e-3, "milliseconds given as s")];
    let what = named(rope, "damping time of the stretch, `axial_damping_time_s`,");
    outside(what, rope.stretch_loss.time, "s", usual::DAMPING_TIME, |value| likely(value, [1e-5, 5e-3], slips))
}

/// One measured decay in two numbers: the ratio of a mode that lives on the stretch of the rope is half its loss
/// factor.
fn same_decay(rope: &Material) -> Option<Implausible> {
    let Damping::Ratio(ratio) = rope.damping else { return None };
    let factor = rope.stretch_loss.factor;
    let is_same = |expected: f64| expected > 0.0 && (ratio / expected - 1.0).abs() <= usual::SAME_DECAY;
    (is_same(0.5 * factor) || is_same(factor)).then(|| Implausible::Odd {
        what: named(rope, &format!("`damping_ratio` is {ratio}, and `axial_loss_factor` is {factor}")),
        slip: "one measured decay given twice? The ratio damps moving the rope, the loss factor stretching it (alone \
               it gives a mode half its value as damping ratio): give the decay of a vibrating rope as \
               `damping_ratio`, and fit the loss factor to that of the platform with `identify`"
            .to_owned(),
    })
}

/// Breaking load and tension limits against the axial stiffness.
fn strength(rope: &Material) -> Vec<Implausible> {
    let strain = |load: Option<f64>| load.map(|load| load / rope.axial_stiffness);
    let limits = rope.tension_limits;

    let breaking = strain(rope.breaking_load).and_then(|strain| {
        let slips: &[(f64, &str)] = &[
            (1e3, "breaking load in kN given as N"),
            (9.81, "breaking load in kgf given as N"),
            (1e-3, "breaking load in mN given as N"),
        ];
        let what = named(rope, "strain at its breaking load, `breaking_load_n` over the axial stiffness,");
        outside(what, strain, "", usual::STRAIN_AT_BREAK, |value| {
            format!("{} Steel has 0.01 to 0.02, fibres have 0.03 to 0.3", likely(value, [8e-3, 0.3], slips))
        })
    });
    let limit = |strain: Option<f64>, key: &str, range: [f64; 2]| {
        outside(named(rope, &format!("strain at its `{key}`")), strain?, "", range, |_| {
            "tension in mN given as N, or axial stiffness in kN given as N?".to_owned()
        })
    };
    let maximum = limit(strain(limits.maximum), "maximum_tension_n", usual::STRAIN_AT_MAXIMUM);
    let minimum = limit(strain(limits.minimum), "minimum_tension_n", usual::STRAIN_AT_MINIMUM);
    [breaking, maximum, minimum].into_iter().flatten().collect()
}

fn drag_coefficient(rope: &Material) -> Option<Implausible> {
    let coefficient = rope.drag_width? / rope.dimensions.drag_diameter?;
    if coefficient == 0.0 {
        return None;
    }
    outside(named(rope, "drag coefficient"), coefficient, "", usual::DRAG_COEFFICIENT, |value| {
        let slip = if value.is_too_large() { "a coefficient in per cent" } else { "coefficient times diameter" };
        format!("{slip}? A round rope has 1.0 to 1.2")
    })
}

fn drag_diameter(rope: &Material) -> Option<Implausible> {
    outside(
        named(rope, "diameter that the wind meets"),
        rope.dimensions.drag_diameter?,
        "m",
        usual::DRAG_DIAMETER,
        |value| likely(value, [5e-4, 0.1], &[(1e-3, "diameter in mm given as m"), (1e-2, "diameter in cm given as m")]),
    )
}

/// Load per length over the weight, and against it.
fn load(robot: &Robot, rope: &Material) -> Option<Implausible> {
    let weight_w = rope.mass_per_length * robot.gravity_w;
    let weight = weight_w.norm();
    let cables = robot.cables.iter().filter(|cable| cable.material == *rope);
    let loads_w: Vec<Vec3> = cables.map(|cable| cable.load_per_length_w).collect();
    let load = loads_w.iter().map(Vec3::norm).fold(0.0, f64::max);
    if weight == 0.0 || load == 0.0 {
        return None;
    }
    let too_much =
        outside(named(rope, "load per length over its weight"), load / weight, "", usual::CABLE_LOAD, |_| {
            "load of the complete cable given per metre, or mN/m given as N/m?".to_owned()
        });

    let twice = || {
        let is_weight = |load_w: &Vec3| (load_w - weight_w).norm() <= usual::WEIGHT_DIGITS * weight;
        loads_w.iter().any(is_weight).then(|| Implausible::Odd {
            what: named(rope, &format!("`load_n_per_m` is {weight:.4} N/m, which is the weight of the rope")),
            slip: "weight counted twice? `mass_kg_per_m` includes it".to_owned(),
        })
    };
    let upward = || {
        let lift = loads_w.iter().map(|load_w| -load_w.dot(&weight_w) / weight).fold(0.0, f64::max);
        let area = rope.dimensions.section.map_or(rope.mass_per_length / usual::DENSITY[0], |section| section.area());
        let buoyancy = SEA_WATER_DENSITY * robot.gravity_w.norm() * area;
        let what = named(rope, "upward load per length over the buoyancy that its volume has in water");
        outside(what, lift / buoyancy, "", usual::BUOYANCY, |_| "wrong sign of `load_n_per_m`?".to_owned())
    };
    too_much.or_else(twice).or_else(upward)
}

/// Density of sea water [kg/m³].
const SEA_WATER_DENSITY: f64 = 1025.0;

/// Mean length of the cables [m].
fn mean_length(robot: &Robot) -> f64 {
    lengths(robot).iter().sum::<f64>() / robot.cables.len().max(1) as f64
}

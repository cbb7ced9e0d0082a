//! Plausibility of an equilibrium: strain, weight of the cables against their tension, length of the cables, and
//! displacement of supports.

use super::{Implausible, likely, outside, supports, usual};
use crate::robot::{Robot, State};
use crate::statics::{Equilibrium, StaticModel};

/// Values of an equilibrium that no usual robot has.
pub fn of_equilibrium(robot: &Robot, equilibrium: &Equilibrium) -> Vec<Implausible> {
    let displacement = supports::displacement(robot, equilibrium);
    // Ideal cables are rigid and have no weight.
    if equilibrium.model == StaticModel::Ideal {
        return displacement.into_iter().collect();
    }
    let of_cables = [strain(robot, equilibrium), weight(robot, equilibrium), length(robot, equilibrium)];
    of_cables.into_iter().chain([displacement]).flatten().collect()
}

/// Largest strain of a cable.
fn strain(robot: &Robot, equilibrium: &Equilibrium) -> Option<Implausible> {
    let strains = robot.cables.iter().zip(&equilibrium.cables).map(|(cable, state)| {
        let tension = state.tension_platform.max(state.tension_anchor);
        (cable.name.as_str(), tension / cable.material.axial_stiffness)
    });
    let (name, strain) = strains.max_by(|a, b| a.1.total_cmp(&b.1))?;
    let what = format!("strain of cable \"{name}\" at equilibrium, tension over axial stiffness,");
    outside(what, strain, "", usual::STRAIN, |value| {
        let slips = &[
            (1e-3, "Young's modulus in a wrong unit, or axial stiffness in kN given as N, or mass in g"),
            (1e-6, "Young's modulus in MPa, or axial stiffness in MN"),
            (1e-9, "Young's modulus in GPa given as Pa"),
        ];
        format!(
            "{} Steel breaks at 0.015 to 0.02; lengths that are too short, and ropes of polyamide, also strain",
            likely(value, [2e-5, 0.02], slips)
        )
    })
}

/// Weight of all cables over their tensions.
fn weight(robot: &Robot, equilibrium: &Equilibrium) -> Option<Implausible> {
    let gravity = robot.gravity_w.norm();
    let (mut weights, mut tensions) = (0.0, 0.0);
    for (cable, state) in robot.cables.iter().zip(&equilibrium.cables) {
        weights += cable.material.mass_per_length * gravity * state.free_length();
        tensions += 0.5 * (state.tension_platform + state.tension_anchor);
    }
    if equilibrium.model != StaticModel::Catenary || tensions == 0.0 {
        return None;
    }
    outside(
        "weight of all cables over the sum of their tensions",
        weights / tensions,
        "",
        usual::WEIGHT_OVER_TENSION,
        |_| "ropes in kg per 100 m or g/m given as kg/m, or tensions in kN given as N?".to_owned(),
    )
}

/// Longest cable over the distance of its ends.
///
/// At a pose that straight cables can hold only by pushing, a sagging cable of any tension balances if it is long
/// enough: it then hangs far below both of its ends and pulls the platform down.
fn length(robot: &Robot, equilibrium: &Equilibrium) -> Option<Implausible> {
    if equilibrium.model != StaticModel::Catenary {
        return None;
    }
    let ratios = robot.cables.iter().zip(&equilibrium.cables).filter(|(_, state)| state.chord() > 0.0);
    let ratios = ratios.map(|(cable, state)| (cable.name.as_str(), state.free_length() / state.chord()));
    let (name, ratio) = ratios.max_by(|a, b| a.1.total_cmp(&b.1))?;

    let what = format!("unstrained length of cable \"{name}\" over the distance of its ends");
    outside(what, ratio, "", usual::LENGTH_OVER_CHORD, |_| match robot.state {
        State::Lengths(_) => "its `unstrained_length_m` too long, or an end of the cable at a wrong place?".to_owned(),
        State::Pose(_) | State::Unknown => {
            "straight it would be slack or have to push, and only so long a cable balances the platform: wrong pose, \
             attachment or anchor?"
                .to_owned()
        }
    })
}

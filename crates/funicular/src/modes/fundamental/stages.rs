//! Search for the first mode in stages: roughly with few unknowns, then with all of them.

use super::batched_cable::CableGroup;
use super::condensed_cables::{AllUnknowns, Reduced, degree_of_start};
use super::lever_axes::KeptOf;
use super::pencil::RobotPencil;
use super::search::{FINAL, LowestPair, NEAR, ROUGH, lowest};
use super::{First, Kind};
use crate::math::Vec6;
use std::array::from_fn;
use std::f64::consts::TAU;

/// Maximum number of times that divided (slack) cables are condensed again about a new frequency before the search with
/// all unknowns.
const MAX_TANGENTS: usize = 3;

/// Relative change of x below which these condensations end.
const CLOSE_ENOUGH: f64 = 0.2;

/// Shifts over the square that the search before has found. A search ends sooner from below its result, because above
/// it another motion may be the nearest: 0.95 below an accurate square; 0.75 below a rough one; 0.7 where the
/// condensation itself has to stay below a square that is far too high.
const BELOW_FOUND: f64 = 0.95;
const BELOW_ROUGH: f64 = 0.75;
const BELOW_TOO_HIGH: f64 = 0.7;

/// Fraction of the kinetic energy below which the platform is at rest, and its motion rounding.
const PLATFORM_AT_REST: f64 = 1e-15;

/// First mode; `None` if the equilibrium is unstable or the search does not end.
pub(super) fn first(mut pencil: RobotPencil) -> Option<First> {
    let mut groups = std::mem::take(&mut pencil.groups);
    let divided = groups.iter().any(CableGroup::is_divided);

    // A rough search with matrices condensed at x = 0.
    let mut start = Reduced::of(&mut groups);
    let metric = start.mass.clone();
    let motion = pencil.any_motion(&metric, 0);
    let mut near = lowest(&pencil, &mut start, &metric, 0.0, vec![motion], if divided { &ROUGH } else { &NEAR })?;
    if divided {
        near = nearer(&pencil, near, &mut start, &mut groups)?;
    }

    // The final search, with all unknowns.
    let degrees = groups.iter().map(|group| degree_of_start(group) + 1).collect();
    let mut whole = AllUnknowns { groups: &mut groups, degrees };

    // Start below the first result: above, another motion may be the nearest.
    let x = if divided { BELOW_FOUND * near.square } else { near.square };
    near.motions.truncate(1);
    let found = lowest(&pencil, &mut whole, &start.mass, x, near.motions, &FINAL)?;
    Some(mode_of(&pencil, &found, &whole))
}

/// Better start for divided cables. At x = 0 their eliminated unknowns move very differently than at the frequency,
/// so that the first result is far too high.
fn nearer(
    pencil: &RobotPencil,
    mut near: LowestPair,
    start: &mut Reduced,
    groups: &mut [CableGroup],
) -> Option<LowestPair> {
    let mut x = BELOW_TOO_HIGH * near.square;
    for _ in 0..MAX_TANGENTS {
        if start.follow(groups, x) {
            let metric = start.mass.clone();
            near.motions.truncate(1);
            near = lowest(pencil, start, &metric, BELOW_ROUGH * x, near.motions, &ROUGH)?;
            if (near.square - x).abs() < CLOSE_ENOUGH * x {
                break;
            }
            x = near.square;
        } else {
            x *= BELOW_TOO_HIGH;
        }
    }
    Some(near)
}

/// First mode from the lowest eigenvalue and its motion, with the cables as the search has left them: at the frequency.
fn mode_of(pencil: &RobotPencil, found: &LowestPair, whole: &AllUnknowns) -> First {
    let mut cable_energy_fractions = vec![0.0; pencil.cable_count];
    for (members, masses) in pencil.members.iter().zip(&found.cables) {
        for (cable, mass) in members.iter().zip(masses) {
            cable_energy_fractions[*cable] = mass / found.mass;
        }
    }

    // Energies of the drives, which those of the cables contain.
    let mut drive_energy_fractions = Vec::new();
    if pencil.has_drive_mass {
        drive_energy_fractions.resize(pencil.cable_count, 0.0);
        for (group, (members, lever_axes)) in pencil.members.iter().zip(&pencil.lever_axes).enumerate() {
            let kept = pulp::Arch::new().dispatch(KeptOf { motion: &found.motions[0], lever_axes, group });
            for (cable, mass) in members.iter().zip(whole.drive_mass(group, kept)) {
                drive_energy_fractions[*cable] = mass / found.mass;
                cable_energy_fractions[*cable] -= mass / found.mass;
            }
        }
    }

    // Energy and motion of the platform.
    let motion = &found.motions[0];
    let platform_energy_fraction = pencil.platform_mass(motion, motion) / found.mass;
    let motion_w = pencil.motions.expanded(&Vec6::from_column_slice(&motion.platform()[..6]));
    let largest = motion_w[motion_w.iamax()];

    let at_rest = platform_energy_fraction < PLATFORM_AT_REST;
    let shape = from_fn(|i| match i {
        _ if at_rest => 0.0,
        0..3 => motion_w[i] / largest,
        _ => motion_w[i] / largest / pencil.ell,
    });

    First {
        frequency_hz: found.square.sqrt() / TAU,
        kind: Kind::of(platform_energy_fraction, drive_energy_fractions.iter().sum()),
        platform_energy_fraction,
        cable_energy_fractions,
        drive_energy_fractions,
        shape,
        unstable_directions: 0,
        certified: true,
    }
}

//! End of a chain at a pulley or a winch: the spring that stands for arc, drum side and winch.
//!
//! The end of the free span slips along the cable against the stiffness of everything behind it, and turns about the
//! swivel axis. A pre-tensioned bar behind the exit point, in line with the cable, has both: its axial stiffness is S₁₁
//! of docs/theory.md, equation (69), and as it carries the tension T over its length d, it resists sideways motion with
//! T/d. With d = T/S₂₂ this is the stiffness of the swivel; d is then r tan(β/2), the distance to the point at which
//! the line of the cable meets the swivel axis. Normal to the cable in the plane of the wheel the exit point is held.

use super::chain::Chain;
use anyhow::{Result, bail};
use funicular::math::Vec3;
use funicular::robot::Robot;
use funicular::statics::CableState;
use serde::Serialize;

/// Distance from the exit point to the fixed point of the spring where it needs none in particular [m].
const ANY_DISTANCE: f64 = 1.0;

/// Ratio of the coupling between slip and sideways motion to the root of both stiffnesses above which it is reported as
/// left out. A vertical swivel axis leaves rounding.
const COUPLED: f64 = 1e-9;

/// Support of the last joint of a chain.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Support {
    /// Fixed point of the spring behind the exit point, world axes [m].
    pub(crate) behind: [f64; 3],
    /// Axial stiffness of the spring [N/m].
    pub(crate) stiffness: f64,
    /// Tension of the spring [N].
    pub(crate) tension: f64,
    /// Unit vectors in which the joint is held, world axes.
    pub(crate) held: Vec<[f64; 3]>,
}

impl Support {
    /// Support of cable `i`, whose chain with its load [N] stands for the free span; `None` where the end is held.
    ///
    /// # Errors
    /// A swivel that is not stable.
    pub(crate) fn of(
        robot: &Robot,
        i: usize,
        state: &CableState,
        chain: &Chain,
        load_w: &Vec3,
        warnings: &mut Vec<String>,
    ) -> Result<Option<Self>> {
        let Some(end) = state.drive.as_ref().map(|drive| &drive.end) else { return Ok(None) };
        let Some(along_w) = end.along_w else { return Ok(None) };
        let name = &robot.cables[i].name;
        let [[slip, coupling], [_, sideways]] = end.stiffness;

        // The pull of the chain along the cable. The rest of it, normal to the cable, is an error of the chain.
        let pull_w = state.force_on_platform_w - load_w * chain.weight_factor;
        let tension = -pull_w.dot(&along_w);

        let normal_w = match end.sideways_w {
            None => along_w.cross(&Vec3::ith(along_w.iamin(), 1.0)).normalize(),
            Some(sideways_w) => sideways_w.cross(&along_w),
        };
        let mut held = vec![normal_w];
        let mut distance = ANY_DISTANCE;
        if end.sideways_w.is_some() {
            if sideways <= 0.0 {
                bail!(
                    "cable \"{name}\" wraps more than half of its wheel, whose swivel is then unstable: a spring of \
                     OpenSees cannot stand for it; choose another pose or another `entry_direction`"
                );
            }
            distance = tension / sideways;
            if coupling.abs() > COUPLED * (slip * sideways).sqrt() {
                warnings.push(format!(
                    "cable \"{name}\": the swivel axis of its pulley is not parallel to the load of the cable; the \
                     coupling of slip and sideways motion, {coupling:.2e} N/m beside {slip:.2e} N/m and {sideways:.2e} \
                     N/m, is left out"
                ));
            }
        } else {
            held.push(along_w.cross(&normal_w));
        }
        Ok(Some(Self {
            behind: (state.anchor_w - along_w * distance).into(),
            stiffness: slip,
            tension,
            held: held.into_iter().map(Into::into).collect(),
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use funicular::robot::State;
    use funicular::statics::{self, Equilibrium, StaticModel};

    /// Six cables over pulleys, with `axis` as the direction in which they enter, to winches that yield.
    fn driven(axis: &str) -> (Robot, Equilibrium) {
        let text = funicular_robots::YUAN2014_4MM
            .replace("[[cables]]", "[[cables]]\npulley = \"wheel\"\nwinch = \"drum\"")
            + &format!(
                "\n[pulleys.wheel]\nradius_m = 0.05\nentry_direction = {axis}\n[winches.drum]\n\
                 drum_side_length_m = 3.0\n\
                 stiffness_n_per_m = 5e4\n"
            );
        let robot = Robot::from_toml(&text).unwrap();
        let State::Lengths(lengths) = &robot.state else { panic!("given by lengths") };
        let lengths: Vec<f64> = lengths.iter().map(|length| length + 3.1).collect();
        let rest = statics::forward(&robot, &lengths, StaticModel::Catenary, None).unwrap();
        (robot, rest)
    }

    fn supports(axis: &str, warnings: &mut Vec<String>) -> Vec<(Support, CableState)> {
        let (robot, rest) = driven(axis);
        let of = |(i, state): (usize, &CableState)| {
            let chain = Chain::of(&robot, &rest, i, 40).unwrap();
            let load_w = robot.gravity_w * (robot.cables[i].material.mass_per_length * state.free_length());
            let support = Support::of(&robot, i, state, &chain, &load_w, warnings).unwrap();
            (support.expect("the cable has a winch"), state.clone())
        };
        rest.cables.iter().enumerate().map(of).collect()
    }

    #[test]
    fn the_spring_is_fixed_where_the_line_of_the_cable_meets_the_swivel_axis() {
        let mut warnings = Vec::new();
        let (robot, _) = driven("[0, 0, 1]");
        for ((support, state), cable) in supports("[0, 0, 1]", &mut warnings).into_iter().zip(&robot.cables) {
            let behind = Vec3::from(support.behind);
            let entry_w = cable.anchor.reference_w();
            // Weight on the wheel moves it by the weight of the arc over the tension, 3e-4 of its distance of 0.1 m.
            assert!((behind - entry_w).xy().norm() < 1e-4, "{behind} and {entry_w}");
            let contact = state.drive.as_ref().unwrap().contact.unwrap();
            let distance = contact.radius * (0.5 * contact.wrap).tan();
            assert!(((state.anchor_w - behind).norm() / distance - 1.0).abs() < 1e-3);
            assert!((support.tension / state.tension_anchor - 1.0).abs() < 1e-4);

            // In series: EA over arc and drum side, and the winch.
            let compliance = (3.0 + contact.arc()) / cable.material.axial_stiffness + 1.0 / 5e4;
            assert!((support.stiffness * compliance - 1.0).abs() < 1e-2, "{}", support.stiffness);
            assert_eq!(support.held.len(), 1);
        }
        assert!(warnings.is_empty(), "{warnings:?}");
    }

    #[test]
    fn a_tilted_swivel_axis_is_reported() {
        let mut warnings = Vec::new();
        supports("[0.3, 0, 1]", &mut warnings);
        assert!(!warnings.is_empty() && warnings[0].contains("is left out"), "{warnings:?}");
    }
}

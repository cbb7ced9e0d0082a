//! Second derivatives of the force of a cable over a pulley: of its derivative by τ, the exit point following, by all
//! that the cable depends on at the same τ.
//!
//! Numbers with derivatives give those by the place of the pulley, by the load and by τ. The others follow from
//! symmetries, without a further derivative: forces scale together, lengths scale together, and the cable turns with
//! all that it hangs on (docs/theory.md, (60t5)).

use super::TensionCurve;
use crate::drive::at_tension::AtTension;
use crate::drive::derivatives::{OuterRow, VARIABLES, place};
use crate::math::dual::{Real, dot};
use crate::math::jet::Jet;
use crate::math::{Mat3, Vec3};

/// Orders that are right one after the other: the derivative by τ, and that of it.
const ORDERS: usize = 2;

/// CurveChange with the variable t of the jets.
#[derive(Debug, Clone, Copy, Default)]
struct CurveChange {
    /// Point of the pulley [m].
    reach_w: Vec3,
    /// Load per unstrained length [N/m].
    load_w: Vec3,
    /// Tension τ [N].
    tau: f64,
}

impl TensionCurve<'_> {
    /// Second derivatives of the force on the platform, as far as it acts along a vector: of [`Self::force_by_tau`] by
    /// the outer variables of the cable at the same τ, and by τ in the place of the length. The winch and the drum side
    /// do not count at the same τ. `None` for a fixed exit point.
    pub(crate) fn second_by_outer(&self, along_w: &Vec3) -> Option<OuterRow> {
        let contact = self.contact.filter(|_| self.has_moving_exit())?;
        let rope = self.span.catenary.rope();
        let by_tension = self.at_tension().by_tension(self.tau, rope.unstrained_length)?;
        let by = |change: CurveChange| self.force_by_tau_along(&change, along_w, &by_tension.inverse);

        // By the place of the pulley, the load and τ.
        let unit = |k: usize| Vec3::from_fn(|i, _| f64::from(u8::from(i == k)));
        let [by_reach, by_load] = [true, false].map(|is_reach| {
            Vec3::from_fn(|k, _| {
                let (moved, none) = (unit(k), Vec3::zeros());
                let (reach_w, load_w) = if is_reach { (moved, none) } else { (none, moved) };
                by(CurveChange { reach_w, load_w, tau: 0.0 })
            })
        });
        let by_tau = by(CurveChange { tau: 1.0, ..CurveChange::default() });

        // By the other variables, from the symmetries.
        let (reach_w, load_w) = (self.cable().anchor.point_w - self.span.start_w, self.span.load_w());
        let by_stiffness = -(load_w.dot(&by_load) + self.tau * by_tau) / rope.axial_stiffness;
        let by_radius = (load_w.dot(&by_load) - reach_w.dot(&by_reach)) / contact.radius;
        let by_turn = by_tension.force_w.cross(along_w) - reach_w.cross(&by_reach) - load_w.cross(&by_load);

        let mut row = [0.0; VARIABLES];
        row[place::REACH..place::LOAD].copy_from_slice(by_reach.as_slice());
        row[place::LOAD..place::AXIAL_STIFFNESS].copy_from_slice(by_load.as_slice());
        row[place::AXIAL_STIFFNESS] = by_stiffness;
        row[place::RADIUS] = by_radius;
        row[place::TURN..place::DRUM_SIDE].copy_from_slice(by_turn.as_slice());
        row[place::LENGTH] = by_tau;
        row.iter().all(|number| number.is_finite()).then_some(row)
    }

    /// Derivative, along a change, of the force on the platform by τ, as far as it acts along a vector.
    fn force_by_tau_along(&self, change: &CurveChange, along_w: &Vec3, inverse: &Mat3) -> f64 {
        let fixed = self.at_tension();
        let number = |value: f64, rate: f64| Jet::<2>::of_time([value, rate, 0.0]);
        let load_w = self.span.load_w();
        let load: [_; 3] = std::array::from_fn(|k| number(load_w[k], change.load_w[k]));
        let size = dot(&load, &load).sqrt();
        let at = AtTension {
            // The pulley moves against the attachment.
            start_w: std::array::from_fn(|k| number(self.span.start_w[k], -change.reach_w[k])),
            load: size,
            up_w: load.map(|component| -(component / size)),
            axial_stiffness: fixed.axial_stiffness,
            anchor: fixed.anchor,
            contact: fixed.contact,
            load_turns: true,
        };
        let tau = Jet::<2> { rows: [[self.tau, change.tau, 0.0], [1.0, 0.0, 0.0]] };
        let (span, _) = at.along(tau, self.span.catenary.rope().unstrained_length, inverse, ORDERS);
        (0..3).map(|k| along_w[k] * span.force_w[k].rows[1][1]).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::super::{exit_points, force_by_tau_over_pulley};
    use super::*;
    use crate::catenary::Rope;
    use crate::catenary::space::HangingCable;
    use crate::math::Rotation;
    use crate::robot::{PulleyContact, Robot};
    use crate::statics::{self, StaticModel};

    /// Step of differences over the size of what changes. They are of the fourth order: the step leaves 1e-12 of a
    /// second derivative, and rounding leaves 1e-12.
    const PART: f64 = 1e-3;

    /// Derivative of the force by τ after a change of one of the outer variables, with the exit point found again.
    fn force_by_tau_after(
        curve: &TensionCurve<'_>,
        contact: PulleyContact,
        variable: usize,
        change: f64,
    ) -> Option<Vec3> {
        let unit = |k: usize| Vec3::from_fn(|i, _| f64::from(u8::from(i == k)));
        let mut cable = curve.cable().clone();
        let (mut load_w, mut rope, mut tau) = (curve.span.load_w(), curve.span.catenary.rope(), curve.tau);
        match variable {
            place::REACH..place::LOAD => cable.anchor.point_w += unit(variable - place::REACH) * change,
            place::LOAD..place::AXIAL_STIFFNESS => load_w += unit(variable - place::LOAD) * change,
            place::AXIAL_STIFFNESS => rope.axial_stiffness += change,
            place::LENGTH => tau += change,
            _ => {}
        }
        if let Some(pulley) = &mut cable.anchor.pulley {
            match variable {
                place::RADIUS => pulley.radius += change,
                place::TURN..place::DRUM_SIDE => {
                    let turn = Rotation::from_scaled_axis(unit(variable - place::TURN) * change);
                    pulley.entry_direction_w = turn * pulley.entry_direction_w;
                }
                _ => {}
            }
        }

        let rope = Rope { weight_per_length: load_w.norm(), ..rope };
        let up_w = -load_w / rope.weight_per_length;
        let span = HangingCable::with_parallel_tension(curve.span.start_w, curve.span.end_w, up_w, rope, tau);
        let (span, contact) = exit_points::at_own_exit_point(&cable, &span, contact, tau);
        force_by_tau_over_pulley(&cable, &span, contact, tau)
    }

    /// Differences of the fourth order, each with its size.
    fn by_differences(curve: &TensionCurve<'_>, along_w: &Vec3) -> Vec<(usize, f64, f64)> {
        let (contact, rope) = (curve.contact.unwrap(), curve.span.catenary.rope());
        let size = |variable: usize| match variable {
            place::REACH..place::LOAD => curve.span.chord_w().norm(),
            place::LOAD..place::AXIAL_STIFFNESS => rope.weight_per_length,
            place::AXIAL_STIFFNESS => rope.axial_stiffness,
            place::RADIUS => contact.radius,
            place::LENGTH => curve.tau,
            _ => 1.0,
        };
        (0..VARIABLES)
            .filter(|variable| !(place::DRUM_SIDE..place::LENGTH).contains(variable))
            .map(|variable| {
                let step = PART * size(variable);
                let at = |parts: f64| along_w.dot(&force_by_tau_after(curve, contact, variable, parts * step).unwrap());
                (variable, (8.0 * (at(1.0) - at(-1.0)) - (at(2.0) - at(-2.0))) / (12.0 * step), size(variable))
            })
            .collect()
    }

    #[test]
    fn second_derivatives_of_the_force_over_a_pulley_are_those_of_differences() {
        let mut compared = 0;
        for text in [funicular_robots::COGIRO_WINCHES, funicular_robots::GRAB_3_CABLES, funicular_robots::GRAB_4_CABLES]
        {
            for (load_w, tilt) in [(Vec3::zeros(), 0.0), (Vec3::new(0.3, -0.2, 0.0), 0.15)] {
                let mut robot = Robot::from_toml(text).unwrap();
                for (i, cable) in robot.cables.iter_mut().enumerate() {
                    let axis_w = Vec3::new(1.0, 0.4 * i as f64, -0.2);
                    let turn = Rotation::from_scaled_axis(axis_w.normalize() * tilt);
                    cable.load_per_length_w = load_w;
                    if let Some(pulley) = &mut cable.anchor.pulley {
                        pulley.entry_direction_w = turn * pulley.entry_direction_w;
                    }
                }
                let Ok(found) = statics::solve(&robot, StaticModel::Catenary, None) else { continue };
                for (i, state) in found.equilibrium.cables.iter().enumerate() {
                    let mut curve = TensionCurve::of_state(&robot, i, state).unwrap();
                    // A slack cable and a taut one.
                    for tau in [curve.tau(), 0.2 * curve.tau()] {
                        curve.set(tau);
                        let along_w = Vec3::new(0.3, -0.7, 0.9);
                        let Some(row) = curve.second_by_outer(&along_w) else { continue };
                        let wanted = by_differences(&curve, &along_w);
                        let most = wanted.iter().fold(0.0_f64, |most, (_, by, size)| most.max((by * size).abs()));
                        for (variable, by, size) in wanted {
                            let off = ((row[variable] - by) * size).abs();
                            assert!(off <= 1e-9 * most, "{i} {variable}: {} {by}, {most}", row[variable]);
                            compared += 1;
                        }
                    }
                }
            }
        }
        assert!(compared > 300, "{compared}");
    }
}

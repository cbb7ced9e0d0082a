//! Centres and angles of arcs in G-code.

use super::words::Block;
use super::{Interpreter, Motion, OFFSETS};
use std::f64::consts::TAU;

/// Difference of both radii of an arc that is rounding of its numbers: within 0.005 mm or a thousandth of the radius,
/// and never more than 0.5 mm, as Grbl has it.
const ROUNDING_M: f64 = 5e-6;
const ROUNDING: f64 = 1e-3;
const MAX_ROUNDING_M: f64 = 5e-4;

/// Angle below which start and end are one point, and the arc a whole circle [rad].
const SAME_POINT: f64 = 1e-9;

/// Difference of two lengths that is rounding for a radius [m].
fn rounding(radius: f64) -> f64 {
    (ROUNDING * radius).clamp(ROUNDING_M, MAX_ROUNDING_M)
}

impl Interpreter {
    /// Centre [m] and angle [rad] of an arc to this end; positive angles by the right-hand rule about the axis.
    pub(super) fn arc(&self, block: &Block, end: [f64; 3], motion: Motion) -> Result<([f64; 3], f64), String> {
        // Axes of the plane in the order in which the third is their normal.
        let [u, v] = [(self.axis + 1) % 3, (self.axis + 2) % 3];
        let is_left = motion == Motion::Counterclockwise;
        let offsets = OFFSETS.map(|letter| block.value(letter).map(|value| value * self.metres));
        let turns = turns(block)?;
        if offsets[self.axis].is_some_and(|offset| offset != 0.0) {
            return Err(format!("{} points out of the plane of the arc", OFFSETS[self.axis]));
        }

        let mut center = self.position;
        match (block.value('R'), offsets[u].is_some() || offsets[v].is_some()) {
            (Some(_), true) => return Err("an arc has a radius R or a centre by I, J and K, not both".to_owned()),
            (None, false) => return Err("an arc needs its centre by I, J and K, or its radius R".to_owned()),
            (Some(radius), false) => {
                let way = [end[u] - self.position[u], end[v] - self.position[v]];
                let [along_u, along_v] = center_of_radius(way, radius * self.metres, is_left)?;
                center[u] += along_u;
                center[v] += along_v;
            }
            (None, true) => {
                for k in [u, v] {
                    let given = offsets[k];
                    center[k] = match given {
                        Some(given) if self.are_centers_absolute => given,
                        given => self.position[k] + given.unwrap_or_default(),
                    };
                }
            }
        }

        let from = [self.position[u] - center[u], self.position[v] - center[v]];
        let to = [end[u] - center[u], end[v] - center[v]];
        let [radius, at_end] = [from, to].map(|[x, y]| x.hypot(y));
        if radius <= ROUNDING_M * 1e-3 || (radius - at_end).abs() > rounding(radius) {
            return Err(format!(
                "the arc does not close: its start is {:.4} mm from the centre and its end {:.4} mm",
                1e3 * radius,
                1e3 * at_end
            ));
        }
        let turn = (from[0] * to[1] - from[1] * to[0]).atan2(from[0] * to[0] + from[1] * to[1]);
        let part = if is_left { turn.rem_euclid(TAU) } else { (-turn).rem_euclid(TAU) };
        let part = if part < SAME_POINT || TAU - part < SAME_POINT { TAU } else { part };
        let whole = part + TAU * (turns - 1.0);
        Ok((center, if is_left { whole } else { -whole }))
    }
}

/// Number of turns of an arc, by P: 1 for an arc of at most a whole circle.
fn turns(block: &Block) -> Result<f64, String> {
    let turns = block.value('P').unwrap_or(1.0);
    if turns < 1.0 || turns.fract() != 0.0 || turns > 1000.0 {
        return Err(format!("P{turns} is no number of turns of an arc: give a whole number from 1 on"));
    }
    Ok(turns)
}

/// Centre of an arc from its start: a positive radius is the shorter arc, a negative one the longer.
fn center_of_radius([x, y]: [f64; 2], radius: f64, is_left: bool) -> Result<[f64; 2], String> {
    let chord = x.hypot(y);
    if chord == 0.0 {
        return Err("an arc with a radius R ends where it begins: give its centre by I and J".to_owned());
    }
    let size = radius.abs();
    let square = size * size - 0.25 * chord * chord;
    if 0.5 * chord - size > rounding(size) {
        return Err(format!(
            "an arc of radius {:.4} mm does not reach its end, {:.4} mm away",
            1e3 * size,
            1e3 * chord
        ));
    }
    // The centre of the shorter arc that turns left is to the left of the chord.
    let height = square.max(0.0).sqrt() / chord;
    let side = if is_left == (radius > 0.0) { height } else { -height };
    Ok([0.5 * x - side * y, 0.5 * y + side * x])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_center_is_at_the_radius_from_both_ends_on_the_side_of_the_turn() {
        for (radius, is_left, center) in
            [(5.0, true, [3.0, 4.0]), (5.0, false, [3.0, -4.0]), (-5.0, true, [3.0, -4.0]), (-5.0, false, [3.0, 4.0])]
        {
            let found = center_of_radius([6.0, 0.0], radius, is_left).unwrap();
            assert!((found[0] - center[0]).hypot(found[1] - center[1]) < 1e-12, "{radius} {is_left}: {found:?}");
        }
        assert!((center_of_radius([2.0, 0.0], 1.0, true).unwrap()[0] - 1.0).abs() < 1e-12);
        assert!(center_of_radius([2.1, 0.0], 1.0, true).unwrap_err().contains("does not reach"));
    }
}

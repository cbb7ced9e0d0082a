//! One rope in space as elements of degree p between the platform and its anchor: forces, Newton matrix, energies.
//!
//! σ in [0, 1] runs from the platform to the anchor and stands for the share of the unstrained length, which the winch
//! changes. Nodes are stored one after the other, three numbers each, with the anchor last.

use super::basis::ElementBasis;
#[cfg(test)]
use super::skyline::Skyline;
use crate::math::{Mat3, Vec3};
use crate::robot::Wind;
use std::sync::Arc;

/// Unstrained length of a rope at one time, with its rate and acceleration [m, m/s, m/s²].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WoundLength {
    /// Unstrained length [m].
    pub value: f64,
    /// Rate, positive while the winch pays out [m/s].
    pub rate: f64,
    /// Acceleration [m/s²].
    pub acceleration: f64,
}

/// Rope as a mesh; its state is kept by the system.
#[derive(Debug, Clone)]
pub(super) struct RopeMesh {
    pub(super) basis: Arc<ElementBasis>,
    pub(super) elements: usize,
    /// Mass per unstrained length [kg/m].
    pub(super) mass: f64,
    /// Axial stiffness EA [N].
    pub(super) stiffness: f64,
    /// Damping time τ of the stretch [s].
    pub(super) damping_time: f64,
    /// Viscous damping per unstrained length [N s/m²].
    pub(super) viscous: f64,
    /// Weight and further dead load per unstrained length [N/m].
    pub(super) load_w: Vec3,
    /// Gravity [m/s²].
    pub(super) gravity_w: Vec3,
    /// Drag coefficient times diameter [m].
    pub(super) drag_width: f64,
}

/// Factors of mass, damping and stiffness in a Newton matrix.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Newton {
    /// Factor of the mass: 1/(hγ) in a step, 0 at rest.
    pub(super) mass: f64,
    /// Factor of the damping: 1 in a step.
    pub(super) damping: f64,
    /// Factor of the stiffness: hγ in a step, 1 at rest.
    pub(super) stiffness: f64,
}

/// Border of a rope's Newton matrix: what depends on the free length and on the place of the far end.
#[derive(Debug, Clone)]
pub(super) struct Border {
    /// Between the free length and each node, three numbers each.
    pub(super) by_length: Vec<f64>,
    /// Derivative by the free length itself.
    pub(super) of_length: f64,
    /// Between the far end and the nodes of the last element, itself included.
    pub(super) by_end: Vec<Mat3>,
}

impl Border {
    pub(super) fn new(rope: &RopeMesh) -> Self {
        let blocks = rope.basis.degree + 1;
        Self { by_length: vec![0.0; rope.size()], of_length: 0.0, by_end: vec![Mat3::zeros(); blocks] }
    }

    fn clear(&mut self) {
        self.by_length.fill(0.0);
        self.of_length = 0.0;
        self.by_end.fill(Mat3::zeros());
    }
}

/// Energy of a rope [J] and the powers that change it [W].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct RopeEnergy {
    pub(super) kinetic: f64,
    pub(super) strain: f64,
    pub(super) potential: f64,
    /// Power of wind and dead loads.
    pub(super) loads: f64,
    /// Power lost in the rope and against still air by viscous damping, not negative.
    pub(super) dissipation: f64,
    /// Power that the winch gives with the rope that passes the anchor.
    pub(super) winch: f64,
}

impl RopeEnergy {
    /// With what lies behind the exit point; if rope passes there, its winch is not at the anchor.
    pub(super) fn with_far_end(self, behind: &Self, passes: bool) -> Self {
        Self {
            kinetic: self.kinetic + behind.kinetic,
            strain: self.strain + behind.strain,
            potential: self.potential + behind.potential,
            loads: self.loads + behind.loads,
            dissipation: self.dissipation + behind.dissipation,
            winch: if passes { behind.winch } else { self.winch },
        }
    }
}

/// Place of an index of a node among the numbers of a rope.
#[inline]
fn at(values: &[f64], node: usize) -> Vec3 {
    Vec3::new(values[3 * node], values[3 * node + 1], values[3 * node + 2])
}

#[inline]
fn add(values: &mut [f64], node: usize, vector: &Vec3) {
    for axis in 0..3 {
        values[3 * node + axis] += vector[axis];
    }
}

/// Σ slopes · values over the nodes of an element.
#[inline]
fn along(slopes: &[f64], values: &[f64]) -> Vec3 {
    let (mut x, mut y, mut z) = (0.0, 0.0, 0.0);
    for (slope, value) in slopes.iter().zip(values.chunks_exact(3)) {
        x += slope * value[0];
        y += slope * value[1];
        z += slope * value[2];
    }
    Vec3::new(x, y, z)
}

/// Strain at one Gauss point.
struct Stretch {
    /// Tangent, a unit vector.
    tangent: Vec3,
    /// Ratio of lengths λ.
    ratio: f64,
    /// Rate of λ [1/s].
    rate: f64,
    /// Tension [N], not negative.
    tension: f64,
}

/// Ratio of lengths below which a rope counts as folded; ropes in use have 1.
pub(super) const FOLDED: f64 = 0.1;

impl RopeMesh {
    /// Index of the anchor's node.
    #[inline]
    pub(super) fn last(&self) -> usize {
        self.elements * self.basis.degree
    }

    /// Count of numbers of its state: three for each node.
    #[inline]
    pub(super) fn size(&self) -> usize {
        3 * (self.last() + 1)
    }

    /// Nodes of element `e` among the numbers of a rope.
    #[inline]
    fn of_element(&self, e: usize) -> std::ops::Range<usize> {
        3 * e * self.basis.degree..3 * ((e + 1) * self.basis.degree + 1)
    }

    /// Mass that is lumped to the platform's end [kg].
    pub(super) fn end_mass(&self, length: f64) -> f64 {
        self.mass * length * self.basis.weights[0] / self.elements as f64
    }

    /// Stretch at Gauss point `g` of an element.
    ///
    /// # References
    /// docs/theory.md, equations (97a) and (97e).
    #[inline]
    fn stretch(&self, length: &WoundLength, g: usize, x: &[f64], v: &[f64]) -> Stretch {
        let per_length = self.elements as f64 / length.value;
        let slope = along(self.basis.at_gauss(g), x) * per_length;
        let ratio = slope.norm();
        let tangent = if ratio > 0.0 { slope / ratio } else { Vec3::zeros() };
        let rate = if self.damping_time > 0.0 {
            let slope_rate = along(self.basis.at_gauss(g), v) * per_length;
            tangent.dot(&slope_rate) - ratio * length.rate / length.value
        } else {
            0.0
        };
        let tension = (self.stiffness * (ratio - 1.0 + self.damping_at(ratio) * rate)).max(0.0);
        Stretch { tangent, ratio, rate, tension }
    }

    /// Damping time at a ratio of lengths [s]. It fades where the rope folds: a point that has folded onto itself has
    /// no tangent, and a tension there would jump from one direction to the opposite one.
    ///
    /// # References
    /// docs/theory.md, equation (97e1).
    #[inline]
    fn damping_at(&self, ratio: f64) -> f64 {
        self.damping_time * (ratio / FOLDED).min(1.0)
    }

    /// Adds to `out` what the nodes need for the motion besides the inner forces, which a [`RopePack`] has added:
    /// inertia less weight, wind and damping. With both, `out` has at the ends the forces that platform and anchor
    /// exert on the rope.
    ///
    /// # References
    /// docs/theory.md, equation (97d).
    ///
    /// [`RopePack`]: super::side_by_side::RopePack
    pub(super) fn add_outer_forces(
        &self,
        length: &WoundLength,
        winds: &[Wind],
        [x, v, a]: [&[f64]; 3],
        out: &mut [f64],
    ) {
        for e in 0..self.elements {
            let nodes = self.of_element(e);
            let (x, v, out) = (&x[nodes.clone()], &v[nodes.clone()], &mut out[nodes.clone()]);
            self.lumped_forces(length, winds, e, [x, v, &a[nodes]], out);
            if length.rate != 0.0 || length.acceleration != 0.0 {
                self.winding_forces(length, e, x, v, out);
            }
        }
    }

    /// Adds the inner forces of the rope alone to `out`.
    #[cfg(test)]
    pub(super) fn add_inner_forces(&self, length: &WoundLength, x: &[f64], v: &[f64], out: &mut [f64]) {
        for e in 0..self.elements {
            let nodes = self.of_element(e);
            for g in 0..self.basis.degree {
                let Stretch { tangent, tension, .. } = self.stretch(length, g, &x[nodes.clone()], &v[nodes.clone()]);
                for (q, slope) in self.basis.at_gauss(g).iter().enumerate() {
                    let force = tangent * (tension * self.basis.gauss_weights[g] * slope);
                    add(out, e * self.basis.degree + q, &force);
                }
            }
        }
    }

    /// Inertia, dead load and damping of the nodes.
    #[inline]
    fn lumped_forces(&self, length: &WoundLength, winds: &[Wind], e: usize, [x, v, a]: [&[f64]; 3], out: &mut [f64]) {
        let share = length.value / self.elements as f64;
        let has_drag = self.drag_width > 0.0;
        for q in 0..=self.basis.degree {
            let part = share * self.basis.weights[q];
            let (mass, viscous) = (part * self.mass, part * self.viscous);
            for axis in 0..3 {
                let k = 3 * q + axis;
                out[k] += mass * a[k] - part * self.load_w[axis];
            }
            if !has_drag && self.viscous == 0.0 {
                continue;
            }
            let velocity = self.velocity(length, e, q, x, v);
            let mut force = velocity * viscous;
            if has_drag {
                force -= self.drag(self.wind_at(winds, e, q), q, x, &velocity) * part;
            }
            add(out, q, &force);
        }
    }

    /// Velocity of the rope itself at node `q` of element `e` [m/s]; it moves along σ while the winch turns.
    #[inline]
    fn velocity(&self, length: &WoundLength, e: usize, q: usize, x: &[f64], v: &[f64]) -> Vec3 {
        if length.rate == 0.0 {
            return at(v, q);
        }
        // σ times the number of elements.
        let place = e as f64 + self.basis.nodes[q];
        at(v, q) - along(self.basis.at_node(q), x) * (place * length.rate / length.value)
    }

    /// Wind at node `q` of element `e`: winds are those of equal pieces of the rope.
    #[inline]
    fn wind_at<'a>(&self, winds: &'a [Wind], e: usize, q: usize) -> &'a Wind {
        let sigma = (e as f64 + self.basis.nodes[q]) / self.elements as f64;
        &winds[((sigma * winds.len() as f64) as usize).min(winds.len() - 1)]
    }

    /// Drag per unstrained length at node `q` of an element [N/m].
    #[inline]
    fn drag(&self, wind: &Wind, q: usize, x: &[f64], velocity: &Vec3) -> Vec3 {
        let slope = along(self.basis.at_node(q), x);
        let tangent = slope.try_normalize(0.0).unwrap_or_else(Vec3::zeros);
        let relative = Wind { velocity_w: wind.velocity_w - velocity, ..*wind };
        relative.cross_pressure_w(&tangent) * self.drag_width
    }

    /// Inertia of the rope that moves along σ while the winch turns.
    fn winding_forces(&self, length: &WoundLength, e: usize, x: &[f64], v: &[f64], out: &mut [f64]) {
        let count = self.elements as f64;
        for q in 0..=self.basis.degree {
            let slopes = self.basis.at_node(q);
            let (x_slope, v_slope) = (along(slopes, x) * count, along(slopes, v) * count);
            let sigma = (e as f64 + self.basis.nodes[q]) / count;
            let part = self.mass * self.basis.weights[q] / count;
            let velocity = at(v, q);

            let at_node =
                (velocity * length.rate - (x_slope * length.acceleration + v_slope * length.rate) * sigma) * part;
            add(out, q, &at_node);
            // −m L c (w + c x_σ), with L c = −σ L'.
            let flow = -sigma * length.rate;
            let momentum = (velocity + x_slope * (flow / length.value)) * (-part * flow * count);
            for (out, slope) in out.chunks_exact_mut(3).zip(slopes) {
                out[0] += slope * momentum.x;
                out[1] += slope * momentum.y;
                out[2] += slope * momentum.z;
            }
        }
    }

    /// Force that the free length needs but for what lies behind the exit point, conjugate to it [N]. Heights count
    /// from `entry_w`.
    ///
    /// # References
    /// docs/theory.md, equation (97l).
    pub(super) fn needed_by_length(
        &self,
        length: &WoundLength,
        winds: &[Wind],
        [x, v, a]: [&[f64]; 3],
        entry_w: &Vec3,
    ) -> f64 {
        let of_end = self.of_element(self.elements - 1);
        let (x_end, v_end, q) = (&x[of_end.clone()], &v[of_end], self.basis.degree);
        let velocity = self.velocity(length, self.elements - 1, q, x_end, v_end);
        let x_slope = along(self.basis.at_node(q), x_end) * self.elements as f64;
        let passing = self.mass * (length.rate / length.value * velocity.dot(&x_slope) + 0.5 * velocity.norm_squared());
        self.length_force(length, winds, [x, v, a], entry_w) + passing
    }

    /// Force conjugate to the unstrained length [N] of the rope as a whole, with what enters at the anchor: its product
    /// with the rate is the power that comes in there. Heights count from `entry_w`.
    fn length_force(&self, length: &WoundLength, winds: &[Wind], [x, v, a]: [&[f64]; 3], entry_w: &Vec3) -> f64 {
        let count = self.elements as f64;
        let ratio = length.rate / length.value;
        let change = length.acceleration / length.value - ratio * ratio;
        let mut sum = 0.0;
        for e in 0..self.elements {
            let nodes = self.of_element(e);
            let (x, v, a) = (&x[nodes.clone()], &v[nodes.clone()], &a[nodes]);
            for q in 0..=self.basis.degree {
                let slopes = self.basis.at_node(q);
                let (x_slope, v_slope) = (along(slopes, x) * count, along(slopes, v) * count);
                let sigma = (e as f64 + self.basis.nodes[q]) / count;
                let part = self.basis.weights[q] / count;
                let velocity = at(v, q) - x_slope * (sigma * ratio);
                let acceleration = at(a, q) - (x_slope * change + v_slope * ratio) * sigma;
                let inertia = -sigma * (acceleration.dot(&x_slope) + velocity.dot(&v_slope))
                    - 0.5 * velocity.norm_squared()
                    - sigma * ratio * velocity.dot(&x_slope);
                sum += part * (self.mass * inertia - self.load_w.dot(&(at(x, q) - entry_w)));
                let mut lost = velocity * self.viscous;
                if self.drag_width > 0.0 {
                    lost -= self.drag(self.wind_at(winds, e, q), q, x, &velocity);
                }
                sum -= part * sigma * lost.dot(&x_slope);
            }
            for g in 0..self.basis.degree {
                let Stretch { ratio, tension, .. } = self.stretch(length, g, x, v);
                let strain = (ratio - 1.0).max(0.0);
                sum += self.basis.gauss_weights[g] / count * (0.5 * self.stiffness * strain * strain - tension * ratio);
            }
        }
        sum
    }

    /// Border of the Newton matrix for a rope whose far end moves and through which rope passes, written to `border`.
    ///
    /// # References
    /// docs/theory.md, equation (97p).
    pub(super) fn border(&self, length: &WoundLength, x: &[f64], v: &[f64], of: Newton, border: &mut Border) {
        border.clear();
        let (count, degree) = (self.elements as f64, self.basis.degree);
        let per_length = count / length.value;
        for e in 0..self.elements {
            let nodes = self.of_element(e);
            let (x, v) = (&x[nodes.clone()], &v[nodes]);
            for q in 0..=degree {
                let sigma = (e as f64 + self.basis.nodes[q]) / count;
                let x_slope = along(self.basis.at_node(q), x) * count;
                let part = self.basis.weights[q] / count;
                let sliding = x_slope * (-self.mass * sigma * of.mass);
                let entry = (sliding - self.load_w * of.stiffness) * part;
                add(&mut border.by_length, e * degree + q, &entry);
                border.of_length -= part * sigma * sliding.dot(&x_slope) / length.value;
            }
            for g in 0..degree {
                let Stretch { tangent, ratio, tension, .. } = self.stretch(length, g, x, v);
                if tension == 0.0 {
                    continue;
                }
                let stiff = (of.stiffness + self.damping_at(ratio) * of.damping) * self.stiffness;
                let weight = self.basis.gauss_weights[g];
                let slopes = self.basis.at_gauss(g);
                let by_length = tangent * (-stiff * ratio / length.value * weight);
                for (q, slope) in slopes.iter().enumerate() {
                    add(&mut border.by_length, e * degree + q, &(by_length * *slope));
                }
                border.of_length += weight / count * stiff * ratio * ratio / length.value;
                if e + 1 < self.elements {
                    continue;
                }
                let across = of.stiffness * tension / ratio;
                let block = tangent * tangent.transpose() * (stiff - across) + Mat3::identity() * across;
                let block = block * (weight * per_length * slopes[degree]);
                for (end, slope) in border.by_end.iter_mut().zip(slopes) {
                    *end += block * *slope;
                }
            }
        }
        let at_end = self.mass * of.mass + self.viscous * of.damping;
        border.by_end[degree] += Mat3::identity() * (at_end * length.value / count * self.basis.weights[degree]);
    }

    /// Numbers of the nodes after the free length has changed from `before` to `after`, the rope staying where it is;
    /// the numbers are those of a function of σ.
    pub(super) fn resampled(&self, before: f64, after: f64, values: &[f64]) -> Vec<f64> {
        self.sampled([0.0, after / before], values)
    }

    /// Numbers of the nodes of a mesh of this kind on the part of the rope between two shares σ of its free length.
    pub(super) fn sampled(&self, [from, to]: [f64; 2], values: &[f64]) -> Vec<f64> {
        let count = self.elements as f64;
        let mut out = Vec::with_capacity(values.len());
        for node in 0..=self.last() {
            let place = (from + (to - from) * self.share_of(node)) * count;
            let e = (place.floor().max(0.0) as usize).min(self.elements - 1);
            let of = &values[self.of_element(e)];
            let weights = self.basis.values(place - e as f64);
            for axis in 0..3 {
                out.push(weights.iter().zip(of[axis..].iter().step_by(3)).map(|(w, x)| w * x).sum());
            }
        }
        out
    }

    /// Share σ of the free length at a node.
    fn share_of(&self, node: usize) -> f64 {
        let e = (node / self.basis.degree).min(self.elements - 1);
        (e as f64 + self.basis.nodes[node - e * self.basis.degree]) / self.elements as f64
    }

    /// Velocities that the nodes have because σ moves along the rope while its length changes: σ L'/L times the slope
    /// of the rope. Where two elements meet the slope is that of the middle.
    pub(super) fn sliding(&self, length: &WoundLength, x: &[f64]) -> Vec<f64> {
        let (count, degree, ratio) = (self.elements as f64, self.basis.degree, length.rate / length.value);
        let mut out = vec![0.0; x.len()];
        if length.rate == 0.0 {
            return out;
        }
        for e in 0..self.elements {
            let nodes = &x[self.of_element(e)];
            for q in 0..=degree {
                let is_shared = (q == 0 && e > 0) || (q == degree && e + 1 < self.elements);
                let part = if is_shared { 0.5 } else { 1.0 };
                let node = e * degree + q;
                let slope = along(self.basis.at_node(q), nodes) * count;
                add(&mut out, node, &(slope * (part * ratio * self.share_of(node))));
            }
        }
        out
    }

    /// Rope itself at the exit point: its tangent times the ratio of lengths.
    pub(super) fn slope_at_end(&self, length: &WoundLength, x: &[f64]) -> Vec3 {
        let nodes = self.of_element(self.elements - 1);
        along(self.basis.at_node(self.basis.degree), &x[nodes]) * (self.elements as f64 / length.value)
    }

    /// Factor of each node in the Newton matrix over its length: inertia and the damping of its motion.
    pub(super) fn on_node(&self, wind: Option<&Wind>, of: Newton) -> f64 {
        let drag = wind.map_or(0.0, |wind| self.drag_width * wind.air_density * wind.velocity_w.norm());
        self.mass * of.mass + (self.viscous + drag) * of.damping
    }

    /// Adds the Newton matrix of the rope: the derivative of the needed forces by the velocities of a stage, without
    /// the terms of the winch and the turn of the damping.
    ///
    /// # References
    /// docs/theory.md, equation (97h).
    #[cfg(test)]
    pub(super) fn assemble(
        &self,
        length: &WoundLength,
        winds: &[Wind],
        x: &[f64],
        v: &[f64],
        of: Newton,
        matrix: &mut Skyline,
    ) {
        matrix.clear();
        let (free, degree) = (self.last(), self.basis.degree);
        let share = length.value / self.elements as f64;
        let per_length = self.elements as f64 / length.value;
        let on_node = self.on_node(winds.first(), of);

        for e in 0..self.elements {
            let nodes = self.of_element(e);
            let (x, v) = (&x[nodes.clone()], &v[nodes]);
            let from = e * degree;
            for (node, weight) in (from..free).zip(&self.basis.weights) {
                matrix.add(free, node, node, &(Mat3::identity() * (on_node * share * weight)));
            }
            for g in 0..degree {
                let Stretch { tangent, ratio, tension, .. } = self.stretch(length, g, x, v);
                if tension == 0.0 {
                    continue;
                }
                let along = (of.stiffness + self.damping_at(ratio) * of.damping) * self.stiffness;
                let across = of.stiffness * tension / ratio;
                let block = tangent * tangent.transpose() * (along - across) + Mat3::identity() * across;
                let block = block * (self.basis.gauss_weights[g] * per_length);
                let slopes = self.basis.at_gauss(g);
                for i in 0..=degree.min(free - 1 - from) {
                    for j in i..=degree.min(free - 1 - from) {
                        matrix.add(free, from + i, from + j, &(block * (slopes[i] * slopes[j])));
                    }
                }
            }
        }
    }

    /// Tension at the anchor [N] from the force that the anchor exerts on the last node: with the momentum of the rope
    /// that passes it.
    ///
    /// # References
    /// docs/theory.md, equation (97f).
    pub(super) fn anchor_tension(&self, length: &WoundLength, x: &[f64], reaction: &Vec3) -> f64 {
        (reaction + self.slope_at_end(length, x) * (self.mass * length.rate * length.rate)).norm()
    }

    /// Energies and powers. The power of the winch is that of the mesh, so that the books of a coarse mesh, of slack
    /// rope and of rope that runs out fast balance as well.
    ///
    /// # References
    /// docs/theory.md, equation (97g).
    pub(super) fn energy(&self, length: &WoundLength, winds: &[Wind], [x, v, a]: [&[f64]; 3]) -> RopeEnergy {
        let mut energy = RopeEnergy::default();
        let count = self.elements as f64;
        let share = length.value / count;
        let dead_load = self.load_w - self.gravity_w * self.mass;
        for e in 0..self.elements {
            let nodes = self.of_element(e);
            let (x, v) = (&x[nodes.clone()], &v[nodes]);
            for q in 0..=self.basis.degree {
                let part = share * self.basis.weights[q];
                let velocity = self.velocity(length, e, q, x, v);
                energy.kinetic += 0.5 * part * self.mass * velocity.norm_squared();
                energy.potential -= part * self.mass * self.gravity_w.dot(&at(x, q));
                energy.dissipation += part * self.viscous * velocity.norm_squared();
                energy.loads += part * dead_load.dot(&velocity);
                if self.drag_width > 0.0 {
                    energy.loads += part * self.drag(self.wind_at(winds, e, q), q, x, &velocity).dot(&velocity);
                }
            }
            for g in 0..self.basis.degree {
                let Stretch { ratio, rate, tension, .. } = self.stretch(length, g, x, v);
                let elastic = self.stiffness * (ratio - 1.0).max(0.0);
                let part = share * self.basis.gauss_weights[g];
                energy.strain += 0.5 * part * elastic * (ratio - 1.0).max(0.0);
                energy.dissipation += part * (tension - elastic) * rate;
            }
        }

        if length.rate != 0.0 {
            let anchor_w = at(x, self.last());
            let force = self.length_force(length, winds, [x, v, a], &anchor_w);
            energy.winch = length.rate * (force - self.mass * self.gravity_w.dot(&anchor_w));
        }
        energy
    }
}

//! One rope in space as elements of degree p between the platform and its anchor: forces, Newton matrix, energies.
//!
//! σ in [0, 1] runs from the platform to the anchor and stands for the share of the unstrained length, which the winch
//! changes. Nodes are stored one after the other, three numbers each, with the anchor last.

use super::basis::ElementBasis;
use super::skyline::Skyline;
use crate::math::{Mat3, Vec3};
use crate::robot::Wind;
use std::rc::Rc;

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
    pub(super) basis: Rc<ElementBasis>,
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
    /// Of the mass: 1/(hγ) in a step, 0 at rest.
    pub(super) mass: f64,
    /// Of the damping: 1 in a step.
    pub(super) damping: f64,
    /// Of the stiffness: hγ in a step, 1 at rest.
    pub(super) stiffness: f64,
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
        let tension = (self.stiffness * (ratio - 1.0 + self.damping_time * rate)).max(0.0);
        Stretch { tangent, ratio, rate, tension }
    }

    /// Forces that the nodes need for the motion: inertia and inner forces less weight, wind and damping, added to
    /// `out`. At the ends they are the forces that platform and anchor exert on the rope.
    ///
    /// # References
    /// docs/theory.md, equation (97d).
    pub(super) fn needed(&self, length: &WoundLength, wind: &Wind, x: &[f64], v: &[f64], a: &[f64], out: &mut [f64]) {
        for e in 0..self.elements {
            let nodes = self.of_element(e);
            let (x, v, out) = (&x[nodes.clone()], &v[nodes.clone()], &mut out[nodes.clone()]);
            self.inner_forces(length, x, v, out);
            self.lumped_forces(length, wind, e, [x, v, &a[nodes]], out);
            if length.rate != 0.0 || length.acceleration != 0.0 {
                self.winding_forces(length, e, x, v, out);
            }
        }
    }

    #[inline]
    fn inner_forces(&self, length: &WoundLength, x: &[f64], v: &[f64], out: &mut [f64]) {
        for g in 0..self.basis.degree {
            let Stretch { tangent, tension, .. } = self.stretch(length, g, x, v);
            if tension == 0.0 {
                continue;
            }
            let force = tangent * (tension * self.basis.gauss_weights[g]);
            for (out, slope) in out.chunks_exact_mut(3).zip(self.basis.at_gauss(g)) {
                out[0] += slope * force.x;
                out[1] += slope * force.y;
                out[2] += slope * force.z;
            }
        }
    }

    /// Inertia, dead load and damping of the nodes.
    #[inline]
    fn lumped_forces(&self, length: &WoundLength, wind: &Wind, e: usize, [x, v, a]: [&[f64]; 3], out: &mut [f64]) {
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
                force -= self.drag(wind, q, x, &velocity) * part;
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

    /// Adds the Newton matrix of the rope: the derivative of [`Self::needed`] by the velocities of a stage, without the
    /// terms of the winch and the turn of the damping.
    ///
    /// # References
    /// docs/theory.md, equation (97h).
    pub(super) fn assemble(
        &self,
        length: &WoundLength,
        wind: &Wind,
        x: &[f64],
        v: &[f64],
        of: Newton,
        matrix: &mut Skyline,
    ) {
        matrix.clear();
        let (free, degree) = (self.last(), self.basis.degree);
        let share = length.value / self.elements as f64;
        let per_length = self.elements as f64 / length.value;
        let drag = self.drag_width * wind.air_density * wind.velocity_w.norm();
        let on_node = self.mass * of.mass + (self.viscous + drag) * of.damping;

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
                let along = (of.stiffness + self.damping_time * of.damping) * self.stiffness;
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

    /// Tension at the anchor [N] from the force that the anchor exerts on the last node.
    ///
    /// # References
    /// docs/theory.md, equation (97f).
    pub(super) fn anchor_tension(&self, length: &WoundLength, reaction: &Vec3) -> f64 {
        let force = reaction.norm();
        let flux = self.mass * length.rate * length.rate;
        force + flux * (1.0 + force / self.stiffness)
    }

    /// Energies and powers; `anchor` is the force that the anchor exerts on the rope.
    ///
    /// # References
    /// docs/theory.md, equation (97g).
    pub(super) fn energy(&self, length: &WoundLength, wind: &Wind, x: &[f64], v: &[f64], anchor: &Vec3) -> RopeEnergy {
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
                    energy.loads += part * self.drag(wind, q, x, &velocity).dot(&velocity);
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

        let tension = self.anchor_tension(length, anchor);
        let ratio = 1.0 + tension / self.stiffness;
        let rate = length.rate;
        energy.winch = -rate * (tension + 0.5 * tension * tension / self.stiffness)
            + 0.5 * self.mass * ratio * ratio * rate.powi(3)
            - rate * self.mass * self.gravity_w.dot(&at(x, self.last()));
        energy
    }
}

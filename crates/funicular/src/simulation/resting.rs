//! Mesh of a rope at rest between two ends: the start of a rope that hangs in a narrow bend.
//!
//! The nodes of an element have as many derivatives as it has Gauss points. At rest the force N there is that at the
//! platform less the load in between, exactly, so that three numbers are sought: the force at the platform with which
//! the stretches of all Gauss points lead from one end to the other.

use super::rope::RopeMesh;
use crate::math::legendre::gauss;
use crate::math::{DMat, Mat3, Vec3};

/// Forces at which the corner of |N| at zero is rounded, over the load of the rope, one after the other. Rope straight
/// down and up again has N = 0 at its bend. The last rounding leaves forces of 1e-5 of the load; with 1e-13 the
/// direction of N is itself rounding, and the ends miss each other by centimetres. From 1e-1 on Newton's method gets
/// there.
const ROUNDINGS: [f64; 5] = [1e-1, 1e-3, 1e-5, 1e-7, 1e-9];

/// Largest number of steps for each rounding.
const STEPS: usize = 60;

/// Rope at rest between two ends.
pub(super) struct RestingRope<'a> {
    pub(super) rope: &'a RopeMesh,
    /// Unstrained length [m].
    pub(super) length: f64,
    /// Load per unstrained length [N/m].
    pub(super) load_w: Vec3,
    /// Ends at the platform and at the anchor [m].
    pub(super) ends_w: [Vec3; 2],
}

impl RestingRope<'_> {
    /// Gauss points of the whole rope, σ and weight.
    fn points(&self) -> Vec<(f64, f64)> {
        let count = self.rope.elements as f64;
        let of_element = gauss(self.rope.basis.degree);
        let point = |e: usize, (x, w): (f64, f64)| ((e as f64 + 0.5 * (x + 1.0)) / count, 0.5 * w / count);
        (0..self.rope.elements).flat_map(|e| of_element.iter().map(move |of| point(e, *of))).collect()
    }

    /// True if the rope has no tension at a Gauss point with its nodes where they are: its mesh is too coarse for its
    /// bend, and Newton's method has nothing to hold on to.
    pub(super) fn is_coarse(&self, nodes_w: &[Vec3]) -> bool {
        let RopeMesh { basis, elements, .. } = self.rope;
        let width = basis.degree + 1;
        (0..*elements).any(|e| {
            let of_element = &nodes_w[e * basis.degree..e * basis.degree + width];
            (0..basis.degree).any(|g| {
                let slope_w: Vec3 =
                    basis.at_gauss(g).iter().zip(of_element).map(|(slope, node_w)| node_w * *slope).sum();
                slope_w.norm() * *elements as f64 <= self.length
            })
        })
    }

    /// Places of the nodes at rest; `None` without a load, which leaves a slack rope no place of its own. `force_w` is
    /// a first guess of the force at the platform, along the rope towards the anchor [N].
    pub(super) fn nodes(&self, force_w: &Vec3) -> Option<Vec<Vec3>> {
        let weight = self.load_w.norm() * self.length;
        if weight == 0.0 {
            return None;
        }
        let points = self.points();
        let mut force_w = *force_w;
        for rounding in ROUNDINGS {
            force_w = self.force(&points, force_w, rounding * weight)?;
        }
        let corner = ROUNDINGS[ROUNDINGS.len() - 1] * weight;
        let mut slopes_w: Vec<Vec3> = points
            .iter()
            .map(|(sigma, _)| self.slope(&self.force_at(&force_w, *sigma), corner) * self.length)
            .collect();

        // What is left between the ends belongs to the softest place.
        let reached_w: Vec3 = slopes_w.iter().zip(&points).map(|(slope_w, (_, weight))| slope_w * *weight).sum();
        let size = |k: &usize| self.force_at(&force_w, points[*k].0).norm();
        let softest = (0..points.len()).min_by(|a, b| size(a).total_cmp(&size(b)))?;
        slopes_w[softest] += (self.ends_w[1] - self.ends_w[0] - reached_w) / points[softest].1;
        self.integrated(&slopes_w)
    }

    fn force_at(&self, force_w: &Vec3, sigma: f64) -> Vec3 {
        force_w - self.load_w * (self.length * sigma)
    }

    /// Slope of the rope by its unstrained length at a force: stretch times tangent.
    fn slope(&self, force_w: &Vec3, corner: f64) -> Vec3 {
        force_w / rounded(force_w.norm_squared(), corner) + force_w / self.rope.stiffness
    }

    /// Complementary energy of a force at the platform, whose least value has the force at rest [J].
    fn energy(&self, points: &[(f64, f64)], force_w: &Vec3, corner: f64) -> f64 {
        let of_point = |(sigma, weight): &(f64, f64)| {
            let square = self.force_at(force_w, *sigma).norm_squared();
            weight * (rounded(square, corner) + 0.5 * square / self.rope.stiffness)
        };
        let chord_w = self.ends_w[1] - self.ends_w[0];
        self.length * points.iter().map(of_point).sum::<f64>() - chord_w.dot(force_w)
    }

    /// Force at the platform by Newton's method on the complementary energy, which is convex.
    ///
    /// # References
    /// docs/theory.md, equation (97k1).
    fn force(&self, points: &[(f64, f64)], mut force_w: Vec3, corner: f64) -> Option<Vec3> {
        let chord_w = self.ends_w[1] - self.ends_w[0];
        for _ in 0..STEPS {
            let mut gap_w = -chord_w;
            let mut matrix = Mat3::zeros();
            for (sigma, weight) in points {
                let here_w = self.force_at(&force_w, *sigma);
                let size = rounded(here_w.norm_squared(), corner);
                let part = weight * self.length;
                gap_w += self.slope(&here_w, corner) * part;
                let turning = (Mat3::identity() - here_w * here_w.transpose() / (size * size)) / size;
                matrix += (turning + Mat3::identity() / self.rope.stiffness) * part;
            }
            if gap_w.norm() < 1e-13 * self.length {
                break;
            }
            let step_w = matrix.try_inverse()? * gap_w;
            let before = self.energy(points, &force_w, corner);
            // Armijo's rule: at least a small part of what the slope promises.
            let promised = step_w.dot(&gap_w);
            let mut part = 1.0;
            while part > 1e-6
                && self.energy(points, &(force_w - step_w * part), corner) > before - 1e-4 * part * promised
            {
                part *= 0.5;
            }
            force_w -= step_w * part;
            if step_w.norm() < 1e-14 * force_w.norm() {
                break;
            }
        }
        force_w.iter().all(|x| x.is_finite()).then_some(force_w)
    }

    /// Places of the nodes with these slopes by σ at the Gauss points, the first at the platform.
    fn integrated(&self, slopes_w: &[Vec3]) -> Option<Vec<Vec3>> {
        let (basis, degree) = (&self.rope.basis, self.rope.basis.degree);
        let by_nodes = DMat::from_fn(degree, degree, |g, q| basis.at_gauss(g)[q + 1]).try_inverse()?;
        let mut nodes_w = vec![self.ends_w[0]];
        for of_element in slopes_w.chunks_exact(degree) {
            let first_w = nodes_w[nodes_w.len() - 1];
            let rest_w: Vec<Vec3> = (of_element.iter().enumerate())
                .map(|(g, slope_w)| slope_w / self.rope.elements as f64 - first_w * basis.at_gauss(g)[0])
                .collect();
            nodes_w.extend((0..degree).map(|q| (0..degree).map(|g| rest_w[g] * by_nodes[(q, g)]).sum::<Vec3>()));
        }
        Some(nodes_w)
    }
}

/// Size of a force with this square, its corner at zero rounded.
fn rounded(square: f64, corner: f64) -> f64 {
    (square + corner * corner).sqrt()
}

#[cfg(test)]
mod tests {
    use super::super::basis::ElementBasis;
    use super::*;
    use std::sync::Arc;

    fn rope(elements: usize, degree: usize) -> RopeMesh {
        let gravity_w = Vec3::new(0.0, 0.0, -9.81);
        RopeMesh {
            basis: Arc::new(ElementBasis::new(degree)),
            elements,
            mass: 0.05,
            stiffness: 2e4,
            damping_time: 0.0,
            viscous: 0.0,
            load_w: gravity_w * 0.05,
            gravity_w,
            drag_width: 0.0,
        }
    }

    /// The forces that the nodes need are those of the load alone, however narrow the bend is: also straight down and
    /// up again.
    #[test]
    fn nodes_at_rest_need_no_force() {
        for (elements, degree) in [(1, 2), (3, 8), (7, 1), (20, 4)] {
            for apart in [4.0, 0.5, 1e-3, 0.0] {
                let rope = rope(elements, degree);
                let ends_w = [Vec3::new(0.0, 0.0, -8.0), Vec3::new(apart, 0.0, 0.0)];
                let resting = RestingRope { rope: &rope, length: 10.0, load_w: rope.load_w, ends_w };
                let nodes_w = resting.nodes(&Vec3::new(1.0, 0.0, 1.0)).unwrap();
                let what = format!("{elements} of degree {degree}, {apart} m apart");
                assert!((nodes_w[nodes_w.len() - 1] - ends_w[1]).norm() < 1e-9, "{what}");

                let x: Vec<f64> = nodes_w.iter().flat_map(|node_w| node_w.iter().copied()).collect();
                let (zero, mut needed) = (vec![0.0; x.len()], vec![0.0; x.len()]);
                let length = super::super::rope::WoundLength { value: 10.0, rate: 0.0, acceleration: 0.0 };
                rope.add_inner_forces(&length, &x, &zero, &mut needed);
                rope.add_outer_forces(&length, &[], [&x, &zero, &zero], &mut needed);
                let inner = &needed[3..needed.len() - 3];
                let most = inner.iter().fold(0.0_f64, |most, force| most.max(force.abs()));
                assert!(most < 1e-4 * 10.0 * 0.05 * 9.81, "{what}: {most}");
            }
        }
    }
}

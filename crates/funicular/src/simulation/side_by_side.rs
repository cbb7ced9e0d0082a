//! Ropes of one mesh side by side, one in each lane of the processor's vectors: their inner forces and the factors of
//! Newton's method. What is done per rope or per wind stays in [`RopeMesh`]. It and [`Skyline`] are the oracle of what
//! is here.
//!
//! [`Skyline`]: super::skyline::Skyline

mod factor;

pub(super) use factor::{FactorPack, RopesInMotion};

use super::rope::{FOLDED, RopeMesh, WoundLength};
use crate::math::simd::{LANES, Lanes, Line, Part};
use pulp::{Arch, Simd, WithSimd};

/// Members of a list in packs of at most as many as there are lanes; those of a pack have one key.
fn packs<K: PartialEq>(keys: impl Iterator<Item = Option<K>>) -> Vec<Vec<usize>> {
    let mut packs: Vec<(K, Vec<usize>)> = Vec::new();
    for (i, key) in keys.enumerate() {
        let Some(key) = key else { continue };
        match packs.iter_mut().find(|(of, pack)| *of == key && pack.len() < LANES) {
            Some((_, pack)) => pack.push(i),
            None => packs.push((key, vec![i])),
        }
    }
    packs.into_iter().map(|(_, pack)| pack).collect()
}

/// Up to eight ropes of one mesh, for their inner forces.
#[derive(Clone)]
pub(super) struct RopePack {
    ropes: Vec<usize>,
    law: StretchLaw,
    x: Lanes,
    v: Lanes,
    forces: Lanes,
}

/// Numbers of the law of the tension, a rope in each lane.
#[derive(Clone, Default)]
struct StretchLaw {
    /// Elements per unstrained length [1/m].
    per_length: Line,
    stiffness: Line,
    damping_time: Line,
    /// Rate of the unstrained length over the length [1/s].
    relative_rate: Line,
}

impl StretchLaw {
    /// Law of these ropes, without their lengths.
    fn of(ropes: &[RopeMesh], lanes: &[usize]) -> Self {
        let mut law = Self::default();
        for (lane, i) in lanes.iter().enumerate() {
            law.set_rope(lane, &ropes[*i]);
        }
        law
    }

    fn set_rope(&mut self, lane: usize, rope: &RopeMesh) {
        self.stiffness[lane] = rope.stiffness;
        self.damping_time[lane] = rope.damping_time;
    }

    fn set_length(&mut self, lane: usize, rope: &RopeMesh, length: &WoundLength) {
        self.per_length[lane] = rope.elements as f64 / length.value;
        self.relative_rate[lane] = length.rate / length.value;
    }

    fn is_damped(&self) -> bool {
        self.damping_time.iter().any(|time| *time > 0.0)
    }
}

impl RopePack {
    /// All ropes in packs.
    pub(super) fn of(ropes: &[RopeMesh]) -> Vec<Self> {
        let packs = packs(ropes.iter().map(|rope| Some((rope.elements, rope.basis.degree))));
        let pack = |of: Vec<usize>| {
            let size = ropes[of[0]].size();
            Self { law: StretchLaw::of(ropes, &of), ropes: of, x: zeros(size), v: zeros(size), forces: zeros(size) }
        };
        packs.into_iter().map(pack).collect()
    }

    /// Adds the inner forces to `out`. Positions, velocities and forces are those of a motion, in which the numbers of
    /// the ropes begin at `offsets`; `lengths` are their free lengths.
    pub(super) fn add_inner_forces(
        &mut self,
        ropes: &[RopeMesh],
        offsets: &[usize],
        lengths: &[WoundLength],
        [x, v]: [&[f64]; 2],
        out: &mut [f64],
    ) {
        let rope = &ropes[self.ropes[0]];
        let is_damped = self.law.is_damped();
        for (lane, i) in self.ropes.iter().enumerate() {
            self.law.set_length(lane, rope, &lengths[*i]);
            gather(&x[offsets[*i]..], lane, &mut self.x);
            if is_damped {
                gather(&v[offsets[*i]..], lane, &mut self.v);
            }
        }

        Arch::new().dispatch(InnerForces { pack: self, rope, is_damped });

        for (lane, i) in self.ropes.iter().enumerate() {
            for (out, line) in out[offsets[*i]..].iter_mut().zip(self.forces.iter()) {
                *out += line[lane];
            }
        }
    }
}

fn zeros(count: usize) -> Lanes {
    let mut lanes = Lanes::any(count);
    lanes.fill(Line::ZERO);
    lanes
}

fn gather(numbers: &[f64], lane: usize, lines: &mut [Line]) {
    for (line, number) in lines.iter_mut().zip(numbers) {
        line[lane] = *number;
    }
}

struct InnerForces<'a> {
    pack: &'a mut RopePack,
    rope: &'a RopeMesh,
    is_damped: bool,
}

impl WithSimd for InnerForces<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let (degree, pack) = (self.rope.basis.degree, self.pack);
        pack.forces.fill(Line::ZERO);
        for part in Part::first(simd, pack.ropes.len()) {
            for e in 0..self.rope.elements {
                let nodes = 3 * e * degree..3 * ((e + 1) * degree + 1);
                let (x, v) = (&pack.x[nodes.clone()], &pack.v[nodes.clone()]);
                let v = self.is_damped.then_some(v);
                of_element(part, self.rope, &pack.law, x, v, &mut pack.forces[nodes]);
            }
        }
    }
}

/// Adds the inner forces of an element.
#[inline(always)]
fn of_element<S: Simd>(
    part: Part<S>,
    rope: &RopeMesh,
    law: &StretchLaw,
    x: &[Line],
    v: Option<&[Line]>,
    out: &mut [Line],
) {
    for (g, weight) in rope.basis.gauss_weights.iter().enumerate() {
        let slopes = rope.basis.at_gauss(g);
        let of = part.stretch(law, along(part, slopes, x), v.map(|v| along(part, slopes, v)));
        let factor = part.mul(part.mul(of.tension, of.inverse), part.splat(*weight));
        let force = of.slope.map(|slope| part.mul(slope, factor));
        for (slope, out) in slopes.iter().zip(out.chunks_exact_mut(3)) {
            let slope = part.splat(*slope);
            for (out, force) in out.iter_mut().zip(force) {
                let sum = part.plus(slope, force, part.of(out));
                part.set(out, sum);
            }
        }
    }
}

/// Σ slopes · values over the nodes of an element.
#[inline(always)]
fn along<S: Simd>(part: Part<S>, slopes: &[f64], values: &[Line]) -> [S::f64s; 3] {
    let mut sums = [part.splat(0.0); 3];
    for (slope, value) in slopes.iter().zip(values.chunks_exact(3)) {
        let slope = part.splat(*slope);
        for axis in 0..3 {
            sums[axis] = part.plus(slope, part.of(&value[axis]), sums[axis]);
        }
    }
    sums
}

/// Ropes at one Gauss point.
struct Stretched<S: Simd> {
    /// Change of the place per unstrained length.
    slope: [S::f64s; 3],
    /// One over the ratio of lengths.
    inverse: S::f64s,
    /// Damping time, which fades where a rope folds [s].
    damping_time: S::f64s,
    /// Tension [N], not negative.
    tension: S::f64s,
}

impl<S: Simd> Part<S> {
    /// Stretch at a Gauss point, where the place changes with σ by `slope`, and the velocity by `slope_rate` if the
    /// ropes are damped.
    ///
    /// # References
    /// docs/theory.md, equations (97a) and (97e).
    #[inline(always)]
    fn stretch(self, law: &StretchLaw, slope: [S::f64s; 3], slope_rate: Option<[S::f64s; 3]>) -> Stretched<S> {
        let simd = self.simd;
        let per_length = self.of(&law.per_length);
        let dot = |a: [S::f64s; 3], b: [S::f64s; 3]| self.plus(a[0], b[0], self.plus(a[1], b[1], self.mul(a[2], b[2])));
        let slope = slope.map(|of| self.mul(of, per_length));
        let ratio = simd.sqrt_f64s(dot(slope, slope));
        // A point of the rope that has folded onto itself has no tangent and no tension.
        let inverse = self.inverse(simd.max_f64s(ratio, self.splat(f64::MIN_POSITIVE)));
        let mut strain = simd.sub_f64s(ratio, self.splat(1.0));
        let mut damping_time = self.splat(0.0);
        if let Some(slope_rate) = slope_rate {
            let along = self.mul(self.mul(dot(slope_rate, slope), per_length), inverse);
            let rate = simd.sub_f64s(along, self.mul(ratio, self.of(&law.relative_rate)));
            let fold = simd.min_f64s(self.mul(ratio, self.splat(1.0 / FOLDED)), self.splat(1.0));
            damping_time = self.mul(self.of(&law.damping_time), fold);
            strain = self.plus(damping_time, rate, strain);
        }
        let tension = simd.max_f64s(self.mul(self.of(&law.stiffness), strain), self.splat(0.0));
        Stretched { slope, inverse, damping_time, tension }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Vec3;
    use crate::simulation::basis::ElementBasis;
    use std::sync::Arc;

    /// Ropes of two meshes, more of one than there are lanes; some are slack in parts, every second one is damped.
    pub(super) fn ropes() -> (Vec<RopeMesh>, Vec<WoundLength>, [Vec<f64>; 2], Vec<usize>) {
        let mut random = fastrand::Rng::with_seed(7);
        let (mut ropes, mut lengths, mut offsets) = (vec![], vec![], vec![]);
        let (mut x, mut v) = (vec![], vec![]);
        let meshes = [(3, 8), (2, 5)].map(|(elements, degree)| (elements, Arc::new(ElementBasis::new(degree))));
        for i in 0..13 {
            let (elements, basis) = meshes[usize::from(i % 6 == 5)].clone();
            let rope = RopeMesh {
                basis,
                elements,
                mass: 0.1,
                stiffness: 1e4 * random.f64(),
                damping_time: f64::from(i % 2) * 1e-3,
                viscous: 0.0,
                load_w: Vec3::zeros(),
                gravity_w: Vec3::zeros(),
                drag_width: 0.0,
            };
            offsets.push(x.len());
            let nodes = rope.last() as f64;
            for k in 0..rope.size() {
                let along = [0.6, 0.5, 0.7][k % 3] * (k / 3) as f64 / nodes;
                x.push(along + 0.002 * random.f64());
                v.push(random.f64() - 0.5);
            }
            lengths.push(WoundLength { value: 1.0 + 0.1 * random.f64(), rate: random.f64() - 0.5, acceleration: 0.0 });
            ropes.push(rope);
        }
        (ropes, lengths, [x, v], offsets)
    }

    pub(super) fn is_near(found: &[f64], expected: &[f64]) -> bool {
        let size = expected.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        found.iter().zip(expected).all(|(a, b)| (a - b).abs() <= 1e-12 * size)
    }

    #[test]
    fn inner_forces_are_those_of_single_ropes() {
        let (ropes, lengths, [x, v], offsets) = ropes();
        let (mut found, mut expected) = (vec![0.0; x.len()], vec![0.0; x.len()]);
        let mut packs = RopePack::of(&ropes);
        assert_eq!(packs.iter().map(|pack| pack.ropes.len()).collect::<Vec<_>>(), [8, 2, 3]);
        for pack in &mut packs {
            pack.add_inner_forces(&ropes, &offsets, &lengths, [&x, &v], &mut found);
        }
        for (i, rope) in ropes.iter().enumerate() {
            let range = offsets[i]..offsets[i] + rope.size();
            rope.add_inner_forces(&lengths[i], &x[range.clone()], &v[range.clone()], &mut expected[range]);
        }
        assert!(is_near(&found, &expected));
        assert!(expected.iter().filter(|force| **force != 0.0).count() > found.len() / 2);
    }
}

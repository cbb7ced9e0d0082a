//! Ropes of one mesh side by side, one in each lane of the processor's vectors: their inner forces, and the
//! substitutions of Newton's method. What is done once per factor, per rope or per wind stays in [`RopeMesh`] and
//! [`Skyline`], which are the oracle of what is here.

use super::rope::{FOLDED, RopeMesh, WoundLength};
use super::skyline::Skyline;
use crate::math::Vec3;
use crate::math::simd::{LANES, Lanes, Line, Part};
use pulp::{Arch, Simd, WithSimd};
use std::array::from_fn;

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
pub(super) struct RopePack {
    ropes: Vec<usize>,
    law: StretchLaw,
    x: Lanes,
    v: Lanes,
    forces: Lanes,
}

/// Numbers of the law of the tension, a rope in each lane.
#[derive(Default)]
struct StretchLaw {
    /// Elements per unstrained length [1/m].
    per_length: Line,
    stiffness: Line,
    damping_time: Line,
    /// Rate of the unstrained length over the length [1/s].
    relative_rate: Line,
}

impl RopePack {
    /// All ropes in packs.
    pub(super) fn of(ropes: &[RopeMesh]) -> Vec<Self> {
        let packs = packs(ropes.iter().map(|rope| Some((rope.elements, rope.basis.degree))));
        let pack = |of: Vec<usize>| {
            let size = ropes[of[0]].size();
            let mut law = StretchLaw::default();
            for (lane, i) in of.iter().enumerate() {
                law.stiffness[lane] = ropes[*i].stiffness;
                law.damping_time[lane] = ropes[*i].damping_time;
            }
            Self { ropes: of, law, x: zeros(size), v: zeros(size), forces: zeros(size) }
        };
        packs.into_iter().map(pack).collect()
    }

    /// Adds the inner forces to `out`. Positions, velocities and forces are those of a motion, in which the numbers of the
    /// ropes begin at `offsets`; `lengths` are their free lengths.
    pub(super) fn add_inner_forces(
        &mut self,
        ropes: &[RopeMesh],
        offsets: &[usize],
        lengths: &[WoundLength],
        [x, v]: [&[f64]; 2],
        out: &mut [f64],
    ) {
        let rope = &ropes[self.ropes[0]];
        let is_damped = self.law.damping_time.iter().any(|time| *time > 0.0);
        for (lane, i) in self.ropes.iter().enumerate() {
            let length = &lengths[*i];
            self.law.per_length[lane] = rope.elements as f64 / length.value;
            self.law.relative_rate[lane] = length.rate / length.value;
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
        let force = part.of_point(law, along(part, slopes, x), v.map(|v| along(part, slopes, v)), *weight);
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

impl<S: Simd> Part<S> {
    /// Force of a Gauss point times its weight.
    ///
    /// # References
    /// docs/theory.md, equations (97a) and (97e).
    #[inline(always)]
    fn of_point(
        self,
        law: &StretchLaw,
        slope: [S::f64s; 3],
        slope_rate: Option<[S::f64s; 3]>,
        weight: f64,
    ) -> [S::f64s; 3] {
        let simd = self.simd;
        let per_length = self.of(&law.per_length);
        let dot = |a: [S::f64s; 3], b: [S::f64s; 3]| self.plus(a[0], b[0], self.plus(a[1], b[1], self.mul(a[2], b[2])));
        let slope = slope.map(|of| self.mul(of, per_length));
        let ratio = simd.sqrt_f64s(dot(slope, slope));
        // A point of the rope that has folded onto itself has no tangent and no tension.
        let inverse = self.inverse(simd.max_f64s(ratio, self.splat(f64::MIN_POSITIVE)));
        let mut strain = simd.sub_f64s(ratio, self.splat(1.0));
        if let Some(slope_rate) = slope_rate {
            let along = self.mul(self.mul(dot(slope_rate, slope), per_length), inverse);
            let rate = simd.sub_f64s(along, self.mul(ratio, self.of(&law.relative_rate)));
            let fold = simd.min_f64s(self.mul(ratio, self.splat(1.0 / FOLDED)), self.splat(1.0));
            let damping_time = self.mul(self.of(&law.damping_time), fold);
            strain = self.plus(damping_time, rate, strain);
        }
        let tension = simd.max_f64s(self.mul(self.of(&law.stiffness), strain), self.splat(0.0));
        let factor = self.mul(self.mul(tension, inverse), self.splat(weight));
        slope.map(|of| self.mul(of, factor))
    }
}

/// Factors of up to eight ropes of one mesh, all with a last node that is kept or all without, and their right-hand sides.
pub(super) struct FactorPack {
    /// Ropes in the lanes.
    pub(super) ropes: Vec<usize>,
    /// Entries of the factors in the order of a [`Skyline`].
    values: Lanes,
    /// Right-hand side in the order of the rows.
    rows: Lanes,
    /// What the kept last nodes receive of the right-hand side, and then their motion.
    end: [Line; 3],
}

impl FactorPack {
    /// Factored matrices in packs, without those of ropes that are gone.
    pub(super) fn of(ropes: &[RopeMesh], is_gone: impl Fn(usize) -> bool, factors: &[Skyline]) -> Vec<Self> {
        let key = |(i, rope): (usize, &RopeMesh)| {
            (!is_gone(i)).then_some((rope.elements, rope.basis.degree, factors[i].keeps_end()))
        };
        let pack = |of: Vec<usize>| {
            let (entries, rows) = (factors[of[0]].values.len(), factors[of[0]].rows());
            let (mut values, mut right) = (Lanes::any(entries), Lanes::any(rows));
            right.fill(Line::ZERO);
            // Lanes without a rope must not hold numbers that are none.
            if of.len() < LANES {
                values.fill(Line::ZERO);
            }
            for (lane, i) in of.iter().enumerate() {
                gather(&factors[*i].values, lane, &mut values);
            }
            Self { ropes: of, values, rows: right, end: [Line::ZERO; 3] }
        };
        packs(ropes.iter().enumerate().map(key)).into_iter().map(pack).collect()
    }

    /// Sets the right-hand side of a lane from numbers of nodes, the platform's first.
    pub(super) fn put(&mut self, lane: usize, nodes: &[f64]) {
        for (rows, node) in self.rows.rchunks_exact_mut(3).zip(nodes.chunks_exact(3)) {
            for (row, number) in rows.iter_mut().zip(node) {
                row[lane] = *number;
            }
        }
    }

    /// Takes the numbers of nodes of a lane out, the platform's first.
    pub(super) fn take(&self, lane: usize, nodes: &mut [f64]) {
        for (rows, node) in self.rows.rchunks_exact(3).zip(nodes.chunks_exact_mut(3)) {
            for (row, number) in rows.iter().zip(node) {
                *number = -row[lane];
            }
        }
    }

    /// Right-hand side of a lane in the order of the rows.
    pub(super) fn rows_of(&self, lane: usize, rows: &mut Vec<f64>) {
        rows.clear();
        rows.extend(self.rows.iter().map(|line| line[lane]));
    }

    /// Sets the right-hand side of a lane in the order of the rows.
    pub(super) fn set_rows(&mut self, lane: usize, rows: &[f64]) {
        gather(rows, lane, &mut self.rows);
    }

    /// What the kept last node of a lane has received, or its motion.
    pub(super) fn received(&self, lane: usize) -> Vec3 {
        Vec3::from_fn(|axis, _| self.end[axis][lane])
    }

    /// Sets the motion of the kept last node of a lane.
    pub(super) fn set_end(&mut self, lane: usize, end: &Vec3) {
        for axis in 0..3 {
            self.end[axis][lane] = end[axis];
        }
    }

    /// [`Skyline::forward`] of all lanes.
    pub(super) fn forward(&mut self, factors: &[Skyline]) {
        Arch::new().dispatch(Forward { shape: &factors[self.ropes[0]], pack: self });
    }

    /// [`Skyline::backward`] of all lanes.
    pub(super) fn backward(&mut self, factors: &[Skyline]) {
        Arch::new().dispatch(Backward { shape: &factors[self.ropes[0]], pack: self });
    }
}

struct Forward<'a> {
    shape: &'a Skyline,
    pack: &'a mut FactorPack,
}

impl WithSimd for Forward<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { shape, pack } = self;
        for part in Part::first(simd, pack.ropes.len()) {
            for node in 0..shape.factored_nodes() {
                let [first, at @ ..] = shape.node(node);
                let row = 3 * node;
                let sums = products(part, &pack.values, at, &pack.rows[first..row]);
                // The diagonal holds the inverse.
                let entry = |i: usize, j: usize| part.of(&pack.values[at[i] + row - first + j]);
                let left: [S::f64s; 3] = from_fn(|i| simd.sub_f64s(part.of(&pack.rows[row + i]), sums[i]));
                let a = part.mul(left[0], entry(0, 0));
                let b = part.mul(part.less(left[1], entry(1, 0), a), entry(1, 1));
                let c = part.less(part.less(left[2], entry(2, 0), a), entry(2, 1), b);
                let c = part.mul(c, entry(2, 2));
                for (i, value) in [a, b, c].into_iter().enumerate() {
                    part.set(&mut pack.rows[row + i], value);
                }
            }
            if shape.keeps_end() {
                let [first, at @ ..] = shape.node(shape.factored_nodes());
                let sums = products(part, &pack.values, at, &pack.rows[first..3 * shape.factored_nodes()]);
                for (end, sum) in pack.end.iter_mut().zip(sums) {
                    part.set(end, sum);
                }
            }
        }
    }
}

struct Backward<'a> {
    shape: &'a Skyline,
    pack: &'a mut FactorPack,
}

impl WithSimd for Backward<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { shape, pack } = self;
        for part in Part::first(simd, pack.ropes.len()) {
            if shape.keeps_end() {
                let [first, at @ ..] = shape.node(shape.factored_nodes());
                let end = from_fn(|i| part.of(&pack.end[i]));
                take_off(part, &pack.values, at, end, &mut pack.rows[first..3 * shape.factored_nodes()]);
            }
            for node in (0..shape.factored_nodes()).rev() {
                let [first, at @ ..] = shape.node(node);
                let row = 3 * node;
                let entry = |i: usize, j: usize| part.of(&pack.values[at[i] + row - first + j]);
                let right: [S::f64s; 3] = from_fn(|i| part.of(&pack.rows[row + i]));
                let c = part.mul(right[2], entry(2, 2));
                let b = part.mul(part.less(right[1], entry(2, 1), c), entry(1, 1));
                let a = part.less(part.less(right[0], entry(1, 0), b), entry(2, 0), c);
                let a = part.mul(a, entry(0, 0));
                for (i, value) in [a, b, c].into_iter().enumerate() {
                    part.set(&mut pack.rows[row + i], value);
                }
                take_off(part, &pack.values, at, [a, b, c], &mut pack.rows[first..row]);
            }
        }
    }
}

/// Scalar products of the three rows of a node, which begin at `at`, with numbers.
#[inline(always)]
fn products<S: Simd>(part: Part<S>, values: &[Line], at: [usize; 3], numbers: &[Line]) -> [S::f64s; 3] {
    let rows = at.map(|at| &values[at..at + numbers.len()]);
    // Two sums of each row, so that neither waits for the other.
    let mut sums = [[part.splat(0.0); 3]; 2];
    let pairs = numbers.chunks_exact(2);
    let odd = pairs.remainder();
    for (k, pair) in pairs.enumerate() {
        for (s, number) in pair.iter().enumerate() {
            for i in 0..3 {
                sums[s][i] = part.plus(part.of(&rows[i][2 * k + s]), part.of(number), sums[s][i]);
            }
        }
    }
    if let [number] = odd {
        for i in 0..3 {
            sums[0][i] = part.plus(part.of(&rows[i][numbers.len() - 1]), part.of(number), sums[0][i]);
        }
    }
    from_fn(|i| part.simd.add_f64s(sums[0][i], sums[1][i]))
}

/// Takes the three rows of a node, which begin at `at`, times their factors off numbers.
#[inline(always)]
fn take_off<S: Simd>(part: Part<S>, values: &[Line], at: [usize; 3], factors: [S::f64s; 3], numbers: &mut [Line]) {
    let rows = at.map(|at| &values[at..at + numbers.len()]);
    for (k, number) in numbers.iter_mut().enumerate() {
        let mut left = part.of(number);
        for i in 0..3 {
            left = part.less(left, part.of(&rows[i][k]), factors[i]);
        }
        part.set(number, left);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::robot::Wind;
    use crate::simulation::basis::ElementBasis;
    use crate::simulation::rope::Newton;
    use crate::simulation::skyline::Profile3;
    use std::rc::Rc;

    /// Ropes of two meshes, more of one than there are lanes; some are slack in parts, every second one is damped.
    fn ropes() -> (Vec<RopeMesh>, Vec<WoundLength>, [Vec<f64>; 2], Vec<usize>) {
        let mut random = fastrand::Rng::with_seed(7);
        let (mut ropes, mut lengths, mut offsets) = (vec![], vec![], vec![]);
        let (mut x, mut v) = (vec![], vec![]);
        let meshes = [(3, 8), (2, 5)].map(|(elements, degree)| (elements, Rc::new(ElementBasis::new(degree))));
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

    fn is_near(found: &[f64], expected: &[f64]) -> bool {
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

    #[test]
    fn substitutions_are_those_of_single_ropes() {
        let (ropes, lengths, [x, v], offsets) = ropes();
        let (is_free, gone) = (|i: usize| i == 1 || i == 7, 4);
        let of = Newton { mass: 1e3, damping: 1.0, stiffness: 1e-3 };
        let factored = |(i, rope): (usize, &RopeMesh)| {
            let (range, wind) = (offsets[i]..offsets[i] + rope.size(), Wind::default());
            let mut matrix = Skyline::zeros(Profile3::new(rope.elements, rope.basis.degree));
            rope.assemble(&lengths[i], &[wind], &x[range.clone()], &v[range], of, &mut matrix);
            matrix.factor(!is_free(i)).unwrap();
            matrix
        };
        let factors: Vec<Skyline> = ropes.iter().enumerate().map(factored).collect();

        let mut packs = FactorPack::of(&ropes, |i| i == gone, &factors);
        assert_eq!(packs.iter().map(|pack| pack.ropes.len()).sum::<usize>(), 12);
        for pack in &mut packs {
            for lane in 0..pack.ropes.len() {
                let i = pack.ropes[lane];
                pack.put(lane, &v[offsets[i]..offsets[i] + ropes[i].size() - 3]);
            }
            pack.forward(&factors);
            let end = Vec3::new(0.1, -0.2, 0.3);
            let mut received = Vec::new();
            for lane in 0..pack.ropes.len() {
                received.push(pack.received(lane));
                pack.set_end(lane, &end);
            }
            pack.backward(&factors);

            for (lane, i) in pack.ropes.iter().copied().enumerate() {
                let nodes = &v[offsets[i]..offsets[i] + ropes[i].size() - 3];
                let mut expected: Vec<f64> = nodes.rchunks_exact(3).flatten().copied().collect();
                let on_end = factors[i].forward(&mut expected);
                factors[i].backward(&mut expected, &end);
                let mut found = Vec::new();
                pack.rows_of(lane, &mut found);
                assert!(is_near(&found, &expected), "rope {i}");
                assert_eq!(factors[i].keeps_end(), !is_free(i));
                if factors[i].keeps_end() {
                    assert!(is_near(received[lane].as_slice(), on_end.as_slice()), "end of rope {i}");
                }
            }
        }
    }
}

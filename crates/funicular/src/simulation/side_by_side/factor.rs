//! Newton's matrices of ropes side by side: assembled, factored and solved with.

use super::{StretchLaw, along, gather, packs, zeros};
use crate::math::simd::{LANES, Lanes, Line, Part};
use crate::math::{Mat3, Vec3};
use crate::simulation::rope::{Newton, RopeMesh, WoundLength};
use crate::simulation::skyline::{NotPositive, Skyline};
use pulp::{Arch, Simd, WithSimd};
use std::array::from_fn;

/// Entries of a symmetric matrix of three rows.
const ENTRIES: usize = 6;
/// Place of the entry of a row and a column among them.
const ENTRY: [[usize; 3]; 3] = [[0, 1, 2], [1, 3, 4], [2, 4, 5]];

/// Newton's matrices of up to eight ropes of one mesh, all with a last node that is kept or all without, their factors
/// and right-hand sides.
#[derive(Clone)]
pub(in crate::simulation) struct FactorPack {
    /// Ropes in the lanes.
    pub(in crate::simulation) ropes: Vec<usize>,
    /// Entries in the order of a [`Skyline`].
    values: Lanes,
    /// Right-hand side in the order of the rows.
    rows: Lanes,
    /// Share of the right-hand side that the kept last nodes receive, and then their motion.
    end: [Line; 3],
}

/// Motion of ropes whose numbers begin at `offsets`, for the matrices of a pack.
pub(in crate::simulation) struct RopesInMotion<'a> {
    pub(in crate::simulation) ropes: &'a [RopeMesh],
    pub(in crate::simulation) offsets: &'a [usize],
    /// Free lengths.
    pub(in crate::simulation) lengths: &'a [WoundLength],
    /// Factor of the mass of each node over its length: inertia and the damping of its motion.
    pub(in crate::simulation) on_nodes: &'a [f64],
    /// Positions and velocities.
    pub(in crate::simulation) motion: [&'a [f64]; 2],
}

impl FactorPack {
    /// Zero matrices in packs, without those of ropes that are gone. `shapes` say which last nodes are kept.
    pub(in crate::simulation) fn of(
        ropes: &[RopeMesh],
        is_gone: impl Fn(usize) -> bool,
        shapes: &[Skyline],
    ) -> Vec<Self> {
        let key = |(i, rope): (usize, &RopeMesh)| {
            (!is_gone(i)).then_some((rope.elements, rope.basis.degree, shapes[i].keeps_end()))
        };
        let pack = |of: Vec<usize>| {
            let shape = &shapes[of[0]];
            Self { ropes: of, values: zeros(shape.values.len()), rows: zeros(shape.rows()), end: [Line::ZERO; 3] }
        };
        packs(ropes.iter().enumerate().map(key)).into_iter().map(pack).collect()
    }

    /// Adds Newton's matrices at a motion: [`RopeMesh::assemble`] of all lanes.
    ///
    /// # References
    /// docs/theory.md, equation (97h).
    pub(in crate::simulation) fn assemble(&mut self, shapes: &[Skyline], of: &RopesInMotion, factors: Newton) {
        self.assemble_by(shapes, of, factors, |of| Arch::new().dispatch(of));
    }

    fn assemble_by(
        &mut self,
        shapes: &[Skyline],
        of: &RopesInMotion,
        factors: Newton,
        run: impl FnOnce(OnPack<Assemble>),
    ) {
        let rope = &of.ropes[self.ropes[0]];
        let mut law = StretchLaw::default();
        let (mut x, mut v, mut on_node) = (zeros(rope.size()), zeros(rope.size()), Line::ZERO);
        // Lanes without a rope repeat the first one: numbers that are none would be slow.
        for lane in 0..LANES {
            let i = self.ropes.get(lane).copied().unwrap_or(self.ropes[0]);
            law.set_rope(lane, &of.ropes[i]);
            law.set_length(lane, rope, &of.lengths[i]);
            on_node[lane] = of.on_nodes[i] * of.lengths[i].value / rope.elements as f64;
            gather(&of.motion[0][of.offsets[i]..], lane, &mut x);
            gather(&of.motion[1][of.offsets[i]..], lane, &mut v);
        }
        let shape = &shapes[self.ropes[0]];
        let work = Assemble { rope, law: &law, motion: [&x, &v], on_node: &on_node, factors };
        run(OnPack { work, shape, pack: self });
    }

    /// [`Skyline::factor`] of all lanes.
    ///
    /// # Errors
    /// [`NotPositive`] if one of the matrices has a pivot that is not positive.
    pub(in crate::simulation) fn factor(&mut self, shapes: &[Skyline]) -> Result<(), NotPositive> {
        self.factor_by(shapes, |of| Arch::new().dispatch(of))
    }

    fn factor_by(&mut self, shapes: &[Skyline], run: impl FnOnce(OnPack<Eliminate>)) -> Result<(), NotPositive> {
        let shape = &shapes[self.ropes[0]];
        run(OnPack { work: Eliminate, shape, pack: self });
        let is_positive = |pivot: &f64| *pivot > 0.0 && pivot.is_finite();
        let are_positive = (0..shape.factored_nodes()).all(|node| {
            let [first, at @ ..] = shape.node(node);
            // Registers narrower than the lanes leave lanes without ropes as they were.
            (0..3).all(|i| self.values[at[i] + 3 * node - first + i][..self.ropes.len()].iter().all(is_positive))
        });
        if are_positive { Ok(()) } else { Err(NotPositive) }
    }

    /// Schur complement of the last node of a lane; zero if it is not kept.
    pub(in crate::simulation) fn complement(&self, shape: &Skyline, lane: usize) -> Mat3 {
        if !shape.keeps_end() {
            return Mat3::zeros();
        }
        let [first, at @ ..] = shape.node(shape.factored_nodes());
        let entry = |i: usize, j: usize| self.values[at[i] + 3 * shape.factored_nodes() - first + j][lane];
        Mat3::from_fn(|i, j| entry(i.max(j), i.min(j)))
    }

    /// Copies the factor of a lane.
    pub(in crate::simulation) fn copy(&self, lane: usize, factor: &mut Skyline) {
        for (value, line) in factor.values.iter_mut().zip(self.values.iter()) {
            *value = line[lane];
        }
    }

    /// Sets the right-hand side of a lane from numbers of nodes, the platform's first.
    pub(in crate::simulation) fn put(&mut self, lane: usize, nodes: &[f64]) {
        for (rows, node) in self.rows.rchunks_exact_mut(3).zip(nodes.chunks_exact(3)) {
            for (row, number) in rows.iter_mut().zip(node) {
                row[lane] = *number;
            }
        }
    }

    /// Takes the numbers of nodes of a lane out, the platform's first.
    pub(in crate::simulation) fn take(&self, lane: usize, nodes: &mut [f64]) {
        for (rows, node) in self.rows.rchunks_exact(3).zip(nodes.chunks_exact_mut(3)) {
            for (row, number) in rows.iter().zip(node) {
                *number = -row[lane];
            }
        }
    }

    /// Right-hand side of a lane in the order of the rows.
    pub(in crate::simulation) fn rows_of(&self, lane: usize, rows: &mut Vec<f64>) {
        rows.clear();
        rows.extend(self.rows.iter().map(|line| line[lane]));
    }

    /// Sets the right-hand side of a lane in the order of the rows.
    pub(in crate::simulation) fn set_rows(&mut self, lane: usize, rows: &[f64]) {
        gather(rows, lane, &mut self.rows);
    }

    /// Share that the kept last node of a lane has received, or its motion.
    pub(in crate::simulation) fn received(&self, lane: usize) -> Vec3 {
        Vec3::from_fn(|axis, _| self.end[axis][lane])
    }

    /// Sets the motion of the kept last node of a lane.
    pub(in crate::simulation) fn set_end(&mut self, lane: usize, end: &Vec3) {
        for axis in 0..3 {
            self.end[axis][lane] = end[axis];
        }
    }

    /// [`Skyline::forward`] of all lanes.
    pub(in crate::simulation) fn forward(&mut self, shapes: &[Skyline]) {
        Arch::new().dispatch(OnPack { work: Forward, shape: &shapes[self.ropes[0]], pack: self });
    }

    /// [`Skyline::backward`] of all lanes.
    pub(in crate::simulation) fn backward(&mut self, shapes: &[Skyline]) {
        Arch::new().dispatch(OnPack { work: Backward, shape: &shapes[self.ropes[0]], pack: self });
    }
}

/// Work on the matrices of a pack, one register of their lanes at a time.
trait OnRegisters {
    fn on<S: Simd>(&self, part: Part<S>, shape: &Skyline, pack: &mut FactorPack);
}

/// Pack with the work to be done on it.
struct OnPack<'a, W> {
    work: W,
    shape: &'a Skyline,
    pack: &'a mut FactorPack,
}

impl<W: OnRegisters> WithSimd for OnPack<'_, W> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        for part in Part::first(simd, self.pack.ropes.len()) {
            self.work.on(part, self.shape, self.pack);
        }
    }
}

/// Assembly at a motion.
struct Assemble<'a> {
    rope: &'a RopeMesh,
    law: &'a StretchLaw,
    motion: [&'a [Line]; 2],
    on_node: &'a Line,
    factors: Newton,
}

impl OnRegisters for Assemble<'_> {
    #[inline(always)]
    fn on<S: Simd>(&self, part: Part<S>, shape: &Skyline, pack: &mut FactorPack) {
        let (rope, degree) = (self.rope, self.rope.basis.degree);
        let is_damped = self.law.is_damped();
        let mut blocks = zeros(ENTRIES * degree);
        for e in 0..rope.elements {
            let nodes = 3 * e * degree..3 * ((e + 1) * degree + 1);
            let [x, v] = self.motion.map(|of| &of[nodes.clone()]);
            let v = is_damped.then_some(v);
            for (g, block) in blocks.chunks_exact_mut(ENTRIES).enumerate() {
                part.block_of_point(rope, self.law, self.factors, g, (x, v), block);
            }
            add_element(part, rope, e, &blocks, self.on_node, shape, &mut pack.values);
        }
    }
}

impl<S: Simd> Part<S> {
    /// Block of Newton's matrix that a Gauss point has for a change of its slope.
    #[inline(always)]
    fn block_of_point(
        self,
        rope: &RopeMesh,
        law: &StretchLaw,
        of: Newton,
        g: usize,
        (x, v): (&[Line], Option<&[Line]>),
        block: &mut [Line],
    ) {
        let simd = self.simd;
        let slopes = rope.basis.at_gauss(g);
        let at = self.stretch(law, along(self, slopes, x), v.map(|v| along(self, slopes, v)));

        let weight = self.mul(self.of(&law.per_length), self.splat(rope.basis.gauss_weights[g]));
        let factor = self.plus(at.damping_time, self.splat(of.damping), self.splat(of.stiffness));
        let stiffness = self.mul(self.mul(factor, self.of(&law.stiffness)), weight);
        // A slack point gives nothing.
        let is_taut = simd.greater_than_f64s(at.tension, self.splat(0.0));
        let along = simd.select_f64s(is_taut, stiffness, self.splat(0.0));
        let across = self.mul(self.mul(self.mul(at.tension, at.inverse), self.splat(of.stiffness)), weight);

        let tangent = at.slope.map(|slope| self.mul(slope, at.inverse));
        let difference = simd.sub_f64s(along, across);
        for i in 0..3 {
            let scaled = self.mul(tangent[i], difference);
            for j in i..3 {
                let none = self.splat(0.0);
                let entry = self.plus(scaled, tangent[j], if i == j { across } else { none });
                self.set(&mut block[ENTRY[i][j]], entry);
            }
        }
    }
}

/// Adds an element with the blocks of its Gauss points and the mass of its nodes to the matrices.
#[inline(always)]
fn add_element<S: Simd>(
    part: Part<S>,
    rope: &RopeMesh,
    e: usize,
    blocks: &[Line],
    on_node: &Line,
    shape: &Skyline,
    values: &mut [Line],
) {
    let (degree, free) = (rope.basis.degree, rope.last());
    let from = e * degree;
    // The anchor has no rows.
    let last = degree.min(free - 1 - from);
    for i in 0..=last {
        let [first, at @ ..] = shape.node(free - 1 - from - i);
        for j in i..=last {
            let mut sums = [part.splat(0.0); ENTRIES];
            for (g, block) in blocks.chunks_exact(ENTRIES).enumerate() {
                let slopes = rope.basis.at_gauss(g);
                let factor = part.splat(slopes[i] * slopes[j]);
                for (sum, entry) in sums.iter_mut().zip(block) {
                    *sum = part.plus(factor, part.of(entry), *sum);
                }
            }
            let column = 3 * (free - 1 - from - j) - first;
            for row in 0..3 {
                for axis in 0..if i == j { row + 1 } else { 3 } {
                    let line = &mut values[at[row] + column + axis];
                    let mut value = part.simd.add_f64s(part.of(line), sums[ENTRY[row][axis]]);
                    if i == j && row == axis {
                        value = part.plus(part.of(on_node), part.splat(rope.basis.weights[i]), value);
                    }
                    part.set(line, value);
                }
            }
        }
    }
}

/// Cholesky factor in place.
struct Eliminate;

impl OnRegisters for Eliminate {
    #[inline(always)]
    fn on<S: Simd>(&self, part: Part<S>, shape: &Skyline, pack: &mut FactorPack) {
        let values = &mut pack.values;
        for node in 0..shape.rows() / 3 {
            let [first, at @ ..] = shape.node(node);
            for other in first / 3..node {
                eliminate(part, values, [first, at[0], at[1], at[2]], other, shape.node(other));
            }
            factor_node(part, values, 3 * node - first, at, node < shape.factored_nodes());
        }
    }
}

/// Entries of the rows of a node, whose first column is `first` and whose rows begin at `at`, in the columns of a node
/// before it.
#[inline(always)]
fn eliminate<S: Simd>(
    part: Part<S>,
    values: &mut [Line],
    [first, at @ ..]: [usize; 4],
    other: usize,
    [first_of_other, rows @ ..]: [usize; 4],
) {
    let from = first.max(first_of_other);
    for (k, row) in rows.iter().enumerate() {
        let column = 3 * other + k;
        let known = &values[row + from - first_of_other..row + column - first_of_other];
        let sums = products(part, values, at.map(|at| at + from - first), known);
        let inverse = part.of(&values[row + column - first_of_other]);
        for (at, sum) in at.iter().zip(sums) {
            let line = &mut values[at + column - first];
            let value = part.mul(part.simd.sub_f64s(part.of(line), sum), inverse);
            part.set(line, value);
        }
    }
}

/// Block on the diagonal of a node, whose rows begin at `at` and have `before` entries in front of it: its factor with
/// the inverses on the diagonal, or the Schur complement of a node that is kept.
#[inline(always)]
fn factor_node<S: Simd>(part: Part<S>, values: &mut [Line], before: usize, at: [usize; 3], is_factored: bool) {
    let sums = [
        products(part, values, at, &values[at[0]..at[0] + before]),
        products(part, values, at, &values[at[1]..at[1] + before]),
        products(part, values, at, &values[at[2]..at[2] + before]),
    ];
    let entry = |i: usize, j: usize| part.simd.sub_f64s(part.of(&values[at[i] + before + j]), sums[j][i]);
    let [mut a00, mut a10, mut a11, mut a20, mut a21, mut a22] =
        [entry(0, 0), entry(1, 0), entry(1, 1), entry(2, 0), entry(2, 1), entry(2, 2)];
    if is_factored {
        let inverse_root = |of: S::f64s| part.inverse(part.simd.sqrt_f64s(of));
        a00 = inverse_root(a00);
        (a10, a20) = (part.mul(a10, a00), part.mul(a20, a00));
        a11 = inverse_root(part.less(a11, a10, a10));
        a21 = part.mul(part.less(a21, a20, a10), a11);
        a22 = inverse_root(part.less(part.less(a22, a20, a20), a21, a21));
    }
    for (i, j, value) in [(0, 0, a00), (1, 0, a10), (1, 1, a11), (2, 0, a20), (2, 1, a21), (2, 2, a22)] {
        part.set(&mut values[at[i] + before + j], value);
    }
}

/// Forward substitution.
struct Forward;

impl OnRegisters for Forward {
    #[inline(always)]
    fn on<S: Simd>(&self, part: Part<S>, shape: &Skyline, pack: &mut FactorPack) {
        for node in 0..shape.factored_nodes() {
            let [first, at @ ..] = shape.node(node);
            let row = 3 * node;
            let sums = products(part, &pack.values, at, &pack.rows[first..row]);
            // The diagonal holds the inverse.
            let entry = |i: usize, j: usize| part.of(&pack.values[at[i] + row - first + j]);
            let left: [S::f64s; 3] = from_fn(|i| part.simd.sub_f64s(part.of(&pack.rows[row + i]), sums[i]));
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

/// Backward substitution.
struct Backward;

impl OnRegisters for Backward {
    #[inline(always)]
    fn on<S: Simd>(&self, part: Part<S>, shape: &Skyline, pack: &mut FactorPack) {
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
    use crate::simulation::side_by_side::tests::{is_near, ropes};
    use crate::simulation::skyline::Profile3;

    #[test]
    fn factors_and_substitutions_are_those_of_single_ropes() {
        let (ropes, lengths, [x, v], offsets) = ropes();
        let (is_free, gone) = (|i: usize| i == 1 || i == 7, 4);
        let of = Newton { mass: 1e3, damping: 1.0, stiffness: 1e-3 };
        let wind = Wind::default();
        let factored = |(i, rope): (usize, &RopeMesh)| {
            let range = offsets[i]..offsets[i] + rope.size();
            let mut matrix = Skyline::zeros(Profile3::new(rope.elements, rope.basis.degree));
            rope.assemble(&lengths[i], &[wind], &x[range.clone()], &v[range], of, &mut matrix);
            let complement = matrix.factor(!is_free(i)).unwrap();
            (matrix, complement)
        };
        let (factors, complements): (Vec<Skyline>, Vec<Mat3>) = ropes.iter().enumerate().map(factored).unzip();
        let on_nodes: Vec<f64> = ropes.iter().map(|rope| rope.on_node(Some(&wind), of)).collect();
        let motion = RopesInMotion {
            ropes: &ropes,
            offsets: &offsets,
            lengths: &lengths,
            on_nodes: &on_nodes,
            motion: [&x, &v],
        };

        // The registers of this machine, and the narrowest ones.
        for is_narrow in [false, true] {
            let mut packs = FactorPack::of(&ropes, |i| i == gone, &factors);
            assert_eq!(packs.iter().map(|pack| pack.ropes.len()).sum::<usize>(), 12);
            for pack in &mut packs {
                if is_narrow {
                    pack.assemble_by(&factors, &motion, of, |of| Simd::vectorize(pulp::Scalar, of));
                    pack.factor_by(&factors, |of| Simd::vectorize(pulp::Scalar, of)).unwrap();
                } else {
                    pack.assemble(&factors, &motion, of);
                    pack.factor(&factors).unwrap();
                }
                for lane in 0..pack.ropes.len() {
                    let i = pack.ropes[lane];
                    let mut factor = factors[i].clone();
                    pack.copy(lane, &mut factor);
                    let whole = if is_free(i) { factor.values.len() } else { factor.node(factor.factored_nodes())[1] };
                    assert!(is_near(&factor.values[..whole], &factors[i].values[..whole]), "factor of rope {i}");
                    let complement = pack.complement(&factor, lane);
                    assert!(is_near(complement.as_slice(), complements[i].as_slice()), "complement of rope {i}");
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
}

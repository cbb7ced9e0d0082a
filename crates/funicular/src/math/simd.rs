//! Eight numbers side by side, the unit of every vector kernel of the crate: one number per frequency, cable or
//! element.
//!
//! There are two ways to work on them. A loop over the eight numbers of a [`Lane`] becomes vector instructions if it is
//! inlined into a function that was dispatched to an instruction set; complex numbers ([`complex`]) and scalar products
//! ([`dot`]) use this way. If the compiler would vectorise the wrong loop, [`Part`] names the registers. Every function
//! here is `#[inline(always)]`, because vector instructions exist only inside the function that was dispatched to them.

pub(crate) mod complex;

use pulp::Simd;
use std::cell::RefCell;
use std::ops::{Deref, DerefMut};

/// Numbers in a [`Lane`]: two AVX2 registers, or one of AVX-512.
pub(crate) const LANES: usize = 8;

/// Eight numbers side by side.
pub(crate) type Lane = [f64; LANES];

/// Sum over a lane, in an order that does not depend on the width of the machine's registers.
#[inline(always)]
pub(crate) fn sum(lane: &Lane) -> f64 {
    let [a, b, c, d, e, f, g, h] = *lane;
    ((a + e) + (c + g)) + ((b + f) + (d + h))
}

/// Scalar product `xᵀ y` of slices of the same length, summed in lanes.
#[inline(always)]
pub(crate) fn dot(x: &[f64], y: &[f64]) -> f64 {
    let mut lanes = [0.0; LANES];
    let (xs, ys) = (x.chunks_exact(LANES), y.chunks_exact(LANES));
    let rest: f64 = xs.remainder().iter().zip(ys.remainder()).map(|(x, y)| x * y).sum();
    for (x, y) in xs.zip(ys) {
        for i in 0..LANES {
            lanes[i] += x[i] * y[i];
        }
    }
    lanes.iter().sum::<f64>() + rest
}

/// A [`Lane`] in memory for computation. It is aligned, because a register that straddles two cache lines is fetched
/// twice. (A plain `Lane` is not, because aligned memory takes longer to allocate.)
#[derive(Debug, Clone, Copy, Default)]
#[repr(align(64))]
pub(crate) struct Line(pub(crate) Lane);

impl Line {
    pub(crate) const ZERO: Self = Self([0.0; LANES]);
}

impl Deref for Line {
    type Target = [f64; LANES];

    #[inline(always)]
    fn deref(&self) -> &[f64; LANES] {
        &self.0
    }
}

impl DerefMut for Line {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut [f64; LANES] {
        &mut self.0
    }
}

/// Part of every lane that fits one register. It fixes the direction of vector code where the compiler might choose
/// another one for a loop over lanes.
#[derive(Clone, Copy)]
pub(crate) struct Part<S: Simd> {
    pub(crate) simd: S,
    at: usize,
}

impl<S: Simd> Part<S> {
    /// All parts of a lane.
    #[inline(always)]
    pub(crate) fn all(simd: S) -> impl Iterator<Item = Self> {
        Self::first(simd, LANES)
    }

    /// Parts that hold the first `count` numbers of a lane.
    #[inline(always)]
    pub(crate) fn first(simd: S, count: usize) -> impl Iterator<Item = Self> {
        (0..count.div_ceil(S::F64_LANES)).map(move |at| Self { simd, at })
    }

    #[inline(always)]
    pub(crate) fn of(self, lane: &Lane) -> S::f64s {
        S::as_simd_f64s(lane).0[self.at]
    }

    #[inline(always)]
    pub(crate) fn set(self, lane: &mut Lane, value: S::f64s) {
        S::as_mut_simd_f64s(lane).0[self.at] = value;
    }

    #[inline(always)]
    pub(crate) fn splat(self, value: f64) -> S::f64s {
        self.simd.splat_f64s(value)
    }

    /// Product and sum a b + c, rounded once.
    #[inline(always)]
    pub(crate) fn mul_add(self, a: S::f64s, b: S::f64s, c: S::f64s) -> S::f64s {
        self.simd.mul_add_f64s(a, b, c)
    }

    /// `a b + c`, rounded once where the processor does so at no cost. Elsewhere, as in browsers, [`Self::mul_add`] is
    /// slow, because it is computed without the processor's help.
    #[inline(always)]
    pub(crate) fn plus(self, a: S::f64s, b: S::f64s, c: S::f64s) -> S::f64s {
        self.simd.mul_add_e_f64s(a, b, c)
    }

    /// `c − a b`, rounded as [`Self::plus`].
    #[inline(always)]
    pub(crate) fn less(self, c: S::f64s, a: S::f64s, b: S::f64s) -> S::f64s {
        self.plus(self.neg(a), b, c)
    }

    #[inline(always)]
    pub(crate) fn mul(self, a: S::f64s, b: S::f64s) -> S::f64s {
        self.simd.mul_f64s(a, b)
    }

    #[inline(always)]
    pub(crate) fn neg(self, a: S::f64s) -> S::f64s {
        self.simd.neg_f64s(a)
    }

    /// Scalar product `Σ a b`, lane by lane.
    #[inline(always)]
    pub(crate) fn dot(self, a: &[Line], b: &[Line]) -> S::f64s {
        // Two sums, so that neither waits for the other.
        let mut sums = [self.splat(0.0); 2];
        let (a_pairs, b_pairs) = (a.chunks_exact(2), b.chunks_exact(2));
        if let ([a], [b]) = (a_pairs.remainder(), b_pairs.remainder()) {
            sums[0] = self.mul(self.of(a), self.of(b));
        }
        for (a, b) in a_pairs.zip(b_pairs) {
            for k in 0..2 {
                sums[k] = self.mul_add(self.of(&a[k]), self.of(&b[k]), sums[k]);
            }
        }
        self.simd.add_f64s(sums[0], sums[1])
    }

    #[inline(always)]
    pub(crate) fn inverse(self, a: S::f64s) -> S::f64s {
        self.simd.div_f64s(self.splat(1.0), a)
    }
}

/// Lanes in memory that the thread keeps for the next robot. If they were returned to the system each time, they would
/// come back as page faults.
#[derive(Debug, Default)]
pub(crate) struct Lanes(Vec<Line>);

thread_local! {
    /// Sorted by the logarithm of their capacity; otherwise small pieces would be used where large ones are needed.
    static SPARE: RefCell<[Vec<Vec<Line>>; SIZES]> = const { RefCell::new([const { Vec::new() }; SIZES]) };
}

/// Number of capacity classes: up to 128 kB per piece.
const SIZES: usize = 12;

/// Maximum number of spare pieces per capacity class and thread.
const MAX_SPARE: usize = 64;

impl Lanes {
    /// Empty, with capacity for `count` lanes.
    pub(crate) fn with_room(count: usize) -> Self {
        let mut lanes = Self::any(count);
        lanes.clear();
        lanes
    }

    /// Lanes with arbitrary values, which the caller has to set.
    pub(crate) fn any(count: usize) -> Self {
        let size = count.next_power_of_two().ilog2() as usize;
        let spare = SPARE.with_borrow_mut(|spare| spare.get_mut(size).and_then(Vec::pop));
        let mut lanes = spare.unwrap_or_else(|| Vec::with_capacity(1 << size));
        lanes.resize(count, Line::ZERO);
        Self(lanes)
    }
}

impl Clone for Lanes {
    fn clone(&self) -> Self {
        let mut lanes = Self::any(self.0.len());
        lanes.0.copy_from_slice(&self.0);
        lanes
    }
}

impl Drop for Lanes {
    fn drop(&mut self) {
        let lanes = std::mem::take(&mut self.0);
        let Some(size) = lanes.capacity().checked_ilog2() else { return };
        // At the end of a thread its store is gone.
        let _ = SPARE.try_with(|spare| {
            let mut spare = spare.borrow_mut();
            if let Some(spare) = spare.get_mut(size as usize).filter(|spare| spare.len() < MAX_SPARE) {
                spare.push(lanes);
            }
        });
    }
}

impl Deref for Lanes {
    type Target = Vec<Line>;

    fn deref(&self) -> &Vec<Line> {
        &self.0
    }
}

impl DerefMut for Lanes {
    fn deref_mut(&mut self) -> &mut Vec<Line> {
        &mut self.0
    }
}

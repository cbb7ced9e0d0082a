//! Receptance at many frequencies; [`LANES`] of them are computed side by side.

use super::receptance;
use crate::cable::catenary_dynamic::{CatenaryDynamicEnd, LossyFamily, LossyPoles, PoleResidue};
use crate::cable::shallow_dynamic::{self, Entire, SERIES_BELOW, ShallowDynamic};
use crate::cable::{DynamicCable, LocalStiffness};
use crate::dynamics::{DynamicCableAt, Dynamics};
use crate::math::simd::complex::{Complexes, SIN_COS_LIMIT, TANH_LIMIT, sin_cos, tanh};
use crate::math::simd::{LANES, Lane};
use crate::math::{CMat6, Complex, Vec6};
use std::array::from_fn;
use std::f64::consts::TAU;

/// Index of entry (i, j), i ≥ j, in a lower triangle by columns.
const fn at(i: usize, j: usize) -> usize {
    j * 6 - j * (j + 1) / 2 + i
}

/// Minimum ratio of a pivot to the largest diagonal entry; lanes below it use the plain version. Above it, elimination
/// without pivoting keeps at least ten digits.
const MIN_PIVOT: f64 = 1e-6;

/// Products of a cable's axes: entries of aaᵀ, anᵀ + naᵀ, nnᵀ, bbᵀ, and of abᵀ + baᵀ and nbᵀ + bnᵀ.
struct Products {
    axial: [f64; 21],
    coupling: [f64; 21],
    normal: [f64; 21],
    out: [f64; 21],
    across: [[f64; 21]; 2],
}

/// Data of the linearised robot in the layout of the kernel: lower triangles by columns.
struct Prepared<'a> {
    dynamics: &'a Dynamics,
    constant: [f64; 21],
    mass: [f64; 21],
    platform_damping: [f64; 21],
    products: Vec<Products>,
    /// Poles of each term with a constant loss of its stretch.
    lossy: Vec<Option<&'a LossyFamily>>,
}

impl<'a> Prepared<'a> {
    /// Data for this number of frequencies.
    fn new(dynamics: &'a Dynamics, frequencies: usize) -> Self {
        let lower = |f: &dyn Fn(usize, usize) -> f64| {
            let mut entries = [0.0; 21];
            for j in 0..6 {
                for i in j..6 {
                    entries[at(i, j)] = f(i, j);
                }
            }
            entries
        };

        let lacking = |i: usize| i >= dynamics.dof();
        // Beyond the platform's coordinates the matrix is an identity.
        let constant = lower(&|i, j| if lacking(i) && i == j { 1.0 } else { dynamics.constant_stiffness()[(i, j)] });
        let (mass, damping) = (dynamics.platform_mass(), dynamics.platform_damping());

        let products = dynamics
            .terms()
            .iter()
            .map(|term| {
                let [a, n, b] = term.axes();
                Products {
                    axial: lower(&|i, j| a[i] * a[j]),
                    coupling: lower(&|i, j| a[i] * n[j] + n[i] * a[j]),
                    normal: lower(&|i, j| n[i] * n[j]),
                    out: lower(&|i, j| b[i] * b[j]),
                    across: [a, n].map(|axis| lower(&|i, j| axis[i] * b[j] + b[i] * axis[j])),
                }
            })
            .collect();
        let lossy = |term: &'a DynamicCableAt| term.form().by_poles()?.lossy_family(frequencies);

        Self {
            dynamics,
            constant,
            mass: lower(&|i, j| mass[(i, j)]),
            platform_damping: lower(&|i, j| damping[(i, j)]),
            products,
            lossy: dynamics.terms().iter().map(lossy).collect(),
        }
    }

    /// Dynamic stiffness D(ω) at each lane, lower triangle.
    #[inline(always)]
    fn dynamic_stiffness(&self, omega: &Lane) -> [Complexes; 21] {
        let mut d: [Complexes; 21] = from_fn(|k| Complexes {
            re: from_fn(|i| self.constant[k] - self.mass[k] * (omega[i] * omega[i])),
            im: from_fn(|i| omega[i] * self.platform_damping[k]),
        });

        for ((term, products), lossy) in self.dynamics.terms().iter().zip(&self.products).zip(&self.lossy) {
            let (k, in_plane_only, coupled) = match term.form() {
                DynamicCable::ShallowDynamic(form) => {
                    (shallow_dynamic::stiffness(entire(form, omega), &form.sag), form.in_plane_only, false)
                }
                DynamicCable::CatenaryDynamic(form) => {
                    let mut k = catenary_dynamic(form, *lossy, omega);
                    if lossy.is_none() && form.has_drive_losses() {
                        add_drive(&mut k, form, omega);
                    }
                    (k, form.in_plane_only, form.coupled().is_some())
                }
            };
            for (entry, d) in d.iter_mut().enumerate() {
                d.add_scaled(&k.axial, products.axial[entry]);
                d.add_scaled(&k.coupling, products.coupling[entry]);
                d.add_scaled(&k.normal, products.normal[entry]);
                if !in_plane_only {
                    d.add_scaled(&k.out_of_plane, products.out[entry]);
                }
                if coupled {
                    d.add_scaled(&k.across[0], products.across[0][entry]);
                    d.add_scaled(&k.across[1], products.across[1][entry]);
                }
            }
        }
        if self.dynamics.supports().is_some() {
            self.take_off_supports(&mut d, omega);
        }
        d
    }

    /// Factors as by [`factorise`]. A loss factor takes nothing at rest, where the complex poles do not hold.
    #[inline(always)]
    fn factorise(&self, d: &mut [Complexes; 21], omega: &Lane) -> [bool; LANES] {
        let accurate = factorise(d);
        let is_lossy = self.lossy.iter().any(Option::is_some);
        from_fn(|i| accurate[i] && !(is_lossy && omega[i] == 0.0))
    }

    /// Subtracts the stiffness that the platform loses because supports yield, lane by lane.
    #[inline(never)]
    fn take_off_supports(&self, d: &mut [Complexes; 21], omega: &Lane) {
        for (lane, omega) in omega.iter().enumerate() {
            let lost = self.dynamics.stiffness_lost_to_supports(*omega);
            for j in 0..6 {
                for i in j..6 {
                    d[at(i, j)].re[lane] -= lost[(i, j)].re;
                    d[at(i, j)].im[lane] -= lost[(i, j)].im;
                }
            }
        }
    }
}

/// Stiffness of a catenary-dynamic cable at each lane. `lossy` has its poles with a constant loss of the stretch.
#[inline(always)]
fn catenary_dynamic(form: &CatenaryDynamicEnd, lossy: Option<&LossyFamily>, omega: &Lane) -> LocalStiffness<Complexes> {
    let (mut re, mut im) = ([0.0; LANES], [0.0; LANES]);
    for i in 0..LANES {
        (re[i], im[i]) = form.damping.square(omega[i], form.mass_per_length);
    }
    let x = Complexes { re, im };
    if let Some(family) = form.coupled() {
        let [axial, coupling, normal, along, across, out_of_plane] = match lossy {
            Some(LossyFamily::Coupled(lossy)) => lossy_pole_sum(lossy, &x),
            _ => pole_sum(family, &x),
        };
        return LocalStiffness { axial, coupling, normal, out_of_plane, across: [along, across] };
    }
    let [axial, coupling, normal] = match lossy {
        Some(LossyFamily::InPlane(lossy)) => lossy_pole_sum(lossy, &x),
        _ => pole_sum(form.in_plane(), &x),
    };
    let out_of_plane = match form.out_of_plane() {
        Some(family) => pole_sum(family, &x)[0],
        None => Complexes::ZERO,
    };
    LocalStiffness { axial, coupling, normal, out_of_plane, across: [Complexes::ZERO; 2] }
}

/// Adds the stiffness by the losses of a drive, lane by lane.
#[cold]
#[inline(never)]
fn add_drive(k: &mut LocalStiffness<Complexes>, form: &CatenaryDynamicEnd, omega: &Lane) {
    for (i, omega) in omega.iter().enumerate() {
        let Some(added) = form.drive_stiffness((*omega).into()) else { continue };
        let entries = [
            (&mut k.axial, added.axial),
            (&mut k.coupling, added.coupling),
            (&mut k.normal, added.normal),
            (&mut k.out_of_plane, added.out_of_plane),
        ];
        let across = k.across.iter_mut().zip(added.across);
        for (sum, added) in entries.into_iter().chain(across) {
            sum.re[i] += added.re;
            sum.im[i] += added.im;
        }
    }
}

/// Entries of `K_s − x M_s − x² Σ g gᵀ/(ω_k² − x)` at each lane.
#[inline(always)]
fn pole_sum<const N: usize, const E: usize>(of: &PoleResidue<N, E>, x: &Complexes) -> [Complexes; E] {
    let mut sums = [Complexes::ZERO; E];
    for (k, pole) in of.poles.iter().enumerate() {
        let gap = Complexes { re: from_fn(|i| pole - x.re[i]), im: from_fn(|i| -x.im[i]) };
        let factor = gap.inverse();
        for (sum, residues) in sums.iter_mut().zip(of.residues()) {
            sum.add_scaled(&factor, residues[k]);
        }
    }
    let (stiffness, mass): ([f64; E], [f64; E]) = (of.start_stiffness(), of.start_mass());
    from_fn(|e| Complexes::real(stiffness[e]) - *x * (Complexes::real(mass[e]) + *x * sums[e]))
}

/// Entries of `K − x M − x² Σ g gᵀ/(λ_k − x)` with complex poles at each lane.
#[inline(always)]
fn lossy_pole_sum<const D: usize, const E: usize>(of: &LossyPoles<D, E>, x: &Complexes) -> [Complexes; E] {
    let mut sums = [Complexes::ZERO; E];
    for (k, pole) in of.poles.iter().enumerate() {
        let gap = Complexes { re: from_fn(|i| pole.re - x.re[i]), im: from_fn(|i| pole.im - x.im[i]) };
        let factor = gap.inverse();
        for (sum, residues) in sums.iter_mut().zip(&of.residues) {
            sum.add_product(&factor, residues[k]);
        }
    }
    let constant = |value: Complex| Complexes { re: [value.re; LANES], im: [value.im; LANES] };
    from_fn(|e| constant(of.stiffness[e]) - *x * (constant(of.mass[e]) + *x * sums[e]))
}

/// Functions of γ of the shallow-dynamic model at each lane, divided by cosh Im √γ.
#[inline(always)]
fn entire(form: &ShallowDynamic, omega: &Lane) -> Entire<Complexes> {
    let (mut re, mut im) = ([0.0; LANES], [0.0; LANES]);
    for i in 0..LANES {
        let (a, b) = form.damping.square(omega[i], form.sag.mass_per_length);
        re[i] = a * form.gamma_by_square;
        im[i] = b * form.gamma_by_square;
    }
    let gamma = Complexes { re, im };
    let h_re: Lane = from_fn(|i| (0.5 * ((re[i] * re[i] + im[i] * im[i]).sqrt() + re[i])).sqrt());
    let h_im: Lane = from_fn(|i| 0.5 * im[i] / h_re[i]);
    let ordinary = (0..LANES).all(|i| re[i] > SERIES_BELOW && h_re[i] < SIN_COS_LIMIT && h_im[i].abs() < TANH_LIMIT);
    if !ordinary {
        return entire_by_lane(gamma);
    }
    let (sine, cosine) = sin_cos(h_re);
    let t = tanh(h_im);
    let s = Complexes { re: sine, im: from_fn(|i| cosine[i] * t[i]) };
    let c = Complexes { re: cosine, im: from_fn(|i| -sine[i] * t[i]) };
    let sigma = s / Complexes { re: h_re, im: h_im };
    Entire { gamma, c, sigma, q: (sigma - c) / gamma }
}

/// Functions of γ lane by lane, for values outside the range of the vector functions.
#[inline(never)]
fn entire_by_lane(gamma: Complexes) -> Entire<Complexes> {
    let mut of = Entire { gamma, c: Complexes::ZERO, sigma: Complexes::ZERO, q: Complexes::ZERO };
    for i in 0..LANES {
        let lane = Entire::complex(gamma.lane(i));
        of.c.set_lane(i, lane.c);
        of.sigma.set_lane(i, lane.sigma);
        of.q.set_lane(i, lane.q);
    }
    of
}

/// Factors `L D Lᵀ` in place: L below the diagonal, inverse pivots on the diagonal. The result is true for a lane if
/// each of its pivots is at least [`MIN_PIVOT`].
#[inline(always)]
fn factorise(d: &mut [Complexes; 21]) -> [bool; LANES] {
    let mut largest = [0.0_f64; LANES];
    for k in 0..6 {
        let n = d[at(k, k)].norm_sqr();
        for i in 0..LANES {
            largest[i] = largest[i].max(n[i]);
        }
    }

    let mut smallest = [f64::INFINITY; LANES];
    for k in 0..6 {
        let n = d[at(k, k)].norm_sqr();
        for i in 0..LANES {
            smallest[i] = smallest[i].min(n[i]);
        }
        let inverse = d[at(k, k)].inverse();
        d[at(k, k)] = inverse;
        for j in k + 1..6 {
            let factor = d[at(j, k)] * inverse;
            for i in j..6 {
                let product = d[at(i, k)] * factor;
                d[at(i, j)] -= product;
            }
        }
        for j in k + 1..6 {
            d[at(j, k)] = d[at(j, k)] * inverse;
        }
    }
    from_fn(|i| smallest[i] > MIN_PIVOT * MIN_PIVOT * largest[i])
}

/// Solution `L⁻¹ v` for a real vector v.
#[inline(always)]
fn forward(l: &[Complexes; 21], v: &[f64; 6]) -> [Complexes; 6] {
    let mut z: [Complexes; 6] = from_fn(|i| Complexes::real(v[i]));
    for j in 0..6 {
        for i in j + 1..6 {
            let product = l[at(i, j)] * z[j];
            z[i] -= product;
        }
    }
    z
}

/// Product `yᵀ D⁻¹ z` of two solutions by [`forward`], with the diagonal D of the factors.
#[inline(always)]
fn product(l: &[Complexes; 21], z: &[Complexes; 6], y: &[Complexes; 6]) -> Complexes {
    let mut sum = Complexes::ZERO;
    for i in 0..6 {
        sum += z[i] * y[i] * l[at(i, i)];
    }
    sum
}

/// Response `outputᵀ D⁻¹ input` at each frequency [Hz].
pub(super) fn one_entry(dynamics: &Dynamics, frequencies_hz: &[f64], input: &Vec6, output: &Vec6) -> Vec<Complex> {
    let scale = dynamics.scale();
    let vector = |v: &Vec6| dynamics.coordinates().motion().reduced(&Vec6::from_fn(|i, _| v[i] / scale[i])).into();

    let mut values = vec![Complex::new(0.0, 0.0); frequencies_hz.len()];
    let entries = OneEntry {
        prepared: Prepared::new(dynamics, frequencies_hz.len()),
        frequencies_hz,
        force: vector(input),
        motion: vector(output),
        plain: &|omega| plain_entry(dynamics, omega, input, output),
        values: &mut values,
    };

    // With registers of 512 bits the compiler makes gathers here, which take half as long again.
    #[cfg(target_arch = "x86_64")]
    match pulp::x86::V3::try_new() {
        Some(simd) => pulp::Simd::vectorize(simd, entries),
        None => pulp::Simd::vectorize(pulp::Scalar, entries),
    }
    #[cfg(not(target_arch = "x86_64"))]
    pulp::Arch::new().dispatch(entries);
    values
}

/// Responses `outputᵀ D⁻¹ input` of all pairs at each frequency [Hz], one row per pair: the first output with all
/// inputs, then the next. D is factorised once per frequency. Each row is that of [`one_entry`] to the last digit.
pub(super) fn entries(
    dynamics: &Dynamics,
    frequencies_hz: &[f64],
    inputs: &[Vec6],
    outputs: &[Vec6],
) -> Vec<Vec<Complex>> {
    let scale = dynamics.scale();
    let vector = |v: &Vec6| dynamics.coordinates().motion().reduced(&Vec6::from_fn(|i, _| v[i] / scale[i])).into();

    let mut rows = vec![vec![Complex::new(0.0, 0.0); frequencies_hz.len()]; inputs.len() * outputs.len()];
    let entries = Entries {
        prepared: Prepared::new(dynamics, frequencies_hz.len()),
        frequencies_hz,
        forces: inputs.iter().map(vector).collect(),
        motions: outputs.iter().map(vector).collect(),
        plain: &|omega, pair| {
            let (output, input) = (&outputs[pair / inputs.len()], &inputs[pair % inputs.len()]);
            plain_entry(dynamics, omega, input, output)
        },
        rows: &mut rows,
    };
    pulp::Arch::new().dispatch(entries);
    rows
}

/// Response `outputᵀ D⁻¹ input` at one angular frequency by the plain version.
fn plain_entry(dynamics: &Dynamics, omega: f64, input: &Vec6, output: &Vec6) -> Complex {
    let x = receptance(dynamics, omega) * input.map(|v| Complex::new(v, 0.0));
    (0..6).map(|i| x[i] * output[i]).sum()
}

/// Complete receptance at each frequency [Hz].
pub(super) fn all_entries(dynamics: &Dynamics, frequencies_hz: &[f64]) -> Vec<CMat6> {
    let mut values = vec![CMat6::zeros(); frequencies_hz.len()];
    pulp::Arch::new().dispatch(AllEntries {
        prepared: Prepared::new(dynamics, frequencies_hz.len()),
        frequencies_hz,
        values: &mut values,
    });
    values
}

/// Loop of [`one_entry`]. It is a type because its call must be inlined into the function that has the vector
/// instructions; this is not guaranteed for the call operator of a closure.
struct OneEntry<'a> {
    prepared: Prepared<'a>,
    frequencies_hz: &'a [f64],
    force: [f64; 6],
    motion: [f64; 6],
    plain: &'a dyn Fn(f64) -> Complex,
    values: &'a mut [Complex],
}

impl pulp::NullaryFnOnce for OneEntry<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { prepared, frequencies_hz, force, motion, plain, values } = self;
        for (block, values) in frequencies_hz.chunks(LANES).zip(values.chunks_mut(LANES)) {
            let omega = angular(block);
            let mut d = prepared.dynamic_stiffness(&omega);
            let accurate = prepared.factorise(&mut d, &omega);
            let sum = product(&d, &forward(&d, &force), &forward(&d, &motion));
            for (i, value) in values.iter_mut().enumerate() {
                *value = if accurate[i] { sum.lane(i) } else { plain(omega[i]) };
            }
        }
    }
}

/// Loop of [`entries`].
struct Entries<'a> {
    prepared: Prepared<'a>,
    frequencies_hz: &'a [f64],
    forces: Vec<[f64; 6]>,
    motions: Vec<[f64; 6]>,
    /// Plain version for one angular frequency and the index of a pair.
    plain: &'a dyn Fn(f64, usize) -> Complex,
    rows: &'a mut [Vec<Complex>],
}

impl pulp::NullaryFnOnce for Entries<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { prepared, frequencies_hz, forces, motions, plain, rows } = self;
        let mut forwards = vec![[Complexes::ZERO; 6]; forces.len()];
        for (block, start) in frequencies_hz.chunks(LANES).zip((0..).step_by(LANES)) {
            let omega = angular(block);
            let mut d = prepared.dynamic_stiffness(&omega);
            let accurate = prepared.factorise(&mut d, &omega);
            for (z, force) in forwards.iter_mut().zip(&forces) {
                *z = forward(&d, force);
            }

            let mut pair = 0;
            for motion in &motions {
                let y = forward(&d, motion);
                for z in &forwards {
                    let sum = product(&d, z, &y);
                    for i in 0..block.len() {
                        rows[pair][start + i] = if accurate[i] { sum.lane(i) } else { plain(omega[i], pair) };
                    }
                    pair += 1;
                }
            }
        }
    }
}

/// Loop of [`all_entries`].
struct AllEntries<'a> {
    prepared: Prepared<'a>,
    frequencies_hz: &'a [f64],
    values: &'a mut [CMat6],
}

impl pulp::NullaryFnOnce for AllEntries<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { prepared, frequencies_hz, values } = self;
        let dynamics = prepared.dynamics;
        for (block, values) in frequencies_hz.chunks(LANES).zip(values.chunks_mut(LANES)) {
            let omega = angular(block);
            let mut d = prepared.dynamic_stiffness(&omega);

            let accurate = prepared.factorise(&mut d, &omega);
            let inverse = invert(&d);
            for (i, value) in values.iter_mut().enumerate() {
                *value = if accurate[i] { of_lane(dynamics, &inverse, i) } else { receptance(dynamics, omega[i]) };
            }
        }
    }
}

/// Receptance of one lane, about the platform origin, from the scaled inverse of its dynamic stiffness.
#[inline(always)]
fn of_lane(dynamics: &Dynamics, inverse: &[Complexes; 21], lane: usize) -> CMat6 {
    let mut scaled = CMat6::zeros();
    for column in 0..dynamics.dof() {
        for row in column..dynamics.dof() {
            let entry = inverse[at(row, column)].lane(lane);
            scaled[(row, column)] = entry;
            scaled[(column, row)] = entry;
        }
    }
    let (expanded, scale) = (dynamics.expanded(&scaled), dynamics.scale());
    CMat6::from_fn(|i, j| expanded[(i, j)] * (1.0 / (scale[i] * scale[j])))
}

/// Inverse `L⁻ᵀ D⁻¹ L⁻¹`, lower triangle, from [`factorise`].
#[inline(always)]
fn invert(l: &[Complexes; 21]) -> [Complexes; 21] {
    // Columns of L⁻¹, below the unit diagonal.
    let mut inverse = [Complexes::ZERO; 21];
    for j in 0..6 {
        inverse[at(j, j)] = Complexes::real(1.0);
        for i in j + 1..6 {
            let mut sum = l[at(i, j)];
            for k in j + 1..i {
                sum += l[at(i, k)] * inverse[at(k, j)];
            }
            inverse[at(i, j)] = sum * -1.0;
        }
    }

    let mut result = [Complexes::ZERO; 21];
    for j in 0..6 {
        for i in j..6 {
            let mut sum = Complexes::ZERO;
            for k in i..6 {
                sum += inverse[at(k, i)] * inverse[at(k, j)] * l[at(k, k)];
            }
            result[at(i, j)] = sum;
        }
    }
    result
}

/// Angular frequencies ω of a block; a short last block repeats its last frequency.
#[inline(always)]
fn angular(block: &[f64]) -> Lane {
    from_fn(|i| block[i.min(block.len() - 1)] * TAU)
}

//! Deliberately plain finite-element cable, compared with every cable model.
//!
//! The cable has straight bars with two nodes and consistent mass. From the program it uses only the equilibrium: the
//! places of the nodes, and the tension in the middle of each bar. (The bar's own stretch would give the tension with
//! an error of EA (κh)²/24, which is large in a stiff rope.)

mod catenary_dynamic;
mod own_model;
mod shallow_dynamic;
mod stretched;

use funicular::cable::catenary_dynamic::CatenaryDynamic;
use funicular::cable::shallow_dynamic::ShallowDynamic;
use funicular::cable::{LocalAxes, Sag};
use funicular::catenary::{Catenary, Rope};
use funicular::math::{DMat, Vec3};
use funicular::robot::Damping;
use std::f64::consts::{PI, TAU};

/// Stiffness and mass over the nodes, with components (horizontal, up, out of plane) per node; first and last are the
/// ends.
struct CableOfBars {
    stiffness: DMat,
    mass: DMat,
}

impl CableOfBars {
    fn new(cable: &Catenary, mass_per_length: f64, count: usize) -> Self {
        let rope = cable.rope();
        let h = rope.unstrained_length / count as f64;
        let size = 3 * (count + 1);
        let (mut stiffness, mut mass) = (DMat::zeros(size, size), DMat::zeros(size, size));
        for e in 0..count {
            let (a, b) = (cable.point_at(e as f64 * h), cable.point_at((e as f64 + 1.0) * h));
            let (dx, dz) = (b[0] - a[0], b[1] - a[1]);
            let length = dx.hypot(dz);
            let tension = cable.tension_at((e as f64 + 0.5) * h);
            let t = [dx / length, dz / length, 0.0];
            for i in 0..3 {
                for j in 0..3 {
                    let same = f64::from(u8::from(i == j));
                    // EA/h along the bar, T/l normal to it.
                    let k = rope.axial_stiffness / h * t[i] * t[j] + tension / length * (same - t[i] * t[j]);
                    let m = mass_per_length * h / 6.0 * same;
                    for (p, q, sign, factor) in
                        [(0, 0, 1.0, 2.0), (0, 1, -1.0, 1.0), (1, 0, -1.0, 1.0), (1, 1, 1.0, 2.0)]
                    {
                        stiffness[(3 * (e + p) + i, 3 * (e + q) + j)] += sign * k;
                        mass[(3 * (e + p) + i, 3 * (e + q) + j)] += factor * m;
                    }
                }
            }
        }
        Self { stiffness, mass }
    }

    /// Dynamic stiffness of the first node with the last node held.
    fn start(&self, omega: f64) -> DMat {
        let d = &self.stiffness - &self.mass * (omega * omega);
        let inner = d.nrows() - 6;
        let coupling = d.view((3, 0), (inner, 3)).clone_owned();
        let solved = d.view((3, 3), (inner, inner)).clone_owned().lu().solve(&coupling).expect("not at a pole");
        d.view((0, 0), (3, 3)) - coupling.transpose() * solved
    }

    /// Clamped frequencies [rad/s], ascending.
    fn clamped(&self) -> Vec<f64> {
        let inner = self.stiffness.nrows() - 6;
        let part = |m: &DMat| m.view((3, 3), (inner, inner)).clone_owned();
        let factor = part(&self.mass).cholesky().expect("mass is positive").l();
        let half = factor.solve_lower_triangular(&part(&self.stiffness)).expect("regular");
        let standard = factor.solve_lower_triangular(&half.transpose()).expect("regular");
        let mut all: Vec<f64> = standard.symmetric_eigenvalues().iter().map(|x| x.max(0.0).sqrt()).collect();
        all.sort_by(f64::total_cmp);
        all
    }
}

const MASS_PER_LENGTH: f64 = 0.067;

/// Highest frequency [rad/s].
const LIMIT: f64 = 7.0 * TAU;

/// Cables as (span, rise, ratio of length to chord): taut, sagging, inclined up and down, deep sag.
const CABLES: [(f64, f64, f64); 5] =
    [(6.0, 0.0, 1.0003), (5.5, 4.0, 1.0008), (5.5, -4.0, 1.004), (6.0, 0.5, 1.03), (2.0, 6.0, 1.01)];

fn cable((span, rise, ratio): (f64, f64, f64)) -> Catenary {
    let unstrained_length = ratio * f64::hypot(span, rise);
    let rope = Rope { unstrained_length, weight_per_length: MASS_PER_LENGTH * 9.81, axial_stiffness: 251_327.0 };
    Catenary::between(span, rise, rope).unwrap()
}

#[test]
fn the_catenary_dynamic_cable_is_the_limit_of_ever_more_bars() {
    for given in CABLES {
        let cable = cable(given);
        let catenary_dynamic = CatenaryDynamic::new(&cable, MASS_PER_LENGTH, LIMIT).unwrap();
        let (coarse, fine) =
            (CableOfBars::new(&cable, MASS_PER_LENGTH, 60), CableOfBars::new(&cable, MASS_PER_LENGTH, 120));
        for frequency in [0.2, 0.9, 2.3, 3.6] {
            let omega = frequency * TAU;
            let poles = catenary_dynamic.in_plane.poles.iter().chain(&catenary_dynamic.out_of_plane.poles);
            let distance = poles.map(|p| (p.sqrt() / omega - 1.0).abs()).fold(1.0, f64::min);
            if distance < 0.03 {
                continue;
            }
            let k = catenary_dynamic.undamped(omega);
            let (coarse, fine) = (coarse.start(omega), fine.start(omega));
            let size = k.axial.abs().max(k.normal.abs()).max(k.coupling.abs());
            for ((i, j), ours) in
                [((0, 0), k.axial), ((0, 1), k.coupling), ((1, 1), k.normal), ((2, 2), k.out_of_plane)]
            {
                // The error of straight bars is of second order in their length: half the length has a quarter of it.
                let extrapolated = (4.0 * fine[(i, j)] - coarse[(i, j)]) / 3.0;
                let (left, once) = ((extrapolated - ours).abs(), (fine[(i, j)] - ours).abs());
                // The remaining error moves the poles by 1e-5, and the stiffness by 1e-5 over the distance to them.
                assert!(
                    left < 3e-5 / distance * size.max(k.out_of_plane.abs()),
                    "{given:?} {frequency} Hz ({i}, {j}): {extrapolated} for {ours}"
                );
                assert!(left <= 0.5 * once + 1e-6 * size, "{given:?} {frequency} Hz ({i}, {j}): {left:e}, {once:e}");
            }
        }
    }
}

#[test]
fn the_catenary_dynamic_cable_has_as_many_clamped_modes_as_the_bars() {
    for given in CABLES {
        let cable = cable(given);
        let catenary_dynamic = CatenaryDynamic::new(&cable, MASS_PER_LENGTH, LIMIT).unwrap();
        let mut ours: Vec<f64> = catenary_dynamic
            .in_plane
            .poles
            .iter()
            .chain(&catenary_dynamic.out_of_plane.poles)
            .map(|pole| pole.sqrt())
            .collect();
        ours.sort_by(f64::total_cmp);
        let bars = CableOfBars::new(&cable, MASS_PER_LENGTH, 120).clamped();
        let below = ours.iter().filter(|omega| **omega < LIMIT).count();
        assert!(below > 3);
        for (k, (a, b)) in ours.iter().zip(&bars).take(below).enumerate() {
            // Error (nπ/N)²/24 of consistent mass with n half waves of the highest family, and as much again of the
            // shape.
            let bound = 4.0 * (PI * (k as f64 + 2.0) / 120.0).powi(2) / 24.0 + 1e-3;
            assert!((a / b - 1.0).abs() < bound, "{given:?}, mode {k}: {a} {b}");
        }
    }
}

#[test]
fn the_shallow_dynamic_model_agrees_with_the_bars_where_sag_is_shallow() {
    for given in [CABLES[0], CABLES[1]] {
        let cable = cable(given);
        let chord = f64::hypot(given.0, given.1);
        let sag = Sag::new(
            chord,
            given.0 / chord,
            cable.parallel_tension(),
            251_327.0,
            MASS_PER_LENGTH,
            MASS_PER_LENGTH * 9.81,
        );
        assert!(sag.ratio() < 0.02, "{}", sag.ratio());
        let axes = LocalAxes::of_chord(&Vec3::zeros(), &Vec3::new(given.0, 0.0, given.1), &Vec3::z());
        let form = ShallowDynamic::new(sag, axes, Damping::Ratio(0.0), false);
        let bars = CableOfBars::new(&cable, MASS_PER_LENGTH, 120).clamped();
        let closed = form.clamped_frequencies_below(LIMIT);
        assert!(closed.len() > 3);
        for (a, b) in closed.iter().zip(&bars) {
            // The theory is of first order in the sag: it leaves out (d/l)² and the variation of tension along the
            // cable.
            assert!((a / b - 1.0).abs() < 0.01, "{given:?}: {a} {b}");
        }
    }
}

#[test]
fn the_warning_about_deep_sag_says_the_error_of_the_shallow_dynamic_model() {
    // The paper's cable, lengthened until its sag ratio is d/l.
    let first = |degrees: f64, ratio: f64| {
        let (sin, cos) = f64::to_radians(degrees).sin_cos();
        let (chord, ea) = (6.848, 20e9 * 1.2566e-5);
        let with = |unstrained_length: f64| {
            let rope = Rope { unstrained_length, weight_per_length: MASS_PER_LENGTH * 9.81, axial_stiffness: ea };
            let cable = Catenary::between(chord * cos, chord * sin, rope).unwrap();
            let sag = Sag::new(chord, cos, cable.parallel_tension(), ea, MASS_PER_LENGTH, MASS_PER_LENGTH * 9.81);
            (cable, sag)
        };
        let (mut low, mut high) = (0.99 * chord, 1.2 * chord);
        while high - low > 1e-13 * chord {
            let middle = 0.5 * (low + high);
            if with(middle).1.ratio() < ratio { low = middle } else { high = middle }
        }
        let (cable, sag) = with(low);
        let catenary_dynamic = CatenaryDynamic::new(&cable, MASS_PER_LENGTH, LIMIT).unwrap();
        let axes = LocalAxes::of_chord(&Vec3::zeros(), &Vec3::new(cos, 0.0, sin), &Vec3::z());
        let closed = ShallowDynamic::new(sag, axes, Damping::Ratio(0.0), true).clamped_frequencies_below(LIMIT)[0];
        closed / catenary_dynamic.in_plane.poles[0].sqrt() - 1.0
    };
    for (degrees, ratio, expected) in [
        (36.0, 0.02, 0.003),
        (36.0, 0.05, 0.018),
        (36.0, 0.10, 0.07),
        (60.0, 0.02, 0.008),
        (60.0, 0.05, 0.044),
        (60.0, 0.10, 0.154),
    ] {
        let off = first(degrees, ratio);
        // To the digits of docs/theory.md, section 6, and of the warning.
        assert!(
            (off - expected).abs() < 0.0006 + 0.002 * f64::from(u8::from(expected >= 0.07)),
            "{degrees}°, d/l {ratio}: {off}"
        );
    }
}

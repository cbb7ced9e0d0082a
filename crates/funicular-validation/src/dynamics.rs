//! Dynamic stiffness and clamped frequencies of one cable.

use super::reference::{BesselRow, ClosedFormRow, Fig2, FiniteElementRow, Published};
use super::section::WRONG;
use super::{Bound, Case, Comparison, Declared, DifferenceKind, Level, NegativeControl, over, reference, slug, worst};
use funicular::cable::shallow_dynamic::ShallowDynamic;
use funicular::cable::{LocalAxes, Sag};
use funicular::math::{Complex, Vec3};
use funicular::robot::Damping;
use std::f64::consts::{PI, TAU};

pub(super) const SECTION: Declared = Declared {
    id: "one-cable",
    title: "Dynamics of one cable",
    note: "The model shallow-dynamic is a closed-form theory of shallow sag, with one tension per string and \
           without axial inertia. Compared with values of the same theory, only rounding remains. Compared with \
           the exact vertical cable, the difference is of second order in the variation of tension along the \
           cable. Compared with finite elements of the elastic catenary, the missing axial inertia causes a \
           difference that grows with the square of the frequency, to 1.5 % at 10 Hz; beside a resonance the \
           slightly shifted pole adds to it.",
    rows: || Ok(rows(&reference::published()?)),
    controls: &[
        NegativeControl {
            id: "mass",
            wrong: "mass per length of the cable 1 % too large",
            proves: "the mass of a vibrating cable",
            rows: || {
                let mut published = reference::published()?;
                published.fig2_cable.mass_kg_per_m *= WRONG;
                published.bessel_cable.mass_kg_per_m *= WRONG;
                Ok(rows(&published))
            },
        },
        NegativeControl {
            id: "tension",
            wrong: "tension of the cable 1 % too large",
            proves: "the tension of a vibrating cable",
            rows: || {
                let mut published = reference::published()?;
                published.fig2_cable.tension_n *= WRONG;
                Ok(rows(&published))
            },
        },
        NegativeControl {
            id: "gravity",
            wrong: "gravity 1 % too large",
            proves: "the sag of the cable",
            rows: || {
                let mut published = reference::published()?;
                published.fig2_cable.gravity_m_s2 *= WRONG;
                Ok(rows(&published))
            },
        },
    ],
};

fn rows(published: &Published) -> Vec<Comparison> {
    let mut rows = roots(published);
    for row in &published.bessel_cable.rows {
        rows.extend(bessel(published, row));
    }
    let source = &published.fig2_closed_form.source;
    rows.extend(published.fig2_closed_form.rows.iter().map(|row| closed_form(published, source, row)));
    let source = &published.fig2_finite_elements.source;
    rows.extend(published.fig2_finite_elements.rows.iter().flat_map(|row| finite_elements(published, source, row)));
    rows
}

/// Sag of the cable of the paper's Fig. 2, with a mass per length [kg/m].
pub(super) fn fig2_sag(of: &Fig2, mass_per_length: f64) -> Sag {
    let cos = of.inclination_deg.to_radians().cos();
    Sag::new(
        of.chord_m,
        cos,
        of.tension_n,
        of.youngs_modulus_pa * of.area_m2,
        mass_per_length,
        mass_per_length * of.gravity_m_s2,
    )
}

fn fig2(of: &Fig2, upper_end_moves: bool, damping: Damping) -> ShallowDynamic {
    let (sin, cos) = of.inclination_deg.to_radians().sin_cos();
    let (lower, upper) = (Vec3::zeros(), Vec3::new(cos, 0.0, sin) * of.chord_m);
    let (from, to) = if upper_end_moves { (upper, lower) } else { (lower, upper) };
    let axes = LocalAxes::of_chord(&from, &to, &Vec3::z());
    ShallowDynamic::new(fig2_sag(of, of.mass_kg_per_m), axes, damping, false)
}

/// Compares the clamped frequencies in plane. The frequencies of the string that sag does not change, even multiples of
/// π, are compared too, but not shown.
fn roots(published: &Published) -> Vec<Comparison> {
    // λ² that stands for the inextensible cable: its roots differ from the limit by a relative 1e-15.
    const INEXTENSIBLE: f64 = 1e18;

    let table = &published.irvine_caughey;
    let rows = table.rows.iter().map(|row| {
        let name = row
            .lambda2
            .map_or_else(|| "inextensible".to_owned(), |l| format!("λ² = {}", funicular_study::text::short(l, 8)));

        let mut cable = fig2(&published.fig2_cable, true, Damping::Ratio(0.0));
        cable.sag.lambda2 = row.lambda2.unwrap_or(INEXTENSIBLE);
        cable.in_plane_only = true;

        // Ω = 1 at this ω.
        let unit = 0.5 / cable.gamma_by_square.sqrt();
        let last = row.roots[3].max(8.0 * PI);
        let found: Vec<f64> =
            cable.clamped_frequencies_below(unit * last * (1.0 + 1e-9)).into_iter().map(|omega| omega / unit).collect();

        // The fifth root of the table's kind lies above 8 π, so there are eight frequencies in total.
        let mut expected: Vec<(f64, bool)> = row.roots.iter().map(|root| (*root, true)).collect();
        expected.extend((1..=4).map(|k| (f64::from(2 * k) * PI, false)));
        expected.sort_by(|a, b| a.0.total_cmp(&b.0));

        let none_invented = if found.len() == expected.len() { 0.0 } else { f64::NAN };
        let gaps = expected.iter().zip(&found).map(|((theirs, _), ours)| (ours / theirs - 1.0).abs());
        let difference = worst(gaps.chain([none_invented]));

        let shown: Vec<f64> =
            expected.iter().zip(&found).filter(|((_, shown), _)| *shown).map(|(_, ours)| *ours).collect();

        Case::new(Level::Exact, &table.source, &format!("irvine-caughey-1974/{}", slug(&name)), &name)
            .of("roots", "first four Ω")
            .numbers(8)
            .row((&row.roots, &shown), (difference, DifferenceKind::Relative), 1e-13, Bound::Rounding)
    });

    rows.collect()
}

fn bessel(published: &Published, row: &BesselRow) -> Vec<Comparison> {
    let of = &published.bessel_cable;
    let weight = of.mass_kg_per_m * of.gravity_m_s2 * of.length_m;

    // Inextensible: τ from the catenary's limit, l·(H/x) = w l/ln(T_B/T_A).
    let tension = weight / f64::ln(1.0 + weight / row.lower_tension_n);
    let sag = Sag::new(of.length_m, 0.0, tension, 1e9, of.mass_kg_per_m, of.mass_kg_per_m * of.gravity_m_s2);
    let axes = LocalAxes::of_chord(&Vec3::zeros(), &(Vec3::z() * of.length_m), &Vec3::z());
    let cable = ShallowDynamic::new(sag, axes, Damping::Ratio(0.0), false);
    let case = Case::new(
        Level::Exact,
        &of.source,
        &format!("bessel/{}n", row.lower_tension_n),
        &format!("vertical, {} N below", row.lower_tension_n),
    );

    let variation = (weight / tension).powi(2);
    let varies = Bound::Model("one tension per string: second order in its variation");
    let theirs = row.clamped_rad_per_s;

    // Every frequency of a vertical string is a double frequency.
    let found: Vec<f64> = cable.clamped_frequencies_below(theirs[2] * 1.2).into_iter().step_by(2).take(3).collect();
    let still = row.stiffness_at_rest_n_per_m;
    let moving = row.stiffness_at_1_rad_per_s_n_per_m;
    let (at_rest, at_one) = (cable.undamped(0.0).out_of_plane, cable.undamped(1.0).out_of_plane);

    vec![
        case.of("rest", "stiffness at rest [N/m]").relative(&[still], &[at_rest], 1e-12, Bound::Rounding),
        case.of("clamped", "first clamped ω [rad/s]").relative(&theirs, &found, 0.012 * variation, varies),
        case.of("stiffness", "stiffness at 1 rad/s [N/m]").absolute(
            &[moving],
            &[at_one],
            0.1 * variation * still,
            varies,
        ),
    ]
}

fn closed_form(published: &Published, source: &str, row: &ClosedFormRow) -> Comparison {
    let case = Case::new(
        Level::Exact,
        source,
        &format!("starossek-1991/{}hz-xi{}", row.frequency_hz, row.damping_ratio),
        &format!("Fig. 2, {} Hz, ξ = {}", row.frequency_hz, row.damping_ratio),
    );
    let cable = fig2(&published.fig2_cable, true, Damping::Ratio(row.damping_ratio));
    let k = cable.damped(row.frequency_hz * TAU);
    let complex = |[re, im]: [f64; 2]| Complex::new(re, im);
    // The chord of the reference runs from the fixed to the moving end, so its coupling has the opposite sign.
    let theirs = [row.axial_n_per_m, row.coupling_n_per_m, row.normal_n_per_m, row.out_of_plane_n_per_m].map(complex);
    let ours = [k.axial, -k.coupling, k.normal, k.out_of_plane];
    let difference = worst(theirs.iter().zip(ours).map(|(a, b)| over((a - b).norm(), a.norm())));
    let moduli = |of: [Complex; 4]| of.map(Complex::norm);
    let shown = (&moduli(theirs)[..], &moduli(ours)[..]);
    // Fourteen digits are printed, of the larger of both parts.
    case.of("moduli", "moduli of k_a, k_b, k_c, k_o [N/m]").row(
        shown,
        (difference, DifferenceKind::Relative),
        2e-11,
        Bound::Rounding,
    )
}

fn finite_elements(published: &Published, source: &str, row: &FiniteElementRow) -> [Comparison; 2] {
    let (frequency, end) = (row.frequency_hz, if row.upper_end_moves { "upper" } else { "lower" });
    let case = Case::new(
        Level::Program,
        source,
        &format!("finite-elements/{frequency}hz-{end}"),
        &format!("Fig. 2, {frequency} Hz, {end} end"),
    );
    let cable = fig2(&published.fig2_cable, row.upper_end_moves, Damping::Ratio(0.0));
    let k = cable.undamped(frequency * TAU).in_world(&cable.axes);
    let [xx, xz, zz, yy] = row.stiffness_xx_xz_zz_yy_n_per_m;

    // Axial inertia, the static coupling of an inclined cable, and the shift of the symmetric pole at 3.12 Hz. A wrong
    // sign of the coupling is off by 29 % at 2.8 Hz.
    let near_pole = 0.012 / (frequency / 3.123 - 1.0).abs();
    let tolerance = 0.015 + near_pole.min(0.1);
    let in_plane = Bound::Model("axial inertia; shift of the pole at 3.12 Hz");
    let ours = [k[(0, 0)], k[(0, 2)], k[(2, 2)]];

    // The tension varies along the cable by 17 % of its mean: poles at multiples of 2.485 Hz are off by 0.1 %.
    let distance = (frequency / 2.485 / (frequency / 2.485).round().max(1.0) - 1.0).abs();
    let across = (0.03 + 0.001 / distance) * yy.abs() + 0.7;
    let out_of_plane = Bound::Model("one tension per string; poles at multiples of 2.485 Hz");

    [
        case.of("in-plane", "K_xx, K_xz, K_zz [N/m]").together(&[xx, xz, zz], &ours, tolerance, in_plane),
        case.of("out-of-plane", "K_yy [N/m]").absolute(&[yy], &[k[(1, 1)]], across, out_of_plane),
    ]
}

//! Strings and sagging cables with held ends.

use super::reference::{ClampedCable, ClampedTable, CooledCable, StringReference, TautString};
use super::section::WRONG;
use super::{Bound, Case, Comparison, Declared, Level, NegativeControl, reference};
use anyhow::Result;
use funicular::cable::catenary_dynamic::CatenaryDynamic;
use funicular::catenary::{Catenary, Rope};
use std::f64::consts::TAU;

/// Relative error of CableDyn's extrapolated frequencies, as two of its meshes tell.
const EXTRAPOLATED: f64 = 2e-7;

/// Relative digits of the exact frequencies.
const EXACT_DIGITS: f64 = 3e-10;

/// Relative difference by the weight that keeps a string without gravity in its plane, a billionth of its tension.
const WEIGHTLESS: f64 = 1e-9;

pub(super) const SECTION: Declared = Declared {
    id: "strings",
    title: "Strings and cables with held ends",
    note: "Frequencies of taut strings of the manuals of ANSYS and SAP2000, tensions of a cable that cools, and \
           frequencies of four sagging cables, up to a sag of an eighth of the chord, against exact shooting and \
           against a finite-element program.",
    rows: || rows(&reference::strings()?),
    controls: &[
        NegativeControl {
            id: "mass",
            wrong: "mass per length of strings and cables 1 % too large",
            proves: "the mass of a vibrating cable",
            rows: || {
                let mut reference = reference::strings()?;
                reference.strings.rows.iter_mut().for_each(|of| of.density_lb_s2_per_in4 *= WRONG);
                reference.cabledyn.table.rows.iter_mut().for_each(|of| of.mass_kg_per_m *= WRONG);
                rows(&reference)
            },
        },
        NegativeControl {
            id: "ea",
            wrong: "axial stiffness EA of strings and cables 1 % too large",
            proves: "the stretch at rest and in motion",
            rows: || {
                let mut reference = reference::strings()?;
                reference.strings.rows.iter_mut().for_each(|of| of.area_in2 *= WRONG);
                reference.cooled.area_mm2 *= WRONG;
                reference.cabledyn.table.rows.iter_mut().for_each(|of| of.axial_stiffness_n *= WRONG);
                rows(&reference)
            },
        },
    ],
};

fn rows(reference: &StringReference) -> Result<Vec<Comparison>> {
    let mut rows = Vec::new();
    for of in &reference.strings.rows {
        rows.extend(string(of)?);
    }
    rows.extend(cooled(&reference.cooled)?);
    for of in &reference.cabledyn.table.rows {
        rows.extend(clamped(&reference.cabledyn, of)?);
    }
    Ok(rows)
}

/// Frequencies of a string whose ends move with it: the mass per stretched length is that of the source.
fn string(of: &TautString) -> Result<Vec<Comparison>> {
    let axial_stiffness = of.area_in2 * of.youngs_modulus_lb_per_in2;
    let strain = of.initial_strain.or_else(|| Some(of.tension_lb? / axial_stiffness)).unwrap_or(f64::NAN);
    let tension = strain * axial_stiffness;
    let rope = Rope {
        unstrained_length: of.length_in / (1.0 + strain),
        weight_per_length: WEIGHTLESS * tension / of.length_in,
        axial_stiffness,
    };
    let mass_per_length = of.area_in2 * of.density_lb_s2_per_in4 * (1.0 + strain);
    let catenary = Catenary::between(of.length_in, 0.0, rope)?;
    let exact = CatenaryDynamic::new(&catenary, mass_per_length, 1.2 * TAU * of.closed_form_hz[2])?;
    let found: Vec<f64> = exact.out_of_plane.poles.iter().take(3).map(|square| square.sqrt() / TAU).collect();

    let case = Case::new(Level::Exact, &of.source, &of.id, &format!("{}, string of {} in", of.id, of.length_in));
    let forces = [catenary.horizontal_force()];
    let printed = Bound::Digits("printed digits");
    Ok(vec![
        case.of("tension", "tension [lb]").relative(&[of.closed_form_tension_lb], &forces, WEIGHTLESS, Bound::Rounding),
        case.of("tension-printed", "tension, published [lb]").level(Level::Published).relative(
            &[of.printed_tension_lb],
            &forces,
            of.printed_relative,
            printed,
        ),
        case.of("frequencies", "first three frequencies [Hz]").relative(
            &of.closed_form_hz,
            &found,
            WEIGHTLESS,
            Bound::Rounding,
        ),
        case.of("frequencies-printed", "first three frequencies, published [Hz]").level(Level::Published).relative(
            &of.printed_hz,
            &found,
            of.printed_relative,
            printed,
        ),
    ])
}

/// Tensions of a cable that cools between fixed ends.
fn cooled(of: &CooledCable) -> Result<Vec<Comparison>> {
    let axial_stiffness = of.youngs_modulus_n_per_mm2 * of.area_mm2;
    let each = of.rows.iter().map(|row| {
        let strain = of.expansion_per_k * row.cooled_by_k;
        let rope = Rope { unstrained_length: 1.0 - strain, weight_per_length: 1e-6, axial_stiffness };
        let catenary = Catenary::between(1.0, 0.0, rope)?;
        let id = format!("code-aster-ssnl115/{}k", row.cooled_by_k);
        let case = Case::new(Level::Published, &of.source, &id, &format!("cooled by {} K", row.cooled_by_k));
        // 1/(1 − αΔT) − 1 is αΔT/(1 − αΔT).
        let tolerance = strain / (1.0 - strain) * (1.0 + 1e-6);
        let bound = Bound::Model("strain of the cooled cable");
        let ours = [catenary.horizontal_force()];
        Ok(case.of("tension", "tension [N]").relative(&[row.tension_n], &ours, tolerance, bound))
    });
    each.collect()
}

/// Forces and clamped frequencies of a sagging cable.
fn clamped(table: &ClampedTable, of: &ClampedCable) -> Result<Vec<Comparison>> {
    let (sin, cos) = of.inclination_deg.to_radians().sin_cos();
    let rope = Rope {
        unstrained_length: of.unstrained_length_m,
        weight_per_length: of.mass_kg_per_m * of.gravity_m_s2,
        axial_stiffness: of.axial_stiffness_n,
    };
    let catenary = Catenary::between(of.chord_m * cos, of.chord_m * sin, rope)?;
    let highest = super::largest(&of.exact_in_plane_rad_per_s).max(super::largest(&of.exact_out_of_plane_rad_per_s));
    let exact = CatenaryDynamic::new(&catenary, of.mass_kg_per_m, 1.01 * highest)?;
    let first = |squares: &[f64], count: usize| -> Vec<f64> { squares.iter().take(count).map(|s| s.sqrt()).collect() };
    let in_plane = first(&exact.in_plane.poles, of.exact_in_plane_rad_per_s.len());
    let across = first(&exact.out_of_plane.poles, of.exact_out_of_plane_rad_per_s.len());

    let case = Case::new(Level::Exact, &table.exact_source, &of.case, &of.case);
    let forces = [catenary.horizontal_force(), catenary.vertical_force_at_end()];
    let theirs = [of.horizontal_force_n, of.vertical_force_at_end_n];
    let digits = Bound::Digits("printed digits");
    let mut rows = vec![
        case.of("forces", "H, V at the end [N]").relative(&theirs, &forces, 1e-11, Bound::Rounding),
        case.of("in-plane", "first clamped ω in plane [rad/s]").relative(
            &of.exact_in_plane_rad_per_s,
            &in_plane,
            EXACT_DIGITS,
            digits,
        ),
        case.of("out-of-plane", "first clamped ω out of plane [rad/s]").relative(
            &of.exact_out_of_plane_rad_per_s,
            &across,
            EXACT_DIGITS,
            digits,
        ),
    ];
    let case = Case::new(Level::Program, &table.table.source, &format!("cabledyn/{}", of.case), &of.case);
    let mesh = Bound::Digits("error of the extrapolated elements");
    rows.extend([
        case.of("in-plane", "first clamped ω in plane [rad/s]").relative(
            &of.cabledyn_in_plane_rad_per_s,
            &in_plane,
            EXTRAPOLATED,
            mesh,
        ),
        case.of("out-of-plane", "first clamped ω out of plane [rad/s]").relative(
            &of.cabledyn_out_of_plane_rad_per_s,
            &across,
            EXTRAPOLATED,
            mesh,
        ),
    ]);
    Ok(rows)
}

//! Elastic catenary of one cable.

use super::reference::{HungBetween, IsolatedCable, Published};
use super::section::WRONG;
use super::{Bound, Case, Comparison, Declared, DifferenceKind, Level, NegativeControl, over, reference, slug, worst};
use anyhow::Result;
use funicular::catenary::{Catenary, CatenaryError, Rope};

pub(super) const SECTION: Declared = Declared {
    id: "catenary",
    title: "Elastic catenary",
    note: "Forces and stiffness of one hanging cable. Both sides solve the same equations, so only rounding \
           remains.",
    rows: || rows(&reference::published()?),
    controls: &[
        NegativeControl {
            id: "ea",
            wrong: "axial stiffness EA of every cable 1 % too large",
            proves: "the stretch of the catenary",
            rows: || {
                let mut published = reference::published()?;
                published.catenary_grid.rows.iter_mut().for_each(|of| of.hung.axial_stiffness_n *= WRONG);
                published.catenary_moorpy.rows.clear();
                published.hanging_lines.rows.clear();
                rows(&published)
            },
        },
        NegativeControl {
            id: "weight",
            wrong: "weight per length of every cable 1 % too large, as by a wrong g",
            proves: "the weight of the catenary",
            rows: || {
                let mut published = reference::published()?;
                let tables = [&mut published.catenary_grid.rows].into_iter().flatten().map(|of| &mut of.hung);
                tables.for_each(|hung| hung.weight_n_per_m *= WRONG);
                published.catenary_moorpy.rows.iter_mut().for_each(|of| of.hung.weight_n_per_m *= WRONG);
                rows(&published)
            },
        },
        NegativeControl {
            id: "load",
            wrong: "load at the node between two cables 1 % too large",
            proves: "the balance of two cables",
            rows: || {
                let mut published = reference::published()?;
                published.isolated_cable.load_kip *= WRONG;
                isolated_cable(&published.isolated_cable)
            },
        },
    ],
};

fn rows(published: &Published) -> Result<Vec<Comparison>> {
    let mut rows = Vec::new();
    for cable in &published.catenary_grid.rows {
        let case = Case::new(
            Level::Exact,
            &published.catenary_grid.source,
            &format!("irvine/{}", id(&cable.hung)),
            &describe(&cable.hung),
        );
        let ours = hang(&cable.hung)?;
        let forces = [ours.horizontal_force(), ours.vertical_force_at_end()];
        let theirs = [cable.horizontal_force_n, cable.vertical_force_at_end_n];
        rows.push(case.of("forces", "H, V at the end [N]").relative(&theirs, &forces, 1e-12, Bound::Rounding));
        rows.push(stiffness(&case, cable.end_stiffness_xx_xz_zz_n_per_m, &ours));
    }

    for cable in &published.catenary_moorpy.rows {
        let case = Case::new(
            Level::Exact,
            &published.catenary_moorpy.source,
            &format!("moorpy/{}", id(&cable.hung)),
            &describe(&cable.hung),
        );
        let ours = hang(&cable.hung)?;
        let forces = [ours.horizontal_force(), ours.vertical_force_at_start(), ours.vertical_force_at_end()];
        let theirs = [cable.horizontal_force_n, cable.vertical_force_at_start_n, cable.vertical_force_at_end_n];
        // Strains of 1e-4: the twelfth digit of the force is the sixteenth of the length.
        rows.push(case.of("forces", "H, V at start and end [N]").relative(&theirs, &forces, 2e-11, Bound::Rounding));
    }
    for line in &published.hanging_lines.rows {
        let case = Case::new(Level::Exact, &line.source, &slug(&line.case), &line.case);
        let ours = hang(&line.hung)?;
        let sag = -ours.point_at(0.5 * line.hung.unstrained_length_m)[1];
        for (id, quantity, theirs, ours) in [
            ("h", "H [N]", line.horizontal_force_n, ours.horizontal_force()),
            ("sag", "sag at the middle [m]", line.sag_at_mid_m, sag),
            ("h-kn", "H [kN]", line.horizontal_force_kn, 1e-3 * ours.horizontal_force()),
            ("tension-end", "tension at the end [kN]", line.tension_at_end_kn, 1e-3 * ours.tension_at_end()),
            ("tension-start", "tension at the start [kN]", line.tension_at_start_kn, 1e-3 * ours.tension_at_start()),
        ] {
            if let Some(theirs) = theirs {
                rows.push(case.of(id, quantity).relative(&[theirs], &[ours], 1e-12, Bound::Rounding));
            }
        }
    }

    rows.extend(isolated_cable(&published.isolated_cable)?);

    Ok(rows)
}

/// Compares the direct stiffnesses relative to their own size, and the coupling, which may be zero, relative to the
/// larger of them.
fn stiffness(case: &Case, theirs: [f64; 3], cable: &Catenary) -> Comparison {
    let [[xx, xz], [_, zz]] = cable.tangent();
    let ours = [xx, xz, zz];
    let larger = theirs[0].max(theirs[2]);
    let sizes = [theirs[0], larger, theirs[2]];
    let difference = worst((0..3).map(|i| over((ours[i] - theirs[i]).abs(), sizes[i])));
    let difference = (difference, DifferenceKind::Relative);
    case.of("end-stiffness", "end stiffness xx, xz, zz [N/m]").row((&theirs, &ours), difference, 1e-12, Bound::Rounding)
}

/// Span, rise and length of a cable as the name of its case.
fn id(of: &HungBetween) -> String {
    [of.span_m, of.rise_m, of.unstrained_length_m].map(|value| funicular_study::text::short(value, 6)).join("_")
}

fn rope(of: &HungBetween) -> Rope {
    Rope {
        unstrained_length: of.unstrained_length_m,
        weight_per_length: of.weight_n_per_m,
        axial_stiffness: of.axial_stiffness_n,
    }
}

fn hang(of: &HungBetween) -> Result<Catenary, CatenaryError> {
    Catenary::between(of.span_m, of.rise_m, rope(of))
}

fn describe(of: &HungBetween) -> String {
    let short = |value: f64| funicular_study::text::short(value, 6);
    format!("span {} m, rise {} m, length {} m", short(of.span_m), short(of.rise_m), short(of.unstrained_length_m))
}

/// Compares a load at a node between two cables, in feet and kips as published.
fn isolated_cable(of: &IsolatedCable) -> Result<Vec<Comparison>> {
    let at_rest = node(of, 0.0, [400.0, -96.0])?;
    let loaded = node(of, of.load_kip, [398.0, -114.0])?;
    let moved = [0, 1].map(|i| (loaded[i] - at_rest[i]) * of.metres_per_foot);
    let case = Case::new(Level::Exact, &of.source, "michalos-1962", "node under a load");
    let computed = &of.displacement_under_load_m;
    let printed = &of.published_displacement_m;
    Ok(vec![
        case.of("node", "node at rest x, z [ft]").together(&of.node_at_rest_ft, &at_rest, 1e-12, Bound::Rounding),
        case.of("displacement", "displacement x, z, recomputed [m]").relative(computed, &moved, 1e-10, Bound::Rounding),
        case.of("displacement-printed", "displacement x, z, published [m]").level(Level::Published).absolute(
            printed,
            &moved,
            5e-4,
            Bound::Digits("three decimals"),
        ),
    ])
}

/// Equilibrium position of the node with a downward load, by Newton's method with finite differences.
fn node(of: &IsolatedCable, load: f64, start: [f64; 2]) -> Result<[f64; 2], CatenaryError> {
    let cable = |span: f64, rise: f64, unstrained_length: f64| {
        let axial_stiffness = of.area_in2 * of.youngs_modulus_kip_per_in2;
        Catenary::between(
            span,
            rise,
            Rope { unstrained_length, weight_per_length: of.weight_kip_per_ft, axial_stiffness },
        )
    };
    let [left, right] = of.unstrained_lengths_ft;
    let balance = |x: f64, z: f64| -> Result<[f64; 2], CatenaryError> {
        let (a, b) = (cable(x, z, left)?, cable(of.span_ft - x, -z, right)?);
        let up = b.vertical_force_at_start() - a.vertical_force_at_end() - load;
        Ok([b.horizontal_force() - a.horizontal_force(), up])
    };
    let [mut x, mut z] = start;
    let step = 1e-6;

    for _ in 0..60 {
        let [f, g] = balance(x, z)?;
        let ([fx, gx], [fz, gz]) = (balance(x + step, z)?, balance(x, z + step)?);
        let (a, b, c, d) = ((fx - f) / step, (fz - f) / step, (gx - g) / step, (gz - g) / step);
        let determinant = a * d - b * c;
        // A step is not longer than the reach of the cables.
        x -= ((d * f - b * g) / determinant).clamp(-20.0, 20.0);
        z -= ((a * g - c * f) / determinant).clamp(-20.0, 20.0);
    }

    Ok([x, z])
}

//! Fig. 2 of the paper: stiffness of one cable over frequency.

use super::published::{FIG2_PRINTED, FINITE_ELEMENTS};
use crate::pages::figure::{PageFigure, axis, colour, line, points, with};
use crate::pages::table::{PageTable, fixed};
use funicular::cable::shallow_dynamic::ShallowDynamic;
use funicular::cable::{LocalAxes, Sag};
use funicular::math::Vec3;
use funicular::robot::Damping;
use serde_json::json;
use std::f64::consts::TAU;

const CHORD: f64 = 6.848;
const TENSION: f64 = 77.6;
const AXIAL_STIFFNESS: f64 = 20e9 * 1.2566e-5;
const INCLINATION_DEG: f64 = 36.0;
const DAMPING: f64 = 0.003;
const GRAVITY: f64 = 9.81;
/// Mass per length of the paper's Table II [kg/m].
const MASS_TABLE_II: f64 = 0.067;
/// Mass per length that reproduces the printed λ² and ε [kg/m].
const MASS_PRINTED: f64 = 0.069;
/// Number of points of a curve.
const POINTS: u32 = 2000;
/// Upper limit of the frequencies [Hz].
const BELOW_HZ: f64 = 10.0;

/// End of the cable that moves.
#[derive(Clone, Copy, PartialEq)]
enum MovedEnd {
    Lower,
    Upper,
}

fn cable(mass_per_length: f64, end: MovedEnd) -> ShallowDynamic {
    let (sin, cos) = INCLINATION_DEG.to_radians().sin_cos();
    let sag = Sag::new(CHORD, cos, TENSION, AXIAL_STIFFNESS, mass_per_length, mass_per_length * GRAVITY);
    let towards_other = Vec3::new(cos, 0.0, sin) * if end == MovedEnd::Lower { 1.0 } else { -1.0 };
    let axes = LocalAxes::of_chord(&Vec3::zeros(), &towards_other, &Vec3::z());
    ShallowDynamic::new(sag, axes, Damping::Ratio(DAMPING), false)
}

/// Magnitude |K11|: horizontal force per horizontal motion [N/m].
fn horizontal(cable: &ShallowDynamic, frequency_hz: f64) -> f64 {
    let k = cable.damped(frequency_hz * TAU);
    let (e, n) = (cable.axes.e.x, cable.axes.n.x);
    (k.axial * (e * e) + k.coupling * (2.0 * e * n) + k.normal * (n * n)).norm()
}

/// Stiffness K11 without damping, with its sign [N/m].
fn horizontal_undamped(cable: &ShallowDynamic, frequency_hz: f64) -> f64 {
    let k = cable.undamped(frequency_hz * TAU);
    let (e, n) = (cable.axes.e.x, cable.axes.n.x);
    k.axial * (e * e) + k.coupling * (2.0 * e * n) + k.normal * (n * n)
}

/// Figure of |K11| over frequency, with independent finite elements.
pub(crate) fn figure() -> PageFigure {
    let frequencies: Vec<f64> = (0..=POINTS).map(|k| BELOW_HZ * f64::from(k) / f64::from(POINTS)).collect();

    let curve = |name: &str, mass, end, colour, dash| {
        let cable = cable(mass, end);
        let values: Vec<f64> = frequencies.iter().map(|f| horizontal(&cable, *f)).collect();
        with(line(name, &frequencies, &values, colour, dash), json!({"hovertemplate": "%{x:.2f} Hz<br>%{y:.4g} N/m"}))
    };

    let elements = |name: &str, column: usize, colour, symbol| {
        let x: Vec<f64> = FINITE_ELEMENTS.iter().map(|row| row[0]).collect();
        let y: Vec<f64> = FINITE_ELEMENTS.iter().map(|row| row[column].abs()).collect();
        points(name, &x, &y, colour, symbol)
    };

    let data = [
        curve("shallow-dynamic, lower end, 0.067 kg/m", MASS_TABLE_II, MovedEnd::Lower, colour::BLUE, "solid"),
        curve("shallow-dynamic, upper end, 0.067 kg/m", MASS_TABLE_II, MovedEnd::Upper, colour::VERMILION, "solid"),
        curve("shallow-dynamic, lower end, 0.069 kg/m", MASS_PRINTED, MovedEnd::Lower, colour::GREY, "dash"),
        elements("finite elements, lower end", 2, colour::BLUE, "circle-open"),
        elements("finite elements, upper end", 1, colour::VERMILION, "diamond-open"),
    ];

    PageFigure::new(
        "figure-cable-stiffness",
        470,
        "The paper's Fig. 2: magnitude of the horizontal end stiffness K11 of one cable (E = 20 GPa, A = 1.2566·10⁻⁵ \
         m², chord 6.848 m, τ = 77.6 N, 36°, ξ = 0.003). Lines: cable model shallow-dynamic (closed form for small \
         sag) at either end; the dashed line has the mass per length that gives the printed λ². Symbols: lumped-mass \
         finite elements of the catenary, 0.067 kg/m, undamped (MoorPy 1.3.0 line matrices, 200 and 400 segments, \
         Richardson extrapolated).",
        &data,
        json!({
            "xaxis": axis("frequency [Hz]", json!({"range": [0, BELOW_HZ]})),
            "yaxis": axis("|K11| [N/m]", json!({"type": "log", "exponentformat": "power", "dtick": 1})),
            "margin": {"l": 74},
        }),
    )
}

/// Table of the cable's parameters: printed, and computed with either mass per length.
pub(crate) fn numbers() -> PageTable {
    let mut table = PageTable::new(
        "table-cable-numbers",
        "The cable of Fig. 2: values printed in the paper, and values computed from its data with the mass per length \
         of its Table II and with the mass per length that reproduces the printed λ² and ε.",
        &["<", "mass per length|kg/m", "λ²", "ε", "Le/l", "held cable, in plane: first resonance|Hz", "second|Hz"],
    );

    let (lambda2, epsilon) = FIG2_PRINTED;
    let blank = || "–".to_owned();
    table.row(vec![
        "printed".into(),
        "0.067 (Table II)".into(),
        fixed(lambda2, 2),
        fixed(epsilon, 3),
        "1.0003".into(),
        blank(),
        blank(),
    ]);

    for (name, mass) in [("from Table II", MASS_TABLE_II), ("to match the printed values", MASS_PRINTED)] {
        let mut cable = cable(mass, MovedEnd::Lower);
        cable.in_plane_only = true;

        let held = cable.clamped_frequencies_below(BELOW_HZ * TAU);

        table.row(vec![
            name.into(),
            fixed(mass, 3),
            fixed(cable.sag.lambda2, 2),
            fixed(cable.sag.epsilon, 4),
            fixed(cable.sag.effective_length / cable.sag.chord, 5),
            fixed(held[0] / TAU, 3),
            fixed(held[1] / TAU, 3),
        ]);
    }
    table
}

/// Table of the model shallow-dynamic compared with finite elements.
pub(crate) fn against_elements() -> PageTable {
    let mut table = PageTable::new(
        "table-elements",
        "K11 without damping, 0.067 kg/m: model shallow-dynamic compared with finite elements of the catenary. \
         Relative differences mean little where K11 passes through zero (near 2.45 Hz) and beside its pole (3.12 Hz). \
         Towards 10 Hz the model is too stiff, because it leaves out the axial inertia: by about (ω l √(m/EA))²/3, 1.5 \
         % at 9.5 Hz.",
        &[
            "frequency|Hz",
            "lower end, elements|N/m",
            "shallow-dynamic|N/m",
            "difference|%",
            "upper end, elements|N/m",
            "shallow-dynamic|N/m",
            "difference|%",
        ],
    );

    let (lower, upper) = (cable(MASS_TABLE_II, MovedEnd::Lower), cable(MASS_TABLE_II, MovedEnd::Upper));

    for [frequency, theirs_upper, theirs_lower] in FINITE_ELEMENTS {
        let mut cells = vec![fixed(frequency, 1)];
        for (theirs, cable) in [(theirs_lower, &lower), (theirs_upper, &upper)] {
            let ours = horizontal_undamped(cable, frequency);
            cells.extend([fixed(theirs, 1), fixed(ours, 1), fixed(100.0 * (ours / theirs - 1.0), 2)]);
        }

        table.row(cells);
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_printed_values_need_another_mass_per_length_than_table_ii() {
        assert!((cable(MASS_TABLE_II, MovedEnd::Lower).sag.lambda2 - 7.13).abs() < 0.01);
        assert!((cable(MASS_PRINTED, MovedEnd::Lower).sag.lambda2 - 7.57).abs() < 0.02);
    }

    #[test]
    fn shallow_dynamic_follows_the_finite_elements_at_both_ends() {
        for [frequency, upper, lower] in FINITE_ELEMENTS {
            for (theirs, end) in [(upper, MovedEnd::Upper), (lower, MovedEnd::Lower)] {
                let ours = horizontal_undamped(&cable(MASS_TABLE_II, end), frequency);
                // 2.8 and 3.0 Hz lie on the flank of the pole at 3.12 Hz, 2.4 Hz beside a zero.
                assert!((ours - theirs).abs() < 400.0 + 0.02 * theirs.abs(), "{frequency} Hz: {ours} {theirs}");
            }
        }
    }
}

//! Shallow-dynamic cables against identities.

use funicular::cable::shallow_dynamic::ShallowDynamic;
use funicular::cable::{LocalAxes, Sag};
use funicular::math::Vec3;
use funicular::robot::Damping;
use std::f64::consts::PI;

/// The paper's cable of Fig. 2, seen from its upper end.
fn papers_cable(damping: Damping) -> ShallowDynamic {
    let (chord, tension, axial_stiffness, mass, gravity) = (6.848, 77.6, 251.32e3, 0.067, 9.81);
    let (sin, cos) = f64::to_radians(36.0).sin_cos();
    let sag = Sag::new(chord, cos, tension, axial_stiffness, mass, mass * gravity);
    let axes = LocalAxes::of_chord(&(Vec3::new(cos, 0.0, sin) * chord), &Vec3::zeros(), &Vec3::z());
    ShallowDynamic::new(sag, axes, damping, false)
}

/// Half of the frequencies in plane are those of the string: antisymmetric modes do not stretch a shallow cable.
#[test]
fn antisymmetric_modes_know_nothing_of_the_sag() {
    for lambda2 in [1e-3, 1.0, 7.0, 40.0, 90.0, 1e3, 1e6] {
        let mut cable = papers_cable(Damping::Ratio(0.0));
        cable.sag.lambda2 = lambda2;
        cable.in_plane_only = true;
        // Ω = 1 at this ω.
        let unit = 0.5 / cable.gamma_by_square.sqrt();
        let found = cable.clamped_frequencies_below(unit * 20.0 * PI);
        for k in 1..10 {
            let string = unit * f64::from(2 * k) * PI;
            let gap = found.iter().map(|omega| (omega / string - 1.0).abs()).fold(f64::INFINITY, f64::min);
            assert!(gap < 1e-13, "λ² {lambda2}, mode {k}: {gap:e}");
        }
        // Between two of them lies a symmetric one, which depends on the sag.
        assert!((18..=20).contains(&found.len()), "λ² {lambda2}: {}", found.len());
    }
}

#[test]
fn damping_makes_every_cable_passive() {
    for damping in [Damping::Ratio(0.003), Damping::Ratio(0.2), Damping::Viscous(0.05)] {
        for i in 1..500 {
            let k = papers_cable(damping).damped(0.3 * f64::from(i));
            let determinant = k.axial.im * k.normal.im - k.coupling.im * k.coupling.im;
            assert!(k.axial.im > 0.0 && k.normal.im > 0.0 && k.out_of_plane.im > 0.0, "{damping:?} {i}");
            assert!(determinant > -1e-12 * k.axial.im * k.normal.im, "{damping:?} {i}");
        }
    }
}

//! Tracking of a robot whose natural frequencies cross or veer, depending on its symmetry.

use funicular::cable::CableModel;
use funicular::cable_motion::WeightedMotions;
use funicular::dynamics::{Dynamics, Linearisation};
use funicular::modes::tracking::{Tracked, track};
use funicular::modes::{self, Mode};
use funicular::robot::{Robot, State};
use funicular::statics::{self, StaticModel};
use std::fmt::Write;

/// Point mass without weight between pairs of cables along x, y and z. The pair along x is `ratio` times as stiff as
/// the pair along y, and a diagonal pair has the fraction `coupling` of that stiffness.
fn star(ratio: f64, coupling: f64) -> Robot {
    let mut text =
        String::from("name = \"star\"\ngravity_m_s2 = [0, 0, 0]\n[platform]\nmass_kg = 2.0\nmotion = \"point-mass\"\n");
    let diagonal = 2.0 * 0.5_f64.sqrt();
    let pairs = [
        ("x", [2.0, 0.0, 0.0], ratio),
        ("y", [0.0, 2.0, 0.0], 1.0),
        ("z", [0.0, 0.0, 2.0], 3.0),
        ("across", [diagonal, diagonal, 0.0], coupling),
    ];
    for (name, anchor, part) in pairs {
        let axial_stiffness = 1e5 * part;
        writeln!(text, "[materials.{name}]\naxial_stiffness_n = {axial_stiffness:?}\nmass_kg_per_m = 0.0").unwrap();
        for (end, sign) in [("plus", 1.0), ("minus", -1.0)] {
            let anchor = anchor.map(|x: f64| sign * x);
            writeln!(
                text,
                "[[cables]]\nname = \"{name} {end}\"\nmaterial = \"{name}\"\nanchor_m = {anchor:?}\n\
                 unstrained_length_m = 1.999"
            )
            .unwrap();
        }
    }
    Robot::from_toml(&text).unwrap()
}

/// The two lower modes, in the plane of x and y, and their motions for tracking.
fn in_plane(ratio: f64, coupling: f64) -> (Vec<Mode>, Vec<Tracked>) {
    let robot = star(ratio, coupling);
    let State::Lengths(lengths) = &robot.state else { panic!("given by lengths") };
    let rest = statics::forward(&robot, lengths, StaticModel::Spring, None).unwrap();
    let linearisation = Linearisation { cable_model: CableModel::Spring, ..Default::default() };
    let dynamics = Dynamics::about(&robot, &rest, linearisation, 100.0).unwrap();
    let mut modes = modes::below(&dynamics, 100.0).modes;
    modes.truncate(2);
    let motions = WeightedMotions::new(&robot, &rest, &dynamics).unwrap();
    let tracked = modes.iter().map(|mode| motions.of(mode)).collect();
    (modes, tracked)
}

/// Ratios from 0.8 to 1.25 in a number of steps, symmetric about 1 and without 1 itself.
fn ratios(steps: i32) -> impl Iterator<Item = f64> {
    (0..steps).map(move |k| (0.8_f64.ln() * (1.0 - 2.0 * f64::from(k) / f64::from(steps - 1))).exp())
}

#[test]
fn modes_along_x_and_along_y_cross_and_keep_their_branches() {
    for steps in [2, 6, 100] {
        let (modes, tracked): (Vec<_>, Vec<_>) = ratios(steps).map(|ratio| in_plane(ratio, 1e-9)).unzip();
        let branches = track(&tracked);
        for (modes, branches) in modes.iter().zip(&branches) {
            for (mode, branch) in modes.iter().zip(branches) {
                // The mode along x is the lower one at first.
                let along_x = mode.shape[0].abs() > mode.shape[1].abs();
                assert_eq!(*branch, usize::from(!along_x), "{steps} steps, {} Hz", mode.frequency_hz);
            }
        }
        assert_eq!(branches.last().unwrap(), &[1, 0], "{steps} steps");
    }
}

#[test]
fn coupled_modes_veer_where_the_steps_are_finer_than_the_range_and_cross_where_they_are_wider() {
    // k_x − k_y is (ratio − 1) times the stiffness of a pair, the coupling is half of `coupling` times it: each mode
    // turns from x to y while the ratio passes 1 ± `coupling`.
    let last = |steps, coupling| {
        let tracked: Vec<_> = ratios(steps).map(|ratio| in_plane(ratio, coupling).1).collect();
        track(&tracked).pop().unwrap()
    };
    assert_eq!(last(100, 0.05), [0, 1]);
    assert_eq!(last(4, 0.01), [1, 0]);
}

//! Point mass on eight strings.

use super::reference::{Cube, CubeRow, Published, library};
use super::section::WRONG;
use super::{Bound, Case, Comparison, Declared, Level, NegativeControl, reference, slug};
use anyhow::Result;
use funicular::cable::CableModel;
use funicular::catenary::Rope;
use funicular::catenary::space::HangingCable;
use funicular::dynamics::{Dynamics, Linearisation};
use funicular::math::Vec3;
use funicular::modes;
use funicular::robot::Pose;
use funicular::statics::{CableState, Equilibrium, Stability, StaticModel};
use std::f64::consts::TAU;

pub(super) const SECTION: Declared = Declared {
    id: "cube",
    title: "A point mass on eight strings",
    note: "Eight straight cables and 30 kg in the middle of a cube of 2.5 m, every frequency with its \
           multiplicity. The reference includes axial waves, which the model shallow-dynamic leaves out: the \
           frequency of a mode that stretches the cables is too high by up to (ω l √(m/EA))²/6.",
    rows: || rows(&reference::published()?, [1.0; 2]),
    controls: &[
        NegativeControl {
            id: "mass",
            wrong: "mass per length of the ropes 1 % too large",
            proves: "the mass of a vibrating string",
            rows: || rows(&reference::published()?, [WRONG, 1.0]),
        },
        NegativeControl {
            id: "ea",
            wrong: "axial stiffness EA of the ropes 1 % too large",
            proves: "the stretch of the strings, and with it their tension",
            rows: || rows(&reference::published()?, [1.0, WRONG]),
        },
    ],
};

/// Comparisons with the mass and the stiffness of the ropes multiplied by factors.
fn rows(published: &Published, factors: [f64; 2]) -> Result<Vec<Comparison>> {
    let cube = &published.cube_point_mass;
    let mut rows = Vec::new();
    for model in &cube.rows {
        rows.extend(frequencies(cube, model, factors)?);
    }
    Ok(rows)
}

/// Linearisation at the middle of the cube, without sag, with the tensions that follow from the lengths.
fn held(cube: &Cube, model: &CubeRow, [mass, stiffness]: [f64; 2]) -> Result<Dynamics> {
    let (mut robot, _) = library("sap2000-8-cable-point-mass")?;
    robot.gravity_w = Vec3::zeros();
    for rope in robot.cables.iter_mut().map(|cable| &mut cable.material) {
        rope.mass_per_length *= mass;
        rope.axial_stiffness *= stiffness;
    }
    let pose = Pose::new(cube.position_m, [0.0; 3]);
    let mut cables = Vec::new();

    for (cable, unstrained_length) in robot.cables.iter().zip(model.unstrained_length_m) {
        let axial_stiffness = cable.material.axial_stiffness;
        let rope = Rope { unstrained_length, weight_per_length: 0.0, axial_stiffness };
        let exit_w = cable.anchor.exit_w(&pose.position_w);
        let hanging = HangingCable::new(pose.position_w, exit_w, Vec3::z(), rope)?;
        cables.push(CableState {
            attachment_w: pose.position_w,
            lever_w: Vec3::zeros(),
            anchor_w: exit_w,
            unstrained_length,
            force_on_platform_w: hanging.force_on_start_w(),
            tension_platform: hanging.catenary.tension_at_start(),
            tension_anchor: hanging.catenary.tension_at_end(),
            hanging: Some(hanging),
            drive: None,
            displacement_w: Vec3::zeros(),
        });
    }

    let rest = Equilibrium {
        pose,
        model: StaticModel::Spring,
        cables,
        residual: 0.0,
        iterations: 0,
        stability: Stability::Rigid,
    };
    let linearisation = Linearisation { cable_model: CableModel::ShallowDynamic, ..Default::default() };

    Ok(Dynamics::about(&robot, &rest, linearisation, cube.limit_hz)?)
}

fn frequencies(cube: &Cube, model: &CubeRow, factors: [f64; 2]) -> Result<Vec<Comparison>> {
    let dynamics = held(cube, model, factors)?;
    let found = modes::below(&dynamics, cube.limit_hz);
    let id = slug(&model.model);
    let case = |id: &str, name: &str| Case::new(Level::Program, &cube.source, id, name);
    let certified = if found.certified { found.modes.len() } else { 0 };
    let quantity = format!("modes below {} Hz", cube.limit_hz);
    let mut rows = vec![case(&id, &model.model).of("count", &quantity).count(model.frequencies_hz.len(), certified)];
    for (i, (mode, theirs)) in found.modes.iter().zip(&model.frequencies_hz).enumerate() {
        let axial = (TAU * theirs * cube.longest_cable_m).powi(2) * cube.mass_kg_per_m / cube.axial_stiffness_n;
        let (tolerance, bound) = if mode.platform_energy_fraction == 0.0 {
            (1e-9, Bound::Rounding)
        } else {
            (axial / 6.0, Bound::Model("axial inertia"))
        };
        let case = case(&format!("{id}/mode-{}", i + 1), &format!("{}, mode {}", model.model, i + 1));
        rows.push(case.of("frequency", "frequency [Hz]").relative(&[*theirs], &[mode.frequency_hz], tolerance, bound));
    }
    Ok(rows)
}

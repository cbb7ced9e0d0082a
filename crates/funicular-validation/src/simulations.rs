//! Large motion in time: histories of robots with sagging ropes that two methods without common code computed.

use super::reference::{HistoryCase, HistoryReference, HistorySample, library};
use super::section::WRONG;
use super::{Bound, Case, Comparison, Declared, Level, NegativeControl, reference, slug};
use anyhow::Result;
use funicular::math::{Mat3, Vec3};
use funicular::robot::{Damping, Robot};
use funicular::simulation::{ElementMesh, RobotSample, Simulation, SimulationEvent, SimulationSettings};
use funicular::statics::{self, StaticModel};

/// Mesh and tolerance whose errors are far below the differences between the two methods.
const FINE: (ElementMesh, f64) = (ElementMesh { elements: 6, degree: 10 }, 3e-10);
/// File of the library with the kind of robot of all cases; their numbers take the place of its own.
const ROBOT: &str = "yuan2014-4mm";

pub(super) const SECTION: Declared = Declared {
    id: "simulations",
    title: "Large motion in time, computed by two methods",
    note: "A payload is released, winches move, a load drops until all cables are slack. The listed numbers are \
           those of the last time; the difference is the largest of all times and cables over the bound that the \
           two methods leave at each time, so that 1 passes.",
    rows: || rows(&reference::histories()?),
    controls: &[
        NegativeControl {
            id: "ea",
            wrong: "axial stiffness EA of the ropes 1 % too large",
            proves: "the stretch of moving ropes",
            rows: || of_first(|of| of.cables.iter_mut().for_each(|cable| cable.axial_stiffness_n *= WRONG)),
        },
        NegativeControl {
            id: "mass",
            wrong: "mass of the platform 1 % too large",
            proves: "the inertia of the platform",
            rows: || {
                of_first(|of| {
                    of.platform.mass_before_kg *= WRONG;
                    of.platform.mass_after_kg *= WRONG;
                })
            },
        },
    ],
};

fn rows(reference: &HistoryReference) -> Result<Vec<Comparison>> {
    let mut rows = Vec::new();
    for of in &reference.cases {
        rows.extend(comparisons(&reference.about, of)?);
    }
    Ok(rows)
}

/// Comparisons of the first case with a change, until its first sample.
fn of_first(change: fn(&mut HistoryCase)) -> Result<Vec<Comparison>> {
    let mut reference = reference::histories()?;
    reference.cases.truncate(1);
    for of in &mut reference.cases {
        of.samples.truncate(2);
        of.slack = None;
        change(of);
    }
    rows(&reference)
}

fn robot_of(of: &HistoryCase) -> Result<(Robot, Vec<f64>)> {
    let (mut robot, _) = library(ROBOT)?;
    robot.gravity_w = Vec3::from(of.gravity_m_s2);
    robot.platform.mass = of.platform.mass_before_kg;
    robot.platform.inertia_p = Mat3::from_row_slice(&of.platform.inertia_kg_m2.concat());
    for (cable, of_cable) in robot.cables.iter_mut().zip(&of.cables) {
        cable.anchor.point_w = Vec3::from(of_cable.anchor_m);
        cable.attachment_p = Vec3::from(of_cable.attachment_m);
        let rope = &mut cable.material;
        (rope.axial_stiffness, rope.mass_per_length) = (of_cable.axial_stiffness_n, of_cable.mass_kg_per_m);
        (rope.damping, rope.stretch_loss.time) = (Damping::Viscous(of.cv_n_s_m2), of.tau_s);
    }
    let lengths = of.cables.iter().map(|cable| cable.unstrained_length_m).collect();
    Ok((robot, lengths))
}

fn events(of: &HistoryCase) -> Vec<SimulationEvent> {
    let lost = of.platform.mass_before_kg - of.platform.mass_after_kg;
    let release = (lost > 0.0).then_some(SimulationEvent::Release { time: 0.0, mass: lost, point_p: None });
    let ramp = of.length_ramps.as_ref().map(|ramps| {
        let [from, until, _] = ramps.t0_t1_dl[0];
        let changes = ramps.t0_t1_dl.iter().map(|[.., change]| *change).collect();
        SimulationEvent::Ramp { time: from, duration: until - from, changes }
    });
    release.into_iter().chain(ramp).collect()
}

fn comparisons(source: &str, of: &HistoryCase) -> Result<Vec<Comparison>> {
    let (robot, lengths) = robot_of(of)?;
    let rest = statics::forward(&robot, &lengths, StaticModel::Catenary, None)?;
    let settings = SimulationSettings { mesh: FINE.0, tolerance: FINE.1, ..SimulationSettings::default() };
    let end = of.samples.last().map_or(0.0, |sample| sample.t_s);
    let mut simulation = Simulation::new(&robot, &rest, &events(of), end, &settings)?;
    let found = of.samples.iter().map(|sample| simulation.at(sample.t_s)).collect::<Result<Vec<_>, _>>()?;

    let pairs = || of.samples.iter().zip(&found);
    let [moved, pulled] = [place_off, tension_off].map(|off| super::worst(pairs().map(|(a, b)| off(a, b))));
    let bound = Bound::Digits("agreement of the two methods");
    let case = Case::new(Level::Program, source, &slug(&of.id), &format!("{} ({})", of.id, of.about));
    let (Some(theirs), Some(ours)) = (of.samples.last(), found.last()) else { return Ok(Vec::new()) };
    let kind = super::DifferenceKind::Relative;
    let tensions: Vec<f64> = ours.cables.iter().map(|cable| cable.tension_platform).collect();
    let mut rows = vec![
        case.of("position", &format!("position at {end} s [m], over the bound")).numbers(3 * of.samples.len()).row(
            (&theirs.position_m, ours.pose.position_w.as_slice()),
            (moved, kind),
            1.0,
            bound,
        ),
        case.of("tensions", &format!("tensions at the platform at {end} s [N], over the bound"))
            .numbers(of.samples.len() * of.cables.len())
            .row((&theirs.tension_platform_n, &tensions), (pulled, kind), 1.0, bound),
    ];
    if let Some(slack) = &of.slack {
        let first: Vec<f64> = simulation.slack().iter().map(|cable| cable.first.unwrap_or(f64::NAN)).collect();
        let (theirs, digits) = (&slack.first_below_half_newton_s, slack.first_slack_bound_s);
        rows.push(case.of("slack", "first time of slack [s]").absolute(theirs, &first, digits, bound));
    }
    Ok(rows)
}

fn place_off(theirs: &HistorySample, ours: &RobotSample) -> f64 {
    (ours.pose.position_w - Vec3::from(theirs.position_m)).norm() / theirs.bound_position_m
}

fn tension_off(theirs: &HistorySample, ours: &RobotSample) -> f64 {
    let pairs = ours.cables.iter().zip(&theirs.tension_platform_n).zip(&theirs.bound_tension_n);
    super::worst(pairs.map(|((cable, tension), bound)| (cable.tension_platform - tension).abs() / bound))
}

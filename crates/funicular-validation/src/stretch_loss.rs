//! Loss of the stretch of ropes: damped modes of robots, and the stiffness of single ropes.

use super::reference::{ChangedRobot, LossyRobot, LossyRope, StretchLossReference, library_text};
use super::section::WRONG;
use super::{Bound, Case, Comparison, Declared, Level, NegativeControl, reference, slug};
use anyhow::{Context, Result, anyhow, bail};
use funicular::cable::{CableModel, EndStiffness, LocalAxes};
use funicular::dynamics::{Dynamics, Linearisation};
use funicular::modes::{self, damped, damped::DampedMode};
use funicular::robot::{Damping, Robot, State, StretchLoss, WinchMode};
use funicular::statics::{self, Equilibrium, StaticModel};
use std::f64::consts::TAU;

/// Range above the highest listed mode, over its frequency.
const MARGIN: f64 = 1.02;

pub(super) const SECTION: Declared = Declared {
    id: "stretch-loss",
    title: "Loss of the stretch of ropes, computed independently",
    note: "Damping ratios with a loss factor η of the axial stiffness, with η and the damping ratio ξ of the \
           ropes, and with a damping time τ (Kelvin and Voigt); shares of the stretch in the undamped modes; the \
           stiffness of single ropes. In the other program loss and inertia stand in one matrix; here the loss \
           acts on a few moments of the strain. Near a veering the lists are compared as sets.",
    rows: || rows(&reference::stretch_loss()?),
    controls: &[
        NegativeControl {
            id: "eta",
            wrong: "loss factor η of the stretch 1 % too large",
            proves: "the loss of the stretch",
            rows: || of_first(|of| of.eta *= WRONG, |of| of.eta *= WRONG),
        },
        NegativeControl {
            id: "tau",
            wrong: "damping time τ of the stretch 1 % too large",
            proves: "the viscous loss of the stretch",
            rows: || of_first(|of| of.tau_s *= WRONG, |of| of.tau_s *= WRONG),
        },
    ],
};

fn rows(reference: &StretchLossReference) -> Result<Vec<Comparison>> {
    let mut rows = Vec::new();
    for of in &reference.robots {
        rows.extend(of_robot(&reference.source, of)?);
    }
    for of in &reference.ropes {
        rows.extend(of_rope(&reference.source, of)?);
    }
    Ok(rows)
}

/// Comparisons of the first robot and of the first rope, with a change of each.
fn of_first(of_robot: fn(&mut LossyRobot), of_rope: fn(&mut LossyRope)) -> Result<Vec<Comparison>> {
    let mut reference = reference::stretch_loss()?;
    reference.robots.truncate(1);
    reference.ropes.truncate(1);
    reference.robots.iter_mut().for_each(of_robot);
    reference.ropes.iter_mut().for_each(of_rope);
    rows(&reference)
}

/// Robot of the library with the numbers of a case, its damping and its loss, at rest.
pub(super) fn at_rest(of: &ChangedRobot, xi: f64, loss: StretchLoss) -> Result<(Robot, Equilibrium)> {
    let mut robot = Robot::from_toml(library_text(&of.robot)?)?;
    robot.platform.mass = of.platform_mass_kg.unwrap_or(robot.platform.mass);
    for cable in &mut robot.cables {
        let rope = &mut cable.material;
        rope.axial_stiffness = of.axial_stiffness_n.unwrap_or(rope.axial_stiffness);
        rope.mass_per_length = of.mass_kg_per_m.unwrap_or(rope.mass_per_length);
        (rope.damping, rope.stretch_loss) = (Damping::Ratio(xi), loss);
    }
    let State::Lengths(own) = &robot.state else { bail!("{} gives no lengths", robot.name) };
    let lengths = of.unstrained_length_m.clone().unwrap_or_else(|| own.clone());
    let rest = statics::forward(&robot, &lengths, StaticModel::Catenary, None)?;
    Ok((robot, rest))
}

/// Undamped and damped modes up to a limit [Hz].
fn modes_of(
    of: &ChangedRobot,
    xi: f64,
    loss: StretchLoss,
    below_hz: f64,
) -> Result<(Vec<modes::Mode>, Vec<DampedMode>)> {
    let (robot, rest) = at_rest(of, xi, loss)?;
    let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), below_hz)?;
    let found = modes::below(&dynamics, below_hz);
    let partners = damped::damped_modes(&dynamics, &found);
    if !partners.certified {
        bail!("{}: the damped list is not certified", robot.name);
    }
    Ok((found.modes, partners.modes))
}

/// Value of the list that is nearest by a distance.
pub(super) fn nearest<T>(list: &[T], distance: impl Fn(&T) -> f64) -> Result<&T> {
    list.iter().min_by(|a, b| distance(a).total_cmp(&distance(b))).context("an empty list")
}

fn of_robot(source: &str, of: &LossyRobot) -> Result<Vec<Comparison>> {
    let case = Case::new(Level::Program, source, &slug(&of.id), &of.id);
    let bound = Bound::Digits("accuracy of the other program");
    let below_hz = MARGIN * of.frequency_hz.iter().copied().fold(0.0, f64::max);
    let hysteretic = StretchLoss { factor: of.eta, time: 0.0 };

    // The undamped modes and their shares, then the damping ratios by the nearest damped modes.
    let (undamped, by_loss) = modes_of(&of.changed, 0.0, hysteretic, below_hz)?;
    let listed = of.frequency_hz.iter().map(|hz| nearest(&undamped, |mode| (mode.frequency_hz - hz).abs()));
    let listed: Vec<&modes::Mode> = listed.collect::<Result<_>>()?;
    let shares: Vec<f64> = listed.iter().map(|mode| mode.stretching_shares.iter().sum()).collect();
    let frequencies: Vec<f64> = listed.iter().map(|mode| mode.frequency_hz).collect();
    let first = &listed.first().ok_or_else(|| anyhow!("no mode"))?.stretching_shares;
    let with_frequencies = |list: &[DampedMode], hz: &[f64], zeta: &[f64]| -> Result<Vec<f64>> {
        let of_pair = |(hz, zeta): (&f64, &f64)| {
            let distance =
                |mode: &DampedMode| (mode.frequency_hz() / hz - 1.0).abs() + (mode.damping_ratio() - zeta).abs();
            Ok(nearest(list, distance)?.damping_ratio())
        };
        hz.iter().zip(zeta).map(of_pair).collect()
    };
    let ratios = with_frequencies(&by_loss, &of.frequency_eta_hz, &of.zeta_eta)?;
    let (_, with_xi) = modes_of(&of.changed, of.xi, hysteretic, below_hz)?;
    let both = with_frequencies(&with_xi, &of.frequency_eta_hz, &of.zeta_eta_xi)?;
    let (_, viscous) = modes_of(&of.changed, 0.0, StretchLoss { factor: 0.0, time: of.tau_s }, below_hz)?;
    let kelvin = with_frequencies(&viscous, &of.frequency_kelvin_voigt_hz, &of.zeta_kelvin_voigt)?;

    let accuracy = of.relative_accuracy;
    Ok(vec![
        case.of("frequencies", "frequencies [Hz]").relative(&of.frequency_hz, &frequencies, 1e-8, bound),
        case.of("shares", "shares of the stretch").relative(&of.stretching_share, &shares, accuracy, bound),
        case.of("shares-by-cable", "shares per cable, first mode").together(
            &of.share_per_cable_mode_1,
            first,
            accuracy,
            bound,
        ),
        case.of("damping-eta", "damping ratios with η").relative(&of.zeta_eta, &ratios, accuracy, bound),
        case.of("damping-eta-xi", "damping ratios with η and ξ").relative(&of.zeta_eta_xi, &both, accuracy, bound),
        case.of("damping-tau", "damping ratios with τ").relative(&of.zeta_kelvin_voigt, &kelvin, accuracy, bound),
    ])
}

fn of_rope(source: &str, of: &LossyRope) -> Result<Vec<Comparison>> {
    let hysteretic = StretchLoss { factor: of.eta, time: 0.0 };
    let omega = of.frequency_hz * TAU;
    let stiffness = |model: CableModel, xi: f64, loss: StretchLoss, omega: f64| -> Result<Vec<f64>> {
        let (robot, rest) = at_rest(&of.changed, xi, loss)?;
        let i = of.cable - 1;
        let up_to_hz = MARGIN * of.frequency_hz;
        let found = EndStiffness::new(&robot, i, &rest.cables[i], model, false, WinchMode::AsGiven, up_to_hz)?;
        let EndStiffness::Dynamic(cable) = found else { bail!("a rope with loss") };
        let (k, axes): (_, &LocalAxes) = (cable.damped(omega), cable.axes());
        let parts = [k.map(|z| z.re), k.map(|z| z.im)].map(|part| part.in_world(axes));
        Ok(parts.iter().flat_map(|part| part.iter().copied().collect::<Vec<f64>>()).collect())
    };

    let case = Case::new(Level::Program, source, &format!("rope/{}", slug(&of.id)), &format!("rope {}", of.id));
    let bound = Bound::Digits("digits of the table");
    let theirs = |k: &[[[f64; 3]; 3]; 2]| -> Vec<f64> { k.iter().flatten().flatten().copied().collect() };
    let dynamic = stiffness(CableModel::CatenaryDynamic, of.xi, hysteretic, omega)?;
    let viscous = StretchLoss { factor: 0.0, time: of.tau_s };
    let kelvin = stiffness(CableModel::CatenaryDynamic, 0.0, viscous, omega)?;
    let still = stiffness(CableModel::CatenaryStatic, 0.0, hysteretic, omega)?;
    Ok(vec![
        case.of("eta-xi", "stiffness with η and ξ [N/m]").together(&theirs(&of.k_eta_xi), &dynamic, 2e-9, bound),
        case.of("tau", "stiffness with τ [N/m]").together(&theirs(&of.k_kelvin_voigt_no_xi), &kelvin, 2e-9, bound),
        case.of("static-eta", "static stiffness with η [N/m]").together(&theirs(&of.k_static_eta), &still, 2e-9, bound),
    ])
}

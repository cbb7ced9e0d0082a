//! Damped modes, mode shapes and points on cables against a separate program; see the head of reference/damped.json.

use funicular::cable::CableModel;
use funicular::cable_motion::CableStations;
use funicular::dynamics::{Assembly, Dynamics, Linearisation};
use funicular::math::Vec3;
use funicular::modes::{self, Kind};
use funicular::response::{self, Port, Quantity, Signal};
use funicular::robot::{Damping, Robot, State};
use funicular::statics::{self, Equilibrium, StaticModel};
use serde_json::Value;
use std::sync::LazyLock;

static REFERENCE: LazyLock<Value> =
    LazyLock::new(|| serde_json::from_str(include_str!("../../reference/damped.json")).unwrap());

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value}"))
}

fn vector(value: &Value) -> Vec3 {
    Vec3::from_fn(|i, _| number(&value[i]))
}

/// The robot of this name among the independent ones, with the damping that `change` gives it.
fn at_rest(id: &str, change: impl Fn(&mut Robot)) -> (Robot, Equilibrium) {
    let all: Value = serde_json::from_str(include_str!("../../reference/independent.json")).unwrap();
    let case = all["cases"].as_array().unwrap().iter().find(|case| case["id"] == id).unwrap().clone();
    let mut robot = Robot::from_toml(case["toml"].as_str().unwrap()).unwrap();
    change(&mut robot);
    let State::Lengths(lengths) = &robot.state else { panic!("cases give lengths") };
    let rest = statics::forward(&robot, lengths, StaticModel::Catenary, None).unwrap();
    (robot, rest)
}

const EXACT: Linearisation =
    Linearisation { cable_model: CableModel::Exact, assembly: Assembly::Consistent, in_plane_only: false };

/// Gives a robot the damping of a case.
fn damp(robot: &mut Robot, case: &Value) {
    for cable in &mut robot.cables {
        let of = &case["cable_damping"][cable.name.as_str()];
        cable.material.damping = match of.get("damping_ratio") {
            Some(xi) => Damping::Ratio(number(xi)),
            None => Damping::Viscous(number(&of["viscous_damping_n_s_m2"])),
        };
    }
    if let Some(platform) = case["platform_damping"].as_object() {
        robot.platform.translational_damping_p = vector(&platform["translation_n_s_m"]);
        robot.platform.rotational_damping_p = vector(&platform["rotation_n_m_s_rad"]);
    }
}

#[test]
fn every_undamped_mode_has_its_damped_partner() {
    for case in REFERENCE["damped_modes"].as_array().unwrap() {
        let (robot, rest) = at_rest(case["robot"].as_str().unwrap(), |robot| damp(robot, case));
        let limit = number(&case["below_hz"]);
        let dynamics = Dynamics::about(&robot, &rest, EXACT, limit).unwrap();
        let undamped = modes::below(&dynamics, limit);
        let damped = modes::damped::of(&dynamics, &undamped);
        assert!(damped.certified, "{}", case["case"]);
        if case["case"] == "a" {
            let first_order = damped
                .modes
                .iter()
                .zip(&undamped.modes)
                .map(|(of, mode)| mode.damping_ratio / of.damping_ratio() - 1.0);
            let off = first_order.fold(0.0_f64, |most, gap| most.max(gap.abs()));
            assert!((off - 0.0019).abs() < 0.0001, "as docs/theory.md has it, section 12: {off}");
        }
        let mut ours: Vec<(f64, f64)> =
            damped.modes.iter().map(|mode| (mode.ringing_hz(), mode.frequency_hz() * mode.damping_ratio())).collect();
        ours.sort_by(|a, b| a.0.total_cmp(&b.0));
        let theirs = case["modes"].as_array().unwrap();
        assert_eq!(ours.len(), theirs.len(), "{}", case["case"]);
        let mut left: Vec<(f64, f64)> =
            theirs.iter().map(|mode| (number(&mode["re_hz"]), number(&mode["im_hz"]))).collect();
        for (re, im) in ours {
            // The nearest that is left: equal ringing frequencies may come in any order.
            let gap = |other: &(f64, f64)| (re - other.0).hypot(im - other.1) / re;
            let nearest = (0..left.len()).min_by(|&i, &j| gap(&left[i]).total_cmp(&gap(&left[j]))).unwrap();
            let (distance, of_damping) = (gap(&left[nearest]), (im / left[nearest].1 - 1.0).abs());
            assert!(distance < 1e-11, "{} at {re} Hz: {distance:e}", case["case"]);
            assert!(of_damping < 1e-8, "{} at {re} Hz: damping off by {of_damping:e}", case["case"]);
            left.swap_remove(nearest);
        }
    }
}

/// A signal of the reference, at the platform's origin or on a cable.
fn signal(end: &Value, robot: &Robot) -> Signal {
    let direction_w = vector(&end["direction_world"]);
    match end.get("cable") {
        Some(name) => {
            let cable = robot.cables.iter().position(|cable| cable.name == name.as_str().unwrap()).unwrap();
            Signal::OnCable { cable, fraction: number(&end["fraction"]), direction_w }
        }
        None => Signal::Along { direction_w, point_p: Vec3::zeros() },
    }
}

#[test]
fn a_force_and_a_motion_may_be_anywhere_on_platform_and_cables() {
    for case in REFERENCE["point_frf"].as_array().unwrap() {
        let (robot, rest) = at_rest(case["robot"].as_str().unwrap(), |_| {});
        let frequencies: Vec<f64> = case["frequency_hz"].as_array().unwrap().iter().map(number).collect();
        let dynamics = Dynamics::about(&robot, &rest, EXACT, 20.0).unwrap();
        for pair in case["pairs"].as_array().unwrap() {
            let (from, to) = (&pair["force"], &pair["displacement"]);
            let signals = [from, to].map(|end| signal(end, &robot));
            let ports = Port::all(&robot, &rest, &dynamics, &signals, true).unwrap();
            let (input, output) = (&ports[0], &ports[1]);
            let ours = response::between(&dynamics, &frequencies, input, output, Quantity::Displacement).unwrap();
            for (k, value) in ours.iter().enumerate() {
                let (re, im) = (number(&pair["real"][k]), number(&pair["imag"][k]));
                let gap = (value.re - re).hypot(value.im - im) / re.hypot(im);
                assert!(gap < 1e-8, "{} {from} → {to} at {} Hz: {gap:e}", case["robot"], frequencies[k]);
            }
        }
    }
}

#[test]
fn shapes_energies_and_modal_masses_are_those_of_the_whole_pencil() {
    for case in REFERENCE["shapes"].as_array().unwrap() {
        let (robot, rest) = at_rest(case["robot"].as_str().unwrap(), |_| {});
        let limit = number(&case["below_hz"]);
        let dynamics = Dynamics::about(&robot, &rest, EXACT, limit).unwrap();
        let found = modes::below(&dynamics, limit);
        let fractions: Vec<f64> = case["fractions"].as_array().unwrap().iter().map(number).collect();
        for theirs in case["modes"].as_array().unwrap() {
            let index = theirs["index"].as_u64().unwrap() as usize;
            let mode = &found.modes[index];
            let context = format!("{} mode {index}", case["robot"]);
            assert!((mode.frequency_hz / number(&theirs["frequency_hz"]) - 1.0).abs() < 1e-11, "{context}");
            let energies = &theirs["kinetic_energy_fraction"];
            let close = |a: f64, b: f64, bound: f64| (a - b).abs() < bound;
            // Eigenvectors are known to the precision of the frequency over the gap to the next one.
            let bound = 1e-9 + 1e-12 / number(&theirs["relative_gap_to_neighbour"]);
            assert!(close(mode.platform_energy_fraction, number(&energies["platform"]), bound), "{context}");
            for (cable, ours) in robot.cables.iter().zip(&mode.cable_energy_fractions) {
                assert!(close(*ours, number(&energies[cable.name.as_str()]), bound), "{context}, cable {}", cable.name);
            }
            let at_rest = theirs["platform_at_rest"].as_bool().unwrap();
            if at_rest {
                assert!(mode.kind == Kind::Cable && mode.shape.iter().all(|x| *x == 0.0), "{context}");
            } else {
                let mass = number(&theirs["modal_mass_kg"]);
                assert!((mode.modal_mass / mass - 1.0).abs() < 10.0 * bound, "{context}: {} {mass}", mode.modal_mass);
            }
            // Displacements for unit modal mass, one sign for all cables of the mode.
            let (mut ours, mut expected) = (Vec::new(), Vec::new());
            for (i, cable) in robot.cables.iter().enumerate() {
                let stations = CableStations::new(&robot, &rest, &dynamics, i, &fractions, false).unwrap();
                let axes = stations.axes;
                for (k, [e, n, b]) in stations.in_mode(&dynamics, mode).into_iter().enumerate() {
                    let moved = (axes.e * e + axes.n * n + axes.b * b) / mode.modal_mass.sqrt();
                    ours.extend(moved.iter().copied());
                    expected.extend(vector(&theirs["cable_displacement_m"][cable.name.as_str()][k]).iter().copied());
                }
            }
            let size = expected.iter().fold(0.0_f64, |size, x| size.max(x.abs()));
            let off = |sign: f64| ours.iter().zip(&expected).map(|(a, b)| (sign * a - b).abs()).fold(0.0, f64::max);
            let off = off(1.0).min(off(-1.0)) / size;
            // Cables are resolved until their frequencies are known to 1e-11; an error of shape enters those squared.
            assert!(off < bound.max(1e-11_f64.sqrt()), "{context}: cable shapes off by {off:e}");
        }
    }
}

#[test]
fn a_force_on_a_cable_that_the_model_does_not_know_is_refused() {
    let (robot, rest) = at_rest("insa-4mm-10.55kg", |_| {});
    let closed = Linearisation { cable_model: CableModel::ClosedForm, ..EXACT };
    let dynamics = Dynamics::about(&robot, &rest, closed, 5.0).unwrap();
    let refused = CableStations::new(&robot, &rest, &dynamics, 0, &[0.5], false).unwrap_err();
    assert!(refused.to_string().contains("needs the model `exact`"), "{refused}");
    let dynamics = Dynamics::about(&robot, &rest, EXACT, 5.0).unwrap();
    let middle = Signal::OnCable { cable: 0, fraction: 0.5, direction_w: Vec3::z() };
    let make = || Port::all(&robot, &rest, &dynamics, &[middle], true).unwrap().remove(0);
    let (one, apart) = (make(), make());
    let between = |a, b| response::between(&dynamics, &[1.0], a, b, Quantity::Displacement);
    assert!(between(&one, &one).is_ok());
    assert_eq!(between(&one, &apart).unwrap_err(), response::ResponseError::SameCable);
}

#[test]
fn the_closed_form_has_a_damped_partner_for_every_mode_too() {
    for id in ["insa-4mm-10.55kg", "symmetric8"] {
        let (robot, rest) = at_rest(id, |robot| {
            for cable in &mut robot.cables {
                cable.material.damping = Damping::Ratio(0.01);
            }
        });
        let closed = Linearisation { cable_model: CableModel::ClosedForm, ..EXACT };
        let dynamics = Dynamics::about(&robot, &rest, closed, 12.0).unwrap();
        let undamped = modes::below(&dynamics, 12.0);
        let damped = modes::damped::of(&dynamics, &undamped);
        assert!(damped.certified && damped.modes.len() == undamped.modes.len(), "{id}");
        for (of, mode) in damped.modes.iter().zip(&undamped.modes) {
            // First order in ξ, so off by some ξ: neighbours within ξ f of each other share more.
            let first_order = mode.damping_ratio;
            assert!((of.damping_ratio() / first_order - 1.0).abs() < 0.1, "{id} {}: {first_order}", mode.frequency_hz);
        }
    }
}

#[test]
fn strong_damping_is_told_and_not_lost() {
    // Viscous, beyond critical for the lowest modes of the cables: 2 m ω is 0.9 N s/m² at 1 Hz.
    let (robot, rest) = at_rest("insa-4mm-10.55kg", |robot| {
        for cable in &mut robot.cables {
            cable.material.damping = Damping::Viscous(3.0);
        }
    });
    let dynamics = Dynamics::about(&robot, &rest, EXACT, 6.0).unwrap();
    let undamped = modes::below(&dynamics, 6.0);
    let damped = modes::damped::of(&dynamics, &undamped);
    assert_eq!(damped.modes.len(), undamped.modes.len());
    assert!(undamped.certified && damped.overdamped > 0 && !damped.certified);
    // Strong, but all ring.
    let (robot, rest) = at_rest("insa-4mm-10.55kg", |robot| {
        for cable in &mut robot.cables {
            cable.material.damping = Damping::Ratio(0.1);
        }
    });
    let dynamics = Dynamics::about(&robot, &rest, EXACT, 6.0).unwrap();
    let undamped = modes::below(&dynamics, 6.0);
    let damped = modes::damped::of(&dynamics, &undamped);
    let mut zeros: Vec<(f64, f64)> = damped.modes.iter().map(|m| (m.omega.re, m.omega.im)).collect();
    zeros.sort_by(|a, b| a.0.total_cmp(&b.0));
    assert!(zeros.windows(2).all(|pair| (pair[1].0 - pair[0].0).hypot(pair[1].1 - pair[0].1) > 1e-6 * pair[0].0));
}

#[test]
fn what_a_mode_adds_to_a_response_is_its_residue() {
    // Beside a natural frequency, undamped, (ω_n² − ω²) X tends to the product of what both ports see, over the modal
    // mass; also where a cable's pole lies so near that its amplitude is an unknown of its own.
    let (robot, rest) = at_rest("insa-4mm-10.55kg", |robot| {
        for cable in &mut robot.cables {
            cable.material.damping = Damping::Ratio(0.0);
        }
    });
    let dynamics = Dynamics::about(&robot, &rest, EXACT, 12.0).unwrap();
    let found = modes::below(&dynamics, 10.0);
    let z = Signal::Along { direction_w: Vec3::z(), point_p: Vec3::zeros() };
    let on = |cable, fraction, direction_w| Signal::OnCable { cable, fraction, direction_w };
    let pairs = [
        [z, z],
        [z, on(2, 0.37, Vec3::x())],
        [on(2, 0.8, Vec3::y()), on(4, 0.25, Vec3::z())],
        [on(2, 0.8, Vec3::y()), on(2, 0.37, Vec3::x())],
    ];
    let pairs = pairs.map(|signals| {
        let mut ports = Port::all(&robot, &rest, &dynamics, &signals, true).unwrap();
        (ports.remove(0), ports.remove(0))
    });
    let residue = |(input, output): &(Port, Port), mode: &modes::Mode| {
        input.in_mode(&dynamics, mode) * output.in_mode(&dynamics, mode) / mode.modal_mass
    };
    let largest = pairs.each_ref().map(|pair| found.modes.iter().map(|m| residue(pair, m).abs()).fold(0.0, f64::max));
    let mut beside_poles = 0;
    for (i, mode) in found.modes.iter().enumerate() {
        let gap = |j: usize| found.modes.get(j).map_or(1.0, |m| (m.frequency_hz / mode.frequency_hz - 1.0).abs());
        let gap = gap(i + 1).min(if i > 0 { gap(i - 1) } else { 1.0 });
        let pole = dynamics.clamped_frequencies_below(75.0).into_iter().map(|(pole, _)| pole / std::f64::consts::TAU);
        let to_pole = pole.map(|pole| (pole / mode.frequency_hz - 1.0).abs()).fold(1.0, f64::min);
        if gap < 1e-4 {
            continue;
        }
        beside_poles += usize::from(to_pole < 4e-4);
        let beside = mode.frequency_hz * (1.0 + 1e-5 * gap);
        let square = |hz: f64| (hz * std::f64::consts::TAU).powi(2);
        let distance = square(mode.frequency_hz) - square(beside);
        for (pair, largest) in pairs.iter().zip(largest) {
            let response =
                response::between(&dynamics, &[beside], &pair.0, &pair.1, Quantity::Displacement).unwrap()[0];
            let residue = residue(pair, mode);
            // A neighbour at `gap` adds 1e-5 of its own.
            let off = (response.re * distance - residue).abs();
            assert!(off < 1e-3 * residue.abs() + 3e-5 * largest, "mode {i}: {off:e} of {residue}");
        }
    }
    assert!(beside_poles > 3, "{beside_poles} modes lie beside a pole");
}

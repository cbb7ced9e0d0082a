//! Damped partners of the modes: none missing, none false, and of first order if damping is weak.

use crate::library::{at_rest, independent_robot};
use funicular::cable::CableModel;
use funicular::dynamics::{Assembly, Dynamics, Linearisation};
use funicular::math::{Complex, DMat, Vec3};
use funicular::modes;
use funicular::reduced_model::{DampingAt, RequestedModel, reduce};
use funicular::response::{Quantity, Signal};
use funicular::robot::{Damping, Robot, StretchLoss, WinchMode};
use funicular::statics::{self, Equilibrium, StaticModel};

/// Robot of reference/independent.json with a change of its damping, and its equilibrium.
fn changed(id: &str, change: impl Fn(&mut Robot)) -> (Robot, Equilibrium) {
    let mut robot = independent_robot(id);
    change(&mut robot);
    let rest = at_rest(&robot);
    (robot, rest)
}

const CATENARY_DYNAMIC: Linearisation = Linearisation {
    cable_model: CableModel::CatenaryDynamic,
    assembly: Assembly::Consistent,
    in_plane_only: false,
    winches: WinchMode::AsGiven,
};

#[test]
fn damping_to_first_order_is_off_by_a_few_thousandths() {
    let (robot, rest) = changed("insa-4mm-10.55kg", |_| {});
    let dynamics = Dynamics::about(&robot, &rest, CATENARY_DYNAMIC, 10.0).unwrap();
    let undamped = modes::below(&dynamics, 10.0);
    let damped = modes::damped::damped_modes(&dynamics, &undamped);
    assert!(damped.certified && damped.modes.len() == undamped.modes.len());
    let first_order =
        damped.modes.iter().zip(&undamped.modes).map(|(of, mode)| mode.damping_ratio / of.damping_ratio() - 1.0);
    let off = first_order.fold(0.0_f64, |max, gap| max.max(gap.abs()));
    assert!((off - 0.0019).abs() < 0.0001, "as docs/theory.md has it, section 12: {off}");
}

#[test]
fn the_shallow_dynamic_model_has_a_damped_partner_for_every_mode_too() {
    for id in ["insa-4mm-10.55kg", "symmetric8"] {
        let (robot, rest) = changed(id, |robot| {
            for cable in &mut robot.cables {
                cable.material.damping = Damping::Ratio(0.01);
            }
        });
        let shallow = Linearisation { cable_model: CableModel::ShallowDynamic, ..CATENARY_DYNAMIC };
        let dynamics = Dynamics::about(&robot, &rest, shallow, 12.0).unwrap();
        let undamped = modes::below(&dynamics, 12.0);
        let damped = modes::damped::damped_modes(&dynamics, &undamped);
        assert!(damped.certified && damped.modes.len() == undamped.modes.len(), "{id}");
        for (of, mode) in damped.modes.iter().zip(&undamped.modes) {
            // First order in ξ, with an error of some ξ; neighbours within ξ f of each other have a larger error.
            let first_order = mode.damping_ratio;
            assert!((of.damping_ratio() / first_order - 1.0).abs() < 0.1, "{id} {}: {first_order}", mode.frequency_hz);
        }
    }
}

#[test]
fn strong_damping_is_told_and_not_lost() {
    // Viscous damping above the critical one of the cables' lowest modes: 2 m ω is 0.9 N s/m² at 1 Hz.
    let (robot, rest) = changed("insa-4mm-10.55kg", |robot| {
        for cable in &mut robot.cables {
            cable.material.damping = Damping::Viscous(3.0);
        }
    });
    let dynamics = Dynamics::about(&robot, &rest, CATENARY_DYNAMIC, 6.0).unwrap();
    let undamped = modes::below(&dynamics, 6.0);
    let damped = modes::damped::damped_modes(&dynamics, &undamped);
    assert_eq!(damped.modes.len(), undamped.modes.len());
    assert!(undamped.certified && damped.overdamped > 0 && !damped.certified);
    // Strong damping, below the critical one for all modes.
    let (robot, rest) = changed("insa-4mm-10.55kg", |robot| {
        for cable in &mut robot.cables {
            cable.material.damping = Damping::Ratio(0.1);
        }
    });
    let dynamics = Dynamics::about(&robot, &rest, CATENARY_DYNAMIC, 6.0).unwrap();
    let undamped = modes::below(&dynamics, 6.0);
    let damped = modes::damped::damped_modes(&dynamics, &undamped);
    let mut zeros: Vec<(f64, f64)> = damped.modes.iter().map(|m| (m.omega.re, m.omega.im)).collect();
    zeros.sort_by(|a, b| a.0.total_cmp(&b.0));
    assert!(zeros.windows(2).all(|pair| (pair[1].0 - pair[0].0).hypot(pair[1].1 - pair[0].1) > 1e-6 * pair[0].0));
}

/// CoGiRo with a loss of its stretch.
fn cogiro_with(loss: StretchLoss) -> (Robot, Equilibrium) {
    let mut robot = Robot::from_toml(funicular_robots::COGIRO).unwrap();
    for cable in &mut robot.cables {
        cable.material.damping = Damping::Viscous(0.02);
        cable.material.stretch_loss = loss;
    }
    let rest = statics::solve(&robot, StaticModel::Catenary, None).unwrap().equilibrium;
    (robot, rest)
}

/// Which damped mode belongs to an undamped one does not depend on the limit of the list.
#[test]
fn pairs_do_not_depend_on_the_limit() {
    for factor in [0.02, 0.07, 0.2, 0.4] {
        let (robot, rest) = cogiro_with(StretchLoss { factor, time: 0.0 });
        let lists = [8.2, 9.0, 10.0, 13.0].map(|below_hz| {
            let dynamics = Dynamics::about(&robot, &rest, CATENARY_DYNAMIC, below_hz).unwrap();
            modes::damped::damped_modes(&dynamics, &modes::below(&dynamics, below_hz))
        });
        for list in &lists[1..] {
            for (k, (of, first)) in list.modes.iter().zip(&lists[0].modes).enumerate() {
                if list.unclear.contains(&k) || lists[0].unclear.contains(&k) {
                    continue;
                }
                let gap = (of.omega - first.omega).norm() / first.omega.norm();
                assert!(gap < 1e-6, "{factor}, mode {k}: {:?} {:?}", of.omega, first.omega);
            }
        }
        let clear = lists[0].modes.len() - lists[0].unclear.len();
        assert!(clear >= lists[0].modes.len() - 4, "{factor}: {:?}", lists[0].unclear);
    }
}

/// Pairs by the complete matrices with growing viscous losses, whose eigenvalues are followed in many short steps.
#[test]
fn pairs_are_those_of_matrices_whose_losses_grow() {
    let below_hz = 8.2;
    let (robot, rest) = cogiro_with(StretchLoss { factor: 0.0, time: 2e-3 });
    let dynamics = Dynamics::about(&robot, &rest, CATENARY_DYNAMIC, below_hz).unwrap();
    let undamped = modes::below(&dynamics, below_hz);
    let damped = modes::damped::damped_modes(&dynamics, &undamped);
    assert!(damped.certified);

    let requested = RequestedModel { below_hz, tolerance: 0.0, damping_at: DampingAt::NaturalFrequencies };
    let signal = Signal::Along { direction_w: Vec3::z(), point_p: Vec3::zeros() };
    let outputs = [(signal, Quantity::Displacement)];
    let model = reduce(&robot, &rest, &dynamics, &[signal], &outputs, requested, &mut |_| true).unwrap();
    let n = model.mass.nrows();
    let inverse = model.mass.clone().cholesky().unwrap().inverse();
    let eigenvalues = |part: f64| -> Vec<Complex> {
        let mut state = DMat::zeros(2 * n, 2 * n);
        state.view_mut((0, n), (n, n)).copy_from(&DMat::identity(n, n));
        state.view_mut((n, 0), (n, n)).copy_from(&(-&inverse * &model.stiffness));
        state.view_mut((n, n), (n, n)).copy_from(&(-&inverse * &model.damping * part));
        let all = state.complex_eigenvalues();
        // λ = iω.
        all.iter().map(|lambda| -Complex::i() * lambda).filter(|omega| omega.re > 0.0).collect()
    };
    let steps = 60;
    let mut followed: Vec<Complex> =
        undamped.modes.iter().map(|mode| Complex::from(mode.frequency_hz * std::f64::consts::TAU)).collect();
    let mut slopes = vec![Complex::new(0.0, 0.0); followed.len()];
    for step in 1..=steps {
        let all = eigenvalues(f64::from(step) / f64::from(steps));
        for (omega, slope) in followed.iter_mut().zip(&mut slopes) {
            let meant = *omega + *slope;
            let nearest = all.iter().min_by(|a, b| (**a - meant).norm().total_cmp(&(**b - meant).norm())).unwrap();
            *slope = if step > 1 { nearest - *omega } else { 0.5 * (nearest - *omega) };
            *omega = *nearest;
        }
    }
    let mut same = 0;
    for (k, (omega, of)) in followed.iter().zip(&damped.modes).enumerate() {
        if damped.unclear.contains(&k) {
            continue;
        }
        same += 1;
        let gap = (omega - of.omega).norm() / omega.norm();
        assert!(gap < 1e-4, "{} Hz: {omega} {}", undamped.modes[k].frequency_hz, of.omega);
    }
    assert!(same + 2 >= followed.len(), "{:?}", damped.unclear);
}

//! Damped partners of the modes: none missing, none false, and of first order if damping is weak.

use crate::library::{at_rest, independent_robot};
use funicular::cable::CableModel;
use funicular::dynamics::{Assembly, Dynamics, Linearisation};
use funicular::modes;
use funicular::robot::{Damping, Robot, WinchMode};
use funicular::statics::Equilibrium;

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

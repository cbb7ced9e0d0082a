//! Gradients with the shapes that a linearised robot has kept, against those with shapes computed again.

use funicular::dynamics::{Dynamics, Linearisation};
use funicular::gradient::{Gradients, Hold};
use funicular::modes;
use funicular::robot::Robot;
use funicular::statics::{self, StaticModel};

/// A robot of held cables, and one whose cables end at pulleys and winches.
#[test]
fn kept_shapes_give_the_same_gradients() {
    for text in [funicular_robots::YUAN2014_4MM, funicular_robots::COGIRO_WINCHES] {
        let robot = Robot::from_toml(text).unwrap();
        let rest = statics::solve(&robot, StaticModel::Catenary, None).unwrap().equilibrium;
        let gradients = Gradients::new(&robot, &rest, Hold::Lengths).unwrap();
        let (again, kept) = (
            Dynamics::about(&robot, &rest, Linearisation::default(), 6.0).unwrap(),
            Dynamics::for_gradients(&robot, &rest, Linearisation::default(), 6.0).unwrap(),
        );
        let modes = modes::below(&again, 6.0).modes;
        let [again, kept] = [&again, &kept].map(|dynamics| gradients.vibration(dynamics).unwrap());
        for mode in modes.iter().filter(|mode| mode.multiplicity == 1) {
            let (a, b) = (again.frequency(mode).unwrap(), kept.frequency(mode).unwrap());
            let difference = (a.dot(&a) + b.dot(&b) - 2.0 * a.dot(&b)).abs();
            // Rounding of the places of the points, in the square.
            assert!(difference <= 1e-12 * a.dot(&a), "{} Hz: {difference}", mode.frequency_hz);
        }
    }
}

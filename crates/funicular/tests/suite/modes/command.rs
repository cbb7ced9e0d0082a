//! Motion after commanded lengths against the exponential of complete matrices with the command as a polynomial,
//! shapers against their zeros and their known slopes, courses against each other.

use super::release::exponential;
use funicular::cable::catenary_dynamic::DriveSignal;
use funicular::dynamics::{Dynamics, Linearisation};
use funicular::math::{Complex, DMat, Vec3};
use funicular::modes::{self, CommandedMotions, Decay, LengthCommand, OmittedModes, damped};
use funicular::path::{Profile, Shaper, ShaperKind};
use funicular::reduced_model::{DampingAt, RequestedModel, SecondOrder, reduce};
use funicular::response::{Quantity, Signal};
use funicular::robot::{Cable, Damping, Robot, State, StretchLoss};
use funicular::statics::{self, CableState, Equilibrium, StaticModel, TensionRule};
use std::f64::consts::{PI, TAU};

const BELOW_HZ: f64 = 16.0;

/// Damping of the ropes per length [N s/m²].
const DAMPING: f64 = 0.05;

/// Step of the exact integration [s]; all times of the tests are multiples of it.
const STEP: f64 = 0.02;

/// Motion of the platform of CoGiRo in a second, or as a whole: translation and rotation vector [m, rad].
const MOTION: [[f64; 3]; 2] = [[0.4, -0.3, 0.2], [0.05, -0.04, 0.1]];

/// Rates or changes of the lengths with which the platform of a robot at rest moves by [`MOTION`].
fn rates_of(robot: &Robot, rest: &Equilibrium) -> Vec<f64> {
    const STEP: f64 = 1e-3;
    let lengths = |step: f64| {
        let [shift, turn] = MOTION.map(|part| Vec3::from(part) * step);
        let state = State::Pose(rest.pose.moved(&shift, &turn));
        let found = statics::solve_at(robot, &state, StaticModel::Catenary, &TensionRule::Lowest).unwrap();
        found.equilibrium.cables.into_iter().map(|cable| cable.unstrained_length)
    };
    lengths(STEP).zip(lengths(-STEP)).map(|(after, before)| (after - before) / (2.0 * STEP)).collect()
}

fn column(values: &[f64]) -> DMat {
    DMat::from_column_slice(values.len(), 1, values)
}

/// Robot whose losses matrices have exactly: rates of its lengths, its free motions at a point, and its complete
/// matrices.
struct CommandedRobot {
    rates: Vec<f64>,
    /// Length and mass of each cable [m, kg].
    ropes: Vec<[f64; 2]>,
    motions: CommandedMotions,
    model: SecondOrder,
}

impl CommandedRobot {
    fn of(mut robot: Robot) -> Self {
        for cable in &mut robot.cables {
            cable.material.damping = Damping::Viscous(DAMPING);
            cable.material.stretch_loss = StretchLoss { factor: 0.0, time: 6e-4 };
        }
        let rest = statics::solve(&robot, StaticModel::Catenary, None).unwrap().equilibrium;
        let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), BELOW_HZ).unwrap();
        let found = modes::below(&dynamics, BELOW_HZ);
        let damped = damped::damped_modes(&dynamics, &found);
        let point_p = Vec3::new(0.3, -0.2, 0.1);
        let arm_w = rest.pose.rot_wp * point_p;
        let motions = CommandedMotions::of(&dynamics, &found, &damped, &arm_w).unwrap();

        let requested =
            RequestedModel { below_hz: BELOW_HZ, tolerance: 0.0, damping_at: DampingAt::NaturalFrequencies };
        let drive = |cable: usize, signal: DriveSignal| Signal::Drive { cable, signal };
        let inputs: Vec<Signal> = (0..robot.cables.len()).map(|i| drive(i, DriveSignal::Length)).collect();
        let along = |direction_w: Vec3| (Signal::Along { direction_w, point_p }, Quantity::Displacement);
        let mut outputs = [Vec3::x(), Vec3::y(), Vec3::z()].map(along).to_vec();
        outputs.push((drive(1, DriveSignal::Tension), Quantity::Displacement));
        let model = reduce(&robot, &rest, &dynamics, &inputs, &outputs, requested, &mut |_| true).unwrap();
        let rope = |(cable, state): (&Cable, &CableState)| {
            [state.unstrained_length, cable.material.mass_per_length * state.unstrained_length]
        };
        let ropes = robot.cables.iter().zip(&rest.cables).map(rope).collect();
        Self { rates: rates_of(&robot, &rest), ropes, motions, model }
    }

    /// Generator of the state (motion, velocity, a cubic polynomial with its derivatives, which is the course of
    /// lengths that change by [`rates`](Self::rates)), and its exponential over a [`STEP`].
    fn generator(&self) -> [DMat; 2] {
        let (model, n) = (&self.model, self.model.mass.nrows());
        let inverse = model.mass.clone().cholesky().unwrap().inverse();
        let mut state = DMat::zeros(2 * n + 4, 2 * n + 4);
        state.view_mut((0, n), (n, n)).copy_from(&DMat::identity(n, n));
        state.view_mut((n, 0), (n, n)).copy_from(&(-&inverse * &model.stiffness));
        state.view_mut((n, n), (n, n)).copy_from(&(-&inverse * &model.damping));
        for (k, force) in self.forces().iter().enumerate() {
            state.view_mut((n, 2 * n + k), (n, 1)).copy_from(&(&inverse * force));
        }
        (0..3).for_each(|k| state[(2 * n + k, 2 * n + k + 1)] = 1.0);
        let forward = exponential(&state, STEP);
        [state, forward]
    }

    /// Forces per course of the lengths, its rate and its acceleration.
    fn forces(&self) -> [DMat; 3] {
        let model = &self.model;
        [&model.input, &model.input_rates[0], &model.input_rates[1]].map(|matrix| matrix * column(&self.rates))
    }

    /// Outputs at each of `times` for a course that is a cubic polynomial from each of its `pieces` on: time, value,
    /// and three derivatives there. The state at the first piece is that of a steady motion.
    fn integrated(&self, [state, forward]: &[DMat; 2], pieces: &[(f64, [f64; 4])], times: &[f64]) -> Vec<DMat> {
        let (model, n, forces) = (&self.model, self.model.mass.nrows(), self.forces());
        let [value, rate, ..] = pieces[0].1;
        let stiffness = model.stiffness.clone().lu();
        let steady = stiffness.solve(&(&forces[0] * rate)).unwrap();
        let place = stiffness.solve(&(&forces[0] * value + &forces[1] * rate - &model.damping * &steady)).unwrap();
        let mut now = DMat::zeros(2 * n + 4, 1);
        now.rows_mut(0, n).copy_from(&place);
        now.rows_mut(n, n).copy_from(&steady);

        let is_at = |a: f64, b: f64| (a - b).abs() < 0.1 * STEP;
        let (mut found, mut step) = (Vec::new(), 0);
        while found.len() < times.len() {
            let time = STEP * f64::from(step);
            if let Some((_, polynomial)) = pieces.iter().rev().find(|piece| is_at(piece.0, time)) {
                now.rows_mut(2 * n, 4).copy_from(&column(polynomial));
            }
            if is_at(times[found.len()], time) {
                found.push(self.outputs(&(state * &now), &now));
            }
            now = forward * now;
            step += 1;
        }
        found
    }

    fn outputs(&self, slope: &DMat, state: &DMat) -> DMat {
        let (model, n) = (&self.model, self.model.mass.nrows());
        let direct = |k: usize| &model.feedthrough[k] * column(&self.rates) * state[2 * n + k];
        &model.output * state.rows(0, n)
            + &model.output_rates[0] * state.rows(n, n)
            + &model.output_rates[1] * slope.rows(n, n)
            + direct(0)
            + direct(1)
            + direct(2)
    }

    /// Static outputs of lengths.
    fn still(&self, lengths: &[f64]) -> DMat {
        let moved = self.model.stiffness.clone().lu().solve(&(&self.model.input * column(lengths)));
        &self.model.output * moved.unwrap() + &self.model.feedthrough[0] * column(lengths)
    }

    /// Bound of the force that moves the ropes themselves at a speed and an acceleration of the course [N]: their
    /// damping and their mass, as if all of each rope moved like its length.
    fn of_ropes(&self, [speed, acceleration]: [f64; 2]) -> f64 {
        let of =
            |(rate, [length, mass]): (&f64, &[f64; 2])| rate.abs() * (DAMPING * length * speed + mass * acceleration);
        self.rates.iter().zip(&self.ropes).map(of).sum()
    }

    /// Compares the closed form with the matrices: three components of the point, and a tension. `fastest` are the
    /// highest speed and acceleration of the course.
    fn compare(&self, command: &LengthCommand, generator: &[DMat; 2], pieces: &[(f64, [f64; 4])], fastest: [f64; 2]) {
        let end = command.duration();
        let times: Vec<f64> = [0.24, 0.5, end, end + 0.08, end + 0.4, end + 3.0].to_vec();
        let expected = self.integrated(generator, pieces, &times);
        let (decay, point) = (self.motions.after(command), self.motions.beside_static(command, &times));
        let tensions = self.motions.tensions_beside_static(command, &times);
        let peak = point.iter().map(Vec3::norm).fold(0.0, f64::max);
        let peak_tension = tensions.iter().map(|of| of[1].abs()).fold(0.0, f64::max);
        assert!(peak > 1e-6 && peak_tension > 1e-3, "{peak} {peak_tension}");
        for (i, time) in times.iter().enumerate() {
            let scalar = pieces.iter().rev().find(|piece| piece.0 <= *time).map(|(from, [a, b, c, d])| {
                let t = time - from;
                a + t * (b + t * (c / 2.0 + t * d / 6.0))
            });
            let lengths: Vec<f64> = self.rates.iter().map(|rate| rate * scalar.unwrap()).collect();
            let gap = &expected[i] - self.still(&lengths);
            let gap = (Vec3::new(gap[0], gap[1], gap[2]), gap[3]);
            // The modes above the limit, which the sum has not, answer to the acceleration: 3e-4 of the peak.
            assert!((gap.0 - point[i]).norm() < 1e-3 * peak, "{time} s: {} {} of {peak}", gap.0, point[i]);
            // The force that moves the ropes themselves is not in the sum; after the end there is none.
            let limit = if *time < end { self.of_ropes(fastest) } else { 1e-4 * peak_tension };
            assert!((gap.1 - tensions[i][1]).abs() < limit, "{time} s: {} {}, {limit}", gap.1, tensions[i][1]);
            if *time >= end {
                assert!((decay.at(time - end) - point[i]).norm() < 1e-11 * peak, "{time} s");
            }
            // In three seconds they have decayed.
            if *time > end + 2.0 {
                assert!((gap.0 - point[i]).norm() < 1e-6 * peak, "{time} s: {} {} of {peak}", gap.0, point[i]);
            }
        }
    }
}

/// Pieces of the integral of order `order` of boxes convolved, which is a cubic polynomial: corner, value and
/// derivatives.
fn pieces(boxes: &[f64], order: usize) -> Vec<(f64, [f64; 4])> {
    let area: f64 = boxes.iter().product();
    let mut corners: Vec<(f64, f64)> = vec![(0.0, 1.0 / area)];
    for duration in boxes {
        let later: Vec<(f64, f64)> = corners.iter().map(|(at, jump)| (at + duration, -jump)).collect();
        corners.extend(later);
    }
    corners.sort_by(|a, b| a.0.total_cmp(&b.0));
    // Between corners the highest derivative is constant.
    let (mut now, mut time, mut found) = ([0.0; 4], 0.0, Vec::new());
    for (at, jump) in corners {
        let t = at - time;
        let [a, b, c, d] = now;
        now = [a + t * (b + t * (c / 2.0 + t * d / 6.0)), b + t * (c + t * d / 2.0), c + t * d, d];
        now[order] += jump;
        time = at;
        found.push((at, now));
    }
    found
}

#[test]
fn moves_and_stops_are_those_of_the_complete_matrices() {
    let case = CommandedRobot::of(Robot::from_toml(funicular_robots::COGIRO).unwrap());
    let boxes = [0.5, 0.24, 0.1];
    let generator = case.generator();
    let moved = LengthCommand::Move { by: case.rates.clone(), profile: Profile::new(&boxes) };
    case.compare(&moved, &generator, &pieces(&boxes, 3), [1.0 / boxes[0], 1.0 / (boxes[0] * boxes[1])]);

    // A stop: the steady motion less the integral of the part of the speed that is lost.
    let stop = LengthCommand::Stop { rates: case.rates.clone(), profile: Profile::new(&boxes[..2]) };
    let lost = pieces(&boxes[..2], 3);
    let steady = lost.iter().map(|(at, [a, b, c, d])| (*at, [at - a, 1.0 - b, -c, -d])).collect::<Vec<_>>();
    case.compare(&stop, &generator, &steady, [1.0, 1.0 / boxes[0]]);
}

/// A change of one per cent in one rate is seen: the comparison above is not blind.
#[test]
fn a_rate_that_is_wrong_by_one_per_cent_is_seen() {
    let case = CommandedRobot::of(Robot::from_toml(funicular_robots::COGIRO).unwrap());
    let stop = |rates: &[f64]| {
        case.motions.after(&LengthCommand::Stop { rates: rates.to_vec(), profile: Profile::new(&[0.5, 0.24]) })
    };
    let mut wrong = case.rates.clone();
    wrong[2] *= 1.01;
    let [right, wrong] = [stop(&case.rates), stop(&wrong)].map(|decay| decay.at(0.0));
    assert!((right - wrong).norm() > 1e-3 * right.norm(), "{right} {wrong}");
}

#[test]
fn samples_of_a_course_are_the_course() {
    let case = CommandedRobot::of(Robot::from_toml(funicular_robots::COGIRO).unwrap());
    let (boxes, by) = ([0.5, 0.24, 0.1], case.rates.clone());
    let profile = Profile::new(&boxes);
    let moved = case.motions.after(&LengthCommand::Move { by: by.clone(), profile: profile.clone() });
    // Lines over a step h follow a vibration of ω to (ωh)²/12 of it: 25 Hz, 1 ms, 2e-3.
    let times: Vec<f64> = (0..=840).map(|i| f64::from(i) * 1e-3).collect();
    let lengths = times.iter().map(|t| by.iter().map(|by| by * profile.done(*t)).collect()).collect();
    let sampled = case.motions.after(&LengthCommand::Samples { times, lengths });
    for time in [0.0, 0.1, 0.7] {
        assert!((moved.at(time) - sampled.at(time)).norm() < 2.1e-3 * moved.envelope(time), "{time} s");
    }
}

/// Sum of the amplitudes.
fn size(decay: &Decay) -> f64 {
    decay.envelope(0.0)
}

#[test]
fn limits_of_stops_and_moves() {
    let case = CommandedRobot::of(Robot::from_toml(funicular_robots::COGIRO).unwrap());
    let stop = |boxes: &[f64]| {
        case.motions.after(&LengthCommand::Stop { rates: case.rates.clone(), profile: Profile::new(boxes) })
    };
    // A stop in no time, and in nearly none.
    let (sudden, short) = (stop(&[]), stop(&[1e-7, 1e-8]));
    assert!((sudden.at(0.1) - short.at(0.1)).norm() < 1e-5 * size(&sudden));
    // A slow command leaves nothing: two boxes that are ten times as long leave at most a hundredth of their bound.
    let [quick, slow, slower] = [1.0, 10.0, 100.0].map(|factor| size(&stop(&[0.31 * factor, 0.17 * factor])));
    assert!(slow < 0.1 * quick && slower < 0.011 * slow.max(0.01 * quick), "{quick} {slow} {slower}");
}

#[test]
fn a_shaper_cancels_its_mode_and_keeps_the_others_apart() {
    let case = CommandedRobot::of(Robot::from_toml(funicular_robots::COGIRO).unwrap());
    let plain = Profile::new(&[0.5, 0.24, 0.1]);
    let after = |profile: Profile| case.motions.after(&LengthCommand::Move { by: case.rates.clone(), profile });
    let without = after(plain.clone());
    let mut loud: Vec<usize> = (0..without.motions.len()).collect();
    loud.sort_by(|a, b| without.motions[*b].size().total_cmp(&without.motions[*a].size()));
    for kind in [ShaperKind::Zv, ShaperKind::Zvd] {
        let of = |k: usize| Shaper::of_mode(kind, without.motions[k].omega).unwrap();
        let both = of(loud[0]).convolved(&of(loud[1]));
        let shaped = after(plain.shaped(&both));
        for k in &loud[..2] {
            assert!(shaped.motions[*k].size() < 1e-9 * without.motions[*k].size(), "{kind:?} {k}");
        }
        assert!(size(&shaped) < 0.5 * size(&without));
        let sum: f64 = both.impulses.iter().map(|impulse| impulse.amplitude).sum();
        assert!((sum - 1.0).abs() < 1e-14);
    }
}

/// Without damping what is left at a frequency that is off by δ has a closed form, (46m).
#[test]
fn shapers_are_as_robust_as_their_closed_forms_say() {
    let omega = Complex::new(TAU * 1.7, 0.0);
    let vibration = 0.05;
    for delta in [-0.3, -0.1, 0.0, 0.05, 0.2_f64] {
        let sine = (0.5 * PI * delta).sin().abs();
        for (kind, expected) in [
            (ShaperKind::Zv, sine),
            (ShaperKind::Zvd, sine * sine),
            (ShaperKind::Ei(vibration), ((1.0 + vibration) * sine * sine - vibration).abs()),
        ] {
            let left = Shaper::of_mode(kind, omega).unwrap().left(omega * (1.0 + delta));
            assert!((left - expected).abs() < 1e-13, "{kind:?} {delta}: {left} {expected}");
        }
    }
    // With damping, zeros at the complex frequency; without K in the impulses 1 − K would be left.
    let damped = Complex::from_polar(TAU * 1.7, 0.05_f64.asin());
    assert!(Shaper::of_mode(ShaperKind::Zv, damped).unwrap().left(damped) < 1e-15);
    assert!(Shaper::of_mode(ShaperKind::Zvd, damped).unwrap().left(damped) < 1e-15);
    assert!(Shaper::of_mode(ShaperKind::Zv, Complex::new(0.0, 3.0)).is_none());
}

/// A box of one period takes all of a vibration but about its damping ratio, (1 − e^{−2πζ'})/2π in the mode's own ζ'.
#[test]
fn a_box_of_one_period_leaves_the_damping_ratio() {
    let case = CommandedRobot::of(Robot::from_toml(funicular_robots::COGIRO).unwrap());
    let after = |profile| case.motions.after(&LengthCommand::Move { by: case.rates.clone(), profile });
    let step = after(Profile::new(&[]));
    for (k, motion) in step.motions.iter().enumerate().take(4) {
        let shaped = after(Profile::new(&[TAU / motion.omega.re]));
        let ratio = shaped.motions[k].size() / motion.size();
        let zeta = motion.omega.im / motion.omega.norm();
        assert!((ratio / zeta - 1.0).abs() < 4.0 * zeta, "{ratio} {zeta}");
    }
}

#[test]
fn a_course_is_a_ramp_with_one_box_and_has_the_way_of_its_mean_time() {
    let ramp = Profile::new(&[2.0, 0.0]);
    assert!((ramp.done(0.5) - 0.25).abs() < 1e-15 && (ramp.remaining(0.5) - 0.5625).abs() < 1e-15);
    let smooth = Profile::new(&[1.2, 0.3, 0.1]);
    assert!((smooth.done(0.8) - 0.5).abs() < 1e-13 && (smooth.remaining(0.0) - 0.8).abs() < 1e-13);
    assert!((smooth.duration() - 1.6).abs() < 1e-15 && smooth.remaining(1.6) == 0.0 && smooth.done(-1.0) == 0.0);
}

/// The part of the modes above a limit in a stop stays within the bounds of a list that ends there, from the mass of
/// slow displacements that the listed modes leave: with a higher limit the bounds fall.
#[test]
fn modes_above_the_limit_stay_within_their_bounds() {
    let mut robot = Robot::from_toml(funicular_robots::COGIRO).unwrap();
    robot.cables.iter_mut().for_each(|cable| cable.material.damping = Damping::Ratio(1e-5));
    let rest = statics::solve(&robot, StaticModel::Catenary, None).unwrap().equilibrium;
    let rates = rates_of(&robot, &rest);
    let mut lossless = robot.clone();
    lossless.cables.iter_mut().for_each(|cable| cable.material.damping = Damping::Ratio(0.0));
    let arm_w = Vec3::new(0.3, -0.2, 0.1);
    let stretch: Vec<f64> = (robot.cables.iter().zip(&rest.cables))
        .map(|(cable, state)| cable.material.axial_stiffness / state.unstrained_length)
        .collect();

    for times in [&[][..], &[0.05], &[0.4, 0.1]] {
        let command = LengthCommand::Stop { rates: rates.clone(), profile: Profile::new(times) };
        let found = [4.5, 7.0, 10.0, 16.0, 24.0].map(|below_hz| {
            let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), below_hz).unwrap();
            let list = modes::below(&dynamics, below_hz);
            let damped = damped::damped_modes(&dynamics, &list);
            let decay = CommandedMotions::of(&dynamics, &list, &damped, &arm_w).unwrap().after(&command);
            let still = Dynamics::about(&lossless, &rest, Linearisation::default(), below_hz).unwrap();
            let omitted = OmittedModes::of(&still, &list, &arm_w, stretch.clone()).expect("a bound");
            (decay, omitted.bounds(&command))
        });
        let (last, _) = &found[found.len() - 1];
        for (decay, bounds) in &found[..found.len() - 1] {
            let gaps = (0..400).map(|i| {
                let time = f64::from(i) * 0.01;
                (decay.at(time) - last.at(time)).norm()
            });
            let gap = gaps.fold(0.0, f64::max);
            println!("{times:?}: {gap:e} of {:e} m, {:e} N", bounds.distance, bounds.mean_tensions[0]);
            assert!(gap <= bounds.distance * 1.001, "{times:?}: {gap:e} {:e}", bounds.distance);
        }
        assert!(found.windows(2).all(|pair| pair[1].1.distance <= pair[0].1.distance), "{times:?}");
        assert!(found[4].1.distance < 0.2 * found[0].1.distance, "{times:?}");
    }
}

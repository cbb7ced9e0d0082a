//! Frequencies chosen for a curve, and peaks that a grid misses, against dense grids.

use super::load;
use crate::random::any_robot;
use funicular::cable::CableModel;
use funicular::dynamics::{Dynamics, Linearisation};
use funicular::math::{Complex, Vec3, Vec6};
use funicular::modes::{self, Mode};
use funicular::response::adaptive::{Resolution, Resolved, resolve};
use funicular::response::missed_peaks::{MISSED, missed_peaks};
use funicular::response::{self, Measured, Port, Quantity, ResponseError, measured};
use funicular::robot::Damping;
use funicular::statics::{self, StaticModel};
use proptest::prelude::*;
use std::f64::consts::TAU;

/// Response of one output to one input.
struct Pair<'a> {
    dynamics: &'a Dynamics,
    input: Vec6,
    output: Vec6,
}

impl Pair<'_> {
    const QUANTITY: Quantity = Quantity::Acceleration;

    fn measured(&self, hz: &[f64]) -> Result<Vec<Vec<Measured>>, ResponseError> {
        measured(self.dynamics, hz, &[Port::Platform(self.input)], &[(Port::Platform(self.output), Self::QUANTITY)])
    }

    fn values(&self, hz: &[f64]) -> Vec<Complex> {
        response::frf(self.dynamics, hz, &self.input, &self.output, Self::QUANTITY).unwrap()
    }

    fn magnitudes(&self, hz: &[f64]) -> Vec<f64> {
        self.values(hz).iter().map(|value| value.norm()).collect()
    }

    fn resolved(&self, grid: &[f64], modes: &[Mode]) -> Resolved {
        resolve(grid, modes, Resolution::default(), |hz| self.measured(hz)).unwrap()
    }
}

fn even(from: f64, to: f64, count: usize) -> Vec<f64> {
    (0..count).map(|i| from + (to - from) * i as f64 / (count - 1) as f64).collect()
}

/// Compares a resolved curve with `dense` evaluations around every natural frequency and as many between the ends.
///
/// The places and widths of the resonances are those of the damped modes. The search itself knows them to first order
/// in the damping only, which is off by several half widths where little of the motion is in strongly damped cables.
fn check_curve(pair: &Pair<'_>, resolved: &Resolved, (from, to): (f64, f64), dense: usize) {
    let hz = &resolved.frequencies_hz;
    let found = resolved.peaks(0, 0.0);
    let damped = modes::damped::damped_modes(pair.dynamics, &modes::below(pair.dynamics, to));
    let resonances = damped.modes.iter().map(|mode| (mode.ringing_hz(), mode.omega.im / TAU));
    let resonances: Vec<(f64, f64)> = resonances.filter(|(hz, _)| (from..to).contains(hz)).collect();
    let narrowest = resonances.iter().map(|(_, width)| *width).fold(f64::INFINITY, f64::min);
    let mut all = even(from, to, dense);
    for (place, width) in resonances {
        all.extend(even((place - 8.0 * width).max(from), (place + 8.0 * width).min(to), dense));
    }
    all.sort_by(f64::total_cmp);
    all.dedup();
    let values = pair.values(&all);
    let is_above_rounding = |k: usize| {
        let row = &pair.measured(&all[k..=k]).unwrap()[0];
        row[0].value.norm() > 10.0 * row[0].floor
    };

    // Every peak of the dense grid is a peak of the result. A ripple that is lower than 0.2 dB is not resolved.
    let peaks = response::peaks(&all, &values, 0.2);
    for peak in &peaks {
        let k = all.partition_point(|f| *f < peak.frequency_hz).clamp(2, all.len() - 3);
        let step = (all[k + 2] - all[k - 2]) / 2.0;
        let near = found.iter().min_by(|p, q| {
            (p.frequency_hz - peak.frequency_hz).abs().total_cmp(&(q.frequency_hz - peak.frequency_hz).abs())
        });
        let near = near.unwrap_or_else(|| panic!("no peak at {} Hz", peak.frequency_hz));
        if is_above_rounding(k) {
            assert!((near.frequency_hz - peak.frequency_hz).abs() <= step, "{peak:?} is found as {near:?}");
            // A peak narrower than the grid is higher than the grid shows; below, its height is that of the response.
            assert!(near.magnitude > peak.magnitude * (1.0 - 1e-3), "{peak:?} is found as {near:?}");
        }
    }

    // A peak of the result is a value of the response, and a maximum: lower on both sides.
    for peak in &found {
        let height = pair.magnitudes(&[peak.frequency_hz])[0];
        assert!((peak.magnitude / height - 1.0).abs() < 1e-9, "{peak:?} {height}");
        let beside = pair.magnitudes(&[peak.frequency_hz - 0.02 * narrowest, peak.frequency_hz + 0.02 * narrowest]);
        assert!(beside.iter().all(|side| *side <= peak.magnitude * (1.0 + 1e-9)), "{peak:?} {beside:?}");
    }

    // Interpolation of the logarithm, down to rounding.
    let mut largest: f64 = 0.0;
    for (k, (at, value)) in all.iter().zip(&values).enumerate() {
        let next = hz.partition_point(|f| f < at).clamp(1, hz.len() - 1);
        let level = |k: usize| resolved.values[0][k].norm().ln();
        let fraction = (at - hz[next - 1]) / (hz[next] - hz[next - 1]);
        let line = level(next - 1) + fraction * (level(next) - level(next - 1));
        let error = (line - value.norm().ln()).abs();
        assert!(error < 0.01 || !is_above_rounding(k), "{error} at {at} Hz of {}..{}", hz[next - 1], hz[next]);
        largest = largest.max(error);
    }
    assert!(largest > 1e-4, "the comparison compares nothing");
}

/// Number of frequencies that any curve with straight lines over the logarithm and an error of 1 % needs: from each
/// frequency the line goes as far as the response stays beside it, at places many times as dense as those of the
/// result.
fn needed(pair: &Pair<'_>, resolved: &Resolved) -> usize {
    const BETWEEN: usize = 12;
    let pairs = resolved.frequencies_hz.windows(2);
    let hz: Vec<f64> = pairs.flat_map(|f| even(f[0], f[1], BETWEEN + 1)[..BETWEEN].to_vec()).collect();
    let rows = pair.measured(&hz).unwrap();
    let levels: Vec<f64> = rows.iter().map(|row| row[0].value.norm().max(row[0].floor).ln()).collect();

    let (mut count, mut from) = (1, 0);
    while from + 1 < hz.len() {
        let (mut lowest, mut highest) = (f64::NEG_INFINITY, f64::INFINITY);
        let mut to = from + 1;
        for next in from + 1..hz.len() {
            let (run, rise) = (hz[next] - hz[from], levels[next] - levels[from]);
            if !(lowest..=highest).contains(&(rise / run)) {
                break;
            }
            (lowest, highest) = (lowest.max((rise - 0.01) / run), highest.min((rise + 0.01) / run));
            to = next;
        }
        from = to;
        count += 1;
    }
    count
}

#[test]
fn peaks_and_curves_of_the_library_are_those_of_a_dense_grid() {
    for (text, from, to, dense) in [
        (funicular_robots::YUAN2014_4MM, 0.1, 5.0, 4_001),
        (funicular_robots::YUAN2014_8MM, 0.0, 2.0, 4_001),
        (funicular_robots::COGIRO, 3.0, 5.0, 20_001),
    ] {
        let (robot, rest) = load(text);
        for cable_model in [CableModel::CatenaryDynamic, CableModel::ShallowDynamic] {
            let linearisation = Linearisation { cable_model, ..Default::default() };
            let dynamics = Dynamics::about(&robot, &rest, linearisation, to).unwrap();
            let modes = modes::within(&dynamics, from, to);
            let along = |direction_w| response::along(&direction_w, &Vec3::new(0.1, 0.05, -0.1), &rest.pose);
            for (input, output) in [(Vec3::z(), Vec3::z()), (Vec3::x(), Vec3::y())] {
                let pair = Pair { dynamics: &dynamics, input: along(input), output: along(output) };
                let resolved = pair.resolved(&even(from, to, 100), &modes);
                assert_eq!(resolved.unresolved, 0);
                let count = resolved.frequencies_hz.len();
                assert!(count < 200 + 40 * modes.len(), "{count} frequencies for {} modes", modes.len());
                assert_eq!(resolved, pair.resolved(&even(from, to, 100), &modes), "deterministic");
                // To 0 Hz the logarithm of an accelerance has no bound.
                check_curve(&pair, &resolved, (from.max(0.01), to), dense);

                // The grid that was chosen misses nothing.
                let found = missed_peaks(&resolved.frequencies_hz, &resolved.values, &modes, |hz| pair.measured(hz));
                assert_eq!(found.unwrap(), None);
            }
        }
    }
}

#[test]
fn values_are_those_of_the_plain_response_and_the_grid_stays() {
    let (robot, rest) = load(funicular_robots::YUAN2014_4MM);
    let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), 5.0).unwrap();
    let u = Vec6::new(0.0, 0.0, 1.0, 0.1, 0.0, 0.0);
    let pair = Pair { dynamics: &dynamics, input: u, output: u };
    let grid = even(0.5, 5.0, 57);
    let resolved = pair.resolved(&grid, &modes::within(&dynamics, 0.5, 5.0));
    assert_eq!(resolved.values[0], pair.values(&resolved.frequencies_hz));
    assert!(grid.iter().all(|hz| resolved.frequencies_hz.contains(hz)));
    assert!(resolved.frequencies_hz.windows(2).all(|pair| pair[0] < pair[1]));
}

#[test]
fn several_responses_have_common_frequencies_that_resolve_each() {
    let (robot, rest) = load(funicular_robots::YUAN2014_4MM);
    let (from, to) = (0.5, 3.0);
    let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), to).unwrap();
    let modes = modes::within(&dynamics, from, to);
    let along = |direction_w| response::along(&direction_w, &Vec3::zeros(), &rest.pose);
    let inputs = [Vec3::x(), Vec3::z()].map(|d| Port::Platform(along(d)));
    let outputs = [Vec3::z(), Vec3::y()].map(|d| (Port::Platform(along(d)), Quantity::Displacement));
    let resolved =
        resolve(&even(from, to, 50), &modes, Resolution::default(), |hz| measured(&dynamics, hz, &inputs, &outputs));
    let resolved = resolved.unwrap();
    for (i, row) in resolved.values.iter().enumerate() {
        let (Port::Platform(input), (Port::Platform(output), quantity)) = (&inputs[i % 2], &outputs[i / 2]) else {
            unreachable!()
        };
        let of = |hz: &[f64]| response::frf(&dynamics, hz, input, output, *quantity).unwrap();
        assert_eq!(*row, of(&resolved.frequencies_hz));
        let middles: Vec<f64> = resolved.frequencies_hz.windows(2).map(|f| 0.5 * (f[0] + f[1])).collect();
        for (k, value) in of(&middles).iter().enumerate() {
            let line = 0.5 * (row[k].norm().ln() + row[k + 1].norm().ln());
            assert!((value.norm().ln() - line).abs() < 0.01, "{} Hz", middles[k]);
        }
    }
}

/// Response of a single mass on a spring: natural frequency, damping ratio, and a constant part.
fn oscillator(hz: &[f64], natural: f64, ratio: f64, constant: f64) -> Vec<Vec<Measured>> {
    let value = |f: &f64| {
        let r = f / natural;
        Complex::new(1.0, 0.0) / Complex::new(1.0 - r * r, 2.0 * ratio * r) + constant
    };
    hz.iter().map(|f| vec![Measured { value: value(f), floor: 1e-12 }]).collect()
}

/// Mode with a natural frequency and a damping ratio; its motion is not used.
fn mode(frequency_hz: f64, damping_ratio: f64) -> Mode {
    let (robot, rest) = load(funicular_robots::YUAN2014_4MM);
    let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), 2.0).unwrap();
    let mut any = modes::within(&dynamics, 0.0, 2.0).remove(0);
    (any.frequency_hz, any.damping_ratio) = (frequency_hz, damping_ratio);
    any
}

#[test]
fn an_oscillator_has_the_peak_of_the_formula() {
    for ratio in [1e-7, 1e-5, 1e-3, 0.01, 0.1, 0.3] {
        let (natural, grid) = (1.234_567, even(0.1, 3.0, 17));
        let resolved = resolve(&grid, &[mode(natural, ratio)], Resolution::default(), |hz| {
            Ok::<_, ()>(oscillator(hz, natural, ratio, 0.0))
        });
        let resolved = resolved.unwrap();
        let peaks = resolved.peaks(0, 0.01);
        assert_eq!(peaks.len(), 1);
        // The maximum of 1/|1 − r² + 2iζr| is 1/(2ζ√(1 − ζ²)) at r = √(1 − 2ζ²).
        let (height, place) =
            (0.5 / (ratio * (1.0 - ratio * ratio).sqrt()), natural * (1.0 - 2.0 * ratio * ratio).sqrt());
        assert!((peaks[0].magnitude / height - 1.0).abs() < 1e-5, "{ratio}: {peaks:?}");
        assert!((peaks[0].frequency_hz - place).abs() < 1e-2 * ratio * natural, "{ratio}: {peaks:?}");
        assert!(resolved.frequencies_hz.len() < 250 && resolved.unresolved == 0);

        // The grid alone misses it, unless it is so broad that the grid shows it.
        let values: Vec<Complex> = oscillator(&grid, natural, ratio, 0.0).iter().map(|row| row[0].value).collect();
        let read = values.iter().map(|v| v.norm()).fold(0.0, f64::max);
        let missed = missed_peaks(&grid, &[values], &[mode(natural, ratio)], |hz| {
            Ok::<_, ()>(oscillator(hz, natural, ratio, 0.0))
        });
        match missed.unwrap() {
            None => assert!(height < (1.0 + MISSED) * read * 1.001, "{ratio}: {height} is read {read}"),
            Some(missed) => {
                assert!(height > (1.0 + MISSED) * read && missed.count == 1);
                let worst = missed.worst;
                assert!((worst.height / height - 1.0).abs() < 1e-4 && (worst.read / read - 1.0).abs() < 1e-12);
                assert!((worst.frequency_hz - place).abs() < 1e-2 * ratio * natural && grid.contains(&worst.read_hz));
            }
        }
    }
}

#[test]
fn a_peak_before_a_background_is_found_beside_the_natural_frequency() {
    // A constant of the size of the peak moves the maximum by a large part of the half width.
    let (natural, ratio) = (1.0, 1e-3);
    for constant in [-800.0, -300.0, -100.0, 100.0, 300.0, 800.0] {
        let of = |hz: &[f64]| oscillator(hz, natural, ratio, constant);
        let resolved =
            resolve(&even(0.5, 1.5, 11), &[mode(natural, ratio)], Resolution::default(), |hz| Ok::<_, ()>(of(hz)));
        let dense = even(0.9, 1.1, 200_001);
        let magnitudes: Vec<f64> = of(&dense).iter().map(|row| row[0].value.norm()).collect();
        let (at, height) = magnitudes.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1)).unwrap();
        let peak = resolved.unwrap().peaks(0, 0.01)[0];
        assert!(
            (peak.magnitude / height - 1.0).abs() < 1e-5 && (peak.frequency_hz - dense[at]).abs() < 3e-6,
            "{constant}"
        );

        // Grid points of which none is near: the check finds the peak whose height is more than 5 % above them.
        let grid = even(0.503, 1.5, 12);
        let values: Vec<Complex> = of(&grid).iter().map(|row| row[0].value).collect();
        let found =
            missed_peaks(&grid, std::slice::from_ref(&values), &[mode(natural, ratio)], |hz| Ok::<_, ()>(of(hz)));
        let next = grid.partition_point(|hz| *hz < peak.frequency_hz);
        let read = values[next - 1].norm().max(values[next].norm());
        match found.unwrap() {
            Some(missed) => assert!((missed.worst.height / height - 1.0).abs() < 1e-3, "{constant}: {missed:?}"),
            // Places at fixed multiples of the half width see a height to a few per cent.
            None => assert!(*height < 1.08 * read, "{constant}: {height} beside {read}"),
        }
    }
}

/// Two resonances in one interval of a grid. The mode of the lower one is known some half widths beside its peak, as
/// the modes without damping are.
#[test]
fn a_peak_beside_a_higher_one_in_its_interval_is_counted() {
    let grid: Vec<f64> = even(0.503, 1.503, 12);
    for constant in [-80.0, 80.0] {
        for (natural, known) in [(1.01, 1.013), (1.01, 1.007), (1.02, 1.023), (1.02, 1.017), (1.02, 1.0215)] {
            let of = |hz: &[f64]| -> Vec<Vec<Measured>> {
                let (high, low) = (oscillator(hz, 1.0, 1e-3, constant), oscillator(hz, natural, 3e-4, 0.0));
                let sum = |(high, low): (&Vec<Measured>, &Vec<Measured>)| Measured {
                    value: high[0].value + low[0].value * 0.1,
                    floor: 1e-12,
                };
                high.iter().zip(&low).map(|both| vec![sum(both)]).collect()
            };
            let values: Vec<Complex> = of(&grid).iter().map(|row| row[0].value).collect();
            let modes = [mode(1.0, 1e-3), mode(known, 1e-3)];
            let found = missed_peaks(&grid, &[values], &modes, |hz| Ok::<_, ()>(of(hz))).unwrap().unwrap();
            assert_eq!(found.count, 2, "{natural} Hz, known as {known} Hz, before {constant}");
            assert!((found.worst.frequency_hz - 1.0).abs() < 2e-3, "{found:?}");
        }
    }
}

/// A zero beside a broad resonance, whose distance from the real axis is far below the width of the resonance.
#[test]
fn an_antiresonance_is_resolved_however_narrow_it_is() {
    let (zero, natural, ratio, floor) = (1.234_567, 2.0, 0.1, 1e-9);
    for depth in [0.0, 1e-8, 1e-6, 1e-4, 1e-2] {
        let of = |hz: &[f64]| -> Vec<Vec<Measured>> {
            let value = |f: &f64| {
                let pole = Complex::new(natural - f, ratio * natural);
                Complex::new(f - zero, depth) / pole
            };
            hz.iter().map(|f| vec![Measured { value: value(f), floor }]).collect()
        };
        let modes = [mode(natural, ratio)];
        let resolved = resolve(&even(0.5, 3.0, 20), &modes, Resolution::default(), |hz| Ok::<_, ()>(of(hz))).unwrap();
        assert!(resolved.unresolved == 0 && resolved.frequencies_hz.len() < 400, "{}", resolved.frequencies_hz.len());

        // At distances from the zero down to where rounding hides the response.
        let (hz, mut compared) = (&resolved.frequencies_hz, 0);
        for k in 0..=900 {
            for sign in [-1.0, 1.0] {
                let at = zero + sign * 10f64.powf(-0.5 - f64::from(k) * 0.01);
                let value = of(&[at])[0][0].value.norm();
                if value < 1.1 * floor {
                    continue;
                }
                let next = hz.partition_point(|f| *f < at);
                let level = |k: usize| resolved.values[0][k].norm().max(floor).ln();
                let fraction = (at - hz[next - 1]) / (hz[next] - hz[next - 1]);
                let line = level(next - 1) + fraction * (level(next) - level(next - 1));
                assert!((line - value.ln()).abs() < 0.01, "{depth}: {line} {} at {at}", value.ln());
                compared += 1;
            }
        }
        assert!(compared > 1600, "{compared}");
    }
}

#[test]
fn an_undamped_resonance_is_a_gap_and_no_peak() {
    let (mut robot, rest) = load(funicular_robots::YUAN2014_4MM);
    for cable in &mut robot.cables {
        cable.material.damping = Damping::Ratio(0.0);
    }
    let to = 3.0;
    let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), to).unwrap();
    let modes = modes::within(&dynamics, 0.1, to);
    let u = response::along(&Vec3::z(), &Vec3::zeros(), &rest.pose);
    let pair = Pair { dynamics: &dynamics, input: u, output: u };
    // A grid with a natural frequency in it, where the response is not finite or of rounding alone.
    let mut grid = even(0.1, to, 40);
    grid.push(modes[3].frequency_hz);
    grid.sort_by(f64::total_cmp);
    let resolved = pair.resolved(&grid, &modes);

    assert!(!modes.is_empty() && resolved.undamped_hz.len() == modes.len());
    let resonances = resolved.undamped_resonances_hz(0);
    assert!(!resonances.is_empty() && resonances.iter().all(|hz| resolved.undamped_hz.contains(hz)));
    assert!(resolved.peaks(0, 1.0).is_empty(), "an undamped robot has no other maxima");
    assert!(resolved.values[0].iter().all(|value| value.norm().is_finite()));
    for mode in &modes {
        let near = |hz: &f64| (hz - mode.frequency_hz).abs() < 4.9e-5 * mode.frequency_hz;
        assert!(!resolved.frequencies_hz.iter().any(near), "{} Hz", mode.frequency_hz);
    }
    assert!(resolved.frequencies_hz.len() < 200 * modes.len());
    // No finite height can be read too low.
    let values = [pair.values(&even(0.1, to, 40))];
    assert_eq!(missed_peaks(&even(0.1, to, 40), &values, &modes, |hz| pair.measured(hz)).unwrap(), None);
}

#[test]
fn the_limit_of_points_holds_and_is_reported() {
    let (robot, rest) = load(funicular_robots::YUAN2014_4MM);
    let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), 5.0).unwrap();
    let u = Vec6::new(0.0, 0.0, 1.0, 0.0, 0.0, 0.0);
    let pair = Pair { dynamics: &dynamics, input: u, output: u };
    let modes = modes::within(&dynamics, 0.1, 5.0);
    let few = Resolution { max_points: 600, ..Default::default() };
    let resolved = resolve(&even(0.1, 5.0, 50), &modes, few, |hz| pair.measured(hz)).unwrap();
    assert!(resolved.frequencies_hz.len() <= 600 + modes.len() && resolved.unresolved > 0);
}

#[test]
fn a_response_that_is_rounding_alone_is_not_resolved() {
    let noise = |hz: &[f64]| -> Result<Vec<Vec<Measured>>, ()> {
        let value = |f: &f64| Complex::new(1e-15 * (1e6 * f).sin(), 1e-15 * (3e7 * f).cos());
        Ok(hz.iter().map(|f| vec![Measured { value: value(f), floor: 1e-12 }]).collect())
    };
    let resolved = resolve(&even(0.1, 3.0, 30), &[mode(1.0, 0.01)], Resolution::default(), noise).unwrap();
    assert!(resolved.frequencies_hz.len() < 60 && resolved.peaks(0, 0.0).len() < 60);
    let values = [noise(&even(0.1, 3.0, 30)).unwrap().iter().map(|row| row[0].value).collect()];
    assert_eq!(missed_peaks(&even(0.1, 3.0, 30), &values, &[mode(1.0, 0.01)], noise), Ok(None));
}

#[test]
fn modes_in_a_range_are_those_of_the_whole_list() {
    for text in [funicular_robots::YUAN2014_4MM, funicular_robots::COGIRO] {
        let (robot, rest) = load(text);
        let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), 20.0).unwrap();
        let all = modes::below(&dynamics, 20.0);
        for (from, to) in [(0.0, 20.0), (0.0, 5.0), (4.0, 7.7), (12.0, 20.0), (0.1, 0.2)] {
            let expected: Vec<f64> =
                all.modes.iter().map(|mode| mode.frequency_hz).filter(|hz| (from..to).contains(hz)).collect();
            let within: Vec<f64> = modes::within(&dynamics, from, to).iter().map(|mode| mode.frequency_hz).collect();
            assert_eq!(within.len(), expected.len(), "{from} to {to}");
            assert_eq!(modes::count_within(&dynamics, from, to), expected.len());
            assert!(within.iter().zip(&expected).all(|(a, b)| (a / b - 1.0).abs() < 1e-10));
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 12, ..Default::default() })]

    #[test]
    fn curves_and_warnings_of_any_robot_are_those_of_a_dense_grid(
        (robot, lengths) in any_robot(),
        ratio in -3.0f64..-1.0,
        seed in 0.0f64..1.0,
    ) {
        let mut robot = robot;
        for cable in &mut robot.cables {
            cable.material.damping = Damping::Ratio(10f64.powf(ratio));
        }
        let Ok(rest) = statics::forward(&robot, &lengths, StaticModel::Catenary, None) else { return Ok(()) };
        let Ok(dynamics) = Dynamics::about(&robot, &rest, Linearisation::default(), 30.0) else { return Ok(()) };
        // A range with a few dozen modes.
        let Some(to) = [30.0, 10.0, 3.0, 1.0].into_iter().find(|to| modes::count_within(&dynamics, 0.05,
            *to) < 60) else {
            return Ok(());
        };
        let modes = modes::within(&dynamics, 0.05, to);
        // Platform modes may have next to no damping: the peak is then narrower than the dense grid resolves.
        prop_assume!(modes.iter().all(|mode| mode.damping_ratio > 1e-6));
        let input = Vec6::new(1.0, seed, 0.3, 0.1, -0.2 * seed, 0.0);
        let output = Vec6::new(0.2, 1.0 - seed, 1.0, 0.0, 0.1, 0.2);
        let pair = Pair { dynamics: &dynamics, input, output };
        let resolved = pair.resolved(&even(0.05, to, 60), &modes);
        let (points, needed) = (resolved.frequencies_hz.len(), needed(&pair, &resolved));
        // Lines use 0.6 of the tolerance and end at halved intervals. The given frequencies and the peaks are kept as
        // well.
        prop_assert!(
            resolved.unresolved == 0 && (points as f64) < 1.6 * needed as f64 + 60.0 + modes.len() as f64,
            "{points} points, {needed} needed, {} modes, {} intervals left",
            modes.len(),
            resolved.unresolved
        );
        check_curve(&pair, &resolved, (0.05, to), 2_001);

        // The warning of a coarse grid is that of the peaks of the resolved curve.
        let grid = even(0.05, to, 200);
        let values = pair.values(&grid);
        let missed = missed_peaks(&grid, std::slice::from_ref(&values), &modes, |hz| pair.measured(hz)).unwrap();
        let read = |hz: f64| {
            let next = grid.partition_point(|at| *at < hz).clamp(1, grid.len() - 1);
            values[next - 1].norm().max(values[next].norm())
        };
        let peaks = resolved.peaks(0, 0.0);
        let higher = |ratio: f64| peaks.iter().filter(move |peak| peak.magnitude > ratio * read(peak.frequency_hz));

        // Resonances are counted, to 1 % of their height. A rise between antiresonances has no natural frequency, and
        // the warning does not promise to count it.
        let damped = modes::damped::damped_modes(&dynamics, &modes::below(&dynamics, to));
        let is_resonance = |hz: f64| {
            damped.modes.iter().any(|mode| (mode.ringing_hz() - hz).abs() < 3.0 * mode.omega.im / TAU)
        };
        let sure = higher(1.01 * (1.0 + MISSED)).filter(|peak| is_resonance(peak.frequency_hz)).count();
        let possible = higher(1.0 + MISSED).count();
        let count = missed.map_or(0, |missed| missed.count);
        let of_all: Vec<_> = higher(1.0 + MISSED)
            .map(|peak| (*peak, peak.magnitude / read(peak.frequency_hz), is_resonance(peak.frequency_hz)))
            .collect();
        prop_assert!((sure..=possible).contains(&count), "{sure} {count} {possible}: {of_all:?}");
        if let Some(missed) = missed {
            let worst = missed.worst;
            let same = peaks.iter().any(|peak| (peak.magnitude / worst.height - 1.0).abs() < 1e-3);
            prop_assert!(same && (worst.read / read(worst.frequency_hz) - 1.0).abs() < 1e-12, "{worst:?}");
        }
    }
}

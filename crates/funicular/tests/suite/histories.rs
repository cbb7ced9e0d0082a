//! Poles of time histories: exact decays, and how often stated intervals hold the truth.

mod readings;

use crate::random::Draw;
use funicular::histories::ambient::{self, AmbientOptions};
use funicular::histories::{IdentifiedPole, Samples, decay, mac};
use funicular::math::Complex;
use std::f64::consts::TAU;

/// Quantile of the normal distribution of the intervals that hold the truth with 95 %.
const NORMAL: f64 = 1.96;

/// Quantile of Student's distribution with 29 degrees of freedom.
const STUDENT_29: f64 = 2.045;

/// Vibration of a made history.
#[derive(Clone, Copy)]
struct Vibration {
    hz: f64,
    damping: f64,
    /// Amplitudes at the sensors.
    shape: [f64; 3],
}

/// Vibrations with a pair whose peaks overlap, as CoGiRo has it.
const CLOSE_PAIR: [Vibration; 3] = [
    Vibration { hz: 4.85, damping: 0.012, shape: [1.0, 0.4, -0.3] },
    Vibration { hz: 7.75, damping: 0.011, shape: [0.3, 1.0, 0.2] },
    Vibration { hz: 7.85, damping: 0.008, shape: [-0.5, 0.6, 0.9] },
];

const WIND: [Vibration; 3] = [
    Vibration { hz: 4.85, damping: 0.012, shape: [1.0, 0.4, -0.3] },
    Vibration { hz: 5.94, damping: 0.009, shape: [0.3, 1.0, 0.5] },
    Vibration { hz: 8.98, damping: 0.010, shape: [-0.5, 0.4, 1.0] },
];

/// Normally distributed pseudo-random number.
fn normal(draw: &mut Draw) -> f64 {
    (-2.0 * draw.between(1e-300, 1.0).ln()).sqrt() * (TAU * draw.between(0.0, 1.0)).cos()
}

/// Free decay after a release, with noise.
fn decaying(vibrations: &[Vibration], noise: f64, (count, step): (usize, f64), draw: &mut Draw) -> Samples {
    let time: Vec<f64> = (0..count).map(|k| step * k as f64).collect();
    let mut channels = vec![vec![0.0; count]; 3];
    for (c, channel) in channels.iter_mut().enumerate() {
        for (value, t) in channel.iter_mut().zip(&time) {
            let of = |vibration: &Vibration| {
                let omega = TAU * vibration.hz;
                let turn = (1.0 - vibration.damping.powi(2)).sqrt() * omega * t;
                vibration.shape[c] * (-vibration.damping * omega * t).exp() * turn.cos()
            };
            *value = 0.2 * (c as f64 + 1.0) + vibrations.iter().map(of).sum::<f64>() + noise * normal(draw);
        }
    }
    Samples::new(time, &channels).unwrap()
}

/// Displacements of vibrations that independent white noises drive, of which every step is exact, with noise of the
/// sensors of 5 %.
fn driven(vibrations: &[Vibration], (count, step): (usize, f64), draw: &mut Draw) -> Samples {
    let mut channels = vec![Vec::new(); 3];
    // Each has the deviations 1 and ω of its displacement and velocity.
    let mut states: Vec<[f64; 2]> = vibrations.iter().map(|of| [normal(draw), TAU * of.hz * normal(draw)]).collect();
    for _ in 0..count {
        for (c, channel) in channels.iter_mut().enumerate() {
            let sum: f64 = vibrations.iter().zip(&states).map(|(of, state)| of.shape[c] * state[0]).sum();
            channel.push(sum + 0.05 * normal(draw));
        }
        for (of, state) in vibrations.iter().zip(&mut states) {
            *state = after(of, *state, step, draw);
        }
    }
    Samples::new((0..count).map(|k| step * k as f64).collect(), &channels).unwrap()
}

/// State of a vibration after a step, with the noise that keeps its covariance.
fn after(of: &Vibration, state: [f64; 2], step: f64, draw: &mut Draw) -> [f64; 2] {
    let omega = TAU * of.hz;
    let (decay, turning) = (of.damping * omega, omega * (1.0 - of.damping.powi(2)).sqrt());
    let (sin, cos) = (turning * step).sin_cos();
    let size = (-decay * step).exp();
    let rows = [
        [size * (cos + decay / turning * sin), size * sin / turning],
        [-size * omega * omega / turning * sin, size * (cos - decay / turning * sin)],
    ];
    let kept = |a: usize, b: usize| rows[a][0] * rows[b][0] + omega * omega * rows[a][1] * rows[b][1];
    let [first, mixed, second] = [1.0 - kept(0, 0), -kept(0, 1), omega * omega - kept(1, 1)];
    let spread = first.sqrt();
    let noise = [normal(draw), normal(draw)];
    [
        rows[0][0] * state[0] + rows[0][1] * state[1] + spread * noise[0],
        rows[1][0] * state[0]
            + rows[1][1] * state[1]
            + mixed / spread * noise[0]
            + (second - mixed * mixed / first).sqrt() * noise[1],
    ]
}

/// Counts of intervals that hold the truth, and the sums of errors and squares in deviations.
#[derive(Default)]
struct Coverage {
    tried: usize,
    frequencies: usize,
    dampings: usize,
    /// Intervals that hold a frequency that is wrong by 1 %.
    wrong: usize,
    squares: [f64; 2],
}

impl Coverage {
    fn add(&mut self, pole: &IdentifiedPole, truth: &Vibration, quantile: f64) {
        let error = |hz: f64| (pole.frequency_hz - hz) / pole.frequency_std_hz;
        let of_damping = (pole.damping_ratio - truth.damping) / pole.damping_std;
        self.tried += 1;
        self.frequencies += usize::from(error(truth.hz).abs() <= quantile);
        self.dampings += usize::from(of_damping.abs() <= quantile);
        self.wrong += usize::from(error(1.01 * truth.hz).abs() <= quantile);
        self.squares[0] += error(truth.hz).powi(2);
        self.squares[1] += of_damping.powi(2);
    }

    /// Parts of the intervals of frequencies and damping ratios that hold the truth.
    fn parts(&self) -> [f64; 2] {
        [self.frequencies, self.dampings].map(|count| count as f64 / self.tried as f64)
    }

    fn told(&self) -> String {
        let ratio = self.squares.map(|sum| (sum / self.tried as f64).sqrt());
        format!("{:?} of {}, errors in deviations {ratio:?}, wrong {}", self.parts(), self.tried, self.wrong)
    }
}

fn check(coverages: &[Coverage], drawn: usize) {
    let mut all = Coverage::default();
    for of in coverages {
        assert_eq!(of.tried, drawn);
        all.tried += of.tried;
        all.frequencies += of.frequencies;
        all.dampings += of.dampings;
        // Each has four deviations of its count around 95 %.
        let width = 4.0 * (0.95 * 0.05 / drawn as f64).sqrt();
        assert!(of.parts().iter().all(|part| *part > 0.95 - width), "{}", of.told());
    }
    assert!(all.parts().iter().all(|part| (0.90..=0.98).contains(part)), "{}", all.told());
}

/// Exact decay of two vibrations: frequencies, damping ratios, and shapes to rounding.
#[test]
fn exact_decay_is_recovered_to_rounding() {
    let truth = [CLOSE_PAIR[0], Vibration { hz: 6.2, ..CLOSE_PAIR[1] }];
    let samples = decaying(&truth, 0.0, (400, 0.01), &mut Draw(1));
    let found = decay::identify(&samples, None, Some(2)).unwrap();
    for (pole, truth) in found.found.poles.iter().zip(&truth) {
        assert!((pole.frequency_hz / truth.hz - 1.0).abs() < 1e-9, "{pole:?}");
        assert!((pole.damping_ratio / truth.damping - 1.0).abs() < 1e-7, "{pole:?}");
        let shape = truth.shape.map(Complex::from);
        assert!(1.0 - mac(&pole.shape, &shape) < 1e-12, "{pole:?}");
        let largest = truth.shape[0].max(truth.shape[1]);
        assert!(pole.shape.iter().zip(&shape).all(|(a, b)| (a - b / largest).norm() < 1e-7), "{pole:?}");
    }
}

/// Decays with a close pair and noise of 5 %: the stated intervals hold the truth in 95 % of 100 draws, the number of
/// vibrations is found, and a frequency that is wrong by 1 % is in none.
#[test]
fn intervals_of_noisy_decays_hold_the_truth() {
    const DRAWN: usize = 100;
    let mut draw = Draw(20);
    let mut coverages: [Coverage; 3] = Default::default();
    for _ in 0..DRAWN {
        let samples = decaying(&CLOSE_PAIR, 0.05, (420, 1.0 / 60.0), &mut draw);
        let found = decay::identify(&samples, None, None).unwrap();
        assert!(found.is_noise || found.correlation < 1.6, "{}", found.correlation);
        assert_eq!(found.found.poles.len(), 3, "{:?}", found.found.poles);
        for ((pole, truth), coverage) in found.found.poles.iter().zip(&CLOSE_PAIR).zip(&mut coverages) {
            coverage.add(pole, truth, NORMAL);
        }
    }
    check(&coverages, DRAWN);
    assert!(coverages.iter().all(|of| of.wrong == 0));
}

/// Records of a system that white noise drives: the stated intervals hold the truth in 95 % of 100 draws.
#[test]
fn intervals_of_ambient_records_hold_the_truth() {
    const DRAWN: usize = 100;
    let mut draw = Draw(30);
    let mut coverages: [Coverage; 3] = Default::default();
    for _ in 0..DRAWN {
        let samples = driven(&WIND, (4000, 0.03), &mut draw);
        let found = ambient::identify(&samples, AmbientOptions::default()).unwrap();
        assert_eq!(found.found.poles.len(), 3, "{:?}", found.found.poles);
        for ((pole, truth), coverage) in found.found.poles.iter().zip(&WIND).zip(&mut coverages) {
            coverage.add(pole, truth, STUDENT_29);
        }
    }
    check(&coverages, DRAWN);
    assert!(coverages.iter().map(|of| of.wrong).sum::<usize>() < 3 * DRAWN / 20);
}

//! Readings that are judged before any fit, and readings that make no history.

use super::{CLOSE_PAIR, decaying};
use crate::random::Draw;
use funicular::histories::{Samples, SamplesError, quality};
use std::f64::consts::TAU;

/// Sinusoid of a channel.
fn sinusoid(hz: f64, rate: f64, count: usize) -> Samples {
    let time: Vec<f64> = (0..count).map(|k| k as f64 / rate).collect();
    let values = time.iter().map(|t| (TAU * hz * t).sin()).collect();
    Samples::new(time, &[values]).unwrap()
}

#[test]
fn energy_near_the_nyquist_frequency_is_seen() {
    assert!(quality::high_energy(&sinusoid(46.0, 100.0, 500), 0) > 0.9);
    assert!(quality::high_energy(&sinusoid(8.0, 100.0, 500), 0) < 1e-3);
}

#[test]
fn clipped_readings_are_counted() {
    let samples = sinusoid(2.0, 100.0, 400);
    let column: Vec<f64> = samples.values().column(0).iter().map(|value| value.clamp(-0.5, 2.0)).collect();
    let beyond = column.iter().filter(|value| **value <= -0.5).count();
    let clipped = Samples::new(samples.time().to_vec(), &[column]).unwrap();
    assert_eq!(quality::clipped(&clipped, 0), beyond);
    assert_eq!(quality::clipped(&samples, 0), 0);
}

#[test]
fn jitter_and_resolution_are_those_of_the_readings() {
    let even = sinusoid(2.03, 100.0, 1000);
    assert!(quality::jitter(&even) < 1e-9);
    let mut draw = Draw(5);
    let time = even.time().iter().map(|t| t + 0.001 * draw.between(-1.0, 1.0)).collect();
    let rounded: Vec<f64> = even.values().iter().map(|value| 0.01 * (100.0 * value).round()).collect();
    let uneven = Samples::new(time, &[rounded]).unwrap();
    // Differences of two uniform numbers within ± 10 % of the step.
    assert!((quality::jitter(&uneven) - 0.1 * (2.0f64 / 3.0).sqrt()).abs() < 0.01);
    assert!((quality::quantum(&uneven, 0) - 0.01).abs() < 1e-9);
}

#[test]
fn readings_that_make_no_history_are_refused() {
    let samples = decaying(&CLOSE_PAIR, 0.01, (100, 0.01), &mut Draw(6));
    let time = samples.time().to_vec();
    let column: Vec<f64> = samples.values().column(0).iter().copied().collect();

    let mut falling = time.clone();
    falling[50] = falling[48];
    let refused = Samples::new(falling, std::slice::from_ref(&column)).unwrap_err();
    assert!(matches!(refused, SamplesError::Order { sample: 51, .. }), "{refused}");
    let mut broken = column.clone();
    broken[7] = f64::NAN;
    assert_eq!(Samples::new(time.clone(), &[broken]).unwrap_err(), SamplesError::NotFinite(8));
    let constant = Samples::new(time.clone(), &[column.clone(), vec![9.81; 100]]).unwrap_err();
    assert_eq!(constant, SamplesError::Constant(2));
    let short = Samples::new(time, &[column[1..].to_vec()]).unwrap_err();
    assert!(matches!(short, SamplesError::Lengths { channel: 1, count: 99, times: 100 }), "{short}");
    assert!(matches!(Samples::new(vec![0.0; 3], &[vec![0.0; 3]]), Err(SamplesError::Few(3))));
}

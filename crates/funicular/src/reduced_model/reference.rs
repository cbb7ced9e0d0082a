//! Responses of the full model at frequencies that include every peak. Errors of a reduced model are measured against
//! them.

use super::channels::Channels;
use crate::dynamics::Dynamics;
use crate::math::Complex;
use crate::modes::Mode;
use crate::response::{self, Quantity, ResponseError};
use std::f64::consts::TAU;

/// Distances of the frequencies around each natural frequency, in half widths of its peak. A peak between two of them
/// is at most 2 % higher than they are, before it is searched for.
const AROUND: [f64; 13] = [0.0, 0.25, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0, 12.0, 20.0];
/// Number of frequencies at equal distances, and of frequencies at equal ratios.
const EVEN: usize = 1000;
/// Ratio of the lowest frequency to the limit.
const LOWEST: f64 = 1e-4;
/// Ratio to the limit of the frequency at which a response is taken for the static one. Its error is about the square
/// of its ratio to the first natural frequency.
const STATIC: f64 = 1e-6;
/// Rounds of the search for a maximum. Each halves the distance of the frequencies around it; six reduce the error of a
/// maximum from 2 % to below 1e-5.
const ROUNDS: usize = 6;
/// Local maxima are searched for if they are above this fraction of the largest sample.
const HIGH: f64 = 0.9;
/// Minimum size of a response that counts as one, as a fraction of the responses that its input and its output have
/// otherwise. Symmetry and rounding leave smaller ones.
const MIN_COUPLING: f64 = 1e-6;

/// Largest value of a pair of output and input, and its frequency [Hz].
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Maximum {
    pub(super) value: f64,
    pub(super) frequency_hz: f64,
}

/// Responses of the full model, in the quantities of the outputs, and their peaks. Pairs of output and input are
/// numbered by columns: `input * outputs + output`.
pub(super) struct ReferenceResponses<'a> {
    /// Full model.
    pub(super) dynamics: &'a Dynamics,
    pub(super) channels: &'a Channels,
    quantities: &'a [Quantity],
    /// Frequencies [Hz], ascending.
    pub(super) frequencies_hz: Vec<f64>,
    /// Responses of all pairs, one frequency after the other.
    pub(super) values: Vec<Complex>,
    /// Static displacement of each pair; zero for velocities and accelerations.
    pub(super) at_rest: Vec<f64>,
    /// Peak of each pair up to the limit.
    pub(super) peaks: Vec<Maximum>,
    /// Size to which the error of each pair is related: its peak, or the product of the scales if it is not coupled.
    pub(super) sizes: Vec<f64>,
    /// Scales of outputs and inputs; divided by both, every peak is at most 1.
    pub(super) output_scale: Vec<f64>,
    pub(super) input_scale: Vec<f64>,
    /// True if drives have losses: modes may be damped so strongly that the real parts of their residues count.
    pub(super) has_drive_losses: bool,
}

impl<'a> ReferenceResponses<'a> {
    /// Responses up to the limit `below_hz` [Hz] of a robot with these `modes`.
    pub(super) fn new(
        dynamics: &'a Dynamics,
        channels: &'a Channels,
        quantities: &'a [Quantity],
        modes: &[Mode],
        below_hz: f64,
    ) -> Result<Self, ResponseError> {
        let pairs = channels.inputs.len() * channels.outputs.len();
        let mut this = Self {
            dynamics,
            channels,
            quantities,
            frequencies_hz: frequencies(modes, below_hz),
            values: Vec::new(),
            at_rest: vec![0.0; pairs],
            peaks: Vec::new(),
            sizes: Vec::new(),
            output_scale: Vec::new(),
            input_scale: Vec::new(),
            has_drive_losses: dynamics.cable_blocks().any(|cable| cable.drive.iter().any(|part| part.damping > 0.0)),
        };

        let displacement = displacements(dynamics, &[STATIC * below_hz], channels)?;
        for (pair, value) in displacement.iter().enumerate() {
            if this.quantity(pair) == Quantity::Displacement {
                this.at_rest[pair] = value.re;
            }
        }

        this.values = this.full(&this.frequencies_hz)?;
        this.peaks = this.maxima(&mut |_, values| values.iter().map(|value| value.norm()).collect())?;
        this.scale();
        Ok(this)
    }

    /// Number of pairs of output and input.
    pub(super) fn pairs(&self) -> usize {
        self.at_rest.len()
    }

    /// Quantity of the output of a pair.
    pub(super) fn quantity(&self, pair: usize) -> Quantity {
        self.quantities[pair % self.quantities.len()]
    }

    /// Responses of the full model in the quantities of the outputs.
    fn full(&self, frequencies_hz: &[f64]) -> Result<Vec<Complex>, ResponseError> {
        self.of(self.dynamics, self.channels, frequencies_hz)
    }

    /// Responses of another model of the robot at the present frequencies, in the quantities of the outputs.
    pub(super) fn of_other(&self, dynamics: &Dynamics, channels: &Channels) -> Result<Vec<Complex>, ResponseError> {
        self.of(dynamics, channels, &self.frequencies_hz)
    }

    fn of(
        &self,
        dynamics: &Dynamics,
        channels: &Channels,
        frequencies_hz: &[f64],
    ) -> Result<Vec<Complex>, ResponseError> {
        let mut values = displacements(dynamics, frequencies_hz, channels)?;
        for (at, &frequency_hz) in values.chunks_exact_mut(self.pairs()).zip(frequencies_hz) {
            for (pair, value) in at.iter_mut().enumerate() {
                *value *= self.quantity(pair).factor(frequency_hz * TAU);
            }
        }
        Ok(values)
    }

    /// Maximum of each pair of numbers that `measure` makes of the full responses at a frequency [Hz]. Frequencies are
    /// added around the highest local maxima, until these are found.
    pub(super) fn maxima(
        &mut self,
        measure: &mut dyn FnMut(f64, &[Complex]) -> Vec<f64>,
    ) -> Result<Vec<Maximum>, ResponseError> {
        let pairs = self.pairs();
        let mut heights: Vec<Vec<f64>> = self
            .frequencies_hz
            .iter()
            .zip(self.values.chunks_exact(pairs))
            .map(|(&f, values)| measure(f, values))
            .collect();

        for round in 0..=ROUNDS {
            let maxima: Vec<usize> = (0..pairs)
                .map(|pair| (0..heights.len()).max_by(|a, b| heights[*a][pair].total_cmp(&heights[*b][pair])))
                .map(|at| at.expect("there are frequencies"))
                .collect();
            if round == ROUNDS {
                let found = |(pair, &at): (usize, &usize)| Maximum {
                    value: heights[at][pair],
                    frequency_hz: self.frequencies_hz[at],
                };
                return Ok(maxima.iter().enumerate().map(found).collect());
            }

            // Middles of the intervals beside each high local maximum.
            let mut added = Vec::new();
            for (pair, &at) in maxima.iter().enumerate() {
                let high = HIGH * heights[at][pair];
                for k in 0..heights.len() {
                    let height = heights[k][pair];
                    let before = k.checked_sub(1);
                    let after = (k + 1 < heights.len()).then_some(k + 1);
                    let is_maximum = [before, after].iter().flatten().all(|other| heights[*other][pair] <= height);
                    if height > 0.0 && height >= high && is_maximum {
                        added.extend(
                            [before, after]
                                .iter()
                                .flatten()
                                .map(|other| 0.5 * (self.frequencies_hz[k] + self.frequencies_hz[*other])),
                        );
                    }
                }
            }
            self.add(added, &mut heights, measure)?;
        }
        unreachable!("the last round returns")
    }

    /// Adds frequencies [Hz] and the heights there, in their order.
    fn add(
        &mut self,
        mut added: Vec<f64>,
        heights: &mut Vec<Vec<f64>>,
        measure: &mut dyn FnMut(f64, &[Complex]) -> Vec<f64>,
    ) -> Result<(), ResponseError> {
        let pairs = self.pairs();
        added.sort_by(f64::total_cmp);
        added.dedup();
        added.retain(|f| self.frequencies_hz.binary_search_by(|other| other.total_cmp(f)).is_err());
        let values = self.full(&added)?;

        let (mut frequencies, mut all, mut all_heights) = (Vec::new(), Vec::new(), Vec::new());
        let mut new = added.iter().zip(values.chunks_exact(pairs)).peekable();
        let old_heights = std::mem::take(heights);
        for ((&f, old), height) in self.frequencies_hz.iter().zip(self.values.chunks_exact(pairs)).zip(old_heights) {
            while let Some((&g, value)) = new.next_if(|(g, _)| **g < f) {
                frequencies.push(g);
                all.extend_from_slice(value);
                all_heights.push(measure(g, value));
            }
            frequencies.push(f);
            all.extend_from_slice(old);
            all_heights.push(height);
        }
        // Nothing is added beyond the last frequency, which is the limit.
        (self.frequencies_hz, self.values, *heights) = (frequencies, all, all_heights);
        Ok(())
    }

    /// Scales of outputs and inputs from the peaks (as LAPACK's `geequ` equilibrates a matrix), and the sizes to which
    /// errors are related.
    fn scale(&mut self) {
        let outputs = self.channels.outputs.len();
        let positive = |x: f64| if x > 0.0 { x } else { 1.0 };
        let peak = |output: usize, input: usize| self.peaks[input * outputs + output].value;
        let inputs = self.channels.inputs.len();

        self.output_scale =
            (0..outputs).map(|o| positive((0..inputs).map(|i| peak(o, i)).fold(0.0, f64::max))).collect();
        self.input_scale = (0..inputs)
            .map(|i| positive((0..outputs).map(|o| peak(o, i) / self.output_scale[o]).fold(0.0, f64::max)))
            .collect();
        self.sizes = (0..self.peaks.len())
            .map(|pair| {
                let scale = self.output_scale[pair % outputs] * self.input_scale[pair / outputs];
                let peak = self.peaks[pair].value;
                if peak >= MIN_COUPLING * scale { peak } else { scale }
            })
            .collect();
    }

    /// True if a pair has a response that counts.
    pub(super) fn is_coupled(&self, pair: usize) -> bool {
        self.peaks[pair].value > 0.0 && self.peaks[pair].value >= self.sizes[pair]
    }
}

/// Displacements of all outputs per force at all inputs: outputs×inputs entries by columns, one frequency [Hz] after
/// the other.
fn displacements(
    dynamics: &Dynamics,
    frequencies_hz: &[f64],
    channels: &Channels,
) -> Result<Vec<Complex>, ResponseError> {
    let (inputs, outputs) = (channels.inputs.len(), channels.outputs.len());
    let measured: Vec<_> = channels.outputs.iter().map(|port| (port.clone(), Quantity::Displacement)).collect();
    let rows = response::matrix(dynamics, frequencies_hz, &channels.inputs, &measured)?;
    let pair = |k: usize, j: usize| rows.iter().skip(j).step_by(inputs).take(outputs).map(move |row| row[k]);
    Ok((0..frequencies_hz.len()).flat_map(|k| (0..inputs).flat_map(move |j| pair(k, j))).collect())
}

/// Frequencies [Hz] up to the limit, ascending: at equal distances, at equal ratios, and around each natural frequency
/// in half widths of its peak.
fn frequencies(modes: &[Mode], below_hz: f64) -> Vec<f64> {
    let even = (1..=EVEN).map(|i| below_hz * i as f64 / EVEN as f64);
    let ratio = |i: usize| below_hz * LOWEST.powf(i as f64 / EVEN as f64);
    let around = modes.iter().flat_map(|mode| {
        AROUND.iter().flat_map(move |t| [-t, *t]).map(move |t| mode.frequency_hz * (1.0 + t * mode.damping_ratio))
    });

    let mut all: Vec<f64> = even.chain((1..=EVEN).map(ratio)).chain(around).collect();
    all.retain(|f| *f > 0.0 && *f <= below_hz);
    all.sort_by(f64::total_cmp);
    all.dedup();
    all
}

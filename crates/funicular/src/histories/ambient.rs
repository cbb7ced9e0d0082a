//! Record under unknown broad-band excitation: poles of its covariances, with deviations by infinitesimal jackknife.

use super::poles::{IdentifiedPole, PoleSet, Samples, SamplesError, frequency_and_damping, mac};
use super::realisation::{RawPole, poles_of};
use crate::math::{Complex, DMat};

/// Default number of blocks of rows of the Toeplitz matrix.
const BLOCK_ROWS: usize = 30;

/// Default number of blocks of time.
const BLOCKS: usize = 30;

/// Maximum number of rows of the Toeplitz matrix.
const MAX_ROWS: usize = 240;

/// Maximum number of pairs of poles in the stabilisation diagram.
const MAX_PAIRS: usize = 20;

/// Step of the jackknife. The pipeline is smooth, and the error of its differences is proportional to the step.
const STEP: f64 = 1e-4;

/// Number of orders in a row, of which every second one may lack it, in which a stable pole is found.
const STABLE_ORDERS: usize = 5;

/// Differences of a stable pole from one order to the next: frequency and damping ratio, relative, and MAC.
const SAME_FREQUENCY: f64 = 0.01;
const SAME_DAMPING: f64 = 0.2;
const SAME_SHAPE: f64 = 0.95;

/// Maximum damping ratio of a vibration; beyond it the pole is one of the wind.
const MAX_DAMPING: f64 = 0.2;

/// Damping ratio below which a pole is the harmonic of a motor.
const HARMONIC: f64 = 1e-3;

/// Minimum ratio of the rate of the covariances to the root mean square frequency of the record.
const MIN_RATE: f64 = 5.0;

/// Choices for a record.
#[derive(Debug, Clone, Copy, Default)]
pub struct AmbientOptions {
    /// Number of blocks of rows.
    pub block_rows: Option<usize>,
    /// Order of the system: two per pole; `None` for the least order that has all stable poles.
    pub order: Option<usize>,
    /// Number of blocks of time.
    pub blocks: Option<usize>,
}

/// Pole of the stabilisation diagram.
#[derive(Debug, Clone)]
pub struct DiagramPole {
    /// Order of the system.
    pub order: usize,
    /// Frequency [Hz].
    pub frequency_hz: f64,
    /// Damping ratio.
    pub damping_ratio: f64,
    /// True if the pole has been found in as many orders as a stable one.
    pub is_stable: bool,
}

/// Poles of a record.
#[derive(Debug, Clone)]
pub struct Ambient {
    /// Poles with covariance and shapes.
    pub found: PoleSet,
    /// Order of the system.
    pub order: usize,
    /// Number of blocks of time.
    pub blocks: usize,
    /// Number of samples between two covariances.
    pub stride: usize,
    /// Poles of all orders.
    pub diagram: Vec<DiagramPole>,
    /// Frequencies of poles that hardly decay [Hz]: harmonics of motors, which are left out.
    pub harmonics_hz: Vec<f64>,
    /// Duration of the record [s].
    pub duration: f64,
}

impl Ambient {
    /// Least duration with which the damping ratio of a pole is known to 25 % [s].
    pub fn least_duration(pole: &IdentifiedPole) -> f64 {
        2.5 / (pole.damping_ratio * pole.frequency_hz)
    }
}

/// Subspace pipeline from covariances to poles.
struct SubspacePipeline {
    rows: usize,
    channels: usize,
    /// Time between covariances [s].
    step: f64,
}

impl SubspacePipeline {
    /// Observability matrix up to an order, of covariances with lags 1, 2 ….
    fn observability(&self, covariances: &[DMat], order: usize) -> Option<DMat> {
        let Self { rows, channels, .. } = *self;
        let toeplitz = DMat::from_fn(rows * channels, rows * channels, |a, b| {
            covariances[rows + a / channels - b / channels - 1][(a % channels, b % channels)]
        });
        let found = toeplitz.try_svd(true, false, f64::EPSILON, 500)?;
        let (vectors, sizes) = (found.u?, found.singular_values);
        let mut places: Vec<usize> = (0..sizes.len()).collect();
        places.sort_by(|a, b| sizes[*b].total_cmp(&sizes[*a]));
        let column = |row: usize, k: usize| vectors[(row, places[k])] * sizes[places[k]].sqrt();
        Some(DMat::from_fn(rows * channels, order.min(places.len() - channels), column))
    }

    /// Observability matrices of covariances that are moved towards those of each block.
    fn moved(&self, mean: &[DMat], of_blocks: &[Vec<DMat>], order: usize) -> Option<Vec<DMat>> {
        let of_block = |block: &Vec<DMat>| {
            let moved: Vec<DMat> = mean.iter().zip(block).map(|(mean, own)| mean + (own - mean) * STEP).collect();
            self.observability(&moved, order)
        };
        of_blocks.iter().map(of_block).collect()
    }

    fn poles(&self, observability: &DMat, order: usize) -> Vec<RawPole> {
        poles_of(&observability.columns(0, order).into(), self.channels, self.step)
    }
}

/// Poles of a record under unknown broad-band excitation.
///
/// # Errors
/// A record that is too short for its blocks, or without a stable pole.
///
/// # References
/// B. Peeters, G. De Roeck (1999), for the subspace of covariances; M. Döhler, L. Mevel (2013), for its covariance.
pub fn identify(samples: &Samples, options: AmbientOptions) -> Result<Ambient, SamplesError> {
    let channels = samples.channels();
    let rows = options.block_rows.unwrap_or(BLOCK_ROWS).min(MAX_ROWS / channels).max(4);
    let blocks = options.blocks.unwrap_or(BLOCKS).max(2);
    let stride = stride(samples, rows, blocks);
    let size = samples.count() / blocks;
    // Every block has a covariance at the longest lag.
    if size <= 2 * rows * stride {
        let least = blocks * (2 * rows * stride + 1);
        return Err(SamplesError::Short { samples: samples.count(), blocks, least });
    }
    let pipeline = SubspacePipeline { rows, channels, step: samples.step() * stride as f64 };
    let of_blocks: Vec<Vec<DMat>> =
        (0..blocks).map(|block| covariances(samples, block * size, size, 2 * rows, stride)).collect();
    let mean = covariances(samples, 0, samples.count(), 2 * rows, stride);

    // Orders that may be taken.
    let highest = (2 * MAX_PAIRS).max(options.order.unwrap_or(0)).min((rows - 1) * channels);
    let whole = pipeline.observability(&mean, highest).ok_or(SamplesError::NoPole)?;
    let highest = whole.ncols();
    let orders: Vec<(usize, Vec<RawPole>)> =
        (1..=highest / 2).map(|pairs| (2 * pairs, pipeline.poles(&whole, 2 * pairs))).collect();
    let (diagram, stable) = stabilisation(&orders);
    let mut candidates = match options.order {
        Some(order) => vec![(order.min(highest), usable(pipeline.poles(&whole, order.min(highest))))],
        None => stable_orders(&orders, &stable),
    };
    let harmonics_hz = without_harmonics(&mut candidates);

    let moved = pipeline.moved(&mean, &of_blocks, highest).ok_or(SamplesError::NoPole)?;
    let (order, found) = best_order(&pipeline, &moved, &candidates).ok_or(SamplesError::NoPole)?;
    Ok(Ambient { found, order, blocks, stride, diagram, harmonics_hz, duration: samples.duration() })
}

/// Takes poles that hardly decay out of all orders; the frequencies of those of the highest one [Hz].
fn without_harmonics(candidates: &mut [(usize, Vec<RawPole>)]) -> Vec<f64> {
    let is_harmonic = |pole: &RawPole| frequency_and_damping(pole.eigenvalue)[1] < HARMONIC;
    let highest = candidates.last().map_or(&[][..], |(_, poles)| poles);
    let found = highest.iter().filter(|pole| is_harmonic(pole)).map(|pole| frequency_and_damping(pole.eigenvalue)[0]);
    let found = found.collect();
    for (_, poles) in candidates {
        poles.retain(|pole| !is_harmonic(pole));
    }
    found
}

/// Least order with the most determined poles, with these poles.
fn best_order(
    pipeline: &SubspacePipeline,
    moved: &[DMat],
    candidates: &[(usize, Vec<RawPole>)],
) -> Option<(usize, PoleSet)> {
    let mut best: Option<(usize, PoleSet)> = None;
    for (order, poles) in candidates {
        let Some(found) = jackknife(pipeline, moved, *order, poles) else { continue };
        let determined: Vec<usize> = (0..poles.len()).filter(|k| is_determined(&found.poles[*k])).collect();
        if determined.len() > best.as_ref().map_or(0, |(_, most)| most.poles.len()) {
            best = Some((*order, found.chosen(&determined)));
        }
    }
    best
}

/// True if the frequency of a pole is better known than half the width of its peak. A vibration is known to a quarter
/// of it in the least record of which the damping ratio is told; a pole that noise has made is known to more than it.
fn is_determined(pole: &IdentifiedPole) -> bool {
    pole.frequency_std_hz < pole.damping_ratio * pole.frequency_hz
}

/// Number of samples between two covariances: the record is sampled faster than its vibrations need.
fn stride(samples: &Samples, rows: usize, blocks: usize) -> usize {
    let values = samples.values();
    let mut least = f64::INFINITY;
    for column in values.column_iter() {
        let mean = column.mean();
        let squares: f64 = column.iter().map(|value| (value - mean).powi(2)).sum();
        let changes: f64 = column.iter().zip(column.iter().skip(1)).map(|(a, b)| (b - a).powi(2)).sum();
        // ω Δt of a sinusoid with these squares.
        least = least.min(std::f64::consts::TAU / (2.0 * (0.5 * (changes / squares).sqrt()).min(1.0).asin()));
    }
    let wanted = (least / MIN_RATE) as usize;
    wanted.clamp(1, (samples.count() / blocks / (2 * rows)).max(1))
}

/// Covariances of a block of samples with lags of 1 to `lags` strides.
fn covariances(samples: &Samples, first: usize, size: usize, lags: usize, stride: usize) -> Vec<DMat> {
    let values = samples.values();
    let mean = values.row_mean();
    (1..=lags)
        .map(|lag| {
            let shift = lag * stride;
            let pairs = size - shift.min(size);
            let mut sum = DMat::zeros(values.ncols(), values.ncols());
            for row in first..first + pairs {
                let (later, now) = (values.row(row + shift) - &mean, values.row(row) - &mean);
                sum += later.transpose() * now;
            }
            sum / pairs.max(1) as f64
        })
        .collect()
}

/// Poles that are vibrations.
fn usable(poles: Vec<RawPole>) -> Vec<RawPole> {
    let is_usable = |pole: &RawPole| (0.0..MAX_DAMPING).contains(&frequency_and_damping(pole.eigenvalue)[1]);
    poles.into_iter().filter(is_usable).collect()
}

/// True if two poles of neighbouring orders are one.
fn is_same(a: &RawPole, b: &RawPole) -> bool {
    let [f, zeta] = frequency_and_damping(a.eigenvalue);
    let [other_f, other_zeta] = frequency_and_damping(b.eigenvalue);
    (f - other_f).abs() < SAME_FREQUENCY * f
        && (zeta - other_zeta).abs() < SAME_DAMPING * zeta
        && mac(&a.shape, &b.shape) > SAME_SHAPE
}

/// Stabilisation diagram, and the poles at the end of the longest rows of orders: (index of the order, index of the
/// pole), one per vibration.
fn stabilisation(orders: &[(usize, Vec<RawPole>)]) -> (Vec<DiagramPole>, Vec<RawPole>) {
    let mut diagram = Vec::new();
    let mut lengths: Vec<Vec<usize>> = Vec::new();
    let mut stable: Vec<RawPole> = Vec::new();
    for (index, (order, poles)) in orders.iter().enumerate() {
        let poles = usable(poles.clone());
        // One order may lack the pole, where another one lies over it.
        let before: Vec<(RawPole, usize)> = (index.saturating_sub(2)..index)
            .flat_map(|i| usable(orders[i].1.clone()).into_iter().zip(lengths[i].clone()))
            .collect();
        let mut own = Vec::with_capacity(poles.len());
        for pole in &poles {
            let kin = before.iter().filter(|(other, _)| is_same(other, pole));
            let longest = kin.map(|(_, length)| *length).max().unwrap_or(0);
            own.push(longest + 1);
            let [frequency_hz, damping_ratio] = frequency_and_damping(pole.eigenvalue);
            let is_stable = longest + 1 >= STABLE_ORDERS;
            diagram.push(DiagramPole { order: *order, frequency_hz, damping_ratio, is_stable });
            if is_stable && !stable.iter().any(|other| is_near(other, pole)) {
                stable.push(pole.clone());
            }
        }
        lengths.push(own);
    }
    (diagram, stable)
}

/// True if a pole of another order is this vibration.
fn is_near(a: &RawPole, b: &RawPole) -> bool {
    let [f, zeta] = frequency_and_damping(a.eigenvalue);
    let [other, _] = frequency_and_damping(b.eigenvalue);
    (f - other).abs() < SAME_FREQUENCY.max(zeta) * f && mac(&a.shape, &b.shape) > 0.8
}

/// Orders that have more of the stable poles than all lower ones, with these poles.
fn stable_orders(orders: &[(usize, Vec<RawPole>)], stable: &[RawPole]) -> Vec<(usize, Vec<RawPole>)> {
    let in_order = |poles: &Vec<RawPole>| -> Vec<RawPole> {
        let poles = usable(poles.clone());
        let mut found: Vec<RawPole> = Vec::new();
        for wanted in stable {
            let near = poles.iter().filter(|pole| is_near(wanted, pole));
            let best = near.max_by(|a, b| mac(&a.shape, &wanted.shape).total_cmp(&mac(&b.shape, &wanted.shape)));
            if let Some(best) = best.filter(|best| !found.iter().any(|of| of.eigenvalue == best.eigenvalue)) {
                found.push(best.clone());
            }
        }
        found.sort_by(|a, b| a.eigenvalue.norm().total_cmp(&b.eigenvalue.norm()));
        found
    };
    let mut growing: Vec<(usize, Vec<RawPole>)> = Vec::new();
    for (order, poles) in orders {
        let found = in_order(poles);
        if found.len() > growing.last().map_or(0, |(_, most)| most.len()) {
            growing.push((*order, found));
        }
    }
    growing
}

/// Numbers of poles: frequency, damping ratio, and the real and imaginary parts of the shape, 1 in its largest channel.
fn numbers(pole: &RawPole, largest: usize) -> Vec<f64> {
    let shape = pole.shape.iter().map(|value| value / pole.shape[largest]);
    frequency_and_damping(pole.eigenvalue).into_iter().chain(shape.flat_map(|value| [value.re, value.im])).collect()
}

/// Poles with their covariance, from the observability matrices that were moved towards each block.
fn jackknife(pipeline: &SubspacePipeline, moved: &[DMat], order: usize, poles: &[RawPole]) -> Option<PoleSet> {
    let largest: Vec<usize> = poles
        .iter()
        .map(|pole| {
            let sizes = pole.shape.iter().map(|value| value.norm()).enumerate();
            sizes.max_by(|a, b| a.1.total_cmp(&b.1)).map_or(0, |(c, _)| c)
        })
        .collect();
    let here: Vec<f64> = poles.iter().zip(&largest).flat_map(|(pole, c)| numbers(pole, *c)).collect();

    let count = moved.len() as f64;
    let mut sum = DMat::zeros(here.len(), here.len());
    for block in moved {
        let found = pipeline.poles(block, order);
        let mut there = Vec::with_capacity(here.len());
        for (pole, c) in poles.iter().zip(&largest) {
            let distance = |other: &&RawPole| (other.eigenvalue - pole.eigenvalue).norm();
            let nearest = found.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
            there.extend(numbers(nearest, *c));
        }
        let difference = DMat::from_iterator(here.len(), 1, there.iter().zip(&here).map(|(a, b)| (a - b) / STEP));
        sum += &difference * difference.transpose();
    }
    let covariance = sum / (count * (count - 1.0));
    if !covariance.iter().all(|entry| entry.is_finite()) {
        return None;
    }

    let width = 2 + 2 * pipeline.channels;
    let deviation = |at: usize| covariance[(at, at)].sqrt();
    let of_pole = |(k, pole): (usize, &RawPole)| {
        let at = k * width;
        let [frequency_hz, damping_ratio] = frequency_and_damping(pole.eigenvalue);
        IdentifiedPole {
            frequency_hz,
            damping_ratio,
            frequency_std_hz: deviation(at),
            damping_std: deviation(at + 1),
            shape: pole.shape.iter().map(|value| value / pole.shape[largest[k]]).collect::<Vec<Complex>>(),
            shape_std: (0..pipeline.channels)
                .map(|c| deviation(at + 2 + 2 * c).hypot(deviation(at + 3 + 2 * c)))
                .collect(),
        }
    };
    let rows: Vec<usize> = (0..poles.len()).flat_map(|k| [k * width, k * width + 1]).collect();
    Some(PoleSet {
        poles: poles.iter().enumerate().map(of_pole).collect(),
        covariance: DMat::from_fn(rows.len(), rows.len(), |a, b| covariance[(rows[a], rows[b])]),
        degrees: count - 1.0,
    })
}

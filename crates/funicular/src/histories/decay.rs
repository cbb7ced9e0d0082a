//! Free decay: number of poles, their fit, and the comparison of both halves.

use super::fitting::{SinusoidFit, SinusoidUnknowns};
use super::poles::{IdentifiedPole, PoleSet, Samples, SamplesError};
use super::realisation::DecaySubspace;
use crate::math::DMat;
use crate::math::least_squares::Minimum;

/// Maximum number of poles.
pub const MAX_POLES: usize = 20;

/// Maximum number of samples of a decay: a fit of seven poles to them in six channels takes some seconds.
pub const MAX_SAMPLES: usize = 20_000;

/// Orders of the subspace beside two per pole, which take up noise.
const SPARE_ORDERS: usize = 4;

/// Maximum number of samples that are averaged to one for the start.
const MAX_STRIDE: usize = 64;

/// Quantile of the normal distribution, in Wilson and Hilferty's formula, by which one more pole has to reduce χ²: once
/// in a million. A pole may lie anywhere, so that noise has as many trials as there are samples.
const SIGNIFICANT: f64 = 4.75;

/// Quantile of the band of χ² and of the correlations of residuals: once in a thousand.
const BAND: f64 = 3.09;

/// Number of lags of the residuals whose correlations are tested.
const LAGS: usize = 20;

/// Number of fits with the deviations of the noise that the fit before has left.
const NOISE_ROUNDS: usize = 3;

/// Number of further poles that are tried after one that did not help, while the residuals are not noise.
const MAX_VAIN: usize = 2;

/// Deviations by which the two halves of a linear decay may differ.
const MAX_DIFFERENCE: f64 = 3.0;

/// Part of a decay.
#[derive(Debug, Clone)]
pub struct PartOfPole {
    /// Frequency [Hz] with its deviation.
    pub frequency_hz: [f64; 2],
    /// Damping ratio with its deviation.
    pub damping_ratio: [f64; 2],
}

/// Pole in both halves of a decay.
#[derive(Debug, Clone)]
pub struct HalvesOfPole {
    /// First and second half.
    pub halves: [PartOfPole; 2],
    /// Largest difference in deviations of the difference.
    pub difference: f64,
}

impl HalvesOfPole {
    /// True if the halves differ by more than noise: the pole changes with the amplitude.
    pub fn differ(&self) -> bool {
        self.difference > MAX_DIFFERENCE
    }
}

/// Poles of a free decay.
#[derive(Debug, Clone)]
pub struct DecayPoles {
    /// Poles with covariance and shapes.
    pub found: PoleSet,
    /// Standard deviation of the noise of each channel: the given one, or that of the residuals.
    pub noise: Vec<f64>,
    /// Sum of the squares of the residuals over the noise.
    pub chi2: f64,
    /// Samples less unknowns.
    pub degrees: f64,
    /// Range of χ² per degree that noise leaves, 99.8 %; for an unknown noise, that of [`DecayPoles::correlation`].
    pub band: [f64; 2],
    /// Mean square of the correlations of neighbouring residuals, times the number of samples: 1 for noise.
    pub correlation: f64,
    /// True if the residuals are noise. Otherwise the deviations have been multiplied by the square root of what is
    /// outside the band.
    pub is_noise: bool,
    /// Poles in both halves, in the order of the poles; absent where a half has no minimum.
    pub halves: Vec<Option<HalvesOfPole>>,
}

/// Fit with a number of poles.
struct Fitted {
    minimum: Minimum,
    noise: Vec<f64>,
    /// Unknowns.
    x: SinusoidUnknowns,
}

/// Number of samples of all channels less the number of unknowns.
fn degrees(samples: &Samples, poles: usize) -> f64 {
    let unknowns = 2 * poles + samples.channels() * (2 * poles + 1);
    ((samples.count() * samples.channels()) as f64 - unknowns as f64).max(1.0)
}

/// Quantile of χ² by Wilson and Hilferty, at a quantile of the normal distribution.
fn chi2_quantile(degrees: f64, normal: f64) -> f64 {
    let width = 2.0 / (9.0 * degrees);
    degrees * (1.0 - width + normal * width.sqrt()).max(0.0).powi(3)
}

/// Poles of a free decay. `noise` is the standard deviation of each channel where it is known.
///
/// Poles are added while they reduce χ² by more than noise does, at most [`MAX_POLES`] or as many as `poles` says.
///
/// # Errors
/// More than [`MAX_SAMPLES`] samples are the caller's to shorten; a history in which no pole is found is refused.
///
/// # Example
/// ```
/// use funicular::histories::{Samples, decay};
///
/// // 2 Hz with 1 % of damping, and a little noise.
/// let time: Vec<f64> = (0..400).map(|k| 0.02 * f64::from(k)).collect();
/// let noise = |t: &f64| 1e-4 * (t * 1e5).sin();
/// let values = time.iter().map(|t| (-0.12566 * t).exp() * (12.566 * t).cos() + noise(t)).collect();
/// let found = decay::identify(&Samples::new(time, &[values])?, None, None)?;
/// assert!((found.found.poles[0].frequency_hz - 2.0).abs() < 1e-3);
/// # Ok::<(), funicular::histories::SamplesError>(())
/// ```
///
/// # References
/// J.-N. Juang, R. S. Pappa (1985), for the start; G. H. Golub, V. Pereyra (1973), L. Kaufman (1975), for the fit.
pub fn identify(samples: &Samples, noise: Option<&[f64]>, poles: Option<usize>) -> Result<DecayPoles, SamplesError> {
    let mut stride = 1;
    let mut subspaces = Vec::new();
    while stride <= MAX_STRIDE {
        subspaces.extend(DecaySubspace::of(samples, stride));
        stride *= 2;
    }
    let highest = poles.unwrap_or(MAX_POLES).min(MAX_POLES).min((samples.count() / 3).saturating_sub(2));

    let mut best: Option<Fitted> = None;
    let mut latest: Option<Fitted> = None;
    let mut vain = 0;
    for count in 1..=highest {
        let Some(found) = fitted(samples, &subspaces, noise, latest.as_ref(), count) else { break };
        let helps = best.as_ref().is_none_or(|best| is_better(samples, best, &found));
        if helps {
            vain = 0;
            best = Some(copied(&found));
        } else {
            vain += 1;
        }
        latest = Some(found);
        let is_enough = best.as_ref().is_some_and(|best| is_noise(samples, best, noise.is_some()));
        if poles.is_none() && (vain > MAX_VAIN || vain > 0 && is_enough) {
            break;
        }
    }
    let best = if poles.is_some() { latest } else { best };
    finished(samples, best.ok_or(SamplesError::NoPole)?, noise.is_some())
}

fn copied(fitted: &Fitted) -> Fitted {
    Fitted { minimum: fitted.minimum.clone(), noise: fitted.noise.clone(), x: fitted.x.clone() }
}

/// Fit with this number of poles, from the subspaces and from the fit with one pole less.
fn fitted(
    samples: &Samples,
    subspaces: &[DecaySubspace],
    known: Option<&[f64]>,
    before: Option<&Fitted>,
    count: usize,
) -> Option<Fitted> {
    let spreads = || (0..samples.channels()).map(|c| samples.spread(c)).collect();
    let noise = before.map(|before| before.noise.clone());
    let mut fit = SinusoidFit::new(samples, known.map(<[f64]>::to_vec).or(noise).unwrap_or_else(spreads));

    let mut starts: Vec<(f64, SinusoidUnknowns)> = Vec::new();
    let total = |fit: &SinusoidFit<'_>, x: &SinusoidUnknowns| fit.squares(x).map(|squares| squares.iter().sum::<f64>());
    for subspace in subspaces {
        let candidates = candidates(samples, subspace, 2 * count + SPARE_ORDERS);
        let Some(start) = fit.strongest(&candidates, count) else { continue };
        if start.len() == 2 * count
            && let Some(chi2) = total(&fit, &start)
        {
            starts.push((chi2, start));
        }
    }
    starts.sort_by(|a, b| a.0.total_cmp(&b.0));
    starts.truncate(1);
    if let Some(before) = before.filter(|before| before.x.len() == 2 * (count - 1)) {
        starts.extend(with_one_more(samples, &fit, &before.x).into_iter().map(|start| (0.0, start)));
    }

    let found = starts.iter().filter_map(|(_, start)| fit.fit(start));
    let mut minimum = found.min_by(|a, b| a.chi2().total_cmp(&b.chi2()))?;
    if known.is_none() {
        for _ in 0..NOISE_ROUNDS {
            fit.noise = residual_noise(samples, &fit, &minimum.x)?;
            minimum = fit.fit(&minimum.x.clone())?;
        }
    }
    Some(Fitted { x: minimum.x.clone(), noise: fit.noise, minimum })
}

/// Decaying poles of a subspace below the Nyquist frequency.
fn candidates(samples: &Samples, subspace: &DecaySubspace, order: usize) -> SinusoidUnknowns {
    let slowest = 1.0 / samples.duration();
    let poles = subspace.poles(order);
    let decaying = poles.iter().map(|pole| [-pole.eigenvalue.re, pole.eigenvalue.im]);
    decaying.filter(|[alpha, omega]| *alpha > -0.5 * slowest && *omega > slowest && alpha < omega).flatten().collect()
}

/// Start with the strongest pole of the residuals beside the poles of a fit.
fn with_one_more(samples: &Samples, fit: &SinusoidFit<'_>, x: &SinusoidUnknowns) -> Option<SinusoidUnknowns> {
    let rest = fit.rest(x)?;
    let channels: Vec<Vec<f64>> = rest.column_iter().map(|column| column.iter().copied().collect()).collect();
    let rest = Samples::new(samples.time().to_vec(), &channels).ok()?;
    let subspace = DecaySubspace::of(&rest, 1)?;
    let of_rest = SinusoidFit::new(&rest, fit.noise.clone());
    let one = of_rest.strongest(&candidates(&rest, &subspace, 2 + SPARE_ORDERS), 1)?;
    (one.len() == 2).then(|| [x.as_slice(), &one].concat())
}

/// Standard deviations of the residuals, corrected for the unknowns.
fn residual_noise(samples: &Samples, fit: &SinusoidFit<'_>, x: &SinusoidUnknowns) -> Option<Vec<f64>> {
    let rest = fit.rest(x)?;
    let degrees = degrees(samples, x.len() / 2) / samples.channels() as f64;
    let least = |c: usize| 1e-12 * samples.spread(c);
    Some((0..rest.ncols()).map(|c| (rest.column(c).norm() / degrees.sqrt()).max(least(c))).collect())
}

/// True if a fit with more poles is better by more than noise makes it.
fn is_better(samples: &Samples, fewer: &Fitted, more: &Fitted) -> bool {
    let channels = samples.channels();
    let added = (more.x.len() - fewer.x.len()) / 2;
    let extra = (2 * added * (channels + 1)) as f64;
    let fits = [fewer, more].map(|of| SinusoidFit::new(samples, more.noise.clone()).squares(&of.x));
    let [Some(before), Some(after)] = fits else { return false };
    // Ratio of likelihoods in which each channel has the noise that it leaves.
    let gain: f64 = before.iter().zip(&after).map(|(a, b)| samples.count() as f64 * (a / b).ln()).sum();
    gain > chi2_quantile(extra, SIGNIFICANT)
}

/// Mean over channels and lags of the squared correlation of residuals, times the number of samples.
fn correlation(rest: &DMat) -> f64 {
    let count = rest.nrows();
    let lags = LAGS.min(count / 4);
    let of = |c: usize, lag: usize| {
        let column = rest.column(c);
        let product = column.rows(lag, count - lag).dot(&column.rows(0, count - lag));
        (product / column.norm_squared().max(f64::MIN_POSITIVE)).powi(2) * (count as f64).powi(2) / (count - lag) as f64
    };
    let sum: f64 = (0..rest.ncols()).flat_map(|c| (1..=lags).map(move |lag| (c, lag))).map(|(c, lag)| of(c, lag)).sum();
    sum / (rest.ncols() * lags) as f64
}

/// Quantity that noise keeps near 1, with its band: χ² per degree for a known noise, otherwise the correlation.
fn tested(samples: &Samples, fitted: &Fitted, is_known: bool) -> Option<(f64, [f64; 2])> {
    let band = |degrees: f64| [-BAND, BAND].map(|normal| chi2_quantile(degrees, normal) / degrees);
    if is_known {
        let degrees = degrees(samples, fitted.x.len() / 2);
        return Some((fitted.minimum.chi2() / degrees, band(degrees)));
    }
    let rest = SinusoidFit::new(samples, fitted.noise.clone()).rest(&fitted.x)?;
    Some((correlation(&rest), band((samples.channels() * LAGS.min(samples.count() / 4)) as f64)))
}

/// True if the residuals are noise.
fn is_noise(samples: &Samples, fitted: &Fitted, is_known: bool) -> bool {
    tested(samples, fitted, is_known).is_some_and(|(value, [_, highest])| value <= highest)
}

fn finished(samples: &Samples, best: Fitted, is_known: bool) -> Result<DecayPoles, SamplesError> {
    let degrees = degrees(samples, best.x.len() / 2);
    let chi2 = best.minimum.chi2();
    let (value, band) = tested(samples, &best, is_known).ok_or(SamplesError::NoPole)?;
    let is_noise = value <= band[1];
    let factor = if is_noise { 1.0 } else { value.max(1.0) };
    let fit = SinusoidFit::new(samples, best.noise.clone());
    let freedom = if is_known && is_noise { f64::INFINITY } else { degrees };
    let found = fit.pole_set(&best.minimum, factor, freedom).ok_or(SamplesError::NoPole)?;
    let rest = fit.rest(&best.x).ok_or(SamplesError::NoPole)?;

    let halves = halves(samples, &best, &found.poles);
    Ok(DecayPoles { found, noise: best.noise, chi2, degrees, band, correlation: correlation(&rest), is_noise, halves })
}

/// Poles of both halves, from the poles of the whole.
fn halves(samples: &Samples, best: &Fitted, poles: &[IdentifiedPole]) -> Vec<Option<HalvesOfPole>> {
    let middle = samples.count() / 2;
    let parts = [samples.part(0..middle), samples.part(middle..samples.count())];
    let sets = parts.each_ref().map(|part| {
        let mut fit = SinusoidFit::new(part, best.noise.clone());
        let minimum = fit.fit(&best.x)?;
        fit.pole_set(&minimum, 1.0, f64::INFINITY)
    });
    let [Some(first), Some(second)] = sets else { return vec![None; poles.len()] };
    let part = |pole: &IdentifiedPole| PartOfPole {
        frequency_hz: [pole.frequency_hz, pole.frequency_std_hz],
        damping_ratio: [pole.damping_ratio, pole.damping_std],
    };
    let distance = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).abs() / a[1].hypot(b[1]);
    let of_pole = |k: usize| {
        let halves = [part(&first.poles[k]), part(&second.poles[k])];
        // A pole that a half does not determine says nothing.
        let is_seen = halves.iter().all(|half| {
            (half.frequency_hz[0] - poles[k].frequency_hz).abs() < 0.05 * poles[k].frequency_hz
                && half.frequency_hz[1] < 0.05 * half.frequency_hz[0]
        });
        let [a, b] = &halves;
        let difference = distance(a.frequency_hz, b.frequency_hz).max(distance(a.damping_ratio, b.damping_ratio));
        is_seen.then_some(HalvesOfPole { halves, difference })
    };
    (0..poles.len()).map(of_pole).collect()
}

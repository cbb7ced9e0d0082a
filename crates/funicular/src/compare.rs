//! Cable models side by side: what each finds below a frequency, and the simplest that is good enough.

use crate::cable::{CableModel, SHALLOW_SAG_LIMIT, Sag};
use crate::dynamics::{Dynamics, DynamicsError, Linearisation};
use crate::math::{Mat6, Vec6};
use crate::modes::{self, Mode, Modes};
use crate::robot::Robot;
use crate::statics::Equilibrium;
use std::f64::consts::TAU;

/// Relative difference of frequency up to which a model counts as good enough.
pub const TOLERANCE: f64 = 0.01;

/// Correlation of platform shapes from which on two modes count as the same motion.
pub const SAME_MOTION: f64 = 0.5;

/// Two modes whose frequencies differ by more than this factor are not the same motion, however alike the platform
/// moves: with 20 cable resonances in between, some shape always fits.
const SAME_RANGE: f64 = 2.0;

/// Relative difference of frequency up to which modes of two models with vibrating cables can be the same.
const SAME_FREQUENCY: f64 = 0.2;

/// All models at one equilibrium.
#[derive(Debug, Clone, PartialEq)]
pub struct Comparison {
    /// Upper limit of the frequencies [Hz].
    pub below_hz: f64,
    /// The model the others are measured against.
    pub reference: CableModel,
    /// One entry a model, in the order of [`CableModel::ALL`].
    pub models: Vec<ModelResult>,
    /// Which one to use.
    pub advice: Advice,
}

/// What one model finds.
#[derive(Debug, Clone, PartialEq)]
pub struct ModelResult {
    /// The model.
    pub model: CableModel,
    /// Its modes below the limit, or why there are none.
    pub modes: Result<Modes, DynamicsError>,
    /// Its modes that have a counterpart in the reference. Of constant stiffnesses: the mode that moves the platform most
    /// alike, with a correlation of at least [`SAME_MOTION`] and a frequency within a factor of two. Of vibrating
    /// cables, most of whose modes hardly move the platform: the nearest in frequency. None for the reference.
    pub matches: Vec<Match>,
    /// Modes of the reference that it has no counterpart of.
    pub missed: usize,
    /// First frequency of the reference that it lacks or has wrong by more than [`TOLERANCE`] [Hz].
    pub first_wrong_hz: Option<f64>,
}

/// A mode and its counterpart in the reference.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Match {
    /// Frequency in this model [Hz].
    pub frequency_hz: f64,
    /// Frequency of the counterpart [Hz].
    pub reference_hz: f64,
    /// Its place in the reference's list, from 0.
    pub reference_index: usize,
    /// `frequency/reference − 1`.
    pub relative_difference: f64,
    /// Correlation of the platform shapes in the mass metric, 0 to 1.
    pub correlation: f64,
}

/// The simplest model that is good enough.
#[derive(Debug, Clone, PartialEq)]
pub struct Advice {
    /// The model.
    pub model: CableModel,
    /// A sentence or two: which, and why.
    pub text: String,
}

/// Finds the modes below `below_hz` [Hz] with every model and measures each against the catenary-dynamic cable,
/// or against the closed form where the catenary-dynamic cable would need more unknowns than it may have. The model in
/// `linearisation` is ignored; assembly and plane hold for all.
///
/// # Errors
/// [`DynamicsError`] if the reference does not exist at this equilibrium (a cable without tension).
pub fn compare(
    robot: &Robot,
    equilibrium: &Equilibrium,
    below_hz: f64,
    linearisation: Linearisation,
) -> Result<Comparison, DynamicsError> {
    let with =
        |cable_model| Dynamics::about(robot, equilibrium, Linearisation { cable_model, ..linearisation }, below_hz);
    let (reference, dynamics) = match with(CableModel::CatenaryDynamic) {
        Ok(dynamics) => (CableModel::CatenaryDynamic, dynamics),
        // Too many unknowns for one cable; the next best is the closed form, which has no such limit.
        Err(DynamicsError::CatenaryDynamic { .. }) => (CableModel::ShallowDynamic, with(CableModel::ShallowDynamic)?),
        Err(other) => return Err(other),
    };

    let truth = modes::below(&dynamics, below_hz);
    let models: Vec<ModelResult> = CableModel::ALL
        .into_iter()
        .map(|model| {
            if model == reference {
                let modes = Ok(truth.clone());
                return ModelResult { model, modes, matches: Vec::new(), missed: 0, first_wrong_hz: None };
            }
            let modes = with(model).map(|dynamics| modes::below(&dynamics, below_hz));
            let found = modes.as_ref().map_or(&[][..], |m| &m.modes);
            let matches = match_modes(found, &truth.modes, &dynamics.mass(), model.is_dynamic());

            // How many modes of the reference are hit, and which within the tolerance.
            let mut hit = vec![false; truth.modes.len()];
            let mut right = hit.clone();
            for m in &matches {
                hit[m.reference_index] = true;
                right[m.reference_index] |= m.relative_difference.abs() <= TOLERANCE;
            }
            let mut missed = hit.iter().filter(|h| !**h).count();

            if model.is_dynamic() {
                // It has the cables' resonances, too; among dozens of them shapes of the platform tell little, and what
                // counts is whether each frequency is there.
                right = frequencies_within(TOLERANCE, found, &truth.modes);
                missed = truth.modes.len().saturating_sub(found.len());
            }

            let first_wrong_hz = right.iter().position(|r| !r).map(|i| truth.modes[i].frequency_hz);
            ModelResult { model, modes, matches, missed, first_wrong_hz }
        })
        .collect();
    let advice = advise(robot, equilibrium, &dynamics, below_hz, &truth, &models);
    Ok(Comparison { below_hz, reference, models, advice })
}

/// Which modes of the ascending list `truth` have one of their own in the ascending list `found`, within a relative
/// tolerance of frequency.
fn frequencies_within(tolerance: f64, found: &[Mode], truth: &[Mode]) -> Vec<bool> {
    let mut left = found.iter().peekable();
    truth
        .iter()
        .map(|wanted| {
            while left.next_if(|m| m.frequency_hz < wanted.frequency_hz * (1.0 - tolerance)).is_some() {}
            left.next_if(|m| m.frequency_hz <= wanted.frequency_hz * (1.0 + tolerance)).is_some()
        })
        .collect()
}

/// Pairs every mode with the reference mode of the most similar platform motion, weighed by how much of that mode is
/// the platform's; or, `by_frequency`, with the nearest. Each reference mode serves once.
fn match_modes(found: &[Mode], truth: &[Mode], mass: &Mat6, by_frequency: bool) -> Vec<Match> {
    let vector = |m: &Mode| Vec6::from_row_slice(&m.shape);
    let inner = |a: &Vec6, b: &Vec6| a.dot(&(mass * b));

    // Every pair that may be one motion, with a score.
    let mut candidates = Vec::new();
    for (i, ours) in found.iter().enumerate() {
        let x = vector(ours);
        for (j, theirs) in truth.iter().enumerate() {
            let y = vector(theirs);
            let (own, other) = (inner(&x, &x), inner(&y, &y));
            // Two vibrations of cables beside a platform at rest are alike if their frequencies are.
            let both_at_rest = own == 0.0 && other == 0.0;
            if !(both_at_rest || own * other > 0.0 || by_frequency) {
                continue;
            }

            let correlation = if both_at_rest { 1.0 } else { modes::mac(&x, &y, inner) };

            let ratio = ours.frequency_hz / theirs.frequency_hz;
            let distance = (1.0 - ratio).abs();
            let score = if by_frequency {
                if distance > SAME_FREQUENCY {
                    continue;
                }
                // Two of nearly the same frequency: the more alike.
                -distance + 0.1 * TOLERANCE * correlation
            } else {
                if correlation < SAME_MOTION || !(1.0 / SAME_RANGE..=SAME_RANGE).contains(&ratio) {
                    continue;
                }
                correlation * theirs.platform_energy_fraction - 1e-6 * distance
            };
            candidates.push((score, correlation, i, j));
        }
    }

    // The best pairs first.
    candidates.sort_by(|a, b| b.0.total_cmp(&a.0));
    let (mut done, mut used) = (vec![None; found.len()], vec![false; truth.len()]);
    for (_, correlation, i, j) in candidates {
        if done[i].is_none() && !used[j] {
            used[j] = true;
            let (frequency_hz, reference_hz) = (found[i].frequency_hz, truth[j].frequency_hz);
            done[i] = Some(Match {
                frequency_hz,
                reference_hz,
                reference_index: j,
                relative_difference: frequency_hz / reference_hz - 1.0,
                correlation,
            });
        }
    }

    done.into_iter().flatten().collect()
}

fn advise(
    robot: &Robot,
    equilibrium: &Equilibrium,
    dynamics: &Dynamics,
    below_hz: f64,
    truth: &Modes,
    models: &[ModelResult],
) -> Advice {
    let sags: Vec<Sag> = equilibrium.cables.iter().enumerate().map(|(i, state)| Sag::of(robot, i, state)).collect();
    let deepest = (0..sags.len()).max_by(|&i, &j| sags[i].ratio().total_cmp(&sags[j].ratio())).unwrap_or(0);
    let ratio = sags[deepest].ratio();
    let lambda2 = sags.iter().map(|s| s.lambda2).fold(0.0, f64::max);

    // What the cables do below the limit.
    let cable_modes = truth.modes.iter().filter(|m| m.platform_energy_fraction < 0.5).count();
    let clamped = dynamics.clamped_frequencies_below(below_hz * TAU);
    let string = match clamped.first() {
        Some((omega, cable)) => format!(
            "the first cable resonance, {:.3} Hz of cable \"{}\", lies below the {below_hz} Hz asked",
            omega / TAU,
            robot.cables[*cable].name
        ),
        None => format!("no cable resonance lies below the {below_hz} Hz asked"),
    };

    // The simplest model that is right.
    let reference = dynamics.linearisation.cable_model;
    let simplest = models.iter().find(|m| m.modes.is_ok() && m.first_wrong_hz.is_none()).map_or(reference, |m| m.model);
    let percent = 100.0 * TOLERANCE;
    let result = |model: CableModel| models.iter().find(|m| m.model == model);
    let lost = result(CableModel::CatenaryStatic).map_or(0, |m| m.missed);
    let total = truth.modes.len();

    let constant = format!(
        "{string}, {cable_modes} of the {total} modes there have most of their energy in the cables, and a constant cable \
         stiffness misses {lost} of them"
    );

    let choice = match simplest {
        _ if truth.modes.is_empty() => {
            format!("Use `{simplest}`: no natural frequency lies below {below_hz} Hz with any model")
        }
        model if model == reference => {
            let wrong = result(CableModel::ShallowDynamic).and_then(|m| m.first_wrong_hz);
            let closed = wrong.map_or(String::new(), |hz| {
                format!("; the closed form lacks the one at {hz:.3} Hz or has it wrong by more than {percent} %")
            });
            format!("Use `{model}`: {constant}{closed}")
        }
        CableModel::ShallowDynamic => {
            format!(
                "Use `shallow-dynamic`, which has all {total} within {percent} % of the {reference} ones: {constant}"
            )
        }
        _ => format!(
            "Use `{simplest}`: it has all {total} modes below {below_hz} Hz within {percent} % of the {reference} ones; {string}"
        ),
    };

    let range = if ratio > SHALLOW_SAG_LIMIT {
        " The sag is beyond d/l = 1/20, the range of the closed form: take its cable resonances as approximate."
    } else {
        ""
    };
    let cable = &robot.cables[deepest].name;
    let text =
        format!("{choice} (largest sag d/l = {ratio:.4} at cable \"{cable}\", largest λ² = {lambda2:.1}).{range}");
    Advice { model: simplest, text }
}

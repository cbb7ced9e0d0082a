//! Comparison of the cable models: natural frequencies of each below a limit, and the simplest model that is good
//! enough.

use crate::cable::{CableModel, SHALLOW_SAG_LIMIT, Sag};
use crate::dynamics::{Dynamics, DynamicsError, Linearisation};
use crate::math::{Mat6, Vec6};
use crate::modes::{self, Mode, Modes};
use crate::robot::Robot;
use crate::statics::Equilibrium;
use std::f64::consts::TAU;

/// Maximum relative difference of frequency for a model that is good enough.
pub const TOLERANCE: f64 = 0.01;

/// Minimum MAC of the platform shapes of two modes that count as the same motion.
pub const SAME_MOTION: f64 = 0.5;

/// Maximum ratio of the frequencies of two modes that count as the same motion. With 20 cable resonances in between,
/// there is always a mode with a similar platform shape.
const SAME_RANGE: f64 = 2.0;

/// Maximum relative difference of frequency for modes of two dynamic models that can be the same.
const SAME_FREQUENCY: f64 = 0.2;

/// Results of all models at one equilibrium.
#[derive(Debug, Clone, PartialEq)]
pub struct Comparison {
    /// Upper limit of the frequencies [Hz].
    pub below_hz: f64,
    /// Reference model, with which the others are compared.
    pub reference: CableModel,
    /// One result per model, in the order of [`CableModel::ALL`].
    pub models: Vec<ModelResult>,
    /// Recommended model.
    pub advice: Advice,
}

/// Results of one model.
#[derive(Debug, Clone, PartialEq)]
pub struct ModelResult {
    /// Cable model.
    pub model: CableModel,
    /// Modes below the limit, or the reason for which there are none.
    pub modes: Result<Modes, DynamicsError>,
    /// Modes that have a counterpart in the reference; empty for the reference itself.
    ///
    /// For a constant stiffness the counterpart is the mode with the most similar platform motion, with a MAC of at
    /// least [`SAME_MOTION`] and a frequency within a factor of two. For a dynamic model, most of whose modes hardly
    /// move the platform, it is the nearest in frequency.
    pub matches: Vec<Match>,
    /// Number of modes of the reference without a counterpart.
    pub missed: usize,
    /// First frequency of the reference that is missing or wrong by more than [`TOLERANCE`] [Hz].
    pub first_wrong_hz: Option<f64>,
}

/// Mode and its counterpart in the reference.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Match {
    /// Frequency in this model [Hz].
    pub frequency_hz: f64,
    /// Frequency of the counterpart [Hz].
    pub reference_hz: f64,
    /// Index of the counterpart in the reference's list, from 0.
    pub reference_index: usize,
    /// Relative difference `frequency/reference − 1`.
    pub relative_difference: f64,
    /// MAC of the platform shapes with the mass matrix, 0 to 1.
    pub correlation: f64,
}

/// Simplest model that is good enough.
#[derive(Debug, Clone, PartialEq)]
pub struct Advice {
    /// Recommended model.
    pub model: CableModel,
    /// Recommendation with its reason, in one or two sentences.
    pub text: String,
}

/// Finds the modes below `below_hz` [Hz] with every cable model and compares them with the catenary-dynamic model. If a
/// catenary-dynamic cable would need too many unknowns, the reference is the shallow-dynamic model. The cable model in
/// `linearisation` is ignored; its other options apply to all models.
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
        // Too many unknowns for one cable: the next best reference is the shallow-dynamic model, which has no such
        // limit.
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
                // A dynamic model also has the cables' resonances. Among dozens of them the platform shapes distinguish
                // little; each frequency counts as right if the model has it.
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

/// True for each mode of the ascending list `truth` that has its own partner in the ascending list `found`, within a
/// relative tolerance of frequency.
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

/// Pairs every mode with the reference mode of the most similar platform motion, weighted by the platform's energy
/// fraction in that mode; with `by_frequency`, with the nearest in frequency. Each reference mode is used once.
fn match_modes(found: &[Mode], truth: &[Mode], mass: &Mat6, by_frequency: bool) -> Vec<Match> {
    let vector = |m: &Mode| Vec6::from_row_slice(&m.shape);
    let inner = |a: &Vec6, b: &Vec6| a.dot(&(mass * b));

    // Every pair that may be the same motion, with a score.
    let mut candidates = Vec::new();
    for (i, ours) in found.iter().enumerate() {
        let x = vector(ours);
        for (j, theirs) in truth.iter().enumerate() {
            let y = vector(theirs);
            let (own, other) = (inner(&x, &x), inner(&y, &y));
            // Two vibrations of cables with the platform at rest are the same motion if their frequencies agree.
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
                // For nearly equal frequencies the MAC decides.
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

/// Recommends the simplest model that has all frequencies of the reference.
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

    // Vibrations of the cables below the limit. A cable with fixed ends gives no lower bound for them: with the moving
    // platform there are modes of the cables below it.
    let mut of_cables = truth.modes.iter().filter(|m| m.platform_energy_fraction < 0.5).map(|m| m.frequency_hz);
    let first_of_cables = of_cables.next();
    let cable_modes = usize::from(first_of_cables.is_some()) + of_cables.count();
    let clamped = dynamics.clamped_frequencies_below(below_hz * TAU);
    let string = match clamped.first() {
        Some((omega, cable)) => format!(
            "with fixed ends the cables resonate from {:.3} Hz on (cable \"{}\"), below the limit of {below_hz} Hz",
            omega / TAU,
            robot.cables[*cable].name
        ),
        None => format!("with fixed ends no cable resonates below the limit of {below_hz} Hz"),
    };

    // The simplest model that has all frequencies.
    let reference = dynamics.linearisation.cable_model;
    let simplest = models.iter().find(|m| m.modes.is_ok() && m.first_wrong_hz.is_none()).map_or(reference, |m| m.model);
    let percent = 100.0 * TOLERANCE;
    let result = |model: CableModel| models.iter().find(|m| m.model == model);
    let lost = result(CableModel::CatenaryStatic).map_or(0, |m| m.missed);
    let total = truth.modes.len();

    let first = first_of_cables.map_or(String::new(), |hz| format!(" (the first at {hz:.3} Hz)"));
    let constant = format!(
        "{string}; with the moving platform {cable_modes} of the {total} modes there have most of their energy in the \
         cables{first}, and a constant cable stiffness misses {lost} of them"
    );

    let choice = match simplest {
        _ if truth.modes.is_empty() => {
            format!("Use `{simplest}`: no natural frequency lies below {below_hz} Hz with any model")
        }
        model if model == reference => {
            let wrong = result(CableModel::ShallowDynamic).and_then(|m| m.first_wrong_hz);
            let closed = wrong.map_or(String::new(), |hz| {
                format!("; `shallow-dynamic` lacks the mode at {hz:.3} Hz or has it wrong by more than {percent} %")
            });
            format!("Use `{model}`: {constant}{closed}")
        }
        CableModel::ShallowDynamic => {
            format!(
                "Use `shallow-dynamic`: it has all {total} modes below {below_hz} Hz within {percent} % of those by \
                 `{reference}`; {constant}"
            )
        }
        _ => format!(
            "Use `{simplest}`: it has all {total} modes below {below_hz} Hz within {percent} % of those by \
             `{reference}`; {string}"
        ),
    };

    let range = if ratio > SHALLOW_SAG_LIMIT {
        " The maximum sag is beyond d/l = 1/20, the range of `shallow-dynamic`: its cable resonances are approximate."
    } else {
        ""
    };
    let cable = &robot.cables[deepest].name;
    let text =
        format!("{choice} (maximum sag d/l = {ratio:.4} at cable \"{cable}\", maximum λ² = {lambda2:.1}).{range}");
    Advice { model: simplest, text }
}

//! Comparison of the cable models: natural frequencies of each below a limit, and the simplest model that is good
//! enough.

use crate::cable::catenary_dynamic::CatenaryDynamicError;
use crate::cable::{CableModel, SHALLOW_SAG_LIMIT, Sag};
use crate::dynamics::{Dynamics, DynamicsError, Linearisation};
use crate::math::{Mat6, Vec6, order};
use crate::modes::{self, Mode, Modes};
use crate::robot::Robot;
use crate::statics::Equilibrium;
use std::f64::consts::TAU;

/// Maximum relative difference of frequency for a model that is good enough.
pub const TOLERANCE: f64 = 0.01;

/// Modes of the reference that are compared, and the accuracy required of their frequencies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Criterion {
    /// Maximum relative difference of frequency for a model that is good enough.
    pub tolerance: f64,
    /// Minimum fraction of the kinetic energy in the platform for a mode that is compared; `None` compares all modes.
    pub platform_share: Option<f64>,
}

impl Default for Criterion {
    fn default() -> Self {
        Self { tolerance: TOLERANCE, platform_share: None }
    }
}

impl Criterion {
    /// Tolerance in per cent, without the rounding of the product.
    pub fn percent(&self) -> f64 {
        (1e10 * self.tolerance).round() * 1e-8
    }

    /// True if a mode of the reference is compared.
    pub fn includes(&self, mode: &Mode) -> bool {
        self.platform_share.is_none_or(|share| mode.platform_energy_fraction >= share)
    }
}

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
    /// Modes that are compared, and the required accuracy.
    pub criterion: Criterion,
    /// Indices of the compared modes in the list of the reference, ascending.
    pub compared: Vec<usize>,
    /// Reference model, with which the others are compared.
    pub reference: CableModel,
    /// Result of each model, in the order of [`CableModel::ALL`].
    pub models: Vec<ModelResult>,
    /// Recommended model.
    pub advice: Advice,
    /// Modes for which a static sag model is worse than a spring, if there are any.
    pub frozen_sag: Option<FrozenSag>,
}

/// Modes above the first cable resonance for which a model with static sag is too soft and farther off than a spring.
///
/// Static sag follows every motion of the platform. Above the resonance of a cable its inertia keeps the sag from
/// following, so that the cable answers like a spring along its chord.
#[derive(Debug, Clone, PartialEq)]
pub struct FrozenSag {
    /// Model with static sag, `catenary-static` or `shallow-static`.
    pub model: CableModel,
    /// Number of such modes.
    pub modes: usize,
    /// Frequency of the first one in the reference [Hz].
    pub frequency_hz: f64,
    /// Relative difference of its frequency with static sag.
    pub static_difference: f64,
    /// Relative difference of its frequency with springs.
    pub spring_difference: f64,
    /// First clamped frequency of a cable [Hz].
    pub clamped_hz: f64,
}

impl FrozenSag {
    /// Explanation in two sentences.
    pub fn text(&self) -> String {
        let Self { model, modes, frequency_hz, static_difference, spring_difference, clamped_hz } = self;
        let others = match modes - 1 {
            0 => String::new(),
            more => format!(" (and at {})", crate::counted(more, "further mode")),
        };
        format!(
            "At {frequency_hz:.4} Hz{others} `{model}` ({:+.1} %) is worse than `spring` ({:+.1} %). This mode lies \
             above the first resonance of a cable with fixed ends, {clamped_hz:.3} Hz: there the inertia of the cables \
             keeps their sag from following the platform, so that a cable answers like a spring, while a static model \
             lets the sag follow at every frequency and is too soft.",
            100.0 * static_difference,
            100.0 * spring_difference
        )
    }
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
    /// move the platform, modes are paired in the order of their frequencies. If only modes of the platform are
    /// compared, the motion decides for every model.
    pub matches: Vec<Match>,
    /// Number of compared modes of the reference without a counterpart.
    pub missed: usize,
    /// Number of compared modes of the reference that the model has within the tolerance.
    pub within: usize,
    /// Largest relative difference, with its sign, of the compared modes that have a counterpart.
    pub largest_difference: Option<f64>,
    /// First compared frequency of the reference that is missing or wrong by more than the tolerance [Hz].
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
    /// Recommendation with its reason, in a few short lines.
    pub text: String,
}

/// Finds the modes below `below_hz` [Hz] with every cable model and compares them with the catenary-dynamic model. If a
/// catenary-dynamic cable would need too many unknowns, the reference is the shallow-dynamic model. The cable model in
/// `linearisation` is ignored; its other fields apply to all models. The criterion selects the modes that count.
///
/// # Errors
/// [`DynamicsError`] if the reference does not exist at this equilibrium (a cable without tension, ideal cables).
pub fn compare(
    robot: &Robot,
    equilibrium: &Equilibrium,
    below_hz: f64,
    linearisation: Linearisation,
    criterion: Criterion,
) -> Result<Comparison, DynamicsError> {
    let with =
        |cable_model| Dynamics::about(robot, equilibrium, Linearisation { cable_model, ..linearisation }, below_hz);
    let (reference, dynamics) = match with(CableModel::CatenaryDynamic) {
        Ok(dynamics) => (CableModel::CatenaryDynamic, dynamics),
        // Too many unknowns for one cable: the next best reference is the shallow-dynamic model, which has no such
        // limit. Every other error says that the robot has no linear vibration at this equilibrium.
        Err(DynamicsError::CatenaryDynamic { reason: CatenaryDynamicError::TooFine { .. }, .. }) => {
            (CableModel::ShallowDynamic, with(CableModel::ShallowDynamic)?)
        }
        Err(other) => return Err(other),
    };

    let truth = modes::below(&dynamics, below_hz);
    let compared: Vec<usize> = (0..truth.modes.len()).filter(|&i| criterion.includes(&truth.modes[i])).collect();
    let models: Vec<ModelResult> = CableModel::ALL
        .into_iter()
        .map(|model| {
            if model == reference {
                return ModelResult::of_reference(&truth, model, compared.len());
            }
            let modes = with(model).map(|dynamics| modes::below(&dynamics, below_hz));
            ModelResult::of(
                modes,
                model,
                &Reference { dynamics: &dynamics, truth: &truth, compared: &compared, criterion },
            )
        })
        .collect();
    let advice =
        Advisor { robot, equilibrium, dynamics: &dynamics, below_hz, truth: &truth, models: &models, criterion };
    let advice = advice.advise(compared.len());
    let clamped = dynamics.clamped_frequencies_below(below_hz * TAU);
    let frozen_sag = clamped.first().and_then(|(omega, _)| frozen_sag(&models, omega / TAU, criterion));
    Ok(Comparison { below_hz, criterion, compared, reference, models, advice, frozen_sag })
}

/// Modes of the reference, with which those of the other models are compared.
struct Reference<'a> {
    dynamics: &'a Dynamics,
    truth: &'a Modes,
    /// Indices of the modes that count.
    compared: &'a [usize],
    criterion: Criterion,
}

impl ModelResult {
    /// The reference itself.
    fn of_reference(truth: &Modes, model: CableModel, compared: usize) -> Self {
        Self {
            model,
            modes: Ok(truth.clone()),
            matches: Vec::new(),
            missed: 0,
            within: compared,
            largest_difference: None,
            first_wrong_hz: None,
        }
    }

    /// Modes of a model, or the reason why there are none, beside those of the reference.
    fn of(modes: Result<Modes, DynamicsError>, model: CableModel, reference: &Reference<'_>) -> Self {
        let Reference { dynamics, truth, compared, criterion } = *reference;
        let found = modes.as_ref().map_or(&[][..], |m| &m.modes);
        let matches = match_modes(found, &truth.modes, compared, &dynamics.mass(), model, criterion);

        // How many modes of the reference are hit, and which within the tolerance: by the pairs that tables show.
        let mut hit = vec![false; truth.modes.len()];
        let mut right = hit.clone();
        for m in &matches {
            hit[m.reference_index] = true;
            right[m.reference_index] |= m.relative_difference.abs() <= criterion.tolerance;
        }
        let missed = compared.iter().filter(|&&i| !hit[i]).count();
        let within = compared.iter().filter(|&&i| right[i]).count();
        let differences = matches.iter().map(|m| m.relative_difference);
        let largest_difference = differences.max_by(|a, b| a.abs().total_cmp(&b.abs()));
        let first_wrong_hz = compared.iter().find(|&&i| !right[i]).map(|&i| truth.modes[i].frequency_hz);
        Self { model, modes, matches, missed, within, largest_difference, first_wrong_hz }
    }
}

/// Modes for which the sag that a static model lets follow is frozen in the reference.
fn frozen_sag(models: &[ModelResult], clamped_hz: f64, criterion: Criterion) -> Option<FrozenSag> {
    let of = |model: CableModel| models.iter().find(|result| result.model == model);
    let springs = &of(CableModel::Spring)?.matches;

    [CableModel::CatenaryStatic, CableModel::ShallowStatic].into_iter().find_map(|model| {
        let mut worse: Vec<(&Match, &Match)> = Vec::new();
        for with_sag in &of(model)?.matches {
            let spring = springs.iter().find(|m| m.reference_index == with_sag.reference_index);
            let Some(spring) = spring else { continue };
            let too_soft = -with_sag.relative_difference;
            if with_sag.reference_hz > clamped_hz
                && too_soft > spring.relative_difference.abs().max(criterion.tolerance)
            {
                worse.push((with_sag, spring));
            }
        }
        let (first, spring) = worse.iter().min_by(|a, b| a.0.reference_hz.total_cmp(&b.0.reference_hz))?;
        Some(FrozenSag {
            model,
            modes: worse.len(),
            frequency_hz: first.reference_hz,
            static_difference: first.relative_difference,
            spring_difference: spring.relative_difference,
            clamped_hz,
        })
    })
}

/// Pairs every mode with the compared reference mode of the most similar platform motion, weighted by the platform's
/// energy fraction in that mode; all modes of a dynamic model in the order of their frequencies. Each reference mode is
/// used once.
///
/// If modes of the platform are compared, the platform's energy fraction in the model's own mode has the same weight: a
/// dynamic model has cable modes with the same platform motion. Of modes that share it the nearest in frequency counts.
fn match_modes(
    found: &[Mode],
    truth: &[Mode],
    compared: &[usize],
    mass: &Mat6,
    model: CableModel,
    criterion: Criterion,
) -> Vec<Match> {
    let of_platform = criterion.platform_share.is_some();
    if model.is_dynamic() && !of_platform {
        return match_in_order(found, truth, mass);
    }
    let closeness = if model.is_dynamic() { 1.0 } else { 1e-6 };
    let vector = |m: &Mode| Vec6::from_row_slice(&m.shape);
    let inner = |a: &Vec6, b: &Vec6| a.dot(&(mass * b));

    // Every pair that may be the same motion, with a score.
    let mut candidates = Vec::new();
    for (i, ours) in found.iter().enumerate() {
        let x = vector(ours);
        for &j in compared {
            let theirs = &truth[j];
            let y = vector(theirs);
            let (own, other) = (inner(&x, &x), inner(&y, &y));
            // Two vibrations of cables with the platform at rest are the same motion if their frequencies agree.
            let both_at_rest = own == 0.0 && other == 0.0;
            if !(both_at_rest || own * other > 0.0) {
                continue;
            }

            let correlation = platform_mac(&x, &y, mass);
            let ratio = ours.frequency_hz / theirs.frequency_hz;
            if correlation < SAME_MOTION || !(1.0 / SAME_RANGE..=SAME_RANGE).contains(&ratio) {
                continue;
            }
            let own_share = if of_platform { ours.platform_energy_fraction } else { 1.0 };
            let score = correlation * theirs.platform_energy_fraction * own_share - closeness * (1.0 - ratio).abs();
            candidates.push((score, correlation, i, j));
        }
    }

    best_pairs(found, truth, candidates)
}

/// Pairs in the order of their scores; each mode of either list is used once. A candidate has the score, the MAC, and
/// the indices of both modes.
fn best_pairs(found: &[Mode], truth: &[Mode], mut candidates: Vec<(f64, f64, usize, usize)>) -> Vec<Match> {
    order::sort_descending(&mut candidates, |candidate| candidate.0);
    let (mut done, mut used) = (vec![None; found.len()], vec![false; truth.len()]);
    for (_, correlation, i, j) in candidates {
        if done[i].is_none() && !used[j] {
            used[j] = true;
            done[i] = Some(Match::of(&found[i], &truth[j], j, correlation));
        }
    }

    done.into_iter().flatten().collect()
}

impl Match {
    fn of(ours: &Mode, theirs: &Mode, reference_index: usize, correlation: f64) -> Self {
        let (frequency_hz, reference_hz) = (ours.frequency_hz, theirs.frequency_hz);
        let relative_difference = frequency_hz / reference_hz - 1.0;
        Self { frequency_hz, reference_hz, reference_index, relative_difference, correlation }
    }
}

/// MAC of two motions of the platform; two cables that vibrate with the platform at rest have the same one, none.
fn platform_mac(a: &Vec6, b: &Vec6, mass: &Mat6) -> f64 {
    let inner = |a: &Vec6, b: &Vec6| a.dot(&(mass * b));
    if inner(a, a) == 0.0 && inner(b, b) == 0.0 { 1.0 } else { modes::mac(a, b, inner) }
}

/// Pairs of all modes of a dynamic model. Among dozens of resonances of cables the shapes of the platform distinguish
/// little: the modes are paired in the order of their frequencies, and the shapes decide between nearly equal ones.
fn match_in_order(found: &[Mode], truth: &[Mode], mass: &Mat6) -> Vec<Match> {
    let hz = |modes: &[Mode]| modes.iter().map(|m| m.frequency_hz).collect::<Vec<f64>>();
    let mut pairs = pairs_in_order(&hz(found), &hz(truth));
    let vector = |m: &Mode| Vec6::from_row_slice(&m.shape);
    let mac = |i: usize, j: usize| platform_mac(&vector(&found[i]), &vector(&truth[j]), mass);
    let score = |i: usize, j: usize| {
        -relative_distance(found[i].frequency_hz, truth[j].frequency_hz) + NEARLY_EQUAL * mac(i, j)
    };

    // Neighbours that fit better the other way round. Each exchange raises the sum of the scores.
    let mut has_changed = true;
    while has_changed {
        has_changed = false;
        for k in 1..pairs.len() {
            let ((a, b), (c, d)) = (pairs[k - 1], pairs[k]);
            if score(a, d) + score(c, b) > score(a, b) + score(c, d) + MIN_GAIN {
                (pairs[k - 1].1, pairs[k].1) = (d, b);
                has_changed = true;
            }
        }
    }

    pairs.into_iter().map(|(i, j)| Match::of(&found[i], &truth[j], j, mac(i, j))).collect()
}

/// Relative distance of frequencies below which the shapes of the platform decide which modes are the same.
const NEARLY_EQUAL: f64 = 0.1 * TOLERANCE;

/// Gain of a score above which two modes exchange their counterparts: more than rounding.
const MIN_GAIN: f64 = 1e-12;

fn relative_distance(ours: f64, theirs: f64) -> f64 {
    (1.0 - ours / theirs).abs()
}

/// Pairs of two ascending lists of frequencies, none of which cross, with the least sum of relative differences. A
/// frequency without a partner counts as half of [`SAME_FREQUENCY`], so that no pair is farther apart than that.
fn pairs_in_order(found: &[f64], truth: &[f64]) -> Vec<(usize, usize)> {
    /// Last step of the best way to pair the beginnings of both lists.
    #[derive(Clone, Copy)]
    enum PairingStep {
        Pair,
        OnlyFound,
        OnlyTruth,
    }
    const ALONE: f64 = 0.5 * SAME_FREQUENCY;

    let width = truth.len() + 1;
    let mut steps = vec![PairingStep::OnlyTruth; (found.len() + 1) * width];
    let mut costs: Vec<f64> = (0..width).map(|j| ALONE * j as f64).collect();
    for (i, ours) in found.iter().enumerate() {
        let row = (i + 1) * width;
        let mut next = vec![ALONE * (i + 1) as f64];
        steps[row] = PairingStep::OnlyFound;
        for (j, theirs) in truth.iter().enumerate() {
            let ways = [
                (costs[j] + relative_distance(*ours, *theirs), PairingStep::Pair),
                (costs[j + 1] + ALONE, PairingStep::OnlyFound),
                (next[j] + ALONE, PairingStep::OnlyTruth),
            ];
            let (cost, step) = ways.into_iter().fold(ways[0], |best, way| if way.0 < best.0 { way } else { best });
            next.push(cost);
            steps[row + j + 1] = step;
        }
        costs = next;
    }

    let (mut i, mut j) = (found.len(), truth.len());
    let mut pairs = Vec::new();
    while i > 0 && j > 0 {
        match steps[i * width + j] {
            PairingStep::Pair => {
                (i, j) = (i - 1, j - 1);
                pairs.push((i, j));
            }
            PairingStep::OnlyFound => i -= 1,
            PairingStep::OnlyTruth => j -= 1,
        }
    }
    pairs.reverse();
    pairs
}

/// Results from which a model is recommended.
struct Advisor<'a> {
    robot: &'a Robot,
    equilibrium: &'a Equilibrium,
    dynamics: &'a Dynamics,
    below_hz: f64,
    truth: &'a Modes,
    models: &'a [ModelResult],
    criterion: Criterion,
}

impl Advisor<'_> {
    /// Recommends the simplest model that has all compared frequencies of the reference, of which there are `total`.
    fn advise(&self, total: usize) -> Advice {
        let cables = self.equilibrium.cables.iter().enumerate();
        let sags: Vec<Sag> = cables.map(|(i, state)| Sag::of(self.robot, i, state)).collect();
        let deepest = (0..sags.len()).max_by(|&i, &j| sags[i].ratio().total_cmp(&sags[j].ratio())).unwrap_or(0);
        let ratio = sags[deepest].ratio();
        let lambda2 = sags.iter().map(|s| s.lambda2).fold(0.0, f64::max);

        // The simplest model that has all frequencies.
        let reference = self.dynamics.linearisation.cable_model;
        let enough = |m: &&ModelResult| m.modes.is_ok() && m.first_wrong_hz.is_none();
        let simplest = self.models.iter().find(enough).map_or(reference, |m| m.model);
        let mut lines = match self.criterion.platform_share {
            None => self.for_all_modes(simplest, reference),
            Some(share) => self.for_the_platform(simplest, reference, total, share),
        };

        lines.push(self.sag_and_resonance(deepest, ratio, lambda2));
        if ratio > SHALLOW_SAG_LIMIT {
            lines.push(
                "The sag is beyond d/l = 1/20: cable resonances of `shallow-dynamic` are approximate.".to_owned(),
            );
        }
        Advice { model: simplest, text: lines.join("\n") }
    }

    fn result(&self, model: CableModel) -> Option<&ModelResult> {
        self.models.iter().find(|m| m.model == model)
    }

    /// Choice for all modes and the reason, a line each.
    fn for_all_modes(&self, simplest: CableModel, reference: CableModel) -> Vec<String> {
        let Self { truth, below_hz, .. } = self;
        let (total, percent) = (truth.modes.len(), self.criterion.percent());
        if total == 0 {
            return vec![format!("Use `{simplest}`: no natural frequency lies below {below_hz} Hz with any model.")];
        }

        let all = if total == 1 { "the one mode".to_owned() } else { format!("all {total} modes") };
        let wrong = self.result(CableModel::ShallowDynamic).and_then(|m| m.first_wrong_hz);
        let choice = match (simplest == reference, wrong) {
            (false, _) => {
                format!("Use `{simplest}`: it has {all} below {below_hz} Hz within {percent} % of `{reference}`.")
            }
            (true, Some(hz)) => format!(
                "Use `{reference}`: `shallow-dynamic` lacks the mode at {hz:.3} Hz or has it wrong by more than \
                 {percent} %."
            ),
            (true, None) => {
                format!("Use `{reference}`: no simpler model has {all} below {below_hz} Hz within {percent} %.")
            }
        };
        let is_dynamic = simplest == reference || simplest == CableModel::ShallowDynamic;
        std::iter::once(choice).chain(is_dynamic.then(|| self.modes_of_cables())).collect()
    }

    /// Line on the modes that only a dynamic model has.
    fn modes_of_cables(&self) -> String {
        // A cable with fixed ends gives no lower bound for them: with the moving platform there are modes of the cables
        // below it.
        let modes = &self.truth.modes;
        let mut of_cables = modes.iter().filter(|m| m.platform_energy_fraction < 0.5).map(|m| m.frequency_hz);
        let first = of_cables.next();
        let count = usize::from(first.is_some()) + of_cables.count();

        let lost = self.result(CableModel::CatenaryStatic).map_or(0, |m| m.missed);
        let from = first.map_or_else(String::new, |hz| format!(", from {hz:.3} Hz on"));
        format!(
            "{count} of {} have most of their energy in the cables{from}; a constant cable stiffness misses {lost}.",
            crate::counted(modes.len(), "mode")
        )
    }

    /// Line on the largest sag and the first resonance of a cable.
    fn sag_and_resonance(&self, deepest: usize, ratio: f64, lambda2: f64) -> String {
        let clamped = self.dynamics.clamped_frequencies_below(self.below_hz * TAU);
        let name = |cable: usize| &self.robot.cables[cable].name;
        let resonance = match clamped.first() {
            Some((omega, cable)) => format!("from {:.3} Hz on (cable \"{}\")", omega / TAU, name(*cable)),
            None => format!("not below {} Hz", self.below_hz),
        };
        format!(
            "Maximum sag d/l = {ratio:.4} (cable \"{}\"), maximum λ² = {lambda2:.1}; cables with fixed ends resonate \
             {resonance}.",
            name(deepest)
        )
    }

    /// Choice for the modes of the platform alone and the reason, a line each.
    fn for_the_platform(&self, simplest: CableModel, reference: CableModel, total: usize, share: f64) -> Vec<String> {
        let (below_hz, percent) = (self.below_hz, self.criterion.percent());
        let modes = crate::counted(total, "platform mode");
        if total == 0 {
            return vec![format!(
                "No mode below {below_hz} Hz has at least {} % of its kinetic energy in the platform: raise the limit, \
                 or require a smaller share.",
                100.0 * share
            )];
        }
        let all = if total == 1 { "the one platform mode".to_owned() } else { format!("all {modes}") };
        if simplest != reference {
            let difference = self.result(simplest).and_then(|m| m.largest_difference).unwrap_or(0.0);
            return vec![
                format!(
                    "Use `{simplest}` for the platform: it has {all} below {below_hz} Hz within {percent} % of \
                     `{reference}`."
                ),
                format!("Its largest difference is {:+.2} %.", 100.0 * difference),
            ];
        }

        // How far the simplest models come.
        let reached: Vec<String> = [CableModel::Spring, CableModel::CatenaryStatic, CableModel::ShallowDynamic]
            .into_iter()
            .filter_map(|model| {
                let result = self.result(model).filter(|result| result.modes.is_ok() && model != reference)?;
                let farthest = result.largest_difference.map_or_else(
                    || "it has none of them".to_owned(),
                    |difference| format!("its largest difference is {:+.1} %", 100.0 * difference),
                );
                Some(format!("`{model}` has {} ({farthest})", result.within))
            })
            .collect();
        vec![
            format!(
                "Use `{reference}` for the platform: no simpler model has {all} below {below_hz} Hz within {percent} %."
            ),
            format!("Of them {}.", reached.join(", ")),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn modes_are_paired_in_the_order_of_their_frequencies() {
        // The nearest pair first would leave 14.5458 with 14.7152, farther away than either of its neighbours.
        assert_eq!(pairs_in_order(&[14.5974, 14.7152], &[14.5458, 14.6387]), [(0, 0), (1, 1)]);
        // A mode that one of the lists lacks leaves the others in their places.
        assert_eq!(pairs_in_order(&[1.0, 3.0, 4.0], &[1.0, 2.0, 3.0, 4.0]), [(0, 0), (1, 2), (2, 3)]);
        assert_eq!(pairs_in_order(&[1.0, 2.0, 3.0], &[1.01, 3.01]), [(0, 0), (2, 1)]);
        // A mode farther away than any that can be the same.
        assert!(pairs_in_order(&[1.0], &[1.3]).is_empty());
        assert!(pairs_in_order(&[], &[1.0]).is_empty());
    }

    /// Every choice of pairs that do not cross, compared by its cost.
    #[test]
    fn no_other_pairs_without_crossing_cost_less() {
        fn least(found: &[f64], truth: &[f64]) -> f64 {
            let alone = 0.5 * SAME_FREQUENCY;
            let (Some((a, found_rest)), Some((b, truth_rest))) = (found.split_first(), truth.split_first()) else {
                return alone * (found.len() + truth.len()) as f64;
            };
            (least(found_rest, truth_rest) + relative_distance(*a, *b))
                .min(alone + least(found_rest, truth))
                .min(alone + least(found, truth_rest))
        }
        let mut state = 7_u64;
        let mut list = |length: usize| {
            let mut values: Vec<f64> = (0..length)
                .map(|_| {
                    state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                    1.0 + (state >> 40) as f64 / f64::from(1 << 24)
                })
                .collect();
            values.sort_by(f64::total_cmp);
            values
        };
        for n in 0..40 {
            let (found, truth) = (list(n % 6), list(n / 6));
            let pairs = pairs_in_order(&found, &truth);
            let apart: f64 = pairs.iter().map(|&(i, j)| relative_distance(found[i], truth[j])).sum();
            let cost = apart + 0.5 * SAME_FREQUENCY * (found.len() + truth.len() - 2 * pairs.len()) as f64;
            assert!((cost - least(&found, &truth)).abs() < 1e-12, "{found:?} {truth:?} {pairs:?}");
        }
    }
}

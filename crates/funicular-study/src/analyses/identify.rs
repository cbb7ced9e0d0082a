//! `identify`: the values of a robot file that fit measurements best, and how well the measurements determine them.
//!
//! docs/theory.md, section 18a, has the equations.

mod assignment;
mod caveats;
mod chi2;
mod derivatives;
mod draws;
mod experiment;
mod histories;
mod lists;
mod model;
mod observations;
mod precision;
mod profile;
mod proposals;
mod reading;
mod resolution;
mod ridge;
mod search;
mod starts;
mod tables;
mod unknowns;

pub use super::profile::{OpenEnd, Profile};
pub use histories::{DiagramRow, HistoryOfPoles, PoleRow};
pub use proposals::ProposedMeasurement;
pub use tables::{FittedResponse, FrequencyRow, StaticRow};

use super::candidate_poses::Candidates;
use super::profile::LIMIT as NORMAL_95;
use super::{candidate_poses, fields, found};
use crate::Watch;
use crate::chosen_numbers::at_bound;
use crate::columns::{Columns, ResultTable, Style, Tabled, column, only_read, parts};
use crate::parameter_pattern::ParameterPattern;
use crate::request::{self, IdentifyRequest};
use crate::rows::rows;
use crate::table::Column;
use crate::text::{counted, digits_for, significant};
use anyhow::{Result, bail};
use assignment::Assigning;
use funicular::math::least_squares::{LeastSquaresEnding, Minimum};
use funicular::robot::parameters::Parameters;
use model::IdentifiedModel;
use observations::{Observation, Subject};
use precision::{Judged, judge};
use resolution::unresolved_peaks;
use ridge::{Profiled, profiles};
use search::{Searched, search};
use starts::StartRow;
use std::cell::RefCell;
use tables::Tables;
use unknowns::{Unknown, unknowns};

/// Maximum number of starts.
const MAX_STARTS: usize = 1000;

rows! {
    /// Results of `identify`.
    pub struct Identified {
        pub robot: String = hidden;
        pub values: Vec<ValueRow>;
        /// Sum of the squares of all residuals, those of priors included.
        pub chi2: f64;
        pub residuals: usize;
        pub degrees_of_freedom: usize;
        pub chi2_per_degree: f64;
        /// Factor by which the deviations of the values were multiplied.
        pub deviation_factor: f64;
        pub verdict: String;
        pub correlations: Vec<Vec<f64>>;
        pub singular_values: Vec<f64>;
        /// Combinations of values that the measurements do not determine.
        pub weak_combinations: Vec<String>;
        pub strong_correlations: Vec<String>;
        /// True if the last search has ended at a minimum, and the starts have not ended apart.
        pub converged: bool;
        pub starts: Vec<StartRow>;
        pub evaluations: usize;
        pub frequencies: Vec<FrequencyRow> = sparse;
        /// Root mean square of the relative differences of all natural frequencies.
        pub frequency_rms: Option<f64>;
        /// Root mean square before the fit, with the same modes as partners.
        pub frequency_rms_before: Option<f64>;
        /// Assignment of frequencies without a number, unless responses were measured as well.
        pub assignment: Option<ModeAssignment>;
        pub responses: Vec<FittedResponse> = sparse;
        pub statics: Vec<StaticRow> = sparse;
        /// Time histories with the natural frequencies that were found in them.
        pub histories: Vec<HistoryOfPoles> = sparse;
        /// Measurements to make next.
        pub proposals: Vec<ProposedMeasurement> = sparse;
        /// Least number of proposed measurements that reaches the wanted deviation; absent if none was wanted or no
        /// number does.
        pub measurements_needed: Option<usize>;
        /// Robot file with the values.
        pub robot_file: String;
        pub warnings: Vec<String> = hidden;
    }
}

rows! {
    /// Assignment of measured frequencies without a number to modes; the numbers are in `frequencies`.
    pub struct ModeAssignment {
        /// False if other assignments are possible; deviations and intervals are then absent.
        pub determined: bool;
        /// Reasons why it is not determined.
        pub doubts: Vec<String>;
        /// Number of frequencies without a number.
        pub frequencies: usize;
        /// Number of these with several modes within two deviations.
        pub crowded: usize;
        /// Number of lists of random frequencies that were fitted in their place.
        pub random_lists: usize;
        /// Number of these lists that fit at least as well.
        pub random_as_good: usize;
        /// Median of χ² per degree of freedom of these lists.
        pub random_chi2_per_degree: Option<f64>;
        /// Best fit with other modes.
        pub second_best: Option<SecondBest>;
    }
}

rows! {
    /// Best fit with other modes and other values.
    pub struct SecondBest {
        /// Values in the order of the identified ones.
        pub values: Vec<f64>;
        pub chi2: f64;
        pub chi2_per_degree: f64;
        /// Numbers of the modes in the ascending list, in the order of `frequencies` of the results.
        pub numbers: Vec<usize>;
        /// Natural frequencies of these modes [Hz].
        pub frequency_hz: Vec<f64>;
    }
}

impl ModeAssignment {
    fn of(found: &Assigning, model: &IdentifiedModel<'_>, doubts: Vec<String>) -> Self {
        let second_best = found.other.as_ref().map(|other| SecondBest {
            values: model.values(&other.x),
            chi2: other.chi2,
            chi2_per_degree: other.chi2 / other.degrees.max(1) as f64,
            numbers: other.assigned.iter().flatten().map(|index| index + 1).collect(),
            frequency_hz: other.frequency_hz.clone(),
        });
        Self {
            determined: doubts.is_empty(),
            doubts,
            frequencies: found.open,
            crowded: found.crowded,
            random_lists: found.random.len(),
            random_as_good: found.as_good(),
            random_chi2_per_degree: found.random_chi2_per_degree(),
            second_best,
        }
    }

    /// Sentence on fits to random frequencies.
    pub fn random_text(&self) -> Option<String> {
        Some(format!(
            "Random frequencies in place of the {} without a number fit with χ²/n = {} (median of {} lists), and {} of \
             these lists fit at least as well.",
            self.frequencies,
            significant(self.random_chi2_per_degree?, 3),
            self.random_lists,
            self.random_as_good
        ))
    }
}

impl SecondBest {
    /// Sentence on χ² and values.
    pub fn sentence(&self, rows: &[ValueRow]) -> String {
        let value = |(row, value): (&ValueRow, &f64)| format!("{} = {}", row.path, significant(*value, 5));
        format!(
            "Second best modes: χ² = {}, χ²/n = {}, {}",
            significant(self.chi2, 4),
            significant(self.chi2_per_degree, 3),
            rows.iter().zip(&self.values).map(value).collect::<Vec<_>>().join(", ")
        )
    }
}

rows! {
    /// Identified value.
    pub struct ValueRow {
        pub path: String;
        pub unit: &'static str;
        pub start: f64;
        pub value: f64;
        /// Standard deviation; absent for a value that the measurements do not determine, or that moves with such a
        /// value.
        pub deviation: Option<f64>;
        /// Interval that holds the value with 95 %: that of the deviation, or that of the profile where χ² is no
        /// parabola.
        pub interval_95: Option<[f64; 2]>;
        pub prior: Option<f64>;
        pub prior_deviation: Option<f64>;
        /// `minimum` or `maximum` if the value is at this bound.
        pub at_bound: Option<&'static str>;
        /// Values that the measurements determine poorly, with which this one moves farther than its deviation.
        pub moves_with: Vec<String> = sparse;
        /// Interval of the deviation; absent if χ² is no parabola.
        pub parabola_95: Option<[f64; 2]> = hidden;
        /// Profile of χ², if it was asked for or if χ² is no parabola.
        pub profile: Option<Profile>;
    }
}

impl ValueRow {
    /// Number of digits of the value, by its deviation.
    pub fn digits(&self) -> usize {
        digits_for(self.value, self.deviation)
    }

    /// Prior knowledge of the value, as `value ± deviation`; empty without it.
    fn prior_text(&self, style: Style) -> String {
        let prior = self.prior.zip(self.prior_deviation);
        let text =
            |(value, deviation)| format!("{} ± {}", style.significant(value, 4), style.significant(deviation, 2));
        prior.map_or_else(String::new, text)
    }

    /// Remark: the bound at which the value is, and whether the measurements determine it.
    fn remark(&self) -> String {
        let bound = self.at_bound.map(|bound| format!("at its {bound}"));
        let moves = (!self.moves_with.is_empty()).then(|| format!("moves with {}", self.moves_with.join(", ")));
        let undetermined = (self.deviation.is_none() && moves.is_none()).then(|| "not determined".to_owned());
        bound.into_iter().chain(moves).chain(undetermined).collect::<Vec<_>>().join(", ")
    }
}

/// Identifies values of a robot file.
///
/// # Errors
/// A request that contradicts itself or the robot, no start at which the robot has an equilibrium, or work that was
/// stopped.
pub fn run(request: &IdentifyRequest, watch: &mut dyn Watch) -> Result<Identified> {
    check(request)?;
    let (request, histories) = histories::with_frequencies(&within_range(request)?)?;
    let request = &request;
    let file = request.robot.read()?;
    let parameters = Parameters::from_toml(&file.text)?;
    if request.fit.is_empty() && !histories.is_empty() {
        return Ok(Identified::of_histories(parameters.robot().name.clone(), file.text.clone(), histories));
    }
    let unknowns = unknowns(&parameters, &request.fit)?;
    let mut profiled = named(("profile", &request.profile), &parameters, &unknowns)?;
    let wanted = candidates(request, &parameters)?;
    let proposed_for = named(("propose_for", &request.propose_for), &parameters, &unknowns)?;

    // The search.
    let watch = RefCell::new(watch);
    let is_cancelled = || watch.borrow().is_cancelled();
    let mut model = IdentifiedModel::new(&parameters, &unknowns, request, &is_cancelled)?;
    let nominal: Vec<f64> = unknowns.iter().map(|unknown| unknown.coordinate(unknown.start)).collect();
    let has_nominal = model.predict(&nominal, None).is_ok();
    let progress = |done: usize, total: usize| watch.borrow_mut().progress(done, total, "starts");
    let searched = search(&mut model, request.starts, &progress)?;
    let best = &searched.best;

    // How well the measurements determine the values.
    let mut judged = judge(&model, best, caveats::is_noise_given(request));
    let assigning = searched.assigning.as_ref();
    let doubts =
        assigning.map(|of| of.doubts(&model, best, &judged, caveats::is_noise_given(request))).unwrap_or_default();
    if searched.apart.is_some() {
        "the search has not arrived: its starts ended apart".clone_into(&mut judged.verdict);
    }
    // Intervals hold for one assignment and one minimum.
    if !doubts.is_empty() || searched.apart.is_some() {
        judged.deviations.fill(None);
        profiled.clear();
    }
    let progress = |done: usize, total: usize| watch.borrow_mut().progress(done, total, "fits of profiles");
    let profiled = profiles(&mut model, best, &profiled, &judged.deviations, judged.factor, &progress)?;
    let rows = value_rows(&model, &best.x, &judged.deviations, profiled);

    let mut warnings = all_warnings(&model, request, &searched, &judged, &doubts, &rows)?;

    // What to measure next.
    let (mut proposed, mut measurements_needed) = (Vec::new(), None);
    if proposals::is_wanted(request) {
        let first = model.at_rest(&best.x, 0)?;
        let poses = wanted.poses(parameters.robot(), &first.held_pose.unwrap_or(first.equilibrium.pose))?;
        let is_chosen = |k| request.propose_for.is_empty() || proposed_for.contains(&k);
        let chosen: Vec<bool> = (0..unknowns.len()).map(is_chosen).collect();
        (proposed, measurements_needed) =
            proposals::proposals(&model, request, (best, judged.factor), &poses, &chosen, &watch)?;
    }
    if let (Some(wanted), None) = (request.wanted_percent, measurements_needed) {
        warnings.push(proposals::not_reached(wanted));
    }

    let tables = tables(&mut model, request, &best.x, Some(&nominal[..]).filter(|_| has_nominal))?;
    warnings.splice(0..0, caveats::left_out(&model, &tables.responses));
    warnings.splice(0..0, histories.iter().flat_map(HistoryOfPoles::caveats));
    Ok(Identified {
        robot: parameters.robot().name.clone(),
        values: rows,
        chi2: best.chi2(),
        residuals: best.residuals.len(),
        degrees_of_freedom: judged.degrees,
        chi2_per_degree: judged.chi2_per_degree,
        deviation_factor: judged.factor,
        verdict: judged.verdict,
        correlations: judged.correlations,
        singular_values: judged.singular_values,
        weak_combinations: judged.weak,
        strong_correlations: judged.strong,
        converged: best.ending == LeastSquaresEnding::Converged && searched.apart.is_none(),
        starts: searched.starts,
        evaluations: model.evaluations,
        frequency_rms: tables.frequency_rms(|row| Some(row.fitted_hz)),
        frequency_rms_before: tables.frequency_rms(|row| row.before_hz),
        frequencies: tables.frequencies,
        assignment: searched.assigning.as_ref().map(|found| ModeAssignment::of(found, &model, doubts)),
        responses: tables.responses,
        statics: tables.statics,
        histories,
        robot_file: model.text(&best.x)?,
        proposals: proposed,
        measurements_needed,
        warnings,
    })
}

/// Warnings about the fit and the robot that it found.
fn all_warnings(
    model: &IdentifiedModel<'_>,
    request: &IdentifyRequest,
    searched: &Searched,
    judged: &Judged,
    doubts: &[String],
    rows: &[ValueRow],
) -> Result<Vec<String>> {
    let best = &searched.best;
    let mut all = Vec::from_iter(caveats::unexplained(judged.chi2_per_degree));
    all.extend(warnings(model, request, best, rows)?);
    all.extend(searched.apart.clone());
    all.extend(searched.assigning.as_ref().and_then(|assigning| assigning.warning(doubts)));
    all.extend(caveats::damping_in_per_cent(request));
    let fitted = model.robot(&best.x)?;
    all.extend(funicular::warnings::of_robot(&fitted).iter().map(|warning| format!("identified robot: {warning}")));
    all.extend(judged.weak.iter().cloned());
    all.extend(rows.iter().filter_map(caveats::moves));
    all.extend(rows.iter().filter_map(|row| caveats::missed_minimum(row, best.chi2(), judged.factor)));
    Ok(all)
}

/// Warnings about a minimum: measurements that the model misses, peaks that are not resolved, values at bounds, and a
/// search that has not ended.
fn warnings(
    model: &IdentifiedModel<'_>,
    request: &IdentifyRequest,
    best: &Minimum,
    rows: &[ValueRow],
) -> Result<Vec<String>> {
    let mut warnings: Vec<String> = caveats::outliers(model, request).into_iter().collect();
    for (number, (experiment, name)) in request.experiments.iter().zip(model.names()).enumerate() {
        let unresolved = unresolved_peaks(model, &best.x, number, experiment)?;
        warnings.extend(unresolved.map(|text| format!("{name}: {text}")));
    }

    warnings.extend(rows.iter().filter_map(caveats::value_at_bound));
    if best.ending != LeastSquaresEnding::Converged {
        warnings.push(format!("the search has not ended after {}", counted(best.iterations, "iteration")));
    }
    Ok(warnings)
}

/// Checks the numbers of a request.
fn check(request: &IdentifyRequest) -> Result<()> {
    if !(1..=MAX_STARTS).contains(&request.starts) {
        bail!("⟪starts⟫: {} starts are not possible: give a whole number from 1 to {MAX_STARTS}", request.starts);
    }
    request::check_positive("response_noise", request.response_noise)?;
    request::check_positive("frequency_noise", request.frequency_noise)?;
    request::check_positive("damping_noise", request.damping_noise)
}

/// Candidates of a proposal.
fn candidates(request: &IdentifyRequest, parameters: &Parameters) -> Result<Candidates> {
    proposals::check(request)?;
    let needs = (proposals::is_wanted(request), "⟪propose⟫ or ⟪wanted_percent⟫");
    candidate_poses::wanted(needs, &request.grid, request.poses.as_ref(), parameters.robot())
}

/// Numbers of the unknowns at the paths of an option, in the order of the fit.
fn named(
    (option, paths): (&'static str, &[String]),
    parameters: &Parameters,
    unknowns: &[Unknown],
) -> Result<Vec<usize>> {
    let mut chosen = vec![false; unknowns.len()];
    for path in paths {
        let pattern = ParameterPattern::parse(option, path, parameters)?;
        let matches: Vec<bool> =
            unknowns.iter().map(|unknown| pattern.matches(&parameters.list()[unknown.index])).collect();
        if !matches.contains(&true) {
            let all: Vec<String> = unknowns.iter().map(|unknown| unknown.path.clone()).collect();
            return Err(pattern.unknown("no fitted value has this path", &all));
        }
        chosen.iter_mut().zip(matches).for_each(|(chosen, matches)| *chosen |= matches);
    }
    Ok((0..unknowns.len()).filter(|&k| chosen[k]).collect())
}

/// Request with the frequencies of responses that count.
fn within_range(request: &IdentifyRequest) -> Result<IdentifyRequest> {
    let mut request = request.clone();
    for (key, hz) in [("from_hz", request.from_hz), ("to_hz", request.to_hz)] {
        hz.map_or(Ok(()), |hz| crate::request::check_not_negative(key, hz))?;
    }
    let (from, to) = (request.from_hz.unwrap_or(0.0), request.to_hz.unwrap_or(f64::INFINITY));
    if from >= to {
        bail!("⟪from_hz⟫ {from} Hz is not below ⟪to_hz⟫ {to} Hz");
    }

    // A frequency that is not possible is refused later, and not left out.
    let counts_or_wrong = |hz: &f64| (from..=to).contains(hz) || !(hz.is_finite() && *hz >= 0.0);
    for response in request.experiments.iter_mut().flat_map(|experiment| &mut experiment.responses) {
        let counts: Vec<bool> = response.frequency_hz.iter().map(counts_or_wrong).collect();
        let keep = |values: &mut Vec<f64>| {
            // Lists of other lengths are refused later.
            if values.len() == counts.len() {
                let mut counts = counts.iter();
                values.retain(|_| counts.next().copied().unwrap_or(true));
            }
        };
        keep(&mut response.real);
        keep(&mut response.imag);
        response.std.iter_mut().for_each(keep);
        keep(&mut response.frequency_hz);
        if response.frequency_hz.is_empty() && !counts.is_empty() {
            bail!("no frequency of a response is between ⟪from_hz⟫ and ⟪to_hz⟫");
        }
    }
    Ok(request)
}

/// Tables of measured and fitted numbers. `nominal` are the coordinates before the fit, if the robot has an equilibrium
/// there; the measured frequencies then have the same modes as partners.
fn tables(
    model: &mut IdentifiedModel<'_>,
    request: &IdentifyRequest,
    x: &[f64],
    nominal: Option<&[f64]>,
) -> Result<Tables> {
    let fitted = model.predict(x, None)?;
    let before = nominal.and_then(|nominal| model.predict(nominal, Some(&fitted.assigned)).ok());
    let before = before.as_ref().map(|before| before.values.as_slice());
    Ok(Tables::of(model, &request.experiments, &fitted.assigned, &fitted.values, before))
}

/// Identified values at coordinates, with their deviations and profiles.
fn value_rows(model: &IdentifiedModel<'_>, x: &[f64], deviations: &[Option<f64>], profiled: Profiled) -> Vec<ValueRow> {
    let Profiled { profiles, moves_with, takes_profile } = profiled;
    let rows = model.unknowns.iter().zip(model.values(x)).zip(deviations);
    let mut rows: Vec<ValueRow> =
        rows.map(|((unknown, value), deviation)| value_row(unknown, value, *deviation)).collect();
    for (k, profile) in profiles.into_iter().enumerate() {
        let row = &mut rows[k];
        if takes_profile[k] {
            row.interval_95 = profile.as_ref().and_then(|profile| Some([profile.from?, profile.to?]));
            row.parabola_95 = None;
        }
        if !moves_with[k].is_empty() {
            row.deviation = None;
            row.moves_with = moves_with[k].iter().map(|other| model.unknowns[*other].path.clone()).collect();
        }
        row.profile = profile;
    }
    rows
}

fn value_row(unknown: &Unknown, value: f64, deviation: Option<f64>) -> ValueRow {
    let x = unknown.coordinate(value);
    let interval = deviation.map(|deviation| [-1.0, 1.0].map(|side| unknown.value(x + side * NORMAL_95 * deviation)));
    ValueRow {
        path: unknown.path.clone(),
        unit: unknown.unit,
        start: unknown.start,
        value,
        deviation: deviation.map(|deviation| deviation * unknown.rate(value)),
        interval_95: interval,
        prior: unknown.prior.map(|prior| prior.0),
        prior_deviation: unknown.prior.map(|prior| prior.1),
        // A bound is reached exactly.
        at_bound: at_bound(value, unknown.bounds, 0.0),
        moves_with: Vec::new(),
        parabola_95: interval,
        profile: None,
    }
}

/// Value with the fit to which it belongs.
pub struct FittedValue<'a> {
    fit: &'a Identified,
    index: usize,
    row: &'a ValueRow,
}

impl<'a> FittedValue<'a> {
    /// All values of a fit.
    pub fn all(fit: &'a Identified) -> impl Iterator<Item = Self> {
        fit.values.iter().enumerate().map(move |(index, row)| Self { fit, index, row })
    }

    fn assignment(&self) -> Option<&'a ModeAssignment> {
        self.fit.assignment.as_ref()
    }

    fn second_best(&self) -> Option<&'a SecondBest> {
        self.assignment().and_then(|assignment| assignment.second_best.as_ref())
    }

    /// Columns of the values.
    pub fn columns() -> Columns<Self> {
        let listed = |numbers: &mut dyn Iterator<Item = usize>| {
            numbers.map(|number| number.to_string()).collect::<Vec<_>>().join(" ")
        };
        let [from, to] =
            fields::interval_95(|of: &Self| of.row.interval_95, |of: &Self| of.row.digits(), "the value with 95 %");
        let profile = |of: &Self| of.row.profile.as_ref().map_or([None; 2], |profile| [profile.from, profile.to]);
        let notes = |of: &Self, style| {
            let prior = of.row.prior_text(style);
            let notes = [if prior.is_empty() { prior } else { format!("prior {prior}") }, of.row.remark()];
            notes.into_iter().filter(|note| !note.is_empty()).collect::<Vec<_>>().join(", ")
        };

        let values = [
            column("path", "", "path of the number", |of: &Self| of.row.path.clone()).plain("value"),
            column("unit", "", "unit of the number", |of: &Self| of.row.unit).plain("unit"),
            column("start", "", "value of the file", |of: &Self| of.row.start).significant("start", 6),
            column("value", "", "identified value", |of: &Self| of.row.value)
                .shown("identified", "", |of, style| style.significant(of.row.value, of.row.digits())),
            column(
                "deviation",
                "",
                "standard deviation; empty if the measurements do not determine the value",
                |of: &Self| of.row.deviation,
            )
            .significant("deviation", 2),
            from,
            to,
            column("prior", "", "value that was known beforehand", |of: &Self| of.row.prior)
                .shown("prior", "", |of, style| of.row.prior_text(style))
                .aligned(true)
                .only_in(Style::Typeset),
            column("prior_deviation", "", "its standard deviation", |of: &Self| of.row.prior_deviation),
            column("at_bound", "", "bound at which the value is", |of: &Self| of.row.at_bound)
                .shown("remark", "", |of, _| of.row.remark())
                .only_in(Style::Typeset),
            only_read().shown("", "", notes).only_in(Style::Plain),
            parts("profile_95_{}", ["from", "to"], "", "end of the interval of the profile: {}", profile),
        ];
        let of_fit = [
            column("second_best", "", "value with the second best modes", |of: &Self| {
                of.second_best().map(|second| second.values[of.index])
            }),
            column(
                "is_assignment_determined",
                "",
                "the best modes are better than others by more than chance",
                |of: &Self| of.assignment().map(|assignment| assignment.determined),
            ),
            column("modes", "", "numbers of the modes of the measured frequencies", move |of: &Self| {
                listed(&mut of.fit.frequencies.iter().map(|row| row.number))
            }),
            column("second_best_modes", "", "numbers of the second best modes", move |of: &Self| {
                of.second_best().map(|second| listed(&mut second.numbers.iter().copied()))
            }),
            column("chi2_per_degree", "1", "χ² per degree of freedom", |of: &Self| of.fit.chi2_per_degree),
            column("second_best_chi2_per_degree", "1", "the same with the second best modes", |of: &Self| {
                of.second_best().map(|second| second.chi2_per_degree)
            }),
            column("random_chi2_per_degree", "1", "the same of fits to random frequencies", |of: &Self| {
                of.assignment().and_then(|assignment| assignment.random_chi2_per_degree)
            }),
        ];
        Columns::new(values.into_iter().chain(of_fit))
    }
}

impl Tabled for Identified {
    fn tables() -> Vec<(&'static str, Vec<Column>)> {
        let poles = ("without `--fit`: frequencies of time histories", PoleRow::columns().described());
        vec![("fitted values", FittedValue::columns().described()), poles]
    }

    fn table(&self) -> ResultTable<'_> {
        if self.values.is_empty() {
            return ResultTable::new(PoleRow::columns(), self.histories.iter().flat_map(|history| &history.poles));
        }
        ResultTable::new(FittedValue::columns(), FittedValue::all(self))
    }
}

found!(Identified, "identify");

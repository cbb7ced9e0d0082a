//! Choices that are not numbers: the rope of all cables, and the attachment to which each anchor is connected.

use super::{Chosen, DesignRun};
use crate::error::Cancelled;
use crate::request::OfferedRope;
use crate::rows::rows;
use crate::set_values::{self, Assignment};
use crate::text::{significant, with_unit};
use anyhow::{Result, anyhow, bail};
use funicular::clearance::Surroundings;
use funicular::robot::parameters::Parameters;
use toml_edit::{DocumentMut, Item};

/// Largest number of ropes for which all values are chosen anew; of more, those with the best goal at the start.
const MAX_SEARCHES: usize = 8;

/// Relative gain of an exchange of attachments that is more than rounding.
const MIN_GAIN: f64 = 1e-6;

/// Largest number of rounds of exchanges, which bounds the time: the goal gains in every round, and rounds end by
/// themselves where none gains.
const MAX_ROUNDS: usize = 50;

/// Keys of a material that belong to the section of its rope.
const OF_SECTION: [&str; 5] =
    ["axial_stiffness_n", "youngs_modulus_pa", "area_m2", "diameter_m", "dynamic_axial_stiffness_n"];

rows! {
    /// Rope that was tried.
    pub struct RopeTried in tables() {
        /// Name of the rope.
        pub name: String => one.plain("rope");
        /// Value of the goal with the values of the file.
        ///
        /// Absent where a pose is not held.
        pub before: Option<f64> => one.unit("").significant("before", 5);
        /// Value of the goal with the chosen values; absent for a rope that was not searched or that meets no demands.
        pub after: Option<f64> => one.unit("").significant("after", 5);
        /// Reason for which there is no value.
        pub reason: Option<String> => one.plain("remark");
        /// True for the chosen rope.
        pub chosen: bool;
    }
}

rows! {
    /// Exchange of the attachments of two cables.
    pub struct ExchangeRow {
        /// Names of the cables.
        pub cables: [String; 2];
        /// Value of the goal after the exchange, with the values of the file.
        pub after: f64;
    }
}

/// Text of the robot file after exchanges of attachments, with these exchanges: the best of all pairs, round by round,
/// while the goal at the start gains and no further cables cross.
///
/// # Errors
/// A robot whose cables end in one point, or work that was stopped.
pub(super) fn reconnected(run: &mut DesignRun<'_>, text: String) -> Result<(String, Exchanges)> {
    let Ok(mut value) = run.start_value(&text) else { return Ok((text, Exchanges::default())) };
    let mut best_text = text;
    let sign = run.request.goal.sign();
    let mut exchanges = Exchanges { before: sign * value, rows: Vec::new() };
    let parameters = Parameters::from_toml(&best_text)?;
    let names: Vec<String> = parameters.robot().cables.iter().map(|cable| cable.name.clone()).collect();
    let crossings = run.crossings(&best_text)?;
    for round in 0..MAX_ROUNDS {
        let mut best: Option<(f64, String, [usize; 2])> = None;
        for i in 0..names.len() {
            for j in i + 1..names.len() {
                if run.watch.is_cancelled() {
                    return Err(Cancelled.into());
                }
                run.watch.progress(round, MAX_ROUNDS, "exchanges");
                let exchanged = exchanged(&best_text, [&names[i], &names[j]])?;
                let Ok(after) = run.start_value(&exchanged) else { continue };
                let least = best.as_ref().map_or(value + MIN_GAIN * value.abs(), |(least, ..)| *least);
                if after > least && run.crossings(&exchanged)? <= crossings {
                    best = Some((after, exchanged, [i, j]));
                }
            }
        }
        let Some((after, exchanged, [i, j])) = best else { break };
        (value, best_text) = (after, exchanged);
        let cables = [names[i].clone(), names[j].clone()];
        exchanges.rows.push(ExchangeRow { cables, after: sign * after });
    }
    Ok((best_text, exchanges))
}

/// Text with the attachments of two cables exchanged.
fn exchanged(text: &str, cables: [&String; 2]) -> Result<String> {
    let parameters = Parameters::from_toml(text)?;
    let cable = |name: &String| parameters.robot().cables.iter().find(|cable| cable.name == *name);
    let [Some(first), Some(second)] = cables.map(cable) else { bail!("a cable has gone") };
    let place = |name: &str, point: [f64; 3]| -> Result<Vec<Assignment>> {
        let of = ["x", "y", "z"].iter().zip(point);
        of.map(|(axis, value)| {
            let path = set_values::path(&format!("cables.{name}.attachment_m.{axis}"));
            Ok(path.map_err(|reason| anyhow!("{reason}"))?.with("⟪reconnect⟫", value))
        })
        .collect()
    };
    let mut assignments = place(cables[0], second.attachment_p.into())?;
    assignments.extend(place(cables[1], first.attachment_p.into())?);
    Ok(set_values::apply(text, &assignments)?)
}

/// Best rope with its values, and all that were tried. Every material of the file takes the values of a rope.
///
/// # Errors
/// Ropes without a name of their own, a rope that the robot file cannot have, no rope with which the poses are held and
/// the demands met, or work that was stopped.
pub(super) fn best_rope(
    run: &mut DesignRun<'_>,
    text: &str,
    ropes: &[OfferedRope],
) -> Result<(Chosen, Vec<RopeTried>)> {
    if ropes.is_empty() {
        bail!("⟪ropes⟫ is empty: give at least one rope");
    }
    let materials = materials(text)?;
    let mut tried = Vec::new();
    let mut texts = Vec::new();
    for rope in ropes {
        if tried.iter().any(|row: &RopeTried| row.name == rope.name) {
            bail!("⟪ropes⟫: the rope {} is there twice", rope.name);
        }
        let with = with_rope(text, &materials, rope)?;
        let (before, reason) = match run.start_value(&with) {
            Ok(value) => (Some(value), None),
            Err(error) => (None, Some(format!("{error:#}"))),
        };
        tried.push(RopeTried { name: rope.name.clone(), before, after: None, reason, chosen: false });
        texts.push(with);
    }

    let mut order: Vec<usize> = (0..ropes.len()).filter(|k| tried[*k].before.is_some()).collect();
    order.sort_by(|a, b| tried[*b].before.unwrap_or(f64::NAN).total_cmp(&tried[*a].before.unwrap_or(f64::NAN)));
    let mut best: Option<(usize, Chosen)> = None;
    for (rank, k) in order.into_iter().enumerate() {
        if rank >= MAX_SEARCHES {
            tried[k].reason = Some(format!("not searched: {MAX_SEARCHES} ropes are better at the start"));
            continue;
        }
        match run.search(texts[k].clone()) {
            Ok(chosen) => {
                tried[k].after = Some(chosen.value());
                if best.as_ref().is_none_or(|(_, best)| chosen.value() > best.value()) {
                    best = Some((k, chosen));
                }
            }
            Err(error) if error.is::<Cancelled>() => return Err(error),
            Err(error) => tried[k].reason = Some(format!("{error:#}")),
        }
    }
    let sign = run.request.goal.sign();
    for row in &mut tried {
        (row.before, row.after) = (row.before.map(|value| sign * value), row.after.map(|value| sign * value));
    }
    let Some((k, chosen)) = best else {
        let reasons: Vec<String> =
            tried.iter().map(|row| format!("{}: {}", row.name, row.reason.as_deref().unwrap_or("no value"))).collect();
        bail!(crate::error::NoSolution(format!("none of the ropes will do; {}", reasons.join("; "))));
    };
    tried[k].chosen = true;
    Ok((chosen, tried))
}

/// Names of the materials of a robot file.
fn materials(text: &str) -> Result<Vec<String>> {
    let document: DocumentMut = text.parse()?;
    let materials = document.get("materials").and_then(Item::as_table_like);
    Ok(materials.map(|of| of.iter().map(|(name, _)| name.to_owned()).collect()).unwrap_or_default())
}

/// Text with the values of a rope in every material, instead of those of its section; limits of tensions that the rope
/// does not have stay.
fn with_rope(text: &str, materials: &[String], rope: &OfferedRope) -> Result<String> {
    let mut document: DocumentMut = text.parse()?;
    let mut assignments = Vec::new();
    for material in materials {
        let table = document.get_mut("materials").and_then(|of| of.get_mut(material)).and_then(Item::as_table_like_mut);
        if let Some(table) = table {
            for key in OF_SECTION {
                table.remove(key);
            }
        }
        for (key, value) in rope.material() {
            let path =
                set_values::path(&format!("materials.{material}.{key}")).map_err(|reason| anyhow!("{reason}"))?;
            assignments.push(path.with("⟪ropes⟫", value));
        }
    }
    set_values::apply(&document.to_string(), &assignments)
        .map_err(|error| anyhow!("⟪ropes⟫, rope {}: {error}", rope.name))
}

impl DesignRun<'_> {
    /// Number of pairs of cables that cross at the first pose.
    fn crossings(&self, text: &str) -> Result<usize> {
        let first = self.first_at_rest(Parameters::from_toml(text)?.robot())?;
        Ok(Surroundings::of(&first.robot).crossing_cables(&first.equilibrium).len())
    }
}

/// Exchanges of attachments, with the value of the goal before them.
#[derive(Default)]
pub(super) struct Exchanges {
    before: f64,
    pub(super) rows: Vec<ExchangeRow>,
}

impl Exchanges {
    /// Sentence on the exchanges.
    pub(super) fn in_words(&self, unit: &str) -> Option<String> {
        let last = self.rows.last()?;
        let pairs: Vec<String> =
            self.rows.iter().map(|row| format!("{} and {}", row.cables[0], row.cables[1])).collect();
        let [before, after] = [self.before, last.after].map(|value| with_unit(&significant(value, 5), unit));
        Some(format!(
            "Attachments exchanged: {}: from {before} to {after}, before any value changes",
            pairs.join(", then ")
        ))
    }
}

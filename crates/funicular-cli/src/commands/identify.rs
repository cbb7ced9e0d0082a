//! `identify`: files of measurements, text and CSV.

use super::profile_table::{Profiled, profiles};
use crate::args::{Cli, IdentifyArgs};
use crate::output::Printed;
use crate::table::{Table, counted, significant};
use anyhow::{Context, Result, bail};
use funicular_answers::inputs::FilesRead;
use funicular_formats::measurements::{self, FileOptions};
use funicular_study::analyses::identify::{FittedValue, Identified, PoleRow, ProposedMeasurement, StaticRow};
use funicular_study::request::{Experiment, FitValue, IdentifyRequest, ResponsePoints};
use serde_json::Value;
use std::fmt::Write as _;
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// Adds the measurements of all files, and the values known beforehand, to a request.
pub(super) fn complete(of: &mut IdentifyRequest, cli: &Cli, read: &mut FilesRead) -> Result<()> {
    let args: IdentifyArgs = cli.files()?;
    of.experiments = experiments(cli, &args, read)?;
    add_priors(&mut of.fit, &args.prior)
}

/// Measurements of all files, and those that are given themselves.
fn experiments(cli: &Cli, args: &IdentifyArgs, read: &mut FilesRead) -> Result<Vec<Experiment>> {
    args.measured.iter().chain(&args.experiments).for_each(|file| read.add("the measurements", file));
    let mut experiments = match &args.experiments {
        Some(path) => read_experiments(path)?,
        None => Vec::new(),
    };
    let mut own: Experiment = serde_json::from_value(Value::Object(cli.given::<Experiment>()))?;
    let points: ResponsePoints = serde_json::from_value(Value::Object(cli.given::<ResponsePoints>()))?;
    for path in &args.measured {
        read.notes.extend(read_measured(path, args, points, &mut own)?);
    }
    let is_measured = !own.responses.is_empty()
        || !own.frequencies.is_empty()
        || !own.histories.is_empty()
        || own.measured_pose.is_some()
        || own.measured_tensions_n.is_some()
        || own.measured_lengths_m.is_some();
    if is_measured || experiments.is_empty() {
        experiments.insert(0, own);
    }
    Ok(experiments)
}

/// Adds values that are known beforehand to the values that are identified.
fn add_priors(fit: &mut [FitValue], priors: &[FitValue]) -> Result<()> {
    for prior in priors {
        let Some(place) = fit.iter().position(|value| value.path == prior.path) else {
            let fitted: Vec<&str> = fit.iter().map(|value| value.path.as_str()).collect();
            bail!(
                "⟪prior⟫ {}: no ⟪fit⟫ has this path; ⟪fit⟫ is given for each value by itself, and was given for `{}`",
                prior.path,
                fitted.join("`, `"),
            );
        };
        let value = &mut fit[place];
        *value = FitValue { prior: prior.prior, prior_std: prior.prior_std, ..value.clone() };
    }
    Ok(())
}

/// Bytes of a file of measurements.
fn bytes_of(path: &Path) -> Result<Vec<u8>> {
    let shown = path.display();
    if path.is_dir() {
        bail!("cannot read {shown}: it is a directory; name a file in it");
    }
    let mut bytes = Vec::new();
    let file = File::open(path).with_context(|| format!("cannot read the measurements {shown}"))?;
    // One byte is read beyond the limit, which shows that a file is too large.
    file.take(measurements::MAX_BYTES as u64 + 1)
        .read_to_end(&mut bytes)
        .with_context(|| format!("cannot read the measurements {shown}"))?;
    Ok(bytes)
}

/// Adds the measurements of a file, and returns notes about them.
fn read_measured(path: &Path, args: &IdentifyArgs, points: ResponsePoints, to: &mut Experiment) -> Result<Vec<String>> {
    let shown = path.display().to_string();
    let bytes = bytes_of(path)?;
    let options = FileOptions {
        nodes: args.node.clone(),
        responses: args.response.clone(),
        input_point_m: points.input_point_m,
        output_point_m: points.output_point_m,
    };
    let found = measurements::read(&shown, &bytes, &options)?;
    to.responses.extend(found.responses);
    to.frequencies.extend(found.frequencies);
    to.histories.extend(found.histories);
    Ok(found.notes)
}

/// Experiments of a JSON file.
fn read_experiments(path: &Path) -> Result<Vec<Experiment>> {
    let shown = path.display().to_string();
    let bytes = bytes_of(path)?;
    measurements::check_size(&shown, bytes.len())?;
    IdentifyRequest::experiments_from_json(&bytes).with_context(|| shown)
}

/// Natural frequencies of time histories, with what was found about the readings.
fn histories(found: &Identified) -> String {
    let mut text = String::new();
    for history in &found.histories {
        let _ = writeln!(text, "{}, {} of {} s:", history.name, history.kind, significant(history.duration_s, 4));
        let _ = write!(text, "\n{}\n\n", Table::of(&PoleRow::columns(), &history.poles));
        for check in &history.checks {
            let _ = writeln!(text, "{check}.");
        }
        text.push('\n');
    }
    text
}

/// Table of the fitted values, and how well they fit.
fn values(found: &Identified) -> String {
    format!(
        "{}: {} from {}\n\n{}\n\nχ² = {} for {} of freedom, χ²/n = {}: {}.\n{} tried.\n",
        found.robot,
        counted(found.values.len(), "value"),
        counted(found.residuals, "residual"),
        Table::of(&FittedValue::columns(), FittedValue::all(found)),
        significant(found.chi2, 4),
        counted(found.degrees_of_freedom, "degree"),
        significant(found.chi2_per_degree, 3),
        found.verdict,
        counted(found.starts.len(), "start"),
    )
}

impl Printed for Identified {
    fn text(&self) -> String {
        if self.values.is_empty() {
            return format!("{}\n\n{}", self.robot, histories(self));
        }
        let mut text = histories(self);
        text += &values(self);
        text += &assignment(self);
        text += &profiles(self.values.iter().filter_map(|row| {
            let profile = row.profile.as_ref()?;
            Some(Profiled {
                path: &row.path,
                unit: row.unit,
                value: row.value,
                digits: row.digits(),
                profile,
                parabola: row.parabola_95,
            })
        }));
        for strong in &self.strong_correlations {
            let _ = writeln!(text, "{strong}.");
        }

        if let Some(after) = self.frequency_rms {
            let before = self.frequency_rms_before.map_or_else(
                || "; before the fit, these modes cannot be computed".to_owned(),
                |before| format!(", before {} %", significant(100.0 * before, 3)),
            );
            let _ = write!(
                text,
                "\n{}: root mean square of the differences {} %{before}.\n",
                counted(self.frequencies.len(), "natural frequency"),
                significant(100.0 * after, 3)
            );
        }
        if !self.responses.is_empty() {
            let _ = write!(text, "\n{}\n", responses(self));
        }
        if !self.statics.is_empty() {
            let _ = write!(text, "\n{}\n", Table::of(&StaticRow::columns(), &self.statics));
        }
        if !self.proposals.is_empty() {
            let _ = write!(
                text,
                "\nMeasurements to make next, one after the other\n{}\n",
                Table::of(&ProposedMeasurement::columns(&self.proposals), &self.proposals)
            );
        }
        if let Some(count) = self.measurements_needed {
            let _ = writeln!(text, "{} reach the wanted deviation.", counted(count, "proposed measurement"));
        }
        text
    }
}

/// Modes of the measured frequencies, the second best ones, and fits to random frequencies; empty if every frequency
/// has a number.
fn assignment(found: &Identified) -> String {
    let Some(assignment) = &found.assignment else { return String::new() };
    let mut text = assignment.random_text().map_or_else(String::new, |sentence| format!("{sentence}\n"));
    let mut columns = vec!["measured [Hz]", "mode", "fitted [Hz]"];
    if assignment.second_best.is_some() {
        columns.extend(["second best: mode", "fitted [Hz]"]);
    }
    let mut table = Table::new(&columns);
    for (k, row) in found.frequencies.iter().enumerate() {
        let mut cells = vec![significant(row.measured_hz, 5), row.number.to_string(), significant(row.fitted_hz, 5)];
        if let Some(second) = &assignment.second_best {
            cells.extend([second.numbers[k].to_string(), significant(second.frequency_hz[k], 5)]);
        }
        table.row(cells);
    }
    let _ = write!(text, "\n{table}\n");
    if let Some(second) = &assignment.second_best {
        let _ = writeln!(text, "{}.", second.sentence(&found.values));
    }
    text
}

/// Table of the responses with their residuals.
fn responses(found: &Identified) -> Table {
    let mut table = Table::new(&["response", "lines", "residual [deviations]"]).text_columns(&[0]);
    for response in &found.responses {
        let name = if response.name.is_empty() {
            format!("{}/{}", response.output, response.input)
        } else {
            response.name.clone()
        };
        table.row(vec![name, response.frequency_hz.len().to_string(), significant(response.residual_rms, 3)]);
    }
    table
}

//! Tracking of the modes of a sweep of one value from row to row.

use super::Tracking;
use funicular::modes::Mode;
use funicular::modes::tracking::{Tracked, track};
use funicular_study::Watch;
use funicular_study::sweep::{PreparedSweep, Quantity, lowest_modes};
use funicular_study::table::{Record, SweepRows};
use funicular_study::text::counted;

/// Maximum number of rows whose modes are computed again for tracking: about a minute of work.
const MAX_TRACKED: usize = 2000;

/// Follows the modes of a sweep of one value from row to row, or gives the reason why not; `None` if the rows have no
/// modes to follow.
pub(super) fn tracking(file: &dyn SweepRows, watch: &mut dyn Watch) -> Option<Result<Tracking, String>> {
    let record = file.record();
    let varied = record.plan.get("vary")?.as_array()?.iter().filter(|axis| {
        axis["count"].as_u64().unwrap_or(1) > 1 || axis["values"].as_array().is_some_and(|values| values.len() > 1)
    });
    if varied.count() != 1 {
        return None;
    }
    let quantities = record.plan.get("quantities")?.as_array()?.iter();
    let count = quantities.filter_map(|name| name.as_str()?.parse::<Quantity>().ok()?.count());
    let count = count.max().filter(|count| *count > 1)?;
    Some(follow(file, record, count, watch))
}

fn follow(file: &dyn SweepRows, record: &Record, count: usize, watch: &mut dyn Watch) -> Result<Tracking, String> {
    if file.rows() > MAX_TRACKED {
        return Err(format!(
            "{} are too many to follow their modes (at most {MAX_TRACKED}): sweep in larger steps",
            counted(file.rows(), "value")
        ));
    }

    let again = PreparedSweep::of_record(record).map_err(|error| format!("{error:#}"))?;
    let mut steps: Vec<Vec<(Mode, Tracked)>> = Vec::with_capacity(file.rows());
    for i in file.first_row()..file.first_row() + file.rows() {
        // A row without modes has its reason in the file.
        let found = lowest_modes(&again.points().point(i), count, again.options());
        steps.push(found.map_or_else(|_| Vec::new(), |found| found.modes.into_iter().zip(found.tracked).collect()));

        watch.progress(steps.len(), file.rows(), "values with their modes");
        if watch.is_cancelled() {
            return Err("stopped before the end".to_owned());
        }
    }

    let (modes, tracked): (Vec<Vec<Mode>>, Vec<Vec<Tracked>>) =
        steps.into_iter().map(|step| step.into_iter().unzip()).unzip();
    let branches = track(&tracked);

    Ok(Tracking { modes, branches })
}

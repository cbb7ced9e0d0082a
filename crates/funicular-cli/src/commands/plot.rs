//! `plot`: the page of a map or sweep.

use crate::args::PlotArgs;
use crate::commands::report::{command_line, write};
use crate::errors;
use crate::output::{Content, Target};
use crate::page::plot::{PlotInput, Tracking, plot};
use crate::progress::{Progress, Waiting};
use crate::sweeping::again::Again;
use crate::table::counted;
use anyhow::{Result, bail};
use funicular::modes::Mode;
use funicular::modes::track::{Tracked, branches};
use funicular::sweep::{Points as _, Quantity, lowest_modes};
use funicular_files::{Guard, Record, SweepFile};

/// Most values of a sweep whose modes are computed again to be tracked: a minute of work.
const MOST_TRACKED: usize = 2000;

pub(crate) fn run(args: &PlotArgs) -> Result<()> {
    let file = SweepFile::open(&args.file)?;
    let to = args.output_file.clone().unwrap_or_else(|| args.file.with_extension("html"));
    let mut guard = Guard::default();
    guard.reads("the rows in", &args.file);
    let target = Target::open(Some(&to), Content::PAGE, &mut guard)?;
    if file.rows == 0 {
        let shown = args.file.display();
        match file.record.part.filter(|_| file.complete) {
            Some(part) => bail!(
                "{shown} is part {part} of {}, which has none of them: plot what `funicular merge` makes of all parts",
                counted(file.record.rows, "row")
            ),
            None => bail!("{shown} has no rows yet: let the sweep go on with --resume"),
        }
    }
    let tracking = tracking(&file);
    let waiting = Waiting::for_("the pictures");
    let page = plot(&PlotInput {
        file: &file,
        label: args.file.display().to_string(),
        command_line: command_line()?,
        tracking,
    })?;
    drop(waiting);
    write(&target, &to, &page.html)?;
    page.notes.iter().for_each(|note| errors::warn(note));
    Ok(())
}

/// The modes of a sweep of one value, followed from row to row, or why they are not; `None` where there are none to follow.
fn tracking(file: &SweepFile) -> Option<Result<Tracking, String>> {
    let record = &file.record;
    let varied = record.plan.get("grid")?.as_array()?.iter().filter(|axis| {
        axis["count"].as_u64().unwrap_or(1) > 1 || axis["values"].as_array().is_some_and(|values| values.len() > 1)
    });
    if record.plan.get("command")? != "sweep" || varied.count() != 1 {
        return None;
    }
    let quantities = record.plan.get("quantities")?.as_array()?.iter();
    let count = quantities.filter_map(|name| match name.as_str()?.parse() {
        Ok(Quantity::Frequencies(count)) => Some(count),
        _ => None,
    });
    let count = count.max().filter(|count| *count > 1)?;
    Some(follow(file, record, count))
}

fn follow(file: &SweepFile, record: &Record, count: usize) -> Result<Tracking, String> {
    if file.rows > MOST_TRACKED {
        return Err(format!(
            "{} are more than the {MOST_TRACKED} whose modes are followed: sweep in larger steps",
            counted(file.rows, "value")
        ));
    }
    let again = Again::of(record)?;
    let mut progress = Progress::with_rate(file.rows, "values with their modes");
    let mut steps: Vec<Vec<(Mode, Tracked)>> = Vec::with_capacity(file.rows);
    for i in file.first_row..file.first_row + file.rows {
        // A row without modes says why in the file.
        let found = lowest_modes(&again.points.point(i), count, &again.options);
        steps.push(found.map_or_else(|_| Vec::new(), |found| found.modes.into_iter().zip(found.tracked).collect()));
        progress.advance(1);
    }
    drop(progress);
    let (modes, tracked): (Vec<Vec<Mode>>, Vec<Vec<Tracked>>) =
        steps.into_iter().map(|step| step.into_iter().unzip()).unzip();
    let branches = branches(&tracked);
    Ok(Tracking { modes, branches })
}

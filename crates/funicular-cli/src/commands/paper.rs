//! `paper`: the page of the starting paper.

use crate::args::PaperArgs;
use crate::commands::report::{command_line, write};
use crate::output::{Content, Target};
use crate::page::paper::paper;
use crate::progress::Waiting;
use anyhow::Result;
use funicular_files::Guard;

pub(crate) fn run(args: &PaperArgs) -> Result<()> {
    let target = Target::open(Some(&args.output_file), Content::PAGE, &mut Guard::default())?;
    let waiting = Waiting::for_("the paper's figures and tables");
    let page = paper(command_line()?)?;
    drop(waiting);
    write(&target, &args.output_file, &page)
}

//! Two pages A4 about a robot at its state, for the person who decides: what it carries and where, what it needs, what
//! is dangerous, and what was assumed. Their drawings are written as PDF, or as SVG in a page of HTML.

mod parts;
mod sheet;

use crate::figures::drawing::Drawing;
use crate::figures::{pdf, svg};
use anyhow::Result;
use askama::Template;
use funicular_study::Watch;
use funicular_study::request::ReportRequest;
use funicular_study::robot_file::RobotFile;
use funicular_study::wording::{Words, worded};
use parts::Parts;

pub use parts::Clock;

/// Two pages.
pub struct Summary {
    title: String,
    drawings: Vec<Drawing>,
    /// Warnings of all parts, one sentence each.
    pub warnings: Vec<String>,
}

#[derive(Template)]
#[template(path = "summary.html")]
struct SummaryPage<'a> {
    title: &'a str,
    version: &'static str,
    pages: Vec<String>,
}

impl Summary {
    /// Computes every part once and draws the pages; a part that takes too long or has no result says so. `call` makes
    /// them again, `words` are those for the names of options, and `clock` tells when it is too long.
    ///
    /// # Errors
    /// A request that contradicts itself or the robot, or a robot without this equilibrium.
    pub fn of_request(
        request: &ReportRequest,
        file: &RobotFile,
        (call, words): (&str, Words),
        watch: &mut dyn Watch,
        clock: Clock<'_>,
    ) -> Result<Self> {
        request.check()?;
        let parts = Parts::of(request, &file.robot, watch, clock)?;
        Ok(Self {
            title: format!("{}: summary", parts.robot),
            drawings: sheet::pages(&parts, call, &|text: &str| worded(text, words)),
            warnings: parts.warnings,
        })
    }

    /// Page of HTML that prints as two pages A4.
    ///
    /// # Errors
    /// A page that cannot be written.
    pub fn html(&self) -> Result<String> {
        let pages = self.drawings.iter().map(svg::svg).collect();
        Ok(SummaryPage { title: &self.title, version: env!("CARGO_PKG_VERSION"), pages }.render()?)
    }

    /// Bytes of the two pages as PDF.
    pub fn pdf(&self) -> Vec<u8> {
        pdf::pages(&self.drawings)
    }
}

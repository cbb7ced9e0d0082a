//! Pages in HTML that open offline: one file with its figures, its numbers and the library that draws them.
//!
//! A page is a template of prose ([`report`], [`paper`]) into which [`figure::Figure`]s and [`table::Table`]s are set.
//! Nothing on it depends on the time, on chance or on the network: two runs write the same bytes.

pub mod figure;
pub mod paper;
pub mod report;
pub mod table;

use plotly::Plot;

/// What every page has around its own content.
pub struct Shell {
    /// Title of the page.
    pub title: String,
    /// (id, name) of the sections, for the list of contents.
    pub contents: &'static [(&'static str, &'static str)],
    version: &'static str,
    style: &'static str,
    script: &'static str,
    bundle: String,
}

impl Shell {
    /// Of a page with this title and these sections.
    pub fn new(title: String, contents: &'static [(&'static str, &'static str)]) -> Self {
        Self {
            title,
            contents,
            version: env!("CARGO_PKG_VERSION"),
            style: include_str!("../templates/page.css"),
            script: include_str!("../templates/page.js"),
            bundle: plotly_script(),
        }
    }
}

/// The `<script>` that holds plotly.js.
///
/// The crate hands out plotly.js and `MathJax` together; formulas here are plain text, so the second, of 2 MB, stays out.
fn plotly_script() -> String {
    const END: &str = "</script>";
    let mut sources = Plot::offline_js_sources();
    let end = sources.find(END).map_or(sources.len(), |at| at + END.len());
    sources.truncate(end);
    sources
}

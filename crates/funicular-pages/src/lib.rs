//! Pages and figures of funicular.
//!
//! [`pages`] makes HTML files that work offline, and [`figures`] makes figures for papers as SVG and PDF. Both take the
//! results of [`funicular_study`] and use no disk and no threads. They are not part of that crate, because they include
//! plotly.js and the font of the figures, which a front end without them does not need.

pub mod figure_style;
pub mod figures;
pub mod pages;

/// Example of README.md, which is tested like those of the documentation.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

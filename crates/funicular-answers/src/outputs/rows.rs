//! Rows of the table of files, one function for each kind of file, and what their bytes need.

use super::{Answered, Drawn, FigureOptions, Made, Make, Output, always};
use anyhow::{Result, bail};
use funicular_files::endings::Kind;
use funicular_formats::surface::{self, SurfaceFormat};
use funicular_study::Watch;
use funicular_study::analyses::prove::Proved;
use funicular_study::analyses::workspace::Workspace;
use funicular_study::text::counted;
use funicular_validation::Validated;

pub(super) type BytesOf = fn(&Answered<'_>, Option<Kind>) -> Result<Made>;

/// File that `-o` does not name by its ending. `words` are its name and its content in messages.
pub(super) const fn file(
    key: &'static str,
    about: &'static str,
    words: [&'static str; 2],
    kinds: &'static [Kind],
    make: Make,
) -> Output {
    let [name, in_words] = words;
    Output {
        key,
        about,
        name,
        in_words,
        kinds,
        by_ending: false,
        several: false,
        folder: false,
        needs: None,
        check: always,
        of_request: false,
        make,
    }
}

pub(super) const fn page(about: &'static str, make: fn(&Answered<'_>) -> Result<String>) -> Output {
    Output { by_ending: true, ..file("page", about, ["the page", "a page"], &[Kind::Html], Make::Page(make)) }
}

pub(super) const fn figure(
    about: &'static str,
    make: fn(&Answered<'_>, &FigureOptions, &mut dyn Watch) -> Result<Drawn>,
) -> Output {
    let words = ["the figure", "a figure"];
    Output { by_ending: true, ..file("figure", about, words, &[Kind::Svg, Kind::Pdf], Make::Figure(make)) }
}

/// Figure that is made of the request alone.
pub(super) const fn drawn(
    about: &'static str,
    make: fn(&Answered<'_>, &FigureOptions, &mut dyn Watch) -> Result<Drawn>,
) -> Output {
    Output { of_request: true, ..figure(about, make) }
}

pub(super) const fn robot_file(key: &'static str, about: &'static str, make: BytesOf) -> Output {
    let words = ["the robot file", "a robot file"];
    Output { by_ending: true, ..file(key, about, words, &[Kind::Toml], Make::Bytes(make)) }
}

pub(super) const fn universal_file(make: BytesOf) -> Output {
    let (about, words) = ("Write the result as a Universal File", ["the Universal File", "a Universal File"]);
    Output { by_ending: true, ..file("universal_file", about, words, &[Kind::Uff], Make::Bytes(make)) }
}

pub(super) const fn lengths(about: &'static str, make: BytesOf) -> Output {
    file("lengths", about, ["the lengths", "CSV"], &[Kind::Csv], Make::Bytes(make))
}

/// Report of `validate` for build servers.
pub(super) const JUNIT: Output = Output {
    by_ending: true,
    ..file(
        "junit",
        "Write a report for build servers in the format of JUnit, one test per comparison",
        ["the report", "a report of tests"],
        &[Kind::Xml],
        Make::Bytes(|at, _| of_validated(at, funicular_validation::junit)),
    )
};

/// Badge of `validate`.
pub(super) const BADGE: Output = Output {
    by_ending: true,
    ..file(
        "badge",
        "Write a badge that says how many comparisons pass",
        ["the badge", "a badge"],
        &[Kind::Svg],
        Make::Bytes(|at, _| of_validated(at, funicular_validation::badge)),
    )
};

fn of_validated(at: &Answered<'_>, make: fn(&Validated) -> String) -> Result<Made> {
    match at.validated {
        Some(found) => Ok(make(found).into_bytes().into()),
        None => bail!("`{}` has no such file", at.request.command()),
    }
}

/// Surface of what is proved inside.
pub(super) const fn proved_surface(make: BytesOf) -> Output {
    let about = "Write the surface of what is proved inside [m] to FILE.stl, FILE.ply or FILE.vtp (ParaView)";
    let kinds = &[Kind::Stl, Kind::Ply, Kind::Vtp];
    Output { several: true, ..file("proved", about, ["the proved set", "a surface"], kinds, Make::Bytes(make)) }
}

/// Certificate of a proof.
pub(super) const fn certificate(make: BytesOf) -> Output {
    let about = "Write a certificate as lines of JSON, which scripts/check_certificate.py checks with rational numbers";
    file("certificate", about, ["the certificate", "lines of JSON"], &[Kind::JsonLines], Make::Bytes(make))
}

pub(super) fn proved_of(found: Option<&Proved>, kind: Option<Kind>) -> Result<Made> {
    let Some(found) = found else { bail!("nothing was proved: give ⟪prove⟫") };
    let bytes = surface::of_proof(&found.surface, format_of(kind))?;
    Ok(Made { size: Some(counted(found.surface.triangles.len(), "triangle")), ..bytes.into() })
}

pub(super) fn certificate_of(found: Option<&Proved>) -> Result<Made> {
    let Some(found) = found else { bail!("nothing was proved: give ⟪prove⟫") };
    Ok(found.certificate().into_bytes().into())
}

fn format_of(kind: Option<Kind>) -> SurfaceFormat {
    match kind {
        Some(Kind::Stl) => SurfaceFormat::Stl,
        Some(Kind::Ply) => SurfaceFormat::Ply,
        _ => SurfaceFormat::Vtp,
    }
}

/// Surface of a workspace in the format of its file.
pub(super) fn surface_of(found: &Workspace, kind: Option<Kind>) -> Result<Made> {
    let bytes = surface::of_workspace(found, format_of(kind))?;
    Ok(Made { size: Some(counted(found.triangles.len(), "triangle")), ..bytes.into() })
}

//! Page about a workspace: its surface in space, volumes, parts and sections.

use super::Shell;
use super::figure::robot::surface_in_space;
use super::figure::{PageFigure, axis, colour, line, with};
use super::table::{PageTable, significant};
use anyhow::Context as _;
use askama::Template;
use funicular_study::analyses::workspace::{PartOfWorkspace, SectionOfWorkspace, VolumeRow, Workspace};
use funicular_study::text::short;
use serde_json::{Value, json};

/// Colours of sections, repeated if there are more.
const SECTION_COLOURS: [&str; 6] =
    [colour::BLUE, colour::VERMILION, colour::GREEN, colour::PURPLE, colour::ORANGE, colour::SKY];

#[derive(Template)]
#[template(path = "workspace.html")]
struct WorkspacePage<'a> {
    shell: Shell,
    found: &'a Workspace,
    conditions: String,
    summary: String,
    surface: PageFigure,
    volumes: PageTable,
    pieces: PageTable,
    sections: Option<PageFigure>,
    areas: PageTable,
    proof: Vec<String>,
    proved: Option<PageTable>,
    command_line: String,
}

/// Writes the page as HTML; `command_line` is the command that writes it again.
///
/// # Errors
/// A page that cannot be written.
pub fn page(found: &Workspace, command_line: String) -> anyhow::Result<String> {
    let has_sections = found.sections.iter().any(|section| !section.polygons_m.is_empty());
    let contents = [
        Some(("set", "Set")),
        Some(("volumes", "Volumes")),
        has_sections.then_some(("sections", "Sections")),
        found.proof.as_ref().map(|_| ("proof", "Proof")),
        Some(("repeat", "How to repeat")),
    ];
    let contents: Vec<(&str, &str)> = contents.into_iter().flatten().collect();
    let volume = found.volume();
    let page = WorkspacePage {
        shell: Shell::new(format!("{}: workspace", found.robot), contents),
        found,
        conditions: found.conditions.iter().map(ToString::to_string).collect::<Vec<_>>().join(", "),
        summary: match &found.plane {
            Some(plane) => format!(
                "{} m² in the plane {} = {} m, with {} cables. The surface and its volumes are those of a slab of 1 m.",
                significant(plane.area_m2, 5),
                plane.axis,
                short(plane.at_m, 4),
                found.static_model
            ),
            None => format!(
                "{} m³{} with steps of {} m, with {} cables.",
                significant(volume.volume_m3, 5),
                found.relative_error().map_or_else(String::new, |of| format!(" ± {} %", significant(100.0 * of, 2))),
                short(volume.step_m, 4),
                found.static_model
            ),
        },
        surface: surface(found),
        volumes: volumes(found),
        pieces: pieces(found),
        sections: has_sections.then(|| sections(found)),
        areas: areas(found),
        proof: found.proof.as_ref().map(super::prove::sentences).unwrap_or_default(),
        proved: found.proof.as_ref().map(super::prove::volumes),
        command_line,
    };
    page.render().context("the page could not be written as HTML")
}

/// Figure of the surface with the anchors and the box of the grid.
fn surface(found: &Workspace) -> PageFigure {
    let cut = if found.touches.is_empty() { "" } else { " Grey: where the box of the grid cuts the set." };
    let caption = format!(
        "Surface of the set, with one scale for all three axes. Squares: anchors. Drag to rotate, scroll to zoom.{cut}"
    );
    surface_in_space(found, caption)
}

fn volumes(found: &Workspace) -> PageTable {
    let caption = "Volume with the steps of the grid, with larger steps, and along rays. The error is the largest that \
                   the steps and points between the nodes let expect.";
    PageTable::of("table-volumes", caption, &VolumeRow::columns(), &found.volumes)
}

fn pieces(found: &Workspace) -> PageTable {
    let mut table = PageTable::new("table-pieces", "Parts and holes.", &["kind", "volume|m³", "handles"]);
    let mut add = |kind: &str, pieces: &[PartOfWorkspace]| {
        for piece in pieces {
            table.row(vec![kind.to_owned(), significant(piece.volume_m3, 5), piece.handles.to_string()]);
        }
    };
    add("part", &found.parts);
    add("hole", &found.holes);
    table
}

/// Name of a section, as in `z = 1.5 m`.
fn name(section: &SectionOfWorkspace) -> String {
    format!("{} = {} m", section.axis, short(section.at_m, 6))
}

/// Figure of all sections; those at right angles to different axes stand beside each other.
fn sections(found: &Workspace) -> PageFigure {
    let planes: Vec<&str> = ["x", "y", "z"]
        .into_iter()
        .filter(|axis| found.sections.iter().any(|section| section.axis == *axis && !section.polygons_m.is_empty()))
        .collect();
    let mut data: Vec<Value> = Vec::new();
    let mut layout = json!({});
    for (place, plane) in planes.iter().enumerate() {
        let number = if place == 0 { String::new() } else { (place + 1).to_string() };
        let (x, y) = (format!("x{number}"), format!("y{number}"));
        let [across, up] = across_and_up(plane);
        let width = 1.0 / planes.len() as f64;
        let begin = place as f64 * width;
        let domain = json!({"domain": [begin, begin + width - 0.08], "anchor": y.clone()});
        layout[format!("xaxis{number}")] = axis(&format!("{} [m]", ["x", "y", "z"][across]), domain);
        let scale = json!({"anchor": x.clone(), "scaleanchor": x.clone()});
        layout[format!("yaxis{number}")] = axis(&format!("{} [m]", ["x", "y", "z"][up]), scale);

        for (i, section) in found.sections.iter().enumerate().filter(|(_, section)| section.axis == *plane) {
            for (k, polygon) in section.polygons_m.iter().enumerate() {
                let along =
                    |of: usize| polygon.iter().chain(polygon.first()).map(|point| point[of]).collect::<Vec<f64>>();
                let tone = SECTION_COLOURS[i % SECTION_COLOURS.len()];
                let drawn = line(&name(section), &along(across), &along(up), tone, "solid");
                let group = name(section);
                data.push(with(drawn, json!({"xaxis": x, "yaxis": y, "legendgroup": group, "showlegend": k == 0})));
            }
        }
    }
    PageFigure::new("figure-sections", 460, "Sections of the surface.", &data, layout)
}

/// Numbers of the axes of a section to the right and upwards.
fn across_and_up(axis: &str) -> [usize; 2] {
    match axis {
        "x" => [1, 2],
        "y" => [0, 2],
        _ => [0, 1],
    }
}

fn areas(found: &Workspace) -> PageTable {
    let mut table = PageTable::new("table-sections", "Areas of the sections.", &["section", "area|m²", "polygons"]);
    for section in &found.sections {
        table.row(vec![name(section), significant(section.area_m2, 5), section.polygons_m.len().to_string()]);
    }
    table
}

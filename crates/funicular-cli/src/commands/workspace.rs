//! `workspace`: run on all cores, text, and files of the surface.

use crate::args::{ChangeArgs, Cli, DrawArgs, FigureArgs, OutputArgs, WorkspaceArgs};
use crate::errors::{self, Interrupted};
use crate::interrupt::{STOPPED, stop_at_next_row};
use crate::output::{Content, FigureSink, Printed, Sink, Target};
use crate::progress::{Progress, ProgressLines};
use crate::robot_file;
use crate::table::{Table, counted, short, significant, vector};
use anyhow::{Result, bail};
use funicular_files::endings::Kind;
use funicular_files::{Guard, WorkspaceRun, threads};
use funicular_formats::surface::{self, SurfaceFormat};
use funicular_pages::figures;
use funicular_study::analyses::workspace::{
    ComparedSets, PartOfWorkspace, RaysOfWorkspace, VolumeRow, Workspace, WorkspaceStudy,
};
use funicular_study::request::{Request, RobotText, WorkspaceRequest};
use funicular_study::wording::{Words, worded};
use serde_json::{Map, Value};
use std::fmt::Write as _;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;

/// Kinds of files that hold a surface.
const SURFACES: [Kind; 3] = [Kind::Stl, Kind::Ply, Kind::Vtp];

/// Largest number of parts or holes that the text lists.
const SHOWN: usize = 6;

/// Request of a workspace, with the robot of a comparison.
pub(super) fn request(cli: &Cli, further: Map<String, Value>) -> Result<Request> {
    let WorkspaceArgs { compare, compare_set, .. } = cli.files()?;
    let mut request = cli.request(further)?;
    if let Request::Workspace(of) = &mut request {
        of.compare = match compare {
            Some(path) => Some(robot_file::read(Some(&path), &ChangeArgs { set: compare_set })?),
            None if compare_set.is_empty() => None,
            None => Some(RobotText { set: [&of.robot.set[..], &compare_set].concat(), ..of.robot.clone() }),
        };
    }
    Ok(request)
}

/// Runs `workspace`: prints the result, writes the surface and the page. `-o` may name either of them.
pub(super) fn run(of: &WorkspaceRequest, args: &WorkspaceArgs, guard: &mut Guard) -> Result<()> {
    let DrawArgs { output: sink, figure } = &args.drawn;
    let output = sink.output_file.as_deref().filter(|_| sink.format.is_none());
    let to_surface = output.filter(|path| format_of(path).is_some());
    let to_page = output.filter(|path| Kind::of(path) == Some(Kind::Html));
    if let (Some(_), Some(_)) = (to_page, &args.page) {
        bail!("⟪page⟫ and -o name a page each: leave out one of them");
    }

    let drawn = FigureSink::open(output, *figure, guard)?;
    let is_elsewhere = to_surface.is_some() || to_page.is_some() || drawn.is_some();
    let printed = OutputArgs { format: sink.format, output_file: sink.output_file.clone().filter(|_| !is_elsewhere) };
    let sink = Sink::open(&printed, &[&SURFACES[..], &[Kind::Html, Kind::Svg, Kind::Pdf]].concat(), guard)?;
    let surfaces = to_surface.into_iter().chain(args.surface.iter().map(PathBuf::as_path));
    let surfaces = surfaces.map(|path| open_surface(path, guard)).collect::<Result<Vec<_>>>()?;
    let page = to_page.or(args.page.as_deref());
    let page = page.map(|path| anyhow::Ok((Target::open(Some(path), Content::PAGE, guard)?, path))).transpose()?;

    let study = WorkspaceStudy::new(of.robot.read()?.robot, of)?;
    if drawn.is_some() && !study.has_sections() {
        bail!("a figure of a workspace shows its sections: give ⟪section⟫, as in z=0.5,1,1.5");
    }
    let found = compute(&study, args.threads)?;
    sink.write(&found)?;
    if let Some(drawn) = drawn {
        drawn.write(&figures::of_sections(&found)?)?;
    }
    for (target, format, path) in surfaces {
        target.write(&surface::of_workspace(&found, format)?)?;
        errors::note(&format!("{} in {}", counted(found.triangles.len(), "triangle"), path.display()));
    }
    if let Some((target, path)) = page {
        let page = funicular_pages::pages::workspace::page(&found, super::page::command_line()?)?;
        target.write(worded(&page, Words::Program).as_bytes())?;
        errors::note(&format!("wrote {}", path.display()));
    }
    if STOPPED.load(Ordering::Relaxed) {
        return Err(Interrupted("stopped: the result is what was found until then".to_owned()).into());
    }
    Ok(())
}

/// Runs a request and prints its results, or writes its surface or page.
pub(super) fn print(of: &WorkspaceRequest, output: &OutputArgs, guard: &mut Guard) -> Result<()> {
    let output = OutputArgs { format: output.format, output_file: output.output_file.clone() };
    let drawn = DrawArgs { output, figure: FigureArgs::default() };
    let nothing =
        WorkspaceArgs { compare: None, compare_set: Vec::new(), drawn, surface: Vec::new(), page: None, threads: None };
    run(of, &nothing, guard)
}

/// Format of a surface by the ending of its file.
fn format_of(path: &Path) -> Option<SurfaceFormat> {
    SurfaceFormat::of_ending(&path.extension()?.to_string_lossy())
}

/// Opens the file of a surface before the work.
fn open_surface<'a>(path: &'a Path, guard: &mut Guard) -> Result<(Target, SurfaceFormat, &'a Path)> {
    let Some(format) = format_of(path) else {
        bail!("{}: a surface is written to a file that ends in .stl, .ply or .vtp", path.display());
    };
    let content = Content { name: "the surface", in_words: "a surface", fitting: &SURFACES };
    Ok((Target::open(Some(path), content, guard)?, format, path))
}

/// Finds the workspace on all cores.
fn compute(study: &WorkspaceStudy, threads: Option<NonZeroUsize>) -> Result<Workspace> {
    // A stopped search keeps its positions, however long their surface takes.
    stop_at_next_row(None)?;
    let _lines = ProgressLines::new();
    let mut bar: Option<Progress> = None;
    let mut positions = 0;
    let mut progress = |done: usize, total: usize, what: &'static str| {
        positions = done;
        bar.get_or_insert_with(|| Progress::with_rate(total, what)).reach(done, total);
    };
    let run = WorkspaceRun { threads: threads::or_all(threads), cancel: &STOPPED };
    let found = run.run(study, &mut progress)?;
    let nothing = || {
        Interrupted(format!(
            "stopped after {}, before the first steps of the grid were done: there is no set yet; give a ⟪grid⟫ with \
             fewer values",
            counted(positions, "position")
        ))
    };
    found.ok_or_else(|| nothing().into())
}

impl Printed for Workspace {
    fn text(&self) -> String {
        let mut text = format!("{}: workspace with {} cables\n\n", self.robot, self.static_model);
        let mut line = |name: &str, value: &str| {
            let _ = writeln!(text, "  {name:<17} {value}");
        };
        let conditions: Vec<String> = self.conditions.iter().map(ToString::to_string).collect();
        line("conditions", &conditions.join(", "));
        line("orientations", &orientation_text(self));
        let volume = self.volume();
        if let Some(plane) = &self.plane {
            line("plane", &format!("{} = {} m", plane.axis, short(plane.at_m, 6)));
            line("area", &format!("{} m²{}", significant(plane.area_m2, 6), error_text(self)));
        } else {
            line("volume", &format!("{} m³{}", significant(volume.volume_m3, 6), error_text(self)));
            line("area", &format!("{} m²", significant(volume.area_m2.unwrap_or(0.0), 6)));
        }
        if let Some(centroid) = volume.centroid_m {
            line("centroid", &format!("({}) m", vector(&centroid, 4)));
        }
        let [low, high] = self.bounds_m;
        line("reaches from", &format!("({}) m to ({}) m", vector(&low, 4), vector(&high, 4)));
        if let Some(plane) = &self.plane {
            line("parts", &plane.parts.to_string());
            line("holes", &if plane.holes == 0 { "none".to_owned() } else { plane.holes.to_string() });
        } else {
            line("parts", &pieces_text(&self.parts));
            line("holes", &pieces_text(&self.holes));
        }
        line("box of the grid", &box_text(self));
        let steps: Vec<String> = self.grid.step_m.iter().map(|step| short(*step, 4)).collect();
        let first = short(self.grid.first_step_m, 4);
        line("steps", &format!("{} m; parts and holes between steps of {first} m can be missed", steps.join(", ")));
        if let Some(inner) = self.inner_box.as_ref().filter(|_| self.plane.is_none()) {
            let (low, high) = (vector(&inner.lower_m, 3), vector(&inner.upper_m, 3));
            line(
                "box inside",
                &format!("({low}) m to ({high}) m, {} m³, by the nodes", significant(inner.volume_m3, 4)),
            );
        }
        line("evaluations", &self.evaluations.to_string());

        if self.plane.is_some() {
            return text + &self.compared.as_ref().map_or_else(String::new, |of| compared_text(of, "m²"));
        }
        let _ = write!(text, "\n{}", Table::of(&VolumeRow::columns(), &self.volumes));
        if !self.sections.is_empty() {
            let _ = write!(text, "\n{}", sections(self));
        }
        if let Some(rays) = &self.rays {
            text += &rays_text(rays);
        }
        if let Some(compared) = &self.compared {
            text += &compared_text(compared, "m³");
        }
        text
    }
}

fn orientation_text(of: &Workspace) -> String {
    match of.roll_pitch_yaw_deg[..] {
        [one] => format!("roll, pitch, yaw ({})°", vector(&one, 4)),
        ref all => format!("{} of {}", of.orientations, all.len()),
    }
}

/// Largest expected error of the volume.
fn error_text(of: &Workspace) -> String {
    of.relative_error().map_or_else(String::new, |error| format!(" ± {} %", significant(100.0 * error, 2)))
}

fn pieces_text(pieces: &[PartOfWorkspace]) -> String {
    let piece = |of: &PartOfWorkspace| {
        let handles = if of.handles == 0 { String::new() } else { format!(" with {}", counted(of.handles, "handle")) };
        format!("{} m³{handles}", significant(of.volume_m3, 5))
    };
    let shown: Vec<String> = pieces.iter().take(SHOWN).map(piece).collect();
    let more = if pieces.len() > SHOWN { ", …" } else { "" };
    match pieces.len() {
        0 => "none".to_owned(),
        1 if pieces[0].handles == 0 => "1".to_owned(),
        count => format!("{count}: {}{more}", shown.join(", ")),
    }
}

fn box_text(of: &Workspace) -> String {
    let (low, high) = (vector(&of.grid.lower_m, 3), vector(&of.grid.upper_m, 3));
    let touches = match of.touches[..] {
        [] => "not reached".to_owned(),
        ref faces if of.plane.is_some() => {
            format!("reached at {}, where {} m are cut", faces.join(", "), significant(of.cut_area_m2, 4))
        }
        ref faces => format!("reached at {}, where {} m² are cut", faces.join(", "), significant(of.cut_area_m2, 4)),
    };
    format!("({low}) m to ({high}) m, {touches}")
}

fn sections(of: &Workspace) -> Table {
    let mut table = Table::new(&["section", "at [m]", "area [m²]", "polygons"]);
    for section in &of.sections {
        let polygons = section.polygons_m.len().to_string();
        table.row(vec![section.axis.to_owned(), short(section.at_m, 6), significant(section.area_m2, 6), polygons]);
    }
    table
}

fn rays_text(rays: &RaysOfWorkspace) -> String {
    format!(
        "\n{} rays from ({}) m: {} with several intervals, {} up to the box.\n",
        rays.count,
        vector(&rays.center_m, 4),
        rays.with_several_intervals,
        rays.cut
    )
}

fn compared_text(of: &ComparedSets, unit: &str) -> String {
    format!(
        "\nCompared with {}, on the same grid: {} {unit}; common to both {} {unit}, only here {} {unit}, only there {} \
         {unit}.\n",
        of.other,
        significant(of.other_volume_m3, 6),
        significant(of.common_volume_m3, 6),
        significant(of.only_own_m3, 4),
        significant(of.only_other_m3, 4)
    )
}

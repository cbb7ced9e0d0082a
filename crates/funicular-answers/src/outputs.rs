//! Files that commands write besides their result: one table, from which the program has its options, Python its
//! keywords and a request in JSON its `write_files`.

mod made;
mod opened;
mod rows;
mod wanted;

pub use made::as_csv;
use made::{Drawn, plain};
pub(crate) use made::{Made, size_of_page};
pub use opened::{Opened, Written, told};
use rows::{
    BADGE, JUNIT, certificate, certificate_of, drawn, figure, file, lengths, page, proved_of, proved_surface,
    robot_file, surface_of, universal_file,
};
pub use wanted::{FILES, Wanted, schema, take_wanted, wanted_to_value};

use crate::destination::{Content, Destination};
use crate::matrices;
use anyhow::{Result, anyhow, bail};
use funicular_files::endings::{self, Kind};
use funicular_files::{Guard, SweepFile};
use funicular_formats::uff_writing::{frf_file, modes_file};
use funicular_pages::figures;
use funicular_pages::pages;
use funicular_pages::pages::plot::SweepFigureChoice;
use funicular_pages::pages::summary::Summary;
use funicular_study::at_rest;
use funicular_study::request::{OfferedWinch, Request};
use funicular_study::wording::{Words, worded};
use funicular_study::{Results, Watch};
use funicular_validation::Validated;
use serde_json::{Map, Value};
use std::path::Path;

/// File that a command writes besides its result.
#[expect(clippy::struct_excessive_bools, reason = "a row of a table")]
pub struct Output {
    /// Name: of the option, written with `-` for `_`, of the keyword and of the key in `write_files` of a request.
    pub key: &'static str,
    /// Meaning.
    pub about: &'static str,
    /// Name of the file in messages: "the page".
    pub name: &'static str,
    /// Content of the file in messages: "a page".
    pub in_words: &'static str,
    /// Kinds of files that hold it.
    pub kinds: &'static [Kind],
    /// True if `-o` with such an ending means this file.
    pub by_ending: bool,
    /// True if there may be several such files.
    pub several: bool,
    /// True if a folder can hold it as well.
    pub folder: bool,
    /// Key of the request without which there is no such file.
    pub needs: Option<&'static str>,
    /// Refuses a request without such a file, before the work.
    check: fn(&Given, &Path) -> Result<()>,
    /// True if it is made of the request alone, without results.
    of_request: bool,
    make: Make,
}

/// Way of making a file.
#[derive(Clone, Copy)]
enum Make {
    /// HTML page.
    Page(fn(&Answered<'_>) -> Result<String>),
    /// Figure that is drawn in the format of the file.
    Figure(fn(&Answered<'_>, &FigureOptions, &mut dyn Watch) -> Result<Drawn>),
    /// Bytes by the kind of the file.
    Bytes(fn(&Answered<'_>, Option<Kind>) -> Result<Made>),
    /// Bytes of a document that is computed from the request.
    Document(fn(&Answered<'_>, &mut dyn Watch) -> Result<Made>),
}

/// Request with its results, from which files are made.
#[derive(Clone, Copy)]
pub struct Answered<'a> {
    /// Request.
    pub request: &'a Request,
    /// Results; none for a command whose result is a file, and for `validate`.
    pub results: Option<&'a Results>,
    /// Results of `validate`, which the study does not know.
    pub validated: Option<&'a Validated>,
    /// Command or code that makes the file again, for pages.
    pub call: &'a str,
    /// Words for the names of options.
    pub words: Words,
}

/// Size of figures, and choice of what they show.
#[derive(Debug, Clone, Default)]
pub struct FigureOptions {
    /// Width [mm].
    pub width_mm: Option<f64>,
    /// Size of the texts [pt].
    pub font_size_pt: Option<f64>,
    /// Number of the mode of `modes` whose shape is drawn.
    pub mode: Option<usize>,
    /// Quantity and slice of a map or sweep.
    pub of_rows: SweepFigureChoice,
}

impl FigureOptions {
    /// Keys of the options that are given.
    pub fn given(&self) -> impl Iterator<Item = &'static str> {
        let SweepFigureChoice { quantity, plane, at } = &self.of_rows;
        let all = [
            (self.width_mm.is_some(), "figure_width_mm"),
            (self.font_size_pt.is_some(), "font_size_pt"),
            (self.mode.is_some(), "figure_mode"),
            (quantity.is_some(), "quantity"),
            (plane.is_some(), "plane"),
            (!at.is_empty(), "at"),
        ];
        all.into_iter().filter(|(is_given, _)| *is_given).map(|(_, key)| key)
    }
}

/// Keys of a request that are given, as JSON.
pub type Given = Map<String, Value>;

/// Results of one command, from those of any.
macro_rules! of {
    ($Variant:ident, $at:ident, $found:ident => $made:expr) => {
        match $at.results {
            Some(Results::$Variant($found)) => $made,
            _ => bail!("`{}` has no such file", $at.request.command()),
        }
    };
}

/// Request of one command, from that of any.
macro_rules! asked {
    ($Variant:ident, $at:ident, $request:ident => $made:expr) => {
        match $at.request {
            Request::$Variant($request) => $made,
            other => bail!("`{}` has no such file", other.command()),
        }
    };
}

#[expect(clippy::unnecessary_wraps, reason = "others refuse")]
fn always(_: &Given, _: &Path) -> Result<()> {
    Ok(())
}

/// Winches on offer of a request.
fn offered<'a>(at: &Answered<'a>) -> Result<&'a [OfferedWinch]> {
    asked!(Winches, at, of => Ok(of.offers.as_deref().unwrap_or_default()))
}

/// Clock in seconds since now, for work that ends after a time.
pub fn clock() -> impl Fn() -> f64 {
    let begin = std::time::Instant::now();
    move || begin.elapsed().as_secs_f64()
}

/// Files of each command besides its result, in the order in which they are opened and written.
static OUTPUTS: &[(&str, &[Output])] = &[
    (
        "statics",
        &[Output {
            check: |given, _| match given.get("all") {
                Some(Value::Bool(true)) => bail!("a figure shows one equilibrium: leave out ⟪all⟫"),
                _ => Ok(()),
            },
            ..drawn(
                "Draw the robot at its equilibrium",
                |at, _, _| asked!(Statics, at, of => Ok(plain(figures::of_statics(of)?))),
            )
        }],
    ),
    (
        "clearance",
        &[figure(
            "Draw the distances of the nearest pairs with the required ones",
            |at, _, _| of!(Clearance, at, found => Ok(plain(figures::of_clearance(found)?))),
        )],
    ),
    (
        "payload",
        &[figure(
            "Draw the tensions with the minimum and the maximum payload",
            |at, _, _| of!(Payload, at, found => Ok(plain(figures::of_payload(found)?))),
        )],
    ),
    (
        "loads",
        &[figure(
            "Draw the tensions with the largest multiple of the required loads",
            |at, _, _| of!(Loads, at, found => Ok(plain(figures::of_loads(found)?))),
        )],
    ),
    (
        "speeds",
        &[figure(
            "Draw speeds, powers and used parts of the winches",
            |at, _, _| of!(Speeds, at, found => Ok(plain(figures::of_speeds(found)))),
        )],
    ),
    (
        "winches",
        &[
            figure(
                "Draw the needs of the winches, with those on offer",
                |at, _, _| of!(Winches, at, found => Ok(plain(figures::of_winches(found, offered(at)?)))),
            ),
            page(
                "Write a page with the needs of the winches, what asks for them, and the offers",
                |at| of!(Winches, at, found => pages::winches::page(found, offered(at)?, at.call.to_owned())),
            ),
        ],
    ),
    (
        "report",
        &[Output {
            by_ending: true,
            of_request: true,
            check: |given, _| match given.get("summary") {
                Some(Value::Bool(true)) => Ok(()),
                _ => bail!("a PDF of `report` has the two pages of a summary: give ⟪summary⟫, or write .html"),
            },
            ..file(
                "pdf",
                "Write the two pages of the summary as PDF",
                ["the summary", "two pages"],
                &[Kind::Pdf],
                Make::Document(|at, watch| {
                    asked!(Report, at, of => {
                        let made = Summary::of_request(of, &of.robot.read()?, (at.call, at.words), watch, &clock())?;
                        Ok(Made { warnings: made.warnings.clone(), ..made.pdf().into() })
                    })
                }),
            )
        }],
    ),
    (
        "modes",
        &[
            drawn(
                "Draw the spectrum, or the shape of one mode",
                |at, options, _| asked!(Modes, at, of => Ok(figures::of_modes(of, options.mode)?.into())),
            ),
            universal_file(|at, _| of!(Modes, at, found => Ok(modes_file(found).into()))),
        ],
    ),
    (
        "frf",
        &[
            drawn(
                "Draw magnitude and phase",
                |at, _, watch| asked!(Frf, at, of => Ok(figures::of_frf(of, watch)?.into())),
            ),
            universal_file(|at, _| of!(Frf, at, found => Ok(frf_file(found)?.into()))),
        ],
    ),
    (
        "settle",
        &[
            page(
                "Write a page with the decay of the point and its modes",
                |at| of!(Settle, at, found => pages::settle::page(found, at.call.to_owned())),
            ),
            figure(
                "Draw the decay of the point",
                |at, _, _| of!(Settle, at, found => Ok(plain(figures::of_decay(found)))),
            ),
            Output {
                needs: Some("sample_time_s"),
                ..lengths(
                    "Write the commanded lengths: t_s, and unstrained_length_NAME_m of every cable [m]",
                    |at, _| {
                        of!(Settle, at, found => match &found.commanded {
                            Some(commanded) => Ok(as_csv(commanded.lengths_table())?.into()),
                            None => bail!("a release has no commanded lengths: leave out ⟪lengths⟫"),
                        })
                    },
                )
            },
        ],
    ),
    (
        "gust",
        &[figure(
            "Draw the spectra of motions and tensions",
            |at, _, _| of!(Gust, at, found => Ok(plain(figures::of_gust(found)))),
        )],
    ),
    (
        "compare",
        &[figure(
            "Draw the differences between the cable models",
            |at, _, _| of!(Compare, at, found => Ok(plain(figures::of_compare(found)))),
        )],
    ),
    (
        "uncertainty",
        &[page(
            "Write a page with the deviations and what they come from",
            |at| of!(Uncertainty, at, found => pages::uncertainty::page(found, at.call.to_owned())),
        )],
    ),
    (
        "trajectory",
        &[
            lengths(
                "Write the lengths for a controller: t_s, and unstrained_length_NAME_m of every cable [m], a \
                 trajectory for `settle`",
                |at, _| of!(Trajectory, at, found => Ok(as_csv(found.lengths_table())?.into())),
            ),
            figure("Draw tensions, lengths, speeds and powers over time, with their limits", |at, _, _| {
                let robot = asked!(Trajectory, at, of => {
                    at_rest::with_limits(&of.robot.read()?.robot, &of.tensions)?
                });
                of!(Trajectory, at, found => Ok(plain(figures::of_trajectory(&robot, found))))
            }),
            page("Write a page with the moving robot, and tensions, speeds and powers over time", |at| {
                of!(Trajectory, at, found => {
                    let Some(robot) = at.request.robot() else { bail!("a trajectory belongs to a robot") };
                    pages::trajectory::page(&robot.read()?.robot, found, at.call.to_owned())
                })
            }),
        ],
    ),
    (
        "simulate",
        &[
            figure(
                "Draw pose and tensions over time",
                |at, _, _| of!(Simulate, at, found => Ok(plain(figures::of_simulation(found)))),
            ),
            file(
                "animation",
                "Write the moving robot as an animated drawing, which any browser shows in true time",
                ["the animation", "an animated drawing"],
                &[Kind::Svg],
                Make::Bytes(
                    |at, _| of!(Simulate, at, found => Ok(figures::animation_of_simulation(found).into_bytes().into())),
                ),
            ),
            page(
                "Write a page with the moving robot, pose and tensions over time, and the spectrum of the motion",
                |at| of!(Simulate, at, found => pages::simulate::page(found, at.call.to_owned())),
            ),
        ],
    ),
    (
        "reduce",
        &[Output {
            folder: true,
            check: matrices::check,
            ..file(
                "matrices",
                "Write the matrices to an .npz or .mat file, or as CSV files to a new folder; FILE.fmu is a unit for \
                 Simulink and Modelica",
                ["the matrices", "matrices"],
                &[Kind::Npz, Kind::Mat, Kind::Fmu],
                Make::Bytes(|at, kind| of!(Reduce, at, found => matrices::made(found, at, kind))),
            )
        }],
    ),
    (
        "identify",
        &[
            robot_file(
                "fitted",
                "Write the robot file with the identified values",
                |at, _| of!(Identify, at, found => Ok(found.robot_file.clone().into_bytes().into())),
            ),
            page(
                "Write a page with measured and fitted curves",
                |at| of!(Identify, at, found => pages::identify::page(found, at.call.to_owned())),
            ),
        ],
    ),
    (
        "calibrate",
        &[
            figure(
                "Draw the anchors with their ellipses",
                |at, _, _| of!(Calibrate, at, found => Ok(plain(figures::of_calibration(found)))),
            ),
            robot_file(
                "calibrated",
                "Write the robot file with the calibrated anchors and attachments",
                |at, _| of!(Calibrate, at, found => Ok(found.robot_file.clone().into_bytes().into())),
            ),
            file(
                "calibrated_covariance",
                "Write the covariance of the calibrated anchors, attachments, pulleys and offsets (as unstrained \
                 lengths), for `uncertainty`; a scale and factors are left out",
                ["the covariance", "CSV"],
                &[Kind::Csv],
                Make::Bytes(|at, _| {
                    of!(Calibrate, at, found => match found.covariance[..] {
                        [] => bail!("the readings do not tell a covariance: they leave numbers, or their own \
                                     deviation, undetermined"),
                        _ => Ok(as_csv(found.covariance_table())?.into()),
                    })
                }),
            ),
            page(
                "Write a page with the anchors and their ellipses, the residuals, rows that can be clicked away and \
                 the proposed poses",
                |at| of!(Calibrate, at, found => pages::calibrate::page(found, at.call.to_owned())),
            ),
        ],
    ),
    (
        "estimate",
        &[
            figure(
                "Draw motion, payload, tensions and residuals over time",
                |at, _, _| of!(Estimate, at, found => Ok(plain(figures::of_estimate(found)))),
            ),
            page(
                "Write a page with motion, payload, tensions, residuals and alarms",
                |at| of!(Estimate, at, found => pages::estimate::page(found, at.call.to_owned())),
            ),
        ],
    ),
    (
        "design",
        &[
            robot_file(
                "designed",
                "Write the robot file with the chosen values",
                |at, _| of!(Design, at, found => Ok(found.robot_file.clone().into_bytes().into())),
            ),
            page(
                "Write a page with the poses before and after, the moved points and the gains of more room",
                |at| of!(Design, at, found => pages::design::page(found, at.call.to_owned())),
            ),
        ],
    ),
    (
        "workspace",
        &[
            figure(
                "Draw the sections",
                |at, _, _| of!(Workspace, at, found => Ok(plain(figures::of_sections(found)?))),
            ),
            Output {
                by_ending: true,
                several: true,
                ..file(
                    "surface",
                    "Write the closed surface of the set [m] to FILE.stl, FILE.ply or FILE.vtp (ParaView)",
                    ["the surface", "a surface"],
                    &[Kind::Stl, Kind::Ply, Kind::Vtp],
                    Make::Bytes(|at, kind| of!(Workspace, at, found => surface_of(found, kind))),
                )
            },
            page(
                "Write a page with the surface in space, the volumes and the sections",
                |at| of!(Workspace, at, found => pages::workspace::page(found, at.call.to_owned())),
            ),
            Output {
                needs: Some("prove"),
                ..proved_surface(|at, kind| of!(Workspace, at, found => proved_of(found.proof.as_ref(), kind)))
            },
            Output {
                needs: Some("prove"),
                ..certificate(|at, _| of!(Workspace, at, found => certificate_of(found.proof.as_ref())))
            },
        ],
    ),
    (
        "prove",
        &[
            figure(
                "Draw a section with what is proved inside, outside and neither",
                |at, _, _| of!(Prove, at, found => Ok(plain(figures::of_proof(found)?))),
            ),
            Output {
                by_ending: true,
                ..proved_surface(|at, kind| of!(Prove, at, found => proved_of(Some(&**found), kind)))
            },
            page(
                "Write a page that says what is proved and what is not, with the three sets",
                |at| of!(Prove, at, found => pages::prove::page(found, at.call.to_owned())),
            ),
            certificate(|at, _| of!(Prove, at, found => certificate_of(Some(&**found)))),
        ],
    ),
    ("validate", &[JUNIT, BADGE]),
    (
        "plot",
        &[drawn("Draw one quantity for a paper", |at, options, _| {
            asked!(Plot, at, of => {
                let rows = SweepFile::open(Path::new(&of.file))?;
                let made = pages::plot::figure(&rows, &of.file, &options.of_rows)?;
                Ok(Drawn { figure: made.figure, warnings: Vec::new(), notes: made.notes })
            })
        })],
    ),
];

/// Files that a command writes besides its result, in the order in which they are opened and written.
pub fn of(command: &str) -> &'static [Output] {
    OUTPUTS.iter().find(|(name, _)| *name == command).map_or(&[], |(_, outputs)| outputs)
}

/// Every kind of file that some command writes besides its result, each once.
pub fn all() -> impl Iterator<Item = &'static Output> {
    let each = OUTPUTS.iter().flat_map(|(_, outputs)| *outputs);
    each.enumerate()
        .filter(|(k, of)| OUTPUTS.iter().flat_map(|(_, all)| *all).position(|one| one.key == of.key) == Some(*k))
        .map(|(_, of)| of)
}

/// File that `-o` means by its ending.
pub fn by_ending(command: &str, path: &Path) -> Option<&'static Output> {
    let kind = Kind::of(path)?;
    of(command).iter().find(|output| output.by_ending && output.kinds.contains(&kind))
}

/// Makes the page of results.
///
/// # Errors
/// Results without a page.
pub fn page_of(at: &Answered<'_>) -> Result<String> {
    let make = of(at.request.command()).iter().find_map(|output| match output.make {
        Make::Page(make) => Some(make),
        _ => None,
    });
    let make = make.ok_or_else(|| anyhow!("`{}` has no page of its own", at.request.command()))?;
    Ok(worded(&make(at)?, at.words))
}

impl Output {
    /// Refuses keys without such a file.
    fn refuse(&self, given: &Given, path: &Path) -> Result<()> {
        if let Some(needed) = self.needs
            && given.get(needed).is_none_or(Value::is_null)
        {
            bail!("⟪{}⟫ means nothing without ⟪{needed}⟫: give both or neither", self.key);
        }
        (self.check)(given, path)
    }

    /// Checks that a file can be written.
    fn destination(&self, path: &Path, guard: &mut Guard) -> Result<Destination> {
        let content = Content { name: self.name, in_words: self.in_words, fitting: self.kinds };
        let is_of_kind = Kind::of(path).is_some_and(|kind| self.kinds.contains(&kind));
        if self.folder && !is_of_kind {
            if path.extension().is_some() && !path.is_dir() {
                bail!(
                    "⟪{}⟫ {} neither ends in {} nor is a folder: give such a name, or a folder, whose name has no \
                     ending",
                    self.key,
                    path.display(),
                    endings::listed(self.kinds)
                );
            }
            return Destination::open_folder(path, content, self.key, guard);
        }
        if self.kinds.len() > 1 && !is_of_kind {
            let (shown, endings) = (path.display(), endings::listed(self.kinds));
            bail!("⟪{}⟫ {shown}: {} is written to a file that ends in {endings}", self.key, self.in_words);
        }
        Destination::open(path, content, guard)
    }
}

#[cfg(test)]
mod tests {
    use super::{FILES, OUTPUTS};
    use funicular_study::request::commands;

    #[test]
    fn no_key_of_a_request_has_the_name_of_a_file_that_is_written() {
        for (command, outputs) in OUTPUTS {
            let info = commands().iter().find(|info| info.name == *command);
            let keys: Vec<&str> = info.into_iter().flat_map(|info| &info.keys).map(|key| key.name).collect();
            assert!(!keys.is_empty(), "{command} is a command");
            assert!(outputs.iter().all(|output| !keys.contains(&output.key)), "{command}");
        }
        assert!(commands().iter().all(|info| info.keys.iter().all(|key| key.name != FILES)));
    }
}

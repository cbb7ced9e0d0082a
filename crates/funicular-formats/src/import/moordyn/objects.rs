//! Bodies, points, lines and line types of a MoorDyn input file.

use super::sections::{self, SectionKind, SourceRow};
use crate::import::text;
use anyhow::{Result, bail};
use funicular::math::{Mat3, Vec3};
use funicular_study::request::SourceFile;
use funicular_study::text::clean;

/// Gravity [m/s²] and density of water [kg/m³] if the options do not give them.
const DEFAULT_GRAVITY: f64 = 9.81;
const DEFAULT_WATER: f64 = 1025.0;

/// Content of an input file.
pub(super) struct MoorDynModel<'a> {
    pub(super) types: Vec<SourceLineType<'a>>,
    pub(super) bodies: Vec<MoorDynBody<'a>>,
    pub(super) points: Vec<MoorDynPoint<'a>>,
    pub(super) lines: Vec<MoorDynLine<'a>>,
    /// Acceleration [m/s²], downwards.
    pub(super) gravity: f64,
    pub(super) assumed: Vec<String>,
    pub(super) lost: Vec<String>,
}

/// Line type: properties of a rope.
pub(super) struct SourceLineType<'a> {
    /// Name exactly as in the file, by which lines refer to it.
    pub(super) word: &'a str,
    /// Name for robot files and messages.
    pub(super) name: String,
    pub(super) mass_per_length: f64,
    pub(super) axial_stiffness: f64,
}

/// Body of an input file.
pub(super) struct MoorDynBody<'a> {
    pub(super) id: usize,
    pub(super) is_free: bool,
    pub(super) mass: f64,
    pub(super) center_p: Vec3,
    pub(super) inertia_p: Mat3,
    pub(super) row: SourceRow<'a>,
}

/// Object that a point is fixed to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Holder {
    Fixed,
    Body(usize),
    Free,
    Coupled,
}

/// Point of an input file: the end of lines.
pub(super) struct MoorDynPoint<'a> {
    pub(super) id: usize,
    pub(super) holder: Holder,
    /// Position in the world, or in the frame of the body that the point is fixed to [m].
    pub(super) position: Vec3,
    pub(super) mass: f64,
    pub(super) row: SourceRow<'a>,
}

/// Line of an input file.
pub(super) struct MoorDynLine<'a> {
    pub(super) id: usize,
    /// Name of its line type, exactly as in the file.
    pub(super) kind: &'a str,
    pub(super) unstrained_length: f64,
    /// Columns of the points at its ends.
    ends: [usize; 2],
    pub(super) row: SourceRow<'a>,
}

/// Data that a robot file does not hold, collected so that each kind is reported once.
#[derive(Default)]
struct MoorDynLosses {
    bending: Vec<String>,
    damping: Vec<String>,
    volumes: Vec<String>,
    forces: Vec<String>,
}

impl<'a> MoorDynModel<'a> {
    pub(super) fn read(file: &'a SourceFile) -> Result<Self> {
        let mut model = Self {
            types: Vec::new(),
            bodies: Vec::new(),
            points: Vec::new(),
            lines: Vec::new(),
            gravity: DEFAULT_GRAVITY,
            assumed: Vec::new(),
            lost: Vec::new(),
        };
        let mut losses = MoorDynLosses::default();
        let mut water = None;
        // Text before the first section that is known is a description.
        let (mut named, mut has_begun) = (None, false);
        for (section, row) in sections::rows(&file.text) {
            has_begun |= section.kind != SectionKind::Other;
            match section.kind {
                SectionKind::LineTypes => {
                    let read = model.line_type(file, &row, &mut losses)?;
                    model.types.push(read);
                }
                SectionKind::Bodies => model.bodies.push(body(file, row, &mut losses)?),
                SectionKind::Points => model.points.push(point(file, row, &mut losses)?),
                SectionKind::Lines => model.lines.push(line(file, row)?),
                SectionKind::Rods => {
                    bail!(row.error(
                        file,
                        "the file has rods, which a robot file cannot hold; describe the platform as a body"
                    ))
                }
                SectionKind::ExternalLoads => {
                    model.lost.push(format!("the external load of line {} of the file", row.line));
                }
                SectionKind::Options => match row.words.get(1).copied() {
                    Some("g" | "gravity") => model.gravity = row.quantity(file, 0, "g")?,
                    Some("rho" | "Rho" | "WtrDnsty" | "rhoW") => water = Some(row.quantity(file, 0, "rho")?),
                    Some("WtrDpth") if row.words[0] != "0" => {
                        model.lost.push(format!("the seabed, {} m below z = 0", clean(row.words[0])));
                    }
                    _ => {}
                },
                SectionKind::Failures => model.lost.push(format!(
                    "the failure of line {} of the file: in a scenario of `simulate` it is a [[cut]] with `at_s` or \
                     `at_tension_n`",
                    row.line
                )),
                SectionKind::Other if has_begun && named != Some(section) && !section.title.is_empty() => {
                    named = Some(section);
                    model.lost.push(format!("the section `{}` from line {} on", clean(section.title), section.line));
                }
                SectionKind::RodTypes | SectionKind::Outputs | SectionKind::Other => {}
            }
        }

        model.check_ids(file)?;
        model.note_losses(file, losses, water)?;
        Ok(model)
    }

    /// Point at an end of a line.
    pub(super) fn point(&self, file: &SourceFile, line: &MoorDynLine, end: usize) -> Result<&MoorDynPoint<'a>> {
        let column = line.ends[end];
        let word = line.row.word(file, column, "attachment")?;
        let letters: String = word.chars().take_while(char::is_ascii_alphabetic).collect();
        if matches!(letters.to_uppercase().as_str(), "R" | "ROD") {
            bail!(line.row.error(file, format!("line {} ends at rod `{}`; rods are not read", line.id, clean(word))));
        }
        let Ok(id) = line.row.id(file, column, "attachment") else {
            bail!(line.row.error(
                file,
                format!(
                    "column {} is `{}`, which is no number of a point; the columns have to be those of MoorDyn version \
                     2 (ID, LineType, AttachA, AttachB, UnstrLen) or 1 (Line, LineType, UnstrLen, NumSegs, NodeAnch, \
                     NodeFair), with a row of these names",
                    column + 1,
                    clean(word)
                )
            ));
        };
        self.points
            .iter()
            .find(|point| point.id == id)
            .ok_or_else(|| line.row.error(file, format!("line {} ends at point {id}, which is not defined", line.id)))
    }

    fn line_type(
        &self,
        file: &SourceFile,
        row: &SourceRow<'a>,
        losses: &mut MoorDynLosses,
    ) -> Result<SourceLineType<'a>> {
        let word = row.word(file, 0, "TypeName")?;
        let name = clean(word);
        if self.types.iter().any(|known| known.word == word) {
            bail!(row.error(file, format!("a second line type is called `{name}`")));
        }

        let stiffness = row.word(file, 3, "EA")?;
        let mut parts = stiffness.split('|');
        let statically = parts.next().unwrap_or_default();
        let axial_stiffness = match text::number(statically) {
            Ok(value) if value > 0.0 => value,
            Ok(value) => bail!(row.error(file, format!("column 4 (EA) is {value} N, it must be positive"))),
            Err(wrong) => bail!(row.error(
                file,
                format!("column 4 (EA) is {wrong}; a separate file with a table of tension over strain is not read")
            )),
        };

        if parts.next().is_some() {
            losses.damping.push(format!("the dynamic stiffness of `{name}`"));
        }
        if row.words.get(4).is_some_and(|word| text::number(word) != Ok(0.0)) {
            losses.damping.push(format!("the damping BA/-zeta of `{name}`"));
        }
        // Version 1 has no bending stiffness: its sixth column is a coefficient of water.
        let bending = row.columns_of(&["ei"]).next().or_else(|| row.columns_of(&["can"]).next().is_none().then_some(5));
        let bends = |column: usize| row.words.get(column).is_some_and(|word| text::number(word) != Ok(0.0));
        if bending.is_some_and(bends) {
            losses.bending.push(format!("`{name}`"));
        }

        Ok(SourceLineType { word, name, mass_per_length: row.quantity(file, 2, "Mass/m")?, axial_stiffness })
    }

    fn check_ids(&self, file: &SourceFile) -> Result<()> {
        fn repeated_id<'r, 'a: 'r>(mut rows: Vec<(usize, &'r SourceRow<'a>)>) -> Option<(usize, &'r SourceRow<'a>)> {
            rows.sort_by_key(|(id, row)| (*id, row.line));
            rows.windows(2).find(|pair| pair[0].0 == pair[1].0).map(|pair| pair[1])
        }
        for (what, again) in [
            ("body", repeated_id(self.bodies.iter().map(|body| (body.id, &body.row)).collect())),
            ("point", repeated_id(self.points.iter().map(|point| (point.id, &point.row)).collect())),
            ("line", repeated_id(self.lines.iter().map(|line| (line.id, &line.row)).collect())),
        ] {
            if let Some((id, row)) = again {
                bail!(row.error(file, format!("a second {what} has the number {id}")));
            }
        }
        Ok(())
    }

    fn note_losses(&mut self, file: &SourceFile, losses: MoorDynLosses, water: Option<f64>) -> Result<()> {
        if self.lines.is_empty() {
            bail!("{}: the file has no lines", file.path);
        }
        let water = water.unwrap_or(DEFAULT_WATER);
        if water != 0.0 {
            self.lost.push(format!(
                "the water of {water} kg/m³ below z = 0, its buoyancy and its drag: everything is in air in the robot \
                 file"
            ));
            self.lost.extend(losses.volumes);
        }
        self.lost.extend(losses.forces);
        self.lost.extend(losses.damping);
        if !losses.bending.is_empty() {
            self.lost.push(format!("the bending stiffness EI of {}", losses.bending.join(", ")));
        }
        if self.bodies.iter().any(|body| body.row.words.get(1).is_some_and(|word| is_coupled(word))) {
            self.assumed.push("the coupled body is free; in the source another program moves it".to_owned());
        }
        Ok(())
    }
}

fn is_coupled(word: &str) -> bool {
    matches!(word.to_uppercase().as_str(), "COUPLED" | "CPLD" | "VESSEL" | "VES")
}

fn body<'a>(file: &SourceFile, row: SourceRow<'a>, losses: &mut MoorDynLosses) -> Result<MoorDynBody<'a>> {
    let id = row.id(file, 0, "ID")?;
    let kind = row.word(file, 1, "Attachment")?.to_uppercase();
    let is_free = match kind.as_str() {
        "FREE" | "COUPLED" | "CPLD" | "VESSEL" | "VES" => true,
        "FIXED" | "FIX" | "ANCHOR" => false,
        _ => bail!(row.error(file, format!("body {id} is `{}`; bodies are free, coupled or fixed", clean(&kind)))),
    };

    for (column, name) in ["X0", "Y0", "Z0", "r0", "p0", "y0"].into_iter().enumerate() {
        row.number(file, 2 + column, name)?;
    }

    let center_p = match row.numbers(file, 9, "CG")?[..] {
        [z] => Vec3::new(0.0, 0.0, z),
        [x, y, z] => Vec3::new(x, y, z),
        ref other => {
            bail!(row.error(file, format!("column 10 (CG) holds {} numbers, one or three are known", other.len())))
        }
    };

    let moments = match row.numbers(file, 10, "I")?[..] {
        [all] => Vec3::repeat(all),
        [x, y, z] => Vec3::new(x, y, z),
        ref other => {
            bail!(row.error(file, format!("column 11 (I) holds {} numbers, one or three are known", other.len())))
        }
    };

    if row.words.get(11).is_some_and(|word| text::number(word) != Ok(0.0)) {
        losses.volumes.push(format!("the volume of body {id}"));
    }

    let mass = row.quantity(file, 8, "Mass")?;
    Ok(MoorDynBody { id, is_free, mass, center_p, inertia_p: Mat3::from_diagonal(&moments), row })
}

fn point<'a>(file: &SourceFile, row: SourceRow<'a>, losses: &mut MoorDynLosses) -> Result<MoorDynPoint<'a>> {
    let id = row.id(file, 0, "ID")?;
    let kind = row.word(file, 1, "Attachment")?.to_uppercase();
    let holder = match kind.as_str() {
        "FIXED" | "FIX" | "ANCHOR" => Holder::Fixed,
        "FREE" | "CONNECT" | "CON" | "POINT" => Holder::Free,
        "COUPLED" | "CPLD" | "VESSEL" | "VES" | "FAIRLEAD" => Holder::Coupled,
        _ => match kind.strip_prefix("BODY").and_then(|number| number.parse().ok()) {
            Some(body) => Holder::Body(body),
            None => bail!(row.error(
                file,
                format!(
                    "point {id} is `{}`; points are fixed, free, coupled, or Body1 for the first body",
                    clean(&kind)
                )
            )),
        },
    };

    let position = Vec3::new(row.number(file, 2, "X")?, row.number(file, 3, "Y")?, row.number(file, 4, "Z")?);
    let mass = row.words.get(5).map_or(Ok(0.0), |_| row.quantity(file, 5, "Mass"))?;

    if row.words.get(6).is_some_and(|word| text::number(word) != Ok(0.0)) {
        losses.volumes.push(format!("the volume of point {id}"));
    }
    // With twelve columns, columns 8 to 10 hold the force on the point; the last two hold its drag.
    if row.words.len() >= 12 && row.words[7..10].iter().any(|word| text::number(word) != Ok(0.0)) {
        losses.forces.push(format!("the external force on point {id}"));
    }

    Ok(MoorDynPoint { id, holder, position, mass, row })
}

fn line<'a>(file: &SourceFile, row: SourceRow<'a>) -> Result<MoorDynLine<'a>> {
    let id = row.id(file, 0, "ID")?;
    let kind = row.word(file, 1, "LineType")?;
    // Version 1 has the length in the third column, and the points after the segments. The names of the columns tell.
    let column = row.columns_of(&["unstr"]).next().unwrap_or(4);
    let named: Vec<usize> = row.columns_of(&["attach", "node", "end"]).take(2).collect();
    let ends = if let [a, b] = named[..] { [a, b] } else { [2, 3] };
    let unstrained_length = row.number(file, column, "UnstrLen")?;
    if unstrained_length <= 0.0 {
        bail!(
            row.error(file, format!("column {} (UnstrLen) is {unstrained_length} m, it must be positive", column + 1))
        );
    }
    Ok(MoorDynLine { id, kind, unstrained_length, ends, row })
}

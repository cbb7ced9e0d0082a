//! Import of files of other programs into a `Draft` of a robot file.
//!
//! A reader takes over only facts from the source. It names the line of an error and lists the facts that a robot file
//! cannot hold. docs/import.md explains every element that is read.

pub(crate) mod caspr;
pub(crate) mod cdpr_gazebo;
pub(crate) mod draft;
mod frames;
pub(crate) mod grab;
pub(crate) mod moordyn;
pub(crate) mod mujoco;
mod pairs;
pub(crate) mod sdf;
pub(crate) mod text;
mod tree;
pub(crate) mod urdf;
pub(crate) mod wirex;
pub(crate) mod xml;

pub use funicular_study::request::{MAX_BYTES, SourceFile};

use anyhow::{Result, anyhow, bail};
use caspr::trajectories::{self, TrajectoryTable};
use draft::Draft;
use funicular_study::request;
use funicular_study::wording::{Words, told, worded};
use xml::Xml;

/// Robot file, or table of a trajectory, made from files of another program.
#[derive(Debug, Clone, PartialEq)]
pub struct Imported {
    /// Text of the robot file or, if a trajectory is requested, of its table.
    pub text: String,
    /// Assumptions made where the sources are not clear.
    pub assumed: Vec<String>,
    /// Facts of the sources that a robot file cannot hold.
    pub lost: Vec<String>,
}

/// Makes a robot file, or the table of a trajectory, from the files of a request. `words` names the options in messages
/// as the front end writes them.
///
/// # Errors
/// The file, the line, the value and the next step; or the reason why a robot file cannot hold the robot.
pub fn run(request: &request::ImportRequest, words: Words) -> Result<Imported> {
    let in_words = |texts: &[String]| texts.iter().map(|text| told(text, words)).collect();
    if let Some(name) = &request.trajectory {
        let TrajectoryTable { csv: text, assumed } = trajectory(&request.files, name)?;
        return Ok(Imported { text, assumed: in_words(&assumed), lost: Vec::new() });
    }

    let mut draft = read(&request.files, &ReadOptions { cable_set: request.cable_set.as_deref() })?;
    draft.complete(&request.ropes, &request.platform)?;
    let text = worded(&draft.to_toml()?, words);
    Ok(Imported { text, assumed: in_words(&draft.assumed), lost: in_words(&draft.lost) })
}

/// Options of a request besides the files.
pub(crate) struct ReadOptions<'a> {
    /// Name of the cable set to read from a CASPR file.
    pub(crate) cable_set: Option<&'a str>,
}

/// Reads the files of one robot. The content of the files, not their names, tells which program wrote them.
///
/// # Errors
///
/// The file, the line, the value and the next step; or the reason why a robot file cannot hold the robot.
pub(crate) fn read(files: &[SourceFile], options: &ReadOptions) -> Result<Draft> {
    let mut sources = Sources::default();
    for file in files {
        sources.add_file(file)?;
    }
    let mut draft = sources.read(options)?;
    draft.assumed.splice(0..0, files.iter().filter_map(SourceFile::caveat));
    Ok(draft)
}

/// Files sorted by program and content.
#[derive(Default)]
struct Sources<'a> {
    bodies: Vec<Xml<'a>>,
    cables: Vec<Xml<'a>>,
    wirex: Vec<Xml<'a>>,
    moordyn: Vec<&'a SourceFile>,
    trajectories: Vec<Xml<'a>>,
    /// Robots of programs that describe one in a single file.
    whole: Vec<Draft>,
    /// Files of CASPR that do not describe the robot itself.
    aside: Vec<String>,
}

impl<'a> Sources<'a> {
    fn add_file(&mut self, file: &'a SourceFile) -> Result<()> {
        if !file.text.trim_start().starts_with('<') {
            if moordyn::is_input(&file.text) {
                self.moordyn.push(file);
            } else {
                self.whole.push(of_tree(file)?);
            }
            return Ok(());
        }

        let xml = Xml::parse(file)?;
        match xml.root().tag_name().name() {
            "bodies_system" | "links" => self.bodies.push(xml),
            "cables" => self.cables.push(xml),
            "models" => self.wirex.push(xml),
            "trajectories" => self.trajectories.push(xml),
            "operational_spaces" => {
                self.aside.push(format!("{} (`{}`)", file.name(), xml.root_name()));
            }
            "mujoco" => self.whole.push(mujoco::read(&xml)?.tidied()),
            "sdf" => self.whole.push(sdf::read(&xml)?.tidied()),
            "robot" => self.whole.push(urdf::read(&xml)?.tidied()),
            other => bail!(
                "{}: the outermost element is <{other}>; CASPR files have <bodies_system> or <cables>, WireX files \
                 <models>, MuJoCo <mujoco>, Gazebo <sdf>, URDF <robot>",
                xml.place(xml.root())
            ),
        }

        Ok(())
    }

    fn read(self, options: &ReadOptions) -> Result<Draft> {
        let Self { bodies, cables, wirex, moordyn, trajectories, mut whole, aside } = self;
        let is_caspr = [&bodies, &cables, &trajectories].iter().any(|of| !of.is_empty()) || !aside.is_empty();
        let of_one_file = !whole.is_empty();
        if [is_caspr, !wirex.is_empty(), !moordyn.is_empty(), of_one_file].into_iter().filter(|given| *given).count()
            > 1
        {
            bail!("the files belong to more than one program; give the files of one robot");
        }
        if !is_caspr && options.cable_set.is_some() {
            bail!("⟪cable_set⟫ chooses among the sets of a CASPR cables file, and no such file is given; leave it out");
        }

        if is_caspr {
            let bodies = only_file(&bodies, "CASPR bodies file (<bodies_system>)")?;
            let cables = only_file(&cables, "CASPR cables file (<cables>)")?;
            let mut draft = caspr::read(bodies, cables, options.cable_set)?;
            draft.lost.extend(aside.into_iter().map(|file| format!("{file}: it does not describe the robot")));
            draft.lost.extend(trajectories.iter().map(not_carried));
            return Ok(draft);
        }

        if !wirex.is_empty() {
            return wirex::read(only_file(&wirex, "WireX file (<models>)")?);
        }

        if let Some(draft) = whole.pop() {
            if !whole.is_empty() {
                bail!("{} files describe a whole robot each; give the file of one robot", whole.len() + 1);
            }
            return Ok(draft);
        }

        match moordyn[..] {
            [file] => moordyn::read(file),
            _ => bail!("{} MoorDyn input files are given; give the file of one robot", moordyn.len()),
        }
    }
}

/// Robot of a file of JSON or YAML.
fn of_tree(file: &SourceFile) -> Result<Draft> {
    let unknown = || {
        anyhow!(
            "{}: it is neither XML (CASPR, WireX, MuJoCo, SDF, URDF) nor a MoorDyn input file, which has sections \
             such as `--- LINE TYPES ---`, nor JSON of GRAB, which has `actuator` and `platform`, nor YAML of cdpr for \
             Gazebo, which has `points` and `platform`",
            file.path
        )
    };
    // Text of another kind is told what is read, not where it is no YAML.
    let looks_like_it = file.text.contains("platform") && (file.text.contains("points") || file.text.contains('{'));
    let tree = match tree::parse(file) {
        Err(error) if looks_like_it => return Err(error),
        tree => tree.map_err(|_| unknown())?,
    };
    let draft = if cdpr_gazebo::is_robot(&tree) {
        cdpr_gazebo::read(file, &tree)?
    } else if grab::is_robot(&tree) {
        grab::read(file, &tree)?
    } else {
        return Err(unknown());
    };
    Ok(draft.tidied())
}

/// Remark on trajectories that a robot file does not hold.
fn not_carried(xml: &Xml) -> String {
    let names: Vec<String> = trajectories::names(xml).iter().map(|name| format!("`{name}`")).collect();
    format!("{}: trajectories {}; ⟪trajectory⟫ NAME writes one as a table", xml.file().name(), names.join(", "))
}

/// Table of a trajectory of the files, with what was assumed.
///
/// # Errors
/// The file, the line, the value and the next step.
fn trajectory(files: &[SourceFile], name: &str) -> Result<TrajectoryTable> {
    let mut sources = Sources::default();
    for file in files {
        sources.add_file(file)?;
    }
    if sources.trajectories.is_empty() {
        bail!("⟪trajectory⟫ needs a CASPR trajectories file (<trajectories>) among the files");
    }
    let bodies = only_file(&sources.bodies, "CASPR bodies file (<bodies_system>)")?;
    trajectories::table(only_file(&sources.trajectories, "CASPR trajectories file (<trajectories>)")?, bodies, name)
}

/// Returns the only file of a kind.
fn only_file<'f, 'a>(files: &'f [Xml<'a>], kind: &str) -> Result<&'f Xml<'a>> {
    match files {
        [file] => Ok(file),
        [] => bail!("there is no {kind} among the files; a CASPR robot needs a bodies file and a cables file"),
        [first, second, ..] => {
            bail!("{} and {} are both a {kind}; give the files of one robot", first.path(), second.path())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use funicular_study::request::{ImportPlatform, ImportRopes};
    use std::path::Path;
    use std::sync::LazyLock;

    /// Example robot in every format: names and texts of its files.
    static EXAMPLES: LazyLock<[Vec<(&str, &str)>; 8]> = LazyLock::new(|| {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/import");
        [
            &["tripod_bodies.xml", "tripod_cables.xml"][..],
            &["tripod.wcrfx"],
            &["tripod.txt"],
            &["tripod_mjcf.xml"],
            &["tripod.sdf"],
            &["tripod.urdf"],
            &["tripod.yaml"],
            &["tripod_grab.json"],
        ]
        .map(|names| {
            let text = |name| &*std::fs::read_to_string(folder.join(name)).expect("the repository has the file").leak();
            names.iter().map(|name| (*name, text(name))).collect()
        })
    });

    fn imported(files: &[(&str, &str)]) -> Result<String> {
        let files = files
            .iter()
            .map(|(name, text)| SourceFile::decode((*name).to_owned(), text.as_bytes()))
            .collect::<Result<Vec<_>>>()?;
        let mut draft = read(&files, &ReadOptions { cable_set: None })?;
        let ropes = ImportRopes { mass_kg_per_m: Some(0.05), axial_stiffness_n: Some(1e6), ..ImportRopes::default() };
        let platform = ImportPlatform::default();
        draft.complete(&ropes, &platform)?;
        draft.to_toml()
    }

    /// Imports an example with one file's text replaced. True if the result is a robot, false if it is a one-line
    /// message.
    fn with(files: &[(&str, &str)], which: usize, text: &str) -> bool {
        let mut files = files.to_vec();
        files[which].1 = text;
        match imported(&files) {
            Ok(_) => true,
            Err(error) => {
                let message = format!("{error:#}");
                assert!(!message.is_empty() && !message.contains('\n'), "{message}");
                false
            }
        }
    }

    #[test]
    fn a_file_that_ends_anywhere_is_read_or_refused() {
        for files in EXAMPLES.iter() {
            imported(files).unwrap();
            for (which, (name, text)) in files.iter().enumerate() {
                let read =
                    (0..text.len()).filter(|end| text.is_char_boundary(*end) && with(files, which, &text[..*end]));
                // Truncated XML and JSON are neither; the end of a MoorDyn file holds little, and YAML without its last
                // cables is a robot.
                let is_closed = text.starts_with(['<', '{']);
                assert!(read.count() < if is_closed { 3 } else { text.len() / 2 }, "{name}");
            }
        }
    }

    #[test]
    fn no_bad_value_in_a_file_makes_a_reader_panic() {
        const BAD: [&str; 14] = [
            "",
            "nan",
            "-inf",
            "1e999",
            "1e-320",
            "1e13",
            "-1",
            "0",
            "1,5",
            "<",
            "&a;",
            "\u{0}",
            "é",
            "99999999999999999999",
        ];

        for files in EXAMPLES.iter() {
            for (which, (name, text)) in files.iter().enumerate() {
                let mut at = 0;
                while let Some(begin) = text[at..].find(|c: char| c.is_ascii_digit()).map(|i| at + i) {
                    let rest = &text[begin..];
                    let end = begin + rest.find(|c: char| !c.is_ascii_digit()).unwrap_or(rest.len());
                    for bad in BAD {
                        with(files, which, &[&text[..begin], bad, &text[end..]].concat());
                    }
                    at = end;
                }
                assert!(at > text.len() / 2, "{name} has numbers to its end");
            }
        }
    }

    #[test]
    fn no_missing_or_doubled_line_makes_a_reader_panic() {
        for files in EXAMPLES.iter() {
            for (which, (_, text)) in files.iter().enumerate() {
                let lines: Vec<&str> = text.lines().collect();
                for i in 0..lines.len() {
                    let doubled = [&lines[..=i], &lines[i..]].concat().join("\n");
                    let without = [&lines[..i], &lines[i + 1..]].concat().join("\n");
                    with(files, which, &doubled);
                    with(files, which, &without);
                }
            }
        }
    }

    #[test]
    fn line_ends_and_byte_order_marks_change_nothing() {
        for files in EXAMPLES.iter() {
            let windows: Vec<(&str, String)> =
                files.iter().map(|(name, text)| (*name, format!("\u{feff}{}", text.replace('\n', "\r\n")))).collect();
            let windows: Vec<(&str, &str)> = windows.iter().map(|(name, text)| (*name, text.as_str())).collect();
            assert_eq!(imported(&windows).unwrap(), imported(files).unwrap());
        }
    }

    #[test]
    fn xml_that_is_a_bomb_is_refused_at_once() {
        let entities: String = (1..60)
            .map(|i| format!("<!ENTITY a{i} \"{}\">", format!("&a{};", i - 1).repeat(10)))
            .chain(["<!ENTITY a0 \"0123456789\">".to_owned()])
            .collect();
        let bomb = format!("<!DOCTYPE models [{entities}]><models>&a59;</models>");
        let deep = "<models>".repeat(1_000_000);
        let wide = format!("<models>{}</models>", "<a/>".repeat(2_000_000));
        for text in [&bomb, &deep, &wide] {
            let error = imported(&[("a.wcrfx", text)]).unwrap_err().to_string();
            assert!(error.contains("not well-formed XML"), "{error}");
        }
    }
}

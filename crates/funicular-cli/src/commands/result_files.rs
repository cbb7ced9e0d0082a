//! Files of commands that find values: the printed result, the robot file with the values, and a page.

use crate::args::OutputArgs;
use crate::errors;
use crate::output::{Content, Printed, Sink, Target};
use anyhow::{Result, bail};
use funicular_files::Guard;
use funicular_files::endings::Kind;
use std::path::{Path, PathBuf};

/// Opened files of a result.
pub(super) struct ResultFiles {
    sink: Sink,
    robot: Option<(Target, PathBuf)>,
    page: Option<(Target, PathBuf)>,
}

impl ResultFiles {
    /// Opens the files before the work. `-o` may name the robot file or the page. `robot` is the key of the option of
    /// the robot file and its value.
    ///
    /// # Errors
    /// A file that cannot be written, that the command reads, or that is named twice.
    pub(super) fn open(
        output: &OutputArgs,
        robot: (&'static str, Option<&Path>),
        page: Option<&Path>,
        guard: &mut Guard,
    ) -> Result<Self> {
        let file = output.output_file.as_deref();
        let kind = file.and_then(Kind::of).filter(|_| output.format.is_none());
        let [to_robot, to_page] = [Kind::Toml, Kind::Html].map(|wanted| file.filter(|_| kind == Some(wanted)));
        let given = |option: Option<&Path>, by_ending: Option<&Path>, name: &str| match (option, by_ending) {
            (Some(_), Some(_)) => {
                bail!("⟪{name}⟫ and -o name a file of the same kind: leave out one of them")
            }
            (option, by_ending) => Ok(option.or(by_ending).map(Path::to_owned)),
        };
        let (to_robot, to_page, elsewhere) = (
            given(robot.1, to_robot, robot.0)?,
            given(page, to_page, "page")?,
            to_robot.is_some() || to_page.is_some(),
        );

        let printed =
            OutputArgs { format: output.format, output_file: output.output_file.clone().filter(|_| !elsewhere) };
        let sink = Sink::open(&printed, &[Kind::Toml, Kind::Html], guard)?;
        let of_robot = Content { name: "the robot file", in_words: "a robot file", fitting: &[Kind::Toml] };
        let mut open = |path: Option<PathBuf>, content: Content| {
            path.map(|path| anyhow::Ok((Target::open(Some(&path), content, guard)?, path))).transpose()
        };
        Ok(Self { sink, robot: open(to_robot, of_robot)?, page: open(to_page, Content::PAGE)? })
    }

    /// Prints the result, and writes the robot file and the page, which is made only if it is wanted.
    ///
    /// # Errors
    /// A file that cannot be written, or a page that cannot be made.
    pub(super) fn write(
        self,
        found: &impl Printed,
        robot_file: &str,
        page: impl FnOnce() -> Result<String>,
    ) -> Result<()> {
        self.sink.write(found)?;
        if let Some((target, path)) = self.robot {
            target.write(robot_file.as_bytes())?;
            errors::note(&format!("wrote {}", path.display()));
        }
        if let Some((target, path)) = self.page {
            target.write(page()?.as_bytes())?;
            errors::note(&format!("wrote {}", path.display()));
        }
        Ok(())
    }
}

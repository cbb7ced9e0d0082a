//! `completions` and `man`: names and help of the program for shells and for the manual, from its arguments.

use crate::args::{self, Cli};
use crate::output;
use anyhow::{Result, bail};
use clap::builder::PossibleValuesParser;
use clap::{Arg, Command, value_parser};
use clap_complete::Shell;
use clap_mangen::Man;
use std::io::{self, Write};

pub(crate) const COMPLETIONS: &str = "completions";
pub(crate) const MAN: &str = "man";

/// Name of the program in shells and in the manual.
const PROGRAM: &str = "funicular";

/// Command `completions` with its arguments, without help.
pub(crate) fn completions() -> Command {
    let shell = Arg::new("shell").value_name("SHELL").required(true).value_parser(value_parser!(Shell));
    Command::new(COMPLETIONS).arg(shell.help("Shell that reads the completions"))
}

/// Command `man` with its arguments, without help. Its values are the other commands.
pub(crate) fn man(commands: &[&'static str]) -> Command {
    let of = Arg::new("of").value_name("COMMAND").value_parser(PossibleValuesParser::new(commands.to_vec()));
    Command::new(MAN).arg(of.hide_possible_values(true).help("Command of the page [default: the whole program]"))
}

/// Prints the completions of a shell or a page of the manual, if the command line asks for one of them.
///
/// # Errors
/// A request is asked for, which these commands do not have, or standard output fails.
pub(crate) fn printed(cli: &Cli) -> Result<bool> {
    let text = match cli.name.as_str() {
        COMPLETIONS => {
            let mut text = Vec::new();
            let shell = *cli.value::<Shell>("shell").unwrap_or(&Shell::Bash);
            clap_complete::generate(shell, &mut args::program(), PROGRAM, &mut text);
            text
        }
        MAN => page(cli.value::<String>("of").map(String::as_str))?,
        _ => return Ok(false),
    };
    if cli.print_request {
        bail!("`{}` has no request: leave out --print-request", cli.name);
    }

    let mut out = io::stdout().lock();
    out.write_all(&text).and_then(|()| out.flush()).map_err(output::of_stdout)?;
    Ok(true)
}

/// Page of the manual in roff, of the program or of one of its commands.
fn page(of: Option<&str>) -> io::Result<Vec<u8>> {
    let mut program = args::program();
    program.build();
    let named = of.and_then(|name| program.find_subcommand(name)).cloned();
    let command = named.map_or(program, |command| {
        let title = format!("{PROGRAM}-{}", command.get_name());
        command.name(title)
    });
    let mut text = Vec::new();
    Man::new(command).render(&mut text)?;
    Ok(text)
}

//! `completions` and `man`: names and help of the program for shells and for the manual, from its arguments.

use crate::args::{self, COMPLETIONS, Cli, MAN};
use crate::output;
use anyhow::{Result, bail};
use clap_complete::Shell;
use clap_mangen::Man;
use std::io::{self, Write};

/// Name of the program in shells and in the manual.
const PROGRAM: &str = "funicular";

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

//! Completions for shells and pages of the manual.

use super::bad_input::assert_refused;
use super::{project, run, succeed};
use std::io::Write;
use std::process::{Command, Stdio};

#[test]
fn completions_know_every_command_and_bash_reads_them() {
    let text = succeed(&["completions", "bash"]);
    for option in ["--below-hz", "--tension-rule", "--readings", "--cable-pieces", "completions"] {
        assert!(text.contains(option), "{option}");
    }
    let mut bash = Command::new("bash").arg("-n").stdin(Stdio::piped()).spawn().unwrap();
    bash.stdin.take().unwrap().write_all(text.as_bytes()).unwrap();
    assert!(bash.wait().unwrap().success());

    for shell in ["zsh", "fish", "powershell", "elvish"] {
        assert!(succeed(&["completions", shell]).contains("below-hz"), "{shell}");
    }
    assert_refused(&run(&["completions", "bsh"]), 2, "bash", "");
    assert_refused(&run(&["completions", "bash", "--print-request"]), 2, "has no request", "");
}

#[test]
fn the_manual_has_a_page_of_the_program_and_one_of_each_command() {
    let program = succeed(&["man"]);
    assert!(program.contains(".TH funicular 1") && program.contains("robot file"), "{program}");

    let modes = succeed(&["man", "modes"]);
    assert!(modes.contains(".TH funicular-modes 1") && modes.contains("below\\-hz"), "{modes}");
    assert!(modes.contains("yuan2014\\-4mm.toml"), "the example is part of the page: {modes}");
    assert_refused(&run(&["man", "mods"]), 2, "modes", "");
}

#[test]
fn the_script_of_an_installation_writes_completions_and_a_page_for_every_command() {
    let folder = tempfile::tempdir().unwrap();
    let script = project("scripts/shell-files");
    let done =
        Command::new("bash").args([&script, env!("CARGO_BIN_EXE_funicular")]).arg(folder.path()).output().unwrap();
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));

    let read = |name: &str| std::fs::read_to_string(folder.path().join(name)).unwrap();
    for name in [
        "bash-completion/completions/funicular",
        "zsh/site-functions/_funicular",
        "fish/vendor_completions.d/funicular.fish",
    ] {
        assert!(read(name).contains("below-hz"), "{name}");
    }
    let commands = funicular_study::request::commands();
    for command in commands {
        let page = read(&format!("man/man1/funicular-{}.1", command.name));
        assert!(page.starts_with(".ie") && page.contains(&format!(".TH funicular-{} 1", command.name)), "{page:.200}");
    }
    let pages = std::fs::read_dir(folder.path().join("man/man1")).unwrap().count();
    assert_eq!(pages, commands.len() + 1, "one page per command, and that of the program");
}

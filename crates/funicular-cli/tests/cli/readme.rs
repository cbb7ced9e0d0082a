//! README.md shows what the program prints. `UPDATE_README=1 cargo test -p funicular-cli readme` writes it anew.

use super::{command, stderr, stdout};
use std::fs;
use std::path::{Path, PathBuf};

const BEGIN: &str = "```console\n$ funicular ";
const END: &str = "```\n";

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Runs a line of the README where its paths are right.
fn printed(line: &str) -> String {
    let arguments: Vec<&str> = line.split(' ').collect();
    let output = command(&arguments).current_dir(root()).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{line}: {}", stderr(&output));
    stdout(&output).to_owned()
}

/// The same words; numbers may differ by one in the last place, and what is zero but for rounding by anything.
fn same(a: &str, b: &str) -> bool {
    let words = |text: &str| text.split_whitespace().map(str::to_owned).collect::<Vec<_>>();
    let number = |word: &str| word.trim_end_matches([',', '%', ')', ';', '.']).trim_start_matches('(').parse::<f64>();
    let (a, b) = (words(a), words(b));
    a.len() == b.len()
        && a.iter().zip(&b).all(|(a, b)| match (number(a), number(b)) {
            _ if a == b => true,
            (Ok(x), Ok(y)) if a.contains('e') => x.abs() < 1e-9 && y.abs() < 1e-9,
            (Ok(x), Ok(y)) => {
                let digits = |word: &str| word.split_once('.').map_or(0, |(_, after)| after.len());
                digits(a) == digits(b) && (x - y).abs() < 1.5 * 0.1_f64.powf(digits(a).min(6) as f64)
            }
            _ => false,
        })
}

#[test]
fn the_documents_show_what_the_program_prints() {
    assert!(blocks_are_printed("README.md") >= 3, "statics, modes and compare are shown");
    assert!(blocks_are_printed("docs/how-to-choose.md") >= 2);
    assert!(blocks_are_printed("docs/sweeps.md") >= 1);
    assert!(blocks_are_printed("docs/control.md") >= 1);
}

/// Checks the console blocks of a document, or renews them; their number.
fn blocks_are_printed(document: &str) -> usize {
    let path = root().join(document);
    let readme = fs::read_to_string(&path).unwrap();
    let mut renewed = String::new();
    let mut rest = readme.as_str();
    let mut blocks = 0;
    while let Some((before, after)) = rest.split_once(BEGIN) {
        let (block, after) = after.split_once(END).expect("a console block ends");
        let (line, shown) = block.split_once('\n').expect("a console block has a command");
        let now = printed(line);
        let update = std::env::var_os("UPDATE_README").is_some();
        assert!(update || same(shown, &now), "{line}: {document} shows\n{shown}\nthe program prints\n{now}");
        renewed += &[before, BEGIN, line, "\n", &now, END].concat();
        rest = after;
        blocks += 1;
    }
    if std::env::var_os("UPDATE_README").is_some() {
        fs::write(&path, renewed + rest).unwrap();
    }
    blocks
}

#[test]
fn the_commands_of_the_readme_and_of_the_program_are_the_same() {
    let readme = fs::read_to_string(root().join("README.md")).unwrap();
    let table: Vec<&str> =
        readme.lines().filter(|line| line.starts_with("| `") && line.contains("`funicular ")).collect();
    let help = super::succeed(&["--help"]);
    let (_, commands) = help.split_once("Commands:").unwrap();
    let (commands, _) = commands.split_once("Options:").unwrap();
    let verbs: Vec<&str> = commands
        .lines()
        .filter(|line| line.starts_with("  ") && !line.starts_with("   "))
        .filter_map(|line| line.split_whitespace().next())
        .filter(|verb| *verb != "help")
        .collect();
    assert_eq!(verbs.len(), table.len(), "{verbs:?}");
    for (verb, row) in verbs.iter().zip(table) {
        assert!(row.starts_with(&format!("| `{verb}` |")), "{verb}: {row}");
        let (_, example) = row.rsplit_once("`funicular ").unwrap();
        let mut arguments: Vec<&str> = example.trim_end_matches([' ', '|', '`']).split(' ').collect();
        if ["merge", "plot", "request"].contains(verb) {
            // Their files have to be made first: `sweeps` and `plots` do.
            continue;
        }
        let is_page = ["report", "paper"].contains(verb);
        if is_page {
            arguments.retain(|argument| *argument != "-o" && *argument != "cogiro.html");
            arguments.extend(["-o", "/dev/null"]);
        }
        let output = command(&arguments).current_dir(root()).output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{row}: {}", stderr(&output));
    }
}

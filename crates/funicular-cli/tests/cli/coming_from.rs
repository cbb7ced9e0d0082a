//! The page for users of other programs names only commands, options, quantities and keys that there are, and what it
//! says to be missing is missing.

use super::{project, run, succeed};
use funicular_study::request;
use std::collections::HashSet;

/// Things that the page says funicular does not have, with words that no name of it may contain then.
const NOT_HERE: [(&str, &[&str]); 2] = [
    ("operational space, several links, muscles", &["muscle", "operational_space", "joint"]),
    ("seabed, current, waves", &["seabed", "water", "current", "wave"]),
];

/// Cells of the right column of every table of the page, each with its left one.
fn rows(page: &str) -> Vec<(String, String)> {
    let cells = |line: &str| line.trim_matches('|').split('|').map(|cell| cell.trim().to_owned()).collect::<Vec<_>>();
    let lines = page.lines().filter(|line| line.starts_with('|') && !line.starts_with("|---"));
    lines.map(cells).filter(|row| row.len() == 2).map(|row| (row[0].clone(), row[1].clone())).collect()
}

/// Words of JSON: its keys and its texts without blanks.
fn names_of(schema: &str) -> HashSet<String> {
    schema.split('"').filter(|word| !word.is_empty() && !word.contains([' ', ',', ':'])).map(str::to_owned).collect()
}

/// Everything that a table may name: commands, and words of all schemas.
fn known() -> HashSet<String> {
    let subjects = ["robot-file", "request", "results"];
    let schemas = subjects.iter().flat_map(|of| names_of(&succeed(&["schema", "--of", of])));
    let columns = names_of(&succeed(&["schema", "--of", "columns"]));
    let commands = request::commands().iter().map(|command| command.name.to_owned());
    schemas.chain(columns).chain(commands).collect()
}

/// True for a key of a request of any command.
fn is_key(name: &str) -> bool {
    request::commands().iter().flat_map(|command| &command.keys).any(|key| key.name == name)
}

/// Checks a piece of code of a table.
fn check(code: &str, known: &HashSet<String>) {
    let words: Vec<&str> = code.split_whitespace().filter(|word| !matches!(*word, "funicular" | "=")).collect();
    let command = request::commands().iter().find(|command| command.name == words[0]);
    let help = command.map(|command| succeed(&["help", command.name]));
    for (i, word) in words.iter().enumerate() {
        let bare = word.trim_matches(|c: char| "[]\",".contains(c));
        let bare = bare.split('.').next().unwrap_or(bare);
        let is_placeholder = bare.chars().all(char::is_uppercase) || word.contains("x,y,z");
        let is_file = i > 0 && matches!(words[i - 1], "-o" | "--scenario" | "--quantity");
        match word.strip_prefix("--") {
            Some(option) => {
                let is_there = match &help {
                    Some(help) => help.contains(&format!("--{option} ")) || help.contains(&format!("--{option}\n")),
                    // Options that name files are no keys of requests.
                    None if ["cable-set", "to"].contains(&option) => true,
                    None => is_key(&option.replace('-', "_")),
                };
                assert!(is_there, "`{code}`: there is no option {word}");
            }
            None if i > 0 && words[i - 1] == "--quantity" => {
                let done = run(&["map", "ROBOT", "--grid", "z=0.5", "--quantity", word]);
                assert_eq!(done.status.code(), Some(0), "`{code}`: there is no quantity {word}");
            }
            None if *word == "-o" || is_placeholder || is_file => {}
            None => assert!(known.contains(bare), "`{code}`: there is nothing called {bare}"),
        }
    }
}

#[test]
fn the_page_names_what_there_is() {
    let page = std::fs::read_to_string(project("docs/coming-from.md")).unwrap();
    let (mut known, rows) = (known(), rows(&page));
    // Tables of a scenario, which has no schema: the reader names them all.
    let robot = super::robot("yuan2014-4mm.toml");
    let folder = tempfile::tempdir().unwrap();
    let scenario = folder.path().join("scenario.toml");
    std::fs::write(&scenario, "[[cut]]\ncable = \"1\"\nat_s = 0.5\n").unwrap();
    let words = ["simulate", &robot, "--scenario", scenario.to_str().unwrap(), "--for", "0.1", "--print-request"];
    known.extend(names_of(&succeed(&words)).into_iter().filter(|name| name == "cut"));

    let mut count = 0;
    for (_, here) in &rows {
        for code in here.split('`').skip(1).step_by(2) {
            check(code, &known);
            count += 1;
        }
    }
    assert!(count > 60, "{count} names");
    for wrong in ["modes --quantity lowest", "[platfrom]", "map --quantity frequency-hz", "--tension-rules"] {
        assert!(std::panic::catch_unwind(|| check(wrong, &known)).is_err(), "{wrong} is not found");
    }
}

#[test]
fn what_the_page_says_to_be_missing_is_missing() {
    let page = std::fs::read_to_string(project("docs/coming-from.md")).unwrap();
    let rows = rows(&page);
    let missing: Vec<&str> =
        rows.iter().filter(|(_, here)| here.contains("not here")).map(|(theirs, _)| theirs.as_str()).collect();
    assert_eq!(missing, NOT_HERE.map(|(what, _)| what), "each missing thing has its words");

    let names = known();
    for (what, words) in NOT_HERE {
        // A name as a whole, or a part of one between underscores.
        let parts = names.iter().flat_map(|name| name.split(['_', '-']).chain([name.as_str()]));
        let found: Vec<&str> = parts.filter(|part| words.contains(part)).collect();
        assert!(found.is_empty(), "the page says that {what} are not here, but there are {found:?}");
    }
}

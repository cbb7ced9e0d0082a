//! Rules of ARCHITECTURE.md that the sources can be read for.

mod circles;
mod names;
mod sizes;
mod words;

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// Every source file under a folder.
fn sources(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let mut files = Vec::new();
    for path in entries {
        if path.is_dir() {
            files.extend(sources(&path));
        } else if path.extension().is_some_and(|ending| ending == "rs") {
            files.push(path);
        }
    }
    files
}

#[test]
fn only_math_names_nalgebra() {
    let path_of_nalgebra = ["nalgebra", "::"].concat();
    let mut naming: Vec<PathBuf> = ["src", "tests", "benches"]
        .into_iter()
        .flat_map(|folder| sources(&root().join(folder)))
        .filter(|path| fs::read_to_string(path).unwrap().contains(&path_of_nalgebra))
        .map(|path| path.strip_prefix(root()).unwrap().to_owned())
        .collect();
    naming.sort();
    assert_eq!(naming, [Path::new("src/math.rs")], "take the type from math.rs, or give it a name there");
}

/// Text of every source of a crate, without its tests, with its path below `crates`.
fn texts(name: &str) -> Vec<(PathBuf, String)> {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let files = sources(&crates.join(name).join("src"));
    assert!(files.len() > 10, "{name}");
    let read = |path: PathBuf| {
        let text = fs::read_to_string(&path).unwrap();
        let shown = path.strip_prefix(&crates).unwrap().to_owned();
        (shown, text.split("#[cfg(test)]").next().unwrap_or_default().to_owned())
    };
    let is_of_tests = |shown: &Path| shown.ends_with("tests.rs") || shown.iter().any(|folder| folder == "tests");
    files.into_iter().map(read).filter(|(shown, _)| !is_of_tests(shown)).collect()
}

/// The first option as a command line has it, `--word`, in a text.
fn option(text: &str) -> Option<&str> {
    text.match_indices("--").find_map(|(at, _)| {
        let (before, after) = (&text[..at], &text[at + 2..]);
        let begins = !before.ends_with(|c: char| c == '-' || c.is_alphanumeric());
        let word = after.split(|c: char| !(c.is_ascii_lowercase() || c == '-')).next().unwrap_or_default();
        (begins && word.starts_with(|c: char| c.is_ascii_lowercase())).then_some(&text[at..at + 2 + word.len()])
    })
}

/// String literals and comments of a source. What a literal inserts between braces is left out.
fn literals_and_comments(source: &str) -> (Vec<String>, Vec<String>) {
    let (mut literals, mut comments) = (Vec::new(), Vec::new());
    let mut rest = source;
    while let Some(c) = rest.chars().next() {
        let raw = rest.strip_prefix('r').filter(|after| after.trim_start_matches('#').starts_with('"'));
        rest = if rest.starts_with("//") {
            let (comment, after) = rest.split_once('\n').unwrap_or((rest, ""));
            comments.push(comment.to_owned());
            after
        } else if let Some(after) = raw {
            let hashes = after.split('"').next().unwrap();
            let (literal, after) = after[hashes.len() + 1..].split_once(&format!("\"{hashes}")).unwrap();
            literals.push(literal);
            after
        } else if c == '"' {
            let text = &rest[1..];
            let is_end = |at: &usize| text[..*at].chars().rev().take_while(|c| *c == '\\').count() % 2 == 0;
            let end = text.match_indices('"').map(|(at, _)| at).find(is_end).unwrap();
            literals.push(&text[..end]);
            &text[end + 1..]
        } else if let Some(character) = rest.strip_prefix("'\\") {
            // Escaped character.
            &character[1..]
        } else if let Some(after) = rest.strip_prefix("'\"'") {
            after
        } else {
            // A word is passed as a whole: its last letter may be an r before a quote.
            let word = rest.len() - rest.trim_start_matches(|c: char| c.is_alphanumeric() || c == '_').len();
            &rest[word.max(c.len_utf8())..]
        };
    }
    let outside_braces = |text: &str| -> String {
        text.split('{').map(|part| part.split_once('}').map_or(part, |(_, after)| after)).collect()
    };
    (literals.into_iter().map(outside_braces).collect(), comments)
}

/// Word of a front end in a text: its user's command line, or one of its options. Code between backticks, and Rust's
/// type `Option`, are no text.
fn word_of_front_end(text: &str) -> Option<&'static str> {
    let text = text.split('`').step_by(2).collect::<Vec<_>>().join(" ").replace("Option<", "").replace("Option::", "");
    let text = text.to_lowercase();
    if text.contains("command line") {
        return Some("command line");
    }
    let mut words = text.split(|c: char| !(c.is_alphanumeric() || c == '_'));
    words.any(|word| word == "option" || word == "options").then_some("option")
}

#[test]
fn core_and_files_name_no_option() {
    // Each front end writes the names of options in its own way: messages name them by their keys, ⟪mass_kg⟫, which are
    // those of the study's requests. The core knows no requests at all.
    assert_eq!(option("raise it with `--min-tension-n`, or -- else"), Some("--min-tension-n"));
    assert_eq!(option("a --- b -- 3 x--y"), None);
    assert_eq!(word_of_front_end("Name on the command line."), Some("command line"));
    assert_eq!(word_of_front_end("Options of the model"), Some("option"));
    assert_eq!(word_of_front_end("an `option` that `SearchOptions` has, optional: Option<f64>"), None);
    let source = "let options = f(\"give \\\"{option}\\\" \\\n  now\", '\"', r#\"an \"x\"\"#); // a\n'b'";
    assert_eq!(
        literals_and_comments(source),
        (vec!["give \\\"\\\" \\\n  now".to_owned(), "an \"x\"".to_owned()], vec!["// a".to_owned()])
    );
    for name in ["funicular", "funicular-files"] {
        for (path, text) in texts(name) {
            let shown = path.display();
            assert_eq!(option(&text), None, "{shown}: carry the data, and let funicular-study word it");
            assert!(name != "funicular" || !text.contains('⟪'), "{shown}: the study names options");
            let (mut said, comments) = literals_and_comments(&text);
            // Comments of the files may say that a caller's option names a file; the core does not know of callers.
            said.extend(comments.into_iter().filter(|_| name == "funicular"));
            let found = said.iter().find(|text| word_of_front_end(text).is_some());
            assert_eq!(found, None, "{shown}: say it in words that every front end shares");
        }
    }
}

/// Calls of the operating system compile for WebAssembly too, and fail there when they run. So the sources are read for
/// them.
#[test]
fn core_and_study_have_no_disk_no_threads_and_no_clock() {
    for name in ["funicular", "funicular-study", "funicular-formats", "funicular-validation", "funicular-pages"] {
        for (path, text) in texts(name) {
            for module in ["fs", "thread", "time", "process", "net", "env"] {
                let named = [format!("std::{module}::"), format!("std::{module};"), format!("std::{{{module}")];
                let found = named.iter().find(|form| text.contains(form.as_str()));
                assert_eq!(found, None, "{}: disk and threads belong to funicular-files", path.display());
            }
        }
    }
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).to_owned()
}

/// Source of a file without its comments and without its unit tests.
fn code(path: &Path) -> String {
    let text = fs::read_to_string(path).unwrap();
    let library = text.split("#[cfg(test)]\nmod tests").next().unwrap();
    library.lines().filter(|line| !line.trim_start().starts_with("//")).collect::<Vec<_>>().join("\n")
}

/// Rooms of the crate that a source names by `crate::ROOM` or in a list `crate::{…}`.
fn named_rooms(source: &str, rooms: &BTreeSet<String>) -> BTreeSet<String> {
    let mut named = BTreeSet::new();
    for after in source.split("crate::").skip(1) {
        let list = after.strip_prefix('{').and_then(|list| list.split('}').next());
        let words = list.map_or_else(|| vec![after], |list| list.split(',').collect());
        for word in words {
            let name: String = word.trim().chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
            if rooms.contains(&name) {
                named.insert(name);
            }
        }
    }
    named
}

/// Rows of the table "Direction" of ARCHITECTURE.md: a room and the rooms that it uses.
fn direction_table() -> Vec<(String, BTreeSet<String>)> {
    let text = fs::read_to_string(root().join("../../ARCHITECTURE.md")).unwrap();
    let section = text.split("## Direction").nth(1).unwrap().split("\n## ").next().unwrap();
    let names = |cell: &str| cell.split('`').skip(1).step_by(2).map(str::to_owned).collect::<Vec<_>>();
    let rows = section.lines().filter(|line| line.starts_with("| `"));
    rows.map(|row| {
        let mut cells = row.trim_matches('|').split('|');
        (names(cells.next().unwrap())[0].clone(), names(cells.next().unwrap()).into_iter().collect())
    })
    .collect()
}

#[test]
fn rooms_use_each_other_as_the_direction_table_of_architecture_says() {
    let table = direction_table();
    let listed: BTreeSet<String> = table.iter().map(|(room, _)| room.clone()).collect();
    let lib = fs::read_to_string(root().join("src/lib.rs")).unwrap();
    let rooms: BTreeSet<String> = lib
        .lines()
        .filter_map(|line| line.strip_prefix("pub mod ").or(line.strip_prefix("mod "))?.strip_suffix(';'))
        .map(str::to_owned)
        .collect();
    assert_eq!(listed, rooms, "the table of ARCHITECTURE.md lists the modules of lib.rs");

    let mut above = BTreeSet::new();
    for (room, stated) in &table {
        assert!(stated.is_subset(&above), "{room} uses a room that is below it in the table");
        above.insert(room.clone());

        let file = root().join(format!("src/{room}.rs"));
        let folder = root().join(format!("src/{room}"));
        let mut files = vec![file];
        if folder.is_dir() {
            files.extend(sources(&folder));
        }
        let mut used: BTreeSet<String> = files.iter().flat_map(|file| named_rooms(&code(file), &rooms)).collect();
        used.remove(room);
        assert_eq!(&used, stated, "rooms that {room} uses, beside its row in ARCHITECTURE.md");
    }
}

#[test]
fn the_map_of_architecture_names_what_exists_and_every_room() {
    let top = root().join("../..");
    let text = fs::read_to_string(top.join("ARCHITECTURE.md")).unwrap();
    assert!(text.lines().count() <= 200, "ARCHITECTURE.md is the map; reasons stand in DESIGN.md");

    let map = text.split("## Map").nth(1).unwrap().split("```").nth(1).unwrap();
    let (mut base, mut inner) = (PathBuf::new(), PathBuf::new());
    for line in map.lines().filter(|line| !line.trim().is_empty()) {
        let indent = line.len() - line.trim_start().len();
        let paths = line.trim_start().split("  ").next().unwrap();
        let mut beside = None;
        for path in paths.split(", ") {
            let folder = match indent {
                0 => top.clone(),
                2 => base.clone(),
                _ => inner.clone(),
            };
            // `src/robot.rs, robot/`: a second name may stand in the folder of the first.
            let full = folder.join(path.trim());
            let second = beside.as_ref().map(|beside: &PathBuf| beside.join(path.trim()));
            let is_there = full.exists() || second.is_some_and(|second| second.exists());
            assert!(is_there, "{} is on the map of ARCHITECTURE.md and not there", full.display());
            beside = beside.or_else(|| full.parent().map(Path::to_owned));
            match indent {
                0 => base = full,
                2 => inner = base.join("src"),
                _ => {}
            }
        }
    }

    for (room, _) in direction_table() {
        assert!(map.contains(&format!("{room}.rs")), "{room} is missing on the map of ARCHITECTURE.md");
    }
}

#[test]
fn the_row_of_a_cable_model_names_every_file_with_an_arm_for_one() {
    let text = fs::read_to_string(root().join("../../ARCHITECTURE.md")).unwrap();
    let row = text.lines().find(|line| line.starts_with("| a cable model |")).unwrap();
    let src = root().join("src");
    let mut named = 0;
    for file in sources(&src) {
        if code(&file).contains("DynamicCable::") {
            let path = file.strip_prefix(&src).unwrap().display().to_string();
            assert!(row.contains(&format!("`{path}`")), "{path} is missing in the row of a cable model");
            named += 1;
        }
    }
    assert!(named > 2, "{named}");
}

//! Rules of ARCHITECTURE.md that the sources can be read for.

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
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut naming: Vec<PathBuf> = sources(&root)
        .into_iter()
        .filter(|path| fs::read_to_string(path).unwrap().contains("nalgebra"))
        .map(|path| path.strip_prefix(&root).unwrap().to_owned())
        .collect();
    naming.sort();
    assert_eq!(naming, [Path::new("math.rs")], "take the type from math.rs, or give it a name there");
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
    files.into_iter().map(read).collect()
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

#[test]
fn core_and_files_name_no_option() {
    // Each front end writes the names of options in its own way: messages name them by their keys, ⟪mass_kg⟫, which are
    // those of the study's requests. The core knows no requests at all.
    assert_eq!(option("raise it with `--min-tension-n`, or -- else"), Some("--min-tension-n"));
    assert_eq!(option("a --- b -- 3 x--y"), None);
    for name in ["funicular", "funicular-files"] {
        for (path, text) in texts(name) {
            assert_eq!(option(&text), None, "{}: carry the data, and let funicular-study word it", path.display());
            assert!(name != "funicular" || !text.contains('⟪'), "{}: the study names options", path.display());
        }
    }
}

/// Calls of the operating system compile for WebAssembly too, and fail there when they run. So the sources are read for them.
#[test]
fn core_and_study_have_no_disk_no_threads_and_no_clock() {
    for name in ["funicular", "funicular-study"] {
        for (path, text) in texts(name) {
            for module in ["fs", "thread", "time", "process", "net", "env"] {
                let named = [format!("std::{module}::"), format!("std::{module};"), format!("std::{{{module}")];
                let found = named.iter().find(|form| text.contains(form.as_str()));
                assert_eq!(found, None, "{}: disk and threads belong to funicular-files", path.display());
            }
        }
    }
}

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

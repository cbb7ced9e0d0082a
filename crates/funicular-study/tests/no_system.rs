//! The study asks nothing of an operating system: files, threads, clocks and the like compile for WebAssembly, and fail there
//! when they are called.

use std::fs;
use std::path::{Path, PathBuf};

/// Modules of the standard library that need an operating system.
const SYSTEM: [&str; 6] = ["std::fs", "std::thread", "std::time", "std::env", "std::net", "std::process"];

fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            sources(&path, found);
        } else {
            found.push(path);
        }
    }
}

#[test]
fn no_source_of_the_study_names_the_operating_system() {
    let mut files = Vec::new();
    sources(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src"), &mut files);
    assert!(files.len() > 20, "the sources are not there");
    for file in files {
        let text = fs::read_to_string(&file).unwrap();
        for (number, line) in (1..).zip(text.lines()) {
            let named = SYSTEM.iter().find(|module| line.contains(**module));
            assert!(named.is_none(), "{}:{number}: {line}", file.display());
        }
    }
}

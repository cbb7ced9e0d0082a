//! Messages name options that exist.

use super::{project, succeed};
use funicular_study::wording::{Words, option};
use std::collections::BTreeSet;
use std::path::Path;

/// Keys between ⟪ and ⟫ in all sources below a folder.
fn keys_in(folder: &Path, keys: &mut BTreeSet<String>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            keys_in(&path, keys);
        } else if path.extension().is_some_and(|ending| ending == "rs") {
            let text = std::fs::read_to_string(&path).unwrap();
            let found = text.split('⟪').skip(1).filter_map(|rest| rest.split_once('⟫')).map(|(key, _)| key);
            let is_key = |key: &&str| key.chars().all(|letter| letter == '_' || letter.is_ascii_lowercase());
            keys.extend(found.filter(is_key).map(str::to_owned));
        }
    }
}

/// Names that start with `--` in a help.
fn options_in(help: &str) -> impl Iterator<Item = &str> {
    help.split([' ', ',', '\n']).filter(|word| word.starts_with("--"))
}

#[test]
fn every_key_of_a_message_is_an_option_of_the_program() {
    let mut keys = BTreeSet::new();
    for part in ["funicular", "funicular-study", "funicular-files", "funicular-cli"] {
        keys_in(Path::new(&project(&format!("crates/{part}/src"))), &mut keys);
    }
    assert!(keys.len() > 60 && keys.contains("quantities"), "{keys:?}");

    let help = succeed(&["--help"]);
    let commands = help.split_once("Commands:\n").unwrap().1.split_once("\n\n").unwrap().0;
    let is_new = |line: &&str| line.starts_with("  ") && !line.starts_with("   ");
    let names = commands.lines().filter(is_new).filter_map(|line| line.split_whitespace().next());
    let helps: Vec<String> = names.filter(|name| *name != "help").map(|name| succeed(&[name, "--help"])).collect();
    assert!(helps.len() > 25);
    let mut options: BTreeSet<&str> = helps.iter().flat_map(|help| options_in(help)).collect();
    options.extend(["ROBOT", "FILE"]);

    let named = keys.iter().map(|key| option(key, Words::Program));
    let missing: Vec<String> = named.filter(|name| !options.contains(name.as_str())).collect();
    assert!(missing.is_empty(), "messages name options that no command has: {missing:?}");
}

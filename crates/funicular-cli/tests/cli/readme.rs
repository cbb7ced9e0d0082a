//! The documents show what the program prints. `UPDATE_README=1 cargo test -p funicular-cli readme` writes it anew.

use super::{command, stderr, stdout};
use std::fs;
use std::path::{Path, PathBuf};

const BEGIN: &str = "```console\n$ funicular ";
const END: &str = "```\n";

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Output of a line of a document, run where its paths are right: warnings first, as a terminal shows them; the message
/// if the document shows that it fails.
fn printed(line: &str, shown: &str) -> String {
    let arguments: Vec<&str> = line.split(' ').collect();
    let output = command(&arguments).current_dir(root()).output().unwrap();

    let after_warnings = shown.lines().find(|line| !line.starts_with("warning: "));
    let expected = i32::from(after_warnings.is_some_and(|line| line.starts_with("error: ")));
    assert_eq!(output.status.code(), Some(expected), "{line}: {}", stderr(&output));
    // Progress depends on the speed of the machine.
    let is_progress = |line: &str| {
        let after =
            |(_, time): (&str, &str)| time.split_once(" s").is_some_and(|(time, _)| time.parse::<u64>().is_ok());
        line.starts_with("computing for ") || line.split_once(" after ").is_some_and(after)
    };
    let told: String = stderr(&output).split_inclusive('\n').filter(|line| !is_progress(line.trim_end())).collect();
    told + stdout(&output)
}

/// Compares two texts word by word; numbers may differ by one in the last place, and what is zero but for rounding by
/// anything.
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

/// Pages of a folder of docs/ and how many console blocks they show.
fn shown_in(folder: &str) -> Vec<(String, usize)> {
    let mut names: Vec<PathBuf> =
        fs::read_dir(root().join(folder)).unwrap().map(|entry| entry.unwrap().path()).collect();
    names.retain(|path| path.extension().is_some_and(|ending| ending == "md"));
    names.sort();
    let pages = names.iter().map(|path| format!("{folder}/{}", path.file_name().unwrap().to_str().unwrap()));
    pages.map(|page| (page.clone(), blocks_are_printed(&page))).collect()
}

/// Every page of docs/ is checked; some have to show something.
#[test]
fn the_documents_show_what_the_program_prints() {
    let shown = shown_in("docs");
    let least = [("commands", 4), ("how-to-choose", 2), ("quick-start", 5), ("workspace", 4), ("measuring", 4)];
    for (page, least) in least.into_iter().chain([("sweeps", 1), ("control", 1), ("pulleys", 1), ("first-result", 2)]) {
        let blocks = shown.iter().find(|(name, _)| *name == format!("docs/{page}.md")).unwrap().1;
        assert!(blocks >= least, "docs/{page}.md shows {blocks} outputs");
    }
}

/// The test has a name of its own, so that it runs beside the one above.
#[test]
fn the_tutorials_show_what_the_program_prints() {
    let shown = shown_in("docs/tutorials");
    assert!(shown.iter().map(|page| page.1).sum::<usize>() >= 20, "{shown:?}");
}

/// Commands with the robot of the quick start that a document shows without their output, in its order.
fn commands_without_output(text: &str) -> Vec<String> {
    let mut commands = Vec::new();
    for line in text.lines() {
        let line_of_shell = line.starts_with("funicular ").then(|| line.split(" #").next().unwrap_or_default());
        let between_backticks = line.split('`').skip(1).step_by(2).filter(|code| code.starts_with("funicular "));
        let found = line_of_shell.into_iter().chain(between_backticks);
        commands.extend(found.filter(|code| code.contains("hall.") && !code.contains('…')).map(str::to_owned));
    }
    commands
}

#[test]
fn commands_that_the_pages_show_without_output_run() {
    let hall = root().join("docs/quick-start/hall.toml").canonicalize().unwrap();
    let mut count = 0;
    for page in ["quick-start", "workspace", "matlab"] {
        let folder = tempfile::tempdir().unwrap();
        let text = fs::read_to_string(root().join(format!("docs/{page}.md"))).unwrap();
        for line in commands_without_output(&text) {
            let words = line.split_whitespace().skip(1);
            let arguments: Vec<&str> =
                words.map(|word| if word.ends_with("hall.toml") { hall.to_str().unwrap() } else { word }).collect();
            let output = command(&arguments).current_dir(folder.path()).output().unwrap();
            assert_eq!(output.status.code(), Some(0), "{page}: {line}: {}", stderr(&output));
            count += 1;
        }
    }
    assert!(count >= 8, "{count} commands");
}

/// Blocks of shell of the tutorials: their lines run in their order, in a folder that has the examples.
#[cfg(unix)]
#[test]
fn commands_of_the_tutorials_run_in_their_order() {
    let pages = ["first-result", "coming-from", "tutorials/drawing", "tutorials/good-enough", "tutorials/cluster"];
    let more = ["tutorials/measurement", "tutorials/controller", "tutorials/paper"];
    let calibrated = ["tutorials/anchors-of-a-plotter", "tutorials/anchors-of-eight-cables"];
    let mut count = 0;
    for page in pages.into_iter().chain(more).chain(calibrated) {
        let folder = tempfile::tempdir().unwrap();
        for name in ["docs", "robots"] {
            std::os::unix::fs::symlink(root().canonicalize().unwrap().join(name), folder.path().join(name)).unwrap();
        }
        let text = fs::read_to_string(root().join(format!("docs/{page}.md"))).unwrap();
        for block in text.split("```sh\n").skip(1) {
            for line in block.split("```").next().unwrap().lines().filter(|line| line.starts_with("funicular ")) {
                let arguments: Vec<&str> = line.split_whitespace().skip(1).collect();
                let output = command(&arguments).current_dir(folder.path()).output().unwrap();
                assert_eq!(output.status.code(), Some(0), "{page}: {line}: {}", stderr(&output));
                count += 1;
            }
        }
        if page == "tutorials/cluster" {
            let bytes = |name: &str| fs::read(folder.path().join(name)).unwrap();
            assert_eq!(bytes("all.parquet"), bytes("merged.parquet"), "the parts are joined to the same file");
        }
    }
    assert!(count >= 19, "{count} commands");
}

/// The listing of docs/pulleys.md, with a platform and a rope, is a robot whose only cable runs as it says.
#[test]
fn the_listing_of_pulleys_and_winches_is_read_and_rests() {
    let page = fs::read_to_string(root().join("docs/pulleys.md")).unwrap();
    let (_, after) = page.split_once("```toml\n").expect("the page has a listing");
    let (listing, _) = after.split_once(END).expect("the listing ends");
    let robot = format!(
        "name = \"listing\"\n[platform]\nmass_kg = 20.0\ninertia_kg_m2 = [1.0, 1.0, 1.0]\ncenter_of_mass_m = [0.0, \
         0.0, 0.0]\n\
         [materials.rope]\naxial_stiffness_n = 251e3\nmass_kg_per_m = 0.067\n{listing}"
    );
    let json = |arguments: &[&str]| -> serde_json::Value {
        let output = super::run_with(&[arguments, &["--format", "json"]].concat(), &robot);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        serde_json::from_str(stdout(&output)).unwrap()
    };

    let checked = json(&["check", "-"]);
    let cable = &checked["cables"][0];
    assert_eq!((&cable["pulley"]["name"], &cable["winch"]["name"]), (&"wheel".into(), &"drum".into()));
    let rest = json(&["statics", "-", "--lengths-m", "6.0"]);
    let drive = &rest["cables"][0]["drive"];
    let of = |key: &str| drive[key].as_f64().unwrap();
    // Up from the winch, over the wheel and down again.
    assert!((of("wrap_deg") - 180.0).abs() < 0.1, "{drive}");
    let sum = of("free_length_m") + of("arc_length_m") + of("drum_side_length_m");
    assert!((sum - 6.0).abs() < 1e-9, "{drive}");
    assert!((of("winch_yield_m") - of("tension_drum_n") / 50e3).abs() < 1e-12, "{drive}");
}

/// Keys and options that the glossary names exist: a word of the program that changes has to change there.
#[test]
fn the_glossary_names_options_and_keys_that_exist() {
    let glossary = fs::read_to_string(root().join("docs/glossary.md")).unwrap();
    let rows: Vec<&str> = glossary.lines().filter(|line| line.starts_with("| ")).skip(1).collect();
    assert!(rows.len() >= 15, "{} words", rows.len());

    let statics = super::succeed(&["help", "statics"]);
    let others = ["map", "frf", "modes"].map(|verb| super::succeed(&["help", verb])).concat();
    let help = statics + &others;
    let keys = super::succeed(&["parameters", root().join("docs/quick-start/hall.toml").to_str().unwrap()]);
    for row in &rows {
        for code in row.rsplit('|').nth(1).unwrap().split('`').skip(1).step_by(2) {
            let option = code.split(' ').find(|word| word.starts_with("--"));
            assert!(option.is_none_or(|option| help.contains(option)), "{row}: no option {code}");
            let key = code.ends_with("_m") || code.ends_with("_ratio");
            assert!(!key || keys.contains(code) || code == "unstrained_length_m", "{row}: no key {code}");
        }
    }
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
        let now = printed(line, shown);
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
fn the_commands_of_the_documents_and_of_the_program_are_the_same() {
    let page = fs::read_to_string(root().join("docs/commands.md")).unwrap();
    let table: Vec<&str> =
        page.lines().filter(|line| line.starts_with("| `") && line.contains("`funicular ")).collect();
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
        if ["merge", "plot", "request", "live"].contains(verb) {
            // Their files have to be made first: `sweeps` and `plots` do. `live` needs a build with the page: `pages`.
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

/// Bytes that README.md may have: a visitor reads it in a minute.
const MAX_README: usize = 8000;

#[test]
fn the_readme_is_short_and_its_number_is_that_of_the_program() {
    let readme = fs::read_to_string(root().join("README.md")).unwrap();
    assert!(readme.len() <= MAX_README, "README.md has {} bytes", readme.len());

    let cogiro = root().join("robots/cogiro.toml");
    let compared = super::succeed(&["compare", cogiro.to_str().unwrap(), "--below-hz", "5", "--format", "json"]);
    let compared: serde_json::Value = serde_json::from_str(&compared).unwrap();
    let of = |key: &str, model: &str| {
        let models = compared["models"].as_array().unwrap();
        models.iter().find(|row| row["cable_model"] == model).unwrap()[key].as_u64().unwrap()
    };
    let all = of("count_below", "catenary-dynamic");
    assert!(readme.contains(&format!("has {all} natural frequencies below 5 Hz")), "{all}");
    assert_eq!((all - of("missed", "spring"), readme.contains("finds one of them")), (1, true));
}

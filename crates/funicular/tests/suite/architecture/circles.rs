//! No circles between the files of a folder: of two files that use each other, none can be understood or changed alone.
//!
//! A file and the folder of the same name are one piece: a file may use its submodules, and they may use what it
//! defines. Between the pieces of one folder there must be no circle. A name that a file only passes on (`pub use`)
//! counts as a use of the file that defines it.

use super::code;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// Path of a module below the root of its crate; empty for the root.
type ModulePath = Vec<String>;

/// Source of every module of a crate, without comments and unit tests, and the names that it imports.
#[derive(Default)]
struct Modules {
    code: BTreeMap<ModulePath, String>,
    imports: BTreeMap<ModulePath, Vec<Import>>,
}

/// Name of a `use`.
struct Import {
    path: Vec<String>,
    /// Name in the file: the last of the path, or the one after `as`.
    name: String,
    is_public: bool,
}

/// Pieces that use each other and cannot be parted, with the reason.
const ALLOWED: [(&str, &[&str], &str); 1] = [(
    "funicular-py",
    &["analyses", "batch", "equilibrium", "robot", "vibration", "written"],
    "classes of Python return each other: `Robot.equilibrium()` is an `Equilibrium`, and `Equilibrium.robot` a `Robot`",
)];

/// Crates whose sources are read.
const CRATES: [&str; 8] = [
    "funicular",
    "funicular-study",
    "funicular-formats",
    "funicular-validation",
    "funicular-pages",
    "funicular-files",
    "funicular-cli",
    "funicular-py",
];

impl Modules {
    fn add(&mut self, path: ModulePath, source: &str) {
        let (body, imports) = parted(source);
        self.code.insert(path.clone(), body);
        self.imports.insert(path, imports);
    }

    fn of_crate(name: &str) -> Self {
        let root = super::root().join("..").join(name).join("src");
        let mut modules = Self::default();
        for file in super::sources(&root) {
            let inside = file.strip_prefix(&root).unwrap().with_extension("");
            let mut path: ModulePath = inside.iter().map(|part| part.to_str().unwrap().to_owned()).collect();
            if path == ["lib"] || path == ["main"] {
                path.clear();
            }
            modules.add(path, &code(Path::new(&file)));
        }
        assert!(modules.code.len() > 5, "{name}");
        modules
    }

    /// Path from the root of the crate; `None` for a name of another crate.
    fn absolute(&self, of: &[String], path: &[String]) -> Option<Vec<String>> {
        let ups = path.iter().take_while(|word| *word == "super").count();
        let (mut base, rest) = match path[0].as_str() {
            "crate" => (Vec::new(), &path[1..]),
            "self" => (of.to_vec(), &path[1..]),
            "super" => (of[..of.len().saturating_sub(ups)].to_vec(), &path[ups..]),
            child => {
                let inside = [of, &[child.to_owned()]].concat();
                self.code.contains_key(&inside).then_some((of.to_vec(), path))?
            }
        };
        base.extend_from_slice(rest);
        Some(base)
    }

    /// Module that defines the name at a path from the root.
    fn definition(&self, path: &[String], steps: usize) -> ModulePath {
        let depth = (0..=path.len()).rev().find(|depth| self.code.contains_key(&path[..*depth])).unwrap_or(0);
        let module = path[..depth].to_vec();
        let (Some(name), true) = (path.get(depth), steps > 0) else { return module };
        let passed_on = self.imports.get(&module).into_iter().flatten().find(|import| import.name == *name);
        match passed_on.and_then(|import| self.absolute(&module, &import.path)) {
            Some(further) if further != path => self.definition(&[&further, &path[depth + 1..]].concat(), steps - 1),
            _ => module,
        }
    }

    /// Modules whose definitions a module uses.
    fn used_by(&self, module: &[String]) -> BTreeSet<ModulePath> {
        /// Maximum number of files that pass a name on.
        const MAX_STEPS: usize = 8;

        let body = &self.code[module];
        let mut used = BTreeSet::new();
        for import in &self.imports[module] {
            let Some(path) = self.absolute(module, &import.path) else { continue };
            if self.code.contains_key(&path) {
                // A module under its name: the paths that begin with it.
                for tail in paths_in(body).filter(|words| words[0] == import.name) {
                    used.insert(self.definition(&[&path, &tail[1..]].concat(), MAX_STEPS));
                }
            } else if !import.is_public || is_named(body, &import.name) {
                used.insert(self.definition(&path, MAX_STEPS));
            }
        }
        for words in paths_in(body) {
            if let Some(path) = self.absolute(module, &words) {
                used.insert(self.definition(&path, MAX_STEPS));
            }
        }
        used
    }

    /// Circle between the pieces of one folder, as the names of the pieces; `None` if there is none.
    fn circle(&self, allowed: &[&str]) -> Option<Vec<String>> {
        let mut uses: BTreeMap<ModulePath, BTreeSet<ModulePath>> = BTreeMap::new();
        for module in self.code.keys() {
            for other in self.used_by(module) {
                // The pieces are the two paths up to where they part; one within the other is one piece.
                let same = module.iter().zip(&other).take_while(|(a, b)| a == b).count();
                if same < module.len().min(other.len()) {
                    uses.entry(module[..=same].to_vec()).or_default().insert(other[..=same].to_vec());
                }
            }
        }

        let is_allowed = |piece: &ModulePath| piece.len() == 1 && allowed.contains(&piece[0].as_str());
        let pieces: Vec<ModulePath> = uses.keys().filter(|piece| !is_allowed(piece)).cloned().collect();
        pieces.iter().find_map(|piece| circle_from(piece, &uses))
    }
}

/// Shortest way from a piece back to itself.
fn circle_from(piece: &ModulePath, uses: &BTreeMap<ModulePath, BTreeSet<ModulePath>>) -> Option<Vec<String>> {
    let (mut ways, mut seen) = (vec![vec![piece]], BTreeSet::new());
    while !ways.is_empty() {
        let mut longer = Vec::new();
        for way in ways {
            for next in uses.get(*way.last()?).into_iter().flatten() {
                if next == piece {
                    return Some(way.iter().chain([&piece]).map(|path| path.join("/")).collect());
                }
                if seen.insert(next) {
                    longer.push([way.as_slice(), &[next]].concat());
                }
            }
        }
        ways = longer;
    }
    None
}

/// Source without its `use` declarations, and the names that these import.
fn parted(source: &str) -> (String, Vec<Import>) {
    let (mut body, mut imports, mut declaration) = (String::new(), Vec::new(), None::<String>);
    for line in source.lines() {
        let trimmed = line.trim_start();
        let begins =
            ["use ", "pub use ", "pub(crate) use ", "pub(super) use "].iter().any(|how| trimmed.starts_with(how));
        if begins && declaration.is_none() {
            declaration = Some(String::new());
        }
        let Some(text) = &mut declaration else {
            body.push_str(line);
            body.push('\n');
            continue;
        };
        text.push_str(trimmed);
        if let Some((text, _)) = text.split_once(';') {
            let (how, tree) = text.split_once("use ").unwrap();
            let is_public = how.starts_with("pub");
            imports.extend(expanded(tree).into_iter().map(|(path, name)| Import { path, name, is_public }));
            declaration = None;
        }
    }
    (body, imports)
}

/// Every path of a `use` tree, and its name in the file.
fn expanded(tree: &str) -> Vec<(Vec<String>, String)> {
    let tree = tree.trim();
    if let Some((before, inside)) = tree.split_once('{') {
        let base: Vec<String> =
            before.split("::").map(str::trim).filter(|w| !w.is_empty()).map(str::to_owned).collect();
        let inside = &inside[..inside.rfind('}').unwrap()];
        let branches = at_top_level(inside).into_iter().flat_map(|branch| expanded(&branch));
        return branches
            .map(|(path, name)| match path.as_slice() {
                [only] if only == "self" => (base.clone(), base.last().unwrap().clone()),
                _ => ([base.clone(), path].concat(), name),
            })
            .collect();
    }
    let (path, renamed) = tree.split_once(" as ").map_or((tree, None), |(path, name)| (path, Some(name.trim())));
    let path: Vec<String> = path.split("::").map(|word| word.trim().to_owned()).collect();
    let name = renamed.unwrap_or(path.last().unwrap()).to_owned();
    vec![(path, name)]
}

/// Parts of a list between the commas that are not inside braces.
fn at_top_level(list: &str) -> Vec<String> {
    let (mut parts, mut depth) = (vec![String::new()], 0);
    for c in list.chars() {
        match c {
            '{' => depth += 1,
            '}' => depth -= 1,
            _ => {}
        }
        if c == ',' && depth == 0 { parts.push(String::new()) } else { parts.last_mut().unwrap().push(c) }
    }
    parts.into_iter().filter(|part| !part.trim().is_empty()).collect()
}

fn is_word(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

/// True if a text has the word.
fn is_named(text: &str, word: &str) -> bool {
    text.split(|c| !is_word(c)).any(|other| other == word)
}

/// Paths of two words and more in a text.
fn paths_in(text: &str) -> impl Iterator<Item = Vec<String>> {
    let paths = text.split(|c| !is_word(c) && c != ':').filter(|path| path.contains("::"));
    let words =
        paths.map(|path| path.split(':').filter(|word| !word.is_empty()).map(str::to_owned).collect::<Vec<_>>());
    words.filter(|words| words.len() > 1)
}

#[test]
fn circles_are_found_through_names_passed_on_and_not_between_a_file_and_its_folder() {
    let of = |sources: &[(&str, &str)]| {
        let mut modules = Modules::default();
        for (path, source) in sources {
            modules.add(path.split('/').filter(|word| !word.is_empty()).map(str::to_owned).collect(), source);
        }
        modules.circle(&[])
    };
    let first = ("a", "use crate::b::{self, Other as Renamed};\nfn f() { b::g() }");
    assert_eq!(of(&[("", ""), first, ("b", "pub fn g() {}")]), None);
    let circle = Some(["a", "b", "a"].map(str::to_owned).to_vec());
    assert_eq!(of(&[("", ""), first, ("b", "fn g() -> crate::a::f {}")]), circle);
    assert_eq!(of(&[("", ""), first, ("b", "use super::{\n    c::{X, a_name},\n    a::f,\n};")]), circle);
    // The root passes on what `a` defines.
    assert_eq!(of(&[("", "pub use a::Thing;"), first, ("b", "use crate::Thing;")]), circle);
    // A file and the files in its folder are one piece, also in a circle with another.
    let folder = [("c", "mod d;\nuse d::x;\nfn y() { d::z() }"), ("c/d", "use super::y;")];
    assert_eq!(of(&[("", ""), folder[0], folder[1]]), None);
    let outside = ("e", "use crate::c::y;");
    assert_eq!(of(&[("", ""), folder[0], ("c/d", "use crate::e::x;"), outside]).unwrap().join(" "), "c e c");
}

#[test]
fn no_files_of_a_folder_use_each_other_in_a_circle() {
    for name in CRATES {
        let allowed = ALLOWED.iter().find(|(of, ..)| *of == name).map_or(&[][..], |(_, pieces, _)| pieces);
        let modules = Modules::of_crate(name);
        let circle = modules.circle(allowed);
        assert_eq!(
            circle, None,
            "{name}: move the type or the function that both need to the lower one, or below both"
        );
        // An exception that is no longer needed is removed.
        assert!(allowed.is_empty() || modules.circle(&[]).is_some(), "{name} needs no exception");
    }
}

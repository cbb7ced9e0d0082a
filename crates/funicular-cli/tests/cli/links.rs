//! Links of the documents lead somewhere, and a list of contents names the headings that there are.

use std::collections::{HashMap, HashSet};
use std::fs;
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// The documents that people read at GitHub.
fn documents() -> Vec<PathBuf> {
    let mut documents: Vec<PathBuf> =
        ["README.md", "ARCHITECTURE.md", "DESIGN.md", "CONTRIBUTING.md"].iter().map(|name| root().join(name)).collect();
    let folders = ["docs", "docs/tutorials"].map(|folder| fs::read_dir(root().join(folder)).unwrap());
    let in_docs = folders.into_iter().flatten().map(|entry| entry.unwrap().path());
    documents.extend(in_docs.filter(|path| path.extension().is_some_and(|extension| extension == "md")));
    documents
}

/// Lines of a document outside fenced blocks, with their numbers.
fn prose(text: &str) -> Vec<(usize, &str)> {
    let mut fenced = false;
    let outside = |(_, line): &(usize, &str)| {
        let fence = line.trim_start().starts_with("```");
        fenced ^= fence;
        !fenced && !fence
    };
    text.lines().zip(1..).map(|(line, number)| (number, line)).filter(outside).collect()
}

/// Headings with their level.
fn headings(text: &str) -> Vec<(usize, &str)> {
    let heading = |line: &'_ str| line.chars().take_while(|c| *c == '#').count();
    prose(text)
        .into_iter()
        .map(|(_, line)| (heading(line), line))
        .filter(|(level, line)| (1..=6).contains(level) && line[*level..].starts_with(' '))
        .map(|(level, line)| (level, line[level..].trim()))
        .collect()
}

/// The anchor of a heading at GitHub: small letters, blanks as hyphens, no other signs than letters, digits, `-` and
/// `_`.
fn anchor(heading: &str) -> String {
    let small = heading.to_lowercase();
    small
        .chars()
        .filter(|c| c.is_alphanumeric() || matches!(c, ' ' | '-' | '_'))
        .map(|c| if c == ' ' { '-' } else { c })
        .collect()
}

/// All anchors of a document; equal headings are numbered from the second on.
fn anchors(text: &str) -> HashSet<String> {
    let mut seen: HashMap<String, usize> = HashMap::new();
    let mut all = HashSet::new();
    for (_, heading) in headings(text) {
        let name = anchor(heading);
        let times = seen.entry(name.clone()).or_insert(0);
        all.insert(if *times == 0 { name } else { format!("{name}-{times}") });
        *times += 1;
    }
    all
}

/// Targets of `[…](target)` and of `src="target"`, `href="target"`, with the line they stand in; code between backticks
/// is none.
fn links(text: &str) -> Vec<(usize, String)> {
    let mut found = Vec::new();
    for (number, line) in prose(text) {
        let plain: String = line.split('`').step_by(2).collect::<Vec<_>>().join("`");
        for (open, close) in [("](", ')'), ("src=\"", '"'), ("href=\"", '"')] {
            for after in plain.split(open).skip(1) {
                let target = after.split(close).next().unwrap_or_default();
                found.push((number, target.split(' ').next().unwrap_or_default().to_owned()));
            }
        }
    }
    found
}

/// Errors in the links of a document.
fn dead_links(path: &Path, text: &str) -> Vec<String> {
    let mut dead = Vec::new();
    for (line, target) in links(text) {
        if target.contains("://") || target.starts_with("mailto:") {
            continue;
        }
        let (file, fragment) =
            target.split_once('#').map_or((target.as_str(), None), |(file, part)| (file, Some(part)));
        let aim = if file.is_empty() { path.to_owned() } else { path.parent().unwrap().join(file) };
        let there = match (aim.exists(), fragment) {
            (exists, None) => exists,
            (false, Some(_)) => false,
            (true, Some(_)) if aim == path => anchors(text).contains(fragment.unwrap_or_default()),
            (true, Some(part)) => fs::read_to_string(&aim).is_ok_and(|text| anchors(&text).contains(part)),
        };
        if !there {
            dead.push(format!("{}:{line}: {target}", path.display()));
        }
    }
    dead
}

#[test]
fn every_link_of_the_documents_leads_somewhere() {
    let (mut dead, mut count) = (Vec::new(), 0);
    for path in documents() {
        let text = fs::read_to_string(&path).unwrap();
        count += links(&text).len();
        dead.extend(dead_links(&path, &text));
    }
    assert!(dead.is_empty(), "dead links:\n{}", dead.join("\n"));
    assert!(count >= 40, "the documents have some fifty links, of which these were seen: {count}");
}

#[test]
fn the_contents_of_the_theory_are_its_headings() {
    let text = fs::read_to_string(root().join("docs/theory.md")).unwrap();
    let (_, after) = text.split_once("Contents:\n").expect("a list of contents");
    let (contents, _) = after.split_once("\n\n").expect("the list ends");
    let listed: Vec<(String, String)> = contents
        .split('·')
        .map(|entry| entry.trim().strip_prefix('[').and_then(|entry| entry.strip_suffix(')')).expect("a link"))
        .map(|entry| entry.split_once("](#").expect("a link within the document"))
        .map(|(title, target)| (title.to_owned(), target.to_owned()))
        .collect();
    let sections: Vec<(String, String)> = headings(&text)
        .into_iter()
        .filter(|(level, _)| *level == 2)
        .map(|(_, title)| (title.to_owned(), anchor(title)))
        .collect();
    assert_eq!(listed, sections);
    assert!(sections.len() > 10);
}

/// The test itself: what it has to find, and what it must not.
#[test]
fn anchors_are_those_of_github_and_dead_links_are_found() {
    assert_eq!(anchor("14 Degrees of freedom, few cables and loads"), "14-degrees-of-freedom-few-cables-and-loads");
    assert_eq!(anchor("Why pulp, and not `wide` or intrinsics?"), "why-pulp-and-not-wide-or-intrinsics");
    let text = "# A\n## B c\n## B c\n```\n# none\n[x](none.md)\n```\n`[y](none.md)` [1](#b-c-1) [2](#b-c-2) \
                [3](none.md) [4](https://example.org/#x) [5](README.md#a)\n[6](CITATION.cff)";
    assert_eq!(anchors(text), ["a", "b-c", "b-c-1"].map(str::to_owned).into());
    let path = root().join("DESIGN.md");
    let dead: Vec<String> = dead_links(&path, text).iter().map(|d| d.rsplit(' ').next().unwrap().to_owned()).collect();
    assert_eq!(dead, ["#b-c-2", "none.md", "README.md#a"]);
}

//! JSON and YAML as a tree of values that know their line, with errors that name file, line and key.

use super::text;
use anyhow::{Result, anyhow, bail};
use funicular::math::{Mat3, Vec3};
use funicular_study::request::SourceFile;
use funicular_study::text::clean;
use saphyr_parser::{Event, Parser, ScalarStyle};

/// Largest depth of values within values; robots have five.
const MAX_DEPTH: usize = 64;
/// Largest number of values; a robot with 100 cables has about 3000.
const MAX_VALUES: usize = 1_000_000;

/// Value of a file with the line on which it begins.
#[derive(Debug)]
pub(crate) struct Tree {
    line: usize,
    kind: TreeKind,
}

#[derive(Debug)]
enum TreeKind {
    /// Text, number or word; true if it stood in quotes.
    Scalar(String, bool),
    List(Vec<Tree>),
    /// Keys with their values, in the order of the file.
    Map(Vec<(String, Tree)>),
}

/// Value of a tree together with its file and its path of keys.
#[derive(Clone)]
pub(crate) struct Place<'a> {
    file: &'a SourceFile,
    tree: &'a Tree,
    path: String,
}

/// Reads the only document of a file of YAML, or of JSON, which YAML contains.
///
/// # Errors
/// The line of the fault.
pub(crate) fn parse(file: &SourceFile) -> Result<Tree> {
    let fault = |line: usize, reason: &str| anyhow!("{}:{line}: the file is not well-formed YAML: {reason}", file.path);
    // Tabs between the values of JSON are white space, which this reader of YAML takes for indentation.
    let is_json = file.text.trim_start().starts_with('{');
    let text = if is_json { file.text.replace('\t', " ") } else { file.text.clone() };

    let mut open: Vec<Tree> = Vec::new();
    let mut keys: Vec<Option<String>> = Vec::new();
    let mut root: Option<Tree> = None;
    let mut count = 0;
    for event in Parser::new_from_str(&text) {
        let (event, span) = event.map_err(|error| fault(error.marker().line(), error.info()))?;
        let line = span.start.line();
        count += 1;
        if count > MAX_VALUES || open.len() > MAX_DEPTH {
            bail!(fault(line, "it has too many values, or values too deep in values"));
        }

        let made = match event {
            Event::Scalar(value, style, ..) => {
                let kind = TreeKind::Scalar(value.into_owned(), style != ScalarStyle::Plain);
                Some(Tree { line, kind })
            }
            Event::SequenceStart(..) | Event::MappingStart(..) => {
                let is_list = matches!(event, Event::SequenceStart(..));
                let kind = if is_list { TreeKind::List(Vec::new()) } else { TreeKind::Map(Vec::new()) };
                open.push(Tree { line, kind });
                keys.push(None);
                None
            }
            Event::SequenceEnd | Event::MappingEnd => {
                keys.pop();
                open.pop()
            }
            Event::Alias(_) => bail!(fault(line, "it has aliases (`*name`), which are not read; write the values out")),
            Event::DocumentStart(_) if root.is_some() => bail!(fault(line, "it has a second document (`---`)")),
            _ => None,
        };

        let Some(made) = made else { continue };
        match (open.last_mut().map(|tree| &mut tree.kind), keys.last_mut()) {
            (Some(TreeKind::List(items)), _) => items.push(made),
            (Some(TreeKind::Map(entries)), Some(key)) => match key.take() {
                Some(key) => {
                    if entries.iter().any(|(known, _)| *known == key) {
                        bail!(fault(line, &format!("the key `{}` is there twice", clean(&key))));
                    }
                    entries.push((key, made));
                }
                None => match made.kind {
                    TreeKind::Scalar(text, _) => *key = Some(text),
                    _ => bail!(fault(line, "a key is a list or a table")),
                },
            },
            _ => root = Some(made),
        }
    }
    root.ok_or_else(|| anyhow!("{}: the file is empty", file.path))
}

impl Tree {
    /// True if the tree is a table that has all of these keys.
    pub(crate) fn has(&self, keys: &[&str]) -> bool {
        keys.iter().all(|key| self.get(key).is_some())
    }

    fn get(&self, key: &str) -> Option<&Tree> {
        let TreeKind::Map(entries) = &self.kind else { return None };
        entries.iter().find(|(known, _)| known == key).map(|(_, tree)| tree)
    }
}

impl<'a> Place<'a> {
    /// Place of the outermost value of a file.
    pub(crate) fn of(file: &'a SourceFile, tree: &'a Tree) -> Self {
        Self { file, tree, path: String::new() }
    }

    /// `file:line` of the value.
    pub(crate) fn place(&self) -> String {
        format!("{}:{}", self.file.path, self.tree.line)
    }

    /// Error located at the value.
    pub(crate) fn error(&self, message: impl std::fmt::Display) -> anyhow::Error {
        anyhow!("{}: {message}", self.place())
    }

    fn named(&self) -> String {
        if self.path.is_empty() { "the file".to_owned() } else { format!("`{}`", clean(&self.path)) }
    }

    /// Value of a key, or `None` if it is absent or empty.
    pub(crate) fn optional(&self, key: &str) -> Result<Option<Self>> {
        if !matches!(self.tree.kind, TreeKind::Map(_)) {
            bail!(self.error(format!("{} must be a table with keys such as `{key}`", self.named())));
        }
        let path = if self.path.is_empty() { key.to_owned() } else { format!("{}.{key}", self.path) };
        let found = self.tree.get(key).filter(|tree| !tree.is_empty());
        Ok(found.map(|tree| Self { file: self.file, tree, path }))
    }

    /// Value of a key.
    pub(crate) fn required(&self, key: &str) -> Result<Self> {
        self.optional(key)?.ok_or_else(|| self.error(format!("{} has no `{key}`", self.named())))
    }

    /// Items of a list, each with its number from 1 in its path.
    pub(crate) fn items(&self) -> Result<Vec<Self>> {
        let TreeKind::List(items) = &self.tree.kind else {
            bail!(self.error(format!("{} must be a list", self.named())));
        };
        let item = |(i, tree)| Self { file: self.file, tree, path: format!("{}[{}]", self.path, i + 1) };
        Ok(items.iter().enumerate().map(item).collect())
    }

    /// Text of a value.
    pub(crate) fn text(&self) -> Result<&'a str> {
        match &self.tree.kind {
            TreeKind::Scalar(text, _) => Ok(text),
            _ => Err(self.error(format!("{} must be one word or number", self.named()))),
        }
    }

    /// Number of a value.
    pub(crate) fn number(&self) -> Result<f64> {
        let text = self.text()?;
        text::number(text).map_err(|wrong| self.error(format!("{} is {wrong}", self.named())))
    }

    /// Number of a key, or `None` if it is absent.
    pub(crate) fn optional_number(&self, key: &str) -> Result<Option<f64>> {
        self.optional(key)?.map(|value| value.number()).transpose()
    }

    /// Truth of a value.
    pub(crate) fn truth(&self) -> Result<bool> {
        match self.text()? {
            "true" | "True" | "1" => Ok(true),
            "false" | "False" | "0" => Ok(false),
            other => Err(self.error(format!("{} is `{}`, it must be true or false", self.named(), clean(other)))),
        }
    }

    /// Numbers of a list. Items may be lists of one number, as a column vector is written.
    pub(crate) fn numbers(&self) -> Result<Vec<f64>> {
        let one = |item: Self| match &item.tree.kind {
            TreeKind::List(inner) if inner.len() == 1 => item.items()?[0].number(),
            _ => item.number(),
        };
        self.items()?.into_iter().map(one).collect()
    }

    /// Three numbers.
    pub(crate) fn vector(&self) -> Result<Vec3> {
        let numbers = self.numbers()?;
        match numbers[..] {
            [x, y, z] => Ok(Vec3::new(x, y, z)),
            _ => Err(self.error(format!("{} holds {} numbers; it must hold three", self.named(), numbers.len()))),
        }
    }

    /// Three rows of three numbers.
    pub(crate) fn matrix(&self) -> Result<Mat3> {
        let rows = self.items()?.iter().map(Self::vector).collect::<Result<Vec<_>>>()?;
        match rows[..] {
            [a, b, c] => Ok(Mat3::from_rows(&[a.transpose(), b.transpose(), c.transpose()])),
            _ => Err(self.error(format!("{} holds {} rows; it must hold three", self.named(), rows.len()))),
        }
    }
}

impl Tree {
    /// True for `null` and for a key without a value.
    fn is_empty(&self) -> bool {
        matches!(&self.kind, TreeKind::Scalar(text, false) if matches!(text.as_str(), "" | "~" | "null"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(text: &str) -> SourceFile {
        SourceFile::decode("a.yaml".to_owned(), text.as_bytes()).unwrap()
    }

    #[test]
    fn json_and_yaml_are_one_tree_with_lines() {
        for text in ["a:\n  b: [1, 2,\n    3]\n  c: ~\n", "{\n\t\"a\":\n\t{\"b\": [[1], [2], [3]], \"c\": null}}"] {
            let file = file(text);
            let tree = parse(&file).unwrap();
            let a = Place::of(&file, &tree).required("a").unwrap();
            assert_eq!(a.required("b").unwrap().vector().unwrap(), Vec3::new(1.0, 2.0, 3.0));
            assert!(a.optional("c").unwrap().is_none());
            assert!(a.required("d").err().unwrap().to_string().ends_with("`a` has no `d`"));
        }
    }

    #[test]
    fn what_is_not_a_robot_is_refused_with_its_line() {
        for (text, expected) in [
            ("", "the file is empty"),
            ("a: [1, 2", "not well-formed"),
            ("a: &x [1]\nb: *x\n", "a.yaml:2: the file is not well-formed YAML: it has aliases"),
            ("a: 1\na: 2\n", "a.yaml:2: the file is not well-formed YAML: the key `a` is there twice"),
            ("a: 1\n---\nb: 1\n", "second document"),
            (&"[".repeat(2000), "recursion limit"),
        ] {
            let told = parse(&file(text)).unwrap_err().to_string();
            assert!(told.contains(expected), "{text:.20}: {told}");
        }
        let file = file("a: [1, x, 3]\n");
        let tree = parse(&file).unwrap();
        let told = Place::of(&file, &tree).required("a").unwrap().vector().unwrap_err().to_string();
        assert_eq!(told, "a.yaml:1: `a[2]` is `x`, which is not a number");
    }
}

//! Issues of a robot file: problem, place and remedy.

use crate::suggest::shown;
use annotate_snippets::{AnnotationKind, Level, Renderer, Snippet};
use std::fmt;
use std::ops::Range;

/// Maximum number of issues that [`SpecError::render`] shows. More issues usually have one cause, and it is among the
/// first.
const SHOWN: usize = 20;

/// Robot file that cannot be used: one or more issues, in file order.
///
/// [`Display`](fmt::Display) gives one line per issue; [`render`](Self::render) shows the lines of the file.
///
/// # Example
///
/// ```
/// use funicular::robot::Robot;
///
/// let text = "name = 'a'\ngravity_m_s2 = [0, 0, down]\n";
/// let error = Robot::from_toml(text).unwrap_err();
/// assert!(error.to_string().starts_with("line 2, column 23: the file is not valid TOML"));
/// assert!(error.render("a.toml", text, false).contains("2 | gravity_m_s2 = [0, 0, down]"));
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SpecError {
    issues: Vec<Issue>,
}

/// Problem of a robot file, and its place.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Issue {
    /// Range of bytes of the text that the issue refers to.
    pub span: Range<usize>,
    /// Line of the first of these bytes, from 1.
    pub line: usize,
    /// Column of the first of these bytes, in characters from 1.
    pub column: usize,
    /// Message: the value and the limit.
    pub message: String,
    /// Remedy.
    pub help: Option<String>,
    /// Second place that belongs to the issue, with a label.
    pub context: Option<(Range<usize>, String)>,
}

impl Issue {
    /// Issue whose line and column [`SpecError::new`] fills in.
    pub(super) fn new(span: Range<usize>, message: impl Into<String>) -> Self {
        Self { span, line: 1, column: 1, message: shown(&message.into()), help: None, context: None }
    }

    /// Adds the remedy.
    pub(super) fn help(&mut self, help: impl Into<String>) -> &mut Self {
        self.help = Some(shown(&help.into()));
        self
    }

    /// Adds a second place.
    pub(super) fn context(&mut self, span: Range<usize>, label: impl Into<String>) -> &mut Self {
        self.context = Some((span, shown(&label.into())));
        self
    }
}

impl SpecError {
    /// Sorts the issues by place and finds lines and columns.
    pub(super) fn new(text: &str, mut issues: Vec<Issue>) -> Self {
        assert!(!issues.is_empty(), "a refused file has a reason");
        issues.sort_by_key(|issue| issue.span.start);
        let lines = Lines::of(text);
        for issue in &mut issues {
            (issue.line, issue.column) = lines.place(issue.span.start);
        }
        Self { issues }
    }

    /// Issues in file order; at least one.
    pub fn issues(&self) -> &[Issue] {
        &self.issues
    }

    /// Issues with the lines of the file they point at, several lines per issue; at most 20 issues.
    ///
    /// `text` is the text that was read. `color` adds ANSI colours.
    ///
    /// # Example
    ///
    /// ```
    /// use funicular::robot::Robot;
    ///
    /// let text = "name = 3\n";
    /// let shown = Robot::from_toml(text).unwrap_err().render("a.toml", text, false);
    /// assert!(shown.contains("a.toml:1:8"));
    /// assert!(shown.contains("1 | name = 3"));
    /// assert!(shown.contains("  |        ^"));
    /// ```
    pub fn render(&self, file_name: &str, text: &str, color: bool) -> String {
        let renderer = if color { Renderer::styled() } else { Renderer::plain() };
        let file_name = shown(file_name);
        let (shown_text, mark) = without_mark(text);
        let place = |span: &Range<usize>| {
            let start = boundary(shown_text, span.start.saturating_sub(mark));
            start..boundary(shown_text, span.end.saturating_sub(mark)).max(start)
        };

        let mut rendered: Vec<String> = Vec::new();
        for issue in self.issues.iter().take(SHOWN) {
            let mut snippet = Snippet::source(shown_text)
                .path(file_name.as_str())
                .annotation(AnnotationKind::Primary.span(place(&issue.span)));
            if let Some((span, label)) = &issue.context {
                snippet = snippet.annotation(AnnotationKind::Context.span(place(span)).label(label.as_str()));
            }
            let mut group = Level::ERROR.primary_title(issue.message.as_str()).element(snippet);
            if let Some(help) = &issue.help {
                group = group.element(Level::HELP.message(help.as_str()));
            }
            rendered.push(renderer.render(&[group]));
        }

        if let Some(more) = self.issues.len().checked_sub(SHOWN).filter(|more| *more > 0) {
            rendered.push(format!("and {more} more"));
        }
        rendered.join("\n\n")
    }
}

impl fmt::Display for SpecError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, issue) in self.issues.iter().enumerate() {
            let end_of_last = if i > 0 { "\n" } else { "" };
            write!(f, "{end_of_last}line {}, column {}: {}", issue.line, issue.column, issue.message)?;
        }
        Ok(())
    }
}

impl std::error::Error for SpecError {}

/// Text without its byte-order mark, and the number of bytes removed: an editor counts columns without the mark.
fn without_mark(text: &str) -> (&str, usize) {
    let rest = text.strip_prefix('\u{feff}').unwrap_or(text);
    (rest, text.len() - rest.len())
}

/// Nearest character boundary of the text at or before `byte`.
fn boundary(text: &str, byte: usize) -> usize {
    let mut byte = byte.min(text.len());
    while !text.is_char_boundary(byte) {
        byte -= 1; // ends: 0 is a boundary
    }
    byte
}

/// Starts of the lines of a text.
struct Lines<'t> {
    text: &'t str,
    mark: usize,
    starts: Vec<usize>,
}

impl<'t> Lines<'t> {
    fn of(text: &'t str) -> Self {
        let (text, mark) = without_mark(text);
        let starts = std::iter::once(0).chain(text.match_indices('\n').map(|(at, _)| at + 1)).collect();
        Self { text, mark, starts }
    }

    /// Line and column of a byte, in characters from 1.
    fn place(&self, byte: usize) -> (usize, usize) {
        let byte = boundary(self.text, byte.saturating_sub(self.mark));
        // At least 1: the first line begins at 0.
        let line = self.starts.partition_point(|start| *start <= byte);
        (line, self.text[self.starts[line - 1]..byte].chars().count() + 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_count_characters_and_not_the_mark() {
        let text = "\u{feff}é = 1\r\nb = 漢字!";
        let place = |byte| Lines::of(text).place(byte);
        let at = |s: &str| place(text.find(s).unwrap());
        assert_eq!(at("é"), (1, 1));
        assert_eq!(at("="), (1, 3));
        assert_eq!(at("b"), (2, 1));
        assert_eq!(at("!"), (2, 7));
        assert_eq!(place(0), (1, 1));
        assert_eq!(place(1000), (2, 8));
    }

    #[test]
    fn the_caret_stands_under_the_value_and_the_help_follows() {
        let text = "\u{feff}a = 1\r\nb = -22\r\n";
        let mut issue = Issue::new(14..17, "`b` is -22, it must be positive");
        issue.help("write 22").context(3..4, "see here");
        let shown = SpecError::new(text, vec![issue]).render("x.toml", text, false);
        let expected = "\
error: `b` is -22, it must be positive
 --> x.toml:2:5
  |
1 | a = 1
  | - see here
2 | b = -22
  |     ^^^
  |
  = help: write 22";
        assert_eq!(shown, expected);
    }

    #[test]
    fn many_issues_are_cut_and_counted() {
        let issues = (0..SHOWN + 3).map(|i| Issue::new(i..i, format!("issue {i}"))).collect();
        let error = SpecError::new("a = 1", issues);
        assert!(error.render("x.toml", "a = 1", false).ends_with("\n\nand 3 more"));
        assert_eq!(error.issues().len(), SHOWN + 3);
    }

    #[test]
    fn colour_is_there_only_when_asked_for() {
        let error = SpecError::new("a", vec![Issue::new(0..1, "no")]);
        assert!(error.render("x.toml", "a", true).contains('\u{1b}'));
        assert!(!error.render("x.toml", "a", false).contains('\u{1b}'));
    }
}

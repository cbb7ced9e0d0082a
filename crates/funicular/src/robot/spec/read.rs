//! Reading single values: types, signs and sizes, names, known keys. Every message points at the value.

use super::key::{Absent, Key, KeyValue, Numeric};
use super::range::{MAX_MAGNITUDE, MIN_POSITIVE, Range as Limits};
use super::{Issue, TABLES};
use crate::suggest::{is_hidden, nearest};
use std::collections::BTreeMap;
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// Maximum number of characters of the user's text that a message repeats.
const QUOTED: usize = 40;

/// Name of the file's top level in messages.
pub(in crate::robot) const TOP: &str = "the top of the file";

/// Remedy for a number with a decimal comma.
pub(super) const DECIMAL_POINT: &str = "write numbers with a decimal point, not a comma: 60.0";

/// Value with its place.
pub(super) type Value<'t> = Spanned<DeValue<'t>>;

/// Key of this name in a table of keys that contains it.
pub(super) fn known(keys: &'static [Key], name: &str) -> &'static Key {
    keys.iter().find(|key| key.name == name).expect("the reader asks for keys of its tables only")
}

/// Values of tables with names of the user's choice, by name; `None` for a refused table, whose name is still known.
pub(super) type Named<T> = BTreeMap<String, Option<T>>;

/// Table with checked keys.
pub(super) struct Section<'t> {
    label: String,
    /// Place of its header, to report missing keys.
    pub span: Range<usize>,
    table: &'t DeTable<'t>,
    keys: &'static [Key],
    /// Known keys that unknown ones were probably meant to be: reported once as unknown, and not again as missing.
    mistyped: Vec<&'static str>,
}

impl<'t> Section<'t> {
    /// Value of a key.
    pub(super) fn get(&self, key: &str) -> Option<&'t Value<'t>> {
        self.table.get(key)
    }

    /// True if an unknown key was probably meant to be one of these.
    pub(super) fn mistyped(&self, keys: &[&str]) -> bool {
        self.mistyped.iter().any(|key| keys.contains(key))
    }

    /// Unit, range and meaning of a key that holds numbers.
    pub(super) fn number(&self, key: &str) -> &'static Numeric {
        known(self.keys, key).numbers()
    }

    /// Default numbers of a key that has them.
    pub(super) fn default(&self, key: &str) -> [f64; 3] {
        known(self.keys, key).default_numbers().expect("the reader asks for defaults of keys that have one")
    }

    /// Line of a robot file with a key.
    pub(super) fn example(&self, key: &str) -> &'static str {
        known(self.keys, key).example
    }

    /// Name of the table in messages.
    pub(super) fn label(&self) -> &str {
        &self.label
    }
}

/// Numbers of a text, kept beside its tree so that they can be replaced.
#[derive(Debug, Clone, Copy, Default)]
pub(in crate::robot) struct Numbers<'t> {
    /// First byte of each number in the text, in ascending order, with the number. Empty if the tree itself holds the
    /// numbers.
    pub values: &'t [(usize, f64)],
    /// First bytes of the numbers that replace those of the text.
    pub changed: &'t [usize],
}

/// Reader of a robot file, which collects the issues.
///
/// A method returns `None` if and only if it has reported an issue.
pub(super) struct Reader<'t> {
    text: &'t str,
    /// Numbers that replace those of the text.
    numbers: Numbers<'t>,
    /// Issues found so far.
    pub issues: Vec<Issue>,
}

impl<'t> Reader<'t> {
    pub(super) fn new(text: &'t str) -> Self {
        Self::with(text, Numbers::default())
    }

    /// Reader with numbers beside the tree.
    pub(super) fn with(text: &'t str, numbers: Numbers<'t>) -> Self {
        Self { text, numbers, issues: Vec::new() }
    }

    /// Number beside the tree at a place of the text.
    fn beside(&self, span: &Range<usize>) -> Option<f64> {
        let values = self.numbers.values;
        values.binary_search_by_key(&span.start, |(start, _)| *start).ok().map(|at| values[at].1)
    }

    /// Reports an issue; help and context can be added to the returned reference.
    pub(super) fn issue(&mut self, span: Range<usize>, message: impl Into<String>) -> &mut Issue {
        let at = self.issues.len();
        self.issues.push(Issue::new(span, message));
        &mut self.issues[at]
    }

    /// Text that the user wrote there, short enough for a message.
    pub(super) fn written(&self, span: Range<usize>) -> String {
        if let Some(number) = self.beside(&span).filter(|_| self.numbers.changed.contains(&span.start)) {
            // In TOML notation.
            let whole = if number % 1.0 == 0.0 { ".0" } else { "" };
            return shortened(&format!("{number}{whole}").to_lowercase());
        }
        shortened(self.text.get(span).unwrap_or("?").trim())
    }

    /// Checks the keys of a table and reports unknown ones.
    pub(super) fn open<'v>(
        &mut self,
        label: impl Into<String>,
        span: Range<usize>,
        table: &'v DeTable<'v>,
        keys: &'static [Key],
    ) -> Section<'v> {
        let label = label.into();
        let mut mistyped = Vec::new();

        for key in table.keys() {
            let name: &str = key.get_ref();
            if keys.iter().any(|known| known.name == name) {
                continue;
            }
            let message = format!("unknown key `{}` {}", shortened(name), inside(&label));
            let all = keys.iter().map(|k| format!("`{}`", k.name)).collect::<Vec<_>>().join(", ");
            let home = TABLES.iter().find(|table| table.keys.iter().any(|k| k.name == name)).map(|table| table.header);
            let help = if let Some(home) = home {
                format!("`{name}` belongs {}; keys here are {all}", inside(home))
            } else if let Some(near) = nearest(name, keys.iter().map(|k| k.name)) {
                mistyped.push(near);
                format!("did you mean `{near}`? keys here are {all}")
            } else {
                format!("keys here are {all}")
            };
            self.issue(key.span(), message).help(help);
        }

        Section { label, span, table, keys, mistyped }
    }

    /// Value of a required key.
    pub(super) fn required<'v>(&mut self, section: &Section<'v>, key: &str) -> Option<&'v Value<'v>> {
        let value = section.get(key);
        if value.is_none() && !section.mistyped(&[key]) {
            let owner = if section.label == TOP { "the file" } else { section.label() };
            let issue = self.issue(section.span.clone(), format!("{owner} has no `{key}`"));
            if let Some(known) = section.keys.iter().find(|known| known.name == key) {
                issue.help(format!("add it, for example `{}`", known.example));
            }
        }
        value
    }

    /// Reports a value of the wrong type.
    pub(super) fn wrong_type(&mut self, label: &str, needed: &str, value: &Value) -> &mut Issue {
        let given = a_type(value.get_ref());
        self.issue(value.span(), format!("{label} is {given}, it must be {needed}"))
    }

    /// Number of a key, within the range given by the table of keys.
    pub(super) fn number_of(&mut self, section: &Section, key: &str, value: &Value) -> Option<f64> {
        self.number_as(known(section.keys, key), value)
    }

    /// Number of a key whose range ends at a limit of its own; `help` says what is usual.
    pub(super) fn number_up_to_limit(
        &mut self,
        section: &Section,
        key: &str,
        value: &Value,
        help: &'static str,
    ) -> Option<f64> {
        let number = self.number_of(section, key, value)?;
        let Numeric { unit, range, .. } = section.number(key);
        let (is_within, side) = match range {
            Limits::UpTo(limit) => (number <= *limit, "at most"),
            _ => (number < range.maximum(), "below"),
        };
        if is_within {
            return Some(number);
        }
        let (written, limit) = (self.written(value.span()), range.maximum());
        let unit = if *unit == "1" { String::new() } else { format!(" {unit}") };
        self.issue(value.span(), format!("`{key}` is {written}, it must be {side} {limit}{unit}")).help(help);
        None
    }

    /// Number of a key, within its range.
    pub(super) fn number_as(&mut self, key: &Key, value: &Value) -> Option<f64> {
        let number = self.number(&format!("`{}`", key.name), key.numbers().range, value);
        if number.is_none()
            && let Some(issue) = self.issues.last_mut().filter(|issue| issue.help.is_none())
        {
            issue.help(format!("give a number in this range, for example `{}`", key.example));
        }
        number
    }

    /// Fraction of a key: a number within its range, up to the maximum or below it.
    pub(super) fn fraction(&mut self, section: &Section, key: &str, value: &Value) -> Option<f64> {
        self.number_up_to_limit(section, key, value, "it is a fraction, not per cent")
    }

    /// Number within the limits. `label` is the key in backticks, or names the element.
    pub(super) fn number(&mut self, label: &str, range: Limits, value: &Value) -> Option<f64> {
        let number = match value.get_ref() {
            DeValue::Float(_) | DeValue::Integer(_) => self.beside(&value.span()).or_else(|| parsed(value.get_ref())),
            other => {
                let quoted_number = matches!(other, DeValue::String(s) if s.trim().parse::<f64>().is_ok());
                let issue = self.wrong_type(label, "a number", value);
                if quoted_number {
                    issue.help("remove the quotes");
                }
                return None;
            }
        };

        // Only digits beyond i128 fail to parse here.
        let number: f64 = number.unwrap_or(f64::INFINITY);
        let limit = if number.is_nan() || (number.is_infinite() && self.written(value.span()).contains("inf")) {
            Some("it must be finite".to_owned())
        } else if number.abs() > MAX_MAGNITUDE {
            Some(format!("the limit is {MAX_MAGNITUDE:e} in magnitude"))
        } else if range.is_positive() && number <= 0.0 {
            Some("it must be positive".to_owned())
        } else if range.is_not_negative() && number < 0.0 {
            Some("it must not be negative".to_owned())
        } else if range.is_one_sided() && number != 0.0 && number < MIN_POSITIVE {
            let or_zero = if range.is_positive() { "" } else { "zero or " };
            Some(format!("it must be {or_zero}at least {MIN_POSITIVE:e}"))
        } else {
            None
        };

        if let Some(limit) = limit {
            let written = self.written(value.span());
            self.issue(value.span(), format!("{label} is {written}, {limit}"));
            return None;
        }
        Some(number)
    }

    /// Three elements of an array; `needed` describes them.
    pub(super) fn three<'v>(&mut self, label: &str, needed: &str, value: &'v Value<'v>) -> Option<[&'v Value<'v>; 3]> {
        let DeValue::Array(array) = value.get_ref() else {
            self.wrong_type(label, needed, value);
            return None;
        };
        let elements: Vec<&Value> = array.iter().collect();
        let Ok(three) = <[&Value; 3]>::try_from(elements) else {
            let count = array.len();
            let elements = if count == 1 { "element" } else { "elements" };
            // `[0,5, 1,0, 2,0]`: a decimal comma makes more elements, all of them whole numbers.
            let commas = (4..=6).contains(&count)
                && array.iter().all(|element| matches!(element.get_ref(), DeValue::Integer(_)));
            let issue = self.issue(value.span(), format!("{label} has {count} {elements} where {needed} are needed"));
            if commas {
                issue.help(DECIMAL_POINT);
            }
            return None;
        };
        Some(three)
    }

    /// Three numbers. Reports every wrong element.
    pub(super) fn three_numbers(&mut self, label: &str, range: Limits, values: [&Value; 3]) -> Option<[f64; 3]> {
        let mut number = |i: usize| self.number(&format!("number {} of {label}", i + 1), range, values[i]);
        let [x, y, z] = [number(0), number(1), number(2)];
        Some([x?, y?, z?])
    }

    /// List of numbers of a key that has one, at least one number. Reports every wrong number.
    pub(super) fn list(&mut self, section: &Section, key: &str, value: &Value) -> Option<Vec<f64>> {
        let label = format!("`{key}`");
        let DeValue::Array(array) = value.get_ref() else {
            let issue = self.wrong_type(&label, "a list of numbers in brackets", value);
            issue.help(format!("for example `{}`", section.example(key)));
            return None;
        };
        if array.is_empty() {
            let issue = self.issue(value.span(), format!("{label} is an empty list"));
            issue.help(format!("give its numbers, for example `{}`, or remove the line", section.example(key)));
            return None;
        }

        let range = section.number(key).range;
        let number =
            |(i, element): (usize, &Value)| self.number(&format!("number {} of {label}", i + 1), range, element);
        let numbers: Vec<Option<f64>> = array.iter().enumerate().map(number).collect();
        numbers.into_iter().collect()
    }

    /// Vector of a key of a section.
    pub(super) fn vector(&mut self, section: &Section, key: &str, value: &Value) -> Option<[f64; 3]> {
        self.vector_as(known(section.keys, key), value)
    }

    /// Vector of a key.
    pub(super) fn vector_as(&mut self, key: &Key, value: &Value) -> Option<[f64; 3]> {
        let (label, numbers) = (format!("`{}`", key.name), key.numbers());
        let unit = if numbers.unit == "1" { String::new() } else { format!(" in {}", numbers.unit) };
        let three = self.three(&label, &format!("three numbers [x, y, z]{unit}"), value)?;
        self.three_numbers(&label, numbers.range, three)
    }

    /// Vector of a key of a section, or its default.
    pub(super) fn vector_or_default(&mut self, section: &Section, key: &str) -> Option<[f64; 3]> {
        section.get(key).map_or_else(|| Some(section.default(key)), |value| self.vector(section, key, value))
    }

    /// Number of a key of a section, or its default.
    pub(super) fn number_or_default(&mut self, section: &Section, key: &str) -> Option<f64> {
        section.get(key).map_or_else(|| Some(section.default(key)[0]), |value| self.number_of(section, key, value))
    }

    /// Text.
    pub(super) fn text(&mut self, key: &str, value: &Value) -> Option<String> {
        let DeValue::String(text) = value.get_ref() else {
            self.wrong_type(&format!("`{key}`"), "text in quotes", value);
            return None;
        };
        Some(text.clone().into_owned())
    }

    /// Text that may have several lines.
    pub(super) fn prose(&mut self, key: &str, value: &Value) -> Option<String> {
        let text = self.text(key, value)?;
        let bad = text.chars().find(|&c| is_hidden(c) && !matches!(c, '\n' | '\r' | '\t'));
        self.without(bad, key, value.span())?;
        Some(text)
    }

    /// Name, as tables and requests show it: text that is not blank and has no control characters.
    pub(super) fn name(&mut self, key: &str, value: &Value) -> Option<String> {
        let text = self.text(key, value)?;
        self.check_name(key, &text, value.span())?;
        Some(text)
    }

    /// Check of [`name`](Self::name), also for names that are keys.
    pub(super) fn check_name(&mut self, key: &str, name: &str, span: Range<usize>) -> Option<()> {
        if name.trim().is_empty() {
            self.issue(span, format!("`{key}` is empty"));
            return None;
        }
        self.without(name.chars().find(|&c| is_hidden(c)), key, span)
    }

    /// Reports a character that is not allowed.
    fn without(&mut self, bad: Option<char>, key: &str, span: Range<usize>) -> Option<()> {
        let Some(bad) = bad else { return Some(()) };
        let code = u32::from(bad);
        self.issue(span, format!("`{key}` holds the control character U+{code:04X}, which would break tables"))
            .help("remove it");
        None
    }

    /// Tables `[kind.NAME]` of a value that holds them, each read by `read_one` from its name and its keys. `singular`
    /// is one of them in words.
    pub(super) fn named_tables<'v, T>(
        &mut self,
        kind: &str,
        singular: &str,
        value: &'v Value<'v>,
        keys: &'static [Key],
        mut read_one: impl FnMut(&mut Self, &str, &Section<'v>) -> Option<T>,
    ) -> Option<Named<T>> {
        let table = self.table(kind, &format!("[{kind}.NAME]"), value)?;
        let mut all = Named::new();
        for (key, value) in table {
            let name: &str = key.get_ref();
            let named = self.check_name(&format!("{singular} name"), name, key.span());
            let header = format!("[{kind}.{name}]");
            let read = self.table(name, &header, value).and_then(|table| {
                let section = self.open(header, value.span(), table, keys);
                read_one(self, name, &section)
            });
            all.insert(name.to_owned(), named.and(read));
        }
        Some(all)
    }

    /// Word of a key that has words, or its default.
    pub(super) fn word(&mut self, section: &Section, key: &str) -> Option<&'static str> {
        let known = known(section.keys, key);
        let (KeyValue::Word(words), Absent::DefaultWord(default)) = (known.value, known.absent) else {
            unreachable!("the reader asks for words of keys that have some")
        };
        let Some(value) = section.get(key) else { return Some(default) };

        let word = self.text(key, value)?;
        let words = || words.iter().map(|(word, _)| *word);
        let found = words().find(|known| *known == word);
        if found.is_none() {
            let all = words().map(|word| format!("\"{word}\"")).collect::<Vec<_>>().join(", ");
            let suggestion =
                nearest(&word, words()).map(|near| format!("did you mean \"{near}\"? ")).unwrap_or_default();
            self.issue(value.span(), format!("`{key}` is \"{}\", which is unknown", shortened(&word)))
                .help(format!("{suggestion}the words are {all}"));
        }
        found
    }

    /// Value of the named table that a key refers to. The outer `None` is a refused value, the inner one a missing key.
    #[expect(clippy::option_option, reason = "outside: refused, an issue is reported; inside: not given")]
    pub(super) fn reference<T: Clone>(
        &mut self,
        section: &Section,
        key: &str,
        kind: &str,
        known: Option<&Named<T>>,
    ) -> Option<Option<T>> {
        let Some(value) = section.get(key) else {
            return (!section.mistyped(&[key])).then_some(None);
        };
        let name = self.text(key, value)?;
        // Tables that were refused as a whole have been reported once.
        let known = known?;
        if let Some(found) = known.get(&name) {
            return found.clone().map(Some);
        }

        let all = known.keys().map(|name| format!("\"{}\"", shortened(name))).collect::<Vec<_>>().join(", ");
        let suggestion = nearest(&name, known.keys().map(String::as_str))
            .map(|near| format!("did you mean \"{}\"? ", shortened(near)))
            .unwrap_or_default();
        let help = if known.is_empty() {
            format!("add a table [{kind}.{}]", shortened(&name))
        } else {
            format!("{suggestion}the file has {all}")
        };
        self.issue(value.span(), format!("there is no {key} \"{}\"", shortened(&name))).help(help);
        None
    }

    /// Table; `header` is its notation in the file.
    pub(super) fn table<'v>(&mut self, key: &str, header: &str, value: &'v Value<'v>) -> Option<&'v DeTable<'v>> {
        let DeValue::Table(table) = value.get_ref() else {
            self.wrong_type(&format!("`{key}`"), &format!("a table, {header}"), value);
            return None;
        };
        Some(table)
    }
}

/// Number of the file; `None` for digits beyond `i128` in another base than ten, and for a value that is not a number.
pub(in crate::robot) fn parsed(value: &DeValue) -> Option<f64> {
    match value {
        DeValue::Float(float) => float.as_str().parse().ok(),
        // Parsed as text, so that any length is read; a hexadecimal mass is unusual but legal.
        DeValue::Integer(integer) if integer.radix() == 10 => integer.as_str().parse().ok(),
        DeValue::Integer(integer) => {
            i128::from_str_radix(integer.as_str(), integer.radix()).ok().map(|integer| integer as f64)
        }
        _ => None,
    }
}

/// Place of a key inside a table, for messages.
fn inside(label: &str) -> String {
    format!("{} {label}", if label == TOP { "at" } else { "in" })
}

/// True if all three numbers are zero, of either sign.
pub(super) fn is_zero(vector: &[f64; 3]) -> bool {
    vector.iter().all(|number| *number == 0.0)
}

/// User's text for a message: escaped, and shortened if it is long.
pub(super) fn shortened(text: &str) -> String {
    let mut shown: String = text.chars().take(QUOTED).flat_map(char::escape_debug).collect();
    if text.chars().nth(QUOTED).is_some() {
        shown.push('…');
    }
    shown
}

/// Type of a value, with its article.
fn a_type(value: &DeValue) -> &'static str {
    match value {
        DeValue::String(_) => "text",
        DeValue::Integer(_) | DeValue::Float(_) => "a number",
        DeValue::Boolean(_) => "true or false",
        DeValue::Datetime(_) => "a date",
        DeValue::Array(_) => "an array",
        DeValue::Table(_) => "a table",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_read_in_every_notation_of_toml() {
        let text = "a = [1_000, +2.5, 0x1F, 1e-3, -0.0]";
        let root = DeTable::parse(text).unwrap();
        let DeValue::Array(array) = root.get_ref()["a"].get_ref() else { panic!() };
        let mut reader = Reader::new(text);
        let numbers: Vec<_> = array.iter().map(|v| reader.number("`a`", Limits::Any, v).unwrap()).collect();
        assert_eq!(numbers, [1000.0, 2.5, 31.0, 1e-3, 0.0]);
    }

    #[test]
    fn long_and_strange_text_is_cut_and_escaped() {
        assert_eq!(shortened("a\u{1b}[31m"), "a\\u{1b}[31m");
        assert_eq!(shortened(&"x".repeat(100)).chars().count(), QUOTED + 1);
    }
}

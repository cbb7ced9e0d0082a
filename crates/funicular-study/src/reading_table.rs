//! Tables for reading as LaTeX (booktabs, siunitx) and as Markdown.

use crate::text::NONE;
use std::fmt::Write as _;

/// Mark between the components of a vector in a cell, until the table of a terminal knows how wide they are.
pub const COMPONENTS: &str = "\u{1f}";

/// Column of a table for reading.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ReadingColumn {
    /// Name of the quantity.
    pub name: String,
    /// Unit; empty without one.
    pub unit: String,
    /// True for a column of texts, which are aligned to the left.
    pub is_text: bool,
}

/// Rounded table with texts in its cells.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ReadingTable {
    /// Columns.
    pub columns: Vec<ReadingColumn>,
    /// Texts of every row, one per column.
    pub rows: Vec<Vec<String>>,
}

/// Signs that LaTeX has by commands, in text.
const COMMANDS: [(char, &str); 43] = [
    ('\\', r"\textbackslash{}"),
    ('&', r"\&"),
    ('%', r"\%"),
    ('$', r"\$"),
    ('#', r"\#"),
    ('_', r"\_"),
    ('{', r"\{"),
    ('}', r"\}"),
    ('~', r"\textasciitilde{}"),
    ('^', r"\textasciicircum{}"),
    ('<', r"$<$"),
    ('>', r"$>$"),
    ('|', r"$|$"),
    ('"', r"\textquotedbl{}"),
    ('–', "--"),
    ('−', "$-$"),
    ('×', r"$\times$"),
    ('·', r"$\cdot$"),
    ('±', r"$\pm$"),
    ('≤', r"$\le$"),
    ('≥', r"$\ge$"),
    ('≈', r"$\approx$"),
    ('→', r"$\to$"),
    ('√', r"$\surd$"),
    ('∞', r"$\infty$"),
    ('°', r"$^\circ$"),
    ('²', "$^2$"),
    ('³', "$^3$"),
    ('⁻', "$^{-}$"),
    ('¹', "$^1$"),
    ('α', r"$\alpha$"),
    ('β', r"$\beta$"),
    ('δ', r"$\delta$"),
    ('Δ', r"$\Delta$"),
    ('ζ', r"$\zeta$"),
    ('θ', r"$\theta$"),
    ('λ', r"$\lambda$"),
    ('µ', r"$\mu$"),
    ('μ', r"$\mu$"),
    ('σ', r"$\sigma$"),
    ('φ', r"$\varphi$"),
    ('ω', r"$\omega$"),
    ('Ω', r"$\Omega$"),
];

impl ReadingTable {
    /// Environment `tabular` with the rules of booktabs. Columns of numbers are `S` columns of siunitx, which align the
    /// decimal points; other columns are aligned to the left or right.
    ///
    /// # Example
    /// ```
    /// use funicular_study::reading_table::{ReadingColumn, ReadingTable};
    ///
    /// let column = |name: &str, unit: &str, is_text| ReadingColumn { name: name.into(), unit: unit.into(), is_text };
    /// let columns = vec![column("cable", "", true), column("tension", "N", false)];
    /// let rows = vec![vec!["a_1".to_owned(), "-12.5".to_owned()]];
    /// let latex = ReadingTable { columns, rows }.latex();
    /// assert!(latex.contains(r"\begin{tabular}{lS[table-format=-2.1]}"));
    /// assert!(latex.contains(r"cable & {tension / \si{N}} \\") && latex.contains(r"a\_1 & -12.5 \\"));
    /// ```
    pub fn latex(&self) -> String {
        let formats: Vec<Option<NumberFormat>> = (0..self.columns.len()).map(|k| self.format(k)).collect();
        let mut kinds = String::new();
        for (column, format) in self.columns.iter().zip(&formats) {
            match format {
                Some(format) => {
                    let _ = write!(kinds, "S[table-format={}]", format.text());
                }
                None => kinds.push(if column.is_text { 'l' } else { 'r' }),
            }
        }
        let heading = |(column, format): (&ReadingColumn, &Option<NumberFormat>)| {
            let text = column.latex();
            if format.is_some() { format!("{{{text}}}") } else { text }
        };
        let headings: Vec<String> = self.columns.iter().zip(&formats).map(heading).collect();
        let cell = |(text, format): (&String, &Option<NumberFormat>)| match format {
            Some(_) if number_parts(text).is_none() => format!("{{{}}}", escaped(text)),
            Some(_) => text.clone(),
            None => escaped(text),
        };
        let row = |row: &Vec<String>| {
            let cells: Vec<String> = row.iter().zip(&formats).map(cell).collect();
            format!("{} \\\\\n", cells.join(" & "))
        };
        format!(
            "% \\usepackage{{booktabs, siunitx}}\n\\begin{{tabular}}{{{kinds}}}\n\\toprule\n{} \\\\\n\\midrule\n{}\
             \\bottomrule\n\\end{{tabular}}\n",
            headings.join(" & "),
            self.rows.iter().map(row).collect::<String>()
        )
    }

    /// Table of Markdown (GitHub, pandoc), with columns of one width.
    ///
    /// # Example
    /// ```
    /// use funicular_study::reading_table::{ReadingColumn, ReadingTable};
    ///
    /// let column = |name: &str, unit: &str, is_text| ReadingColumn { name: name.into(), unit: unit.into(), is_text };
    /// let columns = vec![column("cable", "", true), column("T", "N", false)];
    /// let table = ReadingTable { columns, rows: vec![vec!["a|b".to_owned(), "12".to_owned()]] };
    /// assert_eq!(table.markdown(), "| cable | T [N] |\n|:------|------:|\n| a\\|b  |    12 |\n");
    /// ```
    pub fn markdown(&self) -> String {
        let headings = self.columns.iter().map(|column| {
            let ReadingColumn { name, unit, .. } = column;
            marked(&if unit.is_empty() { name.clone() } else { format!("{name} [{unit}]") })
        });
        let headings: Vec<String> = headings.collect();
        let rows: Vec<Vec<String>> =
            self.rows.iter().map(|row| row.iter().map(|text| marked(text)).collect()).collect();
        let width = |k: usize| {
            let texts = rows.iter().filter_map(|row| row.get(k)).chain(&headings[k..=k]);
            texts.map(|text| text.chars().count()).max().unwrap_or(0).max(3)
        };
        let widths: Vec<usize> = (0..headings.len()).map(width).collect();

        let line = |cells: &[String]| {
            let cells = cells.iter().zip(&self.columns).zip(&widths).map(|((text, column), width)| {
                if column.is_text { format!(" {text:<width$} |") } else { format!(" {text:>width$} |") }
            });
            format!("|{}\n", cells.collect::<String>())
        };
        let rules = self.columns.iter().zip(&widths).map(|(column, width)| {
            let dashes = "-".repeat(width + 1);
            if column.is_text { format!(":{dashes}|") } else { format!("{dashes}:|") }
        });
        let rules = format!("|{}\n", rules.collect::<String>());
        format!("{}{rules}{}", line(&headings), rows.iter().map(|row| line(row)).collect::<String>())
    }

    /// Format of the numbers of a column; `None` if a cell holds something else.
    fn format(&self, k: usize) -> Option<NumberFormat> {
        let mut format = NumberFormat::default();
        let mut is_empty = true;
        for text in self.rows.iter().filter_map(|row| row.get(k)).filter(|text| *text != NONE && !text.is_empty()) {
            format.include(&number_parts(text)?);
            is_empty = false;
        }
        (!self.columns[k].is_text && !is_empty).then_some(format)
    }
}

impl ReadingColumn {
    /// Heading with the unit by siunitx.
    fn latex(&self) -> String {
        let name = escaped(&self.name);
        if self.unit.is_empty() { name } else { format!("{name} / \\si{{{}}}", unit_of_siunitx(&self.unit)) }
    }
}

/// Unit in the literal form of siunitx: `N m/rad` is `N.m/rad`.
fn unit_of_siunitx(unit: &str) -> String {
    let mut text = String::new();
    for c in unit.chars() {
        match c {
            ' ' | '·' => text.push('.'),
            '²' => text.push_str("^2"),
            '³' => text.push_str("^3"),
            '°' => text.push_str(r"\degree"),
            '%' => text.push_str(r"\percent"),
            'µ' | 'μ' => text.push_str(r"\micro "),
            c => text.push_str(&escaped(&c.to_string())),
        }
    }
    text
}

/// Digits of a number before and after the point and in the exponent, and the signs.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
struct NumberFormat {
    is_negative: bool,
    whole: usize,
    decimals: usize,
    exponent: usize,
    has_negative_exponent: bool,
}

impl NumberFormat {
    fn include(&mut self, other: &Self) {
        self.is_negative |= other.is_negative;
        self.whole = self.whole.max(other.whole);
        self.decimals = self.decimals.max(other.decimals);
        self.exponent = self.exponent.max(other.exponent);
        self.has_negative_exponent |= other.has_negative_exponent;
    }

    fn text(self) -> String {
        let sign = |is_negative: bool| if is_negative { "-" } else { "" };
        let exponent = match self.exponent {
            0 => String::new(),
            digits => format!("e{}{digits}", sign(self.has_negative_exponent)),
        };
        format!("{}{}.{}{exponent}", sign(self.is_negative), self.whole, self.decimals)
    }
}

/// Parts of a number; `None` for another text.
fn number_parts(text: &str) -> Option<NumberFormat> {
    let are_digits = |text: &str| text.bytes().all(|byte| byte.is_ascii_digit());
    let unsigned = text.strip_prefix('-').unwrap_or(text);
    let (mantissa, exponent) = unsigned.split_once('e').unwrap_or((unsigned, ""));
    let (whole, decimals) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let digits = exponent.strip_prefix('-').unwrap_or(exponent);
    let is_number = !whole.is_empty() && [whole, decimals, digits].into_iter().all(are_digits);
    let has_digits = !unsigned.contains('e') || !digits.is_empty();
    (is_number && has_digits).then(|| NumberFormat {
        is_negative: text.starts_with('-'),
        whole: whole.len(),
        decimals: decimals.len(),
        exponent: digits.len(),
        has_negative_exponent: exponent.starts_with('-'),
    })
}

/// Text in one line, with the components of a vector side by side.
fn in_line(text: &str) -> String {
    text.replace(COMPONENTS, ", ").split_whitespace().collect::<Vec<_>>().join(" ")
}

fn escaped(text: &str) -> String {
    let mut found = String::new();
    for c in in_line(text).chars() {
        match COMMANDS.iter().find(|(of, _)| *of == c) {
            Some((_, command)) => found.push_str(command),
            None => found.push(c),
        }
    }
    found
}

/// Text in a cell of Markdown.
fn marked(text: &str) -> String {
    let mut found = String::new();
    for c in in_line(text).chars() {
        if matches!(c, '|' | '\\' | '*' | '_' | '`' | '<') {
            found.push('\\');
        }
        found.push(c);
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(cells: &[&str]) -> ReadingTable {
        let column = ReadingColumn { name: "T_max".to_owned(), unit: "N m²/rad".to_owned(), is_text: false };
        ReadingTable { columns: vec![column], rows: cells.iter().map(|cell| vec![(*cell).to_owned()]).collect() }
    }

    #[test]
    fn columns_of_numbers_get_the_format_that_holds_all_of_them() {
        for (cells, format) in [
            (&["1.25", "-12", NONE][..], "S[table-format=-2.2]"),
            (&["1.5e-3", "2.25e12"], "S[table-format=1.2e-2]"),
            (&["12 to 14", "3"], "{r}"),
            (&["0, 1", "2"], "{r}"),
            (&["1e", "2"], "{r}"),
        ] {
            let latex = table(cells).latex();
            assert!(latex.contains(format), "{latex}");
        }
        let latex = table(&["1", NONE]).latex();
        assert!(latex.contains("{T\\_max / \\si{N.m^2/rad}} \\\\") && latex.contains("{--} \\\\"), "{latex}");
    }

    #[test]
    fn special_characters_are_text() {
        let text = "a_b & 50% {x} \\ #1 $ ~^ <|> \"q\" λ²";
        let column = ReadingColumn { name: "of".to_owned(), unit: String::new(), is_text: true };
        let table = ReadingTable { columns: vec![column], rows: vec![vec![text.to_owned()]] };
        let latex = table.latex();
        let row = latex.lines().nth(5).unwrap();
        assert_eq!(
            row,
            "a\\_b \\& 50\\% \\{x\\} \\textbackslash{} \\#1 \\$ \\textasciitilde{}\\textasciicircum{} $<$$|$$>$ \
             \\textquotedbl{}q\\textquotedbl{} $\\lambda$$^2$ \\\\"
        );
        assert!(table.markdown().contains(r"a\_b & 50% {x} \\ #1 $ ~^ \<\|>"), "{}", table.markdown());
    }
}

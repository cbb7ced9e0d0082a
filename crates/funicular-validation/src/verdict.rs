//! `validate`: all comparisons of docs/validation.md.

use super::{Comparison, Section, sections};
use anyhow::Result;
use funicular_study::NoSolution;
use funicular_study::analyses::Found;
use funicular_study::columns::{Columns, CommandTables, ResultTable, Tabled, column};
use funicular_study::table::Column;
use funicular_study::text::counted;
use serde::Serialize;
use serde_json::{Value, json};

/// Results of `validate`: comparisons with numbers that others published or computed.
#[derive(Serialize)]
pub struct Validated {
    /// Number of comparisons.
    pub comparisons: usize,
    /// Number of comparisons within tolerance.
    pub passed: usize,
    /// Comparisons by section.
    pub sections: Vec<Section>,
}

/// Makes all comparisons.
///
/// # Errors
/// Reference data that cannot be read.
pub fn run() -> Result<Validated> {
    let sections = sections()?;
    let rows = || sections.iter().flat_map(|section| &section.rows);
    Ok(Validated { comparisons: rows().count(), passed: rows().filter(|row| row.pass).count(), sections })
}

impl Validated {
    /// Checks that every comparison passes.
    ///
    /// # Errors
    /// [`NoSolution`] that names the first comparison that does not pass.
    pub fn verdict(&self) -> Result<(), NoSolution> {
        let Some(first) = self.sections.iter().flat_map(|section| &section.rows).find(|row| !row.pass) else {
            return Ok(());
        };
        let failed = counted(self.comparisons - self.passed, "comparison");
        Err(NoSolution(format!(
            "{failed} of {} not within tolerance, first: {}, {}: difference {:.1e}, tolerance {:.1e}",
            self.comparisons, first.case, first.quantity, first.difference, first.tolerance
        )))
    }
}

/// Comparison with the section to which it belongs.
struct CompareRow<'a> {
    section: &'a Section,
    row: &'a Comparison,
}

impl CompareRow<'_> {
    fn columns() -> Columns<Self> {
        Columns::new([
            column("section", "", "section of the comparisons", |of: &Self| of.section.title),
            column("case", "", "robot or cable, and its state", |of: &Self| of.row.case.clone()),
            column("quantity", "", "compared quantity", |of: &Self| of.row.quantity.clone()),
            column("difference", "", "largest difference", |of: &Self| of.row.difference),
            column("kind", "", "absolute or relative", |of: &Self| of.row.kind.name()),
            column("tolerance", "", "largest difference that passes", |of: &Self| of.row.tolerance),
            column("bounded_by", "", "reason for the size of the tolerance", |of: &Self| {
                <&str>::from(of.row.bounded_by)
            }),
            column("pass", "", "the difference is within the tolerance", |of: &Self| of.row.pass),
            column("source", "", "source of the reference numbers", |of: &Self| of.row.source.clone()),
        ])
    }
}

impl Tabled for Validated {
    fn tables() -> Vec<(&'static str, Vec<Column>)> {
        vec![("", CompareRow::columns().described())]
    }

    fn table(&self) -> ResultTable<'_> {
        let rows =
            self.sections.iter().flat_map(|section| section.rows.iter().map(move |row| CompareRow { section, row }));
        ResultTable::new(CompareRow::columns(), rows)
    }
}

/// Tables of `validate` in files.
pub fn tables() -> CommandTables {
    (Validated::COMMAND, Validated::tables())
}

/// Name of `validate`, with the JSON Schema of its results without the keys that all results have.
pub fn schema() -> (&'static str, Value) {
    let object = |title: &str, properties: Value| {
        let required: Vec<&String> = properties.as_object().into_iter().flat_map(|keys| keys.keys()).collect();
        let required = json!(required);
        json!({ "title": title, "type": "object", "properties": properties, "required": required,
            "additionalProperties": false })
    };
    let text = json!({ "type": "string" });
    let (number, numbers) = (json!({ "type": "number" }), json!({ "type": "array", "items": { "type": "number" } }));
    let comparison = object(
        "Comparison",
        json!({
            "case": text, "source": text, "quantity": text, "theirs": numbers, "ours": numbers, "difference": number,
            "kind": { "enum": ["absolute", "relative"] }, "tolerance": number, "bounded_by": text,
            "pass": { "type": "boolean" },
        }),
    );
    let rows = json!({ "type": "array", "items": comparison });
    let section = object("Section", json!({ "title": text, "note": text, "rows": rows }));
    let count = json!({ "type": "integer" });
    let sections = json!({ "type": "array", "items": section });
    let all = object("Validated", json!({ "comparisons": count, "passed": count, "sections": sections }));
    (Validated::COMMAND, all)
}

impl Found for Validated {
    const COMMAND: &'static str = "validate";

    /// Empty: the comparisons belong to many robots.
    fn robot(&self) -> &'static str {
        ""
    }

    fn warnings(&self) -> &[String] {
        &[]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_comparison_that_fails_is_named_and_is_no_success() {
        let mut found = run().unwrap();
        assert!(found.verdict().is_ok());
        let row = &mut found.sections[1].rows[0];
        (row.pass, row.difference) = (false, 0.5);
        found.passed -= 1;
        let text = found.verdict().unwrap_err().to_string();
        assert!(
            text.starts_with("1 comparison of ") && text.contains(", first: yuan2014-4mm, 10.55 kg, position [m]"),
            "{text}"
        );
    }
}

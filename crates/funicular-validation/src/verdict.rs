//! `validate`: the comparisons of docs/validation.md that are asked for, and the negative controls.

use super::comparison::Comparison;
use super::section::{ControlRun, Declared, Section};
use super::{Level, SECTIONS};
use anyhow::{Result, anyhow};
use funicular::suggest::nearest;
use funicular_study::NoSolution;
use funicular_study::analyses::Found;
use funicular_study::columns::{Columns, CommandTables, ResultTable, Tabled, column};
use funicular_study::names::Named;
use funicular_study::request::ValidateRequest;
use funicular_study::table::Column;
use funicular_study::text::counted;
use serde::Serialize;
use serde_json::{Value, json};
use std::collections::BTreeSet;

/// Results of `validate`: comparisons with numbers that others published or computed.
#[derive(Serialize)]
pub struct Validated {
    /// Number of comparisons.
    pub comparisons: usize,
    /// Number of comparisons within tolerance.
    pub passed: usize,
    /// Number of reference numbers that are compared.
    pub numbers: usize,
    /// Number of sources of reference numbers.
    pub sources: usize,
    /// Counts by the kind of reference numbers.
    pub levels: Vec<LevelCount>,
    /// Comparisons by section.
    pub sections: Vec<Section>,
    /// Negative controls; empty if they are not asked for.
    pub controls: Vec<ControlRun>,
}

/// Counts of one kind of reference numbers.
#[derive(Serialize)]
pub struct LevelCount {
    /// Kind of reference numbers.
    pub level: &'static str,
    /// Number of comparisons.
    pub comparisons: usize,
    /// Number of reference numbers.
    pub numbers: usize,
    /// Number of their sources.
    pub sources: usize,
}

/// Makes the comparisons that are asked for.
///
/// # Errors
/// Reference data that cannot be read; an ID that no comparison has.
pub fn run(of: &ValidateRequest) -> Result<Validated> {
    let wanted = || SECTIONS.iter().filter(|declared| of.only.is_empty() || of.only.iter().any(|id| may(declared, id)));
    let mut sections = wanted().map(Declared::section).collect::<Result<Vec<Section>>>()?;
    for id in &of.only {
        if !sections.iter().flat_map(|section| &section.rows).any(|row| is_of(row, id)) {
            return Err(unknown(id, &sections));
        }
    }

    let chosen = |row: &Comparison| {
        let by_id = of.only.is_empty() || of.only.iter().any(|id| is_of(row, id));
        by_id && of.level.is_none_or(|level| level == row.level)
    };
    for section in &mut sections {
        section.rows.retain(chosen);
    }
    sections.retain(|section| !section.rows.is_empty());
    if let (true, Some(level)) = (sections.is_empty(), of.level) {
        return Err(anyhow!("no comparison of ⟪only⟫ has the level {}: leave out ⟪level⟫", level.name()));
    }

    let controls = if of.controls { wanted().flat_map(Declared::run_controls).collect::<Result<_>>()? } else { vec![] };
    Ok(Validated::new(sections, controls))
}

/// True if comparisons of the section may have IDs that begin with this.
fn may(declared: &Declared, id: &str) -> bool {
    match SECTIONS.iter().find(|of| begins(id, of.id)) {
        Some(named) => named.id == declared.id,
        None => declared.id.starts_with(id),
    }
}

/// True if the comparison has the ID, or one that begins with it: the name of a section does not mean another section
/// whose name is longer.
fn is_of(row: &Comparison, id: &str) -> bool {
    let is_section = SECTIONS.iter().any(|declared| declared.id == id);
    if is_section { begins(&row.id, id) } else { row.id.starts_with(id) }
}

/// True if an ID is this name, or continues it after a slash.
fn begins(id: &str, name: &str) -> bool {
    id.strip_prefix(name).is_some_and(|rest| rest.is_empty() || rest.starts_with('/'))
}

/// Error for an ID that no comparison has.
fn unknown(id: &str, sections: &[Section]) -> anyhow::Error {
    let rows = sections.iter().flat_map(|section| section.rows.iter().map(|row| row.id.as_str()));
    let known: Vec<&str> = SECTIONS.iter().map(|declared| declared.id).chain(rows).collect();
    if let Some(near) = nearest(id, known.iter().copied()) {
        return anyhow!("⟪only⟫: no comparison has an ID that begins with {id}; did you mean {near}?");
    }
    let sections: Vec<&str> = SECTIONS.iter().map(|declared| declared.id).collect();
    anyhow!("⟪only⟫: no comparison has an ID that begins with {id}; IDs begin with a section: {}", sections.join(", "))
}

impl Validated {
    /// Results with their counts.
    pub(super) fn new(sections: Vec<Section>, controls: Vec<ControlRun>) -> Self {
        let all: Vec<&Comparison> = sections.iter().flat_map(|section| &section.rows).collect();
        let levels = Level::ALL.iter().map(|level| {
            let rows = || all.iter().filter(|row| row.level == *level);
            LevelCount {
                level: level.name(),
                comparisons: rows().count(),
                numbers: rows().map(|row| row.numbers).sum(),
                sources: sources(rows().copied()),
            }
        });
        Self {
            comparisons: all.len(),
            passed: all.iter().filter(|row| row.pass).count(),
            numbers: all.iter().map(|row| row.numbers).sum(),
            sources: sources(all.iter().copied()),
            levels: levels.filter(|count| count.comparisons > 0).collect(),
            sections,
            controls,
        }
    }

    /// Checks that every comparison passes, and that every control fails.
    ///
    /// # Errors
    /// [`NoSolution`] that names the first comparison that does not pass, or the first control that does.
    pub fn verdict(&self) -> Result<(), NoSolution> {
        if let Some(first) = self.sections.iter().flat_map(|section| &section.rows).find(|row| !row.pass) {
            let failed = counted(self.comparisons - self.passed, "comparison");
            return Err(NoSolution(format!(
                "{failed} of {} not within tolerance, first: {}: {}, {}: difference {:.1e}, tolerance {:.1e}",
                self.comparisons, first.id, first.case, first.quantity, first.difference, first.tolerance
            )));
        }
        match self.controls.iter().find(|control| !control.caught) {
            Some(control) => Err(NoSolution(format!(
                "the negative control {} passes all its comparisons: {}",
                control.id, control.wrong
            ))),
            None => Ok(()),
        }
    }
}

/// Number of different sources.
fn sources<'a>(rows: impl Iterator<Item = &'a Comparison>) -> usize {
    rows.map(|row| row.source.as_str()).collect::<BTreeSet<_>>().len()
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
            column("id", "", "name of the comparison, which stays", |of: &Self| of.row.id.clone()),
            column("case", "", "robot or cable, and its state", |of: &Self| of.row.case.clone()),
            column("quantity", "", "compared quantity", |of: &Self| of.row.quantity.clone()),
            column("level", "", "kind of the reference numbers", |of: &Self| of.row.level.name()),
            column("numbers", "", "number of reference numbers", |of: &Self| of.row.numbers),
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
    let list = |of: &Value| json!({ "type": "array", "items": of });
    let (text, truth, count) =
        (json!({ "type": "string" }), json!({ "type": "boolean" }), json!({ "type": "integer" }));
    let (number, numbers) = (json!({ "type": "number" }), json!({ "type": "array", "items": { "type": "number" } }));
    let level = json!({ "enum": Level::ALL.iter().map(|level| level.name()).collect::<Vec<_>>() });
    let comparison = object(
        "Comparison",
        json!({
            "id": text, "case": text, "level": level, "source": text, "quantity": text, "numbers": count,
            "theirs": numbers, "ours": numbers, "difference": number, "kind": { "enum": ["absolute", "relative"] },
            "tolerance": number, "bounded_by": text, "pass": truth,
        }),
    );
    let section = object("Section", json!({ "id": text, "title": text, "note": text, "rows": list(&comparison) }));
    let of_level =
        object("LevelCount", json!({ "level": level, "comparisons": count, "numbers": count, "sources": count }));
    let mut control = object(
        "ControlRun",
        json!({
            "id": text, "wrong": text, "proves": text, "comparisons": count, "failed": count, "worst": text,
            "excess": number, "caught": truth,
        }),
    );
    if let Some(required) = control["required"].as_array_mut() {
        required.retain(|key| key != "excess");
    }
    let all = object(
        "Validated",
        json!({
            "comparisons": count, "passed": count, "numbers": count, "sources": count, "levels": list(&of_level),
            "sections": list(&section), "controls": list(&control),
        }),
    );
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

    fn only(ids: &[&str]) -> ValidateRequest {
        ValidateRequest { only: ids.iter().map(|id| (*id).to_owned()).collect(), ..ValidateRequest::default() }
    }

    #[test]
    fn a_comparison_that_fails_is_named_and_is_no_success() {
        let mut found = run(&only(&["paper-robot"])).unwrap();
        assert!(found.verdict().is_ok());
        let row = &mut found.sections[0].rows[0];
        (row.pass, row.difference) = (false, 0.5);
        found.passed -= 1;
        let text = found.verdict().unwrap_err().to_string();
        let expected = ", first: paper-robot/yuan2014-4mm/10.55kg/position: yuan2014-4mm, 10.55 kg, position [m]";
        assert!(text.starts_with("1 comparison of ") && text.contains(expected), "{text}");
    }

    #[test]
    fn ids_choose_sections_sources_and_single_comparisons() {
        let ids = |of: &ValidateRequest| -> Vec<String> {
            let rows = run(of).unwrap().sections.into_iter().flat_map(|section| section.rows);
            rows.map(|row| row.id).collect()
        };
        let node = ids(&only(&["catenary/michalos-1962"]));
        assert_eq!(node.len(), 3);
        assert_eq!(ids(&only(&["catenary/mich"])), node);
        assert!(ids(&only(&["paper"])).iter().all(|id| id.starts_with("paper/")));
        assert_eq!(ids(&only(&["catenary/michalos-1962/node"])), ["catenary/michalos-1962/node"]);
        let printed = ValidateRequest { level: Some(Level::Published), ..only(&["catenary/michalos-1962"]) };
        assert_eq!(ids(&printed), ["catenary/michalos-1962/displacement-printed"]);
        let told = run(&only(&["catenary/michalos-1963"])).err().unwrap().to_string();
        assert!(told.contains("no comparison has an ID that begins with catenary/michalos-1963"), "{told}");
        let told = run(&only(&["catenery"])).err().unwrap().to_string();
        assert!(told.contains("did you mean catenary?"), "{told}");
        let measured = ValidateRequest { level: Some(Level::Measured), ..only(&["catenary"]) };
        assert!(run(&measured).err().unwrap().to_string().contains("has the level measured"));
    }
}

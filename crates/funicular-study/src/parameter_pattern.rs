//! Paths with which a request names numbers of the robot file: one rule for all commands.

use crate::names::path_suggestion;
use crate::set_values::{self, ANY};
use anyhow::{Result, anyhow, bail};
use funicular::robot::parameters::{Parameter, Parameters};

/// Path of numbers of a robot file. `*` stands for any key; a path to a table or a vector stands for all numbers in it.
#[derive(Debug, Clone)]
pub(crate) struct ParameterPattern {
    /// Option that gives the path.
    option: &'static str,
    /// Path, as it was written.
    text: String,
    keys: Vec<String>,
}

impl ParameterPattern {
    /// Reads a path that `option` gives for numbers of a robot file.
    ///
    /// # Errors
    /// A text that is not a path.
    pub(crate) fn parse(option: &'static str, text: &str, parameters: &Parameters) -> Result<Self> {
        let path = set_values::path(text).map_err(|reason| anyhow!("⟪{option}⟫: {reason}"))?;

        // A component may be written by its index; the list of numbers has its name.
        let keys = match parameters.find(path.keys()) {
            Some(index) => parameters.list()[index].keys.clone(),
            None => path.keys().to_vec(),
        };
        Ok(Self { option, text: text.trim().to_owned(), keys })
    }

    /// Path, as it was written.
    pub(crate) fn text(&self) -> &str {
        &self.text
    }

    /// True for a number at this path or below it.
    pub(crate) fn matches(&self, parameter: &Parameter) -> bool {
        parameter.keys.len() >= self.keys.len()
            && self.keys.iter().zip(&parameter.keys).all(|(own, key)| own == ANY || own == key)
    }

    /// Indices of the numbers that a request may change: all numbers whose key the path names; below a table only those
    /// that the file gives, because a default has no place in it.
    ///
    /// # Errors
    /// A path that no number has.
    pub(crate) fn changeable(&self, parameters: &Parameters) -> Result<Vec<usize>> {
        let matching: Vec<(usize, &Parameter)> =
            parameters.list().iter().enumerate().filter(|(_, parameter)| self.matches(parameter)).collect();
        if matching.is_empty() {
            return Err(self.missing(parameters));
        }

        let names_key = |parameter: &Parameter| {
            self.keys.len() + usize::from(parameter.component.is_some()) >= parameter.keys.len()
        };
        let found: Vec<usize> = matching
            .into_iter()
            .filter(|(_, parameter)| parameter.given || names_key(parameter))
            .map(|(index, _)| index)
            .collect();
        if found.is_empty() {
            bail!(
                "⟪{}⟫ {}: the robot file gives none of the numbers of this table; write them there",
                self.option,
                self.text
            );
        }
        Ok(found)
    }

    /// Error of a path that no number of the robot file has.
    pub(crate) fn missing(&self, parameters: &Parameters) -> anyhow::Error {
        let paths: Vec<String> = parameters.list().iter().map(Parameter::path).collect();
        self.unknown("the robot file has no such number", &paths)
    }

    /// Error of a path that is none of `paths`: the reason, and the nearest of them.
    pub(crate) fn unknown(&self, reason: &str, paths: &[String]) -> anyhow::Error {
        anyhow!("⟪{}⟫ {}: {reason}{}", self.option, self.text, path_suggestion(&self.text, paths))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ROBOT: &str = r#"
        name = "two cables"
        [platform]
        mass_kg = 20.0
        inertia_kg_m2 = [0.8, 0.9, 1.2]
        [materials."steel 6.5"]
        axial_stiffness_n = 1e5
        mass_kg_per_m = 0.05
        [[cables]]
        name = "1"
        material = "steel 6.5"
        anchor_m = [2.0, 2.0, 3.0]
        attachment_m = [0.3, 0.1, 0.1]
        unstrained_length_m = 3.3
        [[cables]]
        name = "2"
        material = "steel 6.5"
        anchor_m = [2.0, -2.0, 3.0]
        attachment_m = [0.3, -0.1, -0.1]
        unstrained_length_m = 3.4
    "#;

    /// Paths of the numbers that match.
    fn matching(text: &str) -> Vec<String> {
        let parameters = Parameters::from_toml(ROBOT).unwrap();
        let pattern = ParameterPattern::parse("by", text, &parameters).unwrap();
        parameters.list().iter().filter(|parameter| pattern.matches(parameter)).map(Parameter::path).collect()
    }

    #[test]
    fn a_path_stands_for_itself_for_a_vector_for_a_table_and_with_a_star_for_any_key() {
        assert_eq!(matching("platform.mass_kg"), ["platform.mass_kg"]);
        assert_eq!(
            matching("cables.1.anchor_m"),
            ["cables.1.anchor_m.x", "cables.1.anchor_m.y", "cables.1.anchor_m.z"]
        );
        assert_eq!(matching("cables.*.anchor_m.z"), ["cables.1.anchor_m.z", "cables.2.anchor_m.z"]);
        assert_eq!(matching("cables.'*'.anchor_m.z"), matching("cables.*.anchor_m.z"));
        assert_eq!(matching(" cables.2.anchor_m.1 "), ["cables.2.anchor_m.y"]);
        assert_eq!(matching("materials.'steel 6.5'.mass_kg_per_m"), ["materials.'steel 6.5'.mass_kg_per_m"]);
        let table = matching("cables.2");
        assert!(table.len() == 7 && table.iter().all(|path| path.starts_with("cables.2.")), "{table:?}");
        assert_eq!(matching("cables").len(), 2 * table.len());
        assert_eq!(matching("cables.2.anchor"), [""; 0]);
    }

    #[test]
    fn of_a_table_the_numbers_change_that_the_file_gives() {
        let parameters = Parameters::from_toml(ROBOT).unwrap();
        let changeable = |text: &str| {
            let found = ParameterPattern::parse("fit", text, &parameters)?.changeable(&parameters)?;
            Ok(found.into_iter().map(|index| parameters.list()[index].path()).collect::<Vec<_>>())
        };
        let message = |found: Result<Vec<String>>| found.unwrap_err().to_string();

        assert_eq!(changeable("cables").unwrap().len(), 2 * 7);
        assert_eq!(changeable("platform.mass_kg").unwrap(), ["platform.mass_kg"]);
        // A number that the path names is not left out silently.
        assert_eq!(
            changeable("platform.drag_area_m2").unwrap().first().map(|path| &path[..21]),
            Some("platform.drag_area_m2")
        );
        assert_eq!(
            message(changeable("wind")),
            "⟪fit⟫ wind: the robot file gives none of the numbers of this table; write them there"
        );
        assert_eq!(
            message(changeable("platform.mas_kg")),
            "⟪fit⟫ platform.mas_kg: the robot file has no such number; did you mean `platform.mass_kg`?"
        );
        // The end of a path is enough for a tip, and so is a part of a key.
        for (text, tip) in [
            ("mass", "did you mean `platform.mass_kg`?"),
            ("robot.mass_kg", "did you mean `platform.mass_kg`?"),
            ("stiffness", "did you mean `materials.'steel 6.5'.axial_stiffness_n`?"),
            ("materials.mass", "did you mean `materials.'steel 6.5'.mass_kg_per_m`?"),
            ("anchor", "did you mean `cables.1.anchor_m` or `cables.2.anchor_m`?"),
        ] {
            let said = message(changeable(text));
            assert!(said.contains(tip), "{text}: {said}");
        }
        assert!(message(changeable("platform.mass kg")).starts_with("⟪fit⟫: `platform.mass kg` is not a path"));
    }
}

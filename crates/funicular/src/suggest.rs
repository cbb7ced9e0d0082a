//! "Did you mean": the known name nearest to a mistyped one. All messages share one measure and one limit.

/// Minimum similarity (Jaro-Winkler, 0 to 1) at which a known name is suggested: `mas` has 0.87 with `mass_kg`, which
/// is meant; `mass_kg_per_m` has 0.66 with `name`, which is not.
const MIN_SIMILARITY: f64 = 0.8;

/// Maximum length of a name [bytes]. Longer text is no name, and its comparison would take long.
const MAX_LENGTH: usize = 100;

/// Names of earlier versions of the program with their present names. The present name is suggested for an earlier one
/// even if their letters have nothing in common.
const RENAMED: &[(&str, &str)] = &[
    ("exact", "catenary-dynamic"),
    ("closed-form", "shallow-dynamic"),
    ("catenary-tangent", "catenary-static"),
    ("static-sag", "shallow-static"),
    ("paper", "without-geometric-stiffness"),
    ("freedoms", "motion"),
    ("wanted_tension_n", "target_tension_n"),
    ("wanted-tension-n", "target-tension-n"),
];

/// Present name of an earlier name, if `word` is one.
///
/// # Example
/// ```
/// use funicular::suggest::renamed;
///
/// assert_eq!(renamed("static-sag"), Some("shallow-static"));
/// assert_eq!(renamed("spring"), None);
/// ```
pub fn renamed(word: &str) -> Option<&'static str> {
    RENAMED.iter().find(|(old, _)| old.eq_ignore_ascii_case(word)).map(|(_, new)| *new)
}

/// Known name that an earlier version called `word`, or else the known name nearest to `word`, if one is near enough.
/// Ignores upper and lower case.
///
/// # Example
/// ```
/// use funicular::suggest::nearest;
///
/// assert_eq!(nearest("statcs", ["check", "statics"]), Some("statics"));
/// assert_eq!(nearest("colour", ["check", "statics"]), None);
/// ```
pub fn nearest<'k>(word: &str, known: impl IntoIterator<Item = &'k str>) -> Option<&'k str> {
    let known: Vec<&str> = known.into_iter().collect();
    if let Some(new) = renamed(word).and_then(|new| known.iter().find(|name| **name == new)) {
        return Some(new);
    }

    let word = word.to_lowercase();
    known
        .into_iter()
        .filter(|name| word.len().max(name.len()) <= MAX_LENGTH)
        .map(|name| (strsim::jaro_winkler(&word, &name.to_lowercase()), name))
        .filter(|(similarity, _)| *similarity >= MIN_SIMILARITY)
        // Equal candidates: the first one wins, so that the answer does not depend on the order of comparison.
        .fold(None, |best: Option<(f64, &str)>, (similarity, name)| match best {
            Some((most, _)) if most >= similarity => best,
            _ => Some((similarity, name)),
        })
        .map(|(_, name)| name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_earlier_name_is_answered_with_the_name_of_today() {
        assert_eq!(nearest("exact", ["spring", "catenary-dynamic"]), Some("catenary-dynamic"));
        assert_eq!(nearest("Freedoms", ["mass_kg", "motion"]), Some("motion"));
        // If the new name is not among the known ones, similarity decides.
        assert_eq!(nearest("exact", ["spring", "exact_length"]), Some("exact_length"));
        assert_eq!(nearest("exact", ["spring"]), None);
    }

    #[test]
    fn typing_errors_are_near_and_other_words_are_not() {
        let keys = ["name", "mass_kg", "inertia_kg_m2", "center_of_mass_m"];
        for (word, expected) in [
            ("mas", Some("mass_kg")),
            ("mass", Some("mass_kg")),
            ("Mass_kg", Some("mass_kg")),
            ("inertia", Some("inertia_kg_m2")),
            ("centre_of_mass_m", Some("center_of_mass_m")),
            ("", None),
            ("colour", None),
            (
                "mass_kg_per_m_and_so_on_for_more_than_a_hundred_letters_which_no_name_of_any_robot_file_or_option_ever_has_had",
                None,
            ),
        ] {
            assert_eq!(nearest(word, keys), expected, "{word}");
        }
        assert!(strsim::jaro_winkler("mass_kg_per_m", "name") < MIN_SIMILARITY);
    }
}

//! Models and rules by the names that the program has for them.

use crate::errors;
use funicular::cable::CableModel;
use funicular::dynamics::{Assembly, Linearisation};
use funicular::statics::{StaticModel, TensionRule};
use pyo3::PyResult;

/// Likeness (Jaro-Winkler) from which a known name is suggested, as in the robot file's reader.
const ALIKE: f64 = 0.8;

fn one_of<T: Copy>(argument: &str, asked: &str, all: &[T], name: fn(T) -> &'static str) -> PyResult<T> {
    if let Some(found) = all.iter().find(|one| name(**one) == asked) {
        return Ok(*found);
    }
    let names: Vec<&str> = all.iter().map(|one| name(*one)).collect();
    let likeness = |name: &&str| strsim::jaro_winkler(asked, name);
    let alike = names.iter().copied().max_by(|a, b| likeness(a).total_cmp(&likeness(b)));
    let suggestion = alike.filter(|name| likeness(name) >= ALIKE);
    Err(errors::input(format!(
        "`{argument}` is \"{asked}\": it must be one of {}{}",
        names.join(", "),
        suggestion.map_or_else(String::new, |name| format!("; did you mean \"{name}\"?"))
    )))
}

pub(crate) fn static_model(asked: &str) -> PyResult<StaticModel> {
    one_of("model", asked, &StaticModel::ALL, StaticModel::name)
}

/// The rule of a name, and of wanted tensions where that is what it needs.
pub(crate) fn tension_rule(asked: Option<&str>, wanted: Option<Vec<f64>>) -> PyResult<Option<TensionRule>> {
    let all = ["lowest", "closest", "middle", "stiffest"];
    let asked = asked.map(|asked| one_of("tension_rule", asked, &all, |name| name)).transpose()?;
    Ok(match (asked, wanted) {
        (None, None) => None,
        (None | Some("closest"), Some(wanted)) => Some(TensionRule::Closest(wanted)),
        (Some("closest"), None) => {
            return Err(errors::input("the tension rule `closest` needs `wanted_tension_n`".to_owned()));
        }
        (Some(_), Some(_)) => {
            return Err(errors::input("`wanted_tension_n` goes with the tension rule `closest` only".to_owned()));
        }
        (Some("middle"), None) => Some(TensionRule::Middle),
        (Some("stiffest"), None) => Some(TensionRule::Stiffest),
        (Some(_), None) => Some(TensionRule::Lowest),
    })
}

/// How a robot is linearised; without a cable model by the exact one, or, where cables do not hang, by the closed form of
/// those that hardly sag, as the program does.
pub(crate) fn linearisation(
    cable_model: Option<&str>,
    assembly: &str,
    in_plane_only: bool,
    static_model: StaticModel,
) -> PyResult<Linearisation> {
    let cable_model = match (cable_model, static_model) {
        (Some(asked), _) => one_of("cable_model", asked, &CableModel::ALL, CableModel::name)?,
        (None, StaticModel::Catenary) => CableModel::Exact,
        (None, StaticModel::Ideal | StaticModel::Spring) => CableModel::ClosedForm,
    };
    Ok(Linearisation {
        cable_model,
        assembly: one_of("assembly", assembly, &Assembly::ALL, Assembly::name)?,
        in_plane_only,
    })
}

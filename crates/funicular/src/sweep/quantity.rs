//! What can be asked of every point, by name.

use super::{Column, Kind};
use crate::cable::CableModel;
use crate::robot::Robot;
use crate::statics::StaticModel;
use crate::suggest::nearest;
use thiserror::Error;

/// One thing to know about every point; read from its name on the command line. A model after a colon is one of those
/// simpler than the exact; without one it is the closed form for frequencies and the spring for stiffness.
///
/// # Example
/// ```
/// use funicular::sweep::Quantity;
///
/// assert_eq!("frequencies:3".parse(), Ok(Quantity::Frequencies(3)));
/// let error = "tension-mx".parse::<Quantity>().unwrap_err();
/// assert_eq!(error.to_string(), "there is no quantity `tension-mx`; did you mean `tension-max`?");
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// The lowest natural frequency, undamped.
    FirstFrequency,
    /// Whose vibration the first mode is.
    FirstKind,
    /// The lowest natural frequencies, so many.
    Frequencies(usize),
    /// Greatest tension anywhere in any cable.
    TensionMax,
    /// Least tension anywhere in any cable.
    TensionMin,
    /// Tension of every cable at the platform.
    Tensions,
    /// Unstrained length of every cable.
    Lengths,
    /// Least distance of a tension from its limits.
    TensionMargin,
    /// Least eigenvalue of the scaled static stiffness.
    StiffnessMin,
    /// Static stiffness along every coordinate, the others free.
    Stiffness,
    /// Distances between the poses of the three static models, at the same lengths.
    PoseError,
    /// Largest sag over chord.
    SagMax,
    /// First frequency with a simpler cable model against the exact one.
    ModelError(CableModel),
    /// Least stiffness with a simpler cable model against the exact one.
    StiffnessError(CableModel),
    /// Nearness to a singular pose.
    Condition,
    /// Potential energy.
    Energy,
    /// The pose that is found.
    Pose,
}

/// A name that is no quantity.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("there is no quantity `{name}`{hint}")]
pub struct UnknownQuantity {
    /// As given.
    pub name: String,
    /// The nearest one or all of them.
    pub hint: String,
}

/// Most natural frequencies of a point.
pub const MOST_FREQUENCIES: usize = 100;

/// Names on the command line with what they give, in the order of the documentation.
pub const QUANTITIES: [(&str, &str); 17] = [
    ("first-frequency", "lowest natural frequency"),
    ("first-kind", "whose vibration that is: platform, cable or mixed"),
    ("frequencies:N", "the lowest N natural frequencies"),
    ("tension-max", "greatest tension anywhere in a cable"),
    ("tension-min", "least tension anywhere in a cable"),
    ("tensions", "tension of every cable at the platform"),
    ("lengths", "unstrained length of every cable"),
    ("tension-margin", "least distance of a tension from its limits, negative beyond them"),
    ("stiffness-min", "least eigenvalue of the static stiffness, rotations scaled by the platform's size"),
    ("stiffness", "static stiffness along every coordinate, the others free"),
    ("pose-error", "distances between the poses of ideal, spring and catenary cables of the same lengths"),
    ("sag-max", "largest sag over chord"),
    ("model-error:MODEL", "first frequency with a simpler cable model, relative to the exact one"),
    ("stiffness-error:MODEL", "least stiffness with a simpler cable model, relative to the exact one"),
    ("condition", "inverse condition of the cables' directions: 0 at a singular pose, 1 at best"),
    ("energy", "potential energy of platform, load and cables"),
    ("pose", "the pose that is found"),
];

impl Quantity {
    /// By its name.
    fn named(text: &str) -> Option<Self> {
        let simpler =
            |name: &str| CableModel::ALL.into_iter().find(|model| *model != CableModel::Exact && model.name() == name);
        Some(match text {
            "first-frequency" => Self::FirstFrequency,
            "first-kind" => Self::FirstKind,
            "tension-max" => Self::TensionMax,
            "tension-min" => Self::TensionMin,
            "tensions" => Self::Tensions,
            "lengths" => Self::Lengths,
            "tension-margin" => Self::TensionMargin,
            "stiffness-min" => Self::StiffnessMin,
            "stiffness" => Self::Stiffness,
            "pose-error" => Self::PoseError,
            "sag-max" => Self::SagMax,
            "model-error" => Self::ModelError(CableModel::ClosedForm),
            "stiffness-error" => Self::StiffnessError(CableModel::Spring),
            "condition" => Self::Condition,
            "energy" => Self::Energy,
            "pose" => Self::Pose,
            other => match other.split_once(':')? {
                ("frequencies", count) => {
                    Self::Frequencies(count.parse().ok().filter(|count| (1..=MOST_FREQUENCIES).contains(count))?)
                }
                ("model-error", model) => Self::ModelError(simpler(model)?),
                ("stiffness-error", model) => Self::StiffnessError(simpler(model)?),
                _ => return None,
            },
        })
    }

    /// Its name on the command line.
    pub fn name(&self) -> String {
        match self {
            Self::Frequencies(count) => format!("frequencies:{count}"),
            Self::ModelError(model) => format!("model-error:{model}"),
            Self::StiffnessError(model) => format!("stiffness-error:{model}"),
            Self::FirstFrequency => "first-frequency".to_owned(),
            Self::FirstKind => "first-kind".to_owned(),
            Self::TensionMax => "tension-max".to_owned(),
            Self::TensionMin => "tension-min".to_owned(),
            Self::Tensions => "tensions".to_owned(),
            Self::Lengths => "lengths".to_owned(),
            Self::TensionMargin => "tension-margin".to_owned(),
            Self::StiffnessMin => "stiffness-min".to_owned(),
            Self::Stiffness => "stiffness".to_owned(),
            Self::PoseError => "pose-error".to_owned(),
            Self::SagMax => "sag-max".to_owned(),
            Self::Condition => "condition".to_owned(),
            Self::Energy => "energy".to_owned(),
            Self::Pose => "pose".to_owned(),
        }
    }

    /// Lowest natural frequencies, so many, with the cable model asked for.
    pub(super) fn frequencies(&self) -> usize {
        match self {
            Self::FirstFrequency | Self::FirstKind => 1,
            Self::Frequencies(count) => *count,
            _ => 0,
        }
    }

    /// What it needs that a static model lacks: the model that it works with alone, if that is another.
    pub(super) fn excludes(&self, model: StaticModel) -> bool {
        match self {
            Self::StiffnessMin | Self::Stiffness => model == StaticModel::Ideal,
            Self::PoseError | Self::ModelError(_) | Self::StiffnessError(_) => model != StaticModel::Catenary,
            _ => false,
        }
    }

    /// Its columns for a robot.
    pub fn columns(&self, robot: &Robot) -> Vec<Column> {
        let real = |name: String, unit: &'static str, about: &str| Column {
            name,
            unit: unit.into(),
            about: about.to_owned(),
            kind: Kind::Real,
        };
        let one = |name: &str, unit: &'static str, about: &str| vec![real(name.to_owned(), unit, about)];
        let each = |prefix: &str, suffix: &str, unit: &'static str, about: &str| {
            robot.cables.iter().map(|c| real(format!("{prefix}_{}_{suffix}", c.name), unit, about)).collect()
        };
        match self {
            Self::FirstFrequency => one("first_frequency_hz", "Hz", "lowest natural frequency, undamped"),
            Self::FirstKind => vec![Column {
                name: "first_kind".to_owned(),
                unit: "".into(),
                about: "whose vibration the first mode is: platform, cable or mixed".to_owned(),
                kind: Kind::Text,
            }],
            Self::Frequencies(count) => (1..=*count)
                .map(|i| real(format!("frequency_{i}_hz"), "Hz", "natural frequency, ascending, undamped"))
                .collect(),
            Self::TensionMax => one("tension_max_n", "N", "greatest tension anywhere in a cable"),
            Self::TensionMin => one("tension_min_n", "N", "least tension anywhere in a cable"),
            Self::Tensions => each("tension_platform", "n", "N", "tension of a cable at the platform"),
            Self::Lengths => each("unstrained_length", "m", "m", "unstrained length of a cable"),
            Self::TensionMargin => one("tension_margin_n", "N", "least distance of a tension from its limits"),
            Self::StiffnessMin => {
                one("stiffness_min_n_per_m", "N/m", "least eigenvalue of the scaled static stiffness")
            }
            Self::Stiffness => stiffness_columns(robot),
            Self::PoseError => pose_error_columns(robot),
            Self::SagMax => one("sag_ratio_max", "1", "largest sag over chord"),
            Self::ModelError(model) => vec![real(
                format!("model_error_{}", underscored(*model)),
                "1",
                "first frequency with this cable model over the exact one, less one",
            )],
            Self::StiffnessError(model) => vec![real(
                format!("stiffness_error_{}", underscored(*model)),
                "1",
                "least static stiffness with this cable model over the exact one, less one",
            )],
            Self::Condition => {
                one("inverse_condition", "1", "least over largest singular value of the cables' scaled directions")
            }
            Self::Energy => one("potential_energy_j", "J", "potential energy of platform, load and cables"),
            Self::Pose => super::AXES
                .iter()
                .enumerate()
                .map(|(i, axis)| {
                    let unit = if i < 3 { "m" } else { "deg" };
                    real(format!("pose_{axis}_{unit}"), unit, "of the pose found, world axes, R = Rz Ry Rx")
                })
                .collect(),
        }
    }
}

fn underscored(model: CableModel) -> String {
    model.name().replace('-', "_")
}

fn stiffness_columns(robot: &Robot) -> Vec<Column> {
    let freedoms = &robot.platform.freedoms;
    let names = freedoms.coordinate_names().iter().enumerate();
    names
        .map(|(k, name)| {
            let (suffix, unit) = if freedoms.is_rotation(k) { ("n_m_per_rad", "N m/rad") } else { ("n_per_m", "N/m") };
            let about = "load along this coordinate over the motion along it, all others free".to_owned();
            Column { name: format!("stiffness_{name}_{suffix}"), unit: unit.into(), about, kind: Kind::Real }
        })
        .collect()
}

/// Rigid cables of given lengths close only where there are as many as freedoms.
pub(super) fn has_ideal_pose(robot: &Robot) -> bool {
    robot.cables.len() == robot.platform.freedoms.count()
}

fn pose_error_columns(robot: &Robot) -> Vec<Column> {
    let pairs: &[&str] = if has_ideal_pose(robot) {
        &["spring_from_ideal", "catenary_from_ideal", "spring_from_catenary"]
    } else {
        &["spring_from_catenary"]
    };
    let about = "distance of the platform origin between two static models at the same lengths";
    pairs
        .iter()
        .map(|pair| Column {
            name: format!("{pair}_distance_m"),
            unit: "m".into(),
            about: about.to_owned(),
            kind: Kind::Real,
        })
        .collect()
}

impl std::str::FromStr for Quantity {
    type Err = UnknownQuantity;

    fn from_str(text: &str) -> Result<Self, UnknownQuantity> {
        let text = text.trim();
        Self::named(text).ok_or_else(|| UnknownQuantity { name: text.to_owned(), hint: hint(text) })
    }
}

fn hint(text: &str) -> String {
    let head = text.split(':').next().unwrap_or(text);
    match head {
        "frequencies" => {
            return format!(": how many is a whole number from 1 to {MOST_FREQUENCIES}, as in frequencies:3");
        }
        "model-error" | "stiffness-error" if text.contains(':') => {
            let models: Vec<&str> =
                CableModel::ALL.iter().filter(|m| **m != CableModel::Exact).map(|m| m.name()).collect();
            return format!(": the model after the colon is one of {}", models.join(", "));
        }
        _ => {}
    }
    let names = QUANTITIES.map(|(name, _)| name);
    let heads = names.map(|name| name.split(':').next().unwrap_or(name));
    match nearest(head, heads).and_then(|near| names.into_iter().find(|name| name.split(':').next() == Some(near))) {
        Some(name) => format!("; did you mean `{name}`?"),
        None => format!("; there are {}", names.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_quantity_of_the_list_is_read_and_named_back() {
        for (name, _) in QUANTITIES {
            let name = name.replace(":N", ":7").replace(":MODEL", ":static-sag");
            assert_eq!(name.parse::<Quantity>().unwrap().name(), name);
        }
    }

    #[test]
    fn what_is_no_quantity_is_told_with_what_there_is() {
        for (name, says) in [
            ("first-freq", "did you mean `first-frequency`"),
            ("frequencies:0", "from 1 to 100"),
            ("frequencies:x", "from 1 to 100"),
            ("model-error:exact", "one of spring, static-sag, catenary-tangent, closed-form"),
            ("", "there are first-frequency"),
            ("é", "there are"),
        ] {
            let error = name.parse::<Quantity>().unwrap_err().to_string();
            assert!(error.contains(says), "{error}");
        }
    }
}

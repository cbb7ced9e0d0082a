//! Quantities of a map or sweep: one row of [`TABLE`] per quantity.
//!
//! A row holds everything about its quantity: name, description, text of docs/sweeps.md, requirements, columns and
//! values. Names, help texts, documentation and the evaluation of points read this table. No other code knows a
//! quantity.

use super::columns::{Column, ColumnKind, Value};
use super::evaluation::{PointEvaluation, has_ideal_pose};
use super::points::AXES;
use super::sensitivity::Sensitivity;
use crate::set_values;
use funicular::cable::{CableModel, Sag};
use funicular::math::rotation;
use funicular::robot::Robot;
use funicular::statics::{self, StaticModel, TensionRange};
use funicular::suggest::nearest;
use std::fmt;
use thiserror::Error;

/// Definition of one quantity.
struct Definition {
    /// Name, with the form of its parameter.
    name: &'static str,
    /// Description in one line.
    about: &'static str,
    /// Columns and their meaning, in the words of docs/sweeps.md.
    documentation: &'static str,
    takes: ParameterKind,
    needs: RequiredModel,
    /// Number of the lowest natural frequencies that it shows, with the cable model of the options.
    frequencies: fn(&Parameter) -> usize,
    columns: fn(&Robot, &Parameter) -> Vec<Column>,
    /// Function that adds the values of a point, one per column.
    values: fn(&mut PointEvaluation<'_>, &Parameter, &mut Vec<Value>),
}

/// Kind of parameter after the colon of a name.
enum ParameterKind {
    Nothing,
    /// Number from 1 to [`MAX_FREQUENCIES`].
    Count,
    /// Cable model other than `catenary-dynamic`, with the default for a name without a colon.
    Model(CableModel),
    /// Result and path of a number of the robot file.
    Sensitivity,
}

/// Static models for which a quantity exists.
enum RequiredModel {
    Anything,
    /// Models whose cables stretch.
    Elastic,
    Catenary,
    /// Any model, with at least as many cables as degrees of freedom.
    HeldPose,
}

/// Value of the parameter in a name.
#[derive(Debug, Clone, PartialEq)]
enum Parameter {
    None,
    Count(usize),
    Model(CableModel),
    Sensitivity(Sensitivity),
}

/// Maximum number of natural frequencies per point.
pub const MAX_FREQUENCIES: usize = 100;

/// Every quantity, in the order of the documentation.
static TABLE: [Definition; 24] = [
    Definition {
        name: "first-frequency",
        about: "lowest natural frequency",
        documentation: "`first_frequency_hz`: lowest natural frequency, undamped, with the requested cable model",
        takes: ParameterKind::Nothing,
        needs: RequiredModel::Anything,
        frequencies: |_| 1,
        columns: |_, _| one("first_frequency_hz", "Hz", "lowest natural frequency, undamped"),
        values: |row, _, out| row.frequencies(1, out),
    },
    Definition {
        name: "first-platform-frequency",
        about: "lowest natural frequency of a mode of the platform",
        documentation: "`first_platform_frequency_hz`: lowest natural frequency of a mode with at least \
                        `--platform-share` (0.5 if not given) of its kinetic energy in the platform, with the requested \
                        cable model; the modes below it are all found, however many they are",
        takes: ParameterKind::Nothing,
        needs: RequiredModel::Anything,
        frequencies: |_| 0,
        columns: |_, _| {
            one("first_platform_frequency_hz", "Hz", "lowest natural frequency of a mode of the platform, undamped")
        },
        values: |row, _, out| {
            let first = row.first_platform_frequency();
            row.push(Some(first), out);
        },
    },
    Definition {
        name: "first-kind",
        about: "kind of the first mode: platform, cable or mixed",
        documentation: "`first_kind`: kind of the first mode by kinetic energy: platform, cable or mixed",
        takes: ParameterKind::Nothing,
        needs: RequiredModel::Anything,
        frequencies: |_| 1,
        columns: |_, _| {
            let about = "kind of the first mode by kinetic energy: platform, cable or mixed";
            vec![Column { kind: ColumnKind::Text, ..column("first_kind".to_owned(), "", about) }]
        },
        values: |row, _, out| {
            let kind = row.modes().and_then(|modes| modes.first().map(|mode| mode.1));
            out.push(kind.map_or(Value::Nothing, |kind| Value::Text(kind.name().into())));
        },
    },
    Definition {
        name: "frequencies:N",
        about: "lowest N natural frequencies",
        documentation: "`frequency_1_hz` …: lowest N natural frequencies, ascending, undamped",
        takes: ParameterKind::Count,
        needs: RequiredModel::Anything,
        frequencies: Parameter::count,
        columns: |_, parameter| {
            let about = "natural frequency, ascending, undamped";
            (1..=parameter.count()).map(|i| column(format!("frequency_{i}_hz"), "Hz", about)).collect()
        },
        values: |row, parameter, out| row.frequencies(parameter.count(), out),
    },
    Definition {
        name: "tension-max",
        about: "maximum tension anywhere in a cable",
        documentation: "`tension_max_n`: maximum tension anywhere in any cable",
        takes: ParameterKind::Nothing,
        needs: RequiredModel::Anything,
        frequencies: |_| 0,
        columns: |_, _| one("tension_max_n", "N", "maximum tension anywhere in a cable"),
        values: |row, _, out| out.push(Value::real(row.tensions().map(|(_, max)| max).reduce(f64::max))),
    },
    Definition {
        name: "tension-max-cable",
        about: "name of the cable with the maximum tension",
        documentation: "`tension_max_cable`: name of the cable with the maximum tension; text",
        takes: ParameterKind::Nothing,
        needs: RequiredModel::Anything,
        frequencies: |_| 0,
        columns: |_, _| {
            let about = "name of the cable with the maximum tension anywhere";
            vec![Column { kind: ColumnKind::Text, ..column("tension_max_cable".to_owned(), "", about) }]
        },
        values: |row, _, out| {
            let mut tensions = row.tensions().map(|(_, max)| max).enumerate();
            let first = tensions.next();
            let tightest = first.map(|first| tensions.fold(first, |most, of| if of.1 > most.1 { of } else { most }));
            let name = tightest.map(|(i, _)| Value::Text(row.robot.cables[i].name.clone().into()));
            out.push(name.unwrap_or(Value::Nothing));
        },
    },
    Definition {
        name: "tension-min",
        about: "minimum tension anywhere in a cable",
        documentation: "`tension_min_n`: minimum tension anywhere in any cable",
        takes: ParameterKind::Nothing,
        needs: RequiredModel::Anything,
        frequencies: |_| 0,
        columns: |_, _| one("tension_min_n", "N", "minimum tension anywhere in a cable"),
        values: |row, _, out| out.push(Value::real(row.tensions().map(|(min, _)| min).reduce(f64::min))),
    },
    Definition {
        name: "tensions",
        about: "tension of every cable at its platform end",
        documentation: "`tension_platform_NAME_n`: tension of every cable at its platform end",
        takes: ParameterKind::Nothing,
        needs: RequiredModel::Anything,
        frequencies: |_| 0,
        columns: |robot, _| each_cable(robot, "tension_platform", "n", "N", "tension of a cable at its platform end"),
        values: |row, _, out| out.extend(row.rest.cables.iter().map(|cable| Value::real(Some(cable.tension_platform)))),
    },
    Definition {
        name: "exit-tensions",
        about: "tension of every cable where it leaves its anchor or pulley",
        documentation: "`tension_anchor_NAME_n`: tension of every cable at its anchor, over a pulley at the exit point",
        takes: ParameterKind::Nothing,
        needs: RequiredModel::Anything,
        frequencies: |_| 0,
        columns: |robot, _| each_cable(robot, "tension_anchor", "n", "N", "tension of a cable at its anchor"),
        values: |row, _, out| out.extend(row.rest.cables.iter().map(|cable| Value::real(Some(cable.tension_anchor)))),
    },
    Definition {
        name: "drum-tensions",
        about: "tension of every cable at its drum",
        documentation: "`tension_drum_NAME_n`: tension of every cable at its drum; without pulley and winch that at its \
                        anchor",
        takes: ParameterKind::Nothing,
        needs: RequiredModel::Anything,
        frequencies: |_| 0,
        columns: |robot, _| each_cable(robot, "tension_drum", "n", "N", "tension of a cable at its drum"),
        values: |row, _, out| out.extend(row.rest.cables.iter().map(|cable| Value::real(Some(cable.tension_drum())))),
    },
    Definition {
        name: "wrap-max",
        about: "maximum wrap angle on a pulley",
        documentation: "`wrap_max_deg`: maximum wrap angle of a cable on its pulley; empty without pulleys and with \
                        `ideal` cables",
        takes: ParameterKind::Nothing,
        needs: RequiredModel::Anything,
        frequencies: |_| 0,
        columns: |_, _| one("wrap_max_deg", "degrees", "maximum wrap angle on a pulley"),
        values: |row, _, out| {
            let wraps = row.rest.cables.iter().filter_map(|cable| cable.drive.as_ref()?.contact);
            out.push(Value::real(wraps.map(|contact| contact.wrap.to_degrees()).reduce(f64::max)));
        },
    },
    Definition {
        name: "lengths",
        about: "unstrained length of every cable",
        documentation: "`unstrained_length_NAME_m`: unstrained length of every cable",
        takes: ParameterKind::Nothing,
        needs: RequiredModel::Anything,
        frequencies: |_| 0,
        columns: |robot, _| each_cable(robot, "unstrained_length", "m", "m", "unstrained length of a cable"),
        values: |row, _, out| {
            out.extend(row.rest.cables.iter().map(|cable| Value::real(Some(cable.unstrained_length))));
        },
    },
    Definition {
        name: "tension-margin",
        about: "minimum distance of a tension from its limits, negative beyond them",
        documentation: "`tension_margin_n`: minimum distance of a tension from its limits (the limits that \
                        `--tension-rule` uses), negative beyond them",
        takes: ParameterKind::Nothing,
        needs: RequiredModel::Anything,
        frequencies: |_| 0,
        columns: |_, _| one("tension_margin_n", "N", "minimum distance of a tension from its limits"),
        values: |row, _, out| {
            let cables = row.rest.cables.iter().enumerate();
            let margins =
                cables.map(|(i, cable)| TensionRange::of(row.robot, i, &cable.chord_w()).margin(cable).distance());
            out.push(Value::real(margins.reduce(f64::min)));
        },
    },
    Definition {
        name: "payload-max",
        about: "maximum payload with tensions within their limits, and the limits that bind",
        documentation: "`payload_max_kg`: maximum mass in addition to the platform, with its centre at \
                        `--payload-center-m`, over all tensions within their limits, whatever the rule; `payload_limits`: \
                        cables at their limits then, as `1 maximum at anchor`",
        takes: ParameterKind::Nothing,
        needs: RequiredModel::HeldPose,
        frequencies: |_| 0,
        columns: |_, _| {
            let about = "cables at their limits with the maximum payload";
            vec![
                column("payload_max_kg".to_owned(), "kg", "maximum mass in addition to the platform"),
                Column { kind: ColumnKind::Text, ..column("payload_limits".to_owned(), "", about) },
            ]
        },
        values: |row, _, out| row.payload(out),
    },
    Definition {
        name: "stiffness-min",
        about: "minimum eigenvalue of the static stiffness, rotations scaled by the platform's size",
        documentation: "`stiffness_min_n_per_m`: minimum eigenvalue of the static stiffness, rotations scaled by the \
                        platform's size; in wind, of the symmetric part of the stiffness",
        takes: ParameterKind::Nothing,
        needs: RequiredModel::Elastic,
        frequencies: |_| 0,
        columns: |_, _| one("stiffness_min_n_per_m", "N/m", "minimum eigenvalue of the scaled static stiffness"),
        values: |row, _, out| {
            out.push(Value::real(row.rest.stability.min_stiffness()));
        },
    },
    Definition {
        name: "stiffness",
        about: "static stiffness along every coordinate, with the other coordinates free",
        documentation: "`stiffness_x_n_per_m` … `stiffness_rz_n_m_per_rad`: static stiffness along one coordinate \
                        while the platform is free to move along the others: 1/(K⁻¹)_ii of the 6×6 stiffness K, not its \
                        entry K_ii; in wind the drag turns with the cables",
        takes: ParameterKind::Nothing,
        needs: RequiredModel::Elastic,
        frequencies: |_| 0,
        columns: |robot, _| stiffness_columns(robot),
        values: |row, _, out| {
            let found = statics::stiffness_along_coordinates(row.robot, row.rest);
            let along = |k: usize| found.as_ref().map(|stiffness| stiffness[k]);
            out.extend((0..row.robot.platform.motion.count()).map(|k| Value::real(along(k))));
        },
    },
    Definition {
        name: "pose-error",
        about: "distances between the poses of ideal, spring and catenary cables with the same lengths",
        documentation: "`spring_from_ideal_distance_m`, `catenary_from_ideal_distance_m`, \
                        `spring_from_catenary_distance_m`: distances between the equilibrium positions of two static \
                        models. All models get the unstrained lengths of the catenaries. The first two columns need as \
                        many cables as degrees of freedom. A distance is empty if the other model has no equilibrium \
                        nearby, for example if all springs are slack",
        takes: ParameterKind::Nothing,
        needs: RequiredModel::Catenary,
        frequencies: |_| 0,
        columns: |robot, _| pose_error_columns(robot),
        values: |row, _, out| row.pose_error(out),
    },
    Definition {
        name: "sag-max",
        about: "maximum ratio of sag to chord",
        documentation: "`sag_ratio_max`: maximum ratio of sag to chord",
        takes: ParameterKind::Nothing,
        needs: RequiredModel::Anything,
        frequencies: |_| 0,
        columns: |_, _| one("sag_ratio_max", "1", "maximum ratio of sag to chord"),
        values: |row, _, out| {
            let sags = row.rest.cables.iter().enumerate().map(|(i, cable)| Sag::of(row.robot, i, cable));
            let ratios = sags.map(|sag| if sag.tension > 0.0 { sag.ratio() } else { f64::INFINITY });
            out.push(Value::real(ratios.reduce(f64::max)));
        },
    },
    Definition {
        name: "model-error:MODEL",
        about: "relative error of the first frequency with a simpler cable model",
        documentation: "`model_error_MODEL`: first frequency with a simpler cable model divided by the one with \
                        `catenary-dynamic`, minus one; without MODEL `shallow-dynamic`",
        takes: ParameterKind::Model(CableModel::ShallowDynamic),
        needs: RequiredModel::Catenary,
        frequencies: |_| 0,
        columns: |_, parameter| {
            let about = "first frequency with this cable model divided by the one with catenary-dynamic, minus one";
            vec![column(format!("model_error_{}", parameter.underscored()), "1", about)]
        },
        values: |row, parameter, out| {
            let error = parameter.model().map(|model| row.model_error(model));
            row.push(error, out);
        },
    },
    Definition {
        name: "stiffness-error:MODEL",
        about: "relative error of the minimum stiffness with a simpler cable model",
        documentation: "`stiffness_error_MODEL`: minimum static stiffness with a simpler cable model divided by the \
                        one with `catenary-static`, minus one; without MODEL `spring`",
        takes: ParameterKind::Model(CableModel::Spring),
        needs: RequiredModel::Catenary,
        frequencies: |_| 0,
        columns: |_, parameter| {
            let about =
                "minimum static stiffness with this cable model divided by the one with catenary-static, minus one";
            vec![column(format!("stiffness_error_{}", parameter.underscored()), "1", about)]
        },
        values: |row, parameter, out| {
            let error = parameter.model().map(|model| row.stiffness_error(model));
            row.push(error, out);
        },
    },
    Definition {
        name: "sensitivity:RESULT:PATH",
        about: "derivative of a result by a number of the robot file",
        documentation: "`first_frequency_hz_by_PATH`, `stiffness_min_n_per_m_by_PATH`, `tension_platform_NAME_n_by_PATH` or \
                        `unstrained_length_NAME_m_by_PATH`: derivative of `first-frequency`, `stiffness-min`, `tensions` or \
                        `lengths` by a number of the robot file, as in `sensitivity:first-frequency:platform.mass_kg`, in \
                        the unit of the result over that of the number. The lengths are held if the state gives them and \
                        with `--hold-lengths-of-pose`; otherwise the pose is held, and the tensions follow their rule",
        takes: ParameterKind::Sensitivity,
        needs: RequiredModel::Elastic,
        frequencies: |_| 0,
        columns: |robot, parameter| {
            parameter.sensitivity().map_or_else(Vec::new, |of| of.columns(&columns_of(of.result(), robot)))
        },
        values: |row, parameter, out| {
            if let Some(of) = parameter.sensitivity() {
                of.values(row, out);
            }
        },
    },
    Definition {
        name: "condition",
        about: "inverse condition number of the cables' directions: 0 at a singular pose, at most 1",
        documentation: "`inverse_condition`: minimum divided by maximum singular value of the cables' directions \
                        (moments divided by the platform's size); 0 at a singular pose",
        takes: ParameterKind::Nothing,
        needs: RequiredModel::Anything,
        frequencies: |_| 0,
        columns: |_, _| {
            one("inverse_condition", "1", "minimum divided by maximum singular value of the cables' scaled directions")
        },
        values: |row, _, out| out.push(Value::real(Some(statics::inverse_condition(row.robot, row.rest)))),
    },
    Definition {
        name: "energy",
        about: "potential energy of platform, load and cables",
        documentation: "`potential_energy_j`: potential energy of platform, load and cables, heights from the world's \
                        origin",
        takes: ParameterKind::Nothing,
        needs: RequiredModel::Anything,
        frequencies: |_| 0,
        columns: |_, _| one("potential_energy_j", "J", "potential energy of platform, load and cables"),
        values: |row, _, out| out.push(Value::real(Some(statics::energy(row.robot, row.rest)))),
    },
    Definition {
        name: "pose",
        about: "pose of the equilibrium",
        documentation: "`pose_x_m` … `pose_yaw_deg`: pose of the equilibrium, which a `sweep` from lengths computes",
        takes: ParameterKind::Nothing,
        needs: RequiredModel::Anything,
        frequencies: |_| 0,
        columns: |_, _| {
            let axes = AXES.iter().enumerate().map(|(i, axis)| (axis, if i < 3 { "m" } else { "deg" }));
            let about = "coordinate of the equilibrium pose, world axes, R = Rz Ry Rx";
            axes.map(|(axis, unit)| column(format!("pose_{axis}_{unit}"), unit, about)).collect()
        },
        values: |row, _, out| {
            let pose = &row.rest.pose;
            let angles = rotation::to_roll_pitch_yaw_deg(&pose.rot_wp);
            out.extend(pose.position_w.iter().chain(&angles).map(|value| Value::real(Some(*value))));
        },
    },
];

/// Quantity to compute at every point, given by its name; `frequencies:3` and `model-error:spring` have a parameter.
///
/// # Example
/// ```
/// use funicular_study::sweep::Quantity;
///
/// let quantity: Quantity = "frequencies:3".parse()?;
/// assert_eq!((quantity.name(), quantity.count()), ("frequencies:3".to_owned(), Some(3)));
/// let error = "tension-mx".parse::<Quantity>().unwrap_err();
/// assert_eq!(error.to_string(), "there is no quantity `tension-mx`; did you mean `tension-max`?");
/// # Ok::<(), funicular_study::sweep::UnknownQuantity>(())
/// ```
#[derive(Clone)]
pub struct Quantity {
    definition: &'static Definition,
    parameter: Parameter,
}

/// Error of a name that is not a quantity.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("there is no quantity `{name}`{hint}")]
pub struct UnknownQuantity {
    /// Name as given.
    pub name: String,
    /// End of the message: the nearest name, or all names.
    pub hint: String,
}

impl Quantity {
    /// Names of all quantities, with the form of their parameters, in the order of the documentation.
    pub fn names() -> impl Iterator<Item = &'static str> {
        TABLE.iter().map(|definition| definition.name)
    }

    /// Rows of a Markdown table of all quantities: name, description.
    pub fn documentation() -> String {
        let rows: Vec<String> = TABLE.iter().map(|of| format!("| `{}` | {} |\n", of.name, of.documentation)).collect();
        rows.concat()
    }

    /// Name with its parameter, also if the parameter is the default.
    pub fn name(&self) -> String {
        let head = self.definition.head();
        match &self.parameter {
            Parameter::None => head.to_owned(),
            Parameter::Count(count) => format!("{head}:{count}"),
            Parameter::Model(model) => format!("{head}:{model}"),
            Parameter::Sensitivity(of) => format!("{head}:{}", of.name()),
        }
    }

    /// Description in one line.
    pub fn about(&self) -> &'static str {
        self.definition.about
    }

    /// Number of values, if the name contains it: 3 for `frequencies:3`.
    pub fn count(&self) -> Option<usize> {
        match self.parameter {
            Parameter::Count(count) => Some(count),
            Parameter::None | Parameter::Model(_) | Parameter::Sensitivity(_) => None,
        }
    }

    /// Path of the number of the robot file by which it differentiates.
    pub(crate) fn path(&self) -> Option<&set_values::Path> {
        self.parameter.sensitivity().map(Sensitivity::path)
    }

    /// Columns of the quantity for a robot.
    pub fn columns(&self, robot: &Robot) -> Vec<Column> {
        (self.definition.columns)(robot, &self.parameter)
    }

    /// Number of the lowest natural frequencies that it shows, with the cable model of the options.
    pub(super) fn frequencies(&self) -> usize {
        (self.definition.frequencies)(&self.parameter)
    }

    /// True if it does not exist for a static model.
    pub(super) fn excludes(&self, model: StaticModel) -> bool {
        match self.definition.needs {
            RequiredModel::Anything | RequiredModel::HeldPose => false,
            RequiredModel::Elastic => model == StaticModel::Ideal,
            RequiredModel::Catenary => model != StaticModel::Catenary,
        }
    }

    /// True if it does not exist for a robot with so few cables.
    pub(super) fn needs_more_cables(&self, robot: &Robot) -> bool {
        matches!(self.definition.needs, RequiredModel::HeldPose) && robot.cables.len() < robot.platform.motion.count()
    }

    /// Adds the values of the quantity at a point.
    pub(super) fn values(&self, row: &mut PointEvaluation<'_>, out: &mut Vec<Value>) {
        (self.definition.values)(row, &self.parameter, out);
    }
}

impl PartialEq for Quantity {
    fn eq(&self, other: &Self) -> bool {
        self.definition.name == other.definition.name && self.parameter == other.parameter
    }
}

impl fmt::Debug for Quantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Quantity({})", self.name())
    }
}

impl Definition {
    /// Name without its parameter.
    fn head(&self) -> &'static str {
        self.name.split(':').next().unwrap_or(self.name)
    }

    /// Parameter after the colon of a name; `None` if this quantity has no such parameter.
    fn parameter(&self, text: Option<&str>) -> Option<Parameter> {
        match (&self.takes, text) {
            (ParameterKind::Nothing, None) => Some(Parameter::None),
            (ParameterKind::Count, Some(text)) => {
                let count = text.parse().ok().filter(|count| (1..=MAX_FREQUENCIES).contains(count));
                count.map(Parameter::Count)
            }
            (ParameterKind::Model(default), None) => Some(Parameter::Model(*default)),
            (ParameterKind::Model(_), Some(text)) => {
                simpler_models().find(|model| model.name() == text).map(Parameter::Model)
            }
            (ParameterKind::Sensitivity, Some(text)) => Sensitivity::parse(text).map(Parameter::Sensitivity),
            (ParameterKind::Nothing, Some(_)) | (ParameterKind::Count | ParameterKind::Sensitivity, None) => None,
        }
    }
}

impl Parameter {
    fn count(&self) -> usize {
        match self {
            Self::Count(count) => *count,
            Self::None | Self::Model(_) | Self::Sensitivity(_) => 0,
        }
    }

    fn model(&self) -> Option<CableModel> {
        match self {
            Self::Model(model) => Some(*model),
            Self::None | Self::Count(_) | Self::Sensitivity(_) => None,
        }
    }

    fn sensitivity(&self) -> Option<&Sensitivity> {
        match self {
            Self::Sensitivity(of) => Some(of),
            Self::None | Self::Count(_) | Self::Model(_) => None,
        }
    }

    /// Name of the model in the form that is used in names of columns.
    fn underscored(&self) -> String {
        self.model().map_or_else(String::new, |model| model.name().replace('-', "_"))
    }
}

/// Cable models that are compared with `catenary-dynamic`.
fn simpler_models() -> impl Iterator<Item = CableModel> {
    CableModel::ALL.into_iter().filter(|model| *model != CableModel::CatenaryDynamic)
}

impl std::str::FromStr for Quantity {
    type Err = UnknownQuantity;

    fn from_str(text: &str) -> Result<Self, UnknownQuantity> {
        let text = text.trim();
        let (head, parameter) = match text.split_once(':') {
            Some((head, parameter)) => (head, Some(parameter)),
            None => (text, None),
        };
        TABLE
            .iter()
            .find(|definition| definition.head() == head)
            .and_then(|definition| Some(Self { definition, parameter: definition.parameter(parameter)? }))
            .ok_or_else(|| UnknownQuantity { name: text.to_owned(), hint: hint(text) })
    }
}

fn hint(text: &str) -> String {
    let head = text.split(':').next().unwrap_or(text);
    match TABLE.iter().find(|definition| definition.head() == head).map(|definition| &definition.takes) {
        Some(ParameterKind::Count) => {
            return format!(": give a whole number from 1 to {MAX_FREQUENCIES} after the colon, as in {head}:3");
        }
        Some(ParameterKind::Sensitivity) => return Sensitivity::hint(text),
        Some(ParameterKind::Model(_)) if text.contains(':') => {
            let models: Vec<&str> = simpler_models().map(CableModel::name).collect();
            let parameter = text.split_once(':').map_or("", |(_, parameter)| parameter);
            if let Some(near) = nearest(parameter, models.iter().copied()) {
                return format!("; did you mean `{head}:{near}`?");
            }
            return format!(": the model after the colon is one of {}", models.join(", "));
        }
        _ => {}
    }
    let near = nearest(head, TABLE.iter().map(Definition::head));
    match near.and_then(|near| TABLE.iter().find(|definition| definition.head() == near)) {
        Some(definition) => format!("; did you mean `{}`?", definition.name),
        None => format!("; there are {}", Quantity::names().collect::<Vec<_>>().join(", ")),
    }
}

/// Columns of the quantity with this name.
fn columns_of(name: &str, robot: &Robot) -> Vec<Column> {
    let quantity = name.parse::<Quantity>();
    quantity.map_or_else(|_| Vec::new(), |quantity| quantity.columns(robot))
}

/// Column of numbers.
fn column(name: String, unit: &'static str, about: &str) -> Column {
    Column { name, unit: unit.into(), about: about.to_owned(), kind: ColumnKind::Real }
}

/// Single column of numbers.
fn one(name: &str, unit: &'static str, about: &str) -> Vec<Column> {
    vec![column(name.to_owned(), unit, about)]
}

/// Columns of numbers, one per cable.
fn each_cable(robot: &Robot, prefix: &str, suffix: &str, unit: &'static str, about: &str) -> Vec<Column> {
    robot.cables.iter().map(|cable| column(format!("{prefix}_{}_{suffix}", cable.name), unit, about)).collect()
}

fn stiffness_columns(robot: &Robot) -> Vec<Column> {
    let motion = &robot.platform.motion;
    let about = "load along this coordinate divided by the motion along it, with all other coordinates free";
    let names = motion.coordinate_names().iter().enumerate();
    names
        .map(|(k, name)| {
            let (suffix, unit) = if motion.is_rotation(k) { ("n_m_per_rad", "N m/rad") } else { ("n_per_m", "N/m") };
            column(format!("stiffness_{name}_{suffix}"), unit, about)
        })
        .collect()
}

fn pose_error_columns(robot: &Robot) -> Vec<Column> {
    let pairs: &[&str] = if has_ideal_pose(robot) {
        &["spring_from_ideal", "catenary_from_ideal", "spring_from_catenary"]
    } else {
        &["spring_from_catenary"]
    };
    let about = "distance between the platform origins of two static models at the same lengths";
    pairs.iter().map(|pair| column(format!("{pair}_distance_m"), "m", about)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_quantity_of_the_table_is_read_and_named_back() {
        for name in Quantity::names() {
            let name = name.replace(":N", ":7").replace(":MODEL", ":shallow-static");
            let name = name.replace(":RESULT:PATH", ":stiffness-min:cables.1.anchor_m.z");
            let quantity: Quantity = name.parse().unwrap();
            assert_eq!(quantity.name(), name);
            assert!(!quantity.about().is_empty());
        }
        for (short, full) in
            [("model-error", "model-error:shallow-dynamic"), ("stiffness-error", "stiffness-error:spring")]
        {
            assert_eq!(short.parse::<Quantity>().unwrap().name(), full);
        }
    }

    #[test]
    fn the_documentation_has_the_rows_of_the_table() {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/sweeps.md");
        let page = std::fs::read_to_string(file).expect("the repository has the file");
        let (_, behind) = page.split_once("| `--quantity` | Columns |\n|---|---|\n").unwrap();
        let (rows, _) = behind.split_once("\n\n").unwrap();
        assert_eq!(format!("{rows}\n"), Quantity::documentation(), "docs/sweeps.md, Quantities");
    }

    #[test]
    fn an_unknown_quantity_is_answered_with_the_known_ones() {
        for (name, says) in [
            ("first-freq", "did you mean `first-frequency`"),
            ("frequencies:0", "from 1 to 100"),
            ("frequencies:x", "from 1 to 100"),
            ("frequencies", "as in frequencies:3"),
            ("tension-max:3", "did you mean `tension-max`"),
            ("model-error:exact", "one of spring, shallow-static, catenary-static, shallow-dynamic"),
            ("sensitivity", "as in sensitivity:first-frequency:platform.mass_kg"),
            ("sensitivity:tension:platform.mass_kg", "did you mean `sensitivity:tensions:platform.mass_kg`"),
            ("sensitivity:tensions:platform mass", "as in sensitivity:first-frequency:platform.mass_kg"),
            ("", "there are first-frequency"),
            ("é", "there are"),
        ] {
            let error = name.parse::<Quantity>().unwrap_err().to_string();
            assert!(error.contains(says), "{error}");
        }
    }
}

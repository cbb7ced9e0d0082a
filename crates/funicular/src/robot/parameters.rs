//! Every number of a robot file as a parameter, with its place, unit, range, meaning and value; and robots with other
//! values of these parameters.
//!
//! Keys, units and ranges come from the table by which the reader checks robot files. A robot with other values is read
//! from the same parsed file with the numbers of the text replaced. So every check of the reader applies, and no number
//! passes through text.

use super::spec::key::{Absent, Component, Key, KeyValue, Numeric, Shape};
use super::spec::{Numbers, SpecError, TABLES, TOP, from_tree, parsed};
use super::{GuideWheelChange, PlatformMotion, Pulley, Robot, RobotChange, RopeSection, SupportChange};
use crate::math::{Mat3, Vec3, Vec6, rotation};
use std::borrow::Cow;
use std::f64::consts::TAU;
use thiserror::Error;
use toml::Spanned;
use toml::de::{DeArray, DeFloat, DeTable, DeValue};

pub use super::spec::range::Range;

/// Part of the robot that a parameter belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RobotPart {
    /// The robot itself: gravity.
    Robot,
    /// The platform.
    Platform,
    /// A rope; its name is the second key of the path.
    Material,
    /// A pulley; its name is the second key of the path.
    Pulley,
    /// A winch; its name is the second key of the path.
    Winch,
    /// A guide wheel; its name is the second key of the path.
    GuideWheel,
    /// A flexible support of anchors; its name is the second key of the path.
    Support,
    /// The cable at this index in file order, from 0.
    Cable(usize),
    /// The load on the platform.
    Load,
    /// The wind.
    Wind,
    /// The pose.
    State,
}

/// One number of a robot file.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameter {
    /// Keys from the top of the file to the number, the name of the component last: `cables`, `3`, `anchor_m`, `z`.
    pub keys: Vec<String>,
    /// Part of the robot that the parameter belongs to.
    pub part: RobotPart,
    /// Key in the table of this part.
    pub key: &'static str,
    /// Component of a vector or tensor: `x`, `y`, `z`; `roll`, `pitch`, `yaw`; `xx`, `yy`, `zz`, `xy`, `xz`, `yz`.
    pub component: Option<&'static str>,
    /// Value, in the unit of the file.
    pub value: f64,
    /// Unit, SI apart from degrees; `1` for a ratio.
    pub unit: &'static str,
    /// Range of the value. A value within it may still be refused together with the robot's other values, as a minimum
    /// above a maximum.
    pub range: Range,
    /// Meaning.
    pub about: &'static str,
    /// True if the file gives the value; otherwise the value is the default.
    pub given: bool,
    /// First byte of the number in the text, for each place where it stands.
    places: Vec<usize>,
}

impl Parameter {
    /// Path by which a command changes the parameter: keys separated by dots, quoted if they contain other characters
    /// than letters, digits, _ and -.
    pub fn path(&self) -> String {
        let bare =
            |key: &str| !key.is_empty() && key.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-');
        let quoted = |key: &String| match key {
            key if bare(key) => key.clone(),
            key if !key.contains('\'') => format!("'{key}'"),
            key => format!("\"{}\"", key.replace('\\', "\\\\").replace('"', "\\\"")),
        };
        self.keys.iter().map(quoted).collect::<Vec<_>>().join(".")
    }
}

/// Reason why a robot cannot have other values.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ParameterError {
    /// Index beyond the end of the list of parameters.
    #[error("there is no parameter number {index}, the robot has {count}")]
    Unknown {
        /// Requested index.
        index: usize,
        /// Number of parameters.
        count: usize,
    },
    /// The value is a default: the file has no place for another one.
    #[error("the robot file does not give {path}: write it there first")]
    NotGiven {
        /// Path of the parameter.
        path: String,
    },
    /// The reader refuses the resulting robot.
    #[error("with {}: {}", changes.join(" and "), first_message(reason))]
    Refused {
        /// Each change, as `path=value`.
        changes: Vec<String>,
        /// Issues found by the reader. They point into the original text, at the values that were replaced.
        reason: SpecError,
    },
}

/// First issue without its line, because the text there holds another value.
fn first_message(reason: &SpecError) -> String {
    reason.issues().first().map_or_else(String::new, |issue| match &issue.help {
        Some(help) => format!("{}; {help}", issue.message),
        None => issue.message.clone(),
    })
}

/// Numbers of a robot file, and robots with other values of these numbers.
///
/// # Example
/// ```
/// use funicular::robot::parameters::Parameters;
///
/// let parameters = Parameters::from_toml(funicular_robots::COGIRO)?;
/// let mass = parameters.find(&["platform", "mass_kg"]).unwrap();
/// assert_eq!(parameters.list()[mass].unit, "kg");
///
/// let heavier = parameters.robot_with(&[(mass, 300.0)])?;
/// assert_eq!(heavier.platform.mass, 300.0); // kg
/// let refused = parameters.robot_with(&[(mass, -1.0)]).unwrap_err();
/// assert_eq!(refused.to_string(), "with platform.mass_kg=-1: `mass_kg` is -1.0, it must be positive");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct Parameters {
    text: String,
    /// Values of the file by key, with their places in the text. The numbers in this tree are placeholders.
    root: DeTable<'static>,
    /// First byte of every number in the text, in ascending order, with the number.
    numbers: Vec<(usize, f64)>,
    robot: Robot,
    list: Vec<Parameter>,
}

impl Parameters {
    /// Reads a robot file and lists its numbers.
    ///
    /// # Errors
    /// [`SpecError`], as [`Robot::from_toml`].
    pub fn from_toml(text: &str) -> Result<Self, SpecError> {
        let robot = Robot::from_toml(text)?;
        // `Robot::from_toml` has just parsed the same text.
        let borrowed = DeTable::parse(text).map(Spanned::into_inner).unwrap_or_default();
        let list = list_of(&borrowed, &robot);

        let mut numbers = Vec::new();
        let root = owned_table(&borrowed, &mut numbers);
        numbers.sort_unstable_by_key(|(place, _)| *place);
        Ok(Self { text: text.to_owned(), root, numbers, robot, list })
    }

    /// Robot with the values of the file.
    pub fn robot(&self) -> &Robot {
        &self.robot
    }

    /// All numbers, in this order: gravity, platform, ropes by name, cables in file order, load, wind, pose.
    pub fn list(&self) -> &[Parameter] {
        &self.list
    }

    /// Index in the list of the parameter at a path. A component is named, as in `anchor_m`, `z`, or numbered from 0,
    /// as in `anchor_m`, `2` and `inertia_kg_m2`, `0`, `1`.
    pub fn find<K: AsRef<str>>(&self, path: &[K]) -> Option<usize> {
        let path: Vec<&str> = path.iter().map(AsRef::as_ref).collect();
        let (key, of_key) = key_of(&path)?;
        let shape = key.numeric_value()?.shape;
        let (own, rest) = path.split_at(of_key);
        let at_key = |parameter: &&Parameter| parameter.keys.len() >= of_key && parameter.keys[..of_key] == *own;
        let place = match (shape.place(rest), rest) {
            (None, []) => None,
            (None, _) => return None,
            // One index of a tensor is a principal moment; in a tensor with rows it is a row.
            (Some(Component::Element(i)), _) if shape == Shape::Tensor => {
                if self.list.iter().filter(at_key).any(|other| other.component == Some("xy")) {
                    return None;
                }
                Some(Component::Entry(i, i))
            }
            (place, _) => place,
        };
        self.list.iter().position(|parameter| {
            let named = parameter.component.and_then(|name| shape.place(&[name]));
            at_key(&parameter) && named == place
        })
    }

    /// Robot with other values, given as pairs of the index in [`Self::list`] and the number in the unit of the file.
    /// The result is the robot that [`Robot::from_toml`] would read from the text with these numbers written in it.
    ///
    /// # Errors
    /// [`ParameterError`].
    pub fn robot_with(&self, values: &[(usize, f64)]) -> Result<Robot, ParameterError> {
        let (mut numbers, mut changed) = (self.numbers.clone(), Vec::with_capacity(values.len()));
        for &(index, value) in values {
            let count = self.list.len();
            let parameter = self.list.get(index).ok_or(ParameterError::Unknown { index, count })?;
            if parameter.places.is_empty() {
                return Err(ParameterError::NotGiven { path: parameter.path() });
            }
            for &place in &parameter.places {
                if let Ok(at) = numbers.binary_search_by_key(&place, |(start, _)| *start) {
                    numbers[at].1 = value;
                    changed.push(place);
                }
            }
        }

        let numbers = Numbers { values: &numbers, changed: &changed };
        from_tree(&self.text, &self.root, numbers).map_err(|reason| {
            let changes = values.iter().map(|&(index, value)| format!("{}={value}", self.list[index].path())).collect();
            ParameterError::Refused { changes, reason }
        })
    }
}

impl Parameters {
    /// Change of the robot per unit of a parameter, in the unit of the file: the direction for derivatives of results
    /// with respect to the parameter. A value of a rope changes all its cables, an angle of the pose turns the platform.
    /// `None` for numbers without derivatives: limits, the plane of a planar platform and angles that leave it, and friction of
    /// pulleys.
    ///
    /// # Example
    /// ```
    /// use funicular::robot::parameters::Parameters;
    ///
    /// let parameters = Parameters::from_toml(funicular_robots::COGIRO)?;
    /// let height = parameters.find(&["cables", "1", "anchor_m", "z"]).unwrap();
    /// assert_eq!(parameters.change(height).unwrap().cables[0].anchor_w.z, 1.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn change(&self, index: usize) -> Option<RobotChange> {
        self.change_of(index, &self.robot)
    }

    /// Change per unit of a parameter as [`Self::change`], of a robot that has been changed since it was read, such as by
    /// another pose.
    pub fn change_of(&self, index: usize, robot: &Robot) -> Option<RobotChange> {
        let parameter = self.list.get(index)?;
        let mut change = RobotChange::none(robot.cables.len());

        let unit = || -> Option<Vec3> {
            let axis = ["x", "y", "z"].iter().position(|name| Some(*name) == parameter.component)?;
            let mut unit = Vec3::zeros();
            unit[axis] = 1.0;
            Some(unit)
        };

        match (parameter.part, parameter.key) {
            (RobotPart::Robot, "gravity_m_s2") => change.gravity_w = unit()?,
            (RobotPart::Platform, "mass_kg") => change.mass = 1.0,
            (RobotPart::Platform, "center_of_mass_m") => change.center_of_mass_p = unit()?,
            (RobotPart::Platform, "drag_area_m2") => change.drag_area = 1.0,
            (RobotPart::Platform, "inertia_kg_m2") => match (parameter.component, &robot.platform.motion) {
                // A single number is the moment about the normal.
                (None, PlatformMotion::Planar(plane)) => {
                    change.inertia_p = plane.normal_w() * plane.normal_w().transpose();
                }
                (component, _) => change.inertia_p = tensor_entry(component)?,
            },
            (RobotPart::Platform, "translational_damping_n_s_m") => change.translational_damping_p = unit()?,
            (RobotPart::Platform, "rotational_damping_n_m_s") => change.rotational_damping_p = unit()?,
            (RobotPart::Wind, "velocity_m_s") => change.wind_velocity_w = unit()?,
            (RobotPart::Wind, "air_density_kg_m3") => change.air_density = 1.0,
            (RobotPart::State, key) => pose_change(robot, parameter, key, unit(), &mut change)?,
            (RobotPart::Load, "force_n") => change.force_w = unit()?,
            (RobotPart::Load, "moment_n_m") => change.moment_w = unit()?,
            (RobotPart::Load, "point_m") => change.point_p = unit()?,
            (RobotPart::Cable(i), key) => {
                let cable = change.cables.get_mut(i)?;
                match key {
                    "anchor_m" => cable.anchor_w = unit()?,
                    "attachment_m" => cable.attachment_p = unit()?,
                    "load_n_per_m" => cable.load_per_length_w = unit()?,
                    "unstrained_length_m" => cable.unstrained_length = 1.0,
                    "entry_direction" => {
                        let pulley = robot.cables[i].anchor.pulley.as_ref()?;
                        cable.pulley.entry_direction_w = self.direction_change(parameter, pulley, &unit()?)?;
                    }
                    _ => return None,
                }
            }
            (RobotPart::Pulley, key) => self.pulley_change(robot, parameter, key, unit(), &mut change)?,
            (RobotPart::Winch, key) => self.winch_change(robot, parameter, key, &mut change)?,
            (RobotPart::GuideWheel, key) => self.guide_wheel_change(robot, parameter, key, &mut change)?,
            (RobotPart::Material, key) => self.material_change(parameter, key, unit(), &mut change)?,
            (RobotPart::Support, key) => support_change(robot, parameter, key, &mut change)?,
            _ => return None,
        }

        Some(change)
    }

    /// Change of the unit vector of a pulley with a component of a vector of any length.
    fn direction_change(&self, parameter: &Parameter, pulley: &Pulley, unit: &Vec3) -> Option<Vec3> {
        let (_, vector) = parameter.keys.split_last()?;
        let components = self.list.iter().filter(|other| other.keys.split_last().is_some_and(|(_, of)| of == vector));
        let length = components.map(|other| other.value * other.value).sum::<f64>().sqrt();
        let direction_w = &pulley.entry_direction_w;
        Some((unit - direction_w * direction_w.dot(unit)) / length)
    }

    /// Change of all cables over a pulley.
    fn pulley_change(
        &self,
        robot: &Robot,
        parameter: &Parameter,
        key: &str,
        unit: Option<Vec3>,
        change: &mut RobotChange,
    ) -> Option<()> {
        let name = parameter.keys.get(1)?;
        for (i, (cable, change)) in robot.cables.iter().zip(&mut change.cables).enumerate() {
            let Some(pulley) = cable.anchor.pulley.as_ref().filter(|pulley| pulley.name == *name) else { continue };
            let change = &mut change.pulley;
            match key {
                "radius_m" => change.radius = 1.0,
                "inertia_kg_m2" => change.inertia = 1.0,
                "swivel_inertia_kg_m2" => change.swivel_inertia = 1.0,
                "entry_direction" => {
                    let own = |other: &Parameter| other.part == RobotPart::Cable(i) && other.key == "entry_direction";
                    if !self.list.iter().any(own) {
                        change.entry_direction_w = self.direction_change(parameter, pulley, &unit?)?;
                    }
                }
                _ => return None,
            }
        }
        Some(())
    }

    /// Change of all cables to a winch. At the cable, numbers about the axis of the drum count by the square of its radius.
    fn winch_change(&self, robot: &Robot, parameter: &Parameter, key: &str, change: &mut RobotChange) -> Option<()> {
        let name = parameter.keys.get(1)?;
        let value_of = |key: &str| {
            let of_winch = |other: &&Parameter| other.part == RobotPart::Winch && other.keys.get(1) == Some(name);
            self.list.iter().filter(of_winch).find(|other| other.key == key).map(|other| other.value)
        };
        // Without a radius no other number of the winch is about the axis.
        let by_radius = value_of("drum_radius_m").map_or(0.0, |radius| radius.powi(-2));
        let bandwidth = value_of("bandwidth_hz");
        let ratio = value_of("gear_ratio").unwrap_or(1.0);

        for (cable, change) in robot.cables.iter().zip(&mut change.cables) {
            let Some(winch) = cable.anchor.winch.as_ref().filter(|winch| winch.name == *name) else { continue };
            let (mass, servo) = (winch.drum_mass + winch.motor_mass, winch.servo());
            let change = &mut change.winch;
            match key {
                "drum_side_length_m" => change.drum_side_length = 1.0,
                "stiffness_n_per_m" => change.stiffness = 1.0,
                "shaft_stiffness_n_m_per_rad" => change.stiffness = by_radius,
                "drum_inertia_kg_m2" => change.drum_mass = by_radius,
                "motor_inertia_kg_m2" => change.motor_mass = by_radius * ratio * ratio,
                "gear_ratio" => change.motor_mass = 2.0 * winch.motor_mass / ratio,
                "damping_n_m_s_per_rad" => change.damping = by_radius,
                "drum_radius_m" => {
                    let per_metre = -2.0 / parameter.value;
                    change.drum_mass = per_metre * winch.drum_mass;
                    change.motor_mass = per_metre * winch.motor_mass;
                    change.damping = per_metre * winch.damping;
                    if value_of("shaft_stiffness_n_m_per_rad").is_some() {
                        change.stiffness = per_metre * winch.stiffness;
                    }
                    if let (Some(servo), None) = (servo, bandwidth) {
                        change.position_gain = per_metre * servo.position_gain;
                        change.speed_gain = per_metre * servo.speed_gain;
                    }
                }
                "bandwidth_hz" => {
                    change.position_gain = 2.0 * servo?.position_gain / parameter.value;
                    change.speed_gain = servo?.speed_gain / parameter.value;
                }
                "control_damping_ratio" => change.speed_gain = 2.0 * mass * bandwidth? * TAU,
                "position_gain_n_m_per_rad" => change.position_gain = by_radius,
                "speed_gain_n_m_s_per_rad" => change.speed_gain = by_radius,
                "delay_s" => change.delay = 1.0,
                _ => return None,
            }

            // Gains by the bandwidth are proportional to the mass.
            if let (Some(servo), Some(_)) = (servo, bandwidth) {
                let relative = (change.drum_mass + change.motor_mass) / mass;
                change.position_gain += relative * servo.position_gain;
                change.speed_gain += relative * servo.speed_gain;
            }
        }
        Some(())
    }

    /// Change of a guide wheel of all cables to its winch.
    fn guide_wheel_change(
        &self,
        robot: &Robot,
        parameter: &Parameter,
        key: &str,
        change: &mut RobotChange,
    ) -> Option<()> {
        let name = parameter.keys.get(1)?;
        let radius = self.list.iter().find(|other| {
            other.part == RobotPart::GuideWheel && other.keys.get(1) == Some(name) && other.key == "radius_m"
        })?;
        let mut is_known = false;
        for (cable, change) in robot.cables.iter().zip(&mut change.cables) {
            let wheels = cable.anchor.winch.as_ref().map_or(&[][..], |winch| &winch.guide_wheels);
            let Some(index) = wheels.iter().position(|wheel| wheel.name == *name) else { continue };
            is_known = true;
            change.guide_wheels.resize(wheels.len(), GuideWheelChange::default());
            let (wheel, change) = (&wheels[index], &mut change.guide_wheels[index]);
            match key {
                "distance_m" => change.distance = 1.0,
                "radius_m" => change.mass = -2.0 * wheel.mass / radius.value,
                "inertia_kg_m2" => change.mass = radius.value.powi(-2),
                _ => return None,
            }
        }
        is_known.then_some(())
    }

    /// Change of all cables made of a rope.
    fn material_change(
        &self,
        parameter: &Parameter,
        key: &str,
        unit: Option<Vec3>,
        change: &mut RobotChange,
    ) -> Option<()> {
        let name = parameter.keys.get(1)?;
        let same_rope = |other: &Parameter| other.part == RobotPart::Material && other.keys.get(1) == Some(name);
        for (i, (cable, change)) in self.robot.cables.iter().zip(&mut change.cables).enumerate() {
            let material = &cable.material;
            if material.name != *name {
                continue;
            }
            let relative = material.axial_stiffness / parameter.value;
            match key {
                "axial_stiffness_n" => change.axial_stiffness = 1.0,
                "youngs_modulus_pa" | "area_m2" => change.axial_stiffness = relative,
                // The drag depends on the diameter, too, unless it has its own.
                "diameter_m" => {
                    let own_drag = self.list.iter().any(|other| other.key == "drag_diameter_m" && same_rope(other));
                    if !own_drag {
                        change.drag_width = material.drag_width.unwrap_or(0.0) / parameter.value;
                    }
                    if matches!(material.dimensions.section, Some(RopeSection::Diameter(_))) {
                        change.axial_stiffness = 2.0 * relative;
                    }
                }
                "drag_coefficient" => match material.dimensions.drag_diameter {
                    Some(diameter) => change.drag_width = diameter,
                    None => return None,
                },
                "drag_diameter_m" => change.drag_width = material.drag_width? / parameter.value,
                "damping_ratio" | "viscous_damping_n_s_m2" => change.damping = 1.0,
                "mass_kg_per_m" => change.mass_per_length = 1.0,
                "load_n_per_m" => {
                    let own = |other: &Parameter| other.part == RobotPart::Cable(i) && other.key == "load_n_per_m";
                    if !self.list.iter().any(own) {
                        change.load_per_length_w = unit?;
                    }
                }
                _ => return None,
            }
        }
        Some(())
    }
}

/// Symmetric tensor whose entry with this name is 1.
fn tensor_entry(component: Option<&str>) -> Option<Mat3> {
    let entry = Shape::Tensor.components().iter().find(|(name, _)| Some(*name) == component)?.1;
    let Component::Entry(i, j) = entry else { return None };
    let mut tensor = Mat3::zeros();
    (tensor[(i, j)], tensor[(j, i)]) = (1.0, 1.0);
    Some(tensor)
}

/// Change of a flexible support.
fn support_change(robot: &Robot, parameter: &Parameter, key: &str, change: &mut RobotChange) -> Option<()> {
    let name = parameter.keys.get(1)?;
    let index = robot.supports.iter().position(|support| support.name == *name)?;
    change.supports.resize(robot.supports.len(), SupportChange::default());
    let change = &mut change.supports[index];
    match (key, parameter.component) {
        // A single number is the stiffness in all directions.
        ("stiffness_n_per_m", None) => change.stiffness_w = Mat3::identity(),
        ("stiffness_n_per_m", component) => change.stiffness_w = tensor_entry(component)?,
        ("mass_kg", _) => change.mass = 1.0,
        ("damping_ratio", _) => change.damping_ratio = 1.0,
        _ => return None,
    }
    Some(())
}

/// Change of the pose that the state gives. Motions that the platform does not have are no changes.
fn pose_change(
    robot: &Robot,
    parameter: &Parameter,
    key: &str,
    unit: Option<Vec3>,
    change: &mut RobotChange,
) -> Option<()> {
    match key {
        "position_m" => change.position_w = unit?,
        // R = Rz(yaw) Ry(pitch) Rx(roll): each angle turns about the axis of its rotation, after those left of it.
        "roll_pitch_yaw_deg" => {
            let [_, pitch, yaw] = robot.written_angles_deg;
            let axis_w = match parameter.component? {
                "roll" => rotation::from_roll_pitch_yaw_deg(0.0, pitch, yaw) * Vec3::x(),
                "pitch" => rotation::from_roll_pitch_yaw_deg(0.0, 0.0, yaw) * Vec3::y(),
                "yaw" => Vec3::z(),
                _ => return None,
            };
            change.rotation_w = axis_w * 1_f64.to_radians();
        }
        _ => return None,
    }

    let (v, turn) = (change.position_w, change.rotation_w);
    let motion = Vec6::new(v.x, v.y, v.z, turn.x, turn.y, turn.z);
    let beyond = motion - robot.platform.motion.allowed(&motion);
    // Rounding of the axes is 1e-16.
    (beyond.norm() <= 1e-12 * motion.norm()).then_some(())
}

/// Key of the table at the beginning of a path, and the number of the path's keys up to it. The rest of the path names
/// a component.
fn key_of(path: &[&str]) -> Option<(&'static Key, usize)> {
    (1..=path.len()).rev().find_map(|count| {
        let (header, key) = match path[..count] {
            [key] => (TOP.to_owned(), key),
            [kind @ ("materials" | "pulleys" | "winches" | "guide_wheels" | "supports"), _, key] => {
                (format!("[{kind}.NAME]"), key)
            }
            ["cables", _, key] => ("[[cables]]".to_owned(), key),
            [table, key] => (format!("[{table}]"), key),
            _ => return None,
        };
        let table = TABLES.iter().find(|table| table.header == header)?;
        table.keys.iter().find(|known| known.name == key).map(|key| (key, count))
    })
}

/// Key that holds numbers, at the beginning of a path, and the rest of the path.
fn numbers_of<'p>(path: &'p [&'p str]) -> Option<(&'static Key, &'static Numeric, &'p [&'p str])> {
    let (key, count) = key_of(path)?;
    let KeyValue::Numbers(numbers) = &key.value else { return None };
    Some((key, numbers, &path[count..]))
}

/// Component that the end of a path names, by its name or its index from 0; `None` for a path that ends at a key of the
/// file.
///
/// # Example
/// ```
/// use funicular::robot::parameters::component;
///
/// let z = component(&["cables", "3", "anchor_m", "z"]).unwrap();
/// assert_eq!((z.row, z.column), (2, None));
/// assert_eq!(component(&["cables", "3", "anchor_m", "2"]), Some(z));
/// let xy = component(&["platform", "inertia_kg_m2", "1", "0"]).unwrap();
/// assert_eq!((xy.row, xy.column), (0, Some(1)));
/// assert!(component(&["cables", "3", "anchor_m"]).is_none());
/// ```
pub fn component<K: AsRef<str>>(path: &[K]) -> Option<ComponentOfKey> {
    let path: Vec<&str> = path.iter().map(AsRef::as_ref).collect();
    let (key, numbers, rest) = numbers_of(&path)?;
    let (row, column) = match numbers.shape.place(rest)? {
        Component::Element(i) => (i, None),
        Component::Entry(i, j) => (i, Some(j)),
    };
    Some(ComponentOfKey { row, column, beyond_key: rest.len(), default: key.default_numbers(), example: key.example })
}

/// Place of a component in the array of its key.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ComponentOfKey {
    /// Element of the vector, or row of the tensor.
    pub row: usize,
    /// Column of the tensor; the mirrored entry has the same value. `None` for an element of a vector and for a
    /// principal moment.
    pub column: Option<usize>,
    /// Number of keys of the path after the key of the array: one, or two for row and column.
    pub beyond_key: usize,
    /// Default vector, used if the file gives none.
    pub default: Option<[f64; 3]>,
    /// Line of a robot file with the whole array.
    pub example: &'static str,
}

/// Array at the beginning of a path that goes on to no number of it: the number of keys up to the array, and the names
/// and indices of its numbers for a message.
///
/// # Example
/// ```
/// use funicular::robot::parameters::unknown_component;
///
/// assert_eq!(unknown_component(&["loads", "force_n", "3"]), Some((2, "x, y and z, or 0, 1 and 2")));
/// assert_eq!(unknown_component(&["loads", "force_n", "2"]), None);
/// ```
pub fn unknown_component<K: AsRef<str>>(path: &[K]) -> Option<(usize, &'static str)> {
    let path: Vec<&str> = path.iter().map(AsRef::as_ref).collect();
    let (_, numbers, rest) = numbers_of(&path)?;
    let names = numbers.shape.names();
    let is_unknown = !rest.is_empty() && !names.is_empty() && numbers.shape.place(rest).is_none();
    is_unknown.then_some((path.len() - rest.len(), names))
}

/// Unit of the number at a path, as in [`Parameter::unit`]; `None` if no key with numbers is there.
///
/// # Example
/// ```
/// use funicular::robot::parameters::unit;
///
/// assert_eq!(unit(&["loads", "force_n", "2"]), Some("N"));
/// assert_eq!(unit(&["wind", "velocity_m_s", "x"]), Some("m/s"));
/// assert_eq!(unit(&["name"]), None);
/// ```
pub fn unit<K: AsRef<str>>(path: &[K]) -> Option<&'static str> {
    let path: Vec<&str> = path.iter().map(AsRef::as_ref).collect();
    numbers_of(&path).map(|(_, numbers, _)| numbers.unit)
}

/// True for a table at the top of the file that may be absent: `loads`, `wind` and `state`.
pub fn is_optional_table(name: &str) -> bool {
    let root = TABLES.iter().filter(|table| table.header == TOP).flat_map(|table| table.keys);
    root.into_iter()
        .any(|key| key.name == name && matches!(key.value, KeyValue::Table) && key.absent != Absent::Refused)
}

/// Copy of a value without borrowed text. Its numbers go to the list `numbers` (first byte, number), and placeholders
/// take their places.
fn owned(value: &Spanned<DeValue<'_>>, numbers: &mut Vec<(usize, f64)>) -> Spanned<DeValue<'static>> {
    let place = value.span();
    let inner = match value.get_ref() {
        DeValue::String(text) => DeValue::String(Cow::Owned(text.to_string())),
        DeValue::Integer(_) | DeValue::Float(_) => {
            // Only digits beyond `i128` cannot be parsed; the reader has refused them.
            numbers.push((place.start, parsed(value.get_ref()).unwrap_or(f64::INFINITY)));
            DeValue::Float(DeFloat::default())
        }
        DeValue::Boolean(truth) => DeValue::Boolean(*truth),
        DeValue::Datetime(date) => DeValue::Datetime(*date),
        DeValue::Array(array) => {
            let mut copy = DeArray::new();
            array.iter().for_each(|element| copy.push(owned(element, numbers)));
            DeValue::Array(copy)
        }
        DeValue::Table(table) => DeValue::Table(owned_table(table, numbers)),
    };
    Spanned::new(place, inner)
}

/// Copy of a table without borrowed text, see [`owned`].
fn owned_table(table: &DeTable<'_>, numbers: &mut Vec<(usize, f64)>) -> DeTable<'static> {
    let mut copy = DeTable::new();
    for (key, value) in table {
        let name = Cow::Owned(key.get_ref().to_string());
        copy.insert(Spanned::new(key.span(), name), owned(value, numbers));
    }
    copy
}

/// All numbers of a file that has been read without issues.
fn list_of(root: &DeTable, robot: &Robot) -> Vec<Parameter> {
    let mut list = Vec::new();
    let mut table = |part: RobotPart, header: &str, path: &[&str], table: &DeTable| {
        let keys = TABLES.iter().find(|table| table.header == header).map_or(&[][..], |table| table.keys);
        for key in keys {
            let KeyValue::Numbers(numbers) = &key.value else { continue };
            let found = match table.get(key.name) {
                Some(value) => numbers_at(value.get_ref(), &value.span(), numbers.shape),
                None => defaults(key, numbers.shape, table, robot),
            };
            for (component, value, places) in found {
                let names = path.iter().copied().chain([key.name]).chain(component);
                list.push(Parameter {
                    keys: names.map(str::to_owned).collect(),
                    part,
                    key: key.name,
                    component,
                    value,
                    unit: numbers.unit,
                    range: numbers.range,
                    about: key.about,
                    given: !places.is_empty(),
                    places,
                });
            }
        }
    };

    table(RobotPart::Robot, TOP, &[], root);
    if let Some(DeValue::Table(platform)) = root.get("platform").map(Spanned::get_ref) {
        table(RobotPart::Platform, "[platform]", &["platform"], platform);
    }
    let named = [
        ("materials", RobotPart::Material),
        ("pulleys", RobotPart::Pulley),
        ("winches", RobotPart::Winch),
        ("guide_wheels", RobotPart::GuideWheel),
        ("supports", RobotPart::Support),
    ];
    for (kind, part) in named {
        let Some(DeValue::Table(tables)) = root.get(kind).map(Spanned::get_ref) else { continue };
        for (name, entry) in tables {
            if let DeValue::Table(entry) = entry.get_ref() {
                table(part, &format!("[{kind}.NAME]"), &[kind, name.get_ref()], entry);
            }
        }
    }
    if let Some(DeValue::Array(cables)) = root.get("cables").map(Spanned::get_ref) {
        for (i, (entry, cable)) in cables.iter().zip(&robot.cables).enumerate() {
            if let DeValue::Table(entry) = entry.get_ref() {
                table(RobotPart::Cable(i), "[[cables]]", &["cables", &cable.name], entry);
            }
        }
    }
    let absent = DeTable::new();
    for (part, name) in [(RobotPart::Load, "loads"), (RobotPart::Wind, "wind"), (RobotPart::State, "state")] {
        match root.get(name).map(Spanned::get_ref) {
            Some(DeValue::Table(entry)) => table(part, &format!("[{name}]"), &[name], entry),
            // Without a pose, the orientation has no meaning either.
            _ if part == RobotPart::State => {}
            _ => table(part, &format!("[{name}]"), &[name], &absent),
        }
    }
    list
}

/// One number of a key: name of its component, value, first byte at each place where it stands.
type KeyNumber = (Option<&'static str>, f64, Vec<usize>);

/// Numbers that the file gives for a key.
fn numbers_at(value: &DeValue, span: &std::ops::Range<usize>, shape: Shape) -> Vec<KeyNumber> {
    if let Some(number) = parsed(value) {
        return vec![(None, number, vec![span.start])];
    }

    let DeValue::Array(rows) = value else { return Vec::new() };
    let element = |row: usize, column: Option<usize>| {
        let value = rows.get(row)?;
        let value = match (value.get_ref(), column) {
            (DeValue::Array(columns), Some(column)) => columns.get(column)?,
            // Three principal moments have no off-diagonal entries.
            (_, Some(column)) if column != row => return None,
            _ => value,
        };
        Some((parsed(value.get_ref())?, value.span().start))
    };

    let components = shape.components().iter();
    components
        .filter_map(|(name, component)| match *component {
            Component::Element(i) => element(i, None).map(|(value, at)| (Some(*name), value, vec![at])),
            Component::Entry(i, j) => {
                let (value, at) = element(i, Some(j))?;
                let (_, mirror) = element(j, Some(i))?;
                Some((Some(*name), value, if mirror == at { vec![at] } else { vec![at, mirror] }))
            }
        })
        .collect()
}

/// Default numbers of a key that the file leaves out, if they have a meaning for this robot.
fn defaults(key: &Key, shape: Shape, table: &DeTable, robot: &Robot) -> Vec<KeyNumber> {
    let motion = &robot.platform.motion;
    let means_something = match key.name {
        "plane_offset_m" => matches!(motion, PlatformMotion::Planar(_)),
        "center_of_mass_m" | "rotational_damping_n_m_s" | "moment_n_m" | "point_m" | "roll_pitch_yaw_deg" => {
            *motion != PlatformMotion::PointMass
        }
        "damping_ratio" => !table.contains_key("viscous_damping_n_s_m2"),
        _ => true,
    };
    let Some(default) = key.default_numbers().filter(|_| means_something) else { return Vec::new() };
    match shape.components() {
        [] => vec![(None, default[0], Vec::new())],
        components => {
            components.iter().zip(default).map(|((name, _), value)| (Some(*name), value, Vec::new())).collect()
        }
    }
}

//! Points of a sweep over values of the robot file.

use crate::parameter_pattern::ParameterPattern;
use crate::set_values::{self, Assignment, ValuePath};
use crate::sweep::{Point, Points, Steps, digits};
use crate::table::{Column, ColumnKind};
use funicular::robot::Robot;
use funicular::robot::parameters::Parameters;
use std::borrow::Cow;

/// Value of the robot file that varies.
#[derive(Debug, Clone, PartialEq)]
pub struct ValueAxis {
    /// Path of the value in the robot file. With `*` for a key it stands for several values, which are equal at every
    /// point.
    pub path: ValuePath,
    /// Values along the axis.
    pub steps: Steps,
}

impl ValueAxis {
    /// Axis from the text of its path and its values.
    ///
    /// # Errors
    /// A text that is not a path.
    pub fn new(path: &str, steps: Steps) -> Result<Self, String> {
        Ok(Self { path: set_values::path(path)?, steps })
    }
}

/// Name of the option in messages.
const OPTION: &str = "⟪vary⟫";

/// Changes of a robot after reading: the state and the loads of a request.
type Adjust = Box<dyn Fn(Robot) -> Result<Robot, String> + Send + Sync>;

/// All combinations of values of a robot file. The first value varies fastest.
pub struct RobotValues {
    text: String,
    axes: Vec<ValueAxis>,
    /// Values that each axis sets: one, or several if its path has a `*`.
    targets: Vec<Vec<ValuePath>>,
    /// Numbers of the file with the values of the first point, and for each of them the index of its axis and its own
    /// index. `None` if an axis is not a number of the file; every robot is then read from its own text.
    numbers: Option<(Parameters, Vec<(usize, usize)>)>,
    adjust: Adjust,
    /// Robots whose unstrained lengths are held: only the values of `[state]` vary in them.
    holders: Option<Box<Self>>,
}

impl RobotValues {
    /// Makes the points from the text of a robot file, the values that vary, and changes of every robot after reading.
    ///
    /// # Errors
    /// A message for the user: a value that varies twice, an end of one variation that alone makes no valid robot, or a
    /// value that changes nothing because another option sets it for every robot.
    pub fn new(text: String, axes: Vec<ValueAxis>, adjust: Adjust) -> Result<Self, String> {
        let targets = axes.iter().map(|axis| targets(&text, &axis.path)).collect::<Result<Vec<_>, _>>()?;
        for (i, axis) in axes.iter().enumerate() {
            let mut earlier = targets[..i].iter().flatten();
            if earlier.any(|other| targets[i].iter().any(|own| own.is_same(other))) {
                return Err(format!("{OPTION} {} is given twice", axis.path.text));
            }
            if let Some(value) = axis.steps.repeated() {
                return Err(format!("{OPTION} {} has the value {value} twice: leave one out", axis.path.text));
            }
        }

        let mut variations = Self { text, axes, targets, numbers: None, adjust, holders: None };
        for (axis, own) in variations.axes.iter().zip(&variations.targets) {
            let tried = match &axis.steps {
                Steps::Range { from, to, .. } => vec![*from, *to],
                Steps::List(values) => values.clone(),
            };
            let mut first = None;
            let (mut values_differ, mut robots_differ) = (false, false);
            for value in tried {
                let robot = variations.robot(&set_to(own, value))?;
                let (of_first, first) = first.get_or_insert_with(|| (value.to_bits(), robot.clone()));
                values_differ |= *of_first != value.to_bits();
                robots_differ |= *first != robot;
            }
            if values_differ && !robots_differ {
                return Err(format!(
                    "{OPTION} {} changes nothing: no part of the robot uses this value, or another option sets it; \
                     leave out one of them",
                    axis.path.text
                ));
            }
        }

        variations.numbers = variations.find_numbers();
        Ok(variations)
    }

    /// Sweep whose robots hold unstrained lengths: those with which the robots of another text rest at the pose of each
    /// point. In that text only the values of `[state]` vary.
    ///
    /// # Errors
    /// A message for the user: a robot that the text does not make.
    pub fn holding(mut self, text: String, adjust: Adjust) -> Result<Self, String> {
        let axes = self.axes.iter().filter(|axis| axis.path.is_of_state()).cloned().collect();
        let holders = Self::new(text, axes, adjust)?;
        holders.first()?;
        self.holders = Some(Box::new(holders));
        Ok(self)
    }

    /// Robot whose lengths are held at a point with these values.
    fn holder_at(&self, values: &[f64]) -> Option<Result<Robot, String>> {
        let holders = self.holders.as_ref()?;
        let of_state = self.axes.iter().zip(values).filter(|(axis, _)| axis.path.is_of_state());
        Some(holders.robot_at(&of_state.map(|(_, value)| *value).collect::<Vec<_>>()))
    }

    /// Numbers that vary, found in the text of the first point, which contains all of them.
    fn find_numbers(&self) -> Option<(Parameters, Vec<(usize, usize)>)> {
        let text = set_values::apply(&self.text, &self.assignments(&self.values(0))).ok()?;
        let parameters = Parameters::from_toml(&text).ok()?;
        let own = self.targets.iter().enumerate().flat_map(|(axis, paths)| paths.iter().map(move |path| (axis, path)));
        let places = own.map(|(axis, path)| Some((axis, parameters.find(path.keys())?))).collect::<Option<Vec<_>>>()?;
        Some((parameters, places))
    }

    /// Values that vary.
    pub fn axes(&self) -> &[ValueAxis] {
        &self.axes
    }

    /// Robot of the first point.
    ///
    /// # Errors
    /// A message that says what is wrong with it.
    pub fn first(&self) -> Result<Robot, String> {
        self.robot_at(&self.values(0))
    }

    /// Robot with these values, one per axis. The numbers are replaced directly if that succeeds. An invalid robot is
    /// read from its text, so that the error names line and column.
    fn robot_at(&self, values: &[f64]) -> Result<Robot, String> {
        if let Some((parameters, places)) = &self.numbers {
            let changes: Vec<(usize, f64)> = places.iter().map(|(axis, place)| (*place, values[*axis])).collect();
            if let Ok(robot) = parameters.robot_with(&changes) {
                return (self.adjust)(robot);
            }
        }
        self.robot(&self.assignments(values))
    }

    /// Robot read from the text with these values.
    fn robot(&self, assignments: &[Assignment]) -> Result<Robot, String> {
        let text = set_values::apply(&self.text, assignments).map_err(|error| error.to_string())?;
        let robot = Robot::from_toml(&text).map_err(|error| {
            let set: Vec<&str> = assignments.iter().map(Assignment::text).collect();
            let help = error.issues().first().and_then(|issue| issue.help.as_deref());
            let help = help.map_or_else(String::new, |help| format!("; {help}"));
            format!("with {}: {error}{help}", set.join(" and "))
        })?;
        (self.adjust)(robot)
    }

    /// Values of a point, one per axis.
    fn values(&self, i: usize) -> Vec<f64> {
        let digits = digits(i, self.axes.iter().map(|axis| axis.steps.count()));
        digits.zip(&self.axes).map(|(digit, axis)| axis.steps.at(digit)).collect()
    }

    fn assignments(&self, values: &[f64]) -> Vec<Assignment> {
        self.targets.iter().zip(values).flat_map(|(own, value)| set_to(own, *value)).collect()
    }
}

impl Points for RobotValues {
    fn count(&self) -> usize {
        self.axes.iter().fold(1, |count, axis| count.saturating_mul(axis.steps.count()))
    }

    fn columns(&self) -> Vec<Column> {
        self.axes
            .iter()
            .map(|axis| Column {
                name: axis.path.text.clone(),
                unit: unit(&axis.path).into(),
                about: "value of the robot file".to_owned(),
                kind: ColumnKind::Real,
            })
            .collect()
    }

    fn parameters(&self, i: usize) -> Option<Cow<'_, Parameters>> {
        let text = set_values::apply(&self.text, &self.assignments(&self.values(i))).ok()?;
        Parameters::from_toml(&text).ok().map(Cow::Owned)
    }

    fn point(&self, i: usize) -> Point<'_> {
        let coordinates = self.values(i);
        let (holder, reason) = match self.holder_at(&coordinates) {
            None => (None, None),
            Some(Ok(holder)) => (Some(Cow::Owned(holder)), None),
            Some(Err(reason)) => (None, Some(reason)),
        };
        let robot = match reason {
            None => self.robot_at(&coordinates),
            Some(reason) => Err(reason),
        };
        let robot = robot.map(|robot| {
            let state = robot.state.clone();
            (Cow::Owned(robot), Cow::Owned(state))
        });
        Point { coordinates, robot, holder }
    }
}

/// Values of a robot file that a path sets: one, or with a `*` all that match.
fn targets(text: &str, path: &ValuePath) -> Result<Vec<ValuePath>, String> {
    if !path.is_pattern() {
        return Ok(vec![path.clone()]);
    }
    let parameters = Parameters::from_toml(text).map_err(|error| format!("{OPTION} {}: {error}", path.text))?;
    let chosen = ParameterPattern::parse("vary", &path.text, &parameters)
        .and_then(|pattern| pattern.changeable(&parameters))
        .map_err(|error| format!("{error:#}"))?;
    chosen.into_iter().map(|index| set_values::path(&parameters.list()[index].path())).collect()
}

/// Assignments of one number to several values.
fn set_to(paths: &[ValuePath], value: f64) -> Vec<Assignment> {
    paths.iter().map(|path| path.with(OPTION, value)).collect()
}

/// Unit of a column: that of the robot file's number, in the letters of the files of rows.
fn unit(path: &ValuePath) -> String {
    path.unit().unwrap_or("1").replace("degrees", "deg").replace('²', "2").replace('³', "3")
}

#[cfg(test)]
mod tests {
    use super::*;
    use funicular::robot::parameters::ParameterError;
    use funicular::robot::spec::SpecError;

    #[test]
    fn the_unit_of_a_column_is_that_of_the_number() {
        for (path, expected) in [
            ("platform.mass_kg", "kg"),
            ("platform.inertia_kg_m2.0.1", "kg m2"),
            ("platform.drag_area_m2", "m2"),
            ("platform.plane_normal.x", "1"),
            ("platform.translational_damping_n_s_m.x", "N s/m"),
            ("platform.rotational_damping_n_m_s.2", "N m s"),
            ("gravity_m_s2.2", "m/s2"),
            ("materials.rope.mass_kg_per_m", "kg/m"),
            ("materials.rope.diameter_m", "m"),
            ("materials.rope.load_n_per_m.z", "N/m"),
            ("materials.rope.axial_stiffness_n", "N"),
            ("materials.rope.youngs_modulus_pa", "Pa"),
            ("materials.rope.viscous_damping_n_s_m2", "N s/m2"),
            ("materials.rope.damping_ratio", "1"),
            ("loads.moment_n_m.0", "N m"),
            ("wind.velocity_m_s.x", "m/s"),
            ("wind.air_density_kg_m3", "kg/m3"),
            ("state.roll_pitch_yaw_deg.yaw", "deg"),
            ("cables.*.anchor_m.z", "m"),
        ] {
            assert_eq!(unit(&set_values::path(path).unwrap()), expected, "{path}");
        }
    }

    /// Path of a parameter whose component is given by its index instead of its name.
    fn by_index(parameters: &Parameters, at: usize) -> String {
        let parameter = &parameters.list()[at];
        let Some(name) = parameter.component else { return parameter.path() };
        let path = parameter.path();
        let array = path.strip_suffix(name).unwrap();
        let axis = |letter: &str| ["x", "y", "z"].iter().position(|known| *known == letter).unwrap();
        let index = match name {
            "roll" => "0".to_owned(),
            "pitch" => "1".to_owned(),
            "yaw" => "2".to_owned(),
            one if one.len() == 1 => axis(one).to_string(),
            two => {
                let (row, column) = two.split_at(1);
                // The mirrored entry has the same value.
                format!("{}.{}", axis(column), axis(row))
            }
        };
        format!("{array}{index}")
    }

    /// Changes every number of every robot of the library, alone and in pairs, to values inside and outside its range.
    /// The robot with the number replaced equals the robot read from the changed text, bit for bit, and both methods
    /// refuse the same robots with the same message.
    #[test]
    fn numbers_in_place_and_numbers_in_the_text_make_the_same_robots() {
        let (mut equal, mut refused) = (0, 0);
        for (_, text) in funicular_robots::ALL {
            let parameters = Parameters::from_toml(text).unwrap();
            let list = parameters.list();
            assert!(list.len() > 20, "{text}");

            let mut random = 20_140_531_u64;
            let mut next = |count: u64| {
                random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                (random >> 33) % count
            };

            for (i, parameter) in list.iter().enumerate().filter(|(_, parameter)| parameter.given) {
                assert_eq!(parameters.robot_with(&[(i, parameter.value)]).as_ref(), Ok(parameters.robot()));
                let index_path = set_values::path(&by_index(&parameters, i)).unwrap();
                assert_eq!(parameters.find(index_path.keys()), Some(i), "{}", index_path.text);
                assert!(index_path.is_same(&set_values::path(&parameter.path()).unwrap()));

                let factor = 1.0 + next(1_000_000) as f64 * 1e-6;
                for value in [parameter.value * factor, parameter.value + 0.1, -factor, 0.0, 1e-13, 0.7, 3e12, f64::NAN]
                {
                    let other = next(list.len() as u64) as usize;
                    let mut changes = vec![(i, value)];
                    if other != i && list[other].given {
                        changes.push((other, list[other].value * factor));
                    }

                    // Names and indices of components take turns.
                    let named = next(2) == 0;
                    let path_of = |at: usize| if named { list[at].path() } else { by_index(&parameters, at) };
                    let path = |at: usize| set_values::path(&path_of(at)).unwrap();
                    let assignments: Vec<_> =
                        changes.iter().map(|(at, value)| path(*at).with(OPTION, *value)).collect();

                    let edited = Robot::from_toml(&set_values::apply(text, &assignments).unwrap());

                    match (parameters.robot_with(&changes), edited) {
                        // The texts are compared too, because zeros of both signs are equal and their texts are not.
                        (Ok(one), Ok(other)) => {
                            assert_eq!(format!("{one:?}"), format!("{other:?}"));
                            equal += 1;
                        }
                        (Err(ParameterError::Refused { reason, .. }), Err(other)) => {
                            let words = |error: &SpecError| -> Vec<_> {
                                error.issues().iter().map(|issue| (issue.message.clone(), issue.help.clone())).collect()
                            };
                            assert_eq!(words(&reason), words(&other));
                            refused += 1;
                        }
                        (one, other) => panic!("{changes:?}: {one:?} and {other:?}"),
                    }
                }
            }
        }

        assert!(equal > 1000 && refused > 1000, "{equal} {refused}");
    }

    /// Robots of a sweep equal the robots read from changed texts. A value that is not a number of the file is read
    /// from text.
    #[test]
    fn a_sweep_over_numbers_has_the_robots_of_the_edited_texts() {
        let text = funicular_robots::COGIRO;
        // The second value, the tables of load and wind, and the limits of a cable are not in the file. The limits
        // exclude each other in some rows.
        let axes = [
            ("cables.1.anchor_m.z", Steps::range(5.0, 6.0, 3)),
            ("platform.translational_damping_n_s_m.x", Steps::range(0.0, 0.2, 2)),
            // The robot has no [loads] and no [wind].
            ("loads.force_n.2", Steps::range(-50.0, 50.0, 2)),
            ("wind.velocity_m_s.0", Steps::range(1.0, 5.0, 2)),
            ("cables.2.minimum_tension_n", Steps::range(10.0, 400.0, 3)),
            ("cables.2.maximum_tension_n", Steps::range(300.0, 1000.0, 3)),
        ];

        let axes = axes.map(|(path, steps)| ValueAxis::new(path, steps.unwrap()).unwrap()).to_vec();
        let sweep = RobotValues::new(text.to_owned(), axes, Box::new(Ok)).unwrap();
        assert!(sweep.numbers.is_some() && !text.contains("[loads]") && !text.contains("[wind]"));

        let (mut robots, mut refusals) = (0, 0);
        for i in 0..sweep.count() {
            let by_text = sweep.robot(&sweep.assignments(&sweep.values(i)));
            assert_eq!(sweep.robot_at(&sweep.values(i)), by_text);
            if by_text.is_ok() { robots += 1 } else { refusals += 1 }
        }

        assert!(robots > 0 && refusals > 0, "{robots} {refusals}");
    }

    #[test]
    fn a_star_moves_all_values_that_match_at_once() {
        let text = funicular_robots::COGIRO;
        let axis = |path: &str, from: f64, to: f64| ValueAxis::new(path, Steps::range(from, to, 2).unwrap()).unwrap();
        let made = |axes: Vec<ValueAxis>| RobotValues::new(text.to_owned(), axes, Box::new(Ok));
        let sweep = made(vec![axis("cables.*.anchor_m.z", 5.0, 6.0), axis("platform.mass_kg", 80.0, 90.0)]).unwrap();
        assert_eq!((sweep.count(), sweep.columns()[0].name.as_str()), (4, "cables.*.anchor_m.z"));
        assert!(sweep.numbers.is_some());

        for (i, (height, mass)) in [(5.0, 80.0), (6.0, 80.0), (5.0, 90.0), (6.0, 90.0)].into_iter().enumerate() {
            let robot = sweep.robot_at(&sweep.values(i)).unwrap();
            let heights = robot.cables.iter().map(|cable| cable.anchor.reference_w().z.to_bits());
            assert!(heights.clone().count() > 6 && heights.clone().all(|bits| bits == f64::to_bits(height)));
            assert_eq!(robot.platform.mass.to_bits(), f64::to_bits(mass));
            assert_eq!(sweep.robot(&sweep.assignments(&sweep.values(i))), Ok(robot));
        }

        let twice = made(vec![axis("cables.*.anchor_m.z", 5.0, 6.0), axis("cables.1.anchor_m.2", 5.0, 6.0)]).err();
        assert!(twice.unwrap().contains("cables.1.anchor_m.2 is given twice"));
        let none = made(vec![axis("cables.*.height", 5.0, 6.0)]).err().unwrap();
        assert!(none.contains("⟪vary⟫ cables.*.height: the robot file has no such number"), "{none}");
    }

    #[test]
    fn a_value_that_another_option_sets_and_one_given_twice_are_refused() {
        let text = funicular_robots::YUAN2014_4MM;
        let varied = |paths: &[&str], mass: Option<f64>| {
            let steps = Steps::range(10.0, 20.0, 3).unwrap();
            let axes = paths.iter().map(|path| ValueAxis::new(path, steps.clone()).unwrap());
            let adjust = Box::new(move |robot: Robot| Ok(mass.map_or(robot.clone(), |mass| robot.with_mass(mass))));
            RobotValues::new(text.to_owned(), axes.collect(), adjust).err()
        };
        let path = "platform.mass_kg";
        assert_eq!(varied(&[path], None), None);
        assert!(
            varied(&[path], Some(15.0))
                .unwrap()
                .contains("changes nothing: no part of the robot uses this value, or another option sets it")
        );
        assert!(varied(&[path, "platform.\"mass_kg\""], None).unwrap().contains("given twice"));
        assert!(varied(&["gravity_m_s2.z", "gravity_m_s2.2"], None).unwrap().contains("given twice"));
        assert!(varied(&["platform.mas_kg"], None).unwrap().contains("did you mean `mass_kg`?"));
    }
}

//! Numbers of the robot file by which results are differentiated, and their tolerances.

use super::GradientParameter;
use crate::at_rest::AtRest;
use crate::parameter_pattern::ParameterPattern;
use anyhow::{Result, anyhow, bail};
use funicular::math::Vec3;
use funicular::robot::parameters::{Parameter, Parameters, RobotPart};
use funicular::robot::{Load, RobotChange};

/// Tolerance of a position or length that is not given [m], and of an angle [degrees]: what is usually measured.
const TOLERANCE_OF_LENGTH_M: f64 = 1e-3;
const TOLERANCE_OF_ANGLE_DEG: f64 = 0.1;

/// Tolerance of any other value that is not given, relative to it.
const RELATIVE_TOLERANCE: f64 = 0.01;

/// Numbers of the robot file by which results are differentiated.
#[derive(Default)]
pub struct GradientColumns {
    /// Path, value, unit and tolerance of each number.
    pub parameters: Vec<GradientParameter>,
    /// Change of the robot per unit of each number.
    pub changes: Vec<RobotChange>,
    /// Paths of chosen numbers without derivatives.
    pub(super) without_derivative: Vec<String>,
}

impl GradientColumns {
    /// Numbers of the `text` of a robot file at the paths of `by`, or all, with the tolerances `given` as PATH=VALUE or
    /// PATH=PERCENT%, or else the usual ones.
    ///
    /// # Errors
    /// A path that no number has, or numbers that all lack derivatives.
    pub fn of(at_rest: &AtRest, text: &str, by: &[String], given: &[String]) -> Result<Self> {
        let all = Parameters::from_toml(text).map_err(|error| anyhow!("{error}"))?;
        let patterns = by.iter().map(|text| ParameterPattern::parse("by", text, &all)).collect::<Result<Vec<_>>>()?;
        let tolerances =
            given.iter().map(|text| Tolerance::parse("tolerances", text, &all)).collect::<Result<Vec<_>>>()?;
        let is_met = |pattern: &&ParameterPattern| all.list().iter().any(|parameter| pattern.matches(parameter));
        if let Some(unmet) = patterns.iter().chain(tolerances.iter().map(|of| &of.pattern)).find(|of| !is_met(of)) {
            return Err(unmet.missing(&all));
        }

        let texts = given.iter().map(String::as_str);
        let entries: Vec<_> = texts.zip(&tolerances).map(|(text, given)| ("tolerances", text, given)).collect();
        refuse_replaced(&entries, all.list())?;

        let mut columns = Self::default();
        for (index, parameter) in all.list().iter().enumerate() {
            if !patterns.is_empty() && !patterns.iter().any(|pattern| pattern.matches(parameter)) {
                continue;
            }
            let Some(change) = all.change_of(index, &at_rest.robot) else {
                columns.without_derivative.push(parameter.path());
                continue;
            };
            let value = value_at(at_rest, parameter);
            // The last tolerance that names a number counts.
            let given = tolerances.iter().rev().find(|given| given.matches(parameter));
            let tolerance = given.map_or_else(|| usual_tolerance(parameter, value), |given| given.of(value));
            let (path, unit) = (parameter.path(), parameter.unit);
            columns.parameters.push(GradientParameter { path, value, unit, tolerance });
            columns.changes.push(change);
        }
        if columns.parameters.is_empty() {
            bail!(
                "⟪by⟫: {} without derivatives: limits, the plane of a planar platform, friction of pulleys and losses \
                 of gears have none",
                columns.without_derivative.join(", ")
            );
        }
        Ok(columns)
    }
}

/// Tolerance or deviation that an option gives for numbers of the robot file.
pub(crate) struct Tolerance {
    pattern: ParameterPattern,
    value: f64,
    is_percent: bool,
}

impl Tolerance {
    /// Tolerance from its text `PATH=VALUE` or `PATH=PERCENT%`.
    ///
    /// # Errors
    /// A text that is not of this form, or a negative value.
    pub(crate) fn parse(option: &'static str, text: &str, parameters: &Parameters) -> Result<Self> {
        let wrong = || anyhow!("⟪{option}⟫ {text}: write PATH=VALUE or PATH=PERCENT%, as in platform.mass_kg=1%");
        let (path, value) = text.rsplit_once('=').ok_or_else(wrong)?;
        let number = value.trim().trim_end_matches('%');
        let parsed: f64 = number.trim().parse().map_err(|_| wrong())?;
        if !(parsed.is_finite() && parsed >= 0.0) {
            bail!("⟪{option}⟫ {text}: it must be finite and not negative");
        }
        let is_percent = value.trim_end().ends_with('%');
        Ok(Self { pattern: ParameterPattern::parse(option, path, parameters)?, value: parsed, is_percent })
    }

    /// Tolerance of a number with this value, in the unit of the number.
    pub(crate) fn of(&self, value: f64) -> f64 {
        if self.is_percent { 0.01 * self.value * value.abs() } else { self.value }
    }

    /// True for a tolerance that is relative to the value.
    pub(crate) fn is_percent(&self) -> bool {
        self.is_percent
    }

    /// True for a number that the option names.
    pub(crate) fn matches(&self, parameter: &Parameter) -> bool {
        self.pattern.matches(parameter)
    }

    /// Error of an option whose path no number of the robot file has.
    pub(crate) fn missing(&self, parameters: &Parameters) -> anyhow::Error {
        self.pattern.missing(parameters)
    }
}

/// Refuses an entry whose numbers are all named by later ones, which alone would count; `entries` have their key and
/// their text.
///
/// # Errors
/// An entry without effect, which is likely a slip. A general entry before a special one has an effect.
pub(crate) fn refuse_replaced(entries: &[(&str, &str, &Tolerance)], numbers: &[Parameter]) -> Result<()> {
    for (i, (key, text, entry)) in entries.iter().enumerate() {
        let mut replacing = None;
        let mut own = numbers.iter().filter(|number| entry.matches(number)).peekable();
        let is_replaced = own.peek().is_some()
            && own.all(|number| {
                let later = entries[i + 1..].iter().find(|(_, _, later)| later.matches(number));
                replacing = replacing.or(later);
                later.is_some()
            });
        if let (true, Some((other_key, other, _))) = (is_replaced, replacing) {
            bail!(
                "⟪{key}⟫ {text} has no effect, because ⟪{other_key}⟫ {other} names its numbers again: keep one of \
                 them, or give the general one first"
            );
        }
    }
    Ok(())
}

/// Tolerance of a number that no option gives, in the unit of the number.
fn usual_tolerance(parameter: &Parameter, value: f64) -> f64 {
    match (parameter.unit, parameter.key) {
        // The thickness of a rope is no position.
        ("m", key) if !key.contains("diameter") => TOLERANCE_OF_LENGTH_M,
        ("degrees", _) => TOLERANCE_OF_ANGLE_DEG,
        _ => RELATIVE_TOLERANCE * value.abs(),
    }
}

/// Value of a number at rest: that of the robot file, or the one that an option or the equilibrium gives instead.
pub(crate) fn value_at(at_rest: &AtRest, parameter: &Parameter) -> f64 {
    let robot = &at_rest.robot;
    let Load { force_w, moment_w, point_p } = &robot.load;
    let axis = ["x", "y", "z"].iter().position(|axis| Some(*axis) == parameter.component);
    let of = |vector: &Vec3| axis.map(|axis| vector[axis]);
    let angle = |angles: [f64; 3]| {
        ["roll", "pitch", "yaw"].iter().position(|name| Some(*name) == parameter.component).map(|axis| angles[axis])
    };
    let found = match (parameter.part, parameter.key) {
        (RobotPart::Platform, "mass_kg") => Some(robot.platform.mass),
        (RobotPart::Load, "force_n") => of(force_w),
        (RobotPart::Load, "moment_n_m") => of(moment_w),
        (RobotPart::Load, "point_m") => of(point_p),
        (RobotPart::Wind, "velocity_m_s") => of(&robot.wind.velocity_w),
        (RobotPart::State, "position_m") => of(&at_rest.equilibrium.pose.position_w),
        (RobotPart::State, "roll_pitch_yaw_deg") => angle(robot.written_angles_deg),
        (RobotPart::Cable(i), "unstrained_length_m") => Some(at_rest.equilibrium.cables[i].unstrained_length),
        _ => None,
    };
    found.unwrap_or(parameter.value)
}

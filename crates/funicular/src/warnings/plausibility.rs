//! Values that no usual robot has: most of them are slips of a unit or of a sign.
//!
//! A value outside the usual range is a warning, never an error: the robot may be an unusual one. Each warning has the
//! value, the usual range and the likely slip. All ranges are in one table, [`usual`].

mod drives;
mod equilibrium;
mod geometry;
mod loads;
mod platform;
mod rope;
mod supports;
pub mod usual;

pub use equilibrium::of_equilibrium;

use crate::robot::Robot;
use std::fmt;

/// Value of a robot that no usual robot has.
#[derive(Debug, Clone, PartialEq)]
pub enum Implausible {
    /// Value outside its usual range.
    OutOfRange {
        /// Subject and quantity, such as `rope "a": Young's modulus`.
        what: String,
        /// Value of the robot.
        value: f64,
        /// Unit of the value and of the range; empty for ratios.
        unit: &'static str,
        /// Usual minimum and maximum; zero or infinite if there is none.
        usual: [f64; 2],
        /// Likely slip.
        slip: String,
    },
    /// Observation without a range, such as a coordinate whose sign differs from that of the other cables.
    Odd {
        /// Observation.
        what: String,
        /// Likely slip.
        slip: String,
    },
}

impl fmt::Display for Implausible {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Odd { what, slip } => write!(f, "{what}: {slip}"),
            Self::OutOfRange { what, value, unit, usual, slip } => {
                let with_unit = |value: f64| {
                    let number = number(value);
                    if unit.is_empty() { number } else { format!("{number} {unit}") }
                };
                let range = match *usual {
                    [low, high] if high.is_infinite() => format!("usual is at least {}", with_unit(low)),
                    [0.0, high] => format!("usual is at most {}", with_unit(high)),
                    [low, high] => format!("usual is {} to {}", number(low), with_unit(high)),
                };
                write!(f, "{what} is {}, {range}: {slip}", with_unit(*value))
            }
        }
    }
}

/// Number with four significant digits.
fn number(value: f64) -> String {
    let rounded: f64 = format!("{value:.3e}").parse().unwrap_or(value);
    if rounded == 0.0 || (1e-3..1e6).contains(&rounded.abs()) { format!("{rounded}") } else { format!("{rounded:e}") }
}

/// Warning about a value outside a range; `None` inside.
fn outside(
    what: impl Into<String>,
    value: f64,
    unit: &'static str,
    usual: [f64; 2],
    slip: impl FnOnce(Outlier) -> String,
) -> Option<Implausible> {
    let is_usual = value.is_nan() || (usual[0]..=usual[1]).contains(&value);
    let slip = || slip(Outlier { value, usual });
    (!is_usual).then(|| Implausible::OutOfRange { what: what.into(), value, unit, usual, slip: slip() })
}

/// Value outside its usual range.
#[derive(Debug, Clone, Copy)]
struct Outlier {
    value: f64,
    usual: [f64; 2],
}

impl Outlier {
    fn is_too_large(self) -> bool {
        self.value > self.usual[1]
    }
}

/// Hint for a value that no slip of the table explains.
const SOME_SLIP: &str = "a slip of its unit or of the decimal point?";

/// Likely slips, each a factor that undoes it with a text: those that bring the value into the likely range, else into
/// the usual one, else all that made the value too large or, for a small value, too small.
fn likely(of: Outlier, range: [f64; 2], slips: &[(f64, &str)]) -> String {
    let those = |wanted: &dyn Fn(f64) -> bool| -> Vec<&str> {
        let mut texts: Vec<&str> = slips.iter().filter(|(undo, _)| wanted(*undo)).map(|(_, text)| *text).collect();
        texts.dedup();
        texts
    };
    let fits = |[low, high]: [f64; 2], undo: f64| (low..=high).contains(&(of.value * undo));
    let undoes = |undo: f64| if of.is_too_large() { undo < 1.0 } else { undo > 1.0 };
    let texts = [
        those(&|undo| undoes(undo) && fits(range, undo)),
        those(&|undo| undoes(undo) && fits(of.usual, undo)),
        those(&undoes),
    ];
    let texts = texts.into_iter().find(|texts| !texts.is_empty());
    texts.map_or_else(|| SOME_SLIP.to_owned(), |texts| format!("{}?", texts.join(", or ")))
}

/// Values of a robot that no usual robot has. It needs no equilibrium.
///
/// # Example
/// ```
/// use funicular::{robot::Robot, warnings::plausibility};
///
/// let text = funicular_robots::COGIRO;
/// assert!(plausibility::of_robot(&Robot::from_toml(text)?).is_empty());
///
/// let slip = text.replace("youngs_modulus_pa = 100e9", "youngs_modulus_pa = 100");
/// let found = plausibility::of_robot(&Robot::from_toml(&slip)?);
/// assert!(found[0].to_string().contains("GPa given as Pa?"));
/// # Ok::<(), funicular::robot::spec::SpecError>(())
/// ```
pub fn of_robot(robot: &Robot) -> Vec<Implausible> {
    let mut found = Vec::new();

    let ropes = rope::distinct(robot);
    let of_ropes: Vec<Implausible> = ropes.iter().flat_map(|rope| rope::check(robot, rope)).collect();
    let ropes_fit = of_ropes.is_empty();
    found.extend(of_ropes);

    // A wrong geometry makes the numbers that are compared with it wrong as well.
    let of_geometry = geometry::check(robot);
    let geometry_fits = of_geometry.is_empty();
    found.extend(of_geometry);
    found.extend(geometry::full_turns(robot));
    if geometry_fits {
        found.extend(platform::check(robot));
    }
    found.extend(loads::check(robot, ropes_fit && geometry_fits));
    found.extend(drives::check(robot, geometry_fits));
    if geometry_fits {
        found.extend(supports::check(robot));
    }
    found
}

/// Remarks about values that are usual for one kind of robot and a slip for another.
pub fn notes(robot: &Robot) -> Vec<String> {
    let of_ropes = rope::distinct(robot).into_iter().filter_map(rope::note);
    let of_damping = super::of_damping(robot).map(|warning| warning.to_string());
    of_ropes.chain(of_damping).collect()
}

//! Names of inputs and outputs, as the program, the Python package and files have them, and where they are on a robot.
//!
//! `fz` is a vertical force on the platform, `az` its vertical acceleration, `cable:3@0.5:az` that of the middle of cable
//! "3". A name is read once, checked against what the robot can do, and becomes a [`Port`] of a response.

use crate::cable_motion::{CableMotionError, CableStations};
use crate::dynamics::Dynamics;
use crate::math::{Vec3, Vec6};
use crate::response::{Direction, Port, Quantity};
use crate::robot::{Freedoms, Robot};
use crate::statics::Equilibrium;
use crate::suggest;
use thiserror::Error;

/// Largest magnitude of a number, as in robot files: no product of the analyses overflows within it.
const LARGEST: f64 = 1e12;
/// Shortest direction, as the smallest positive quantity of robot files.
const SHORTEST: f64 = 1e-12;
/// Part of a direction below which a planar platform cannot follow it.
const IN_PLANE: f64 = 1e-9;

/// A name that is none, or one that means nothing on a robot.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum PortError {
    /// A number that cannot be read or used.
    #[error(transparent)]
    Number(#[from] NumberError),
    /// Not three components.
    #[error("{0} numbers where x,y,z are needed")]
    Components(usize),
    /// A direction without length.
    #[error("a direction cannot be zero")]
    ZeroDirection,
    /// A point on a cable that is not written as one.
    #[error("{0} is missing: a point on a cable is cable:NAME@FRACTION:DIRECTION, as in cable:3@0.5:z")]
    Form(&'static str),
    /// A point beyond a cable's ends.
    #[error("{0} is not a part of the cable's length: 0 is the platform, 1 the anchor")]
    Fraction(f64),
    /// A moment on a cable.
    #[error("{0} is not a force, and only forces act on a cable")]
    NotAForce(String),
    /// A rotation of a cable.
    #[error("{0} is not a translation, and the points of a cable do not turn")]
    NotATranslation(String),
    /// No input.
    #[error(
        "not an input: fx, fy, fz (force), mx, my, mz (moment), f:ux,uy,uz or m:ux,uy,uz (along a direction in world \
         axes), or a force on a cable as in cable:3@0.5:fz"
    )]
    NotAnInput,
    /// No output.
    #[error(
        "not an output: x, y, z, rx, ry, rz (displacement, rotation), with v (velocity) or a (acceleration) before it \
         as in ay, or x:ux,uy,uz, v:ux,uy,uz, a:ux,uy,uz (along a direction in world axes), or a point \
         of a cable as in cable:3@0.5:az"
    )]
    NotAnOutput,
    /// A cable that the robot does not have.
    #[error("the robot has no cable \"{name}\"{}", suggest::or_list(name, "cables", names))]
    NoSuchCable {
        /// Name asked.
        name: String,
        /// Names there are.
        names: Vec<String>,
    },
    /// A point of the platform for a port on a cable.
    #[error("the {side}'s point is one of the platform, and the {side} {name} is on a cable: leave out the point")]
    PointOfCable {
        /// `input` or `output`.
        side: &'static str,
        /// Its name.
        name: String,
    },
    /// A point for a moment or a rotation.
    #[error("the {side}'s point has no effect: the {side} {name} is the same at every point; leave out the point")]
    PointOfRotation {
        /// `input` or `output`.
        side: &'static str,
        /// Its name.
        name: String,
    },
    /// A rotation of a point mass.
    #[error(
        "a point mass does not turn: the {side} {name} is not possible; use a force (fx) and a translation (x, vx, ax)"
    )]
    PointMassTurns {
        /// `input` or `output`.
        side: &'static str,
        /// Its name.
        name: String,
    },
    /// A point of a point mass.
    #[error("a point mass has no points but its origin: leave out the {side}'s point")]
    PointMassPoint {
        /// `input` or `output`.
        side: &'static str,
    },
    /// What a planar platform cannot do.
    #[error(
        "the {side} {name} is out of the plane of the platform ({freedoms}, normal {}, {}, {}), in which a guide holds \
         it: choose a direction in the plane, or the rotation about its normal",
        normal.x,
        normal.y,
        normal.z
    )]
    OutOfPlane {
        /// `input` or `output`.
        side: &'static str,
        /// Its name.
        name: String,
        /// Kind of the platform.
        freedoms: &'static str,
        /// Normal of its plane.
        normal: Vec3,
    },
}

/// A number in a text that is none, or not one to compute with.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum NumberError {
    /// Nothing.
    #[error("a number is missing")]
    Missing,
    /// No number.
    #[error("`{0}` is not a number (write it without its unit, with a point for decimals)")]
    NotANumber(String),
    /// NaN or infinite.
    #[error("{0} is not a finite number")]
    NotFinite(String),
    /// Too large.
    #[error("{0} is beyond {LARGEST:e} in magnitude")]
    TooLarge(String),
}

/// A finite number of at most 1e12 in magnitude, as in robot files.
///
/// # Errors
/// [`NumberError`].
pub fn number(text: &str) -> Result<f64, NumberError> {
    let text = text.trim();
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() && value.abs() <= LARGEST => Ok(value),
        Ok(value) if value.is_finite() => Err(NumberError::TooLarge(text.to_owned())),
        Ok(_) => Err(NumberError::NotFinite(text.to_owned())),
        Err(_) if text.is_empty() => Err(NumberError::Missing),
        Err(_) => Err(NumberError::NotANumber(text.to_owned())),
    }
}

/// `x,y,z`, of any length but zero.
fn direction(text: &str) -> Result<Vec3, PortError> {
    let components = text.split(',').map(number).collect::<Result<Vec<f64>, _>>()?;
    let [x, y, z] = components[..] else { return Err(PortError::Components(components.len())) };
    let vector = Vec3::new(x, y, z);
    if vector.norm() >= SHORTEST { Ok(vector) } else { Err(PortError::ZeroDirection) }
}

/// The unit vector of a world axis.
fn axis(name: &str) -> Option<Vec3> {
    match name {
        "x" => Some(Vec3::x()),
        "y" => Some(Vec3::y()),
        "z" => Some(Vec3::z()),
        _ => None,
    }
}

/// A point on a cable.
#[derive(Debug, Clone, PartialEq)]
pub struct OnCable {
    /// Name of the cable.
    pub name: String,
    /// Part of the unstrained length from the platform.
    pub fraction: f64,
}

/// `cable:NAME@FRACTION:WHAT`: the point, and WHAT. `None` if it does not begin so. The name may hold any character; the
/// last `@` ends it.
fn on_cable(text: &str) -> Result<Option<(OnCable, &str)>, PortError> {
    let Some(rest) = text.strip_prefix("cable:") else { return Ok(None) };
    let (name, rest) = rest.rsplit_once('@').ok_or(PortError::Form("`@`"))?;
    let (fraction, what) = rest.split_once(':').ok_or(PortError::Form("the direction"))?;
    let fraction = number(fraction)?;
    if !(0.0..=1.0).contains(&fraction) {
        return Err(PortError::Fraction(fraction));
    }
    Ok(Some((OnCable { name: name.to_owned(), fraction }, what)))
}

/// What drives the platform or a cable.
#[derive(Debug, Clone, PartialEq)]
pub struct Input {
    /// As it was written.
    pub name: String,
    /// Where, if not on the platform.
    pub on_cable: Option<OnCable>,
    /// A moment, not a force.
    pub is_moment: bool,
    /// Direction in world axes.
    pub direction_w: Vec3,
}

impl Input {
    /// Reads `fx` … `mz`, `f:ux,uy,uz`, `m:ux,uy,uz`; forces also after `cable:NAME@FRACTION:`.
    ///
    /// # Errors
    /// [`PortError`].
    ///
    /// # Example
    /// ```
    /// use funicular::ports::Input;
    ///
    /// assert!(Input::parse("mz")?.is_moment);
    /// assert_eq!(Input::parse("cable:3@0.5:fz")?.on_cable.unwrap().name, "3");
    /// assert!(Input::parse("z").is_err());
    /// # Ok::<(), funicular::ports::PortError>(())
    /// ```
    pub fn parse(text: &str) -> Result<Self, PortError> {
        let name = text.trim().to_owned();
        if let Some((place, what)) = on_cable(&name)? {
            let force = Self::parse(what)?;
            if force.is_moment || force.on_cable.is_some() {
                return Err(PortError::NotAForce(what.to_owned()));
            }
            return Ok(Self { name, on_cable: Some(place), ..force });
        }
        let (is_moment, direction_w) = if let Some(rest) = name.strip_prefix("f:") {
            (false, direction(rest)?)
        } else if let Some(rest) = name.strip_prefix("m:") {
            (true, direction(rest)?)
        } else if let Some(along) = name.strip_prefix('f').and_then(axis) {
            (false, along)
        } else if let Some(about) = name.strip_prefix('m').and_then(axis) {
            (true, about)
        } else {
            return Err(PortError::NotAnInput);
        };
        Ok(Self { name, on_cable: None, is_moment, direction_w })
    }

    /// Its direction on a robot, with the force at a point of the platform [m] (the origin, if none is given); if it is on
    /// a cable, only the direction counts.
    ///
    /// # Errors
    /// [`PortError`] if the robot cannot be driven so.
    pub fn direction(&self, robot: &Robot, point_p: Option<Vec3>) -> Result<Direction, PortError> {
        let Self { name, on_cable, is_moment: turns, direction_w } = self;
        End { side: "input", name, turns: *turns, on_cable: on_cable.is_some(), direction_w: *direction_w }
            .direction(robot, point_p)
    }
}

/// What is measured of the platform or a cable.
#[derive(Debug, Clone, PartialEq)]
pub struct Output {
    /// As it was written.
    pub name: String,
    /// Where, if not on the platform.
    pub on_cable: Option<OnCable>,
    /// A rotation, not a translation.
    pub is_rotation: bool,
    /// Displacement, velocity or acceleration.
    pub quantity: Quantity,
    /// Direction in world axes.
    pub direction_w: Vec3,
}

impl Output {
    /// Reads `x` … `rz`, with `v` or `a` before it, or `x:ux,uy,uz`, `v:…`, `a:…`; translations also after
    /// `cable:NAME@FRACTION:`.
    ///
    /// # Errors
    /// [`PortError`].
    ///
    /// # Example
    /// ```
    /// use funicular::{ports::Output, response::Quantity};
    ///
    /// let output = Output::parse("ary")?;
    /// assert!(output.is_rotation && output.quantity == Quantity::Acceleration);
    /// # Ok::<(), funicular::ports::PortError>(())
    /// ```
    pub fn parse(text: &str) -> Result<Self, PortError> {
        let name = text.trim().to_owned();
        if let Some((place, what)) = on_cable(&name)? {
            let motion = Self::parse(what)?;
            if motion.is_rotation || motion.on_cable.is_some() {
                return Err(PortError::NotATranslation(what.to_owned()));
            }
            return Ok(Self { name, on_cable: Some(place), ..motion });
        }
        let (quantity, is_rotation, direction_w) = Self::motion(&name)?;
        Ok(Self { name, on_cable: None, is_rotation, quantity, direction_w })
    }

    fn motion(name: &str) -> Result<(Quantity, bool, Vec3), PortError> {
        for (prefix, quantity) in
            [("x:", Quantity::Displacement), ("v:", Quantity::Velocity), ("a:", Quantity::Acceleration)]
        {
            if let Some(rest) = name.strip_prefix(prefix) {
                return Ok((quantity, false, direction(rest)?));
            }
        }
        let (quantity, rest) = match name.as_bytes().first() {
            Some(b'v') => (Quantity::Velocity, &name[1..]),
            Some(b'a') => (Quantity::Acceleration, &name[1..]),
            _ => (Quantity::Displacement, name),
        };
        if let Some(along) = axis(rest) {
            return Ok((quantity, false, along));
        }
        let about = rest.strip_prefix('r').and_then(axis).ok_or(PortError::NotAnOutput)?;
        Ok((quantity, true, about))
    }

    /// As [`Input::direction`].
    ///
    /// # Errors
    /// [`PortError`] if the robot does not move so.
    pub fn direction(&self, robot: &Robot, point_p: Option<Vec3>) -> Result<Direction, PortError> {
        let Self { name, on_cable, is_rotation: turns, direction_w, .. } = self;
        End { side: "output", name, turns: *turns, on_cable: on_cable.is_some(), direction_w: *direction_w }
            .direction(robot, point_p)
    }
}

/// One end of a response.
struct End<'a> {
    side: &'static str,
    name: &'a str,
    /// A moment or a rotation.
    turns: bool,
    on_cable: bool,
    direction_w: Vec3,
}

impl End<'_> {
    fn direction(&self, robot: &Robot, point_p: Option<Vec3>) -> Result<Direction, PortError> {
        let Self { side, name, turns, on_cable, direction_w } = *self;
        let name = name.to_owned();
        if on_cable && point_p.is_some() {
            return Err(PortError::PointOfCable { side, name });
        }
        if turns && point_p.is_some() {
            return Err(PortError::PointOfRotation { side, name });
        }
        match robot.platform.freedoms {
            Freedoms::PointMass if turns => return Err(PortError::PointMassTurns { side, name }),
            Freedoms::PointMass if point_p.is_some_and(|point| point.norm() > 0.0) => {
                return Err(PortError::PointMassPoint { side });
            }
            Freedoms::Planar(plane) if !on_cable => {
                let (normal, u) = (plane.normal_w(), direction_w.normalize());
                let along = normal.dot(&u);
                // A planar platform moves along its plane and turns about the normal.
                let possible = if turns { along.abs() } else { (u - normal * along).norm() };
                if possible < IN_PLANE {
                    let freedoms = robot.platform.freedoms.name();
                    return Err(PortError::OutOfPlane { side, name, freedoms, normal });
                }
            }
            Freedoms::Rigid | Freedoms::PointMass | Freedoms::Planar(_) => {}
        }
        Ok(if turns {
            Direction::About { axis_w: direction_w }
        } else {
            Direction::Along { direction_w, point_p: point_p.unwrap_or_default() }
        })
    }
}

/// The cable of a place, by its name.
///
/// # Errors
/// [`PortError::NoSuchCable`].
pub fn cable_of(robot: &Robot, place: &OnCable) -> Result<usize, PortError> {
    robot.cables.iter().position(|cable| cable.name == place.name).ok_or_else(|| PortError::NoSuchCable {
        name: place.name.clone(),
        names: robot.cables.iter().map(|cable| cable.name.clone()).collect(),
    })
}

/// Why two ports have no place on a robot.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum PlaceError {
    /// A cable that is not there.
    #[error(transparent)]
    Port(#[from] PortError),
    /// A cable whose motion is not known.
    #[error(transparent)]
    Motion(#[from] CableMotionError),
}

/// The points on cables where a response begins or ends.
#[derive(Debug, Clone)]
pub struct Places {
    /// Stations of the cables that are concerned.
    pub stations: Vec<CableStations>,
    /// Which stations, and which of them, the input is at; `None` on the platform.
    pub input: Option<(usize, usize)>,
    /// The same of the output.
    pub output: Option<(usize, usize)>,
}

impl Places {
    /// The places of an input and an output on a robot linearised about an equilibrium.
    ///
    /// # Errors
    /// [`PlaceError`].
    pub fn new(
        robot: &Robot,
        equilibrium: &Equilibrium,
        dynamics: &Dynamics,
        input: Option<&OnCable>,
        output: Option<&OnCable>,
    ) -> Result<Self, PlaceError> {
        let stations =
            |i: usize, fractions: &[f64]| CableStations::new(robot, equilibrium, dynamics, i, fractions, true);
        let mut places = Self { stations: Vec::new(), input: None, output: None };
        if let (Some(from), Some(to)) = (input, output)
            && from.name == to.name
        {
            places.stations.push(stations(cable_of(robot, from)?, &[from.fraction, to.fraction])?);
            return Ok(Self { input: Some((0, 0)), output: Some((0, 1)), ..places });
        }
        for (place, end) in [(input, &mut places.input), (output, &mut places.output)] {
            if let Some(place) = place {
                *end = Some((places.stations.len(), 0));
                places.stations.push(stations(cable_of(robot, place)?, &[place.fraction])?);
            }
        }
        Ok(places)
    }

    /// The port at a place: with the platform's vector if it is not on a cable.
    pub fn port(&self, place: Option<(usize, usize)>, vector: Vec6, direction_w: Vec3) -> Port<'_> {
        match place {
            None => Port::Platform(vector),
            Some((at, station)) => {
                let stations = &self.stations[at];
                Port::Cable { stations, station, direction_w: direction_w.normalize() }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inputs_and_outputs_have_the_names_of_the_field() {
        for (text, is_moment) in [("fx", false), ("mz", true), ("f:0,-1,1", false), ("m:1,0,0", true)] {
            assert_eq!(Input::parse(text).unwrap().is_moment, is_moment, "{text}");
        }
        for bad in ["", "f", "fw", "fxy", "f:0,0,0", "f:1,2", "x", "Fx"] {
            assert!(Input::parse(bad).is_err(), "{bad}");
        }
        for (text, quantity, is_rotation) in [
            ("x", Quantity::Displacement, false),
            ("rz", Quantity::Displacement, true),
            ("vy", Quantity::Velocity, false),
            ("ary", Quantity::Acceleration, true),
            ("a:0,1,1", Quantity::Acceleration, false),
            ("x:0,1,1", Quantity::Displacement, false),
        ] {
            let found = Output::parse(text).unwrap();
            assert!(found.quantity == quantity && found.is_rotation == is_rotation, "{text}");
        }
        for bad in ["", "a", "v", "r", "rw", "fz", "a:0,0,0", "é"] {
            assert!(Output::parse(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn a_point_on_a_cable_is_its_name_and_a_part_of_its_length() {
        let found = Output::parse("cable:left @ rope:2@0.25:a:0,1,1").unwrap();
        assert_eq!(found.on_cable, Some(OnCable { name: "left @ rope:2".to_owned(), fraction: 0.25 }));
        assert!(found.quantity == Quantity::Acceleration && found.direction_w == Vec3::new(0.0, 1.0, 1.0));
        assert_eq!(Input::parse("cable:3@1:fz").unwrap().on_cable.unwrap().fraction.to_bits(), 1.0_f64.to_bits());
        for bad in ["cable:3", "cable:3@0.5", "cable:3@1.5:z", "cable:3@-0.1:z", "cable:3@x:z", "cable:3@0.5:rz"] {
            assert!(Output::parse(bad).is_err(), "{bad}");
        }
        assert!(Input::parse("cable:3@0.5:mz").is_err());
    }
}

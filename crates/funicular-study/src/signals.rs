//! Names of signals: `fz` is a vertical force on the platform, `az` the vertical acceleration of the platform, and
//! `cable:3@0.5:az` the vertical acceleration of the middle of cable "3", `length:3` the commanded length of cable "3",
//! `base-x` a motion of the base, `anchor:3:z` one of the anchor of cable "3".
//!
//! A name is read once, checked for the robot, and converted to a [`Signal`].

use crate::values::{self, MIN_POSITIVE, NumberError};
use funicular::cable::catenary_dynamic::DriveSignal;
use funicular::math::Vec3;
use funicular::response::{FrameInput, Quantity, Signal};
use funicular::robot::{PlatformMotion, Robot};
use funicular::suggest::nearest;
use thiserror::Error;

/// Minimum in-plane fraction of a direction that a planar platform can follow.
const IN_PLANE: f64 = 1e-9;

/// Error of a name that is not a signal, or of a signal that does not exist on a robot.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum SignalError {
    /// Number that cannot be read or used.
    #[error(transparent)]
    Number(#[from] NumberError),
    /// Direction without exactly three components.
    #[error("{0} numbers where x,y,z are needed")]
    Components(usize),
    /// Direction of length zero.
    #[error("a direction cannot be zero")]
    ZeroDirection,
    /// Point on a cable with an incomplete name.
    #[error("{0} is missing: a point on a cable is cable:NAME@FRACTION:DIRECTION, as in cable:3@0.5:z")]
    Form(&'static str),
    /// Point beyond the ends of a cable.
    #[error("{0} is not a fraction of the cable's length: give 0 (platform) to 1 (anchor)")]
    Fraction(f64),
    /// Moment on a cable.
    #[error("{0} is not a force: only forces can act on a cable")]
    NotAForce(String),
    /// Rotation of a cable.
    #[error("{0} is not a translation: points of a cable have no rotation")]
    NotATranslation(String),
    /// Name that is not an input.
    #[error(
        "not an input: fx, fy, fz (force), mx, my, mz (moment), f:ux,uy,uz or m:ux,uy,uz (along a direction in world \
         axes), a force on a cable as in cable:3@0.5:fz, the commanded length of a cable as in length:3, a force of \
         its motor or on its drum as in motor:3 or drum:3, a motion of the base as in base-x or base-rz, or one of an \
         anchor as in anchor:3:x"
    )]
    NotAnInput,
    /// Name that is not an output.
    #[error(
        "not an output: x, y, z, rx, ry, rz (displacement, rotation), with v (velocity) or a (acceleration) before it \
         as in ay, or x:ux,uy,uz, v:ux,uy,uz, a:ux,uy,uz (along a direction in world axes), a point \
         of a cable as in cable:3@0.5:az, the motion of a drum or a motor as in drum:3 or motor:3, or the tension of a \
         cable at the platform or at its drum as in tension:3 or drum-tension:3"
    )]
    NotAnOutput,
    /// Cable that the robot does not have.
    #[error("the robot has no cable \"{name}\"{}", near_or_all(name, names))]
    NoSuchCable {
        /// Requested name.
        name: String,
        /// Names of the robot's cables.
        names: Vec<String>,
    },
    /// Anchor without a direction.
    #[error("the direction is missing: the motion of an anchor is anchor:NAME:DIRECTION, as in anchor:3:x")]
    AnchorForm,
    /// Signal of a drive or motion of the frame where none is possible.
    #[error("{0} is a signal of a drive or a motion of the base or of an anchor: `frf` takes these")]
    BesidePlatform(String),
    /// Point of the platform for a signal that is not on the platform.
    #[error(
        "the point of the {side} is a point of the platform, but the {side} {name} is not on the platform: leave out \
         the point"
    )]
    PointOfPlatform {
        /// `input` or `output`.
        side: &'static str,
        /// Name of the signal.
        name: String,
    },
    /// Point for a moment or a rotation.
    #[error(
        "the point of the {side} has no effect, because the {side} {name} is the same at every point: leave out the \
         point"
    )]
    PointOfRotation {
        /// `input` or `output`.
        side: &'static str,
        /// Name of the signal.
        name: String,
    },
    /// Rotation of a point mass.
    #[error(
        "a point mass has no rotation, so the {side} {name} is not possible: use a force (fx) and a translation (x, \
         vx, ax)"
    )]
    PointMassTurns {
        /// `input` or `output`.
        side: &'static str,
        /// Name of the signal.
        name: String,
    },
    /// Point of a point mass other than its origin.
    #[error("a point mass has no point except its origin: leave out the point of the {side}")]
    PointMassPoint {
        /// `input` or `output`.
        side: &'static str,
    },
    /// Signal that a planar platform cannot follow.
    #[error(
        "the {side} {name} is out of the plane of the platform ({dof}, normal {}, {}, {}), in which a guide holds \
         it: choose a direction in the plane, or the rotation about its normal",
        normal.x,
        normal.y,
        normal.z
    )]
    OutOfPlane {
        /// `input` or `output`.
        side: &'static str,
        /// Name of the signal.
        name: String,
        /// Kind of the platform.
        dof: &'static str,
        /// Normal of its plane.
        normal: Vec3,
    },
}

/// End of a message: `; did you mean …?` for a near name, else the names of all cables.
fn near_or_all(name: &str, names: &[String]) -> String {
    if let Some(near) = nearest(name, names.iter().map(String::as_str)) {
        return format!("; did you mean `{near}`?");
    }
    let all: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
    format!("; its cables are {}", all.join(", "))
}

/// Reads a direction `x,y,z` of any length except zero.
fn direction(text: &str) -> Result<Vec3, SignalError> {
    let components = text.split(',').map(values::number).collect::<Result<Vec<f64>, _>>()?;
    let [x, y, z] = components[..] else { return Err(SignalError::Components(components.len())) };
    let vector = Vec3::new(x, y, z);
    if vector.norm() >= MIN_POSITIVE { Ok(vector) } else { Err(SignalError::ZeroDirection) }
}

/// Unit vector of a world axis.
fn axis(name: &str) -> Option<Vec3> {
    match name {
        "x" => Some(Vec3::x()),
        "y" => Some(Vec3::y()),
        "z" => Some(Vec3::z()),
        _ => None,
    }
}

/// Signal of a drive from `length:NAME`, `drum:NAME`, `motor:NAME` or `tension:NAME`: the quantity and the cable's
/// name; `None` for another name.
fn of_drive(text: &str) -> Option<(DriveSignal, String)> {
    let (kind, cable) = text.split_once(':')?;
    let signal = DriveSignal::ALL.into_iter().find(|signal| signal.name() == kind)?;
    Some((signal, cable.to_owned()))
}

/// Given motion of the frame from `base-x` … `base-rz` or `anchor:NAME:x`; `None` for another name.
fn of_frame(text: &str) -> Result<Option<Place>, SignalError> {
    if let Some(rest) = text.strip_prefix("base-") {
        let (turns, rest) = rest.strip_prefix('r').map_or((false, rest), |rest| (true, rest));
        return Ok(axis(rest).map(|direction_w| Place::Base { turns, direction_w }));
    }
    let Some(rest) = text.strip_prefix("anchor:") else { return Ok(None) };
    let (cable, along) = rest.rsplit_once(':').ok_or(SignalError::AnchorForm)?;
    let direction_w = axis(along).map_or_else(|| direction(along), Ok)?;
    Ok(Some(Place::Anchor { cable: cable.to_owned(), direction_w }))
}

/// Place of an input or output, by names.
#[derive(Debug, Clone, PartialEq)]
pub enum Place {
    /// The platform: along a direction in world axes, or about it.
    Platform {
        /// True for a moment or a rotation.
        turns: bool,
        /// Direction in world axes.
        direction_w: Vec3,
    },
    /// A point of a cable.
    Cable {
        /// Name of the cable.
        cable: String,
        /// Fraction of its unstrained length from the platform, 0 to 1.
        fraction: f64,
        /// Direction in world axes.
        direction_w: Vec3,
    },
    /// A quantity of the drive of a cable.
    Drive {
        /// Name of the cable.
        cable: String,
        /// Quantity.
        signal: DriveSignal,
    },
    /// A given motion of the base with all anchors and drums; an input.
    Base {
        /// True for a rotation about an axis through the origin of the world.
        turns: bool,
        /// Direction in world axes.
        direction_w: Vec3,
    },
    /// A given motion of the anchor of a cable; an input.
    Anchor {
        /// Name of the cable.
        cable: String,
        /// Direction in world axes.
        direction_w: Vec3,
    },
}

impl Place {
    /// Checks that this is the platform or a point of a cable.
    fn on_platform_or_cable(&self, name: &str) -> Result<(), SignalError> {
        match self {
            Self::Platform { .. } | Self::Cable { .. } => Ok(()),
            Self::Drive { .. } | Self::Base { .. } | Self::Anchor { .. } => {
                Err(SignalError::BesidePlatform(name.to_owned()))
            }
        }
    }
}

/// Splits `cable:NAME@FRACTION:WHAT` into the point and WHAT; `None` if the text does not begin with `cable:`. The name
/// may hold any character; the last `@` ends it.
fn on_cable(text: &str) -> Result<Option<(String, f64, &str)>, SignalError> {
    let Some(rest) = text.strip_prefix("cable:") else { return Ok(None) };
    let (name, rest) = rest.rsplit_once('@').ok_or(SignalError::Form("`@`"))?;
    let (fraction, what) = rest.split_once(':').ok_or(SignalError::Form("the direction"))?;
    let fraction = values::number(fraction)?;
    if !(0.0..=1.0).contains(&fraction) {
        return Err(SignalError::Fraction(fraction));
    }
    Ok(Some((name.to_owned(), fraction, what)))
}

/// Input signal: a force or moment on the platform, a force on a cable, a quantity of a cable's drive, or a given
/// motion of the base or of an anchor.
#[derive(Debug, Clone, PartialEq)]
pub struct Input {
    /// Name as the user wrote it.
    pub name: String,
    /// Place.
    pub place: Place,
}

impl Input {
    /// Reads `fx` … `mz`, `f:ux,uy,uz`, `m:ux,uy,uz`; forces also after `cable:NAME@FRACTION:`; `length:NAME`,
    /// `drum:NAME`, `motor:NAME`; `base-x` … `base-rz`, `anchor:NAME:x`.
    ///
    /// # Errors
    /// [`SignalError`].
    ///
    /// # Example
    /// ```
    /// use funicular_study::signals::{Input, Place};
    ///
    /// assert!(matches!(Input::parse("mz")?.place, Place::Platform { turns: true, .. }));
    /// assert!(matches!(Input::parse("cable:3@0.5:fz")?.place, Place::Cable { cable, .. } if cable == "3"));
    /// assert!(Input::parse("z").is_err());
    /// # Ok::<(), funicular_study::signals::SignalError>(())
    /// ```
    pub fn parse(text: &str) -> Result<Self, SignalError> {
        let name = text.trim().to_owned();

        if let Some((cable, fraction, what)) = on_cable(&name)? {
            let Place::Platform { turns: false, direction_w } = Self::parse(what)?.place else {
                return Err(SignalError::NotAForce(what.to_owned()));
            };
            return Ok(Self { name, place: Place::Cable { cable, fraction, direction_w } });
        }

        if let Some((signal, cable)) = of_drive(&name).filter(|(signal, _)| signal.is_input()) {
            return Ok(Self { name, place: Place::Drive { cable, signal } });
        }

        if let Some(place) = of_frame(&name)? {
            return Ok(Self { name, place });
        }

        let (turns, direction_w) = if let Some(rest) = name.strip_prefix("f:") {
            (false, direction(rest)?)
        } else if let Some(rest) = name.strip_prefix("m:") {
            (true, direction(rest)?)
        } else if let Some(along) = name.strip_prefix('f').and_then(axis) {
            (false, along)
        } else if let Some(about) = name.strip_prefix('m').and_then(axis) {
            (true, about)
        } else {
            return Err(SignalError::NotAnInput);
        };

        Ok(Self { name, place: Place::Platform { turns, direction_w } })
    }

    /// Signal on a robot, with the force at a point of the platform [m] (default: the origin).
    ///
    /// # Errors
    /// [`SignalError`] if the robot has no such input.
    pub fn signal(&self, robot: &Robot, point_p: Option<Vec3>) -> Result<Signal, SignalError> {
        ResponseEnd { side: "input", name: &self.name, place: &self.place }.signal(robot, point_p)
    }

    /// Unit of the signal.
    pub fn unit(&self) -> &'static str {
        match &self.place {
            Place::Platform { turns: true, .. } => "N m",
            Place::Drive { signal: DriveSignal::Length, .. }
            | Place::Base { turns: false, .. }
            | Place::Anchor { .. } => "m",
            Place::Base { turns: true, .. } => "rad",
            Place::Platform { .. } | Place::Cable { .. } | Place::Drive { .. } => "N",
        }
    }

    /// Checks that this is a force or moment on the platform, or a force on a cable.
    ///
    /// # Errors
    /// [`SignalError::BesidePlatform`].
    pub(crate) fn on_platform_or_cable(&self) -> Result<(), SignalError> {
        self.place.on_platform_or_cable(&self.name)
    }
}

/// Output signal: a motion of the platform or of a point on a cable, or a quantity of a cable's drive.
#[derive(Debug, Clone, PartialEq)]
pub struct Output {
    /// Name as the user wrote it.
    pub name: String,
    /// Place.
    pub place: Place,
    /// Displacement, velocity or acceleration.
    pub quantity: Quantity,
}

impl Output {
    /// Reads `x` … `rz`, with `v` or `a` before it, or `x:ux,uy,uz`, `v:…`, `a:…`; translations also after
    /// `cable:NAME@FRACTION:`; `drum:NAME`, `motor:NAME`, `tension:NAME`.
    ///
    /// # Errors
    /// [`SignalError`].
    ///
    /// # Example
    /// ```
    /// use funicular::response::Quantity;
    /// use funicular_study::signals::Output;
    ///
    /// let output = Output::parse("ary")?;
    /// assert!(output.is_rotation() && output.quantity == Quantity::Acceleration);
    /// # Ok::<(), funicular_study::signals::SignalError>(())
    /// ```
    pub fn parse(text: &str) -> Result<Self, SignalError> {
        let name = text.trim().to_owned();
        if let Some((cable, fraction, what)) = on_cable(&name)? {
            let Self { place: Place::Platform { turns: false, direction_w }, quantity, .. } = Self::parse(what)? else {
                return Err(SignalError::NotATranslation(what.to_owned()));
            };
            return Ok(Self { name, place: Place::Cable { cable, fraction, direction_w }, quantity });
        }
        if let Some((signal, cable)) = of_drive(&name).filter(|(signal, _)| signal.is_output()) {
            return Ok(Self { name, place: Place::Drive { cable, signal }, quantity: Quantity::Displacement });
        }
        let (quantity, turns, direction_w) = Self::motion(&name)?;
        Ok(Self { name, place: Place::Platform { turns, direction_w }, quantity })
    }

    fn motion(name: &str) -> Result<(Quantity, bool, Vec3), SignalError> {
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
        let about = rest.strip_prefix('r').and_then(axis).ok_or(SignalError::NotAnOutput)?;
        Ok((quantity, true, about))
    }

    /// Signal on a robot, measured at a point of the platform [m] (default: the origin).
    ///
    /// # Errors
    /// [`SignalError`] if the robot has no such output.
    pub fn signal(&self, robot: &Robot, point_p: Option<Vec3>) -> Result<Signal, SignalError> {
        ResponseEnd { side: "output", name: &self.name, place: &self.place }.signal(robot, point_p)
    }

    /// True for a rotation of the platform.
    pub fn is_rotation(&self) -> bool {
        matches!(self.place, Place::Platform { turns: true, .. })
    }

    /// Unit of the signal as a displacement, or as the tension of a cable.
    pub fn unit(&self) -> &'static str {
        match &self.place {
            Place::Drive { signal, .. } if signal.is_tension() => "N",
            Place::Platform { turns: true, .. } => "rad",
            _ => "m",
        }
    }

    /// Checks that this is a motion of the platform or of a point on a cable.
    ///
    /// # Errors
    /// [`SignalError::BesidePlatform`].
    pub(crate) fn on_platform_or_cable(&self) -> Result<(), SignalError> {
        self.place.on_platform_or_cable(&self.name)
    }
}

/// Input or output of a response.
struct ResponseEnd<'a> {
    side: &'static str,
    name: &'a str,
    place: &'a Place,
}

impl ResponseEnd<'_> {
    fn signal(&self, robot: &Robot, point_p: Option<Vec3>) -> Result<Signal, SignalError> {
        let (side, name) = (self.side, self.name.to_owned());
        let has_point = point_p.is_some();
        let none = |signal: Result<Signal, SignalError>| {
            if has_point { Err(SignalError::PointOfPlatform { side, name: name.clone() }) } else { signal }
        };

        match self.place {
            Place::Platform { turns, direction_w } => self.on_platform(robot, *turns, *direction_w, point_p),
            Place::Cable { cable, fraction, direction_w } => {
                none(cable_of(robot, cable).map(|cable| Signal::OnCable {
                    cable,
                    fraction: *fraction,
                    direction_w: *direction_w,
                }))
            }
            Place::Drive { cable, signal } => {
                none(cable_of(robot, cable).map(|cable| Signal::Drive { cable, signal: *signal }))
            }
            Place::Base { turns: false, direction_w } => none(Ok(Signal::Frame(FrameInput::BaseAlong(*direction_w)))),
            Place::Base { turns: true, direction_w } => none(Ok(Signal::Frame(FrameInput::BaseAbout(*direction_w)))),
            Place::Anchor { cable, direction_w } => none(
                cable_of(robot, cable)
                    .map(|cable| Signal::Frame(FrameInput::Anchor { cable, direction_w: *direction_w })),
            ),
        }
    }

    fn on_platform(
        &self,
        robot: &Robot,
        turns: bool,
        direction_w: Vec3,
        point_p: Option<Vec3>,
    ) -> Result<Signal, SignalError> {
        let (side, name) = (self.side, self.name.to_owned());
        if turns && point_p.is_some() {
            return Err(SignalError::PointOfRotation { side, name });
        }

        match robot.platform.motion {
            PlatformMotion::PointMass if turns => return Err(SignalError::PointMassTurns { side, name }),
            PlatformMotion::PointMass if point_p.is_some_and(|point| point.norm() > 0.0) => {
                return Err(SignalError::PointMassPoint { side });
            }
            PlatformMotion::Planar(plane) => {
                let (normal, u) = (plane.normal_w(), direction_w.normalize());
                let along = normal.dot(&u);
                // A planar platform moves in its plane and rotates about the normal.
                let possible = if turns { along.abs() } else { (u - normal * along).norm() };
                if possible < IN_PLANE {
                    let dof = robot.platform.motion.name();
                    return Err(SignalError::OutOfPlane { side, name, dof, normal });
                }
            }
            PlatformMotion::Rigid | PlatformMotion::PointMass => {}
        }

        let along = Signal::Along { direction_w, point_p: point_p.unwrap_or_default() };
        Ok(if turns { Signal::About { axis_w: direction_w } } else { along })
    }
}

/// Index of the cable with a name, in the order of the file.
fn cable_of(robot: &Robot, name: &str) -> Result<usize, SignalError> {
    robot.cables.iter().position(|cable| cable.name == *name).ok_or_else(|| SignalError::NoSuchCable {
        name: name.to_owned(),
        names: robot.cables.iter().map(|cable| cable.name.clone()).collect(),
    })
}

/// Inputs and outputs with their signals on a robot.
pub(crate) type SignalLists = (Vec<(Input, Signal)>, Vec<(Output, Signal)>);

/// Unit of a response: motion divided by force or moment.
pub fn response_unit(input: &Input, output: &Output) -> String {
    let motion = output.unit();
    let by_time = match output.quantity {
        Quantity::Displacement => "",
        Quantity::Velocity => "/s",
        Quantity::Acceleration => "/s²",
    };
    let effort = if input.unit() == "N m" { "(N·m)" } else { input.unit() };
    if by_time.is_empty() { format!("{motion}/{effort}") } else { format!("({motion}{by_time})/{effort}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inputs_and_outputs_have_the_names_of_the_field() {
        for (text, unit) in [
            ("fx", "N"),
            ("mz", "N m"),
            ("f:0,-1,1", "N"),
            ("m:1,0,0", "N m"),
            ("length:3", "m"),
            ("base-z", "m"),
            ("base-ry", "rad"),
            ("anchor:left: 2:0,1,1", "m"),
        ] {
            assert_eq!(Input::parse(text).unwrap().unit(), unit, "{text}");
        }
        for bad in ["", "f", "fw", "fxy", "f:0,0,0", "f:1,2", "x", "Fx", "base-w", "base-", "anchor:3", "anchor:3:w"] {
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
            assert!(found.quantity == quantity && found.is_rotation() == is_rotation, "{text}");
        }

        for bad in ["", "a", "v", "r", "rw", "fz", "a:0,0,0", "é"] {
            assert!(Output::parse(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn a_point_on_a_cable_is_its_name_and_a_part_of_its_length() {
        let found = Output::parse("cable:left @ rope:2@0.25:a:0,1,1").unwrap();
        let (cable, direction_w) = ("left @ rope:2".to_owned(), Vec3::new(0.0, 1.0, 1.0));
        assert_eq!(found.place, Place::Cable { cable, fraction: 0.25, direction_w });
        assert_eq!(found.quantity, Quantity::Acceleration);
        assert!(matches!(Input::parse("cable:3@1:fz").unwrap().place, Place::Cable { fraction: 1.0, .. }));
        for bad in ["cable:3", "cable:3@0.5", "cable:3@1.5:z", "cable:3@-0.1:z", "cable:3@x:z", "cable:3@0.5:rz"] {
            assert!(Output::parse(bad).is_err(), "{bad}");
        }
        assert!(Input::parse("cable:3@0.5:mz").is_err());
    }
}

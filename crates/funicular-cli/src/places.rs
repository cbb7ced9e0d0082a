//! Where forces act and motion is measured: on the platform, or on cables.

use crate::args::PointArgs;
use crate::args::values::{Input, OnCable, Output};
use crate::state::AtRest;
use anyhow::{Result, anyhow, bail};
use funicular::cable_motion::CableStations;
use funicular::dynamics::Dynamics;
use funicular::math::{Vec3, Vec6};
use funicular::response::{Direction, Port};
use funicular::robot::{Freedoms, Robot};
use funicular_files::edit;

/// The points on cables where a response begins or ends.
pub(crate) struct Places {
    pub(crate) stations: Vec<CableStations>,
    /// Which stations, and which of them; `None` on the platform.
    pub(crate) input: Option<(usize, usize)>,
    pub(crate) output: Option<(usize, usize)>,
}

impl Places {
    pub(crate) fn new(
        at_rest: &AtRest,
        dynamics: &Dynamics,
        input: Option<&OnCable>,
        output: Option<&OnCable>,
    ) -> Result<Self> {
        let AtRest { robot, equilibrium, .. } = at_rest;
        let stations =
            |i: usize, fractions: &[f64]| CableStations::new(robot, equilibrium, dynamics, i, fractions, true);
        let cable = |place: &OnCable| cable_of(robot, place);
        let mut places = Self { stations: Vec::new(), input: None, output: None };
        if let (Some(from), Some(to)) = (input, output)
            && from.name == to.name
        {
            places.stations.push(stations(cable(from)?, &[from.fraction, to.fraction])?);
            return Ok(Self { input: Some((0, 0)), output: Some((0, 1)), ..places });
        }
        for (place, end) in [(input, &mut places.input), (output, &mut places.output)] {
            if let Some(place) = place {
                *end = Some((places.stations.len(), 0));
                places.stations.push(stations(cable(place)?, &[place.fraction])?);
            }
        }
        Ok(places)
    }

    /// The port at a place: with the platform's vector if it is not on a cable.
    pub(crate) fn port(&self, place: Option<(usize, usize)>, vector: Vec6, direction_w: Vec3) -> Port<'_> {
        match place {
            None => Port::Platform(vector),
            Some((at, station)) => {
                let stations = &self.stations[at];
                Port::Cable { stations, station, direction_w: direction_w.normalize() }
            }
        }
    }
}

/// The cable of a place, by its name.
pub(crate) fn cable_of(robot: &Robot, place: &OnCable) -> Result<usize> {
    robot.cables.iter().position(|cable| cable.name == place.name).ok_or_else(|| {
        let names: Vec<String> = robot.cables.iter().map(|cable| cable.name.clone()).collect();
        anyhow!("the robot has no cable \"{}\"{}", place.name, edit::suggestion(&place.name, &names))
    })
}

/// Input and output of a response, checked against what the robot can do.
pub(crate) fn directions(
    robot: &Robot,
    input: &Input,
    output: &Output,
    points: &PointArgs,
) -> Result<(Direction, Direction)> {
    Ok((input_direction(robot, input, points.input_point_m)?, output_direction(robot, output, points.output_point_m)?))
}

/// An input, checked against what the robot can do; if it is on a cable, only its direction counts.
pub(crate) fn input_direction(robot: &Robot, input: &Input, point: Option<Vec3>) -> Result<Direction> {
    let Input { name, on_cable, is_moment: turns, direction_w } = input;
    Side { option: "--input", name, turns: *turns, on_cable: on_cable.is_some(), direction_w: *direction_w }
        .direction(robot, point)
}

/// The same for an output.
pub(crate) fn output_direction(robot: &Robot, output: &Output, point: Option<Vec3>) -> Result<Direction> {
    let Output { name, on_cable, is_rotation: turns, direction_w, .. } = output;
    Side { option: "--output", name, turns: *turns, on_cable: on_cable.is_some(), direction_w: *direction_w }
        .direction(robot, point)
}

/// One end of a response.
struct Side<'a> {
    option: &'static str,
    name: &'a str,
    /// A moment or a rotation.
    turns: bool,
    on_cable: bool,
    direction_w: Vec3,
}

impl Side<'_> {
    fn direction(&self, robot: &Robot, point: Option<Vec3>) -> Result<Direction> {
        let Self { option, name, turns, on_cable, direction_w } = *self;
        if on_cable && point.is_some() {
            bail!("{option}-point-m is a point of the platform: {option} {name} is on a cable; remove it");
        }
        if turns && point.is_some() {
            bail!("{option}-point-m has no effect: {option} {name} is the same at every point; remove it");
        }
        check_point_mass(robot, turns, option, name, point)?;
        if !on_cable {
            check_plane(robot, turns, option, name, &direction_w)?;
        }
        Ok(if turns {
            Direction::About { axis_w: direction_w }
        } else {
            Direction::Along { direction_w, point_p: point.unwrap_or_default() }
        })
    }
}

/// A planar platform moves along its plane and turns about the normal.
fn check_plane(robot: &Robot, turns: bool, option: &str, name: &str, direction_w: &Vec3) -> Result<()> {
    let Freedoms::Planar(plane) = robot.platform.freedoms else { return Ok(()) };
    let (normal, u) = (plane.normal_w(), direction_w.normalize());
    let along = normal.dot(&u);
    let possible = if turns { along.abs() } else { (u - normal * along).norm() };
    if possible < 1e-9 {
        let freedoms = robot.platform.freedoms.name();
        bail!(
            "{option} {name} is out of the plane of the platform ({freedoms}, normal {}, {}, {}), in which a guide holds \
             it: choose a direction in the plane, or the rotation about its normal",
            normal.x,
            normal.y,
            normal.z
        );
    }
    Ok(())
}

/// A point mass neither turns nor extends.
fn check_point_mass(robot: &Robot, turns: bool, option: &str, name: &str, point: Option<Vec3>) -> Result<()> {
    if robot.platform.freedoms != Freedoms::PointMass {
        return Ok(());
    }
    if turns {
        bail!(
            "a point mass does not turn: {option} {name} is not possible; use a force (fx) and a translation (x, vx, ax)"
        );
    }
    if point.is_some_and(|point| point.norm() > 0.0) {
        bail!("a point mass has no points but its origin: remove {option}-point-m");
    }
    Ok(())
}

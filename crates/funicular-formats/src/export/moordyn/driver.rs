//! A scenario for MoorDyn: a Python script that has the input file in it and commands the lengths of the lines.
//!
//! An input file has the mass of its body and the lengths of its lines for all times. A release from rest is therefore
//! a file with the mass after it and the place before it; lengths are set by the script while MoorDyn runs.

use anyhow::{Result, anyhow, bail};
use askama::Template;
use funicular::math::Vec3;
use funicular::robot::{PlatformMotion, Robot};
use funicular::simulation::{CommandedLengths, SimulationEvent, without_payload};
use funicular_study::analyses::simulate::ScenarioEvents;
use funicular_study::at_rest::AtRest;
use funicular_study::request::Scenario;

/// Rows of the result, as `simulate` has them.
const ROWS: f64 = 1000.0;

#[derive(Template)]
#[template(path = "moordyn.py", escape = "none")]
struct MoorDynDriver {
    released: f64,
    start: f64,
    end: f64,
    row: f64,
    is_body: bool,
    /// Texts of Python: names of the cables, and lines of the input file.
    cables: Vec<String>,
    input: Vec<String>,
    /// Numbers of the lines whose lengths change, from 1.
    moved: String,
    /// Times, changes of these lines, and rates of the changes.
    commands: Vec<String>,
}

/// Refuses what MoorDyn cannot hold, before any computation.
///
/// # Errors
/// The event, and why.
pub(crate) fn refuse(scenario: &Scenario) -> Result<()> {
    let Scenario { release, pick, lengths: _, tension, stop: _, push, cut } = scenario;
    let kept = "a body of MoorDyn keeps the mass of its file";
    let events = [
        ("pick", pick.len(), format!("{kept}, so that it cannot take a payload up")),
        (
            "tension",
            tension.len(),
            "a line of MoorDyn has a commanded length, and no winch holds its tension".to_owned(),
        ),
        ("push", push.len(), "MoorDyn has no forces on a body but weight and water".to_owned()),
        ("cut", cut.len(), "a script for MoorDyn does not break lines".to_owned()),
    ];
    if let Some((kind, _, why)) = events.iter().find(|(_, count, _)| *count > 0) {
        bail!(
            "[[{kind}]] of ⟪scenario⟫: {why}. A file for MoorDyn can have a release from rest, lengths and stops: leave it \
             out, or use `simulate`"
        );
    }
    let later = release.iter().position(|of| of.at_s != release[0].at_s);
    if let Some(k) = later {
        bail!(
            "[[release]] number {} of ⟪scenario⟫ is at another time than the first: {kept}, so that a file can begin with \
             one release only; leave it out, or use `simulate`",
            k + 1
        );
    }
    Ok(())
}

/// What happens after the equilibrium.
pub(crate) struct MoorDynCourse {
    /// Robot after the release, at the place before it.
    pub(crate) after: AtRest,
    /// Mass of the released payload [kg].
    pub(crate) released: f64,
    lengths: CommandedLengths,
    /// Time from which on MoorDyn runs [s].
    start: f64,
    end: f64,
}

impl MoorDynCourse {
    /// Course of a scenario.
    ///
    /// # Errors
    /// An event that cannot happen, or a release after a change of length.
    pub(crate) fn of(at_rest: &AtRest, scenario: &Scenario, duration: f64) -> Result<Self> {
        let events = ScenarioEvents::of(scenario, at_rest)?;
        let lengths = CommandedLengths::new(&at_rest.robot, &at_rest.equilibrium, &events.list, duration)
            .map_err(|error| events.told(error))?;
        let (mut after, mut released, mut start) = (at_rest.clone(), 0.0, 0.0);
        for (event, label) in events.list.iter().zip(&events.labels) {
            let SimulationEvent::Release { time, mass, point_p } = *event else { continue };
            if lengths.knots().first().is_some_and(|first| *first < time) {
                bail!(
                    "{label} of ⟪scenario⟫: at {time} s the winches have begun to move, and a body of MoorDyn keeps the \
                     mass of its file, so that only a release from rest can be written; move it to the beginning, or use \
                     `simulate`"
                );
            }
            after.robot = without_payload(&after.robot, mass, point_p)
                .map_err(|fault| anyhow!("{label} of ⟪scenario⟫: {fault}"))?;
            released += mass;
            start = time;
        }
        if start >= duration {
            bail!("[[release]] of ⟪scenario⟫ is at the end of ⟪duration_s⟫, {duration} s: give a longer time");
        }
        Ok(Self { after, released, lengths, start, end: duration })
    }

    /// Script that runs the input file.
    ///
    /// # Errors
    /// A template that cannot be filled.
    pub(crate) fn script(&self, input: &str, warnings: &mut Vec<String>) -> Result<String> {
        let robot = &self.after.robot;
        warn(robot, warnings);
        let all = self.lengths.knots();
        let has_moved = |i: &usize| all.iter().any(|time| self.change(*i, *time) != 0.0);
        let moved: Vec<usize> = (0..robot.cables.len()).filter(has_moved).collect();
        let row = |time: &f64| {
            let changes: Vec<f64> = moved.iter().map(|i| self.change(*i, *time)).collect();
            let rates: Vec<f64> = moved.iter().map(|i| self.lengths.at(*i, *time).rate + 0.0).collect();
            python(&(time, changes, rates))
        };
        let text = |text: &str| python(&text);
        let script = MoorDynDriver {
            released: self.released,
            start: self.start,
            end: self.end,
            row: self.end / ROWS,
            is_body: robot.platform.motion != PlatformMotion::PointMass,
            cables: robot.cables.iter().map(|cable| text(&cable.name)).collect::<Result<_>>()?,
            input: input.lines().map(text).collect::<Result<_>>()?,
            commands: if moved.is_empty() { Vec::new() } else { all.iter().map(row).collect::<Result<_>>()? },
            moved: python(&moved.iter().map(|i| i + 1).collect::<Vec<usize>>())?,
        };
        Ok(script.render()? + "\n")
    }

    /// Change of a length since the start [m].
    fn change(&self, cable: usize, time: f64) -> f64 {
        self.lengths.at(cable, time).value - self.after.equilibrium.cables[cable].unstrained_length
    }
}

/// Numbers, lists and texts as JSON and Python both write them.
fn python(value: &impl serde::Serialize) -> Result<String> {
    Ok(serde_json::to_string(value)?)
}

/// Says what `simulate` has and MoorDyn has not.
fn warn(robot: &Robot, warnings: &mut Vec<String>) {
    if robot.cables.iter().any(|cable| cable.anchor.winch.is_some()) {
        warnings
            .push("lengths of lines follow their commands at once: inertia and control of winches are left out".into());
    }
    let platform = &robot.platform;
    let damped =
        [platform.translational_damping_p, platform.rotational_damping_p].iter().any(|of| *of != Vec3::zeros());
    if damped || platform.drag_area != 0.0 {
        warnings.push("the damping of the platform and the drag of the air are left out".into());
    }
}

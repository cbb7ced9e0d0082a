//! A scenario for MoorDyn: a Python script that has the input file in it and commands the lengths of the lines.
//!
//! An input file has the mass of its body and the lengths of its lines for all times. A release from rest is therefore
//! a file with the mass after it and the place before it; the script sets lengths and breaks lines while MoorDyn runs.

use anyhow::{Result, anyhow, bail};
use askama::Template;
use funicular::math::Vec3;
use funicular::robot::{PlatformMotion, Robot};
use funicular::simulation::{CommandedLengths, CutAt, EventFault, SimulationError, SimulationEvent, without_payload};
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
    /// Times of cuts, with the number of the line and of its point at the platform.
    cuts: String,
}

/// Refuses what MoorDyn cannot hold, before any computation.
///
/// # Errors
/// The event, and why.
pub(crate) fn refuse(scenario: &Scenario) -> Result<()> {
    let Scenario { release, pick, lengths: _, tension, stop: _, push, anchor, cut } = scenario;
    let kept = "a body of MoorDyn keeps the mass of its file";
    let parted = cut.iter().filter(|of| of.place_m != 0.0).count();
    let fuses = cut.iter().filter(|of| of.at_tension_n.is_some()).count();
    let events = [
        ("pick", pick.len(), format!("{kept}, so that it cannot take a payload up")),
        ("tension", tension.len(), "a line of MoorDyn has a length, and no winch holds its tension".to_owned()),
        ("push", push.len(), "MoorDyn has no forces on a body but weight and water".to_owned()),
        ("anchor", anchor.len(), "the script moves no points of MoorDyn; let the anchors rest".to_owned()),
        ("cut", fuses, "a line of MoorDyn breaks when the script says so, not at a tension; give `at_s`".to_owned()),
        ("cut", parted, "the script frees the end of a line, and cannot part it; leave `place_m` out".to_owned()),
    ];
    if let Some((kind, _, why)) = events.iter().find(|(_, count, _)| *count > 0) {
        bail!(
            "[[{kind}]] of ⟪scenario⟫: {why}. A script for MoorDyn can have a release from rest, lengths, stops and \
             cuts at a time: leave it out, or use `simulate`"
        );
    }
    let later = release.iter().position(|of| of.at_s.total_cmp(&release[0].at_s).is_ne());
    if let Some(k) = later {
        bail!(
            "[[release]] number {} of ⟪scenario⟫ is at another time than the first: {kept}, so that a file can begin \
             with one release only; leave it out, or use `simulate`",
            k + 1
        );
    }
    Ok(())
}

/// Course of a scenario from the equilibrium on.
pub(crate) struct MoorDynCourse {
    /// Robot after the release, at the place before it.
    pub(crate) after: AtRest,
    /// Mass of the released payload [kg].
    pub(crate) released: f64,
    lengths: CommandedLengths,
    /// Times and cables that fail, by time.
    cuts: Vec<(f64, usize)>,
    /// Time from which on MoorDyn runs [s].
    start: f64,
    end: f64,
}

impl MoorDynCourse {
    /// Course of a scenario within a duration [s].
    ///
    /// # Errors
    /// An event that cannot happen, or a release when the robot is no longer at rest.
    pub(crate) fn of(at_rest: &AtRest, scenario: &Scenario, duration: f64) -> Result<Self> {
        let events = ScenarioEvents::of(scenario, at_rest)?;
        let lengths = CommandedLengths::new(&at_rest.robot, &at_rest.equilibrium, &events.list, duration)
            .map_err(|error| events.told(error))?;
        let cuts = cuts(at_rest, &events)?;
        let first = lengths.knots().first().copied().into_iter().chain(cuts.first().map(|cut| cut.0));
        let first = first.fold(f64::INFINITY, f64::min);
        let (mut after, mut released, mut start) = (at_rest.clone(), 0.0, 0.0);
        for (event, label) in events.list.iter().zip(&events.labels) {
            let SimulationEvent::Release { time, mass, point_p } = *event else { continue };
            if first < time {
                bail!(
                    "{label} of ⟪scenario⟫: at {time} s the robot is no longer at rest, and a body of MoorDyn keeps \
                     the mass of its file, so that only a release from rest can be written; move it to the beginning, \
                     or use `simulate`"
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
        Ok(Self { after, released, lengths, cuts, start, end: duration })
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
            cuts: python(&self.cuts.iter().map(|(time, i)| (time, i + 1, self.point_of(*i))).collect::<Vec<_>>())?,
            commands: if moved.is_empty() { Vec::new() } else { all.iter().map(row).collect::<Result<_>>()? },
            moved: python(&moved.iter().map(|i| i + 1).collect::<Vec<usize>>())?,
        };
        Ok(script.render()? + "\n")
    }

    /// Number of the point at which a cable holds the platform.
    fn point_of(&self, cable: usize) -> usize {
        let robot = &self.after.robot;
        let own = if robot.platform.motion == PlatformMotion::PointMass { 0 } else { cable };
        robot.cables.len() + 1 + own
    }

    /// Change of a length since the start [m].
    fn change(&self, cable: usize, time: f64) -> f64 {
        self.lengths.at(cable, time).value - self.after.equilibrium.cables[cable].unstrained_length
    }
}

/// Times and cables that fail, by time.
///
/// # Errors
/// A cable that fails twice, or the last one.
fn cuts(at_rest: &AtRest, events: &ScenarioEvents) -> Result<Vec<(f64, usize)>> {
    let cut = |event: &SimulationEvent| match *event {
        SimulationEvent::Cut { cable, at: CutAt::Time(time), .. } => Some((time, cable)),
        _ => None,
    };
    let mut found: Vec<(usize, f64, usize)> =
        (events.list.iter().enumerate()).filter_map(|(k, event)| cut(event).map(|(time, i)| (k, time, i))).collect();
    found.sort_by(|a, b| a.1.total_cmp(&b.1));
    for (n, (event, _, i)) in found.iter().enumerate() {
        let cable = at_rest.robot.cables[*i].name.clone();
        let refused = if found[..n].iter().any(|earlier| earlier.2 == *i) {
            Some(EventFault::CutTwice { cable })
        } else {
            (n + 1 == at_rest.robot.cables.len()).then_some(EventFault::LastCable { cable })
        };
        if let Some(fault) = refused {
            return Err(events.told(SimulationError::Event { event: *event, fault }));
        }
    }
    Ok(found.into_iter().map(|(_, time, i)| (time, i)).collect())
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

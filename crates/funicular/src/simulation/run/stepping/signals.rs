//! Inputs and outputs of a simulation in intervals by their names, as other programs connect them.

use super::{AnchorAtEnd, LengthAtEnd, StepError, StepInputs, SteppedSimulation, WrenchInput};
use crate::math::Vec3;
use crate::robot::Robot;
use crate::simulation::RobotSample;

const AXES: [&str; 3] = ["x", "y", "z"];

/// Input or output with a name.
#[derive(Debug, Clone, PartialEq)]
pub struct StepSignal {
    /// Name, which ends with the unit.
    pub name: String,
    /// Unit; `1` for a number without one.
    pub unit: &'static str,
    /// Value at the start.
    pub start: f64,
    /// True for an output that follows at once from an input of the same interval: a force, or the acceleration of a
    /// length or an anchor.
    pub follows_at_once: bool,
    of: SignalOf,
}

/// Number that a signal is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum SignalOf {
    Length(usize),
    LengthRate(usize),
    Anchor(usize, usize),
    AnchorVelocity(usize, usize),
    Force(usize),
    Moment(usize),
    Wind(usize),
    Position(usize),
    Quaternion(usize),
    Velocity(usize),
    Acceleration(usize),
    TensionPlatform(usize),
    TensionAnchor(usize),
    LengthNow(usize),
    LengthRateNow(usize),
    EnergyDefect,
}

/// Inputs and outputs of a robot.
#[derive(Debug, Clone, PartialEq)]
pub struct StepSignals {
    /// Inputs: lengths with rates, places of anchors with velocities, force and moment, wind.
    pub inputs: Vec<StepSignal>,
    /// Outputs: motion of the platform, tensions, lengths, defect of the energy.
    pub outputs: Vec<StepSignal>,
}

impl StepSignals {
    /// Signals of a simulation; their start values are those of its present time.
    pub fn of(simulation: &mut SteppedSimulation) -> Self {
        let robot = simulation.robot().clone();
        let now = simulation.now();
        let mut signals = Self { inputs: inputs(&robot, simulation), outputs: outputs(&robot) };
        for input in &mut signals.inputs {
            input.start = match input.of {
                SignalOf::Length(i) => now.cables[i].length.value,
                SignalOf::Anchor(i, axis) => robot.cables[i].anchor.point_w[axis],
                SignalOf::Wind(axis) => robot.wind.velocity_w[axis],
                _ => 0.0,
            };
        }
        let values = signals.values(&now);
        signals.outputs.iter_mut().zip(values).for_each(|(output, value)| output.start = value);
        signals
    }

    /// Advances by an interval [s] with values of all inputs, in their order. A length or an anchor whose values are
    /// those of its rest goes on resting.
    ///
    /// # Errors
    /// [`StepError`]; the simulation is then as it was.
    pub fn step(
        &self,
        simulation: &mut SteppedSimulation,
        interval: f64,
        values: &[f64],
    ) -> Result<RobotSample, StepError> {
        if values.len() != self.inputs.len() {
            return Err(StepError::SignalCount { given: values.len(), inputs: self.inputs.len() });
        }
        let inputs = self.step_inputs(simulation, values);
        simulation.step(interval, &inputs)
    }

    fn step_inputs(&self, simulation: &SteppedSimulation, values: &[f64]) -> StepInputs {
        let robot = simulation.robot();
        let mut inputs = StepInputs::default();
        let mut wrench = WrenchInput::default();
        let (mut wind_w, mut has_wind) = (Vec3::zeros(), false);
        let cables = robot.cables.len();
        let still = LengthAtEnd { length: 0.0, rate: Some(0.0), acceleration: None };
        let home = AnchorAtEnd { place_w: Vec3::zeros(), velocity_w: Some(Vec3::zeros()), acceleration_w: None };
        for (signal, value) in self.inputs.iter().zip(values) {
            match signal.of {
                SignalOf::Length(i) | SignalOf::LengthRate(i) => {
                    inputs.lengths.resize(cables, None);
                    let command = inputs.lengths[i].get_or_insert(still);
                    if let SignalOf::Length(_) = signal.of {
                        command.length = *value;
                    } else {
                        command.rate = Some(*value);
                    }
                }
                SignalOf::Anchor(i, axis) | SignalOf::AnchorVelocity(i, axis) => {
                    inputs.anchors.resize(cables, None);
                    let AnchorAtEnd { place_w, velocity_w, .. } = inputs.anchors[i].get_or_insert(home);
                    if let SignalOf::Anchor(..) = signal.of {
                        place_w[axis] = *value;
                    } else if let Some(velocity_w) = velocity_w {
                        velocity_w[axis] = *value;
                    }
                }
                SignalOf::Force(axis) => wrench.force_w[axis] = *value,
                SignalOf::Moment(axis) => wrench.moment_w[axis] = *value,
                SignalOf::Wind(axis) => (wind_w[axis], has_wind) = (*value, true),
                _ => {}
            }
        }
        // An anchor that has not moved needs no course.
        for (i, anchor) in inputs.anchors.iter_mut().enumerate() {
            let rests = |of: &mut AnchorAtEnd| {
                let home_w = robot.cables[i].anchor.point_w;
                of.place_w == home_w && of.velocity_w == Some(Vec3::zeros()) && simulation.has_not_moved(i)
            };
            anchor.take_if(rests);
        }
        inputs.wrench = Some(wrench);
        inputs.wind_w = has_wind.then_some(wind_w);
        inputs
    }

    /// Values of the outputs, in their order.
    pub fn values(&self, now: &RobotSample) -> Vec<f64> {
        let quaternion = now.pose.rot_wp.quaternion();
        let value = |signal: &StepSignal| match signal.of {
            SignalOf::Position(axis) => now.pose.position_w[axis],
            SignalOf::Quaternion(0) => quaternion.w,
            SignalOf::Quaternion(k) => quaternion.imag()[k - 1],
            SignalOf::Velocity(k) => now.velocity_w[k],
            SignalOf::Acceleration(k) => now.acceleration_w[k],
            SignalOf::TensionPlatform(i) => now.cables[i].tension_platform,
            SignalOf::TensionAnchor(i) => now.cables[i].tension_anchor,
            SignalOf::LengthNow(i) => now.cables[i].length.value,
            SignalOf::LengthRateNow(i) => now.cables[i].length.rate,
            SignalOf::EnergyDefect => now.energy.defect(),
            _ => signal.start,
        };
        self.outputs.iter().map(value).collect()
    }
}

fn signal(name: String, unit: &'static str, of: SignalOf) -> StepSignal {
    let follows_at_once = matches!(
        of,
        SignalOf::Acceleration(_) | SignalOf::TensionPlatform(_) | SignalOf::TensionAnchor(_) | SignalOf::EnergyDefect
    );
    StepSignal { name, unit, start: 0.0, follows_at_once, of }
}

fn inputs(robot: &Robot, simulation: &SteppedSimulation) -> Vec<StepSignal> {
    let mut inputs = Vec::new();
    for (i, cable) in robot.cables.iter().enumerate().filter(|(i, _)| !simulation.holds_tension(*i)) {
        let name = &cable.name;
        inputs.push(signal(format!("length_{name}_m"), "m", SignalOf::Length(i)));
        inputs.push(signal(format!("length_rate_{name}_m_s"), "m/s", SignalOf::LengthRate(i)));
    }
    for (i, cable) in robot.cables.iter().enumerate().filter(|(_, cable)| cable.anchor.support.is_none()) {
        let name = &cable.name;
        for (axis, letter) in AXES.iter().enumerate() {
            inputs.push(signal(format!("anchor_{name}_{letter}_m"), "m", SignalOf::Anchor(i, axis)));
        }
        for (axis, letter) in AXES.iter().enumerate() {
            let name = format!("anchor_velocity_{name}_{letter}_m_s");
            inputs.push(signal(name, "m/s", SignalOf::AnchorVelocity(i, axis)));
        }
    }
    for (axis, letter) in AXES.iter().enumerate() {
        inputs.push(signal(format!("force_{letter}_n"), "N", SignalOf::Force(axis)));
    }
    if robot.platform.motion.can_turn() {
        for (axis, letter) in AXES.iter().enumerate() {
            inputs.push(signal(format!("moment_{letter}_n_m"), "N.m", SignalOf::Moment(axis)));
        }
    }
    if robot.wind.air_density > 0.0 {
        for (axis, letter) in AXES.iter().enumerate() {
            inputs.push(signal(format!("wind_{letter}_m_s"), "m/s", SignalOf::Wind(axis)));
        }
    }
    inputs
}

fn outputs(robot: &Robot) -> Vec<StepSignal> {
    let axes = || AXES.iter().enumerate();
    let mut outputs: Vec<StepSignal> =
        axes().map(|(k, axis)| signal(format!("{axis}_m"), "m", SignalOf::Position(k))).collect();
    let parts = ["w", "x", "y", "z"].iter().enumerate();
    outputs.extend(parts.map(|(k, part)| signal(format!("quaternion_{part}"), "1", SignalOf::Quaternion(k))));
    for (what, of) in [
        ("velocity", SignalOf::Velocity as fn(usize) -> SignalOf),
        ("acceleration", SignalOf::Acceleration as fn(usize) -> SignalOf),
    ] {
        let (ending, unit, turning) = if what == "velocity" { ("s", "m/s", "rad/s") } else { ("s2", "m/s2", "rad/s2") };
        outputs.extend(axes().map(|(k, axis)| signal(format!("{what}_{axis}_m_{ending}"), unit, of(k))));
        let angular =
            |(k, axis): (usize, &&str)| signal(format!("angular_{what}_{axis}_rad_{ending}"), turning, of(3 + k));
        outputs.extend(axes().map(angular));
    }
    for (i, cable) in robot.cables.iter().enumerate() {
        let name = &cable.name;
        outputs.push(signal(format!("tension_platform_{name}_n"), "N", SignalOf::TensionPlatform(i)));
        outputs.push(signal(format!("tension_anchor_{name}_n"), "N", SignalOf::TensionAnchor(i)));
        outputs.push(signal(format!("unstrained_length_{name}_m"), "m", SignalOf::LengthNow(i)));
        outputs.push(signal(format!("unstrained_length_rate_{name}_m_s"), "m/s", SignalOf::LengthRateNow(i)));
    }
    outputs.push(signal("energy_defect_j".to_owned(), "J", SignalOf::EnergyDefect));
    outputs
}

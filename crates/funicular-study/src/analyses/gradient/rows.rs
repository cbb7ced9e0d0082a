//! Results with their derivatives, one row each.

use super::{GradientResult, RefusedResult};
use crate::request::{self, GradientRequest};
use anyhow::{Result, bail};
use funicular::dynamics::Dynamics;
use funicular::gradient::{GradientError, Gradients, VibrationGradients};
use funicular::math::Vec3;
use funicular::modes::{self, Mode};
use funicular::response::Quantity;
use funicular::robot::{Robot, RobotChange};
use funicular::statics::CableState;

/// Rows of the table under construction.
pub(super) struct GradientRows<'a> {
    pub(super) changes: &'a [RobotChange],
    pub(super) results: Vec<GradientResult>,
    pub(super) refused: Vec<RefusedResult>,
}

impl GradientRows<'_> {
    /// Adds the results of the equilibrium that a request names.
    pub(super) fn statics(&mut self, robot: &Robot, gradients: &Gradients, groups: &[&str]) {
        let equilibrium = gradients.equilibrium();
        if groups.contains(&"pose") {
            self.pose(gradients);
        }
        if groups.contains(&"lengths") {
            let lengths: Vec<f64> = equilibrium.cables.iter().map(|cable| cable.unstrained_length).collect();
            self.of_cables(robot, ["length of cable", ""], "m", &lengths, &gradients.lengths());
        }
        if groups.contains(&"tensions") {
            self.tensions(robot, gradients);
        }
        if groups.contains(&"stiffness-min") {
            let value = equilibrium.stability.min_stiffness().unwrap_or_default();
            self.push("minimum stiffness".to_owned(), "N/m", value, gradients.min_stiffness());
        }
    }

    /// Adds the natural frequencies and damping ratios below a limit [Hz] that a request names.
    pub(super) fn modes(
        &mut self,
        dynamics: &Dynamics,
        vibration: &VibrationGradients,
        groups: &[&str],
        below_hz: f64,
    ) {
        let found = modes::below(dynamics, below_hz);
        if groups.contains(&"frequencies") {
            self.frequencies(&found.modes, vibration);
        }
        if groups.contains(&"damping") {
            let damped = modes::damped::damped_modes(dynamics, &found);
            for (k, mode) in damped.modes.iter().enumerate() {
                let gradient = vibration.damped(mode);
                let name = format!("damping ratio {}", k + 1);
                self.push(name, "1", mode.damping_ratio(), gradient.map(|gradient| gradient.damping_ratio));
            }
        }
    }

    fn push(&mut self, name: String, unit: &str, value: f64, gradient: Result<RobotChange, GradientError>) {
        match gradient {
            Ok(gradient) => self.add(name, unit, value, None, &gradient),
            Err(error) => self.refused.push(RefusedResult { name, reason: error.to_string() }),
        }
    }

    fn add(&mut self, name: String, unit: &str, value: f64, block_entry: Option<[usize; 2]>, gradient: &RobotChange) {
        // `+ 0.0` makes a negative zero positive.
        let derivatives = self.changes.iter().map(|change| gradient.dot(change) + 0.0).collect();
        self.results.push(GradientResult { name, unit: unit.to_owned(), value, block_entry, derivatives });
    }

    fn pose(&mut self, gradients: &Gradients) {
        const NAMES: [(&str, &str); 6] = [
            ("x", "m"),
            ("y", "m"),
            ("z", "m"),
            ("rotation about x", "rad"),
            ("rotation about y", "rad"),
            ("rotation about z", "rad"),
        ];
        let position: [f64; 3] = gradients.equilibrium().pose.position_w.into();
        for (k, ((name, unit), gradient)) in NAMES.into_iter().zip(gradients.pose()).enumerate() {
            // A rotation is counted from the equilibrium.
            self.add(name.to_owned(), unit, position.get(k).copied().unwrap_or(0.0), None, &gradient);
        }
    }

    /// Adds one result per cable, whose name stands between the two texts.
    fn of_cables(
        &mut self,
        robot: &Robot,
        [before, after]: [&str; 2],
        unit: &str,
        values: &[f64],
        gradients: &[RobotChange],
    ) {
        for ((cable, value), gradient) in robot.cables.iter().zip(values).zip(gradients) {
            self.add(format!("{before} \"{}\"{after}", cable.name), unit, *value, None, gradient);
        }
    }

    fn tensions(&mut self, robot: &Robot, gradients: &Gradients) {
        let cables = &gradients.equilibrium().cables;
        let values = |of: fn(&CableState) -> f64| cables.iter().map(of).collect::<Vec<f64>>();
        let (platform, anchor) = (values(|cable| cable.tension_platform), values(|cable| cable.tension_anchor));
        let name = |place| ["tension of cable", place];
        self.of_cables(robot, name(" at the platform"), "N", &platform, &gradients.tensions_platform());
        self.of_cables(robot, name(" at the anchor"), "N", &anchor, &gradients.tensions_anchor());
        if cables.iter().any(|cable| cable.drive.is_some()) {
            let drum = values(CableState::tension_drum);
            self.of_cables(robot, name(" at the drum"), "N", &drum, &gradients.tensions_drum());
        }
    }

    fn frequencies(&mut self, modes: &[Mode], vibration: &VibrationGradients) {
        let mut first = 0;
        while first < modes.len() {
            let count = modes[first].multiplicity.clamp(1, modes.len() - first);
            let shared: Vec<&Mode> = modes[first..first + count].iter().collect();
            if let [mode] = shared[..] {
                self.push(format!("frequency {}", first + 1), "Hz", mode.frequency_hz, vibration.frequency(mode));
            } else {
                self.shared_frequency(first, &shared, vibration);
            }
            first += count;
        }
    }

    /// Adds the upper half of the block of derivatives of modes that share a frequency; `first` is the index of the
    /// first one in the list.
    fn shared_frequency(&mut self, first: usize, shared: &[&Mode], vibration: &VibrationGradients) {
        let (from, to) = (first + 1, first + shared.len());
        for (i, row) in vibration.block(shared).iter().enumerate() {
            for (j, gradient) in row.iter().enumerate().skip(i) {
                let entry = [from + i, from + j];
                let name = format!("frequencies {from} to {to}, entry {}, {}", entry[0], entry[1]);
                self.add(name, "Hz", shared[0].frequency_hz, Some(entry), gradient);
            }
        }
    }

    /// Adds real and imaginary part of the response at the frequency of a request.
    pub(super) fn response(
        &mut self,
        robot: &Robot,
        vibration: &VibrationGradients,
        request: &GradientRequest,
    ) -> Result<()> {
        let (Some(input), Some(output), Some(at_hz)) = (&request.input, &request.output, request.at_hz) else {
            bail!("a response needs ⟪input⟫, ⟪output⟫ and ⟪at_hz⟫");
        };
        let (input, output) = (request::input(input)?, request::output(output)?);
        request.points.check()?;
        let [at_input, at_output] =
            [request.points.input_point_m, request.points.output_point_m].map(|point| point.map(Vec3::from));
        let (from, to) = (input.signal(robot, at_input)?, output.signal(robot, at_output)?);
        let quantity: Quantity = output.quantity;
        let rows = vibration.responses(&[from], &[(to, quantity)], &[at_hz], self.changes)?;
        let Some(found) = rows.first().and_then(|row| row.first()) else { bail!("the response has no value") };

        let unit = crate::signals::response_unit(&input, &output);
        for (part, value, derivatives) in [
            ("real part", found.value.re, found.along.iter().map(|z| z.re + 0.0).collect()),
            ("imaginary part", found.value.im, found.along.iter().map(|z| z.im + 0.0).collect()),
        ] {
            let name = format!("response at {at_hz} Hz, {part}");
            self.results.push(GradientResult { name, unit: unit.clone(), value, block_entry: None, derivatives });
        }
        Ok(())
    }
}

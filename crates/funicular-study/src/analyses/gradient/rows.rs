//! Results with their derivatives, one row each.

use super::{GradientResult, RefusedResult};
use crate::measure::{MEASURES, Measure, MeasureGroup, ResponsePart, TensionPlace};
use crate::request::{self, GradientRequest};
use anyhow::{Result, bail};
use funicular::dynamics::Dynamics;
use funicular::gradient::{GradientError, Gradients, VibrationGradients};
use funicular::math::Vec3;
use funicular::modes::{self, Mode};
use funicular::response::Quantity;
use funicular::robot::{Robot, RobotChange};

/// Rows of the table under construction.
pub(super) struct GradientRows<'a> {
    pub(super) robot: &'a Robot,
    pub(super) changes: &'a [RobotChange],
    pub(super) results: Vec<GradientResult>,
    pub(super) refused: Vec<RefusedResult>,
}

impl GradientRows<'_> {
    /// Adds the results of the equilibrium that a request names.
    pub(super) fn statics(&mut self, robot: &Robot, gradients: &Gradients, groups: &[&MeasureGroup]) {
        let rest = gradients.equilibrium();
        let has_drums = rest.cables.iter().any(|cable| cable.drive.is_some());
        let places = [TensionPlace::Platform, TensionPlace::Anchor, TensionPlace::Drum];
        let places = if has_drums { &places[..] } else { &places[..2] };
        let requested = MEASURES.iter().filter(|group| groups.contains(group));
        let measures: Vec<Measure> =
            requested.flat_map(|group| group.of_statics(robot, &[0, 1, 2, 3, 4, 5], places)).collect();

        let found = Measure::static_gradients(&measures, gradients);
        for (measure, gradient) in measures.into_iter().zip(found) {
            let Some(gradient) = gradient else { continue };
            let value = measure.static_value(robot, rest, &rest.pose).unwrap_or_default();
            self.push(measure, value, gradient);
        }
    }

    /// Adds the natural frequencies and damping ratios below a limit [Hz] that a request names; returns the number of
    /// modes there.
    pub(super) fn modes(
        &mut self,
        dynamics: &Dynamics,
        vibration: &VibrationGradients,
        groups: &[&MeasureGroup],
        below_hz: f64,
    ) -> usize {
        let found = modes::below(dynamics, below_hz);
        if groups.contains(&&MeasureGroup::Frequencies) {
            self.frequencies(&found.modes, vibration);
        }
        if groups.contains(&&MeasureGroup::Damping) {
            let damped = modes::damped::damped_modes(dynamics, &found);
            for (k, mode) in damped.modes.iter().enumerate() {
                let gradient = vibration.damped(mode).map(|gradient| gradient.damping_ratio);
                self.push(Measure::Damping(k), mode.damping_ratio(), gradient);
            }
        }
        found.modes.len()
    }

    fn push(&mut self, measure: Measure, value: f64, gradient: Result<RobotChange, GradientError>) {
        match gradient {
            Ok(gradient) => {
                // `+ 0.0` makes a negative zero positive.
                let derivatives = self.changes.iter().map(|change| gradient.dot(change) + 0.0).collect();
                self.add(measure, measure.unit().to_owned(), value, derivatives);
            }
            Err(error) => {
                let (name, measure) = (measure.name(self.robot), measure.identity(self.robot));
                self.refused.push(RefusedResult { name, measure, reason: error.to_string() });
            }
        }
    }

    fn add(&mut self, measure: Measure, unit: String, value: f64, derivatives: Vec<f64>) {
        let block_entry = match measure {
            Measure::SharedFrequency { entry: [i, j], .. } => Some([i + 1, j + 1]),
            _ => None,
        };
        let (name, measure) = (measure.name(self.robot), measure.identity(self.robot));
        self.results.push(GradientResult { name, measure, unit, value, block_entry, derivatives });
    }

    fn frequencies(&mut self, modes: &[Mode], vibration: &VibrationGradients) {
        let mut first = 0;
        while first < modes.len() {
            let count = modes[first].multiplicity.clamp(1, modes.len() - first);
            let shared: Vec<&Mode> = modes[first..first + count].iter().collect();
            if let [mode] = shared[..] {
                self.push(Measure::Frequency(first), mode.frequency_hz, vibration.frequency(mode));
            } else {
                self.shared_frequency(first, &shared, vibration);
            }
            first += count;
        }
    }

    /// Adds the upper half of the block of derivatives of modes that share a frequency; `first` is the index of the
    /// first one in the list.
    fn shared_frequency(&mut self, first: usize, shared: &[&Mode], vibration: &VibrationGradients) {
        let last = first + shared.len() - 1;
        for (i, row) in vibration.block(shared).into_iter().enumerate() {
            for (j, gradient) in row.into_iter().enumerate().skip(i) {
                let measure = Measure::SharedFrequency { first, last, entry: [first + i, first + j] };
                self.push(measure, shared[0].frequency_hz, Ok(gradient));
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
            (ResponsePart::Real, found.value.re, found.along.iter().map(|z| z.re + 0.0).collect()),
            (ResponsePart::Imaginary, found.value.im, found.along.iter().map(|z| z.im + 0.0).collect()),
        ] {
            self.add(Measure::Response(at_hz, part), unit.clone(), value, derivatives);
        }
        Ok(())
    }
}

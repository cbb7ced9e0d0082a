//! Inputs and outputs of a reduced model on the linearised robot.

use super::ReductionError;
use super::matrices::CoordinateLayout;
use crate::cable::catenary_dynamic::{EndSignal, InPowersOfS};
use crate::dynamics::Dynamics;
use crate::math::{Complex, DMat, Vec3, Vec6};
use crate::response::{self, Port, Quantity, ResponseError, Signal};
use crate::robot::Robot;
use crate::statics::Equilibrium;
use std::array::from_fn;

/// Ports of the inputs and outputs on the linearised robot.
pub(super) struct Channels {
    pub(super) inputs: Vec<Port>,
    pub(super) outputs: Vec<Port>,
}

impl Channels {
    pub(super) fn new(
        robot: &Robot,
        equilibrium: &Equilibrium,
        dynamics: &Dynamics,
        inputs: &[Signal],
        outputs: &[(Signal, Quantity)],
        loaded: bool,
    ) -> Result<Self, ReductionError> {
        let signals: Vec<Signal> = inputs.iter().copied().chain(outputs.iter().map(|(signal, _)| *signal)).collect();
        let mut inputs_first = Port::all(robot, equilibrium, dynamics, &signals, loaded)?;
        let outputs = inputs_first.split_off(inputs.len());
        Ok(Self { inputs: inputs_first, outputs })
    }

    /// Displacement of every output per force at every input, at all frequencies.
    pub(super) fn responses(
        &self,
        dynamics: &Dynamics,
        frequencies_hz: &[f64],
    ) -> Result<Vec<Vec<Complex>>, ResponseError> {
        let outputs: Vec<_> = self.outputs.iter().map(|port| (port.clone(), Quantity::Displacement)).collect();
        response::matrix(dynamics, frequencies_hz, &self.inputs, &outputs)
    }

    /// Row of a port over the coordinates, in powers of s.
    fn row(port: &Port, dynamics: &Dynamics, layout: &CoordinateLayout) -> InPowersOfS<Vec<f64>> {
        let zeros = || vec![0.0; layout.coordinates.len()];
        let mut row = [zeros(), zeros(), zeros()];
        let coordinates = |vector: &Vec6| dynamics.coordinates().motion().reduced(vector);

        match port {
            Port::Platform(vector) => {
                row[0][..layout.dof].copy_from_slice(&coordinates(vector).as_slice()[..layout.dof]);
            }
            Port::Drive { term, signal, .. } => {
                let Some(powers) = dynamics.drive_signal_row(*term, *signal) else {
                    unreachable!("a port has a signal of its drive")
                };
                for (row, of_cable) in row.iter_mut().zip(&powers) {
                    layout.add_row(of_cable, *term, 1.0, row);
                }
            }
            Port::Frame(frame) => {
                row[0][..layout.dof].copy_from_slice(&coordinates(frame.constant()).as_slice()[..layout.dof]);
                if let Some(supports) = dynamics.supports() {
                    let (constant, feet) = frame.on_feet();
                    row[0][layout.first_support..].copy_from_slice(constant);
                    row[2][layout.first_support..].copy_from_slice(&supports.inertia_of_feet(feet));
                }

                for (term, motion) in frame.carriers() {
                    let Some(powers) = dynamics.carrier_row(term, motion) else {
                        unreachable!("other models were refused")
                    };
                    for (row, of_cable) in row.iter_mut().zip(&powers) {
                        layout.add_row(of_cable, term, 1.0, row);
                    }
                }
            }
            Port::Cable { stations, station, direction_w } => {
                let (platform, term, amplitudes) = stations.row(dynamics, *station, direction_w);
                row[0][..layout.dof].copy_from_slice(&coordinates(&platform).as_slice()[..layout.dof]);
                if let Some(term) = term {
                    let from = layout.first_of_term[term];
                    row[0][from..from + amplitudes.len()].copy_from_slice(&amplitudes);
                }

                let axes = [Vec3::x(), Vec3::y(), Vec3::z()];
                let by_far_end = axes.map(|axis| stations.still_by_far_end(*station, direction_w, &axis));
                let on_supports = dynamics.station_row_on_supports(stations.cable, by_far_end, &amplitudes);
                row[0][layout.first_support..].copy_from_slice(&on_supports);
            }
        }

        row
    }

    /// Matrices of ports by powers of s, one row per port.
    pub(super) fn rows(ports: &[Port], dynamics: &Dynamics, layout: &CoordinateLayout) -> InPowersOfS<DMat> {
        let rows: Vec<_> = ports.iter().map(|port| Self::row(port, dynamics, layout)).collect();
        from_fn(|power| DMat::from_fn(ports.len(), layout.coordinates.len(), |i, j| rows[i][power][j]))
    }

    /// Signals at the far ends of cables: index of the cable, and signal.
    pub(super) fn at_far_ends(&self, dynamics: &Dynamics) -> Vec<(usize, EndSignal)> {
        let of_port = |port: &Port| match port {
            Port::Drive { term, signal, .. } => vec![(*term, EndSignal::Drive(*signal))],
            Port::Frame(frame) => frame.carriers().map(|(term, motion)| (term, EndSignal::Carrier(*motion))).collect(),
            Port::Platform(_) | Port::Cable { .. } => Vec::new(),
        };
        let all = self.inputs.iter().chain(&self.outputs).flat_map(of_port);
        all.map(|(term, signal)| (dynamics.terms()[term].cable(), signal)).collect()
    }

    /// Outputs per inputs with all coordinates at rest, in powers of s, outputs×inputs. Input and output of the drive
    /// of one cable have such a part, and so has an output on a cable whose far end the input moves.
    pub(super) fn direct(&self, dynamics: &Dynamics) -> InPowersOfS<DMat> {
        let entry = |output: &Port, input: &Port| match (input, output) {
            (Port::Drive { term, signal: input, .. }, Port::Drive { term: of_output, signal: output, .. })
                if term == of_output =>
            {
                dynamics.direct_drive_signal(*term, *input, *output).unwrap_or_default()
            }
            (Port::Frame(frame), Port::Drive { term, signal, .. }) => {
                let moved = frame.carriers().find(|(of, _)| of == term);
                moved.and_then(|(_, motion)| dynamics.direct_by_carrier(*term, motion, *signal)).unwrap_or_default()
            }
            (Port::Drive { term, signal, .. }, Port::Cable { stations, station, direction_w })
            | (Port::Cable { stations, station, direction_w }, Port::Drive { term, signal, .. })
                if dynamics.terms()[*term].cable() == stations.cable =>
            {
                [stations.still_by_ends(*station, direction_w, dynamics.ends_of_signal(*term, *signal)), 0.0, 0.0]
            }
            (Port::Frame(frame), Port::Cable { stations, station, direction_w }) => {
                [frame.still_of_station(stations, *station, direction_w), 0.0, 0.0]
            }
            _ => [0.0; 3],
        };

        let size = (self.outputs.len(), self.inputs.len());
        from_fn(|power| DMat::from_fn(size.0, size.1, |o, i| entry(&self.outputs[o], &self.inputs[i])[power]))
    }
}

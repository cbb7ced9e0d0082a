//! Places and directions of forces and measured motions, as data ([`Signal`]) and on a linearised robot ([`Port`]).

use super::frame_motion::{FrameInput, FrameMotion};
use crate::cable::catenary_dynamic::DriveSignal;
use crate::cable_motion::{CableMotionError, CableStations};
use crate::dynamics::Dynamics;
use crate::math::{CDMat, CVec6, Complex, Vec3, Vec6};
use crate::modes::Mode;
use crate::robot::{Pose, Robot};
use crate::statics::Equilibrium;
use std::sync::Arc;

/// Place and direction in which a force acts or a motion is measured.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Signal {
    /// A force on, or a translation of, a platform point along a direction in world axes (normalised on use).
    Along {
        /// Direction, world axes.
        direction_w: Vec3,
        /// Point, platform frame [m].
        point_p: Vec3,
    },
    /// A moment on, or a rotation of, the platform about a direction in world axes (normalised on use).
    About {
        /// Axis, world axes.
        axis_w: Vec3,
    },
    /// A force on, or a translation of, a point of a cable along a direction in world axes (normalised on use).
    OnCable {
        /// Index of the cable, in the order of the file.
        cable: usize,
        /// Fraction of the unstrained length from the platform, 0 to 1.
        fraction: f64,
        /// Direction, world axes.
        direction_w: Vec3,
    },
    /// A quantity of the drive of a cable.
    Drive {
        /// Index of the cable, in the order of the file.
        cable: usize,
        /// Quantity.
        signal: DriveSignal,
    },
    /// A given motion of the frame; an input.
    Frame(FrameInput),
}

impl Signal {
    /// Vector u (6 components) of a signal on the platform at a pose: a force f there is the wrench `u f` about the
    /// platform origin, and the motion there is `uᵀ x`. `None` for a signal on a cable, whose vector depends on
    /// frequency.
    pub fn platform_vector(&self, pose: &Pose) -> Option<Vec6> {
        match self {
            Self::Along { direction_w, point_p } => Some(along(direction_w, point_p, pose)),
            Self::About { axis_w } => Some(about(axis_w)),
            Self::OnCable { .. } | Self::Drive { .. } | Self::Frame(_) => None,
        }
    }
}

/// Vector u (6 components) of a platform point along a direction at a pose, for [`Signal::Along`]: a force f there is
/// the wrench `u f` about the platform origin, and the motion there is `uᵀ x`.
pub fn along(direction_w: &Vec3, point_p: &Vec3, pose: &Pose) -> Vec6 {
    let u = direction_w.normalize();
    let moment = (pose.rot_wp * point_p).cross(&u);
    Vec6::new(u.x, u.y, u.z, moment.x, moment.y, moment.z)
}

/// Vector u (6 components) of a moment on, or a rotation of, the platform about an axis in world axes; see [`along`].
pub fn about(axis_w: &Vec3) -> Vec6 {
    let u = axis_w.normalize();
    Vec6::new(0.0, 0.0, 0.0, u.x, u.y, u.z)
}

/// Signal on a robot linearised about an equilibrium.
#[derive(Debug, Clone)]
pub enum Port {
    /// Signal on the platform, with its vector by [`along`] or [`about`].
    Platform(Vec6),
    /// Signal at a station of a cable. Ports on the same cable share its stations.
    Cable {
        /// Stations of the cable.
        stations: Arc<CableStations>,
        /// Index of the station.
        station: usize,
        /// Direction in world axes, a unit vector.
        direction_w: Vec3,
    },
    /// Quantity of the drive of a catenary-dynamic cable.
    Drive {
        /// Index of the cable among those whose stiffness depends on frequency.
        term: usize,
        /// Quantity.
        signal: DriveSignal,
        /// Attachment from the platform origin, world axes [m].
        lever_w: Vec3,
    },
    /// Given motion of the frame; an input.
    Frame(FrameMotion),
}

impl Port {
    /// Ports of signals, in the same order. All points of one cable become stations of one [`CableStations`], because a
    /// force at one of them moves the others. With `loaded`, forces may act on the stations.
    ///
    /// # Errors
    /// [`CableMotionError`]: a model without motion along the cables, or a cable that cannot be discretised.
    pub fn all(
        robot: &Robot,
        equilibrium: &Equilibrium,
        dynamics: &Dynamics,
        signals: &[Signal],
        loaded: bool,
    ) -> Result<Vec<Self>, CableMotionError> {
        // Points of each cable; cables in the order of first appearance.
        let mut points: Vec<(usize, Vec<f64>)> = Vec::new();
        for signal in signals {
            if let Signal::OnCable { cable, fraction, .. } = signal {
                match points.iter_mut().find(|(of, _)| of == cable) {
                    Some((_, fractions)) => fractions.push(*fraction),
                    None => points.push((*cable, vec![*fraction])),
                }
            }
        }
        let stations = (points.iter())
            .map(|(cable, fractions)| {
                CableStations::new(robot, equilibrium, dynamics, *cable, fractions, loaded).map(Arc::new)
            })
            .collect::<Result<Vec<_>, _>>()?;

        // The stations of a cable have the order of its signals.
        let mut next = vec![0; stations.len()];
        let port = |signal: &Signal| {
            Ok(match signal {
                Signal::Along { direction_w, point_p } => {
                    Self::Platform(along(direction_w, point_p, &equilibrium.pose))
                }
                Signal::About { axis_w } => Self::Platform(about(axis_w)),
                Signal::Drive { cable, signal } => {
                    let no_signal = || CableMotionError::NoDriveSignal {
                        cable: robot.cables[*cable].name.clone(),
                        signal: signal.name(),
                    };
                    let term = dynamics.terms().iter().position(|term| term.cable() == *cable).ok_or_else(no_signal)?;
                    let port = Self::Drive { term, signal: *signal, lever_w: equilibrium.cables[*cable].lever_w };
                    // Every frequency has the same signals.
                    port.drive_vector(dynamics, 1.0).ok_or_else(no_signal)?;
                    port
                }
                Signal::Frame(input) => Self::Frame(FrameMotion::new(robot, equilibrium, dynamics, input)?),
                Signal::OnCable { cable, direction_w, .. } => {
                    let at = points.iter().position(|(of, _)| of == cable).expect("every cable has stations");
                    let station = next[at];
                    next[at] += 1;
                    Self::Cable { stations: Arc::clone(&stations[at]), station, direction_w: direction_w.normalize() }
                }
            })
        };
        signals.iter().map(port).collect()
    }

    /// Position at equilibrium of a port on a cable [m, world axes]; `None` for a port on the platform.
    pub fn cable_point_w(&self) -> Option<Vec3> {
        match self {
            Self::Platform(_) | Self::Drive { .. } | Self::Frame(_) => None,
            Self::Cable { stations, station, .. } => Some(stations.points_w[*station]),
        }
    }

    /// Motion of the port in a mode, in the scale of `Mode::shape` [m]. By reciprocity it is also the modal force per
    /// unit force at the port. The residue of a mode is the product of the motions of two ports over the modal mass.
    /// `None` for a drive's signal and for a motion of the frame.
    pub fn in_mode(&self, dynamics: &Dynamics, mode: &Mode) -> Option<f64> {
        Some(match self {
            Self::Platform(vector) => vector.dot(&Vec6::from(mode.shape)),
            Self::Drive { .. } | Self::Frame(_) => return None,
            Self::Cable { stations, station, direction_w } => {
                let [e, n, b] = stations.in_mode(dynamics, mode)[*station];
                (stations.axes.e * e + stations.axes.n * n + stations.axes.b * b).dot(direction_w)
            }
        })
    }

    /// Vector of a drive's signal about the platform origin at ω [rad/s]; `None` if the cable has no such signal.
    fn drive_vector(&self, dynamics: &Dynamics, omega: f64) -> Option<CVec6> {
        let Self::Drive { term, signal, lever_w } = self else { return None };
        let form = dynamics.terms()[*term].form().by_poles()?;
        let local = form.signal_vector(*signal, omega.into())?;
        let axes = [form.axes.e, form.axes.n, form.axes.b];
        let mut vector = CVec6::zeros();
        for (axis, entry) in axes.iter().zip(local) {
            let moment = lever_w.cross(axis);
            for k in 0..3 {
                vector[k] += entry * axis[k];
                vector[3 + k] += entry * moment[k];
            }
        }
        Some(vector)
    }

    /// Forces on the displacements of the supports per unit of an input at ω [rad/s], the platform and all supports
    /// held; by reciprocity the output per displacement. `None` on a rigid frame.
    pub(super) fn on_supports(&self, dynamics: &Dynamics, omega: f64) -> Option<Vec<Complex>> {
        let supports = dynamics.supports()?;
        let mut forces = vec![Complex::new(0.0, 0.0); supports.count()];

        match self {
            Self::Platform(_) => {}
            Self::Frame(motion) => return Some(motion.on_supports(dynamics, supports, omega)),
            Self::Drive { term, signal, .. } => {
                let (Some(form), Some((first, motions))) =
                    (dynamics.terms()[*term].form().by_poles(), supports.carrier_motions(*term))
                else {
                    return Some(forces);
                };
                for (force, motion) in forces[first..].iter_mut().zip(&motions) {
                    *force = form.signal_by_carrier(motion, *signal, omega.into()).unwrap_or_default();
                }
            }
            Self::Cable { stations, station, direction_w } => {
                let Some(first) = supports.of_cable(stations.cable) else { return Some(forces) };
                let term = dynamics.terms().iter().position(|term| term.cable() == stations.cable);
                let motions = term.and_then(|term| supports.carrier_motions(term)).map(|(_, motions)| motions);
                for (k, force) in forces[first..first + 3].iter_mut().enumerate() {
                    let mut moved_w = Vec3::zeros();
                    moved_w[k] = 1.0;
                    let motion = motions.as_ref().map(|motions| &motions[k]);
                    *force = stations.by_far_end(dynamics, (*station, direction_w), &moved_w, motion, omega);
                }
            }
        }

        Some(forces)
    }

    /// Vector of the port about the platform origin at ω [rad/s], and its forces on the supports; the supports are free
    /// in the vector. `by_platform` are their displacements there, less their sign, per scaled motion of the platform:
    /// see [`Dynamics::support_response`]; `None` on a rigid frame.
    pub(crate) fn free_vector(
        &self,
        dynamics: &Dynamics,
        by_platform: Option<&CDMat>,
        omega: f64,
    ) -> (CVec6, Vec<Complex>) {
        let mut vector = self.vector(dynamics, omega);
        let Some(on_supports) = self.on_supports(dynamics, omega) else { return (vector, Vec::new()) };
        let Some(by_platform) = by_platform else { return (vector, on_supports) };
        let mut scaled = CVec6::zeros();
        for (row, force) in by_platform.row_iter().zip(&on_supports) {
            row.iter().zip(scaled.iter_mut()).for_each(|(entry, sum)| *sum += entry * force);
        }
        vector -= dynamics.unscaled_vector(&scaled);
        (vector, on_supports)
    }

    /// Vector of the port about the platform origin at ω [rad/s].
    pub(crate) fn vector(&self, dynamics: &Dynamics, omega: f64) -> CVec6 {
        match self {
            Self::Platform(vector) => vector.map(Complex::from),
            Self::Drive { .. } => self.drive_vector(dynamics, omega).unwrap_or_else(CVec6::zeros),
            Self::Frame(motion) => motion.vector(dynamics, omega),
            Self::Cable { stations, station, direction_w } => {
                stations.transmission(dynamics, *station, direction_w, omega)
            }
        }
    }
}

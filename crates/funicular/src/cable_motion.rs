//! Motion of the points along the cables, in a natural mode and in a response to a force.
//!
//! If the platform end of a cable moves by u, the points along the cable move by `Ψ(s) u + Σ φ_k(s) q_k`: the slow
//! shape and the clamped modes, whose amplitudes q_k follow from u and the frequency (docs/theory.md, section 11).

mod weighted;

pub use weighted::WeightedMotions;

use crate::cable::catenary_dynamic::{
    CarrierMotion, CatenaryDynamic, CatenaryDynamicError, DriveSignal, InternalMotion, Stations,
};
use crate::cable::{CableModel, LocalAxes};
use crate::dynamics::Dynamics;
use crate::math::{CVec6, Complex, Vec3, Vec6};
use crate::modes::Mode;
use crate::robot::Robot;
use crate::statics::Equilibrium;
use thiserror::Error;

/// Reason why the motion along a cable is not known.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum CableMotionError {
    /// The model describes the cable's end only.
    #[error("the {0} model describes the end of a cable only: the motion along it needs the model `catenary-dynamic`")]
    Model(CableModel),
    /// The cable has no such signal of its drive.
    #[error(
        "cable \"{cable}\" has no signal `{signal}`: `length` needs a motor that holds its angle or a position \
         control, `drum` a drum and `motor` a motor that can move, all a cable with mass and the model \
         `catenary-dynamic`, or `shallow-dynamic` with a winch"
    )]
    NoDriveSignal {
        /// Name of the cable.
        cable: String,
        /// Name of the signal.
        signal: &'static str,
    },
    /// The force of the cable on the platform by a motion of its anchor is not known.
    #[error("cable \"{cable}\" has no stiffness that a motion of its anchor could act on")]
    NoFrameMotion {
        /// Name of the cable.
        cable: String,
    },
    /// The cable has no catenary-dynamic stiffness.
    #[error("cable \"{cable}\": {reason}")]
    CatenaryDynamic {
        /// Name of the cable.
        cable: String,
        /// Reason.
        reason: CatenaryDynamicError,
    },
}

/// Stations along one cable, with the data for their motion.
#[derive(Debug, Clone)]
pub struct CableStations {
    /// Index of the cable, in the order of the file.
    pub cable: usize,
    /// Unstrained arc length of each station from the platform [m].
    pub arc_lengths: Vec<f64>,
    /// Positions of the stations at equilibrium, world axes [m].
    pub points_w: Vec<Vec3>,
    /// Axes of the displacements: for a hanging cable e horizontal towards the anchor, n up, b out of plane.
    pub axes: LocalAxes,
    lever_w: Vec3,
    model: StationModel,
}

/// Model of the motion of stations.
#[derive(Debug, Clone)]
enum StationModel {
    /// A massless cable moves as a straight line: per station the fraction of the platform end's motion.
    Straight(Vec<f64>),
    /// A cable that vibrates about its catenary.
    CatenaryDynamic {
        cable: Box<CatenaryDynamic>,
        stations: Stations,
        /// Index of the cable among those whose stiffness depends on frequency.
        term: usize,
    },
}

impl CableStations {
    /// Stations on cable `i` of a robot linearised about an equilibrium, at fractions of the unstrained length from the
    /// platform (0 to 1). With `loaded`, forces may act on the stations.
    ///
    /// # Errors
    /// [`CableMotionError`]: the shallow-dynamic model has no motion along the cable.
    pub fn new(
        robot: &Robot,
        equilibrium: &Equilibrium,
        dynamics: &Dynamics,
        i: usize,
        fractions: &[f64],
        loaded: bool,
    ) -> Result<Self, CableMotionError> {
        let state = &equilibrium.cables[i];
        let arc_lengths: Vec<f64> = fractions.iter().map(|fraction| fraction * state.free_length()).collect();
        let term = dynamics.terms().iter().position(|term| term.cable() == i && !dynamics.is_at_rest(i));
        let chord_w = state.chord_w();

        // Shallow spans with a drive have poles and residues, too, but no shape of the catenary.
        let cable_model = dynamics.linearisation.cable_model;
        if term.is_some() && cable_model.is_shallow() {
            return Err(CableMotionError::Model(cable_model));
        }

        let end = term.and_then(|term| Some((term, dynamics.terms()[term].form().by_poles()?)));
        let (model, axes) = if let Some((term, end)) = end {
            let hanging = state.hanging.as_ref().expect("a catenary-dynamic cable hangs");
            let (m, limit) = (end.mass_per_length, end.cable.limit);
            let (mut cable, mut stations) = CatenaryDynamic::with_stations(
                &hanging.catenary,
                end.cable.end.clone(),
                m,
                limit,
                &arc_lengths,
                loaded,
                end.cable.stretch.moments,
            )
            .map_err(|reason| {
                let cable = robot.cables[i].name.clone();
                CableMotionError::CatenaryDynamic { cable, reason }
            })?;
            if !loaded {
                // Take the cable of `dynamics`, with as many clamped modes as it has kept.
                if let Some(kept) = &end.kept {
                    kept.compress(&mut stations.in_plane, &mut stations.out_of_plane, &mut stations.coupled);
                }
                cable = end.cable.clone();
            }
            (StationModel::CatenaryDynamic { cable: Box::new(cable), stations, term }, end.axes)
        } else {
            let end_fractions = fractions.iter().map(|fraction| 1.0 - fraction).collect();
            (StationModel::Straight(end_fractions), LocalAxes::of_cable(robot, i, state))
        };

        let points_w = fractions
            .iter()
            .zip(&arc_lengths)
            .map(|(fraction, s)| match &state.hanging {
                Some(hanging) => hanging.point_w(*s),
                None => state.attachment_w + chord_w * *fraction,
            })
            .collect();
        Ok(Self { cable: i, arc_lengths, points_w, axes, lever_w: state.lever_w, model })
    }

    /// Displacement (e, n, b) of each station in a mode, in the scale of `Mode::shape` [m]. If the platform is at rest,
    /// the scale is a modal mass of 1 kg. Mode and stations belong to the same `dynamics`.
    pub fn in_mode(&self, dynamics: &Dynamics, mode: &Mode) -> Vec<[f64; 3]> {
        let motion = &mode.motion;
        let motion_w = dynamics.coordinates().expand(&motion.platform);
        let largest = motion_w[motion_w.iamax()];
        let scale = if largest == 0.0 { 1.0 } else { 1.0 / largest };

        match &self.model {
            StationModel::Straight(fractions) => {
                let shape = mode.shape;
                let end_w = Vec3::new(shape[0], shape[1], shape[2])
                    + Vec3::new(shape[3], shape[4], shape[5]).cross(&self.lever_w);
                let LocalAxes { e, n, b } = self.axes;
                let anchor_w = self.support_motion_w(dynamics, &motion.supports) * scale;
                let at_w = |fraction: &f64| end_w * *fraction + anchor_w * (1.0 - fraction);
                fractions.iter().map(|fraction| [e, n, b].map(|axis| axis.dot(&at_w(fraction)))).collect()
            }
            StationModel::CatenaryDynamic { cable, stations, term } => {
                let of = &dynamics.terms()[*term];
                let mut start = of.axes().map(|axis| Complex::from(axis.dot(&motion.platform)));
                if let Some(supports) = dynamics.supports() {
                    let running = supports.sheaves().displacement(*term, &motion.supports);
                    start.iter_mut().zip(running).for_each(|(start, running)| *start += running);
                }
                let square = (mode.frequency_hz * std::f64::consts::TAU).powi(2);
                let mut motion_along = internal_motion(dynamics, cable, start, square.into());
                let carried =
                    dynamics.supports().and_then(|of| of.both_ends(*term).zip(of.ends(*term, &motion.supports)));
                if let Some((both, ends)) = carried {
                    motion_along.add_carrier(cable, both, ends.map(Complex::from), square.into());
                }
                let Some(end) = of.form().by_poles() else { unreachable!("made of this term") };

                // Clamped modes whose poles lie near the frequency have their amplitudes in the mode.
                for near in motion.near.iter().filter(|near| near.term == *term) {
                    // Loaded stations have their own discretisation, in which a clamped mode may have the other sign.
                    let [theirs, ours] =
                        [&end.cable, &**cable].map(|cable| cable.participation(near.family, near.pole));
                    let same_sign = ours.iter().zip(theirs).map(|(a, b)| a * b).sum::<f64>() > 0.0;
                    motion_along.amplitudes(near.family)[near.pole] =
                        if same_sign { near.amplitude } else { -near.amplitude }.into();
                }

                let at = |k: usize| stations.displacement(k, &motion_along).map(|u| u.re * scale);
                (0..self.arc_lengths.len()).map(at).collect()
            }
        }
    }

    /// Transmission vector v(ω): displacement of station `at` along `direction_w` (unit) per platform motion,
    /// `u = vᵀ x`, damped, at ω [rad/s]. v is a 6-vector about the platform origin. By reciprocity a force f at the
    /// station acts on the platform as the wrench `v f`.
    pub fn transmission(&self, dynamics: &Dynamics, at: usize, direction_w: &Vec3, omega: f64) -> CVec6 {
        let LocalAxes { e, n, b } = self.axes;
        let towards = self.local(direction_w);

        // Displacement along the direction per displacement of the platform end in (e, n, b).
        let row: [Complex; 3] = match &self.model {
            StationModel::Straight(fractions) => towards.map(|component| Complex::from(component * fractions[at])),
            StationModel::CatenaryDynamic { cable, stations, .. } => {
                let square = dynamics.cable_square(self.cable, omega);
                std::array::from_fn(|axis| {
                    let start = std::array::from_fn(|k| Complex::from(f64::from(u8::from(k == axis))));
                    let motion_along = internal_motion(dynamics, cable, start, square);
                    let motion_along = with_drive(dynamics, self.cable, cable, motion_along, omega);
                    let moved = stations.displacement(at, &motion_along);
                    moved.iter().zip(towards).map(|(u, component)| u * component).sum()
                })
            }
        };

        // As a wrench about the platform origin.
        let mut vector = CVec6::zeros();
        for (axis, entry) in [e, n, b].into_iter().zip(row) {
            let moment = self.lever_w.cross(&axis);
            for k in 0..3 {
                vector[k] += entry * axis[k];
                vector[3 + k] += entry * moment[k];
            }
        }
        vector
    }

    /// Displacement of station `at` along a unit vector for a displacement `far_end_w` of the far end, the platform
    /// held, at ω [rad/s], damped. `carrier` is that motion in the axes of a cable whose stiffness depends on
    /// frequency; `None` if it is at rest.
    pub(crate) fn by_far_end(
        &self,
        dynamics: &Dynamics,
        (at, direction_w): (usize, &Vec3),
        far_end_w: &Vec3,
        carrier: Option<&CarrierMotion>,
        omega: f64,
    ) -> Complex {
        match (&self.model, carrier) {
            (StationModel::Straight(_), _) => self.still_by_far_end(at, direction_w, far_end_w).into(),
            (StationModel::CatenaryDynamic { .. }, None) => 0.0.into(),
            (StationModel::CatenaryDynamic { cable, stations, term }, Some(carrier)) => {
                let Some(end) = dynamics.terms()[*term].form().by_poles() else { unreachable!("made of this term") };
                let moved = stations.displacement(at, &end.motion_by_carrier(cable, carrier, omega.into()));
                moved.iter().zip(self.local(direction_w)).map(|(u, component)| u * component).sum()
            }
        }
    }

    /// Displacement of station `at` along a unit vector per unit of a signal of the drive or tension of the cable, the
    /// platform held, at ω [rad/s], damped; by reciprocity also the output per force on the station. Zero without such
    /// a signal.
    pub(crate) fn by_signal(
        &self,
        dynamics: &Dynamics,
        (at, direction_w): (usize, &Vec3),
        signal: DriveSignal,
        omega: f64,
    ) -> Complex {
        let StationModel::CatenaryDynamic { cable, stations, term } = &self.model else { return 0.0.into() };
        let Some(end) = dynamics.terms()[*term].form().by_poles() else { unreachable!("made of this term") };
        let Some(motion) = end.motion_by_signal(cable, signal, omega.into()) else { return 0.0.into() };
        let moved = stations.displacement(at, &motion);
        moved.iter().zip(self.local(direction_w)).map(|(u, component)| u * component).sum()
    }

    /// Displacement of station `at` along `direction_w` (unit) for a displacement `far_end_w` of the far end, with the
    /// platform and the amplitudes of the clamped modes at rest.
    pub(crate) fn still_by_far_end(&self, at: usize, direction_w: &Vec3, far_end_w: &Vec3) -> f64 {
        match &self.model {
            StationModel::Straight(fractions) => far_end_w.dot(direction_w) * (1.0 - fractions[at]),
            StationModel::CatenaryDynamic { .. } => {
                self.still_by_ends(at, direction_w, [[0.0; 3], self.local(far_end_w)])
            }
        }
    }

    /// Displacement of station `at` along `direction_w` (unit) for displacements (e, n, b) of the platform end and of
    /// the far end, with the amplitudes of the clamped modes at rest; zero for a cable without mass.
    pub(crate) fn still_by_ends(&self, at: usize, direction_w: &Vec3, [start, end]: [[f64; 3]; 2]) -> f64 {
        let StationModel::CatenaryDynamic { stations, .. } = &self.model else { return 0.0 };
        let moved = stations.still(at, start, end);
        moved.iter().zip(self.local(direction_w)).map(|(u, component)| u * component).sum()
    }

    /// Row of the motion of station `at` along `direction_w` (unit) over the platform's slow motion and the amplitudes
    /// of the cable's clamped modes, in plane and then out of plane. The results are the platform's 6-vector, the index
    /// of a catenary-dynamic cable among the terms of the dynamics, and the row over the amplitudes.
    pub(crate) fn row(&self, dynamics: &Dynamics, at: usize, direction_w: &Vec3) -> (Vec6, Option<usize>, Vec<f64>) {
        let towards = self.local(direction_w);
        match &self.model {
            StationModel::Straight(fractions) => {
                (self.of_end(towards.map(|component| component * fractions[at])), None, Vec::new())
            }
            StationModel::CatenaryDynamic { stations, term, .. } => {
                let Stations { in_plane, out_of_plane, coupled, .. } = stations;
                let [h, v, b] = towards;

                if !coupled.still.is_empty() {
                    let along = |part: &[f64; 3]| part.iter().zip(towards).map(|(part, axis)| part * axis).sum::<f64>();
                    let psi = &coupled.still[at];
                    let still = std::array::from_fn(|n| along(&[psi[0][n], psi[1][n], psi[2][n]]));
                    let amplitudes = coupled.modes.iter().map(|mode| along(&mode[at])).collect();
                    return (self.of_end(still), Some(*term), amplitudes);
                }

                // Slow motion with the platform end.
                let psi = &in_plane.still[at];
                let still = [0, 1].map(|n| h * psi[0][n] + v * psi[1][n]);
                let of_end = self.of_end([still[0], still[1], b * out_of_plane.still[at][0][0]]);

                // Clamped modes.
                let by_in_plane = in_plane.modes.iter().map(|mode| h * mode[at][0] + v * mode[at][1]);
                let counted = if dynamics.linearisation.in_plane_only { &[] } else { &out_of_plane.modes[..] };
                let amplitudes = by_in_plane.chain(counted.iter().map(|mode| b * mode[at][0]));
                (of_end, Some(*term), amplitudes.collect())
            }
        }
    }

    /// Converts a row over the end's displacement in (e, n, b) to a 6-vector about the platform origin.
    fn of_end(&self, row: [f64; 3]) -> Vec6 {
        let LocalAxes { e, n, b } = self.axes;
        let force_w = e * row[0] + n * row[1] + b * row[2];
        let moment_w = self.lever_w.cross(&force_w);
        Vec6::new(force_w.x, force_w.y, force_w.z, moment_w.x, moment_w.y, moment_w.z)
    }

    /// Displacement of station `at` along a unit vector per force along another one at station `loaded`, with the
    /// platform held, at ω [rad/s], damped [m/N]. The stations' cable adds it to the response through the platform.
    pub(crate) fn own_receptance(
        &self,
        dynamics: &Dynamics,
        (at, direction_w): (usize, &Vec3),
        (loaded, force_w): (usize, &Vec3),
        omega: f64,
    ) -> Complex {
        let (out, force) = (self.local(direction_w), self.local(force_w));
        match &self.model {
            // No model here describes how a massless cable yields to a force between its ends.
            StationModel::Straight(_) => Complex::new(f64::NAN, 0.0),
            StationModel::CatenaryDynamic { cable, stations, .. } => {
                let square = dynamics.cable_square(self.cable, omega);
                let motion_along = InternalMotion::under_force(cable, stations, (loaded, force), square);
                let motion_along = with_drive(dynamics, self.cable, cable, motion_along, omega);
                stations.displacement(at, &motion_along).iter().zip(out).map(|(u, component)| u * component).sum()
            }
        }
    }

    /// True if [`own_receptance`](Self::own_receptance) is known.
    pub(crate) fn has_own_receptance(&self) -> bool {
        matches!(self.model, StationModel::CatenaryDynamic { .. })
    }

    /// Motion of the support of the cable, world axes; zero for a rigid anchor.
    fn support_motion_w(&self, dynamics: &Dynamics, supports: &[f64]) -> Vec3 {
        let first = dynamics.supports().and_then(|of| of.of_cable(self.cable));
        let moved = first.and_then(|first| supports.get(first..first + 3));
        moved.map_or_else(Vec3::zeros, Vec3::from_column_slice)
    }

    /// Components (e, n, b) of a direction in world axes.
    fn local(&self, direction_w: &Vec3) -> [f64; 3] {
        let LocalAxes { e, n, b } = self.axes;
        [e, n, b].map(|axis| axis.dot(direction_w))
    }
}

/// Motion along cable `i` at ω [rad/s] with the losses of its drive.
fn with_drive(
    dynamics: &Dynamics,
    i: usize,
    cable: &CatenaryDynamic,
    motion: InternalMotion,
    omega: f64,
) -> InternalMotion {
    let term = dynamics.terms().iter().find(|term| term.cable() == i);
    match term.and_then(|term| term.form().by_poles()) {
        Some(form) if form.has_drive_losses() => {
            let losses = form.beyond_undamped(omega.into(), 1.0);
            motion.with_drive(cable, &losses, dynamics.cable_square(i, omega))
        }
        _ => motion,
    }
}

/// Motion along a cable that follows from its start's. With `in_plane_only` the motion out of plane has no clamped
/// modes.
fn internal_motion(
    dynamics: &Dynamics,
    cable: &CatenaryDynamic,
    start: [Complex; 3],
    square: Complex,
) -> InternalMotion {
    let mut motion = InternalMotion::new(cable, start, square);
    if dynamics.linearisation.in_plane_only {
        motion.out_of_plane.fill(0.0.into());
    }
    motion
}

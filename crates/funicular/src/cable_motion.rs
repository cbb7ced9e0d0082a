//! How the points along the cables move: in a natural mode, and in a response to a force.
//!
//! A cable whose platform end moves by u answers along its length with `Ψ(s) u + Σ φ_k(s) q_k`: the slow shape and its
//! clamped modes, the amplitudes following from u and the frequency (docs/theory.md, section 11).

mod weighted;

pub use weighted::WeightedMotions;

use crate::cable::catenary_dynamic::{CatenaryDynamic, ExactError, InternalMotion, Stations};
use crate::cable::{CableModel, DynamicCable, LocalAxes};
use crate::dynamics::Dynamics;
use crate::math::{CVec6, Complex, Vec3, Vec6};
use crate::modes::Mode;
use crate::robot::Robot;
use crate::statics::Equilibrium;
use thiserror::Error;

/// Why the motion along cables is not known.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum CableMotionError {
    /// The model knows the cable's end only.
    #[error("the {0} model knows the end of a cable only: the motion along it needs the model `catenary-dynamic`")]
    Model(CableModel),
    /// The catenary-dynamic cable cannot be discretised.
    #[error("cable \"{cable}\": {reason}")]
    CatenaryDynamic {
        /// Name of the cable.
        cable: String,
        /// Why.
        reason: ExactError,
    },
}

/// Stations along one cable, and what moves them.
#[derive(Debug, Clone)]
pub struct CableStations {
    /// Which cable, file order.
    pub cable: usize,
    /// Unstrained arc length of each station from the platform [m].
    pub arc_lengths: Vec<f64>,
    /// Where they are at rest, world axes [m].
    pub points_w: Vec<Vec3>,
    /// Axes of the displacements: for a hanging cable e horizontal towards the anchor, n up, b across.
    pub axes: LocalAxes,
    lever_w: Vec3,
    kind: Kind,
}

#[derive(Debug, Clone)]
enum Kind {
    /// A massless cable moves as a straight line: the part of the platform end's motion at each station.
    Straight(Vec<f64>),
    CatenaryDynamic {
        exact: Box<CatenaryDynamic>,
        stations: Stations,
        /// Its place among the cables whose stiffness depends on frequency.
        term: usize,
    },
}

impl CableStations {
    /// Stations at fractions of the unstrained length from the platform (0 to 1), on cable `i` of a robot linearised
    /// about an equilibrium. Forces act on stations that are `loaded`.
    ///
    /// # Errors
    /// [`CableMotionError`]: the closed form has no motion along the cable.
    pub fn new(
        robot: &Robot,
        equilibrium: &Equilibrium,
        dynamics: &Dynamics,
        i: usize,
        fractions: &[f64],
        loaded: bool,
    ) -> Result<Self, CableMotionError> {
        let state = &equilibrium.cables[i];
        let arc_lengths: Vec<f64> = fractions.iter().map(|part| part * state.unstrained_length).collect();
        let term = dynamics.terms().iter().position(|term| term.cable() == i);
        let chord_w = state.chord_w();

        let (kind, axes) = match term.map(|at| (at, dynamics.terms()[at].form())) {
            Some((_, DynamicCable::ShallowDynamic(_))) => {
                return Err(CableMotionError::Model(CableModel::ShallowDynamic));
            }
            Some((term, DynamicCable::CatenaryDynamic(end))) => {
                let hanging = state.hanging.as_ref().expect("a catenary-dynamic cable hangs");
                let (m, limit) = (end.mass_per_length, end.exact.limit);
                let (mut exact, mut stations) =
                    CatenaryDynamic::with_stations(&hanging.catenary, m, limit, arc_lengths.clone(), loaded).map_err(
                        |reason| CableMotionError::CatenaryDynamic { cable: robot.cables[i].name.clone(), reason },
                    )?;
                if !loaded {
                    // The same cable as in `dynamics`, with as many of its clamped modes.
                    if let Some((plane, across)) = end.kept {
                        stations.in_plane.compress(plane, &exact.in_plane.compressed(plane, 2).1);
                        stations.out_of_plane.compress(across, &exact.out_of_plane.compressed(across, 1).1);
                    }
                    exact = end.exact.clone();
                }
                (Kind::CatenaryDynamic { exact: Box::new(exact), stations, term }, end.axes)
            }
            None => {
                let parts = fractions.iter().map(|part| 1.0 - part).collect();
                (Kind::Straight(parts), LocalAxes::of_cable(robot, i, state))
            }
        };

        let points_w = fractions
            .iter()
            .zip(&arc_lengths)
            .map(|(part, s)| match &state.hanging {
                Some(hanging) => hanging.point_w(*s),
                None => state.attachment_w + chord_w * *part,
            })
            .collect();
        Ok(Self { cable: i, arc_lengths, points_w, axes, lever_w: state.lever_w, kind })
    }

    /// Displacement (e, n, b) of each station in a mode [m, as `Mode::shape`]: with the platform at rest that of a
    /// modal mass of 1 kg. The mode is one of the same `dynamics` as the stations.
    pub fn in_mode(&self, dynamics: &Dynamics, mode: &Mode) -> Vec<[f64; 3]> {
        let motion = &mode.motion;
        let motion_w = dynamics.coordinates().expand(&motion.platform);
        let largest = motion_w[motion_w.iamax()];
        let scale = if largest == 0.0 { 1.0 } else { 1.0 / largest };

        match &self.kind {
            Kind::Straight(parts) => {
                let shape = mode.shape;
                let end_w = Vec3::new(shape[0], shape[1], shape[2])
                    + Vec3::new(shape[3], shape[4], shape[5]).cross(&self.lever_w);
                let LocalAxes { e, n, b } = self.axes;
                parts.iter().map(|part| [e, n, b].map(|axis| part * axis.dot(&end_w))).collect()
            }
            Kind::CatenaryDynamic { exact, stations, term } => {
                let of = &dynamics.terms()[*term];
                let start = of.axes().map(|axis| Complex::from(axis.dot(&motion.platform)));
                let square = (mode.frequency_hz * std::f64::consts::TAU).powi(2);
                let mut swing = swing(dynamics, exact, start, square.into());
                let DynamicCable::CatenaryDynamic(end) = of.form() else { unreachable!("made of this term") };

                // Modes whose poles lie at the frequency have amplitudes of their own.
                for near in motion.near.iter().filter(|near| near.term == *term) {
                    // Where stations are loaded the cable is discretised anew, and a mode's sign is its own.
                    let (family, same_sign) = if near.across {
                        let [theirs, ours] =
                            [&end.exact, &**exact].map(|cable| cable.out_of_plane.participation[near.pole]);
                        (&mut swing.out_of_plane, ours.iter().zip(theirs).map(|(a, b)| a * b).sum::<f64>() > 0.0)
                    } else {
                        let [theirs, ours] =
                            [&end.exact, &**exact].map(|cable| cable.in_plane.participation[near.pole]);
                        (&mut swing.in_plane, ours.iter().zip(theirs).map(|(a, b)| a * b).sum::<f64>() > 0.0)
                    };
                    family[near.pole] = if same_sign { near.amplitude } else { -near.amplitude }.into();
                }

                let at = |k: usize| stations.displacement(k, &swing).map(|u| u.re * scale);
                (0..self.arc_lengths.len()).map(at).collect()
            }
        }
    }

    /// What the motion of station `at` along `direction_w` (unit) is of the platform's motion at ω [rad/s], damped: the
    /// 6-vector v(ω) about the platform origin with `u = vᵀ x`. By reciprocity a force f at the station acts on the
    /// platform as `v f`.
    pub fn transmission(&self, dynamics: &Dynamics, at: usize, direction_w: &Vec3, omega: f64) -> CVec6 {
        let LocalAxes { e, n, b } = self.axes;
        let towards = self.local(direction_w);

        // Row of the displacement along the direction by the end's displacement in (e, n, b).
        let row: [Complex; 3] = match &self.kind {
            Kind::Straight(parts) => towards.map(|part| Complex::from(part * parts[at])),
            Kind::CatenaryDynamic { exact, stations, .. } => {
                let square = dynamics.cable_square(self.cable, omega);
                std::array::from_fn(|axis| {
                    let start = std::array::from_fn(|k| Complex::from(f64::from(u8::from(k == axis))));
                    let swing = swing(dynamics, exact, start, square);
                    let moved = stations.displacement(at, &swing);
                    moved.iter().zip(towards).map(|(u, part)| u * part).sum()
                })
            }
        };

        // As a wrench about the platform origin.
        let mut vector = CVec6::zeros();
        for (axis, part) in [e, n, b].into_iter().zip(row) {
            let moment = self.lever_w.cross(&axis);
            for k in 0..3 {
                vector[k] += part * axis[k];
                vector[3 + k] += part * moment[k];
            }
        }
        vector
    }

    /// The motion of station `at` along `direction_w` (unit) by the platform's slow motion and by the amplitudes of the
    /// cable's clamped modes, in plane and then across: the platform's 6-vector, and for a catenary-dynamic cable its place among the
    /// terms of the dynamics and the amplitudes' row.
    pub(crate) fn row(&self, dynamics: &Dynamics, at: usize, direction_w: &Vec3) -> (Vec6, Option<usize>, Vec<f64>) {
        let towards = self.local(direction_w);
        match &self.kind {
            Kind::Straight(parts) => (self.of_end(towards.map(|part| part * parts[at])), None, Vec::new()),
            Kind::CatenaryDynamic { stations, term, .. } => {
                let (plane, across) = (&stations.in_plane, &stations.out_of_plane);
                let [h, v, b] = towards;
                let psi = &plane.still[at];
                let still = [0, 1].map(|n| h * psi[0][n] + v * psi[1][n]);
                let of_end = self.of_end([still[0], still[1], b * across.still[at][0][0]]);
                let in_plane = plane.modes.iter().map(|mode| h * mode[at][0] + v * mode[at][1]);
                let sideways = if dynamics.linearisation.in_plane_only { &[] } else { &across.modes[..] };
                let amplitudes = in_plane.chain(sideways.iter().map(|mode| b * mode[at][0]));
                (of_end, Some(*term), amplitudes.collect())
            }
        }
    }

    /// The 6-vector about the platform origin of a row over the end's displacement in (e, n, b).
    fn of_end(&self, row: [f64; 3]) -> Vec6 {
        let LocalAxes { e, n, b } = self.axes;
        let force_w = e * row[0] + n * row[1] + b * row[2];
        let moment_w = self.lever_w.cross(&force_w);
        Vec6::new(force_w.x, force_w.y, force_w.z, moment_w.x, moment_w.y, moment_w.z)
    }

    /// Displacement of station `at` along a unit vector per force along another at station `loaded`, with the platform
    /// held, at ω [rad/s], damped [m/N]; what the stations' cable adds to the answer through the platform.
    pub(crate) fn own_receptance(
        &self,
        dynamics: &Dynamics,
        (at, direction_w): (usize, &Vec3),
        (loaded, force_w): (usize, &Vec3),
        omega: f64,
    ) -> Complex {
        let (out, force) = (self.local(direction_w), self.local(force_w));
        match &self.kind {
            // A taut massless string: its end forces fix where a force on it acts, and no model here says how it yields.
            Kind::Straight(_) => Complex::new(f64::NAN, 0.0),
            Kind::CatenaryDynamic { exact, stations, .. } => {
                let square = dynamics.cable_square(self.cable, omega);
                stations.receptance(exact, (at, out), (loaded, force), square)
            }
        }
    }

    /// Whether a force on a station has an answer of the cable's own.
    pub(crate) fn is_exact(&self) -> bool {
        matches!(self.kind, Kind::CatenaryDynamic { .. })
    }

    /// Components (e, n, b).
    fn local(&self, direction_w: &Vec3) -> [f64; 3] {
        let LocalAxes { e, n, b } = self.axes;
        [e, n, b].map(|axis| axis.dot(direction_w))
    }
}

/// Motion of a cable by its start's; across it is as slow as can be where only the plane counts.
fn swing(dynamics: &Dynamics, exact: &CatenaryDynamic, start: [Complex; 3], square: Complex) -> InternalMotion {
    let mut swing = InternalMotion::new(exact, start, square);
    if dynamics.linearisation.in_plane_only {
        swing.out_of_plane.fill(0.0.into());
    }
    swing
}

//! Gradients of natural frequencies, damped frequencies, damping ratios and responses.

use super::adjoint::Adjoint;
use super::cable_form::{CableAt, CableMotion, LossesAt};
use super::drive_form::ControlAt;
use super::robot_form::{At, Driven, FormMotion, NearAmplitude, RobotForm};
use super::scalar::{Vector, add_times, cross, vector};
use super::{GradientError, Gradients};
use crate::cable::catenary_dynamic::{DriveSignal, MovingEnd, NearRanges};
use crate::dynamics::{DynamicCableAt, Dynamics, refuse_two_stiffnesses};
use crate::math::{CDMat, CMat6, CVec6, Complex, Vec3, Vec6};
use crate::modes::Mode;
use crate::modes::damped::DampedMode;
use crate::response::{self, Port, Quantity, Signal};
use crate::robot::RobotChange;
use std::f64::consts::TAU;

/// Gradients of vibrations about an equilibrium; from [`Gradients::vibration`].
///
/// # Example
/// ```
/// use funicular::dynamics::{Dynamics, Linearisation};
/// use funicular::gradient::{Gradients, Hold};
/// use funicular::modes;
/// use funicular::robot::{Robot, RobotChange};
/// use funicular::statics::{self, StaticModel};
///
/// let robot = Robot::from_toml(funicular_robots::YUAN2014_4MM)?;
/// let lengths = [6.863, 6.565, 6.756, 6.663, 6.801, 6.604];
/// let first = |robot: &Robot| -> Result<_, Box<dyn std::error::Error>> {
///     let rest = statics::forward(robot, &lengths, StaticModel::Catenary, None)?;
///     let dynamics = Dynamics::about(robot, &rest, Linearisation::default(), 5.0)?;
///     let mode = modes::below(&dynamics, 5.0).modes.swap_remove(0);
///     Ok((rest, dynamics, mode))
/// };
/// let (rest, dynamics, mode) = first(&robot)?;
/// let gradients = Gradients::new(&robot, &rest, Hold::Lengths)?;
/// let by_mass = gradients.vibration(&dynamics)?.frequency(&mode)?.mass; // Hz/kg
///
/// let change = RobotChange::of_mass(&robot);
/// let at = |step: f64| first(&robot.changed(&change, step)).map(|found| found.2.frequency_hz);
/// let [lighter, heavier] = [-1e-3, 1e-3].map(at);
/// assert!((by_mass - (heavier? - lighter?) / 2e-3).abs() < 1e-4 * by_mass.abs());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct VibrationGradients<'g> {
    gradients: &'g Gradients<'g>,
    dynamics: &'g Dynamics,
    form: RobotForm,
    /// Cable of each term whose stiffness depends on frequency.
    terms: Vec<usize>,
}

/// Gradients of a damped mode.
#[derive(Debug, Clone, PartialEq)]
pub struct DampedGradient {
    /// Gradient of the natural frequency |ω|/2π [Hz].
    pub frequency_hz: RobotChange,
    /// Gradient of the frequency of the decaying vibration, Re ω/2π [Hz].
    pub ringing_hz: RobotChange,
    /// Gradient of the damping ratio ζ = Im ω/|ω| [-].
    pub damping_ratio: RobotChange,
}

/// Response at one frequency and its derivatives along directions.
#[derive(Debug, Clone, PartialEq)]
pub struct ResponseDerivatives {
    /// Response.
    pub value: Complex,
    /// Derivative of the response along each direction.
    pub along: Vec<Complex>,
}

impl<'g> VibrationGradients<'g> {
    pub(super) fn new(gradients: &'g Gradients<'g>, dynamics: &'g Dynamics) -> Result<Self, GradientError> {
        refuse_two_stiffnesses(gradients.robot())?;
        let robots = (gradients.robot(), gradients.pullback.settled());
        let form = RobotForm::of_dynamics(robots, gradients.equilibrium(), dynamics)?;
        let terms = dynamics.terms().iter().map(DynamicCableAt::cable).collect();
        Ok(Self { gradients, dynamics, form, terms })
    }

    fn cables(&self) -> usize {
        self.gradients.robot().cables.len()
    }

    /// Gradient of a simple natural frequency [Hz], dω = dW/(2ω · modal mass). Modes with the platform at rest have a
    /// gradient, too.
    ///
    /// # Errors
    /// [`GradientError::Multiple`]: several modes share the frequency; see [`Self::block`].
    ///
    /// # References
    /// docs/theory.md, equation (57).
    pub fn frequency(&self, mode: &Mode) -> Result<RobotChange, GradientError> {
        if mode.multiplicity != 1 {
            let Mode { frequency_hz, multiplicity, .. } = *mode;
            return Err(GradientError::Multiple { frequency_hz, multiplicity });
        }
        let motion = self.motion_of(mode);
        Ok(self.of_pair((mode, &motion), (mode, &motion)))
    }

    /// Gradients of modes that share a frequency [Hz]: a symmetric block. Along a direction of change, the eigenvalues
    /// of the block of the entries' derivatives are the one-sided derivatives of the frequencies. The entries depend on
    /// the choice of the modes at the shared frequency, these eigenvalues do not.
    ///
    /// # References
    /// docs/theory.md, equation (60g).
    pub fn block(&self, modes: &[&Mode]) -> Vec<Vec<RobotChange>> {
        let motions: Vec<_> = modes.iter().map(|mode| self.motion_of(mode)).collect();
        let entry = |i: usize, j: usize| self.of_pair((modes[i], &motions[i]), (modes[j], &motions[j]));
        (0..modes.len()).map(|i| (0..modes.len()).map(|j| entry(i, j)).collect()).collect()
    }

    /// Gradient of the coupling of two modes [Hz], the entry of [`Self::block`] off its diagonal. A change with the
    /// coupling c moves two frequencies with the distance d apart by c²/d each, beyond the change by their gradients.
    /// For modes at different frequencies it is taken at the geometric mean of both.
    ///
    /// # References
    /// docs/theory.md, equations (60g) and (94d2).
    pub fn coupling(&self, a: &Mode, b: &Mode) -> RobotChange {
        self.of_pair((a, &self.motion_of(a)), (b, &self.motion_of(b)))
    }

    /// Motion of a mode with unit modal mass.
    fn motion_of(&self, mode: &Mode) -> FormMotion<f64> {
        let (v, theta) = self.platform_motion(&mode.motion.platform);
        let near: Vec<NearAmplitude<f64>> =
            mode.motion.near.iter().map(|near| (near.term, near.family, near.pole, near.amplitude)).collect();
        let at = self.form.undamped(mode.frequency_hz * TAU);
        let supports = triples(&mode.motion.supports);
        self.form.motion(v, theta, &at, &self.terms, &Driven { supports: &supports, near: &near, forces: None })
    }

    fn of_pair(&self, a: (&Mode, &FormMotion<f64>), b: (&Mode, &FormMotion<f64>)) -> RobotChange {
        let omega = (a.0.frequency_hz * b.0.frequency_hz).sqrt() * TAU;
        let at = self.form.undamped(omega);
        self.gradients.of(|scalar| self.form.add(scalar, a.1, b.1, &at, 1.0 / (2.0 * omega * TAU)))
    }

    /// Translation and rotation in world axes of a scaled motion in the platform's coordinates.
    fn platform_motion(&self, reduced: &Vec6) -> (Vector<f64>, Vector<f64>) {
        let coordinates = self.dynamics.coordinates();
        let motion = coordinates.expand(reduced);
        let ell = coordinates.ell();
        ([motion[0], motion[1], motion[2]], [motion[3] / ell, motion[4] / ell, motion[5] / ell])
    }

    /// Complex frequency ω at which the form is evaluated, with all damping. With `leaves_out`, the drives do not
    /// contain the poles near ω, whose amplitudes are then unknowns; `driven` are the cables with forces on their
    /// drives.
    fn at(&self, omega: Complex, leaves_out: bool, driven: &[usize]) -> At<Complex> {
        let mut cables: Vec<CableAt<Complex>> = (0..self.cables())
            .map(|i| {
                let (square, by_damping) = self.dynamics.square_by_damping(i, omega);
                let loss = self.gradients.robot().cables[i].material.stretch_loss;
                CableAt { square, by_damping, ..CableAt::default() }.with_stretch(loss, omega)
            })
            .collect();
        for term in self.dynamics.terms() {
            let Some(form) = term.form().by_poles() else { continue };
            let at = &mut cables[term.cable()];
            if let Some(motor) = form.cable.end.as_ref().and_then(MovingEnd::chain).and_then(|chain| chain.motor) {
                at.control = ControlAt::at(motor.servo.as_ref(), motor.damping, omega);
            }
            if form.has_drive_losses() || driven.contains(&term.cable()) {
                let left_out =
                    if leaves_out { Dynamics::near_of_border(form, at.square) } else { NearRanges::default() };
                let losses = form.beyond_undamped(omega, 1.0);
                at.losses = form.drive_at(at.square, &left_out).map(|motions| LossesAt::of(&motions, &losses));
            }
        }
        At { square: omega * omega, rate: omega * Complex::i(), loss: Complex::i(), cables }
    }

    /// Gradients of a damped mode, whose zero of the dynamic stiffness is simple.
    ///
    /// # Errors
    /// [`GradientError::NoDampedMotion`]: modes that share a frequency.
    ///
    /// # References
    /// docs/theory.md, equation (60h).
    pub fn damped(&self, mode: &DampedMode) -> Result<DampedGradient, GradientError> {
        let omega = mode.omega;
        let refused = || GradientError::NoDampedMotion { frequency_hz: mode.frequency_hz() };
        let found = self.dynamics.damped_motion(omega).ok_or_else(refused)?;

        let at = self.at(omega, true, &[]);
        let [re, im] = [|z: &Complex| z.re, |z: &Complex| z.im].map(|part| found.platform.map(|z| part(&z)));
        let [re, im] = [re, im].map(|part| self.platform_motion(&part));
        let join = |re: Vector<f64>, im: Vector<f64>| std::array::from_fn(|k| Complex::new(re[k], im[k]));
        let supports = triples(&found.supports);
        let driven = Driven { supports: &supports, near: &found.near, forces: None };
        let motion = self.form.motion(join(re.0, im.0), join(re.1, im.1), &at, &self.terms, &driven);
        let mut by_omega = Adjoint::zeros(self.cables());
        self.form.add(&mut by_omega, &motion, &motion, &at, -found.slope.inv());

        // d|ω|, d Re ω and dζ from dω.
        let size = omega.norm();
        let gradient = |of: &dyn Fn(Complex) -> f64| self.gradients.pullback.gradient(&by_omega.map(of));
        Ok(DampedGradient {
            frequency_hz: gradient(&|z| (omega.conj() * z).re / (size * TAU)),
            ringing_hz: gradient(&|z| z.re / TAU),
            damping_ratio: gradient(&|z| omega.re * (omega.re * z.im - omega.im * z.re) / size.powi(3)),
        })
    }

    /// Responses between all pairs of signals on the platform and at drives (`length`, `motor`, `drum`) at each
    /// frequency [Hz], with their derivatives along directions: one row per pair, in the order of [`response::matrix`].
    ///
    /// A direction is a change of the robot. The point of a signal turns with the platform, and the direction of a
    /// signal stays in the world.
    ///
    /// # Errors
    /// [`GradientError::NotOnPlatform`], [`GradientError::NoDriveSignal`], [`GradientError::Resonance`].
    ///
    /// # Example
    /// ```
    /// use funicular::dynamics::{Dynamics, Linearisation};
    /// use funicular::gradient::{Gradients, Hold};
    /// use funicular::math::Vec3;
    /// use funicular::response::{Quantity, Signal};
    /// use funicular::robot::{Robot, RobotChange};
    /// use funicular::statics::{self, StaticModel};
    ///
    /// let robot = Robot::from_toml(funicular_robots::YUAN2014_4MM)?;
    /// let rest = statics::solve(&robot, StaticModel::Catenary, None)?.equilibrium;
    /// let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), 5.0)?;
    /// let gradients = Gradients::new(&robot, &rest, Hold::Lengths)?;
    /// let z = Signal::Along { direction_w: Vec3::z(), point_p: Vec3::zeros() };
    /// let mass = RobotChange::of_mass(&robot);
    /// let output = (z, Quantity::Acceleration);
    /// let rows = gradients.vibration(&dynamics)?.responses(&[z], &[output], &[1.1, 1.2], &[mass])?;
    /// assert_eq!((rows.len(), rows[0].len(), rows[0][0].along.len()), (1, 2, 1));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # References
    /// docs/theory.md, equation (60i).
    pub fn responses(
        &self,
        inputs: &[Signal],
        outputs: &[(Signal, Quantity)],
        frequencies_hz: &[f64],
        along: &[RobotChange],
    ) -> Result<Vec<Vec<ResponseDerivatives>>, GradientError> {
        let (signals, from, to) = different(inputs, outputs);
        let places = signals.iter().map(|signal| self.place(signal)).collect::<Result<Vec<_>, _>>()?;
        let driven: Vec<usize> = places.iter().filter_map(SignalPlace::cable).collect();
        let receptances = response::receptances(self.dynamics, frequencies_hz).map_err(|reason| match reason {
            response::ResponseError::Resonance { frequency_hz } => GradientError::Resonance { frequency_hz },
            response::ResponseError::SameCable => GradientError::NotOnPlatform,
        })?;

        let mut rows = vec![Vec::with_capacity(frequencies_hz.len()); inputs.len() * outputs.len()];
        for (receptance, frequency_hz) in receptances.iter().zip(frequencies_hz) {
            let omega = frequency_hz * TAU;
            let at = self.at(omega.into(), false, &driven);
            let followed = self.dynamics.support_response(omega);
            let moved = |place| self.moved_by(place, receptance, followed.as_ref(), &at, omega);
            let responses: Vec<SignalResponse> = places.iter().map(moved).collect();
            let of_signal = |i: &usize| (&places[*i], &responses[*i]);

            let pairs = to
                .iter()
                .zip(outputs)
                .flat_map(|(to, (_, quantity))| from.iter().map(move |from| (to, quantity, from)));
            for (row, (to, quantity, from)) in rows.iter_mut().zip(pairs) {
                let factor = quantity.factor(omega);
                row.push(self.derivatives_of_pair(of_signal(to), of_signal(from), &at, factor, along));
            }
        }
        Ok(rows)
    }

    /// Motion of the robot by a unit of a signal at ω [rad/s]. `followed` is [`Dynamics::support_response`].
    fn moved_by(
        &self,
        place: &SignalPlace,
        receptance: &CMat6,
        followed: Option<&(CDMat, CDMat)>,
        at: &At<Complex>,
        omega: f64,
    ) -> SignalResponse {
        let (vector, on_supports) = place.vector(self.dynamics, followed.map(|of| &of.0), omega);
        let platform = receptance * vector;
        let (v, theta) = halves(&platform);
        let supports = self.displacements(followed, &platform, &on_supports);
        let forces = place.forces(self.dynamics, omega);
        let driven = Driven {
            supports: &supports,
            near: &[],
            forces: forces.as_ref().map(|(cable, forces)| (*cable, &forces[..])),
        };
        let motion = self.form.motion(v, theta, at, &self.terms, &driven);
        SignalResponse { platform, forces, motion }
    }

    /// Response of an output to an input, with its derivatives along directions; `factor` leads from the displacement
    /// to the quantity of the output.
    fn derivatives_of_pair(
        &self,
        (output, by_output): (&SignalPlace, &SignalResponse),
        (input, by_input): (&SignalPlace, &SignalResponse),
        at: &At<Complex>,
        factor: Complex,
        along: &[RobotChange],
    ) -> ResponseDerivatives {
        let value = factor * output.displacement(by_output, by_input);

        let mut scalar = Adjoint::zeros(self.cables());
        self.form.add(&mut scalar, &by_output.motion, &by_input.motion, at, -factor);
        for (place, other) in [(output, by_input), (input, by_output)] {
            match place {
                SignalPlace::OnPlatform { .. } => place.add_turn(&mut scalar, &halves(&other.platform).1, factor),
                SignalPlace::Drive { cable, signal, .. } => {
                    self.form.add_signal(&mut scalar, (*cable, *signal), &other.motion, at, factor);
                }
            }
        }
        ResponseDerivatives { value, along: self.along(&scalar, along) }
    }

    /// Displacements of the supports for a motion of the platform and forces on the supports, from
    /// [`Dynamics::support_response`].
    fn displacements(&self, followed: Option<&(CDMat, CDMat)>, x: &CVec6, forces: &[Complex]) -> Vec<Vector<Complex>> {
        let Some((by_platform, by_forces)) = followed else { return Vec::new() };
        let mut all = vec![Complex::new(0.0, 0.0); by_platform.nrows()];
        for (k, displacement) in all.iter_mut().enumerate() {
            let row = self.dynamics.unscaled_vector(&CVec6::from_fn(|i, _| by_platform[(k, i)]));
            *displacement =
                -row.dot(x) + forces.iter().enumerate().map(|(j, force)| by_forces[(k, j)] * force).sum::<Complex>();
        }
        triples(&all)
    }

    /// Derivatives along directions of the scalar with these coefficients.
    fn along(&self, scalar: &Adjoint<Complex>, directions: &[RobotChange]) -> Vec<Complex> {
        let [re, im] = [scalar.map(|z| z.re), scalar.map(|z| z.im)].map(|part| self.gradients.pullback.gradient(&part));
        directions.iter().map(|direction| Complex::new(re.dot(direction), im.dot(direction))).collect()
    }

    fn place(&self, signal: &Signal) -> Result<SignalPlace, GradientError> {
        let pose = &self.gradients.equilibrium().pose;
        if let Signal::Drive { cable, signal } = signal {
            let refused = || GradientError::NoDriveSignal {
                cable: self.gradients.robot().cables[*cable].name.clone(),
                signal: signal.name(),
            };
            let term = self.terms.iter().position(|of| of == cable).ok_or_else(refused)?;
            let lever_w = self.gradients.equilibrium().cables[*cable].lever_w;
            let port = Port::Drive { term, signal: *signal, lever_w };
            let place = SignalPlace::Drive { cable: *cable, term, signal: *signal, port };
            // Every frequency has the same signals.
            place.forces(self.dynamics, 1.0).ok_or_else(refused)?;
            return Ok(place);
        }
        let vector = signal.platform_vector(pose).ok_or(GradientError::NotOnPlatform)?;
        let arm = match signal {
            Signal::Along { direction_w, point_p } => Some((direction_w.normalize(), pose.rot_wp * point_p)),
            _ => None,
        };
        Ok(SignalPlace::OnPlatform { vector, arm })
    }
}

/// Place of a signal.
enum SignalPlace {
    /// Point or axis on the platform: vector about its origin; direction and arm of a point, world axes.
    OnPlatform { vector: Vec6, arm: Option<(Vec3, Vec3)> },
    /// Signal of a cable's drive, with the index of the cable among those whose stiffness depends on frequency.
    Drive { cable: usize, term: usize, signal: DriveSignal, port: Port },
}

impl SignalPlace {
    /// Cable of a drive's signal.
    fn cable(&self) -> Option<usize> {
        if let Self::Drive { cable, .. } = *self { Some(cable) } else { None }
    }

    /// Vector about the platform origin at ω [rad/s] with free supports, and the forces on these; see
    /// [`Port::free_vector`].
    fn vector(&self, dynamics: &Dynamics, by_platform: Option<&CDMat>, omega: f64) -> (CVec6, Vec<Complex>) {
        match self {
            Self::OnPlatform { vector, .. } => (vector.map(Complex::from), Vec::new()),
            Self::Drive { port, .. } => port.free_vector(dynamics, by_platform, omega),
        }
    }

    /// Displacement of the signal in the response to another one. `own` is the response to the signal itself, with its
    /// forces on a drive.
    fn displacement(&self, own: &SignalResponse, other: &SignalResponse) -> Complex {
        match (self, &own.forces) {
            (Self::OnPlatform { vector, .. }, _) => (0..6).map(|k| other.platform[k] * vector[k]).sum::<Complex>(),
            (Self::Drive { .. }, Some((cable, row))) => {
                let motions = other.motion.cable(*cable).map_or(&[][..], CableMotion::of_drive);
                row.iter().zip(motions).map(|(row, z)| row * z).sum()
            }
            (Self::Drive { .. }, None) => Complex::new(0.0, 0.0),
        }
    }

    /// Forces of a drive's signal on the motions of its cable, with that cable.
    fn forces(&self, dynamics: &Dynamics, omega: f64) -> Option<(usize, Vec<Complex>)> {
        let Self::Drive { cable, term, signal, .. } = self else { return None };
        let form = dynamics.terms()[*term].form().by_poles()?;
        Some((*cable, form.signal_forces(*signal, omega.into())?))
    }

    /// Adds the turn of the arm r with the platform, `((dφ × r) × u)·θ = dφ·(r × (u × θ))`, for a rotation θ.
    fn add_turn(&self, scalar: &mut Adjoint<Complex>, theta: &Vector<Complex>, factor: Complex) {
        if let Self::OnPlatform { arm: Some((direction, arm)), .. } = self {
            let turn = cross(&vector(arm), &cross(&vector(direction), theta));
            add_times(&mut scalar.rotation, &turn, factor);
        }
    }
}

/// Motion of the robot by a unit of a signal.
struct SignalResponse {
    /// Motion of the platform about its origin.
    platform: CVec6,
    /// Forces of a drive's signal on the motions of its cable, with that cable.
    forces: Option<(usize, Vec<Complex>)>,
    motion: FormMotion<Complex>,
}

/// Different signals among inputs and outputs, and their numbers for the inputs and for the outputs. The motion by a
/// signal is computed once, also if it is both input and output.
fn different<'s>(inputs: &'s [Signal], outputs: &'s [(Signal, Quantity)]) -> (Vec<&'s Signal>, Vec<usize>, Vec<usize>) {
    let mut signals: Vec<&Signal> = Vec::with_capacity(inputs.len() + outputs.len());
    let mut numbered = |signal| {
        signals.iter().position(|known| *known == signal).unwrap_or_else(|| {
            signals.push(signal);
            signals.len() - 1
        })
    };
    let from = inputs.iter().map(&mut numbered).collect();
    let to = outputs.iter().map(|(signal, _)| numbered(signal)).collect();
    (signals, from, to)
}

/// Displacements of the supports from their coordinates, three per support.
fn triples<T: Copy>(coordinates: &[T]) -> Vec<Vector<T>> {
    coordinates.chunks_exact(3).map(|of| [of[0], of[1], of[2]]).collect()
}

/// Translation and rotation of a motion.
fn halves(motion: &CVec6) -> (Vector<Complex>, Vector<Complex>) {
    ([motion[0], motion[1], motion[2]], [motion[3], motion[4], motion[5]])
}

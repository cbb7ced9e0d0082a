//! Rope behind the exit point: arc, drum side, guide wheels, drum and motor, as unstrained lengths from the platform.
//!
//! The coordinate of each station is the unstrained length Y from the platform to it, the exit point being the first.
//! Between two stations lies a piece of rope, whose content is the difference of their lengths, or the shaft of the
//! winch. What holds the last station is a commanded length, a motor, or a given tension.

use super::rope::WoundLength;
use crate::drive::{arc_nodes, stretch_of, tension_of};
use crate::math::Vec3;
use crate::robot::{Anchor, Control, DrumSide, PulleyContact, Servo, Winch};
use crate::statics::CableState;

/// Number of pieces of a drum side with mass between two stations. The first axial wave of a bar with six lumped masses
/// is 1 % too slow and the second 4.5 %, by `sin x = x (1 − x²/6 …)` at x = nπ/12.
const ROD_PIECES: usize = 6;
/// Geometric length of a piece below which it counts as this long [m]: a piece of no length has no stiffness, and its
/// stretch of a thousandth would be 1e-7 m.
const MIN_PIECE: f64 = 1e-4;
/// Time constant of the slow integral action of a servo, in radians of its bandwidth: it leaves no error at rest, and a
/// mode at a tenth of the bandwidth sees a hundredth of it.
const INTEGRAL_RADIANS: f64 = 1000.0;

/// Piece between two stations, or between the last one and what holds it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum FeedLink {
    /// Rope of a geometric length [m]; the first has the arc, too. A winch that yields pays out `compliance` per
    /// tension
    /// [m/N].
    Rope { straight: f64, compliance: f64 },
    /// Shaft of this stiffness at the rope [N/m].
    Shaft(f64),
}

/// Part that holds the last station.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum WinchHold {
    /// The commanded unstrained length, or the motor that follows it.
    Length,
    /// A tension at the drum that goes from one value to another.
    Tension { from: f64, duration: f64, before: f64, after: f64 },
}

impl WinchHold {
    /// Tension of the drum at a time [N]; `None` if a length is commanded.
    pub(super) fn tension(&self, time: f64) -> Option<f64> {
        let Self::Tension { from, duration, before, after } = *self else { return None };
        let x = if duration > 0.0 { ((time - from) / duration).clamp(0.0, 1.0) } else { 1.0 };
        Some(before + (after - before) * super::winding::ramp(x)[0])
    }
}

/// Motor that is the last station.
#[derive(Debug, Clone, Copy, PartialEq)]
struct FeedMotor {
    damping: f64,
    servo: Option<Servo>,
    /// Integral gain [N/(m s)].
    integral_gain: f64,
}

impl FeedMotor {
    fn of(winch: &Winch) -> Self {
        let servo = if let Control::Position(servo) = winch.control { Some(servo) } else { None };
        let gain = |servo: &Servo| {
            let bandwidth = (servo.position_gain / (winch.drum_mass + winch.motor_mass)).sqrt();
            if servo.integral { servo.position_gain * bandwidth / INTEGRAL_RADIANS } else { 0.0 }
        };
        Self { damping: winch.damping, servo, integral_gain: servo.as_ref().map_or(0.0, gain) }
    }
}

/// Rope on a pulley at one moment: lengths of its parts [m], and ψ of each part less that at the entry point [N].
pub(super) type ArcParts = [(f64, f64); 6];

/// Rope and winch behind an exit point.
#[derive(Debug, Clone)]
pub(super) struct Feed {
    /// Pieces from the exit point on.
    links: Vec<FeedLink>,
    /// Mass of each station at the rope [kg].
    pub(super) masses: Vec<f64>,
    motor: Option<FeedMotor>,
    pub(super) hold: WinchHold,
    /// Force of the motor that balances the rest position of its controller [N].
    pub(super) bias: f64,
    /// Stretch with which the rope was wound.
    pub(super) stretch: f64,
    axial_stiffness: f64,
    /// True while the last station does what it is told: before its tension is set, and while the start is sought.
    pub(super) is_locked: bool,
    /// Length by which a locked last station is beyond its command [m]: that by which a winch without inertia yields.
    ahead: f64,
    /// Unstrained rope between the last station and a winch that holds a tension without inertia [m].
    pub(super) behind: f64,
}

/// Forces of a feed on its stations and their derivatives.
#[derive(Debug, Clone, Default)]
pub(super) struct FeedForces {
    /// Force that each station needs but for inertia, conjugate to Y [N].
    pub(super) needed: Vec<f64>,
    /// Stiffness and damping of each station, and stiffness between it and the next.
    pub(super) stiffness: Vec<f64>,
    pub(super) damping: Vec<f64>,
    pub(super) coupling: Vec<f64>,
    /// Tension of the last piece of rope or of the shaft [N]; `None` if the drum is at the exit point.
    pub(super) tension_drum: Option<f64>,
    /// Tension between the entry point and the next station [N]; zero if the drum is at the exit point.
    pub(super) tension_entry: f64,
    /// Energy of pieces and shaft [J], without weight.
    pub(super) strain: f64,
    /// Power of what holds the last station [W], without that of weight, and power lost in it.
    pub(super) power: f64,
    pub(super) dissipation: f64,
}

/// State of one piece of rope.
#[derive(Debug, Clone, Copy, Default)]
struct PieceState {
    psi: f64,
    /// −dψ/dS [N/m].
    stiffness: f64,
    tension: f64,
    strain: f64,
}

impl Feed {
    /// Feed of a cable; `None` if the rope cannot move at its exit point.
    pub(super) fn of(anchor: &Anchor, state: &CableState, axial_stiffness: f64, mass: f64) -> Option<Self> {
        let winch = anchor.winch.as_ref();
        let control = winch.map_or(Control::Ideal, |winch| winch.control);
        let moves = winch.is_some_and(|winch| control != Control::Ideal || winch.stiffness.is_finite());
        let has_rope = anchor.pulley.is_some() || anchor.drum_side_length() > 0.0;
        if !has_rope && !moves {
            return None;
        }
        let stretch = 1.0 + state.tension_drum() / axial_stiffness;
        let mut feed = Self {
            links: Vec::new(),
            masses: vec![anchor.pulley.as_ref().map_or(0.0, |pulley| pulley.inertia / pulley.radius.powi(2))],
            motor: None,
            hold: WinchHold::Length,
            bias: 0.0,
            stretch,
            axial_stiffness,
            is_locked: false,
            ahead: 0.0,
            behind: 0.0,
        };
        let on_drum = if has_rope { feed.add_drum_side(winch, anchor.drum_side_length(), mass) } else { 0.0 };
        if let Some(winch) = winch {
            feed.add_winch(winch, on_drum);
        }
        Some(feed)
    }

    /// Feed of a winch at the anchor that will hold a tension: the length is commanded until then.
    pub(super) fn plain(axial_stiffness: f64) -> Self {
        Self {
            links: Vec::new(),
            masses: vec![0.0],
            motor: None,
            hold: WinchHold::Length,
            bias: 0.0,
            stretch: 1.0,
            axial_stiffness,
            is_locked: true,
            ahead: 0.0,
            behind: 0.0,
        }
    }

    /// Pieces between guide wheels and pieces of a rod; the mass of rope that lies on the drum [kg].
    fn add_drum_side(&mut self, winch: Option<&Winch>, length: f64, mass: f64) -> f64 {
        let wheels = winch.map_or(&[][..], |winch| &winch.guide_wheels);
        let is_rod = winch.is_some_and(|winch| winch.drum_side == DrumSide::Rod) && mass > 0.0 && length > 0.0;
        let mut ends: Vec<(f64, f64)> =
            wheels.iter().filter(|wheel| wheel.mass > 0.0).map(|wheel| (wheel.distance, wheel.mass)).collect();
        ends.push((length, 0.0));
        let mut before = 0.0;
        for (end, wheel) in ends {
            let parts = if is_rod { ROD_PIECES } else { 1 };
            let straight = (end - before) / parts as f64;
            let part_mass = if is_rod { mass * straight / self.stretch } else { 0.0 };
            for _ in 0..parts {
                if let Some(last) = self.masses.last_mut() {
                    *last += 0.5 * part_mass;
                }
                self.links.push(FeedLink::Rope { straight, compliance: 0.0 });
                self.masses.push(0.5 * part_mass);
            }
            if let Some(last) = self.masses.last_mut() {
                *last += wheel;
            }
            before = end;
        }
        // The last station is the drum, which `add_winch` makes one if it moves.
        self.masses.pop().unwrap_or(0.0)
    }

    /// Drum, shaft and motor; `on_drum` is the mass of rope there [kg].
    fn add_winch(&mut self, winch: &Winch, on_drum: f64) {
        let motor_moves = winch.control != Control::Ideal;
        // A motor with constant torque and without inertia pulls the drum itself.
        let has_shaft = winch.stiffness.is_finite() && !(motor_moves && winch.motor_mass == 0.0);
        let turning = winch.drum_mass + if motor_moves && !has_shaft { winch.motor_mass } else { 0.0 };
        let has_rope = !self.links.is_empty();

        if has_shaft {
            match self.links.last_mut() {
                Some(FeedLink::Rope { compliance, .. }) if turning == 0.0 => *compliance = 1.0 / winch.stiffness,
                _ => {
                    self.station(has_rope, turning + on_drum);
                    self.links.push(FeedLink::Shaft(winch.stiffness));
                }
            }
        }
        let mass = if has_shaft { winch.motor_mass } else { turning + on_drum };
        if motor_moves && mass > 0.0 {
            self.station(has_rope || has_shaft, mass);
            self.motor = Some(FeedMotor::of(winch));
        }
    }

    /// Adds a mass as a station of its own, or to the exit point if no rope lies between them.
    fn station(&mut self, is_behind: bool, mass: f64) {
        match self.masses.last_mut() {
            Some(last) if !is_behind => *last += mass,
            _ => self.masses.push(mass),
        }
    }

    /// Locks the last station while the start is sought, if what holds it does so at any tension. `beyond` is its
    /// length in statics over the commanded one [m].
    pub(super) fn lock(&mut self, beyond: f64) {
        self.ahead = beyond;
        self.is_locked = self.is_locked || self.has_integral() || self.motor.is_none_or(|motor| motor.servo.is_none());
    }

    /// Lets the last station go after the start has been found. `needed` is the force that it needs there from all
    /// that is attached to it, the free span included where the drum is at the anchor [N]; `forces` are those of the
    /// feed alone. A motor balances this force by itself, and a winch without inertia that pulls with a constant
    /// `torque` holds the tension at its drum. `lengths` are the commanded length and that of the last station.
    pub(super) fn let_go(&mut self, needed: f64, forces: &FeedForces, torque: bool, lengths: [f64; 2]) {
        if self.motor.is_some() && self.follows_command() {
            self.bias = -needed / self.stretch;
        }
        if torque && self.motor.is_none() {
            let tension = forces.tension_drum.unwrap_or_else(|| tension_of(-needed, self.stretch_at(-needed)));
            let hold = WinchHold::Tension { from: 0.0, duration: 0.0, before: tension, after: tension };
            self.hold_tension(hold, lengths);
        }
        self.is_locked = false;
    }

    /// Number of stations.
    pub(super) fn count(&self) -> usize {
        self.masses.len()
    }

    /// True if the rope behind the last station follows a commanded length or tension.
    fn is_open(&self) -> bool {
        self.links.len() == self.masses.len()
    }

    /// Energy per unstrained length that rope on a drum at the exit point keeps [N]: that of the stretch with which it
    /// was wound. Zero if rope lies between them.
    fn stored_at_exit(&self) -> f64 {
        let is_drum = match self.links.first() {
            None => self.motor.is_some(),
            Some(link) => matches!(link, FeedLink::Shaft(_)),
        };
        if is_drum { 0.5 * self.axial_stiffness * (self.stretch - 1.0).powi(2) } else { 0.0 }
    }

    /// True if a motor with a servo holds its place at rest, whatever the tension.
    pub(super) fn has_integral(&self) -> bool {
        self.motor.is_some_and(|motor| motor.integral_gain > 0.0)
    }

    /// Delay of the servo that holds the last station [s], and its gains in the coordinates of the stations; `None`
    /// without a delay. While the winch holds a tension the gains are zero.
    pub(super) fn delayed_servo(&self) -> Option<(f64, [f64; 2])> {
        let servo = self.motor?.servo.filter(|servo| servo.delay > 0.0)?;
        let scale = if self.hold == WinchHold::Length { self.stretch * self.stretch } else { 0.0 };
        Some((servo.delay, [servo.position_gain, servo.speed_gain].map(|gain| scale * gain)))
    }

    /// True while the last station goes where the command goes.
    pub(super) fn follows_command(&self) -> bool {
        self.is_locked && !self.is_open()
    }

    /// Motion of a last station that follows its command.
    pub(super) fn commanded(&self, given: &WoundLength) -> WoundLength {
        WoundLength { value: given.value + self.ahead, ..*given }
    }

    /// Unstrained length from the platform to what holds the rope.
    pub(super) fn whole(&self, given: WoundLength, z: [&[f64]; 3]) -> WoundLength {
        if self.is_open() && self.hold == WinchHold::Length {
            return given;
        }
        let [value, rate, acceleration] = z.map(|of| of[self.count() - 1]);
        WoundLength { value: value + self.behind, rate, acceleration }
    }

    /// From now on the winch holds a tension. `lengths` are the unstrained lengths to the winch and to the last
    /// station.
    pub(super) fn hold_tension(&mut self, hold: WinchHold, [given, last]: [f64; 2]) {
        if self.hold == WinchHold::Length && self.is_open() {
            self.behind = given - last;
        }
        self.hold = hold;
        self.is_locked = false;
    }

    /// State of piece `j` with this content. The first piece has an arc, and its straight part may be longer than at
    /// the start.
    fn piece(&self, j: usize, content: f64, (arc, longer): (Option<&ArcParts>, f64)) -> PieceState {
        match self.links[j] {
            FeedLink::Rope { straight, compliance } => {
                let (arc, longer) = if j == 0 { (arc, longer) } else { (None, 0.0) };
                let straight = if arc.is_none() { straight.max(MIN_PIECE) } else { straight } + longer;
                rope_piece(self.axial_stiffness, (straight, compliance), arc, content)
            }
            FeedLink::Shaft(stiffness) => {
                let along = stiffness * self.stretch * self.stretch;
                let psi = -along * content;
                let strain = 0.5 * along * content * content;
                PieceState { psi, stiffness: along, tension: psi / self.stretch, strain }
            }
        }
    }

    /// Forces for the lengths `y` of the stations and their rates, behind them the integral of the servo's error and
    /// its delayed error. `given` is the commanded length; `first` is the arc of the first piece, and by how much its
    /// straight part is longer than at the start [m].
    ///
    /// # References
    /// docs/theory.md, equations (97l) and (97m).
    pub(super) fn forces(
        &self,
        time: f64,
        given: &WoundLength,
        (y, v): (&[f64], &[f64]),
        first: (Option<&ArcParts>, f64),
    ) -> FeedForces {
        let count = self.count();
        let mut out = FeedForces {
            needed: vec![0.0; count],
            stiffness: vec![0.0; count],
            damping: vec![0.0; count],
            coupling: vec![0.0; count],
            ..FeedForces::default()
        };
        // The free span is the only neighbour of a drum at the exit point, and the rope that enters it brings its
        // stretch.
        let stored = self.stored_at_exit();
        out.needed[0] -= stored;
        out.power += stored * v[0];
        for j in 0..self.links.len() {
            let is_last = j + 1 == count;
            let tension = if is_last { self.hold.tension(time) } else { None };
            let content = if is_last { given.value } else { y[j + 1] } - y[j];
            let piece = match tension {
                None => self.piece(j, content, first),
                Some(tension) => self.pulled(self.links.get(j), tension),
            };
            out.needed[j] += piece.psi;
            out.stiffness[j] += piece.stiffness;
            out.strain += piece.strain;
            if j == 0 {
                out.tension_entry = piece.tension;
            }
            out.tension_drum = Some(piece.tension);
            if is_last {
                out.power -= piece.psi * if tension.is_some() { v[j] } else { given.rate };
                continue;
            }
            // The rope on the drum keeps the stretch with which it was wound.
            let is_drum = matches!(self.links.get(j + 1), Some(FeedLink::Shaft(_)) | None);
            let rope_ends = is_drum && matches!(self.links[j], FeedLink::Rope { .. });
            let on_next = if rope_ends { self.stretch * piece.tension } else { piece.psi };
            out.power += (on_next - piece.psi) * v[j + 1];
            out.needed[j + 1] -= on_next;
            out.stiffness[j + 1] += piece.stiffness;
            out.coupling[j] -= piece.stiffness;
        }
        if !self.is_open() {
            self.add_hold(time, given, (y, v), &mut out);
        }
        out
    }

    /// ψ of a tension [N].
    pub(super) fn psi(&self, tension: f64) -> f64 {
        tension * (1.0 + 0.5 * tension / self.axial_stiffness)
    }

    /// Stretch at ψ.
    pub(super) fn stretch_at(&self, psi: f64) -> f64 {
        stretch_of(psi, self.axial_stiffness)
    }

    /// Piece that a winch without inertia pulls with a tension; its energy is the winch's. A shaft turns a drum, whose
    /// rope keeps its stretch.
    fn pulled(&self, link: Option<&FeedLink>, tension: f64) -> PieceState {
        let tension = tension.max(0.0);
        let psi = match link {
            Some(FeedLink::Shaft(_)) => self.stretch * tension,
            _ => self.psi(tension),
        };
        PieceState { psi, tension, ..PieceState::default() }
    }

    /// Adds what holds the last station: a motor, or a tension without inertia.
    fn add_hold(&self, time: f64, given: &WoundLength, (y, v): (&[f64], &[f64]), out: &mut FeedForces) {
        let last = self.count() - 1;
        let Some(motor) = self.motor else {
            // A station that follows its command has the force that it needs.
            if let Some(tension) = self.hold.tension(time) {
                let psi = self.pulled(None, tension).psi;
                out.needed[last] += psi;
                out.power -= psi * v[last];
            }
            return;
        };
        let scale = self.stretch * self.stretch;
        let mut force = self.stretch * self.hold.tension(time).unwrap_or(self.bias);
        if let (Some(servo), WinchHold::Length) = (motor.servo, self.hold) {
            let has_integral = motor.integral_gain > 0.0;
            let integral = if has_integral { y[last + 1] } else { 0.0 };
            let [error, rate] = if servo.delay > 0.0 {
                let delayed = last + 1 + usize::from(has_integral);
                [y[delayed], v[delayed]]
            } else {
                out.stiffness[last] += scale * servo.position_gain;
                out.damping[last] += scale * servo.speed_gain;
                [y[last] - given.value, v[last] - given.rate]
            };
            force += scale * (servo.position_gain * error + servo.speed_gain * rate + motor.integral_gain * integral);
        }
        out.needed[last] += force + scale * motor.damping * v[last];
        out.damping[last] += scale * motor.damping;
        out.power -= force * v[last];
        out.dissipation += scale * motor.damping * v[last] * v[last];
    }

    /// Unstrained lengths of the stations at rest behind a free span of the length `free`.
    pub(super) fn at_rest(&self, free: f64, psi: f64, arc: Option<&ArcParts>, longer: f64) -> Vec<f64> {
        let mut y = vec![free];
        for j in 1..self.count() {
            let content = match self.links[j - 1] {
                FeedLink::Shaft(stiffness) => {
                    let tension = tension_of(psi, self.stretch_at(psi));
                    -tension / (stiffness * self.stretch)
                }
                FeedLink::Rope { straight, compliance } => {
                    let arc = arc.filter(|_| j == 1);
                    let straight = if arc.is_none() { straight.max(MIN_PIECE) } else { straight };
                    let straight = straight + if j == 1 { longer } else { 0.0 };
                    content_at(self.axial_stiffness, (straight, compliance), arc, psi).0
                }
            };
            y.push(y[j - 1] + content);
        }
        y
    }
}

/// Content of a piece of rope at ψ, and minus its derivative by ψ [m/N].
fn content_at(ea: f64, (straight, compliance): (f64, f64), arc: Option<&ArcParts>, psi: f64) -> (f64, f64) {
    let at_entry = stretch_of(psi, ea);
    let tension = tension_of(psi, at_entry);
    let content = (straight - tension * compliance) / at_entry;
    let square = at_entry * at_entry;
    let (mut sum, mut slope) = (content, compliance / square + content / (ea * square));
    for (length, lift) in arc.into_iter().flatten() {
        let here = stretch_of(psi + lift, ea);
        sum += length / here;
        slope += length / (ea * here.powi(3));
    }
    (sum, slope)
}

/// State of a piece of rope with a given content: ψ by Newton's method. It may be negative: the free span, which cannot
/// push, sees to it that it is not for longer than a wave takes. A piece that cannot push would be slack at an error of
/// its content of T/k, which is 1e-6 m on a wheel.
fn rope_piece(ea: f64, of: (f64, f64), arc: Option<&ArcParts>, content: f64) -> PieceState {
    const STEPS: usize = 12;
    let mut psi = 0.0;
    let mut slope = 0.0;
    for _ in 0..STEPS {
        let (here, by_psi) = content_at(ea, of, arc, psi);
        slope = by_psi;
        let step = (here - content) / by_psi;
        psi += step;
        if step.abs() <= 1e-13 * (psi.abs() + 1.0) {
            break;
        }
    }
    let stretch = stretch_of(psi, ea);
    let tension = tension_of(psi, stretch);
    let mut strain = 0.5 * tension * tension * ((of.0 - tension * of.1) / (stretch * ea) + of.1);
    for (length, lift) in arc.into_iter().flatten() {
        let stretch = stretch_of(psi + lift, ea);
        let tension = tension_of(psi + lift, stretch);
        strain += 0.5 * tension * tension / ea * length / stretch;
    }
    PieceState { psi, stiffness: 1.0 / slope, tension, strain }
}

/// Parts of the rope on a pulley for a load per unstrained length.
pub(super) fn arc_parts(contact: &PulleyContact, load_w: &Vec3) -> ArcParts {
    let mut parts = [(0.0, 0.0); 6];
    for (part, (angle, length)) in parts.iter_mut().zip(arc_nodes(&contact.wheel())) {
        *part = (length, -load_w.dot(&contact.offset_w(angle)));
    }
    parts
}

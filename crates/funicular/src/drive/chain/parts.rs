//! Parts from which the chain behind an exit point is built, and the order of its motions.

use super::{AT_WHEEL, Place};
use crate::drive::{AnchorEnd, DriveAtRest};
use crate::robot::{Anchor, Control, DrumSide, GuideWheel, Servo, Winch, WinchMode};
use std::ops::Range;

/// Polynomial degree of a drum side with mass per radian of an axial wave's phase, and its degrees besides. A wave
/// needs 0.5 degrees per radian; the rest is margin. The stiffness is then exact to 1e-10, which a test checks up to 50
/// radians; with 0.5 it is 4e-10 there.
const DEGREE_PER_RADIAN: f64 = 0.7;
const BASE_DEGREE: f64 = 8.0;

/// Parts from which a chain is built.
pub(super) struct Parts<'a> {
    pub(super) winch: Option<&'a Winch>,
    /// Control of the motor in the requested mode of winches.
    pub(super) control: Control,
    /// Mechanical stiffness of the winch at the cable [N/m]; infinite for a rigid one.
    pub(super) shaft: f64,
    /// EA [N] and mass per length [kg/m] of the cable.
    pub(super) axial_stiffness: f64,
    pub(super) mass_per_length: f64,
    /// Stretch at the exit point, and at the drum.
    pub(super) stretch: f64,
    pub(super) stretch_drum: f64,
    /// Compliance of each piece of arc and drum side [m/N], from the exit point on; the arc belongs to the first. Empty
    /// if the drum is at the exit point.
    pub(super) pieces: Vec<f64>,
    /// Masses of the guide wheels between the pieces [kg].
    pub(super) guides: Vec<f64>,
}

/// Compliance of each piece of arc and drum side between guide wheels with mass [m/N], and the masses of these wheels
/// [kg].
fn pieces(anchor: &Anchor, drive: &DriveAtRest, axial_stiffness: f64) -> (Vec<f64>, Vec<f64>) {
    let whole = drive.end.rope_compliance;
    if whole <= 0.0 {
        return (Vec::new(), Vec::new());
    }
    let all = anchor.winch.as_ref().map_or(&[][..], |winch| &winch.guide_wheels);
    let guides: Vec<&GuideWheel> = all.iter().filter(|wheel| wheel.mass > 0.0).collect();
    if guides.is_empty() {
        return (vec![whole], Vec::new());
    }

    // The drum side is uniform; the rest of the compliance is that of the arc.
    let straight = drive.drum_side_length / (axial_stiffness * drive.end.stretch_drum.powi(2));
    let length = anchor.drum_side_length();
    let ends: Vec<f64> = [0.0].into_iter().chain(guides.iter().map(|wheel| wheel.distance)).chain([length]).collect();
    let mut pieces: Vec<f64> = ends.windows(2).map(|ends| straight * (ends[1] - ends[0]) / length).collect();
    pieces[0] += whole - straight;
    (pieces, guides.iter().map(|wheel| wheel.mass).collect())
}

impl<'a> Parts<'a> {
    /// Parts behind an end; `None` if none of them moves.
    pub(super) fn of(
        anchor: &'a Anchor,
        drive: &DriveAtRest,
        (axial_stiffness, mass_per_length): (f64, f64),
        mode: WinchMode,
    ) -> Option<Self> {
        let winch = anchor.winch.as_ref();
        let control = match (mode, winch) {
            (WinchMode::Stuck, _) => return None,
            (WinchMode::Clamped, _) | (_, None) => Control::Ideal,
            (WinchMode::Torque, Some(_)) => Control::Torque,
            (WinchMode::AsGiven, Some(winch)) => winch.control,
        };

        let (pieces, guides) = pieces(anchor, drive, axial_stiffness);
        let AnchorEnd { stretch, stretch_drum, .. } = drive.end;
        let parts = Self {
            winch,
            control,
            shaft: winch.map_or(f64::INFINITY, |winch| winch.stiffness),
            axial_stiffness,
            mass_per_length,
            stretch,
            stretch_drum,
            pieces,
            guides,
        };

        (parts.has_rope() || parts.drum_moves()).then_some(parts)
    }

    /// True if there is cable between exit point and drum.
    pub(super) fn has_rope(&self) -> bool {
        !self.pieces.is_empty()
    }

    pub(super) fn motor_moves(&self) -> bool {
        self.control != Control::Ideal
    }

    pub(super) fn drum_moves(&self) -> bool {
        self.motor_moves() || self.shaft.is_finite()
    }

    pub(super) fn servo(&self) -> Option<Servo> {
        if let Control::Position(servo) = self.control { Some(servo) } else { None }
    }

    /// Stiffness of a piece of arc and drum side on σ [N/m]; all pieces in series have the stiffness k_r of equation
    /// (75).
    pub(super) fn spring(&self, piece: usize) -> f64 {
        1.0 / (self.stretch * self.stretch * self.pieces[piece])
    }

    /// Mass of a drum side that is a rod [kg]; zero for one without mass.
    pub(super) fn rod_mass(&self) -> f64 {
        let length: f64 = (0..self.pieces.len()).map(|piece| self.rod_length(piece)).sum();
        if self.is_rod() { self.mass_per_length * length } else { 0.0 }
    }

    /// Length of the uniform rod with the stiffness of a piece [m].
    pub(super) fn rod_length(&self, piece: usize) -> f64 {
        self.axial_stiffness / self.spring(piece)
    }

    /// True if the mass of the cable between exit point and drum counts.
    pub(super) fn is_rod(&self) -> bool {
        let wanted = self.winch.is_some_and(|winch| winch.drum_side == DrumSide::Rod);
        wanted && self.has_rope() && self.mass_per_length > 0.0
    }
}

/// Order of the motions: σ, guide wheels, waves of the drum side, drum, motor.
pub(super) struct MotionOrder {
    pub(super) count: usize,
    /// Guide wheels, as motions of the cable there.
    pub(super) guides: Vec<Place>,
    /// Ends of the pieces of the drum side from σ to the drum, as parts of their elongation: the motion of the cable
    /// there without the factor of the stretch. `None` for a drum that is held; empty if the drum is at the exit point.
    pub(super) nodes: Vec<Option<Place>>,
    /// Motions that are waves of each piece of the drum side.
    pub(super) waves: Vec<Range<usize>>,
    /// Places of drum and motor, if they move. A drum at the exit point moves with σ, a rigid shaft with its motor.
    pub(super) drum: Option<Place>,
    pub(super) motor: Option<Place>,
}

impl MotionOrder {
    pub(super) fn of(parts: &Parts, limit: f64) -> Self {
        let motion = |motion: usize| Place { motion, factor: 1.0 };
        let guides: Vec<Place> = (1..=parts.guides.len()).map(motion).collect();
        let mut count = 1 + guides.len();

        let slowness = (parts.mass_per_length / parts.axial_stiffness).sqrt();
        let of_piece = |piece: usize| {
            let first = count;
            if parts.is_rod() {
                let phase = limit * slowness * parts.rod_length(piece);
                count += (DEGREE_PER_RADIAN * phase + BASE_DEGREE).ceil() as usize - 1;
            }
            first..count
        };
        let waves: Vec<Range<usize>> = (0..parts.pieces.len()).map(of_piece).collect();

        let ratio = parts.stretch / parts.stretch_drum;
        let mut another = || {
            count += 1;
            motion(count - 1)
        };
        let drum = parts.drum_moves().then(|| if parts.has_rope() { another() } else { AT_WHEEL.times(1.0 / ratio) });
        let motor = match drum {
            Some(drum) if parts.motor_moves() => Some(if parts.shaft.is_finite() { another() } else { drum }),
            _ => None,
        };

        let mut nodes = Vec::new();
        if parts.has_rope() {
            nodes.push(Some(AT_WHEEL));
            nodes.extend(guides.iter().map(|guide| Some(guide.times(ratio))));
            nodes.push(drum.map(|drum| drum.times(ratio)));
        }
        Self { count, guides, nodes, waves, drum, motor }
    }

    /// Place of a function of a piece of the drum side: its end towards the exit point, that towards the drum, then its
    /// waves.
    pub(super) fn place(&self, piece: usize, function: usize) -> Option<Place> {
        match function {
            0 | 1 => self.nodes[piece + function],
            wave => Some(Place { motion: self.waves[piece].start + wave - 2, factor: 1.0 }),
        }
    }
}

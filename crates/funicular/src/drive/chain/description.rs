//! Parts of a chain with their places, for derivatives of its energy by their numbers.

use super::parts::{MotionOrder, Parts};
use super::{AT_WHEEL, Place};
use crate::drive::DriveAtRest;
use crate::math::{DMat, legendre};
use crate::robot::{Anchor, WinchMode};
use std::ops::Range;

/// Parts of a chain with their places among its motions.
#[derive(Debug, Clone)]
pub(crate) struct ChainDescription {
    /// Pieces of arc and drum side from the exit point to the drum; empty if the drum is at the exit point.
    pub(crate) pieces: Vec<Piece>,
    /// Place of each guide wheel with mass, and its index in the winch.
    pub(crate) guides: Vec<(Place, usize)>,
    /// Places of drum and motor, if they move.
    pub(crate) drum: Option<Place>,
    pub(crate) motor: Option<Place>,
    /// True if a control holds the position of the motor.
    pub(crate) is_controlled: bool,
    /// Stiffness between drum and motor, or drum and frame [N/m]; infinite for a rigid winch.
    pub(crate) shaft: f64,
    /// Ratio λ/λ_E of the stretch at the exit point to that at the drum.
    pub(crate) ratio: f64,
}

/// Piece of arc and drum side between two places.
#[derive(Debug, Clone)]
pub(crate) struct Piece {
    /// Stiffness on σ [N/m], and compliance [m/N].
    pub(crate) spring: f64,
    pub(crate) compliance: f64,
    /// Ends towards the exit point and towards the drum; `None` for a drum that is held.
    pub(crate) ends: [Option<Place>; 2],
    /// True for an end whose place contains the ratio of the stretches.
    pub(crate) by_ratio: [bool; 2],
    /// Motions that are its waves.
    pub(crate) waves: Range<usize>,
    /// Mass integrals of its functions over [−1, 1]: both ends, then the waves; `None` without mass.
    pub(crate) mass: Option<DMat>,
}

impl ChainDescription {
    /// Parts of the chain of [`DriveChain::of`](super::DriveChain::of); `None` if the cable cannot move at its exit
    /// point.
    pub(crate) fn of(
        anchor: &Anchor,
        drive: &DriveAtRest,
        rope: (f64, f64),
        mode: WinchMode,
        limit: f64,
    ) -> Option<Self> {
        let parts = Parts::of(anchor, drive, rope, mode)?;
        let layout = MotionOrder::of(&parts, limit);
        let pieces = (layout.nodes.windows(2).enumerate())
            .map(|(piece, ends)| Piece {
                spring: parts.spring(piece),
                compliance: parts.pieces[piece],
                ends: [ends[0], ends[1]],
                by_ratio: [piece > 0, true],
                waves: layout.waves[piece].clone(),
                mass: parts.is_rod().then(|| legendre::element_mass(layout.waves[piece].len() + 1)),
            })
            .collect();

        let wheels = anchor.winch.as_ref().map_or(&[][..], |winch| &winch.guide_wheels);
        let heavy = wheels.iter().enumerate().filter(|(_, wheel)| wheel.mass > 0.0).map(|(index, _)| index);
        Some(Self {
            pieces,
            guides: layout.guides.iter().copied().zip(heavy).collect(),
            drum: layout.drum,
            motor: layout.motor,
            is_controlled: parts.servo().is_some(),
            shaft: parts.shaft,
            ratio: parts.stretch / parts.stretch_drum,
        })
    }
}

impl Place {
    /// True for a drum or motor at the exit point, whose place contains the ratio of the stretches.
    pub(crate) fn is_at_exit(self) -> bool {
        self.motion == AT_WHEEL.motion
    }
}

//! End of a cable that can move: along the cable, as on a pulley with a drive behind it, and out of plane, as on a pulley
//! that swivels.
//!
//! The motions of the drive are inner unknowns of the cable, so that its clamped modes contain them, and the count of
//! natural frequencies with them (docs/theory.md, section 18).

use super::CatenaryDynamicError;
use crate::catenary::space::HangingCable;
use crate::drive::{AnchorEnd, DriveChain};
use crate::math::DMat;

/// End of a cable that can move.
#[derive(Debug, Clone, PartialEq)]
pub struct MovingEnd {
    /// Motion in plane; `None` if the end is held there.
    pub along: Option<EndAlong>,
    /// Stiffness [N/m] and mass [kg] against motion out of plane; `None` if the end is held there.
    pub out_of_plane: Option<(f64, f64)>,
}

/// Motion of an end along the cable, with the drive behind it.
#[derive(Debug, Clone, PartialEq)]
pub struct EndAlong {
    /// Direction towards the platform: its components (horizontal, up).
    pub direction: [f64; 2],
    /// Drive; its first motion is that of the end.
    pub chain: DriveChain,
}

/// Maximum component out of plane of the direction in which an end moves along the cable, and maximum coupling between
/// its motions over their stiffness: rounding is 1e-15, and the frequencies change by the square of both.
const IN_PLANE: f64 = 1e-8;

impl MovingEnd {
    /// Motion of the end of a hanging cable at its pulley and winch; `None` if it is held. `chain` is the drive behind
    /// it, and `swivel_mass` the mass that the swivel adds to the motion out of plane [kg].
    ///
    /// # Errors
    /// [`CatenaryDynamicError::Skew`]: the end moves in and out of plane at the same time.
    pub(crate) fn of(
        hanging: &HangingCable,
        end: &AnchorEnd,
        chain: Option<DriveChain>,
        swivel_mass: f64,
    ) -> Result<Option<Self>, CatenaryDynamicError> {
        if chain.is_none() && end.sideways_w.is_none() {
            return Ok(None);
        }
        let (horizontal_w, up_w) = hanging.axes_w();
        let out_w = horizontal_w.cross(&up_w);

        // The motions have to be in plane and out of plane.
        let [[stiffness, coupling], [_, sideways]] = end.stiffness;
        let skew = end.sideways_w.map_or(0.0, |sideways_w| {
            let turned = (sideways_w - out_w * out_w.dot(&sideways_w)).norm();
            turned.max(coupling.abs() / (stiffness * sideways).abs().sqrt())
        });
        if skew.max(out_w.dot(&end.travel_w).abs()) > IN_PLANE {
            return Err(CatenaryDynamicError::Skew);
        }

        let direction = [horizontal_w.dot(&end.travel_w), up_w.dot(&end.travel_w)];
        let along = chain.map(|chain| EndAlong { direction, chain });
        Ok(Some(Self { along, out_of_plane: end.sideways_w.map(|_| (sideways, swivel_mass)) }))
    }

    /// Drive behind the motion along the cable, if there is one.
    pub(crate) fn chain(&self) -> Option<&DriveChain> {
        self.along.as_ref().map(|along| &along.chain)
    }

    /// Mass against motion out of plane [kg]; zero if the end is held there.
    pub(crate) fn swivel_mass(&self) -> f64 {
        self.out_of_plane.map_or(0.0, |(_, mass)| mass)
    }

    /// True if wheel, swivel, drum or motor has mass.
    pub(crate) fn has_mass(&self) -> bool {
        self.swivel_mass() > 0.0 || self.chain().is_some_and(|chain| chain.mass.amax() > 0.0)
    }

    /// Static stiffness of the start in plane and out of plane, from those with the end held, and the static response of
    /// the motions at the end to forces on them. The stiffness of an end that moves is zero.
    pub(super) fn still(&self, [[hh, hv], [_, vv]]: [[f64; 2]; 2], o: f64) -> Result<Still, CatenaryDynamicError> {
        let mut in_plane = [[hh, hv, -hh, -hv], [hv, vv, -hv, -vv], [-hh, -hv, hh, hv], [-hv, -vv, hv, vv]];
        let mut flexibility = DMat::zeros(0, 0);
        if let Some(EndAlong { direction: [h, v], chain }) = &self.along {
            let pulled = [hh * h + hv * v, hv * h + vv * v];
            flexibility = chain.flexibility(h * pulled[0] + v * pulled[1]).ok_or(CatenaryDynamicError::RunsOut)?;
            let left = |held: f64, i: usize, j: usize| held - pulled[i] * pulled[j] * flexibility[(0, 0)];
            in_plane = [[0.0; 4]; 4];
            (in_plane[0][0], in_plane[1][1]) = (left(hh, 0, 0), left(vv, 1, 1));
            (in_plane[0][1], in_plane[1][0]) = (left(hv, 0, 1), left(hv, 0, 1));
        }
        let (out_of_plane, flexibility_out_of_plane) = match self.out_of_plane {
            Some((sideways, _)) => ([[o - o * o / (o + sideways), 0.0], [0.0, 0.0]], 1.0 / (o + sideways)),
            None => ([[o, -o], [-o, o]], 0.0),
        };
        Ok(Still { in_plane, out_of_plane, flexibility, flexibility_out_of_plane })
    }
}

/// Static stiffness of a cable whose end may move, and flexibility of that end.
pub(super) struct Still {
    pub(super) in_plane: [[f64; 4]; 4],
    pub(super) out_of_plane: [[f64; 2]; 2],
    pub(super) flexibility: DMat,
    pub(super) flexibility_out_of_plane: f64,
}

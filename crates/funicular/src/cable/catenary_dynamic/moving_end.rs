//! End of a cable that can move: along the cable, as on a pulley with a drive behind it, and sideways, as on a pulley
//! that swivels.
//!
//! The motions of the drive are inner unknowns of the cable, so that its clamped modes contain them, and the count of
//! natural frequencies with them (docs/theory.md, section 18). An end that moves along the cable in its plane, and
//! sideways normal to it, keeps the motions in plane and out of plane apart. On a pulley with an inclined swivel axis,
//! or in wind, it couples them.

use super::CatenaryDynamicError;
use super::partition::Guide;
use crate::cable::LocalAxes;
use crate::drive::{AnchorEnd, DriveChain};
use crate::math::{DMat, Mat3, Vec3};

/// End of a cable that can move. Directions are unit vectors in the axes (e, n, b) of the cable's model: for a hanging
/// cable horizontal, up and out of plane.
#[derive(Debug, Clone, PartialEq)]
pub struct MovingEnd {
    /// Motion along the cable; `None` if the end is held there.
    pub along: Option<EndAlong>,
    /// Motion with the swivelling wheel; `None` if the end is held there.
    pub sideways: Option<EndSideways>,
}

/// Motion of an end along the cable, with the drive behind it.
#[derive(Debug, Clone, PartialEq)]
pub struct EndAlong {
    /// Direction towards the platform.
    pub direction: [f64; 3],
    /// Drive; its first motion is that of the end.
    pub chain: DriveChain,
}

/// Motion of an end with the swivelling wheel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EndSideways {
    /// Direction normal to the wheel.
    pub direction: [f64; 3],
    /// Stiffness [N/m].
    pub stiffness: f64,
    /// Stiffness between this motion and that along the cable [N/m].
    pub coupling: f64,
    /// Mass of the swivel at the exit point [kg].
    pub mass: f64,
}

/// Maximum component out of plane of the direction in which an end moves along the cable, and maximum coupling between
/// its motions over their stiffness, for an end that keeps the families apart: rounding is 1e-15, and the frequencies
/// change by the square of both.
const IN_PLANE: f64 = 1e-8;

impl MovingEnd {
    /// Motion of the end of a cable at its pulley and winch, in the axes of its model; `None` if it is held. `chain` is
    /// the drive behind it, and `swivel_mass` the mass that the swivel adds to the motion sideways [kg].
    pub(crate) fn of(axes: &LocalAxes, end: &AnchorEnd, chain: Option<DriveChain>, swivel_mass: f64) -> Option<Self> {
        if chain.is_none() && end.sideways_w.is_none() {
            return None;
        }
        let LocalAxes { e, n, b } = axes;
        let local = |direction_w: &Vec3| [e, n, b].map(|axis| axis.dot(direction_w));

        let [[_, coupling], [_, stiffness]] = end.stiffness;
        let sideways = end.sideways_w.as_ref().map(|direction_w| EndSideways {
            direction: local(direction_w),
            stiffness,
            coupling,
            mass: swivel_mass,
        });
        Some(Self { along: chain.map(|chain| EndAlong { direction: local(&end.travel_w), chain }), sideways })
    }

    /// True if the end couples the motions of the cable in plane and out of plane.
    pub(crate) fn couples(&self) -> bool {
        let along = self.along.as_ref().map_or(0.0, |along| along.direction[2].abs());
        let sideways = self.sideways.as_ref().map_or(0.0, |sideways| {
            let turned = sideways.direction[0].hypot(sideways.direction[1]);
            let stiffness = self.chain().map_or(0.0, |chain| chain.stiffness[(0, 0)]);
            let coupled =
                if stiffness == 0.0 { 0.0 } else { sideways.coupling / (stiffness * sideways.stiffness).abs().sqrt() };
            turned.max(coupled.abs())
        });
        along.max(sideways) > IN_PLANE
    }

    /// Drive behind the motion along the cable, if there is one.
    pub(crate) fn chain(&self) -> Option<&DriveChain> {
        self.along.as_ref().map(|along| &along.chain)
    }

    /// Mass against motion sideways [kg]; zero if the end is held there.
    pub(crate) fn swivel_mass(&self) -> f64 {
        self.sideways.map_or(0.0, |sideways| sideways.mass)
    }

    /// True if wheel, swivel, drum or motor has mass.
    pub(crate) fn has_mass(&self) -> bool {
        self.swivel_mass() > 0.0 || self.chain().is_some_and(|chain| chain.mass.amax() > 0.0)
    }

    /// True if its motions are not those of springs: without mass of the cable it still vibrates, or has losses.
    pub(crate) fn has_dynamics(&self) -> bool {
        self.swivel_mass() > 0.0 || self.chain().is_some_and(DriveChain::has_dynamics)
    }

    /// Number of motions along the cable, and of all.
    pub(crate) fn counts(&self) -> (usize, usize) {
        let along = self.chain().map_or(0, DriveChain::len);
        (along, along + usize::from(self.sideways.is_some()))
    }

    /// Motions in the plane of the cable, for an end that keeps the families apart.
    pub(super) fn guide_in_plane(&self) -> Option<Guide<2>> {
        self.along.as_ref().map(|EndAlong { direction: [h, v, _], chain }| Guide {
            directions: vec![(0, [*h, *v])],
            stiffness: chain.stiffness.clone(),
            mass: &chain.mass + &chain.cable_mass,
        })
    }

    /// Motion out of plane, for an end that keeps the families apart.
    pub(super) fn guide_out_of_plane(&self) -> Option<Guide<1>> {
        self.sideways.map(|sideways| Guide {
            directions: vec![(0, [1.0])],
            stiffness: DMat::from_element(1, 1, sideways.stiffness),
            mass: DMat::from_element(1, 1, sideways.mass),
        })
    }

    /// All motions: those of the drive, then that sideways.
    pub(super) fn guide(&self) -> Guide<3> {
        let (along, count) = self.counts();
        let (mut stiffness, mut mass) = (DMat::zeros(count, count), DMat::zeros(count, count));
        let mut directions = Vec::new();
        if let Some(EndAlong { direction, chain }) = &self.along {
            stiffness.view_mut((0, 0), (along, along)).copy_from(&chain.stiffness);
            mass.view_mut((0, 0), (along, along)).copy_from(&(&chain.mass + &chain.cable_mass));
            directions.push((0, *direction));
        }
        if let Some(sideways) = &self.sideways {
            stiffness[(along, along)] = sideways.stiffness;
            mass[(along, along)] = sideways.mass;
            directions.push((along, sideways.direction));
            if along > 0 {
                (stiffness[(0, along)], stiffness[(along, 0)]) = (sideways.coupling, sideways.coupling);
            }
        }
        Guide { directions, stiffness, mass }
    }

    /// Static stiffness of both ends in plane and out of plane, from those of the start with the end held, and the
    /// static response of all motions at the end to forces on them.
    pub(super) fn static_stiffness(
        &self,
        held: [[f64; 2]; 2],
        held_out_of_plane: f64,
    ) -> Result<StaticEnds, CatenaryDynamicError> {
        let ([[mut hh, mut hv], [_, mut vv]], mut o) = (held, held_out_of_plane);
        let (along, count) = self.counts();
        let mut flexibility = DMat::zeros(count, count);
        if let Some(EndAlong { direction: [h, v, _], chain }) = &self.along {
            let pulled = [hh * h + hv * v, hv * h + vv * v];
            let of_chain = chain.flexibility(h * pulled[0] + v * pulled[1]).ok_or(CatenaryDynamicError::RunsOut)?;
            let left = |held: f64, i: usize, j: usize| held - pulled[i] * pulled[j] * of_chain[(0, 0)];
            (hh, hv, vv) = (left(hh, 0, 0), left(hv, 0, 1), left(vv, 1, 1));
            flexibility.view_mut((0, 0), (along, along)).copy_from(&of_chain);
        }
        if let Some(EndSideways { stiffness, .. }) = &self.sideways {
            flexibility[(along, along)] = 1.0 / (o + stiffness);
            o -= o * o / (o + stiffness);
        }
        let in_plane = [[hh, hv, -hh, -hv], [hv, vv, -hv, -vv], [-hh, -hv, hh, hv], [-hv, -vv, hv, vv]];
        Ok(StaticEnds { in_plane, out_of_plane: [[o, -o], [-o, o]], flexibility })
    }

    /// Static stiffness of both ends for an end that couples the families, and the static response of all motions at
    /// the end to forces on them.
    ///
    /// # References
    /// docs/theory.md, equation (70): the motions of the end are in series with the cable.
    pub(super) fn static_stiffness_coupled(
        &self,
        [[hh, hv], [_, vv]]: [[f64; 2]; 2],
        o: f64,
    ) -> Result<([[f64; 6]; 6], DMat), CatenaryDynamicError> {
        let held = Mat3::new(hh, hv, 0.0, hv, vv, 0.0, 0.0, 0.0, o);
        let Guide { directions, mut stiffness, .. } = self.guide();
        let pulled: Vec<(usize, Vec3, Vec3)> = (directions.iter())
            .map(|(motion, direction)| (*motion, Vec3::from(*direction), held * Vec3::from(*direction)))
            .collect();

        for (i, direction, _) in &pulled {
            for (j, _, force) in &pulled {
                stiffness[(*i, *j)] += direction.dot(force);
            }
        }
        let flexibility = stiffness.cholesky().ok_or(CatenaryDynamicError::RunsOut)?.inverse();

        let mut left = held;
        for (i, _, a) in &pulled {
            for (j, _, b) in &pulled {
                left -= a * b.transpose() * flexibility[(*i, *j)];
            }
        }
        let mut ends = [[0.0; 6]; 6];
        for (i, row) in ends.iter_mut().enumerate() {
            for (j, entry) in row.iter_mut().enumerate() {
                *entry = if (i < 3) == (j < 3) { left[(i % 3, j % 3)] } else { -left[(i % 3, j % 3)] };
            }
        }
        Ok((ends, flexibility))
    }
}

/// Static stiffness of both ends of a cable, and flexibility of the motions at its end.
pub(super) struct StaticEnds {
    pub(super) in_plane: [[f64; 4]; 4],
    pub(super) out_of_plane: [[f64; 2]; 2],
    pub(super) flexibility: DMat,
}

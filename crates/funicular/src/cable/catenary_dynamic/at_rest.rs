//! Cables of models without inertia whose stretch has a loss: no poles, but the motions in which they stretch.
//!
//! Their stiffness is static apart from the loss, so that counts and undamped modes are those of the stiffness without
//! it (docs/theory.md, equations (27e) and (27f)).

use super::stretch::StrainMoments;
use super::{
    CatenaryDynamic, CatenaryDynamicEnd, CatenaryDynamicError, Derived, Displacements, DriveMotion, EndDirections,
    MovingEnd, PoleResidue,
};
use crate::cable::{LocalAxes, LocalStiffness};
use crate::catenary::Catenary;
use crate::drive::{AnchorEnd, DriveChain};
use crate::math::DMat;
use crate::robot::{Damping, StretchLoss};

/// Span of a cable in a model without inertia.
pub(crate) struct SpanAtRest {
    /// Axes of its stiffness.
    axes: LocalAxes,
    /// Stiffness of the platform end with the far end held [N/m].
    held: LocalStiffness<f64>,
    strain: StrainMoments,
}

impl SpanAtRest {
    /// Span that stretches along its chord alone, as a spring does or a cable of shallow sag, with the stiffness of the
    /// rope [N/m].
    pub(crate) fn along_chord(axes: LocalAxes, held: LocalStiffness<f64>, rope: f64) -> Self {
        let strain = StrainMoments { by_force: vec![[1.0 / rope, 0.0]], stiffness: vec![rope] };
        Self { axes, held, strain }
    }

    /// Hanging span. Under a constant change N of the tension vector its strain has the energy `Nᵀ F N/2`, `F = ∫ t tᵀ
    /// ds/EA`; so it has two moments, whose rows are those of the square root of F.
    pub(crate) fn hanging(axes: LocalAxes, catenary: &Catenary) -> Self {
        let [[axial, coupling], [_, normal]] = catenary.tangent();
        let out_of_plane = catenary.out_of_plane_stiffness();
        let held = LocalStiffness { axial, coupling, normal, out_of_plane, across: [0.0; 2] };

        // Square root of a symmetric 2×2 matrix by its trace and its determinant, in units of the length.
        let rope = catenary.rope();
        let [[a, b], [_, c]] = catenary.direction_integrals().map(|row| row.map(|of| of / rope.unstrained_length));
        let root = (a * c - b * b).max(0.0).sqrt();
        let stiffness = rope.axial_stiffness / rope.unstrained_length;
        let scale = stiffness * (a + c + 2.0 * root).sqrt();
        let by_force = vec![[(a + root) / scale, b / scale], [b / scale, (c + root) / scale]];
        Self { axes, held, strain: StrainMoments { by_force, stiffness: vec![stiffness; 2] } }
    }
}

impl CatenaryDynamicEnd {
    /// Cable whose model has no inertia, with its end at a pulley or winch at rest and the loss of its stretch.
    ///
    /// # Errors
    /// [`CatenaryDynamicError::RunsOut`]: nothing holds that end.
    pub(crate) fn at_rest(
        span: SpanAtRest,
        end: Option<&AnchorEnd>,
        stretch_loss: StretchLoss,
        in_plane_only: bool,
    ) -> Result<Self, CatenaryDynamicError> {
        let SpanAtRest { axes, held, strain } = span;
        let in_plane = [[held.axial, held.coupling], [held.coupling, held.normal]];
        let end = end.and_then(|end| MovingEnd::of(&axes, end, DriveChain::at_rest(end), 0.0));
        let (mut stiffness, of_end) = match &end {
            Some(end) => end.static_stiffness_coupled(in_plane, held.out_of_plane)?,
            None => (both_ends(in_plane, held.out_of_plane), DMat::zeros(0, 0)),
        };

        // Slow motions: a motion of the far end is one of the platform end in the other direction.
        let by_start = strain.by_start(&of_end, end.as_ref(), (in_plane, held.out_of_plane));
        let mut still: Vec<[[f64; 6]; 3]> =
            (by_start.into_iter()).map(|[h, v, b]| [[h, v, b, -h, -v, -b], [0.0; 6], [0.0; 6]]).collect();
        if in_plane_only {
            for (i, j) in [(2, 2), (2, 5), (5, 2), (5, 5)] {
                stiffness[i][j] = 0.0;
            }
            for [row, ..] in &mut still {
                [row[2], row[5]] = [0.0; 2];
            }
        }

        let drive = DriveMotion {
            along: Displacements::none(),
            sideways: Displacements::none(),
            coupled: Displacements { still, modes: Vec::new() },
            flexibility: strain.flexibility(of_end, end.as_ref(), in_plane),
        };
        let cable = CatenaryDynamic {
            in_plane: PoleResidue::none(),
            out_of_plane: PoleResidue::none(),
            coupled: Some(Box::new(PoleResidue::new(stiffness, [[0.0; 6]; 6], Vec::new(), Vec::new()))),
            limit: f64::INFINITY,
            error: 0.0,
            degrees: Vec::new(),
            stretch: strain.motions(end.as_ref()),
            end,
            drive: Some(drive),
        };
        Ok(Self {
            cable,
            axes,
            damping: Damping::Ratio(0.0),
            stretch_loss,
            mass_per_length: 0.0,
            in_plane_only,
            kept: None,
            directions: EndDirections::along_chord(),
            shapes: None,
            is_at_rest: true,
            lossy: Derived::default(),
        })
    }
}

/// Stiffness of both ends of a span, in the axes (horizontal, up, out of plane) of the start and of the end.
fn both_ends([[hh, hv], [_, vv]]: [[f64; 2]; 2], o: f64) -> [[f64; 6]; 6] {
    let held = [[hh, hv, 0.0], [hv, vv, 0.0], [0.0, 0.0, o]];
    std::array::from_fn(|i| {
        std::array::from_fn(|j| if (i < 3) == (j < 3) { held[i % 3][j % 3] } else { -held[i % 3][j % 3] })
    })
}

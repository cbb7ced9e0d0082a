//! Cable at an equilibrium, with all that the stiffness of its end is asked for.

use super::catenary_dynamic::{CatenaryDynamicEnd, MovingEnd, Shapes, SpanAtRest};
use super::{EndStiffness, LocalAxes, LocalStiffness, NoStiffness, Sag, moving_end};
use crate::catenary::space::HangingCable;
use crate::math::Mat3;
use crate::robot::{Material, Robot, WinchMode};
use crate::statics::CableState;

/// Cable of a robot whose end stiffness is wanted.
pub(crate) struct CableSituation<'a> {
    pub(super) robot: &'a Robot,
    /// Index of the cable.
    pub(super) i: usize,
    pub(super) state: &'a CableState,
    /// Axes of its chord.
    pub(super) axes: LocalAxes,
    /// Leave out all stiffness out of the cable's plane.
    pub(super) in_plane_only: bool,
    pub(super) winches: WinchMode,
    /// Highest angular frequency for which the stiffness has to be valid [rad/s].
    pub(super) limit: f64,
    pub(super) shapes: Shapes,
}

impl<'a> CableSituation<'a> {
    pub(super) fn sag(&self) -> Sag {
        Sag::of(self.robot, self.i, self.state)
    }

    pub(super) fn material(&self) -> &'a Material {
        &self.robot.cables[self.i].material
    }

    /// True for a rope that has motions beside its stiffness: its stretch has a loss, or its strains are wanted.
    pub(super) fn has_strains(&self) -> bool {
        self.shapes.has_strains(self.material().stretch_loss)
    }

    /// Curve of the cable.
    ///
    /// # Errors
    /// [`NoStiffness::Rigid`] for an ideal cable.
    pub(super) fn hanging(&self) -> Result<&'a HangingCable, NoStiffness> {
        self.state.hanging.as_ref().ok_or(NoStiffness::Rigid)
    }

    /// End at the pulley or winch in the axes of a model; `None` for one that is held.
    pub(super) fn moving_end(&self, axes: &LocalAxes) -> Option<MovingEnd> {
        moving_end(self.robot, self.i, self.state, axes, self.winches, self.limit)
    }

    /// Constant stiffness of a span that is held at its far end, in series with its pulley and winch.
    pub(super) fn in_series(&self, held: Mat3) -> EndStiffness {
        let drive = self.state.drive.as_deref();
        EndStiffness::Constant(drive.map_or(held, |drive| drive.end.in_series_with(&held)))
    }

    /// Stiffness without what acts out of the plane, if that is left out.
    pub(super) fn in_plane(&self, end: EndStiffness) -> EndStiffness {
        match end {
            EndStiffness::Constant(k) if self.in_plane_only => {
                let b = self.axes.b;
                EndStiffness::Constant(k - b * b.transpose() * b.dot(&(k * b)))
            }
            other => other,
        }
    }

    /// Straight span without mass. If it has strains, their stiffness is `axial`.
    pub(super) fn along_chord(&self, held: LocalStiffness<f64>, axial: f64) -> Result<EndStiffness, NoStiffness> {
        if self.has_strains() {
            return self.at_rest(SpanAtRest::along_chord(self.axes, held, axial));
        }
        Ok(self.in_series(held.in_world(&self.axes)))
    }

    /// Span without vibration, with the motions of its strains.
    pub(super) fn at_rest(&self, span: SpanAtRest) -> Result<EndStiffness, NoStiffness> {
        let drive = self.state.drive.as_deref().map(|drive| &drive.end);
        let end = CatenaryDynamicEnd::at_rest(span, drive, self.material().stretch_loss, self.in_plane_only)?;
        Ok(EndStiffness::by_poles(end))
    }
}

//! Families of clamped modes of a discretised cable: motions in plane and out of plane, or both together.

use super::mesh::{ElementTable, Mesh};
use super::moving_end::{MovingEnd, StaticEnds};
use super::partition::Condensed;
use super::stretch::StretchMotions;
use super::{CatenaryDynamic, CatenaryDynamicError, Displacements, DriveMotion, Stations};
use crate::catenary::Catenary;
use crate::math::DMat;

/// Poles and residues of the families of a discretised cable, with the displacements of its stations and of the motions
/// at its end.
pub(super) struct Families {
    pub(super) in_plane: Condensed<2, 4, 3>,
    pub(super) out_of_plane: Condensed<1, 2, 1>,
    pub(super) coupled: Option<Condensed<3, 6, 6>>,
    /// Static response of the motions at the end to forces on them.
    pub(super) flexibility: DMat,
    /// Estimated relative error of the clamped frequencies below the limit.
    pub(super) error: f64,
    /// Arc lengths of the stations.
    pub(super) arc_lengths: Vec<f64>,
    /// Motions in which the rope stretches, if it has loss.
    pub(super) stretch: StretchMotions,
}

/// Positions of the stations of a cable.
#[derive(Clone, Copy)]
pub(super) enum StationPositions<'a> {
    /// At these arc lengths from the start [m].
    ArcLengths(&'a [f64]),
    /// At the points of the Gauss rules of the elements.
    GaussPoints,
}

impl StationPositions<'_> {
    fn arc_lengths(self, mesh: &Mesh, tables: &[ElementTable]) -> Vec<f64> {
        match self {
            Self::ArcLengths(arc_lengths) => arc_lengths.to_vec(),
            Self::GaussPoints => mesh.points(tables),
        }
    }
}

impl Families {
    /// Motions in plane and out of plane for themselves.
    pub(super) fn apart(
        catenary: &Catenary,
        mesh: &Mesh,
        end: Option<&MovingEnd>,
        limit: f64,
        positions: StationPositions,
        moments: usize,
    ) -> Result<Self, CatenaryDynamicError> {
        let held = MovingEnd { along: None, sideways: None };
        let end = end.unwrap_or(&held);
        let StaticEnds { in_plane, out_of_plane, flexibility } =
            end.static_stiffness(catenary.tangent(), catenary.out_of_plane_stiffness())?;

        let tables = mesh.tables();
        let arc_lengths = positions.arc_lengths(mesh, &tables);
        let strain = mesh.moments(&tables, moments);
        let in_plane = mesh.condense(&tables, in_plane, end.guide_in_plane().as_ref(), limit, &arc_lengths, moments)?;
        let out_of_plane =
            mesh.condense(&tables, out_of_plane, end.guide_out_of_plane().as_ref(), limit, &arc_lengths, 0)?;
        let error = in_plane.error.max(out_of_plane.error);
        let flexibility = strain.flexibility(flexibility, Some(end), catenary.tangent());
        let stretch = strain.motions(Some(end));
        Ok(Self { in_plane, out_of_plane, coupled: None, flexibility, error, arc_lengths, stretch })
    }

    /// Motions in plane and out of plane, which the end couples.
    pub(super) fn together(
        catenary: &Catenary,
        mesh: &Mesh,
        end: &MovingEnd,
        limit: f64,
        positions: StationPositions,
        moments: usize,
    ) -> Result<Self, CatenaryDynamicError> {
        let (ends, flexibility) =
            end.static_stiffness_coupled(catenary.tangent(), catenary.out_of_plane_stiffness())?;
        let tables = mesh.tables();
        let arc_lengths = positions.arc_lengths(mesh, &tables);
        let strain = mesh.moments(&tables, moments);
        let coupled = mesh.condense(&tables, ends, Some(&end.guide()), limit, &arc_lengths, moments)?;
        let error = coupled.error;
        let flexibility = strain.flexibility(flexibility, Some(end), catenary.tangent());
        Ok(Self {
            in_plane: Condensed::none(),
            out_of_plane: Condensed::none(),
            coupled: Some(coupled),
            flexibility,
            error,
            arc_lengths,
            stretch: strain.motions(Some(end)),
        })
    }

    /// Cable, and its stations; the moments of the strain and the motions at its end, which follow the stations, belong
    /// to the cable.
    pub(super) fn split(
        mut self,
        end: Option<MovingEnd>,
        limit: f64,
        degrees: Vec<usize>,
    ) -> (CatenaryDynamic, Stations) {
        let arc_lengths = self.arc_lengths;
        let first = arc_lengths.len();
        let mut coupled_stations = Displacements::none();
        let mut drive = DriveMotion {
            along: Displacements::none(),
            sideways: Displacements::none(),
            coupled: Displacements::none(),
            flexibility: self.flexibility,
        };
        let coupled = self.coupled.map(|mut coupled| {
            drive.coupled = coupled.stations.split_off(first);
            coupled_stations = coupled.stations;
            Box::new(coupled.ends)
        });
        if coupled.is_none() {
            drive.along = self.in_plane.stations.split_off(first);
            drive.sideways = self.out_of_plane.stations.split_off(first);
        }
        let stretch = self.stretch;
        match &coupled {
            Some(_) => stretch.put_in_order(&mut drive.coupled, end.as_ref()),
            None => stretch.put_in_order(&mut drive.along, end.as_ref()),
        }

        let drive = (end.is_some() || stretch.moments > 0).then_some(drive);
        let (in_plane, out_of_plane) = (self.in_plane.stations, self.out_of_plane.stations);
        let stations = Stations { arc_lengths, in_plane, out_of_plane, coupled: coupled_stations };
        let (in_plane, out_of_plane) = (self.in_plane.ends, self.out_of_plane.ends);
        let error = self.error;
        (CatenaryDynamic { in_plane, out_of_plane, coupled, limit, error, degrees, end, drive, stretch }, stations)
    }
}

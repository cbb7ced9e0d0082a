//! One cable in gusts: its matrices with aerodynamic damping, and the loads of the gusts on its cells.

use super::field::{GustPlace, TurbulentField};
use super::{GustError, Setting};
use crate::cable::EndStiffness;
use crate::cable_motion::CableStations;
use crate::dynamics::{CableBlocks, Dynamics};
use crate::math::{CDMat, Complex, DMat, DVec, Mat3, Vec3, Vec6, legendre};
use crate::reduced_model::{CoordinateLayout, Matrices};

/// Cells of a cable. With 16 the r.m.s. values of a robot over a stadium differ by up to 3e-4 from those with 48,
/// tensions by 8e-4.
pub(super) const CELLS: usize = 16;

/// Points of the Gauss rule in a cell: shapes with fewer than three half waves per cell are integrated to 1e-3.
const POINTS: usize = 3;

/// Part of the pull of a cable that may point out of the plane of a planar platform.
const OUT_OF_PLANE: f64 = 1e-9;

/// Cable in gusts. Its coordinates are those of the platform, the amplitudes of its clamped modes, and those of the
/// supports.
pub(super) struct GustyCable {
    /// Matrices of the cable alone, with the aerodynamic damping.
    pub(super) matrices: Matrices,
    /// Generalised forces per velocity of the air [N s/m]: per cell a column for the component along the wind, one for
    /// the lateral and one for that up.
    pub(super) loads: DMat,
    /// Cells of the cable; none if the wind does not act on it.
    pub(super) cells: Vec<GustPlace>,
    /// Motion of the platform by which the end moves along the cable, over its coordinates.
    pub(super) pull: Option<DVec>,
    /// True if its stiffness does not depend on frequency: the platform's matrices have it, too.
    pub(super) is_constant: bool,
    dof: usize,
    modes: usize,
}

/// Points of a cable on which the wind acts, cell by cell, and the drag there.
pub(super) struct Drag {
    /// Points of all cells.
    pub(super) stations: CableStations,
    /// Length of cable at each point of a cell [m].
    pub(super) lengths: [f64; POINTS],
    /// Force per length and velocity of the air, world axes [N s/m²].
    pub(super) by_velocity_w: Mat3,
}

impl Drag {
    /// Drag of cable `i`; `None` if the wind does not act on it.
    pub(super) fn of(setting: &Setting, i: usize) -> Result<Option<Self>, GustError> {
        let Setting { robot, equilibrium, dynamics } = *setting;
        let state = &equilibrium.cables[i];
        let width = robot.cables[i].material.drag_width.unwrap_or(0.0);
        let Some(axis_w) = state.chord_w().try_normalize(0.0).filter(|_| width > 0.0) else { return Ok(None) };

        let rule = legendre::gauss(POINTS);
        let fraction = |cell: usize, xi: f64| (cell as f64 + 0.5 + 0.5 * xi) / CELLS as f64;
        let fractions: Vec<f64> =
            (0..CELLS).flat_map(|cell| rule.iter().map(move |(xi, _)| fraction(cell, *xi))).collect();
        let stations = CableStations::new(robot, equilibrium, dynamics, i, &fractions, false)?;
        let cell = state.free_length() / CELLS as f64;
        Ok(Some(Self {
            stations,
            lengths: std::array::from_fn(|point| 0.5 * rule[point].1 * cell),
            by_velocity_w: robot.wind.cross_pressure_by_velocity_w(&axis_w) * width,
        }))
    }
}

impl GustyCable {
    /// Cable `i`, with the blocks of its vibration; `None` for a cable whose stiffness does not depend on frequency.
    pub(super) fn new(
        setting: &Setting,
        field: &TurbulentField,
        i: usize,
        blocks: Option<&CableBlocks>,
    ) -> Result<Self, GustError> {
        let Setting { equilibrium, dynamics, .. } = *setting;
        let state = &equilibrium.cables[i];
        let supports = dynamics.support_blocks().map_or(0, |of| of.mass.nrows());
        let modes = blocks.map_or(0, |blocks| blocks.modes.len());
        let layout = CoordinateLayout::new(dynamics.dof(), blocks.map_or(&[], std::slice::from_ref), supports);
        let mut matrices = Matrices::zeros(layout.coordinates.len());
        match blocks {
            Some(blocks) => matrices.add_cable(blocks, 0, &layout),
            None => matrices.stiffness = constant_stiffness(setting, i, layout.coordinates.len())?,
        }

        // Load and damping by the drag.
        let drag = Drag::of(setting, i)?;
        let count = drag.as_ref().map_or(0, |_| CELLS);
        let mut loads = DMat::zeros(layout.coordinates.len(), 3 * count);
        let mut cells = Vec::with_capacity(count);
        let extent_w = state.chord_w() / CELLS as f64;
        if let Some(Drag { stations, lengths, by_velocity_w }) = &drag {
            let [by_velocity_w, axes] = [by_velocity_w, &field.axes].map(|of| DMat::from_fn(3, 3, |k, l| of[(k, l)]));
            for cell in 0..CELLS {
                for (point, length) in lengths.iter().enumerate() {
                    let at = cell * POINTS + point;
                    let motion = motion_w(dynamics, stations, at);
                    let force = motion.transpose() * &by_velocity_w * *length;
                    matrices.damping += &force * &motion;
                    let mut of_cell = loads.columns_mut(3 * cell, 3);
                    of_cell += force * &axes;
                }
                // As the drag, the places are those of a straight cable.
                cells.push(GustPlace { center_w: state.attachment_w + extent_w * (cell as f64 + 0.5), extent_w });
            }
        }

        let pull = pull(setting, i, layout.coordinates.len());
        Ok(Self { matrices, loads, cells, pull, is_constant: blocks.is_none(), dof: dynamics.dof(), modes })
    }

    /// Number of clamped modes.
    pub(super) fn mode_count(&self) -> usize {
        self.modes
    }

    /// Index of a coordinate of the ends, which are the platform's and then those of the supports.
    pub(super) fn end(&self, i: usize) -> usize {
        if i < self.dof { i } else { i + self.modes }
    }

    /// Index of the amplitude of a clamped mode.
    pub(super) fn mode(&self, k: usize) -> usize {
        self.dof + k
    }

    /// Row of the tension at the platform over its coordinates, from its dynamic stiffness: the force that the platform
    /// takes away from the end of the cable. `None` without a [`pull`](Self::pull).
    ///
    /// # References
    /// docs/theory.md, equation (49n).
    pub(super) fn tension_row(&self, stiffness: &CDMat) -> Option<Vec<Complex>> {
        let pull = self.pull.as_ref()?;
        let entry = |column: usize| -> Complex {
            pull.iter().enumerate().map(|(row, along)| -stiffness[(row, column)] * *along).sum()
        };
        Some((0..stiffness.ncols()).map(entry).collect())
    }
}

/// Stiffness of cable `i`, which does not depend on frequency, over the platform's coordinates and the supports.
fn constant_stiffness(setting: &Setting, i: usize, count: usize) -> Result<DMat, GustError> {
    let Setting { robot, equilibrium, dynamics } = *setting;
    let of = dynamics.linearisation;
    let settled = equilibrium.settled(robot);
    let found =
        EndStiffness::new(&settled, i, &equilibrium.cables[i], of.cable_model, of.in_plane_only, of.winches, 0.0);
    let Ok(EndStiffness::Constant(stiffness)) = found else { return Ok(DMat::zeros(count, count)) };
    let stations = CableStations::new(robot, equilibrium, dynamics, i, &[0.0, 1.0], false)?;
    let motion = motion_w(dynamics, &stations, 0) - motion_w(dynamics, &stations, 1);
    Ok(motion.transpose() * DMat::from_fn(3, 3, |k, l| stiffness[(k, l)]) * motion)
}

/// Motion of the platform along the pull of cable `i`, without a rotation; `None` for a slack cable, and for a planar
/// platform out of whose plane the cable pulls.
fn pull(setting: &Setting, i: usize, count: usize) -> Option<DVec> {
    let Setting { equilibrium, dynamics, .. } = *setting;
    let along_w = equilibrium.cables[i].force_on_platform_w.try_normalize(0.0)?;
    let translation = Vec6::new(along_w.x, along_w.y, along_w.z, 0.0, 0.0, 0.0);
    let motion = dynamics.coordinates().motion();
    let reduced = motion.reduced(&translation);
    if (motion.expanded(&reduced) - translation).norm() > OUT_OF_PLANE {
        return None;
    }
    Some(DVec::from_fn(count, |k, _| if k < dynamics.dof() { reduced[k] } else { 0.0 }))
}

/// Motion of a station along the axes of the world (rows) over the coordinates of its cable (columns).
pub(super) fn motion_w(dynamics: &Dynamics, stations: &CableStations, at: usize) -> DMat {
    let axes = [Vec3::x(), Vec3::y(), Vec3::z()];
    let motion = dynamics.coordinates().motion();
    let rows = axes.map(|direction_w| {
        let (platform, _, amplitudes) = stations.row(dynamics, at, &direction_w);
        let by_far_end = axes.map(|axis_w| stations.still_by_far_end(at, &direction_w, &axis_w));
        let on_supports = dynamics.station_row_on_supports(stations.cable, by_far_end, &amplitudes);
        let reduced = motion.reduced(&platform);
        let mut row = reduced.as_slice()[..dynamics.dof()].to_vec();
        row.extend(amplitudes);
        row.extend(on_supports);
        row
    });
    DMat::from_fn(3, rows[0].len(), |k, j| rows[k][j])
}

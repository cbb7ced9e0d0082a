//! Blocks of a second-order model: the platform, and per catenary-dynamic cable its end and its clamped modes.
//!
//! With the amplitudes q_k of the clamped modes as coordinates beside the platform's motion x, the matrices of a
//! catenary-dynamic cable do not depend on frequency (docs/theory.md, section 13). Displacements of flexible supports
//! stand beside x: together they are the coordinates of the ends.
//!
//! ```text
//! K_c = [ K_s   0   ]      M_c = [ M_s   g_k ]
//!       [ 0     ω_k² ]           [ g_kᵀ   1  ]
//! ```

use super::{DynamicCableAt, Dynamics, Supports};
use crate::cable::catenary_dynamic::{
    CarrierMotion, CatenaryDynamicEnd, DriveForm, DrivePart, DriveSignal, ENDS, InPowersOfS, PoleResidue,
};
use crate::math::{DMat, Mat3, Mat6, Vec3, Vec6};
use crate::robot::Damping;

/// Matrices of the platform over its coordinates [m, rad]; they include all stiffness that does not depend on
/// frequency.
pub(crate) struct PlatformBlocks {
    pub(crate) mass: DMat,
    pub(crate) damping: DMat,
    pub(crate) stiffness: DMat,
}

/// Matrices of flexible supports over their displacements, three per support, with the stiffness of cables that does
/// not depend on frequency.
pub(crate) struct SupportBlocks {
    /// Stiffness [N/m].
    pub(crate) stiffness: DMat,
    /// Stiffness between the platform's coordinates and the supports.
    pub(crate) coupling: DMat,
    /// Mass [kg].
    pub(crate) mass: DMat,
    /// Imaginary part of the stiffness by constant damping ratios [N/m].
    pub(crate) loss: DMat,
}

/// Blocks that a catenary-dynamic cable adds. The ends are the platform's coordinates, then those of the supports.
pub(crate) struct CableBlocks {
    /// Index of the cable, in the order of the file.
    pub(crate) cable: usize,
    /// Static stiffness K_s over the coordinates of the ends.
    pub(crate) end_stiffness: DMat,
    /// Mass M_s over the coordinates of the ends.
    pub(crate) end_mass: DMat,
    /// Clamped modes, in plane and then out of plane.
    pub(crate) modes: Vec<ClampedMode>,
    /// Damping of the rope.
    pub(crate) damping: Damping,
    /// Mass per unstrained length [kg/m].
    pub(crate) mass_per_length: f64,
    /// Parts of the drive with mass of their own or losses.
    pub(crate) drive: Vec<DrivePartBlock>,
}

/// Part of a drive that moves with a cable.
pub(crate) struct DrivePartBlock {
    /// Row of its motion.
    pub(crate) row: CableRow,
    /// Mass [kg], on which the damping of the rope does not act.
    pub(crate) mass: f64,
    /// Viscous damping [N s/m].
    pub(crate) damping: f64,
    /// Imaginary part of the stiffness by a constant loss factor [N/m].
    pub(crate) loss: f64,
    /// Fraction of the static response that the modes cannot represent: above zero for a part without mass.
    pub(crate) massless: f64,
}

/// Row over the coordinates of the ends, which are the platform's and then those of the supports, and the amplitudes of
/// the clamped modes of a cable.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct CableRow {
    pub(crate) ends: Vec<f64>,
    pub(crate) modes: Vec<f64>,
}

/// Clamped mode of unit modal mass.
pub(crate) struct ClampedMode {
    /// Participation g_k over the coordinates of the ends.
    pub(crate) participation: Vec<f64>,
    /// Pole ω_k² [rad²/s²].
    pub(crate) pole: f64,
    pub(crate) out_of_plane: bool,
}

impl Dynamics {
    /// Matrices of the platform, not scaled.
    pub(crate) fn platform_blocks(&self) -> PlatformBlocks {
        let [mass, damping, stiffness] =
            [&self.mass, &self.platform_damping, &self.constant].map(|matrix| self.unscaled_block(matrix));
        PlatformBlocks { mass, damping, stiffness }
    }

    /// Matrices of every catenary-dynamic cable, not scaled, in the order of [`terms`](Self::terms).
    pub(crate) fn cable_blocks(&self) -> impl Iterator<Item = CableBlocks> {
        self.terms.iter().enumerate().filter_map(|(t, term)| Some(self.blocks_of(t, term, term.form.by_poles()?)))
    }

    /// Matrices of the flexible supports, not scaled; `None` on a rigid frame.
    pub(crate) fn support_blocks(&self) -> Option<SupportBlocks> {
        let supports = self.supports()?;
        let [stiffness, mass, loss] = supports.constant_parts().map(Clone::clone);
        let (scaled, scale) = (supports.constant_coupling(), self.coordinate_scale());
        let coupling = DMat::from_fn(self.dof(), supports.count(), |i, j| scaled[(i, j)] * scale[i]);
        Some(SupportBlocks { stiffness, coupling, mass, loss })
    }

    /// Number of coordinates of the supports.
    fn support_count(&self) -> usize {
        self.supports().map_or(0, Supports::count)
    }

    /// Row of a signal of the drive of a cable, given by its index among the terms. `None` if it has no such signal.
    pub(crate) fn drive_signal_row(&self, term: usize, signal: DriveSignal) -> Option<InPowersOfS<CableRow>> {
        let end = self.terms[term].form.by_poles()?;
        let forms = end.signal_form(signal)?;
        Some(self.rows(term, forms, |carrier| end.direct_by_carrier(carrier, signal).unwrap_or_default()))
    }

    /// Output per input of signals of the drive of one cable with all coordinates at rest; `None` without such signals.
    pub(crate) fn direct_drive_signal(
        &self,
        term: usize,
        input: DriveSignal,
        output: DriveSignal,
    ) -> Option<InPowersOfS<f64>> {
        let end = self.terms[term].form.by_poles()?;
        end.direct_signal(input, output)
    }

    /// Row of a motion of the carrier of a cable's far end; the cable is given by its index among the terms. `None` if
    /// it is not catenary-dynamic.
    pub(crate) fn carrier_row(&self, term: usize, motion: &CarrierMotion) -> Option<InPowersOfS<CableRow>> {
        let end = self.terms[term].form.by_poles()?;
        Some(self.rows(term, end.carrier_form(motion), |carrier| end.between_carriers(carrier, motion)))
    }

    /// Row over the supports of the motion of a point on a cable, given by its index in the order of the file:
    /// `by_far_end_w` has its displacement per displacement of the far end along each axis of the world, and
    /// `amplitudes` its motion in the clamped modes.
    pub(crate) fn station_row_on_supports(&self, cable: usize, by_far_end_w: [f64; 3], amplitudes: &[f64]) -> Vec<f64> {
        let mut row = vec![0.0; self.support_count()];
        let Some((supports, first)) = self.supports().and_then(|of| Some((of, of.of_cable(cable)?))) else {
            return row;
        };
        row[first..first + 3].copy_from_slice(&by_far_end_w);
        let term = self.terms.iter().position(|term| term.cable == cable);
        if let Some(still) = term.and_then(|term| supports.static_amplitudes(term)) {
            row[first..].iter_mut().zip(&still).for_each(|(entry, still)| *entry += product(amplitudes, still));
        }
        row
    }

    /// Motions (e, n, b) of the platform end and of the far end of a cable per unit of a signal of its drive; the cable
    /// is given by its index among the terms.
    pub(crate) fn ends_of_signal(&self, term: usize, signal: DriveSignal) -> [[f64; 3]; 2] {
        let Some(end) = self.terms[term].form.by_poles() else { return [[0.0; 3]; 2] };
        end.ends_of_signal(signal)
    }

    /// Output of the drive of a cable, or its tension, per motion of the carrier of its far end with all coordinates at
    /// rest; `None` without such a signal.
    pub(crate) fn direct_by_carrier(
        &self,
        term: usize,
        motion: &CarrierMotion,
        output: DriveSignal,
    ) -> Option<InPowersOfS<f64>> {
        let end = self.terms[term].form.by_poles()?;
        end.direct_by_carrier(motion, output)
    }

    /// Row of a form of a cable, given by its index among the terms. `by_carrier` is its value per displacement of a
    /// support along each axis of the world, the amplitudes of the clamped modes at rest.
    ///
    /// The coordinate of a clamped mode is its amplitude without the static one by a drum side that is stretched.
    fn row(&self, term: usize, form: DriveForm, by_carrier: [f64; 3]) -> CableRow {
        let mut ends = self.unscaled_row(&self.terms[term].vector(form.end));
        ends.resize(self.dof() + self.support_count(), 0.0);
        if let Some((of, (first, _))) = self.supports().and_then(|of| Some((of, of.directions_w(term)?))) {
            let at_support = &mut ends[self.dof() + first..][..3];
            at_support.copy_from_slice(&by_carrier);
            for (entry, still) in at_support.iter_mut().zip(of.static_amplitudes(term).iter().flatten()) {
                *entry += product(&form.modes, still);
            }
        }
        CableRow { ends, modes: form.modes }
    }

    /// Rows of a polynomial of forms. `by_carrier` is its value for a motion of the carrier.
    fn rows(
        &self,
        term: usize,
        forms: InPowersOfS<DriveForm>,
        by_carrier: impl Fn(&CarrierMotion) -> InPowersOfS<f64>,
    ) -> InPowersOfS<CableRow> {
        let motions = self.supports().and_then(|supports| supports.carrier_motions(term)).map(|(_, motions)| motions);
        let by_support = motions.map_or([[0.0; 3]; 3], |motions| motions.map(|motion| by_carrier(&motion)));
        let mut power = 0..;
        forms.map(|form| {
            let power = power.next().unwrap_or_default();
            self.row(term, form, by_support.map(|powers| powers[power]))
        })
    }

    fn blocks_of(&self, t: usize, term: &DynamicCableAt, end: &CatenaryDynamicEnd) -> CableBlocks {
        let cable = &end.cable;
        let with_out_of_plane = !self.linearisation.in_plane_only;
        let (plane, normal) = (&cable.in_plane, &cable.out_of_plane);

        // The drive.
        let motions = self.supports().and_then(|supports| supports.carrier_motions(t)).map(|(_, motions)| motions);
        let part = |part: DrivePart| {
            let by_carrier = motions.map_or([0.0; 3], |motions| motions.map(|carrier| part.along(&carrier)));
            let DrivePart { motion, mass, damping, loss, massless, .. } = part;
            DrivePartBlock { row: self.row(t, motion, by_carrier), mass, damping, loss, massless }
        };
        let drive: Vec<DrivePartBlock> = end.drive_parts().into_iter().map(part).collect();

        // A cable on a support has both ends.
        if let Some((first, directions_w)) = self.supports().and_then(|supports| supports.directions_w(t)) {
            return self.blocks_of_both_ends(t, (first, directions_w), drive);
        }

        if let Some(coupled) = &cable.coupled {
            return self.blocks_of_coupled(term, coupled, drive);
        }

        // The end.
        let at_end = |[[hh, hv, ..], [vh, vv, ..], ..]: &[[f64; 4]; 4], out_of_plane: f64| {
            let out_of_plane = if with_out_of_plane { out_of_plane } else { 0.0 };
            let local = Mat3::new(*hh, *hv, 0.0, *vh, *vv, 0.0, 0.0, 0.0, out_of_plane);
            self.unscaled_block(&term.congruent(&local))
        };
        let end_stiffness = at_end(&plane.stiffness, normal.stiffness[0][0]);
        let end_mass = at_end(&plane.mass, normal.mass[0][0]);

        // The clamped modes.
        let mode = |direction: Vec6, pole: &f64, out_of_plane: bool| ClampedMode {
            participation: self.unscaled_row(&direction),
            pole: *pole,
            out_of_plane,
        };
        let in_plane = plane.participation.iter().map(|g| term.along * g[0] + term.normal * g[1]).zip(&plane.poles);
        let out_of_plane =
            normal.participation.iter().filter(|_| with_out_of_plane).map(|g| term.out * g[0]).zip(&normal.poles);
        let modes = in_plane
            .map(|(direction, pole)| mode(direction, pole, false))
            .chain(out_of_plane.map(|(direction, pole)| mode(direction, pole, true)))
            .collect();

        let (damping, mass_per_length) = self.damping[term.cable];
        CableBlocks { cable: term.cable, end_stiffness, end_mass, modes, damping, mass_per_length, drive }
    }

    /// Blocks of a cable with a rigid anchor whose end couples motions in plane and out of plane, with its drive.
    fn blocks_of_coupled(
        &self,
        term: &DynamicCableAt,
        coupled: &PoleResidue<6, 6>,
        drive: Vec<DrivePartBlock>,
    ) -> CableBlocks {
        let at_end = |matrix: &[[f64; 6]; 6]| self.unscaled_block(&term.congruent(&Mat3::from_fn(|i, j| matrix[i][j])));
        let (end_stiffness, end_mass) = (at_end(&coupled.stiffness), at_end(&coupled.mass));

        let mode = |(g, pole): (&[f64; 6], &f64)| {
            let direction = term.vector([g[0], g[1], g[2]]);
            ClampedMode { participation: self.unscaled_row(&direction), pole: *pole, out_of_plane: false }
        };
        let modes = coupled.participation.iter().zip(&coupled.poles).map(mode).collect();

        let (damping, mass_per_length) = self.damping[term.cable];
        CableBlocks { cable: term.cable, end_stiffness, end_mass, modes, damping, mass_per_length, drive }
    }

    /// Blocks of a cable on a support, given by its index among the terms, with its drive. The support moves the ends
    /// along `directions_w` and has its coordinates from the index `first` on.
    fn blocks_of_both_ends(
        &self,
        t: usize,
        (first, directions_w): (usize, &[Vec3; ENDS]),
        drive: Vec<DrivePartBlock>,
    ) -> CableBlocks {
        let term = &self.terms[t];
        let (damping, mass_per_length) = self.damping[term.cable];
        let count = self.dof() + self.support_count();

        // Motion of each end by the coordinates.
        let mut motions = DMat::zeros(ENDS, count);
        for (i, axis) in term.axes().into_iter().enumerate() {
            self.unscaled_row(axis).into_iter().enumerate().for_each(|(j, entry)| motions[(i, j)] = entry);
        }
        for (i, direction) in directions_w.iter().enumerate() {
            (0..3).for_each(|k| motions[(i, self.dof() + first + k)] += direction[k]);
        }

        let both = self.supports().and_then(|supports| supports.both_ends(t));
        let [end_stiffness, end_mass] = both.map_or([DMat::zeros(count, count), DMat::zeros(count, count)], |both| {
            both.still_parts()
                .map(|matrix| motions.transpose() * DMat::from_fn(ENDS, ENDS, |i, j| matrix[i][j]) * &motions)
        });
        let mode = |(g, pole, out_of_plane): (&[f64; ENDS], f64, bool)| {
            let participation = (0..count).map(|j| (0..ENDS).map(|i| g[i] * motions[(i, j)]).sum()).collect();
            ClampedMode { participation, pole, out_of_plane }
        };
        let modes = both.map_or_else(Vec::new, |both| both.clamped_modes().map(mode).collect());
        CableBlocks { cable: term.cable, end_stiffness, end_mass, modes, damping, mass_per_length, drive }
    }

    /// Removes the scaling from a matrix over the platform's coordinates.
    fn unscaled_block(&self, matrix: &Mat6) -> DMat {
        let (f, scale) = (self.dof(), self.coordinate_scale());
        DMat::from_fn(f, f, |i, j| matrix[(i, j)] * scale[i] * scale[j])
    }

    /// Removes the scaling from a vector over the platform's coordinates.
    fn unscaled_row(&self, vector: &Vec6) -> Vec<f64> {
        let scale = self.coordinate_scale();
        (0..self.dof()).map(|i| vector[i] * scale[i]).collect()
    }
}

impl DynamicCableAt {
    /// Transforms a form of the end's displacement (e, n, b) to the platform's scaled coordinates.
    fn congruent(&self, local: &Mat3) -> Mat6 {
        let axes = self.axes();
        Mat6::from_fn(|i, j| {
            let mut sum = 0.0;
            for (p, u) in axes.iter().enumerate() {
                for (q, v) in axes.iter().enumerate() {
                    sum += local[(p, q)] * u[i] * v[j];
                }
            }
            sum
        })
    }
}

/// Sum of the products of the entries.
fn product(one: &[f64], other: &[f64]) -> f64 {
    one.iter().zip(other).map(|(one, other)| one * other).sum()
}

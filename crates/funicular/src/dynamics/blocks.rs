//! Blocks of a second-order model: the platform, and per catenary-dynamic cable its end and its clamped modes.
//!
//! With the amplitudes q_k of the clamped modes as coordinates beside the platform's motion x, the matrices of a
//! catenary-dynamic cable do not depend on frequency (docs/theory.md, section 13):
//!
//! ```text
//! K_c = [ K_s   0   ]      M_c = [ M_s   g_k ]
//!       [ 0     ω_k² ]           [ g_kᵀ   1  ]
//! ```

use super::{DynamicCableAt, Dynamics};
use crate::cable::DynamicCable;
use crate::cable::catenary_dynamic::{
    CarrierMotion, CatenaryDynamicEnd, DriveForm, DrivePart, DriveSignal, InPowersOfS,
};
use crate::math::{DMat, Mat3, Mat6, Vec6};
use crate::robot::Damping;

/// Matrices of the platform over its coordinates [m, rad]; they include all stiffness that does not depend on
/// frequency.
pub(crate) struct PlatformBlocks {
    pub(crate) mass: DMat,
    pub(crate) damping: DMat,
    pub(crate) stiffness: DMat,
}

/// Blocks that a catenary-dynamic cable adds.
pub(crate) struct CableBlocks {
    /// Index of the cable, in the order of the file.
    pub(crate) cable: usize,
    /// Static stiffness K_s of the end over the platform's coordinates.
    pub(crate) end_stiffness: DMat,
    /// Mass M_s of the end over the platform's coordinates.
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
    /// Fraction of the static response that the modes cannot represent: above zero for a part without mass.
    pub(crate) massless: f64,
}

/// Row over the platform's coordinates and the amplitudes of the clamped modes of a cable.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct CableRow {
    pub(crate) platform: Vec<f64>,
    pub(crate) modes: Vec<f64>,
}

/// Clamped mode of unit modal mass.
pub(crate) struct ClampedMode {
    /// Participation g_k over the platform's coordinates.
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
        self.terms.iter().filter_map(|term| match &term.form {
            DynamicCable::CatenaryDynamic(end) => Some(self.blocks_of(term, end)),
            DynamicCable::ShallowDynamic(_) => None,
        })
    }

    /// Row of a signal of the drive of a cable, given by its index among the terms. `None` if it has no such signal.
    pub(crate) fn drive_signal_row(&self, term: usize, signal: DriveSignal) -> Option<InPowersOfS<CableRow>> {
        let term = &self.terms[term];
        let DynamicCable::CatenaryDynamic(end) = &term.form else { return None };
        Some(end.signal_form(signal)?.map(|form| self.row(term, form)))
    }

    /// Output per input of signals of the drive of one cable with all coordinates at rest; `None` without such signals.
    pub(crate) fn direct_drive_signal(
        &self,
        term: usize,
        input: DriveSignal,
        output: DriveSignal,
    ) -> Option<InPowersOfS<f64>> {
        let DynamicCable::CatenaryDynamic(end) = &self.terms[term].form else { return None };
        end.direct_signal(input, output)
    }

    /// Row of a motion of the carrier of a cable's far end; the cable is given by its index among the terms. `None` if it is not
    /// catenary-dynamic.
    pub(crate) fn carrier_row(&self, term: usize, motion: &CarrierMotion) -> Option<InPowersOfS<CableRow>> {
        let term = &self.terms[term];
        let DynamicCable::CatenaryDynamic(end) = &term.form else { return None };
        Some(end.carrier_form(motion).map(|form| self.row(term, form)))
    }

    /// Motions (e, n, b) of the platform end and of the far end of a cable per unit of a signal of its drive; the cable is given by
    /// its index among the terms.
    pub(crate) fn ends_of_signal(&self, term: usize, signal: DriveSignal) -> [[f64; 3]; 2] {
        let DynamicCable::CatenaryDynamic(end) = &self.terms[term].form else { return [[0.0; 3]; 2] };
        end.ends_of_signal(signal)
    }

    /// Output of the drive of a cable, or its tension, per motion of the carrier of its far end with all coordinates at rest;
    /// `None` without such a signal.
    pub(crate) fn direct_by_carrier(
        &self,
        term: usize,
        motion: &CarrierMotion,
        output: DriveSignal,
    ) -> Option<InPowersOfS<f64>> {
        let DynamicCable::CatenaryDynamic(end) = &self.terms[term].form else { return None };
        end.direct_by_carrier(motion, output)
    }

    fn row(&self, term: &DynamicCableAt, form: DriveForm) -> CableRow {
        CableRow { platform: self.unscaled_row(&term.vector(form.end)), modes: form.modes }
    }

    fn blocks_of(&self, term: &DynamicCableAt, end: &CatenaryDynamicEnd) -> CableBlocks {
        let cable = &end.cable;
        let with_out_of_plane = !self.linearisation.in_plane_only;
        let (plane, normal) = (&cable.in_plane, &cable.out_of_plane);
        let (damping, mass_per_length) = self.damping[term.cable];

        // The drive.
        let part = |part: DrivePart| {
            let DrivePart { motion, mass, damping, massless, .. } = part;
            DrivePartBlock { row: self.row(term, motion), mass, damping, massless }
        };
        let drive: Vec<DrivePartBlock> = end.drive_parts().into_iter().map(part).collect();

        if let Some(coupled) = &cable.coupled {
            let at_end =
                |matrix: &[[f64; 6]; 6]| self.unscaled_block(&term.congruent(&Mat3::from_fn(|i, j| matrix[i][j])));
            let modes = coupled.participation.iter().zip(&coupled.poles).map(|(g, pole)| {
                let direction = term.vector([g[0], g[1], g[2]]);
                ClampedMode { participation: self.unscaled_row(&direction), pole: *pole, out_of_plane: false }
            });
            let (end_stiffness, end_mass) = (at_end(&coupled.stiffness), at_end(&coupled.mass));
            return CableBlocks {
                cable: term.cable,
                end_stiffness,
                end_mass,
                modes: modes.collect(),
                damping,
                mass_per_length,
                drive,
            };
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

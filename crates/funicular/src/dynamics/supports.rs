//! Flexible supports of a linearised robot: their displacements are unknowns beside the platform's motion.
//!
//! With the displacements e of all supports the dynamic stiffness is
//!
//! ```text
//! D_ext = [ D    B ]      D = Σ over cables with their anchors held,  B, Y: forces by motions of the anchors
//!         [ Bᵀ   Y ]      D − B Y⁻¹ Bᵀ: stiffness of the platform with free supports
//! ```
//!
//! D_ext has the poles of single cables only, those with both ends held. So counts and modes are those of D_ext
//! (docs/theory.md, equations (92) and (93)).

use super::sheaves::Sheaves;
use super::{DynamicCableAt, Dynamics, DynamicsError};
use crate::cable::catenary_dynamic::{ByTurn, CarrierMotion, CatenaryDynamicEnd, ENDS, NearPole, NearRanges, TwoEnded};
use crate::cable::{DynamicCable, LocalAxes};
use crate::math::{CDMat, CMat6, Complex, DMat, DVec, Mat3, Mat6, Vec3, Vec6};
use crate::platform::{Coordinates, wrench_columns, wrench_of};
use crate::robot::Robot;
use crate::statics::{CableState, on_support, support_side};

/// Flexible supports of a linearised robot. Displacements are in world axes [m], three per support.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Supports {
    /// Stiffness that does not depend on frequency: supports, and cables without mass [N/m].
    stiffness: DMat,
    /// Stiffness of such cables between the platform, in scaled coordinates, and the supports [N/m].
    coupling: DMat,
    /// Mass of each support [kg].
    mass: DMat,
    /// Imaginary part of the stiffness of damped supports [N/m].
    loss: DMat,
    /// Cables on supports, per cable whose stiffness depends on frequency.
    carried: Vec<Option<CableOnSupport>>,
    /// First coordinate of the support of each cable of the robot; `None` for a rigid anchor.
    of_cable: Vec<Option<usize>>,
    /// Ropes that run over sheaves, whose coordinates stand behind those of the supports [m].
    sheaves: Sheaves,
}

/// Cable on a support, whose stiffness depends on frequency.
#[derive(Debug, Clone, PartialEq)]
struct CableOnSupport {
    /// True if its drum stays on the ground.
    from_ground: bool,
    /// First coordinate of its support.
    first: usize,
    /// Stiffness of both ends.
    both: TwoEnded,
    /// Direction in which the support moves each end; zero for the platform's.
    directions_w: [Vec3; ENDS],
}

impl CableOnSupport {
    /// Motion of the ends by the supports' displacements.
    fn motion(&self, supports: &[f64]) -> [f64; ENDS] {
        let e = Vec3::from_column_slice(&supports[self.first..self.first + 3]);
        self.directions_w.map(|direction| direction.dot(&e))
    }

    /// True if a motion of the frame moves the entry point along the drum side as the support does: both with the drum,
    /// or both without it.
    fn moves_like(&self, moved: &CarrierMotion) -> bool {
        moved.with_drum != self.from_ground
    }

    /// Motion of the ends with the frame.
    fn ends_of(&self, moved: &CarrierMotion) -> [f64; ENDS] {
        let [e, n, b] = moved.displacement;
        [0.0, 0.0, 0.0, e, n, b, if self.moves_like(moved) { moved.along_drum_side } else { 0.0 }]
    }

    /// Forces on the motions of the drive by a motion of the frame beside that of the ends, at ω [rad/s].
    fn forces_beside_ends(&self, form: &CatenaryDynamicEnd, moved: &CarrierMotion, omega: f64) -> Vec<Complex> {
        let along_drum_side = if self.moves_like(moved) { 0.0 } else { moved.along_drum_side };
        form.forces_at(&CarrierMotion { along_drum_side, ..*moved }, omega.into())
    }

    /// Mass [kg m] between the entry point of a drum side from the ground, along it, and a base that moves with the
    /// whole drum side.
    fn mass_beside_ends(&self, form: &CatenaryDynamicEnd, moved: &CarrierMotion) -> f64 {
        if self.moves_like(moved) {
            return 0.0;
        }
        form.carried_mass(0) * form.drum_side_ratio() * moved.along_drum_side
    }

    /// Forces on the supports from those on the ends.
    fn on_supports(&self, ends: &[f64; ENDS], count: usize) -> Vec<f64> {
        let mut forces = vec![0.0; count];
        for (direction, end) in self.directions_w.iter().zip(ends) {
            (0..3).for_each(|k| forces[self.first + k] += direction[k] * end);
        }
        forces
    }
}

/// Frequency at which the rows of the supports are evaluated; every number with its derivative.
pub(super) struct SupportsAt {
    /// Square ω_c² of each cable whose stiffness depends on frequency.
    pub(super) squares: Vec<(Complex, Complex)>,
    /// Square ω² of the supports.
    pub(super) support_square: (Complex, Complex),
    /// Fraction of the damping that acts on the supports.
    pub(super) losses: f64,
    /// Relative distance to poles that are left out.
    pub(super) width: f64,
}

/// Rows of the supports in D_ext without near poles, and their derivatives.
pub(super) struct SupportRows {
    /// B: scaled coordinates of the platform by displacements of supports [N/m].
    pub(super) coupling: (CDMat, CDMat),
    /// Y [N/m].
    pub(super) own: (CDMat, CDMat),
}

/// Supports under construction.
pub(super) struct SupportsBuilder<'a> {
    robot: &'a Robot,
    coordinates: &'a Coordinates,
    supports: Supports,
}

impl<'a> SupportsBuilder<'a> {
    pub(super) fn new(robot: &'a Robot, coordinates: &'a Coordinates) -> Self {
        let sheaves = Sheaves::new(robot, 3 * robot.supports.len());
        let count = 3 * robot.supports.len() + sheaves.count();
        let mut supports = Supports {
            stiffness: DMat::zeros(count, count),
            coupling: DMat::zeros(6, count),
            mass: DMat::zeros(count, count),
            loss: DMat::zeros(count, count),
            carried: Vec::new(),
            of_cable: robot.cables.iter().map(|cable| Some(3 * cable.anchor.support?)).collect(),
            sheaves,
        };
        for (i, support) in robot.supports.iter().enumerate() {
            let block = |matrix: &mut DMat, value: &Mat3| matrix.view_mut((3 * i, 3 * i), (3, 3)).copy_from(value);
            block(&mut supports.stiffness, &support.stiffness_w);
            block(&mut supports.mass, &(Mat3::identity() * support.mass));
            block(&mut supports.loss, &(support.stiffness_w * (2.0 * support.damping_ratio)));
        }
        Self { robot, coordinates, supports }
    }

    /// Adds cable `i`, whose stiffness does not depend on frequency; `held` is the stiffness of its span [N/m].
    pub(super) fn add_constant(&mut self, i: usize, state: &CableState, held: &Mat3) {
        let Some(support) = self.robot.cables[i].anchor.support else { return };
        let Some(stiffness) = on_support(self.robot, i, state, held) else { return };
        for (k, column) in wrench_columns(&-stiffness.force_w, &state.lever_w).iter().enumerate() {
            let mut view = self.supports.coupling.column_mut(3 * support + k);
            view += self.coordinates.reduce(column);
        }
        let mut view = self.supports.stiffness.view_mut((3 * support, 3 * support), (3, 3));
        view += stiffness.stiffness_w;
    }

    /// Adds cable `i`, whose stiffness depends on frequency.
    pub(super) fn add_dynamic(&mut self, i: usize, state: &CableState, form: &DynamicCable) {
        let found = self.robot.cables[i].anchor.support.zip(support_side(self.robot, i, state));
        let (Some((support, side)), Some(end)) = (found, form.by_poles()) else {
            self.supports.carried.push(None);
            return;
        };
        let LocalAxes { e, n, b } = end.axes;
        let still = Vec3::zeros();
        let directions_w = [still, still, still, e, n, b, side.direction_w];
        let both = TwoEnded::new(end, side.from_ground);
        self.supports.carried.push(Some(CableOnSupport {
            from_ground: side.from_ground,
            first: 3 * support,
            both,
            directions_w,
        }));

        // The tension of a drum side from the ground, and the mass of one that moves with the support.
        let mut stiffness = self.supports.stiffness.view_mut((3 * support, 3 * support), (3, 3));
        stiffness += side.sideways_w;
        if !side.from_ground {
            let mass = end.cable.end.as_ref().and_then(|end| end.chain()).map_or(0.0, |chain| chain.drum_side_mass);
            let across = Mat3::identity() - side.direction_w * side.direction_w.transpose();
            let mut view = self.supports.mass.view_mut((3 * support, 3 * support), (3, 3));
            view += across * mass;
        }
    }

    /// Adds the running of rope into cable `i`, whose stiffness `k` [N/m] does not depend on frequency.
    pub(super) fn run_constant(&mut self, i: usize, state: &CableState, k: &Mat3) {
        let Some(end) = self.supports.sheaves.end(i, state) else { return };
        let force_w = k * end.direction_w - end.load_w;
        self.add_running(i, state, (&force_w, force_w.dot(&end.direction_w)));
    }

    /// Adds the running of rope into cable `i`, whose stiffness depends on frequency.
    ///
    /// # Errors
    /// [`DynamicsError::RunningRope`] for a rope over a sheave of the frame.
    pub(super) fn run_dynamic(
        &mut self,
        i: usize,
        state: &CableState,
        form: &DynamicCable,
    ) -> Result<(), DynamicsError> {
        let end = self.supports.sheaves.end(i, state);
        self.supports.sheaves.add_term(self.robot, i, end.as_ref(), form.axes())?;
        if let Some(end) = end {
            self.add_running(i, state, (&-end.load_w, -end.load_w.dot(&end.direction_w)));
        }
        Ok(())
    }

    /// Adds a force on the platform end of cable `i`, and its own resistance, per length that runs into the cable.
    fn add_running(&mut self, i: usize, state: &CableState, (force_w, own): (&Vec3, f64)) {
        let by = self.supports.sheaves.of_cable(i).to_vec();
        let wrench = self.coordinates.reduce(&wrench_of(force_w, &state.lever_w));
        for (column, sign) in &by {
            let mut view = self.supports.coupling.column_mut(*column);
            view += wrench * *sign;
            for (row, other) in &by {
                self.supports.stiffness[(*row, *column)] += own * sign * other;
            }
        }
    }

    pub(super) fn finish(self) -> Supports {
        self.supports
    }
}

impl Supports {
    /// Number of coordinates: three per support, and those of ropes over sheaves.
    pub(crate) fn count(&self) -> usize {
        self.stiffness.nrows()
    }

    /// Rows of the supports at a frequency, without the losses of drives.
    pub(super) fn rows(&self, terms: &[DynamicCableAt], at: &SupportsAt) -> SupportRows {
        let (square, slope) = at.support_square;
        let loss = Complex::new(0.0, at.losses);
        let own = self.stiffness.map(Complex::from) + self.loss.map(|loss_of| loss * loss_of)
            - self.mass.map(|mass| square * mass);
        let mut rows = SupportRows {
            coupling: (self.coupling.map(Complex::from), CDMat::zeros(6, self.count())),
            own: (own, self.mass.map(|mass| -slope * mass)),
        };

        for (t, (term, (square, slope))) in terms.iter().zip(&at.squares).enumerate() {
            self.sheaves.add_rows([&mut rows.coupling, &mut rows.own], (t, term), (*square, *slope), at.width);
        }

        for ((term, carried), (square, slope)) in terms.iter().zip(&self.carried).zip(&at.squares) {
            let (Some(carried), Some(form)) = (carried, term.form.by_poles()) else { continue };
            if at.width == 0.0 && *slope == Complex::new(0.0, 0.0) {
                rows.add(term, carried, &carried.both.value_at(*square), Complex::new(1.0, 0.0), false);
                continue;
            }
            let (value, by_square) = carried.both.at(*square, &form.near(square.re, at.width));
            rows.add(term, carried, &value, Complex::new(1.0, 0.0), false);
            rows.add(term, carried, &by_square, *slope, true);
        }
        rows
    }

    /// Adds the losses of drives at ω [rad/s], whose motions are free.
    fn add_drive_losses(
        &self,
        rows: &mut SupportRows,
        terms: &[DynamicCableAt],
        squares: &[(Complex, Complex)],
        omega: f64,
    ) {
        for (t, (term, (square, _))) in terms.iter().zip(squares).enumerate() {
            self.sheaves.add_drive_losses([&mut rows.coupling, &mut rows.own], (t, term), *square, omega);
        }
        for ((term, carried), (square, _)) in terms.iter().zip(&self.carried).zip(squares) {
            let (Some(carried), Some(form)) = (carried, term.form.by_poles()) else { continue };
            let all = NearRanges::default();
            let Some(motions) = form.drive_at(*square, &all).filter(|_| form.has_drive_losses()) else { continue };
            let delta = form.beyond_undamped(omega.into(), 1.0);
            let transfer: Vec<[Complex; ENDS]> =
                carried.both.drive(*square, &all).into_iter().map(|(row, _)| row).collect();

            // Tᵀ Δ (1 + R Δ)⁻¹ T.
            let mut added = [[Complex::new(0.0, 0.0); ENDS]; ENDS];
            for j in 0..ENDS {
                let column: Vec<Complex> = transfer.iter().map(|row| row[j]).collect();
                let forces = motions.forces_by(&delta, &column);
                for (i, row) in added.iter_mut().enumerate() {
                    row[j] += transfer.iter().zip(&forces).map(|(row, force)| row[i] * force).sum::<Complex>();
                }
            }
            rows.add(term, carried, &added, Complex::new(1.0, 0.0), false);
        }
    }

    /// Participation of the supports in a near pole of a cable, given by its index among the terms.
    pub(super) fn participation(&self, term: usize, near: &NearPole) -> Vec<f64> {
        match &self.carried[term] {
            Some(carried) => carried.on_supports(&carried.both.participation(near.family, near.index), self.count()),
            None => self.sheaves.participation(term, near, self.count()),
        }
    }

    /// The given motions of a cable's drive per displacement of the supports at x = ω_c², and their derivatives by x:
    /// one row per motion. `None` for a cable with a rigid anchor.
    pub(super) fn drive(
        &self,
        term: usize,
        motions: &[usize],
        x: Complex,
        left_out: &NearRanges,
    ) -> Option<Vec<Vec<(Complex, Complex)>>> {
        let carried = self.carried[term].as_ref()?;
        let zero = Complex::new(0.0, 0.0);
        let by_supports = |(value, slope): ([Complex; ENDS], [Complex; ENDS])| {
            let mut row = vec![(zero, zero); self.count()];
            for (direction, (value, slope)) in carried.directions_w.iter().zip(value.into_iter().zip(slope)) {
                for k in 0..3 {
                    row[carried.first + k].0 += value * direction[k];
                    row[carried.first + k].1 += slope * direction[k];
                }
            }
            row
        };
        Some(carried.both.motions(motions, x, left_out).into_iter().map(by_supports).collect())
    }

    /// Ropes that run over sheaves.
    pub(crate) fn sheaves(&self) -> &Sheaves {
        &self.sheaves
    }

    /// Motion of the carrier of a cable's end per displacement of its support along each axis of the world, with the
    /// first coordinate of that support. The cable is given by its index among the terms; `None` for a rigid anchor.
    pub(crate) fn carrier_motions(&self, term: usize) -> Option<(usize, [CarrierMotion; 3])> {
        let carried = self.carried[term].as_ref()?;
        let [.., e, n, b, along] = carried.directions_w;
        let motion = |k: usize| CarrierMotion {
            displacement: [e[k], n[k], b[k]],
            by_turn: ByTurn::default(),
            along_drum_side: along[k],
            with_drum: !carried.from_ground,
        };
        Some((carried.first, [0, 1, 2].map(motion)))
    }

    /// Adds the forces of inertia that act on the displacements of the supports while their feet move, by three
    /// coordinates per support.
    pub(crate) fn add_inertia_of_feet(&self, forces: &mut [Complex], feet: &[f64], omega: f64) {
        let inertia = &self.mass * DVec::from_column_slice(feet) * (omega * omega);
        forces.iter_mut().zip(inertia.iter()).for_each(|(force, inertia)| *force += inertia);
    }

    /// Adds the forces on the support of a cable, given by its index among the terms, while the frame moves its anchor
    /// and perhaps its drum.
    pub(crate) fn add_forces_by_carrier(
        &self,
        forces: &mut [Complex],
        (term, form): (usize, &CatenaryDynamicEnd),
        moved: &CarrierMotion,
        omega: f64,
        square: Complex,
    ) {
        let Some(carried) = &self.carried[term] else { return };
        let all = NearRanges::default();
        let stiffness = carried.both.value_at(square);
        let ends = carried.ends_of(moved);
        let mut on_ends: [Complex; ENDS] =
            std::array::from_fn(|i| -(0..ENDS).map(|j| stiffness[i][j] * ends[j]).sum::<Complex>());

        // The drive: its losses, the swivel that turns, and the mass of a drum side from the ground, which moves with
        // the base.
        if let Some(motions) = form.drive_at(square, &all) {
            let delta = form.beyond_undamped(omega.into(), 1.0);
            let transfer: Vec<[Complex; ENDS]> =
                carried.both.drive(square, &all).into_iter().map(|(row, _)| row).collect();
            let given = carried.forces_beside_ends(form, moved, omega);
            let mut free: Vec<Complex> =
                transfer.iter().map(|row| row.iter().zip(ends).map(|(t, u)| t * u).sum()).collect();
            motions.add_motion_by(&given, &mut free);
            let lost = motions.forces_by(&delta, &free);
            for (i, force) in on_ends.iter_mut().enumerate() {
                *force += (transfer.iter().zip(given.iter().zip(&lost)))
                    .map(|(row, (given, lost))| row[i] * (given - lost))
                    .sum::<Complex>();
            }
            on_ends[ENDS - 1] += square * carried.mass_beside_ends(form, moved);
            if carried.from_ground {
                on_ends[ENDS - 1] -= form.drum_side_at_wheel() * form.drum_side_ratio() * moved.by_turn.stretched;
            }
        }

        for (direction, force) in carried.directions_w.iter().zip(on_ends) {
            (0..3).for_each(|k| forces[carried.first + k] += force * direction[k]);
        }
    }

    /// Stiffness and mass that do not depend on frequency [N/m, kg], and the imaginary part of the stiffness of damped
    /// supports [N/m].
    pub(super) fn constant_parts(&self) -> [&DMat; 3] {
        [&self.stiffness, &self.mass, &self.loss]
    }

    /// Stiffness between the platform, in scaled coordinates, and the supports by cables whose stiffness does not
    /// depend on frequency [N/m].
    pub(super) fn constant_coupling(&self) -> &DMat {
        &self.coupling
    }

    /// Directions in which the support of a cable, given by its index among the terms, moves each end of it, world
    /// axes, with the first coordinate of that support; `None` for a rigid anchor.
    pub(super) fn directions_w(&self, term: usize) -> Option<(usize, &[Vec3; ENDS])> {
        self.carried[term].as_ref().map(|carried| (carried.first, &carried.directions_w))
    }

    /// Static amplitudes of the clamped modes of a cable on a support per displacement of the support along each axis
    /// of the world; the cable is given by its index among the terms. A drum side from the ground pulls at them. `None`
    /// for a rigid anchor.
    pub(super) fn static_amplitudes(&self, term: usize) -> Option<[Vec<f64>; 3]> {
        let carried = self.carried[term].as_ref()?;
        let along = carried.directions_w[ENDS - 1];
        Some([0, 1, 2].map(|k| carried.both.static_amplitudes().map(|amplitude| amplitude * along[k]).collect()))
    }

    /// Forces of inertia on the supports per acceleration of the frame, which moves their feet by three coordinates per
    /// support [kg].
    pub(crate) fn inertia_of_feet(&self, feet: &[f64]) -> Vec<f64> {
        (-&self.mass * DVec::from_column_slice(feet)).as_slice().to_vec()
    }

    /// True if a support has damping of its own.
    pub(crate) fn has_losses(&self) -> bool {
        self.loss.amax() > 0.0
    }

    /// Copy for cables whose clamped modes have been compressed.
    pub(super) fn with_cables(&self, terms: &[DynamicCableAt]) -> Self {
        let mut supports = self.clone();
        for (carried, term) in supports.carried.iter_mut().zip(terms) {
            if let (Some(carried), Some(end)) = (carried, term.form.by_poles()) {
                carried.both = TwoEnded::new(end, carried.from_ground);
            }
        }
        supports
    }

    /// First coordinate of the support of a cable of the robot; `None` for a rigid anchor.
    pub(crate) fn of_cable(&self, cable: usize) -> Option<usize> {
        self.of_cable[cable]
    }

    /// Motion of both ends of a cable by the supports alone; `None` for a rigid anchor.
    pub(crate) fn ends(&self, term: usize, supports: &[f64]) -> Option<[f64; ENDS]> {
        Some(self.carried[term].as_ref()?.motion(supports))
    }

    /// Both ends of a cable on a support.
    pub(crate) fn both_ends(&self, term: usize) -> Option<&TwoEnded> {
        self.carried[term].as_ref().map(|carried| &carried.both)
    }

    /// Moving mass that displacements of supports add to each cable whose stiffness depends on frequency, for a scaled
    /// motion of the platform, without near poles [kg m²].
    pub(super) fn added_energies(
        &self,
        terms: &[DynamicCableAt],
        at: &SupportsAt,
        platform: &Vec6,
        supports: &[f64],
    ) -> Vec<f64> {
        let of = |(t, term): (usize, &DynamicCableAt)| {
            let (Some(carried), Some(form)) = (&self.carried[t], term.form.by_poles()) else {
                return 0.0;
            };
            let x = at.squares[t].0;
            let (_, slope) = carried.both.at(x, &form.near(x.re, at.width));
            let (ends, of_platform) = (carried.motion(supports), term.displacement(platform));
            let by = |i: usize, j: usize| -slope[i][j].re;
            let mixed: f64 = (0..3)
                .flat_map(|i| (3..ENDS).map(move |j| (i, j)))
                .map(|(i, j)| by(i, j) * of_platform[i] * ends[j])
                .sum();
            let own: f64 =
                (3..ENDS).flat_map(|i| (3..ENDS).map(move |j| (i, j))).map(|(i, j)| by(i, j) * ends[i] * ends[j]).sum();
            2.0 * mixed + own
        };

        let running = self.sheaves.added_energies(terms, (&at.squares, at.width), platform, supports);
        terms.iter().enumerate().map(of).zip(running).map(|(carried, running)| carried + running).collect()
    }

    /// Kinetic energy of each support over ω²/2 [kg m²] and the work of its losses [N m] for displacements of all.
    pub(super) fn energies(&self, supports: &[f64]) -> (Vec<f64>, f64) {
        let e = DVec::from_column_slice(supports);
        let moved = &self.mass * &e;
        let of = |k: usize| (0..3).map(|i| moved[3 * k + i] * e[3 * k + i]).sum();
        ((0..self.sheaves.first() / 3).map(of).collect(), e.dot(&(&self.loss * &e)))
    }
}

impl SupportRows {
    /// Adds a matrix over the ends of a cable, times a factor, to the values or to their derivatives.
    fn add(
        &mut self,
        term: &DynamicCableAt,
        carried: &CableOnSupport,
        ends: &[[Complex; ENDS]; ENDS],
        factor: Complex,
        to_slope: bool,
    ) {
        let (coupling, own) =
            if to_slope { (&mut self.coupling.1, &mut self.own.1) } else { (&mut self.coupling.0, &mut self.own.0) };
        for (j, direction) in carried.directions_w.iter().enumerate().skip(3) {
            for k in 0..3 {
                let column = carried.first + k;
                for (i, axis) in term.axes().iter().enumerate() {
                    let entry = factor * ends[i][j] * direction[k];
                    (0..6).for_each(|r| coupling[(r, column)] += entry * axis[r]);
                }
                for (i, other) in carried.directions_w.iter().enumerate().skip(3) {
                    let entry = factor * ends[i][j] * direction[k];
                    (0..3).for_each(|r| own[(carried.first + r, column)] += entry * other[r]);
                }
            }
        }
    }
}

impl Dynamics {
    /// Flexible supports; `None` on a rigid frame.
    pub(crate) fn supports(&self) -> Option<&Supports> {
        self.supports.as_deref()
    }

    /// Undamped frequency at x = ω²; derivatives are by x.
    pub(super) fn undamped_at(&self, x: f64, width: f64) -> SupportsAt {
        let square = (Complex::from(x), Complex::new(1.0, 0.0));
        SupportsAt { squares: vec![square; self.terms.len()], support_square: square, losses: 0.0, width }
    }

    /// Damped frequency ω [rad/s]; derivatives are zero.
    fn damped_at(&self, omega: f64) -> SupportsAt {
        let zero = Complex::new(0.0, 0.0);
        let squares = self.terms.iter().map(|term| (self.cable_square(term.cable, omega), zero)).collect();
        SupportsAt { squares, support_square: (Complex::from(omega * omega), zero), losses: 1.0, width: 0.0 }
    }

    /// Rows of the supports at ω [rad/s] with all damping.
    pub(super) fn damped_rows(&self, supports: &Supports, omega: f64) -> SupportRows {
        let at = self.damped_at(omega);
        let mut rows = supports.rows(&self.terms, &at);
        supports.add_drive_losses(&mut rows, &self.terms, &at.squares, omega);
        rows
    }

    /// Stiffness `B Y⁻¹ Bᵀ` that the platform loses because its supports yield, at ω [rad/s] with all damping; scaled.
    /// Not finite at a frequency at which undamped supports vibrate with the platform at rest.
    pub(super) fn damped_loss(&self, supports: &Supports, omega: f64) -> CMat6 {
        lost(&self.damped_rows(supports, omega))
    }

    /// Y⁻¹ B ᵀ and Y⁻¹ at ω [rad/s] with all damping: displacements of supports, less their sign, per scaled motion of
    /// the platform, and per force on them. `None` on a rigid frame.
    pub(crate) fn support_response(&self, omega: f64) -> Option<(CDMat, CDMat)> {
        let rows = self.damped_rows(self.supports()?, omega);
        let count = rows.own.0.nrows();
        let free = rows.own.0.try_inverse().unwrap_or_else(|| CDMat::repeat(count, count, f64::INFINITY.into()));
        Some((&free * rows.coupling.0.transpose(), free))
    }

    /// Stiffness of [`damped_loss`](Self::damped_loss); zero on a rigid frame.
    pub(crate) fn stiffness_lost_to_supports(&self, omega: f64) -> CMat6 {
        self.supports().map_or_else(CMat6::zeros, |supports| self.damped_loss(supports, omega))
    }

    /// Such a stiffness of the undamped robot.
    pub(super) fn undamped_loss(&self, supports: &Supports, omega: f64) -> Mat6 {
        lost(&supports.rows(&self.terms, &self.undamped_at(omega * omega, 0.0))).map(|entry| entry.re)
    }
}

/// `B Y⁻¹ Bᵀ`.
fn lost(rows: &SupportRows) -> CMat6 {
    let coupling = &rows.coupling.0;
    let solved = rows.own.0.clone().lu().solve(&coupling.transpose());
    let Some(solved) = solved else { return CMat6::repeat(Complex::new(f64::INFINITY, 0.0)) };
    let total = coupling * solved;
    CMat6::from_fn(|i, j| total[(i, j)])
}

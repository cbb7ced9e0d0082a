//! Ropes that run over sheaves of a linearised robot: the lengths that run from one cable into another are unknowns
//! beside the platform's motion.
//!
//! The length s that runs into a cable moves the end of its material by `d s`, d = λ t, along the tangent t into the
//! cable, and leaves a piece of rope behind that bears the load q. So the force on the platform grows by
//! `−(K d − q) s` with the dynamic stiffness K of the end, and the difference of ψ(T) by `−(d·K d − q·d) s`
//! (docs/theory.md, equation (92g)).

use super::error::RunningRopeRefusal;
use super::{DynamicCableAt, DynamicsError};
use crate::cable::catenary_dynamic::{DriveAt, NearPole};
use crate::cable::{LocalAxes, LocalStiffness};
use crate::math::{CDMat, Complex, Vec3, Vec6};
use crate::robot::Robot;
use crate::statics::CableState;

/// Ropes that run over sheaves.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Sheaves {
    /// First coordinate.
    first: usize,
    /// Number of coordinates: one less than cables in each running part of a rope.
    count: usize,
    /// Coordinates that move the end of each cable of the robot, with their signs; empty for an end that is held.
    of_cables: Vec<Vec<(usize, f64)>>,
    /// Cables of the robot that are in a part of more than two, over a sheave of the frame.
    over_frame: Vec<usize>,
    /// Ends per cable whose stiffness depends on frequency.
    ends: Vec<Option<SheavedEnd>>,
}

/// End of a cable with mass at a sheave.
#[derive(Debug, Clone, PartialEq)]
struct SheavedEnd {
    /// Displacement of its material per length that runs into it (e, n, b).
    direction: [f64; 3],
    /// Coordinates that let rope run into it, with their signs.
    by: Vec<(usize, f64)>,
}

impl SheavedEnd {
    /// Length that runs into the cable [m].
    fn length(&self, coordinates: &[f64]) -> f64 {
        self.by.iter().map(|(place, sign)| sign * coordinates[*place]).sum()
    }
}

/// Running of rope into a cable at rest.
pub(super) struct RunningInto {
    /// Displacement of the end of its material per length.
    pub(super) direction_w: Vec3,
    /// Load per unstrained length [N/m].
    pub(super) load_w: Vec3,
}

impl Sheaves {
    /// Coordinates from `first` on; no cable has an end yet.
    pub(super) fn new(robot: &Robot, first: usize) -> Self {
        let mut sheaves = Self {
            first,
            count: 0,
            of_cables: vec![Vec::new(); robot.cables.len()],
            over_frame: Vec::new(),
            ends: Vec::new(),
        };
        for part in robot.ropes.iter().flat_map(|rope| rope.running_parts()) {
            let Some((last, others)) = part.split_last() else { continue };
            for cable in others {
                let place = first + sheaves.count;
                sheaves.of_cables[*cable].push((place, 1.0));
                sheaves.of_cables[*last].push((place, -1.0));
                sheaves.count += 1;
            }
            if part.len() > 2 {
                sheaves.over_frame.extend(part);
            }
        }
        sheaves
    }

    pub(super) fn first(&self) -> usize {
        self.first
    }

    pub(super) fn count(&self) -> usize {
        self.count
    }

    pub(super) fn of_cable(&self, i: usize) -> &[(usize, f64)] {
        &self.of_cables[i]
    }

    /// Running of rope into cable `i`; `None` if none runs.
    pub(super) fn end(&self, i: usize, state: &CableState) -> Option<RunningInto> {
        let span = state.hanging.as_ref().filter(|_| !self.of_cables[i].is_empty())?;
        let along_w = state.force_on_platform_w.try_normalize(0.0)?;
        let stretch = 1.0 + state.tension_platform / span.catenary.rope().axial_stiffness;
        Some(RunningInto { direction_w: along_w * stretch, load_w: span.load_w() })
    }

    /// Adds cable `i`, whose stiffness depends on frequency, in its local axes.
    ///
    /// # Errors
    /// [`DynamicsError::RunningRope`] for a rope over a sheave of the frame.
    pub(super) fn add_term(
        &mut self,
        robot: &Robot,
        i: usize,
        end: Option<&RunningInto>,
        axes: &LocalAxes,
    ) -> Result<(), DynamicsError> {
        if self.over_frame.contains(&i) {
            let cable = robot.cables[i].name.clone();
            return Err(DynamicsError::RunningRope { cable, reason: RunningRopeRefusal::FrameSheave });
        }
        let LocalAxes { e, n, b } = axes;
        self.ends.push(end.map(|end| SheavedEnd {
            direction: [e, n, b].map(|axis| axis.dot(&end.direction_w)),
            by: self.of_cables[i].clone(),
        }));
        Ok(())
    }

    fn end_of(&self, term: usize) -> Option<&SheavedEnd> {
        self.ends.get(term)?.as_ref()
    }

    /// Adds the stiffness of the end of cable `t` at x = ω_c² without its near poles to the values of coupling and own
    /// stiffness, and its derivative to the slopes.
    pub(super) fn add_rows(
        &self,
        [coupling, own]: [&mut (CDMat, CDMat); 2],
        (t, term): (usize, &DynamicCableAt),
        (square, slope): (Complex, Complex),
        width: f64,
    ) {
        let Some(end) = self.end_of(t) else { return };
        let (stiffness, _) = term.form.complex_beside_poles(square, width);
        add((&mut coupling.0, &mut own.0), term, end, times(&stiffness, &end.direction));
        if slope != Complex::new(0.0, 0.0) {
            let mass = term.form.complex_mass_beside_poles(square, width);
            let force = times(&mass, &end.direction).map(|mass| -slope * mass);
            add((&mut coupling.1, &mut own.1), term, end, force);
        }
    }

    /// Adds the losses of the drive and of the stretch of cable `t` at ω [rad/s].
    pub(super) fn add_drive_losses(
        &self,
        [coupling, own]: [&mut (CDMat, CDMat); 2],
        (t, term): (usize, &DynamicCableAt),
        square: Complex,
        omega: f64,
    ) {
        let Some(end) = self.end_of(t) else { return };
        let whole = times(&term.form.damped(omega), &end.direction);
        let without = times(&term.form.complex_beside_poles(square, 0.0).0, &end.direction);
        let force = std::array::from_fn(|k| whole[k] - without[k]);
        add((&mut coupling.0, &mut own.0), term, end, force);
    }

    /// Participation of the coordinates in a near pole of cable `term`; `count` is that of all coordinates.
    pub(super) fn participation(&self, term: usize, near: &NearPole, count: usize) -> Vec<f64> {
        let mut all = vec![0.0; count];
        if let Some(end) = self.end_of(term) {
            let along: f64 = near.direction.iter().zip(end.direction).map(|(g, d)| g * d).sum();
            end.by.iter().for_each(|(place, sign)| all[*place] += sign * along);
        }
        all
    }

    /// Motions of the drive of cable `term` per coordinate and their derivatives by x, one row per motion; `None` if no
    /// rope runs into it.
    pub(super) fn drive(&self, term: usize, motions: &DriveAt, count: usize) -> Option<Vec<Vec<(Complex, Complex)>>> {
        let end = self.end_of(term)?;
        let zero = Complex::new(0.0, 0.0);
        let along = |row: &[Complex; 3]| row.iter().zip(end.direction).map(|(t, d)| t * d).sum::<Complex>();
        let of = |(row, slope): (&[Complex; 3], &[Complex; 3])| {
            let mut all = vec![(zero, zero); count];
            for (place, sign) in &end.by {
                all[*place].0 += along(row) * sign;
                all[*place].1 += along(slope) * sign;
            }
            all
        };
        Some(motions.transfer.iter().zip(&motions.transfer_slope).map(of).collect())
    }

    /// Displacement (e, n, b) of the end of cable `term` by rope that runs into it [m].
    pub(crate) fn displacement(&self, term: usize, coordinates: &[f64]) -> [f64; 3] {
        self.end_of(term).map_or([0.0; 3], |end| end.direction.map(|d| d * end.length(coordinates)))
    }

    /// Moving mass that running rope adds to each cable whose stiffness depends on frequency, for a scaled motion of
    /// the platform, without near poles [kg m²].
    pub(super) fn added_energies(
        &self,
        terms: &[DynamicCableAt],
        (squares, width): (&[(Complex, Complex)], f64),
        platform: &Vec6,
        coordinates: &[f64],
    ) -> Vec<f64> {
        let of = |(t, term): (usize, &DynamicCableAt)| {
            let Some(end) = self.end_of(t) else { return 0.0 };
            let mass = term.form.complex_mass_beside_poles(squares[t].0, width);
            let moved = times(&mass, &end.direction).map(|mass| mass.re * end.length(coordinates));
            let by_platform = term.displacement(platform);
            let running = self.displacement(t, coordinates);
            (0..3).map(|k| moved[k] * (2.0 * by_platform[k] + running[k])).sum()
        };
        terms.iter().enumerate().map(of).collect()
    }
}

/// Force (e, n, b) of a stiffness against a displacement.
fn times(stiffness: &LocalStiffness<Complex>, [e, n, b]: &[f64; 3]) -> [Complex; 3] {
    let LocalStiffness { axial, coupling, normal, out_of_plane, across } = *stiffness;
    [
        axial * e + coupling * n + across[0] * b,
        coupling * e + normal * n + across[1] * b,
        across[0] * e + across[1] * n + out_of_plane * b,
    ]
}

/// Adds the force against a unit of rope that runs into a cable to the rows of its coordinates.
fn add((coupling, own): (&mut CDMat, &mut CDMat), term: &DynamicCableAt, end: &SheavedEnd, force: [Complex; 3]) {
    let resistance: Complex = force.iter().zip(end.direction).map(|(f, d)| f * d).sum();
    for (column, sign) in &end.by {
        for (f, axis) in force.iter().zip(term.axes()) {
            (0..6).for_each(|r| coupling[(r, *column)] += f * (axis[r] * sign));
        }
        for (row, other) in &end.by {
            own[(*row, *column)] += resistance * (sign * other);
        }
    }
}

//! Robot as a pencil whose lowest eigenvalue is sought: platform, and cables side by side.

use super::batched_cable::{CableGroup, CableSpan, KeptStiffness};
use super::lever_axes::{LeverAxes, RobotMotion};
use crate::cable::catenary_dynamic::MovingEnd;
use crate::cable::{LocalAxes, Sag, moving_end};
use crate::catenary::space::HangingCable;
use crate::dynamics::{self, PlatformTerms};
use crate::math::simd::{LANES, Line, Part, sum};
use crate::math::{Mat6, Vec3, Vec6};
use crate::robot::{PlatformMotion, Robot, WinchMode};
use crate::statics::Equilibrium;
use pulp::Simd;
use std::array::from_fn;
use std::f64::consts::TAU;

/// Pencil K − xM of a robot about its equilibrium.
pub(super) struct RobotPencil {
    pub(super) dof: usize,
    /// Motions that the platform has.
    pub(super) motions: PlatformMotion,
    /// Mean distance of the attachments from the platform origin [m].
    pub(super) ell: f64,
    /// Stiffness that does not depend on frequency; scaled, in the platform's coordinates.
    pub(super) constant: Mat6,
    /// Mass of the platform; scaled, in the platform's coordinates.
    pub(super) mass: Mat6,
    /// Columns of the mass.
    mass_columns: [Line; 6],
    /// Axes of the cables with mass, per group.
    pub(super) lever_axes: Vec<LeverAxes>,
    /// Indices of the cables of each group.
    pub(super) members: Vec<Vec<usize>>,
    /// Cables side by side.
    pub(super) groups: Vec<CableGroup>,
    /// Number of cables of the robot, those without mass included.
    pub(super) cable_count: usize,
    /// True if a wheel, a swivel, a drum or a motor has mass.
    pub(super) has_drive_mass: bool,
}

/// Limit of the frequencies for which drives are discretised, over the frequency of the taut string. Only a drum side
/// with mass depends on it, by the phase of its axial waves, which is small at these frequencies.
const ABOVE_STRING: f64 = 2.0;

impl RobotPencil {
    /// Pencil of a robot; `None` if a cable does not hang, has no tension or a point without tension, or if its end
    /// couples motions in plane and out of plane.
    pub(super) fn new(robot: &Robot, equilibrium: &Equilibrium) -> Option<Self> {
        let PlatformTerms { mut constant, mass, coordinates } = dynamics::platform_terms(robot, equilibrium);

        // Collect the cables with mass or with a drive that has mass, and add the stiffness of the others.
        let mut massive = Vec::with_capacity(equilibrium.cables.len());
        let mut spans = Vec::with_capacity(equilibrium.cables.len());
        let mut has_drive_mass = false;
        for (i, state) in equilibrium.cables.iter().enumerate() {
            let hanging = state.hanging.as_ref()?;
            let mass_per_length = robot.cables[i].material.mass_per_length;
            if hanging.catenary.parallel_tension() <= 0.0 {
                return None;
            }

            let end = state.drive.as_ref().and_then(|_| {
                let limit = ABOVE_STRING * TAU * Sag::of(robot, i, state).string_frequency_hz();
                let axes = LocalAxes::of_hanging(hanging);
                moving_end(robot, i, state, &axes, WinchMode::default(), limit)
            });
            if end.as_ref().is_some_and(MovingEnd::couples) {
                return None;
            }
            if mass_per_length == 0.0 && !end.as_ref().is_some_and(MovingEnd::has_dynamics) {
                constant += dynamics::constant_cable(robot, state, &state.tangent_w()?);
                continue;
            }

            has_drive_mass |= end.as_ref().is_some_and(MovingEnd::has_mass);
            massive.push((i, hanging));
            spans.push(CableSpan { catenary: &hanging.catenary, mass_per_length, end });
        }

        // Groups of cables side by side, with their axes.
        let groups = CableGroup::groups(&spans)?;
        let reduce = |force: &Vec3, lever: &Vec3| coordinates.reduce_force(force, lever);
        let axes = |group: &CableGroup| lever_axes_of(group, &massive, equilibrium, reduce);
        let lever_axes = groups.iter().map(axes).collect();
        let cables_of = |group: &CableGroup| group.members().iter().map(|at| massive[*at].0).collect();
        let members = groups.iter().map(cables_of).collect();

        let mass_columns = from_fn(|j| Line(from_fn(|i| if i < 6 { mass[(i, j)] } else { 0.0 })));
        let (dof, cable_count) = (coordinates.count(), robot.cables.len());
        let (motions, ell) = (coordinates.motion(), coordinates.ell());
        Some(Self {
            dof,
            motions,
            ell,
            constant,
            mass,
            mass_columns,
            lever_axes,
            members,
            groups,
            cable_count,
            has_drive_mass,
        })
    }

    /// Start vector number `number`. Its fixed quasi-random entries make orthogonality to a mode practically
    /// impossible.
    pub(super) fn any_motion(&self, masses: &[KeptStiffness], number: usize) -> RobotMotion {
        // Entries evenly distributed over their range, with both signs except for number 0.
        let entry = |i: usize| {
            let even = ((i + 97 * number) as f64 * 0.754_877_666).fract();
            if number == 0 { 1.0 - 0.618 * even } else { 1.0 - 2.0 * even }
        };
        let mut motion = RobotMotion::any(masses.len());
        *motion.platform_mut() = from_fn(|i| if i < self.dof { entry(i) } else { 0.0 });
        let mut next = 6;
        for (group, (mass, members)) in masses.iter().zip(&self.members).enumerate() {
            for (line, mass) in motion.bubbles_mut(group).into_iter().zip([&mass.in_plane[5], &mass.out_of_plane[2]]) {
                let used = members.len();
                // An unknown without mass follows the others.
                *line = Line(from_fn(|i| {
                    let moves = i < used && mass[i] > 0.0;
                    if moves { (self.mass[(0, 0)] / mass[i]).sqrt() * entry(next + i) } else { 0.0 }
                }));
                next += used;
            }
        }
        motion
    }

    /// Computes B y with the masses of the condensed cables, for inverse iteration; any positive definite B would do.
    #[inline(always)]
    pub(super) fn inertia<S: Simd>(&self, simd: S, masses: &[KeptStiffness], y: &RobotMotion, into: &mut RobotMotion) {
        let motion = y.platform();
        let mut platform = [0.0; LANES];
        for part in Part::all(simd) {
            let mut sum = part.splat(0.0);
            for (column, by) in self.mass_columns.iter().zip(motion) {
                sum = part.mul_add(part.of(column), part.splat(*by), sum);
            }
            part.set(&mut platform, sum);
        }

        // Cables, and the forces of their ends on the platform.
        for (group, (lever_axes, mass)) in self.lever_axes.iter().zip(masses).enumerate() {
            let [q, p] = y.bubbles(group);
            let [force_q, force_p] = into.bubbles_mut(group);
            let mut wrench = [[0.0; LANES]; 6];
            for part in Part::all(simd) {
                let mut in_plane = [part.splat(0.0); 6];
                for (entry, mass) in in_plane.iter_mut().zip(&mass.in_plane) {
                    *entry = part.of(mass);
                }
                let [nn, en, ee, qn, qe, qq] = in_plane;
                let [oo, bo, bb] =
                    [part.of(&mass.out_of_plane[0]), part.of(&mass.out_of_plane[1]), part.of(&mass.out_of_plane[2])];

                let ([n, e, b], q, p) = (lever_axes.ends(part, motion), part.of(q), part.of(p));

                let forces = [
                    part.mul_add(nn, n, part.mul_add(en, e, part.mul(qn, q))),
                    part.mul_add(en, n, part.mul_add(ee, e, part.mul(qe, q))),
                    part.mul_add(oo, b, part.mul(bo, p)),
                ];
                part.set(force_q, part.mul_add(qn, n, part.mul_add(qe, e, part.mul(qq, q))));
                part.set(force_p, part.mul_add(bo, b, part.mul(bb, p)));
                for (i, wrench) in wrench.iter_mut().enumerate() {
                    part.set(wrench, lever_axes.wrench(part, i, forces));
                }
            }

            for (platform, wrench) in platform.iter_mut().zip(&wrench) {
                *platform += sum(wrench);
            }
        }
        *into.platform_mut() = platform;
    }

    /// Product `aᵀ M b` of the platform alone.
    pub(super) fn platform_mass(&self, a: &RobotMotion, b: &RobotMotion) -> f64 {
        let [a, b] = [a, b].map(|motion| Vec6::from_column_slice(&motion.platform()[..6]));
        a.dot(&(self.mass * b))
    }
}

/// Lever axes of a group of the cables with mass, which are given with their indices in the robot. `reduce` gives a
/// force on a lever arm in the platform's coordinates.
fn lever_axes_of(
    group: &CableGroup,
    massive: &[(usize, &HangingCable)],
    equilibrium: &Equilibrium,
    reduce: impl Fn(&Vec3, &Vec3) -> Vec6,
) -> LeverAxes {
    let mut axes = LeverAxes::default();
    for (lane, at) in group.members().iter().enumerate() {
        let (cable, hanging) = massive[*at];
        let (level_w, up_w) = hanging.axes_w();
        let [cos, sin] = group.axis(lane);
        let (e, n) = (level_w * cos + up_w * sin, up_w * cos - level_w * sin);
        let lever = &equilibrium.cables[cable].lever_w;
        axes.set(lane, [n, e, e.cross(&n)].map(|u| reduce(&u, lever)));
    }
    axes
}

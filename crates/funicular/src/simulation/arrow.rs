//! Newton's corrections of a motion: the matrix of platform and ropes as an arrow, the ropes first, the platform last.

use super::body::{BodyMotion, halves, joined};
use super::far_border::FarBorder;
use super::far_end::FarEnd;
use super::rope::{Newton, RopeMesh, WoundLength};
use super::side_by_side::{FactorPack, RopesInMotion};
use super::skyline::{NotPositive, Profile3, Skyline};
use super::system::{MotionNumbers, RopeEnd, System, six, three};
use crate::math::{DMat, DVec, Mat3, Mat6, Vec3, inverse6, skew};

/// Factored Newton matrix of the system.
#[derive(Clone)]
pub(super) struct Arrow {
    factors: Vec<Skyline>,
    /// The factors side by side, with the right-hand sides.
    packs: Vec<FactorPack>,
    /// Borders of the ropes whose far end moves.
    borders: Vec<Option<FarBorder>>,
    /// Translation of each attached end for a turn of the platform, `−R [a]×`.
    turns: Vec<Mat3>,
    /// Supports between ropes and platform.
    supports: SupportBlock,
    /// Inverse of the matrix of the platform's coordinates.
    inverse: Mat6,
    /// Work space: right-hand side of a rope in the order of its rows.
    rows: Vec<f64>,
}

/// Supports in the matrix.
#[derive(Clone)]
struct SupportBlock {
    /// Inverse of their own matrix.
    inverse: DMat,
    /// Between supports (rows) and platform.
    by_body: DMat,
    /// Right-hand side.
    needed: DVec,
}

impl Arrow {
    pub(super) fn new(system: &System) -> Self {
        let shape = |rope: &RopeMesh| Skyline::zeros(Profile3::new(rope.elements, rope.basis.degree));
        let border = |(rope, far): (&RopeMesh, &Option<FarEnd>)| far.as_ref().map(|far| FarBorder::new(rope, far));
        let supports = 3 * system.supports.len();
        Self {
            factors: system.ropes.iter().map(shape).collect(),
            packs: Vec::new(),
            borders: system.ropes.iter().zip(&system.far_ends).map(border).collect(),
            turns: vec![Mat3::zeros(); system.ropes.len()],
            supports: SupportBlock {
                inverse: DMat::zeros(supports, supports),
                by_body: DMat::zeros(supports, 6),
                needed: DVec::zeros(supports),
            },
            inverse: Mat6::identity(),
            rows: Vec::new(),
        }
    }

    /// Factors the Newton matrix at a motion, whose needed forces are `needed`.
    ///
    /// # References
    /// docs/theory.md, equations (97h), (97i) and (97p).
    pub(super) fn factor(
        &mut self,
        system: &System,
        time: f64,
        lengths: &[WoundLength],
        m: &MotionNumbers,
        needed: &[f64],
        of: Newton,
    ) -> Result<(), NotPositive> {
        let body = system.body_motion(m);
        let mut matrix = system.body.matrix(&body, of.mass, of.damping, of.stiffness);
        let mut of_supports = supports_alone(system, of);
        self.supports.by_body.fill(0.0);
        let free: Vec<WoundLength> = (0..lengths.len()).map(|i| system.free_length(i, &lengths[i], m)).collect();
        let packs = self.factor_ropes(system, time, &free, m, of)?;
        for pack in &packs {
            for (lane, i) in pack.ropes.iter().copied().enumerate() {
                let mut kept = Mat6::zeros();
                kept.fixed_view_mut::<3, 3>(0, 0).copy_from(&pack.complement(&self.factors[i], lane));
                if let Some(far) = &mut self.borders[i] {
                    pack.copy(lane, &mut self.factors[i]);
                    kept += far.factor((system, i), (time, &lengths[i]), m, needed, of, &self.factors[i])?;
                }
                let force_w = three(needed, system.offsets[i]);
                self.add_rope((system, i), &body, &kept, force_w, of, (&mut matrix, &mut of_supports));
            }
        }
        self.packs = packs;
        if !system.supports.is_empty() {
            self.supports.inverse = of_supports.try_inverse().ok_or(NotPositive)?;
            let lost = self.supports.by_body.transpose() * &self.supports.inverse * &self.supports.by_body;
            matrix -= Mat6::from_iterator(lost.iter().copied());
        }
        self.inverse = inverse6(&system.body.reduced_matrix(&matrix)).ok_or(NotPositive)?;
        Ok(())
    }

    /// Factors of the ropes alone, whose free lengths are `free`.
    fn factor_ropes(
        &mut self,
        system: &System,
        time: f64,
        free: &[WoundLength],
        m: &MotionNumbers,
        of: Newton,
    ) -> Result<Vec<FactorPack>, NotPositive> {
        for (factor, end) in self.factors.iter_mut().zip(&system.ends) {
            factor.keep_end(*end == RopeEnd::Attached);
        }
        let on_node = |(i, rope): (usize, &RopeMesh)| rope.on_node(system.air.on_rope(i, time).first(), of);
        let on_nodes: Vec<f64> = system.ropes.iter().enumerate().map(on_node).collect();
        let ropes = RopesInMotion {
            ropes: &system.ropes,
            offsets: &system.offsets,
            lengths: free,
            on_nodes: &on_nodes,
            motion: [&m.x, &m.v],
        };

        let mut packs = FactorPack::of(&system.ropes, |i| system.ends[i] == RopeEnd::Gone, &self.factors);
        for pack in &mut packs {
            pack.assemble(&self.factors, &ropes, of);
            pack.factor(&self.factors)?;
        }
        Ok(packs)
    }

    /// Adds what end and support of rope `i` keep to the matrices of platform and supports. `force_w` is the force that
    /// the end needs.
    fn add_rope(
        &mut self,
        (system, i): (&System, usize),
        body: &BodyMotion,
        kept: &Mat6,
        force_w: Vec3,
        of: Newton,
        (matrix, of_supports): (&mut Mat6, &mut DMat),
    ) {
        let support = system.far_ends[i].as_ref().and_then(|far| far.support).map(|support| 3 * support.index);
        if let Some(row) = support {
            let mut own = of_supports.fixed_view_mut::<3, 3>(row, row);
            own += kept.fixed_view::<3, 3>(3, 3);
        }
        if system.ends[i] != RopeEnd::Attached {
            return;
        }

        let complement: Mat3 = kept.fixed_view::<3, 3>(0, 0).into_owned();
        let lever = system.body.lever_p(i);
        let turn = -body.rot_wp * skew(&lever);
        let by_turn = complement * turn;
        let force_p = body.rot_wp.transpose() * force_w;
        let mut add = |row, column, block: &Mat3| {
            let mut view = matrix.fixed_view_mut::<3, 3>(row, column);
            view += block;
        };
        add(0, 0, &complement);
        add(0, 3, &by_turn);
        add(3, 0, &by_turn.transpose());
        add(3, 3, &(turn.transpose() * by_turn + skew(&lever) * skew(&force_p) * of.stiffness));
        if let Some(row) = support {
            let mixed: Mat3 = kept.fixed_view::<3, 3>(3, 0).into_owned();
            let mut view = self.supports.by_body.fixed_view_mut::<3, 3>(row, 0);
            view += mixed;
            let mut view = self.supports.by_body.fixed_view_mut::<3, 3>(row, 3);
            view += mixed * turn;
        }
        self.turns[i] = turn;
    }

    /// Correction of the velocities that takes the needed forces to zero, written over them.
    pub(super) fn solve(&mut self, system: &System, needed: &mut [f64]) {
        let mut on_body = six(needed);
        for index in 0..system.supports.len() {
            let force = three(needed, System::of_support(index).start);
            self.supports.needed.fixed_rows_mut::<3>(3 * index).copy_from(&force);
        }
        for pack in &mut self.packs {
            for lane in 0..pack.ropes.len() {
                pack.put(lane, &needed[system.inner_nodes(pack.ropes[lane])]);
            }
            pack.forward(&self.factors);
            for (lane, i) in pack.ropes.iter().copied().enumerate() {
                let mut passed = pack.received(lane);
                if let Some(far) = &mut self.borders[i] {
                    pack.rows_of(lane, &mut self.rows);
                    let [on_end, on_support] = far.forward(&self.rows, &needed[system.of_far_end(i)]);
                    passed += on_end;
                    if let Some(support) = system.far_ends[i].as_ref().and_then(|far| far.support) {
                        let mut view = self.supports.needed.fixed_rows_mut::<3>(3 * support.index);
                        view -= on_support;
                    }
                }
                if system.ends[i] == RopeEnd::Attached {
                    on_body -= joined(&passed, &self.turns[i].tr_mul(&passed));
                }
            }
        }
        let held = &self.supports.inverse * &self.supports.needed;
        on_body -= six((self.supports.by_body.transpose() * &held).as_slice());

        let move_of_body = -system.body.expanded(&(self.inverse * system.body.reduced(&on_body)));
        needed[..6].copy_from_slice(move_of_body.as_slice());
        let by_body = DVec::from_column_slice(move_of_body.as_slice());
        let of_supports = -held - &self.supports.inverse * (&self.supports.by_body * by_body);
        for index in 0..system.supports.len() {
            needed[System::of_support(index)].copy_from_slice(&of_supports.as_slice()[3 * index..3 * index + 3]);
        }
        self.move_ropes(system, &of_supports, needed);
    }

    /// Corrections of the ropes for those of the platform, which stand in `needed`, and of the supports.
    fn move_ropes(&mut self, system: &System, of_supports: &DVec, needed: &mut [f64]) {
        let (translation, turn) = halves(&six(needed));
        for (i, end) in system.ends.iter().enumerate() {
            if *end == RopeEnd::Gone {
                needed[system.of_rope(i)].fill(0.0);
                needed[system.of_far_end(i)].fill(0.0);
            }
        }
        for pack in &mut self.packs {
            for lane in 0..pack.ropes.len() {
                let i = pack.ropes[lane];
                let is_attached = system.ends[i] == RopeEnd::Attached;
                let of_end = if is_attached { translation + self.turns[i] * turn } else { Vec3::zeros() };
                if let Some(far) = &mut self.borders[i] {
                    let support = system.far_ends[i].as_ref().and_then(|far| far.support);
                    let of_support =
                        support.map_or_else(Vec3::zeros, |support| three(of_supports.as_slice(), 3 * support.index));
                    pack.rows_of(lane, &mut self.rows);
                    far.backward(&mut self.rows, &of_end, &of_support);
                    pack.set_rows(lane, &self.rows);
                    needed[system.of_far_end(i)].copy_from_slice(far.z.as_slice());
                }
                // `backward` subtracts; the correction has the opposite sign of the right-hand side.
                pack.set_end(lane, &-of_end);
            }
            pack.backward(&self.factors);
            for (lane, i) in pack.ropes.iter().copied().enumerate() {
                let inner = system.inner_nodes(i);
                pack.take(lane, &mut needed[inner.clone()]);
                if system.ends[i] == RopeEnd::Attached {
                    let of_end = pack.received(lane);
                    needed[inner.start..inner.start + 3].copy_from_slice((-of_end).as_slice());
                }
                needed[inner.end..inner.end + 3].fill(0.0);
            }
        }
    }
}

/// Matrix of the supports without their ropes.
fn supports_alone(system: &System, of: Newton) -> DMat {
    let size = 3 * system.supports.len();
    let mut matrix = DMat::zeros(size, size);
    for (index, support) in system.supports.iter().enumerate() {
        let own = support.stiffness_w * (of.stiffness + of.damping * support.damping_time)
            + Mat3::identity() * (support.mass * of.mass);
        matrix.fixed_view_mut::<3, 3>(3 * index, 3 * index).copy_from(&own);
    }
    matrix
}

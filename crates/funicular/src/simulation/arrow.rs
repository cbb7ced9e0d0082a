//! Newton's corrections of a motion: the matrix of platform and ropes as an arrow, the ropes first, the platform last.

use super::body::{halves, joined};
use super::far_end::FarEnd;
use super::rope::{Border, Newton, RopeMesh, WoundLength};
use super::skyline::{NotPositive, Profile3, Skyline};
use super::system::{MotionNumbers, RopeEnd, System, six, three};
use crate::math::{DMat, DVec, Mat3, Mat6, Vec3, inverse6, skew};

/// Factored Newton matrix of the system.
pub(super) struct Arrow {
    factors: Vec<Skyline>,
    /// Borders of the ropes whose far end moves.
    borders: Vec<Option<FarBorder>>,
    /// Stiffness of each attached end as the platform meets it.
    complements: Vec<Mat3>,
    /// Translation of each attached end for a turn of the platform, `−R [a]×`.
    turns: Vec<Mat3>,
    /// Inverse of the matrix of the supports, between them and the platform, and both multiplied.
    posts: Posts,
    /// Inverse of the matrix of the platform's coordinates.
    inverse: Mat6,
    /// Work space: right-hand sides of the ropes in the order of their rows.
    rows: Vec<Vec<f64>>,
}

/// Supports in the matrix.
struct Posts {
    inverse: DMat,
    /// Between supports (rows) and platform.
    by_body: DMat,
    /// Right-hand side.
    needed: DVec,
}

/// Far end of a rope in the matrix: its own numbers z, behind them the end of the rope at the platform and the support.
struct FarBorder {
    border: Border,
    /// Forward solutions of the columns of z and of the support, in the order of the rope's rows.
    columns: Vec<Vec<f64>>,
    /// Inverse of the matrix of z.
    inverse: DMat,
    /// Between z and the six numbers of end and support.
    outer: DMat,
    /// Number of numbers z.
    count: usize,
    /// Numbers z of a correction.
    z: DVec,
    /// Direction in which the last node moves with the swivel, and its number.
    swivel: Option<(usize, Vec3)>,
    /// True for numbers z that do not move.
    is_held: Vec<bool>,
}

/// Numbers of end and support behind z.
const OUTER: usize = 6;

impl Arrow {
    pub(super) fn new(system: &System) -> Self {
        let shape = |rope: &RopeMesh| Skyline::zeros(Profile3::new(rope.elements, rope.basis.degree));
        let border = |(rope, far): (&RopeMesh, &Option<FarEnd>)| far.as_ref().map(|far| FarBorder::new(rope, far));
        let posts = 3 * system.posts.len();
        Self {
            factors: system.ropes.iter().map(shape).collect(),
            borders: system.ropes.iter().zip(&system.far_ends).map(border).collect(),
            complements: vec![Mat3::zeros(); system.ropes.len()],
            turns: vec![Mat3::zeros(); system.ropes.len()],
            posts: Posts {
                inverse: DMat::zeros(posts, posts),
                by_body: DMat::zeros(posts, 6),
                needed: DVec::zeros(posts),
            },
            inverse: Mat6::identity(),
            rows: system.ropes.iter().map(|rope| vec![0.0; rope.size() - 3]).collect(),
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
        let mut of_posts = posts_alone(system, of);
        self.posts.by_body.fill(0.0);
        for (i, rope) in system.ropes.iter().enumerate() {
            let (range, end) = (system.of_rope(i), system.ends[i]);
            if end == RopeEnd::Gone {
                continue;
            }
            let wind = system.air.on_rope(i, time);
            let free = system.free_length(i, &lengths[i], m);
            let factor = &mut self.factors[i];
            rope.assemble(&free, &wind, &m.x[range.clone()], &m.v[range.clone()], of, factor);
            let is_attached = end == RopeEnd::Attached;
            let mut complement = factor.factor(is_attached)?;
            let mut by_post = None;
            if let Some(far) = &mut self.borders[i] {
                let outer = far.factor((system, i), (time, &lengths[i]), m, needed, of, factor)?;
                complement += outer.fixed_view::<3, 3>(0, 0);
                by_post = system.far_ends[i].as_ref().and_then(|far| far.support).map(|post| (post.index, outer));
            }
            if let Some((index, outer)) = &by_post {
                let mut own = of_posts.fixed_view_mut::<3, 3>(3 * index, 3 * index);
                own += outer.fixed_view::<3, 3>(3, 3);
            }
            if !is_attached {
                continue;
            }

            let lever = system.body.lever_p(i);
            let turn = -body.rot_wp * skew(&lever);
            let by_turn = complement * turn;
            let force_p = body.rot_wp.transpose() * three(needed, range.start);
            let mut add = |row, column, block: &Mat3| {
                let mut view = matrix.fixed_view_mut::<3, 3>(row, column);
                view += block;
            };
            add(0, 0, &complement);
            add(0, 3, &by_turn);
            add(3, 0, &by_turn.transpose());
            add(3, 3, &(turn.transpose() * by_turn + skew(&lever) * skew(&force_p) * of.stiffness));
            if let Some((index, outer)) = by_post {
                let mixed: Mat3 = outer.fixed_view::<3, 3>(3, 0).into_owned();
                let mut view = self.posts.by_body.fixed_view_mut::<3, 3>(3 * index, 0);
                view += mixed;
                let mut view = self.posts.by_body.fixed_view_mut::<3, 3>(3 * index, 3);
                view += mixed * turn;
            }
            self.complements[i] = complement;
            self.turns[i] = turn;
        }
        if !system.posts.is_empty() {
            self.posts.inverse = of_posts.try_inverse().ok_or(NotPositive)?;
            let lost = self.posts.by_body.transpose() * &self.posts.inverse * &self.posts.by_body;
            matrix -= Mat6::from_iterator(lost.iter().copied());
        }
        self.inverse = inverse6(&system.body.reduced_matrix(&matrix)).ok_or(NotPositive)?;
        Ok(())
    }

    /// Correction of the velocities that takes the needed forces to zero, written over them.
    pub(super) fn solve(&mut self, system: &System, needed: &mut [f64]) {
        let mut on_body = six(needed);
        for index in 0..system.posts.len() {
            let force = three(needed, System::of_post(index).start);
            self.posts.needed.fixed_rows_mut::<3>(3 * index).copy_from(&force);
        }
        for (i, rope) in system.ropes.iter().enumerate() {
            let end = system.ends[i];
            if end == RopeEnd::Gone {
                continue;
            }
            let (from, free) = (system.offsets[i], rope.last());
            let rows = &mut self.rows[i];
            for node in 0..free {
                let row = 3 * (free - 1 - node);
                rows[row..row + 3].copy_from_slice(&needed[from + 3 * node..from + 3 * node + 3]);
            }
            let mut passed = self.factors[i].forward(rows);
            if let Some(far) = &mut self.borders[i] {
                let [on_end, on_post] = far.forward(rows, &needed[system.of_far_end(i)]);
                passed += on_end;
                if let Some(post) = system.far_ends[i].as_ref().and_then(|far| far.support) {
                    let mut view = self.posts.needed.fixed_rows_mut::<3>(3 * post.index);
                    view -= on_post;
                }
            }
            if end == RopeEnd::Attached {
                on_body -= joined(&passed, &self.turns[i].tr_mul(&passed));
            }
        }
        let held = &self.posts.inverse * &self.posts.needed;
        on_body -= six((self.posts.by_body.transpose() * &held).as_slice());

        let move_of_body = -system.body.expanded(&(self.inverse * system.body.reduced(&on_body)));
        let (translation, turn) = halves(&move_of_body);
        needed[..6].copy_from_slice(move_of_body.as_slice());
        let by_body = DVec::from_column_slice(move_of_body.as_slice());
        let of_posts = -held - &self.posts.inverse * (&self.posts.by_body * by_body);
        for index in 0..system.posts.len() {
            needed[System::of_post(index)].copy_from_slice(&of_posts.as_slice()[3 * index..3 * index + 3]);
        }
        for (i, rope) in system.ropes.iter().enumerate() {
            let end = system.ends[i];
            let (from, free) = (system.offsets[i], rope.last());
            let far_range = system.of_far_end(i);
            if end == RopeEnd::Gone {
                needed[from..from + rope.size()].fill(0.0);
                needed[far_range].fill(0.0);
                continue;
            }
            let is_attached = end == RopeEnd::Attached;
            let of_end = if is_attached { translation + self.turns[i] * turn } else { Vec3::zeros() };
            let rows = &mut self.rows[i];
            if let Some(far) = &mut self.borders[i] {
                let post = system.far_ends[i].as_ref().and_then(|far| far.support);
                let of_post = post.map_or_else(Vec3::zeros, |post| three(of_posts.as_slice(), 3 * post.index));
                far.backward(rows, &of_end, &of_post);
                needed[far_range].copy_from_slice(far.z.as_slice());
            }
            // `backward` subtracts; the correction has the opposite sign of the right-hand side.
            self.factors[i].backward(rows, &-of_end);
            for node in 0..free {
                let row = 3 * (free - 1 - node);
                for axis in 0..3 {
                    needed[from + 3 * node + axis] = -rows[row + axis];
                }
            }
            if is_attached {
                needed[from..from + 3].copy_from_slice(of_end.as_slice());
            }
            needed[from + 3 * free..from + 3 * free + 3].fill(0.0);
        }
    }
}

/// Matrix of the supports without their ropes.
fn posts_alone(system: &System, of: Newton) -> DMat {
    let size = 3 * system.posts.len();
    let mut matrix = DMat::zeros(size, size);
    for (index, post) in system.posts.iter().enumerate() {
        let own = post.stiffness_w * (of.stiffness + of.damping * post.damping_time)
            + Mat3::identity() * (post.mass * of.mass);
        matrix.fixed_view_mut::<3, 3>(3 * index, 3 * index).copy_from(&own);
    }
    matrix
}

impl FarBorder {
    fn new(rope: &RopeMesh, far: &FarEnd) -> Self {
        let count = far.places().count;
        let columns = count + if far.support.is_some() { 3 } else { 0 };
        Self {
            border: Border::new(rope),
            columns: vec![vec![0.0; rope.size() - 3]; columns],
            inverse: DMat::zeros(count, count),
            outer: DMat::zeros(count, OUTER),
            count,
            z: DVec::zeros(count),
            swivel: None,
            is_held: vec![false; count],
        }
    }

    /// Factors the far end of rope `i`, whose own matrix is factored; the result is what it adds to the complement of
    /// end and support.
    fn factor(
        &mut self,
        (system, i): (&System, usize),
        (time, given): (f64, &WoundLength),
        m: &MotionNumbers,
        needed: &[f64],
        of: Newton,
        factor: &Skyline,
    ) -> Result<Mat6, NotPositive> {
        let Some(far) = &system.far_ends[i] else { return Ok(Mat6::zeros()) };
        let (rope, range) = (&system.ropes[i], system.of_rope(i));
        let free = system.free_length(i, given, m);
        rope.border(&free, &m.x[range.clone()], &m.v[range], of, &mut self.border);
        let state = system.far_state(i, time, given, m, needed);
        let forces = far.forces(&state);
        let (places, last) = (far.places(), rope.last());
        let swivel = places.swivel.map_or(0.0, |at| state.z[0][at]);
        self.swivel = places.swivel.zip(far.sideways_w(swivel));

        // Own matrix of z and support, without the rope's inner nodes.
        let size = self.count + 3;
        let mut own = DMat::zeros(size, size);
        let end = self.border.by_end[rope.basis.degree];
        let length_by_end = three(&self.border.by_length, 3 * last);
        if let (Some(feed), Some(at)) = (&far.feed, places.feed) {
            own[(at, at)] += self.border.of_length;
            let scale = feed.stretch * feed.stretch;
            let of_feed = &forces.feed;
            for j in 0..feed.count() {
                own[(at + j, at + j)] += scale * feed.masses[j] * of.mass
                    + of_feed.stiffness[j] * of.stiffness
                    + of_feed.damping[j] * of.damping;
                if j + 1 < feed.count() {
                    let coupling = of_feed.coupling[j] * of.stiffness;
                    own[(at + j, at + j + 1)] += coupling;
                    own[(at + j + 1, at + j)] += coupling;
                }
            }
            for axis in 0..3 {
                let mut by_post = length_by_end[axis];
                // A drum side from the ground is stretched by the support.
                by_post += of_feed.stiffness[0] * forces.post_along_w[axis] * of.stiffness;
                own[(at, self.count + axis)] += by_post;
                own[(self.count + axis, at)] += by_post;
            }
            let along = forces.post_along_w * forces.post_along_w.transpose() * (of_feed.stiffness[0] * of.stiffness);
            let mut view = own.fixed_view_mut::<3, 3>(self.count, self.count);
            view += along;
        }
        if let Some(at) = places.integral {
            own[(at, at)] += of.mass.max(1.0);
        }
        if let Some((at, sideways_w)) = self.swivel {
            own[(at, at)] += sideways_w.dot(&(end * sideways_w))
                + forces.swivel_mass * of.mass
                + forces.swivel_stiffness * of.stiffness;
            if let Some(length) = places.feed {
                let coupling = length_by_end.dot(&sideways_w);
                own[(at, length)] += coupling;
                own[(length, at)] += coupling;
            }
            let by_post = end * sideways_w;
            for axis in 0..3 {
                own[(at, self.count + axis)] += by_post[axis];
                own[(self.count + axis, at)] += by_post[axis];
            }
        }
        let mut view = own.fixed_view_mut::<3, 3>(self.count, self.count);
        view += end + forces.post_stiffness_w * of.stiffness;

        self.eliminate(far, rope, factor, &own)
    }

    /// Columns of the rope's inner nodes for z and support, and what stays after them.
    fn eliminate(&mut self, far: &FarEnd, rope: &RopeMesh, factor: &Skyline, own: &DMat) -> Result<Mat6, NotPositive> {
        let places = far.places();
        let mut on_end = vec![Vec3::zeros(); self.columns.len()];
        for (k, column) in self.columns.iter_mut().enumerate() {
            column.fill(0.0);
            let is_length = places.feed == Some(k);
            let direction_w = match self.swivel {
                Some((at, sideways_w)) if at == k => Some(sideways_w),
                _ if k >= self.count => Some(Vec3::ith(k - self.count, 1.0)),
                _ => None,
            };
            if !is_length && direction_w.is_none() {
                continue;
            }
            let mut put = |node: usize, value: &Vec3| {
                let row = 3 * (rope.last() - 1 - node);
                for axis in 0..3 {
                    column[row + axis] += value[axis];
                }
            };
            if is_length {
                (0..rope.last()).for_each(|node| put(node, &three(&self.border.by_length, 3 * node)));
            }
            if let Some(direction_w) = direction_w {
                let first = rope.last() - rope.basis.degree;
                for (q, block) in self.border.by_end[..rope.basis.degree].iter().enumerate() {
                    put(first + q, &(block * direction_w));
                }
            }
            // The node on the platform keeps its own numbers.
            let kept = factor.take_kept(column);
            on_end[k] = kept - factor.forward(column);
        }

        // Schur complement of z, end and support.
        let mut outer = DMat::zeros(self.count, OUTER);
        let mut core = own.view((0, 0), (self.count, self.count)).into_owned();
        let mut left = Mat6::zeros();
        let posts = self.columns.len() - self.count;
        let inner = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
        for k in 0..self.count {
            for l in 0..=k {
                let lost = inner(&self.columns[k], &self.columns[l]);
                core[(k, l)] -= lost;
                if k != l {
                    core[(l, k)] -= lost;
                }
            }
            for axis in 0..3 {
                outer[(k, axis)] = on_end[k][axis];
            }
            for axis in 0..posts {
                outer[(k, 3 + axis)] =
                    own[(k, self.count + axis)] - inner(&self.columns[k], &self.columns[self.count + axis]);
            }
        }
        for row in 0..posts {
            for column in 0..posts {
                left[(3 + row, 3 + column)] = own[(self.count + row, self.count + column)]
                    - inner(&self.columns[self.count + row], &self.columns[self.count + column]);
            }
            for axis in 0..3 {
                left[(3 + row, axis)] = on_end[self.count + row][axis];
                left[(axis, 3 + row)] = on_end[self.count + row][axis];
            }
        }
        self.fix(far, &mut core, &mut outer);
        if self.count > 0 {
            self.inverse = core.try_inverse().ok_or(NotPositive)?;
            let lost = outer.transpose() * &self.inverse * &outer;
            left -= Mat6::from_iterator(lost.iter().copied());
        }
        self.outer = outer;
        Ok(left)
    }

    /// Takes numbers that do not move out of the matrix: a station that follows its command, a swivel on its axis.
    fn fix(&mut self, far: &FarEnd, core: &mut DMat, outer: &mut DMat) {
        let places = far.places();
        let is_held = &mut self.is_held;
        is_held.fill(false);
        let mut hold = |k: usize| {
            is_held[k] = true;
            core.row_mut(k).fill(0.0);
            core.column_mut(k).fill(0.0);
            core[(k, k)] = 1.0;
            outer.row_mut(k).fill(0.0);
        };
        if self.swivel.is_none() {
            places.swivel.into_iter().for_each(&mut hold);
        }
        if let (Some(feed), Some(at)) = (&far.feed, places.feed)
            && feed.follows_command()
        {
            hold(at + feed.count() - 1);
            places.integral.into_iter().for_each(&mut hold);
        }
    }

    /// Right-hand side of z from that of the rope, which is forward solved, and its own; what end and support receive of
    /// both.
    fn forward(&mut self, rows: &[f64], needed: &[f64]) -> [Vec3; 2] {
        let inner = |a: &[f64]| rows.iter().zip(a).map(|(x, y)| x * y).sum::<f64>();
        for (k, needed) in needed.iter().enumerate() {
            self.z[k] = if self.is_held[k] { 0.0 } else { needed - inner(&self.columns[k]) };
        }
        let solved = &self.inverse * &self.z;
        let received = self.outer.transpose() * &solved;
        let mut on_post = three(received.as_slice(), 3);
        for (axis, column) in self.columns[self.count..].iter().enumerate() {
            on_post[axis] += inner(column);
        }
        self.z = solved;
        [three(received.as_slice(), 0), on_post]
    }

    /// Correction of z, and what the rope's right-hand side loses by it and by the motion of the support.
    fn backward(&mut self, rows: &mut [f64], of_end: &Vec3, of_post: &Vec3) {
        let outside = joined(of_end, of_post);
        let outside = DVec::from_column_slice(outside.as_slice());
        self.z = -&self.z - &self.inverse * (&self.outer * outside);
        for (k, column) in self.columns.iter().enumerate() {
            let by = if k < self.count { self.z[k] } else { of_post[k - self.count] };
            // The correction is minus what the rows give.
            rows.iter_mut().zip(column).for_each(|(row, entry)| *row += by * entry);
        }
    }
}

//! Straight cables compared with the corners of the polytope of tensions, found in an independent way.

use super::{check, cogiro, cogiro_pose, min_stiffness, seven_cables, seven_pose, spread, tau};
use funicular::math::DMat;
use funicular::robot::{PlatformMotion, Pose, Robot};
use funicular::statics::{self, StaticModel, StaticsError, TensionRange, TensionRule};

/// Straight cables at a pose, by methods that share only vectors with the program: the tensions that hold the platform
/// are `particular + N z`, from the singular value decomposition, and their polytope is given by its corners.
struct Straight {
    particular: Vec<f64>,
    /// Row per cable, column per dimension.
    null: DMat,
    limits: [f64; 2],
}

impl Straight {
    fn at(robot: &Robot, pose: &Pose, limits: [f64; 2]) -> Self {
        let m = robot.cables.len();
        let n = if robot.platform.motion == PlatformMotion::Rigid { 6 } else { 3 };
        let mut a = DMat::zeros(m, m);
        for (i, cable) in robot.cables.iter().enumerate() {
            let lever = pose.rot_wp * cable.attachment_p;
            let e = (cable.anchor.reference_w() - pose.position_w - lever).normalize();
            let moment = lever.cross(&e);
            let column = [e.x, e.y, e.z, moment.x, moment.y, moment.z];
            (0..n).for_each(|j| a[(j, i)] = column[j]);
        }
        let weight = robot.gravity_w * robot.platform.mass;
        let moment = (pose.rot_wp * robot.platform.center_of_mass_p).cross(&weight);
        let load = [weight.x, weight.y, weight.z, moment.x, moment.y, moment.z];
        let right = DMat::from_fn(m, 1, |j, _| if j < n { -load[j] } else { 0.0 });
        let svd = a.svd(true, true);
        let particular = svd.solve(&right, 1e-9).unwrap().iter().copied().collect();
        // The squared matrix has m − n zero singular values, sorted last.
        let v_t = svd.v_t.unwrap();
        let null = DMat::from_fn(m, m - n, |i, k| v_t[(n + k, i)]);
        Self { particular, null, limits }
    }

    fn dimension(&self) -> usize {
        self.null.ncols()
    }

    fn tensions(&self, z: &[f64]) -> Vec<f64> {
        (0..self.particular.len())
            .map(|i| self.particular[i] + z.iter().enumerate().map(|(k, z)| self.null[(i, k)] * z).sum::<f64>())
            .collect()
    }

    fn distance(&self, z: &[f64]) -> f64 {
        let [minimum, maximum] = self.limits;
        self.tensions(z).iter().fold(f64::INFINITY, |least, t| least.min(t - minimum).min(maximum - t))
    }

    /// All corners of the polytope.
    fn corners(&self) -> Vec<Vec<f64>> {
        let rows: Vec<(usize, f64)> =
            (0..self.particular.len()).flat_map(|i| self.limits.map(|limit| (i, limit))).collect();
        let gap = |(i, limit): (usize, f64)| limit - self.particular[i];
        let n = &self.null;
        let mut corners = Vec::new();
        for (k, &p) in rows.iter().enumerate() {
            match self.dimension() {
                1 => corners.push(vec![gap(p) / n[(p.0, 0)]]),
                2 => {
                    for &q in &rows[..k] {
                        let det = n[(p.0, 0)] * n[(q.0, 1)] - n[(p.0, 1)] * n[(q.0, 0)];
                        if det.abs() > 1e-12 {
                            corners.push(vec![
                                (gap(p) * n[(q.0, 1)] - n[(p.0, 1)] * gap(q)) / det,
                                (n[(p.0, 0)] * gap(q) - gap(p) * n[(q.0, 0)]) / det,
                            ]);
                        }
                    }
                }
                other => panic!("corners in {other} dimensions"),
            }
        }
        corners.retain(|corner| corner.iter().all(|z| z.is_finite()) && self.distance(corner) > -1e-8);
        corners
    }

    /// Point of the polytope nearest to target tensions: inside, on an edge, or a corner.
    fn nearest(&self, wanted: &[f64]) -> Vec<f64> {
        let n = &self.null;
        let free: Vec<f64> = (0..self.dimension())
            .map(|k| (0..wanted.len()).map(|i| n[(i, k)] * (wanted[i] - self.particular[i])).sum())
            .collect();
        let mut candidates = self.corners();
        if self.dimension() == 2 {
            for i in 0..wanted.len() {
                for limit in self.limits {
                    // Foot of the perpendicular on the line tension i = limit.
                    let normal = [n[(i, 0)], n[(i, 1)]];
                    let lack = (limit - self.tensions(&free)[i]) / (normal[0].powi(2) + normal[1].powi(2));
                    candidates.push(vec![free[0] + lack * normal[0], free[1] + lack * normal[1]]);
                }
            }
        }
        candidates.push(free);
        candidates.retain(|z| self.distance(z) > -1e-8);
        let cost = |z: &Vec<f64>| self.tensions(z).iter().zip(wanted).map(|(t, w)| (t - w).powi(2)).sum::<f64>();
        let best = candidates.into_iter().min_by(|a, b| cost(a).total_cmp(&cost(b))).unwrap();
        self.tensions(&best)
    }
}

/// Counts (possible, impossible) poses.
fn verdicts(robot: &Robot, limits: [f64; 2], poses: impl Iterator<Item = Pose>, model: StaticModel) -> (usize, usize) {
    let (mut possible, mut impossible) = (0, 0);
    for pose in poses {
        let straight = Straight::at(robot, &pose, limits);
        let corners = straight.corners();
        match statics::distribute_tensions(robot, &pose, model, &TensionRule::Lowest) {
            Ok(held) => {
                assert!(!corners.is_empty(), "the program finds tensions and no corner exists: {pose:?}");
                check(robot, &held);
                let best = straight.nearest(&vec![limits[0]; robot.cables.len()]);
                for (ours, theirs) in tau(&held).iter().zip(&best) {
                    assert!((ours - theirs).abs() < 1e-5 * limits[0].max(*theirs), "{ours} {theirs} at {pose:?}");
                }
                possible += 1;
            }
            Err(StaticsError::BeyondLimits(miss)) => {
                assert!(corners.is_empty(), "a corner exists and the program misses by {miss}: {pose:?}");
                impossible += 1;
            }
            Err(other) => panic!("{other} at {pose:?}"),
        }
    }
    (possible, impossible)
}

#[test]
fn verdict_and_lowest_tensions_of_10_000_poses_of_cogiro_are_those_of_the_corners() {
    let robot = cogiro(1e-9, 30.0, 600.0);
    let found = verdicts(&robot, [30.0, 600.0], (0..10_000).map(cogiro_pose), StaticModel::Catenary);
    assert!(found.0 > 2500 && found.1 > 2500, "{found:?}");
    let found = verdicts(&robot, [30.0, 600.0], (0..500).map(cogiro_pose), StaticModel::Ideal);
    assert!(found.0 > 100 && found.1 > 100, "{found:?}");
}

#[test]
fn verdict_and_lowest_tensions_of_10_000_poses_of_seven_cables_are_those_of_the_corners() {
    let robot = seven_cables(1e-9, 10.0, 1500.0);
    let found = verdicts(&robot, [10.0, 1500.0], (0..10_000).map(seven_pose), StaticModel::Catenary);
    assert!(found.0 > 2500 && found.1 > 2500, "{found:?}");
    let found = verdicts(&robot, [10.0, 1500.0], (0..500).map(seven_pose), StaticModel::Spring);
    assert!(found.0 > 100 && found.1 > 100, "{found:?}");
}

#[test]
fn middle_is_as_far_from_the_limits_as_the_best_of_all_corners() {
    for i in 0..300 {
        let (robot, limits) = (cogiro(0.0, 30.0, 900.0), [30.0, 900.0]);
        let pose = cogiro_pose(i);
        let Ok(held) = statics::distribute_tensions(&robot, &pose, StaticModel::Spring, &TensionRule::Middle) else {
            continue;
        };
        check(&robot, &held);
        let reached = held
            .cables
            .iter()
            .enumerate()
            .map(|(i, cable)| TensionRange::of(&robot, i, &cable.chord_w()).margin(cable).relative().unwrap());
        let reached = reached.fold(f64::INFINITY, f64::min);
        // Limits widened from both sides: corners exist until the optimum is passed.
        let exists = |part: f64| {
            let width = part * (limits[1] - limits[0]);
            !Straight::at(&robot, &pose, [limits[0] + width, limits[1] - width]).corners().is_empty()
        };
        assert!(exists(reached - 1e-7) && !exists(reached + 1e-7), "{reached} at {pose:?}");
    }
}

#[test]
fn closest_is_the_nearest_point_of_the_polytope() {
    for i in 0..500 {
        let robot = seven_cables(0.0, 10.0, 1500.0);
        let wanted: Vec<f64> = (0..7).map(|k| 700.0 * spread(i + 7, k)).collect();
        let rule = TensionRule::Closest(wanted.clone());
        let Ok(held) = statics::distribute_tensions(&robot, &seven_pose(i), StaticModel::Spring, &rule) else {
            continue;
        };
        let best = Straight::at(&robot, &seven_pose(i), [10.0, 1500.0]).nearest(&wanted);
        assert!(tau(&held).iter().zip(&best).all(|(ours, theirs)| (ours - theirs).abs() < 1e-6), "{best:?}");
    }
}

#[test]
fn no_other_tensions_of_straight_cables_are_stiffer() {
    let mut tried = 0;
    for (i, robot) in (0..60).flat_map(|i| [(i, cogiro(0.0, 30.0, 900.0)), (i, seven_cables(0.0, 10.0, 1500.0))]) {
        let is_cogiro = robot.cables.len() == 8;
        let (pose, limits) = if is_cogiro { (cogiro_pose(i), [30.0, 900.0]) } else { (seven_pose(i), [10.0, 1500.0]) };
        let Ok(held) = statics::distribute_tensions(&robot, &pose, StaticModel::Spring, &TensionRule::Stiffest) else {
            continue;
        };
        check(&robot, &held);
        let best = min_stiffness(&held);
        let corners = Straight::at(&robot, &pose, limits).corners();
        // Corners, and points spread between them.
        for k in 0..200 {
            let weights: Vec<f64> = (0..corners.len()).map(|c| spread(31 * k + c, c % 8).powi(4)).collect();
            let sum: f64 = weights.iter().sum();
            let z: Vec<f64> = (0..corners[0].len())
                .map(|d| match corners.get(k) {
                    Some(corner) => corner[d],
                    None => corners.iter().zip(&weights).map(|(corner, w)| corner[d] * w / sum).sum(),
                })
                .collect();
            let wanted = Straight::at(&robot, &pose, limits).tensions(&z);
            let other = statics::distribute_tensions(&robot, &pose, StaticModel::Spring, &TensionRule::Closest(wanted))
                .unwrap();
            assert!(min_stiffness(&other) <= best * (1.0 + 1e-7), "{} > {best}", min_stiffness(&other));
            tried += 1;
        }
    }
    assert!(tried > 5000, "{tried}");
}

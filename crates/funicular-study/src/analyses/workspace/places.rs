//! Where a workspace is searched: the box with its grid, the orientations, rays and sections.

use crate::request::{Axis, Steps, WorkspaceRequest, check_positive, digits};
use crate::sweep::AXES;
use anyhow::{Result, anyhow, bail};
use funicular::level_set::{MAX_NODES, PointGrid, Sphere};
use funicular::math::{Rotation, Vec3};
use funicular::robot::{PlatformMotion, Pose, Robot, State};

/// Number of steps along the longest side of the box, if no step is given.
const STEPS: f64 = 40.0;

/// Number of steps that a search takes as one at first: counts that the program chooses are multiples of it.
const FIRST_STRIDE: usize = 4;

/// Maximum number of orientations at a position.
const MAX_ORIENTATIONS: usize = 10_000;

/// Maximum number of sections.
const MAX_SECTIONS: usize = 1000;

/// Thickness of the slab that stands for the plane of a planar platform [m]: its volume in m³ is the area in m².
pub(super) const THICKNESS: f64 = 1.0;

/// Plane in which a planar platform moves: the number of the axis at right angles to it, and its coordinate there [m].
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PlaneOfMotion {
    pub(super) axis: usize,
    pub(super) at: f64,
}

impl PlaneOfMotion {
    /// Plane of a robot; `None` for a platform that moves in space.
    ///
    /// # Errors
    /// A plane at an angle to the axes of the world.
    fn of(robot: &Robot) -> Result<Option<Self>> {
        let PlatformMotion::Planar(plane) = &robot.platform.motion else { return Ok(None) };
        let normal = plane.normal_w();
        let Some(axis) = (0..3).find(|k| normal[*k].abs() >= 1.0) else {
            bail!(
                "the plane of the platform is at an angle to the axes of the world, along which the grid is: use \
                 `funicular map` with ⟪poses⟫ in the plane"
            );
        };
        Ok(Some(Self { axis, at: plane.offset() * normal[axis] }))
    }

    /// The position in the plane that stands for all beside it.
    pub(super) fn project(&self, mut position: Vec3) -> Vec3 {
        position[self.axis] = self.at;
        position
    }
}

/// Grid of positions of a request, and the plane of a planar platform, which the grid covers as a slab. Sides that the
/// request does not give reach from the least to the greatest coordinate of the anchors and the origin.
///
/// # Errors
/// An axis that is given twice or is no range, a box without a side, or too many nodes.
pub(super) fn grid(request: &WorkspaceRequest, robot: &Robot) -> Result<(PointGrid, Option<PlaneOfMotion>)> {
    if let Some(step) = request.step_m {
        check_positive("step_m", step)?;
    }
    let mut sides: [Option<(f64, f64, usize)>; 3] = [None; 3];
    for axis in &request.grid {
        let Some(k) = AXES[..3].iter().position(|name| *name == axis.name()) else { continue };
        let steps = axis.steps().map_err(|reason| anyhow!("⟪grid⟫ {}: {reason}", axis.name()))?;
        let Steps::Range { from, to, count } = steps else {
            bail!("⟪grid⟫ {}: a workspace needs a range, as in {}=-2:2:41", axis.name(), axis.name());
        };
        if sides[k].replace((from, to, count - 1)).is_some() {
            bail!("⟪grid⟫ {}: the axis is given twice", axis.name());
        }
    }

    let plane = PlaneOfMotion::of(robot)?;
    if let Some(PlaneOfMotion { axis, at }) = plane {
        let slab = (at - 0.5 * THICKNESS, at + 0.5 * THICKNESS, FIRST_STRIDE);
        if sides[axis].replace(slab).is_some() {
            bail!(
                "⟪grid⟫ {}: the platform stays in the plane {} = {at} m; leave this axis out",
                AXES[axis],
                AXES[axis]
            );
        }
    }

    let anchors: Vec<Vec3> = robot.cables.iter().map(|cable| cable.anchor.reference_w()).collect();
    let corner = |choose: fn(f64, f64) -> f64, k: usize| anchors.iter().map(|anchor| anchor[k]).fold(0.0, choose);
    let ends: [(f64, f64); 3] = std::array::from_fn(|k| match sides[k] {
        Some((from, to, _)) => (from, to),
        None => (corner(f64::min, k), corner(f64::max, k)),
    });
    let in_space = (0..3).filter(|k| plane.is_none_or(|plane| plane.axis != *k));
    let longest = in_space.map(|k| ends[k].1 - ends[k].0).fold(0.0, f64::max);
    let step = request.step_m.unwrap_or(longest / STEPS);
    let mut counts = [0; 3];
    for k in 0..3 {
        let (from, to) = ends[k];
        if to <= from {
            bail!("all anchors have {} = {from} m like the origin: give ⟪grid⟫ {}=A:B:N", AXES[k], AXES[k]);
        }
        let chosen = || {
            (((to - from) / step / FIRST_STRIDE as f64 - 1e-9).ceil().max(1.0) as usize).saturating_mul(FIRST_STRIDE)
        };
        counts[k] = sides[k].map_or_else(chosen, |(_, _, count)| count);
    }

    let [lower, upper] = [ends.map(|end| end.0), ends.map(|end| end.1)].map(Vec3::from);
    let grid = PointGrid::new(lower, upper, counts).ok_or_else(|| {
        let [x, y, z] = counts.map(|count| count + 1);
        anyhow!(
            "⟪grid⟫: {x} x {y} x {z} nodes are too many: give at most {MAX_NODES}, with larger steps or a smaller box"
        )
    })?;
    Ok((grid, plane))
}

/// Orientations at each position, in the order of a map: all combinations of the angles of the grid, or else that of
/// the state.
///
/// # Errors
/// An axis that is given twice, angles of a point mass, or too many orientations.
pub(super) fn orientations(request: &WorkspaceRequest, robot: &Robot) -> Result<Vec<Rotation>> {
    let mut angles: [Option<Steps>; 3] = [None, None, None];
    for axis in &request.grid {
        let Some(k) = AXES[3..].iter().position(|name| *name == axis.name()) else { continue };
        let steps = axis.steps().map_err(|reason| anyhow!("⟪grid⟫ {}: {reason}", axis.name()))?;
        if angles[k].replace(steps).is_some() {
            bail!("⟪grid⟫ {}: the axis is given twice", axis.name());
        }
    }

    let of_state = match &robot.state {
        State::Pose(pose) => pose.rot_wp,
        State::Lengths(_) | State::Unknown => Rotation::identity(),
    };
    if angles.iter().all(Option::is_none) {
        return Ok(vec![of_state]);
    }
    if !robot.platform.motion.can_turn() {
        bail!("⟪grid⟫: a point mass has no orientation: leave out roll, pitch and yaw");
    }
    let angles = angles.map(|steps| steps.unwrap_or_else(|| Steps::List(vec![0.0])));
    let count = angles.iter().map(Steps::count).fold(1_usize, usize::saturating_mul);
    if count > MAX_ORIENTATIONS {
        bail!("⟪grid⟫: {count} orientations are too many: give at most {MAX_ORIENTATIONS}");
    }

    let of = |index: usize| {
        let at: Vec<f64> =
            digits(index, angles.iter().map(Steps::count)).zip(&angles).map(|(digit, steps)| steps.at(digit)).collect();
        Pose::new([0.0; 3], [at[0], at[1], at[2]]).rot_wp
    };
    Ok((0..count).map(of).collect())
}

/// Refuses a grid along axes that do not exist or along which the platform cannot move, and states without a pose.
pub(super) fn check(request: &WorkspaceRequest, robot: &Robot) -> Result<()> {
    if request.point.state.lengths_m.is_some() || request.point.state.hold_lengths_of_pose {
        bail!(
            "`workspace` goes through poses, each with its own lengths: leave out ⟪lengths_m⟫ and \
             ⟪hold_lengths_of_pose⟫"
        );
    }
    if let Some(axis) = request.grid.iter().find(|axis| !AXES.contains(&axis.name())) {
        bail!("⟪grid⟫: there is no axis `{}`: give x, y, z, roll, pitch or yaw", axis.name());
    }
    if matches!(robot.platform.motion, PlatformMotion::Planar(_)) {
        if request.rays.is_some() {
            bail!("rays fill a volume, and a planar platform has an area: leave out ⟪rays⟫");
        }
        if !request.section.is_empty() {
            bail!("the set of a planar platform is a section itself: leave out ⟪section⟫");
        }
    }
    if robot.constraint().is_under() {
        bail!(
            "with fewer cables than degrees of freedom the cables do not hold every orientation: use `funicular map`, \
             which shows the nearest pose that they hold"
        );
    }
    Ok(())
}

/// Sphere of the rays of a request.
///
/// # Errors
/// A number for which there is no sphere.
pub(super) fn sphere(count: usize) -> Result<Sphere> {
    Sphere::with_directions(count).ok_or_else(|| {
        let numbers = Sphere::numbers();
        let (below, above): (Vec<usize>, Vec<usize>) = numbers.iter().partition(|number| **number < count);
        let near = [below.last(), above.first()].into_iter().flatten().map(ToString::to_string).collect::<Vec<_>>();
        anyhow!("⟪rays⟫: {count} rays do not cover a sphere evenly: give {}", near.join(" or "))
    })
}

/// Planes of the sections, that of a planar platform among them: number of the axis and coordinate [m].
///
/// # Errors
/// An axis that is no axis of positions, or a plane beyond the box.
pub(super) fn sections(given: &[Axis], grid: &PointGrid, plane: Option<PlaneOfMotion>) -> Result<Vec<(usize, f64)>> {
    let mut planes: Vec<(usize, f64)> = plane.iter().map(|plane| (plane.axis, plane.at)).collect();
    for axis in given {
        let Some(k) = AXES[..3].iter().position(|name| *name == axis.name()) else {
            bail!("⟪section⟫ {}: a section is at right angles to x, y or z", axis.name());
        };
        let steps = axis.steps().map_err(|reason| anyhow!("⟪section⟫ {}: {reason}", axis.name()))?;
        if steps.count() > MAX_SECTIONS {
            bail!("⟪section⟫ {}: {} sections are too many: give at most {MAX_SECTIONS}", axis.name(), steps.count());
        }
        let (low, high) = (grid.lower()[k], grid.upper()[k]);
        for at in (0..steps.count()).map(|i| steps.at(i)) {
            if at < low || at > high {
                bail!("⟪section⟫ {}={at}: the grid reaches from {low} to {high} m", axis.name());
            }
            planes.push((k, at));
        }
    }
    Ok(planes)
}

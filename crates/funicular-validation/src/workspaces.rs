//! Workspaces: published and computed volumes, and ends of rays.

use super::reference::WorkspaceReference;
use super::section::WRONG;
use super::{Bound, Case, Comparison, Declared, DifferenceKind, Level, NegativeControl, reference};
use anyhow::{Context, Result};
use funicular::level_set::{LevelSet, PointGrid, RaySet, RaysInBox, Sphere};
use funicular::math::{Rotation, Vec3};
use funicular::robot::{Pose, Robot, TensionLimits};
use funicular::statics::{self, LoadCapacity, StaticModel};

/// Relative difference of volumes that are sums of the same cubes: rounding of a few hundred terms.
const SAME_RAYS: f64 = 1e-12;

/// Difference of the ends of rays [m]: the reference prints twelve decimals of ends found to 1e-9 m.
const ENDS: f64 = 2e-9;

pub(super) const SECTION: Declared = Declared {
    id: "workspaces",
    title: "Workspaces",
    note: "Volumes of a box-shaped robot along the 258 rays of a subdivided octahedron, with the closed-form \
           tensions of the published program and with all tensions, and of CoGiRo with a box of required loads. \
           Straight cables. The published search keeps the middle of its last bracket of 1e-4 m, and the \
           comparison does the same; the program itself finds the ends of rays to the tolerance that is asked for.",
    rows: || rows(&reference::workspaces()?),
    controls: &[
        NegativeControl {
            id: "frame",
            wrong: "height of the frame 1 % too large",
            proves: "the volume of a box-shaped workspace",
            rows: || {
                let mut reference = reference::workspaces()?;
                reference.box_shaped.frame_m[2] *= WRONG;
                box_shaped(&reference)
            },
        },
        NegativeControl {
            id: "required",
            wrong: "required loads 1 % too large",
            proves: "the ends of rays",
            rows: || {
                let mut reference = reference::workspaces()?;
                reference.cogiro.required_box_n_nm = reference.cogiro.required_box_n_nm.map(|half| half * WRONG);
                cogiro(&reference)
            },
        },
    ],
};

fn rows(reference: &WorkspaceReference) -> Result<Vec<Comparison>> {
    let mut rows = box_shaped(reference)?;
    rows.extend(cogiro(reference)?);
    Ok(rows)
}

/// Function of a pose that is positive inside a workspace.
type Margin = fn(&Robot, &Pose) -> Option<f64>;

/// Volume, area and centroid with the closed form and with all tensions.
fn box_shaped(reference: &WorkspaceReference) -> Result<Vec<Comparison>> {
    let of = &reference.box_shaped;
    let robot = Robot::from_toml(&of.robot_file())?;
    let all_tensions: Margin = |robot, pose| LoadCapacity::at(robot, pose, StaticModel::Ideal, None).ok()?.margin();
    let sets: [(&str, &str, Margin, [f64; 2]); 2] = [
        ("closed-form", "closed-form tensions", statics::closed_form_margin, [of.closed_form_m3, of.closed_form_m2]),
        ("all-tensions", "all tensions", all_tensions, [of.all_tensions_m3, of.all_tensions_m2]),
    ];

    let sphere = Sphere::with_directions(of.rays).context("no such sphere")?;
    let center = Vec3::from(of.center_m);
    let mut rows = Vec::new();
    for (id, name, margin, theirs) in sets {
        let is_inside = |position: Vec3| {
            let pose = Pose { position_w: position, rot_wp: Rotation::identity() };
            margin(&robot, &pose).is_some_and(|margin| margin > 0.0)
        };
        let lengths: Vec<f64> =
            sphere.directions().iter().map(|ray| published_end(|r| is_inside(center + ray * r), of.search_m)).collect();
        let hull = sphere.hull(center, &lengths);
        let case = Case::new(
            Level::Published,
            &reference.source,
            &format!("ipanema1/{id}"),
            &format!("IPAnema1Design, {name}, 258 rays"),
        );
        let ours = [hull.volume(), hull.area()];
        rows.push(case.of("volume-area", "volume and area [m³, m²]").relative(
            &theirs,
            &ours,
            SAME_RAYS,
            Bound::Rounding,
        ));
    }
    Ok(rows)
}

/// Distance of the published search along a ray: halving from 0 to `longest` until the bracket is below `shortest`; its
/// middle is kept.
fn published_end(is_inside: impl Fn(f64) -> bool, [longest, shortest]: [f64; 2]) -> f64 {
    let (mut inner, mut outer) = (0.0, longest);
    while outer - inner >= shortest {
        let middle = f64::midpoint(inner, outer);
        if is_inside(middle) {
            inner = middle;
        } else {
            outer = middle;
        }
    }
    f64::midpoint(inner, outer)
}

/// Volume on a coarse grid, and the ends of rays along the axes.
fn cogiro(reference: &WorkspaceReference) -> Result<Vec<Comparison>> {
    let of = &reference.cogiro;
    let [minimum, maximum] = of.tension_limits_n.map(Some);
    let mut robot = Robot::from_toml(funicular_robots::COGIRO)?.with_tension_limits(TensionLimits { minimum, maximum });
    let [x, y, z, roll, pitch, yaw] = of.required_box_n_nm;
    robot.required.force_w = Vec3::new(x, y, z);
    robot.required.moment_w = Vec3::new(roll, pitch, yaw);
    let margin = |position: &Vec3| {
        let pose = Pose { position_w: *position, rot_wp: Rotation::identity() };
        let capacity = LoadCapacity::at(&robot, &pose, StaticModel::Ideal, None).ok()?;
        capacity.dead_load().ok()?;
        capacity.margin()
    };
    let mut evaluate = |positions: &[Vec3]| Some(positions.iter().map(margin).collect());

    let [lower, upper] = of.box_m.map(Vec3::from);
    let steps = [0, 1, 2].map(|k| ((upper[k] - lower[k]) / of.step_m).round() as usize);
    let grid = PointGrid::new(lower, upper, steps).context("no grid")?;
    let set = LevelSet::find(grid, ENDS, &mut evaluate).context("stopped")?;
    let case = Case::new(
        Level::Program,
        &reference.source,
        "cogiro",
        &format!("CoGiRo, required box, steps of {} m", of.step_m),
    );
    let ours = [set.boundary(1).volume()];
    // Both have an error of about what halving the steps changes, and cut their cells along other diagonals.
    let change = (of.halved_volume_m3 / of.volume_m3 - 1.0).abs();
    let bound = Bound::Model("other diagonals of the cells; change by halving the steps");
    let mut rows = vec![case.of("volume", "volume [m³]").relative(&[of.volume_m3], &ours, change, bound)];

    let search = RaysInBox { center: of.center_m.into(), bounds: [lower, upper], step: 0.25, tolerance: 0.1 * ENDS };
    let rays = RaySet::find(Sphere::with_directions(6).context("no sphere")?, &search, &mut evaluate);
    let rays = rays.context("stopped")?;
    let ours: Vec<f64> = rays.rays().iter().filter_map(|ray| Some(ray.intervals.first()?[1])).collect();
    let case = Case::new(Level::Program, &reference.source, "cogiro", "CoGiRo, required box, rays along the axes");
    let difference = (super::largest_difference(&of.ends_m, &ours), DifferenceKind::Absolute);
    let bound = Bound::Digits("end of the other search");
    rows.push(case.of("ends", "ends along +x, -x, +y, -y, +z, -z [m]").row(
        (&of.ends_m, &ours),
        difference,
        ENDS,
        bound,
    ));
    Ok(rows)
}

//! Required loads at a pose as a set of wrenches: a sum of convex parts with their reach in every direction.

use crate::math::{Mat3, Mat6, Vec3, Vec6, skew};
use crate::platform::{Coordinates, mass_matrix, wrench_of};
use crate::robot::{LoadShape, Pose, RequiredLoads, Robot, stacked};

/// Maximum number of loads that are tried one by one where all are wanted: each takes an equilibrium of some 50 µs.
const MAX_TRIED: usize = 1024;

/// Maximum number of combinations of corners that are formed: a box of forces and moments, one of accelerations and an
/// uncertain payload have 64 · 8 · 64 · 2.
const MAX_VERTICES: usize = 65_536;

/// Required loads at a pose in addition to the dead load, reduced [N]. The zero wrench belongs to them.
#[derive(Debug, Clone)]
pub(super) struct RequiredSet {
    parts: Vec<LoadPart>,
}

/// Load of a [`RequiredSet`] by the coefficients of the wrenches that span its parts. They stay while these wrenches
/// change with pose and robot.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct LoadCoefficients(Vec<Vec<f64>>);

/// Convex part of the required loads.
#[derive(Debug, Clone)]
enum LoadPart {
    /// Sum of the segments from `−g` to `g`: a box, or its image.
    Segments(Vec<Vec6>),
    /// Image of the unit ball: `Σ c_k g_k` with `Σ c_k² ≤ 1`.
    Ball(Vec<Vec6>),
    /// Convex hull.
    Points(Vec<Vec6>),
}

impl LoadPart {
    /// Reach in a direction.
    fn reach(&self, n: &Vec6) -> f64 {
        match self {
            Self::Segments(halves) => halves.iter().map(|half| n.dot(half).abs()).sum(),
            Self::Ball(axes) => axes.iter().map(|axis| n.dot(axis).powi(2)).sum::<f64>().sqrt(),
            Self::Points(points) => points.iter().map(|point| n.dot(point)).fold(f64::NEG_INFINITY, f64::max),
        }
    }

    /// Wrenches whose combinations the part consists of.
    fn generators(&self) -> &[Vec6] {
        let (Self::Segments(of) | Self::Ball(of) | Self::Points(of)) = self;
        of
    }

    /// Coefficients of the wrench with the largest component along a direction.
    fn farthest(&self, n: &Vec6) -> Vec<f64> {
        match self {
            Self::Segments(halves) => halves.iter().map(|half| n.dot(half).signum()).collect(),
            Self::Ball(axes) => {
                let reach = self.reach(n);
                axes.iter().map(|axis| if reach == 0.0 { 0.0 } else { n.dot(axis) / reach }).collect()
            }
            Self::Points(points) => {
                let farther = |a: &usize, b: &usize| n.dot(&points[*a]).total_cmp(&n.dot(&points[*b]));
                self.corner((0..points.len()).max_by(farther).unwrap_or_default())
            }
        }
    }

    /// Coefficients of a corner, by its number among [`Self::corners`].
    fn corner(&self, number: usize) -> Vec<f64> {
        match self {
            Self::Segments(halves) => (0..halves.len()).map(|k| sign(number, k)).collect(),
            Self::Ball(axes) => vec![0.0; axes.len()],
            Self::Points(points) => (0..points.len()).map(|k| f64::from(u8::from(k == number))).collect(),
        }
    }

    /// Corners; `None` for a ball.
    fn corners(&self) -> Option<Vec<Vec6>> {
        match self {
            Self::Segments(halves) => Some(corners(halves)),
            Self::Points(points) => Some(points.clone()),
            Self::Ball(_) => None,
        }
    }
}

impl RequiredSet {
    /// Required loads of a platform at a pose, about the dead load with the lightest payload.
    pub(super) fn of(robot: &Robot, pose: &Pose, required: &RequiredLoads) -> Self {
        let coordinates = Coordinates::of(robot);
        let mut set = Self { parts: Vec::new() };

        // Forces and moments.
        let halves = nonzero(axes_of(&required.force_w, &required.moment_w), &coordinates);
        set.add(match required.shape {
            LoadShape::Box => LoadPart::Segments(halves),
            LoadShape::Ellipsoid => LoadPart::Ball(halves),
        });

        // Any one of the listed loads, or none.
        let listed = required.listed.iter().map(|load| {
            let moment = Vec6::new(0.0, 0.0, 0.0, load.moment_w.x, load.moment_w.y, load.moment_w.z);
            coordinates.reduce(&(wrench_of(&load.force_w, &(pose.rot_wp * load.point_p)) + moment))
        });
        let listed: Vec<Vec6> = listed.collect();
        if !listed.is_empty() {
            set.add(LoadPart::Points([vec![Vec6::zeros()], listed].concat()));
        }

        // Inertia, and with it the payload.
        let accelerations = axes_of(&required.acceleration_w, &required.angular_acceleration_w);
        if required.payload.max_mass == 0.0 {
            let mass = mass_matrix(&robot.platform, pose);
            set.add(LoadPart::Segments(nonzero(accelerations.map(|axis| mass * axis), &coordinates)));
        } else {
            let wrenches = payload_corners(robot, pose, required);
            set.add(LoadPart::Points(wrenches.iter().map(|wrench| coordinates.reduce(wrench)).collect()));
        }

        // Wind on the platform from every horizontal direction.
        let pressure = 0.5 * robot.wind.air_density * required.wind_speed.powi(2) * robot.platform.drag_area;
        let arm_w = pose.rot_wp * robot.platform.center_of_mass_p;
        if pressure > 0.0 {
            // Projections of three axes span the horizontal disk and turn smoothly with gravity.
            let up_w = robot.up_w();
            let level = [Vec3::x(), Vec3::y(), Vec3::z()].map(|axis_w| axis_w - up_w * up_w.dot(&axis_w));
            let wrench = |axis_w: &Vec3| coordinates.reduce(&wrench_of(&(axis_w * pressure), &arm_w));
            set.add(LoadPart::Ball(level.iter().map(wrench).collect()));
        }
        set
    }

    /// All accelerations of the platform from rest with the norm 1 m/s², angular ones times ℓ.
    pub(super) fn unit_accelerations(robot: &Robot, pose: &Pose) -> Self {
        let coordinates = Coordinates::of(robot);
        let mass = coordinates.reduce_matrix(&mass_matrix(&robot.platform, pose));
        let axes = (0..coordinates.count()).map(|k| mass.column(k).into_owned());
        Self { parts: vec![LoadPart::Ball(axes.collect())] }
    }

    /// Adds a load that acts together with all others.
    pub(super) fn add_fixed(&mut self, load: Vec6) {
        self.add(LoadPart::Points(vec![load]));
    }

    fn add(&mut self, part: LoadPart) {
        let (LoadPart::Segments(of) | LoadPart::Ball(of) | LoadPart::Points(of)) = &part;
        if !of.is_empty() {
            self.parts.push(part);
        }
    }

    /// True if nothing is required but the dead load.
    pub(super) fn is_empty(&self) -> bool {
        self.parts.is_empty()
    }

    /// Reach in a direction, not negative, because the dead load alone is required as well.
    pub(super) fn reach(&self, n: &Vec6) -> f64 {
        self.parts.iter().map(|part| part.reach(n)).sum::<f64>().max(0.0)
    }

    /// Coefficients of the load with the largest component along a direction.
    pub(super) fn farthest(&self, n: &Vec6) -> LoadCoefficients {
        LoadCoefficients(self.parts.iter().map(|part| part.farthest(n)).collect())
    }

    /// Coefficients of the load at a share of the way from one load to another. A ball is followed along its surface.
    pub(super) fn between(&self, from: &LoadCoefficients, to: &LoadCoefficients, share: f64) -> LoadCoefficients {
        let blend = |((part, from), to): ((&LoadPart, &Vec<f64>), &Vec<f64>)| {
            let mut blended: Vec<f64> = from.iter().zip(to).map(|(a, b)| a + share * (b - a)).collect();
            let size = blended.iter().map(|of| of * of).sum::<f64>().sqrt();
            if matches!(part, LoadPart::Ball(_)) && size > 0.0 {
                for of in &mut blended {
                    *of /= size;
                }
            }
            blended
        };
        LoadCoefficients(self.parts.iter().zip(&from.0).zip(&to.0).map(blend).collect())
    }

    /// Load with these coefficients.
    pub(super) fn load(&self, coefficients: &LoadCoefficients) -> Vec6 {
        let parts = self.parts.iter().zip(&coefficients.0);
        parts.flat_map(|(part, of)| part.generators().iter().zip(of)).map(|(generator, of)| generator * *of).sum()
    }

    /// Loads that ask most of cables: all vertices if they are not too many, otherwise those farthest along each of the
    /// given directions and against it. The dead load alone is the first.
    pub(super) fn extremes(&self, directions: &[Vec6]) -> Vec<Vec6> {
        let alone = vec![Vec6::zeros()];
        if self.is_empty() {
            return alone;
        }
        if let Some(vertices) = self.vertices().filter(|vertices| vertices.len() <= MAX_TRIED) {
            return [alone, vertices].concat();
        }
        let mut found: Vec<LoadCoefficients> = Vec::new();
        for direction in directions.iter().flat_map(|n| [*n, -n]) {
            let farthest = self.farthest(&direction);
            if !found.contains(&farthest) {
                found.push(farthest);
            }
        }
        [alone, found.iter().map(|of| self.load(of)).collect()].concat()
    }

    /// Coefficients of a load, by its number among [`Self::vertices`].
    pub(super) fn vertex(&self, mut number: usize) -> LoadCoefficients {
        let mut coefficients: Vec<Vec<f64>> = Vec::with_capacity(self.parts.len());
        for part in self.parts.iter().rev() {
            let count = part.corners().map_or(1, |corners| corners.len());
            coefficients.push(part.corner(number % count));
            number /= count;
        }
        coefficients.reverse();
        LoadCoefficients(coefficients)
    }

    /// Sums of the corners of all parts, which the vertices of the set are among; `None` for a set with a ball, or if
    /// they are too many.
    pub(super) fn vertices(&self) -> Option<Vec<Vec6>> {
        let mut sums = vec![Vec6::zeros()];
        for part in &self.parts {
            let corners = part.corners()?;
            if sums.len() * corners.len() > MAX_VERTICES {
                return None;
            }
            sums = sums.iter().flat_map(|sum| corners.iter().map(move |corner| sum + corner)).collect();
        }
        Some(sums)
    }
}

/// Corners of the box with these half axes.
fn corners(halves: &[Vec6]) -> Vec<Vec6> {
    let signed = |number: usize| halves.iter().enumerate().map(|(k, half)| half * sign(number, k)).sum();
    (0..1_usize << halves.len()).map(signed).collect()
}

/// Sign of the half axis `k` in a corner of a box.
fn sign(corner: usize, k: usize) -> f64 {
    if corner & (1 << k) == 0 { -1.0 } else { 1.0 }
}

/// Axes of a box of six components with these half widths.
fn axes_of(linear: &Vec3, angular: &Vec3) -> [Vec6; 6] {
    std::array::from_fn(|k| {
        let mut axis = Vec6::zeros();
        axis[k] = if k < 3 { linear[k] } else { angular[k - 3] };
        axis
    })
}

/// Reduced wrenches that are not zero.
fn nonzero<const N: usize>(wrenches: [Vec6; N], coordinates: &Coordinates) -> Vec<Vec6> {
    let reduced = wrenches.iter().map(|wrench| coordinates.reduce(wrench));
    reduced.filter(|wrench| wrench.norm() > 0.0).collect()
}

/// Wrenches of payload and inertia for all corners of mass, centre and acceleration, in addition to the weight of the
/// lightest payload in the middle; world axes (N, N m): (40m), (40n).
fn payload_corners(robot: &Robot, pose: &Pose, required: &RequiredLoads) -> Vec<Vec6> {
    let payload = &required.payload;
    let rot = pose.rot_wp.to_rotation_matrix();
    let own_mass = mass_matrix(&robot.platform, pose);
    let lightest = wrench_of(&(robot.gravity_w * payload.min_mass), &(rot * payload.center_p));

    // The inertia is quadratic in the centre, if the platform turns.
    let turns = required.angular_acceleration_w != Vec3::zeros();
    let bends = if turns { payload.center_reach_p.component_mul(&payload.center_reach_p) } else { Vec3::zeros() };

    let mut wrenches = Vec::new();
    for mass in distinct(payload.min_mass, payload.max_mass) {
        for center_p in box_corners(&payload.center_reach_p).map(|corner| payload.center_p + corner) {
            let arm_w = rot * center_p;
            let weight = wrench_of(&(robot.gravity_w * mass), &arm_w) - lightest;
            let inertia = own_mass + inertia_of_point(mass, &arm_w);
            for linear_w in box_corners(&required.acceleration_w) {
                for angular_w in box_corners(&required.angular_acceleration_w) {
                    let motion = stacked(&linear_w, &angular_w);
                    let load = weight - inertia * motion;
                    let angular_p = rot.inverse() * angular_w;
                    wrenches.extend(bend_corners(&bends).map(|bend| {
                        let moment_p = angular_p * bend.sum() - angular_p.component_mul(&bend);
                        load + stacked(&Vec3::zeros(), &(rot * moment_p * mass))
                    }));
                }
            }
        }
    }
    wrenches
}

/// Mass matrix of a point mass at a lever arm about the platform origin.
fn inertia_of_point(mass: f64, arm_w: &Vec3) -> Mat6 {
    let arm = skew(arm_w);
    let mut matrix = Mat6::zeros();
    let mut put = |row, column, block: Mat3| matrix.fixed_view_mut::<3, 3>(row, column).copy_from(&(block * mass));
    put(0, 0, Mat3::identity());
    put(0, 3, -arm);
    put(3, 0, arm);
    put(3, 3, -arm * arm);
    matrix
}

/// Both ends of an ascending range, or its only value.
fn distinct(from: f64, to: f64) -> impl Iterator<Item = f64> {
    std::iter::once(from).chain((to > from).then_some(to))
}

/// Corners of a box about the origin; a width of zero does not double them.
fn box_corners(half_widths: &Vec3) -> impl Iterator<Item = Vec3> {
    product(half_widths.map(|half| -half), *half_widths)
}

/// Corners of a box from the origin to a corner.
fn bend_corners(to: &Vec3) -> impl Iterator<Item = Vec3> {
    product(Vec3::zeros(), *to)
}

fn product(from: Vec3, to: Vec3) -> impl Iterator<Item = Vec3> {
    distinct(from.x, to.x).flat_map(move |x| {
        distinct(from.y, to.y).flat_map(move |y| distinct(from.z, to.z).map(move |z| Vec3::new(x, y, z)))
    })
}

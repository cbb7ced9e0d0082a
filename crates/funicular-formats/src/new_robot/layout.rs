//! Points of the cables of a new robot: made for a number of cables, or taken from a table.

use super::points::CablePoints;
use super::{MAX_CABLES, NewMotion};
use anyhow::{Result, bail};
use funicular::math::Vec3;
use std::f64::consts::{PI, SQRT_2, TAU};

/// Sides of the default box around the platform [m].
const BOX: [f64; 3] = [1.0, 1.0, 0.5];

/// Half the side of the square on whose corners the anchors of eight cables stand, for a platform of 1 m [m]. A smaller
/// platform has a smaller room in proportion, a larger one at least twice its side.
const HALF_ROOM: f64 = 4.0;

/// Height of the anchors over half the side of the room.
const HEIGHT_OVER_HALF: f64 = 1.5;

/// Height of the platform over that of the anchors: the cables are inclined by about 30°, where tensions are moderate.
const PLATFORM_OVER_HEIGHT: f64 = 0.4;

/// Distance between the anchors of the upper and the lower cable of a pair, over the height of the anchors.
const PAIR_OVER_HEIGHT: f64 = 1.0 / 12.0;

/// Heights of the platform that are tried between the floor and the anchors of a table.
const TRIED_BETWEEN: [f64; 5] = [0.4, 0.5, 0.25, 0.6, 0.75];

/// Depths below anchors of one height that are tried, over half the width of the anchors.
const TRIED_BELOW: [f64; 5] = [0.8, 0.5, 1.2, 0.3, 2.0];

/// Height of the floor if no anchor is below it [m].
const FLOOR: f64 = 0.0;

/// Points of all cables, and where the platform may hang.
pub(super) struct Layout {
    pub(super) cables: Vec<CablePoints>,
    /// Horizontal position of the platform [m].
    pub(super) middle: [f64; 2],
    /// Heights of the platform to try, in this order [m].
    pub(super) heights: Vec<f64>,
    /// Floor below which no part of the platform is, if the anchors stand on one [m].
    pub(super) floor: Option<f64>,
    /// Sides of the box of the platform, or else of the box around the attachments [m].
    pub(super) sides: [f64; 3],
}

impl Layout {
    /// Layout with a number of cables around the origin, above the platform. Opposite cables mirror each other, so that
    /// the platform in the middle is in equilibrium.
    pub(super) fn of_count(count: Option<usize>, motion: NewMotion, sides: Option<[f64; 3]>) -> Result<Self> {
        let fewest = match motion {
            NewMotion::Rigid => 2,
            NewMotion::PointMass | NewMotion::PlanarXz => 1,
            // Nothing pulls a platform in a level plane but its cables, which have to pull against each other.
            NewMotion::PlanarXy => 4,
        };
        let count = count.unwrap_or(if motion == NewMotion::Rigid { 8 } else { 4 });
        if count == 1 && fewest == 2 {
            bail!(
                "⟪cables⟫ 1: one cable does not keep a rigid platform from turning about it; give ⟪motion⟫ point-mass"
            );
        }
        if !(fewest..=MAX_CABLES).contains(&count) {
            bail!("⟪cables⟫ {count}: give {fewest} to {MAX_CABLES} cables");
        }

        let sides = sides.unwrap_or(BOX);
        let side = sides[0].max(sides[1]);
        let half = f64::max(HALF_ROOM * side.min(1.0), 2.0 * side);
        let height = f64::max(HEIGHT_OVER_HALF * half, 4.0 * sides[2]);
        let room = Room { half, height, sides };
        let points = match motion {
            NewMotion::Rigid => room.around(count),
            NewMotion::PointMass => room.to_one_point(count),
            NewMotion::PlanarXz => room.in_plane(count),
            NewMotion::PlanarXy => room.in_level_plane(count),
        };

        let named = |(i, (anchor, attachment)): (usize, (Vec3, Vec3))| CablePoints {
            name: (i + 1).to_string(),
            anchor: anchor.map(rounded),
            attachment: attachment.map(rounded),
        };
        let cables = points.into_iter().enumerate().map(named).collect();
        let is_level = motion == NewMotion::PlanarXy;
        let middle_height = if is_level { 0.0 } else { rounded(PLATFORM_OVER_HEIGHT * height) };
        let floor = (!is_level).then_some(FLOOR);
        Ok(Self { cables, middle: [0.0, 0.0], heights: vec![middle_height], floor, sides })
    }

    /// Layout with the points of a table. The platform hangs in the middle of the anchors.
    pub(super) fn of_points(cables: Vec<CablePoints>, motion: NewMotion, box_m: Option<[f64; 3]>) -> Self {
        let [x, y, z] = extent(cables.iter().map(|cable| cable.anchor));
        let middle = |[low, high]: [f64; 2]| rounded(0.5 * (low + high));
        // The origin of a planar platform moves in the plane of the anchors.
        let across = if motion == NewMotion::PlanarXz {
            rounded(cables.iter().map(|cable| cable.anchor.y).sum::<f64>() / cables.len() as f64)
        } else {
            middle(y)
        };

        if motion == NewMotion::PlanarXy {
            let height = rounded(cables.iter().map(|cable| cable.anchor.z).sum::<f64>() / cables.len() as f64);
            let sides = extent(cables.iter().map(|cable| cable.attachment)).map(|[low, high]| rounded(high - low));
            return Self { cables, middle: [middle(x), middle(y)], heights: vec![height], floor: None, sides };
        }

        let half_width = 0.5 * f64::max(x[1] - x[0], y[1] - y[0]);
        let depth = z[1] - z[0];
        let between = TRIED_BETWEEN.iter().map(|part| z[0] + part * depth);
        // Without width the only anchor, or a column of anchors, holds the platform as a pendulum.
        let scale = if half_width > 0.0 { half_width } else { f64::max(depth, 1.0) };
        let below = TRIED_BELOW.iter().map(|part| z[1] - part * scale);
        // Anchors of about one height hold the platform below them.
        let heights: Vec<f64> =
            if depth > 0.5 * half_width { between.chain(below).collect() } else { below.chain(between).collect() };

        // Distance of the origin above the lowest point of the platform.
        let lowest = cables.iter().map(|cable| cable.attachment.z).fold(0.0, f64::min);
        let below_origin = f64::max(-lowest, 0.5 * box_m.map_or(0.0, |sides| sides[2]));
        let least = FLOOR + below_origin;
        // Anchors that leave no room above the floor do not stand on it: the origin is at their height.
        let floor = (z[0] >= FLOOR && z[1] > least).then_some(FLOOR);

        let heights = heights.into_iter().map(rounded);
        let heights = match floor {
            Some(_) => {
                let room = TRIED_BETWEEN.iter().map(|part| rounded(least + part * (z[1] - least)));
                heights.filter(|height| *height > least).chain(room).collect()
            }
            None => heights.collect(),
        };
        let sides = extent(cables.iter().map(|cable| cable.attachment)).map(|[low, high]| rounded(high - low));
        Self { cables, middle: [middle(x), across], heights, floor, sides }
    }
}

/// Room of a made layout.
struct Room {
    /// Half the side of the square of the anchors of eight cables [m].
    half: f64,
    /// Height of the upper anchors [m].
    height: f64,
    /// Sides of the box around the platform [m].
    sides: [f64; 3],
}

impl Room {
    /// Point on a circle of the room.
    fn on_circle(&self, angle: f64, height: f64) -> Vec3 {
        // The circle goes through the corners of the square.
        Vec3::new(angle.cos(), angle.sin(), 0.0) * (SQRT_2 * self.half) + Vec3::z() * height
    }

    /// Point at the platform's sides, on the ellipse that touches them.
    fn on_platform(&self, angle: f64, height: f64) -> Vec3 {
        let [a, b, _] = self.sides;
        Vec3::new(0.5 * a * angle.cos(), 0.5 * b * angle.sin(), height)
    }

    /// Cable from above the middle to the top of the platform.
    fn cable_from_above(&self) -> (Vec3, Vec3) {
        (Vec3::z() * self.height, Vec3::z() * (0.5 * self.sides[2]))
    }

    /// Cables of a rigid platform. From six cables on they come in pairs: the upper and the lower cable of a corner go
    /// to different sides of the platform, which fixes the rotation about the vertical.
    fn around(&self, count: usize) -> Vec<(Vec3, Vec3)> {
        let top = 0.5 * self.sides[2];
        if count == 2 {
            let ends = |sign: f64| {
                (Vec3::new(sign * self.half, 0.0, self.height), Vec3::new(sign * 0.5 * self.sides[0], 0.0, top))
            };
            return vec![ends(-1.0), ends(1.0)];
        }
        if count < 6 {
            let ends = |angle: f64| (self.on_circle(angle, self.height), self.on_platform(angle, top));
            return angles(count).map(ends).collect();
        }

        let corners = count / 2;
        let lower = self.height * (1.0 - PAIR_OVER_HEIGHT);
        let turn = PI / corners as f64;
        let pairs = angles(corners).flat_map(|angle| {
            [
                (self.on_circle(angle, self.height), self.on_platform(angle - turn, top)),
                (self.on_circle(angle, lower), self.on_platform(angle + turn, -top)),
            ]
        });
        pairs.chain((count % 2 == 1).then(|| self.cable_from_above())).collect()
    }

    /// Cables of a point mass.
    fn to_one_point(&self, count: usize) -> Vec<(Vec3, Vec3)> {
        if count == 1 {
            return vec![(Vec3::z() * self.height, Vec3::zeros())];
        }
        angles(count).map(|angle| (self.on_circle(angle, self.height), Vec3::zeros())).collect()
    }

    /// Cables of a platform in the plane y = 0, in pairs left and right from top to bottom.
    fn in_plane(&self, count: usize) -> Vec<(Vec3, Vec3)> {
        let [a, _, c] = self.sides;

        if count == 3 {
            // The lines of three mirrored cables meet in one point, about which nothing resists a rotation. So the
            // right cable is a lower one, and the third cable balances it above the left corner.
            let corner = |sign: f64| Vec3::new(sign * 0.5 * a, 0.0, -sign * 0.5 * c);
            let right = Vec3::new(self.half, 0.0, self.height * (1.0 - PAIR_OVER_HEIGHT));
            let above = Vec3::new(-0.5 * a, 0.0, self.height);
            return vec![
                (Vec3::new(-self.half, 0.0, self.height), corner(-1.0)),
                (right, corner(1.0)),
                (above, corner(-1.0)),
            ];
        }

        let pairs = count / 2;
        let below = |pair: usize| pair as f64 / (pairs.max(2) - 1) as f64;
        let ends = |pair: usize, sign: f64| {
            // The anchors of a robot with many pairs are as far apart as those of two pairs.
            let anchor = Vec3::new(sign * self.half, 0.0, self.height * (1.0 - PAIR_OVER_HEIGHT * below(pair)));
            (anchor, Vec3::new(sign * 0.5 * a, 0.0, c * (0.5 - below(pair))))
        };

        let paired = (0..pairs).flat_map(|pair| [ends(pair, -1.0), ends(pair, 1.0)]);
        paired.chain((count % 2 == 1).then(|| self.cable_from_above())).collect()
    }

    /// Cables of a platform in the plane z = 0, all around it. Two neighbours cross each other, one above the other,
    /// which holds the rotation.
    fn in_level_plane(&self, count: usize) -> Vec<(Vec3, Vec3)> {
        let ends = |(i, angle): (usize, f64)| {
            let sign = if i % 2 == 0 { 1.0 } else { -1.0 };
            let height = sign * 0.5 * self.sides[2];
            (self.on_circle(angle, height), self.on_platform(angle + sign * TAU / count as f64, height))
        };
        angles(count).enumerate().map(ends).collect()
    }
}

/// Equally spaced angles. The first is half a step from the x axis, so that four are at the corners of a square.
fn angles(count: usize) -> impl Iterator<Item = f64> {
    (0..count).map(move |i| TAU * (i as f64 + 0.5) / count as f64)
}

/// Smallest and largest coordinate along each axis.
pub(super) fn extent(points: impl Iterator<Item = Vec3>) -> [[f64; 2]; 3] {
    points.fold([[f64::INFINITY, f64::NEG_INFINITY]; 3], |extent, point| {
        std::array::from_fn(|i| [extent[i][0].min(point[i]), extent[i][1].max(point[i])])
    })
}

/// Number of metres or degrees with six decimals, finer than any robot is measured.
pub(super) fn rounded(value: f64) -> f64 {
    // Adding zero turns −0 into 0.
    format!("{value:.6}").parse().unwrap_or(value) + 0.0
}

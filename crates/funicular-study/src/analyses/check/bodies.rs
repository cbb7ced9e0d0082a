//! Obstacles, bodies of the platform and required distances of a robot file, as `check` describes them.

use crate::rows::rows;
use crate::text::{short, vector};
use funicular::math::{Vec3, rotation};
use funicular::robot::{Body, RequiredClearance, Solid};

rows! {
    /// Body of a robot file, in the world or in the frame of the platform.
    pub struct CheckedBody {
        pub name: String;
        /// `box`, `cylinder`, `half-space` or `mesh`.
        pub shape: &'static str;
        /// Origin of the body's own frame: the centre of a box or a cylinder, a point in the plane of a half space.
        pub position_m: [f64; 3];
        pub roll_pitch_yaw_deg: [f64; 3];
        /// Ends of the axis of a cylinder; absent for other shapes.
        pub from_m: Option<[f64; 3]>;
        pub to_m: Option<[f64; 3]>;
        /// Edges of a box; absent for other shapes.
        pub size_m: Option<[f64; 3]>;
        pub diameter_m: Option<f64>;
        pub length_m: Option<f64>;
        /// Direction out of a half space; absent for other shapes.
        pub outward: Option<[f64; 3]>;
        /// Number of triangles of a mesh; absent for other shapes.
        pub triangles: Option<usize>;
    }
}

impl CheckedBody {
    pub(super) fn of(body: &Body) -> Self {
        let Body { name, pose, solid } = body;
        let end = |half_length: f64| Some(pose.point_w(&Vec3::new(0.0, 0.0, half_length)).into());
        let none = Self {
            name: name.clone(),
            shape: solid.word(),
            position_m: pose.position_w.into(),
            roll_pitch_yaw_deg: rotation::to_roll_pitch_yaw_deg(&pose.rot_wp),
            from_m: None,
            to_m: None,
            size_m: None,
            diameter_m: None,
            length_m: None,
            outward: None,
            triangles: None,
        };
        match solid {
            Solid::Box { half } => Self { size_m: Some((half * 2.0).into()), ..none },
            Solid::Cylinder { radius, half_length } => Self {
                from_m: end(-half_length),
                to_m: end(*half_length),
                diameter_m: Some(2.0 * radius),
                length_m: Some(2.0 * half_length),
                ..none
            },
            Solid::HalfSpace => Self { outward: Some((pose.rot_wp * Vec3::z()).into()), ..none },
            Solid::Mesh(_) => Self { triangles: Some(body.triangles().len()), ..none },
        }
    }

    /// Size in one phrase.
    pub fn size_text(&self) -> String {
        if let Some(size) = &self.size_m {
            return format!("{} m", size.map(|edge| short(edge, 4)).join(" × "));
        }
        if let (Some(diameter), Some(length)) = (self.diameter_m, self.length_m) {
            return format!("diameter {} m, length {} m", short(diameter, 4), short(length, 4));
        }
        self.triangles.map_or_else(|| "without end".to_owned(), |count| funicular::counted(count, "triangle"))
    }

    /// Place in one phrase.
    pub fn place_text(&self) -> String {
        let at = vector(&self.position_m, 4);
        if let (Some(from), Some(to)) = (&self.from_m, &self.to_m) {
            return format!("from ({}) to ({}) m", vector(from, 4), vector(to, 4));
        }
        if let Some(outward) = &self.outward {
            return format!("behind the plane through ({at}) m with the normal ({})", vector(outward, 4));
        }
        let what = if self.size_m.is_some() { "centre" } else { "origin" };
        let turn = if self.roll_pitch_yaw_deg.iter().all(|angle| *angle == 0.0) {
            String::new()
        } else {
            format!(", roll, pitch, yaw ({})°", vector(&self.roll_pitch_yaw_deg, 3))
        };
        format!("{what} ({at}) m{turn}")
    }
}

rows! {
    /// Distances that have to be kept free.
    pub struct CheckedClearance {
        pub cables_m: f64;
        pub platform_m: f64;
        pub obstacles_m: f64;
        /// Length at the ends of cables that is not compared; absent if the file gives none.
        pub from_end_m: Option<f64>;
    }
}

impl CheckedClearance {
    pub(super) fn of(required: &RequiredClearance) -> Self {
        let RequiredClearance { cables, platform, obstacles, from_end } = *required;
        Self { cables_m: cables, platform_m: platform, obstacles_m: obstacles, from_end_m: from_end }
    }

    /// Distances in one phrase.
    pub fn text(&self) -> String {
        let [cables, platform, obstacles] =
            [self.cables_m, self.platform_m, self.obstacles_m].map(|distance| short(distance, 4));
        let from_end = self.from_end_m.map_or_else(String::new, |length| {
            format!("; the last {} m of each cable are not compared with what they are mounted on", short(length, 4))
        });
        format!("{cables} m between cables, {platform} m to the platform, {obstacles} m to obstacles{from_end}")
    }
}

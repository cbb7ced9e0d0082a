//! What was asked of a sweep, in the words of its files: the same from every front end, or their files would differ.

use crate::{Grid, Part, Record};
use funicular::math::{Vec3, rotation};
use funicular::robot::Pose;
use funicular::sweep::{AXES, Options, Plan, Poses, Quantity};
use serde_json::{Map, Value, json};
use sha2::{Digest, Sha256};

/// Where the points of a sweep come from.
#[derive(Debug, Clone, Copy)]
pub enum Source<'a> {
    /// All poses of a grid; axes that it does not have are those of the base.
    Grid {
        /// The poses.
        poses: &'a Poses,
        /// The pose that the others are taken from.
        base: Option<&'a Pose>,
    },
    /// Poses in a row: position [m], roll, pitch, yaw [degrees].
    List(&'a [[f64; 6]]),
    /// Values of the robot file.
    Values(&'a Grid),
}

/// What was asked beside robot and points; `None` where the user said nothing.
#[derive(Debug, Clone, Copy)]
#[expect(missing_docs, reason = "the fields are the options of the program")]
pub struct Asked<'a> {
    pub options: &'a Options,
    pub quantities: &'a [Quantity],
    pub wanted_tension_n: Option<&'a [f64]>,
    pub min_tension_n: Option<f64>,
    pub max_tension_n: Option<f64>,
    /// Position [m], roll, pitch, yaw [degrees].
    pub pose: Option<[f64; 6]>,
    pub lengths_m: Option<&'a [f64]>,
    pub mass_kg: Option<f64>,
    pub force_n: Option<Vec3>,
    pub moment_n_m: Option<Vec3>,
    pub load_point_m: Option<Vec3>,
    pub wind_m_s: Option<Vec3>,
    pub cable_load_n_per_m: Option<Vec3>,
}

impl Source<'_> {
    /// `map` goes through poses, `sweep` through values of the robot file.
    fn command(&self) -> &'static str {
        match self {
            Self::Grid { .. } | Self::List(_) => "map",
            Self::Values(_) => "sweep",
        }
    }

    fn describe(&self, into: &mut Map<String, Value>) {
        match self {
            Self::Grid { poses, base } => {
                let axes = poses.axes().into_iter().flatten().cloned();
                let grid = Grid(AXES.iter().map(|axis| (*axis).to_owned()).zip(axes).collect());
                into.insert("grid".to_owned(), grid.to_json());
                if let Some(base) = base {
                    into.insert("orientation_wxyz".to_owned(), json!(rotation::quaternion_wxyz(&base.rot_wp)));
                }
            }
            Self::List(poses) => {
                into.insert("poses".to_owned(), json!({ "count": poses.len(), "sha256": digest(poses) }));
            }
            Self::Values(grid) => {
                into.insert("grid".to_owned(), grid.to_json());
            }
        }
    }
}

/// Tells lists of poses apart.
fn digest(poses: &[[f64; 6]]) -> String {
    let mut sha = Sha256::new();
    poses.iter().flatten().for_each(|value| sha.update(value.to_bits().to_le_bytes()));
    format!("{:x}", sha.finalize())
}

impl Asked<'_> {
    /// As keys of a plan; what was not said is not there.
    pub fn describe(&self, into: &mut Map<String, Value>) {
        let vector = |v: Option<Vec3>| v.map(|v| [v.x, v.y, v.z]);
        let options = self.options;
        let value = json!({
            "quantities": self.quantities.iter().map(Quantity::name).collect::<Vec<_>>(),
            "static_model": options.static_model.name(),
            "tension_rule": options.tension_rule.name(),
            "wanted_tension_n": self.wanted_tension_n,
            "min_tension_n": self.min_tension_n,
            "max_tension_n": self.max_tension_n,
            "cable_model": options.linearisation.cable_model.name(),
            "assembly": options.linearisation.assembly.name(),
            "in_plane_only": options.linearisation.in_plane_only,
            "up_to_hz": options.highest_hz,
            "pose": self.pose,
            "lengths_m": self.lengths_m,
            "mass_kg": self.mass_kg,
            "force_n": vector(self.force_n),
            "moment_n_m": vector(self.moment_n_m),
            "load_point_m": vector(self.load_point_m),
            "wind_m_s": vector(self.wind_m_s),
            "cable_load_n_per_m": vector(self.cable_load_n_per_m),
        });
        if let Value::Object(all) = value {
            into.extend(all.into_iter().filter(|(_, value)| !value.is_null()));
        }
    }
}

impl Record {
    /// Of a plan, the text of its robot file, the robot's name, and what was asked.
    pub fn of(
        plan: &Plan,
        robot_file: String,
        name: &str,
        source: Source<'_>,
        asked: &Asked<'_>,
        part: Option<Part>,
    ) -> Self {
        let mut words =
            Map::from_iter([("command".to_owned(), json!(source.command())), ("robot".to_owned(), json!(name))]);
        source.describe(&mut words);
        asked.describe(&mut words);
        Self {
            robot_file,
            plan: words,
            columns: plan.columns().to_vec(),
            rows: plan.rows(),
            chunk_rows: plan.chunk_rows(),
            part,
        }
    }
}

//! `check`: what the robot file says.

use crate::output::Results;
use crate::table::{self, Table, decimals, decimals_or_none, short, vector};
use funicular::math::rotation;
use funicular::robot::{Cable, Damping, Freedoms, Load, Robot, State, TensionLimits, Wind};
use serde::Serialize;
use std::cmp::Ordering;
use std::fmt::Write;

/// The robot as it was read.
#[derive(Serialize)]
pub(crate) struct Checked {
    #[serde(skip)]
    name: String,
    source: String,
    gravity_m_s2: [f64; 3],
    freedoms: usize,
    platform: PlatformRow,
    /// Absent where there is none.
    #[serde(skip_serializing_if = "Option::is_none")]
    load: Option<LoadRow>,
    #[serde(skip_serializing_if = "Option::is_none")]
    wind: Option<WindRow>,
    materials: Vec<MaterialRow>,
    cables: Vec<CableRow>,
    /// `lengths`, `pose` or `none`.
    state: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    pose: Option<PoseRow>,
    #[serde(skip)]
    warnings: Vec<String>,
}

#[derive(Serialize)]
struct PlatformRow {
    freedoms: &'static str,
    /// Only of a planar platform.
    #[serde(skip_serializing_if = "Option::is_none")]
    plane_normal: Option<[f64; 3]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    plane_offset_m: Option<f64>,
    mass_kg: f64,
    inertia_kg_m2: [[f64; 3]; 3],
    center_of_mass_m: [f64; 3],
    #[serde(skip_serializing_if = "Option::is_none")]
    drag_area_m2: Option<f64>,
}

/// A load on the platform.
#[derive(Serialize)]
pub(crate) struct LoadRow {
    force_n: [f64; 3],
    moment_n_m: [f64; 3],
    point_m: [f64; 3],
}

impl LoadRow {
    /// `None` where there is none.
    pub(crate) fn of(load: &Load) -> Option<Self> {
        (load.force_w.norm() > 0.0 || load.moment_w.norm() > 0.0).then(|| Self {
            force_n: load.force_w.into(),
            moment_n_m: load.moment_w.into(),
            point_m: load.point_p.into(),
        })
    }

    /// For people.
    pub(crate) fn text(&self) -> String {
        let [force, moment, point] = [&self.force_n, &self.moment_n_m, &self.point_m].map(|three| vector(three, 4));
        format!("force ({force}) N at ({point}) m of the platform, moment ({moment}) N m")
    }
}

/// The wind.
#[derive(Serialize)]
pub(crate) struct WindRow {
    velocity_m_s: [f64; 3],
    air_density_kg_m3: f64,
}

impl WindRow {
    /// `None` in still air.
    pub(crate) fn of(wind: &Wind) -> Option<Self> {
        (wind.velocity_w.norm() > 0.0)
            .then(|| Self { velocity_m_s: wind.velocity_w.into(), air_density_kg_m3: wind.air_density })
    }

    /// For people.
    pub(crate) fn text(&self) -> String {
        format!("({}) m/s, air of {} kg/m³", vector(&self.velocity_m_s, 3), short(self.air_density_kg_m3, 4))
    }
}

#[derive(Serialize, PartialEq)]
struct MaterialRow {
    name: String,
    axial_stiffness_n: f64,
    mass_kg_per_m: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    damping_ratio: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    viscous_damping_n_s_m2: Option<f64>,
    #[serde(flatten)]
    limits: LimitRow,
    #[serde(skip_serializing_if = "Option::is_none")]
    breaking_load_n: Option<f64>,
    /// Drag coefficient times diameter.
    #[serde(skip_serializing_if = "Option::is_none")]
    drag_width_m: Option<f64>,
}

/// Limits of tension, as far as there are any.
#[derive(Serialize, PartialEq)]
struct LimitRow {
    #[serde(skip_serializing_if = "Option::is_none")]
    minimum_tension_n: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    maximum_tension_n: Option<f64>,
}

impl LimitRow {
    fn of(limits: TensionLimits) -> Self {
        Self { minimum_tension_n: limits.minimum, maximum_tension_n: limits.maximum }
    }

    fn cells(&self) -> [String; 2] {
        [or_none(self.minimum_tension_n), or_none(self.maximum_tension_n)]
    }
}

fn or_none(value: Option<f64>) -> String {
    value.map_or_else(|| table::NONE.to_owned(), |value| short(value, 4))
}

#[derive(Serialize)]
struct CableRow {
    name: String,
    material: String,
    anchor_m: [f64; 3],
    attachment_m: [f64; 3],
    #[serde(skip_serializing_if = "Option::is_none")]
    unstrained_length_m: Option<f64>,
    /// Its own or those of its rope.
    #[serde(flatten)]
    limits: LimitRow,
    /// Besides weight and wind; absent where there is none.
    #[serde(skip_serializing_if = "Option::is_none")]
    load_n_per_m: Option<[f64; 3]>,
}

#[derive(Serialize)]
struct PoseRow {
    position_m: [f64; 3],
    roll_pitch_yaw_deg: [f64; 3],
}

pub(crate) fn run(robot: Robot) -> Checked {
    let mut materials: Vec<MaterialRow> = Vec::new();
    for cable in &robot.cables {
        let rope = &cable.material;
        let (damping_ratio, viscous_damping_n_s_m2) = match rope.damping {
            Damping::Ratio(ratio) => (Some(ratio), None),
            Damping::Viscous(coefficient) => (None, Some(coefficient)),
        };
        let row = MaterialRow {
            name: rope.name.clone(),
            axial_stiffness_n: rope.axial_stiffness,
            mass_kg_per_m: rope.mass_per_length,
            damping_ratio,
            viscous_damping_n_s_m2,
            limits: LimitRow::of(rope.tension_limits),
            breaking_load_n: rope.breaking_load,
            drag_width_m: rope.drag_width,
        };
        if !materials.contains(&row) {
            materials.push(row);
        }
    }
    let lengths = match &robot.state {
        State::Lengths(lengths) => Some(lengths),
        State::Pose(_) | State::Unknown => None,
    };
    let cables = robot
        .cables
        .iter()
        .enumerate()
        .map(|(i, cable)| CableRow {
            name: cable.name.clone(),
            material: cable.material.name.clone(),
            anchor_m: cable.anchor_w.into(),
            attachment_m: cable.attachment_p.into(),
            unstrained_length_m: lengths.map(|lengths| lengths[i]),
            limits: LimitRow::of(cable.limits()),
            load_n_per_m: (cable.load_per_length_w.norm() > 0.0).then(|| cable.load_per_length_w.into()),
        })
        .collect();
    let (state, pose) = match &robot.state {
        State::Lengths(_) => ("lengths", None),
        State::Pose(pose) => {
            let row = PoseRow {
                position_m: pose.position_w.into(),
                roll_pitch_yaw_deg: rotation::to_roll_pitch_yaw_deg(&pose.rot_wp),
            };
            ("pose", Some(row))
        }
        State::Unknown => ("none", None),
    };
    let inertia = robot.platform.inertia_p;
    let freedoms = robot.platform.freedoms.count();
    let plane = match robot.platform.freedoms {
        Freedoms::Planar(plane) => Some(plane),
        Freedoms::Rigid | Freedoms::PointMass => None,
    };
    Checked {
        warnings: warnings(&robot),
        name: robot.name,
        source: robot.source,
        gravity_m_s2: robot.gravity_w.into(),
        freedoms,
        platform: PlatformRow {
            freedoms: robot.platform.freedoms.name(),
            plane_normal: plane.map(|plane| plane.normal_w().into()),
            plane_offset_m: plane.map(|plane| plane.offset()),
            mass_kg: robot.platform.mass,
            inertia_kg_m2: std::array::from_fn(|i| std::array::from_fn(|j| inertia[(i, j)])),
            center_of_mass_m: robot.platform.center_of_mass_p.into(),
            drag_area_m2: (robot.platform.drag_area > 0.0).then_some(robot.platform.drag_area),
        },
        load: LoadRow::of(&robot.load),
        wind: WindRow::of(&robot.wind),
        materials,
        cables,
        state,
        pose,
    }
}

fn warnings(robot: &Robot) -> Vec<String> {
    let (cables, freedoms) = (robot.cables.len(), robot.platform.freedoms.count());
    let mut warnings = Vec::new();
    if cables < freedoms {
        warnings.push(format!(
            "{cables} cables for {freedoms} freedoms: from lengths the platform hangs where its energy is least; of a pose \
             that they cannot hold, statics gives the nearest that they can"
        ));
    }
    if let Freedoms::Planar(plane) = robot.platform.freedoms {
        let across = |cable: &Cable| plane.distance(&cable.anchor_w) - plane.normal_w().dot(&cable.attachment_p);
        let beside: Vec<String> = robot
            .cables
            .iter()
            .filter(|cable| across(cable).abs() > 1e-9 * (1.0 + cable.anchor_w.norm()))
            .map(|cable| format!("\"{}\" by {} m", cable.name, short(across(cable), 4)))
            .collect();
        if !beside.is_empty() {
            warnings.push(format!(
                "cables leave the plane of the platform: {}; what they pull across it is carried by the guide, which has no \
                 friction and does not yield here",
                beside.join(", ")
            ));
        }
        let across = plane.normal_w().dot(&robot.gravity_w);
        if across.abs() > 1e-9 * robot.gravity_w.norm() {
            warnings.push(format!(
                "gravity has {} m/s² across the plane of the platform: the guide carries it, and cables sag out of the plane",
                short(across, 4)
            ));
        }
    }
    warnings
}

impl Results for Checked {
    const COMMAND: &'static str = "check";

    fn robot(&self) -> &str {
        &self.name
    }

    fn warnings(&self) -> &[String] {
        &self.warnings
    }

    fn text(&self) -> String {
        let mut out = format!("{}\n", self.name);
        let mut say = |line: String| out.push_str(&(line + "\n"));
        if !self.source.is_empty() {
            say(format!("  source      {}", self.source));
        }
        let (cables, freedoms) = (self.cables.len(), self.freedoms);
        let redundancy = match cables.cmp(&freedoms) {
            Ordering::Less => format!("{} fewer than freedoms", freedoms - cables),
            Ordering::Equal => "as many as freedoms".to_owned(),
            Ordering::Greater => format!("{} more than freedoms", cables - freedoms),
        };
        say(format!("  cables      {}, {redundancy}", self.cables.len()));
        let platform = &self.platform;
        let kind = match (platform.plane_normal, platform.plane_offset_m) {
            (Some(normal), Some(offset)) => {
                format!(
                    "{} platform, plane with normal ({}), {} m from the origin",
                    platform.freedoms,
                    vector(&normal, 4),
                    short(offset, 4)
                )
            }
            _ if platform.freedoms == Freedoms::PointMass.name() => "point mass".to_owned(),
            _ => "rigid platform".to_owned(),
        };
        say(format!("  platform    {kind}, {} kg", short(platform.mass_kg, 6)));
        if platform.freedoms != Freedoms::PointMass.name() {
            let rows = platform.inertia_kg_m2;
            let cell = |i: usize, j: usize| short(rows[i][j], 5);
            say(format!(
                "  inertia     xx {}, yy {}, zz {}, xy {}, xz {}, yz {} kg m² about the centre of mass",
                cell(0, 0),
                cell(1, 1),
                cell(2, 2),
                cell(0, 1),
                cell(0, 2),
                cell(1, 2)
            ));
            say(format!("  mass centre ({}) m in the platform frame", vector(&platform.center_of_mass_m, 4)));
        }
        say(format!("  gravity     ({}) m/s²", vector(&self.gravity_m_s2, 4)));
        if let Some(load) = &self.load {
            say(format!("  load        {}", load.text()));
        }
        if let Some(wind) = &self.wind {
            say(format!("  wind        {}", wind.text()));
        }
        if let Some(area) = platform.drag_area_m2 {
            say(format!("  drag area   {} m² (drag coefficient times area), in the centre of mass", short(area, 4)));
        }
        let state = match &self.pose {
            Some(pose) => format!(
                "pose ({}) m, roll, pitch, yaw ({})°",
                vector(&pose.position_m, 4),
                vector(&pose.roll_pitch_yaw_deg, 3)
            ),
            None if self.state == "lengths" => "unstrained lengths".to_owned(),
            None => "none: analyses need --lengths-m or --pose".to_owned(),
        };
        say(format!("  state       {state}"));
        out + "\n" + &self.rope_table() + "\n" + &self.cable_table()
    }

    fn csv(&self, out: &mut csv::Writer<Vec<u8>>) -> csv::Result<()> {
        out.write_record([
            "name",
            "material",
            "anchor_x_m",
            "anchor_y_m",
            "anchor_z_m",
            "attachment_x_m",
            "attachment_y_m",
            "attachment_z_m",
            "unstrained_length_m",
            "minimum_tension_n",
            "maximum_tension_n",
            "load_x_n_per_m",
            "load_y_n_per_m",
            "load_z_n_per_m",
        ])?;
        for c in &self.cables {
            let LimitRow { minimum_tension_n, maximum_tension_n } = c.limits;
            let limits = (minimum_tension_n, maximum_tension_n);
            let load = c.load_n_per_m.unwrap_or_default();
            out.serialize((&c.name, &c.material, c.anchor_m, c.attachment_m, c.unstrained_length_m, limits, load))?;
        }
        Ok(())
    }
}

impl Checked {
    fn rope_table(&self) -> String {
        let limited = |rope: &MaterialRow| rope.limits.cells().iter().any(|cell| cell != table::NONE);
        let limited = self.materials.iter().any(|rope| limited(rope) || rope.breaking_load_n.is_some());
        let header = [
            "rope",
            "EA [N]",
            "mass [kg/m]",
            "damping ratio",
            "viscous damping [N s/m²]",
            "least T [N]",
            "greatest T [N]",
            "breaks at [N]",
            "drag width [m]",
        ];
        let dragged = self.materials.iter().any(|rope| rope.drag_width_m.is_some());
        let mut columns = header[..if limited { 8 } else { 5 }].to_vec();
        columns.extend(dragged.then_some(header[8]));
        let mut ropes = Table::new(&columns);
        for rope in &self.materials {
            let mut row = vec![
                rope.name.clone(),
                short(rope.axial_stiffness_n, 6),
                short(rope.mass_kg_per_m, 5),
                or_none(rope.damping_ratio),
                or_none(rope.viscous_damping_n_s_m2),
            ];
            if limited {
                row.extend(rope.limits.cells());
                row.push(or_none(rope.breaking_load_n));
            }
            if dragged {
                row.push(or_none(rope.drag_width_m));
            }
            ropes.row(row);
        }
        ropes.to_string()
    }

    fn cable_table(&self) -> String {
        let limited = self.cables.iter().any(|cable| cable.limits.cells().iter().any(|cell| cell != table::NONE));
        let header =
            ["cable", "rope", "anchor [m]", "attachment [m]", "unstrained [m]", "least T [N]", "greatest T [N]"];
        let loaded = self.cables.iter().any(|cable| cable.load_n_per_m.is_some());
        let mut columns = header[..if limited { 7 } else { 5 }].to_vec();
        columns.extend(loaded.then_some("load [N/m]"));
        let mut cables = Table::new(&columns).text_columns(&[1]);
        for cable in &self.cables {
            let point = |values: &[f64; 3]| {
                values.iter().fold(String::new(), |mut text, value| {
                    let _ = write!(text, "{:>10}", decimals(*value, 4));
                    text
                })
            };
            let mut row = vec![
                cable.name.clone(),
                cable.material.clone(),
                point(&cable.anchor_m),
                point(&cable.attachment_m),
                decimals_or_none(cable.unstrained_length_m, 4),
            ];
            if limited {
                row.extend(cable.limits.cells());
            }
            if loaded {
                row.push(cable.load_n_per_m.as_ref().map_or_else(|| table::NONE.to_owned(), point));
            }
            cables.row(row);
        }
        cables.to_string()
    }
}

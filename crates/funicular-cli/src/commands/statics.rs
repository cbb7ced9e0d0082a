//! `statics`: the equilibrium.

use crate::args::StaticsArgs;
use crate::commands::check::LoadRow;
use crate::output::Results;
use crate::state::{self, AtRest, SagNumbers};
use crate::table::{self, Table, decimals, decimals_or_none, short, significant, vector};
use anyhow::Result;
use funicular::cable::Sag;
use funicular::math::rotation;
use funicular::robot::{Robot, TensionLimits};
use funicular::statics::{Limit, Stability, TensionMargin, TensionRange};
use serde::Serialize;

#[derive(Serialize)]
pub(crate) struct Statics {
    #[serde(skip)]
    robot: String,
    static_model: &'static str,
    mass_kg: f64,
    /// On the platform; absent where there is none.
    #[serde(skip_serializing_if = "Option::is_none")]
    load: Option<LoadRow>,
    pose: PoseRow,
    /// Distance from the pose asked; absent where the cables are as many as the freedoms, or lengths were given.
    #[serde(skip_serializing_if = "Option::is_none")]
    nearest_pose_distance_m: Option<f64>,
    /// Absent where the tensions were no choice.
    #[serde(skip_serializing_if = "Option::is_none")]
    tension_rule: Option<&'static str>,
    cables: Vec<CableRow>,
    residual: f64,
    iterations: usize,
    /// Absent for ideal cables, which are rigid.
    #[serde(skip_serializing_if = "Option::is_none")]
    stable: Option<bool>,
    #[serde(skip_serializing_if = "Option::is_none")]
    least_stiffness_n_per_m: Option<f64>,
    #[serde(skip)]
    warnings: Vec<String>,
}

#[derive(Serialize)]
struct PoseRow {
    position_m: [f64; 3],
    quaternion_wxyz: [f64; 4],
    roll_pitch_yaw_deg: [f64; 3],
}

#[derive(Serialize)]
struct CableRow {
    name: String,
    unstrained_length_m: f64,
    tension_platform_n: f64,
    tension_anchor_n: f64,
    chord_m: f64,
    #[serde(flatten)]
    sag: SagNumbers,
    force_on_platform_n: [f64; 3],
    /// Absent where neither the file nor a rule has limits.
    #[serde(flatten)]
    limits: Option<LimitNumbers>,
}

/// The limits of a cable's tension, and how far it is from them.
#[derive(Serialize)]
struct LimitNumbers {
    minimum_tension_n: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    maximum_tension_n: Option<f64>,
    /// Distance from the nearer limit; absent without any.
    tension_margin_n: f64,
    /// The same over the distance between the limits.
    #[serde(skip_serializing_if = "Option::is_none")]
    tension_margin: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    limit_reached: Option<&'static str>,
}

impl LimitNumbers {
    fn of(margin: &TensionMargin) -> Self {
        let TensionRange { minimum, maximum } = margin.range;
        Self {
            minimum_tension_n: minimum,
            maximum_tension_n: maximum.is_finite().then_some(maximum),
            tension_margin_n: margin.distance(),
            tension_margin: margin.relative(),
            limit_reached: margin.reached().map(|limit| match limit {
                Limit::Minimum => "minimum",
                Limit::Maximum => "maximum",
            }),
        }
    }

    fn cells(&self) -> [String; 2] {
        let maximum = self.maximum_tension_n.map_or_else(|| "∞".to_owned(), |maximum| short(maximum, 4));
        let margin = match self.limit_reached {
            Some(limit) if self.tension_margin_n.abs() <= 1e-6 * self.minimum_tension_n.max(1.0) => limit.to_owned(),
            _ => decimals(self.tension_margin_n, 1),
        };
        [format!("{} to {maximum}", short(self.minimum_tension_n, 4)), margin]
    }
}

pub(crate) fn run(robot: Robot, args: &StaticsArgs) -> Result<Statics> {
    let (at_rest, rule) = state::equilibrium_with(robot, &args.state, &args.tensions)?;
    let AtRest { robot, equilibrium, .. } = &at_rest;
    let limited = rule.is_some() || robot.cables.iter().any(|cable| cable.limits() != TensionLimits::default());
    let cables = equilibrium
        .cables
        .iter()
        .enumerate()
        .map(|(i, cable)| CableRow {
            name: robot.cables[i].name.clone(),
            unstrained_length_m: cable.unstrained_length,
            tension_platform_n: cable.tension_platform,
            tension_anchor_n: cable.tension_anchor,
            chord_m: cable.chord(),
            sag: SagNumbers::of(&Sag::of(robot, i, cable)),
            force_on_platform_n: cable.force_on_platform_w.into(),
            limits: limited.then(|| LimitNumbers::of(&TensionRange::of(robot, i, cable.chord()).margin(cable))),
        })
        .collect();
    let (stable, least_stiffness_n_per_m) = match equilibrium.stability {
        Stability::Stable { least_stiffness } => (Some(true), Some(least_stiffness)),
        Stability::Unstable { least_stiffness, .. } => (Some(false), Some(least_stiffness)),
        Stability::Rigid => (None, None),
    };
    let pose = &equilibrium.pose;
    Ok(Statics {
        warnings: at_rest.warnings(None),
        robot: robot.name.clone(),
        static_model: equilibrium.model.name(),
        mass_kg: robot.platform.mass,
        load: LoadRow::of(&robot.load),
        pose: PoseRow {
            position_m: pose.position_w.into(),
            quaternion_wxyz: rotation::quaternion_wxyz(&pose.rot_wp),
            roll_pitch_yaw_deg: rotation::to_roll_pitch_yaw_deg(&pose.rot_wp),
        },
        nearest_pose_distance_m: at_rest.instead_of.map(|(_, distance)| distance),
        tension_rule: rule.map(|rule| rule.name()),
        cables,
        residual: equilibrium.residual,
        iterations: equilibrium.iterations,
        stable,
        least_stiffness_n_per_m,
    })
}

impl Results for Statics {
    const COMMAND: &'static str = "statics";

    fn robot(&self) -> &str {
        &self.robot
    }

    fn warnings(&self) -> &[String] {
        &self.warnings
    }

    fn text(&self) -> String {
        let limited = self.cables.iter().any(|cable| cable.limits.is_some());
        let header = [
            "cable",
            "unstrained [m]",
            "chord [m]",
            "T platform [N]",
            "T anchor [N]",
            "sag/chord",
            "λ²",
            "string [Hz]",
            "limits [N]",
            "margin [N]",
        ];
        let mut cables = Table::new(&header[..if limited { 10 } else { 8 }]);
        let or_none = |value: Option<f64>| value.map_or_else(|| table::NONE.to_owned(), |v| significant(v, 4));
        for cable in &self.cables {
            let mut row = vec![
                cable.name.clone(),
                decimals(cable.unstrained_length_m, 4),
                decimals(cable.chord_m, 4),
                decimals(cable.tension_platform_n, 3),
                decimals(cable.tension_anchor_n, 3),
                decimals_or_none(cable.sag.sag_ratio, 5),
                or_none(cable.sag.lambda2),
                decimals_or_none(cable.sag.string_frequency_hz, 3),
            ];
            row.extend(cable.limits.iter().flat_map(LimitNumbers::cells));
            cables.row(row);
        }
        let stability = match (self.stable, self.least_stiffness_n_per_m) {
            (Some(true), Some(least)) => format!("Stable, least stiffness {} N/m", significant(least, 4)),
            (Some(false), Some(least)) => format!("NOT STABLE, least stiffness {} N/m", significant(least, 4)),
            _ => "Rigid cables: no stiffness".to_owned(),
        };
        let rule = self.tension_rule.map_or_else(String::new, |rule| format!(", tensions by the rule `{rule}`"));
        let load = self.load.as_ref().map_or_else(String::new, |load| format!(", {}", load.text()));
        let nearest = self.nearest_pose_distance_m.map_or_else(String::new, |distance| {
            format!("  nearest pose that the cables can hold, {} m from the one asked\n", short(distance, 4))
        });
        format!(
            "{}: equilibrium with {} cables, {} kg{load}{rule}\n\n  position         ({}) m\n  roll, pitch, yaw ({})°\n{nearest}\n\
             {cables}\n{stability}. Residual {:.1e} after {}.\n",
            self.robot,
            self.static_model,
            short(self.mass_kg, 6),
            vector(&self.pose.position_m, 6),
            vector(&self.pose.roll_pitch_yaw_deg, 4),
            self.residual,
            table::counted(self.iterations, "iteration"),
        )
    }

    fn csv(&self, out: &mut csv::Writer<Vec<u8>>) -> csv::Result<()> {
        out.write_record([
            "name",
            "unstrained_length_m",
            "tension_platform_n",
            "tension_anchor_n",
            "chord_m",
            "sag_ratio",
            "lambda2",
            "string_frequency_hz",
            "force_on_platform_x_n",
            "force_on_platform_y_n",
            "force_on_platform_z_n",
            "minimum_tension_n",
            "maximum_tension_n",
            "tension_margin_n",
            "limit_reached",
        ])?;
        for c in &self.cables {
            let limits = c.limits.as_ref();
            out.serialize((
                &c.name,
                c.unstrained_length_m,
                c.tension_platform_n,
                c.tension_anchor_n,
                c.chord_m,
                c.sag.sag_ratio,
                c.sag.lambda2,
                c.sag.string_frequency_hz,
                c.force_on_platform_n,
                limits.map(|l| l.minimum_tension_n),
                limits.and_then(|l| l.maximum_tension_n),
                limits.map(|l| l.tension_margin_n),
                limits.and_then(|l| l.limit_reached),
            ))?;
        }
        Ok(())
    }
}

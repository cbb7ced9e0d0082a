//! `statics`: the equilibrium.

use crate::args::StateArgs;
use crate::output::Results;
use crate::state::{self, AtRest, SagNumbers, static_model_name};
use crate::table::{self, Table, decimals, decimals_or_none, short, significant, vector};
use anyhow::Result;
use funicular::cable::Sag;
use funicular::math::rotation;
use funicular::robot::Robot;
use funicular::statics::Stability;
use serde::Serialize;

#[derive(Serialize)]
pub(crate) struct Statics {
    #[serde(skip)]
    robot: String,
    static_model: &'static str,
    mass_kg: f64,
    pose: PoseRow,
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
}

pub(crate) fn run(robot: Robot, args: &StateArgs) -> Result<Statics> {
    let at_rest = state::equilibrium(robot, args)?;
    let AtRest { robot, equilibrium } = &at_rest;
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
        static_model: static_model_name(equilibrium.model),
        mass_kg: robot.platform.mass,
        pose: PoseRow {
            position_m: pose.position_w.into(),
            quaternion_wxyz: rotation::quaternion_wxyz(&pose.rot_wp),
            roll_pitch_yaw_deg: rotation::to_roll_pitch_yaw_deg(&pose.rot_wp),
        },
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
        let mut cables = Table::new(&[
            "cable",
            "unstrained [m]",
            "chord [m]",
            "T platform [N]",
            "T anchor [N]",
            "sag/chord",
            "λ²",
            "string [Hz]",
        ]);
        let or_none = |value: Option<f64>| value.map_or_else(|| table::NONE.to_owned(), |v| significant(v, 4));
        for cable in &self.cables {
            cables.row(vec![
                cable.name.clone(),
                decimals(cable.unstrained_length_m, 4),
                decimals(cable.chord_m, 4),
                decimals(cable.tension_platform_n, 3),
                decimals(cable.tension_anchor_n, 3),
                decimals_or_none(cable.sag.sag_ratio, 5),
                or_none(cable.sag.lambda2),
                decimals_or_none(cable.sag.string_frequency_hz, 3),
            ]);
        }
        let stability = match (self.stable, self.least_stiffness_n_per_m) {
            (Some(true), Some(least)) => format!("Stable, least stiffness {} N/m", significant(least, 4)),
            (Some(false), Some(least)) => format!("NOT STABLE, least stiffness {} N/m", significant(least, 4)),
            _ => "Rigid cables: no stiffness".to_owned(),
        };
        format!(
            "{}: equilibrium with {} cables, {} kg\n\n  position         ({}) m\n  roll, pitch, yaw ({})°\n\n\
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
        ])?;
        for c in &self.cables {
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
            ))?;
        }
        Ok(())
    }
}

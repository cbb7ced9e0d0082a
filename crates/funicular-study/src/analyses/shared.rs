//! Rows that several commands share.

use crate::at_rest::AtRest;
use funicular::cable::Sag;
use funicular::dynamics::Linearisation;
use funicular::math::rotation;
use funicular::pose_error::PoseDifference;
use funicular::robot::Pose;
use funicular::robot::WinchMode;
use funicular::statics::TensionRule;
use serde::Serialize;

/// Models used for a result, by the names that JSON has.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct Models {
    pub static_model: &'static str,
    pub cable_model: &'static str,
    pub assembly: &'static str,
    pub in_plane_only: bool,
    /// Winches in vibration; absent if they are as in the robot file.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub winches: Option<&'static str>,
    #[serde(flatten)]
    pub origin: Origin,
}

/// Origin of the tensions of an equilibrium.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct Origin {
    /// Rule that chose the tensions; absent if there was no choice.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tension_rule: Option<&'static str>,
    /// True if the unstrained lengths of a pose are held; absent otherwise.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub lengths_held: bool,
}

impl Origin {
    pub fn of(at_rest: &AtRest) -> Self {
        let tension_rule = at_rest.rule.as_ref().map(TensionRule::name);
        Self { tension_rule, lengths_held: at_rest.held_pose.is_some() }
    }

    /// Description that continues a line; empty if the tensions follow from the state alone.
    pub fn phrase(&self) -> String {
        let rule = self.tension_rule.map_or_else(String::new, |rule| format!(", tensions by the rule `{rule}`"));
        format!("{rule}{}", if self.lengths_held { ", lengths of the pose held" } else { "" })
    }
}

impl Models {
    pub fn of(at_rest: &AtRest, linearisation: Linearisation) -> Self {
        Self {
            origin: Origin::of(at_rest),
            static_model: at_rest.equilibrium.model.name(),
            cable_model: linearisation.cable_model.name(),
            assembly: linearisation.assembly.name(),
            in_plane_only: linearisation.in_plane_only,
            winches: Some(linearisation.winches).filter(|mode| *mode != WinchMode::AsGiven).map(WinchMode::name),
        }
    }

    /// Description in one line.
    pub fn line(&self) -> String {
        let plane = if self.in_plane_only { ", in plane only" } else { "" };
        let winches = self.winches.map_or_else(String::new, |mode| format!(", winches {mode}"));
        let origin = self.origin.phrase();
        format!(
            "{} statics, {} cables, {} assembly{plane}{winches}{origin}",
            self.static_model, self.cable_model, self.assembly
        )
    }
}

/// Numbers of a cable's sag for JSON. They are absent for a cable without tension. The string frequency is also absent
/// for a cable without mass.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct SagNumbers {
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sag_ratio: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lambda2: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub string_frequency_hz: Option<f64>,
}

impl SagNumbers {
    pub fn of(sag: &Sag) -> Self {
        let taut = sag.tension > 0.0;
        Self {
            sag_ratio: taut.then(|| sag.ratio()),
            lambda2: taut.then_some(sag.lambda2),
            string_frequency_hz: taut.then(|| sag.string_frequency_hz()).filter(|f| f.is_finite()),
        }
    }
}

/// Pose of the platform.
#[derive(Serialize)]
pub struct PoseRow {
    pub position_m: [f64; 3],
    pub quaternion_wxyz: [f64; 4],
    pub roll_pitch_yaw_deg: [f64; 3],
}

impl PoseRow {
    pub fn of(pose: &Pose) -> Self {
        Self {
            position_m: pose.position_w.into(),
            quaternion_wxyz: rotation::quaternion_wxyz(&pose.rot_wp),
            roll_pitch_yaw_deg: rotation::to_roll_pitch_yaw_deg(&pose.rot_wp),
        }
    }
}

/// Translation and rotation between two poses.
#[derive(Serialize, Clone, Copy)]
pub struct PoseDifferenceRow {
    pub translation_m: [f64; 3],
    pub distance_m: f64,
    pub angle_deg: f64,
}

impl From<PoseDifference> for PoseDifferenceRow {
    fn from(difference: PoseDifference) -> Self {
        Self {
            translation_m: difference.translation,
            distance_m: difference.distance,
            angle_deg: difference.angle.to_degrees(),
        }
    }
}

//! Ropes over sheaves: the robots of the tests, and the subjects in the files of the folder.
//!
//! - `statics`: block and tackle, ellipse and heavy ropes, stiffness against differences, poses, refused files
//! - `vibration`: modes against closed forms and against the static stiffness

mod statics;
mod vibration;

use funicular::robot::Robot;
use std::fmt::Write;

/// Cable of a robot of these tests: anchor, attachment, unstrained length, and the cable before it on its rope.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fall {
    pub anchor_m: [f64; 3],
    pub attachment_m: Option<[f64; 3]>,
    pub length_m: Option<f64>,
    pub continues: Option<usize>,
    pub more: &'static str,
}

impl Fall {
    pub(super) fn new(anchor_m: [f64; 3], length_m: Option<f64>, continues: Option<usize>) -> Self {
        Self { anchor_m, attachment_m: None, length_m, continues, more: "" }
    }

    /// Cable of 5 m to a point of [`BODY`], with further keys.
    pub(super) fn of_body(
        anchor_m: [f64; 3],
        attachment_m: [f64; 3],
        continues: Option<usize>,
        more: &'static str,
    ) -> Self {
        Self { anchor_m, attachment_m: Some(attachment_m), length_m: Some(5.0), continues, more }
    }
}

/// Robot file with the platform, the rope and these cables, named from "1" on.
pub(super) fn text_of(platform: &str, rope: &str, falls: &[Fall]) -> String {
    let mut text = format!("name = \"falls\"\n[platform]\n{platform}\n[materials.rope]\n{rope}\n");
    text.push_str("[pulleys.wheel]\nradius_m = 0.1\nentry_direction = [0, 0, 1]\n");
    text.push_str("[winches.drum]\ndrum_side_length_m = 2.0\nstiffness_n_per_m = 3e5\n");
    for (i, fall) in falls.iter().enumerate() {
        let _ = write!(
            text,
            "[[cables]]\nname = \"{}\"\nmaterial = \"rope\"\nanchor_m = {:?}\n{}\n",
            i + 1,
            fall.anchor_m,
            fall.more
        );
        if let Some(attachment) = fall.attachment_m {
            let _ = writeln!(text, "attachment_m = {attachment:?}");
        }
        if let Some(length) = fall.length_m {
            let _ = writeln!(text, "unstrained_length_m = {length:?}");
        }
        if let Some(before) = fall.continues {
            let _ = writeln!(text, "shares_rope_with = \"{}\"", before + 1);
        }
    }
    text
}

pub(super) fn robot_of(platform: &str, rope: &str, falls: &[Fall]) -> Robot {
    Robot::from_toml(&text_of(platform, rope, falls)).unwrap()
}

pub(super) const BODY: &str = "mass_kg = 300.0\ninertia_kg_m2 = [20.0, 25.0, 30.0]";
pub(super) const POINT: &str = "mass_kg = 100.0\nmotion = \"point-mass\"";
pub(super) const LIGHT: &str = "axial_stiffness_n = 2e5\nmass_kg_per_m = 0.0";
pub(super) const HEAVY: &str = "axial_stiffness_n = 2e5\nmass_kg_per_m = 0.8";

/// Mass of 100 kg that hangs in a rope between two anchors at different heights.
pub(super) fn hanging(rope: &str, lengths: [f64; 2]) -> Robot {
    let falls =
        [Fall::new([-3.0, 0.0, 1.0], Some(lengths[0]), None), Fall::new([2.0, 0.0, -0.5], Some(lengths[1]), Some(0))];
    robot_of(POINT, rope, &falls)
}

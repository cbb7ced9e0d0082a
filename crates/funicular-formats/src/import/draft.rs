//! Draft of a robot during an import: facts of the source, additions from options, assumptions and losses.

pub(crate) mod file;

use anyhow::{Result, anyhow, bail};
use funicular::math::{Mat3, Rotation, Vec3};
use funicular::robot::{Pose, Robot};
use funicular::statics::TensionRange;
use funicular_study::at_rest;
use funicular_study::request::{self, ImportPlatform, ImportRopes};
use std::collections::BTreeSet;

/// Deviation of the cosine from 1 of an axis that rounding turns away from a coordinate axis.
const MAX_TILT: f64 = 1e-9;
/// Relative difference of two products of the same numbers: some units in the last place, far below the tolerance of
/// any rope.
const MAX_ROUNDING: f64 = 1e-14;

/// Facts of a source about a robot.
pub(crate) struct Draft {
    pub(crate) name: String,
    /// Source of the numbers: program, files, cable set.
    pub(crate) source: String,
    /// Acceleration of gravity, world axes [m/s²].
    pub(crate) gravity_w: Vec3,
    pub(crate) platform: DraftPlatform,
    pub(crate) cables: Vec<DraftCable>,
    pub(crate) state: DraftState,
    /// Payload that the robot has to carry [kg].
    pub(crate) payload: Option<f64>,
    /// Changes of the numbers that do not change the robot.
    pub(crate) notes: Vec<String>,
    /// Assumptions that the source does not state.
    pub(crate) assumed: Vec<String>,
    /// Facts of the source that the robot file does not hold.
    pub(crate) lost: Vec<String>,
}

/// Moving platform of a draft.
pub(crate) struct DraftPlatform {
    /// Mass [kg]; `None` if the source has none.
    pub(crate) mass: Option<f64>,
    /// Inertia tensor about the centre of mass, platform axes [kg m²]; `None` if the source has no physically possible
    /// one.
    pub(crate) inertia_p: Option<Mat3>,
    /// Centre of mass in the platform frame [m]; `None` if the source has none.
    pub(crate) center_of_mass_p: Option<Vec3>,
    pub(crate) motion: DraftMotion,
    /// Place of mass and inertia in the source: `file:line`, with the column in XML.
    pub(crate) place: String,
}

/// Motion that the platform can have.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum DraftMotion {
    Rigid,
    /// Translations only.
    PointMass,
    /// Translations along two world axes and rotation about the third.
    Planar {
        /// Name of the plane.
        plane: &'static str,
    },
}

impl DraftMotion {
    /// Planar motion in the coordinate plane with this normal, of any length; `None` for other planes.
    pub(crate) fn with_normal(normal_w: &Vec3) -> Option<Self> {
        let normal = normal_w.try_normalize(0.0)?;
        let axis = (0..3).find(|axis| normal[*axis].abs() > 1.0 - MAX_TILT)?;
        Some(Self::Planar { plane: ["yz", "xz", "xy"][axis] })
    }

    /// World axis normal to the plane of a planar platform: 0, 1 or 2 for x, y or z.
    fn normal_axis(self) -> Option<usize> {
        match self {
            Self::Planar { plane: "yz" } => Some(0),
            Self::Planar { plane: "xz" } => Some(1),
            Self::Planar { .. } => Some(2),
            Self::Rigid | Self::PointMass => None,
        }
    }
}

/// Cable of a draft.
pub(crate) struct DraftCable {
    pub(crate) name: String,
    /// Anchor in the world frame [m].
    pub(crate) anchor_w: Vec3,
    /// Attachment in the platform frame [m].
    pub(crate) attachment_p: Vec3,
    pub(crate) rope: DraftRope,
    /// Minimum and maximum tension [N].
    pub(crate) limits: [Option<f64>; 2],
    /// Unstrained length [m].
    pub(crate) unstrained_length: Option<f64>,
    /// Pulley at the anchor, whose entry point is the anchor.
    pub(crate) pulley: Option<DraftPulley>,
    pub(crate) winch: Option<DraftWinch>,
}

/// Winch of a draft: what its source says of it, by the keys of a robot file. The cable has no length between its drum
/// and its anchor.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct DraftWinch {
    /// Name in the source; may be empty.
    pub(crate) name: String,
    /// Keys with their values, SI units.
    pub(crate) values: Vec<(&'static str, f64)>,
}

/// Pulley of a draft.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct DraftPulley {
    /// Radius of the wheel [m].
    pub(crate) radius: f64,
    /// Direction of travel at the entry point towards the platform, of any length, world axes.
    pub(crate) entry_direction_w: Vec3,
}

/// Rope of a draft, with the properties that the source gives.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct DraftRope {
    /// Name in the source; may be empty.
    pub(crate) name: String,
    /// Mass per unstrained length [kg/m].
    pub(crate) mass_per_length: Option<f64>,
    /// Axial stiffness EA [N].
    pub(crate) axial_stiffness: Option<f64>,
    /// Young's modulus of the full circular section [Pa].
    pub(crate) youngs_modulus: Option<f64>,
    /// Diameter [m].
    pub(crate) diameter: Option<f64>,
    /// Breaking load [N].
    pub(crate) breaking_load: Option<f64>,
}

/// State of the robot in the source.
pub(crate) enum DraftState {
    /// Given by the unstrained lengths of the cables.
    Lengths,
    Pose(Pose),
    Unknown,
}

impl Draft {
    /// Draft of a robot from a program that has rigid bodies and springs only. Axial stiffnesses that differ by the
    /// rounding of a product are one; a body whose cables all end at its origin, which is
    /// its centre of mass, feels no moment and is a point mass.
    pub(crate) fn tidied(mut self) -> Self {
        let mut known: Vec<f64> = Vec::new();
        for stiffness in self.cables.iter_mut().filter_map(|cable| cable.rope.axial_stiffness.as_mut()) {
            match known.iter().find(|first| (**first - *stiffness).abs() <= MAX_ROUNDING * first.abs()) {
                Some(first) => *stiffness = *first,
                None => known.push(*stiffness),
            }
        }

        let platform = &mut self.platform;
        let is_centered = platform.center_of_mass_p.unwrap_or_default() == Vec3::zeros();
        let is_point = is_centered && self.cables.iter().all(|cable| cable.attachment_p == Vec3::zeros());
        if platform.motion == DraftMotion::Rigid && is_point {
            platform.motion = DraftMotion::PointMass;
            if let DraftState::Pose(pose) = &mut self.state {
                pose.rot_wp = Rotation::identity();
            }
            self.notes.push("All cables end at the centre of mass: the platform is a point mass".to_owned());
        }
        self
    }

    /// Adds the values of the options. An option overrides the source.
    ///
    /// # Errors
    ///
    /// One message with every option that is required and missing.
    pub(crate) fn complete(&mut self, ropes: &ImportRopes, platform: &ImportPlatform) -> Result<()> {
        ropes.check()?;
        platform.check()?;
        self.refuse_useless(ropes, platform)?;
        self.name_cables();
        self.merge_point_mass();
        self.set_state(platform)?;
        let mut missing = self.complete_platform(platform);
        missing.extend(self.complete_ropes(ropes));
        if !missing.is_empty() {
            bail!("the source lacks values that a robot file needs: {}", missing.join("; "));
        }
        self.leave_out_limits();
        Ok(())
    }

    /// Refuses options that would have no effect.
    fn refuse_useless(&self, ropes: &ImportRopes, platform: &ImportPlatform) -> Result<()> {
        if self.platform.motion == DraftMotion::PointMass {
            let given = [
                ("⟪inertia_kg_m2⟫", platform.inertia_kg_m2.is_some()),
                ("⟪center_of_mass_m⟫", platform.center_of_mass_m.is_some()),
            ];
            if let Some((option, _)) = given.iter().find(|(_, given)| *given) {
                bail!(
                    "the platform is a point mass, which has neither inertia tensor nor centre of mass: leave \
                     out {option}"
                );
            }
        }
        let has_stiffness = self.cables.iter().any(|cable| cable.rope.axial_stiffness.is_some());
        if ropes.diameter_m.is_some() && ropes.youngs_modulus_pa.is_none() && has_stiffness {
            bail!(
                "the source gives EA of the ropes, which ⟪diameter_m⟫ does not change: leave it out, or add \
                 ⟪youngs_modulus_pa⟫"
            );
        }
        Ok(())
    }

    /// Removes tension limits that a robot file cannot hold or that have another meaning there.
    fn leave_out_limits(&mut self) {
        let limits: Vec<_> = self.cables.iter_mut().map(|cable| std::mem::take(&mut cable.limits)).collect();

        let mut text = String::new();
        self.tables(&mut text);
        // An invalid robot is refused later, with the reason.
        let robot = Robot::from_toml(&text).ok();

        let mut removed: [(&str, Vec<String>); 4] = [
            ("maximum, which is not positive", Vec::new()),
            ("maximum, which is above the breaking load", Vec::new()),
            ("minimum, which is not below the maximum", Vec::new()),
            (
                "minimum, which is below the default minimum of analyses: in the source it only keeps straight cables \
                 from being slack",
                Vec::new(),
            ),
        ];
        for (i, (cable, [mut minimum, mut maximum])) in self.cables.iter_mut().zip(limits).enumerate() {
            let chord = match &self.state {
                DraftState::Pose(pose) => cable.anchor_w - pose.point_w(&cable.attachment_p),
                DraftState::Lengths | DraftState::Unknown => Vec3::zeros(),
            };
            let default_minimum = robot.as_ref().map_or(0.0, |robot| TensionRange::of(robot, i, &chord).minimum);
            let breaks = cable.rope.breaking_load.unwrap_or(f64::INFINITY);
            let gone = [
                maximum.take_if(|limit| *limit <= 0.0),
                maximum.take_if(|limit| *limit > breaks),
                minimum.take_if(|limit| *limit >= maximum.unwrap_or(breaks)),
                minimum.take_if(|limit| *limit < default_minimum),
            ];
            for ((_, names), _) in removed.iter_mut().zip(gone).filter(|(_, gone)| gone.is_some()) {
                names.push(cable.name.clone());
            }
            cable.limits = [minimum, maximum];
        }

        for (what, names) in removed.into_iter().filter(|(_, names)| !names.is_empty()) {
            self.lost.push(format!("a tension limit of the cables {}: the {what}", listed(&names)));
        }
    }

    /// Gives every cable a unique name, because results are listed by name.
    fn name_cables(&mut self) {
        let given: BTreeSet<String> = self.cables.iter().map(|cable| cable.name.clone()).collect();
        let mut taken = BTreeSet::new();
        for (i, cable) in self.cables.iter_mut().enumerate() {
            let base = if cable.name.is_empty() { (i + 1).to_string() } else { cable.name.clone() };
            let mut name = base.clone();
            let mut count = 1;
            while taken.contains(&name) || (name != cable.name && given.contains(&name)) {
                count += 1;
                name = format!("{base} ({count})");
            }
            if name != cable.name {
                let what =
                    if cable.name.is_empty() { "has no name".to_owned() } else { format!("is a second \"{base}\"") };
                self.assumed.push(format!("cable number {} {what} in the source; it is called \"{name}\"", i + 1));
            }
            taken.insert(name.clone());
            cable.name = name;
        }
    }

    /// Moves all cables of a point mass to one point. A platform that cannot rotate feels only forces, so shifting an
    /// attachment to the origin and its anchor by the same vector changes nothing.
    fn merge_point_mass(&mut self) {
        if self.platform.motion != DraftMotion::PointMass {
            return;
        }
        if self.cables.iter().any(|cable| cable.attachment_p != Vec3::zeros()) {
            self.notes.push(
                "The platform translates only. Its cables end in one point here: each anchor is the source's anchor \
                 minus the source's attachment; lengths, forces and motion do not change"
                    .to_owned(),
            );
            for cable in &mut self.cables {
                cable.anchor_w -= cable.attachment_p;
                cable.attachment_p = Vec3::zeros();
            }
        }
        self.platform.inertia_p = None;
        self.platform.center_of_mass_p = Some(Vec3::zeros());
    }

    fn set_state(&mut self, options: &ImportPlatform) -> Result<()> {
        let Some(pose) = options.pose.map(request::Pose::to_robot).transpose()? else { return Ok(()) };
        at_rest::refuse_orientation(self.platform.motion == DraftMotion::PointMass, &pose)
            .map_err(|error| anyhow!("⟪pose⟫: {error}"))?;
        match self.state {
            DraftState::Lengths => {
                self.lost.push("the unstrained lengths of the source: ⟪pose⟫ replaces them".to_owned());
                self.cables.iter_mut().for_each(|cable| cable.unstrained_length = None);
            }
            DraftState::Pose(_) => self.lost.push("the pose of the source: ⟪pose⟫ replaces it".to_owned()),
            DraftState::Unknown => {}
        }
        self.notes.push("The pose is that of ⟪pose⟫".to_owned());
        self.state = DraftState::Pose(pose);
        Ok(())
    }

    /// Adds the options of the platform and lists the values that are still missing.
    fn complete_platform(&mut self, options: &ImportPlatform) -> Vec<String> {
        let mut missing = Vec::new();
        let platform = &mut self.platform;
        if let Some(mass) = options.mass_kg {
            self.notes.push(match platform.mass {
                Some(of_source) => format!("The platform's mass is that of ⟪mass_kg⟫; the source has {of_source} kg"),
                None => "The platform's mass is that of ⟪mass_kg⟫".to_owned(),
            });
            platform.mass = Some(mass);
        }
        if platform.mass.is_none() {
            missing.push(format!("{}: the platform has no mass, give ⟪mass_kg⟫ KG", platform.place));
        }
        if platform.motion == DraftMotion::PointMass {
            return missing;
        }

        if let Some(inertia) = options.inertia_kg_m2 {
            self.notes.push("The platform's inertia tensor is that of ⟪inertia_kg_m2⟫".to_owned());
            let [xx, yy, zz, xy, xz, yz] = inertia;
            platform.inertia_p = Some(Mat3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz));
        }
        if let Some(center) = options.center_of_mass_m {
            self.notes.push("The platform's centre of mass is that of ⟪center_of_mass_m⟫".to_owned());
            platform.center_of_mass_p = Some(center.into());
        }

        // A planar platform rotates about the normal of its plane only, so this moment of inertia has to be positive.
        let normal = platform.motion.normal_axis();
        let turns = |inertia: &Mat3| normal.is_none_or(|normal| inertia[(normal, normal)] > 0.0);
        if !platform.inertia_p.as_ref().is_some_and(turns) {
            missing.push(format!(
                "{}: the platform has no physically possible inertia tensor, give ⟪inertia_kg_m2⟫ XX,YY,ZZ{}",
                platform.place,
                if normal.is_some() { ", of which only the moment about the normal of its plane counts" } else { "" }
            ));
        }
        if platform.center_of_mass_p.is_none() {
            missing
                .push(format!("{}: the platform has no centre of mass, give ⟪center_of_mass_m⟫ X,Y,Z", platform.place));
        }
        missing
    }

    /// Adds the options of the ropes and lists the values that are still missing.
    fn complete_ropes(&mut self, options: &ImportRopes) -> Vec<String> {
        let mut given = Vec::new();
        if let Some(mass) = options.mass_kg_per_m {
            given.push("⟪mass_kg_per_m⟫");
            self.cables.iter_mut().for_each(|cable| cable.rope.mass_per_length = Some(mass));
        }
        if let Some(stiffness) = options.axial_stiffness_n {
            given.push("⟪axial_stiffness_n⟫");
            for rope in self.cables.iter_mut().map(|cable| &mut cable.rope) {
                rope.axial_stiffness = Some(stiffness);
                (rope.youngs_modulus, rope.diameter) = (None, None);
            }
        }
        if let Some(modulus) = options.youngs_modulus_pa {
            given.push("⟪youngs_modulus_pa⟫");
            for rope in self.cables.iter_mut().map(|cable| &mut cable.rope) {
                rope.youngs_modulus = Some(modulus);
                rope.axial_stiffness = None;
            }
        }
        if let Some(diameter) = options.diameter_m {
            given.push("⟪diameter_m⟫");
            self.cables.iter_mut().for_each(|cable| cable.rope.diameter = Some(diameter));
        }
        if !given.is_empty() {
            let apply = if given.len() == 1 { "applies" } else { "apply" };
            self.notes.push(format!("Ropes: {} {apply} to all ropes", given.join(" and ")));
        }

        let lack = |is: fn(&DraftRope) -> bool| self.cables.iter().any(|cable| is(&cable.rope));
        let mut missing = Vec::new();
        if lack(|rope| rope.mass_per_length.is_none()) {
            missing.push("the mass of the ropes, give ⟪mass_kg_per_m⟫".to_owned());
        }
        if lack(|rope| rope.axial_stiffness.is_none() && rope.youngs_modulus.is_none()) {
            missing.push(
                "the stiffness of the ropes, give ⟪axial_stiffness_n⟫, or ⟪youngs_modulus_pa⟫ with ⟪diameter_m⟫"
                    .to_owned(),
            );
        } else if lack(|rope| rope.axial_stiffness.is_none() && rope.diameter.is_none()) {
            missing.push("the diameter of the ropes, give ⟪diameter_m⟫, or ⟪axial_stiffness_n⟫".to_owned());
        }
        missing
    }
}

/// Rotation `R = Rx(a) Ry(b) Rz(c)` [rad], the convention of CASPR and MoorDyn. A robot file uses `Rz Ry Rx`.
pub(crate) fn rotation_xyz(a: f64, b: f64, c: f64) -> Rotation {
    Rotation::from_euler_angles(a, 0.0, 0.0)
        * Rotation::from_euler_angles(0.0, b, 0.0)
        * Rotation::from_euler_angles(0.0, 0.0, c)
}

/// List of names such as `"1", "2" and "3"`; a long list is cut off.
pub(crate) fn listed(names: &[String]) -> String {
    const MAX_LISTED: usize = 12;
    let quoted: Vec<String> = names.iter().take(MAX_LISTED).map(|name| format!("\"{name}\"")).collect();
    match (&quoted[..], names.len() > MAX_LISTED) {
        ([all @ .., last], false) if !all.is_empty() => format!("{} and {last}", all.join(", ")),
        (all, false) => all.concat(),
        (all, true) => format!("{} and {} more", all.join(", "), names.len() - MAX_LISTED),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_about_moving_axes_turn_about_x_last_in_the_world() {
        let (s, c) = (0.5_f64.sin(), 0.5_f64.cos());
        // Rx(90°) Rz(0.5) takes x to (cos, 0, sin): the rotation about z acts first, then the rotation about x.
        let turned = rotation_xyz(std::f64::consts::FRAC_PI_2, 0.0, 0.5) * Vec3::x();
        assert!((turned - Vec3::new(c, 0.0, s)).norm() < 1e-15, "{turned}");
    }

    #[test]
    fn lists_of_names_are_short() {
        let names = |n: usize| (1..=n).map(|i| i.to_string()).collect::<Vec<_>>();
        assert_eq!(listed(&names(1)), "\"1\"");
        assert_eq!(listed(&names(3)), "\"1\", \"2\" and \"3\"");
        assert!(listed(&names(40)).ends_with("\"12\" and 28 more"));
    }
}

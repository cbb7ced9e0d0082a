//! `check`: description of the robot in the robot file.

mod bodies;
mod required;

use super::fields::AXES;
use super::found;
use super::shared::{LoadRow, WindRow};
use crate::columns::{ResultTable, Tabled, only_read, parts};
use crate::rows::rows;
use crate::table::Column;
use crate::text::NONE;
use crate::text::short;
pub use bodies::{CheckedBody, CheckedClearance};
use funicular::math::rotation;
use funicular::robot::{
    Cable, Control, Damping, GuideWheel, PlatformMotion, Pulley, PulleyFriction, Robot, State, Support, TensionLimits,
    Winch, WinchLimits,
};
use funicular::statics::{self, CableState, StaticModel};
use funicular::warnings::{self, Warning, plausibility};
pub use required::CheckedRequired;
use std::f64::consts::TAU;

rows! {
    /// Results of `check`: the robot as it was read.
    pub struct Checked {
        pub robot: String = hidden;
        pub source: String;
        pub gravity_m_s2: [f64; 3];
        pub degrees_of_freedom: usize;
        pub platform: CheckedPlatform;
        /// Load on the platform; absent if there is none.
        pub load: Option<LoadRow>;
        pub wind: Option<WindRow>;
        pub materials: Vec<CheckedRope>;
        pub cables: Vec<CheckedCable>;
        /// Flexible supports; absent on a rigid frame.
        pub supports: Vec<CheckedSupport> = sparse;
        /// Bodies that stand in the world; absent if there are none.
        pub obstacles: Vec<CheckedBody> = sparse;
        /// Bodies that move with the platform, in its frame; absent if there are none.
        pub platform_bodies: Vec<CheckedBody> = sparse;
        /// Required distances; absent if the file gives none.
        pub clearance: Option<CheckedClearance>;
        /// Required loads and velocities; absent if the file gives none.
        pub required: Option<CheckedRequired>;
        /// Further required loads, of which any one may act; absent if there are none.
        pub required_loads: Vec<LoadRow> = sparse;
        /// `lengths`, `pose` or `none`.
        pub state: &'static str;
        pub pose: Option<CheckedPose>;
        /// Remarks on unusual values, which may be intended or a slip; absent if there are none.
        pub notes: Vec<String> = sparse;
        pub warnings: Vec<String> = hidden;
    }
}

rows! {
    /// Platform of a robot file.
    pub struct CheckedPlatform {
        pub motion: &'static str;
        /// Plane of a planar platform; absent for other platforms.
        pub plane_normal: Option<[f64; 3]>;
        pub plane_offset_m: Option<f64>;
        pub mass_kg: f64;
        pub inertia_kg_m2: [[f64; 3]; 3];
        pub center_of_mass_m: [f64; 3];
        pub drag_area_m2: Option<f64>;
    }
}

rows! {
    /// Rope of a robot file.
    #[derive(PartialEq)]
    pub struct CheckedRope in tables(ropes: &[Self]) with {
        let limited = ropes.iter().any(|rope| rope.limits.are_given() || rope.breaking_load_n.is_some());
        let dragged = ropes.iter().any(|rope| rope.drag_width_m.is_some());
        let stiffer = ropes.iter().any(|rope| rope.dynamic_axial_stiffness_n.is_some());
        let lossy = ropes.iter().any(|rope| rope.axial_loss_factor.is_some() || rope.axial_damping_time_s.is_some());
    } rows {
        /// Name of the rope.
        pub name: String => one.plain("rope");
        /// Axial stiffness EA.
        pub axial_stiffness_n: f64 => one.short("EA", 6);
        /// Axial stiffness in vibration.
        pub dynamic_axial_stiffness_n: Option<f64> => one.short("EA in vibration", 6).read_if(stiffer);
        /// Mass per length.
        pub mass_kg_per_m: f64 => one.short("mass", 5);
        /// Damping ratio.
        pub damping_ratio: Option<f64> => one.short("damping ratio", 4);
        /// Viscous damping per length.
        pub viscous_damping_n_s_m2: Option<f64> => one.short("viscous damping", 4);
        /// Loss factor of the stretch.
        ///
        /// Absent if zero.
        pub axial_loss_factor: Option<f64> => one.short("loss factor", 4).read_if(lossy);
        /// Damping time of the stretch.
        ///
        /// Absent if zero.
        pub axial_damping_time_s: Option<f64> => one.short("damping time", 4).read_if(lossy);
        /// Tension limits of the rope.
        pub limits: CheckedLimits = spread => columns(limited);
        /// Breaking load.
        pub breaking_load_n: Option<f64> => one.short("breaks at", 4).read_if(limited);
        /// Drag coefficient times diameter.
        pub drag_width_m: Option<f64> => one.short("drag width", 4).read_if(dragged);
    }
}

rows! {
    /// Tension limits; a limit that is not given is absent.
    #[derive(PartialEq)]
    pub struct CheckedLimits in tables(are_read: bool) {
        /// Minimum tension that is allowed.
        pub minimum_tension_n: Option<f64> => one.short("min T", 4).read_if(are_read);
        /// Maximum tension that is allowed.
        pub maximum_tension_n: Option<f64> => one.short("max T", 4).read_if(are_read);
    }
}

impl CheckedLimits {
    fn of(limits: TensionLimits) -> Self {
        Self { minimum_tension_n: limits.minimum, maximum_tension_n: limits.maximum }
    }
}

rows! {
    /// Cable of a robot file.
    pub struct CheckedCable in tables(cables: &[Self]) with {
        let limited = cables.iter().any(|cable| cable.limits.are_given());
        let loaded = cables.iter().any(|cable| cable.load_n_per_m.is_some());
    } rows {
        /// Name of the cable.
        pub name: String => one.plain("cable");
        /// Name of its rope.
        pub material: String => one.plain("rope");
        /// Anchor, world axes, {}.
        pub anchor_m: [f64; 3] => each(AXES).components("anchor", 4);
        /// Attachment, platform axes, {}.
        pub attachment_m: [f64; 3] => each(AXES).components("attachment", 4);
        /// Pulley at the anchor; absent if there is none.
        pub pulley: Option<CheckedPulley>;
        /// Winch behind the anchor; absent if there is none.
        pub winch: Option<CheckedWinch>;
        /// Name of the flexible support of its anchor; absent for a rigid anchor.
        pub support: Option<String>;
        /// Cable whose rope continues in this one over a sheave; absent for a cable of its own.
        pub shares_rope_with: Option<String>;
        /// Efficiency of that sheave; absent without one.
        pub sheave_efficiency: Option<f64>;
        /// Unstrained length of the file.
        pub unstrained_length_m: Option<f64> => one.decimals("unstrained", 4);
        /// Parts of the unstrained length of a cable over a pulley or to a winch; absent for other cables, and if the
        /// lengths are unknown or have no equilibrium.
        pub length_parts: Option<LengthParts>;
        /// Tension limits of the cable, or else of its rope.
        pub limits: CheckedLimits = spread => columns(limited);
        /// Load per length besides weight and wind; absent if there is none.
        pub load_n_per_m: Option<[f64; 3]>
            => parts("load_{}_n_per_m", AXES, "N/m", "load per length besides weight and wind, {}", |cable: &Self| {
                cable.load_n_per_m.unwrap_or_default()
            })
            => only_read()
                .shown("load", "N/m", |cable: &Self, style| {
                    cable.load_n_per_m.map_or_else(|| NONE.to_owned(), |load| style.components(&load, 4))
                })
                .aligned(false)
                .only_if(loaded);
    }
}

rows! {
    /// Unstrained length of a cable at rest, as it is counted with a pulley or a winch and without them.
    pub struct LengthParts {
        /// Unstrained length from the attachment to the anchor point, if the cable ended there with the same tension.
        pub to_anchor_m: f64;
        /// Length that pulley and drum side add: the unstrained length of the file less `to_anchor_m`.
        pub beyond_anchor_m: f64;
    }
}

impl LengthParts {
    fn of(cable: &Cable, state: &CableState) -> Option<Self> {
        state.drive.as_ref()?;
        let stretch = 1.0 + state.tension_anchor / cable.material.axial_stiffness;
        let to_anchor = (cable.anchor.reference_w() - state.attachment_w).norm();
        let to_anchor_m = state.free_length() + (to_anchor - state.chord()) / stretch;
        Some(Self { to_anchor_m, beyond_anchor_m: state.unstrained_length - to_anchor_m })
    }
}

rows! {
    /// Pulley of a cable.
    pub struct CheckedPulley {
        pub name: String;
        pub radius_m: f64;
        /// Direction of travel at the anchor towards the platform, unit vector.
        pub entry_direction: [f64; 3];
        /// Friction; empty without friction.
        pub friction: CheckedFriction = spread;
    }
}

rows! {
    /// Friction of a pulley, of one kind at most.
    #[derive(Default)]
    pub struct CheckedFriction {
        pub friction_coefficient: Option<f64>;
        pub efficiency: Option<f64>;
        pub bearing_friction_coefficient: Option<f64>;
        pub bearing_radius_m: Option<f64>;
    }
}

impl CheckedFriction {
    fn of(friction: Option<PulleyFriction>) -> Self {
        let none = Self::default();
        match friction {
            None => none,
            Some(PulleyFriction::Sliding { coefficient }) => Self { friction_coefficient: Some(coefficient), ..none },
            Some(PulleyFriction::Efficiency(efficiency)) => Self { efficiency: Some(efficiency), ..none },
            Some(PulleyFriction::Bearing { coefficient, radius }) => {
                Self { bearing_friction_coefficient: Some(coefficient), bearing_radius_m: Some(radius), ..none }
            }
        }
    }

    /// Description in one phrase; `None` without friction.
    pub fn text(&self) -> Option<String> {
        if let Some(coefficient) = self.friction_coefficient {
            return Some(format!("μ = {}", short(coefficient, 4)));
        }
        if let Some(efficiency) = self.efficiency {
            return Some(format!("η = {}", short(efficiency, 4)));
        }
        let (coefficient, radius) = (self.bearing_friction_coefficient?, self.bearing_radius_m?);
        Some(format!("bearing {} at {} m", short(coefficient, 4), short(radius, 4)))
    }
}

rows! {
    /// Winch of a cable.
    pub struct CheckedWinch {
        pub name: String;
        pub drum_side_length_m: f64;
        /// Stiffness at the cable; absent for a rigid winch.
        pub stiffness_n_per_m: Option<f64>;
        /// Masses that drum and motor add at the cable; absent without inertia.
        pub drum_mass_kg: Option<f64>;
        pub motor_mass_kg: Option<f64>;
        /// Guide wheels, the nearest to the anchor first; absent without any.
        pub guide_wheels: Vec<CheckedGuideWheel> = sparse;
        /// Control of the motor; absent if it holds its angle.
        pub control: Option<&'static str>;
        /// Gains of a position control at the cable.
        pub position_gain_n_per_m: Option<f64>;
        pub speed_gain_n_s_per_m: Option<f64>;
        /// Efficiency of the gear; absent if it is 1.
        pub gear_efficiency: Option<f64>;
        pub limits: CheckedWinchLimits = spread;
    }
}

rows! {
    /// Limits of a winch and its motor; a limit that is not given is absent.
    pub struct CheckedWinchLimits {
        pub max_speed_m_s: Option<f64>;
        pub max_acceleration_m_s2: Option<f64>;
        /// Torque of the motor at its own shaft.
        pub max_torque_n_m: Option<f64>;
        pub max_power_w: Option<f64>;
        pub max_brake_power_w: Option<f64>;
        /// Corners of the torque–speed curve: speeds and torques.
        pub torque_speed_rad_s: Vec<f64> = sparse;
        pub torque_speed_n_m: Vec<f64> = sparse;
    }
}

impl CheckedWinchLimits {
    fn of(limits: &WinchLimits) -> Self {
        let WinchLimits { speed, acceleration, torque, power, brake_power, torque_speed } = limits;
        let given = |limit: &f64| limit.is_finite().then_some(*limit);
        Self {
            max_speed_m_s: given(speed),
            max_acceleration_m_s2: given(acceleration),
            max_torque_n_m: given(torque),
            max_power_w: given(power),
            max_brake_power_w: given(brake_power),
            torque_speed_rad_s: torque_speed.iter().map(|[speed, _]| *speed).collect(),
            torque_speed_n_m: torque_speed.iter().map(|[_, torque]| *torque).collect(),
        }
    }

    /// Limits in one phrase; `None` without any.
    pub fn text(&self) -> Option<String> {
        let braking = self.max_brake_power_w.filter(|brake| Some(*brake) != self.max_power_w);
        let numbers = [
            ("", self.max_speed_m_s, "m/s"),
            ("", self.max_acceleration_m_s2, "m/s²"),
            ("", self.max_torque_n_m, "N m"),
            ("", self.max_power_w, "W"),
            ("braking ", braking, "W"),
        ];
        let numbers =
            numbers.iter().filter_map(|(of, limit, unit)| Some(format!("{of}{} {unit}", short((*limit)?, 4))));
        let curve = self.torque_speed_rad_s.last().map(|last| format!("torque curve to {} rad/s", short(*last, 4)));
        let parts: Vec<String> = numbers.chain(curve).collect();
        (!parts.is_empty()).then(|| parts.join(", "))
    }
}

rows! {
    /// Flexible support of anchors.
    pub struct CheckedSupport {
        pub name: String;
        pub stiffness_n_per_m: [[f64; 3]; 3];
        pub mass_kg: f64;
        pub damping_ratio: f64;
        /// `on-support` or `on-ground`.
        pub drums: &'static str;
        /// Lowest frequency of the support alone; absent without mass.
        pub first_frequency_hz: Option<f64>;
    }
}

impl CheckedSupport {
    fn of(support: &Support) -> Self {
        let Support { name, stiffness_w, mass, damping_ratio, drum } = support;
        let softest = stiffness_w.symmetric_eigenvalues().min();
        Self {
            name: name.clone(),
            stiffness_n_per_m: std::array::from_fn(|i| std::array::from_fn(|j| stiffness_w[(i, j)])),
            mass_kg: *mass,
            damping_ratio: *damping_ratio,
            drums: drum.name(),
            first_frequency_hz: (*mass > 0.0).then(|| (softest / mass).sqrt() / TAU),
        }
    }
}

rows! {
    /// Guide wheel of a winch.
    pub struct CheckedGuideWheel {
        pub name: String;
        /// Length of the cable from its anchor to the wheel.
        pub distance_m: f64;
        /// Mass that the wheel adds at the cable.
        pub mass_kg: f64;
    }
}

impl CheckedPulley {
    fn of(pulley: &Pulley) -> Self {
        let Pulley { name, radius, entry_direction_w, friction, .. } = pulley;
        Self {
            name: name.clone(),
            radius_m: *radius,
            entry_direction: (*entry_direction_w).into(),
            friction: CheckedFriction::of(*friction),
        }
    }
}

impl CheckedWinch {
    fn of(winch: &Winch) -> Self {
        let Winch { name, drum_side_length, stiffness, drum_mass, motor_mass, guide_wheels, .. } = winch;
        let guide_wheel = |wheel: &GuideWheel| {
            let GuideWheel { name, distance, mass } = wheel;
            CheckedGuideWheel { name: name.clone(), distance_m: *distance, mass_kg: *mass }
        };
        let servo = if let Control::Position(servo) = winch.control { Some(servo) } else { None };
        let control = match winch.control {
            Control::Ideal => None,
            Control::Position(_) => Some("position"),
            Control::Torque => Some("torque"),
        };
        Self {
            name: name.clone(),
            drum_side_length_m: *drum_side_length,
            stiffness_n_per_m: stiffness.is_finite().then_some(*stiffness),
            drum_mass_kg: Some(*drum_mass).filter(|mass| *mass > 0.0),
            motor_mass_kg: Some(*motor_mass).filter(|mass| *mass > 0.0),
            guide_wheels: guide_wheels.iter().map(guide_wheel).collect(),
            control,
            position_gain_n_per_m: servo.map(|servo| servo.position_gain),
            speed_gain_n_s_per_m: servo.map(|servo| servo.speed_gain),
            gear_efficiency: Some(winch.gear_efficiency).filter(|efficiency| *efficiency < 1.0),
            limits: CheckedWinchLimits::of(&winch.limits),
        }
    }

    /// Motion of its drum and guide wheels in one phrase; `None` for a motor that holds its angle where nothing has
    /// inertia.
    pub fn drive_text(&self) -> Option<String> {
        let mass = self.drum_mass_kg.unwrap_or(0.0) + self.motor_mass_kg.unwrap_or(0.0);
        let inertia = (mass > 0.0).then(|| format!("{} kg", short(mass, 4)));
        let control = match (self.control, self.position_gain_n_per_m) {
            (Some(control), Some(gain)) => Some(format!("{control} control, {} N/m", short(gain, 4))),
            (Some(control), None) => Some(format!("constant {control}")),
            (None, _) => inertia.is_some().then(|| "motor held".to_owned()),
        };
        let guides: f64 = self.guide_wheels.iter().map(|wheel| wheel.mass_kg).sum();
        let guides = (guides > 0.0).then(|| format!("guide wheels {} kg", short(guides, 4)));
        let gear = self.gear_efficiency.map(|efficiency| format!("gear η = {}", short(efficiency, 4)));
        let parts: Vec<String> = inertia.into_iter().chain(control).chain(guides).chain(gear).collect();
        (!parts.is_empty()).then(|| parts.join(", "))
    }
}

rows! {
    /// Pose of a robot file.
    pub struct CheckedPose {
        pub position_m: [f64; 3];
        pub roll_pitch_yaw_deg: [f64; 3];
    }
}

/// Describes the robot as it was read, with warnings about unusual values.
pub fn run(robot: Robot) -> Checked {
    let (materials, cables) = (ropes(&robot), cables(&robot));
    let (state, pose) = state(&robot);
    let inertia = robot.platform.inertia_p;
    let dof = robot.platform.motion.count();

    let plane = match robot.platform.motion {
        PlatformMotion::Planar(plane) => Some(plane),
        PlatformMotion::Rigid | PlatformMotion::PointMass => None,
    };

    Checked {
        warnings: caveats(&robot),
        notes: plausibility::notes(&robot),
        robot: robot.name,
        source: robot.source,
        gravity_m_s2: robot.gravity_w.into(),
        degrees_of_freedom: dof,
        platform: CheckedPlatform {
            motion: robot.platform.motion.name(),
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
        supports: robot.supports.iter().map(CheckedSupport::of).collect(),
        obstacles: robot.obstacles.iter().map(CheckedBody::of).collect(),
        platform_bodies: robot.platform.bodies.iter().map(CheckedBody::of).collect(),
        clearance: robot.clearance.as_ref().map(CheckedClearance::of),
        required: CheckedRequired::of(&robot.required),
        required_loads: robot.required.listed.iter().map(LoadRow::of_any).collect(),
        cables,
        state,
        pose,
    }
}

/// Ropes of the cables, each once.
fn ropes(robot: &Robot) -> Vec<CheckedRope> {
    let mut ropes: Vec<CheckedRope> = Vec::new();
    for cable in &robot.cables {
        let rope = &cable.material;
        let (damping_ratio, viscous_damping_n_s_m2) = match rope.damping {
            Damping::Ratio(ratio) => (Some(ratio), None),
            Damping::Viscous(coefficient) => (None, Some(coefficient)),
        };

        let row = CheckedRope {
            name: rope.name.clone(),
            axial_stiffness_n: rope.axial_stiffness,
            dynamic_axial_stiffness_n: rope.dynamic_axial_stiffness,
            mass_kg_per_m: rope.mass_per_length,
            damping_ratio,
            viscous_damping_n_s_m2,
            axial_loss_factor: not_zero(rope.stretch_loss.factor),
            axial_damping_time_s: not_zero(rope.stretch_loss.time),
            limits: CheckedLimits::of(rope.tension_limits),
            breaking_load_n: rope.breaking_load,
            drag_width_m: rope.drag_width,
        };

        if !ropes.contains(&row) {
            ropes.push(row);
        }
    }
    ropes
}

fn not_zero(value: f64) -> Option<f64> {
    (value != 0.0).then_some(value)
}

/// Cables in the order of the file.
fn cables(robot: &Robot) -> Vec<CheckedCable> {
    let lengths = match &robot.state {
        State::Lengths(lengths) => Some(lengths),
        State::Pose(_) | State::Unknown => None,
    };

    // Lengths can only be divided where the platform rests.
    let driven = robot.cables.iter().any(|cable| !cable.anchor.is_fixed());
    let rest = lengths.filter(|_| driven);
    let rest = rest.and_then(|lengths| statics::forward(robot, lengths, StaticModel::Catenary, None).ok());

    let row = |(i, cable): (usize, &Cable)| CheckedCable {
        name: cable.name.clone(),
        material: cable.material.name.clone(),
        anchor_m: cable.anchor.reference_w().into(),
        attachment_m: cable.attachment_p.into(),
        pulley: cable.anchor.pulley.as_ref().map(CheckedPulley::of),
        winch: cable.anchor.winch.as_ref().map(CheckedWinch::of),
        support: cable.anchor.support.map(|support| robot.supports[support].name.clone()),
        shares_rope_with: continued(robot, i).map(|(before, _)| robot.cables[before].name.clone()),
        sheave_efficiency: continued(robot, i).map(|(_, efficiency)| efficiency),
        unstrained_length_m: lengths.map(|lengths| lengths[i]),
        length_parts: rest.as_ref().and_then(|rest| LengthParts::of(cable, &rest.cables[i])),
        limits: CheckedLimits::of(cable.limits()),
        load_n_per_m: (cable.load_per_length_w.norm() > 0.0).then(|| cable.load_per_length_w.into()),
    };

    robot.cables.iter().enumerate().map(row).collect()
}

/// Cable whose rope continues in cable `i`, and the efficiency of the sheave between them.
fn continued(robot: &Robot, i: usize) -> Option<(usize, f64)> {
    robot.ropes.iter().find_map(|rope| {
        let place = rope.cables.iter().position(|cable| *cable == i).filter(|place| *place > 0)?;
        Some((rope.cables[place - 1], rope.efficiencies[place - 1]))
    })
}

/// Kind of the state, and its pose if it has one.
fn state(robot: &Robot) -> (&'static str, Option<CheckedPose>) {
    match &robot.state {
        State::Lengths(_) => ("lengths", None),
        State::Pose(pose) => {
            let row = CheckedPose {
                position_m: pose.position_w.into(),
                roll_pitch_yaw_deg: rotation::to_roll_pitch_yaw_deg(&pose.rot_wp),
            };
            ("pose", Some(row))
        }
        State::Unknown => ("none", None),
    }
}

/// Warning about cables that cross in the state of the file: as they hang at rest, or straight where they do not rest.
fn crossing(robot: &Robot) -> Option<Warning> {
    let rest = || statics::solve(robot, StaticModel::Catenary, None).map(|found| found.equilibrium);
    match &robot.state {
        State::Unknown => None,
        State::Pose(pose) => match rest() {
            Ok(rest) => warnings::of_crossings(robot, &rest),
            Err(_) => warnings::of_crossing_chords(robot, pose),
        },
        State::Lengths(_) => warnings::of_crossings(robot, &rest().ok()?),
    }
}

fn caveats(robot: &Robot) -> Vec<String> {
    let mut warnings: Vec<String> = plausibility::of_robot(robot).iter().map(ToString::to_string).collect();
    warnings.extend(crossing(robot).map(|warning| warning.to_string()));

    if robot.constraint().is_under() {
        let (cables, dof) = (robot.rope_count(), robot.platform.motion.count());
        let cables =
            if robot.has_ropes_over_sheaves() { format!("{cables} ropes") } else { format!("{cables} cables") };
        warnings.push(format!(
            "{cables} for {dof} degrees of freedom: for given lengths the platform hangs at a minimum of its \
             energy; if the cables cannot hold a given pose, statics finds the nearest pose that they can hold"
        ));
    }

    if let PlatformMotion::Planar(plane) = robot.platform.motion {
        let across =
            |cable: &Cable| plane.distance(&cable.anchor.reference_w()) - plane.normal_w().dot(&cable.attachment_p);
        let beside: Vec<String> = robot
            .cables
            .iter()
            .filter(|cable| across(cable).abs() > 1e-9 * (1.0 + cable.anchor.reference_w().norm()))
            .map(|cable| format!("\"{}\" by {} m", cable.name, short(across(cable), 4)))
            .collect();
        if !beside.is_empty() {
            warnings.push(format!(
                "cables leave the plane of the platform: {}; the guide carries their out-of-plane forces and is \
                 assumed to be rigid and without friction",
                beside.join(", ")
            ));
        }

        let across = plane.normal_w().dot(&robot.gravity_w);
        if across.abs() > 1e-9 * robot.gravity_w.norm() {
            warnings.push(format!(
                "gravity has {} m/s² out of the plane of the platform: the guide carries it, and cables sag out of the \
                 plane",
                short(across, 4)
            ));
        }
    }
    warnings
}

impl CheckedLimits {
    fn are_given(&self) -> bool {
        self.minimum_tension_n.is_some() || self.maximum_tension_n.is_some()
    }
}

impl Tabled for Checked {
    fn tables() -> Vec<(&'static str, Vec<Column>)> {
        vec![("", CheckedCable::columns(&[]).described())]
    }

    fn table(&self) -> ResultTable<'_> {
        ResultTable::new(CheckedCable::columns(&self.cables), &self.cables)
    }
}

found!(Checked, "check");

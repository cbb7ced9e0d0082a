//! Change of the robot per unit of each parameter, along which results are differentiated.

use super::{Parameter, Parameters, RobotPart};
use crate::math::{Mat3, Vec3, Vec6, rotation};
use crate::robot::spec::key::{Component, Shape};
use crate::robot::{GuideWheelChange, PlatformMotion, Pulley, Robot, RobotChange, RopeSection, SupportChange};
use std::f64::consts::TAU;

/// Keys of numbers without derivatives, with the table in which they stand. All other numbers have a direction.
const WITHOUT_DERIVATIVE: &[(&str, &[&str])] = &[
    // Another plane means other coordinates of the platform.
    ("platform", &["plane_normal", "plane_offset_m"]),
    // Limits judge tensions or stop a rule, which keeps them as they are: a limit that is reached stays reached.
    ("materials", &["minimum_tension_n", "maximum_tension_n", "breaking_load_n"]),
    ("cables", &["minimum_tension_n", "maximum_tension_n"]),
    // No equilibrium depends on it, and derivatives of vibration are refused beside it.
    ("materials", &["dynamic_axial_stiffness_n"]),
    // Results with derivatives are those of the mean wind.
    ("wind", &["intensity", "length_scale_m", "coherence_decay"]),
    // Results with derivatives are those of the dead load.
    (
        "required",
        &[
            "force_n",
            "moment_n_m",
            "payload_min_kg",
            "payload_max_kg",
            "payload_center_m",
            "payload_center_reach_m",
            "acceleration_m_s2",
            "angular_acceleration_rad_s2",
            "wind_speed_m_s",
            "velocity_m_s",
            "angular_velocity_rad_s",
        ],
    ),
    // Distances are results without derivatives.
    ("platform_bodies", BODY),
    ("obstacles", BODY),
    ("clearance", &["cables_m", "platform_m", "obstacles_m", "from_end_m"]),
    // Results with derivatives are those without a moving motor and without limits of it.
    (
        "winches",
        &[
            "gear_efficiency",
            "max_speed_m_s",
            "max_acceleration_m_s2",
            "max_torque_n_m",
            "max_power_w",
            "max_brake_power_w",
        ],
    ),
    // Results with derivatives are those of cables of their own.
    ("cables", &["sheave_efficiency"]),
    // Results with derivatives are those without friction.
    ("pulleys", &["friction_coefficient", "efficiency", "bearing_friction_coefficient", "bearing_radius_m"]),
];

/// Keys of numbers of a body.
const BODY: &[&str] =
    &["position_m", "roll_pitch_yaw_deg", "from_m", "to_m", "size_m", "width_m", "height_m", "diameter_m", "length_m"];

impl Parameters {
    /// Change of the robot per unit of a parameter, in the unit of the file: the direction for derivatives of results
    /// with respect to the parameter. A value of a rope changes all its cables, an angle of the pose turns the
    /// platform. `None` for numbers without derivatives: limits, the plane of a planar platform and angles that leave
    /// it, friction of pulleys, and efficiency and limits of motors.
    ///
    /// # Example
    /// ```
    /// use funicular::robot::parameters::Parameters;
    ///
    /// let parameters = Parameters::from_toml(funicular_robots::COGIRO)?;
    /// let height = parameters.find(&["cables", "1", "anchor_m", "z"]).unwrap();
    /// assert_eq!(parameters.change(height).unwrap().cables[0].anchor_w.z, 1.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn change(&self, index: usize) -> Option<RobotChange> {
        self.change_of(index, &self.robot)
    }

    /// Change per unit of a parameter as [`Self::change`], of a robot that has been changed since it was read, such as
    /// by another pose.
    pub fn change_of(&self, index: usize, robot: &Robot) -> Option<RobotChange> {
        let parameter = self.list.get(index)?;
        if is_without_derivative(parameter) {
            return None;
        }
        let mut change = RobotChange::none(robot.cables.len());

        let unit = || -> Option<Vec3> {
            let axis = ["x", "y", "z"].iter().position(|name| Some(*name) == parameter.component)?;
            let mut unit = Vec3::zeros();
            unit[axis] = 1.0;
            Some(unit)
        };

        match (parameter.part, parameter.key) {
            (RobotPart::Robot, "gravity_m_s2") => change.gravity_w = unit()?,
            (RobotPart::Platform, "mass_kg") => change.mass = 1.0,
            (RobotPart::Platform, "center_of_mass_m") => change.center_of_mass_p = unit()?,
            (RobotPart::Platform, "drag_area_m2") => change.drag_area = 1.0,
            (RobotPart::Platform, "inertia_kg_m2") => match (parameter.component, &robot.platform.motion) {
                // A single number is the moment about the normal.
                (None, PlatformMotion::Planar(plane)) => {
                    change.inertia_p = plane.normal_w() * plane.normal_w().transpose();
                }
                (component, _) => change.inertia_p = tensor_entry(component)?,
            },
            (RobotPart::Platform, "translational_damping_n_s_m") => change.translational_damping_p = unit()?,
            (RobotPart::Platform, "rotational_damping_n_m_s") => change.rotational_damping_p = unit()?,
            (RobotPart::Wind, "velocity_m_s") => change.wind_velocity_w = unit()?,
            (RobotPart::Wind, "air_density_kg_m3") => change.air_density = 1.0,
            (RobotPart::State, key) => pose_change(robot, parameter, key, unit(), &mut change)?,
            (RobotPart::Load, "force_n") => change.force_w = unit()?,
            (RobotPart::Load, "moment_n_m") => change.moment_w = unit()?,
            (RobotPart::Load, "point_m") => change.point_p = unit()?,
            (RobotPart::Cable(i), key) => {
                let cable = change.cables.get_mut(i)?;
                match key {
                    "anchor_m" => cable.anchor_w = unit()?,
                    "attachment_m" => cable.attachment_p = unit()?,
                    "load_n_per_m" => cable.load_per_length_w = unit()?,
                    "unstrained_length_m" => cable.unstrained_length = 1.0,
                    "entry_direction" => {
                        let pulley = robot.cables[i].anchor.pulley.as_ref()?;
                        cable.pulley.entry_direction_w = self.direction_change(parameter, pulley, &unit()?)?;
                    }
                    _ => return None,
                }
            }
            (RobotPart::Pulley, key) => self.pulley_change(robot, parameter, key, unit(), &mut change)?,
            (RobotPart::Winch, key) => self.winch_change(robot, parameter, key, &mut change)?,
            (RobotPart::GuideWheel, key) => self.guide_wheel_change(robot, parameter, key, &mut change)?,
            (RobotPart::Material, key) => self.material_change(parameter, key, unit(), &mut change)?,
            (RobotPart::Support, key) => support_change(robot, parameter, key, &mut change)?,
            _ => return None,
        }

        Some(change)
    }

    /// Change of the unit vector of a pulley with a component of a vector of any length.
    fn direction_change(&self, parameter: &Parameter, pulley: &Pulley, unit: &Vec3) -> Option<Vec3> {
        let (_, vector) = parameter.keys.split_last()?;
        let components = self.list.iter().filter(|other| other.keys.split_last().is_some_and(|(_, of)| of == vector));
        let length = components.map(|other| other.value * other.value).sum::<f64>().sqrt();
        let direction_w = &pulley.entry_direction_w;
        Some((unit - direction_w * direction_w.dot(unit)) / length)
    }

    /// Change of all cables over a pulley.
    fn pulley_change(
        &self,
        robot: &Robot,
        parameter: &Parameter,
        key: &str,
        unit: Option<Vec3>,
        change: &mut RobotChange,
    ) -> Option<()> {
        let name = parameter.keys.get(1)?;
        for (i, (cable, change)) in robot.cables.iter().zip(&mut change.cables).enumerate() {
            let Some(pulley) = cable.anchor.pulley.as_ref().filter(|pulley| pulley.name == *name) else { continue };
            let change = &mut change.pulley;
            match key {
                "radius_m" => change.radius = 1.0,
                "inertia_kg_m2" => change.inertia = 1.0,
                "swivel_inertia_kg_m2" => change.swivel_inertia = 1.0,
                "entry_direction" => {
                    let own = |other: &Parameter| other.part == RobotPart::Cable(i) && other.key == "entry_direction";
                    if !self.list.iter().any(own) {
                        change.entry_direction_w = self.direction_change(parameter, pulley, &unit?)?;
                    }
                }
                _ => return None,
            }
        }

        Some(())
    }

    /// Change of all cables to a winch. At the cable, numbers about the axis of the drum count by the square of its
    /// radius.
    fn winch_change(&self, robot: &Robot, parameter: &Parameter, key: &str, change: &mut RobotChange) -> Option<()> {
        let name = parameter.keys.get(1)?;
        let value_of = |key: &str| {
            let of_winch = |other: &&Parameter| other.part == RobotPart::Winch && other.keys.get(1) == Some(name);
            self.list.iter().filter(of_winch).find(|other| other.key == key).map(|other| other.value)
        };
        // Without a radius no other number of the winch is about the axis.
        let by_radius = value_of("drum_radius_m").map_or(0.0, |radius| radius.powi(-2));
        let bandwidth = value_of("bandwidth_hz");
        let ratio = value_of("gear_ratio").unwrap_or(1.0);

        for (cable, change) in robot.cables.iter().zip(&mut change.cables) {
            let Some(winch) = cable.anchor.winch.as_ref().filter(|winch| winch.name == *name) else { continue };
            let (mass, servo) = (winch.drum_mass + winch.motor_mass, winch.servo());
            let change = &mut change.winch;
            match key {
                "drum_side_length_m" => change.drum_side_length = 1.0,
                "stiffness_n_per_m" => change.stiffness = 1.0,
                "shaft_stiffness_n_m_per_rad" => change.stiffness = by_radius,
                "drum_inertia_kg_m2" => change.drum_mass = by_radius,
                "motor_inertia_kg_m2" => change.motor_mass = by_radius * ratio * ratio,
                "gear_ratio" => change.motor_mass = 2.0 * winch.motor_mass / ratio,
                "damping_n_m_s_per_rad" => change.damping = by_radius,
                "drum_radius_m" => {
                    let per_metre = -2.0 / parameter.value;
                    change.drum_mass = per_metre * winch.drum_mass;
                    change.motor_mass = per_metre * winch.motor_mass;
                    change.damping = per_metre * winch.damping;
                    if value_of("shaft_stiffness_n_m_per_rad").is_some() {
                        change.stiffness = per_metre * winch.stiffness;
                    }
                    if let (Some(servo), None) = (servo, bandwidth) {
                        change.position_gain = per_metre * servo.position_gain;
                        change.speed_gain = per_metre * servo.speed_gain;
                    }
                }
                "bandwidth_hz" => {
                    change.position_gain = 2.0 * servo?.position_gain / parameter.value;
                    change.speed_gain = servo?.speed_gain / parameter.value;
                }
                "control_damping_ratio" => change.speed_gain = 2.0 * mass * bandwidth? * TAU,
                "position_gain_n_m_per_rad" => change.position_gain = by_radius,
                "speed_gain_n_m_s_per_rad" => change.speed_gain = by_radius,
                "delay_s" => change.delay = 1.0,
                _ => return None,
            }

            // Gains by the bandwidth are proportional to the mass.
            if let (Some(servo), Some(_)) = (servo, bandwidth) {
                let relative = (change.drum_mass + change.motor_mass) / mass;
                change.position_gain += relative * servo.position_gain;
                change.speed_gain += relative * servo.speed_gain;
            }
        }
        Some(())
    }

    /// Change of a guide wheel of all cables to its winch.
    fn guide_wheel_change(
        &self,
        robot: &Robot,
        parameter: &Parameter,
        key: &str,
        change: &mut RobotChange,
    ) -> Option<()> {
        let name = parameter.keys.get(1)?;
        let radius = self.list.iter().find(|other| {
            other.part == RobotPart::GuideWheel && other.keys.get(1) == Some(name) && other.key == "radius_m"
        })?;
        let mut is_known = false;
        for (cable, change) in robot.cables.iter().zip(&mut change.cables) {
            let wheels = cable.anchor.winch.as_ref().map_or(&[][..], |winch| &winch.guide_wheels);
            let Some(index) = wheels.iter().position(|wheel| wheel.name == *name) else { continue };
            is_known = true;
            change.guide_wheels.resize(wheels.len(), GuideWheelChange::default());
            let (wheel, change) = (&wheels[index], &mut change.guide_wheels[index]);
            match key {
                "distance_m" => change.distance = 1.0,
                "radius_m" => change.mass = -2.0 * wheel.mass / radius.value,
                "inertia_kg_m2" => change.mass = radius.value.powi(-2),
                _ => return None,
            }
        }

        is_known.then_some(())
    }

    /// Change of all cables made of a rope.
    fn material_change(
        &self,
        parameter: &Parameter,
        key: &str,
        unit: Option<Vec3>,
        change: &mut RobotChange,
    ) -> Option<()> {
        let name = parameter.keys.get(1)?;
        let same_rope = |other: &Parameter| other.part == RobotPart::Material && other.keys.get(1) == Some(name);
        for (i, (cable, change)) in self.robot.cables.iter().zip(&mut change.cables).enumerate() {
            let material = &cable.material;
            if material.name != *name {
                continue;
            }
            let relative = material.axial_stiffness / parameter.value;
            match key {
                "axial_stiffness_n" => change.axial_stiffness = 1.0,
                "youngs_modulus_pa" | "area_m2" => change.axial_stiffness = relative,
                // The drag depends on the diameter, too, unless it has its own.
                "diameter_m" => {
                    let own_drag = self.list.iter().any(|other| other.key == "drag_diameter_m" && same_rope(other));
                    if !own_drag {
                        change.drag_width = material.drag_width.unwrap_or(0.0) / parameter.value;
                    }
                    if matches!(material.dimensions.section, Some(RopeSection::Diameter(_))) {
                        change.axial_stiffness = 2.0 * relative;
                    }
                }
                "drag_coefficient" => match material.dimensions.drag_diameter {
                    Some(diameter) => change.drag_width = diameter,
                    None => return None,
                },
                "drag_diameter_m" => change.drag_width = material.drag_width? / parameter.value,
                "damping_ratio" | "viscous_damping_n_s_m2" => change.damping = 1.0,
                "axial_loss_factor" => change.loss_factor = 1.0,
                "axial_damping_time_s" => change.damping_time = 1.0,
                "mass_kg_per_m" => change.mass_per_length = 1.0,
                "load_n_per_m" => {
                    let own = |other: &Parameter| other.part == RobotPart::Cable(i) && other.key == "load_n_per_m";
                    if !self.list.iter().any(own) {
                        change.load_per_length_w = unit?;
                    }
                }
                _ => return None,
            }
        }

        Some(())
    }
}

fn is_without_derivative(parameter: &Parameter) -> bool {
    let in_table = |table: &str| parameter.keys.first().is_some_and(|first| first == table);
    WITHOUT_DERIVATIVE.iter().any(|(table, keys)| in_table(table) && keys.contains(&parameter.key))
}

/// Symmetric tensor whose entry with this name is 1.
fn tensor_entry(component: Option<&str>) -> Option<Mat3> {
    let entry = Shape::Tensor.components().iter().find(|(name, _)| Some(*name) == component)?.1;
    let Component::Entry(i, j) = entry else { return None };
    let mut tensor = Mat3::zeros();
    (tensor[(i, j)], tensor[(j, i)]) = (1.0, 1.0);
    Some(tensor)
}

/// Change of a flexible support.
fn support_change(robot: &Robot, parameter: &Parameter, key: &str, change: &mut RobotChange) -> Option<()> {
    let name = parameter.keys.get(1)?;
    let index = robot.supports.iter().position(|support| support.name == *name)?;
    change.supports.resize(robot.supports.len(), SupportChange::default());
    let change = &mut change.supports[index];
    match (key, parameter.component) {
        // A single number is the stiffness in all directions.
        ("stiffness_n_per_m", None) => change.stiffness_w = Mat3::identity(),
        ("stiffness_n_per_m", component) => change.stiffness_w = tensor_entry(component)?,
        ("mass_kg", _) => change.mass = 1.0,
        ("damping_ratio", _) => change.damping_ratio = 1.0,
        _ => return None,
    }
    Some(())
}

/// Change of the pose that the state gives. Motions that the platform does not have are no changes.
fn pose_change(
    robot: &Robot,
    parameter: &Parameter,
    key: &str,
    unit: Option<Vec3>,
    change: &mut RobotChange,
) -> Option<()> {
    match key {
        "position_m" => change.position_w = unit?,
        // R = Rz(yaw) Ry(pitch) Rx(roll): each angle turns about the axis of its rotation, after those left of it.
        "roll_pitch_yaw_deg" => {
            let [_, pitch, yaw] = robot.written_angles_deg;
            let axis_w = match parameter.component? {
                "roll" => rotation::from_roll_pitch_yaw_deg(0.0, pitch, yaw) * Vec3::x(),
                "pitch" => rotation::from_roll_pitch_yaw_deg(0.0, 0.0, yaw) * Vec3::y(),
                "yaw" => Vec3::z(),
                _ => return None,
            };
            change.rotation_w = axis_w * 1_f64.to_radians();
        }
        _ => return None,
    }

    let (v, turn) = (change.position_w, change.rotation_w);
    let motion = Vec6::new(v.x, v.y, v.z, turn.x, turn.y, turn.z);
    let beyond = motion - robot.platform.motion.allowed(&motion);
    // Rounding of the axes is 1e-16.
    (beyond.norm() <= 1e-12 * motion.norm()).then_some(())
}

#[cfg(test)]
mod tests {
    use super::{Parameter, Parameters, RobotPart, WITHOUT_DERIVATIVE, is_without_derivative};
    use crate::robot::spec::key::Table;
    use crate::robot::spec::{TABLES, TOP};

    /// Robot files that have every key with numbers: some keys exclude each other.
    const FILES: [&str; 2] = [
        r#"
        name = "a number for most keys"
        gravity_m_s2 = [0.0, 0.0, -9.81]
        [platform]
        mass_kg = 10.0
        inertia_kg_m2 = [0.2, 0.3, 0.4]
        center_of_mass_m = [0.0, 0.0, 0.1]
        drag_area_m2 = 0.3
        translational_damping_n_s_m = [1.0, 1.0, 1.0]
        rotational_damping_n_m_s = [0.1, 0.1, 0.1]
        [materials.rope]
        youngs_modulus_pa = 100e9
        diameter_m = 0.004
        dynamic_axial_stiffness_n = 2e6
        mass_kg_per_m = 0.07
        damping_ratio = 0.003
        axial_loss_factor = 0.02
        axial_damping_time_s = 0.8e-3
        minimum_tension_n = 1.0
        maximum_tension_n = 5000.0
        breaking_load_n = 9000.0
        drag_coefficient = 1.2
        drag_diameter_m = 0.005
        load_n_per_m = [0.0, 0.1, 0.0]
        [pulleys.wheel]
        radius_m = 0.05
        entry_direction = [0.0, 0.0, 1.0]
        inertia_kg_m2 = 0.0002
        swivel_inertia_kg_m2 = 0.001
        friction_coefficient = 0.1
        [winches.drum]
        drum_side_length_m = 2.0
        drum_radius_m = 0.06
        stiffness_n_per_m = 1e5
        drum_inertia_kg_m2 = 0.004
        motor_inertia_kg_m2 = 0.001
        gear_ratio = 5.0
        damping_n_m_s_per_rad = 0.01
        control = "position"
        bandwidth_hz = 8.0
        control_damping_ratio = 0.7
        delay_s = 0.001
        gear_efficiency = 0.9
        max_speed_m_s = 2.0
        max_acceleration_m_s2 = 10.0
        max_torque_n_m = 12.0
        max_power_w = 1500.0
        max_brake_power_w = 500.0
        torque_speed_rad_s = [0.0, 300.0]
        torque_speed_n_m = [12.0, 4.0]
        [guide_wheels.guide]
        winch = "drum"
        distance_m = 0.5
        radius_m = 0.04
        inertia_kg_m2 = 0.0001
        [supports.post]
        stiffness_n_per_m = 1e5
        mass_kg = 20.0
        damping_ratio = 0.01
        [[cables]]
        name = "1"
        material = "rope"
        anchor_m = [0.0, 0.0, 3.0]
        attachment_m = [0.1, 0.0, 0.0]
        pulley = "wheel"
        winch = "drum"
        support = "post"
        minimum_tension_n = 2.0
        maximum_tension_n = 4000.0
        unstrained_length_m = 4.5
        [loads]
        force_n = [0.0, 0.0, -50.0]
        moment_n_m = [0.0, 0.0, 2.0]
        point_m = [0.0, 0.0, -0.1]
        [wind]
        velocity_m_s = [8.0, 0.0, 0.0]
        air_density_kg_m3 = 1.2
        turbulence = "kaimal"
        intensity = [0.15, 0.12, 0.075]
        length_scale_m = [85.0, 28.0, 6.9]
        coherence_decay = [0.0, 10.0, 10.0]
        "#,
        r#"
        name = "keys that exclude others"
        [platform]
        mass_kg = 10.0
        motion = "planar"
        plane_normal = [0.0, 1.0, 0.0]
        plane_offset_m = 0.5
        inertia_kg_m2 = 0.2
        [materials.rope]
        axial_stiffness_n = 1e6
        mass_kg_per_m = 0.07
        viscous_damping_n_s_m2 = 0.5
        [materials.other]
        youngs_modulus_pa = 100e9
        area_m2 = 1e-5
        mass_kg_per_m = 0.07
        [pulleys.wheel]
        radius_m = 0.05
        efficiency = 0.96
        [pulleys.journal]
        radius_m = 0.05
        bearing_friction_coefficient = 0.1
        bearing_radius_m = 0.01
        [winches.drum]
        drum_radius_m = 0.06
        shaft_stiffness_n_m_per_rad = 400.0
        control = "position"
        position_gain_n_m_per_rad = 100.0
        speed_gain_n_m_s_per_rad = 5.0
        [[cables]]
        name = "1"
        material = "rope"
        anchor_m = [0.0, 0.5, 3.0]
        attachment_m = [0.1, 0.0, 0.0]
        pulley = "wheel"
        winch = "drum"
        entry_direction = [0.0, 0.0, 1.0]
        load_n_per_m = [0.0, 0.0, -0.1]
        [required]
        force_n = [1.0, 1.0, 1.0]
        moment_n_m = [0.1, 0.1, 0.1]
        payload_min_kg = 1.0
        payload_max_kg = 2.0
        payload_center_m = [0.0, 0.0, 0.1]
        payload_center_reach_m = [0.1, 0.0, 0.0]
        acceleration_m_s2 = [0.1, 0.1, 0.1]
        angular_acceleration_rad_s2 = [0.1, 0.1, 0.1]
        wind_speed_m_s = 3.0
        velocity_m_s = [1.0, 1.0, 1.0]
        angular_velocity_rad_s = [0.1, 0.1, 0.1]
        [clearance]
        cables_m = 0.01
        platform_m = 0.02
        obstacles_m = 0.03
        from_end_m = 0.04
        [platform_bodies.frame]
        size_m = [0.1, 0.1, 0.1]
        position_m = [0.0, 0.0, -0.1]
        roll_pitch_yaw_deg = [0.0, 0.0, 10.0]
        [platform_bodies.tool]
        shape = "cylinder"
        diameter_m = 0.1
        length_m = 0.2
        [platform_bodies.rail]
        from_m = [0.0, -0.1, 0.0]
        to_m = [0.0, 0.1, 0.0]
        width_m = 0.01
        height_m = 0.02
        [obstacles.column]
        shape = "cylinder"
        diameter_m = 0.1
        length_m = 0.2
        position_m = [5.0, 0.0, 0.1]
        roll_pitch_yaw_deg = [0.0, 0.0, 10.0]
        [obstacles.beam]
        from_m = [5.0, 1.0, 0.1]
        to_m = [6.0, 1.0, 0.1]
        width_m = 0.1
        height_m = 0.2
        [obstacles.crate]
        size_m = [0.1, 0.1, 0.1]
        position_m = [6.0, 0.0, 0.1]
        [[cables]]
        name = "2"
        material = "other"
        anchor_m = [1.0, 0.5, 3.0]
        attachment_m = [0.1, 0.0, 0.0]
        pulley = "journal"
        entry_direction = [0.0, 0.0, 1.0]
        [[cables]]
        name = "3"
        material = "other"
        anchor_m = [1.0, 1.5, 3.0]
        attachment_m = [0.1, 0.0, 0.0]
        shares_rope_with = "2"
        sheave_efficiency = 0.97
        [state]
        position_m = [0.5, 0.5, 1.0]
        roll_pitch_yaw_deg = [0.0, 10.0, 0.0]
        "#,
    ];

    fn is_in(table: &Table, parameter: &Parameter) -> bool {
        let name = table.header.trim_matches(['[', ']']).trim_end_matches(".NAME");
        match parameter.part {
            RobotPart::Robot => table.header == TOP,
            _ => parameter.keys[0] == name,
        }
    }

    #[test]
    fn every_number_of_the_file_has_a_direction_or_is_listed_without() {
        let files = FILES.map(|text| Parameters::from_toml(text).unwrap_or_else(|error| panic!("{error}")));
        let mut listed = 0;
        // Listed loads have no names, so their numbers are no parameters.
        for table in TABLES.iter().filter(|table| table.header != "[[required_loads]]") {
            for key in table.keys.iter().filter(|key| key.numeric_value().is_some()) {
                let label = format!("{} {}", table.header, key.name);
                let mut of_key = Vec::new();
                for parameters in &files {
                    let given = parameters.list().iter().enumerate().filter(|(_, parameter)| parameter.given);
                    for (index, parameter) in given.filter(|(_, of)| of.key == key.name && is_in(table, of)) {
                        let zero = parameters.change(index).is_none_or(|change| change.dot(&change) == 0.0);
                        of_key.push((is_without_derivative(parameter), zero));
                    }
                }

                assert!(!of_key.is_empty(), "no file of this test gives {label}");
                if of_key.iter().any(|(is_listed, _)| *is_listed) {
                    listed += 1;
                    assert!(of_key.iter().all(|&both| both == (true, true)), "{label} has a derivative");
                } else {
                    assert!(of_key.iter().any(|(_, zero)| !zero), "{label} has neither a derivative nor a reason");
                }
            }
        }
        assert_eq!(listed, WITHOUT_DERIVATIVE.iter().map(|(_, keys)| keys.len()).sum::<usize>());
    }
}

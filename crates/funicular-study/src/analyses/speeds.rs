//! `speeds`: what the winches do while the platform moves, and how fast their limits let it be.

use super::fields;
use super::found;
use super::gradient::no_solution;
use super::shared::{Origin, PoseRow};
use crate::at_rest::{self, AtRest};
use crate::columns::{Field, ResultTable, Tabled, column};
use crate::names::Named;
use crate::request::SpeedsRequest;
use crate::rows::rows;
use crate::table::Column;
use anyhow::{Result, bail};
use funicular::math::Vec6;
use funicular::robot::{LimitOfWinch, Robot, TwistSet};
use funicular::speeds::{LargestMotion, SpeedLimit, WinchAtRest, WinchSpeeds};

rows! {
    /// Results of `speeds`.
    pub struct Speeds {
        pub robot: String = hidden;
        pub static_model: &'static str;
        pub origin: Origin = spread;
        pub pose: PoseRow;
        /// Work of the winches for the required velocities; absent if none is required.
        pub required: Option<RequiredSpeeds>;
        /// Largest speed of the platform origin in every direction without turning [m/s].
        pub every_direction: LargestSpeed;
        /// Largest speeds along the coordinates of the platform: axes of the world, and turns about them.
        pub directions: Vec<DirectionRow>;
        pub cables: Vec<CableSpeeds>;
        pub warnings: Vec<String> = hidden;
    }
}

rows! {
    /// Required velocities, and the winches meanwhile.
    pub struct RequiredSpeeds {
        /// True if every winch stays within its limits.
        pub reached: bool;
        pub velocity_m_s: [f64; 3];
        pub angular_velocity_rad_s: [f64; 3];
        /// `box`, or `ellipsoid` with these half axes, for velocities and angular velocities each.
        pub velocity_shape: &'static str;
        /// Largest multiple of the required velocities.
        pub speed_factor: LargestSpeed;
        /// Largest sums of the powers of all motors that drive and of all that brake.
        pub driving_power_w: f64;
        pub braking_power_w: f64;
    }
}

rows! {
    /// Largest speed or multiple of it, with what limits it. All are absent if nothing does.
    pub struct LargestSpeed {
        pub value: Option<f64>;
        /// Cable whose winch limits it.
        pub cable: Option<String>;
        /// Limit of this winch: `speed`, `torque`, `power` or `brake-power`.
        pub limit: Option<&'static str>;
    }
}

rows! {
    /// Largest speeds along or about one axis.
    pub struct DirectionRow {
        pub coordinate: &'static str;
        /// `m/s` or `rad/s`.
        pub unit: &'static str;
        /// In the positive direction.
        pub forward: LargestSpeed;
        /// In the negative direction.
        pub backward: LargestSpeed;
    }
}

rows! {
    /// One cable with its winch.
    pub struct CableSpeeds in tables(asks: bool) with {
        let used = |name: &'static str, of: fn(&WinchInUse) -> Option<f64>| {
            let part = move |row: &Self| row.required.as_ref().and_then(of);
            column(name, "1", "used part of this limit, above 1 beyond it", move |row: &Self| {
                part(row).filter(|part| part.is_finite())
            })
        };
        let shown = |field: Field<Self>, heading: &'static str, of: fn(&WinchInUse) -> Option<f64>| {
            field
                .shown(heading, "", move |row, style| match row.required.as_ref().and_then(of) {
                    Some(part) if part.is_infinite() => "beyond".to_owned(),
                    part => style.significant(part, 3),
                })
                .read_if(asks)
        };
        let required = |of: fn(&WinchInUse) -> f64| move |row: &Self| row.required.as_ref().map(of);
    } rows {
        pub name: String => fields::cable_name(|row: &Self| row.name.clone());
        /// Speed of the cable at the drum per speed along {}, paying out.
        ///
        /// Speed of the cable at the drum per speed of the platform along the axes of the world, positive while it pays
        /// out.
        pub rate_per_velocity: [f64; 3] => each(fields::AXES, "rate_{}");
        /// Speed of the cable at the drum per angular velocity about {}, paying out.
        pub rate_per_angular_velocity_m_per_rad: [f64; 3] => each(fields::AXES, "rate_r{}_m_per_rad");
        /// Tension at the drum.
        pub tension_drum_n: f64 => one.decimals("T drum", 2);
        /// Torque of the motor at rest.
        ///
        /// Absent without a radius of the drum.
        pub motor_torque_at_rest_n_m: Option<f64> => one.significant("torque at rest", 4);
        /// Largest speed of the cable while it winds in.
        ///
        /// Largest speed of the cable at the drum while it winds in; absent without a limit.
        pub speed_max_in_m_s: Option<f64> => one.significant("in up to", 4);
        /// Largest speed of the cable while it pays out.
        pub speed_max_out_m_s: Option<f64> => one.significant("out up to", 4);
        /// Limit that is reached first.
        pub limit: Option<&'static str> => one.plain("limit");
        /// Largest speed of the platform in every direction, as far as this winch allows.
        ///
        /// Largest speed of the platform in every direction without turning, as far as this winch allows.
        pub platform_speed_max_m_s: Option<f64>
            => one.significant("platform", 4)
            => column("speed_m_s", "m/s", "largest speed for the required velocities", required(|of| of.speed_m_s))
                .significant("speed", 4)
                .read_if(asks)
            => column("driving_power_w", "W", "largest power of the motor that drives", required(|of| {
                of.driving_power_w
            }))
                .significant("drives", 4)
                .read_if(asks)
            => column("braking_power_w", "W", "largest power of the motor that brakes", required(|of| {
                of.braking_power_w
            }))
                .significant("brakes", 4)
                .read_if(asks)
            => shown(used("used_speed", |of| of.used_speed), "of speed", |of| of.used_speed)
            => shown(used("used_torque", |of| of.used_torque), "of torque", |of| of.used_torque)
            => shown(used("used_power", |of| of.used_power), "of power", |of| of.used_power)
            => shown(used("used_brake_power", |of| of.used_brake_power), "of brake", |of| of.used_brake_power);
        /// Work of the winch for the required velocities; absent if none is required.
        pub required: Option<WinchInUse> = spread;
    }
}

rows! {
    /// Largest numbers of one winch for the required velocities.
    pub struct WinchInUse {
        pub speed_m_s: f64;
        pub driving_power_w: f64;
        pub braking_power_w: f64;
        /// Used parts of the limits: above 1 beyond the limit. Absent without a limit, and a part of the torque also
        /// beyond the end of the torque–speed curve, where the part has no value.
        pub used_speed: Option<f64> = sparse;
        pub used_torque: Option<f64> = sparse;
        pub used_power: Option<f64> = sparse;
        pub used_brake_power: Option<f64> = sparse;
    }
}

/// Computes the speeds that the winches allow at an equilibrium.
///
/// # Errors
/// A robot with fewer cables than degrees of freedom, one without such an equilibrium, or an equilibrium without rates
/// of its lengths.
pub fn run(robot: Robot, request: &SpeedsRequest) -> Result<Speeds> {
    let robot = at_rest::with_required_velocities(robot, &request.required)?;
    if robot.constraint().is_under() {
        bail!(
            "{} cables cannot give a platform with {} degrees of freedom every velocity: `speeds` needs at least as \
             many cables as degrees of freedom",
            robot.cables.len(),
            robot.platform.motion.count()
        );
    }
    let at_rest = at_rest::equilibrium(robot, &request.robot, &request.state, &request.tensions)?;
    let AtRest { robot, equilibrium: rest, rule, .. } = &at_rest;
    // Lengths that are held have tensions of their own.
    let rule = rule.as_ref().filter(|_| at_rest.held_pose.is_none());
    let speeds = WinchSpeeds::at(robot, rest, rule).map_err(no_solution)?;

    let twists = robot.required.twists_w();
    let asks = !twists.is_empty();
    let cables = robot.cables.iter().zip(speeds.winches());
    let row = |of: LargestMotion| LargestSpeed::of(robot, of);
    Ok(Speeds {
        robot: robot.name.clone(),
        static_model: rest.model.name(),
        origin: Origin::of(&at_rest),
        pose: PoseRow::of(&rest.pose),
        required: asks.then(|| RequiredSpeeds::of(robot, &speeds, &twists)),
        every_direction: row(speeds.in_every_direction()),
        directions: directions(robot, &speeds),
        cables: cables
            .map(|(cable, winch)| CableSpeeds::of(cable.name.clone(), winch, asks.then_some(&twists)))
            .collect(),
        warnings: (at_rest.warnings(None).into_iter())
            .chain(kink(&at_rest, &speeds))
            .chain(at_rest.rule_near_jump())
            .collect(),
    })
}

/// Warning of rates that are not those of the rule.
fn kink(at_rest: &AtRest, speeds: &WinchSpeeds) -> Option<String> {
    let rule = at_rest.rule.as_ref().filter(|_| at_rest.held_pose.is_none() && !speeds.follows_rule)?;
    Some(format!(
        "the rule `{}` has no derivatives at this equilibrium: the rates are those of tensions that change least along \
         the cables; they differ by the change of stretch and sag alone",
        rule.name()
    ))
}

/// Largest speeds along the coordinates of the platform.
fn directions(robot: &Robot, speeds: &WinchSpeeds) -> Vec<DirectionRow> {
    let motion = &robot.platform.motion;
    let row = |(k, coordinate): (usize, &&'static str)| {
        let unit_w = motion.expanded(&Vec6::ith(k, 1.0));
        DirectionRow {
            coordinate,
            unit: if motion.is_rotation(k) { "rad/s" } else { "m/s" },
            forward: LargestSpeed::of(robot, speeds.along(&unit_w)),
            backward: LargestSpeed::of(robot, speeds.along(&-unit_w)),
        }
    };
    motion.coordinate_names().iter().enumerate().map(row).collect()
}

impl LargestSpeed {
    fn of(robot: &Robot, LargestMotion { value, cable }: LargestMotion) -> Self {
        Self {
            value: value.is_finite().then_some(value),
            cable: cable.map(|(i, _)| robot.cables[i].name.clone()),
            limit: cable.map(|(_, limit)| limit.name()),
        }
    }
}

impl RequiredSpeeds {
    fn of(robot: &Robot, speeds: &WinchSpeeds, twists: &TwistSet) -> Self {
        let factor = speeds.factor(twists);
        let powers = speeds.powers(twists);
        Self {
            reached: factor.value >= 1.0,
            velocity_m_s: robot.required.velocity_w.into(),
            angular_velocity_rad_s: robot.required.angular_velocity_w.into(),
            velocity_shape: robot.required.velocity_shape.name(),
            speed_factor: LargestSpeed::of(robot, factor),
            driving_power_w: powers.driving,
            braking_power_w: powers.braking,
        }
    }
}

impl CableSpeeds {
    fn of(name: String, at_rest: &WinchAtRest, twists: Option<&TwistSet>) -> Self {
        let [x, y, z, rx, ry, rz] = at_rest.by_twist.into();
        let finite = |value: f64| value.is_finite().then_some(value);
        let SpeedLimit { value: slowest, limit } = at_rest.slowest();
        Self {
            name,
            rate_per_velocity: [x, y, z],
            rate_per_angular_velocity_m_per_rad: [rx, ry, rz],
            tension_drum_n: at_rest.tension,
            motor_torque_at_rest_n_m: at_rest.winch.motor(at_rest.tension, 0.0, 0.0).torque,
            speed_max_in_m_s: finite(at_rest.inwards.value),
            speed_max_out_m_s: finite(at_rest.outwards.value),
            limit: limit.map(LimitOfWinch::name),
            platform_speed_max_m_s: finite(slowest / at_rest.by_twist.fixed_rows::<3>(0).norm()),
            required: twists.map(|twists| WinchInUse::of(at_rest, twists)),
        }
    }
}

impl WinchInUse {
    fn of(at_rest: &WinchAtRest, twists: &TwistSet) -> Self {
        let worst = at_rest.worst_in(twists);
        let limits = &at_rest.winch.limits;
        let used = |of: LimitOfWinch, is_given: bool| {
            worst.uses.iter().find(|(other, _)| is_given && *other == of).map(|(_, part)| *part)
        };
        Self {
            speed_m_s: worst.speed,
            driving_power_w: worst.driving,
            braking_power_w: worst.braking,
            used_speed: used(LimitOfWinch::Speed, limits.speed.is_finite()),
            used_torque: used(LimitOfWinch::Torque, limits.torque_at(0.0).is_finite()),
            used_power: used(LimitOfWinch::Power, limits.power.is_finite()),
            used_brake_power: used(LimitOfWinch::BrakePower, limits.brake_power.is_finite()),
        }
    }
}

impl Tabled for Speeds {
    fn tables() -> Vec<(&'static str, Vec<Column>)> {
        vec![("", CableSpeeds::columns(true).described())]
    }

    fn table(&self) -> ResultTable<'_> {
        ResultTable::new(CableSpeeds::columns(true), &self.cables)
    }
}

found!(Speeds, "speeds");

//! `winches`: the winches that a robot needs over its poses, for everything that is required there.

use super::candidate_poses;
use super::found;
use super::gradient::no_solution;
use super::shared::PoseRow;
use crate::at_rest;
use crate::columns::{ResultTable, Tabled};
use crate::error::{Cancelled, NoSolution};
use crate::request::{self, OfferedWinch, WinchesRequest};
use crate::rows::rows;
use crate::table::Column;
use crate::text::{significant, with_unit};
use crate::values::positive;
use crate::watch::Watch;
use anyhow::{Result, bail};
use funicular::math::Vec6;
use funicular::robot::{Pose, Robot, RopeSection, State};
use funicular::winch_needs::{CableNeeds, LargestNeed, WinchNeed, WinchNeeds, WinchNeedsError};
use std::f64::consts::PI;

/// Name of the winch that serves every cable.
const EVERY: &str = "every cable";

/// Turns of rope that stay on the drum when it is paid out: the rope holds by their friction.
const SPARE_TURNS: f64 = 3.0;

/// Distance of two layers of rope over its diameter: ropes lie in the grooves of the layer below.
const LAYER_PITCH: f64 = 0.866;

/// Maximum number of layers that are counted; no drum has so many.
const MAX_LAYERS: usize = 100;

rows! {
    /// Results of `winches`.
    pub struct Winches {
        pub robot: String = hidden;
        pub static_model: &'static str;
        /// Number of poses.
        pub poses: usize;
        /// Number of poses at which every required load is held; the others ask for no winch.
        pub held: usize;
        /// First pose at which a required load is not held.
        pub not_held: Option<NotHeldRow>;
        /// Winch that serves every cable: what asks for each of its numbers.
        pub asked: Vec<AskedRow>;
        /// Winch that serves every cable, then that of each cable.
        pub winches: Vec<WinchRow>;
        /// Winches on offer; absent without offers.
        pub offers: Option<Vec<OfferRow>>;
        pub warnings: Vec<String> = hidden;
    }
}

rows! {
    /// Pose at which a required load is not held.
    pub struct NotHeldRow {
        pub pose: PoseRow;
        /// Reason.
        pub reason: String;
    }
}

rows! {
    /// Largest value of a quantity, with what asks for it.
    pub struct AskedRow {
        /// `tension`, `speed`, `acceleration`, `torque`, `power` or `brake-power`.
        pub quantity: &'static str;
        pub value: f64;
        /// Unit of the value.
        pub unit: &'static str;
        pub cable: String;
        pub pose: PoseRow;
        /// Required load in addition to the dead load, world axes.
        pub force_n: [f64; 3];
        pub moment_n_m: [f64; 3];
        /// Velocity of the platform; absent for a tension.
        pub velocity_m_s: Option<[f64; 3]>;
        pub angular_velocity_rad_s: Option<[f64; 3]>;
    }
}

rows! {
    /// Winch that is needed.
    pub struct WinchRow in tables() {
        /// name of the cable, or `every cable` for a winch that serves all
        pub name: String => one.plain("winch");
        /// largest tension at the drum
        pub tension_n: f64 => one.significant("tension", 4);
        /// largest speed of the cable at the drum
        pub speed_m_s: f64 => one.significant("speed", 4);
        /// largest acceleration of the cable at the drum
        pub acceleration_m_s2: f64 => one.significant("acceleration", 4);
        /// largest torque of the motor; absent without a radius of the drum
        pub torque_n_m: Option<f64> => one.significant("torque", 4);
        /// largest mechanical power of the motor that drives
        pub power_w: f64 => one.significant("power", 4);
        /// largest mechanical power of the motor that brakes
        pub brake_power_w: f64 => one.significant("brakes", 4);
        /// rope that goes on and off the drum between the extreme lengths
        pub rope_m: f64 => one.significant("rope", 4);
        /// least unstrained length
        pub length_min_m: f64 => one;
        /// largest unstrained length
        pub length_max_m: f64 => one;
        /// layers of rope on the drum, three spare turns included; absent without width and radius of the drum and
        /// diameter of the rope
        pub layers: Option<usize> => one.significant("layers", 3);
    }
}

rows! {
    /// Winch on offer, compared with the winch that serves every cable.
    pub struct OfferRow in tables() {
        /// name of the winch on offer
        pub name: String => one.plain("offer");
        /// true if it is enough for every cable, as far as it says what it gives
        pub fits: bool => one.plain("fits");
        /// largest needed part of what it gives, above 1 for a winch that is too small; absent if it says nothing
        pub used: Option<f64> => one.significant("used", 3).unit("1");
        /// quantity of this part
        pub by: Option<&'static str> => one.plain("by");
    }
}

/// Quantities of a winch in the order of [`WinchNeed::ALL`], with their units.
const QUANTITIES: [(&str, &str); 6] = [
    ("tension", "N"),
    ("speed", "m/s"),
    ("acceleration", "m/s²"),
    ("torque", "N m"),
    ("power", "W"),
    ("brake-power", "W"),
];

/// Computes the winches that a robot needs.
///
/// # Errors
/// A request that contradicts itself or the robot, fewer cables than degrees of freedom, no pose at which every
/// required load is held, or work that was stopped before its first pose.
pub fn run(robot: Robot, request: &WinchesRequest, watch: &mut dyn Watch) -> Result<Winches> {
    request::check("drum_width_m", request.drum_width_m, positive)?;
    if request.offers.as_ref().is_some_and(Vec::is_empty) {
        bail!("⟪offers⟫ has no winches: give at least one");
    }
    let robot = at_rest::with_limits(&at_rest::with_state(robot, &request.state)?, &request.tensions)?;
    let robot =
        at_rest::with_required_velocities(at_rest::with_required(robot, &request.required)?, &request.velocities)?;
    if robot.constraint().is_under() {
        bail!(
            "{} cables do not hold a platform with {} degrees of freedom at every pose: `winches` needs at least as \
             many cables as degrees of freedom",
            robot.cables.len(),
            robot.platform.motion.count()
        );
    }
    if request.state.hold_lengths_of_pose {
        bail!("winches give every pose its lengths: leave out ⟪hold_lengths_of_pose⟫");
    }
    let poses = poses(&robot, request)?;
    let NeedsOfPoses { needs, held, not_held, done } = needs_of(&robot, &poses, request, watch)?;
    let Some(needs) = needs else {
        let Some(NotHeldRow { reason, .. }) = not_held else { return Err(Cancelled.into()) };
        let at = if done == 1 { "the pose does not hold" } else { "none of the poses holds" };
        bail!(NoSolution(format!("{at} every required load: {reason}")));
    };

    let winches = rows_of(&robot, &needs, request.drum_width_m);
    let mut warnings = Vec::new();
    if done < poses.len() {
        warnings.push(format!("stopped after {done} of {} poses: the winches are those of these poses", poses.len()));
    }
    if let Some(NotHeldRow { pose, reason }) = &not_held {
        let [x, y, z] = pose.position_m.map(|value| significant(value, 4));
        warnings.push(format!(
            "{} of {done} poses do not hold every required load and ask for no winch; the first is ({x}, {y}, {z}) m: \
             {reason}",
            done - held
        ));
    }
    let offers = request.offers.as_ref();
    Ok(Winches {
        robot: robot.name.clone(),
        static_model: request.state.static_model.name(),
        poses: done,
        held,
        not_held,
        asked: asked(&robot, &needs),
        offers: offers.map(|offers| offers.iter().map(|offer| OfferRow::of(offer, &winches[0])).collect()),
        winches,
        warnings,
    })
}

/// Needs of the winches over poses.
#[derive(Default)]
struct NeedsOfPoses {
    /// Needs of the poses that hold every required load; `None` without such a pose.
    needs: Option<WinchNeeds>,
    held: usize,
    /// First pose that does not hold every required load.
    not_held: Option<NotHeldRow>,
    /// Number of poses before the work was stopped.
    done: usize,
}

/// Needs of the winches over poses.
///
/// # Errors
/// Limits that contradict each other, and an equilibrium without rates of its lengths.
fn needs_of(robot: &Robot, poses: &[Pose], request: &WinchesRequest, watch: &mut dyn Watch) -> Result<NeedsOfPoses> {
    let rule = at_rest::rule(&request.tensions)?.unwrap_or_default();
    let mut found = NeedsOfPoses::default();
    for pose in poses {
        if watch.is_cancelled() {
            break;
        }
        match WinchNeeds::at(robot, pose, request.state.static_model, &rule) {
            Ok(needs) => {
                found.held += 1;
                match &mut found.needs {
                    None => found.needs = Some(needs),
                    Some(all) => all.merge(&needs),
                }
            }
            Err(WinchNeedsError::NoRates(error)) => return Err(no_solution(error)),
            Err(WinchNeedsError::NotHeld { reason, .. }) if !reason.is_no_solution() => return Err((*reason).into()),
            Err(error) => {
                let first = || NotHeldRow { pose: PoseRow::of(pose), reason: error.to_string() };
                found.not_held = Some(found.not_held.take().unwrap_or_else(first));
            }
        }
        found.done += 1;
        watch.progress(found.done, poses.len(), "poses");
    }
    Ok(found)
}

/// Poses of a request: a grid about the pose of the state, a list, or this pose alone.
fn poses(robot: &Robot, request: &WinchesRequest) -> Result<Vec<Pose>> {
    if let Some(rows) = candidate_poses::of_places(&request.places, &request.state, robot)? {
        return Ok(rows.iter().map(candidate_poses::pose).collect());
    }
    match &robot.state {
        State::Pose(pose) => Ok(vec![*pose]),
        _ => bail!("the robot has no pose: give ⟪grid⟫, ⟪poses⟫ or ⟪pose⟫"),
    }
}

/// Rows of the winch that serves every cable, and of each.
fn rows_of(robot: &Robot, needs: &WinchNeeds, drum_width: Option<f64>) -> Vec<WinchRow> {
    let of_cables: Vec<WinchRow> = (robot.cables.iter().zip(&needs.cables))
        .map(|(cable, needs)| {
            let radius = cable.anchor.winch.as_ref().and_then(|winch| winch.drum_radius);
            // The area of a wire rope is that of its metal: it tells no diameter.
            let diameter = cable.material.dimensions.section.and_then(|section| match section {
                RopeSection::Diameter(diameter) => Some(diameter),
                RopeSection::Area(_) => None,
            });
            let drum = drum_width.zip(radius).zip(diameter);
            WinchRow::of(
                cable.name.clone(),
                needs,
                drum.and_then(|((width, radius), d)| layers(needs.stroke(), width, radius, d)),
            )
        })
        .collect();
    let most = |of: fn(&WinchRow) -> f64| of_cables.iter().map(of).fold(f64::NEG_INFINITY, f64::max);
    let every = WinchRow {
        name: EVERY.to_owned(),
        tension_n: most(|row| row.tension_n),
        speed_m_s: most(|row| row.speed_m_s),
        acceleration_m_s2: most(|row| row.acceleration_m_s2),
        torque_n_m: of_cables.iter().filter_map(|row| row.torque_n_m).reduce(f64::max),
        power_w: most(|row| row.power_w),
        brake_power_w: most(|row| row.brake_power_w),
        rope_m: most(|row| row.rope_m),
        length_min_m: -most(|row| -row.length_min_m),
        length_max_m: most(|row| row.length_max_m),
        layers: of_cables.iter().filter_map(|row| row.layers).max(),
    };
    std::iter::once(every).chain(of_cables).collect()
}

impl WinchRow {
    fn of(name: String, needs: &CableNeeds, layers: Option<usize>) -> Self {
        let value = |need| needs.of(need).map(|largest: LargestNeed| largest.value);
        let or_zero = |need| value(need).unwrap_or(0.0);
        let [length_min_m, length_max_m] = needs.lengths;
        Self {
            name,
            tension_n: or_zero(WinchNeed::Tension),
            speed_m_s: or_zero(WinchNeed::Speed),
            acceleration_m_s2: or_zero(WinchNeed::Acceleration),
            torque_n_m: value(WinchNeed::Torque),
            power_w: or_zero(WinchNeed::Power),
            brake_power_w: or_zero(WinchNeed::BrakePower),
            rope_m: needs.stroke(),
            length_min_m,
            length_max_m,
            layers,
        }
    }

    /// Values in the order of [`QUANTITIES`].
    fn values(&self) -> [Option<f64>; 6] {
        [
            Some(self.tension_n),
            Some(self.speed_m_s),
            Some(self.acceleration_m_s2),
            self.torque_n_m,
            Some(self.power_w),
            Some(self.brake_power_w),
        ]
    }
}

/// Layers of rope of a diameter [m] on a drum of a width and a radius to the middle of the first layer [m] that take a
/// length of rope [m] besides the spare turns; none for a drum that is narrower than the rope, or far too small.
fn layers(length: f64, width: f64, radius: f64, diameter: f64) -> Option<usize> {
    // Half a thousandth of a turn counts as rounding of the width.
    let turns = (width / diameter + 5e-4).floor();
    let mut left = length + SPARE_TURNS * 2.0 * PI * radius;
    (turns >= 1.0).then_some(())?;
    for layer in 1..=MAX_LAYERS {
        left -= turns * 2.0 * PI * (radius + (layer - 1) as f64 * LAYER_PITCH * diameter);
        if left <= 0.0 {
            return Some(layer);
        }
    }
    None
}

/// Pose, load and velocity that ask for each number of the winch that serves every cable.
fn asked(robot: &Robot, needs: &WinchNeeds) -> Vec<AskedRow> {
    let parts = |of: &Vec6| {
        let [x, y, z, rx, ry, rz] = (*of).into();
        [[x, y, z], [rx, ry, rz]]
    };
    let row = |(need, (quantity, unit)): (WinchNeed, (&'static str, &'static str))| {
        let (cable, of) = needs.of_one(need)?;
        let [force_n, moment_n_m] = parts(&of.load_w);
        let moves = need != WinchNeed::Tension;
        let [velocity_m_s, angular_velocity_rad_s] = parts(&of.twist_w).map(|part| moves.then_some(part));
        let cable = robot.cables[cable].name.clone();
        let pose = PoseRow::of(&of.pose);
        Some(AskedRow {
            quantity,
            value: of.value,
            unit,
            cable,
            pose,
            force_n,
            moment_n_m,
            velocity_m_s,
            angular_velocity_rad_s,
        })
    };
    WinchNeed::ALL.into_iter().zip(QUANTITIES).filter_map(row).collect()
}

impl OfferRow {
    /// Comparison of an offer with what is needed.
    fn of(offer: &OfferedWinch, needed: &WinchRow) -> Self {
        let needs = needed.values().into_iter().chain([Some(needed.rope_m)]);
        let names = QUANTITIES.iter().map(|(name, _)| *name).chain(["rope"]);
        let parts =
            names.zip(needs).zip(offer.numbers()).filter_map(|((name, need), gives)| Some((name, need? / gives?)));
        let most = parts.reduce(|most, of| if of.1 > most.1 { of } else { most });
        Self {
            name: offer.name.clone(),
            fits: most.is_some_and(|(_, part)| part <= 1.0),
            used: most.map(|(_, part)| part),
            by: most.map(|(name, _)| name),
        }
    }
}

impl Winches {
    /// Winch that serves every cable in one sentence.
    pub fn sentence(&self) -> String {
        let of = |(quantity, digits): (&str, usize)| {
            let row = self.asked.iter().find(|row| row.quantity == quantity && row.value > 0.0)?;
            Some(with_unit(&significant(row.value, digits), row.unit))
        };
        let shown =
            [("tension", 4), ("speed", 3), ("acceleration", 3), ("torque", 3), ("power", 3), ("brake-power", 3)];
        let numbers: Vec<String> = shown
            .into_iter()
            .filter_map(|shown| {
                let number = of(shown)?;
                Some(if shown.0 == "brake-power" { format!("{number} while it brakes") } else { number })
            })
            .collect();
        // At one pose only the stretch under different loads is wound.
        let rope = self.winches[0].rope_m;
        let wound = if self.poses > 1 { format!("; {} m of rope", significant(rope, 3)) } else { String::new() };
        format!("Each winch: {}{wound}", numbers.join(", "))
    }
}

impl Tabled for Winches {
    fn tables() -> Vec<(&'static str, Vec<Column>)> {
        vec![("", WinchRow::columns().described())]
    }

    fn table(&self) -> ResultTable<'_> {
        ResultTable::new(WinchRow::columns(), &self.winches)
    }
}

found!(Winches, "winches");

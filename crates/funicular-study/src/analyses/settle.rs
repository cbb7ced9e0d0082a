//! `settle`: how a point of the platform swings after a release or a command, and when it has settled.

mod command;
mod history;
mod motion;
mod omitted;
mod payloads;
mod release;
mod rows;
mod shaping;
mod tension;
mod trajectory;

pub use payloads::WithPayload;
pub use shaping::Shaping;
pub use tension::LowestTension;
pub use trajectory::check as check_trajectory;

use super::fields::AXES;
use super::found;
use super::shared::Models;
use crate::at_rest::{self, AtRest, ModesBelow};
use crate::columns::{Columns, ResultTable, Tabled, column, parts};
use crate::error::NoSolution;
use crate::frequency_range::rounded_up;
use crate::request::{self, SettleRequest, check_vector};
use crate::rows::rows;
use crate::table::Column;
use crate::text::{decimals, significant};
use anyhow::{Result, bail};
use command::{Command, CommandKind};
use funicular::cable::CableModel;
use funicular::dynamics::{Dynamics, Linearisation};
use funicular::math::Vec3;
use funicular::modes::damped::DampedModes;
use funicular::modes::{self, CommandedMotions, Decay, DecayingMotion, LengthCommand, Modes, Release};
use funicular::robot::{Cable, Robot};
use funicular::statics::{Equilibrium, Stability, StaticModel};
use history::SwingHistory;
use motion::MotionKind;
use release::UnderWrench;
use std::f64::consts::TAU;

rows! {
    /// Results of `settle`.
    pub struct Settled {
        pub robot: String = hidden;
        pub below_hz: f64;
        pub models: Models = spread;
        pub tolerance_m: f64;
        /// Command before the decay; absent for a release.
        pub commanded: Option<Commanded> = spread;
        /// The wrench and its displacement; absent for a command.
        pub held: Option<Held> = spread;
        /// Maximum distance of the point from its rest in the history.
        pub peak_m: f64;
        /// Last time at which the point is at the tolerance, since the release or the end of the command; absent if it
        /// never settles.
        pub settled_s: Option<f64>;
        /// Time from which on the sum of all amplitudes is within the tolerance; absent if it never is.
        pub surely_settled_s: Option<f64>;
        /// Motion that never ends, because nothing damps it; absent if the point settles.
        pub never_settles: Option<NeverSettles>;
        /// True if a count proves that every mode has its damped mode.
        pub damped_certified: bool;
        /// Modes that take part, the largest amplitude first.
        pub modes: Vec<SettlingMode>;
        /// Motion from the release or the end of the command on.
        pub history: Vec<HistoryRow>;
        /// Frequency up to which modes are in the history; absent if all are.
        pub history_up_to_hz: Option<f64>;
        /// Rows while the command runs, if there is one, and after it.
        whole: Vec<HistoryRow> = hidden;
        pub warnings: Vec<String> = hidden;
    }
}

rows! {
    /// Undamped motion that is larger than the tolerance.
    #[derive(Debug, Clone, Copy)]
    pub struct NeverSettles {
        /// Sum of the amplitudes of all undamped modes: the point keeps swinging by up to this distance.
        pub amplitude_m: f64;
        /// Frequency of the undamped mode with the largest amplitude.
        pub frequency_hz: f64;
    }
}

rows! {
    /// Displacement before a release.
    pub struct Held {
        /// Displacement of the point under the wrench, linear, world axes.
        pub held_m: [f64; 3];
        /// Displacement between the equilibria with the wrench and without it; absent if there is none with it, and
        /// with ideal cables.
        pub held_exact_m: Option<[f64; 3]>;
        /// Bound of what the modes above the limit add to the displacement at the release.
        pub omitted_m: f64;
        pub lowest_tension: LowestTension;
    }
}

rows! {
    /// Command of the lengths.
    pub struct Commanded {
        /// `stop`, `move` or `trajectory`.
        pub command_kind: &'static str;
        /// Time from its start to its end, with the shaper.
        pub duration_s: f64;
        pub lowest_tension: LowestTension;
        /// Bound of the distance by which the modes above the limit move the point after the command; absent if none is
        /// known.
        pub omitted_m: Option<f64>;
        /// Bound of the change of the tension of a cable, averaged along it, by the modes above the limit; absent if
        /// none is known.
        pub omitted_tension_n: Option<f64>;
        /// Motion while the command runs, at negative times.
        pub during: Vec<HistoryRow>;
        pub shaping: Option<Shaping>;
        /// Vibration that the commanded lengths leave with payloads, if they are requested.
        pub payloads: Vec<WithPayload> = sparse;
        /// Names of the cables, in the order of the lengths; absent without samples.
        pub cables: Vec<String> = sparse;
        /// Lengths over time, if they are requested.
        pub lengths: Vec<LengthsRow> = sparse;
    }
}

rows! {
    /// Commanded unstrained lengths at one time.
    pub struct LengthsRow {
        /// Time since the start of the command.
        pub t_s: f64;
        pub unstrained_lengths_m: Vec<f64>;
    }
}

rows! {
    /// Part of a mode in the motion.
    pub struct SettlingMode in tables(modes: &[Self]) with {
        let is_shaped = modes.iter().any(|mode| mode.amplitude_without_m.is_some());
    } rows {
        /// Frequency of the damped mode.
        pub frequency_hz: f64 => one.decimals("f", 4);
        /// Damping ratio.
        pub damping_ratio: f64 => one
            .shown("damping", "%", |mode, style| style.significant(100.0 * mode.damping_ratio, 3));
        /// Amplitude at the release or the end of the command.
        ///
        /// Amplitude at the release or the end of the command: half of the long axis of the ellipse on which the point
        /// moves.
        pub amplitude_m: f64 => one
            .shown("amplitude", "mm", |mode, style| style.significant(1e3 * mode.amplitude_m, 3));
        /// Amplitude without the shaper.
        ///
        /// Absent without one.
        pub amplitude_without_m: Option<f64> => one
            .shown("without shaper", "mm", |mode, style| {
                mode.amplitude_without_m.map_or_else(String::new, |size| style.significant(1e3 * size, 3))
            })
            .read_if(is_shaped);
        /// Time in which this amplitude alone falls to the tolerance.
        ///
        /// Zero if it is smaller, absent if it never does.
        pub settled_s: Option<f64> => one.significant("to the tolerance", 3);
    }
}

rows! {
    /// Displacement of the point at one time from where the lengths of this time hold it at rest, and the bound of its
    /// distance.
    #[derive(Clone)]
    pub struct HistoryRow in tables() with {
        let place = |row: &Self| [row.x_m, row.y_m, row.z_m];
    } rows {
        /// Time since the release or the end of the command.
        pub t_s: f64
            => one
            => parts(
                "{}_m",
                AXES,
                "m",
                "displacement of the point from its rest with the lengths of this time, {}",
                place,
            );
        pub x_m: f64;
        pub y_m: f64;
        pub z_m: f64;
        /// Bound of its distance from its rest, from the end of a command on.
        ///
        /// Absent while a command runs.
        pub envelope_m: Option<f64> => one;
    }
}

/// Points per period of the fastest mode that takes part, and maximum number of points.
const POINTS_PER_PERIOD: f64 = 16.0;
const MAX_POINTS: f64 = 20_000.0;

/// Part of the largest amplitude below which a mode does not make the steps of the history finer.
const SMALL: f64 = 1e-3;

/// Least relative change of the frequency of the platform on the way for which the linear motion about the end is in
/// doubt. A move of 0.18 m of the robot of Yuan 2014 has the right amplitude then, and a history that is wrong by a
/// quarter.
const FREQUENCIES_DIFFER: f64 = 0.1;

/// Computes the decay after a release or a command.
///
/// # Errors
/// A request without any of these or with several, a robot without such an equilibrium, a slack cable, an equilibrium
/// to which nothing returns, or modes whose decay has no closed form.
pub fn run(robot: Robot, request: &SettleRequest) -> Result<Settled> {
    checked(request)?;
    let state = trajectory::state(&robot, request)?;
    let at_rest = |robot: Robot| at_rest::equilibrium(robot, &request.robot, &state, &request.tensions);
    let light = CommandKind::of(request).and_then(|_| with_light_ropes(&robot));
    let Some(light) = light else { return about(&at_rest(robot)?, request) };

    // What is unusual about the light ropes is none of the user's values.
    let (given, light) = (at_rest(robot)?, at_rest(light)?);
    let known: Vec<String> = given.implausible().collect();
    let added: Vec<String> = light.implausible().filter(|warning| !known.contains(warning)).collect();
    let mut found = about(&light, request)?;
    found.warnings.retain(|warning| !added.contains(warning));
    Ok(found)
}

/// Mass of a rope without mass while its length is commanded, per metre and over the mass of the platform: its own
/// vibration is far above that of the platform, and its weight is below the digits of a tension.
const LIGHT: f64 = 1e-9;

/// Robot whose ropes without mass have a negligible one, because only a rope with mass has a commanded length; `None`
/// if all ropes have mass.
fn with_light_ropes(robot: &Robot) -> Option<Robot> {
    let is_massless = |cable: &Cable| cable.material.mass_per_length == 0.0;
    if !robot.cables.iter().any(is_massless) {
        return None;
    }
    let mut light = robot.clone();
    for cable in light.cables.iter_mut().filter(|cable| is_massless(cable)) {
        cable.material.mass_per_length = LIGHT * robot.platform.mass;
    }
    Some(light)
}

/// Computes the decay of a robot at equilibrium. The state of the request is not used.
///
/// # Errors
/// The errors of [`run`].
pub fn about(at_rest: &AtRest, request: &SettleRequest) -> Result<Settled> {
    checked(request)?;
    check_rest(at_rest)?;
    let command = Command::of(at_rest, request)?;
    let (swing, mut warnings) = Swing::of(at_rest, request, command.as_ref())?;
    let moved = match &command {
        Some(command) => swing.after_command(command, request, &mut warnings)?,
        None => swing.after_release(request, &mut warnings)?,
    };

    let (decay, tolerance) = (&moved.decay, request.tolerance_m);
    let surely_settled = decay.surely_settled(tolerance);
    let without = moved.without.as_ref().map(|decay| decay.surely_settled(tolerance));
    let shown_until = without.filter(|time| time.is_finite()).map_or(surely_settled, |time| surely_settled.max(time));
    let SwingHistory { rows: history, up_to_hz, peak } = SwingHistory::of(decay, shown_until);
    warnings.extend(up_to_hz.map(history::caveat));
    let held = moved.held.as_ref().map_or(0.0, |held| Vec3::from(held.held_m).norm());
    let during = moved.commanded.as_ref().map_or(&[][..], |commanded| &commanded.during);
    let whole = [during, &history].concat();
    Ok(Settled {
        robot: at_rest.robot.name.clone(),
        below_hz: swing.limit,
        models: Models::of(at_rest, swing.linearisation),
        tolerance_m: tolerance,
        peak_m: peak.max(held),
        settled_s: finite(decay.settled(tolerance)),
        surely_settled_s: finite(surely_settled),
        never_settles: NeverSettles::of(decay, tolerance),
        damped_certified: swing.damped.certified,
        modes: settling_modes(decay, moved.without.as_ref(), tolerance),
        history,
        history_up_to_hz: up_to_hz,
        whole,
        commanded: moved.commanded,
        held: moved.held,
        warnings,
    })
}

/// Free motions of a robot at equilibrium.
struct Swing<'a> {
    at_rest: &'a AtRest,
    linearisation: Linearisation,
    limit: f64,
    dynamics: Dynamics,
    modes: Modes,
    damped: DampedModes,
    /// Point whose motion counts, from the platform origin, world axes.
    arm_w: Vec3,
}

/// Motion after a release or a command.
struct Moved {
    decay: Decay,
    held: Option<Held>,
    commanded: Option<Commanded>,
    /// Motion after the command without its shaper; `None` without one.
    without: Option<Decay>,
}

impl<'a> Swing<'a> {
    /// Free motions, with warnings. Without a given limit it is so high that the modes above it do not count.
    fn of(at_rest: &'a AtRest, request: &SettleRequest, command: Option<&Command>) -> Result<(Self, Vec<String>)> {
        let linearisation = at_rest::linearisation(&request.model, at_rest.equilibrium.model);
        if command.is_some() && linearisation.cable_model != CableModel::CatenaryDynamic {
            bail!(
                "the cable model `{}` has no length that is commanded: commands need `catenary-dynamic`, the default",
                linearisation.cable_model.name()
            );
        }
        let point_p = Vec3::from(request.points.output_point_m.unwrap_or_default());
        let arm_w = at_rest.equilibrium.pose.rot_wp * point_p;
        let of_limit = |limit: f64| at_rest.modes_with_strains(linearisation, limit, modes::MAX_MODES);
        let (mut limit, is_given) = match request.below_hz {
            Some(given) => (at_rest.modes_limit(Some(given), linearisation)?, true),
            None => (at_rest.sway_limit(linearisation)?, false),
        };
        let mut found = of_limit(limit)?;
        while !is_given
            && omitted::counts(at_rest, request, command, &found, &arm_w)
            && found.dynamics.modes_below(omitted::NEXT_LIMIT * limit * TAU) <= omitted::MAX_CHOSEN_MODES
        {
            limit = rounded_up(omitted::NEXT_LIMIT * limit);
            found = of_limit(limit)?;
        }

        let ModesBelow { dynamics, modes, mut warnings } = found;
        warnings.extend(at_rest.without_damping());
        let damped = modes::damped::damped_modes(&dynamics, &modes);
        let ratios: Vec<f64> = damped.modes.iter().map(modes::damped::DampedMode::damping_ratio).collect();
        warnings.extend(modes::caveat_of_stretch(&at_rest.robot, &modes.modes, &ratios, modes::PLATFORM_SHARE));
        if modes.modes.iter().all(|mode| mode.platform_energy_fraction == 0.0) && damped.others.is_empty() {
            bail!("no mode in which the platform moves lies below {limit} Hz: raise ⟪below_hz⟫, or leave it out");
        }
        Ok((Self { at_rest, linearisation, limit, dynamics, modes, damped, arm_w }, warnings))
    }

    fn after_release(&self, request: &SettleRequest, warnings: &mut Vec<String>) -> Result<Moved> {
        let wrench = omitted::wrench(self.at_rest, request);
        let released = Release::of(&self.dynamics, &self.modes, &self.damped, &wrench, &self.arm_w)?;
        let lowest_tension = LowestTension::after_release(self.at_rest, &released)?;
        let Release { decay, held, omitted, .. } = released;
        warnings.extend(omitted::caveat_of_release(omitted, request.tolerance_m, self.limit));

        let under_wrench = UnderWrench::of(self.at_rest, request);
        warnings.extend(under_wrench.as_ref().and_then(|under| under.caveat(&held)));
        let held_exact_m = under_wrench.and_then(|under| Some(under.found?.0.into()));
        let held = Held { held_m: held.into(), held_exact_m, omitted_m: omitted, lowest_tension };
        Ok(Moved { decay, held: Some(held), commanded: None, without: None })
    }

    fn after_command(&self, unshaped: &Command, request: &SettleRequest, warnings: &mut Vec<String>) -> Result<Moved> {
        let motions = CommandedMotions::of(&self.dynamics, &self.modes, &self.damped, &self.arm_w)?;
        let without = motions.after(&unshaped.lengths());
        let shaped = match shaping::kind(request)? {
            Some(kind) => Some(shaping::chosen(kind, request, &without)?),
            None => None,
        };
        let shaped_command = shaped.as_ref().map(|(shaper, _)| unshaped.shaped(shaper)).transpose()?;
        let command = shaped_command.as_ref().unwrap_or(unshaped);
        let lowest_tension = LowestTension::of(self.at_rest, command, &motions)?;
        let omitted = omitted::bounds(self.at_rest, self.linearisation, &self.modes, &self.arm_w, &command.lengths());
        warnings.extend(omitted::caveat(omitted.as_ref(), request.tolerance_m, self.limit, &lowest_tension));
        warnings.extend(self.frequencies_at(&command.start()?)?);
        warnings.extend(command.rule_jumps());

        let name = request.shaper.as_deref().unwrap_or_default();
        let tolerance = request.tolerance_m;
        let shaping = shaped.map(|(shaper, modes)| Shaping::of(name, &shaper, modes, &without, tolerance));
        let lengths = request.sample_time_s.map(|step| command.sampled(step)).transpose()?.unwrap_or_default();
        let cables = &self.at_rest.robot.cables;
        let lengths_without = unshaped.lengths();
        let commanded = Commanded {
            command_kind: command.name(),
            duration_s: command.duration(),
            lowest_tension,
            omitted_m: omitted.as_ref().map(|of| of.distance),
            omitted_tension_n: omitted
                .map(|of| of.mean_tensions.into_iter().fold(0.0, f64::max))
                .filter(|of| of.is_finite()),
            during: during(&motions, &command.lengths()),
            payloads: self.with_payloads(request, &command.lengths(), shaping.is_some().then_some(&lengths_without))?,
            cables: if lengths.is_empty() { Vec::new() } else { cables.iter().map(|of| of.name.clone()).collect() },
            lengths,
            shaping,
        };
        let decay = motions.after(&command.lengths());
        let without = commanded.shaping.is_some().then_some(without);
        Ok(Moved { decay, held: None, commanded: Some(commanded), without })
    }

    /// Warning if the frequency of the platform at the start of a command is another than at its end.
    fn frequencies_at(&self, start: &Equilibrium) -> Result<Option<String>> {
        let (robot, start) = start.with_dynamic_stiffness(&self.at_rest.robot);
        let dynamics = Dynamics::about(&robot, &start, self.linearisation, self.limit)?;
        // The smooth frequency: lists of modes at two poses do not pair by number.
        let pair = dynamics.platform_frequency().zip(self.dynamics.platform_frequency());
        let differs = pair.filter(|(from, to)| (from / to - 1.0).abs() > FREQUENCIES_DIFFER);
        Ok(differs.map(|(from, to)| {
            format!(
                "the frequency of the platform is {from:.4} Hz at the start of the motion and {to:.4} Hz at its end, \
                 where the motion is linear: amplitudes have the right size, the history does not; a shaper is made \
                 for the end"
            )
        }))
    }
}

fn checked(request: &SettleRequest) -> Result<()> {
    request.points.check()?;
    for (name, vector) in [
        ("release_n", request.release_n),
        ("release_n_m", request.release_n_m),
        ("stop_m_s", request.stop_m_s),
        ("stop_rad_s", request.stop_rad_s),
        ("move_m", request.move_m),
        ("move_deg", request.move_deg),
    ] {
        check_vector(name, vector)?;
    }
    request::check_positive("tolerance_m", request.tolerance_m)?;

    let moves = |parts: [Option<[f64; 3]>; 2]| parts.into_iter().flatten().flatten().any(|part| part != 0.0);
    let release = [request.release_n, request.release_n_m];
    let (stop, moved) = ([request.stop_m_s, request.stop_rad_s], [request.move_m, request.move_deg]);
    let given = [release, stop, moved].iter().filter(|parts| parts.iter().any(Option::is_some)).count();
    if given + usize::from(request.trajectory.is_some()) > 1 {
        bail!(
            "give a release, a stop, a move or a trajectory, not several: the motions of each add up, because they are \
             linear"
        );
    }
    match CommandKind::of(request) {
        None if !moves(release) => bail!(
            "nothing is released: give the force ⟪release_n⟫, as 0,0,-20, or the moment ⟪release_n_m⟫; or a motion \
             that ends, ⟪stop_m_s⟫, ⟪move_m⟫ or ⟪trajectory⟫"
        ),
        None => command::refuse_for_release(request),
        Some(CommandKind::Motion(MotionKind::Stop)) if !moves(stop) => {
            bail!("nothing stops: give the velocity before, ⟪stop_m_s⟫, as 0,0.2,0")
        }
        Some(CommandKind::Motion(MotionKind::Move)) if !moves(moved) => {
            bail!("nothing moves: give the displacement ⟪move_m⟫, as 0,0.2,0")
        }
        Some(kind) => {
            shaping::kind(request)?;
            command::check_times(kind, request)
        }
    }
}

/// Refuses an equilibrium about which nothing swings linearly, or to which nothing returns.
fn check_rest(AtRest { robot, equilibrium, .. }: &AtRest) -> Result<()> {
    let is_slack = |i: &usize| equilibrium.model != StaticModel::Ideal && equilibrium.cables[*i].is_slack();
    if let Some(i) = (0..robot.cables.len()).find(is_slack) {
        let name = &robot.cables[i].name;
        return Err(NoSolution(format!(
            "cable \"{name}\" is slack at rest: it pulls in one direction only, and the linear motion does not \
             know that; choose a state without slack cables, or the static model `catenary`"
        ))
        .into());
    }
    if matches!(equilibrium.stability, Stability::Unstable { .. }) {
        return Err(NoSolution(
            "the equilibrium is not stable: the platform does not come to rest there; choose another pose".to_owned(),
        )
        .into());
    }
    Ok(())
}

/// Time, or `None` for one that never comes.
fn finite(time: f64) -> Option<f64> {
    Some(time).filter(|time| time.is_finite())
}

impl NeverSettles {
    /// Undamped motion of a decay, if it is larger than the tolerance.
    fn of(decay: &Decay, tolerance: f64) -> Option<Self> {
        let amplitude_m: f64 = decay.undamped().map(DecayingMotion::size).sum();
        let largest = decay.undamped().max_by(|a, b| a.size().total_cmp(&b.size()))?;
        (amplitude_m > tolerance).then(|| Self { amplitude_m, frequency_hz: largest.omega.norm() / TAU })
    }
}

fn settling_modes(decay: &Decay, without: Option<&Decay>, tolerance: f64) -> Vec<SettlingMode> {
    let mut all: Vec<SettlingMode> = (decay.motions.iter().enumerate())
        .map(|(k, motion)| {
            let (size, rate) = (motion.size(), motion.rate());
            SettlingMode {
                frequency_hz: motion.omega.norm() / TAU,
                damping_ratio: rate / motion.omega.norm(),
                amplitude_m: size,
                amplitude_without_m: without.map(|without| without.motions[k].size()),
                settled_s: if size > tolerance { finite((size / tolerance).ln() / rate) } else { Some(0.0) },
            }
        })
        .collect();
    let loudness = |mode: &SettlingMode| mode.amplitude_without_m.unwrap_or(mode.amplitude_m);
    all.sort_by(|a, b| loudness(b).total_cmp(&loudness(a)));
    all
}

/// Number of steps in which a history shows the fastest mode that counts.
fn points_in(until: f64, fastest: f64) -> f64 {
    (until * fastest / TAU * POINTS_PER_PERIOD).clamp(2.0, MAX_POINTS).ceil()
}

/// Motion while a command runs, up to its end.
fn during(motions: &CommandedMotions, command: &LengthCommand) -> Vec<HistoryRow> {
    let end = command.duration();
    let left = motions.after(command).motions;
    let largest = left.iter().map(DecayingMotion::size).fold(0.0, f64::max);
    let counts = left.iter().filter(|motion| motion.size() >= SMALL * largest);
    let points = points_in(end, counts.fold(0.0, |fastest, motion| fastest.max(motion.omega.re)));
    // The end itself is the first row of the history after it.
    let times: Vec<f64> = (0..points as usize).map(|i| end * i as f64 / points).collect();
    let beside = motions.beside_static(command, &times);
    let row = |(time, place): (&f64, Vec3)| {
        let [x_m, y_m, z_m] = place.into();
        HistoryRow { t_s: time - end, x_m, y_m, z_m, envelope_m: None }
    };
    if end > 0.0 { times.iter().zip(beside).map(row).collect() } else { Vec::new() }
}

/// Words for a time after which something holds.
pub fn after(time: Option<f64>) -> String {
    time.map_or_else(|| "never".to_owned(), |time| format!("after {} s", significant(time, 4)))
}

impl Settled {
    /// Sentence without its end that says when the point has settled, also by the sum of all amplitudes, or why it
    /// never does.
    pub fn when_settled(&self) -> String {
        let tolerance = significant(1e3 * self.tolerance_m, 4);
        if let Some(of) = &self.never_settles {
            return format!(
                "Never within {tolerance} mm for good: the point keeps swinging by up to {} mm, because the mode at \
                 {} Hz has no damping; give the ropes `damping_ratio` and `axial_loss_factor`, or the platform \
                 `translational_damping_n_s_m`",
                significant(1e3 * of.amplitude_m, 4),
                decimals(of.frequency_hz, 4)
            );
        }
        format!("{}; by the sum of all amplitudes {}", self.when_within(&tolerance), after(self.surely_settled_s))
    }

    /// Time after which the point stays within the tolerance [mm].
    fn when_within(&self, tolerance: &str) -> String {
        match &self.commanded {
            Some(of) if self.settled_s == Some(0.0) => {
                format!("The point is already within {tolerance} mm of its rest when the {} ends", of.command_kind)
            }
            None if self.settled_s == Some(0.0) => {
                format!("The point is already within {tolerance} mm of its rest at the release")
            }
            _ => format!("Within {tolerance} mm for good {}", after(self.settled_s)),
        }
    }
}

impl Commanded {
    /// Table of the commanded lengths over time.
    pub fn lengths_table(&self) -> ResultTable<'_> {
        let columns = Columns::new([
            column("t_s", "s", "time since the start of the command", |row: &LengthsRow| row.t_s),
            parts(
                "unstrained_length_{}_m",
                &self.cables,
                "m",
                "commanded unstrained length of cable {}",
                |row: &LengthsRow| row.unstrained_lengths_m.clone(),
            ),
        ]);
        ResultTable::new(columns, &self.lengths)
    }
}

impl Tabled for Settled {
    fn tables() -> Vec<(&'static str, Vec<Column>)> {
        vec![("", HistoryRow::columns().described())]
    }

    fn table(&self) -> ResultTable<'_> {
        ResultTable::new(HistoryRow::columns(), &self.whole)
    }
}

found!(Settled, "settle");

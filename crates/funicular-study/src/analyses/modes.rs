//! `modes`: every natural frequency below a limit.

mod columns;

use super::found;
use super::shared::{Axes, ModeRow, Models};
use crate::at_rest::{self, AtRest, ModesBelow};
use crate::request::{self, Model, Terms};
use crate::rows::rows;
use crate::shared_ropes::refuse_ropes_in;
use crate::signals::{Input, Output, response_unit};
use anyhow::{Result, anyhow, bail};
use funicular::cable_motion::CableStations;
use funicular::dynamics::{Assembly, Dynamics, Linearisation};
use funicular::math::Rotation;
use funicular::modes::{self, damped};
use funicular::response::Signal;
use funicular::robot::{Robot, WinchMode};
use std::f64::consts::TAU;

rows! {
    /// Results of `modes`: every natural frequency below a limit.
    pub struct Modes {
        pub robot: String = hidden;
        pub below_hz: f64;
        /// True if the request gives no limit, and the lowest natural frequencies are shown.
        pub is_default_limit: bool = hidden;
        pub models: Models = spread;
        pub count_below: usize;
        pub certified: bool;
        /// Directions without a frequency, in which the equilibrium is unstable or indifferent.
        pub unstable_directions: usize;
        /// True if the equilibrium is indifferent in these directions: nothing holds the platform, nor drives it away.
        pub is_indifferent: bool = hidden;
        /// True if a count proves that every mode has its damped mode; absent if damping ratios are of first order.
        pub damped_certified: Option<bool>;
        /// Percentage of the amplitude to which modes decay in `decay_time_s`; absent for rigid cables.
        pub decay_percent: Option<f64>;
        /// Minimum fraction of the kinetic energy in the platform for `first_platform_mode`.
        pub platform_share: f64;
        /// First mode of the platform; absent if none lies below the limit.
        pub first_platform_mode: Option<FirstPlatformMode>;
        /// Modes below it that move the platform considerably, with at least a fifth of their kinetic energy: a motion
        /// of the platform that is split beside a resonance of a cable.
        pub share_platform: Vec<FirstPlatformMode> = sparse;
        pub cable_names: Vec<String>;
        /// Names of the flexible supports; absent on a rigid frame.
        pub support_names: Vec<String> = sparse;
        pub participation: Option<Participation> = spread;
        pub stations: Vec<StationsRow> = sparse;
        pub modes: Vec<ModeRow>;
        /// Points of the platform, for files of mode shapes.
        pub outline: Outline = hidden;
        pub warnings: Vec<String> = hidden;
    }
}

rows! {
    /// Mode that moves the platform, with its share: the first one with enough of it, or one below.
    #[derive(Debug, Clone, Copy)]
    pub struct FirstPlatformMode {
        /// Index in the list of modes, from 0.
        pub index: usize;
        pub frequency_hz: f64;
        pub platform_energy_fraction: f64;
    }
}

impl FirstPlatformMode {
    /// First mode of the platform in a list.
    pub fn of(found: &modes::Modes, share: f64) -> Option<Self> {
        Some(Self::at(found, found.first_platform(share)?))
    }

    /// Modes below it that move the platform, too.
    pub fn below(found: &modes::Modes, share: f64) -> Vec<Self> {
        found.share_platform(share).into_iter().map(|index| Self::at(found, index)).collect()
    }

    fn at(found: &modes::Modes, index: usize) -> Self {
        let modes::Mode { frequency_hz, platform_energy_fraction, .. } = found.modes[index];
        Self { index, frequency_hz, platform_energy_fraction }
    }
}

/// Points of the platform and its orientation.
pub struct Outline {
    /// Attachments in the order of the cables, platform frame [m].
    pub attachments_m: Vec<[f64; 3]>,
    /// Rotation from the platform frame to the world frame.
    pub rot_wp: Rotation,
}

impl Outline {
    fn of(at_rest: &AtRest) -> Self {
        let attachments_m = at_rest.robot.cables.iter().map(|cable| cable.attachment_p.into()).collect();
        Self { attachments_m, rot_wp: at_rest.equilibrium.pose.rot_wp }
    }
}

rows! {
    /// Input and output of the response to which the modes contribute.
    pub struct Participation {
        pub input: String;
        pub output: String;
        /// Unit of `peak`.
        pub peak_unit: String;
    }
}

rows! {
    /// Stations of a cable, where the displacements of `cable_shapes` are given.
    pub struct StationsRow {
        pub cable: String;
        pub arc_length_m: Vec<f64>;
        pub position_m: Vec<[f64; 3]>;
        pub axes: Axes;
    }
}

/// Computes every natural frequency below a limit.
///
/// # Errors
/// A request that contradicts itself or the robot, a robot without such an equilibrium, or too many modes.
pub fn run(robot: Robot, request: &request::ModesRequest) -> Result<Modes> {
    // Signals that the robot does not have are refused before the work.
    let pair = checked(&robot, request)?;
    of_checked(&at_rest::equilibrium(robot, &request.robot, &request.state, &request.tensions)?, request, pair)
}

/// Computes the natural frequencies of a robot at equilibrium. The state of the request is not used.
///
/// # Errors
/// The errors of [`run`].
pub fn about(at_rest: &AtRest, request: &request::ModesRequest) -> Result<Modes> {
    of_checked(at_rest, request, checked(&at_rest.robot, request)?)
}

/// Name of the cable model of rigid cables in results.
pub const RIGID: &str = "rigid";

/// Modes of a robot on rigid cables.
///
/// # Errors
/// Options that rigid cables do not have, sagging cables, or a platform without mass.
pub fn with_rigid_cables(at_rest: &AtRest, request: &request::ModesRequest) -> Result<(modes::Modes, Vec<String>)> {
    let Model { cable_model, terms: Terms { assembly, in_plane_only, winches } } = request.model;
    let given = [
        (cable_model.is_some(), "cable_model", "the cables are rigid in every frequency range"),
        (assembly != Assembly::Consistent, "assembly", "their stiffness is the geometric stiffness alone"),
        (in_plane_only, "in_plane_only", "straight cables have no plane"),
        (winches != WinchMode::AsGiven, "winches", "their winches are rigid"),
        (request.input.is_some(), "input", "responses are computed for cables that stretch"),
        (request.stations.is_some(), "stations", "rigid cables do not vibrate"),
    ];
    if let Some((_, key, reason)) = given.into_iter().find(|(given, ..)| *given) {
        bail!("⟪rigid_cables⟫ does not go with ⟪{key}⟫, because {reason}: leave out one of the two");
    }

    refuse_ropes_in("⟪rigid_cables⟫", &at_rest.robot)?;
    // There are at most six such motions, so all of them are shown without a limit.
    let limit = request.below_hz.unwrap_or(request::MAX_HZ);
    let found = modes::with_rigid_cables(&at_rest.robot, &at_rest.equilibrium, limit)
        .map_err(|error| anyhow!("⟪rigid_cables⟫: {error}"))?;
    let mut warnings = at_rest.warnings(None);
    warnings.extend(found.caveat());
    Ok((found, warnings))
}

/// Result of `modes` with rigid cables.
fn about_rigid_cables(at_rest: &AtRest, request: &request::ModesRequest) -> Result<Modes> {
    let (found, warnings) = with_rigid_cables(at_rest, request)?;
    let robot = &at_rest.robot;

    Ok(Modes {
        robot: robot.name.clone(),
        below_hz: found.below_hz,
        is_default_limit: false,
        models: Models { cable_model: RIGID, ..Models::of(at_rest, Linearisation::default()) },
        count_below: found.count_below,
        certified: found.certified,
        unstable_directions: found.unstable_directions,
        is_indifferent: at_rest.equilibrium.stability.is_indifferent(),
        damped_certified: None,
        decay_percent: None,
        platform_share: request.platform_share,
        first_platform_mode: FirstPlatformMode::of(&found, request.platform_share),
        share_platform: FirstPlatformMode::below(&found, request.platform_share),
        cable_names: robot.cables.iter().map(|cable| cable.name.clone()).collect(),
        support_names: Vec::new(),
        participation: None,
        stations: Vec::new(),
        modes: found.modes.into_iter().map(ModeRow::from).collect(),
        outline: Outline::of(at_rest),
        warnings,
    })
}

/// Computes the natural frequencies for a request that [`checked`] has accepted.
fn of_checked(at_rest: &AtRest, request: &request::ModesRequest, pair: Option<SignalPair>) -> Result<Modes> {
    if request.rigid_cables {
        return about_rigid_cables(at_rest, request);
    }
    if pair.is_some() {
        refuse_ropes_in("`modes` with ⟪input⟫ and ⟪output⟫", &at_rest.robot)?;
    }
    let linearisation = at_rest::linearisation(&request.model, at_rest.equilibrium.model);
    let limit = at_rest.modes_limit(request.below_hz, linearisation)?;
    let ModesBelow { dynamics, modes: found, mut warnings } =
        at_rest.modes_with_strains(linearisation, limit, modes::MAX_MODES)?;
    warnings.extend(at_rest.without_damping());
    let at_rest = &*at_rest.vibrating();
    let AtRest { robot, .. } = at_rest;

    // Damping, and the peaks that depend on it.
    let mut rows: Vec<ModeRow> = found.modes.iter().cloned().map(ModeRow::from).collect();
    let (partners, caveats) = if request.damped { modes::damped_partners(&dynamics, &found) } else { (None, vec![]) };
    warnings.extend(caveats);
    if let Some(partners) = &partners {
        for (row, mode) in rows.iter_mut().zip(&partners.modes) {
            let eigenvalue = mode.eigenvalue();
            row.damping_ratio = mode.damping_ratio();
            row.eigenvalue_per_s = Some([eigenvalue.re, eigenvalue.im]);
        }
    }
    let ratios: Vec<f64> = rows.iter().map(|row| row.damping_ratio).collect();
    warnings.extend(modes::caveat_of_stretch(robot, &found.modes, &ratios, request.platform_share));
    set_decay_times(&mut rows, request.decay_percent);
    let participation = pair.map(|pair| participate(&mut rows, at_rest, &dynamics, &found, &pair)).transpose()?;

    let stations = request.stations.map_or(Ok(Vec::new()), |count| stations(at_rest, &dynamics, count))?;
    for (row, mode) in rows.iter_mut().zip(&found.modes) {
        row.cable_shapes = stations.iter().map(|of| of.in_mode(&dynamics, mode)).collect();
    }

    Ok(Modes {
        robot: robot.name.clone(),
        below_hz: limit,
        is_default_limit: request.below_hz.is_none(),
        models: Models::of(at_rest, linearisation),
        count_below: found.count_below,
        certified: found.certified,
        unstable_directions: found.unstable_directions,
        is_indifferent: at_rest.equilibrium.stability.is_indifferent(),
        damped_certified: partners.map(|partners| partners.certified),
        decay_percent: Some(request.decay_percent),
        platform_share: request.platform_share,
        first_platform_mode: FirstPlatformMode::of(&found, request.platform_share),
        share_platform: FirstPlatformMode::below(&found, request.platform_share),
        cable_names: robot.cables.iter().map(|cable| cable.name.clone()).collect(),
        support_names: robot.supports.iter().map(|support| support.name.clone()).collect(),
        participation,
        stations: stations.iter().map(|of| StationsRow::of(robot, of)).collect(),
        modes: rows,
        outline: Outline::of(at_rest),
        warnings,
    })
}

/// Writes the times of decay to a percentage of the amplitude into the rows of the modes.
fn set_decay_times(rows: &mut [ModeRow], percent: f64) {
    for row in rows {
        let rate = match row.eigenvalue_per_s {
            Some([re, _]) => -re,
            None => row.damping_ratio * row.frequency_hz * TAU,
        };
        let time = damped::decay_time(rate, 0.01 * percent);
        row.decay_time_s = time.is_finite().then_some(time);
    }
}

/// Writes residues and peaks of a response into the rows of the modes; names the response.
fn participate(
    rows: &mut [ModeRow],
    at_rest: &AtRest,
    dynamics: &Dynamics,
    found: &modes::Modes,
    SignalPair { input, output, signals }: &SignalPair,
) -> Result<Participation> {
    let [from, to] = at_rest.ports(dynamics, *signals)?;

    for (row, mode) in rows.iter_mut().zip(&found.modes) {
        // Signals of drives and motions of the frame are refused before.
        let (Some(from), Some(to)) = (from.in_mode(dynamics, mode), to.in_mode(dynamics, mode)) else { continue };

        let residue = from * to / mode.modal_mass;
        let omega = mode.frequency_hz * TAU;
        let by_time = output.quantity.factor(omega).norm();

        row.residue_per_kg = Some(residue + 0.0);
        let damping = 2.0 * row.damping_ratio * omega * omega;
        row.peak = (damping > 0.0).then(|| residue.abs() * by_time / damping);
    }

    Ok(Participation {
        input: input.name.clone(),
        output: output.name.clone(),
        peak_unit: response_unit(input, output),
    })
}

/// Input and output of the response to which the modes contribute, with their signals on the robot.
struct SignalPair {
    input: Input,
    output: Output,
    signals: [Signal; 2],
}

/// Refuses numbers out of range, and reads the signals of the response if the request has one.
fn checked(robot: &Robot, request: &request::ModesRequest) -> Result<Option<SignalPair>> {
    request.below_hz.map_or(Ok(()), |limit| request::check_positive("below_hz", limit))?;
    request::check_fraction("platform_share", request.platform_share)?;
    check_percent(request.decay_percent)?;
    match (&request.input, &request.output) {
        (Some(input), Some(output)) => {
            let (input, output) = (request::input(input)?, request::output(output)?);
            let signals = at_rest::signals(robot, &input, &output, &request.points)?;
            Ok(Some(SignalPair { input, output, signals }))
        }
        (None, None) => Ok(None),
        (Some(_), None) => bail!("⟪input⟫ is given without ⟪output⟫: a response needs both"),
        (None, Some(_)) => bail!("⟪output⟫ is given without ⟪input⟫: a response needs both"),
    }
}

/// Refuses a percentage of the amplitude to which nothing decays.
fn check_percent(percent: f64) -> Result<()> {
    if percent > 0.0 && percent < 100.0 {
        return Ok(());
    }
    bail!("⟪decay_percent⟫ is {percent}: give the percentage of the amplitude that is left, between 0 and 100, as 5")
}

/// Stations at equal steps along every cable.
fn stations(at_rest: &AtRest, dynamics: &Dynamics, count: usize) -> Result<Vec<CableStations>> {
    let AtRest { robot, equilibrium, .. } = at_rest;
    request::check_stations(count)?;
    let fractions: Vec<f64> = (0..count).map(|i| i as f64 / (count - 1) as f64).collect();
    let of = |i: usize| Ok(CableStations::new(robot, equilibrium, dynamics, i, &fractions, false)?);
    (0..robot.cables.len()).map(of).collect()
}

impl StationsRow {
    fn of(robot: &Robot, stations: &CableStations) -> Self {
        Self {
            cable: robot.cables[stations.cable].name.clone(),
            arc_length_m: stations.arc_lengths.clone(),
            position_m: stations.points_w.iter().map(|point| (*point).into()).collect(),
            axes: Axes::of(&stations.axes),
        }
    }
}

/// Names of the few cables, drives and supports with the most energy in a mode, with their fractions of the energy.
pub fn strongest(
    names: &[String],
    cables: &[f64],
    drives: &[f64],
    (supports, of_supports): (&[String], &[f64]),
) -> Vec<(String, f64)> {
    const SHOWN: usize = 3;
    // A smaller fraction is rounded to zero in the table.
    const MIN_SHARE: f64 = 0.05;
    let of_cables = names.iter().cloned().zip(cables.iter().copied());
    let of_drives = names.iter().map(|name| format!("drive of {name}")).zip(drives.iter().copied());
    let of_supports = supports.iter().map(|name| format!("support {name}")).zip(of_supports.iter().copied());
    let mut all: Vec<(String, f64)> = of_cables.chain(of_drives).chain(of_supports).collect();
    all.sort_by(|a, b| b.1.total_cmp(&a.1));
    all.retain(|(_, share)| *share >= MIN_SHARE);
    all.truncate(SHOWN);
    all
}

found!(Modes, "modes");

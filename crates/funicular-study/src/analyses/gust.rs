//! `gust`: motions and tensions in turbulent wind, with their expected peaks.

mod measured;

pub use measured::check as check_spectrum;

use super::fields::AXES;
use super::found;
use super::shared::Models;
use crate::at_rest::{self, AtRest, ModesBelow};
use crate::columns::{Columns, ResultTable, Tabled, column};
use crate::error::NoSolution;
use crate::request::{self, GustRequest, TurbulenceOptions, check_vector};
use crate::rows::rows;
use crate::signals::Output;
use crate::table::Column;
use anyhow::{Context, Result, bail};
use funicular::gust::{self, GustResonance, Gusts, PeakFactor, Spectra};
use funicular::math::Vec3;
use funicular::modes;
use funicular::response::{Quantity, Signal};
use funicular::robot::{PlatformMotion, Robot, Turbulence};

rows! {
    /// Results of `gust`.
    pub struct Gusty {
        pub robot: String = hidden;
        pub below_hz: f64;
        pub models: Models = spread;
        pub mean_wind_m_s: [f64; 3];
        pub turbulence: TurbulenceRow;
        pub duration_s: f64;
        /// Modes below the limit, with their damping in still air and by the mean wind.
        pub modes: Vec<AirDamping>;
        pub frequency_hz: Vec<f64>;
        pub outputs: Vec<GustRow>;
        pub warnings: Vec<String> = hidden;
    }
}

rows! {
    /// Turbulence of the results.
    pub struct TurbulenceRow {
        pub spectrum: &'static str;
        pub intensity: [f64; 3];
        /// Absent for measured spectra.
        pub length_scale_m: Option<[f64; 3]>;
        pub coherence_decay: [f64; 3];
        pub frozen: bool;
    }
}

rows! {
    /// Damping of a mode, of first order.
    pub struct AirDamping in tables() with {
        let percent = |ratio: fn(&Self) -> f64| {
            move |mode: &Self, style: crate::columns::Style| style.significant(100.0 * ratio(mode), 3)
        };
    } rows {
        /// Natural frequency.
        pub frequency_hz: f64 => one.decimals("f", 4);
        /// Damping ratio in still air.
        pub damping_ratio: f64 => one.shown("damping", "%", percent(|mode| mode.damping_ratio));
        /// Damping ratio by the mean wind.
        ///
        /// Added to the other.
        pub aerodynamic_damping_ratio: f64 => one
            .shown("by the wind", "%", percent(|mode| mode.aerodynamic_damping_ratio));
    }
}

rows! {
    /// One output in gusts.
    pub struct GustRow in tables() {
        /// Output.
        pub output: String => one.plain("output");
        /// Unit.
        pub unit: String => one.plain("unit");
        /// Mean.
        ///
        /// Mean tension; zero for a motion, which is about the equilibrium in the mean wind.
        pub mean: f64 => one.unit("").significant("mean", 4);
        pub rms: f64 => one.unit("").about("r.m.s. value about the mean").significant("r.m.s.", 4);
        /// R.m.s. value without the dynamics of the robot; absent without stiffness.
        pub quasi_static_rms: Option<f64>
            => one.unit("").about("r.m.s. value without dynamics").significant("slow gusts", 4)
            => column("main_mode_hz", "Hz", "mode nearest to which most of the variance is", |row: &Self| {
                row.main_mode.map(|(hz, _)| hz)
            })
            .significant("mostly near", 3)
            => column("main_share", "1", "part of the variance there", |row: &Self| row.main_mode.map(|(_, part)| part))
                .significant("part", 2)
                .with_unit("1");
        /// Rate of crossings.
        pub rate_hz: f64
            => one.significant("rate", 3)
            => column("smallest", "", "expected smallest value", Self::smallest).significant("smallest", 4)
            => column("largest", "", "expected largest value", Self::largest).significant("largest", 4);
        /// Expected largest excursion to one side within the duration; absent for fewer than ten expected crossings.
        pub peak: Option<f64>;
        /// Standard deviation of that excursion.
        pub peak_deviation: Option<f64>;
        /// Probability of a slack cable.
        ///
        /// Probability that the tension falls to zero within the duration, 0 below 1e-12; tensions alone.
        pub slack_probability: Option<f64> => one.significant("slack", 2).with_unit("1");
        /// Part of the variance nearest to each mode of `modes`, in their order.
        pub share_by_mode: Vec<f64>;
        /// Spectral density, unit squared per Hz.
        pub density: Vec<f64>;
        /// Spectral density without the dynamics of the robot; empty without stiffness.
        pub slow_density: Vec<f64>;
        /// Frequency and share of the mode with the largest share.
        pub main_mode: Option<(f64, f64)> = hidden;
    }
}

impl GustRow {
    /// Expected smallest value within the duration.
    pub fn smallest(&self) -> Option<f64> {
        Some(self.mean - self.peak?)
    }

    /// Expected largest value within the duration.
    pub fn largest(&self) -> Option<f64> {
        Some(self.mean + self.peak?)
    }

    /// True for a tension.
    pub fn is_tension(&self) -> bool {
        self.slack_probability.is_some()
    }
}

/// Computes the response to gusts.
///
/// # Errors
/// A request without turbulence or mean wind, a robot without such an equilibrium or without drag, a slack cable, or a
/// response that is not finite.
pub fn run(robot: Robot, request: &GustRequest) -> Result<Gusty> {
    checked(request)?;
    outputs(&robot, request)?;
    about(&at_rest::equilibrium(robot, &request.robot, &request.state, &request.tensions)?, request)
}

/// Computes the response to gusts of a robot at equilibrium. The state of the request is not used.
///
/// # Errors
/// The errors of [`run`].
pub fn about(at_rest: &AtRest, request: &GustRequest) -> Result<Gusty> {
    checked(request)?;
    let at_rest = &*at_rest.vibrating();
    let AtRest { equilibrium, .. } = at_rest;
    let turbulence = match &request.spectrum {
        Some(columns) => measured::turbulence(&at_rest.robot, columns, &request.gusts)?,
        None => turbulence(&at_rest.robot, &request.gusts)?,
    };
    let robot = &Robot { turbulence: Some(turbulence), ..at_rest.robot.clone() };
    let outputs = outputs(robot, request)?;
    refuse_slack(at_rest)?;

    let linearisation = at_rest::linearisation(&request.model, equilibrium.model);
    let limit = match request.below_hz {
        Some(given) => at_rest.modes_limit(Some(given), linearisation)?,
        None => at_rest.sway_limit(linearisation)?,
    };
    let ModesBelow { dynamics, modes: found, mut warnings } =
        at_rest.modes_below(linearisation, limit, modes::MAX_MODES)?;
    let signals: Vec<(Signal, Quantity)> = outputs.iter().map(|(output, signal)| (*signal, output.quantity)).collect();
    warnings.extend(measured::caveat(robot, limit));
    let gusts = Gusts::new(robot, equilibrium, &dynamics, &signals, limit)?;
    let natural: Vec<f64> = found.modes.iter().map(|mode| mode.frequency_hz).collect();
    let in_air = gust::aerodynamic_damping_ratio(robot, equilibrium, &dynamics, &found.modes)?;
    let resonances = GustResonance::of_modes(&found.modes, &in_air);
    let spectra = gusts.spectra(limit, &resonances).map_err(|error| no_solution(&error))?;

    Ok(Gusty {
        robot: robot.name.clone(),
        below_hz: limit,
        models: Models::of(at_rest, linearisation),
        mean_wind_m_s: robot.wind.velocity_w.into(),
        turbulence: TurbulenceRow::of(robot).context("the turbulence was set above")?,
        duration_s: request.duration_s,
        modes: found.modes.iter().zip(in_air).map(AirDamping::of).collect(),
        outputs: (outputs.iter().enumerate())
            .map(|(k, (output, signal))| GustRow {
                main_mode: main_mode(&natural, &spectra, k),
                ..row(at_rest, output, signal, &spectra, k, request.duration_s)
            })
            .collect(),
        frequency_hz: spectra.frequencies_hz,
        warnings,
    })
}

fn checked(request: &GustRequest) -> Result<()> {
    request::check_positive("duration_s", request.duration_s)?;
    check_vector("output_point_m", request.output_point_m)?;
    let TurbulenceOptions { intensity, length_scale_m, coherence_decay, .. } = request.gusts;
    let most = Turbulence::MAX_INTENSITY;
    if intensity.iter().flatten().any(|part| !(0.0..most).contains(part)) {
        bail!(
            "⟪intensity⟫ has to be three numbers from 0 to below {most}: deviations over the mean speed, no percentages"
        );
    }
    if length_scale_m.iter().flatten().any(|part| !(*part > 0.0 && part.is_finite())) {
        bail!("⟪length_scale_m⟫ has to be three positive lengths [m]");
    }
    if coherence_decay.iter().flatten().any(|part| !(*part >= 0.0 && part.is_finite())) {
        bail!("⟪coherence_decay⟫ has to be three numbers that are not negative");
    }
    Ok(())
}

/// Turbulence of the robot file with the changes of the request.
fn turbulence(robot: &Robot, options: &TurbulenceOptions) -> Result<Turbulence> {
    let of_file = robot.turbulence.as_ref();
    let Some(spectrum) = options.turbulence.or(of_file.map(|of| of.spectrum)) else {
        bail!(
            "the wind has no turbulence: give ⟪turbulence⟫, ⟪intensity⟫ and ⟪length_scale_m⟫, or these keys in [wind] \
             of the robot file"
        );
    };
    let (Some(intensity), Some(length_scale)) = (
        options.intensity.or(of_file.map(|of| of.intensity)),
        options.length_scale_m.or(of_file.map(|of| of.length_scale)),
    ) else {
        bail!(
            "a wind with ⟪turbulence⟫ needs ⟪intensity⟫ and ⟪length_scale_m⟫, each for the gusts along the mean wind, \
             lateral and up, as 0.15,0.12,0.075 and 85,28,6.9"
        );
    };
    let of_file_or = of_file.map_or(Turbulence::COHERENCE_DECAY, |of| of.coherence_decay);
    refuse_calm(robot)?;
    Ok(Turbulence {
        spectrum,
        measured: None,
        intensity,
        length_scale,
        coherence_decay: options.coherence_decay.unwrap_or(of_file_or),
        is_frozen: of_file.is_none_or(|of| of.is_frozen),
    })
}

fn refuse_calm(robot: &Robot) -> Result<()> {
    if robot.wind.velocity_w == Vec3::zeros() {
        bail!("there is no mean wind, so the gusts have no direction and no length in time: give ⟪wind_m_s⟫");
    }
    Ok(())
}

/// Outputs of a request with their signals: all motions that the platform has and all tensions if it names none.
fn outputs(robot: &Robot, request: &GustRequest) -> Result<Vec<(Output, Signal)>> {
    let mut names = request.output.clone();
    if names.is_empty() {
        names.extend(motions(robot));
        names.extend(robot.cables.iter().map(|cable| format!("tension:{}", cable.name)));
    }
    let point = request.output_point_m.map(Vec3::from);
    let is_named = !request.output.is_empty();
    let read = |name: &String| {
        let output = request::output(name)?;
        // The point belongs to the translations among the outputs that nobody named.
        let has_point = is_named || !(output.is_rotation() || output.unit() == "N");
        let signal = output.signal(robot, point.filter(|_| has_point))?;
        Ok((output, signal))
    };
    names.iter().map(read).collect()
}

/// Names of the motions of the platform along and about the axes of the world.
fn motions(robot: &Robot) -> Vec<String> {
    let turns = |axis: &str| format!("r{axis}");
    let all = AXES.iter().map(|axis| (*axis).to_owned()).chain(AXES.iter().map(|axis| turns(axis)));
    match robot.platform.motion {
        PlatformMotion::Rigid => all.collect(),
        PlatformMotion::PointMass => all.take(AXES.len()).collect(),
        PlatformMotion::Planar(_) => {
            let exists = |name: &String| Output::parse(name).is_ok_and(|output| output.signal(robot, None).is_ok());
            all.filter(exists).collect()
        }
    }
}

/// Probability below which a cable counts as never slack: no wind is known to be normally distributed so far out.
const MIN_PROBABILITY: f64 = 1e-12;

/// Probability without digits that mean nothing.
fn possible(probability: f64) -> f64 {
    if probability < MIN_PROBABILITY { 0.0 } else { probability }
}

/// Refuses a slack cable, which linear motion does not know.
fn refuse_slack(AtRest { robot, equilibrium, .. }: &AtRest) -> Result<()> {
    let slack = (0..robot.cables.len()).find(|i| equilibrium.cables[*i].is_slack());
    slack.map_or(Ok(()), |i| {
        let name = &robot.cables[i].name;
        Err(NoSolution(format!(
            "cable \"{name}\" is slack in the mean wind: it pulls in one direction only, and the linear response does \
             not know that; choose a state without slack cables, or less wind"
        ))
        .into())
    })
}

/// A response that is not finite, or whose integration does not end, is no fault of the request.
fn no_solution(error: &gust::GustError) -> anyhow::Error {
    NoSolution(error.to_string()).into()
}

/// Numbers of output `k`.
fn row(
    AtRest { equilibrium, .. }: &AtRest,
    output: &Output,
    signal: &Signal,
    spectra: &Spectra,
    k: usize,
    duration: f64,
) -> GustRow {
    let moments = spectra.moments[k];
    let (rms, rate_hz) = (moments.rms(), moments.rate());
    let factor = PeakFactor::new(rate_hz, duration);
    let mean = match signal {
        Signal::Drive { cable, .. } => Some(equilibrium.cables[*cable].force_on_platform_w.norm()),
        _ => None,
    };
    let by_time = match output.quantity {
        Quantity::Displacement => "",
        Quantity::Velocity => "/s",
        Quantity::Acceleration => "/s²",
    };
    GustRow {
        output: output.name.clone(),
        unit: format!("{}{by_time}", output.unit()),
        mean: mean.unwrap_or(0.0),
        rms,
        quasi_static_rms: Some(moments.quasi_static.sqrt()).filter(|rms| rms.is_finite()),
        rate_hz,
        peak: factor.map(|factor| factor.mean * rms),
        peak_deviation: factor.map(|factor| factor.deviation * rms),
        slack_probability: mean.map(|mean| possible(gust::slack_probability(mean, rms, rate_hz, duration))),
        share_by_mode: spectra.by_mode[k].iter().map(|part| share(*part, moments.variance)).collect(),
        density: spectra.densities.iter().map(|of| of.total[k]).collect(),
        slow_density: spectra.densities.iter().map(|of| of.quasi_static[k]).take_while(|of| of.is_finite()).collect(),
        main_mode: None,
    }
}

/// Part of a variance; zero for an output that does not move.
fn share(part: f64, variance: f64) -> f64 {
    if variance > 0.0 { part / variance } else { 0.0 }
}

/// Frequency of the mode nearest to which output `k` has most of its variance, and this part.
fn main_mode(natural_hz: &[f64], spectra: &Spectra, k: usize) -> Option<(f64, f64)> {
    let parts = natural_hz.iter().copied().zip(spectra.by_mode[k].iter().copied());
    let (hz, part) = parts.max_by(|a, b| a.1.total_cmp(&b.1))?;
    Some((hz, share(part, spectra.moments[k].variance)))
}

impl TurbulenceRow {
    fn of(robot: &Robot) -> Option<Self> {
        let Turbulence { spectrum, intensity, length_scale, coherence_decay, is_frozen, measured } =
            robot.turbulence.as_ref()?;
        Some(Self {
            spectrum: if measured.is_some() { "measured" } else { spectrum.word() },
            intensity: *intensity,
            length_scale_m: measured.is_none().then_some(*length_scale),
            coherence_decay: *coherence_decay,
            frozen: *is_frozen,
        })
    }
}

impl AirDamping {
    fn of((mode, aerodynamic_damping_ratio): (&modes::Mode, f64)) -> Self {
        Self { frequency_hz: mode.frequency_hz, damping_ratio: mode.damping_ratio, aerodynamic_damping_ratio }
    }
}

/// Density of one output at one frequency.
struct DensityAt<'a> {
    row: &'a GustRow,
    hz: f64,
    density: f64,
    slow: Option<f64>,
}

impl DensityAt<'_> {
    fn columns() -> Columns<Self> {
        Columns::new([
            column("output", "", "output", |at: &Self| at.row.output.clone()),
            column("frequency_hz", "Hz", "frequency", |at: &Self| at.hz),
            column("density", "", "spectral density, one-sided: unit of the output squared per Hz", |at: &Self| {
                at.density
            }),
            column("slow_density", "", "the same without the dynamics of the robot", |at: &Self| at.slow),
            column("unit", "", "unit of the output", |at: &Self| at.row.unit.clone()),
        ])
    }
}

impl Tabled for Gusty {
    fn tables() -> Vec<(&'static str, Vec<Column>)> {
        vec![("", DensityAt::columns().described())]
    }

    fn table(&self) -> ResultTable<'_> {
        let rows = self.outputs.iter().flat_map(|row| {
            self.frequency_hz.iter().zip(&row.density).enumerate().map(move |(i, (hz, density))| DensityAt {
                row,
                hz: *hz,
                density: *density,
                slow: row.slow_density.get(i).copied(),
            })
        });
        ResultTable::new(DensityAt::columns(), rows)
    }
}

found!(Gusty, "gust");

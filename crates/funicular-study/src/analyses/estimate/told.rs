//! Sentences about a run: fit of the readings, numbers that are not determined, and faults.

use super::log::EstimateLog;
use super::log_run::LogRun;
use super::rows::{CableErrors, SensorFit};
use crate::text::significant;
use funicular::estimation::{Consistency, EstimationSettings, MAX_CORRELATION, SensorGroup};

/// Part of the prior deviation from which on a number counts as not determined.
const AS_BEFORE: f64 = 0.9;

/// Part of outliers from which on a sensor is called faulty.
const MANY_OUTLIERS: f64 = 0.05;

/// Ratio of residuals to their noise that is worth a sentence.
const WORTH_TELLING: f64 = 1.2;

/// Sentences and tables about a run.
pub(super) struct Told {
    pub(super) fit: String,
    pub(super) not_determined: Vec<String>,
    pub(super) sensors: Vec<SensorFit>,
    pub(super) cable_errors: Vec<CableErrors>,
    pub(super) warnings: Vec<String>,
}

/// Sentences about a run that has ended.
pub(super) fn of_run(run: &mut LogRun, log: &EstimateLog, settings: &EstimationSettings, cables: &[String]) -> Told {
    let groups = SensorGroup::ALL.into_iter().filter(|group| log.has(*group));
    let sensors: Vec<SensorFit> =
        groups.filter_map(|group| sensor_fit(group, run.follower.estimator.consistency(group), cables)).collect();
    let state = run.follower.estimator.state();
    let cells = run.follower.estimator.consistency(SensorGroup::Tensions);
    let cable_errors = (cables.iter().zip(&state.cables).enumerate())
        .map(|(i, (cable, of))| {
            let ratio = cells.ratio(i);
            CableErrors {
                cable: cable.clone(),
                offset_m: of.offset.value,
                offset_std_m: of.offset.std,
                tension_bias_n: ratio.map(|_| of.tension_bias.value),
                tension_bias_std_n: ratio.map(|_| of.tension_bias.std),
                residual_ratio: ratio,
            }
        })
        .collect();

    let mut not_determined = Vec::new();
    let priors = &settings.priors;
    let mut tell = |what: &str, unit: &str, [found, prior]: [f64; 2], remedy: &str| {
        if prior > 0.0 && found > AS_BEFORE * prior {
            not_determined.push(format!(
                "{what} is not determined by these sensors: its deviation of {} {unit} is that of the prior; {remedy}",
                significant(found, 3)
            ));
        }
    };
    let cells_would = "tensions of some cables would tell it";
    tell("the payload", "kg", [state.payload.std, priors.payload[1]], cells_would);
    let offsets = state.cables[..cables.len()].iter().map(|cable| cable.offset.std).fold(0.0, f64::max);
    tell(
        "the offset of a length",
        "m",
        [offsets, priors.offset],
        "a tracker and motion through the workspace would tell it",
    );
    if log.has(SensorGroup::Tensions) && priors.force > 0.0 && priors.payload[1] > 0.0 {
        not_determined.push(
            "payload and vertical external force are one number at one time: the payload is the part that stays"
                .to_owned(),
        );
    }

    let warnings = warnings(run, log);
    Told { fit: fit(&sensors, run, log), not_determined, sensors, cable_errors, warnings }
}

/// Caveats of the tests.
fn warnings(run: &LogRun, log: &EstimateLog) -> Vec<String> {
    let [deviation, correlation] = run.follower.estimator.whiteness();
    let mut warnings = Vec::new();
    if log.has(SensorGroup::Tensions) && correlation > MAX_CORRELATION {
        warnings.push(format!(
            "successive residuals of the load cells are correlated by {}: the tests of cables rest, because they would \
             not keep their rate of false alarms; give the load cells the deviation of their noise, or rows further \
             apart",
            significant(correlation, 2)
        ));
    } else if deviation > WORTH_TELLING {
        warnings.push(format!(
            "the residuals of the load cells at quiet times are {} times what ⟪tension_std_n⟫ says: alarms are \
             rescaled",
            significant(deviation, 3)
        ));
    }
    if run.mistrusted > 0 {
        warnings.push(format!(
            "{} of {} rows have no deviations: the readings of the half second before do not fit their stated noise",
            run.mistrusted,
            log.count()
        ));
    }
    warnings
}

/// Fit of one kind of sensor.
fn sensor_fit(group: SensorGroup, of: &Consistency, cables: &[String]) -> Option<SensorFit> {
    let squares = of.per_freedom()?;
    let band = of.band();
    let axes = ["x", "y", "z"];
    let name = |k: usize| match group {
        SensorGroup::Tensions => format!("cable {}", cables.get(k).map_or("", String::as_str)),
        SensorGroup::Angles => "one cable".to_owned(),
        _ => format!("axis {}", axes.get(k).copied().unwrap_or("")),
    };
    let count = if group == SensorGroup::Tensions { cables.len() } else { axes.len() };
    let worst = (0..count).filter_map(|k| Some((k, of.ratio(k)?))).max_by(|a, b| a.1.total_cmp(&b.1));
    let mut text = if squares > band[1] {
        match worst {
            Some((k, ratio)) if ratio > WORTH_TELLING => {
                format!("the residuals of {} are {} times what the noise allows", name(k), significant(ratio, 2))
            }
            _ => "the residuals are larger than the noise allows".to_owned(),
        }
    } else if squares < band[0] {
        "the residuals are smaller than stated: the noise is less, or the platform vibrated".to_owned()
    } else {
        "the residuals fit the stated noise".to_owned()
    };
    if of.gated_share() > MANY_OUTLIERS {
        text += "; so many outliers are no noise: the sensor is faulty";
    }
    Some(SensorFit { sensor: group.name(), readings: of.count, squares, band, outliers: of.gated, text })
}

/// Sentence on the fit of all sensors.
fn fit(sensors: &[SensorFit], run: &LogRun, log: &EstimateLog) -> String {
    if sensors.is_empty() {
        return "there is nothing but lengths: they and the load give the pose, and nothing tests it".to_owned();
    }
    if 2 * run.mistrusted > log.count() {
        return misfit(sensors, run, log);
    }
    let large: Vec<&str> = sensors.iter().filter(|of| of.squares > of.band[1]).map(|of| of.sensor).collect();
    if large.is_empty() {
        return "all readings fit their stated noise".to_owned();
    }
    format!("larger residuals than the stated noise allows: {}", large.join(", "))
}

/// Sentence on a log most of whose rows do not fit, with the sensor that fits least.
fn misfit(sensors: &[SensorFit], run: &LogRun, log: &EstimateLog) -> String {
    let worst = sensors.iter().max_by(|a, b| (a.squares / a.band[1]).total_cmp(&(b.squares / b.band[1])));
    let of_worst = worst.map_or_else(String::new, |of| {
        format!(", most of all those of the {} (mean square {} instead of 1)", of.sensor, significant(of.squares, 3))
    });
    format!(
        "the log does not fit this robot: in {} of {} rows the readings are far beyond their stated noise{of_worst}; \
         the numbers and alarms below mean little. Check the places of the sensors on the platform (tracked point, \
         inertial unit), their axes and units, and the robot file",
        run.mistrusted,
        log.count()
    )
}

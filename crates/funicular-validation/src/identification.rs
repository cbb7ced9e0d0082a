//! Values of robots that `identify` finds, compared with those that the measurements have or that others identified.

use super::reference::{IdentificationReference, MeasuredPose, MeasuredResponses, PlatformOfMakers, ReferenceTable};
use super::section::WRONG;
use super::{Bound, Case, Comparison, Declared, DifferenceKind, Level, NegativeControl, reference, slug, worst};
use anyhow::{Result, ensure};
use funicular::math::{Rotation, Vec3, rotation};
use funicular::statics::StaticModel;
use funicular_study::analyses::identify::{self, Identified};
use funicular_study::measurements::{MeasuredFrequency, MeasuredResponse};
use funicular_study::request::{Experiment, Pose, State};
use funicular_study::{Request, Silent};
use serde_json::json;

/// Deviations within which ten values lie: the largest of ten is beyond 3 once in 37 repetitions.
const DEVIATIONS: f64 = 3.0;

/// Difference of χ²/n from 1: three deviations √(2/n) for 1736 degrees of freedom are 0.102.
const CHI2: f64 = 0.102;

/// Distance of the centre of mass [m] from that of the makers, and relative difference of the moments of inertia: the
/// makers' own sets of records, with two, three and four cables, differ by up to 2.7 mm in height, and by 0.5 to 5 % in
/// xx.
const CENTER: f64 = 4e-3;
const INERTIA: f64 = 0.05;

/// Root mean square of the relative differences [%] that a separate search has left, and its printed digits.
const RMS_OF_SEARCH: f64 = 2.11;
const RMS_DIGITS: f64 = 0.005;

pub(super) const SECTION: Declared = Declared {
    id: "identification",
    title: "Identification",
    note: "Values that `identify` finds. First, ten values of the six-cable robot from responses of a separate \
           program with known noise, from a start that is wrong by up to 50 %: the differences are in deviations \
           of the result, and χ²/n is 1 if the deviations are right. Second, the platform of Bologna's prototype \
           from the 208 frequencies of the section above, with its mass held, because frequencies do not change if \
           mass and inertia have a common factor. The makers identified the same platform from records over time, \
           by another method. The fit lowers the root mean square of the differences to 2.11 % and no further: the \
           oscillations were large, and each peak was looked for within 7 % of the makers' model. Poses without a \
           published measurement are not part of it.",
    rows: || rows(&reference::identification()?, &reference::measured()?.grab),
    controls: &[NegativeControl {
        id: "frequencies",
        wrong: "frequencies of the responses 1 % too large",
        proves: "the frequencies at which responses are compared",
        rows: || {
            let mut given = reference::identification()?.responses;
            (given.from_hz, given.step_hz) = (WRONG * given.from_hz, WRONG * given.step_hz);
            from_responses(&given)
        },
    }],
};

fn rows(reference: &IdentificationReference, poses: &ReferenceTable<MeasuredPose>) -> Result<Vec<Comparison>> {
    let mut rows = from_responses(&reference.responses)?;
    rows.extend(from_frequencies(&reference.makers, poses)?);
    Ok(rows)
}

/// Search without any prior, from the values of the request.
fn identified(request: &serde_json::Value, experiments: Vec<Experiment>) -> Result<Identified> {
    let Request::Identify(mut request) = Request::from_json(&request.to_string())? else {
        anyhow::bail!("identify was requested")
    };
    request.experiments = experiments;
    identify::run(&request, &mut Silent)
}

/// Values from the responses of a separate program.
fn from_responses(given: &MeasuredResponses) -> Result<Vec<Comparison>> {
    let set: Vec<_> = given.values.iter().map(|value| json!({"path": value.path, "value": value.start})).collect();
    let fit: Vec<_> = given.values.iter().map(|value| json!({"path": value.path})).collect();
    let responses = (given.outputs.iter())
        .map(|output| MeasuredResponse {
            input: given.input.clone(),
            output: output.output.clone(),
            input_point_m: Some(given.input_point_m),
            output_point_m: Some(given.output_point_m),
            frequency_hz: (0..output.real.len()).map(|i| given.from_hz + given.step_hz * i as f64).collect(),
            real: output.real.clone(),
            imag: output.imag.clone(),
            ..MeasuredResponse::default()
        })
        .collect();
    let found = identified(
        &json!({
            "command": "identify", "robot": {"text": funicular_robots::YUAN2014_4MM, "set": set}, "fit": fit,
            "starts": 1, "experiments": [{"frequencies": [{"frequency_hz": 1.0}]}],
        }),
        vec![Experiment { responses, ..Experiment::default() }],
    )?;
    ensure!(found.values.len() == given.values.len(), "a value is missing");

    let case = Case::new(Level::Program, &given.source, "responses", "six cables, three responses");
    let truth: Vec<f64> = given.values.iter().map(|value| value.truth).collect();
    let ours: Vec<f64> = found.values.iter().map(|row| row.value).collect();
    let apart =
        found.values.iter().zip(&truth).map(|(row, truth)| (row.value - truth).abs() / row.deviation.unwrap_or(0.0));
    Ok(vec![
        case.of("values", "ten values of the robot file [SI]; difference in deviations").row(
            (&truth, &ours),
            (worst(apart), DifferenceKind::Absolute),
            DEVIATIONS,
            Bound::Digits("noise of 2 %"),
        ),
        case.of("chi2", "χ² per degree of freedom").absolute(
            &[1.0],
            &[found.chi2_per_degree],
            CHI2,
            Bound::Digits("noise of 2 %"),
        ),
    ])
}

/// Platform from natural frequencies of rigid cables at many poses.
fn from_frequencies(
    makers: &ReferenceTable<PlatformOfMakers>,
    poses: &ReferenceTable<MeasuredPose>,
) -> Result<Vec<Comparison>> {
    let experiments = poses.rows.iter().map(experiment).collect();
    let found = identified(
        &json!({
            "command": "identify", "robot": {"text": funicular_robots::GRAB_4_CABLES}, "starts": 1,
            "rigid_cables": true,
            "fit": [{"path": "platform.center_of_mass_m"}, {"path": "platform.inertia_kg_m2"}],
            "experiments": [{"frequencies": [{"frequency_hz": 1.0}]}],
        }),
        experiments,
    )?;
    let value = |path: &str| found.values.iter().find(|row| row.path == path).map_or(f64::NAN, |row| row.value);
    let com = ["x", "y", "z"].map(|axis| value(&format!("platform.center_of_mass_m.{axis}")));
    let [x2, y2, z2] = com.map(|x| x * x);
    let moments = ["xx", "yy", "zz"].map(|entry| value(&format!("platform.inertia_kg_m2.{entry}")));
    let at_origin = [moments[0] + y2 + z2, moments[1] + x2 + z2, moments[2] + x2 + y2];

    let mut rows = Vec::new();
    for theirs in &makers.rows {
        let case = Case::new(
            Level::Measured,
            &makers.source,
            &format!("grab/{}", slug(&theirs.set)),
            &format!("GRAB prototype, {}", theirs.set),
        );
        let other = Bound::Model("another method, other records");
        rows.push(case.of("centre-of-mass", "centre of mass [m]").absolute(&theirs.com_m, &com, CENTER, other));
        let quantity = "moments of inertia xx, yy, zz about the origin per mass [m²]";
        rows.push(case.of("inertia", quantity).relative(&theirs.inertia_at_origin_kg_m2, &at_origin, INERTIA, other));
    }
    let case =
        Case::new(Level::Program, &poses.source, "grab/scipy", &format!("GRAB prototype, {} poses", poses.rows.len()));
    let ours = 100.0 * found.frequency_rms.unwrap_or(f64::NAN);
    let quantity = "root mean square of the differences after the fit [%], against a trust-region search of SciPy";
    rows.push(case.of("rms", quantity).absolute(
        &[RMS_OF_SEARCH],
        &[ours],
        RMS_DIGITS,
        Bound::Digits("printed digits"),
    ));
    Ok(rows)
}

/// Measured frequencies at a pose, with the numbers of their modes.
fn experiment(row: &MeasuredPose) -> Experiment {
    let turned = |axis: Vec3, angle: f64| Rotation::from_scaled_axis(axis * angle);
    let [a, b, c] = row.angles_xyz_rad;
    let rot_wp = turned(Vec3::x(), a) * turned(Vec3::y(), b) * turned(Vec3::z(), c);
    let cables: &[&str] = match row.cables {
        2 => &["1", "3"],
        3 => &["1", "2", "3"],
        _ => &["1", "2", "3", "4"],
    };
    let numbered = row.measured_hz.iter().enumerate().filter_map(|(i, hz)| Some((i, (*hz)?)));
    Experiment {
        name: format!("{} cables, experiment {}", row.cables, row.experiment),
        cables: Some(cables.iter().map(|name| (*name).to_owned()).collect()),
        state: State {
            pose: Some(Pose::Quaternion(row.position_m, rotation::quaternion_wxyz(&rot_wp))),
            static_model: StaticModel::Ideal,
            ..State::default()
        },
        frequencies: numbered
            .map(|(i, frequency_hz)| MeasuredFrequency {
                frequency_hz,
                label: Some((i + 1).to_string()),
                ..MeasuredFrequency::default()
            })
            .collect(),
        ..Experiment::default()
    }
}

//! Linear deviations of results, compared with those of sampled robots.

use super::{Bound, Case, Comparison, Declared, DifferenceKind, Level, NegativeControl, slug};
use anyhow::{Context, Result, anyhow, bail};
use funicular_study::analyses::uncertainty::{Uncertainties, UncertaintyStudy};
use funicular_study::request::Request;
use funicular_study::table::Values;
use serde_json::json;

/// Number of sampled robots.
const SAMPLES: usize = 2000;

/// Maximum relative difference of a deviation: 2000 robots have it to 1.6 %, and the results are linear to a few per
/// cent.
const DEVIATION: f64 = 0.06;

/// Maximum difference of the share of robots in an interval: the share of 2000 robots has a deviation of 0.5 %.
const COVERAGE: f64 = 0.02;

/// Robots, with what deviates.
const ROBOTS: [Deviating; 3] = [
    Deviating {
        name: "yuan2014-4mm",
        text: funicular_robots::YUAN2014_4MM,
        path: "cables.*.anchor_m",
        tolerance: 0.002,
    },
    Deviating {
        name: "cogiro",
        text: funicular_robots::COGIRO,
        path: "cables.*.unstrained_length_m",
        tolerance: 0.0005,
    },
    Deviating { name: "ipanema2", text: funicular_robots::IPANEMA2, path: "cables.*.anchor_m", tolerance: 0.0005 },
];

/// Robot, with what deviates.
struct Deviating {
    name: &'static str,
    text: &'static str,
    path: &'static str,
    tolerance: f64,
}

/// Source of the reference numbers.
const SOURCE: &str =
    "Latin hypercube of 2000 robots of this program, each with its own equilibrium; no derivative is used.";

pub(super) const SECTION: Declared = Declared {
    id: "uncertainty",
    title: "Uncertainty",
    note: "Deviations of poses, tensions and minimum stiffness by the gradients, beside those of sampled robots: \
           the mass of the platform deviates by 1 % (normal), its centre by 1 mm (normal), and anchors or lengths \
           are anywhere within their tolerance. Of each kind the result with the largest difference is shown. The \
           share is that of the sampled robots whose result is in the linear interval of 95 %.",
    rows: || rows(&ROBOTS, 1.0),
    controls: &[NegativeControl {
        id: "tolerance",
        wrong: "deviation of the anchors 10 % too large in the linear results; 2000 samples know a deviation to 1.6 %",
        proves: "the size of deviations",
        rows: || rows(&ROBOTS[..1], 1.1),
    }],
};

/// Comparisons of robots; the deviations of the linear results are multiplied by a factor.
fn rows(robots: &[Deviating], factor: f64) -> Result<Vec<Comparison>> {
    let mut rows = Vec::new();
    for of in robots {
        compare(of, factor, &mut rows)?;
    }
    Ok(rows)
}

/// Compares one robot.
fn compare(of: &Deviating, factor: f64, rows: &mut Vec<Comparison>) -> Result<()> {
    let Deviating { name, text, path, tolerance } = *of;
    let request = |method: &str, factor: f64| {
        json!({
            "command": "uncertainty", "robot": {"name": name, "text": text},
            "of": ["pose", "tensions", "stiffness-min"],
            "deviations": ["platform.mass_kg=1%", "platform.center_of_mass_m=0.001"],
            "tolerances": [format!("{path}={}", tolerance * factor)],
            "method": method, "samples": SAMPLES,
        })
    };
    let linear = linear(&request("automatic", factor).to_string())?;
    let columns = sampled(&request("sampled", 1.0).to_string())?;

    let case = Case::new(Level::Program, SOURCE, name, &format!("{name}, {path}={tolerance}"));
    for (kind, unit) in [("position", "m"), ("rotation", "rad"), ("tension", "N"), ("minimum stiffness", "N/m")] {
        let (mut farthest, mut coverage) = ((0.0, 0.0, 0.0), (0.0, 0.0));
        let results = linear.poses.first().context("no pose")?.results.iter();
        for (result, values) in results.zip(&columns).filter(|(result, _)| result.unit == unit) {
            if result.method != "linear" {
                bail!("{name}, {}: {}", result.name, result.sampling_reason.as_deref().unwrap_or_default());
            }
            let found = deviation_of(values).context("no sample")?;
            let deviation = result.deviation.context("no deviation")?;
            let difference = (deviation / found - 1.0).abs();
            if difference >= farthest.0 {
                farthest = (difference, found, deviation);
            }
            let [from, to] = result.interval_95.context("no interval")?;
            let inside =
                values.iter().filter(|value| (from..=to).contains(*value)).count() as f64 / values.len() as f64;
            if (inside - 0.95_f64).abs() >= coverage.0 {
                coverage = ((inside - 0.95_f64).abs(), inside);
            }
        }
        let bound = Bound::Model("linear in the deviations");
        let (difference, theirs, ours) = farthest;
        let of_kind = format!("standard deviation, {kind} [{unit}]");
        let id = slug(kind);
        let quantity = case.of(&id, &of_kind);
        rows.push(quantity.row((&[theirs], &[ours]), (difference, DifferenceKind::Relative), DEVIATION, bound));
        let share = format!("share of robots in the interval of 95 %, {kind}");
        let id = format!("{id}-share");
        rows.push(case.of(&id, &share).absolute(&[0.95], &[coverage.1], COVERAGE, Bound::Digits("number of robots")));
    }
    Ok(())
}

/// Standard deviation of a sample, summed in ascending order; `None` for fewer than two values.
fn deviation_of(values: &[f64]) -> Option<f64> {
    let mut sorted: Vec<f64> = values.iter().copied().filter(|value| value.is_finite()).collect();
    sorted.sort_by(f64::total_cmp);
    let count = sorted.len() as f64;
    let mean = sorted.iter().sum::<f64>() / count;
    let squares: f64 = sorted.iter().map(|value| (value - mean).powi(2)).sum();
    (sorted.len() > 1).then(|| (squares / (count - 1.0)).sqrt())
}

fn study(request: &str) -> Result<UncertaintyStudy> {
    let Request::Uncertainty(request) = Request::from_json(request).map_err(|error| anyhow!("{error}"))? else {
        bail!("uncertainty was requested");
    };
    UncertaintyStudy::new(&request)
}

/// Linear deviations.
fn linear(request: &str) -> Result<Uncertainties> {
    let study = study(request)?;
    let plan = study.plan(vec![study.linear(0)])?;
    let table = plan.table();
    Ok(plan.finish(&table))
}

/// Values of each result of the sampled robots.
fn sampled(request: &str) -> Result<Vec<Vec<f64>>> {
    let study = study(request)?;
    let plan = study.plan(vec![study.linear(0)])?;
    let mut columns: Vec<Vec<f64>> = Vec::new();
    // The sample comes first; the robots after it are for shares and corners.
    for chunk in (0..SAMPLES.div_ceil(plan.chunk_rows())).filter_map(|chunk| plan.evaluate(chunk, &|| false)) {
        let [_, _, _, Values::Text(reasons), results @ ..] = &chunk.columns[..] else { bail!("no rows of robots") };
        if let Some(reason) = reasons.iter().flatten().next() {
            bail!("a sampled robot has no results: {reason}");
        }
        columns.resize_with(results.len(), Vec::new);
        for (column, values) in columns.iter_mut().zip(results) {
            if let Values::Real(values) = values {
                column.extend(values.iter().flatten());
            }
        }
    }
    for column in &mut columns {
        column.truncate(SAMPLES);
    }
    Ok(columns)
}

//! `pose-error`: how far simpler static models are off, over platform mass.

use crate::args::PoseErrorArgs;
use crate::errors::NoSolution;
use crate::output::Results;
use crate::progress::Progress;
use crate::table::{self, Table, decimals, decimals_or_none, short, significant};
use anyhow::{Result, bail};
use funicular::pose_error::{self, PoseDifference, PoseErrorPoint, Threshold};
use funicular::robot::{Robot, State};
use serde::Serialize;

#[derive(Serialize)]
pub(crate) struct PoseErrors {
    #[serde(skip)]
    robot: String,
    points: Vec<PointRow>,
    #[serde(skip_serializing_if = "Option::is_none")]
    threshold: Option<ThresholdRow>,
    #[serde(skip)]
    warnings: Vec<String>,
}

/// Differences are absent where one of the two models has no equilibrium.
#[derive(Serialize)]
struct PointRow {
    mass_kg: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    spring_from_ideal: Option<Difference>,
    #[serde(skip_serializing_if = "Option::is_none")]
    catenary_from_ideal: Option<Difference>,
    #[serde(skip_serializing_if = "Option::is_none")]
    spring_from_catenary: Option<Difference>,
}

#[derive(Serialize, Clone, Copy)]
struct Difference {
    translation_m: [f64; 3],
    distance_m: f64,
    angle_deg: f64,
}

impl From<PoseDifference> for Difference {
    fn from(difference: PoseDifference) -> Self {
        Self {
            translation_m: difference.translation,
            distance_m: difference.distance,
            angle_deg: difference.angle.to_degrees(),
        }
    }
}

#[derive(Serialize)]
struct ThresholdRow {
    tolerance_mm: f64,
    /// `everywhere`, `from` or `nowhere`.
    within: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    from_mass_kg: Option<f64>,
}

pub(crate) fn run(robot: &Robot, args: &PoseErrorArgs) -> Result<PoseErrors> {
    let lengths = match (&args.lengths_m, &robot.state) {
        (Some(lengths), _) => &lengths.0,
        (None, State::Lengths(lengths)) => lengths,
        (None, State::Pose(_) | State::Unknown) => bail!(
            "the robot file gives no unstrained lengths, which fix the comparison: give --lengths-m (`funicular statics` \
             prints the lengths of a pose)"
        ),
    };
    let range = args.mass_kg;
    let masses: Vec<f64> = (0..range.count)
        .map(|i| {
            if i + 1 == range.count {
                range.to
            } else {
                range.from + (range.to - range.from) * i as f64 / (range.count - 1) as f64
            }
        })
        .collect();
    if masses.windows(2).any(|pair| pair[1] <= pair[0]) {
        bail!(
            "--mass-kg: {} masses are more than the numbers between {} and {} can tell apart; ask for fewer",
            range.count,
            range.from,
            range.to
        );
    }
    // Lengths that do not fit the robot are wrong at every mass: said once, as bad input.
    let first = PoseErrorPoint::at_mass(robot, lengths, masses[0]);
    if let Err(
        error @ (funicular::statics::StaticsError::LengthCount { .. }
        | funicular::statics::StaticsError::CableCount { .. }),
    ) = &first.catenary
    {
        return Err(error.clone().into());
    }
    let mut progress = Progress::new(masses.len(), "masses");
    let points: Vec<PoseErrorPoint> = masses
        .into_iter()
        .map(|mass| {
            let point = PoseErrorPoint::at_mass(robot, lengths, mass);
            progress.advance(1);
            point
        })
        .collect();
    if points.iter().all(|point| point.catenary.is_err() || (point.spring.is_err() && point.ideal.is_err())) {
        let reason = points[0].catenary.as_ref().err().or(points[0].spring.as_ref().err());
        let reason = reason.map_or_else(String::new, |error| format!("; at {} kg: {error}", points[0].mass));
        return Err(NoSolution(format!("at no mass of the range do two models have an equilibrium{reason}")).into());
    }
    let threshold = args.tolerance_mm.map(|tolerance_mm| {
        let found = pose_error::threshold(robot, lengths, &points, 1e-3 * tolerance_mm);
        let (within, from_mass_kg) = match found {
            Threshold::Everywhere => ("everywhere", None),
            Threshold::From(mass) => ("from", Some(mass)),
            Threshold::Nowhere => ("nowhere", None),
        };
        ThresholdRow { tolerance_mm, within, from_mass_kg }
    });
    Ok(PoseErrors {
        robot: robot.name.clone(),
        warnings: warnings(&points),
        points: points
            .iter()
            .map(|point| PointRow {
                mass_kg: point.mass,
                spring_from_ideal: point.spring_from_ideal().map(Difference::from),
                catenary_from_ideal: point.catenary_from_ideal().map(Difference::from),
                spring_from_catenary: point.spring_from_catenary().map(Difference::from),
            })
            .collect(),
        threshold,
    })
}

/// Each model that has no equilibrium somewhere, with the first reason.
fn warnings(points: &[PoseErrorPoint]) -> Vec<String> {
    let mut warnings = Vec::new();
    for (name, of) in [
        ("ideal", (|p| p.ideal.as_ref().err()) as fn(&PoseErrorPoint) -> Option<&funicular::statics::StaticsError>),
        ("spring", |p| p.spring.as_ref().err()),
        ("catenary", |p| p.catenary.as_ref().err()),
    ] {
        let mut failed = points.iter().filter_map(|point| of(point).map(|error| (point.mass, error)));
        if let Some((mass, error)) = failed.next() {
            let count = failed.count() + 1;
            warnings.push(format!(
                "{name} cables have no equilibrium at {count} of {}, first at {mass} kg: {error}",
                table::counted(points.len(), "mass").replace("masss", "masses"),
            ));
        }
    }
    warnings
}

impl PoseErrors {
    fn threshold_line(&self) -> String {
        match &self.threshold {
            None => "The mass from which on springs are good enough: --tolerance-mm.".to_owned(),
            Some(ThresholdRow { tolerance_mm, from_mass_kg: Some(mass), .. }) => format!(
                "From {} kg on the spring pose is within {tolerance_mm} mm of the catenary pose; below it, sag matters.",
                significant(*mass, 5)
            ),
            Some(ThresholdRow { tolerance_mm, within: "everywhere", .. }) => {
                format!("The spring pose is within {tolerance_mm} mm of the catenary pose at every mass of the range.")
            }
            Some(ThresholdRow { tolerance_mm, .. }) => {
                format!("The spring pose is not within {tolerance_mm} mm of the catenary pose at the end of the range.")
            }
        }
    }
}

impl Results for PoseErrors {
    const COMMAND: &'static str = "pose-error";

    fn robot(&self) -> &str {
        &self.robot
    }

    fn warnings(&self) -> &[String] {
        &self.warnings
    }

    fn text(&self) -> String {
        let mut table = Table::new(&[
            "mass [kg]",
            "spring-ideal [mm]",
            "[°]",
            "catenary-ideal [mm]",
            "[°]",
            "spring-catenary [mm]",
            "[°]",
        ]);
        for point in &self.points {
            let mut row = vec![short(point.mass_kg, 6)];
            for difference in [point.spring_from_ideal, point.catenary_from_ideal, point.spring_from_catenary] {
                row.push(decimals_or_none(difference.map(|d| 1e3 * d.distance_m), 3));
                row.push(difference.map_or_else(|| table::NONE.to_owned(), |d| decimals(d.angle_deg, 4)));
            }
            table.row(row);
        }
        format!(
            "{}: distance and angle between the poses of static models\n\n{table}\n{}\n",
            self.robot,
            self.threshold_line()
        )
    }

    fn csv(&self, out: &mut csv::Writer<Vec<u8>>) -> csv::Result<()> {
        let columns = ["spring_from_ideal", "catenary_from_ideal", "spring_from_catenary"]
            .into_iter()
            .flat_map(|pair| ["x_m", "y_m", "z_m", "distance_m", "angle_deg"].map(|part| format!("{pair}_{part}")));
        out.write_record(std::iter::once("mass_kg".to_owned()).chain(columns))?;
        for point in &self.points {
            let pairs = [point.spring_from_ideal, point.catenary_from_ideal, point.spring_from_catenary];
            let cells = pairs.map(|pair| {
                let part = |of: fn(&Difference) -> f64| pair.as_ref().map(of);
                [
                    part(|d| d.translation_m[0]),
                    part(|d| d.translation_m[1]),
                    part(|d| d.translation_m[2]),
                    part(|d| d.distance_m),
                    part(|d| d.angle_deg),
                ]
            });
            out.serialize((point.mass_kg, cells))?;
        }
        Ok(())
    }
}

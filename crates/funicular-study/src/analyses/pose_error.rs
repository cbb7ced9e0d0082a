//! `pose-error`: pose errors of simpler static models over platform mass.

use super::fields::AXES;
use super::found;
use super::shared::PoseRow;
use crate::Watch;
use crate::at_rest;
use crate::columns::{Columns, ResultTable, Tabled, column, parts};
use crate::error::{Cancelled, NoSolution, with_warnings};
use crate::request::{self, PoseErrorRequest};
use crate::rows::rows;
use crate::table::Column;
use crate::text::counted;
use crate::values::positive;
use anyhow::{Result, anyhow, bail};
use funicular::pose_error::{self, PoseErrorPoint, Threshold};
use funicular::robot::{Robot, State};
use funicular::statics::{self, Solution, StaticModel, StaticsError, TensionRule};

pub use super::shared::PoseDifferenceRow;

rows! {
    /// Results of `pose-error`: distances between the poses of static models over platform mass.
    pub struct PoseErrors {
        pub robot: String = hidden;
        /// Unstrained lengths, the same at every mass.
        pub unstrained_length_m: Vec<f64>;
        /// Origin of the unstrained lengths; absent if they are given.
        pub held: Option<HeldPoseRow>;
        pub points: Vec<PoseErrorRow>;
        pub threshold: Option<ThresholdRow>;
        pub warnings: Vec<String> = hidden;
    }
}

rows! {
    /// Pose whose unstrained lengths are held, with the mass and the rule for which they hold it.
    pub struct HeldPoseRow {
        pub pose: PoseRow;
        pub mass_kg: f64;
        pub tension_rule: Option<&'static str>;
    }
}

rows! {
    /// Pose differences at one mass. A difference is absent if one of the two models has no equilibrium.
    pub struct PoseErrorRow {
        pub mass_kg: f64;
        pub spring_from_ideal: Option<PoseDifferenceRow>;
        pub catenary_from_ideal: Option<PoseDifferenceRow>;
        pub spring_from_catenary: Option<PoseDifferenceRow>;
    }
}

rows! {
    /// Minimum mass at which springs are good enough.
    pub struct ThresholdRow {
        pub tolerance_mm: f64;
        /// `everywhere`, `from` or `nowhere`.
        pub within: &'static str;
        pub from_mass_kg: Option<f64>;
    }
}

/// Computes the distances between the poses of ideal, spring and catenary cables over platform mass.
///
/// # Errors
/// A range that does not ascend, a robot without lengths, no mass at which two models have an equilibrium, or work that
/// was stopped.
pub fn run(robot: &Robot, request: &request::PoseErrorRequest, watch: &mut dyn Watch) -> Result<PoseErrors> {
    let masses = masses(request)?;
    let (lengths, held) = lengths(robot, request)?;
    let lengths = &lengths[..];

    // Lengths that do not fit the robot are wrong at every mass. They are reported once, as bad input.
    let first = PoseErrorPoint::at_mass(robot, lengths, masses[0]);
    if let Err(error @ (StaticsError::LengthCount { .. } | StaticsError::CableCount { .. })) = &first.catenary {
        return Err(error.clone().into());
    }
    let mut points = Vec::with_capacity(masses.len());
    for (i, &mass) in masses.iter().enumerate() {
        points.push(PoseErrorPoint::at_mass(robot, lengths, mass));
        watch.progress(i + 1, masses.len(), "masses");
        if watch.is_cancelled() {
            return Err(Cancelled.into());
        }
    }

    if points.iter().all(|point| point.catenary.is_err() || (point.spring.is_err() && point.ideal.is_err())) {
        let reason = points[0].catenary.as_ref().err().or(points[0].spring.as_ref().err());
        let reason = reason.map_or_else(String::new, |error| format!("; at {} kg: {error}", points[0].mass));
        return Err(NoSolution(format!("at no mass of the range do two models have an equilibrium{reason}")).into());
    }
    let threshold = request.tolerance_mm.map(|tolerance_mm| {
        let found = pose_error::threshold(robot, lengths, &points, 1e-3 * tolerance_mm);
        let (within, from_mass_kg) = match found {
            Threshold::Everywhere => ("everywhere", None),
            Threshold::From(mass) => ("from", Some(mass)),
            Threshold::Nowhere => ("nowhere", None),
        };
        ThresholdRow { tolerance_mm, within, from_mass_kg }
    });
    let implausible = funicular::warnings::of_robot(robot).into_iter().map(|warning| warning.to_string());
    Ok(PoseErrors {
        robot: robot.name.clone(),
        warnings: implausible.chain(warnings(&points)).collect(),
        unstrained_length_m: lengths.to_vec(),
        held,
        points: points
            .iter()
            .map(|point| PoseErrorRow {
                mass_kg: point.mass,
                spring_from_ideal: point.spring_from_ideal().map(PoseDifferenceRow::from),
                catenary_from_ideal: point.catenary_from_ideal().map(PoseDifferenceRow::from),
                spring_from_catenary: point.spring_from_catenary().map(PoseDifferenceRow::from),
            })
            .collect(),
        threshold,
    })
}

/// Unstrained lengths of all masses: given ones, or those with which the robot of the file rests at a pose; then also
/// that pose and the mass there.
fn lengths(robot: &Robot, request: &request::PoseErrorRequest) -> Result<(Vec<f64>, Option<HeldPoseRow>)> {
    let PoseErrorRequest { lengths_m, pose, tensions, .. } = request;
    let given = match (lengths_m, &robot.state) {
        (Some(_), _) if pose.is_some() => {
            bail!("give ⟪pose⟫ or ⟪lengths_m⟫, not both: each follows from the other")
        }
        (Some(lengths), _) => Some(lengths),
        (None, State::Lengths(lengths)) if pose.is_none() => Some(lengths),
        _ => None,
    };
    let rule = at_rest::rule(tensions)?;
    if let Some(lengths) = given {
        if rule.is_some() {
            return Err(StaticsError::RuleOfLengths.into());
        }
        return Ok((lengths.clone(), None));
    }

    let state = request::State { pose: *pose, ..request::State::default() };
    let holder = at_rest::holder(&request.robot, &state, tensions)?;
    if holder.state == State::Unknown {
        bail!("the robot file gives neither unstrained lengths nor a pose: give ⟪lengths_m⟫ or ⟪pose⟫");
    }
    let Solution { equilibrium, rule, .. } =
        statics::solve(&holder, StaticModel::Catenary, rule).map_err(|error| with_warnings(error, &holder))?;
    let row = HeldPoseRow {
        pose: PoseRow::of(&equilibrium.pose),
        mass_kg: holder.platform.mass,
        tension_rule: rule.as_ref().map(TensionRule::name),
    };
    Ok((equilibrium.cables.iter().map(|cable| cable.unstrained_length).collect(), Some(row)))
}

/// Maximum number of masses of a range.
pub(crate) const MAX_MASSES: usize = 100_000;

/// Masses of the request [kg], ascending. The first and the last are exact.
fn masses(request: &request::PoseErrorRequest) -> Result<Vec<f64>> {
    let (from, to, count) = request.mass_kg;
    for mass in [from, to] {
        positive(mass).map_err(|reason| anyhow!("⟪mass_kg⟫: {reason}"))?;
    }
    if to <= from {
        bail!("⟪mass_kg⟫: the range ends at {to}, it must end above its start {from}");
    }
    if !(2..=MAX_MASSES).contains(&count) {
        bail!("⟪mass_kg⟫: {count} masses are not possible: give a whole number from 2 to {MAX_MASSES}");
    }
    let at = |i: usize| if i + 1 == count { to } else { from + (to - from) * i as f64 / (count - 1) as f64 };
    let masses: Vec<f64> = (0..count).map(at).collect();
    if masses.windows(2).any(|pair| pair[1] <= pair[0]) {
        bail!(
            "⟪mass_kg⟫: between {from} and {to} there are fewer than {count} different numbers: request fewer masses"
        );
    }
    Ok(masses)
}

/// Warnings about models without an equilibrium at some masses, with the first reason.
fn warnings(points: &[PoseErrorPoint]) -> Vec<String> {
    let mut warnings = Vec::new();
    for (name, of) in [
        ("ideal", (|p| p.ideal.as_ref().err()) as fn(&PoseErrorPoint) -> Option<&StaticsError>),
        ("spring", |p| p.spring.as_ref().err()),
        ("catenary", |p| p.catenary.as_ref().err()),
    ] {
        let mut failed = points.iter().filter_map(|point| of(point).map(|error| (point.mass, error)));
        if let Some((mass, error)) = failed.next() {
            let count = failed.count() + 1;
            warnings.push(format!(
                "{name} cables have no equilibrium at {count} of {}, first at {mass} kg: {error}",
                counted(points.len(), "mass"),
            ));
        }
    }
    warnings
}

impl PoseErrorRow {
    fn columns() -> Columns<Self> {
        type Pair = fn(&PoseErrorRow) -> Option<&PoseDifferenceRow>;
        let pairs: [(&str, &str, Pair); 3] = [
            ("spring_from_ideal", "pose with springs, from that with ideal cables", |row| {
                row.spring_from_ideal.as_ref()
            }),
            ("catenary_from_ideal", "pose with catenaries, from that with ideal cables", |row| {
                row.catenary_from_ideal.as_ref()
            }),
            ("spring_from_catenary", "pose with springs, from that with catenaries", |row| {
                row.spring_from_catenary.as_ref()
            }),
        ];
        let mass = column("mass_kg", "kg", "mass of the platform", |row: &Self| row.mass_kg);
        let of_pairs = pairs.into_iter().flat_map(|(name, about, of)| {
            [
                parts(&format!("{name}_{{}}_m"), AXES, "m", &format!("{about}: translation, {{}}"), move |row| {
                    of(row).map_or([None; 3], |pair| pair.translation_m.map(Some))
                }),
                parts(&format!("{name}_{{}}_m"), ["distance"], "m", &format!("{about}: distance"), move |row| {
                    [of(row).map(|pair| pair.distance_m)]
                }),
                parts(&format!("{name}_{{}}_deg"), ["angle"], "deg", &format!("{about}: angle"), move |row| {
                    [of(row).map(|pair| pair.angle_deg)]
                }),
            ]
        });
        Columns::new(std::iter::once(mass).chain(of_pairs))
    }
}

impl Tabled for PoseErrors {
    fn tables() -> Vec<(&'static str, Vec<Column>)> {
        vec![("", PoseErrorRow::columns().described())]
    }

    fn table(&self) -> ResultTable<'_> {
        ResultTable::new(PoseErrorRow::columns(), &self.points)
    }
}

found!(PoseErrors, "pose-error");

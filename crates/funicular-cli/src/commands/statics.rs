//! `statics`: the equilibrium.

use crate::args::StaticsArgs;
use crate::commands::check::{LoadRow, WindRow};
use crate::output::Results;
use crate::progress::Waiting;
use crate::state::{self, AtRest, SagNumbers};
use crate::table::{self, Table, decimals, decimals_or_none, short, significant, vector};
use anyhow::Result;
use funicular::cable::Sag;
use funicular::math::rotation;
use funicular::robot::{Pose, Robot, TensionLimits};
use funicular::statics::{self, Candidate, Equilibrium, Limit, Stability, TensionMargin, TensionRange};
use serde::Serialize;

#[derive(Serialize)]
pub(crate) struct Statics {
    #[serde(skip)]
    robot: String,
    static_model: &'static str,
    mass_kg: f64,
    /// On the platform; absent where there is none.
    #[serde(skip_serializing_if = "Option::is_none")]
    load: Option<LoadRow>,
    /// Absent in still air.
    #[serde(skip_serializing_if = "Option::is_none")]
    wind: Option<WindRow>,
    pose: PoseRow,
    /// Distance from the pose asked; absent where the cables are as many as the freedoms, or lengths were given.
    #[serde(skip_serializing_if = "Option::is_none")]
    nearest_pose_distance_m: Option<f64>,
    /// Absent where the tensions were no choice.
    #[serde(skip_serializing_if = "Option::is_none")]
    tension_rule: Option<&'static str>,
    cables: Vec<CableRow>,
    residual: f64,
    /// Neither loads nor tensions: the residual says nothing.
    #[serde(skip)]
    carries_nothing: bool,
    iterations: usize,
    /// Absent for ideal cables, which are rigid.
    #[serde(skip_serializing_if = "Option::is_none")]
    stable: Option<bool>,
    #[serde(skip_serializing_if = "Option::is_none")]
    least_stiffness_n_per_m: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    other_stable: Option<OtherStable>,
    /// All that a search found, the lowest first; with --all.
    #[serde(skip_serializing_if = "Option::is_none")]
    equilibria: Option<Vec<EquilibriumRow>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    search: Option<Search>,
    #[serde(skip)]
    warnings: Vec<String>,
}

/// Another equilibrium of the same lengths.
#[derive(Serialize)]
struct EquilibriumRow {
    stable: bool,
    /// Directions in which the energy falls.
    falling_directions: usize,
    /// Directions in which it does not change.
    indifferent_directions: usize,
    /// Above that of the lowest; absent where the loads have no potential.
    #[serde(skip_serializing_if = "Option::is_none")]
    energy_j: Option<f64>,
    /// From the first equilibrium.
    distance_m: f64,
    pose: PoseRow,
    tensions_platform_n: Vec<f64>,
}

impl EquilibriumRow {
    fn of(candidate: &Candidate) -> Self {
        Self {
            stable: candidate.is_stable(),
            falling_directions: candidate.falling,
            indifferent_directions: candidate.indifferent,
            energy_j: candidate.energy,
            distance_m: candidate.distance,
            pose: PoseRow::of(&candidate.equilibrium.pose),
            tensions_platform_n: candidate.equilibrium.cables.iter().map(|cable| cable.tension_platform).collect(),
        }
    }

    fn stability(&self) -> String {
        match (self.falling_directions, self.indifferent_directions) {
            (0, 0) => "stable".to_owned(),
            (0, _) => "indifferent".to_owned(),
            (falling, _) => format!("unstable ({falling})"),
        }
    }
}

/// What a search for all equilibria found.
#[derive(Serialize)]
struct Search {
    starts: usize,
    /// Sum of (−1)^falling_directions, and what it is of a list that lacks none.
    index_sum: i64,
    #[serde(skip_serializing_if = "Option::is_none")]
    expected_index_sum: Option<i64>,
}

/// Another stable equilibrium, where a short search met one.
#[derive(Serialize)]
struct OtherStable {
    /// Above that of this equilibrium; absent where the loads have no potential.
    #[serde(skip_serializing_if = "Option::is_none")]
    energy_above_j: Option<f64>,
    distance_m: f64,
    position_m: [f64; 3],
}

impl OtherStable {
    fn of(robot: &Robot, equilibrium: &Equilibrium) -> Option<Self> {
        let (other, energy_above_j) = statics::other_stable(robot, equilibrium)?;
        Some(Self { energy_above_j, distance_m: other.distance, position_m: other.equilibrium.pose.position_w.into() })
    }

    fn text(&self) -> String {
        let energy = self.energy_above_j.map_or_else(String::new, |energy| {
            format!(", {} J {}", short(energy.abs(), 4), if energy < 0.0 { "lower" } else { "higher" })
        });
        format!(
            "These lengths have another stable equilibrium, {} m away{energy} (--all lists what there is).\n",
            short(self.distance_m, 4)
        )
    }
}

#[derive(Serialize)]
struct PoseRow {
    position_m: [f64; 3],
    quaternion_wxyz: [f64; 4],
    roll_pitch_yaw_deg: [f64; 3],
}

impl PoseRow {
    fn of(pose: &Pose) -> Self {
        Self {
            position_m: pose.position_w.into(),
            quaternion_wxyz: rotation::quaternion_wxyz(&pose.rot_wp),
            roll_pitch_yaw_deg: rotation::to_roll_pitch_yaw_deg(&pose.rot_wp),
        }
    }
}

#[derive(Serialize)]
struct CableRow {
    name: String,
    unstrained_length_m: f64,
    tension_platform_n: f64,
    tension_anchor_n: f64,
    chord_m: f64,
    #[serde(flatten)]
    sag: SagNumbers,
    force_on_platform_n: [f64; 3],
    /// Absent where neither the file nor a rule has limits.
    #[serde(flatten)]
    limits: Option<LimitNumbers>,
}

/// The limits of a cable's tension, and how far it is from them.
#[derive(Serialize)]
struct LimitNumbers {
    minimum_tension_n: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    maximum_tension_n: Option<f64>,
    /// Distance from the nearer limit; absent without any.
    tension_margin_n: f64,
    /// The same over the distance between the limits.
    #[serde(skip_serializing_if = "Option::is_none")]
    tension_margin: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    limit_reached: Option<&'static str>,
}

impl LimitNumbers {
    fn of(margin: &TensionMargin) -> Self {
        let TensionRange { minimum, maximum } = margin.range;
        Self {
            minimum_tension_n: minimum,
            maximum_tension_n: maximum.is_finite().then_some(maximum),
            tension_margin_n: margin.distance(),
            tension_margin: margin.relative(),
            limit_reached: margin.reached().map(|limit| match limit {
                Limit::Minimum => "minimum",
                Limit::Maximum => "maximum",
            }),
        }
    }

    fn cells(&self) -> [String; 2] {
        let maximum = self.maximum_tension_n.map_or_else(|| "∞".to_owned(), |maximum| short(maximum, 4));
        let margin = match self.limit_reached {
            Some(limit) if self.tension_margin_n.abs() <= 1e-6 * self.minimum_tension_n.max(1.0) => limit.to_owned(),
            _ => decimals(self.tension_margin_n, 1),
        };
        [format!("{} to {maximum}", short(self.minimum_tension_n, 4)), margin]
    }
}

pub(crate) fn run(robot: Robot, args: &StaticsArgs) -> Result<Statics> {
    let (at_rest, rule) = state::equilibrium_with(robot, &args.state, &args.tensions)?;
    let AtRest { robot, equilibrium, .. } = &at_rest;
    let limited = rule.is_some() || robot.cables.iter().any(|cable| cable.limits() != TensionLimits::default());
    let cables = equilibrium
        .cables
        .iter()
        .enumerate()
        .map(|(i, cable)| CableRow {
            name: robot.cables[i].name.clone(),
            unstrained_length_m: cable.unstrained_length,
            tension_platform_n: cable.tension_platform,
            tension_anchor_n: cable.tension_anchor,
            chord_m: cable.chord(),
            sag: SagNumbers::of(&Sag::of(robot, i, cable)),
            force_on_platform_n: cable.force_on_platform_w.into(),
            limits: limited.then(|| LimitNumbers::of(&TensionRange::of(robot, i, &cable.chord_w()).margin(cable))),
        })
        .collect();
    let (stable, least_stiffness_n_per_m) = match equilibrium.stability {
        Stability::Stable { least_stiffness } => (Some(true), Some(least_stiffness)),
        Stability::Unstable { least_stiffness, .. } => (Some(false), Some(least_stiffness)),
        Stability::Rigid => (None, None),
    };
    let (mut equilibria, mut search, mut other_stable) = (None, None, None);
    let mut warnings = at_rest.warnings(None);
    if args.all {
        let lengths: Vec<f64> = equilibrium.cables.iter().map(|cable| cable.unstrained_length).collect();
        let waiting = Waiting::for_("the equilibria of these lengths");
        let all = statics::all(robot, &lengths, equilibrium.model, Some(&equilibrium.pose))?;
        drop(waiting);
        if let (true, Some(expected)) = (all.lacks_some(), all.expected_index_sum) {
            warnings.push(format!(
                "the list of equilibria is not whole: the sum of (−1)^(falling directions) is {}, of all it is {expected} \
                 (after {} starts)",
                all.index_sum, all.starts
            ));
        }
        equilibria = Some(all.found.iter().map(EquilibriumRow::of).collect());
        let (index_sum, expected_index_sum) = (all.index_sum, all.expected_index_sum);
        search = Some(Search { starts: all.starts, index_sum, expected_index_sum });
    } else {
        other_stable = OtherStable::of(robot, equilibrium);
    }
    Ok(Statics {
        warnings,
        robot: robot.name.clone(),
        static_model: equilibrium.model.name(),
        mass_kg: robot.platform.mass,
        load: LoadRow::of(&robot.load),
        wind: WindRow::of(&robot.wind),
        pose: PoseRow::of(&equilibrium.pose),
        nearest_pose_distance_m: at_rest.instead_of.map(|(_, distance)| distance),
        tension_rule: rule.map(|rule| rule.name()),
        cables,
        residual: equilibrium.residual,
        carries_nothing: statics::carries_nothing(robot, equilibrium),
        iterations: equilibrium.iterations,
        stable,
        least_stiffness_n_per_m,
        other_stable,
        equilibria,
        search,
    })
}

impl Results for Statics {
    const COMMAND: &'static str = "statics";

    fn robot(&self) -> &str {
        &self.robot
    }

    fn warnings(&self) -> &[String] {
        &self.warnings
    }

    fn text(&self) -> String {
        let limited = self.cables.iter().any(|cable| cable.limits.is_some());
        let header = [
            "cable",
            "unstrained [m]",
            "chord [m]",
            "T platform [N]",
            "T anchor [N]",
            "sag/chord",
            "λ²",
            "string [Hz]",
            "limits [N]",
            "margin [N]",
        ];
        let mut cables = Table::new(&header[..if limited { 10 } else { 8 }]);
        let or_none = |value: Option<f64>| value.map_or_else(|| table::NONE.to_owned(), |v| significant(v, 4));
        for cable in &self.cables {
            let mut row = vec![
                cable.name.clone(),
                decimals(cable.unstrained_length_m, 4),
                decimals(cable.chord_m, 4),
                decimals(cable.tension_platform_n, 3),
                decimals(cable.tension_anchor_n, 3),
                decimals_or_none(cable.sag.sag_ratio, 5),
                or_none(cable.sag.lambda2),
                decimals_or_none(cable.sag.string_frequency_hz, 3),
            ];
            row.extend(cable.limits.iter().flat_map(LimitNumbers::cells));
            cables.row(row);
        }
        let stability = match (self.stable, self.least_stiffness_n_per_m) {
            (Some(true), Some(least)) => format!("Stable, least stiffness {} N/m", significant(least, 4)),
            (Some(false), Some(0.0)) => "INDIFFERENT: the platform is free to move in some direction".to_owned(),
            (Some(false), Some(least)) => format!("NOT STABLE, least stiffness {} N/m", significant(least, 4)),
            _ => "Rigid cables: no stiffness".to_owned(),
        };
        let rule = self.tension_rule.map_or_else(String::new, |rule| format!(", tensions by the rule `{rule}`"));
        let load = self.load.as_ref().map_or_else(String::new, |load| format!(", {}", load.text()));
        let wind = self.wind.as_ref().map_or_else(String::new, |wind| format!(", wind {}", wind.text()));
        let nearest = self.nearest_pose_distance_m.map_or_else(String::new, |distance| {
            format!("  nearest pose that the cables can hold, {} m from the one asked\n", short(distance, 4))
        });
        let others = match (&self.other_stable, self.equilibria_table()) {
            (_, Some(table)) => format!("\n{table}"),
            (Some(other), None) => other.text(),
            (None, None) => String::new(),
        };
        let balance = if self.carries_nothing {
            "No load and no tension: nothing to balance,".to_owned()
        } else {
            format!("Residual {:.1e}", self.residual)
        };
        format!(
            "{}: equilibrium with {} cables, {} kg{load}{wind}{rule}\n\n  position         ({}) m\n  roll, pitch, yaw ({})°\n{nearest}\n\
             {cables}\n{stability}. {balance} after {}.\n{others}",
            self.robot,
            self.static_model,
            short(self.mass_kg, 6),
            vector(&self.pose.position_m, 6),
            vector(&self.pose.roll_pitch_yaw_deg, 4),
            table::counted(self.iterations, "iteration"),
        )
    }

    fn csv(&self, out: &mut csv::Writer<Vec<u8>>) -> csv::Result<()> {
        if let Some(equilibria) = &self.equilibria {
            return equilibria_csv(equilibria, out);
        }
        out.write_record([
            "name",
            "unstrained_length_m",
            "tension_platform_n",
            "tension_anchor_n",
            "chord_m",
            "sag_ratio",
            "lambda2",
            "string_frequency_hz",
            "force_on_platform_x_n",
            "force_on_platform_y_n",
            "force_on_platform_z_n",
            "minimum_tension_n",
            "maximum_tension_n",
            "tension_margin_n",
            "limit_reached",
        ])?;
        for c in &self.cables {
            let limits = c.limits.as_ref();
            out.serialize((
                &c.name,
                c.unstrained_length_m,
                c.tension_platform_n,
                c.tension_anchor_n,
                c.chord_m,
                c.sag.sag_ratio,
                c.sag.lambda2,
                c.sag.string_frequency_hz,
                c.force_on_platform_n,
                limits.map(|l| l.minimum_tension_n),
                limits.and_then(|l| l.maximum_tension_n),
                limits.map(|l| l.tension_margin_n),
                limits.and_then(|l| l.limit_reached),
            ))?;
        }
        Ok(())
    }
}

impl Statics {
    /// All equilibria found.
    fn equilibria_table(&self) -> Option<String> {
        let (equilibria, search) = (self.equilibria.as_ref()?, self.search.as_ref()?);
        let header = ["", "equilibrium", "energy [J]", "distance [m]", "position [m]", "roll, pitch, yaw [°]"];
        let mut rows = Table::new(&header).text_columns(&[1]);
        for (i, row) in equilibria.iter().enumerate() {
            rows.row(vec![
                (i + 1).to_string(),
                row.stability(),
                row.energy_j.map_or_else(|| table::NONE.to_owned(), |energy| short(energy, 5)),
                decimals(row.distance_m, 4),
                vector(&row.pose.position_m, 4),
                vector(&row.pose.roll_pitch_yaw_deg, 2),
            ]);
        }
        let stable = equilibria.iter().filter(|row| row.stable).count();
        let sum = match search.expected_index_sum {
            Some(expected) if expected == search.index_sum => {
                "; as many with an even as with an odd number of falling directions, as it must be"
            }
            _ => "",
        };
        // A point mass has one equilibrium, which needs no counting.
        let sum = if search.starts == 0 { "" } else { sum };
        let found = equilibria.len();
        let noun = if found == 1 { "equilibrium" } else { "equilibria" };
        let starts = table::counted(search.starts.max(1), "start");
        Some(format!("{rows}\n{found} {noun}, {stable} stable, from {starts}{sum}.\n"))
    }
}

fn equilibria_csv(equilibria: &[EquilibriumRow], out: &mut csv::Writer<Vec<u8>>) -> csv::Result<()> {
    let mut header: Vec<String> = [
        "stable",
        "falling_directions",
        "indifferent_directions",
        "energy_j",
        "distance_m",
        "x_m",
        "y_m",
        "z_m",
        "roll_deg",
        "pitch_deg",
        "yaw_deg",
    ]
    .map(str::to_owned)
    .to_vec();
    let cables = equilibria.first().map_or(0, |row| row.tensions_platform_n.len());
    header.extend((1..=cables).map(|i| format!("tension_platform_{i}_n")));
    out.write_record(&header)?;
    for row in equilibria {
        let state = (row.stable, row.falling_directions, row.indifferent_directions, row.energy_j, row.distance_m);
        out.serialize((state, row.pose.position_m, row.pose.roll_pitch_yaw_deg, &row.tensions_platform_n))?;
    }
    Ok(())
}

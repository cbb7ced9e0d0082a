//! Tables I and II and Fig. 6 of the paper: geometry, ideal poses, and errors of simpler static models.

use super::published::{IDEAL_POSITION, MOORPY};
use crate::pages::figure::{PageFigure, axis, colour, line, points, with};
use crate::pages::table::{PageTable, fixed};
use funicular::pose_error::{PoseDifference, PoseErrorPoint, Threshold, threshold};
use funicular::robot::{Robot, State};
use serde_json::{Value, json};

/// Minimum and maximum platform mass of the paper [kg].
const MASS_RANGE: (f64, f64) = (10.55, 86.35);
/// Number of points of a curve.
const POINTS: u32 = 60;
/// Tolerances of the thresholds [m].
const TOLERANCES: [f64; 4] = [0.001, 0.002, 0.005, 0.01];
/// Names of the cable sets in all tables.
const SET_NAMES: [&str; 2] = ["4 mm", "8 mm"];

/// Difference between the poses of two static models.
type Difference = fn(&PoseErrorPoint) -> Option<PoseDifference>;

/// Pose errors of one cable set over the range of masses.
pub(crate) struct Sweep {
    robot: Robot,
    lengths: Vec<f64>,
    points: Vec<PoseErrorPoint>,
}

impl Sweep {
    /// Computes the pose errors of a robot whose file gives lengths.
    pub(crate) fn of(robot: &Robot) -> Self {
        let lengths = lengths(robot);
        let step = (MASS_RANGE.1 - MASS_RANGE.0) / f64::from(POINTS - 1);
        let points =
            (0..POINTS).map(|k| PoseErrorPoint::at_mass(robot, &lengths, MASS_RANGE.0 + step * f64::from(k))).collect();
        Self { robot: robot.clone(), lengths, points }
    }

    /// Masses of the points [kg].
    fn masses(&self) -> Vec<f64> {
        self.points.iter().map(|point| point.mass).collect()
    }

    /// Part of the difference between two models at every mass [mm].
    fn curve(&self, of: Difference, part: fn(&PoseDifference) -> f64) -> Vec<f64> {
        self.points.iter().map(|point| of(point).map_or(f64::NAN, |difference| 1e3 * part(&difference))).collect()
    }
}

/// Unstrained lengths in the file [m]; empty if it gives a pose.
pub(crate) fn lengths(robot: &Robot) -> Vec<f64> {
    match &robot.state {
        State::Lengths(lengths) => lengths.clone(),
        State::Pose(_) | State::Unknown => Vec::new(),
    }
}

/// Tables I and II of the paper: geometry and cable lengths.
pub(crate) fn geometry(sweeps: &[Sweep; 2]) -> PageTable {
    let mut table = PageTable::new(
        "table-geometry",
        "The paper's Tables I and II: anchors in the world frame, attachments in the platform frame, unstrained \
         lengths of both cable sets. These are inputs here; both sets have E = 20 GPa, 0.067 kg/m (4 mm) and 0.251 \
         kg/m (8 mm).",
        &["<cable", "anchor x|m", "y|m", "z|m", "attachment x|m", "y|m", "z|m", "length, 4 mm|m", "length, 8 mm|m"],
    );
    for (i, cable) in sweeps[0].robot.cables.iter().enumerate() {
        let (b, a) = (cable.anchor.reference_w(), cable.attachment_p);
        let mut cells = vec![cable.name.clone()];
        cells.extend([b.x, b.y, b.z, a.x, a.y, a.z].map(|v| fixed(v, 3)));
        cells.extend(sweeps.iter().map(|s| fixed(s.lengths[i], 3)));
        table.row(cells);
    }
    table
}

/// Table of the ideal poses of both sets, compared with an independent solution.
pub(crate) fn ideal_poses(sweeps: &[Sweep; 2]) -> PageTable {
    let mut table = PageTable::new(
        "table-ideal",
        "Ideal pose (inextensible straight cables): computed here, and from an independent solution of the six length \
         equations |B − (p + R A)| = L0. Six lengths determine six coordinates, so this checks the solution, not the \
         data.",
        &["<cable set", "<", "x|m", "y|m", "z|m", "largest error of a length|m"],
    );

    for ((sweep, name), theirs) in sweeps.iter().zip(SET_NAMES).zip(IDEAL_POSITION) {
        if let Ok(ideal) = &sweep.points[0].ideal {
            let p = ideal.pose.position_w;
            let closure = ideal.cables.iter().zip(&sweep.lengths).map(|(c, l)| (c.chord() - l).abs());
            let mut cells = vec![name.to_owned(), "computed".to_owned()];
            cells.extend([p.x, p.y, p.z].map(|v| fixed(v, 4)));
            cells.push(format!("{:.0e}", closure.fold(0.0, f64::max)).replace('-', "−"));
            table.marked_row("rule", cells);
        }

        let mut cells = vec![name.to_owned(), "independent".to_owned()];
        cells.extend(theirs.map(|v| fixed(v, 4)));
        cells.push("–".to_owned());

        table.row(cells);
    }
    table
}

/// Fig. 6: error along z of simpler models, for cable set 0 (4 mm) or 1 (8 mm).
pub(crate) fn error_figure(sweeps: &[Sweep; 2], set: usize) -> PageFigure {
    let sweep = &sweeps[set];
    let curve = |of: Difference| sweep.curve(of, |difference| difference.translation[2]);
    let masses = sweep.masses();
    let data = vec![
        line("catenary", &masses, &curve(PoseErrorPoint::catenary_from_ideal), colour::BLUE, "solid"),
        line("spring", &masses, &curve(PoseErrorPoint::spring_from_ideal), colour::GREEN, "dot"),
        line("spring from catenary", &masses, &curve(PoseErrorPoint::spring_from_catenary), colour::ORANGE, "dash"),
        independent(sweep, set),
    ];

    let id = ["figure-pose-4mm", "figure-pose-8mm"][set];
    let caption = format!(
        "The paper's Fig. 6, the error along z, {} cables: displacement of the platform along z from its ideal \
         position over the platform's mass, and that of springs from the catenary. Circles: MoorPy 1.3.0.",
        SET_NAMES[set]
    );
    let layout = json!({
        "xaxis": axis("platform mass [kg]", json!({"range": [5, 90]})),
        "yaxis": axis("displacement along z [mm]", json!({"zeroline": true, "zerolinecolor": "#aaaaaa"})),
    });

    PageFigure::new(id, 380, caption, &data, layout)
}

/// Displacements along z of MoorPy's equilibria from the ideal position [mm].
fn independent(sweep: &Sweep, set: usize) -> Value {
    let ideal = sweep.points[0].ideal.as_ref().map(|e| e.pose.position_w).unwrap_or_default();
    let x: Vec<f64> = MOORPY[set].iter().map(|theirs| theirs.mass).collect();
    let y: Vec<f64> = MOORPY[set].iter().map(|theirs| 1e3 * (theirs.position[2] - ideal.z)).collect();
    points("MoorPy, catenary", &x, &y, colour::BLACK, "circle-open")
}

/// Displacement from the ideal position along x and y, and its magnitude.
pub(crate) fn axes_figure(sweeps: &[Sweep; 2], set: usize) -> PageFigure {
    let sweep = &sweeps[set];
    let masses = sweep.masses();

    type DifferencePart = fn(&PoseDifference) -> f64;
    let parts: [(&str, &str, DifferencePart); 3] = [
        ("x", colour::VERMILION, |difference| difference.translation[0]),
        ("y", colour::GREEN, |difference| difference.translation[1]),
        ("distance", colour::BLACK, |difference| difference.distance),
    ];
    let mut data = Vec::new();
    for (name, colour, part) in parts {
        let catenary = sweep.curve(PoseErrorPoint::catenary_from_ideal, part);
        let spring = sweep.curve(PoseErrorPoint::spring_from_ideal, part);
        data.push(line(name, &masses, &catenary, colour, "solid"));
        data.push(with(
            line(&format!("{name}, spring"), &masses, &spring, colour, "dot"),
            json!({"line": {"width": 2.2}, "showlegend": false}),
        ));
    }

    let id = ["figure-axes-4mm", "figure-axes-8mm"][set];
    let caption = format!(
        "Displacement from the ideal position along x and y, and its magnitude in space, {} cables; solid: catenary, \
         dotted: spring.",
        SET_NAMES[set]
    );
    let layout = json!({
        "xaxis": axis("platform mass [kg]", json!({"range": [5, 90]})),
        "yaxis": axis("displacement [mm]", json!({"zeroline": true, "zerolinecolor": "#aaaaaa"})),
    });

    PageFigure::new(id, 380, caption, &data, layout)
}

/// Table of the masses above which the spring model is within a tolerance of the catenary.
pub(crate) fn thresholds(sweeps: &[Sweep; 2]) -> PageTable {
    let mut table = PageTable::new(
        "table-thresholds",
        "Minimum platform mass from which the spring model's position stays within a tolerance of the catenary's, up \
         to 86.35 kg.",
        &["tolerance|mm", "4 mm cables|kg", "8 mm cables|kg"],
    );
    for tolerance in TOLERANCES {
        let mut cells = vec![fixed(1e3 * tolerance, 0)];
        cells.extend(sweeps.iter().map(|s| match threshold(&s.robot, &s.lengths, &s.points, tolerance) {
            Threshold::Everywhere => format!("all from {}", fixed(MASS_RANGE.0, 2)),
            Threshold::From(mass) => fixed(mass, 2),
            Threshold::Nowhere => "none".to_owned(),
        }));
        table.row(cells);
    }
    table
}

/// Table of equilibria compared with MoorPy's.
pub(crate) fn against_moorpy(sweeps: &[Sweep; 2]) -> PageTable {
    let mut table = PageTable::new(
        "table-moorpy",
        "Equilibrium with catenaries: computed here and by MoorPy 1.3.0 (printed there to 0.01 mm).",
        &["<cable set", "mass|kg", "x, computed|m", "y|m", "z|m", "x, MoorPy|m", "y|m", "z|m", "distance|mm"],
    );
    for ((sweep, name), theirs) in sweeps.iter().zip(SET_NAMES).zip(&MOORPY) {
        for theirs in theirs {
            let Ok(ours) = PoseErrorPoint::at_mass(&sweep.robot, &sweep.lengths, theirs.mass).catenary else {
                continue;
            };
            let p = ours.pose.position_w;
            let mut cells = vec![name.to_owned(), fixed(theirs.mass, 2)];
            cells.extend([p.x, p.y, p.z].map(|v| fixed(v, 5)));
            cells.extend(theirs.position.map(|v| fixed(v, 5)));
            cells.push(fixed(1e3 * (p - funicular::math::Vec3::from(theirs.position)).norm(), 3));
            table.row(cells);
        }
    }
    table
}

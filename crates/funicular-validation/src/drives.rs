//! Cables over pulleys and on winches.

use super::reference::{
    CableToWinch, Drives, FrictionCorner, FrictionHalfWidths, RobotWithWinches, SaggingOverPulley, StraightOverPulley,
};
use super::{Bound, Case, Comparison, Level, reference, slug};
use anyhow::{Result, anyhow};
use funicular::drive::{CableAtRest, DriveFriction};
use funicular::math::{Mat3, Vec3, rotation};
use funicular::robot::{Anchor, Cable, Constraint, Pulley, PulleyFriction, Robot, State};
use funicular::statics::{self, CableState, Equilibrium, Held, Interval, StaticModel};
use std::fmt::Write;

/// Comparisons at rest and with friction.
pub(super) fn rows(drives: &Drives) -> Result<Vec<Comparison>> {
    let mut rows = Vec::new();
    for row in &drives.straight.rows {
        rows.extend(straight(row, &drives.straight.source));
    }

    for row in &drives.sagging.rows {
        rows.extend(sagging(row, &drives.sagging.source)?);
    }
    for row in &drives.cables.rows {
        rows.extend(to_winch(row, &drives.cables.source)?);
    }
    for row in &drives.robots.rows {
        rows.extend(robot(row, &drives.robots.source)?);
    }

    for row in &drives.friction_corners.rows {
        let robot = with_friction(drives, &row.robot, row.friction_coefficient)?;
        rows.extend(friction_corner(row, &robot, &drives.friction_corners.source)?);
    }
    for row in &drives.friction_half_widths.rows {
        let robot = with_friction(drives, &row.robot, row.friction_coefficient * SMALL_FRICTION)?;
        rows.extend(friction_half_widths(row, &robot, &drives.friction_half_widths.source)?);
    }

    Ok(rows)
}

/// Comparisons of single cables with a change.
pub(super) fn of_changed(change: fn(&mut Drives)) -> Result<Vec<Comparison>> {
    let mut drives = reference::drives()?;
    change(&mut drives);
    drives.robots.rows.clear();
    drives.vibration.rows.clear();
    drives.moving_cables.rows.clear();
    drives.friction_corners.rows.clear();
    drives.friction_half_widths.rows.clear();
    rows(&drives)
}

/// Leaves the equilibria with friction.
pub(super) fn only_friction(drives: &mut Drives) {
    drives.straight.rows.clear();
    drives.sagging.rows.clear();
    drives.cables.rows.clear();
    drives.vibration.rows.clear();
    drives.moving_cables.rows.clear();
    drives.friction_half_widths.rows.clear();
    // Its robot stays, and is not compared again.
    drives.friction_corners.rows.truncate(1);
}

/// Rounding of closed forms with lengths of some metres.
const CLOSED_FORM: f64 = 2e-14;

/// Rounding of the solution: the unknowns are found to 1e-13, and a taut cable turns a relative error of its length
/// into one of its tension that is EA/T times as large.
const SOLVED: f64 = 1e-10;

/// Relative difference of half widths due to the strain on the wheel, which the reference leaves out in the term of the
/// arc: the strain T/EA is 2e-4, the arc gives a fiftieth of the half width.
const ON_WHEEL: f64 = 1e-5;

fn straight(row: &StraightOverPulley, source: &str) -> Vec<Comparison> {
    let anchor = Anchor {
        pulley: Some(Pulley::new("wheel", row.radius_m, Vec3::from(row.entry_direction).normalize())),
        ..Anchor::from(Vec3::from(row.entry_point_m))
    };
    let end_w = Vec3::from(row.platform_point_m);
    let exit_w = anchor.exit_w(&end_w);
    let wrap = anchor.contact(&end_w).map_or(f64::NAN, |contact| contact.wrap);
    let length = (end_w - exit_w).norm() + anchor.length_beyond(&end_w);

    let case =
        Case::new(Level::Exact, source, &format!("straight/{}", slug(&row.case)), &format!("straight, {}", row.case));
    let tolerance = row.printed_digits + CLOSED_FORM;
    let bound = if row.printed_digits > CLOSED_FORM { Bound::Digits("12 printed digits") } else { Bound::Rounding };
    vec![
        case.of("wrap-length", "wrap [rad], length [m]").absolute(
            &[row.wrap_rad, row.length_m],
            &[wrap, length],
            tolerance,
            bound,
        ),
        case.of("exit", "exit point [m]").absolute(&row.exit_point_m, exit_w.as_slice(), tolerance, bound),
    ]
}

fn sagging(row: &SaggingOverPulley, source: &str) -> Result<Vec<Comparison>> {
    let [x, z] = row.platform_point_along_up_m;
    let robot = single(&Single {
        gravity: 1.0,
        mass_per_length: row.weight_n_per_m,
        axial_stiffness: row.axial_stiffness_n,
        radius: row.radius_m,
        entry_direction: [0.0, 0.0, 1.0],
        anchor: [0.0; 3],
        drum_side_length: 0.0,
        winch_stiffness: None,
    })?;
    let found = CableAtRest::of(&robot, 0, Vec3::new(x, 0.0, z), row.unstrained_length_m);
    let (force_w, k, exit_w) = (found.force_w(), found.tangent_w(), found.span.end_w);
    let drive = found.drive.as_ref().ok_or_else(|| anyhow!("a cable over a pulley has a drive"))?;
    let catenary = &found.span.catenary;

    let case =
        Case::new(Level::Exact, source, &format!("sagging/{}", slug(&row.case)), &format!("sagging, {}", row.case));
    let wrap = drive.contact.map_or(f64::NAN, |contact| contact.wrap);
    let tensions = [catenary.tension_at_start(), catenary.tension_at_end(), drive.tension_drum];
    let their_tensions = [row.tension_platform_n, row.tension_exit_n, row.tension_drum_n];
    let entries = [k[(0, 0)], k[(0, 2)], k[(2, 2)], k[(1, 1)]];
    let free_length = catenary.rope().unstrained_length;
    Ok(vec![
        case.of("force", "force [N]").together(
            &row.force_at_platform_along_up_n,
            &[force_w.x, force_w.z],
            SOLVED,
            Bound::Rounding,
        ),
        case.of("tensions", "tensions [N]").together(&their_tensions, &tensions, SOLVED, Bound::Rounding),
        case.of("wrap-length", "wrap [rad], free length [m]").absolute(
            &[row.wrap_rad, row.free_length_m],
            &[wrap, free_length],
            SOLVED,
            Bound::Rounding,
        ),
        case.of("exit", "exit point [m]").absolute(
            &row.exit_point_along_up_m,
            &[exit_w.x, exit_w.z],
            SOLVED,
            Bound::Rounding,
        ),
        case.of("stiffness", "stiffness [N/m]").together(&row.stiffness_n_per_m, &entries, SOLVED, Bound::Rounding),
    ])
}

/// Point mass on the cable of a case.
pub(super) fn to_winch_robot(row: &CableToWinch) -> Result<Robot> {
    single(&Single {
        gravity: 9.81,
        mass_per_length: row.mass_kg_per_m,
        axial_stiffness: row.axial_stiffness_n,
        radius: row.radius_m,
        entry_direction: row.entry_direction,
        anchor: row.entry_point_m,
        drum_side_length: row.drum_side_length_m,
        winch_stiffness: row.winch_stiffness_n_per_m,
    })
}

fn to_winch(row: &CableToWinch, source: &str) -> Result<Vec<Comparison>> {
    let robot = to_winch_robot(row)?;
    let found = CableAtRest::of(&robot, 0, Vec3::from(row.platform_point_m), row.unstrained_length_m);
    let drive = found.drive.as_ref().ok_or_else(|| anyhow!("a cable over a pulley has a drive"))?;
    let catenary = &found.span.catenary;
    let wrap = drive.contact.map_or(f64::NAN, |contact| contact.wrap);

    let case = Case::new(Level::Program, source, &format!("cable/{}", slug(&row.case)), &row.case);
    let digits = Bound::Digits("12 printed digits");
    // A tilted swivel axis.
    let kinked = row.kink_rad.abs() > 1e-12;
    let (stiffness, bound) =
        if kinked { (10.0 * row.kink_rad.powi(2), Bound::Model("square of the kink")) } else { (SOLVED, digits) };
    let k = found.tangent_w();
    let theirs = Mat3::from_fn(|i, j| row.stiffness_n_per_m[i][j]);
    let lengths = [catenary.rope().unstrained_length, drive.arc_length, drive.drum_side_length];
    Ok(vec![
        case.of("force", "force [N]").together(&row.force_on_platform_n, found.force_w().as_slice(), SOLVED, digits),
        case.of("tensions", "tensions at exit and drum [N]").together(
            &[row.tension_exit_n, row.tension_drum_n],
            &[catenary.tension_at_end(), drive.tension_drum],
            SOLVED,
            digits,
        ),
        case.of("wrap-kink", "wrap, kink [rad]").absolute(
            &[row.wrap_rad, row.kink_rad],
            &[wrap, drive.kink],
            SOLVED,
            digits,
        ),
        case.of("exit", "exit point [m]").absolute(&row.exit_point_m, found.span.end_w.as_slice(), SOLVED, digits),
        case.of("lengths", "lengths of span, arc, drum side [m]").absolute(&row.lengths_m, &lengths, SOLVED, digits),
        case.of("stiffness", "stiffness [N/m]").together(theirs.as_slice(), k.as_slice(), stiffness, bound),
        case.of("force-by-length", "force per length [N/m]").together(
            &row.force_per_unstrained_length_n_per_m,
            found.force_by_length_w().as_slice(),
            stiffness,
            bound,
        ),
        case.of("energy", "energy [J]").relative(&[row.energy_j], &[found.energy()], SOLVED, digits),
    ])
}

fn robot(row: &RobotWithWinches, source: &str) -> Result<Vec<Comparison>> {
    let robot = robot_of(row)?;
    let State::Lengths(lengths) = &robot.state else { return Err(anyhow!("the lengths are given")) };
    let rest = statics::forward(&robot, lengths, StaticModel::Catenary, None)?;
    let stiffness = statics::tangent_stiffness(&robot, &rest).ok_or_else(|| anyhow!("the cables are elastic"))?;
    let exit: Vec<f64> = rest.cables.iter().map(|cable| cable.tension_anchor).collect();
    let drum: Vec<f64> = rest.cables.iter().map(CableState::tension_drum).collect();

    // The way back: lengths from the pose.
    let held = statics::inverse(&robot, &rest.pose, StaticModel::Catenary);
    let case = Case::new(Level::Program, source, &format!("robot/{}", slug(&row.case)), &row.case);
    let digits = Bound::Digits("12 printed digits");
    let angles = rotation::to_roll_pitch_yaw_deg(&rest.pose.rot_wp);
    let mut rows = vec![
        case.of("position", "position [m]").absolute(&row.position_m, rest.pose.position_w.as_slice(), 1e-11, digits),
        case.of("orientation", "orientation [°]").absolute(&row.roll_pitch_yaw_deg, &angles, 1e-9, digits),
        case.of("tensions-exit", "tensions at the exit [N]").together(&row.tension_exit_n, &exit, SOLVED, digits),
        case.of("tensions-drum", "tensions at the drum [N]").together(&row.tension_drum_n, &drum, SOLVED, digits),
        case.of("stiffness", "stiffness").together(
            row.stiffness_6x6.as_flattened(),
            stiffness.as_slice(),
            SOLVED,
            digits,
        ),
    ];
    // More cables than degrees of freedom have a choice.
    if let (Ok(held), true) = (held, robot.constraint() == Constraint::Fully) {
        let back: Vec<f64> = held.cables.iter().map(|cable| cable.unstrained_length).collect();
        rows.push(case.of("lengths", "lengths from the pose [m]").absolute(lengths, &back, 1e-11, Bound::Rounding));
    }
    Ok(rows)
}

/// Robot of a case whose pulleys have friction.
fn with_friction(drives: &Drives, case: &str, coefficient: f64) -> Result<Robot> {
    let row = drives.robots.rows.iter().find(|row| row.case == case).ok_or_else(|| anyhow!("no robot \"{case}\""))?;
    let mut robot = robot_of(row)?;
    for pulley in robot.cables.iter_mut().filter_map(|cable| cable.anchor.pulley.as_mut()) {
        pulley.friction = Some(PulleyFriction::Sliding { coefficient });
    }
    Ok(robot)
}

/// Change of the excess lengths per round [m] at which the rounds end: rounding of lengths of some metres.
const LAST_CHANGE: f64 = 1e-14;

/// Maximum number of rounds. Each reduces the error by about the friction exponent.
const MAX_ROUNDS: usize = 60;

/// Equilibrium with friction: cables without friction whose lengths are shorter by the excess of friction, which
/// follows from their tensions.
fn friction_corner(row: &FrictionCorner, robot: &Robot, source: &str) -> Result<Vec<Comparison>> {
    let State::Lengths(lengths) = &robot.state else { return Err(anyhow!("the lengths are given")) };
    let used: Vec<f64> = row.last_towards_platform.iter().map(|towards| if *towards { 1.0 } else { -1.0 }).collect();
    let frictions = |rest: &Equilibrium| -> Result<Vec<DriveFriction>> {
        let of = |((cable, state), used): ((&Cable, &CableState), &f64)| {
            let (span, drive) = state.hanging.as_ref().zip(state.drive.as_ref())?;
            Some(drive.with_friction(span, &cable.anchor, *used))
        };
        let found: Option<Vec<_>> = robot.cables.iter().zip(&rest.cables).zip(&used).map(of).collect();
        found.ok_or_else(|| anyhow!("a cable over a pulley has a drive"))
    };

    let mut rest = statics::forward(robot, lengths, StaticModel::Catenary, None)?;
    let mut found = frictions(&rest)?;
    for _ in 0..MAX_ROUNDS {
        let shortened: Vec<f64> = lengths.iter().zip(&found).map(|(length, own)| length - own.excess_length).collect();
        rest = statics::forward(robot, &shortened, StaticModel::Catenary, Some(&rest.pose))?;
        let next = frictions(&rest)?;
        let change = next.iter().zip(&found).map(|(new, old)| (new.excess_length - old.excess_length).abs());
        let change = change.fold(0.0, f64::max);
        found = next;
        if change < LAST_CHANGE {
            break;
        }
    }

    let exit: Vec<f64> = rest.cables.iter().map(|cable| cable.tension_anchor).collect();
    let drum: Vec<f64> = found.iter().map(|own| own.tension_drum).collect();
    let theirs: Vec<f64> = row.rotation.as_flattened().to_vec();
    let ours = rest.pose.rot_wp.to_rotation_matrix();
    // The reference lists rows.
    let ours: Vec<f64> = ours.matrix().transpose().as_slice().to_vec();
    let case = Case::new(Level::Program, source, &format!("friction/{}", slug(&row.case)), &row.case);
    let digits = Bound::Digits("12 printed digits");
    Ok(vec![
        case.of("position", "position [m]").absolute(&row.position_m, rest.pose.position_w.as_slice(), 1e-11, digits),
        case.of("rotation", "rotation matrix").absolute(&theirs, &ours, 1e-10, digits),
        case.of("tensions-exit", "tensions at the exit [N]").together(&row.tension_exit_n, &exit, SOLVED, digits),
        case.of("tensions-drum", "tensions at the drum [N]").together(&row.tension_drum_n, &drum, SOLVED, digits),
    ])
}

/// Factor on the friction for which second-order terms are below the compared digits.
const SMALL_FRICTION: f64 = 1e-4;

fn friction_half_widths(row: &FrictionHalfWidths, robot: &Robot, source: &str) -> Result<Vec<Comparison>> {
    let State::Lengths(lengths) = &robot.state else { return Err(anyhow!("the lengths are given")) };
    let rest = statics::forward(robot, lengths, StaticModel::Catenary, None)?;
    let found = statics::friction_interval(robot, &rest, Held::Lengths)?;
    let motion = found.motion.ok_or_else(|| anyhow!("the lengths are held"))?;
    let scaled = |intervals: [Interval; 3]| intervals.map(|interval| interval.half_width() / SMALL_FRICTION);

    let case = Case::new(Level::Program, source, &format!("friction-widths/{}", slug(&row.case)), &row.case);
    let bound = Bound::Model("strain of the cable on the wheel");
    let ours = [scaled(motion.translation_w), scaled(motion.rotation_w)];
    Ok(vec![
        case.of("translation", "translation [m]").relative(&row.translation_m, &ours[0], ON_WHEEL, bound),
        case.of("rotation", "rotation [rad]").relative(&row.rotation_rad, &ours[1], ON_WHEEL, bound),
    ])
}

/// Numbers of one cable over a pulley.
struct Single {
    gravity: f64,
    mass_per_length: f64,
    axial_stiffness: f64,
    radius: f64,
    entry_direction: [f64; 3],
    anchor: [f64; 3],
    drum_side_length: f64,
    winch_stiffness: Option<f64>,
}

/// Point mass on one cable.
fn single(of: &Single) -> Result<Robot> {
    let winch = winch_text(of.drum_side_length, of.winch_stiffness);
    let text = format!(
        "name = \"one cable\"\ngravity_m_s2 = [0.0, 0.0, {:?}]\n[platform]\nmass_kg = 1.0\nmotion = \"point-mass\"\n\
         [materials.rope]\naxial_stiffness_n = {:?}\nmass_kg_per_m = {:?}\n[pulleys.wheel]\nradius_m = {:?}\n\
         entry_direction = {:?}\n{winch}[[cables]]\nname = \"1\"\nmaterial = \"rope\"\npulley = \"wheel\"\n\
         winch = \"drum\"\nanchor_m = {:?}\n",
        -of.gravity, of.axial_stiffness, of.mass_per_length, of.radius, of.entry_direction, of.anchor
    );
    Ok(Robot::from_toml(&text)?)
}

fn winch_text(drum_side_length: f64, stiffness: Option<f64>) -> String {
    let stiffness = stiffness.map_or_else(String::new, |stiffness| format!("stiffness_n_per_m = {stiffness:?}\n"));
    format!("[winches.drum]\ndrum_side_length_m = {drum_side_length:?}\n{stiffness}")
}

pub(super) fn robot_of(row: &RobotWithWinches) -> Result<Robot> {
    let mut text = format!(
        "name = {:?}\n[platform]\nmass_kg = {:?}\ncenter_of_mass_m = {:?}\ninertia_kg_m2 = {:?}\n[materials.rope]\n\
         axial_stiffness_n = {:?}\nmass_kg_per_m = {:?}\n[pulleys.wheel]\nradius_m = {:?}\n\
         entry_direction = [0.0, 0.0, 1.0]\n{}",
        row.case,
        row.mass_kg,
        row.center_of_mass_m,
        row.inertia_kg_m2,
        row.axial_stiffness_n,
        row.mass_kg_per_m,
        row.radius_m,
        winch_text(row.drum_side_length_m, row.winch_stiffness_n_per_m)
    );

    let cables = row.anchors_m.iter().zip(&row.attachments_m).zip(&row.unstrained_lengths_m).enumerate();
    for (i, ((anchor, attachment), length)) in cables {
        write!(
            text,
            "[[cables]]\nname = \"{}\"\nmaterial = \"rope\"\npulley = \"wheel\"\nwinch = \"drum\"\n\
             anchor_m = {anchor:?}\nattachment_m = {attachment:?}\nunstrained_length_m = {length:?}\n",
            i + 1
        )?;
    }

    Ok(Robot::from_toml(&text)?)
}

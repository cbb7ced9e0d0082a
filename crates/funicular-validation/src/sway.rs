//! Sway of robots after a release, a stop and a shaped move.

use super::reference::{ShapedSum, SwayReference, SwayingRobot};
use super::section::WRONG;
use super::stretch_loss::{at_rest, nearest};
use super::{Bound, Case, Comparison, Declared, Level, NegativeControl, reference, slug};
use anyhow::{Result, bail};
use funicular::dynamics::{Dynamics, Linearisation};
use funicular::math::{Vec3, Vec6};
use funicular::modes::{self, CommandedMotions, Decay, LengthCommand, Release, damped};
use funicular::path::{Profile, Shaper, ShaperKind};
use funicular::robot::StretchLoss;
use std::f64::consts::TAU;

/// Vibration that the shaper `ei` of the other program leaves.
const VIBRATION: f64 = 0.05;

/// Relative digits of the exact times of settling in the table.
const DIGITS_OF_TIMES: f64 = 1e-5;

pub(super) const SECTION: Declared = Declared {
    id: "sway",
    title: "Sway after a release, a stop and a shaped move, computed independently",
    note: "Amplitudes of the platform origin mode by mode, the largest first, its position a second later, and the \
           times from which on it is within a tolerance, exactly and by the sum of all amplitudes. Lengths are \
           commanded with boxes of speed, acceleration and jerk, and with shapers.",
    rows: || rows(&reference::sway()?),
    controls: &[
        NegativeControl {
            id: "force",
            wrong: "force before the release 1 % too large",
            proves: "the amplitudes after a release",
            rows: || of_first(|of| of.release.force_n = of.release.force_n.map(|force| WRONG * force)),
        },
        NegativeControl {
            id: "rates",
            wrong: "speeds before the stop 1 % too large",
            proves: "the amplitudes after a stop",
            rows: || of_first(|of| of.stop.rates_m_s.iter_mut().for_each(|rate| *rate *= WRONG)),
        },
        NegativeControl {
            id: "shaper",
            wrong: "frequencies of the shapers 10 % too large",
            proves: "the vibration that a shaper leaves",
            rows: || {
                of_first(|of| {
                    let modes = of.shaped.shapers.iter_mut().flat_map(|row| &mut row.modes_hz);
                    modes.for_each(|hz| *hz *= 1.1);
                })
            },
        },
        NegativeControl {
            id: "eta",
            wrong: "loss factor η of the stretch 1 % too large",
            proves: "the time of settling",
            rows: || of_first(|of| of.eta *= WRONG),
        },
    ],
};

fn rows(reference: &SwayReference) -> Result<Vec<Comparison>> {
    let mut rows = Vec::new();
    for of in &reference.robots {
        rows.extend(of_robot(&reference.source, of)?);
    }
    Ok(rows)
}

/// Comparisons of the first robot with a change.
fn of_first(change: fn(&mut SwayingRobot)) -> Result<Vec<Comparison>> {
    let mut reference = reference::sway()?;
    reference.robots.truncate(1);
    reference.robots.iter_mut().for_each(change);
    rows(&reference)
}

/// Part of the place to which modes at the limit add that stand in one of the two lists only.
const AT_THE_LIMIT: f64 = 1e-5;

fn of_robot(source: &str, of: &SwayingRobot) -> Result<Vec<Comparison>> {
    let (robot, rest) = at_rest(&of.changed, of.xi, StretchLoss { factor: of.eta, time: 0.0 })?;
    let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), of.below_hz)?;
    let found = modes::below(&dynamics, of.below_hz);
    let damped = damped::damped_modes(&dynamics, &found);
    if !damped.certified {
        bail!("{}: the damped list is not certified", robot.name);
    }
    let case = Case::new(Level::Program, source, &slug(&of.id), &of.id);
    let (accuracy, bound) = (of.relative_accuracy, Bound::Digits("accuracy of the other program"));
    let same =
        |id: &str, name: &str, theirs: &[f64], ours: &[f64]| case.of(id, name).together(theirs, ours, accuracy, bound);
    let sum = |id: &str, name: &str, theirs: f64, ours: f64| same(id, name, &[theirs], &[ours]);

    let [x, y, z] = of.release.force_n;
    let release = Release::of(&dynamics, &found, &damped, &Vec6::new(x, y, z, 0.0, 0.0, 0.0), &Vec3::zeros())?;
    let theirs = &of.release;
    let at_1s = release.decay.at(1.0);
    let place = case.of("release-place", "place after 1 s, release [m]");
    let mut rows = vec![
        same("release-deflection", "deflection [m]", &theirs.static_deflection_m, release.held.as_slice()),
        same("release-amplitudes", "amplitudes, release [m]", &theirs.amplitudes_m, &loudest(&release.decay)),
        place.together(&theirs.position_at_1s_m, at_1s.as_slice(), accuracy.max(AT_THE_LIMIT), bound),
    ];
    let times = theirs.settle.iter().map(|of| (of.tolerance_m, of.bound_s, of.exact_s)).collect::<Vec<_>>();
    rows.extend(settling(&case, ("release", "release"), &times, &release.decay, 0.0));

    let motions = CommandedMotions::of(&dynamics, &found, &damped, &Vec3::zeros())?;
    let theirs = &of.stop;
    let command = LengthCommand::Stop { rates: theirs.rates_m_s.clone(), profile: Profile::new(&theirs.durations_s) };
    let stop = motions.after(&command);
    let at_1s = stop.at(1.0);
    rows.extend([
        same("stop-amplitudes", "amplitudes, stop [m]", &theirs.amplitudes_m, &loudest(&stop)),
        sum("stop-sum", "sum of all amplitudes, stop [m]", theirs.sum_m, stop.envelope(0.0)),
        same("stop-place", "place 1 s after the stop [m]", &theirs.position_1s_after_m, at_1s.as_slice()),
    ]);
    let times = theirs.settle.iter().map(|of| (of.tolerance_m, of.bound_s, of.exact_s)).collect::<Vec<_>>();
    rows.extend(settling(&case, ("stop", "stop"), &times, &stop, command.duration()));

    let theirs = &of.shaped;
    let profile = Profile::new(&theirs.durations_s);
    let after = |profile: Profile| motions.after(&LengthCommand::Move { by: theirs.change_m.clone(), profile });
    let plain = after(profile.clone());
    rows.push(same("move-amplitudes", "amplitudes, move [m]", &theirs.amplitudes_m, &loudest(&plain)));
    for row in &theirs.shapers {
        let shaper = shaper(row, &plain)?;
        let shaped = after(profile.shaped(&shaper));
        let name = format!("{} of {} mode(s)", row.shaper, row.modes_hz.len());
        let id = format!("{}-{}", row.shaper, row.modes_hz.len());
        rows.push(sum(&format!("{id}-sum"), &format!("sum, {name} [m]"), row.sum_m, shaped.envelope(0.0)));
        let times = [(theirs.tolerance_m, row.bound_s, row.exact_s)];
        rows.extend(settling(&case, (&id, &name), &times, &shaped, shaper.duration()));
    }
    Ok(rows)
}

/// The six largest amplitudes [m].
fn loudest(decay: &Decay) -> Vec<f64> {
    let mut sizes: Vec<f64> = decay.motions.iter().map(modes::DecayingMotion::size).collect();
    sizes.sort_by(|a, b| b.total_cmp(a));
    sizes.truncate(6);
    sizes
}

/// Times of settling, by the bound and exactly, from `earlier` before the beginning of the decay on [s].
fn settling(
    case: &Case,
    (id, name): (&str, &str),
    theirs: &[(f64, f64, f64)],
    decay: &Decay,
    earlier: f64,
) -> Vec<Comparison> {
    let bound = Bound::Digits("digits of the table");
    let ours = |time: fn(&Decay, f64) -> f64| -> Vec<f64> {
        theirs.iter().map(|(tolerance, ..)| time(decay, *tolerance) + earlier).collect()
    };
    let [bounds, exact]: [Vec<f64>; 2] =
        [theirs.iter().map(|of| of.1).collect(), theirs.iter().map(|of| of.2).collect()];
    vec![
        case.of(&format!("{id}-settled-sum"), &format!("settled by the sum, {name} [s]")).together(
            &bounds,
            &ours(Decay::surely_settled),
            DIGITS_OF_TIMES,
            bound,
        ),
        case.of(&format!("{id}-settled"), &format!("settled, {name} [s]")).together(
            &exact,
            &ours(Decay::settled),
            DIGITS_OF_TIMES,
            bound,
        ),
    ]
}

fn shaper(of: &ShapedSum, plain: &Decay) -> Result<Shaper> {
    let kind = match of.shaper.as_str() {
        "zv" => ShaperKind::Zv,
        "zvd" => ShaperKind::Zvd,
        "ei" => ShaperKind::Ei(VIBRATION),
        other => bail!("no shaper {other}"),
    };
    let mut shaper = Shaper::none();
    for hz in &of.modes_hz {
        let mode = nearest(&plain.motions, |mode| (mode.omega.norm() / TAU / hz - 1.0).abs())?;
        let Some(own) = Shaper::of_mode(kind, mode.omega) else { bail!("{hz} Hz does not oscillate") };
        shaper = shaper.convolved(&own);
    }
    Ok(shaper)
}

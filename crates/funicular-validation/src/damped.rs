//! Damped natural frequencies, responses of points on cables, and shapes of undamped modes.

use super::reference::{Damped, DampedRobot, IndependentReference, PointRobot, ReferencePoint, RopeDamping, robot};
use super::section::WRONG;
use super::{
    Bound, Case, Comparison, Declared, DifferenceKind, Level, NegativeControl, reference, shapes, slug, worst,
};
use anyhow::{Context, Result};
use funicular::dynamics::{Dynamics, Linearisation};
use funicular::math::Vec3;
use funicular::modes;
use funicular::response::{self, Port, Quantity, Signal};
use funicular::robot::{Damping, Robot};
use funicular::statics::{self, StaticModel};

pub(super) const SECTION: Declared = Declared {
    id: "damped",
    title: "Damped modes, shapes and points on cables, computed independently",
    note: "Complex natural frequencies with damping of ropes (constant ratio, viscous, both in one robot) and of \
           the platform; responses whose force or motion is on a cable; energies, modal masses and shapes of \
           undamped modes. The other program solves one eigenvalue problem of all unknowns in extended precision. \
           The error of a mode shape is the error of its frequency divided by the relative gap to the next \
           frequency. The differences of energies and modal masses are therefore divided by 1 + 0.001/gap. All \
           values of a list are compared; the table shows the last one.",
    rows: || rows(&reference::damped()?, &reference::independent()?),
    controls: &[
        NegativeControl {
            id: "ratio",
            wrong: "damping of every rope 1 % too large",
            proves: "the loss in the cables, in the complex frequencies",
            rows: || {
                let mut damped = reference::damped()?;
                damped.robots.truncate(1);
                (damped.point_frf, damped.shapes) = (Vec::new(), Vec::new());
                for of in damped.robots.iter_mut().flat_map(|of| of.cable_damping.values_mut()) {
                    match of {
                        RopeDamping::Ratio { damping_ratio: value }
                        | RopeDamping::Viscous { viscous_damping_n_s_m2: value } => *value *= WRONG,
                    }
                }
                rows(&damped, &reference::independent()?)
            },
        },
        NegativeControl {
            id: "place",
            wrong: "points on the cables 1 % further from the platform",
            proves: "the place of points on sagging cables",
            rows: || {
                let mut damped = reference::damped()?;
                (damped.robots, damped.shapes) = (Vec::new(), Vec::new());
                damped.point_frf.truncate(1);
                for pair in damped.point_frf.iter_mut().flat_map(|of| &mut of.pairs) {
                    pair.force.fraction *= WRONG;
                }
                rows(&damped, &reference::independent()?)
            },
        },
        NegativeControl {
            id: "shapes",
            wrong: "places of the shapes 1 % further from the platform",
            proves: "the shapes of the cables in the modes",
            rows: || {
                let mut damped = reference::damped()?;
                (damped.robots, damped.point_frf) = (Vec::new(), Vec::new());
                damped.shapes.truncate(1);
                let places = damped.shapes.iter_mut().flat_map(|of| &mut of.fractions);
                places.for_each(|place| *place *= if *place < 0.99 { WRONG } else { 1.0 });
                rows(&damped, &reference::independent()?)
            },
        },
    ],
};

fn rows(reference: &Damped, robots: &IndependentReference) -> Result<Vec<Comparison>> {
    let toml = |id: &str| {
        let case = robots.cases.iter().find(|other| other.id == id).context("a robot of independent.json")?;
        Ok::<_, anyhow::Error>(&case.toml)
    };
    let mut rows = Vec::new();

    for of in &reference.robots {
        rows.extend(frequencies(&reference.about, of, toml(&of.robot)?)?);
    }
    for of in &reference.point_frf {
        rows.push(points(&reference.about, of, toml(&of.robot)?)?);
    }
    for of in &reference.shapes {
        rows.extend(shapes::of_robot(&reference.about, of, toml(&of.robot)?)?);
    }

    Ok(rows)
}

fn frequencies(source: &str, of: &DampedRobot, toml: &str) -> Result<Vec<Comparison>> {
    let case = Case::new(
        Level::Program,
        source,
        &format!("{}/{}", of.robot, slug(&of.case)),
        &format!("{}, {}", of.robot, of.case),
    );
    let (mut robot, lengths) = robot(toml)?;

    for cable in &mut robot.cables {
        cable.material.damping = match of.cable_damping.get(&cable.name).context("damping of every cable")? {
            RopeDamping::Ratio { damping_ratio } => Damping::Ratio(*damping_ratio),
            RopeDamping::Viscous { viscous_damping_n_s_m2 } => Damping::Viscous(*viscous_damping_n_s_m2),
        };
    }
    if let Some(platform) = &of.platform_damping {
        robot.platform.translational_damping_p = Vec3::from(platform.translation_n_s_m);
        robot.platform.rotational_damping_p = Vec3::from(platform.rotation_n_m_s_rad);
    }

    let rest = statics::forward(&robot, &lengths, StaticModel::Catenary, None)?;
    let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), of.below_hz)?;
    let damped = modes::damped::damped_modes(&dynamics, &modes::below(&dynamics, of.below_hz));
    let mut ours: Vec<(f64, f64)> =
        damped.modes.iter().map(|mode| (mode.ringing_hz(), mode.frequency_hz() * mode.damping_ratio())).collect();
    ours.sort_by(|a, b| a.0.total_cmp(&b.0));
    let certified = if damped.certified { ours.len() } else { 0 };

    // Nearly equal frequencies may have any order: each is compared with the nearest one that is left.
    let mut left = ours.clone();
    let pairs = of.modes.iter().map(|theirs| {
        let gap = |(re, im): &(f64, f64)| (re - theirs.re_hz).hypot(im - theirs.im_hz) / theirs.re_hz;
        let nearest = (0..left.len()).min_by(|&i, &j| gap(&left[i]).total_cmp(&gap(&left[j])));
        nearest.map_or((f64::NAN, f64::NAN), |i| {
            let ours = left.swap_remove(i);
            (gap(&ours), (ours.1 / theirs.im_hz - 1.0).abs())
        })
    });
    let (gaps, of_decay): (Vec<f64>, Vec<f64>) = pairs.unzip();
    let theirs = of.modes.last().map_or([f64::NAN; 2], |mode| [mode.re_hz, mode.im_hz]);
    let last = ours.last().map_or([f64::NAN; 2], |(re, im)| [*re, *im]);

    Ok(vec![
        case.of("count", &format!("damped modes below {} Hz", of.below_hz)).count(of.modes.len(), certified),
        case.of("frequencies", "complex natural frequency, last [Hz]").numbers(2 * of.modes.len()).row(
            (&theirs, &last),
            (worst(gaps.into_iter()), DifferenceKind::Relative),
            1e-11,
            Bound::Elements,
        ),
        // The imaginary part is some thousandths of the frequency and has the absolute error of the frequency.
        case.of("decay", "its imaginary part alone, last [Hz]").numbers(of.modes.len()).row(
            (&theirs[1..], &last[1..]),
            (worst(of_decay.into_iter()), DifferenceKind::Relative),
            1e-8,
            Bound::Elements,
        ),
    ])
}

/// Compares the responses of all pairs of points of one robot.
fn points(source: &str, of: &PointRobot, toml: &str) -> Result<Comparison> {
    let case = Case::new(Level::Program, source, &format!("{}/points", of.robot), &of.robot);
    let (robot, lengths) = robot(toml)?;
    let rest = statics::forward(&robot, &lengths, StaticModel::Catenary, None)?;
    let highest = of.frequency_hz.iter().copied().fold(0.0, f64::max);
    let dynamics = Dynamics::about(&robot, &rest, Linearisation::default(), highest)?;

    let mut gaps = Vec::new();
    let mut shown = (0.0, 0.0);
    for pair in &of.pairs {
        let signals = [signal(&pair.force, &robot)?, signal(&pair.displacement, &robot)?];
        let ports = Port::all(&robot, &rest, &dynamics, &signals, true)?;
        let ours = response::between(&dynamics, &of.frequency_hz, &ports[0], &ports[1], Quantity::Displacement)?;
        for (k, value) in ours.iter().enumerate() {
            let (re, im) = (pair.response.real[k], pair.response.imag[k]);
            gaps.push((value.re - re).hypot(value.im - im) / re.hypot(im));
            if re.hypot(im) > shown.0 {
                shown = (re.hypot(im), value.norm());
            }
        }
    }

    Ok(case
        .of("responses", &format!("{} responses of points on cables, largest [m/N]", of.pairs.len()))
        .numbers(2 * gaps.len())
        .row((&[shown.0], &[shown.1]), (worst(gaps.into_iter()), DifferenceKind::Relative), 1e-8, Bound::Elements))
}

/// Signal for a point of the reference, at the platform's origin or on a cable.
fn signal(point: &ReferencePoint, robot: &Robot) -> Result<Signal> {
    let direction_w = Vec3::from(point.direction_world);
    Ok(match &point.cable {
        Some(name) => {
            let cable = robot.cables.iter().position(|cable| cable.name == *name).context("a cable of the robot")?;
            Signal::OnCable { cable, fraction: point.fraction, direction_w }
        }
        None => Signal::Along { direction_w, point_p: Vec3::zeros() },
    })
}

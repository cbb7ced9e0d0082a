//! Fig. 7 and Table III of the paper: its dynamic test, with parameters that were identified here because they were not
//! published.

use super::fit::{Fit, Platform, fit};
use super::matching::{Agreement, MAX_DIFFERENCE};
use super::pose::lengths;
use super::published::{DYNAMIC, EXPERIMENT, SPRING, STATIC_SAG};
use crate::figures::style::ModelStyle;
use crate::pages::figure::PageFigure;
use crate::pages::figure::response::{Marks, ResponseCurve, figure};
use crate::pages::table::{PageTable, fixed, listed};
use anyhow::Context as _;
use funicular::cable::{CableModel, SHALLOW_SAG_LIMIT, Sag};
use funicular::dynamics::{Assembly, Dynamics, Linearisation};
use funicular::math::{Mat3, Vec3};
use funicular::modes::{self, Modes};
use funicular::response::{self, Peak, Quantity};
use funicular::robot::{Damping, Robot, WinchMode};
use funicular::statics::{self, StaticModel};

/// Upper limit of the paper's lists [Hz].
const BELOW_HZ: f64 = 10.0;
/// Minimum prominence of a peak [dB]; chosen with knowledge of the published lists.
const PROMINENCE_DB: f64 = 0.5;

/// Names of the cable sets.
const CABLES: [&str; 2] = ["4 mm", "8 mm"];

/// Name of the identified set in tables; its platform is in robots/yuan2014-dynamic-test.toml.
const SET: &str = "4 mm";

/// Start of the fit with 8 mm cables: the nearest platform of a search. With 4 mm cables it is the identified one.
const START_8MM: (f64, [f64; 3], [[f64; 3]; 3]) =
    (88.86, [0.0671, 0.0165, 0.0041], [[1.462, 0.271, -0.425], [0.271, 2.013, -0.076], [-0.425, -0.076, 1.101]]);

/// Results with the identified platform.
pub(crate) struct Outcome {
    robot: Robot,
    peaks: Vec<Peak>,
    natural: Modes,
    static_sag: Modes,
    spring: Modes,
    sags: Vec<f64>,
    curves: Vec<ResponseCurve>,
}

/// Computes the results of the robot of the dynamic test.
///
/// # Errors
/// A robot without equilibrium or without response.
pub(crate) fn outcome(robot: &Robot) -> anyhow::Result<Outcome> {
    let rest = statics::forward(robot, &lengths(robot), StaticModel::Catenary, None)?;
    // Fig. 7 is the acceleration along y per force along z. The paper gives neither the point of the force nor that of
    // the sensor: both are placed at the attachment of cable 3.
    let point_p = robot.cables[2].attachment_p;
    let along = |direction_w: Vec3| response::along(&direction_w, &point_p, &rest.pose);
    let (input, outputs) = (along(Vec3::z()), [along(Vec3::y())]);

    let with = |cable_model| -> anyhow::Result<(Modes, ResponseCurve)> {
        let linearisation = Linearisation {
            cable_model,
            assembly: Assembly::WithoutGeometricStiffness,
            in_plane_only: true,
            winches: WinchMode::AsGiven,
        };
        let dynamics = Dynamics::about(robot, &rest, linearisation, BELOW_HZ)?;
        let found = modes::below(&dynamics, BELOW_HZ);
        let at = (&dynamics, BELOW_HZ, &found.modes[..]);
        let curve = ResponseCurve::of(
            cable_model.name(),
            ModelStyle::of(cable_model),
            at,
            &input,
            &outputs,
            Quantity::Acceleration,
        )?;
        Ok((found, curve))
    };

    let (natural, dynamic) = with(CableModel::ShallowDynamic)?;
    let (static_sag, sag_curve) = with(CableModel::ShallowStatic)?;
    let (spring, spring_curve) = with(CableModel::Spring)?;

    let peaks = dynamic.peaks(PROMINENCE_DB);
    let sags = rest.cables.iter().enumerate().map(|(i, state)| Sag::of(robot, i, state).ratio()).collect();

    let curves = vec![dynamic, sag_curve, spring_curve];
    Ok(Outcome { robot: robot.clone(), peaks, natural, static_sag, spring, sags, curves })
}

/// Fits of the nine frequencies of the two static models, with either cable set.
pub(crate) struct Fits([Fit; 2]);

impl Fits {
    /// Fits both cable sets: robots with 4 mm cables and the identified platform, and with 8 mm cables.
    ///
    /// # Errors
    /// A cable set without equilibrium at its start.
    pub(crate) fn of(robots: [&Robot; 2]) -> anyhow::Result<Self> {
        let identified = &robots[0].platform;
        let (mass, center, [[xx, xy, xz], [yx, yy, yz], [zx, zy, zz]]) = START_8MM;
        let starts = [
            Platform { mass: identified.mass, center_p: identified.center_of_mass_p, inertia_p: identified.inertia_p },
            Platform { mass, center_p: Vec3::from(center), inertia_p: Mat3::new(xx, xy, xz, yx, yy, yz, zx, zy, zz) },
        ];
        let of = |set: usize| {
            fit(robots[set], &starts[set]).with_context(|| format!("{} cables have no equilibrium", CABLES[set]))
        };
        Ok(Self([of(0)?, of(1)?]))
    }

    /// Decimal orders of magnitude by which the 8 mm cables are less likely.
    fn orders(&self) -> f64 {
        self.0[0].evidence - self.0[1].evidence
    }

    /// Table of both fits.
    pub(crate) fn table(&self) -> PageTable {
        let mut table = PageTable::new(
            "table-fit",
            "Platform fitted to the nine printed frequencies of the two static models, with either cable set. A \
             printed tenth has a deviation of 0.03 Hz. Known beforehand: centre of mass within 3 cm, in z 6 cm, of the \
             origin; radii of the second moments 0.1 m within a factor of 2.2; correlations of their products tanh of \
             0 ± 1; nothing of the mass. Deviations are standard deviations. Undetermined: combinations of the ten \
             values that follow from what is known beforehand. Likelihood: probability of the nine frequencies, \
             integrated over all platforms, relative to the other cable set.",
            &[
                "<cables",
                "χ² of nine",
                "with priors",
                "mass|kg",
                "±|kg",
                "centre of mass x, y, z|m",
                "±|m",
                "radii of gyration x, y, z|m",
                "±|m",
                "undetermined",
                "likelihood|log₁₀",
            ],
        );

        for (i, fit) in self.0.iter().enumerate() {
            let center: [f64; 3] = fit.platform.center_p.into();

            table.row(vec![
                CABLES[i].to_owned(),
                fixed(fit.chi2, 2),
                fixed(fit.chi2_with_priors, 1),
                fixed(fit.platform.mass, 1),
                fixed(fit.mass_std, 1),
                listed(&center, 3),
                listed(&fit.center_std, 3),
                listed(&fit.gyration, 3),
                listed(&fit.gyration_std, 3),
                fit.undetermined.to_string(),
                fixed(if i == 0 { self.orders() } else { -self.orders() }, 1),
            ]);
        }
        table
    }

    /// Sentences on what the nine frequencies determine, one per cable set.
    pub(crate) fn sentences(&self) -> [String; 2] {
        let [small, large] = &self.0;
        let millimetres = small.center_std.map(|std| 1e3 * std);
        let relative = small.gyration_std.iter().zip(&small.gyration).map(|(std, radius)| 100.0 * std / radius);

        [
            format!(
                "The 4 mm cables meet all nine printed frequencies of the two static models, and there is no other \
                 natural frequency of these models below {BELOW_HZ} Hz. Printed tenths have a deviation of about 0.03 \
                 Hz. They determine the mass to ± {} kg, the centre of mass to ± {} mm, and the radii of gyration to ± \
                 {} %. They leave {} of the ten values undetermined, mainly of the products of inertia.",
                fixed(small.mass_std, 1),
                listed(&millimetres, 0),
                fixed(relative.fold(0.0, f64::max), 0),
                funicular_study::text::counted(small.undetermined, "combination"),
            ),
            format!(
                "No platform on the 8 mm cables that the search found meets them: the sum of squared deviations stays \
                 at {}, with {} kg, above the largest mass of the paper's static test. Under the same assumptions \
                 about centre and size of the platform the 8 mm cables are less likely by {} orders of magnitude.",
                fixed(large.chi2, 0),
                fixed(large.platform.mass, 0),
                fixed(self.orders(), 0),
            ),
        ]
    }
}

fn frequencies(modes: &Modes) -> Vec<f64> {
    modes.modes.iter().map(|m| m.frequency_hz).collect()
}

impl Outcome {
    /// Figure 7 of the paper.
    pub(crate) fn figure(&self) -> PageFigure {
        let caption = format!(
            "The paper's Fig. 7 with the platform identified by us: acceleration along y per force along z, both at \
             the attachment of cable 3, because the paper does not give the points. Ticks: all natural frequencies \
             with the cable model shallow-dynamic; numbers: peaks of its response with at least {PROMINENCE_DB} dB \
             [Hz]; dashed grey: the paper's peaks with dynamic stiffness."
        );
        let marks = Marks {
            modes: &self.natural.modes,
            peaks: &self.peaks,
            published: Some(("published, dynamic stiffness", &DYNAMIC)),
            phase: false,
        };
        figure("figure-test", caption, "(m/s²)/N", BELOW_HZ, &self.curves, &marks)
    }
}

/// Minimum and maximum of the sags.
fn range(sags: &[f64]) -> (f64, f64) {
    sags.iter().fold((f64::INFINITY, 0.0_f64), |(low, high), sag| (low.min(*sag), high.max(*sag)))
}

/// Sentence on the sag of the cables, compared with the limit of the model shallow-dynamic.
pub(crate) fn sag_text(outcome: &Outcome) -> String {
    let (minimum, maximum) = range(&outcome.sags);
    let range = if maximum <= SHALLOW_SAG_LIMIT {
        "within the limit 1/20 of the model shallow-dynamic"
    } else {
        "partly beyond the limit 1/20 of the model shallow-dynamic: there its lists follow from the formula, but not \
         from a real cable"
    };
    format!("With this set d/l is {} to {}, {range}.", fixed(minimum, 3), fixed(maximum, 3))
}

/// Root mean square of the distance from each published frequency to the nearest computed one [Hz].
fn nearest_rms(published: &[f64], ours: &[f64]) -> f64 {
    let nearest = |f: &f64| ours.iter().map(|other| (other - f).abs()).fold(f64::INFINITY, f64::min);
    (published.iter().map(|f| nearest(f).powi(2)).sum::<f64>() / published.len() as f64).sqrt()
}

/// Root mean square of the distance from a random frequency to the nearest of `count` evenly spaced ones [Hz]: the
/// distance is uniform up to half a step.
fn rms_by_chance(count: usize) -> f64 {
    BELOW_HZ / count as f64 / 12.0_f64.sqrt()
}

/// Sentence on how far the published peaks are from the computed ones, compared with chance.
pub(crate) fn chance_text(outcome: &Outcome) -> String {
    let peaks: Vec<f64> = outcome.peaks.iter().map(|peak| peak.frequency_hz).collect();
    format!(
        "The peaks computed with this set do not meet the published ones: from the peaks of the paper's dynamic model \
         to the nearest computed peak it is {} Hz in the root mean square, from the measured ones {} Hz, and from \
         random frequencies to the nearest of {} evenly spaced ones {} Hz.",
        fixed(nearest_rms(&DYNAMIC, &peaks), 2),
        fixed(nearest_rms(&EXPERIMENT, &peaks), 2),
        peaks.len(),
        fixed(rms_by_chance(peaks.len()), 2),
    )
}

/// Table of the identified parameters.
pub(crate) fn parameters(outcome: &Outcome) -> PageTable {
    let mut table = PageTable::new(
        "table-identified",
        "Parameters of the dynamic test, identified by us and not published: robots/yuan2014-dynamic-test.toml. \
         Inertia: tensor about the centre of mass in platform axes; centre of mass relative to the platform origin; \
         sag divided by chord at the resulting equilibrium.",
        &[
            "<cables",
            "mass|kg",
            "centre of mass x, y, z|m",
            "inertia xx, yy, zz, xy, xz, yz|kg m²",
            "ξ",
            "sag d/l|min to max",
            "cables beyond 1/20",
        ],
    );

    let Outcome { robot, sags, .. } = outcome;
    let (center, inertia): ([f64; 3], _) = (robot.platform.center_of_mass_p.into(), &robot.platform.inertia_p);
    let entries = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)].map(|entry| inertia[entry]);
    let (minimum, maximum) = range(sags);
    let (Damping::Ratio(damping) | Damping::Viscous(damping)) = robot.cables[0].material.damping;
    table.row(vec![
        SET.to_owned(),
        fixed(robot.platform.mass, 2),
        listed(&center, 4),
        listed(&entries, 4),
        fixed(damping, 3),
        format!("{} to {}", fixed(minimum, 3), fixed(maximum, 3)),
        sags.iter().filter(|sag| **sag > SHALLOW_SAG_LIMIT).count().to_string(),
    ]);
    table
}

/// Table III of the paper: each published list above the computed ones.
pub(crate) fn lists(outcome: &Outcome) -> Vec<PageTable> {
    let peaks: Vec<f64> = outcome.peaks.iter().map(|peak| peak.frequency_hz).collect();
    let (sag, spring) = (frequencies(&outcome.static_sag), frequencies(&outcome.spring));
    let list = side_by_side;

    vec![
        list(
            "table-dynamic",
            "peaks with dynamic stiffness. Computed: peaks of the response with the model shallow-dynamic",
            &DYNAMIC,
            &peaks,
        ),
        list(
            "table-experiment",
            "peaks of the experiment, ± 0.1 Hz. Computed: peaks of the response with the model shallow-dynamic",
            &EXPERIMENT,
            &peaks,
        ),
        list(
            "table-shallow-static",
            "quasi-static sagging model. Computed: natural frequencies with the model shallow-static",
            &STATIC_SAG,
            &sag,
        ),
        list("table-spring", "spring model. Computed: natural frequencies with the model spring", &SPRING, &spring),
    ]
}

fn side_by_side(id: &'static str, what: &str, published: &[f64], ours: &[f64]) -> PageTable {
    let mut columns = vec!["<cables".to_owned()];
    columns.extend(published.iter().map(|f| format!("{f:.1}|Hz")));
    columns.extend(["missing", "extra", "<<extra frequencies|Hz", "rms|Hz", "largest|Hz"].map(str::to_owned));
    let columns: Vec<&str> = columns.iter().map(String::as_str).collect();

    let caption = format!(
        "Table III, {what}; below {BELOW_HZ} Hz. Header: the published list. Frequencies are paired in order if they \
         are closer than {MAX_DIFFERENCE} Hz; rms and largest difference are those of the pairs.",
    );
    let mut table = PageTable::new(id, caption, &columns);

    let agreement = Agreement::of(published, ours);
    let mut cells = vec![SET.to_owned()];
    cells.extend(agreement.pairs.iter().map(|(_, ours)| ours.map_or_else(|| "–".to_owned(), |f| fixed(f, 2))));
    cells.extend([
        agreement.missing().to_string(),
        agreement.extra.len().to_string(),
        listed(&agreement.extra, 2),
        fixed(agreement.rms(), 3),
        fixed(agreement.largest(), 2),
    ]);
    table.row(cells);
    table
}

/// Table of all natural frequencies compared with the peaks.
pub(crate) fn counts(outcome: &Outcome) -> PageTable {
    let mut table = PageTable::new(
        "table-counts",
        format!(
            "All natural frequencies below {BELOW_HZ} Hz with the model shallow-dynamic (in plane, counted by \
             Wittrick–Williams), and the number of peaks of the response: two different lists."
        ),
        &["<cables", "natural frequencies", "count", "peaks", "<<all natural frequencies|Hz"],
    );
    let natural = &outcome.natural;
    table.row(vec![
        SET.to_owned(),
        natural.modes.len().to_string(),
        format!("{}, {}", natural.count_below, if natural.certified { "certified" } else { "not certified" }),
        outcome.peaks.len().to_string(),
        listed(&frequencies(natural), 2),
    ]);
    table
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pages::paper::robots;

    /// Every printed frequency of both static models is met to its printed tenth, and there is no other one below 10
    /// Hz.
    #[test]
    fn the_set_meets_the_nine_frequencies_of_the_static_models() {
        let [_, _, test] = robots().unwrap();
        let found = outcome(&test).unwrap();
        let rounds_to = |ours: &[f64], printed: &[f64]| {
            assert_eq!(ours.len(), printed.len(), "{ours:?}");
            for (a, b) in ours.iter().zip(printed) {
                assert!((a - b).abs() <= 0.05, "{ours:?}");
            }
        };
        rounds_to(&frequencies(&found.spring), &SPRING);
        rounds_to(&frequencies(&found.static_sag), &STATIC_SAG);
        assert!(found.natural.certified);
        // The page concludes that the peaks are no nearer than by chance.
        let peaks: Vec<f64> = found.peaks.iter().map(|peak| peak.frequency_hz).collect();
        for published in [&DYNAMIC[..], &EXPERIMENT[..]] {
            assert!(nearest_rms(published, &peaks) > rms_by_chance(peaks.len()), "{peaks:?}");
        }
        assert!(
            !found.peaks.is_empty() && found.figure().to_string().contains("acceleration along y per force along z")
        );
    }

    /// The set on the page is the fit of the 4 mm cables within its deviations, and the 8 mm cables cannot meet the
    /// nine frequencies.
    #[test]
    fn the_nine_frequencies_tell_the_cables_apart() {
        let [_, large, test] = robots().unwrap();
        let fits = Fits::of([&test, &large]).unwrap();
        let [four, eight] = &fits.0;
        assert!(four.chi2 < 0.1 && four.chi2_with_priors < 2.0, "{four:?}");
        assert!(eight.chi2 > 10.0, "{eight:?}");
        assert!(fits.orders() > 4.5, "{}", fits.orders());

        let set = &test.platform;
        assert!((four.platform.mass - set.mass).abs() < 2.0 * four.mass_std, "{four:?}");
        for i in 0..3 {
            let radius = (set.inertia_p[(i, i)] / set.mass).sqrt();
            assert!((four.platform.center_p[i] - set.center_of_mass_p[i]).abs() < 2.0 * four.center_std[i], "{four:?}");
            assert!((four.gyration[i] - radius).abs() < 2.0 * four.gyration_std[i], "{four:?}");
        }

        // The sentences have the numbers of the fits.
        let [of_small, of_large] = fits.sentences();
        assert!(of_small.contains(&fixed(four.mass_std, 1)) && of_large.contains(&fixed(fits.orders(), 0)));
    }
}

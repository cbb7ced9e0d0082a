//! Layout of the numbers of a frame: the name, place and meaning of each, said once.
//!
//! A frame is a list of numbers without names, so whoever reads it has to know the order. The tables here write the
//! numbers, and a test writes page/src/layout.js and the tables of docs/web.md from them.

use funicular::cable::Sag;
use funicular::math::rotation;
use funicular::modes::{Kind, Mode, Modes};
use funicular::robot::{Robot, TensionLimits};
use funicular::statics::{self, CableState, Limit, Stability, TensionMargin, TensionRange};
use funicular_study::at_rest::AtRest;

/// Number of numbers before the cables.
pub const HEADER: usize = count(&header());

/// Numbers per cable.
pub const CABLE: usize = count(&cable());

/// Numbers per mode before the energy fractions of the cables.
pub const MODE: usize = count(&mode());

/// Numbers with one name, taken from `S`.
pub struct Part<S> {
    /// Name on the page.
    pub key: &'static str,
    /// Count of the numbers.
    pub count: usize,
    /// Meaning in the documentation. `KINDS` stands for the numbers of the kinds of modes.
    pub meaning: &'static str,
    write: fn(&S, &mut Vec<f64>),
}

const fn part<S>(key: &'static str, count: usize, meaning: &'static str, write: fn(&S, &mut Vec<f64>)) -> Part<S> {
    Part { key, count, meaning, write }
}

const fn count<S>(parts: &[Part<S>]) -> usize {
    let (mut sum, mut i) = (0, 0);
    while i < parts.len() {
        sum += parts[i].count;
        i += 1;
    }
    sum
}

/// Appends the numbers of a table.
///
/// # Panics
/// A part that does not write as many numbers as it says: all later numbers would be read under wrong names.
pub fn write<S>(parts: &[Part<S>], of: &S, to: &mut Vec<f64>) {
    for part in parts {
        let end = to.len() + part.count;
        (part.write)(of, to);
        assert_eq!(to.len(), end, "count of `{}`", part.key);
    }
}

/// Source of the numbers before the cables.
pub struct Header<'a> {
    /// Equilibrium of the frame.
    pub at_rest: &'a AtRest,
    /// List of modes; none without.
    pub modes: Option<&'a Modes>,
    /// Number of points per cable.
    pub points: usize,
    /// Number of modes in the frame.
    pub shown: usize,
}

impl Header<'_> {
    /// 1 stable, 0 unstable, −1 rigid; and minimum stiffness.
    fn stability(&self) -> (f64, f64) {
        match self.at_rest.equilibrium.stability {
            Stability::Stable { min_stiffness } => (1.0, min_stiffness),
            Stability::Unstable { min_stiffness, .. } => (0.0, min_stiffness),
            Stability::Rigid => (-1.0, f64::NAN),
        }
    }

    fn is_limited(&self) -> bool {
        let AtRest { robot, rule, .. } = self.at_rest;
        rule.is_some() || robot.cables.iter().any(|cable| cable.limits() != TensionLimits::default())
    }

    /// A number of the list of modes; zero without a list.
    fn of_modes(&self, number: impl FnOnce(&Modes) -> f64) -> f64 {
        self.modes.map_or(0.0, number)
    }
}

/// Numbers before the cables.
pub const fn header<'a>() -> [Part<Header<'a>>; 17] {
    [
        part("cables", 1, "count of cables", |of, to| to.push(of.at_rest.robot.cables.len() as f64)),
        part("pointsPerCable", 1, "count of points per cable", |of, to| to.push(of.points as f64)),
        part("modes", 1, "count of modes", |of, to| to.push(of.shown as f64)),
        part("position", 3, "position [m]", |of, to| to.extend(of.at_rest.equilibrium.pose.position_w.iter())),
        part("quaternion", 4, "quaternion w, x, y, z", |of, to| {
            to.extend(rotation::quaternion_wxyz(&of.at_rest.equilibrium.pose.rot_wp));
        }),
        part("angles", 3, "roll, pitch, yaw [degrees]", |of, to| {
            to.extend(rotation::to_roll_pitch_yaw_deg(&of.at_rest.equilibrium.pose.rot_wp));
        }),
        part("residual", 1, "residual", |of, to| to.push(of.at_rest.equilibrium.residual)),
        part("iterations", 1, "iterations", |of, to| to.push(of.at_rest.equilibrium.iterations as f64)),
        part("stability", 1, "stability (1 stable, 0 unstable, −1 rigid)", |of, to| to.push(of.stability().0)),
        part("minStiffness", 1, "minimum stiffness [N/m]", |of, to| to.push(of.stability().1)),
        part("distance", 1, "distance from the requested pose [m], NaN if it is reached", |of, to| {
            to.push(of.at_rest.requested_pose.map_or(f64::NAN, |(_, distance)| distance));
        }),
        part("limited", 1, "1 with tension limits", |of, to| to.push(flag(of.is_limited()))),
        part("unloaded", 1, "1 without any load", |of, to| {
            to.push(flag(statics::is_unloaded(&of.at_rest.robot, &of.at_rest.equilibrium)));
        }),
        part("belowHz", 1, "limit of the list of modes [Hz]", |of, to| to.push(of.of_modes(|list| list.below_hz))),
        part("countBelow", 1, "modes below it", |of, to| to.push(of.of_modes(|list| list.count_below as f64))),
        part("certified", 1, "1 if certified", |of, to| to.push(of.of_modes(|list| flag(list.certified)))),
        part("unstableDirections", 1, "unstable directions", |of, to| {
            to.push(of.of_modes(|list| list.unstable_directions as f64));
        }),
    ]
}

/// Source of the numbers of a cable.
pub struct Cable<'a> {
    state: &'a CableState,
    sag: Sag,
    margin: TensionMargin,
}

impl<'a> Cable<'a> {
    /// Cable `i` of a robot in its state.
    pub fn new(robot: &Robot, i: usize, state: &'a CableState) -> Self {
        let margin = TensionRange::of(robot, i, &state.chord_w()).margin(state);
        Self { state, sag: Sag::of(robot, i, state), margin }
    }

    /// A number that a cable without tension does not have.
    fn taut(&self, value: f64) -> f64 {
        if self.sag.tension > 0.0 { value } else { f64::NAN }
    }

    /// Limit that is reached.
    fn reached(&self) -> f64 {
        match self.margin.reached() {
            None => 0.0,
            Some(Limit::Minimum) => -1.0,
            Some(Limit::Maximum) => 1.0,
        }
    }
}

/// Numbers of a cable.
pub const fn cable<'a>() -> [Part<Cable<'a>>; 16] {
    [
        part("length", 1, "unstrained length [m]", |of, to| to.push(of.state.unstrained_length)),
        part("tension", 1, "tension at the platform [N]", |of, to| to.push(of.state.tension_platform)),
        part("tensionAnchor", 1, "tension at the anchor [N]", |of, to| to.push(of.state.tension_anchor)),
        part("tensionDrum", 1, "tension at the drum [N]", |of, to| to.push(of.state.tension_drum())),
        part("chord", 1, "chord [m]", |of, to| to.push(of.state.chord())),
        part("sagRatio", 1, "sag ratio, NaN without tension", |of, to| to.push(of.taut(of.sag.ratio()))),
        part("lambda2", 1, "λ², NaN without tension", |of, to| to.push(of.taut(of.sag.lambda2))),
        part("stringHz", 1, "string frequency [Hz], NaN without tension", |of, to| {
            to.push(of.taut(of.sag.string_frequency_hz()));
        }),
        part("lowest", 1, "minimum tension anywhere [N]", |of, to| to.push(of.margin.min)),
        part("highest", 1, "maximum tension anywhere [N]", |of, to| to.push(of.margin.max)),
        part("minimum", 1, "lower limit of the tension [N]", |of, to| to.push(of.margin.range.minimum)),
        part("maximum", 1, "upper limit of the tension [N]", |of, to| to.push(of.margin.range.maximum)),
        part("reached", 1, "limit reached (−1 lower, 0 none, 1 upper)", |of, to| to.push(of.reached())),
        part("slack", 1, "1 if slack", |of, to| to.push(flag(of.state.is_slack()))),
        part("attachment", 3, "attachment, world axes [m]", |of, to| to.extend(of.state.attachment_w.iter())),
        part("anchor", 3, "anchor, world axes [m]", |of, to| to.extend(of.state.anchor_w.iter())),
    ]
}

/// Number and word of a kind of modes.
const fn kind(kind: Kind) -> (f64, &'static str) {
    match kind {
        Kind::Platform => (0.0, "platform"),
        Kind::Cable => (1.0, "cable"),
        Kind::Drive => (2.0, "drive"),
        Kind::Mixed => (3.0, "mixed"),
    }
}

/// Numbers of a mode before the energy fractions of the cables.
pub const fn mode() -> [Part<Mode>; 7] {
    [
        part("hz", 1, "frequency [Hz]", |of, to| to.push(of.frequency_hz)),
        part("multiplicity", 1, "multiplicity", |of, to| to.push(of.multiplicity as f64)),
        part("damping", 1, "damping ratio of first order", |of, to| to.push(of.damping_ratio)),
        part("kind", 1, "kind (KINDS)", |of, to| to.push(kind(of.kind).0)),
        part("platformShare", 1, "energy fraction of the platform", |of, to| to.push(of.platform_energy_fraction)),
        part("mass", 1, "modal mass [kg]", |of, to| to.push(of.modal_mass)),
        // `+ 0.0` makes a negative zero positive.
        part("shape", 6, "shape of the platform, as in `modes`", |of, to| to.extend(of.shape.map(|x| x + 0.0).iter())),
    ]
}

fn flag(fact: bool) -> f64 {
    if fact { 1.0 } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fmt::Write;

    /// Kinds of modes in the order of their numbers.
    const KINDS: [Kind; 4] = [Kind::Platform, Kind::Cable, Kind::Drive, Kind::Mixed];

    /// Lines around the generated part of docs/web.md.
    const MARKS: [&str; 2] = ["<!-- layout: begin -->\n", "<!-- layout: end -->"];

    /// Table of JavaScript: names and counts.
    fn script_of<S>(name: &str, meaning: &str, parts: &[Part<S>]) -> String {
        let mut text = format!("/** {meaning} */\nexport const {name} = [\n");
        for part in parts {
            writeln!(text, "  [\"{}\", {}],", part.key, part.count).unwrap();
        }
        text + "];\n"
    }

    fn script() -> String {
        let words: Vec<String> = KINDS.iter().map(|one| format!("\"{}\"", kind(*one).1)).collect();
        [
            "// Layout of the numbers of a frame: names and counts, in their order. Do not edit:\n\
             // `UPDATE_DOCS=1 cargo test -p funicular-wasm layout` writes this file from \
             src/layout.rs of the module.\n"
                .to_owned(),
            script_of("HEADER", "Numbers before the cables.", &header()),
            script_of("CABLE", "Numbers of each cable.", &cable()),
            script_of("MODE", "Numbers of each mode, which the energy fractions of the cables follow.", &mode()),
            format!("/** Kinds of modes, by their numbers. */\nexport const KINDS = [{}];\n", words.join(", ")),
        ]
        .join("\n")
    }

    /// Table of the documentation: places and meanings.
    fn table_of<S>(title: &str, parts: &[Part<S>]) -> String {
        let kinds: Vec<String> = KINDS.iter().map(|one| kind(*one)).map(|(i, word)| format!("{i} {word}")).collect();
        let mut text = format!("| Place | {title} |\n|---|---|\n");
        let mut at = 0;
        for Part { count, meaning, .. } in parts {
            let place = if *count == 1 { at.to_string() } else { format!("{at}–{}", at + count - 1) };
            writeln!(text, "| {place} | {} |", meaning.replace("KINDS", &kinds.join(", "))).unwrap();
            at += count;
        }
        text
    }

    fn documentation() -> String {
        let sizes = format!(
            "\nA frame has {HEADER} numbers, then {CABLE} per cable, then x, y, z of every point, then {MODE} per \
             mode, each followed by\nthe energy fractions of the cables:\n"
        );
        [
            sizes,
            table_of("Numbers of the frame", &header()),
            table_of("Numbers of a cable", &cable()),
            table_of("Numbers of a mode", &mode()) + "\n",
        ]
        .join("\n")
    }

    /// Compares a text with that of a file, or writes the file.
    fn check(file: &str, written: &str, made: &str) {
        if std::env::var_os("UPDATE_DOCS").is_some() {
            std::fs::write(file, made).unwrap();
            return;
        }
        assert!(
            written == made,
            "{file} differs from the layout of a frame; write it anew with `UPDATE_DOCS=1 cargo test -p funicular-wasm \
             layout`"
        );
    }

    #[test]
    fn the_page_reads_the_layout_of_a_frame() {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/page/src/layout.js");
        check(file, &std::fs::read_to_string(file).unwrap_or_default(), &script());
    }

    #[test]
    fn the_documentation_has_the_layout_of_a_frame() {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/web.md");
        let page = std::fs::read_to_string(file).unwrap();
        let (before, rest) = page.split_once(MARKS[0]).unwrap();
        let (_, after) = rest.split_once(MARKS[1]).unwrap();
        check(file, &page, &[before, MARKS[0], &documentation(), MARKS[1], after].concat());
    }

    #[test]
    fn the_number_of_a_kind_is_its_place() {
        for (i, one) in KINDS.iter().enumerate() {
            assert!((kind(*one).0 - i as f64).abs() < f64::EPSILON);
        }
    }
}

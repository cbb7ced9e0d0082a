//! `[materials.NAME]`: properties of a rope. Unused materials are allowed: a file may offer several ropes to choose
//! from.

use super::key::{Absent, Key, Shape};
use super::limits;
use super::range::{MAX_MAGNITUDE, MIN_POSITIVE, Range};
use super::read::{Named, Reader, Section};
use crate::math::Vec3;
use crate::robot::{Damping, Material, RopeDimensions, RopeSection, StretchLoss};
use std::f64::consts::PI;

/// Damping ratio that must not be reached: from here on it is not material damping, and `ω² (1 − 2iξ)` is turned from
/// the real axis by 45°.
const RATIO_LIMIT: f64 = 0.5;

/// Loss factor that must not be reached: with it a rope loses 2π times the energy of its stretch in a cycle. Larger
/// values are per cent.
const LOSS_FACTOR_LIMIT: f64 = 1.0;

/// Damping time that must not be reached [s]: it would give a loss factor of one at 0.16 Hz. Values above are
/// milliseconds.
const DAMPING_TIME_LIMIT: f64 = 1.0;

/// Keys of `[materials.NAME]`.
pub(super) const KEYS: &[Key] = &[
    Key::numeric(
        Shape::Number,
        "youngs_modulus_pa",
        "youngs_modulus_pa = 100e9",
        "Pa",
        Range::Positive,
        "modulus E of the rope; EA is E times the area",
    )
    .without(Absent::Depends(TWO_WAYS)),
    Key::numeric(
        Shape::Number,
        "diameter_m",
        "diameter_m = 0.004",
        "m",
        Range::Positive,
        "diameter of the rope; the modulus then counts for its full circle",
    )
    .without(Absent::Depends(TWO_WAYS)),
    Key::numeric(
        Shape::Number,
        "area_m2",
        "area_m2 = 8e-6",
        "m²",
        Range::Positive,
        "cross-section that the modulus refers to, for wire ropes usually the metal area",
    )
    .without(Absent::Depends(TWO_WAYS)),
    Key::numeric(
        Shape::Number,
        "axial_stiffness_n",
        "axial_stiffness_n = 250e3",
        "N",
        Range::Positive,
        "axial stiffness EA of the rope",
    )
    .without(Absent::Depends(TWO_WAYS)),
    Key::numeric(
        Shape::Number,
        "dynamic_axial_stiffness_n",
        "dynamic_axial_stiffness_n = 400e3",
        "N",
        Range::Positive,
        "axial stiffness of the rope in vibration, which is higher for fibre ropes; equilibria keep the other one",
    )
    .without(Absent::Means("vibration has the stiffness of the equilibrium")),
    Key::numeric(
        Shape::Number,
        "mass_kg_per_m",
        "mass_kg_per_m = 0.06",
        "kg/m",
        Range::NotNegative,
        "mass of the rope per unstrained length",
    ),
    Key::numeric(
        Shape::Number,
        "damping_ratio",
        "damping_ratio = 0.003",
        "1",
        Range::Below(RATIO_LIMIT),
        "damping ratio of moving the rope, not of stretching it, the same at every frequency",
    )
    .or([0.0; 3]),
    Key::numeric(
        Shape::Number,
        "viscous_damping_n_s_m2",
        "viscous_damping_n_s_m2 = 0.01",
        "N s/m²",
        Range::NotNegative,
        "viscous damping of moving the rope per length, not of stretching it",
    )
    .without(Absent::Means("the `damping_ratio` applies; a file gives one of the two")),
    Key::numeric(
        Shape::Number,
        "axial_loss_factor",
        "axial_loss_factor = 0.02",
        "1",
        Range::Below(LOSS_FACTOR_LIMIT),
        "loss factor η of the rope's stretch, the same at every frequency: EA (1 + iη)",
    )
    .or([0.0; 3]),
    Key::numeric(
        Shape::Number,
        "axial_damping_time_s",
        "axial_damping_time_s = 0.8e-3",
        "s",
        Range::Below(DAMPING_TIME_LIMIT),
        "damping time τ of the rope's stretch: EA (1 + iωτ), adds to the loss factor",
    )
    .or([0.0; 3]),
    Key::numeric(
        Shape::Number,
        "minimum_tension_n",
        "minimum_tension_n = 50",
        "N",
        Range::NotNegative,
        "minimum tension of the cables of this rope",
    )
    .without(Absent::Means("no minimum of the file; analyses use a small multiple of the cable's weight")),
    Key::numeric(
        Shape::Number,
        "maximum_tension_n",
        "maximum_tension_n = 5000",
        "N",
        Range::Positive,
        "maximum tension of the cables of this rope",
    )
    .without(Absent::Means("the `breaking_load_n` if it is given, else no maximum")),
    Key::numeric(
        Shape::Number,
        "breaking_load_n",
        "breaking_load_n = 12e3",
        "N",
        Range::Positive,
        "tension at which the rope breaks",
    )
    .without(Absent::Means("unknown")),
    Key::numeric(
        Shape::Number,
        "drag_coefficient",
        "drag_coefficient = 1.2",
        "1",
        Range::NotNegative,
        "drag coefficient of the rope in a wind across it",
    )
    .without(Absent::Means("no drag")),
    Key::numeric(
        Shape::Number,
        "drag_diameter_m",
        "drag_diameter_m = 0.005",
        "m",
        Range::Positive,
        "diameter that the wind meets",
    )
    .without(Absent::Means("the `diameter_m`")),
    Key::numeric(
        Shape::Vector,
        "load_n_per_m",
        "load_n_per_m = [0.0, 0.0, -0.5]",
        "N/m",
        Range::Any,
        "dead load per unstrained length besides the weight, world axes",
    )
    .or([0.0; 3]),
];

const TWO_WAYS: &str = "give `youngs_modulus_pa` with one of `diameter_m` and `area_m2`, or `axial_stiffness_n` alone";

/// Materials by name; `None` for a refused material, whose name is still known.
pub(super) type Materials = Named<Material>;

/// Reads all materials.
pub(super) fn read(reader: &mut Reader, root: &Section) -> Option<Materials> {
    let value = reader.required(root, "materials")?;
    let table = reader.table("materials", "[materials.NAME]", value)?;
    if table.is_empty() {
        reader
            .issue(value.span(), "there is no material")
            .help("add a table [materials.NAME] for every rope, NAME of your choice");
        return None;
    }

    reader.named_tables("materials", "material", value, KEYS, read_one)
}

fn read_one(reader: &mut Reader, name: &str, section: &Section) -> Option<Material> {
    let stiffness = StiffnessKeys::read(reader, section);
    let axial_stiffness = stiffness.axial_stiffness(reader, section);
    let dynamic_axial_stiffness = limits::optional(reader, section, "dynamic_axial_stiffness_n");
    let mass_per_length =
        reader.required(section, "mass_kg_per_m").and_then(|value| reader.number_of(section, "mass_kg_per_m", value));
    let damping = damping(reader, section);
    let loss = ["axial_loss_factor", "axial_damping_time_s"].map(|key| below_limit(reader, section, key));

    let breaking_load = limits::breaking_load(reader, section);
    let tension_limits = limits::read(reader, section);
    if let Some(limits) = tension_limits {
        limits::check(reader, section, limits, breaking_load.flatten());
    }

    let drag = drag(reader, section, stiffness.diameter());
    let load_per_length = reader.vector_or_default(section, "load_n_per_m");

    Some(Material {
        name: name.to_owned(),
        axial_stiffness: axial_stiffness?,
        dynamic_axial_stiffness: dynamic_axial_stiffness?,
        mass_per_length: mass_per_length?,
        damping: damping?,
        stretch_loss: StretchLoss { factor: loss[0]?, time: loss[1]? },
        tension_limits: tension_limits?,
        breaking_load: breaking_load?,
        drag_width: drag?.map(|[coefficient, diameter]| coefficient * diameter),
        load_per_length_w: Vec3::from(load_per_length?),
        dimensions: RopeDimensions { section: stiffness.section(), drag_diameter: drag?.map(|[_, diameter]| diameter) },
    })
}

/// Drag coefficient and diameter [m], if a coefficient is given.
#[expect(clippy::option_option, reason = "outside: refused, an issue is reported; inside: not given")]
fn drag(reader: &mut Reader, section: &Section, rope_diameter: Option<f64>) -> Option<Option<[f64; 2]>> {
    let own = section.get("drag_diameter_m");
    // An issue of the rope's own diameter has been reported together with its stiffness.
    let of_rope = section.get("diameter_m").map(|_| rope_diameter);
    let diameter = own.map(|value| reader.number_of(section, "drag_diameter_m", value)).or(of_rope);

    let Some(value) = section.get("drag_coefficient") else {
        if let Some(own) = own {
            reader
                .issue(own.span(), format!("{} has `drag_diameter_m`, but no `drag_coefficient`", section.label()))
                .help("give both, for a smooth round rope `drag_coefficient = 1.2`");
            return None;
        }
        return Some(None);
    };

    let coefficient = reader.number_of(section, "drag_coefficient", value);
    let Some(diameter) = diameter else {
        reader
            .issue(value.span(), format!("{} has `drag_coefficient`, but no diameter", section.label()))
            .help("give the `drag_diameter_m` that the wind meets");
        return None;
    };
    Some(Some([coefficient?, diameter?]))
}

/// Valid numbers that determine the stiffness of a rope.
struct StiffnessKeys {
    numbers: [Option<f64>; 4],
    /// True if a given number is invalid; the issue has been reported.
    wrong: bool,
}

impl StiffnessKeys {
    const NAMES: [&str; 4] = ["axial_stiffness_n", "youngs_modulus_pa", "diameter_m", "area_m2"];

    /// Reads the numbers first: each invalid number gets its own message.
    fn read(reader: &mut Reader, section: &Section) -> Self {
        let mut wrong = section.mistyped(&Self::NAMES);
        let numbers = Self::NAMES.map(|key| {
            let value = section.get(key)?;
            let number = reader.number_of(section, key, value);
            wrong |= number.is_none();
            number
        });
        Self { numbers, wrong }
    }

    fn diameter(&self) -> Option<f64> {
        self.numbers[2]
    }

    /// Cross-section of the file.
    fn section(&self) -> Option<RopeSection> {
        let [_, _, diameter, area] = self.numbers;
        diameter.map(RopeSection::Diameter).or(area.map(RopeSection::Area))
    }

    /// Axial stiffness EA [N], given in one of the two ways.
    fn axial_stiffness(&self, reader: &mut Reader, section: &Section) -> Option<f64> {
        let Self { numbers, wrong } = *self;
        let keys = Self::NAMES;
        let values = keys.map(|key| section.get(key));

        if let Some(stiffness) = values[0] {
            let mut others = keys.into_iter().zip(values).skip(1);
            if let Some((other, value)) = others.find_map(|(key, value)| Some((key, value?))) {
                reader
                    .issue(value.span(), format!("`{other}` does not go with `axial_stiffness_n`"))
                    .context(stiffness.span(), "already given here")
                    .help(TWO_WAYS);
                return None;
            }
            return numbers[0];
        }

        if let (Some(diameter), Some(area)) = (values[2], values[3]) {
            let mut both = [("diameter_m", diameter.span()), ("area_m2", area.span())];
            both.sort_by_key(|(_, span)| span.start);
            let [(first, first_span), (second, second_span)] = both;
            reader
                .issue(second_span, format!("`{second}` does not go with `{first}`"))
                .context(first_span, "already given here")
                .help(TWO_WAYS);
            return None;
        }

        if wrong {
            return None;
        }

        let label = section.label();
        let missing = match (numbers[1], numbers[2], numbers[3]) {
            (None, None, None) => format!("{label} has no axial stiffness"),
            (None, _, _) => format!("{label} has no `youngs_modulus_pa`"),
            (Some(_), None, None) => {
                format!("{label} has `youngs_modulus_pa`, but neither `diameter_m` nor `area_m2`")
            }
            (Some(modulus), diameter, area) => {
                let area = area.or(diameter.map(|d| PI * d * d / 4.0))?;
                return product_in_limits(reader, section, modulus * area);
            }
        };
        reader.issue(section.span.clone(), missing).help(TWO_WAYS);
        None
    }
}

/// Checks the product E A: both factors may be within the limits and the product not.
fn product_in_limits(reader: &mut Reader, section: &Section, stiffness: f64) -> Option<f64> {
    if (MIN_POSITIVE..=MAX_MAGNITUDE).contains(&stiffness) {
        return Some(stiffness);
    }
    let span = section.get("youngs_modulus_pa").map_or(section.span.clone(), toml::Spanned::span);
    reader
        .issue(
            span,
            format!(
                "the axial stiffness is {stiffness:e} N, it must be between {MIN_POSITIVE:e} and {MAX_MAGNITUDE:e} N"
            ),
        )
        .help("check the units: Pa, and m or m²");
    None
}

fn damping(reader: &mut Reader, section: &Section) -> Option<Damping> {
    let [ratio, viscous] = ["damping_ratio", "viscous_damping_n_s_m2"].map(|key| section.get(key));
    match (ratio, viscous) {
        (Some(ratio), Some(viscous)) => {
            reader
                .issue(viscous.span(), "`viscous_damping_n_s_m2` does not go with `damping_ratio`")
                .context(ratio.span(), "already given here")
                .help("give one of the two");
            None
        }
        (Some(value), None) => {
            let help = "it is a fraction, not per cent: wire ropes have about 0.003";
            reader.number_up_to_limit(section, "damping_ratio", value, help).map(Damping::Ratio)
        }
        (None, Some(value)) => reader.number_of(section, "viscous_damping_n_s_m2", value).map(Damping::Viscous),
        (None, None) => Some(Damping::Ratio(section.default("damping_ratio")[0])),
    }
}

/// Number of the loss of the stretch, or its default.
fn below_limit(reader: &mut Reader, section: &Section, key: &'static str) -> Option<f64> {
    let help = match key {
        "axial_loss_factor" => "it is a fraction, not per cent: 2 % is 0.02",
        _ => "it is in seconds, not milliseconds: 0.8 ms is 0.8e-3",
    };
    let Some(value) = section.get(key) else { return Some(section.default(key)[0]) };
    reader.number_up_to_limit(section, key, value, help)
}

//! Text of a new robot file. Every comment beside a value is that of the table of keys.

use super::layout::rounded;
use super::points::CablePoints;
use super::{NewMotion, RopeType, angles};
use crate::import::draft::file::{WIDTH, comment, float, quoted, vector};
use anyhow::{Result, bail};
use funicular::math::Vec3;
use funicular::robot::Pose;
use funicular::robot::spec::key::{Absent, Key, KeyValue};
use funicular::robot::spec::{TABLES, top_of_file};
use funicular_study::names::Named;
use funicular_study::request::NewRequest;
use funicular_study::text::short;

/// Modulus of a wire rope on its metal area [Pa]: a starting value within the typical catalogue values, 60 to 110 GPa.
const MODULUS: f64 = 100e9;

/// Strength class of the wires [N/mm²], the usual one of EN 12385-4.
const GRADE: f64 = 1770.0;

/// Damping ratio of wire ropes that the reader's messages name.
const DAMPING_RATIO: f64 = 0.003;

/// Mass of an HMPE rope over the square of its diameter [kg/m³] (MoorPy, MoorProps_default.yaml, `hmpe`).
const HMPE_MASS: f64 = 496.0;

/// Minimum breaking load of an HMPE rope over the square of its diameter [N/m²], without the cubic term of the source,
/// which adds 1 % at 10 mm (MoorPy, MoorProps_default.yaml, `hmpe`).
const HMPE_BREAKING_LOAD: f64 = 580e6;

/// Strain at which the linear law of an HMPE rope reaches the breaking load: the largest elongation at break of the
/// fibre, 3 to 4 % (DSM Dyneema, CIS YA100, 2010). MoorPy has EA of 56 breaking loads for a rope in service, and the
/// modulus of the fibre, 109 GPa, would give 96.
const HMPE_STRAIN_AT_BREAK: f64 = 0.04;

/// Damping time of the stretch of an HMPE rope [s]: 473 N s over EA of 614.6 kN, of a braided rope of 4 mm in
/// simulations of kites (KiteModels.jl, settings after U. Fechner's thesis, 2016). No measurement is behind it that was
/// found; for wire ropes and aramid not even such a number was.
const HMPE_DAMPING_TIME: f64 = 0.77e-3;

/// Name of the rope in the file.
const ROPE: &str = "rope";

/// Rope of a new robot.
#[derive(Debug, Clone, Copy)]
pub(super) enum Rope {
    /// Rope of a type with its diameter [m].
    Type { rope: RopeType, diameter: f64 },
    /// Rope with known stiffness EA [N] and mass per length [kg/m].
    Other { axial_stiffness: f64, mass_per_length: f64 },
}

/// Factors C of the metal area, W of the mass and K of the breaking load of a wire rope.
fn wire_factors(rope: RopeType) -> Option<[f64; 3]> {
    match rope {
        RopeType::SixTimes19 => Some([0.449, 0.400, 0.356]),
        RopeType::SevenTimes7 => Some([0.432, 0.384, 0.388]),
        RopeType::Hmpe => None,
    }
}

/// Mass per length [kg/m]: W d² of a wire rope, with W for kg per 100 m and mm.
fn mass_per_length(rope: RopeType, diameter: f64) -> f64 {
    match wire_factors(rope) {
        Some([_, mass, _]) => mass * (diameter * 1e3).powi(2) / 100.0,
        None => HMPE_MASS * diameter * diameter,
    }
}

/// Minimum breaking load [N]: K d² R of a wire rope.
pub(super) fn breaking_load(rope: RopeType, diameter: f64) -> f64 {
    match wire_factors(rope) {
        Some([_, _, load]) => load * (diameter * 1e3).powi(2) * GRADE,
        None => HMPE_BREAKING_LOAD * diameter * diameter,
    }
}

/// Contents of a new robot file except its pose.
pub(super) struct NewFile<'a> {
    pub(super) request: &'a NewRequest,
    /// Mass of the platform [kg].
    pub(super) mass: f64,
    pub(super) rope: Rope,
    pub(super) cables: &'a [CablePoints],
    /// Sides of the box that gives the inertia [m].
    pub(super) box_sides: [f64; 3],
}

impl NewFile<'_> {
    /// Text of the file with a pose as its state.
    ///
    /// # Errors
    /// Attachments without a box around them.
    pub(super) fn text(&self, pose: &Pose) -> Result<String> {
        let mut out = String::new();
        comment(
            &mut out,
            "",
            &format!(
                "Robot file of funicular {}, written by `new`. Its numbers are starting values: replace them \
                 by your own.",
                env!("CARGO_PKG_VERSION")
            ),
        );
        comment(&mut out, "", "docs/robot-file.md explains every key. `funicular parameters FILE` lists every number.");
        comment(
            &mut out,
            "",
            "An editor completes and checks this file if its first line is `#:schema ./robot.schema.json`, a file that \
             `funicular schema -o robot.schema.json` writes.",
        );
        out.push('\n');

        self.root(&mut out);
        self.platform(&mut out, pose)?;
        self.material(&mut out);
        self.all_cables(&mut out);
        // A point mass bears no moment, and every force at its own point.
        let unused: &[&str] =
            if self.request.motion == NewMotion::PointMass { &["moment_n_m", "point_m"] } else { &[] };
        FileSection::new(&mut out, "[loads]").rest(unused);
        FileSection::new(&mut out, "[wind]").rest(&[]);
        self.state(&mut out, pose);
        Ok(out)
    }

    /// Height of the lowest point of the platform in a pose [m]: of an attachment, or of a corner of the given box.
    pub(super) fn lowest_point(&self, pose: &Pose) -> f64 {
        let attachments = self.cables.iter().map(|cable| cable.attachment);
        attachments
            .chain(self.request.box_m.into_iter().flat_map(corners))
            .map(|point| (pose.position_w + pose.rot_wp * point).z)
            .fold(pose.position_w.z, f64::min)
    }

    fn root(&self, out: &mut String) {
        let name = self.request.name.as_deref().unwrap_or("new robot");
        let source = match &self.request.from_csv {
            Some(csv) => format!("points from {}; other numbers are starting values", csv.name()),
            None => "starting values".to_owned(),
        };
        let mut root = FileSection { out, header: top_of_file().header };
        root.value("name", &quoted(name));
        root.value("source", &quoted(&source));
        root.rest(&["name", "source"]);
    }

    fn platform(&self, out: &mut String, pose: &Pose) -> Result<()> {
        let motion = self.request.motion;
        let mut section = FileSection::new(out, "[platform]");
        section.value("mass_kg", &float(self.mass));
        section.value("motion", &quoted(motion.name()));

        if motion == NewMotion::PointMass {
            if self.request.box_m.is_some() {
                bail!("a point mass has no box and no inertia: leave ⟪box_m⟫ out, or give ⟪motion⟫ rigid");
            }
            let absent = ["plane_offset_m", "center_of_mass_m", "rotational_damping_n_m_s"];
            section.rest(&[&["mass_kg", "motion"][..], &absent].concat());
            return Ok(());
        }

        let offset = match motion {
            NewMotion::PlanarXz => pose.position_w.y,
            NewMotion::PlanarXy => pose.position_w.z,
            NewMotion::Rigid | NewMotion::PointMass => 0.0,
        };
        if offset != 0.0 {
            section.value("plane_offset_m", &float(offset));
        }
        section
            .note(&format!("Moments of a homogeneous box, m(b² + c²)/12 and so on, of {} m.", sides(self.box_sides)));
        section.value("inertia_kg_m2", &self.inertia()?);
        let unused = if motion == NewMotion::Rigid { "plane_offset_m" } else { "" };
        let given = if offset == 0.0 { "" } else { "plane_offset_m" };
        section.rest(&["mass_kg", "motion", "inertia_kg_m2", unused, given]);
        Ok(())
    }

    /// Principal moments of the box, or for a planar platform the moment about the normal of its plane.
    fn inertia(&self) -> Result<String> {
        // Rounding the second moments and not their sums keeps the moments of a flat box possible.
        let second = self.box_sides.map(|side| digits(self.mass * side * side / 12.0, 4));
        let [xx, yy, zz] = [second[1] + second[2], second[0] + second[2], second[0] + second[1]];
        let about_normal = match self.request.motion {
            NewMotion::PlanarXz => Some(yy),
            NewMotion::PlanarXy => Some(zz),
            NewMotion::Rigid | NewMotion::PointMass => None,
        };
        if about_normal.unwrap_or(xx.min(yy).min(zz)) <= 0.0 {
            bail!(
                "the attachments span no box, {} m: give the sides of the platform's box in ⟪box_m⟫, or ⟪motion⟫ \
                 point-mass if all cables end in one point",
                sides(self.box_sides)
            );
        }
        // Ten digits are more than the sums of numbers with four have, and fewer than rounding has.
        let short = |moment: f64| float(digits(moment, 10));
        Ok(about_normal.map_or_else(|| format!("[{}, {}, {}]", short(xx), short(yy), short(zz)), short))
    }

    fn material(&self, out: &mut String) {
        let mut section = FileSection::new(out, "[materials.NAME]");
        // The drag diameter alone is refused, and so is a drag coefficient without a diameter.
        let mut given = vec!["drag_coefficient", "drag_diameter_m"];

        match self.rope {
            Rope::Type { rope, diameter } => {
                given.extend(match wire_factors(rope) {
                    Some([area, ..]) => wire_stiffness(&mut section, rope, diameter, area),
                    None => fibre_stiffness(&mut section, rope, diameter),
                });
                section.value("mass_kg_per_m", &float(digits(mass_per_length(rope, diameter), 6)));
                section.value("damping_ratio", &float(DAMPING_RATIO));
                section.value("breaking_load_n", &float(digits(breaking_load(rope, diameter), 4)));
                given.extend(["mass_kg_per_m", "damping_ratio", "breaking_load_n"]);
                if rope == RopeType::Hmpe {
                    section.note(
                        "The damping time of the stretch is a parameter of kite simulations (KiteModels.jl), not a \
                         measured one: fit it with `identify`.",
                    );
                    section.value("axial_damping_time_s", &float(HMPE_DAMPING_TIME));
                    given.push("axial_damping_time_s");
                }
            }
            Rope::Other { axial_stiffness, mass_per_length } => {
                section.value("axial_stiffness_n", &float(axial_stiffness));
                section.value("mass_kg_per_m", &float(mass_per_length));
                given.extend(["axial_stiffness_n", "mass_kg_per_m"]);
            }
        }
        section.rest(&given);
    }

    fn all_cables(&self, out: &mut String) {
        for (i, cable) in self.cables.iter().enumerate() {
            let mut section = FileSection::new(out, "[[cables]]");
            let values = [
                ("name", Some(quoted(&cable.name))),
                ("material", Some(quoted(ROPE))),
                ("anchor_m", Some(vector(&cable.anchor))),
                ("attachment_m", (self.request.motion != NewMotion::PointMass).then(|| vector(&cable.attachment))),
            ];
            // The first cable explains the keys of all.
            for (key, value) in values.iter().filter_map(|(key, value)| Some((*key, value.as_ref()?))) {
                if i == 0 { section.value(key, value) } else { section.plain(key, value) }
            }
            if i == 0 {
                // Pulleys, winches and supports need tables of their own.
                let drives = ["pulley", "entry_direction", "winch", "support"];
                section.rest(&[&["name", "material", "anchor_m", "attachment_m"][..], &drives[..]].concat());
            }
        }
    }

    fn state(&self, out: &mut String, pose: &Pose) {
        let mut section = FileSection::new(out, "[state]");
        section.value("position_m", &vector(&pose.position_w.map(rounded)));
        let angles = angles(pose);
        if self.request.motion == NewMotion::PointMass {
            return;
        }
        if angles == Vec3::zeros() {
            section.rest(&["position_m"]);
        } else {
            section.value("roll_pitch_yaw_deg", &vector(&angles));
        }
    }
}

/// Table of the file that is being written.
struct FileSection<'o> {
    out: &'o mut String,
    header: &'static str,
}

impl<'o> FileSection<'o> {
    /// Begins a table.
    fn new(out: &'o mut String, header: &'static str) -> Self {
        add_line(out, "");
        add_line(out, &header.replace("NAME", ROPE));
        Self { out, header }
    }

    /// Keys that a table may have.
    fn keys(&self) -> &'static [Key] {
        TABLES.iter().find(|table| table.header == self.header).map_or(&[], |table| table.keys)
    }

    /// Writes a comment of its own.
    fn note(&mut self, text: &str) {
        comment(self.out, "", text);
    }

    /// Writes a value with the meaning of its key.
    fn value(&mut self, key: &str, value: &str) {
        let about = self.keys().iter().find(|known| known.name == key).map(about).unwrap_or_default();
        self.line(&format!("{key} = {value}"), &about);
    }

    /// Writes a value without a comment.
    fn plain(&mut self, key: &str, value: &str) {
        add_line(self.out, &format!("{key} = {value}"));
    }

    /// Writes the examples of the keys that are left out, as comments.
    fn rest(&mut self, given: &[&str]) {
        for key in self.keys() {
            let is_value = !matches!(key.value, KeyValue::Table | KeyValue::Tables | KeyValue::NamedTables);
            let optional = !matches!(key.absent, Absent::Refused | Absent::Depends(_));
            if is_value && optional && !given.contains(&key.name) {
                self.line(&format!("# {}", key.example), &about(key));
            }
        }
    }

    /// Writes a line with its comment beside it, or above it if there is no room.
    fn line(&mut self, line: &str, about: &str) {
        if line.chars().count() + about.chars().count() + 4 <= WIDTH {
            add_line(self.out, &format!("{line}  # {about}"));
        } else {
            comment(self.out, "", about);
            add_line(self.out, line);
        }
    }
}

/// Writes the stiffness of a wire rope by its metal area, and says where its numbers come from. Returns the keys.
fn wire_stiffness(section: &mut FileSection, rope: RopeType, diameter: f64, area: f64) -> &'static [&'static str] {
    section.note(&format!(
        "Wire rope {}, {} mm: metal area C d², mass W d² and breaking load K d² R with the factors of EN 12385 and R = \
         {GRADE} N/mm². The modulus on the metal area is a starting value: replace it by that of your rope.",
        rope.name(),
        short(diameter * 1e3, 4)
    ));
    section.value("youngs_modulus_pa", &format!("{MODULUS:e}"));
    section.value("area_m2", &float(digits(area * diameter * diameter, 6)));
    &["youngs_modulus_pa", "area_m2"]
}

/// Writes the cautious stiffness of an HMPE rope, and says where its numbers come from. Returns the key.
fn fibre_stiffness(section: &mut FileSection, rope: RopeType, diameter: f64) -> &'static [&'static str] {
    let (mm, strain) = (short(diameter * 1e3, 4), HMPE_STRAIN_AT_BREAK);
    for note in [
        format!(
            "Braided HMPE rope (as Dyneema), {mm} mm. Mass {HMPE_MASS} kg/m³ d² and breaking load {} N/mm² d²: MoorPy, \
             MoorProps_default.yaml, `hmpe`.",
            short(HMPE_BREAKING_LOAD * 1e-6, 4)
        ),
        format!(
            "The stiffness is cautious: breaking load / {strain}, because the fibre breaks at a strain of at most \
             {strain} (DSM Dyneema, CIS YA100, 2010). A rope in service is about twice as stiff. Low frequencies and \
             large displacements are on the safe side, differences of tension between cables are not: replace the \
             value by that of your rope."
        ),
        "MoorPy's numbers are those of mooring ropes, tens of millimetres thick: below that they are extrapolated. The \
         damping ratio is that of wire ropes, because no measurement of such a rope was found."
            .to_owned(),
    ] {
        section.note(&note);
    }
    section.value("axial_stiffness_n", &float(digits(breaking_load(rope, diameter) / strain, 4)));
    &["axial_stiffness_n"]
}

/// Adds a line of the file.
fn add_line(out: &mut String, line: &str) {
    out.push_str(line);
    out.push('\n');
}

/// Meaning and unit of a key.
fn about(key: &Key) -> String {
    match key.each_number() {
        Some(numbers) if numbers.unit != "1" => format!("{} [{}]", key.about, numbers.unit),
        _ => key.about.to_owned(),
    }
}

/// Corners of a box around the origin of the platform.
fn corners(sides: [f64; 3]) -> [Vec3; 8] {
    let half = |corner: usize, axis: usize| if corner >> axis & 1 == 0 { -0.5 } else { 0.5 } * sides[axis];
    std::array::from_fn(|corner| Vec3::from_fn(|axis, _| half(corner, axis)))
}

/// Sides of a box in words.
fn sides(sides: [f64; 3]) -> String {
    sides.map(|side| short(side, 4)).join(" × ")
}

/// Number with `count` significant digits.
fn digits(value: f64, count: usize) -> f64 {
    format!("{value:.*e}", count.saturating_sub(1)).parse().unwrap_or(value)
}

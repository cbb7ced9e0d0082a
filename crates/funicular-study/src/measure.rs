//! Catalogue of the numbers that `gradient`, `uncertainty`, `map`, `sweep` and `design` name, value and differentiate.
//!
//! A [`Measure`] is said once here: its names, its unit, its value and its gradient. Values and gradients of vibration
//! come from the modes and responses that each command has anyway.

use funicular::gradient::{GradientError, Gradients};
use funicular::robot::{Pose, Robot, RobotChange};
use funicular::statics::{Equilibrium, LoadCapacity};
use serde_json::{Value, json};

/// Result of a robot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Measure {
    /// Component of the pose: position, then rotation vector from the equilibrium of the undisturbed robot.
    Pose(usize),
    /// Unstrained length of a cable.
    Length(usize),
    /// Tension of a cable at one of its places.
    Tension(usize, TensionPlace),
    /// Unstrained length of all ropes.
    RopeLength,
    /// Mass of all ropes.
    RopeMass,
    /// Minimum stiffness.
    MinStiffness,
    /// Largest multiple of the required loads.
    LoadFactor,
    /// Natural frequency, by its number in the ascending list, from 0.
    Frequency(usize),
    /// Entry of the block of modes that share a frequency: first and last mode, then the two modes of the entry, from
    /// 0.
    SharedFrequency { first: usize, last: usize, entry: [usize; 2] },
    /// Damping ratio of the mode with this number, from 0.
    Damping(usize),
    /// Part of the response at a frequency [Hz].
    Response(f64, ResponsePart),
}

/// Group of results, as requests name it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum MeasureGroup {
    Pose,
    Lengths,
    Tensions,
    RopeLength,
    RopeMass,
    MinStiffness,
    LoadFactor,
    Frequencies,
    Damping,
    Response,
}

impl MeasureGroup {
    /// All groups, in the order of results.
    pub(crate) const ALL: [Self; 10] = [
        Self::Pose,
        Self::Lengths,
        Self::Tensions,
        Self::RopeLength,
        Self::RopeMass,
        Self::MinStiffness,
        Self::LoadFactor,
        Self::Frequencies,
        Self::Damping,
        Self::Response,
    ];

    /// Name in requests.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Pose => "pose",
            Self::Lengths => "lengths",
            Self::Tensions => "tensions",
            Self::RopeLength => "rope-length",
            Self::RopeMass => "rope-mass",
            Self::MinStiffness => "stiffness-min",
            Self::LoadFactor => "load-factor",
            Self::Frequencies => "frequencies",
            Self::Damping => "damping",
            Self::Response => "response",
        }
    }

    /// True for results of modes, which end at a limit of the frequencies.
    pub(crate) fn is_of_modes(self) -> bool {
        matches!(self, Self::Frequencies | Self::Damping)
    }

    /// Results of the group at an equilibrium: the pose by these components, tensions at these places. None for
    /// vibration.
    pub(crate) fn of_statics(self, robot: &Robot, components: &[usize], places: &[TensionPlace]) -> Vec<Measure> {
        match self {
            Self::Pose => components.iter().copied().map(Measure::Pose).collect(),
            Self::Lengths => Measure::lengths(robot),
            Self::Tensions => places.iter().flat_map(|place| Measure::tensions(robot, *place)).collect(),
            Self::RopeLength => vec![Measure::RopeLength],
            Self::RopeMass => vec![Measure::RopeMass],
            Self::MinStiffness => vec![Measure::MinStiffness],
            Self::LoadFactor => vec![Measure::LoadFactor],
            Self::Frequencies | Self::Damping | Self::Response => Vec::new(),
        }
    }
}

/// Place of a tension.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum TensionPlace {
    Platform,
    Anchor,
    Drum,
}

impl TensionPlace {
    fn name(self) -> &'static str {
        match self {
            Self::Platform => "platform",
            Self::Anchor => "anchor",
            Self::Drum => "drum",
        }
    }
}

/// Part of a complex response.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ResponsePart {
    Real,
    Imaginary,
    /// In decibels of the unit of the response.
    Magnitude,
    /// In degrees.
    Phase,
}

impl ResponsePart {
    fn name(self) -> &'static str {
        match self {
            Self::Real => "real",
            Self::Imaginary => "imaginary",
            Self::Magnitude => "magnitude",
            Self::Phase => "phase",
        }
    }
}

/// Axes of the components of a pose.
const AXES: [&str; 3] = ["x", "y", "z"];

impl Measure {
    /// Name in tables and messages.
    pub(crate) fn name(self, robot: &Robot) -> String {
        let cable = |i: usize| &robot.cables[i].name;
        match self {
            Self::Pose(k) if k < 3 => AXES[k].to_owned(),
            Self::Pose(k) => format!("rotation about {}", AXES[k - 3]),
            Self::Length(i) => format!("length of cable \"{}\"", cable(i)),
            Self::Tension(i, place) => format!("tension of cable \"{}\" at the {}", cable(i), place.name()),
            Self::RopeLength => "length of all ropes".to_owned(),
            Self::RopeMass => "mass of all ropes".to_owned(),
            Self::MinStiffness => "minimum stiffness".to_owned(),
            Self::LoadFactor => "load factor".to_owned(),
            Self::Frequency(k) => format!("frequency {}", k + 1),
            Self::SharedFrequency { first, last, entry: [i, j] } => {
                format!("frequencies {} to {}, entry {}, {}", first + 1, last + 1, i + 1, j + 1)
            }
            Self::Damping(k) => format!("damping ratio {}", k + 1),
            Self::Response(hz, part @ (ResponsePart::Real | ResponsePart::Imaginary)) => {
                format!("response at {hz} Hz, {} part", part.name())
            }
            Self::Response(hz, part) => format!("{} of the response at {hz} Hz", part.name()),
        }
    }

    /// Name of a column with its unit, as in files of maps and sweeps.
    pub(crate) fn column(self, robot: &Robot) -> String {
        let cable = |i: usize| &robot.cables[i].name;
        match self {
            Self::Pose(k) if k < 3 => format!("pose_{}_m", AXES[k]),
            Self::Pose(k) => format!("pose_rotation_{}_rad", AXES[k - 3]),
            Self::Length(i) => format!("unstrained_length_{}_m", cable(i)),
            Self::Tension(i, place) => format!("tension_{}_{}_n", place.name(), cable(i)),
            Self::RopeLength => "rope_length_m".to_owned(),
            Self::RopeMass => "rope_mass_kg".to_owned(),
            Self::MinStiffness => "stiffness_min_n_per_m".to_owned(),
            Self::LoadFactor => "load_factor".to_owned(),
            Self::Frequency(k) => format!("frequency_{}_hz", k + 1),
            Self::SharedFrequency { entry: [i, j], .. } => format!("frequency_{}_{}_hz", i + 1, j + 1),
            Self::Damping(k) => format!("damping_ratio_{}", k + 1),
            Self::Response(hz, ResponsePart::Magnitude) => format!("response_at_{hz}_hz_db"),
            Self::Response(hz, ResponsePart::Phase) => format!("response_at_{hz}_hz_phase_deg"),
            Self::Response(hz, part) => format!("response_at_{hz}_hz_{}", part.name()),
        }
    }

    /// Identity as data: `kind`, and the cable, mode or frequency to which the result belongs. Modes count from 1.
    pub(crate) fn identity(self, robot: &Robot) -> Value {
        let cable = |i: usize| &robot.cables[i].name;
        match self {
            Self::Pose(k) if k < 3 => json!({ "kind": "position", "axis": AXES[k] }),
            Self::Pose(k) => json!({ "kind": "rotation", "axis": AXES[k - 3] }),
            Self::Length(i) => json!({ "kind": "length", "cable": cable(i) }),
            Self::Tension(i, place) => json!({ "kind": "tension", "cable": cable(i), "place": place.name() }),
            Self::RopeLength => json!({ "kind": "rope-length" }),
            Self::RopeMass => json!({ "kind": "rope-mass" }),
            Self::MinStiffness => json!({ "kind": "stiffness-min" }),
            Self::LoadFactor => json!({ "kind": "load-factor" }),
            Self::Frequency(k) => json!({ "kind": "frequency", "mode": k + 1 }),
            Self::SharedFrequency { first, last, entry: [i, j] } => {
                json!({ "kind": "shared-frequency", "modes": [first + 1, last + 1], "entry": [i + 1, j + 1] })
            }
            Self::Damping(k) => json!({ "kind": "damping", "mode": k + 1 }),
            Self::Response(hz, part) => json!({ "kind": "response", "at_hz": hz, "part": part.name() }),
        }
    }

    /// Unit; that of real and imaginary part of a response depends on its signals.
    pub(crate) fn unit(self) -> &'static str {
        match self {
            Self::Pose(k) if k >= 3 => "rad",
            Self::Pose(_) | Self::Length(_) | Self::RopeLength => "m",
            Self::RopeMass => "kg",
            Self::Tension(..) => "N",
            Self::MinStiffness => "N/m",
            Self::Frequency(_) | Self::SharedFrequency { .. } => "Hz",
            Self::LoadFactor | Self::Damping(_) => "1",
            Self::Response(_, ResponsePart::Magnitude) => "dB",
            Self::Response(_, ResponsePart::Phase) => "degrees",
            Self::Response(..) => "",
        }
    }

    /// Frequency of a response [Hz].
    pub(crate) fn at_hz(self) -> Option<f64> {
        match self {
            Self::Response(hz, _) => Some(hz),
            _ => None,
        }
    }

    /// Number of the mode, from 0, for results of a mode.
    pub(crate) fn mode(self) -> Option<usize> {
        match self {
            Self::Frequency(k) | Self::Damping(k) => Some(k),
            _ => None,
        }
    }

    /// Lengths of all cables.
    pub(crate) fn lengths(robot: &Robot) -> Vec<Self> {
        (0..robot.cables.len()).map(Self::Length).collect()
    }

    /// Tensions of all cables at a place.
    pub(crate) fn tensions(robot: &Robot, place: TensionPlace) -> Vec<Self> {
        (0..robot.cables.len()).map(|i| Self::Tension(i, place)).collect()
    }

    /// Value at an equilibrium; `None` for results of vibration, and for the stiffness of rigid cables. Rotations count
    /// from the undisturbed pose.
    pub(crate) fn static_value(self, robot: &Robot, rest: &Equilibrium, undisturbed: &Pose) -> Option<f64> {
        let cable = |i: usize| rest.cables.get(i);
        let lengths = || rest.cables.iter().map(|cable| cable.unstrained_length);
        match self {
            Self::Pose(k) if k < 3 => Some(rest.pose.position_w[k]),
            Self::Pose(k) => Some((rest.pose.rot_wp * undisturbed.rot_wp.inverse()).scaled_axis()[k - 3]),
            Self::Length(i) => cable(i).map(|cable| cable.unstrained_length),
            Self::Tension(i, TensionPlace::Platform) => cable(i).map(|cable| cable.tension_platform),
            Self::Tension(i, TensionPlace::Anchor) => cable(i).map(|cable| cable.tension_anchor),
            Self::Tension(i, TensionPlace::Drum) => cable(i).map(funicular::statics::CableState::tension_drum),
            Self::RopeLength => Some(lengths().sum()),
            Self::RopeMass => {
                Some(lengths().zip(&robot.cables).map(|(l, cable)| l * cable.material.mass_per_length).sum())
            }
            Self::MinStiffness => rest.stability.min_stiffness(),
            Self::LoadFactor => {
                let capacity = LoadCapacity::at(robot, &rest.pose, rest.model, None).ok()?;
                capacity.load_factor_value().ok()
            }
            Self::Frequency(_) | Self::SharedFrequency { .. } | Self::Damping(_) | Self::Response(..) => None,
        }
    }

    /// Gradients of measures at an equilibrium, each family of them computed once; `None` for results of vibration.
    pub(crate) fn static_gradients(
        measures: &[Self],
        gradients: &Gradients,
    ) -> Vec<Option<Result<RobotChange, GradientError>>> {
        let if_any = |wanted: fn(&Self) -> bool, all: &dyn Fn() -> Vec<RobotChange>| {
            if measures.iter().any(wanted) { all() } else { Vec::new() }
        };
        let pose = if_any(|of| matches!(of, Self::Pose(_)), &|| gradients.pose().to_vec());
        let lengths = if_any(|of| matches!(of, Self::Length(_)), &|| gradients.lengths());
        let at_platform =
            if_any(|of| matches!(of, Self::Tension(_, TensionPlace::Platform)), &|| gradients.tensions_platform());
        let at_anchor =
            if_any(|of| matches!(of, Self::Tension(_, TensionPlace::Anchor)), &|| gradients.tensions_anchor());
        let at_drum = if_any(|of| matches!(of, Self::Tension(_, TensionPlace::Drum)), &|| gradients.tensions_drum());

        let gradient = |measure: &Self| match *measure {
            Self::Pose(k) => Some(Ok(pose[k].clone())),
            Self::Length(i) => Some(Ok(lengths[i].clone())),
            Self::Tension(i, TensionPlace::Platform) => Some(Ok(at_platform[i].clone())),
            Self::Tension(i, TensionPlace::Anchor) => Some(Ok(at_anchor[i].clone())),
            Self::Tension(i, TensionPlace::Drum) => Some(Ok(at_drum[i].clone())),
            Self::RopeLength => Some(Ok(gradients.rope_length())),
            Self::RopeMass => Some(Ok(gradients.rope_mass())),
            Self::MinStiffness => Some(gradients.min_stiffness()),
            Self::LoadFactor => Some(gradients.load_factor().map(|found| found.gradient)),
            Self::Frequency(_) | Self::SharedFrequency { .. } | Self::Damping(_) | Self::Response(..) => None,
        };
        measures.iter().map(gradient).collect()
    }
}

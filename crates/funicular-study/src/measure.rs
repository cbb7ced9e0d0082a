//! Catalogue of the numbers that `gradient`, `uncertainty`, `map`, `sweep` and `design` name, value and differentiate.
//!
//! A [`Measure`] is said once here: its names, its unit, its value and its gradient; one of a whole robot or of each
//! cable is a row of [`MEASURES`]. Values and gradients of vibration come from the modes and responses that each
//! command has anyway.

use funicular::gradient::{GradientError, Gradients};
use funicular::robot::{Pose, Robot, RobotChange};
use funicular::statics::{CableState, Equilibrium, LoadCapacity};
use serde_json::{Value, json};

/// Result of a robot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Measure {
    /// Component of the pose: position, then rotation vector from the equilibrium of the undisturbed robot.
    Pose(usize),
    /// Number of the cable with this index.
    Cable(&'static CableMeasure, usize),
    /// Number of the whole robot.
    Robot(&'static RobotMeasure),
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

/// Number of the whole robot at rest. Its row in [`MEASURES`] says all about it; requests, tables, maps, derivatives,
/// uncertainties and designs follow.
#[derive(Debug)]
pub(crate) struct RobotMeasure {
    /// Name in requests, and that of its quantity.
    pub(crate) key: &'static str,
    /// Name in tables and messages.
    pub(crate) name: &'static str,
    /// Name of its column.
    pub(crate) column: &'static str,
    pub(crate) unit: &'static str,
    /// Quantity of maps; none for a number that the table of quantities computes in another way.
    pub(crate) quantity: Option<MeasureQuantity>,
    /// Goal of designs; none for a number that no design improves, or that has a search of its own.
    pub(crate) goal: Option<MeasureGoal>,
    /// Value; none where the number does not exist.
    pub(crate) value: fn(&Robot, &Equilibrium) -> Option<f64>,
    pub(crate) gradient: fn(&Gradients<'_>) -> Result<RobotChange, GradientError>,
}

/// Number of each cable at rest.
#[derive(Debug)]
pub(crate) struct CableMeasure {
    /// Name of its quantity in maps.
    pub(crate) key: &'static str,
    /// Kind in data.
    kind: &'static str,
    /// Place of a tension.
    place: Option<TensionPlace>,
    /// Name of its columns, with {} for that of the cable.
    column: &'static str,
    pub(crate) unit: &'static str,
    pub(crate) quantity: MeasureQuantity,
    value: fn(&CableState) -> f64,
    gradients: fn(&Gradients<'_>) -> Vec<RobotChange>,
}

/// Quantity of maps and sweeps that shows a measure.
#[derive(Debug, Clone, Copy)]
pub(crate) struct MeasureQuantity {
    /// Meaning, in one line.
    pub(crate) about: &'static str,
    /// Meaning of its column, in the words of docs/sweeps.md.
    pub(crate) documentation: &'static str,
    /// True for a quantity that only cables that stretch have.
    pub(crate) is_elastic: bool,
}

/// Goal of a design.
#[derive(Debug, Clone, Copy)]
pub(crate) struct MeasureGoal {
    /// Sign of an improvement.
    pub(crate) sign: f64,
    /// Meaning, for help texts.
    pub(crate) about: &'static str,
}

// The key is the name, which no other measure has.
impl PartialEq for RobotMeasure {
    fn eq(&self, other: &Self) -> bool {
        self.key == other.key
    }
}

impl PartialEq for CableMeasure {
    fn eq(&self, other: &Self) -> bool {
        self.key == other.key
    }
}

/// Group of results, as requests name it.
#[derive(Debug, PartialEq)]
pub(crate) enum MeasureGroup {
    Pose,
    /// Numbers of each cable.
    Cables {
        name: &'static str,
        measures: &'static [CableMeasure],
    },
    Robot(&'static RobotMeasure),
    Frequencies,
    Damping,
    Response,
}

/// Unstrained length of a cable.
const LENGTH: CableMeasure = CableMeasure {
    key: "lengths",
    kind: "length",
    place: None,
    column: "unstrained_length_{}_m",
    unit: "m",
    quantity: MeasureQuantity {
        about: "unstrained length of every cable",
        documentation: "`unstrained_length_NAME_m`: unstrained length of every cable",
        is_elastic: false,
    },
    value: |cable| cable.unstrained_length,
    gradients: |at| at.lengths(),
};

/// Tensions of a cable, from the platform to the winch.
const TENSIONS: [CableMeasure; 3] = [
    CableMeasure {
        key: "tensions",
        kind: "tension",
        place: Some(TensionPlace::Platform),
        column: "tension_platform_{}_n",
        unit: "N",
        quantity: MeasureQuantity {
            about: "tension of every cable at its platform end",
            documentation: "`tension_platform_NAME_n`: tension of every cable at its platform end",
            is_elastic: false,
        },
        value: |cable| cable.tension_platform,
        gradients: |at| at.tensions_platform(),
    },
    CableMeasure {
        key: "exit-tensions",
        kind: "tension",
        place: Some(TensionPlace::Anchor),
        column: "tension_anchor_{}_n",
        unit: "N",
        quantity: MeasureQuantity {
            about: "tension of every cable where it leaves its anchor or pulley",
            documentation: "`tension_anchor_NAME_n`: tension of every cable at its anchor, over a pulley at the exit \
                            point",
            is_elastic: false,
        },
        value: |cable| cable.tension_anchor,
        gradients: |at| at.tensions_anchor(),
    },
    CableMeasure {
        key: "drum-tensions",
        kind: "tension",
        place: Some(TensionPlace::Drum),
        column: "tension_drum_{}_n",
        unit: "N",
        quantity: MeasureQuantity {
            about: "tension of every cable at its drum",
            documentation: "`tension_drum_NAME_n`: tension of every cable at its drum; without pulley and winch that \
                            at its anchor",
            is_elastic: false,
        },
        value: CableState::tension_drum,
        gradients: |at| at.tensions_drum(),
    },
];

/// Minimum stiffness. Its goal has a search of its own, because the next larger ones may become the smallest.
pub(crate) static MIN_STIFFNESS: RobotMeasure = RobotMeasure {
    key: "stiffness-min",
    name: "minimum stiffness",
    column: "stiffness_min_n_per_m",
    unit: "N/m",
    quantity: Some(MeasureQuantity {
        about: "minimum eigenvalue of the static stiffness, rotations scaled by the platform's size",
        documentation: "`stiffness_min_n_per_m`: minimum eigenvalue of the static stiffness, rotations scaled by the \
                        platform's size; in wind, of the symmetric part of the stiffness",
        is_elastic: true,
    }),
    goal: None,
    value: |_, rest| rest.stability.min_stiffness(),
    gradient: |at| at.min_stiffness(),
};

/// Largest multiple of the required loads that is held.
static LOAD_FACTOR_MEASURE: RobotMeasure = RobotMeasure {
    key: "load-factor",
    name: "load factor",
    column: "load_factor",
    unit: "1",
    // A map keeps what the other quantities of the required loads need as well.
    quantity: None,
    goal: Some(MeasureGoal { sign: 1.0, about: "Largest multiple of the required loads that is held" }),
    value: |robot, rest| {
        let capacity = LoadCapacity::at(robot, &rest.pose, rest.model, None).ok()?;
        capacity.load_factor_value().ok()
    },
    gradient: |at| at.load_factor().map(|found| found.gradient),
};

/// The load factor as a measure of a robot.
pub(crate) const LOAD_FACTOR: Measure = Measure::Robot(&LOAD_FACTOR_MEASURE);

/// All groups, in the order of results.
pub(crate) static MEASURES: [MeasureGroup; 10] = [
    MeasureGroup::Pose,
    MeasureGroup::Cables { name: "lengths", measures: &[LENGTH] },
    MeasureGroup::Cables { name: "tensions", measures: &TENSIONS },
    MeasureGroup::Robot(&RobotMeasure {
        key: "rope-length",
        name: "length of all ropes",
        column: "rope_length_m",
        unit: "m",
        quantity: Some(MeasureQuantity {
            about: "unstrained length of all ropes",
            documentation: "`rope_length_m`: sum of the unstrained lengths of all cables",
            is_elastic: false,
        }),
        goal: Some(MeasureGoal { sign: -1.0, about: "Least length of all ropes" }),
        value: |_, rest| Some(rest.cables.iter().map(|cable| cable.unstrained_length).sum()),
        gradient: |at| Ok(at.rope_length()),
    }),
    MeasureGroup::Robot(&RobotMeasure {
        key: "rope-mass",
        name: "mass of all ropes",
        column: "rope_mass_kg",
        unit: "kg",
        quantity: Some(MeasureQuantity {
            about: "mass of all ropes",
            documentation: "`rope_mass_kg`: mass of all ropes, from the platform to the winches",
            is_elastic: false,
        }),
        goal: Some(MeasureGoal { sign: -1.0, about: "Least mass of all ropes" }),
        value: |robot, rest| {
            let ropes = rest.cables.iter().zip(&robot.cables);
            Some(ropes.map(|(state, cable)| state.unstrained_length * cable.material.mass_per_length).sum())
        },
        gradient: |at| Ok(at.rope_mass()),
    }),
    MeasureGroup::Robot(&MIN_STIFFNESS),
    MeasureGroup::Robot(&LOAD_FACTOR_MEASURE),
    MeasureGroup::Frequencies,
    MeasureGroup::Damping,
    MeasureGroup::Response,
];

impl MeasureGroup {
    /// Names of all groups.
    pub(crate) fn names() -> impl Iterator<Item = &'static str> {
        MEASURES.iter().map(Self::name)
    }

    /// Name in requests.
    pub(crate) fn name(&self) -> &'static str {
        match self {
            Self::Pose => "pose",
            Self::Cables { name, .. } => name,
            Self::Robot(measure) => measure.key,
            Self::Frequencies => "frequencies",
            Self::Damping => "damping",
            Self::Response => "response",
        }
    }

    /// True for results of modes, which end at a limit of the frequencies.
    pub(crate) fn is_of_modes(&self) -> bool {
        matches!(self, Self::Frequencies | Self::Damping)
    }

    /// Results of the group at an equilibrium: the pose by these components, tensions at these places. None for
    /// vibration.
    pub(crate) fn of_statics(&self, robot: &Robot, components: &[usize], places: &[TensionPlace]) -> Vec<Measure> {
        match self {
            Self::Pose => components.iter().copied().map(Measure::Pose).collect(),
            Self::Cables { measures, .. } => {
                let shown = measures.iter().filter(|of| of.place.is_none_or(|place| places.contains(&place)));
                shown.flat_map(|of| of.members(robot)).collect()
            }
            Self::Robot(measure) => vec![Measure::Robot(measure)],
            Self::Frequencies | Self::Damping | Self::Response => Vec::new(),
        }
    }
}

impl CableMeasure {
    /// Measures of this number, one per cable.
    pub(crate) fn members(&'static self, robot: &Robot) -> Vec<Measure> {
        (0..robot.cables.len()).map(|i| Measure::Cable(self, i)).collect()
    }
}

/// Numbers of each cable of all groups.
pub(crate) fn of_cables() -> impl Iterator<Item = &'static CableMeasure> {
    MEASURES.iter().flat_map(|group| match group {
        MeasureGroup::Cables { measures, .. } => *measures,
        _ => &[],
    })
}

/// Numbers of the whole robot.
pub(crate) fn of_robot() -> impl Iterator<Item = &'static RobotMeasure> {
    MEASURES.iter().filter_map(|group| match group {
        MeasureGroup::Robot(measure) => Some(*measure),
        _ => None,
    })
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
            Self::Cable(of, i) => {
                let place = of.place.map_or_else(String::new, |place| format!(" at the {}", place.name()));
                format!("{} of cable \"{}\"{place}", of.kind, cable(i))
            }
            Self::Robot(of) => of.name.to_owned(),
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
            Self::Cable(of, i) => of.column.replace("{}", cable(i)),
            Self::Robot(of) => of.column.to_owned(),
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
            Self::Cable(of, i) => match of.place {
                Some(place) => json!({ "kind": of.kind, "cable": cable(i), "place": place.name() }),
                None => json!({ "kind": of.kind, "cable": cable(i) }),
            },
            Self::Robot(of) => json!({ "kind": of.key }),
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
            Self::Pose(_) => "m",
            Self::Cable(of, _) => of.unit,
            Self::Robot(of) => of.unit,
            Self::Frequency(_) | Self::SharedFrequency { .. } => "Hz",
            Self::Damping(_) => "1",
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

    /// Value at an equilibrium; `None` for results of vibration, and for the stiffness of rigid cables. Rotations count
    /// from the undisturbed pose.
    pub(crate) fn static_value(self, robot: &Robot, rest: &Equilibrium, undisturbed: &Pose) -> Option<f64> {
        match self {
            Self::Pose(k) if k < 3 => Some(rest.pose.position_w[k]),
            Self::Pose(k) => Some((rest.pose.rot_wp * undisturbed.rot_wp.inverse()).scaled_axis()[k - 3]),
            Self::Cable(of, i) => rest.cables.get(i).map(of.value),
            Self::Robot(of) => (of.value)(robot, rest),
            Self::Frequency(_) | Self::SharedFrequency { .. } | Self::Damping(_) | Self::Response(..) => None,
        }
    }

    /// Gradients of measures at an equilibrium, each family of them computed once; `None` for results of vibration.
    pub(crate) fn static_gradients(
        measures: &[Self],
        gradients: &Gradients,
    ) -> Vec<Option<Result<RobotChange, GradientError>>> {
        let is_of_pose = |measure: &Self| matches!(measure, Self::Pose(_));
        let pose = if measures.iter().any(is_of_pose) { gradients.pose().to_vec() } else { Vec::new() };
        let mut of_cables: Vec<(&CableMeasure, Vec<RobotChange>)> = Vec::new();
        for measure in measures {
            if let Self::Cable(of, _) = measure
                && !of_cables.iter().any(|(other, _)| other == of)
            {
                of_cables.push((of, (of.gradients)(gradients)));
            }
        }

        let gradient = |measure: &Self| match *measure {
            Self::Pose(k) => Some(Ok(pose[k].clone())),
            Self::Cable(of, i) => {
                let family = of_cables.iter().find(|(other, _)| *other == of);
                family.map(|(_, gradients)| Ok(gradients[i].clone()))
            }
            Self::Robot(of) => Some((of.gradient)(gradients)),
            Self::Frequency(_) | Self::SharedFrequency { .. } | Self::Damping(_) | Self::Response(..) => None,
        };
        measures.iter().map(gradient).collect()
    }
}

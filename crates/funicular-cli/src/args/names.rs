//! Choices of an option by name, and the choices of the core that they stand for.

use clap::ValueEnum;
use funicular::cable::CableModel;
use funicular::dynamics::Assembly;
use funicular::gradient::Hold;
use funicular::robot::WinchMode;
use funicular::statics::StaticModel;
use funicular_study::names::{DesignGoal, ModelForm, Per, UncertaintyMethod};

/// Tension rules by name; see [`funicular::statics::TensionRule`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum TensionRuleName {
    /// Minimum sum of squares of the tensions above their minimum
    Lowest,
    /// Minimum sum of squares of the differences from --target-tension-n
    Closest,
    /// Maximum distance from the limits, relative to the distance between them
    Middle,
    /// Maximum of the minimum eigenvalue of the scaled stiffness
    Stiffest,
}

/// Static models by name; see [`StaticModel`].
#[derive(Debug, Clone, Copy, Default, ValueEnum)]
pub(crate) enum StaticModelName {
    /// Straight, massless, rigid
    Ideal,
    /// Straight, massless, elastic
    Spring,
    /// Elastic, sagging under its own weight
    #[default]
    Catenary,
}

impl From<StaticModelName> for StaticModel {
    fn from(name: StaticModelName) -> Self {
        match name {
            StaticModelName::Ideal => Self::Ideal,
            StaticModelName::Spring => Self::Spring,
            StaticModelName::Catenary => Self::Catenary,
        }
    }
}

/// Cable models by name; see [`CableModel`].
#[derive(Debug, Clone, Copy, ValueEnum)]
pub(crate) enum CableModelName {
    /// Vibration about the elastic catenary: any sag, axial waves included
    CatenaryDynamic,
    /// Dynamic stiffness of a shallow sagging cable (Starossek 1991)
    ShallowDynamic,
    /// Static stiffness of a shallow sagging cable (Irvine 1981)
    ShallowStatic,
    /// Exact static stiffness of the elastic catenary
    CatenaryStatic,
    /// Massless spring along the chord
    Spring,
}

impl From<CableModelName> for CableModel {
    fn from(name: CableModelName) -> Self {
        match name {
            CableModelName::CatenaryDynamic => Self::CatenaryDynamic,
            CableModelName::ShallowDynamic => Self::ShallowDynamic,
            CableModelName::ShallowStatic => Self::ShallowStatic,
            CableModelName::CatenaryStatic => Self::CatenaryStatic,
            CableModelName::Spring => Self::Spring,
        }
    }
}

/// Form of a reduced model by name; see [`ModelForm`].
#[derive(Debug, Clone, Copy, Default, ValueEnum)]
pub(crate) enum ModelFormName {
    /// State space of the modes that inputs and outputs see
    #[default]
    StateSpace,
    /// M, C, K of the platform and all modes of the cables with fixed ends, and their state space
    SecondOrder,
}

impl From<ModelFormName> for ModelForm {
    fn from(name: ModelFormName) -> Self {
        match name {
            ModelFormName::StateSpace => Self::StateSpace,
            ModelFormName::SecondOrder => Self::SecondOrder,
        }
    }
}

/// Name of the held quantity; see [`Hold`].
#[derive(Debug, Clone, Copy, Default, ValueEnum)]
pub(crate) enum HoldName {
    /// The unstrained lengths; the pose follows
    #[default]
    Lengths,
    /// The pose; the unstrained lengths follow
    Pose,
    /// The pose and the rule of --tension-rule; the unstrained lengths follow
    Rule,
}

impl From<HoldName> for Hold {
    fn from(name: HoldName) -> Self {
        match name {
            HoldName::Lengths => Self::Lengths,
            HoldName::Pose => Self::Pose,
            HoldName::Rule => Self::Rule,
        }
    }
}

/// Goal of a design by name; see [`DesignGoal`].
#[derive(Debug, Clone, Copy, Default, ValueEnum)]
pub(crate) enum DesignGoalName {
    /// Highest first natural frequency, cables included
    #[default]
    First,
    /// Highest first natural frequency of the platform on the static stiffness of its cables
    Platform,
    /// Highest minimum stiffness, as `statics` prints it
    Stiffness,
    /// Least mass of all ropes
    RopeMass,
    /// Least length of all ropes
    RopeLength,
}

impl From<DesignGoalName> for DesignGoal {
    fn from(name: DesignGoalName) -> Self {
        match name {
            DesignGoalName::First => Self::First,
            DesignGoalName::Platform => Self::Platform,
            DesignGoalName::Stiffness => Self::Stiffness,
            DesignGoalName::RopeMass => Self::RopeMass,
            DesignGoalName::RopeLength => Self::RopeLength,
        }
    }
}

/// Step of derivatives by name; see [`Per`].
#[derive(Debug, Clone, Copy, Default, ValueEnum)]
pub(crate) enum PerName {
    /// Unit of the number
    #[default]
    Unit,
    /// Percent of its value
    Percent,
    /// Tolerance of the number
    Tolerance,
}

impl From<PerName> for Per {
    fn from(name: PerName) -> Self {
        match name {
            PerName::Unit => Self::Unit,
            PerName::Percent => Self::Percent,
            PerName::Tolerance => Self::Tolerance,
        }
    }
}

/// Method for the deviations of results by name; see [`UncertaintyMethod`].
#[derive(Debug, Clone, Copy, Default, ValueEnum)]
pub(crate) enum UncertaintyMethodName {
    /// Linear where tensions and frequencies allow it, otherwise sampled
    #[default]
    Automatic,
    /// Linear for every result
    Linear,
    /// Sampled for every result
    Sampled,
}

impl From<UncertaintyMethodName> for UncertaintyMethod {
    fn from(name: UncertaintyMethodName) -> Self {
        match name {
            UncertaintyMethodName::Automatic => Self::Automatic,
            UncertaintyMethodName::Linear => Self::Linear,
            UncertaintyMethodName::Sampled => Self::Sampled,
        }
    }
}

/// Winches in vibration by name; see [`WinchMode`].
#[derive(Debug, Clone, Copy, Default, ValueEnum)]
pub(crate) enum WinchModeName {
    /// As the robot file describes them
    #[default]
    AsGiven,
    /// Motors held at their angle
    Clamped,
    /// Motors with constant torque
    Torque,
    /// Cables that stick to their pulleys
    Stuck,
}

impl From<WinchModeName> for WinchMode {
    fn from(name: WinchModeName) -> Self {
        match name {
            WinchModeName::AsGiven => Self::AsGiven,
            WinchModeName::Clamped => Self::Clamped,
            WinchModeName::Torque => Self::Torque,
            WinchModeName::Stuck => Self::Stuck,
        }
    }
}

/// Terms of the stiffness by name; see [`Assembly`].
#[derive(Debug, Clone, Copy, Default, ValueEnum)]
pub(crate) enum AssemblyName {
    /// All terms: end stiffness of the cables, and rotation of their forces on their lever arms
    #[default]
    Consistent,
    /// End stiffness of the cables only, as in Yuan et al. 2014
    WithoutGeometricStiffness,
}

impl From<AssemblyName> for Assembly {
    fn from(name: AssemblyName) -> Self {
        match name {
            AssemblyName::Consistent => Self::Consistent,
            AssemblyName::WithoutGeometricStiffness => Self::WithoutGeometricStiffness,
        }
    }
}

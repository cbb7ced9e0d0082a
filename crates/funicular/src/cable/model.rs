//! Models of a cable, each with what other rooms ask about it.

use super::situation::CableSituation;
use super::{EndStiffness, NoStiffness, catenary_end, shallow_end, spring};
use crate::math::Mat3;
use crate::robot::Robot;
use crate::statics::{CableState, StaticModel};
use std::fmt;

/// Model of the stiffness of a cable at its platform end.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum CableModel {
    /// Massless spring along the chord with stiffness EA/L₀; no stiffness in other directions.
    Spring,
    /// Irvine's static stiffness of a shallow sagging cable; independent of frequency.
    ShallowStatic,
    /// Exact static stiffness of the elastic catenary; independent of frequency.
    CatenaryStatic,
    /// Starossek's dynamic stiffness of a shallow sagging cable.
    ShallowDynamic,
    /// Linear vibration about the elastic catenary: any sag, axial inertia included.
    #[default]
    CatenaryDynamic,
}

/// Shape of a cable at rest in a model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CableShape {
    /// Straight line.
    Straight,
    /// Parabola of a sag that is small against the chord.
    Shallow,
    /// Elastic catenary of any sag.
    Catenary,
}

/// Properties of a cable model.
#[derive(Debug, Clone, Copy)]
pub struct ModelEntry {
    /// The model.
    pub model: CableModel,
    /// Name in requests and results.
    pub name: &'static str,
    /// Meaning, for lists of choices.
    pub about: &'static str,
    /// Shape of the cable at rest.
    pub shape: CableShape,
    /// True if the stiffness depends on frequency, so that the cable has resonances of its own.
    pub is_dynamic: bool,
    /// True if the stiffness divides by the tension, so that a cable without tension has none.
    pub needs_tension: bool,
    /// True if axial waves along the cable are part of the model.
    pub has_axial_waves: bool,
    /// End stiffness of a cable.
    pub(super) end: fn(&CableSituation<'_>) -> Result<EndStiffness, NoStiffness>,
    /// Static stiffness of the free span of a cable, its far end held [N/m]; `None` for a rigid cable in a model that
    /// needs its curve.
    pub(super) span: fn(&Robot, usize, &CableState) -> Option<Mat3>,
}

/// All cable models, the simplest first, in the order of [`CableModel`].
pub const MODELS: [ModelEntry; 5] = [
    ModelEntry {
        model: CableModel::Spring,
        name: "spring",
        about: "Massless spring along the chord",
        shape: CableShape::Straight,
        is_dynamic: false,
        needs_tension: false,
        has_axial_waves: false,
        end: spring::end,
        span: spring::span,
    },
    ModelEntry {
        model: CableModel::ShallowStatic,
        name: "shallow-static",
        about: "Static stiffness of a shallow sagging cable (Irvine 1981)",
        shape: CableShape::Shallow,
        is_dynamic: false,
        needs_tension: true,
        has_axial_waves: false,
        end: shallow_end::at_rest,
        span: shallow_end::span,
    },
    ModelEntry {
        model: CableModel::CatenaryStatic,
        name: "catenary-static",
        about: "Exact static stiffness of the elastic catenary",
        shape: CableShape::Catenary,
        is_dynamic: false,
        needs_tension: false,
        has_axial_waves: false,
        end: catenary_end::at_rest,
        span: catenary_end::span,
    },
    ModelEntry {
        model: CableModel::ShallowDynamic,
        name: "shallow-dynamic",
        about: "Dynamic stiffness of a shallow sagging cable (Starossek 1991)",
        shape: CableShape::Shallow,
        is_dynamic: true,
        needs_tension: true,
        has_axial_waves: false,
        end: shallow_end::vibrating,
        span: catenary_end::span,
    },
    ModelEntry {
        model: CableModel::CatenaryDynamic,
        name: "catenary-dynamic",
        about: "Vibration about the elastic catenary: any sag, axial waves included",
        shape: CableShape::Catenary,
        is_dynamic: true,
        needs_tension: true,
        has_axial_waves: true,
        end: catenary_end::vibrating,
        span: catenary_end::span,
    },
];

impl CableModel {
    /// All models, the simplest first.
    pub const ALL: [Self; MODELS.len()] = {
        let mut all = [Self::Spring; MODELS.len()];
        let mut i = 0;
        while i < MODELS.len() {
            all[i] = MODELS[i].model;
            i += 1;
        }
        all
    };

    /// Properties of the model.
    pub fn entry(self) -> &'static ModelEntry {
        const TABLE: &[ModelEntry; MODELS.len()] = &MODELS;
        &TABLE[self as usize]
    }

    /// Name of the model in requests and results.
    pub fn name(self) -> &'static str {
        self.entry().name
    }

    /// Meaning of the model, for lists of choices.
    pub fn about(self) -> &'static str {
        self.entry().about
    }

    /// True if the stiffness depends on frequency, so that the cable has resonances of its own.
    pub fn is_dynamic(self) -> bool {
        self.entry().is_dynamic
    }

    /// True for a model of shallow sag, which is valid up to [`SHALLOW_SAG_LIMIT`](super::SHALLOW_SAG_LIMIT).
    pub(crate) fn is_shallow(self) -> bool {
        self.entry().shape == CableShape::Shallow
    }

    /// Dynamic model for cables whose equilibrium comes from a static model: with the same shape, or for straight
    /// cables, which have no dynamic model, with a shallow sag.
    pub fn dynamic_about(statics: StaticModel) -> Self {
        match statics {
            StaticModel::Catenary => Self::CatenaryDynamic,
            StaticModel::Ideal | StaticModel::Spring => Self::ShallowDynamic,
        }
    }

    /// Model without vibration of the cables that has the shape of a static model.
    pub fn static_about(statics: StaticModel) -> Self {
        match statics {
            StaticModel::Catenary => Self::CatenaryStatic,
            StaticModel::Ideal | StaticModel::Spring => Self::Spring,
        }
    }
}

impl fmt::Display for CableModel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

#[cfg(test)]
mod tests {
    use super::{CableModel, MODELS};

    #[test]
    fn the_table_has_one_row_per_model_in_their_order() {
        for (i, entry) in MODELS.iter().enumerate() {
            assert_eq!((entry.model as usize, entry.model.entry().name), (i, entry.name));
        }
        assert_eq!(CableModel::ALL.map(CableModel::name), MODELS.map(|entry| entry.name));
    }
}

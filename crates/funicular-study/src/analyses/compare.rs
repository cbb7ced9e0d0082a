//! `compare`: all cable models side by side.

use super::found;
use super::shared::{ModeRow, Origin};
use crate::at_rest::{self, AtRest};
use crate::columns::{Columns, ResultTable, Tabled, column};
use crate::request;
use crate::rows::rows;
use crate::table::Column;
use anyhow::Result;
use funicular::cable::CableModel;
use funicular::compare::{self, Comparison, Criterion, FrozenSag, ModelResult};
use funicular::dynamics::Linearisation;
use funicular::modes;
use funicular::robot::Robot;

rows! {
    /// Results of `compare`: every cable model compared with the reference.
    pub struct Compared {
        pub robot: String = hidden;
        pub below_hz: f64;
        pub static_model: &'static str;
        pub assembly: &'static str;
        pub in_plane_only: bool;
        pub origin: Origin = spread;
        pub reference: &'static str;
        pub tolerance: f64;
        /// Minimum fraction of the kinetic energy in the platform for a compared mode; absent if all modes are
        /// compared.
        pub platform_share: Option<f64>;
        /// Indices of the compared modes in the list of the reference, from 0.
        pub compared: Vec<usize>;
        pub models: Vec<ModelRow>;
        pub advice: AdviceRow;
        /// Reason why a model with static sag is worse than a spring; absent if it is not.
        pub frozen_sag: Option<FrozenSagRow>;
        pub warnings: Vec<String> = hidden;
    }
}

rows! {
    /// Modes of one cable model, and their matches in the reference.
    pub struct ModelRow {
        pub cable_model: &'static str;
        /// Reason why the model has no modes here.
        pub error: Option<String>;
        pub modes: Vec<ModeRow>;
        pub count_below: usize;
        pub certified: bool;
        pub matches: Vec<MatchRow>;
        pub missed: usize;
        /// Number of compared modes within the tolerance.
        pub within: usize;
        /// Largest relative difference of the compared modes that have a counterpart.
        pub largest_difference: Option<f64>;
        pub first_wrong_hz: Option<f64>;
    }
}

rows! {
    /// Mode and the mode of the reference that it matches.
    pub struct MatchRow {
        pub frequency_hz: f64;
        pub reference_hz: f64;
        pub reference_index: usize;
        pub relative_difference: f64;
        pub correlation: f64;
    }
}

rows! {
    /// Recommendation: the simplest model that is good enough.
    pub struct AdviceRow {
        pub cable_model: &'static str;
        pub text: String;
    }
}

rows! {
    /// Modes for which a static sag model is worse than a spring.
    pub struct FrozenSagRow {
        pub cable_model: &'static str;
        pub modes: usize;
        pub frequency_hz: f64;
        pub relative_difference: f64;
        pub spring_relative_difference: f64;
        pub first_cable_resonance_hz: f64;
        pub text: String;
    }
}

impl From<FrozenSag> for FrozenSagRow {
    fn from(frozen: FrozenSag) -> Self {
        Self {
            text: frozen.text(),
            cable_model: frozen.model.name(),
            modes: frozen.modes,
            frequency_hz: frozen.frequency_hz,
            relative_difference: frozen.static_difference,
            spring_relative_difference: frozen.spring_difference,
            first_cable_resonance_hz: frozen.clamped_hz,
        }
    }
}

/// Computes the modes with every cable model and compares them with the reference.
///
/// # Errors
/// A robot without such an equilibrium, or too many modes.
pub fn run(robot: Robot, request: &request::CompareRequest) -> Result<Compared> {
    request::check_positive("below_hz", request.below_hz)?;
    about(&at_rest::equilibrium(robot, &request.robot, &request.state, &request.tensions)?, request)
}

/// Compares the cable models for a robot at equilibrium. The state of the request is not used.
///
/// # Errors
/// The errors of [`run`].
pub fn about(at_rest: &AtRest, request: &request::CompareRequest) -> Result<Compared> {
    request::check_positive("below_hz", request.below_hz)?;
    request::check_fraction("platform_share", request.platform_share)?;
    request::check_not_negative("tolerance", request.tolerance)?;
    let platform_share = request.platform.then_some(request.platform_share);
    let criterion = Criterion { tolerance: request.tolerance, platform_share };
    let linearisation = Linearisation {
        // The number of modes is checked before any work. Warnings of the models follow. The shallow-dynamic model
        // counts fastest.
        cable_model: CableModel::ShallowDynamic,
        assembly: request.terms.assembly,
        in_plane_only: request.terms.in_plane_only,
        winches: request.terms.winches,
    };
    let at_rest = &*at_rest.vibrating();
    let (reference, mut warnings) = at_rest.dynamics(linearisation, request.below_hz)?;
    modes::check_count(&reference, request.below_hz, modes::MAX_MODES)?;
    let found = compare::compare(&at_rest.robot, &at_rest.equilibrium, request.below_hz, linearisation, criterion)?;

    let Comparison { below_hz, compared, reference, models, advice, frozen_sag, .. } = found;
    for model in &models {
        if let Some(warning) = model.modes.as_ref().ok().and_then(modes::Modes::caveat) {
            warnings.push(format!("{}: {warning}", model.model));
        }
    }

    Ok(Compared {
        robot: at_rest.robot.name.clone(),
        below_hz,
        static_model: at_rest.equilibrium.model.name(),
        assembly: linearisation.assembly.name(),
        in_plane_only: linearisation.in_plane_only,
        origin: Origin::of(at_rest),
        reference: reference.name(),
        tolerance: request.tolerance,
        platform_share,
        compared,
        models: models.into_iter().map(ModelRow::from).collect(),
        advice: AdviceRow { cable_model: advice.model.name(), text: advice.text },
        frozen_sag: frozen_sag.map(FrozenSagRow::from),
        warnings,
    })
}

impl From<ModelResult> for ModelRow {
    fn from(result: ModelResult) -> Self {
        let (modes, count_below, certified, error) = match result.modes {
            Ok(found) => {
                (found.modes.into_iter().map(ModeRow::from).collect(), found.count_below, found.certified, None)
            }
            Err(error) => (Vec::new(), 0, false, Some(error.to_string())),
        };

        let matches = result
            .matches
            .into_iter()
            .map(|m| MatchRow {
                frequency_hz: m.frequency_hz,
                reference_hz: m.reference_hz,
                reference_index: m.reference_index,
                relative_difference: m.relative_difference,
                correlation: m.correlation,
            })
            .collect();

        Self {
            cable_model: result.model.name(),
            error,
            modes,
            count_below,
            certified,
            matches,
            missed: result.missed,
            within: result.within,
            largest_difference: result.largest_difference,
            first_wrong_hz: result.first_wrong_hz,
        }
    }
}

/// Mode of one cable model beside its counterpart.
struct Matched<'a> {
    cable_model: &'static str,
    mode: &'a ModeRow,
    counterpart: Option<&'a MatchRow>,
}

impl<'a> Matched<'a> {
    fn columns() -> Columns<Self> {
        Columns::new([
            column("cable_model", "", "cable model", |row: &Self| row.cable_model),
            column("frequency_hz", "Hz", "natural frequency with this model", |row: &Self| row.mode.frequency_hz),
            column("kind", "", "where most of the kinetic energy is", |row: &Self| row.mode.kind),
            column("platform_energy_fraction", "1", "share of the platform in the kinetic energy", |row: &Self| {
                row.mode.platform_energy_fraction
            }),
            column("reference_hz", "Hz", "frequency of the counterpart in the reference", |row: &Self| {
                row.counterpart.map(|of| of.reference_hz)
            }),
            column("relative_difference", "1", "difference from the counterpart, divided by it", |row: &Self| {
                row.counterpart.map(|of| of.relative_difference)
            }),
            column("correlation", "1", "correlation of the two motions of the platform", |row: &Self| {
                row.counterpart.map(|of| of.correlation)
            }),
        ])
    }

    fn of(model: &'a ModelRow) -> impl Iterator<Item = Self> {
        // Matches are in the order of the modes. A mode with the platform at rest has no match.
        let mut matches = model.matches.iter().peekable();
        model.modes.iter().map(move |mode| {
            let counterpart = matches.next_if(|of| of.frequency_hz.to_bits() == mode.frequency_hz.to_bits());
            Self { cable_model: model.cable_model, mode, counterpart }
        })
    }
}

impl Tabled for Compared {
    fn tables() -> Vec<(&'static str, Vec<Column>)> {
        vec![("", Matched::columns().described())]
    }

    fn table(&self) -> ResultTable<'_> {
        ResultTable::new(Matched::columns(), self.models.iter().flat_map(Matched::of))
    }
}

found!(Compared, "compare");

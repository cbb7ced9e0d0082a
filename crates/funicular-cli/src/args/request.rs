//! Conversion of arguments to requests. Names and values are copied; no decision is made here.

use super::values::PoseNumbers;
use super::{
    AssemblyName, CableArgs, CableModelName, ChangeArgs, CompareArgs, EachArgs, ExportArgs, ExportFormat, FrfArgs,
    GradientArgs, ImportArgs, LengthUnitName, LinearisedArgs, LiveArgs, LoadArgs, LoadedRobotArgs, MapArgs, MergeArgs,
    ModelArgs, ModesArgs, MotionName, NewArgs, PayloadArgs, PlotArgs, PointArgs, PoseErrorArgs, RangeArgs, ReduceArgs,
    ReportArgs, RopeName, StateArgs, StaticsArgs, StiffnessArgs, SweepArgs, TensionArgs, TensionRuleName, TermArgs,
    UncertaintyArgs, WinchModeName,
};
use funicular_study::import::SourceFile;
use funicular_study::names::TensionRuleName as Rule;
use funicular_study::new_robot::{LengthUnit, NewMotion, RopeType};
use funicular_study::request::{
    self, Axis, EachPoint, FrequencyRange, ImportPlatform, ImportRopes, Load, Model, OneOrSeveral, Pose,
    ResponsePoints, ResponseRange, RobotText, State, Tensions, Terms,
};
use std::path::Path;

impl ChangeArgs {
    /// Text of a robot file with the changes of `--set`.
    pub(crate) fn robot(&self, name: String, text: String) -> RobotText {
        RobotText { name, text, set: self.set.clone() }
    }
}

impl LinearisedArgs {
    pub(crate) fn request(&self) -> (State, Tensions, Model) {
        (self.state.request(), self.tensions.request(), self.model.request())
    }
}

impl StateArgs {
    pub(crate) fn request(&self) -> State {
        State {
            lengths_m: self.lengths_m.as_ref().map(|lengths| lengths.0.clone()),
            hold_lengths_of_pose: self.hold_lengths_of_pose,
            ..self.loaded.at_pose(self.pose)
        }
    }
}

impl LoadedRobotArgs {
    /// State at a pose, or else at the pose of the robot file.
    pub(crate) fn at_pose(&self, pose: Option<PoseNumbers>) -> State {
        State {
            pose: pose.map(|pose| Pose::Angles(pose.0)),
            mass_kg: self.mass_kg,
            static_model: self.static_model.into(),
            load: self.load.request(),
            ..State::default()
        }
    }
}

impl LoadArgs {
    pub(crate) fn request(&self) -> Load {
        let Self { force_n, moment_n_m, load_point_m, wind_m_s, cable_load_n_per_m } = *self;
        Load {
            force_n: force_n.map(Into::into),
            moment_n_m: moment_n_m.map(Into::into),
            load_point_m: load_point_m.map(Into::into),
            wind_m_s: wind_m_s.map(Into::into),
            cable_load_n_per_m: cable_load_n_per_m.map(Into::into),
        }
    }
}

impl TensionArgs {
    pub(crate) fn request(&self) -> Tensions {
        Tensions {
            tension_rule: self.tension_rule.map(Rule::from),
            target_tension_n: self.target_tension_n.as_ref().map(|target| target.0.clone()),
            min_tension_n: self.min_tension_n,
            max_tension_n: self.max_tension_n,
        }
    }
}

impl From<TensionRuleName> for Rule {
    fn from(name: TensionRuleName) -> Self {
        match name {
            TensionRuleName::Lowest => Self::Lowest,
            TensionRuleName::Closest => Self::Closest,
            TensionRuleName::Middle => Self::Middle,
            TensionRuleName::Stiffest => Self::Stiffest,
        }
    }
}

impl ModelArgs {
    pub(crate) fn request(&self) -> Model {
        Model { cable_model: self.cable_model.map(CableModelName::into), terms: self.terms.request() }
    }
}

impl TermArgs {
    fn request(&self) -> Terms {
        Terms {
            assembly: AssemblyName::into(self.assembly),
            in_plane_only: self.in_plane_only,
            winches: WinchModeName::into(self.winches),
        }
    }
}

impl PointArgs {
    fn request(&self) -> ResponsePoints {
        ResponsePoints {
            input_point_m: self.input_point_m.map(Into::into),
            output_point_m: self.output_point_m.map(Into::into),
        }
    }
}

impl RangeArgs {
    fn request(&self) -> FrequencyRange {
        FrequencyRange { from_hz: self.from_hz, to_hz: self.to_hz, points: Some(self.points as usize), log: self.log }
    }
}

impl StaticsArgs {
    pub(crate) fn request(&self, robot: RobotText) -> request::StaticsRequest {
        request::StaticsRequest {
            robot,
            state: self.state.request(),
            tensions: self.tensions.request(),
            all: self.all,
            friction_interval: self.friction_interval,
        }
    }
}

impl StiffnessArgs {
    pub(crate) fn request(&self, robot: RobotText) -> request::StiffnessRequest {
        let (state, tensions, model) = self.linearised.request();
        request::StiffnessRequest { robot, at_hz: self.at_hz, state, tensions, model }
    }
}

impl ModesArgs {
    pub(crate) fn request(&self, robot: RobotText) -> request::ModesRequest {
        let (state, tensions, model) = self.linearised.request();
        request::ModesRequest {
            robot,
            below_hz: self.below_hz,
            input: self.input.as_ref().map(|input| input.name.clone()),
            output: self.output.as_ref().map(|output| output.name.clone()),
            points: self.points.request(),
            stations: self.stations,
            platform_share: self.share.platform_share,
            damped: true,
            rigid_cables: self.rigid_cables,
            state,
            tensions,
            model,
        }
    }
}

impl FrfArgs {
    pub(crate) fn request(&self, robot: RobotText) -> request::FrfRequest {
        let (state, tensions, model) = self.linearised.request();
        request::FrfRequest {
            robot,
            range: ResponseRange {
                from_hz: self.from_hz,
                to_hz: self.to_hz,
                points: self.points.map(|points| points as usize),
                log: self.log,
            },
            adaptive: self.adaptive,
            input: OneOrSeveral::of(self.input.iter().map(|input| input.name.clone()).collect()),
            output: OneOrSeveral::of(self.output.iter().map(|output| output.name.clone()).collect()),
            signal_points: self.signal_points.request(),
            prominence_db: self.prominence_db,
            state,
            tensions,
            model,
        }
    }
}

impl CompareArgs {
    pub(crate) fn request(&self, robot: RobotText) -> request::CompareRequest {
        request::CompareRequest {
            robot,
            below_hz: self.below_hz,
            platform: self.platform,
            platform_share: self.share.platform_share,
            tolerance: self.tolerance,
            state: self.state.request(),
            tensions: self.tensions.request(),
            terms: self.terms.request(),
        }
    }
}

impl GradientArgs {
    pub(crate) fn request(&self, robot: RobotText) -> request::GradientRequest {
        let (state, tensions, model) = self.linearised.request();
        request::GradientRequest {
            robot,
            of: self.of.clone(),
            by: self.by.clone(),
            hold: self.hold.into(),
            per: self.per.into(),
            tolerances: self.tolerances.clone(),
            below_hz: self.below_hz,
            at_hz: self.at_hz,
            input: self.input.as_ref().map(|input| input.name.clone()),
            output: self.output.as_ref().map(|output| output.name.clone()),
            points: self.points.request(),
            state,
            tensions,
            model,
        }
    }
}

impl UncertaintyArgs {
    pub(crate) fn request(&self, robot: RobotText, poses: Option<Vec<[f64; 6]>>) -> request::UncertaintyRequest {
        let (state, tensions, model) = self.linearised.request();
        request::UncertaintyRequest {
            robot,
            of: self.of.clone(),
            deviations: self.deviations.clone(),
            tolerances: self.tolerances.clone(),
            hold: self.hold.into(),
            method: self.method.into(),
            samples: self.samples,
            seed: self.seed,
            below_hz: self.below_hz,
            at_hz: (!self.at_hz.is_empty()).then(|| self.at_hz.clone()),
            input: self.input.as_ref().map(|input| input.name.clone()),
            output: self.output.as_ref().map(|output| output.name.clone()),
            points: self.points.request(),
            poses,
            state,
            tensions,
            model,
        }
    }
}

impl PayloadArgs {
    pub(crate) fn request(&self, robot: RobotText) -> request::PayloadRequest {
        request::PayloadRequest {
            robot,
            payload_center_m: self.payload_center_m.map(Into::into),
            state: self.state.request(),
            tensions: self.tensions.request(),
        }
    }
}

impl PoseErrorArgs {
    pub(crate) fn request(&self, robot: RobotText) -> request::PoseErrorRequest {
        let range = self.mass_kg;
        request::PoseErrorRequest {
            robot,
            mass_kg: (range.from, range.to, range.count),
            lengths_m: self.lengths_m.as_ref().map(|lengths| lengths.0.clone()),
            pose: self.pose.map(|pose| Pose::Angles(pose.0)),
            tensions: self.tensions.request(),
            tolerance_mm: self.tolerance_mm,
        }
    }
}

impl CableArgs {
    pub(crate) fn request(&self, robot: RobotText) -> request::CableRequest {
        request::CableRequest {
            robot,
            name: self.name.clone(),
            range: self.range.request(),
            state: self.state.request(),
            tensions: self.tensions.request(),
            cable_model: self.cable_model.map(CableModelName::into),
            in_plane_only: self.in_plane_only,
            winches: WinchModeName::into(self.winches),
        }
    }
}

impl ReduceArgs {
    pub(crate) fn request(&self, robot: RobotText) -> request::ReduceRequest {
        let (state, tensions, model) = self.linearised.request();
        request::ReduceRequest {
            robot,
            below_hz: self.below_hz,
            input: self.input.iter().map(|input| input.name.clone()).collect(),
            output: self.output.iter().map(|output| output.name.clone()).collect(),
            points: self.points.request(),
            form: self.form.into(),
            order: self.order,
            tolerance: self.tolerance,
            damping_at_hz: self.damping_at_hz,
            state,
            tensions,
            model,
        }
    }
}

impl EachArgs {
    fn request(&self) -> EachPoint {
        let (state, tensions, model) = self.linearised.request();
        EachPoint {
            quantities: self.what.quantity.iter().map(funicular_study::sweep::Quantity::name).collect(),
            up_to_hz: self.what.up_to_hz,
            platform_share: self.what.share.platform_share,
            payload_center_m: self.what.payload_center_m.map(Into::into),
            state,
            tensions,
            model,
        }
    }
}

impl MapArgs {
    /// Request of a map; `poses` are the poses in the file of `--poses`.
    pub(crate) fn request(&self, robot: RobotText, poses: Option<Vec<[f64; 6]>>) -> request::MapRequest {
        let grid = self.grid.iter().map(|(axis, steps)| Axis::new(axis.clone(), steps)).collect();
        request::MapRequest { robot, grid, poses, point: self.point.request() }
    }
}

impl SweepArgs {
    pub(crate) fn request(&self, robot: RobotText) -> request::SweepRequest {
        let vary = self.vary.iter().map(|axis| Axis::new(axis.path.text.clone(), &axis.steps)).collect();
        request::SweepRequest { robot, vary, point: self.point.request() }
    }
}

impl ReportArgs {
    pub(crate) fn request(&self, robot: RobotText) -> request::ReportRequest {
        let (state, tensions, model) = self.linearised.request();
        request::ReportRequest {
            robot,
            below_hz: self.below_hz,
            platform_share: self.share.platform_share,
            input: self.input.as_ref().map(|input| input.name.clone()),
            output: self.output.as_ref().map(|output| output.name.clone()),
            points: self.points.request(),
            state,
            tensions,
            model,
        }
    }
}

impl LiveArgs {
    pub(crate) fn request(&self, robot: RobotText) -> request::LiveRequest {
        let (state, tensions, model) = self.linearised.request();
        request::LiveRequest { robot, state, tensions, model }
    }
}

impl ImportArgs {
    pub(crate) fn request(&self, files: Vec<SourceFile>) -> request::ImportRequest {
        let (ropes, platform) = (&self.ropes, &self.platform);
        request::ImportRequest {
            files,
            cable_set: self.cable_set.clone(),
            ropes: ImportRopes {
                mass_kg_per_m: ropes.mass_kg_per_m,
                axial_stiffness_n: ropes.axial_stiffness_n,
                youngs_modulus_pa: ropes.youngs_modulus_pa,
                diameter_m: ropes.diameter_m,
            },
            platform: ImportPlatform {
                mass_kg: platform.mass_kg,
                inertia_kg_m2: platform.inertia_kg_m2.map(|inertia| inertia.0),
                center_of_mass_m: platform.center_of_mass_m.map(Into::into),
                pose: platform.pose.map(|pose| Pose::Angles(pose.0)),
            },
        }
    }
}

impl NewArgs {
    /// Request of a new robot; `csv` is the file of `--from-csv`.
    pub(crate) fn request(&self, csv: Option<SourceFile>) -> request::NewRequest {
        request::NewRequest {
            name: self.name.clone(),
            cables: self.cables,
            motion: match self.motion {
                MotionName::Rigid => NewMotion::Rigid,
                MotionName::PointMass => NewMotion::PointMass,
                MotionName::PlanarXz => NewMotion::PlanarXz,
            },
            from_csv: csv,
            csv_unit: self.csv_unit.map(|unit| match unit {
                LengthUnitName::M => LengthUnit::Metre,
                LengthUnitName::Mm => LengthUnit::Millimetre,
            }),
            mass_kg: self.mass_kg,
            box_m: self.box_m.map(Into::into),
            rope: match self.rope {
                RopeName::SixTimes19 => RopeType::SixTimes19,
                RopeName::SevenTimes7 => RopeType::SevenTimes7,
                RopeName::Hmpe => RopeType::Hmpe,
            },
            diameter_m: self.diameter_m,
            axial_stiffness_n: self.axial_stiffness_n,
            mass_kg_per_m: self.mass_kg_per_m,
            pose: self.pose.map(|pose| Pose::Angles(pose.0)),
        }
    }
}

impl ExportArgs {
    pub(crate) fn request(&self, robot: RobotText) -> request::ExportRequest {
        request::ExportRequest {
            robot,
            to: ExportFormat::into(self.to),
            segments: self.segments as usize,
            modes_below_hz: self.modes_below_hz,
            state: self.state.request(),
            tensions: self.tensions.request(),
        }
    }
}

impl From<ExportFormat> for funicular_study::export::ExportFormat {
    fn from(format: ExportFormat) -> Self {
        match format {
            ExportFormat::Opensees => Self::Opensees,
            ExportFormat::Moordyn => Self::Moordyn,
            ExportFormat::Vtk => Self::Vtk,
        }
    }
}

impl MergeArgs {
    pub(crate) fn request(&self) -> request::MergeRequest {
        request::MergeRequest { parts: self.parts.iter().map(|part| shown(part)).collect() }
    }
}

impl PlotArgs {
    pub(crate) fn request(&self) -> request::PlotRequest {
        request::PlotRequest { file: shown(&self.file) }
    }
}

fn shown(path: &Path) -> String {
    path.display().to_string()
}

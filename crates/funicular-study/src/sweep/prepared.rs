//! Preparation of a map or sweep: its request becomes points, quantities and options.

use super::{AXES, Options, Plan, Points, Poses, Quantity, RobotValues, Steps, SweepError, ValueAxis, digest};
use crate::at_rest::{self, refuse_no_state};
use crate::names::TensionRuleName;
use crate::request::{Axis, EachPoint, MapRequest, PointOptions, Request, RobotText, SweepRequest, check_fraction};
use crate::robot_file::RobotFile;
use crate::shared_ropes::refuse_ropes_of_request;
use crate::table::{Part, Record};
use crate::values::positive;
use anyhow::{Context as _, Result, anyhow, bail};
use funicular::math::rotation;
use funicular::robot::parameters::{Parameter, Parameters};
use funicular::robot::{PlatformMotion, Pose, Robot, State};
use funicular::statics::{self, StaticsError};
use funicular::warnings;
use serde_json::{Map, Value, json};

/// Map or sweep that is ready to run.
pub struct PreparedSweep {
    /// Request with its defaults filled in, so that all front ends compute the same rows and write the same plan.
    request: Request,
    /// One robot of the sweep.
    robot: Robot,
    /// Text of the robot file, with its changes.
    robot_file: String,
    /// Text of the robot whose lengths are held, if lengths are held and it differs from `robot_file`.
    holder_file: Option<String>,
    points: Box<dyn Points + Send>,
    /// Orientation of a grid along axes that the grid does not have, with every digit.
    base: Option<Pose>,
    quantities: Vec<Quantity>,
    options: Options,
}

impl PreparedSweep {
    /// Prepares a request of `map` or `sweep`.
    ///
    /// # Errors
    /// A request of another command, or a request that contradicts itself or the robot.
    pub fn new(request: &Request) -> Result<Self> {
        Self::with_holder(request, None)
    }

    /// Prepares a request. If lengths are held, `holder` is the text of the robot that gives them; if it is absent,
    /// that robot follows from the request.
    fn with_holder(request: &Request, holder: Option<RobotText>) -> Result<Self> {
        refuse_ropes_of_request(request)?;
        let holder = |robot: &RobotText| holder.unwrap_or_else(|| robot.of_holder());
        match request {
            Request::Map(map) => Self::of_map(map, &holder(&map.robot)),
            Request::Sweep(sweep) => Self::of_sweep(sweep, &holder(&sweep.robot)),
            other => bail!("`{}` is neither a map nor a sweep", other.command()),
        }
    }

    fn of_map(request: &MapRequest, holder: &RobotText) -> Result<Self> {
        let file = request.robot.read()?;
        let robot = with_request(file.robot, &request.point.options)?;
        let PointOptions { state, tensions, .. } = &request.point.options;
        let mut holder_file = None;
        let mut holding = None;
        if state.hold_lengths_of_pose {
            let RobotFile { robot, text, .. } = holder.read()?;
            holding = Some(at_rest::holder_of(robot, state, tensions)?);
            holder_file = (text != file.text).then_some(text);
        }

        let mut request = request.clone();

        // The poses: a list, or a grid around the pose of the state.
        let mut base = None;
        let points = match &request.places.poses {
            Some(_) if !request.places.grid.is_empty() => bail!("give ⟪grid⟫ or ⟪poses⟫, not both"),
            Some(poses) => {
                check_poses(poses, &robot)?;
                Poses::list(robot.clone(), poses.clone())
            }
            None if request.places.grid.is_empty() => bail!("give ⟪grid⟫ or ⟪poses⟫: a map needs poses"),
            None => {
                let axes = steps_of(&request.places.grid, "grid")?;
                base = base_pose(holding.as_ref().unwrap_or(&robot), &request)?;
                Poses::grid(robot.clone(), &axes, base.as_ref())?
            }
        };
        if let Some(axes) = points.axes() {
            request.places.grid =
                AXES.iter().zip(axes).map(|(name, steps)| Axis::new((*name).to_owned(), steps)).collect();
        }

        let (quantities, options) = quantities_and_options(&robot, &mut request.point)?;
        let parameters = parameters_of(&quantities, &file.text)?;
        let (request, points) = (Request::Map(request), Box::new(points.holding(holding).with_parameters(parameters)));
        Ok(Self { request, robot, robot_file: file.text, holder_file, points, base, quantities, options })
    }

    fn of_sweep(request: &SweepRequest, holder: &RobotText) -> Result<Self> {
        let text = request.robot.changed_text()?;
        let mut request = request.clone();
        if request.vary.is_empty() {
            bail!("give ⟪vary⟫: a sweep needs a value that varies");
        }

        let axes = steps_of(&request.vary, "vary")?
            .into_iter()
            .map(|(path, steps)| ValueAxis::new(&path, steps))
            .collect::<Result<Vec<_>, String>>()
            .map_err(|reason| anyhow!("⟪vary⟫: {reason}"))?;

        let point = request.point.options.clone();
        let adjust = Box::new(move |robot| with_request(robot, &point).map_err(|error| format!("{error:#}")));
        let mut points = RobotValues::new(text.clone(), axes, adjust).map_err(|reason| anyhow!("{reason}"))?;
        let robot = points.first().map_err(|reason| anyhow!("{reason}"))?;

        let mut holder_file = None;
        if request.point.options.state.hold_lengths_of_pose {
            at_rest::refuse_no_pose(&robot)?;
            let PointOptions { state, tensions, .. } = request.point.options.clone();
            let adjust = Box::new(move |robot| {
                at_rest::holder_of(robot, &state, &tensions).map_err(|error| format!("{error:#}"))
            });
            let of_holder = holder.changed_text()?;
            points = points.holding(of_holder.clone(), adjust).map_err(|reason| anyhow!("{reason}"))?;
            holder_file = (of_holder != text).then_some(of_holder);
        }

        refuse_no_state(&robot)?;

        let (quantities, options) = quantities_and_options(&robot, &mut request.point)?;
        parameters_of(&quantities, &text)?;
        let (request, points) = (Request::Sweep(request), Box::new(points));
        Ok(Self { request, robot, robot_file: text, holder_file, points, base: None, quantities, options })
    }

    /// Restores the sweep of a file from the plan in the file.
    ///
    /// # Errors
    /// A plan that this version does not understand completely.
    pub fn of_record(record: &Record) -> Result<Self> {
        let mut plan = record.plan.clone();
        let robot = RobotText { name: String::new(), text: record.robot_file.clone(), set: Vec::new() };
        plan.insert("robot".to_owned(), serde_json::to_value(robot)?);
        plan.remove("orientation_wxyz");
        let holder = plan.remove("holder_file").and_then(|text| text.as_str().map(str::to_owned));
        let holder = holder.map(|text| RobotText { name: String::new(), text, set: Vec::new() });

        let request = Request::from_value(Value::Object(plan)).map_err(|error| anyhow!("{error}"))?;
        let prepared = Self::with_holder(&request, holder)?;

        // The plan is made again and compared, which proves that nothing was left out.
        if prepared.description() != record.plan {
            bail!("its plan is not a plan of this version of the program");
        }
        Ok(prepared)
    }

    /// Request with its defaults filled in.
    pub fn request(&self) -> &Request {
        &self.request
    }

    /// One robot of the sweep.
    pub fn robot(&self) -> &Robot {
        &self.robot
    }

    /// Warnings about values of the robot that no usual robot has; of a sweep, those of its first point.
    pub fn warnings(&self) -> Vec<String> {
        warnings::of_robot(&self.robot).iter().map(ToString::to_string).collect()
    }

    /// Points of the sweep.
    pub fn points(&self) -> &dyn Points {
        self.points.as_ref()
    }

    /// Options of every point.
    pub fn options(&self) -> &Options {
        &self.options
    }

    /// Plan of the rows to compute.
    ///
    /// # Errors
    /// [`SweepError`]: quantities that the robot or the models do not have, or too many points.
    pub fn plan(&self) -> Result<Plan<'_>, SweepError> {
        Plan::new(self.points.as_ref(), &self.robot, &self.quantities, &self.options)
    }

    /// Description that a file of these rows contains.
    pub fn record(&self, plan: &Plan, part: Option<Part>) -> Record {
        Record {
            robot_file: self.robot_file.clone(),
            plan: self.description(),
            columns: plan.columns().to_vec(),
            rows: plan.rows(),
            chunk_rows: plan.chunk_rows(),
            part,
        }
    }

    /// Request in the form that the file keeps: the robot by its name, since its text is stored separately, and a list
    /// of poses by its digest.
    fn description(&self) -> Map<String, Value> {
        let Value::Object(mut keys) = self.request.to_value() else { return Map::new() };
        keys.remove("schema");
        keys.insert("robot".to_owned(), json!(self.robot.name));

        if let Some(text) = &self.holder_file {
            keys.insert("holder_file".to_owned(), json!(text));
        }

        if let Request::Map(MapRequest { places, .. }) = &self.request {
            if let Some(poses) = &places.poses {
                keys.remove("grid");
                let description = json!({ "count": poses.len(), "sha256": digest::of_poses(poses) });
                keys.insert("poses".to_owned(), description);
            }
            if let Some(base) = &self.base {
                keys.insert("orientation_wxyz".to_owned(), json!(rotation::quaternion_wxyz(&base.rot_wp)));
            }
        }
        keys
    }
}

/// Robot of a point with the changes of the request.
pub(crate) fn with_request(robot: Robot, point: &PointOptions) -> Result<Robot> {
    let robot = at_rest::with_limits(&at_rest::with_state(robot, &point.state)?, &point.tensions)?;
    at_rest::with_required_velocities(at_rest::with_required(robot, &point.required)?, &point.velocities)
}

/// Quantities and options of every point. Fills in the defaults of the request.
fn quantities_and_options(robot: &Robot, point: &mut EachPoint) -> Result<(Vec<Quantity>, Options)> {
    let quantities = (point.quantities.iter())
        .map(|name| name.parse().map_err(|error| anyhow!("⟪quantities⟫ {name}: {error}")))
        .collect::<Result<Vec<Quantity>>>()?;
    point.quantities = quantities.iter().map(Quantity::name).collect();
    Ok((quantities, options_of(robot, &mut point.options)?))
}

/// Options of every point. Fills in the defaults of the request.
///
/// # Errors
/// Numbers out of their ranges, or a rule of tensions without a choice.
pub(crate) fn options_of(robot: &Robot, point: &mut PointOptions) -> Result<Options> {
    positive(point.up_to_hz).map_err(|reason| anyhow!("⟪up_to_hz⟫: {reason}"))?;
    let rule = at_rest::rule(&point.tensions)?;
    if rule.is_some() && !statics::leaves_choice(robot) {
        let (cables, dof) = (robot.cables.len(), robot.platform.motion.count());
        return Err(StaticsError::NothingToChoose { cables, dof }.into());
    }
    let tension_rule = rule.unwrap_or_default();
    if statics::leaves_choice(robot) {
        point.tensions.tension_rule = Some(TensionRuleName::from(&tension_rule));
    }

    let static_model = point.state.static_model;
    let linearisation = at_rest::linearisation(&point.model, static_model);
    point.model.cable_model = Some(linearisation.cable_model);
    check_fraction("platform_share", point.platform_share)?;
    let payload_center_p = at_rest::payload_center(robot, point.payload_center_m)?;
    let (highest_hz, platform_share) = (point.up_to_hz, point.platform_share);
    Ok(Options { static_model, tension_rule, linearisation, highest_hz, platform_share, payload_center_p })
}

/// Numbers of the robot file, if a quantity differentiates by one of them.
///
/// # Errors
/// A path that is no number of the file, or that leads to several.
fn parameters_of(quantities: &[Quantity], text: &str) -> Result<Option<Parameters>> {
    let mut differentiating = quantities.iter().filter_map(|of| Some((of, of.path()?))).peekable();
    if differentiating.peek().is_none() {
        return Ok(None);
    }
    let parameters = Parameters::from_toml(text)?;
    for (quantity, path) in differentiating {
        if parameters.find(path.keys()).is_none() {
            let paths: Vec<String> = parameters.list().iter().map(Parameter::path).collect();
            let nearest = crate::names::suggestion(&path.text, &paths);
            bail!("⟪quantities⟫ {}: the robot file has no number {}{nearest}", quantity.name(), path.text);
        }
    }
    Ok(Some(parameters))
}

/// Names and values of axes.
fn steps_of(axes: &[Axis], key: &str) -> Result<Vec<(String, Steps)>> {
    axes.iter()
        .map(|axis| {
            let steps = axis.steps().map_err(|reason| anyhow!("⟪{key}⟫ {}: {reason}", axis.name()))?;
            Ok((axis.name().to_owned(), steps))
        })
        .collect()
}

/// Pose for the axes that the grid does not have: the pose of the request, or else of the robot's state.
fn base_pose(robot: &Robot, request: &MapRequest) -> Result<Option<Pose>> {
    Ok(match &robot.state {
        State::Pose(pose) => Some(*pose),
        State::Unknown => None,
        State::Lengths(lengths) => {
            let rest = statics::forward(robot, lengths, request.point.options.state.static_model, None).context(
                "the grid does not have all axes and the robot's state has no pose to take them from: give ⟪pose⟫",
            )?;
            Some(rest.pose)
        }
    })
}

/// Refuses poses that the platform cannot have.
pub(crate) fn check_poses(poses: &[[f64; 6]], robot: &Robot) -> Result<()> {
    if poses.is_empty() {
        bail!("⟪poses⟫ has no poses: give at least one");
    }
    for (i, pose) in poses.iter().enumerate() {
        for value in pose {
            crate::values::finite(*value).map_err(|reason| anyhow!("⟪poses⟫, pose {}: {reason}", i + 1))?;
        }
        let pose = Pose::new([pose[0], pose[1], pose[2]], [pose[3], pose[4], pose[5]]);
        at_rest::refuse_orientation(robot.platform.motion == PlatformMotion::PointMass, &pose)
            .map_err(|error| anyhow!("⟪poses⟫, pose {}: {error}", i + 1))?;
    }
    Ok(())
}

//! Vibration about the equilibrium: models, signals, ports, modes below a limit.

use super::AtRest;
use crate::request::{Model, ResponsePoints, Terms};
use crate::signals::{Input, Output};
use anyhow::Result;
use funicular::cable::CableModel;
use funicular::cable_motion::CableMotionError;
use funicular::dynamics::{Dynamics, Linearisation};
use funicular::math::Vec3;
use funicular::modes::{self, Modes};
use funicular::response::{Port, Signal};
use funicular::robot::Robot;
use funicular::statics::{Equilibrium, StaticModel};
use std::borrow::Cow;

/// Cable model of a request. The default is the dynamic model with the same shape as the static model.
pub fn cable_model(requested: Option<CableModel>, static_model: StaticModel) -> CableModel {
    requested.unwrap_or_else(|| CableModel::dynamic_about(static_model))
}

/// Linearisation of a request.
pub fn linearisation(model: &Model, static_model: StaticModel) -> Linearisation {
    let Terms { assembly, in_plane_only, winches } = model.terms;
    Linearisation { cable_model: cable_model(model.cable_model, static_model), assembly, in_plane_only, winches }
}

/// Input and output of a response, checked for this robot.
///
/// # Errors
/// A signal that does not exist on the robot, or a point that is not finite.
pub fn signals(robot: &Robot, input: &Input, output: &Output, points: &ResponsePoints) -> Result<[Signal; 2]> {
    points.check()?;
    input.on_platform_or_cable()?;
    output.on_platform_or_cable()?;
    let [from, to] = [points.input_point_m, points.output_point_m].map(|point| point.map(Vec3::from));
    Ok([input.signal(robot, from)?, output.signal(robot, to)?])
}

/// Linearised robot with every mode below a limit.
#[derive(Debug)]
pub struct ModesBelow {
    /// Robot linearised about its equilibrium.
    pub dynamics: Dynamics,
    /// Modes below the limit.
    pub modes: Modes,
    /// Warnings about the robot, its models up to the limit, and the count of the modes.
    pub warnings: Vec<String>,
}

impl AtRest {
    /// Robot and equilibrium with the stiffness of slow loads alone.
    pub(crate) fn slow(&self) -> (Cow<'_, Robot>, Cow<'_, Equilibrium>) {
        let mut robot = Cow::Borrowed(&self.robot);
        if robot.has_dynamic_stiffness() {
            robot.to_mut().cables.iter_mut().for_each(|cable| cable.material.dynamic_axial_stiffness = None);
        }
        (robot, Cow::Borrowed(&self.equilibrium))
    }

    /// Ports of the linearised robot for the input and the output of a response.
    ///
    /// # Errors
    /// [`CableMotionError`]: a cable model without motion along the cables.
    pub fn ports(&self, dynamics: &Dynamics, signals: [Signal; 2]) -> Result<[Port; 2], CableMotionError> {
        let Self { robot, equilibrium, .. } = &*self.vibrating();
        let all = Port::all(robot, equilibrium, dynamics, &signals, true)?;
        Ok(all.try_into().expect("there are as many ports as signals"))
    }

    /// Robot linearised about its equilibrium, with warnings for frequencies up to a limit [Hz].
    ///
    /// # Errors
    /// A cable model that has no stiffness at this equilibrium.
    pub fn dynamics(&self, linearisation: Linearisation, up_to_hz: f64) -> Result<(Dynamics, Vec<String>)> {
        let Self { robot, equilibrium, .. } = &*self.vibrating();
        let dynamics = Dynamics::about(robot, equilibrium, linearisation, up_to_hz)?;
        Ok((dynamics, self.warnings(Some((linearisation.cable_model, up_to_hz)))))
    }

    /// Robot linearised about its equilibrium as by [`dynamics`](Self::dynamics), for gradients of its vibrations.
    ///
    /// # Errors
    /// A cable model that has no stiffness at this equilibrium.
    pub(crate) fn dynamics_for_gradients(
        &self,
        linearisation: Linearisation,
        up_to_hz: f64,
    ) -> Result<(Dynamics, Vec<String>)> {
        let dynamics = Dynamics::for_gradients(&self.robot, &self.equilibrium, linearisation, up_to_hz)?;
        Ok((dynamics, self.warnings(Some((linearisation.cable_model, up_to_hz)))))
    }

    /// Modes below a limit [Hz] of the robot linearised about its equilibrium.
    ///
    /// # Errors
    /// A cable model that has no stiffness at this equilibrium, or more than `max_modes` modes below the limit.
    pub fn modes_below(&self, linearisation: Linearisation, limit_hz: f64, max_modes: usize) -> Result<ModesBelow> {
        Self::listed(self.dynamics(linearisation, limit_hz)?, limit_hz, max_modes)
    }

    /// Modes as by [`modes_below`](Self::modes_below), with their shares of the stretch.
    ///
    /// # Errors
    /// The errors of [`modes_below`](Self::modes_below).
    pub fn modes_with_strains(&self, linearisation: Linearisation, limit_hz: f64, max: usize) -> Result<ModesBelow> {
        let Self { robot, equilibrium, .. } = &*self.vibrating();
        let dynamics = Dynamics::with_strains(robot, equilibrium, linearisation, limit_hz)?;
        let warnings = self.warnings(Some((linearisation.cable_model, limit_hz)));
        Self::listed((dynamics, warnings), limit_hz, max)
    }

    fn listed(
        (dynamics, mut warnings): (Dynamics, Vec<String>),
        limit_hz: f64,
        max_modes: usize,
    ) -> Result<ModesBelow> {
        modes::check_count(&dynamics, limit_hz, max_modes)?;
        let modes = modes::below(&dynamics, limit_hz);
        warnings.extend(modes.caveat());
        Ok(ModesBelow { dynamics, modes, warnings })
    }
}

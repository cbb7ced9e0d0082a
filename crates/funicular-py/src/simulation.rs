//! `funicular.Simulation`: a robot in motion that advances by intervals.

use crate::arrays::{Number, Numbers, TextKeyed, Vector};
use crate::errors;
use crate::labels::Names;
use crate::pose::PyPose;
use funicular::math::Vec3;
use funicular::robot::Robot;
use funicular::simulation::{
    AnchorAtEnd, CutAt, LengthAtEnd, RobotSample, SimulationEvent, SimulationSettings, StepError, StepInputs,
    SteppedSimulation,
};
use funicular_study::at_rest::AtRest;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use std::sync::{Mutex, MutexGuard, TryLockError};

/// Robot in motion that advances by intervals, with inputs and events that are known only when they come.
///
/// Made by `Equilibrium.simulation`. Arrays with one entry per cable are in the order of the file. What raises an
/// exception leaves the simulation as it was.
#[pyclass(frozen, name = "Simulation", module = "funicular")]
pub(crate) struct PySimulation {
    names: Vec<String>,
    state: Mutex<State>,
}

/// Simulation with its present sample.
#[derive(Clone)]
struct State {
    simulation: SteppedSimulation,
    now: RobotSample,
}

/// One number per cable: a row, or a dictionary by names that leaves cables out.
#[derive(FromPyObject)]
pub(crate) enum PerCable<'py> {
    ByName(TextKeyed<'py>),
    Row(Numbers),
}

impl PerCable<'_> {
    /// Number of each cable; `None` for those that are left out.
    pub(crate) fn of(self, what: &str, names: &[String]) -> PyResult<Vec<Option<f64>>> {
        let by_name = match self {
            Self::ByName(by_name) => by_name.0,
            Self::Row(row) => {
                let row = row.named_row(what, &Names::of_cables(names, what))?;
                let (given, cables) = (row.len(), names.len());
                if given != cables {
                    let text =
                        format!("`{what}` has {given} numbers, and the robot has {cables} cables: give one each");
                    return Err(errors::input(text));
                }
                return Ok(row.into_iter().map(Some).collect());
            }
        };
        let mut found = vec![None; names.len()];
        for (name, value) in by_name.iter() {
            let name: String = name.extract()?;
            let place = place_of(what, &name, names)?;
            let Ok(number) = value.extract::<Number>();
            found[place] = Some(number.finite(&format!("{what}[{name}]"))?);
        }
        Ok(found)
    }
}

/// Place of a cable by its name.
fn place_of(what: &str, name: &str, names: &[String]) -> PyResult<usize> {
    names.iter().position(|of| of == name).ok_or_else(|| {
        let shown = crate::errors::shown(name);
        errors::input(format!("`{what}`: there is no cable \"{shown}\": the cables are {}", names.join(", ")))
    })
}

/// Vector of an argument; zero if it is not given.
fn vector(what: &str, given: Option<Numbers>) -> PyResult<Vec3> {
    given.map_or(Ok(Vec3::zeros()), |given| Ok(Vec3::from(given.three(what)?)))
}

impl PySimulation {
    pub(crate) fn begun(
        py: Python<'_>,
        at_rest: &AtRest,
        tension_control: &[String],
        settings: SimulationSettings,
    ) -> PyResult<Self> {
        let names: Vec<String> = at_rest.robot.cables.iter().map(|cable| cable.name.clone()).collect();
        let places = tension_control.iter().map(|name| place_of("tension_control", name, &names));
        let places: Vec<usize> = places.collect::<PyResult<_>>()?;
        let begun = py.detach(|| {
            let vibrating = at_rest.vibrating();
            let (robot, rest) = (&vibrating.robot, &vibrating.equilibrium);
            let mut simulation = SteppedSimulation::new(robot, rest, &places, &settings)?;
            let now = simulation.now();
            Ok(State { simulation, now })
        });
        let state = begun.map_err(|error: StepError| errors::step(&error))?;
        Ok(Self { names, state: Mutex::new(state) })
    }

    /// State, if no other thread is in it.
    fn state(&self) -> PyResult<MutexGuard<'_, State>> {
        match self.state.try_lock() {
            Ok(state) => Ok(state),
            Err(TryLockError::Poisoned(poisoned)) => Ok(poisoned.into_inner()),
            Err(TryLockError::WouldBlock) => {
                let text = "another thread is in this simulation: give each thread a simulation of its own, by `clone`";
                Err(errors::input(text.to_owned()))
            }
        }
    }

    /// Changes the simulation without Python's lock.
    fn change(
        &self,
        py: Python<'_>,
        change: impl Send + FnOnce(&mut SteppedSimulation) -> Result<(), StepError>,
    ) -> PyResult<()> {
        let mut guard = self.state()?;
        let state = &mut *guard;
        let changed = py.detach(|| {
            change(&mut state.simulation)?;
            state.now = state.simulation.now();
            Ok(())
        });
        changed.map_err(|error: StepError| errors::step(&error))
    }

    /// Lets an event happen that is made from the present time.
    fn happen(&self, py: Python<'_>, event: impl Send + FnOnce(f64) -> SimulationEvent) -> PyResult<()> {
        self.change(py, |simulation| {
            let event = event(simulation.time());
            simulation.happen(&event)
        })
    }

    fn vector_of(&self, of: impl Fn(&RobotSample) -> [f64; 3]) -> PyResult<Vector> {
        Ok(of(&self.state()?.now).into_iter().collect())
    }

    fn per_cable(&self, of: impl Fn(&funicular::simulation::CableSample) -> f64) -> PyResult<Vector> {
        Ok(self.state()?.now.cables.iter().map(of).collect())
    }
}

#[pymethods]
impl PySimulation {
    /// Advances by an interval. What is left out goes on as it is: lengths with their last rates, force and moment with
    /// their last rates, the wind.
    ///
    /// Parameters
    /// ----------
    /// dt_s
    ///     Interval [s], from 1e-6 to 1.
    /// lengths_m
    ///     Unstrained lengths at the end of the interval [m]: one per cable, or a dictionary by names.
    /// rates_m_s
    ///     Rates of these lengths at the end [m/s]. Without them a length may change by a micrometre.
    /// accelerations_m_s2
    ///     Accelerations of these lengths at the end [m/s²]; without them the course is a cubic polynomial.
    /// force_n
    ///     Force on the platform at the beginning, world axes [N], besides the load of the robot.
    /// moment_n_m
    ///     Moment at the beginning about the platform origin, world axes [N m].
    /// force_rate_n_s
    ///     Rate of the force [N/s]; zero if a force is given without.
    /// moment_rate_n_m_s
    ///     Rate of the moment [N m/s]; zero if a moment is given without.
    /// wind_m_s
    ///     Mean velocity of the wind, world axes [m/s].
    /// anchors_m
    ///     Places of anchors at the end of the interval, world axes [m]: a dictionary from names of cables to x, y, z.
    /// anchor_velocities_m_s
    ///     Velocities of these anchors at the end [m/s]. Without them an anchor may move by a micrometre.
    /// anchor_accelerations_m_s2
    ///     Accelerations of these anchors at the end [m/s²]; without them the course is a cubic polynomial.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     An input is wrong; the simulation is as it was.
    /// NoSolutionError
    ///     The motion cannot be followed; the simulation is as it was.
    #[pyo3(signature = (dt_s, *, lengths_m=None, rates_m_s=None, accelerations_m_s2=None, force_n=None,
        moment_n_m=None, force_rate_n_s=None, moment_rate_n_m_s=None, wind_m_s=None, anchors_m=None,
        anchor_velocities_m_s=None, anchor_accelerations_m_s2=None))]
    #[expect(clippy::too_many_arguments, reason = "keywords of Python")]
    fn step(
        &self,
        py: Python<'_>,
        dt_s: Number,
        lengths_m: Option<PerCable<'_>>,
        rates_m_s: Option<PerCable<'_>>,
        accelerations_m_s2: Option<PerCable<'_>>,
        force_n: Option<Numbers>,
        moment_n_m: Option<Numbers>,
        force_rate_n_s: Option<Numbers>,
        moment_rate_n_m_s: Option<Numbers>,
        wind_m_s: Option<Numbers>,
        anchors_m: Option<TextKeyed<'_>>,
        anchor_velocities_m_s: Option<TextKeyed<'_>>,
        anchor_accelerations_m_s2: Option<TextKeyed<'_>>,
    ) -> PyResult<()> {
        let interval = dt_s.value("dt_s")?;
        let mut inputs =
            StepInputs { lengths: self.commands(lengths_m, rates_m_s, accelerations_m_s2)?, ..StepInputs::default() };
        inputs.anchors = self.anchors(anchors_m, anchor_velocities_m_s, anchor_accelerations_m_s2)?;
        inputs.wind_w = wind_m_s.map(|wind| wind.three("wind_m_s")).transpose()?.map(Vec3::from);
        let force = force_n.map(|of| of.three("force_n")).transpose()?.map(Vec3::from);
        let moment = moment_n_m.map(|of| of.three("moment_n_m")).transpose()?.map(Vec3::from);
        let rates = [vector("force_rate_n_s", force_rate_n_s)?, vector("moment_rate_n_m_s", moment_rate_n_m_s)?];
        for (rate, of, name) in [(rates[0], force, "force"), (rates[1], moment, "moment")] {
            if rate != Vec3::zeros() && of.is_none() {
                return Err(errors::input(format!("a rate of the {name} needs the {name} itself: give both")));
            }
        }

        let mut guard = self.state()?;
        let state = &mut *guard;
        if force.is_some() || moment.is_some() {
            let mut wrench = state.simulation.held_wrench();
            if let Some(force_w) = force {
                (wrench.force_w, wrench.force_rate_w) = (force_w, rates[0]);
            }
            if let Some(moment_w) = moment {
                (wrench.moment_w, wrench.moment_rate_w) = (moment_w, rates[1]);
            }
            inputs.wrench = Some(wrench);
        }
        let stepped = py.detach(|| {
            state.now = state.simulation.step(interval, &inputs)?;
            Ok(())
        });
        stepped.map_err(|error: StepError| errors::step(&error))
    }

    /// Lets a payload go now.
    ///
    /// Parameters
    /// ----------
    /// mass_kg
    ///     Mass of the payload, a part of the platform's mass [kg].
    /// point_m
    ///     Point of the payload in the platform frame [m]; the centre of mass if not given.
    #[pyo3(signature = (mass_kg, point_m=None))]
    fn release(&self, py: Python<'_>, mass_kg: Number, point_m: Option<Numbers>) -> PyResult<()> {
        let mass = mass_kg.positive("mass_kg")?;
        let point_p = point_m.map(|point| point.three("point_m")).transpose()?.map(Vec3::from);
        self.happen(py, |time| SimulationEvent::Release { time, mass, point_p })
    }

    /// Takes a payload up now, a point mass that sticks to the platform.
    ///
    /// Parameters
    /// ----------
    /// mass_kg
    ///     Mass of the payload [kg].
    /// point_m
    ///     Point of the payload in the platform frame [m]; the centre of mass if not given.
    /// velocity_m_s
    ///     Velocity of the payload before, world axes [m/s]; that of the platform if not given.
    #[pyo3(signature = (mass_kg, point_m=None, *, velocity_m_s=None))]
    fn pick(
        &self,
        py: Python<'_>,
        mass_kg: Number,
        point_m: Option<Numbers>,
        velocity_m_s: Option<Numbers>,
    ) -> PyResult<()> {
        let mass = mass_kg.positive("mass_kg")?;
        let point_p = point_m.map(|point| point.three("point_m")).transpose()?.map(Vec3::from);
        let velocity_w = velocity_m_s.map(|velocity| velocity.three("velocity_m_s")).transpose()?.map(Vec3::from);
        self.happen(py, |time| SimulationEvent::Pick { time, mass, point_p, velocity_w })
    }

    /// Pushes the platform for a while from now on.
    ///
    /// Parameters
    /// ----------
    /// duration_s
    ///     Duration [s].
    /// force_n
    ///     Force, world axes [N].
    /// moment_n_m
    ///     Moment, world axes [N m].
    /// point_m
    ///     Point at which the force acts, platform frame [m]; the origin if not given.
    /// rise_s
    ///     Time in which the push grows at its beginning and fades at its end [s]; at once if not given.
    #[pyo3(signature = (duration_s, *, force_n=None, moment_n_m=None, point_m=None, rise_s=None))]
    fn push(
        &self,
        py: Python<'_>,
        duration_s: Number,
        force_n: Option<Numbers>,
        moment_n_m: Option<Numbers>,
        point_m: Option<Numbers>,
        rise_s: Option<Number>,
    ) -> PyResult<()> {
        let duration = duration_s.positive("duration_s")?;
        let rise = rise_s.map_or(Ok(0.0), |rise| rise.not_negative("rise_s"))?;
        let (force_w, moment_w) = (vector("force_n", force_n)?, vector("moment_n_m", moment_n_m)?);
        let point_p = vector("point_m", point_m)?;
        self.happen(py, |time| SimulationEvent::Push { time, duration, rise, force_w, moment_w, point_p })
    }

    /// Cuts a cable at the platform, now or when its tension at either end reaches a value.
    ///
    /// Parameters
    /// ----------
    /// cable
    ///     Name of the cable.
    /// at_tension_n
    ///     Tension at which it fails [N]; it is cut now if not given.
    #[pyo3(signature = (cable, *, at_tension_n=None))]
    fn cut(&self, py: Python<'_>, cable: String, at_tension_n: Option<Number>) -> PyResult<()> {
        let cable = place_of("cable", &cable, &self.names)?;
        let tension = at_tension_n.map(|tension| tension.positive("at_tension_n")).transpose()?;
        self.happen(py, |time| {
            let at = tension.map_or(CutAt::Time(time), CutAt::Tension);
            SimulationEvent::Cut { cable, at, place: 0.0 }
        })
    }

    /// Brings winches to rest, with a continuous acceleration.
    ///
    /// Parameters
    /// ----------
    /// duration_s
    ///     Duration [s].
    /// cables
    ///     Names of the cables; all if not given.
    #[pyo3(signature = (duration_s, cables=None))]
    fn stop(&self, py: Python<'_>, duration_s: Number, cables: Option<Vec<String>>) -> PyResult<()> {
        let duration = duration_s.positive("duration_s")?;
        let cables = match cables {
            Some(names) => names.iter().map(|name| place_of("cables", name, &self.names)).collect::<PyResult<_>>()?,
            None => (0..self.names.len()).collect(),
        };
        self.happen(py, |time| SimulationEvent::Stop { time, duration, cables })
    }

    /// Lets winches at rest change lengths within a time, from rest to rest.
    ///
    /// Parameters
    /// ----------
    /// changes_m
    ///     Changes of the unstrained lengths [m]: one per cable, or a dictionary by names.
    /// duration_s
    ///     Duration [s].
    fn change_lengths(&self, py: Python<'_>, changes_m: PerCable<'_>, duration_s: Number) -> PyResult<()> {
        let duration = duration_s.positive("duration_s")?;
        let changes: Vec<f64> =
            changes_m.of("changes_m", &self.names)?.into_iter().map(Option::unwrap_or_default).collect();
        if let Some(change) = changes.iter().find(|change| !change.is_finite()) {
            return Err(errors::input(format!("`changes_m` has {change}: give numbers")));
        }
        self.happen(py, |time| SimulationEvent::Ramp { time, duration, changes })
    }

    /// Lets winches hold tensions from now on in place of lengths, by their torque.
    ///
    /// Parameters
    /// ----------
    /// tensions_n
    ///     Tensions at the drums [N]: one per cable, or a dictionary by names.
    /// duration_s
    ///     Time within which the tension goes from the present one to the given one [s].
    fn hold_tensions(&self, py: Python<'_>, tensions_n: PerCable<'_>, duration_s: Number) -> PyResult<()> {
        let duration = duration_s.positive("duration_s")?;
        let tensions = tensions_n.of("tensions_n", &self.names)?;
        self.happen(py, |time| SimulationEvent::Tension { time, duration, tensions })
    }

    /// Returns the state as bytes, for `restore`.
    fn save<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        Ok(PyBytes::new(py, &self.state()?.simulation.save()))
    }

    /// Takes over a state that `save` returned, of a simulation with the same robot, start and settings. It goes on
    /// with the same bits.
    fn restore(&self, py: Python<'_>, state: &Bound<'_, PyBytes>) -> PyResult<()> {
        let bytes = state.as_bytes();
        self.change(py, |simulation| simulation.restore(bytes))
    }

    /// Returns a simulation of its own in the same state.
    fn clone(&self) -> PyResult<Self> {
        Ok(Self { names: self.names.clone(), state: Mutex::new(Clone::clone(&*self.state()?)) })
    }

    fn __copy__(&self) -> PyResult<Self> {
        self.clone()
    }

    fn __deepcopy__(&self, memo: &Bound<'_, PyAny>) -> PyResult<Self> {
        let _ = memo;
        self.clone()
    }

    /// Names of the cables, in the order of the file.
    #[getter]
    fn cable_names(&self) -> Vec<String> {
        self.names.clone()
    }

    /// Present time [s].
    #[getter]
    fn time_s(&self) -> PyResult<f64> {
        Ok(self.state()?.now.time)
    }

    /// Pose of the platform.
    #[getter]
    fn pose(&self) -> PyResult<PyPose> {
        Ok(PyPose::of(&self.state()?.now.pose))
    }

    /// Velocity of the platform origin, world axes [m/s].
    #[getter]
    fn velocity_m_s(&self) -> PyResult<Vector> {
        self.vector_of(|now| [0, 1, 2].map(|k| now.velocity_w[k]))
    }

    /// Angular velocity of the platform, world axes [rad/s].
    #[getter]
    fn angular_velocity_rad_s(&self) -> PyResult<Vector> {
        self.vector_of(|now| [3, 4, 5].map(|k| now.velocity_w[k]))
    }

    /// Acceleration of the platform origin, world axes [m/s²].
    #[getter]
    fn acceleration_m_s2(&self) -> PyResult<Vector> {
        self.vector_of(|now| [0, 1, 2].map(|k| now.acceleration_w[k]))
    }

    /// Angular acceleration of the platform, world axes [rad/s²].
    #[getter]
    fn angular_acceleration_rad_s2(&self) -> PyResult<Vector> {
        self.vector_of(|now| [3, 4, 5].map(|k| now.acceleration_w[k]))
    }

    /// Tensions at the platform [N].
    #[getter]
    fn tension_platform_n(&self) -> PyResult<Vector> {
        self.per_cable(|cable| cable.tension_platform)
    }

    /// Tensions at the anchors [N].
    #[getter]
    fn tension_anchor_n(&self) -> PyResult<Vector> {
        self.per_cable(|cable| cable.tension_anchor)
    }

    /// Unstrained lengths [m].
    #[getter]
    fn unstrained_length_m(&self) -> PyResult<Vector> {
        self.per_cable(|cable| cable.length.value)
    }

    /// Rates of the unstrained lengths [m/s].
    #[getter]
    fn length_rate_m_s(&self) -> PyResult<Vector> {
        self.per_cable(|cable| cable.length.rate)
    }

    /// Places of the anchors, world axes [m]: a row per cable.
    #[getter]
    fn anchors_m(&self) -> PyResult<Vec<[f64; 3]>> {
        let state = self.state()?;
        Ok((0..self.names.len()).map(|cable| state.simulation.anchor_motion(cable)[0].into()).collect())
    }

    /// Names of the cables that have been cut or have failed.
    #[getter]
    fn cut_cables(&self) -> PyResult<Vec<String>> {
        let state = self.state()?;
        let cut = state.now.cables.iter().zip(&self.names).filter(|(cable, _)| cable.is_cut);
        Ok(cut.map(|(_, name)| name.clone()).collect())
    }

    /// Energies at the present time and works since the start [J]: `kinetic`, `strain`, `potential`, `winches`,
    /// `anchors`, `loads`, `dissipated`, `payloads`, `defect`.
    #[getter]
    fn energy_j<'py>(&self, py: Python<'py>) -> PyResult<TextKeyed<'py>> {
        let energy = self.state()?.now.energy;
        let found = PyDict::new(py);
        for (name, value) in [
            ("kinetic", energy.kinetic),
            ("strain", energy.strain),
            ("potential", energy.potential),
            ("winches", energy.winches),
            ("anchors", energy.anchors),
            ("loads", energy.loads),
            ("dissipated", energy.dissipated),
            ("payloads", energy.payloads),
            ("defect", energy.defect()),
        ] {
            found.set_item(name, value)?;
        }
        Ok(TextKeyed(found))
    }

    /// Numbers of the integrator's own steps so far: `accepted`, `rejected`, `factored`, `evaluations`.
    #[getter]
    fn steps<'py>(&self, py: Python<'py>) -> PyResult<TextKeyed<'py>> {
        let counts = self.state()?.simulation.run().counts();
        let found = PyDict::new(py);
        found.set_item("accepted", counts.accepted)?;
        found.set_item("rejected", counts.rejected)?;
        found.set_item("factored", counts.factored)?;
        found.set_item("evaluations", counts.evaluations)?;
        Ok(TextKeyed(found))
    }

    fn __repr__(&self) -> PyResult<String> {
        let state = self.state()?;
        let Robot { name, .. } = state.simulation.robot();
        Ok(format!("<Simulation of {name:?} at {} s>", state.now.time))
    }
}

impl PySimulation {
    /// Commands of lengths from their numbers.
    fn commands(
        &self,
        lengths: Option<PerCable<'_>>,
        rates: Option<PerCable<'_>>,
        accelerations: Option<PerCable<'_>>,
    ) -> PyResult<Vec<Option<LengthAtEnd>>> {
        let read = |what: &str, of: Option<PerCable<'_>>| {
            of.map_or_else(|| Ok(vec![None; self.names.len()]), |of| of.of(what, &self.names))
        };
        let is_given = lengths.is_some() || rates.is_some() || accelerations.is_some();
        let lengths = read("lengths_m", lengths)?;
        let (rates, accelerations) = (read("rates_m_s", rates)?, read("accelerations_m_s2", accelerations)?);
        if !is_given {
            return Ok(Vec::new());
        }
        let command = |i: usize| match (lengths[i], rates[i], accelerations[i]) {
            (Some(length), rate, acceleration) => Ok(Some(LengthAtEnd { length, rate, acceleration })),
            (None, None, None) => Ok(None),
            _ => {
                let name = &self.names[i];
                Err(errors::input(format!(
                    "cable \"{name}\" has a rate or an acceleration without its length: give both"
                )))
            }
        };
        (0..self.names.len()).map(command).collect()
    }

    /// Places of anchors with their velocities and accelerations.
    fn anchors(
        &self,
        places: Option<TextKeyed<'_>>,
        velocities: Option<TextKeyed<'_>>,
        accelerations: Option<TextKeyed<'_>>,
    ) -> PyResult<Vec<Option<AnchorAtEnd>>> {
        if places.is_none() && velocities.is_none() && accelerations.is_none() {
            return Ok(Vec::new());
        }
        let read = |what: &str, of: Option<TextKeyed<'_>>| -> PyResult<Vec<Option<Vec3>>> {
            let mut found = vec![None; self.names.len()];
            let Some(of) = of else { return Ok(found) };
            for (name, value) in of.0.iter() {
                let name: String = name.extract()?;
                let place = place_of(what, &name, &self.names)?;
                found[place] = Some(Vec3::from(value.extract::<Numbers>()?.three(&format!("{what}[{name}]"))?));
            }
            Ok(found)
        };
        let places = read("anchors_m", places)?;
        let velocities = read("anchor_velocities_m_s", velocities)?;
        let accelerations = read("anchor_accelerations_m_s2", accelerations)?;
        let anchor = |i: usize| match (places[i], velocities[i], accelerations[i]) {
            (Some(place_w), velocity_w, acceleration_w) => {
                Ok(Some(AnchorAtEnd { place_w, velocity_w, acceleration_w }))
            }
            (None, None, None) => Ok(None),
            _ => {
                let name = &self.names[i];
                Err(errors::input(format!(
                    "the anchor of cable \"{name}\" has a velocity or an acceleration without its place: give both"
                )))
            }
        };
        (0..self.names.len()).map(anchor).collect()
    }
}

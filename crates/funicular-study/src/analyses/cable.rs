//! `cable`: dynamic stiffness of the platform end of one cable, with the anchor fixed.

use super::found;
use super::shared::{Axes, Origin, SagNumbers};
use crate::at_rest::{self, AtRest};
use crate::columns::{Columns, ResultTable, Tabled, column, parts};
use crate::error::{Cancelled, NoSolution};
use crate::names::suggestion;
use crate::request;
use crate::rows::rows;
use crate::table::Column;
use crate::watch::Watch;
use anyhow::{Result, bail};
use funicular::cable::{CableModel, EndStiffness, LocalAxes, LocalStiffness, Sag};
use funicular::dynamics::DynamicsError;
use funicular::math::{Complex, Mat3};
use funicular::robot::{Robot, WinchMode};
use funicular::warnings;
use std::f64::consts::TAU;

/// Number of frequencies between two looks at the watch: some milliseconds.
pub(crate) const STEP: usize = 256;

/// Maximum number of clamped frequencies in one list.
const MAX_CLAMPED: usize = 10_000;

rows! {
    /// Results of `cable`: stiffness of the platform end of one cable over frequency.
    pub struct CableResult {
        pub robot: String = hidden;
        pub name: String;
        pub static_model: &'static str;
        pub cable_model: &'static str;
        pub in_plane_only: bool;
        pub origin: Origin = spread;
        pub chord_m: f64;
        pub parallel_tension_n: f64;
        pub sag: SagNumbers = spread;
        /// Axes of the cable.
        pub axes: Axes;
        /// Undamped natural frequencies with both ends fixed; absent for cable models without them.
        pub clamped_frequencies_hz: Option<Vec<f64>>;
        pub frequency_hz: Vec<f64>;
        pub local: Local;
        pub world: World;
        pub warnings: Vec<String> = hidden;
    }
}

rows! {
    /// Stiffness along the chord, coupling, normal in plane and out of plane [N/m].
    #[derive(Default)]
    pub struct Local {
        pub k_a: ComplexValues;
        pub k_b: ComplexValues;
        pub k_c: ComplexValues;
        pub k_o: ComplexValues;
    }
}

rows! {
    /// Complex numbers over frequency.
    #[derive(Default)]
    pub struct ComplexValues {
        pub real: Vec<f64>;
        pub imag: Vec<f64>;
    }
}

rows! {
    /// 3×3 stiffness in world axes at each frequency [N/m].
    #[derive(Default)]
    pub struct World {
        pub real: Vec<[[f64; 3]; 3]>;
        pub imag: Vec<[[f64; 3]; 3]>;
    }
}

/// Computes the stiffness of the platform end of one cable over frequency, with the anchor fixed.
///
/// # Errors
/// A name that no cable has, a robot without such an equilibrium, or an undamped resonance at one of the frequencies.
pub fn run(robot: Robot, request: &request::CableRequest, watch: &mut dyn Watch) -> Result<CableResult> {
    let frequency_hz = request.range.frequencies()?;
    place(&robot, &request.name)?;
    let at_rest = at_rest::equilibrium(robot, &request.robot, &request.state, &request.tensions)?;
    let requested = RequestedCable {
        name: &request.name,
        frequency_hz,
        cable_model: request.cable_model,
        in_plane_only: request.in_plane_only,
        winches: request.winches,
    };
    about(&at_rest, requested, watch)
}

/// Requested cable of a robot at equilibrium.
#[derive(Debug)]
pub struct RequestedCable<'a> {
    /// Name of the cable.
    pub name: &'a str,
    /// Frequencies [Hz], none negative, at least one.
    pub frequency_hz: Vec<f64>,
    /// Cable model. The default depends on the static model.
    pub cable_model: Option<CableModel>,
    /// Leave out the out-of-plane stiffness of the cable.
    pub in_plane_only: bool,
    /// Winches in vibration.
    pub winches: WinchMode,
}

/// Index of a cable in the robot.
fn place(robot: &Robot, name: &str) -> Result<usize> {
    let Some(i) = robot.cables.iter().position(|cable| cable.name == name) else {
        let names: Vec<String> = robot.cables.iter().map(|cable| cable.name.clone()).collect();
        bail!("the robot has no cable \"{name}\"{}", suggestion(name, &names))
    };
    Ok(i)
}

/// Computes the stiffness of one cable of a robot at equilibrium.
///
/// # Errors
/// The errors of [`run`].
pub fn about(at_rest: &AtRest, requested: RequestedCable<'_>, watch: &mut dyn Watch) -> Result<CableResult> {
    let RequestedCable { name, frequency_hz, cable_model, in_plane_only, winches } = requested;
    let at_rest = &*at_rest.vibrating();
    let i = place(&at_rest.robot, name)?;
    let (from_hz, to_hz) =
        frequency_hz.iter().fold((f64::INFINITY, 0.0_f64), |(from, to), hz| (from.min(*hz), to.max(*hz)));
    let (robot, state) = (&at_rest.robot, &at_rest.equilibrium.cables[i]);
    let model: CableModel = at_rest::cable_model(cable_model, at_rest.equilibrium.model);

    let stiffness = EndStiffness::new(robot, i, state, model, in_plane_only, winches, to_hz)
        .map_err(|reason| DynamicsError::of_cable(name, model, reason))?;
    let sag = Sag::of(robot, i, state);
    let of_cable = warnings::of_cable(robot, &at_rest.equilibrium, i, model, to_hz);
    let axes = LocalAxes::of_cable(robot, i, state);
    let values = curve(&stiffness, &axes, &frequency_hz, watch)?;
    let part = |of: fn(&LocalStiffness<Complex>) -> Complex| ComplexValues {
        real: values.iter().map(|k| of(k).re + 0.0).collect(),
        imag: values.iter().map(|k| of(k).im + 0.0).collect(),
    };
    let world = |of: fn(&Complex) -> f64| {
        values.iter().map(|k| rows(&k.map(of).in_world(&axes))).collect::<Vec<[[f64; 3]; 3]>>()
    };

    Ok(CableResult {
        robot: robot.name.clone(),
        name: name.to_owned(),
        static_model: at_rest.equilibrium.model.name(),
        cable_model: model.name(),
        in_plane_only,
        origin: Origin::of(at_rest),
        chord_m: sag.chord,
        parallel_tension_n: sag.tension,
        sag: SagNumbers::of(&sag),
        axes: Axes::of(&axes),
        clamped_frequencies_hz: clamped(&stiffness, from_hz, to_hz)?,
        local: Local {
            k_a: part(|k| k.axial),
            k_b: part(|k| k.coupling),
            k_c: part(|k| k.normal),
            k_o: part(|k| k.out_of_plane),
        },
        world: World { real: world(|k| k.re), imag: world(|k| k.im) },
        frequency_hz,
        warnings: at_rest.implausible().chain(of_cable.iter().map(ToString::to_string)).collect(),
    })
}

/// Stiffness in the axes of the chord at each frequency [Hz].
fn curve(
    stiffness: &EndStiffness,
    axes: &LocalAxes,
    frequency_hz: &[f64],
    watch: &mut dyn Watch,
) -> Result<Vec<LocalStiffness<Complex>>> {
    frequency_hz
        .iter()
        .enumerate()
        .map(|(place, &f)| {
            if place % STEP == 0 {
                watch.progress(place, frequency_hz.len(), "frequencies");
                if watch.is_cancelled() {
                    return Err(Cancelled.into());
                }
            }
            let k = match stiffness {
                EndStiffness::Constant(world) => in_axes(world, axes),
                EndStiffness::Dynamic(form) => turned(&form.damped(f * TAU), form.axes(), axes),
            };
            let numbers = [k.axial, k.coupling, k.normal, k.out_of_plane].into_iter().chain(k.across);
            let finite = numbers.into_iter().all(|k| k.re.is_finite() && k.im.is_finite());
            if finite {
                Ok(k)
            } else {
                let reason = "is not finite: an undamped natural frequency of the clamped cable lies there; give the \
                              rope damping or choose other frequencies";
                Err(NoSolution(format!("the stiffness at {f} Hz {reason}")).into())
            }
        })
        .collect()
}

/// Transforms a stiffness from the axes of its model to the axes of the chord.
fn turned(k: &LocalStiffness<Complex>, from: &LocalAxes, to: &LocalAxes) -> LocalStiffness<Complex> {
    if from == to {
        return *k;
    }
    let [re, im] = [k.map(|k| k.re), k.map(|k| k.im)].map(|part| in_axes(&part.in_world(from), to));
    let i = Complex::i();
    LocalStiffness {
        axial: re.axial + i * im.axial,
        coupling: re.coupling + i * im.coupling,
        normal: re.normal + i * im.normal,
        out_of_plane: re.out_of_plane + i * im.out_of_plane,
        across: [0, 1].map(|axis| re.across[axis] + i * im.across[axis]),
    }
}

/// Transforms a symmetric stiffness from world axes to the axes of the cable.
fn in_axes(world: &Mat3, axes: &LocalAxes) -> LocalStiffness<Complex> {
    let LocalAxes { e, n, b } = axes;
    let between = |u: &funicular::math::Vec3, v: &funicular::math::Vec3| Complex::new(u.dot(&(world * v)), 0.0);
    LocalStiffness {
        axial: between(e, e),
        coupling: between(e, n),
        normal: between(n, n),
        out_of_plane: between(b, b),
        across: [between(e, b), between(n, b)],
    }
}

fn rows(matrix: &Mat3) -> [[f64; 3]; 3] {
    std::array::from_fn(|i| std::array::from_fn(|j| matrix[(i, j)] + 0.0))
}

/// Natural frequencies of the cable with both ends fixed, within the range [Hz].
fn clamped(stiffness: &EndStiffness, from_hz: f64, to_hz: f64) -> Result<Option<Vec<f64>>> {
    let EndStiffness::Dynamic(form) = stiffness else { return Ok(None) };
    let limit = to_hz * TAU;
    let count = form.clamped_modes_below(limit);
    if count > MAX_CLAMPED {
        bail!(
            "the cable has {count} clamped frequencies below {to_hz} Hz; at most {MAX_CLAMPED} are listed: lower \
             ⟪to_hz⟫"
        );
    }
    let all = form.clamped_frequencies_below(limit).into_iter().map(|omega| omega / TAU);
    Ok(Some(all.filter(|f| *f >= from_hz).collect()))
}

/// Stiffness of a cable at a frequency.
struct StiffnessAt<'a> {
    found: &'a CableResult,
    index: usize,
}

impl StiffnessAt<'_> {
    fn columns() -> Columns<Self> {
        /// The matrix is symmetric: its upper half is written.
        const UPPER: [(usize, usize, &str); 6] =
            [(0, 0, "xx"), (0, 1, "xy"), (0, 2, "xz"), (1, 1, "yy"), (1, 2, "yz"), (2, 2, "zz")];
        type Part = fn(&Local) -> &ComplexValues;
        const LOCAL: [(&str, &str, Part); 4] = [
            ("a", "along the chord", |local| &local.k_a),
            ("b", "coupling of chord and normal", |local| &local.k_b),
            ("c", "normal in plane", |local| &local.k_c),
            ("o", "out of plane", |local| &local.k_o),
        ];
        let frequency = column("frequency_hz", "Hz", "frequency", |row: &Self| row.found.frequency_hz[row.index]);
        let local = LOCAL.into_iter().map(|(name, about, of)| {
            parts(
                &format!("k_{name}_{{}}_n_per_m"),
                ["real", "imag"],
                "N/m",
                &format!("stiffness {about}, {{}} part"),
                move |row: &Self| {
                    let values = of(&row.found.local);
                    [values.real[row.index], values.imag[row.index]]
                },
            )
        });
        let world = UPPER.into_iter().map(|(i, j, name)| {
            parts(
                &format!("k_{name}_{{}}_n_per_m"),
                ["real", "imag"],
                "N/m",
                &format!("stiffness {name} in world axes, {{}} part"),
                move |row: &Self| {
                    let World { real, imag } = &row.found.world;
                    [real[row.index][i][j], imag[row.index][i][j]]
                },
            )
        });
        Columns::new(std::iter::once(frequency).chain(local).chain(world))
    }
}

impl Tabled for CableResult {
    fn tables() -> Vec<(&'static str, Vec<Column>)> {
        vec![("", StiffnessAt::columns().described())]
    }

    fn table(&self) -> ResultTable<'_> {
        let rows = (0..self.frequency_hz.len()).map(|index| StiffnessAt { found: self, index });
        ResultTable::new(StiffnessAt::columns(), rows)
    }
}

found!(CableResult, "cable");

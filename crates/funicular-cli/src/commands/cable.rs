//! `cable`: the dynamic stiffness of one cable's platform end, anchor held.

use crate::args::CableArgs;
use crate::errors::NoSolution;
use crate::grid;
use crate::output::Results;
use crate::state::{self, SagNumbers};
use crate::table::{Table, counted, decimals, significant};
use anyhow::{Result, bail};
use funicular::cable::{CableModel, EndStiffness, LocalAxes, LocalStiffness, Sag};
use funicular::dynamics::DynamicsError;
use funicular::math::{Complex, Mat3};
use funicular::robot::Robot;
use funicular::statics::CableState;
use funicular_files::edit;
use serde::Serialize;
use std::f64::consts::TAU;

/// Most clamped frequencies of one list.
const MOST_CLAMPED: usize = 10_000;

#[derive(Serialize)]
pub(crate) struct CableResult {
    #[serde(skip)]
    robot: String,
    name: String,
    static_model: &'static str,
    cable_model: &'static str,
    in_plane_only: bool,
    chord_m: f64,
    parallel_tension_n: f64,
    #[serde(flatten)]
    sag: SagNumbers,
    /// Unit vectors along the chord, in plane and out of plane, world axes.
    axes: Axes,
    /// Undamped, both ends held; absent for the models without them.
    #[serde(skip_serializing_if = "Option::is_none")]
    clamped_frequencies_hz: Option<Vec<f64>>,
    frequency_hz: Vec<f64>,
    local: Local,
    world: World,
    #[serde(skip)]
    warnings: Vec<String>,
}

#[derive(Serialize)]
pub(crate) struct Axes {
    e: [f64; 3],
    n: [f64; 3],
    b: [f64; 3],
}

impl Axes {
    pub(crate) fn of(axes: &LocalAxes) -> Self {
        Self { e: axes.e.into(), n: axes.n.into(), b: axes.b.into() }
    }
}

/// Along the chord, coupling, normal in plane, out of plane [N/m].
#[derive(Serialize)]
#[expect(clippy::struct_field_names, reason = "the symbols of the cited equations, and the keys of the JSON")]
struct Local {
    k_a: Curve,
    k_b: Curve,
    k_c: Curve,
    k_o: Curve,
}

#[derive(Serialize)]
struct Curve {
    real: Vec<f64>,
    imag: Vec<f64>,
}

/// 3×3 in world axes at each frequency [N/m].
#[derive(Serialize)]
struct World {
    real: Vec<[[f64; 3]; 3]>,
    imag: Vec<[[f64; 3]; 3]>,
}

pub(crate) fn run(robot: Robot, args: &CableArgs) -> Result<CableResult> {
    let frequency_hz = grid::frequencies(&args.range)?;
    let Some(i) = robot.cables.iter().position(|cable| cable.name == args.name) else {
        let names: Vec<String> = robot.cables.iter().map(|cable| cable.name.clone()).collect();
        bail!("the robot has no cable \"{}\"{}", args.name, edit::suggestion(&args.name, &names))
    };
    let at_rest = state::equilibrium(robot, &args.state)?;
    let (robot, state) = (&at_rest.robot, &at_rest.equilibrium.cables[i]);
    let model: CableModel = state::cable_model(args.cable_model, at_rest.equilibrium.model);
    let stiffness = EndStiffness::new(robot, i, state, model, args.in_plane_only, args.range.to_hz)
        .map_err(|reason| DynamicsError::of_cable(&args.name, model, reason))?;
    let sag = Sag::of(robot, i, state);
    let axes = LocalAxes::of_cable(robot, i, state);
    let values = curve(&stiffness, &axes, &frequency_hz)?;
    let part = |of: fn(&LocalStiffness<Complex>) -> Complex| Curve {
        real: values.iter().map(|k| of(k).re + 0.0).collect(),
        imag: values.iter().map(|k| of(k).im + 0.0).collect(),
    };
    let world = |of: fn(&Complex) -> f64| {
        values.iter().map(|k| rows(&in_part(k, of).in_world(&axes))).collect::<Vec<[[f64; 3]; 3]>>()
    };
    Ok(CableResult {
        robot: robot.name.clone(),
        name: args.name.clone(),
        static_model: at_rest.equilibrium.model.name(),
        cable_model: model.name(),
        in_plane_only: args.in_plane_only,
        chord_m: sag.chord,
        parallel_tension_n: sag.tension,
        sag: SagNumbers::of(&sag),
        axes: Axes::of(&axes),
        clamped_frequencies_hz: clamped(&stiffness, args)?,
        local: Local {
            k_a: part(|k| k.axial),
            k_b: part(|k| k.coupling),
            k_c: part(|k| k.normal),
            k_o: part(|k| k.out_of_plane),
        },
        world: World { real: world(|k| k.re), imag: world(|k| k.im) },
        frequency_hz,
        warnings: warnings(robot, i, state, &sag, model, args),
    })
}

/// The four numbers at each frequency [Hz].
fn curve(stiffness: &EndStiffness, axes: &LocalAxes, frequency_hz: &[f64]) -> Result<Vec<LocalStiffness<Complex>>> {
    frequency_hz
        .iter()
        .map(|&f| {
            let k = match stiffness {
                EndStiffness::Constant(world) => in_axes(world, axes),
                EndStiffness::Dynamic(form) => turned(&form.damped(f * TAU), form.axes(), axes),
            };
            let finite =
                [k.axial, k.coupling, k.normal, k.out_of_plane].iter().all(|k| k.re.is_finite() && k.im.is_finite());
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

/// A stiffness in the axes of its model, in the axes of the chord.
fn turned(k: &LocalStiffness<Complex>, from: &LocalAxes, to: &LocalAxes) -> LocalStiffness<Complex> {
    if from == to {
        return *k;
    }
    let part = |of: fn(&Complex) -> f64| in_axes(&in_part(k, of).in_world(from), to);
    let (re, im) = (part(|k| k.re), part(|k| k.im));
    let join = |re: Complex, im: Complex| Complex::new(re.re, im.re);
    LocalStiffness {
        axial: join(re.axial, im.axial),
        coupling: join(re.coupling, im.coupling),
        normal: join(re.normal, im.normal),
        out_of_plane: join(re.out_of_plane, im.out_of_plane),
    }
}

/// A symmetric stiffness in world axes, in the axes of the cable.
fn in_axes(world: &Mat3, axes: &LocalAxes) -> LocalStiffness<Complex> {
    let LocalAxes { e, n, b } = axes;
    let between = |u: &funicular::math::Vec3, v: &funicular::math::Vec3| Complex::new(u.dot(&(world * v)), 0.0);
    LocalStiffness { axial: between(e, e), coupling: between(e, n), normal: between(n, n), out_of_plane: between(b, b) }
}

fn in_part(k: &LocalStiffness<Complex>, of: fn(&Complex) -> f64) -> LocalStiffness<f64> {
    LocalStiffness {
        axial: of(&k.axial),
        coupling: of(&k.coupling),
        normal: of(&k.normal),
        out_of_plane: of(&k.out_of_plane),
    }
}

fn rows(matrix: &Mat3) -> [[f64; 3]; 3] {
    std::array::from_fn(|i| std::array::from_fn(|j| matrix[(i, j)] + 0.0))
}

/// Frequencies of the cable with both ends held in the range [Hz].
fn clamped(stiffness: &EndStiffness, args: &CableArgs) -> Result<Option<Vec<f64>>> {
    let EndStiffness::Dynamic(form) = stiffness else { return Ok(None) };
    let limit = args.range.to_hz * TAU;
    let count = form.clamped_modes_below(limit);
    if count > MOST_CLAMPED {
        bail!(
            "the cable has {count} clamped frequencies below {} Hz, at most {MOST_CLAMPED} are listed: lower --to-hz",
            args.range.to_hz
        );
    }
    let all = form.clamped_frequencies_below(limit).into_iter().map(|omega| omega / TAU);
    Ok(Some(all.filter(|f| *f >= args.range.from_hz).collect()))
}

/// What the core warns of, for this cable alone.
fn warnings(
    robot: &Robot,
    i: usize,
    state: &CableState,
    sag: &Sag,
    model: CableModel,
    args: &CableArgs,
) -> Vec<String> {
    use funicular::validity::{AXIAL_PART, DeepSag, Warning};
    let cable = args.name.clone();
    let mut warnings = Vec::new();
    if state.is_slack() {
        warnings.push(Warning::Slack { cable: cable.clone() });
    }
    if let Some(deep) = DeepSag::of(robot, i, state, model) {
        warnings.push(Warning::DeepSag { cables: vec![deep], model });
    }
    let (axial_hz, below_hz) = (sag.axial_frequency_hz(), args.range.to_hz);
    if model != CableModel::Exact && below_hz > AXIAL_PART * axial_hz {
        warnings.push(Warning::AxialWaves { cable, axial_hz, below_hz });
    }
    warnings.iter().map(ToString::to_string).collect()
}

fn line(label: &str, text: &str) -> String {
    format!("  {label:<24} {text}\n")
}

impl Results for CableResult {
    const COMMAND: &'static str = "cable";

    fn robot(&self) -> &str {
        &self.robot
    }

    fn warnings(&self) -> &[String] {
        &self.warnings
    }

    fn text(&self) -> String {
        let mut out = format!(
            "{}: cable \"{}\", stiffness of its platform end\n{} statics, {} model{}\n\n",
            self.robot,
            self.name,
            self.static_model,
            self.cable_model,
            if self.in_plane_only { ", in plane only" } else { "" }
        );
        let mut say = |label: &str, text: String| out.push_str(&line(label, &text));
        say("chord", format!("{} m", decimals(self.chord_m, 4)));
        say("tension along the chord", format!("{} N", significant(self.parallel_tension_n, 6)));
        if let (Some(ratio), Some(lambda2)) = (self.sag.sag_ratio, self.sag.lambda2) {
            say("sag/chord", decimals(ratio, 5));
            say("λ²", significant(lambda2, 5));
        }
        if let Some(string) = self.sag.string_frequency_hz {
            say("taut string", format!("{} Hz", significant(string, 5)));
        }
        if let Some(clamped) = &self.clamped_frequencies_hz {
            const SHOWN: usize = 12;
            let shown: Vec<String> = clamped.iter().take(SHOWN).map(|f| decimals(*f, 4)).collect();
            let more = if clamped.len() > SHOWN { ", …" } else { "" };
            let count = counted(clamped.len(), "clamped frequency").replace("frequencys", "frequencies");
            say(
                &count,
                format!("{}{more}{}", shown.join(", "), if clamped.is_empty() { "in the range" } else { " Hz" }),
            );
        }
        let mut table = Table::new(&["f [Hz]", "|k_a| [N/m]", "|k_b| [N/m]", "|k_c| [N/m]", "|k_o| [N/m]"]);
        let Local { k_a, k_b, k_c, k_o } = &self.local;
        let last = self.frequency_hz.len() - 1;
        const ROWS: usize = 10;
        let mut places: Vec<usize> = (0..=ROWS).map(|row| row * last / ROWS).collect();
        places.dedup();
        for i in places {
            let size = |curve: &Curve| significant(curve.real[i].hypot(curve.imag[i]), 5);
            table.row(vec![significant(self.frequency_hz[i], 5), size(k_a), size(k_b), size(k_c), size(k_o)]);
        }
        format!(
            "{out}\nAlong the chord (a), coupling (b), normal in plane (c), out of plane (o)\n{table}\n\
             All {} frequencies, complex and in world axes: --format csv or --format json.\n",
            self.frequency_hz.len()
        )
    }

    fn csv(&self, out: &mut csv::Writer<Vec<u8>>) -> csv::Result<()> {
        // The matrix is symmetric: its upper half.
        const UPPER: [(usize, usize, &str); 6] =
            [(0, 0, "xx"), (0, 1, "xy"), (0, 2, "xz"), (1, 1, "yy"), (1, 2, "yz"), (2, 2, "zz")];
        let names = ["a", "b", "c", "o"].into_iter().chain(UPPER.map(|(_, _, name)| name));
        let columns = names.flat_map(|name| ["real", "imag"].map(|part| format!("k_{name}_{part}_n_per_m")));
        out.write_record(std::iter::once("frequency_hz".to_owned()).chain(columns))?;
        let Local { k_a, k_b, k_c, k_o } = &self.local;
        for (i, frequency) in self.frequency_hz.iter().enumerate() {
            let local = [k_a, k_b, k_c, k_o].map(|k| (k.real[i], k.imag[i]));
            let world =
                UPPER.map(|(row, column, _)| (self.world.real[i][row][column], self.world.imag[i][row][column]));
            out.serialize((frequency, local, world))?;
        }
        Ok(())
    }
}

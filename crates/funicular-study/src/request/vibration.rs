//! Requests about vibration.

use super::MAX_STATIONS;
use super::key::{Key, declared};
use super::parts::{
    FrequencyRange, Model, NumberColumns, OneOrSeveral, ResponsePoints, ResponseRange, RobotText, State, Tensions,
    Terms,
};
use crate::names::{ModelForm, optional};
use funicular::cable::CableModel;
use funicular::compare::TOLERANCE;
use funicular::modes::PLATFORM_SHARE;
use funicular::modes::damped::DECAY_PERCENT;
use funicular::robot::{TurbulenceSpectrum, WinchMode};

declared! {
    /// Every natural frequency below a limit, with a count that proves that none is missing.
    pub struct ModesRequest {
        /// Robot file.
        robot: RobotText = RobotText::default() => (Data(shape::robot)).required();
        /// Upper limit of the frequencies [Hz].
        below_hz: Option<f64> = None =>
            (Number(Positive)).otherwise("slightly above the 20 lowest; with rigid cables above all");
        /// Input of a response (see `frf`): also show the contribution of each mode to this response; needs ⟪output⟫.
        input: Option<String> = None => (Written(ProgramForm::Input)).form("INPUT").needs("output");
        /// Output of that response; needs ⟪input⟫.
        output: Option<String> = None => (Written(ProgramForm::Output)).form("OUTPUT").needs("input");
        /// Points of the platform.
        #[serde(flatten)]
        points: ResponsePoints = ResponsePoints::default() => group;
        /// Number of points along every cable whose displacements in each mode are listed, ends included; only in JSON.
        stations: Option<usize> = None => (Count(2..=MAX_STATIONS as u64));
        /// Minimum fraction of the kinetic energy in the platform for a mode that counts as a mode of the platform.
        platform_share: f64 = PLATFORM_SHARE => (Number(Fraction));
        /// Percentage of its amplitude to which a mode decays in the time that is listed.
        decay_percent: f64 = DECAY_PERCENT => (Number(Positive));
        /// Compute the damped mode of every undamped mode; otherwise damping ratios are of first order in the damping.
        damped: bool = true => (Switch).option(Key::NOT_IN_PROGRAM);
        /// State and loads.
        #[serde(flatten)]
        state: State = State::default() => group;
        /// Rule and limits of tensions.
        #[serde(flatten)]
        tensions: Tensions = Tensions::default() => group;
        /// Linearisation.
        #[serde(flatten)]
        model: Model = Model::default() => group;
        /// Modes with cables that are straight, without mass and rigid in length: how a platform swings on fewer cables
        /// than it has degrees of freedom; with ideal as ⟪static_model⟫.
        rigid_cables: bool = false => (Switch).under("Model");
    }
    examples {
        "funicular modes robots/yuan2014-4mm.toml --below-hz 20",
        "funicular modes robots/yuan2014-4mm.toml --below-hz 5 --input fz --output az",
        "funicular modes robots/yuan2014-4mm.toml --below-hz 5 --stations 21 -o modes.json",
        "funicular modes robots/yuan2014-4mm.toml --below-hz 5 -o modes.uff",
        "funicular modes robots/cogiro.toml --below-hz 10 --cable-model spring -o modes.csv",
        "funicular modes robots/cogiro.toml --pose 1,2,1.5 --tension-rule middle --below-hz 8 --platform-share 0.75",
        "funicular modes robots/grab-3-cables.toml --static-model ideal --rigid-cables --below-hz 10",
        "funicular modes robots/cogiro.toml --below-hz 5 --figure-mode 3 -o shape.pdf",
    }
}

declared! {
    /// Frequency response of the platform or of points on cables, and its peaks.
    pub struct FrfRequest {
        /// Robot file.
        robot: RobotText = RobotText::default() => (Data(shape::robot)).required();
        /// Frequencies.
        #[serde(flatten)]
        range: ResponseRange = ResponseRange::default() => group;
        /// Add frequencies until every peak has its height (to 0.1 %) and straight lines over the logarithm of the
        /// magnitude are accurate to 1 %.
        adaptive: bool = false => (Switch);
        /// Input: force fx, fy, fz, moment mx, my, mz, or f:ux,uy,uz, m:ux,uy,uz along a direction, world axes; a force
        /// on a cable, as in cable:3@0.5:fz; the commanded length of a cable, length:3, a force of its motor or on its
        /// drum, motor:3, drum:3; a motion of the base, base-x to base-rz, or of an anchor, anchor:3:x (repeatable).
        input: OneOrSeveral = OneOrSeveral::One(DEFAULT_INPUT.to_owned()) => (OneOrMore(ProgramForm::Input))
            .form("INPUT");
        /// Output: displacement x, y, z, rotation rx, ry, rz, velocity vx … vrz, acceleration ax … arz, or x:ux,uy,uz,
        /// v:…, a:… along a direction, world axes; the motion of a point on a cable (name, fraction of its length from
        /// the platform), as in cable:3@0.5:az; the motion of a drum or motor, drum:3, motor:3, or the tension at the
        /// platform or at the drum, tension:3, drum-tension:3 (repeatable).
        output: OneOrSeveral = OneOrSeveral::One(DEFAULT_OUTPUT.to_owned()) => (OneOrMore(ProgramForm::Output))
            .form("OUTPUT");
        /// Points of the platform.
        #[serde(flatten)]
        signal_points: ResponsePoints = ResponsePoints::default() => group;
        /// Minimum height of a peak above the valleys beside it [dB].
        prominence_db: f64 = 1.0 => (Number(NotNegative));
        /// State and loads.
        #[serde(flatten)]
        state: State = State::default() => group;
        /// Rule and limits of tensions.
        #[serde(flatten)]
        tensions: Tensions = Tensions::default() => group;
        /// Linearisation.
        #[serde(flatten)]
        model: Model = Model::default() => group;
    }
    examples {
        "funicular frf robots/yuan2014-4mm.toml --from-hz 0.1 --to-hz 10 --points 2000 \\\n    --input fz --output ay",
        "funicular frf robots/yuan2014-4mm.toml --from-hz 0.1 --to-hz 100 --points 5000 --log \\\n    --input f:1,0,1 \
         --output x --output-point-m 0,0,-0.2 -o frf.csv",
        "funicular frf robots/yuan2014-4mm.toml --from-hz 0.1 --to-hz 10 --adaptive \\\n    --input fz --output ay",
        "funicular frf robots/yuan2014-4mm.toml --from-hz 0.1 --to-hz 10 --adaptive \\\n    --input fx --input fz \
         --output x --output cable:3@0.5:az -o frf.json",
        "funicular frf robots/yuan2014-4mm.toml --from-hz 0.1 --to-hz 10 --points 2000 \\\n    --input fz --output az \
         --output-point-m 0.1,0.08,0.02 -o frf.uff",
        "funicular frf robots/yuan2014-4mm.toml --from-hz 0.1 --to-hz 10 --adaptive \\\n    --input fz --output az \
         --figure-width-mm ieee-single -o frf.pdf",
    }
}

declared! {
    /// Swing of a point of the platform after a release, a stop, a move or a trajectory, when it has settled, and
    /// input shapers against it.
    ///
    /// The state is that at the end: the rest after the release, the pose at which the command ends. The motion is
    /// linear about it.
    pub struct SettleRequest {
        /// Robot file.
        robot: RobotText = RobotText::default() => (Data(shape::robot)).required();
        /// Force on the platform that is released, at ⟪input_point_m⟫, world axes [N].
        release_n: Option<[f64; 3]> = None => (Vector).otherwise("none");
        /// Moment on the platform that is released, world axes [N m].
        release_n_m: Option<[f64; 3]> = None => (Vector).otherwise("none");
        /// Velocity of the platform before it stops, world axes [m/s]; its lengths command it.
        stop_m_s: Option<[f64; 3]> = None => (Vector).otherwise("none");
        /// Angular velocity of the platform before it stops, world axes [rad/s].
        stop_rad_s: Option<[f64; 3]> = None => (Vector).otherwise("none");
        /// Displacement of the platform from rest to rest, world axes [m]; its lengths command it.
        move_m: Option<[f64; 3]> = None => (Vector).otherwise("none");
        /// Rotation vector of the platform from rest to rest, world axes [degrees].
        move_deg: Option<[f64; 3]> = None => (Vector).otherwise("none");
        /// Trajectory that the lengths command, from rest to rest: columns t_s [s], and either x_m, y_m, z_m, roll_deg,
        /// pitch_deg, yaw_deg or unstrained_length_NAME_m of every cable [m]; between the rows the lengths change in
        /// straight lines. Without a pose and lengths the state is that of the last row.
        trajectory: Option<NumberColumns> = None => (Columns).read_by(Reader::Columns, "the trajectory");
        /// Times of the command [s], each at most the one before. A move has T1 from the start of the acceleration to
        /// the start of the deceleration, T2 for each of the two, and T3 for each change of the acceleration; a stop
        /// has T1 for the deceleration, and T2 and T3 for its changes. The command takes their sum; without them a stop
        /// is sudden.
        profile_s: Option<Vec<f64>> = None => (Commas(ProgramForm::NotNegative)).form("T1[,T2[,T3]]").otherwise("none");
        /// Input shaper of the command: zv, zvd, or ei:V, which leaves the fraction V of a vibration, as in
        /// ei:0.05.
        shaper: Option<String> = None => (Text).form("zv|zvd|ei:V").otherwise("none");
        /// Natural frequencies of the modes whose vibration the shaper cancels [Hz].
        shape_modes_hz: Option<Vec<f64>> = None => (Commas(ProgramForm::Positive)).form("F1,F2,…")
            .otherwise("the modes with the largest amplitudes, at most three, until their sum is within the tolerance");
        /// Payloads [kg] with which the vibration after the same lengths is listed as well. Their centre of mass is
        /// that of the `[required]` payload of the file, or that of the platform.
        robust_payload_kg: Option<Vec<f64>> = None => (Commas(ProgramForm::NotNegative)).form("M1,M2,…")
            .otherwise("none");
        /// Time between the samples of the commanded lengths, which are then listed [s].
        sample_time_s: Option<f64> = None => (Number(Positive)).otherwise("no samples");
        /// Points of the platform.
        #[serde(flatten)]
        points: ResponsePoints = ResponsePoints::default() => group;
        /// Distance from its rest within which the point has settled [m].
        tolerance_m: f64 = SETTLED_WITHIN => (Number(Positive));
        /// Upper limit of the frequencies of the modes that take part [Hz].
        below_hz: Option<f64> = None =>
            (Number(Positive)).otherwise("above all modes of the platform");
        /// State and loads.
        #[serde(flatten)]
        state: State = State::default() => group;
        /// Rule and limits of tensions.
        #[serde(flatten)]
        tensions: Tensions = Tensions::default() => group;
        /// Linearisation.
        #[serde(flatten)]
        model: Model = Model::default() => group;
    }
    examples {
        "funicular settle robots/yuan2014-4mm.toml --release-n 0,0,-20 --below-hz 10",
        "funicular settle robots/cogiro.toml --release-n 0,0,-196 --tolerance-m 1e-4 --below-hz 20 -o settling.csv",
        "funicular settle robots/yuan2014-4mm.toml --stop-m-s 0,0.2,0 --profile-s 0.4,0.1 --below-hz 10",
        "funicular settle robots/yuan2014-4mm.toml --move-m 0,0.05,0 --profile-s 1.2,0.3,0.1 --below-hz 10 \\\n    \
         --shaper zv --tolerance-m 1e-4 --sample-time-s 0.01 --lengths lengths.csv",
        "funicular settle robots/yuan2014-4mm.toml --trajectory lengths.csv --below-hz 10 --robust-payload-kg 0.5,1 -o \
         decay.html",
    }
}

/// Default of the distance within which a point has settled [m].
const SETTLED_WITHIN: f64 = 1e-3;

declared! {
    /// Response to turbulent wind: r.m.s. values and expected peaks of motions and tensions, with their spectra.
    pub struct GustRequest {
        /// Robot file.
        robot: RobotText = RobotText::default() => (Data(shape::robot)).required();
        /// Output, see `frf`: a motion of the platform or of a point on a cable, or the tension at the platform,
        /// tension:3 (repeatable).
        output: Vec<String> = Vec::new() =>
            (List(ProgramForm::Output)).form("OUTPUT").otherwise("all displacements and rotations of the platform, and \
                all tensions");
        /// Point of the platform whose motion is measured, platform frame [m].
        output_point_m: Option<[f64; 3]> = None => (Vector).otherwise("the origin");
        /// Time for which the mean wind lasts, and in which peaks are expected [s].
        duration_s: f64 = GUST_DURATION => (Number(Positive));
        /// Upper limit of the frequencies [Hz]; faster gusts are left out.
        below_hz: Option<f64> = None => (Number(Positive))
            .otherwise("above all modes of the platform");
        /// Measured spectra of the gusts in place of ⟪turbulence⟫, one-sided: columns frequency_hz, and along_m2_s,
        /// lateral_m2_s and up_m2_s [m²/s² per Hz], straight between the rows and constant below the first. With
        /// ⟪intensity⟫ their integrals are compared with it.
        spectrum: Option<NumberColumns> = None => (Columns).under("Gusts")
            .read_by(Reader::Columns, "the spectra");
        /// Turbulence about the mean wind.
        #[serde(flatten)]
        gusts: TurbulenceOptions = TurbulenceOptions::default() => group;
        /// State and loads.
        #[serde(flatten)]
        state: State = State::default() => group;
        /// Rule and limits of tensions.
        #[serde(flatten)]
        tensions: Tensions = Tensions::default() => group;
        /// Linearisation.
        #[serde(flatten)]
        model: Model = Model::default() => group;
    }
    examples {
        "funicular gust robots/stadium-camera.toml --set materials.rope-5mm.drag_coefficient=1.2 \\\n    --set \
         materials.rope-5mm.drag_diameter_m=0.005 --set platform.drag_area_m2=0.3 --wind-m-s 12,0,0 \\\n    \
         --turbulence kaimal --intensity 0.15,0.12,0.075 --length-scale-m 85,28,6.9 --below-hz 2",
    }
}

/// Default of the time in which peaks are expected [s]: ten minutes, over which mean winds are taken.
pub(crate) const GUST_DURATION: f64 = 600.0;

declared! {
    /// Turbulence about the mean wind. A value that is not given comes from the robot file.
    #[derive(Copy)]
    pub struct TurbulenceOptions {
        /// Spectrum of the gusts.
        #[serde(with = "optional")]
        turbulence: Option<TurbulenceSpectrum> = None => (name::<TurbulenceSpectrum>()).form("SPECTRUM").under("Gusts")
            .otherwise("from the robot file");
        /// Standard deviation of the gusts along the mean wind, lateral and up, over the mean speed.
        intensity: Option<[f64; 3]> = None => (Vector).form("ALONG,LATERAL,UP").under("Gusts")
            .otherwise("from the robot file");
        /// Length scales of the gusts along, lateral and up, each in the direction of the mean wind [m].
        length_scale_m: Option<[f64; 3]> = None => (Vector).form("ALONG,LATERAL,UP").under("Gusts")
            .otherwise("from the robot file");
        /// Decay of the coherence with the distance along the mean wind, lateral and up.
        coherence_decay: Option<[f64; 3]> = None => (Vector).form("ALONG,LATERAL,UP").under("Gusts")
            .otherwise("from the robot file, or 0,10,10");
    }
}

declared! {
    /// Comparison of all cable models, and the simplest model that is good enough.
    pub struct CompareRequest {
        /// Robot file.
        robot: RobotText = RobotText::default() => (Data(shape::robot)).required();
        /// Upper limit of the frequencies [Hz].
        below_hz: f64 = 0.0 => (Number(Positive)).required();
        /// Compare the modes of the platform alone.
        platform: bool = false => (Switch);
        /// Minimum fraction of the kinetic energy in the platform for a mode that counts as a mode of the platform.
        platform_share: f64 = PLATFORM_SHARE => (Number(Fraction));
        /// Maximum relative difference of frequency for a model that is good enough.
        tolerance: f64 = TOLERANCE => (Number(NotNegative)).form("FRACTION");
        /// State and loads.
        #[serde(flatten)]
        state: State = State::default() => group;
        /// Rule and limits of tensions.
        #[serde(flatten)]
        tensions: Tensions = Tensions::default() => group;
        /// Terms of the stiffness.
        #[serde(flatten)]
        terms: Terms = Terms::default() => group;
    }
    examples {
        "funicular compare robots/yuan2014-4mm.toml --below-hz 5",
        "funicular compare robots/cogiro.toml --below-hz 15 --platform --tolerance 0.05",
        "funicular compare robots/yuan2014-4mm.toml --below-hz 5 -o models.svg",
    }
}

declared! {
    /// Dynamic stiffness of one cable over frequency.
    pub struct CableRequest {
        /// Robot file.
        robot: RobotText = RobotText::default() => (Data(shape::robot)).required();
        /// Name of the cable in the robot file.
        name: String = String::new() => (Text).form("NAME").required();
        /// Frequencies.
        #[serde(flatten)]
        range: FrequencyRange = FrequencyRange::default() => group;
        /// State and loads.
        #[serde(flatten)]
        state: State = State::default() => group;
        /// Rule and limits of tensions.
        #[serde(flatten)]
        tensions: Tensions = Tensions::default() => group;
        /// Cable model: how the cable responds to motion of its platform end.
        #[serde(with = "optional")]
        cable_model: Option<CableModel> = None => (name::<CableModel>()).form("MODEL").under("Model")
            .otherwise("catenary-dynamic; shallow-dynamic for static models other than catenary");
        /// Leave out the out-of-plane stiffness of the cable, as in Yuan et al. 2014.
        in_plane_only: bool = false => (Switch).under("Model");
        /// Winch in vibration, for a cable that runs to a winch.
        #[serde(with = "crate::names")]
        winches: WinchMode = WinchMode::default() => (name::<WinchMode>()).form("MODE").under("Model");
    }
    examples {
        "funicular cable robots/yuan2014-4mm.toml --name 1 --from-hz 0.1 --to-hz 20 --points 1000",
    }
}

declared! {
    /// State space A, B, C, D for control design, or the second-order model M, C, K.
    ///
    /// The state space has the modes that the inputs and outputs see: as few states as the tolerance allows, or the
    /// best ones for a given number of states. docs/control.md explains the error and the use in Python and MATLAB.
    pub struct ReduceRequest {
        /// Robot file.
        robot: RobotText = RobotText::default() => (Data(shape::robot)).required();
        /// Highest frequency for which the model is valid [Hz].
        below_hz: f64 = 0.0 => (Number(Positive)).required();
        /// Input signal, see `frf` (repeatable).
        input: Vec<String> = Vec::new() =>
            (List(ProgramForm::Input)).form("INPUT").otherwise("all forces and moments on the platform");
        /// Output signal, see `frf` (repeatable).
        output: Vec<String> = Vec::new() =>
            (List(ProgramForm::Output)).form("OUTPUT").otherwise("all displacements and rotations of the platform");
        /// Points of the platform.
        #[serde(flatten)]
        points: ResponsePoints = ResponsePoints::default() => group;
        /// Form of the model.
        #[serde(with = "crate::names")]
        form: ModelForm = ModelForm::default() => (name::<ModelForm>()).form("FORM");
        /// Maximum error of each response, relative to its peak below the limit; the state space has as few states as
        /// it allows [default: 0.01]. With the second-order form: maximum relative error due to omitted modes
        /// [default: 0.001].
        tolerance: Option<f64> = None => (Number(NotNegative)).form("FRACTION");
        /// Maximum number of states, instead of a tolerance.
        order: Option<usize> = None => (Count(0..=u64::MAX));
        /// Frequency at which viscous damping reproduces constant damping ratios [Hz].
        damping_at_hz: Option<f64> = None => (Number(Positive)).otherwise("every natural frequency");
        /// State and loads.
        #[serde(flatten)]
        state: State = State::default() => group;
        /// Rule and limits of tensions.
        #[serde(flatten)]
        tensions: Tensions = Tensions::default() => group;
        /// Linearisation.
        #[serde(flatten)]
        model: Model = Model::default() => group;
    }
    examples {
        "funicular reduce robots/yuan2014-4mm.toml --below-hz 5 --input fz --output az --matrices model.mat",
        "funicular reduce robots/cogiro.toml --below-hz 10 --input fz --output z --order 8 --matrices model.npz",
        "funicular reduce robots/cogiro-winches.toml --below-hz 5 --input length:1 --output z --output tension:1",
        "funicular reduce robots/cogiro-winches.toml --below-hz 5 --input base-z --output z --output az",
        "funicular reduce robots/yuan2014-4mm.toml --below-hz 5 --form second-order --matrices model\n\nIn Python: m = \
         numpy.load('model.npz'); m['A'], m['B'], m['C'], m['D']\nIn MATLAB: load model.mat; sys = ss(A, B, C, D)",
    }
}

/// Input of a response that names none: a vertical force on the platform.
const DEFAULT_INPUT: &str = "fz";

/// Output of a response that names none: the vertical acceleration of the platform, which sensors measure.
const DEFAULT_OUTPUT: &str = "az";

impl FrfRequest {
    /// True if frequencies are added until every peak has its height.
    pub fn is_adaptive(&self) -> bool {
        self.adaptive || self.range.points.is_none()
    }
}

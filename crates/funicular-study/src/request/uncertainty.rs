//! Request of the uncertainty of results.

use super::key::declared;
use super::parts::{Model, Places, ResponsePoints, RobotText, State, Tensions};
use crate::measure::MeasureGroup;
use crate::names::UncertaintyMethod;
use funicular::gradient::Hold;
use serde::{Deserialize, Deserializer, Serialize};

/// Number of sampled robots if a request gives none: deviations are then accurate to 5 %.
const DEFAULT_SAMPLES: usize = 200;

/// Covariance of two numbers of the robot file, or the variance of one.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct CovarianceEntry {
    /// Path of the first number.
    pub first: String,
    /// Path of the second number; that of the first for its variance.
    pub second: String,
    /// Covariance, in the product of their units.
    pub covariance: f64,
}

declared! {
    /// Deviations of results from deviations or tolerances of numbers of the robot file.
    ///
    /// Results are linear in the deviations where no cable may become slack and no frequencies may cross; elsewhere the
    /// program computes sampled robots, on all cores. Each result has its deviation, the interval that holds 95 % of
    /// all robots, and the shares of the numbers; docs/uncertainty.md explains the tables.
    pub struct UncertaintyRequest {
        /// Robot file.
        robot: RobotText = RobotText::default() => (Data(shape::robot)).required();
        /// Standard deviations PATH=VALUE or PATH=PERCENT% of normally distributed numbers, separated by commas.
        /// `parameters` lists the paths; * stands for any key, and a path to a table or vector for all numbers in it.
        /// Each entry is a group with its own share.
        deviations: Vec<String> = Vec::new() => (Sizes).form("DEVIATIONS");
        /// Tolerances PATH=VALUE or PATH=PERCENT% of numbers with a uniform distribution within ± their tolerance,
        /// separated by commas.
        tolerances: Vec<String> = Vec::new() => (Sizes).form("TOLERANCES");
        /// Covariance of numbers that deviate together, as `calibrate` writes it: a table with the columns first,
        /// second (paths) and covariance, in the units of the file; pairs without a row are independent
        covariance: Option<Vec<CovarianceEntry>> = None => (Data(shape::objects))
            .read_by(Reader::Records, "the covariance");
        /// Results, separated by commas.
        of: Vec<String> = pose_and_tensions() => (Texts).form("RESULTS").one_of(MeasureGroup::names());
        /// Quantity that is held while the numbers deviate; with the pose held, the tensions parallel to the chords of
        /// more cables than degrees of freedom change least, or follow their rule.
        #[serde(with = "crate::names")]
        hold: Hold = Hold::default() => (name::<Hold>()).form("WHAT");
        /// Upper limit of the frequencies [Hz]; for frequencies and damping.
        below_hz: Option<f64> = None => (Number(Positive));
        /// Frequencies of the response [Hz], separated by commas.
        #[serde(deserialize_with = "one_or_several")]
        at_hz: Option<Vec<f64>> = None => (Commas(ProgramForm::NotNegative)).form("HZ");
        /// Input of the response (see `frf`).
        input: Option<String> = None => (Written(ProgramForm::Input)).form("INPUT");
        /// Output of the response (see `frf`); results are its magnitudes in decibels and its phases in degrees.
        output: Option<String> = None => (Written(ProgramForm::Output)).form("OUTPUT");
        /// Points of the platform.
        #[serde(flatten)]
        points: ResponsePoints = ResponsePoints::default() => group;
        /// Poses.
        #[serde(flatten)]
        places: Places = Places::default() => group;
        /// Method for the deviations.
        #[serde(with = "crate::names")]
        method: UncertaintyMethod = UncertaintyMethod::default() => (name::<UncertaintyMethod>()).form("METHOD");
        /// Number of sampled robots per pose that needs sampling, 10 to 1000000; with several groups, each group needs
        /// as many again.
        samples: usize = DEFAULT_SAMPLES => (Count(0..=u64::MAX));
        /// Seed of the sample.
        seed: u32 = 0 => (Count(0..=u64::from(u32::MAX)));
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
        "funicular uncertainty robots/yuan2014-4mm.toml --deviations platform.mass_kg=1%,cables.*.anchor_m=0.002 \
         \\\n    --of pose,tensions,frequencies --below-hz 2",
        "funicular uncertainty robots/cogiro.toml --pose 1,2,1.5 --tolerances cables.*.unstrained_length_m=0.0002 -o \
         cogiro.html",
        "funicular uncertainty robots/cogiro.toml --covariance covariance.csv --grid x=-5:5:3 --grid y=-3:3:3 \
         \\\n    --grid z=1.5 --of pose",
        "funicular uncertainty robots/cogiro.toml --poses trajectory.csv --deviations platform.center_of_mass_m=0.005 \
         \\\n    --of stiffness-min --hold pose -o stiffness.csv",
        "funicular uncertainty robots/yuan2014-4mm.toml --deviations materials.*.youngs_modulus_pa=5%,platform=1% \
         \\\n    --of frequencies,damping --below-hz 3 --samples 2000 --samples-file robots.parquet",
    }
}

/// Results whose deviations are computed if a request names none.
fn pose_and_tensions() -> Vec<String> {
    vec!["pose".to_owned(), "tensions".to_owned()]
}

/// Reads a number or a list of numbers as a list.
fn one_or_several<'de, D: Deserializer<'de>>(source: D) -> Result<Option<Vec<f64>>, D::Error> {
    #[derive(Deserialize)]
    #[serde(untagged, expecting = "a frequency is a number, and several are a list of numbers")]
    enum Numbers {
        One(f64),
        Several(Vec<f64>),
    }
    Ok(Option::<Numbers>::deserialize(source)?.map(|numbers| match numbers {
        Numbers::One(hz) => vec![hz],
        Numbers::Several(all) => all,
    }))
}

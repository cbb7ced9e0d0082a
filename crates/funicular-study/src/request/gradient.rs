//! Request of derivatives.

use super::key::declared;
use super::parts::{Model, ResponsePoints, RobotText, State, Tensions};
use crate::measure::MeasureGroup;
use crate::names::Per;
use funicular::gradient::Hold;

declared! {
    /// Derivatives of results with respect to every number of the robot file.
    ///
    /// All derivatives come from the solution itself, without perturbing a number; docs/gradients.md explains the
    /// tables. The text shows the ten largest of each result, JSON and CSV all of them.
    pub struct GradientRequest {
        /// Robot file.
        robot: RobotText = RobotText::default() => (Data(shape::robot)).required();
        /// Results, separated by commas.
        of: Vec<String> = frequencies() => (Texts).form("RESULTS").one_of(MeasureGroup::names());
        /// Numbers of the robot file, by paths that `parameters` lists, separated by commas; * stands for any key, and
        /// a path to a table or vector for all numbers in it.
        by: Vec<String> = Vec::new() => (Texts).form("PATHS").otherwise("all");
        /// Quantity that is held while a number changes; with the pose held, the tensions parallel to the chords of
        /// more cables than degrees of freedom change least, or follow their rule.
        #[serde(with = "crate::names")]
        hold: Hold = Hold::default() => (name::<Hold>()).form("WHAT");
        /// Unit of the derivatives: per unit, percent or tolerance of each number.
        #[serde(with = "crate::names")]
        per: Per = Per::default() => (name::<Per>()).form("STEP");
        /// Tolerances PATH=VALUE or PATH=PERCENT%, separated by commas.
        tolerances: Vec<String> = Vec::new() =>
            (Sizes).form("TOLERANCES").otherwise("usual ones, which docs/gradients.md lists");
        /// Upper limit of the frequencies [Hz]; for frequencies and damping.
        below_hz: Option<f64> = None => (Number(Positive));
        /// Frequency of the response [Hz].
        at_hz: Option<f64> = None => (Number(NotNegative));
        /// Input of the response, on the platform (see `frf`).
        input: Option<String> = None => (Written(ProgramForm::Input)).form("INPUT");
        /// Output of the response, on the platform (see `frf`).
        output: Option<String> = None => (Written(ProgramForm::Output)).form("OUTPUT");
        /// Points of the platform.
        #[serde(flatten)]
        points: ResponsePoints = ResponsePoints::default() => group;
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
        "funicular gradient robots/yuan2014-4mm.toml --below-hz 2",
        "funicular gradient robots/cogiro.toml --pose 1,2,1.5 --of tensions,stiffness-min --by cables.*.anchor_m \
         --hold pose",
        "funicular gradient robots/yuan2014-4mm.toml --of frequencies,damping --below-hz 1.5 --per percent -o \
         gradients.csv",
        "funicular gradient robots/yuan2014-4mm.toml --of response --at-hz 1.1 --input fz --output az \\\n    --by \
         platform,materials --per tolerance --tolerances platform.mass_kg=2%",
    }
}

/// Results that are differentiated if a request names none.
pub fn frequencies() -> Vec<String> {
    vec!["frequencies".to_owned()]
}

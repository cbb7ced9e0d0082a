//! Requests of pages, and of the comparison with published numbers.

use super::key::declared;
use super::parts::{Model, ResponsePoints, RobotText, State, Tensions};
use super::{check_fraction, check_positive};
use crate::names::{ValidationLevel, optional};
use anyhow::Result;
use funicular::modes::PLATFORM_SHARE;

declared! {
    /// HTML page with all analyses of a robot and their figures.
    pub struct ReportRequest {
        /// Robot file.
        robot: RobotText = RobotText::default() => (Data(shape::robot)).required();
        /// Two pages A4 for the person who decides, instead of the page with all analyses; -o FILE.pdf writes them as
        /// PDF.
        summary: bool = false => (Switch);
        /// Upper limit of the frequencies [Hz].
        below_hz: f64 = 20.0 => (Number(Positive));
        /// Input of the frequency response: fx … mz, or f:ux,uy,uz, m:ux,uy,uz, see `funicular frf`.
        input: Option<String> = None =>
            (Written(ProgramForm::Input)).form("INPUT").otherwise("fz; fx if the platform cannot move along z");
        /// Output of the frequency response: x … arz, or x:ux,uy,uz, v:…, a:…, see `funicular frf`.
        output: Option<String> = None =>
            (Written(ProgramForm::Output)).form("OUTPUT").otherwise("az; ax if the platform cannot move along z");
        /// Points of the platform.
        #[serde(flatten)]
        points: ResponsePoints = ResponsePoints::default() => group;
        /// Minimum fraction of the kinetic energy in the platform for a mode that counts as a mode of the platform.
        platform_share: f64 = PLATFORM_SHARE => (Number(Fraction));
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
        "funicular report",
        "funicular report robots/cogiro.toml -o cogiro.html",
        "funicular report robots/cogiro.toml --pose 1,1,1.5 --summary -o cogiro.pdf",
        "funicular report robots/yuan2014-4mm.toml --pose 0,0,0.5 --below-hz 10 --input f:1,0,1 --output x",
    }
}

impl ReportRequest {
    /// Checks the limit of the frequencies and the share of a mode of the platform.
    ///
    /// # Errors
    /// A limit that is not positive, or a share that is not a fraction.
    pub fn check(&self) -> Result<()> {
        check_positive("below_hz", self.below_hz)?;
        check_fraction("platform_share", self.platform_share)
    }
}

declared! {
    /// HTML page on which the platform can be dragged, and everything is computed anew.
    ///
    /// The page contains the program itself, as WebAssembly, and opens in a browser without network. docs/web.md
    /// describes it.
    pub struct LiveRequest {
        /// Robot file.
        robot: RobotText = RobotText::default() => (Data(shape::robot)).required();
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
        "funicular live robots/cogiro.toml -o cogiro.html",
        "funicular live robots/cogiro.toml --pose 1,2,1.5 --tension-rule middle --set platform.mass_kg=150",
    }
}

declared! {
    /// HTML page with every figure and table of Yuan et al. 2014 beside the results of this program.
    pub struct PaperRequest {
    }
    examples {
        "funicular paper -o paper.html",
    }
}

declared! {
    /// Compare the program with numbers that others published or computed; exit code 1 if a difference is out of
    /// tolerance.
    pub struct ValidateRequest {
        /// Only comparisons whose IDs are these, or begin with them: a section, a source or one comparison.
        only: Vec<String> = Vec::new() => (Texts).form("IDS").otherwise("all");
        /// Only comparisons with reference numbers of this kind.
        #[serde(with = "optional")]
        level: Option<ValidationLevel> = None => (name::<ValidationLevel>()).form("LEVEL").otherwise("all");
        /// Negative controls, too: sections with one wrong input, which must fail.
        controls: bool = false => (Switch);
    }
    examples {
        "funicular validate",
        "funicular validate --only catenary/michalos-1962",
        "funicular validate --level measured --format json",
        "funicular validate --controls",
        "funicular validate -o validation.xml",
    }
}

//! Results of a proof.

use super::ProofStudy;
use crate::analyses::fields::AXES;
use crate::analyses::found;
use crate::analyses::shared::PoseRow;
use crate::columns::{ResultTable, Tabled};
use crate::rows::rows;
use crate::table::Column;
use crate::text::significant;
use funicular::math::Vec3;
use funicular::proof::{BoxVerdict, FaceMesh, PositionBox, ProofSearch, ProofStatement, ProvedBox};

/// Number of undecided boxes that are shown.
const WORST: usize = 3;

rows! {
    /// Results of `prove`, or of the proof of a workspace.
    pub struct Proved {
        pub robot: String = hidden;
        pub static_model: &'static str;
        /// Middle of the box, and the orientation of the statement.
        pub pose: PoseRow;
        /// Half widths of the box of positions.
        pub within_m: [f64; 3];
        /// Largest turns about the axes of the world, which belong to the statement at every position.
        pub within_deg: [f64; 3];
        /// Number of required loads of which all others are combinations.
        pub loads: usize;
        /// `inside`, `outside` or `undecided` for the whole box, or `divided` if parts of it are decided differently.
        pub verdict: &'static str;
        /// Least distance of a tension from its limits if the box is inside; the least wrench that is missing if it is
        /// outside.
        pub margin_n: Option<f64>;
        /// Reason why the whole box is undecided.
        pub reason: Option<&'static str>;
        /// Unit of the volumes: m³, or m², m if the box has no width along one or two axes.
        pub volume_unit: &'static str;
        /// Volume of the box, in the unit that is given.
        pub whole: f64;
        /// Volume that is proved inside.
        pub inside: f64;
        /// Volume that is proved outside.
        pub outside: f64;
        /// Volume that is neither.
        pub undecided: f64;
        /// Undecided volume over the volume that is not proved outside.
        pub undecided_share: f64;
        /// Number of boxes that were proved or tried.
        pub tried: usize;
        /// Reason why the division ended: `complete`, `boxes`, `time`, `undecided` or `stopped`.
        pub end: &'static str;
        /// Largest undecided boxes, with the reasons.
        pub worst: Vec<BoxRow>;
        /// Boxes of the division.
        pub boxes: Vec<BoxRow>;
        pub region: PositionBox = hidden;
        pub surface: FaceMesh = hidden;
        pub statement: ProofStatement = hidden;
        pub warnings: Vec<String> = hidden;
    }
}

rows! {
    /// Box of a division.
    #[derive(Debug, Clone)]
    pub struct BoxRow in tables() {
        /// Least coordinate of the positions, {}.
        pub lower_m: [f64; 3] => each(AXES, "lower_{}_m").decimals("from", 4);
        /// Greatest coordinate of the positions, {}.
        pub upper_m: [f64; 3] => each(AXES, "upper_{}_m").decimals("to", 4);
        /// Verdict: inside, outside or undecided.
        pub verdict: &'static str => one.plain("verdict");
        /// Least distance of a tension from its limits inside, or the least missing wrench outside.
        pub margin_n: Option<f64> => one.significant("margin", 5);
        /// Reason why it is undecided.
        pub reason: Option<&'static str> => one.plain("reason");
    }
}

/// Reason why a division ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum DivisionEnd {
    Complete,
    Boxes,
    Time,
    Undecided,
    Stopped,
}

impl DivisionEnd {
    fn name(self) -> &'static str {
        match self {
            Self::Complete => "complete",
            Self::Boxes => "boxes",
            Self::Time => "time",
            Self::Undecided => "undecided",
            Self::Stopped => "stopped",
        }
    }
}

impl BoxRow {
    fn of(of: &ProvedBox) -> Self {
        let PositionBox { lower, upper } = of.region;
        let (verdict, margin_n, reason) = match of.verdict {
            BoxVerdict::Inside(margin) => ("inside", Some(margin), None),
            BoxVerdict::Outside(margin) => ("outside", Some(margin), None),
            BoxVerdict::Undecided(reason) => ("undecided", None, Some(reason.name())),
        };
        Self { lower_m: lower.into(), upper_m: upper.into(), verdict, margin_n, reason }
    }

    /// Box of positions.
    pub fn region(&self) -> PositionBox {
        PositionBox { lower: Vec3::from(self.lower_m), upper: Vec3::from(self.upper_m) }
    }
}

impl Proved {
    pub(super) fn of(study: &ProofStudy, search: &ProofSearch, end: DivisionEnd) -> Self {
        let boxes: Vec<BoxRow> = search.boxes().map(|of| BoxRow::of(&of)).collect();
        let mut undecided: Vec<&BoxRow> = boxes.iter().filter(|of| of.verdict == "undecided").collect();
        undecided.sort_by(|a, b| b.region().measure().total_cmp(&a.region().measure()));
        let worst: Vec<BoxRow> = undecided.iter().take(WORST).map(|of| (*of).clone()).collect();

        let all = |verdict: &str| boxes.iter().all(|of| of.verdict == verdict);
        let verdict = ["inside", "outside", "undecided"].into_iter().find(|name| all(name)).unwrap_or("divided");
        let is_decided = matches!(verdict, "inside" | "outside");
        let least = boxes.iter().filter_map(|of| of.margin_n).reduce(f64::min);
        let reason = if verdict == "undecided" { worst.first().and_then(|of| of.reason) } else { None };
        let volumes = search.volumes();
        let sides = study.region.upper - study.region.lower;
        let volume_unit = ["", "m", "m²", "m³"][sides.iter().filter(|side| **side > 0.0).count()];
        Self {
            robot: study.robot.name.clone(),
            static_model: study.model.name(),
            pose: PoseRow::of(&study.pose),
            within_m: (sides * 0.5).into(),
            within_deg: study.turns_deg,
            loads: study.statement.load_count(),
            verdict,
            margin_n: least.filter(|_| is_decided),
            reason,
            volume_unit,
            whole: volumes.whole,
            inside: volumes.inside,
            outside: volumes.outside,
            undecided: volumes.undecided(),
            undecided_share: volumes.undecided_share(),
            tried: search.tried(),
            end: end.name(),
            worst,
            region: study.region,
            surface: search.surface(),
            statement: study.statement.clone(),
            warnings: study.warnings(),
            boxes,
        }
    }

    /// True if the work was stopped from outside.
    pub fn is_stopped(&self) -> bool {
        self.end == DivisionEnd::Stopped.name()
    }
}

/// Part of a line of progress: bounds of the volume so far.
pub(super) fn so_far(search: &ProofSearch) -> String {
    let volumes = search.volumes();
    let [low, high] = [volumes.inside, volumes.whole - volumes.outside].map(|of| significant(of, 5));
    let share = significant(100.0 * volumes.undecided_share(), 2);
    format!("proved so far: {low} to {high}, {share} % of it undecided")
}

impl Tabled for Proved {
    fn tables() -> Vec<(&'static str, Vec<Column>)> {
        vec![("", BoxRow::columns().described())]
    }

    fn table(&self) -> ResultTable<'_> {
        ResultTable::new(BoxRow::columns(), &self.boxes)
    }
}

found!(Proved, "prove");

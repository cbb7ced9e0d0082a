//! Requests about the set of all positions at which the robot meets conditions.

use super::grids::PointOptions;
use super::key::declared;
use super::parts::{Axis, RobotText};
use super::prove::Division;
use crate::names::OrientationRule;
use serde::{Deserialize, Serialize};

declared! {
    /// Set of all positions at which quantities keep their limits: its surface, volume, parts and holes.
    ///
    /// Without a limit the positions are those at which tensions within their limits hold the platform, with the
    /// required loads if there are any. The surface is found on a grid, whose vertices lie where a quantity has its
    /// limit; every result names the step of the grid or the number of rays behind it.
    pub struct WorkspaceRequest {
        /// Robot file.
        robot: RobotText = RobotText::default() => (Data(shape::robot)).required();
        /// Least value of a quantity of `map`, or of one of its columns, as in load-factor=1 or clearance_margin_m=0.05
        /// (repeatable: all limits are kept).
        at_least: Vec<BoundValue> = Vec::new() => (List(ProgramForm::Bound)).form("QUANTITY=VALUE").under("Set");
        /// Greatest value of a quantity of `map`, or of one of its columns, as in tension-max=3000 (repeatable).
        at_most: Vec<BoundValue> = Vec::new() => (List(ProgramForm::Bound)).form("QUANTITY=VALUE").under("Set");
        /// Axis of the grid: x, y, z [m] with N values from A to B; N - 1 should be a multiple of 4. Without x, y or z
        /// it reaches from the least to the greatest coordinate of the anchors and the origin. With roll, pitch, yaw
        /// [degrees], N values or listed ones, ⟪orientations⟫ says which of them have to be possible (repeatable).
        grid: Vec<Axis> = Vec::new() => (List(ProgramForm::GridAxis)).form("AXIS=A:B:N|V,V,…").under("Set");
        /// Step of the grid along axes that ⟪grid⟫ does not give [m].
        step_m: Option<f64> = None => (Number(Positive)).under("Set").otherwise("a fortieth of the longest side");
        /// Orientations of the grid that have to be possible at a position.
        #[serde(with = "crate::names")]
        orientations: OrientationRule = OrientationRule::default() =>
            (name::<OrientationRule>()).form("WHICH").under("Set");
        /// Tolerance of the vertices along the edges of the grid, and of the ends of rays [m].
        vertex_tolerance_m: Option<f64> = None =>
            (Number(Positive)).under("Set").otherwise("a hundredth of the smallest step");
        /// Number of rays from ⟪center_m⟫ for a second volume: 6, 18, 66, 258, 1026 … or 12, 42, 162, 642, 2562 …;
        /// every interval of a ray inside the set is kept.
        rays: Option<usize> = None => (Count(6..=200_000)).under("Set");
        /// Point from which the rays go out [m].
        center_m: Option<[f64; 3]> = None => (Vector).under("Set").needs("rays").otherwise("the centroid of the set");
        /// Section at right angles to an axis, as in z=1.5 or z=0.5,1,1.5 (repeatable).
        section: Vec<Axis> = Vec::new() => (List(ProgramForm::GridAxis)).form("AXIS=V,V,…").under("Set");
        /// Robot file whose set is compared with this one, on the same grid and with the same options.
        compare: Option<Box<RobotText>> = None => (Data(shape::robot)).under("Set")
            .read_by(Reader::Robot, "the other robot file");
        /// Prove as well in which parts of the box required loads are held at every position, not only at the nodes.
        prove: bool = false => (Switch).under("Proof");
        /// End of the proof.
        #[serde(flatten)]
        division: Division = Division::default() => group;
        /// State and loads; the pose gives the orientation for axes that the grid does not have.
        #[serde(flatten)]
        point: PointOptions = PointOptions::default() => (group without ["lengths_m", "hold_lengths_of_pose"]);
    }
    examples {
        "funicular workspace robots/cogiro.toml --required-force-n 150,150,150 --required-moment-n-m 30,30,30 -o \
         cogiro.stl",
        "funicular workspace robots/ipanema2.toml --grid z=0:4:41 --at-least load-factor=1 --at-least \
         stiffness-min=1e4",
        "funicular workspace robots/cogiro.toml --prove --boxes 100000 -o workspace.html --certificate cogiro.jsonl",
        "funicular workspace robots/cogiro.toml --grid yaw=-20:20:5 --orientations all --section z=1.5 -o \
         workspace.html",
    }
}

/// Limit of a quantity of a map.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BoundValue {
    /// Name of the quantity, or of one of its columns.
    pub quantity: String,
    /// Least or greatest value.
    pub value: f64,
}

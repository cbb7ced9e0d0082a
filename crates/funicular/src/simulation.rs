//! Large motion of a robot in time: platform and sagging ropes, winches that pay out, payloads that are released,
//! cables that fail or go slack.
//!
//! Each rope is a string without bending stiffness that stretches, weighs and has mass, as elements of a degree that
//! the caller chooses; the platform is a rigid body, a point mass, or a body in a plane. The start is the equilibrium
//! of this mesh. Steps are as long as a tolerance of positions allows. The equations are in docs/theory.md, section
//! 18e.

mod air;
mod arrow;
mod basis;
mod body;
mod books;
mod dense;
mod esdirk;
mod event;
mod far_border;
mod far_end;
mod feed;
mod moving_anchor;
mod planned;
mod resting;
mod rope;
mod run;
mod side_by_side;
mod skyline;
mod start;
mod state;
mod sudden;
mod system;
mod winding;

pub use books::EnergyBooks;
pub use esdirk::StepCounts;
pub use event::{CutAt, EventFault, SimulationEvent};
pub use planned::{CommandedLengths, without_payload};
pub use rope::WoundLength;
pub use run::{
    AnchorAtEnd, CableSample, LengthAtEnd, RobotSample, Simulation, SlackCable, StepError, StepInputs, StepSignal,
    StepSignals, SteppedSimulation, WrenchInput,
};
pub use start::{ElementMesh, LossOfMode, RestFault, SimulationError, SimulationSettings};

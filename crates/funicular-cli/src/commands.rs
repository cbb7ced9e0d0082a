//! One file a verb: options and a robot in, a result out.

pub(crate) mod cable;
pub(crate) mod check;
pub(crate) mod compare;
pub(crate) mod export;
pub(crate) mod frf;
pub(crate) mod import;
pub(crate) mod map;
pub(crate) mod merge;
pub(crate) mod modes;
pub(crate) mod paper;
pub(crate) mod plot;
pub(crate) mod pose_error;
pub(crate) mod reduce;
pub(crate) mod report;
pub(crate) mod statics;
pub(crate) mod stiffness;
pub(crate) mod sweep;
pub(crate) mod validate;

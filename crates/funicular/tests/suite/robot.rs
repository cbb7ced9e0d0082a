//! The robot: its file, the motion of its platform, wind and other loads along its cables.

mod motion;
mod spec;
mod winch;
mod wind;

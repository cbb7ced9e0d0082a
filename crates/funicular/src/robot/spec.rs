//! The robot file.

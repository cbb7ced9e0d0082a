//! Structs of the header, member by member. Members are only ever appended.

use crate::status::of_status;
use funicular::control_loop::LoopState;

/// Number of numbers of a summary.
pub const SUMMARY: usize = 7;

/// `fn_pose_input`: motion of the platform and external load on it.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default)]
pub struct PoseInput {
    /// Size of the caller's struct in bytes.
    pub struct_size: u32,
    /// Zero.
    pub reserved: u32,
    /// Position of the platform's origin [m].
    pub position_m: [f64; 3],
    /// Rotation from platform to world axes.
    pub quaternion_wxyz: [f64; 4],
    /// Velocity of the origin [m/s].
    pub velocity_m_s: [f64; 3],
    /// Angular velocity, world axes [rad/s].
    pub angular_velocity_rad_s: [f64; 3],
    /// Acceleration of the origin [m/s²].
    pub acceleration_m_s2: [f64; 3],
    /// Angular acceleration, world axes [rad/s²].
    pub angular_acceleration_rad_s2: [f64; 3],
    /// External force at the origin, world axes [N].
    pub force_n: [f64; 3],
    /// External moment about the origin, world axes [N m].
    pub moment_n_m: [f64; 3],
}

/// `fn_inverse_result`: lengths and tensions.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct InverseResult {
    /// Size of the caller's struct in bytes.
    pub struct_size: u32,
    /// Number of values for which each array has room.
    pub cables: u32,
    /// Status, as returned.
    pub status: i32,
    /// Number of Newton steps.
    pub iterations: i32,
    /// Number of calls since the values were computed.
    pub age_calls: i32,
    /// Index of the cable with the least margin.
    pub least_margin_cable: i32,
    /// Distance of its tensions from the nearer limit [N].
    pub least_margin_n: f64,
    /// Wrench that is not balanced [N].
    pub error_n: f64,
    /// Bound of the error of the lengths [m].
    pub error_m: f64,
    /// Unstrained lengths to the drums [m].
    pub length_m: *mut f64,
    /// Rates of these lengths [m/s].
    pub length_rate_m_s: *mut f64,
    /// Accelerations of these lengths [m/s²].
    pub length_acceleration_m_s2: *mut f64,
    /// Unstrained lengths of the free spans [m].
    pub free_length_m: *mut f64,
    /// Tensions at the platform [N].
    pub tension_platform_n: *mut f64,
    /// Tensions at the drums [N].
    pub tension_drum_n: *mut f64,
    /// Distances of the tensions from the nearer limit [N].
    pub margin_n: *mut f64,
    /// Wrench that no tensions within the limits can provide [N]: positive if it is proved that there are none.
    pub missing_n: f64,
    /// Direction of the missing force; with that of the moment of length 1.
    pub missing_force: [f64; 3],
    /// Direction of the missing moment, over the mean distance of the attachments.
    pub missing_moment: [f64; 3],
    /// Cables that reach farthest along the direction at their maximum, one bit each.
    pub missing_at_maximum: u32,
    /// Zero.
    pub reserved: u32,
}

/// `fn_forward_result`: pose and tensions.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ForwardResult {
    /// Size of the caller's struct in bytes.
    pub struct_size: u32,
    /// Number of values for which each array has room.
    pub cables: u32,
    /// Status, as returned.
    pub status: i32,
    /// Number of Newton steps.
    pub iterations: i32,
    /// Number of calls since the values were computed.
    pub age_calls: i32,
    /// Index of the cable with the least margin.
    pub least_margin_cable: i32,
    /// Distance of its tensions from the nearer limit [N].
    pub least_margin_n: f64,
    /// Wrench that is not balanced [N].
    pub error_n: f64,
    /// Bound of the error of the pose [m].
    pub error_m: f64,
    /// Position of the platform's origin [m].
    pub position_m: [f64; 3],
    /// Rotation from platform to world axes.
    pub quaternion_wxyz: [f64; 4],
    /// Unstrained lengths of the free spans [m].
    pub free_length_m: *mut f64,
    /// Tensions at the platform [N].
    pub tension_platform_n: *mut f64,
    /// Tensions at the drums [N].
    pub tension_drum_n: *mut f64,
    /// Distances of the tensions from the nearer limit [N].
    pub margin_n: *mut f64,
}

/// `fn_wrench_result`: load on the platform.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default)]
pub struct WrenchResult {
    /// Size of the caller's struct in bytes.
    pub struct_size: u32,
    /// Status, as returned.
    pub status: i32,
    /// External force at the origin, world axes [N].
    pub force_n: [f64; 3],
    /// External moment about the origin, world axes [N m].
    pub moment_n_m: [f64; 3],
    /// Mass whose weight is the part of the force along gravity [kg].
    pub payload_kg: f64,
}

/// Structs with pointers whose members are all zero by default.
macro_rules! zero_by_default {
    ($($of:ident)*) => {
        $(
            impl Default for $of {
                fn default() -> Self {
                    // SAFETY: every pattern of bits is a value, see `Sized32`.
                    unsafe { std::mem::zeroed() }
                }
            }
        )*
    };
}

pub(crate) use zero_by_default;

zero_by_default! { InverseResult ForwardResult }

/// Result with a summary of its state.
pub(crate) trait Summarised {
    /// Writes status, steps, age, margin and errors.
    fn summarise(&mut self, found: &LoopState);

    /// Status, Newton steps, age, cable with the least margin, its margin, remaining wrench, error.
    fn summary(&self) -> [f64; SUMMARY];
}

macro_rules! summarised {
    ($($of:ident)*) => {
        $(
            impl Summarised for $of {
                fn summarise(&mut self, found: &LoopState) {
                    self.status = of_status(found.status);
                    self.iterations = found.iterations as i32;
                    self.age_calls = i32::try_from(found.age).unwrap_or(i32::MAX);
                    self.least_margin_cable = found.least_margin_cable as i32;
                    self.least_margin_n = found.least_margin;
                    (self.error_n, self.error_m) = (found.error_force, found.error_length);
                }

                fn summary(&self) -> [f64; SUMMARY] {
                    let [status, steps, age, cable] =
                        [self.status, self.iterations, self.age_calls, self.least_margin_cable].map(f64::from);
                    [status, steps, age, cable, self.least_margin_n, self.error_n, self.error_m]
                }
            }
        )*
    };
}

summarised! { InverseResult ForwardResult }

/// Struct that begins with its size in bytes.
///
/// # Safety
/// The type is `repr(C)`, begins with a `u32`, and every pattern of bits is a value of it.
pub(crate) unsafe trait Sized32: Copy + Default {
    /// Size up to which a caller has to give it: that of the first version without the members that may be missing.
    const LEAST: usize;
}

// SAFETY: integers, numbers and pointers only; the size comes first.
unsafe impl Sized32 for PoseInput {
    const LEAST: usize = std::mem::offset_of!(Self, velocity_m_s);
}
// SAFETY: the same.
unsafe impl Sized32 for InverseResult {
    const LEAST: usize = std::mem::offset_of!(Self, length_m);
}
// SAFETY: the same.
unsafe impl Sized32 for ForwardResult {
    const LEAST: usize = std::mem::offset_of!(Self, free_length_m);
}
// SAFETY: the same.
unsafe impl Sized32 for WrenchResult {
    const LEAST: usize = size_of::<Self>();
}

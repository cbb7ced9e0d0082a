/* Prints the place of every member of the structs; scripts/test-c compares it with tests/layout.txt, and a test in Rust
 * compares the structs of the library with the same file. */
#include "funicular.h"

#include <stdio.h>

#define SIZE(type) printf(#type " size %lu\n", (unsigned long)sizeof(type))
#define AT(type, member) printf(#type " " #member " %lu\n", (unsigned long)offsetof(type, member))

int main(void) {
  SIZE(fn_pose_input);
  AT(fn_pose_input, struct_size);
  AT(fn_pose_input, reserved);
  AT(fn_pose_input, position_m);
  AT(fn_pose_input, quaternion_wxyz);
  AT(fn_pose_input, velocity_m_s);
  AT(fn_pose_input, angular_velocity_rad_s);
  AT(fn_pose_input, acceleration_m_s2);
  AT(fn_pose_input, angular_acceleration_rad_s2);
  AT(fn_pose_input, force_n);
  AT(fn_pose_input, moment_n_m);
  SIZE(fn_inverse_result);
  AT(fn_inverse_result, struct_size);
  AT(fn_inverse_result, cables);
  AT(fn_inverse_result, status);
  AT(fn_inverse_result, iterations);
  AT(fn_inverse_result, age_calls);
  AT(fn_inverse_result, least_margin_cable);
  AT(fn_inverse_result, least_margin_n);
  AT(fn_inverse_result, error_n);
  AT(fn_inverse_result, error_m);
  AT(fn_inverse_result, length_m);
  AT(fn_inverse_result, length_rate_m_s);
  AT(fn_inverse_result, length_acceleration_m_s2);
  AT(fn_inverse_result, free_length_m);
  AT(fn_inverse_result, tension_platform_n);
  AT(fn_inverse_result, tension_drum_n);
  AT(fn_inverse_result, margin_n);
  AT(fn_inverse_result, missing_n);
  AT(fn_inverse_result, missing_force);
  AT(fn_inverse_result, missing_moment);
  AT(fn_inverse_result, missing_at_maximum);
  AT(fn_inverse_result, reserved);
  SIZE(fn_forward_result);
  AT(fn_forward_result, struct_size);
  AT(fn_forward_result, cables);
  AT(fn_forward_result, status);
  AT(fn_forward_result, iterations);
  AT(fn_forward_result, age_calls);
  AT(fn_forward_result, least_margin_cable);
  AT(fn_forward_result, least_margin_n);
  AT(fn_forward_result, error_n);
  AT(fn_forward_result, error_m);
  AT(fn_forward_result, position_m);
  AT(fn_forward_result, quaternion_wxyz);
  AT(fn_forward_result, free_length_m);
  AT(fn_forward_result, tension_platform_n);
  AT(fn_forward_result, tension_drum_n);
  AT(fn_forward_result, margin_n);
  SIZE(fn_wrench_result);
  AT(fn_wrench_result, struct_size);
  AT(fn_wrench_result, status);
  AT(fn_wrench_result, force_n);
  AT(fn_wrench_result, moment_n_m);
  AT(fn_wrench_result, payload_kg);
  return 0;
}

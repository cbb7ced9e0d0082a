/* Functions of funicular.h with plain arrays, for programs that cannot make structs with pointers: MATLAB's loadlibrary,
 * Octave, Julia's ccall. One session is a model with one loop. Statuses as in funicular.h; with a negative one nothing
 * was written. Arrays of results may be NULL; those per cable have as many numbers as fn_flat_cables says.
 *
 * input: 25 numbers: position (3), quaternion w x y z (4), velocity (3), angular velocity (3), acceleration (3), angular
 * acceleration (3), force (3), moment (3).
 * summary: 7 numbers: status, Newton steps, age in calls, cable with the least margin (from 0), its margin in N,
 * remaining wrench in N, error of lengths or pose in m. */
#ifndef FUNICULAR_FLAT_H
#define FUNICULAR_FLAT_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

int32_t fn_flat_open(const char *path, void **session, char *message, uint32_t message_bytes);
int32_t fn_flat_close(void *session);
int32_t fn_flat_cables(void *session);
int32_t fn_flat_reset(void *session);
int32_t fn_flat_status_text(int32_t status, char *text, uint32_t bytes);
int32_t fn_flat_inverse(void *session, const double *input, double *summary, double *length_m, double *length_rate_m_s,
                        double *length_acceleration_m_s2, double *tension_platform_n, double *tension_drum_n);
/* missing: 8 numbers for the last fn_flat_inverse with a result: wrench in N that no tensions within the limits can
 * provide (0: not proved that there are none), direction of its force (3) and of its moment (3), and the cables at their
 * maximum as the sum of 2^i for cable i from 0. */
int32_t fn_flat_missing(void *session, double *missing);
/* start: 25 numbers, or NULL for the last pose; without any the search starts from nothing and reserves memory. */
int32_t fn_flat_forward(void *session, const double *length_m, const double *start, double *summary,
                        double *position_quaternion, double *tension_platform_n, double *tension_drum_n);
/* load: 7 numbers: force (3), moment (3), payload in kg. */
int32_t fn_flat_wrench(void *session, const double *input, const double *tension_drum_n, double *load);

#ifdef __cplusplus
}
#endif

#endif

/* Cable-driven parallel robots with sagging cables: statics inside a control loop, motion step by step, and an
 * estimator of the state from sensors. C99, C++.
 *
 * SI units; every name has its unit. World axes. Cables in the order of the robot file. Lengths are unstrained lengths
 * from the attachment on the platform to the drum (to the anchor without one): what a winch has to pay out.
 *
 * Memory. The caller owns all memory but that of models, simulations and estimators. fn_inverse, fn_forward, fn_wrench,
 * fn_warm_up, fn_reset, fn_est_update and fn_est_get reserve none, take no lock, print nothing, and every iteration in
 * them has a largest number of steps. The others are for set-up.
 *
 * Threads. A model is read only: many loops may use it. A loop serves one thread at a time; a second one gets FN_BUSY.
 *
 * Results. Every function returns a status. From zero on there is a result, and a smaller status is better. With a
 * negative one nothing at all was written, and the state of the loop is as before. Arrays may be NULL: not wanted.
 *
 * Structs begin with struct_size = sizeof(struct). A longer struct of a later version is accepted. A shorter one is
 * accepted if it has all members above the line "may be missing"; members that it does not have are zero or not wanted.
 *
 * Input. Numbers that are not finite or larger than 1e9 are FN_BAD_INPUT. A quaternion has either sign and is
 * normalised; one whose length differs from 1 by more than 1e-3 is FN_BAD_INPUT. */
#ifndef FUNICULAR_H
#define FUNICULAR_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define FN_ABI_VERSION 1 /* what fn_abi_version() has to return */
#define FN_MAX_CABLES 16

/* Statuses. */
#define FN_CERTIFIED 0          /* balance, limits and certificate hold */
#define FN_ACCEPTED 1           /* balance and limits hold, the certificate is missing */
#define FN_BEYOND_LIMITS 2      /* the balance holds with tensions beyond their limits */
#define FN_HELD 3               /* nothing was found: the last certified values, age_calls old */
#define FN_BAD_INPUT (-1)       /* not finite, too large, not positive, or a bad quaternion */
#define FN_BAD_POINTER (-2)     /* missing or not aligned */
#define FN_BAD_STRUCT (-3)      /* struct_size or cables too small */
#define FN_BAD_MODEL (-4)       /* robot file: the message says where */
#define FN_NOT_FOR_LOOP (-5)    /* robot that a loop cannot compute: the message says why */
#define FN_BAD_MEMORY (-6)      /* too small or not aligned, see fn_loop_bytes */
#define FN_BAD_HANDLE (-7)      /* no model or loop there, or it has ended */
#define FN_IN_USE (-8)          /* the model has loops */
#define FN_BUSY (-9)            /* another thread is in a call with this loop */
#define FN_POISONED (-10)       /* an earlier call failed inside: end the loop */
#define FN_PANIC (-11)          /* a mistake in this library */
#define FN_IMPOSSIBLE_POSE (-12) /* out of the plane, or an attachment at its anchor */
#define FN_INSIDE_PULLEY (-13)  /* an attachment is inside a wheel */
#define FN_LIMITS_CONTRADICT (-14) /* a minimum tension is not below its maximum at this pose */
#define FN_SINGULAR (-15)       /* the cables do not oppose every motion at this pose */
#define FN_TOO_SLACK (-16)      /* a cable cannot have this tension at this pose */
#define FN_NOT_FOUND (-17)      /* no result in the largest number of steps, and none to hold */
#define FN_NO_START (-18)       /* lengths to pose need a pose to start from */
#define FN_NO_REST (-19)        /* no equilibrium to begin at: the message says why */
#define FN_REFUSED (-20)        /* an input, an interval or an event of a simulation: the message says why */
#define FN_FAILED (-21)         /* no step of a simulation can follow the motion */
#define FN_BAD_STATE (-22)      /* a saved state is damaged, or belongs to another simulation */
#define FN_LOST (-23)           /* no length for 0.2 s, or readings that lead nowhere: fn_est_restart */

/* Alarms of an estimator, and their explanations. */
#define FN_EST_SLIP 1        /* a cable became longer unseen by its encoder */
#define FN_EST_LOAD_CELL 2   /* a load cell stepped */
#define FN_EST_PAYLOAD 3     /* a payload was taken up or put down */
#define FN_EST_FORCE 4       /* an external force beyond its prior */
#define FN_EST_CUT 5         /* a cable has no tension any more */
#define FN_EST_STUCK 6       /* a load cell repeats one reading */
#define FN_EST_UNEXPLAINED 7 /* load cells: fn_est_explain says what fits, best 50 ms later */

typedef struct fn_model fn_model; /* robot, read only */
typedef struct fn_loop fn_loop;   /* state of one loop, in memory of the caller */
typedef struct fn_sim fn_sim;     /* robot in motion, which advances step by step */
typedef struct fn_est fn_est;     /* estimator of the state of a robot from its sensors */

/* Motion of the platform, and external load on it besides the load of the robot file. */
typedef struct fn_pose_input {
  uint32_t struct_size;
  uint32_t reserved; /* 0 */
  double position_m[3];
  double quaternion_wxyz[4]; /* from platform to world axes */
  /* may be missing: */
  double velocity_m_s[3];
  double angular_velocity_rad_s[3];
  double acceleration_m_s2[3]; /* the inertia of the platform is a load on it */
  double angular_acceleration_rad_s2[3];
  double force_n[3];    /* at the origin of the platform */
  double moment_n_m[3]; /* about that origin */
} fn_pose_input;

typedef struct fn_inverse_result {
  uint32_t struct_size;
  uint32_t cables; /* room of each array, at least the number of cables */
  int32_t status;
  int32_t iterations;
  int32_t age_calls; /* 0 but for FN_HELD */
  int32_t least_margin_cable; /* from 0 */
  double least_margin_n; /* smallest distance of a tension from its limit, negative beyond it */
  double error_n; /* wrench that is not balanced; moments over the mean distance of the attachments */
  double error_m; /* bound of the error of the lengths */
  /* may be missing: */
  double *length_m;
  double *length_rate_m_s; /* positive while the cable is paid out */
  double *length_acceleration_m_s2;
  double *free_length_m; /* without the arc on the pulley and the drum side */
  double *tension_platform_n;
  double *tension_drum_n;
  double *margin_n;
  /* Proof with FN_BEYOND_LIMITS that no tensions within the limits hold the platform (exit points on pulleys held):
   * even if each cable pulls as far along the direction as its limits allow, missing_n are missing. 0: not proved. */
  double missing_n;
  double missing_force[3];  /* direction, with the moment of length 1 */
  double missing_moment[3]; /* moments over the mean distance of the attachments */
  uint32_t missing_at_maximum; /* bit i: cable i (from 0) pulls farthest at its maximum; the others at their minimum */
  uint32_t reserved;
} fn_inverse_result;

typedef struct fn_forward_result {
  uint32_t struct_size;
  uint32_t cables;
  int32_t status;
  int32_t iterations;
  int32_t age_calls;
  int32_t least_margin_cable;
  double least_margin_n;
  double error_n;
  double error_m; /* bound of the error of the pose */
  double position_m[3];
  double quaternion_wxyz[4];
  /* may be missing: */
  double *free_length_m;
  double *tension_platform_n;
  double *tension_drum_n;
  double *margin_n;
} fn_forward_result;

typedef struct fn_wrench_result {
  uint32_t struct_size;
  int32_t status;
  double force_n[3];
  double moment_n_m[3];
  double payload_kg; /* mass whose weight is the part of the force along gravity */
} fn_wrench_result;

/* Set-up. */

int32_t fn_abi_version(void);

/* Text of a status, with a zero at its end, cut to its memory. */
int32_t fn_status_text(int32_t status, char *text, size_t bytes);

/* Model from the text of a robot file, or from the file. A message (may be NULL) says why there is none. */
int32_t fn_model_from_toml(const char *toml, size_t bytes, fn_model **model, char *message, size_t message_bytes);
int32_t fn_model_from_file(const char *path, fn_model **model, char *message, size_t message_bytes);
int32_t fn_model_cables(const fn_model *model, uint32_t *cables);
/* FN_IN_USE while loops of the model have not ended. NULL is fine. */
int32_t fn_model_free(fn_model *model);

/* Memory of a loop: its size and alignment; any memory of both, for as long as the loop lives. */
int32_t fn_loop_bytes(const fn_model *model, size_t *bytes, size_t *alignment);
int32_t fn_loop_init(const fn_model *model, void *memory, size_t bytes, fn_loop **loop);
int32_t fn_loop_end(fn_loop *loop); /* the memory is the caller's again */

/* Runs every path once at the pose of the robot file, so that the first call in the loop is as fast as the others.
 * FN_NO_START without such a pose. The state stays as it was. */
int32_t fn_warm_up(fn_loop *loop);

/* Loop. */

/* The next call starts cold, as the first one did: for runs that have to repeat to the last digit. */
int32_t fn_reset(fn_loop *loop);

/* Pose to lengths and tensions. Rates and accelerations cost time; they are computed if one of the arrays is wanted. */
int32_t fn_inverse(fn_loop *loop, const fn_pose_input *input, fn_inverse_result *result);

/* Lengths to pose and tensions. The search starts at the pose of `start`, whose load and motion count too, or (NULL) at
 * the last pose of this loop. FN_NO_START if there is none. */
int32_t fn_forward(fn_loop *loop, const double *length_m, uint32_t cables, const fn_pose_input *start,
                   fn_forward_result *result);

/* Lengths to pose from nothing. Reserves memory and has no bound of time: before the loop, not in it. */
int32_t fn_forward_cold(fn_loop *loop, const double *length_m, uint32_t cables, fn_forward_result *result);

/* Tensions at the drums to the external load on the platform: what fn_inverse would have to be given for them. */
int32_t fn_wrench(fn_loop *loop, const fn_pose_input *input, const double *tension_drum_n, uint32_t cables,
                  fn_wrench_result *result);

/* Simulation step by step. It reserves memory, and its time has no bound; one thread at a time, a second one gets
 * FN_BUSY. With a negative status the simulation is as before. A message (may be NULL) says why. */

/* Robot of the text of a robot file, at rest. Elements of each rope and their degree, and the error of a position that a
 * step may have; 0 for the usual ones (3, 8, 1e-7). The start has the unstrained lengths length_m, for which the search
 * begins at the pose x, y, z [m], quaternion w, x, y, z; both NULL for the state of the robot file. */
int32_t fn_sim_new(const char *toml, size_t bytes, uint32_t elements, uint32_t degree, double tolerance_m,
                   const double *length_m, uint32_t cables, const double *pose, fn_sim **sim, char *message,
                   size_t message_bytes);
int32_t fn_sim_free(fn_sim *sim); /* NULL is fine */

/* Inputs and outputs have names, and numbers from 0: first the inputs, then the outputs. */
int32_t fn_sim_signals(fn_sim *sim, uint32_t *inputs, uint32_t *outputs);
int32_t fn_sim_signal_name(fn_sim *sim, uint32_t signal, char *name, size_t name_bytes, char *unit, size_t unit_bytes);
int32_t fn_sim_find(fn_sim *sim, const char *name, uint32_t *signal); /* FN_REFUSED: none has this name */
/* Inputs count for the whole next step: lengths and anchors are those at its end, forces act from its beginning on. */
int32_t fn_sim_set(fn_sim *sim, const uint32_t *signals, const double *values, size_t count);
int32_t fn_sim_get(fn_sim *sim, const uint32_t *signals, double *values, size_t count);
int32_t fn_sim_time(fn_sim *sim, double *time_s);

/* Advances by 1e-6 to 1 s. */
int32_t fn_sim_step(fn_sim *sim, double interval_s, char *message, size_t message_bytes);

/* Events at the present time. The point of a payload is x, y, z in the platform frame; NULL for the centre of mass. */
int32_t fn_sim_cut(fn_sim *sim, uint32_t cable, char *message, size_t message_bytes);
int32_t fn_sim_release(fn_sim *sim, double mass_kg, const double *point_m, char *message, size_t message_bytes);
int32_t fn_sim_pick(fn_sim *sim, double mass_kg, const double *point_m, char *message, size_t message_bytes);

/* State with the inputs, in memory of the caller, for the same robot, start and settings: it goes on with the same bits.
 * FN_BAD_MEMORY: too small; `bytes` then has the size that is needed. */
int32_t fn_sim_save(fn_sim *sim, void *memory, size_t *bytes);
int32_t fn_sim_restore(fn_sim *sim, const void *memory, size_t bytes);

/* Estimator: pose, velocity, payload, external force, tensions and errors of the sensors, each with its standard
 * deviation, from lengths and whatever else is read. docs/estimation.md has the model and what each number means. One
 * thread at a time; a second one gets FN_BUSY. With a negative status the estimator is as before. */

typedef struct fn_est_settings {
  uint32_t struct_size;
  uint32_t reserved; /* 0 */
  /* Standard deviations of single readings. */
  double length_std_m;
  double tension_std_n;
  double cable_angle_std_rad;
  double gyroscope_std_rad_s;
  double accelerometer_std_m_s2;
  double tracker_std_m;
  /* Before the first reading: payload, and standard deviations of what is not known. */
  double payload_kg;
  double payload_std_kg;
  double first_moment_std_kg_m;
  double force_std_n;
  double moment_std_n_m;
  double force_time_s; /* in which force and moment change */
  double offset_std_m;
  double tension_bias_std_n;
  double friction; /* between rope and load cell */
  double false_alarms_per_hour;
  double inertial_unit_m[3]; /* platform frame */
  double tracked_point_m[3];
} fn_est_settings;

/* Readings of one time. NULL: this sensor was not read. Bit i of a mask: reading i is missing, and what stands there is
 * not looked at; a number that is not finite elsewhere is FN_BAD_INPUT. */
typedef struct fn_est_readings {
  uint32_t struct_size;
  uint32_t cables; /* number of values of each array per cable */
  const double *length_m;
  const double *tension_n; /* at drums or anchors */
  const double *azimuth_rad; /* direction in which a cable leaves its anchor */
  const double *elevation_rad;
  const double *gyroscope_rad_s;    /* 3, platform axes */
  const double *accelerometer_m_s2; /* 3, platform axes; at rest minus gravity */
  const double *tracker_m;          /* 3, world */
  uint32_t length_missing;
  uint32_t tension_missing;
  uint32_t azimuth_missing;
  uint32_t elevation_missing;
  uint32_t gyroscope_missing;
  uint32_t accelerometer_missing;
  uint32_t tracker_missing;
  uint32_t reserved; /* 0 */
} fn_est_readings;

typedef struct fn_est_result {
  uint32_t struct_size;
  uint32_t cables;    /* room of each array */
  int32_t is_trusted; /* 0: readings do not fit their stated noise; all deviations are infinite then */
  int32_t rings;      /* 1 while the platform vibrates */
  int32_t alarm;      /* of the last update, FN_EST_...; 0: none */
  int32_t alarm_cable; /* -1: none */
  double time_s;
  double position_m[3];
  double quaternion_wxyz[4];
  double position_std_m[3];
  double rotation_std_rad[3];
  double velocity_m_s[3];
  double velocity_std_m_s[3];
  double angular_velocity_rad_s[3];
  double angular_velocity_std_rad_s[3];
  double force_n[3]; /* external, besides the loads of the file */
  double force_std_n[3];
  double moment_n_m[3];
  double moment_std_n_m[3];
  double payload_kg;
  double payload_std_kg;
  double first_moment_kg_m[3]; /* platform axes */
  double first_moment_std_kg_m[3];
  /* may be missing: */
  double *tension_n;
  double *tension_std_n;
  double *offset_m; /* true length minus reading */
  double *offset_std_m;
  double *tension_bias_n;
  double *tension_bias_std_n;
  double *slack; /* 1 slack, 0 taut, -1 unknown */
} fn_est_result;

/* One explanation of an alarm. */
typedef struct fn_est_fault {
  int32_t kind;    /* FN_EST_... */
  int32_t cable;   /* -1: none */
  double size;     /* slip in m, step of a load cell in N, payload in kg, force along z in N */
  double std;
  double worse_by; /* minus twice the logarithm of the likelihood, from the best */
} fn_est_fault;

/* Usual settings. */
int32_t fn_est_defaults(fn_est_settings *settings);

/* Estimator of the text of a robot file, at rest with the lengths of all cables. NULL: usual settings. The search for
 * the pose begins at x, y, z [m], quaternion w, x, y, z, or (NULL) from nothing. A message (may be NULL) says why
 * there is no estimator. */
int32_t fn_est_new(const char *toml, size_t bytes, const fn_est_settings *settings, const fn_est_readings *readings,
                   const double *near_pose, fn_est **est, char *message, size_t message_bytes);
int32_t fn_est_free(fn_est *est); /* NULL is fine */

/* Moves the estimate by a time step and takes the readings at its end. The result may be NULL. FN_REFUSED: the step is
 * not above 0 and at most 1 s. FN_LOST: restart. */
int32_t fn_est_update(fn_est *est, const fn_est_readings *readings, double step_s, fn_est_result *result);
int32_t fn_est_get(fn_est *est, fn_est_result *result);

/* Begins anew at rest with the lengths of all cables: with payload and errors of the sensors as known, or (forget 1)
 * with what was known before the first reading. near_pose: NULL for the last one. */
int32_t fn_est_restart(fn_est *est, const fn_est_readings *readings, const double *near_pose, int32_t forget,
                       char *message, size_t message_bytes);

/* Explanations of the last alarm, best first, and 1 if the first is better than all others. Many times the work of an
 * update: outside the loop. After it, fn_est_take_fault makes the number that changed unknown again. */
int32_t fn_est_explain(fn_est *est, fn_est_fault *faults, uint32_t room, uint32_t *count, int32_t *is_decided);
int32_t fn_est_take_fault(fn_est *est, int32_t kind, int32_t cable);

#ifdef __cplusplus
}
#endif

#endif

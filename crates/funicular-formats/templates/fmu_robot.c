/* {{ comment_name }}: the robot in motion; written by `funicular export`.

   Functional Mock-up Unit 2.0 and 3.0 for co-simulation. The declarations below are those of the standard that this unit
   uses. The robot is computed by the C library of funicular, which is linked in:
   cc -shared -fPIC -O2 -o {{ identifier }}.so sources/{{ identifier }}.c libfunicular_c.a -lpthread -ldl -lm */

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#if defined _WIN32
#define EXPORT __declspec(dllexport)
#else
#define EXPORT __attribute__((visibility("default")))
#endif

/* The C library: include/funicular.h of funicular-c. */
typedef struct fn_sim fn_sim;
int32_t fn_sim_new(const char *toml, size_t bytes, uint32_t elements, uint32_t degree, double tolerance_m,
                   const double *length_m, uint32_t cables, const double *pose, fn_sim **sim, char *message,
                   size_t message_bytes);
int32_t fn_sim_free(fn_sim *sim);
int32_t fn_sim_set(fn_sim *sim, const uint32_t *signals, const double *values, size_t count);
int32_t fn_sim_get(fn_sim *sim, const uint32_t *signals, double *values, size_t count);
int32_t fn_sim_time(fn_sim *sim, double *time_s);
int32_t fn_sim_step(fn_sim *sim, double interval_s, char *message, size_t message_bytes);
int32_t fn_sim_save(fn_sim *sim, void *memory, size_t *bytes);
int32_t fn_sim_restore(fn_sim *sim, const void *memory, size_t bytes);
enum { FN_CERTIFIED = 0, FN_PANIC = -11, FN_POISONED = -10 };

/* The value references are inputs, outputs and the time, in this order. */
enum { INPUTS = {{ inputs }}, OUTPUTS = {{ outputs }}, OF_TIME = INPUTS + OUTPUTS };
static const char GUID[] = "{{ guid }}";
static const unsigned char ROBOT[] = { {% for byte in robot %}{{ byte }},{% if loop.index0 % 32 == 31 %}
{% endif %}{% endfor %} };
static const double LENGTHS[] = { {% for value in lengths %}{{ value|fmt("{:e}") }}, {% endfor %}};
static const double POSE[] = { {% for value in pose %}{{ value|fmt("{:e}") }}, {% endfor %}};
static const double TOLERANCE = {{ tolerance|fmt("{:e}") }};

typedef void *Environment;
typedef enum { Ok, Warning, Discard, Error, Fatal, Pending } Status;
typedef void (*Logger2)(Environment, const char *, Status, const char *, const char *, ...);
typedef void (*Logger3)(Environment, Status, const char *, const char *);

typedef struct {
  fn_sim *sim;
  double start; /* time of the importer at which the simulation begins */
  bool failed;
  Environment environment;
  Logger2 logger2;
  Logger3 logger3;
  char *name;
} Unit;

typedef struct {
  double start;
  size_t bytes;
  unsigned char data[];
} Saved;

static Status tell(Unit *u, Status status, const char *message) {
  if (u->logger2 != NULL) u->logger2(u->environment, u->name, status, "error", "%s", message);
  if (u->logger3 != NULL) u->logger3(u->environment, status, "error", message);
  return status;
}

/* A new simulation in place of the present one. */
static Status begin(Unit *u) {
  char message[1000];
  fn_sim *sim = NULL;
  const size_t cables = sizeof LENGTHS / sizeof *LENGTHS;
  if (fn_sim_new((const char *)ROBOT, sizeof ROBOT, 0, 0, TOLERANCE, LENGTHS, (uint32_t)cables, POSE, &sim, message,
                 sizeof message) < 0)
    return tell(u, Error, message);
  fn_sim_free(u->sim);
  u->sim = sim;
  u->failed = false;
  return Ok;
}

static void end(Unit *u) {
  if (u == NULL) return;
  fn_sim_free(u->sim);
  free(u->name);
  free(u);
}

static Unit *instance(const char *name, const char *token, Environment environment, Logger2 logger2, Logger3 logger3) {
  Unit *u = calloc(1, sizeof *u);
  if (u == NULL) return NULL;
  u->environment = environment;
  u->logger2 = logger2;
  u->logger3 = logger3;
  u->name = calloc(1, (name == NULL ? 0 : strlen(name)) + 1);
  if (u->name != NULL && name != NULL) strcpy(u->name, name);
  if (token == NULL || strcmp(token, GUID) != 0) {
    tell(u, Error, "the GUID or the token is not that of modelDescription.xml");
  } else if (u->name != NULL && begin(u) == Ok) {
    return u;
  }
  end(u);
  return NULL;
}

static double now(Unit *u) {
  double time = 0.0;
  fn_sim_time(u->sim, &time);
  return u->start + time;
}

static Status get(Unit *u, const uint32_t of[], size_t n, double to[]) {
  for (size_t i = 0; i < n; i++) {
    if (of[i] == OF_TIME) to[i] = now(u);
    else if (fn_sim_get(u->sim, of + i, to + i, 1) < 0) return tell(u, Error, "there is no variable with this reference");
  }
  return Ok;
}

static Status set(Unit *u, const uint32_t of[], size_t n, const double from[]) {
  if (fn_sim_set(u->sim, of, from, n) < 0) return tell(u, Error, "only inputs can be set, to finite numbers");
  return Ok;
}

static Status step(Unit *u, double time, double interval) {
  char message[1000];
  if (fabs(time - now(u)) > 1e-9 * (1.0 + fabs(time))) return tell(u, Discard, "the communication point is not the present time");
  if (interval == 0.0) return Ok;
  const int32_t status = fn_sim_step(u->sim, interval, message, sizeof message);
  if (status == FN_PANIC || status == FN_POISONED) return tell(u, Fatal, message);
  u->failed = status < 0;
  return u->failed ? tell(u, Discard, message) : Ok;
}

static Status save(Unit *u, void **kept) {
  size_t bytes = 0;
  fn_sim_save(u->sim, NULL, &bytes);
  Saved *saved = malloc(sizeof *saved + bytes);
  if (saved == NULL) return Error;
  saved->start = u->start;
  saved->bytes = bytes;
  if (fn_sim_save(u->sim, saved->data, &bytes) < 0) {
    free(saved);
    return tell(u, Error, "the state cannot be saved");
  }
  free(*kept);
  *kept = saved;
  return Ok;
}

static Status restore(Unit *u, const Saved *saved) {
  if (saved == NULL || fn_sim_restore(u->sim, saved->data, saved->bytes) < 0)
    return tell(u, Error, "the state is damaged, or belongs to another unit");
  u->start = saved->start;
  u->failed = false;
  return Ok;
}

static Status serialize(const Saved *saved, unsigned char to[], size_t size) {
  const size_t bytes = sizeof *saved + saved->bytes;
  if (size < bytes) return Error;
  memcpy(to, saved, bytes);
  return Ok;
}

static Status deserialize(Unit *u, const unsigned char from[], size_t size, void **kept) {
  Saved head;
  if (size < sizeof head) return tell(u, Error, "the state is too short");
  memcpy(&head, from, sizeof head);
  if (head.bytes > size - sizeof head) return tell(u, Error, "the state is too short");
  Saved *saved = malloc(sizeof *saved + head.bytes);
  if (saved == NULL) return Error;
  memcpy(saved, from, sizeof *saved + head.bytes);
  free(*kept);
  *kept = saved;
  return Ok;
}

/* ---- FMI 2.0 ---- */

typedef struct {
  Logger2 logger;
  void *(*allocate)(size_t, size_t);
  void (*release)(void *);
  void (*finished)(Environment, Status);
  Environment environment;
} Callbacks2;

EXPORT const char *fmi2GetTypesPlatform(void) { return "default"; }
EXPORT const char *fmi2GetVersion(void) { return "2.0"; }
EXPORT Status fmi2SetDebugLogging(void *c, int on, size_t n, const char *const kinds[]) { return Ok; }
EXPORT void *fmi2Instantiate(const char *name, int type, const char *guid, const char *resources, const Callbacks2 *calls,
                             int visible, int logging) {
  if (type != 1) return NULL;
  return instance(name, guid, calls ? calls->environment : NULL, calls ? calls->logger : NULL, NULL);
}
EXPORT void fmi2FreeInstance(void *c) { end(c); }
EXPORT Status fmi2SetupExperiment(void *c, int has_tolerance, double tolerance, double start, int has_stop, double stop) {
  ((Unit *)c)->start = start;
  return Ok;
}
EXPORT Status fmi2EnterInitializationMode(void *c) { return Ok; }
EXPORT Status fmi2ExitInitializationMode(void *c) { return Ok; }
EXPORT Status fmi2Terminate(void *c) { return Ok; }
EXPORT Status fmi2Reset(void *c) { return begin(c); }
EXPORT Status fmi2GetReal(void *c, const uint32_t of[], size_t n, double to[]) { return get(c, of, n, to); }
EXPORT Status fmi2SetReal(void *c, const uint32_t of[], size_t n, const double from[]) { return set(c, of, n, from); }
#define NO_VALUES_2(TYPE, VALUE) \
  EXPORT Status fmi2Get##TYPE(void *c, const uint32_t of[], size_t n, VALUE to[]) { return n ? Error : Ok; } \
  EXPORT Status fmi2Set##TYPE(void *c, const uint32_t of[], size_t n, VALUE const from[]) { return n ? Error : Ok; }
NO_VALUES_2(Integer, int)
NO_VALUES_2(Boolean, int)
NO_VALUES_2(String, const char *)
EXPORT Status fmi2GetFMUstate(void *c, void **kept) { return save(c, kept); }
EXPORT Status fmi2SetFMUstate(void *c, void *kept) { return restore(c, kept); }
EXPORT Status fmi2FreeFMUstate(void *c, void **kept) {
  free(*kept);
  *kept = NULL;
  return Ok;
}
EXPORT Status fmi2SerializedFMUstateSize(void *c, void *kept, size_t *size) {
  *size = sizeof(Saved) + ((Saved *)kept)->bytes;
  return Ok;
}
EXPORT Status fmi2SerializeFMUstate(void *c, void *kept, char to[], size_t size) {
  return serialize(kept, (unsigned char *)to, size);
}
EXPORT Status fmi2DeSerializeFMUstate(void *c, const char from[], size_t size, void **kept) {
  return deserialize(c, (const unsigned char *)from, size, kept);
}
EXPORT Status fmi2GetDirectionalDerivative(void *c, const uint32_t of[], size_t n, const uint32_t by[], size_t known,
                                           const double seed[], double to[]) { return Error; }
EXPORT Status fmi2SetRealInputDerivatives(void *c, const uint32_t of[], size_t n, const int order[], const double from[]) { return Error; }
EXPORT Status fmi2GetRealOutputDerivatives(void *c, const uint32_t of[], size_t n, const int order[], double to[]) { return Error; }
EXPORT Status fmi2DoStep(void *c, double time, double interval, int keep) { return step(c, time, interval); }
EXPORT Status fmi2CancelStep(void *c) { return Error; }
EXPORT Status fmi2GetStatus(void *c, int kind, Status *to) { return Discard; }
EXPORT Status fmi2GetRealStatus(void *c, int kind, double *to) {
  if (kind != 2) return Discard;
  *to = now(c);
  return Ok;
}
EXPORT Status fmi2GetIntegerStatus(void *c, int kind, int *to) { return Discard; }
EXPORT Status fmi2GetBooleanStatus(void *c, int kind, int *to) {
  *to = ((Unit *)c)->failed;
  return kind == 3 ? Ok : Discard;
}
EXPORT Status fmi2GetStringStatus(void *c, int kind, const char **to) { return Discard; }

/* ---- FMI 3.0 ---- */

EXPORT const char *fmi3GetVersion(void) { return "3.0"; }
EXPORT Status fmi3SetDebugLogging(void *c, bool on, size_t n, const char *const kinds[]) { return Ok; }
EXPORT void *fmi3InstantiateModelExchange(const char *name, const char *token, const char *resources, bool visible, bool logging,
                                          Environment environment, Logger3 logger) { return NULL; }
EXPORT void *fmi3InstantiateScheduledExecution(const char *name, const char *token, const char *resources, bool visible,
                                               bool logging, Environment environment, Logger3 logger, void *update,
                                               void *lock, void *unlock) { return NULL; }
EXPORT void *fmi3InstantiateCoSimulation(const char *name, const char *token, const char *resources, bool visible, bool logging,
                                         bool events, bool early, const uint32_t wanted[], size_t n,
                                         Environment environment, Logger3 logger, void *update) {
  return instance(name, token, environment, NULL, logger);
}
EXPORT void fmi3FreeInstance(void *c) { end(c); }
EXPORT Status fmi3EnterInitializationMode(void *c, bool has_tolerance, double tolerance, double start, bool has_stop, double stop) {
  ((Unit *)c)->start = start;
  return Ok;
}
EXPORT Status fmi3ExitInitializationMode(void *c) { return Ok; }
EXPORT Status fmi3EnterEventMode(void *c) { return Error; }
EXPORT Status fmi3Terminate(void *c) { return Ok; }
EXPORT Status fmi3Reset(void *c) { return begin(c); }
EXPORT Status fmi3GetFloat64(void *c, const uint32_t of[], size_t n, double to[], size_t m) { return n == m ? get(c, of, n, to) : Error; }
EXPORT Status fmi3SetFloat64(void *c, const uint32_t of[], size_t n, const double from[], size_t m) { return n == m ? set(c, of, n, from) : Error; }
#define NO_VALUES_3(TYPE, VALUE) \
  EXPORT Status fmi3Get##TYPE(void *c, const uint32_t of[], size_t n, VALUE to[], size_t m) { return n ? Error : Ok; } \
  EXPORT Status fmi3Set##TYPE(void *c, const uint32_t of[], size_t n, VALUE const from[], size_t m) { return n ? Error : Ok; }
NO_VALUES_3(Float32, float)
NO_VALUES_3(Int8, int8_t)
NO_VALUES_3(UInt8, uint8_t)
NO_VALUES_3(Int16, int16_t)
NO_VALUES_3(UInt16, uint16_t)
NO_VALUES_3(Int32, int32_t)
NO_VALUES_3(UInt32, uint32_t)
NO_VALUES_3(Int64, int64_t)
NO_VALUES_3(UInt64, uint64_t)
NO_VALUES_3(Boolean, bool)
NO_VALUES_3(String, const char *)
EXPORT Status fmi3GetBinary(void *c, const uint32_t of[], size_t n, size_t sizes[], const uint8_t *to[], size_t m) { return n ? Error : Ok; }
EXPORT Status fmi3SetBinary(void *c, const uint32_t of[], size_t n, const size_t sizes[], const uint8_t *const from[], size_t m) { return n ? Error : Ok; }
EXPORT Status fmi3GetClock(void *c, const uint32_t of[], size_t n, bool to[]) { return n ? Error : Ok; }
EXPORT Status fmi3SetClock(void *c, const uint32_t of[], size_t n, const bool from[]) { return n ? Error : Ok; }
EXPORT Status fmi3GetNumberOfVariableDependencies(void *c, uint32_t of, size_t *n) { return Error; }
EXPORT Status fmi3GetVariableDependencies(void *c, uint32_t of, size_t elements[], uint32_t by[], size_t by_elements[], int kinds[],
                                          size_t n) { return Error; }
EXPORT Status fmi3GetFMUState(void *c, void **kept) { return save(c, kept); }
EXPORT Status fmi3SetFMUState(void *c, void *kept) { return restore(c, kept); }
EXPORT Status fmi3FreeFMUState(void *c, void **kept) {
  free(*kept);
  *kept = NULL;
  return Ok;
}
EXPORT Status fmi3SerializedFMUStateSize(void *c, void *kept, size_t *size) {
  *size = sizeof(Saved) + ((Saved *)kept)->bytes;
  return Ok;
}
EXPORT Status fmi3SerializeFMUState(void *c, void *kept, uint8_t to[], size_t size) { return serialize(kept, to, size); }
EXPORT Status fmi3DeserializeFMUState(void *c, const uint8_t from[], size_t size, void **kept) { return deserialize(c, from, size, kept); }
EXPORT Status fmi3GetDirectionalDerivative(void *c, const uint32_t of[], size_t n, const uint32_t by[], size_t known,
                                           const double seed[], size_t seeds, double to[], size_t m) { return Error; }
EXPORT Status fmi3GetAdjointDerivative(void *c, const uint32_t of[], size_t n, const uint32_t by[], size_t known,
                                       const double seed[], size_t seeds, double to[], size_t m) { return Error; }
EXPORT Status fmi3EnterConfigurationMode(void *c) { return Ok; }
EXPORT Status fmi3ExitConfigurationMode(void *c) { return Ok; }
EXPORT Status fmi3GetIntervalDecimal(void *c, const uint32_t of[], size_t n, double to[], int kinds[]) { return Error; }
EXPORT Status fmi3GetIntervalFraction(void *c, const uint32_t of[], size_t n, uint64_t to[], uint64_t parts[], int kinds[]) { return Error; }
EXPORT Status fmi3GetShiftDecimal(void *c, const uint32_t of[], size_t n, double to[]) { return Error; }
EXPORT Status fmi3GetShiftFraction(void *c, const uint32_t of[], size_t n, uint64_t to[], uint64_t parts[]) { return Error; }
EXPORT Status fmi3SetIntervalDecimal(void *c, const uint32_t of[], size_t n, const double from[]) { return Error; }
EXPORT Status fmi3SetIntervalFraction(void *c, const uint32_t of[], size_t n, const uint64_t from[], const uint64_t parts[]) { return Error; }
EXPORT Status fmi3SetShiftDecimal(void *c, const uint32_t of[], size_t n, const double from[]) { return Error; }
EXPORT Status fmi3SetShiftFraction(void *c, const uint32_t of[], size_t n, const uint64_t from[], const uint64_t parts[]) { return Error; }
EXPORT Status fmi3EvaluateDiscreteStates(void *c) { return Error; }
EXPORT Status fmi3UpdateDiscreteStates(void *c, bool *again, bool *stop, bool *nominals, bool *values, bool *defined, double *next) {
  *again = *stop = *nominals = *values = *defined = false;
  return Ok;
}
EXPORT Status fmi3EnterContinuousTimeMode(void *c) { return Error; }
EXPORT Status fmi3CompletedIntegratorStep(void *c, bool keep, bool *event, bool *stop) { return Error; }
EXPORT Status fmi3SetTime(void *c, double time) { return Error; }
EXPORT Status fmi3SetContinuousStates(void *c, const double from[], size_t n) { return Error; }
EXPORT Status fmi3GetContinuousStateDerivatives(void *c, double to[], size_t n) { return Error; }
EXPORT Status fmi3GetEventIndicators(void *c, double to[], size_t n) { return n ? Error : Ok; }
EXPORT Status fmi3GetContinuousStates(void *c, double to[], size_t n) { return Error; }
EXPORT Status fmi3GetNominalsOfContinuousStates(void *c, double to[], size_t n) { return Error; }
EXPORT Status fmi3GetNumberOfEventIndicators(void *c, size_t *n) { *n = 0; return Ok; }
EXPORT Status fmi3GetNumberOfContinuousStates(void *c, size_t *n) { *n = 0; return Ok; }
EXPORT Status fmi3EnterStepMode(void *c) { return Ok; }
EXPORT Status fmi3GetOutputDerivatives(void *c, const uint32_t of[], size_t n, const int32_t orders[], double to[], size_t m) { return Error; }
EXPORT Status fmi3DoStep(void *c, double time, double interval, bool keep, bool *event, bool *stop, bool *early, double *last) {
  const Status status = step(c, time, interval);
  *event = *early = false;
  *stop = status != Ok;
  *last = now(c);
  return status;
}
EXPORT Status fmi3ActivateModelPartition(void *c, uint32_t clock, double time) { return Error; }

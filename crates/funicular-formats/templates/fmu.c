/* {{ comment_name }}: state space x' = A x + B u, y = C x + D u; written by `funicular reduce`.
   {{ statement }}

   Functional Mock-up Unit 2.0 for model exchange and co-simulation. The declarations below are those of the standard
   (Functional Mock-up Interface 2.0.4, chapters 2.1 to 4.2) that this unit uses. It needs a C compiler alone:
   cc -shared -fPIC -O2 -o binaries/linux64/{{ identifier }}.so sources/{{ identifier }}.c */

#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#if defined _WIN32
#define EXPORT __declspec(dllexport)
#else
#define EXPORT __attribute__((visibility("default")))
#endif

typedef void *fmi2Component;
typedef void *fmi2ComponentEnvironment;
typedef void *fmi2FMUstate;
typedef unsigned int fmi2ValueReference;
typedef double fmi2Real;
typedef int fmi2Integer;
typedef int fmi2Boolean;
typedef char fmi2Char;
typedef const fmi2Char *fmi2String;
typedef char fmi2Byte;
typedef enum { fmi2OK, fmi2Warning, fmi2Discard, fmi2Error, fmi2Fatal, fmi2Pending } fmi2Status;
typedef enum { fmi2ModelExchange, fmi2CoSimulation } fmi2Type;
typedef enum { fmi2DoStepStatus, fmi2PendingStatus, fmi2LastSuccessfulTime, fmi2Terminated } fmi2StatusKind;
typedef void (*fmi2CallbackLogger)(fmi2ComponentEnvironment, fmi2String, fmi2Status, fmi2String, fmi2String, ...);
typedef void *(*fmi2CallbackAllocateMemory)(size_t, size_t);
typedef void (*fmi2CallbackFreeMemory)(void *);
typedef void (*fmi2StepFinished)(fmi2ComponentEnvironment, fmi2Status);
typedef struct {
  fmi2CallbackLogger logger;
  fmi2CallbackAllocateMemory allocateMemory;
  fmi2CallbackFreeMemory freeMemory;
  fmi2StepFinished stepFinished;
  fmi2ComponentEnvironment componentEnvironment;
} fmi2CallbackFunctions;
typedef struct {
  fmi2Boolean newDiscreteStatesNeeded;
  fmi2Boolean terminateSimulation;
  fmi2Boolean nominalsOfContinuousStatesChanged;
  fmi2Boolean valuesOfContinuousStatesChanged;
  fmi2Boolean nextEventTimeDefined;
  fmi2Real nextEventTime;
} fmi2EventInfo;

/* The value references are inputs, outputs, states and derivatives, in this order. */
enum { INPUTS = {{ inputs }}, OUTPUTS = {{ outputs }}, STATES = {{ states }} };
enum { OF_OUTPUTS = INPUTS, OF_STATES = INPUTS + OUTPUTS, OF_RATES = OF_STATES + STATES, END = OF_RATES + STATES };
static const char GUID[] = "{{ guid }}";

/* Entries of the matrices that are not zero: row, column, value. */
typedef struct { int row, column; double value; } Entry;
{%- for matrix in matrices %}
static const Entry {{ matrix.name }}[] = { {% for e in matrix.entries %}{ {{ e.0 }}, {{ e.1 }}, {{ e.2|fmt("{:e}") }} }, {% endfor %}{ 0, 0, 0.0 } };
{%- endfor %}
/* Sizes of the states under usual inputs (1 mm, 10 N), for the tolerances of integrators. */
static const double NOMINALS[] = { {% for value in nominals %}{{ value|fmt("{:e}") }}, {% endfor %}};
enum { COUNT_A = sizeof A / sizeof *A, COUNT_B = sizeof B / sizeof *B, COUNT_C = sizeof C / sizeof *C, COUNT_D = sizeof D / sizeof *D };

typedef struct {
  double time, input[INPUTS], state[STATES];
} Model;

/* Adds a matrix times a vector. */
static void add(double *to, const Entry *matrix, int count, const double *by) {
  for (int i = 0; i < count; i++) to[matrix[i].row] += matrix[i].value * by[matrix[i].column];
}

static void rates(const Model *m, double *to) {
  memset(to, 0, STATES * sizeof *to);
  add(to, A, COUNT_A, m->state);
  add(to, B, COUNT_B, m->input);
}

static void outputs(const Model *m, double *to) {
  memset(to, 0, OUTPUTS * sizeof *to);
  add(to, C, COUNT_C, m->state);
  add(to, D, COUNT_D, m->input);
}

/* Moves the state over a step with constant input, exactly: the series x + h v + h^2/2 A v + ... with v = A x + B u, in
   parts so short that the norm of A times a part is at most 1, where 20 terms reach the rounding. */
static void advance(Model *m, double step) {
  double sums[STATES], norm = 0.0, parts;
  memset(sums, 0, sizeof sums);
  for (int i = 0; i < COUNT_A; i++) sums[A[i].row] += A[i].value < 0.0 ? -A[i].value : A[i].value;
  for (int i = 0; i < STATES; i++) norm = sums[i] > norm ? sums[i] : norm;
  parts = (double)(long long)(norm * step) + 1.0;
  const double part = step / parts;
  for (double done = 0.0; done < parts; done += 1.0) {
    double term[STATES], next[STATES];
    rates(m, term);
    for (int k = 1; k <= 20; k++) {
      for (int i = 0; i < STATES; i++) {
        term[i] *= part / k;
        m->state[i] += term[i];
      }
      memset(next, 0, sizeof next);
      add(next, A, COUNT_A, term);
      memcpy(term, next, sizeof term);
    }
  }
  m->time += step;
}

EXPORT const char *fmi2GetTypesPlatform(void) { return "default"; }
EXPORT const char *fmi2GetVersion(void) { return "2.0"; }
EXPORT fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean on, size_t n, const fmi2String kinds[]) { return fmi2OK; }

EXPORT fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String resources,
                                     const fmi2CallbackFunctions *calls, fmi2Boolean visible, fmi2Boolean logging) {
  if (guid == NULL || strcmp(guid, GUID) != 0) {
    if (calls != NULL && calls->logger != NULL)
      calls->logger(calls->componentEnvironment, name, fmi2Error, "error", "the GUID is not that of modelDescription.xml");
    return NULL;
  }
  return calloc(1, sizeof(Model));
}

EXPORT void fmi2FreeInstance(fmi2Component c) { free(c); }
EXPORT fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean toleranceDefined, fmi2Real tolerance, fmi2Real start,
                                      fmi2Boolean stopDefined, fmi2Real stop) {
  ((Model *)c)->time = start;
  return fmi2OK;
}
EXPORT fmi2Status fmi2EnterInitializationMode(fmi2Component c) { return fmi2OK; }
EXPORT fmi2Status fmi2ExitInitializationMode(fmi2Component c) { return fmi2OK; }
EXPORT fmi2Status fmi2Terminate(fmi2Component c) { return fmi2OK; }
EXPORT fmi2Status fmi2Reset(fmi2Component c) {
  memset(c, 0, sizeof(Model));
  return fmi2OK;
}

EXPORT fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference of[], size_t n, fmi2Real to[]) {
  const Model *m = c;
  double y[OUTPUTS], v[STATES];
  outputs(m, y);
  rates(m, v);
  for (size_t i = 0; i < n; i++) {
    if (of[i] < OF_OUTPUTS) to[i] = m->input[of[i]];
    else if (of[i] < OF_STATES) to[i] = y[of[i] - OF_OUTPUTS];
    else if (of[i] < OF_RATES) to[i] = m->state[of[i] - OF_STATES];
    else if (of[i] < END) to[i] = v[of[i] - OF_RATES];
    else return fmi2Error;
  }
  return fmi2OK;
}

EXPORT fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference of[], size_t n, const fmi2Real from[]) {
  Model *m = c;
  for (size_t i = 0; i < n; i++) {
    if (of[i] < OF_OUTPUTS) m->input[of[i]] = from[i];
    else if (of[i] >= OF_STATES && of[i] < OF_RATES) m->state[of[i] - OF_STATES] = from[i];
    else return fmi2Error;
  }
  return fmi2OK;
}

/* There are numbers alone. */
EXPORT fmi2Status fmi2GetInteger(fmi2Component c, const fmi2ValueReference of[], size_t n, fmi2Integer to[]) { return n ? fmi2Error : fmi2OK; }
EXPORT fmi2Status fmi2GetBoolean(fmi2Component c, const fmi2ValueReference of[], size_t n, fmi2Boolean to[]) { return n ? fmi2Error : fmi2OK; }
EXPORT fmi2Status fmi2GetString(fmi2Component c, const fmi2ValueReference of[], size_t n, fmi2String to[]) { return n ? fmi2Error : fmi2OK; }
EXPORT fmi2Status fmi2SetInteger(fmi2Component c, const fmi2ValueReference of[], size_t n, const fmi2Integer from[]) { return n ? fmi2Error : fmi2OK; }
EXPORT fmi2Status fmi2SetBoolean(fmi2Component c, const fmi2ValueReference of[], size_t n, const fmi2Boolean from[]) { return n ? fmi2Error : fmi2OK; }
EXPORT fmi2Status fmi2SetString(fmi2Component c, const fmi2ValueReference of[], size_t n, const fmi2String from[]) { return n ? fmi2Error : fmi2OK; }

EXPORT fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate *kept) {
  if (*kept == NULL) *kept = malloc(sizeof(Model));
  if (*kept == NULL) return fmi2Error;
  memcpy(*kept, c, sizeof(Model));
  return fmi2OK;
}
EXPORT fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate kept) {
  memcpy(c, kept, sizeof(Model));
  return fmi2OK;
}
EXPORT fmi2Status fmi2FreeFMUstate(fmi2Component c, fmi2FMUstate *kept) {
  free(*kept);
  *kept = NULL;
  return fmi2OK;
}
EXPORT fmi2Status fmi2SerializedFMUstateSize(fmi2Component c, fmi2FMUstate kept, size_t *size) {
  *size = sizeof(Model);
  return fmi2OK;
}
EXPORT fmi2Status fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate kept, fmi2Byte to[], size_t size) {
  if (size < sizeof(Model)) return fmi2Error;
  memcpy(to, kept, sizeof(Model));
  return fmi2OK;
}
EXPORT fmi2Status fmi2DeSerializeFMUstate(fmi2Component c, const fmi2Byte from[], size_t size, fmi2FMUstate *kept) {
  if (size < sizeof(Model)) return fmi2Error;
  if (*kept == NULL) *kept = malloc(sizeof(Model));
  if (*kept == NULL) return fmi2Error;
  memcpy(*kept, from, sizeof(Model));
  return fmi2OK;
}

/* The model is linear: its derivatives are outputs and rates of the directions. */
EXPORT fmi2Status fmi2GetDirectionalDerivative(fmi2Component c, const fmi2ValueReference of[], size_t n,
                                               const fmi2ValueReference by[], size_t known, const fmi2Real seed[], fmi2Real to[]) {
  Model direction;
  memset(&direction, 0, sizeof direction);
  if (fmi2SetReal(&direction, by, known, seed) != fmi2OK) return fmi2Error;
  return fmi2GetReal(&direction, of, n, to);
}

EXPORT fmi2Status fmi2EnterEventMode(fmi2Component c) { return fmi2OK; }
EXPORT fmi2Status fmi2NewDiscreteStates(fmi2Component c, fmi2EventInfo *info) {
  memset(info, 0, sizeof *info);
  return fmi2OK;
}
EXPORT fmi2Status fmi2EnterContinuousTimeMode(fmi2Component c) { return fmi2OK; }
EXPORT fmi2Status fmi2CompletedIntegratorStep(fmi2Component c, fmi2Boolean keep, fmi2Boolean *event, fmi2Boolean *end) {
  *event = *end = 0;
  return fmi2OK;
}
EXPORT fmi2Status fmi2SetTime(fmi2Component c, fmi2Real time) {
  ((Model *)c)->time = time;
  return fmi2OK;
}
EXPORT fmi2Status fmi2SetContinuousStates(fmi2Component c, const fmi2Real from[], size_t n) {
  if (n != STATES) return fmi2Error;
  memcpy(((Model *)c)->state, from, n * sizeof *from);
  return fmi2OK;
}
EXPORT fmi2Status fmi2GetDerivatives(fmi2Component c, fmi2Real to[], size_t n) {
  if (n != STATES) return fmi2Error;
  rates(c, to);
  return fmi2OK;
}
EXPORT fmi2Status fmi2GetEventIndicators(fmi2Component c, fmi2Real to[], size_t n) { return n ? fmi2Error : fmi2OK; }
EXPORT fmi2Status fmi2GetContinuousStates(fmi2Component c, fmi2Real to[], size_t n) {
  if (n != STATES) return fmi2Error;
  memcpy(to, ((Model *)c)->state, n * sizeof *to);
  return fmi2OK;
}
EXPORT fmi2Status fmi2GetNominalsOfContinuousStates(fmi2Component c, fmi2Real to[], size_t n) {
  if (n != STATES) return fmi2Error;
  for (size_t i = 0; i < n; i++) to[i] = NOMINALS[i];
  return fmi2OK;
}

EXPORT fmi2Status fmi2SetRealInputDerivatives(fmi2Component c, const fmi2ValueReference of[], size_t n, const fmi2Integer order[], const fmi2Real from[]) { return fmi2Error; }
EXPORT fmi2Status fmi2GetRealOutputDerivatives(fmi2Component c, const fmi2ValueReference of[], size_t n, const fmi2Integer order[], fmi2Real to[]) { return fmi2Error; }
EXPORT fmi2Status fmi2DoStep(fmi2Component c, fmi2Real time, fmi2Real step, fmi2Boolean keep) {
  if (!(step >= 0.0)) return fmi2Error;
  advance(c, step);
  ((Model *)c)->time = time + step;
  return fmi2OK;
}
EXPORT fmi2Status fmi2CancelStep(fmi2Component c) { return fmi2Error; }
EXPORT fmi2Status fmi2GetStatus(fmi2Component c, fmi2StatusKind kind, fmi2Status *to) { return fmi2Discard; }
EXPORT fmi2Status fmi2GetRealStatus(fmi2Component c, fmi2StatusKind kind, fmi2Real *to) {
  if (kind != fmi2LastSuccessfulTime) return fmi2Discard;
  *to = ((Model *)c)->time;
  return fmi2OK;
}
EXPORT fmi2Status fmi2GetIntegerStatus(fmi2Component c, fmi2StatusKind kind, fmi2Integer *to) { return fmi2Discard; }
EXPORT fmi2Status fmi2GetBooleanStatus(fmi2Component c, fmi2StatusKind kind, fmi2Boolean *to) {
  *to = 0;
  return kind == fmi2Terminated ? fmi2OK : fmi2Discard;
}
EXPORT fmi2Status fmi2GetStringStatus(fmi2Component c, fmi2StatusKind kind, fmi2String *to) { return fmi2Discard; }

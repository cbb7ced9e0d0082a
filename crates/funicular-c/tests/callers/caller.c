/* A controller in C99: the loop of docs/controller.md, and everything that goes wrong. Argument: a robot file. Exit code
 * 0 and a line per check, or the first check that fails. */
#include "funicular.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define CHECK(condition)                                                   \
  do {                                                                     \
    if (!(condition)) {                                                    \
      fprintf(stderr, "%s:%d: %s\n", __FILE__, __LINE__, #condition);      \
      exit(1);                                                             \
    }                                                                      \
  } while (0)

/* Memory of the loop: no heap. */
static union {
  unsigned char bytes[65536];
  double for_alignment;
  void *for_alignment_too;
} memory;

static fn_pose_input at(double x, double y, double z) {
  fn_pose_input input;
  memset(&input, 0, sizeof input);
  input.struct_size = sizeof input;
  input.position_m[0] = x;
  input.position_m[1] = y;
  input.position_m[2] = z;
  input.quaternion_wxyz[0] = 1.0;
  return input;
}

static void follows_a_line(fn_loop *loop, uint32_t cables) {
  double length[FN_MAX_CABLES], rate[FN_MAX_CABLES], tension[FN_MAX_CABLES], before[FN_MAX_CABLES];
  fn_inverse_result result;
  double speed = 0.2;
  int tick;
  uint32_t i;

  memset(&result, 0, sizeof result);
  result.struct_size = sizeof result;
  result.cables = FN_MAX_CABLES;
  result.length_m = length;
  result.length_rate_m_s = rate;
  result.tension_drum_n = tension;

  for (tick = 0; tick < 1000; tick++) {
    fn_pose_input input = at(speed * tick * 1e-3, 0.0, 1.5);
    int32_t status;
    input.velocity_m_s[0] = speed;
    status = fn_inverse(loop, &input, &result);
    CHECK(status == FN_CERTIFIED && result.status == status && result.age_calls == 0);
    CHECK(result.error_n < 1e-6 && result.least_margin_n > 0.0 && result.iterations <= 12);
    for (i = 0; i < cables; i++) {
      CHECK(tension[i] > 0.0);
      if (tick > 0) CHECK(fabs((length[i] - before[i]) / 1e-3 - rate[i]) < 1e-3);
    }
    memcpy(before, length, sizeof before);
  }
  printf("a line at 0.2 m/s: lengths of cable 1 to %.6f m\n", length[0]);
}

static void goes_there_and_back(fn_loop *loop, uint32_t cables) {
  double length[FN_MAX_CABLES], tension[FN_MAX_CABLES];
  fn_pose_input input = at(0.4, -0.3, 1.2);
  fn_inverse_result there;
  fn_forward_result back;
  fn_wrench_result load;

  memset(&there, 0, sizeof there);
  there.struct_size = sizeof there;
  there.cables = cables;
  there.length_m = length;
  there.tension_drum_n = tension;
  input.force_n[0] = 30.0;
  CHECK(fn_inverse(loop, &input, &there) == FN_CERTIFIED);

  memset(&back, 0, sizeof back);
  back.struct_size = sizeof back;
  input.position_m[0] += 0.002;
  CHECK(fn_forward(loop, length, cables, &input, &back) >= FN_CERTIFIED);
  CHECK(fabs(back.position_m[0] - 0.4) < 1e-9 && fabs(back.position_m[1] + 0.3) < 1e-9);

  memset(&load, 0, sizeof load);
  load.struct_size = sizeof load;
  input.position_m[0] -= 0.002;
  CHECK(fn_wrench(loop, &input, tension, cables, &load) == FN_CERTIFIED);
  CHECK(fabs(load.force_n[0] - 30.0) < 1e-5 && fabs(load.payload_kg) < 1e-5);
  printf("lengths lead back to the pose within %.1e m\n", fabs(back.position_m[0] - 0.4));
}

static void refuses(fn_model *model, fn_loop *loop, uint32_t cables) {
  double length[FN_MAX_CABLES], untouched = -77.0;
  fn_pose_input input = at(0.0, 0.0, 1.5);
  fn_inverse_result result;
  unsigned char *aside = memory.bytes + 1;
  fn_loop *other = NULL;

  memset(&result, 0, sizeof result);
  result.struct_size = sizeof result;
  result.cables = cables;
  result.length_m = length;
  length[0] = untouched;
  result.status = 55;

  input.position_m[1] = NAN;
  CHECK(fn_inverse(loop, &input, &result) == FN_BAD_INPUT);
  input.position_m[1] = 1e300;
  CHECK(fn_inverse(loop, &input, &result) == FN_BAD_INPUT);
  input.position_m[1] = 0.0;
  input.quaternion_wxyz[0] = 0.0;
  CHECK(fn_inverse(loop, &input, &result) == FN_BAD_INPUT);
  input.quaternion_wxyz[0] = 1.01;
  CHECK(fn_inverse(loop, &input, &result) == FN_BAD_INPUT);
  input.quaternion_wxyz[0] = -1.0005;
  CHECK(fn_inverse(NULL, &input, &result) == FN_BAD_POINTER);
  CHECK(fn_inverse(loop, NULL, &result) == FN_BAD_POINTER);
  CHECK(fn_inverse(loop, &input, NULL) == FN_BAD_POINTER);
  input.struct_size = 12;
  CHECK(fn_inverse(loop, &input, &result) == FN_BAD_STRUCT);
  input.struct_size = sizeof input;
  result.cables = cables - 1;
  CHECK(fn_inverse(loop, &input, &result) == FN_BAD_STRUCT);
  result.cables = cables;
  CHECK(length[0] == untouched && result.status == 55 && result.iterations == 0);

  /* The first version of a struct, and a later one. */
  input.struct_size = (uint32_t)offsetof(fn_pose_input, velocity_m_s);
  CHECK(fn_inverse(loop, &input, &result) == FN_CERTIFIED && length[0] != untouched);
  input.struct_size = sizeof input + 64;
  CHECK(fn_inverse(loop, &input, &result) == FN_CERTIFIED);
  input.struct_size = sizeof input;
  length[0] = untouched;
  result.struct_size = (uint32_t)offsetof(fn_inverse_result, length_m);
  CHECK(fn_inverse(loop, &input, &result) == FN_CERTIFIED && length[0] == untouched);

  CHECK(fn_model_free(model) == FN_IN_USE);
  CHECK(fn_loop_init(model, aside, sizeof memory - 8, &other) == FN_BAD_MEMORY);
  CHECK(fn_loop_init(model, memory.bytes + 32768, 16, &other) == FN_BAD_MEMORY && other == NULL);
  printf("bad input, addresses, structs and memory are refused\n");
}

/* Text of a file with a zero behind it. */
static char *text_of(const char *path, size_t *bytes) {
  FILE *file = fopen(path, "rb");
  char *text;
  CHECK(file != NULL && fseek(file, 0, SEEK_END) == 0);
  *bytes = (size_t)ftell(file);
  text = malloc(*bytes + 1);
  CHECK(text != NULL && fseek(file, 0, SEEK_SET) == 0 && fread(text, 1, *bytes, file) == *bytes);
  text[*bytes] = 0;
  fclose(file);
  return text;
}

/* Lengths and tensions of a line as readings: the estimator follows it. */
static void estimates(const char *path, fn_loop *loop, uint32_t cables) {
  double length[FN_MAX_CABLES], tension[FN_MAX_CABLES], estimated[FN_MAX_CABLES], speed = 0.1, end;
  double near_pose[7] = {0.0, 0.0, 1.5, 1.0, 0.0, 0.0, 0.0};
  fn_inverse_result at_rest;
  fn_est_settings settings;
  fn_est_readings readings;
  fn_est_result result;
  fn_est *est = NULL;
  char message[500];
  size_t bytes = 0;
  char *toml = text_of(path, &bytes);
  int tick;

  memset(&at_rest, 0, sizeof at_rest);
  at_rest.struct_size = sizeof at_rest;
  at_rest.cables = FN_MAX_CABLES;
  at_rest.length_m = length;
  at_rest.tension_drum_n = tension;
  memset(&settings, 0, sizeof settings);
  settings.struct_size = sizeof settings;
  CHECK(fn_est_defaults(&settings) == FN_CERTIFIED && settings.payload_std_kg > 0.0);
  settings.payload_std_kg = 0.5;
  memset(&readings, 0, sizeof readings);
  readings.struct_size = sizeof readings;
  readings.cables = cables;
  readings.length_m = length;
  readings.tension_n = tension;
  memset(&result, 0, sizeof result);
  result.struct_size = sizeof result;
  result.cables = FN_MAX_CABLES;
  result.tension_n = estimated;

  for (tick = 0; tick <= 1000; tick++) {
    /* From rest to the full speed within 0.5 s. */
    double time = tick * 1e-3, grown = time < 0.5 ? time * time : time - 0.25;
    fn_pose_input input = at(speed * grown, 0.0, 1.5);
    CHECK(fn_inverse(loop, &input, &at_rest) == FN_CERTIFIED);
    if (tick == 0) {
      int32_t status = fn_est_new(toml, bytes, &settings, &readings, near_pose, &est, message, sizeof message);
      if (status != FN_CERTIFIED) fprintf(stderr, "%s\n", message);
      CHECK(status == FN_CERTIFIED);
    } else {
      CHECK(fn_est_update(est, &readings, 1e-3, &result) == FN_CERTIFIED && result.is_trusted == 1);
    }
  }
  end = speed * 0.75;
  CHECK(fabs(result.position_m[0] - end) < 3.0 * result.position_std_m[0] + 1e-4);
  CHECK(fabs(result.velocity_m_s[0] - speed) < 5e-3 && estimated[0] > 0.0);
  length[0] = NAN;
  CHECK(fn_est_update(est, &readings, 1e-3, &result) == FN_BAD_INPUT);
  readings.length_missing = 1;
  CHECK(fn_est_update(est, &readings, 1e-3, &result) == FN_CERTIFIED);
  CHECK(fn_est_free(est) == FN_CERTIFIED && fn_est_free(NULL) == FN_CERTIFIED);
  free(toml);
  printf("an estimator follows: x %.4f m, deviation %.4f m\n", end, result.position_std_m[0]);
}

int main(int count, char **arguments) {
  char message[2000], words[200];
  fn_model *model = NULL;
  fn_loop *loop = NULL;
  size_t bytes = 0, alignment = 0;
  uint32_t cables = 0;

  CHECK(count == 2 && fn_abi_version() == FN_ABI_VERSION);
  CHECK(fn_model_from_toml("name = ", 7, &model, message, sizeof message) == FN_BAD_MODEL && strlen(message) > 10);
  CHECK(fn_model_from_file("no such file", &model, message, sizeof message) == FN_BAD_MODEL && model == NULL);
  if (fn_model_from_file(arguments[1], &model, message, sizeof message) != FN_CERTIFIED) {
    fprintf(stderr, "%s\n", message);
    return 1;
  }
  CHECK(fn_model_cables(model, &cables) == FN_CERTIFIED && cables <= FN_MAX_CABLES);
  CHECK(fn_loop_bytes(model, &bytes, &alignment) == FN_CERTIFIED);
  CHECK(bytes <= sizeof memory / 2 && (uintptr_t)memory.bytes % alignment == 0);
  CHECK(fn_loop_init(model, memory.bytes, bytes, &loop) == FN_CERTIFIED);
  CHECK(fn_warm_up(loop) == FN_CERTIFIED);

  follows_a_line(loop, cables);
  goes_there_and_back(loop, cables);
  refuses(model, loop, cables);
  estimates(arguments[1], loop, cables);

  CHECK(fn_reset(loop) == FN_CERTIFIED);
  CHECK(fn_loop_end(loop) == FN_CERTIFIED && fn_loop_end(loop) == FN_BAD_HANDLE);
  CHECK(fn_warm_up(loop) == FN_BAD_HANDLE);
  CHECK(fn_model_free(model) == FN_CERTIFIED && fn_model_free(NULL) == FN_CERTIFIED);
  CHECK(fn_status_text(FN_HELD, words, sizeof words) == FN_CERTIFIED && strstr(words, "held") != NULL);
  printf("a loop takes %lu bytes\n", (unsigned long)bytes);
  return 0;
}

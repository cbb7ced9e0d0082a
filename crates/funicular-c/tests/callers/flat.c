/* The flat header from C: the same lengths as by funicular.h are compared in Octave's and Julia's callers too. Argument: a
 * robot file. */
#include "funicular_flat.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define CHECK(condition)                                              \
  do {                                                                \
    if (!(condition)) {                                               \
      fprintf(stderr, "%s:%d: %s\n", __FILE__, __LINE__, #condition); \
      exit(1);                                                        \
    }                                                                 \
  } while (0)

int main(int count, char **arguments) {
  double input[25] = {0.3, -0.2, 1.4, 1.0, 0.0, 0.0, 0.0, 0.1};
  double summary[7], length[16], rate[16], acceleration[16], platform[16], drum[16], pose[7], load[7];
  void *session = NULL;
  char message[2000];

  CHECK(count == 2);
  CHECK(fn_flat_open("no such file", &session, message, sizeof message) == -4 && session == NULL);
  CHECK(fn_flat_open(arguments[1], &session, message, sizeof message) == 0);
  CHECK(fn_flat_cables(session) == 8);
  CHECK(fn_flat_inverse(session, input, summary, length, rate, acceleration, platform, drum) == 0);
  CHECK(summary[0] == 0.0 && summary[4] > 0.0 && fabs(rate[0]) < 0.1 && drum[0] > 0.0);
  CHECK(fn_flat_reset(session) == 0);
  CHECK(fn_flat_forward(session, length, NULL, summary, pose, NULL, NULL) >= 0);
  CHECK(fabs(pose[0] - 0.3) < 1e-6 && fabs(pose[2] - 1.4) < 1e-6 && fabs(fabs(pose[3]) - 1.0) < 1e-9);
  input[7] = 0.0;
  CHECK(fn_flat_wrench(session, input, drum, load) == 0 && fabs(load[6]) < 1e-3);
  input[0] = NAN;
  CHECK(fn_flat_inverse(session, input, NULL, length, NULL, NULL, NULL, NULL) == -1);
  CHECK(fn_flat_inverse(NULL, input, NULL, length, NULL, NULL, NULL, NULL) == -2);
  CHECK(fn_flat_close(session) == 0 && fn_flat_close(NULL) == 0);
  printf("flat: %.6f m\n", length[0]);
  return 0;
}

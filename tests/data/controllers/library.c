/* A controller that steers straight on, and in period 2 does what options.mode says. Asked for plans, it
 * numbers what it is to write: the inputs in steps of 0.001, the gains in steps of 0.0001. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "controller/control/controller_abi.h"

struct controller {
  char mode[16];
  int input_dim;
  int state_dim;
  int horizon;
  uint64_t seed;
};

static void* create(const qsmpc_problem* problem, char* error, size_t size) {
  struct controller* made = calloc(1, sizeof *made);
  const char* mode = strstr(problem->options, "\"mode\":\"");
  if (mode != NULL) sscanf(mode + 8, "%15[a-z_]", made->mode);
  made->input_dim = problem->input_dim;
  made->state_dim = problem->state_dim;
  made->horizon = problem->horizon;
  printf("what a library prints is in the log\n");
  fflush(stdout);
  if (strcmp(made->mode, "no_start") != 0) return made;
  snprintf(error, size, "no horizon of %d stages", (int)problem->horizon);
  free(made);
  return NULL;
}

static void reset(void* self, uint64_t seed) { ((struct controller*)self)->seed = seed; }

static int32_t act(void* self, const qsmpc_situation* situation, qsmpc_answer* answer, char* error,
                   size_t size) {
  const struct controller* controller = self;
  const char* mode = situation->period == 2 ? controller->mode : "";
  int i;
  if (answer->plan_inputs != NULL) {
    const int inputs = controller->horizon * controller->input_dim;
    for (i = 0; i < inputs; ++i) answer->plan_inputs[i] = 1e-3 * i;
    for (i = 0; i < inputs * controller->state_dim; ++i) answer->plan_gains[i] = 1e-4 * i;
    return 0;
  }
  if (answer->input == NULL) return 2;
  for (i = 0; i < controller->input_dim; ++i) answer->input[i] = 0.01 * (double)(controller->seed % 10);
  if (strcmp(mode, "crash") == 0) *(volatile int*)NULL = 1;
  if (strcmp(mode, "exit") == 0) exit(7);
  while (strcmp(mode, "hang") == 0) sleep(1000);
  if (strcmp(mode, "reads") == 0 && getchar() != EOF) exit(8);
  if (strcmp(mode, "nan") == 0) answer->input[0] = NAN;
  if (strcmp(mode, "inf") == 0) answer->input[0] = INFINITY;
  if (strcmp(mode, "size") == 0) answer->input_count = 2;
  if (strcmp(mode, "bounds") == 0) answer->input[0] = 99.0;
  if (strcmp(mode, "error") == 0) {
    snprintf(error, size, "no way out");
    return 1;
  }
  return 0;
}

static void destroy(void* self) { free(self); }

const qsmpc_controller_table* qsmpc_controller(void) {
#ifdef OTHER_VERSION
  static const qsmpc_controller_table table = {QSMPC_CONTROLLER_ABI + 1, "other", create, reset, act,
                                               destroy};
#else
  static const qsmpc_controller_table table = {QSMPC_CONTROLLER_ABI, "library", create, reset, act,
                                               destroy};
#endif
  return &table;
}

/* A system of doubles alone, without a recording: no derivatives are known. */
#include <stdlib.h>
#include <string.h>

#include "models/dynamics/own_dynamics_abi.h"

typedef struct cart {
  double mass;
  double time_step;
} cart;

static void* create(const double* parameters, double time_step, char* message, size_t size) {
  if (!(parameters[0] > 0.0)) {
    strncpy(message, "mass must be above 0", size - 1);
    return NULL;
  }
  cart* model = malloc(sizeof(cart));
  if (model != NULL) *model = (cart){parameters[0], time_step};
  return model;
}

static int32_t step(const void* model, size_t count, const double* const* states,
                    const double* const* inputs, double* const* next) {
  const cart* c = model;
  for (size_t i = 0; i < count; ++i) {
    next[0][i] = states[0][i] + c->time_step * states[1][i];
    next[1][i] = states[1][i] + c->time_step * inputs[0][i] / c->mass;
  }
  return 0;
}

static const qsmpc_coordinate kStates[] = {{"position", "m", 0, 0.0, 0.0},
                                           {"velocity", "m/s", 0, 0.0, 0.0}};
static const qsmpc_coordinate kInputs[] = {{"force", "N", 0, -5.0, 5.0}};
static const qsmpc_parameter kParameters[] = {{"mass", "kg", 2.0}};
static const qsmpc_system kCart = {.name = "plain_cart",
                                   .summary = "a cart without derivatives",
                                   .states = kStates,
                                   .inputs = kInputs,
                                   .parameters = kParameters,
                                   .state_count = 2,
                                   .input_count = 1,
                                   .parameter_count = 1,
                                   .position_x = -1,
                                   .position_y = -1,
                                   .heading = -1,
                                   .create = create,
                                   .destroy = free,
                                   .step = step,
                                   .record = NULL};
static const qsmpc_system* const kSystems[] = {&kCart};
static const qsmpc_dynamics_table kTable = {
#ifdef OTHER_VERSION
    OTHER_VERSION,
#else
    QSMPC_DYNAMICS_VERSION,
#endif
    1, kSystems};

const qsmpc_dynamics_table* qsmpc_dynamics(void);
const qsmpc_dynamics_table* qsmpc_dynamics(void) { return &kTable; }

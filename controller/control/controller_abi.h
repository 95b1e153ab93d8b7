/* The C interface of controllers that are no part of qsmpc: a shared library that a scenario names,
 *
 *     controller: {kind: library, library: mpc.so}
 *
 * It exports one function, `qsmpc_controller`, which returns a table of four others. They are called by
 * a process of the controller's own, from one thread, in this order: create, reset, act … act, reset,
 * act …, destroy. What crashes or hangs there ends the drive, not qsmpc.
 *
 * Usable from C99 and C++. Matrices are stored row by row. See docs/controllers.md.
 */
#ifndef QSMPC_CONTROLLER_ABI_H
#define QSMPC_CONTROLLER_ABI_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* NOLINTBEGIN(modernize-use-using, readability-identifier-naming): it is C. */

/* Grows with every change of what follows. */
#define QSMPC_CONTROLLER_ABI 1

typedef struct qsmpc_coordinate {
  const char* name; /* e.g. "x" */
  const char* unit; /* SI symbol, e.g. "m" */
  int32_t is_angle; /* whether values 2 pi apart mean the same */
} qsmpc_coordinate;

/* The resolved scenario, n states and m inputs. Valid while the controller is. */
typedef struct qsmpc_problem {
  const char* name;
  const char* system;
  int32_t state_dim; /* n */
  int32_t input_dim; /* m */
  const qsmpc_coordinate* states;
  const qsmpc_coordinate* inputs;
  int32_t position_x; /* index of the state; -1 where the system has none, as below */
  int32_t position_y;
  int32_t heading;
  int32_t parameter_count; /* constants of the system */
  const char* const* parameter_names;
  const double* parameter_values;

  double time_step;   /* s, the control period */
  int32_t step_limit; /* periods of a drive at most */
  int32_t horizon;    /* stages of a plan, controller.horizon */
  int32_t plans;      /* whether every answer shall have a plan, controller.plans */
  double deadline;    /* s, for an answer */

  const double* input_lower; /* m */
  const double* input_upper;
  const double* initial_mean;       /* n */
  const double* initial_covariance; /* n x n */
  const double* noise_covariance;   /* n x n, added to the state in every period */
  const double* sensor_covariance;  /* n x n, of what is observed less the state */

  const double* bounds_lower; /* n, of the safe set; infinite where there are none */
  const double* bounds_upper;
  int32_t obstacle_count;       /* of boxes; shapes of the plane of position are in `json` alone */
  const double* obstacle_lower; /* obstacle_count x n, boxes; infinite as the bounds */
  const double* obstacle_upper;
  int32_t disc_count;         /* of the vehicle's footprint; 0: a point */
  const double* disc_radii;   /* m */
  const double* disc_offsets; /* disc_count x 2, forward and left of the position, m */

  const double* target; /* n */
  double target_radius; /* m */
  const double* cost_state;    /* n x n, Q of 1/2 x'Qx */
  const double* cost_input;    /* m x m, R of u'Ru */
  const double* cost_terminal; /* n x n, P of x'Px */
  double risk_stage;           /* limits of certified probabilities; infinite for none */
  double risk_plan;
  double risk_mission;

  const char* options; /* controller.options as a JSON object */
  const char* json;    /* all of this and more as JSON, as external controllers get it */
} qsmpc_problem;

/* What is known when an input is to be chosen. Valid during the call. */
typedef struct qsmpc_situation {
  int64_t period;            /* of the drive, from 0 */
  int64_t periods_left;      /* this one with them, at most */
  double time;               /* s */
  double deadline;           /* s from now */
  const double* observation; /* n, what is seen of the state now */
  const double* mean;        /* n, of the state as it was predicted before that */
  const double* covariance;  /* n x n */
} qsmpc_situation;

/* What is decided; `act` writes into it. Inputs must be within the bounds. */
typedef struct qsmpc_answer {
  double* input;       /* without plans: m, to be written */
  int32_t input_count; /* how many of them were; m unless changed */
  /* With plans, else null: horizon x m, the inputs of the stages, and horizon x m x n, how they
   * answer to the state's distance from the nominal one, zero unless written. The input of this
   * period is then that of the first stage at what is observed. */
  double* plan_inputs;
  double* plan_gains;
  /* How the optimisation ended: "converged", "iteration_limit", "stalled", "deadline", "infeasible",
   * "risk_exceeded" or "numerical_trouble"; null for the first. */
  const char* status;
  int32_t evaluations; /* of the cost; 0 where that is not known */
} qsmpc_answer;

typedef struct qsmpc_controller_table {
  uint32_t abi;     /* QSMPC_CONTROLLER_ABI; the first member in every version */
  const char* name; /* for messages */
  /* Returns the controller, which the others get; null where it cannot be made, with the reason as a
   * text that ends in 0 in `error`, `size` bytes. */
  void* (*create)(const qsmpc_problem* problem, char* error, size_t size);
  /* The next period is the first of another drive, with random numbers of this seed. */
  void (*reset)(void* controller, uint64_t seed);
  /* Returns 0, or anything else where there is no answer, with the reason in `error`. */
  int32_t (*act)(void* controller, const qsmpc_situation* situation, qsmpc_answer* answer, char* error,
                 size_t size);
  void (*destroy)(void* controller);
} qsmpc_controller_table;

/* What the library exports. The table must stay valid. */
#if defined(__GNUC__)
__attribute__((visibility("default")))
#endif
const qsmpc_controller_table* qsmpc_controller(void);

/* NOLINTEND(modernize-use-using, readability-identifier-naming) */

#ifdef __cplusplus
}
#endif

#endif

/* What a shared library with systems of one's own exports: one function, which returns a table of
 * plain values and functions. In C or C++; in C++ own_dynamics.hpp writes the table by itself.
 *
 * No function may let an exception out. All are called from several threads at a time, on one model,
 * and must answer the same to the same arguments.
 */
#ifndef QSMPC_OWN_DYNAMICS_ABI_H
#define QSMPC_OWN_DYNAMICS_ABI_H

#include <stddef.h>
#include <stdint.h>

/* NOLINTBEGIN(readability-identifier-naming, modernize-use-using): C */
#ifdef __cplusplus
extern "C" {
#endif

/* Of everything in this file; a library of another one is refused. */
#define QSMPC_DYNAMICS_VERSION 1u
/* What the exported function is called. */
#define QSMPC_DYNAMICS_SYMBOL "qsmpc_dynamics"

typedef struct qsmpc_coordinate {
  const char* name; /* a letter, then letters, digits and _ */
  const char* unit; /* SI symbol, e.g. "rad/s" */
  int32_t is_angle; /* whether values 2 pi apart mean the same */
  double lower;     /* of an input: its bounds, finite */
  double upper;
} qsmpc_coordinate;

typedef struct qsmpc_parameter {
  const char* name;
  const char* unit;
  double value; /* unless the scenario says another one */
} qsmpc_parameter;

/* Operations that a step is recorded as, on values that are numbered from 0: first the states, then
 * the inputs. New ones are added at the end. */
enum qsmpc_operation {
  QSMPC_CONSTANT,
  QSMPC_NEGATE,
  QSMPC_ADD,
  QSMPC_SUBTRACT,
  QSMPC_MULTIPLY,
  QSMPC_DIVIDE,
  QSMPC_POWER,
  QSMPC_SQRT,
  QSMPC_SIN,
  QSMPC_COS,
  QSMPC_TAN,
  QSMPC_ASIN,
  QSMPC_ACOS,
  QSMPC_ATAN,
  QSMPC_ATAN2,
  QSMPC_EXP,
  QSMPC_LOG,
  QSMPC_SINH,
  QSMPC_COSH,
  QSMPC_TANH,
  QSMPC_ABS,
  QSMPC_MIN,
  QSMPC_MAX
};

typedef struct qsmpc_recorder {
  void* context;
  /* The number of the result of `operation` on the values a and b (or a alone), or of `constant`;
   * below 0 where there is none, after which the recording must end. */
  int32_t (*record)(void* context, int32_t operation, int32_t a, int32_t b, double constant);
} qsmpc_recorder;

typedef struct qsmpc_system {
  const char* name;
  const char* summary; /* one line */
  const qsmpc_coordinate* states;
  const qsmpc_coordinate* inputs;
  const qsmpc_parameter* parameters;
  int32_t state_count;
  int32_t input_count;
  int32_t parameter_count;
  int32_t position_x; /* numbers of states, from 0; -1 where there is none */
  int32_t position_y;
  int32_t heading;

  /* A model with these parameters, in the table's order, for a control period in s; NULL, with a
   * line in `message`, where it cannot be. */
  void* (*create)(const double* parameters, double time_step, char* message, size_t message_size);
  void (*destroy)(void* model);
  /* The states after a control period of `count` particles; rows[i] holds coordinate i of all of
   * them. 0 where it was done. */
  int32_t (*step)(const void* model, size_t count, const double* const* states,
                  const double* const* inputs, double* const* next);
  /* The same step as operations: writes the numbers of the new states to `next`. 0 where it was
   * done. NULL: derivatives are not known, and no certificate is given. */
  int32_t (*record)(const void* model, const qsmpc_recorder* recorder, int32_t* next);
} qsmpc_system;

typedef struct qsmpc_dynamics_table {
  uint32_t version; /* QSMPC_DYNAMICS_VERSION; stays the first member in every version */
  uint32_t system_count;
  const qsmpc_system* const* systems;
} qsmpc_dynamics_table;

/* The exported function. */
typedef const qsmpc_dynamics_table* (*qsmpc_dynamics_function)(void);

#ifdef __cplusplus
}
#endif
/* NOLINTEND(readability-identifier-naming, modernize-use-using) */

#endif

#include "controller/planning/cost/cost_terms.hpp"

namespace qsmpc::controller {

const std::vector<CostTermEntry>& cost_terms() {
  static const std::vector<CostTermEntry> table = {
      {.name = "input", .part = "input", .make = make_input_term},
      {.name = "state", .part = "state", .make = make_state_term},
      {.name = "terminal", .part = "terminal", .make = make_terminal_term},
      {.name = "bounds", .part = "box", .make = make_bounds_term},
      {.name = "obstacles", .part = "obstacle", .make = make_obstacle_term},
      {.name = "printed bounds", .part = "box", .make = make_printed_bounds_term},
      {.name = "printed obstacles", .part = "obstacle", .make = make_printed_obstacle_term},
  };
  return table;
}

}  // namespace qsmpc::controller

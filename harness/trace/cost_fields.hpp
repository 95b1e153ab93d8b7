// The names that files use for the parts of a plan's expected cost: a single list for writing and
// reading.
#pragma once

#include <string>
#include <vector>

#include "controller/planning/cost/cost_parts.hpp"

namespace qsmpc::harness {

/// The columns of /plan/cost.
[[nodiscard]] inline std::vector<std::string> cost_part_names() {
  std::vector<std::string> names;
  for (const controller::CostPartEntry& part : controller::cost_parts()) names.push_back(part.name);
  return names;
}

/// The cost parts in the order of the columns.
[[nodiscard]] inline std::vector<double> cost_row(const controller::CostParts& cost) {
  std::vector<double> row(controller::cost_parts().size());
  for (std::size_t part = 0; part < row.size(); ++part) row[part] = cost[part];
  return row;
}

}  // namespace qsmpc::harness

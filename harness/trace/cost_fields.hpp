// The parts of a plan's expected cost under the names that files use, so that what is written and
// read is one list.
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "controller/planning/cost/horizon_cost.hpp"

namespace qsmpc::harness {

struct CostField {
  const char* name;
  double controller::CostParts::*member;
};

/// The columns of /plan/cost.
inline constexpr std::array<CostField, 5> kCostFields = {{
    {"state", &controller::CostParts::state},
    {"input", &controller::CostParts::input},
    {"terminal", &controller::CostParts::terminal},
    {"box", &controller::CostParts::box},
    {"obstacle", &controller::CostParts::obstacle},
}};

[[nodiscard]] inline std::vector<std::string> cost_part_names() {
  std::vector<std::string> names(kCostFields.size());
  std::ranges::transform(kCostFields, names.begin(), &CostField::name);
  return names;
}

/// The parts in the order of the columns.
[[nodiscard]] inline std::vector<double> cost_row(const controller::CostParts& cost) {
  std::vector<double> row;
  row.reserve(kCostFields.size());
  for (const CostField& field : kCostFields) row.push_back(cost.*field.member);
  return row;
}

}  // namespace qsmpc::harness

#include "controller/planning/cost/cost_parts.hpp"

#include <stdexcept>

namespace qsmpc::controller {

const std::vector<CostPartEntry>& cost_parts() {
  static const std::vector<CostPartEntry> table = {
      {.name = "state", .words = "distance to the target"},
      {.name = "input", .words = "input"},
      {.name = "terminal", .words = "distance at the plan’s end"},
      {.name = "box", .words = "nearness to the bounds"},
      {.name = "obstacle", .words = "nearness to obstacles"},
  };
  return table;
}

std::size_t cost_part(std::string_view name) {
  const std::vector<CostPartEntry>& table = cost_parts();
  for (std::size_t part = 0; part < table.size(); ++part) {
    if (table[part].name == name) return part;
  }
  throw std::invalid_argument("no part of the cost is called '" + std::string(name) + "'");
}

CostParts::CostParts(std::initializer_list<std::pair<std::string_view, double>> parts) {
  for (const auto& [name, value] : parts) values_[cost_part(name)] = value;
}

CostParts CostParts::all(double value) {
  CostParts parts;
  for (std::size_t part = 0; part < cost_parts().size(); ++part) parts[part] = value;
  return parts;
}

double CostParts::total() const {
  double sum = values_.front();
  for (std::size_t part = 1; part < kMost; ++part) sum += values_[part];
  return sum;
}

}  // namespace qsmpc::controller

#include "harness/contest/contest.hpp"

#include <fmt/format.h>

namespace qsmpc::harness {

std::vector<ContestCell> Contest::cells() const {
  std::vector<ContestCell> all;
  for (std::size_t scenario = 0; scenario < scenarios.size(); ++scenario) {
    for (std::size_t plant = 0; plant < plants.size(); ++plant) {
      for (std::size_t level = 0; level < noise.size(); ++level) {
        all.push_back({.scenario = scenario, .plant = plant, .noise = level});
      }
    }
  }
  return all;
}

std::string Contest::name_of(const ContestCell& cell) const {
  std::string text;
  const auto append = [&](const std::string& part) { text += (text.empty() ? "" : ", ") + part; };
  const bool is_only_scenario = scenarios.size() == 1 && (plants.size() > 1 || noise.size() > 1);
  if (!is_only_scenario) append(scenarios[cell.scenario].text);
  if (plants.size() > 1) append(plants[cell.plant].text);
  if (noise.size() > 1) append(fmt::format("noise {:g}", noise[cell.noise]));
  return text;
}

}  // namespace qsmpc::harness

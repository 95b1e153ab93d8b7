// A plant's answers as a table, and as JSON.
#pragma once

#include <optional>
#include <string>

#include "harness/doctor/gain_search.hpp"
#include "harness/doctor/plant_answers.hpp"
#include "harness/scenario/scenario.hpp"

namespace qsmpc::harness {

/// What `qsmpc doctor` has found.
struct Diagnosis {
  const Scenario& scenario;
  PlantAnswers answers;
  std::optional<GainSearch> search{};  ///< where gains were sought
};

/// Lines for a terminal: every state's answer to every input, what is wrong, and gains to try.
[[nodiscard]] std::string diagnosis_table(const Diagnosis& diagnosis);

[[nodiscard]] std::string diagnosis_json(const Diagnosis& diagnosis);

}  // namespace qsmpc::harness

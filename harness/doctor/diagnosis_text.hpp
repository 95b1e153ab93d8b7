// A plant's responses as a table, and as JSON.
#pragma once

#include <optional>
#include <string>

#include "harness/doctor/gain_search.hpp"
#include "harness/doctor/plant_answers.hpp"
#include "harness/scenario/scenario.hpp"

namespace qsmpc::harness {

/// The findings of `qsmpc doctor`.
struct Diagnosis {
  const Scenario& scenario;
  PlantAnswers answers;
  std::optional<GainSearch> search{};  ///< if gains were searched for
};

/// Lines for a terminal: every state's response to every input, the problems, and suggested gains.
[[nodiscard]] std::string diagnosis_table(const Diagnosis& diagnosis);

[[nodiscard]] std::string diagnosis_json(const Diagnosis& diagnosis);

}  // namespace qsmpc::harness

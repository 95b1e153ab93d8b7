// What is wrong with how a plant answers, in words and numbers, and gains that would mend it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/doctor/plant_answers.hpp"
#include "harness/scenario/plant_mapping.hpp"
#include "harness/scenario/scenario.hpp"

namespace qsmpc::harness {

enum class AnswerVerdict {
  kAsModel,     ///< as the model's, or too small to matter
  kNone,        ///< the model answers, the plant does not
  kSign,        ///< the other way
  kSize,        ///< smaller than 3/4 or larger than 4/3 of the model's
  kLate,        ///< by more than one and a half periods
  kUnforeseen,  ///< the plant answers, the model does not
  kMismatch,    ///< right in sign and size, but off by more than three deviations of the noise
};

/// A word for it, "ok", "none", "sign", "size", "late", "unforeseen", "mismatch".
[[nodiscard]] const char* verdict_name(AnswerVerdict verdict);

/// What is said of state `state`'s answer. A discrepancy by period matters above the planned
/// noise's deviation, or where no noise is planned. An answer that is missing, has the wrong sign
/// or less than half or more than twice the size is wrong in any case where the model's is above a
/// quarter of the state's scale.
[[nodiscard]] AnswerVerdict verdict_of(const Scenario& scenario, const PlantAnswers& answers,
                                       const InputAnswer& answer, std::size_t state);

/// A sentence without a full stop for everything that is wrong, with numbers.
[[nodiscard]] std::vector<std::string> answer_warnings(const Scenario& scenario,
                                                       const PlantAnswers& answers);

/// The same, of a scenario whose plant is a simulator's, after driving it; none for other plants.
/// Throws InputError where the plant cannot be made.
[[nodiscard]] std::vector<std::string> plant_warnings(const Scenario& scenario);

}  // namespace qsmpc::harness

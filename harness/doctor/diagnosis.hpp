// Diagnoses how a plant responds to its inputs, in words and numbers, and suggests corrected gains.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/doctor/plant_answers.hpp"
#include "harness/scenario/plant_mapping.hpp"
#include "harness/scenario/scenario.hpp"

namespace qsmpc::harness {

enum class AnswerVerdict {
  kAsModel,     ///< as the model's, or the difference is negligible
  kNone,        ///< the model responds, the plant does not
  kSign,        ///< of the opposite sign
  kSize,        ///< smaller than 3/4 or larger than 4/3 of the model's
  kLate,        ///< by more than one and a half periods
  kUnforeseen,  ///< the plant responds, the model does not
  kMismatch,    ///< right in sign and size, but off by more than three deviations of the noise
};

/// The verdict's name: "ok", "none", "sign", "size", "late", "unforeseen" or "mismatch".
[[nodiscard]] const char* verdict_name(AnswerVerdict verdict);

/// The verdict on the response of state `state`. A discrepancy per period matters if it exceeds the
/// standard deviation of the planned noise, or if no noise is planned. A response that is missing,
/// of the wrong sign, or less than half or more than twice the size is always wrong if the model's
/// exceeds a quarter of the state's scale.
[[nodiscard]] AnswerVerdict verdict_of(const Scenario& scenario, const PlantAnswers& answers,
                                       const InputAnswer& answer, std::size_t state);

/// One sentence without a full stop for each problem, with numbers.
[[nodiscard]] std::vector<std::string> answer_warnings(const Scenario& scenario,
                                                       const PlantAnswers& answers);

/// The same for a scenario with a simulated plant, after driving it; none for other plants. Throws
/// InputError where the plant cannot be made.
[[nodiscard]] std::vector<std::string> plant_warnings(const Scenario& scenario);

}  // namespace qsmpc::harness

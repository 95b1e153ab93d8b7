// `predict.json`: the machine-readable result of a prediction. docs/predict.md describes its keys.
#pragma once

#include <string>

#include "harness/prediction/prediction_report.hpp"

namespace qsmpc::harness {

/// One object with stable keys, ending in a newline. Non-finite numbers are null. Equal reports
/// give equal bytes.
[[nodiscard]] std::string prediction_json(const PredictionReport& report);

}  // namespace qsmpc::harness

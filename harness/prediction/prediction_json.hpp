// `predict.json`: what programs read of a prediction. docs/predict.md describes its keys.
#pragma once

#include <string>

#include "harness/prediction/prediction_report.hpp"

namespace qsmpc::harness {

/// One object with stable keys, ending in a new line. Numbers that are not finite are null. Equal
/// reports give equal bytes.
[[nodiscard]] std::string prediction_json(const PredictionReport& report);

}  // namespace qsmpc::harness

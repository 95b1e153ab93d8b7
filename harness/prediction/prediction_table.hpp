// A prediction as a table for a terminal of 80 columns.
#pragma once

#include <string>

#include "harness/prediction/prediction_report.hpp"

namespace qsmpc::harness {

/// One row per stage: nominal position, W2 bound, certificate and its kind, the published value
/// (marked as not a bound), and the simulated rate if there is one; then a row for the whole
/// horizon.
[[nodiscard]] std::string prediction_table(const PredictionReport& report);

}  // namespace qsmpc::harness

// The errors of prediction methods as a table for a terminal of 80 columns.
#pragma once

#include <string>
#include <vector>

#include "harness/prediction/prediction_report.hpp"

namespace qsmpc::harness {

/// For each of `stages` (1 … horizon; empty: the last), one row per method: errors in W2, mean and
/// covariance, its probability of being unsafe, and its time; above them, the errors due to
/// sampling alone and the simulated rate. Empty if the report has no comparison.
[[nodiscard]] std::string law_table(const PredictionReport& report, const std::vector<int>& stages);

}  // namespace qsmpc::harness

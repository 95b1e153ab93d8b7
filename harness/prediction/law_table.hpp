// The errors of methods of prediction as a table for a terminal of 80 columns.
#pragma once

#include <string>
#include <vector>

#include "harness/prediction/prediction_report.hpp"

namespace qsmpc::harness {

/// For each of these stages (1 … horizon; none: the last) one row a method: errors of W2, mean and
/// covariance, the probability of being unsafe that it says, and its time; before them what
/// sampling alone gives and the simulated rate. Empty where the report has no comparison.
[[nodiscard]] std::string law_table(const PredictionReport& report, const std::vector<int>& stages);

}  // namespace qsmpc::harness

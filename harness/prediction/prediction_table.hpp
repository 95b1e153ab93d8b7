// A prediction as a table for a terminal of 80 columns.
#pragma once

#include <string>

#include "harness/prediction/prediction_report.hpp"

namespace qsmpc::harness {

/// One row a stage: nominal position, W2 bound, certificate and which it is, the published value
/// (marked as no bound), and the simulated rate where there is one; then the whole horizon.
[[nodiscard]] std::string prediction_table(const PredictionReport& report);

}  // namespace qsmpc::harness

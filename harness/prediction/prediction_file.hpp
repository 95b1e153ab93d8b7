// The files of a prediction: predict.h5, predict.json and scenario.yaml.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "harness/prediction/prediction_report.hpp"
#include "harness/trace/hdf5_file.hpp"

namespace qsmpc::harness {

inline constexpr const char* kPredictionFile = "predict.h5";
inline constexpr const char* kPredictionNumbersFile = "predict.json";

/// Incremented by every change that an older reader would misread.
inline constexpr std::int64_t kPredictionSchema = 1;

/// The datasets of predict.h5. docs/predict.md describes them.
[[nodiscard]] std::vector<DatasetSpec> prediction_layout(const PredictionReport& report);

/// Writes the three files into the existing folder `folder`. All are fully written before the first
/// gets its final name, and predict.json gets its name last: if it exists, the other two match it.
/// Throws IoError; each file that existed before is then either unchanged or gone.
void write_prediction(const PredictionReport& report, const std::string& folder);

}  // namespace qsmpc::harness

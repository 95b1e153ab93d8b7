// The files that a prediction leaves: predict.h5, predict.json and scenario.yaml.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "harness/prediction/prediction_report.hpp"
#include "harness/trace/hdf5_file.hpp"

namespace qsmpc::harness {

inline constexpr const char* kPredictionFile = "predict.h5";
inline constexpr const char* kPredictionNumbersFile = "predict.json";

/// Grows with every change that an older reader would misread.
inline constexpr std::int64_t kPredictionSchema = 1;

/// The datasets of predict.h5. docs/predict.md describes them.
[[nodiscard]] std::vector<DatasetSpec> prediction_layout(const PredictionReport& report);

/// Writes the three files into `folder`, which exists. All of them are written aside before the
/// first gets its name, and predict.json gets it last: where that is, the other two belong to it.
/// Throws IoError; what stood under the names before is then there still, or is gone as well.
void write_prediction(const PredictionReport& report, const std::string& folder);

}  // namespace qsmpc::harness

// The output files of a comparison: comparison.h5, comparison.json, scenario.yaml, and derived
// files that callers add.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "harness/mismatch/comparison.hpp"
#include "harness/trace/hdf5_file.hpp"

namespace qsmpc::harness {

inline constexpr const char* kComparisonFile = "comparison.h5";
inline constexpr const char* kComparisonNumbersFile = "comparison.json";

/// Incremented with every change that an older reader would misread.
inline constexpr std::int64_t kComparisonSchema = 1;

/// A file of text.
struct TextFile {
  std::string path;
  std::string text;
};

/// The groups of the plants in comparison.h5, in their order: /plants/NAME, where characters of a
/// name other than letters, digits, '_', '-' and '.' are replaced, and a number is appended to
/// avoid duplicates.
[[nodiscard]] std::vector<std::string> plant_groups(const Comparison& comparison);

/// The datasets of comparison.h5, as described in docs/compare.md.
[[nodiscard]] std::vector<DatasetSpec> comparison_layout(const Comparison& comparison);

/// Writes the three files into `folder`, which must exist, and `more` at their own paths. All are
/// written to temporary files before the first is renamed, and comparison.json is renamed last:
/// where it exists, the other files belong to it. Throws IoError; earlier files of the same names
/// are then either unchanged or gone.
void write_comparison(const Comparison& comparison, const std::vector<TextFile>& more,
                      const std::string& folder);

/// The parts of comparison.h5 in `folder` that tables, figures and pages show. Left empty are the
/// plan, all paths and particles, residuals and magnitudes of episodes, fault messages, the
/// measured model error, lags and `lag1_deviation`; certificates contain their values only. Data
/// that a file of an older version lacks (speed, p-values of the closed loop) are not a number, or
/// 0 (`w2_paths`). Throws InputError where the file is damaged, of another schema or not a
/// comparison, and IoError where it cannot be read.
[[nodiscard]] Comparison read_comparison(const std::string& folder);

}  // namespace qsmpc::harness

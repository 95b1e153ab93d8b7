// The files that a comparison leaves: comparison.h5, comparison.json, scenario.yaml, and those that
// others have made of it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "harness/mismatch/comparison.hpp"
#include "harness/trace/hdf5_file.hpp"

namespace qsmpc::harness {

inline constexpr const char* kComparisonFile = "comparison.h5";
inline constexpr const char* kComparisonNumbersFile = "comparison.json";

/// Grows with every change that an older reader would misread.
inline constexpr std::int64_t kComparisonSchema = 1;

/// A file of text.
struct TextFile {
  std::string path;
  std::string text;
};

/// The groups of the plants in comparison.h5, in their order: /plants/NAME, where what a name has
/// besides letters, digits, '_', '-' and '.' is replaced, and a number is added where two would be
/// the same.
[[nodiscard]] std::vector<std::string> plant_groups(const Comparison& comparison);

/// The datasets of comparison.h5. docs/compare.md describes them.
[[nodiscard]] std::vector<DatasetSpec> comparison_layout(const Comparison& comparison);

/// Writes the three files into `folder`, which exists, and `more` at their own paths. All are
/// written aside before the first gets its name, and comparison.json gets it last: where that is,
/// the others belong to it. Throws IoError; what stood under the names before is then there still,
/// or is gone as well.
void write_comparison(const Comparison& comparison, const std::vector<TextFile>& more,
                      const std::string& folder);

/// What comparison.h5 in `folder` says that tables, figures and pages show. Empty are: the plan,
/// all paths and particles, residuals and magnitudes of episodes and the words of faults, the
/// measured model error, lags and `lag1_deviation`; of the certificates there are the values only.
/// What a file of an older version does not say (speed, p-values of the closed loop) is not a
/// number, or 0
/// (`w2_paths`). Throws InputError where the file is damaged, of another schema or something else,
/// IoError where it cannot be read.
[[nodiscard]] Comparison read_comparison(const std::string& folder);

}  // namespace qsmpc::harness

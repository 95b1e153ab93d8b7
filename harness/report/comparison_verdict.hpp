// The verdict of a comparison, shown first.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/mismatch/comparison.hpp"
#include "harness/report/table_page.hpp"

namespace qsmpc::harness {

/// The closed loop's certificates count as exceeded if their p-value is below this.
inline constexpr double kExceededBelow = 0.01;

/// Whether the closed loop of `plant` contradicts its certificates.
[[nodiscard]] bool is_exceeded_in_closed_loop(const PlantComparison& plant);

/// Largest root mean square over the stages of the distance between the paths of `plant` and those
/// of the model, in the norm of the state; infinite if the plant failed on all paths at once.
[[nodiscard]] double largest_divergence(const PlantComparison& plant);

/// Whether everything that `plant` adds to the model in a period is rounding.
[[nodiscard]] bool is_the_model(const PlantComparison& plant);

/// "2, 4 to 7".
[[nodiscard]] std::string stages_text(const std::vector<int>& stages);

/// Not good if a certificate is exceeded, under the plan or in closed loop. The verdict names these
/// plants, and the plant that is farthest from the model.
[[nodiscard]] PageVerdict comparison_verdict(const Comparison& comparison);

/// States that no certificate is a bound, and why; nothing if they are bounds.
[[nodiscard]] std::optional<PageVerdict> no_bound_verdict(const Comparison& comparison);

/// States that drives were unsafe, and on which plants; nothing if all were safe.
[[nodiscard]] std::optional<PageVerdict> unsafe_verdict(const Comparison& comparison);

}  // namespace qsmpc::harness

// What a comparison says first.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/mismatch/comparison.hpp"
#include "harness/report/table_page.hpp"

namespace qsmpc::harness {

/// A p-value of the closed loop's certificates that is taken for "exceeded" when it is below.
inline constexpr double kExceededBelow = 0.01;

/// Whether the closed loop of `plant` speaks against its certificates.
[[nodiscard]] bool is_exceeded_in_closed_loop(const PlantComparison& plant);

/// Largest root mean square over the stages of the distance between the paths of `plant` and those
/// of the model, in the norm of the state; infinite where the plant broke on all paths at once.
[[nodiscard]] double largest_divergence(const PlantComparison& plant);

/// Whether all that `plant` adds to the model in a period is rounding.
[[nodiscard]] bool is_the_model(const PlantComparison& plant);

/// "2, 4 to 7".
[[nodiscard]] std::string stages_text(const std::vector<int>& stages);

/// Not good where a certificate is exceeded, under the plan or in closed loop. It says on which
/// plants, and which plant is farthest from the model.
[[nodiscard]] PageVerdict comparison_verdict(const Comparison& comparison);

/// That no certificate is a bound, and why; none where they are.
[[nodiscard]] std::optional<PageVerdict> no_bound_verdict(const Comparison& comparison);

/// That drives were unsafe, and on which plants; none where all were safe.
[[nodiscard]] std::optional<PageVerdict> unsafe_verdict(const Comparison& comparison);

}  // namespace qsmpc::harness

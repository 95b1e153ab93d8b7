// How much memory a scenario's sizes ask for, estimated before it is asked for.
#pragma once

#include <optional>
#include <string>

#include "harness/scenario/scenario.hpp"

namespace qsmpc::harness {

/// About how much memory (bytes) the controller of `scenario` needs, by horizon and numbers of
/// points or samples. Within a factor of about 4 of what was measured, and made for refusing what
/// is far beyond a machine.
[[nodiscard]] double memory_need(const Scenario& scenario);

/// The memory (bytes) that this process may use: the machine's, or less where the limits of the
/// process (ulimit -v) or of its control group say so.
[[nodiscard]] double usable_memory();

/// What of the usable memory may be asked for.
inline constexpr double kMemoryShare = 0.75;

/// What is wrong, in the words of an error, and what would not be.
struct MemoryProblem {
  std::string found;
  std::string expected;
};

/// Whether `count` drives of `scenario` at the same time need more than kMemoryShare of `usable`
/// bytes; nothing where they do not.
[[nodiscard]] std::optional<MemoryProblem> memory_problem(const Scenario& scenario, int count,
                                                          double usable);

}  // namespace qsmpc::harness

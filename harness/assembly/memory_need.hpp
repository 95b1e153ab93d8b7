// Estimates the memory that a scenario requires, before it is allocated.
#pragma once

#include <optional>
#include <string>

#include "harness/scenario/scenario.hpp"

namespace qsmpc::harness {

/// Approximate memory (bytes) that the controller of `scenario` needs, from the horizon and the
/// numbers of points or samples. Within a factor of about 4 of measurements; meant for rejecting
/// sizes far beyond a machine's memory.
[[nodiscard]] double memory_need(const Scenario& scenario);

/// The memory (bytes) that this process may use: the machine's, or less where the process's limits
/// (ulimit -v) or its control group restrict it.
[[nodiscard]] double usable_memory();

/// The usable share of that memory.
inline constexpr double kMemoryShare = 0.75;

/// The problem in the words of an error, and what would be acceptable.
struct MemoryProblem {
  std::string found;
  std::string expected;
};

/// The problem if `count` simultaneous drives of `scenario` need more than kMemoryShare of `usable`
/// bytes; nothing otherwise.
[[nodiscard]] std::optional<MemoryProblem> memory_problem(const Scenario& scenario, int count,
                                                          double usable);

}  // namespace qsmpc::harness

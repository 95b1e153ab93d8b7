#include "harness/trace/trace.hpp"

#include <array>
#include <stdexcept>
#include <utility>

namespace qsmpc::harness {
namespace {

constexpr std::array<std::pair<Outcome, const char*>, 5> kOutcomeNames = {{
    {Outcome::kReached, "reached"},
    {Outcome::kTimeout, "timeout"},
    {Outcome::kLeftSafeSet, "left_safe_set"},
    {Outcome::kFault, "fault"},
    {Outcome::kInterrupted, "interrupted"},
}};

}  // namespace

const char* outcome_name(Outcome outcome) {
  for (const auto& [value, name] : kOutcomeNames) {
    if (value == outcome) return name;
  }
  throw std::invalid_argument("not an outcome");
}

Outcome outcome_from_name(const std::string& name) {
  for (const auto& [value, known] : kOutcomeNames) {
    if (name == known) return value;
  }
  throw std::invalid_argument(
      "\"" + name + "\" is no outcome: reached, timeout, left_safe_set, fault or interrupted");
}

}  // namespace qsmpc::harness

#include "harness/reproduction/result.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>

#include <fmt/format.h>

#include "harness/threads/workers.hpp"

namespace qsmpc::harness {
namespace {

/// The processor's name in /proc/cpuinfo; "unknown" if it has none.
std::string processor_name() {
  std::ifstream file("/proc/cpuinfo");
  const std::string key = "model name";
  for (std::string line; std::getline(file, line);) {
    if (!line.starts_with(key)) continue;
    const std::size_t start = line.find_first_not_of(" \t", line.find(':') + 1);
    if (start != std::string::npos) return line.substr(start);
  }
  return "unknown";
}

}  // namespace

std::optional<double> ratio_of(const ResultRow& row) {
  if (!row.published || *row.published == 0.0) return std::nullopt;
  const double ratio = row.here / *row.published;
  return std::isfinite(ratio) ? std::optional(ratio) : std::nullopt;
}

Machine this_machine() {
  return {.processor = processor_name(),
          .cores = available_threads(),
#ifdef __clang__
          .compiler = fmt::format("clang {}", __clang_version__)};
#else
          .compiler = fmt::format("gcc {}", __VERSION__)};
#endif
}

}  // namespace qsmpc::harness

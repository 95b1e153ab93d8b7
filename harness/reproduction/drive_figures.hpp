// Drives in closed loop as figures: where they went, what was done, what was certified.
#pragma once

#include <string>
#include <vector>

#include "harness/figures/plane_map.hpp"
#include "harness/figures/svg_chart.hpp"
#include "harness/reproduction/laboratory.hpp"

namespace qsmpc::harness {

/// Drives under the name that a legend gives them.
struct NamedSample {
  std::string name;
  const Sample* sample = nullptr;
};

/// All drives of `sample`, the first of them in full, with its beliefs and where the end of its
/// plans was expected. For a system with a position.
[[nodiscard]] PlaneMap drive_map(const std::string& title, const Sample& sample);

/// What the ellipses on it are.
inline constexpr const char* kMapCaption =
    "Of the first drive, the belief and where the end of the plan was expected, every 12 periods.";

/// Each input of the first drives over time, within its bounds; of the same system.
[[nodiscard]] std::vector<Chart> input_charts(const std::vector<NamedSample>& samples);

/// Each state of the first drives over time.
[[nodiscard]] std::vector<Chart> state_charts(const std::vector<NamedSample>& samples);

/// The expected cost of the first drives' plans over time.
[[nodiscard]] Chart cost_chart(const std::vector<NamedSample>& samples);

/// Probabilities of the unsafe set at the next step, over time, of the first drive: the published
/// way and C1 from the plain and from the compressed measure, and the certificate in force.
[[nodiscard]] Chart risk_chart(const std::string& title, const Sample& sample);

/// The certificate in force of the next step, over time: mean over the drives under way.
[[nodiscard]] Chart certified_chart(const std::vector<NamedSample>& samples);

/// The published probability of the next step, over time: mean over the drives under way.
[[nodiscard]] Chart published_chart(const std::vector<NamedSample>& samples);

}  // namespace qsmpc::harness

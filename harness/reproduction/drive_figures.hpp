// Figures of closed-loop drives: paths, inputs and certificates.
#pragma once

#include <string>
#include <vector>

#include "harness/figures/plane_map.hpp"
#include "harness/figures/svg_chart.hpp"
#include "harness/reproduction/laboratory.hpp"

namespace qsmpc::harness {

/// Drives with their name in a legend.
struct NamedSample {
  std::string name;
  const Sample* sample = nullptr;
};

/// All drives of `sample`. The first is drawn in full, with its beliefs and the expected end of its
/// plans. For a system with a position.
[[nodiscard]] PlaneMap drive_map(const std::string& title, const Sample& sample);

/// Explains the ellipses on that map.
inline constexpr const char* kMapCaption =
    "The first drive: belief and expected end of the plan, every 12 periods.";

/// Each input of the first drives over time, within its bounds. All samples are of the same system.
[[nodiscard]] std::vector<Chart> input_charts(const std::vector<NamedSample>& samples);

/// Each state of the first drives over time.
[[nodiscard]] std::vector<Chart> state_charts(const std::vector<NamedSample>& samples);

/// The expected cost of the first drives' plans over time.
[[nodiscard]] Chart cost_chart(const std::vector<NamedSample>& samples);

/// Probabilities of the unsafe set at the next step over time, for the first drive: the published
/// value and C1, each from the plain and from the compressed measure, and the certificate in force.
[[nodiscard]] Chart risk_chart(const std::string& title, const Sample& sample);

/// The certificate in force of the next step over time: mean over the drives still running.
[[nodiscard]] Chart certified_chart(const std::vector<NamedSample>& samples);

/// The published probability of the next step over time: mean over the drives still running.
[[nodiscard]] Chart published_chart(const std::vector<NamedSample>& samples);

}  // namespace qsmpc::harness

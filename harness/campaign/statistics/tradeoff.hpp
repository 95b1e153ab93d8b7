// Risk against cost: how often the drives of a variant are unsafe, and what those cost that arrive.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "harness/campaign/store/store_reader.hpp"
#include "harness/statistics/binomial_interval.hpp"

namespace qsmpc::harness {

/// The mean of a quantity of drives.
struct DriveMean {
  std::int64_t drives = 0;
  double mean = std::numeric_limits<double>::quiet_NaN();
  RateInterval interval{};  ///< 99 %, by a bootstrap over the seeds; not numbers below two drives
};

struct TradeoffPoint {
  std::size_t variant = 0;  ///< its place among the variants
  /// The cost of the drives that reached the target. A drive that ended before it was there, or ran
  /// out of time, was not charged for the same way: its cost does not compare.
  DriveMean cost{};
  /// The sum of a drive's next-step certificates. Its expectation, which may be above 1, bounds the
  /// probability that a drive is unsafe, where the plant is what the certificates are about: the
  /// model, or within the model error.
  DriveMean certified{};
};

/// Points that a line joins, in its order.
struct TradeoffFamily {
  std::string name;
  std::vector<TradeoffPoint> points{};
};

/// What is drawn together: all families on one scenario and plant.
struct TradeoffPanel {
  std::string scenario;
  std::string plant;  ///< empty: the scenario's own
  std::vector<TradeoffFamily> families{};
};

/// A panel for each scenario and plant, in the order of the variants; none where the campaign has
/// no families. Throws what the store throws.
[[nodiscard]] std::vector<TradeoffPanel> tradeoff_panels(const StoreReader& store);

}  // namespace qsmpc::harness

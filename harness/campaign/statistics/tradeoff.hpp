// Risk against cost: how often drives of a variant are unsafe, and the cost of those that reach the
// target.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "harness/campaign/store/store_reader.hpp"
#include "harness/statistics/binomial_interval.hpp"

namespace qsmpc::harness {

/// The mean of a quantity over drives.
struct DriveMean {
  std::int64_t drives = 0;
  double mean = std::numeric_limits<double>::quiet_NaN();
  RateInterval interval{};  ///< 99 %, by a bootstrap over the seeds; NaN below two drives
};

struct TradeoffPoint {
  std::size_t variant = 0;  ///< its index among the variants
  /// The cost of the drives that reached the target. The cost of a drive that ended earlier or ran
  /// out of time is for another path and not comparable.
  DriveMean cost{};
  /// The sum of a drive's next-step certificates. Its expectation, which may exceed 1, bounds the
  /// probability that a drive is unsafe if the plant is one that the certificates cover: the model,
  /// or within the model error.
  DriveMean certified{};
};

/// Points joined by a line, in its order.
struct TradeoffFamily {
  std::string name;
  std::vector<TradeoffPoint> points{};
};

/// What is plotted together: all families for one scenario and plant.
struct TradeoffPanel {
  std::string scenario;
  std::string plant;  ///< empty: the scenario's own
  std::vector<TradeoffFamily> families{};
};

/// A panel for each scenario and plant, in the order of the variants; none if the campaign has no
/// families. Throws what the store throws.
[[nodiscard]] std::vector<TradeoffPanel> tradeoff_panels(const StoreReader& store);

}  // namespace qsmpc::harness

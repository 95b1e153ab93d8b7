// Streaming tallies of a contest's drives, in one cell or several.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "harness/campaign/statistics/paired_difference.hpp"
#include "harness/campaign/store/episode_row.hpp"
#include "harness/contest/standings.hpp"

namespace qsmpc::harness {

/// Tallies the drives of one controller.
class StandingTally {
 public:
  /// risk_limit: Contest::risk_limit.
  explicit StandingTally(std::optional<double> risk_limit) : risk_limit_(risk_limit) {}

  /// weights: poisson_weights of the row's seed.
  void add(const EpisodeRow& row, const Eigen::ArrayXd& weights);

  /// All but what comes from the timed drives and the comparison with the reference.
  [[nodiscard]] Standing result() const;

 private:
  static constexpr std::size_t kCounted = 8;
  struct SeedCounts {
    std::int64_t drives = 0;
    std::array<std::int64_t, kCounted> events{};
  };
  [[nodiscard]] EpisodeRate rate_of(std::size_t event) const;

  std::optional<double> risk_limit_;
  std::map<std::uint64_t, SeedCounts> seeds_{};
  BootstrapMean believed_{};
  BootstrapMean certified_{};
  BootstrapMean cost_{};
};

/// Compares the drives of a controller and of the reference with the same seed in the same cell.
class VersusTally {
 public:
  /// weights: poisson_weights of their seed; cell: a number that identifies the cell.
  void add(const EpisodeRow& reference, const EpisodeRow& row, std::size_t cell,
           const Eigen::ArrayXd& weights);

  [[nodiscard]] Versus result() const;

 private:
  struct Share {
    BootstrapMean mean{};
    std::map<std::uint64_t, std::int64_t> more{};  ///< excess of drives, by seed
    void add(bool reference, bool own, std::uint64_t seed, const Eigen::ArrayXd& weights);
    [[nodiscard]] ShareDifference result() const;
  };
  /// Sums of costs in the sample and in each bootstrap replicate.
  struct CellCosts {
    double own = 0.0;
    double reference = 0.0;
    Eigen::ArrayXd owns = Eigen::ArrayXd::Zero(kBootstrapReplicates);
    Eigen::ArrayXd references = Eigen::ArrayXd::Zero(kBootstrapReplicates);
  };
  [[nodiscard]] CostDifference cost() const;

  Share reached_{};
  Share unsafe_{};
  BootstrapMean cost_{};
  std::map<std::size_t, CellCosts> costs_{};
};

}  // namespace qsmpc::harness

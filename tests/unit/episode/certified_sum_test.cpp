// What the sum of a drive's next-step certificates says of the drives that become unsafe:
// docs/theory/certificates.md, "Without a budget".
#include <algorithm>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "harness/episode/episode.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "harness/statistics/binomial_interval.hpp"
#include "harness/trace/episode_view.hpp"
#include "harness/trace/summary.hpp"
#include "tests/support/effort.hpp"

namespace qsmpc::harness {
namespace certified_sum_test {

const int kDrives = testing::by_effort(200, 2000, 20000);
constexpr double kTail = 1e-6;  // of each limit below

/// A point that is held beside a wall, at which it may be unsafe in every period.
Scenario beside_a_wall() {
  return load_scenario(
      "double_integrator",
      {"controller.horizon=1", "controller.quantisation.state=10", "limit.steps=12",
       "initial_state={mean: [2.8, 0], covariance: [0.0001, 0.0001]}",
       "target={state: [0, 0], radius: 0.01}"});
}

/// Holds its place for seven periods, then accelerates towards the wall: most of the risk is in the
/// period in which the drive becomes unsafe.
ControllerObject pushing_at_last() {
  return {.name = "pushes", .act = [](const controller::Situation& now) {
            const double place = now.time < 0.65 ? 2.8 : 4.0;
            const double wanted = 30.0 * (place - now.observation[0]) - 9.0 * now.observation[1];
            return ControllerAnswer{
                .input = Eigen::VectorXd::Constant(1, std::clamp(wanted, -2.0, 2.0))};
          }};
}

struct UnsafeDrive {
  double sum = 0.0;      ///< of its certificates
  double earlier = 0.0;  ///< without that of the period in which it became unsafe
};

std::vector<UnsafeDrive> unsafe_drives() {
  const Scenario scenario = beside_a_wall();
  std::vector<UnsafeDrive> drives;
  for (int seed = 0; seed < kDrives; ++seed) {
    const Trace trace =
        run_episode(scenario, {.seed = static_cast<std::uint64_t>(seed)}, pushing_at_last());
    if (trace.outcome != Outcome::kLeftBounds) continue;
    const double sum = summarise(EpisodeView(trace)).next_step_sum;
    drives.push_back({sum, sum - trace.steps.back().certificates.front().value});
  }
  return drives;
}

double lower_limit(const std::vector<UnsafeDrive>& drives, double UnsafeDrive::*sum, double limit) {
  const auto within =
      std::ranges::count_if(drives, [&](const UnsafeDrive& one) { return one.*sum <= limit; });
  return clopper_pearson(within, kDrives, kTail).lower;
}

TEST(CertifiedSum, bounds_the_share_of_drives_that_become_unsafe_within_it) {
  const std::vector<UnsafeDrive> drives = unsafe_drives();
  EXPECT_GT(drives.size(), static_cast<std::size_t>(kDrives) / 4);
  bool needs_the_last = false;
  for (const double limit : {0.01, 0.03, 0.1, 0.2, 0.3, 0.5, 0.7}) {
    EXPECT_LE(lower_limit(drives, &UnsafeDrive::sum, limit), limit);
    needs_the_last |= lower_limit(drives, &UnsafeDrive::earlier, limit) > limit;
  }
  EXPECT_TRUE(needs_the_last) << "the period in which a drive becomes unsafe has to count";
}

}  // namespace certified_sum_test
}  // namespace qsmpc::harness

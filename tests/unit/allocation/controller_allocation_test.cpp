// After warm-up no controller of the table allocates in a decision, as long as it certifies
// nothing; the shield certifies in every period.
#include <cmath>

#include <gtest/gtest.h>

#include "controller/control/controller.hpp"
#include "tests/unit/allocation/allocation_problem.hpp"
#include "tests/unit/allocation/allocations.hpp"

namespace qsmpc::controller {
namespace controller_allocation_test {

using namespace testing;

TEST(ControllerAllocations, none_after_a_rehearsal_along_the_path) {
  constexpr int kRehearsal = 12;
  constexpr int kPeriods = 12;
  for (const ControllerEntry& entry : controllers()) {
    if (entry.name == "shield") continue;
    for (const LqrAbout about : {LqrAbout::kPath, LqrAbout::kTarget}) {
      for (const char* system : {"dubins", "bicycle"}) {
        SCOPED_TRACE(entry.name + (about == LqrAbout::kPath ? " path " : " target ") + system);
        const auto dynamics = models::make_dynamics(system, {}, 0.1);
        ControllerSettings settings;
        settings.problem = settings_of({.system = system, .closed_loop = true}, *dynamics);
        settings.lqr_about = about;
        const auto controller = entry.make(*dynamics, settings);
        Gaussian belief = belief_of(*dynamics);
        models::StateBatch state = belief.mean;
        Eigen::VectorXd observation(state.rows());
        models::StateBatch next(state.rows(), 1);
        models::StateBatch input(dynamics->input_dim(), 1);
        for (int n = 0; n < kRehearsal + kPeriods; ++n) {
          observation = state.col(0);
          observation[1] += 0.05 * std::sin(2.0 * n);
          const Situation situation{.period = n, .belief = belief, .observation = observation};
          const AllocationCount allocations;
          const Decision& decision = controller->decide(situation);
          const std::size_t count = allocations.count();
          if (n >= kRehearsal) {
            EXPECT_EQ(count, 0U) << "period " << n;
          }
          ASSERT_TRUE(decision.input.allFinite());
          input = decision.input;
          dynamics->step(state, input, next);
          state = next;
          belief.mean = state.col(0);
        }
      }
    }
  }
}

}  // namespace controller_allocation_test
}  // namespace qsmpc::controller

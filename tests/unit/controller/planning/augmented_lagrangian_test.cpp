// The multipliers of the augmented Lagrangian from one plan to the next.
#include "controller/planning/solvers/augmented_lagrangian.hpp"

#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "controller/planning/risk/risk_constraint.hpp"
#include "models/constants.hpp"
#include "tests/unit/controller/planning/planner_fixture.hpp"

namespace qsmpc::controller {
namespace augmented_lagrangian_test {

using namespace testing;

using Eigen::VectorXd;

/// z ≤ 0, entry by entry.
class BelowZero final : public SummedConstraints {
 public:
  explicit BelowZero(Eigen::Index count) : count_(count) {}
  [[nodiscard]] Eigen::Index count() const override { return count_; }
  const VectorXd& values(const VectorXd& z) override { return values_ = z; }
  void add_gradient(const VectorXd& multipliers, VectorXd& gradient) override {
    gradient += multipliers;
  }

 private:
  Eigen::Index count_;
  VectorXd values_;
};

/// The multipliers: the gradient where every constraint is zero.
VectorXd multipliers_of(AugmentedLagrangian& lagrangian, Eigen::Index count) {
  VectorXd gradient = VectorXd::Zero(count);
  lagrangian.add(VectorXd::Zero(count), gradient);
  return gradient;
}

class Multipliers : public ::testing::Test {
 protected:
  /// Multipliers proportional to `violations`.
  void make(const VectorXd& violations) {
    lagrangian.start(constraint, 50.0, /*warm=*/false);
    (void)lagrangian.update(violations, 0.01);
    made = multipliers_of(lagrangian, violations.size());
    ASSERT_TRUE(made.isApprox(made[0] / violations[0] * violations));
    ASSERT_GT(made[0], 0.0);
  }
  VectorXd after(const StageRows& rows) {
    lagrangian.shift(rows);
    lagrangian.start(constraint, 50.0, /*warm=*/true);
    return multipliers_of(lagrangian, made.size());
  }

  BelowZero constraint{5};
  AugmentedLagrangian lagrangian;
  VectorXd made;
};

TEST_F(Multipliers, of_stages_move_up_and_all_others_stay) {
  make(VectorXd{{1.0, 2.0, 3.0, 5.0, 7.0}});
  EXPECT_EQ(after({.begin = 1, .count = 3}),
            (VectorXd{{made[0], made[2], made[3], made[3], made[4]}}));
}

TEST_F(Multipliers, move_up_by_all_constraints_of_a_stage) {
  make(VectorXd{{1.0, 2.0, 3.0, 5.0, 7.0}});
  EXPECT_EQ(after({.begin = 0, .count = 4, .of_stage = 2}),
            (VectorXd{{made[2], made[3], made[2], made[3], made[4]}}));
}

TEST_F(Multipliers, stay_where_no_constraint_is_of_a_stage_or_there_are_more_than_multipliers) {
  make(VectorXd{{1.0, 2.0, 3.0, 5.0, 7.0}});
  EXPECT_EQ(after({}), made);
  EXPECT_EQ(after({.begin = 1, .count = 8}), made);
}

TEST_F(Multipliers, are_exhausted_at_ten_times_the_cost_where_nothing_keeps_the_constraints) {
  const VectorXd violations = VectorXd{{-1.0, 1.0, 0.5, 0.0, -2.0}};
  lagrangian.start(constraint, 50.0, /*warm=*/false);
  int updates = 0;
  while (lagrangian.update(violations, 0.01)) {
    ASSERT_LT(++updates, 20);
    EXPECT_LE(multipliers_of(lagrangian, 5).maxCoeff(), 500.0);
  }
  EXPECT_TRUE(lagrangian.exhausted());
  EXPECT_GT(updates, 2);
  // The next plan may be able to keep them.
  lagrangian.start(constraint, 100.0, /*warm=*/true);
  EXPECT_FALSE(lagrangian.exhausted());
  EXPECT_TRUE(lagrangian.update(violations, 0.01));
}

TEST(RiskConstraint, its_stage_rows_are_those_of_the_limit_of_every_stage) {
  const auto car = dubins_car();
  const PlannerSettings settings = block_settings();
  RiskConstraint constraint(*car, settings);
  for (const double first : {kInfinity, 0.1}) {
    for (const double stage : {kInfinity, 0.2}) {
      for (const double plan : {kInfinity, 0.3}) {
        constraint.set_limits({.first = first, .stage = stage, .plan = plan}, 0);
        const StageRows rows = constraint.stage_rows();
        EXPECT_EQ(rows.of_stage, 1);
        EXPECT_EQ(rows.count, stage < 1.0 ? settings.horizon : 0);
        EXPECT_EQ(rows.begin, first < 1.0 ? 1 : 0);
        EXPECT_EQ(rows.begin + rows.count + (plan < 1.0 ? 1 : 0), constraint.count());
      }
    }
  }
}

}  // namespace augmented_lagrangian_test
}  // namespace qsmpc::controller

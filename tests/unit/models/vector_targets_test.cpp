// The batch loops give the same bits on every instruction set, for whole vectors and remainders.
#include "tests/support/vector_targets.hpp"

#include <memory>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "tests/unit/models/dynamics_fixture.hpp"

namespace qsmpc::models {
namespace models_vector_targets_test {

using namespace testing;

struct Answers {
  StateBatch next;
  StateBatch state_adjoint;
  StateBatch input_adjoint;
};

Answers answers_of(const Dynamics& dynamics, const StateBatch& states, const StateBatch& inputs,
                   const StateBatch& adjoint) {
  const double unset = std::nan("");
  Answers answers{.next = StateBatch::Constant(states.rows(), states.cols(), unset),
                  .state_adjoint = StateBatch::Constant(states.rows(), states.cols(), unset),
                  .input_adjoint = StateBatch::Constant(inputs.rows(), inputs.cols(), unset)};
  dynamics.step(states, inputs, answers.next);
  dynamics.pullback(states, inputs, adjoint, answers.state_adjoint, answers.input_adjoint);
  return answers;
}

TEST(VectorTargets, there_is_more_than_one_to_compare) { EXPECT_GE(vector_targets().size(), 2U); }

class EverySystemOnEveryTarget : public EverySystem {};

TEST_P(EverySystemOnEveryTarget, step_and_pullback_are_equal_bit_for_bit) {
  for (const Eigen::Index count : {1, 2, 3, 4, 5, 7, 8, 9, 15, 16, 17, 100, 1023}) {
    StateBatch particles = states(count);
    // Some headings are reduced by the standard library.
    if (count > 2 && particles.rows() > 2) particles(2, count / 2) = 3e7;
    const StateBatch actions = inputs(count);
    const StateBatch adjoint = random_batch(generator_, particles.rows(), count, 1.0);
    const Answers best = answers_of(dynamics(), particles, actions, adjoint);
    ASSERT_TRUE(best.next.allFinite() && best.state_adjoint.allFinite() &&
                best.input_adjoint.allFinite());
    for (const std::int64_t target : vector_targets()) {
      const OnTarget only(target);
      const Answers here = answers_of(dynamics(), particles, actions, adjoint);
      EXPECT_EQ(here.next, best.next) << hwy::TargetName(target) << ", " << count;
      EXPECT_EQ(here.state_adjoint, best.state_adjoint) << hwy::TargetName(target);
      EXPECT_EQ(here.input_adjoint, best.input_adjoint) << hwy::TargetName(target);
    }
  }
}

TEST_P(EverySystemOnEveryTarget, a_particle_does_not_depend_on_the_others) {
  const StateBatch particles = states(37);
  const StateBatch actions = inputs(37);
  const StateBatch adjoint = random_batch(generator_, particles.rows(), 37, 1.0);
  const Answers together = answers_of(dynamics(), particles, actions, adjoint);
  for (Eigen::Index i = 0; i < 37; ++i) {
    const Answers alone = answers_of(dynamics(), particles.col(i), actions.col(i), adjoint.col(i));
    EXPECT_EQ(alone.next.col(0), together.next.col(i));
    EXPECT_EQ(alone.state_adjoint.col(0), together.state_adjoint.col(i));
    EXPECT_EQ(alone.input_adjoint.col(0), together.input_adjoint.col(i));
  }
}

TEST_P(EverySystemOnEveryTarget, columns_of_larger_batches_are_read_and_written_alone) {
  const StateBatch particles = states(40);
  const StateBatch actions = inputs(40);
  const StateBatch whole = step(particles, actions);
  for (const std::int64_t target : vector_targets()) {
    const OnTarget only(target);
    StateBatch next = StateBatch::Constant(particles.rows(), 40, 0.25);
    dynamics().step(particles.middleCols(5, 13), actions.middleCols(5, 13), next.middleCols(5, 13));
    EXPECT_EQ(next.middleCols(5, 13), whole.middleCols(5, 13)) << hwy::TargetName(target);
    EXPECT_TRUE((next.leftCols(5).array() == 0.25).all()) << hwy::TargetName(target);
    EXPECT_TRUE((next.rightCols(22).array() == 0.25).all()) << hwy::TargetName(target);
  }
}

INSTANTIATE_TEST_SUITE_P(systems, EverySystemOnEveryTarget, ::testing::ValuesIn(system_names()));

}  // namespace models_vector_targets_test
}  // namespace qsmpc::models

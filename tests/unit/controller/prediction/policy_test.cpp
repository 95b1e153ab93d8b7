#include "controller/prediction/policy.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "models/linear_algebra.hpp"
#include "tests/unit/controller/measure/random_measures.hpp"
#include "tests/unit/controller/planning/planner_fixture.hpp"

namespace qsmpc::controller {
namespace policy_test {

using namespace testing;

/// x⁺ = Ax + Bu, for which the linear-quadratic regulator is exact.
class LinearSystem final : public models::Dynamics {
 public:
  LinearSystem(Eigen::MatrixXd a, Eigen::MatrixXd b) : a_(std::move(a)), b_(std::move(b)) {
    description_.states.resize(a_.rows());
    description_.inputs.resize(b_.cols());
  }
  [[nodiscard]] const models::SystemDescription& description() const override {
    return description_;
  }
  void step(const BatchView& states, const BatchView& inputs, BatchOut next) const override {
    next = a_ * states + b_ * inputs;
  }
  void pullback(const BatchView& /*states*/, const BatchView& /*inputs*/,
                const BatchView& next_adjoint, BatchOut state_adjoint,
                BatchOut input_adjoint) const override {
    state_adjoint = a_.transpose() * next_adjoint;
    input_adjoint = b_.transpose() * next_adjoint;
  }
  void jacobians(const Eigen::Ref<const Eigen::VectorXd>&, const Eigen::Ref<const Eigen::VectorXd>&,
                 Eigen::Ref<Eigen::MatrixXd> state_jacobian,
                 Eigen::Ref<Eigen::MatrixXd> input_jacobian) const override {
    state_jacobian = a_;
    input_jacobian = b_;
  }
  [[nodiscard]] double lipschitz(const Eigen::Ref<const Eigen::MatrixXd>& gain) const override {
    return a_.norm() + b_.norm() * gain.norm();
  }

 private:
  Eigen::MatrixXd a_;
  Eigen::MatrixXd b_;
  models::SystemDescription description_;
};

struct LinearProblem {
  Eigen::MatrixXd a;
  Eigen::MatrixXd b;
  LqrWeights weights;
  int horizon = 0;

  [[nodiscard]] std::vector<Eigen::MatrixXd> gains() const {
    const LinearSystem system(a, b);
    return lqr_gains(system, Eigen::MatrixXd::Zero(a.rows(), horizon + 1),
                     Eigen::MatrixXd::Zero(b.cols(), horizon), weights);
  }
  /// ½ΣxᵀQx + ½uᵀRu + ½xᵀPx under these gains from `state`.
  [[nodiscard]] double cost(const std::vector<Eigen::MatrixXd>& gains,
                            Eigen::VectorXd state) const {
    double sum = 0.0;
    for (const Eigen::MatrixXd& gain : gains) {
      const Eigen::VectorXd input = gain * state;
      sum += 0.5 * state.dot(weights.state * state) + 0.5 * input.dot(weights.input * input);
      state = a * state + b * input;
    }
    return sum + 0.5 * state.dot(weights.terminal * state);
  }
};

LinearProblem random_linear_problem(Generator& generator, int horizon) {
  return {.a = random_matrix(generator, 4, 4),
          .b = random_matrix(generator, 4, 2),
          .weights = {.state = random_spd(generator, 4),
                      .input = random_spd(generator, 2),
                      .terminal = random_spd(generator, 4)},
          .horizon = horizon};
}

TEST(LqrGains, reach_the_steady_state_of_the_riccati_equation) {
  // The scalar system x⁺ = x + u with Q = R = 1: P = (1 + √5)/2 and K = −P/(1 + P).
  const LinearProblem scalar{.a = Eigen::MatrixXd::Ones(1, 1),
                             .b = Eigen::MatrixXd::Ones(1, 1),
                             .weights = {.state = Eigen::MatrixXd::Ones(1, 1),
                                         .input = Eigen::MatrixXd::Ones(1, 1),
                                         .terminal = Eigen::MatrixXd::Zero(1, 1)},
                             .horizon = 60};
  const double value = 0.5 * (1.0 + std::sqrt(5.0));
  // The recursion contracts by 0.15 per stage: after sixty stages only rounding is left.
  EXPECT_NEAR(scalar.gains()[0](0, 0), -value / (1.0 + value), 1e-14);
}

TEST(LqrGains, no_perturbed_gain_costs_less) {
  Generator generator(101);
  for (int repetition = 0; repetition < 20; ++repetition) {
    const LinearProblem problem = random_linear_problem(generator, 6);
    const std::vector<Eigen::MatrixXd> gains = problem.gains();
    const Eigen::VectorXd start = random_matrix(generator, 4, 1);
    const double least = problem.cost(gains, start);
    for (int trial = 0; trial < 20; ++trial) {
      std::vector<Eigen::MatrixXd> perturbed = gains;
      perturbed[trial % 6] += random_matrix(generator, 2, 4, trial < 10 ? 0.1 : 0.001);
      EXPECT_GE(problem.cost(perturbed, start), least * (1.0 - 1e-12));  // rounding
    }
  }
}

TEST(LqrGains, reach_the_minimum_of_the_quadratic_programme) {
  // Without noise, the feedback gives the minimiser of the stacked inputs, found by a linear solve.
  Generator generator(102);
  const LinearProblem problem = random_linear_problem(generator, 5);
  const Eigen::VectorXd start = random_matrix(generator, 4, 1);
  const auto cost_of = [&](const Eigen::VectorXd& stacked) {
    Eigen::VectorXd state = start;
    double sum = 0.0;
    for (int k = 0; k < 5; ++k) {
      const Eigen::VectorXd input = stacked.segment(2 * k, 2);
      sum += 0.5 * state.dot(problem.weights.state * state) +
             0.5 * input.dot(problem.weights.input * input);
      state = problem.a * state + problem.b * input;
    }
    return sum + 0.5 * state.dot(problem.weights.terminal * state);
  };
  // A quadratic function is determined by its values: H_ij and g_i by exact second differences.
  const double at_zero = cost_of(Eigen::VectorXd::Zero(10));
  const auto unit = [](int i) { return Eigen::VectorXd(Eigen::VectorXd::Unit(10, i)); };
  Eigen::MatrixXd hessian(10, 10);
  Eigen::VectorXd gradient(10);
  for (int i = 0; i < 10; ++i) {
    gradient[i] = 0.5 * (cost_of(unit(i)) - cost_of(-unit(i)));
    for (int j = 0; j < 10; ++j) {
      hessian(i, j) = cost_of(unit(i) + unit(j)) - cost_of(unit(i)) - cost_of(unit(j)) + at_zero;
    }
  }
  const double least = cost_of(-models::solve_symmetric(hessian, gradient));
  EXPECT_NEAR(problem.cost(problem.gains(), start), least, 1e-10 * least);  // rounding of the solve
}

TEST(Policy, inputs_of_a_batch_equal_the_input_of_each_column) {
  Generator generator(103);
  for (const double gain : {0.0, 0.5, 5.0}) {
    Policy policy{
        .inputs = random_matrix(generator, 2, 4),
        .states = random_matrix(generator, 3, 5),
        .gains = std::vector<Eigen::MatrixXd>(4, random_matrix(generator, 2, 3, gain)),
        .bounds = {.lower = Eigen::Vector2d(-1.0, -1.5), .upper = Eigen::Vector2d(1.0, 0.5)}};
    policy.inputs = policy.inputs.cwiseMin(0.5);
    const Points states = random_matrix(generator, 3, 50, 2.0);
    Points inputs = Points::Constant(2, 50, std::nan(""));
    for (Eigen::Index k = 0; k < 4; ++k) {
      policy_inputs(policy, k, states, inputs);
      for (Eigen::Index i = 0; i < states.cols(); ++i) {
        const Eigen::VectorXd single = policy_input(policy, k, states.col(i));
        // K (x − x̄) compared with Kx − Kx̄, for numbers up to thirty.
        EXPECT_LE((inputs.col(i) - single).norm(), 1e-14 * 30.0);
        EXPECT_TRUE((single.array() >= policy.bounds.lower.array()).all());
        EXPECT_TRUE((single.array() <= policy.bounds.upper.array()).all());
      }
    }
  }
}

TEST(Policy, nominal_states_follow_the_noise_free_steps) {
  const auto car = dubins_car();
  const Eigen::MatrixXd inputs = Eigen::RowVector3d(0.5, -0.2, 1.0);
  const Eigen::MatrixXd states = nominal_states(*car, Eigen::Vector3d(1.0, 2.0, 0.3), inputs);
  ASSERT_EQ(states.cols(), 4);
  EXPECT_EQ(states.col(0), Eigen::Vector3d(1.0, 2.0, 0.3));
  for (Eigen::Index k = 0; k < 3; ++k) {
    EXPECT_NEAR(states(0, k + 1), states(0, k) + 0.15 * std::cos(states(2, k)), 1e-14);
    EXPECT_NEAR(states(1, k + 1), states(1, k) + 0.15 * std::sin(states(2, k)), 1e-14);
    EXPECT_NEAR(states(2, k + 1), states(2, k) + 0.1 * inputs(0, k), 1e-14);
  }
}

}  // namespace policy_test
}  // namespace qsmpc::controller

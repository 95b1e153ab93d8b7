// Derivatives of single particles, and of the cost by a common gain change, against differences.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/unit/controller/measure/reference_cases.hpp"

namespace qsmpc::controller {
namespace particle_gradient_test {

using namespace testing;

// Central differences: truncation h² times third derivatives, rounding ε/h times values.
constexpr double kStep = 1e-6;
constexpr double kTolerance = 1e-6;
// Inputs closer to a bound than this may be clamped on one side of a difference only.
constexpr double kClampMargin = 1e-4;

struct Setting {
  bool closed_loop = false;
  bool noise = false;
  bool with_gain = false;
  std::string system;
};

std::vector<Setting> settings() {
  std::vector<Setting> all;
  for (const char* system : {"dubins", "bicycle"}) {
    for (const bool noise : {false, true}) {
      all.push_back({false, noise, false, system});
      all.push_back({true, noise, false, system});
      all.push_back({true, noise, true, system});
    }
  }
  return all;
}

/// The problem, its cost, and a decision vector at which no clamp is about to change.
class Held {
 public:
  explicit Held(const Setting& setting)
      : problem_({.system = setting.system,
                  .closed_loop = setting.closed_loop,
                  .noise = setting.noise,
                  .points = 12,
                  .compressed = 9}),
        prediction_(problem_.predict()),
        cost_(problem_.terms(), prediction_, problem_.policy()) {
    const Eigen::Index inputs = problem_.policy().inputs.size();
    const Eigen::Index gains = setting.with_gain ? problem_.policy().gains[0].size() : 0;
    Generator generator(55);
    do {
      z_ = random_matrix(generator, inputs + gains, 1, 0.1);
      z_.head(inputs) += problem_.policy().inputs.reshaped();
      cost_.rollout(z_);
    } while (setting.closed_loop && nearest_clamp() < kClampMargin);
  }

  [[nodiscard]] HorizonCost& cost() { return cost_; }
  [[nodiscard]] const Eigen::VectorXd& z() const { return z_; }
  [[nodiscard]] const Policy& policy() const { return problem_.policy(); }
  [[nodiscard]] int saturated() const { return saturated_; }

 private:
  [[nodiscard]] double nearest_clamp() {
    const Policy& held = problem_.policy();
    const Eigen::Index rows = held.inputs.rows();
    const Eigen::MatrixXd inputs = z_.head(held.inputs.size()).reshaped(rows, held.horizon());
    const Eigen::MatrixXd states = nominal_states(problem_.dynamics(), held.states.col(0), inputs);
    double nearest = 1e300;
    saturated_ = 0;
    for (Eigen::Index k = 0; k < held.horizon(); ++k) {
      Eigen::MatrixXd gain = held.gains[k];
      if (z_.size() > held.inputs.size()) {
        gain += z_.tail(gain.size()).reshaped(rows, gain.cols());
      }
      const Points& particles = cost_.particles(k);
      for (Eigen::Index i = 0; i < particles.cols(); ++i) {
        const Eigen::VectorXd wanted = inputs.col(k) + gain * (particles.col(i) - states.col(k));
        const double room = std::min((wanted - held.bounds.lower).minCoeff(),
                                     (held.bounds.upper - wanted).minCoeff());
        nearest = std::min({nearest, (wanted - held.bounds.lower).cwiseAbs().minCoeff(),
                            (held.bounds.upper - wanted).cwiseAbs().minCoeff()});
        saturated_ += room < 0.0 ? 1 : 0;
      }
    }
    return nearest;
  }

  ReferenceProblem problem_;
  Prediction prediction_;
  HorizonCost cost_;
  Eigen::VectorXd z_;
  int saturated_ = 0;
};

/// The slope of coordinate `axis` of one particle.
StageSlope slope_of(const Held& held, Eigen::Index particle, Eigen::Index axis) {
  StageSlope slope{.particles = {particle},
                   .by_particle = Eigen::MatrixXd::Zero(held.policy().states.rows(), 1)};
  slope.by_particle(axis, 0) = 1.0;
  return slope;
}

TEST(ParticleGradient, equals_central_differences) {
  for (const Setting& setting : settings()) {
    Held held(setting);
    SCOPED_TRACE(setting.system + (setting.closed_loop ? ", closed" : ", open") +
                 (setting.noise ? ", mixture" : ", noise-free") +
                 (setting.with_gain ? ", gain" : ""));
    EXPECT_EQ(held.saturated() > 0, setting.closed_loop);
    HorizonCost& cost = held.cost();
    Eigen::VectorXd gradient = Eigen::VectorXd::Constant(held.z().size(), std::nan(""));
    for (const Eigen::Index stage : {1, 2, 4}) {
      for (const Eigen::Index particle : {0, 4, 8}) {
        for (Eigen::Index axis = 0; axis < held.policy().states.rows(); ++axis) {
          cost.rollout(held.z());
          cost.pull_back(stage, slope_of(held, particle, axis), gradient);
          for (Eigen::Index j = 0; j < held.z().size(); ++j) {
            Eigen::VectorXd moved = held.z();
            moved[j] = held.z()[j] + kStep;
            cost.rollout(moved);
            const double high = cost.particles(stage)(axis, particle);
            moved[j] = held.z()[j] - kStep;
            cost.rollout(moved);
            const double slope = (high - cost.particles(stage)(axis, particle)) / (2.0 * kStep);
            EXPECT_NEAR(gradient[j], slope, kTolerance * std::max(1.0, std::abs(slope)))
                << "stage " << stage << ", particle " << particle << ", axis " << axis << ", entry "
                << j;
          }
        }
      }
    }
  }
}

TEST(ParticleGradient, of_several_particles_is_the_sum) {
  for (const Setting& setting : settings()) {
    Held held(setting);
    HorizonCost& cost = held.cost();
    cost.rollout(held.z());
    const Eigen::Index dim = held.policy().states.rows();
    Eigen::VectorXd together(held.z().size());
    Eigen::VectorXd one(held.z().size());
    StageSlope slope{.particles = {1, 3, 6}, .by_particle = Eigen::MatrixXd::Random(dim, 3)};
    cost.pull_back(3, slope, together);
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(held.z().size());
    for (int i = 0; i < 3; ++i) {
      cost.pull_back(
          3, {.particles = {slope.particles[i]}, .by_particle = slope.by_particle.col(i)}, one);
      sum += one;
    }
    EXPECT_LT((together - sum).norm(), kTolerance * (1.0 + sum.norm())) << setting.system;
  }
}

TEST(ParticleGradient, leaves_cost_and_gradient_as_they_were) {
  for (const Setting& setting : settings()) {
    Held held(setting);
    HorizonCost& cost = held.cost();
    Eigen::VectorXd before(held.z().size());
    Eigen::VectorXd after(held.z().size());
    Eigen::VectorXd unused(held.z().size());
    const double value = cost.evaluate(held.z(), before);
    cost.pull_back(3, slope_of(held, 2, 0), unused);
    EXPECT_EQ(cost.evaluate(held.z()), value);
    cost.pull_back(1, slope_of(held, 2, 1), unused);
    EXPECT_EQ(cost.evaluate(held.z(), after), value);
    EXPECT_EQ(before, after);
  }
}

TEST(HorizonCostByGain, gradient_equals_central_differences) {
  for (const Setting& setting : settings()) {
    Held held(setting);
    HorizonCost& cost = held.cost();
    Eigen::VectorXd gradient(held.z().size());
    const double value = cost.evaluate(held.z(), gradient);
    for (Eigen::Index j = 0; j < held.z().size(); ++j) {
      Eigen::VectorXd moved = held.z();
      moved[j] = held.z()[j] + kStep;
      const double high = cost.evaluate(moved);
      moved[j] = held.z()[j] - kStep;
      const double slope = (high - cost.evaluate(moved)) / (2.0 * kStep);
      EXPECT_NEAR(gradient[j], slope, kTolerance * (std::abs(slope) + std::abs(value)))
          << setting.system << setting.noise << setting.with_gain << ", entry " << j;
    }
  }
}

}  // namespace particle_gradient_test
}  // namespace qsmpc::controller

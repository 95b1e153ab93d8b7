// Plans of every system with everything that their motions refer to, and pairs of simulated states
// and surrogates, for tests of the Gaussian surrogate.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Eigenvalues>

#include "controller/certification/affine_surrogate.hpp"
#include "tests/unit/controller/measure/random_measures.hpp"
#include "tests/unit/controller/planning/planner_fixture.hpp"

namespace qsmpc::testing {

constexpr int kSamples = 10000;

/// A prescribed plan with everything that its motion refers to.
struct Case {
  std::string name;
  std::shared_ptr<const models::Dynamics> dynamics;
  controller::Gaussian belief;
  controller::PlannerSettings settings;
  std::shared_ptr<controller::Planner> planner;
  controller::Plan plan;

  [[nodiscard]] controller::PredictedMotion motion() const {
    return controller::motion_of(*planner, belief, plan);
  }
};

/// The feedback of a case's inputs: none, LQR, or this gain.
struct Feedback {
  bool closed_loop = false;
  std::optional<Eigen::MatrixXd> gain = std::nullopt;
};

inline Case make_case(const std::string& name, std::shared_ptr<const models::Dynamics> dynamics,
                      const controller::Gaussian& belief, const Eigen::MatrixXd& noise,
                      const Eigen::VectorXd& input, const Feedback& feedback, int horizon = 8) {
  const int dim = dynamics->state_dim();
  controller::PlannerSettings settings;
  settings.horizon = horizon;
  settings.closed_loop = feedback.closed_loop;
  settings.feedback_gain = feedback.gain;
  settings.state_points = 8;  // the surrogates do not depend on the particles
  settings.noise_points = 4;
  settings.compressed_points = 8;
  settings.noise_covariance = noise;
  settings.cost = {.state = Eigen::MatrixXd::Identity(dim, dim),
                   .input = 0.1 * Eigen::MatrixXd::Identity(input.size(), input.size()),
                   .terminal = Eigen::MatrixXd::Identity(dim, dim),
                   .target = Eigen::VectorXd::Zero(dim)};
  settings.safe_set = controller::unbounded_safe_set(dim);
  settings.bounds = {.lower = dynamics->description().input_lower,
                     .upper = dynamics->description().input_upper};
  Case result{.name = name,
              .dynamics = dynamics,
              .belief = belief,
              .settings = settings,
              .planner = std::make_shared<controller::Planner>(*dynamics, settings),
              .plan = {}};
  result.plan = result.planner->prescribe(belief, input.replicate(1, horizon));
  return result;
}

inline controller::Gaussian around(const Eigen::VectorXd& mean, const Eigen::VectorXd& deviation) {
  return {.mean = mean, .covariance = deviation.cwiseAbs2().asDiagonal()};
}

inline Case dubins(const Feedback& feedback, double input = 0.3, double width = 0.1) {
  return make_case("dubins", dubins_car(),
                   around(Eigen::Vector3d::Zero(), Eigen::Vector3d::Constant(width)),
                   Eigen::Vector3d(0.01, 0.01, 0.001).asDiagonal(),
                   Eigen::VectorXd::Constant(1, input), feedback);
}

/// All coordinates correlated.
inline Case skewed_dubins(const Feedback& feedback, Generator& generator) {
  return make_case(
      "skewed dubins", dubins_car(),
      {.mean = Eigen::Vector3d(1.0, 2.0, 0.7), .covariance = random_spd(generator, 3, 0.02)},
      random_spd(generator, 3, 0.01), Eigen::VectorXd::Constant(1, 0.4), feedback);
}

inline Case double_integrator(const Feedback& feedback, double input = 0.5, double width = 0.1) {
  return make_case("double integrator", models::make_dynamics("double_integrator", {}, 0.1),
                   around(Eigen::Vector2d(1.0, 0.2), Eigen::Vector2d(width, width)),
                   Eigen::Vector2d(1e-4, 1e-3).asDiagonal(), Eigen::VectorXd::Constant(1, input),
                   feedback);
}

inline Case bicycle(const Feedback& feedback, double speed = 10.0, double width = 1.0) {
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(6);
  mean[3] = speed;
  Eigen::VectorXd deviation(6);
  deviation << 0.1, 0.1, 0.03, 0.2, 0.1, 0.05;
  Eigen::VectorXd noise(6);
  noise << 0.03, 0.03, 0.01, 0.05, 0.03, 0.02;
  return make_case("bicycle", models::make_dynamics("bicycle", {}, 0.1),
                   around(mean, width * deviation), noise.cwiseAbs2().asDiagonal(),
                   Eigen::Vector2d(0.2, 0.03), feedback);
}

inline Case cart_pole(const Feedback& feedback, double width = 1.0) {
  Eigen::Vector4d deviation(0.05, 0.05, 0.02, 0.05);
  return make_case("cart-pole", models::make_dynamics("cart_pole", {}, 0.05),
                   around(Eigen::Vector4d(0.0, 0.1, 0.05, 0.0), width * deviation),
                   (0.02 * Eigen::Vector4d::Ones()).cwiseAbs2().asDiagonal(),
                   Eigen::VectorXd::Constant(1, 1.0), feedback);
}

/// Paths of the state and of its surrogate under the same draws; stages 0 … horizon.
struct Pairs {
  std::vector<controller::Points> state;
  std::vector<controller::Points> surrogate;
  std::vector<controller::Points>
      noise;  ///< noise of the step that leads to the stage; at 0 the belief's draws
};

/// The draws that enter at the stages 0 … horizon.
inline std::vector<controller::Points> draw_noise(const controller::PredictedMotion& motion,
                                                  Generator& generator) {
  NormalSampler belief(motion.belief.covariance);
  NormalSampler noise(motion.noise_covariance);
  std::vector<controller::Points> result;
  for (Eigen::Index k = 0; k <= motion.policy.horizon(); ++k) {
    controller::Points draws(motion.belief.mean.size(), kSamples);
    for (int i = 0; i < kSamples; ++i) draws.col(i) = (k == 0 ? belief : noise)(generator);
    result.push_back(draws);
  }
  return result;
}

/// shifts: the noise's mean at every stage, included in the stages' laws; none: zero.
inline Pairs pairs_under(const controller::PredictedMotion& motion,
                         const std::vector<controller::SurrogateStage>& stages,
                         std::vector<controller::Points> noise,
                         const std::vector<Eigen::VectorXd>& shifts = {}) {
  const Eigen::Index dim = motion.belief.mean.size();
  Pairs pairs;
  pairs.noise = std::move(noise);
  pairs.state.push_back(pairs.noise[0].colwise() + motion.belief.mean);
  pairs.surrogate.push_back(pairs.state[0]);
  for (Eigen::Index k = 0; k < motion.policy.horizon(); ++k) {
    controller::Points inputs(motion.policy.inputs.rows(), kSamples);
    controller::Points next(dim, kSamples);
    controller::policy_inputs(motion.policy, k, pairs.state[k], inputs);
    motion.dynamics.step(pairs.state[k], inputs, next);
    pairs.state.push_back(next + pairs.noise[k + 1]);
    const controller::Points offset = pairs.surrogate[k].colwise() - stages[k].law.mean;
    Eigen::VectorXd centre = stages[k + 1].law.mean;
    if (!shifts.empty()) centre -= shifts[k + 1];
    pairs.surrogate.push_back(((stages[k].transition * offset).colwise() + centre) +
                              pairs.noise[k + 1]);
  }
  return pairs;
}

inline Pairs simulate_pairs(const controller::PredictedMotion& motion,
                            const std::vector<controller::SurrogateStage>& stages,
                            Generator& generator) {
  return pairs_under(motion, stages, draw_noise(motion, generator));
}

inline Eigen::VectorXd root_mean_squares(const controller::Points& values) {
  return (values.rowwise().squaredNorm() / static_cast<double>(values.cols())).cwiseSqrt();
}

inline Eigen::MatrixXd sample_covariance(const controller::Points& first,
                                         const controller::Points& second) {
  const controller::Points a = first.colwise() - first.rowwise().mean();
  const controller::Points b = second.colwise() - second.rowwise().mean();
  return a * b.transpose() / static_cast<double>(a.cols());
}

/// All systems in open loop, with LQR, and with unreasonable gains, some of which saturate most of
/// the time.
inline std::vector<Case> all_cases(Generator& generator) {
  const Feedback lqr{.closed_loop = true};
  const auto gain = [](const Eigen::MatrixXd& matrix) {
    return Feedback{.closed_loop = true, .gain = matrix};
  };
  return {dubins({}),
          skewed_dubins({}, generator),
          dubins(lqr),
          skewed_dubins(lqr, generator),
          dubins(gain(Eigen::RowVector3d(4.0, -6.0, -8.0)), 1.5, 0.3),
          double_integrator({}),
          double_integrator(lqr),
          double_integrator(lqr, 1.9, 0.5),
          double_integrator(gain(random_matrix(generator, 1, 2, 10.0))),
          bicycle({}),
          bicycle(lqr),
          bicycle(gain(random_matrix(generator, 2, 6, 0.05))),
          cart_pole({}),
          cart_pole(lqr),
          cart_pole(gain(Eigen::RowVector4d(3.0, 4.0, 40.0, 8.0)))};
}

}  // namespace qsmpc::testing

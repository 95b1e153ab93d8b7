// Horizons of the Dubins car and the bicycle from random points, between walls and obstacles, on
// which fast code is compared with plain code.
#pragma once

#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "controller/planning/cost/horizon_cost.hpp"
#include "controller/prediction/prediction.hpp"
#include "tests/support/plain_planner.hpp"
#include "tests/unit/controller/measure/random_measures.hpp"

namespace qsmpc::testing {

struct ReferenceCase {
  std::string system;
  bool closed_loop = false;
  bool noise = true;
  controller::PenaltyShape shape = controller::PenaltyShape::kSmooth;
  int points = 100;      ///< at the start
  int compressed = 100;  ///< at later stages
};

inline std::string name_of(const ReferenceCase& options) {
  return options.system + (options.closed_loop ? "_closed" : "_open") +
         (options.noise ? "_mixture" : "_noise_free") +
         (options.shape == controller::PenaltyShape::kThesis ? "_thesis_" : "_smooth_") +
         std::to_string(options.points) + "_" + std::to_string(options.compressed);
}

class ReferenceProblem {
 public:
  explicit ReferenceProblem(const ReferenceCase& options) : options_(options) {
    Generator generator(404);
    const bool car = options.system == "dubins";
    dynamics_ = car ? models::make_dynamics("dubins", {{"speed", 1.5}}, 0.1)
                    : models::make_dynamics("bicycle", {}, 0.1);
    const Eigen::Index dim = dynamics_->state_dim();
    const Eigen::Index inputs = dynamics_->input_dim();
    Eigen::VectorXd mean = random_matrix(generator, dim, 1, 0.2);
    if (!car) mean[3] += 15.0;  // m/s
    start_ = random_measure(generator, dim, options.points);
    start_.locations = 0.15 * start_.locations;
    start_.locations.colwise() += mean;
    noise_ = random_spd(generator, dim, 0.003);
    no_noise_ = Eigen::MatrixXd::Zero(dim, dim);
    within_ = random_spd(generator, dim, 0.001);
    cost_ = {.state = random_spd(generator, dim),
             .input = random_spd(generator, inputs),
             .terminal = random_spd(generator, dim),
             .target = mean + random_matrix(generator, dim, 1)};
    penalty_.shape = options.shape;
    make_room(mean, car ? 0.15 : 1.5);
    make_policy(generator, mean);
    propagator_ = controller::make_propagator(
        options.noise ? "mixture" : "noise_free",
        {.noise = {.mean = Eigen::VectorXd::Zero(dim), .covariance = noise_},
         .noise_points = kParts,
         .compressed_points = options.compressed});
  }

  [[nodiscard]] const models::Dynamics& dynamics() const { return *dynamics_; }
  [[nodiscard]] const controller::DiscreteMeasure& start() const { return start_; }
  [[nodiscard]] const controller::Policy& policy() const { return policy_; }
  [[nodiscard]] controller::Propagator& propagator() const { return *propagator_; }
  [[nodiscard]] controller::HorizonCostTerms terms() const {
    return {.dynamics = *dynamics_,
            .safe_set = safe_set_,
            .cost = cost_,
            .penalty = penalty_,
            .noise_covariance = options_.noise ? noise_ : no_noise_,
            .within_covariance = within_};
  }
  [[nodiscard]] PlainNoise plain_noise() const {
    return {.none = !options_.noise,
            .covariance = noise_,
            .cells = options_.compressed,
            .parts = kParts};
  }
  [[nodiscard]] controller::Prediction predict() const {
    return qsmpc::controller::predict(*dynamics_, *propagator_, start_, policy_);
  }
  /// Number of particles at stage 0 with an input at a bound.
  [[nodiscard]] int saturated() const {
    int count = 0;
    for (Eigen::Index i = 0; i < start_.size(); ++i) {
      const Eigen::VectorXd input = controller::policy_input(policy_, 0, start_.locations.col(i));
      count += (input.array() == policy_.bounds.lower.array()).any() ||
               (input.array() == policy_.bounds.upper.array()).any();
    }
    return count;
  }

 private:
  static constexpr int kParts = 20;
  static constexpr int kHorizon = 4;

  /// Walls and obstacles around the path, which advances by `reach` per stage.
  void make_room(const Eigen::VectorXd& mean, double reach) {
    const Eigen::Index dim = mean.size();
    constexpr double kFar = std::numeric_limits<double>::infinity();
    safe_set_ = controller::unbounded_safe_set(dim);
    safe_set_.bounds.lower[0] = mean[0] - 0.2;
    safe_set_.bounds.upper[0] = mean[0] + 3.0 * reach;
    safe_set_.bounds.upper[1] = mean[1] + 0.25;
    safe_set_.bounds.lower[2] = mean[2] - 0.3;
    const auto block = [&](double x, double y, double half) {
      controller::Box box{.lower = Eigen::VectorXd::Constant(dim, -kFar),
                          .upper = Eigen::VectorXd::Constant(dim, kFar)};
      box.lower.head<2>() << mean[0] + x - half, mean[1] + y - half;
      box.upper.head<2>() << mean[0] + x + half, mean[1] + y + half;
      return box;
    };
    safe_set_.obstacles = {block(reach, 0.1, 0.1), block(1.2 * reach, 0.2, 0.15),
                           block(2.5 * reach, -0.5, 0.3)};
    std::get<controller::Box>(safe_set_.obstacles[2].form).upper[2] = mean[2] + 0.05;
  }

  void make_policy(Generator& generator, const Eigen::VectorXd& mean) {
    const Eigen::Index inputs = dynamics_->input_dim();
    policy_.inputs = random_matrix(generator, inputs, kHorizon, 0.2);
    policy_.states = controller::nominal_states(*dynamics_, mean, policy_.inputs);
    // Closed loop: tight enough to clamp some particles.
    const double bound = options_.closed_loop ? 0.3 : 2.0;
    policy_.bounds = {.lower = Eigen::VectorXd::Constant(inputs, -bound),
                      .upper = Eigen::VectorXd::Constant(inputs, 0.9 * bound)};
    for (int k = 0; k < kHorizon; ++k) {
      const Eigen::MatrixXd gain = random_matrix(generator, inputs, mean.size());
      policy_.gains.emplace_back(options_.closed_loop ? gain : Eigen::MatrixXd(0.0 * gain));
    }
  }

  ReferenceCase options_;
  std::unique_ptr<const models::Dynamics> dynamics_;
  controller::DiscreteMeasure start_;
  Eigen::MatrixXd noise_;
  Eigen::MatrixXd no_noise_;
  Eigen::MatrixXd within_;
  controller::QuadraticCost cost_;
  controller::Penalty penalty_;
  controller::SafeSet safe_set_;
  controller::Policy policy_;
  std::unique_ptr<controller::Propagator> propagator_;
};

/// Both systems, loops, propagators and penalties at the usual size; other sizes for some: one
/// point, and more points than one task takes.
inline std::vector<ReferenceCase> reference_cases() {
  std::vector<ReferenceCase> cases;
  for (const char* system : {"dubins", "bicycle"}) {
    for (const bool closed_loop : {false, true}) {
      for (const bool noise : {false, true}) {
        for (const controller::PenaltyShape shape :
             {controller::PenaltyShape::kSmooth, controller::PenaltyShape::kThesis}) {
          cases.push_back({system, closed_loop, noise, shape, 100, 101});
        }
      }
      for (const auto& [points, compressed] : {std::pair{1, 1}, std::pair{1, 50}, std::pair{7, 3},
                                               std::pair{101, 7}, std::pair{3000, 1100}}) {
        cases.push_back(
            {system, closed_loop, true, controller::PenaltyShape::kSmooth, points, compressed});
      }
    }
    cases.push_back({system, true, false, controller::PenaltyShape::kThesis, 3000, 3000});
  }
  return cases;
}

}  // namespace qsmpc::testing

// Model predictive control of the constant-speed car without qsmpc's planner: projected
// Gauss–Newton steps on the turn rates along the noise-free path, with penalties near the blocks.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/Cholesky>
#include <qsmpc/controller/control/own_controller.hpp>

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kMostSteps = 30;
constexpr double kSettled = 1e-6;  // relative gain below which a step is the last
constexpr double kDamping = 1e-3;
constexpr double kDifference = 1e-6;  // rad/s, of a finite difference

class Mpc {
 public:
  explicit Mpc(const qsmpc::own::Problem& problem)
      : problem_(problem),
        speed_(problem.parameter("speed")),
        lower_(problem.input_lower()[0]),
        upper_(problem.input_upper()[0]),
        state_root_(problem.cost_state().diagonal().cwiseSqrt() * std::sqrt(0.5)),
        terminal_root_(problem.cost_terminal().diagonal().cwiseSqrt()),
        input_root_(std::sqrt(problem.cost_input()(0, 0))) {}

  void reset(std::uint64_t /*seed*/) { turns_.resize(0); }

  qsmpc::own::Answer act(const qsmpc::own::Situation& situation) {
    const VectorXd start = situation.mean;
    int evaluations = 0;
    if (turns_.size() == 0) {
      turns_ = first_turns(start, evaluations);
    } else {
      std::rotate(turns_.begin(), turns_.begin() + 1, turns_.end());
      turns_.tail(1) = turns_.segment(turns_.size() - 2, 1);
      turns_ = improved(start, turns_, evaluations);
    }
    return {.plan_inputs = turns_.transpose(), .evaluations = evaluations};
  }

 private:
  /// The best result from initial turns to either side: there are two ways around a block.
  VectorXd first_turns(const VectorXd& start, int& evaluations) const {
    VectorXd best;
    for (const double turn : {-1.0, 0.0, 1.0}) {
      const VectorXd from =
          VectorXd::Constant(problem_.horizon(), std::clamp(turn, lower_, upper_));
      const VectorXd found = improved(start, from, evaluations);
      const bool is_better =
          best.size() == 0 || residuals(start, found).norm() < residuals(start, best).norm();
      if (is_better) best = found;
    }
    return best;
  }

  VectorXd improved(const VectorXd& start, VectorXd turns, int& evaluations) const {
    for (int n = 0; n < kMostSteps; ++n) {
      const VectorXd now = residuals(start, turns);
      MatrixXd slope(now.size(), turns.size());
      for (Index k = 0; k < turns.size(); ++k) {
        VectorXd moved = turns;
        moved[k] += kDifference;
        slope.col(k) = (residuals(start, moved) - now) / kDifference;
      }
      MatrixXd normal = slope.transpose() * slope;
      normal.diagonal() *= 1.0 + kDamping;
      const VectorXd step = normal.ldlt().solve(slope.transpose() * now);
      ++evaluations;
      VectorXd next;
      double share = 1.0;
      do {
        next = (turns - share * step).cwiseMax(lower_).cwiseMin(upper_);
        share *= 0.5;
      } while (residuals(start, next).squaredNorm() > now.squaredNorm() && share > 1e-4);
      const double cost = residuals(start, next).squaredNorm();
      if (!(cost < now.squaredNorm())) break;
      turns = next;
      if (now.squaredNorm() - cost < kSettled * now.squaredNorm()) break;
    }
    return turns;
  }

  /// Residuals, the sum of whose squares is the cost.
  [[nodiscard]] VectorXd residuals(const VectorXd& start, const VectorXd& turns) const {
    std::vector<double> all;
    VectorXd state = start;
    const auto add = [&](const VectorXd& values) {
      all.insert(all.end(), values.begin(), values.end());
    };
    for (Index k = 0; k < turns.size(); ++k) {
      add(state_root_.cwiseProduct(state - problem_.target()));
      all.push_back(input_root_ * turns[k]);
      const double step = problem_.time_step();
      state += Eigen::Vector3d(step * speed_ * std::cos(state[2]),
                               step * speed_ * std::sin(state[2]), step * turns[k]);
      add(penalties(state));
    }
    add(terminal_root_.cwiseProduct(state - problem_.target()));
    return Eigen::Map<const VectorXd>(all.data(), static_cast<Index>(all.size()));
  }

  /// Penalties of every obstacle and every side of the bounds.
  [[nodiscard]] VectorXd penalties(const VectorXd& state) const {
    constexpr double kMargin = 0.6;    // m
    constexpr double kWeight = 400.0;  // the square root of the cost per square metre
    const auto obstacles = problem_.obstacle_lower().rows();
    VectorXd values(obstacles + 4);
    for (Index i = 0; i < obstacles; ++i) {
      double depth = std::numeric_limits<double>::infinity();
      for (Index axis = 0; axis < 2; ++axis) {
        depth = std::min({depth, state[axis] - problem_.obstacle_lower()(i, axis),
                          problem_.obstacle_upper()(i, axis) - state[axis]});
      }
      values[i] = kWeight * std::max(depth + kMargin, 0.0);
    }
    for (Index axis = 0; axis < 2; ++axis) {
      const double below = problem_.bounds_lower()[axis] - state[axis];
      const double above = state[axis] - problem_.bounds_upper()[axis];
      values[obstacles + 2 * axis] = kWeight * std::max(below + kMargin, 0.0);
      values[obstacles + 2 * axis + 1] = kWeight * std::max(above + kMargin, 0.0);
    }
    return values;
  }

  qsmpc::own::Problem problem_;
  double speed_;
  double lower_;
  double upper_;
  VectorXd state_root_;
  VectorXd terminal_root_;
  double input_root_;
  VectorXd turns_;  // of the last plan, rad/s
};

}  // namespace

QSMPC_REGISTER_CONTROLLER(Mpc);

#include "controller/chance/sampled_paths.hpp"

#include <algorithm>

namespace qsmpc::controller {

SampledPaths::SampledPaths(const models::Dynamics& dynamics, const InputBounds& bounds,
                           Eigen::Index horizon, Eigen::Index memory)
    : dynamics_(dynamics),
      bounds_(bounds),
      horizon_(horizon),
      memory_(memory),
      state_dim_(dynamics.state_dim()),
      input_dim_(dynamics.input_dim()),
      stages_(static_cast<std::size_t>(horizon + 1)) {
  decisions_ = inputs_in_decision();
  for (Eigen::Index k = 0; k < horizon_; ++k) {
    first_matrix_.push_back(decisions_);
    decisions_ += lags(k) * input_dim_ * state_dim_;
  }
}

void SampledPaths::shift(Eigen::VectorXd& z) const {
  const Eigen::Index block = input_dim_ * state_dim_;
  // Reads always lie behind writes, so a forward copy is safe.
  const auto move = [&z](Eigen::Index to, Eigen::Index from, Eigen::Index count) {
    std::copy_n(z.data() + from, count, z.data() + to);
  };
  for (Eigen::Index k = 0; k + 1 < horizon_; ++k) {
    move(k * input_dim_, (k + 1) * input_dim_, input_dim_);
    // By lags, so that each matrix keeps responding to the same noise; the first stage has no
    // matrices.
    move(first_matrix_[k], first_matrix_[k + 1], lags(k) * block);
  }
}

void SampledPaths::resize() {
  for (Stage& stage : stages_) {
    stage.states.resize(state_dim_, paths_ + 1);
    stage.adjoint.resize(state_dim_, paths_ + 1);
    stage.pulled.resize(state_dim_, paths_ + 1);
    stage.inputs.resize(input_dim_, paths_ + 1);
    stage.input_adjoint.resize(input_dim_, paths_ + 1);
  }
  away_.resize(state_dim_, paths_ + 1);
  weighted_.resize(state_dim_, paths_ + 1);
  through_input_.resize(input_dim_, paths_ + 1);
  input_sum_.resize(input_dim_);
}

void SampledPaths::hold(const Eigen::VectorXd& mean, const PathDraw& draw) {
  draw_ = &draw;
  mean_ = mean;
  paths_ = draw.start.cols();
  is_rolled_out_ = false;
  resize();
  stages_[0].states.leftCols(paths_) = draw.start;
  stages_[0].states.col(paths_) = mean;
}

void SampledPaths::hold_gains(const std::vector<Eigen::MatrixXd>& gains) {
  gains_ = gains.empty() ? nullptr : &gains;
  is_rolled_out_ = false;
}

/// The inputs of a stage, whose states are known.
void SampledPaths::apply_policy(Eigen::Index stage, const Eigen::VectorXd& z) {
  Stage& at = stages_[stage];
  at.inputs.colwise() = z.segment(stage * input_dim_, input_dim_);
  if (paths_ == 0) return;
  auto inputs = at.inputs.leftCols(paths_);
  if (gains_ != nullptr) {
    away_.leftCols(paths_) = at.states.leftCols(paths_).colwise() - at.states.col(paths_);
    inputs.noalias() += (*gains_)[stage] * away_.leftCols(paths_);
  }
  const Eigen::Index block = input_dim_ * state_dim_;
  for (Eigen::Index lag = 1; lag <= lags(stage); ++lag) {
    const Eigen::Map<const Eigen::MatrixXd> matrix(
        z.data() + first_matrix_[stage] + (lag - 1) * block, input_dim_, state_dim_);
    inputs.noalias() += matrix * draw_->noise[stage - lag];
  }
  if (gains_ == nullptr && lags(stage) == 0) return;
  for (Eigen::Index i = 0; i < input_dim_; ++i) {
    inputs.row(i) = inputs.row(i).cwiseMax(bounds_.lower[i]).cwiseMin(bounds_.upper[i]);
  }
}

void SampledPaths::rollout(const Eigen::VectorXd& z) {
  if (is_rolled_out_ && rolled_out_ == z) return;
  for (Eigen::Index k = 0; k < horizon_; ++k) {
    apply_policy(k, z);
    Stage& next = stages_[k + 1];
    dynamics_.step(stages_[k].states, stages_[k].inputs, next.states);
    if (paths_ > 0) next.states.leftCols(paths_) += draw_->noise[k];
  }
  rolled_out_ = z;
  is_rolled_out_ = true;
}

void SampledPaths::clear_adjoints() {
  for (Stage& stage : stages_) {
    stage.adjoint.setZero();
    stage.input_adjoint.setZero();
  }
}

CostParts SampledPaths::add_cost(const QuadraticCost& cost) {
  const Eigen::Index n = counted();
  const double share = 1.0 / static_cast<double>(n);
  double state = 0.0;
  double input = 0.0;
  double terminal = 0.0;
  for (Eigen::Index k = 0; k <= horizon_; ++k) {
    Stage& stage = stages_[k];
    auto away = away_.leftCols(n);
    auto weighted = weighted_.leftCols(n);
    away = stage.states.leftCols(n).colwise() - cost.target_at(k);
    const bool last = k == horizon_;
    weighted.noalias() = (last ? cost.terminal : cost.state) * away;
    const double value = away.cwiseProduct(weighted).sum();
    (last ? terminal : state) += (last ? share : 0.5 * share) * value;
    stage.adjoint.leftCols(n) += (last ? 2.0 * share : share) * weighted;
    if (last) break;
    auto weighted_inputs = through_input_.leftCols(n);
    weighted_inputs.noalias() = cost.input * stage.inputs.leftCols(n);
    stage.input_adjoint.leftCols(n) += 2.0 * share * weighted_inputs;
    input += share * weighted_inputs.cwiseProduct(stage.inputs.leftCols(n)).sum();
  }
  return {{"state", state}, {"input", input}, {"terminal", terminal}};
}

void SampledPaths::pull_back(Eigen::VectorXd& gradient) {
  const Eigen::Index block = input_dim_ * state_dim_;
  for (Eigen::Index k = horizon_ - 1; k >= 0; --k) {
    Stage& stage = stages_[k];
    dynamics_.pullback(stage.states, stage.inputs, stages_[k + 1].adjoint, stage.pulled,
                       through_input_);
    stage.adjoint += stage.pulled;
    stage.input_adjoint += through_input_;
    if (paths_ > 0 && (gains_ != nullptr || lags(k) > 0)) {
      auto adjoint = stage.input_adjoint.leftCols(paths_);
      for (Eigen::Index i = 0; i < input_dim_; ++i) {
        const auto applied = stage.inputs.row(i).head(paths_).array();
        adjoint.row(i) = (applied > bounds_.lower[i] && applied < bounds_.upper[i])
                             .select(adjoint.row(i).array(), 0.0);
      }
      if (gains_ != nullptr) {
        const Eigen::MatrixXd& gain = (*gains_)[k];
        stage.adjoint.leftCols(paths_).noalias() += gain.transpose() * adjoint;
        input_sum_ = adjoint.rowwise().sum();
        stage.adjoint.col(paths_).noalias() -= gain.transpose() * input_sum_;
      }
      for (Eigen::Index lag = 1; lag <= lags(k); ++lag) {
        Eigen::Map<Eigen::MatrixXd> matrix(gradient.data() + first_matrix_[k] + (lag - 1) * block,
                                           input_dim_, state_dim_);
        matrix.noalias() += adjoint * draw_->noise[k - lag].transpose();
      }
    }
    gradient.segment(k * input_dim_, input_dim_) += stage.input_adjoint.rowwise().sum();
  }
}

}  // namespace qsmpc::controller

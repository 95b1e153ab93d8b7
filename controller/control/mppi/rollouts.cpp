#include "controller/control/mppi/rollouts.hpp"

#include <utility>

#include "models/constants.hpp"

namespace qsmpc::controller {

SampleChunk::SampleChunk(int place, Eigen::Index samples, Eigen::Index state_dim,
                         Eigen::Index input_dim, Eigen::Index horizon)
    : number(place),
      inputs(horizon * input_dim, samples),
      states(state_dim, samples),
      next(state_dim, samples),
      centres(state_dim, samples),
      normals(state_dim, samples),
      clearances(samples),
      quadratic(samples),
      unsafe(samples) {}

Rollouts::Rollouts(const models::Dynamics& dynamics, const PlannerSettings& problem,
                   const UnsafeCost& unsafe_cost)
    : dynamics_(dynamics),
      horizon_(problem.horizon),
      input_dim_(dynamics.input_dim()),
      state_({QuadraticForm(problem.cost.state, problem.cost.target)}),
      input_(problem.cost.input, Eigen::VectorXd::Zero(dynamics.input_dim())),
      terminal_(problem.cost.terminal, problem.cost.target),
      unsafe_(problem.safe_set),
      unsafe_cost_(unsafe_cost),
      start_(problem.cost.target) {}

void Rollouts::place(const Eigen::VectorXd& start, const QuadraticCost& cost) {
  start_ = start;
  const bool moves = cost.stage_targets.cols() > 0;
  state_.resize(moves ? static_cast<std::size_t>(horizon_) : 1, state_.front());
  for (std::size_t k = 0; k < state_.size(); ++k) {
    state_[k].centre = cost.target_at(static_cast<Eigen::Index>(k));
  }
  terminal_.centre = cost.target_at(horizon_);
}

Eigen::Map<const Points> Rollouts::inputs_of(const SampleChunk& chunk, int stage) const {
  return {chunk.inputs.data() + stage * input_dim_ * chunk.count(), input_dim_, chunk.count()};
}

void Rollouts::add_input_cost(const SampleChunk& chunk, Eigen::ArrayXd& totals) const {
  for (int k = 0; k < horizon_; ++k) add_quadratic(input_, 1.0, inputs_of(chunk, k), totals);
}

void Rollouts::roll_out(const RolloutNoise& noise, SampleChunk& chunk) const {
  chunk.quadratic.setZero();
  chunk.unsafe.setZero();
  for (Eigen::Index i = 0; i < start_.size(); ++i) chunk.states.row(i).setConstant(start_[i]);
  add_noise(noise, 0, chunk);
  for (int k = 0; k < horizon_; ++k) {
    dynamics_.step(chunk.states, inputs_of(chunk, k), chunk.next);
    std::swap(chunk.states, chunk.next);
    add_noise(noise, k + 1, chunk);
    const bool ends = k + 1 == horizon_;
    const QuadraticForm& state = state_.size() > 1 && !ends ? state_[k + 1] : state_.front();
    add_quadratic(ends ? terminal_ : state, ends ? 1.0 : 0.5, chunk.states, chunk.quadratic);
    add_unsafe(k + 1, chunk);
  }
}

void Rollouts::add_noise(const RolloutNoise& noise, int stage, SampleChunk& chunk) const {
  if (noise.path != nullptr) {
    for (Eigen::Index i = 0; i < chunk.states.rows(); ++i) {
      chunk.states.row(i).array() += (*noise.path)(i, stage);
    }
  }
  if (noise.own != nullptr) {
    add_own_noise(*noise.own, horizon_, stage, chunk.number, chunk.states, chunk.normals);
  }
}

void Rollouts::add_unsafe(int stage, SampleChunk& chunk) const {
  chunk.clearances.setConstant(kInfinity);
  for (const DiscView& disc : unsafe_.discs()) {
    const bool moves = !disc.placement.at_position();
    if (moves) place_discs(disc.placement, chunk.states, chunk.centres);
    for (const RegionPointer& region : disc.regions) {
      region->lower_to_distances(stage, moves ? chunk.centres : chunk.states, chunk.clearances);
    }
  }
  add_unsafe_cost(unsafe_cost_, chunk.clearances, chunk.unsafe.data());
}

}  // namespace qsmpc::controller

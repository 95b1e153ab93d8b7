#include "controller/planning/cost/horizon_cost.hpp"

#include <algorithm>
#include <utility>

namespace qsmpc::controller {
namespace {

using StateView = Eigen::Map<const models::StateBatch>;
using StateSpan = Eigen::Map<models::StateBatch>;

auto columns(const Points& points, ParticleRange range) {
  return points.middleCols(range.begin, range.end - range.begin);
}

auto columns(Points& points, ParticleRange range) {
  return points.middleCols(range.begin, range.end - range.begin);
}

}  // namespace

HorizonCost::HorizonCost(const HorizonCostTerms& terms, Executor run)
    : terms_(terms), run_(std::move(run)) {
  for (const CostTermEntry& entry : cost_terms()) {
    std::unique_ptr<StageTerm> term = entry.make(terms);
    if (term == nullptr) continue;
    const TermPlace place = term->place();
    const bool needs_all = term->needs_all();
    terms_in_use_.push_back({.part = cost_part(entry.part),
                             .place = place,
                             .needs_all = needs_all,
                             .term = std::move(term)});
  }
}

HorizonCost::HorizonCost(const HorizonCostTerms& terms, const Prediction& prediction,
                         const Policy& policy)
    : HorizonCost(terms) {
  freeze_assignments(prediction, policy);
}

void HorizonCost::freeze_assignments(const Prediction& prediction, const Policy& policy) {
  rolled_out_ = false;
  transposed_ = 0;
  prediction_ = &prediction;
  policy_.inputs = policy.inputs;
  policy_.states = policy.states;
  policy_.gains = policy.gains;
  policy_.bounds = policy.bounds;
  gains_ = policy.gains;
  closed_loop_ = std::any_of(gains_.begin(), gains_.end(),
                             [](const Eigen::MatrixXd& gain) { return !gain.isZero(0.0); });
  lone_ = std::all_of(prediction.maps.begin(), prediction.maps.end(),
                      [](const StageMap& map) { return map.identity; });
  resize_stages();
  stages_[0].points = prediction.stages[0].locations;
  fixed_ = {};
  for (const Term& each : terms_in_use_) {
    each.term->freeze({.belief = prediction.stages[0],
                       .noise_covariance = terms_.noise_covariance,
                       .within_covariance = terms_.within_covariance,
                       .horizon = policy.horizon()});
    fixed_[each.part] += each.term->fixed();
  }
}

void HorizonCost::resize_stages() {
  const Eigen::Index dim = policy_.states.rows();
  const Eigen::Index inputs = policy_.inputs.rows();
  const Eigen::Index horizon = policy_.horizon();
  stages_.resize(horizon + 1);
  Eigen::Index most = 0;
  for (Eigen::Index k = 0; k <= horizon; ++k) {
    const Eigen::Index size = prediction_->stages[k].size();
    most = std::max(most, size);
    Stage& stage = stages_[k];
    for (Points* points : {&stage.points, &stage.adjoint, &stage.stepped, &stage.state_gradient,
                           &stage.stepped_adjoint, &stage.pulled}) {
      points->resize(dim, size);
    }
    for (Points* points : {&stage.inputs, &stage.input_gradient, &stage.input_adjoint}) {
      points->resize(inputs, size);
    }
    resize_packed(static_cast<int>(dim), size, stage.packed_adjoint);
    resize_packed(static_cast<int>(dim), size, stage.packed_stepped);
    stage.constant.resize(inputs);
  }
  partials_.resize(chunks_of(most));
  for (Partial& partial : partials_) {
    partial.inputs.resize(inputs);
    partial.outer.resize(inputs, dim);
  }
  nominal_adjoint_.resize(dim);
  nominal_step_adjoint_.resize(dim);
  nominal_input_adjoint_.resize(inputs);
  input_sum_.resize(inputs);
  outer_sum_.resize(inputs, dim);
}

double HorizonCost::evaluate(const Eigen::Ref<const Eigen::MatrixXd>& inputs,
                             Eigen::MatrixXd& gradient) {
  flat_.resize(inputs.size());
  flat_gradient_.resize(inputs.size());
  Eigen::Map<Eigen::MatrixXd>(flat_.data(), inputs.rows(), inputs.cols()) = inputs;
  const double value = evaluate(flat_, flat_gradient_);
  gradient = Eigen::Map<const Eigen::MatrixXd>(flat_gradient_.data(), inputs.rows(), inputs.cols());
  return value;
}

double HorizonCost::evaluate(const Eigen::VectorXd& z, Eigen::VectorXd& gradient) {
  if (!adjoints_at_hand_ || !is_rolled_out(z)) forward(z);
  backward(policy_.horizon(), /*with_cost=*/true, gradient);
  return parts_.total();
}

double HorizonCost::evaluate(const Eigen::VectorXd& z) {
  rollout(z);
  return parts_.total();
}

void HorizonCost::rollout(const Eigen::VectorXd& z) {
  if (!is_rolled_out(z)) forward(z);
}

/// Reads the inputs and, if present, the change of the gains from z.
void HorizonCost::set_decision(const Eigen::VectorXd& z) {
  const Eigen::Index inputs = policy_.inputs.rows();
  const Eigen::Index dim = policy_.states.rows();
  policy_.inputs = Eigen::Map<const Eigen::MatrixXd>(z.data(), inputs, policy_.inputs.cols());
  with_gain_ = z.size() > policy_.inputs.size();
  if (!with_gain_) return;
  const Eigen::Map<const Eigen::MatrixXd> change(z.data() + policy_.inputs.size(), inputs, dim);
  for (Eigen::Index k = 0; k < policy_.horizon(); ++k) policy_.gains[k] = gains_[k] + change;
}

StagePolicy HorizonCost::stage_policy(Eigen::Index k) const {
  return {.constant = stages_[k].constant.data(),
          .gain = policy_.gains[k].data(),
          .lower = policy_.bounds.lower.data(),
          .upper = policy_.bounds.upper.data(),
          .closed_loop = closed_loop_ || with_gain_};
}

void HorizonCost::forward(const Eigen::VectorXd& z) {
  decision_.assign(z.begin(), z.end());
  rolled_out_ = true;
  adjoints_at_hand_ = true;
  set_decision(z);
  const Eigen::Index dim = policy_.states.rows();
  const Eigen::Index inputs = policy_.inputs.rows();
  parts_ = fixed_;
  for (Eigen::Index k = 0; k < policy_.horizon(); ++k) {
    Stage& stage = stages_[k];
    const double* const state = policy_.states.col(k).data();
    StateSpan next_state(policy_.states.col(k + 1).data(), dim, 1);
    terms_.dynamics.step(StateView(state, dim, 1),
                         StateView(policy_.inputs.col(k).data(), inputs, 1), next_state);
    stage.constant = policy_.inputs.col(k);
    stage.constant.noalias() -= policy_.gains[k] * policy_.states.col(k);

    const Eigen::Index sources = stage.points.cols();
    const Eigen::Index clusters = stages_[k + 1].points.cols();
    for_chunks(run_, sources, [&](ParticleRange range, int chunk) {
      partials_[chunk].cost = forward_sources(k, range);
    });
    for (Eigen::Index i = 0; i < sources; i += kChunk) {
      parts_.add(partials_[i / kChunk].cost);
    }
    add_terms_of_all(k);
    const bool spread = prediction_->maps[k].spread.size() != 0;
    if (spread) {
      for_chunks(run_, clusters, [&](ParticleRange range, int) {
        apply_shares(prediction_->maps[k], stage.stepped, stage.packed_stepped, range.begin,
                     range.end, stages_[k + 1].points);
      });
      apply_spread(prediction_->maps[k], stages_[k + 1].points);
    }
    for_chunks(run_, clusters, [&](ParticleRange range, int chunk) {
      partials_[chunk].cost = forward_clusters(k, range);
    });
    for (Eigen::Index i = 0; i < clusters; i += kChunk) parts_.add(partials_[i / kChunk].cost);
  }
}

/// Evaluates the terms at one place that can be split by particles; without any, zeroes the
/// gradient.
void HorizonCost::add_terms(TermPlace place, TermBatch batch, CostParts& parts) const {
  batch.blank = true;
  for (const Term& each : terms_in_use_) {
    if (each.place != place || each.needs_all) continue;
    if (!each.term->acts(batch.stage, policy_.horizon())) continue;
    parts[each.part] += each.term->add(batch, run_);
    batch.blank = false;
  }
  clear_if_blank(batch);
}

/// Policy, step and costs of a range of particles of stage k.
CostParts HorizonCost::forward_sources(Eigen::Index k, ParticleRange range) {
  Stage& stage = stages_[k];
  const Eigen::VectorXd& weights = prediction_->stages[k].weights;
  CostParts cost;
  apply_policy(stage_policy(k), stage.points, range, stage.inputs);
  add_terms(TermPlace::kInputs,
            {.stage = k,
             .points = stage.inputs,
             .weights = weights,
             .range = range,
             .gradient = stage.input_gradient},
            cost);
  terms_.dynamics.step(columns(std::as_const(stage.points), range),
                       columns(std::as_const(stage.inputs), range), columns(stage.stepped, range));
  add_terms(TermPlace::kStepped,
            {.stage = k + 1,
             .points = stage.stepped,
             .weights = weights,
             .range = range,
             .gradient = stage.state_gradient},
            cost);
  if (!prediction_->maps[k].identity) {
    pack(stage.stepped, range.begin, range.end, stage.packed_stepped);
  }
  return cost;
}

/// The terms of the next state that need all particles of stage k at once.
void HorizonCost::add_terms_of_all(Eigen::Index k) {
  Stage& stage = stages_[k];
  for (const Term& each : terms_in_use_) {
    if (!each.needs_all || !each.term->acts(k + 1, policy_.horizon())) continue;
    parts_[each.part] += each.term->add({.stage = k + 1,
                                         .points = stage.stepped,
                                         .weights = prediction_->stages[k].weights,
                                         .range = {0, stage.stepped.cols()},
                                         .gradient = stage.state_gradient,
                                         .lone = prediction_->maps[k].identity},
                                        run_);
  }
}

/// A range of particles of stage k + 1, and the terms at them.
CostParts HorizonCost::forward_clusters(Eigen::Index k, ParticleRange range) {
  const Stage& stage = stages_[k];
  Stage& next = stages_[k + 1];
  const StageMap& map = prediction_->maps[k];
  if (map.spread.size() == 0) {
    apply_shares(map, stage.stepped, stage.packed_stepped, range.begin, range.end, next.points);
  }
  CostParts cost;
  add_terms(TermPlace::kParticles,
            {.stage = k + 1,
             .points = next.points,
             .weights = map.weights,
             .range = range,
             .gradient = next.adjoint},
            cost);
  return cost;
}

/// Ensures that the first `stages` maps have their transposes. Predictions that are only evaluated
/// never need them.
void HorizonCost::transpose_maps(Eigen::Index stages) {
  for (; transposed_ < stages; ++transposed_) {
    const StageMap& map = prediction_->maps[transposed_];
    if (map.identity) continue;
    Stage& stage = stages_[transposed_];
    transpose(map.shares, static_cast<int>(stage.points.cols()), run_, stage.transposed);
  }
}

/// Backward pass from the adjoints of stage `from` and, with the cost, of all earlier stages.
void HorizonCost::backward(Eigen::Index from, bool with_cost, Eigen::VectorXd& gradient) {
  transpose_maps(from);
  adjoints_at_hand_ = false;
  gradient.setZero();
  nominal_adjoint_.setZero();
  stages_[0].adjoint.setZero();
  for (Eigen::Index k = from - 1; k >= 0; --k) {
    const Eigen::Index sources = stages_[k].points.cols();
    Stage& next = stages_[k + 1];
    const StageMap& map = prediction_->maps[k];
    pullback_spread(map, next.adjoint);
    if (!map.identity) {
      for_chunks(run_, map.clusters(), [&](ParticleRange range, int) {
        pack(next.adjoint, range.begin, range.end, next.packed_adjoint);
      });
    }
    for_chunks(run_, sources, [&](ParticleRange range, int chunk) {
      backward_sources(k, with_cost, range, partials_[chunk]);
    });
    input_sum_.setZero();
    outer_sum_.setZero();
    for (Eigen::Index i = 0; i < sources; i += kChunk) {
      input_sum_ += partials_[i / kChunk].inputs;
      if (with_gain_) outer_sum_ += partials_[i / kChunk].outer;
    }
    backward_nominal(k, input_sum_.data(), outer_sum_.data(), gradient);
  }
}

/// Backwards through map, step and policy, for a range of particles of stage k.
void HorizonCost::backward_sources(Eigen::Index k, bool with_cost, ParticleRange range,
                                   Partial& partial) {
  Stage& stage = stages_[k];
  const Stage& next = stages_[k + 1];
  pullback_shares(prediction_->maps[k], stage.transposed, next.adjoint, next.packed_adjoint,
                  range.begin, range.end, stage.stepped_adjoint);
  if (with_cost) add_points(stage.state_gradient, range, stage.stepped_adjoint);
  terms_.dynamics.pullback(columns(std::as_const(stage.points), range),
                           columns(std::as_const(stage.inputs), range),
                           columns(std::as_const(stage.stepped_adjoint), range),
                           columns(stage.pulled, range), columns(stage.input_adjoint, range));
  add_points(stage.pulled, range, stage.adjoint);
  if (with_cost) add_points(stage.input_gradient, range, stage.input_adjoint);
  partial.inputs.setZero();
  if (with_gain_) partial.outer.setZero();
  pullback_policy(stage_policy(k), stage.points, stage.inputs, stage.input_adjoint, range,
                  stage.adjoint, partial.inputs.data(),
                  with_gain_ ? partial.outer.data() : nullptr);
}

/// Backwards through the nominal step x̄_{k+1} = f(x̄_k, v_k), and through v_k − K_k x̄_k in the
/// policy. With a the adjoints of the inputs: sum = Σ a, outer = Σ a xᵀ.
void HorizonCost::backward_nominal(Eigen::Index k, const double* sum, const double* outer,
                                   Eigen::VectorXd& gradient) {
  const Eigen::Index dim = policy_.states.rows();
  const Eigen::Index inputs = policy_.inputs.rows();
  const Eigen::Map<const Eigen::VectorXd> of_inputs(sum, inputs);
  nominal_step_adjoint_ = nominal_adjoint_;
  terms_.dynamics.pullback(StateView(policy_.states.col(k).data(), dim, 1),
                           StateView(policy_.inputs.col(k).data(), inputs, 1),
                           StateView(nominal_step_adjoint_.data(), dim, 1),
                           StateSpan(nominal_adjoint_.data(), dim, 1),
                           StateSpan(nominal_input_adjoint_.data(), inputs, 1));
  gradient.segment(k * inputs, inputs) = nominal_input_adjoint_ + of_inputs;
  nominal_adjoint_.noalias() -= policy_.gains[k].transpose() * of_inputs;
  if (!with_gain_) return;
  Eigen::Map<Eigen::MatrixXd> of_gain(gradient.data() + policy_.inputs.size(), inputs, dim);
  of_gain += Eigen::Map<const Eigen::MatrixXd>(outer, inputs, dim);
  of_gain.noalias() -= of_inputs * policy_.states.col(k).transpose();
}

void HorizonCost::pull_back(Eigen::Index k, const StageSlope& slope, Eigen::VectorXd& gradient) {
  if (lone_ && slope.particles.size() == 1) {
    pull_back_alone(k, slope, gradient);
    return;
  }
  for (Eigen::Index j = 0; j <= k; ++j) stages_[j].adjoint.setZero();
  for (std::size_t i = 0; i < slope.particles.size(); ++i) {
    stages_[k].adjoint.col(slope.particles[i]) =
        slope.by_particle.col(static_cast<Eigen::Index>(i));
  }
  backward(k, /*with_cost=*/false, gradient);
}

/// The same for a particle that depends on no other: backwards along its own path.
void HorizonCost::pull_back_alone(Eigen::Index k, const StageSlope& slope,
                                  Eigen::VectorXd& gradient) {
  const Eigen::Index inputs = policy_.inputs.rows();
  const Eigen::Index particle = slope.particles.front();
  gradient.setZero();
  nominal_adjoint_.setZero();
  Eigen::VectorXd& adjoint = lone_adjoint_;
  adjoint = slope.by_particle.col(0);
  for (Eigen::Index j = k - 1; j >= 0; --j) {
    const Stage& stage = stages_[j];
    const ParticleRange one{particle, particle + 1};
    lone_next_ = adjoint;
    terms_.dynamics.pullback(columns(stage.points, one), columns(stage.inputs, one),
                             StateView(lone_next_.data(), lone_next_.size(), 1),
                             StateSpan(adjoint.data(), adjoint.size(), 1),
                             StateSpan(input_sum_.data(), inputs, 1));
    if (closed_loop_ || with_gain_) {
      for (Eigen::Index input = 0; input < inputs; ++input) {
        const double u = stage.inputs(input, particle);
        const bool free = u > policy_.bounds.lower[input] && u < policy_.bounds.upper[input];
        if (!free) input_sum_[input] = 0.0;
      }
      adjoint.noalias() += policy_.gains[j].transpose() * input_sum_;
    }
    outer_sum_.noalias() = input_sum_ * stage.points.col(particle).transpose();
    backward_nominal(j, input_sum_.data(), outer_sum_.data(), gradient);
  }
}

}  // namespace qsmpc::controller

#include "tests/support/plain_planner.hpp"

#include <algorithm>
#include <cmath>

#include "controller/prediction/moment_matching.hpp"
#include "tests/support/plain_penalty.hpp"

namespace qsmpc::testing {
namespace {

Eigen::VectorXd step(const models::Dynamics& dynamics, const Eigen::VectorXd& state,
                     const Eigen::VectorXd& input) {
  models::StateBatch next(state.size(), 1);
  dynamics.step(models::StateBatch(state), models::StateBatch(input), next);
  return next.col(0);
}

/// x̄_0, and x̄_{k+1} = f(x̄_k, v_k).
Eigen::MatrixXd nominal(const models::Dynamics& dynamics, const Eigen::VectorXd& start,
                        const Eigen::MatrixXd& inputs) {
  Eigen::MatrixXd states(start.size(), inputs.cols() + 1);
  states.col(0) = start;
  for (Eigen::Index k = 0; k < inputs.cols(); ++k) {
    states.col(k + 1) = step(dynamics, states.col(k), inputs.col(k));
  }
  return states;
}

/// sat(v_k + K_k (x − x̄_k)).
Eigen::VectorXd input_at(const controller::Policy& policy, Eigen::Index k,
                         const Eigen::VectorXd& state) {
  Eigen::VectorXd input = policy.inputs.col(k) + policy.gains[k] * (state - policy.states.col(k));
  for (Eigen::Index a = 0; a < input.size(); ++a) {
    input[a] = std::clamp(input[a], policy.bounds.lower[a], policy.bounds.upper[a]);
  }
  return input;
}

/// 1 − θ² of the laws that particles stand for (docs/theory/planning.md).
double lost_share(Eigen::Index count, Eigen::Index dim) {
  const double width =
      1.5 / std::pow(static_cast<double>(count), 1.0 / static_cast<double>(dim + 4));
  return std::min(1.0, width * width);
}

/// Σ share · stepped + offset for each destination.
std::vector<Eigen::VectorXd> moved(const std::vector<PlainDestination>& map,
                                   const std::vector<Eigen::VectorXd>& stepped) {
  std::vector<Eigen::VectorXd> result;
  for (const PlainDestination& destination : map) {
    Eigen::VectorXd place = destination.offset;
    for (const PlainShare& share : destination.shares) {
      place += share.share * stepped[share.source];
    }
    result.push_back(place);
  }
  return result;
}

/// The map of one stage, and the resulting weights.
struct Taken {
  std::vector<PlainDestination> map;
  std::vector<double> weights;
  double w2 = 0.0;
};

/// Moves the destinations: the optimal linear transport map from the covariance of the cells' means
/// to that of the mixture, applied to these means.
void displace(const PlainMixture& mixture, Taken& taken) {
  const Eigen::Index dim = mixture.cells[0].mean.size();
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(dim);
  double weight = 0.0;
  for (const PlainCell& cell : mixture.cells) {
    mean += cell.weight * cell.mean;
    weight += cell.weight;
  }
  mean /= weight;
  Eigen::MatrixXd between = Eigen::MatrixXd::Zero(dim, dim);
  Eigen::MatrixXd within = Eigen::MatrixXd::Zero(dim, dim);
  for (const PlainCell& cell : mixture.cells) {
    between += cell.weight * (cell.mean - mean) * (cell.mean - mean).transpose();
    within += cell.weight * cell.covariance;
  }
  const Eigen::MatrixXd spread = controller::spread_between(between, between + within);
  double cost = 0.0;
  for (std::size_t n = 0; n < mixture.cells.size(); ++n) {
    const Eigen::VectorXd offset = mixture.cells[n].mean - mean;
    const Eigen::VectorXd moved_by = spread * offset - offset;
    taken.map[n].offset += moved_by;
    cost += mixture.cells[n].weight * moved_by.squaredNorm();
  }
  taken.w2 = std::sqrt(mixture.w2 * mixture.w2 + cost);
}

Taken take_up_noise(const std::vector<Eigen::VectorXd>& stepped, const std::vector<double>& weights,
                    const PlainNoise& noise) {
  Taken taken;
  const Eigen::Index dim = stepped[0].size();
  if (noise.none) {
    for (std::size_t i = 0; i < stepped.size(); ++i) {
      taken.map.push_back(
          {.shares = {{static_cast<int>(i), 1.0}}, .offset = Eigen::VectorXd::Zero(dim)});
    }
    taken.weights = weights;
    return taken;
  }
  controller::Points sources(dim, stepped.size());
  for (std::size_t i = 0; i < stepped.size(); ++i) sources.col(i) = stepped[i];
  const PlainMixture mixture =
      plain_split(noise.covariance, noise.cells, noise.parts, sources,
                  Eigen::Map<const Eigen::VectorXd>(weights.data(), weights.size()));
  for (const PlainCell& cell : mixture.cells) {
    PlainDestination destination{.shares = {}, .offset = cell.noise_mean};
    for (const PlainPart& part : cell.parts) {
      destination.shares.push_back({part.source, part.mass / cell.weight});
    }
    taken.map.push_back(destination);
    taken.weights.push_back(cell.weight);
  }
  displace(mixture, taken);
  return taken;
}

/// One stage of the forward pass.
struct Stage {
  std::vector<Eigen::VectorXd> states;
  std::vector<Eigen::VectorXd> inputs;
  std::vector<std::vector<bool>> clamped;
  std::vector<Eigen::VectorXd> stepped;
  std::vector<Eigen::VectorXd> penalty_slope;  // of the weighted penalties
  std::vector<Eigen::VectorXd> bound_slope;    // of the weighted bound penalties, at `stepped`
};

class PlainHorizon {
 public:
  PlainHorizon(const controller::HorizonCostTerms& terms, const PlainPrediction& prediction,
               const controller::Policy& policy, bool optimises_gain)
      : terms_(terms),
        prediction_(prediction),
        policy_(policy),
        closed_(optimises_gain ||
                std::any_of(policy.gains.begin(), policy.gains.end(),
                            [](const Eigen::MatrixXd& gain) { return !gain.isZero(0.0); })),
        dim_(policy.states.rows()),
        horizon_(policy.horizon()) {}

  PlainCost run(const Eigen::MatrixXd& inputs, const Eigen::MatrixXd& gain_change) {
    policy_.inputs = inputs;
    policy_.states = nominal(terms_.dynamics, policy_.states.col(0), inputs);
    for (Eigen::MatrixXd& gain : policy_.gains) gain += gain_change;
    forward();
    backward();
    return result_;
  }

 private:
  [[nodiscard]] double weight(Eigen::Index k, std::size_t i) const {
    return prediction_.stages[k][i].weight;
  }

  /// W and factor of the state cost at stage k: ½ xᵀQx, and xᵀPx at the end.
  [[nodiscard]] const Eigen::MatrixXd& form(Eigen::Index k) const {
    return k == horizon_ ? terms_.cost.terminal : terms_.cost.state;
  }
  [[nodiscard]] double factor(Eigen::Index k) const { return k == horizon_ ? 1.0 : 0.5; }

  [[nodiscard]] double& part(std::string_view name) {
    return result_.parts[controller::cost_part(name)];
  }

  void add_state_cost(Eigen::Index k, double value) {
    part(k == horizon_ ? "terminal" : "state") += value;
  }

  /// Cost of the points before noise and compression, plus the noise's contribution.
  void price_states(Eigen::Index k, const std::vector<Eigen::VectorXd>& points,
                    const Eigen::MatrixXd& lost, Eigen::Index weights_of) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Eigen::VectorXd away = points[i] - terms_.cost.target;
      add_state_cost(k, factor(k) * weight(weights_of, i) * away.dot(form(k) * away));
    }
    add_state_cost(k, factor(k) * (form(k) * lost).trace());
  }

  void forward() {
    const PlainPenalty penalty(terms_.safe_set, terms_.penalty);
    stages_.assign(horizon_ + 1, {});
    for (const PlainParticle& particle : prediction_.stages[0]) {
      stages_[0].states.push_back(particle.state);
    }
    price_states(0, stages_[0].states, terms_.within_covariance, 0);
    for (Eigen::Index k = 0; k < horizon_; ++k) {
      Stage& stage = stages_[k];
      for (std::size_t i = 0; i < stage.states.size(); ++i) act(k, i);
      price_states(k + 1, stage.stepped, terms_.noise_covariance, k);
      evaluate_bounds(k, penalty);
      Stage& next = stages_[k + 1];
      next.states = moved(prediction_.maps[k], stage.stepped);
      for (std::size_t n = 0; n < next.states.size(); ++n) {
        Eigen::VectorXd slope = Eigen::VectorXd::Zero(dim_);
        const PenaltyValue value = penalty(next.states[n], slope);
        part("box") += weight(k + 1, n) * value.box;
        part("obstacle") += weight(k + 1, n) * value.obstacle;
        next.penalty_slope.emplace_back(weight(k + 1, n) * slope);
      }
    }
  }

  /// Bound penalties of the laws that the stepped particles stand for: mean m + θ (f_i − m),
  /// variance σ² + (1 − θ²) v (expected_bounds.hpp).
  void evaluate_bounds(Eigen::Index k, const PlainPenalty& penalty) {
    Stage& stage = stages_[k];
    const auto count = static_cast<Eigen::Index>(stage.stepped.size());
    const double smoothing = prediction_.compressed ? lost_share(count, dim_) : 0.0;
    const double share = std::sqrt(1.0 - smoothing);
    Eigen::VectorXd weights(count);
    Eigen::MatrixXd stepped(dim_, count);
    for (Eigen::Index i = 0; i < count; ++i) {
      weights[i] = weight(k, i);
      stepped.col(i) = stage.stepped[i];
    }
    const Eigen::VectorXd mean = stepped * weights;
    const Eigen::MatrixXd away = stepped.colwise() - mean;
    const Eigen::VectorXd variance = away.cwiseAbs2() * weights;
    const Eigen::VectorXd deviations =
        (terms_.noise_covariance.diagonal() + smoothing * variance).cwiseSqrt();
    Eigen::MatrixXd slopes;
    Eigen::VectorXd by_deviation;
    part("box") += penalty.of_bounds((share * away).colwise() + mean, weights, deviations, slopes,
                                     by_deviation);
    const Eigen::VectorXd by_mean = (1.0 - share) * slopes.rowwise().sum();
    for (Eigen::Index i = 0; i < count; ++i) {
      Eigen::VectorXd slope = share * slopes.col(i) + weights[i] * by_mean;
      for (Eigen::Index axis = 0; axis < dim_; ++axis) {
        if (deviations[axis] == 0.0) continue;
        slope[axis] +=
            by_deviation[axis] * smoothing * weights[i] * away(axis, i) / deviations[axis];
      }
      stage.bound_slope.push_back(slope);
    }
  }

  /// Input, its cost and the step of one particle.
  void act(Eigen::Index k, std::size_t i) {
    Stage& stage = stages_[k];
    const Eigen::VectorXd wanted =
        policy_.inputs.col(k) + policy_.gains[k] * (stage.states[i] - policy_.states.col(k));
    Eigen::VectorXd input = wanted;
    std::vector<bool> clamped(wanted.size(), false);
    for (Eigen::Index a = 0; a < wanted.size(); ++a) {
      input[a] = std::clamp(wanted[a], policy_.bounds.lower[a], policy_.bounds.upper[a]);
      clamped[a] =
          closed_ && (wanted[a] <= policy_.bounds.lower[a] || wanted[a] >= policy_.bounds.upper[a]);
    }
    part("input") += weight(k, i) * input.dot(terms_.cost.input * input);
    stage.stepped.push_back(step(terms_.dynamics, stage.states[i], input));
    stage.inputs.push_back(input);
    stage.clamped.push_back(clamped);
  }

  void backward() {
    const Eigen::Index inputs = policy_.inputs.rows();
    result_.input_gradient = Eigen::MatrixXd::Zero(inputs, horizon_);
    result_.gain_gradient = Eigen::MatrixXd::Zero(inputs, dim_);
    Eigen::VectorXd of_nominal = Eigen::VectorXd::Zero(dim_);
    std::vector<Eigen::VectorXd> of_next = stages_[horizon_].penalty_slope;
    for (Eigen::Index k = horizon_ - 1; k >= 0; --k) {
      std::vector<Eigen::VectorXd> of_stepped = through_map(k, of_next);
      of_next = through_step(k, of_stepped, of_nominal);
      if (k == 0) break;
      for (std::size_t i = 0; i < of_next.size(); ++i) of_next[i] += stages_[k].penalty_slope[i];
    }
  }

  [[nodiscard]] std::vector<Eigen::VectorXd> through_map(
      Eigen::Index k, const std::vector<Eigen::VectorXd>& of_next) const {
    const Stage& stage = stages_[k];
    std::vector<Eigen::VectorXd> of_stepped;
    for (std::size_t i = 0; i < stage.stepped.size(); ++i) {
      of_stepped.emplace_back(2.0 * factor(k + 1) * weight(k, i) *
                                  (form(k + 1) * (stage.stepped[i] - terms_.cost.target)) +
                              stage.bound_slope[i]);
    }
    for (std::size_t n = 0; n < of_next.size(); ++n) {
      for (const PlainShare& share : prediction_.maps[k][n].shares) {
        of_stepped[share.source] += share.share * of_next[n];
      }
    }
    return of_stepped;
  }

  /// Returns the adjoints of the states; replaces the adjoint of the next nominal state by that of
  /// stage k.
  std::vector<Eigen::VectorXd> through_step(Eigen::Index k,
                                            const std::vector<Eigen::VectorXd>& of_stepped,
                                            Eigen::VectorXd& of_nominal) {
    const Stage& stage = stages_[k];
    const Eigen::Index inputs = policy_.inputs.rows();
    Eigen::MatrixXd by_state(dim_, dim_);
    Eigen::MatrixXd by_input(dim_, inputs);
    const Eigen::VectorXd nominal = policy_.states.col(k);
    terms_.dynamics.jacobians(nominal, policy_.inputs.col(k), by_state, by_input);
    result_.input_gradient.col(k) += by_input.transpose() * of_nominal;
    of_nominal = by_state.transpose() * of_nominal;
    std::vector<Eigen::VectorXd> of_states;
    for (std::size_t i = 0; i < stage.states.size(); ++i) {
      terms_.dynamics.jacobians(stage.states[i], stage.inputs[i], by_state, by_input);
      Eigen::VectorXd of_input = by_input.transpose() * of_stepped[i] +
                                 2.0 * weight(k, i) * (terms_.cost.input * stage.inputs[i]);
      for (Eigen::Index a = 0; a < inputs; ++a) {
        if (stage.clamped[i][a]) of_input[a] = 0.0;
      }
      result_.input_gradient.col(k) += of_input;
      result_.gain_gradient += of_input * (stage.states[i] - nominal).transpose();
      of_nominal -= policy_.gains[k].transpose() * of_input;
      of_states.emplace_back(by_state.transpose() * of_stepped[i] +
                             policy_.gains[k].transpose() * of_input);
    }
    return of_states;
  }

  const controller::HorizonCostTerms& terms_;
  const PlainPrediction& prediction_;
  controller::Policy policy_;
  bool closed_;
  Eigen::Index dim_;
  Eigen::Index horizon_;
  std::vector<Stage> stages_;
  PlainCost result_;
};

}  // namespace

PlainPrediction plain_predict(const models::Dynamics& dynamics,
                              const controller::DiscreteMeasure& start,
                              const controller::Policy& policy, const PlainNoise& noise) {
  PlainPrediction prediction;
  prediction.compressed = !noise.none;
  prediction.stages.emplace_back();
  for (Eigen::Index i = 0; i < start.size(); ++i) {
    prediction.stages[0].push_back({start.locations.col(i), start.weights[i]});
  }
  for (Eigen::Index k = 0; k < policy.horizon(); ++k) {
    std::vector<Eigen::VectorXd> stepped;
    std::vector<double> weights;
    for (const PlainParticle& particle : prediction.stages[k]) {
      stepped.push_back(step(dynamics, particle.state, input_at(policy, k, particle.state)));
      weights.push_back(particle.weight);
    }
    const Taken taken = take_up_noise(stepped, weights, noise);
    const std::vector<Eigen::VectorXd> places = moved(taken.map, stepped);
    std::vector<PlainParticle> next;
    for (std::size_t n = 0; n < places.size(); ++n) next.push_back({places[n], taken.weights[n]});
    prediction.stages.push_back(next);
    prediction.maps.push_back(taken.map);
    prediction.w2.push_back(taken.w2);
  }
  return prediction;
}

PlainCost plain_cost(const controller::HorizonCostTerms& terms, const PlainPrediction& prediction,
                     const controller::Policy& policy, const Eigen::MatrixXd& inputs,
                     const Eigen::MatrixXd& gain_change, bool optimises_gain) {
  return PlainHorizon(terms, prediction, policy, optimises_gain).run(inputs, gain_change);
}

}  // namespace qsmpc::testing

#include "controller/prediction/prediction.hpp"

namespace qsmpc {

void predict(const Dynamics& dynamics, Propagator& propagator, const DiscreteMeasure& start,
             const Policy& policy, const Executor& run, PredictionScratch& scratch,
             Prediction& out) {
  const Eigen::Index horizon = policy.horizon();
  out.stages.resize(horizon + 1);
  out.stepped.resize(horizon);
  out.maps.resize(horizon);
  out.stages[0] = start;
  for (Eigen::Index k = 0; k < horizon; ++k) {
    const DiscreteMeasure& stage = out.stages[k];
    Points& stepped = out.stepped[k];
    scratch.inputs.resize(policy.inputs.rows(), stage.size());
    stepped.resize(stage.dim(), stage.size());
    policy_inputs(policy, k, stage.locations, scratch.inputs);
    dynamics.step(stage.locations, scratch.inputs, stepped);
    StageMap& map = out.maps[k];
    propagator.update(stepped, stage.weights, run, map);
    DiscreteMeasure& next = out.stages[k + 1];
    next.weights = map.weights;
    next.locations.resize(stage.dim(), map.clusters());
    if (!map.identity) {
      resize_packed(static_cast<int>(stage.dim()), stage.size(), scratch.packed);
      pack(stepped, 0, stage.size(), scratch.packed);
    }
    apply_shares(map, stepped, scratch.packed, 0, map.clusters(), next.locations);
    apply_spread(map, next.locations);
  }
}

Prediction predict(const Dynamics& dynamics, Propagator& propagator, const DiscreteMeasure& start,
                   const Policy& policy) {
  PredictionScratch scratch;
  Prediction prediction;
  predict(dynamics, propagator, start, policy, run_in_turn, scratch, prediction);
  return prediction;
}

}  // namespace qsmpc

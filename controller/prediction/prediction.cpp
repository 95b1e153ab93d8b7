#include "controller/prediction/prediction.hpp"

#include "controller/storage.hpp"

namespace qsmpc::controller {
namespace {

using Span = Eigen::Map<models::StateBatch>;

/// stepped = f(x, u) for the particles of stage k, also in packed form (`scratch.packed`).
void step_stage(const models::Dynamics& dynamics, const DiscreteMeasure& stage,
                const Policy& policy, Eigen::Index k, const Executor& run,
                PredictionScratch& scratch, Points& stepped) {
  const Eigen::Index inputs = policy.inputs.rows();
  stepped.resize(stage.dim(), stage.size());
  const std::size_t room = static_cast<std::size_t>(inputs * stage.size());
  make_room(scratch.inputs, room);
  scratch.inputs.resize(room);
  resize_packed(static_cast<int>(stage.dim()), stage.size(), scratch.packed);
  for_chunks(run, stage.size(), [&](ParticleRange range, int) {
    const Eigen::Index count = range.end - range.begin;
    const auto states = stage.locations.middleCols(range.begin, count);
    Span chosen(scratch.inputs.data() + inputs * range.begin, inputs, count);
    policy_inputs(policy, k, states, chosen);
    dynamics.step(states, chosen, stepped.middleCols(range.begin, count));
    pack(stepped, range.begin, range.end, scratch.packed);
  });
}

}  // namespace

Prediction without_shares(const Prediction& prediction) {
  Prediction result{.stages = prediction.stages, .stepped = prediction.stepped, .maps = {}};
  result.maps.reserve(prediction.maps.size());
  for (const StageMap& map : prediction.maps) {
    result.maps.push_back({.identity = map.identity,
                           .shares = {},
                           .offset = {},
                           .weights = map.weights,
                           .spread = map.spread,
                           .compression_w2 = map.compression_w2});
  }
  return result;
}

void predict(const models::Dynamics& dynamics, Propagator& propagator, const DiscreteMeasure& start,
             const Policy& policy, const Executor& run, PredictionScratch& scratch,
             Prediction& out) {
  const Eigen::Index horizon = policy.horizon();
  out.stages.resize(horizon + 1);
  out.stepped.resize(horizon);
  out.maps.resize(horizon);
  out.stages[0] = start;
  for (Eigen::Index k = 0; k < horizon; ++k) {
    const DiscreteMeasure& stage = out.stages[k];
    const Points& stepped = out.stepped[k];
    step_stage(dynamics, stage, policy, k, run, scratch, out.stepped[k]);
    StageMap& map = out.maps[k];
    propagator.update(stepped, stage.weights, run, map);
    DiscreteMeasure& next = out.stages[k + 1];
    next.weights = map.weights;
    next.locations.resize(stage.dim(), map.clusters());
    for_chunks(run, map.clusters(), [&](ParticleRange range, int) {
      apply_shares(map, stepped, scratch.packed, range.begin, range.end, next.locations);
    });
    apply_spread(map, next.locations);
  }
}

Prediction predict(const models::Dynamics& dynamics, Propagator& propagator,
                   const DiscreteMeasure& start, const Policy& policy) {
  PredictionScratch scratch;
  Prediction prediction;
  predict(dynamics, propagator, start, policy, run_in_turn, scratch, prediction);
  return prediction;
}

}  // namespace qsmpc::controller

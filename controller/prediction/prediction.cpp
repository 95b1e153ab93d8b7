#include "controller/prediction/prediction.hpp"

#include <utility>

namespace qsmpc {

Prediction predict(const Dynamics& dynamics, const Propagator& propagator,
                   const DiscreteMeasure& start, const Policy& policy) {
  Prediction prediction;
  prediction.stages.push_back(start);
  for (Eigen::Index k = 0; k < policy.horizon(); ++k) {
    const DiscreteMeasure& stage = prediction.stages.back();
    Points inputs(policy.inputs.rows(), stage.size());
    Points stepped(stage.dim(), stage.size());
    policy_inputs(policy, k, stage.locations, inputs);
    dynamics.step(stage.locations, inputs, stepped);
    StageMap map = propagator.stage_map(stepped, stage.weights);
    DiscreteMeasure next{.locations = Points(stage.dim(), map.clusters()), .weights = map.weights};
    apply_stage_map(map, stepped, next.locations);
    prediction.stepped.push_back(std::move(stepped));
    prediction.maps.push_back(std::move(map));
    prediction.stages.push_back(std::move(next));
  }
  return prediction;
}

}  // namespace qsmpc

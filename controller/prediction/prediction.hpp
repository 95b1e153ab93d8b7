// A discrete measure rolled forward along a horizon under a policy. `predict` records, for every
// stage, how the stepped points were combined with the noise and compressed, so that the same
// prediction can be re-evaluated with these assignments fixed.
#pragma once

#include <vector>

#include "controller/measure/measures.hpp"
#include "controller/prediction/model_error.hpp"
#include "controller/prediction/policy.hpp"
#include "controller/prediction/propagator.hpp"
#include "models/dynamics/dynamics.hpp"

#pragma GCC visibility push(default)

namespace qsmpc::controller {

/// The measures along the horizon under one policy.
struct Prediction {
  std::vector<DiscreteMeasure> stages;  ///< horizon + 1; stage 0 is the quantised belief
  std::vector<Points> stepped;          ///< horizon; f(c_i, u_i) of stage k's points
  std::vector<StageMap> maps;           ///< horizon; from stepped[k] to stages[k + 1]
};

/// A copy of `prediction` without the shares and offsets of its maps, which take by far the most
/// memory with many points. It suffices for certificates and reports, but cannot be evaluated
/// again.
[[nodiscard]] Prediction without_shares(const Prediction& prediction);

/// Scratch of a prediction; reused, it makes the next one allocation-free.
struct PredictionScratch {
  std::vector<double> inputs;
  PackedPoints packed;
};

/// Rolls `start` forward under `policy` into `out`, whose storage is reused; the assignments are
/// chosen for this motion.
void predict(const models::Dynamics& dynamics, Propagator& propagator, const DiscreteMeasure& start,
             const Policy& policy, const Executor& run, PredictionScratch& scratch,
             Prediction& out);

/// The same, returned by value.
[[nodiscard]] Prediction predict(const models::Dynamics& dynamics, Propagator& propagator,
                                 const DiscreteMeasure& start, const Policy& policy);

/// A prediction with all of its inputs, as certificates need them; refers to objects that must
/// outlive it.
struct PredictedMotion {
  const models::Dynamics& dynamics;
  const Eigen::MatrixXd& noise_covariance;  ///< of the model, state_dim x state_dim
  double noise_w2 = 0.0;                    ///< W2 between the noise and its discretisation
  const Gaussian& belief;                   ///< law of the state at stage 0
  double belief_w2 = 0.0;                   ///< W2 between the belief and prediction.stages[0]
  const Policy& policy;
  const Prediction& prediction;
  /// The plant's error against the model, period by period of a drive; null if the plant is the
  /// model.
  const ModelError* model_error = nullptr;
  /// The difference of the state at stage 0 from a variable with the law `belief`, if that is
  /// itself the model's prediction for a plant; null if the belief is the state's law. It describes
  /// one period: its `first` is ignored.
  const ModelError* belief_error = nullptr;
  /// The period of a drive that begins at stage 0: that of stage k is `first_period` + k.
  Eigen::Index first_period = 0;

  /// The plant's error in the period that begins at `stage`; null if the plant is the model.
  [[nodiscard]] const ModelError* error_at(Eigen::Index stage) const {
    return model_error == nullptr ? nullptr : &model_error->of_period(first_period + stage);
  }
};

}  // namespace qsmpc::controller

#pragma GCC visibility pop

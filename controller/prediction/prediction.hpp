// A discrete measure rolled forward along a horizon under a policy. `predict` records, for every
// stage, how the stepped points were combined with the noise and compressed, so that the same
// prediction can be evaluated again with these assignments held.
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

/// `prediction` without the shares and offsets of its maps, which are by far the most of it where
/// there are many points: what certificates and reports need. It can't be evaluated again.
[[nodiscard]] Prediction without_shares(const Prediction& prediction);

/// What a prediction works on, so that the next one allocates nothing.
struct PredictionScratch {
  std::vector<double> inputs;
  PackedPoints packed;
};

/// Rolls `start` forward under `policy`, with assignments that suit it, into `out`, whose storage
/// is reused.
void predict(const models::Dynamics& dynamics, Propagator& propagator, const DiscreteMeasure& start,
             const Policy& policy, const Executor& run, PredictionScratch& scratch,
             Prediction& out);

/// The same as a new value.
[[nodiscard]] Prediction predict(const models::Dynamics& dynamics, Propagator& propagator,
                                 const DiscreteMeasure& start, const Policy& policy);

/// A prediction with all that it was made from, as certificates need it; refers to objects that
/// must outlive it.
struct PredictedMotion {
  const models::Dynamics& dynamics;
  const Eigen::MatrixXd& noise_covariance;  ///< of the model, state_dim x state_dim
  double noise_w2 = 0.0;                    ///< W2 between the noise and what stands for it
  const Gaussian& belief;                   ///< law of the state at stage 0
  double belief_w2 = 0.0;                   ///< W2 between the belief and prediction.stages[0]
  const Policy& policy;
  const Prediction& prediction;
  /// What the plant adds to the model, period by period of a drive; null where the plant is the
  /// model.
  const ModelError* model_error = nullptr;
  /// What the state at stage 0 has beside a variable with the law `belief`, where that is itself
  /// the model's prediction for a plant; null where the belief is the state's law. It is said of
  /// one period: what it may have in `first` does not count.
  const ModelError* belief_error = nullptr;
  /// The period of a drive that begins at stage 0: that of stage k is `first_period` + k.
  Eigen::Index first_period = 0;

  /// What the plant adds in the period that begins at `stage`; null where it is the model.
  [[nodiscard]] const ModelError* error_at(Eigen::Index stage) const {
    return model_error == nullptr ? nullptr : &model_error->of_period(first_period + stage);
  }
};

}  // namespace qsmpc::controller

#pragma GCC visibility pop

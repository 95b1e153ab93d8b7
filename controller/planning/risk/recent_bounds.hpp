// The surrogate bounds of the policies certified last, so that none is certified twice: a plan asks
// for those of the same policy several times, to compare it, to optimise about it and to count
// entries.
#pragma once

#include <vector>

#include "controller/certification/surrogate_bounds.hpp"
#include "controller/measure/measures.hpp"
#include "controller/parallel.hpp"
#include "controller/prediction/policy.hpp"
#include "controller/prediction/prediction.hpp"
#include "controller/regions/unsafe_set.hpp"

namespace qsmpc::controller {

class RecentBounds {
 public:
  /// Keeps references to both.
  RecentBounds(const UnsafeSet& unsafe, const Executor& run) : unsafe_(unsafe), run_(run) {}

  /// surrogate_bounds(motion, …) with the least effort and NarrowCore::kIfTelling; valid until the
  /// next call. Since the last `forget`, only the policy and the belief may have changed.
  const SurrogateBounds& of(const PredictedMotion& motion);
  /// To be called if anything else has changed: the laws of moving obstacles, the period.
  void forget() { entries_.clear(); }

 private:
  struct Entry {
    Gaussian belief;
    Policy policy;
    SurrogateBounds bounds;

    [[nodiscard]] bool is_of(const PredictedMotion& motion) const;
  };

  const UnsafeSet& unsafe_;
  const Executor& run_;
  std::vector<Entry> entries_;  // the last used first
};

}  // namespace qsmpc::controller

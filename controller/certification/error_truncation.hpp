// A model error as a bound of one stage's error, cut off where it is large with a probability that
// certificates can afford. Derivation: docs/theory/surrogate.md, section 7.
#pragma once

#include <Eigen/Core>

#include "controller/certification/stage_error.hpp"
#include "controller/prediction/model_error.hpp"

namespace qsmpc::controller {

/// Norms of a model error less its offset, unknown ones infinite, and a size that it exceeds in no
/// coordinate but with a probability of at most `outside`.
struct TruncatedError {
  StageError bound;
  double outside = 0.0;
};

/// What surrogates with a core of `reach` standard deviations take for `error` less its offset, one
/// of `count` errors along a horizon, whatever the others are (count ≥ 1). All together exceed
/// their sizes with a probability of about 1e-6 where norms of order 8 are known, 1e-5 and 1e-4
/// where only those of order 4 and 2 are; and of 1e-3 for a core narrower than the wide one, whose
/// sizes are smaller.
[[nodiscard]] TruncatedError truncate_error(const ModelError& error, Eigen::Index count,
                                            double reach);

}  // namespace qsmpc::controller

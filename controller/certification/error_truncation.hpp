// A model error as a bound on one stage's error, truncated at sizes that it exceeds only with a
// probability that certificates can afford. Derivation: docs/theory/surrogate.md, section 7.
#pragma once

#include <Eigen/Core>

#include "controller/certification/stage_error.hpp"
#include "controller/prediction/model_error.hpp"

namespace qsmpc::controller {

/// Norms of a model error less its offset, infinite where unknown, and a size for each coordinate.
/// The probability that any coordinate exceeds its size is at most `outside`.
struct TruncatedError {
  StageError bound;
  double outside = 0.0;
};

/// The truncation of `error` less its offset for surrogates with a core of `reach` standard
/// deviations, as one of `count` ≥ 1 errors along a horizon, whatever the others are. The
/// probability that any of them exceeds its size is about 1e-6 where norms of order 8 are known,
/// and 1e-5 or 1e-4 where only those of order 4 or 2 are. For a core narrower than the wide one it
/// is 1e-3, with smaller sizes.
[[nodiscard]] TruncatedError truncate_error(const ModelError& error, Eigen::Index count,
                                            double reach);

}  // namespace qsmpc::controller

// How far particles are at least from the law of draws.
#pragma once

#include "controller/measure/measures.hpp"

namespace qsmpc::testing {

/// W2 between the particles and the draws (dim x count, of equal weight) in one coordinate: a lower
/// bound of the W2 of all.
[[nodiscard]] double marginal_w2(const controller::DiscreteMeasure& particles,
                                 const controller::Points& draws, Eigen::Index axis);

/// What is added to a bound of W2 between the particles and a law before the marginal W2 of `draws`
/// from this law is held against it, in one coordinate: W2 between n draws and their law is about
/// σ√(2.5/n) in one dimension, for normal laws; that it is three times as much does not happen in
/// some thousand comparisons, heavier tails included.
[[nodiscard]] double sampling_w2(const controller::Points& draws, Eigen::Index axis);

}  // namespace qsmpc::testing

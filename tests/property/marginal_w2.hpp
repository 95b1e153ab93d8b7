// A lower bound of the distance between particles and the law of draws.
#pragma once

#include "controller/measure/measures.hpp"

namespace qsmpc::testing {

/// W2 between the particles and the draws (dim x count, equally weighted) in one coordinate: a
/// lower bound of W2 in all coordinates.
[[nodiscard]] double marginal_w2(const controller::DiscreteMeasure& particles,
                                 const controller::Points& draws, Eigen::Index axis);

/// The tolerance added to a bound of W2 between particles and a law before it is compared with the
/// marginal W2 of `draws` from this law, in one coordinate. W2 between n draws and their law is
/// about σ√(2.5/n) in one dimension for normal laws; three times as much does not occur in some
/// thousand comparisons, even with heavier tails.
[[nodiscard]] double sampling_w2(const controller::Points& draws, Eigen::Index axis);

}  // namespace qsmpc::testing

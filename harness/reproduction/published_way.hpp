// The probability of the unsafe set as the thesis computes it, compared with valid bounds.
//
// Algorithm 3 takes a norm over the dimensions for the distance to the unsafe set and leaves
// obstacles out, which certifies less than the true probability. Algorithm 4 spends d · m against
// the radius where W2 calls for d² · m against its square, which is loose. Eq. 4-4 leaves the noise
// out of the radius.
#pragma once

#include <vector>

#include "controller/measure/measures.hpp"
#include "controller/regions/unsafe_set.hpp"
#include "harness/trace/trace.hpp"

namespace qsmpc::harness {

/// The worst case for one measure and radius, computed in three ways.
struct WorstCase {
  double published = 1.0;  ///< Algorithms 3 and 4 and Eq. 4-4 as printed: NOT a bound
  double distance = 1.0;   ///< Algorithm 4 with the true distance and radius: a bound
  double sound = 1.0;      ///< with the true distance and transport cost: C1
};

/// The radii of one measure: a bound of W2 between it and the law of the state, and the radius that
/// the thesis would use (Eq. 4-4, 4-6).
struct Radii {
  double sound = 0.0;
  double published = 0.0;
};

[[nodiscard]] WorstCase worst_cases(const controller::DiscreteMeasure& measure,
                                    const controller::UnsafeSet& unsafe, const Radii& radii);

/// The next step of a period, from the product of stepped points and noise points (Eq. 4-4) and
/// from the compressed measure (Eq. 4-6).
struct NextStepView {
  WorstCase plain;
  WorstCase compressed;
};

/// The views of every period of `trace`. Its plan is predicted again with the propagator
/// "compressed", that of the thesis, in place of the one that it was made with.
[[nodiscard]] std::vector<NextStepView> next_step_views(const Trace& trace);

}  // namespace qsmpc::harness

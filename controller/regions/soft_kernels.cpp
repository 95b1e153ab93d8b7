#include "controller/regions/soft_kernels.hpp"

#include <array>
#include <cmath>

#include <boost/math/quadrature/gauss.hpp>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "controller/regions/soft_kernels.cpp"
#include <hwy/foreach_target.h>

#include "controller/measure/normal/normal_cdf-inl.hpp"
#include "models/simd/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace qsmpc::controller {
namespace HWY_NAMESPACE {

using namespace models::HWY_NAMESPACE;

// Beyond this many standard deviations a normal tail is below kSoftMassError.
constexpr double kTailReach = 8.6;

/// The standard deviation, the reach and their inverses.
struct SoftScale {
  Vector deviation;
  Vector inverse;
  Vector reach;
  Vector inverse_square;  ///< of the reach
};

/// An upper bound of E[(1 − (D − y)²/t²); D − t ≤ y ≤ D] for y ~ N(0, s²), where `edge` holds the
/// values at D/s; zero where the expectation is less than kSoftMassError.
HWY_INLINE Vector before_wall(Vector wall, const NormalValues& edge, const SoftScale& scale) {
  const Vector s = scale.deviation;
  const Vector from = wall - scale.reach;
  const Vector tail = s * constant(kTailReach);
  const Mask near = hn::And(hn::Le(from, tail), hn::Ge(wall, zeros() - tail));
  const NormalValues low = normal_values(from * scale.inverse);
  const Vector mass = hn::Max(zeros(), edge.probability - low.probability);
  // s² α φ(α) = s (D − t) φ(α), and the same at D.
  const Vector first = s * (low.density - edge.density);
  const Vector second = s * (s * mass + from * low.density - wall * edge.density);
  const Vector squares = wall * (wall * mass - (first + first)) + second;
  const Vector allowance = constant(kSoftMomentError) * (wall * wall + s * s);
  const Vector value = mass - (squares - allowance) * scale.inverse_square;
  return hn::IfThenElseZero(near, hn::Min(hn::Max(value, zeros()), mass));
}

/// Which ends of an interval are finite.
struct FiniteEnds {
  bool lower;
  bool upper;
};

/// `below`: the interval's lower end less the mean; `above`: the mean less its upper end.
HWY_INLINE Vector soft_interval(Vector below, Vector above, const SoftScale& scale,
                                FiniteEnds finite) {
  Vector inside = constant(1.0);
  Vector before = zeros();
  if (finite.lower) {
    const NormalValues lower = normal_values(below * scale.inverse);
    inside = inside - lower.probability;
    before = before_wall(below, lower, scale);
  }
  if (finite.upper) {
    const NormalValues upper = normal_values(above * scale.inverse);
    inside = inside - upper.probability;
    before = before + before_wall(above, upper, scale);
  }
  const Vector value = hn::Max(inside, zeros()) + before + constant(kSoftMassError);
  return hn::Min(value, constant(1.0));
}

/// The same for a deviation of 0: (1 − dist²/t²)₊.
HWY_INLINE Vector hard_interval(Vector below, Vector above, const SoftScale& scale) {
  const Vector distance = hn::Max(hn::Max(below, above), zeros()) / scale.reach;
  return hn::Max(zeros(), constant(1.0) - distance * distance);
}

HWY_INLINE SoftScale scale_of(double deviation, Vector reach) {
  return {constant(deviation), constant(deviation > 0.0 ? 1.0 / deviation : 0.0), reach,
          constant(1.0) / (reach * reach)};
}

FiniteEnds finite_ends(const SoftInterval& interval) {
  return {.lower = std::isfinite(interval.lower), .upper = std::isfinite(interval.upper)};
}

void by_reach(const SoftInterval& interval, const double* reaches, std::size_t count, double* out) {
  const Vector below = constant(interval.lower);
  const Vector above = constant(-interval.upper);
  const bool spread = interval.deviation > 0.0;
  const FiniteEnds finite = finite_ends(interval);
  for_vectors(count, [&](std::size_t i, auto read, auto write, std::size_t) HWY_ATTR {
    // Lanes past the end read as zero; their results are not written.
    const SoftScale scale = scale_of(interval.deviation, read(reaches + i));
    write(spread ? soft_interval(below, above, scale, finite) : hard_interval(below, above, scale),
          out + i);
  });
}

void by_mean(const SoftInterval& interval, double t, const double* means, std::size_t count,
             double* out) {
  const Vector lower = constant(interval.lower);
  const Vector upper = constant(interval.upper);
  const SoftScale scale = scale_of(interval.deviation, constant(t));
  const bool spread = interval.deviation > 0.0;
  const FiniteEnds finite = finite_ends(interval);
  for_vectors(count, [&](std::size_t i, auto read, auto write, std::size_t) HWY_ATTR {
    const Vector mean = read(means + i);
    const Vector below = lower - mean;
    const Vector above = mean - upper;
    write(spread ? soft_interval(below, above, scale, finite) : hard_interval(below, above, scale),
          out + i);
  });
}

// Less than 1e-9 of the probability lies beyond it on either side.
constexpr double kEstimateReach = 6.0;
// A multiple of kLanes.
constexpr std::size_t kEstimateNodes = 16;

/// ∫ φ(x) [Φ((high − rx)/√(1 − r²)) − Φ((low − rx)/√(1 − r²))] dx by Gauss quadrature with the
/// given nodes and weights on [−1, 1].
double estimate_rectangle(const StandardRectangle& rectangle, double correlation,
                          const double* nodes, const double* weights) {
  const double from = std::fmax(rectangle.low[0], -kEstimateReach);
  const double to = std::fmin(rectangle.high[0], kEstimateReach);
  if (!(from < to)) return 0.0;
  const double inverse = 1.0 / std::sqrt((1.0 - correlation) * (1.0 + correlation));
  const double half = 0.5 * (to - from);
  Sum sum;
  for (std::size_t i = 0; i < kEstimateNodes; i += kWidth) {
    const Vector x = constant(0.5 * (from + to)) + constant(half) * load(nodes + i);
    const Vector shift = constant(correlation) * x;
    const Vector upper = (constant(rectangle.high[1]) - shift) * constant(inverse);
    const Vector lower = (constant(rectangle.low[1]) - shift) * constant(inverse);
    // Evaluated in the tail in which the interval lies.
    const Mask flip = hn::Gt(lower, zeros());
    const Vector far = normal_values(hn::IfThenElse(flip, zeros() - lower, upper)).probability;
    const Vector near = normal_values(hn::IfThenElse(flip, zeros() - upper, lower)).probability;
    const Vector mass = load(weights + i) * normal_values(x).density;
    sum.add(i / kWidth % kParts, mass * (far - near));
  }
  return half * sum.total();
}

}  // namespace HWY_NAMESPACE
}  // namespace qsmpc::controller
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace qsmpc::controller {

namespace {

/// Gauss quadrature rule for rectangle_estimate.
struct EstimateRule {
  static constexpr std::size_t kCount = HWY_NAMESPACE::kEstimateNodes;
  std::array<double, kCount> nodes;
  std::array<double, kCount> weights;

  EstimateRule() {
    using Half = boost::math::quadrature::gauss<double, kCount>;  // the other half is its mirror
    for (std::size_t i = 0; i < kCount / 2; ++i) {
      nodes[2 * i] = Half::abscissa()[i];
      nodes[2 * i + 1] = -nodes[2 * i];
      weights[2 * i] = weights[2 * i + 1] = Half::weights()[i];
    }
  }
};

}  // namespace

HWY_EXPORT(by_reach);
HWY_EXPORT(by_mean);
HWY_EXPORT(estimate_rectangle);

void soft_interval_by_reach(const SoftInterval& interval, const double* reaches, std::size_t count,
                            double* out) {
  HWY_DYNAMIC_DISPATCH(by_reach)(interval, reaches, count, out);
}

void soft_interval_by_mean(const SoftInterval& interval, double t, const double* means,
                           std::size_t count, double* out) {
  HWY_DYNAMIC_DISPATCH(by_mean)(interval, t, means, count, out);
}

double rectangle_estimate(const StandardRectangle& rectangle, double correlation) {
  static const EstimateRule rule;
  return HWY_DYNAMIC_DISPATCH(estimate_rectangle)(rectangle, correlation, rule.nodes.data(),
                                                  rule.weights.data());
}

}  // namespace qsmpc::controller
#endif

#include "harness/statistics/confidence_sequence.hpp"

#include <cmath>
#include <stdexcept>

#include <boost/math/special_functions/gamma.hpp>

namespace qsmpc::harness {
namespace {

constexpr double kPrior = 0.5;  // both parameters of the beta mixing distribution
constexpr int kHalvings = 60;   // bisection steps: enough for full double precision

double log_beta(double a, double b) {
  return boost::math::lgamma(a) + boost::math::lgamma(b) - boost::math::lgamma(a + b);
}

/// log pˢ (1 − p)ⁿ⁻ˢ, 0 < p < 1.
double log_likelihood(double events, double others, double p) {
  return events * std::log(p) + others * std::log1p(-p);
}

}  // namespace

RateInterval confidence_sequence(std::int64_t events, std::int64_t trials, double confidence) {
  if (events < 0 || events > trials || !(confidence > 0.0 && confidence < 1.0)) {
    throw std::invalid_argument("confidence sequence: an invalid count or confidence");
  }
  if (trials == 0) return {};
  const auto seen = static_cast<double>(events);
  const auto others = static_cast<double>(trials - events);
  // p is outside the interval where its log-likelihood is at most this.
  const double least =
      log_beta(kPrior + seen, kPrior + others) - log_beta(kPrior, kPrior) + std::log1p(-confidence);
  const double rate = seen / (seen + others);
  /// Bisects between `outside` and the observed rate, which is inside, for the outer side of the
  /// limit.
  const auto limit = [&](double outside) {
    double inside = rate;
    for (int n = 0; n < kHalvings; ++n) {
      const double middle = 0.5 * (outside + inside);
      (log_likelihood(seen, others, middle) > least ? inside : outside) = middle;
    }
    return outside;
  };
  return {.lower = events == 0 ? 0.0 : limit(0.0), .upper = events == trials ? 1.0 : limit(1.0)};
}

}  // namespace qsmpc::harness

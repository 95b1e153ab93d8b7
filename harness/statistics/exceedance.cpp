#include "harness/statistics/exceedance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace qsmpc::harness {
namespace {

constexpr int kIntervals = 20'000;  // of the quadrature: fine enough for the peak with 10⁶ events
constexpr double kNegligible = 60.0;    // e⁻⁶⁰ of the peak adds nothing in double precision
constexpr double kLargestTilt = 700.0;  // eᵗ is still finite

/// Logarithm of the integrand.
double log_density(const EventTally& tally, double tilt) {
  return static_cast<double>(tally.events) * tilt - tally.certified * std::expm1(tilt) -
         2.0 * std::log1p(tilt);
}

/// ln ∫₀^∞ exp(N t − S (eᵗ − 1)) (1 + t)⁻² dt by the trapezoidal rule; infinite where S = 0 < N.
double log_evidence(const EventTally& tally) {
  if (tally.certified == 0.0) {
    return tally.events == 0 ? 0.0 : std::numeric_limits<double>::infinity();
  }
  const double ratio = static_cast<double>(tally.events) / tally.certified;
  const double peak = std::log(std::max(ratio, 1.0));
  double end = peak + 1.0;
  while (end < kLargestTilt && log_density(tally, end) > log_density(tally, peak) - kNegligible) {
    end += 1.0;
  }
  const double width = end / kIntervals;
  const double scale = log_density(tally, peak);
  double sum = 0.0;
  for (int i = 0; i <= kIntervals; ++i) {
    const double weight = i == 0 || i == kIntervals ? 0.5 : 1.0;
    sum += weight * std::exp(log_density(tally, i * width) - scale);
  }
  return scale + std::log(sum * width);
}

}  // namespace

double exceedance_p_value(const std::vector<EventTally>& tallies) {
  if (tallies.empty()) throw std::invalid_argument("exceedance: no tally");
  double evidence = 0.0;
  for (const EventTally& tally : tallies) {
    if (tally.events < 0 || !(tally.certified >= 0.0)) {
      throw std::invalid_argument("exceedance: an invalid tally");
    }
    evidence += std::exp(log_evidence(tally));
  }
  return std::min(1.0, static_cast<double>(tallies.size()) / evidence);
}

void PeriodTallies::add(std::int64_t period, double certified, bool event) {
  EventTally& tally = tallies_[static_cast<std::size_t>(period % 2)];
  tally.certified += certified;
  tally.events += event ? 1 : 0;
}

void PeriodTallies::end_episode(std::int64_t periods, double certified) {
  add(periods, certified, false);
}

}  // namespace qsmpc::harness

#include "controller/certification/saturation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <boost/math/quadrature/gauss.hpp>

#include "controller/measure/normal/integer_power.hpp"
#include "controller/measure/normal/normal_distribution.hpp"

namespace qsmpc::controller {
namespace {

// Bounds the rounding that cancellation in a difference can leave, relative to its terms.
constexpr double kQuadratureRounding = 16.0 * std::numeric_limits<double>::epsilon();

// Quadrature of moments: its reach in deviations, and a bound on its relative error.
constexpr int kQuadratureReach = 12;
constexpr double kQuadratureError = 1e-8;

/// Upper bound of E[|q/s|^p; |Z| > reach]. There |q/s| ≤ 3|Z|: a mean within `reach` deviations of
/// E sat contributes at most that, Z and the fit |Z| each; for a mean further away, the clamp is
/// constant up to the reach. E[Z^p; |Z| > r] is at most 2 r^{p−1} φ(r)/(1 − p/r²).
double beyond_reach(int order) {
  const double squared = kQuadratureReach * kQuadratureReach;
  return 2.0 * integer_power(3.0, order) * integer_power(kQuadratureReach, order - 1) *
         normal_density(kQuadratureReach) / (1.0 - order / squared);
}

/// E (Z − z)₊ and E (Z − z)₊² for Z ~ N(0, 1).
struct Excess {
  double first;
  double second;
  double rounding;  ///< bounds the error of `second`
};

Excess excess(double z) {
  const double tail = normal_cumulative(-z);
  const double density = normal_density(z);
  // In the tail the two terms nearly cancel, and the density of z has z² roundings.
  const double roundings = z > 0.0 ? 1.0 + z * z : 1.0;
  return {.first = std::max(0.0, density - z * tail),
          .second = std::max(0.0, (1.0 + z * z) * tail - z * density),
          .rounding = kQuadratureRounding * std::max(0.0, roundings * (1.0 + z * z) * tail)};
}

using Rule = boost::math::quadrature::gauss<double, 10>;  // half of the nodes; they are symmetric

/// A node of a quadrature over z ~ N(0, 1): its weight times the density.
struct NormalNode {
  double z;
  double mass;
};

using PanelNodes =
    std::array<NormalNode, 2 * std::tuple_size_v<std::decay_t<decltype(Rule::abscissa())>>>;

/// Nodes over [from, to], at most one deviation wide: ten integrate what is smooth there exactly up
/// to rounding.
PanelNodes panel_nodes(double from, double to) {
  PanelNodes nodes;
  const double half = 0.5 * (to - from);
  const double centre = 0.5 * (from + to);
  for (std::size_t i = 0; i < Rule::abscissa().size(); ++i) {
    for (const int side : {0, 1}) {
      const double offset = half * Rule::abscissa()[i];
      const double z = side == 0 ? centre - offset : centre + offset;
      nodes[2 * i + side] = {.z = z, .mass = half * Rule::weights()[i] * normal_density(z)};
    }
  }
  return nodes;
}

constexpr int kUnitPanels = 2 * kQuadratureReach;

/// The panels between integer multiples of the deviation, up to the reach.
std::array<PanelNodes, kUnitPanels> nodes_of_unit_panels() {
  std::array<PanelNodes, kUnitPanels> panels;
  for (int i = 0; i < kUnitPanels; ++i) {
    panels[i] = panel_nodes(i - kQuadratureReach, i + 1 - kQuadratureReach);
  }
  return panels;
}

}  // namespace

// With h = (upper − m)/s and l = (m − lower)/s, sat(ℓ) − m = s (Z − (Z − h)₊ + (−Z − l)₊). The two
// excesses o, u are never both positive, so that with p, q the tails beyond h and l
//     E sat = m + s (E u − E o),  slope = E[(Z − o + u) Z] = 1 − p − q,
// and the residual is r = (p + q) Z − o + u − E(u − o), whose variance
//     Var(u − o) − (p + q)²
// vanishes with the excesses themselves: no difference of numbers of order one is taken.
SaturationFit fit_saturation(double mean, double deviation, double lower, double upper) {
  if (!(deviation > 0.0)) {
    const bool inside = mean > lower && mean < upper;
    return {.mean = std::clamp(mean, lower, upper), .slope = inside ? 1.0 : 0.0, .residual = 0.0};
  }
  const double high = (upper - mean) / deviation;
  const double low = (mean - lower) / deviation;
  const Excess over = excess(high);
  const Excess under = excess(low);
  const double outside = normal_cumulative(-high) + normal_cumulative(-low);
  const double shift = under.first - over.first;
  const double squares = over.second + under.second;
  const double variance = squares - shift * shift - outside * outside;
  return {
      .mean = std::clamp(mean + deviation * shift, lower, upper),
      .slope = std::clamp(1.0 - outside, 0.0, 1.0),
      .residual = deviation * std::sqrt(std::max(0.0, variance) + over.rounding + under.rounding)};
}

std::array<double, kHigherOrders.size()> saturation_residual_norms(const SaturationFit& fit,
                                                                   double mean, double deviation,
                                                                   double lower, double upper) {
  std::array<double, kHigherOrders.size()> norms{};
  if (!std::isfinite(mean) || !std::isfinite(deviation)) {
    norms.fill(std::numeric_limits<double>::infinity());
    return norms;
  }
  if (deviation <= 0.0) return norms;
  // q/s is that of a standard normal variable with these bounds.
  const double low = (lower - mean) / deviation;
  const double high = (upper - mean) / deviation;
  const double centre = (fit.mean - mean) / deviation;
  const auto add = [&](const PanelNodes& panel) {
    for (std::size_t node = 0; node < panel.size(); ++node) {
      const double z = panel[node].z;
      const double q = std::clamp(z, low, high) - centre - fit.slope * z;
      for (std::size_t k = 0; k < norms.size(); ++k) {
        norms[k] += panel[node].mass * integer_power(q, kHigherOrders[k]);
      }
    }
  };
  static const std::array<PanelNodes, kUnitPanels> unit_panels = nodes_of_unit_panels();
  for (int i = 0; i < kUnitPanels; ++i) {
    // The integrand is smooth between the kinks of the clamp.
    const double from = i - kQuadratureReach;
    const double to = from + 1.0;
    const double first = std::clamp(low, from, to);
    const double second = std::clamp(high, from, to);
    const bool bends = (first > from && first < to) || (second > from && second < to);
    if (!bends) {
      add(unit_panels[i]);
      continue;
    }
    add(panel_nodes(from, first));
    add(panel_nodes(first, second));
    add(panel_nodes(second, to));
  }
  for (std::size_t k = 0; k < norms.size(); ++k) {
    const double total = norms[k] + beyond_reach(kHigherOrders[k]);
    norms[k] = deviation * (1.0 + kQuadratureError) * std::pow(total, 1.0 / kHigherOrders[k]);
  }
  return norms;
}

double largest_saturation_residual(const SaturationFit& fit, double mean, double reach,
                                   double lower, double upper) {
  // Piecewise linear: its extremes are at the ends or at the kinks of the clamp.
  double largest = 0.0;
  for (const double wanted : {-reach, reach, lower - mean, upper - mean}) {
    const double s = std::clamp(wanted, -reach, reach);
    const double residual = std::clamp(mean + s, lower, upper) - fit.mean - fit.slope * s;
    largest = std::max(largest, std::abs(residual));
  }
  return largest;
}

}  // namespace qsmpc::controller

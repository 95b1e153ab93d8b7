#include "harness/statistics/chi_squared.hpp"

#include <cmath>

#include <boost/math/distributions/chi_squared.hpp>

#include "models/constants.hpp"

namespace qsmpc::harness {

double chi_squared_tail(double value, int degrees) {
  if (!std::isfinite(value)) return kNotANumber;
  const boost::math::chi_squared_distribution<double> law(degrees);
  return boost::math::cdf(boost::math::complement(law, value));
}

}  // namespace qsmpc::harness

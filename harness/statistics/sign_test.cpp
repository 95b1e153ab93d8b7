#include "harness/statistics/sign_test.hpp"

#include <algorithm>
#include <stdexcept>

#include <boost/math/distributions/binomial.hpp>

namespace qsmpc::harness {

double sign_test_p_value(std::int64_t higher, std::int64_t lower) {
  if (higher < 0 || lower < 0) throw std::invalid_argument("sign test: a negative number of pairs");
  if (higher + lower == 0) return 1.0;
  const boost::math::binomial_distribution<double> equal(static_cast<double>(higher + lower), 0.5);
  return std::min(1.0, 2.0 * boost::math::cdf(equal, static_cast<double>(std::min(higher, lower))));
}

}  // namespace qsmpc::harness

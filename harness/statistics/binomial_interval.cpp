#include "harness/statistics/binomial_interval.hpp"

#include <stdexcept>

#include <boost/math/distributions/binomial.hpp>

namespace qsmpc::harness {

RateInterval clopper_pearson(std::int64_t events, std::int64_t trials, double tail) {
  if (trials < 1 || events < 0 || events > trials || !(tail > 0.0 && tail < 1.0)) {
    throw std::invalid_argument("Clopper-Pearson: an invalid count or confidence");
  }
  using Binomial = boost::math::binomial_distribution<double>;
  const auto n = static_cast<double>(trials);
  const auto k = static_cast<double>(events);
  return {.lower = Binomial::find_lower_bound_on_p(n, k, tail),
          .upper = Binomial::find_upper_bound_on_p(n, k, tail)};
}

}  // namespace qsmpc::harness

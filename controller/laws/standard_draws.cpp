#include "controller/laws/standard_draws.hpp"

#include <cmath>
#include <numbers>

#include <boost/math/special_functions/erf.hpp>

#include "models/random/random_numbers.hpp"

namespace qsmpc::controller {
namespace {

bool is_prime(int number) {
  for (int divisor = 2; divisor * divisor <= number; ++divisor) {
    if (number % divisor == 0) return false;
  }
  return true;
}

}  // namespace

double normal_quantile(double probability) {
  return -std::numbers::sqrt2 * boost::math::erfc_inv(2.0 * probability);
}

StandardDraws random_draws(Eigen::Index dim, Eigen::Index count, std::uint64_t seed) {
  StandardDraws draws{.choices = Eigen::VectorXd(count), .normals = Points(dim, count)};
  for (Eigen::Index i = 0; i < count; ++i) {
    models::RandomKey key{.seed = seed,
                          .episode = kFirstLawDraw + static_cast<std::uint64_t>(i),
                          .stream = models::RandomStream::kPrediction};
    draws.normals.col(i) = models::standard_normal_sample(dim, key);
    key.step = 1;
    draws.choices[i] = models::uniform_sample(1, key)[0];
  }
  return draws;
}

StandardDraws quasi_random_draws(Eigen::Index dim, Eigen::Index count) {
  StandardDraws draws{.choices = Eigen::VectorXd(count), .normals = Points(dim, count)};
  const auto size = static_cast<double>(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    draws.choices[i] = (static_cast<double>(i) + 0.5) / size;
  }
  int prime = 1;
  for (Eigen::Index axis = 0; axis < dim; ++axis) {
    do ++prime;
    while (!is_prime(prime));
    const double root = std::sqrt(static_cast<double>(prime));
    for (Eigen::Index i = 0; i < count; ++i) {
      // Half an index further, so that no point is 0; multiples of irrational numbers never are.
      const double multiple = (static_cast<double>(i) + 0.5) * root;
      draws.normals(axis, i) = normal_quantile(multiple - std::floor(multiple));
    }
  }
  return draws;
}

}  // namespace qsmpc::controller

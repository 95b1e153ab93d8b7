#include "tests/property/random_draws.hpp"

#include <cmath>

namespace qsmpc::testing {

double uniform(Generator& generator, double lower, double upper) {
  return std::uniform_real_distribution<double>(lower, upper)(generator);
}

int uniform_int(Generator& generator, int lower, int upper) {
  return std::uniform_int_distribution<int>(lower, upper)(generator);
}

bool chance(Generator& generator, double probability) {
  return uniform(generator, 0.0, 1.0) < probability;
}

double log_uniform(Generator& generator, double low, double high) {
  return std::pow(10.0, uniform(generator, low, high));
}

Eigen::VectorXd uniform_vector(Generator& generator, Eigen::Index size, double lower,
                               double upper) {
  return Eigen::VectorXd::NullaryExpr(size, [&] { return uniform(generator, lower, upper); });
}

Eigen::MatrixXd random_covariance(Generator& generator, Eigen::Index dim, double low, double high) {
  const Eigen::MatrixXd root =
      Eigen::MatrixXd::NullaryExpr(dim, dim, [&] { return uniform(generator, -1.0, 1.0); });
  Eigen::MatrixXd covariance = root * root.transpose() + 0.05 * Eigen::MatrixXd::Identity(dim, dim);
  if (chance(generator, 0.3)) {
    const Eigen::VectorXd diagonal = covariance.diagonal();
    covariance = diagonal.asDiagonal();
  }
  Eigen::VectorXd scale =
      Eigen::VectorXd::NullaryExpr(dim, [&] { return log_uniform(generator, low, high); });
  if (chance(generator, 0.1)) {
    scale[uniform_int(generator, 0, static_cast<int>(dim) - 1)] = 0.0;
  }
  const Eigen::VectorXd factor = scale.cwiseQuotient(covariance.diagonal().cwiseSqrt());
  covariance = (factor.asDiagonal() * covariance * factor.asDiagonal()).eval();
  return 0.5 * (covariance + covariance.transpose());
}

}  // namespace qsmpc::testing

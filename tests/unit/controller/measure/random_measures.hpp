// Random matrices, Gaussians and samples with fixed seeds.
#pragma once

#include <cmath>
#include <random>

#include <Eigen/Core>

#include "controller/measure/measures.hpp"
#include "models/linear_algebra.hpp"

namespace qsmpc::testing {

using Generator = std::mt19937_64;

inline double uniform(Generator& generator, double lower, double upper) {
  return std::uniform_real_distribution<double>(lower, upper)(generator);
}

inline Eigen::MatrixXd random_matrix(Generator& generator, Eigen::Index rows, Eigen::Index cols,
                                     double scale = 1.0) {
  return Eigen::MatrixXd::NullaryExpr(rows, cols,
                                      [&] { return uniform(generator, -scale, scale); });
}

/// Symmetric, positive definite, not diagonal.
inline Eigen::MatrixXd random_spd(Generator& generator, Eigen::Index dim, double scale = 1.0) {
  const Eigen::MatrixXd root = random_matrix(generator, dim, dim);
  return scale * (root * root.transpose() + 0.1 * Eigen::MatrixXd::Identity(dim, dim));
}

inline controller::DiscreteMeasure random_measure(Generator& generator, Eigen::Index dim,
                                                  Eigen::Index size) {
  controller::DiscreteMeasure measure{.locations = random_matrix(generator, dim, size, 2.0),
                                      .weights = random_matrix(generator, size, 1).cwiseAbs()};
  measure.weights.array() += 0.01;
  measure.weights /= measure.weights.sum();
  return measure;
}

/// Draws from N(0, covariance), singular covariances included.
class NormalSampler {
 public:
  explicit NormalSampler(const Eigen::MatrixXd& covariance) {
    const models::SymmetricEigen eigen = models::symmetric_eigen(covariance);
    root_ = eigen.vectors * eigen.values.cwiseMax(0.0).cwiseSqrt().asDiagonal();
  }
  [[nodiscard]] Eigen::VectorXd operator()(Generator& generator) {
    Eigen::VectorXd standard(root_.cols());
    for (double& entry : standard) entry = normal_(generator);
    return root_ * standard;
  }

 private:
  Eigen::MatrixXd root_;
  std::normal_distribution<double> normal_;
};

}  // namespace qsmpc::testing

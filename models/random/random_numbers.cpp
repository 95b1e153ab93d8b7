#include "models/random/random_numbers.hpp"

#include <array>
#include <cstddef>
#include <stdexcept>
#include <utility>

#include <Random123/boxmuller.hpp>
#include <Random123/philox.h>
#include <Random123/uniform.hpp>

#include "models/linear_algebra.hpp"

namespace qsmpc::models {
namespace {

using Generator = r123::Philox4x64;
constexpr Eigen::Index kBlock = 4;  // numbers per call of the generator

// Eigenvalues this far below zero, relative to the largest, are rounding errors.
constexpr double kRelativeRounding = 1e-12;

std::array<std::uint64_t, kBlock> random_block(const RandomKey& key, Eigen::Index block) {
  const Generator::ctr_type counter = {
      {key.step, static_cast<std::uint64_t>(key.stream), static_cast<std::uint64_t>(block), 0}};
  const Generator::ctr_type bits = Generator()(counter, {{key.seed, key.episode}});
  return {bits[0], bits[1], bits[2], bits[3]};
}

Eigen::MatrixXd symmetric_root(const Eigen::MatrixXd& covariance) {
  const double scale = covariance.cwiseAbs().maxCoeff();
  if (!covariance.isApprox(covariance.transpose(), kRelativeRounding)) {
    throw std::invalid_argument("the covariance is not symmetric");
  }
  const SymmetricEigen eigen = symmetric_eigen(covariance);
  if (eigen.values.minCoeff() < -kRelativeRounding * scale) {
    throw std::invalid_argument("the covariance is not positive semidefinite");
  }
  const Eigen::VectorXd deviations = eigen.values.cwiseMax(0.0).cwiseSqrt();
  return eigen.vectors * deviations.asDiagonal() * eigen.vectors.transpose();
}

}  // namespace

Eigen::VectorXd standard_normal_sample(Eigen::Index count, const RandomKey& key) {
  Eigen::VectorXd values(count);
  standard_normals(key, {values.data(), static_cast<std::size_t>(count)});
  return values;
}

void standard_normals(const RandomKey& key, std::span<double> out) {
  for (std::size_t i = 0; i < out.size(); i += kBlock) {
    const auto bits = random_block(key, static_cast<Eigen::Index>(i) / kBlock);
    const r123::double2 first = r123::boxmuller(bits[0], bits[1]);
    const r123::double2 second = r123::boxmuller(bits[2], bits[3]);
    const std::array<double, kBlock> block{first.x, first.y, second.x, second.y};
    for (std::size_t k = 0; k < kBlock && i + k < out.size(); ++k) out[i + k] = block[k];
  }
}

Eigen::VectorXd uniform_sample(Eigen::Index count, const RandomKey& key) {
  Eigen::VectorXd values(count);
  for (Eigen::Index i = 0; i < count; i += kBlock) {
    const auto bits = random_block(key, i / kBlock);
    for (Eigen::Index k = 0; k < kBlock && i + k < count; ++k) {
      values[i + k] = r123::u01<double>(bits[k]);
    }
  }
  return values;
}

void random_words(const RandomKey& key, std::span<std::uint64_t> out) {
  for (std::size_t i = 0; i < out.size(); i += kBlock) {
    const auto bits = random_block(key, static_cast<Eigen::Index>(i) / kBlock);
    for (std::size_t k = 0; k < kBlock && i + k < out.size(); ++k) out[i + k] = bits[k];
  }
}

GaussianSampler::GaussianSampler(Eigen::VectorXd mean, const Eigen::MatrixXd& covariance)
    : mean_(std::move(mean)) {
  const Eigen::Index n = mean_.size();
  if (n == 0 || covariance.rows() != n || covariance.cols() != n) {
    throw std::invalid_argument("the sizes of mean and covariance do not agree");
  }
  if (!mean_.allFinite() || !covariance.allFinite()) {
    throw std::invalid_argument("the mean or the covariance is not finite");
  }
  root_ = symmetric_root(covariance);
}

Eigen::VectorXd GaussianSampler::sample(const RandomKey& key) const {
  return mean_ + root_ * standard_normal_sample(mean_.size(), key);
}

}  // namespace qsmpc::models

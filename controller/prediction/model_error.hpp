// The error of the model of a plant: what is known about e in x⁺ = f(x, u) + e + w, w the model's
// noise.
//
// e may depend in any way on everything before w enters, but not on w, which is independent of that
// past. The norms of e less a known offset are bounded coordinate by coordinate: the first periods
// of a drive, during start-up transients of the plant, have bounds of their own, and all later
// periods share the same ones. Certificates computed with these bounds hold for the plant:
// docs/theory/surrogate.md, section 7.
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "controller/measure/normal/norm_orders.hpp"

#pragma GCC visibility push(default)

namespace qsmpc::controller {

struct ModelError {
  Eigen::VectorXd mean;              ///< n, information only; empty where unknown
  Eigen::MatrixXd covariance;        ///< n x n, information only; empty where unknown
  Eigen::VectorXd root_mean_square;  ///< n, bounds √E(e − m)_i², in the states' units; finite
  HigherNorms higher;  ///< n each, bounds (E|(e − m)_i|^p)^{1/p}; infinite where unknown
  /// If set, bounds √E|e|² in place of √Σ (|m_i| + root_mean_square_i)².
  std::optional<double> stated_radius{};
  Eigen::VectorXd offset{};  ///< n, m, known and the same on every path; empty where it is zero
  /// The errors in periods 0, 1, … of a drive, where they differ from that in all later periods,
  /// which the other members describe. Their own `first` is empty.
  std::vector<ModelError> first{};

  /// The error in period `period` ≥ 0 of a drive.
  [[nodiscard]] const ModelError& of_period(Eigen::Index period) const;

  /// Bounds √E|e|², and so W2 between e and zero: the stated radius, else
  /// √Σ (|m_i| + root_mean_square_i)².
  [[nodiscard]] double radius() const;
};

/// An error with this root mean square, of which nothing else is known.
[[nodiscard]] ModelError model_error_of_size(const Eigen::VectorXd& root_mean_square);

/// Mean, covariance (over `count`, not count − 1) and norms of samples e = x⁺ − f(x, u) − w, or of
/// what bounds e. residuals: state_dim x count, finite. The norms are those of the samples, without
/// a margin for their finite number, which the caller adds (`widened`).
/// Throws std::invalid_argument without samples.
[[nodiscard]] ModelError model_error_of(const Eigen::Ref<const Eigen::MatrixXd>& residuals);

/// `error` with all norms and the stated radius multiplied by `factor` > 0, in all periods; means,
/// covariances and offsets are unchanged.
[[nodiscard]] ModelError widened(ModelError error, double factor);

}  // namespace qsmpc::controller

#pragma GCC visibility pop

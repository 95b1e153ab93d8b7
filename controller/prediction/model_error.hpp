// How far a plant is from the model: what is known of e in x⁺ = f(x, u) + e + w, w the model's
// noise.
//
// e may depend in any way on everything up to the moment before w comes in, but not on w, which is
// independent of that past. Of e less a known offset the norms are bounded coordinate by
// coordinate: in the first periods of a drive, while what is at rest in the plant comes up, by
// their own, and the same at every period after them. Certificates that are given them hold for the
// plant: docs/theory/surrogate.md, section 7.
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
  /// What bounds √E|e|² in place of √Σ (|m_i| + root_mean_square_i)².
  std::optional<double> stated_radius{};
  Eigen::VectorXd offset{};  ///< n, m, known and the same on every path; empty where it is zero
  /// Of periods 0, 1, … of a drive, where they differ from all later ones, of which the above is
  /// said; none of these has any of its own.
  std::vector<ModelError> first{};

  /// What is said of period `period` ≥ 0 of a drive.
  [[nodiscard]] const ModelError& of_period(Eigen::Index period) const;

  /// Bounds √E|e|², and so W2 between e and none: the stated radius, else
  /// √Σ (|m_i| + root_mean_square_i)².
  [[nodiscard]] double radius() const;
};

/// An error of this root mean square of which nothing else is known.
[[nodiscard]] ModelError model_error_of_size(const Eigen::VectorXd& root_mean_square);

/// Mean, covariance (over `count`, not count − 1) and norms of samples e = x⁺ − f(x, u) − w, or of
/// what bounds e. residuals: state_dim x count, finite. The norms are those of the samples as they
/// are: what finitely many samples leave open is for the caller to add (`widened`).
/// Throws std::invalid_argument without samples.
[[nodiscard]] ModelError model_error_of(const Eigen::Ref<const Eigen::MatrixXd>& residuals);

/// `error` with all norms, and the stated radius, `factor` > 0 times as large, of all periods;
/// means, covariances and offsets stay what they are.
[[nodiscard]] ModelError widened(ModelError error, double factor);

}  // namespace qsmpc::controller

#pragma GCC visibility pop

// Statistics of a plant's one-step residuals against the model: their size, whether they are white
// or autocorrelated, and what is attributable to chance or rounding.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace qsmpc::harness {

/// Tests whether residuals are white: whether the residual of a period carries no information about
/// the next one. Not a number where a residual is constant.
struct Whiteness {
  int lags = 0;                 ///< periods that `ljung_box` looks back
  Eigen::VectorXd lag1;         ///< autocorrelation from one period to the next, by state
  double lag1_deviation = 0.0;  ///< standard deviation of `lag1` where residuals are white
  Eigen::VectorXd ljung_box;    ///< by state: about χ² with `lags` degrees of freedom if white
  Eigen::VectorXd p_value;      ///< probability that a χ² variable is at least as large, by state
};

/// Statistics of residuals r in the units of the states; n: state_dim.
struct ResidualStatistics {
  std::int64_t periods = 0;
  Eigen::VectorXd mean;
  Eigen::VectorXd mean_deviation;  ///< standard error of `mean`, episodes being independent;
                                   ///< not a number for a single episode
  Eigen::MatrixXd covariance;      ///< n x n, divided by `periods`, not periods − 1
  Eigen::VectorXd rmse;            ///< √(mean r²)
  Eigen::VectorXd rounding;        ///< an `rmse` below this is rounding: the plant is the model
  Whiteness whiteness;
};

/// The maximum number of periods that `Whiteness::ljung_box` looks back.
inline constexpr int kMostLags = 10;

/// episodes: the residuals of each, state_dim x periods, in the order of time; products of
/// residuals of two episodes are never formed. magnitude: the largest |state| that occurred, by
/// state (state_dim), which determines the size of rounding errors. Without residuals, everything
/// is zero and the autocorrelations are not a number.
///
/// With m the mean over all, c_h = Σ (r_k − m)(r_{k+h} − m) over the N_h pairs h periods apart
/// within an episode, N of them for h = 0: the autocorrelation is c_h/c_0, its variance for white
/// Gaussian residuals N_h/(N (N + 2)), and the statistic N (N + 2) Σ_h (c_h/c_0)²/N_h, which for a
/// single episode is that of Ljung and Box ("On a measure of lack of fit in time series models",
/// Biometrika 65, 1978).
[[nodiscard]] ResidualStatistics residual_statistics(const std::vector<Eigen::MatrixXd>& episodes,
                                                     const Eigen::VectorXd& magnitude);

}  // namespace qsmpc::harness

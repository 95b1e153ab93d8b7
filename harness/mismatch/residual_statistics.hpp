// What one-step residuals of a plant against the model say: how large they are, whether they are
// noise or have a memory, and what of it is no more than chance or rounding.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace qsmpc::harness {

/// Whether residuals are white: whether what a period leaves unexplained says nothing of the next
/// one. Not a number where a residual never changes.
struct Whiteness {
  int lags = 0;                 ///< periods that `ljung_box` looks back
  Eigen::VectorXd lag1;         ///< autocorrelation from one period to the next, by state
  double lag1_deviation = 0.0;  ///< standard deviation of `lag1` where residuals are white
  Eigen::VectorXd ljung_box;    ///< by state: about χ² of `lags` degrees of freedom where white
  Eigen::VectorXd p_value;      ///< probability that a χ² variable is that large, by state
};

/// Of residuals r in the units of the states; n: state_dim.
struct ResidualStatistics {
  std::int64_t periods = 0;
  Eigen::VectorXd mean;
  Eigen::VectorXd mean_deviation;  ///< standard error of `mean`, whole episodes being independent;
                                   ///< not a number for a single one
  Eigen::MatrixXd covariance;      ///< n x n, over `periods`, not periods − 1
  Eigen::VectorXd rmse;            ///< √(mean r²)
  Eigen::VectorXd rounding;        ///< an `rmse` below it is rounding: the plant is the model
  Whiteness whiteness;
};

/// The most periods that `Whiteness::ljung_box` looks back.
inline constexpr int kMostLags = 10;

/// episodes: the residuals of each, state_dim x periods, in the order of time; those of two
/// episodes are never multiplied with each other. magnitude: the largest |state| that there was,
/// by state (state_dim), which says what rounding can do. Of no residuals at all, everything is
/// zero and no autocorrelation is a number.
///
/// With m the mean over all, c_h = Σ (r_k − m)(r_{k+h} − m) over the N_h pairs h periods apart
/// within an episode, N of them for h = 0: the autocorrelation is c_h/c_0, its variance for white
/// Gaussian residuals N_h/(N (N + 2)), and the statistic N (N + 2) Σ_h (c_h/c_0)²/N_h, which for a
/// single episode is that of Ljung and Box ("On a measure of lack of fit in time series models",
/// Biometrika 65, 1978).
[[nodiscard]] ResidualStatistics residual_statistics(const std::vector<Eigen::MatrixXd>& episodes,
                                                     const Eigen::VectorXd& magnitude);

}  // namespace qsmpc::harness

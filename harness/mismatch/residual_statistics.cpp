#include "harness/mismatch/residual_statistics.hpp"

#include <algorithm>
#include <cmath>

#include "harness/statistics/chi_squared.hpp"
#include "harness/trace/residuals.hpp"
#include "models/constants.hpp"

namespace qsmpc::harness {
namespace {

/// Σ over the episodes of the products of residuals `lag` periods apart, and their number.
struct LaggedProducts {
  Eigen::VectorXd sum;  // state_dim
  double pairs = 0.0;
};

LaggedProducts lagged_products(const std::vector<Eigen::MatrixXd>& centred, Eigen::Index dim,
                               Eigen::Index lag) {
  LaggedProducts products{.sum = Eigen::VectorXd::Zero(dim)};
  for (const Eigen::MatrixXd& episode : centred) {
    const Eigen::Index pairs = episode.cols() - lag;
    if (pairs <= 0) continue;
    products.sum += (episode.leftCols(pairs).array() * episode.rightCols(pairs).array())
                        .rowwise()
                        .sum()
                        .matrix();
    products.pairs += static_cast<double>(pairs);
  }
  return products;
}

Whiteness whiteness_of(const std::vector<Eigen::MatrixXd>& centred, Eigen::Index dim) {
  Eigen::Index longest = 0;
  for (const Eigen::MatrixXd& episode : centred) longest = std::max(longest, episode.cols());
  Whiteness whiteness{.lags = static_cast<int>(std::clamp<Eigen::Index>(longest - 1, 0, kMostLags)),
                      .lag1 = Eigen::VectorXd::Constant(dim, kNotANumber),
                      .lag1_deviation = kNotANumber,
                      .ljung_box = Eigen::VectorXd::Constant(dim, kNotANumber),
                      .p_value = Eigen::VectorXd::Constant(dim, kNotANumber)};
  if (whiteness.lags == 0) return whiteness;
  const LaggedProducts squares = lagged_products(centred, dim, 0);
  const double scale = squares.pairs * (squares.pairs + 2.0);
  whiteness.ljung_box.setZero();
  for (int lag = 1; lag <= whiteness.lags; ++lag) {
    const LaggedProducts products = lagged_products(centred, dim, lag);
    // 0/0 where a residual is constant: intentionally not a number.
    const Eigen::VectorXd correlation = products.sum.cwiseQuotient(squares.sum);
    whiteness.ljung_box += scale / products.pairs * correlation.cwiseAbs2();
    if (lag > 1) continue;
    whiteness.lag1 = correlation;
    whiteness.lag1_deviation = std::sqrt(products.pairs / scale);
  }
  for (Eigen::Index i = 0; i < dim; ++i) {
    whiteness.p_value[i] = chi_squared_tail(whiteness.ljung_box[i], whiteness.lags);
  }
  return whiteness;
}

/// Standard error of the mean with episodes as the independent units: the residuals within an
/// episode may be arbitrarily dependent.
Eigen::VectorXd mean_deviation(const std::vector<Eigen::MatrixXd>& centred, Eigen::Index dim,
                               double periods) {
  const auto episodes = static_cast<double>(
      std::ranges::count_if(centred, [](const auto& episode) { return episode.cols() > 0; }));
  if (episodes < 2.0) return Eigen::VectorXd::Constant(dim, kNotANumber);
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(dim);
  for (const Eigen::MatrixXd& episode : centred) squares += episode.rowwise().sum().cwiseAbs2();
  return (squares * episodes / (episodes - 1.0)).cwiseSqrt() / periods;
}

}  // namespace

ResidualStatistics residual_statistics(const std::vector<Eigen::MatrixXd>& episodes,
                                       const Eigen::VectorXd& magnitude) {
  const Eigen::Index dim = magnitude.size();
  ResidualStatistics statistics{.mean = Eigen::VectorXd::Zero(dim),
                                .mean_deviation = Eigen::VectorXd::Constant(dim, kNotANumber),
                                .covariance = Eigen::MatrixXd::Zero(dim, dim),
                                .rmse = Eigen::VectorXd::Zero(dim),
                                .rounding = residual_rounding(magnitude),
                                .whiteness = whiteness_of({}, dim)};
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(dim);
  for (const Eigen::MatrixXd& episode : episodes) {
    if (episode.cols() == 0) continue;
    statistics.periods += episode.cols();
    statistics.mean += episode.rowwise().sum();
    squares += episode.rowwise().squaredNorm();
  }
  if (statistics.periods == 0) return statistics;
  const auto count = static_cast<double>(statistics.periods);
  statistics.mean /= count;
  statistics.rmse = (squares / count).cwiseSqrt();

  std::vector<Eigen::MatrixXd> centred;
  for (const Eigen::MatrixXd& episode : episodes) {
    if (episode.cols() == 0) continue;
    centred.emplace_back(episode.colwise() - statistics.mean);
    statistics.covariance += centred.back() * centred.back().transpose() / count;
  }
  statistics.mean_deviation = mean_deviation(centred, dim, count);
  statistics.whiteness = whiteness_of(centred, dim);
  return statistics;
}

}  // namespace qsmpc::harness

#include "tests/support/dubins_closed_form.hpp"

#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <random>
#include <vector>

#include "tests/support/slsqp_search.hpp"

namespace qsmpc::testing {
namespace {

using Complex = std::complex<double>;

constexpr int kHeading = 2;

/// (cos φ, sin φ) = Re(α e^{iφ}) with these α.
const std::array<Complex, 2> kDirections = {Complex(1.0, 0.0), Complex(0.0, -1.0)};

/// The Gaussian part of the state at stage k: belief plus k times the noise, without the reach.
Eigen::Matrix3d gaussian_covariance(const DubinsProblem& problem, int k) {
  return problem.belief.covariance + k * problem.noise_covariance;
}

/// The headings before every step, as means and E e^{iφ_k}.
struct Headings {
  std::vector<double> mean;        // horizon + 1
  std::vector<double> variance;    // horizon + 1
  std::vector<Complex> character;  // horizon + 1
};

Headings headings(const DubinsProblem& problem, const Eigen::Ref<const Eigen::MatrixXd>& inputs) {
  Headings result;
  double mean = problem.belief.mean[kHeading];
  for (int k = 0; k <= inputs.cols(); ++k) {
    const double variance = gaussian_covariance(problem, k)(kHeading, kHeading);
    result.mean.push_back(mean);
    result.variance.push_back(variance);
    result.character.push_back(std::polar(std::exp(-0.5 * variance), mean));
    if (k < inputs.cols()) mean += problem.time_step * inputs(0, k);
  }
  return result;
}

/// E of the outer product of (cos φ_j, sin φ_j) and (cos φ_l, sin φ_l), j ≤ l. The increments of
/// the heading are independent: Cov(φ_j, φ_l) = Var φ_j. With z = e^{iφ},
/// E Re(αz_j) Re(βz_l) = ½ Re(αβ E z_j z_l + αβ̄ E z_j z̄_l).
Eigen::Matrix2d direction_product(const Headings& headings, int j, int l) {
  const double shared = std::exp(-headings.variance[j]);
  const Complex sum = headings.character[j] * headings.character[l] * shared;
  const Complex difference = headings.character[j] * std::conj(headings.character[l]) / shared;
  Eigen::Matrix2d result;
  for (int a = 0; a < 2; ++a) {
    for (int b = 0; b < 2; ++b) {
      const Complex alpha = kDirections[a];
      const Complex beta = kDirections[b];
      result(a, b) = 0.5 * (alpha * beta * sum + alpha * std::conj(beta) * difference).real();
    }
  }
  return result;
}

/// E g (cos φ_j, sin φ_j) for g Gaussian with this mean and covariance with φ_j (3 each):
/// E g e^{iφ} = (E g + i Cov(g, φ)) E e^{iφ}.
Eigen::Matrix<double, 3, 2> direction_times(const Eigen::Vector3d& mean,
                                            const Eigen::Vector3d& covariance,
                                            const Complex& character) {
  Eigen::Matrix<double, 3, 2> result;
  for (int row = 0; row < 3; ++row) {
    for (int a = 0; a < 2; ++a) {
      result(row, a) = (kDirections[a] * Complex(mean[row], covariance[row]) * character).real();
    }
  }
  return result;
}

double quadratic(const DubinsMoments& moments, const Eigen::MatrixXd& weight,
                 const Eigen::VectorXd& target) {
  const Eigen::MatrixXd about_target = moments.second - moments.mean * target.transpose() -
                                       target * moments.mean.transpose() +
                                       target * target.transpose();
  return weight.cwiseProduct(about_target).sum();
}

/// The cost, and its gradient by central differences. The cost is analytic, so the gradient is
/// accurate to 1e-9 of it.
double cost_and_gradient(const DubinsProblem& problem, const std::vector<double>& inputs,
                         std::vector<double>& gradient) {
  constexpr double kStep = 1e-4;  // rad/s; error of third order, rounding 1e-16 / 1e-4
  Eigen::MatrixXd moved =
      Eigen::Map<const Eigen::RowVectorXd>(inputs.data(), static_cast<Eigen::Index>(inputs.size()));
  for (std::size_t i = 0; i < gradient.size(); ++i) {
    double& input = moved(0, static_cast<Eigen::Index>(i));
    input = inputs[i] + kStep;
    const double above = dubins_cost(problem, moved).total();
    input = inputs[i] - kStep;
    gradient[i] = (above - dubins_cost(problem, moved).total()) / (2.0 * kStep);
    input = inputs[i];
  }
  return dubins_cost(problem, moved).total();
}

}  // namespace

std::vector<DubinsMoments> dubins_moments(const DubinsProblem& problem,
                                          const Eigen::Ref<const Eigen::MatrixXd>& inputs) {
  const double reach = problem.speed * problem.time_step;
  const Headings heading = headings(problem, inputs);
  std::vector<DubinsMoments> result;
  Eigen::Vector2d direction_sum = Eigen::Vector2d::Zero();     // E Σ_j (cos, sin) φ_j
  Eigen::Matrix2d direction_square = Eigen::Matrix2d::Zero();  // E of its outer product
  for (int k = 0; k <= inputs.cols(); ++k) {
    // x_k = g + s (Σ_{j<k} cos φ_j, Σ_{j<k} sin φ_j, 0), g Gaussian.
    Eigen::Vector3d mean = problem.belief.mean;
    mean[kHeading] = heading.mean[k];
    Eigen::Matrix<double, 3, 2> cross = Eigen::Matrix<double, 3, 2>::Zero();
    for (int j = 0; j < k; ++j) {
      cross += direction_times(mean, gaussian_covariance(problem, j).col(kHeading),
                               heading.character[j]);
    }
    DubinsMoments moments{.mean = mean,
                          .second = gaussian_covariance(problem, k) + mean * mean.transpose()};
    moments.mean.head<2>() += reach * direction_sum;
    moments.second.leftCols<2>() += reach * cross;
    moments.second.topRows<2>() += reach * cross.transpose();
    moments.second.topLeftCorner<2, 2>() += reach * reach * direction_square;
    result.push_back(moments);

    for (int a = 0; a < 2; ++a) {
      direction_sum[a] += (kDirections[a] * heading.character[k]).real();
    }
    direction_square += direction_product(heading, k, k);
    for (int j = 0; j < k; ++j) {
      const Eigen::Matrix2d product = direction_product(heading, j, k);
      direction_square += product + product.transpose();
    }
  }
  return result;
}

controller::CostParts dubins_cost(const DubinsProblem& problem,
                                  const Eigen::Ref<const Eigen::MatrixXd>& inputs) {
  const std::vector<DubinsMoments> moments = dubins_moments(problem, inputs);
  const controller::QuadraticCost& cost = problem.cost;
  double state = 0.0;
  double input = 0.0;
  for (Eigen::Index k = 0; k < inputs.cols(); ++k) {
    state += 0.5 * quadratic(moments[k], cost.state, cost.target);
    input += inputs.col(k).dot(cost.input * inputs.col(k));
  }
  return {{"state", state},
          {"input", input},
          {"terminal", quadratic(moments.back(), cost.terminal, cost.target)}};
}

DubinsOptimum dubins_optimum(const DubinsProblem& problem, int horizon, int starts) {
  constexpr unsigned kSeed = 1;
  constexpr double kTolerance = 1e-13;  // relative, of the cost
  constexpr int kEvaluations = 300;
  std::mt19937_64 generator(kSeed);
  std::uniform_real_distribution<double> share;
  const double lower = problem.bounds.lower[0];
  const double upper = problem.bounds.upper[0];
  const auto entries = static_cast<std::size_t>(horizon);
  const SlsqpSearch settings{
      .cost =
          [&problem](const std::vector<double>& inputs, std::vector<double>& gradient) {
            return cost_and_gradient(problem, inputs, gradient);
          },
      .lower = std::vector<double>(entries, lower),
      .upper = std::vector<double>(entries, upper),
      .relative_tolerance = kTolerance,
      .evaluations = kEvaluations};
  DubinsOptimum best{.inputs = {}, .cost = std::numeric_limits<double>::infinity()};
  const std::array<double, 3> constants = {0.0, lower, upper};
  for (int start = 0; start < starts; ++start) {
    std::vector<double> inputs(entries);
    for (double& input : inputs) {
      input = start < 3 ? constants[start] : lower + (upper - lower) * share(generator);
    }
    inputs = run_slsqp(settings, inputs);
    const Eigen::MatrixXd found = Eigen::Map<const Eigen::RowVectorXd>(inputs.data(), horizon);
    const double cost = dubins_cost(problem, found).total();
    if (cost < best.cost) best = {.inputs = found, .cost = cost};
  }
  return best;
}

}  // namespace qsmpc::testing

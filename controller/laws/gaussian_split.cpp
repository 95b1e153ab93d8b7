#include "controller/laws/gaussian_split.hpp"

#include <cmath>

#include "controller/laws/covariance_root.hpp"
#include "controller/laws/normal_grid.hpp"

namespace qsmpc::controller {
namespace {

constexpr double kDeviationOfThree = 0.7;
constexpr double kDeviationOfFive = 0.55;

NormalSplit make_split(int parts, double deviation) {
  const NormalGrid rule = gauss_hermite(parts);
  return {.weights = rule.weights,
          .means = std::sqrt(1.0 - deviation * deviation) * rule.nodes.row(0).transpose(),
          .deviation = deviation};
}

}  // namespace

const NormalSplit& normal_split(int parts) {
  static const NormalSplit three = make_split(3, kDeviationOfThree);
  static const NormalSplit five = make_split(5, kDeviationOfFive);
  return parts == 3 ? three : five;
}

GaussianMixture split_gaussian(const Gaussian& gaussian, const Eigen::VectorXd& direction,
                               const NormalSplit& split) {
  const Eigen::VectorXd along = covariance_root(gaussian.covariance) * direction;
  const double removed = 1.0 - split.deviation * split.deviation;
  const Eigen::MatrixXd covariance = gaussian.covariance - removed * along * along.transpose();
  const auto parts = static_cast<std::size_t>(split.weights.size());
  return {.weights = split.weights,
          .means = (along * split.means.transpose()).colwise() + gaussian.mean,
          .covariances = std::vector<Eigen::MatrixXd>(parts, covariance)};
}

}  // namespace qsmpc::controller

#include "controller/chance/smoothed_tail.hpp"

#include <cmath>

namespace qsmpc::controller {

double smoothed_cvar(const Eigen::Ref<const Eigen::ArrayXd>& losses, double risk, double smoothing,
                     Eigen::ArrayXd& weights) {
  const double h = smoothing;
  const auto count = static_cast<double>(losses.size());
  // The mean of s'(loss − t), which is δ at the minimum, falls with t, from 1 to 0 between these.
  double low = losses.minCoeff() - h;
  double high = losses.maxCoeff() + h;
  const auto share = [&](double t) {
    weights = ((losses - t + h) / (2.0 * h)).cwiseMax(0.0).cwiseMin(1.0);
    return weights.sum() / count;
  };
  // Bisection.
  for (int n = 0; n < 60 && high - low > 1e-12 * (1.0 + std::abs(low)); ++n) {
    const double middle = 0.5 * (low + high);
    (share(middle) > risk ? low : high) = middle;
  }
  const double t = 0.5 * (low + high);
  share(t);
  double sum = 0.0;
  for (Eigen::Index i = 0; i < losses.size(); ++i) {
    const double y = losses[i] - t;
    if (y >= h) {
      sum += y;
    } else if (y > -h) {
      sum += (y + h) * (y + h) / (4.0 * h);
    }
  }
  weights /= risk * count;
  return t + sum / (risk * count);
}

}  // namespace qsmpc::controller

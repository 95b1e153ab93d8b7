#include "controller/certification/tilted_covariance.hpp"

#include <utility>

namespace qsmpc::controller {

TiltedCovariance::TiltedCovariance(const PathTilt& tilt)
    : tilt_(tilt), shares_(1.0 - tilt.spreads.array().square()) {}

void TiltedCovariance::start(Gaussian& law) {
  covariance_ = law.covariance;
  with_ = tilt_.empty() ? Eigen::MatrixXd(law.mean.size(), 0) : tilt_.functionals.moves[0];
  tilt_law(0, law);
}

void TiltedCovariance::step(Eigen::Index stage, const Eigen::MatrixXd& transition,
                            const Eigen::MatrixXd& noise_covariance, Gaussian& law) {
  with_last_ = transition * covariance_;
  covariance_ = with_last_ * transition.transpose() + noise_covariance;
  covariance_ = 0.5 * (covariance_ + covariance_.transpose()).eval();
  law.covariance = covariance_;
  if (tilt_.empty()) return;
  const auto block = static_cast<std::size_t>(stage) + 1;
  const Eigen::MatrixXd with_before = std::move(with_);
  with_ = transition * with_before + tilt_.functionals.moves[block];
  with_last_ -= with_ * shares_.asDiagonal() * with_before.transpose();
  tilt_law(stage + 1, law);
}

void TiltedCovariance::tilt_law(Eigen::Index block, Gaussian& law) const {
  if (tilt_.empty()) return;
  law.mean += tilt_.functionals.moves[static_cast<std::size_t>(block)] * tilt_.centre;
  law.covariance = covariance_ - with_ * shares_.asDiagonal() * with_.transpose();
  law.covariance = 0.5 * (law.covariance + law.covariance.transpose()).eval();
  // A variance entirely explained by the functionals can be slightly negative by rounding.
  law.covariance.diagonal() = law.covariance.diagonal().cwiseMax(0.0);
}

}  // namespace qsmpc::controller

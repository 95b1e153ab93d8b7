#include <cmath>
#include <memory>
#include <stdexcept>

#include "controller/laws/closed_loop_step.hpp"
#include "controller/laws/covariance_root.hpp"
#include "controller/laws/law_makers.hpp"
#include "controller/laws/law_propagator.hpp"
#include "controller/laws/unscented_step.hpp"

namespace qsmpc::controller {

void check_unscented(const UnscentedSettings& settings, Eigen::Index dim) {
  const auto d = static_cast<double>(dim);
  const double square = settings.alpha * settings.alpha;
  const double spread = square * (d + settings.kappa);
  if (!(spread > 0.0)) {
    throw std::invalid_argument("unscented: kappa must be above minus the state's dimension");
  }
  if (!(spread >= d * (square - settings.beta))) {
    throw std::invalid_argument(
        "unscented: alpha^2 (d + kappa) >= d (alpha^2 - beta) is needed for covariances that are "
        "positive semidefinite");
  }
}

GaussianMixture unscented_step(const LawProblem& problem, Eigen::Index stage,
                               const GaussianMixture& law, const UnscentedSettings& settings) {
  const Eigen::Index dim = law.dim();
  const Eigen::Index each = 2 * dim + 1;
  const double square =
      settings.alpha * settings.alpha * (static_cast<double>(dim) + settings.kappa);
  Points sigma(dim, each * law.size());
  for (Eigen::Index i = 0; i < law.size(); ++i) {
    const Eigen::MatrixXd root = std::sqrt(square) * covariance_root(law.covariances[i]);
    const Eigen::VectorXd mean = law.means.col(i);
    sigma.col(i * each) = mean;
    sigma.middleCols(i * each + 1, dim) = root.colwise() + mean;
    sigma.middleCols(i * each + 1 + dim, dim) = (-root).colwise() + mean;
  }
  const Points moved = closed_loop_step(problem, stage, sigma);
  GaussianMixture next{.weights = law.weights, .means = Points(dim, law.size()), .covariances = {}};
  const double weight = 0.5 / square;
  for (Eigen::Index i = 0; i < law.size(); ++i) {
    const Eigen::VectorXd centre = moved.col(i * each);
    const Eigen::MatrixXd offsets = moved.middleCols(i * each + 1, 2 * dim).colwise() - centre;
    const Eigen::VectorXd drift = weight * offsets.rowwise().sum();
    next.means.col(i) = centre + drift;
    next.covariances.emplace_back(symmetric_part(weight * offsets * offsets.transpose() +
                                                 (settings.beta - settings.alpha * settings.alpha) *
                                                     drift * drift.transpose()) +
                                  problem.noise_covariance);
  }
  return next;
}

namespace {

class UnscentedLaw final : public LawPropagator {
 public:
  explicit UnscentedLaw(const LawSettings& settings) : settings_(settings.unscented) {}

 private:
  [[nodiscard]] StageLaw begin(const LawProblem& problem) override {
    check_unscented(settings_, problem.belief.mean.size());
    return gaussian_law(problem.belief);
  }

  [[nodiscard]] StageLaw advance(const LawProblem& problem, Eigen::Index stage,
                                 const StageLaw& law) override {
    return unscented_step(problem, stage, std::get<GaussianMixture>(law), settings_);
  }

  UnscentedSettings settings_;
};

}  // namespace

LawMethod unscented_law() {
  return {
      .name = "unscented",
      .summary = "A Gaussian propagated by sigma points, with the scaled weights",
      .make = [](const LawSettings& settings) { return std::make_unique<UnscentedLaw>(settings); }};
}

}  // namespace qsmpc::controller

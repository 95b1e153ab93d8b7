#include "controller/laws/stage_law.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "controller/laws/covariance_root.hpp"

namespace qsmpc::controller {
namespace {

Eigen::VectorXd law_mean(const DiscreteMeasure& law) { return mean_of(law); }
Eigen::VectorXd law_mean(const GaussianMixture& law) { return law.means * law.weights; }
Eigen::VectorXd law_mean(const HermiteExpansion& law) { return law.mean(); }

Eigen::MatrixXd law_covariance(const DiscreteMeasure& law) { return covariance_of(law); }
Eigen::MatrixXd law_covariance(const GaussianMixture& law) {
  const Points centred = law.means.colwise() - law_mean(law);
  Eigen::MatrixXd covariance = centred * law.weights.asDiagonal() * centred.transpose();
  for (Eigen::Index i = 0; i < law.size(); ++i) {
    covariance += law.weights[i] * law.covariances[i];
  }
  return covariance;
}
Eigen::MatrixXd law_covariance(const HermiteExpansion& law) { return law.covariance(); }

/// For every choice, the first index whose cumulative weight exceeds it; grouped by index.
std::vector<std::vector<Eigen::Index>> choose(const Eigen::VectorXd& weights,
                                              const Eigen::VectorXd& choices) {
  std::vector<double> cumulated(weights.begin(), weights.end());
  for (std::size_t i = 1; i < cumulated.size(); ++i) cumulated[i] += cumulated[i - 1];
  // The sum is one only up to rounding, but every choice must find an index.
  cumulated.back() = std::numeric_limits<double>::infinity();
  std::vector<std::vector<Eigen::Index>> chosen(cumulated.size());
  for (Eigen::Index i = 0; i < choices.size(); ++i) {
    const auto at = std::upper_bound(cumulated.begin(), cumulated.end(), choices[i]);
    chosen[static_cast<std::size_t>(at - cumulated.begin())].push_back(i);
  }
  return chosen;
}

Points draws_of(const DiscreteMeasure& law, const StandardDraws& draws) {
  Points out(law.dim(), draws.count());
  const auto chosen = choose(law.weights, draws.choices);
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    for (const Eigen::Index draw : chosen[i]) {
      out.col(draw) = law.locations.col(static_cast<Eigen::Index>(i));
    }
  }
  return out;
}

Points draws_of(const GaussianMixture& law, const StandardDraws& draws) {
  Points out(law.dim(), draws.count());
  const auto chosen = choose(law.weights, draws.choices);
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    if (chosen[i].empty()) continue;
    const Eigen::MatrixXd moved =
        covariance_root(law.covariances[i]) * draws.normals(Eigen::all, chosen[i]);
    out(Eigen::all, chosen[i]) =
        moved.colwise() + Eigen::VectorXd(law.means.col(static_cast<Eigen::Index>(i)));
  }
  return out;
}

Points draws_of(const HermiteExpansion& law, const StandardDraws& draws) {
  constexpr Eigen::Index kBlock = 4096;  // keeps the table of polynomial values small
  Points out(law.coefficients.rows(), draws.count());
  for (Eigen::Index begin = 0; begin < draws.count(); begin += kBlock) {
    const Eigen::Index size = std::min(kBlock, draws.count() - begin);
    out.middleCols(begin, size) =
        law.coefficients * law.basis.values(draws.normals.middleCols(begin, size));
  }
  return out;
}

bool all_finite(const DiscreteMeasure& law) {
  return law.locations.allFinite() && law.weights.allFinite();
}
bool all_finite(const GaussianMixture& law) {
  return law.means.allFinite() && law.weights.allFinite() &&
         std::ranges::all_of(law.covariances,
                             [](const Eigen::MatrixXd& matrix) { return matrix.allFinite(); });
}
bool all_finite(const HermiteExpansion& law) { return law.coefficients.allFinite(); }

}  // namespace

StageLaw gaussian_law(const Gaussian& gaussian) {
  return GaussianMixture{.weights = Eigen::VectorXd::Ones(1),
                         .means = gaussian.mean,
                         .covariances = {gaussian.covariance}};
}

StageLaw lost_law(Eigen::Index dim) {
  return DiscreteMeasure{
      .locations = Points::Constant(dim, 1, std::numeric_limits<double>::quiet_NaN()),
      .weights = Eigen::VectorXd::Ones(1)};
}

Eigen::Index law_dim(const StageLaw& law) { return mean_of(law).size(); }

bool is_finite(const StageLaw& law) {
  return std::visit([](const auto& kind) { return all_finite(kind); }, law);
}

Eigen::VectorXd mean_of(const StageLaw& law) {
  return std::visit([](const auto& kind) { return law_mean(kind); }, law);
}

Eigen::MatrixXd covariance_of(const StageLaw& law) {
  return std::visit([](const auto& kind) { return law_covariance(kind); }, law);
}

Points law_draws(const StageLaw& law, const StandardDraws& draws) {
  return std::visit([&](const auto& kind) { return draws_of(kind, draws); }, law);
}

double unsafe_probability(const StageLaw& law, const UnsafeSet& unsafe, const StandardDraws& draws,
                          Eigen::Index stage) {
  if (!is_finite(law)) return 1.0;
  if (const auto* points = std::get_if<DiscreteMeasure>(&law)) {
    const Eigen::VectorXd distances = clearances(points->locations, unsafe, stage);
    return (distances.array() <= 0.0).select(points->weights, 0.0).sum();
  }
  const Eigen::VectorXd distances = clearances(law_draws(law, draws), unsafe, stage);
  return static_cast<double>((distances.array() <= 0.0).count()) /
         static_cast<double>(draws.count());
}

}  // namespace qsmpc::controller

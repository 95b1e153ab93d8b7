// Non-intrusive polynomial chaos, expanded anew at every stage in as many standard normals as there
// are states. Equations and sources: docs/theory/laws.md.
#include <algorithm>
#include <memory>
#include <optional>

#include "controller/laws/closed_loop_step.hpp"
#include "controller/laws/covariance_root.hpp"
#include "controller/laws/law_makers.hpp"
#include "controller/laws/law_propagator.hpp"
#include "controller/laws/normal_grid.hpp"
#include "models/linear_algebra.hpp"

namespace qsmpc::controller {
namespace {

/// Share of a covariance's largest eigenvalue below which a direction counts as having no variance.
constexpr double kLeastVariance = 1e-13;

/// The pseudo-inverse of covariance_root(covariance).
Eigen::MatrixXd inverse_root(const Eigen::MatrixXd& covariance) {
  const models::SymmetricEigen eigen = models::symmetric_eigen(covariance);
  const double least = kLeastVariance * eigen.values.maxCoeff();
  const Eigen::VectorXd inverse =
      (eigen.values.array() > least)
          .select(eigen.values.cwiseMax(least).cwiseSqrt().cwiseInverse(), 0.0);
  return eigen.vectors * inverse.asDiagonal() * eigen.vectors.transpose();
}

/// The law of x + w for x of this expansion in ξ and w ~ N(0, Σ), as an expansion of the same order
/// in new germs ξ' = S^−½ (C₁ ξ + w), S = C₁ C₁ᵀ + Σ, C₁ the coefficients of the first degree: the
/// first degree represents C₁ ξ + w exactly, and higher degrees become their conditional
/// expectations given ξ'. The variance that these lose is added to the first degree, so that mean
/// and covariance are those of x + w.
HermiteExpansion with_noise(const HermiteExpansion& expansion, const Eigen::MatrixXd& noise) {
  const Eigen::Index germs = expansion.basis.germs();
  const Eigen::MatrixXd first = expansion.coefficients.middleCols(1, germs);
  const Eigen::Index higher_terms = expansion.basis.terms() - germs - 1;
  const Eigen::MatrixXd linear = symmetric_part(first * first.transpose()) + noise;
  HermiteExpansion next{
      .basis = expansion.basis,
      .coefficients = Eigen::MatrixXd::Zero(first.rows(), expansion.basis.terms())};
  next.coefficients.col(0) = expansion.mean();
  if (higher_terms == 0) {
    next.coefficients.middleCols(1, germs) = covariance_root(linear);
    return next;
  }
  const Eigen::MatrixXd correlation = first.transpose() * inverse_root(linear);
  Eigen::MatrixXd kept =
      expansion.coefficients * expansion.basis.conditional_expectation(correlation);
  const auto before = expansion.coefficients.rightCols(higher_terms);
  const auto after = kept.rightCols(higher_terms);
  const Eigen::MatrixXd lost =
      symmetric_part(before * before.transpose() - after * after.transpose());
  next.coefficients.rightCols(higher_terms) = after;
  next.coefficients.middleCols(1, germs) = covariance_root(linear + lost);
  return next;
}

class PolynomialChaosLaw final : public LawPropagator {
 public:
  explicit PolynomialChaosLaw(const LawSettings& settings)
      : order_(settings.order), most_nodes_(settings.most_nodes) {}

 private:
  [[nodiscard]] StageLaw begin(const LawProblem& problem) override {
    HermiteExpansion law = gaussian_expansion(problem.belief, order_);
    if (grid_.nodes.rows() != problem.belief.mean.size()) {
      grid_ = normal_grid(problem.belief.mean.size(), order_, most_nodes_);
      values_ = law.basis.values(grid_.nodes);
    }
    return law;
  }

  /// c_α = E g(x(ξ)) h_α(ξ) by quadrature, then the noise.
  [[nodiscard]] StageLaw advance(const LawProblem& problem, Eigen::Index stage,
                                 const StageLaw& law) override {
    const auto& expansion = std::get<HermiteExpansion>(law);
    const Points moved = closed_loop_step(problem, stage, expansion.coefficients * values_);
    if (!moved.allFinite()) return lost_law(moved.rows());
    return with_noise({.basis = expansion.basis,
                       .coefficients = moved * grid_.weights.asDiagonal() * values_.transpose()},
                      problem.noise_covariance);
  }

  int order_;
  int most_nodes_;
  NormalGrid grid_;
  Points values_;  // of all polynomials at the nodes
};

}  // namespace

LawMethod polynomial_chaos_law() {
  return {.name = "polynomial_chaos",
          .summary = "A polynomial in standard normals, projected again at every stage",
          .make = [](const LawSettings& settings) {
            return std::make_unique<PolynomialChaosLaw>(settings);
          }};
}

}  // namespace qsmpc::controller

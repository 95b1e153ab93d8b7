// A mixture of Gaussians: split where the closed loop is most nonlinear, moved by the unscented
// transform, and merged by Runnalls' algorithm. Equations and sources: docs/theory/laws.md.
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

#include "controller/laws/closed_loop_step.hpp"
#include "controller/laws/gaussian_split.hpp"
#include "controller/laws/law_makers.hpp"
#include "controller/laws/law_propagator.hpp"
#include "controller/laws/mixture_reduction.hpp"
#include "controller/laws/unscented_step.hpp"
#include "models/linear_algebra.hpp"

namespace qsmpc::controller {
namespace {

/// The largest bend of a component by the closed loop.
struct Bend {
  double size = 0.0;          ///< of the second and third differences along z, in the state's unit
  double spread = 0.0;        ///< root mean square of the first differences over all z
  Eigen::VectorXd direction;  ///< z, a unit vector in whitened coordinates
};

/// Directions along which a component may be split, in whitened coordinates (d x n): the
/// eigenvectors of its covariance, and the S e_i, which carry all of one state's variance.
Eigen::MatrixXd candidate_directions(const Eigen::MatrixXd& eigenvectors,
                                     const Eigen::MatrixXd& root) {
  const Eigen::Index dim = root.rows();
  Eigen::MatrixXd candidates(dim, 2 * dim);
  candidates.leftCols(dim) = eigenvectors;
  candidates.rightCols(dim) = root;
  for (auto column : candidates.rightCols(dim).colwise()) {
    const double size = column.norm();
    if (size > 0.0) column /= size;  // a state without variance stays zero and adds no bend
  }
  return candidates;
}

/// g(m + S z h) − g(m) for the columns of `ways` = S z h, and for −h.
struct Differences {
  Eigen::MatrixXd ahead;
  Eigen::MatrixXd behind;

  [[nodiscard]] Eigen::MatrixXd even() const { return 0.5 * (ahead + behind); }
  [[nodiscard]] Eigen::MatrixXd odd() const { return 0.5 * (ahead - behind); }
};

/// Second differences are blind to what is odd about the mean, such as a clamp with equally distant
/// bounds; comparing first differences at full and at half reach reveals it.
Bend bend_of(const LawProblem& problem, Eigen::Index stage, const Eigen::VectorXd& mean,
             const Eigen::MatrixXd& covariance) {
  // As far out as the nodes of the three-point Gauss-Hermite rule.
  constexpr double kReach = std::numbers::sqrt3;
  const models::SymmetricEigen eigen = models::symmetric_eigen(covariance);
  const Eigen::MatrixXd root = eigen.vectors * eigen.values.cwiseMax(0.0).cwiseSqrt().asDiagonal() *
                               eigen.vectors.transpose();
  const Eigen::MatrixXd candidates = candidate_directions(eigen.vectors, root);
  const Eigen::Index count = candidates.cols();
  const Eigen::MatrixXd ways = kReach * root * candidates;
  Points points(mean.size(), 4 * count + 1);
  points << ways, -ways, 0.5 * ways, -0.5 * ways, Eigen::VectorXd::Zero(mean.size());
  points.colwise() += mean;
  const Points moved = closed_loop_step(problem, stage, points);
  const Eigen::MatrixXd offsets = moved.leftCols(4 * count).colwise() - moved.col(4 * count);
  const Differences full{.ahead = offsets.leftCols(count),
                         .behind = offsets.middleCols(count, count)};
  const Differences half{.ahead = offsets.middleCols(2 * count, count),
                         .behind = offsets.rightCols(count)};
  const Eigen::MatrixXd even = full.even() / (kReach * kReach);
  const Eigen::MatrixXd odd = (full.odd() - 2.0 * half.odd()) / kReach;
  const Eigen::VectorXd squares =
      (even.colwise().squaredNorm() + odd.colwise().squaredNorm()).transpose();
  Bend bend;
  Eigen::Index best = 0;
  bend.size = std::sqrt(squares.maxCoeff(&best));
  // Only the eigenvectors form a basis.
  bend.spread = full.odd().leftCols(mean.size()).norm() / kReach;
  bend.direction = candidates.col(best);
  return bend;
}

class GaussianMixtureLaw final : public LawPropagator {
 public:
  explicit GaussianMixtureLaw(const LawSettings& settings) : settings_(settings) {}

 private:
  [[nodiscard]] StageLaw begin(const LawProblem& problem) override {
    check_unscented(settings_.unscented, problem.belief.mean.size());
    return gaussian_law(problem.belief);
  }

  [[nodiscard]] StageLaw advance(const LawProblem& problem, Eigen::Index stage,
                                 const StageLaw& law) override {
    const GaussianMixture split = split_bent(problem, stage, std::get<GaussianMixture>(law));
    GaussianMixture moved = unscented_step(problem, stage, split, settings_.unscented);
    if (!is_finite(moved)) return lost_law(moved.dim());
    return reduce_mixture(std::move(moved), settings_.components);
  }

  /// Repeatedly splits the component with the largest weighted bend, until no bend exceeds the
  /// tolerance or there are `split` times as many components as are kept.
  [[nodiscard]] GaussianMixture split_bent(const LawProblem& problem, Eigen::Index stage,
                                           GaussianMixture law) const {
    if (settings_.components == 1) return law;
    const NormalSplit& parts = normal_split(settings_.split);
    const Eigen::Index most = Eigen::Index{settings_.components} * settings_.split;
    std::vector<Bend> bends;
    for (Eigen::Index i = 0; i < law.size(); ++i) {
      bends.push_back(bend_of(problem, stage, law.means.col(i), law.covariances[i]));
    }
    while (law.size() + settings_.split - 1 <= most) {
      const Eigen::Index worst = most_bent(law, bends);
      if (worst < 0) break;
      split_component(law, worst, bends[worst].direction, parts);
      bends[worst] = bend_of(problem, stage, law.means.col(worst), law.covariances[worst]);
      for (auto i = static_cast<Eigen::Index>(bends.size()); i < law.size(); ++i) {
        bends.push_back(bend_of(problem, stage, law.means.col(i), law.covariances[i]));
      }
    }
    return law;
  }

  /// −1 if none bends by more than the tolerance; non-finite bends do not count.
  [[nodiscard]] Eigen::Index most_bent(const GaussianMixture& law,
                                       const std::vector<Bend>& bends) const {
    Eigen::Index worst = -1;
    double most = 0.0;
    for (Eigen::Index i = 0; i < law.size(); ++i) {
      const Bend& bend = bends[i];
      const double weighted = law.weights[i] * bend.size;
      if (bend.size > settings_.least_bend * bend.spread && weighted > most) {
        most = weighted;
        worst = i;
      }
    }
    return worst;
  }

  /// The first part replaces the component, the others are appended.
  static void split_component(GaussianMixture& law, Eigen::Index component,
                              const Eigen::VectorXd& direction, const NormalSplit& split) {
    const GaussianMixture parts =
        split_gaussian({.mean = law.means.col(component), .covariance = law.covariances[component]},
                       direction, split);
    const Eigen::Index before = law.size();
    const double weight = law.weights[component];
    const Eigen::Index added = parts.size() - 1;
    law.weights.conservativeResize(before + added);
    law.weights[component] = weight * parts.weights[0];
    law.weights.tail(added) = weight * parts.weights.tail(added);
    law.means.conservativeResize(Eigen::NoChange, before + added);
    law.means.col(component) = parts.means.col(0);
    law.means.rightCols(added) = parts.means.rightCols(added);
    law.covariances[component] = parts.covariances.front();
    law.covariances.insert(law.covariances.end(), parts.covariances.begin() + 1,
                           parts.covariances.end());
  }

  LawSettings settings_;
};

}  // namespace

LawMethod gaussian_mixture_law() {
  return {.name = "gaussian_mixture",
          .summary =
              "A mixture, split where the model is most nonlinear, merged by Runnalls' algorithm",
          .make = [](const LawSettings& settings) {
            return std::make_unique<GaussianMixtureLaw>(settings);
          }};
}

}  // namespace qsmpc::controller

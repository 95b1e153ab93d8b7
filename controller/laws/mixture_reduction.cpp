#include "controller/laws/mixture_reduction.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "controller/laws/covariance_root.hpp"

namespace qsmpc::controller {
namespace {

constexpr double kRegularShare = 1e-12;

/// The remaining components, and the costs of merging their pairs.
class MixtureMerger {
 public:
  explicit MixtureMerger(GaussianMixture mixture) : mixture_(std::move(mixture)) {
    const Eigen::Index dim = mixture_.dim();
    const double trace = covariance_of(StageLaw(mixture_)).trace();
    // A mixture without any spread merges at no cost, whatever is added.
    regular_ = (trace > 0.0 ? kRegularShare * trace : 1.0) * Eigen::MatrixXd::Identity(dim, dim);
    const Eigen::Index count = mixture_.size();
    alive_.assign(static_cast<std::size_t>(count), true);
    log_determinants_.resize(count);
    for (Eigen::Index i = 0; i < count; ++i) {
      log_determinants_[i] = log_determinant(mixture_.covariances[i]);
    }
    costs_ = Eigen::MatrixXd::Constant(count, count, std::numeric_limits<double>::infinity());
    for (Eigen::Index i = 0; i < count; ++i) {
      for (Eigen::Index j = i + 1; j < count; ++j) costs_(i, j) = cost(i, j);
    }
  }

  void merge_cheapest() {
    Eigen::Index first = 0;
    Eigen::Index second = 0;
    costs_.minCoeff(&first, &second);
    merge(first, second);
  }

  [[nodiscard]] GaussianMixture left() const {
    std::vector<Eigen::Index> kept;
    for (std::size_t i = 0; i < alive_.size(); ++i) {
      if (alive_[i]) kept.push_back(static_cast<Eigen::Index>(i));
    }
    GaussianMixture out{.weights = mixture_.weights(kept),
                        .means = mixture_.means(Eigen::all, kept),
                        .covariances = {}};
    for (const Eigen::Index i : kept) out.covariances.push_back(mixture_.covariances[i]);
    return out;
  }

 private:
  [[nodiscard]] double log_determinant(const Eigen::MatrixXd& covariance) const {
    return 2.0 * models::cholesky_factor(covariance + regular_).diagonal().array().log().sum();
  }

  /// Covariance of the components i and j when merged.
  [[nodiscard]] Eigen::MatrixXd merged_covariance(Eigen::Index i, Eigen::Index j) const {
    const double weight = mixture_.weights[i] + mixture_.weights[j];
    const double share = mixture_.weights[i] / weight;
    const Eigen::VectorXd apart = mixture_.means.col(i) - mixture_.means.col(j);
    return share * mixture_.covariances[i] + (1.0 - share) * mixture_.covariances[j] +
           share * (1.0 - share) * apart * apart.transpose();
  }

  [[nodiscard]] double cost(Eigen::Index i, Eigen::Index j) const {
    const double first = mixture_.weights[i];
    const double second = mixture_.weights[j];
    return 0.5 * ((first + second) * log_determinant(merged_covariance(i, j)) -
                  first * log_determinants_[i] - second * log_determinants_[j]);
  }

  /// Merges both into component `first`; first < second.
  void merge(Eigen::Index first, Eigen::Index second) {
    const double weight = mixture_.weights[first] + mixture_.weights[second];
    const double share = mixture_.weights[first] / weight;
    mixture_.covariances[first] = merged_covariance(first, second);
    mixture_.means.col(first) =
        share * mixture_.means.col(first) + (1.0 - share) * mixture_.means.col(second);
    mixture_.weights[first] = weight;
    log_determinants_[first] = log_determinant(mixture_.covariances[first]);
    alive_[second] = false;
    costs_.row(second).setConstant(std::numeric_limits<double>::infinity());
    costs_.col(second).setConstant(std::numeric_limits<double>::infinity());
    for (Eigen::Index other = 0; other < mixture_.size(); ++other) {
      if (other == first || !alive_[other]) continue;
      costs_(std::min(first, other), std::max(first, other)) =
          cost(std::min(first, other), std::max(first, other));
    }
  }

  GaussianMixture mixture_;
  Eigen::MatrixXd regular_;
  std::vector<bool> alive_;
  Eigen::VectorXd log_determinants_;
  Eigen::MatrixXd costs_;  // of remaining pairs i < j; infinite elsewhere
};

}  // namespace

GaussianMixture reduce_mixture(GaussianMixture mixture, int components) {
  const Eigen::Index surplus = mixture.size() - components;
  if (surplus <= 0) return mixture;
  MixtureMerger merger(std::move(mixture));
  for (Eigen::Index merged = 0; merged < surplus; ++merged) merger.merge_cheapest();
  return merger.left();
}

}  // namespace qsmpc::controller

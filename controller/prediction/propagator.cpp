#include "controller/prediction/propagator.hpp"

#include <cmath>
#include <numeric>
#include <stdexcept>

#include "controller/measure/compression.hpp"
#include "controller/measure/soft_compression.hpp"
#include "controller/prediction/moment_matching.hpp"
#include "controller/prediction/product_map.hpp"

namespace qsmpc {
namespace {

constexpr const char* kCompressed = "compressed";
constexpr const char* kMomentMatched = "moment_matched";
constexpr const char* kSoft = "soft";
constexpr const char* kNoiseFree = "noise_free";

/// Products with the noise quantiser, brought to a number of clusters.
class ProductPropagator : public Propagator {
 public:
  [[nodiscard]] StageMap stage_map(const Points& stepped,
                                   const Eigen::VectorXd& weights) const final {
    const DiscreteMeasure measure{.locations = stepped, .weights = weights};
    if (!stepped.allFinite()) return lost_map(measure);
    return compressed_map(measure, product_measure(measure, noise_.measure));
  }

  [[nodiscard]] double noise_w2() const final { return noise_.w2; }

 protected:
  ProductPropagator(const PropagatorSettings& settings, QuantiserKind kind)
      : settings_(settings), noise_(quantise(settings.noise, settings.noise_points, kind)) {
    if (settings.compressed_points < 1) {
      throw std::invalid_argument("propagator: at least one point must be kept");
    }
  }

  [[nodiscard]] const PropagatorSettings& settings() const { return settings_; }
  [[nodiscard]] const DiscreteMeasure& noise() const { return noise_.measure; }

 private:
  /// The map from `stepped` to clusters of `product`, its products with the noise.
  [[nodiscard]] virtual StageMap compressed_map(const DiscreteMeasure& stepped,
                                                const DiscreteMeasure& product) const = 0;

  PropagatorSettings settings_;
  GaussianQuantisation noise_;
};

/// The clusters of the split tree.
class CompressedPropagator final : public ProductPropagator {
 public:
  explicit CompressedPropagator(const PropagatorSettings& settings)
      : ProductPropagator(settings, QuantiserKind::kProduct) {}

 private:
  [[nodiscard]] StageMap compressed_map(const DiscreteMeasure& stepped,
                                        const DiscreteMeasure& product) const override {
    return cluster_map(compress(product, settings().compressed_points, /*refinements=*/0),
                       stepped.weights, noise());
  }
};

/// Refined clusters, spread about their mean so that they have the covariance of the stepped points
/// plus that of the noise: what the noise quantiser and the compression lost.
class MomentMatchedPropagator final : public ProductPropagator {
 public:
  explicit MomentMatchedPropagator(const PropagatorSettings& settings)
      : ProductPropagator(settings, QuantiserKind::kLloyd) {
    if (settings.refinements < 0) {
      throw std::invalid_argument("propagator: refinements must not be negative");
    }
  }

 private:
  /// The clusters' means are conditional means of the products, so that the two parts of a
  /// product's way, to its cluster's mean and from there to where the spread puts it, are
  /// uncorrelated: their squares add.
  [[nodiscard]] StageMap compressed_map(const DiscreteMeasure& stepped,
                                        const DiscreteMeasure& product) const override {
    const Compression compression =
        compress(product, settings().compressed_points, settings().refinements);
    StageMap map = cluster_map(compression, stepped.weights, noise());
    const Eigen::MatrixXd covariance = covariance_of(compression.measure);
    map.spread = spread_between(covariance, covariance_of(stepped) + settings().noise.covariance);
    map.compression_w2 = std::hypot(compression.w2, spread_w2(covariance, map.spread));
    return map;
  }
};

/// Algorithm 1, with the shares held.
class SoftPropagator final : public ProductPropagator {
 public:
  explicit SoftPropagator(const PropagatorSettings& settings)
      : ProductPropagator(settings, QuantiserKind::kProduct) {
    if (!(settings.sharpness > 0.0) || !std::isfinite(settings.sharpness)) {
      throw std::invalid_argument("propagator: the sharpness must be positive and finite");
    }
  }

 private:
  [[nodiscard]] StageMap compressed_map(const DiscreteMeasure& stepped,
                                        const DiscreteMeasure& product) const override {
    return cluster_map(compress_soft(product, {.count = settings().compressed_points,
                                               .sharpness = settings().sharpness}),
                       stepped.weights, noise());
  }
};

/// Every point stays as it is. The noise is represented by its mean, so its whole standard
/// deviation counts as error.
class NoiseFreePropagator final : public Propagator {
 public:
  explicit NoiseFreePropagator(const PropagatorSettings& settings)
      : noise_w2_(std::sqrt(settings.noise.covariance.trace())) {}

  [[nodiscard]] StageMap stage_map(const Points& stepped,
                                   const Eigen::VectorXd& weights) const override {
    StageMap map;
    map.row_begin.resize(weights.size() + 1);
    std::iota(map.row_begin.begin(), map.row_begin.end(), 0);
    map.column.assign(map.row_begin.begin(), map.row_begin.end() - 1);
    map.coefficient.assign(weights.size(), 1.0);
    map.offset = Points::Zero(stepped.rows(), stepped.cols());
    map.weights = weights;
    return map;
  }

  [[nodiscard]] double noise_w2() const override { return noise_w2_; }

 private:
  double noise_w2_;
};

}  // namespace

void apply_stage_map(const StageMap& map, const Points& stepped, Points& out) {
  for (Eigen::Index axis = 0; axis < stepped.rows(); ++axis) {
    for (Eigen::Index n = 0; n < map.clusters(); ++n) {
      double sum = map.offset(axis, n);
      for (int k = map.row_begin[n]; k < map.row_begin[n + 1]; ++k) {
        sum += map.coefficient[k] * stepped(axis, map.column[k]);
      }
      out(axis, n) = sum;
    }
  }
  if (map.spread.size() == 0) return;
  const Eigen::VectorXd mean = out * map.weights / map.weights.sum();
  Eigen::VectorXd offset(mean.size());
  for (Eigen::Index n = 0; n < map.clusters(); ++n) {
    offset = out.col(n) - mean;
    out.col(n) = mean;
    out.col(n).noalias() += map.spread * offset;
  }
}

void pullback_stage_map(const StageMap& map, const Points& adjoint, Points& stepped_adjoint) {
  stepped_adjoint.setZero();
  const bool spread = map.spread.size() != 0;
  // With S symmetric: the adjoint of cluster n before the spread is S g_n + ρ̃_n (I − S) Σ g.
  Eigen::VectorXd mean_adjoint;
  if (spread) {
    const Eigen::VectorXd total = adjoint.rowwise().sum();
    mean_adjoint = (total - map.spread * total) / map.weights.sum();
  }
  for (Eigen::Index axis = 0; axis < adjoint.rows(); ++axis) {
    for (Eigen::Index n = 0; n < map.clusters(); ++n) {
      const double entry =
          spread ? map.spread.col(axis).dot(adjoint.col(n)) + map.weights[n] * mean_adjoint[axis]
                 : adjoint(axis, n);
      for (int k = map.row_begin[n]; k < map.row_begin[n + 1]; ++k) {
        stepped_adjoint(axis, map.column[k]) += map.coefficient[k] * entry;
      }
    }
  }
}

const std::vector<PropagatorEntry>& propagators() {
  static const std::vector<PropagatorEntry> table = {
      {kCompressed, "product with the noise quantiser, compressed after every step (Eq. 4-5, 4-6)"},
      {kMomentMatched,
       "the same with Lloyd's quantiser and refined compression, spread to the covariance due"},
      {kSoft, "as \"compressed\", but with the soft assignments of Algorithm 1; slow"},
      {kNoiseFree, "the belief's points only; the noise counts as error of the certificate"},
  };
  return table;
}

std::unique_ptr<const Propagator> make_propagator(std::string_view name,
                                                  const PropagatorSettings& settings) {
  check_gaussian(settings.noise);
  if (!settings.noise.mean.isZero(0.0)) {
    throw std::invalid_argument("propagator: the noise must have zero mean");
  }
  if (name == kCompressed) return std::make_unique<CompressedPropagator>(settings);
  if (name == kMomentMatched) return std::make_unique<MomentMatchedPropagator>(settings);
  if (name == kSoft) return std::make_unique<SoftPropagator>(settings);
  if (name == kNoiseFree) return std::make_unique<NoiseFreePropagator>(settings);
  std::string known;
  for (const PropagatorEntry& entry : propagators()) {
    known += (known.empty() ? "" : ", ") + entry.name;
  }
  throw std::invalid_argument("no propagator '" + std::string(name) + "'; known are: " + known);
}

}  // namespace qsmpc

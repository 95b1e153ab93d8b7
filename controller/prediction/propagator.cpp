#include "controller/prediction/propagator.hpp"

#include <cmath>
#include <stdexcept>

#include "controller/measure/compression/compression.hpp"
#include "controller/measure/compression/mixture_split.hpp"
#include "controller/measure/compression/soft_compression.hpp"
#include "controller/named_entry.hpp"
#include "controller/prediction/moment_matching.hpp"
#include "controller/prediction/product_map.hpp"

namespace qsmpc::controller {
namespace {

/// Products with the noise quantiser, compressed to a number of clusters.
class ProductPropagator : public Propagator {
 public:
  void update(const Points& stepped, const Eigen::VectorXd& weights, const Executor& /*run*/,
              StageMap& out) final {
    const DiscreteMeasure measure{.locations = stepped, .weights = weights};
    out = stepped.allFinite() ? compressed_map(measure, product_measure(measure, noise_.measure))
                              : lost_map(measure);
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
/// plus that of the noise: this restores what the noise quantiser and the compression lost.
class MomentMatchedPropagator final : public ProductPropagator {
 public:
  explicit MomentMatchedPropagator(const PropagatorSettings& settings)
      : ProductPropagator(settings, QuantiserKind::kLloyd) {
    if (settings.refinements < 0) {
      throw std::invalid_argument("propagator: refinements must not be negative");
    }
  }

 private:
  /// The clusters' means are conditional means of the products, so that the two displacements of a
  /// product, to its cluster's mean and then by the spread, are uncorrelated: their squares add.
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

/// Algorithm 1, with its shares fixed.
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

/// The noise stays Gaussian: the mixture about the stepped points is cut into cells, whose means
/// are spread so that they have its covariance.
class MixturePropagator final : public Propagator {
 public:
  explicit MixturePropagator(const PropagatorSettings& settings)
      : splitter_(settings.noise.covariance, settings.compressed_points, settings.noise_points) {}

  void update(const Points& stepped, const Eigen::VectorXd& weights, const Executor& run,
              StageMap& out) override {
    if (!stepped.allFinite()) {
      out = lost_map({.locations = stepped, .weights = weights});
      return;
    }
    splitter_.split(stepped, weights, run, cells_);
    cluster_map(cells_, run, out);
    spread_between(cells_.covariance, cells_.whole_covariance, spread_);
    displace(out);
    // As above: the two displacements are uncorrelated.
    out.compression_w2 = std::hypot(cells_.w2, spread_w2(cells_.covariance, spread_));
  }

  /// The noise is not quantised; the loss of its cells is part of the map's cost.
  [[nodiscard]] double noise_w2() const override { return 0.0; }

 private:
  /// Moves the points to their spread positions by constant offsets: a fixed spread matrix would
  /// amplify their response to the inputs, and optimisation would stall too early.
  void displace(StageMap& map) const {
    const Eigen::Index dim = map.offset.rows();
    const Eigen::Map<const Points> mean(cells_.mean.data(), dim, map.clusters());
    for (Eigen::Index a = 0; a < dim; ++a) {
      for (Eigen::Index b = 0; b < dim; ++b) {
        const double excess = spread_(a, b) - (a == b ? 1.0 : 0.0);
        map.offset.row(a) += excess * mean.row(b);
      }
    }
  }

  MixtureSplitter splitter_;
  MixtureCells cells_;
  Eigen::MatrixXd spread_;
};

/// Every point stays as it is. The noise is represented by its mean, so its whole standard
/// deviation counts as error.
class NoiseFreePropagator final : public Propagator {
 public:
  explicit NoiseFreePropagator(const PropagatorSettings& settings)
      : noise_w2_(std::sqrt(settings.noise.covariance.trace())) {}

  void update(const Points& /*stepped*/, const Eigen::VectorXd& weights, const Executor& /*run*/,
              StageMap& out) override {
    out.identity = true;
    out.weights = weights;
    out.compression_w2 = 0.0;
  }

  [[nodiscard]] double noise_w2() const override { return noise_w2_; }

 private:
  double noise_w2_;
};

template <class Kind>
std::unique_ptr<Propagator> make(const PropagatorSettings& settings) {
  return std::make_unique<Kind>(settings);
}

}  // namespace

StageMap Propagator::stage_map(const Points& stepped, const Eigen::VectorXd& weights) {
  StageMap map;
  update(stepped, weights, run_in_turn, map);
  return map;
}

const std::vector<PropagatorEntry>& propagators() {
  static const std::vector<PropagatorEntry> table = {
      {"mixture",
       "the noise stays Gaussian and is cut into cells with the points after every step; fast",
       make<MixturePropagator>},
      {"compressed", "product with the noise quantiser, compressed after every step (Eq. 4-5, 4-6)",
       make<CompressedPropagator>},
      {"moment_matched",
       "the same with Lloyd's quantiser and refined compression, and the covariance restored",
       make<MomentMatchedPropagator>},
      {"soft", "as \"compressed\", but with the soft assignments of Algorithm 1; slow",
       make<SoftPropagator>},
      {"noise_free", "the belief's points only; the noise counts as error in the certificates",
       make<NoiseFreePropagator>, false},
  };
  return table;
}

const PropagatorEntry& propagator_entry(std::string_view name) {
  return named_entry(propagators(), name, "propagator");
}

std::unique_ptr<Propagator> make_propagator(std::string_view name,
                                            const PropagatorSettings& settings) {
  check_gaussian(settings.noise);
  if (!settings.noise.mean.isZero(0.0)) {
    throw std::invalid_argument("propagator: the noise must have zero mean");
  }
  return propagator_entry(name).make(settings);
}

}  // namespace qsmpc::controller

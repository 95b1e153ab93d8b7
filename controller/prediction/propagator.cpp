#include "controller/prediction/propagator.hpp"

#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "controller/measure/compression.hpp"
#include "controller/prediction/moment_matching.hpp"

namespace qsmpc {
namespace {

constexpr const char* kCompressed = "compressed";
constexpr const char* kMomentMatched = "moment_matched";
constexpr const char* kNoiseFree = "noise_free";

/// Products with the noise quantiser, compressed to a number of clusters.
class CompressedPropagator : public Propagator {
 public:
  CompressedPropagator(const PropagatorSettings& settings, int refinements)
      : noise_(quantise(settings.noise, settings.noise_points)),
        compressed_points_(settings.compressed_points),
        refinements_(refinements) {
    if (compressed_points_ < 1) {
      throw std::invalid_argument("propagator: at least one point must be kept");
    }
    if (refinements_ < 0) {
      throw std::invalid_argument("propagator: refinements must not be negative");
    }
  }

  [[nodiscard]] StageMap stage_map(const Points& stepped,
                                   const Eigen::VectorXd& weights) const override {
    if (!stepped.allFinite()) return lost_map(stepped, weights);
    const DiscreteMeasure product = product_measure(stepped, weights);
    const Compression compression = compress(product, compressed_points_, refinements_);
    StageMap map = sparse_map(compression, weights);
    finish({.locations = stepped, .weights = weights}, compression, map);
    return map;
  }

  [[nodiscard]] double noise_w2() const override { return noise_.w2; }

 private:
  /// What is done to the map from `stepped` to the cluster means, which is complete by itself.
  virtual void finish(const DiscreteMeasure& /*stepped*/, const Compression& /*compression*/,
                      StageMap& /*map*/) const {}

  /// The map of points that are not finite: all into one cluster, at infinite cost.
  [[nodiscard]] static StageMap lost_map(const Points& stepped, const Eigen::VectorXd& weights) {
    StageMap map;
    map.row_begin = {0, static_cast<int>(weights.size())};
    map.column.resize(weights.size());
    std::iota(map.column.begin(), map.column.end(), 0);
    map.coefficient.assign(weights.begin(), weights.end());
    map.offset = Points::Zero(stepped.rows(), 1);
    map.weights = Eigen::VectorXd::Constant(1, weights.sum());
    map.compression_w2 = std::numeric_limits<double>::infinity();
    return map;
  }

  /// All sums f_i + d_j; the product of point i and noise j stands at i·m + j.
  [[nodiscard]] DiscreteMeasure product_measure(const Points& stepped,
                                                const Eigen::VectorXd& weights) const {
    const Eigen::Index noise_size = noise_.measure.size();
    DiscreteMeasure product{.locations = Points(stepped.rows(), stepped.cols() * noise_size),
                            .weights = Eigen::VectorXd(stepped.cols() * noise_size)};
    for (Eigen::Index i = 0; i < stepped.cols(); ++i) {
      product.locations.middleCols(i * noise_size, noise_size) =
          noise_.measure.locations.colwise() + stepped.col(i);
      product.weights.segment(i * noise_size, noise_size) = weights[i] * noise_.measure.weights;
    }
    return product;
  }

  /// With Γ_ni = Σ_{j: a(i,j) = n} γ_j: A_ni = ρ_i Γ_ni / ρ̃_n and
  /// b_n = Σ_i ρ_i Σ_{j: a(i,j) = n} γ_j d_j / ρ̃_n.
  [[nodiscard]] StageMap sparse_map(const Compression& compression,
                                    const Eigen::VectorXd& weights) const {
    const Eigen::Index sources = weights.size();
    const Eigen::Index noise_size = noise_.measure.size();
    const Eigen::Index clusters = compression.measure.size();
    StageMap map;
    map.weights = compression.measure.weights;
    map.compression_w2 = compression.w2;
    map.offset = Points::Zero(noise_.measure.dim(), clusters);
    Eigen::MatrixXd share = Eigen::MatrixXd::Zero(sources, clusters);  // ρ_i Γ_ni, by column n
    for (Eigen::Index i = 0; i < sources; ++i) {
      for (Eigen::Index j = 0; j < noise_size; ++j) {
        const int n = compression.assignment[i * noise_size + j];
        const double mass = weights[i] * noise_.measure.weights[j];
        share(i, n) += mass;
        map.offset.col(n) += mass * noise_.measure.locations.col(j);
      }
    }
    map.row_begin.push_back(0);
    for (Eigen::Index n = 0; n < clusters; ++n) {
      map.offset.col(n) /= map.weights[n];
      for (Eigen::Index i = 0; i < sources; ++i) {
        if (share(i, n) == 0.0) continue;
        map.column.push_back(static_cast<int>(i));
        map.coefficient.push_back(share(i, n) / map.weights[n]);
      }
      map.row_begin.push_back(static_cast<int>(map.column.size()));
    }
    return map;
  }

  GaussianQuantisation noise_;
  int compressed_points_;
  int refinements_;
};

/// The clusters, spread about their mean so that they have the covariance of the stepped points
/// plus that of the noise: what the noise quantiser and the compression lost.
class MomentMatchedPropagator final : public CompressedPropagator {
 public:
  explicit MomentMatchedPropagator(const PropagatorSettings& settings)
      : CompressedPropagator(settings, settings.refinements),
        noise_covariance_(settings.noise.covariance) {}

 private:
  /// The clusters' means are conditional means of the products, so that the two parts of a
  /// product's way, to its cluster's mean and from there to where the spread puts it, are
  /// uncorrelated: their squares add.
  void finish(const DiscreteMeasure& stepped, const Compression& compression,
              StageMap& map) const override {
    const Eigen::MatrixXd target = covariance_of(stepped) + noise_covariance_;
    map.spread = spread_between(covariance_of(compression.measure), target);
    map.compression_w2 =
        std::hypot(compression.w2, spread_w2(covariance_of(compression.measure), map.spread));
  }

  Eigen::MatrixXd noise_covariance_;
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
       "the same, compressed with refinements and spread to the covariance that it should have"},
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
  if (name == kCompressed) {
    return std::make_unique<CompressedPropagator>(settings, /*refinements=*/0);
  }
  if (name == kMomentMatched) return std::make_unique<MomentMatchedPropagator>(settings);
  if (name == kNoiseFree) return std::make_unique<NoiseFreePropagator>(settings);
  std::string known;
  for (const PropagatorEntry& entry : propagators()) {
    known += (known.empty() ? "" : ", ") + entry.name;
  }
  throw std::invalid_argument("no propagator '" + std::string(name) + "'; known are: " + known);
}

}  // namespace qsmpc

#include "controller/prediction/product_map.hpp"

#include <limits>
#include <numeric>

#include "controller/storage.hpp"

namespace qsmpc::controller {
namespace {

/// Composition of the clusters of products f_i + d_j; cluster n has mass ρ̃_n.
struct Clusters {
  Eigen::MatrixXd share;  ///< sources x clusters; the mass of n that comes from products of i
  Points noise_moment;    ///< d x clusters; Σ mass · d_j over the products in n
};

/// A_ni = share_in / ρ̃_n and b_n = noise_moment_n / ρ̃_n. Clusters without mass are left out.
StageMap map_to_means(const Clusters& clusters, const Eigen::VectorXd& masses) {
  const Eigen::Index kept = (masses.array() > 0.0).count();
  StageMap map;
  map.weights.resize(kept);
  map.offset.resize(clusters.noise_moment.rows(), kept);
  map.shares.begin.push_back(0);
  Eigen::Index at = 0;
  for (Eigen::Index n = 0; n < masses.size(); ++n) {
    if (masses[n] <= 0.0) continue;
    map.weights[at] = masses[n];
    map.offset.col(at) = clusters.noise_moment.col(n) / masses[n];
    for (Eigen::Index i = 0; i < clusters.share.rows(); ++i) {
      if (clusters.share(i, n) == 0.0) continue;
      map.shares.column.push_back(static_cast<int>(i));
      map.shares.value.push_back(clusters.share(i, n) / masses[n]);
    }
    map.shares.begin.push_back(static_cast<int>(map.shares.column.size()));
    ++at;
  }
  return map;
}

}  // namespace

DiscreteMeasure product_measure(const DiscreteMeasure& stepped, const DiscreteMeasure& noise) {
  const Eigen::Index noise_size = noise.size();
  DiscreteMeasure product{.locations = Points(stepped.dim(), stepped.size() * noise_size),
                          .weights = Eigen::VectorXd(stepped.size() * noise_size)};
  for (Eigen::Index i = 0; i < stepped.size(); ++i) {
    product.locations.middleCols(i * noise_size, noise_size) =
        noise.locations.colwise() + stepped.locations.col(i);
    product.weights.segment(i * noise_size, noise_size) = stepped.weights[i] * noise.weights;
  }
  return product;
}

StageMap cluster_map(const Compression& compression, const Eigen::VectorXd& weights,
                     const DiscreteMeasure& noise) {
  const Eigen::Index count = compression.measure.size();
  Clusters clusters{.share = Eigen::MatrixXd::Zero(weights.size(), count),
                    .noise_moment = Points::Zero(noise.dim(), count)};
  for (Eigen::Index i = 0; i < weights.size(); ++i) {
    for (Eigen::Index j = 0; j < noise.size(); ++j) {
      const int n = compression.assignment[i * noise.size() + j];
      const double mass = weights[i] * noise.weights[j];
      clusters.share(i, n) += mass;
      clusters.noise_moment.col(n) += mass * noise.locations.col(j);
    }
  }
  StageMap map = map_to_means(clusters, compression.measure.weights);
  map.compression_w2 = compression.w2;
  return map;
}

StageMap cluster_map(const SoftCompression& compression, const Eigen::VectorXd& weights,
                     const DiscreteMeasure& noise) {
  const Eigen::Index count = compression.measure.size();
  Clusters clusters{.share = Eigen::MatrixXd(weights.size(), count),
                    .noise_moment = Points::Zero(noise.dim(), count)};
  for (Eigen::Index i = 0; i < weights.size(); ++i) {
    const auto belonging = compression.responsibilities.middleRows(i * noise.size(), noise.size());
    const Eigen::MatrixXd masses = weights[i] * (noise.weights.asDiagonal() * belonging);
    clusters.share.row(i) = masses.colwise().sum();
    clusters.noise_moment += noise.locations * masses;
  }
  StageMap map = map_to_means(clusters, clusters.share.colwise().sum().transpose());
  map.compression_w2 = compression.w2;
  return map;
}

void cluster_map(const MixtureCells& cells, const Executor& run, StageMap& out) {
  const int count = cells.cells();
  const Eigen::Index dim = static_cast<Eigen::Index>(cells.noise_mean.size()) / count;
  out.identity = false;
  out.shares.begin = cells.begin;
  make_room(out.shares.column, cells.source.size());
  make_room(out.shares.value, cells.source.size());
  out.shares.column = cells.source;
  out.shares.value.resize(cells.mass.size());
  for_chunks(run, count, [&](ParticleRange range, int) {
    for (std::ptrdiff_t n = range.begin; n < range.end; ++n) {
      const double inverse = 1.0 / cells.weight[n];
      for (int k = cells.begin[n]; k < cells.begin[n + 1]; ++k) {
        out.shares.value[k] = cells.mass[k] * inverse;
      }
    }
  });
  out.spread.resize(0, 0);
  out.offset = Eigen::Map<const Points>(cells.noise_mean.data(), dim, count);
  out.weights = Eigen::Map<const Eigen::VectorXd>(cells.weight.data(), count);
  out.compression_w2 = cells.w2;
}

StageMap lost_map(const DiscreteMeasure& stepped) {
  StageMap map;
  const int size = static_cast<int>(stepped.size());
  map.shares.begin = {0, size};
  map.shares.column.resize(size);
  std::iota(map.shares.column.begin(), map.shares.column.end(), 0);
  map.shares.value.assign(stepped.weights.begin(), stepped.weights.end());
  map.offset = Points::Zero(stepped.dim(), 1);
  map.weights = Eigen::VectorXd::Constant(1, stepped.weights.sum());
  map.compression_w2 = std::numeric_limits<double>::infinity();
  return map;
}

}  // namespace qsmpc::controller

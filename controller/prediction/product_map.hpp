// The products of stepped points and noise points, and the maps to the means of their clusters.
#pragma once

#include "controller/measure/compression/compression.hpp"
#include "controller/measure/compression/mixture_split.hpp"
#include "controller/measure/compression/soft_compression.hpp"
#include "controller/measure/measures.hpp"
#include "controller/prediction/stage_map.hpp"

namespace qsmpc::controller {

/// All sums f_i + d_j of stepped points and noise points (Eq. 4-5); that of i and j has the index
/// i·m + j, where m is the number of noise points.
[[nodiscard]] DiscreteMeasure product_measure(const DiscreteMeasure& stepped,
                                              const DiscreteMeasure& noise);

/// The map from stepped points with these weights to the means of the clusters into which
/// `compression` puts their products with `noise`.
[[nodiscard]] StageMap cluster_map(const Compression& compression, const Eigen::VectorXd& weights,
                                   const DiscreteMeasure& noise);

/// The same for soft clusters: fixes the products' shares in the clusters instead of assignments.
[[nodiscard]] StageMap cluster_map(const SoftCompression& compression,
                                   const Eigen::VectorXd& weights, const DiscreteMeasure& noise);

/// The map from stepped points to the means of the cells that their mixture is cut into; reuses the
/// storage of `out`.
void cluster_map(const MixtureCells& cells, const Executor& run, StageMap& out);

/// The map of non-finite stepped points: all into one cluster, at infinite cost.
[[nodiscard]] StageMap lost_map(const DiscreteMeasure& stepped);

}  // namespace qsmpc::controller

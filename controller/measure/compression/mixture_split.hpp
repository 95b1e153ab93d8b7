// Cuts a Gaussian mixture into cells, each of which becomes one point: a prediction absorbs
// Gaussian noise in this way at a constant number of points, without quantising the noise.
//
// The mixture is Σ ρ_i N(f_i, Σ): the sources f_i plus noise w ~ N(0, Σ). In the axes of Σ the
// noise has independent coordinates, so that the probability of a box, and the first and second
// moments over it, are products of one-dimensional closed forms. Cells are boxes in these axes,
// made by repeatedly splitting those with the largest spread at their means. The part of a source
// in a cell is a region of its noise; everything in a cell moves to the cell's mean. As the parts
// of a source partition its noise, this is a coupling of the mixture with the result, and its cost
// is the variance within the cells, exactly (docs/theory/quantisation.md).
//
// A source is cut into a bounded number of parts: where a part would carry less than the share
// 1/parts, the whole of the source in the cell goes to the other side of the split. This bounds the
// work by sources x parts, as a noise quantiser of `parts` points would, and keeps the result a
// partition.
#pragma once

#include <memory>
#include <vector>

#include <Eigen/Core>

#include "controller/measure/measures.hpp"
#include "controller/parallel.hpp"

namespace qsmpc::controller {

/// Which share of which source is in which cell. Storage is reused from call to call.
struct MixtureCells {
  std::vector<int> begin;      ///< cells + 1; the parts of cell n are [begin[n], begin[n + 1])
  std::vector<int> source;     ///< of each part, increasing within a cell
  std::vector<double> mass;    ///< of each part: ρ_i P(w in the part)
  std::vector<double> weight;  ///< cells; the sum of the cell's parts, > 0
  /// d x cells, row by row: the cell's mean less the mixture's.
  std::vector<double> mean;
  /// d x cells, row by row: the mean of the noise over the cell's parts, by mass.
  std::vector<double> noise_mean;
  double w2 = 0.0;  ///< of the coupling; W2 of the mixture to the cells' means is at most this
  Eigen::MatrixXd covariance;        ///< d x d, of the cells' means
  Eigen::MatrixXd whole_covariance;  ///< d x d, of the mixture

  [[nodiscard]] int cells() const { return static_cast<int>(weight.size()); }
};

class MixtureSplitter {
 public:
  /// covariance: Σ, d x d, positive semidefinite, d ≤ 8. cells, parts: ≥ 1. Throws
  /// std::invalid_argument otherwise.
  MixtureSplitter(const Eigen::MatrixXd& covariance, int cells, int parts);
  ~MixtureSplitter();

  /// Cuts the mixture about `sources` (d x n, finite) with `weights` (n, non-negative, summing to
  /// one) into at most the requested number of cells; fewer only where nothing is left to split.
  /// Allocates nothing once it has processed a mixture of this size; with several threads, whose
  /// memory is divided differently each time, hardly anything.
  void split(const Points& sources, const Eigen::VectorXd& weights, const Executor& run,
             MixtureCells& out);

 private:
  struct Work;
  std::unique_ptr<Work> work_;
};

}  // namespace qsmpc::controller

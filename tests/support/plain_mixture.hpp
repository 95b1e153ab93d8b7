// The mixture split of controller/measure/compression/mixture_split.hpp in its plainest form: one
// struct per piece of a source, one loop over the pieces per sum, the standard library's erfc and
// exp. Tests compare the fast implementation with it.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "controller/measure/measures.hpp"

namespace qsmpc::testing {

/// The part of one source that lies in one cell.
struct PlainPart {
  int source = 0;
  double mass = 0.0;
};

struct PlainCell {
  std::vector<PlainPart> parts;  ///< by increasing source
  double weight = 0.0;
  Eigen::VectorXd noise_mean;  ///< d
  Eigen::VectorXd mean;        ///< d; of the mixture over the cell
  Eigen::MatrixXd covariance;  ///< d x d; of the mixture over the cell
};

struct PlainMixture {
  std::vector<PlainCell> cells;
  double w2 = 0.0;
};

/// The mixture of N(sources.col(i), covariance) with `weights`, split into at most `cells` cells,
/// each source into at most `parts` parts.
[[nodiscard]] PlainMixture plain_split(const Eigen::MatrixXd& covariance, int cells, int parts,
                                       const controller::Points& sources,
                                       const Eigen::VectorXd& weights);

}  // namespace qsmpc::testing

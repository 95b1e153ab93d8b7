// Level lines of a function known at the nodes of a grid.
#pragma once

#include <vector>

#include <Eigen/Core>

namespace qsmpc::harness {

/// The boundary of {values > level} by marching squares with linear interpolation: closed lines,
/// one point per column (row index, column index; fractional between nodes), the first point
/// repeated at the end. Values outside the grid and on its outermost nodes count as below `level`,
/// so that every line closes; so do non-finite values. At a saddle, the mean of the cell's corners
/// decides.
[[nodiscard]] std::vector<Eigen::Matrix2Xd> contour_lines(
    const Eigen::Ref<const Eigen::MatrixXd>& values, double level);

}  // namespace qsmpc::harness

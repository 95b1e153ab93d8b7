// Level lines of a function known at the nodes of a grid.
#pragma once

#include <vector>

#include <Eigen/Core>

namespace qsmpc::harness {

/// The boundary of {values > level} by marching squares with linear interpolation: closed lines,
/// one point a column (row index, column index; fractions between the nodes), the first point
/// repeated at the end. Outside of the grid and on its outermost nodes the values are taken to be
/// below `level`, so that every line closes. At a saddle, the mean of the cell's corners decides.
/// Values that are not finite are taken to be below `level`, too.
[[nodiscard]] std::vector<Eigen::Matrix2Xd> contour_lines(
    const Eigen::Ref<const Eigen::MatrixXd>& values, double level);

}  // namespace qsmpc::harness

// The cheapest way to a goal from anywhere in a rectangle of the plane, where the price of a metre
// varies with the place.
//
//   const TravelField field(grid, prices, goal);
//   field.cost(position);         // of the cheapest way to the goal
//   field.trace(position, way);   // the way itself
//
// The cost V solves the eikonal equation |∇V| = price, V(goal) = 0, by fast marching: J. A.
// Sethian, "A fast marching level set method for monotonically advancing fronts", PNAS 93, 1996.
#pragma once

#include <vector>

#include <Eigen/Core>

namespace qsmpc::controller {

/// Nodes at origin + spacing · (column, row).
struct PlaneGrid {
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();  ///< m
  double spacing = 1.0;                              ///< m, > 0
  Eigen::Index columns = 2;                          ///< along x, ≥ 2
  Eigen::Index rows = 2;                             ///< along y, ≥ 2

  [[nodiscard]] Eigen::Vector2d node(Eigen::Index column, Eigen::Index row) const {
    return origin +
           spacing * Eigen::Vector2d(static_cast<double>(column), static_cast<double>(row));
  }
};

class TravelField {
 public:
  /// prices: of a metre at each node, columns x rows, finite and > 0. The goal is moved to the
  /// nearest point of the grid. Throws std::invalid_argument on prices of another size, not finite
  /// or not > 0.
  TravelField(const PlaneGrid& grid, Eigen::ArrayXXd prices, const Eigen::Vector2d& goal);

  /// The cost of the cheapest way from `position`, or the grid's nearest point if that is outside,
  /// to the goal. Accurate to a few per cent, as the method is first-order.
  [[nodiscard]] double cost(const Eigen::Vector2d& position) const;

  /// The cost of the straight line between two points; may stop early once it exceeds `enough`.
  [[nodiscard]] double cost_of_line(const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                                    double enough) const;

  /// The nodes on a cheapest way, from the one nearest to `position` to the one nearest to the
  /// goal; the cost falls from each to the next. Replaces the content of `way`.
  void trace(const Eigen::Vector2d& position, std::vector<Eigen::Vector2d>& way) const;

  [[nodiscard]] const PlaneGrid& grid() const { return grid_; }

 private:
  struct Cell {
    Eigen::Index column = 0;
    Eigen::Index row = 0;
    double right = 0.0;  // weight of the neighbours at column + 1
    double up = 0.0;
  };

  [[nodiscard]] Cell cell_at(const Eigen::Vector2d& position) const;
  [[nodiscard]] static double interpolate(const Eigen::ArrayXXd& values, const Cell& cell);
  [[nodiscard]] double arrival(Eigen::Index column, Eigen::Index row) const;
  void march(const Eigen::Vector2d& goal);

  PlaneGrid grid_;
  Eigen::ArrayXXd prices_;  // columns x rows
  Eigen::ArrayXXd costs_;
};

}  // namespace qsmpc::controller

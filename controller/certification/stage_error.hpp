// Bounds on an error of the state at a stage, as affine surrogates propagate them.
#pragma once

#include <cstddef>

#include <Eigen/Core>

#include "controller/measure/normal/norm_orders.hpp"

namespace qsmpc::controller {

/// Bounds on an error e: a row for each coordinate, and a column for each norm.
struct StageError {
  static constexpr Eigen::Index kColumns = 2 + static_cast<Eigen::Index>(kHigherOrders.size());
  using Bounds = Eigen::Matrix<double, Eigen::Dynamic, kColumns>;

  Bounds bounds;  ///< n x kColumns; columns as named below

  /// The zero error in n coordinates.
  [[nodiscard]] static StageError none(Eigen::Index n) {
    return {.bounds = Bounds::Zero(n, kColumns)};
  }

  /// n, bounds √E[e_i²; inside]
  [[nodiscard]] auto mean_square() { return bounds.col(0); }
  [[nodiscard]] auto mean_square() const { return bounds.col(0); }
  /// n, bounds (E[|e_i|^p; inside])^{1/p}, p = kHigherOrders[k]
  [[nodiscard]] auto higher(std::size_t k) { return bounds.col(1 + static_cast<Eigen::Index>(k)); }
  [[nodiscard]] auto higher(std::size_t k) const {
    return bounds.col(1 + static_cast<Eigen::Index>(k));
  }
  /// n, bounds |e_i| on the event that the next stage is inside
  [[nodiscard]] auto largest() { return bounds.col(kColumns - 1); }
  [[nodiscard]] auto largest() const { return bounds.col(kColumns - 1); }
};

}  // namespace qsmpc::controller

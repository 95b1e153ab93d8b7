// A target that is a path, as the scenario states it and as derived.
#pragma once

#include <memory>
#include <optional>

#include <Eigen/Core>

#include "controller/reference/path_target.hpp"

#pragma GCC visibility push(default)

namespace qsmpc::harness {

/// A path to be followed, as written.
struct TargetPath {
  /// n x 2: x and y; or n x 4: x, y and the widths to the right and to the left edge, m.
  Eigen::MatrixXd rows;
  bool closed = false;
  bool fast = false;                 ///< as fast as the limits allow; else at `speed`
  double speed = 1.0;                ///< m/s
  controller::SpeedLimits limits{};  ///< of a fast path
  int laps = 1;                      ///< of a closed path

  [[nodiscard]] bool has_widths() const { return rows.cols() > 2; }
};

}  // namespace qsmpc::harness

#pragma GCC visibility pop

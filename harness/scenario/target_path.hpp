// A target that is a path: what the scenario says of it, and what follows from that.
#pragma once

#include <memory>
#include <optional>

#include <Eigen/Core>

#include "controller/reference/path_target.hpp"

#pragma GCC visibility push(default)

namespace qsmpc::harness {

/// A path to be followed, as it is written.
struct TargetPath {
  /// n x 2: x and y, or n x 4: and the widths from there to the right and to the left edge, m.
  Eigen::MatrixXd rows;
  bool closed = false;
  bool fast = false;                 ///< as fast as the limits allow, else at `speed`
  double speed = 1.0;                ///< m/s
  controller::SpeedLimits limits{};  ///< of a fast one
  int laps = 1;                      ///< of a closed one

  [[nodiscard]] bool has_widths() const { return rows.cols() > 2; }
};

}  // namespace qsmpc::harness

#pragma GCC visibility pop

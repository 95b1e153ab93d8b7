// The Savitzky-Golay filter of planned inputs: each becomes the value, at its own period, of the
// parabola that fits those about it best.
#pragma once

#include <Eigen/Core>

namespace qsmpc::controller {

class InputSmoothing {
 public:
  /// half_window: periods to either side; 0 for no filter, or ≥ 2 (through three points the
  /// parabola is exact). rest: the inputs before the drive, input_dim.
  InputSmoothing(int half_window, const Eigen::VectorXd& rest);

  /// The inputs before the drive are those at rest again.
  void reset();
  /// Tells that `input` (input_dim) has been applied.
  void note_applied(const Eigen::VectorXd& input);
  /// Filters `inputs` (input_dim x horizon): before them are those that were applied, behind them
  /// the last is held. Allocates in the first call only.
  void smooth(Eigen::MatrixXd& inputs);

 private:
  Eigen::Index half_;
  Eigen::VectorXd rest_;
  Eigen::VectorXd window_;  // 2 half + 1
  Eigen::MatrixXd past_;    // input_dim x half, the latest last
  Eigen::MatrixXd padded_;
};

}  // namespace qsmpc::controller

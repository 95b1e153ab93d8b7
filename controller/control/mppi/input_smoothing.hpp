// The Savitzky-Golay filter of planned inputs: each is replaced by the value, at its period, of the
// least-squares parabola through the inputs around it.
#pragma once

#include <Eigen/Core>

namespace qsmpc::controller {

class InputSmoothing {
 public:
  /// half_window: periods to either side; 0 for no filter, or ≥ 2 (through three points the
  /// parabola is exact, so that 1 would not smooth). rest: the inputs before the drive, input_dim.
  InputSmoothing(int half_window, const Eigen::VectorXd& rest);

  /// A new drive: all past inputs are those at rest.
  void reset();
  /// Records that `input` (input_dim) has been applied.
  void note_applied(const Eigen::VectorXd& input);
  /// Filters `inputs` (input_dim x horizon) in place, padded in front by the inputs applied and
  /// behind by the last one. Allocates in the first call only.
  void smooth(Eigen::MatrixXd& inputs);

 private:
  Eigen::Index half_;
  Eigen::VectorXd rest_;
  Eigen::VectorXd window_;  // 2 half + 1
  Eigen::MatrixXd past_;    // input_dim x half, the latest last
  Eigen::MatrixXd padded_;
};

}  // namespace qsmpc::controller

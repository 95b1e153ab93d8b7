#include "controller/control/mppi/input_smoothing.hpp"

namespace qsmpc::controller {

InputSmoothing::InputSmoothing(int half_window, const Eigen::VectorXd& rest)
    : half_(half_window), rest_(rest) {
  // Savitzky and Golay 1964, of second order: (3h² + 3h − 1 − 5i²) · 3 / ((2h−1)(2h+1)(2h+3)).
  window_.resize(2 * half_ + 1);
  const auto h = static_cast<double>(half_);
  const double scale = 3.0 / ((2.0 * h - 1.0) * (2.0 * h + 1.0) * (2.0 * h + 3.0));
  for (Eigen::Index k = 0; k < window_.size(); ++k) {
    const auto i = static_cast<double>(k - half_);
    window_[k] = scale * (3.0 * h * h + 3.0 * h - 1.0 - 5.0 * i * i);
  }
  reset();
}

void InputSmoothing::reset() { past_ = rest_.replicate(1, half_); }

void InputSmoothing::note_applied(const Eigen::VectorXd& input) {
  if (half_ == 0) return;
  for (Eigen::Index k = 0; k + 1 < half_; ++k) past_.col(k) = past_.col(k + 1);
  past_.col(half_ - 1) = input;
}

void InputSmoothing::smooth(Eigen::MatrixXd& inputs) {
  if (half_ == 0) return;
  const Eigen::Index horizon = inputs.cols();
  padded_.resize(inputs.rows(), horizon + 2 * half_);
  padded_.leftCols(half_) = past_;
  padded_.middleCols(half_, horizon) = inputs;
  padded_.rightCols(half_).colwise() = inputs.col(horizon - 1);
  for (Eigen::Index k = 0; k < horizon; ++k) {
    inputs.col(k).noalias() = padded_.middleCols(k, window_.size()) * window_;
  }
}

}  // namespace qsmpc::controller

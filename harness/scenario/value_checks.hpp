// Checks of a value beyond its type and size; each returns the problem in the words that an error
// uses for what was found, or nothing.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "controller/regions/safe_set.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::harness {

/// Copies the lower triangle of the square, finite `matrix` to the upper one where they differ by
/// rounding only. Returns why the matrix is not symmetric and positive semidefinite: entries that
/// differ by more than 1e-9 of the largest entry, or an eigenvalue below minus 1e-9 of it.
[[nodiscard]] std::optional<std::string> make_semidefinite(Eigen::MatrixXd& matrix);

/// The least variance other than 0. Certificates divide by the variance and square the result;
/// below this limit that leaves the range of floating-point numbers, and a bound may be too low.
inline constexpr double kLeastVariance = 1e-300;

/// The first variance of a covariance that is neither 0 nor at least kLeastVariance, e.g.
/// "a variance of 1e-305".
[[nodiscard]] std::optional<std::string> tiny_variance(const Eigen::MatrixXd& covariance);

/// What is expected where `tiny_variance` found something.
[[nodiscard]] std::string expected_variances();

/// The largest magnitude of a state, in its unit: simulators fail not far beyond it.
inline constexpr double kLargestCoordinate = 1e9;

/// The bound or obstacle that makes the state `point` unsafe, its body included, naming states as
/// `states` does, e.g. "x = 13, outside of the bounds -1 < x < 12" or
/// "a body that reaches 0.1 into safe_set.obstacles.0".
[[nodiscard]] std::optional<std::string> why_unsafe(const Eigen::VectorXd& point,
                                                    const controller::SafeSet& safe_set,
                                                    const std::vector<models::Coordinate>& states);

/// Width and height of a video frame, pixels.
struct FrameSize {
  int width = 0;
  int height = 0;
};

inline constexpr int kMostStages = 1000;  // of a horizon

inline constexpr int kLeastFrameSide = 64;    // pixels; smaller frames show nothing
inline constexpr int kMostFrameWidth = 7680;  // pixels, 8K
inline constexpr int kMostFrameHeight = 4320;

/// The size written as "1280x720": both even, as video encoders require, and within the limits
/// above; nothing for any other `text`.
[[nodiscard]] std::optional<FrameSize> parse_frame_size(std::string_view text);

/// The expectation that an error states where `parse_frame_size` returned nothing.
[[nodiscard]] std::string expected_frame_size();

}  // namespace qsmpc::harness

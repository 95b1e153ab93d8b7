// What a value must be beyond its type and size; each returns what is wrong in the words that an
// error uses for what was found, or nothing.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "controller/regions/safe_set.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::harness {

/// Replaces the upper triangle of the square, finite `matrix` by the lower one where they differ by
/// rounding only. Returns what keeps it from being symmetric and positive semidefinite: entries
/// that differ by more than 1e-9 of the largest entry, or an eigenvalue below minus 1e-9 of it.
[[nodiscard]] std::optional<std::string> make_semidefinite(Eigen::MatrixXd& matrix);

/// The least variance that is not 0: certificates divide by it and square what comes out, and below
/// it that leaves the range of numbers, so that a bound may come out too low.
inline constexpr double kLeastVariance = 1e-300;

/// The first variance of a covariance that is neither 0 nor at least kLeastVariance, e.g.
/// "a variance of 1e-305".
[[nodiscard]] std::optional<std::string> tiny_variance(const Eigen::MatrixXd& covariance);

/// What is expected where `tiny_variance` found something.
[[nodiscard]] std::string expected_variances();

/// The largest number of a state, in its unit: simulators give up not far beyond.
inline constexpr double kLargestCoordinate = 1e9;

/// Which bound or obstacle makes the state `point` unsafe, its body included, naming states as
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

inline constexpr int kLeastFrameSide = 64;    // pixels; less shows nothing
inline constexpr int kMostFrameWidth = 7680;  // pixels, 8K
inline constexpr int kMostFrameHeight = 4320;

/// The size written as "1280x720": both even, as video encoders need, and within the limits above;
/// nothing if `text` is something else.
[[nodiscard]] std::optional<FrameSize> parse_frame_size(std::string_view text);

/// What an error says is expected where `parse_frame_size` found nothing.
[[nodiscard]] std::string expected_frame_size();

}  // namespace qsmpc::harness

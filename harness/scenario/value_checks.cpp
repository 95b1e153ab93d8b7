#include "harness/scenario/value_checks.hpp"

#include <cmath>

#include <fmt/format.h>

#include "controller/regions/unsafe_set.hpp"
#include "harness/text/number_parse.hpp"
#include "models/linear_algebra.hpp"

namespace qsmpc::harness {
namespace {

// Relative to the largest entry: far above the rounding of a matrix that a program printed with
// ten digits, far below an entry that somebody meant.
constexpr double kMatrixTolerance = 1e-9;

std::optional<int> parse_side(std::string_view text, int most) {
  const std::optional<int> side = parse_integer<int>(text);
  const bool is_allowed = side && *side >= kLeastFrameSide && *side <= most && *side % 2 == 0;
  return is_allowed ? side : std::nullopt;
}

}  // namespace

std::optional<std::string> make_semidefinite(Eigen::MatrixXd& matrix) {
  const double scale = matrix.cwiseAbs().maxCoeff();
  if (scale == 0.0) return std::nullopt;
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    for (Eigen::Index j = 0; j < i; ++j) {
      if (std::abs(matrix(i, j) / scale - matrix(j, i) / scale) > kMatrixTolerance) {
        return fmt::format("{} in row {}, column {} and {} in its mirror image", matrix(i, j),
                           i + 1, j + 1, matrix(j, i));
      }
      matrix(j, i) = matrix(i, j);
    }
  }
  // Scaled, so that no entry however large or small overflows on the way to the eigenvalues.
  const double least = models::symmetric_eigenvalues(matrix / scale).minCoeff();
  if (least >= -kMatrixTolerance) return std::nullopt;
  return fmt::format("a matrix with the eigenvalue {:.6g}", least * scale);
}

std::optional<std::string> why_unsafe(const Eigen::VectorXd& point,
                                      const controller::SafeSet& safe_set,
                                      const std::vector<models::Coordinate>& states) {
  const controller::Box& bounds = safe_set.bounds;
  for (Eigen::Index i = 0; i < point.size(); ++i) {
    if (point[i] > bounds.lower[i] && point[i] < bounds.upper[i]) continue;
    return fmt::format("{0} = {1}, outside of the bounds {2} < {0} < {3}",
                       states[static_cast<std::size_t>(i)].name, point[i], bounds.lower[i],
                       bounds.upper[i]);
  }
  for (std::size_t k = 0; k < safe_set.obstacles.size(); ++k) {
    const controller::Box& obstacle = safe_set.obstacles[k];
    const bool inside = (point.array() >= obstacle.lower.array()).all() &&
                        (point.array() <= obstacle.upper.array()).all();
    if (inside) return fmt::format("a state inside safe_set.obstacles.{}", k);
  }
  if (safe_set.body.is_point()) return std::nullopt;
  const double clearance = controller::clearance(point, controller::UnsafeSet(safe_set));
  if (clearance > 0.0) return std::nullopt;
  return fmt::format("a vehicle that reaches {} m into the unsafe set", -clearance);
}

std::optional<FrameSize> parse_frame_size(std::string_view text) {
  const std::size_t cross = text.find('x');
  if (cross == std::string_view::npos) return std::nullopt;
  const std::optional<int> width = parse_side(text.substr(0, cross), kMostFrameWidth);
  const std::optional<int> height = parse_side(text.substr(cross + 1), kMostFrameHeight);
  if (!width || !height) return std::nullopt;
  return FrameSize{.width = *width, .height = *height};
}

std::string expected_frame_size() {
  return fmt::format("WIDTHxHEIGHT in even numbers of pixels from {0}x{0} to {1}x{2}",
                     kLeastFrameSide, kMostFrameWidth, kMostFrameHeight);
}

}  // namespace qsmpc::harness

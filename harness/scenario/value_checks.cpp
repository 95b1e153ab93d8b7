#include "harness/scenario/value_checks.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "controller/regions/unsafe_set.hpp"
#include "harness/scenario/target_course.hpp"
#include "harness/text/number_parse.hpp"
#include "models/linear_algebra.hpp"

namespace qsmpc::harness {
namespace {

// Relative to the largest entry: far above the rounding of a matrix printed with ten digits, far
// below an intended entry.
constexpr double kMatrixTolerance = 1e-9;

std::optional<int> parse_side(std::string_view text, int most) {
  const std::optional<int> side = parse_integer<int>(text);
  const bool is_allowed = side && *side >= kLeastFrameSide && *side <= most && *side % 2 == 0;
  return is_allowed ? side : std::nullopt;
}

/// A coordinate's bounds, e.g. "-1 < x < 12".
std::string bounds_text(const controller::Box& bounds, Eigen::Index axis, const std::string& name) {
  return fmt::format("{} < {} < {}", bounds.lower[axis], name, bounds.upper[axis]);
}

/// The bound that the disc violates.
std::optional<std::string> why_beyond(const Eigen::VectorXd& centre,
                                      const controller::DiscView& disc,
                                      const controller::Box& bounds,
                                      const std::vector<models::Coordinate>& states) {
  for (Eigen::Index i = 0; i < centre.size(); ++i) {
    const double lower = disc.bounds.lower[i];
    const double upper = disc.bounds.upper[i];
    if (centre[i] > lower && centre[i] < upper) continue;
    const std::string& name = states[static_cast<std::size_t>(i)].name;
    if (lower >= upper) {
      return fmt::format("a body that has no room within the bounds of {}: {}", name,
                         bounds_text(bounds, i, name));
    }
    return fmt::format("a body that reaches {:.3g} beyond the bounds {}",
                       std::max(lower - centre[i], centre[i] - upper),
                       bounds_text(bounds, i, name));
  }
  return std::nullopt;
}

/// The bound or obstacle that the body violates, for a state whose position is safe.
std::optional<std::string> why_body_unsafe(const Eigen::VectorXd& state,
                                           const controller::SafeSet& safe_set,
                                           const std::vector<models::Coordinate>& states) {
  const controller::UnsafeSet unsafe(safe_set);
  for (const controller::DiscView& disc : unsafe.discs()) {
    if (auto why = why_beyond(disc.placement.of(state), disc, safe_set.bounds, states)) return why;
  }
  controller::SafeSet one = controller::unbounded_safe_set(state.size());
  one.body = safe_set.body;
  for (std::size_t k = 0; k < safe_set.obstacles.size(); ++k) {
    one.obstacles = {safe_set.obstacles[k]};
    const double clearance = controller::clearance(state, one);
    if (clearance > 0.0) continue;
    return fmt::format("a body that reaches {:.3g} into safe_set.obstacles.{}", -clearance, k);
  }
  one.obstacles.clear();
  one.road = safe_set.road;
  if (const double clearance = controller::clearance(state, one); clearance <= 0.0) {
    return fmt::format("a body that reaches {:.3g} beyond the edge of target.path's road",
                       -clearance);
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::string> make_semidefinite(Eigen::MatrixXd& matrix) {
  const double scale = matrix.cwiseAbs().maxCoeff();
  if (scale == 0.0) return std::nullopt;
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    for (Eigen::Index j = 0; j < i; ++j) {
      if (std::abs(matrix(i, j) / scale - matrix(j, i) / scale) > kMatrixTolerance) {
        return fmt::format("{} in row {}, column {} and {} in the transposed entry", matrix(i, j),
                           i + 1, j + 1, matrix(j, i));
      }
      matrix(j, i) = matrix(i, j);
    }
  }
  // Scaled, so that no entry overflows in the computation of the eigenvalues.
  const double least = models::symmetric_eigenvalues(matrix / scale).minCoeff();
  if (least >= -kMatrixTolerance) return std::nullopt;
  return fmt::format("a matrix with the eigenvalue {:.6g}", least * scale);
}

std::optional<std::string> tiny_variance(const Eigen::MatrixXd& covariance) {
  for (const double variance : covariance.diagonal()) {
    if (variance > 0.0 && variance < kLeastVariance) {
      return fmt::format("a variance of {:.3g}", variance);
    }
  }
  return std::nullopt;
}

std::string expected_variances() {
  return fmt::format("variances that are 0 or at least {:g}", kLeastVariance);
}

std::optional<std::string> why_unsafe(const Eigen::VectorXd& point,
                                      const controller::SafeSet& safe_set,
                                      const std::vector<models::Coordinate>& states) {
  const controller::Box& bounds = safe_set.bounds;
  for (Eigen::Index i = 0; i < point.size(); ++i) {
    if (point[i] > bounds.lower[i] && point[i] < bounds.upper[i]) continue;
    const std::string& name = states[static_cast<std::size_t>(i)].name;
    return fmt::format("{} = {}, outside of the bounds {}", name, point[i],
                       bounds_text(bounds, i, name));
  }
  for (std::size_t k = 0; k < safe_set.obstacles.size(); ++k) {
    controller::SafeSet one{.bounds = controller::unbounded_safe_set(point.size()).bounds,
                            .obstacles = {safe_set.obstacles[k]}};
    one.body.x = safe_set.body.x;
    one.body.y = safe_set.body.y;
    if (controller::clearance(point, one) <= 0.0) {
      return fmt::format("a state inside safe_set.obstacles.{}", k);
    }
  }
  if (safe_set.road) {
    const Eigen::Vector2d place(point[safe_set.body.x], point[safe_set.body.y]);
    if (!is_on_road(*safe_set.road, place)) return "a state off the road of target.path";
  }
  if (safe_set.body.is_point()) return std::nullopt;
  return why_body_unsafe(point, safe_set, states);
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

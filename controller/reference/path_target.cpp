#include "controller/reference/path_target.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace qsmpc::controller {
namespace {

// Approximate spacing of a profile's places, m, and their largest number.
constexpr double kProfileSpacing = 0.5;
constexpr double kMostPlaces = 50'000.0;
// Curvatures below this do not limit the speed further, 1/m.
constexpr double kStraight = 1e-6;
// Progress is searched within this distance of the last one, m, or within this many time steps at
// the path's speed if that is farther.
constexpr double kLeastSearch = 2.0;
constexpr double kSearchedSteps = 5.0;

}  // namespace

SpeedProfile::SpeedProfile(const ArcPath& path, const SpeedLimits& limits)
    : closed_(path.closed()) {
  const double count = std::clamp(std::ceil(path.length() / kProfileSpacing), 2.0, kMostPlaces);
  const auto n = static_cast<std::size_t>(count) + (closed_ ? 0 : 1);
  spacing_ = path.length() / count;
  for (std::size_t i = 0; i < n; ++i) {
    const double curvature = std::abs(path.at(static_cast<double>(i) * spacing_).curvature);
    speeds_.push_back(
        std::min(limits.top, std::sqrt(limits.across / std::max(curvature, kStraight))));
  }
  const double gain = 2.0 * limits.along * spacing_;
  const auto limit = [&](double& speed, double before) {
    speed = std::min(speed, std::sqrt(before * before + gain));
  };
  // Two laps of a closed path, so that limits carry over from its end to its beginning.
  const std::size_t steps = closed_ ? 2 * n : n - 1;
  for (std::size_t k = 0; k < steps; ++k) limit(speeds_[(k + 1) % n], speeds_[k % n]);
  for (std::size_t k = steps; k-- > 0;) limit(speeds_[k % n], speeds_[(k + 1) % n]);
}

double SpeedProfile::at(double along) const {
  const auto n = static_cast<double>(speeds_.size());
  if (speeds_.size() == 1) return speeds_.front();
  double place = along / spacing_;
  place = closed_ ? place - n * std::floor(place / n) : std::clamp(place, 0.0, n - 1.0);
  const auto from = std::min(static_cast<std::size_t>(place), speeds_.size() - 1);
  const double share = place - static_cast<double>(from);
  const std::size_t to =
      closed_ ? (from + 1) % speeds_.size() : std::min(from + 1, speeds_.size() - 1);
  return (1.0 - share) * speeds_[from] + share * speeds_[to];
}

double SpeedProfile::top() const { return *std::ranges::max_element(speeds_); }

double progress_on(const PathTarget& target, const Eigen::Vector2d& position,
                   std::optional<double> last) {
  const ArcPath& path = *target.path;
  if (last) {
    const double step = target.speed.at(*last) * target.time_step;
    const double reach = std::max(kLeastSearch, kSearchedSteps * step);
    return path.project(position, *last - reach, *last + reach);
  }
  if (!path.closed()) return path.project(position);
  const double half = 0.5 * path.length();
  return path.project(position, target.begin - half, target.begin + half);
}

void path_targets(const PathTarget& target, const models::SystemDescription& system,
                  const Eigen::Ref<const Eigen::VectorXd>& state, double progress,
                  Eigen::Ref<Eigen::MatrixXd> out) {
  constexpr double kFullTurn = 2.0 * std::numbers::pi;
  const auto set = [&](int index, Eigen::Index stage, double value) {
    if (index >= 0) out(index, stage) = value;
  };
  const int speed_state =
      std::max(system.state_index("longitudinal_speed"), system.state_index("speed"));
  const int yaw_rate = system.state_index("yaw_rate");
  const int velocity_x = system.state_index("velocity_x");
  const int velocity_y = system.state_index("velocity_y");
  double last_heading = system.heading >= 0 ? state[system.heading] : 0.0;
  double along = progress;
  out.setZero();
  for (Eigen::Index k = 0; k < out.cols(); ++k) {
    const PathPlace place = target.path->at(along);
    const double speed = target.speed.at(along);
    const double heading =
        place.heading + kFullTurn * std::round((last_heading - place.heading) / kFullTurn);
    set(system.position_x, k, place.position.x());
    set(system.position_y, k, place.position.y());
    set(system.heading, k, heading);
    set(speed_state, k, speed);
    set(yaw_rate, k, place.curvature * speed);
    set(velocity_x, k, speed * std::cos(heading));
    set(velocity_y, k, speed * std::sin(heading));
    last_heading = heading;
    along += speed * target.time_step;
  }
}

}  // namespace qsmpc::controller

#include "controller/regions/disc_placement.hpp"

#include <cmath>

namespace qsmpc::controller {

DiscPlacement::DiscPlacement(const Body& body, const Disc& disc)
    : reach_(disc.offset.norm()), x_(body.x), y_(body.y), heading_(body.heading) {
  if (reach_ > 0.0) bearing_ = std::atan2(disc.offset.y(), disc.offset.x());
}

double DiscPlacement::lipschitz() const {
  // The largest singular value of [[1, |o|], [0, 1]]: the heading stays in the state while it moves
  // the position.
  return at_position() ? 1.0 : 0.5 * reach_ + std::sqrt(1.0 + 0.25 * reach_ * reach_);
}

Eigen::VectorXd DiscPlacement::of(const Eigen::Ref<const Eigen::VectorXd>& state) const {
  Eigen::VectorXd moved = state;
  if (at_position()) return moved;
  const double angle = state[heading_] + bearing_;
  moved[x_] += reach_ * std::cos(angle);
  moved[y_] += reach_ * std::sin(angle);
  return moved;
}

void DiscPlacement::of(const Points& states, ParticleRange range, Points& out) const {
  const Eigen::Index count = range.end - range.begin;
  out = states.middleCols(range.begin, count);
  if (at_position()) return;
  for (Eigen::Index i = 0; i < count; ++i) {
    const double angle = out(heading_, i) + bearing_;
    out(x_, i) += reach_ * std::cos(angle);
    out(y_, i) += reach_ * std::sin(angle);
  }
}

void DiscPlacement::pull_back(const Points& states, ParticleRange range,
                              const Points& moved_adjoint, Points& adjoint) const {
  const Eigen::Index count = range.end - range.begin;
  adjoint.middleCols(range.begin, count) += moved_adjoint.leftCols(count);
  if (at_position()) return;
  for (Eigen::Index i = 0; i < count; ++i) {
    // Most particles are far from everything.
    const double by_x = moved_adjoint(x_, i);
    const double by_y = moved_adjoint(y_, i);
    if (by_x == 0.0 && by_y == 0.0) continue;
    const double angle = states(heading_, range.begin + i) + bearing_;
    adjoint(heading_, range.begin + i) +=
        reach_ * (by_y * std::cos(angle) - by_x * std::sin(angle));
  }
}

}  // namespace qsmpc::controller

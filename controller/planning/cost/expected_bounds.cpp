#include "controller/planning/cost/expected_bounds.hpp"

#include <algorithm>
#include <cmath>

namespace qsmpc::controller {
namespace {

// Replaces a standard deviation of 0, at which the closed forms take their limits.
constexpr double kLeastDeviation = 1e-150;

/// Whether no particle between these two is penalised by a face; false if anything is NaN.
bool all_far(const AxisInterval& bounds, const SmoothedCoordinate& law, double least, double most,
             double length) {
  const double reach = length + kFarDeviations * law.deviation;
  return law.share * least + law.offset - bounds.lower > reach &&
         bounds.upper - (law.share * most + law.offset) > reach;
}

}  // namespace

double smoothing_of(Eigen::Index count, Eigen::Index dim) {
  constexpr double kFactor = 1.5;
  const double bandwidth =
      kFactor * std::pow(static_cast<double>(count), -1.0 / static_cast<double>(dim + 4));
  return std::min(1.0, bandwidth * bandwidth);
}

ExpectedBounds::ExpectedBounds(const Box& bounds, const Penalty& penalty) : penalty_(penalty) {
  if (penalty.shape != PenaltyShape::kSmooth || !(penalty.box > 0.0)) return;
  bounds_ = bounded_axes(bounds);
  coordinates_.resize(bounds_.size());
}

/// Calls action(coordinate, offset of its range in the points, range, slot in the list of sums) for
/// all coordinates near a face and all chunks.
template <class Action>
void ExpectedBounds::for_near(const Executor& run, const Points& points,
                              const Action& action) const {
  for_chunks(run, points.cols(), [&](ParticleRange range, int chunk) {
    for (std::size_t n = 0; n < bounds_.size(); ++n) {
      if (!coordinates_[n].near) continue;
      action(n, bounds_[n].axis * points.cols() + range.begin, range, chunk * bounds_.size() + n);
    }
  });
}

/// Computes the laws of the coordinates from the moments of all chunks.
void ExpectedBounds::describe(const Law& law, const Points& points) {
  for (std::size_t n = 0; n < bounds_.size(); ++n) {
    const AxisInterval& bounds = bounds_[n];
    const double reference = points(bounds.axis, 0);
    CoordinateMoments sum = moments_[n];
    for (std::size_t slot = n + bounds_.size(); slot < moments_.size(); slot += bounds_.size()) {
      sum.first += moments_[slot].first;
      sum.second += moments_[slot].second;
      sum.least = std::min(sum.least, moments_[slot].least);
      sum.most = std::max(sum.most, moments_[slot].most);
    }
    const double variance = sum.second - sum.first * sum.first;
    Coordinate& coordinate = coordinates_[n];
    SmoothedCoordinate& smoothed = coordinate.law;
    coordinate.mean = reference + sum.first;
    smoothed.share = std::sqrt(1.0 - law.smoothing);
    smoothed.offset = (1.0 - smoothed.share) * coordinate.mean;
    smoothed.deviation =
        std::max(kLeastDeviation, std::hypot(law.noise_deviation[bounds.axis],
                                             std::sqrt(law.smoothing * std::max(0.0, variance))));
    coordinate.near =
        !all_far(bounds, smoothed, reference + sum.least, reference + sum.most, penalty_.length);
  }
}

double ExpectedBounds::add(const Law& law, const Points& points, const Eigen::VectorXd& weights,
                           const Executor& run, Points& gradient) {
  if (empty() || points.cols() == 0) return 0.0;
  const std::size_t slots = chunks_of(points.cols()) * bounds_.size();
  moments_.resize(slots);
  face_costs_.resize(slots);
  for (Coordinate& coordinate : coordinates_) coordinate.near = true;
  for_near(
      run, points, [&](std::size_t n, std::ptrdiff_t at, ParticleRange range, std::size_t slot) {
        moments_[slot] = coordinate_moments(points.data() + at, weights.data() + range.begin,
                                            range.end - range.begin, points(bounds_[n].axis, 0));
      });
  describe(law, points);
  const auto is_near = [](const Coordinate& coordinate) { return coordinate.near; };
  if (std::none_of(coordinates_.begin(), coordinates_.end(), is_near)) return 0.0;
  for_near(run, points,
           [&](std::size_t n, std::ptrdiff_t at, ParticleRange range, std::size_t slot) {
             face_costs_[slot] = evaluate_faces(bounds_[n], coordinates_[n].law, penalty_,
                                                points.data() + at, weights.data() + range.begin,
                                                range.end - range.begin, gradient.data() + at);
           });
  double value = 0.0;
  for (std::size_t n = 0; n < bounds_.size(); ++n) {
    Coordinate& coordinate = coordinates_[n];
    if (!coordinate.near) continue;
    FaceCost sum;
    for (std::size_t slot = n; slot < slots; slot += bounds_.size()) {
      sum.value += face_costs_[slot].value;
      sum.by_offset += face_costs_[slot].by_offset;
      sum.by_variance += face_costs_[slot].by_variance;
    }
    value += sum.value;
    // Through the mean that particles are shrunk towards, and through the variance: the derivative
    // of (1 − θ²) v by f_i is (1 − θ²) 2 ρ_i (f_i − m).
    const double linear = law.smoothing * sum.by_variance;
    coordinate.correction = {
        .constant = (1.0 - coordinate.law.share) * sum.by_offset - linear * coordinate.mean,
        .linear = linear};
  }
  if (law.smoothing == 0.0) return value;
  for_near(run, points, [&](std::size_t n, std::ptrdiff_t at, ParticleRange range, std::size_t) {
    correct_gradient(coordinates_[n].correction, points.data() + at, weights.data() + range.begin,
                     range.end - range.begin, gradient.data() + at);
  });
  return value;
}

}  // namespace qsmpc::controller

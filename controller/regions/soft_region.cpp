#include "controller/regions/soft_region.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "controller/regions/soft_part.hpp"
#include "models/constants.hpp"

namespace qsmpc::controller {
namespace {

/// A sum of products over intervals, vectorised over the centres, for independent coordinates.
class FactoredRegion final : public SoftRegion {
 public:
  explicit FactoredRegion(const GaussianCentres& centres)
      : centres_(centres.centres),
        lowest_(centres.lowest),
        highest_(centres.highest),
        covariance_(centres.covariance) {}

  /// Adds an interval to the current part; `is_last` ends the part.
  void add_factor(Eigen::Index axis, double lower, double upper, bool is_last) {
    const double deviation = std::sqrt(std::max(0.0, covariance_(axis, axis)));
    factors_.push_back({.axis = axis,
                        .interval = {.lower = lower, .upper = upper, .deviation = deviation},
                        .gap = std::max({0.0, lower - highest_[axis], lowest_[axis] - upper}),
                        .is_last = is_last});
  }

  void add(double t, Eigen::Index begin, Eigen::Index count, double* totals) const override {
    for (std::size_t first = 0; first < factors_.size();) {
      std::size_t end = first;
      bool far = false;
      do {
        // For every centre both the inside and the surrounding within t are in the tail.
        far = far || factors_[end].gap - t > kTail * factors_[end].interval.deviation;
      } while (!factors_[end++].is_last);
      if (far) {
        for (Eigen::Index i = 0; i < count; ++i) totals[i] += 2.0 * kTailAllowance;
      } else {
        add_part(t, first, end, begin, count, totals);
      }
      first = end;
    }
  }

 private:
  /// One axis of a part; the values of its axes are multiplied.
  struct Factor {
    Eigen::Index axis;
    SoftInterval interval;
    double gap;    ///< least distance from a centre
    bool is_last;  ///< in its part
  };

  void add_part(double t, std::size_t first, std::size_t end, Eigen::Index begin,
                Eigen::Index count, double* totals) const {
    std::array<double, kSoftBlock> product;
    std::array<double, kSoftBlock> factor;
    product.fill(1.0);
    for (std::size_t k = first; k < end; ++k) {
      soft_interval_by_mean(factors_[k].interval, t, &centres_(factors_[k].axis, begin),
                            static_cast<std::size_t>(count), factor.data());
      for (Eigen::Index i = 0; i < count; ++i) product[i] *= factor[i];
    }
    for (Eigen::Index i = 0; i < count; ++i) totals[i] += product[i];
  }

  const Points& centres_;
  const Eigen::VectorXd& lowest_;
  const Eigen::VectorXd& highest_;
  const Eigen::MatrixXd& covariance_;
  std::vector<Factor> factors_;
};

/// A box whose coordinates are correlated, centre by centre.
class CorrelatedBox final : public SoftRegion {
 public:
  CorrelatedBox(const Box& box, const GaussianCentres& centres)
      : box_(box), centres_(centres.centres), covariance_(centres.covariance) {}

  void add(double t, Eigen::Index begin, Eigen::Index count, double* totals) const override {
    for (Eigen::Index i = 0; i < count; ++i) {
      totals[i] += soft_part_probability(centres_.col(begin + i), covariance_, box_, t);
    }
  }

 private:
  const Box& box_;
  const Points& centres_;
  const Eigen::MatrixXd& covariance_;
};

}  // namespace

std::unique_ptr<const SoftRegion> soft_walls(const Box& bounds, const GaussianCentres& centres) {
  auto region = std::make_unique<FactoredRegion>(centres);
  for (const AxisInterval& interval : bounded_axes(bounds)) {
    if (!std::isinf(interval.lower)) {
      region->add_factor(interval.axis, -kInfinity, interval.lower, true);
    }
    if (!std::isinf(interval.upper)) {
      region->add_factor(interval.axis, interval.upper, kInfinity, true);
    }
  }
  return region;
}

std::unique_ptr<const SoftRegion> soft_box(const Box& box, const GaussianCentres& centres) {
  if (!diagonal_on(centres.covariance, box)) return std::make_unique<CorrelatedBox>(box, centres);
  auto region = std::make_unique<FactoredRegion>(centres);
  const std::vector<AxisInterval> intervals = bounded_axes(box);
  // A box that is the whole space has no bounded axis.
  if (intervals.empty()) region->add_factor(0, -kInfinity, kInfinity, true);
  for (const AxisInterval& interval : intervals) {
    region->add_factor(interval.axis, interval.lower, interval.upper,
                       interval.axis == intervals.back().axis);
  }
  return region;
}

}  // namespace qsmpc::controller

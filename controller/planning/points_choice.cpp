#include "controller/planning/points_choice.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "controller/planning/planner.hpp"
#include "controller/reference/progress.hpp"
#include "controller/regions/unsafe_set.hpp"
#include "models/constants.hpp"

namespace qsmpc::controller {
namespace {

// Ratio of successive numbers of points; between two of them hardly anything changes.
constexpr double kLadderStep = 1.25;
// Standard deviations of one period's noise beyond which a state counts as having moved.
constexpr double kDeviations = 3.0;

/// A start of planning, and its plan with the most points.
struct Place {
  Gaussian belief;
  std::optional<double> progress;  // as in PlanRequest
  Plan plan;
};

PlannerSettings with_points(PlannerSettings settings, int points) {
  settings.state_points = std::min(settings.state_points, points);
  settings.compressed_points = std::min(settings.compressed_points, points);
  return settings;
}

class PointsComparison {
 public:
  PointsComparison(const models::Dynamics& dynamics, const Gaussian& belief,
                   const PointsSearch& search, PlannerSettings settings)
      : dynamics_(dynamics),
        settings_(without_deadline(std::move(settings))),
        search_(search),
        unsafe_(settings_.safe_set),
        judge_(dynamics, settings_) {
    find_places(belief);
  }

  [[nodiscard]] PointsChoice choose() {
    if (places_.empty()) return choice_of(settings_, 0.0);  // no basis for a comparison
    const int most = std::max(settings_.state_points, settings_.compressed_points);
    for (int points = fewest(); points < most;
         points = static_cast<int>(std::ceil(points * kLadderStep))) {
      const PlannerSettings fewer = with_points(settings_, points);
      const double gap = gap_of(fewer);
      if (gap <= search_.tolerance) return choice_of(fewer, gap);
    }
    return choice_of(settings_, 0.0);
  }

 private:
  /// As many as the unscented transform uses: with fewer, some coordinate does not vary at all.
  [[nodiscard]] int fewest() const { return 2 * dynamics_.state_dim() + 1; }

  static PlannerSettings without_deadline(PlannerSettings settings) {
    settings.deadline = kInfinity;
    return settings;
  }

  [[nodiscard]] PointsChoice choice_of(const PlannerSettings& settings, double gap) const {
    return {.state_points = settings.state_points,
            .compressed_points = settings.compressed_points,
            .gap = gap,
            .places = static_cast<int>(places_.size())};
  }

  /// Follows plans with the most points from end to end, and adds a place nearer to the unsafe set
  /// at each.
  void find_places(Gaussian belief) {
    std::optional<double> progress = progress_at(belief.mean, {});
    for (int n = 0; n < search_.stretches; ++n) {
      if (!add_place(belief, progress)) return;
      const Plan& plan = places_.back().plan;
      const Eigen::MatrixXd path = plan.policy.states;
      if (!path.allFinite()) return;
      const std::optional<Eigen::VectorXd> aside = nearest_to_unsafe(plan.prediction.stages.back());
      for (const auto& state : path.colwise()) progress = progress_at(state, progress);
      if (aside) add_place(later(*aside), progress);
      if (is_noise(path.rightCols<1>() - belief.mean)) return;
      belief = later(path.rightCols<1>());
    }
  }

  [[nodiscard]] std::optional<double> progress_at(const Eigen::Ref<const Eigen::VectorXd>& state,
                                                  std::optional<double> before) const {
    return progress_after(settings_.path, settings_.waypoints, dynamics_.description(), state,
                          before);
  }

  /// A belief as it arises during a drive.
  [[nodiscard]] Gaussian later(const Eigen::VectorXd& mean) const {
    return {.mean = mean, .covariance = settings_.noise_covariance};
  }

  /// Plans with the most points, and adds the place if the plan is finite. Returns whether it did.
  bool add_place(const Gaussian& belief, std::optional<double> progress) {
    judge_.reset();
    Plan plan = judge_.plan(belief, {.progress = progress});
    if (!std::isfinite(plan.cost.total())) return false;
    // The first guess may have been far off.
    const Plan& next = judge_.plan_from(belief, plan, progress);
    if (better(next, plan)) plan = next;
    total_ += plan.cost.total();
    places_.push_back({belief, progress, std::move(plan)});
    return true;
  }

  /// The safe point nearest to the unsafe set, if any.
  [[nodiscard]] std::optional<Eigen::VectorXd> nearest_to_unsafe(
      const DiscreteMeasure& measure) const {
    std::optional<Eigen::VectorXd> nearest;
    double least = kInfinity;
    for (const auto& point : measure.locations.colwise()) {
      const double distance = clearance(point, unsafe_);
      if (!(distance > 0.0) || !(distance < least)) continue;
      least = distance;
      nearest = point;
    }
    return nearest;
  }

  /// Whether the displacement is within one period's noise, i.e. the plan stays in place.
  [[nodiscard]] bool is_noise(const Eigen::VectorXd& way) const {
    const Eigen::ArrayXd deviations = settings_.noise_covariance.diagonal().array().sqrt();
    return (way.array().abs() <= kDeviations * deviations).all();
  }

  /// The change of all places' plans with the settings `fewer`, relative to their cost; infinite if
  /// one of them cannot be compared.
  double gap_of(const PlannerSettings& fewer) {
    Planner planner(dynamics_, fewer);
    double change = 0.0;
    for (const Place& place : places_) change += change_at(place, planner);
    // Costs are at least 0, and 0 only at the end of a drive without noise.
    const double gap = change / std::max(total_, std::numeric_limits<double>::min());
    return std::isfinite(gap) ? gap : kInfinity;
  }

  /// By how much the cost of the place's plan, by the most points, grows when `planner` goes on
  /// from it.
  double change_at(const Place& place, Planner& planner) {
    const Plan& plan = planner.plan_from(place.belief, place.plan, place.progress);
    const Plan& judged = judge_.price(place.belief, plan, place.progress);
    if (plan.risk.kept && !judged.risk.kept) return kInfinity;
    return judged.cost.total() - place.plan.cost.total();
  }

  const models::Dynamics& dynamics_;
  PlannerSettings settings_;
  PointsSearch search_;
  UnsafeSet unsafe_;
  Planner judge_;
  std::vector<Place> places_;
  double total_ = 0.0;  // cost of the places' plans
};

}  // namespace

PointsChoice choose_points(const models::Dynamics& dynamics, const Gaussian& belief,
                           const PointsSearch& search, const PlannerSettings& settings) {
  if (!(search.tolerance > 0.0) || search.stretches < 1) {
    throw std::invalid_argument("points: a tolerance above 0 and at least one stretch are needed");
  }
  return PointsComparison(dynamics, belief, search, settings).choose();
}

}  // namespace qsmpc::controller

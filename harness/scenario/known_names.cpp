#include "harness/scenario/known_names.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "controller/control/controller.hpp"
#include "controller/estimation/estimator.hpp"
#include "controller/measure/quantisation/gaussian_quantiser.hpp"
#include "controller/planning/risk/risk_limits.hpp"
#include "controller/planning/solvers/ocp_solver.hpp"
#include "controller/prediction/propagator.hpp"
#include "harness/scenario/outside_controllers.hpp"

namespace qsmpc::harness {
namespace {

// Longer names are not typing errors, and the distance costs time quadratic in their length.
constexpr std::size_t kLongestCompared = 64;
constexpr std::size_t kMostSuggested = 3;

// Up to a third of the letters may be wrong, or two in a short name.
std::size_t farthest_near(std::string_view name) {
  return std::max<std::size_t>(2, name.size() / 3);
}

template <class Entries>
std::vector<std::string> names_of(const Entries& entries) {
  std::vector<std::string> names;
  names.reserve(entries.size());
  for (const auto& entry : entries) names.push_back(entry.name);
  return names;
}

}  // namespace

std::vector<std::string> coordinate_names(const std::vector<models::Coordinate>& coordinates) {
  return names_of(coordinates);
}

const std::vector<std::string>& system_names() {
  static const std::vector<std::string> names = names_of(models::systems());
  return names;
}

const std::vector<std::string>& controller_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all = names_of(controller::controllers());
    for (std::string& name : names_of(outside_controllers())) all.push_back(std::move(name));
    return all;
  }();
  return names;
}

const std::vector<std::string>& shielded_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all = names_of(controller::controllers());
    std::erase(all, "shield");
    return all;
  }();
  return names;
}

const std::string& driving_kind(const Scenario::Controller& controller) {
  return controller.kind == "shield" ? controller.shield.of : controller.kind;
}

bool is_sampling(const Scenario::Controller& controller) {
  const std::vector<controller::ControllerEntry>& known = controller::controllers();
  return std::any_of(known.begin(), known.end(), [&](const auto& entry) {
    return entry.name == driving_kind(controller) && entry.samples;
  });
}

const std::vector<std::string>& estimator_names() {
  static const std::vector<std::string> names = names_of(controller::estimators());
  return names;
}

const std::vector<std::string>& lqr_about_names() {
  static const std::vector<std::string> names{"path", "target"};
  return names;
}

const std::vector<std::string>& risk_otherwise_names() {
  static const std::vector<std::string> names = names_of(controller::risk_otherwise_entries());
  return names;
}

const std::vector<std::string>& solver_names() {
  static const std::vector<std::string> names = names_of(controller::solvers());
  return names;
}

const std::vector<std::string>& input_bounding_names() {
  static const std::vector<std::string> names = names_of(controller::input_boundings());
  return names;
}

const std::vector<std::string>& propagator_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> carrying;
    for (const controller::PropagatorEntry& entry : controller::propagators()) {
      if (entry.carries_noise) carrying.push_back(entry.name);
    }
    return carrying;
  }();
  return names;
}

const std::vector<std::string>& quantiser_names() {
  static const std::vector<std::string> names = names_of(controller::quantisers());
  return names;
}

const std::vector<std::string>& policy_names() {
  static const std::vector<std::string> names{"closed_loop", "open_loop", "disturbance_feedback"};
  return names;
}

const std::vector<std::string>& guide_names() {
  static const std::vector<std::string> names{"none", "grid"};
  return names;
}

const std::vector<std::string>& penalty_shape_names() {
  static const std::vector<std::string> names{"smooth", "thesis"};
  return names;
}

const std::vector<std::string>& plant_kind_names() {
  static const std::vector<std::string> names{"analytic", "mujoco"};
  return names;
}

const std::vector<std::string>& disturbance_kind_names() {
  static const std::vector<std::string> names{"force", "state"};
  return names;
}

const std::vector<std::string>& camera_names() {
  static const std::vector<std::string> names{"chase", "fixed", "split", "top"};
  return names;
}

const std::vector<std::string>& overlay_names() {
  static const std::vector<std::string> names{"particles", "ellipses", "tube", "ghost",
                                              "raw",       "body",     "path"};
  return names;
}

std::size_t edit_distance(std::string_view a, std::string_view b) {
  // Three rows of the dynamic programme: a swap looks two rows back.
  std::vector<std::size_t> before(b.size() + 1);
  std::vector<std::size_t> above(b.size() + 1);
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::swap(before, above);
    std::swap(above, row);
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = above[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({above[j] + 1, row[j - 1] + 1, replaced});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) row[j] = std::min(row[j], before[j - 2] + 1);
    }
  }
  return row[b.size()];
}

std::vector<std::string> nearest_names(std::string_view name,
                                       const std::vector<std::string>& known) {
  if (name.empty() || name.size() > kLongestCompared) return {};
  std::vector<std::pair<std::size_t, std::string>> near;
  for (const std::string& candidate : known) {
    // An unfinished name ("dubins") is near too, however much is missing.
    const bool begun = name.size() >= 3 && candidate.starts_with(name);
    const std::size_t slips = edit_distance(name, candidate);
    const std::size_t distance = begun ? std::min<std::size_t>(slips, 1) : slips;
    if (distance <= farthest_near(name) && distance < candidate.size()) {
      near.emplace_back(distance, candidate);
    }
  }
  std::stable_sort(near.begin(), near.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  if (near.size() > kMostSuggested) near.resize(kMostSuggested);
  std::vector<std::string> names;
  names.reserve(near.size());
  for (auto& [distance, candidate] : near) names.push_back(std::move(candidate));
  return names;
}

std::string expected_names(std::string_view name, const std::vector<std::string>& known) {
  const std::vector<std::string> near = nearest_names(name, known);
  if (near.empty()) return fmt::format("one of {}", fmt::join(known, ", "));
  // The suggestion comes first, so that it survives the truncation of a long list.
  return fmt::format("{} (known: {})", fmt::join(near, " or "), fmt::join(known, ", "));
}

}  // namespace qsmpc::harness

#include "harness/report/comparison_verdict.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include <fmt/format.h>

#include "harness/scenario/certificate_scope.hpp"
#include "harness/text/number_format.hpp"
#include "harness/text/printable.hpp"

namespace qsmpc::harness {
namespace {

constexpr std::size_t kPlantNameLimit = 120;  // bytes of a plant's name, which may be a path

std::string name_of(const PlantComparison& plant) { return printable(plant.name, kPlantNameLimit); }

/// States what is exceeded on `plant`; empty if nothing is.
std::string exceeded_text(const PlantComparison& plant) {
  std::string text;
  if (!plant.exceeded_stages.empty()) {
    text = fmt::format("at stage{} {} of the plan", plant.exceeded_stages.size() == 1 ? "" : "s",
                       stages_text(plant.exceeded_stages));
  }
  if (is_exceeded_in_closed_loop(plant)) {
    text += fmt::format("{}in closed loop (p = {})", text.empty() ? "" : " and ",
                        format_short(plant.closed_loop.p_value));
  }
  return text.empty() ? text : fmt::format("On {} {}.", name_of(plant), text);
}

/// States how far a single plant is from the model.
std::string distance_text(const PlantComparison& plant) {
  const std::string name = name_of(plant);
  if (is_the_model(plant)) return fmt::format("{} matches the model except for rounding.", name);
  const double divergence = largest_divergence(plant);
  if (!std::isfinite(divergence)) return fmt::format("{} broke on every path.", name);
  return fmt::format(
      "Under the plan the paths of {} diverge from the model’s by up to {} (root mean square, norm "
      "of the state).",
      name, format_short(divergence));
}

std::string farthest_text(const Comparison& comparison) {
  if (comparison.plants.size() == 1) return distance_text(comparison.plants.front());
  if (std::ranges::all_of(comparison.plants, is_the_model)) {
    return "Every plant matches the model except for rounding.";
  }
  const PlantComparison& plant =
      *std::ranges::max_element(comparison.plants, {}, largest_divergence);
  const double divergence = largest_divergence(plant);
  if (!std::isfinite(divergence)) {
    return fmt::format("Farthest from the model: {}, which broke on every path.", name_of(plant));
  }
  return fmt::format(
      "Farthest from the model: {}. Its paths under the plan diverge from the model’s by up to {} "
      "(root mean square, norm of the state).",
      name_of(plant), format_short(divergence));
}

/// `exceeded`: number of plants on which a certificate is exceeded.
std::string verdict_title(std::size_t exceeded, std::size_t plants) {
  const bool is_single = plants == 1;
  if (exceeded == 0) {
    return is_single ? "No certificate is exceeded" : "No certificate is exceeded on any plant";
  }
  return is_single ? "Certificates are exceeded"
                   : fmt::format("Certificates are exceeded on {} of {} plants", exceeded, plants);
}

}  // namespace

bool is_exceeded_in_closed_loop(const PlantComparison& plant) {
  return plant.closed_loop.p_value < kExceededBelow;
}

double largest_divergence(const PlantComparison& plant) {
  double largest = -1.0;
  for (const HorizonStage& stage : plant.horizon) {
    const double norm = stage.w2_to_model();
    if (std::isfinite(norm)) largest = std::max(largest, norm);
  }
  return largest < 0.0 ? std::numeric_limits<double>::infinity() : largest;
}

bool is_the_model(const PlantComparison& plant) {
  return plant.paths.faults == 0 &&
         (plant.one_step.rmse.array() <= plant.one_step.rounding.array()).all();
}

std::string stages_text(const std::vector<int>& stages) {
  std::string text;
  for (std::size_t n = 0; n < stages.size();) {
    std::size_t last = n;
    while (last + 1 < stages.size() && stages[last + 1] == stages[last] + 1) ++last;
    text += text.empty() ? "" : ", ";
    text += last > n + 1 ? fmt::format("{} to {}", stages[n], stages[last])
                         : fmt::format("{}", stages[n]);
    n = last > n + 1 ? last + 1 : n + 1;
  }
  return text;
}

std::optional<PageVerdict> unsafe_verdict(const Comparison& comparison) {
  PageVerdict verdict;
  std::int64_t unsafe = 0;
  std::int64_t drives = 0;
  for (const PlantComparison& plant : comparison.plants) {
    const ClosedLoop& loop = plant.closed_loop;
    unsafe += loop.unsafe;
    drives += loop.episodes;
    if (loop.unsafe == 0) continue;
    verdict.sentences.push_back(fmt::format(
        "On {}: {} of {} ({} collided, {} left the bounds).", name_of(plant), loop.unsafe,
        loop.episodes, loop.count(Outcome::kCollision), loop.count(Outcome::kLeftBounds)));
  }
  if (unsafe == 0) return std::nullopt;
  verdict.title = fmt::format("{} of {} drives were unsafe", unsafe, drives);
  return verdict;
}

std::optional<PageVerdict> no_bound_verdict(const Comparison& comparison) {
  const std::string why = why_no_bound(comparison.scenario);
  if (why.empty()) return std::nullopt;
  return PageVerdict{.title = "Certificates of the drives are not bounds",
                     .sentences = {"They hold for a policy that sees the state; " + why +
                                   ". Along the plan the policy does see the state: the "
                                   "certificates of its stages are bounds."}};
}

PageVerdict comparison_verdict(const Comparison& comparison) {
  PageVerdict verdict;
  for (const PlantComparison& plant : comparison.plants) {
    const std::string text = exceeded_text(plant);
    if (!text.empty()) verdict.sentences.push_back(text);
  }
  const bool is_good = verdict.sentences.empty();
  verdict.mood = is_good ? PageMood::kGood : PageMood::kBad;
  verdict.title = verdict_title(verdict.sentences.size(), comparison.plants.size());
  verdict.sentences.push_back(farthest_text(comparison));
  if (is_good) {
    verdict.sentences.push_back(fmt::format(
        "This is not a proof: no unsafe path among {} is still compatible with a probability of "
        "{}.",
        comparison.paths,
        format_bound(
            clopper_pearson(0, std::max<std::int64_t>(1, comparison.paths), kIntervalTail).upper)));
  }
  return verdict;
}

}  // namespace qsmpc::harness

#include "harness/contest/contest_reader.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <numeric>
#include <optional>
#include <span>
#include <unordered_set>
#include <utility>

#include <fmt/format.h>

#include "harness/campaign/plan/campaign_keys.hpp"
#include "harness/campaign/plan/draft_reading.hpp"
#include "harness/contest/contest_keys.hpp"
#include "harness/scenario/known_names.hpp"
#include "harness/text/fnv1a.hpp"
#include "models/random/random_numbers.hpp"

namespace qsmpc::harness {
namespace {

constexpr std::int64_t kMostGridPoints = 100'000;  // of a controller's search

/// The points of a grid of `points` to try, ascending: all, or `budget` of them at random. The
/// random numbers depend on the controller's name, so that other controllers of the contest have no
/// effect.
std::vector<std::size_t> tried_points(std::int64_t points, std::int64_t budget,
                                      const std::string& controller) {
  std::vector<std::size_t> order(static_cast<std::size_t>(points));
  std::iota(order.begin(), order.end(), std::size_t{0});
  if (points <= budget) return order;
  Fnv1a<std::uint64_t> hash;
  hash.add(controller);
  std::vector<std::uint64_t> words(static_cast<std::size_t>(budget));
  models::random_words(
      {.seed = 0, .episode = hash.value(), .stream = models::RandomStream::kSearch}, words);
  for (std::size_t i = 0; i < words.size(); ++i) {
    std::swap(order[i], order[i + words[i] % (order.size() - i)]);
  }
  order.resize(words.size());
  std::ranges::sort(order);
  return order;
}

/// Point `point` of the grid; the first axis varies slowest.
ContestCandidate candidate_at(const std::vector<GridAxis>& axes, std::size_t point) {
  ContestCandidate candidate;
  std::size_t stride = 1;
  for (const GridAxis& axis : axes) stride *= axis.values.size();
  for (const GridAxis& axis : axes) {
    stride /= axis.values.size();
    const CampaignSetting& value = axis.values[point / stride % axis.values.size()];
    candidate.settings.push_back(value);
    candidate.label += (candidate.label.empty() ? "" : ", ") + value.text;
  }
  return candidate;
}

class ContestReader {
 public:
  ContestReader(const YamlNode& tree, const std::string& file, Problems& problems)
      : root_(tree, problems), problems_(problems) {
    contest_.file = file;
  }

  Contest read() {
    contest_.plants.emplace_back();
    contest_.noise = {1.0};
    if (!root_.present()) return std::move(contest_);
    read_names();
    read_controllers();
    read_reference();
    if (const YamlNode* node = root_.tree("common")) read_common(*node);
    read_scenarios();
    if (const YamlNode* node = root_.tree("plants")) {
      std::vector<CampaignChoice> plants = read_choices(*node, "plants", problems_);
      if (!plants.empty()) contest_.plants = std::move(plants);
    }
    if (const YamlNode* node = root_.tree("noise")) read_noise(*node);
    contest_.seeds = read_seeds(root_, "seeds", problems_);
    // Read even where it is absent, so that misspelt keys are compared with it.
    const double limit = root_.number("risk_limit", 0.0, {.least = 0.0, .most = 1.0});
    if (root_.has("risk_limit")) contest_.risk_limit = limit;
    read_tuning();
    read_timing();
    root_.refuse_unread();
    return std::move(contest_);
  }

 private:
  void read_names();
  void read_controllers();
  void read_reference();
  void read_common(const YamlNode& node);
  void read_scenarios();
  void read_noise(const YamlNode& node);
  void read_tuning();
  void read_search(const YamlNode& node, std::int64_t budget);
  void refuse_shared_seeds(const YamlNode& node);
  void read_timing();
  void refuse_shared(const std::vector<CampaignSetting>& settings);
  [[nodiscard]] std::vector<std::string> controller_names() const;

  Section root_;
  Problems& problems_;
  Contest contest_{};
};

void ContestReader::read_names() {
  const std::string stem = std::filesystem::path(contest_.file).stem().string();
  contest_.name = root_.text("name", stem, kLongestName);
  if (root_.has("name") && contest_.name.empty()) root_.note("name", "a name, not empty");
  contest_.description = root_.text("description", "", kLongestCampaignDescription);
}

/// Keys that define the problem must be the same for all controllers.
void ContestReader::refuse_shared(const std::vector<CampaignSetting>& settings) {
  for (const CampaignSetting& setting : settings) {
    const std::string expected = why_shared(setting.key);
    if (expected.empty()) continue;
    YamlNode place;
    place.line = setting.line;
    problems_.add(place, path_of(setting, setting.key), setting.key, expected);
  }
}

void ContestReader::read_controllers() {
  const std::string expected =
      fmt::format("a mapping of 2 to {} names to {{KEY: VALUE}}", kMostControllers);
  const YamlNode* node = root_.tree("controllers");
  if (node == nullptr) {
    root_.require("controllers", expected);
    return;
  }
  if (node->kind != YamlNode::Kind::kMap || node->items.size() < 2 ||
      node->items.size() > kMostControllers) {
    root_.note("controllers", expected);
    return;
  }
  for (std::size_t i = 0; i < node->items.size(); ++i) {
    const YamlNode& item = node->items[i];
    const std::string path = "controllers." + node->keys[i];
    if (!is_line_of_text(node->keys[i], kLongestName)) {
      problems_.add(item, "controllers", "\"" + node->keys[i] + "\"",
                    fmt::format("a name of 1 to {} bytes on one line", kLongestName));
    } else if (item.kind != YamlNode::Kind::kMap) {
      problems_.add(item, path, describe(item), "a mapping {KEY: VALUE}");
    } else {
      contest_.controllers.push_back({.name = node->keys[i],
                                      .settings = read_settings(item, path, problems_),
                                      .place = {line_of(item), path},
                                      .candidates = {{}}});
      refuse_shared(contest_.controllers.back().settings);
    }
  }
}

std::vector<std::string> ContestReader::controller_names() const {
  std::vector<std::string> names;
  for (const ContestController& controller : contest_.controllers) names.push_back(controller.name);
  return names;
}

void ContestReader::read_reference() {
  const std::vector<std::string> names = controller_names();
  if (names.empty()) return;
  const std::string name = root_.name("reference", names.front(), names);
  contest_.reference = static_cast<std::size_t>(std::ranges::find(names, name) - names.begin());
}

void ContestReader::read_common(const YamlNode& node) {
  if (node.kind != YamlNode::Kind::kMap) {
    problems_.add(node, "common", describe(node), "a mapping {KEY: VALUE}");
    return;
  }
  contest_.common = read_settings(node, "common", problems_);
}

void ContestReader::read_scenarios() {
  if (const YamlNode* node = root_.tree("scenarios")) {
    contest_.scenarios = read_choices(*node, "scenarios", problems_);
  } else {
    root_.require("scenarios", "a list of names of shipped scenarios, or paths");
  }
}

void ContestReader::read_noise(const YamlNode& node) {
  contest_.noise_line = line_of(node);
  const std::string expected = fmt::format("a number from 0 to {:g}", kLargestNoise);
  if (node.kind != YamlNode::Kind::kList || node.items.empty() ||
      node.items.size() > kMostNoiseLevels) {
    problems_.add(node, "noise", describe(node),
                  fmt::format("a list of 1 to {} factors", kMostNoiseLevels));
    return;
  }
  std::vector<double> levels;
  for (std::size_t i = 0; i < node.items.size(); ++i) {
    const YamlNode& item = node.items[i];
    const std::string path = fmt::format("noise.{}", i);
    const std::optional<double> factor = parse_number(item);
    if (!factor || !(*factor >= 0.0 && *factor <= kLargestNoise)) {
      problems_.add(item, path, describe(item), expected);
    } else if (std::ranges::find(levels, *factor) != levels.end()) {
      problems_.add(item, path, describe(item) + " a second time", "each once");
    } else {
      levels.push_back(*factor);
    }
  }
  if (!levels.empty()) contest_.noise = std::move(levels);
}

void ContestReader::read_tuning() {
  Section tuning = root_.section("tuning");
  if (!tuning.present()) return;
  tuning.require("budget", fmt::format("a whole number from 1 to {}", kLargestBudget));
  const int budget = tuning.whole("budget", 1, {1, kLargestBudget});
  contest_.tuning = {.seeds = read_seeds(tuning, "seeds", problems_), .budget = budget};
  if (const YamlNode* node = tuning.tree("seeds")) refuse_shared_seeds(*node);
  if (const YamlNode* node = tuning.tree("search")) {
    read_search(*node, budget);
  } else {
    tuning.require("search", "a mapping of controllers to {KEY: [VALUES]}");
  }
  tuning.refuse_unread();
}

/// Settings tuned on the contest's own seeds would look better in its results than they are.
void ContestReader::refuse_shared_seeds(const YamlNode& node) {
  const SeedSet& tuning = contest_.tuning->seeds;
  const SeedSet& drives = contest_.seeds;
  const auto refuse = [&](std::uint64_t seed) {
    problems_.add(node, "tuning.seeds", fmt::format("seed {}, one of the contest's", seed),
                  "seeds that the contest does not drive: " + seeds_text(drives));
  };
  if (tuning.listed.empty() && drives.listed.empty()) {
    const std::uint64_t first = std::max(tuning.first, drives.first);
    const std::uint64_t end = std::min(tuning.first + static_cast<std::uint64_t>(tuning.count),
                                       drives.first + static_cast<std::uint64_t>(drives.count));
    if (first < end) refuse(first);
    return;
  }
  // At least one of them is a list, of at most kMostListedSeeds.
  const SeedSet& listed = tuning.listed.empty() ? drives : tuning;
  const SeedSet& other = tuning.listed.empty() ? tuning : drives;
  const std::unordered_set<std::uint64_t> others(other.listed.begin(), other.listed.end());
  for (const std::uint64_t seed : listed.listed) {
    const bool is_shared =
        other.listed.empty()
            ? seed >= other.first && seed - other.first < static_cast<std::uint64_t>(other.count)
            : others.contains(seed);
    if (is_shared) {
      refuse(seed);
      return;
    }
  }
}

void ContestReader::read_search(const YamlNode& node, std::int64_t budget) {
  if (node.kind != YamlNode::Kind::kMap || node.items.empty()) {
    problems_.add(node, "tuning.search", describe(node),
                  "a mapping of controllers to {KEY: [VALUES]}");
    return;
  }
  for (std::size_t i = 0; i < node.items.size(); ++i) {
    const std::string path = "tuning.search." + node.keys[i];
    const auto controller =
        std::ranges::find(contest_.controllers, node.keys[i], &ContestController::name);
    if (controller == contest_.controllers.end()) {
      problems_.add(node.items[i], path, node.keys[i],
                    expected_names(node.keys[i], controller_names()));
      continue;
    }
    const std::vector<GridAxis> axes = read_axes(node.items[i], path, problems_);
    if (axes.empty()) continue;
    double points = 1.0;
    for (const GridAxis& axis : axes) {
      refuse_shared(axis.values);
      points *= static_cast<double>(axis.values.size());
    }
    if (points < 1.0) continue;  // an axis without a valid value
    if (points > static_cast<double>(kMostGridPoints)) {
      problems_.add(node.items[i], path, fmt::format("{:.0f} combinations", points),
                    fmt::format("at most {}", kMostGridPoints));
      continue;
    }
    controller->grid = static_cast<std::int64_t>(points);
    controller->candidates.clear();
    for (const std::size_t point : tried_points(controller->grid, budget, controller->name)) {
      controller->candidates.push_back(candidate_at(axes, point));
    }
  }
}

void ContestReader::read_timing() {
  Section timing = root_.section("timing");
  contest_.timing_seeds = timing.whole("seeds", kTimingSeeds, {1, kMostTimingSeeds});
  timing.refuse_unread();
}

}  // namespace

Contest read_contest(const YamlNode& tree, const std::string& file, Problems& problems) {
  return ContestReader(tree, file, problems).read();
}

}  // namespace qsmpc::harness

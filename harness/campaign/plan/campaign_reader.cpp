#include "harness/campaign/plan/campaign_reader.hpp"

#include <algorithm>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "harness/campaign/plan/campaign_keys.hpp"
#include "harness/campaign/plan/draft_reading.hpp"
#include "harness/campaign/plan/variant_families.hpp"
#include "harness/campaign/statistics/stop_rule.hpp"

namespace qsmpc::harness {
namespace {

constexpr const char* kNoSettings = "base";  // the name of an empty mapping in a list of variants

class CampaignReader {
 public:
  CampaignReader(const YamlNode& tree, const std::string& file, Problems& problems)
      : tree_(tree), root_(tree, problems), problems_(problems) {
    draft_.file = file;
  }

  CampaignDraft read() {
    draft_.variants.emplace_back();
    draft_.plants.emplace_back();
    if (!root_.present()) return std::move(draft_);
    read_names();
    read_scenarios();
    if (const YamlNode* node = take("variants")) read_variants(*node);
    if (const YamlNode* node = take("grid")) draft_.grid = read_axes(*node, "grid", problems_);
    if (const YamlNode* node = take("plants")) read_plants(*node);
    read_seeds_or_say_why_not();
    read_traces();
    read_until();
    read_rare();
    draft_.families = read_families(root_.section("figure"), tree_.find("figure"), problems_);
    root_.refuse_unread();
    return std::move(draft_);
  }

 private:
  void read_names();
  void read_scenarios();
  void read_variants(const YamlNode& node);
  void read_variant(const YamlNode& node, const std::string& path, const std::string& name);
  void read_plants(const YamlNode& node);
  void read_seeds_or_say_why_not();
  void read_traces();
  void read_until();
  void read_rare();

  /// The value of a key; marks the key as known.
  const YamlNode* take(const std::string& key) {
    (void)root_.holds_text(key);
    return tree_.find(key);
  }
  void note(const YamlNode& node, std::string path, std::string expected) {
    problems_.add(node, std::move(path), describe(node), std::move(expected));
  }

  const YamlNode& tree_;
  Section root_;
  Problems& problems_;
  CampaignDraft draft_;
};

void CampaignReader::read_names() {
  const std::string stem = std::filesystem::path(draft_.file).stem().string();
  draft_.name = root_.text("name", stem, kLongestName);
  if (root_.has("name") && draft_.name.empty()) root_.note("name", "a name, not empty");
  (void)root_.text("description", "", kLongestCampaignDescription);
}

void CampaignReader::read_scenarios() {
  const std::string expected = "the name of a shipped scenario, or the path of one";
  const YamlNode* one = take("scenario");
  const YamlNode* many = take("scenarios");
  if (one != nullptr && many != nullptr) {
    root_.note("scenarios", "either scenario or scenarios", "both of them");
  }
  if (one == nullptr && many == nullptr) {
    root_.require("scenario", expected + "; or scenarios, a list of them");
  }
  if (one != nullptr) {
    const bool is_text = one->kind == YamlNode::Kind::kText;
    if (is_text && is_line_of_text(one->text, kLongestPath)) {
      draft_.scenarios.push_back({.text = one->text, .place = {line_of(*one), "scenario"}});
    } else {
      note(*one, "scenario", expected);
    }
  }
  if (many != nullptr) draft_.scenarios = read_choices(*many, "scenarios", problems_);
}

void CampaignReader::read_variants(const YamlNode& node) {
  const bool is_map = node.kind == YamlNode::Kind::kMap;
  if ((!is_map && node.kind != YamlNode::Kind::kList) || node.items.empty()) {
    note(node, "variants", "a mapping of names to {KEY: VALUE}, or a list of {KEY: VALUE}");
    return;
  }
  draft_.variants.clear();
  for (std::size_t i = 0; i < node.items.size(); ++i) {
    if (!is_map) {
      read_variant(node.items[i], fmt::format("variants.{}", i), "");
    } else if (is_line_of_text(node.keys[i], kLongestName)) {
      read_variant(node.items[i], "variants." + node.keys[i], node.keys[i]);
    } else {
      problems_.add(node.items[i], "variants", "\"" + node.keys[i] + "\"",
                    fmt::format("a name of 1 to {} bytes on one line", kLongestName));
    }
  }
  if (draft_.variants.empty()) draft_.variants.emplace_back();
}

void CampaignReader::read_variant(const YamlNode& node, const std::string& path,
                                  const std::string& name) {
  if (node.kind != YamlNode::Kind::kMap) {
    note(node, path, "a mapping {KEY: VALUE}; {} for the scenario as it is");
    return;
  }
  SettingGroup variant{.name = name,
                       .settings = read_settings(node, path, problems_),
                       .place = {line_of(node), path}};
  std::string texts;
  for (const CampaignSetting& setting : variant.settings) {
    texts += (texts.empty() ? "" : ", ") + setting.text;
  }
  if (name.empty()) variant.name = texts.empty() ? kNoSettings : texts;
  draft_.variants.push_back(std::move(variant));
}

void CampaignReader::read_plants(const YamlNode& node) {
  std::vector<CampaignChoice> plants = read_choices(node, "plants", problems_);
  if (!plants.empty()) draft_.plants = std::move(plants);
}

void CampaignReader::read_seeds_or_say_why_not() {
  const YamlNode* single = tree_.find("seed");
  if (tree_.find("seeds") == nullptr && single != nullptr) {
    (void)take("seed");  // reported instead of the missing key `seeds`
    problems_.add(*single, "seed", "a scenario's key",
                  "seeds: {first: 0, count: 1000}, or a list of whole numbers");
  } else {
    draft_.seeds = read_seeds(root_, "seeds", problems_);
  }
}

void CampaignReader::read_traces() {
  const std::vector<std::string>& names = trace_keeping_names();
  const std::string name = root_.name("traces", trace_keeping_name(draft_.traces), names);
  draft_.traces = static_cast<TraceKeeping>(std::ranges::find(names, name) - names.begin());
  draft_.trace_sample = root_.whole("trace_sample", 0, {0, kMostCampaignSeeds});
  if (root_.has("trace_sample") && draft_.traces != TraceKeeping::kFailures) {
    root_.note("trace_sample", "this key only with traces: failures");
  }
}

void CampaignReader::read_until() {
  const bool is_asked_for = root_.has("until");
  Section until = root_.section("until");
  if (!is_asked_for || !until.present()) return;
  StopCriterion criterion;
  until.require("rate_halfwidth", "half-width of each rate's interval, e.g. 0.001");
  criterion.rate_halfwidth = until.number("rate_halfwidth", kHalfwidthRange.most, kHalfwidthRange);
  criterion.confidence = until.number("confidence", criterion.confidence, kStopConfidenceRange);
  criterion.of = until.name("of", criterion.of, stop_event_names());
  until.refuse_unread();
  draft_.until = criterion;
}

void CampaignReader::read_rare() {
  const bool is_asked_for = root_.has("rare");
  Section section = root_.section("rare");
  if (!is_asked_for) return;
  RareSettings rare;
  SplitSettings& splitting = rare.splitting;
  splitting.particles = section.whole("particles", splitting.particles, {2, kMostRareParticles});
  splitting.killed = section.whole("killed", splitting.killed, {1, kMostRareParticles - 1});
  splitting.floor = section.number("floor", splitting.floor, kRareFloor);
  if (splitting.killed >= splitting.particles) {
    section.note("killed", fmt::format("fewer than the {} particles", splitting.particles));
  }
  rare.certify = section.flag("certify", rare.certify);
  section.refuse_unread();
  draft_.rare = rare;
}

}  // namespace

bool is_key_within(const std::string& inner, const std::string& outer) {
  return inner.starts_with(outer) && (inner.size() == outer.size() || inner[outer.size()] == '.');
}

std::string path_of(const CampaignSetting& setting, const std::string& key) {
  if (!is_key_within(key, setting.key)) return setting.owner + "." + key;
  return setting.owner + "." + setting.key + setting.item + key.substr(setting.key.size());
}

CampaignDraft read_campaign(const YamlNode& tree, const std::string& file, Problems& problems) {
  return CampaignReader(tree, file, problems).read();
}

}  // namespace qsmpc::harness

#include "harness/campaign/plan/campaign_reader.hpp"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string_view>
#include <unordered_set>
#include <utility>

#include <fmt/format.h>

#include "harness/campaign/plan/campaign_keys.hpp"
#include "harness/campaign/plan/variant_families.hpp"
#include "harness/scenario/yaml_text.hpp"
#include "harness/text/number_parse.hpp"
#include "harness/text/text_encoding.hpp"

namespace qsmpc::harness {
namespace {

constexpr std::size_t kLongestKey = 200;  // bytes; of a dotted path
constexpr const char* kSeedExpected = "a whole number from 0 to 9223372036854775807";
constexpr const char* kNoSettings = "base";  // the name of {} in a list of variants

bool is_line_of_text(const std::string& text, std::size_t longest) {
  return !text.empty() && text.size() <= longest && !find_text_problem(text) &&
         text.find_first_of("\n\r\t") == std::string::npos;
}

int line_of(const YamlNode& node) { return node.key_line > 0 ? node.key_line : node.line; }

std::optional<std::uint64_t> parse_seed(const YamlNode& node) {
  if (node.kind != YamlNode::Kind::kText || node.quoted) return std::nullopt;
  const auto seed = parse_integer<std::uint64_t>(node.text);
  return seed && *seed < kSeedEnd ? seed : std::nullopt;
}

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
    if (const YamlNode* node = take("grid")) read_grid(*node);
    if (const YamlNode* node = take("plants")) read_plants(*node);
    read_seeds();
    read_traces();
    draft_.families = read_families(root_.section("figure"), tree_.find("figure"), problems_);
    root_.refuse_unread();
    return std::move(draft_);
  }

 private:
  void read_names();
  void read_scenarios();
  void read_variants(const YamlNode& node);
  void read_variant(const YamlNode& node, const std::string& path, const std::string& name);
  void read_grid(const YamlNode& node);
  void read_plants(const YamlNode& node);
  void read_seeds();
  void read_seed_list(const YamlNode& node);
  void read_seed_range(Section section);
  void read_traces();
  [[nodiscard]] std::vector<CampaignChoice> choices(const YamlNode& list, const std::string& key);
  [[nodiscard]] bool check_key(const YamlNode& value, const std::string& key,
                               const std::string& path);

  /// The value of a key, which is then known.
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
  if (many != nullptr) draft_.scenarios = choices(*many, "scenarios");
}

/// A list of texts, each once.
std::vector<CampaignChoice> CampaignReader::choices(const YamlNode& list, const std::string& key) {
  if (list.kind != YamlNode::Kind::kList || list.items.empty()) {
    note(list, key, "a list of at least one name or path");
    return {};
  }
  std::vector<CampaignChoice> choices;
  std::unordered_set<std::string> seen;
  for (std::size_t i = 0; i < list.items.size(); ++i) {
    const YamlNode& item = list.items[i];
    const std::string path = fmt::format("{}.{}", key, i);
    if (item.kind != YamlNode::Kind::kText || !is_line_of_text(item.text, kLongestPath)) {
      note(item, path, "a name or path");
    } else if (!seen.insert(item.text).second) {
      problems_.add(item, path, item.text + " a second time", "each once");
    } else {
      choices.push_back({.text = item.text, .place = {line_of(item), path}});
    }
  }
  return choices;
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
  SettingGroup variant{.name = name, .place = {line_of(node), path}};
  std::string texts;
  for (std::size_t i = 0; i < node.items.size(); ++i) {
    const std::string& key = node.keys[i];
    if (!check_key(node.items[i], key, fmt::format("{}.{}", path, key))) continue;
    variant.settings.push_back({.key = key,
                                .value = node.items[i],
                                .text = key + "=" + yaml_flow(node.items[i]),
                                .owner = path,
                                .line = line_of(node.items[i])});
    if (!texts.empty()) texts += ", ";
    texts += variant.settings.back().text;
  }
  if (name.empty()) variant.name = texts.empty() ? kNoSettings : texts;
  draft_.variants.push_back(std::move(variant));
}

/// Whether a scenario's `key` may be set; `path` is where the campaign does it.
bool CampaignReader::check_key(const YamlNode& value, const std::string& key,
                               const std::string& path) {
  if (!is_line_of_text(key, kLongestKey) || key.find('=') != std::string::npos) {
    problems_.add(value, path, "\"" + key + "\"",
                  "a key of the scenario, names joined by dots, e.g. controller.horizon");
    return false;
  }
  if (is_key_within(key, "seed")) {
    problems_.add(value, path, "a seed", "the campaign's own key seeds");
    return false;
  }
  if (is_key_within(key, "name")) {
    problems_.add(value, path, "a name", "names from the campaign's keys only");
    return false;
  }
  return true;
}

void CampaignReader::read_grid(const YamlNode& node) {
  if (node.kind != YamlNode::Kind::kMap || node.items.empty()) {
    note(node, "grid", "a mapping of keys to lists of values");
    return;
  }
  for (std::size_t i = 0; i < node.items.size(); ++i) {
    const YamlNode& values = node.items[i];
    const std::string& key = node.keys[i];
    const std::string path = fmt::format("grid.{}", key);
    if (!check_key(values, key, path)) continue;
    if (values.kind != YamlNode::Kind::kList || values.items.empty()) {
      note(values, path, "a list of at least one value");
      continue;
    }
    GridAxis axis{.key = key, .line = line_of(values), .values = {}};
    std::unordered_set<std::string> seen;
    for (std::size_t k = 0; k < values.items.size(); ++k) {
      const YamlNode& value = values.items[k];
      const std::string text = yaml_flow(value);
      if (!seen.insert(text).second) {
        problems_.add(value, fmt::format("{}.{}", path, k), fmt::format("{} a second time", text),
                      "each once");
        continue;
      }
      axis.values.push_back({.key = key,
                             .value = value,
                             .text = fmt::format("{}={}", key, text),
                             .owner = "grid",
                             .item = fmt::format(".{}", k),
                             .line = line_of(value)});
    }
    draft_.grid.push_back(std::move(axis));
  }
}

void CampaignReader::read_plants(const YamlNode& node) {
  std::vector<CampaignChoice> plants = choices(node, "plants");
  if (!plants.empty()) draft_.plants = std::move(plants);
}

void CampaignReader::read_seeds() {
  const std::string expected = "{first: 0, count: 1000}, or a list of whole numbers";
  const YamlNode* node = take("seeds");
  const YamlNode* single = tree_.find("seed");
  if (node == nullptr && single != nullptr) {
    (void)take("seed");  // it is what is wrong, and not that another key is missing
    problems_.add(*single, "seed", "a scenario's key", "seeds: " + expected);
  } else if (node == nullptr) {
    root_.require("seeds", expected);
  } else if (node->kind == YamlNode::Kind::kList) {
    read_seed_list(*node);
  } else if (node->kind == YamlNode::Kind::kMap) {
    read_seed_range(root_.section("seeds"));
  } else {
    note(*node, "seeds", expected);
  }
}

void CampaignReader::read_seed_list(const YamlNode& node) {
  if (node.items.empty() || node.items.size() > kMostListedSeeds) {
    note(node, "seeds", fmt::format("a list of 1 to {} seeds", kMostListedSeeds));
    return;
  }
  std::unordered_set<std::uint64_t> seen;
  for (std::size_t i = 0; i < node.items.size(); ++i) {
    const YamlNode& item = node.items[i];
    const std::string path = fmt::format("seeds.{}", i);
    const std::optional<std::uint64_t> seed = parse_seed(item);
    if (!seed) {
      note(item, path, kSeedExpected);
    } else if (!seen.insert(*seed).second) {
      problems_.add(item, path, item.text + " a second time", "each seed once");
    } else {
      draft_.seeds.listed.push_back(*seed);
    }
  }
}

void CampaignReader::read_seed_range(Section section) {
  section.require("count", fmt::format("how many seeds, from 1 to {}", kMostCampaignSeeds));
  draft_.seeds.count = section.whole("count", 1, {1, kMostCampaignSeeds});
  (void)section.holds_text("first");
  if (const YamlNode* first = tree_.find("seeds")->find("first")) {
    const std::optional<std::uint64_t> seed = parse_seed(*first);
    if (!seed) {
      section.note("first", kSeedExpected);
    } else if (*seed > kSeedEnd - static_cast<std::uint64_t>(draft_.seeds.count)) {
      section.note("first", fmt::format("no seed over {}", kSeedEnd - 1),
                   fmt::format("{} with a count of {}", *seed, draft_.seeds.count));
    } else {
      draft_.seeds.first = *seed;
    }
  }
  section.refuse_unread();
}

void CampaignReader::read_traces() {
  const std::vector<std::string>& names = trace_keeping_names();
  const std::string name = root_.name("traces", trace_keeping_name(draft_.traces), names);
  draft_.traces = static_cast<TraceKeeping>(std::ranges::find(names, name) - names.begin());
  draft_.trace_sample = root_.whole("trace_sample", 0, {0, kMostCampaignSeeds});
  if (root_.has("trace_sample") && draft_.traces != TraceKeeping::kFailures) {
    root_.note("trace_sample", "no such key without traces: failures");
  }
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

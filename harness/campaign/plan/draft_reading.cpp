#include "harness/campaign/plan/draft_reading.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <unordered_set>
#include <utility>

#include <fmt/format.h>

#include "harness/campaign/plan/campaign_keys.hpp"
#include "harness/scenario/yaml_text.hpp"
#include "harness/text/number_parse.hpp"
#include "harness/text/text_encoding.hpp"

namespace qsmpc::harness {
namespace {

constexpr std::size_t kLongestKey = 200;  // bytes of a dotted path
constexpr const char* kSeedExpected = "a whole number from 0 to 9223372036854775807";

void note_node(const YamlNode& node, std::string path, std::string expected, Problems& problems) {
  problems.add(node, std::move(path), describe(node), std::move(expected));
}

std::optional<std::uint64_t> parse_seed(const YamlNode& node) {
  if (node.kind != YamlNode::Kind::kText || node.quoted) return std::nullopt;
  const auto seed = parse_integer<std::uint64_t>(node.text);
  return seed && *seed < kSeedEnd ? seed : std::nullopt;
}

/// Whether a scenario's `key` may be set; `path` is where the file sets it.
bool check_key(const YamlNode& value, const std::string& key, const std::string& path,
               Problems& problems) {
  if (!is_line_of_text(key, kLongestKey) || key.find('=') != std::string::npos) {
    problems.add(value, path, "\"" + key + "\"",
                 "a key of the scenario, names joined by dots, e.g. controller.horizon");
    return false;
  }
  if (is_key_within(key, "seed")) {
    problems.add(value, path, "a seed", "the campaign's own key seeds");
    return false;
  }
  if (is_key_within(key, "name")) {
    problems.add(value, path, "a name", "names from the campaign's keys only");
    return false;
  }
  return true;
}

SeedSet read_seed_list(const YamlNode& node, const std::string& key, Problems& problems) {
  SeedSet seeds;
  if (node.items.empty() || node.items.size() > kMostListedSeeds) {
    note_node(node, key, fmt::format("a list of 1 to {} seeds", kMostListedSeeds), problems);
    return seeds;
  }
  std::unordered_set<std::uint64_t> seen;
  for (std::size_t i = 0; i < node.items.size(); ++i) {
    const YamlNode& item = node.items[i];
    const std::string path = fmt::format("{}.{}", key, i);
    const std::optional<std::uint64_t> seed = parse_seed(item);
    if (!seed) {
      note_node(item, path, kSeedExpected, problems);
    } else if (!seen.insert(*seed).second) {
      problems.add(item, path, item.text + " a second time", "each seed once");
    } else {
      seeds.listed.push_back(*seed);
    }
  }
  return seeds;
}

SeedSet read_seed_range(Section section) {
  SeedSet seeds;
  section.require("count", fmt::format("how many seeds, from 1 to {}", kMostCampaignSeeds));
  seeds.count = section.whole("count", 1, {1, kMostCampaignSeeds});
  if (const YamlNode* first = section.tree("first")) {
    const std::optional<std::uint64_t> seed = parse_seed(*first);
    if (!seed) {
      section.note("first", kSeedExpected);
    } else if (*seed > kSeedEnd - static_cast<std::uint64_t>(seeds.count)) {
      section.note("first", fmt::format("no seed above {}", kSeedEnd - 1),
                   fmt::format("{} with a count of {}", *seed, seeds.count));
    } else {
      seeds.first = *seed;
    }
  }
  section.refuse_unread();
  return seeds;
}

}  // namespace

bool is_line_of_text(const std::string& text, std::size_t longest) {
  return !text.empty() && text.size() <= longest && !find_text_problem(text) &&
         text.find_first_of("\n\r\t") == std::string::npos;
}

int line_of(const YamlNode& node) { return node.key_line > 0 ? node.key_line : node.line; }

std::vector<CampaignChoice> read_choices(const YamlNode& list, const std::string& path,
                                         Problems& problems) {
  if (list.kind != YamlNode::Kind::kList || list.items.empty()) {
    note_node(list, path, "a list of at least one name or path", problems);
    return {};
  }
  std::vector<CampaignChoice> choices;
  std::unordered_set<std::string> seen;
  for (std::size_t i = 0; i < list.items.size(); ++i) {
    const YamlNode& item = list.items[i];
    const std::string place = fmt::format("{}.{}", path, i);
    if (item.kind != YamlNode::Kind::kText || !is_line_of_text(item.text, kLongestPath)) {
      note_node(item, place, "a name or path", problems);
    } else if (!seen.insert(item.text).second) {
      problems.add(item, place, item.text + " a second time", "each once");
    } else {
      choices.push_back({.text = item.text, .place = {line_of(item), place}});
    }
  }
  return choices;
}

std::vector<CampaignSetting> read_settings(const YamlNode& map, const std::string& path,
                                           Problems& problems) {
  std::vector<CampaignSetting> settings;
  for (std::size_t i = 0; i < map.items.size(); ++i) {
    const std::string& key = map.keys[i];
    if (!check_key(map.items[i], key, fmt::format("{}.{}", path, key), problems)) continue;
    settings.push_back({.key = key,
                        .value = map.items[i],
                        .text = key + "=" + yaml_flow(map.items[i]),
                        .owner = path,
                        .line = line_of(map.items[i])});
  }
  return settings;
}

std::vector<GridAxis> read_axes(const YamlNode& map, const std::string& path, Problems& problems) {
  if (map.kind != YamlNode::Kind::kMap || map.items.empty()) {
    note_node(map, path, "a mapping of keys to lists of values", problems);
    return {};
  }
  std::vector<GridAxis> axes;
  for (std::size_t i = 0; i < map.items.size(); ++i) {
    const YamlNode& values = map.items[i];
    const std::string& key = map.keys[i];
    const std::string place = fmt::format("{}.{}", path, key);
    if (!check_key(values, key, place, problems)) continue;
    if (values.kind != YamlNode::Kind::kList || values.items.empty()) {
      note_node(values, place, "a list of at least one value", problems);
      continue;
    }
    GridAxis axis{.key = key, .line = line_of(values), .values = {}};
    std::unordered_set<std::string> seen;
    for (std::size_t k = 0; k < values.items.size(); ++k) {
      const YamlNode& value = values.items[k];
      const std::string text = yaml_flow(value);
      if (!seen.insert(text).second) {
        problems.add(value, fmt::format("{}.{}", place, k), fmt::format("{} a second time", text),
                     "each once");
        continue;
      }
      axis.values.push_back({.key = key,
                             .value = value,
                             .text = fmt::format("{}={}", key, text),
                             .owner = path,
                             .item = fmt::format(".{}", k),
                             .line = line_of(value)});
    }
    axes.push_back(std::move(axis));
  }
  return axes;
}

SeedSet read_seeds(Section& section, const std::string& key, Problems& problems) {
  const std::string expected = "{first: 0, count: 1000}, or a list of whole numbers";
  const YamlNode* node = section.tree(key);
  if (node == nullptr) {
    section.require(key, expected);
    return {};
  }
  const std::string path = section.path_of(key);
  if (node->kind == YamlNode::Kind::kList) return read_seed_list(*node, path, problems);
  if (node->kind == YamlNode::Kind::kMap) return read_seed_range(section.section(key));
  note_node(*node, path, expected, problems);
  return {};
}

}  // namespace qsmpc::harness

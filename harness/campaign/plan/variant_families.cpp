#include "harness/campaign/plan/variant_families.hpp"

#include <algorithm>
#include <cstddef>
#include <unordered_set>

#include <fmt/format.h>

#include "harness/campaign/plan/campaign_keys.hpp"
#include "harness/scenario/known_names.hpp"
#include "harness/text/text_encoding.hpp"

namespace qsmpc::harness {
namespace {

constexpr const char* kFamiliesKey = "risk_against_cost";
constexpr std::size_t kMostKnownTold = 30;  // of the valid members listed in an error

bool is_family_name(const std::string& name) {
  return !name.empty() && name.size() <= kLongestName && !find_text_problem(name) &&
         name.find_first_of("\n\r\t") == std::string::npos;
}

/// Members that are not text or are duplicates are reported and left out.
std::vector<CampaignChoice> members_of(const YamlNode& list, const std::string& path,
                                       Problems& problems) {
  std::vector<CampaignChoice> members;
  std::unordered_set<std::string> seen;
  for (std::size_t i = 0; i < list.items.size(); ++i) {
    const YamlNode& item = list.items[i];
    const std::string place = fmt::format("{}.{}", path, i);
    if (item.kind != YamlNode::Kind::kText) {
      problems.add(item, place, describe(item), "the name of a variant");
    } else if (!seen.insert(item.text).second) {
      problems.add(item, place, item.text + " a second time", "each once");
    } else {
      members.push_back({.text = item.text, .place = {item.line, place}});
    }
  }
  return members;
}

/// "w20 (known: w2, w20)"; of more than kMostKnownTold, the nearest and then the first ones.
std::string expected_settings(const std::string& name, const std::vector<std::string>& known) {
  if (known == std::vector<std::string>{""})
    return "the name of a setting, but the campaign has no variants or grid";
  if (known.size() <= kMostKnownTold) return expected_names(name, known);
  std::vector<std::string> told = nearest_names(name, known);
  for (const std::string& one : known) {
    if (told.size() == kMostKnownTold) break;
    if (std::ranges::find(told, one) == told.end()) told.push_back(one);
  }
  return expected_names(name, told) + ", …";
}

}  // namespace

std::vector<FamilyDraft> read_families(Section figure, const YamlNode* node, Problems& problems) {
  if (!figure.present()) return {};
  const std::string path = figure.path_of(kFamiliesKey);
  (void)figure.holds_text(kFamiliesKey);  // marks the key as known
  figure.refuse_unread();
  const YamlNode* families = node->find(kFamiliesKey);
  if (families == nullptr) return {};
  if (families->kind != YamlNode::Kind::kMap || families->items.empty() ||
      families->items.size() > kMostFamilies) {
    problems.add(*families, path, describe(*families),
                 fmt::format("a mapping of 1 to {} names to lists of variants", kMostFamilies));
    return {};
  }
  std::vector<FamilyDraft> drafts;
  for (std::size_t i = 0; i < families->items.size(); ++i) {
    const YamlNode& list = families->items[i];
    const std::string& name = families->keys[i];
    const std::string place = fmt::format("{}.{}", path, name);
    if (!is_family_name(name)) {
      problems.add(list, path, "\"" + name + "\"",
                   fmt::format("a name of 1 to {} bytes on one line", kLongestName));
    } else if (list.kind != YamlNode::Kind::kList || list.items.empty()) {
      problems.add(list, place, describe(list), "a list of at least one variant");
    } else {
      drafts.push_back({.name = name, .settings = members_of(list, place, problems)});
    }
  }
  return drafts;
}

std::vector<VariantFamily> known_families(const std::vector<FamilyDraft>& drafts,
                                          const std::vector<std::string>& known,
                                          CampaignRefusals& refusals) {
  const std::unordered_set<std::string> there(known.begin(), known.end());
  std::vector<VariantFamily> families;
  for (const FamilyDraft& draft : drafts) {
    VariantFamily family{.name = draft.name};
    for (const CampaignChoice& member : draft.settings) {
      if (there.contains(member.text)) {
        family.settings.push_back(member.text);
      } else {
        refusals.add(member.place, member.text, expected_settings(member.text, known));
      }
    }
    families.push_back(std::move(family));
  }
  return families;
}

}  // namespace qsmpc::harness

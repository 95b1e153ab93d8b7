#include "harness/campaign/plan/campaign_keys.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/campaign/campaign.hpp"
#include "harness/campaign/statistics/stop_rule.hpp"
#include "harness/scenario/keys/key_schema.hpp"

namespace qsmpc::harness {
namespace {

/// A list of distinct names or paths.
ListValue choices_value() {
  return list_of_values(TextValue{.what = "a name or path"}, {.least = 1, .once = true});
}

std::vector<KeyDescription> head_keys() {
  return {{.name = "name",
           .values = {TextValue{.longest = kLongestName, .what = "a name"}},
           .words = "what the campaign is called, up to {longest} bytes",
           .fallback_words = "the file's name"},
          {.name = "description",
           .values = {TextValue{.longest = kLongestCampaignDescription}},
           .words = "one line for people, up to {longest} bytes",
           .fallback_words = "none"},
          {.name = "scenario",
           .values = {TextValue{.what = "a name or path"}},
           .words = "a shipped scenario's name, or a path from the campaign file's folder (where "
                    "the file comes first)"},
          {.name = "scenarios",
           .values = {choices_value()},
           .words = "list of such names or paths; one of `scenario` and `scenarios` is needed, and "
                    "only one"}};
}

std::vector<KeyDescription> setting_keys() {
  const KeyDescription value{.name = "KEY", .family = NameFamily::kFree, .values = {AnyValue{}}};
  const MappingValue settings{{value}};
  const KeyDescription variant{.name = "NAME", .family = NameFamily::kFree, .values = {settings}};
  KeyDescription values = value;
  values.values = {list_of_values(AnyValue{}, {.least = 1, .once = true})};
  return {{.name = "variants",
           .values = {list_of_values(settings, {.least = 1}), MappingValue{{variant}}},
           .words = "settings that are applied together: a mapping of a name to `{KEY: VALUE}`, or "
                    "a list of `{KEY: VALUE}`; `{}` is the scenario as it is",
           .fallback_words = "the scenario as it is"},
          {.name = "grid",
           .values = {MappingValue{{values}}},
           .words = "mapping of a KEY to a list of VALUES: all combinations, applied after the "
                    "variant's settings",
           .fallback_words = "none"},
          {.name = "plants",
           .values = {choices_value()},
           .words = "list of names or paths, as after `--plant` of `qsmpc compare`; an XML file is "
                    "looked for in the campaign file's folder first",
           .fallback_words = "the scenario's own"}};
}

std::vector<KeyDescription> seed_keys() {
  const WholeValue seed{0, kSeedEnd - 1};
  const MappingValue range{{{.name = "first",
                             .values = {seed},
                             .words = "the first seed, {range}; the others follow in steps of 1",
                             .fallback = "0"},
                            {.name = "count",
                             .values = {WholeValue{1, kMostCampaignSeeds}},
                             .words = "number of seeds",
                             .required = true}}};
  return {
      {.name = "seeds",
       .values = {range,
                  list_of_values(seed, {.least = 1, .most = kMostListedSeeds, .once = true})},
       .words = fmt::format("a mapping of the keys below, or a list of up to {} seeds, each once",
                            kMostListedSeeds),
       .required = true}};
}

std::vector<KeyDescription> until_keys() {
  const MappingValue rule{
      {{.name = "rate_halfwidth",
        .values = {NumberValue{kHalfwidthRange}},
        .words = "half-width, {range}, at which the interval of each variant's rate is narrow "
                 "enough to stop",
        .required = true},
       {.name = "confidence",
        .values = {NumberValue{kStopConfidenceRange}},
        .words = "confidence of each of these intervals, {range}, valid at every number of seeds",
        .fallback = "0.99"},
       {.name = "of",
        .values = {NameValue{stop_event_names()}},
        .words = "what is counted: {names}",
        .fallback = kUnsafeEvent}}};
  return {{.name = "until",
           .values = {rule},
           .words = "stops once the rates are known precisely enough: a mapping of the keys below, "
                    "see [below](#stopping-early); `seeds` is then the maximum",
           .fallback_words = "all seeds"}};
}

std::vector<KeyDescription> trace_keys() {
  return {{.name = "traces",
           .values = {NameValue{trace_keeping_names()}},
           .words = "episodes whose traces are kept: {names}; a failure is an episode that did not "
                    "reach the target or was unsafe",
           .fallback = trace_keeping_name(TraceKeeping::kNone)},
          {.name = "trace_sample",
           .values = {WholeValue{0, kMostCampaignSeeds}},
           .words = "with `failures`: number of first seeds of each variant, {range}, whose traces "
                    "are kept in any case",
           .fallback = "0"}};
}

std::vector<KeyDescription> figure_keys() {
  const KeyDescription family{
      .name = "FAMILY",
      .family = NameFamily::kFree,
      .values = {list_of_values(TextValue{.what = "settings"}, {.least = 1, .once = true})}};
  const MappingValue figures{
      {{.name = "risk_against_cost",
        .values = {MappingValue{{family}}},
        .words = fmt::format("mapping of a FAMILY to a list of its variants, up to {} "
                             "families, see [below](#risk-against-cost)",
                             kMostFamilies),
        .fallback_words = "no such figure"}}};
  return {{.name = "figure",
           .values = {figures},
           .words = "figures that are drawn on request: a mapping of the key below",
           .fallback_words = "none"}};
}

std::vector<KeyDescription> rare_keys() {
  const SplitSettings fallback;
  const MappingValue rare{
      {{.name = "particles",
        .values = {WholeValue{2, kMostRareParticles}},
        .words = "drives kept at a time: more of them give a sharper estimate at proportionally "
                 "higher cost",
        .fallback = fmt::format("{}", fallback.particles)},
       {.name = "killed",
        .values = {WholeValue{1, kMostRareParticles - 1}},
        .words = "number of them, fewer than `particles`, that are discarded at each level",
        .fallback = fmt::format("{}", fallback.killed)},
       {.name = "floor",
        .values = {NumberValue{kRareFloor}},
        .words = "a run ends once its estimate can only be smaller",
        .fallback = fmt::format("{}", fallback.floor)},
       {.name = "certify",
        .values = {FlagValue{}},
        .words = "whether all of these drives are certified, so that the certificates can be "
                 "compared with the probability",
        .fallback = "true"}}};
  return {{.name = "rare",
           .values = {rare},
           .words = "look for [rare outcomes](rare.md): each seed of a variant also estimates, by "
                    "splitting, how probable an unsafe drive is; a mapping of the keys below",
           .fallback_words = "no search for them"}};
}

}  // namespace

const std::vector<std::string>& trace_keeping_names() {
  static const std::vector<std::string> names{trace_keeping_name(TraceKeeping::kNone),
                                              trace_keeping_name(TraceKeeping::kFailures),
                                              trace_keeping_name(TraceKeeping::kAll)};
  return names;
}

const std::vector<KeyDescription>& campaign_keys() {
  static const std::vector<KeyDescription> keys = [] {
    std::vector<KeyDescription> all;
    for (std::vector<KeyDescription> (*make)() :
         {head_keys, setting_keys, seed_keys, until_keys, trace_keys, rare_keys, figure_keys}) {
      for (KeyDescription& key : make()) all.push_back(std::move(key));
    }
    return all;
  }();
  return keys;
}

nlohmann::ordered_json campaign_schema() {
  nlohmann::ordered_json schema =
      json_schema({.title = "qsmpc campaign",
                   .description = "The episodes to drive: scenarios, times settings, times plants, "
                                  "each with the same seeds."},
                  campaign_keys());
  for (const char* key : {"scenario", "scenarios"}) {
    schema["oneOf"].push_back({{"required", {key}}});
  }
  return schema;
}

std::vector<DocumentTable> campaign_tables() {
  return {{.file = "docs/campaign.md", .name = "campaign", .text = key_table(campaign_keys())}};
}

}  // namespace qsmpc::harness

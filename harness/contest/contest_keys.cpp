#include "harness/contest/contest_keys.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/campaign/plan/campaign_keys.hpp"
#include "harness/campaign/plan/campaign_reader.hpp"
#include "harness/scenario/keys/key_schema.hpp"

namespace qsmpc::harness {
namespace {

/// Keys of `controller` that belong to the problem, not to its solver.
constexpr std::array kSharedKeys{"controller.horizon", "controller.input_bounds", "controller.cost",
                                 "controller.deadline", "controller.threads"};
constexpr const char* kScenariosWords =
    "list of shipped scenarios' names, or paths from the contest file's folder (where the file "
    "comes first)";
constexpr const char* kPlantsWords =
    "list of names or paths, as after `--plant` of `qsmpc compare`; an XML file is looked for in "
    "the contest file's folder first";

ListValue choices() {
  return list_of_values(TextValue{.what = "a name or path"}, {.least = 1, .once = true});
}

MappingValue settings() {
  return {{{.name = "KEY", .family = NameFamily::kFree, .values = {AnyValue{}}}}};
}

std::vector<KeyValue> seed_values() {
  const WholeValue seed{0, kSeedEnd - 1};
  const MappingValue range{
      {{.name = "first", .values = {seed}},
       {.name = "count", .values = {WholeValue{1, kMostCampaignSeeds}}, .required = true}}};
  return {range, list_of_values(seed, {.least = 1, .most = kMostListedSeeds, .once = true})};
}

std::vector<KeyDescription> head_of_contest() {
  const KeyDescription controller{
      .name = "NAME", .family = NameFamily::kFree, .values = {settings()}};
  return {{.name = "name",
           .values = {TextValue{.longest = kLongestName, .what = "a name"}},
           .words = "what the contest is called, up to {longest} bytes",
           .fallback_words = "the file's name"},
          {.name = "description",
           .values = {TextValue{.longest = kLongestCampaignDescription}},
           .words = "one line for people, up to {longest} bytes",
           .fallback_words = "none"},
          {.name = "controllers",
           .values = {MappingValue{{controller}}},
           .words = fmt::format("mapping of a NAME to the settings `{{KEY: VALUE}}` that make the "
                                "controller, 2 to {} of them; a KEY is one within `controller` or "
                                "`risk`, see [fairness](#fairness)",
                                kMostControllers),
           .required = true},
          {.name = "reference",
           .values = {TextValue{.longest = kLongestName, .what = "a controller's NAME"}},
           .words = "the controller that the others are compared with, seed by seed",
           .fallback_words = "the first one"},
          {.name = "common",
           .values = {settings()},
           .words = "settings of all controllers: `{KEY: VALUE}`",
           .fallback_words = "none"}};
}

std::vector<KeyDescription> drives_of_contest() {
  return {{.name = "scenarios", .values = {choices()}, .words = kScenariosWords, .required = true},
          {.name = "plants",
           .values = {choices()},
           .words = kPlantsWords,
           .fallback_words = "the scenario's own"},
          {.name = "noise",
           .values = {list_of_values(NumberValue{{.least = 0.0, .most = kLargestNoise}},
                                     {.least = 1, .most = kMostNoiseLevels, .once = true})},
           .words = fmt::format("list of factors of the scenario's `disturbance.covariance`, from "
                                "0 to {:g}; the controllers receive the scaled one",
                                kLargestNoise),
           .fallback = "[1]"},
          {.name = "seeds",
           .values = seed_values(),
           .words = "`{first: FIRST, count: COUNT}`, or a list of seeds, as in a "
                    "[campaign](campaign.md#the-campaign-file)",
           .required = true},
          {.name = "risk_limit",
           .values = {NumberValue{{.least = 0.0, .most = 1.0}}},
           .words = "a certified risk, {range}, that every drive is asked to keep; for each "
                    "controller the share of drives that do is told as "
                    "[`kept`](#what-is-measured)",
           .fallback_words = "none"}};
}

std::vector<KeyDescription> tuning_of_contest() {
  const KeyDescription axis{.name = "KEY",
                            .family = NameFamily::kFree,
                            .values = {list_of_values(AnyValue{}, {.least = 1, .once = true})}};
  const KeyDescription search{
      .name = "NAME", .family = NameFamily::kFree, .values = {MappingValue{{axis}}}};
  const MappingValue tuning{
      {{.name = "seeds",
        .values = seed_values(),
        .words = "like `seeds`, but without any of them",
        .required = true},
       {.name = "search",
        .values = {MappingValue{{search}}},
        .words = "mapping of a controller's NAME to `{KEY: [VALUES]}`: all combinations are its "
                 "candidates; a controller that is not named drives with its settings as they are",
        .required = true},
       {.name = "budget",
        .values = {WholeValue{1, kLargestBudget}},
        .words = "number of candidates tried per controller, {range}; if there are more, the first "
                 "ones in a fixed random order",
        .required = true}}};
  const MappingValue timing{{{.name = "seeds",
                              .values = {WholeValue{1, kMostTimingSeeds}},
                              .words = "number of first seeds, {range}, that are driven once more, "
                                       "one drive at a time, to measure the times",
                              .fallback = fmt::format("{}", kTimingSeeds)}}};
  return {{.name = "tuning",
           .values = {tuning},
           .words = "the search for each controller's settings: a mapping of the keys below",
           .fallback_words = "none: they drive with their settings as they are"},
          {.name = "timing",
           .values = {timing},
           .words = "a mapping of the key below",
           .fallback_words = "its default"}};
}

}  // namespace

const std::vector<KeyDescription>& contest_keys() {
  static const std::vector<KeyDescription> keys = [] {
    std::vector<KeyDescription> all;
    for (std::vector<KeyDescription> (*make)() :
         {head_of_contest, drives_of_contest, tuning_of_contest}) {
      for (KeyDescription& key : make()) all.push_back(std::move(key));
    }
    return all;
  }();
  return keys;
}

nlohmann::ordered_json contest_schema() {
  return json_schema({.title = "qsmpc contest",
                      .description = "Controllers that drive the same scenarios, plants, noise and "
                                     "seeds."},
                     contest_keys());
}

std::vector<DocumentTable> contest_tables() {
  return {{.file = "docs/contest.md", .name = "contest", .text = key_table(contest_keys())}};
}

std::string why_shared(const std::string& key) {
  const bool is_own =
      (is_key_within(key, "controller") && key != "controller") || is_key_within(key, "risk");
  if (!is_own)
    return "keys within controller or risk; settings of all controllers belong in common";
  const bool is_shared = std::ranges::any_of(
      kSharedKeys, [&](const char* shared) { return is_key_within(key, shared); });
  return is_shared ? "the same for all controllers, in common" : "";
}

}  // namespace qsmpc::harness

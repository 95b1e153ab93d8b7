#include "harness/contest/contest_file.hpp"

#include <unordered_set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/campaign/plan/campaign_plan.hpp"
#include "harness/contest/contest_plan.hpp"
#include "harness/contest/contest_reader.hpp"
#include "harness/files/text_file.hpp"
#include "harness/scenario/shipped_files.hpp"
#include "harness/scenario/yaml_section.hpp"
#include "harness/scenario/yaml_tree.hpp"
#include "harness/text/json_text.hpp"
#include "harness/text/printable.hpp"

namespace qsmpc::harness {
namespace {

constexpr std::size_t kLongestLabel = 100;  // bytes of a candidate, for a terminal

LoadedContest read_contest_file(const std::string& path, Problems& problems) {
  const YamlNode tree = parse_yaml(read_text_file(path), path);
  LoadedContest loaded{.contest = read_contest(tree, path, problems)};
  const Contest& contest = loaded.contest;
  if (contest.controllers.empty() || contest.scenarios.empty()) return loaded;
  const ContestChoice first(contest.controllers.size(), 0);
  loaded.drives =
      contest_campaign(contest, chosen_contenders(first), contest.seeds, false, problems);
  const std::vector<Contender> searched = searched_contenders(contest);
  if (searched.empty() || !problems.empty()) return loaded;
  loaded.search = contest_campaign(contest, searched, contest.tuning->seeds, true, problems);
  loaded.search.name += ", tuning";
  return loaded;
}

Campaign checked(Campaign (*make)(const Contest&, const ContestChoice&, Problems&),
                 const Contest& contest, const ContestChoice& choice) {
  Problems problems(contest.file);
  Campaign campaign = make(contest, choice, problems);
  if (!problems.empty()) throw InputError(problems.sorted().front());
  return campaign;
}

std::string counted_things(std::size_t count, const char* what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

}  // namespace

std::string find_contest(const std::string& path_or_name) {
  return find_file_or_shipped(path_or_name, ShippedKind::kContest);
}

LoadedContest load_contest(const std::string& path_or_name) {
  const std::string path = find_contest(path_or_name);
  Problems problems(path);
  LoadedContest loaded = read_contest_file(path, problems);
  if (!problems.empty()) throw InputError(problems.sorted().front());
  return loaded;
}

std::vector<InputError::Where> validate_contest_file(const std::string& path_or_name) {
  try {
    const std::string path = find_contest(path_or_name);
    Problems problems(path);
    (void)read_contest_file(path, problems);
    // A problem with a setting is reported once per scenario; keep only the first report.
    std::vector<InputError::Where> once;
    std::unordered_set<std::string> seen;
    for (const InputError::Where& where : problems.sorted()) {
      if (seen.insert(InputError(where).what()).second) once.push_back(where);
    }
    return once;
  } catch (const InputError& error) {
    return {error.where()};
  }
}

bool is_contest_file(const std::string& path_or_name) {
  if (!is_file(path_or_name)) {
    return find_shipped_contest(path_or_name) && !find_shipped_scenario(path_or_name) &&
           !find_shipped_campaign(path_or_name);
  }
  try {
    const YamlNode tree = parse_yaml(read_text_file(path_or_name), path_or_name);
    return tree.find("controllers") != nullptr && tree.find("model") == nullptr;
  } catch (const InputError&) {
    return false;
  }
}

Campaign chosen_drives(const Contest& contest, const ContestChoice& choice) {
  return checked(
      [](const Contest& of, const ContestChoice& chosen, Problems& problems) {
        return contest_campaign(of, chosen_contenders(chosen), of.seeds, false, problems);
      },
      contest, choice);
}

Campaign timed_drives(const Contest& contest, const ContestChoice& choice) {
  Campaign campaign = checked(
      [](const Contest& of, const ContestChoice& chosen, Problems& problems) {
        return contest_campaign(of, chosen_contenders(chosen),
                                first_seeds(of.seeds, of.timing_seeds), false, problems);
      },
      contest, choice);
  campaign.name += ", timing";
  return campaign;
}

std::string contest_size_text(const LoadedContest& loaded) {
  const Contest& contest = loaded.contest;
  return fmt::format("contest {}: {} x {} x {} x {} x {} = {} drives", printable(contest.name),
                     counted_things(contest.controllers.size(), "controller"),
                     counted_things(contest.scenarios.size(), "scenario"),
                     counted_things(contest.plants.size(), "plant"),
                     counted_things(contest.noise.size(), "noise level"),
                     counted_things(static_cast<std::size_t>(contest.seeds.size()), "seed"),
                     loaded.drives.episodes());
}

std::string contest_plan_text(const LoadedContest& loaded) {
  const Contest& contest = loaded.contest;
  std::string text = contest_size_text(loaded) + "\n\n";
  for (std::size_t n = 0; n < contest.controllers.size(); ++n) {
    const ContestController& controller = contest.controllers[n];
    text += fmt::format("  {}{}\n", printable(controller.name),
                        n == contest.reference ? " (the reference)" : "");
    for (const CampaignSetting& setting : controller.settings) {
      text += "    " + printable(setting.text, kLongestLabel) + "\n";
    }
    if (controller.candidates.size() == 1 && controller.grid == 1) continue;
    text += fmt::format("    {} of {} candidates are tried:\n", controller.candidates.size(),
                        controller.grid);
    for (const ContestCandidate& candidate : controller.candidates) {
      text += "      " + printable(candidate.label, kLongestLabel) + "\n";
    }
  }
  const Campaign timed = timed_drives(contest, ContestChoice(contest.controllers.size(), 0));
  return text + fmt::format(
                    "\n  search    {} drives\n  contest   {} drives, seeds {}\n  timing    "
                    "{} drives, one at a time\n",
                    loaded.search.variants.empty() ? 0 : loaded.search.episodes(),
                    loaded.drives.episodes(), printable(seeds_text(contest.seeds), 60),
                    timed.episodes());
}

std::string contest_plan_json(const LoadedContest& loaded) {
  using Json = nlohmann::ordered_json;
  const Contest& contest = loaded.contest;
  Json json{{"contest", contest.name},
            {"reference", contest.controllers[contest.reference].name},
            {"controllers", Json::object()}};
  for (const ContestController& controller : contest.controllers) {
    Json item{
        {"settings", Json::array()}, {"grid", controller.grid}, {"candidates", Json::array()}};
    for (const CampaignSetting& setting : controller.settings) {
      item["settings"].push_back(setting.text);
    }
    for (const ContestCandidate& candidate : controller.candidates) {
      item["candidates"].push_back(candidate.label);
    }
    json["controllers"][controller.name] = std::move(item);
  }
  json["noise"] = contest.noise;
  json["search"] = nullptr;
  if (!loaded.search.variants.empty()) {
    json["search"] = Json::parse(campaign_plan_json(loaded.search));
  }
  json["drives"] = Json::parse(campaign_plan_json(loaded.drives));
  json["timing"] = {{"seeds", first_seeds(contest.seeds, contest.timing_seeds).size()}};
  return json_text(json);
}

}  // namespace qsmpc::harness

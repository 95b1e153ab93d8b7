#include <nlohmann/json.hpp>

#include "harness/contest/contest_results.hpp"
#include "harness/contest/sentences.hpp"
#include "harness/text/json_text.hpp"
#include "harness/trace/json_values.hpp"

namespace qsmpc::harness {
namespace {

using ContestJson = nlohmann::ordered_json;

ContestJson share_json(const EpisodeRate& rate) {
  return {{"drives", rate.events}, {"rate", rate.rate}, {"interval", interval_json(rate.interval)}};
}

ContestJson drive_mean_json(const DriveMean& mean) {
  return {{"drives", mean.drives}, {"mean", mean.mean}, {"interval", interval_json(mean.interval)}};
}

ContestJson share_difference_json(const ShareDifference& difference, MatchResult result) {
  return {{"mean", difference.mean},
          {"interval", interval_json(difference.interval)},
          {"pairs", difference.pairs},
          {"higher", difference.higher},
          {"lower", difference.lower},
          {"p_value", difference.p_value},
          {"result", match_result_name(result)}};
}

ContestJson versus_json(const Versus& versus) {
  const CostDifference& cost = versus.cost;
  return {{"reached", share_difference_json(versus.reached, versus.arrival())},
          {"unsafe", share_difference_json(versus.unsafe, versus.safety())},
          {"cost",
           {{"mean", cost.mean},
            {"interval", interval_json(cost.interval)},
            {"ratio", cost.ratio},
            {"ratio_interval", interval_json(cost.ratio_interval)},
            {"pairs", cost.pairs},
            {"result", match_result_name(versus.economy())}}}};
}

ContestJson contest_times_json(const ContestTimes& times) {
  if (times.periods == 0) return nullptr;
  return {{"periods", times.periods}, {"late", times.late},      {"median", times.ocp_ms.median},
          {"p95", times.ocp_ms.p95},  {"p99", times.ocp_ms.p99}, {"max", times.ocp_ms.max},
          {"mean", times.ocp_ms.mean}};
}

ContestJson standing_json(const Standing& standing) {
  ContestJson json{{"drives", standing.drives},
                   {"reached", share_json(standing.reached)},
                   {"collision", share_json(standing.collision)},
                   {"left_bounds", share_json(standing.left_bounds)},
                   {"timeout", share_json(standing.timeout)},
                   {"fault", share_json(standing.fault)},
                   {"unsafe", share_json(standing.unsafe)},
                   {"kept", nullptr},
                   {"promised", nullptr},
                   {"believed", drive_mean_json(standing.believed)},
                   {"certified", drive_mean_json(standing.certified)},
                   {"certificate", scope_json(standing.no_bound)},
                   {"cost", drive_mean_json(standing.cost)},
                   {"versus", nullptr},
                   {"ocp_ms", contest_times_json(standing.times)}};
  if (standing.kept) json["kept"] = share_json(*standing.kept);
  if (standing.promised) json["promised"] = share_json(*standing.promised);
  if (standing.versus) json["versus"] = versus_json(*standing.versus);
  return json;
}

ContestJson texts_of(const std::vector<CampaignSetting>& settings) {
  ContestJson json = ContestJson::array();
  for (const CampaignSetting& setting : settings) json.push_back(setting.text);
  return json;
}

ContestJson tried_json(const ContestController& controller,
                       const std::vector<TriedCandidate>& tried, std::size_t chosen) {
  ContestJson json = ContestJson::array();
  for (const TriedCandidate& one : tried) {
    json.push_back({{"settings", texts_of(controller.candidates[one.candidate].settings)},
                    {"drives", one.drives},
                    {"failures", one.failures},
                    {"relative_cost", one.relative_cost},
                    {"chosen", one.candidate == chosen}});
  }
  return json;
}

ContestJson controllers_json(const ContestResults& results) {
  ContestJson json = ContestJson::object();
  for (std::size_t n = 0; n < results.contest.controllers.size(); ++n) {
    const ContestController& controller = results.contest.controllers[n];
    const std::size_t chosen = results.tuning.choice[n];
    json[controller.name] = {{"settings", texts_of(controller.settings)},
                             {"grid", controller.grid},
                             {"tried", tried_json(controller, results.tuning.tried[n], chosen)},
                             {"chosen", texts_of(controller.candidates[chosen].settings)},
                             {"overall", standing_json(results.overall[n])},
                             {"words", words_about(results, n)}};
  }
  return json;
}

ContestJson cell_json(const ContestResults& results, const CellStandings& cell) {
  const Contest& contest = results.contest;
  ContestJson json{{"scenario", contest.scenarios[cell.cell.scenario].text},
                   {"plant", nullptr},
                   {"noise", contest.noise[cell.cell.noise]},
                   {"controllers", ContestJson::object()}};
  const std::string& plant = contest.plants[cell.cell.plant].text;
  if (!plant.empty()) json["plant"] = plant;
  for (std::size_t n = 0; n < cell.standings.size(); ++n) {
    json["controllers"][contest.controllers[n].name] = standing_json(cell.standings[n]);
  }
  return json;
}

}  // namespace

std::string contest_json(const ContestResults& results) {
  const Contest& contest = results.contest;
  ContestJson json{{"name", contest.name},
                   {"description", contest.description},
                   {"version", results.version},
                   {"reference", contest.controllers[contest.reference].name},
                   {"seeds", seeds_text(contest.seeds)},
                   {"common", texts_of(contest.common)},
                   {"risk_limit", nullptr},
                   {"drives", results.asked},
                   {"done", results.done},
                   {"tuning", nullptr},
                   {"timing", nullptr}};
  if (contest.risk_limit) json["risk_limit"] = *contest.risk_limit;
  if (contest.tuning) {
    json["tuning"] = {{"seeds", seeds_text(contest.tuning->seeds)},
                      {"budget", contest.tuning->budget},
                      {"criterion", tuning_criterion(contest)}};
  }
  if (results.timed) json["timing"] = {{"seeds", contest.timing_seeds}, {"jobs", 1}};
  json["headline"] = contest_headline(results);
  json["controllers"] = controllers_json(results);
  json["cells"] = ContestJson::array();
  for (const CellStandings& cell : results.cells) json["cells"].push_back(cell_json(results, cell));
  return json_text(json);
}

}  // namespace qsmpc::harness

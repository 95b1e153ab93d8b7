#include "harness/prediction/prediction_json.hpp"

#include <cstddef>

#include "harness/prediction/prediction_file.hpp"
#include "harness/scenario/certificate_scope.hpp"
#include "harness/text/json_text.hpp"
#include "harness/trace/json_values.hpp"

namespace qsmpc::harness {
namespace {

using Json = nlohmann::ordered_json;

Json rate_json(std::int64_t events, std::int64_t samples) {
  const SimulatedRate simulated = simulated_rate(events, samples);
  return {{"rate", simulated.rate},
          {"lower", simulated.limits.lower},
          {"upper", simulated.limits.upper},
          {"samples", samples}};
}

Json certificate_json(const controller::StageCertificate& certificate) {
  Json all = Json::object();
  for (const controller::CertificateEntry& entry : controller::certificate_entries()) {
    if (entry.is_bound) all[entry.key] = certificate.of(entry.key);
  }
  return {{"value", certificate.value},
          {"kind", certificate.kind},
          {"all", all},
          {"entry", certificate.of("entry")},
          {"thesis", certificate.of("thesis")}};
}

Json stage_json(const PredictionReport& report, std::size_t stage) {
  const controller::DiscreteMeasure& particles = report.prediction.stages[stage];
  const controller::StageBudget& budget = report.budgets[stage];
  Json json;
  json["stage"] = stage;
  json["mean"] = vector_json(controller::mean_of(particles));
  json["covariance"] = rows_json(controller::covariance_of(particles));
  json["w2_bound"] = budget.total;
  json["budget"] = {{"belief", budget.belief},
                    {"noise", budget.noise},
                    {"compression", budget.compression},
                    {"model", budget.model},
                    {"dynamics", budget.dynamics}};
  json["certificate"] = certificate_json(report.certificates[stage - 1]);
  if (report.monte_carlo) {
    json["monte_carlo"] =
        rate_json(report.monte_carlo->stages[stage - 1], report.monte_carlo->samples);
  }
  return json;
}

Json truth_json(const LawComparison& laws) {
  Json json{{"samples", laws.truth.samples}, {"w2_paths", kTransportPaths}};
  json["stages"] = Json::array();
  for (std::size_t k = 0; k < laws.floors.size(); ++k) {
    json["stages"].push_back({{"stage", k + 1},
                              {"mean", vector_json(laws.truth.moments[k].mean)},
                              {"covariance", rows_json(laws.truth.moments[k].covariance)},
                              {"floor",
                               {{"w2", laws.floors[k].w2},
                                {"mean", laws.floors[k].mean},
                                {"covariance", laws.floors[k].covariance}}}});
  }
  return json;
}

Json methods_json(const LawComparison& laws) {
  Json json = Json::object();
  for (const MethodErrors& method : laws.methods) {
    Json stages = Json::array();
    for (std::size_t k = 0; k < method.stages.size(); ++k) {
      const LawErrors& errors = method.stages[k];
      stages.push_back({{"stage", k + 1},
                        {"w2", errors.w2},
                        {"mean", errors.mean},
                        {"covariance", errors.covariance},
                        {"unsafe", errors.unsafe}});
    }
    json[method.name] = {{"ms", method.milliseconds}, {"stages", stages}};
  }
  return json;
}

}  // namespace

std::string prediction_json(const PredictionReport& report) {
  Json json;
  json["inputs"] = rows_json(report.policy.inputs.transpose());
  json["cost"] = report.cost.total();  // null if the controller has none
  json["stages"] = Json::array();
  for (std::size_t stage = 1; stage < report.prediction.stages.size(); ++stage) {
    json["stages"].push_back(stage_json(report, stage));
  }
  json["horizon"] = {{"value", report.horizon_bound}};
  if (report.monte_carlo) {
    json["horizon"]["monte_carlo"] =
        rate_json(report.monte_carlo->any_stage, report.monte_carlo->samples);
  }
  if (report.laws) {
    json["truth"] = truth_json(*report.laws);
    json["methods"] = methods_json(*report.laws);
  }
  json["certificate"] = scope_json(why_no_bound(report.scenario));
  json["particles"] = kPredictionFile;
  return json_text(json);
}

}  // namespace qsmpc::harness

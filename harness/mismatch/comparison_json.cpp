#include "harness/mismatch/comparison_json.hpp"

#include <cstddef>

#include "harness/scenario/certificate_scope.hpp"
#include "harness/text/json_text.hpp"
#include "harness/trace/json_values.hpp"

namespace qsmpc::harness {
namespace {

using Json = nlohmann::ordered_json;

double rate_of(std::int64_t events, std::int64_t trials) {
  return static_cast<double>(events) / static_cast<double>(trials);
}

Json states_json(const models::SystemDescription& system) {
  Json states = Json::array();
  for (const models::Coordinate& state : system.states) {
    states.push_back({{"name", state.name}, {"unit", state.unit}});
  }
  return states;
}

Json one_step_json(const ResidualStatistics& statistics) {
  const Whiteness& whiteness = statistics.whiteness;
  return {{"rmse", vector_json(statistics.rmse)},
          {"mean", vector_json(statistics.mean)},
          {"covariance", rows_json(statistics.covariance)},
          {"periods", statistics.periods},
          {"mean_deviation", vector_json(statistics.mean_deviation)},
          {"rounding", vector_json(statistics.rounding)},
          {"whiteness",
           {{"lags", whiteness.lags},
            {"lag1", vector_json(whiteness.lag1)},
            {"lag1_deviation", whiteness.lag1_deviation},
            {"ljung_box", vector_json(whiteness.ljung_box)},
            {"p_value", vector_json(whiteness.p_value)}}}};
}

Json horizon_json(const Comparison& comparison, const PlantComparison& plant) {
  Json stages = Json::array();
  for (const HorizonStage& stage : plant.horizon) {
    const W2Floor& floor = comparison.floors[static_cast<std::size_t>(stage.stage)];
    stages.push_back({{"stage", stage.stage},
                      {"divergence_rmse", vector_json(stage.divergence_rmse)},
                      {"w2_to_model", stage.w2_to_model()},
                      {"w2", stage.w2},
                      {"w2_floor", floor.mean},
                      {"w2_floor_deviation", floor.deviation},
                      {"residual_rmse", vector_json(stage.residual_rmse)}});
  }
  return stages;
}

Json closed_loop_json(const PlantComparison& plant) {
  const ClosedLoop& loop = plant.closed_loop;
  return {{"cost", loop.cost},
          {"cost_deviation", loop.cost_deviation},
          {"min_clearance", loop.min_clearance},
          {"unsafe_rate", rate_of(loop.unsafe, loop.episodes)},
          {"unsafe_interval", interval_json(loop.unsafe_limits)},
          {"outcomes", loop.outcomes},
          {"certificate_exceeded", plant.exceeded_stages.size()},
          {"next_step",
           {{"periods", loop.periods},
            {"unsafe", loop.unsafe_periods},
            {"certified", loop.certified_periods},
            {"p_value", loop.p_value}}}};
}

Json certificate_json(const Comparison& comparison, const PlantComparison& plant) {
  Json stages = Json::array();
  for (std::size_t k = 0; k < plant.horizon.size(); ++k) {
    const HorizonStage& stage = plant.horizon[k];
    Json json{{"stage", stage.stage},
              {"without", comparison.certificates[k].value},
              {"with", nullptr},
              {"observed", rate_of(stage.unsafe, comparison.paths)},
              {"lower", stage.unsafe_limits.lower},
              {"upper", stage.unsafe_limits.upper}};
    if (comparison.with_error) json["with"] = (*comparison.with_error)[k].value;
    stages.push_back(std::move(json));
  }
  return {{"stages", stages}, {"exceeded_stages", plant.exceeded_stages}};
}

Json plant_json(const Comparison& comparison, const PlantComparison& plant) {
  return {{"episodes", plant.closed_loop.episodes},
          {"one_step", one_step_json(plant.one_step)},
          {"horizon", horizon_json(comparison, plant)},
          {"closed_loop", closed_loop_json(plant)},
          {"ensemble",
           {{"paths", comparison.paths},
            {"w2_paths", comparison.w2_paths},
            {"faults", plant.paths.faults}}},
          {"certificate", certificate_json(comparison, plant)},
          {"speed", {{"times_real_time", plant.speed}}}};
}

Json error_json(const Comparison& comparison) {
  const controller::ModelError& error = *comparison.measured_error;
  Json first = Json::array();
  for (const controller::ModelError& own : error.first) {
    first.push_back({{"offset", vector_json(own.offset)},
                     {"rms", vector_json(own.root_mean_square)},
                     {"norm4", vector_json(own.higher[0])},
                     {"norm8", vector_json(own.higher[1])},
                     {"radius", own.radius()}});
  }
  return {{"plant", comparison.error_plant},
          {"rms", vector_json(error.root_mean_square)},
          {"norm4", vector_json(error.higher[0])},
          {"norm8", vector_json(error.higher[1])},
          {"radius", error.radius()},
          {"mean", vector_json(error.mean)},
          {"covariance", rows_json(error.covariance)},
          {"first", std::move(first)}};
}

}  // namespace

std::string comparison_json(const Comparison& comparison) {
  Json json;
  json["scenario"] = comparison.scenario.name;
  json["seed"] = comparison.scenario.seed;
  json["version"] = comparison.version;
  json["states"] = states_json(comparison.system);
  json["plants"] = Json::object();
  for (const PlantComparison& plant : comparison.plants) {
    json["plants"][plant.name] = plant_json(comparison, plant);
  }
  json["certificate"] = scope_json(why_no_bound(comparison.scenario));
  json["certificate"]["along_plan"] = {{"holds", true}};  // the policy observes the state there
  if (comparison.measured_error) json["model_error"] = error_json(comparison);
  return json_text(json);
}

}  // namespace qsmpc::harness

#include <optional>

#include <nlohmann/json.hpp>

#include "harness/reproduction/results_table.hpp"
#include "harness/text/json_text.hpp"

namespace qsmpc::harness {
namespace {

using Json = nlohmann::ordered_json;

Json number_json(std::optional<double> value) { return value ? Json(*value) : Json(nullptr); }

Json place_json(const std::optional<TablePlace>& place) {
  if (!place) return nullptr;
  return {{"table", place->table}, {"row", place->row}, {"column", place->column}};
}

Json row_json(const std::string& experiment, const ResultRow& row) {
  return {{"experiment", experiment},
          {"quantity", row.quantity},
          {"unit", row.unit},
          {"published", number_json(row.published)},
          {"here", row.here},  // null if not finite
          {"ratio", number_json(ratio_of(row))},
          {"note", row.note},
          {"place", place_json(row.place)}};
}

}  // namespace

std::string results_json(const Reproduction& reproduction) {
  Json json{{"version", reproduction.version},
            {"machine",
             {{"processor", reproduction.machine.processor},
              {"cores", reproduction.machine.cores},
              {"compiler", reproduction.machine.compiler}}},
            {"seeds", reproduction.seeds},
            {"threads", reproduction.threads},
            {"complete", reproduction.complete},
            {"seconds", reproduction.seconds},
            {"rows", Json::array()},
            {"claims", Json::array()},
            {"experiments", Json::array()}};
  for (const ExperimentResult& experiment : reproduction.experiments) {
    for (const ResultRow& row : experiment.rows) {
      json["rows"].push_back(row_json(experiment.name, row));
    }
    for (const Claim& claim : experiment.claims) {
      json["claims"].push_back({{"experiment", experiment.name},
                                {"statement", claim.statement},
                                {"holds", claim.holds},
                                {"evidence", claim.evidence}});
    }
    Json figures = Json::array();
    for (const ResultFigure& figure : experiment.figures) figures.push_back(figure.file);
    json["experiments"].push_back({{"name", experiment.name},
                                   {"title", experiment.title},
                                   {"seconds", experiment.seconds},
                                   {"remarks", experiment.remarks},
                                   {"figures", figures}});
  }
  return json_text(json);
}

}  // namespace qsmpc::harness

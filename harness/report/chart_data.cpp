#include "harness/report/chart_data.hpp"

#include "harness/report/packed_numbers.hpp"

namespace qsmpc::harness {
namespace {

using Json = nlohmann::ordered_json;

const char* mark_name(Mark mark) {
  switch (mark) {
    case Mark::kLine:
      return "line";
    case Mark::kSteps:
      return "steps";
    case Mark::kPoints:
    case Mark::kJoined:
    case Mark::kLimits:
      break;
  }
  return "points";
}

}  // namespace

const char* scale_name(Scale scale) { return scale == Scale::kLog ? "log" : "linear"; }

nlohmann::ordered_json chart_data(const Chart& chart) {
  Json json = {{"xLabel", chart.x_label},
               {"yLabel", chart.y_label},
               {"xScale", scale_name(chart.x_scale)},
               {"yScale", scale_name(chart.y_scale)},
               {"leastX", chart.least_x},
               {"leastY", chart.least_shown},
               {"xIncludes", chart.x_includes},
               {"yIncludes", chart.y_includes},
               {"series", Json::array()},
               {"rules", Json::array()}};
  for (const Series& series : chart.series) {
    json["series"].push_back({{"name", series.name},
                              {"colour", series.colour},
                              {"mark", mark_name(series.mark)},
                              {"dashed", series.dashed},
                              {"x", packed_floats(series.x)},
                              {"y", packed_floats(series.y)}});
  }
  for (const Rule& rule : chart.rules) {
    json["rules"].push_back({{"name", rule.name}, {"value", rule.value}});
  }
  return json;
}

}  // namespace qsmpc::harness

// A chart as data for the page's scripts, which redraw it with a cursor and zoom.
#pragma once

#include <nlohmann/json.hpp>

#include "harness/figures/svg_chart.hpp"

namespace qsmpc::harness {

/// Everything of `chart` that web/charts.js draws. Its numbers are packed (packed_numbers.hpp).
[[nodiscard]] nlohmann::ordered_json chart_data(const Chart& chart);

/// The name of `scale` in web/charts.js.
[[nodiscard]] const char* scale_name(Scale scale);

}  // namespace qsmpc::harness

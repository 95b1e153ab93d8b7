// The legend of a chart or a map.
#pragma once

#include <string>
#include <vector>

namespace qsmpc::harness {

inline constexpr double kSwatchWidth = 28.0;
inline constexpr double kSwatchHeight = 12.0;

struct LegendEntry {
  std::string drawing;  ///< SVG elements in a box of kSwatchWidth x kSwatchHeight units
  std::string name;     ///< not escaped

  bool operator==(const LegendEntry&) const = default;
};

/// Entries with a stroke across the whole box, with a dot in its middle, and with a filled
/// rectangle, in the style of `classes`.
[[nodiscard]] LegendEntry line_entry(const std::string& classes, const std::string& name);
[[nodiscard]] LegendEntry dot_entry(const std::string& classes, const std::string& name);
[[nodiscard]] LegendEntry area_entry(const std::string& classes, const std::string& name);

/// A <ul>. Names are escaped.
[[nodiscard]] std::string legend_html(const std::vector<LegendEntry>& entries);

}  // namespace qsmpc::harness

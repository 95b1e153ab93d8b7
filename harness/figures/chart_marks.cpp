#include "harness/figures/chart_marks.hpp"

#include <vector>

#include <fmt/format.h>

#include "harness/figures/palette.hpp"

namespace qsmpc::harness {
namespace {

struct Corner {
  double x;
  double y;
};

/// The strokes of a marker centred at (0, 0), each through its corners; all markers appear about
/// equally large.
std::vector<std::vector<Corner>> strokes_of(int marker) {
  switch (marker) {
    case kOrange:
      return {{{-3, -3}, {3, -3}, {3, 3}, {-3, 3}, {-3, -3}}};
    case kGreen:
      return {{{0, -4.2}, {4, 2.8}, {-4, 2.8}, {0, -4.2}}};
    case kPurple:
      return {{{0, -4.4}, {4.4, 0}, {0, 4.4}, {-4.4, 0}, {0, -4.4}}};
    case kVermilion:
      return {{{-3.4, -3.4}, {3.4, 3.4}}, {{3.4, -3.4}, {-3.4, 3.4}}};
    case kPaletteSize:
      return {{{0, 4.2}, {4, -2.8}, {-4, -2.8}, {0, 4.2}}};
    case kPaletteSize + 1:
      return {{{-3.4, -3.4}, {3.4, -3.4}, {-3.4, 3.4}, {3.4, 3.4}, {-3.4, -3.4}}};
    default:
      return {{{-4.2, 0}, {4.2, 0}}, {{0, -4.2}, {0, 4.2}}};
  }
}

}  // namespace

std::string mark_data(int marker, double x, double y) {
  if (marker == kBlue) return fmt::format("M{:.1f} {:.1f}h0", x, y);  // as wide as the stroke
  std::string data;
  for (const std::vector<Corner>& stroke : strokes_of(marker)) {
    char command = 'M';
    for (const Corner& corner : stroke) {
      data += fmt::format("{}{:.1f} {:.1f}", command, x + corner.x, y + corner.y);
      command = 'L';
    }
  }
  return data;
}

std::string mark_classes(int colour, int marker) {
  return fmt::format("{} c{}", marker == kBlue ? "points" : "line", colour);
}

}  // namespace qsmpc::harness

#include "render/picture_layout.hpp"

#include <algorithm>
#include <stdexcept>

namespace qsmpc::render {
namespace {

constexpr int kLeastPane = 32;         // pixels
constexpr int kSeparator = 2;          // pixels between panes
constexpr double kMostOfBands = 0.45;  // of the height
constexpr double kMostColumn = 0.32;   // of the width
constexpr double kMostLegend = 0.14;   // of the height, below a single pane
constexpr double kMostLine = 0.25;     // of the height

std::vector<CameraKind> cameras_of(const std::string& camera) {
  if (camera == "split") {
    return {CameraKind::kChase, CameraKind::kTop};
  }
  return {camera_kind(camera)};
}

// Length of each of `count` equal parts of `length` pixels.
int part(int length, std::size_t count) {
  return (length - static_cast<int>(count - 1) * kSeparator) / static_cast<int>(count);
}

PictureLayout single_pane(int width, int height, CameraKind camera, const BandSizes& sizes) {
  PictureLayout layout;
  const auto wide = static_cast<double>(width);
  if (sizes.column > kMostColumn * width) {
    const int line = static_cast<int>(std::min(sizes.line, kMostLine * height));
    layout.place = HudPlace::kLine;
    layout.panes.push_back({0, camera, 0, line, width, height - line});
    layout.bands.push_back({0.0, 0.0, wide, static_cast<double>(line)});
    return layout;
  }
  const int column = static_cast<int>(sizes.column);
  const int legend = static_cast<int>(std::min(sizes.legend, kMostLegend * height));
  layout.place = HudPlace::kColumn;
  layout.panes.push_back({0, camera, column, 0, width - column, height - legend});
  layout.bands.push_back({0.0, 0.0, static_cast<double>(column), static_cast<double>(height)});
  layout.legend = {static_cast<double>(column), static_cast<double>(height - legend),
                   static_cast<double>(width - column), static_cast<double>(legend)};
  return layout;
}

}  // namespace

PictureLayout picture_layout(int width, int height, const std::string& camera, std::size_t episodes,
                             const BandSizes& sizes) {
  const std::vector<CameraKind> cameras = cameras_of(camera);
  const bool portrait = height > width;
  PictureLayout layout;
  if (episodes == 1 && cameras.size() == 1 && !portrait) {
    return single_pane(width, height, cameras[0], sizes);
  }
  const bool in_columns = episodes == 1 && !portrait;  // the cameras of an episode
  const double wanted = sizes.charts + sizes.legend;
  const double scale = std::min(1.0, kMostOfBands * height / wanted);
  const int legend = static_cast<int>(scale * sizes.legend);
  const int band = static_cast<int>(scale * sizes.charts);
  const int room = height - band - legend;
  const int column = part(width, episodes);
  const int pane_width = in_columns ? part(column, cameras.size()) : column;
  const int pane_height = in_columns ? room : part(room, cameras.size());
  if (pane_width < kLeastPane || pane_height < kLeastPane) {
    throw std::invalid_argument("picture of " + std::to_string(width) + "x" +
                                std::to_string(height) + " pixels: too small to be divided");
  }
  for (std::size_t episode = 0; episode < episodes; ++episode) {
    const int left = static_cast<int>(episode) * (column + kSeparator);
    for (std::size_t i = 0; i < cameras.size(); ++i) {
      const int index = static_cast<int>(i);
      layout.panes.push_back(
          {episode, cameras[i], left + (in_columns ? index * (pane_width + kSeparator) : 0),
           in_columns ? 0 : index * (pane_height + kSeparator), pane_width, pane_height});
    }
    layout.bands.push_back({static_cast<double>(left), static_cast<double>(room),
                            static_cast<double>(column), static_cast<double>(band)});
  }
  layout.legend = {0.0, static_cast<double>(height - legend), static_cast<double>(width),
                   static_cast<double>(legend)};
  return layout;
}

}  // namespace qsmpc::render

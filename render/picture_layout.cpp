#include "render/picture_layout.hpp"

#include <algorithm>
#include <stdexcept>

namespace qsmpc::render {
namespace {

constexpr int kLeastPane = 32;         // pixels
constexpr int kSeparator = 2;          // pixels between panes
constexpr double kMostOfBands = 0.45;  // of the height

std::vector<CameraKind> cameras_of(const std::string& camera) {
  if (camera == "split") {
    return {CameraKind::kChase, CameraKind::kTop};
  }
  return {camera_kind(camera)};
}

// The part `index` of `count` of `length` pixels, all of the same size.
int part(int length, std::size_t count) {
  return (length - static_cast<int>(count - 1) * kSeparator) / static_cast<int>(count);
}

}  // namespace

PictureLayout picture_layout(int width, int height, const std::string& camera, std::size_t episodes,
                             const BandHeights& heights) {
  const std::vector<CameraKind> cameras = cameras_of(camera);
  const bool portrait = height > width;
  PictureLayout layout;
  if (episodes == 1 && cameras.size() == 1 && !portrait) {
    layout.panes.push_back({0, cameras[0], 0, 0, width, height});
    return layout;
  }
  const bool in_columns = episodes == 1 && !portrait;  // the cameras of an episode
  const double wanted = heights.charts + heights.legend;
  const double scale = std::min(1.0, kMostOfBands * height / wanted);
  const int legend = static_cast<int>(scale * heights.legend);
  const int band = static_cast<int>(scale * heights.charts);
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

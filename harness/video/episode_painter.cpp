#include "harness/video/episode_painter.hpp"

#include <algorithm>
#include <stdexcept>

namespace qsmpc::harness {
namespace {

constexpr double kPlansInView = 1.9;  // distance of the chase camera, in lengths of the longest
                                      // plan

const EpisodeView& drawable(const EpisodeView& view) {
  const std::string reason = why_not_drawn(view);
  if (!reason.empty()) throw std::runtime_error("no video: " + reason);
  return view;
}

}  // namespace

std::string why_not_drawn(const EpisodeView& view) {
  const models::SystemDescription& system = view.system();
  if ((system.position_x < 0 || system.position_y < 0) && !is_on_rail(system)) {
    return system.name + " has no position in the plane or along a line";
  }
  return drawn_vehicle(view).empty() ? "the scenario names no vehicle (plant.mjcf)" : "";
}

EpisodePictures::EpisodePictures(const EpisodeView& view, const VideoLayout& layout,
                                 const EpisodeView* beside)
    : layout_(layout), frames_(drawable(view), layout.overlays) {
  if (beside == nullptr) return;
  beside_.emplace(drawable(*beside), layout.overlays);
  const ChartRanges ranges = united(frames_.ranges(), beside_->ranges());
  frames_.set_ranges(ranges);
  beside_->set_ranges(ranges);
}

double EpisodePictures::duration() const {
  return std::max(frames_.duration(), beside_ ? beside_->duration() : 0.0);
}

std::vector<render::Frame> EpisodePictures::at(double time) const {
  std::vector<render::Frame> frames{frames_.at(time)};
  if (beside_) frames.push_back(beside_->at(time));
  return frames;
}

render::PictureOptions EpisodePictures::options() const {
  return {.width = layout_.width, .height = layout_.height, .camera = layout_.camera};
}

std::vector<render::EpisodeScene> EpisodePictures::scenes() const {
  const auto scene = [this](const EpisodeFrames& frames) {
    return render::EpisodeScene{.world = frames.world(),
                                .mjcf_path = frames.vehicle(),
                                .chase_distance = kPlansInView * frames.longest_plan(),
                                .region = frames.region(),
                                .raised = frames.on_rail(),
                                .heading = beside_ ? frames.heading() : ""};
  };
  std::vector<render::EpisodeScene> scenes{scene(frames_)};
  if (beside_) scenes.push_back(scene(*beside_));
  return scenes;
}

EpisodePainter::EpisodePainter(const EpisodePictures& pictures)
    : pictures_(pictures), renderer_(pictures.options(), pictures.scenes()) {}

void EpisodePainter::draw(double time, render::Image& out) {
  renderer_.draw(pictures_.at(time), out);
}

}  // namespace qsmpc::harness

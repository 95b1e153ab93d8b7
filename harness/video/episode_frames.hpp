// What an episode's pictures show, from its trace alone.
#pragma once

#include <memory>

#include "harness/trace/trace.hpp"
#include "harness/video/episode_track.hpp"
#include "models/dynamics/dynamics.hpp"
#include "render/frame.hpp"

namespace qsmpc {

/// Frames of one trace; const functions may be called from several threads at once.
class EpisodeFrames {
 public:
  /// `trace` must outlive it. Throws std::invalid_argument when the trace's system is unknown.
  explicit EpisodeFrames(const Trace& trace);

  /// s, from the start to the end of the last control period.
  [[nodiscard]] double duration() const { return track_.duration(); }

  /// Bounds, obstacles and target of the scenario, as far as they lie in the plane of position.
  [[nodiscard]] World world() const;

  /// The smallest rectangle about the world and the whole way driven.
  [[nodiscard]] PlanarRectangle region() const;

  /// m, the longest plan of the episode: how far a camera must see.
  [[nodiscard]] double longest_plan() const;

  /// The frame at `time` (s); from `duration()` on with a banner that tells the outcome. Plan,
  /// particles and certificate are those of the control period that `time` is in.
  [[nodiscard]] Frame at(double time) const;

 private:
  [[nodiscard]] std::size_t step_at(double time) const;
  void add_plan(const StepRecord& step, Frame& frame) const;
  [[nodiscard]] std::vector<HudRow> rows(const StepRecord& step, double time) const;
  [[nodiscard]] std::vector<StripChart> charts(std::size_t step) const;

  const Trace& trace_;
  std::unique_ptr<const Dynamics> dynamics_;
  EpisodeTrack track_;
  double least_certificate_;
};

}  // namespace qsmpc

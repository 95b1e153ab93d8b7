// A trace and the quantities derived from it, as Python holds it.
#pragma once

#include <memory>
#include <string>
#include <utility>

#include <nanobind/nanobind.h>

#include "harness/trace/episode_view.hpp"
#include "harness/trace/trace.hpp"

namespace qsmpc::python {

class Episode {
 public:
  explicit Episode(harness::Trace trace)
      : trace_(std::make_unique<const harness::Trace>(std::move(trace))), view_(*trace_) {}

  [[nodiscard]] const harness::Trace& trace() const { return *trace_; }
  [[nodiscard]] const harness::EpisodeView& view() const { return view_; }

 private:
  std::unique_ptr<const harness::Trace> trace_;
  harness::EpisodeView view_;
};

/// Adds the array members of an episode to its class.
void add_episode_arrays(nanobind::class_<Episode>& type);

}  // namespace qsmpc::python

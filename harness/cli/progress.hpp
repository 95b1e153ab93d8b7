// Progress of long work on standard error: a bar that redraws itself on a terminal, plain lines
// elsewhere.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace qsmpc::harness {

class Progress {
 public:
  /// label: the activity, e.g. "driving". quiet: print nothing.
  Progress(std::string label, bool quiet);
  /// Ends the bar's line.
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Reports `done` of `total` (> 0), with a note on the current state. Cheap to call often: it
  /// redraws the bar at most ten times a second, or prints a plain line at every tenth of the work.
  void update(std::int64_t done, std::int64_t total, const std::string& note = {});

 private:
  void draw_bar(std::int64_t done, std::int64_t total, const std::string& note);

  using Clock = std::chrono::steady_clock;
  std::string label_;
  bool quiet_;
  bool terminal_;
  bool drawn_ = false;
  int tenths_ = 0;
  Clock::time_point last_{};
};

}  // namespace qsmpc::harness

// How far long work is: a bar that redraws itself on a terminal, plain lines elsewhere, both on
// standard error.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace qsmpc::harness {

class Progress {
 public:
  /// label: what is being done, e.g. "driving". quiet: say nothing.
  Progress(std::string label, bool quiet);
  /// Ends the bar's line.
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// `done` of `total` (> 0), with a word on the present state. Cheap to call often: it draws at
  /// most ten times a second, and a plain line at every tenth of the work.
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

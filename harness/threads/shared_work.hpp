// Progress and cancellation of work that several threads share.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <utility>

namespace qsmpc::harness {

class SharedWork {
 public:
  using Progress = std::function<void(std::int64_t, std::int64_t, const std::string&)>;

  /// total: units of work. should_stop: called by several threads. on_progress: called with units
  /// done, total and the current activity, by one thread at a time. Either function may be empty.
  SharedWork(std::int64_t total, std::function<bool()> should_stop, Progress on_progress)
      : total_(total), should_stop_(std::move(should_stop)), on_progress_(std::move(on_progress)) {}

  /// Sets the activity reported from now on.
  void begin(std::string what) {
    const std::lock_guard lock(mutex_);
    what_ = std::move(what);
  }

  /// Reports one unit as done.
  void advance() {
    const std::lock_guard lock(mutex_);
    ++done_;
    if (on_progress_) on_progress_(done_, total_, what_);
  }

  /// Whether the work is to be abandoned; once true, it stays true.
  [[nodiscard]] bool stopped() {
    if (!stopped_ && should_stop_ && should_stop_()) stopped_ = true;
    return stopped_;
  }

 private:
  std::int64_t total_;
  std::function<bool()> should_stop_;
  Progress on_progress_;
  std::mutex mutex_;
  std::int64_t done_ = 0;
  std::string what_;
  std::atomic<bool> stopped_ = false;
};

}  // namespace qsmpc::harness

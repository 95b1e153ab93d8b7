#include "harness/episode/driver_pool.hpp"

#include <algorithm>
#include <optional>

namespace qsmpc::harness {

Trace DriverPool::run(const Scenario& scenario, const EpisodeOptions& options) {
  EpisodeDriver driver = take(scenario);
  Trace trace = driver.run(options);  // a driver that throws is not put back
  put_back(scenario, std::move(driver));
  return trace;
}

EpisodeDriver DriverPool::take(const Scenario& scenario) {
  {
    const std::lock_guard lock(mutex_);
    const auto known =
        std::ranges::find(resting_, &scenario, [](const auto& e) { return e.first; });
    if (known != resting_.end()) {
      EpisodeDriver driver = std::move(known->second);
      resting_.erase(known);
      return driver;
    }
  }
  return EpisodeDriver(scenario);
}

void DriverPool::put_back(const Scenario& scenario, EpisodeDriver driver) {
  std::optional<EpisodeDriver> longest;  // destroyed after the lock is released
  const std::lock_guard lock(mutex_);
  resting_.emplace_back(&scenario, std::move(driver));
  if (resting_.size() <= limit_) return;
  longest = std::move(resting_.front().second);
  resting_.pop_front();
}

}  // namespace qsmpc::harness

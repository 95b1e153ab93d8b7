// Plants that are used again: making one may mean to read and compile a MuJoCo model.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "harness/errors.hpp"
#include "harness/plant/plant.hpp"

namespace qsmpc::harness {

/// Lends plants to threads: as many are made as are out at the same time at most, or, where every
/// path has a vehicle of its own, one for each. They are to be reset by who takes them.
class PlantPool {
 public:
  /// Makes the plant of a path.
  using Maker = std::function<std::unique_ptr<Plant>(std::int64_t)>;

  /// make: called by several threads. A first plant is made at once, so that what is wrong with it
  /// is thrown here, but where paths differ in their plants (differ): one of them says nothing of
  /// the others.
  explicit PlantPool(Maker make, bool differ = false) : make_(std::move(make)), differ_(differ) {
    if (!differ_) idle_.push_back(make_(0));
  }

  /// The plant of path `path`; nullptr where paths differ and the simulator refuses this one.
  [[nodiscard]] std::unique_ptr<Plant> take(std::int64_t path) {
    if (!differ_) {
      const std::lock_guard lock(mutex_);
      if (!idle_.empty()) {
        std::unique_ptr<Plant> plant = std::move(idle_.back());
        idle_.pop_back();
        return plant;
      }
    }
    try {
      return make_(path);
    } catch (const SimulatorError&) {
      if (!differ_) throw;
      return nullptr;
    }
  }

  void give_back(std::unique_ptr<Plant> plant) {
    if (differ_) return;
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(plant));
  }

 private:
  Maker make_;
  bool differ_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<Plant>> idle_;
};

}  // namespace qsmpc::harness

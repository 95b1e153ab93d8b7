// Plants that are used again: making one may mean to read and compile a MuJoCo model.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "harness/plant/plant.hpp"

namespace qsmpc {

/// Lends plants to threads: as many are made as are out at the same time at most. They are to be
/// reset by who takes them.
class PlantPool {
 public:
  /// make: called by several threads. A first plant is made at once, so that what is wrong with it
  /// is thrown here.
  explicit PlantPool(std::function<std::unique_ptr<Plant>()> make) : make_(std::move(make)) {
    idle_.push_back(make_());
  }

  [[nodiscard]] std::unique_ptr<Plant> take() {
    {
      const std::lock_guard lock(mutex_);
      if (!idle_.empty()) {
        std::unique_ptr<Plant> plant = std::move(idle_.back());
        idle_.pop_back();
        return plant;
      }
    }
    return make_();
  }

  void give_back(std::unique_ptr<Plant> plant) {
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(plant));
  }

 private:
  std::function<std::unique_ptr<Plant>()> make_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<Plant>> idle_;
};

}  // namespace qsmpc

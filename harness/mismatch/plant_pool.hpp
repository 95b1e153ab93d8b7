// A pool of reusable plants: making one may require reading and compiling a MuJoCo model.
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

/// Lends plants to threads. It makes as many as are lent at the same time or, if every path has its
/// own vehicle, one per path. The borrower must reset them.
class PlantPool {
 public:
  /// Makes the plant of a path.
  using Maker = std::function<std::unique_ptr<Plant>(std::int64_t)>;

  /// make: called by several threads. A first plant is made immediately, so that its errors are
  /// thrown here, unless plants differ between paths (differ): one of them then says nothing about
  /// the others.
  explicit PlantPool(Maker make, bool differ = false) : make_(std::move(make)), differ_(differ) {
    if (!differ_) idle_.push_back(make_(0));
  }

  /// The plant of path `path`; nullptr where paths differ and the simulator rejects this one.
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

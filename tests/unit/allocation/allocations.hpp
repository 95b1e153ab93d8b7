// Counts what the program takes from the heap.
#pragma once

#include <cstddef>

namespace qsmpc::testing {

/// While it lives, counts allocations of every thread; one at a time.
class AllocationCount {
 public:
  AllocationCount();
  ~AllocationCount();
  AllocationCount(const AllocationCount&) = delete;
  AllocationCount& operator=(const AllocationCount&) = delete;
  AllocationCount(AllocationCount&&) = delete;
  AllocationCount& operator=(AllocationCount&&) = delete;

  [[nodiscard]] std::size_t count() const;
};

}  // namespace qsmpc::testing

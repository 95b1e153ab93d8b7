// Counts heap allocations of the program.
#pragma once

#include <cstddef>

namespace qsmpc::testing {

/// While alive, counts the allocations of every thread; one instance at a time.
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

// Runs vector loops on each instruction set that the processor has, instead of the best alone.
#pragma once

#include <cstdint>
#include <vector>

#include <hwy/targets.h>

namespace qsmpc::testing {

/// While it lives, loops that are chosen at run time are those of one instruction set.
class OnTarget {
 public:
  explicit OnTarget(std::int64_t target) { hwy::GetChosenTarget().Update(target); }
  OnTarget(const OnTarget&) = delete;
  OnTarget& operator=(const OnTarget&) = delete;
  OnTarget(OnTarget&&) = delete;
  OnTarget& operator=(OnTarget&&) = delete;
  /// The next call chooses the best again.
  ~OnTarget() { hwy::GetChosenTarget().DeInit(); }
};

/// The instruction sets that loops are compiled for and this processor has, the best first. More
/// than one on any processor newer than the least that the build is for.
inline std::vector<std::int64_t> vector_targets() { return hwy::SupportedAndGeneratedTargets(); }

}  // namespace qsmpc::testing

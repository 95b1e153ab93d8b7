// Runs vector loops on each instruction set of the processor instead of only the best one.
#pragma once

#include <cstdint>
#include <vector>

#include <hwy/targets.h>

namespace qsmpc::testing {

/// During its lifetime, loops dispatched at run time use this one instruction set.
class OnTarget {
 public:
  explicit OnTarget(std::int64_t target) { hwy::GetChosenTarget().Update(target); }
  OnTarget(const OnTarget&) = delete;
  OnTarget& operator=(const OnTarget&) = delete;
  OnTarget(OnTarget&&) = delete;
  OnTarget& operator=(OnTarget&&) = delete;
  /// Restores the choice of the best instruction set.
  ~OnTarget() { hwy::GetChosenTarget().DeInit(); }
};

/// The instruction sets that loops are compiled for and this processor has, best first. More than
/// one on any processor newer than the build's baseline.
inline std::vector<std::int64_t> vector_targets() { return hwy::SupportedAndGeneratedTargets(); }

}  // namespace qsmpc::testing

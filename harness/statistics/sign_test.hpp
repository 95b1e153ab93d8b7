// The sign test: whether one side of paired observations is ahead more often than by chance.
#pragma once

#include <cstdint>

namespace qsmpc::harness {

/// The exact two-sided p-value of `higher` pairs of one sign and `lower` of the other, under the
/// null hypothesis that both signs are equally probable in independent pairs; 1 without pairs. For
/// binary outcomes this is McNemar's test. Throws std::invalid_argument on negative counts.
[[nodiscard]] double sign_test_p_value(std::int64_t higher, std::int64_t lower);

}  // namespace qsmpc::harness

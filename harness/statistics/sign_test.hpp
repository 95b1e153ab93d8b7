// Whether one side of pairs is ahead more often than by chance.
#pragma once

#include <cstdint>

namespace qsmpc::harness {

/// The exact two-sided p-value of `higher` pairs of one sign and `lower` of the other, against
/// either sign being equally probable in independent pairs; 1 without a pair. With pairs of yes and
/// no it is McNemar's test. Throws std::invalid_argument on negative numbers.
[[nodiscard]] double sign_test_p_value(std::int64_t higher, std::int64_t lower);

}  // namespace qsmpc::harness

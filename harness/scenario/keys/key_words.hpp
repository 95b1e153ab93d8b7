// The descriptions of keys in words.
#pragma once

#include <string>

#include "harness/scenario/keys/key_description.hpp"

namespace qsmpc::harness {

/// The range of numbers that `key` may hold, e.g. "1 to 1000" or "> 0, up to 10⁶"; empty without
/// limits.
[[nodiscard]] std::string range_words(const KeyDescription& key);

/// The words of `key` with its range, names and maximum length filled in.
[[nodiscard]] std::string filled_words(const KeyDescription& key);

}  // namespace qsmpc::harness

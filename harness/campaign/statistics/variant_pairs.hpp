// Which variants of a campaign are compared with each other.
#pragma once

#include <cstddef>
#include <vector>

#include "harness/campaign/store/store_reader.hpp"

namespace qsmpc::harness {

/// What a variant differs by from its baseline.
enum class DiffersBy { kSettings, kPlant };

/// "settings" or "plant".
[[nodiscard]] const char* differs_by_name(DiffersBy by);

/// A variant and what it is compared with, as indices.
struct VariantPair {
  std::size_t variant = 0;
  std::size_t baseline = 0;
  DiffersBy by = DiffersBy::kSettings;

  friend bool operator==(const VariantPair&, const VariantPair&) = default;
};

/// Of each variant: the first one with the same scenario and plant, and the first one with the same
/// scenario and settings; not where that is the variant itself.
[[nodiscard]] std::vector<VariantPair> variant_pairs(const std::vector<StoredVariant>& variants);

}  // namespace qsmpc::harness

// The pairs of a campaign's variants that are compared.
#pragma once

#include <cstddef>
#include <vector>

#include "harness/campaign/store/store_reader.hpp"

namespace qsmpc::harness {

/// In what a variant differs from its baseline.
enum class DiffersBy { kSettings, kPlant };

/// "settings" or "plant".
[[nodiscard]] const char* differs_by_name(DiffersBy by);

/// The indices of a variant and its baseline.
struct VariantPair {
  std::size_t variant = 0;
  std::size_t baseline = 0;
  DiffersBy by = DiffersBy::kSettings;

  friend bool operator==(const VariantPair&, const VariantPair&) = default;
};

/// The baselines of each variant: the first variant with the same scenario and plant, and the first
/// one with the same scenario and settings, except the variant itself.
[[nodiscard]] std::vector<VariantPair> variant_pairs(const std::vector<StoredVariant>& variants);

}  // namespace qsmpc::harness

#include "harness/campaign/statistics/variant_pairs.hpp"

#include <stdexcept>

namespace qsmpc::harness {
namespace {

/// The first variant with the scenario of `variant` and the same `member`.
std::size_t first_with(const std::vector<StoredVariant>& variants, std::size_t variant,
                       std::string StoredVariant::*member) {
  std::size_t first = 0;
  while (variants[first].scenario != variants[variant].scenario ||
         variants[first].*member != variants[variant].*member) {
    ++first;
  }
  return first;
}

}  // namespace

const char* differs_by_name(DiffersBy by) {
  switch (by) {
    case DiffersBy::kSettings:
      return "settings";
    case DiffersBy::kPlant:
      return "plant";
  }
  throw std::invalid_argument("difference of variants: a value that has no name");
}

std::vector<VariantPair> variant_pairs(const std::vector<StoredVariant>& variants) {
  std::vector<VariantPair> pairs;
  for (std::size_t n = 0; n < variants.size(); ++n) {
    const std::size_t settings = first_with(variants, n, &StoredVariant::plant);
    const std::size_t plant = first_with(variants, n, &StoredVariant::settings);
    if (settings != n) {
      pairs.push_back({.variant = n, .baseline = settings, .by = DiffersBy::kSettings});
    }
    if (plant != n) pairs.push_back({.variant = n, .baseline = plant, .by = DiffersBy::kPlant});
  }
  return pairs;
}

}  // namespace qsmpc::harness

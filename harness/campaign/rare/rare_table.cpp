#include "harness/campaign/rare/rare_table.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "harness/text/printable.hpp"
#include "harness/text/text_width.hpp"

namespace qsmpc::harness {
namespace {

constexpr std::size_t kRareNameWidth = 20;  // of variant names

/// At most 8 characters.
std::string rare_number(double value) {
  if (!std::isfinite(value)) return "-";
  return value == 0.0 ? "0" : fmt::format("{:.2e}", value);
}

std::string rare_limits(const RateInterval& interval) {
  return fmt::format("[{}, {}]", rare_number(interval.lower), rare_number(interval.upper));
}

std::string rare_line(const VariantStatistics& variant, const RareStatistics& rare) {
  std::string text = fmt::format(
      "{:>4} {}{:>5}{:>10}{:>22}{:>10}{:>10}{:>10}{:>8}{}\n", variant.id,
      padded(printable(variant.name, kRareNameWidth - 2), kRareNameWidth), rare.runs.size(),
      rare_number(rare.probability), rare_limits(rare.interval), rare_number(rare.certified),
      rare_number(static_cast<double>(rare.periods)), rare_number(rare.worth_periods),
      std::isfinite(rare.gain()) ? fmt::format("{:.3g}", rare.gain()) : "-",
      rare.exceeds_certified() && variant.no_bound.empty() ? " !" : "");
  if (rare.limits == RareLimits::kPlain) {
    text += fmt::format("     limits from {} plain drives, {} of them unsafe\n", rare.plain_drives,
                        rare.plain_unsafe);
  }
  if (rare.extinct + rare.below_floor > 0) {
    text += fmt::format("     estimates of 0: {} runs died out, {} ended at the floor\n",
                        rare.extinct, rare.below_floor);
  }
  return text;
}

}  // namespace

std::string rare_table(const CampaignStatistics& statistics) {
  if (std::ranges::none_of(statistics.variants,
                           [](const auto& variant) { return variant.rare.has_value(); })) {
    return {};
  }
  std::string text = fmt::format(
      "\nProbability of an unsafe drive, by splitting\n"
      "     {:<{}}{:>5}{:>10}{:>22}{:>10}{:>10}{:>10}{:>8}\n",
      "variant", kRareNameWidth, "runs", "unsafe", "99 %", "certified", "periods", "worth", "gain");
  for (const VariantStatistics& variant : statistics.variants) {
    if (variant.rare) text += rare_line(variant, *variant.rare);
  }
  return text +
         "certified: mean sum of a drive's next-step certificates; worth: plain periods of the "
         "same precision.\n";
}

}  // namespace qsmpc::harness

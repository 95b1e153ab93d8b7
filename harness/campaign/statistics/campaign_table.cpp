#include "harness/campaign/statistics/campaign_table.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>

#include "harness/campaign/rare/rare_table.hpp"
#include "harness/campaign/statistics/stop_report.hpp"
#include "harness/text/number_format.hpp"
#include "harness/text/printable.hpp"
#include "harness/text/text_width.hpp"
#include "harness/trace/ending.hpp"

namespace qsmpc::harness {
namespace {

constexpr std::size_t kNameWidth = 28;   // of variants
constexpr std::size_t kTitleLimit = 76;  // of a variant's name on a separate line
constexpr std::size_t kFullName = 100;
constexpr std::size_t kNoBoundLimit = 94;  // bytes of the reason on its line
constexpr std::size_t kOutcomeLimit = 16;
constexpr std::size_t kDoneWidth = 7;   // column of the number of drives
constexpr std::size_t kRateWidth = 14;  // column of the limits of a rate in percent
constexpr double kSurprising = 0.01;    // p-values below this are marked
constexpr std::size_t kMedian = 3;      // index in spread_shares, as are the next two
constexpr std::size_t kFifth = 1;
constexpr std::size_t kNinetyFifth = 5;

/// `text` truncated to `width` columns. The truncation mark takes one column and three bytes.
std::string cut(const std::string& text, std::size_t width) {
  return padded(printable(text, width - 2), width);  // leaves room for the mark and a gap
}

std::string head_name(const char* text) { return fmt::format("     {:<{}}", text, kNameWidth); }
/// The variant's name with its number, by which differences refer to it.
std::string name_of(const CampaignStatistics& statistics, std::size_t variant) {
  return fmt::format("{:>4} {}", statistics.variants[variant].id,
                     cut(statistics.variants[variant].name, kNameWidth));
}

/// At most 9 characters.
std::string number(double value) {
  if (!std::isfinite(value)) return "-";
  return is_plain_in_table(value) ? fmt::format("{:.4g}", value) : fmt::format("{:.2e}", value);
}

std::string probability(double value) {
  return std::isfinite(value) ? fmt::format("{:.2g}", value) : "-";
}

std::string limits_in_percent(const EpisodeRate& rate) {
  if (!std::isfinite(rate.rate)) return "";
  return fmt::format("[{}, {}]", format_percent(rate.interval.lower),
                     format_percent(rate.interval.upper));
}

std::string mean_with_error(const Spread& spread) {
  if (!std::isfinite(spread.standard_error)) return number(spread.mean);
  return fmt::format("{} +- {:.2g}", number(spread.mean), spread.standard_error);
}

std::string head(const CampaignStatistics& statistics) {
  const StoredCampaign& campaign = statistics.campaign;
  std::string text = fmt::format("{}: {} of {} episodes", printable(campaign.name, 40),
                                 statistics.done, campaign.episodes);
  if (campaign.shard.count > 1) {
    text += fmt::format(", shard {} of {}", campaign.shard.index, campaign.shard.count);
  }
  text += "\n";
  const char* before = "  ";
  for (const auto& [outcome, count] : in_order(statistics.outcomes)) {
    const double share = static_cast<double>(count) / static_cast<double>(statistics.done);
    text += fmt::format("{}{} {} ({} %)", before, count, printable(outcome, kOutcomeLimit),
                        format_percent(share));
    before = ", ";
  }
  const std::string stop = stop_sentence(statistics);
  return text + "\n" + (stop.empty() ? "" : "  " + stop + "\n");
}

/// The full names that are truncated elsewhere.
std::string long_names(const CampaignStatistics& statistics) {
  std::string text;
  for (const VariantStatistics& variant : statistics.variants) {
    if (variant.name.size() <= kNameWidth - 2) continue;
    text += fmt::format("{:>4} {}\n", variant.id, printable(variant.name, kFullName));
  }
  return text.empty() ? text : "\nVariants with long names\n" + text;
}

/// Two lines per variant: its shares and their intervals.
std::string outcome_section(const CampaignStatistics& statistics) {
  const std::vector<ListedOutcome> outcomes = outcomes_of(statistics.variants);
  std::string text =
      fmt::format("\nWhat became of the drives, in %, with {}\n{}{:>{}}",
                  interval_words(statistics), head_name("variant"), "done", kDoneWidth);
  for (const ListedOutcome& outcome : outcomes) {
    text += fmt::format("{:>{}}", outcome.title, kRateWidth);
  }
  for (std::size_t n = 0; n < statistics.variants.size(); ++n) {
    const VariantStatistics& variant = statistics.variants[n];
    text += fmt::format("\n{}{:>{}}", name_of(statistics, n), variant.done, kDoneWidth);
    std::string limits = fmt::format("\n{}{:>{}}", head_name(""), "", kDoneWidth);
    for (const ListedOutcome& outcome : outcomes) {
      const EpisodeRate& rate = variant.*outcome.rate;
      text += fmt::format("{:>{}}", format_percent(rate.rate), kRateWidth);
      limits += fmt::format("{:>{}}", limits_in_percent(rate), kRateWidth);
    }
    text += limits;
  }
  return text + "\n";
}

std::string spread_section(const CampaignStatistics& statistics) {
  std::string text = fmt::format(
      "\nCost, least clearance (m), time to target (s): mean; 5th, 50th and 95th "
      "percentiles\n{}{:>20}{:>9}{:>9}{:>10}{:>10}{:>9}{:>10}\n",
      head_name("variant"), "cost", "median", "95 %", "clear 5 %", "median", "time", "95 %");
  for (std::size_t n = 0; n < statistics.variants.size(); ++n) {
    const VariantStatistics& variant = statistics.variants[n];
    const std::vector<double>& clearance = variant.min_clearance.quantiles;
    const std::vector<double>& time = variant.time_to_target.quantiles;
    text +=
        fmt::format("{}{:>20}{:>9}{:>9}{:>10}{:>10}{:>9}{:>10}\n", name_of(statistics, n),
                    mean_with_error(variant.cost), number(variant.cost.quantiles[kMedian]),
                    number(variant.cost.quantiles[kNinetyFifth]), number(clearance[kFifth]),
                    number(clearance[kMedian]), number(time[kMedian]), number(time[kNinetyFifth]));
  }
  return text;
}

std::string certificate_section(const CampaignStatistics& statistics) {
  std::string text = fmt::format(
      "\nNext-step certificates: do they hold?\n{}{:>10}{:>9}{:>12}{:>12}{:>10}{:>16}\n",
      head_name("variant"), "periods", "unsafe", "observed", "certified", "p", "bins exceeded");
  for (std::size_t n = 0; n < statistics.variants.size(); ++n) {
    const VariantStatistics& variant = statistics.variants[n];
    const auto filled = std::ranges::count_if(
        variant.calibration, [](const CalibrationBin& bin) { return bin.periods > 0; });
    const auto exceeded = std::ranges::count_if(
        variant.calibration, [](const CalibrationBin& bin) { return bin.exceeded; });
    text += fmt::format("{}{:>10}{:>9}{:>12}{:>12}{:>10}{:>16}\n", name_of(statistics, n),
                        variant.periods, variant.unsafe_periods,
                        probability(variant.unsafe_step_rate()),
                        probability(variant.certified_step_rate()),
                        probability(variant.p_value) + (variant.p_value < kSurprising ? " !" : ""),
                        fmt::format("{} of {}{}", exceeded, filled, exceeded > 0 ? " !" : ""));
    if (!variant.no_bound.empty()) {
      text += fmt::format("     NO BOUND: {}\n", printable(variant.no_bound, kNoBoundLimit));
    }
  }
  return text;
}

std::string calibration_section(const CampaignStatistics& statistics) {
  std::string text = fmt::format(
      "\nPeriods of all variants by certified probability\n"
      "  {:<22}{:>10}{:>11}{:>9}{:>11}{:>24}{:>12}\n",
      "certified", "periods", "mean", "unsafe", "observed", "99 % (a guide)", "p");
  for (const CalibrationBin& bin : statistics.calibration) {
    if (bin.periods == 0) continue;
    text += fmt::format("  {:<22}{:>10}{:>11.2e}{:>9}{:>11.2e}{:>24}{:>12}\n",
                        fmt::format("{:.1e} ... {:.1e}", bin.lower, bin.upper), bin.periods,
                        bin.mean_certified, bin.unsafe, bin.rate,
                        fmt::format("[{:.1e}, {:.1e}]", bin.interval.lower, bin.interval.upper),
                        probability(bin.p_value) + (bin.exceeded ? " !" : ""));
  }
  return text;
}

std::string difference_text(const CampaignStatistics& statistics,
                            const VariantDifference& difference) {
  const VariantPair& pair = difference.pair;
  const VariantStatistics& variant = statistics.variants[pair.variant];
  std::string text = fmt::format("  {} minus {} (other {}): {}\n", variant.id,
                                 statistics.variants[pair.baseline].id, differs_by_name(pair.by),
                                 printable(variant.name, kTitleLimit));
  for (const MeanDifference& quantity : difference.quantities) {
    text += fmt::format("    {:<18}{:>12}{:>26}{:>10}{:>10}{:>10}{:>10}\n", quantity.quantity,
                        number(quantity.mean),
                        std::isfinite(quantity.interval.lower)
                            ? fmt::format("[{}, {}]", number(quantity.interval.lower),
                                          number(quantity.interval.upper))
                            : "-",
                        quantity.pairs, quantity.higher, quantity.lower, quantity.left_out);
  }
  return text;
}

std::string difference_section(const CampaignStatistics& statistics) {
  if (statistics.differences.empty()) return {};
  std::string text =
      fmt::format("\nDifferences, seed by seed\n    {:<18}{:>12}{:>26}{:>10}{:>10}{:>10}{:>10}\n",
                  "mean of", "difference", "99 % interval", "pairs", "higher", "lower", "left out");
  for (const VariantDifference& difference : statistics.differences) {
    text += difference_text(statistics, difference);
  }
  return text;
}

std::string time_section(const CampaignStatistics& statistics) {
  std::string text =
      fmt::format("\nPlanning and certifying (ms)\n{}{:>10}{:>10}{:>10}{:>10}{:>10}{:>18}\n",
                  head_name("variant"), "median", "p95", "p99", "max", "mean", "deadline misses");
  for (std::size_t n = 0; n < statistics.variants.size(); ++n) {
    const VariantStatistics& variant = statistics.variants[n];
    const Distribution& times = variant.ocp_ms;
    text += fmt::format("{}{:>10}{:>10}{:>10}{:>10}{:>10}{:>18}\n", name_of(statistics, n),
                        number(times.median), number(times.p95), number(times.p99),
                        number(times.max), number(times.mean), variant.deadline_misses);
  }
  return text;
}

}  // namespace

std::string campaign_table(const CampaignStatistics& statistics) {
  return head(statistics) + long_names(statistics) + outcome_section(statistics) +
         spread_section(statistics) + certificate_section(statistics) + rare_table(statistics) +
         calibration_section(statistics) + difference_section(statistics) +
         time_section(statistics) +
         "collision, left bounds: where the true state was first unsafe, even if the drive "
         "continued.\n"
         "A drive that faulted ranks worst. bins exceeded, p: of the certificates only;\n"
         "p: small if more periods end unsafe than certified; !: at most 1 in 100 by chance "
         "alone.\n";
}

}  // namespace qsmpc::harness

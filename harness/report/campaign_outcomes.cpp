#include "harness/report/campaign_outcomes.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <fmt/format.h>

#include "harness/campaign/statistics/stop_report.hpp"
#include "harness/figures/legend.hpp"
#include "harness/text/html.hpp"
#include "harness/text/number_format.hpp"
#include "harness/text/printable.hpp"

namespace qsmpc::harness {
namespace {

constexpr double kBarLength = 100.0;         // in the bar's own units
constexpr std::size_t kWorstNameLimit = 90;  // bytes of a variant's name in a sentence

/// The CSS class that fills the bar of `outcome`.
std::string fill_of(const ListedOutcome& outcome) { return "fill-" + outcome.name; }

std::int64_t total_of(const CampaignStatistics& statistics, const ListedOutcome& outcome) {
  std::int64_t total = 0;
  for (const VariantStatistics& variant : statistics.variants) {
    total += (variant.*outcome.rate).events;
  }
  return total;
}

/// "188 reached the target, 212 collided, 0 left the bounds, …"
std::string totals_text(const CampaignStatistics& statistics) {
  std::string text;
  for (const ListedOutcome& outcome : outcomes_of(statistics.variants)) {
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", total_of(statistics, outcome),
                        outcome.verb);
  }
  return text + ".";
}

/// Names the variant whose drives were unsafe most often; empty if there is nothing to compare.
std::string worst_variant_text(const CampaignStatistics& statistics) {
  const std::vector<VariantStatistics>& variants = statistics.variants;
  if (variants.size() < 2) return {};
  const auto worst = std::ranges::max_element(variants, {}, [](const VariantStatistics& variant) {
    return std::isfinite(variant.unsafe.rate) ? variant.unsafe.rate : -1.0;
  });
  if (worst->unsafe.events == 0) return {};
  return fmt::format("Most often in variant {}: {} % of its drives ({}).", worst->id,
                     format_percent(worst->unsafe.rate), printable(worst->name, kWorstNameLimit));
}

/// All drives of a variant from left to right, grouped by outcome.
std::string bar_html(const VariantStatistics& variant, const std::vector<ListedOutcome>& outcomes) {
  std::string parts;
  std::string words;
  double begin = 0.0;
  for (const ListedOutcome& outcome : outcomes) {
    const EpisodeRate& rate = variant.*outcome.rate;
    if (rate.events == 0) continue;
    const double length = kBarLength * rate.rate;
    const std::string text = fmt::format("{} {} %", outcome.title, format_percent(rate.rate));
    parts += fmt::format(
        "<rect class=\"{}\" x=\"{:.3f}\" y=\"0\" width=\"{:.3f}\" height=\"10\"><title>{}</title>"
        "</rect>",
        fill_of(outcome), begin, length, escape_html(text));
    begin += length;
    words += (words.empty() ? "" : ", ") + text;
  }
  return fmt::format(
      "<svg class=\"bar\" viewBox=\"0 0 {} 10\" preserveAspectRatio=\"none\" role=\"img\" "
      "aria-label=\"{}\">{}</svg>",
      kBarLength, escape_html(words.empty() ? "no drives yet" : words), parts);
}

/// A share in percent above its limits; in soft print if it is 0, highlighted if it is a failure.
std::string percent_html(const EpisodeRate& rate, bool is_unsafe) {
  if (!std::isfinite(rate.rate)) return "–";
  std::string share = format_percent(rate.rate) + " %";
  if (rate.events == 0) {
    share = "<span class=\"soft\">" + share + "</span>";
  } else if (is_unsafe) {
    share = "<strong class=\"alarm\">" + share + "</strong>";
  }
  return fmt::format("{}<br/><span class=\"soft\">[{}, {}]</span>", share,
                     escape_html(format_percent(rate.interval.lower)),
                     escape_html(format_percent(rate.interval.upper)));
}

bool is_unsafe(const ListedOutcome& outcome) {
  return outcome.rate == &VariantStatistics::collision ||
         outcome.rate == &VariantStatistics::left_bounds ||
         outcome.rate == &VariantStatistics::left_safe_set;
}

std::string outcome_legend(const std::vector<ListedOutcome>& outcomes) {
  std::vector<LegendEntry> entries;
  entries.reserve(outcomes.size());
  for (const ListedOutcome& outcome : outcomes) {
    entries.push_back(area_entry(fill_of(outcome), outcome.title));
  }
  return legend_html(entries);
}

}  // namespace

PageVerdict outcome_verdict(const CampaignStatistics& statistics) {
  std::int64_t done = 0;
  std::int64_t reached = 0;
  std::int64_t unsafe = 0;
  for (const VariantStatistics& variant : statistics.variants) {
    done += variant.done;
    reached += variant.reached.events;
    unsafe += variant.unsafe.events;
  }
  if (done == 0)
    return {.mood = PageMood::kOpen, .title = "No drive has finished", .sentences = {}};
  const auto share = [&](std::int64_t count) {
    return format_percent(static_cast<double>(count) / static_cast<double>(done));
  };
  PageVerdict verdict{
      .mood = unsafe > 0       ? PageMood::kBad
              : reached < done ? PageMood::kOpen
                               : PageMood::kGood,
      .title = fmt::format("{} % of {} drives reached the target safely", share(reached), done),
      .sentences = {totals_text(statistics)}};
  if (unsafe > 0) {
    verdict.title = fmt::format("{} % of {} drives were unsafe; {} % reached the target safely",
                                share(unsafe), done, share(reached));
  }
  const std::string worst = worst_variant_text(statistics);
  if (!worst.empty()) verdict.sentences.push_back(worst);
  return verdict;
}

std::string campaign_outcomes(const CampaignStatistics& statistics) {
  const std::vector<ListedOutcome> outcomes = outcomes_of(statistics.variants);
  PageTable table{.label = "What became of the drives, by variant",
                  .heads = {"variant", "drives", ""},
                  .rows = {},
                  .text_columns = {2}};
  for (const ListedOutcome& outcome : outcomes) table.heads.push_back(outcome.title);
  for (std::size_t n = 0; n < statistics.variants.size(); ++n) {
    const VariantStatistics& variant = statistics.variants[n];
    std::vector<std::string> row = {fmt::format("{}: {}", variant.id, escape_html(variant.name)),
                                    fmt::format("{}", variant.done), bar_html(variant, outcomes)};
    for (const ListedOutcome& outcome : outcomes) {
      row.push_back(percent_html(variant.*outcome.rate, is_unsafe(outcome)));
    }
    table.rows.push_back(std::move(row));
  }
  std::string note = "Shares of the drives with their " + interval_words(statistics) +
                     ", in percent. Collision and left bounds: how the true state first became "
                     "unsafe, even if the drive continued.";
  if (outcomes.size() > listed_outcomes().size()) {
    note +=
        " Left safe set: either of the two, in drives of an earlier version that did not "
        "distinguish them.";
  }
  return verdict_html(outcome_verdict(statistics)) +
         section_head("What became of the drives", note) + outcome_legend(outcomes) +
         table_html(table);
}

}  // namespace qsmpc::harness

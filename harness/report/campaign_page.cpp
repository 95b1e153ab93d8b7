#include "harness/report/campaign_page.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "harness/campaign/statistics/stop_report.hpp"
#include "harness/figures/svg_figure.hpp"
#include "harness/report/campaign_charts.hpp"
#include "harness/report/campaign_drives.hpp"
#include "harness/report/campaign_outcomes.hpp"
#include "harness/report/page_frame.hpp"
#include "harness/report/rare_section.hpp"
#include "harness/report/table_page.hpp"
#include "harness/report/tradeoff_charts.hpp"
#include "harness/text/html.hpp"

namespace qsmpc::harness {
namespace {

constexpr std::size_t kFifth = 1;   // index into spread_shares
constexpr std::size_t kMedian = 3;  // index into spread_shares
constexpr std::size_t kNinetyFifth = 5;

/// The header of a variant's row.
std::string variant_head(const CampaignStatistics& statistics, std::size_t variant) {
  return fmt::format("{}: {}", statistics.variants[variant].id,
                     escape_html(statistics.variants[variant].name));
}

std::int64_t exceeded_bins(const std::vector<CalibrationBin>& bins) {
  return std::ranges::count_if(bins, &CalibrationBin::exceeded);
}

PageVerdict certificate_verdict(const CampaignStatistics& statistics) {
  std::int64_t periods = 0;
  std::int64_t unsafe = 0;
  double certified = 0.0;
  std::int64_t exceeded = exceeded_bins(statistics.calibration);
  for (const VariantStatistics& variant : statistics.variants) {
    periods += variant.periods;
    unsafe += variant.unsafe_periods;
    certified += variant.certified_periods;
    exceeded += exceeded_bins(variant.calibration);
  }
  const char* scope =
      "This concerns the certificates only: whether periods end unsafe more often than certified, "
      "not whether the drives went well.";
  if (periods == 0) {
    return {.mood = PageMood::kOpen, .title = "Certificates: no periods yet", .sentences = {}};
  }
  const bool none_holds = none_is_bound(statistics);
  if (none_holds) scope = "None of them is a bound, so none can be exceeded.";
  return {.mood = none_holds     ? PageMood::kOpen
                  : exceeded > 0 ? PageMood::kBad
                                 : PageMood::kGood,
          .title = none_holds     ? "Certificates: not bounds here"
                   : exceeded > 0 ? "Certificates are exceeded"
                                  : "No certificate is refuted",
          .sentences = {
              fmt::format("{} of {} periods ended unsafe; their certificates add up to {} "
                          "(p = {}).",
                          unsafe, periods, number_html(certified), number_html(statistics.p_value)),
              scope}};
}

std::string kicker(const CampaignStatistics& statistics) {
  std::string text = fmt::format("{} of {} drives", statistics.done, statistics.campaign.episodes);
  const Shard& shard = statistics.campaign.shard;
  if (shard.count > 1) text += fmt::format(", shard {} of {}", shard.index, shard.count);
  std::string html = fmt::format("<p class=\"kicker\">{}, seeds {}</p>\n", text,
                                 escape_html(statistics.campaign.seeds));
  const std::string stop = stop_sentence(statistics);
  if (!stop.empty()) html += "<p class=\"note\">" + escape_html(stop) + "</p>\n";
  return html;
}

std::string spread_table(const CampaignStatistics& statistics) {
  PageTable table{.label = "Cost, clearance and time, by variant",
                  .heads = {"variant", "cost, mean", "median", "95 %", "clearance, 5 % (m)",
                            "median (m)", "time to target, median (s)", "95 % (s)"},
                  .rows = {}};
  for (std::size_t n = 0; n < statistics.variants.size(); ++n) {
    const VariantStatistics& variant = statistics.variants[n];
    std::vector<std::string> row = {variant_head(statistics, n)};
    for (const double value :
         {variant.cost.mean, variant.cost.quantiles[kMedian], variant.cost.quantiles[kNinetyFifth],
          variant.min_clearance.quantiles[kFifth], variant.min_clearance.quantiles[kMedian],
          variant.time_to_target.quantiles[kMedian],
          variant.time_to_target.quantiles[kNinetyFifth]}) {
      row.push_back(number_html(value));
    }
    table.rows.push_back(std::move(row));
  }
  return section_head(
             "Cost, clearance, time",
             "Means and percentiles. Drives that faulted rank as the worst. Times are for drives "
             "that reached the target.") +
         table_html(table);
}

std::string certificates_table(const CampaignStatistics& statistics) {
  PageTable table{.label = "Certificates of the next step, by variant",
                  .heads = {"variant", "periods", "unsafe", "observed", "certified", "believed",
                            "p", "bins exceeded", "planning, median (ms)", "99 % (ms)"},
                  .rows = {}};
  for (std::size_t n = 0; n < statistics.variants.size(); ++n) {
    const VariantStatistics& variant = statistics.variants[n];
    const std::int64_t exceeded = exceeded_bins(variant.calibration);
    const std::string certified = number_html(variant.certified_step_rate()) +
                                  (variant.no_bound.empty() ? "" : " <strong>no bound</strong>");
    table.rows.push_back({variant_head(statistics, n), fmt::format("{}", variant.periods),
                          fmt::format("{}", variant.unsafe_periods),
                          number_html(variant.unsafe_step_rate()), certified,
                          number_html(variant.believed_step_rate()), number_html(variant.p_value),
                          exceeded > 0 ? fmt::format("<strong>{}</strong>", exceeded) : "0",
                          number_html(variant.ocp_ms.median), number_html(variant.ocp_ms.p99)});
  }
  return section_head(
             "Certificates of the next step, and planning",
             "Believed: the controller's own estimate of the probability, not a bound. p is small "
             "where more periods end unsafe than certified." +
                 no_bound_words(statistics)) +
         verdict_html(certificate_verdict(statistics)) + table_html(table);
}

std::string differences_table(const CampaignStatistics& statistics) {
  if (statistics.differences.empty()) return {};
  PageTable table{.label = "Differences between variants, seed by seed",
                  .heads = {"variant − baseline"},
                  .rows = {}};
  for (const std::string& quantity : paired_quantities()) table.heads.push_back(quantity);
  for (const VariantDifference& difference : statistics.differences) {
    std::vector<std::string> row = {fmt::format("{} − {}",
                                                statistics.variants[difference.pair.variant].id,
                                                statistics.variants[difference.pair.baseline].id)};
    for (const MeanDifference& mean : difference.quantities) {
      row.push_back(number_html(mean.mean) + "<br/>" + interval_html(mean.interval));
    }
    table.rows.push_back(std::move(row));
  }
  return section_head("Differences, seed by seed",
                      std::string("Means with 99 % bootstrap intervals.") +
                          (statistics.campaign.until
                               ? " They assume a number of seeds that is fixed in advance; here it "
                                 "depends on the results, so they are only a guide."
                               : "")) +
         table_html(table);
}

/// A link to the file at `path`, relative to the page.
std::string link_html(const std::string& path, const std::string& words) {
  std::string url = ".";
  for (std::size_t begin = 0; begin <= path.size();) {
    const std::size_t end = std::min(path.find('/', begin), path.size());
    url += url_beside(path.substr(begin, end - begin)).substr(1);
    begin = end + 1;
  }
  return fmt::format("<a href=\"{}\">{}</a>", url, words);
}

/// Links to an episode's existing files, and the commands that create the rest.
std::string files_html(const ListedEpisode& episode) {
  std::string html;
  for (const auto& [path, words] :
       {std::pair{&episode.page, "page"}, std::pair{&episode.video, "video"},
        std::pair{&episode.trace, "trace"}}) {
    if (!path->empty()) html += (html.empty() ? "" : " · ") + link_html(*path, words);
  }
  for (const std::string& command : episode.commands) {
    html += (html.empty() ? "" : "<br/>") + ("<code>" + escape_html(command) + "</code>");
  }
  return html;
}

/// Highlighted if the drive was unsafe.
std::string worst_outcome_html(const EpisodeRow& row) {
  const std::string outcome = escape_html(row.outcome);
  return row.unsafe ? "<strong class=\"alarm\">" + outcome + "</strong>" : outcome;
}

std::string worst_table(const CampaignStatistics& statistics,
                        const std::vector<ListedEpisode>& worst) {
  if (worst.empty()) return {};
  PageTable table{
      .label = "The worst episodes",
      .heads = {"variant", "seed", "outcome", "unsafe", "least clearance (m)", "cost", "files"},
      .rows = {},
      .text_columns = {2, 6}};
  for (const ListedEpisode& episode : worst) {
    const EpisodeRow& row = episode.row;
    const auto variant =
        std::ranges::find(statistics.variants, row.variant, &VariantStatistics::id);
    const auto position = static_cast<std::size_t>(variant - statistics.variants.begin());
    table.rows.push_back(
        {variant == statistics.variants.end() ? "" : variant_head(statistics, position),
         fmt::format("{}", row.seed), worst_outcome_html(row),
         row.unsafe ? "<strong>yes</strong>" : "no", number_html(row.min_clearance),
         number_html(row.cost), files_html(episode)});
  }
  return section_head("The worst episodes",
                      "First those that entered the unsafe set or whose simulator failed, then by "
                      "least clearance, then by cost. Run the commands in the folder of this page; "
                      "“qsmpc report . --worst N” creates the pages and videos of the N worst at "
                      "once.") +
         table_html(table);
}

/// Panels side by side, such that no row has a gap if possible; empty without panels.
std::string grid(const std::vector<Panel>& panels) {
  if (panels.empty()) return {};
  std::string html =
      panels.size() % 3 == 0 ? "<div class=\"grid thirds\">\n" : "<div class=\"grid\">\n";
  for (const Panel& panel : panels) html += panel_figure(panel);
  return html + "</div>\n";
}

/// The charts of one figure, except those that would show a single point.
std::vector<Panel> charts_of(const std::vector<CampaignFigure>& figures, const char* file) {
  std::vector<Panel> panels;
  for (const CampaignFigure& figure : figures) {
    if (figure.file != file) continue;
    for (const Chart& chart : figure.charts) {
      if (has_places(chart)) panels.emplace_back(chart);
    }
  }
  return panels;
}

std::string rates_section(const std::vector<CampaignFigure>& figures) {
  const std::string charts = grid(charts_of(figures, kOutcomesFile));
  return charts.empty() ? charts : section_head("Outcomes with their intervals", {}) + charts;
}

/// The maps, followed by the distributions of cost, clearance and time, which stand beside a single
/// map.
std::string drives_section(const CampaignStatistics& statistics,
                           const std::vector<CampaignFigure>& figures) {
  const DriveMaps drives = drive_maps(statistics);
  const std::vector<Panel> distributions = charts_of(figures, kDistributionsFile);
  std::vector<Panel> panels(drives.maps.begin(), drives.maps.end());
  const bool share_a_grid = panels.size() == 1;
  if (share_a_grid) panels.insert(panels.end(), distributions.begin(), distributions.end());
  std::string html;
  if (!panels.empty() || !drives.notes.empty()) html += section_head("Driven paths", {});
  for (const std::string& note : drives.notes) {
    html += "<p class=\"note\">" + escape_html(note) + "</p>\n";
  }
  html += grid(panels) + spread_table(statistics);
  return share_a_grid ? html : html + grid(distributions);
}

}  // namespace

std::string campaign_page(const CampaignStatistics& statistics,
                          const std::vector<ListedEpisode>& worst) {
  const std::string name = escape_html(statistics.campaign.name);
  const std::vector<CampaignFigure> figures = campaign_figures(statistics);
  return framed_page(
      {.title = statistics.campaign.name,
       .version = statistics.campaign.version,
       .kind = PageKind::kTables},
      "<h1>" + name + "</h1>\n" + kicker(statistics) + campaign_outcomes(statistics) +
          drives_section(statistics, figures) + worst_table(statistics, worst) +
          rare_section(statistics) + tradeoff_section(statistics) + certificates_table(statistics) +
          grid(charts_of(figures, kReliabilityFile)) + differences_table(statistics) +
          grid(charts_of(figures, kDifferencesFile)) + rates_section(figures));
}

}  // namespace qsmpc::harness

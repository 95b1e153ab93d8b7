#include "harness/cli/campaign_results.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "harness/campaign/rare/rare_scenarios.hpp"
#include "harness/campaign/statistics/campaign_csv.hpp"
#include "harness/campaign/statistics/campaign_json.hpp"
#include "harness/campaign/statistics/campaign_table.hpp"
#include "harness/campaign/store/store_reader.hpp"
#include "harness/campaign/store/store_schema.hpp"
#include "harness/cli/artefacts.hpp"
#include "harness/cli/campaign_episodes.hpp"
#include "harness/cli/fail_on.hpp"
#include "harness/cli/output.hpp"
#include "harness/figures/svg_figure.hpp"
#include "harness/files/atomic_file.hpp"
#include "harness/report/campaign_charts.hpp"
#include "harness/report/campaign_page.hpp"

namespace qsmpc::harness {
namespace {

constexpr const char* kNumbersFile = "campaign.json";

bool has_outcome(const CampaignStatistics& statistics, const std::string& outcome) {
  const auto found = statistics.outcomes.find(outcome);
  return found != statistics.outcomes.end() && found->second > 0;
}

bool is_exceeded(const std::vector<CalibrationBin>& bins) {
  return std::ranges::any_of(bins, &CalibrationBin::exceeded);
}

}  // namespace

CampaignStatistics write_campaign_results(const std::string& folder, std::size_t worst,
                                          bool is_verified) {
  const StoreReader store(folder);
  if (!is_verified) store.verify();
  CampaignStatistics statistics = campaign_statistics(store);
  write_episodes_csv(store, folder + "/episodes.csv");
  write_file(folder + "/variants.csv", variants_csv(statistics));
  write_file(folder + "/differences.csv", differences_csv(statistics));
  write_file(folder + "/calibration.csv", calibration_csv(statistics));
  for (const CampaignFigure& figure : campaign_figures(statistics)) {
    write_file(folder + "/" + figure.file, svg_figure(figure.charts));
  }
  write_file(folder + "/" + kPageFile,
             campaign_page(statistics, worst_with_files(store, folder, worst)));
  write_rare_scenarios(store, folder);
  write_file(folder + "/" + kNumbersFile, campaign_json(statistics));
  return statistics;
}

void print_campaign_results(const CampaignStatistics& statistics, const std::string& folder,
                            bool json) {
  if (json) {
    print_result(campaign_json(statistics));
    return;
  }
  std::string text = campaign_table(statistics);
  text += fmt::format("\n  page     {0}/{1}\n  store    {0}/{2}\n  numbers  {0}/{3}\n", folder,
                      kPageFile, kStoreFile, kNumbersFile);
  text += fmt::format(
      "  tables   {0}/episodes.csv, variants.csv, differences.csv, calibration.csv\n", folder);
  text += "  figures  " + folder + "/";
  const std::vector<CampaignFigure> figures = campaign_figures(statistics);
  for (std::size_t i = 0; i < figures.size(); ++i) {
    text += (i == 0 ? "" : ", ") + figures[i].file;
  }
  print_result(text + "\n");
}

bool asked_to_tell(const std::vector<std::string>& fail_on, const CampaignStatistics& statistics) {
  return std::ranges::any_of(fail_on, [&](const std::string& name) {
    if (name == kFailOnUnsafe) {
      return std::ranges::any_of(statistics.variants,
                                 [](const auto& variant) { return variant.unsafe.events > 0; });
    }
    if (name == kFailOnRiskExceeded) {
      return std::ranges::any_of(statistics.variants,
                                 [](const auto& variant) { return variant.risk_exceeded > 0; });
    }
    if (name == kFailOnExceeded) {
      return is_exceeded(statistics.calibration) ||
             std::ranges::any_of(statistics.variants, [](const auto& variant) {
               return is_exceeded(variant.calibration);
             });
    }
    return has_outcome(statistics, name);
  });
}

}  // namespace qsmpc::harness

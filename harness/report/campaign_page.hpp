// The report of a campaign: one HTML page that needs nothing but itself.
//
//   write_file(folder + "/report.html", campaign_page(statistics));
#pragma once

#include <string>
#include <vector>

#include "harness/campaign/statistics/statistics.hpp"
#include "harness/campaign/store/episode_row.hpp"

namespace qsmpc::harness {

/// An episode that is worth looking at, and what there is of it. Paths are relative to the folder
/// of the page, empty where there is no such file.
struct ListedEpisode {
  EpisodeRow row{};
  std::string page{};
  std::string video{};
  std::string trace{};
  std::vector<std::string> commands{};  ///< that make what is not there, one a line
};

/// The page as UTF-8 text: what became of the drives, cost and times, certificates, differences,
/// the `worst` episodes, each linked to what there is of it, and the figures. It loads nothing and
/// runs no script; texts are escaped.
[[nodiscard]] std::string campaign_page(const CampaignStatistics& statistics,
                                        const std::vector<ListedEpisode>& worst = {});

}  // namespace qsmpc::harness

// The report of a campaign: one self-contained HTML page.
//
//   write_file(folder + "/report.html", campaign_page(statistics));
#pragma once

#include <string>
#include <vector>

#include "harness/campaign/statistics/statistics.hpp"
#include "harness/campaign/store/episode_row.hpp"

namespace qsmpc::harness {

/// An episode worth inspecting, and the files that exist for it. Paths are relative to the folder
/// of the page, and empty if there is no such file.
struct ListedEpisode {
  EpisodeRow row{};
  std::string page{};
  std::string video{};
  std::string trace{};
  std::vector<std::string> commands{};  ///< that create the missing files, one per line
};

/// The page as UTF-8 text: outcomes of the drives, cost and times, certificates, differences, the
/// `worst` episodes with links to their existing files, and the figures. It loads nothing and runs
/// no script; texts are escaped.
[[nodiscard]] std::string campaign_page(const CampaignStatistics& statistics,
                                        const std::vector<ListedEpisode>& worst = {});

}  // namespace qsmpc::harness

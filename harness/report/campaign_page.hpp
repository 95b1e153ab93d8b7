// A campaign as a page.
#pragma once

#include <string>

#include "harness/campaign/statistics/statistics.hpp"

namespace qsmpc {

/// A self-contained HTML page: whether the certificates hold, tables of variants and of their
/// differences, and the figures of campaign_figures. Texts are escaped.
[[nodiscard]] std::string campaign_page(const CampaignStatistics& statistics);

}  // namespace qsmpc

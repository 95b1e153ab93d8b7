// Episodes of a campaign, one by one: what there is of them, and what can be made of them.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "harness/campaign/store/store_reader.hpp"
#include "harness/report/campaign_page.hpp"

namespace qsmpc::harness {

/// The `count` worst episodes of the campaign in `folder`, each with the files that there are of it
/// and the commands, to be typed in that folder, that make those which are missing. The resolved
/// scenarios that these commands name are written to `folder`/variants. Throws as StoreReader, and
/// IoError.
[[nodiscard]] std::vector<ListedEpisode> worst_with_files(const StoreReader& store,
                                                          const std::string& folder,
                                                          std::size_t count);

/// Makes summary, page and video of the `count` worst episodes of the campaign in `folder`, a video
/// only where there is none. An episode whose trace is not kept is driven again first, from its
/// variant's scenario and its seed; where it does not end as the store says, since another version
/// or machine drove it, standard error says so. False if interrupted; what is finished is kept.
/// Throws InputError where a variant's vehicle is no longer that of the campaign, IoError where the
/// campaign is at work or nothing can be written.
[[nodiscard]] bool make_worst_episodes(const std::string& folder, std::size_t count, bool quiet);

}  // namespace qsmpc::harness

// Single episodes of a campaign: their existing files, and how to create the others.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "harness/campaign/store/store_reader.hpp"
#include "harness/report/campaign_page.hpp"

namespace qsmpc::harness {

/// The `count` worst episodes of the campaign in `folder`, each with its existing files and the
/// commands, to be run in that folder, that create the missing ones. The resolved scenarios that
/// these commands name are written to `folder`/variants. Throws as StoreReader, and IoError.
[[nodiscard]] std::vector<ListedEpisode> worst_with_files(const StoreReader& store,
                                                          const std::string& folder,
                                                          std::size_t count);

/// Makes summary, page and video of the `count` worst episodes of the campaign in `folder`, a video
/// only if there is none. An episode whose trace was not kept is first driven again from its
/// variant's scenario and its seed; if it does not end as stored, because another version or
/// machine drove it, a message on standard error says so. Returns false if interrupted; finished
/// files are kept. Throws InputError if a variant's vehicle is no longer that of the campaign, and
/// IoError if the campaign is running or nothing can be written.
[[nodiscard]] bool make_worst_episodes(const std::string& folder, std::size_t count, bool quiet);

}  // namespace qsmpc::harness

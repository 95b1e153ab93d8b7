// Reads the parts that campaign files share with other plans of drives. Invalid parts are added to
// `problems` and left out of the results.
#pragma once

#include <string>
#include <vector>

#include "harness/campaign/campaign.hpp"
#include "harness/campaign/plan/campaign_reader.hpp"
#include "harness/scenario/yaml_section.hpp"
#include "harness/scenario/yaml_tree.hpp"

namespace qsmpc::harness {

/// Whether `text` is non-empty, at most `longest` bytes long, and free of control characters.
[[nodiscard]] bool is_line_of_text(const std::string& text, std::size_t longest);

/// The line of the key whose value `node` is, else its own line.
[[nodiscard]] int line_of(const YamlNode& node);

/// A list of distinct names or paths; `path` is its dotted path in the file.
[[nodiscard]] std::vector<CampaignChoice> read_choices(const YamlNode& list,
                                                       const std::string& path, Problems& problems);

/// {KEY: VALUE, …} at the dotted path `path`, the owner of the settings.
[[nodiscard]] std::vector<CampaignSetting> read_settings(const YamlNode& map,
                                                         const std::string& path,
                                                         Problems& problems);

/// {KEY: [VALUE, …], …}, as in a grid, at the dotted path `path`.
[[nodiscard]] std::vector<GridAxis> read_axes(const YamlNode& map, const std::string& path,
                                              Problems& problems);

/// The seeds under `key` of `section`: {first, count}, or a list of seeds. A missing key is a
/// problem.
[[nodiscard]] SeedSet read_seeds(Section& section, const std::string& key, Problems& problems);

}  // namespace qsmpc::harness

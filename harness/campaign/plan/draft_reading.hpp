// The parts of a campaign file that other plans of drives have too, read from their tree.
// Everything wrong is noted, and left out of what is returned.
#pragma once

#include <string>
#include <vector>

#include "harness/campaign/campaign.hpp"
#include "harness/campaign/plan/campaign_reader.hpp"
#include "harness/scenario/yaml_section.hpp"
#include "harness/scenario/yaml_tree.hpp"

namespace qsmpc::harness {

/// Whether `text` is not empty, of at most `longest` bytes, and has no control character.
[[nodiscard]] bool is_line_of_text(const std::string& text, std::size_t longest);

/// The line of the key that `node` is the value of, else its own.
[[nodiscard]] int line_of(const YamlNode& node);

/// A list of names or paths, each once; `path` is its dotted path in the file.
[[nodiscard]] std::vector<CampaignChoice> read_choices(const YamlNode& list,
                                                       const std::string& path, Problems& problems);

/// {KEY: VALUE, …} at the dotted path `path`, the owner of the settings.
[[nodiscard]] std::vector<CampaignSetting> read_settings(const YamlNode& map,
                                                         const std::string& path,
                                                         Problems& problems);

/// {KEY: [VALUE, …], …}, as of a grid, at the dotted path `path`.
[[nodiscard]] std::vector<GridAxis> read_axes(const YamlNode& map, const std::string& path,
                                              Problems& problems);

/// What `key` of `section` holds: {first, count}, or a list of seeds. One that is not there is
/// noted, too.
[[nodiscard]] SeedSet read_seeds(Section& section, const std::string& key, Problems& problems);

}  // namespace qsmpc::harness

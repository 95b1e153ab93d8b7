// Manual pages, generated from the commands.
#pragma once

#include <string>

#include "harness/cli/command_tree.hpp"

namespace qsmpc::harness {

/// The name of a command's page: "qsmpc-campaign-status".
[[nodiscard]] std::string manual_name(const NamedCommand& command);

/// The page of a command for man(1), section 1, in the macros of man(7).
[[nodiscard]] std::string manual_page(const NamedCommand& command);

/// Writes the pages of `app` and all its commands into `folder` as NAME.1. Throws IoError.
void write_manual(const CLI::App& app, const std::string& folder);

}  // namespace qsmpc::harness

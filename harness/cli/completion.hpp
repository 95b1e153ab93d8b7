// Shell completion of command lines, generated from the commands.
#pragma once

#include <string>

namespace CLI {
class App;
}

namespace qsmpc::harness {

/// A script for bash, to be sourced, or installed as "qsmpc" in its folder of completions. Names of
/// scenarios and campaigns are queried from the program on demand.
[[nodiscard]] std::string bash_completion(const CLI::App& app);

/// The same for zsh: "_qsmpc" in a folder of its $fpath.
[[nodiscard]] std::string zsh_completion(const CLI::App& app);

}  // namespace qsmpc::harness

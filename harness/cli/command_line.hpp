// Messages of the command line itself: help, versions and usage errors.
#pragma once

#include <string>

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace qsmpc::harness {

/// The help of the innermost command that `app` has parsed, with the full command in its usage
/// line.
[[nodiscard]] std::string help_of_parsed(const CLI::App& app);

/// The program's version, and those of the libraries that it is linked with, one per line.
[[nodiscard]] std::string versions();

/// One line: what is wrong with `argv`, which `app` rejected with `error`, with the nearest command
/// or option if one is unknown.
[[nodiscard]] std::string usage_problem(const CLI::App& app, const CLI::ParseError& error, int argc,
                                        const char* const* argv);

}  // namespace qsmpc::harness

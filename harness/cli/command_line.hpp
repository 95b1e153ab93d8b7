// What the command line itself says: help, versions, and what is wrong with what was typed.
#pragma once

#include <string>

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace qsmpc::harness {

/// The help of the innermost command that `app` has parsed, with the whole command in its usage.
[[nodiscard]] std::string help_of_parsed(const CLI::App& app);

/// The program's version, and on a line each those of the libraries that it is linked with.
[[nodiscard]] std::string versions();

/// One line: what is wrong with `argv`, which `app` refused with `error`, with the nearest command
/// or option where one is not known.
[[nodiscard]] std::string usage_problem(const CLI::App& app, const CLI::ParseError& error, int argc,
                                        const char* const* argv);

}  // namespace qsmpc::harness

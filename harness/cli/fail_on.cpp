#include "harness/cli/fail_on.hpp"

#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/trace/ending.hpp"

namespace qsmpc::harness {

void add_fail_on_option(CLI::App& command, std::vector<std::string>& fail_on,
                        const std::vector<std::string>& words) {
  const std::map<std::string, std::string> former = {{kLeftSafeSet, kFailOnUnsafe}};
  command
      .add_option("--fail-on", fail_on,
                  fmt::format("exit with 1 on any of these ({}); default: {}",
                              fmt::join(words, ", "), fmt::join(fail_on, ",")))
      ->delimiter(',')
      ->transform(CLI::Transformer(former).description(""))
      ->check(CLI::IsMember(words));
}

}  // namespace qsmpc::harness

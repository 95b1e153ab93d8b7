#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "harness/cli/commands.hpp"
#include "harness/cli/completion.hpp"
#include "harness/cli/exit_codes.hpp"
#include "harness/cli/output.hpp"

namespace qsmpc::harness {

void add_completion_command(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("completion", "Prints a script that completes command lines in a shell.");
  command->footer(
      "Example: source <(qsmpc completion bash)\n"
      "For zsh: qsmpc completion zsh > ~/.zfunc/_qsmpc, with ~/.zfunc in $fpath before compinit");
  const auto shell = std::make_shared<std::string>();
  command->add_option("shell", *shell, "bash or zsh")
      ->required()
      ->check(CLI::IsMember({"bash", "zsh"}));
  command->callback([&app, shell, &exit_code] {
    print_result(*shell == "bash" ? bash_completion(app) : zsh_completion(app));
    exit_code = kDone;
  });
}

}  // namespace qsmpc::harness

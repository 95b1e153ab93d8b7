// Output for shells and manual readers, checked with bash, zsh and groff.
#include <array>
#include <cstdio>
#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/integration/process.hpp"
#include "tests/support/temporary_folder.hpp"

namespace qsmpc::harness {
namespace shell_test {

using namespace testing;

using ::testing::HasSubstr;

/// The output of a shell command, including its errors.
std::string printed_by(const std::string& command) {
  // NOLINTNEXTLINE(bugprone-command-processor,cert-env33-c): shells are what is tested
  std::FILE* pipe = ::popen(("( " + command + " ) 2>&1").c_str(), "r");
  if (pipe == nullptr) return "popen failed";
  std::string text;
  std::array<char, 4096> part{};
  for (std::size_t n = 0; (n = std::fread(part.data(), 1, part.size(), pipe)) > 0;) {
    text.append(part.data(), n);
  }
  ::pclose(pipe);
  return text;
}

/// Bash's completions after `words`, the last of which is being typed.
std::string offered_after(const std::string& words) {
  const std::string program = QSMPC_PROGRAM;
  return printed_by("bash -c 'PATH=" + std::filesystem::path(program).parent_path().string() +
                    ":$PATH; source <(qsmpc completion bash); COMP_WORDS=(qsmpc " + words +
                    "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _qsmpc; echo ${COMPREPLY[*]}'");
}

TEST(Completion, bash_completes_commands_and_their_commands) {
  EXPECT_EQ(offered_after("camp"), "campaign\n");
  EXPECT_EQ(offered_after("rep"), "report reproduce\n");
  EXPECT_EQ(offered_after("campaign mer"), "merge\n");
  EXPECT_EQ(offered_after("help doc"), "doctor\n");
}

TEST(Completion, bash_completes_options_and_what_they_may_be) {
  EXPECT_EQ(offered_after("run --se"), "--set --seed\n");
  EXPECT_EQ(offered_after("run --no"), "--no-video\n");
  EXPECT_EQ(offered_after("campaign status --js"), "--json\n");
  EXPECT_EQ(offered_after("run --gl os"), "osmesa\n");
  EXPECT_EQ(offered_after("schema cam"), "campaign\n");
}

TEST(Completion, bash_completes_what_is_shipped) {
  EXPECT_EQ(offered_after("run dubins_tr"), "dubins_trap\n");
  EXPECT_THAT(offered_after("run --seed 3 bicycle_"), HasSubstr("bicycle_yard"));
  EXPECT_THAT(offered_after("campaign mission"), HasSubstr("mission_budget"));
}

TEST(Completion, zsh_reads_its_script) {
  const TemporaryFolder folder;
  const std::string script = folder.path() + "/_qsmpc";
  EXPECT_EQ(printed_by(std::string(QSMPC_PROGRAM) + " completion zsh > " + script + " && zsh -n " +
                       script),
            "");
  const std::string text = read_text(script);
  EXPECT_THAT(text, HasSubstr("#compdef qsmpc"));
  EXPECT_THAT(text, HasSubstr("'*--seed["));
  EXPECT_THAT(text, HasSubstr("(auto osmesa egl)"));
}

TEST(Manual, has_a_page_for_every_command_that_groff_accepts) {
  const TemporaryFolder folder;
  ASSERT_EQ(run_qsmpc({"help", "--write-manual", folder.path()}).exit_code, 0);
  const std::set<std::string> pages = files_in(folder.path());
  for (const char* page : {"qsmpc.1", "qsmpc-run.1", "qsmpc-campaign-status.1"}) {
    EXPECT_TRUE(pages.contains(page)) << page;
  }
  for (const std::string& page : pages) {
    const std::string path = folder.path() + "/" + page;
    EXPECT_EQ(printed_by("groff -ww -man -Tutf8 -z " + path), "") << page;
  }
  const std::string run =
      printed_by("groff -man -Tascii -P-cbou " + folder.path() + "/qsmpc-run.1 | tr -s ' '");
  EXPECT_THAT(run, HasSubstr("qsmpc-run - Runs one closed-loop episode"));
  EXPECT_THAT(run, HasSubstr("--seed"));
  EXPECT_THAT(run, HasSubstr("EXIT STATUS"));
}

}  // namespace shell_test
}  // namespace qsmpc::harness

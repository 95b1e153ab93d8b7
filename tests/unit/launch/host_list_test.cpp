#include "harness/cluster/launch/host_list.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/errors.hpp"
#include "tests/support/temporary_folder.hpp"

namespace qsmpc::harness {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::string refusal_of_hosts(const std::string& text) {
  try {
    (void)parse_hosts(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

TEST(HostList, takes_the_number_of_workers_in_both_notations) {
  EXPECT_THAT(
      parse_hosts("one,4/me@two.example, 2*three:2222,:,3/:"),
      ElementsAre(LaunchHost{.login = "one"}, LaunchHost{.login = "me@two.example", .tasks = 4},
                  LaunchHost{.login = "three", .port = 2222, .tasks = 2}, LaunchHost{.login = ":"},
                  LaunchHost{.login = ":", .tasks = 3}));
}

TEST(HostList, leaves_addresses_with_several_colons_whole) {
  EXPECT_THAT(parse_hosts("2/fe80::1%eth0"),
              ElementsAre(LaunchHost{.login = "fe80::1%eth0", .tasks = 2}));
}

TEST(HostList, reads_a_file_of_logins_with_comments) {
  const qsmpc::testing::TemporaryFolder folder;
  const std::string file =
      folder.file("hosts", "# all of them\n8/big\n\n  me@small   # slow\r\n:\n");
  EXPECT_THAT(parse_hosts("@" + file),
              ElementsAre(LaunchHost{.login = "big", .tasks = 8}, LaunchHost{.login = "me@small"},
                          LaunchHost{.login = ":"}));
}

TEST(HostList, refuses_what_ssh_would_take_for_options_and_what_shells_read) {
  for (const char* const text : {"-oProxyCommand=x", "me@", "a b", "ssh -p 22 a", "$(x)", "0/a",
                                 "x/a", "a:0", "a:70000", "a:b", "4/", "100001/a"}) {
    EXPECT_THAT(refusal_of_hosts(text),
                HasSubstr("--on: found " + std::string(text) + ", expected"))
        << text;
  }
  EXPECT_THAT(refusal_of_hosts("a,,b"), HasSubstr("found ssh:a,,b"));
  EXPECT_THAT(refusal_of_hosts(""), HasSubstr("found ssh:, expected ssh:HOST"));
  EXPECT_THAT(refusal_of_hosts("60000/a,60000/b"), HasSubstr("found 120000 workers"));
}

TEST(HostList, refuses_a_line_of_a_file_by_its_number) {
  const qsmpc::testing::TemporaryFolder folder;
  const std::string file = folder.file("hosts", "a\n\nssh -p 2 b\n");
  EXPECT_THAT(refusal_of_hosts("@" + file), HasSubstr(file + ":3: --on: found ssh -p 2 b"));
  EXPECT_THAT(refusal_of_hosts("@" + folder.file("none", "# nothing\n")),
              HasSubstr("found no host"));
}

}  // namespace
}  // namespace qsmpc::harness

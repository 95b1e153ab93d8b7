#include "harness/files/installation.hpp"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace qsmpc::harness {
namespace installation_test {

using ::testing::ElementsAre;

TEST(Installation, finds_the_prefix_of_programs_and_libraries) {
  EXPECT_THAT(installation_prefixes_of("/usr/bin/qsmpc"), ElementsAre("/usr", "/"));
  EXPECT_THAT(installation_prefixes_of("/opt/q/lib/x86_64-linux-gnu/libqsmpc.so.0.1"),
              ElementsAre("/opt/q/lib", "/opt/q"));
}

// A wheel ships its files, and they take precedence over those in Python's own prefix.
TEST(Installation, finds_the_prefix_of_the_python_module) {
  EXPECT_THAT(installation_prefixes_of("/usr/lib/python3/dist-packages/qsmpc/_native/core.so"),
              ElementsAre("/usr/lib/python3/dist-packages/qsmpc", "/usr/lib/python3/dist-packages",
                          "/usr"));
  EXPECT_THAT(installation_prefixes_of("/env/lib/python3.11/site-packages/qsmpc/_native/core.so"),
              ElementsAre("/env/lib/python3.11/site-packages/qsmpc",
                          "/env/lib/python3.11/site-packages", "/env"));
}

TEST(Installation, has_no_prefix_where_the_executable_is_unknown) {
  EXPECT_TRUE(installation_prefixes_of("").empty());
}

}  // namespace installation_test
}  // namespace qsmpc::harness

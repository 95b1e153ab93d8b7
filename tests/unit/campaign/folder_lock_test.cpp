#include "harness/campaign/store/folder_lock.hpp"

#include <csignal>
#include <ctime>
#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/utsname.h>
#include <sys/wait.h>
#include <unistd.h>

#include "harness/errors.hpp"
#include "tests/support/temporary_folder.hpp"

namespace qsmpc::harness {
namespace folder_lock_test {

using ::testing::HasSubstr;

TEST(FolderLock, names_the_holder_to_whoever_comes_second) {
  const testing::TemporaryFolder folder;
  const FolderLock first(folder.path());
  try {
    const FolderLock second(folder.path());
    FAIL() << "both hold it";
  } catch (const IoError& error) {
    EXPECT_THAT(error.what(), HasSubstr("process " + std::to_string(::getpid())));
    EXPECT_THAT(error.what(), HasSubstr(folder.path()));
  }
}

TEST(FolderLock, is_visible_to_those_who_only_query_it) {
  const testing::TemporaryFolder folder;
  EXPECT_FALSE(lock_holder(folder.path()));
  {
    const FolderLock lock(folder.path());
    const std::optional<LockHolder> holder = lock_holder(folder.path());
    ASSERT_TRUE(holder);
    EXPECT_EQ(holder->process, ::getpid());
    utsname system{};
    ASSERT_EQ(::uname(&system), 0);
    EXPECT_EQ(holder->host, std::string(system.nodename));
    EXPECT_NEAR(static_cast<double>(holder->since), static_cast<double>(std::time(nullptr)), 60.0);
    EXPECT_TRUE(lock_holder(folder.path())) << "asking took it";
  }
  EXPECT_FALSE(lock_holder(folder.path()));
}

TEST(FolderLock, is_free_again_when_its_holder_was_killed) {
  const testing::TemporaryFolder folder;
  int ready[2];
  ASSERT_EQ(::pipe(ready), 0);
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    const FolderLock lock(folder.path());
    (void)!::write(ready[1], "x", 1);
    for (;;) ::pause();
  }
  char byte = 0;
  ASSERT_EQ(::read(ready[0], &byte, 1), 1);
  EXPECT_THROW(FolderLock{folder.path()}, IoError);
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  EXPECT_FALSE(lock_holder(folder.path()));
  EXPECT_NO_THROW(FolderLock{folder.path()});
}

TEST(FolderLock, times_are_in_utc) {
  EXPECT_EQ(utc_text(0), "1970-01-01 00:00:00 UTC");
  EXPECT_EQ(utc_text(951'827'696), "2000-02-29 12:34:56 UTC");
}

TEST(FolderLock, does_not_write_through_a_symbolic_link) {
  const testing::TemporaryFolder folder;
  const std::string precious = folder.file("precious", "old");
  std::filesystem::create_symlink(precious, folder / "campaign.lock");
  EXPECT_THROW(FolderLock{folder.path()}, IoError);
  EXPECT_EQ(std::filesystem::file_size(precious), 3U);
}

TEST(FolderLock, names_the_folder_that_cannot_be_locked) {
  try {
    const FolderLock lock("/no/such/folder");
    FAIL() << "locked";
  } catch (const IoError& error) {
    EXPECT_THAT(error.what(), HasSubstr("/no/such/folder"));
    EXPECT_THAT(error.what(), HasSubstr("opened"));
    EXPECT_THAT(error.what(), HasSubstr("No such file or directory"));
  }
}

}  // namespace folder_lock_test
}  // namespace qsmpc::harness

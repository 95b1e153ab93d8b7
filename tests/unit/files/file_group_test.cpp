#include "harness/files/file_group.hpp"

#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/errors.hpp"
#include "tests/support/temporary_folder.hpp"

namespace qsmpc::harness {
namespace file_group_test {

using ::testing::ElementsAre;
using testing::TemporaryFolder;

bool exists(const std::string& path) { return std::filesystem::exists(path); }

TEST(FileGroup, no_file_has_its_name_before_the_commit) {
  const TemporaryFolder folder;
  FileGroup files;
  files.add(folder / "a").write("1");
  files.add(folder / "b").write("2");
  EXPECT_FALSE(exists(folder / "a") || exists(folder / "b"));
  files.commit();
  EXPECT_TRUE(exists(folder / "a") && exists(folder / "b"));
  EXPECT_THAT(files.paths(), ElementsAre(folder / "a", folder / "b"));
}

TEST(FileGroup, leaves_no_trace_without_a_commit) {
  const TemporaryFolder folder;
  {
    FileGroup files;
    files.add(folder / "a").write("1");
    EXPECT_THROW(files.add(folder / "no/b"), IoError);
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(FileGroup, an_older_seal_is_gone_where_a_file_before_it_fails) {
  const TemporaryFolder folder;
  (void)folder.file("seal", "old");
  std::filesystem::create_directories(folder / "data/occupied");
  FileGroup files;
  files.add(folder / "data").write("new");
  files.add(folder / "seal").write("new");
  EXPECT_THROW(files.commit_sealed(), IoError);
  EXPECT_FALSE(exists(folder / "seal"));
}

TEST(FileGroup, a_commit_without_a_seal_keeps_older_files_that_it_does_not_reach) {
  const TemporaryFolder folder;
  (void)folder.file("last", "old");
  std::filesystem::create_directories(folder / "data/occupied");
  FileGroup files;
  files.add(folder / "data").write("new");
  files.add(folder / "last").write("new");
  EXPECT_THROW(files.commit(), IoError);
  EXPECT_TRUE(exists(folder / "last"));
}

}  // namespace file_group_test
}  // namespace qsmpc::harness

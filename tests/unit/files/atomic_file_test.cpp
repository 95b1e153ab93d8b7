// A file exists completely or not at all. The tests may run as root, for whom no folder is
// read-only, so failures are caused by type (a file instead of a folder) or by a file size limit.
#include "harness/files/atomic_file.hpp"

#include <csignal>
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include "tests/unit/scenario/scenario_fixture.hpp"

namespace qsmpc::harness {
namespace atomic_file_test {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

template <class Action>
std::string io_error_of(Action action) {
  try {
    action();
  } catch (const IoError& error) {
    return error.what();
  }
  ADD_FAILURE() << "nothing was thrown";
  return "";
}

TEST(PendingFile, is_under_its_name_only_after_commit) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.txt";
  PendingFile file(path);
  file.write("one ");
  file.write(std::string("two\0", 4));
  EXPECT_FALSE(std::filesystem::exists(path));
  EXPECT_TRUE(std::filesystem::exists(path + ".partial"));
  file.commit();
  EXPECT_EQ(content_of(path), std::string("one two\0", 8));
  EXPECT_FALSE(std::filesystem::exists(path + ".partial"));
}

TEST(PendingFile, leaves_the_old_file_and_nothing_else_when_abandoned) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.txt", "old");
  {
    PendingFile file(path);
    file.write("new");
  }
  EXPECT_EQ(content_of(path), "old");
  EXPECT_FALSE(std::filesystem::exists(path + ".partial"));
}

TEST(PendingFile, replaces_what_a_killed_process_left_and_what_was_there_before) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.txt", "old and long");
  (void)folder.file("a.txt.partial", "half of something longer");
  write_file(path, "new");
  EXPECT_EQ(content_of(path), "new");
}

TEST(PendingFile, commits_what_another_writer_put_under_the_partial_name) {
  const TemporaryFolder folder;
  PendingFile file(folder / "a.txt");
  std::filesystem::remove(file.partial_path());
  (void)folder.file("a.txt.partial", "from a library");
  file.commit();
  EXPECT_EQ(content_of(folder / "a.txt"), "from a library");
}

TEST(PendingFile, says_which_path_cannot_be_written_and_why) {
  const TemporaryFolder folder;
  const std::string file = folder.file("file", "");
  EXPECT_THAT(io_error_of([&] { write_file(file + "/a.txt", "x"); }),
              AllOf(HasSubstr(file + "/a.txt"), HasSubstr("Not a directory")));
  EXPECT_THAT(io_error_of([&] { write_file(folder / "none/a.txt", "x"); }),
              HasSubstr("No such file or directory"));
}

/// While alive, limits the files of this process to `bytes`: as on a full disk, writing beyond that
/// fails.
class SmallFiles {
 public:
  explicit SmallFiles(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit small{.rlim_cur = bytes, .rlim_max = before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &small);
  }
  SmallFiles(const SmallFiles&) = delete;
  SmallFiles& operator=(const SmallFiles&) = delete;
  SmallFiles(SmallFiles&&) = delete;
  SmallFiles& operator=(SmallFiles&&) = delete;
  ~SmallFiles() {
    setrlimit(RLIMIT_FSIZE, &before_);
    (void)std::signal(SIGXFSZ, handler_);
  }

 private:
  rlimit before_{};
  void (*handler_)(int);
};

TEST(PendingFile, a_disk_that_takes_no_more_is_reported_and_nothing_is_left_behind) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.txt", "old");
  const std::string error = [&] {
    const SmallFiles small(2);
    return io_error_of([&] { write_file(path, "new"); });
  }();
  EXPECT_THAT(error, AllOf(HasSubstr(path), HasSubstr("File too large")));
  EXPECT_EQ(content_of(path), "old");
  EXPECT_FALSE(std::filesystem::exists(path + ".partial"));
}

TEST(PendingFile, a_folder_of_the_final_name_is_reported) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "a.txt");
  EXPECT_THAT(io_error_of([&] { write_file(folder / "a.txt", "x"); }), HasSubstr("Is a directory"));
  EXPECT_FALSE(std::filesystem::exists(folder / "a.txt.partial"));
}

TEST(CommitPartialFile, gives_a_finished_file_its_name) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.txt", "old");
  (void)folder.file("a.txt.partial", "new");
  EXPECT_EQ(partial_path_of(path), path + ".partial");
  commit_partial_file(path);
  EXPECT_EQ(content_of(path), "new");
  EXPECT_FALSE(std::filesystem::exists(path + ".partial"));
}

TEST(PendingFile, does_not_write_through_a_symbolic_link) {
  const TemporaryFolder folder;
  const std::string precious = folder.file("precious", "old");
  std::filesystem::create_symlink(precious, folder / "a.txt.partial");
  EXPECT_THAT(io_error_of([&] { write_file(folder / "a.txt", "new"); }),
              HasSubstr("a.txt.partial"));
  EXPECT_EQ(content_of(precious), "old");
  // Only a link in place of the temporary file is refused; a link in place of the file itself is
  // replaced, and its target stays.
  std::filesystem::create_symlink(precious, folder / "b.txt");
  write_file(folder / "b.txt", "new");
  EXPECT_EQ(content_of(precious), "old");
  EXPECT_EQ(content_of(folder / "b.txt"), "new");
}

TEST(CommitPartialFile, keeps_the_old_file_if_the_new_one_is_unfinished) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.txt", "old");
  EXPECT_THAT(io_error_of([&] { commit_partial_file(path); }), HasSubstr(path));
  EXPECT_EQ(content_of(path), "old");
}

TEST(MakeOutputFolder, makes_all_folders_above_and_accepts_one_that_is_there) {
  const TemporaryFolder folder;
  make_output_folder(folder / "a/b/c");
  make_output_folder(folder / "a/b/c");
  EXPECT_TRUE(std::filesystem::is_directory(folder / "a/b/c"));
}

TEST(MakeOutputFolder, names_what_is_in_the_way) {
  const TemporaryFolder folder;
  const std::string file = folder.file("file", "");
  EXPECT_THAT(io_error_of([&] { make_output_folder(file); }), HasSubstr("Not a directory"));
  EXPECT_THAT(io_error_of([&] { make_output_folder(file + "/a"); }),
              AllOf(HasSubstr(file + "/a"), HasSubstr("Not a directory"), Not(HasSubstr("\n"))));
  EXPECT_THAT(io_error_of([&] { make_output_folder(""); }), Not(HasSubstr("Success")));
}

}  // namespace atomic_file_test
}  // namespace qsmpc::harness

#include "harness/files/random_access_file.hpp"

#include <array>
#include <filesystem>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/errors.hpp"
#include "tests/support/temporary_folder.hpp"

namespace qsmpc::harness {
namespace random_access_file_test {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::vector<std::uint8_t> bytes_from(const RandomAccessFile& file, std::int64_t position) {
  std::vector<std::uint8_t> bytes(100);
  bytes.resize(file.read_at(position, bytes));
  return bytes;
}

TEST(random_access_file, keeps_what_is_written_out_of_order) {
  const testing::TemporaryFolder folder;
  RandomAccessFile file(folder / "bytes");
  file.write_at(4, std::array<std::uint8_t, 2>{5, 6});
  file.write_at(1, std::array<std::uint8_t, 2>{2, 3});
  EXPECT_EQ(file.size(), 6);
  EXPECT_THAT(bytes_from(file, 0), ElementsAre(0, 2, 3, 0, 5, 6));
  EXPECT_THAT(bytes_from(file, 5), ElementsAre(6));
  EXPECT_THAT(bytes_from(file, 6), ElementsAre());
}

TEST(random_access_file, empties_what_was_there_and_stays_when_closed) {
  const testing::TemporaryFolder folder;
  const std::string path = folder / "bytes";
  RandomAccessFile(path).write_at(0, std::array<std::uint8_t, 3>{1, 2, 3});
  EXPECT_EQ(std::filesystem::file_size(path), 3U);
  EXPECT_EQ(RandomAccessFile(path).size(), 0);
}

TEST(random_access_file, errors_give_the_path_and_the_systems_message) {
  const testing::TemporaryFolder folder;
  const std::string path = folder / "missing/bytes";
  try {
    const RandomAccessFile file(path);
    FAIL() << "it was created";
  } catch (const IoError& error) {
    EXPECT_THAT(error.what(), HasSubstr(path));
    EXPECT_THAT(error.what(), HasSubstr("No such file or directory"));
  }
  const std::string precious = folder.file("precious", "old");
  std::filesystem::create_symlink(precious, folder / "link");
  EXPECT_THROW(RandomAccessFile(folder / "link"), IoError);
  EXPECT_EQ(std::filesystem::file_size(precious), 3U);
  RandomAccessFile full("/dev/full");
  EXPECT_THROW(full.write_at(0, std::array<std::uint8_t, 1>{1}), IoError);
}

}  // namespace random_access_file_test
}  // namespace qsmpc::harness

// A folder for traces, and helpers to inspect files in it.
#pragma once

#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>

#include "harness/errors.hpp"
#include "harness/trace/trace_file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace qsmpc::testing {

class TraceFolder : public ::testing::Test {
 protected:
  [[nodiscard]] std::string path(const std::string& name = "episode.h5") const {
    return folder_ / name;
  }
  [[nodiscard]] static std::string bytes_of(const std::string& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  /// All bytes after the superblock and its extension, in which HDF5 always stores the second in
  /// which the file was created.
  [[nodiscard]] static std::string content_of(const std::string& file) {
    constexpr std::size_t kHeader = 108;
    return bytes_of(file).substr(kHeader);
  }
  static void write_bytes(const std::string& file, const std::string& bytes) {
    std::ofstream(file, std::ios::binary) << bytes;
  }
  /// The message with which `read_trace` refuses a file as bad input.
  [[nodiscard]] static std::string refusal(const std::string& file) {
    try {
      static_cast<void>(harness::read_trace(file));
    } catch (const harness::InputError& error) {
      return error.what();
    }
    return "";
  }

  TemporaryFolder folder_;
};

}  // namespace qsmpc::testing

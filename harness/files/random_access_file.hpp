// Files with random access, e.g. for a library that writes a file out of order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace qsmpc::harness {

/// A file that is open for reading and writing. Members throw IoError with its path and the
/// system's message. The destructor closes the file and keeps what was written.
class RandomAccessFile {
 public:
  /// Creates the file at `path`, or truncates the existing one. A symbolic link is refused.
  explicit RandomAccessFile(std::string path);
  RandomAccessFile(const RandomAccessFile&) = delete;
  RandomAccessFile& operator=(const RandomAccessFile&) = delete;
  ~RandomAccessFile();

  [[nodiscard]] const std::string& path() const { return path_; }

  /// Size of the file, bytes.
  [[nodiscard]] std::int64_t size() const;

  /// Writes all of `bytes` at `position` (bytes); they survive this process. A gap before a
  /// position beyond the end is filled with zeros.
  void write_at(std::int64_t position, std::span<const std::uint8_t> bytes);

  /// Reads into the beginning of `out` from `position` on. Returns the number of bytes read; 0 at
  /// the end.
  std::size_t read_at(std::int64_t position, std::span<std::uint8_t> out) const;

 private:
  std::string path_;
  int descriptor_ = -1;
};

}  // namespace qsmpc::harness

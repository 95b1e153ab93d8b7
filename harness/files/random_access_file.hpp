// Files that are read and written anywhere, e.g. by a library that makes a file out of order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace qsmpc::harness {

/// A file that is open for reading and writing. Members throw IoError with its path and the
/// system's words. Closing it leaves it where it is, with what was written.
class RandomAccessFile {
 public:
  /// Creates the file at `path`, or empties the one that is there. A symbolic link is refused.
  explicit RandomAccessFile(std::string path);
  RandomAccessFile(const RandomAccessFile&) = delete;
  RandomAccessFile& operator=(const RandomAccessFile&) = delete;
  ~RandomAccessFile();

  [[nodiscard]] const std::string& path() const { return path_; }

  /// Bytes.
  [[nodiscard]] std::int64_t size() const;

  /// Puts all of `bytes` at `position` (bytes), where they outlive this process; with a gap of
  /// zeros where that is beyond the end.
  void write_at(std::int64_t position, std::span<const std::uint8_t> bytes);

  /// Fills the beginning of `out` from `position` on. Returns the number of bytes; 0: the end.
  std::size_t read_at(std::int64_t position, std::span<std::uint8_t> out) const;

 private:
  std::string path_;
  int descriptor_ = -1;
};

}  // namespace qsmpc::harness

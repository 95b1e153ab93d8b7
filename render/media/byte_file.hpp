// Where the bytes of a media file are kept: the caller's business, who has folders, names and
// disks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace qsmpc::render {

/// Bytes that can be read and written anywhere. Members throw what they like, e.g. that the disk is
/// full; whoever writes a video is thrown it.
class ByteFile {
 public:
  ByteFile() = default;
  ByteFile(const ByteFile&) = delete;
  ByteFile& operator=(const ByteFile&) = delete;
  virtual ~ByteFile() = default;

  /// Begins anew with no bytes; called before all else.
  virtual void clear() = 0;

  /// Number of bytes.
  [[nodiscard]] virtual std::int64_t size() = 0;

  /// Puts `bytes` at `position`, counted in bytes from the beginning, also beyond the end. What is
  /// written should outlive a process that is killed.
  virtual void write_at(std::int64_t position, std::span<const std::uint8_t> bytes) = 0;

  /// Fills the beginning of `out` with the bytes from `position` on. Returns their number, 0 only
  /// at the end.
  virtual std::size_t read_at(std::int64_t position, std::span<std::uint8_t> out) = 0;
};

}  // namespace qsmpc::render

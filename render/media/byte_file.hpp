// The storage of a media file's bytes, implemented by the caller, who knows folders, names and
// disks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace qsmpc::render {

/// Bytes with random access for reading and writing. Members may throw anything, e.g. that the disk
/// is full; the exception reaches the writer of the video.
class ByteFile {
 public:
  ByteFile() = default;
  ByteFile(const ByteFile&) = delete;
  ByteFile& operator=(const ByteFile&) = delete;
  virtual ~ByteFile() = default;

  /// Starts again without any bytes; called first.
  virtual void clear() = 0;

  /// Number of bytes.
  [[nodiscard]] virtual std::int64_t size() = 0;

  /// Writes `bytes` at `position`, in bytes from the beginning; it may be beyond the end. Written
  /// bytes should survive a killed process.
  virtual void write_at(std::int64_t position, std::span<const std::uint8_t> bytes) = 0;

  /// Reads bytes from `position` on into the beginning of `out`. Returns their number, 0 only at
  /// the end.
  virtual std::size_t read_at(std::int64_t position, std::span<std::uint8_t> out) = 0;
};

}  // namespace qsmpc::render

// Adapts a ByteFile for reading or writing by FFmpeg's libraries. Included only by the .cpp files
// that encode.
#pragma once

#include <cstdint>
#include <exception>
#include <string>

#include "render/media/byte_file.hpp"
#include "render/media/libav.hpp"

namespace qsmpc::render::libav {

class ByteStream {
 public:
  enum class Use { kRead, kWrite };

  /// Starts at the first byte. Exceptions of `file` cannot pass through the libraries: they are
  /// stored in `error`, and the libraries get an error code. Throws std::runtime_error if memory
  /// runs out.
  ByteStream(ByteFile& file, Use use, std::exception_ptr& error, const std::string& what);
  ~ByteStream();
  ByteStream(const ByteStream&) = delete;
  ByteStream& operator=(const ByteStream&) = delete;

  [[nodiscard]] AVIOContext* context() { return context_; }

 private:
  static int read(void* stream, std::uint8_t* buffer, int size);
  static int write(void* stream, std::uint8_t* buffer, int size);
  static std::int64_t seek(void* stream, std::int64_t offset, int whence);

  // The result of `action`, or an error code if it threw.
  template <typename Action>
  auto guarded(const Action& action) -> decltype(action());

  ByteFile& file_;
  std::exception_ptr& error_;
  std::int64_t position_ = 0;
  AVIOContext* context_ = nullptr;
};

}  // namespace qsmpc::render::libav

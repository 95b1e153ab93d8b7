// A ByteFile as FFmpeg's libraries read or write it. Included only by the .cpp files that encode.
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

  /// Begins at the first byte. What `file` throws cannot pass through the libraries: it is kept in
  /// `error`, and they are told of a failure. Throws std::runtime_error when memory runs out.
  ByteStream(ByteFile& file, Use use, std::exception_ptr& error, const std::string& what);
  ~ByteStream();
  ByteStream(const ByteStream&) = delete;
  ByteStream& operator=(const ByteStream&) = delete;

  [[nodiscard]] AVIOContext* context() { return context_; }

 private:
  static int read(void* stream, std::uint8_t* buffer, int size);
  static int write(void* stream, std::uint8_t* buffer, int size);
  static std::int64_t seek(void* stream, std::int64_t offset, int whence);

  // What `action` returns, or a code after it threw.
  template <typename Action>
  auto guarded(const Action& action) -> decltype(action());

  ByteFile& file_;
  std::exception_ptr& error_;
  std::int64_t position_ = 0;
  AVIOContext* context_ = nullptr;
};

}  // namespace qsmpc::render::libav

#include "render/media/byte_stream.hpp"

#include <cerrno>
#include <cstdio>

namespace qsmpc::render::libav {
namespace {

constexpr int kStreamBuffer = 1 << 16;  // bytes

}  // namespace

template <typename Action>
auto ByteStream::guarded(const Action& action) -> decltype(action()) {
  try {
    return action();
  } catch (...) {
    if (!error_) error_ = std::current_exception();
    return AVERROR(EIO);
  }
}

ByteStream::ByteStream(ByteFile& file, Use use, std::exception_ptr& error, const std::string& what)
    : file_(file), error_(error) {
  auto* buffer = static_cast<unsigned char*>(check_allocated(av_malloc(kStreamBuffer), what));
  const bool writes = use == Use::kWrite;
  context_ = avio_alloc_context(buffer, kStreamBuffer, writes ? 1 : 0, this,
                                writes ? nullptr : &ByteStream::read,
                                writes ? &ByteStream::write : nullptr, &ByteStream::seek);
  if (context_ == nullptr) av_free(buffer);
  check_allocated(context_, what);
}

ByteStream::~ByteStream() {
  av_freep(&context_->buffer);  // which is not always the original one
  avio_context_free(&context_);
}

int ByteStream::read(void* stream, std::uint8_t* buffer, int size) {
  auto& self = *static_cast<ByteStream*>(stream);
  return self.guarded([&] {
    const auto count = static_cast<int>(
        self.file_.read_at(self.position_, {buffer, static_cast<std::size_t>(size)}));
    self.position_ += count;
    return count == 0 ? AVERROR_EOF : count;
  });
}

int ByteStream::write(void* stream, std::uint8_t* buffer, int size) {
  auto& self = *static_cast<ByteStream*>(stream);
  return self.guarded([&] {
    self.file_.write_at(self.position_, {buffer, static_cast<std::size_t>(size)});
    self.position_ += size;
    return size;
  });
}

std::int64_t ByteStream::seek(void* stream, std::int64_t offset, int whence) {
  auto& self = *static_cast<ByteStream*>(stream);
  return self.guarded([&]() -> std::int64_t {
    switch (whence & ~AVSEEK_FORCE) {
      case AVSEEK_SIZE:
        return self.file_.size();
      case SEEK_SET:
        return self.position_ = offset;
      case SEEK_CUR:
        return self.position_ += offset;
      case SEEK_END:
        return self.position_ = self.file_.size() + offset;
      default:
        return AVERROR(EINVAL);
    }
  });
}

}  // namespace qsmpc::render::libav

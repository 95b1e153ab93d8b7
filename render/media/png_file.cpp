#include "render/media/png_file.hpp"

#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <stdexcept>

#include "render/media/libav.hpp"

namespace qsmpc {
namespace {

libav::Pointer<AVPacket> encode(const Image& image, const std::string& what) {
  const AVCodec* const png = avcodec_find_encoder(AV_CODEC_ID_PNG);
  if (png == nullptr) {
    throw std::runtime_error(what + ": this FFmpeg has no PNG encoder");
  }
  const libav::Pointer<AVCodecContext> codec(
      libav::check_allocated(avcodec_alloc_context3(png), what));
  codec->width = image.width;
  codec->height = image.height;
  codec->pix_fmt = AV_PIX_FMT_RGB24;
  codec->time_base = {1, 1};
  libav::check(avcodec_open2(codec.get(), png, nullptr), what);

  const libav::Pointer<AVFrame> frame(libav::check_allocated(av_frame_alloc(), what));
  frame->width = image.width;
  frame->height = image.height;
  frame->format = AV_PIX_FMT_RGB24;
  libav::check(av_frame_get_buffer(frame.get(), 0), what);
  const auto row = 3 * static_cast<std::size_t>(image.width);
  for (int y = 0; y < image.height; ++y) {
    std::memcpy(frame->data[0] + static_cast<std::ptrdiff_t>(y) * frame->linesize[0],
                image.rgb.data() + static_cast<std::size_t>(y) * row, row);
  }
  libav::Pointer<AVPacket> packet(libav::check_allocated(av_packet_alloc(), what));
  libav::check(avcodec_send_frame(codec.get(), frame.get()), what);
  libav::check(avcodec_receive_packet(codec.get(), packet.get()), what);
  return packet;
}

[[noreturn]] void throw_system_error(const std::string& what, const std::string& leftover) {
  const std::string words = std::strerror(errno);
  std::remove(leftover.c_str());
  throw std::runtime_error(what + ": " + words);
}

}  // namespace

void write_png(const std::string& path, const Image& image) {
  const auto pixels =
      static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  if (image.width <= 0 || image.height <= 0 || image.rgb.size() != 3 * pixels) {
    throw std::invalid_argument("picture \"" + path + "\": its data do not fit its size");
  }
  const std::string what = "picture \"" + path + "\"";
  libav::silence_log();
  const libav::Pointer<AVPacket> packet = encode(image, what);
  const std::string aside = path + ".partial";
  std::FILE* const file = std::fopen(aside.c_str(), "wb");
  if (file == nullptr) {
    throw std::runtime_error(what + ": " + std::strerror(errno));
  }
  const auto size = static_cast<std::size_t>(packet->size);
  const bool written = std::fwrite(packet->data, 1, size, file) == size && std::fflush(file) == 0;
  const int write_error = errno;
  if (std::fclose(file) != 0 || !written) {
    errno = written ? errno : write_error;
    throw_system_error(what, aside);
  }
  if (std::rename(aside.c_str(), path.c_str()) != 0) {
    throw_system_error(what, aside);
  }
}

}  // namespace qsmpc

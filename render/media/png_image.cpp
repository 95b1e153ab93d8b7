#include "render/media/png_image.hpp"

#include <cstddef>
#include <cstring>
#include <stdexcept>

#include "render/media/media_file.hpp"

namespace qsmpc::render {

std::string encode_png(const Image& image) {
  const std::string what = "PNG picture";
  const auto pixels =
      static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  if (image.width <= 0 || image.height <= 0 || image.rgb.size() != 3 * pixels) {
    throw std::invalid_argument(what + ": its data do not match its size");
  }
  libav::silence_log();
  const libav::Pointer<AVCodecContext> codec = libav::open_encoder({.encoder = "png",
                                                                    .pixels = AV_PIX_FMT_RGB24,
                                                                    .width = image.width,
                                                                    .height = image.height,
                                                                    .frames_per_second = 1,
                                                                    .options = {}},
                                                                   what);
  const libav::Pointer<AVFrame> frame = libav::allocate_frame(*codec, what);
  const auto row = 3 * static_cast<std::size_t>(image.width);
  for (int y = 0; y < image.height; ++y) {
    std::memcpy(frame->data[0] + static_cast<std::ptrdiff_t>(y) * frame->linesize[0],
                image.rgb.data() + static_cast<std::size_t>(y) * row, row);
  }
  const libav::Pointer<AVPacket> packet(libav::check_allocated(av_packet_alloc(), what));
  libav::check(avcodec_send_frame(codec.get(), frame.get()), what);
  libav::check(avcodec_receive_packet(codec.get(), packet.get()), what);
  return {reinterpret_cast<const char*>(packet->data), static_cast<std::size_t>(packet->size)};
}

}  // namespace qsmpc::render

// Ownership and error text for FFmpeg's libraries. Included only by the .cpp files that encode.
#pragma once

#include <memory>
#include <string>

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libswscale/swscale.h>
}

namespace qsmpc::render::libav {

struct Deleter {
  void operator()(AVCodecContext* codec) const { avcodec_free_context(&codec); }
  void operator()(AVFrame* frame) const { av_frame_free(&frame); }
  void operator()(AVPacket* packet) const { av_packet_free(&packet); }
  void operator()(SwsContext* scaler) const { sws_freeContext(scaler); }
};

template <typename T>
using Pointer = std::unique_ptr<T, Deleter>;

/// Stops the libraries from printing; the last message of a thread goes into the exception that
/// `check` throws on that thread.
void silence_log();

/// Throws std::runtime_error "WHAT: the library's or the system's message" if `code` is negative;
/// otherwise returns it.
int check(int code, const std::string& what);

/// Throws std::runtime_error if `pointer` is null, which means that memory ran out.
template <typename T>
T* check_allocated(T* pointer, const std::string& what) {
  if (pointer == nullptr) {
    check(AVERROR(ENOMEM), what);
  }
  return pointer;
}

}  // namespace qsmpc::render::libav

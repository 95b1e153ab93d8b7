// Media files of one video stream, by FFmpeg's libraries. Included only by the .cpp files that
// encode.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "render/media/libav.hpp"

namespace qsmpc::libav {

/// Names and values of a library's options.
using Settings = std::vector<std::pair<std::string, std::string>>;

/// How pictures are encoded.
struct EncoderSettings {
  std::string encoder;  ///< the library's name of it, e.g. "libx264"
  AVPixelFormat pixels = AV_PIX_FMT_YUV420P;
  int width = 0;
  int height = 0;
  int frames_per_second = 0;
  int threads = 1;
  Settings options;
};

/// Throws std::runtime_error "WHAT: …" when there is no such encoder or it refuses an option.
[[nodiscard]] Pointer<AVCodecContext> open_encoder(const EncoderSettings& settings,
                                                   const std::string& what);

/// A frame with memory for `codec`'s pictures.
[[nodiscard]] Pointer<AVFrame> allocate_frame(const AVCodecContext& codec, const std::string& what);

/// A kind of container and its options.
struct Container {
  std::string name;  ///< the library's name of it, e.g. "mp4"
  Settings options;
};

/// A file of one video stream, being written. All members throw std::runtime_error "WHAT: the
/// system's words".
class OutputFile {
 public:
  OutputFile(const std::string& path, const Container& container, std::string what);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// The stream, of which the caller sets everything before `write_header`.
  [[nodiscard]] AVStream& stream() { return *stream_; }
  /// What is written reaches the file at once, where it survives the death of this process.
  void flush_always();
  void write_header();
  /// `packet`'s times are in units of `time_base`; the packet is empty afterwards.
  void write(AVPacket& packet, AVRational time_base);
  /// Sends `frame` to `codec`, or the end of all where it is null, and writes what comes out.
  void encode(AVCodecContext& codec, const AVFrame* frame);
  /// Writes the end and makes it durable.
  void close();

 private:
  std::string path_;
  std::string what_;
  Settings options_;
  AVFormatContext* format_ = nullptr;
  AVStream* stream_ = nullptr;
  Pointer<AVPacket> packet_;
};

/// Copies the stream of the file at `source` into another file as it is; the first picture's time
/// becomes 0.
void copy_stream(const std::string& source, const std::string& target, const Container& container,
                 const std::string& what);

/// Decodes the file at `path` from its beginning to its end.
void for_each_picture(const std::string& path, const std::string& what,
                      const std::function<void(const AVFrame&)>& action);

}  // namespace qsmpc::libav

// Media files with one video stream, by FFmpeg's libraries. Included only by the .cpp files that
// encode.
#pragma once

#include <exception>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "render/media/byte_file.hpp"
#include "render/media/byte_stream.hpp"
#include "render/media/libav.hpp"

namespace qsmpc::render::libav {

/// Names and values of library options.
using Settings = std::vector<std::pair<std::string, std::string>>;

/// How pictures are encoded.
struct EncoderSettings {
  std::string encoder;  ///< the library's name for it, e.g. "libx264"
  AVPixelFormat pixels = AV_PIX_FMT_YUV420P;
  int width = 0;
  int height = 0;
  int frames_per_second = 0;
  int threads = 1;
  Settings options;
};

/// Throws std::runtime_error "WHAT: …" if there is no such encoder or it rejects an option.
[[nodiscard]] Pointer<AVCodecContext> open_encoder(const EncoderSettings& settings,
                                                   const std::string& what);

/// A frame with memory for a picture of `codec`.
[[nodiscard]] Pointer<AVFrame> allocate_frame(const AVCodecContext& codec, const std::string& what);

/// A container format and its options.
struct Container {
  std::string name;  ///< the library's name for it, e.g. "mp4"
  Settings options;
};

/// An output file with one video stream. All members throw what the file throws, otherwise
/// std::runtime_error "WHAT: the library's message".
class OutputFile {
 public:
  /// Clears `file`, which must outlive this object.
  OutputFile(ByteFile& file, const Container& container, std::string what);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// The stream; the caller sets all its properties before `write_header`.
  [[nodiscard]] AVStream& stream() { return *stream_; }
  /// From now on written data reach the file at once, so that they survive a killed process.
  void flush_always();
  void write_header();
  /// `packet`'s times are in units of `time_base`; the packet is empty afterwards.
  void write(AVPacket& packet, AVRational time_base);
  /// Sends `frame` to `codec` (null: the end of the stream) and writes the resulting packets.
  void encode(AVCodecContext& codec, const AVFrame* frame);
  /// Writes the trailer.
  void close();

 private:
  // To move an index to the front, the library reads back its own output.
  static int open_again(AVFormatContext* format, AVIOContext** io, const char* url, int flags,
                        AVDictionary** options);
  static int close_again(AVFormatContext* format, AVIOContext* io);
  void check_written(int code);

  ByteFile& file_;
  std::string what_;
  Settings options_;
  std::exception_ptr error_;
  std::unique_ptr<ByteStream> io_;
  std::unique_ptr<ByteStream> second_io_;
  AVFormatContext* format_ = nullptr;
  AVStream* stream_ = nullptr;
  Pointer<AVPacket> packet_;
};

/// Copies the stream of `source` unchanged into another file; the first picture's time becomes 0.
/// Throws like OutputFile.
void copy_stream(ByteFile& source, ByteFile& target, const Container& container,
                 const std::string& what);

/// Decodes `file` from its beginning to its end. Throws like OutputFile.
void for_each_picture(ByteFile& file, const std::string& what,
                      const std::function<void(const AVFrame&)>& action);

}  // namespace qsmpc::render::libav

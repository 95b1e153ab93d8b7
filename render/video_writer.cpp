#include "render/video_writer.hpp"

#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

#include "render/libav.hpp"

namespace qsmpc {
namespace {

// A file being written, its format and its name for messages.
class OutputFile {
 public:
  OutputFile(const std::string& path, std::string what) : path_(path), what_(std::move(what)) {
    // "file:" keeps a colon in a path from being read as a protocol.
    const std::string url = "file:" + path;
    libav::check(avformat_alloc_output_context2(&format_, nullptr, "mp4", url.c_str()), what_);
    const int code = avio_open(&format_->pb, url.c_str(), AVIO_FLAG_WRITE);
    if (code < 0) {
      avformat_free_context(format_);
      libav::check(code, what_);
    }
  }

  ~OutputFile() {
    avio_closep(&format_->pb);
    avformat_free_context(format_);
  }
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  AVStream* add_stream() {
    return libav::check_allocated(avformat_new_stream(format_, nullptr), what_);
  }

  void write_header(const char* flags) {
    AVDictionary* settings = nullptr;
    av_dict_set(&settings, "movflags", flags, 0);
    const int code = avformat_write_header(format_, &settings);
    av_dict_free(&settings);
    libav::check(code, what_);
  }

  // Every fragment reaches the file at once, where it survives the death of this process.
  void flush_always() { format_->flags |= AVFMT_FLAG_FLUSH_PACKETS; }

  void write(AVPacket* packet) { libav::check(av_interleaved_write_frame(format_, packet), what_); }

  void close() {
    libav::check(av_write_trailer(format_), what_);
    libav::check(format_->pb->error, what_);
    libav::check(avio_closep(&format_->pb), what_);
  }

  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  std::string path_;
  std::string what_;
  AVFormatContext* format_ = nullptr;
};

struct InputDeleter {
  void operator()(AVFormatContext* format) const { avformat_close_input(&format); }
};
using InputPointer = std::unique_ptr<AVFormatContext, InputDeleter>;

InputPointer open_input(const std::string& path, const std::string& what) {
  AVFormatContext* format = nullptr;
  libav::check(avformat_open_input(&format, ("file:" + path).c_str(), nullptr, nullptr), what);
  InputPointer input(format);
  libav::check(avformat_find_stream_info(format, nullptr), what);
  return input;
}

void flush_to_disk(const std::string& path, const std::string& what) {
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0 || fsync(file) != 0) {
    const int code = AVERROR(errno);
    if (file >= 0) {
      close(file);
    }
    libav::check(code, what);
  }
  close(file);
}

// Copies the fragments of `source` into a plain MP4 whose index comes first.
void remux(const std::string& source, const std::string& target, const std::string& what) {
  const InputPointer input = open_input(source, what);
  OutputFile output(target, what);
  AVStream* const stream = output.add_stream();
  const AVStream* const from = input->streams[0];
  libav::check(avcodec_parameters_copy(stream->codecpar, from->codecpar), what);
  stream->codecpar->codec_tag = 0;
  stream->time_base = from->time_base;
  stream->avg_frame_rate = from->avg_frame_rate;
  output.write_header("+faststart");
  const libav::Pointer<AVPacket> packet(libav::check_allocated(av_packet_alloc(), what));
  std::int64_t begin = AV_NOPTS_VALUE;
  while (true) {
    const int code = av_read_frame(input.get(), packet.get());
    if (code == AVERROR_EOF) {
      break;
    }
    libav::check(code, what);
    // Fragments cannot begin before 0, so reordered frames made the first one late.
    begin = begin == AV_NOPTS_VALUE ? packet->pts : begin;
    packet->pts -= begin;
    packet->dts -= begin;
    av_packet_rescale_ts(packet.get(), from->time_base, stream->time_base);
    packet->pos = -1;
    output.write(packet.get());
  }
  output.close();
}

void check_request(const std::string& what, int width, int height, int frames_per_second) {
  const std::string size = std::to_string(width) + "x" + std::to_string(height);
  if (width <= 0 || height <= 0 || width % 2 != 0 || height % 2 != 0) {
    throw std::invalid_argument(what + ": its size " + size +
                                " must be two positive even numbers of pixels");
  }
  if (frames_per_second <= 0) {
    throw std::invalid_argument(what + ": " + std::to_string(frames_per_second) +
                                " frames a second is not positive");
  }
}

}  // namespace

struct VideoWriter::Encoder {
  std::string path;
  std::string what;
  int frames_per_second;
  libav::Pointer<AVCodecContext> codec;
  libav::Pointer<SwsContext> scaler;
  libav::Pointer<AVFrame> frame;
  libav::Pointer<AVPacket> packet;
  std::unique_ptr<OutputFile> output;
  AVStream* stream = nullptr;
  std::int64_t frames = 0;
  bool failed = false;

  [[nodiscard]] std::string partial_path() const { return path + ".partial"; }

  void open_codec(int width, int height, const VideoOptions& options) {
    const AVCodec* const h264 = avcodec_find_encoder_by_name("libx264");
    if (h264 == nullptr) {
      throw std::runtime_error(what + ": this FFmpeg has no H.264 encoder (libx264)");
    }
    codec.reset(libav::check_allocated(avcodec_alloc_context3(h264), what));
    codec->width = width;
    codec->height = height;
    codec->pix_fmt = AV_PIX_FMT_YUV420P;
    codec->time_base = {1, frames_per_second};
    codec->framerate = {frames_per_second, 1};
    codec->gop_size = frames_per_second;  // a fragment begins at a key frame: one a second
    codec->thread_count = options.threads;
    codec->color_range = AVCOL_RANGE_MPEG;
    codec->color_primaries = AVCOL_PRI_BT709;
    codec->color_trc = AVCOL_TRC_BT709;
    codec->colorspace = AVCOL_SPC_BT709;
    codec->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
    AVDictionary* settings = nullptr;
    av_dict_set(&settings, "preset", options.preset.c_str(), 0);
    av_dict_set_int(&settings, "crf", options.quality, 0);
    const int code = avcodec_open2(codec.get(), h264, &settings);
    av_dict_free(&settings);
    libav::check(code, what);
  }

  void open_converter() {
    frame.reset(libav::check_allocated(av_frame_alloc(), what));
    frame->width = codec->width;
    frame->height = codec->height;
    frame->format = codec->pix_fmt;
    libav::check(av_frame_get_buffer(frame.get(), 0), what);
    packet.reset(libav::check_allocated(av_packet_alloc(), what));
    scaler.reset(libav::check_allocated(
        sws_getContext(codec->width, codec->height, AV_PIX_FMT_RGB24, codec->width, codec->height,
                       codec->pix_fmt, SWS_BILINEAR, nullptr, nullptr, nullptr),
        what));
    constexpr int kUnity = 1 << 16;  // contrast and saturation as they are
    sws_setColorspaceDetails(scaler.get(), sws_getCoefficients(SWS_CS_DEFAULT), 1,
                             sws_getCoefficients(SWS_CS_ITU709), 0, 0, kUnity, kUnity);
  }

  void open_output() {
    output = std::make_unique<OutputFile>(partial_path(), what);
    stream = output->add_stream();
    stream->time_base = codec->time_base;
    stream->avg_frame_rate = codec->framerate;
    libav::check(avcodec_parameters_from_context(stream->codecpar, codec.get()), what);
    output->flush_always();
    output->write_header("+frag_keyframe+empty_moov+default_base_moof");
  }

  // Sends one frame, or the end of all where `next` is null, and writes what comes out.
  void encode(const AVFrame* next) {
    libav::check(avcodec_send_frame(codec.get(), next), what);
    while (true) {
      const int code = avcodec_receive_packet(codec.get(), packet.get());
      if (code == AVERROR(EAGAIN) || code == AVERROR_EOF) {
        return;
      }
      libav::check(code, what);
      packet->duration = 1;
      av_packet_rescale_ts(packet.get(), codec->time_base, stream->time_base);
      packet->stream_index = stream->index;
      output->write(packet.get());
    }
  }

  void close_partial() {
    encode(nullptr);
    output->close();
    output.reset();
  }
};

VideoWriter::VideoWriter(const std::string& path, int width, int height, int frames_per_second,
                         const VideoOptions& options)
    : encoder_(std::make_unique<Encoder>()) {
  encoder_->path = path;
  encoder_->what = "video \"" + path + "\"";
  encoder_->frames_per_second = frames_per_second;
  check_request(encoder_->what, width, height, frames_per_second);
  libav::silence_log();
  encoder_->open_codec(width, height, options);
  encoder_->open_converter();
  encoder_->open_output();
}

VideoWriter::~VideoWriter() {
  if (encoder_->output == nullptr || encoder_->failed) {
    return;
  }
  try {
    encoder_->close_partial();
  } catch (const std::exception&) {
    // What reached the file before stays playable; a destructor has nobody to tell.
    encoder_->failed = true;
  }
}

void VideoWriter::add(const Image& image) {
  Encoder& e = *encoder_;
  const auto pixels =
      static_cast<std::size_t>(e.codec->width) * static_cast<std::size_t>(e.codec->height);
  if (image.width != e.codec->width || image.height != e.codec->height ||
      image.rgb.size() != 3 * pixels) {
    throw std::invalid_argument(e.what + ": a frame of " + std::to_string(image.width) + "x" +
                                std::to_string(image.height) + " pixels does not fit");
  }
  if (e.output == nullptr || e.failed) {
    throw std::runtime_error(e.what + ": it is finished or has failed");
  }
  try {
    libav::check(av_frame_make_writable(e.frame.get()), e.what);
    const std::array<const unsigned char*, 1> planes{image.rgb.data()};
    const std::array<int, 1> strides{3 * image.width};
    sws_scale(e.scaler.get(), planes.data(), strides.data(), 0, image.height, e.frame->data,
              e.frame->linesize);
    e.frame->pts = e.frames++;
    e.encode(e.frame.get());
  } catch (...) {
    e.failed = true;
    throw;
  }
}

void VideoWriter::finish() {
  Encoder& e = *encoder_;
  if (e.output == nullptr || e.failed || e.frames == 0) {
    throw std::runtime_error(e.what + ": there is nothing to finish");
  }
  const std::string aside = e.path + ".remux.partial";
  try {
    e.close_partial();
    remux(e.partial_path(), aside, e.what);
    flush_to_disk(aside, e.what);
    if (std::rename(aside.c_str(), e.path.c_str()) != 0) {
      libav::check(AVERROR(errno), e.what);
    }
  } catch (...) {
    e.failed = true;
    std::remove(aside.c_str());
    throw;
  }
  std::remove(e.partial_path().c_str());
}

}  // namespace qsmpc

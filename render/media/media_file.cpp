#include "render/media/media_file.hpp"

#include <cerrno>
#include <cstdint>
#include <memory>
#include <stdexcept>

#include <fcntl.h>
#include <unistd.h>

namespace qsmpc::libav {
namespace {

// "file:" keeps a colon in a path from being read as a protocol.
std::string url_of(const std::string& path) { return "file:" + path; }

class Dictionary {
 public:
  explicit Dictionary(const Settings& settings) {
    for (const auto& [name, value] : settings) {
      av_dict_set(&dictionary_, name.c_str(), value.c_str(), 0);
    }
  }
  ~Dictionary() { av_dict_free(&dictionary_); }
  Dictionary(const Dictionary&) = delete;
  Dictionary& operator=(const Dictionary&) = delete;

  AVDictionary** get() { return &dictionary_; }

  // What nobody took, which is a mistake in this program or another version of the library.
  void check_empty(const std::string& what) const {
    const AVDictionaryEntry* const left =
        av_dict_get(dictionary_, "", nullptr, AV_DICT_IGNORE_SUFFIX);
    if (left != nullptr) {
      throw std::runtime_error(what + ": this FFmpeg has no option \"" + left->key + "\"");
    }
  }

 private:
  AVDictionary* dictionary_ = nullptr;
};

struct InputDeleter {
  void operator()(AVFormatContext* format) const { avformat_close_input(&format); }
};
using InputPointer = std::unique_ptr<AVFormatContext, InputDeleter>;

InputPointer open_input(const std::string& path, const std::string& what) {
  AVFormatContext* format = nullptr;
  check(avformat_open_input(&format, url_of(path).c_str(), nullptr, nullptr), what);
  InputPointer input(format);
  check(avformat_find_stream_info(format, nullptr), what);
  return input;
}

// Whether there was another packet.
bool read_packet(AVFormatContext& input, AVPacket& packet, const std::string& what) {
  const int code = av_read_frame(&input, &packet);
  if (code == AVERROR_EOF) {
    return false;
  }
  check(code, what);
  return true;
}

void flush_to_disk(const std::string& path, const std::string& what) {
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0 || fsync(file) != 0) {
    const int code = AVERROR(errno);
    if (file >= 0) {
      ::close(file);
    }
    check(code, what);
  }
  ::close(file);
}

}  // namespace

Pointer<AVCodecContext> open_encoder(const EncoderSettings& settings, const std::string& what) {
  const AVCodec* const encoder = avcodec_find_encoder_by_name(settings.encoder.c_str());
  if (encoder == nullptr) {
    throw std::runtime_error(what + ": this FFmpeg has no encoder \"" + settings.encoder + "\"");
  }
  Pointer<AVCodecContext> codec(check_allocated(avcodec_alloc_context3(encoder), what));
  codec->width = settings.width;
  codec->height = settings.height;
  codec->pix_fmt = settings.pixels;
  codec->time_base = {1, settings.frames_per_second};
  codec->framerate = {settings.frames_per_second, 1};
  codec->gop_size = settings.frames_per_second;  // a fragment begins at a key frame: one a second
  codec->thread_count = settings.threads;
  if (settings.pixels == AV_PIX_FMT_YUV420P) {
    codec->color_range = AVCOL_RANGE_MPEG;
    codec->color_primaries = AVCOL_PRI_BT709;
    codec->color_trc = AVCOL_TRC_BT709;
    codec->colorspace = AVCOL_SPC_BT709;
  }
  codec->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
  Dictionary options(settings.options);
  check(avcodec_open2(codec.get(), encoder, options.get()), what);
  options.check_empty(what);
  return codec;
}

Pointer<AVFrame> allocate_frame(const AVCodecContext& codec, const std::string& what) {
  Pointer<AVFrame> frame(check_allocated(av_frame_alloc(), what));
  frame->width = codec.width;
  frame->height = codec.height;
  frame->format = codec.pix_fmt;
  check(av_frame_get_buffer(frame.get(), 0), what);
  return frame;
}

OutputFile::OutputFile(const std::string& path, const Container& container, std::string what)
    : path_(path),
      what_(std::move(what)),
      options_(container.options),
      packet_(check_allocated(av_packet_alloc(), what_)) {
  const std::string url = url_of(path);
  check(avformat_alloc_output_context2(&format_, nullptr, container.name.c_str(), url.c_str()),
        what_);
  const int code = avio_open(&format_->pb, url.c_str(), AVIO_FLAG_WRITE);
  stream_ = code < 0 ? nullptr : avformat_new_stream(format_, nullptr);
  if (stream_ == nullptr) {
    avio_closep(&format_->pb);
    avformat_free_context(format_);
    check(code, what_);
    check(AVERROR(ENOMEM), what_);
  }
}

OutputFile::~OutputFile() {
  avio_closep(&format_->pb);
  avformat_free_context(format_);
}

void OutputFile::flush_always() { format_->flags |= AVFMT_FLAG_FLUSH_PACKETS; }

void OutputFile::write_header() {
  Dictionary options(options_);
  check(avformat_write_header(format_, options.get()), what_);
  options.check_empty(what_);
}

void OutputFile::write(AVPacket& packet, AVRational time_base) {
  av_packet_rescale_ts(&packet, time_base, stream_->time_base);
  packet.stream_index = stream_->index;
  packet.pos = -1;
  check(av_interleaved_write_frame(format_, &packet), what_);
}

void OutputFile::encode(AVCodecContext& codec, const AVFrame* frame) {
  check(avcodec_send_frame(&codec, frame), what_);
  while (true) {
    const int code = avcodec_receive_packet(&codec, packet_.get());
    if (code == AVERROR(EAGAIN) || code == AVERROR_EOF) {
      return;
    }
    check(code, what_);
    packet_->duration = 1;
    write(*packet_, codec.time_base);
  }
}

void OutputFile::close() {
  check(av_write_trailer(format_), what_);
  check(format_->pb->error, what_);
  check(avio_closep(&format_->pb), what_);
  flush_to_disk(path_, what_);
}

void copy_stream(const std::string& source, const std::string& target, const Container& container,
                 const std::string& what) {
  const InputPointer input = open_input(source, what);
  OutputFile output(target, container, what);
  const AVStream& from = *input->streams[0];
  AVStream& to = output.stream();
  check(avcodec_parameters_copy(to.codecpar, from.codecpar), what);
  to.codecpar->codec_tag = 0;
  to.time_base = from.time_base;
  to.avg_frame_rate = from.avg_frame_rate;
  output.write_header();
  const Pointer<AVPacket> packet(check_allocated(av_packet_alloc(), what));
  std::int64_t begin = AV_NOPTS_VALUE;
  while (read_packet(*input, *packet, what)) {
    // Fragments cannot begin before 0, so reordered frames made the first one late.
    begin = begin == AV_NOPTS_VALUE ? packet->pts : begin;
    packet->pts -= begin;
    packet->dts -= begin;
    output.write(*packet, from.time_base);
  }
  output.close();
}

void for_each_picture(const std::string& path, const std::string& what,
                      const std::function<void(const AVFrame&)>& action) {
  const InputPointer input = open_input(path, what);
  const AVCodecParameters& parameters = *input->streams[0]->codecpar;
  const AVCodec* const decoder = avcodec_find_decoder(parameters.codec_id);
  if (decoder == nullptr) {
    throw std::runtime_error(what + ": this FFmpeg cannot read \"" + path + "\"");
  }
  const Pointer<AVCodecContext> codec(check_allocated(avcodec_alloc_context3(decoder), what));
  check(avcodec_parameters_to_context(codec.get(), &parameters), what);
  check(avcodec_open2(codec.get(), decoder, nullptr), what);
  const Pointer<AVFrame> frame(check_allocated(av_frame_alloc(), what));
  const Pointer<AVPacket> packet(check_allocated(av_packet_alloc(), what));
  bool more = true;
  while (more) {
    more = read_packet(*input, *packet, what);
    check(avcodec_send_packet(codec.get(), more ? packet.get() : nullptr), what);
    av_packet_unref(packet.get());
    int code = avcodec_receive_frame(codec.get(), frame.get());
    for (; code >= 0; code = avcodec_receive_frame(codec.get(), frame.get())) {
      action(*frame);
    }
    check(code == AVERROR(EAGAIN) || code == AVERROR_EOF ? 0 : code, what);
  }
}

}  // namespace qsmpc::libav

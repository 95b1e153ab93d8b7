#include "render/media/media_file.hpp"

#include <cerrno>
#include <cstdint>
#include <stdexcept>

namespace qsmpc::render::libav {
namespace {

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

  // Throws if an option was not used: a mistake in this program or another version of the library.
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

// Rethrows what a file threw meanwhile, otherwise checks `code`.
int check_stream(int code, const std::exception_ptr& error, const std::string& what) {
  if (error) std::rethrow_exception(error);
  return check(code, what);
}

// An input file with one video stream.
class InputFile {
 public:
  InputFile(ByteFile& file, std::string what)
      : what_(std::move(what)), io_(file, ByteStream::Use::kRead, error_, what_) {
    format_ = check_allocated(avformat_alloc_context(), what_);
    format_->pb = io_.context();
    // Frees the format on failure.
    check_stream(avformat_open_input(&format_, nullptr, nullptr, nullptr), error_, what_);
    const int code = avformat_find_stream_info(format_, nullptr);
    if (code < 0 || error_) avformat_close_input(&format_);
    check_stream(code, error_, what_);
  }
  ~InputFile() { avformat_close_input(&format_); }
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  [[nodiscard]] const AVStream& stream() const { return *format_->streams[0]; }

  // Reads the next packet; returns whether there was one.
  bool read(AVPacket& packet) {
    const int code = av_read_frame(format_, &packet);
    if (code == AVERROR_EOF && !error_) return false;
    check_stream(code, error_, what_);
    return true;
  }

 private:
  std::string what_;
  std::exception_ptr error_;
  ByteStream io_;
  AVFormatContext* format_ = nullptr;
};

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
  codec->gop_size = settings.frames_per_second;  // a fragment begins at a key frame: one per second
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

OutputFile::OutputFile(ByteFile& file, const Container& container, std::string what)
    : file_(file),
      what_(std::move(what)),
      options_(container.options),
      io_(std::make_unique<ByteStream>(file, ByteStream::Use::kWrite, error_, what_)),
      packet_(check_allocated(av_packet_alloc(), what_)) {
  file_.clear();
  check(avformat_alloc_output_context2(&format_, nullptr, container.name.c_str(), nullptr), what_);
  format_->pb = io_->context();
  format_->flags |= AVFMT_FLAG_CUSTOM_IO;
  format_->opaque = this;
  format_->io_open = open_again;
  format_->io_close2 = close_again;
  stream_ = avformat_new_stream(format_, nullptr);
  if (stream_ == nullptr) {
    avformat_free_context(format_);
    check(AVERROR(ENOMEM), what_);
  }
}

OutputFile::~OutputFile() { avformat_free_context(format_); }

int OutputFile::open_again(AVFormatContext* format, AVIOContext** io, const char* /*url*/,
                           int flags, AVDictionary** /*options*/) {
  auto& self = *static_cast<OutputFile*>(format->opaque);
  if ((flags & AVIO_FLAG_WRITE) != 0 || self.second_io_) return AVERROR(ENOSYS);
  try {
    self.second_io_ =
        std::make_unique<ByteStream>(self.file_, ByteStream::Use::kRead, self.error_, self.what_);
  } catch (...) {
    return AVERROR(ENOMEM);
  }
  *io = self.second_io_->context();
  return 0;
}

int OutputFile::close_again(AVFormatContext* format, AVIOContext* /*io*/) {
  static_cast<OutputFile*>(format->opaque)->second_io_.reset();
  return 0;
}

void OutputFile::check_written(int code) { check_stream(code, error_, what_); }

void OutputFile::flush_always() { format_->flags |= AVFMT_FLAG_FLUSH_PACKETS; }

void OutputFile::write_header() {
  Dictionary options(options_);
  check_written(avformat_write_header(format_, options.get()));
  options.check_empty(what_);
}

void OutputFile::write(AVPacket& packet, AVRational time_base) {
  av_packet_rescale_ts(&packet, time_base, stream_->time_base);
  packet.stream_index = stream_->index;
  packet.pos = -1;
  check_written(av_interleaved_write_frame(format_, &packet));
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
  check_written(av_write_trailer(format_));
  avio_flush(format_->pb);
  check_written(format_->pb->error);
}

void copy_stream(ByteFile& source, ByteFile& target, const Container& container,
                 const std::string& what) {
  InputFile input(source, what);
  OutputFile output(target, container, what);
  const AVStream& from = input.stream();
  AVStream& to = output.stream();
  check(avcodec_parameters_copy(to.codecpar, from.codecpar), what);
  to.codecpar->codec_tag = 0;
  to.time_base = from.time_base;
  to.avg_frame_rate = from.avg_frame_rate;
  output.write_header();
  const Pointer<AVPacket> packet(check_allocated(av_packet_alloc(), what));
  std::int64_t begin = AV_NOPTS_VALUE;
  while (input.read(*packet)) {
    // Fragments cannot begin before 0, so reordered frames delayed the first one.
    begin = begin == AV_NOPTS_VALUE ? packet->pts : begin;
    packet->pts -= begin;
    packet->dts -= begin;
    output.write(*packet, from.time_base);
  }
  output.close();
}

void for_each_picture(ByteFile& file, const std::string& what,
                      const std::function<void(const AVFrame&)>& action) {
  InputFile input(file, what);
  const AVCodecParameters& parameters = *input.stream().codecpar;
  const AVCodec* const decoder = avcodec_find_decoder(parameters.codec_id);
  if (decoder == nullptr) {
    throw std::runtime_error(what + ": this FFmpeg cannot read what it wrote");
  }
  const Pointer<AVCodecContext> codec(check_allocated(avcodec_alloc_context3(decoder), what));
  check(avcodec_parameters_to_context(codec.get(), &parameters), what);
  check(avcodec_open2(codec.get(), decoder, nullptr), what);
  const Pointer<AVFrame> frame(check_allocated(av_frame_alloc(), what));
  const Pointer<AVPacket> packet(check_allocated(av_packet_alloc(), what));
  bool more = true;
  while (more) {
    more = input.read(*packet);
    check(avcodec_send_packet(codec.get(), more ? packet.get() : nullptr), what);
    av_packet_unref(packet.get());
    int code = avcodec_receive_frame(codec.get(), frame.get());
    for (; code >= 0; code = avcodec_receive_frame(codec.get(), frame.get())) {
      action(*frame);
    }
    check(code == AVERROR(EAGAIN) || code == AVERROR_EOF ? 0 : code, what);
  }
}

}  // namespace qsmpc::render::libav

#include "render/media/video_writer.hpp"

#include <array>
#include <cerrno>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <stdexcept>

#include "render/media/animated_picture.hpp"
#include "render/media/media_file.hpp"

namespace qsmpc {
namespace {

// `best` at quality 100, `worst` at quality 0, and between them in proportion.
int on_scale(int quality, double best, double worst) {
  return static_cast<int>(std::lround(best + (worst - best) * (kBestQuality - quality) / 100.0));
}

VideoFormat chosen_format(const std::string& path, const VideoOptions& options,
                          const std::string& what) {
  const std::optional<VideoFormat> format = options.format ? options.format : video_format_of(path);
  if (!format) {
    std::string known;
    for (const std::string& name : video_format_names()) {
      known += (known.empty() ? "." : ", .") + name;
    }
    throw std::invalid_argument(what + ": its name must end with one of " + known);
  }
  return *format;
}

void check_request(const std::string& what, const libav::EncoderSettings& wanted,
                   const VideoOptions& options, VideoFormat format) {
  const int fps = wanted.frames_per_second;
  if (wanted.width <= 0 || wanted.height <= 0 || wanted.width % 2 != 0 || wanted.height % 2 != 0) {
    throw std::invalid_argument(what + ": its size " + std::to_string(wanted.width) + "x" +
                                std::to_string(wanted.height) +
                                " must be two positive even numbers of pixels");
  }
  if (fps <= 0) {
    throw std::invalid_argument(what + ": " + std::to_string(fps) +
                                " frames a second is not positive");
  }
  if (fps > most_frames_per_second(format)) {
    throw std::invalid_argument(what + ": " + std::to_string(fps) +
                                " frames a second are more than " +
                                std::to_string(most_frames_per_second(format)));
  }
  if (options.quality < 0 || options.quality > kBestQuality) {
    throw std::invalid_argument(what + ": a quality of " + std::to_string(options.quality) +
                                " is not within 0 … 100");
  }
}

libav::Settings fragments() {
  return {{"movflags", "+frag_keyframe+empty_moov+default_base_moof"}};
}

// How the partial file is written, and how a finished one is where it holds the same pictures.
struct Recipe {
  std::string encoder;
  AVPixelFormat pixels = AV_PIX_FMT_YUV420P;
  libav::Settings options;
  libav::Container partial;
  libav::Container finished;
};

Recipe recipe_of(VideoFormat format, const VideoOptions& options) {
  switch (format) {
    case VideoFormat::kMp4:
      return {.encoder = "libx264",
              .options = {{"preset", options.preset},
                          // A quarter of its time for a twentieth of the size.
                          {"bf", "0"},
                          {"crf", std::to_string(on_scale(options.quality, 1.0, 48.5))}},
              .partial = {"mp4", fragments()},
              .finished = {"mp4", {{"movflags", "+faststart"}}}};
    case VideoFormat::kWebm:
      return {.encoder = "libvpx-vp9",
              .options = {{"deadline", "realtime"},
                          {"cpu-used", "8"},
                          {"lag-in-frames", "0"},  // a killed process has written what it was given
                          {"row-mt", "1"},
                          {"tile-columns", "2"},
                          {"b", "0"},
                          {"crf", std::to_string(on_scale(options.quality, 4.0, 59.0))}},
              .partial = {"webm", {{"cluster_time_limit", "1000"}}},
              .finished = {"webm", {{"cues_to_front", "1"}}}};
    case VideoFormat::kGif:
    case VideoFormat::kWebp:
      break;
  }
  return {.encoder = "libx264rgb",
          .pixels = AV_PIX_FMT_RGB24,
          .options = {{"preset", "ultrafast"}, {"qp", "0"}},
          .partial = {"mp4", fragments()},
          .finished = {}};
}

}  // namespace

struct VideoWriter::Encoder {
  std::string path;
  std::string what;
  VideoFormat format;
  int frames_per_second;
  int quality;
  Recipe recipe;
  libav::Pointer<AVCodecContext> codec;
  libav::Pointer<SwsContext> scaler;
  libav::Pointer<AVFrame> frame;
  std::unique_ptr<libav::OutputFile> output;
  std::int64_t frames = 0;
  bool failed = false;

  [[nodiscard]] std::string partial_path() const { return path + ".partial"; }

  void open_converter() {
    frame = libav::allocate_frame(*codec, what);
    scaler.reset(libav::check_allocated(
        sws_getContext(codec->width, codec->height, AV_PIX_FMT_RGB24, codec->width, codec->height,
                       codec->pix_fmt, SWS_BILINEAR, nullptr, nullptr, nullptr),
        what));
    constexpr int kUnity = 1 << 16;  // contrast and saturation as they are
    sws_setColorspaceDetails(scaler.get(), sws_getCoefficients(SWS_CS_DEFAULT), 1,
                             sws_getCoefficients(SWS_CS_ITU709), 0, 0, kUnity, kUnity);
  }

  void open_output() {
    output = std::make_unique<libav::OutputFile>(partial_path(), recipe.partial, what);
    AVStream& stream = output->stream();
    stream.time_base = codec->time_base;
    stream.avg_frame_rate = codec->framerate;
    libav::check(avcodec_parameters_from_context(stream.codecpar, codec.get()), what);
    output->flush_always();
    output->write_header();
  }

  void close_partial() {
    output->encode(*codec, nullptr);
    output->close();
    output.reset();
  }

  void write_finished(const std::string& target) const {
    if (is_animated_picture(format)) {
      write_animated_picture(
          {.format = format, .frames_per_second = frames_per_second, .quality = quality},
          partial_path(), target, what);
    } else {
      libav::copy_stream(partial_path(), target, recipe.finished, what);
    }
  }
};

VideoWriter::VideoWriter(const std::string& path, int width, int height, int frames_per_second,
                         const VideoOptions& options)
    : encoder_(std::make_unique<Encoder>()) {
  Encoder& e = *encoder_;
  e.path = path;
  e.what = "video \"" + path + "\"";
  e.format = chosen_format(path, options, e.what);
  e.frames_per_second = frames_per_second;
  e.quality = options.quality;
  e.recipe = recipe_of(e.format, options);
  const libav::EncoderSettings settings{.encoder = e.recipe.encoder,
                                        .pixels = e.recipe.pixels,
                                        .width = width,
                                        .height = height,
                                        .frames_per_second = frames_per_second,
                                        .threads = options.threads,
                                        .options = e.recipe.options};
  check_request(e.what, settings, options, e.format);
  libav::silence_log();
  e.codec = libav::open_encoder(settings, e.what);
  e.open_converter();
  e.open_output();
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

VideoFormat VideoWriter::format() const { return encoder_->format; }

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
    e.output->encode(*e.codec, e.frame.get());
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
  const std::string aside = e.path + ".finished.partial";
  try {
    e.close_partial();
    e.write_finished(aside);
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

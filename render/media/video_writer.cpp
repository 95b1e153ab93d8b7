#include "render/media/video_writer.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>

#include "render/media/animated_picture.hpp"
#include "render/media/media_file.hpp"

namespace qsmpc::render {
namespace {

// Interpolates linearly from `worst` at quality 0 to `best` at quality 100.
int on_scale(int quality, double best, double worst) {
  return static_cast<int>(std::lround(best + (worst - best) * (kBestQuality - quality) / 100.0));
}

void check_request(const std::string& what, const VideoSettings& wanted) {
  const int fps = wanted.frames_per_second;
  if (wanted.width <= 0 || wanted.height <= 0 || wanted.width % 2 != 0 || wanted.height % 2 != 0) {
    throw std::invalid_argument(what + ": its size " + std::to_string(wanted.width) + "x" +
                                std::to_string(wanted.height) +
                                " must be two positive even numbers of pixels");
  }
  if (fps <= 0) {
    throw std::invalid_argument(what + ": " + std::to_string(fps) +
                                " frames per second is not positive");
  }
  if (fps > most_frames_per_second(wanted.format)) {
    throw std::invalid_argument(what + ": " + std::to_string(fps) +
                                " frames per second is more than " +
                                std::to_string(most_frames_per_second(wanted.format)));
  }
  if (wanted.quality < 0 || wanted.quality > kBestQuality) {
    throw std::invalid_argument(what + ": a quality of " + std::to_string(wanted.quality) +
                                " is not within 0 … 100");
  }
}

libav::Settings fragments() {
  return {{"movflags", "+frag_keyframe+empty_moov+default_base_moof"}};
}

// Settings of the partial file, and of a finished file that contains the same pictures.
struct Recipe {
  std::string encoder;
  AVPixelFormat pixels = AV_PIX_FMT_YUV420P;
  libav::Settings options;
  libav::Container partial;
  libav::Container finished;
};

Recipe recipe_of(const VideoSettings& options) {
  switch (options.format) {
    case VideoFormat::kMp4:
      return {.encoder = "libx264",
              .options = {{"preset", options.preset},
                          // No B-frames: a quarter less time for a file a twentieth larger.
                          {"bf", "0"},
                          {"crf", std::to_string(on_scale(options.quality, 1.0, 48.5))}},
              .partial = {"mp4", fragments()},
              .finished = {"mp4", {{"movflags", "+faststart"}}}};
    case VideoFormat::kWebm:
      return {.encoder = "libvpx-vp9",
              .options = {{"deadline", "realtime"},
                          {"cpu-used", "8"},
                          {"lag-in-frames", "0"},  // a killed process has written its frames
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
  ByteFile& partial;
  VideoSettings settings;
  std::string what;
  Recipe recipe{};
  libav::Pointer<AVCodecContext> codec{};
  libav::Pointer<SwsContext> scaler{};
  libav::Pointer<AVFrame> frame{};
  std::unique_ptr<libav::OutputFile> output{};
  std::int64_t frames = 0;
  bool failed = false;

  void open_converter() {
    frame = libav::allocate_frame(*codec, what);
    scaler.reset(libav::check_allocated(
        sws_getContext(codec->width, codec->height, AV_PIX_FMT_RGB24, codec->width, codec->height,
                       codec->pix_fmt, SWS_BILINEAR, nullptr, nullptr, nullptr),
        what));
    constexpr int kUnity = 1 << 16;  // contrast and saturation unchanged
    sws_setColorspaceDetails(scaler.get(), sws_getCoefficients(SWS_CS_DEFAULT), 1,
                             sws_getCoefficients(SWS_CS_ITU709), 0, 0, kUnity, kUnity);
  }

  void open_output() {
    output = std::make_unique<libav::OutputFile>(partial, recipe.partial, what);
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

  void write_finished(ByteFile& target) const {
    if (is_animated_picture(settings.format)) {
      write_animated_picture({.format = settings.format,
                              .frames_per_second = settings.frames_per_second,
                              .quality = settings.quality},
                             partial, target, what);
    } else {
      libav::copy_stream(partial, target, recipe.finished, what);
    }
  }
};

VideoWriter::VideoWriter(ByteFile& partial, const VideoSettings& settings)
    : encoder_(new Encoder{
          .partial = partial, .settings = settings, .what = "video \"" + settings.name + "\""}) {
  Encoder& e = *encoder_;
  check_request(e.what, settings);
  e.recipe = recipe_of(settings);
  libav::silence_log();
  e.codec = libav::open_encoder({.encoder = e.recipe.encoder,
                                 .pixels = e.recipe.pixels,
                                 .width = settings.width,
                                 .height = settings.height,
                                 .frames_per_second = settings.frames_per_second,
                                 .threads = settings.threads,
                                 .options = e.recipe.options},
                                e.what);
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
    // Earlier data in the file stay playable; a destructor cannot report the error.
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
                                std::to_string(image.height) + " pixels does not match the video");
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

void VideoWriter::finish(ByteFile& finished) {
  Encoder& e = *encoder_;
  if (e.output == nullptr || e.failed || e.frames == 0) {
    throw std::runtime_error(e.what + ": there is nothing to finish");
  }
  try {
    e.close_partial();
    e.write_finished(finished);
  } catch (...) {
    e.failed = true;
    throw;
  }
}

}  // namespace qsmpc::render

#include "render/media/animated_picture.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <stdexcept>
#include <vector>

#include "render/media/gif_palette.hpp"
#include "render/media/media_file.hpp"

namespace qsmpc::render {
namespace {

constexpr int kMostColours = 255;  // a GIF has 256; one stays transparent
constexpr int kFewestColours = 31;

// Converts pictures to 4 bytes per pixel, in the order of `format`.
class Converter {
 public:
  Converter(AVPixelFormat format, std::string what) : format_(format), what_(std::move(what)) {}

  void convert(const AVFrame& frame, unsigned char* out, int stride) {
    scaler_.reset(libav::check_allocated(
        sws_getCachedContext(scaler_.release(), frame.width, frame.height,
                             static_cast<AVPixelFormat>(frame.format), frame.width, frame.height,
                             format_, SWS_POINT, nullptr, nullptr, nullptr),
        what_));
    const std::array<unsigned char*, 1> planes{out};
    const std::array<int, 1> strides{stride};
    libav::check(sws_scale(scaler_.get(), frame.data, frame.linesize, 0, frame.height,
                           planes.data(), strides.data()),
                 what_);
  }

 private:
  AVPixelFormat format_;
  std::string what_;
  libav::Pointer<SwsContext> scaler_;
};

// The output file, opened once the first picture gives its size.
class PictureFile {
 public:
  PictureFile(ByteFile& target, std::string container, std::string what)
      : target_(target), container_(std::move(container)), what_(std::move(what)) {}

  [[nodiscard]] bool is_open() const { return output_.has_value(); }

  void open(const libav::EncoderSettings& settings) {
    codec_ = libav::open_encoder(settings, what_);
    frame_ = libav::allocate_frame(*codec_, what_);
    output_.emplace(target_, libav::Container{container_, {{"loop", "0"}}}, what_);
    AVStream& stream = output_->stream();
    stream.time_base = codec_->time_base;
    stream.avg_frame_rate = codec_->framerate;
    libav::check(avcodec_parameters_from_context(stream.codecpar, codec_.get()), what_);
    output_->write_header();
  }

  // The frame to fill and then add.
  AVFrame& next() {
    // A new frame each time: an encoder may keep the previous one.
    frame_ = libav::allocate_frame(*codec_, what_);
    frame_->pts = frames_++;
    return *frame_;
  }

  void add() { output_->encode(*codec_, frame_.get()); }

  void close() {
    if (!is_open()) {
      throw std::runtime_error(what_ + ": no picture could be read back");
    }
    output_->encode(*codec_, nullptr);
    output_->close();
  }

 private:
  ByteFile& target_;
  std::string container_;
  std::string what_;
  libav::Pointer<AVCodecContext> codec_;
  libav::Pointer<AVFrame> frame_;
  std::optional<libav::OutputFile> output_;
  std::int64_t frames_ = 0;
};

int colour_count(int quality) {
  const int share = std::min(quality, kUsualQuality);
  return kFewestColours + (kMostColours - kFewestColours) * share / kUsualQuality;
}

std::vector<std::uint32_t> best_palette(ByteFile& source, int colours, const std::string& what) {
  ColourCount count;
  Converter converter(AV_PIX_FMT_RGBA, what);
  std::vector<unsigned char> rgba;
  libav::for_each_picture(source, what, [&](const AVFrame& frame) {
    rgba.resize(4 * static_cast<std::size_t>(frame.width) * static_cast<std::size_t>(frame.height));
    converter.convert(frame, rgba.data(), 4 * frame.width);
    count.add(rgba, frame.width, frame.height);
  });
  return count.best(colours);
}

void write_gif(const AnimatedPicture& wanted, ByteFile& source, ByteFile& target,
               const std::string& what) {
  const std::vector<std::uint32_t> palette =
      best_palette(source, colour_count(wanted.quality), what);
  PaletteMap map(palette);
  Converter converter(AV_PIX_FMT_RGBA, what);
  PictureFile file(target, "gif", what);
  std::vector<unsigned char> rgba;
  libav::for_each_picture(source, what, [&](const AVFrame& frame) {
    if (!file.is_open()) {
      file.open({.encoder = "gif",
                 .pixels = AV_PIX_FMT_PAL8,
                 .width = frame.width,
                 .height = frame.height,
                 .frames_per_second = wanted.frames_per_second,
                 .options = {}});
    }
    const auto width = static_cast<std::size_t>(frame.width);
    rgba.resize(4 * width * static_cast<std::size_t>(frame.height));
    converter.convert(frame, rgba.data(), 4 * frame.width);
    AVFrame& out = file.next();
    // Unused entries stay 0, which is transparent: unchanged pixels are left out.
    auto* const entries = reinterpret_cast<std::uint32_t*>(out.data[1]);
    std::fill_n(entries, kMostColours + 1, 0U);
    std::copy(palette.begin(), palette.end(), entries);
    for (int y = 0; y < frame.height; ++y) {
      unsigned char* const row = out.data[0] + static_cast<std::ptrdiff_t>(y) * out.linesize[0];
      const unsigned char* const from = rgba.data() + static_cast<std::size_t>(y) * 4 * width;
      for (int x = 0; x < frame.width; ++x) {
        row[x] = map.index(from + static_cast<std::ptrdiff_t>(4) * x, x, y);
      }
    }
    file.add();
  });
  file.close();
}

void write_webp(const AnimatedPicture& wanted, ByteFile& source, ByteFile& target,
                const std::string& what) {
  // libwebp's own scale is steeper: its 75 looks like 60 here.
  constexpr double kStretch = 0.625;
  const double quality = kBestQuality - kStretch * (kBestQuality - wanted.quality);
  Converter converter(AV_PIX_FMT_RGB32, what);
  PictureFile file(target, "webp", what);
  libav::for_each_picture(source, what, [&](const AVFrame& frame) {
    if (!file.is_open()) {
      file.open({.encoder = "libwebp_anim",
                 .pixels = AV_PIX_FMT_RGB32,
                 .width = frame.width,
                 .height = frame.height,
                 .frames_per_second = wanted.frames_per_second,
                 .options = {{"quality", std::to_string(quality)}}});
    }
    AVFrame& out = file.next();
    converter.convert(frame, out.data[0], out.linesize[0]);
    file.add();
  });
  file.close();
}

}  // namespace

void write_animated_picture(const AnimatedPicture& wanted, ByteFile& source, ByteFile& target,
                            const std::string& what) {
  switch (wanted.format) {
    case VideoFormat::kGif:
      return write_gif(wanted, source, target, what);
    case VideoFormat::kWebp:
      return write_webp(wanted, source, target, what);
    case VideoFormat::kMp4:
    case VideoFormat::kWebm:
      break;
  }
  throw std::invalid_argument(what + ": " + video_format_name(wanted.format) +
                              " is not an animated picture format");
}

}  // namespace qsmpc::render

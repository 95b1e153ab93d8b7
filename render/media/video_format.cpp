#include "render/media/video_format.hpp"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <stdexcept>

namespace qsmpc::render {

const std::vector<std::string>& video_format_names() {
  static const std::vector<std::string> names{"mp4", "webm", "gif", "webp"};
  return names;
}

const std::string& video_format_name(VideoFormat format) {
  return video_format_names().at(static_cast<std::size_t>(format));
}

std::optional<VideoFormat> video_format(const std::string& name) {
  const std::vector<std::string>& names = video_format_names();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) {
    return std::nullopt;
  }
  return static_cast<VideoFormat>(found - names.begin());
}

std::optional<VideoFormat> video_format_of(const std::string& path) {
  const std::size_t dot = path.rfind('.');
  if (dot == std::string::npos) {
    return std::nullopt;
  }
  std::string ending = path.substr(dot + 1);
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return video_format(ending);
}

VideoFormat known_video_format(const std::string& path) {
  if (const std::optional<VideoFormat> format = video_format_of(path)) return *format;
  std::string known;
  for (const std::string& name : video_format_names())
    known += (known.empty() ? "." : ", .") + name;
  throw std::invalid_argument("video \"" + path + "\": its name must end with one of " + known);
}

std::string video_codec(VideoFormat format) {
  switch (format) {
    case VideoFormat::kMp4:
      return "h264";
    case VideoFormat::kWebm:
      return "vp9";
    case VideoFormat::kGif:
      return "gif";
    case VideoFormat::kWebp:
      return "webp";
  }
  return {};
}

int most_frames_per_second(VideoFormat format) {
  constexpr int kGif = 50;
  constexpr int kFilm = 240;
  return format == VideoFormat::kGif ? kGif : kFilm;
}

bool is_animated_picture(VideoFormat format) {
  return format == VideoFormat::kGif || format == VideoFormat::kWebp;
}

}  // namespace qsmpc::render

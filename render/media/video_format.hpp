// Video file formats and the quality of their pictures.
#pragma once

#include <optional>
#include <string>
#include <vector>

#pragma GCC visibility push(default)

namespace qsmpc::render {

enum class VideoFormat { kMp4, kWebm, kGif, kWebp };

/// One scale for all formats: 100 is best, 0 the smallest file.
inline constexpr int kUsualQuality = 60;
inline constexpr int kBestQuality = 100;

/// "mp4", "webm", "gif", "webp": the file name extensions.
[[nodiscard]] const std::vector<std::string>& video_format_names();
[[nodiscard]] const std::string& video_format_name(VideoFormat format);

/// The inverse; empty if `name` is none of them.
[[nodiscard]] std::optional<VideoFormat> video_format(const std::string& name);

/// The format given by the extension of `path`, in any case; empty if it is unknown.
[[nodiscard]] std::optional<VideoFormat> video_format_of(const std::string& path);

/// The same; throws std::invalid_argument, listing the known extensions, if it is unknown.
[[nodiscard]] VideoFormat known_video_format(const std::string& path);

/// The codec of such a file as ffprobe names it, e.g. "h264".
[[nodiscard]] std::string video_codec(VideoFormat format);

/// More frames per second than this cannot be shown: a GIF's clock counts hundredths of a second,
/// and viewers need at least two per frame.
[[nodiscard]] int most_frames_per_second(VideoFormat format);

/// Whether it is an animated picture: shown wherever pictures are, looping, but large.
[[nodiscard]] bool is_animated_picture(VideoFormat format);

}  // namespace qsmpc::render

#pragma GCC visibility pop

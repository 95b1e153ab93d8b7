#include "harness/video/video_timings.hpp"

#include <fstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/errors.hpp"

namespace qsmpc::harness {

double VideoTimings::seconds() const { return fps > 0 ? static_cast<double>(frames) / fps : 0.0; }

double VideoTimings::frames_per_second() const { return wall_s > 0.0 ? frames / wall_s : 0.0; }

std::string video_line(const VideoTimings& timings) {
  return fmt::format(
      "video: {} frames in {:.1f} s ({:.0f} frames/s; drawing {:.0f} ms, encoding {:.0f} ms per "
      "frame)",
      timings.frames, timings.wall_s, timings.frames_per_second(), timings.drawing_ms,
      timings.encoding_ms);
}

std::string video_json(const VideoTimings& timings) {
  const nlohmann::ordered_json json{{"frames", timings.frames},
                                    {"fps", timings.fps},
                                    {"width", timings.width},
                                    {"height", timings.height},
                                    {"codec", timings.codec},
                                    {"from", timings.from},
                                    {"speed", timings.speed},
                                    {"seconds", timings.seconds()},
                                    {"wall_s", timings.wall_s},
                                    {"frames_per_second", timings.frames_per_second()},
                                    {"drawing_ms", timings.drawing_ms},
                                    {"encoding_ms", timings.encoding_ms},
                                    {"simulation_ms", timings.simulation_ms},
                                    {"gl", timings.gl}};
  return json.dump(2) + "\n";
}

VideoTimings read_video_timings(const std::string& path) {
  std::string found;
  try {
    std::ifstream file(path);
    const nlohmann::json json = nlohmann::json::parse(file);
    VideoTimings timings{.frames = json.at("frames"),
                         .fps = json.at("fps"),
                         .from = json.at("from"),
                         .speed = json.at("speed"),
                         .width = json.at("width"),
                         .height = json.at("height"),
                         .codec = json.at("codec"),
                         .wall_s = json.at("wall_s"),
                         .drawing_ms = json.at("drawing_ms"),
                         .encoding_ms = json.at("encoding_ms"),
                         .simulation_ms = json.at("simulation_ms"),
                         .gl = json.at("gl")};
    if (timings.speed > 0.0 && timings.from >= 0.0) return timings;
    found = fmt::format("speed {} from {} s", timings.speed, timings.from);
  } catch (const nlohmann::json::exception& error) {
    found = error.what();
  } catch (const std::ios_base::failure& error) {
    found = error.what();
  }
  throw InputError({.file = path, .found = found, .expected = "a file written by qsmpc render"});
}

}  // namespace qsmpc::harness

// The address space that drawing takes, to be checked before the drawing libraries are started: if
// they get none, they kill the process with a signal.
#pragma once

#include <optional>
#include <string>

#include "harness/video/episode_video.hpp"

namespace qsmpc::harness {

/// Approximate address space (bytes) for a video or picture with `options`, including libraries, on
/// a machine with `cores` cores. Somewhat more than was measured with OSMesa and x264.
[[nodiscard]] double drawing_memory(const EpisodeVideoOptions& options, int cores);

/// The address space (bytes) that the process may still take under its limit (ulimit -v); infinity
/// without a limit.
[[nodiscard]] double free_address_space();

/// Why `free` bytes of address space are too few to draw with `options`, as text for an error;
/// nothing if they are enough.
[[nodiscard]] std::optional<std::string> why_no_memory_to_draw(const EpisodeVideoOptions& options,
                                                               double free);

}  // namespace qsmpc::harness

// How much address space drawing takes, asked before the libraries that draw are started: they end
// the process with a signal where they get none.
#pragma once

#include <optional>
#include <string>

#include "harness/video/episode_video.hpp"

namespace qsmpc::harness {

/// About how much address space (bytes) a video or picture takes with `options`, its libraries
/// included, on a machine of `cores`. Somewhat more than was measured with OSMesa and x264.
[[nodiscard]] double drawing_memory(const EpisodeVideoOptions& options, int cores);

/// The address space (bytes) that the process may still take: what its limit (ulimit -v) leaves,
/// infinity without one.
[[nodiscard]] double free_address_space();

/// Why `free` bytes of address space are too few to draw with `options`, in words for an error;
/// nothing where they are enough.
[[nodiscard]] std::optional<std::string> why_no_memory_to_draw(const EpisodeVideoOptions& options,
                                                               double free);

}  // namespace qsmpc::harness

// Still pictures.
#pragma once

#include <string>

#include "render/frame.hpp"

namespace qsmpc {

/// Writes `image` as a PNG; aside first, so that `path` is a whole file or what it was before.
/// Throws std::runtime_error with the path and the system's words when it cannot be written,
/// std::invalid_argument when the image is empty or its data do not fit its size.
void write_png(const std::string& path, const Image& image);

}  // namespace qsmpc

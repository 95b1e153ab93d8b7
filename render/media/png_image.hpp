// Still pictures.
#pragma once

#include <string>

#include "render/frame.hpp"

namespace qsmpc::render {

/// The bytes of a PNG file that holds `image`. Throws std::invalid_argument when the image is empty
/// or its data do not fit its size, std::runtime_error when it cannot be encoded.
[[nodiscard]] std::string encode_png(const Image& image);

}  // namespace qsmpc::render

// Still pictures.
#pragma once

#include <string>

#include "render/frame.hpp"

namespace qsmpc::render {

/// The bytes of a PNG file of `image`. Throws std::invalid_argument if the image is empty or its
/// data do not match its size, std::runtime_error if it cannot be encoded.
[[nodiscard]] std::string encode_png(const Image& image);

}  // namespace qsmpc::render

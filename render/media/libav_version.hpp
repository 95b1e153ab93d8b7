#pragma once

#include <string>

namespace qsmpc::render {

/// Version of the linked FFmpeg libraries, e.g. "5.1.6-0+deb12u1".
[[nodiscard]] std::string libav_version();

}  // namespace qsmpc::render

#include "render/media/libav_version.hpp"

extern "C" {
#include <libavutil/avutil.h>
}

namespace qsmpc::render {

std::string libav_version() { return av_version_info(); }

}  // namespace qsmpc::render

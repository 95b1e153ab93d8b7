// All public headers of render: pictures of frames, and videos of them.
#pragma once

#include "render/frame.hpp"
#include "render/media/video_format.hpp"
#include "render/renderer.hpp"

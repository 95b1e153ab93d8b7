#include "render/offscreen_context.hpp"

#include <array>
#include <cstddef>
#include <stdexcept>

#include <GL/gl.h>
#include <GL/osmesa.h>

namespace qsmpc {
namespace {

// MuJoCo draws into a framebuffer object of its own; the context's buffer only has to exist.
constexpr std::size_t kBufferSide = 16;  // pixels
constexpr int kDepthBits = 24;
constexpr int kStencilBits = 8;

const char* gl_string(GLenum name) { return reinterpret_cast<const char*>(glGetString(name)); }

}  // namespace

struct OffscreenContext::Handle {
  OSMesaContext context = nullptr;
  std::array<unsigned char, 4 * kBufferSide * kBufferSide> pixels{};
  std::string description;

  ~Handle() {
    if (context != nullptr) {
      OSMesaMakeCurrent(nullptr, nullptr, 0, 0, 0);
      OSMesaDestroyContext(context);
    }
  }
};

OffscreenContext::OffscreenContext() : handle_(std::make_unique<Handle>()) {
  handle_->context = OSMesaCreateContextExt(OSMESA_RGBA, kDepthBits, kStencilBits, 0, nullptr);
  if (handle_->context == nullptr) {
    throw std::runtime_error("off-screen rendering: OSMesa cannot make a context");
  }
  if (OSMesaMakeCurrent(handle_->context, handle_->pixels.data(), GL_UNSIGNED_BYTE,
                        GLsizei{kBufferSide}, GLsizei{kBufferSide}) == GL_FALSE) {
    throw std::runtime_error("off-screen rendering: OSMesa cannot make its context current");
  }
  // Where another OpenGL library comes first in the link order, calls end there and return nothing.
  const char* version = gl_string(GL_VERSION);
  const char* renderer = gl_string(GL_RENDERER);
  if (version == nullptr || renderer == nullptr) {
    throw std::runtime_error("off-screen rendering: OpenGL calls do not reach OSMesa");
  }
  handle_->description = std::string(version) + ", " + renderer;
}

OffscreenContext::~OffscreenContext() = default;

const std::string& OffscreenContext::description() const { return handle_->description; }

}  // namespace qsmpc

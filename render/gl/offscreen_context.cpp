#include "render/gl/offscreen_context.hpp"

#include <stdexcept>

#include "render/gl/gl_context.hpp"
#include "render/gl/gl_functions.hpp"
#include "render/gl/gl_library.hpp"

namespace qsmpc::render {
namespace {

const char* gl_string(GLenum name) { return reinterpret_cast<const char*>(glGetString(name)); }

std::unique_ptr<GlContext> make_context(const GlLibrary& library) {
  return library.backend == GlBackend::kOsmesa ? make_osmesa_context(library.handle)
                                               : make_egl_context(library.handle);
}

}  // namespace

struct OffscreenContext::Handle {
  std::unique_ptr<GlContext> context;
  std::string description;
};

OffscreenContext::OffscreenContext() : handle_(std::make_unique<Handle>()) {
  handle_->context = make_context(loaded_gl());
  load_gl_functions(handle_->context->lookup());
  // Null if calls do not reach the context's library.
  const char* version = gl_string(GL_VERSION);
  const char* renderer = gl_string(GL_RENDERER);
  if (version == nullptr || renderer == nullptr) {
    throw std::runtime_error("off-screen rendering: OpenGL calls do not reach the context");
  }
  describe_gl(version, renderer);
  handle_->description = gl_description();
}

OffscreenContext::~OffscreenContext() = default;

const std::string& OffscreenContext::description() const { return handle_->description; }

}  // namespace qsmpc::render

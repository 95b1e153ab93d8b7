// Contexts of the two libraries that OpenGL can come from. Included only by offscreen_context.cpp
// and their own sources.
#pragma once

#include <memory>
#include <stdexcept>
#include <string>

#include <dlfcn.h>

#include "render/gl/gl_functions.hpp"

namespace qsmpc::render {

/// A context that is current on the thread that made it until it is destroyed there.
class GlContext {
 public:
  GlContext() = default;
  virtual ~GlContext() = default;
  GlContext(const GlContext&) = delete;
  GlContext& operator=(const GlContext&) = delete;

  /// How OpenGL's functions are found.
  [[nodiscard]] virtual GlLookup lookup() const = 0;
};

/// `library`: of dlopen. Throw std::runtime_error when there is no context to be had.
[[nodiscard]] std::unique_ptr<GlContext> make_osmesa_context(void* library);
[[nodiscard]] std::unique_ptr<GlContext> make_egl_context(void* library);

/// Sets `function` to what `library` has under `name`; throws std::runtime_error if it has not.
template <typename Function>
void find_function(void* library, const char* name, Function& function) {
  function = reinterpret_cast<Function>(dlsym(library, name));
  if (function == nullptr) {
    throw std::runtime_error(std::string("off-screen rendering: the library has no ") + name);
  }
}

}  // namespace qsmpc::render

// Contexts of the two libraries that can provide OpenGL. Included only by offscreen_context.cpp and
// the contexts' own sources.
#pragma once

#include <memory>
#include <stdexcept>
#include <string>

#include <dlfcn.h>

#include "render/gl/gl_functions.hpp"

namespace qsmpc::render {

/// A context that is current on the thread that created it until it is destroyed there.
class GlContext {
 public:
  GlContext() = default;
  virtual ~GlContext() = default;
  GlContext(const GlContext&) = delete;
  GlContext& operator=(const GlContext&) = delete;

  /// The function that looks up OpenGL's functions.
  [[nodiscard]] virtual GlLookup lookup() const = 0;
};

/// `library`: a handle from dlopen. Both throw std::runtime_error if no context can be created.
[[nodiscard]] std::unique_ptr<GlContext> make_osmesa_context(void* library);
[[nodiscard]] std::unique_ptr<GlContext> make_egl_context(void* library);

/// Sets `function` to the symbol `name` of `library`; throws std::runtime_error if there is none.
template <typename Function>
void find_function(void* library, const char* name, Function& function) {
  function = reinterpret_cast<Function>(dlsym(library, name));
  if (function == nullptr) {
    throw std::runtime_error(std::string("off-screen rendering: the library has no ") + name);
  }
}

}  // namespace qsmpc::render

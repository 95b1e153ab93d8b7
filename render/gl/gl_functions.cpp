#include "render/gl/gl_functions.hpp"

#include <mutex>
#include <stdexcept>
#include <string>

namespace qsmpc::render {

// A declared name cannot stand in parentheses. NOLINTNEXTLINE(bugprone-macro-parentheses)
#define QSMPC_DEFINE_GL(name) decltype(&::name) name = nullptr;
QSMPC_GL_FUNCTIONS(QSMPC_DEFINE_GL)
#undef QSMPC_DEFINE_GL

namespace {

template <typename Function>
void load(Function& function, GlLookup lookup, const char* name) {
  function = reinterpret_cast<Function>(lookup(name));
  if (function == nullptr) {
    throw std::runtime_error(std::string("off-screen rendering: OpenGL has no ") + name);
  }
}

}  // namespace

void load_gl_functions(GlLookup lookup) {
  static std::once_flag loaded;
  std::call_once(loaded, [lookup] {
#define QSMPC_LOAD_GL(name) load(name, lookup, #name);
    QSMPC_GL_FUNCTIONS(QSMPC_LOAD_GL)
#undef QSMPC_LOAD_GL
  });
}

}  // namespace qsmpc::render

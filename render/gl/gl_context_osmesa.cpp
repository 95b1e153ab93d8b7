#include <array>
#include <cstddef>

#include <GL/osmesa.h>

#include "render/gl/gl_context.hpp"

namespace qsmpc::render {
namespace {

// MuJoCo draws into its own framebuffer object; the context's buffer only has to exist.
constexpr std::size_t kBufferSide = 16;  // pixels
constexpr int kDepthBits = 24;
constexpr int kStencilBits = 8;

struct OsmesaFunctions {
  decltype(&::OSMesaCreateContextExt) create = nullptr;
  decltype(&::OSMesaMakeCurrent) make_current = nullptr;
  decltype(&::OSMesaDestroyContext) destroy = nullptr;
  decltype(&::OSMesaGetProcAddress) lookup = nullptr;

  explicit OsmesaFunctions(void* library) {
    find_function(library, "OSMesaCreateContextExt", create);
    find_function(library, "OSMesaMakeCurrent", make_current);
    find_function(library, "OSMesaDestroyContext", destroy);
    find_function(library, "OSMesaGetProcAddress", lookup);
  }
};

class OsmesaContext : public GlContext {
 public:
  explicit OsmesaContext(void* library)
      : functions_(library),
        context_(functions_.create(OSMESA_RGBA, kDepthBits, kStencilBits, 0, nullptr)) {
    if (context_ == nullptr) {
      throw std::runtime_error("off-screen rendering: OSMesa cannot make a context");
    }
    if (functions_.make_current(context_, pixels_.data(), GL_UNSIGNED_BYTE, GLsizei{kBufferSide},
                                GLsizei{kBufferSide}) == GL_FALSE) {
      functions_.destroy(context_);
      throw std::runtime_error("off-screen rendering: OSMesa cannot make its context current");
    }
  }

  ~OsmesaContext() override {
    functions_.make_current(nullptr, nullptr, 0, 0, 0);
    functions_.destroy(context_);
  }
  OsmesaContext(const OsmesaContext&) = delete;
  OsmesaContext& operator=(const OsmesaContext&) = delete;

  [[nodiscard]] GlLookup lookup() const override { return functions_.lookup; }

 private:
  OsmesaFunctions functions_;
  OSMesaContext context_;
  std::array<unsigned char, 4 * kBufferSide * kBufferSide> pixels_{};
};

}  // namespace

std::unique_ptr<GlContext> make_osmesa_context(void* library) {
  return std::make_unique<OsmesaContext>(library);
}

}  // namespace qsmpc::render

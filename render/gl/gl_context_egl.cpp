#include <array>
#include <mutex>
#include <string_view>
#include <vector>

#include <EGL/egl.h>
#include <EGL/eglext.h>

#include "render/gl/gl_context.hpp"

namespace qsmpc::render {
namespace {

struct EglFunctions {
  decltype(&::eglGetProcAddress) lookup = nullptr;
  decltype(&::eglQueryString) query_string = nullptr;
  decltype(&::eglInitialize) initialise = nullptr;
  decltype(&::eglBindAPI) bind_api = nullptr;
  decltype(&::eglChooseConfig) choose_config = nullptr;
  decltype(&::eglCreateContext) create = nullptr;
  decltype(&::eglMakeCurrent) make_current = nullptr;
  decltype(&::eglDestroyContext) destroy = nullptr;
  decltype(&::eglReleaseThread) release_thread = nullptr;

  explicit EglFunctions(void* library) {
    find_function(library, "eglGetProcAddress", lookup);
    find_function(library, "eglQueryString", query_string);
    find_function(library, "eglInitialize", initialise);
    find_function(library, "eglBindAPI", bind_api);
    find_function(library, "eglChooseConfig", choose_config);
    find_function(library, "eglCreateContext", create);
    find_function(library, "eglMakeCurrent", make_current);
    find_function(library, "eglDestroyContext", destroy);
    find_function(library, "eglReleaseThread", release_thread);
  }
};

// Whether `list`, words separated by blanks and possibly null, contains `word`.
bool holds(const char* list, std::string_view word) {
  const std::string padded = " " + std::string(list == nullptr ? "" : list) + " ";
  return padded.find(" " + std::string(word) + " ") != std::string::npos;
}

// A display without a screen, and the configuration of its contexts.
struct Display {
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLConfig config = nullptr;
};

class DisplaySearch {
 public:
  explicit DisplaySearch(const EglFunctions& functions) : functions_(functions) {
    get_display_ = reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(
        functions.lookup("eglGetPlatformDisplayEXT"));
    extensions_ = functions.query_string(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  }

  // Graphics cards first, then Mesa without a surface, which draws on the CPU if necessary.
  Display find() {
    if (get_display_ != nullptr && holds(extensions_, "EGL_EXT_platform_device")) {
      for (const EGLDeviceEXT device : cards()) {
        if (const Display found = opened(EGL_PLATFORM_DEVICE_EXT, device); found.config) {
          return found;
        }
      }
    }
    if (get_display_ != nullptr && holds(extensions_, "EGL_MESA_platform_surfaceless")) {
      if (const Display found = opened(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY);
          found.config) {
        return found;
      }
    }
    throw std::runtime_error(
        "off-screen rendering: EGL finds neither a graphics card nor Mesa's driver to draw with "
        "(Debian: libgl1-mesa-dri)");
  }

 private:
  [[nodiscard]] std::vector<EGLDeviceEXT> cards() const {
    const auto query_devices =
        reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(functions_.lookup("eglQueryDevicesEXT"));
    const auto query_string = reinterpret_cast<PFNEGLQUERYDEVICESTRINGEXTPROC>(
        functions_.lookup("eglQueryDeviceStringEXT"));
    constexpr EGLint kMost = 16;
    std::array<EGLDeviceEXT, kMost> devices{};
    EGLint count = 0;
    std::vector<EGLDeviceEXT> found;
    if (query_devices == nullptr || query_string == nullptr ||
        query_devices(kMost, devices.data(), &count) == EGL_FALSE) {
      return found;
    }
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
      if (!holds(query_string(devices[i], EGL_EXTENSIONS), "EGL_MESA_device_software")) {
        found.push_back(devices[i]);
      }
    }
    return found;
  }

  // The config is null if the display cannot draw OpenGL without a surface.
  [[nodiscard]] Display opened(EGLenum platform, void* native) const {
    Display found{get_display_(platform, native, nullptr), nullptr};
    if (found.display == EGL_NO_DISPLAY ||
        functions_.initialise(found.display, nullptr, nullptr) == EGL_FALSE ||
        !holds(functions_.query_string(found.display, EGL_EXTENSIONS),
               "EGL_KHR_surfaceless_context")) {
      return {};
    }
    constexpr std::array<EGLint, 5> kWanted{EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE,
                                            EGL_OPENGL_BIT, EGL_NONE};
    EGLint count = 0;
    if (functions_.choose_config(found.display, kWanted.data(), &found.config, 1, &count) ==
            EGL_FALSE ||
        count < 1) {
      return {};
    }
    return found;
  }

  const EglFunctions& functions_;
  PFNEGLGETPLATFORMDISPLAYEXTPROC get_display_ = nullptr;
  const char* extensions_ = nullptr;
};

// One display for all threads, open until the process ends.
Display shared_display(const EglFunctions& functions) {
  static std::mutex mutex;
  static Display display;
  const std::lock_guard lock(mutex);
  if (display.config == nullptr) {
    display = DisplaySearch(functions).find();
  }
  return display;
}

class EglContext : public GlContext {
 public:
  explicit EglContext(void* library)
      : functions_(library), display_(shared_display(functions_).display) {
    const EGLConfig config = shared_display(functions_).config;
    functions_.bind_api(EGL_OPENGL_API);  // a setting of each thread
    context_ = functions_.create(display_, config, EGL_NO_CONTEXT, nullptr);
    if (context_ == EGL_NO_CONTEXT) {
      throw std::runtime_error("off-screen rendering: EGL cannot make a context");
    }
    if (functions_.make_current(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) == EGL_FALSE) {
      functions_.destroy(display_, context_);
      throw std::runtime_error("off-screen rendering: EGL cannot make its context current");
    }
  }

  ~EglContext() override {
    functions_.make_current(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    functions_.destroy(display_, context_);
    functions_.release_thread();
  }
  EglContext(const EglContext&) = delete;
  EglContext& operator=(const EglContext&) = delete;

  [[nodiscard]] GlLookup lookup() const override { return functions_.lookup; }

 private:
  EglFunctions functions_;
  EGLDisplay display_;
  EGLContext context_ = EGL_NO_CONTEXT;
};

}  // namespace

std::unique_ptr<GlContext> make_egl_context(void* library) {
  return std::make_unique<EglContext>(library);
}

}  // namespace qsmpc::render

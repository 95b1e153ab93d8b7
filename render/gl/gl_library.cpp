#include "render/gl/gl_library.hpp"

#include <algorithm>
#include <cstddef>
#include <mutex>
#include <optional>
#include <stdexcept>

#include <dlfcn.h>

namespace qsmpc::render {
namespace {

constexpr const char* kAuto = "auto";

const GlCandidates& usual_candidates() {
  static const GlCandidates candidates{.osmesa = {"libOSMesa.so.8", "libOSMesa.so"},
                                       .egl = {"libEGL.so.1", "libEGL.so"}};
  return candidates;
}

const std::string& name_of(GlBackend backend) {
  return gl_names().at(1 + static_cast<std::size_t>(backend));
}

struct State {
  std::mutex mutex;
  std::optional<GlLibrary> library;
  std::string description;
};

State& state() {
  static State only;
  return only;
}

// The first of `names` that can be opened, or null. Global, so that MuJoCo finds it; never closed,
// as contexts of other threads may still be in use.
void* open_first(const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    if (void* const handle = dlopen(name.c_str(), RTLD_NOW | RTLD_GLOBAL)) {
      return handle;
    }
  }
  return nullptr;
}

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) {
    text += (text.empty() ? "" : ", ") + name;
  }
  return text;
}

[[noreturn]] void throw_none(const std::vector<std::string>& tried) {
  throw std::runtime_error(
      "off-screen rendering: none of these libraries can be loaded: " + joined(tried) +
      "; install OSMesa (Debian: libosmesa6) or EGL with a driver (Debian: libegl1 "
      "libgl1-mesa-dri)");
}

GlLibrary load(const std::string& name) {
  State& s = state();
  const std::lock_guard lock(s.mutex);
  if (!s.library) {
    s.library = open_gl(name, usual_candidates());
  }
  const std::string& loaded = name_of(s.library->backend);
  if (name != kAuto && name != loaded) {
    throw std::runtime_error("off-screen rendering: " + name + " was asked for, but " + loaded +
                             " is already loaded, and a process can use only one");
  }
  return *s.library;
}

}  // namespace

const std::vector<std::string>& gl_names() {
  static const std::vector<std::string> names{kAuto, "osmesa", "egl"};
  return names;
}

GlLibrary open_gl(const std::string& name, const GlCandidates& candidates) {
  const std::vector<std::string>& known = gl_names();
  if (std::find(known.begin(), known.end(), name) == known.end()) {
    throw std::invalid_argument("off-screen rendering: \"" + name + "\" is not one of " +
                                joined(known));
  }
  std::vector<std::string> tried;
  for (const GlBackend backend : {GlBackend::kOsmesa, GlBackend::kEgl}) {
    if (name != kAuto && name != name_of(backend)) {
      continue;
    }
    const std::vector<std::string>& names =
        backend == GlBackend::kOsmesa ? candidates.osmesa : candidates.egl;
    if (void* const handle = open_first(names)) {
      return {backend, handle};
    }
    tried.insert(tried.end(), names.begin(), names.end());
  }
  throw_none(tried);
}

void use_gl(const std::string& name) { load(name); }

GlLibrary loaded_gl() { return load(kAuto); }

std::string gl_description() {
  State& s = state();
  const std::lock_guard lock(s.mutex);
  return s.description;
}

void describe_gl(const std::string& version, const std::string& renderer) {
  State& s = state();
  const std::lock_guard lock(s.mutex);
  s.description = name_of(s.library.value().backend) + ": " + version + ", " + renderer;
}

}  // namespace qsmpc::render

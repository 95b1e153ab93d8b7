// An OpenGL context without a display and without an environment variable: OSMesa, which draws on
// the CPU, or EGL. Which of them is the process's choice: see gl_library.hpp.
#pragma once

#include <memory>
#include <string>

namespace qsmpc::render {

/// Owns one context, current on the thread that made it from construction to destruction. Use and
/// destroy it on that thread; each thread may have one of its own.
class OffscreenContext {
 public:
  /// Throws std::runtime_error when there is no library to draw with (naming those looked for), no
  /// context can be made or OpenGL calls do not reach it.
  OffscreenContext();
  ~OffscreenContext();
  OffscreenContext(const OffscreenContext&) = delete;
  OffscreenContext& operator=(const OffscreenContext&) = delete;

  /// The library, and version and renderer in OpenGL's own words, e.g. "osmesa: 4.5 (Compatibility
  /// Profile) Mesa, llvmpipe".
  [[nodiscard]] const std::string& description() const;

 private:
  struct Handle;
  std::unique_ptr<Handle> handle_;
};

}  // namespace qsmpc::render

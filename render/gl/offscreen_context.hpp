// An OpenGL context that needs neither a display nor an environment variable: OSMesa, which draws
// on the CPU, or EGL. The choice is made once per process, see gl_library.hpp.
#pragma once

#include <memory>
#include <string>

namespace qsmpc::render {

/// Owns one context, current on the creating thread from construction to destruction. Use and
/// destroy it on that thread; each thread may have its own.
class OffscreenContext {
 public:
  /// Throws std::runtime_error if no library is found (naming those tried), no context can be
  /// created or OpenGL calls do not reach it.
  OffscreenContext();
  ~OffscreenContext();
  OffscreenContext(const OffscreenContext&) = delete;
  OffscreenContext& operator=(const OffscreenContext&) = delete;

  /// The library, with OpenGL's version and renderer strings, e.g. "osmesa: 4.5 (Compatibility
  /// Profile) Mesa, llvmpipe".
  [[nodiscard]] const std::string& description() const;

 private:
  struct Handle;
  std::unique_ptr<Handle> handle_;
};

}  // namespace qsmpc::render

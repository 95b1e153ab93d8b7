// An OpenGL context without a display: OSMesa, which draws on the CPU and needs neither an X server
// nor an environment variable.
#pragma once

#include <memory>
#include <string>

namespace qsmpc {

/// Owns one context, current on the thread that made it from construction to destruction. Use and
/// destroy it on that thread; each thread may have one of its own.
class OffscreenContext {
 public:
  /// Throws std::runtime_error when no context can be made or OpenGL calls do not reach it.
  OffscreenContext();
  ~OffscreenContext();
  OffscreenContext(const OffscreenContext&) = delete;
  OffscreenContext& operator=(const OffscreenContext&) = delete;

  /// Version and renderer in OpenGL's own words, e.g. "4.5 (Compatibility Profile) Mesa, llvmpipe".
  [[nodiscard]] const std::string& description() const;

 private:
  struct Handle;
  std::unique_ptr<Handle> handle_;
};

}  // namespace qsmpc

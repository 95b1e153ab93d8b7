// Selects the library that provides OpenGL. It is found and loaded at run time, so that everything
// that does not draw works without one.
//
// MuJoCo looks for its OpenGL functions among the libraries loaded by the process, first EGL, then
// OSMesa: both in one process would draw into each other's contexts. The first library loaded is
// therefore the only one.
#pragma once

#include <string>
#include <vector>

namespace qsmpc::render {

/// OSMesa draws on the CPU and needs no driver; its pictures do not depend on a graphics card. EGL,
/// made current without a surface, draws with any driver that it finds.
enum class GlBackend { kOsmesa, kEgl };

/// Names of shared libraries to try for each backend, in order.
struct GlCandidates {
  std::vector<std::string> osmesa;
  std::vector<std::string> egl;
};

/// "auto", "osmesa", "egl": the names that `use_gl` accepts.
[[nodiscard]] const std::vector<std::string>& gl_names();

/// Loads the library named `name` unless it is already loaded; "auto" means the loaded one,
/// otherwise OSMesa if available, otherwise EGL. Off-screen contexts call this with "auto", so that
/// a call is needed only to choose another, before the first context. Thread-safe. Throws
/// std::runtime_error if another library is already loaded or none can be loaded (naming those
/// tried and what to install), std::invalid_argument on another name.
void use_gl(const std::string& name);

/// The OpenGL implementation of the contexts so far, e.g. "osmesa: 4.5 (Compatibility Profile)
/// Mesa, llvmpipe"; empty before the first context.
[[nodiscard]] std::string gl_description();

/// An opened library, with its handle for dlsym.
struct GlLibrary {
  GlBackend backend = GlBackend::kOsmesa;
  void* handle = nullptr;
};

/// As `use_gl`, but among `candidates` and without remembering the result. For `use_gl` and its
/// tests.
[[nodiscard]] GlLibrary open_gl(const std::string& name, const GlCandidates& candidates);

/// The loaded library; if there is none, loads one as `use_gl("auto")` does.
[[nodiscard]] GlLibrary loaded_gl();

/// Stores the result of `gl_description`.
void describe_gl(const std::string& version, const std::string& renderer);

}  // namespace qsmpc::render

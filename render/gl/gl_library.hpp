// Which library OpenGL comes from. It is found and loaded at run time, so that all that draws
// nothing works where there is none.
//
// MuJoCo looks for its OpenGL functions among what the process has loaded, first EGL's and then
// OSMesa's: two of them in one process would draw into each other's contexts. So the first that is
// loaded stays the only one.
#pragma once

#include <string>
#include <vector>

namespace qsmpc::render {

/// OSMesa draws on the CPU and needs no driver; its pictures depend on no graphics card. EGL, made
/// current without any surface, draws with whatever driver it finds.
enum class GlBackend { kOsmesa, kEgl };

/// Names of shared libraries to try, in this order, in each backend.
struct GlCandidates {
  std::vector<std::string> osmesa;
  std::vector<std::string> egl;
};

/// "auto", "osmesa", "egl": what `use_gl` takes.
[[nodiscard]] const std::vector<std::string>& gl_names();

/// Loads the library named `name`, unless it is loaded; "auto" stands for the one that is loaded,
/// or OSMesa where it is there, or EGL. Off-screen contexts do this by themselves with "auto", so
/// that only a wish needs this call, before the first of them. Thread-safe. Throws
/// std::runtime_error when another library is loaded already or none can be (it then names those
/// that were tried and what to install), std::invalid_argument on another name.
void use_gl(const std::string& name);

/// What drew the contexts so far, e.g. "osmesa: 4.5 (Compatibility Profile) Mesa, llvmpipe"; empty
/// before the first.
[[nodiscard]] std::string gl_description();

/// A library that was opened, and its handle for dlsym.
struct GlLibrary {
  GlBackend backend = GlBackend::kOsmesa;
  void* handle = nullptr;
};

/// What `use_gl` does, among `candidates`, without remembering it. For it and its tests.
[[nodiscard]] GlLibrary open_gl(const std::string& name, const GlCandidates& candidates);

/// The one that is loaded; loads it as `use_gl("auto")` does.
[[nodiscard]] GlLibrary loaded_gl();

/// Remembers what `gl_description` says.
void describe_gl(const std::string& version, const std::string& renderer);

}  // namespace qsmpc::render

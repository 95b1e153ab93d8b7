#include "harness/files/installation.hpp"

#include <filesystem>
#include <system_error>

#include <dlfcn.h>

namespace qsmpc::harness {
namespace {

namespace fs = std::filesystem;

}  // namespace

std::string own_object_file() {
  std::error_code error;
  Dl_info object{};
  if (dladdr(reinterpret_cast<const void*>(&own_object_file), &object) != 0 &&
      object.dli_fname != nullptr) {
    const fs::path path = object.dli_fname;
    // For a program, dli_fname is the name that it was called by.
    const bool is_library = path.filename().string().find(".so") != std::string::npos;
    if (is_library || path.is_absolute()) {
      const fs::path canonical = fs::weakly_canonical(path, error);
      if (!error) return canonical.string();
    }
  }
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  return error ? std::string() : program.string();
}

std::vector<std::string> installation_prefixes_of(const std::string& object_file) {
  std::vector<std::string> prefixes;
  fs::path folder = fs::path(object_file).parent_path();
  for (int level = 0; level < 2 && folder.has_relative_path(); ++level) {
    folder = folder.parent_path();
    prefixes.push_back(folder.string());
  }
  if (folder.filename() == "dist-packages" || folder.filename() == "site-packages") {
    prefixes.push_back(folder.parent_path().parent_path().parent_path().string());
  }
  return prefixes;
}

std::vector<std::string> installation_prefixes() {
  return installation_prefixes_of(own_object_file());
}

}  // namespace qsmpc::harness

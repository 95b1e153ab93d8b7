#include "harness/control/host_program.hpp"

#include <cstdlib>
#include <filesystem>
#include <system_error>

#include <unistd.h>

#include "harness/errors.hpp"

namespace qsmpc::harness {
namespace {

namespace fs = std::filesystem;

constexpr const char* kName = "qsmpc-host";

bool is_program(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error) && ::access(path.c_str(), X_OK) == 0;
}

}  // namespace

std::string host_program() {
  if (const char* const given = std::getenv("QSMPC_HOST"); given != nullptr && *given != '\0') {
    if (is_program(given)) return given;
    throw IoError(std::string(given) + ": no program, but QSMPC_HOST names it");
  }
  std::error_code error;
  const fs::path folder = fs::read_symlink("/proc/self/exe", error).parent_path();
  for (const fs::path& path : {folder / kName, folder.parent_path() / "libexec" / "qsmpc" / kName,
                               fs::path(QSMPC_BUILD_FOLDER) / kName}) {
    if (is_program(path)) return path.string();
  }
  throw IoError(std::string(kName) + ", which starts controllers, is not installed");
}

}  // namespace qsmpc::harness

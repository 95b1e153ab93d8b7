#include "harness/control/host_program.hpp"

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include <unistd.h>

#include "harness/errors.hpp"
#include "harness/files/installation.hpp"
#include "harness/files/text_file.hpp"

namespace qsmpc::harness {
namespace {

namespace fs = std::filesystem;

constexpr const char* kName = "qsmpc-host";

bool is_program(const fs::path& path) { return is_file(path) && ::access(path.c_str(), X_OK) == 0; }

}  // namespace

std::string host_program() {
  if (const char* const given = std::getenv("QSMPC_HOST"); given != nullptr && *given != '\0') {
    if (is_program(given)) return given;
    throw IoError(std::string(given) + ": not an executable file, but QSMPC_HOST names it");
  }
  // Beside the program in a build folder, or where both are installed.
  std::vector<fs::path> places{fs::path(own_object_file()).parent_path() / kName};
  for (const std::string& prefix : installation_prefixes()) {
    places.push_back(fs::path(prefix) / "libexec" / "qsmpc" / kName);
  }
  places.push_back(fs::path(QSMPC_BUILD_FOLDER) / kName);
  for (const fs::path& path : places) {
    if (is_program(path)) return path.string();
  }
  throw IoError(std::string(kName) + ", which starts controllers, is not installed");
}

}  // namespace qsmpc::harness

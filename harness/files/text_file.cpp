#include "harness/files/text_file.hpp"

#include <cerrno>
#include <system_error>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "harness/errors.hpp"

namespace qsmpc::harness {
namespace {

[[noreturn]] void fail_to_read(const std::string& path, const std::string& found) {
  throw InputError({.file = path, .found = found, .expected = "a readable file"});
}

std::string words(int error) { return std::generic_category().message(error); }

std::string read_descriptor(int descriptor, const std::string& path) {
  struct stat status {};
  if (::fstat(descriptor, &status) != 0) fail_to_read(path, words(errno));
  if (S_ISDIR(status.st_mode)) fail_to_read(path, "a folder");
  if (!S_ISREG(status.st_mode)) fail_to_read(path, "a device or pipe");
  // Reading one byte more than allowed reveals a file that is too large, whatever size it reports.
  std::string text(kMaxTextFileBytes + 1, '\0');
  std::size_t size = 0;
  while (size < text.size()) {
    const ssize_t count = ::read(descriptor, text.data() + size, text.size() - size);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail_to_read(path, words(errno));
    if (count == 0) break;
    size += static_cast<std::size_t>(count);
  }
  if (size > kMaxTextFileBytes) {
    throw InputError({.file = path,
                      .found = "more than " + std::to_string(kMaxTextFileBytes) + " bytes",
                      .expected = "a file of at most 1 MiB"});
  }
  text.resize(size);
  return text;
}

}  // namespace

bool is_file(const std::filesystem::path& path) {
  std::error_code ignored;
  return std::filesystem::is_regular_file(path, ignored);
}

std::string read_text_file(const std::string& path) {
  // Without O_NONBLOCK, opening a named pipe would wait for its writer.
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0) fail_to_read(path, words(errno));
  try {
    std::string text = read_descriptor(descriptor, path);
    ::close(descriptor);
    return text;
  } catch (...) {
    ::close(descriptor);
    throw;
  }
}

}  // namespace qsmpc::harness

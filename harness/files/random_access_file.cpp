#include "harness/files/random_access_file.hpp"

#include <cerrno>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "harness/errors.hpp"
#include "harness/text/printable.hpp"

namespace qsmpc::harness {
namespace {

[[noreturn]] void throw_system_words(const std::string& path, const std::string& doing) {
  throw IoError(printable(path, 400) + ": cannot be " + doing + ": " +
                std::generic_category().message(errno));
}

// Repeats `call` while a signal interrupts it.
template <typename Call>
auto uninterrupted(const Call& call) -> decltype(call()) {
  auto result = call();
  while (result < 0 && errno == EINTR) result = call();
  return result;
}

}  // namespace

RandomAccessFile::RandomAccessFile(std::string path) : path_(std::move(path)) {
  constexpr mode_t kMode = 0666;  // masked by the user's umask
  constexpr int kFlags = O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW;
  descriptor_ = uninterrupted([&] { return ::open(path_.c_str(), kFlags, kMode); });
  if (descriptor_ < 0) throw_system_words(path_, "written");
}

RandomAccessFile::~RandomAccessFile() { ::close(descriptor_); }

std::int64_t RandomAccessFile::size() const {
  struct stat status {};
  if (::fstat(descriptor_, &status) != 0) throw_system_words(path_, "read");
  return status.st_size;
}

void RandomAccessFile::write_at(std::int64_t position, std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t written =
        uninterrupted([&] { return ::pwrite(descriptor_, bytes.data(), bytes.size(), position); });
    if (written < 0) throw_system_words(path_, "written");
    position += written;
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
}

std::size_t RandomAccessFile::read_at(std::int64_t position, std::span<std::uint8_t> out) const {
  const ssize_t count =
      uninterrupted([&] { return ::pread(descriptor_, out.data(), out.size(), position); });
  if (count < 0) throw_system_words(path_, "read");
  return static_cast<std::size_t>(count);
}

}  // namespace qsmpc::harness

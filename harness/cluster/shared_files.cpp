#include "harness/cluster/shared_files.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <filesystem>
#include <string_view>
#include <system_error>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "harness/errors.hpp"
#include "harness/text/printable.hpp"

namespace qsmpc::harness {
namespace {

constexpr mode_t kSharedFileMode = 0666;  // reduced by the user's umask
constexpr mode_t kSharedFolderMode = 0777;

[[noreturn]] void fail_shared(const std::string& path, const std::string& doing, int error) {
  throw IoError(printable(path, 400) + ": cannot be " + doing + ": " +
                std::generic_category().message(error));
}

/// A file descriptor that is closed on destruction.
class SharedFile {
 public:
  SharedFile(const std::string& path, int flags) : path_(path) {
    do {
      descriptor_ = ::open(path.c_str(), flags | O_CLOEXEC | O_NOFOLLOW, kSharedFileMode);
    } while (descriptor_ < 0 && errno == EINTR);
    error_ = descriptor_ < 0 ? errno : 0;
  }
  SharedFile(const SharedFile&) = delete;
  SharedFile& operator=(const SharedFile&) = delete;
  ~SharedFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }

  /// The errno of opening; 0 if it succeeded.
  [[nodiscard]] int error() const { return error_; }

  [[nodiscard]] std::string read() const {
    std::string text;
    std::array<char, 4096> part{};
    for (;;) {
      const ssize_t count = ::read(descriptor_, part.data(), part.size());
      if (count < 0 && errno == EINTR) continue;
      if (count < 0) fail_shared(path_, "read", errno);
      if (count == 0) return text;
      text.append(part.data(), static_cast<std::size_t>(count));
    }
  }

  /// Writes all bytes and closes the file: a network file system may report a full disk only on
  /// close.
  void write(std::string_view bytes) {
    while (!bytes.empty()) {
      const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) fail_shared(path_, "written", errno);
      bytes.remove_prefix(static_cast<std::size_t>(written));
    }
    if (::fsync(descriptor_) != 0 && errno != EINVAL && errno != ENOTSUP) {
      fail_shared(path_, "written to disk", errno);
    }
    const int status = ::close(descriptor_);
    descriptor_ = -1;
    if (status != 0 && errno != EINTR) fail_shared(path_, "written", errno);
  }

 private:
  const std::string& path_;
  int descriptor_ = -1;
  int error_ = 0;
};

}  // namespace

std::optional<std::string> read_shared_file(const std::string& path) {
  const SharedFile file(path, O_RDONLY);
  if (file.error() == ENOENT) return std::nullopt;
  if (file.error() != 0) fail_shared(path, "read", file.error());
  return file.read();
}

bool create_shared_file(const std::string& path, const std::string& text) {
  SharedFile file(path, O_WRONLY | O_CREAT | O_EXCL);
  if (file.error() == EEXIST) return false;
  if (file.error() != 0) fail_shared(path, "made", file.error());
  try {
    file.write(text);
  } catch (...) {
    ::unlink(path.c_str());  // another task may succeed
    throw;
  }
  return true;
}

void overwrite_shared_file(const std::string& path, const std::string& text) {
  SharedFile file(path, O_WRONLY);
  if (file.error() != 0) fail_shared(path, "written", file.error());
  file.write(text);
}

bool create_shared_folder(const std::string& path) {
  if (::mkdir(path.c_str(), kSharedFolderMode) != 0) {
    if (errno != EEXIST) fail_shared(path, "created as a folder", errno);
    return false;
  }
  const std::string parent = std::filesystem::path(path).parent_path().string();
  SharedFile folder(parent, O_RDONLY | O_DIRECTORY);
  if (folder.error() != 0) fail_shared(parent, "opened", folder.error());
  folder.write({});  // flushes its entries to disk
  return true;
}

std::vector<std::string> names_in_folder(const std::string& folder) {
  std::vector<std::string> names;
  std::error_code error;
  std::filesystem::directory_iterator entry(folder, error);
  const std::filesystem::directory_iterator end;
  while (!error && entry != end) {
    names.push_back(entry->path().filename().string());
    entry.increment(error);
  }
  if (error) fail_shared(folder, "read", error.value());
  std::ranges::sort(names);
  return names;
}

}  // namespace qsmpc::harness

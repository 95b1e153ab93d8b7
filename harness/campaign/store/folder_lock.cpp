#include "harness/campaign/store/folder_lock.hpp"

#include <array>
#include <cerrno>
#include <climits>
#include <ctime>
#include <sstream>
#include <string_view>
#include <system_error>

#include <fcntl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "harness/errors.hpp"
#include "harness/text/printable.hpp"

namespace qsmpc::harness {
namespace {

constexpr mode_t kFileMode = 0666;  // reduced by the user's umask
constexpr std::size_t kMostBytes = 512;

std::string path_in(const std::string& folder) { return folder + "/campaign.lock"; }

[[noreturn]] void fail(const std::string& path, const std::string& doing, int error) {
  throw IoError(printable(path, 400) + ": cannot " + doing + ": " +
                std::generic_category().message(error));
}

/// A lock of the whole file, for open file description locks. These belong to the descriptor; other
/// file locks belong to the process, which would lose them by closing any other descriptor of the
/// file.
struct flock whole_file() {
  struct flock lock = {};
  lock.l_type = F_WRLCK;
  lock.l_whence = SEEK_SET;
  return lock;
}

LockHolder read_holder(int descriptor) {
  std::array<char, kMostBytes> bytes{};
  const ssize_t size = ::pread(descriptor, bytes.data(), bytes.size(), 0);
  std::istringstream text(std::string(bytes.data(), size > 0 ? static_cast<std::size_t>(size) : 0));
  LockHolder holder;
  text >> holder.process >> holder.host >> holder.since;
  return holder;
}

std::string host_name() {
  std::array<char, HOST_NAME_MAX + 1> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 && name[0] != '\0' ? name.data() : "?";
}

/// Writes this process into the file as its holder.
void write_holder(int descriptor, const std::string& path) {
  const std::time_t now = std::time(nullptr);
  const std::string text = fmt::format("{} {} {}\n", ::getpid(), host_name(), now);
  const bool written =
      ::ftruncate(descriptor, 0) == 0 &&
      ::pwrite(descriptor, text.data(), text.size(), 0) == static_cast<ssize_t>(text.size());
  if (!written) fail(path, "be written", errno);
}

std::string describe(const LockHolder& holder) {
  if (holder.process == 0) return "another process";
  return fmt::format("process {} on {}, since {}", holder.process, printable(holder.host),
                     utc_text(holder.since));
}

}  // namespace

std::string utc_text(std::int64_t seconds) {
  return fmt::format("{:%Y-%m-%d %H:%M:%S} UTC", fmt::gmtime(static_cast<std::time_t>(seconds)));
}

FolderLock::FolderLock(const std::string& folder) {
  const std::string path = path_in(folder);
  descriptor_ = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, kFileMode);
  if (descriptor_ < 0) fail(path, "be opened", errno);
  struct flock lock = whole_file();
  if (::fcntl(descriptor_, F_OFD_SETLK, &lock) != 0) {
    const int error = errno;
    const LockHolder holder = read_holder(descriptor_);
    ::close(descriptor_);
    if (error != EAGAIN && error != EACCES) fail(path, "be locked", error);
    throw IoError(printable(folder, 400) + ": this campaign is being run by " + describe(holder));
  }
  try {
    write_holder(descriptor_, path);
  } catch (...) {
    ::close(descriptor_);
    throw;
  }
}

FolderLock::~FolderLock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

std::optional<LockHolder> lock_holder(const std::string& folder) {
  const std::string path = path_in(folder);
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
  if (descriptor < 0 && errno == ENOENT) return std::nullopt;
  if (descriptor < 0) fail(path, "be read", errno);
  // F_OFD_GETLK only tests for the lock. A read-only descriptor may test only for a read lock, with
  // which a write lock conflicts as well.
  struct flock lock = whole_file();
  lock.l_type = F_RDLCK;
  const int status = ::fcntl(descriptor, F_OFD_GETLK, &lock);
  const int error = errno;
  const LockHolder holder = read_holder(descriptor);
  ::close(descriptor);
  if (status != 0) fail(path, "be checked for a lock", error);
  if (lock.l_type == F_UNLCK) return std::nullopt;
  return holder;
}

}  // namespace qsmpc::harness

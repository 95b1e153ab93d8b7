#include "harness/files/atomic_file.hpp"

#include <cerrno>
#include <filesystem>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "harness/errors.hpp"
#include "harness/text/printable.hpp"

namespace qsmpc::harness {
namespace {

constexpr mode_t kFileMode = 0666;  // masked by the user's umask
constexpr mode_t kFolderMode = 0777;

[[noreturn]] void fail(const std::string& path, const std::string& doing, int error) {
  throw IoError(printable(path, 400) + ": cannot " + doing + ": " +
                std::generic_category().message(error));
}

int open_retrying(const std::string& path, int flags) {
  int descriptor = -1;
  do {
    descriptor = ::open(path.c_str(), flags | O_CLOEXEC, kFileMode);
  } while (descriptor < 0 && errno == EINTR);
  return descriptor;
}

// Returns 0 or the error. Devices, pipes and some network file systems cannot sync and report
// EINVAL: then nothing can be made durable.
int sync_error(int descriptor) {
  int status = 0;
  do {
    status = ::fsync(descriptor);
  } while (status < 0 && errno == EINTR);
  return status == 0 || errno == EINVAL || errno == ENOTSUP ? 0 : errno;
}

// Reopens the file by name, since a library given `partial_path()` may have put another file there.
void sync_path(const std::string& path, int flags) {
  const int descriptor = open_retrying(path, O_RDONLY | flags);
  if (descriptor < 0) fail(path, "be opened again", errno);
  const int error = sync_error(descriptor);
  if (::close(descriptor) != 0 && error == 0 && errno != EINTR) fail(path, "be closed", errno);
  if (error != 0) fail(path, "be written to disk", error);
}

// The name itself is durable once its folder is synced.
void publish(const std::string& partial_path, const std::string& path) {
  sync_path(partial_path, 0);
  if (::rename(partial_path.c_str(), path.c_str()) != 0) fail(path, "be written", errno);
}

std::string folder_of(const std::string& path) {
  const std::string folder = std::filesystem::path(path).parent_path().string();
  return folder.empty() ? "." : folder;
}

}  // namespace

void commit_file(const std::string& partial_path, const std::string& path) {
  publish(partial_path, path);
  sync_path(folder_of(path), O_DIRECTORY);
}

void commit_partial_file(const std::string& path) { commit_file(partial_path_of(path), path); }

PendingFile::PendingFile(std::string path)
    : path_(std::move(path)), partial_path_(partial_path_of(path_)) {
  // O_NOFOLLOW: a symbolic link could redirect the output elsewhere.
  descriptor_ = open_retrying(partial_path_, O_WRONLY | O_CREAT | O_TRUNC | O_NOFOLLOW);
  if (descriptor_ < 0) fail(partial_path_, "be written", errno);
}

PendingFile::~PendingFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (!committed_) ::unlink(partial_path_.c_str());
}

void PendingFile::write(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail(path_, "be written", errno);
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

void PendingFile::close_file() {
  const int descriptor = std::exchange(descriptor_, -1);
  // Linux frees the descriptor even when close() was interrupted; any other error means lost data.
  if (descriptor >= 0 && ::close(descriptor) != 0 && errno != EINTR) {
    fail(path_, "be written", errno);
  }
}

void PendingFile::commit() {
  close_file();
  publish(partial_path_, path_);
  committed_ = true;
  sync_path(folder_of(path_), O_DIRECTORY);
}

void write_file(const std::string& path, std::string_view text) {
  PendingFile file(path);
  file.write(text);
  file.commit();
}

void make_output_folder(const std::string& path) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (error) fail(path, "be created as a folder", error.value());
  if (!std::filesystem::is_directory(path, error)) fail(path, "be used as a folder", ENOTDIR);
  if (::access(path.c_str(), W_OK | X_OK) != 0) fail(path, "be written into", errno);
}

void make_durable_folder(const std::string& path, const std::string& base) {
  std::error_code error;
  if (path == base || std::filesystem::is_directory(path, error)) return;
  const std::string parent = folder_of(path);
  make_durable_folder(parent, base);
  // EEXIST: another process may have created it meanwhile.
  if (::mkdir(path.c_str(), kFolderMode) != 0 && errno != EEXIST) {
    fail(path, "be created as a folder", errno);
  }
  sync_path(parent, O_DIRECTORY);
}

void remove_file(const std::string& path) {
  std::error_code error;
  std::filesystem::remove(path, error);
  if (error) throw IoError(path + ": " + error.message());
}

}  // namespace qsmpc::harness

#include "harness/trace/hdf5_handle.hpp"

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string_view>

#include <fcntl.h>
#include <unistd.h>

#include "harness/errors.hpp"

namespace qsmpc::harness::hdf5 {
namespace {

std::recursive_mutex& mutex() {
  // Never destroyed: a file may still close itself during the destruction of static objects.
  static auto* const instance = new std::recursive_mutex;
  return *instance;
}

std::atomic<bool> files_abandoned = false;

/// Replaces the library's own clean-up, which would retry the writes that a full disk refused, and
/// crash.
void clean_up() {
  if (!files_abandoned) H5close();
}

}  // namespace

void abandon(Handle& handle) {
  files_abandoned = true;
  handle.release();
}

Lock::Lock() : lock_(mutex()) {
  static const bool prepared = [] {
    H5dont_atexit();
    return std::atexit(clean_up) == 0 && H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr) >= 0;
  }();
  static_cast<void>(prepared);
}

std::string error_words() {
  std::string words;
  const auto visit = [](unsigned n, const H5E_error2_t* error, void* data) -> herr_t {
    auto& text = *static_cast<std::string*>(data);
    if (n == 0 && error->desc != nullptr) text = error->desc;
    return 0;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, visit, &words);
  constexpr std::string_view kSystem = "error message = '";
  if (const auto at = words.find(kSystem); at != std::string::npos) {
    const auto begin = at + kSystem.size();
    return words.substr(begin, words.find('\'', begin) - begin);
  }
  return words.empty() ? "HDF5 gave no reason" : "HDF5: " + words;
}

Handle text_type(std::size_t bytes) {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type.get(), bytes);
  H5Tset_cset(type.get(), H5T_CSET_UTF8);
  H5Tset_strpad(type.get(), H5T_STR_NULLPAD);
  return type;
}

Handle file_access() {
  Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  // Fixes the file format, even if built with a later version of the library.
  H5Pset_libver_bounds(access.get(), H5F_LIBVER_V110, H5F_LIBVER_V110);
  H5Pset_fclose_degree(access.get(), H5F_CLOSE_STRONG);
  // A file system without locks is accepted.
  H5Pset_file_locking(access.get(), /*use_file_locking=*/true, /*ignore_when_disabled=*/true);
  return access;
}

bool opened_for_writing(const std::string& path) {
  constexpr const char* kExpected = "a trace in HDF5, as `qsmpc run` writes it";
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) {
    const int error = errno;
    if (error != ENOENT && error != ENOTDIR) throw IoError(path + ": " + std::strerror(error));
    throw InputError({.file = path, .found = "no file", .expected = kExpected});
  }
  constexpr std::size_t kVersion = 8;
  constexpr std::size_t kFlags = 11;
  std::array<char, kFlags + 1> head{};
  const ssize_t count = ::read(descriptor, head.data(), head.size());
  const int error = errno;
  ::close(descriptor);
  if (count < 0 && error == EISDIR) {
    throw InputError({.file = path, .found = "a folder", .expected = kExpected});
  }
  if (count < 0) throw IoError(path + ": " + std::strerror(error));
  constexpr std::string_view kSignature = "\x89HDF\r\n\x1a\n";
  if (std::string_view(head.data(), kSignature.size()) != kSignature) {
    throw InputError({.file = path, .found = "a file that is not HDF5", .expected = kExpected});
  }
  return head[kVersion] >= 3 && head[kFlags] != 0;
}

}  // namespace qsmpc::harness::hdf5

// Owning wrappers of HDF5's identifiers, only for the sources of `hdf5_file.hpp`.
#pragma once

#include <cstddef>
#include <mutex>
#include <string>
#include <utility>

#include <hdf5.h>

namespace qsmpc::harness::hdf5 {

/// The lock that guards HDF5. Taking it also turns off the printing of HDF5's error stack.
class Lock {
 public:
  Lock();

 private:
  std::lock_guard<std::recursive_mutex> lock_;
};

/// Owns one HDF5 identifier.
class Handle {
 public:
  using Close = herr_t (*)(hid_t);
  Handle() = default;
  Handle(hid_t id, Close close) : id_(id), close_(close) {}
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
  }
  ~Handle() { reset(); }

  [[nodiscard]] hid_t get() const { return id_; }
  [[nodiscard]] bool ok() const { return id_ >= 0; }
  /// Gives the identifier up without closing it.
  void release() { id_ = -1; }
  herr_t reset() { return ok() ? close_(std::exchange(id_, -1)) : 0; }

 private:
  hid_t id_ = -1;
  Close close_ = nullptr;
};

/// Gives up an identifier that cannot be closed any more; HDF5 keeps it until the process ends.
void abandon(Handle& handle);
/// The innermost message of HDF5's error stack, reduced to the system's error message if it
/// contains one.
[[nodiscard]] std::string error_words();
/// The type of texts of `bytes` bytes; `bytes` may be H5T_VARIABLE.
[[nodiscard]] Handle text_type(std::size_t bytes);
/// File access properties: the format's version, file locks, and that closing a file closes all of
/// its objects.
[[nodiscard]] Handle file_access();
/// Whether the superblock's flags say that a writer has the file open. Throws InputError if there
/// is no file, and IoError if it cannot be read.
[[nodiscard]] bool opened_for_writing(const std::string& path);

}  // namespace qsmpc::harness::hdf5

// Atomically written files, complete or absent: they are written under another name, then renamed.
//
//   PendingFile file(folder + "/summary.json");
//   file.write(text);
//   file.commit();
#pragma once

#include <string>
#include <string_view>

namespace qsmpc::harness {

/// The name of the file `path` while it is being written: `PATH.partial`.
[[nodiscard]] inline std::string partial_path_of(const std::string& path) {
  return path + ".partial";
}

/// Makes the finished file at `partial_path_of(path)` durable and renames it to `path`, replacing
/// what was there. Throws IoError on any failure; the content of `path` is then unchanged. For
/// files that must survive the death of their writer; for others use PendingFile.
void commit_partial_file(const std::string& path);

/// A file that is being written as `PATH.partial` beside its final name. `commit` renames it to
/// that name, replacing what was there; a PendingFile destroyed without `commit` leaves no trace. A
/// library that opens files itself may be given `partial_path()`.
class PendingFile {
 public:
  /// Creates `PATH.partial`, or truncates one that a killed process left behind.
  /// Throws IoError with the path and the system's message, also if that name is a symbolic link.
  explicit PendingFile(std::string path);
  PendingFile(const PendingFile&) = delete;
  PendingFile& operator=(const PendingFile&) = delete;
  PendingFile(PendingFile&&) = delete;
  PendingFile& operator=(PendingFile&&) = delete;
  ~PendingFile();

  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] const std::string& partial_path() const { return partial_path_; }

  /// Appends `bytes`. Throws IoError if not all of them could be written, e.g. on a full disk.
  void write(std::string_view bytes);

  /// Makes the content durable, then visible under the final name. Throws IoError on any failure;
  /// the file at the final name is then unchanged. To be called once.
  void commit();

 private:
  void close_file();

  std::string path_;
  std::string partial_path_;
  int descriptor_ = -1;
  bool committed_ = false;
};

/// Makes the complete file at `partial_path` durable, then visible as `path` in the same folder,
/// replacing what was there. Throws IoError on any failure; the content of `path` is then
/// unchanged.
void commit_file(const std::string& partial_path, const std::string& path);

/// Writes `text` to `path` atomically, as PendingFile does. Throws IoError.
void write_file(const std::string& path, std::string_view text);

/// Creates the folder `path` and its parents, unless they exist. Throws IoError if that fails, if
/// something else has that name, or if the folder is not writable.
void make_output_folder(const std::string& path);

/// Creates the folder `path` within the existing folder `base`, and the folders between them. They
/// are durable on return, so that files in them can be durable. Throws IoError.
void make_durable_folder(const std::string& path, const std::string& base);

/// Removes the file at `path`, which need not exist. Throws IoError with the system's message.
void remove_file(const std::string& path);

}  // namespace qsmpc::harness

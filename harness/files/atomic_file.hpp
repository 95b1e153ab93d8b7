// Files that are there whole or not at all: written aside, then renamed.
//
//   PendingFile file(folder + "/summary.json");
//   file.write(text);
//   file.commit();
#pragma once

#include <string>
#include <string_view>

namespace qsmpc::harness {

/// Where the file `path` stands while it is being written: `PATH.partial`.
[[nodiscard]] inline std::string partial_path_of(const std::string& path) {
  return path + ".partial";
}

/// Makes the finished file at `partial_path_of(path)` durable and gives it the name `path`,
/// replacing what stood there. Throws IoError on any failure; `path` then still holds what it held
/// before. For files that outlive their writer when it is killed; others are a PendingFile.
void commit_partial_file(const std::string& path);

/// A file that is being written as `PATH.partial` beside its final name. `commit` gives it that
/// name, replacing what stood there; a PendingFile that is destroyed without leaves no trace.
/// A library that writes files by itself may be given `partial_path()`.
class PendingFile {
 public:
  /// Creates `PATH.partial`, or empties one that a killed process left behind.
  /// Throws IoError with the path and the system's words, also where that name is a symbolic link.
  explicit PendingFile(std::string path);
  PendingFile(const PendingFile&) = delete;
  PendingFile& operator=(const PendingFile&) = delete;
  PendingFile(PendingFile&&) = delete;
  PendingFile& operator=(PendingFile&&) = delete;
  ~PendingFile();

  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] const std::string& partial_path() const { return partial_path_; }

  /// Appends `bytes`. Throws IoError when not all of them could be written, e.g. on a full disk.
  void write(std::string_view bytes);

  /// Makes the content durable, then visible under the final name. Throws IoError on any failure;
  /// the final name then still holds what it held before. To be called once.
  void commit();

 private:
  void close_file();

  std::string path_;
  std::string partial_path_;
  int descriptor_ = -1;
  bool committed_ = false;
};

/// Makes the file at `partial_path`, which is whole, durable, then visible under the name `path` in
/// the same folder, replacing what stood there. Throws IoError on any failure; `path` then still
/// holds what it held before.
void commit_file(const std::string& partial_path, const std::string& path);

/// Writes `text` to `path` in one piece, as PendingFile does. Throws IoError.
void write_file(const std::string& path, std::string_view text);

/// Makes the folder `path` and those above it, unless they are there. Throws IoError when that
/// fails, when something else has that name, or when nothing can be written into it.
void make_output_folder(const std::string& path);

/// Makes the folder `path`, which is within the folder `base`, which is there; and the folders
/// between them. They are on the disk when it returns, so that files in them can be. Throws
/// IoError.
void make_durable_folder(const std::string& path, const std::string& base);

/// Removes the file at `path`, which need not exist. Throws IoError with the system's words.
void remove_file(const std::string& path);

}  // namespace qsmpc::harness

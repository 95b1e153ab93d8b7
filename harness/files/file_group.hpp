// Files that belong together: all are fully written before the first gets its final name.
//
//   FileGroup files;
//   library.write_to(files.add(folder + "/data.h5").partial_path());
//   files.add(folder + "/data.json").write(text);
//   files.commit_sealed();
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "harness/files/atomic_file.hpp"

namespace qsmpc::harness {

/// A group of pending files; destroyed without a commit, it leaves no trace.
class FileGroup {
 public:
  /// Begins the file at `path`. The reference stays valid as long as the group.
  /// Throws IoError as PendingFile does.
  PendingFile& add(const std::string& path);

  /// Gives the files their final names, in the order in which they were added. To be called once.
  /// Throws IoError; files before the one that failed then have their final names.
  void commit();

  /// As `commit`, with the last file as the seal of the others: an existing file of its name is
  /// removed first. If the last file exists, all the others match it, whenever the process is
  /// killed. The group must not be empty.
  void commit_sealed();

  /// The final names, in the order in which the files were added.
  [[nodiscard]] std::vector<std::string> paths() const;

 private:
  std::vector<std::unique_ptr<PendingFile>> files_;
};

}  // namespace qsmpc::harness

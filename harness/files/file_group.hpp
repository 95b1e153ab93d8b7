// Files that belong together: all are written aside before the first gets its name.
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

/// A group that is destroyed without a commit leaves no trace.
class FileGroup {
 public:
  /// Begins the file at `path`. The reference stays valid as long as the group.
  /// Throws IoError as PendingFile does.
  PendingFile& add(const std::string& path);

  /// Gives the files their names, in the order in which they were added. To be called once.
  /// Throws IoError; files before the one that failed then have theirs.
  void commit();

  /// As `commit`, with the last file as the seal of the others: what stands under its name is
  /// removed first. Where the last file is, all others belong to it, whenever the process is
  /// killed. The group is not empty.
  void commit_sealed();

  /// The final names, in the order in which the files were added.
  [[nodiscard]] std::vector<std::string> paths() const;

 private:
  std::vector<std::unique_ptr<PendingFile>> files_;
};

}  // namespace qsmpc::harness

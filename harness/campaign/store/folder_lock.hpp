// Ensures that only one process at a time works in a campaign's folder.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace qsmpc::harness {

/// The process that holds a folder.
struct LockHolder {
  long process = 0;        ///< its pid; 0 if not yet written
  std::string host;        ///< the machine that it runs on
  std::int64_t since = 0;  ///< s since 1970-01-01 00:00 UTC
};

/// "YYYY-MM-DD HH:MM:SS UTC".
[[nodiscard]] std::string utc_text(std::int64_t seconds);

/// Holds a lock on `FOLDER/campaign.lock` during its lifetime. The system releases the lock when
/// the process ends, however it ends; the file remains, and its existence alone means nothing.
class FolderLock {
 public:
  /// Locks the folder, which must exist. Throws IoError if another process holds it, naming that
  /// process, or if the file cannot be created or locked.
  explicit FolderLock(const std::string& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_ = -1;
};

/// The current holder of `folder`, or nothing. Does not take the lock. Throws IoError if the file
/// exists and cannot be read.
[[nodiscard]] std::optional<LockHolder> lock_holder(const std::string& folder);

}  // namespace qsmpc::harness

// One process at a time works in a campaign's folder.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace qsmpc::harness {

/// Who holds a folder.
struct LockHolder {
  long process = 0;        ///< its number; 0 where it has not said yet
  std::string host;        ///< the machine that it runs on
  std::int64_t since = 0;  ///< s since 1970-01-01 00:00 UTC
};

/// "YYYY-MM-DD HH:MM:SS UTC".
[[nodiscard]] std::string utc_text(std::int64_t seconds);

/// Holds `FOLDER/campaign.lock` as long as it lives. The system lets go of it when the process
/// ends, however it ends; the file stays, and means nothing by itself.
class FolderLock {
 public:
  /// Takes the folder, which must exist. Throws IoError when another process has it, saying which,
  /// and when the file cannot be made or locked.
  explicit FolderLock(const std::string& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_ = -1;
};

/// Who holds `folder` now, or nothing. Takes nothing itself. Throws IoError when the file is there
/// and cannot be read.
[[nodiscard]] std::optional<LockHolder> lock_holder(const std::string& folder);

}  // namespace qsmpc::harness

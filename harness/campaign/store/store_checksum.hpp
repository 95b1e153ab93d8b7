// Checksums of a campaign's episodes: what a disk or a cable has changed in a store must not go
// into statistics unseen.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

// NOLINTNEXTLINE(readability-identifier-naming): the name that its library gives it
namespace SQLite {
class Database;
}

namespace qsmpc::harness {

/// Checksums of episodes of one store: of all numbers and texts of their rows but the variant's,
/// which differs between shards. Periods count as the rows, one a period, that they were in earlier
/// schemas.
class EpisodeChecksums {
 public:
  explicit EpisodeChecksums(SQLite::Database& database);
  ~EpisodeChecksums();
  EpisodeChecksums(const EpisodeChecksums&) = delete;
  EpisodeChecksums& operator=(const EpisodeChecksums&) = delete;

  /// Of the rows that are there now. Throws SQLite::Exception.
  [[nodiscard]] std::int64_t of(std::int64_t variant, std::int64_t seed);

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// An episode, as the store numbers it.
struct StoredEpisode {
  std::int64_t variant = 0;
  std::int64_t seed = 0;
};

/// The first episode whose rows are not those that its checksum was made of, or are gone; nothing
/// where all are sound. Episodes of earlier versions have none and count as sound.
[[nodiscard]] std::optional<StoredEpisode> damaged_episode(SQLite::Database& database);

}  // namespace qsmpc::harness

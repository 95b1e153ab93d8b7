// Checksums of a campaign's episodes: what a disk or a cable has changed in a store must not go
// into statistics unseen.
#pragma once

#include <cstdint>
#include <optional>

// NOLINTNEXTLINE(readability-identifier-naming): the name that its library gives it
namespace SQLite {
class Database;
}

namespace qsmpc::harness {

/// Adds the checksum of an episode whose rows are there: of all their numbers and texts but the
/// variant's, which differs between shards. To be called within the rows' transaction.
void insert_checksum(SQLite::Database& database, std::int64_t variant, std::int64_t seed);

/// An episode, as the store numbers it.
struct StoredEpisode {
  std::int64_t variant = 0;
  std::int64_t seed = 0;
};

/// The first episode whose rows are not those that its checksum was made of, or are gone; nothing
/// where all are sound. Episodes of earlier versions have none and count as sound.
[[nodiscard]] std::optional<StoredEpisode> damaged_episode(SQLite::Database& database);

}  // namespace qsmpc::harness

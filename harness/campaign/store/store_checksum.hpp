// Checksums of a campaign's episodes, so that data corrupted on disk or in transit cannot enter
// statistics unnoticed.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <tuple>

// NOLINTNEXTLINE(readability-identifier-naming): the name that its library gives it
namespace SQLite {
class Database;
}

namespace qsmpc::harness {

/// Computes checksums of episodes of one store, over all numbers and texts of their rows except the
/// variant's number, which differs between shards. Periods are hashed as one row per period, as in
/// earlier schemas.
class EpisodeChecksums {
 public:
  explicit EpisodeChecksums(SQLite::Database& database);
  ~EpisodeChecksums();
  EpisodeChecksums(const EpisodeChecksums&) = delete;
  EpisodeChecksums& operator=(const EpisodeChecksums&) = delete;

  /// The checksum of the episode's current rows. Throws SQLite::Exception.
  [[nodiscard]] std::int64_t of(std::int64_t variant, std::int64_t seed);

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// The store's key of an episode, in the store's order.
struct StoredEpisode {
  std::int64_t variant = 0;
  std::int64_t seed = 0;

  friend bool operator<(const StoredEpisode& a, const StoredEpisode& b) {
    return std::tie(a.variant, a.seed) < std::tie(b.variant, b.seed);
  }
};

/// The first episode of the store at `path` whose rows do not match its checksum or are missing, in
/// the order of variant and seed; nothing if all are intact. Episodes of earlier versions have no
/// checksum and count as intact. Reads with up to `threads` ≥ 1 threads, each with its own
/// connection; what is not yet committed is not seen. Throws SQLite::Exception.
[[nodiscard]] std::optional<StoredEpisode> damaged_episode(const std::string& path, int threads);

}  // namespace qsmpc::harness

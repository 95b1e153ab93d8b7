#include "harness/campaign/statistics/campaign_csv.hpp"
#include "harness/files/atomic_file.hpp"

namespace qsmpc::harness {
namespace {

constexpr std::size_t kPieceSize = 1 << 16;  // bytes per write, which a last line may exceed

}  // namespace

void write_episodes_csv(const StoreReader& store, const std::string& path) {
  PendingFile file(path);
  std::string piece = episodes_csv_head();
  for (const StoredVariant& variant : store.variants()) {
    store.for_each_episode(variant.id, [&](const EpisodeRow& row) {
      piece += episodes_csv_line(variant, row);
      if (piece.size() < kPieceSize) return;
      file.write(piece);
      piece.clear();
    });
  }
  file.write(piece);
  file.commit();
}

}  // namespace qsmpc::harness

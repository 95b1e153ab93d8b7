// The cells that MixtureSplitter makes, and how one is cut in two.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "controller/measure/compression/block_pool.hpp"
#include "controller/measure/compression/mixture_kernels.hpp"

namespace qsmpc::controller {

/// The sources of cells: names, weights and positions (d x stride); entries from `size` to `stride`
/// are zero. The table is stored in a block; so are its arrays and its cells' edges, whose blocks
/// are chained.
struct SourceTable {
  std::size_t size = 0;
  std::size_t stride = 0;
  double* name = nullptr;  ///< integers as doubles, so that they move together with the rest
  double* weight = nullptr;
  double* position = nullptr;
  Block* own = nullptr;  ///< that holds the table
  std::atomic<Block*> chain{nullptr};
  std::atomic<int> users{0};  ///< cells
};

/// A box in the noise's axes with the parts of sources that are in it.
struct MixtureBox {
  SourceTable* table = nullptr;
  std::array<MixtureInterval, kMixtureDimLimit> intervals{};
  MixtureMoments moments;
  int axis = 0;     ///< of the largest spread
  double at = 0.0;  ///< its mean there
  /// Σ mass (x − mean)² along the axis, as a share of the mixture's second moment.
  double spread = 0.0;
  std::uint32_t key = 0;  ///< rounded_spread(spread), or 0 if it is not to be cut
};

/// A box in the list that every round traverses, with what the rounds read of it.
struct ListedBox {
  MixtureBox* box = nullptr;
  std::uint32_t key = 0;      ///< of the box
  std::uint32_t sources = 0;  ///< in its table
};

/// Sort key of a spread: spreads that differ only by rounding, as those of mirror images, have
/// equal keys.
[[nodiscard]] std::uint32_t rounded_spread(double spread);

/// `size` padded as the loops require.
[[nodiscard]] std::size_t padded_sources(std::size_t size);

/// Data common to all cells of a mixture.
struct MixtureFrame {
  int dim = 0;
  Eigen::VectorXd deviations;  ///< of the noise along its axes
  double least_share = 0.0;    ///< of a source that a part may carry
  double second_moment = 0.0;  ///< of the mixture about its mean
  double* nothing = nullptr;   ///< zeros, for lower edges without a cut
};

/// Cuts cells in its own memory, so that every thread can use a separate one.
class CellCutter {
 public:
  CellCutter() { pending_.reserve(kDepth); }
  BlockPool& pool() { return pool_; }

  /// A table with room for `size` sources, used by one cell.
  [[nodiscard]] SourceTable* make_table(const MixtureFrame& frame, std::size_t size);
  [[nodiscard]] MixtureBox* make_box();
  /// Memory that lives as long as the table.
  [[nodiscard]] double* take(SourceTable& table, std::size_t count);

  /// Cuts the box repeatedly until all pieces have keys below `least` or there are `most` of them.
  /// Writes them to `out`, which must have room for `most`, the lower one of each cut first, and
  /// returns their number.
  std::ptrdiff_t refine(const MixtureFrame& frame, MixtureBox* box, std::uint32_t least,
                        std::size_t most, ListedBox* out);

  /// Chooses where the box will be cut next.
  static void choose_axis(const MixtureFrame& frame, MixtureBox& box);

 private:
  [[nodiscard]] MixtureBox* cut(const MixtureFrame& frame, MixtureBox& box);
  void give_own_table(const MixtureFrame& frame, MixtureBox& box, std::size_t parts);
  void release(SourceTable& table);

  static constexpr std::size_t kDepth = 256;  // of nested cuts, usually

  BlockPool pool_;
  std::vector<MixtureBox*> pending_;
};

}  // namespace qsmpc::controller

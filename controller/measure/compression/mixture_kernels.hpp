// The inner loops of MixtureSplitter, vectorised for the processor's widest SIMD instructions.
#pragma once

#include <array>
#include <cstddef>

namespace qsmpc::controller {

/// The largest dimension that the loops support.
inline constexpr int kMixtureDimLimit = 8;
/// The arrays of the loops are padded to a multiple of this many entries.
inline constexpr std::size_t kMixturePadding = 8;

/// Partial moments of every source's coordinate x = y + σ z, z standard normal, up to an edge:
/// probability, ∫ x and ∫ x², in three arrays that are `stride` apart.
using MixtureEdge = const double*;

/// The edges of one cell along one axis.
struct MixtureInterval {
  MixtureEdge lower = nullptr;
  MixtureEdge upper = nullptr;
};

/// Sums over the parts in a cell: mass, and by axis ∫ x and ∫ x², all weighted by the sources'
/// weights.
struct MixtureMoments {
  double mass = 0.0;
  std::array<double, kMixtureDimLimit> first{};
  std::array<double, kMixtureDimLimit> second{};
};

/// A split of a cell at x = `at` along one of its axes.
struct MixtureCut {
  int dim = 0;
  /// That axis first, then the others.
  std::array<MixtureInterval, kMixtureDimLimit> intervals{};
  const double* weight = nullptr;    ///< of the sources
  const double* position = nullptr;  ///< y, along the axis
  std::size_t stride = 0;
  double at = 0.0;
  double deviation = 0.0;    ///< σ along the axis, ≥ 0
  double least_share = 0.0;  ///< of a source that a part may carry
  double* edge = nullptr;    ///< receives the new edge: 3 x stride
};

/// The moments and parts of a cell below `at`; axes in the order of the cut.
struct MixtureCutResult {
  MixtureMoments lower;
  std::size_t lower_parts = 0;  ///< sources that have a part below, and above
  std::size_t upper_parts = 0;
};

/// Computes the edge for the sources begin … end − 1 and sums the moments below it. begin is a
/// multiple of kMixturePadding; the entries from end to the next multiple of it must be readable
/// and writable, with weight and position 0. Where one of a source's two parts would carry less
/// than least_share, the larger part takes both.
MixtureCutResult cut_mixture(const MixtureCut& cut, std::size_t begin, std::size_t end);

/// A copy of those sources that have a part in a cell, to arrays of their own.
struct MixtureCopy {
  int dim = 0;
  std::array<MixtureInterval, kMixtureDimLimit> intervals{};  ///< of the cell, by axis
  const double* source = nullptr;                             ///< names of the sources
  const double* weight = nullptr;
  const double* position = nullptr;  ///< dim x stride
  std::size_t size = 0;              ///< of the arrays above
  std::size_t stride = 0;
  std::size_t parts = 0;  ///< sources with a part in the cell
  /// The destination, laid out as above, with its own stride: at least `parts` rounded up to a
  /// multiple of kMixturePadding, plus kMixturePadding.
  double* to_source = nullptr;
  double* to_weight = nullptr;
  double* to_position = nullptr;
  /// Lower and upper, by axis; the lower may be null, and is then not copied.
  std::array<std::array<double*, 2>, kMixtureDimLimit> to_edges{};
  std::size_t to_stride = 0;
};

/// Copies the sources that have a part in the cell, in order, and appends zeros.
void copy_mixture_parts(const MixtureCopy& copy);

/// A finished cell.
struct MixtureCell {
  int dim = 0;
  std::array<MixtureInterval, kMixtureDimLimit> intervals{};  ///< by axis
  std::array<const double*, kMixtureDimLimit> position{};     ///< y, by axis
  const double* weight = nullptr;
  const double* source = nullptr;  ///< names of the sources
  std::size_t stride = 0;
};

struct MixtureParts {
  std::size_t count = 0;
  double mass = 0.0;
  std::array<double, kMixtureDimLimit> first{};  ///< Σ mass · E[x], by axis
  std::array<double, kMixtureDimLimit> noise{};  ///< Σ mass · E[x − y], by axis
};

/// Writes the mass and the source's name of every part of the cell among `size` sources to `mass`
/// and `source`, which must have room for `size` rounded up to a multiple of kMixturePadding, plus
/// kMixturePadding.
MixtureParts list_mixture_parts(const MixtureCell& cell, std::size_t size, double* mass,
                                double* source);

}  // namespace qsmpc::controller

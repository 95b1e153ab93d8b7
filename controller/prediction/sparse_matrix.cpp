#include "controller/prediction/sparse_matrix.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "controller/storage.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "controller/prediction/sparse_matrix.cpp"
#include <hwy/foreach_target.h>

#include "models/simd/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace qsmpc::controller {
namespace HWY_NAMESPACE {

using namespace models::HWY_NAMESPACE;

// Coordinates processed at once, and concurrent partial sums, so that one addition need not wait
// for the previous one.
constexpr int kGroup = 4;
constexpr int kChains = 4;

void pack_points(const Points& points, Eigen::Index begin, Eigen::Index end, PackedPoints& packed) {
  const Eigen::Index dim = points.rows();
  const Eigen::Index stride = packed.stride;
  const double* const from = points.data();
  double* const to = packed.data.data();
  for (Eigen::Index first = 0; first < dim; first += kGroup) {
    const Eigen::Index coordinates = std::min<Eigen::Index>(kGroup, dim - first);
    Eigen::Index i = begin;
#if HWY_MAX_BYTES >= 32
    // Four points at once: transposes a 4 x 4 block.
    using Tag = hn::FixedTag<double, kGroup>;
    const Tag d;
    const auto row = [&](Eigen::Index axis) HWY_ATTR {
      return axis < coordinates ? hn::LoadU(d, from + (first + axis) * points.cols() + i)
                                : hn::Zero(d);
    };
    for (; i + kGroup <= end; i += kGroup) {
      const auto x = row(0);
      const auto y = row(1);
      const auto z = row(2);
      const auto w = row(3);
      const auto even = hn::InterleaveLower(d, x, y);  // x₀ y₀ x₂ y₂
      const auto odd = hn::InterleaveUpper(d, x, y);   // x₁ y₁ x₃ y₃
      const auto even_rest = hn::InterleaveLower(d, z, w);
      const auto odd_rest = hn::InterleaveUpper(d, z, w);
      double* const point = to + i * stride + first;
      hn::StoreU(hn::ConcatLowerLower(d, even_rest, even), d, point);
      hn::StoreU(hn::ConcatLowerLower(d, odd_rest, odd), d, point + stride);
      hn::StoreU(hn::ConcatUpperUpper(d, even_rest, even), d, point + 2 * stride);
      hn::StoreU(hn::ConcatUpperUpper(d, odd_rest, odd), d, point + 3 * stride);
    }
#endif
    for (; i < end; ++i) {
      for (Eigen::Index axis = 0; axis < coordinates; ++axis) {
        to[i * stride + first + axis] = from[(first + axis) * points.cols() + i];
      }
    }
  }
}

void multiply_packed(const SparseMatrix& a, const PackedPoints& points, int begin, int end,
                     Points& out) {
  using Tag = hn::CappedTag<double, kGroup>;
  using Group = hn::Vec<Tag>;
  const Tag d;
  constexpr int kGroupWidth = static_cast<int>(hn::MaxLanes(Tag()));
  constexpr int kPieces = kGroup / kGroupWidth;
  const int* const column = a.column.data();
  const double* const value = a.value.data();
  const int stride = points.stride;
  const Eigen::Index dim = out.rows();
  for (Eigen::Index first = 0; first < dim; first += kGroup) {
    const double* const data = points.data.data() + first;
    const Eigen::Index coordinates = std::min<Eigen::Index>(kGroup, dim - first);
    for (int n = begin; n < end; ++n) {
      Group sum[kChains][kPieces];
      for (auto& chain : sum) {
        for (Group& piece : chain) piece = hn::Zero(d);
      }
      const int stop = a.begin[n + 1];
      int k = a.begin[n];
      for (; k + kChains <= stop; k += kChains) {
        for (int chain = 0; chain < kChains; ++chain) {
          const double* const point =
              data + static_cast<std::ptrdiff_t>(column[k + chain]) * stride;
          const Group factor = hn::Set(d, value[k + chain]);
          for (std::ptrdiff_t piece = 0; piece < kPieces; ++piece) {
            sum[chain][piece] =
                sum[chain][piece] + factor * hn::LoadU(d, point + piece * kGroupWidth);
          }
        }
      }
      // The remainder, without a branch on its size, because rows differ in length.
      for (int chain = 0; a.begin[n] < stop && chain < kChains - 1; ++chain) {
        const bool exists = k + chain < stop;
        const int entry = exists ? k + chain : stop - 1;
        const double* const point = data + static_cast<std::ptrdiff_t>(column[entry]) * stride;
        const Group factor = hn::Set(d, exists ? value[entry] : 0.0);
        for (std::ptrdiff_t piece = 0; piece < kPieces; ++piece) {
          sum[chain][piece] =
              sum[chain][piece] + factor * hn::LoadU(d, point + piece * kGroupWidth);
        }
      }
      double result[kGroup];
      for (std::ptrdiff_t piece = 0; piece < kPieces; ++piece) {
        hn::StoreU((sum[0][piece] + sum[1][piece]) + (sum[2][piece] + sum[3][piece]), d,
                   result + piece * kGroupWidth);
      }
      for (Eigen::Index axis = 0; axis < coordinates; ++axis) out(first + axis, n) = result[axis];
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace qsmpc::controller
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace qsmpc::controller {

HWY_EXPORT(multiply_packed);
HWY_EXPORT(pack_points);

namespace {
// Number of entries that justifies a block of its own in a transposition, and the largest number of
// blocks.
constexpr std::ptrdiff_t kBlock = 16384;
constexpr std::ptrdiff_t kMostBlocks = 16;
}  // namespace

void multiply(const SparseMatrix& a, const PackedPoints& points, int begin, int end, Points& out) {
  HWY_DYNAMIC_DISPATCH(multiply_packed)(a, points, begin, end, out);
}

void transpose(const SparseMatrix& a, int columns, const Executor& run, SparseMatrix& out) {
  // Rows are divided into blocks, whose entries of a column follow one another.
  const auto entries = static_cast<std::ptrdiff_t>(a.column.size());
  const int rows = a.rows();
  const int blocks = static_cast<int>(std::clamp<std::ptrdiff_t>(entries / kBlock, 1, kMostBlocks));
  const auto first_row = [&](int block) {
    const auto entry = static_cast<int>(entries * block / blocks);
    return static_cast<int>(std::lower_bound(a.begin.begin(), a.begin.end() - 1, entry) -
                            a.begin.begin());
  };
  const auto rows_of = [&](int block) {
    return std::pair(first_row(block), block + 1 == blocks ? rows : first_row(block + 1));
  };
  make_room(out.column, entries);
  make_room(out.value, entries);
  out.column.resize(entries);
  out.value.resize(entries);
  make_room(out.places, static_cast<std::size_t>(blocks) * columns);
  out.places.assign(static_cast<std::size_t>(blocks) * columns, 0);
  const auto places_of = [&](int block) {
    return out.places.data() + static_cast<std::ptrdiff_t>(block) * columns;
  };
  const auto count = [&](int block) {
    const auto [begin, end] = rows_of(block);
    int* const places = places_of(block);
    for (int k = a.begin[begin]; k < a.begin[end]; ++k) ++places[a.column[k]];
  };
  run(blocks, count);
  out.begin.assign(columns + 1, 0);
  int place = 0;
  for (int column = 0; column < columns; ++column) {
    out.begin[column] = place;
    for (int block = 0; block < blocks; ++block) {
      place += std::exchange(places_of(block)[column], place);
    }
  }
  out.begin[columns] = place;
  const auto scatter = [&](int block) {
    const auto [begin, end] = rows_of(block);
    int* const places = places_of(block);
    for (int n = begin; n < end; ++n) {
      for (int k = a.begin[n]; k < a.begin[n + 1]; ++k) {
        const int to = places[a.column[k]]++;
        out.column[to] = n;
        out.value[to] = a.value[k];
      }
    }
  };
  run(blocks, scatter);
}

void resize_packed(int dim, Eigen::Index count, PackedPoints& packed) {
  constexpr int kGroup = 4;
  const int stride = (dim + kGroup - 1) / kGroup * kGroup;
  const std::size_t size = static_cast<std::size_t>(stride) * count;
  if (packed.stride == stride && packed.data.size() == size) return;
  packed.stride = stride;
  make_room(packed.data, size);
  packed.data.assign(size, 0.0);
}

void pack(const Points& points, Eigen::Index begin, Eigen::Index end, PackedPoints& packed) {
  HWY_DYNAMIC_DISPATCH(pack_points)(points, begin, end, packed);
}

}  // namespace qsmpc::controller
#endif

#include "controller/prediction/sparse_matrix.hpp"

#include "controller/storage.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "controller/prediction/sparse_matrix.cpp"
#include <hwy/foreach_target.h>

#include "models/simd/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace qsmpc {
namespace HWY_NAMESPACE {

// Coordinates that are handled at once, and sums that are under way at the same time, so that one
// addition need not wait for the one before it.
constexpr int kGroup = 4;
constexpr int kChains = 4;

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
          for (int piece = 0; piece < kPieces; ++piece) {
            sum[chain][piece] =
                sum[chain][piece] + factor * hn::LoadU(d, point + piece * kGroupWidth);
          }
        }
      }
      for (; k < stop; ++k) {
        const double* const point = data + static_cast<std::ptrdiff_t>(column[k]) * stride;
        const Group factor = hn::Set(d, value[k]);
        for (int piece = 0; piece < kPieces; ++piece) {
          sum[0][piece] = sum[0][piece] + factor * hn::LoadU(d, point + piece * kGroupWidth);
        }
      }
      double result[kGroup];
      for (int piece = 0; piece < kPieces; ++piece) {
        hn::StoreU((sum[0][piece] + sum[1][piece]) + (sum[2][piece] + sum[3][piece]), d,
                   result + piece * kGroupWidth);
      }
      for (Eigen::Index axis = 0; axis < coordinates; ++axis) out(first + axis, n) = result[axis];
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace qsmpc
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace qsmpc {

HWY_EXPORT(multiply_packed);

void multiply(const SparseMatrix& a, const PackedPoints& points, int begin, int end, Points& out) {
  HWY_DYNAMIC_DISPATCH(multiply_packed)(a, points, begin, end, out);
}

void transpose(const SparseMatrix& a, int columns, SparseMatrix& out) {
  out.begin.assign(columns + 1, 0);
  make_room(out.column, a.column.size());
  make_room(out.value, a.value.size());
  out.column.resize(a.column.size());
  out.value.resize(a.value.size());
  for (const int column : a.column) ++out.begin[column + 1];
  for (int i = 0; i < columns; ++i) out.begin[i + 1] += out.begin[i];
  // The beginnings serve as places to write to, and are moved back afterwards.
  for (int n = 0; n < a.rows(); ++n) {
    for (int k = a.begin[n]; k < a.begin[n + 1]; ++k) {
      const int to = out.begin[a.column[k]]++;
      out.column[to] = n;
      out.value[to] = a.value[k];
    }
  }
  for (int i = columns; i > 0; --i) out.begin[i] = out.begin[i - 1];
  out.begin[0] = 0;
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
  for (Eigen::Index axis = 0; axis < points.rows(); ++axis) {
    const double* const row = points.data() + axis * points.cols();
    double* to = packed.data.data() + begin * packed.stride + axis;
    for (Eigen::Index i = begin; i < end; ++i, to += packed.stride) *to = row[i];
  }
}

}  // namespace qsmpc
#endif

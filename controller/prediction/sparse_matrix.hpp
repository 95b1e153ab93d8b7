// Sparse matrices that act on batches of points, vectorised for the processor's widest SIMD
// instructions.
#pragma once

#include <cstddef>
#include <vector>

#include "controller/measure/measures.hpp"
#include "controller/parallel.hpp"
#include "controller/storage.hpp"

#pragma GCC visibility push(default)

namespace qsmpc::controller {

/// Row n has the entries begin[n] … begin[n + 1] − 1. Storage is reused when a matrix is
/// overwritten.
struct SparseMatrix {
  std::vector<int> begin;  ///< rows + 1
  std::vector<int> column;
  std::vector<double> value;
  std::vector<int> places;  ///< scratch of a transposition into this

  [[nodiscard]] int rows() const { return static_cast<int>(begin.size()) - 1; }
};

/// out = aᵀ, for `a` with `columns` columns; the entries of a row stay in the order of a's rows.
void transpose(const SparseMatrix& a, int columns, const Executor& run, SparseMatrix& out);

/// Points one after the other, each with contiguous coordinates, padded with zeros up to `stride`.
struct PackedPoints {
  int stride = 0;  ///< a multiple of 4, at least the dimension
  LineVector data;

  [[nodiscard]] const double* point(int i) const {
    return data.data() + static_cast<std::ptrdiff_t>(i) * stride;
  }
};

/// Makes room for `count` points of dimension `dim`.
void resize_packed(int dim, Eigen::Index count, PackedPoints& packed);

/// Packs the points begin … end − 1.
void pack(const Points& points, Eigen::Index begin, Eigen::Index end, PackedPoints& packed);

/// out.col(n) = Σ_i a(n, i) points_i for the rows begin … end − 1 of a. The sum is taken in four
/// interleaved parts. out: dim x rows.
void multiply(const SparseMatrix& a, const PackedPoints& points, int begin, int end, Points& out);

}  // namespace qsmpc::controller

#pragma GCC visibility pop

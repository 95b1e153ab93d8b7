#include "controller/prediction/stage_map.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "controller/prediction/stage_map.cpp"
#include <hwy/foreach_target.h>

#include "models/simd/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace qsmpc::controller {
namespace HWY_NAMESPACE {

using namespace models::HWY_NAMESPACE;

// Coordinates of a point held in registers at once; larger dimensions use Eigen.
constexpr Eigen::Index kHeld = 8;

/// x ↦ a + S x for all columns; d ≤ kHeld.
void affine_in_place(const Eigen::MatrixXd& matrix, const double* added, Points& points) {
  const Eigen::Index dim = points.rows();
  const Eigen::Index stride = points.cols();
  double* const x = points.data();
  for_vectors(stride, [&](std::size_t i, auto load_at, auto store_at, std::size_t) HWY_ATTR {
    Vector held[kHeld];
    for (Eigen::Index a = 0; a < dim; ++a) held[a] = load_at(x + a * stride + i);
    for (Eigen::Index a = 0; a < dim; ++a) {
      Vector sum = constant(added[a]);
      for (Eigen::Index b = 0; b < dim; ++b) sum = sum + constant(matrix(a, b)) * held[b];
      store_at(sum, x + a * stride + i);
    }
  });
}

/// points.row(a) += factor[a] · weights.
void add_weights(const double* factor, const Eigen::VectorXd& weights, Points& points) {
  for (Eigen::Index a = 0; a < points.rows(); ++a) {
    double* const row = points.data() + a * points.cols();
    const Vector scale = constant(factor[a]);
    for_vectors(points.cols(),
                [&](std::size_t i, auto load_at, auto store_at, std::size_t) HWY_ATTR {
                  store_at(load_at(row + i) + scale * load_at(weights.data() + i), row + i);
                });
  }
}

/// out[a] = Σ_i weights_i points(a, i), or without weights where they are null.
void row_sums(const double* weights, const Points& points, double* out) {
  for (Eigen::Index a = 0; a < points.rows(); ++a) {
    const double* const row = points.data() + a * points.cols();
    Sum sum;
    for_vectors(points.cols(), [&](std::size_t i, auto load_at, auto, std::size_t part) HWY_ATTR {
      const Vector value = load_at(row + i);
      sum.add(part, weights == nullptr ? value : value * load_at(weights + i));
    });
    out[a] = sum.total();
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace qsmpc::controller
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace qsmpc::controller {

HWY_EXPORT(affine_in_place);
HWY_EXPORT(add_weights);
HWY_EXPORT(row_sums);

namespace {

constexpr Eigen::Index kLargestHeld = 8;  // as kHeld of the loops
using SmallVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kLargestHeld, 1>;

void apply_large_spread(const StageMap& map, Points& out) {
  const Eigen::VectorXd mean = out * map.weights / map.weights.sum();
  const Points offset = out.colwise() - mean;
  out.noalias() = map.spread * offset;
  out.colwise() += mean;
}

void pullback_large_spread(const StageMap& map, Points& adjoint) {
  const Eigen::VectorXd total = adjoint.rowwise().sum();
  const Eigen::VectorXd of_mean = (total - map.spread * total) / map.weights.sum();
  const Points own = adjoint;
  adjoint.noalias() = map.spread * own;
  adjoint.noalias() += of_mean * map.weights.transpose();
}

}  // namespace

void apply_shares(const StageMap& map, const Points& stepped, const PackedPoints& packed,
                  Eigen::Index begin, Eigen::Index end, Points& out) {
  auto columns = out.middleCols(begin, end - begin);
  if (map.identity) {
    columns = stepped.middleCols(begin, end - begin);
    return;
  }
  multiply(map.shares, packed, static_cast<int>(begin), static_cast<int>(end), out);
  columns += map.offset.middleCols(begin, end - begin);
}

void apply_spread(const StageMap& map, Points& out) {
  const Eigen::Index dim = map.spread.rows();
  if (dim == 0) return;
  if (dim > kLargestHeld) {
    apply_large_spread(map, out);
    return;
  }
  SmallVector mean(dim);
  HWY_DYNAMIC_DISPATCH(row_sums)(map.weights.data(), out, mean.data());
  mean /= map.weights.sum();
  SmallVector added = mean;
  added.noalias() -= map.spread * mean;
  HWY_DYNAMIC_DISPATCH(affine_in_place)(map.spread, added.data(), out);
}

void apply_stage_map(const StageMap& map, const Points& stepped, Points& out) {
  PackedPoints packed;
  resize_packed(static_cast<int>(stepped.rows()), stepped.cols(), packed);
  pack(stepped, 0, stepped.cols(), packed);
  apply_shares(map, stepped, packed, 0, map.clusters(), out);
  apply_spread(map, out);
}

// With S symmetric, the adjoint of cluster n before the spread is S g_n + ρ̃_n (I − S) Σ g.
void pullback_spread(const StageMap& map, Points& adjoint) {
  const Eigen::Index dim = map.spread.rows();
  if (dim == 0) return;
  if (dim > kLargestHeld) {
    pullback_large_spread(map, adjoint);
    return;
  }
  SmallVector total(dim);
  HWY_DYNAMIC_DISPATCH(row_sums)(nullptr, adjoint, total.data());
  SmallVector of_mean = total;
  of_mean.noalias() -= map.spread * total;
  of_mean /= map.weights.sum();
  const SmallVector nothing = SmallVector::Zero(dim);
  HWY_DYNAMIC_DISPATCH(affine_in_place)(map.spread, nothing.data(), adjoint);
  HWY_DYNAMIC_DISPATCH(add_weights)(of_mean.data(), map.weights, adjoint);
}

void pullback_shares(const StageMap& map, const SparseMatrix& transposed, const Points& adjoint,
                     const PackedPoints& packed, Eigen::Index begin, Eigen::Index end,
                     Points& stepped_adjoint) {
  if (map.identity) {
    stepped_adjoint.middleCols(begin, end - begin) = adjoint.middleCols(begin, end - begin);
    return;
  }
  multiply(transposed, packed, static_cast<int>(begin), static_cast<int>(end), stepped_adjoint);
}

void pullback_stage_map(const StageMap& map, const Points& adjoint, Points& stepped_adjoint) {
  Points unspread = adjoint;
  pullback_spread(map, unspread);
  PackedPoints packed;
  resize_packed(static_cast<int>(adjoint.rows()), adjoint.cols(), packed);
  pack(unspread, 0, adjoint.cols(), packed);
  SparseMatrix transposed;
  if (!map.identity) {
    transpose(map.shares, static_cast<int>(stepped_adjoint.cols()), run_in_turn, transposed);
  }
  pullback_shares(map, transposed, unspread, packed, 0, stepped_adjoint.cols(), stepped_adjoint);
}

}  // namespace qsmpc::controller
#endif

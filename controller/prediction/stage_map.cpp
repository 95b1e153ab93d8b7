#include "controller/prediction/stage_map.hpp"

namespace qsmpc {

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
  if (map.spread.size() == 0) return;
  const Eigen::VectorXd mean = out * map.weights / map.weights.sum();
  Eigen::VectorXd offset(mean.size());
  for (Eigen::Index n = 0; n < map.clusters(); ++n) {
    offset = out.col(n) - mean;
    out.col(n) = mean;
    out.col(n).noalias() += map.spread * offset;
  }
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
  if (map.spread.size() == 0) return;
  const Eigen::VectorXd total = adjoint.rowwise().sum();
  const Eigen::VectorXd of_mean = (total - map.spread * total) / map.weights.sum();
  Eigen::VectorXd own(total.size());
  for (Eigen::Index n = 0; n < map.clusters(); ++n) {
    own = adjoint.col(n);
    adjoint.col(n) = map.weights[n] * of_mean;
    adjoint.col(n).noalias() += map.spread * own;
  }
}

void pullback_shares(const StageMap& map, const Points& adjoint, const PackedPoints& packed,
                     Eigen::Index begin, Eigen::Index end, Points& stepped_adjoint) {
  if (map.identity) {
    stepped_adjoint.middleCols(begin, end - begin) = adjoint.middleCols(begin, end - begin);
    return;
  }
  multiply(map.shares_transposed, packed, static_cast<int>(begin), static_cast<int>(end),
           stepped_adjoint);
}

void pullback_stage_map(const StageMap& map, const Points& adjoint, Points& stepped_adjoint) {
  Points unspread = adjoint;
  pullback_spread(map, unspread);
  PackedPoints packed;
  resize_packed(static_cast<int>(adjoint.rows()), adjoint.cols(), packed);
  pack(unspread, 0, adjoint.cols(), packed);
  pullback_shares(map, unspread, packed, 0, stepped_adjoint.cols(), stepped_adjoint);
}

}  // namespace qsmpc

#include "harness/figures/contour_lines.hpp"

#include <array>
#include <cmath>
#include <cstddef>

namespace qsmpc::harness {
namespace {

using Eigen::Index;

constexpr Index kNone = -1;

/// Traces the lines of one level. A line crosses a grid edge at most once. Every crossed edge lies
/// between two cells, each of which joins it to another crossed edge, so the crossings form rings.
class LineTracer {
 public:
  LineTracer(const Eigen::Ref<const Eigen::MatrixXd>& values, double level)
      : values_(values),
        level_(level),
        joined_(static_cast<std::size_t>(2 * values.size()), {kNone, kNone}) {
    for (Index i = 0; i + 1 < values_.rows(); ++i) {
      for (Index j = 0; j + 1 < values_.cols(); ++j) join_in_cell(i, j);
    }
  }

  [[nodiscard]] std::vector<Eigen::Matrix2Xd> lines() {
    std::vector<Eigen::Matrix2Xd> lines;
    std::vector<bool> seen(joined_.size(), false);
    for (Index start = 0; start < std::ssize(joined_); ++start) {
      if (at(start)[0] != kNone && !seen[static_cast<std::size_t>(start)]) {
        lines.push_back(ring_from(start, seen));
      }
    }
    return lines;
  }

 private:
  [[nodiscard]] bool above(Index i, Index j) const {
    const bool inner = i > 0 && j > 0 && i + 1 < values_.rows() && j + 1 < values_.cols();
    return inner && std::isfinite(values_(i, j)) && values_(i, j) > level_;
  }

  /// The edge from node (i, j) to (i + 1, j), or to (i, j + 1).
  [[nodiscard]] Index edge_down(Index i, Index j) const { return 2 * (i * values_.cols() + j); }
  [[nodiscard]] Index edge_across(Index i, Index j) const { return edge_down(i, j) + 1; }

  [[nodiscard]] std::array<Index, 2>& at(Index edge) {
    return joined_[static_cast<std::size_t>(edge)];
  }

  void join(Index a, Index b) {
    at(a)[at(a)[0] == kNone ? 0 : 1] = b;
    at(b)[at(b)[0] == kNone ? 0 : 1] = a;
  }

  void join_in_cell(Index i, Index j) {
    const std::array<bool, 4> corner = {above(i, j), above(i, j + 1), above(i + 1, j + 1),
                                        above(i + 1, j)};
    // Edge n leads from corner n to the next one.
    const std::array<Index, 4> edge = {edge_across(i, j), edge_down(i, j + 1),
                                       edge_across(i + 1, j), edge_down(i, j)};
    std::array<Index, 4> crossed{};
    std::size_t count = 0;
    for (std::size_t n = 0; n < 4; ++n) {
      if (corner.at(n) != corner.at((n + 1) % 4)) crossed.at(count++) = edge.at(n);
    }
    if (count == 2) join(crossed[0], crossed[1]);
    if (count != 4) return;
    const double middle =
        (values_(i, j) + values_(i, j + 1) + values_(i + 1, j + 1) + values_(i + 1, j)) / 4.0;
    // At a saddle, the lines cut off the two corners that differ from the middle. Edges 3 and 0
    // meet in corner 0.
    if (corner[0] == (middle > level_)) {
      join(edge[0], edge[1]);
      join(edge[2], edge[3]);
    } else {
      join(edge[3], edge[0]);
      join(edge[1], edge[2]);
    }
  }

  [[nodiscard]] Eigen::Vector2d crossing(Index edge) const {
    const Index node = edge / 2;
    const Index i = node / values_.cols();
    const Index j = node % values_.cols();
    const bool down = edge % 2 == 0;
    const double from = values_(i, j);
    const double to = down ? values_(i + 1, j) : values_(i, j + 1);
    // The outermost nodes count as below whatever their value; the crossing is kept on the edge.
    const double share = (level_ - from) / (to - from);
    const double along = share >= 0.0 && share <= 1.0 ? share : 0.5;
    const auto row = static_cast<double>(i);
    const auto column = static_cast<double>(j);
    return down ? Eigen::Vector2d(row + along, column) : Eigen::Vector2d(row, column + along);
  }

  [[nodiscard]] Eigen::Matrix2Xd ring_from(Index start, std::vector<bool>& seen) {
    std::vector<Index> edges;
    Index edge = start;
    while (edge != kNone && !seen[static_cast<std::size_t>(edge)]) {
      seen[static_cast<std::size_t>(edge)] = true;
      edges.push_back(edge);
      const std::array<Index, 2> next = at(edge);
      edge = !seen[static_cast<std::size_t>(next[0])] ? next[0] : next[1];
    }
    edges.push_back(start);
    Eigen::Matrix2Xd line(2, std::ssize(edges));
    for (Index n = 0; n < line.cols(); ++n) {
      line.col(n) = crossing(edges[static_cast<std::size_t>(n)]);
    }
    return line;
  }

  const Eigen::Ref<const Eigen::MatrixXd>& values_;
  double level_;
  std::vector<std::array<Index, 2>> joined_;  ///< for each edge, its neighbours along the line
};

}  // namespace

std::vector<Eigen::Matrix2Xd> contour_lines(const Eigen::Ref<const Eigen::MatrixXd>& values,
                                            double level) {
  return LineTracer(values, level).lines();
}

}  // namespace qsmpc::harness

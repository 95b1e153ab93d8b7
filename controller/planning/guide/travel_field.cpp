#include "controller/planning/guide/travel_field.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <queue>
#include <stdexcept>
#include <utility>

#include "models/constants.hpp"

namespace qsmpc::controller {
namespace {

using Node = std::pair<Eigen::Index, Eigen::Index>;  // column, row

constexpr std::array<Node, 4> kBeside = {{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};
constexpr std::array<Node, 8> kAround = {
    {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {1, -1}, {-1, 1}, {-1, -1}}};
// Samples of a straight line per spacing of the grid.
constexpr double kSamplesPerSpacing = 2.0;

}  // namespace

TravelField::TravelField(const PlaneGrid& grid, Eigen::ArrayXXd prices, const Eigen::Vector2d& goal)
    : grid_(grid), prices_(std::move(prices)) {
  const bool fits = grid.columns >= 2 && grid.rows >= 2 && prices_.rows() == grid.columns &&
                    prices_.cols() == grid.rows;
  if (!fits || !prices_.isFinite().all() || !(prices_ > 0.0).all()) {
    throw std::invalid_argument("travel field: prices must be positive, one for each node");
  }
  march(goal);
}

/// The upwind solution at a node from its neighbours along each axis.
double TravelField::arrival(Eigen::Index column, Eigen::Index row) const {
  const auto at = [&](Eigen::Index c, Eigen::Index r) {
    const bool inside = c >= 0 && c < grid_.columns && r >= 0 && r < grid_.rows;
    return inside ? costs_(c, r) : kInfinity;
  };
  const double along_x = std::min(at(column - 1, row), at(column + 1, row));
  const double along_y = std::min(at(column, row - 1), at(column, row + 1));
  const double step = grid_.spacing * prices_(column, row);
  const double apart = std::abs(along_x - along_y);
  if (!(apart < step)) return std::min(along_x, along_y) + step;
  return 0.5 * (along_x + along_y + std::sqrt(2.0 * step * step - apart * apart));
}

void TravelField::march(const Eigen::Vector2d& goal) {
  using Entry = std::pair<double, Node>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> front;
  costs_.setConstant(grid_.columns, grid_.rows, kInfinity);
  Eigen::Array<bool, Eigen::Dynamic, Eigen::Dynamic> done =
      Eigen::Array<bool, Eigen::Dynamic, Eigen::Dynamic>::Constant(grid_.columns, grid_.rows,
                                                                   false);
  const Cell cell = cell_at(goal);
  const Eigen::Vector2d inside =
      goal.cwiseMax(grid_.origin).cwiseMin(grid_.node(grid_.columns - 1, grid_.rows - 1));
  for (const Eigen::Index c : {cell.column, cell.column + 1}) {
    for (const Eigen::Index r : {cell.row, cell.row + 1}) {
      costs_(c, r) = prices_(c, r) * (grid_.node(c, r) - inside).norm();
      front.emplace(costs_(c, r), Node(c, r));
    }
  }
  while (!front.empty()) {
    const auto [cost, node] = front.top();
    front.pop();
    const auto [column, row] = node;
    if (done(column, row)) continue;
    done(column, row) = true;
    for (const auto& [right, up] : kBeside) {
      const Eigen::Index c = column + right;
      const Eigen::Index r = row + up;
      if (c < 0 || c >= grid_.columns || r < 0 || r >= grid_.rows || done(c, r)) continue;
      const double later = arrival(c, r);
      if (later < costs_(c, r)) {
        costs_(c, r) = later;
        front.emplace(later, Node(c, r));
      }
    }
  }
}

TravelField::Cell TravelField::cell_at(const Eigen::Vector2d& position) const {
  const auto place = [](double along, Eigen::Index nodes, double& share) {
    const double last = static_cast<double>(nodes - 1);
    const double within = std::clamp(along, 0.0, last);
    const auto index = std::min(static_cast<Eigen::Index>(within), nodes - 2);
    share = within - static_cast<double>(index);
    return index;
  };
  const Eigen::Vector2d along = (position - grid_.origin) / grid_.spacing;
  Cell cell;
  cell.column = place(along.x(), grid_.columns, cell.right);
  cell.row = place(along.y(), grid_.rows, cell.up);
  return cell;
}

double TravelField::interpolate(const Eigen::ArrayXXd& values, const Cell& cell) {
  const Eigen::Index c = cell.column;
  const Eigen::Index r = cell.row;
  const double low = (1.0 - cell.right) * values(c, r) + cell.right * values(c + 1, r);
  const double high = (1.0 - cell.right) * values(c, r + 1) + cell.right * values(c + 1, r + 1);
  return (1.0 - cell.up) * low + cell.up * high;
}

double TravelField::cost(const Eigen::Vector2d& position) const {
  return interpolate(costs_, cell_at(position));
}

double TravelField::cost_of_line(const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                                 double enough) const {
  const double length = (to - from).norm();
  const auto samples = std::lround(std::ceil(kSamplesPerSpacing * length / grid_.spacing));
  const double share = 1.0 / static_cast<double>(std::max(1L, samples));
  double sum = 0.0;
  for (long i = 0; i < samples; ++i) {
    const double at = (static_cast<double>(i) + 0.5) * share;
    sum += interpolate(prices_, cell_at(from + at * (to - from))) * length * share;
    if (sum > enough) break;
  }
  return sum;
}

void TravelField::trace(const Eigen::Vector2d& position, std::vector<Eigen::Vector2d>& way) const {
  const Cell cell = cell_at(position);
  Node node(cell.column + (cell.right > 0.5 ? 1 : 0), cell.row + (cell.up > 0.5 ? 1 : 0));
  way.clear();
  while (true) {
    way.push_back(grid_.node(node.first, node.second));
    Node next = node;
    double steepest = 0.0;
    for (const auto& [right, up] : kAround) {
      const Eigen::Index c = node.first + right;
      const Eigen::Index r = node.second + up;
      if (c < 0 || c >= grid_.columns || r < 0 || r >= grid_.rows) continue;
      const double length = right != 0 && up != 0 ? std::sqrt(2.0) : 1.0;
      const double slope = (costs_(node.first, node.second) - costs_(c, r)) / length;
      if (slope > steepest) {
        steepest = slope;
        next = Node(c, r);
      }
    }
    if (next == node) return;
    node = next;
  }
}

}  // namespace qsmpc::controller

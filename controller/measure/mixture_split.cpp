#include "controller/measure/mixture_split.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <stdexcept>
#include <utility>

#include <Eigen/Eigenvalues>

#include "controller/measure/mixture_kernels.hpp"
#include "controller/storage.hpp"

namespace qsmpc {
namespace {

// Cells that spread at least this fraction of the most spread one are split in the same round, so
// that a round has work for several threads. A split leaves each half less than half the spread of
// a bell along its axis.
constexpr double kRoundShare = 0.5;
// Spreads below this fraction of the whole mixture's are rounding.
constexpr double kNoSpread = 1e-14;
// A side with less than this fraction of its cell's mass is rounding.
constexpr double kNoMass = 1e-12;
// What rounding may take away from the cost, relative to the whole mixture's second moment.
constexpr double kCostRounding = 1e-15;
// A cell whose sources are fewer than this share of its table gets a table of its own.
constexpr double kSparse = 0.5;
constexpr std::size_t kLeastTable = 64;
// Cells whose parts one task lists.
constexpr std::size_t kCellGroup = 64;
// Sources that one task works on; a multiple of kMixturePadding.
constexpr std::size_t kSourceChunk = 2048;

std::size_t padded(std::size_t size) {
  return (size + kMixturePadding - 1) / kMixturePadding * kMixturePadding;
}

/// Spreads that differ by rounding alone, as those of mirror images do, compare as equal.
std::uint32_t rounded(double spread) {
  constexpr int kDropped = 6;  // of the 23 bits of a float
  return std::bit_cast<std::uint32_t>(static_cast<float>(spread)) >> kDropped;
}

/// Sources that cells are made of: names, weights and positions (d x stride).
struct Table {
  std::size_t size = 0;
  std::size_t stride = 0;
  double* name = nullptr;  // whole numbers, as doubles: they move together with the rest
  double* weight = nullptr;
  double* position = nullptr;
};

struct Cell {
  std::size_t table = 0;
  std::array<MixtureInterval, kMixtureDimLimit> intervals{};
  MixtureMoments moments;
  int axis = 0;
  double at = 0.0;  // the mean along the axis
  // Σ mass (x − mean)² along the axis, as a share of the mixture's second moment.
  double spread = 0.0;
};

/// A split that is under way.
struct Split {
  int cell = 0;
  MixtureCut cut{};
  std::size_t first_task = 0;
  std::size_t tasks = 0;
};

}  // namespace

struct MixtureSplitter::Work {
  Work(const Eigen::MatrixXd& covariance, int cells, int parts)
      : dim(static_cast<int>(covariance.rows())), limit(cells), least_share(1.0 / parts) {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(covariance);
    axes = eigen.eigenvectors();
    deviations = eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt();
    centre.resize(dim);
    for (Eigen::MatrixXd* matrix : {&mixture_covariance, &cells_covariance, &product})
      matrix->setZero(dim, dim);
    cell_list.reserve(limit);
    keys.reserve(limit);
    tables.reserve(2 * limit + 1);
    round.reserve(limit);
    splits.reserve(limit);
    copies.reserve(2 * limit);
    places.reserve(limit);
  }

  void start(const Points& sources, const Eigen::VectorXd& weights);
  void choose_axis(std::size_t n);
  bool begin_round();
  void prepare(int index);
  void finish(const Split& split);
  void give_own_table(Cell& cell, std::size_t parts);
  void list(const Executor& run, MixtureCells& out);
  [[nodiscard]] MixtureParts list_cell(std::size_t n);
  void describe(MixtureCells& out);
  void rotate(Eigen::MatrixXd& in_axes, Eigen::MatrixXd& out);

  int dim;
  int limit;
  double least_share;
  Eigen::MatrixXd axes;                // of the noise, columns
  Eigen::VectorXd deviations;          // along them
  Eigen::VectorXd centre;              // mean of the sources
  double second_moment = 0.0;          // of the mixture about the centre
  Eigen::MatrixXd mixture_covariance;  // covariance of the mixture, in the axes
  Eigen::MatrixXd cells_covariance;    // of the cells' means
  Eigen::MatrixXd product;

  Arena arena;
  double* nothing = nullptr;  // zeros, for edges where no cut has been
  std::vector<Table> tables;
  std::vector<Cell> cell_list;
  std::vector<std::uint32_t> keys;  // of the cells: rounded(spread), or 0: not to be split
  std::vector<int> round;
  std::vector<Split> splits;
  std::vector<std::pair<int, std::size_t>> tasks;  // split and first source
  std::vector<MixtureCutResult> results;
  std::vector<MixtureCopy> copies;  // to the tables made in this round
  std::vector<std::size_t> places;  // of a cell's parts in the following two
  std::vector<double> part_mass;
  std::vector<double> part_source;
  std::vector<MixtureParts> listed;  // by cell
};

/// One cell that holds everything.
void MixtureSplitter::Work::start(const Points& sources, const Eigen::VectorXd& weights) {
  arena.reset();
  tables.clear();
  cell_list.clear();
  keys.clear();
  const std::size_t size = weights.size();
  const std::size_t stride = padded(size);
  Table table{.size = size, .stride = stride};
  table.name = arena.take(stride);
  table.weight = arena.take(stride);
  table.position = arena.take(dim * stride);
  std::iota(table.name, table.name + stride, 0.0);
  std::copy(weights.begin(), weights.end(), table.weight);
  std::fill(table.weight + size, table.weight + stride, 0.0);
  for (int a = 0; a < dim; ++a) {
    double sum = 0.0;
    for (std::size_t i = 0; i < size; ++i) sum += weights[i] * sources(a, i);
    centre[a] = sum;
  }
  Cell cell;
  cell.moments.mass = weights.sum();
  second_moment = 0.0;
  nothing = arena.take(3 * stride);
  std::fill(nothing, nothing + 3 * stride, 0.0);
  for (int a = 0; a < dim; ++a) {
    double* const position = table.position + a * stride;
    std::fill(position, position + stride, 0.0);
    for (int b = 0; b < dim; ++b) {
      const double entry = axes(b, a);
      if (entry == 0.0) continue;
      const double* const row = sources.data() + b * sources.cols();
      for (std::size_t i = 0; i < size; ++i) position[i] += entry * (row[i] - centre[b]);
    }
    double* const all = arena.take(3 * stride);
    std::fill(all, all + 3 * stride, 0.0);
    const double variance = deviations[a] * deviations[a];
    for (std::size_t i = 0; i < size; ++i) {
      const double y = position[i];
      all[i] = 1.0;
      all[stride + i] = y;
      all[2 * stride + i] = y * y + variance;
      cell.moments.first[a] += table.weight[i] * y;
      cell.moments.second[a] += table.weight[i] * (y * y + variance);
    }
    cell.intervals[a] = {.lower = nothing, .upper = all};
    second_moment += cell.moments.second[a];
  }
  for (int a = 0; a < dim; ++a) {
    const double* const first = table.position + a * stride;
    for (int b = 0; b <= a; ++b) {
      const double* const second = table.position + b * stride;
      double sum = a == b ? deviations[a] * deviations[a] * cell.moments.mass : 0.0;
      for (std::size_t i = 0; i < size; ++i) sum += table.weight[i] * first[i] * second[i];
      mixture_covariance(a, b) = sum;
    }
  }
  tables.push_back(table);
  cell_list.push_back(cell);
  keys.push_back(0);
  choose_axis(0);
}

void MixtureSplitter::Work::choose_axis(std::size_t n) {
  Cell& cell = cell_list[n];
  keys[n] = 0;
  for (int a = 0; a < dim; ++a) {
    const double mean = cell.moments.first[a] / cell.moments.mass;
    const double spread = (cell.moments.second[a] - mean * cell.moments.first[a]) / second_moment;
    if (!(spread > kNoSpread)) continue;
    const std::uint32_t key = rounded(spread);
    if (key > keys[n]) {
      keys[n] = key;
      cell.axis = a;
      cell.at = mean;
      cell.spread = spread;
    }
  }
}

/// Chooses the cells that are split next; false if there is none.
bool MixtureSplitter::Work::begin_round() {
  splits.clear();
  tasks.clear();
  round.clear();
  const int left = limit - static_cast<int>(cell_list.size());
  const auto most = std::max_element(keys.begin(), keys.end());
  if (left <= 0 || *most == 0) return false;
  const std::uint32_t least =
      std::max(rounded(kRoundShare * cell_list[most - keys.begin()].spread), std::uint32_t{1});
  for (int n = 0; n < static_cast<int>(keys.size()); ++n) {
    if (keys[n] >= least) round.push_back(n);
  }
  std::sort(round.begin(), round.end(),
            [this](int a, int b) { return keys[a] != keys[b] ? keys[a] > keys[b] : a < b; });
  if (static_cast<int>(round.size()) > left) round.resize(left);
  std::size_t chunks = 0;
  for (const int index : round) chunks += tables[cell_list[index].table].size / kSourceChunk + 1;
  make_room(tasks, chunks);
  for (const int index : round) prepare(index);
  make_room(results, tasks.size());
  results.resize(std::max(results.size(), tasks.size()));
  return true;
}

void MixtureSplitter::Work::prepare(int index) {
  const Cell& cell = cell_list[index];
  const Table& table = tables[cell.table];
  Split& split = splits.emplace_back();
  split.cell = index;
  split.first_task = tasks.size();
  MixtureCut& cut = split.cut;
  cut.dim = dim;
  cut.weight = table.weight;
  cut.position = table.position + cell.axis * table.stride;
  cut.stride = table.stride;
  cut.at = cell.at;
  cut.deviation = deviations[cell.axis];
  cut.least_share = least_share;
  cut.edge = arena.take(3 * table.stride);
  cut.intervals[0] = cell.intervals[cell.axis];
  for (int a = 0, b = 1; a < dim; ++a) {
    if (a != cell.axis) cut.intervals[b++] = cell.intervals[a];
  }
  for (std::size_t begin = 0; begin < table.size; begin += kSourceChunk) {
    tasks.emplace_back(static_cast<int>(splits.size()) - 1, begin);
  }
  split.tasks = tasks.size() - split.first_task;
}

/// Puts the two halves in the place of the cell that was split, and at the end.
void MixtureSplitter::Work::finish(const Split& split) {
  MixtureCutResult& sum = results[split.first_task];
  for (std::size_t k = 1; k < split.tasks; ++k) {
    const MixtureCutResult& result = results[split.first_task + k];
    sum.lower.mass += result.lower.mass;
    for (int a = 0; a < dim; ++a) {
      sum.lower.first[a] += result.lower.first[a];
      sum.lower.second[a] += result.lower.second[a];
    }
    sum.lower_parts += result.lower_parts;
    sum.upper_parts += result.upper_parts;
  }
  Cell& cell = cell_list[split.cell];
  const double whole = cell.moments.mass;
  if (!(sum.lower.mass > kNoMass * whole && whole - sum.lower.mass > kNoMass * whole)) {
    keys[split.cell] = 0;
    return;
  }
  const std::size_t last = cell_list.size();
  cell_list.push_back(cell);
  keys.push_back(0);
  Cell& upper = cell_list[last];
  cell.moments.mass = sum.lower.mass;
  upper.moments.mass = whole - sum.lower.mass;
  for (int a = 0, b = 1; a < dim; ++a) {
    const int from = a == cell.axis ? 0 : b++;
    cell.moments.first[a] = sum.lower.first[from];
    cell.moments.second[a] = sum.lower.second[from];
    upper.moments.first[a] -= sum.lower.first[from];
    upper.moments.second[a] -= sum.lower.second[from];
  }
  cell.intervals[cell.axis].upper = split.cut.edge;
  upper.intervals[upper.axis].lower = split.cut.edge;
  give_own_table(cell, sum.lower_parts);
  give_own_table(upper, sum.upper_parts);
  choose_axis(split.cell);
  choose_axis(last);
}

/// Where few of the table's sources have a part in the cell, the cell goes on with these alone, in
/// a table that is yet to be filled.
void MixtureSplitter::Work::give_own_table(Cell& cell, std::size_t parts) {
  const Table old = tables[cell.table];
  if (old.size < kLeastTable ||
      static_cast<double>(parts) > kSparse * static_cast<double>(old.size)) {
    return;
  }
  const std::size_t stride = padded(parts) + kMixturePadding;
  Table own{.size = parts, .stride = stride};
  own.name = arena.take(stride);
  own.weight = arena.take(stride);
  own.position = arena.take(dim * stride);
  MixtureCopy& copy = copies.emplace_back();
  copy.dim = dim;
  copy.intervals = cell.intervals;
  copy.source = old.name;
  copy.weight = old.weight;
  copy.position = old.position;
  copy.size = old.size;
  copy.stride = old.stride;
  copy.parts = parts;
  copy.to_source = own.name;
  copy.to_weight = own.weight;
  copy.to_position = own.position;
  copy.to_stride = stride;
  for (int a = 0; a < dim; ++a) {
    // Zeros are zeros for any choice of sources.
    const bool uncut = cell.intervals[a].lower == nothing;
    copy.to_edges[a] = {uncut ? nullptr : arena.take(3 * stride), arena.take(3 * stride)};
    cell.intervals[a] = {.lower = uncut ? nothing : copy.to_edges[a][0],
                         .upper = copy.to_edges[a][1]};
  }
  cell.table = tables.size();
  tables.push_back(own);
}

/// From the noise's axes, of which the lower triangle is given, to the state's.
void MixtureSplitter::Work::rotate(Eigen::MatrixXd& in_axes, Eigen::MatrixXd& out) {
  in_axes.triangularView<Eigen::StrictlyUpper>() = in_axes.transpose();
  product.noalias() = axes * in_axes;
  out.noalias() = product * axes.transpose();
}

/// Lists the parts of all cells: first each cell's in a place of its own, then side by side.
void MixtureSplitter::Work::list(const Executor& run, MixtureCells& out) {
  places.clear();
  std::size_t room = 0;
  for (const Cell& cell : cell_list) {
    places.push_back(room);
    room += tables[cell.table].stride + kMixturePadding;
  }
  make_room(part_mass, room);
  make_room(part_source, room);
  part_mass.resize(std::max(part_mass.size(), room));
  part_source.resize(std::max(part_source.size(), room));
  listed.resize(cell_list.size());
  const int groups = static_cast<int>((cell_list.size() + kCellGroup - 1) / kCellGroup);
  const auto for_cells = [&](const auto& action) {
    const auto group = [&](int index) {
      const std::size_t begin = index * kCellGroup;
      const std::size_t end = std::min(begin + kCellGroup, cell_list.size());
      for (std::size_t n = begin; n < end; ++n) action(n);
    };
    if (room < kSourceChunk) {
      run_in_turn(groups, group);
    } else {
      run(groups, group);
    }
  };
  for_cells([&](std::size_t n) { listed[n] = list_cell(n); });
  out.begin.assign(1, 0);
  std::size_t total = 0;
  std::size_t count = 0;
  for (std::size_t n = 0; n < listed.size(); ++n) {
    // By differences of moments a cell may have some mass, of which rounding is all.
    if (listed[n].count == 0) continue;
    cell_list[count] = cell_list[n];
    places[count] = places[n];
    listed[count++] = listed[n];
    total += listed[n].count;
    out.begin.push_back(static_cast<int>(total));
  }
  cell_list.resize(count);
  make_room(out.source, total);
  make_room(out.mass, total);
  out.source.resize(total);
  out.mass.resize(total);
  for_cells([&](std::size_t n) {
    if (n >= count) return;
    const std::size_t from = places[n];
    std::copy_n(part_mass.begin() + from, listed[n].count, out.mass.begin() + out.begin[n]);
    for (std::size_t k = 0; k < listed[n].count; ++k) {
      out.source[out.begin[n] + k] = static_cast<int>(part_source[from + k]);
    }
  });
  describe(out);
}

MixtureParts MixtureSplitter::Work::list_cell(std::size_t n) {
  const Cell& cell = cell_list[n];
  const Table& table = tables[cell.table];
  MixtureCell finished{.dim = dim,
                       .intervals = cell.intervals,
                       .weight = table.weight,
                       .source = table.name,
                       .stride = table.stride};
  for (int a = 0; a < dim; ++a) finished.position[a] = table.position + a * table.stride;
  return list_mixture_parts(finished, table.size, part_mass.data() + places[n],
                            part_source.data() + places[n]);
}

/// Weights and means of the cells that were listed.
void MixtureSplitter::Work::describe(MixtureCells& out) {
  const std::size_t count = cell_list.size();
  cells_covariance.setZero();
  out.weight.resize(count);
  out.mean.resize(dim * count);
  out.noise_mean.resize(dim * count);
  for (std::size_t n = 0; n < count; ++n) {
    const MixtureParts& parts = listed[n];
    out.weight[n] = parts.mass;
    for (int a = 0; a < dim; ++a) {
      for (int b = 0; b <= a; ++b) {
        cells_covariance(a, b) += parts.first[a] * parts.first[b] / parts.mass;
      }
    }
    for (int b = 0; b < dim; ++b) {
      double mean = 0.0;
      double noise = 0.0;
      for (int a = 0; a < dim; ++a) {
        mean += axes(b, a) * parts.first[a];
        noise += axes(b, a) * parts.noise[a];
      }
      out.mean[b * count + n] = mean / parts.mass;
      out.noise_mean[b * count + n] = noise / parts.mass;
    }
  }
}

MixtureSplitter::MixtureSplitter(const Eigen::MatrixXd& covariance, int cells, int parts) {
  check_gaussian({.mean = Eigen::VectorXd::Zero(covariance.rows()), .covariance = covariance});
  if (covariance.rows() > kMixtureDimLimit) {
    throw std::invalid_argument("mixture: at most " + std::to_string(kMixtureDimLimit) +
                                " dimensions");
  }
  if (cells < 1 || parts < 1) {
    throw std::invalid_argument("mixture: at least one cell and one part are needed");
  }
  work_ = std::make_unique<Work>(covariance, cells, parts);
}

MixtureSplitter::~MixtureSplitter() = default;

void MixtureSplitter::split(const Points& sources, const Eigen::VectorXd& weights,
                            const Executor& run, MixtureCells& out) {
  Work& work = *work_;
  work.start(sources, weights);
  while (work.begin_round()) {
    const auto task = [&work](int k) {
      const auto [split, begin] = work.tasks[k];
      const MixtureCut& cut = work.splits[split].cut;
      const std::size_t size = work.tables[work.cell_list[work.splits[split].cell].table].size;
      work.results[k] = cut_mixture(cut, begin, std::min(size, begin + kSourceChunk));
    };
    run(static_cast<int>(work.tasks.size()), task);
    work.copies.clear();
    for (const Split& split : work.splits) work.finish(split);
    const auto fill = [&work](int k) { copy_mixture_parts(work.copies[k]); };
    run(static_cast<int>(work.copies.size()), fill);
  }
  work.list(run, out);
  // The cost is what the cells lack of the mixture's second moment.
  out.w2 = std::sqrt(std::max(0.0, work.second_moment - work.cells_covariance.trace()) +
                     kCostRounding * work.second_moment);
  work.rotate(work.cells_covariance, out.covariance);
  work.rotate(work.mixture_covariance, out.whole_covariance);
}

}  // namespace qsmpc

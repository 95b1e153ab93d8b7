#include "controller/measure/compression/mixture_split.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <numeric>
#include <stdexcept>

#include "controller/measure/compression/mixture_cells.hpp"
#include "controller/storage.hpp"
#include "models/linear_algebra.hpp"

namespace qsmpc::controller {
namespace {

// Allowance for rounding in the cost, relative to the whole mixture's second moment.
constexpr double kCostRounding = 1e-15;
// A round cuts the cells whose spread is at least the largest one divided by a ratio between these
// two, and cuts them again until their pieces spread less. Early cells have a far larger spread
// than the final ones, which allows a large ratio; but more rounds balance the work between threads
// better.
constexpr double kLeastRatio = 2.0;
constexpr double kMostRatio = 16.0;
// Number of sources that justifies a task of its own.
constexpr std::size_t kTaskSources = 2048;
// Number of cells whose parts one task lists.
constexpr std::size_t kCellGroup = 64;

}  // namespace

struct MixtureSplitter::Work {
  Work(const Eigen::MatrixXd& covariance, int cells, int parts);

  void start(const Points& sources, const Eigen::VectorXd& weights);
  bool begin_round();
  void run_task(std::size_t task);
  void merge();
  void list(const Executor& run, MixtureCells& out);
  [[nodiscard]] MixtureParts list_box(std::size_t n);
  void describe(std::size_t n, std::size_t count, MixtureCells& out);
  void rotate(Eigen::MatrixXd& in_axes, Eigen::MatrixXd& out);
  [[nodiscard]] CellCutter& borrow();
  void hand_back(CellCutter& cutter);

  /// One of the cells that a round cuts.
  struct Chosen {
    std::ptrdiff_t place = 0;   // in the list of boxes
    std::ptrdiff_t pieces = 0;  // number that it was cut into
  };
  struct Task {
    std::size_t begin = 0;  // of the chosen
    std::size_t end = 0;
  };

  int limit;
  Eigen::MatrixXd axes;    // of the noise, columns
  Eigen::VectorXd centre;  // mean of the sources
  MixtureFrame frame;
  Eigen::MatrixXd mixture_covariance;  // covariance of the mixture, in the axes
  Eigen::MatrixXd cells_covariance;    // of the cells' means
  Eigen::MatrixXd product;

  std::vector<ListedBox> boxes;  // neighbours in a cut follow one another, the lower one first
  std::vector<ListedBox> merged;
  std::vector<Chosen> round;
  std::vector<ListedBox> pieces;  // of the chosen, `most` places each
  std::uint32_t least = 0;        // least key that is cut in the round
  std::size_t most = 0;           // largest number of pieces of a cell
  std::vector<Task> tasks;
  std::vector<std::unique_ptr<CellCutter>> cutters;
  std::vector<CellCutter*> idle;
  std::mutex mutex;  // guards the idle cutters

  std::vector<std::size_t> places;  // of a cell's parts in the next two arrays
  std::vector<double> part_mass;
  std::vector<double> part_source;
  std::vector<MixtureParts> listed;  // by cell
};

MixtureSplitter::Work::Work(const Eigen::MatrixXd& covariance, int cells, int parts)
    : limit(cells) {
  const models::SymmetricEigen eigen = models::symmetric_eigen(covariance);
  axes = eigen.vectors;
  frame.dim = static_cast<int>(covariance.rows());
  frame.deviations = eigen.values.cwiseMax(0.0).cwiseSqrt();
  frame.least_share = 1.0 / parts;
  centre.resize(frame.dim);
  for (Eigen::MatrixXd* matrix : {&mixture_covariance, &cells_covariance, &product})
    matrix->setZero(frame.dim, frame.dim);
  for (auto* list : {&boxes, &merged}) list->reserve(limit);
  round.reserve(limit);
  tasks.reserve(limit);
  pieces.resize(2 * static_cast<std::size_t>(limit));
}

CellCutter& MixtureSplitter::Work::borrow() {
  const std::scoped_lock lock(mutex);
  if (idle.empty()) {
    idle.push_back(cutters.emplace_back(std::make_unique<CellCutter>()).get());
    idle.reserve(cutters.size());
  }
  CellCutter& cutter = *idle.back();
  idle.pop_back();
  return cutter;
}

void MixtureSplitter::Work::hand_back(CellCutter& cutter) {
  const std::scoped_lock lock(mutex);
  idle.push_back(&cutter);
}

/// Starts with one cell that holds everything.
void MixtureSplitter::Work::start(const Points& sources, const Eigen::VectorXd& weights) {
  for (const auto& cutter : cutters) cutter->pool().reset();
  CellCutter& cutter = borrow();
  const int dim = frame.dim;
  const std::size_t size = weights.size();
  SourceTable& table = *cutter.make_table(frame, size);
  const std::size_t stride = table.stride;
  std::iota(table.name, table.name + stride, 0.0);
  std::copy(weights.begin(), weights.end(), table.weight);
  std::fill(table.weight + size, table.weight + stride, 0.0);
  for (int a = 0; a < dim; ++a) {
    double sum = 0.0;
    for (std::size_t i = 0; i < size; ++i) sum += weights[i] * sources(a, i);
    centre[a] = sum;
  }
  MixtureBox& box = *cutter.make_box();
  box.table = &table;
  box.moments.mass = weights.sum();
  frame.second_moment = 0.0;
  frame.nothing = cutter.pool().take(3 * stride)->data();
  std::fill(frame.nothing, frame.nothing + 3 * stride, 0.0);
  for (int a = 0; a < dim; ++a) {
    double* const position = table.position + a * stride;
    std::fill(position, position + stride, 0.0);
    for (int b = 0; b < dim; ++b) {
      const double entry = axes(b, a);
      if (entry == 0.0) continue;
      const double* const row = sources.data() + b * sources.cols();
      for (std::size_t i = 0; i < size; ++i) position[i] += entry * (row[i] - centre[b]);
    }
    double* const all = cutter.take(table, 3 * stride);
    std::fill(all, all + 3 * stride, 0.0);
    const double variance = frame.deviations[a] * frame.deviations[a];
    for (std::size_t i = 0; i < size; ++i) {
      const double y = position[i];
      all[i] = 1.0;
      all[stride + i] = y;
      all[2 * stride + i] = y * y + variance;
      box.moments.first[a] += table.weight[i] * y;
      box.moments.second[a] += table.weight[i] * (y * y + variance);
    }
    box.intervals[a] = {.lower = frame.nothing, .upper = all};
    frame.second_moment += box.moments.second[a];
  }
  for (int a = 0; a < dim; ++a) {
    const double* const first = table.position + a * stride;
    for (int b = 0; b <= a; ++b) {
      const double* const second = table.position + b * stride;
      double sum = a == b ? frame.deviations[a] * frame.deviations[a] * box.moments.mass : 0.0;
      for (std::size_t i = 0; i < size; ++i) sum += table.weight[i] * first[i] * second[i];
      mixture_covariance(a, b) = sum;
    }
  }
  CellCutter::choose_axis(frame, box);
  boxes.assign(1, {&box, box.key, static_cast<std::uint32_t>(size)});
  hand_back(cutter);
}

/// Chooses the cells to cut next and divides them into tasks; returns false if there are none.
bool MixtureSplitter::Work::begin_round() {
  const auto by_key = [](const ListedBox& a, const ListedBox& b) { return a.key < b.key; };
  const ListedBox& widest = *std::max_element(boxes.begin(), boxes.end(), by_key);
  const std::size_t left = limit - boxes.size();
  if (left == 0 || widest.key == 0) return false;
  const double ratio = std::clamp(static_cast<double>(limit) / static_cast<double>(boxes.size()),
                                  kLeastRatio, kMostRatio);
  least = std::max(rounded_spread(widest.box->spread / ratio), std::uint32_t{1});
  round.clear();
  for (std::size_t n = 0; n < boxes.size(); ++n) {
    if (boxes[n].key >= least) round.push_back({.place = static_cast<std::ptrdiff_t>(n)});
  }
  most = 1 + left / round.size();
  if (round.size() >= left) {
    // The last cuts: the most spread cells, each once.
    most = 2;
    const auto before = [this](const Chosen& a, const Chosen& b) {
      const std::uint32_t key = boxes[a.place].key;
      const std::uint32_t other = boxes[b.place].key;
      return key != other ? key > other : a.place < b.place;
    };
    std::nth_element(round.begin(), round.begin() + (left - 1), round.end(), before);
    round.resize(left);
    std::sort(round.begin(), round.end(),
              [](const Chosen& a, const Chosen& b) { return a.place < b.place; });
  }
  tasks.clear();
  std::size_t sources = kTaskSources;  // of the current task
  for (std::size_t n = 0; n < round.size(); ++n) {
    if (sources >= kTaskSources) {
      tasks.push_back({.begin = n});
      sources = 0;
    }
    sources += boxes[round[n].place].sources;
    tasks.back().end = n + 1;
  }
  return true;
}

void MixtureSplitter::Work::run_task(std::size_t task) {
  CellCutter& cutter = borrow();
  for (std::size_t n = tasks[task].begin; n < tasks[task].end; ++n) {
    round[n].pieces =
        cutter.refine(frame, boxes[round[n].place].box, least, most, pieces.data() + n * most);
  }
  hand_back(cutter);
}

/// Replaces the cells that were cut by their pieces, in place.
void MixtureSplitter::Work::merge() {
  merged.clear();
  std::ptrdiff_t from = 0;
  for (std::size_t n = 0; n < round.size(); ++n) {
    const auto own = pieces.begin() + static_cast<std::ptrdiff_t>(n * most);
    merged.insert(merged.end(), boxes.begin() + from, boxes.begin() + round[n].place);
    merged.insert(merged.end(), own, own + round[n].pieces);
    from = round[n].place + 1;
  }
  merged.insert(merged.end(), boxes.begin() + from, boxes.end());
  boxes.swap(merged);
}

/// Rotates a matrix, given by its lower triangle, from the noise's axes to the state's.
void MixtureSplitter::Work::rotate(Eigen::MatrixXd& in_axes, Eigen::MatrixXd& out) {
  in_axes.triangularView<Eigen::StrictlyUpper>() = in_axes.transpose();
  product.noalias() = axes * in_axes;
  out.noalias() = product * axes.transpose();
}

/// Lists the parts of all cells: first each cell's in its own range, then contiguously.
void MixtureSplitter::Work::list(const Executor& run, MixtureCells& out) {
  places.clear();
  make_room(places, boxes.size());
  std::size_t room = 0;
  for (const ListedBox& listed_box : boxes) {
    places.push_back(room);
    room += padded_sources(listed_box.sources) + kMixturePadding;
  }
  make_room(part_mass, room);
  make_room(part_source, room);
  part_mass.resize(std::max(part_mass.size(), room));
  part_source.resize(std::max(part_source.size(), room));
  make_room(listed, boxes.size());
  listed.resize(boxes.size());
  const int groups = static_cast<int>((boxes.size() + kCellGroup - 1) / kCellGroup);
  const auto for_cells = [&](const auto& action) {
    const auto group = [&](int index) {
      const std::size_t begin = index * kCellGroup;
      const std::size_t end = std::min(begin + kCellGroup, boxes.size());
      for (std::size_t n = begin; n < end; ++n) action(n);
    };
    if (room < kTaskSources) {
      run_in_turn(groups, group);
    } else {
      run(groups, group);
    }
  };
  for_cells([&](std::size_t n) { listed[n] = list_box(n); });
  out.begin.assign(1, 0);
  std::size_t total = 0;
  std::size_t count = 0;
  for (std::size_t n = 0; n < listed.size(); ++n) {
    // A cell's mass, as a difference of moments, may be nothing but rounding.
    if (listed[n].count == 0) continue;
    places[count] = places[n];
    listed[count++] = listed[n];
    total += listed[n].count;
    out.begin.push_back(static_cast<int>(total));
  }
  make_room(out.source, total);
  make_room(out.mass, total);
  out.source.resize(total);
  out.mass.resize(total);
  out.weight.resize(count);
  out.mean.resize(frame.dim * count);
  out.noise_mean.resize(frame.dim * count);
  for_cells([&](std::size_t n) {
    if (n >= count) return;
    const std::size_t from = places[n];
    std::copy_n(part_mass.begin() + from, listed[n].count, out.mass.begin() + out.begin[n]);
    for (std::size_t k = 0; k < listed[n].count; ++k) {
      out.source[out.begin[n] + k] = static_cast<int>(part_source[from + k]);
    }
    describe(n, count, out);
  });
  cells_covariance.setZero();
  for (std::size_t n = 0; n < count; ++n) {
    const MixtureParts& parts = listed[n];
    for (int a = 0; a < frame.dim; ++a) {
      const double share = parts.first[a] / parts.mass;
      for (int b = 0; b <= a; ++b) cells_covariance(a, b) += share * parts.first[b];
    }
  }
}

MixtureParts MixtureSplitter::Work::list_box(std::size_t n) {
  const MixtureBox& box = *boxes[n].box;
  const SourceTable& table = *box.table;
  MixtureCell finished{.dim = frame.dim,
                       .intervals = box.intervals,
                       .weight = table.weight,
                       .source = table.name,
                       .stride = table.stride};
  for (int a = 0; a < frame.dim; ++a) finished.position[a] = table.position + a * table.stride;
  return list_mixture_parts(finished, table.size, part_mass.data() + places[n],
                            part_source.data() + places[n]);
}

/// Weight and means of a cell that was listed.
void MixtureSplitter::Work::describe(std::size_t n, std::size_t count, MixtureCells& out) {
  const MixtureParts& parts = listed[n];
  out.weight[n] = parts.mass;
  for (int b = 0; b < frame.dim; ++b) {
    double mean = 0.0;
    double noise = 0.0;
    for (int a = 0; a < frame.dim; ++a) {
      mean += axes(b, a) * parts.first[a];
      noise += axes(b, a) * parts.noise[a];
    }
    out.mean[b * count + n] = mean / parts.mass;
    out.noise_mean[b * count + n] = noise / parts.mass;
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
    const auto task = [&work](int n) { work.run_task(n); };
    const int count = static_cast<int>(work.tasks.size());
    if (count == 1) {
      run_in_turn(count, task);
    } else {
      run(count, task);
    }
    work.merge();
  }
  work.list(run, out);
  // The cost is the part of the mixture's second moment that the cells' means lack.
  out.w2 = std::sqrt(std::max(0.0, work.frame.second_moment - work.cells_covariance.trace()) +
                     kCostRounding * work.frame.second_moment);
  work.rotate(work.cells_covariance, out.covariance);
  work.rotate(work.mixture_covariance, out.whole_covariance);
}

}  // namespace qsmpc::controller

#include "controller/measure/compression/mixture_cells.hpp"

#include <bit>
#include <memory>

namespace qsmpc::controller {
namespace {

// Spreads below this fraction of the whole mixture's are rounding.
constexpr double kNoSpread = 1e-14;
// A side with less than this fraction of its cell's mass is rounding.
constexpr double kNoMass = 1e-12;
// A cell with parts of at most this share of its table's sources gets a table of its own.
constexpr double kSparse = 0.5;
constexpr std::size_t kLeastTable = 64;

constexpr std::size_t doubles_of(std::size_t bytes) {
  return (bytes + sizeof(double) - 1) / sizeof(double);
}

}  // namespace

std::uint32_t rounded_spread(double spread) {
  constexpr int kDropped = 6;  // of the 23 bits of a float
  return std::bit_cast<std::uint32_t>(static_cast<float>(spread)) >> kDropped;
}

std::size_t padded_sources(std::size_t size) {
  return (size + kMixturePadding - 1) / kMixturePadding * kMixturePadding;
}

SourceTable* CellCutter::make_table(const MixtureFrame& frame, std::size_t size) {
  Block* const block = pool_.take(doubles_of(sizeof(SourceTable)));
  auto* const table = std::construct_at(reinterpret_cast<SourceTable*>(block->data()));
  table->size = size;
  // Copies are written in whole vectors, past their end.
  table->stride = padded_sources(size) + kMixturePadding;
  table->own = block;
  table->users = 1;
  table->name = take(*table, (2 + frame.dim) * table->stride);
  table->weight = table->name + table->stride;
  table->position = table->weight + table->stride;
  return table;
}

MixtureBox* CellCutter::make_box() {
  Block* const block = pool_.take(doubles_of(sizeof(MixtureBox)));
  return std::construct_at(reinterpret_cast<MixtureBox*>(block->data()));
}

double* CellCutter::take(SourceTable& table, std::size_t count) {
  Block* const block = pool_.take(count);
  // Several threads may work on cells of one table.
  block->next = table.chain.load(std::memory_order_relaxed);
  while (!table.chain.compare_exchange_weak(block->next, block, std::memory_order_release,
                                            std::memory_order_relaxed)) {
  }
  return block->data();
}

void CellCutter::release(SourceTable& table) {
  if (table.users.fetch_sub(1, std::memory_order_acq_rel) > 1) return;
  Block* block = table.chain.load(std::memory_order_acquire);
  while (block != nullptr) {
    Block* const next = block->next;
    pool_.give_back(block);
    block = next;
  }
  pool_.give_back(table.own);
}

void CellCutter::choose_axis(const MixtureFrame& frame, MixtureBox& box) {
  const MixtureMoments& moments = box.moments;
  box.key = 0;
  for (int a = 0; a < frame.dim; ++a) {
    const double mean = moments.first[a] / moments.mass;
    const double spread = (moments.second[a] - mean * moments.first[a]) / frame.second_moment;
    if (!(spread > kNoSpread)) continue;
    const std::uint32_t key = rounded_spread(spread);
    if (key > box.key) {
      box.key = key;
      box.axis = a;
      box.at = mean;
      box.spread = spread;
    }
  }
}

std::ptrdiff_t CellCutter::refine(const MixtureFrame& frame, MixtureBox* box, std::uint32_t least,
                                  std::size_t most, ListedBox* out) {
  ListedBox* const begin = out;
  std::size_t pieces = 1;
  pending_.assign(1, box);
  while (!pending_.empty()) {
    MixtureBox* const next = pending_.back();
    pending_.pop_back();
    MixtureBox* const upper = next->key >= least && pieces < most ? cut(frame, *next) : nullptr;
    if (upper == nullptr) {
      *out++ = {next, next->key, static_cast<std::uint32_t>(next->table->size)};
      continue;
    }
    ++pieces;
    pending_.push_back(upper);
    pending_.push_back(next);
  }
  return out - begin;
}

/// Leaves the lower half in `box` and returns the upper one; null if one of them would be empty.
MixtureBox* CellCutter::cut(const MixtureFrame& frame, MixtureBox& box) {
  SourceTable& table = *box.table;
  double* const edge = take(table, 3 * table.stride);
  MixtureCut cut{.dim = frame.dim,
                 .weight = table.weight,
                 .position = table.position + box.axis * table.stride,
                 .stride = table.stride,
                 .at = box.at,
                 .deviation = frame.deviations[box.axis],
                 .least_share = frame.least_share,
                 .edge = edge};
  cut.intervals[0] = box.intervals[box.axis];
  for (int a = 0, b = 1; a < frame.dim; ++a) {
    if (a != box.axis) cut.intervals[b++] = box.intervals[a];
  }
  const MixtureCutResult sum = cut_mixture(cut, 0, table.size);
  const double whole = box.moments.mass;
  if (!(sum.lower.mass > kNoMass * whole && whole - sum.lower.mass > kNoMass * whole)) {
    box.key = 0;
    return nullptr;
  }
  MixtureBox& upper = *make_box();
  upper = box;
  table.users.fetch_add(1, std::memory_order_relaxed);
  box.moments.mass = sum.lower.mass;
  upper.moments.mass = whole - sum.lower.mass;
  for (int a = 0, b = 1; a < frame.dim; ++a) {
    const int from = a == box.axis ? 0 : b++;
    box.moments.first[a] = sum.lower.first[from];
    box.moments.second[a] = sum.lower.second[from];
    upper.moments.first[a] -= sum.lower.first[from];
    upper.moments.second[a] -= sum.lower.second[from];
  }
  box.intervals[box.axis].upper = edge;
  upper.intervals[upper.axis].lower = edge;
  give_own_table(frame, box, sum.lower_parts);
  give_own_table(frame, upper, sum.upper_parts);
  choose_axis(frame, box);
  choose_axis(frame, upper);
  return &upper;
}

/// If few of the table's sources have a part in the box, gives it a table of only these.
void CellCutter::give_own_table(const MixtureFrame& frame, MixtureBox& box, std::size_t parts) {
  SourceTable& old = *box.table;
  if (old.size < kLeastTable ||
      static_cast<double>(parts) > kSparse * static_cast<double>(old.size)) {
    return;
  }
  SourceTable& own = *make_table(frame, parts);
  MixtureCopy copy{.dim = frame.dim,
                   .intervals = box.intervals,
                   .source = old.name,
                   .weight = old.weight,
                   .position = old.position,
                   .size = old.size,
                   .stride = old.stride,
                   .parts = parts,
                   .to_source = own.name,
                   .to_weight = own.weight,
                   .to_position = own.position,
                   .to_stride = own.stride};
  int edges = 0;
  for (int a = 0; a < frame.dim; ++a) edges += box.intervals[a].lower == frame.nothing ? 1 : 2;
  double* at = take(own, 3 * own.stride * edges);
  const auto next_edge = [&] {
    double* const edge = at;
    at += 3 * own.stride;
    return edge;
  };
  for (int a = 0; a < frame.dim; ++a) {
    // The edge of zeros serves for any choice of sources.
    const bool uncut = box.intervals[a].lower == frame.nothing;
    copy.to_edges[a][0] = uncut ? nullptr : next_edge();
    copy.to_edges[a][1] = next_edge();
    box.intervals[a] = {.lower = uncut ? frame.nothing : copy.to_edges[a][0],
                        .upper = copy.to_edges[a][1]};
  }
  copy_mixture_parts(copy);
  box.table = &own;
  release(old);
}

}  // namespace qsmpc::controller

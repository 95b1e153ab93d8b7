#include "harness/statistics/rank_selection.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <map>
#include <stdexcept>

namespace qsmpc::harness {
namespace {

constexpr unsigned kKeyBits = 64;
constexpr unsigned kBitsPerPass = 16;
constexpr std::uint64_t kSign = std::uint64_t{1} << 63U;

/// An order-preserving map from doubles to unsigned integers.
std::uint64_t key_of(double value) {
  const auto bits = std::bit_cast<std::uint64_t>(value == 0.0 ? 0.0 : value);  // −0 counts as 0
  return (bits & kSign) != 0 ? ~bits : bits | kSign;
}

double value_of(std::uint64_t key) {
  return std::bit_cast<double>((key & kSign) != 0 ? key & ~kSign : ~key);
}

/// What is known of a wanted value: the leading bits of its key.
struct Candidate {
  std::uint64_t prefix = 0;
  std::int64_t rank = 0;   ///< among the values with this prefix, from 1
  std::int64_t count = 0;  ///< number of values with this prefix
};

class RankSelection {
 public:
  RankSelection(const ValueStream& each, std::int64_t count, const std::vector<std::int64_t>& ranks)
      : each_(each) {
    for (const std::int64_t rank : ranks) {
      if (rank < 1 || rank > count) throw std::invalid_argument("ranks: a rank out of range");
      wanted_.push_back({.prefix = 0, .rank = rank, .count = count});
    }
  }

  std::vector<double> values(std::int64_t most_kept) {
    while (known_bits_ < kKeyBits && candidates() > most_kept) narrow();
    if (known_bits_ < kKeyBits) return sorted();
    std::vector<double> values;
    for (const Candidate& one : wanted_) values.push_back(value_of(one.prefix));
    return values;
  }

 private:
  [[nodiscard]] std::uint64_t prefix_of(std::uint64_t key) const {
    return known_bits_ == 0 ? 0 : key >> (kKeyBits - known_bits_);
  }

  [[nodiscard]] std::int64_t candidates() const {
    std::map<std::uint64_t, std::int64_t> counts;
    for (const Candidate& one : wanted_) counts[one.prefix] = one.count;
    std::int64_t sum = 0;
    for (const auto& [prefix, count] : counts) sum += count;
    return sum;
  }

  /// Reads the stream and determines kBitsPerPass more bits of each wanted value.
  void narrow() {
    constexpr std::uint64_t kBuckets = std::uint64_t{1} << kBitsPerPass;
    std::map<std::uint64_t, std::vector<std::int64_t>> counts;
    for (const Candidate& one : wanted_) counts[one.prefix].resize(kBuckets);
    const unsigned shift = kKeyBits - known_bits_ - kBitsPerPass;
    each_([&](double value) {
      const std::uint64_t key = key_of(value);
      const auto found = counts.find(prefix_of(key));
      if (found != counts.end()) ++found->second[(key >> shift) & (kBuckets - 1)];
    });
    for (Candidate& one : wanted_) {
      const std::vector<std::int64_t>& buckets = counts.at(one.prefix);
      std::uint64_t bucket = 0;
      while (bucket + 1 < kBuckets && one.rank > buckets[bucket]) one.rank -= buckets[bucket++];
      one.prefix = (one.prefix << kBitsPerPass) | bucket;
      one.count = buckets[bucket];
    }
    known_bits_ += kBitsPerPass;
  }

  /// Reads the stream and sorts the remaining candidates.
  [[nodiscard]] std::vector<double> sorted() const {
    std::map<std::uint64_t, std::vector<double>> kept;
    for (const Candidate& one : wanted_) kept[one.prefix];
    each_([&](double value) {
      const auto found = kept.find(prefix_of(key_of(value)));
      if (found != kept.end()) found->second.push_back(value);
    });
    for (auto& [prefix, values] : kept) std::ranges::sort(values);
    std::vector<double> values;
    for (const Candidate& one : wanted_) {
      values.push_back(kept.at(one.prefix).at(static_cast<std::size_t>(one.rank - 1)));
    }
    return values;
  }

  const ValueStream& each_;
  std::vector<Candidate> wanted_{};
  unsigned known_bits_ = 0;
};

}  // namespace

std::vector<double> values_at_ranks(const ValueStream& each, std::int64_t count,
                                    const std::vector<std::int64_t>& ranks,
                                    std::int64_t most_kept) {
  return RankSelection(each, count, ranks).values(most_kept);
}

void KeptValues::add(double value) {
  ++count_;
  sum_ += value;
  if (has_all()) {
    values_.push_back(value);
  } else if (!values_.empty()) {
    std::vector<double>().swap(values_);
  }
}

const std::vector<double>& KeptValues::sorted() {
  std::ranges::sort(values_);
  return values_;
}

Distribution KeptValues::distribution(const ValueStream& each) {
  if (count_ == 0) return SortedDistribution(0).result();
  std::vector<std::int64_t> ranks;
  for (const double share : distribution_shares()) ranks.push_back(nearest_rank(share, count_));
  const std::vector<double> values =
      has_all() ? selected(ranks) : values_at_ranks(each, count_, ranks, most_kept_);
  return {.median = values[0],
          .p95 = values[1],
          .p99 = values[2],
          .max = values[3],
          .mean = sum_ / static_cast<double>(count_)};
}

/// The values at ascending ranks (1 … count) of the kept values, which are reordered.
std::vector<double> KeptValues::selected(const std::vector<std::int64_t>& ranks) {
  std::vector<double> values;
  auto begin = values_.begin();
  for (const std::int64_t rank : ranks) {
    const auto place = values_.begin() + (rank - 1);
    if (place >= begin) std::nth_element(begin, place, values_.end());
    begin = std::max(begin, place + 1);
    values.push_back(*place);
  }
  return values;
}

}  // namespace qsmpc::harness

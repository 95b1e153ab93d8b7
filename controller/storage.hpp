// Reusable storage for data of similar size from use to use.
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <new>
#include <vector>

#pragma GCC visibility push(default)

namespace qsmpc::controller {

/// Allocates memory aligned to cache lines, so that SIMD vectors as wide as a line never straddle
/// two.
template <class T>
struct LineAllocator {
  using value_type = T;
  static constexpr std::align_val_t kLine{64};

  LineAllocator() = default;
  template <class Other>
  // NOLINTNEXTLINE(google-explicit-constructor): containers convert their allocators.
  LineAllocator(const LineAllocator<Other>&) {}
  [[nodiscard]] T* allocate(std::size_t count) {
    return static_cast<T*>(::operator new(count * sizeof(T), kLine));
  }
  void deallocate(T* data, std::size_t) { ::operator delete(data, kLine); }
  bool operator==(const LineAllocator&) const { return true; }
};

/// Doubles aligned to cache lines.
using LineVector = std::vector<double, LineAllocator<double>>;

/// Reserves room for `count` entries; where the capacity is too small, for twice as many, so that
/// counts that vary from use to use soon cause no more allocations.
template <class T, class Allocator>
void make_room(std::vector<T, Allocator>& entries, std::size_t count) {
  if (entries.capacity() < count) entries.reserve(2 * count);
}

/// Arena of doubles: memory is handed out piece by piece and released all at once.
class Arena {
 public:
  /// `count` doubles of unspecified value, aligned to a cache line.
  double* take(std::size_t count) {
    count = (count + kLine - 1) / kLine * kLine;
    while (at_ < slabs_.size() && used_ + count > slabs_[at_].size) {
      ++at_;
      used_ = 0;
    }
    if (at_ == slabs_.size()) {
      add_slab(count);
      used_ = 0;
    }
    double* const begin = slabs_[at_].data.get() + used_;
    used_ += count;
    given_ += count;
    return begin;
  }
  /// Releases everything, and ensures room for at least 1.5 times the most handed out between two
  /// resets.
  void reset() {
    most_ = std::max(most_, given_);
    std::size_t room = 0;
    for (const Slab& slab : slabs_) room += slab.size;
    if (room < most_ + most_ / 2) add_slab(3 * most_ - room);
    at_ = 0;
    used_ = 0;
    given_ = 0;
  }

 private:
  static constexpr std::size_t kLine = 64 / sizeof(double);
  static constexpr std::size_t kSlab = std::size_t{1} << 17;  // doubles
  struct Release {
    void operator()(double* data) const { LineAllocator<double>{}.deallocate(data, 0); }
  };
  // Uninitialised: spare room that is never used takes addresses but no memory.
  struct Slab {
    std::size_t size = 0;  // doubles
    std::unique_ptr<double[], Release> data;
  };
  void add_slab(std::size_t count) {
    const std::size_t size = std::max(kSlab, count);
    slabs_.push_back(
        {.size = size,
         .data = std::unique_ptr<double[], Release>(LineAllocator<double>{}.allocate(size))});
  }

  std::vector<Slab> slabs_;
  std::size_t at_ = 0;
  std::size_t used_ = 0;   // of the current slab
  std::size_t given_ = 0;  // in total
  std::size_t most_ = 0;   // largest given_ between two resets
};

}  // namespace qsmpc::controller

#pragma GCC visibility pop

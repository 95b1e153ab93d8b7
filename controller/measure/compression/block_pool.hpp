// A memory pool for many short-lived arrays of all sizes: returned blocks are reused soon, while
// they are still in the processor's caches.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <memory>

#include "controller/storage.hpp"

namespace qsmpc::controller {

/// An array of doubles aligned to a cache line, which is also a node of a linked list.
struct Block {
  Block* next = nullptr;
  std::size_t lines = 0;  ///< cache lines of data

  [[nodiscard]] double* data() { return reinterpret_cast<double*>(this) + kHeader; }
  static constexpr std::size_t kHeader = 64 / sizeof(double);  // doubles
};
static_assert(sizeof(Block) <= Block::kHeader * sizeof(double));

/// Not thread-safe; but a block may be given back to a pool other than its own, as long as both are
/// reset together.
class BlockPool {
 public:
  /// A block for `count` doubles of unspecified value.
  [[nodiscard]] Block* take(std::size_t count) {
    const std::size_t lines = rounded((count + kLine - 1) / kLine);
    Block*& free = free_[class_of(lines)];
    if (free != nullptr) {
      Block* const block = free;
      free = block->next;
      return block;
    }
    double* const memory = arena_.take(Block::kHeader + lines * kLine);
    return std::construct_at(reinterpret_cast<Block*>(memory), Block{.lines = lines});
  }
  void give_back(Block* block) {
    Block*& free = free_[class_of(block->lines)];
    block->next = free;
    free = block;
  }
  /// Reclaims all blocks.
  void reset() {
    arena_.reset();
    free_.fill(nullptr);
  }

 private:
  static constexpr std::size_t kLine = 64 / sizeof(double);
  // Sizes within an eighth of each other are one class.
  static constexpr std::size_t kSteps = 8;
  static constexpr std::size_t kClasses = 64 * kSteps;

  static std::size_t step_of(std::size_t lines) {
    return lines < 2 * kSteps ? 1 : std::bit_floor(lines) / kSteps;
  }
  static std::size_t rounded(std::size_t lines) {
    const std::size_t step = step_of(lines);
    return (lines + step - 1) / step * step;
  }
  static std::size_t class_of(std::size_t lines) {
    const std::size_t step = step_of(lines);
    return static_cast<std::size_t>(std::bit_width(step)) * kSteps + lines / step;
  }

  Arena arena_;
  std::array<Block*, kClasses> free_{};
};

}  // namespace qsmpc::controller

// The few colours of an animated GIF, and pictures in them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace qsmpc::render {

/// Counts the colours of pictures, then chooses those that show all of them best.
class ColourCount {
 public:
  /// Throws std::bad_alloc.
  ColourCount();
  ~ColourCount();
  ColourCount(const ColourCount&) = delete;
  ColourCount& operator=(const ColourCount&) = delete;

  /// `rgba`: 4 bytes a pixel, rows without a gap. Throws std::runtime_error.
  void add(const std::vector<unsigned char>& rgba, int width, int height);

  /// At most `count` (2 … 255) opaque colours, each as 0xffRRGGBB. Throws std::runtime_error when
  /// no picture was added.
  [[nodiscard]] std::vector<std::uint32_t> best(int count) const;

 private:
  struct Counter;
  std::unique_ptr<Counter> counter_;
};

/// Finds, for each pixel, the colour of a palette. Between two colours it alternates in a pattern
/// that stands still, so that what does not move in a film stays as it is in the file.
class PaletteMap {
 public:
  explicit PaletteMap(std::vector<std::uint32_t> palette);

  /// The index of the palette's colour nearest to `rgb` as the pixel at (x, y) shows it.
  [[nodiscard]] std::uint8_t index(const unsigned char* rgb, int x, int y);

 private:
  // Of a channel, in the table of what was found before: who asks first for one of the colours
  // that share an entry finds for all.
  static constexpr int kBits = 7;
  static constexpr std::size_t kEntries = std::size_t{1} << (3 * kBits);

  [[nodiscard]] std::uint8_t known_or_nearest(const std::array<int, 3>& colour);
  [[nodiscard]] std::uint8_t nearest(const std::array<int, 3>& colour) const;

  std::vector<std::uint32_t> palette_;
  std::vector<std::int16_t> known_;  // -1: not found yet
};

}  // namespace qsmpc::render

// The limited palette of an animated GIF, and the conversion of pictures to it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace qsmpc::render {

/// Counts the colours of pictures, then chooses the palette that represents them best.
class ColourCount {
 public:
  /// Throws std::bad_alloc.
  ColourCount();
  ~ColourCount();
  ColourCount(const ColourCount&) = delete;
  ColourCount& operator=(const ColourCount&) = delete;

  /// `rgba`: 4 bytes per pixel, rows without gaps. Throws std::runtime_error.
  void add(const std::vector<unsigned char>& rgba, int width, int height);

  /// At most `count` (2 … 255) opaque colours, each as 0xffRRGGBB. Throws std::runtime_error if no
  /// picture was added.
  [[nodiscard]] std::vector<std::uint32_t> best(int count) const;

 private:
  struct Counter;
  std::unique_ptr<Counter> counter_;
};

/// Finds the palette colour of each pixel. Intermediate colours are dithered in a fixed pattern, so
/// that static parts of a film stay identical in the file.
class PaletteMap {
 public:
  explicit PaletteMap(std::vector<std::uint32_t> palette);

  /// The index of the palette colour nearest to `rgb` as dithered at pixel (x, y).
  [[nodiscard]] std::uint8_t index(const unsigned char* rgb, int x, int y);

 private:
  // Bits per channel in the cache of lookups. Colours that share an entry get the result of the
  // first one looked up.
  static constexpr int kBits = 7;
  static constexpr std::size_t kEntries = std::size_t{1} << (3 * kBits);

  [[nodiscard]] std::uint8_t known_or_nearest(const std::array<int, 3>& colour);
  [[nodiscard]] std::uint8_t nearest(const std::array<int, 3>& colour) const;

  std::vector<std::uint32_t> palette_;
  std::vector<std::int16_t> known_;  // -1: not looked up yet
};

}  // namespace qsmpc::render

#include "render/media/gif_palette.hpp"

#include <algorithm>
#include <new>
#include <stdexcept>
#include <string>
#include <utility>

#include <libimagequant.h>

namespace qsmpc::render {
namespace {

constexpr int kSpeed = 4;            // libimagequant's: 1 slow … 10 coarse
constexpr int kPatternSide = 4;      // pixels
constexpr int kSpread = 10;          // of 255, between the extremes of the pattern
constexpr int kUnseen = 10 * 3 * 3;  // in units of `distance`: three steps of 255 in each channel

// Ordered dithering (B. E. Bayer, 1973): each value once, neighbours far apart.
constexpr std::array<int, std::size_t{kPatternSide} * kPatternSide> kPattern{
    0, 8, 2, 10, 12, 4, 14, 6, 3, 11, 1, 9, 15, 7, 13, 5};

struct Deleter {
  void operator()(liq_attr* attributes) const { liq_attr_destroy(attributes); }
  void operator()(liq_histogram* histogram) const { liq_histogram_destroy(histogram); }
  void operator()(liq_image* image) const { liq_image_destroy(image); }
  void operator()(liq_result* result) const { liq_result_destroy(result); }
};
template <typename T>
using Pointer = std::unique_ptr<T, Deleter>;

template <typename T>
T* check_allocated(T* pointer) {
  if (pointer == nullptr) {
    throw std::bad_alloc();
  }
  return pointer;
}

void check(liq_error error) {
  if (error != LIQ_OK) {
    throw std::runtime_error("choosing colours: error " + std::to_string(error) +
                             " of libimagequant");
  }
}

// Weighted roughly by the eye's sensitivity.
int distance(const std::array<int, 3>& colour, std::uint32_t entry) {
  const int red = colour[0] - static_cast<int>(entry >> 16U & 0xffU);
  const int green = colour[1] - static_cast<int>(entry >> 8U & 0xffU);
  const int blue = colour[2] - static_cast<int>(entry & 0xffU);
  return 3 * red * red + 6 * green * green + blue * blue;
}

int offset_at(int x, int y) {
  const int cell = kPatternSide * (y % kPatternSide) + x % kPatternSide;
  const int place = kPattern[static_cast<std::size_t>(cell)];
  constexpr int kLast = kPatternSide * kPatternSide - 1;
  return (2 * place - kLast) * kSpread / (2 * kLast);
}

}  // namespace

struct ColourCount::Counter {
  Pointer<liq_attr> attributes;
  Pointer<liq_histogram> histogram;
};

ColourCount::ColourCount() : counter_(std::make_unique<Counter>()) {
  counter_->attributes.reset(check_allocated(liq_attr_create()));
  check(liq_set_speed(counter_->attributes.get(), kSpeed));
  counter_->histogram.reset(check_allocated(liq_histogram_create(counter_->attributes.get())));
}

ColourCount::~ColourCount() = default;

void ColourCount::add(const std::vector<unsigned char>& rgba, int width, int height) {
  const Pointer<liq_image> image(check_allocated(
      liq_image_create_rgba(counter_->attributes.get(), rgba.data(), width, height, 0.0)));
  check(
      liq_histogram_add_image(counter_->histogram.get(), counter_->attributes.get(), image.get()));
}

std::vector<std::uint32_t> ColourCount::best(int count) const {
  check(liq_set_max_colors(counter_->attributes.get(), count));
  liq_result* found = nullptr;
  check(liq_histogram_quantize(counter_->histogram.get(), counter_->attributes.get(), &found));
  const Pointer<liq_result> result(found);
  const liq_palette& palette = *check_allocated(liq_get_palette(result.get()));
  std::vector<std::uint32_t> colours;
  for (unsigned i = 0; i < palette.count; ++i) {
    const liq_color& c = palette.entries[i];
    colours.push_back(0xff000000U | static_cast<std::uint32_t>(c.r) << 16U |
                      static_cast<std::uint32_t>(c.g) << 8U | c.b);
  }
  return colours;
}

PaletteMap::PaletteMap(std::vector<std::uint32_t> palette)
    : palette_(std::move(palette)), known_(kEntries, -1) {}

std::uint8_t PaletteMap::index(const unsigned char* rgb, int x, int y) {
  const std::array<int, 3> colour{rgb[0], rgb[1], rgb[2]};
  const std::uint8_t plain = known_or_nearest(colour);
  if (distance(colour, palette_[plain]) <= kUnseen) {
    return plain;
  }
  const int offset = offset_at(x, y);
  return known_or_nearest({std::clamp(colour[0] + offset, 0, 255),
                           std::clamp(colour[1] + offset, 0, 255),
                           std::clamp(colour[2] + offset, 0, 255)});
}

std::uint8_t PaletteMap::known_or_nearest(const std::array<int, 3>& colour) {
  std::size_t entry = 0;
  for (const int channel : colour) {
    entry =
        entry << static_cast<unsigned>(kBits) | static_cast<std::size_t>(channel >> (8 - kBits));
  }
  if (known_[entry] < 0) {
    known_[entry] = nearest(colour);
  }
  return static_cast<std::uint8_t>(known_[entry]);
}

std::uint8_t PaletteMap::nearest(const std::array<int, 3>& colour) const {
  const auto best = std::min_element(palette_.begin(), palette_.end(),
                                     [&colour](std::uint32_t a, std::uint32_t b) {
                                       return distance(colour, a) < distance(colour, b);
                                     });
  return static_cast<std::uint8_t>(best - palette_.begin());
}

}  // namespace qsmpc::render

#include "render/gl/smoothing.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>

namespace qsmpc::render {
namespace {

constexpr int kLeastContrast = 14;     // of 255: lower contrasts are invisible
constexpr float kLongestReach = 2.5F;  // pixels along an edge; more would erode the particles
constexpr float kReduction = 1.0F / 8.0F;
constexpr float kLeastReduction = 255.0F / 128.0F;
constexpr int kFraction = 256;  // units of subpixel positions per pixel

// Red, blue and green of a pixel, 16 bits each, so that one multiplication blends all of them.
using Lanes = std::uint64_t;
constexpr Lanes kLowBytes = 0x00ff'00ff'00ff'00ffU;
constexpr Lanes kRounding = 0x0080'0080'0080'0080U;  // half, where 8 bits are dropped
constexpr Lanes kHalfOfTwo = 0x0001'0001'0001'0001U;
constexpr int kBlueShift = 16;
constexpr int kGreenShift = 32;

Lanes lanes_of(std::uint32_t pixel) {
  return (pixel & 0x00ff00ffU) | static_cast<Lanes>(pixel & 0xff00ff00U) << 24U;
}

// (1 − share/256) · a + share/256 · b.
Lanes blend(Lanes a, Lanes b, unsigned share) {
  return ((a * (kFraction - share) + b * share + kRounding) >> 8U) & kLowBytes;
}

Lanes mean(Lanes a, Lanes b) { return ((a + b + kHalfOfTwo) >> 1U) & kLowBytes; }

// Weights of the eye's sensitivity, in eighths.
int luma_of(int red, int green, int blue) { return (2 * red + 5 * green + blue) / 8; }

int luma_of(Lanes colour) {
  return luma_of(static_cast<int>(colour & 0xffU), static_cast<int>(colour >> kGreenShift & 0xffU),
                 static_cast<int>(colour >> kBlueShift & 0xffU));
}

class EdgeFilter {
 public:
  EdgeFilter(Image& image, SmoothingWorkspace& workspace)
      : image_(image), workspace_(workspace), width_(image.width), height_(image.height) {
    const std::size_t count = image.rgb.size() / 3;
    workspace_.original.resize(count);
    workspace_.luma.resize(count);
    workspace_.edges.assign(static_cast<std::size_t>(width_), 0);
    const unsigned char* rgb = image.rgb.data();
    for (std::size_t i = 0; i < count; ++i, rgb += 3) {
      workspace_.original[i] = rgb[0] | static_cast<std::uint32_t>(rgb[1]) << 8U |
                               static_cast<std::uint32_t>(rgb[2]) << 16U;
      workspace_.luma[i] = static_cast<unsigned char>(luma_of(rgb[0], rgb[1], rgb[2]));
    }
  }

  void run() {
    for (int y = 1; y + 1 < height_; ++y) {
      find_edges(y);
      smooth_row(y);
    }
  }

 private:
  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(x);
  }

  // The contrast of every pixel of a row to its four neighbours; a plain loop that the compiler
  // vectorises, as most pixels are not on an edge.
  void find_edges(int y) {
    const unsigned char* const middle = &workspace_.luma[index(0, y)];
    const unsigned char* const above = middle - width_;
    const unsigned char* const below = middle + width_;
    unsigned char* const edges = workspace_.edges.data();
    for (int x = 1; x < width_ - 1; ++x) {
      const unsigned char high = std::max(std::max(std::max(above[x], below[x]), middle[x]),
                                          std::max(middle[x - 1], middle[x + 1]));
      const unsigned char low = std::min(std::min(std::min(above[x], below[x]), middle[x]),
                                         std::min(middle[x - 1], middle[x + 1]));
      const auto contrast = static_cast<unsigned char>(high - low);
      edges[x] = contrast > kLeastContrast ? 1 : 0;
    }
  }

  // Skips eight pixels without an edge at once.
  void smooth_row(int y) {
    constexpr int kBlock = 8;
    const unsigned char* const edges = workspace_.edges.data();
    for (int begin = 0; begin < width_; begin += kBlock) {
      const int end = std::min(begin + kBlock, width_);
      std::uint64_t any = 1;
      if (end - begin == kBlock) {
        std::memcpy(&any, edges + begin, sizeof any);
      }
      for (int x = begin; any != 0 && x < end; ++x) {
        if (edges[x] != 0) {
          smooth_pixel(x, y);
        }
      }
    }
  }

  // Bilinear interpolation between pixel centres at a position in units of 1 / kFraction; positions
  // outside the picture are clamped to its border.
  [[nodiscard]] Lanes sample(int x, int y) const {
    const int cx = std::clamp(x, 0, (width_ - 1) * kFraction - 1);
    const int cy = std::clamp(y, 0, (height_ - 1) * kFraction - 1);
    const std::uint32_t* const upper = &workspace_.original[index(cx / kFraction, cy / kFraction)];
    const std::uint32_t* const lower = upper + width_;
    const auto across = static_cast<unsigned>(cx % kFraction);
    const auto down = static_cast<unsigned>(cy % kFraction);
    return blend(blend(lanes_of(upper[0]), lanes_of(upper[1]), across),
                 blend(lanes_of(lower[0]), lanes_of(lower[1]), across), down);
  }

  void smooth_pixel(int x, int y) {
    const auto luma = [this](int column, int row) -> int {
      return workspace_.luma[index(column, row)];
    };
    const int nw = luma(x - 1, y - 1);
    const int ne = luma(x + 1, y - 1);
    const int sw = luma(x - 1, y + 1);
    const int se = luma(x + 1, y + 1);
    const int middle = luma(x, y);
    // Along the edge, i.e. across the gradient.
    const auto across = static_cast<float>((sw + se) - (nw + ne));
    const auto upright = static_cast<float>((nw + sw) - (ne + se));
    const float total = static_cast<float>(nw + ne + sw + se);
    const float reduction = std::max(total * 0.25F * kReduction, kLeastReduction);
    const float scale = 1.0F / (std::min(std::abs(across), std::abs(upright)) + reduction);
    const float dx = kFraction * std::clamp(across * scale, -kLongestReach, kLongestReach);
    const float dy = kFraction * std::clamp(upright * scale, -kLongestReach, kLongestReach);
    const auto mean_of_two = [&](float reach) {
      const auto rx = static_cast<int>(reach * dx);
      const auto ry = static_cast<int>(reach * dy);
      const int px = x * kFraction;
      const int py = y * kFraction;
      return mean(sample(px - rx, py - ry), sample(px + rx, py + ry));
    };
    const Lanes near = mean_of_two(1.0F / 6.0F);
    const Lanes wide = mean(near, mean_of_two(0.5F));
    // If the wide mean reached across another edge, it is brighter or darker than the whole
    // neighbourhood.
    const int low = std::min({nw, ne, sw, se, middle});
    const int high = std::max({nw, ne, sw, se, middle});
    const bool astray = luma_of(wide) < low || luma_of(wide) > high;
    const Lanes chosen = astray ? near : wide;
    unsigned char* const pixel = &image_.rgb[3 * index(x, y)];
    pixel[0] = static_cast<unsigned char>(chosen & 0xffU);
    pixel[1] = static_cast<unsigned char>(chosen >> kGreenShift & 0xffU);
    pixel[2] = static_cast<unsigned char>(chosen >> kBlueShift & 0xffU);
  }

  Image& image_;
  SmoothingWorkspace& workspace_;
  int width_;
  int height_;
};

}  // namespace

void smooth_edges(Image& image, SmoothingWorkspace& workspace) {
  EdgeFilter(image, workspace).run();
}

}  // namespace qsmpc::render

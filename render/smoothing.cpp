#include "render/smoothing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace qsmpc {
namespace {

constexpr int kLeastContrast = 14;     // of 255: below it nobody sees an edge
constexpr float kLongestReach = 2.5F;  // pixels along an edge; more would eat the particles
constexpr float kReduction = 1.0F / 8.0F;
constexpr float kLeastReduction = 255.0F / 128.0F;

using Rgb = std::array<float, 3>;

// Red and blue count little: the weights are those of the eye, in eighths.
unsigned char luma_of(const unsigned char* pixel) {
  return static_cast<unsigned char>((2 * pixel[0] + 5 * pixel[1] + pixel[2]) / 8);
}

float luma_of(const Rgb& colour) {
  return (2.0F * colour[0] + 5.0F * colour[1] + colour[2]) / 8.0F;
}

class EdgeFilter {
 public:
  EdgeFilter(Image& image, SmoothingWorkspace& workspace)
      : image_(image), workspace_(workspace), width_(image.width), height_(image.height) {
    workspace_.original = image.rgb;
    workspace_.luma.resize(image.rgb.size() / 3);
    workspace_.edges.resize(static_cast<std::size_t>(width_));
    for (std::size_t i = 0; i < workspace_.luma.size(); ++i) {
      workspace_.luma[i] = luma_of(&image.rgb[3 * i]);
    }
  }

  void run() {
    for (int y = 1; y + 1 < height_; ++y) {
      find_edges(y);
      for (int x = 1; x + 1 < width_; ++x) {
        if (workspace_.edges[static_cast<std::size_t>(x)] > kLeastContrast) {
          smooth_pixel(x, y);
        }
      }
    }
  }

 private:
  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(x);
  }

  // The contrast of every pixel of a row to its four neighbours; a plain loop, so that it is
  // vectorised: most pixels are on no edge.
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
      edges[x] = static_cast<unsigned char>(high - low);
    }
  }

  // Bilinear between pixel centres; places outside of the picture are moved to its border.
  [[nodiscard]] Rgb sample(float x, float y) const {
    const float cx = std::clamp(x, 0.0F, static_cast<float>(width_ - 1));
    const float cy = std::clamp(y, 0.0F, static_cast<float>(height_ - 1));
    const int x0 = std::min(static_cast<int>(cx), width_ - 2);
    const int y0 = std::min(static_cast<int>(cy), height_ - 2);
    const float fx = cx - static_cast<float>(x0);
    const float fy = cy - static_cast<float>(y0);
    const unsigned char* const upper = &workspace_.original[3 * index(x0, y0)];
    const unsigned char* const lower = &workspace_.original[3 * index(x0, y0 + 1)];
    Rgb colour{};
    for (std::size_t i = 0; i < 3; ++i) {
      const float top = (1.0F - fx) * upper[i] + fx * upper[i + 3];
      const float bottom = (1.0F - fx) * lower[i] + fx * lower[i + 3];
      colour[i] = (1.0F - fy) * top + fy * bottom;
    }
    return colour;
  }

  [[nodiscard]] Rgb mean_of_two(float x, float y, float dx, float dy, float reach) const {
    const Rgb a = sample(x - reach * dx, y - reach * dy);
    const Rgb b = sample(x + reach * dx, y + reach * dy);
    return {0.5F * (a[0] + b[0]), 0.5F * (a[1] + b[1]), 0.5F * (a[2] + b[2])};
  }

  void smooth_pixel(int x, int y) {
    const auto luma = [this](int column, int row) -> float {
      return workspace_.luma[index(column, row)];
    };
    const float nw = luma(x - 1, y - 1);
    const float ne = luma(x + 1, y - 1);
    const float sw = luma(x - 1, y + 1);
    const float se = luma(x + 1, y + 1);
    const float middle = luma(x, y);
    // Along the edge, i.e. across the gradient.
    const float across = (sw + se) - (nw + ne);
    const float upright = (nw + sw) - (ne + se);
    const float reduction = std::max((nw + ne + sw + se) * 0.25F * kReduction, kLeastReduction);
    const float scale = 1.0F / (std::min(std::abs(across), std::abs(upright)) + reduction);
    const float dx = std::clamp(across * scale, -kLongestReach, kLongestReach);
    const float dy = std::clamp(upright * scale, -kLongestReach, kLongestReach);
    const auto px = static_cast<float>(x);
    const auto py = static_cast<float>(y);
    const Rgb near = mean_of_two(px, py, dx, dy, 1.0F / 6.0F);
    const Rgb far = mean_of_two(px, py, dx, dy, 0.5F);
    const Rgb wide{0.5F * (near[0] + far[0]), 0.5F * (near[1] + far[1]), 0.5F * (near[2] + far[2])};
    // The wide mean may have reached across another edge; then it is brighter or darker than all
    // here.
    const float low = std::min({nw, ne, sw, se, middle});
    const float high = std::max({nw, ne, sw, se, middle});
    const bool astray = luma_of(wide) < low || luma_of(wide) > high;
    const Rgb& chosen = astray ? near : wide;
    unsigned char* const pixel = &image_.rgb[3 * index(x, y)];
    for (std::size_t i = 0; i < 3; ++i) {
      pixel[i] = static_cast<unsigned char>(std::lround(chosen[i]));
    }
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

}  // namespace qsmpc

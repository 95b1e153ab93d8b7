// Thousands of points: which ones are drawn, and how they are thinned.
#include <numeric>

#include <gtest/gtest.h>

#include "render/scene/thinning.hpp"
#include "tests/unit/render/render_fixture.hpp"

namespace qsmpc::render {
namespace points_test {

ParticleStage weighted_row(std::size_t count) {
  ParticleStage stage;
  double sum = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    stage.points.push_back({static_cast<double>(i), 0.0});
    stage.weights.push_back(1.0 + static_cast<double>((7 * i) % count));
    sum += stage.weights.back();
  }
  for (double& weight : stage.weights) {
    weight /= sum;
  }
  return stage;
}

TEST(thinning, is_the_least_that_keeps_the_limit) {
  EXPECT_EQ(thinning(0, 10), 1U);
  EXPECT_EQ(thinning(10, 10), 1U);
  EXPECT_EQ(thinning(11, 10), 2U);
  EXPECT_EQ(thinning(120'000, kMostOverlayPoints), 7U);
}

TEST(thinning, keeps_every_nth_by_weight_and_the_whole_weight) {
  const ParticleStage all = weighted_row(100);
  const ParticleStage kept = thinned(all, 5);
  EXPECT_EQ(kept.points.size(), 20U);
  EXPECT_NEAR(std::accumulate(kept.weights.begin(), kept.weights.end(), 0.0), 1.0, 1e-12);
  // Heavy and light ones alike: every fifth is kept, with its weight times nearly five.
  for (std::size_t i = 0; i < kept.points.size(); ++i) {
    const auto index = static_cast<std::size_t>(kept.points[i].x);
    EXPECT_NEAR(kept.weights[i] / all.weights[index], 5.0, 0.05);
    if (i > 0) {
      EXPECT_GT(kept.weights[i - 1], kept.weights[i]);
    }
  }
}

TEST(thinning, of_one_changes_nothing_and_of_many_keeps_a_point) {
  const ParticleStage all = weighted_row(6);
  EXPECT_EQ(thinned(all, 1).weights, all.weights);
  EXPECT_EQ(thinned(all, 50).points.size(), 1U);
  EXPECT_TRUE(thinned({}, 3).points.empty());
}

// Points are drawn in three ways, depending on their size.
TEST(points, of_every_size_lie_where_they_project) {
  Renderer renderer(small_picture("top"), small_world(), kRedBox);
  for (const std::size_t others : {std::size_t{0}, std::size_t{60}, std::size_t{5000}}) {
    Frame frame;
    frame.particles.emplace_back();
    ParticleStage& stage = frame.particles.front();
    for (std::size_t i = 0; i <= others; ++i) {
      stage.points.push_back(i == 0 ? PlanarPoint{1.0, 0.5} : PlanarPoint{-1.5, -1.5});
      stage.weights.push_back(1.0 / static_cast<double>(others + 1));
    }
    Image image;
    renderer.draw(frame, image);
    const Pixel pixel = pixel_at(image, *renderer.locate(frame, {1.0, 0.5}, 0.01));
    EXPECT_LT(colour_difference(pixel, stage_colour(0, 1)), 100) << others;
    EXPECT_LT(pixel.green, 140) << others;  // the ground's is 228
  }
}

}  // namespace points_test
}  // namespace qsmpc::render

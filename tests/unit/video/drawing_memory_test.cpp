#include "harness/video/drawing_memory.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "models/constants.hpp"

namespace qsmpc::harness {
namespace drawing_memory_test {

using ::testing::ContainsRegex;

TEST(DrawingMemory, grows_with_pixels_threads_and_cores) {
  const EpisodeVideoOptions usual;
  EpisodeVideoOptions large = usual;
  large.width *= 2;
  EpisodeVideoOptions many = usual;
  many.threads *= 2;
  const double need = drawing_memory(usual, 2);
  // Measured: 850 MB.
  EXPECT_GT(need, 850e6);
  EXPECT_LT(need, 1000e6);
  EXPECT_GT(drawing_memory(large, 2), need);
  EXPECT_GT(drawing_memory(many, 2), need);
  EXPECT_GT(drawing_memory(usual, 4), need);
}

TEST(DrawingMemory, says_what_it_takes_and_what_there_is) {
  const EpisodeVideoOptions options;
  EXPECT_FALSE(why_no_memory_to_draw(options, kInfinity));
  const auto reason = why_no_memory_to_draw(options, 200e6);
  ASSERT_TRUE(reason);
  EXPECT_THAT(*reason, ContainsRegex("drawing 1280x720 pixels on 2 threads takes about [0-9]+ MB "
                                     "of address space, .*leaves 200 MB$"));
}

}  // namespace drawing_memory_test
}  // namespace qsmpc::harness

#include "harness/video/ordered_drawing.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>

#include <gtest/gtest.h>

namespace qsmpc::harness {
namespace ordered_drawing_test {

OrderedDrawing::Drawer number_drawer() {
  return [](int index, render::Image& out) { out.width = index; };
}

TEST(ordered_drawing, pictures_come_in_order_whoever_drew_them) {
  constexpr int kTotal = 50;
  OrderedDrawing drawing({.total = kTotal, .threads = 3}, [] {
    return [](int index, render::Image& out) {
      // Every third picture is late.
      std::this_thread::sleep_for(std::chrono::milliseconds(index % 3 == 0 ? 2 : 0));
      out.width = index;
    };
  });
  render::Image image;
  for (int index = 0; index < kTotal; ++index) {
    drawing.take(image);
    EXPECT_EQ(image.width, index);
  }
  EXPECT_THROW(drawing.take(image), std::out_of_range);
}

TEST(ordered_drawing, no_more_pictures_are_begun_than_there_are_slots) {
  std::atomic<int> begun = 0;
  OrderedDrawing drawing({.total = 100, .threads = 3}, [&begun] {
    return [&begun](int index, render::Image& out) {
      ++begun;
      out.width = index;
    };
  });
  ASSERT_EQ(drawing.slots(), 6);
  render::Image image;
  for (int taken = 1; taken <= 20; ++taken) {
    drawing.take(image);
    EXPECT_LE(begun, taken + drawing.slots());
    std::this_thread::sleep_for(std::chrono::milliseconds(1));  // gives threads time to start
                                                                // further pictures
    EXPECT_LE(begun, taken + drawing.slots());
  }
}

TEST(ordered_drawing, memory_of_pictures_is_used_again) {
  std::atomic<int> allocations = 0;
  OrderedDrawing drawing({.total = 60, .threads = 2}, [&allocations] {
    return [&allocations](int /*index*/, render::Image& out) {
      allocations += out.rgb.empty() ? 1 : 0;
      out.rgb.resize(12);
    };
  });
  render::Image image;
  for (int index = 0; index < 60; ++index) {
    drawing.take(image);
  }
  EXPECT_LE(allocations, drawing.slots() + 1);  // plus the one held by the caller
}

TEST(ordered_drawing, each_thread_makes_its_own_drawer_and_uses_it_alone) {
  std::atomic<int> drawers = 0;
  std::atomic<int> strangers = 0;
  OrderedDrawing drawing({.total = 40, .threads = 2}, [&] {
    ++drawers;
    const std::thread::id owner = std::this_thread::get_id();
    return [&strangers, owner](int /*index*/, render::Image& /*out*/) {
      strangers += std::this_thread::get_id() == owner ? 0 : 1;
    };
  });
  render::Image image;
  for (int index = 0; index < 40; ++index) {
    drawing.take(image);
  }
  EXPECT_LE(drawers, 2);
  EXPECT_EQ(strangers, 0);
}

TEST(ordered_drawing, what_a_drawer_throws_reaches_the_taker) {
  OrderedDrawing drawing({.total = 100, .threads = 2}, [] {
    return [](int index, render::Image& /*out*/) {
      if (index == 7) throw std::runtime_error("no paint");
    };
  });
  render::Image image;
  const auto take_all = [&] {
    for (int index = 0; index < 100; ++index) {
      drawing.take(image);
    }
  };
  EXPECT_THROW(take_all(), std::runtime_error);
}

TEST(ordered_drawing, what_making_a_drawer_throws_reaches_the_taker) {
  OrderedDrawing drawing({.total = 5, .threads = 1},
                         []() -> OrderedDrawing::Drawer { throw std::runtime_error("no easel"); });
  render::Image image;
  EXPECT_THROW(drawing.take(image), std::runtime_error);
}

TEST(ordered_drawing, ends_though_pictures_are_left) {
  OrderedDrawing drawing({.total = 1000, .threads = 2}, number_drawer);
  render::Image image;
  drawing.take(image);
}

TEST(ordered_drawing, tells_how_long_drawing_took) {
  OrderedDrawing drawing({.total = 4, .threads = 2}, [] {
    return [](int /*index*/, render::Image& /*out*/) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    };
  });
  render::Image image;
  for (int index = 0; index < 4; ++index) {
    drawing.take(image);
  }
  EXPECT_GE(drawing.drawing_seconds(), 4 * 0.005);
}

TEST(ordered_drawing, needs_a_thread) {
  EXPECT_THROW(OrderedDrawing({.total = 1, .threads = 0}, number_drawer), std::invalid_argument);
}

}  // namespace ordered_drawing_test
}  // namespace qsmpc::harness

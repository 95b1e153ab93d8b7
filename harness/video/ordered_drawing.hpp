// Pictures drawn by several threads and consumed by one, in order and with bounded memory.
//
//   OrderedDrawing drawing({.total = 300, .threads = 2}, [&] {
//     auto renderer = std::make_shared<Renderer>(…);  // on the drawing thread, whose own it stays
//     return [renderer](int index, Image& out) { renderer->draw(frame_of(index), out); };
//   });
//   for (int index = 0; index < 300; ++index) { drawing.take(image); video.add(image); }
#pragma once

#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "render/frame.hpp"

namespace qsmpc::harness {

class OrderedDrawing {
 public:
  /// Draws picture `index` into `out`, which reuses the memory of an earlier picture.
  using Drawer = std::function<void(int index, render::Image& out)>;
  /// Called once on each drawing thread; its result is also called and destroyed there.
  using DrawerFactory = std::function<Drawer()>;

  struct Work {
    int total = 0;    ///< pictures, 0 … total - 1
    int threads = 1;  ///< drawing threads; no more than `total` are started
  };

  /// Starts drawing. Throws std::invalid_argument if `work.threads` is below 1.
  OrderedDrawing(const Work& work, const DrawerFactory& make_drawer);

  /// Stops after the pictures that are being drawn.
  ~OrderedDrawing();
  OrderedDrawing(const OrderedDrawing&) = delete;
  OrderedDrawing& operator=(const OrderedDrawing&) = delete;

  /// Waits for the next picture, starting with the first, and swaps it into `image`. Rethrows the
  /// exception of a drawing thread; throws std::out_of_range when all pictures are taken.
  void take(render::Image& image);

  /// Number of pictures that may be held at once, drawn or being drawn, besides the one that was
  /// taken.
  [[nodiscard]] int slots() const { return static_cast<int>(slots_.size()); }

  /// Wall-clock time spent in drawers so far, summed over the threads, s.
  [[nodiscard]] double drawing_seconds() const;

 private:
  struct Slot {
    bool drawn = false;
    render::Image image;
  };

  Slot& slot_of(int index) { return slots_[static_cast<std::size_t>(index) % slots_.size()]; }
  int next_to_draw();
  void draw_all(const DrawerFactory& make_drawer);

  int total_;
  std::vector<Slot> slots_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  int begun_ = 0;  // number of pictures begun
  int taken_ = 0;
  double drawing_seconds_ = 0.0;
  bool stop_ = false;
  std::exception_ptr error_;
  std::vector<std::thread> threads_;  // last: they use the rest
};

}  // namespace qsmpc::harness

#include "harness/video/ordered_drawing.hpp"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <stdexcept>
#include <utility>

namespace qsmpc::harness {
namespace {

// Lets the other threads continue past a slow picture until this many per thread are ahead of it.
constexpr std::size_t kSlotsPerThread = 2;

std::size_t slot_count(const OrderedDrawing::Work& work) {
  if (work.threads < 1) {
    throw std::invalid_argument("drawing: at least one thread is needed");
  }
  return kSlotsPerThread * static_cast<std::size_t>(work.threads);
}

}  // namespace

OrderedDrawing::OrderedDrawing(const Work& work, const DrawerFactory& make_drawer)
    : total_(work.total), slots_(slot_count(work)) {
  for (int thread = 0; thread < std::min(work.threads, work.total); ++thread) {
    threads_.emplace_back([this, make_drawer] { draw_all(make_drawer); });
  }
}

OrderedDrawing::~OrderedDrawing() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  for (std::thread& thread : threads_) {
    thread.join();
  }
}

void OrderedDrawing::take(render::Image& image) {
  std::unique_lock lock(mutex_);
  if (taken_ >= total_) {
    throw std::out_of_range("drawing: all pictures have been taken");
  }
  Slot& slot = slot_of(taken_);
  changed_.wait(lock, [&] { return error_ != nullptr || slot.drawn; });
  if (error_ != nullptr) {
    std::rethrow_exception(error_);
  }
  std::swap(slot.image, image);
  slot.drawn = false;
  ++taken_;
  lock.unlock();
  changed_.notify_all();
}

double OrderedDrawing::drawing_seconds() const {
  const std::lock_guard lock(mutex_);
  return drawing_seconds_;
}

// The next picture not yet begun, once its slot is free, i.e. once the slot's previous picture was
// taken; -1 if nothing is left to do.
int OrderedDrawing::next_to_draw() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] {
    return stop_ || begun_ >= total_ || begun_ < taken_ + static_cast<int>(slots_.size());
  });
  return stop_ || begun_ >= total_ ? -1 : begun_++;
}

void OrderedDrawing::draw_all(const DrawerFactory& make_drawer) {
  try {
    const Drawer draw = make_drawer();
    for (int index = next_to_draw(); index >= 0; index = next_to_draw()) {
      Slot& slot = slot_of(index);  // no other thread accesses its image until it is drawn
      const auto begin = std::chrono::steady_clock::now();
      draw(index, slot.image);
      const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begin;
      {
        const std::lock_guard lock(mutex_);
        slot.drawn = true;
        drawing_seconds_ += spent.count();
      }
      changed_.notify_all();
    }
  } catch (...) {
    {
      const std::lock_guard lock(mutex_);
      error_ = error_ == nullptr ? std::current_exception() : error_;
      stop_ = true;
    }
    changed_.notify_all();
  }
}

}  // namespace qsmpc::harness

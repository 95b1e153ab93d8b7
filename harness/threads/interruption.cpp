#include "harness/threads/interruption.hpp"

#include <atomic>

namespace qsmpc::harness {
namespace {

// Global, as signals concern the whole process. Signal handlers may access lock-free atomics.
std::atomic<int> seen = 0;
std::atomic<int> patience = 1;
static_assert(std::atomic<int>::is_always_lock_free);

}  // namespace

int interrupts() noexcept { return seen.load(std::memory_order_relaxed); }

int note_interrupt() noexcept { return seen.fetch_add(1, std::memory_order_relaxed) + 1; }

void forget_interrupts() noexcept { seen.store(0, std::memory_order_relaxed); }

void check_interrupts() {
  if (interrupts() >= patience.load(std::memory_order_relaxed)) throw Interrupted();
}

InterruptPatience::InterruptPatience(int count) : before_(patience.exchange(count)) {}

InterruptPatience::~InterruptPatience() { patience = before_; }

}  // namespace qsmpc::harness

#include "tests/unit/allocation/allocations.hpp"

#include <atomic>
#include <cerrno>
#include <cstdlib>

#include <execinfo.h>

#include "harness/threads/sanitizers.hpp"

// Sanitizers have their own allocator and report on it; otherwise the functions of the C library,
// which operator new and Eigen call, are replaced by wrappers that count.
#define QSMPC_SANITIZED (QSMPC_ADDRESS_SANITIZER || QSMPC_THREAD_SANITIZER)

namespace {

std::atomic<bool> counting{false};
std::atomic<std::size_t> counted{0};
// Set in a thread that is about to print, since printing may allocate.
thread_local bool printing = false;

void note_allocation() {
  if (!counting.load(std::memory_order_relaxed) || printing) return;
  if (counted.fetch_add(1) > 0) return;
  // Where the first allocation came from: printed to standard error, for addr2line.
  constexpr int kFrames = 30;
  constexpr int kStandardError = 2;
  void* frames[kFrames];
  printing = true;
  backtrace_symbols_fd(frames, backtrace(frames, kFrames), kStandardError);
  printing = false;
}

}  // namespace

#if QSMPC_SANITIZED

extern "C" int __sanitizer_install_malloc_and_free_hooks(void (*malloc_hook)(const volatile void*,
                                                                             std::size_t),
                                                         void (*free_hook)(const volatile void*));

namespace {
void on_malloc(const volatile void* /*block*/, std::size_t /*size*/) { note_allocation(); }
void on_free(const volatile void* /*block*/) {}
}  // namespace

#else

extern "C" {

void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* block, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);

void* malloc(std::size_t size) {
  note_allocation();
  return __libc_malloc(size);
}

void* calloc(std::size_t count, std::size_t size) {
  note_allocation();
  return __libc_calloc(count, size);
}

void* realloc(void* block, std::size_t size) {
  note_allocation();
  return __libc_realloc(block, size);
}

void* memalign(std::size_t alignment, std::size_t size) {
  note_allocation();
  return __libc_memalign(alignment, size);
}

void* aligned_alloc(std::size_t alignment, std::size_t size) {
  note_allocation();
  return __libc_memalign(alignment, size);
}

int posix_memalign(void** block, std::size_t alignment, std::size_t size) {
  note_allocation();
  *block = __libc_memalign(alignment, size);
  return *block == nullptr ? ENOMEM : 0;
}

}  // extern "C"

#endif

namespace qsmpc::testing {

AllocationCount::AllocationCount() {
  static const bool prepared = [] {
    // The first call of `backtrace` loads a library.
    void* frame[1];
    (void)backtrace(frame, 1);
#if QSMPC_SANITIZED
    __sanitizer_install_malloc_and_free_hooks(on_malloc, on_free);
#endif
    return true;
  }();
  (void)prepared;
  counted = 0;
  counting = true;
}

AllocationCount::~AllocationCount() { counting = false; }

std::size_t AllocationCount::count() const { return counted; }

}  // namespace qsmpc::testing

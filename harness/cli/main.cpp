#include <cstddef>

#include <Eigen/Core>

#include "harness/cli/program.hpp"

namespace {

// Eigen splits products of larger matrices into blocks according to the processor's cache sizes,
// which affects the last bits of the results. Fixed sizes make results independent of the
// processor.
constexpr std::ptrdiff_t kKibibyte = 1024;
constexpr std::ptrdiff_t kFirstCache = 48 * kKibibyte;
constexpr std::ptrdiff_t kSecondCache = 2048 * kKibibyte;
constexpr std::ptrdiff_t kThirdCache = 32768 * kKibibyte;

}  // namespace

int main(int argc, char** argv) {
  Eigen::setCpuCacheSizes(kFirstCache, kSecondCache, kThirdCache);
  return qsmpc::harness::run_program(argc, argv);
}

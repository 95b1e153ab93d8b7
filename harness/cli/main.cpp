#include <cstddef>

#include <Eigen/Core>

#include "harness/cli/program.hpp"

namespace {

// Eigen cuts products of larger matrices into blocks by the sizes of the processor's caches, and
// their last bits with them. With sizes of our own, results do not depend on the processor's.
constexpr std::ptrdiff_t kKibibyte = 1024;
constexpr std::ptrdiff_t kFirstCache = 48 * kKibibyte;
constexpr std::ptrdiff_t kSecondCache = 2048 * kKibibyte;
constexpr std::ptrdiff_t kThirdCache = 32768 * kKibibyte;

}  // namespace

int main(int argc, char** argv) {
  Eigen::setCpuCacheSizes(kFirstCache, kSecondCache, kThirdCache);
  return qsmpc::harness::run_program(argc, argv);
}

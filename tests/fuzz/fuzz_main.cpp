// The entry point for libFuzzer. QSMPC_FUZZ_TARGET selects the target.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>

#include "tests/fuzz/fuzz_targets.hpp"

namespace {

const qsmpc::testing::FuzzTarget* target = nullptr;

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* /*count*/, char*** /*arguments*/) {
  const char* const name = std::getenv("QSMPC_FUZZ_TARGET");
  try {
    target = &qsmpc::testing::fuzz_target(name == nullptr ? "" : name);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "QSMPC_FUZZ_TARGET: %s\n", error.what());
    std::exit(2);
  }
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  target->read(std::string(reinterpret_cast<const char*>(bytes), size));
  return 0;
}

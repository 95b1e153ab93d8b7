#include "harness/video/drawing_memory.hpp"

#include <algorithm>
#include <fstream>

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include "harness/threads/workers.hpp"
#include "models/constants.hpp"

namespace qsmpc::harness {
namespace {

constexpr double kMega = 1e6;
// Measured with Mesa's OSMesa and x264. For every drawing thread, Mesa starts as many threads as
// there are cores, and each thread takes address space for its stack and its part of the heap.
constexpr double kLibraries = 460e6;      // bytes, including buffers of a small picture
constexpr double kThreadOfACore = 75e6;   // bytes
constexpr double kPixelOfAThread = 55.0;  // bytes
constexpr int kMostCores = 8;             // more make little difference

}  // namespace

double drawing_memory(const EpisodeVideoOptions& options, int cores) {
  const double pixels = static_cast<double>(options.width) * options.height;
  return kLibraries + options.threads *
                          (kThreadOfACore * std::min(cores, kMostCores) + kPixelOfAThread * pixels);
}

double free_address_space() {
  rlimit limit{};
  if (::getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return kInfinity;
  double pages = 0.0;  // pages in use
  std::ifstream("/proc/self/statm") >> pages;
  const double used = pages * static_cast<double>(::sysconf(_SC_PAGESIZE));
  return std::max(0.0, static_cast<double>(limit.rlim_cur) - used);
}

std::optional<std::string> why_no_memory_to_draw(const EpisodeVideoOptions& options, double free) {
  const double need = drawing_memory(options, available_threads());
  if (need <= free) return std::nullopt;
  return fmt::format(
      "drawing {}x{} pixels on {} threads takes about {:.0f} MB of address space, but the process "
      "limit (ulimit -v) leaves {:.0f} MB",
      options.width, options.height, options.threads, need / kMega, free / kMega);
}

}  // namespace qsmpc::harness

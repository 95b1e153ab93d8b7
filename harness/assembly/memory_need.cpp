#include "harness/assembly/memory_need.hpp"

#include <algorithm>
#include <fstream>

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include "controller/prediction/propagator.hpp"
#include "harness/scenario/known_names.hpp"
#include "models/constants.hpp"

namespace qsmpc::harness {
namespace {

constexpr double kGiga = 1e9;
constexpr double kNumber = sizeof(double);
// Measured, bytes: storage per share of a point in a cluster, and the cost of clustering per
// product of a point and a component of the noise.
constexpr double kShare = 14.0;
constexpr double kProduct = 400.0;

/// The number in a system file; infinity if there is none, e.g. "max".
double limit_in(const char* path) {
  std::ifstream file(path);
  double value = kInfinity;
  return file >> value ? value : kInfinity;
}

/// The inputs of every sample, plus a few numbers per sample and per path of the noise.
double samples_need(const Scenario& scenario) {
  const controller::MppiSettings& mppi = scenario.controller.mppi;
  const auto dim = static_cast<double>(scenario.initial_state.mean.size());
  const auto inputs = static_cast<double>(scenario.controller.input_lower.size());
  const double stages = scenario.controller.horizon;
  const double paths = mppi.noise_paths;
  const double sample = stages * inputs + paths + 4.0 * dim + 8.0;
  return kNumber * (mppi.samples * sample + paths * (stages + 1.0) * dim);
}

double process_limit(int resource) {
  rlimit limit{};
  const bool is_limited = ::getrlimit(static_cast<__rlimit_resource>(resource), &limit) == 0 &&
                          limit.rlim_cur != RLIM_INFINITY;
  return is_limited ? static_cast<double>(limit.rlim_cur) : kInfinity;
}

std::string size_words(const Scenario::Controller& controller) {
  if (is_sampling(controller)) return fmt::format("{} samples", controller.mppi.samples);
  const Scenario::Quantisation& points = controller.quantisation;
  return fmt::format("{} state points, {} noise points, {} compressed points", points.state,
                     points.noise, points.compressed);
}

}  // namespace

double memory_need(const Scenario& scenario) {
  const Scenario::Controller& controller = scenario.controller;
  if (is_sampling(controller)) return samples_need(scenario);
  if (driving_kind(controller) != "quantised") return 0.0;  // the others hold no particles
  const auto dim = static_cast<double>(scenario.initial_state.mean.size());
  const double stages = controller.horizon;
  const double kept = controller.quantisation.compressed;
  const double most = std::max(controller.quantisation.state, controller.quantisation.compressed);
  const bool has_noise = controller.propagate_noise &&
                         controller::propagator_entry(controller.propagator).carries_noise;
  const double points = has_noise ? kept : controller.quantisation.state;
  const double parts = has_noise ? controller.quantisation.noise : 0.0;
  const double prediction = stages * points * (kNumber * (3.0 * dim + 2.0) + kShare * parts);
  const double clusters = kProduct * most * parts;
  return prediction + clusters;
}

double usable_memory() {
  const double machine =
      static_cast<double>(::sysconf(_SC_PHYS_PAGES)) * static_cast<double>(::sysconf(_SC_PAGESIZE));
  return std::min({machine, process_limit(RLIMIT_AS), process_limit(RLIMIT_DATA),
                   limit_in("/sys/fs/cgroup/memory.max"),
                   limit_in("/sys/fs/cgroup/memory/memory.limit_in_bytes")});
}

std::optional<MemoryProblem> memory_problem(const Scenario& scenario, int count, double usable) {
  const double need = count * memory_need(scenario);
  if (need <= kMemoryShare * usable) return std::nullopt;
  const Scenario::Controller& controller = scenario.controller;
  return MemoryProblem{
      .found =
          fmt::format("settings that need about {:.2g} GB of memory: a horizon of {} with {}{}",
                      need / kGiga, controller.horizon, size_words(controller),
                      count > 1 ? fmt::format(", {} drives in parallel", count) : ""),
      .expected = fmt::format("at most {:.2g} GB, {:.0f} % of the memory",
                              kMemoryShare * usable / kGiga, 100.0 * kMemoryShare)};
}

}  // namespace qsmpc::harness
